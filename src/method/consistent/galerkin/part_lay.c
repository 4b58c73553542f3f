/* Sharing a body among ranks (part.h): a grid of blocks. */
#include "method/consistent/galerkin/galerkin.h"

#include "base/memory.h"
#include "scene/absorbing_layers.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static int axis_of(const struct consistent *c, int slot)
{
    return slot == DEPTH ? c->dimension - 1 : slot;
}

/* Windows are whole numbers of so many planes or rows. */
static size_t unit_of(int slot)
{
    return slot == DEPTH ? PART_PLANES : PART_STRIP;
}

static size_t rounded_up(size_t n, size_t unit)
{
    return (n + unit - 1) / unit * unit;
}

/* Control values that the operator reaches: N K, of the dissipation N B^T B; without sweeps K alone, N G in layers.
 * Who looks reaches two (tuned_seen). */
static size_t reach_of(const struct consistent *c)
{
    enum { DIFFERENCE = 4 };
    const struct consistent_options *options = &c->options;
    const size_t degree = (size_t)options->degree, sweeps = (size_t)options->sweeps;
    const size_t narrow = options->dissipation > 0 && degree < DIFFERENCE ? DIFFERENCE : degree;
    const size_t seen = degree > 1 ? degree : 2;
    if (sweeps == 0) return seen + (layer_anywhere(c->model.scene) ? exact_inverse_half(options) : 0);
    return sweeps * degree + narrow;
}

/* What a rank has at least: the halo of its neighbours; at the ends a whole layer and all that it moves. */
static size_t least_of(const struct consistent *c, int slot, int rank, int ranks)
{
    const int face = 2 * axis_of(c, slot);
    const size_t low = rank == 0 ? c->layer[face] : 0, high = rank == ranks - 1 ? c->layer[face + 1] : 0;
    const size_t layers = low + high, ends = ((size_t)c->options.degree + 1) / 2;
    return rounded_up(c->part.along[slot].halo + (layers > 0 ? layers + ends : 0), unit_of(slot));
}

/* What a plane or row costs; 1: one without layers. */
static double cost_of(const struct consistent *c, int slot, size_t k)
{
    const int across = axis_of(c, slot);
    double slabs = k < c->layer[2 * across] || k + c->layer[2 * across + 1] >= c->n[slot] ? 1 : 0;
    for (int axis = 0; axis < c->dimension; axis++)
        if (axis != across)
            slabs += (double)(c->layer[2 * axis] + c->layer[2 * axis + 1]) / (double)c->n[c->slot[axis]];
    return 1 + layer_cost(c->model.scene) * slabs;
}

/* What those of them from .. end - 1 cost. */
static double cost_between(const struct consistent *c, int slot, size_t from, size_t end)
{
    double sum = 0;
    for (size_t k = from; k < end && k < c->n[slot]; k++)
        sum += cost_of(c, slot, k);
    return sum;
}

/* Bounds of so many ranks along a slot, of costs as even as can be; false: there are too many ranks. */
static bool share(const struct consistent *c, int slot, int ranks, size_t *bound)
{
    const size_t count = (size_t)ranks, whole = c->n[slot], unit = unit_of(slot);
    const double all = cost_between(c, slot, 0, whole);
    double done = 0;
    size_t rank = 0;
    for (size_t k = 0; k < whole; k++) {
        if (k % unit == 0) {
            const double half = cost_between(c, slot, k, k + unit) / 2;
            while (rank < count && done + half >= all * (double)rank / (double)count)
                bound[rank++] = k;
        }
        done += cost_of(c, slot, k);
    }
    while (rank <= count)
        bound[rank++] = whole;
    for (int r = 0; r + 1 < ranks; r++)
        if (bound[r + 1] < bound[r] + least_of(c, slot, r, ranks))
            bound[r + 1] = bound[r] + least_of(c, slot, r, ranks);
    for (int r = ranks - 1; r > 0; r--) {
        const size_t least = least_of(c, slot, r, ranks);
        if (bound[r + 1] < least) return false;
        if (bound[r] > bound[r + 1] - least) bound[r] = (bound[r + 1] - least) / unit * unit;
    }
    for (int r = 0; r < ranks; r++)
        if (bound[r + 1] < bound[r] + least_of(c, slot, r, ranks)) return false;
    return true;
}

