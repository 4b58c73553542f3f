/* The two halves of a step that the leapfrog family shares. */
#include "stepping/schemes.h"

#include <string.h>

/* Below this a parallel region costs more than it saves. */
enum { SERIAL = 20000 };

void leapfrog_drift(struct stepper *stepper, struct state *state)
{
    struct model *model = stepper->model;
    const size_t n = model->unknowns;
    const double dt = stepper->dt;
    double *restrict u = state->y;
    double *restrict v = state->y + n;
    const double *restrict a = state->a;
    const bool filters = model->spatial->after_step != NULL;
    if (filters) memcpy(stepper->work[0], u, n * sizeof *u);
    if (model->memory != NULL) {
        leapfrog_kick(stepper, state);
        model->memory->drag(model, dt, v);
    }
    const double kick = model->memory != NULL ? 0 : 0.5 * dt;
#pragma omp parallel for simd schedule(static) if (n > SERIAL)
    for (size_t i = 0; i < n; i++) {
        v[i] += kick * a[i];
        u[i] += dt * v[i];
    }
    if (filters) model->spatial->after_step(model, dt, stepper->work[0], u, v);
    if (model->memory != NULL) model->memory->remember(model, dt, u, v, v + n);
    state->step++;
    state->time = (double)state->step * dt;
}

static void add_acceleration(const struct stepper *stepper, struct state *state, double half)
{
    const size_t n = stepper->model->unknowns;
    double *restrict v = state->y + n;
    const double *restrict a = state->a;
#pragma omp parallel for simd schedule(static) if (n > SERIAL)
    for (size_t i = 0; i < n; i++)
        v[i] += half * a[i];
}

void leapfrog_kick(struct stepper *stepper, struct state *state)
{
    add_acceleration(stepper, state, 0.5 * stepper->dt);
}

void leapfrog_unkick(struct stepper *stepper, struct state *state)
{
    add_acceleration(stepper, state, -0.5 * stepper->dt);
}

void leapfrog_begin(struct stepper *stepper, struct state *state)
{
    struct model *model = stepper->model;
    if (model->memory != NULL) model->memory->start(model, state->y, state->y + 2 * model->unknowns);
}

const double *leapfrog_memory(const struct stepper *stepper, const struct state *state)
{
    return stepper->model->memory != NULL ? state->y + 2 * stepper->model->unknowns : NULL;
}

bool leapfrog_hold(struct stepper *stepper, struct state *state)
{
    if (stepper->held.loads == 0) return false;
    const struct drive drive = driver_at_step(&stepper->driver, state->step, DRIVER_PLAIN);
    held_change(&stepper->held, &drive, 0.5 * stepper->dt, state->y + stepper->model->unknowns, state->a);
    return true;
}
