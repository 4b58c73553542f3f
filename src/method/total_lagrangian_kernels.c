/* Inner loops of total-Lagrangian SPH, for one block of points at a time (equations:
 * total_lagrangian_force.c).
 *
 * The tensors H and A stand in planes: column b of all points, H_ab of point i at plane b, place d i + a. So
 * the numbers of a point stand beside each other as those of the displacements do, and every sum over
 * neighbours is one of short vectors times a number.
 *
 * Runs (points in sequence whose neighbours stand at the same distances in memory with the same weights, as
 * those of a lattice do) are summed eight points at a time: their d vectors of eight numbers are loaded from
 * the neighbours' place, and the weights are read once. The other points are summed one at a time, with a
 * vector of four numbers of which the first d count. The last eight points of a run are summed again where
 * they overlap those before; nothing is read that is written here. */
#include "method/total_lagrangian_kernels.h"

enum { MOST = 3 };

/* Distance in memory from the first point of the row's run to neighbour k, in points. */
INLINED ptrdiff_t shift_of(const struct tl_rows *rows, const struct tl_block *block, size_t k)
{
    return (ptrdiff_t)rows->index[k] - (ptrdiff_t)block->pattern;
}

/* First of the eight points that begin at p of a run; the last eight where there are no more. */
INLINED size_t eight_at(const struct tl_block *block, size_t p)
{
    return block->first + (p + VEC <= block->count ? p : (size_t)block->count - VEC);
}

/* --- Gradients --- */

INLINED void gradient_run(struct tl_model *tl, const struct tl_block *block, const size_t d)
{
    const struct tl_rows *rows = &tl->gradient;
    const size_t begin = rows->start[block->pattern], end = rows->start[block->pattern + 1];
    for (size_t p = 0; p < block->count; p += VEC) {
        const size_t i = eight_at(block, p);
        const double *u = tl->site_u + d * i;
        vec8 own[MOST], sum[MOST][MOST];
        for (size_t v = 0; v < d; v++) {
            own[v] = VEC8(u + VEC * v);
            for (size_t b = 0; b < d; b++)
                sum[b][v] = (vec8){0};
        }
        for (size_t k = begin; k < end; k++) {
            const double *other = u + (ptrdiff_t)d * shift_of(rows, block, k);
            const double *g = rows->weight + d * k;
            for (size_t v = 0; v < d; v++) {
                const vec8 difference = VEC8(other + VEC * v) - own[v];
                for (size_t b = 0; b < d; b++)
                    sum[b][v] += difference * g[b];
            }
        }
        for (size_t b = 0; b < d; b++)
            for (size_t v = 0; v < d; v++)
                *(vec8 *)(tl->H + b * tl->plane + d * i + VEC * v) = sum[b][v];
    }
}

/* Sums are taken in two interleaved halves: one sum would wait for each addition before. */
INLINED void gradient_points(struct tl_model *tl, const struct tl_block *block, const size_t d)
{
    const struct tl_rows *rows = &tl->gradient;
    for (size_t i = block->first; i < block->first + block->count; i++) {
        const vec4 own = VEC4(tl->site_u + d * i);
        const size_t end = rows->start[i + 1];
        vec4 even[MOST] = {0}, odd[MOST] = {0};
        size_t k = rows->start[i];
        for (; k + 1 < end; k += 2) {
            const vec4 first = VEC4(tl->site_u + d * rows->index[k]) - own;
            const vec4 second = VEC4(tl->site_u + d * rows->index[k + 1]) - own;
            const double *g = rows->weight + d * k;
            for (size_t b = 0; b < d; b++) {
                even[b] += first * g[b];
                odd[b] += second * g[d + b];
            }
        }
        if (k < end) {
            const vec4 last = VEC4(tl->site_u + d * rows->index[k]) - own;
            for (size_t b = 0; b < d; b++)
                even[b] += last * rows->weight[d * k + b];
        }
        for (size_t b = 0; b < d; b++)
            for (size_t a = 0; a < d; a++)
                tl->H[b * tl->plane + d * i + a] = even[b][a] + odd[b][a];
    }
}

/* --- Stresses and hourglass control --- */

