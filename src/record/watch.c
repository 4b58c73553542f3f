/* The watch over a run: is the state finite, and has the body more energy than was put into it?
 *
 * What the loads have put in cannot be less than the energy gained: E(t) - E(0) <= work done by the loads.
 * Where the model tells the power of its loads, the work is summed over the steps (trapezoid); elsewhere the
 * energy is held against its largest value while the loads came on. */
#include "record/parts.h"

#include "base/memory.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { EVERY = 50 };
/* Energy of the state at a step may differ from the scheme's own conserved energy near the stability limit
 * (leapfrog: by up to 1 / (1 - (omega dt / 2)^2), 5 at nine tenths of the limit): growth beyond ten times the
 * work is no rounding and no such difference. */
static const double growth_allowed = 10.0;
/* Energy gained without being given, over what was given: a few per cent is usual at 15^3 (doc/results.md).
 */
static const double growth_noted = 0.5;
/* Without work: a free body under a steady push gains energy as t^2, a hundredfold between a tenth of the run
 * and its end. */
static const double growth_unwatched = 1e4;

static bool moved_by_faces(const struct scene *scene)
{
    for (size_t face = 0; face < FACES; face++) {
        const enum boundary_kind kind = scene->boundary[face].kind;
        if (kind == BOUNDARY_VELOCITY || kind == BOUNDARY_DISPLACEMENT) return true;
    }
    return false;
}

void watch_start(struct recorder *recorder)
{
    const struct scene *scene = recorder->scene;
    struct watch *watch = &recorder->watch;
    *watch = (struct watch){0};
    watch->by_work = recorder->model->class->power != NULL && recorder->model->class->energy != NULL &&
                     !moved_by_faces(scene);
    watch->reference_until = 0.1 * scene->end_time;
    for (size_t k = 0; k < scene->loads; k++)
        watch->reference_until = fmax(watch->reference_until, history_end(&scene->load[k].history));
    for (size_t face = 0; face < FACES; face++)
        if (scene->boundary[face].kind == BOUNDARY_VELOCITY ||
            scene->boundary[face].kind == BOUNDARY_DISPLACEMENT)
            watch->reference_until =
                fmax(watch->reference_until, history_end(&scene->boundary[face].history));
}

static void add_work(struct recorder *recorder, const struct state *state)
{
    struct watch *watch = &recorder->watch;
    const struct drive drive = drive_last(recorder->stepper, state->time);
    double load = 0.0, absorbed = 0.0;
    recorder->model->class->power(recorder->model, &drive, state->y, &load, &absorbed);
    if (recorder->started) {
        const double half = 0.5 * (state->time - recorder->last_time);
        watch->work += half * (watch->power + load);
        watch->gross += half * (fmax(watch->power, 0.0) + fmax(load, 0.0));
        watch->absorbed += half * (watch->power_absorbed + absorbed);
    }
    watch->power = load;
    watch->power_absorbed = absorbed;
}

static const char *likely_cause(const struct recorder *recorder)
{
    const struct stepper *stepper = recorder->stepper;
    if (stepper->limit > 0.0 && stepper->dt > 0.999 * stepper->limit)
        return "the time step is beyond the stability limit; leave stepping%time_step and courant out";
    if (stepper->limit <= 0.0) return "the time step was not held against a limit; try a smaller one";
    if (!recorder->model->self_adjoint)
        return "this method's operator is not symmetric and may grow by itself; try a smaller time step, "
               "method%variant = 'consistent', or other options of the method";
    return "an absorbing face or a material near nu = 0.5; try a smaller time step";
}

