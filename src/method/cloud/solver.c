/* The sparse system of the pair correction, (C w C^T) x = r, matrix-free.
 *
 * For x = (f, grad f / 2) with a smooth f a pair sees only third derivatives of f, so that the eigenvalues
 * fall as the sixth power of the wave number: conjugate gradients with the diagonal alone take thousands of
 * turns (15^3 points: 4,000 for 5e-7). So the smooth part is preconditioned by Galerkin's matrix on cubic
 * B-splines f with knots a few spacings apart (splines.c), solved by Cholesky (a two-level additive
 * Schwarz method; Smith, Bjorstad & Gropp 1996, section 2). (GSL's sparse GMRES wants the matrix stored and
 * knows no preconditioner.) */
#include "method/cloud/pairs.h"

#include "base/memory.h"
#include "base/vectors.h"
#include "method/cloud/splines.h"

#include <math.h>
#include <string.h>

enum { LIMIT = 1000, CHECKED = 20, NUMBERS = 4, QUADRATICS = 10 };

struct cloud_solver {
    const struct cloud_pairs *pairs;
    struct cloud_splines *splines;
    vec4 *p, *q, *z;
    double *scale;
    size_t nulls;
    double *null; /* [nulls][(d + 1) * points]: orthonormal basis of the null space */
};

static void free_solver(struct cloud_solver **freed)
{
    struct cloud_solver *solver = *freed;
    if (solver == NULL) return;
    OF_PROCESSOR(cloud_splines_free)(&solver->splines);
    array_free(solver->p);
    array_free(solver->q);
    array_free(solver->z);
    array_free(solver->scale);
    array_free(solver->null);
    array_free(solver);
    *freed = NULL;
}

static double dot(size_t n, const double *a, const double *b)
{
    double even = 0, odd = 0;
    size_t k = 0;
    for (; k + 2 <= n; k += 2) {
        even += a[k] * b[k];
        odd += a[k + 1] * b[k + 1];
    }
    return k < n ? even + odd + a[k] * b[k] : even + odd;
}

/* x -= (x . null) null. */
static void take_out(size_t n, const double *null, double *x)
{
    const double part = dot(n, null, x);
    for (size_t k = 0; k < n; k++)
        x[k] -= part * null[k];
}

/* (f, grad f / 2) of the quadratic functions, made orthonormal. */
static void make_null_space(struct cloud_solver *solver)
{
    const struct cloud_pairs *pairs = solver->pairs;
    const size_t d = pairs->d;
    const size_t n = (d + 1) * pairs->points;
    for (size_t a = 0; a <= d; a++)
        for (size_t b = a; b <= d; b++) { /* products of 1 (d) and the coordinates (0 .. d - 1) */
            double *x = solver->null + n * solver->nulls;
            for (size_t i = 0; i < pairs->points; i++) {
                double s[4] = {0};
                double *own = x + (d + 1) * i;
                for (size_t c = 0; c < d; c++)
                    s[c] = pairs->position[3 * i + c] - 0.5 * (pairs->low[c] + pairs->high[c]);
                s[d] = 1;
                own[0] = s[a] * s[b];
                for (size_t c = 0; c < d; c++)
                    own[c + 1] = 0.5 * ((a == c ? s[b] : 0) + (b == c ? s[a] : 0));
            }
            for (int sweep = 0; sweep < 2; sweep++)
                for (size_t before = 0; before < solver->nulls; before++)
                    take_out(n, solver->null + n * before, x);
            const double length = sqrt(dot(n, x, x));
            if (!(length > 0)) continue;
            for (size_t k = 0; k < n; k++)
                x[k] /= length;
            solver->nulls++;
        }
}

static selas_status create(const struct cloud_pairs *pairs, struct cloud_solver **created,
                           struct messages *messages)
{
    const size_t n = (pairs->d + 1) * pairs->points;
    *created = NULL;
    struct cloud_solver *solver = array_new(1, sizeof *solver);
    if (solver == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the pair correction");
    solver->pairs = pairs;
    solver->p = array_new(n, sizeof *solver->p);
    solver->q = array_new(n, sizeof *solver->q);
    solver->z = array_new(n, sizeof *solver->z);
    solver->scale = array_new(n, sizeof *solver->scale);
    solver->null = array_new(QUADRATICS * n, sizeof *solver->null);
    selas_status status = SELAS_OK;
    if (solver->p == NULL || solver->q == NULL || solver->z == NULL || solver->scale == NULL ||
        solver->null == NULL)
        status = fail(messages, SELAS_NO_MEMORY, "no memory for the pair correction");
    if (status == SELAS_OK && solver->null != NULL) make_null_space(solver);
    if (status == SELAS_OK) status = OF_PROCESSOR(cloud_splines_create)(pairs, &solver->splines, messages);
    for (size_t i = 0; i < pairs->points && status == SELAS_OK; i++)
        for (size_t k = pairs->start[i]; k < pairs->start[i + 1]; k++) {
            double *scale = solver->scale + (pairs->d + 1) * i;
            scale[0] += pairs->weight[k];
            for (size_t c = 0; c < pairs->d; c++) {
                const double x = pairs->offset[pairs->d * k + c];
                scale[c + 1] += pairs->weight[k] * x * x;
            }
        }
    if (status != SELAS_OK) free_solver(&solver);
    *created = solver;
    return status;
}

/* What pair k of row i sees of the multipliers: l_i - l_j + (g_i + g_j).(x_j - x_i). */
INLINED void pair_sees(const struct cloud_pairs *pairs, const vec4 *x, size_t i, size_t k, vec4 *seen)
{
    const size_t d = pairs->d;
    const vec4 *own = x + (d + 1) * i, *other = x + (d + 1) * pairs->index[k];
    vec4 sum = own[0] - other[0];
    for (size_t c = 0; c < d; c++)
        sum += (own[c + 1] + other[c + 1]) * pairs->offset[d * k + c];
    *seen = sum;
}

/* One row of q = C w C^T p. */
static void apply_row(const struct cloud_pairs *pairs, const vec4 *p, size_t i, vec4 *q)
{
    const size_t d = pairs->d;
    vec4 sum[NUMBERS] = {0};
    for (size_t k = pairs->start[i]; k < pairs->start[i + 1]; k++) {
        vec4 seen;
        pair_sees(pairs, p, i, k, &seen);
        seen *= pairs->weight[k];
        sum[0] += seen;
        for (size_t c = 0; c < d; c++)
            sum[c + 1] += seen * pairs->offset[d * k + c];
    }
    memcpy(q + (d + 1) * i, sum, (d + 1) * sizeof *sum);
}

static void apply(const struct cloud_pairs *pairs, const vec4 *p, vec4 *q)
{
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < pairs->points; i++)
        apply_row(pairs, p, i, q);
}

