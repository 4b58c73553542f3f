/* The modified equation of order 4 (Dablain 1986; Cohen 2002, section 6): leapfrog with its leading time
 * error removed,
 *
 *   M D2 u + C D0 u + K (u + dt^2/12 a0) = F + dt^2/12 F'',   a0 = Q (F - K u),
 *
 * D2, D0 the central differences. F'' is the second difference of F. Two operator calls a step. Without
 * dampers Q = M^-1. With dampers Q is the inverse mass with the damped components held: K - dt^2/12 K Q K
 * stays symmetric and positive, so dampers only take energy, and a0 is right to second order in dt next to
 * them. (M^-1 there would be the acceleration of faces without dampers, by far too large: 13 % of a wave came
 * back near the limit. C in a0 makes it unsymmetric, and it grows.) Memory of absorbing layers is the same in both
 * calls. Stable for omega dt <= sqrt(12), with dampers for omega dt <= 2, as K - dt^2/12 K Q K <= K, with layers
 * for omega dt <= sqrt(6) (doc/theory/stepping.md, T6b). The velocity (u(n+1) - u(n-1)) / (2 dt) has the error
 * dt^2/6 u''', which finish() takes out of the histories and show() out of what is looked at on the way.
 *
 * Damped materials answer to dt^2/12 a0 unrelaxed (doc/theory/damping.md, Eq 15a), so the second call is one on it
 * alone, and what the first one gave is added. */
#include "stepping/schemes.h"

#include <math.h>
#include <string.h>

/* Vectors of unknowns, two to a work vector. */
static double *lifted_of(const struct stepper *stepper)
{
    return stepper->work[0];
}

/* The velocities while others are shown. */
static double *own_of(const struct stepper *stepper)
{
    return stepper->work[0] + stepper->model->unknowns;
}

/* The acceleration of a step is kept over the next two. */
static double *kept_of(const struct stepper *stepper, unsigned long step)
{
    return stepper->work[1] + step % 2 * stepper->model->unknowns;
}

static double limit(const struct spectrum *spectrum, long stages)
{
    (void)stages;
    /* a viscous force taken at the half step needs x + 2 viscous dt <= 4, and x = (omega dt)^2 (1 - (omega
     * dt)^2 / 12) is 3 at most */
    const double viscous = spectrum->viscous > 0.0 ? 0.5 / spectrum->viscous : INFINITY;
    const double most = spectrum->dampers ? 2.0 : spectrum->layers ? sqrt(6.0) : sqrt(12.0);
    const double waves = spectrum->omega > 0.0 ? most / spectrum->omega : INFINITY;
    return fmin(waves, viscous);
}

/* The drive of a step; after the first without loads that are held. */
static struct drive drive_of(struct stepper *stepper, unsigned long step, enum driver_terms terms)
{
    const struct drive drive = driver_at_step(&stepper->driver, step, terms);
    return step > 0 ? held_left_out(&stepper->held, stepper->model->scene, &drive) : drive;
}

/* Damped materials: the second call is one on dt^2/12 a alone, lifted, to which a itself is added. */
static void add_unrelaxed(struct model *model, const struct drive *drive, double half_step, double twelfth,
                          double *restrict lifted, double *restrict a)
{
    const size_t n = model->unknowns;
#pragma omp parallel for simd schedule(static)
    for (size_t i = 0; i < n; i++)
        lifted[i] = twelfth * a[i];
    model->spatial->accelerate(model, drive, half_step, lifted, NULL, a);
#pragma omp parallel for simd schedule(static)
    for (size_t i = 0; i < n; i++)
        a[i] += lifted[i] / twelfth;
}

/* With the drive given, or (NULL) that of the step. */
static void accelerate_by(struct stepper *stepper, const struct drive *given, unsigned long step,
                          const double *extra, const double *restrict u, const double *v, double *restrict a)
{
    struct model *model = stepper->model;
    const size_t n = model->unknowns;
    const double twelfth = stepper->dt * stepper->dt / 12.0, half_step = step > 0 ? 0.5 * stepper->dt : 0.0;
    double *restrict lifted = lifted_of(stepper);
    struct drive drive = given != NULL ? *given : drive_of(stepper, step, DRIVER_PLAIN);
    drive.extra = extra;
    model->spatial->accelerate(model, &drive, model->damped ? DAMPERS_HOLD : 0.0, u, NULL, a);
    if (model->core->loss != NULL) {
        const struct drive none = {.time = drive.time};
        drive = given != NULL ? none : drive_of(stepper, step, DRIVER_CORRECTION);
        add_unrelaxed(model, &drive, half_step, twelfth, lifted, a);
        if (given == NULL) drive_of(stepper, step, DRIVER_CORRECTED); /* for driver_last */
        return;
    }
#pragma omp parallel for simd schedule(static)
    for (size_t i = 0; i < n; i++)
        lifted[i] = u[i] + twelfth * a[i];
    if (given == NULL) drive = drive_of(stepper, step, DRIVER_CORRECTED);
    drive.extra = extra;
    model->spatial->accelerate(model, &drive, half_step, lifted, v, a);
}

