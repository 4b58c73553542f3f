/* Averages of the rock over pieces of a column (doc/theory/general-ground.md, section 4). */
#include "method/consistent/general/piece.h"

#include <math.h>
#include <string.h>

static const double sharpening = 1. / 6;

static double hat(double t)
{
    return fmax(0, 1 - fabs(t));
}

static double at_knots(double t)
{
    return (1 + 2 * sharpening) * hat(t) - sharpening * (hat(t - 1) + hat(t + 1));
}

double piece_kernel(enum at at, double t)
{
    return at == AT_KNOTS ? at_knots(t) : (at_knots(t - .5) + at_knots(t + .5)) / 2;
}

static void quantities(const struct rock *rock, double value[AVERAGES])
{
    const double m = rock->lambda + 2 * rock->mu;
    value[MEAN_DENSITY] = rock->density;
    value[MEAN_SOFTNESS] = 1 / m;
    value[MEAN_SLIP] = 1 / rock->mu;
    value[MEAN_SHEAR] = rock->mu;
    value[MEAN_SPREAD] = rock->mu * (3 * rock->lambda + 2 * rock->mu) / m;
    value[MEAN_RATIO] = rock->lambda / m;
}

/* (G11a), from those of the rock */
static void cell_quantities(const struct rock *rock, const struct shares *shares, const double of[AVERAGES],
                            double value[CELL])
{
    const double m = rock->lambda + 2 * rock->mu, mu = rock->mu, kappa = rock->lambda + 2. / 3 * mu;
    const double bulk = shares->bulk, shear = shares->shear;
    value[CELL_SOFTNESS] = of[MEAN_SOFTNESS];
    value[CELL_SPREAD] = of[MEAN_SPREAD];
    value[CELL_SLIP] = of[MEAN_SLIP];
    value[CELL_SHEAR] = of[MEAN_SHEAR];
    value[PART_SOFTNESS] = (bulk * kappa + 4. / 3 * shear * mu) / (m * m);
    value[PART_RATIO] = 2 * (bulk - shear) * (kappa / m) * (mu / m);
    value[PART_SPREAD] = (4 * bulk * mu + 3 * shear * kappa) * (kappa / m) * (mu / m);
    value[PART_SLIP] = shear / mu;
    value[PART_SHEAR] = shear * mu;
}

void piece_sample(const struct rock *rock, const struct shares *shares, double height, double part,
                  struct piece *piece)
{
    double value[AVERAGES], cell[CELL];
    quantities(rock, value);
    for (int n = 0; n < POSITIVE; n++)
        piece->least[n] = fmin(piece->least[n], value[n]);
    for (int n = 0; n < AVERAGES; n++) {
        piece->mean[0][n] += part * value[n];
        piece->mean[1][n] += part * height * value[n];
    }
    piece->slope[SLOPE_NONE] += part * log(rock->lambda + 2 * rock->mu);
    if (shares == NULL) return;
    cell_quantities(rock, shares, value, cell);
    for (int n = 0; n < CELL; n++)
        piece->cell[n] += part * cell[n];
}

static bool same_rock(const struct piece *one, const struct piece *other)
{
    return one->even && other->even && one->mean[0][MEAN_DENSITY] == other->mean[0][MEAN_DENSITY] &&
           one->mean[0][MEAN_SHEAR] == other->mean[0][MEAN_SHEAR] &&
           one->mean[0][MEAN_SOFTNESS] == other->mean[0][MEAN_SOFTNESS] &&
           one->cell[PART_SHEAR] == other->cell[PART_SHEAR] &&
           one->cell[PART_SOFTNESS] == other->cell[PART_SOFTNESS];
}

void piece_follow(const struct piece *before, struct piece *piece)
{
    piece->alike = before != NULL && same_rock(before, piece) ? before->alike + 1 : 0;
}

void piece_add(const struct piece *one, double weight, double cell, struct piece *sum)
{
    for (int moment = 0; moment < 2; moment++)
        for (int q = 0; q < AVERAGES; q++)
            sum->mean[moment][q] += weight * one->mean[moment][q];
    for (int q = 0; q < CELL && cell > 0; q++)
        sum->cell[q] += cell * one->cell[q];
    for (int q = 0; q < POSITIVE; q++)
        sum->least[q] = fmin(sum->least[q], one->least[q]);
}

