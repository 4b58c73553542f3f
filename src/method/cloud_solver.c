/* The sparse system of the pair correction, (C w C^T) x = r, matrix-free.
 *
 * For x = (f, grad f / 2) with a smooth f a pair sees only third derivatives of f, so that the eigenvalues
 * fall as the sixth power of the wave number: conjugate gradients with the diagonal alone take thousands of
 * turns (15^3 points: 4,000 for 5e-7). So the smooth part is preconditioned by Galerkin's matrix on cubic
 * B-splines f with knots a few spacings apart, solved by Cholesky (a two-level additive Schwarz method;
 * Smith, Bjorstad & Gropp 1996, section 2). The matrix of the splines takes every STRIDE-th pair, times
 * STRIDE. (GSL's sparse GMRES wants the matrix stored and knows no preconditioner.) */
#include "method/cloud_pairs.h"

#include "base/gsl_errors.h"
#include "base/memory.h"

#include <gsl/gsl_blas.h>
#include <gsl/gsl_linalg.h>
#include <math.h>
#include <string.h>

enum { MOST_SPLINES = 2000, STRIDE = 4, LIMIT = 1000, NUMBERS = 4, QUADRATICS = 10 };

struct cloud_solver {
    const struct cloud_pairs *pairs;
    size_t cells[3], splines[3], total;
    double step[3];
    gsl_matrix *factor; /* Cholesky factor of the splines' matrix */
    gsl_vector *small;  /* [total] */
    double *p, *q, *z, *scale;
    size_t nulls;
    double *null; /* [nulls][(d + 1) * points]: orthonormal basis of the null space */
};

double cloud_pair_sees(const struct cloud_pairs *pairs, const double *multiplier, size_t i, size_t k)
{
    const size_t d = pairs->d;
    const double *own = multiplier + (d + 1) * i;
    const double *other = multiplier + (d + 1) * pairs->index[k];
    double sum = own[0] - other[0];
    for (size_t c = 0; c < d; c++)
        sum += (own[c + 1] + other[c + 1]) * pairs->offset[d * k + c];
    return sum;
}

void cloud_solver_free(struct cloud_solver **freed)
{
    struct cloud_solver *solver = *freed;
    if (solver == NULL) return;
    if (solver->factor != NULL) gsl_matrix_free(solver->factor);
    if (solver->small != NULL) gsl_vector_free(solver->small);
    array_free(solver->p);
    array_free(solver->q);
    array_free(solver->z);
    array_free(solver->scale);
    array_free(solver->null);
    array_free(solver);
    *freed = NULL;
}

/* Knots: as close as MOST_SPLINES allows, but not closer than two spacings. */
static void choose_knots(struct cloud_solver *solver)
{
    const struct cloud_pairs *pairs = solver->pairs;
    for (double wide = 2;; wide *= 1.1) {
        solver->total = 1;
        for (size_t c = 0; c < 3; c++) {
            const double length = pairs->high[c] - pairs->low[c];
            solver->cells[c] = c < pairs->d ? (size_t)fmax(1, round(length / wide)) : 1;
            solver->step[c] = c < pairs->d ? length / (double)solver->cells[c] : 1;
            solver->splines[c] = c < pairs->d ? solver->cells[c] + 3 : 1;
            solver->total *= solver->splines[c];
        }
        if (solver->total <= MOST_SPLINES) return;
    }
}

/* The four cubic B-splines at s in [0, 1] of a cell, and their derivatives by s. */
static void cubic(double s, double value[4], double slope[4])
{
    const double t = 1 - s;
    value[0] = t * t * t / 6;
    value[1] = 2. / 3 - s * s + s * s * s / 2;
    value[2] = 2. / 3 - t * t + t * t * t / 2;
    value[3] = s * s * s / 6;
    slope[0] = -t * t / 2;
    slope[1] = -2 * s + 1.5 * s * s;
    slope[2] = 2 * t - 1.5 * t * t;
    slope[3] = s * s / 2;
}

