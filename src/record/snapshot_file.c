/* Snapshots while a run goes on: each is a file of its own in the folder `unfinished`, complete from the
 * moment it has its name, so that a run that is killed loses none and a restart finds them. When the run is
 * over they are gathered into run.h5.
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
    const size_t *index; /* NULL: all */
};

static size_t listed(const struct list *list, size_t row)
{
    return list->index != NULL ? list->index[row] : row;
}

static void give_position(const struct list *list, size_t row, double *value)
{
    model_position(list->model, listed(list, row), value);
}

static void give_index(const struct list *list, size_t row, double *value)
{
    *value = (double)listed(list, row);
}

/* A table, some rows at a time: a lattice does not store its points. */
static bool write_list(hid_t place, const char *name, hid_t type, size_t rows, size_t columns,
                       const struct list *list,
                       void (*give)(const struct list *list, size_t row, double *value))
{
    enum { ROWS = 512, COLUMNS = 3 };
    double slab[ROWS * COLUMNS];
    const hid_t set = hdf_rows(place, name, type, rows, columns);
    bool good = set >= 0;
    for (size_t first = 0; first < rows && good; first += ROWS) {
        const size_t count = rows - first < ROWS ? rows - first : ROWS;
        for (size_t i = 0; i < count; i++)
            give(list, first + i, slab + columns * i);
        good = hdf_rows_pass(set, true, first, count, columns, slab);
    }
    return set >= 0 && H5Dclose(set) >= 0 && good;
}

/* Positions of the whole body and of each region, with the indices of its points. */
bool hdf_points(const struct recorder *recorder, hid_t file)
{
    const struct model *model = recorder->model;
    const struct list all = {.model = model};
    const hid_t points = hdf_group(file, "points");
    if (points < 0) return false;
    const double grid[3] = {(double)model->grid[0], (double)model->grid[1], (double)model->grid[2]};
    bool good = write_list(points, "position", H5T_IEEE_F64LE, model->points, 3, &all, give_position) &&
                hdf_numbers(points, "lattice", 3, grid);
    for (size_t s = 0; s < recorder->scene->snapshots && good; s++) {
        const struct snapshot_record *record = &recorder->snapshot[s];
        const struct list some = {model, record->index};
        if (record->index == NULL) continue;
        char name[48];
        snprintf(name, sizeof name, "region_%zu", s + 1);
        const hid_t region = hdf_group(points, name);
        good = region >= 0 &&
               write_list(region, "position", H5T_IEEE_F64LE, record->points, 3, &some, give_position) &&
               write_list(region, "index", H5T_STD_U64LE, record->points, 1, &some, give_index);
        if (region >= 0) H5Gclose(region);
    }
    H5Gclose(points);
    return good;
}

/* What the record shows of a piece of the body moves to the head of the buffer; `row`: rows shown so far. */
static size_t pick_rows(const struct snapshot_record *record, size_t components, size_t row, size_t from,
                        size_t end)
{
    size_t rows = 0;
    if (record->index == NULL) return end - from;
    for (; row + rows < record->points && record->index[row + rows] < end; rows++)
        memmove(record->buffer + components * rows,
                record->buffer + components * (record->index[row + rows] - from),
                components * sizeof *record->buffer);
    return rows;
}

/* Together: a field goes piece by piece to the first rank, and from there into the set, if there is one. */
static bool pass_field(struct recorder *recorder, const struct snapshot_record *record, selas_field field,
                       const struct state *state, hid_t set)
{
    struct model *model = recorder->model;
    struct ranks *ranks = recorder->scene->ranks;
    const size_t components = (size_t)field_components(field);
    bool good = set >= 0;
    int holder;
    state_settle(recorder->stepper, state, field == SELAS_ACCELERATION);
    for (size_t from = 0, row = 0, rows, end; from < model->points; from = end, row += rows) {
        end = snapshot_piece(model, from, &holder);
        if (holder == ranks_me(ranks))
            model->core->field(model, field, state->y, state->a, from, end, record->buffer);
        rows = pick_rows(record, components, row, from, end);
        ranks_fetch(ranks, holder, record->buffer, rows * components * sizeof *record->buffer);
        good = good && hdf_rows_pass(set, true, row, rows, components, record->buffer);
    }
    return good;
}

