/* Sums over the neighbours of eight particles in sequence. Inlined into the instances of
 * rate.c.
 *
 * Where particles are numbered in some order (lattices, rings) the neighbours of one stand at much the same
 * distances in memory as those of the next. So the lists of eight particles are merged into one of distances
 * in memory, and for each of them eight pairs are taken at once, with contiguous loads from the planes of
 * struct updated. A place that is no neighbour of some particle is out of its reach, as the lists are
 * complete: the slope of the kernel is 0 there and adds nothing.
 *
 * Else particles go one by one: the neighbours within reach are copied into a batch, component by component,
 * and eight of them at a time meet the particle in all lanes; the last lanes are filled up with a place that
 * is far away.
 *
 * Either way the sums, in ascending order, do not depend on when the lists were made. */
#ifndef SELAS_METHOD_UPDATED_LAGRANGIAN_GATHER_H
#define SELAS_METHOD_UPDATED_LAGRANGIAN_GATHER_H

#include "method/updated_lagrangian/pairs.h"

/* Sums of the particles first ... last - 1, eight in each; first is a multiple of eight. Chunk by chunk of
 * all of them: what the neighbours of the first eight are read from is in the first-level cache still when
 * the second eight need it. */
INLINED void gather_eights(const struct updated *updated, const int dimension, const struct pair_switches on,
                           size_t first, size_t last, struct eight_sums *sums)
{
    const struct pair_constants constants = pair_constants_of(updated);
    bool more = true;
    for (int k = 0; more; k += CHUNK) {
        more = false;
        for (size_t i = first; i < last; i += VEC) {
            const struct pairs pairs = {.own = updated_packed(updated, i),
                                        .other = updated_packed(updated, i),
                                        .own_stride = updated->stride,
                                        .other_stride = updated->stride,
                                        .shift = updated->shift + updated->neighbours.start[i],
                                        .count = (int)updated->shifts[i / VEC]};
            if (k < pairs.count)
                add_chunk(updated, &constants, dimension, on, &pairs, k, &sums[(i - first) / VEC]);
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
    double own[COMPONENTS][VEC];
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
    for (int n = count; n % VEC != 0; n++) {
        for (size_t c = 0; c < layout.size; c++)
            batch->number[c][n] = own[c];
        batch->number[0][n] += 1000 * updated->reach * updated->longest;
    }
    return count;
}

/* Sums of particle i into lane n. */
INLINED void gather_one(const struct updated *updated, const int dimension, const struct pair_switches on,
                        size_t i, size_t lane, struct eight_sums *sums)
{
    const struct pair_constants constants = pair_constants_of(updated);
    const double *own = updated->record + updated->layout.size * i;
    _Alignas(64) struct batch batch;
    _Alignas(64) struct eight_sums parts = {.matrix = {{0}}};
    int32_t shift[BATCH / VEC];
    for (int k = 0; k < BATCH / VEC; k++)
        shift[k] = VEC * k;
    for (size_t c = 0; c < updated->layout.size; c++)
        for (int n = 0; n < VEC; n++)
            batch.own[c][n] = own[c];
    size_t next = updated->neighbours.start[i];
    const size_t last = updated->neighbours.start[i + 1];
    for (int count = BATCH; count == BATCH;) {
        count = fill_batch(updated, dimension, own, last, &next, &batch);
        const struct pairs pairs = {.own = batch.own[0],
                                    .other = batch.number[0],
                                    .own_stride = VEC,
                                    .other_stride = ROW,
                                    .shift = shift,
                                    .count = (count + VEC - 1) / VEC};
        for (int k = 0; k < pairs.count; k += CHUNK)
            add_chunk(updated, &constants, dimension, on, &pairs, k, &parts);
    }
    put_sums(dimension, &parts, lane, sums);
}

#endif