/* Splines that do not vanish at a point: their numbers and, for each, 1 + d numbers (f, grad f / 2). */
static size_t splines_at(const struct cloud_solver *solver, size_t i, size_t index[64], double f[64][NUMBERS])
{
    const struct cloud_pairs *pairs = solver->pairs;
    double value[3][4] = {{1}, {1}, {1}};
    double slope[3][4] = {{0}};
    size_t first[3] = {0};
    size_t many[3] = {1, 1, 1};
    for (size_t c = 0; c < pairs->d; c++) {
        const double s = (pairs->position[3 * i + c] - pairs->low[c]) / solver->step[c];
        first[c] = (size_t)fmin(fmax(floor(s), 0), (double)(solver->cells[c] - 1));
        many[c] = 4;
        cubic(s - (double)first[c], value[c], slope[c]);
        for (size_t k = 0; k < 4; k++)
            slope[c][k] /= solver->step[c];
    }
    size_t count = 0;
    for (size_t z = 0; z < many[2]; z++)
        for (size_t y = 0; y < many[1]; y++)
            for (size_t x = 0; x < many[0]; x++) {
                index[count] =
                    first[0] + x + solver->splines[0] * (first[1] + y + solver->splines[1] * (first[2] + z));
                f[count][0] = value[0][x] * value[1][y] * value[2][z];
                f[count][1] = 0.5 * slope[0][x] * value[1][y] * value[2][z];
                f[count][2] = 0.5 * value[0][x] * slope[1][y] * value[2][z];
                f[count][3] = 0.5 * value[0][x] * value[1][y] * slope[2][z];
                count++;
            }
    return count;
}

/* What pair k of row i sees of each spline, merged into one list; returns its length. */
static size_t pair_splines(const struct cloud_solver *solver, size_t i, size_t k, size_t index[2 * 64],
                           double seen[2 * 64])
{
    const struct cloud_pairs *pairs = solver->pairs;
    size_t own[64];
    double f[64][NUMBERS];
    size_t count = 0;
    for (int side = 0; side < 2; side++) {
        const size_t many = splines_at(solver, side == 0 ? i : pairs->index[k], own, f);
        const size_t before = count;
        size_t at = 0; /* both lists ascend */
        for (size_t s = 0; s < many; s++) {
            double sum = side == 0 ? f[s][0] : -f[s][0];
            for (size_t c = 0; c < pairs->d; c++)
                sum += f[s][c + 1] * pairs->offset[pairs->d * k + c];
            while (at < before && index[at] < own[s])
                at++;
            if (at < before && index[at] == own[s]) {
                seen[at] += sum;
                continue;
            }
            index[count] = own[s];
            seen[count++] = sum;
        }
    }
    return count;
}

static selas_status factorise(struct cloud_solver *solver, struct messages *messages)
{
    const struct cloud_pairs *pairs = solver->pairs;
    gsl_matrix *matrix = solver->factor;
    size_t turn = 0;
    for (size_t i = 0; i < pairs->points; i++)
        for (size_t k = pairs->start[i]; k < pairs->start[i + 1]; k++) {
            size_t index[2 * 64];
            double seen[2 * 64];
            if (pairs->index[k] < i || turn++ % STRIDE != 0) continue;
            const size_t count = pair_splines(solver, i, k, index, seen);
            const double weight = STRIDE * pairs->weight[k];
            for (size_t a = 0; a < count; a++) {
                double *row = matrix->data + index[a] * matrix->tda;
                for (size_t b = 0; b < count; b++)
                    row[index[b]] += weight * seen[a] * seen[b];
            }
        }
    double largest = 0;
    for (size_t a = 0; a < solver->total; a++)
        largest = fmax(largest, gsl_matrix_get(matrix, a, a));
    for (size_t a = 0; a < solver->total; a++) /* the quadratic functions are its null space */
        gsl_matrix_set(matrix, a, a, gsl_matrix_get(matrix, a, a) + 1e-9 * largest);
    gsl_errors_returned();
    const int failed = gsl_linalg_cholesky_decomp1(matrix);
    gsl_errors_as_before();
    if (failed != 0) return fail(messages, SELAS_BAD_SCENE, "the points are too uneven for the cloud method");
    return SELAS_OK;
}

static double dot(size_t n, const double *a, const double *b)
{
    double sum = 0;
    for (size_t k = 0; k < n; k++)
        sum += a[k] * b[k];
    return sum;
}

/* Takes what lies along the first `count` null vectors out of x. */
static void project(const struct cloud_solver *solver, size_t count, double *x)
{
    const size_t n = (solver->pairs->d + 1) * solver->pairs->points;
    for (size_t a = 0; a < count; a++) {
        const double *null = solver->null + n * a;
        const double part = dot(n, null, x);
        for (size_t k = 0; k < n; k++)
            x[k] -= part * null[k];
    }
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
                project(solver, solver->nulls, x);
            const double length = sqrt(dot(n, x, x));
            if (!(length > 0)) continue;
            for (size_t k = 0; k < n; k++)
                x[k] /= length;
            solver->nulls++;
        }
}

