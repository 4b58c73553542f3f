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

static size_t length(struct part_range range)
{
    return range.end - range.from;
}

enum { MOST_FIELDS = 32 };

/* Messages of an exchange along a slot; over y of the rows of some planes. */
struct messages_of {
    const struct consistent *c;
    const struct part_fields *fields;
    int slot;
    struct part_range planes;
    size_t pieces;
    struct ranks_piece piece[2 * MOST_FIELDS];
};

struct part_fields part_values(const struct consistent *c, void *field, size_t fields, size_t number)
{
    return (struct part_fields){field, fields, c->volume * number, c->plane * number, c->n[0] * number};
}

static struct part_range own_planes(const struct consistent *c)
{
    return (struct part_range){c->part.along[DEPTH].own, c->part.along[DEPTH].end};
}

static size_t bytes_of_rows(const struct part_fields *f, size_t planes, size_t rows)
{
    return f->fields * planes * rows * f->row;
}

/* Room for rows of planes, those of planes before them in front. */
static char *room_of(const struct messages_of *m, int side, bool received, size_t rows)
{
    return m->c->part.room[2 * side + received] +
           bytes_of_rows(m->fields, m->planes.from - own_planes(m->c).from, rows);
}

/* Rows between fields and room. */
static void pack(const struct messages_of *m, int side, bool received, struct part_range rows)
{
    const struct part_fields *f = m->fields;
    const size_t bytes = length(rows) * f->row;
    char *room = room_of(m, side, received, length(rows));
    for (size_t i = 0; i < f->fields; i++)
        for (size_t k = m->planes.from; k < m->planes.end; k++, room += bytes) {
            char *place = (char *)f->field + i * f->apart + k * f->plane + rows.from * f->row;
            memcpy(received ? place : room, received ? room : place, bytes);
        }
}

static int neighbour(const struct consistent *c, int slot, int side)
{
    const int step = slot == DEPTH ? c->part.along[1].ranks : 1;
    return ranks_me(c->part.ranks) + (side == 0 ? -step : step);
}

static bool has_neighbour(const struct part_axis *a, int side)
{
    return side == 0 ? a->me > 0 : a->me + 1 < a->ranks;
}

/* What comes from a neighbour: the halo. */
static struct part_range received_from(const struct consistent *c, int slot, int side)
{
    const struct part_axis *a = &c->part.along[slot];
    return side == 0 ? (struct part_range){0, a->own} : (struct part_range){a->end, c->n[slot]};
}

static void add_pieces(struct messages_of *m, int side, struct part_range send, struct part_range receive)
{
    const struct part_fields *f = m->fields;
    const int with = neighbour(m->c, m->slot, side);
    if (m->slot == 1) {
        const size_t planes = length(m->planes);
        pack(m, side, false, send);
        m->piece[m->pieces++] = (struct ranks_piece){
            with, room_of(m, side, false, length(send)), room_of(m, side, true, length(receive)),
            bytes_of_rows(f, planes, length(send)), bytes_of_rows(f, planes, length(receive))};
        return;
    }
    for (size_t i = 0; i < f->fields; i++) {
        char *field = (char *)f->field + i * f->apart;
        m->piece[m->pieces++] =
            (struct ranks_piece){with, field + send.from * f->plane, field + receive.from * f->plane,
                                 length(send) * f->plane, length(receive) * f->plane};
    }
}

/* Halos along a slot begin to travel; over y those of some planes. */
static void depart(const struct consistent *c, const struct part_fields *fields, int slot,
                   struct part_range planes)
{
    const struct part_axis *a = &c->part.along[slot];
    struct messages_of m = {.c = c, .fields = fields, .slot = slot, .planes = planes};
    for (int side = 0; side < 2 && length(planes) > 0; side++)
        if (has_neighbour(a, side))
            add_pieces(&m, side,
                       side == 0 ? (struct part_range){a->own, a->own + a->halo}
                                 : (struct part_range){a->end - a->halo, a->end},
                       received_from(c, slot, side));
    ranks_depart(c->part.ranks, m.pieces, m.piece);
}

