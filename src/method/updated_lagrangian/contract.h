/* Rates of eight particles from their sums, one particle in each lane of a vector: L^-1, the velocity
 * gradient, the accelerations, and the stress rate of Hooke's law with the Jaumann terms (equations in
 * rate.c). Inlined into the instances of rate.c. */
#ifndef SELAS_METHOD_UPDATED_LAGRANGIAN_CONTRACT_H
#define SELAS_METHOD_UPDATED_LAGRANGIAN_CONTRACT_H

#include "base/vectors.h"
#include "method/updated_lagrangian/updated_lagrangian.h"

/* Sums over the neighbours of eight particles, with 2 W' / slope_scale for W': contract() puts that right. */
struct eight_sums {
    vec8 matrix[6];      /* V grad W (x_j - x_i), symmetric, over what deforms with the body */
    vec8 full[6];        /* the same over all: with the ghosts of loaded faces */
    vec8 velocity[3][3]; /* V (v_j - v_i) grad W */
    vec8 push[6][3];     /* m (s_j/rho_j^2 + f^4 R_j) grad W */
    vec8 pull[3];        /* m grad W, which s_i/rho_i^2 multiplies */
    vec8 soft[3];        /* m f^4 grad W, which R_i multiplies */
    vec8 damp[3];        /* m Pi grad W */
};

/* Inverse of L; the identity where the neighbours do not span the space. */
INLINED void invert(const int dimension, const vec8 m[6], vec8 inverse[3][3])
{
    const vec8 none = {0}, one = none + 1;
    vec8 det, x[3][3];
    if (dimension == 1) {
        det = m[0];
        x[0][0] = one;
    } else if (dimension == 2) {
        det = m[0] * m[1] - m[2] * m[2];
        x[0][0] = m[1];
        x[1][1] = m[0];
        x[0][1] = x[1][0] = -m[2];
    } else {
        x[0][0] = m[1] * m[2] - m[4] * m[4];
        x[0][1] = x[1][0] = m[4] * m[5] - m[3] * m[2];
        x[0][2] = x[2][0] = m[3] * m[4] - m[1] * m[5];
        x[1][1] = m[0] * m[2] - m[5] * m[5];
        x[2][2] = m[0] * m[1] - m[3] * m[3];
        x[1][2] = x[2][1] = m[3] * m[5] - m[0] * m[4];
        det = m[0] * x[0][0] + m[3] * x[0][1] + m[5] * x[0][2];
    }
    const mask8 spans = (mask8)(det > 1e-6);
    const vec8 scale = 1 / ((vec8)((mask8)det & spans) + (vec8)((mask8)one & ~spans));
    for (int a = 0; a < dimension; a++)
        for (int b = 0; b < dimension; b++)
            inverse[a][b] =
                (vec8)((mask8)(x[a][b] * scale) & spans) + (vec8)((mask8)(a == b ? one : none) & ~spans);
}

/* Stress rate from the velocity gradient g[a][b] = d v_a / d x_b. */
INLINED void stress_rate(const struct updated *updated, const int dimension, vec8 g[3][3], const vec8 *trace,
                         const vec8 stress[6], vec8 rate[6])
{
    const double lambda = updated->material->plane_lambda, mu = updated->material->mu;
    for (int a = 0; a < dimension; a++)
        for (int b = a; b < dimension; b++) {
            vec8 sum = mu * (g[a][b] + g[b][a]);
            if (a == b) sum += lambda * *trace;
            if (updated->options.jaumann)
                for (int c = 0; c < dimension; c++) {
                    const vec8 ac = (g[a][c] - g[c][a]) / 2, cb = (g[c][b] - g[b][c]) / 2;
                    sum += ac * stress[updated_component[dimension][c][b]] -
                           stress[updated_component[dimension][a][c]] * cb;
                }
            rate[updated_component[dimension][a][b]] = sum;
        }
}

/* Number `entry` of each of `count` rows of `width` numbers, and back; the other lanes are 0. */
INLINED void take_lanes(const double *rows, size_t width, size_t entry, size_t count, vec8 *value)
{
    double lane[VEC] = {0};
    for (size_t n = 0; n < count; n++)
        lane[n] = rows[width * n + entry];
    memcpy(value, lane, sizeof lane);
}

INLINED void give_lanes(const vec8 *value, double *rows, size_t width, size_t entry, size_t count)
{
    double lane[VEC];
    memcpy(lane, value, sizeof lane);
    for (size_t n = 0; n < count; n++)
        rows[width * n + entry] = lane[n];
}

