/* Inner loops of total-Lagrangian SPH over points that stand in no run (equations: force.c).
 *
 * One point at a time, its neighbours two at a time (rows have an even number of entries). In the plane one
 * vector holds the numbers of two neighbours as they stand in memory, (x, y, x', y'), so that they take one
 * load each; what the sums need in another order is made by shuffles within pairs, which are cheap. (Vectors
 * of four neighbours are slower: shuffles then share one unit with additions and multiplications.) Otherwise
 * a vector of four holds the `dimension` numbers of one neighbour, and the sums are taken in two interleaved
 * halves: one sum would wait for each addition before. */
#include "method/total_lagrangian/run_loops.h"

enum { MOST = 3 };

/* --- In the plane --- */

/* The two numbers at the base of each of two neighbours. */
INLINED void both(const double *base, const int32_t *shift, vec4 *result)
{
    *result = __builtin_shufflevector(VEC2(base + shift[0]), VEC2(base + shift[1]), 0, 1, 2, 3);
}

INLINED void twice(const double *own, vec4 *result)
{
    *result = __builtin_shufflevector(VEC2(own), VEC2(own), 0, 1, 0, 1);
}

/* (a, b, c, d): (a, a, c, c), (b, b, d, d), (b, a, d, c). */
#define EVEN(v) __builtin_shufflevector(v, v, 0, 0, 2, 2)
#define ODD(v) __builtin_shufflevector(v, v, 1, 1, 3, 3)
#define SWAPPED(v) __builtin_shufflevector(v, v, 1, 0, 3, 2)

/* (a, b) + (c, d). */
INLINED void fold(const vec4 *v, vec2 *result)
{
    *result = __builtin_shufflevector(*v, *v, 0, 1) + __builtin_shufflevector(*v, *v, 2, 3);
}

INLINED void gradient_in_plane(struct tl_model *tl, size_t i)
{
    const struct tl_rows *rows = &tl->gradient;
    const double *u = tl->site_u + 2 * i;
    vec4 own, straight = {0}, crossed = {0};
    vec2 same, other;
    twice(u, &own);
    const size_t first = tl_first(rows, i), count = tl_last(rows, i) - first;
    const int32_t *shift = rows->shift + first;
    const double *g = rows->weight + 2 * first;
    for (size_t k = 0; k < count; k += 2) {
        vec4 difference;
        both(u, shift + k, &difference);
        difference -= own;
        const vec4 weight = VEC4(g + 2 * k);
        straight += difference * weight;
        crossed += SWAPPED(difference) * weight;
    }
    fold(&straight, &same);
    fold(&crossed, &other);
    *(vec2 *)(tl->H + 2 * i) = __builtin_shufflevector(same, other, 0, 2);
    *(vec2 *)(tl->H + tl->plane + 2 * i) = __builtin_shufflevector(same, other, 3, 1);
}

INLINED void control_in_plane(struct tl_model *tl, size_t i)
{
    const struct tl_rows *rows = &tl->pair;
    const double *u = tl->site_u + 2 * i, *x = tl->place + 2 * i;
    const double *H0 = tl->H + 2 * i, *H1 = H0 + tl->plane;
    vec4 own_u, own_x, own_H0, own_H1, force = {0}, moment0 = {0}, moment1 = {0};
    vec2 sum;
    twice(u, &own_u);
    twice(x, &own_x);
    twice(H0, &own_H0);
    twice(H1, &own_H1);
    const size_t first = tl_first(rows, i), count = tl_last(rows, i) - first;
    const int32_t *shift = rows->shift + first;
    const double *weight = rows->weight + first;
    for (size_t k = 0; k < count; k += 2) {
        vec4 X, e, of_H0, of_H1;
        both(x, shift + k, &X);
        both(u, shift + k, &e);
        both(H0, shift + k, &of_H0);
        both(H1, shift + k, &of_H1);
        X -= own_x;
        const vec4 X0 = EVEN(X), X1 = ODD(X);
        e -= own_u;
        e -= 0.5 * ((of_H0 + own_H0) * X0 + (of_H1 + own_H1) * X1);
        e *= __builtin_shufflevector(VEC2(weight + k), VEC2(weight + k), 0, 0, 1, 1);
        force += e;
        moment0 += e * X0;
        moment1 += e * X1;
    }
    fold(&force, &sum);
    *(vec2 *)(tl->extra + 2 * i) = sum;
    fold(&moment0, &sum);
    *(vec2 *)(tl->A + 2 * i) -= 0.5 * sum;
    fold(&moment1, &sum);
    *(vec2 *)(tl->A + tl->plane + 2 * i) -= 0.5 * sum;
}

