/* Checkpoints: the state and what the recorder has seen, in one HDF5 file under its own name only when
 * complete, on the disk, and read back.
 *
 * /y, /a: state; /trace_N_u, _v, _a: rows of receiver N, one a step; /profile_N and /seen_N: what the
 * profiles have; /due, /entry_group, /entry_time: snapshots so far (their files are snapshot_file.c's);
 * /watch and /before: the energy watch; /figures: step, time and so on (struct figures); /deck: the deck with
 * all defaults (a checkpoint goes on only with the very same scene), /source: the deck as it was read, /name.
 * Numbers have 64 bits: what is read back is what was written. The head is head.c's. */
#include "record/kept.h"

#include "base/memory.h"
#include "base/safe_file.h"
#include "record/checkpoint_head.h"
#include "record/run_file.h"
#include "record/sets.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* All that is no array, as one array. */
enum figure {
    STEP,
    TIME,
    LAST_TIME,
    BEFORE_TIME,
    TIME_STEP,
    ENTRIES,
    RECORDED, /* 1: with result files */
    EVALUATIONS,
    WALL_SECONDS,
    CPU_SECONDS,
    FILES_LOW, /* CRC of the files that the deck names, half and half */
    FILES_HIGH,
    FIGURES
};

/* One way through all arrays of a checkpoint. */
struct walk {
    hid_t file;
    enum { WALK_WRITE, WALK_READ, WALK_COMPARE } mode;
    bool good;
};

static void pass(struct walk *walk, const char *name, hid_t type, void *data, size_t count)
{
    if (count == 0 || !walk->good) return;
    if (walk->mode == WALK_WRITE)
        walk->good = set_write(walk->file, name, type, data, count);
    else if (walk->mode == WALK_READ)
        walk->good = set_read(walk->file, name, type, data, count);
    else
        walk->good = set_compare(walk->file, name, type, data, count);
}

static void pass_real(struct walk *walk, const char *name, size_t number, const char *ending, double *data,
                      size_t count)
{
    char full[48];
    snprintf(full, sizeof full, number > 0 ? "%s_%zu%s" : "%s", name, number, ending);
    pass(walk, full, H5T_NATIVE_DOUBLE, data, count);
}

/* --- The parts of the recorder --- */

static void pass_traces(struct walk *walk, struct recorder *recorder, size_t rows)
{
    for (size_t r = 0; r < recorder->scene->receivers; r++) {
        struct trace *trace = &recorder->trace[r];
        pass_real(walk, "trace", r + 1, "_u", trace->u, 3 * rows);
        pass_real(walk, "trace", r + 1, "_v", trace->v, 3 * rows);
        pass_real(walk, "trace", r + 1, "_a", trace->a, 3 * rows);
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
        pass_real(walk, "profile", p + 1, "", record->value,
                  times * record->profile->points * record->columns);
        pass(walk, seen, H5T_NATIVE_UCHAR, record->seen, times);
    }
}

/* Which snapshots there are; recorder->entry has room for them. */
static void pass_entries(struct walk *walk, struct recorder *recorder, size_t entries)
{
    const size_t groups = recorder->scene->snapshots;
    double *number = array_new(2 * entries + groups, sizeof *number);
    if (number == NULL) walk->good = false;
    if (number == NULL) return;
    double *group = number, *time = number + entries, *due = number + 2 * entries;
    for (size_t k = 0; k < entries; k++) {
        group[k] = (double)recorder->entry[k].group;
        time[k] = recorder->entry[k].time;
    }
    for (size_t s = 0; s < groups; s++)
        due[s] = (double)recorder->snapshot[s].due;
    pass_real(walk, "entry_group", 0, "", group, entries);
    pass_real(walk, "entry_time", 0, "", time, entries);
    pass_real(walk, "due", 0, "", due, groups);
    for (size_t k = 0; walk->mode == WALK_READ && walk->good && k < entries; k++) {
        walk->good = group[k] >= 0.0 && group[k] < (double)groups;
        if (walk->good) recorder->entry[k] = (struct snapshot_entry){(size_t)group[k], k, time[k]};
    }
    for (size_t s = 0; walk->mode == WALK_READ && walk->good && s < groups; s++) {
        walk->good = due[s] >= 0.0 && due[s] <= 1e15;
        if (walk->good) recorder->snapshot[s].due = (size_t)due[s];
    }
    array_free(number);
}

