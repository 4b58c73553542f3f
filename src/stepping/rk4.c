/* The classical Runge-Kutta scheme of order 4: four calls a step, R = 1 + z + z^2/2 + z^3/6 + z^4/24,
 * imaginary limit 2 sqrt(2) = 2.83, real limit 2.79. */
#include "stepping/runge_kutta.h"
#include "stepping/schemes.h"

#include <string.h>

static double complex polynomial(double complex z, long stages)
{
    (void)stages;
    return 1 + z * (1 + z / 2 * (1 + z / 3 * (1 + z / 4)));
}

static void step(struct stepper *stepper, struct state *state)
{
    const size_t n = stepper->model->state_size;
    const double dt = stepper->dt;
    double *rate = stepper->work[0], *before = stepper->work[1], *stage = stepper->work[2];
    memcpy(before, state->y, n * sizeof *before);
    runge_kutta_add(n, state->y, state->y, dt / 6, rate);
    runge_kutta_add(n, stage, before, dt / 2, rate);
    runge_kutta_rate(stepper, state->time + dt / 2, stage, rate);
    runge_kutta_add(n, state->y, state->y, dt / 3, rate);
    runge_kutta_add(n, stage, before, dt / 2, rate);
    runge_kutta_rate(stepper, state->time + dt / 2, stage, rate);
    runge_kutta_add(n, state->y, state->y, dt / 3, rate);
    runge_kutta_add(n, stage, before, dt, rate);
    runge_kutta_rate(stepper, state->time + dt, stage, rate);
    runge_kutta_add(n, state->y, state->y, dt / 6, rate);
    runge_kutta_finish(stepper, state);
}

const struct scheme_class scheme_rk4 = {
    .name = "rk4",
    .order = 4,
    .can = SCHEME_WAVES | SCHEME_MOVING_LOADS,
    .default_for = DEFAULT_FOR_UNDAMPED,
    .evaluations = 4,
    .polynomial = polynomial,
    .vectors = 3,
    RUNGE_KUTTA_STARTS,
    .step = step,
};
