/* What the tests of the consistent method share: a model of a plain scene, its operators, leapfrog. */
#ifndef CONSISTENT_RUN_H
#define CONSISTENT_RUN_H

#include "near.h"

#include "method/consistent.h"
#include "plain_scene.h"

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
    uint64_t seed = 7;
    for (size_t i = 0; i < n; i++) {
        seed = seed * 6364136223846793005u + 1442695040888963407u;
        x[i] = (double)(seed >> 11) * 0x1p-52 - 1;
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

/* v holds v(n-1/2) on entry and v(n+1/2) at the end. */
static inline void leap(struct run *run, const struct drive *drive, double dt)
{
    double *v = run->y + run->n;
    run->model->class->accelerate(run->model, drive, dt / 2, run->y, v, run->a);
    for (size_t i = 0; i < run->n; i++) {
        v[i] += dt * run->a[i];
        run->y[i] += dt * v[i];
    }
}

#endif
