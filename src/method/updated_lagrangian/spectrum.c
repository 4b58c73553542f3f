/* The two radii that limit the time step, each by Arnoldi's iteration (Saad 2011, Numerical methods for large
 * eigenvalue problems, chapter 6) about the body at rest, with the rates themselves as the operator (they are
 * linear there):
 *
 *   waves      v -> stress rate -> acceleration, viscosity and artificial stress off, and v -> acceleration
 *              by hourglass control, dampers at rest: eigenvalues -omega^2
 *   viscosity  v -> acceleration of the viscous term alone, beta off, between all pairs: eigenvalue -radius
 *
 * Between all pairs: the viscosity acts on approaching pairs only, but at a compressive front all pairs
 * approach, and there its whole matrix rules small disturbances. (Half that radius keeps a run finite,
 * because a disturbance that grows soon makes pairs recede, but leaves noise behind the front.) A wave, on
 * the other hand, finds its pairs approaching half of the time: its mean damping is half of the quotient of
 * the full matrix.
 *
 * Neither operator is symmetric, as L_i stands before both stresses. Of the Ritz values of the Krylov space
 * the largest theta is taken, with its residual |A x - theta x| on top: the eigenvalues of operators like
 * these, which are nearly normal, are no further from theta than that. */
#include "base/gsl_errors.h"
#include "base/memory.h"
#include "method/updated_lagrangian/updated_lagrangian.h"
#include "points/disorder.h"

#include <gsl/gsl_complex_math.h>
#include <gsl/gsl_eigen.h>
#include <math.h>
#include <string.h>

enum { STEPS = 40, CHECK = 4 };
static const double ENOUGH = 2e-3; /* residual over theta */

/* Work vectors of the iteration. */
struct iteration {
    double *vector; /* unknowns, and stresses behind them */
    double *y, *dydt;
    double *basis; /* [unknowns * (STEPS + 1)], orthonormal */
    double projected[STEPS + 1][STEPS];
    bool room;
};

/* Together: sums of the ranks' own numbers, in the order of one process. */
static double product_of(const struct updated *updated, const double *a, const double *b)
{
    struct ranks *ranks = updated->part.ranks;
    const size_t d = (size_t)updated->dimension, from = d * updated->lead, end = from + d * updated->own;
    double sum = 0;
    for (int r = 0; r < ranks_count(ranks); r++) {
        for (size_t i = r == ranks_me(ranks) ? from : end; i < end; i++)
            sum += a[i] * b[i];
        ranks_spread(ranks, r, &sum, sizeof sum);
    }
    return sum;
}

/* Rates of the body at rest with velocities v and stresses s (either may be NULL). */
static void evaluate(struct updated *updated, struct iteration *work, const double *v, const double *stress)
{
    struct model *model = &updated->model;
    const size_t unknowns = model->unknowns, points = updated->held;
    const struct drive quiet = {.time = 0};
    memset(work->y, 0, model->state_size * sizeof *work->y);
    if (v != NULL) memcpy(work->y + unknowns, v, unknowns * sizeof *v);
    for (size_t i = 0; i < points; i++)
        work->y[2 * unknowns + i] = updated->material->density;
    if (stress != NULL)
        memcpy(work->y + 2 * unknowns + points, stress, (size_t)updated->stresses * points * sizeof *stress);
    updated_rate(model, &quiet, work->y, work->dydt);
}

static void wave_map(struct updated *updated, struct iteration *work)
{
    const size_t extra = 2 * updated->model.unknowns + updated->held;
    evaluate(updated, work, work->vector, NULL);
    /* evaluate() clears y, so that the rates must not be read from it */
    const size_t bytes = (updated->model.state_size - extra) * sizeof(double);
    double *stress = work->vector + updated->model.unknowns;
    memcpy(stress, work->dydt + extra, bytes);
    evaluate(updated, work, work->vector, stress);
}

static void viscous_map(struct updated *updated, struct iteration *work)
{
    evaluate(updated, work, work->vector, NULL);
}

