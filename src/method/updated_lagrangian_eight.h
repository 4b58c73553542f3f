/* Sums over the neighbours of eight particles in sequence at a time, one in each lane of a vector.
 *
 * Where particles are numbered in some order (lattices, rings) the neighbours of one stand at much the same
 * distances in memory as those of the next. So the lists of eight particles are merged into one of distances
 * in memory, and for each of them eight pairs are taken at once, with contiguous loads from the planes of
 * struct updated. A place that is no neighbour of some particle is out of its reach, as the lists are
 * complete: the slope of the kernel is 0 there and adds nothing. So the sums, in ascending order, do not
 * depend on when the lists were made. Cubic spline only. Inlined into the instances of
 * updated_lagrangian_rate.c.
 *
 * A list is taken in chunks: the first loop over a chunk makes what the pairs have between them (distance,
 * slope of the kernel, viscosity) and adds it to L and grad v, the second adds the stresses. In space one
 * loop would need 33 sums and as many other numbers at once, more than there are registers. */
#ifndef SELAS_UPDATED_LAGRANGIAN_EIGHT_H
#define SELAS_UPDATED_LAGRANGIAN_EIGHT_H

#include "method/updated_lagrangian_contract.h"

/* What all pairs have in common. */
struct eight_constants {
    double inverse_length, scale, usual, alpha, beta, repulsion, one_side;
};

enum { CHUNK = 16 };

/* Pairs of eight particles: x_i - x_j, m W'/r, Pi, f^4. */
struct chunk {
    vec8 d[3][CHUNK], force[CHUNK], pressure[CHUNK], power[CHUNK];
};

#define OWN(component) VEC8(own + (component)*stride)
#define OTHER(component) VEC8(other + (component)*stride)

/* W'/r, f^4 and Pi of eight pairs; the last two only where they are on. `own` and `other`: the first
 * component of both (the other ones stand `stride` further on each). */
INLINED void meet(const struct updated *updated, const struct eight_constants *constants, const bool viscous,
                  const bool repulsive, const double *own, const double *other, const vec8 *square,
                  const vec8 *approach, vec8 *slope, vec8 *power, vec8 *viscosity)
{
    const struct updated_layout layout = updated->layout;
    const size_t stride = updated->stride;
    const bool even = updated->even;
    vec8 length = {0};
    length += 1;
    if (!even) length = (OWN(layout.length) + OTHER(layout.length)) / 2;
    vec8 q;
    vec8_root(square, &q);
    q *= constants->inverse_length;
    vec8 shorter = length; /* 1 / length */
    if (!even) {
        shorter = 1 / length;
        q *= shorter;
    }
    const vec8 h = constants->usual * length, far = *square + .01 * h * h;
    const vec8 mean = (OWN(layout.density) + OTHER(layout.density)) / 2;
    const vec8 both = far * mean;
    vec8 each = q; /* one division for all */
    if (viscous) each *= both;
    const vec8 inverse = 1 / each;
    const vec8 outer = WHERE(q < 2, 2 - q), inner = WHERE(q < 1, 1 - q);
    const vec8 outer_square = outer * outer, inner_square = inner * inner;
    *slope = constants->scale * (2 * inner_square - outer_square / 2) * inverse;
    if (viscous) *slope *= both;
    for (int k = 0; !even && k < updated->dimension + 2; k++)
        *slope *= shorter;
    if (repulsive) {
        const vec8 f = constants->repulsion * (outer_square * outer - 4 * inner_square * inner);
        *power = f * f * (f * f);
    }
    if (viscous) {
        const vec8 common = inverse * q, phi = h * *approach * (common * mean);
        const vec8 product = (constants->beta * phi - constants->alpha) * phi * (common * far);
        *viscosity = WHERE(*approach < constants->one_side, product);
    }
}

