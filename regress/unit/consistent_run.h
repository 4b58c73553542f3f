/* What the tests of the consistent method share: a model of a plain scene, its operators, leapfrog. */
#ifndef CONSISTENT_RUN_H
#define CONSISTENT_RUN_H

#include "near.h"

#include "method/consistent/consistent.h"
#include "plain_scene.h"

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_sort_vector.h>
#include <stdlib.h>

static inline struct consistent_options plain_options(int degree, bool mapped)
{
    return (struct consistent_options){.degree = degree, .mapped = mapped};
}

static inline struct model *make(const struct plain_scene *plain, struct consistent_options options)
{
    struct messages messages = {0};
    struct model *model = NULL;
    if (consistent_create_with(&plain->scene, &options, &model, &messages) != SELAS_OK)
        print_error("%s", messages.text);
    assert_non_null(model);
    return model;
}

static inline void noise(size_t n, double *x)
{
    uint64_t bits = 7;
    for (size_t i = 0; i < n; i++) {
        bits = bits * 6364136223846793005u + 1442695040888963407u;
        x[i] = (double)(bits >> 11) * 0x1p-52 - 1;
    }
}

/* Whole field out = plan u. */
static inline void apply(struct consistent *c, const struct tensor_plan *plan, const double *u, double *out)
{
    memset(out, 0, c->model.unknowns * sizeof *out);
    for (size_t k = 0; k < c->n[DEPTH]; k++) {
        double *plane[3];
        for (int i = 0; i < c->dimension; i++)
            plane[i] = out + (size_t)i * c->volume + k * c->plane;
        tensor_plane(plan, 0, k, 1, u, plane);
    }
}

static inline double dot(size_t n, const double *a, const double *b)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

/* Phase speed of interior plane waves from the operators' own symbols: eigenvalues of the 3 x 3 matrix K^(k)
 * over M^(k); worst relative error of P and S along x, and also (3 directions) along both diagonals. */
static inline double worst_dispersion(struct model *model, int directions_used, double points, double spacing)
{
    static const double directions[3][3] = {
        {1, 0, 0}, {M_SQRT1_2, M_SQRT1_2, 0}, {.57735027, .57735027, .57735027}};
    struct consistent *c = consistent_of(model);
    const struct material *m = &model->scene->material[0];
    const size_t n = model->unknowns,
                 middle = c->n[0] / 2 + c->n[0] * (c->n[1] / 2) + c->plane * (c->n[2] / 2);
    double *u = calloc(n, sizeof *u), *out = calloc(n, sizeof *out), worst = 0;
    gsl_matrix *symbol = gsl_matrix_alloc(3, 3);
    gsl_vector *values = gsl_vector_alloc(3);
    gsl_eigen_symm_workspace *work = gsl_eigen_symm_alloc(3);
    const double wavenumber = 2 * M_PI / (points * spacing);
    for (int d = 0; d < directions_used; d++) {
        double mass = 0;
        for (int from = 0; from < 3; from++) {
            memset(u, 0, n * sizeof *u);
            for (size_t p = 0; p < c->volume; p++) {
                const double i = (double)(p % c->n[0]) - (double)(c->n[0] / 2);
                const double j = (double)(p / c->n[0] % c->n[1]) - (double)(c->n[1] / 2);
                const double k = (double)(p / c->plane) - (double)(c->n[2] / 2);
                u[(size_t)from * c->volume + p] =
                    cos(wavenumber * spacing *
                        (i * directions[d][0] + j * directions[d][1] + k * directions[d][2]));
            }
            if (c->hform != NULL) { /* the symbol is real and even: cosines suffice */
                apply(c, c->hform->acceleration, u, out);
                for (size_t i = 0; i < n; i++)
                    out[i] = -out[i];
            } else
                apply(c, c->stiffness, u, out);
            for (size_t to = 0; to < 3; to++)
                gsl_matrix_set(symbol, to, (size_t)from, out[to * c->volume + middle]);
            if (c->hform == NULL) apply(c, c->mass, u, out);
            mass = c->hform != NULL ? 1 : out[(size_t)from * c->volume + middle];
        }
        gsl_matrix_scale(symbol, 1 / mass);
        gsl_eigen_symm(symbol, values, work);
        gsl_sort_vector(values);
        for (size_t i = 0; i < 3; i++) {
            const double speed = i < 2 ? m->s_speed : m->p_speed;
            worst = fmax(worst, fabs(sqrt(gsl_vector_get(values, i)) / (wavenumber * speed) - 1));
        }
    }
    gsl_matrix_free(symbol);
    gsl_vector_free(values);
    gsl_eigen_symm_free(work);
    free(u);
    free(out);
    return worst;
}

/* u, v, a of a model and a step of leapfrog. */
struct run {
    struct model *model;
    size_t n;
    double *y, *a;
};

static inline struct run run_new(const struct plain_scene *plain, struct consistent_options options)
{
    struct run run = {.model = make(plain, options)};
    run.n = run.model->unknowns;
    run.y = calloc(2 * run.n, sizeof *run.y);
    run.a = calloc(run.n, sizeof *run.a);
    return run;
}

static inline void run_free(struct run *run)
{
    free(run->y);
    free(run->a);
    model_free(&run->model);
}

/* Velocity at a place. */
static inline void velocity_at(const struct run *run, const double place[3], double value[3])
{
    struct probe probe = {0};
    struct messages messages = {0};
    assert_int_equal(run->model->core->probe(run->model, place, &probe, &messages), SELAS_OK);
    run->model->core->observe(run->model, &probe, SELAS_VELOCITY, run->y, run->a, value);
    probe_free(&probe);
}

/* v holds v(n-1/2) on entry and v(n+1/2) at the end. */
static inline void leap(struct run *run, const struct drive *drive, double dt)
{
    double *v = run->y + run->n;
    run->model->spatial->accelerate(run->model, drive, dt / 2, run->y, v, run->a);
    for (size_t i = 0; i < run->n; i++)
        v[i] += dt * run->a[i];
    if (drive->extra != NULL) run->model->memory->drag(run->model, dt, v);
    for (size_t i = 0; i < run->n; i++)
        run->y[i] += dt * v[i];
    if (drive->extra != NULL) run->model->memory->remember(run->model, dt, run->y, v, v + run->n);
}

/* Steps without loads, with memory where the model has some. */
static inline void march(struct run *run, double dt, int steps)
{
    const struct drive drive = {.extra = run->model->memory != NULL ? run->y + 2 * run->n : NULL};
    for (int step = 0; step < steps; step++)
        leap(run, &drive, dt);
}

#endif
