/* Snapshots while a run goes on: each is a file of its own in the folder `unfinished`, complete from the
 * moment it has its name, so that a run that is killed loses none and a restart finds them. When the run is
 * over they are gathered into run.h5. Ranks write each file together (walk.h).
 *
 * unfinished/snapshot_NNNN.h5: /snapshots/NNNN as in run.h5; unfinished/points.h5: /points. */
#include "record/run_file.h"

#include "base/safe_file.h"
#include "parallel/ranks.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Points that are listed. */
struct list {
    const struct model *model;
    const struct snapshot_record *record; /* NULL: all */
};

static size_t listed(const struct list *list, size_t row)
{
    return list->record != NULL ? snapshot_point(list->model, list->record, row) : row;
}

static void give_position(const struct list *list, size_t row, double *value)
{
    model_position(list->model, listed(list, row), value);
}

static void give_index(const struct list *list, size_t row, double *value)
{
    *value = (double)listed(list, row);
}

static void give_number(const struct list *list, size_t row, double *value)
{
    *value = list->model->number[row];
}

/* A table, some rows at a time: a lattice does not store its points. */
static void write_list(struct walk *walk, const char *name, hid_t type, size_t rows, size_t columns,
                       const struct list *list,
                       void (*give)(const struct list *list, size_t row, double *value))
{
    enum { ROWS = 512, COLUMNS = 3 };
    double slab[ROWS * COLUMNS];
    const hid_t set = walk_table(walk, name, type, rows, columns);
    size_t first, end;
    walk_share(walk, rows, &first, &end);
    for (; set >= 0 && !walk->failed && first < end; first += ROWS) {
        const size_t count = end - first < ROWS ? end - first : ROWS;
        for (size_t i = 0; i < count; i++)
            give(list, first + i, slab + columns * i);
        walk_rows(walk, set, first, count, columns, slab);
    }
    walk_close(walk, set);
}

static void make_group(struct walk *walk, const char *name)
{
    const hid_t group = walk_group(walk, name);
    if (group >= 0) H5Gclose(group);
}

static void write_region(struct walk *walk, const struct list *list, size_t number, size_t points)
{
    char region[48], name[64];
    snprintf(region, sizeof region, "/points/region_%zu", number);
    make_group(walk, region);
    snprintf(name, sizeof name, "%s/position", region);
    write_list(walk, name, H5T_IEEE_F64LE, points, 3, list, give_position);
    snprintf(name, sizeof name, "%s/index", region);
    write_list(walk, name, H5T_STD_U64LE, points, 1, list, give_index);
}

/* Positions of the whole body and of each region, with the indices of its points. */
void hdf_points(const struct recorder *recorder, struct walk *walk)
{
    const struct model *model = recorder->model;
    const struct list all = {.model = model};
    const double grid[3] = {(double)model->grid[0], (double)model->grid[1], (double)model->grid[2]};
    const hid_t points = walk_group(walk, "/points");
    if (points >= 0) {
        walk_note(walk, hdf_numbers(points, "lattice", 3, grid));
        H5Gclose(points);
    }
    write_list(walk, "/points/position", H5T_IEEE_F64LE, model->points, 3, &all, give_position);
    if (model->number != NULL)
        write_list(walk, "/points/number", H5T_STD_U64LE, model->points, 1, &all, give_number);
    for (size_t s = 0; s < recorder->scene->snapshots; s++) {
        const struct snapshot_record *record = &recorder->snapshot[s];
        const struct list some = {model, record};
        if (!record->snapshot->whole) write_region(walk, &some, s + 1, record->points);
    }
}

/* How many of the points from .. end - 1 the record shows; `row`: rows shown before them. */
static size_t rows_of(const struct model *model, const struct snapshot_record *record, size_t row,
                      size_t from, size_t end)
{
    size_t rows = 0;
    if (record->snapshot->whole) return end - from;
    while (row + rows < record->points && snapshot_point(model, record, row + rows) < end)
        rows++;
    return rows;
}