void piece_smooth(double from, double to, double weight[3])
{
    const double end[2] = {from / reach_of_kernel, to / reach_of_kernel};
    for (int order = 0; order < 3; order++)
        weight[order] = 0;
    for (int side = 0; side < 2; side++) {
        const double s = end[side], sign = side == 0 ? -1 : 1, rest = 1 - s * s;
        weight[0] += sign * 15. / 16 * s * (1 - s * s * (2. / 3 - s * s / 5));
        weight[1] -= sign * 15. / 16 * rest * rest / reach_of_kernel;
        weight[2] -= sign * 15. / 4 * rest * s / (reach_of_kernel * reach_of_kernel);
    }
}

void piece_slopes(const double slope[], int slot, const double weight[3], double sum[])
{
    /* Without the slopes along the slot, and how many these are. */
    static const struct from {
        enum slope without, with;
        int order;
    } from[3][SLOPES] = {
        {{0, SLOPE_NONE, 0}, {0, SLOPE_0, 1}, {0, SLOPE_00, 2}},
        {{0, SLOPE_NONE, 0},
         {0, SLOPE_1, 1},
         {0, SLOPE_11, 2},
         {SLOPE_0, SLOPE_0, 0},
         {SLOPE_0, SLOPE_01, 1},
         {SLOPE_00, SLOPE_00, 0}},
        {{0, SLOPE_NONE, 0},
         {0, SLOPE_2, 1},
         {0, SLOPE_22, 2},
         {SLOPE_0, SLOPE_0, 0},
         {SLOPE_0, SLOPE_02, 1},
         {SLOPE_00, SLOPE_00, 0},
         {SLOPE_1, SLOPE_1, 0},
         {SLOPE_1, SLOPE_12, 1},
         {SLOPE_01, SLOPE_01, 0},
         {SLOPE_11, SLOPE_11, 0}},
    };
    static const int count[3] = {3, 6, 10};
    for (int n = 0; n < count[slot]; n++)
        sum[from[slot][n].with] += weight[from[slot][n].order] * slope[from[slot][n].without];
}

void piece_turn(struct piece *piece)
{
    for (int q = 0; q < AVERAGES; q++)
        piece->mean[1][q] = -piece->mean[1][q];
}

void piece_average(const struct piece *ring, size_t plane, enum at at, ptrdiff_t first, ptrdiff_t pieces,
                   struct averaged *sum)
{
    const struct piece *piece[PIECES];
    const ptrdiff_t low = first < 0 ? -first : 0, high = pieces - 1 - first;
    for (int n = 0; n < PIECES; n++)
        piece[n] = ring + plane * (size_t)((first + n + RING) % RING);
    *sum = (struct averaged){.even = false};
    memcpy(sum->least, piece[0]->least, sizeof sum->least);
    memcpy(sum->mean, piece[0]->mean[0], sizeof sum->mean);
    memcpy(sum->cell, piece[0]->cell, sizeof sum->cell);
    sum->even = piece[PIECES - 1]->alike + 1 >= PIECES;
    if (sum->even) return;
    memset(sum->mean, 0, sizeof sum->mean);
    for (int q = 0; q < CELL; q++) /* half a cell on either side */
        sum->cell[q] = (piece[PIECES / 2 - 1]->cell[q] + piece[PIECES / 2]->cell[q]) / 2;
    for (int n = 0; n < PIECES; n++) {
        const double t = (n + .5) / 2 - reach_of_kernel, from = piece_kernel(at, t - .25),
                     to = piece_kernel(at, t + .25);
        const double weight[2] = {(from + to) / 4,
                                  to - from}; /* the piece is half a cell, and its slope 2 (to - from) */
        for (int moment = 0; moment < 2; moment++)
            for (int q = 0; q < AVERAGES; q++)
                sum->mean[q] += weight[moment] * piece[n]->mean[moment][q];
        for (int q = 0; q < POSITIVE; q++)
            sum->least[q] = fmin(sum->least[q], piece[n]->least[q]);
        const struct piece *within = piece[n < low ? low : n > high ? high : n];
        double smooth[3];
        piece_smooth(t - .25, t + .25, smooth);
        piece_slopes(within->slope, DEPTH, smooth, sum->slope);
    }
}
