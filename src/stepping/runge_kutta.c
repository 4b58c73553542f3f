/* What the Runge-Kutta schemes share (see the header): one way to evaluate y' = F(t, y), one end of a step.
 */
#include "stepping/runge_kutta.h"

#include <string.h>

void runge_kutta_rate(struct stepper *stepper, double time, const double *y, double *dydt)
{
    struct model *model = stepper->model;
    const struct drive drive = driver_at(&stepper->driver, time);
    if (model->spatial->rate != NULL) {
        model->spatial->rate(model, &drive, y, dydt);
        return;
    }
    const size_t n = model->unknowns;
    memcpy(dydt, y + n, n * sizeof *y);
    model->spatial->accelerate(model, &drive, 0, y, y + n, dydt + n);
}

void runge_kutta_start(struct stepper *stepper, struct state *state)
{
    const size_t n = stepper->model->unknowns;
    runge_kutta_rate(stepper, state->time, state->y, stepper->work[0]);
    memcpy(state->a, stepper->work[0] + n, n * sizeof *state->a);
}

void runge_kutta_finish(struct stepper *stepper, struct state *state)
{
    state->step++;
    state->time = (double)state->step * stepper->dt;
    runge_kutta_start(stepper, state);
}

void runge_kutta_add(size_t n, double *out, const double *x, double factor, const double *f)
{
#pragma omp parallel for simd schedule(static) if (n > 20000)
    for (size_t i = 0; i < n; i++)
        out[i] = x[i] + factor * f[i];
}
