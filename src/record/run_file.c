/* run.h5: histories, snapshots, every setting of the deck, and where the run comes from.
 *
 * /histories/NAME [rows x 7], /histories/NAME_exact; /points/position [points x 3]; /snapshots/NNNN/FIELD
 * [points x components] (single precision; attributes time, step, group); /settings/GROUP_N attributes;
 * /provenance attributes. The file has a temporary name until it is complete. */
#include "record/run_file.h"

#include "record/safe_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

struct quiet quiet_begin(void)
{
    struct quiet quiet = {0};
    H5Eget_auto2(H5E_DEFAULT, &quiet.function, &quiet.data);
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    return quiet;
}

void quiet_end(struct quiet quiet)
{
    H5Eset_auto2(H5E_DEFAULT, quiet.function, quiet.data);
}

static selas_status cannot_write(const struct recorder *recorder, struct messages *messages)
{
    return fail(messages, SELAS_FILE_ERROR, "cannot write '%s' (is the disk full?)", recorder->file->path);
}

bool hdf_text(hid_t place, const char *name, const char *text)
{
    const hid_t type = H5Tcopy(H5T_C_S1);
    H5Tset_size(type, strlen(text) + 1);
    const hid_t space = H5Screate(H5S_SCALAR);
    const hid_t attribute = H5Acreate2(place, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    const bool good = attribute >= 0 && H5Awrite(attribute, type, text) >= 0;
    if (attribute >= 0) H5Aclose(attribute);
    H5Sclose(space);
    H5Tclose(type);
    return good;
}

bool hdf_numbers(hid_t place, const char *name, size_t count, const double *value)
{
    const hsize_t size = count;
    const hid_t space = count == 1 ? H5Screate(H5S_SCALAR) : H5Screate_simple(1, &size, NULL);
    const hid_t attribute = H5Acreate2(place, name, H5T_IEEE_F64LE, space, H5P_DEFAULT, H5P_DEFAULT);
    const bool good = attribute >= 0 && H5Awrite(attribute, H5T_NATIVE_DOUBLE, value) >= 0;
    if (attribute >= 0) H5Aclose(attribute);
    H5Sclose(space);
    return good;
}

bool hdf_table(hid_t place, const char *name, hid_t type, size_t rows, size_t columns, const double *value)
{
    const hsize_t size[2] = {rows, columns};
    const hid_t space = H5Screate_simple(2, size, NULL);
    const hid_t set = H5Dcreate2(place, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    const bool good = set >= 0 && H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) >= 0;
    const bool closed = set >= 0 && H5Dclose(set) >= 0;
    H5Sclose(space);
    return good && closed;
}

hid_t hdf_group(hid_t place, const char *name)
{
    return H5Gcreate2(place, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
}

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
static bool write_points(const struct recorder *recorder, hid_t file)
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

selas_status run_file_open(struct recorder *recorder, struct messages *messages)
{
    struct run_file *file = calloc(1, sizeof *file);
    if (file == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for run.h5");
    selas_status status =
        safe_file_names(recorder->scene->output.directory, "run.h5", &file->path, &file->temporary, messages);
    if (status != SELAS_OK) {
        free(file);
        return status;
    }
    recorder->file = file;
    const struct quiet quiet = quiet_begin();
    file->file = H5Fcreate(file->temporary, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    bool good = file->file >= 0;
    if (good) {
        file->snapshots = hdf_group(file->file, "snapshots");
        good = file->snapshots >= 0 && write_points(recorder, file->file) &&
               H5Fflush(file->file, H5F_SCOPE_LOCAL) >= 0;
    } else {
        file->snapshots = -1;
    }
    quiet_end(quiet);
    return good ? SELAS_OK : cannot_write(recorder, messages);
}

static bool write_field(struct recorder *recorder, const struct snapshot_record *record, hid_t group,
                        selas_field field, const struct state *state)
{
    struct model *model = recorder->model;
    const size_t components = (size_t)field_components(field);
    double *value = record->buffer;
    model->class->field(model, field, state->y, state->a, value);
    for (size_t i = 0; record->index != NULL && i < record->points; i++) /* indices ascend: in place */
        memmove(value + components * i, value + components * record->index[i], components * sizeof *value);
    return hdf_table(group, field_name(field), H5T_IEEE_F32LE, record->points, components, value);
}

selas_status run_file_snapshot(struct recorder *recorder, const struct snapshot_record *record,
                               const struct state *state, size_t number, struct messages *messages)
{
    char name[24];
    snprintf(name, sizeof name, "%04zu", number);
    const struct quiet quiet = quiet_begin();
    const hid_t group = hdf_group(recorder->file->snapshots, name);
    const double step = (double)state->step;
    const double occurrence = (double)(record - recorder->snapshot) + 1.0;
    bool good = group >= 0 && hdf_numbers(group, "time", 1, &state->time) &&
                hdf_numbers(group, "step", 1, &step) && hdf_numbers(group, "group", 1, &occurrence) &&
                hdf_text(group, "position", record->position) &&
                (!recorder->stepper->unwarp ||
                 hdf_text(group, "note", "keeps the time error of the scheme, which only receivers lose"));
    for (int field = 0; field <= SELAS_ENERGY && good; field++)
        if ((record->snapshot->fields >> field & 1U) != 0)
            good = write_field(recorder, record, group, (selas_field)field, state);
    if (group >= 0) H5Gclose(group);
    good = good && H5Fflush(recorder->file->file, H5F_SCOPE_LOCAL) >= 0;
    quiet_end(quiet);
    return good ? SELAS_OK : cannot_write(recorder, messages);
}

static bool write_histories(const struct recorder *recorder, hid_t file)
{
    const hid_t group = hdf_group(file, "histories");
    double *table = malloc((recorder->rows * 7 + 1) * sizeof *table);
    bool good = group >= 0 && table != NULL && hdf_text(group, "columns", "t ux uy uz vx vy vz");
    for (size_t r = 0; r < recorder->scene->receivers && good; r++) {
        const double *const part[2] = {recorder->trace[r].value,
                                       recorder->exact != NULL ? recorder->exact + r * recorder->rows * 6
                                                               : NULL};
        for (int k = 0; k < 2 && good && part[k] != NULL; k++) {
            for (size_t i = 0; i < recorder->rows; i++) {
                table[7 * i] = recorder->time[i];
                memcpy(table + 7 * i + 1, part[k] + 6 * i, 6 * sizeof *table);
            }
            char name[NAME_SIZE + 16];
            file_name_of(recorder->scene->receiver[r].name, k == 0 ? "" : "_exact", name, sizeof name);
            good = hdf_table(group, name, H5T_IEEE_F64LE, recorder->rows, 7, table);
            const hid_t set = good ? H5Dopen2(group, name, H5P_DEFAULT) : -1;
            good = set >= 0 && hdf_numbers(set, "position", 3, recorder->scene->receiver[r].position);
            if (set >= 0) H5Dclose(set);
        }
    }
    free(table);
    if (group >= 0) H5Gclose(group);
    return good;
}

static bool close_file(struct run_file *file)
{
    bool good = true;
    if (file->snapshots >= 0) H5Gclose(file->snapshots);
    if (file->file >= 0) good = H5Fclose(file->file) >= 0;
    file->snapshots = file->file = -1;
    return good;
}

selas_status run_file_finish(struct recorder *recorder, const struct run_figures *figures,
                             struct messages *messages)
{
    struct run_file *file = recorder->file;
    const struct quiet quiet = quiet_begin();
    bool good = write_histories(recorder, file->file) &&
                write_provenance(recorder, file->file, figures, messages) &&
                H5Fflush(file->file, H5F_SCOPE_LOCAL) >= 0;
    good = close_file(file) && good;
    quiet_end(quiet);
    if (!good) return cannot_write(recorder, messages);
    const selas_status status = safe_file_commit(file->temporary, file->path, messages);
    file->complete = status == SELAS_OK;
    return status;
}

void run_file_discard(struct recorder *recorder)
{
    struct run_file *file = recorder->file;
    if (file == NULL) return;
    const struct quiet quiet = quiet_begin();
    close_file(file);
    quiet_end(quiet);
    if (!file->complete) remove(file->temporary);
    free(file->path);
    free(file->temporary);
    free(file);
    recorder->file = NULL;
}

selas_status run_file_read(const struct recorder *recorder, size_t number, selas_field field, size_t start,
                           size_t stride, size_t count, size_t block, double *value,
                           struct messages *messages)
{
    char name[64];
    snprintf(name, sizeof name, "/snapshots/%04zu/%s", number, field_name(field));
    const hsize_t components = (hsize_t)field_components(field);
    const hsize_t from[2] = {start, 0}, apart[2] = {stride, components}, times[2] = {count, 1};
    const hsize_t size[2] = {block, components}, whole[2] = {count * block, components};
    const struct quiet quiet = quiet_begin();
    const hid_t file = H5Fopen(recorder->file->path, H5F_ACC_RDONLY, H5P_DEFAULT);
    const hid_t set = file >= 0 ? H5Dopen2(file, name, H5P_DEFAULT) : -1;
    bool good = set >= 0;
    if (good) {
        const hid_t there = H5Dget_space(set);
        const hid_t here = H5Screate_simple(2, whole, NULL);
        good = H5Sselect_hyperslab(there, H5S_SELECT_SET, from, apart, times, size) >= 0 &&
               H5Dread(set, H5T_NATIVE_DOUBLE, here, there, H5P_DEFAULT, value) >= 0;
        H5Sclose(here);
        H5Sclose(there);
        H5Dclose(set);
    }
    if (file >= 0) H5Fclose(file);
    quiet_end(quiet);
    return good ? SELAS_OK
                : fail(messages, SELAS_FILE_ERROR, "cannot read %s of '%s'", name, recorder->file->path);
}
