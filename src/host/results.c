/* What a host and the program get from a run: values and histories at receivers, result files, the exact
 * solution, the plan. */
#include "host/simulation.h"

#include "base/clock.h"
#include "parallel/ranks.h"

#include <string.h>

static selas_status find_receiver(selas_simulation *simulation, const char *name, size_t *index)
{
    const struct scene *scene = simulation->scene;
    for (size_t i = 0; name != NULL && i < scene->receivers; i++)
        if (strcmp(scene->receiver[i].name, name) == 0) {
            *index = i;
            return SELAS_OK;
        }
    return fail(&simulation->messages, SELAS_BAD_ARGUMENT, "there is no receiver '%s'",
                name != NULL ? name : "(NULL)");
}

selas_status selas_receiver(selas_simulation *simulation, const char *name, selas_field field, double *value)
{
    AT_THE_DOOR(simulation);
    simulation_call(simulation);
    selas_status status = simulation_begin(simulation);
    if (status != SELAS_OK) return status;
    if (value == NULL || field < SELAS_DISPLACEMENT || field > SELAS_ENERGY)
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT, "no such field, or no room for its value");
    size_t index = 0;
    status = find_receiver(simulation, name, &index);
    if (status != SELAS_OK) return status;
    const struct receiver *receiver = &simulation->scene->receiver[index];
    host_looks_at(simulation, receiver->position, "a receiver");
    host_reads(simulation, receiver, field);
    recorder_value(simulation->recorder, index, field, &simulation->state, value);
    return SELAS_OK;
}

selas_status selas_history(selas_simulation *simulation, const char *name, size_t *rows, const double **time,
                           const double **value)
{
    AT_THE_DOOR(simulation);
    simulation_call(simulation);
    selas_status status = simulation_scene(simulation);
    if (status != SELAS_OK) return status;
    if (!simulation->finished || rows == NULL || time == NULL || value == NULL)
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT,
                    "histories exist after selas_finish, and need room for rows, time and value");
    size_t index = 0;
    status = find_receiver(simulation, name, &index);
    if (status != SELAS_OK) return status;
    const struct history_rows history = recorder_history(simulation->recorder, index);
    *rows = history.rows;
    *time = history.time;
    *value = history.value;
    return SELAS_OK;
}

selas_status selas_record(selas_simulation *simulation)
{
    AT_THE_DOOR(simulation);
    simulation_call(simulation);
    const selas_status status = simulation_scene(simulation);
    if (status != SELAS_OK) return status;
    if (simulation->state.y != NULL && !simulation->recording)
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT,
                    "ask for result files before the first step, and before a value is read at t = 0");
    simulation->recording = true;
    return SELAS_OK;
}

/* Refuses what has none; `compute`: histories will be asked of it. */
static selas_status make_exact(selas_simulation *simulation, bool compute)
{
    if (simulation->scene->reference.kind[0] == '\0') return SELAS_OK;
    const double begin = cpu_seconds();
    selas_status status = SELAS_OK;
    if (simulation->exact == NULL)
        status = exact_create(simulation->scene, &simulation->exact, &simulation->messages);
    if (status == SELAS_OK && compute) status = exact_compute(simulation->exact, &simulation->messages);
    simulation->figures.exact_cpu_seconds += cpu_seconds() - begin;
    return status;
}

selas_status selas_write(selas_simulation *simulation)
{
    AT_THE_DOOR(simulation);
    simulation_call(simulation);
    selas_status status = simulation_scene(simulation);
    if (status != SELAS_OK) return status;
    if (!simulation->recording)
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT,
                    "selas_record was not called before the first step");
    status = simulation_at_home(simulation);
    if (status == SELAS_OK) status = simulation_finish(simulation);
    if (status != SELAS_OK) return status;
    /* what was computed is written, whether there is something to compare it with or not */
    const selas_status compared = ranks_first(simulation->ranks) ? make_exact(simulation, true) : SELAS_OK;
    status =
        recorder_write(simulation->recorder, simulation->exact, &simulation->figures, &simulation->messages);
    return status == SELAS_OK ? compared : status;
}

selas_status selas_write_exact(selas_simulation *simulation)
{
    AT_THE_DOOR(simulation);
    simulation_call(simulation);
    selas_status status = simulation_scene(simulation);
    if (status != SELAS_OK) return status;
    if (simulation->scene->reference.kind[0] == '\0')
        return fail(&simulation->messages, SELAS_BAD_SCENE, "the deck has no &reference");
    status = simulation_at_home(simulation);
    if (status == SELAS_OK) status = make_exact(simulation, true);
    if (status == SELAS_OK)
        status = record_exact(simulation->scene, simulation->exact, &simulation->messages);
    return status;
}

selas_status selas_plan(selas_simulation *simulation,
                        void (*tell)(void *context, const char *key, const char *value), void *context)
{
    AT_THE_DOOR(simulation);
    simulation_call(simulation);
    selas_status status = simulation_check(simulation);
    if (status != SELAS_OK) return status;
    if (tell == NULL)
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT, "there is nobody to tell the plan to");
    status = simulation_prepare(simulation);
    if (status != SELAS_OK) return status;
    simulation->busy = true;
    recorder_plan(simulation->recorder, simulation->state.y == NULL ? simulation->stepper : NULL, tell,
                  context);
    simulation->busy = false;
    if (!ranks_first(simulation->ranks)) return SELAS_OK;
    return make_exact(simulation, false); /* what the run would refuse when it is over */
}
