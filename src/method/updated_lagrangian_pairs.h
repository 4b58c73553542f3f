/* Sums over pairs of particles, eight pairs at a time, one in each lane of a vector: what eight particles in
 * sequence (updated_lagrangian_eight.h) and single particles (updated_lagrangian_batch.h) have in common.
 * Inlined into the instances of updated_lagrangian_rate.c.
 *
 * Pairs come in chunks, and each chunk is gone over in short loops: differences; roots; kernel and viscosity;
 * L and grad v; stresses. One loop would need 36 sums in space and as many other numbers at once, more than
 * there are registers, and on the long way from a distance to the slope of the kernel the processor would
 * wait: it looks about a hundred instructions ahead, so that only in short loops are there many pairs on the
 * way. */
#ifndef SELAS_UPDATED_LAGRANGIAN_PAIRS_H
#define SELAS_UPDATED_LAGRANGIAN_PAIRS_H

#include "method/updated_lagrangian_contract.h"

/* What all pairs have in common. */
struct pair_constants {
    double inverse_length, inverse_square, scale, half_inverse_density, alpha, beta, repulsion, one_side;
};

/* What there is; constant where an instance is made for it. */
struct pair_switches {
    bool viscous, repulsive; /* artificial viscosity and stress */
    bool cubic, even;        /* cubic spline; one smoothing length */
};

enum { CHUNK = 12 };

/* Eight pairs each. */
struct chunk {
    vec8 d[3][CHUNK], change[3][CHUNK]; /* x_i - x_j, later m grad W; v_j - v_i */
    vec8 s[CHUNK], approach[CHUNK];     /* q^2, -change.d */
    vec8 shorter[CHUNK];                /* usual smoothing length over that of the pair, if it is another */
    vec8 mean[CHUNK];                   /* mean density over the usual one */
    vec8 inverse[CHUNK];                /* 1 / q without viscosity, else 1 / (q (q^2 + .01) mean) */
    vec8 span[CHUNK], force[CHUNK];     /* V W'/r, m W'/r */
    vec8 pressure[CHUNK], power[CHUNK]; /* Pi, f^4 */
};

/* Where the packed particles stand: component c of the eight on one side at own + c * own_stride; of the
 * eight on the other side of group k of pairs at other + shift[k] + c * other_stride. */
struct pairs {
    const double *own, *other;
    size_t own_stride, other_stride;
    const int32_t *shift;
    int count;
};

INLINED struct pair_constants pair_constants_of(const struct updated *updated)
{
    const double h = updated->smoothing_length, density = updated->material->density;
    return (struct pair_constants){
        .inverse_length = 1 / h,
        .inverse_square = 1 / (h * h),
        .scale = updated->slope_scale,
        .half_inverse_density = .5 / density,
        .alpha = updated->alpha * updated->sound_speed / density,
        .beta = updated->beta / density,
        .repulsion = updated->repulsion_scale,
        .one_side = updated->both_sides ? INFINITY : 0,
    };
}

#define OWN(component) VEC8(pairs->own + (component)*pairs->own_stride)
#define OTHER(component) VEC8(other + (component)*pairs->other_stride)

/* w'(q)/q and w(q) of the cubic spline by truncated powers, w = ((2 - q)^3 - 4 (1 - q)^3) / 6, each where
 * positive: no branch. */
INLINED void cubic_spline(const vec8 *q, const vec8 *inverse, vec8 *slope, vec8 *shape)
{
    const vec8 outer = WHERE(*q < 2, 2 - *q), inner = WHERE(*q < 1, 1 - *q);
    const vec8 outer_square = outer * outer, inner_square = inner * inner;
    *slope = (2 * inner_square - outer_square / 2) * *inverse;
    *shape = (1.0 / 6) * (outer_square * outer) - (4.0 / 6) * (inner_square * inner);
}

/* The same of any kernel, number by number. */
INLINED void other_kernel(const struct kernel *kernel, const int dimension, const vec8 *q, vec8 *slope,
                          vec8 *shape)
{
    for (int n = 0; n < VEC; n++) {
        const bool within = (*q)[n] < kernel->support;
        (*slope)[n] = within ? kernel->slope_over_q(dimension, (*q)[n]) : 0;
        (*shape)[n] = within ? kernel->shape(dimension, (*q)[n]) : 0;
    }
}

