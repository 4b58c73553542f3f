/* Parts of a body (part.h). */
#include "method/consistent/galerkin/galerkin.h"

#include "base/memory.h"
#include "base/sums.h"
#include "scene/absorbing_layers.h"

#include <string.h>

/* --- Sharing the planes ------------------------------------------------------------------------------- */

static size_t rounded_up(size_t n)
{
    return (n + PART_UNIT - 1) / PART_UNIT * PART_UNIT;
}

/* Planes that the operator reaches: N K, of the dissipation N B^T B; without sweeps K alone. */
static size_t reach_of(const struct consistent_options *options)
{
    enum { DIFFERENCE = 4 };
    const size_t degree = (size_t)options->degree, sweeps = (size_t)options->sweeps;
    const size_t narrow = options->dissipation > 0 && degree < DIFFERENCE ? DIFFERENCE : degree;
    return sweeps == 0 ? degree : sweeps * degree + narrow;
}

/* Planes that a rank has at least: the halo of its neighbours; at the ends a whole layer and all that it moves. */
static size_t least_of(const struct consistent *c, int rank, int ranks)
{
    const int face = 2 * (c->dimension - 1);
    const size_t low = rank == 0 ? c->layer[face] : 0, high = rank == ranks - 1 ? c->layer[face + 1] : 0;
    const size_t layers = low + high;
    return rounded_up(c->part.halo + (layers > 0 ? layers + 1 : 0));
}

/* What a plane of the body costs; 1: no layers. */
static double cost_of(const struct consistent *c, size_t k)
{
    const int last = c->dimension - 1;
    double plain = k >= c->layer[2 * last] && k + c->layer[2 * last + 1] < c->part.whole ? 1 : 0;
    for (int axis = 0; axis < last; axis++)
        plain *= 1 - (double)(c->layer[2 * axis] + c->layer[2 * axis + 1]) / (double)c->n[c->slot[axis]];
    return plain + layer_cost(c->model.scene) * (1 - plain);
}

/* Half of what the planes from k on cost that go to one rank. */
static double half_unit(const struct consistent *c, size_t k)
{
    double sum = 0;
    for (size_t i = k; i < k + PART_UNIT && i < c->part.whole; i++)
        sum += cost_of(c, i) / 2;
    return sum;
}

/* Bounds of so many ranks, of costs as even as can be; false: there are too many ranks. */
static bool share(const struct consistent *c, int ranks, size_t *bound)
{
    const size_t count = (size_t)ranks;
    double all = 0, done = 0;
    for (size_t k = 0; k < c->part.whole; k++)
        all += cost_of(c, k);
    size_t rank = 0;
    for (size_t k = 0; k < c->part.whole; k++) {
        if (k % PART_UNIT == 0)
            while (rank < count && done + half_unit(c, k) >= all * (double)rank / (double)count)
                bound[rank++] = k;
        done += cost_of(c, k);
    }
    while (rank <= count)
        bound[rank++] = c->part.whole;
    for (int r = 0; r + 1 < ranks; r++)
        if (bound[r + 1] < bound[r] + least_of(c, r, ranks)) bound[r + 1] = bound[r] + least_of(c, r, ranks);
    for (int r = ranks - 1; r > 0; r--) {
        const size_t least = least_of(c, r, ranks);
        if (bound[r + 1] < least) return false;
        if (bound[r] > bound[r + 1] - least) bound[r] = (bound[r + 1] - least) / PART_UNIT * PART_UNIT;
    }
    for (int r = 0; r < ranks; r++)
        if (bound[r + 1] < bound[r] + least_of(c, r, ranks)) return false;
    return true;
}

selas_status part_lay(struct consistent *c, struct messages *messages)
{
    struct rank_part *part = &c->part;
    const size_t whole = c->n[DEPTH];
    part->whole = part->end = whole;
    part->ranks = c->model.scene->ranks;
    if (part->ranks == NULL) return SELAS_OK;
    part->halo = rounded_up(reach_of(&c->options));
    int ranks = ranks_count(part->ranks);
    part->bound = array_new((size_t)ranks + 1, sizeof *part->bound);
    if (part->bound == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the ranks");
    while (ranks > 1 && !share(c, ranks, part->bound))
        ranks--;
    if (ranks == 1) part->bound[1] = whole;
    if (ranks < ranks_count(part->ranks) && ranks_fixed(part->ranks))
        return fail(
            messages, SELAS_UNSUPPORTED,
            "%d of the %d ranks of the communicator would have work: the body has %zu planes over its "
            "last axis, a rank needs at least %zu; open it with %d ranks",
            ranks, ranks_count(part->ranks), whole, least_of(c, -1, 1), ranks);
    if (ranks < ranks_count(part->ranks))
        warn(messages,
             "%d of %d ranks have work: the body has %zu planes over its last axis, a rank needs at least "
             "%zu of them "
             "and the points of absorbing layers across that axis",
             ranks, ranks_count(part->ranks), whole, least_of(c, -1, 1));
    ranks_take(part->ranks, ranks);
    if (ranks_idle(part->ranks)) return SELAS_STOPPED;
    const size_t me = (size_t)ranks_me(part->ranks);
    const size_t from = part->bound[me], end = part->bound[me + 1];
    part->first = from < part->halo ? 0 : from - part->halo;
    part->own = from - part->first;
    part->end = end - part->first;
    c->n[DEPTH] = (end + part->halo < whole ? end + part->halo : whole) - part->first;
    return SELAS_OK;
}

void part_free(struct consistent *c)
{
    for (size_t i = 0; i < c->part.matrices; i++)
        if (c->part.cut[i] != c->part.matrix[i]) band_free(c->part.cut[i]);
    array_free(c->part.bound);
}

/* --- What the window has of the whole ----------------------------------------------------------------- */

const struct band *part_matrix(struct consistent *c, const struct band *whole)
{
    struct rank_part *part = &c->part;
    if (whole == NULL || part->whole == c->n[DEPTH]) return whole;
    for (size_t i = 0; i < part->matrices; i++)
        if (part->matrix[i] == whole) return part->cut[i];
    struct band *cut = part->matrices == PART_MATRICES ? NULL : band_cut(whole, part->first, c->n[DEPTH]);
    if (cut == NULL) return NULL;
    part->matrix[part->matrices] = whole;
    part->cut[part->matrices++] = cut;
    return cut;
}

bool part_terms(struct consistent *c, struct tensor_term *terms, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        const struct band **depth = &terms[i].matrix[DEPTH];
        if (*depth == NULL) continue;
        *depth = part_matrix(c, *depth);
        if (*depth == NULL) return false;
    }
    return true;
}