/* The first loop, over the places `shift` of the chunk. */
INLINED void add_strain(const struct updated *updated, const struct eight_constants *constants,
                        const int dimension, const bool viscous, const bool repulsive, const double *own,
                        const int32_t *shift, int count, struct chunk *chunk, struct eight_sums *sums)
{
    const struct updated_layout layout = updated->layout;
    const size_t stride = updated->stride;
    vec8 velocity[3][3], matrix[6];
    memcpy(velocity, sums->velocity, sizeof velocity);
    memcpy(matrix, sums->matrix, sizeof matrix);
    for (int k = 0; k < count; k++) {
        const double *other = own + shift[k];
        vec8 d[3], change[3], square = {0}, approach = {0}, slope, power, viscosity;
        for (int a = 0; a < dimension; a++) {
            d[a] = OWN((size_t)a) - OTHER((size_t)a);
            change[a] = OTHER(layout.velocity + (size_t)a) - OWN(layout.velocity + (size_t)a);
            square += d[a] * d[a];
            approach -= change[a] * d[a];
            chunk->d[a][k] = d[a];
        }
        meet(updated, constants, viscous, repulsive, own, other, &square, &approach, &slope, &power,
             &viscosity);
        const vec8 span = slope * OTHER(layout.span);
        chunk->force[k] = slope * OTHER(layout.mass);
        if (viscous) chunk->pressure[k] = viscosity;
        if (repulsive) chunk->power[k] = power;
        for (int a = 0; a < dimension; a++) {
            const vec8 strain = span * d[a];
            for (int b = 0; b < dimension; b++)
                velocity[b][a] += change[b] * strain;
            for (int b = a; b < dimension; b++)
                matrix[updated_component[dimension][a][b]] -= d[b] * strain;
        }
        if (!updated->pressed) continue;
        const vec8 volume = slope * OTHER(layout.volume);
        for (int a = 0; a < dimension; a++)
            for (int b = a; b < dimension; b++)
                sums->full[updated_component[dimension][a][b]] -= d[b] * volume * d[a];
    }
    memcpy(sums->velocity, velocity, sizeof velocity);
    memcpy(sums->matrix, matrix, sizeof matrix);
}

/* The second: m (s_j / rho_j^2 + f^4 (R_i + R_j) - Pi I) grad W into push, m grad W into `pull`, which
 * s_i / rho_i^2 multiplies when all is summed. */
INLINED void add_stress(const struct updated *updated, const int dimension, const bool viscous,
                        const bool repulsive, const double *own, const int32_t *shift, int count,
                        const struct chunk *chunk, struct eight_sums *sums, vec8 pull[3])
{
    const struct updated_layout layout = updated->layout;
    const size_t stride = updated->stride;
    const int stresses = dimension * (dimension + 1) / 2;
    vec8 push[6][3], total[3];
    memcpy(push, sums->push, sizeof push);
    memcpy(total, pull, sizeof total);
    for (int k = 0; k < count; k++) {
        const double *other = own + shift[k];
        vec8 force[3];
        for (int a = 0; a < dimension; a++) {
            force[a] = chunk->force[k] * chunk->d[a][k];
            total[a] += force[a];
        }
        for (int s = 0; s < stresses; s++) {
            vec8 stress = OTHER(layout.tension + (size_t)s);
            if (repulsive)
                stress += chunk->power[k] *
                          (OWN(layout.repulsion + (size_t)s) + OTHER(layout.repulsion + (size_t)s));
            if (viscous && s < dimension) stress -= chunk->pressure[k]; /* xx, yy, zz come first */
            for (int a = 0; a < dimension; a++)
                push[s][a] += stress * force[a];
        }
    }
    memcpy(sums->push, push, sizeof push);
    memcpy(pull, total, sizeof total);
}

/* Sums of the particles i ... i + 7; i is a multiple of eight. */
INLINED void updated_eight(const struct updated *updated, const int dimension, const bool viscous,
                           const bool repulsive, size_t i, struct eight_sums *sums)
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
    const size_t stride = updated->stride, begin = updated->neighbours.start[i];
    const double *own = updated->planes + VEC + i;
    const int32_t *shift = updated->shift + begin;
    const int total = (int)updated->shifts[i / VEC];
    struct chunk chunk;
    vec8 pull[3] = {{0}};
    for (int k = 0; k < total; k += CHUNK) {
        const int count = k + CHUNK < total ? CHUNK : total - k;
        add_strain(updated, &constants, dimension, viscous, repulsive, own, shift + k, count, &chunk, sums);
        add_stress(updated, dimension, viscous, repulsive, own, shift + k, count, &chunk, sums, pull);
    }
    for (int s = 0; s < dimension * (dimension + 1) / 2; s++)
        for (int a = 0; a < dimension; a++)
            sums->push[s][a] += OWN(updated->layout.tension + (size_t)s) * pull[a];
}

#undef OWN
#undef OTHER

#endif
