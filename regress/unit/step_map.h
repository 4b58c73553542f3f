/* One step of leapfrog or the modified equation, memory variables and all, as a linear map of the state: for tests of
 * its eigenvalues. */
#ifndef STEP_MAP_H
#define STEP_MAP_H

#include "near.h"

#include "model/model.h"

#include <gsl/gsl_complex_math.h>
#include <gsl/gsl_eigen.h>
#include <stdlib.h>
#include <string.h>

/* u, v and memory by an acceleration. */
static inline void map_go_on(struct model *model, double dt, double *y, const double *a)
{
    const size_t n = model->unknowns;
    for (size_t i = 0; i < n; i++)
        y[n + i] += dt * a[i];
    model->memory->drag(model, dt, y + n);
    for (size_t i = 0; i < n; i++)
        y[i] += dt * y[n + i];
    model->memory->remember(model, dt, y, y + n, y + 2 * n);
}

/* v is that of the half step before on entry and at the end. */
static inline void map_step(struct model *model, double dt, double *y, double *a)
{
    const size_t n = model->unknowns;
    const struct drive drive = {.extra = y + 2 * n};
    model->spatial->accelerate(model, &drive, dt / 2, y, y + n, a);
    map_go_on(model, dt, y, a);
}

/* The same by the modified equation; damped materials do not relax by what it adds. */
static inline void map_corrected_step(struct model *model, double dt, double *y, double *a)
{
    const size_t n = model->unknowns;
    const bool relaxes = model->core->loss != NULL;
    const struct drive drive = {.extra = y + 2 * n}, unrelaxed = {.time = 0};
    double *lifted = malloc(2 * n * sizeof *lifted), *first = lifted + n;
    model->spatial->accelerate(model, &drive, 0, y, NULL, first);
    for (size_t i = 0; i < n; i++)
        lifted[i] = (relaxes ? 0 : y[i]) + dt * dt / 12 * first[i];
    model->spatial->accelerate(model, relaxes ? &unrelaxed : &drive, dt / 2, lifted, relaxes ? NULL : y + n,
                               a);
    for (size_t i = 0; i < n && relaxes; i++)
        a[i] += first[i];
    free(lifted);
    map_go_on(model, dt, y, a);
}

typedef void map_of_step(struct model *model, double dt, double *y, double *a);

/* Largest modulus among the eigenvalues of a map on what is not held (NULL: nothing is), *count of them. */
static inline double map_largest_of(map_of_step *step, struct model *model, double dt,
                                    bool (*held)(struct model *model, size_t i), size_t *count)
{
    const size_t size = model->state_size;
    double *y = calloc(size, sizeof *y), *a = calloc(model->unknowns, sizeof *a), largest = 0;
    size_t *place = calloc(size, sizeof *place), free_ones = 0;
    for (size_t i = 0; i < size; i++)
        if (held == NULL || !held(model, i)) place[free_ones++] = i;
    gsl_matrix *map = gsl_matrix_calloc(free_ones, free_ones);
    gsl_vector_complex *value = gsl_vector_complex_alloc(free_ones);
    gsl_eigen_nonsymm_workspace *work = gsl_eigen_nonsymm_alloc(free_ones);
    for (size_t j = 0; j < free_ones; j++) {
        memset(y, 0, size * sizeof *y);
        y[place[j]] = 1;
        step(model, dt, y, a);
        for (size_t i = 0; i < free_ones; i++)
            gsl_matrix_set(map, i, j, y[place[i]]);
    }
    gsl_eigen_nonsymm_params(0, 1, work); /* balanced: u, v and the memory have different units */
    assert_int_equal(gsl_eigen_nonsymm(map, value, work), 0);
    *count = free_ones;
    for (size_t i = 0; i < free_ones; i++)
        largest = fmax(largest, gsl_complex_abs(gsl_vector_complex_get(value, i)));
    gsl_eigen_nonsymm_free(work);
    gsl_vector_complex_free(value);
    gsl_matrix_free(map);
    free(place);
    free(y);
    free(a);
    return largest;
}

static inline double map_largest(struct model *model, double dt, bool (*held)(struct model *model, size_t i),
                                 size_t *count)
{
    return map_largest_of(map_step, model, dt, held, count);
}

/* Growth a step of the velocities of noise (uniform motion does not count), over the last two thirds of 300 steps. */
static inline double map_growth(map_of_step *step, struct model *model, double dt)
{
    enum { THIRD = 100 };
    const size_t size = model->state_size;
    double *y = calloc(size, sizeof *y), *a = calloc(model->unknowns, sizeof *a), norm[4];
    for (size_t i = 0; i < size; i++)
        y[i] = sin(1 + 12.9898 * (double)i);
    for (int third = 0; third < 4; third++) {
        norm[third] = 0;
        for (size_t i = model->unknowns; i < 2 * model->unknowns; i++)
            norm[third] = hypot(norm[third], y[i]);
        for (int i = 0; third < 3 && i < THIRD; i++)
            step(model, dt, y, a);
    }
    free(y);
    free(a);
    return pow(norm[3] / norm[1], .5 / THIRD);
}

#endif