/* Together; group: of the first rank. */
static bool write_fields(struct recorder *recorder, const struct snapshot_record *record,
                         const struct state *state, hid_t group)
{
    bool good = true;
    model_complete(recorder->model, state->y, state->a);
    for (int f = 0; f <= SELAS_ENERGY; f++) {
        const selas_field field = (selas_field)f;
        const size_t components = (size_t)field_components(field);
        if ((record->snapshot->fields >> f & 1U) == 0) continue;
        const hid_t set = group >= 0 && good
                              ? hdf_rows(group, field_name(field), H5T_IEEE_F32LE, record->points, components)
                              : -1;
        good = pass_field(recorder, record, field, state, set) && good;
        if (set >= 0) good = H5Dclose(set) >= 0 && good;
    }
    return good;
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

/* What goes into one file. */
struct content {
    struct recorder *recorder;
    const struct snapshot_record *record; /* NULL: the points */
    const struct state *state;
    size_t number;
};

/* Together, but for the points; file: of the first rank. */
static bool write_content(const struct content *content, hid_t file)
{
    struct recorder *recorder = content->recorder;
    const struct snapshot_record *record = content->record;
    if (record == NULL) return file >= 0 && hdf_points(recorder, file);
    char name[24];
    snprintf(name, sizeof name, "%04zu", content->number);
    const hid_t all = file >= 0 ? hdf_group(file, "snapshots") : -1;
    const hid_t group = all >= 0 ? hdf_group(all, name) : -1;
    bool good = group >= 0 &&
                write_marks(recorder, record, group, content->state->time, (double)content->state->step);
    ranks_spread(recorder->scene->ranks, 0, &good, sizeof good);
    good = good && write_fields(recorder, record, content->state, group);
    if (group >= 0) H5Gclose(group);
    if (all >= 0) H5Gclose(all);
    return good;
}

static selas_status write_file(const struct content *content, const char *name, struct messages *messages)
{
    char *path = NULL, *temporary = NULL;
    selas_status status =
        safe_file_names(content->recorder->file->unfinished.path, name, &path, &temporary, messages);
    if (status != SELAS_OK) return status;
    const struct quiet quiet = quiet_begin();
    const hid_t file = hdf_create_file(temporary, 0);
    bool good = write_content(content, file);
    if (file >= 0) good = H5Fclose(file) >= 0 && good;
    good = good && rename(temporary, path) == 0;
    const int error = errno;
    quiet_end(quiet);
    if (!good) {
        remove(temporary);
        status = hdf_cannot("write", path, error, messages);
    }
    free(path);
    free(temporary);
    return status;
}

static void file_of(const struct recorder *recorder, size_t number, char *path, size_t size)
{
    snprintf(path, size, "%s/snapshot_%04zu.h5", recorder->file->unfinished.path, number);
}

/* The folder, and the points in it. */
static selas_status make_unfinished(struct recorder *recorder, struct messages *messages)
{
    struct run_file *file = recorder->file;
    if (file->unfinished.made) return SELAS_OK;
    selas_status status = unfinished_make(&file->unfinished, messages);
    if (status == SELAS_OK)
        status = write_file(&(struct content){.recorder = recorder}, "points.h5", messages);
    file->unfinished.made = status == SELAS_OK;
    return status;
}

selas_status run_file_snapshot(struct recorder *recorder, const struct snapshot_record *record,
                               const struct state *state, size_t number, struct messages *messages)
{
    struct ranks *ranks = recorder->scene->ranks;
    const struct content content = {recorder, record, state, number};
    const bool first = ranks_first(ranks);
    char name[40];
    snprintf(name, sizeof name, "snapshot_%04zu.h5", number);
    selas_status status = first ? make_unfinished(recorder, messages) : SELAS_OK;
    status = ranks_agree(ranks, status, messages);
    if (status != SELAS_OK) return status;
    if (!first) write_content(&content, -1);
    if (first && recorder->file->synced > number) recorder->file->synced = number;
    if (first) status = write_file(&content, name, messages);
    return ranks_agree(ranks, status, messages);
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

static bool copy_field(const struct snapshot_record *record, hid_t part, const char *inside,
                       selas_field field, hid_t group)
{
    char name[80];
    const size_t components = (size_t)field_components(field);
    snprintf(name, sizeof name, "%s/%s", inside, field_name(field));
    const hid_t from = H5Dopen2(part, name, H5P_DEFAULT);
    if (from < 0) return false;
    const hid_t space = H5Dget_space(from);
    const hid_t to = hdf_rows(group, field_name(field), H5T_IEEE_F32LE, record->points, components);
    bool good =
        to >= 0 && H5Sget_simple_extent_npoints(space) == (hssize_t)record->points * (hssize_t)components;
    for (size_t row = 0; good && row < record->points; row += record->room) {
        const size_t left = record->points - row, rows = left < record->room ? left : record->room;
        good = hdf_rows_pass(from, false, row, rows, components, record->buffer) &&
               hdf_rows_pass(to, true, row, rows, components, record->buffer);
    }
    if (to >= 0) good = H5Dclose(to) >= 0 && good;
    H5Sclose(space);
    H5Dclose(from);
    return good;
}

/* Read and written by hand: H5Ocopy of HDF5 1.10 crashes when the disk is full. */
static bool gather_one(const struct recorder *recorder, const struct snapshot_entry *entry, const char *path,
                       hid_t all)
{
    const struct snapshot_record *record = &recorder->snapshot[entry->group];
    char inside[48];
    snprintf(inside, sizeof inside, "/snapshots/%04zu", entry->number);
    const hid_t part = hdf_open_file(path);
    if (part < 0) return false;
    const hid_t group = hdf_group(all, strrchr(inside, '/') + 1);
    bool good = group >= 0 && write_marks(recorder, record, group, mark_of(part, inside, "time"),
                                          mark_of(part, inside, "step"));
    for (int field = 0; field <= SELAS_ENERGY && good; field++)
        if ((record->snapshot->fields >> field & 1U) != 0)
            good = copy_field(record, part, inside, (selas_field)field, group);
    if (group >= 0) H5Gclose(group);
    H5Fclose(part);
    return good;
}

bool snapshots_gather(const struct recorder *recorder, hid_t file)
{
    const hid_t group = hdf_group(file, "snapshots");
    const size_t size = strlen(recorder->file->unfinished.path) + 48;
    char *path = malloc(size);
    bool good = group >= 0 && path != NULL;
    for (size_t k = 0; k < recorder->entries && good; k++) {
        file_of(recorder, k, path, size);
        good = gather_one(recorder, &recorder->entry[k], path, group);
    }
    free(path);
    if (group >= 0) H5Gclose(group);
    return good;
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
