/* Sums over pairs of particles, one pair in each lane of a vector: what particles in sequence and single
 * particles (gather.h) have in common. Inlined into the instances of block_rates.c.
 *
 * Pairs come in chunks, and each chunk is gone over in short loops: distances and differences; roots; kernel
 * and viscosity; L and grad v; stresses. One loop would need 42 sums in space and as many other numbers at
 * once, more than there are registers, and on the long way from a distance to the slope of the kernel the
 * processor would wait: it looks about a hundred instructions ahead, so that only in short loops are there
 * many pairs on the way.
 *
 * A pair needs as little as can be: what is the particle's own (s_i, R_i, the scale of the kernel, L_i^-1)
 * is taken out of the sums, constants are put together, and vectors of pairs none of which is in reach are
 * left out. */
#ifndef SELAS_METHOD_UPDATED_LAGRANGIAN_PAIRS_H
#define SELAS_METHOD_UPDATED_LAGRANGIAN_PAIRS_H

#include "method/updated_lagrangian/contract.h"

#if VECTOR_BYTES > 16
#include <immintrin.h>
#endif

/* What all pairs have in common. */
struct pair_constants {
    double inverse_square, closest; /* 1 / h^2; the square of the kernel's support */
    double alpha, beta;             /* of (beta b mean - alpha) b, b = (v_ij.x_ij) / (q (q^2 + .01) mean) */
    double one_side;
};

/* What there is; constant where an instance is made for it. */
struct pair_switches {
    bool viscous, repulsive; /* artificial viscosity and stress */
    bool cubic, even;        /* cubic spline; one smoothing length */
    bool pressed;            /* ghosts that carry a traction do not deform */
};

/* Vectors of pairs in a chunk, which stays in the first-level cache. */
enum { CHUNK = 12 };

/* LANES pairs each. */
struct chunk {
    lanes d[3][CHUNK], change[3][CHUNK]; /* x_i - x_j, later V grad W; v_j - v_i */
    lanes s[CHUNK], approach[CHUNK];     /* q^2, -change.d */
    lanes shorter[CHUNK];                /* usual smoothing length over that of the pair, if it is another */
    lanes mean[CHUNK];                   /* sum of the densities */
    lanes inverse[CHUNK];                /* 1 / q without viscosity, else 1 / (q (q^2 + .01) mean) */
    lanes span[CHUNK], volume[CHUNK];    /* V W'/r, over what deforms and over all */
    lanes power[CHUNK];                  /* f^4 */
    int reached[CHUNK], count;           /* which of them are in reach, and how many */
    bool within[CHUNK];
};

/* Where the packed particles stand: component c of those on one side at own + c * own_stride; of those on the
 * other side of vector k of pairs at other + shift[k] + c * other_stride. */
struct pairs {
    const double *own, *other;
    size_t own_stride, other_stride;
    const int32_t *shift;
    int count;
};

INLINED struct pair_constants pair_constants_of(const struct updated *updated)
{
    const double h = updated->smoothing_length, support = updated->options.kernel->support;
    /* phi = h v.x / (r^2 + .01 h^2) = b mean / h, Pi = (-alpha c phi + beta phi^2) / (mean / 2) */
    return (struct pair_constants){
        .inverse_square = 1 / (h * h),
        .closest = support * support,
        .alpha = 2 * updated->alpha * updated->sound_speed / h,
        .beta = 2 * updated->beta / (h * h),
        .one_side = updated->both_sides ? INFINITY : 0,
    };
}

#define OWN(component) AT(pairs->own + (component)*pairs->own_stride)
#define OTHER(component) AT(other + (component)*pairs->other_stride)

/* w'(q)/q and w(q), by which q that of the cubic spline is, by truncated powers, w = ((2 - q)^3 - 4 (1 -
 * q)^3) / 6, each where positive: no branch. Twice the slope and six times the shape: updated_slope_scale()
 * and updated_shape_scale(). */
INLINED void cubic_spline(const lanes *q, const lanes *inverse, lanes *slope, lanes *shape)
{
    const lanes outer = WHERE(*q < 2, 2 - *q), inner = WHERE(*q < 1, 1 - *q);
    const lanes outer_square = outer * outer, inner_square = 4 * inner * inner;
    *slope = (inner_square - outer_square) * *inverse;
    *shape = outer_square * outer - inner_square * inner;
}

