/* Parts of a body (part.h): what a window has of the whole, what ranks tell each other. */
#include "method/consistent/galerkin/galerkin.h"

#include "base/memory.h"
#include "base/sums.h"

#include <string.h>

/* --- What the window has of the whole ----------------------------------------------------------------- */

const struct band *part_matrix(struct consistent *c, int slot, const struct band *whole)
{
    struct rank_part *part = &c->part;
    const size_t n = part->along[slot].whole;
    if (whole == NULL || n == c->n[slot] || n != whole->n) return whole;
    for (size_t i = 0; i < part->matrices; i++)
        if (part->matrix[i].whole == whole && part->matrix[i].slot == slot) return part->matrix[i].cut;
    struct band *cut =
        part->matrices == PART_MATRICES ? NULL : band_cut(whole, part->along[slot].first, c->n[slot]);
    if (cut == NULL) return NULL;
    part->matrix[part->matrices].slot = slot;
    part->matrix[part->matrices].whole = whole;
    part->matrix[part->matrices++].cut = cut;
    return cut;
}

bool part_terms(struct consistent *c, struct tensor_term *terms, size_t count)
{
    for (size_t i = 0; i < count; i++)
        for (int slot = 0; slot < 3; slot++) {
            const struct band **matrix = &terms[i].matrix[slot];
            if (*matrix == NULL) continue;
            *matrix = part_matrix(c, slot, *matrix);
            if (*matrix == NULL) return false;
        }
    return true;
}

size_t part_face(const struct consistent *c, int face)
{
    const int slot = c->slot[face / 2];
    const struct part_axis *along = &c->part.along[slot];
    const size_t at = face % 2 == 0 ? 0 : along->whole - 1;
    return at >= along->first && at - along->first < c->n[slot] ? at - along->first : SIZE_MAX;
}

/* Which part along a slot has a plane or row of the body for its own. */
static int part_of(const struct part_axis *along, size_t at)
{
    int rank = 0;
    while (along->bound != NULL && at >= along->bound[rank + 1])
        rank++;
    return rank;
}

int part_holder(const struct consistent *c, size_t j, size_t k)
{
    const struct part_axis *along = c->part.along;
    return part_of(&along[1], j) + along[1].ranks * part_of(&along[2], k);
}

double part_largest(const struct consistent *c, double value)
{
    ranks_largest(c->part.ranks, 1, &value);
    return value;
}

double part_product(const struct consistent *c, const double *x, const double *y)
{
    const struct part_axis *rows = &c->part.along[1], *planes = &c->part.along[DEPTH];
    const size_t nx = c->n[0];
    double sum = 0;
    if (c->part.ranks == NULL) return sum_of_products(c->model.unknowns, x, y, c->threads);
    for (size_t component = 0; component < (size_t)c->dimension; component++) {
        const size_t from = component * c->volume + planes->own * c->plane;
        if (!part_rows(&c->part)) {
            sum += sum_of_products((planes->end - planes->own) * c->plane, x + from, y + from, c->threads);
            continue;
        }
        for (size_t k = planes->own; k < planes->end; k++) {
            const size_t at = component * c->volume + k * c->plane + rows->own * nx;
            sum += sum_of_products((rows->end - rows->own) * nx, x + at, y + at, 1);
        }
    }
    return sum;
}

/* --- Exchange ----------------------------------------------------------------------------------------- */

/* Planes or rows from .. end - 1. */
struct range {
    size_t from, end;
};

static size_t length(struct range range)
{
    return range.end - range.from;
}

enum { MOST_FIELDS = 32 };

/* Messages of an exchange along a slot. */
struct messages_of {
    const struct consistent *c;
    const struct part_fields *fields;
    int slot;
    size_t pieces;
    struct ranks_piece piece[2 * MOST_FIELDS];
    struct range received[2]; /* rows, of the neighbours before and behind */
};

struct part_fields part_values(const struct consistent *c, void *field, size_t fields, size_t number)
{
    const size_t plane = c->plane * number;
    return (struct part_fields){field, fields, c->volume * number, plane, 1, plane, c->n[0] * number};
}

/* Planes whose rows are sent: own ones. */
static struct range planes_of(const struct consistent *c, const struct part_fields *f)
{
    const struct part_axis *planes = &c->part.along[DEPTH];
    return f->plane == 0 ? (struct range){0, 1} : (struct range){planes->own, planes->end};
}

static size_t bytes_of_rows(const struct consistent *c, const struct part_fields *f, size_t rows)
{
    return f->fields * length(planes_of(c, f)) * f->lines * rows * f->row;
}