/* What the largest window along a slot costs. */
static double largest_window(const struct consistent *c, int slot, int ranks, const size_t *bound)
{
    const size_t halo = c->part.along[slot].halo;
    double largest = 0;
    for (int r = 0; r < ranks; r++) {
        const size_t from = bound[r] > halo ? bound[r] - halo : 0;
        const double cost = cost_between(c, slot, from, bound[r + 1] + halo);
        largest = cost > largest ? cost : largest;
    }
    return largest;
}

/* Can rows be shared too? General ground and the exact mass keep whole planes; so do dampers across depth alone, whose
 * power is told. */
static bool shares_rows(const struct consistent *c)
{
    const struct boundary *boundary = c->model.scene->boundary;
    bool side = false, end = false;
    for (int face = 0; face < 2 * c->dimension; face++)
        *(c->slot[face / 2] == DEPTH ? &end : &side) |= boundary_damps(&boundary[face]);
    return c->dimension == 3 && !c->options.general && c->options.sweeps > 0 && (side || !end);
}

/* Ranks over y by depth that a test asks for: SELAS_RANK_GRID=2x3. */
static bool asked_for(int rows, int planes)
{
    const char *grid = getenv("SELAS_RANK_GRID");
    int y, z;
    return grid == NULL || sscanf(grid, "%dx%d", &y, &z) != 2 || (y == rows && z == planes);
}

/* The grid of so many ranks whose largest window costs least; 0 ranks over y: there is none. */
static int choose_rows(const struct consistent *c, int ranks, size_t *rows, size_t *planes)
{
    int best = 0;
    double least = 0;
    const size_t most = shares_rows(c) ? c->n[1] / PART_STRIP : 0;
    for (int y = 1; y == 1 || (y <= ranks && (size_t)y <= most); y++) {
        if (ranks % y != 0 || !asked_for(y, ranks / y) || !share(c, DEPTH, ranks / y, planes)) continue;
        if (y > 1 && !share(c, 1, y, rows)) continue;
        const double wide = y > 1 ? largest_window(c, 1, y, rows) : cost_between(c, 1, 0, c->n[1]);
        const double cost = wide * largest_window(c, DEPTH, ranks / y, planes);
        if (best > 0 && cost >= least) continue;
        best = y;
        least = cost;
    }
    return best;
}

/* This rank's part along a slot, of `ranks`. */
static bool take_part(struct consistent *c, int slot, int me, int ranks)
{
    struct part_axis *along = &c->part.along[slot];
    const size_t whole = c->n[slot];
    along->me = me;
    along->ranks = ranks;
    along->bound = array_new((size_t)ranks + 1, sizeof *along->bound);
    if (along->bound == NULL) return false;
    along->bound[ranks] = whole;
    if (ranks > 1) share(c, slot, ranks, along->bound);
    return true;
}

static void take_window(struct consistent *c, int slot)
{
    struct part_axis *along = &c->part.along[slot];
    const size_t from = along->bound[along->me], end = along->bound[along->me + 1];
    along->first = from < along->halo ? 0 : from - along->halo;
    along->own = from - along->first;
    along->end = end - along->first;
    c->n[slot] = (end + along->halo < along->whole ? end + along->halo : along->whole) - along->first;
}

/* Planes of each turn: all in the last if they are few, or if a layer across depth, which adds to its planes together,
 * reaches planes that are sent before. */