selas_status cloud_solver_create(const struct cloud_pairs *pairs, struct cloud_solver **created,
                                 struct messages *messages)
{
    const size_t n = (pairs->d + 1) * pairs->points;
    *created = NULL;
    struct cloud_solver *solver = array_new(1, sizeof *solver);
    if (solver == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the pair correction");
    solver->pairs = pairs;
    choose_knots(solver);
    solver->p = array_new(n, sizeof *solver->p);
    solver->q = array_new(n, sizeof *solver->q);
    solver->z = array_new(n, sizeof *solver->z);
    solver->scale = array_new(n, sizeof *solver->scale);
    solver->null = array_new(QUADRATICS * n, sizeof *solver->null);
    gsl_errors_returned();
    solver->factor = gsl_matrix_calloc(solver->total, solver->total);
    solver->small = gsl_vector_calloc(solver->total);
    gsl_errors_as_before();
    selas_status status = SELAS_OK;
    if (solver->p == NULL || solver->q == NULL || solver->z == NULL || solver->scale == NULL ||
        solver->null == NULL || solver->factor == NULL || solver->small == NULL)
        status = fail(messages, SELAS_NO_MEMORY, "no memory for the pair correction");
    if (status == SELAS_OK && solver->null != NULL) make_null_space(solver);
    if (status == SELAS_OK) status = factorise(solver, messages);
    for (size_t i = 0; i < pairs->points && status == SELAS_OK; i++)
        for (size_t k = pairs->start[i]; k < pairs->start[i + 1]; k++) {
            double *scale = solver->scale + (pairs->d + 1) * i;
            scale[0] += pairs->weight[k];
            for (size_t c = 0; c < pairs->d; c++) {
                const double x = pairs->offset[pairs->d * k + c];
                scale[c + 1] += pairs->weight[k] * x * x;
            }
        }
    if (status != SELAS_OK) cloud_solver_free(&solver);
    *created = solver;
    return status;
}

/* q = C w C^T p. */
static void apply(const struct cloud_pairs *pairs, const double *p, double *q)
{
    const size_t d = pairs->d;
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < pairs->points; i++) {
        double sum[NUMBERS] = {0};
        for (size_t k = pairs->start[i]; k < pairs->start[i + 1]; k++) {
            const double t = pairs->weight[k] * cloud_pair_sees(pairs, p, i, k);
            sum[0] += t;
            for (size_t c = 0; c < d; c++)
                sum[c + 1] += t * pairs->offset[d * k + c];
        }
        memcpy(q + (d + 1) * i, sum, (d + 1) * sizeof *sum);
    }
}

/* z = D^-1 r + P (P^T A P)^-1 P^T r. */
static void precondition(struct cloud_solver *solver, const double *r, double *z)
{
    const size_t numbers = solver->pairs->d + 1;
    size_t index[64];
    double f[64][NUMBERS];
    gsl_vector_set_zero(solver->small);
    for (size_t i = 0; i < solver->pairs->points; i++) {
        const size_t count = splines_at(solver, i, index, f);
        for (size_t s = 0; s < count; s++)
            for (size_t c = 0; c < numbers; c++)
                solver->small->data[index[s]] += f[s][c] * r[numbers * i + c];
    }
    gsl_linalg_cholesky_svx(solver->factor, solver->small);
    for (size_t i = 0; i < solver->pairs->points; i++) {
        const size_t count = splines_at(solver, i, index, f);
        for (size_t c = 0; c < numbers; c++) {
            double sum = r[numbers * i + c] / solver->scale[numbers * i + c];
            for (size_t s = 0; s < count; s++)
                sum += f[s][c] * solver->small->data[index[s]];
            z[numbers * i + c] = sum;
        }
    }
}

int cloud_solve(struct cloud_solver *solver, double *r, double small, double *x)
{
    const size_t n = (solver->pairs->d + 1) * solver->pairs->points;
    double before = 0;
    memset(x, 0, n * sizeof *x);
    project(solver, solver->nulls, r); /* rounding */
    for (int turn = 0; turn < LIMIT; turn++) {
        if (turn % 20 == 0)
            if (sqrt(dot(n, r, r) / (double)n) <= small) return turn;
        precondition(solver, r, solver->z);
        project(solver, solver->nulls, solver->z);
        const double now = dot(n, r, solver->z);
        for (size_t k = 0; k < n; k++)
            solver->p[k] = solver->z[k] + (turn == 0 ? 0 : now / before * solver->p[k]);
        before = now;
        apply(solver->pairs, solver->p, solver->q);
        const double step = now / dot(n, solver->p, solver->q);
        for (size_t k = 0; k < n; k++) {
            x[k] += step * solver->p[k];
            r[k] -= step * solver->q[k];
        }
    }
    return -1;
}