static void correct(struct cloud_pairs *pairs, const vec4 *x)
{
    const size_t d = pairs->d;
    for (size_t i = 0; i < pairs->points; i++)
        for (size_t k = pairs->start[i]; k < pairs->start[i + 1]; k++) {
            vec4 seen;
            pair_sees(pairs, x, i, k, &seen);
            for (size_t c = 0; c < d; c++)
                pairs->value[d * k + c] += pairs->weight[k] * seen[c];
        }
}

/* Products of each lane. */
static void dots(size_t n, const vec4 *a, const vec4 *b, vec4 *product)
{
    vec4 even = {0}, odd = {0};
    for (size_t k = 0; k + 1 < n; k += 2) {
        even += a[k] * b[k];
        odd += a[k + 1] * b[k + 1];
    }
    if (n % 2 == 1) even += a[n - 1] * b[n - 1];
    *product = even + odd;
}

/* Takes what lies along the null vectors out of x. */
static void project(const struct cloud_solver *solver, vec4 *x)
{
    const size_t n = (solver->pairs->d + 1) * solver->pairs->points;
    for (size_t a = 0; a < solver->nulls; a++) {
        const double *null = solver->null + n * a;
        vec4 part = {0}, odd = {0};
        for (size_t k = 0; k + 1 < n; k += 2) {
            part += null[k] * x[k];
            odd += null[k + 1] * x[k + 1];
        }
        if (n % 2 == 1) odd += null[n - 1] * x[n - 1];
        part += odd;
        for (size_t k = 0; k < n; k++)
            x[k] -= part * null[k];
    }
}

/* z = D^-1 r + P (P^T A P)^-1 P^T r. */
static void precondition(struct cloud_solver *solver, const vec4 *r, vec4 *z)
{
    const size_t n = (solver->pairs->d + 1) * solver->pairs->points;
    for (size_t k = 0; k < n; k++)
        z[k] = r[k] / solver->scale[k];
    OF_PROCESSOR(cloud_splines_add)(solver->splines, r, z);
}

/* Lanes whose residuals are not small yet (beyond the dimension they are 0): 1 for these, 0 for others. */
static bool unsolved(size_t n, const vec4 *r, double small, vec4 *open)
{
    vec4 square;
    bool any = false;
    dots(n, r, r, &square);
    for (int lane = 0; lane < 4; lane++) {
        const bool large = sqrt(square[lane] / (double)n) > small;
        (*open)[lane] = large;
        any = any || large;
    }
    return any;
}

static int solve(struct cloud_solver *solver, vec4 *r, double small, vec4 *x)
{
    const size_t n = (solver->pairs->d + 1) * solver->pairs->points;
    vec4 before = {0}, open = {0};
    memset(x, 0, n * sizeof *x);
    project(solver, r); /* rounding */
    for (int turn = 0; turn < LIMIT; turn++) {
        vec4 now, curvature, step = {0}, onward = {0};
        if (turn % CHECKED == 0 && !unsolved(n, r, small, &open)) return turn;
        precondition(solver, r, solver->z);
        project(solver, solver->z);
        dots(n, r, solver->z, &now);
        for (int lane = 0; lane < 4; lane++)
            if (turn > 0 && open[lane] > 0) onward[lane] = now[lane] / before[lane];
        for (size_t k = 0; k < n; k++)
            solver->p[k] = solver->z[k] + onward * solver->p[k];
        before = now;
        apply(solver->pairs, solver->p, solver->q);
        dots(n, solver->p, solver->q, &curvature);
        for (int lane = 0; lane < 4; lane++)
            if (open[lane] > 0) step[lane] = now[lane] / curvature[lane];
        for (size_t k = 0; k < n; k++) {
            x[k] += step * solver->p[k];
            r[k] -= step * solver->q[k];
        }
    }
    return -1;
}

const struct cloud_solvers OF_PROCESSOR(cloud_solvers) = {create, free_solver, solve, correct};
