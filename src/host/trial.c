/* The trial of scene%accuracy: a simulation of its own that nobody sees (accuracy/trial.h). */
#include "compare/misfit.h"
#include "host/simulation.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

/* Relative L2 error of the velocity vector at a receiver. */
static selas_status error_at(const struct history_rows *history, const double position[3],
                             struct exact *exact, double *error, struct messages *messages)
{
    double *value = array_new(6 * history->rows, sizeof *value);
    if (value == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the exact history of a trial");
    const selas_status status =
        exact->class->history(exact, position, history->rows, history->time, value, messages);
    const struct misfit whole = misfit_of(history->rows, history->time, history->value + 3, value + 3, 6, 3);
    *error = whole.l2_of > 0 ? whole.l2 / whole.l2_of : 0;
    array_free(value);
    return status;
}

static selas_status keep(const struct history_rows *history, struct history_file *kept,
                         struct messages *messages)
{
    const size_t rows = history->rows;
    kept->time = array_new(rows, sizeof *kept->time);
    kept->value = array_new(6 * rows, sizeof *kept->value);
    if (kept->time == NULL || kept->value == NULL)
        return fail(messages, SELAS_NO_MEMORY, "no memory for the histories of a trial");
    kept->rows = rows;
    memcpy(kept->time, history->time, rows * sizeof *kept->time);
    memcpy(kept->value, history->value, 6 * rows * sizeof *kept->value);
    return SELAS_OK;
}

selas_status host_trial(struct scene *scene, struct exact *exact, double *error, struct history_file *kept,
                        struct messages *messages)
{
    struct scene bare = *scene;
    bare.snapshots = bare.profiles = 0;
    struct selas_simulation simulation = {
        .scene = &bare, .deck = (struct deck *)scene->deck, .advised = true};
    selas_status status = simulation_finish(&simulation);
    for (size_t i = 0; i < bare.receivers && status == SELAS_OK; i++) {
        const struct history_rows history = recorder_history(simulation.recorder, i);
        const double *place = bare.receiver[i].position;
        if (exact != NULL) status = error_at(&history, place, exact, &error[i], &simulation.messages);
        if (kept != NULL && status == SELAS_OK) status = keep(&history, &kept[i], &simulation.messages);
    }
    if (status != SELAS_OK)
        fail(messages, status, "the trial run of scene%%accuracy (spacing %g): %s", bare.body.spacing,
             simulation.messages.text != NULL ? simulation.messages.text : "no memory");
    simulation.scene = NULL; /* the caller's */
    simulation_discard(&simulation);
    messages_free(&simulation.messages);
    return status;
}
