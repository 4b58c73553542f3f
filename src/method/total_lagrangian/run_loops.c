/* Inner loops of total-Lagrangian SPH over runs, and the stresses of all points (equations:
 * force.c).
 *
 * The tensors H and A stand in planes: column b of all points, H_ab of point i at plane b, place d i + a. So
 * the numbers of a point stand beside each other as those of the displacements do, and every sum over
 * neighbours is one of short vectors times a number.
 *
 * Runs (points in sequence that share a row of weights, as those of a lattice do) are summed a vector's
 * length of points at a time: their d vectors are loaded from the neighbours' place, and the weights are read
 * once. The last points of a run are summed again where they overlap those before; nothing is read that is
 * written here. The other points: point_loops.c. */
#include "method/total_lagrangian/run_loops.h"
#include "method/total_lagrangian/shuffles.h"

enum { MOST = 3, MOST_VECTORS = 4 };

/* Vectors that are summed together: in the plane, where a sum has few parts, those of two groups of points if
 * there are as many in a run (GROUP). Else sums wait for each other. */
INLINED size_t vectors_of(const size_t d)
{
    return d < 3 && 2 * LANES <= GROUP ? 2 * d : d;
}

/* First of `many` points that begin at p of a run; the last ones where there are no more. */
INLINED size_t points_at(const struct tl_block *block, size_t p, size_t many)
{
    return block->first + (p + many <= block->count ? p : block->count - many);
}

/* --- Gradients --- */

INLINED void gradient_run(struct tl_model *tl, const struct tl_block *block, const size_t d)
{
    const struct tl_rows *rows = &tl->gradient;
    const size_t begin = tl_first(rows, block->first), end = tl_last(rows, block->first);
    const size_t vectors = vectors_of(d), many = vectors / d * LANES;
    for (size_t p = 0; p < block->count; p += many) {
        const size_t i = points_at(block, p, many);
        const double *u = tl->site_u + d * i;
        lanes own[MOST_VECTORS], sum[MOST][MOST_VECTORS];
        for (size_t v = 0; v < vectors; v++) {
            own[v] = AT(u + LANES * v);
            for (size_t b = 0; b < d; b++)
                sum[b][v] = (lanes){0};
        }
        for (size_t k = begin; k < end; k++) {
            const double *other = u + rows->shift[k];
            const double *g = rows->weight + d * k;
            for (size_t v = 0; v < vectors; v++) {
                const lanes difference = AT(other + LANES * v) - own[v];
                for (size_t b = 0; b < d; b++)
                    sum[b][v] += difference * g[b];
            }
        }
        for (size_t b = 0; b < d; b++)
            for (size_t v = 0; v < vectors; v++)
                *(lanes *)(tl->H + b * tl->plane + d * i + LANES * v) = sum[b][v];
    }
}

/* --- Stresses and hourglass control --- */