/* First loop: differences, and the square of what the inverse is of. */
INLINED void take_differences(const struct updated *updated, const struct pair_constants *constants,
                              const int dimension, const struct pair_switches on, const struct pairs *pairs,
                              struct chunk *chunk)
{
    const struct updated_layout layout = updated->layout;
    for (int k = 0; k < pairs->count; k++) {
        const double *other = pairs->other + pairs->shift[k];
        vec8 square = {0}, approach = {0};
        for (size_t a = 0; a < (size_t)dimension; a++) {
            const vec8 d = OWN(a) - OTHER(a), change = OTHER(layout.velocity + a) - OWN(layout.velocity + a);
            square += d * d;
            approach -= change * d;
            chunk->d[a][k] = d;
            chunk->change[a][k] = change;
        }
        chunk->approach[k] = approach;
        vec8 s = square * constants->inverse_square;
        if (!on.even) {
            const vec8 shorter = 2 / (OWN(layout.length) + OTHER(layout.length));
            s *= shorter * shorter;
            chunk->shorter[k] = shorter;
        }
        chunk->s[k] = chunk->inverse[k] = s;
        if (!on.viscous) continue;
        const vec8 mean = (OWN(layout.density) + OTHER(layout.density)) * constants->half_inverse_density;
        const vec8 both = (s + .01) * mean;
        chunk->mean[k] = mean;
        chunk->inverse[k] = s * (both * both);
    }
}

/* Second loop: x = 1 / sqrt(x), to rounding, of numbers well within the range of floats: from a root in
 * single precision by one step of third order. Roots and divisions in double take longer than all else that a
 * pair needs. */
INLINED void take_inverse_roots(int count, vec8 *x)
{
    for (int k = 0; k < count; k++) {
        float8 single = __builtin_convertvector(x[k], float8);
        float number[VEC];
        memcpy(number, &single, sizeof number);
#pragma omp simd
        for (int n = 0; n < VEC; n++)
            number[n] = 1 / sqrtf(number[n]);
        memcpy(&single, number, sizeof number);
        const vec8 y = __builtin_convertvector(single, vec8), e = 1 - x[k] * y * y;
        x[k] = y + y * e * (.5 + .375 * e);
    }
}

/* Third loop: the kernel and the viscosity. */
INLINED void weigh(const struct updated *updated, const struct pair_constants *constants, const int dimension,
                   const struct pair_switches on, const struct pairs *pairs, struct chunk *chunk)
{
    const struct updated_layout layout = updated->layout;
    for (int k = 0; k < pairs->count; k++) {
        const double *other = pairs->other + pairs->shift[k];
        const vec8 s = chunk->s[k], far = s + .01;
        vec8 over = chunk->inverse[k], slope = {0}, shape = {0};
        if (on.viscous) over *= far * chunk->mean[k];
        const vec8 q = s * over;
        if (on.cubic)
            cubic_spline(&q, &over, &slope, &shape);
        else
            other_kernel(updated->options.kernel, dimension, &q, &slope, &shape);
        slope *= constants->scale;
        for (int power = 0; !on.even && power < dimension + 2; power++)
            slope *= chunk->shorter[k];
        chunk->span[k] = slope * OTHER(layout.span);
        chunk->force[k] = slope * OTHER(layout.mass);
        if (on.repulsive) {
            const vec8 f = constants->repulsion * shape, f2 = f * f;
            chunk->power[k] = f2 * f2;
        }
        if (on.viscous) {
            const vec8 approach = chunk->approach[k], common = chunk->inverse[k] * q;
            vec8 phi = approach * constants->inverse_length * (common * chunk->mean[k]);
            if (!on.even) phi *= chunk->shorter[k];
            const vec8 viscosity = (constants->beta * phi - constants->alpha) * phi * (common * far);
            chunk->pressure[k] = WHERE(approach < constants->one_side, viscosity);
        }
    }
}

/* L with the ghosts of loaded faces, which carry a stress but do not deform: V W'/r = m W'/r / rho; before
 * the fourth loop. */
INLINED void add_full(const struct updated *updated, const int dimension, const struct pairs *pairs,
                      const struct chunk *chunk, struct eight_sums *sums)
{
    for (int k = 0; k < pairs->count; k++) {
        const double *other = pairs->other + pairs->shift[k];
        const vec8 volume = chunk->force[k] / OTHER(updated->layout.density);
        for (int a = 0; a < dimension; a++)
            for (int b = a; b < dimension; b++)
                sums->full[updated_component[dimension][a][b]] -= chunk->d[b][k] * volume * chunk->d[a][k];
    }
}

/* Fourth loop: L, the velocity gradient and m grad W, which s_i / rho_i^2 multiplies when all is summed.
 * Leaves m grad W in place of d. */
INLINED void add_strains(const int dimension, int count, struct chunk *restrict chunk,
                         struct eight_sums *restrict sums)
{
    for (int k = 0; k < count; k++) {
        vec8 d[3], change[3];
        const vec8 span = chunk->span[k], mass = chunk->force[k];
        for (int a = 0; a < dimension; a++) {
            d[a] = chunk->d[a][k];
            change[a] = chunk->change[a][k];
        }
        for (int a = 0; a < dimension; a++) {
            const vec8 strain = span * d[a], force = mass * d[a];
            sums->pull[a] += force;
            chunk->d[a][k] = force;
            for (int b = 0; b < dimension; b++)
                sums->velocity[b][a] += change[b] * strain;
            for (int b = a; b < dimension; b++)
                sums->matrix[updated_component[dimension][a][b]] -= d[b] * strain;
        }
    }
}