/* d vectors of eight points' numbers, point by point, into one vector for each component, and back. */
INLINED void apart(const size_t d, const vec8 *together, vec8 *component)
{
    const vec8 *t = together;
    if (d == 1) {
        component[0] = t[0];
    } else if (d == 2) {
        component[0] = __builtin_shufflevector(t[0], t[1], 0, 2, 4, 6, 8, 10, 12, 14);
        component[1] = __builtin_shufflevector(t[0], t[1], 1, 3, 5, 7, 9, 11, 13, 15);
    } else {
        const vec8 x = __builtin_shufflevector(t[0], t[1], 0, 3, 6, 9, 12, 15, 0, 0);
        const vec8 y = __builtin_shufflevector(t[0], t[1], 1, 4, 7, 10, 13, 0, 0, 0);
        const vec8 z = __builtin_shufflevector(t[0], t[1], 2, 5, 8, 11, 14, 0, 0, 0);
        component[0] = __builtin_shufflevector(x, t[2], 0, 1, 2, 3, 4, 5, 10, 13);
        component[1] = __builtin_shufflevector(y, t[2], 0, 1, 2, 3, 4, 8, 11, 14);
        component[2] = __builtin_shufflevector(z, t[2], 0, 1, 2, 3, 4, 9, 12, 15);
    }
}

INLINED void together(const size_t d, const vec8 *c, vec8 *t)
{
    if (d == 1) {
        t[0] = c[0];
    } else if (d == 2) {
        t[0] = __builtin_shufflevector(c[0], c[1], 0, 8, 1, 9, 2, 10, 3, 11);
        t[1] = __builtin_shufflevector(c[0], c[1], 4, 12, 5, 13, 6, 14, 7, 15);
    } else {
        const vec8 first = __builtin_shufflevector(c[0], c[1], 0, 8, 0, 1, 9, 0, 2, 10);
        const vec8 second = __builtin_shufflevector(c[0], c[1], 0, 3, 11, 0, 4, 12, 0, 5);
        const vec8 third = __builtin_shufflevector(c[0], c[1], 13, 0, 6, 14, 0, 7, 15, 0);
        t[0] = __builtin_shufflevector(first, c[2], 0, 1, 8, 3, 4, 9, 6, 7);
        t[1] = __builtin_shufflevector(second, c[2], 10, 1, 2, 11, 4, 5, 12, 7);
        t[2] = __builtin_shufflevector(third, c[2], 0, 13, 2, 3, 14, 5, 6, 15);
    }
}

/* V P(H) of eight points by Hooke's or Saint Venant-Kirchhoff's law (elastic_law.c). */
INLINED void quadratic_law(const struct elastic *elastic, const size_t d, bool small, const vec8 *volume,
                           vec8 H[MOST][MOST], vec8 P[MOST][MOST])
{
    vec8 S[MOST][MOST], pressure = {0};
    const vec8 mu = elastic->mu * *volume, lambda = elastic->plane_lambda * *volume;
    for (size_t a = 0; a < d; a++)
        for (size_t b = a; b < d; b++) {
            vec8 twice = H[a][b] + H[b][a];
            for (size_t c = 0; c < d && !small; c++)
                twice += H[c][a] * H[c][b];
            if (a == b) pressure += 0.5 * twice;
            S[a][b] = S[b][a] = mu * twice;
        }
    pressure *= lambda;
    for (size_t a = 0; a < d; a++)
        S[a][a] += pressure;
    for (size_t a = 0; a < d; a++)
        for (size_t b = 0; b < d; b++) {
            P[a][b] = S[a][b];
            for (size_t c = 0; c < d && !small; c++)
                P[a][b] += H[a][c] * S[c][b];
        }
}

/* The same by any law, point by point. */
INLINED void any_law(const struct elastic *elastic, const size_t d, const vec8 *volume, vec8 H[MOST][MOST],
                     vec8 P[MOST][MOST])
{
    for (int p = 0; p < VEC; p++) {
        double own[9], stress[9];
        for (size_t a = 0; a < d; a++)
            for (size_t b = 0; b < d; b++)
                own[d * a + b] = H[a][b][p];
        elastic_stress(elastic, own, stress);
        for (size_t a = 0; a < d; a++)
            for (size_t b = 0; b < d; b++)
                P[a][b][p] = (*volume)[p] * stress[d * a + b];
    }
}

/* V P(H) of the eight points from i on, which have the same law, in planes: A[b][v]. */
INLINED void stress_of_eight(const struct tl_model *tl, size_t i, const size_t d, vec8 A[MOST][MOST])
{
    const struct elastic *elastic = &tl->elastic[i];
    const bool small = tl->linear || elastic->law == LAW_LINEAR;
    const vec8 volume = VEC8(tl->cloud->volume + i);
    vec8 H[MOST][MOST], P[MOST][MOST], part[MOST], component[MOST];
    for (size_t b = 0; b < d; b++) {
        for (size_t v = 0; v < d; v++)
            part[v] = VEC8(tl->H + b * tl->plane + d * i + VEC * v);
        apart(d, part, component);
        for (size_t a = 0; a < d; a++)
            H[a][b] = component[a];
    }
    if (small || elastic->law == LAW_SAINT_VENANT_KIRCHHOFF)
        quadratic_law(elastic, d, small, &volume, H, P);
    else
        any_law(elastic, d, &volume, H, P);
    for (size_t b = 0; b < d; b++) {
        for (size_t a = 0; a < d; a++)
            component[a] = P[a][b];
        together(d, component, A[b]);
    }
}

