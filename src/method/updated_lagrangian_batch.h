/* Sums over the neighbours of one particle, for any arrangement: pairs within reach are packed into batches,
 * component by component, so that the arithmetic runs in vectors. A batch is full when it holds BATCH pairs
 * within reach, so that the sums do not depend on when the lists were made. Inlined into the instances of
 * updated_lagrangian_rate.c. */
#ifndef SELAS_UPDATED_LAGRANGIAN_BATCH_H
#define SELAS_UPDATED_LAGRANGIAN_BATCH_H

#include "base/vectors.h"
#include "method/updated_lagrangian.h"

#include <math.h>

enum { BATCH = 64 };

/* Pairs of one particle that are within reach. After weigh() span, volume and mass carry the factor W'/r, so
 * that times d they are V grad W, m grad W. */
struct batch {
    int count;
    double d[3][BATCH], change[3][BATCH]; /* x_i - x_j, v_j - v_i */
    double square[BATCH], length[BATCH];  /* h of the pair over the usual one */
    double span[BATCH], volume[BATCH], mass[BATCH];
    double tension[6][BATCH], repulsion[6][BATCH];
    double pressure[BATCH], strength[BATCH]; /* m Pi W'/r, m f^4 W'/r */
};

/* The cubic spline by truncated powers, w = ((2 - q)^3 - 4 (1 - q)^3) / 6, each where positive: no branch. */
static inline double cubic_slope_over_q(double q)
{
    const double outer = q < 2 ? 2 - q : 0, inner = q < 1 ? 1 - q : 0;
    return (2 * inner * inner - outer * outer / 2) / q;
}

static inline double cubic_shape(double q)
{
    const double outer = q < 2 ? 2 - q : 0, inner = q < 1 ? 1 - q : 0;
    return (outer * outer * outer - 4 * inner * inner * inner) / 6;
}

/* Monaghan's viscosity, Eq 17 with r_ij read as a vector, between pairs that approach each other. */
INLINED void add_viscosity(const struct updated *updated, const int dimension, double density,
                           struct batch *batch)
{
    const double usual = updated->smoothing_length, alpha = updated->alpha * updated->sound_speed,
                 beta = updated->beta;
    const bool both_sides = updated->both_sides;
#pragma omp simd
    for (int n = 0; n < batch->count; n++) {
        double approach = 0;
        for (int a = 0; a < dimension; a++)
            approach -= batch->change[a][n] * batch->d[a][n];
        const double h = usual * batch->length[n];
        const double phi = h * approach / (batch->square[n] + .01 * h * h);
        const double mean = (density + batch->mass[n] / batch->volume[n]) / 2;
        const double viscosity = batch->mass[n] * (beta * phi * phi - alpha * phi) / mean;
        batch->pressure[n] = both_sides || approach < 0 ? viscosity : 0;
    }
}

/* Kernel factors of a batch. */
INLINED void weigh(const struct updated *updated, const int dimension, const bool viscous,
                   const bool repulsive, struct batch *batch)
{
    const struct kernel *kernel = updated->options.kernel;
    const double h = updated->smoothing_length, scale = updated->slope_scale;
    double slope[BATCH], shape[BATCH];
    if (updated->cubic) {
#pragma omp simd
        for (int n = 0; n < batch->count; n++) {
            const double q = sqrt(batch->square[n]) / (h * batch->length[n]);
            slope[n] = scale * cubic_slope_over_q(q);
            if (repulsive) shape[n] = cubic_shape(q);
        }
    } else {
        for (int n = 0; n < batch->count; n++) {
            const double q = sqrt(batch->square[n]) / (h * batch->length[n]);
            slope[n] = scale * kernel->slope_over_q(dimension, q);
            if (repulsive) shape[n] = kernel->shape(dimension, q);
        }
    }
    if (!updated->even)
        for (int n = 0; n < batch->count; n++) {
            const double g = batch->length[n], square = g * g;
            slope[n] /= dimension == 1 ? square * g : dimension == 2 ? square * square : square * square * g;
        }
    const int stresses = dimension * (dimension + 1) / 2;
#pragma omp simd
    for (int n = 0; n < batch->count; n++) {
        batch->span[n] *= slope[n];
        batch->volume[n] *= slope[n];
        batch->mass[n] *= slope[n];
        if (viscous) batch->pressure[n] *= slope[n];
        if (repulsive) {
            const double f = updated->repulsion_scale * shape[n], power = f * f * f * f;
            batch->strength[n] = batch->mass[n] * power;
            for (int s = 0; s < stresses; s++)
                batch->tension[s][n] += power * batch->repulsion[s][n];
        }
    }
}

