/* The library's door: deck -> scene -> model -> stepping -> record, each made when first needed. */
#include "accuracy/accuracy.h"
#include "method/methods.h"
#include "selas.h"

#include "base/clock.h"
#include "base/memory.h"
#include "host/simulation.h"
#include "parallel/ranks.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Seconds by the wall clock and of this process's CPUs. */
struct stopwatch {
    double wall, cpu;
};

static struct stopwatch start_watch(void)
{
    return (struct stopwatch){wall_seconds(), cpu_seconds()};
}

static void add_elapsed(struct stopwatch since, double *wall, double *cpu)
{
    const struct stopwatch now = start_watch();
    *wall += now.wall - since.wall;
    *cpu += now.cpu - since.cpu;
}

/* --- Opening and closing --- */

selas_status simulation_new(selas_simulation **simulation)
{
    if (simulation == NULL) return SELAS_BAD_ARGUMENT;
    *simulation = calloc(1, sizeof **simulation);
    if (*simulation != NULL && door_open(*simulation)) return SELAS_OK;
    free(*simulation);
    *simulation = NULL;
    return SELAS_NO_MEMORY;
}

/* A run that goes on writes where it began. */
static selas_status place_results(selas_simulation *simulation)
{
    if (simulation->results == NULL) return SELAS_OK;
    const size_t size = strlen(simulation->results) + 1;
    char *directory = array_new(size, 1);
    if (directory == NULL) return fail(&simulation->messages, SELAS_NO_MEMORY, "no memory for a name");
    memcpy(directory, simulation->results, size);
    array_free(simulation->scene->output.directory);
    simulation->scene->output.directory = directory;
    return SELAS_OK;
}

/* The scene of the deck, with what the host drives put into it. */
static selas_status build_scene(selas_simulation *simulation)
{
    const struct stopwatch begun = start_watch();
    selas_status status =
        accuracy_build(simulation->deck, host_trial, &simulation->scene, &simulation->messages);
    if (status == SELAS_OK) status = place_results(simulation);
    if (status == SELAS_OK) status = host_prepare_scene(simulation);
    if (status == SELAS_OK) simulation->scene->ranks = simulation->ranks;
    if (status != SELAS_OK) scene_free(&simulation->scene);
    add_elapsed(begun, &simulation->figures.setup_wall_seconds, &simulation->figures.setup_cpu_seconds);
    return status;
}

selas_status selas_open_deck_with(const char *path, size_t count, const char *const *overrides,
                                  selas_simulation **opened)
{
    AT_THE_DOOR(NULL);
    const selas_status status = simulation_new(opened);
    if (status != SELAS_OK) return status;
    selas_simulation *simulation = *opened;
    size_t there = 0;
    while (overrides != NULL && there < count && overrides[there] != NULL)
        there++;
    if (path == NULL || there < count)
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT, "the deck's path or the overrides are NULL");
    simulation->broken = deck_read_file(path, count, overrides, &simulation->deck, &simulation->messages);
    return simulation_scene(simulation);
}

selas_status selas_open_deck(const char *path, selas_simulation **simulation)
{
    return selas_open_deck_with(path, 0, NULL, simulation);
}

selas_status selas_open_text(const char *name, const char *text, selas_simulation **opened)
{
    AT_THE_DOOR(NULL);
    const selas_status status = simulation_new(opened);
    if (status != SELAS_OK) return status;
    selas_simulation *simulation = *opened;
    if (name == NULL || text == NULL)
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT, "the deck's name or text is NULL");
    simulation->broken =
        deck_read_text(name, text, strlen(text), 0, NULL, &simulation->deck, &simulation->messages);
    return simulation_scene(simulation);
}

selas_status selas_open_new(const char *name, selas_simulation **opened)
{
    AT_THE_DOOR(NULL);
    const selas_status status = simulation_new(opened);
    if (status != SELAS_OK) return status;
    selas_simulation *simulation = *opened;
    if (name == NULL || name[0] == '\0')
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT, "the scene's name is NULL or empty");
    return deck_new(name, &simulation->deck, &simulation->messages);
}

