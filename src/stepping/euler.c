/* Forward Euler, y_(n+1) = y_n + dt F(t_n, y_n): first order, one call a step. He & Seaid (2016) compare with
 * it in Table 1. Its imaginary limit is 0, its real limit 2: only viscosity makes it bounded. */
#include "stepping/runge_kutta.h"
#include "stepping/schemes.h"

static double complex polynomial(double complex z, long stages)
{
    (void)stages;
    return 1 + z;
}

static void step(struct stepper *stepper, struct state *state)
{
    const size_t n = stepper->model->state_size;
    runge_kutta_add(n, state->y, state->y, stepper->dt, stepper->work[0]);
    runge_kutta_finish(stepper, state);
}

const struct scheme_class scheme_euler = {
    .name = "euler",
    .order = 1,
    .can = SCHEME_MOVING_LOADS,
    .evaluations = 1,
    .polynomial = polynomial,
    .vectors = 1,
    RUNGE_KUTTA_STARTS,
    .step = step,
};