INLINED void force_in_plane(struct tl_model *tl, size_t s)
{
    const struct tl_rows *rows = &tl->transposed;
    const double *A0 = tl->A + 2 * s, *A1 = A0 + tl->plane;
    vec4 sum0 = {0}, sum1 = {0};
    vec2 sum, force = {0};
    const size_t first = tl_first(rows, s), count = tl_last(rows, s) - first;
    const int32_t *shift = rows->shift + first;
    const double *g = rows->weight + 2 * first;
    for (size_t k = 0; k < count; k += 2) {
        vec4 of_A0, of_A1;
        both(A0, shift + k, &of_A0);
        both(A1, shift + k, &of_A1);
        const vec4 weight = VEC4(g + 2 * k);
        sum0 += of_A0 * EVEN(weight);
        sum1 += of_A1 * ODD(weight);
    }
    sum0 += sum1;
    fold(&sum0, &sum);
    if (tl->extra != NULL && s < tl->cloud->points) force = VEC2(tl->extra + 2 * s);
    *(vec2 *)(tl->force + 2 * s) = force - sum;
}

/* --- On a line and in space --- */

INLINED void gradient_of(struct tl_model *tl, size_t i, const size_t d)
{
    const struct tl_rows *rows = &tl->gradient;
    const double *u = tl->site_u + d * i;
    const vec4 own = VEC4(u);
    vec4 even[MOST] = {0}, odd[MOST] = {0};
    for (size_t k = tl_first(rows, i), end = tl_last(rows, i); k < end; k += 2) {
        const vec4 first = VEC4(u + rows->shift[k]) - own;
        const vec4 second = VEC4(u + rows->shift[k + 1]) - own;
        const double *g = rows->weight + d * k;
        for (size_t b = 0; b < d; b++) {
            even[b] += first * g[b];
            odd[b] += second * g[d + b];
        }
    }
    for (size_t b = 0; b < d; b++)
        for (size_t a = 0; a < d; a++)
            tl->H[b * tl->plane + d * i + a] = even[b][a] + odd[b][a];
}

/* Hourglass forces of point i, and A without their moment. */
INLINED void control_of(struct tl_model *tl, size_t i, const size_t d)
{
    const struct tl_rows *rows = &tl->pair;
    const double *x = tl->place + d * i, *u = tl->site_u + d * i, *own_H = tl->H + d * i;
    const vec4 own = VEC4(u);
    vec4 H[MOST], moment[MOST] = {0}, force = {0};
    for (size_t b = 0; b < d; b++)
        H[b] = VEC4(own_H + b * tl->plane);
    for (size_t k = tl_first(rows, i), end = tl_last(rows, i); k < end; k++) {
        const ptrdiff_t shift = rows->shift[k];
        double X[MOST];
        vec4 seen = {0};
        for (size_t b = 0; b < d; b++) {
            X[b] = x[shift + (ptrdiff_t)b] - x[b];
            seen += (H[b] + VEC4(own_H + b * tl->plane + shift)) * X[b];
        }
        vec4 e = VEC4(u + shift) - own - 0.5 * seen;
        e *= rows->weight[k];
        force += e;
        for (size_t b = 0; b < d; b++)
            moment[b] += e * X[b];
    }
    for (size_t a = 0; a < d; a++) {
        tl->extra[d * i + a] = force[a];
        for (size_t b = 0; b < d; b++)
            tl->A[b * tl->plane + d * i + a] -= 0.5 * moment[b][a];
    }
}

INLINED void force_of(struct tl_model *tl, size_t s, const size_t d)
{
    const struct tl_rows *rows = &tl->transposed;
    const bool extra = tl->extra != NULL && s < tl->cloud->points;
    const double *A = tl->A + d * s;
    vec4 even[MOST] = {0}, odd[MOST] = {0};
    for (size_t k = tl_first(rows, s), end = tl_last(rows, s); k < end; k += 2) {
        const double *first = A + rows->shift[k];
        const double *second = A + rows->shift[k + 1];
        const double *g = rows->weight + d * k;
        for (size_t b = 0; b < d; b++) {
            even[b] += VEC4(first + b * tl->plane) * g[b];
            odd[b] += VEC4(second + b * tl->plane) * g[d + b];
        }
    }
    for (size_t a = 0; a < d; a++) {
        double force = extra ? tl->extra[d * s + a] : 0;
        for (size_t b = 0; b < d; b++)
            force -= even[b][a] + odd[b][a];
        tl->force[d * s + a] = force;
    }
}

/* --- One function for each dimension --- */

#define OF_BLOCK(name, d, call)                                                                              \
    static void name##_##d(struct tl_model *tl, const struct tl_block *block)                                \
    {                                                                                                        \
        for (size_t i = block->first, last = i + block->count; i < last; i++)                                \
            (call);                                                                                          \
    }
OF_BLOCK(gradient, 1, gradient_of(tl, i, 1))
OF_BLOCK(gradient, 2, gradient_in_plane(tl, i))
OF_BLOCK(gradient, 3, gradient_of(tl, i, 3))
OF_BLOCK(control, 1, control_of(tl, i, 1))
OF_BLOCK(control, 2, control_in_plane(tl, i))
OF_BLOCK(control, 3, control_of(tl, i, 3))
OF_BLOCK(force, 1, force_of(tl, i, 1))
OF_BLOCK(force, 2, force_in_plane(tl, i))
OF_BLOCK(force, 3, force_of(tl, i, 3))

const struct tl_point_loops OF_PROCESSOR(tl_point_loops) = {
    {gradient_1, gradient_2, gradient_3}, {control_1, control_2, control_3}, {force_1, force_2, force_3}};