/* Rows that have come, of planes of a turn. */
static void take_rows(const struct consistent *c, const struct part_fields *fields, int turn)
{
    const struct messages_of m = {.c = c, .fields = fields, .slot = 1, .planes = c->part.sent[turn]};
    for (int side = 0; side < 2 && length(m.planes) > 0; side++)
        if (has_neighbour(&c->part.along[1], side)) pack(&m, side, true, received_from(c, 1, side));
}

/* Rows of own planes go before planes, which go with all rows of the window, so that corners are right. */
void part_send(const struct consistent *c, const struct part_fields *fields, int turn)
{
    const struct rank_part *part = &c->part;
    const bool rows = part_rows(part),
               apart = length(part->sent[PART_LOW]) + length(part->sent[PART_HIGH]) > 0;
    if (part->ranks == NULL || fields->fields > MOST_FIELDS) return;
    if (rows && turn == PART_FIRST) {
        ranks_arrive(part->ranks);
        take_rows(c, fields, PART_LOW);
        take_rows(c, fields, PART_HIGH);
    }
    if (apart && turn == (rows ? PART_FIRST : PART_HIGH)) depart(c, fields, DEPTH, own_planes(c));
    if (rows) depart(c, fields, 1, part->sent[turn]);
    if (turn < PART_LAST) return;
    ranks_arrive(part->ranks);
    if (rows) take_rows(c, fields, PART_FIRST);
    if (rows) take_rows(c, fields, PART_LAST);
    if (apart) return;
    depart(c, fields, DEPTH, own_planes(c));
    ranks_arrive(part->ranks);
}

void part_exchange(const struct consistent *c, const struct part_fields *fields)
{
    for (int turn = 0; turn < PART_TURNS; turn++)
        part_send(c, fields, turn);
}

int part_turn_of(const struct rank_part *part, size_t from, size_t end)
{
    for (int turn = 0; turn < PART_LAST; turn++) {
        const struct part_range *sent = &part->sent[turn];
        if (length(*sent) > 0 && from < sent->end && end > sent->from) return turn;
    }
    return PART_LAST;
}

double part_bytes(const struct consistent *c, const struct part_fields *f)
{
    const struct part_axis *y = &c->part.along[1], *z = &c->part.along[DEPTH];
    const int beside = has_neighbour(y, 0) + has_neighbour(y, 1),
              above = has_neighbour(z, 0) + has_neighbour(z, 1);
    return beside * (double)bytes_of_rows(f, length(own_planes(c)), y->halo) +
           above * (double)(f->fields * z->halo * f->plane);
}

void part_sweep(const struct consistent *c, int slot, bool forward, size_t reach,
                const struct part_fields *fields, void (*work)(void *context, size_t from, size_t end),
                void *context)
{
    const struct part_axis *a = &c->part.along[slot];
    const struct part_range none = {0, 0};
    const struct part_range low = {a->own, a->own + reach}, high = {a->end - reach, a->end};
    const struct part_range missing =
        forward ? (struct part_range){a->own - reach, a->own} : (struct part_range){a->end, a->end + reach};
    const int from = forward ? 0 : 1, to = 1 - from;
    struct messages_of before = {.c = c, .fields = fields, .slot = slot, .planes = own_planes(c)},
                       after = before;
    if (has_neighbour(a, from)) {
        add_pieces(&before, from, none, missing);
        ranks_exchange(c->part.ranks, before.pieces, before.piece);
        if (slot == 1) pack(&before, from, true, missing);
    }
    work(context, a->own, a->end);
    if (has_neighbour(a, to)) {
        add_pieces(&after, to, forward ? high : low, none);
        ranks_exchange(c->part.ranks, after.pieces, after.piece);
    }
}
