/* All that a checkpoint keeps of a run but its figures and its deck (checkpoint.c says under what names). */
#include "record/walk.h"

#include "base/memory.h"
#include "record/parts.h"

#include <errno.h>

static void pass_traces(struct walk *walk, struct recorder *recorder, size_t rows)
{
    for (size_t r = 0; r < recorder->scene->receivers; r++) {
        struct trace *trace = &recorder->trace[r];
        walk_real(walk, "trace", r + 1, "_u", trace->u, 3 * rows);
        walk_real(walk, "trace", r + 1, "_v", trace->v, 3 * rows);
        walk_real(walk, "trace", r + 1, "_a", trace->a, 3 * rows);
        trace->rows = rows;
    }
}

static void pass_profiles(struct walk *walk, struct recorder *recorder)
{
    for (size_t p = 0; p < recorder->scene->profiles; p++) {
        struct profile_record *record = &recorder->profile[p];
        const size_t times = record->profile->times;
        char seen[32];
        snprintf(seen, sizeof seen, "seen_%zu", p + 1);
        walk_real(walk, "profile", p + 1, "", record->value,
                  times * record->profile->points * record->columns);
        walk_pass(walk, seen, H5T_NATIVE_UCHAR, record->seen, times);
    }
}

/* Which snapshots there are; recorder->entry has room for them. */
static void pass_entries(struct walk *walk, struct recorder *recorder, size_t entries)
{
    const size_t groups = recorder->scene->snapshots;
    double *number = array_new(2 * entries + groups, sizeof *number);
    double missing = number == NULL ? 1.0 : 0.0;
    ranks_largest(walk->ranks, 1, &missing);
    if (missing > 0.0 || number == NULL) {
        if (number == NULL) walk->error = ENOMEM;
        array_free(number);
        walk->failed = true;
        return;
    }
    double *group = number, *time = number + entries, *due = number + 2 * entries;
    for (size_t k = 0; k < entries; k++) {
        group[k] = (double)recorder->entry[k].group;
        time[k] = recorder->entry[k].time;
    }
    for (size_t s = 0; s < groups; s++)
        due[s] = (double)recorder->snapshot[s].due;
    walk_real(walk, "entry_group", 0, "", group, entries);
    walk_real(walk, "entry_time", 0, "", time, entries);
    walk_real(walk, "due", 0, "", due, groups);
    for (size_t k = 0; walk->mode == SET_READ && !walk->failed && k < entries; k++) {
        walk->failed = !(group[k] >= 0.0 && group[k] < (double)groups);
        if (!walk->failed) recorder->entry[k] = (struct snapshot_entry){(size_t)group[k], k, time[k]};
    }
    for (size_t s = 0; walk->mode == SET_READ && !walk->failed && s < groups; s++) {
        walk->failed = !(due[s] >= 0.0 && due[s] <= 1e15);
        if (!walk->failed) recorder->snapshot[s].due = (size_t)due[s];
    }
    array_free(number);
}

/* The state, the accelerations and what steps in one pass keep, which ranks share. */
static void pass_state(struct walk *walk, const struct recorder *recorder, struct state *state)
{
    struct model *model = model_computed(recorder->model);
    const bool shared = ranks_count(walk->ranks) > 1 && model->core->share != NULL;
    struct spread shares = {0};
    if (walk->mode == SET_WRITE && !walk->together) model_complete(model, state->y, state->a);
    if (shared) model->core->share(model, ARRAY_UNKNOWNS, &shares);
    walk_shared(walk, "a", H5T_NATIVE_DOUBLE, 1, state->a, model->unknowns, shared ? &shares : NULL);
    for (size_t k = 0; recorder->stepper->scheme->keeps && k < 2; k++)
        walk_shared(walk, k == 0 ? "a_even" : "a_odd", H5T_NATIVE_DOUBLE, 1,
                    recorder->stepper->work[1] + k * model->unknowns, model->unknowns,
                    shared ? &shares : NULL);
    if (shared) model->core->share(model, ARRAY_UNKNOWNS, &shares);
    if (shared) model->core->share(model, ARRAY_EXTRA, &shares);
    walk_shared(walk, "y", H5T_NATIVE_DOUBLE, 1, state->y, model->state_size, shared ? &shares : NULL);
    if (!recorder->stepper->one_pass) return;
    size_t bytes = 0;
    void *kept = model->one_pass->kept(model, &bytes);
    shares.runs = shares.here = shares.there = 0;
    if (shared) model->one_pass->share(model, &shares);
    walk_shared(walk, "kept", H5T_NATIVE_UCHAR, shared ? bytes / shares.here : 1, kept,
                shared ? shares.here : bytes, shared ? &shares : NULL);
}

void walk_recorder(struct walk *walk, struct recorder *recorder, struct state *state, size_t rows,
                   size_t entries)
{
    const struct held *held = &recorder->stepper->held;
    pass_state(walk, recorder, state);
    if (held->count > 0) walk_real(walk, "held", 0, "", held->rest, held->count);
    walk_pass(walk, "watch", H5T_NATIVE_DOUBLE, &recorder->watch, WATCH_NUMBERS);
    walk_pass(walk, "before", H5T_NATIVE_DOUBLE, &recorder->before, WATCH_NUMBERS);
    pass_traces(walk, recorder, rows);
    pass_profiles(walk, recorder);
    pass_entries(walk, recorder, entries);
}