INLINED double dot(const struct batch *batch, const double *weight, const double *x)
{
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (int n = 0; n < batch->count; n++)
        sum += weight[n] * x[n];
    return sum;
}

INLINED void add_batch(const struct updated *updated, const int dimension, const bool viscous,
                       const bool repulsive, const double *own, struct batch *batch,
                       struct updated_sums *sums)
{
    const struct updated_layout layout = updated->layout;
    const double density = own[layout.mass] / own[layout.volume];
    if (viscous) add_viscosity(updated, dimension, density, batch);
    weigh(updated, dimension, viscous, repulsive, batch);
    const int stresses = dimension * (dimension + 1) / 2;
    double product[BATCH];
    for (int a = 0; a < dimension; a++) {
        const double *d = batch->d[a];
        const double mass = dot(batch, batch->mass, d);
        const double pressure = viscous ? dot(batch, batch->pressure, d) : 0;
        const double strength = repulsive ? dot(batch, batch->strength, d) : 0;
#pragma omp simd
        for (int n = 0; n < batch->count; n++)
            product[n] = batch->mass[n] * d[n];
        for (int s = 0; s < stresses; s++)
            sums->push[s][a] += dot(batch, batch->tension[s], product) +
                                own[layout.tension + (size_t)s] * mass +
                                (repulsive ? own[layout.repulsion + (size_t)s] * strength : 0);
        for (int b = 0; b < dimension && viscous; b++)
            sums->push[updated_component[dimension][b][b]][a] -= pressure;
#pragma omp simd
        for (int n = 0; n < batch->count; n++)
            product[n] = batch->span[n] * d[n];
        for (int b = 0; b < dimension; b++)
            sums->velocity[b][a] += dot(batch, batch->change[b], product);
        for (int b = a; b < dimension; b++)
            sums->matrix[updated_component[dimension][a][b]] -= dot(batch, batch->d[b], product);
        if (!updated->pressed) continue;
#pragma omp simd
        for (int n = 0; n < batch->count; n++)
            product[n] = batch->volume[n] * d[n];
        for (int b = a; b < dimension; b++)
            sums->full[updated_component[dimension][a][b]] -= dot(batch, batch->d[b], product);
    }
    batch->count = 0;
}

INLINED void updated_gather(const struct updated *updated, const int dimension, const bool viscous,
                            const bool repulsive, size_t i, struct updated_sums *sums)
{
    const struct updated_layout layout = updated->layout;
    const int stresses = dimension * (dimension + 1) / 2;
    const double reach = updated->reach * updated->reach;
    const double *own = updated->record + layout.size * i;
    struct batch batch;
    batch.count = 0;
    for (size_t k = updated->neighbours.start[i]; k < updated->neighbours.start[i + 1]; k++) {
        const double *other = updated->record + layout.size * updated->neighbours.index[k];
        const int n = batch.count;
        double square = 0;
        for (int a = 0; a < dimension; a++) {
            const double d = own[a] - other[a];
            batch.d[a][n] = d;
            square += d * d;
        }
        const double length = (own[layout.length] + other[layout.length]) / 2;
        if (!(square < reach * length * length)) continue;
        batch.square[n] = square;
        batch.length[n] = length;
        batch.volume[n] = other[layout.volume];
        batch.span[n] = other[layout.span];
        batch.mass[n] = other[layout.mass];
        for (int a = 0; a < dimension; a++)
            batch.change[a][n] = other[layout.velocity + (size_t)a] - own[layout.velocity + (size_t)a];
        for (int s = 0; s < stresses; s++)
            batch.tension[s][n] = other[layout.tension + (size_t)s];
        if (repulsive)
            for (int s = 0; s < stresses; s++)
                batch.repulsion[s][n] = other[layout.repulsion + (size_t)s];
        if (++batch.count == BATCH) add_batch(updated, dimension, viscous, repulsive, own, &batch, sums);
    }
    add_batch(updated, dimension, viscous, repulsive, own, &batch, sums);
}

#endif
