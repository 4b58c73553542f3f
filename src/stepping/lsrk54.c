/* LSRK(5,4): the five-stage fourth-order Runge-Kutta scheme in two registers of Carpenter & Kennedy (1994,
 * NASA TM 109112, solution 3):
 *
 *   dy_i = A_i dy_(i-1) + dt F(t + c_i dt, y_(i-1)),
 *   y_i  = y_(i-1) + B_i dy_i.
 *
 * Five calls a step, imaginary limit 3.34, real limit 4.65. */
#include "stepping/runge_kutta.h"
#include "stepping/schemes.h"

#include <string.h>

enum { STAGES = 5 };

static const double A[STAGES] = {0, -567301805773.0 / 1357537059087.0, -2404267990393.0 / 2016746695238.0,
                                 -3550918686646.0 / 2091501179385.0, -1275806237668.0 / 842570457699.0};
static const double B[STAGES] = {1432997174477.0 / 9575080441755.0, 5161836677717.0 / 13612068292357.0,
                                 1720146321549.0 / 2090206949498.0, 3134564353537.0 / 4481467310338.0,
                                 2277821191437.0 / 14882151754819.0};
static const double C[STAGES] = {0, 1432997174477.0 / 9575080441755.0, 2526269341429.0 / 6820363962896.0,
                                 2006345519317.0 / 3224310063776.0, 2802321613138.0 / 2924317926251.0};

/* The scheme itself applied to y' = z y, dt = 1. */
static double complex polynomial(double complex z, long stages)
{
    (void)stages;
    double complex y = 1, dy = 0;
    for (int i = 0; i < STAGES; i++) {
        dy = A[i] * dy + z * y;
        y += B[i] * dy;
    }
    return y;
}

static void step(struct stepper *stepper, struct state *state)
{
    const size_t n = stepper->model->state_size;
    const double dt = stepper->dt;
    double *rate = stepper->work[0], *change = stepper->work[1], *y = state->y;
    for (int i = 0; i < STAGES; i++) {
        if (i > 0) runge_kutta_rate(stepper, state->time + C[i] * dt, y, rate);
        const double a = i > 0 ? A[i] : 0, b = B[i];
        if (i == 0) memset(change, 0, n * sizeof *change); /* what another step left may not be finite */
#pragma omp parallel for simd schedule(static) if (n > 20000)
        for (size_t k = 0; k < n; k++) {
            change[k] = a * change[k] + dt * rate[k];
            y[k] += b * change[k];
        }
    }
    runge_kutta_finish(stepper, state);
}

const struct scheme_class scheme_lsrk54 = {
    .name = "lsrk54",
    .order = 4,
    .can = SCHEME_WAVES | SCHEME_MOVING_LOADS,
    .evaluations = STAGES,
    .polynomial = polynomial,
    .vectors = 2,
    RUNGE_KUTTA_STARTS,
    .step = step,
};
