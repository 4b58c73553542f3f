/* The recorder: what a run leaves, gathered step by step and written at the end. */
#include "record/kept.h"
#include "record/results.h"
#include "record/watch.h"

#include "base/memory.h"
#include "base/safe_file.h"
#include "parallel/few_ranks.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

selas_status recorder_create(const struct scene *scene, struct model *model, const struct stepper *stepper,
                             struct recorder **created, struct messages *messages)
{
    *created = NULL;
    struct recorder *recorder = calloc(1, sizeof *recorder);
    if (recorder == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the record");
    recorder->scene = scene;
    recorder->model = model;
    recorder->stepper = stepper;
    recorder->folder = scene->output.directory;
    selas_status status = trace_create(recorder, messages);
    if (status == SELAS_OK) status = profile_create(recorder, messages);
    if (status == SELAS_OK) status = snapshot_create(recorder, messages);
    if (status != SELAS_OK) {
        recorder_free(&recorder);
        return status;
    }
    watch_start(recorder);
    recorder->before =
        recorder->watch; /* a checkpoint has the numbers of both, but not what this makes anew */
    status = hindsight_create(recorder, messages);
    if (status != SELAS_OK) {
        recorder_free(&recorder);
        return status;
    }
    *created = recorder;
    return SELAS_OK;
}

selas_status recorder_keep_files(struct recorder *recorder, struct messages *messages)
{
    free(recorder->files);
    recorder->files = kept_files(recorder->scene);
    const bool good = recorder->files != NULL;
    const bool same = ranks_same(recorder->scene->ranks, good ? kept_sum(recorder->files) : 0);
    if (!good) return fail(messages, SELAS_NO_MEMORY, "no memory for the names of the deck's files");
    if (same) return SELAS_OK;
    return fail(messages, SELAS_FILE_ERROR, "ranks have read different files that the deck names");
}

static selas_status claim_folder(const struct recorder *recorder, struct messages *messages)
{
    selas_status status = make_folder(recorder->scene->output.directory, messages);
    if (status != SELAS_OK) return status;
    char *names = results_names(recorder->scene, recorder, false);
    status = results_claim(recorder->scene, names, messages);
    free(names);
    return status;
}

/* The first rank has made it. */
static selas_status see_folder(const char *folder, struct messages *messages)
{
    if (access(folder, W_OK | X_OK) == 0) return SELAS_OK;
    return fail(messages, SELAS_FILE_ERROR, "cannot write into the folder '%s': %s", folder, strerror(errno));
}

selas_status recorder_open(struct recorder *recorder, const char *work, struct messages *messages)
{
    recorder->recording = true;
    struct ranks *ranks = recorder->scene->ranks;
    const char *folder = recorder->scene->output.directory;
    if (recorder->file != NULL) return SELAS_OK;
    selas_status status = ranks_first(ranks) ? claim_folder(recorder, messages) : SELAS_OK;
    status = ranks_agree(ranks, status, messages);
    if (status == SELAS_OK) status = ranks_agree(ranks, see_folder(folder, messages), messages);
    return status == SELAS_OK ? run_file_open(recorder, work, messages) : status;
}

/* Does anybody but receivers look at the velocities of this step? Their finished histories the scheme corrects. */
static bool looked_at(const struct recorder *recorder, const struct state *state)
{
    const bool powers = recorder->scene->loads > 0 || recorder->model->damped || recorder->watch.with_faces;
    return powers || !((double)state->step < recorder->watch.next) || profile_due(recorder, state->step) ||
           snapshot_due(recorder, state);
}

/* Returns whether it did, for hide(). */
static bool show(const struct recorder *recorder, const struct state *state)
{
    const bool shown = looked_at(recorder, state);
    if (shown) state_show(recorder->stepper, state, true);
    return shown;
}

static void hide(const struct recorder *recorder, const struct state *state, bool shown)
{
    if (shown) state_show(recorder->stepper, state, false);
}

/* Profiles, and then the watch, which may settle the state. */
static selas_status look(struct recorder *recorder, const struct state *state, struct messages *messages)
{
    profile_observe(recorder, state);
    return watch_observe(recorder, state, messages);
}

static selas_status keep(struct recorder *recorder, const struct state *state, struct messages *messages)
{
    const selas_status status = look(recorder, state, messages);
    if (status != SELAS_OK) return status;
    recorder->started = true;
    recorder->last_step = state->step;
    recorder->last_time = state->time;
    return recorder->recording ? snapshot_observe(recorder, state, messages) : SELAS_OK;
}

static selas_status keep_again(struct recorder *recorder, const struct state *state,
                               struct messages *messages)
{
    const selas_status status = look(recorder, state, messages);
    recorder->started = true;
    recorder->last_time = state->time;
    return status == SELAS_OK && recorder->recording ? snapshot_observe_again(recorder, state, messages)
                                                     : status;
}

selas_status recorder_observe(struct recorder *recorder, const struct state *state, struct messages *messages)
{
    if (recorder->started && state->step != recorder->last_step + 1)
        return fail(messages, SELAS_BAD_ARGUMENT, "the record has step %lu and was given step %lu",
                    recorder->last_step, state->step);
    recorder->before = recorder->watch;
    recorder->before_time = recorder->last_time;
    selas_status status = trace_observe(recorder, state, messages);
    if (status != SELAS_OK) return status;
    const bool shown = show(recorder, state);
    status = keep(recorder, state, messages);
    hide(recorder, state, shown);
    return status;
}

void recorder_forget(struct recorder *recorder, const struct state *state)
{
    if (recorder->finished) return;
    trace_forget(recorder);
    const bool shown = show(recorder, state);
    profile_forget(recorder, state);
    hide(recorder, state, shown);
    recorder->watch = recorder->before;
    recorder->last_time = recorder->before_time;
    recorder->started = state->step > 0;
}

selas_status recorder_observe_again(struct recorder *recorder, const struct state *state,
                                    struct messages *messages)
{
    if (recorder->finished) return SELAS_OK;
    selas_status status = trace_observe(recorder, state, messages);
    if (status != SELAS_OK) return status;
    const bool shown = show(recorder, state);
    status = keep_again(recorder, state, messages);
    hide(recorder, state, shown);
    return status;
}

bool recorder_gather(struct recorder *recorder)
{
    profile_gather(recorder);
    trace_gather(recorder);
    return ranks_first(recorder->scene->ranks);
}

selas_status recorder_finish(struct recorder *recorder, struct messages *messages)
{
    if (recorder->finished) return SELAS_OK;
    const selas_status status = recorder_gather(recorder) ? trace_finish(recorder, messages) : SELAS_OK;
    recorder->finished = status == SELAS_OK;
    return status;
}

struct history_rows recorder_history(const struct recorder *recorder, size_t receiver)
{
    return (struct history_rows){recorder->rows, recorder->time, recorder->trace[receiver].value};
}

/* What the scheme's velocities lack of its order, at one place. */
static void add_shown(const struct recorder *recorder, const struct probe *probe, const struct state *state,
                      double value[3])
{
    const struct scheme_class *scheme = recorder->stepper->scheme;
    const double *of[3];
    double part[3];
    if (scheme->shown == NULL) return;
    scheme->shown(recorder->stepper, state, of, part);
    for (int k = 0; k < 3; k++) {
        double rate[6] = {0};
        model_observe(recorder->model, probe, SELAS_ACCELERATION, state->y, of[k], rate);
        for (int c = 0; c < 3; c++)
            value[c] += part[k] * rate[c];
    }
}

void recorder_value(struct recorder *recorder, size_t receiver, selas_field field, const struct state *state,
                    double *value)
{
    const struct probe *probe = &recorder->trace[receiver].probe;
    struct ranks *ranks = recorder->scene->ranks;
    const bool energy = field == SELAS_ENERGY;
    if (energy) state_show(recorder->stepper, state, true);
    if (probe->holder == ranks_me(ranks)) {
        model_observe(recorder->model, probe, field, state->y, state->a, value);
        if (field == SELAS_VELOCITY) add_shown(recorder, probe, state, value);
    }
    if (energy) state_show(recorder->stepper, state, false);
    ranks_spread(ranks, probe->holder, value, (size_t)field_components(field) * sizeof *value);
}

selas_status recorder_write_so_far(struct recorder *recorder, struct messages *messages)
{
    const char *results = recorder->folder;
    if (!recorder_gather(recorder)) return SELAS_OK;
    selas_status status = recorder_unfinished(recorder, &recorder->folder, messages);
    recorder->so_far = true;
    if (status == SELAS_OK) status = trace_finish(recorder, messages);
    if (status == SELAS_OK) status = histories_write(recorder, messages);
    if (status == SELAS_OK) status = profile_write(recorder, messages);
    if (status == SELAS_OK && recorder->scene->output.plots) plot_histories(recorder, messages);
    trace_unfinish(recorder);
    recorder->so_far = false;
    recorder->folder = results;
    return status;
}

static selas_status write_deck(const struct recorder *recorder, struct messages *messages)
{
    const struct scene *scene = recorder->scene;
    if (scene->deck == NULL) return SELAS_OK;
    struct safe_file file;
    selas_status status = safe_file_open(scene->output.directory, "deck.nml", &file, messages);
    if (status != SELAS_OK) return status;
    if (scene_driven(scene))
        fprintf(file.file,
                "! A host drove loads or faces (report.txt): by itself this deck is another run.\n");
    status = deck_write(scene->deck, file.file, messages);
    return safe_file_close(&file, status, messages);
}

static selas_status write_texts(struct recorder *recorder, const char *names, struct messages *messages)
{
    selas_status status = results_list(recorder->scene, names, messages);
    if (status == SELAS_OK) status = write_deck(recorder, messages);
    if (status == SELAS_OK) status = histories_write(recorder, messages);
    return status == SELAS_OK ? profile_write(recorder, messages) : status;
}

/* What comes behind run.h5. */
static selas_status write_rest(struct recorder *recorder, const char *names, struct exact *exact,
                               const struct run_figures *figures, struct messages *messages)
{
    selas_status status = xdmf_write(recorder, messages);
    if (status == SELAS_OK) status = report_write(recorder, exact, figures, messages);
    return status == SELAS_OK ? results_tidy(recorder->scene, names, messages) : status;
}

/* Together: all but the pictures. */
static selas_status write_all(struct recorder *recorder, struct exact *exact,
                              const struct run_figures *figures, struct messages *messages)
{
    struct ranks *ranks = recorder->scene->ranks;
    const bool first = ranks_first(ranks);
    char *names = first ? results_names(recorder->scene, recorder, true) : NULL;
    selas_status status = first ? write_texts(recorder, names, messages) : SELAS_OK;
    status = ranks_agree(ranks, status, messages);
    if (status == SELAS_OK) status = run_file_finish(recorder, figures, messages);
    if (status == SELAS_OK && first) status = write_rest(recorder, names, exact, figures, messages);
    free(names);
    return ranks_agree(ranks, status, messages);
}

selas_status recorder_write(struct recorder *recorder, struct exact *exact, const struct run_figures *figures,
                            struct messages *messages)
{
    if (recorder->written) return SELAS_OK;
    struct ranks *ranks = recorder->scene->ranks;
    selas_status status = ranks_agree(ranks, recorder_open(recorder, NULL, messages), messages);
    if (status == SELAS_OK) status = ranks_agree(ranks, recorder_finish(recorder, messages), messages);
    if (status != SELAS_OK) return status;
    /* what was computed is written, whether there is something to compare it with or not */
    const selas_status compared = exact != NULL ? histories_compare(recorder, exact, messages) : SELAS_OK;
    status = write_all(recorder, compared == SELAS_OK ? exact : NULL, figures, messages);
    if (status != SELAS_OK) return status;
    if (recorder->scene->output.plots && ranks_first(ranks)) {
        plot_histories(recorder, messages);
        plot_snapshots(recorder, messages);
        plot_damping(recorder, messages);
        if (plots_ground(recorder->scene)) plot_ground(recorder->scene, messages);
    }
    run_file_close(recorder, true);
    recorder->written = true;
    return compared;
}

void recorder_free(struct recorder **freed)
{
    if (freed == NULL || *freed == NULL) return;
    struct recorder *recorder = *freed;
    run_file_close(recorder, false);
    trace_free(recorder);
    hindsight_free(recorder);
    profile_free(recorder);
    snapshot_free(recorder);
    array_free(recorder->time);
    array_free(recorder->exact);
    free(recorder->entry);
    free(recorder->files);
    free(recorder);
    *freed = NULL;
}
