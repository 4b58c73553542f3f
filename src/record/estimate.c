/* How long a run will take: some of its own steps, seen by a recorder of its own, while all of the body moves
 * (what is at rest costs less). */
#include "record/watch.h"

#include "base/clock.h"
#include "parallel/ranks.h"

#include <math.h>

enum { LEAST = 2, MOST = 50 };
static const double patience = 0.5; /* seconds */

/* A host is not asked before its run. */
static void stay_silent(void *context, double time, double *load, double *displacement)
{
    (void)context;
    (void)time;
    (void)load;
    (void)displacement;
}

/* From point to point another way, so little that nothing turns or comes near its neighbour. */
static void stir(const struct model *model, double *u)
{
    const double size = 1e-6 * model->scene->body.spacing;
    for (size_t i = 0; i < model->unknowns; i++)
        u[i] += size * sin(0.7 * (double)i + 1.0);
}

/* Mean seconds of a step and what is recorded of it, after one that does not count. */
static double mean_step(struct stepper *stepper, struct recorder *recorder, struct state *state)
{
    double begun = 0.0, now = 0.0;
    int steps = -1;
    for (bool more = true; more; steps++) {
        if (steps == 0) begun = wall_seconds();
        recorder->watch.next = INFINITY; /* looks at the whole state are counted apart */
        stepper->scheme->step(stepper, state);
        recorder_observe(recorder, state, NULL);
        now = wall_seconds();
        more = steps + 1 < LEAST || (steps + 1 < MOST && now - begun < patience);
        ranks_spread(recorder->scene->ranks, 0, &more, sizeof more);
    }
    const double each = (now - begun) / steps;
    recorder->watch.next = 0.0;
    watch_observe(recorder, state, NULL);
    return each + (wall_seconds() - now) / (double)watch_every(recorder->model);
}

static double time_steps(struct stepper *stepper, struct recorder *recorder, struct state *state)
{
    if (state_create(stepper, state, NULL) != SELAS_OK) return -1.0;
    stir(stepper->model, state->y);
    if (stepper->scheme->start != NULL) stepper->scheme->start(stepper, state);
    return recorder_observe(recorder, state, NULL) == SELAS_OK ? mean_step(stepper, recorder, state) : -1.0;
}

double estimate_step(const struct recorder *own, struct stepper *stepper)
{
    const struct host_drive *host = stepper->driver.host;
    const struct host_drive silent = {.at = stay_silent};
    const unsigned long evaluations = stepper->model->evaluations;
    struct recorder *recorder = NULL;
    struct state state = {0};
    double seconds = -1.0;
    if (host != NULL) stepper->driver.host = &silent;
    if (ranks_agree(own->scene->ranks, recorder_create(own->scene, own->model, stepper, &recorder, NULL),
                    NULL) == SELAS_OK)
        seconds = time_steps(stepper, recorder, &state);
    state_free(&state);
    recorder_free(&recorder);
    stepper->model->evaluations = evaluations;
    if (stepper->model->core->forget != NULL) stepper->model->core->forget(stepper->model);
    stepper->driver.host = host;
    driver_changed(&stepper->driver, 0);
    return seconds;
}