INLINED void stress_run(struct tl_model *tl, const struct tl_block *block, const size_t d)
{
    const struct tl_rows *rows = &tl->pair;
    const bool controlled = tl->extra != NULL;
    const size_t begin = controlled ? rows->start[block->pattern] : 0,
                 end = controlled ? rows->start[block->pattern + 1] : 0;
    const double *origin = tl->site_position + 3 * (size_t)block->pattern;
    for (size_t p = 0; p < block->count; p += VEC) {
        const size_t i = eight_at(block, p);
        const double *u = tl->site_u + d * i, *H = tl->H + d * i;
        vec8 A[MOST][MOST], moment[MOST][MOST] = {{{0}}}, force[MOST] = {{0}};
        for (size_t k = begin; k < end; k++) {
            const ptrdiff_t shift = (ptrdiff_t)d * shift_of(rows, block, k);
            double X[MOST];
            for (size_t b = 0; b < d; b++)
                X[b] = tl->site_position[3 * (size_t)rows->index[k] + b] - origin[b];
            for (size_t v = 0; v < d; v++) {
                vec8 seen = {0};
                for (size_t b = 0; b < d; b++)
                    seen += (VEC8(H + b * tl->plane + VEC * v) + VEC8(H + b * tl->plane + shift + VEC * v)) *
                            X[b];
                vec8 e = VEC8(u + shift + VEC * v) - VEC8(u + VEC * v) - 0.5 * seen;
                e *= rows->weight[k];
                force[v] += e;
                for (size_t b = 0; b < d; b++)
                    moment[b][v] += e * X[b];
            }
        }
        stress_of_eight(tl, i, d, A);
        for (size_t v = 0; v < d; v++) {
            for (size_t b = 0; b < d; b++)
                *(vec8 *)(tl->A + b * tl->plane + d * i + VEC * v) = A[b][v] - 0.5 * moment[b][v];
            if (controlled) *(vec8 *)(tl->extra + d * i + VEC * v) = force[v];
        }
    }
}