/* What grad W of the sums is multiplied with: L^-1 and the scale of the kernel, which the sums go without. */
INLINED void correction(const struct updated *updated, const int dimension, const vec8 sums[6],
                        vec8 inverse[3][3])
{
    const double scale = updated->slope_scale / 2;
    vec8 matrix[6] = {{0}};
    for (int s = 0; updated->options.correction && s < dimension * (dimension + 1) / 2; s++)
        matrix[s] = scale * sums[s];
    invert(dimension, matrix, inverse);
    for (int a = 0; a < dimension; a++)
        for (int b = 0; b < dimension; b++)
            inverse[a][b] *= scale;
}

/* Rates of the particles i ... i + count - 1, at most eight. */
INLINED void contract(const struct updated *updated, const int dimension, size_t i, size_t count,
                      const struct eight_sums *sums, const double *y, double *dydt)
{
    const size_t points = updated->cloud->points, unknowns = updated->model.unknowns;
    const size_t dim = (size_t)dimension, stresses = dim * (dim + 1) / 2;
    const double *density = y + 2 * unknowns + i, *stress = y + 2 * unknowns + points + stresses * i;
    double *acceleration = dydt + unknowns + dim * i, *density_rate = dydt + 2 * unknowns + i,
           *stresses_rate = dydt + 2 * unknowns + points + stresses * i;
    vec8 inverse[3][3], gradient[3][3], trace = {0}, own[6] = {{0}}, soft[6] = {{0}}, rate[6], thinning;
    correction(updated, dimension, sums->matrix, inverse);
    for (int a = 0; a < dimension; a++) {
        for (int b = 0; b < dimension; b++) {
            gradient[a][b] = sums->velocity[a][0] * inverse[b][0];
            for (int c = 1; c < dimension; c++)
                gradient[a][b] += sums->velocity[a][c] * inverse[b][c];
        }
        trace += gradient[a][a];
    }
    if (updated->pressed) correction(updated, dimension, sums->full, inverse);
    const double *packed = updated_packed(updated, i);
    const size_t step = updated_step(updated), place = updated->ordered ? 1 : updated->layout.size;
    const vec8 none = {0}, one = none + 1;
    take_lanes(density, 1, 0, count, &thinning);
    const vec8 volume = 1 / (thinning + WHERE(thinning == 0, one));
    for (size_t s = 0; s < stresses; s++) {
        take_lanes(packed + step * (updated->layout.tension + s), place, 0, count, &own[s]);
        own[s] *= volume;
        if (!updated->repulsive) continue;
        take_lanes(packed + step * (updated->layout.repulsion + s), place, 0, count, &soft[s]);
        soft[s] *= volume;
    }
    for (int a = 0; a < dimension; a++) {
        vec8 sum = {0};
        for (int c = 0; c < dimension; c++)
            for (int b = 0; b < dimension; b++) {
                const int s = updated_component[dimension][a][b];
                vec8 push = sums->push[s][c] + own[s] * sums->pull[c] + soft[s] * sums->soft[c];
                if (a == b) push -= sums->damp[c];
                sum += push * inverse[b][c];
            }
        give_lanes(&sum, acceleration, dim, (size_t)a, count);
    }
    thinning *= -trace;
    give_lanes(&thinning, density_rate, 1, 0, count);
    for (size_t s = 0; s < stresses; s++)
        take_lanes(stress, stresses, s, count, &own[s]);
    stress_rate(updated, dimension, gradient, &trace, own, rate);
    for (size_t s = 0; s < stresses; s++)
        give_lanes(&rate[s], stresses_rate, stresses, s, count);
}

/* The lanes of the sums of one particle together, into one lane of those of eight. */
INLINED void put_lane(const vec8 *parts, size_t lane, vec8 *eight)
{
    double sum = 0;
    for (int n = 0; n < VEC; n++)
        sum += (*parts)[n];
    (*eight)[lane] = sum;
}

INLINED void put_sums(const int dimension, const struct eight_sums *parts, size_t lane,
                      struct eight_sums *eight)
{
    for (int s = 0; s < dimension * (dimension + 1) / 2; s++) {
        put_lane(&parts->matrix[s], lane, &eight->matrix[s]);
        put_lane(&parts->full[s], lane, &eight->full[s]);
        for (int a = 0; a < dimension; a++)
            put_lane(&parts->push[s][a], lane, &eight->push[s][a]);
    }
    for (int a = 0; a < dimension; a++) {
        put_lane(&parts->pull[a], lane, &eight->pull[a]);
        put_lane(&parts->soft[a], lane, &eight->soft[a]);
        put_lane(&parts->damp[a], lane, &eight->damp[a]);
        for (int b = 0; b < dimension; b++)
            put_lane(&parts->velocity[a][b], lane, &eight->velocity[a][b]);
    }
}

#endif