static void lay_turns(struct consistent *c)
{
    enum { FURTHER = PART_PLANES, LEAST = 2 * PART_PLANES };
    struct part_range *made = c->part.made, *sent = c->part.sent;
    const struct part_axis *a = &c->part.along[DEPTH];
    const int face = 2 * axis_of(c, DEPTH);
    const size_t low = a->me == 0 ? 0 : a->halo, high = a->me + 1 == a->ranks ? 0 : a->halo;
    const size_t below = low > 0 || c->layer[face] == 0 ? 0 : c->layer[face] + a->halo + FURTHER;
    const size_t above = high > 0 || c->layer[face + 1] == 0 ? 0 : c->layer[face + 1] + a->halo + FURTHER;
    const size_t from = a->own + low, end = a->end - (high > 0 ? high : above);
    for (int turn = 0; turn < PART_TURNS; turn++)
        made[turn] = sent[turn] = (struct part_range){a->own, turn < PART_LAST ? a->own : a->end};
    if (a->end < a->own + low + high + below + above + 2 * FURTHER + LEAST) return;
    sent[PART_LOW].end = from;
    sent[PART_HIGH] = (struct part_range){a->end - high, a->end};
    sent[PART_FIRST] = (struct part_range){from, from};
    if (part_rows(&c->part) && below == 0)
        sent[PART_FIRST].end += (end - from) * 3 / 4 / FURTHER * FURTHER - FURTHER;
    sent[PART_LAST] = (struct part_range){sent[PART_FIRST].end, a->end - high};
    const size_t further = sent[PART_FIRST].end > from ? sent[PART_FIRST].end + FURTHER : 0;
    made[PART_LOW].end = low > 0 ? from + FURTHER : from;
    made[PART_HIGH] = (struct part_range){high > 0 ? a->end - high - FURTHER : a->end, a->end};
    made[PART_FIRST] = (struct part_range){made[PART_LOW].end, further > 0 ? further : made[PART_LOW].end};
    made[PART_LAST] = (struct part_range){made[PART_FIRST].end, made[PART_HIGH].from};
}

/* Room for rows of all fields. */
static bool lay_room(struct consistent *c)
{
    if (!part_rows(&c->part)) return true;
    const size_t planes = c->n[DEPTH], bytes = PART_NUMBERS * planes * c->n[0] * sizeof(double);
    for (int i = 0; i < 4; i++) {
        c->part.room[i] = array_new(bytes * c->part.along[1].halo, 1);
        if (c->part.room[i] == NULL) return false;
    }
    return true;
}

