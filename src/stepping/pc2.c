/* PC2, the predictor-corrector of He & Seaid (2016), Eq 29, which is the explicit midpoint rule:
 *     y* = y_n + dt/2 F(t_n, y_n),   y_(n+1) = y_n + dt F(t_n + dt/2, y*)
 * (Eq 29's third line, 2 y^ - y_n with y^ = y_n + dt/2 F(y*), is the same thing). Second order, two calls a
 * step; R = 1 + z + z^2/2: imaginary limit 0, real limit 2. */
#include "stepping/runge_kutta.h"
#include "stepping/schemes.h"

static double complex polynomial(double complex z, long stages)
{
    (void)stages;
    return 1 + z + z * z / 2;
}

static void step(struct stepper *stepper, struct state *state)
{
    const size_t n = stepper->model->state_size;
    const double dt = stepper->dt;
    double *rate = stepper->work[0], *middle = stepper->work[1];
    runge_kutta_add(n, middle, state->y, dt / 2, rate);
    runge_kutta_rate(stepper, state->time + dt / 2, middle, rate);
    runge_kutta_add(n, state->y, state->y, dt, rate);
    runge_kutta_finish(stepper, state);
}

const struct scheme_class scheme_pc2 = {
    .name = "pc2",
    .order = 2,
    .can = SCHEME_MOVING_LOADS,
    .evaluations = 2,
    .polynomial = polynomial,
    .vectors = 2,
    RUNGE_KUTTA_STARTS,
    .step = step,
};