/* The same of any kernel, number by number. */
INLINED void other_kernel(const struct kernel *kernel, const int dimension, const lanes *q, lanes *slope,
                          lanes *shape)
{
    for (int n = 0; n < LANES; n++) {
        const bool within = (*q)[n] < kernel->support;
        (*slope)[n] = within ? 2 * kernel->slope_over_q(dimension, (*q)[n]) : 0;
        (*shape)[n] = within ? 6 * kernel->shape(dimension, (*q)[n]) : 0;
    }
}

/* Some number in the vector is less than the limit. */
INLINED bool any_less(const lanes *x, double limit)
{
    const lanes_mask less = (lanes_mask)(*x < limit);
#if VECTOR_BYTES == 64
    return _mm512_movepi64_mask((__m512i)less) != 0;
#elif VECTOR_BYTES == 32
    return _mm256_movemask_pd((__m256d)less) != 0;
#else
    return (less[0] | less[1]) != 0;
#endif
}

/* First loop: distances, and whether somebody is in reach. */
INLINED void take_distances(const struct updated *updated, const struct pair_constants *constants,
                            const int dimension, const struct pair_switches on, const struct pairs *pairs,
                            struct chunk *chunk)
{
    for (int k = 0; k < pairs->count; k++) {
        const double *other = pairs->other + pairs->shift[k];
        lanes square = {0};
        for (size_t a = 0; a < (size_t)dimension; a++) {
            const lanes d = OWN(a) - OTHER(a);
            square += d * d;
            chunk->d[a][k] = d;
        }
        lanes s = square * constants->inverse_square;
        if (!on.even) {
            const lanes shorter = 2 / (OWN(updated->layout.length) + OTHER(updated->layout.length));
            s *= shorter * shorter;
            chunk->shorter[k] = shorter;
        }
        chunk->s[k] = s;
        chunk->within[k] = any_less(&s, constants->closest);
    }
    int count = 0;
    for (int k = 0; k < pairs->count; k++) {
        chunk->reached[count] = k;
        count += chunk->within[k];
    }
    chunk->count = count;
}

/* Second loop: the other differences, and the square of what the inverse is of. */
INLINED void take_differences(const struct updated *updated, const int dimension,
                              const struct pair_switches on, const struct pairs *pairs, struct chunk *chunk)
{
    const struct updated_layout layout = updated->layout;
    for (int n = 0; n < chunk->count; n++) {
        const int k = chunk->reached[n];
        const double *other = pairs->other + pairs->shift[k];
        lanes approach = {0};
        for (size_t a = 0; a < (size_t)dimension; a++) {
            const lanes change = OTHER(layout.velocity + a) - OWN(layout.velocity + a);
            if (on.viscous) approach -= change * chunk->d[a][k];
            chunk->change[a][k] = change;
        }
        const lanes s = chunk->s[k];
        if (!on.viscous) {
            chunk->inverse[k] = s;
            continue;
        }
        const lanes mean = OWN(layout.density) + OTHER(layout.density), both = (s + .01) * mean;
        chunk->approach[k] = approach;
        chunk->mean[k] = mean;
        chunk->inverse[k] = s * (both * both);
    }
}

/* Third loop: x = 1 / sqrt(x), to rounding. The first guess y is half the exponent taken from the number's
 * bits, to 3.5 %: |e| < .0692, e = 1 - x y^2. 1 / sqrt(1 - e) by the polynomial of third degree that comes
 * closest (1e-6), then by three terms of its series. Roots and divisions take longer than all else that a
 * pair needs. */
INLINED void take_inverse_roots(struct chunk *chunk)
{
    for (int n = 0; n < chunk->count; n++) {
        const int k = chunk->reached[n];
        lanes *x = chunk->inverse;
        const lanes square = x[k];
        const lanes guess = (lanes)(0x5fe6eb50c7b537a9 - ((lanes_bits)square >> 1));
        lanes e = 1 - square * guess * guess;
        const lanes y =
            guess * (0.99999917128758716 +
                     e * (0.49999925406266828 + e * (0.37634845857073469 + e * 0.31371374967740283)));
        e = 1 - square * y * y;
        x[k] = y + y * e * (.5 + .375 * e);
    }
}

/* Fourth loop: the kernel, the viscosity, and those parts of the forces that are a number for each pair:
 * what s_i, R_i and the viscosity multiply when all is summed. */
