/* Lists of neighbours for eight particles at a time (gather.h), and the choice between them
 * and lists of single particles. The choice is made once, from the reference places, so that it does not
 * depend on the history of the run. */
#include "method/updated_lagrangian/updated_lagrangian.h"

#include "base/memory.h"
#include "base/vectors.h"

/* Eight particles may have this many times the neighbours of one between them before they are better summed
 * one by one. */
static const double MOST = 2;

/* First entry from k on of particle i's list that its kernel can reach before the next search; the end of the
 * list if there is none. Where lengths differ the lists hold many that it cannot. */
static size_t reachable(const struct updated *updated, size_t i, size_t k)
{
    const struct neighbours *near = &updated->neighbours;
    const size_t points = updated->points;
    for (; k < near->start[i + 1] && !updated->even; k++) {
        const size_t j = near->index[k], source = j < points ? j : updated->ghost[j - points].source;
        const double most =
            updated->reach * (updated->length[i] + updated->length[source]) / 2 + updated->skin;
        double square = 0;
        for (size_t a = 0; a < (size_t)updated->dimension; a++) {
            const double d = updated->searched[3 * i + a] - updated->searched[3 * j + a];
            square += d * d;
        }
        if (square < most * most) break;
    }
    return k;
}

/* Merges the lists of particles i ... last - 1, at most eight, into ascending distances in memory; returns how
 * many. Adds the number of pairs to *pairs. */
static uint32_t merge(const struct updated *updated, size_t i, size_t last, size_t *pairs)
{
    const struct neighbours *near = &updated->neighbours;
    int32_t *shift = updated->shift + near->start[i];
    size_t next[GROUP] = {0};
    uint32_t count = 0;
    for (size_t n = i; n < last; n++)
        next[n - i] = reachable(updated, n, near->start[n]);
    for (;;) {
        int64_t least = INT64_MAX;
        for (size_t n = i; n < last; n++) {
            if (next[n - i] == near->start[n + 1]) continue;
            const int64_t distance = (int64_t)near->index[next[n - i]] - (int64_t)n;
            if (distance < least) least = distance;
        }
        if (least == INT64_MAX) return count;
        shift[count++] = (int32_t)least;
        for (size_t n = i; n < last; n++) {
            if (next[n - i] == near->start[n + 1] || (int64_t)near->index[next[n - i]] - (int64_t)n != least)
                continue;
            next[n - i] = reachable(updated, n, next[n - i] + 1);
            ++*pairs;
        }
    }
}

/* Merges the lists of the particles from .. end - 1, groups of eight from the first one on. */
static selas_status merge_all(struct updated *updated, size_t from, size_t end, struct messages *messages)
{
    if (updated->shift_room < updated->neighbours.pair_room) {
        array_free(updated->shift);
        updated->shift_room = updated->neighbours.pair_room;
        updated->shift = array_new(updated->shift_room, sizeof *updated->shift);
        if (updated->shift == NULL) {
            updated->shift_room = 0;
            return fail(messages, SELAS_NO_MEMORY, "no memory for the neighbours of %zu particles",
                        end - from);
        }
    }
    size_t pairs = 0;
#pragma omp parallel for schedule(static) reduction(+ : pairs) if (end - from >= UPDATED_PARALLEL)
    for (size_t i = from; i < end; i += GROUP)
        updated->shifts[(i - from) / GROUP] = merge(updated, i, i + GROUP < end ? i + GROUP : end, &pairs);
    updated->merged = pairs;
    return SELAS_OK;
}

selas_status updated_merge_lists(struct updated *updated, struct messages *messages)
{
    return merge_all(updated, updated->from, updated->from + updated->own, messages);
}

/* The places before the first and behind the last are far away from everything. */
static void fill_ends(struct updated *updated)
{
    const size_t places = updated->points + updated->ghosts;
    for (size_t k = 0; k < updated->stride; k++) {
        if (k >= GROUP && k < GROUP + places) continue;
        for (size_t a = 0; a < (size_t)updated->dimension; a++)
            updated->planes[a * updated->stride + k] = 1e6 * updated->reach * updated->longest;
        updated->planes[updated->layout.density * updated->stride + k] = updated->material->density;
        updated->planes[updated->layout.length * updated->stride + k] = 1;
    }
}

selas_status updated_take_packed(struct updated *updated, struct messages *messages)
{
    const size_t places = updated->points + updated->ghosts;
    double **const packed = updated->ordered ? &updated->planes : &updated->record;
    updated->stride = (places + 4 * GROUP - 1) / GROUP * GROUP;
    array_free(*packed);
    *packed =
        array_new(updated->layout.size * (updated->ordered ? updated->stride : places), sizeof **packed);
    if (*packed == NULL)
        return fail(messages, SELAS_NO_MEMORY, "no memory for %zu particles", updated->points);
    if (updated->ordered) fill_ends(updated);
    return SELAS_OK;
}

selas_status updated_one_by_one(struct updated *updated, struct messages *messages)
{
    array_free(updated->planes);
    array_free(updated->shifts);
    array_free(updated->shift);
    updated->ordered = false;
    updated->planes = NULL;
    updated->shifts = NULL;
    updated->shift = NULL;
    updated->shift_room = 0;
    return updated_take_packed(updated, messages);
}

/* The groups that begin with own particles: where the first one does, and where the last one ends. */
static void own_groups(const struct updated *updated, size_t *from, size_t *end)
{
    const size_t before = updated->cloud->first, whole = updated->cloud->whole;
    *from = (before + updated->from + GROUP - 1) / GROUP * GROUP;
    *end = (before + updated->from + updated->own + GROUP - 1) / GROUP * GROUP;
    *end = (*end < whole ? *end : whole) - before;
    *from -= before;
}

selas_status updated_choose_order(struct updated *updated, struct messages *messages)
{
    double merged[2] = {0, 0}; /* of pairs of eight particles each, of single ones */
    size_t from, end;
    own_groups(updated, &from, &end);
    selas_status status = SELAS_OK;
    updated->ordered = updated->cubic && updated->points + updated->ghosts <= INT32_MAX;
    if (updated->ordered) {
        updated->shifts = array_new(updated->own / GROUP + 2, sizeof *updated->shifts);
        status = updated->shifts != NULL
                     ? merge_all(updated, from, end, messages)
                     : fail(messages, SELAS_NO_MEMORY, "no memory for %zu particles", updated->points);
    }
    status = updated_agree(updated, status, messages);
    if (status != SELAS_OK) return status;
    for (size_t i = from, group = 0; updated->shifts != NULL && i < end; i += GROUP)
        merged[0] += GROUP * (double)updated->shifts[group++];
    merged[1] = (double)updated->merged;
    ranks_sum(updated->part.ranks, 2, merged);
    updated->ordered = updated->ordered && merged[0] < MOST * merged[1];
    return updated->ordered ? updated_take_packed(updated, messages) : updated_one_by_one(updated, messages);
}