/* Rows of own planes between fields and room. */
static void pack(const struct consistent *c, const struct part_fields *f, struct range rows, bool out,
                 char *room)
{
    const struct range planes = planes_of(c, f);
    const size_t bytes = length(rows) * f->row;
    for (size_t i = 0; i < f->fields; i++)
        for (size_t k = planes.from; k < planes.end; k++)
            for (size_t line = 0; line < f->lines; line++, room += bytes) {
                char *place =
                    (char *)f->field + i * f->apart + k * f->plane + line * f->line + rows.from * f->row;
                memcpy(out ? room : place, out ? place : room, bytes);
            }
}

static int neighbour(const struct consistent *c, int slot, int side)
{
    const int step = slot == DEPTH ? c->part.along[1].ranks : 1;
    return ranks_me(c->part.ranks) + (side == 0 ? -step : step);
}

static void add_pieces(struct messages_of *m, int side, struct range send, struct range receive)
{
    const struct part_fields *f = m->fields;
    const int with = neighbour(m->c, m->slot, side);
    if (m->slot == 1) {
        char *const *room = m->c->part.room + 2 * side;
        pack(m->c, f, send, true, room[0]);
        m->received[side] = receive;
        m->piece[m->pieces++] =
            (struct ranks_piece){with, room[0], room[1], bytes_of_rows(m->c, f, length(send)),
                                 bytes_of_rows(m->c, f, length(receive))};
        return;
    }
    for (size_t i = 0; i < f->fields; i++) {
        char *field = (char *)f->field + i * f->apart;
        m->piece[m->pieces++] =
            (struct ranks_piece){with, field + send.from * f->plane, field + receive.from * f->plane,
                                 length(send) * f->plane, length(receive) * f->plane};
    }
}

static void send_all(struct messages_of *m)
{
    ranks_exchange(m->c->part.ranks, m->pieces, m->piece);
    for (int side = 0; side < 2 && m->slot == 1; side++)
        if (length(m->received[side]) > 0)
            pack(m->c, m->fields, m->received[side], false, m->c->part.room[2 * side + 1]);
}

/* Is anything of the fields shared along the slot? */
static bool shared_along(const struct consistent *c, int slot, const struct part_fields *f)
{
    return c->part.along[slot].ranks > 1 && (slot == DEPTH ? f->plane : f->row) > 0;
}

/* Rows of own planes first, then planes with all rows of the window, so that corners are right. */
void part_exchange(const struct consistent *c, const struct part_fields *fields)
{
    if (fields->fields > MOST_FIELDS) return;
    for (int slot = 1; slot < 3; slot++) {
        const struct part_axis *a = &c->part.along[slot];
        struct messages_of m = {.c = c, .fields = fields, .slot = slot};
        if (!shared_along(c, slot, fields)) continue;
        if (a->me > 0) add_pieces(&m, 0, (struct range){a->own, a->own + a->halo}, (struct range){0, a->own});
        if (a->me + 1 < a->ranks)
            add_pieces(&m, 1, (struct range){a->end - a->halo, a->end}, (struct range){a->end, c->n[slot]});
        send_all(&m);
    }
}

double part_bytes(const struct consistent *c, const struct part_fields *f)
{
    const struct part_axis *y = &c->part.along[1], *z = &c->part.along[DEPTH];
    const int beside = (y->me > 0) + (y->me + 1 < y->ranks), above = (z->me > 0) + (z->me + 1 < z->ranks);
    const double rows = shared_along(c, 1, f) ? (double)bytes_of_rows(c, f, y->halo) : 0;
    const double planes = shared_along(c, DEPTH, f) ? (double)(f->fields * z->halo * f->plane) : 0;
    return beside * rows + above * planes;
}

void part_sweep(const struct consistent *c, int slot, bool forward, size_t reach,
                const struct part_fields *fields, void (*work)(void *context, size_t from, size_t end),
                void *context)
{
    const struct part_axis *a = &c->part.along[slot];
    const struct range none = {0, 0};
    const struct range low = {a->own, a->own + reach}, high = {a->end - reach, a->end};
    struct messages_of before = {.c = c, .fields = fields, .slot = slot}, after = before;
    if (forward ? a->me > 0 : a->me + 1 < a->ranks)
        add_pieces(&before, forward ? 0 : 1, none,
                   forward ? (struct range){a->own - reach, a->own} : (struct range){a->end, a->end + reach});
    send_all(&before);
    work(context, a->own, a->end);
    if (forward ? a->me + 1 < a->ranks : a->me > 0)
        add_pieces(&after, forward ? 1 : 0, forward ? high : low, none);
    send_all(&after);
}
