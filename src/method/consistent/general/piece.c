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

/* Their derivatives by e: those of lambda and M are kappa. */
static void by_bulk(const struct rock *rock, double value[AVERAGES])
{
    const double m = rock->lambda + 2 * rock->mu, kappa = rock->lambda + 2. / 3 * rock->mu;
    memset(value, 0, AVERAGES * sizeof *value);
    value[MEAN_SOFTNESS] = -kappa / (m * m);
    value[MEAN_SPREAD] = 4 * kappa * (rock->mu / m) * (rock->mu / m);
    value[MEAN_RATIO] = 2 * kappa * rock->mu / (m * m);
}

void piece_sample(const struct rock *rock, double height, double part, bool derivatives, struct piece *piece)
{
    double value[AVERAGES], derivative[AVERAGES];
    quantities(rock, value);
    if (derivatives) by_bulk(rock, derivative);
    for (int n = 0; n < POSITIVE; n++) {
        if (!(value[n] < piece->least[n])) continue;
        piece->least[n] = value[n];
        if (derivatives) piece->least_by_bulk[n] = derivative[n];
    }
    for (int n = 0; n < AVERAGES; n++) {
        piece->mean[0][n] += part * value[n];
        piece->mean[1][n] += part * height * value[n];
    }
    for (int n = 0; n < AVERAGES && derivatives; n++) {
        piece->by_bulk[0][n] += part * derivative[n];
        piece->by_bulk[1][n] += part * height * derivative[n];
    }
    piece->level += part * log(rock->lambda + 2 * rock->mu);
}

static bool same_rock(const struct piece *one, const struct piece *other)
{
    return one->even && other->even && one->mean[0][MEAN_DENSITY] == other->mean[0][MEAN_DENSITY] &&
           one->mean[0][MEAN_SHEAR] == other->mean[0][MEAN_SHEAR] &&
           one->mean[0][MEAN_SOFTNESS] == other->mean[0][MEAN_SOFTNESS];
}

void piece_follow(const struct piece *before, struct piece *piece)
{
    piece->alike = before != NULL && same_rock(before, piece) ? before->alike + 1 : 0;
}

void piece_add(const struct piece *one, double weight, double even, bool derivatives, struct piece *sum)
{
    for (int moment = 0; moment < 2; moment++)
        for (int q = 0; q < AVERAGES; q++)
            sum->mean[moment][q] += weight * one->mean[moment][q];
    for (int moment = 0; moment < 2 && derivatives; moment++)
        for (int q = 0; q < AVERAGES; q++)
            sum->by_bulk[moment][q] += weight * one->by_bulk[moment][q];
    for (int q = 0; q < POSITIVE && derivatives; q++)
        if (one->least[q] < sum->least[q]) sum->least_by_bulk[q] = one->least_by_bulk[q];
    for (int q = 0; q < POSITIVE; q++)
        if (one->least[q] < sum->least[q]) sum->least[q] = one->least[q];
    sum->level += even * one->level;
    for (int s = 0; s < 2; s++)
        sum->rise[s] += even * one->rise[s];
}

void piece_turn(struct piece *piece)
{
    for (int q = 0; q < AVERAGES; q++) {
        piece->mean[1][q] = -piece->mean[1][q];
        piece->by_bulk[1][q] = -piece->by_bulk[1][q];
    }
}

void piece_average(const struct piece *ring, size_t plane, enum at at, ptrdiff_t first, ptrdiff_t pieces,
                   struct averaged *sum)
{
    const struct piece *piece[PIECES];
    const ptrdiff_t low = first < 0 ? -first : 0, high = pieces - 1 - first;
    for (int n = 0; n < PIECES; n++)
        piece[n] = ring + plane * (size_t)((first + n + RING) % RING);
    *sum = (struct averaged){.level = 0};
    memcpy(sum->least, piece[0]->least, sizeof sum->least);
    memcpy(sum->least_by_bulk, piece[0]->least_by_bulk, sizeof sum->least_by_bulk);
    memcpy(sum->mean, piece[0]->mean[0], sizeof sum->mean);
    memcpy(sum->by_bulk, piece[0]->by_bulk[0], sizeof sum->by_bulk);
    sum->level = piece[0]->level;
    sum->even = piece[PIECES - 1]->alike + 1 >= PIECES;
    if (sum->even) return;
    memset(sum->mean, 0, sizeof sum->mean);
    memset(sum->by_bulk, 0, sizeof sum->by_bulk);
    sum->level = 0;
    for (int n = 0; n < PIECES; n++) {
        const double t = (n + .5) / 2 - reach_of_kernel, from = piece_kernel(at, t - .25),
                     to = piece_kernel(at, t + .25);
        const double weight[2] = {(from + to) / 4,
                                  to - from}; /* the piece is half a cell, and its slope 2 (to - from) */
        for (int moment = 0; moment < 2; moment++)
            for (int q = 0; q < AVERAGES; q++) {
                sum->mean[q] += weight[moment] * piece[n]->mean[moment][q];
                sum->by_bulk[q] += weight[moment] * piece[n]->by_bulk[moment][q];
            }
        for (int q = 0; q < POSITIVE; q++)
            if (piece[n]->least[q] < sum->least[q]) {
                sum->least[q] = piece[n]->least[q];
                sum->least_by_bulk[q] = piece[n]->least_by_bulk[q];
            }
        const struct piece *within = piece[n < low ? low : n > high ? high : n];
        sum->level += within->level / PIECES;
        for (int s = 0; s < 2; s++)
            sum->rise[s] += within->rise[s] / PIECES;
        sum->rise[DEPTH] += (t > 0 ? 2. : -2.) / PIECES * within->level;
    }
}