/* What the record shows of a piece of the body moves to the head of the buffer. */
static void pick_rows(const struct model *model, const struct snapshot_record *record, size_t components,
                      size_t row, size_t rows, size_t from)
{
    for (size_t i = 0; !record->snapshot->whole && i < rows; i++)
        memmove(record->buffer + components * i,
                record->buffer + components * (snapshot_point(model, record, row + i) - from),
                components * sizeof *record->buffer);
}

/* Piece by piece, each by the rank that holds it. */
static void pass_field(struct recorder *recorder, const struct snapshot_record *record, selas_field field,
                       const struct state *state, struct walk *walk, hid_t set)
{
    struct model *model = recorder->model;
    const size_t components = (size_t)field_components(field);
    const int me = ranks_me(walk->ranks);
    int holder;
    for (size_t from = 0, row = 0, rows, end; from < model->points; from = end, row += rows) {
        end = snapshot_piece(model, from, &holder);
        rows = rows_of(model, record, row, from, end);
        if (holder != me || rows == 0 || walk->failed) continue;
        model->core->field(model, field, state->y, state->a, from, end, record->buffer);
        pick_rows(model, record, components, row, rows, from);
        for (size_t i = 0; i < components * rows; i++)
            recorder->shown[field] = fmax(recorder->shown[field], fabs(record->buffer[i]));
        walk_rows(walk, set, row, rows, components, record->buffer);
    }
}

static void write_fields(struct recorder *recorder, const struct snapshot_record *record,
                         const struct state *state, const char *inside, struct walk *walk)
{
    const bool all = walk->together || ranks_count(walk->ranks) == 1;
    char name[80];
    if (all) model_complete(recorder->model, state->y, state->a);
    for (int f = 0; f <= SELAS_ENERGY; f++) {
        const selas_field field = (selas_field)f;
        if ((record->snapshot->fields >> f & 1U) == 0) continue;
        snprintf(name, sizeof name, "%s/%s", inside, field_name(field));
        const hid_t set =
            walk_table(walk, name, H5T_IEEE_F32LE, record->points, (size_t)field_components(field));
        if (all) state_settle(recorder->stepper, state, field == SELAS_ACCELERATION);
        if (set >= 0) pass_field(recorder, record, field, state, walk, set);
        if (all) ranks_largest(walk->ranks, 1, &recorder->shown[field]);
        walk_close(walk, set);
    }
}

/* What a snapshot says of itself. */
static bool write_marks(const struct recorder *recorder, const struct snapshot_record *record, hid_t group,
                        double time, double step)
{
    const double occurrence = (double)(record - recorder->snapshot) + 1.0;
    return hdf_numbers(group, "time", 1, &time) && hdf_numbers(group, "step", 1, &step) &&
           hdf_numbers(group, "group", 1, &occurrence) && hdf_text(group, "position", record->position) &&
           (!recorder->stepper->unwarp ||
            hdf_text(group, "note", "keeps the time error of the scheme, which only receivers lose"));
}

/* The group of a snapshot, with its marks. */
static void make_marked(const struct recorder *recorder, const struct snapshot_record *record,
                        struct walk *walk, const char *inside, double time, double step)
{
    const hid_t group = walk_group(walk, inside);
    if (group < 0) return;
    walk_note(walk, write_marks(recorder, record, group, time, step));
    H5Gclose(group);
}

/* What goes into one file. */
struct content {
    struct recorder *recorder;
    const struct snapshot_record *record; /* NULL: the points */
    const struct state *state;
    size_t number;
};

static void write_content(const struct content *content, struct walk *walk)
{
    struct recorder *recorder = content->recorder;
    const struct state *state = content->state;
    char inside[48];
    if (content->record == NULL) {
        hdf_points(recorder, walk);
        return;
    }
    snprintf(inside, sizeof inside, "/snapshots/%04zu", content->number);
    make_group(walk, "/snapshots");
    make_marked(recorder, content->record, walk, inside, state->time, (double)state->step);
    write_fields(recorder, content->record, state, inside, walk);
}