static void pass_all(struct walk *walk, struct recorder *recorder, struct state *state,
                     double figures[FIGURES])
{
    pass_real(walk, "y", 0, "", state->y, recorder->model->state_size);
    pass_real(walk, "a", 0, "", state->a, recorder->model->unknowns);
    if (recorder->stepper->one_pass) {
        size_t bytes = 0;
        struct model *model = recorder->stepper->model;
        void *kept = model->one_pass->kept(model, &bytes);
        pass(walk, "kept", H5T_NATIVE_UCHAR, kept, bytes);
    }
    const struct held *held = &recorder->stepper->held;
    if (held->count > 0) pass_real(walk, "held", 0, "", held->rest, held->count);
    pass(walk, "watch", H5T_NATIVE_DOUBLE, &recorder->watch, WATCH_NUMBERS);
    pass(walk, "before", H5T_NATIVE_DOUBLE, &recorder->before, WATCH_NUMBERS);
    pass_traces(walk, recorder, (size_t)figures[STEP] + 1);
    pass_profiles(walk, recorder);
    pass_entries(walk, recorder, (size_t)figures[ENTRIES]);
}

/* The same deck to the letter. */
static bool same_deck(hid_t file, const char *text)
{
    return set_compare(file, "deck", H5T_NATIVE_CHAR, text, strlen(text) + 1);
}

/* --- Writing --- */

struct text_piece {
    const char *name, *text;
};

/* Writes or compares everything. */
static bool walk_file(const char *path, struct recorder *recorder, struct state *state,
                      const struct text_piece text[3], double figures[FIGURES], bool write)
{
    struct walk walk = {.file = write ? hdf_create_file(path, CHECKPOINT_HEAD) : hdf_open_file(path),
                        .mode = write ? WALK_WRITE : WALK_COMPARE};
    if (walk.file < 0) return false;
    walk.good = true;
    pass_real(&walk, "figures", 0, "", figures, FIGURES);
    pass_all(&walk, recorder, state, figures);
    for (size_t i = 0; i < 3 && walk.good; i++) {
        const size_t size = strlen(text[i].text) + 1;
        walk.good = write ? set_write(walk.file, text[i].name, H5T_NATIVE_CHAR, text[i].text, size)
                          : set_compare(walk.file, text[i].name, H5T_NATIVE_CHAR, text[i].text, size);
    }
    return H5Fclose(walk.file) >= 0 && walk.good;
}

static selas_status write_checked(const char *temporary, struct recorder *recorder, struct state *state,
                                  double figures[FIGURES], const char *deck, struct messages *messages)
{
    const struct deck *source = recorder->scene->deck;
    const struct text_piece text[3] = {{"deck", deck},
                                       {"source", source != NULL ? deck_source(source) : ""},
                                       {"name", source != NULL ? deck_name(source) : ""}};
    bool written = false, same = false;
    int error = 0;
#pragma omp critical(selas_hdf5)
    {
        const struct quiet quiet = quiet_begin();
        if (recorder->file != NULL) snapshot_files_sync(recorder);
        errno = 0;
        written = walk_file(temporary, recorder, state, text, figures, true);
        error = errno;
        errno = 0;
        same = written && walk_file(temporary, recorder, state, text, figures, false);
        if (written) error = errno;
        quiet_end(quiet);
    }
    if (!written) return hdf_cannot("write the checkpoint", temporary, error, messages);
    if (!same && error == ENOMEM) return hdf_cannot("check the checkpoint", temporary, error, messages);
    if (!same)
        return fail(messages, SELAS_FILE_ERROR,
                    "the checkpoint '%s' does not read back as it was written (is the disk sound?)",
                    temporary);
    return checkpoint_seal(temporary, messages);
}

/* Gives a file a second name by way of a third, so that the second never is without a file (where the file
 * system has hard links). */