/* Where the body moves fastest (or is not finite); only called when the run has already failed. */
static selas_status tell_place(const struct recorder *recorder, const struct state *state, const char *what,
                               struct messages *messages)
{
    const struct model *model = recorder->model;
    double *velocity = array_new(3 * model->points, sizeof *velocity);
    if (velocity == NULL || model->class->field == NULL) {
        array_free(velocity);
        return fail(messages, SELAS_UNSTABLE, "the run went unstable at t = %.6g (step %lu): %s; likely: %s",
                    state->time, state->step, what, likely_cause(recorder));
    }
    model->class->field(recorder->model, SELAS_VELOCITY, state->y, state->a, velocity);
    size_t place = 0;
    double fastest = -1.0;
    for (size_t i = 0; i < model->points; i++) {
        const double speed = hypot(hypot(velocity[3 * i], velocity[3 * i + 1]), velocity[3 * i + 2]);
        if (isfinite(speed) && speed <= fastest) continue;
        place = i;
        fastest = speed;
        if (!isfinite(speed)) break;
    }
    array_free(velocity);
    double x[3];
    model_position(model, place, x);
    char where[160];
    snprintf(where, sizeof where, "at (%.6g, %.6g, %.6g)", x[0], x[1], x[2]);
    if (model->class->unseen != NULL && isfinite(fastest)) {
        char beyond[160];
        const double speed = model->class->unseen(recorder->model, state->y, sizeof beyond, beyond);
        if (speed > fastest) {
            fastest = speed;
            memcpy(where, beyond, sizeof where);
        }
    }
    return fail(messages, SELAS_UNSTABLE,
                "the run went unstable at t = %.6g (step %lu): %s; fastest %s, speed %.3g; likely: %s",
                state->time, state->step, what, where, fastest, likely_cause(recorder));
}

static bool state_finite(const struct recorder *recorder, const struct state *state)
{
    double sum = 0.0; /* 0 * x is 0 for every finite x, and NaN otherwise */
    for (size_t i = 0; i < recorder->model->state_size; i++)
        sum += 0.0 * state->y[i];
    return sum == 0.0;
}

selas_status watch_sound(const struct recorder *recorder, const struct state *state,
                         struct messages *messages)
{
    state_settle(recorder->stepper, state, false);
    if (state_finite(recorder, state)) return SELAS_OK;
    return tell_place(recorder, state, "the state is not finite", messages);
}

/* Energy from nowhere that is not yet enough to stop, but too much to trust: said once, at the end. */
static void warn_of_growth(const struct watch *watch, double total, double given, struct messages *messages)
{
    const double gained = total - watch->initial - watch->work + watch->absorbed;
    if (gained > growth_noted * given)
        warn(messages,
             "the body ends with %.3g of energy that nobody gave it (%.3g was given): the results grow by "
             "themselves and are not to be trusted",
             gained, given);
}

static selas_status judge(struct recorder *recorder, const struct state *state, double total,
                          struct messages *messages)
{
    struct watch *watch = &recorder->watch;
    char what[200];
    if (watch->by_work) {
        const double given = watch->initial + watch->gross;
        const double defect = fabs(total - watch->initial - watch->work + watch->absorbed);
        watch->largest_defect = fmax(watch->largest_defect, defect);
        if (state->step == recorder->stepper->steps) warn_of_growth(watch, total, given, messages);
        if (!(total > growth_allowed * given) || state->step < EVERY) return SELAS_OK;
        snprintf(what, sizeof what, "the body has the energy %.3g, but was given only %.3g", total, given);
    } else {
        if (state->time <= watch->reference_until) {
            watch->reference = fmax(watch->reference, total);
            return SELAS_OK;
        }
        if (!(total > growth_unwatched * watch->reference) || watch->reference <= 0.0) return SELAS_OK;
        snprintf(what, sizeof what, "the energy %.3g is %.3g times what it was when the loads came on", total,
                 total / watch->reference);
    }
    return tell_place(recorder, state, what, messages);
}

selas_status watch_observe(struct recorder *recorder, const struct state *state, struct messages *messages)
{
    struct watch *watch = &recorder->watch;
    if (watch->by_work) add_work(recorder, state);
    if (state->step < watch->next) return SELAS_OK;
    watch->next = state->step + EVERY;
    const unsigned long end = recorder->stepper->steps; /* the balance at the end is wanted in any case */
    if (state->step < end && watch->next > end) watch->next = end;
    state_settle(recorder->stepper, state, false);
    if (!state_finite(recorder, state))
        return tell_place(recorder, state, "the state is not finite", messages);
    if (recorder->model->class->energy == NULL) return SELAS_OK;
    struct energy energy = {0};
    recorder->model->class->energy(recorder->model, state->y, &energy);
    const double total = energy.kinetic + energy.strain;
    if (!isfinite(total)) return tell_place(recorder, state, "the energy is not finite", messages);
    if (!recorder->started) watch->initial = total;
    watch->largest = fmax(watch->largest, total);
    watch->last = energy;
    watch->last_time = state->time;
    return judge(recorder, state, total, messages);
}
