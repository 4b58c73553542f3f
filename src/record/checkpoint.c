/* Checkpoints: the state and what the recorder has seen, in one HDF5 file under its own name only when
 * complete, on the disk, and read back.
 *
 * /y, /a: state; /trace_N_u, _v, _a: rows of receiver N, one a step; /profile_N and /seen_N: what the
 * profiles have; /due, /entry_group, /entry_time: snapshots so far (their files are snapshot_file.c's);
 * /watch and /before: the energy watch; /figures: step, time and so on (struct figures); /deck: the deck with
 * all defaults (a checkpoint goes on only with the very same scene), /source: the deck as it was read, /name.
 * Numbers have 64 bits: what is read back is what was written. The head is head.c's. */
#include "record/parts.h"

#include "base/memory.h"
#include "base/safe_file.h"
#include "record/checkpoint_head.h"
#include "record/kept.h"
#include "record/run_file.h"
#include "record/walk.h"

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

/* --- Writing --- */

enum { TEXTS = 4 };

struct text_piece {
    const char *name, *text;
};

/* Writes or compares everything; together. */
static bool walk_file(struct walk *walk, struct recorder *recorder, struct state *state,
                      const struct text_piece text[TEXTS], double figures[FIGURES])
{
    for (bool more = walk_begin(walk); more; more = walk_again(walk)) {
        walk_real(walk, "figures", 0, "", figures, FIGURES);
        walk_recorder(walk, recorder, state, (size_t)figures[STEP] + 1, (size_t)figures[ENTRIES]);
        for (size_t i = 0; i < TEXTS; i++)
            walk_text(walk, text[i].name, text[i].text);
    }
    return walk_good(walk);
}