size_t part_plane(const struct consistent *c, size_t plane)
{
    return plane >= c->part.first && plane - c->part.first < c->n[DEPTH] ? plane - c->part.first : SIZE_MAX;
}

size_t part_face(const struct consistent *c, int face)
{
    const int slot = c->slot[face / 2];
    if (slot == DEPTH) return part_plane(c, face % 2 == 0 ? 0 : c->part.whole - 1);
    return face % 2 == 0 ? 0 : c->n[slot] - 1;
}

int part_holder(const struct consistent *c, size_t plane)
{
    int rank = 0;
    while (c->part.bound != NULL && plane >= c->part.bound[rank + 1])
        rank++;
    return rank;
}

/* --- Exchange ----------------------------------------------------------------------------------------- */

/* Planes `from` .. `end` - 1 of fields, sent or received. */
struct planes {
    size_t from, end;
};

struct fields {
    char *field;
    size_t fields, apart, plane;
};

enum { MOST_FIELDS = 32 };

static void add_pieces(const struct fields *f, int with, struct planes send, struct planes receive,
                       size_t *pieces, struct ranks_piece *piece)
{
    for (size_t i = 0; i < f->fields; i++) {
        char *field = f->field + i * f->apart;
        piece[(*pieces)++] =
            (struct ranks_piece){with, field + send.from * f->plane, field + receive.from * f->plane,
                                 (send.end - send.from) * f->plane, (receive.end - receive.from) * f->plane};
    }
}

void part_exchange(const struct consistent *c, void *field, size_t fields, size_t apart, size_t plane)
{
    const struct rank_part *part = &c->part;
    const struct fields f = {field, fields, apart, plane};
    struct ranks_piece piece[2 * MOST_FIELDS];
    size_t pieces = 0;
    if (part->ranks == NULL || fields > MOST_FIELDS) return;
    const int me = ranks_me(part->ranks);
    if (me > 0)
        add_pieces(&f, me - 1, (struct planes){part->own, part->own + part->halo},
                   (struct planes){0, part->own}, &pieces, piece);
    if (me + 1 < ranks_count(part->ranks))
        add_pieces(&f, me + 1, (struct planes){part->end - part->halo, part->end},
                   (struct planes){part->end, c->n[DEPTH]}, &pieces, piece);
    ranks_exchange(part->ranks, pieces, piece);
}

double part_largest(const struct consistent *c, double value)
{
    ranks_largest(c->part.ranks, 1, &value);
    return value;
}

double part_product(const struct consistent *c, const double *x, const double *y)
{
    double sum = 0;
    if (c->part.ranks == NULL) return sum_of_products(c->model.unknowns, x, y, c->threads);
    for (size_t component = 0; component < (size_t)c->dimension; component++) {
        const size_t from = component * c->volume + c->part.own * c->plane;
        sum += sum_of_products((c->part.end - c->part.own) * c->plane, x + from, y + from, c->threads);
    }
    return sum;
}

void part_sweep(const struct consistent *c, bool forward, size_t reach, double *field, size_t fields,
                size_t apart, size_t plane, void (*work)(void *context, size_t from, size_t end),
                void *context)
{
    const struct rank_part *part = &c->part;
    const struct fields f = {(char *)field, fields, apart, plane};
    const struct planes none = {0, 0};
    struct ranks_piece piece[MOST_FIELDS];
    size_t pieces = 0;
    const int me = ranks_me(part->ranks), count = ranks_count(part->ranks);
    const int before = forward ? me - 1 : me + 1, after = forward ? me + 1 : me - 1;
    if (before >= 0 && before < count)
        add_pieces(&f, before, none,
                   forward ? (struct planes){part->own - reach, part->own}
                           : (struct planes){part->end, part->end + reach},
                   &pieces, piece);
    ranks_exchange(part->ranks, pieces, piece);
    work(context, part->own, part->end);
    pieces = 0;
    if (after >= 0 && after < count)
        add_pieces(&f, after,
                   forward ? (struct planes){part->end - reach, part->end}
                           : (struct planes){part->own, part->own + reach},
                   none, &pieces, piece);
    ranks_exchange(part->ranks, pieces, piece);
}
