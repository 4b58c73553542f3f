/* Rates of a vector of particles from their sums, one particle in each lane of a vector: L^-1, the velocity
 * gradient, the accelerations, and the stress rate of Hooke's law with the Jaumann terms (equations in
 * rate.c). Inlined into the instances of block_rates.c. */
#ifndef SELAS_METHOD_UPDATED_LAGRANGIAN_CONTRACT_H
#define SELAS_METHOD_UPDATED_LAGRANGIAN_CONTRACT_H

#include "base/vectors.h"
#include "method/updated_lagrangian/updated_lagrangian.h"

/* Sums over the neighbours of LANES particles, with 2 W' / slope_scale for W': contract() puts that right. */
struct lane_sums {
    lanes matrix[6];      /* V grad W (x_j - x_i), symmetric, over what deforms with the body */
    lanes full[6];        /* the same over all: with the ghosts of loaded faces */
    lanes velocity[3][3]; /* V (v_j - v_i) grad W */
    lanes push[6][3];     /* m (s_j/rho_j^2 + f^4 R_j) grad W */
    lanes pull[3];        /* m grad W, which s_i/rho_i^2 multiplies */
    lanes soft[3];        /* m f^4 grad W, which R_i multiplies */
    lanes damp[3];        /* m Pi grad W */
};

/* Inverse of L; the identity where the neighbours do not span the space. */
INLINED void invert(const int dimension, const lanes m[6], lanes inverse[3][3])
{
    const lanes none = {0}, one = none + 1;
    lanes det, x[3][3];
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
    const lanes_mask spans = (lanes_mask)(det > 1e-6);
    const lanes scale = 1 / ((lanes)((lanes_mask)det & spans) + (lanes)((lanes_mask)one & ~spans));
    for (int a = 0; a < dimension; a++)
        for (int b = 0; b < dimension; b++)
            inverse[a][b] = (lanes)((lanes_mask)(x[a][b] * scale) & spans) +
                            (lanes)((lanes_mask)(a == b ? one : none) & ~spans);
}

/* Stress rate from the velocity gradient g[a][b] = d v_a / d x_b. */
INLINED void stress_rate(const struct updated *updated, const int dimension, lanes g[3][3],
                         const lanes *trace, const lanes stress[6], lanes rate[6])
{
    const double lambda = updated->material->plane_lambda, mu = updated->material->mu;
    for (int a = 0; a < dimension; a++)
        for (int b = a; b < dimension; b++) {
            lanes sum = mu * (g[a][b] + g[b][a]);
            if (a == b) sum += lambda * *trace;
            if (updated->options.jaumann)
                for (int c = 0; c < dimension; c++) {
                    const lanes ac = (g[a][c] - g[c][a]) / 2, cb = (g[c][b] - g[b][c]) / 2;
                    sum += ac * stress[updated_component[dimension][c][b]] -
                           stress[updated_component[dimension][a][c]] * cb;
                }
            rate[updated_component[dimension][a][b]] = sum;
        }
}

/* Number `entry` of each of `count` rows of `width` numbers, and back; the other lanes are 0. */
INLINED void take_lanes(const double *rows, size_t width, size_t entry, size_t count, lanes *value)
{
    double lane[LANES] = {0};
    for (size_t n = 0; n < count; n++)
        lane[n] = rows[width * n + entry];
    memcpy(value, lane, sizeof lane);
}

INLINED void give_lanes(const lanes *value, double *rows, size_t width, size_t entry, size_t count)
{
    double lane[LANES];
    memcpy(lane, value, sizeof lane);
    for (size_t n = 0; n < count; n++)
        rows[width * n + entry] = lane[n];
}

/* What grad W of the sums is multiplied with: L^-1 and the scale of the kernel, which the sums go without. */
INLINED void correction(const struct updated *updated, const int dimension, const lanes sums[6],
                        lanes inverse[3][3])
{
    const double scale = updated->slope_scale / 2;
    lanes matrix[6] = {{0}};
    for (int s = 0; updated->options.correction && s < dimension * (dimension + 1) / 2; s++)
        matrix[s] = scale * sums[s];
    invert(dimension, matrix, inverse);
    for (int a = 0; a < dimension; a++)
        for (int b = 0; b < dimension; b++)
            inverse[a][b] *= scale;
}

/* Rates of the own particles i ... i + count - 1, at most LANES. */
INLINED void contract(const struct updated *updated, const int dimension, size_t i, size_t count,
                      const struct lane_sums *sums, const double *y, double *dydt)
{
    const size_t row = updated_row(updated, i), unknowns = updated->model.unknowns;
    const size_t dim = (size_t)dimension, stresses = dim * (dim + 1) / 2;
    const size_t tensors = 2 * unknowns + updated->held + stresses * row;
    const double *density = y + 2 * unknowns + row, *stress = y + tensors;
    double *acceleration = dydt + unknowns + dim * row, *density_rate = dydt + 2 * unknowns + row,
           *stresses_rate = dydt + tensors;
    lanes inverse[3][3], gradient[3][3], trace = {0}, own[6] = {{0}}, soft[6] = {{0}}, rate[6], thinning;
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
    const lanes none = {0}, one = none + 1;
    take_lanes(density, 1, 0, count, &thinning);
    const lanes volume = 1 / (thinning + WHERE(thinning == 0, one));
    for (size_t s = 0; s < stresses; s++) {
        take_lanes(packed + step * (updated->layout.tension + s), place, 0, count, &own[s]);
        own[s] *= volume;
        if (!updated->repulsive) continue;
        take_lanes(packed + step * (updated->layout.repulsion + s), place, 0, count, &soft[s]);
        soft[s] *= volume;
    }
    for (int a = 0; a < dimension; a++) {
        lanes sum = {0};
        for (int c = 0; c < dimension; c++)
            for (int b = 0; b < dimension; b++) {
                const int s = updated_component[dimension][a][b];
                lanes push = sums->push[s][c] + own[s] * sums->pull[c] + soft[s] * sums->soft[c];
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

/* The sums of one particle lie in GROUP lanes, of one vector or several, and go together in one order
 * whatever the width. */
enum { PARTS = GROUP / LANES };

/* Adds the lanes of a number of one particle's sums up into one lane of those of several. */
INLINED void put_lane(const lanes *part, size_t lane, lanes *several)
{
    double sum = 0;
    for (size_t p = 0; p < PARTS; p++)
        for (int n = 0; n < LANES; n++)
            sum += part[p * sizeof(struct lane_sums) / sizeof(lanes)][n];
    (*several)[lane] = sum;
}

INLINED void put_sums(const int dimension, const struct lane_sums *parts, size_t lane,
                      struct lane_sums *several)
{
    for (int s = 0; s < dimension * (dimension + 1) / 2; s++) {
        put_lane(&parts->matrix[s], lane, &several->matrix[s]);
        put_lane(&parts->full[s], lane, &several->full[s]);
        for (int a = 0; a < dimension; a++)
            put_lane(&parts->push[s][a], lane, &several->push[s][a]);
    }
    for (int a = 0; a < dimension; a++) {
        put_lane(&parts->pull[a], lane, &several->pull[a]);
        put_lane(&parts->soft[a], lane, &several->soft[a]);
        put_lane(&parts->damp[a], lane, &several->damp[a]);
        for (int b = 0; b < dimension; b++)
            put_lane(&parts->velocity[a][b], lane, &several->velocity[a][b]);
    }
}

#endif