/* Together. */
static selas_status write_checked(const char *temporary, struct recorder *recorder, struct state *state,
                                  double figures[FIGURES], const char *deck, struct messages *messages)
{
    const struct deck *source = recorder->scene->deck;
    const struct text_piece text[TEXTS] = {{"deck", deck},
                                           {"source", source != NULL ? deck_source(source) : ""},
                                           {"name", source != NULL ? deck_name(source) : ""},
                                           {"origin", source != NULL ? deck_origin(source) : ""}};
    struct ranks *ranks = recorder->scene->ranks;
    struct walk writing = {.ranks = ranks, .path = temporary, .mode = SET_WRITE, .head = CHECKPOINT_HEAD},
                reading = {.ranks = ranks, .path = temporary, .mode = SET_COMPARE};
    bool written = false, same = false;
#pragma omp critical(selas_hdf5)
    {
        const struct quiet quiet = quiet_begin();
        if (recorder->file != NULL) snapshot_files_sync(recorder);
        written = walk_file(&writing, recorder, state, text, figures);
        same = written && walk_file(&reading, recorder, state, text, figures);
        quiet_end(quiet);
    }
    if (!written) return walk_cannot(&writing, "write the checkpoint", messages);
    selas_status status = SELAS_OK;
    if (reading.failed && reading.error == ENOMEM)
        status = hdf_cannot("check the checkpoint", temporary, ENOMEM, messages);
    else if (reading.failed)
        status =
            fail(messages, SELAS_FILE_ERROR,
                 "the checkpoint '%s' does not read back as it was written (is the disk sound?)", temporary);
    else if (same)
        status = checkpoint_seal(temporary, ranks, messages);
    return ranks_agree(ranks, status, messages);
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
    struct ranks *ranks = recorder->scene->ranks;
    const uint64_t files = kept_sum(recorder->files);
    double figures[FIGURES] = {[STEP] = (double)state->step,
                               [TIME] = state->time,
                               [LAST_TIME] = recorder->last_time,
                               [BEFORE_TIME] = recorder->before_time,
                               [TIME_STEP] = recorder->stepper->dt,
                               [ENTRIES] = (double)recorder->entries,
                               [RECORDED] = recorder->recording ? 1.0 : 0.0,
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
    status = ranks_agree(ranks, status, messages);
    if (status != SELAS_OK || text == NULL || temporary == NULL) {
        free(text);
        free(temporary);
        return status;
    }
    snprintf(temporary, room, "%s.part", path);
    recorder_gather(recorder);
    status = write_checked(temporary, recorder, state, figures, text, messages);
    if (ranks_first(ranks)) {
        if (status != SELAS_OK) remove(temporary);
        if (status == SELAS_OK && keep != KEEP_NOTHING) keep_older(path, keep);
        if (status == SELAS_OK) status = safe_file_commit(temporary, path, messages);
    }
    free(text);
    free(temporary);
    return ranks_agree(ranks, status, messages);
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
    const uint64_t files = kept_sum(recorder->files);
    const double dt = recorder->stepper->dt;
    if (!is_count(figures[STEP], 9e15) || !is_count(figures[ENTRIES], 1e9) ||
        !is_count(figures[EVALUATIONS], 9e15))
        return "its step makes no sense";
    for (size_t k = 0; k < FIGURES; k++)
        if (!isfinite(figures[k])) return "its times make no sense";
    if (!(fabs(figures[TIME_STEP] - dt) <= 1e-9 * dt)) return "its time step is another one";
    if (figures[FILES_LOW] != (double)(files & UINT32_MAX) || figures[FILES_HIGH] != (double)(files >> 32))
        return "a file that its deck names (points, table or reference) has changed since, or the host gives "
               "other "
               "points or drives other loads";
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

/* Together: is something wrong with any rank? "" stands for what is wrong elsewhere. */
static const char *wrong_anywhere(const struct recorder *recorder, const char *wrong)
{
    double any = wrong != NULL ? 1.0 : 0.0;
    ranks_largest(recorder->scene->ranks, 1, &any);
    return wrong == NULL && any > 0.0 ? "" : wrong;
}

/* What the first rank finds before anything is read. */
static const char *look_at_file(hid_t file, const struct recorder *recorder, const char *text,
                                double figures[FIGURES])
{
    if (file < 0) return "it cannot be opened";
    if (!set_compare(file, "deck", H5T_NATIVE_CHAR, text, strlen(text) + 1)) return "it is of another scene";
    const hid_t set = set_open(file, "figures", H5T_NATIVE_DOUBLE, FIGURES, SET_READ);
    const bool good = set >= 0 && set_pass(set, H5T_NATIVE_DOUBLE, SET_READ, figures, 0, FIGURES);
    if (set >= 0) H5Dclose(set);
    const char *wrong = good ? misfit_of_figures(recorder, figures) : "it is damaged";
    return wrong == NULL && !rows_there(file, recorder, figures) ? "it is damaged" : wrong;
}

/* *error: the system's reason. */
static const char *read_all(const char *path, struct recorder *recorder, struct state *state,
                            const char *text, double figures[FIGURES], int *error, struct messages *messages)
{
    struct ranks *ranks = recorder->scene->ranks;
    struct walk walk = {.ranks = ranks, .path = path, .mode = SET_READ};
    const hid_t file = ranks_first(ranks) ? hdf_open_file(path) : -1;
    const char *wrong = ranks_first(ranks) ? look_at_file(file, recorder, text, figures) : NULL;
    if (wrong != NULL) *error = errno;
    if (file >= 0) H5Fclose(file);
    wrong = wrong_anywhere(recorder, wrong);
    if (wrong != NULL) return wrong;
    ranks_spread(ranks, 0, figures, FIGURES * sizeof *figures);
    wrong = make_room(recorder, figures, messages);
    if (wrong != NULL) *error = errno;
    wrong = wrong_anywhere(recorder, wrong);
    if (wrong != NULL) return wrong;
    for (bool more = walk_begin(&walk); more; more = walk_again(&walk))
        walk_recorder(&walk, recorder, state, (size_t)figures[STEP] + 1, (size_t)figures[ENTRIES]);
    if (walk.failed) wrong = walk.error != 0 ? strerror(walk.error) : "it is damaged";
    if (walk.failed) *error = walk.error;
    wrong = wrong_anywhere(recorder, wrong);
    if (wrong != NULL) return wrong;
    state->step = (unsigned long)figures[STEP];
    state->time = figures[TIME];
    recorder->last_step = state->step;
    recorder->last_time = figures[LAST_TIME];
    recorder->before_time = figures[BEFORE_TIME];
    recorder->entries = (size_t)figures[ENTRIES];
    model_computed(recorder->model)->evaluations = (unsigned long)figures[EVALUATIONS];
    recorder->started = true;
    for (size_t k = 0; wrong == NULL && recorder->file != NULL && ranks_first(ranks) && k < recorder->entries;
         k++)
        if (!snapshot_file_there(recorder, k, recorder->entry[k].time))
            wrong = "a file snapshot_NNNN.h5 that belongs beside it is missing or damaged";
    return wrong_anywhere(recorder, wrong);
}

/* Together. */
static const char *read_file(struct recorder *recorder, struct state *state, const char *path,
                             const char *text, double figures[FIGURES], int *error, struct messages *messages)
{
    const char *wrong;
#pragma omp critical(selas_hdf5)
    {
        const struct quiet quiet = quiet_begin();
        wrong = read_all(path, recorder, state, text, figures, error, messages);
        quiet_end(quiet);
    }
    return wrong;
}

selas_status checkpoint_read(struct recorder *recorder, struct state *state, struct run_figures *spent,
                             const char *path, struct messages *messages)
{
    struct ranks *ranks = recorder->scene->ranks;
    char *text = deck_echo(recorder->scene->deck, messages), why[200] = "",
         rounding[CHECKPOINT_ROUNDING] = "";
    const bool whole = checkpoint_whole(path, ranks, why, sizeof why, rounding);
    const char *wrong = text == NULL ? "there is no memory for its deck" : whole ? NULL : why;
    int error = text == NULL ? ENOMEM : 0;
    double figures[FIGURES] = {0};
    wrong = wrong_anywhere(recorder, wrong);
    if (wrong == NULL && strcmp(why, build_commit()) != 0)
        warn(messages,
             "the checkpoint '%s' was written by commit %s, this is %s: what follows may differ from what "
             "that program would have computed; to go on with that one would be right",
             path, why, build_commit());
    if (wrong == NULL && rounding[0] != '\0' && strcmp(rounding, checkpoint_rounding()) != 0)
        warn(messages,
             "the checkpoint '%s' was written on a processor with %s multiplication and addition, this run "
             "rounds "
             "otherwise: what follows differs in the last bits; %s would be right",
             path, strcmp(rounding, "plain") == 0 ? "separate" : "fused",
             strcmp(rounding, "plain") == 0 ? "SELAS_PROCESSOR=x86-64" : "a processor with AVX2 and FMA");
    if (wrong == NULL) wrong = read_file(recorder, state, path, text, figures, &error, messages);
    free(text);
    selas_status status = SELAS_OK;
    if (error == ENOMEM)
        status = hdf_cannot("read the checkpoint", path, error, messages);
    else if (wrong != NULL && wrong[0] != '\0')
        status = fail(messages, SELAS_FILE_ERROR, "the checkpoint '%s' cannot be used: %s", path, wrong);
    status = ranks_agree(ranks, status, messages);
    if (status != SELAS_OK) return status;
    spent->wall_seconds = figures[WALL_SECONDS];
    spent->cpu_seconds = figures[CPU_SECONDS];
    /* a snapshot of this very step that could not be written is still due */
    return recorder->recording ? snapshot_observe(recorder, state, messages) : SELAS_OK;
}
