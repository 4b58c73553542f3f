/* Saving a simulation and going on with it; runs that go on from a checkpoint, or are made again from the
 * deck in run.h5. */
#include "host/simulation.h"
#include "parallel/ranks.h"

#include "record/kept.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static selas_status check_path(selas_simulation *simulation, const char *path)
{
    if (path == NULL || path[0] == '\0')
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT, "the checkpoint's path is NULL or empty");
    return simulation->failed == SELAS_OK ? SELAS_OK : simulation_consequence(simulation, simulation->failed);
}

selas_status selas_save(selas_simulation *simulation, const char *path)
{
    AT_THE_DOOR(simulation);
    simulation_call(simulation);
    selas_status status = simulation_begin(simulation);
    if (status == SELAS_OK) status = check_path(simulation, path);
    if (status == SELAS_OK && scene_driven(simulation->scene))
        status = shared_alone(simulation, "a checkpoint of loads that a host drives");
    if (status != SELAS_OK) return status;
    return checkpoint_write(simulation->recorder, &simulation->state, &simulation->figures, path,
                            KEEP_NOTHING, &simulation->messages);
}

/* --- Going on --- */

/* The folder that holds a path; NULL without memory. */
static char *folder_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    if (slash == NULL) return strdup(".");
    return strndup(path, slash == path ? 1 : (size_t)(slash - path));
}

/* Result files go on where they were begun: with the snapshots so far. */
static selas_status open_again(selas_simulation *simulation)
{
    const char *results = simulation->scene->output.directory;
    const size_t size = strlen(results) + 16;
    char *work = simulation->work != NULL ? strdup(simulation->work) : malloc(size);
    if (work == NULL) return fail(&simulation->messages, SELAS_NO_MEMORY, "no memory for a name");
    if (simulation->work == NULL) snprintf(work, size, "%s/unfinished", results);
    const selas_status status = recorder_open(simulation->recorder, work, &simulation->messages);
    free(work);
    return status;
}

/* The simulation with a state that nobody has seen yet. */
static selas_status prepare_restore(selas_simulation *simulation)
{
    selas_status status = simulation_prepare(simulation);
    if (status != SELAS_OK) return status;
    if (simulation->state.step > 0)
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT, "restore before the first step");
    if (simulation->recording && simulation->state.y != NULL)
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT,
                    "with result files restore right after selas_record");
    if (simulation->state.y == NULL) status = simulation_state(simulation);
    if (status == SELAS_OK && simulation->recording) status = open_again(simulation);
    return ranks_agree(simulation->ranks, status, &simulation->messages);
}

selas_status selas_restore(selas_simulation *simulation, const char *path)
{
    AT_THE_DOOR(simulation);
    simulation_call(simulation);
    selas_status status = simulation_prepare(simulation);
    if (status == SELAS_OK) status = check_path(simulation, path);
    if (status == SELAS_OK) status = prepare_restore(simulation);
    if (status != SELAS_OK) return status;
    simulation_failed(simulation, checkpoint_read(simulation->recorder, &simulation->state,
                                                  &simulation->figures, path, &simulation->messages));
    struct stepper *stepper = simulation->stepper;
    if (simulation->failed == SELAS_OK)
        simulation_failed(simulation, simulation_reach(simulation, simulation->state.step));
    if (simulation->failed != SELAS_OK) return simulation->failed;
    driver_changed(&stepper->driver, 0);
    simulation->dirty = false;
    const unsigned long evaluations = model_computed(simulation->model)->evaluations;
    if (stepper->scheme->resume != NULL) stepper->scheme->resume(stepper, &simulation->state);
    model_computed(simulation->model)->evaluations = evaluations;
    return SELAS_OK;
}

/* --- Runs of the program --- */

static selas_status read_kept(selas_simulation *simulation, const struct kept_deck *kept, size_t count,
                              const char *const *overrides)
{
    const size_t size = strlen(kept->name) + sizeof ".nml";
    char *name = malloc(size);
    if (name == NULL) return fail(&simulation->messages, SELAS_NO_MEMORY, "no memory for a name");
    snprintf(name, size, "%s.nml", kept->name);
    selas_status status = deck_read_text(name, kept->text, strlen(kept->text), count, overrides,
                                         &simulation->deck, &simulation->messages);
    free(name);
    if (status == SELAS_OK)
        status = deck_set_source(simulation->deck, kept->source, kept->origin, &simulation->messages);
    return status;
}

static bool named_unfinished(const char *folder)
{
    const char *slash = strrchr(folder, '/');
    return strncmp(slash != NULL ? slash + 1 : folder, "unfinished", 10) == 0;
}