/* How many ranks have work, and how many of them over y. */
static selas_status lay_grid(struct consistent *c, int *used, int *over_y, struct messages *messages)
{
    const int count = ranks_count(c->part.ranks);
    size_t *bound = array_new(2 * ((size_t)count + 1), sizeof *bound);
    if (bound == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the ranks");
    *used = count;
    while (*used > 1 && (*over_y = choose_rows(c, *used, bound, bound + count + 1)) == 0)
        (*used)--;
    if (*used == 1) *over_y = 1;
    array_free(bound);
    char body[160];
    int length =
        snprintf(body, sizeof body, "the body has %zu planes over its last axis, a rank needs at least %zu",
                 c->n[DEPTH], least_of(c, DEPTH, -1, 1));
    if (shares_rows(c))
        snprintf(body + length, sizeof body - (size_t)length, "; and %zu rows over y, of which it needs %zu",
                 c->n[1], least_of(c, 1, -1, 1));
    if (*used < count && ranks_fixed(c->part.ranks))
        return fail(messages, SELAS_UNSUPPORTED,
                    "%d of the %d ranks of the communicator would have work: %s; open it with as many", *used,
                    count, body);
    if (*used < count)
        warn(messages,
             "of %d ranks %d can work: %s; the first and the last ones have all points of absorbing layers "
             "besides",
             count, *used, body);
    return SELAS_OK;
}

selas_status part_lay(struct consistent *c, struct messages *messages)
{
    struct rank_part *part = &c->part;
    int used = 1, over_y = 1;
    for (int slot = 0; slot < 3; slot++)
        part->along[slot] = (struct part_axis){.whole = c->n[slot], .end = c->n[slot], .ranks = 1};
    part->made[PART_LAST] = part->sent[PART_LAST] = (struct part_range){0, c->n[DEPTH]};
    part->ranks = c->model.scene->ranks;
    if (part->ranks == NULL) return SELAS_OK;
    for (int slot = 1; slot < 3; slot++)
        part->along[slot].halo = rounded_up(reach_of(c), unit_of(slot));
    const selas_status status = lay_grid(c, &used, &over_y, messages);
    if (status != SELAS_OK) return status;
    ranks_take(part->ranks, used);
    if (ranks_idle(part->ranks)) return SELAS_STOPPED;
    const int me = ranks_me(part->ranks);
    if (!take_part(c, 1, me % over_y, over_y) || !take_part(c, DEPTH, me / over_y, used / over_y))
        return fail(messages, SELAS_NO_MEMORY, "no memory for the ranks");
    for (int slot = 1; slot < 3; slot++)
        take_window(c, slot);
    lay_turns(c);
    return lay_room(c) ? SELAS_OK : fail(messages, SELAS_NO_MEMORY, "no memory for the ranks");
}

/* --- What is expected of it: Eq (R2b) of doc/developers/ranks.md for each block ---------------------------- */

/* Planes or rows from .. end - 1 that lie in an absorbing layer. */
static double layers_between(const struct consistent *c, int slot, size_t from, size_t end)
{
    const size_t *layer = &c->layer[2 * axis_of(c, slot)], whole = c->part.along[slot].whole;
    double count = 0;
    for (size_t k = from; k < end; k++)
        count += k < layer[0] || k + layer[1] >= whole ? 1 : 0;
    return count;
}

/* What part `part` along a slot has of its own and in its window, and of how many neighbours. */
struct side {
    double own, window, layers;
    int neighbours;
};

static struct side side_of(const struct part_axis *along, const struct consistent *c, int slot, int part)
{
    const size_t from = along->bound != NULL ? along->bound[part] : 0,
                 end = along->bound != NULL ? along->bound[part + 1] : along->whole;
    struct side side = {.own = (double)(end - from), .layers = layers_between(c, slot, from, end)};
    side.neighbours = (part > 0) + (part + 1 < along->ranks);
    side.window = side.own + (double)(from < along->halo ? from : along->halo) +
                  (double)(along->whole - end < along->halo ? along->whole - end : along->halo);
    if (part == 0 && along->ranks == 1) side.window = side.own;
    return side;
}

struct ranks_outlook part_outlook(const struct consistent *c)
{
    const struct part_axis *y = &c->part.along[1], *z = &c->part.along[DEPTH];
    const double x = (double)c->part.along[0].whole, beside = layers_between(c, 0, 0, c->part.along[0].whole);
    double most = 0, longest = 0, sum = 0;
    for (int rank = 0; rank < y->ranks * z->ranks; rank++) {
        const struct side rows = side_of(y, c, 1, rank % y->ranks),
                          planes = side_of(z, c, DEPTH, rank / y->ranks);
        const double points = x * rows.own * planes.own;
        const double work = points + layer_cost(c->model.scene) *
                                         (beside * rows.own * planes.own + x * rows.layers * planes.own +
                                          x * rows.own * planes.layers);
        const double sent = (double)(sizeof(double) * (size_t)c->dimension) * x *
                            (rows.neighbours * (double)y->halo * planes.own +
                             planes.neighbours * (double)z->halo * rows.window);
        most = fmax(most, work);
        longest =
            fmax(longest, PART_POINT * work + PART_HALO_POINT * (x * rows.window * planes.window - points) +
                              RANKS_BYTE * sent + RANKS_MESSAGE * (rows.neighbours + planes.neighbours));
        sum += work;
    }
    const double mean = sum / (y->ranks * z->ranks);
    return (struct ranks_outlook){.balance = mean / most, .efficiency = PART_POINT * mean / longest};
}

void part_free(struct consistent *c)
{
    for (size_t i = 0; i < c->part.matrices; i++)
        if (c->part.matrix[i].cut != c->part.matrix[i].whole) band_free(c->part.matrix[i].cut);
    for (int slot = 0; slot < 3; slot++)
        array_free(c->part.along[slot].bound);
    for (int i = 0; i < 4; i++)
        array_free(c->part.room[i]);
}