INLINED void weigh(const struct updated *updated, const struct pair_constants *constants, const int dimension,
                   const struct pair_switches on, const struct pairs *pairs, struct chunk *restrict chunk,
                   struct lane_sums *restrict sums)
{
    const struct updated_layout layout = updated->layout;
    for (int n = 0; n < chunk->count; n++) {
        const int k = chunk->reached[n];
        const double *other = pairs->other + pairs->shift[k];
        const lanes s = chunk->s[k];
        lanes over = chunk->inverse[k], slope = {0}, shape = {0}, d[3];
        if (on.viscous) over *= (s + .01) * chunk->mean[k];
        const lanes q = s * over;
        if (on.cubic)
            cubic_spline(&q, &over, &slope, &shape);
        else
            other_kernel(updated->options.kernel, dimension, &q, &slope, &shape);
        for (int power = 0; !on.even && power < dimension + 2; power++)
            slope *= chunk->shorter[k];
        chunk->span[k] = slope * OTHER(layout.span);
        if (on.pressed) chunk->volume[k] = slope * OTHER(layout.volume);
        const lanes mass = slope * OTHER(layout.mass);
        for (int a = 0; a < dimension; a++) {
            d[a] = chunk->d[a][k];
            sums->pull[a] += mass * d[a];
        }
        if (on.repulsive) {
            const lanes square = shape * shape, power = square * square, part = mass * power;
            chunk->power[k] = power;
            for (int a = 0; a < dimension; a++)
                sums->soft[a] += part * d[a];
        }
        if (on.viscous) {
            const lanes approach = WHERE(chunk->approach[k] < constants->one_side, chunk->approach[k]);
            lanes b = approach * (chunk->inverse[k] * q);
            if (!on.even) b *= chunk->shorter[k];
            lanes deforming = mass;
            if (on.pressed) deforming = chunk->span[k] * OTHER(layout.density);
            const lanes part = (constants->beta * (b * chunk->mean[k]) - constants->alpha) * b * deforming;
            for (int a = 0; a < dimension; a++)
                sums->damp[a] += part * d[a];
        }
    }
}

/* L with the ghosts of loaded faces, which carry a stress but do not deform; before the fifth loop. */
INLINED void add_full(const int dimension, const struct chunk *chunk, struct lane_sums *sums)
{
    for (int n = 0; n < chunk->count; n++) {
        const int k = chunk->reached[n];
        for (int a = 0; a < dimension; a++)
            for (int b = a; b < dimension; b++)
                sums->full[updated_component[dimension][a][b]] -=
                    chunk->d[b][k] * chunk->volume[k] * chunk->d[a][k];
    }
}

/* Fifth loop: the velocity gradient and L, each on its own where there are few registers. Leaves V grad W in
 * place of d. */
INLINED void add_strains(const int dimension, const bool pressed, const bool velocity, const bool matrix,
                         struct chunk *restrict chunk, struct lane_sums *restrict sums)
{
    for (int n = 0; n < chunk->count; n++) {
        const int k = chunk->reached[n];
        lanes d[3], change[3];
        const lanes span = chunk->span[k];
        for (int a = 0; a < dimension; a++) {
            d[a] = chunk->d[a][k];
            change[a] = chunk->change[a][k];
        }
        for (int a = 0; a < dimension; a++) {
            const lanes strain = span * d[a];
            for (int b = 0; velocity && b < dimension; b++)
                sums->velocity[b][a] += change[b] * strain;
            if (!matrix) continue;
            chunk->d[a][k] = (pressed ? chunk->volume[k] : span) * d[a];
            for (int b = a; b < dimension; b++)
                sums->matrix[updated_component[dimension][a][b]] -= d[b] * strain;
        }
    }
}

/* Sixth loop: V (s_j / rho_j + f^4 rho_j R_j) grad W. */
INLINED void add_stresses(const struct updated *updated, const int dimension, const struct pair_switches on,
                          const int first, const int last, const struct pairs *pairs,
                          const struct chunk *restrict chunk, struct lane_sums *restrict sums)
{
    const size_t tension = updated->layout.tension, repulsion = updated->layout.repulsion;
    for (int n = 0; n < chunk->count; n++) {
        const int k = chunk->reached[n];
        const double *other = pairs->other + pairs->shift[k];
        lanes force[3];
        for (int a = 0; a < dimension; a++)
            force[a] = chunk->d[a][k];
        for (int s = first; s < last; s++) {
            lanes stress = OTHER(tension + (size_t)s);
            if (on.repulsive) stress += chunk->power[k] * OTHER(repulsion + (size_t)s);
            for (int a = 0; a < dimension; a++)
                sums->push[s][a] += stress * force[a];
        }
    }
}

