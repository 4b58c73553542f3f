/* The watch over a run: is the state finite, and has the body more energy than was put into it?
 *
 * What the loads have put in cannot be less than the energy gained: E(t) - E(0) <= work done by the loads.
 * Where the model tells the power of its loads, the work is summed over the steps (trapezoid); elsewhere the
 * energy is held against its largest value while the loads came on. */
#include "record/watch.h"

#include "base/sums.h"
#include "parallel/ranks.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>

/* Energy of the state at a step may differ from the scheme's own conserved energy near the stability limit
 * (leapfrog: by up to 1 / (1 - (omega dt / 2)^2), 5 at nine tenths of the limit): growth beyond ten times the
 * work is no rounding and no such difference. */
static const double growth_allowed = 10.0;
/* In fewer steps the trapezoid of the work of a load that just begins is itself half wrong. */
enum { NOTED_STEPS = 8 };
/* Moved faces: times what they can give (faces_can_give). */
static const double growth_of_faces = 100.0;
/* Without work: a free body under a steady push gains energy as t^2, a hundredfold between a tenth of the run
 * and its end. */
static const double growth_unwatched = 1e4;

/* Largest way and speed of a moved face over the run, as the steps see them. */
static void motion_of(const struct recorder *recorder, const struct boundary *boundary, double *way,
                      double *speed)
{
    const struct stepper *stepper = recorder->stepper;
    double before = 0.0;
    for (unsigned long step = 1; step <= stepper->steps; step++) {
        const double now = boundary_displacement(boundary, (double)step * stepper->dt, 0);
        *way = fmax(*way, fabs(boundary->amplitude * now));
        *speed = fmax(*speed, fabs(boundary->amplitude * (now - before)) / stepper->dt);
        before = now;
    }
}

/* A face that is moved by U at the speed V gives a body of mass M, extent L and waves of speed c energy of
 * the order M (V^2 + c^2 (U / L)^2); driven in resonance the amplitude grows with every passage of a wave,
 * that is (1 + t c / L)^2 times that at time t. The power itself is not known to most methods. */
static void faces_can_give(struct recorder *recorder)
{
    const struct scene *scene = recorder->scene;
    struct watch *watch = &recorder->watch;
    double way = 0.0, speed = 0.0, density = 0.0, shortest = INFINITY, mass;
    for (size_t face = 0; face < FACES; face++) {
        const struct boundary *boundary = &scene->boundary[face];
        if (boundary_moves(boundary)) motion_of(recorder, boundary, &way, &speed);
    }
    for (size_t m = 0; m < scene->materials; m++)
        density = fmax(density, scene->material[m].density);
    for (int axis = 0; axis < scene->dimension; axis++)
        shortest = fmin(shortest, scene->body.high[axis] - scene->body.low[axis]);
    mass = density * (double)recorder->model->points * pow(scene->body.spacing, scene->dimension);
    watch->face_rate = shortest > 0.0 ? scene_fastest(scene) / shortest : 0.0;
    watch->face_energy = mass * (speed * speed + pow(way * watch->face_rate, 2.0));
}

void watch_start(struct recorder *recorder)
{
    const struct scene *scene = recorder->scene;
    struct watch *watch = &recorder->watch;
    const bool moved = (scene_needs(scene) & CAN_MOVE) != 0;
    *watch = (struct watch){0};
    watch->by_work = recorder->model->core->power != NULL && recorder->model->core->energy != NULL && !moved;
    watch->with_faces = moved && !scene_driven(scene) && recorder->model->core->power != NULL;
    if (watch->with_faces) faces_can_give(recorder);
    watch->reference_until = scene_driven(scene) ? scene->end_time : 0.1 * scene->end_time;
    for (size_t k = 0; k < scene->loads; k++)
        watch->reference_until = fmax(watch->reference_until, history_end(&scene->load[k].history));
    for (size_t face = 0; face < FACES; face++)
        if (boundary_moves(&scene->boundary[face]))
            watch->reference_until =
                fmax(watch->reference_until, history_end(&scene->boundary[face].history));
}

static void add_work(struct recorder *recorder, const struct state *state, double load, double absorbed)
{
    struct watch *watch = &recorder->watch;
    double damped = 0.0;
    if (recorder->model->untold) watch->untold = 1;
    if (recorder->scene->output.balance && recorder->model->core->loss != NULL) {
        state_settle(recorder->stepper, state, false);
        damped = recorder->model->core->loss(recorder->model, state->y);
    }
    if (recorder->started) {
        const double half = 0.5 * (state->time - recorder->last_time);
        watch->work += half * (watch->power + load);
        watch->gross += half * (fmax(watch->power, 0.0) + fmax(load, 0.0));
        watch->absorbed += half * (watch->power_absorbed + absorbed);
        watch->damped += half * (watch->power_damped + damped);
    }
    watch->power = load;
    watch->power_damped = damped;
    watch->power_absorbed = absorbed;
}

