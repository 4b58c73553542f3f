/* Snapshots while a run goes on: each is a file of its own in the folder `unfinished`, complete from the
 * moment it has its name, so that a run that is killed loses none and a restart finds them. When the run is
 * over they are gathered into run.h5.
 *
 * unfinished/snapshot_NNNN.h5: /snapshots/NNNN as in run.h5; unfinished/points.h5: /points. */
#include "record/run_file.h"

#include "base/safe_file.h"

#include <errno.h>
#include <fcntl.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

/* Positions of all points, in slabs: a lattice does not store them. */
static bool write_positions(hid_t place, const struct model *model)
{
    enum { ROWS = 512 };
    double slab[ROWS][3];
    const hsize_t size[2] = {model->points, 3};
    const hid_t space = H5Screate_simple(2, size, NULL);
    const hid_t set =
        H5Dcreate2(place, "position", H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    bool good = set >= 0;
    for (size_t first = 0; first < model->points && good; first += ROWS) {
        const size_t left = model->points - first, rows = left < ROWS ? left : ROWS;
        for (size_t i = 0; i < rows; i++)
            model_position(model, first + i, slab[i]);
        const hsize_t from[2] = {first, 0}, count[2] = {rows, 3};
        const hid_t memory = H5Screate_simple(2, count, NULL);
        good = H5Sselect_hyperslab(space, H5S_SELECT_SET, from, NULL, count, NULL) >= 0 &&
               H5Dwrite(set, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, slab) >= 0;
        H5Sclose(memory);
    }
    good = set >= 0 && H5Dclose(set) >= 0 && good;
    H5Sclose(space);
    return good;
}

/* Positions of the whole body and of each region, with the indices of its points. */
bool hdf_points(const struct recorder *recorder, hid_t file)
{
    const struct model *model = recorder->model;
    const hid_t points = hdf_group(file, "points");
    if (points < 0) return false;
    const double grid[3] = {(double)model->grid[0], (double)model->grid[1], (double)model->grid[2]};
    bool good = write_positions(points, model) && hdf_numbers(points, "lattice", 3, grid);
    for (size_t s = 0; s < recorder->scene->snapshots && good; s++) {
        const struct snapshot_record *record = &recorder->snapshot[s];
        if (record->index == NULL) continue;
        for (size_t i = 0; i < record->points; i++)
            model_position(model, record->index[i], record->buffer + 3 * i);
        char name[48];
        snprintf(name, sizeof name, "region_%zu", s + 1);
        const hid_t region = hdf_group(points, name);
        good =
            region >= 0 && hdf_table(region, "position", H5T_IEEE_F64LE, record->points, 3, record->buffer);
        for (size_t i = 0; i < record->points; i++)
            record->buffer[i] = (double)record->index[i];
        good = good && hdf_table(region, "index", H5T_STD_U64LE, record->points, 1, record->buffer);
        if (region >= 0) H5Gclose(region);
    }
    H5Gclose(points);
    return good;
}

static bool write_field(struct recorder *recorder, const struct snapshot_record *record, hid_t group,
                        selas_field field, const struct state *state)
{
    struct model *model = recorder->model;
    const size_t components = (size_t)field_components(field);
    double *value = record->buffer;
    state_settle(recorder->stepper, state, field == SELAS_ACCELERATION);
    model->core->field(model, field, state->y, state->a, value);
    for (size_t i = 0; record->index != NULL && i < record->points; i++) /* indices ascend: in place */
        memmove(value + components * i, value + components * record->index[i], components * sizeof *value);
    return hdf_table(group, field_name(field), H5T_IEEE_F32LE, record->points, components, value);
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

static bool write_group(struct recorder *recorder, const struct snapshot_record *record,
                        const struct state *state, hid_t group)
{
    bool good = write_marks(recorder, record, group, state->time, (double)state->step);
    for (int field = 0; field <= SELAS_ENERGY && good; field++)
        if ((record->snapshot->fields >> field & 1U) != 0)
            good = write_field(recorder, record, group, (selas_field)field, state);
    return good;
}

/* What goes into one file. */
struct content {
    struct recorder *recorder;
    const struct snapshot_record *record; /* NULL: the points */
    const struct state *state;
    size_t number;
};

static bool write_content(const struct content *content, hid_t file)
{
    if (content->record == NULL) return hdf_points(content->recorder, file);
    char name[24];
    snprintf(name, sizeof name, "%04zu", content->number);
    const hid_t all = hdf_group(file, "snapshots");
    const hid_t group = all >= 0 ? hdf_group(all, name) : -1;
    const bool good = group >= 0 && write_group(content->recorder, content->record, content->state, group);
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
    bool good = file >= 0 && write_content(content, file);
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

selas_status run_file_snapshot(struct recorder *recorder, const struct snapshot_record *record,
                               const struct state *state, size_t number, struct messages *messages)
{
    struct run_file *file = recorder->file;
    char name[40];
    selas_status status = SELAS_OK;
    if (!file->unfinished.made) {
        status = unfinished_make(&file->unfinished, messages);
        if (status == SELAS_OK)
            status = write_file(&(struct content){.recorder = recorder}, "points.h5", messages);
        file->unfinished.made = status == SELAS_OK;
    }
    if (status != SELAS_OK) return status;
    snprintf(name, sizeof name, "snapshot_%04zu.h5", number);
    if (file->synced > number) file->synced = number;
    return write_file(&(struct content){recorder, record, state, number}, name, messages);
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
    const hid_t set = H5Dopen2(part, name, H5P_DEFAULT);
    if (set < 0) return false;
    const hid_t space = H5Dget_space(set);
    const bool good =
        H5Sget_simple_extent_npoints(space) == (hssize_t)record->points * (hssize_t)components &&
        H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, record->buffer) >= 0;
    H5Sclose(space);
    H5Dclose(set);
    return good &&
           hdf_table(group, field_name(field), H5T_IEEE_F32LE, record->points, components, record->buffer);
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
