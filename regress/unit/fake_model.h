/* A model whose states are known functions of place and time, for tests of the record: a wave that runs away
 * from the body's low corner,
 *
 *   u_c(x, t) = (c + 1) g(t - s / speed),  g(t) = t^6 exp(-t) for t > 0,  s = |x - corner|
 *
 * It is no solution of anything; it is smooth, at rest for t <= 0, and has exact derivatives. */
#ifndef FAKE_MODEL_H
#define FAKE_MODEL_H

#include "base/memory.h"
#include "record/record.h"

#include <ftw.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

static const double fake_speed = 1.5;
static double fake_gain = 1.0;   /* what the model computes is this times the truth */
static double fake_growth = 0.0; /* ... times exp(growth t): an instability */

static inline double fake_pulse(double t, int derivative)
{
    if (t <= 0.0) return 0.0;
    const double e = exp(-t);
    if (derivative == 0) return pow(t, 6.0) * e;
    if (derivative == 1) return (6.0 * pow(t, 5.0) - pow(t, 6.0)) * e;
    return (30.0 * pow(t, 4.0) - 12.0 * pow(t, 5.0) + pow(t, 6.0)) * e;
}

static inline double fake_truth(const double x[3], int component, double t, int derivative)
{
    const double s = sqrt(x[0] * x[0] + x[1] * x[1] + x[2] * x[2]);
    return (component + 1) * fake_pulse(t - s / fake_speed, derivative);
}

static void fake_state(const struct model *model, struct state *state, double dt, unsigned long step)
{
    state->step = step;
    state->time = (double)step * dt;
    const double gain = fake_gain * exp(fake_growth * state->time);
    for (size_t i = 0; i < model->points; i++)
        for (int c = 0; c < 3; c++) {
            const size_t k = 3 * i + (size_t)c;
            state->y[k] = gain * fake_truth(model->position + 3 * i, c, state->time, 0);
            state->y[model->unknowns + k] = gain * fake_truth(model->position + 3 * i, c, state->time, 1);
            state->a[k] = gain * fake_truth(model->position + 3 * i, c, state->time, 2);
        }
}

static selas_status fake_probe(struct model *model, const double position[3], struct probe *probe,
                               struct messages *messages)
{
    const selas_status status = probe_allocate(probe, 1, messages);
    if (status != SELAS_OK) return status;
    double least = INFINITY;
    for (size_t i = 0; i < model->points; i++) {
        const double *x = model->position + 3 * i;
        const double away = hypot(hypot(x[0] - position[0], x[1] - position[1]), x[2] - position[2]);
        if (away >= least) continue;
        least = away;
        probe->index[0] = i;
    }
    memcpy(probe->position, position, sizeof probe->position);
    probe->weight[0] = 1.0;
    probe->material = &model->scene->material[0];
    return SELAS_OK;
}

static void fake_field(struct model *model, selas_field field, const double *y, const double *a, size_t first,
                       size_t end, double *value)
{
    const size_t components = (size_t)field_components(field);
    for (size_t i = first; i < end; i++)
        for (size_t c = 0; c < components; c++) {
            const double *from = field == SELAS_VELOCITY       ? y + model->unknowns
                                 : field == SELAS_ACCELERATION ? a
                                                               : y;
            value[components * (i - first) + c] = from[3 * i + c % 3];
        }
}

static void fake_energy(struct model *model, const double *y, struct energy *energy)
{
    *energy = (struct energy){0};
    for (size_t i = 0; i < model->unknowns; i++)
        energy->kinetic += 0.5 * y[model->unknowns + i] * y[model->unknowns + i];
}

static const struct method fake_method = {.name = "fake", .variant = "known"};
static const struct model_core fake_core = {.probe = fake_probe, .field = fake_field, .energy = fake_energy};

static const struct model_operator fake_operator = {0};

static const struct scheme_class fake_scheme = {.name = "none", .order = 4, .evaluations = 1.0, .vectors = 1};

static selas_status fake_history(struct exact *exact, const double position[3], size_t n, const double *time,
                                 double *value, struct messages *messages)
{
    (void)exact;
    (void)messages;
    for (size_t i = 0; i < n; i++)
        for (int c = 0; c < 3; c++) {
            value[6 * i + (size_t)c] = fake_truth(position, c, time[i], 0);
            value[6 * i + 3 + (size_t)c] = fake_truth(position, c, time[i], 1);
        }
    return SELAS_OK;
}

