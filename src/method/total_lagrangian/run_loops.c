/* Inner loops of total-Lagrangian SPH over runs, and the stresses of all points (equations:
 * force.c).
 *
 * The tensors H and A stand in planes: column b of all points, H_ab of point i at plane b, place d i + a. So
 * the numbers of a point stand beside each other as those of the displacements do, and every sum over
 * neighbours is one of short vectors times a number.
 *
 * Runs (points in sequence that share a row of weights, as those of a lattice do) are summed eight points at
 * a time: their d vectors of eight numbers are loaded from the neighbours' place, and the weights are read
 * once. The last eight points of a run are summed again where they overlap those before; nothing is read that
 * is written here. The other points: point_loops.c. */
#include "method/total_lagrangian/run_loops.h"

enum { MOST = 3 };

/* First of the eight points that begin at p of a run; the last eight where there are no more. */
INLINED size_t eight_at(const struct tl_block *block, size_t p)
{
    return block->first + (p + VEC <= block->count ? p : (size_t)block->count - VEC);
}

/* --- Gradients --- */

INLINED void gradient_run(struct tl_model *tl, const struct tl_block *block, const size_t d)
{
    const struct tl_rows *rows = &tl->gradient;
    const size_t begin = tl_first(rows, block->first), end = tl_last(rows, block->first);
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
            const double *other = u + rows->shift[k];
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
    const size_t begin = controlled ? tl_first(rows, block->first) : 0,
                 end = controlled ? tl_last(rows, block->first) : 0;
    const double *origin = tl->place + d * block->first;
    for (size_t p = 0; p < block->count; p += VEC) {
        const size_t i = eight_at(block, p);
        const double *u = tl->site_u + d * i, *H = tl->H + d * i;
        vec8 A[MOST][MOST], moment[MOST][MOST] = {{{0}}}, force[MOST] = {{0}};
        for (size_t k = begin; k < end; k++) {
            const ptrdiff_t shift = rows->shift[k];
            double X[MOST];
            for (size_t b = 0; b < d; b++)
                X[b] = origin[rows->shift[k] + (ptrdiff_t)b] - origin[b];
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
    }
}

/* --- Forces --- */

INLINED void force_run(struct tl_model *tl, const struct tl_block *block, const size_t d)
{
    const struct tl_rows *rows = &tl->transposed;
    const size_t begin = tl_first(rows, block->first), end = tl_last(rows, block->first);
    for (size_t p = 0; p < block->count; p += VEC) {
        const size_t s = eight_at(block, p);
        const bool extra = tl->extra != NULL && s < tl->cloud->points;
        vec8 sum[MOST][MOST] = {{{0}}};
        for (size_t k = begin; k < end; k++) {
            const double *A = tl->A + d * s + rows->shift[k];
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

/* --- One function for each dimension --- */

#define BLOCK_FUNCTIONS(d)                                                                                   \
    EACH_MACHINE static void gradient_##d(struct tl_model *tl, const struct tl_block *block)                 \
    {                                                                                                        \
        gradient_run(tl, block, d);                                                                          \
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
        force_run(tl, block, d);                                                                             \
    }
BLOCK_FUNCTIONS(1)
BLOCK_FUNCTIONS(2)
BLOCK_FUNCTIONS(3)

void tl_gradient_block(struct tl_model *tl, const struct tl_block *block)
{
    void (*const of[MOST])(struct tl_model *, const struct tl_block *) = {gradient_1, gradient_2, gradient_3};
    if (block->run)
        of[tl->cloud->dimension - 1](tl, block);
    else
        tl_gradient_points(tl, block);
}

void tl_stress_block(struct tl_model *tl, const struct tl_block *block)
{
    void (*const of[MOST])(struct tl_model *, const struct tl_block *) = {stress_1, stress_2, stress_3};
    of[tl->cloud->dimension - 1](tl, block);
    if (!block->run && tl->extra != NULL) tl_control_points(tl, block);
}

void tl_force_block(struct tl_model *tl, const struct tl_block *block)
{
    void (*const of[MOST])(struct tl_model *, const struct tl_block *) = {force_1, force_2, force_3};
    if (block->run)
        of[tl->cloud->dimension - 1](tl, block);
    else
        tl_force_points(tl, block);
}
