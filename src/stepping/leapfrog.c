/* Leapfrog (central differences in time, second order), in velocity-Verlet form:
 *
 *   w(n+1/2) = v(n) + dt/2 a(n),   u(n+1) = u(n) + dt w(n+1/2),
 *   (M + dt/2 C) a(n+1) = F(n+1) - K u(n+1) - C w(n+1/2),   v(n+1) = w(n+1/2) + dt/2 a(n+1),
 *
 * which is M (u(n+1) - 2 u(n) + u(n-1)) / dt^2 + C (u(n+1) - u(n-1)) / (2 dt) + K u(n) = F(n): the dampers
 * are implicit, one operator call a step. Stable for omega dt <= 2. With `unwarp` the only time error, the
 * warp omega = (2/dt) sin(omega' dt/2), is taken out of the histories (stepping/time_dispersion.c). */
#include "stepping/schemes.h"
#include "stepping/time_dispersion.h"

#include <math.h>

static double limit(const struct spectrum *spectrum, long stages)
{
    const double omega = spectrum->omega, viscous = spectrum->viscous;
    (void)stages;
    /* (v/2 dt) <= sqrt(1 + ...) : central damping at the full step does not lower the limit; a viscous force
     * taken explicitly at the half step does: omega^2 dt^2 + 2 viscous dt <= 4. */
    if (omega <= 0.0) return viscous > 0.0 ? 2.0 / viscous : INFINITY;
    const double ratio = viscous / omega;
    return 2.0 / omega * (sqrt(1.0 + 0.25 * ratio * ratio) - 0.5 * ratio);
}

static void start(struct stepper *stepper, struct state *state)
{
    struct model *model = stepper->model;
    struct drive drive = driver_at_step(&stepper->driver, state->step, DRIVER_PLAIN);
    /* a host may change its loads at the time reached, and then wants that acceleration anew */
    stepper->one_pass = model->one_pass != NULL && !scene_driven(model->scene);
    if (stepper->one_pass) {
        model->one_pass->begin(model, &drive, stepper->dt, state->y, state->a);
        return;
    }
    leapfrog_begin(stepper, state);
    drive.extra = leapfrog_memory(stepper, state);
    model->spatial->accelerate(model, &drive, 0.0, state->y, state->y + model->unknowns, state->a);
}

/* What settles a state. */
static void resume(struct stepper *stepper, struct state *state)
{
    if (stepper->one_pass) driver_at_step(&stepper->driver, state->step, DRIVER_PLAIN);
}

static void accelerate(void *scheme, const struct drive *drive, const double *u, const double *v, double *a)
{
    const struct stepper *stepper = scheme;
    stepper->model->spatial->accelerate(stepper->model, drive, 0.5 * stepper->dt, u, v, a);
}

/* The second half of a step: from w(n+1/2) to v(n+1), memory being at its end. */
static void close_step(struct stepper *stepper, struct state *state)
{
    struct model *model = stepper->model;
    double *u = state->y;
    double *v = state->y + model->unknowns;
    struct drive drive = driver_at_step(&stepper->driver, state->step, DRIVER_PLAIN);
    drive.extra = leapfrog_memory(stepper, state);
    const struct drive rest = held_left_out(&stepper->held, model->scene, &drive);
    accelerate(stepper, &rest, u, v, state->a);
    held_add(&stepper->held, &drive, state->a);
    leapfrog_kick(stepper, state);
}

static void step(struct stepper *stepper, struct state *state)
{
    struct model *model = stepper->model;
    if (!stepper->one_pass) {
        leapfrog_drift(stepper, state);
        close_step(stepper, state);
        return;
    }
    state->step++;
    state->time = (double)state->step * stepper->dt;
    const struct drive drive = driver_at_step(&stepper->driver, state->step, DRIVER_PLAIN);
    model->one_pass->advance(model, &drive, stepper->dt, state->y, state->a);
}

static void again(struct stepper *stepper, struct state *state)
{
    if (state->step == 0) {
        start(stepper, state);
        return;
    }
    if (leapfrog_hold(stepper, state)) return;
    leapfrog_unkick(stepper, state);
    close_step(stepper, state);
}

static selas_status finish(const struct stepper *stepper, size_t n, double *u, double *v, double *a,
                           struct messages *messages)
{
    if (!stepper->unwarp) return SELAS_OK;
    return time_dispersion_unwarp(stepper->dt, n, u, v, a, messages);
}

const struct scheme_class scheme_leapfrog = {
    .name = "leapfrog",
    .order = 2,
    .can = SCHEME_WAVES | SCHEME_MOVING_LOADS | SCHEME_FILTERS | SCHEME_LAYERS | SCHEME_DAMPED |
           SCHEME_DAMPED_FACES | SCHEME_ONE_PASS | SCHEME_UNWARPS,
    .default_for = DEFAULT_FOR_ACCELERATE,
    .needs_acceleration = true,
    .evaluations = 1.0,
    .accelerate = accelerate,
    .limit = limit,
    .start = start,
    .resume = resume,
    .step = step,
    .again = again,
    .finish = finish,
};
