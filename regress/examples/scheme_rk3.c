/* Example of a time scheme: Kutta's of order 3, k1 = F(t, y), k2 = F(t + dt/2, y + dt/2 k1),
 * k3 = F(t + dt, y - dt k1 + 2 dt k2), y += dt/6 (k1 + 4 k2 + k3); imaginary limit sqrt(3). */
#include "stepping/runge_kutta.h"
#include "stepping/schemes.h"

static double complex polynomial(double complex z, long stages)
{
    (void)stages;
    return 1 + z * (1 + z / 2 * (1 + z / 3));
}

static void step(struct stepper *stepper, struct state *state)
{
    const size_t n = stepper->model->state_size;
    const double dt = stepper->dt;
    double *rate = stepper->work[0], *middle = stepper->work[1], *end = stepper->work[2];
    runge_kutta_add(n, middle, state->y, dt / 2, rate);
    runge_kutta_add(n, end, state->y, -dt, rate);
    runge_kutta_add(n, state->y, state->y, dt / 6, rate);
    runge_kutta_rate(stepper, state->time + dt / 2, middle, rate);
    runge_kutta_add(n, end, end, 2 * dt, rate);
    runge_kutta_add(n, state->y, state->y, 2 * dt / 3, rate);
    runge_kutta_rate(stepper, state->time + dt, end, rate);
    runge_kutta_add(n, state->y, state->y, dt / 6, rate);
    runge_kutta_finish(stepper, state);
}

const struct scheme_class scheme_rk3 = {
    .name = "rk3",
    .order = 3,
    .can = SCHEME_WAVES | SCHEME_MOVING_LOADS,
    .evaluations = 3,
    .polynomial = polynomial,
    .vectors = 3,
    RUNGE_KUTTA_STARTS,
    .step = step,
};
