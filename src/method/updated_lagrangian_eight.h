/* Sums over the neighbours of eight particles in sequence at a time, one in each lane of a vector.
 *
 * Where particles are numbered in some order (lattices, rings) the neighbours of one stand at much the same
 * distances in memory as those of the next. So the lists of eight particles are merged into one of distances
 * in memory, and for each of them eight pairs are taken at once, with contiguous loads from the planes of
 * struct updated. A place that is no neighbour of some particle is out of its reach, as the lists are
 * complete: the slope of the kernel is 0 there and adds nothing. So the sums, in ascending order, do not
 * depend on when the lists were made. Cubic spline only. Inlined into the instances of
 * updated_lagrangian_rate.c. */
#ifndef SELAS_UPDATED_LAGRANGIAN_EIGHT_H
#define SELAS_UPDATED_LAGRANGIAN_EIGHT_H

#include "base/vectors.h"
#include "method/updated_lagrangian.h"

#include <math.h>
#include <string.h>

struct eight_sums {
    vec8 matrix[6], full[6], velocity[3][3], push[6][3];
};

/* What all pairs have in common. */
struct eight_constants {
    double inverse_length, scale, usual, small, alpha, beta, repulsion, one_side;
};

/* Where the condition holds the value, else 0. */
#define WHERE(condition, value) ((vec8)((mask8)(value) & (mask8)(condition)))

INLINED void root(const vec8 *square, vec8 *result)
{
    double number[VEC];
    memcpy(number, square, sizeof number);
#pragma omp simd
    for (int n = 0; n < VEC; n++)
        number[n] = sqrt(number[n]);
    memcpy(result, number, sizeof number);
}

/* Adds the pairs of the eight particles at `own` with the eight places at `other` (first component of both:
 * their other components stand `stride` further on each). */
INLINED void add_eight(const struct updated *updated, const struct eight_constants *constants,
                       const int dimension, const bool viscous, const bool repulsive, const double *own,
                       const double *other, struct eight_sums *sums)
{
    const struct updated_layout layout = updated->layout;
    const size_t stride = updated->stride;
    const int stresses = dimension * (dimension + 1) / 2;
#define OWN(component) VEC8(own + (component)*stride)
#define OTHER(component) VEC8(other + (component)*stride)
    vec8 d[3], change[3], total[6], square = {0}, approach = {0}, length = {0}, distance;
    for (int a = 0; a < dimension; a++) {
        d[a] = OWN((size_t)a) - OTHER((size_t)a);
        change[a] = OTHER(layout.velocity + (size_t)a) - OWN(layout.velocity + (size_t)a);
        square += d[a] * d[a];
        approach -= change[a] * d[a];
    }
    length += 1;
    if (!updated->even) length = (OWN(layout.length) + OTHER(layout.length)) / 2;
    root(&square, &distance);
    vec8 q = distance * constants->inverse_length;
    vec8 shorter = length; /* 1 / length */
    if (!updated->even) {
        shorter = 1 / length;
        q *= shorter;
    }
    const vec8 h = constants->usual * length, far = square + .01 * h * h;
    const vec8 mean = (OWN(layout.density) + OTHER(layout.density)) / 2;
    vec8 each = q; /* one division for all */
    if (viscous) each *= far * mean;
    const vec8 inverse = 1 / each;
    const vec8 outer = WHERE(q < 2, 2 - q), inner = WHERE(q < 1, 1 - q);
    vec8 slope = constants->scale * (2 * inner * inner - outer * outer / 2) * inverse;
    if (viscous) slope *= far * mean;
    for (int power = 0; !updated->even && power < dimension + 2; power++)
        slope *= shorter;
    for (int s = 0; s < stresses; s++)
        total[s] = OWN(layout.tension + (size_t)s) + OTHER(layout.tension + (size_t)s);
    if (repulsive) {
        const vec8 f = constants->repulsion * (outer * outer * outer - 4 * inner * inner * inner);
        const vec8 power = f * f * f * f;
        for (int s = 0; s < stresses; s++)
            total[s] += power * (OWN(layout.repulsion + (size_t)s) + OTHER(layout.repulsion + (size_t)s));
    }
    if (viscous) {
        const vec8 phi = h * approach * (inverse * q * mean);
        const vec8 viscosity = (constants->beta * phi - constants->alpha) * phi * (inverse * q * far);
        const vec8 pressure = WHERE(approach < constants->one_side, viscosity);
        for (int a = 0; a < dimension; a++)
            total[updated_component[dimension][a][a]] -= pressure;
    }
    const vec8 mass = slope * OTHER(layout.mass), span = slope * OTHER(layout.span);
    for (int a = 0; a < dimension; a++) {
        const vec8 force = mass * d[a], strain = span * d[a];
        for (int s = 0; s < stresses; s++)
            sums->push[s][a] += total[s] * force;
        for (int b = 0; b < dimension; b++)
            sums->velocity[b][a] += change[b] * strain;
        for (int b = a; b < dimension; b++)
            sums->matrix[updated_component[dimension][a][b]] -= d[b] * strain;
    }
    if (updated->pressed) {
        const vec8 volume = slope * OTHER(layout.volume);
        for (int a = 0; a < dimension; a++)
            for (int b = a; b < dimension; b++)
                sums->full[updated_component[dimension][a][b]] -= d[b] * volume * d[a];
    }
#undef OWN
#undef OTHER
}

/* Sums of the particles i ... i + 7; i is a multiple of eight. */
INLINED void updated_eight(const struct updated *updated, const int dimension, const bool viscous,
                           const bool repulsive, size_t i, struct updated_sums sums[VEC])
{
    const double h = updated->smoothing_length;
    const struct eight_constants constants = {
        .inverse_length = 1 / h,
        .scale = updated->slope_scale,
        .usual = h,
        .alpha = updated->alpha * updated->sound_speed,
        .beta = updated->beta,
        .repulsion = updated->repulsion_scale / 6,
        .one_side = updated->both_sides ? INFINITY : 0,
    };
    const double *own = updated->planes + VEC + i;
    const size_t begin = updated->neighbours.start[i];
    const size_t end = begin + updated->shifts[i / VEC];
    struct eight_sums all = {.matrix = {{0}}};
    for (size_t k = begin; k < end; k++)
        add_eight(updated, &constants, dimension, viscous, repulsive, own, own + updated->shift[k], &all);
    for (int n = 0; n < VEC; n++) {
        for (int s = 0; s < dimension * (dimension + 1) / 2; s++) {
            sums[n].matrix[s] = all.matrix[s][n];
            sums[n].full[s] = all.full[s][n];
            for (int a = 0; a < dimension; a++)
                sums[n].push[s][a] = all.push[s][a][n];
        }
        for (int a = 0; a < dimension; a++)
            for (int b = 0; b < dimension; b++)
                sums[n].velocity[a][b] = all.velocity[a][b][n];
    }
}

#endif