static void name_again(const char *path, const char *stem, int length, const char *ending)
{
    const size_t room = (size_t)length + 16;
    char *named = malloc(2 * room);
    if (named == NULL) return;
    char *linked = named + room;
    snprintf(named, room, "%.*s_%s.h5", length, stem, ending);
    snprintf(linked, room, "%.*s_link", length, stem);
    unlink(linked);
    if (link(path, linked) == 0 && rename(linked, named) != 0) unlink(linked);
    free(named);
}

static void keep_older(const char *path, enum checkpoint_keep keep)
{
    const size_t size = strlen(path);
    const int length = size > 3 && strcmp(path + size - 3, ".h5") == 0 ? (int)size - 3 : (int)size;
    char *before = keep == KEEP_LAST_AND_BEFORE ? malloc(size + 16) : NULL;
    if (before != NULL) {
        snprintf(before, size + 16, "%.*s_before.h5", length, path);
        name_again(before, path, length, "earlier");
    }
    free(before);
    name_again(path, path, length, "before");
}

selas_status checkpoint_write(struct recorder *recorder, struct state *state, const struct run_figures *spent,
                              const char *path, enum checkpoint_keep keep, struct messages *messages)
{
    uint64_t files = 0;
    if (!kept_files_checksum(recorder->scene, &files))
        return fail(messages, SELAS_NO_MEMORY, "no memory for a checkpoint");
    double figures[FIGURES] = {[STEP] = (double)state->step,
                               [TIME] = state->time,
                               [LAST_TIME] = recorder->last_time,
                               [BEFORE_TIME] = recorder->before_time,
                               [TIME_STEP] = recorder->stepper->dt,
                               [ENTRIES] = (double)recorder->entries,
                               [RECORDED] = recorder->file != NULL ? 1.0 : 0.0,
                               [EVALUATIONS] = (double)model_computed(recorder->model)->evaluations,
                               [WALL_SECONDS] = spent->wall_seconds,
                               [CPU_SECONDS] = spent->cpu_seconds,
                               [FILES_LOW] = (double)(files & UINT32_MAX),
                               [FILES_HIGH] = (double)(files >> 32)};
    char *text = deck_echo(recorder->scene->deck, messages);
    const size_t room = strlen(path) + 8;
    char *temporary = malloc(room);
    selas_status status = watch_sound(recorder, state, messages);
    if (status == SELAS_OK && (text == NULL || temporary == NULL))
        status = fail(messages, SELAS_NO_MEMORY, "no memory for a checkpoint");
    if (status != SELAS_OK || text == NULL || temporary == NULL) {
        free(text);
        free(temporary);
        return status;
    }
    snprintf(temporary, room, "%s.part", path);
    status = write_checked(temporary, recorder, state, figures, text, messages);
    if (status != SELAS_OK) remove(temporary);
    if (status == SELAS_OK && keep != KEEP_NOTHING) keep_older(path, keep);
    if (status == SELAS_OK) status = safe_file_commit(temporary, path, messages);
    free(text);
    free(temporary);
    return status;
}

/* --- Reading --- */

/* A count that a double holds exactly. */
static bool is_count(double figure, double below)
{
    return figure >= 0.0 && figure < below;
}

/* A reason why the checkpoint's own figures do not fit, or NULL. */
static const char *misfit_of_figures(const struct recorder *recorder, const double figures[FIGURES])
{
    uint64_t files = 0;
    const double dt = recorder->stepper->dt;
    if (!is_count(figures[STEP], 9e15) || !is_count(figures[ENTRIES], 1e9) ||
        !is_count(figures[EVALUATIONS], 9e15))
        return "its step makes no sense";
    for (size_t k = 0; k < FIGURES; k++)
        if (!isfinite(figures[k])) return "its times make no sense";
    if (!(fabs(figures[TIME_STEP] - dt) <= 1e-9 * dt)) return "its time step is another one";
    if (!kept_files_checksum(recorder->scene, &files)) return "there is no memory for its name";
    if (figures[FILES_LOW] != (double)(files & UINT32_MAX) || figures[FILES_HIGH] != (double)(files >> 32))
        return "a file that its deck names (points, table or reference) has changed since";
    if (recorder->file != NULL && recorder->scene->snapshots > 0 && figures[RECORDED] == 0.0)
        return "it was saved by a run without result files: its snapshots are not there";
    return NULL;
}

