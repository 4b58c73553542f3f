/* A box of numbers in blocks of rows and planes, one a rank, with halos of one row and plane: written by the walk of
 * checkpoints into BLOCKS.h5 and compared, read by the first rank alone, and by all with halos. blocks PATH ROWS, where
 * ROWS is how many blocks stand side by side; the others stand on them. */
#include "record/run_file.h"
#include "record/walk.h"

#include <mpi.h>
#include <stdio.h>
#include <stdlib.h>

enum { NX = 3, NY = 11, NZ = 13, UNITS = 2, ALL = NX * NY * NZ };

struct sides {
    size_t own, end, low, high; /* own ones, and those of the window */
};

static struct sides part_of(size_t n, size_t parts, size_t k)
{
    struct sides side = {n * k / parts, n * (k + 1) / parts, 0, n};
    if (side.own > 0) side.low = side.own - 1;
    if (side.end < n) side.high = side.end + 1;
    return side;
}

/* An entry of the number at a place of the whole box, as no other place has it. */
static double number(size_t place, size_t unit)
{
    return 1000.0 * (double)unit + (double)place;
}

static void walk_box(struct walk *walk, double *mine, const struct spread *shares)
{
    for (bool more = walk_begin(walk); more; more = walk_again(walk))
        walk_shared(walk, "box", H5T_NATIVE_DOUBLE, UNITS, mine, shares->here, shares);
}

/* How many entries of the window are not the box's; those of halos count where `halo`. */
static size_t wrong(const double *mine, const struct sides *y, const struct sides *z, bool halo)
{
    size_t bad = 0, at = 0;
    for (size_t k = z->low; k < z->high; k++)
        for (size_t j = y->low; j < y->high; j++)
            for (size_t i = 0; i < NX; i++, at++) {
                const bool own = k >= z->own && k < z->end && j >= y->own && j < y->end;
                for (size_t u = 0; u < UNITS; u++)
                    bad += (own || halo) && mine[UNITS * at + u] != number((k * NY + j) * NX + i, u);
            }
    return bad;
}

/* The same of the file, for a process alone. */
static size_t wrong_in_file(const char *path)
{
    static double whole[UNITS * ALL];
    size_t bad = 0;
    struct walk walk = {.path = path, .mode = SET_READ};
    for (bool more = walk_begin(&walk); more; more = walk_again(&walk))
        walk_pass(&walk, "box", H5T_NATIVE_DOUBLE, whole, (size_t)UNITS * ALL);
    for (size_t k = 0; k < ALL; k++)
        for (size_t u = 0; u < UNITS; u++)
            bad += whole[UNITS * k + u] != number(k, u);
    return walk.failed ? ALL : bad;
}

int main(int count, char **words)
{
    struct ranks *ranks = ranks_begin();
    const char *path = count > 1 ? words[1] : "blocks.h5";
    const size_t side = count > 2 ? strtoul(words[2], NULL, 10) : 1, me = (size_t)ranks_me(ranks);
    const struct sides y = part_of(NY, side, me % side),
                       z = part_of(NZ, (size_t)ranks_count(ranks) / side, me / side);
    const size_t rows = y.high - y.low, planes = z.high - z.low, row = NX;
    const struct spread_run run = {.there = (z.low * NY + y.low) * row,
                                   .count = rows * row,
                                   .from = (y.own - y.low) * row,
                                   .end = (y.end - y.low) * row,
                                   .times = planes,
                                   .here_step = rows * row,
                                   .there_step = NY * row,
                                   .first = z.own - z.low,
                                   .last = z.end - z.low};
    struct spread shares = {0};
    spread_add(&shares, rows * planes * row, ALL, &run);
    double *mine = calloc(UNITS * shares.here, sizeof *mine);
    size_t at = 0;
    for (size_t k = z.low; k < z.high; k++) /* halos hold what must not be written */
        for (size_t j = y.low; j < y.high; j++)
            for (size_t i = 0; i < NX; i++, at++)
                for (size_t u = 0; u < UNITS; u++)
                    mine[UNITS * at + u] = k >= z.own && k < z.end && j >= y.own && j < y.end
                                               ? number((k * NY + j) * NX + i, u)
                                               : -1;
    struct walk writing = {.ranks = ranks, .path = path, .mode = SET_WRITE},
                comparing = {.ranks = ranks, .path = path, .mode = SET_COMPARE}, differing = comparing,
                reading = {.ranks = ranks, .path = path, .mode = SET_READ};
    walk_box(&writing, mine, &shares);
    walk_box(&comparing, mine, &shares);
    double bad[5] = {!walk_good(&writing), !walk_good(&comparing),
                     ranks_first(ranks) ? (double)wrong_in_file(path) : 0, 0, 0};
    walk_box(&reading, mine, &shares);
    bad[3] = !walk_good(&reading) || wrong(mine, &y, &z, true) > 0;
    mine[UNITS * (run.first * run.here_step + run.from)] += 1;
    walk_box(&differing, mine, &shares);
    bad[4] = !differing.failed;
    ranks_sum(ranks, 5, bad);
    if (ranks_first(ranks))
        printf("written %g, compared %g, in the file %g, read %g, a difference missed %g\n", bad[0], bad[1],
               bad[2], bad[3], bad[4]);
    free(mine);
    ranks_end(&ranks);
    return bad[0] + bad[1] + bad[2] + bad[3] + bad[4] > 0;
}