/* The checkpoint of a run lies beside its snapshots in a folder of their own in that of the results. */
static selas_status find_results(selas_simulation *simulation, const char *path)
{
    char *folder = folder_of(path);
    if (folder != NULL && !named_unfinished(folder)) { /* "checkpoint.h5" to one who stands there */
        char *whole = realpath(folder, NULL);
        free(folder);
        folder = whole;
    }
    if (folder != NULL && !named_unfinished(folder)) {
        free(folder);
        return fail(&simulation->messages, SELAS_FILE_ERROR,
                    "'%s' lies in no folder 'unfinished': a run goes on beside the snapshots that it has",
                    path);
    }
    simulation->work = folder;
    simulation->results = folder != NULL ? folder_of(folder) : NULL;
    if (simulation->results != NULL) return SELAS_OK;
    return fail(&simulation->messages, SELAS_NO_MEMORY, "no memory for a name");
}

selas_status simulation_open_checkpoint(const char *path, struct ranks *ranks, selas_simulation **opened)
{
    struct kept_deck kept;
    selas_status status = simulation_new(opened);
    if (status != SELAS_OK) return status;
    selas_simulation *simulation = *opened;
    status = kept_deck_of_checkpoint(path, ranks, &kept, &simulation->messages);
    if (status == SELAS_OK) status = find_results(simulation, path);
    if (status == SELAS_OK) status = read_kept(simulation, &kept, 0, NULL);
    if (status == SELAS_OK && deck_changed(simulation->deck))
        warn(&simulation->messages,
             "the deck '%s' has changed since this run was begun, which goes on as it was begun: for the "
             "changed deck a "
             "run of its own would be right",
             kept.origin);
    kept_deck_free(&kept);
    return status == SELAS_OK ? simulation_scene(simulation) : status;
}

/* The results that run.h5 belongs to stay as they are, unless the user says where to go. */
static selas_status place_rerun(selas_simulation *simulation)
{
    const char *name = deck_name(simulation->deck);
    const size_t size = strlen(name) + sizeof "output/-rerun";
    if (deck_given(deck_get(simulation->deck, "output", 0), "directory")) return SELAS_OK;
    simulation->results = malloc(size);
    if (simulation->results == NULL)
        return fail(&simulation->messages, SELAS_NO_MEMORY, "no memory for a name");
    snprintf(simulation->results, size, "output/%s-rerun", name);
    return SELAS_OK;
}

/* The deck only names its files, and nothing keeps what a host gave; overrides that name files mean others. */
static void warn_of_change(selas_simulation *simulation, const char *path, const char *files)
{
    if (files == NULL || !kept_files_changed(simulation->scene, files)) return;
    warn(&simulation->messages,
         "a file that the deck of '%s' names has changed since, or a host gave that run its points or drove "
         "its loads: "
         "this is another run; the files as they were would be right",
         path);
}

selas_status simulation_open_run(const char *path, size_t count, const char *const *overrides,
                                 selas_simulation **opened)
{
    struct kept_deck kept;
    selas_status status = simulation_new(opened);
    if (status != SELAS_OK) return status;
    selas_simulation *simulation = *opened;
    status = kept_deck_of_run(path, &kept, &simulation->messages);
    const char **all = status == SELAS_OK ? malloc((count + 1) * sizeof *all) : NULL;
    if (all != NULL) {
        all[0] = "output%directory=";
        for (size_t i = 0; i < count; i++)
            all[i + 1] = overrides[i];
        status = read_kept(simulation, &kept, count + 1, all);
    } else if (status == SELAS_OK) {
        status = fail(&simulation->messages, SELAS_NO_MEMORY, "no memory for the overrides");
    }
    if (status == SELAS_OK) status = place_rerun(simulation);
    if (status == SELAS_OK) status = simulation_scene(simulation);
    if (status == SELAS_OK) warn_of_change(simulation, path, kept.files);
    free(all);
    kept_deck_free(&kept);
    return status;
}

char *simulation_checkpoint_path(selas_simulation *simulation)
{
    const char *folder = simulation->work != NULL ? simulation->work : selas_output_directory(simulation);
    const size_t size = strlen(folder) + 40;
    char *path = malloc(size);
    if (path != NULL)
        snprintf(path, size, "%s%s/checkpoint.h5", folder, simulation->work != NULL ? "" : "/unfinished");
    return path;
}

selas_status simulation_checkpoint(selas_simulation *simulation, enum checkpoint_keep keep)
{
    const char *folder;
    char *path = simulation_checkpoint_path(simulation);
    selas_status status =
        path != NULL ? SELAS_OK : fail(&simulation->messages, SELAS_NO_MEMORY, "no memory for a name");
    if (status == SELAS_OK && ranks_first(simulation->ranks))
        status = recorder_unfinished(simulation->recorder, &folder, &simulation->messages);
    status = ranks_agree(simulation->ranks, status, &simulation->messages);
    if (status == SELAS_OK)
        status = checkpoint_write(simulation->recorder, &simulation->state, &simulation->figures, path, keep,
                                  &simulation->messages);
    free(path);
    return status;
}