static const struct exact_class fake_exact_class = {.kind = "fake", .history = fake_history};

struct fake {
    struct scene scene;
    struct material material;
    struct receiver receiver[4];
    struct profile profile;
    struct snapshot snapshot[2];
    struct load load;
    struct model model;
    struct stepper stepper;
    struct state state;
    struct exact exact;
    double *position;
    char folder[64];
};

/* A lattice of n[0] x n[1] x n[2] points, `spacing` apart, from the origin on; dt; end_time. */
static void fake_build(struct fake *fake, int dimension, const size_t n[3], double spacing, double dt,
                       double end_time)
{
    memset(fake, 0, sizeof *fake);
    snprintf(fake->folder, sizeof fake->folder, "/tmp/selas-record-XXXXXX");
    if (mkdtemp(fake->folder) == NULL) abort();
    const size_t points = n[0] * n[1] * n[2];
    fake->position = array_new(3 * points, sizeof(double));
    for (size_t i = 0; i < points; i++) {
        fake->position[3 * i] = spacing * (double)(i % n[0]);
        fake->position[3 * i + 1] = spacing * (double)(i / n[0] % n[1]);
        fake->position[3 * i + 2] = spacing * (double)(i / n[0] / n[1]);
    }
    fake->material = (struct material){.name = "rock",
                                       .density = 1.0,
                                       .lambda = 1.0,
                                       .mu = 1.0,
                                       .young = 2.5,
                                       .poisson = 0.25,
                                       .plane_lambda = 1.0,
                                       .p_speed = 1.7320508,
                                       .s_speed = 1.0};
    struct scene *scene = &fake->scene;
    snprintf(scene->title, sizeof scene->title, "A wave & its <record>");
    scene->dimension = dimension;
    scene->end_time = end_time;
    scene->materials = 1;
    scene->material = &fake->material;
    scene->receiver = fake->receiver;
    scene->profile = &fake->profile;
    scene->snapshot = fake->snapshot;
    scene->load = &fake->load;
    scene->body.spacing = spacing;
    scene->output.directory = fake->folder;
    fake->model = (struct model){.method = &fake_method,
                                 .core = &fake_core,
                                 .spatial = &fake_operator,
                                 .scene = scene,
                                 .points = points,
                                 .position = fake->position,
                                 .grid = {n[0], n[1], n[2]},
                                 .unknowns = 3 * points,
                                 .state_size = 6 * points,
                                 .component_stride = 1,
                                 .point_stride = 3,
                                 .self_adjoint = true};
    fake->stepper = (struct stepper){.scheme = &fake_scheme,
                                     .model = &fake->model,
                                     .dt = dt,
                                     .steps = (unsigned long)ceil(end_time / dt - 1e-9),
                                     .extra = 1};
    if (driver_create(&fake->stepper.driver, scene, dt, &(struct messages){0}) != SELAS_OK) abort();
    snprintf(fake->stepper.dt_reason, sizeof fake->stepper.dt_reason, "given");
    fake->state.y = array_new(6 * points, sizeof(double));
    fake->state.a = array_new(3 * points, sizeof(double));
    fake->exact = (struct exact){.class = &fake_exact_class, .scene = scene};
}

/* Shows the recorder every state; stops where it fails. */
static selas_status fake_run(struct fake *fake, struct recorder *recorder, struct messages *messages)
{
    selas_status status = SELAS_OK;
    for (unsigned long step = 0; step <= fake->stepper.steps + fake->stepper.extra && status == SELAS_OK;
         step++) {
        fake_state(&fake->model, &fake->state, fake->stepper.dt, step);
        status = recorder_observe(recorder, &fake->state, messages);
    }
    return status;
}

static int fake_remove(const char *path, const struct stat *about, int kind, struct FTW *where)
{
    (void)about;
    (void)kind;
    (void)where;
    return remove(path);
}

static void fake_clear(struct fake *fake)
{
    nftw(fake->folder, fake_remove, 8, FTW_DEPTH | FTW_PHYS);
    array_free(fake->position);
    driver_free(&fake->stepper.driver);
    array_free(fake->state.y);
    array_free(fake->state.a);
}

#endif