void simulation_discard(selas_simulation *simulation)
{
    recorder_free(&simulation->recorder);
    state_free(&simulation->state);
    stepper_free(&simulation->stepper);
    model_free(&simulation->model);
    exact_free(&simulation->exact);
    scene_free(&simulation->scene);
    array_free(simulation->scratch);
    array_free(simulation->values);
    array_free(simulation->lattice);
    simulation->scratch = simulation->values = simulation->lattice = NULL;
    simulation->values_room = 0;
    simulation->prepared = simulation->dirty = false;
    simulation->broken = SELAS_OK;
}

void selas_close(selas_simulation **closed)
{
    if (closed == NULL || *closed == NULL) return;
    selas_simulation *simulation = *closed;
    if (!door_known(simulation)) *closed = NULL;
    if (*closed == NULL || !door_taken(simulation)) return; /* not from inside, nor beside */
    door_close(simulation);
    simulation_discard(simulation);
    host_free(simulation);
    array_free(simulation->point_position);
    array_free(simulation->point_volume);
    array_free(simulation->point_material);
    free(simulation->results);
    free(simulation->work);
    free(simulation->last);
    deck_free(&simulation->deck);
    messages_free(&simulation->messages);
    ranks_leave(&simulation->joined);
    free(simulation);
    *closed = NULL;
}

/* --- Building and stepping --- */

selas_status simulation_check(selas_simulation *simulation)
{
    if (simulation == NULL || door_refused(simulation)) return SELAS_BAD_ARGUMENT;
    if (simulation->busy)
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT,
                    "a function of the host may not call its own simulation");
    if (simulation->deck != NULL) return SELAS_OK;
    if (simulation->failure[1] == 0) simulation->failure[1] = simulation->messages.length;
    return simulation_consequence(simulation,
                                  simulation->broken != SELAS_OK ? simulation->broken : SELAS_BAD_ARGUMENT);
}

selas_status simulation_may_change(selas_simulation *simulation)
{
    const selas_status status = simulation_check(simulation);
    if (status != SELAS_OK) return status;
    if (simulation->state.step > 0 || simulation->failed != SELAS_OK || simulation->finished)
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT,
                    "the scene cannot change after the first step");
    return SELAS_OK;
}

selas_status simulation_scene(selas_simulation *simulation)
{
    selas_status status = simulation_check(simulation);
    if (status != SELAS_OK || simulation->scene != NULL) return status;
    if (simulation->broken != SELAS_OK) return simulation_consequence(simulation, simulation->broken);
    status = deck_complete(simulation->deck, &simulation->messages);
    if (status == SELAS_OK) status = build_scene(simulation);
    simulation->broken = status;
    if (status != SELAS_OK) simulation_keep_failure(simulation);
    return status;
}

selas_status selas_build(selas_simulation *simulation)
{
    AT_THE_DOOR(simulation);
    simulation_call(simulation);
    return simulation_scene(simulation);
}

selas_status simulation_at_home(selas_simulation *simulation)
{
    const char *directory = simulation->scene->output.directory;
    if (directory[0] == '/' || !deck_moved(simulation->deck)) return SELAS_OK;
    return fail(&simulation->messages, SELAS_FILE_ERROR,
                "the folder of the results, '%s', is meant from where the deck was opened, which the host "
                "has left: to go "
                "back, or an output%%directory that begins with '/', would be right",
                directory);
}