/* Largest Ritz value of the first n vectors, its residual, and the vector in the basis (its real part). */
static bool largest_ritz(const struct iteration *work, size_t n, double *theta, double *residual,
                         double *part)
{
    double *numbers = array_new((3 * n + 2) * n, sizeof *numbers);
    if (numbers == NULL) return false;
    gsl_matrix_view matrix_view = gsl_matrix_view_array(numbers, n, n);
    gsl_matrix_complex_view vectors_view = gsl_matrix_complex_view_array(numbers + n * n, n, n);
    gsl_vector_complex_view values_view = gsl_vector_complex_view_array(numbers + 3 * n * n, n);
    gsl_matrix *matrix = &matrix_view.matrix;
    gsl_matrix_complex *vectors = &vectors_view.matrix;
    gsl_vector_complex *values = &values_view.vector;
    gsl_errors_returned();
    gsl_eigen_nonsymmv_workspace *space = gsl_eigen_nonsymmv_alloc(n);
    bool found = space != NULL;
    if (found) {
        for (size_t i = 0; i < n; i++)
            for (size_t j = 0; j < n; j++)
                gsl_matrix_set(matrix, i, j, work->projected[i][j]);
        found = gsl_eigen_nonsymmv(matrix, values, vectors, space) == 0;
    }
    *theta = 0;
    for (size_t j = 0; found && j < n; j++) {
        const double size = gsl_complex_abs(gsl_vector_complex_get(values, j));
        if (!(size > *theta)) continue;
        *theta = size;
        *residual = work->projected[n][n - 1] * gsl_complex_abs(gsl_matrix_complex_get(vectors, n - 1, j));
        for (size_t i = 0; i < n; i++) {
            const gsl_complex entry = gsl_matrix_complex_get(vectors, i, j);
            part[i] = GSL_REAL(entry);
        }
    }
    gsl_eigen_nonsymmv_free(space);
    gsl_errors_as_before();
    array_free(numbers);
    return found;
}

/* Takes what is along the first n vectors of the basis out of the rates of the velocities, the next vector.
 */
static void project(const struct updated *updated, struct iteration *work, size_t n)
{
    const size_t unknowns = updated->model.unknowns;
    double *next = work->basis + unknowns * n;
    memcpy(next, work->dydt + unknowns, unknowns * sizeof *next);
    for (size_t j = 0; j < n; j++) {
        const double *known = work->basis + unknowns * j;
        const double product = product_of(updated, known, next);
        for (size_t i = 0; i < unknowns; i++)
            next[i] -= product * known[i];
        work->projected[j][n - 1] = product;
    }
    const double rest = sqrt(product_of(updated, next, next));
    work->projected[n][n - 1] = rest;
    for (size_t i = 0; i < unknowns && rest > 0; i++)
        next[i] /= rest;
}

/* Largest eigenvalue of a map from velocities to accelerations; leaves its vector in work->vector. */
static double iterate(struct updated *updated, struct iteration *work,
                      void (*map)(struct updated *updated, struct iteration *work))
{
    const size_t unknowns = updated->model.unknowns;
    uint64_t seed = 2016;
    double *first = work->basis, theta = 0, residual = 0, part[STEPS] = {0};
    const size_t before = (size_t)updated->dimension * updated->first; /* numbers of the body */
    for (size_t i = 0; i < before; i++)
        seed = seed * 6364136223846793005u + 1442695040888963407u;
    for (size_t i = 0; i < unknowns; i++) {
        seed = seed * 6364136223846793005u + 1442695040888963407u;
        first[i] = (double)(seed >> 11) * 0x1p-52 - 1;
    }
    const double length = sqrt(product_of(updated, first, first));
    for (size_t i = 0; i < unknowns; i++)
        first[i] /= length;
    memset(work->projected, 0, sizeof work->projected);
    size_t n = 0;
    for (bool done = false; n < STEPS && !done;) {
        memcpy(work->vector, work->basis + unknowns * n, unknowns * sizeof *work->vector);
        map(updated, work);
        project(updated, work, ++n);
        if (!isfinite(work->projected[n][n - 1])) return 0;
        const bool exhausted = !(work->projected[n][n - 1] > 1e-12 * fabs(work->projected[0][0]));
        if (!exhausted && n % CHECK != 0) continue;
        work->room = work->room && updated_all_have(updated, largest_ritz(work, n, &theta, &residual, part));
        done = exhausted || !work->room || residual < ENOUGH * theta;
    }
    memset(work->vector, 0, unknowns * sizeof *work->vector);
    for (size_t j = 0; j < n; j++)
        for (size_t i = 0; i < unknowns; i++)
            work->vector[i] += part[j] * work->basis[unknowns * j + i];
    return theta + residual;
}

/* Damping rate of the motion in work->vector: v.Dv / v.v. */
static double quotient(struct updated *updated, struct iteration *work)
{
    const size_t unknowns = updated->model.unknowns;
    viscous_map(updated, work);
    const double product = product_of(updated, work->vector, work->dydt + unknowns);
    const double square = product_of(updated, work->vector, work->vector);
    return square > 0 ? -product / square : 0;
}