/* Sums of squares are finite, in numbers that can be worked with: a square that overflows spoils the energy.
 */
static const char *wrong_with_state(const struct recorder *recorder, const struct state *state)
{
    const size_t size = recorder->model->state_size;
    double spoiled = 0.0; /* 0 * x is 0 for every finite x, and NaN otherwise */
    double wrong = isfinite(sum_of_products(size, state->y, state->y, omp_get_max_threads())) ? 0.0 : 1.0;
    for (size_t i = 0; i < size && wrong > 0.0; i++)
        spoiled += 0.0 * state->y[i];
    if (spoiled != 0.0) wrong = 2.0;
    ranks_largest(recorder->scene->ranks, 1, &wrong);
    return wrong == 0.0 ? NULL : wrong == 1.0 ? "the state overflows" : "the state is not finite";
}

/* Some numbers of the state, others at every step: what is not finite spreads and is soon among them, while
 * it still is where it began. *energetic: velocities among them are far above those at the last such time. */
static bool sample_sound(struct recorder *recorder, const struct state *state, bool *energetic)
{
    enum { SAMPLED = 2048, APART = 31, FAR_ABOVE = 16 };
    const size_t size = recorder->model->state_size, unknowns = recorder->model->unknowns;
    const size_t apart = (size / SAMPLED > APART ? size / SAMPLED : APART) | 1; /* no row of a lattice */
    double sum = 0.0, velocities = 0.0;
    for (size_t i = state->step % apart; i < size; i += apart) {
        const double square = state->y[i] * state->y[i];
        sum += 0.0 * square;
        if (i >= unknowns && i < 2 * unknowns) velocities += square;
    }
    *energetic = velocities > FAR_ABOVE * recorder->watch.sampled;
    if (*energetic) recorder->watch.sampled = velocities;
    return sum == 0.0;
}

selas_status watch_sound(const struct recorder *recorder, const struct state *state,
                         struct messages *messages)
{
    state_settle(recorder->stepper, state, false);
    const char *wrong = wrong_with_state(recorder, state);
    return wrong == NULL ? SELAS_OK : watch_tell(recorder, state, wrong, messages);
}

/* What can have grown by itself. To what does not move an absorbing layer is all but soft, so that a static
 * field has strain energy there that nobody gave it (doc/theory/absorbing-faces.md, section 3). Beside layers only
 * what moves counts: twice the kinetic energy, for waves have as much strain energy in the mean; and that of
 * leapfrog's half-step velocities w = v + dt/2 a, for at the shortest period, 2 dt, v is 0. */
static double energy_of_waves(const struct recorder *recorder, const struct state *state,
                              const struct energy *energy)
{
    const struct model *model = recorder->stepper->model;
    const double total = energy->kinetic + energy->strain, dt = recorder->stepper->dt;
    if (model->memory == NULL || total <= recorder->watch.initial + recorder->watch.work) return total;
    state_settle(recorder->stepper, state, true);
    const double *v = state->y + model->unknowns, *a = state->a;
    const int threads = omp_get_max_threads();
    double sum[3] = {sum_of_products(model->unknowns, v, v, threads), /* of ranks with their halos */
                     sum_of_products(model->unknowns, v, a, threads),
                     sum_of_products(model->unknowns, a, a, threads)};
    ranks_sum(recorder->scene->ranks, 3, sum);
    const double vv = sum[0], ww = vv + dt * sum[1] + 0.25 * dt * dt * sum[2];
    return fmin(total, 2.0 * energy->kinetic * (vv > 0.0 ? fmax(1.0, ww / vv) : 1.0));
}

/* More energy than can have been given? Fills `what` if so. */
static bool grown(const struct recorder *recorder, const struct state *state, double waves, size_t size,
                  char *what)
{
    const struct watch *watch = &recorder->watch;
    const double given = watch_given(watch, state->time);
    const bool last = watch->by_work && state->step == recorder->stepper->steps;
    if (state->step < (last ? NOTED_STEPS : WATCH_EVERY)) return false;
    if (watch->by_work && waves > growth_allowed * given)
        snprintf(what, size, "the body has the energy %.3g, but was given only %.3g", waves, given);
    else if (!watch->by_work && watch->face_energy > 0.0 && waves > growth_of_faces * given)
        snprintf(what, size,
                 "the body has the energy %.3g, but loads and moved faces can have given only some %.3g",
                 waves, given);
    else if (!watch->by_work && state->time > watch->reference_until && watch->reference > 0.0 &&
             waves > growth_unwatched * watch->reference)
        snprintf(what, size, "the energy %.3g is %.3g times what it was when the loads came on", waves,
                 waves / watch->reference);
    else
        return false;
    return true;
}