selas_status simulation_prepare(selas_simulation *simulation)
{
    selas_status status = simulation_scene(simulation);
    if (status != SELAS_OK || simulation->prepared) return status;
    struct messages *messages = &simulation->messages;
    const struct stopwatch begun = start_watch();
    status = shared_check(simulation);
    if (status == SELAS_OK && simulation->model == NULL)
        status = model_create(simulation->scene, &simulation->model, messages);
    if (ranks_idle(simulation->ranks)) return SELAS_STOPPED;
    status = shared_made(simulation, status);
    if (status == SELAS_OK && simulation->stepper == NULL)
        status = stepper_create(simulation->model, &simulation->stepper, messages);
    if (status == SELAS_OK) host_prepare_stepper(simulation);
    if (status == SELAS_OK && simulation->recorder == NULL)
        status = recorder_create(simulation->scene, simulation->model, simulation->stepper,
                                 &simulation->recorder, messages);
    status = shared_prepared(simulation, status);
    if (status == SELAS_OK) recorder_weigh(simulation->recorder);
    simulation->prepared = status == SELAS_OK;
    simulation->figures.threads = omp_get_max_threads();
    add_elapsed(begun, &simulation->figures.setup_wall_seconds, &simulation->figures.setup_cpu_seconds);
    return status;
}

selas_status simulation_state(selas_simulation *simulation)
{
    selas_status status = state_create(simulation->stepper, &simulation->state, &simulation->messages);
    if (status == SELAS_OK) status = recorder_keep_files(simulation->recorder, &simulation->messages);
    return ranks_agree(simulation->ranks, status, &simulation->messages);
}

/* The state at t = 0, seen by the recorder. */
static selas_status start(selas_simulation *simulation)
{
    selas_status status = simulation_prepare(simulation);
    if (status != SELAS_OK || simulation->state.y != NULL) return status;
    if (simulation->recording) status = simulation_at_home(simulation);
    if (status != SELAS_OK) return status;
    const struct stopwatch begun = start_watch();
    model_computed(simulation->model)->evaluations = 0;
    status = simulation_state(simulation);
    if (status == SELAS_OK && simulation->recording)
        status = recorder_open(simulation->recorder, NULL, &simulation->messages);
    status = ranks_agree(simulation->ranks, status, &simulation->messages);
    if (status == SELAS_OK)
        status = recorder_observe(simulation->recorder, &simulation->state, &simulation->messages);
    if (status == SELAS_OK) status = host_answer(simulation);
    if (status != SELAS_STOPPED) simulation_failed(simulation, status);
    add_elapsed(begun, &simulation->figures.setup_wall_seconds, &simulation->figures.setup_cpu_seconds);
    return status;
}

selas_status simulation_begin(selas_simulation *simulation)
{
    selas_status status = start(simulation);
    if (status != SELAS_OK) return status;
    if (simulation->failed != SELAS_OK) return simulation_consequence(simulation, simulation->failed);
    status = host_refresh(simulation);
    if (status != SELAS_OK) simulation_failed(simulation, status);
    return status;
}

selas_status simulation_reach(selas_simulation *simulation, unsigned long step)
{
    struct driver *driver = &simulation->stepper->driver;
    if (driver_reaches(driver, step)) return SELAS_OK;
    return ranks_agree(simulation->ranks, driver_reach(driver, step, &simulation->messages),
                       &simulation->messages);
}

static selas_status run_steps(selas_simulation *simulation, unsigned long steps)
{
    selas_status status = simulation_begin(simulation);
    if (status != SELAS_OK) return status;
    struct messages *messages = &simulation->messages;
    if (simulation->finished && steps > 0)
        return fail(messages, SELAS_BAD_ARGUMENT, "the histories are finished; no step can follow");
    if (simulation->recording && steps > 0) status = simulation_at_home(simulation);
    if (status != SELAS_OK) return status;
    if (steps > 0) host_advise(simulation);
    const struct stopwatch begun = start_watch();
    const double waited = ranks_waited(simulation->ranks);
    for (unsigned long i = 0; i < steps && status == SELAS_OK; i++) {
        const double sent = ranks_sent(simulation->ranks);
        status = simulation_reach(simulation, simulation->state.step + 1);
        if (status != SELAS_OK) break;
        simulation->stepper->scheme->step(simulation->stepper, &simulation->state);
        simulation->figures.halo_bytes = ranks_sent(simulation->ranks) - sent;
        status = host_answer(simulation);
        const bool stopped = status == SELAS_STOPPED;
        if (stopped) status = SELAS_OK;
        if (status == SELAS_OK) status = recorder_observe(simulation->recorder, &simulation->state, messages);
        if (status == SELAS_OK && stopped) status = SELAS_STOPPED;
    }
    if (status != SELAS_STOPPED) simulation_failed(simulation, status);
    add_elapsed(begun, &simulation->figures.wall_seconds, &simulation->figures.cpu_seconds);
    shared_add_times(simulation, wall_seconds() - begun.wall, ranks_waited(simulation->ranks) - waited);
    return status;
}