static void measure(struct updated *updated, struct iteration *work, struct spectrum *spectrum)
{
    const double alpha = updated->alpha, beta = updated->beta;
    const bool repulsive = updated->repulsive;
    const unsigned long evaluations = updated->model.evaluations;
    updated->repulsive = false;
    updated->both_sides = true;
    updated->alpha = updated->beta = 0;
    updated->velocities_displace = true;
    spectrum->omega = sqrt(iterate(updated, work, wave_map));
    updated->velocities_displace = false;
    updated->alpha = alpha;
    if (alpha > 0) {
        spectrum->wave_damping = quotient(updated, work) / 2;
        spectrum->viscous = iterate(updated, work, viscous_map);
    }
    updated->beta = beta;
    updated->both_sides = false;
    updated->repulsive = repulsive;
    updated->model.evaluations = evaluations;
}

size_t updated_spectrum_bytes(const struct updated *updated)
{
    const struct model *model = &updated->model;
    return model->bytes + sizeof(double) * (4 * model->state_size + (STEPS + 2) * model->unknowns);
}

selas_status updated_spectrum(struct model *model, struct spectrum *spectrum, struct messages *messages)
{
    struct iteration work = {.vector = array_new(model->state_size, sizeof(double)),
                             .y = array_new(model->state_size, sizeof(double)),
                             .dydt = array_new(model->state_size, sizeof(double)),
                             .basis = array_new(model->unknowns, (STEPS + 1) * sizeof(double))};
    work.room = work.vector != NULL && work.y != NULL && work.dydt != NULL && work.basis != NULL;
    if (!updated_all_have(updated_of(model), work.room)) work.room = false;
    *spectrum = (struct spectrum){0};
    if (work.room) measure(updated_of(model), &work, spectrum);
    array_free(work.vector);
    array_free(work.basis);
    array_free(work.y);
    array_free(work.dydt);
    return work.room ? SELAS_OK : fail(messages, SELAS_NO_MEMORY, "no memory to measure the spectrum");
}

/* As cloud_mean_power() of the body. */
double updated_mean_power(const struct updated *updated, double order)
{
    struct ranks *ranks = updated->part.ranks;
    const struct cloud *cloud = updated->cloud;
    double sums[2] = {0};
    for (int r = 0; r < ranks_count(ranks); r++) {
        const size_t end = updated->made + updated->own;
        for (size_t i = r == ranks_me(ranks) ? updated->made : end; i < end; i++) {
            const double spacing = pow(cloud->volume[i], 1.0 / cloud->dimension);
            sums[0] += cloud->volume[i] * pow(spacing / cloud->spacing, order);
            sums[1] += cloud->volume[i];
        }
        ranks_spread(ranks, r, sums, sizeof sums);
    }
    return sums[0] / sums[1];
}

/* Of the k-th own particle, from its acceleration. */
static void add_disorder(const struct updated *updated, const double *acceleration, size_t k, double sums[2])
{
    const struct cloud *cloud = updated->cloud;
    const size_t i = updated->made + k;
    const double each = updated->material->density * pow(cloud->volume[i], 1.0 / updated->dimension);
    double force[3] = {0};
    for (size_t a = 0; a < (size_t)updated->dimension; a++)
        force[a] = each * acceleration[a];
    disorder_add(sums, cloud, &updated->model.scene->body, updated->reach, i, force);
}

/* By the rates themselves, under a unit pull on all sides. */
selas_status updated_disorder(struct updated *updated, double *disorder, struct messages *messages)
{
    struct model *model = &updated->model;
    const size_t dimension = (size_t)updated->dimension, stresses = (size_t)updated->stresses;
    const bool repulsive = updated->repulsive;
    const unsigned long evaluations = model->evaluations;
    double *stress = array_new(stresses * updated->held, sizeof *stress), sums[2] = {0};
    struct iteration work = {.y = array_new(model->state_size, sizeof(double)),
                             .dydt = array_new(model->state_size, sizeof(double))};
    work.room = stress != NULL && work.y != NULL && work.dydt != NULL;
    if (!updated_all_have(updated, work.room)) work.room = false;
    for (size_t i = 0; work.room && i < updated->held; i++)
        for (size_t a = 0; a < dimension; a++)
            stress[stresses * i + (size_t)updated_component[dimension][a][a]] = 1;
    updated->repulsive = false;
    if (work.room) evaluate(updated, &work, NULL, stress);
    updated->repulsive = repulsive;
    model->evaluations = evaluations;
    for (int r = 0; work.room && r < ranks_count(updated->part.ranks); r++) {
        for (size_t k = r == ranks_me(updated->part.ranks) ? 0 : updated->own; k < updated->own; k++)
            add_disorder(updated, work.dydt + model->unknowns + dimension * (updated->lead + k), k, sums);
        ranks_spread(updated->part.ranks, r, sums, sizeof sums);
    }
    *disorder = disorder_mean(sums, updated->dimension);
    array_free(stress);
    array_free(work.y);
    array_free(work.dydt);
    return work.room ? SELAS_OK : fail(messages, SELAS_NO_MEMORY, "no memory to measure the particles");
}