/* Fifth loop: m (s_j / rho_j^2 + f^4 (R_i + R_j) - Pi I) grad W, of the components first ... last - 1 of the
 * stress. */
INLINED void add_stresses(const struct updated *updated, const int dimension, const struct pair_switches on,
                          const int first, const int last, const struct pairs *pairs,
                          const struct chunk *restrict chunk, struct eight_sums *restrict sums)
{
    const size_t tension = updated->layout.tension, repulsion = updated->layout.repulsion;
    vec8 own[6];
    for (int s = first; s < last && on.repulsive; s++)
        own[s] = OWN(repulsion + (size_t)s);
    for (int k = 0; k < pairs->count; k++) {
        const double *other = pairs->other + pairs->shift[k];
        vec8 force[3];
        for (int a = 0; a < dimension; a++)
            force[a] = chunk->d[a][k];
        for (int s = first; s < last; s++) {
            vec8 stress = OTHER(tension + (size_t)s);
            if (on.repulsive) stress += chunk->power[k] * (own[s] + OTHER(repulsion + (size_t)s));
            if (on.viscous && s < dimension) stress -= chunk->pressure[k]; /* xx, yy, zz come first */
            for (int a = 0; a < dimension; a++)
                sums->push[s][a] += stress * force[a];
        }
    }
}

/* The loops as functions of their own, so that none has to care for the numbers of the others: for constant
 * dimension, and with constant switches where all that is usual is on. */
#define EACH_SWITCH(loop)                                                                                    \
    if (on.viscous && on.repulsive && on.cubic && on.even) {                                                 \
        const struct pair_switches as = {true, true, true, true};                                            \
        loop;                                                                                                \
    } else {                                                                                                 \
        const struct pair_switches as = on;                                                                  \
        loop;                                                                                                \
    }
#define LOOPS(dim)                                                                                           \
    EACH_MACHINE NOT_INLINED static void meet_##dim(                                                         \
        const struct updated *updated, const struct pair_constants *constants, struct pair_switches on,      \
        const struct pairs *pairs, struct chunk *chunk)                                                      \
    {                                                                                                        \
        EACH_SWITCH(take_differences(updated, constants, dim, as, pairs, chunk))                             \
        take_inverse_roots(pairs->count, chunk->inverse);                                                    \
        EACH_SWITCH(weigh(updated, constants, dim, as, pairs, chunk))                                        \
    }                                                                                                        \
    EACH_MACHINE NOT_INLINED static void strains_##dim(int count, struct chunk *restrict chunk,              \
                                                       struct eight_sums *restrict sums)                     \
    {                                                                                                        \
        add_strains(dim, count, chunk, sums);                                                                \
    }                                                                                                        \
    EACH_MACHINE NOT_INLINED static void stresses_##dim(                                                     \
        const struct updated *updated, struct pair_switches on, const struct pairs *pairs,                   \
        const struct chunk *restrict chunk, struct eight_sums *restrict sums)                                \
    {                                                                                                        \
        EACH_SWITCH(add_stresses(updated, dim, as, 0, dim, pairs, chunk, sums))                              \
        EACH_SWITCH(add_stresses(updated, dim, as, dim, dim *(dim + 1) / 2, pairs, chunk, sums))             \
    }
LOOPS(1)
LOOPS(2)
LOOPS(3)
#undef LOOPS
#undef EACH_SWITCH
#define OF_DIMENSION(name) (dimension == 1 ? name##_1 : dimension == 2 ? name##_2 : name##_3)

/* Adds all pairs. */
INLINED void add_pairs(const struct updated *updated, const struct pair_constants *constants,
                       const int dimension, const struct pair_switches on, const struct pairs *pairs,
                       struct eight_sums *sums)
{
    _Alignas(64) struct chunk chunk;
    for (int k = 0; k < pairs->count; k += CHUNK) {
        struct pairs some = *pairs;
        some.shift += k;
        some.count = k + CHUNK < pairs->count ? CHUNK : pairs->count - k;
        OF_DIMENSION(meet)(updated, constants, on, &some, &chunk);
        if (updated->pressed) add_full(updated, dimension, &some, &chunk, sums);
        OF_DIMENSION(strains)(some.count, &chunk, sums);
        OF_DIMENSION(stresses)(updated, on, &some, &chunk, sums);
    }
}

#undef OF_DIMENSION
#undef OWN
#undef OTHER

#endif