static void accelerate(void *scheme, const struct drive *drive, const double *u, const double *v, double *a)
{
    accelerate_by(scheme, drive, 1, NULL, u, v, a);
}

static void accelerate_now(struct stepper *stepper, struct state *state)
{
    accelerate_by(stepper, NULL, state->step, leapfrog_memory(stepper, state), state->y,
                  state->y + stepper->model->unknowns, state->a);
    if (state->step == 0) return;
    const struct drive drive = driver_last(&stepper->driver, state->time);
    held_add(&stepper->held, &drive, state->a);
}

/* The scheme's v is (u(1) - u(-1)) / (2 dt) = u' + dt^2/6 u''', so a body that moves at t = 0 starts with
 * that; u''' = -M^-1 K v, K about the body at rest (velocities are no displacements to a nonlinear law):
 * loads and dampers begin at t = 0 and leave no trace before it. */
static void start(struct stepper *stepper, struct state *state)
{
    struct model *model = stepper->model;
    const size_t n = model->unknowns;
    const double sixth = stepper->dt * stepper->dt / 6.0;
    const struct drive none = {.time = 0.0};
    double *v = state->y + n, *third = own_of(stepper);
    leapfrog_begin(stepper, state);
    if (model->spatial->linearise != NULL) model->spatial->linearise(model, true);
    model->spatial->accelerate(model, &none, 0.0, v, NULL, third);
    if (model->spatial->linearise != NULL) model->spatial->linearise(model, false);
    for (size_t i = 0; i < n; i++)
        v[i] += sixth * third[i];
    accelerate_now(stepper, state);
    for (size_t i = 0; i < n; i++) { /* as if u''' had been the same before */
        kept_of(stepper, 1)[i] = state->a[i] - stepper->dt * third[i];
        kept_of(stepper, 0)[i] = state->a[i] - 2.0 * stepper->dt * third[i];
    }
}

static void step(struct stepper *stepper, struct state *state)
{
    memcpy(kept_of(stepper, state->step), state->a, stepper->model->unknowns * sizeof *state->a);
    leapfrog_drift(stepper, state);
    accelerate_now(stepper, state);
    leapfrog_kick(stepper, state);
}

static void again(struct stepper *stepper, struct state *state)
{
    if (state->step == 0) { /* the start has no half kick */
        accelerate_now(stepper, state);
        return;
    }
    if (leapfrog_hold(stepper, state)) return;
    leapfrog_unkick(stepper, state);
    accelerate_now(stepper, state);
    leapfrog_kick(stepper, state);
}

/* v - dt^2/6 da/dt, with da/dt of second order from this and the last two steps. */
static void shown(const struct stepper *stepper, const struct state *state, const double *of[3],
                  double part[3])
{
    const double factor = stepper->dt / 12.0;
    of[0] = state->a;
    of[1] = kept_of(stepper, state->step + 1);
    of[2] = kept_of(stepper, state->step);
    part[0] = -3 * factor;
    part[1] = 4 * factor;
    part[2] = -factor;
}

static void show(const struct stepper *stepper, const struct state *state, bool others)
{
    const size_t n = stepper->model->unknowns;
    const double factor = stepper->dt / 12.0;
    const double *restrict a = state->a, *restrict before = kept_of(stepper, state->step + 1);
    const double *restrict earlier = kept_of(stepper, state->step);
    double *restrict v = state->y + n;
    memcpy(others ? own_of(stepper) : v, others ? v : own_of(stepper), n * sizeof *v);
    if (!others) return;
#pragma omp parallel for simd schedule(static)
    for (size_t i = 0; i < n; i++)
        v[i] -= factor * (4.0 * (a[i] - before[i]) - (a[i] - earlier[i])); /* 0 of what rests */
}

/* v := v - dt^2/6 da/dt, with da/dt by central differences inside and one-sided ones of second order at the
 * ends. */
static selas_status finish(const struct stepper *stepper, size_t n, double *u, double *v, double *a,
                           struct messages *messages)
{
    (void)u;
    (void)messages;
    if (n < 3) return SELAS_OK;
    const double factor = stepper->dt / 12.0;
    for (size_t c = 0; c < 3; c++) {
        for (size_t i = 1; i + 1 < n; i++)
            v[3 * i + c] -= factor * (a[3 * (i + 1) + c] - a[3 * (i - 1) + c]);
        v[c] -= factor * (-3.0 * a[c] + 4.0 * a[3 + c] - a[6 + c]);
        v[3 * (n - 1) + c] -=
            factor * (3.0 * a[3 * (n - 1) + c] - 4.0 * a[3 * (n - 2) + c] + a[3 * (n - 3) + c]);
    }
    return SELAS_OK;
}

const struct scheme_class scheme_modified_equation = {
    .name = "modified-equation",
    .order = 4,
    .can = SCHEME_WAVES | SCHEME_FILTERS | SCHEME_LAYERS |
           SCHEME_DAMPED, /* knows how loads vary in time, not how they move */
    .needs_acceleration = true,
    .evaluations = 2.0,
    .accelerate = accelerate,
    .limit = limit,
    .vectors = 2,
    .keeps = true,
    .start = start,
    .step = step,
    .again = again,
    .show = show,
    .shown = shown,
    .finish = finish,
};