/* V P(H) of LANES points by Hooke's or Saint Venant-Kirchhoff's law (elastic_law.c). */
INLINED void quadratic_law(const struct elastic *elastic, const size_t d, bool small, const lanes *volume,
                           lanes H[MOST][MOST], lanes P[MOST][MOST])
{
    lanes S[MOST][MOST], pressure = {0};
    const lanes mu = elastic->mu * *volume, lambda = elastic->plane_lambda * *volume;
    for (size_t a = 0; a < d; a++)
        for (size_t b = a; b < d; b++) {
            lanes twice = H[a][b] + H[b][a];
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
INLINED void any_law(const struct elastic *elastic, const size_t d, const lanes *volume, lanes H[MOST][MOST],
                     lanes P[MOST][MOST])
{
    for (int p = 0; p < LANES; p++) {
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

/* V P(H) of the LANES points from i on, which have the same law, in planes: A[b][v]. */
INLINED void stress_of_vector(const struct tl_model *tl, size_t i, const size_t d, lanes A[MOST][MOST])
{
    const struct elastic *elastic = &tl->elastic[i];
    const bool small = tl->linear || elastic->law == LAW_LINEAR;
    const lanes volume = AT(tl->cloud->volume + i);
    lanes H[MOST][MOST], P[MOST][MOST], part[MOST], component[MOST];
    for (size_t b = 0; b < d; b++) {
        for (size_t v = 0; v < d; v++)
            part[v] = AT(tl->H + b * tl->plane + d * i + LANES * v);
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

/* Hourglass forces of the points from i on and their moments: vectors first ... last - 1 of d. */
INLINED void control_run(const struct tl_model *tl, const struct tl_block *block, size_t i, const size_t d,
                         const size_t first, const size_t last, lanes force[MOST], lanes moment[MOST][MOST])
{
    const struct tl_rows *rows = &tl->pair;
    const double *origin = tl->place + d * block->origin;
    const double *u = tl->site_u + d * i, *H = tl->H + d * i;
    for (size_t k = tl_first(rows, block->first), end = tl_last(rows, block->first); k < end; k++) {
        const ptrdiff_t shift = rows->shift[k];
        double X[MOST];
        for (size_t b = 0; b < d; b++)
            X[b] = origin[shift + (ptrdiff_t)b] - origin[b];
        for (size_t v = first; v < last; v++) {
            lanes seen = {0};
            for (size_t b = 0; b < d; b++)
                seen +=
                    (AT(H + b * tl->plane + LANES * v) + AT(H + b * tl->plane + shift + LANES * v)) * X[b];
            lanes e = AT(u + shift + LANES * v) - AT(u + LANES * v) - 0.5 * seen;
            e *= rows->weight[k];
            force[v] += e;
            for (size_t b = 0; b < d; b++)
                moment[b][v] += e * X[b];
        }
    }
}

INLINED void stress_run(struct tl_model *tl, const struct tl_block *block, const size_t d)
{
    const bool controlled = tl->extra != NULL;
    for (size_t p = 0; p < block->count; p += LANES) {
        const size_t i = points_at(block, p, LANES), step = FEW_REGISTERS && d == 3 ? 1 : d;
        lanes A[MOST][MOST], moment[MOST][MOST] = {{{0}}}, force[MOST] = {{0}};
        for (size_t v = 0; controlled && v < d; v += step)
            control_run(tl, block, i, d, v, v + step, force, moment);
        stress_of_vector(tl, i, d, A);
        for (size_t v = 0; v < d; v++) {
            for (size_t b = 0; b < d; b++)
                *(lanes *)(tl->A + b * tl->plane + d * i + LANES * v) = A[b][v] - 0.5 * moment[b][v];
            if (controlled) *(lanes *)(tl->extra + d * i + LANES * v) = force[v];
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

INLINED bool one_law(const struct elastic *elastic)
{
    bool same = true;
    for (int n = 1; n < GROUP; n++)
        same = same && elastic[n].law == elastic->law && elastic[n].mu == elastic->mu &&
               elastic[n].plane_lambda == elastic->plane_lambda && elastic[n].lambda == elastic->lambda;
    return same;
}

/* Whether GROUP points go together does not depend on the vector's width: numbers of single points are
 * rounded otherwise. */
INLINED void stress_points(struct tl_model *tl, const struct tl_block *block, const size_t d)
{
    const size_t last = (size_t)block->first + block->count;
    for (size_t i = block->first, next; i < last; i = next) {
        const bool group = i + GROUP <= last && one_law(&tl->elastic[i]);
        next = group ? i + GROUP : i + 1;
        if (!group) stress_point(tl, i, d);
        for (size_t from = i; group && from < next; from += LANES) {
            lanes A[MOST][MOST];
            stress_of_vector(tl, from, d, A);
            for (size_t b = 0; b < d; b++)
                for (size_t v = 0; v < d; v++)
                    *(lanes *)(tl->A + b * tl->plane + d * from + LANES * v) = A[b][v];
        }
    }
}

/* --- Forces --- */

INLINED void force_run(struct tl_model *tl, const struct tl_block *block, const size_t d)
{
    const struct tl_rows *rows = &tl->transposed;
    const size_t begin = tl_first(rows, block->first), end = tl_last(rows, block->first);
    const size_t vectors = vectors_of(d), many = vectors / d * LANES;
    for (size_t p = 0; p < block->count; p += many) {
        const size_t s = points_at(block, p, many);
        const bool extra = tl->extra != NULL && s < tl->cloud->points;
        lanes sum[MOST][MOST_VECTORS] = {{{0}}};
        for (size_t k = begin; k < end; k++) {
            const double *A = tl->A + d * s + rows->shift[k];
            const double *g = rows->weight + d * k;
            for (size_t b = 0; b < d; b++)
                for (size_t v = 0; v < vectors; v++)
                    sum[b][v] += AT(A + b * tl->plane + LANES * v) * g[b];
        }
        for (size_t v = 0; v < vectors; v++) {
            lanes force = extra ? AT(tl->extra + d * s + LANES * v) : (lanes){0};
            for (size_t b = 0; b < d; b++)
                force -= sum[b][v];
            *(lanes *)(tl->force + d * s + LANES * v) = force;
        }
    }
}

/* --- One function for each dimension --- */

#define OF_DIMENSION(d)                                                                                      \
    static void gradient_##d(struct tl_model *tl, const struct tl_block *block)                              \
    {                                                                                                        \
        gradient_run(tl, block, d);                                                                          \
    }                                                                                                        \
    static void stress_##d(struct tl_model *tl, const struct tl_block *block)                                \
    {                                                                                                        \
        if (block->run)                                                                                      \
            stress_run(tl, block, d);                                                                        \
        else                                                                                                 \
            stress_points(tl, block, d);                                                                     \
    }                                                                                                        \
    static void force_##d(struct tl_model *tl, const struct tl_block *block)                                 \
    {                                                                                                        \
        force_run(tl, block, d);                                                                             \
    }
OF_DIMENSION(1)
OF_DIMENSION(2)
OF_DIMENSION(3)

const struct tl_run_loops OF_PROCESSOR(tl_run_loops) = {
    {gradient_1, gradient_2, gradient_3}, {stress_1, stress_2, stress_3}, {force_1, force_2, force_3}};