/* The file holds as many rows of histories and snapshots as its figures say (memory is taken for them). */
static bool rows_there(hid_t file, const struct recorder *recorder, const double figures[FIGURES])
{
    hsize_t size = 0;
    const double bytes =
        72.0 * (figures[STEP] + 1.0) * (double)recorder->scene->receivers + 16.0 * figures[ENTRIES];
    return H5Fget_filesize(file, &size) >= 0 && bytes <= (double)size;
}

static const char *make_room(struct recorder *recorder, const double figures[FIGURES],
                             struct messages *messages)
{
    const size_t entries = (size_t)figures[ENTRIES];
    if (entries > recorder->entry_room) {
        struct snapshot_entry *grown = realloc(recorder->entry, entries * sizeof *grown);
        if (grown == NULL) return "there is no memory for its list of snapshots";
        recorder->entry = grown;
        recorder->entry_room = entries;
    }
    if (entries > 0) memset(recorder->entry, 0, entries * sizeof *recorder->entry);
    if (trace_reserve(recorder, (size_t)figures[STEP] + 1, messages) != SELAS_OK)
        return "there is no memory for its histories";
    return NULL;
}

static const char *read_all(hid_t file, struct recorder *recorder, struct state *state, const char *text,
                            double figures[FIGURES], struct messages *messages)
{
    if (!same_deck(file, text)) return "it is of another scene";
    if (!set_read(file, "figures", H5T_NATIVE_DOUBLE, figures, FIGURES)) return "it is damaged";
    const char *wrong = misfit_of_figures(recorder, figures);
    if (wrong == NULL && !rows_there(file, recorder, figures)) wrong = "it is damaged";
    if (wrong == NULL) wrong = make_room(recorder, figures, messages);
    if (wrong != NULL) return wrong;
    struct walk walk = {file, WALK_READ, true};
    pass_all(&walk, recorder, state, figures);
    if (!walk.good) return "it is damaged";
    state->step = (unsigned long)figures[STEP];
    state->time = figures[TIME];
    recorder->last_step = state->step;
    recorder->last_time = figures[LAST_TIME];
    recorder->before_time = figures[BEFORE_TIME];
    recorder->entries = (size_t)figures[ENTRIES];
    model_computed(recorder->model)->evaluations = (unsigned long)figures[EVALUATIONS];
    recorder->started = true;
    for (size_t k = 0; recorder->file != NULL && k < recorder->entries; k++)
        if (!snapshot_file_there(recorder, k, recorder->entry[k].time))
            return "a file snapshot_NNNN.h5 that belongs beside it is missing or damaged";
    return NULL;
}

selas_status checkpoint_read(struct recorder *recorder, struct state *state, struct run_figures *spent,
                             const char *path, struct messages *messages)
{
    char *text = deck_echo(recorder->scene->deck, messages), why[200] = "";
    const char *wrong = why;
    int error = 0;
    double figures[FIGURES] = {0};
    if (text == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for a checkpoint");
    if (checkpoint_whole(path, why, sizeof why)) {
#pragma omp critical(selas_hdf5)
        {
            const struct quiet quiet = quiet_begin();
            const hid_t file = hdf_open_file(path);
            wrong = "it cannot be opened";
            if (file >= 0) {
                wrong = read_all(file, recorder, state, text, figures, messages);
                error = wrong != NULL ? errno : 0;
                H5Fclose(file);
            }
            quiet_end(quiet);
        }
    }
    free(text);
    if (error == ENOMEM) return hdf_cannot("read the checkpoint", path, error, messages);
    if (wrong != NULL)
        return fail(messages, SELAS_FILE_ERROR, "the checkpoint '%s' cannot be used: %s", path, wrong);
    spent->wall_seconds = figures[WALL_SECONDS];
    spent->cpu_seconds = figures[CPU_SECONDS];
    /* a snapshot of this very step that could not be written is still due */
    return recorder->file != NULL ? snapshot_observe(recorder, state, messages) : SELAS_OK;
}