selas_status selas_step(selas_simulation *simulation, unsigned long steps)
{
    AT_THE_DOOR(simulation);
    simulation_call(simulation);
    const selas_status status = simulation_check(simulation);
    if (status != SELAS_OK) return status;
    if (steps <= ~0UL >> 1) return run_steps(simulation, steps);
    return fail(&simulation->messages, SELAS_BAD_ARGUMENT, "a number of steps below 0, or too large");
}

selas_status selas_advance(selas_simulation *simulation, double time)
{
    AT_THE_DOOR(simulation);
    simulation_call(simulation);
    const selas_status status = simulation_prepare(simulation);
    if (status != SELAS_OK) return status;
    if (!isfinite(time))
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT, "the time to advance to must be finite");
    const double steps = ceil(time / simulation->stepper->dt - 1e-9);
    if (steps <= (double)simulation->state.step) return run_steps(simulation, 0);
    if (steps > 9e15) return fail(&simulation->messages, SELAS_BAD_ARGUMENT, "time %g is too far away", time);
    return run_steps(simulation, (unsigned long)steps - simulation->state.step);
}

double selas_time(const selas_simulation *simulation)
{
    return door_known(simulation) && simulation->deck != NULL ? simulation->state.time : (double)NAN;
}

double selas_end_time(selas_simulation *simulation)
{
    AT_THE_DOOR(simulation);
    return simulation_scene(simulation) == SELAS_OK ? simulation->scene->end_time : (double)NAN;
}

double selas_time_step(selas_simulation *simulation)
{
    AT_THE_DOOR(simulation);
    return simulation_prepare(simulation) == SELAS_OK ? simulation->stepper->dt : 0.0;
}

unsigned long selas_steps(const selas_simulation *simulation)
{
    return door_known(simulation) ? simulation->state.step : 0;
}

unsigned long selas_steps_needed(selas_simulation *simulation)
{
    AT_THE_DOOR(simulation);
    if (simulation_prepare(simulation) != SELAS_OK) return 0;
    return simulation->stepper->steps + simulation->stepper->extra;
}

selas_status simulation_finish(selas_simulation *simulation)
{
    selas_status status = simulation_begin(simulation);
    if (status != SELAS_OK || simulation->finished) return status;
    const unsigned long needed = simulation->stepper->steps + simulation->stepper->extra;
    if (simulation->state.step < needed) status = run_steps(simulation, needed - simulation->state.step);
    if (status == SELAS_OK) status = recorder_finish(simulation->recorder, &simulation->messages);
    status = ranks_agree(simulation->ranks, status, &simulation->messages);
    if (status == SELAS_OK) shared_gather_times(simulation);
    simulation->finished = status == SELAS_OK;
    return status;
}

selas_status selas_finish(selas_simulation *simulation)
{
    AT_THE_DOOR(simulation);
    simulation_call(simulation);
    return simulation_finish(simulation);
}

const char *selas_output_directory(selas_simulation *simulation)
{
    AT_THE_DOOR(simulation);
    return simulation_scene(simulation) == SELAS_OK ? simulation->scene->output.directory : "";
}