/* Together. */
static selas_status write_named(const struct content *content, const char *path, const char *temporary,
                                struct messages *messages)
{
    struct ranks *ranks = content->recorder->scene->ranks;
    struct walk walk = {.ranks = ranks, .path = temporary, .named = path, .mode = SET_WRITE};
#pragma omp critical(selas_hdf5)
    {
        const struct quiet quiet = quiet_begin();
        for (bool more = walk_begin(&walk); more; more = walk_again(&walk))
            write_content(content, &walk);
        if (walk_good(&walk) && ranks_first(ranks)) walk_note(&walk, rename(temporary, path) == 0);
        quiet_end(quiet);
    }
    if (walk_good(&walk)) return SELAS_OK;
    if (ranks_first(ranks)) remove(temporary);
    return walk_cannot(&walk, "write", messages);
}

/* Together. */
static selas_status write_file(const struct content *content, const char *name, struct messages *messages)
{
    char *path = NULL, *temporary = NULL;
    selas_status status =
        safe_file_names(content->recorder->file->unfinished.path, name, &path, &temporary, messages);
    status = ranks_agree(content->recorder->scene->ranks, status, messages);
    if (status == SELAS_OK) status = write_named(content, path, temporary, messages);
    free(path);
    free(temporary);
    return status;
}

static void file_of(const struct recorder *recorder, size_t number, char *path, size_t size)
{
    snprintf(path, size, "%s/snapshot_%04zu.h5", recorder->file->unfinished.path, number);
}

/* Together: the folder, and the points in it. */
static selas_status make_unfinished(struct recorder *recorder, struct messages *messages)
{
    struct unfinished *unfinished = &recorder->file->unfinished;
    struct ranks *ranks = recorder->scene->ranks;
    bool made = unfinished->made;
    ranks_spread(ranks, 0, &made, sizeof made);
    if (made) return SELAS_OK;
    selas_status status = ranks_first(ranks) ? unfinished_make(unfinished, messages) : SELAS_OK;
    status = ranks_agree(ranks, status, messages);
    if (status == SELAS_OK)
        status = write_file(&(struct content){.recorder = recorder}, "points.h5", messages);
    unfinished->made = status == SELAS_OK;
    return status;
}

selas_status run_file_snapshot(struct recorder *recorder, const struct snapshot_record *record,
                               const struct state *state, size_t number, struct messages *messages)
{
    const struct content content = {recorder, record, state, number};
    char name[40];
    snprintf(name, sizeof name, "snapshot_%04zu.h5", number);
    const selas_status status = make_unfinished(recorder, messages);
    if (status != SELAS_OK) return status;
    if (recorder->file->synced > number) recorder->file->synced = number;
    return write_file(&content, name, messages);
}

/* The number that an attribute of a snapshot holds; NaN if there is none. */
static double mark_of(hid_t file, const char *inside, const char *name)
{
    double number = NAN;
    const hid_t attribute = H5Aopen_by_name(file, inside, name, H5P_DEFAULT, H5P_DEFAULT);
    if (attribute < 0) return number;
    if (H5Aread(attribute, H5T_NATIVE_DOUBLE, &number) < 0) number = NAN;
    H5Aclose(attribute);
    return number;
}

/* This rank's share. */
static void copy_rows(const struct snapshot_record *record, hid_t from, size_t components, struct walk *walk,
                      hid_t to)
{
    size_t row, end;
    walk_share(walk, record->points, &row, &end);
    for (size_t rows; row < end && !walk->failed; row += rows) {
        rows = end - row < record->room ? end - row : record->room;
        walk_note(walk, hdf_rows_pass(from, false, row, rows, components, record->buffer));
        walk_rows(walk, to, row, rows, components, record->buffer);
    }
}