/* Hourglass forces of point i, and A without their moment. */
INLINED void control_point(struct tl_model *tl, size_t i, const size_t d)
{
    const struct tl_rows *rows = &tl->pair;
    const vec4 u = VEC4(tl->site_u + d * i);
    vec4 H[MOST], moment[MOST] = {0}, force = {0};
    for (size_t b = 0; b < d; b++)
        H[b] = VEC4(tl->H + b * tl->plane + d * i);
    for (size_t k = rows->start[i]; k < rows->start[i + 1]; k++) {
        const size_t j = rows->index[k];
        double X[MOST];
        vec4 seen = {0};
        for (size_t b = 0; b < d; b++) {
            X[b] = tl->site_position[3 * j + b] - tl->site_position[3 * i + b];
            seen += (H[b] + VEC4(tl->H + b * tl->plane + d * j)) * X[b];
        }
        vec4 e = VEC4(tl->site_u + d * j) - u - 0.5 * seen;
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

/* V P(H) of point i into A. */
INLINED void stress_point(struct tl_model *tl, size_t i, const size_t d)
{
    double H[9], P[9];
    struct elastic elastic = tl->elastic[i];
    if (tl->linear) elastic.law = LAW_LINEAR;
    tl_tensor(tl, i, H);
    elastic_stress(&elastic, H, P);
    for (size_t a = 0; a < d; a++)
        for (size_t b = 0; b < d; b++)
            tl->A[b * tl->plane + d * i + a] = tl->cloud->volume[i] * P[d * a + b];
}

INLINED bool eight_of_one_law(const struct elastic *elastic)
{
    bool same = true;
    for (int n = 1; n < VEC; n++)
        same = same && elastic[n].law == elastic->law && elastic[n].mu == elastic->mu &&
               elastic[n].plane_lambda == elastic->plane_lambda && elastic[n].lambda == elastic->lambda;
    return same;
}

INLINED void stress_points(struct tl_model *tl, const struct tl_block *block, const size_t d)
{
    const size_t last = (size_t)block->first + block->count;
    for (size_t i = block->first, next; i < last; i = next) {
        const bool eight = i + VEC <= last && eight_of_one_law(&tl->elastic[i]);
        next = eight ? i + VEC : i + 1;
        if (eight) {
            vec8 A[MOST][MOST];
            stress_of_eight(tl, i, d, A);
            for (size_t b = 0; b < d; b++)
                for (size_t v = 0; v < d; v++)
                    *(vec8 *)(tl->A + b * tl->plane + d * i + VEC * v) = A[b][v];
        } else {
            stress_point(tl, i, d);
        }
        for (size_t k = i; tl->extra != NULL && k < next; k++)
            control_point(tl, k, d);
    }
}

/* --- Forces --- */

INLINED void force_run(struct tl_model *tl, const struct tl_block *block, const size_t d)
{
    const struct tl_rows *rows = &tl->transposed;
    const size_t begin = rows->start[block->pattern], end = rows->start[block->pattern + 1];
    for (size_t p = 0; p < block->count; p += VEC) {
        const size_t s = eight_at(block, p);
        const bool extra = tl->extra != NULL && s < tl->cloud->points;
        vec8 sum[MOST][MOST] = {{{0}}};
        for (size_t k = begin; k < end; k++) {
            const double *A = tl->A + (ptrdiff_t)d * ((ptrdiff_t)s + shift_of(rows, block, k));
            const double *g = rows->weight + d * k;
            for (size_t b = 0; b < d; b++)
                for (size_t v = 0; v < d; v++)
                    sum[b][v] += VEC8(A + b * tl->plane + VEC * v) * g[b];
        }
        for (size_t v = 0; v < d; v++) {
            vec8 force = extra ? VEC8(tl->extra + d * s + VEC * v) : (vec8){0};
            for (size_t b = 0; b < d; b++)
                force -= sum[b][v];
            *(vec8 *)(tl->force + d * s + VEC * v) = force;
        }
    }
}

INLINED void force_points(struct tl_model *tl, const struct tl_block *block, const size_t d)
{
    const struct tl_rows *rows = &tl->transposed;
    for (size_t s = block->first; s < block->first + block->count; s++) {
        const bool extra = tl->extra != NULL && s < tl->cloud->points;
        const size_t end = rows->start[s + 1];
        vec4 even[MOST] = {0}, odd[MOST] = {0};
        size_t k = rows->start[s];
        for (; k + 1 < end; k += 2) {
            const double *first = tl->A + d * rows->index[k], *second = tl->A + d * rows->index[k + 1];
            const double *g = rows->weight + d * k;
            for (size_t b = 0; b < d; b++) {
                even[b] += VEC4(first + b * tl->plane) * g[b];
                odd[b] += VEC4(second + b * tl->plane) * g[d + b];
            }
        }
        if (k < end)
            for (size_t b = 0; b < d; b++)
                even[b] += VEC4(tl->A + b * tl->plane + d * rows->index[k]) * rows->weight[d * k + b];
        for (size_t a = 0; a < d; a++) {
            double force = extra ? tl->extra[d * s + a] : 0;
            for (size_t b = 0; b < d; b++)
                force -= even[b][a] + odd[b][a];
            tl->force[d * s + a] = force;
        }
    }
}

/* --- One function for each dimension --- */

#define BLOCK_FUNCTIONS(d)                                                                                   \
    EACH_MACHINE static void gradient_##d(struct tl_model *tl, const struct tl_block *block)                 \
    {                                                                                                        \
        if (block->run)                                                                                      \
            gradient_run(tl, block, d);                                                                      \
        else                                                                                                 \
            gradient_points(tl, block, d);                                                                   \
    }                                                                                                        \
    EACH_MACHINE static void stress_##d(struct tl_model *tl, const struct tl_block *block)                   \
    {                                                                                                        \
        if (block->run)                                                                                      \
            stress_run(tl, block, d);                                                                        \
        else                                                                                                 \
            stress_points(tl, block, d);                                                                     \
    }                                                                                                        \
    EACH_MACHINE static void force_##d(struct tl_model *tl, const struct tl_block *block)                    \
    {                                                                                                        \
        if (block->run)                                                                                      \
            force_run(tl, block, d);                                                                         \
        else                                                                                                 \
            force_points(tl, block, d);                                                                      \
    }
BLOCK_FUNCTIONS(1)
BLOCK_FUNCTIONS(2)
BLOCK_FUNCTIONS(3)

void tl_gradient_block(struct tl_model *tl, const struct tl_block *block)
{
    void (*const of[MOST])(struct tl_model *, const struct tl_block *) = {gradient_1, gradient_2, gradient_3};
    of[tl->cloud->dimension - 1](tl, block);
}

void tl_stress_block(struct tl_model *tl, const struct tl_block *block)
{
    void (*const of[MOST])(struct tl_model *, const struct tl_block *) = {stress_1, stress_2, stress_3};
    of[tl->cloud->dimension - 1](tl, block);
}

void tl_force_block(struct tl_model *tl, const struct tl_block *block)
{
    void (*const of[MOST])(struct tl_model *, const struct tl_block *) = {force_1, force_2, force_3};
    of[tl->cloud->dimension - 1](tl, block);
}