static void keep_energy(struct recorder *recorder, const struct state *state, const struct energy *energy)
{
    struct watch *watch = &recorder->watch;
    const double total = energy->kinetic + energy->strain, waves = energy_of_waves(recorder, state, energy);
    const bool last = state->step == recorder->stepper->steps && state->step >= NOTED_STEPS;
    if (!recorder->started) watch->initial = total;
    watch->largest = fmax(watch->largest, total);
    watch->last = *energy;
    watch->worked = watch->work;
    watch->let_out = watch->absorbed;
    watch->taken = watch->damped;
    watch->last_time = state->time;
    if (watch->by_work) {
        const double defect = fabs(total - watch->initial - watch->work + watch->absorbed + watch->damped);
        watch->largest_defect = fmax(watch->largest_defect, defect);
        if (last) watch->gained = waves - watch->initial - watch->work + watch->absorbed + watch->damped;
    } else if (state->time <= watch->reference_until) {
        watch->reference = fmax(watch->reference, waves);
    }
    if (last && watch->face_energy > 0.0) watch->gained = fmax(0.0, waves - watch_given(watch, state->time));
}

/* Energy of a settled state; kept for the report if it is one of those looked at regularly. */
static selas_status judge(struct recorder *recorder, const struct state *state, bool keep,
                          struct messages *messages)
{
    char what[200];
    struct energy energy = {0};
    if (recorder->model->core->energy == NULL) return SELAS_OK;
    recorder->model->core->energy(recorder->model, state->y, &energy);
    const double total = energy.kinetic + energy.strain;
    if (!isfinite(total)) return watch_tell(recorder, state, "the energy is not finite", messages);
    if (keep) keep_energy(recorder, state, &energy);
    const double waves = energy_of_waves(recorder, state, &energy);
    return grown(recorder, state, waves, sizeof what, what) ? watch_tell(recorder, state, what, messages)
                                                            : SELAS_OK;
}

/* What all ranks together see of a step. */
enum { SEEN_WHOLE, SEEN_UNSOUND, SEEN_ENERGETIC, SEEN_LOAD, SEEN_ABSORBED, SEEN };

static void see(struct recorder *recorder, const struct state *state, double seen[SEEN])
{
    struct watch *watch = &recorder->watch;
    bool energetic = false;
    const bool whole = !((double)state->step < watch->next);
    if (watch->by_work || watch->with_faces) {
        const struct drive drive = driver_last(&recorder->stepper->driver, state->time);
        recorder->model->core->power(recorder->model, &drive, state->y, &seen[SEEN_LOAD],
                                     &seen[SEEN_ABSORBED]);
    }
    if (!whole && !sample_sound(recorder, state, &energetic)) seen[SEEN_UNSOUND] = 1.0;
    seen[SEEN_WHOLE] = whole ? 1.0 : 0.0;
    seen[SEEN_ENERGETIC] = energetic ? 1.0 : 0.0;
    ranks_sum(recorder->scene->ranks, SEEN, seen);
    if (watch->by_work || watch->with_faces) add_work(recorder, state, seen[SEEN_LOAD], seen[SEEN_ABSORBED]);
}

/* Between the looks at everything; leaves nothing in the results. */
static selas_status glance(struct recorder *recorder, const struct state *state, const double seen[SEEN],
                           struct messages *messages)
{
    if (seen[SEEN_UNSOUND] > 0.0) return watch_sound(recorder, state, messages);
    if (!(seen[SEEN_ENERGETIC] > 0.0)) return SELAS_OK;
    state_settle(recorder->stepper, state, false);
    return judge(recorder, state, false, messages);
}

selas_status watch_observe(struct recorder *recorder, const struct state *state, struct messages *messages)
{
    struct watch *watch = &recorder->watch;
    double seen[SEEN] = {0};
    see(recorder, state, seen);
    if (!(seen[SEEN_WHOLE] > 0.0)) {
        const selas_status glanced = glance(recorder, state, seen, messages);
        if (glanced == SELAS_OK) hindsight_observe(recorder, state, false, messages);
        return glanced;
    }
    const unsigned long end = recorder->stepper->steps, next = state->step + watch_every(recorder->model);
    /* the balance at the end is wanted in any case */
    watch->next = (double)(state->step < end && next > end ? end : next);
    selas_status status = watch_sound(recorder, state, messages);
    if (status == SELAS_OK) status = judge(recorder, state, true, messages);
    if (status == SELAS_OK) hindsight_observe(recorder, state, true, messages);
    return status;
}
