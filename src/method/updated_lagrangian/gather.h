/* Sums over the neighbours of particles, a vector of pairs at a time. Inlined into the instances of
 * block_rates.c.
 *
 * Where particles are numbered in some order (lattices, rings) the neighbours of one stand at much the same
 * distances in memory as those of the next. So the lists of GROUP particles are merged into one of distances
 * in memory (order.c), and for each of them as many pairs as a vector holds are taken at once, with
 * contiguous loads from the planes of struct updated. A place that is no neighbour of some particle is out of
 * its reach, as the lists are complete: the slope of the kernel is 0 there and adds nothing.
 *
 * Else particles go one by one: the neighbours within reach are copied into a batch, component by component,
 * and a vector of them at a time meets the particle in all lanes; the last lanes are filled up with a place
 * that is far away.
 *
 * Either way the sums, in ascending order, do not depend on when the lists were made. */
#ifndef SELAS_METHOD_UPDATED_LAGRANGIAN_GATHER_H
#define SELAS_METHOD_UPDATED_LAGRANGIAN_GATHER_H

#include "method/updated_lagrangian/pairs.h"

/* Sums of the particles first ... last - 1, LANES in each; groups begin with the first own particle. Chunk by chunk of
 * all of them: what the neighbours of the first are read from is in the first-level cache still when the
 * second need it. */
INLINED void gather_ordered(const struct updated *updated, const int dimension, const struct pair_switches on,
                            size_t first, size_t last, struct lane_sums *sums)
{
    const struct pair_constants constants = pair_constants_of(updated);
    bool more = true;
    for (int k = 0; more; k += CHUNK) {
        more = false;
        for (size_t i = first; i < last; i += LANES) {
            const size_t group = (i - updated->from) / GROUP;
            const struct pairs pairs = {.own = updated_packed(updated, i),
                                        .other = updated_packed(updated, i),
                                        .own_stride = updated->stride,
                                        .other_stride = updated->stride,
                                        .shift = updated->shift +
                                                 updated->neighbours.start[updated->from + GROUP * group],
                                        .count = (int)updated->shifts[group]};
            if (k < pairs.count)
                add_chunk(updated, &constants, dimension, on, &pairs, k, &sums[(i - first) / LANES]);
            more = more || k + CHUNK < pairs.count;
        }
    }
}

enum {
    BATCH = 64,
    ROW = 72, /* rows of a power of two would crowd in few lines of the cache */
    COMPONENTS = 23
};

/* Components of up to BATCH neighbours. */
struct batch {
    double number[COMPONENTS][ROW];
    double own[COMPONENTS][LANES];
};

/* Copies neighbours within reach from entry *next of the list on; returns how many. */
INLINED int fill_batch(const struct updated *updated, const int dimension, const double *own, size_t last,
                       size_t *next, struct batch *batch)
{
    const struct updated_layout layout = updated->layout;
    const double reach = updated->reach * updated->reach;
    int count = 0;
    for (; *next < last && count < BATCH; ++*next) {
        const double *other = updated->record + layout.size * updated->neighbours.index[*next];
        double square = 0;
        for (int a = 0; a < dimension; a++)
            square += (own[a] - other[a]) * (own[a] - other[a]);
        const double length = (own[layout.length] + other[layout.length]) / 2;
        if (!(square < reach * length * length)) continue;
        for (size_t c = 0; c < layout.size; c++)
            batch->number[c][count] = other[c];
        count++;
    }
    for (int n = count; n % GROUP != 0; n++) {
        for (size_t c = 0; c < layout.size; c++)
            batch->number[c][n] = own[c];
        batch->number[0][n] += 1000 * updated->reach * updated->longest;
    }
    return count;
}

/* Sums of particle i into a lane: each GROUP of its neighbours is one vector, or several with sums of their
 * own, so that they are added in one order whatever the width. */
INLINED void gather_one(const struct updated *updated, const int dimension, const struct pair_switches on,
                        size_t i, size_t lane, struct lane_sums *sums)
{
    const struct pair_constants constants = pair_constants_of(updated);
    const double *own = updated->record + updated->layout.size * i;
    _Alignas(64) struct batch batch;
    _Alignas(64) struct lane_sums parts[PARTS] = {{.matrix = {{0}}}};
    int32_t shift[BATCH / GROUP];
    for (int k = 0; k < BATCH / GROUP; k++)
        shift[k] = GROUP * k;
    for (size_t c = 0; c < updated->layout.size; c++)
        for (int n = 0; n < LANES; n++)
            batch.own[c][n] = own[c];
    size_t next = updated->neighbours.start[i];
    const size_t last = updated->neighbours.start[i + 1];
    for (int count = BATCH; count == BATCH;) {
        count = fill_batch(updated, dimension, own, last, &next, &batch);
        for (int part = 0; part < PARTS; part++) {
            const struct pairs pairs = {.own = batch.own[0],
                                        .other = batch.number[0] + LANES * part,
                                        .own_stride = LANES,
                                        .other_stride = ROW,
                                        .shift = shift,
                                        .count = (count + GROUP - 1) / GROUP};
            for (int k = 0; k < pairs.count; k += CHUNK)
                add_chunk(updated, &constants, dimension, on, &pairs, k, &parts[part]);
        }
    }
    put_sums(dimension, parts, lane, sums);
}

#endif
