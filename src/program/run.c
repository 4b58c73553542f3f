/* A run of the program (see the header).
 *
 * Checkpoints go to `unfinished/checkpoint.h5` in the folder of the results: before the first step and every
 * output%checkpoint_every steps, every output%checkpoint_minutes minutes, on a signal, and when the results
 * cannot be written. One that cannot be written is told once and the run goes on with the one before. */
#include "program/run.h"

#include "advice/advice.h"
#include "base/clock.h"
#include "base/progress.h"
#include "host/simulation.h"
#include "parallel/ranks.h"
#include "program/signals.h"

#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* The watch finds what goes wrong within so many steps: a checkpoint older than that is good. At least one of
 * the last three is: the older two are kept so. */
enum { WATCHED = 100, KEPT = 3 };
static const char *const kept_name[KEPT] = {"", "_before", "_earlier"};

struct saved {
    bool any;
    unsigned long step;
    double time;
};

struct run {
    selas_simulation *simulation;
    bool quiet;
    size_t *told;
    char *path;               /* of the checkpoint */
    struct saved saved[KEPT]; /* the last one, the one before, and one earlier */
    bool complained;
    double next_moment; /* by the clock, seconds */
};

void tell_messages(const selas_simulation *simulation, size_t *told)
{
    if (simulation != NULL && !ranks_first(simulation->ranks)) return;
    const char *text = simulation != NULL ? selas_message(simulation) : "error: no memory\n";
    const size_t length = strlen(text);
    if (length > *told) fputs(text + *told, stderr);
    *told = length;
}

void print_line(void *context, const char *key, const char *value)
{
    if (context != NULL) fprintf(context, "%s: %s\n", key, value);
}

static void print_text(void *context, const char *text)
{
    fputs(text, context);
    fflush(context);
}

/* --- Checkpoints --- */

static double minutes_between(const struct run *run)
{
    return run->simulation->scene->output.checkpoint_minutes;
}

/* What becomes of the last ones when the next is written at `step`: NAME_before.h5 is to be WATCHED steps
 * old, or NAME_earlier.h5. */
static enum checkpoint_keep keep_at(const struct run *run, unsigned long step)
{
    const struct saved *last = &run->saved[0], *before = &run->saved[1];
    if (!last->any || last->step == step) return KEEP_NOTHING;
    if (!before->any || step - last->step >= WATCHED) return KEEP_LAST;
    return last->step - before->step >= WATCHED ? KEEP_LAST_AND_BEFORE : KEEP_NOTHING;
}

static selas_status save(struct run *run)
{
    const struct saved now = {true, selas_steps(run->simulation), selas_time(run->simulation)};
    const enum checkpoint_keep keep = keep_at(run, now.step);
    const selas_status status = simulation_checkpoint(run->simulation, keep);
    run->next_moment = wall_seconds() + 60.0 * minutes_between(run);
    if (status != SELAS_OK) return status;
    if (keep == KEEP_LAST_AND_BEFORE) run->saved[2] = run->saved[1];
    if (keep != KEEP_NOTHING) run->saved[1] = run->saved[0];
    run->saved[0] = now;
    return status;
}

static bool due(const struct run *run)
{
    const long every = run->simulation->scene->output.checkpoint_every;
    if (every > 0 && selas_steps(run->simulation) % (unsigned long)every == 0) return true;
    return minutes_between(run) > 0.0 && wall_seconds() >= run->next_moment;
}

/* A run is worth more than one of its checkpoints. */
static selas_status save_on_the_way(struct run *run)
{
    const selas_status status = save(run);
    if (status == SELAS_OK || status == SELAS_UNSTABLE) return status;
    if (!run->complained && ranks_first(run->simulation->ranks)) {
        tell_messages(run->simulation, run->told);
        fprintf(stderr, "warning: the run goes on without this checkpoint\n");
    }
    *run->told = strlen(selas_message(run->simulation));
    run->complained = true;
    return SELAS_OK;
}

/* Where to go on after a failure that has left no new checkpoint. */
static void tell_last(const struct run *run, bool unstable)
{
    const unsigned long now = selas_steps(run->simulation);
    int good = 0;
    while (unstable && good < KEPT && run->saved[good].any && run->saved[good].step + WATCHED > now)
        good++;
    if (!run->saved[0].any) {
        if (now > 0) fprintf(stderr, "there is no checkpoint of this run\n");
        return;
    }
    bool touched = good == KEPT || !run->saved[good].any;
    if (touched) good--;                             /* all are young: the oldest */
    if (run->saved[good].step == 0) touched = false; /* nothing had begun */
    fprintf(stderr, "the last %s checkpoint is that of step %lu, t = %.6g%s: selas restart %.*s%s.h5\n",
            touched ? "known" : "good", run->saved[good].step, run->saved[good].time,
            touched ? ", which may be touched already" : "", (int)strlen(run->path) - 3, run->path,
            kept_name[good]);
}