static bool has_numbers(hid_t set, size_t numbers)
{
    const hid_t space = H5Dget_space(set);
    const bool right = H5Sget_simple_extent_npoints(space) == (hssize_t)numbers;
    H5Sclose(space);
    return right;
}

/* part: the file of the snapshot, negative: none. */
static void copy_field(const struct snapshot_record *record, hid_t part, const char *name, size_t components,
                       struct walk *walk)
{
    const hid_t to = walk_table(walk, name, H5T_IEEE_F32LE, record->points, components);
    const hid_t from = part >= 0 && to >= 0 ? H5Dopen2(part, name, H5P_DEFAULT) : -1;
    if (to >= 0) walk_note(walk, from >= 0 && has_numbers(from, record->points * components));
    if (from >= 0) copy_rows(record, from, components, walk, to);
    if (from >= 0) H5Dclose(from);
    walk_close(walk, to);
}

/* Read and written by hand: H5Ocopy of HDF5 1.10 crashes when the disk is full. */
static void gather_one(const struct recorder *recorder, const struct snapshot_entry *entry, const char *path,
                       struct walk *walk)
{
    const struct snapshot_record *record = &recorder->snapshot[entry->group];
    const bool looks = walk->together || walk_makes(walk);
    char inside[48], name[80];
    snprintf(inside, sizeof inside, "/snapshots/%04zu", entry->number);
    const hid_t part = looks ? hdf_open_file(path) : -1;
    walk_note(walk, !looks || part >= 0);
    make_marked(recorder, record, walk, inside, mark_of(part, inside, "time"), mark_of(part, inside, "step"));
    for (int field = 0; field <= SELAS_ENERGY; field++) {
        if ((record->snapshot->fields >> field & 1U) == 0) continue;
        snprintf(name, sizeof name, "%s/%s", inside, field_name((selas_field)field));
        copy_field(record, part, name, (size_t)field_components((selas_field)field), walk);
    }
    if (part >= 0) H5Fclose(part);
}

void snapshots_gather(const struct recorder *recorder, struct walk *walk)
{
    const size_t size = strlen(recorder->file->unfinished.path) + 48;
    char *path = malloc(size);
    walk_note(walk, path != NULL);
    const bool good = walk_good(walk) && path != NULL;
    make_group(walk, "/snapshots");
    for (size_t k = 0; good && k < recorder->entries; k++) {
        file_of(recorder, k, path, size);
        gather_one(recorder, &recorder->entry[k], path, walk);
    }
    free(path);
}

bool snapshot_file_there(const struct recorder *recorder, size_t number, double time)
{
    const size_t size = strlen(recorder->file->unfinished.path) + 48;
    char *path = malloc(size), inside[48];
    if (path == NULL) return false;
    file_of(recorder, number, path, size);
    snprintf(inside, sizeof inside, "/snapshots/%04zu", number);
    double shown = NAN;
    const hid_t part = hdf_open_file(path);
    const hid_t attribute = part >= 0 ? H5Aopen_by_name(part, inside, "time", H5P_DEFAULT, H5P_DEFAULT) : -1;
    if (attribute >= 0) {
        if (H5Aread(attribute, H5T_NATIVE_DOUBLE, &shown) < 0) shown = NAN;
        H5Aclose(attribute);
    }
    if (part >= 0) H5Fclose(part);
    free(path);
    return shown == time;
}

void snapshot_files_sync(const struct recorder *recorder)
{
    const size_t size = strlen(recorder->file->unfinished.path) + 48;
    char *path = malloc(size);
    for (size_t k = recorder->file->synced; path != NULL && k < recorder->entries; k++) {
        file_of(recorder, k, path, size);
        const int handle = open(path, O_RDONLY | O_CLOEXEC);
        if (handle < 0) continue;
        fsync(handle);
        close(handle);
    }
    if (path != NULL) recorder->file->synced = recorder->entries;
    free(path);
}