/* The loops as functions of their own, so that none has to care for the numbers of the others: for constant
 * dimension, and with constant switches where all that is usual is on. */
#define EACH_SWITCH(loop)                                                                                    \
    if (on.viscous && on.repulsive && on.cubic && on.even && !on.pressed) {                                  \
        const struct pair_switches as = {true, true, true, true, false};                                     \
        loop;                                                                                                \
    } else {                                                                                                 \
        const struct pair_switches as = on;                                                                  \
        loop;                                                                                                \
    }
#define LOOPS(dim)                                                                                           \
    NOT_INLINED static void meet_##dim(const struct updated *updated,                                        \
                                       const struct pair_constants *constants, struct pair_switches on,      \
                                       const struct pairs *pairs, struct chunk *chunk)                       \
    {                                                                                                        \
        EACH_SWITCH(take_distances(updated, constants, dim, as, pairs, chunk))                               \
        EACH_SWITCH(take_differences(updated, dim, as, pairs, chunk))                                        \
        take_inverse_roots(chunk);                                                                           \
    }                                                                                                        \
    NOT_INLINED static void weights_##dim(const struct updated *updated,                                     \
                                          const struct pair_constants *constants, struct pair_switches on,   \
                                          const struct pairs *pairs, struct chunk *restrict chunk,           \
                                          struct lane_sums *restrict sums){EACH_SWITCH(                      \
        weigh(updated, constants, dim, as, pairs, chunk,                                                     \
              sums))} NOT_INLINED static void strains_##dim(bool pressed, struct chunk *restrict chunk,      \
                                                            struct lane_sums *restrict sums)                 \
    {                                                                                                        \
        if (FEW_REGISTERS && dim == 3) {                                                                     \
            add_strains(dim, false, true, false, chunk, sums);                                               \
            if (pressed)                                                                                     \
                add_strains(dim, true, false, true, chunk, sums);                                            \
            else                                                                                             \
                add_strains(dim, false, false, true, chunk, sums);                                           \
        } else if (pressed) {                                                                                \
            add_strains(dim, true, true, true, chunk, sums);                                                 \
        } else {                                                                                             \
            add_strains(dim, false, true, true, chunk, sums);                                                \
        }                                                                                                    \
    }                                                                                                        \
    NOT_INLINED static void stresses_##dim(const struct updated *updated, struct pair_switches on,           \
                                           const struct pairs *pairs, const struct chunk *restrict chunk,    \
                                           struct lane_sums *restrict sums)                                  \
    {                                                                                                        \
        if (FEW_REGISTERS && dim == 3) {                                                                     \
            EACH_SWITCH(add_stresses(updated, dim, as, 0, 3, pairs, chunk, sums))                            \
            EACH_SWITCH(add_stresses(updated, dim, as, 3, 6, pairs, chunk, sums))                            \
        } else {                                                                                             \
            EACH_SWITCH(add_stresses(updated, dim, as, 0, dim *(dim + 1) / 2, pairs, chunk, sums))           \
        }                                                                                                    \
    }
LOOPS(1)
LOOPS(2)
LOOPS(3)
#undef LOOPS
#undef EACH_SWITCH
#define OF_DIMENSION(name) (dimension == 1 ? name##_1 : dimension == 2 ? name##_2 : name##_3)

/* Adds one chunk of the pairs, from number k on. */
INLINED void add_chunk(const struct updated *updated, const struct pair_constants *constants,
                       const int dimension, const struct pair_switches on, const struct pairs *pairs, int k,
                       struct lane_sums *sums)
{
    _Alignas(64) struct chunk chunk;
    struct pairs some = *pairs;
    some.shift += k;
    some.count = k + CHUNK < pairs->count ? CHUNK : pairs->count - k;
    OF_DIMENSION(meet)(updated, constants, on, &some, &chunk);
    OF_DIMENSION(weights)(updated, constants, on, &some, &chunk, sums);
    if (on.pressed) add_full(dimension, &chunk, sums);
    OF_DIMENSION(strains)(on.pressed, &chunk, sums);
    OF_DIMENSION(stresses)(updated, on, &some, &chunk, sums);
}

#undef OF_DIMENSION
#undef OWN
#undef OTHER

#endif