/* The run ends here, its state is kept. */
static void keep_state(struct run *run, const char *why)
{
    const unsigned long step = selas_steps(run->simulation);
    const selas_status status = save(run);
    tell_messages(run->simulation, run->told);
    if (!ranks_first(run->simulation->ranks)) return;
    if (status == SELAS_OK)
        fprintf(stderr, "%s at step %lu, t = %.6g; the state is kept, go on with: selas restart %s\n", why,
                step, selas_time(run->simulation), run->path);
    else
        fprintf(stderr, "%s at step %lu, t = %.6g; the state could not be kept\n", why, step,
                selas_time(run->simulation));
    if (status != SELAS_OK) tell_last(run, false);
}

/* What the receivers have seen, for who cannot wait for the end. */
static void leave_histories(struct run *run)
{
    selas_simulation *simulation = run->simulation;
    const selas_status status = recorder_write_so_far(simulation->recorder, &simulation->messages);
    tell_messages(simulation, run->told);
    if (status == SELAS_OK && simulation->scene->receivers > 0 && ranks_first(simulation->ranks))
        fprintf(stderr, "the histories so far are in %.*s\n",
                (int)(strlen(run->path) - strlen("checkpoint.h5")), run->path);
}

/* --- Stepping --- */

/* What is to be done after a step: what any rank is told to, or the clock of any. */
struct wishes {
    bool stop, save;
};

static struct wishes wishes_of(const struct run *run, bool stepped)
{
    double wish[2] = {signals_stop() != NULL ? 1.0 : 0.0,
                      stepped && (signals_save() || due(run)) ? 1.0 : 0.0};
    ranks_largest(run->simulation->ranks, 2, wish);
    return (struct wishes){wish[0] > 0.0, wish[1] > 0.0};
}

static selas_status step_on(struct run *run, struct progress *progress, unsigned long needed)
{
    selas_simulation *simulation = run->simulation;
    selas_status status = SELAS_OK;
    struct wishes wishes = wishes_of(run, false);
    while (status == SELAS_OK && selas_steps(simulation) < needed && !wishes.stop) {
        status = selas_step(simulation, 1);
        if (status == SELAS_OK) wishes = wishes_of(run, true);
        if (status == SELAS_OK && wishes.save) status = save_on_the_way(run);
        if (!run->quiet) progress_update(progress, selas_time(simulation), selas_steps(simulation));
    }
    return status;
}

static selas_status begin(struct run *run, const char *from)
{
    selas_simulation *simulation = run->simulation;
    simulation->advised = true; /* by the program */
    selas_status status = selas_record(simulation);
    if (status == SELAS_OK && from != NULL) status = selas_restore(simulation, from);
    if (status == SELAS_OK) status = selas_step(simulation, 0); /* builds everything; says what cannot be */
    if (status != SELAS_OK) return status;
    run->path = simulation_checkpoint_path(simulation);
    run->next_moment = wall_seconds() + 60.0 * minutes_between(run);
    run->saved[0] = (struct saved){from != NULL, selas_steps(simulation), selas_time(simulation)};
    if (from == NULL && simulation->scene->output.checkpoint_every > 0) status = save_on_the_way(run);
    return run->path != NULL ? status : SELAS_NO_MEMORY;
}

static selas_status run_with_progress(struct run *run, const char *from)
{
    struct progress progress;
    selas_simulation *simulation = run->simulation;
    selas_status status = begin(run, from);
    if (status != SELAS_OK) return status;
    const unsigned long needed = selas_steps_needed(simulation);
    tell_messages(simulation, run->told);
    if (from == NULL)
        advice_tell(simulation->scene, simulation->stepper, print_line, run->quiet ? NULL : stderr);
    signals_catch();
    progress_start(&progress, selas_end_time(simulation), isatty(STDERR_FILENO) != 0, print_text, stderr);
    status = step_on(run, &progress, needed);
    const bool stopped = status == SELAS_OK && selas_steps(simulation) < needed;
    if (!run->quiet)
        progress_finish(&progress, selas_time(simulation), selas_steps(simulation),
                        status == SELAS_OK && !stopped);
    if (stopped) {
        char why[48];
        const char *signal = signals_stop();
        snprintf(why, sizeof why, "stopped by %s", signal != NULL ? signal : "a signal to another rank");
        keep_state(run, why);
        leave_histories(run);
        return SELAS_STOPPED;
    }
    if (status == SELAS_FILE_ERROR) {
        keep_state(run, "stopped");
    } else if (status != SELAS_OK) {
        tell_messages(simulation, run->told);
        if (ranks_first(simulation->ranks)) tell_last(run, status == SELAS_UNSTABLE);
    }
    return status;
}

selas_status run_program(selas_simulation *simulation, const char *from, bool quiet, size_t *told)
{
    quiet = quiet || !ranks_first(simulation->ranks);
    struct run run = {.simulation = simulation, .quiet = quiet, .told = told};
    selas_status status = run_with_progress(&run, from);
    if (status == SELAS_OK) {
        status = selas_write(simulation);
        if (status == SELAS_FILE_ERROR || status == SELAS_NO_MEMORY)
            keep_state(&run, "the results could not be written");
    }
    if (status == SELAS_OK && !quiet) {
        recorder_summary(simulation->recorder, &simulation->figures, stdout);
        printf("results in %s/\n", selas_output_directory(simulation));
    }
    free(run.path);
    return status;
}
