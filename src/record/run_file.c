/* run.h5: histories, snapshots, every setting of the deck, and where the run comes from.
 *
 * /histories/NAME [rows x 7], /histories/NAME_exact; /points/position [points x 3]; /snapshots/NNNN/FIELD
 * [points x components] (single precision; attributes time, step, group); /settings/GROUP_N attributes;
 * /provenance attributes. It is made when the run is over, by all ranks, under a temporary name until it is complete;
 * snapshots come from the files of their own in which they were kept so far (snapshot_file.c). */
#include "record/run_file.h"

#include "base/safe_file.h"
#include "parallel/files.h"
#include "record/sets.h"

#include <errno.h>
#include <stdlib.h>
#include <string.h>

/* HDF5 tells only that it failed; what the system said is still in errno, if it was the system. */
selas_status hdf_cannot(const char *what, const char *path, int error, struct messages *messages)
{
    static const int told[] = {ENOSPC, EDQUOT, EFBIG,  EIO,    EROFS,  EACCES,  EPERM,
                               ENOENT, EMFILE, ENFILE, ENOMEM, EISDIR, ENOTDIR, ESTALE};
    for (size_t i = 0; i < sizeof told / sizeof *told; i++)
        if (error == told[i])
            return fail(messages, error == ENOMEM ? SELAS_NO_MEMORY : SELAS_FILE_ERROR, "cannot %s '%s': %s",
                        what, path, strerror(error));
    return fail(messages, SELAS_FILE_ERROR, "cannot %s '%s'", what, path);
}

/* Files are locked by folder (unfinished.h): HDF5's own locks only keep readers out, or fail where the file
 * system has none. */
static hid_t without_locks(void)
{
    const hid_t access = H5Pcreate(H5P_FILE_ACCESS);
#if H5_VERSION_GE(1, 10, 7)
    H5Pset_file_locking(access, false, true);
#endif
    return access;
}

hid_t hdf_create_file(const char *path, size_t head)
{
    const hid_t access = without_locks(), creation = H5Pcreate(H5P_FILE_CREATE);
    if (head > 0) H5Pset_userblock(creation, head);
    const hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, creation, access);
    H5Pclose(access);
    H5Pclose(creation);
    return file;
}

hid_t hdf_open_file(const char *path)
{
    const hid_t access = without_locks();
    const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, access);
    H5Pclose(access);
    return file;
}

hid_t hdf_open_together(const struct ranks *ranks, const char *path, bool write)
{
    const hid_t access = without_locks();
    ranks_open_together(ranks, access);
    const hid_t file = H5Fopen(path, write ? H5F_ACC_RDWR : H5F_ACC_RDONLY, access);
    H5Pclose(access);
    return file;
}

/* Attributes are kept in the object header, which holds at most 64 KiB. */
bool hdf_text(hid_t place, const char *name, const char *text)
{
    enum { LONG = 32000 };
    const bool set = strlen(text) >= LONG;
    const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
    H5Tset_size(type, strlen(text) + 1);
    const hid_t to = set ? H5Dcreate2(place, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT)
                         : H5Acreate2(place, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    const bool good = to >= 0 && (set ? H5Dwrite(to, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text)
                                      : H5Awrite(to, type, text)) >= 0;
    if (to >= 0) (void)(set ? H5Dclose(to) : H5Aclose(to));
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

hid_t hdf_rows(hid_t place, const char *name, hid_t type, size_t rows, size_t columns)
{
    const hsize_t size[2] = {rows, columns};
    return set_make(place, name, type, 2, size);
}

bool hdf_rows_pass(hid_t set, bool write, size_t first, size_t rows, size_t columns, double *value)
{
    const hsize_t from[2] = {first, 0}, count[2] = {rows, columns};
    if (rows == 0) return true;
    const hid_t there = H5Dget_space(set), here = H5Screate_simple(2, count, NULL);
    const bool good = H5Sselect_hyperslab(there, H5S_SELECT_SET, from, NULL, count, NULL) >= 0 &&
                      (write ? H5Dwrite(set, H5T_NATIVE_DOUBLE, here, there, H5P_DEFAULT, value)
                             : H5Dread(set, H5T_NATIVE_DOUBLE, here, there, H5P_DEFAULT, value)) >= 0;
    H5Sclose(here);
    H5Sclose(there);
    return good;
}

static bool hdf_table(hid_t place, const char *name, hid_t type, size_t rows, size_t columns,
                      const double *value)
{
    const hid_t set = hdf_rows(place, name, type, rows, columns);
    const bool good = set >= 0 && H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) >= 0;
    return set >= 0 && H5Dclose(set) >= 0 && good;
}

hid_t hdf_group(hid_t place, const char *name)
{
    return H5Gcreate2(place, name, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
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

static void write_all(const struct recorder *recorder, const struct run_figures *figures, struct walk *walk,
                      struct messages *messages)
{
    const hid_t file = walk->file;
    hdf_points(recorder, walk);
    snapshots_gather(recorder, walk);
    if (walk_makes(walk) && !walk->failed)
        walk_note(walk, write_histories(recorder, file) && write_settings(recorder->scene->deck, file) &&
                            write_provenance(recorder, file, figures, messages));
}

selas_status run_file_open(struct recorder *recorder, const char *work, struct messages *messages)
{
    const char *folder = recorder->scene->output.directory;
    struct run_file *file = calloc(1, sizeof *file);
    if (file == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for run.h5");
    selas_status status = safe_file_names(folder, "run.h5", &file->path, &file->temporary, messages);
    if (status == SELAS_OK)
        status =
            unfinished_open(folder, work, ranks_first(recorder->scene->ranks), &file->unfinished, messages);
    if (status == SELAS_OK) {
        recorder->file = file;
        return SELAS_OK;
    }
    free(file->path);
    free(file->temporary);
    free(file);
    return status;
}

selas_status recorder_unfinished(struct recorder *recorder, const char **folder, struct messages *messages)
{
    *folder = recorder->file->unfinished.path;
    return make_folder(*folder, messages);
}

selas_status run_file_finish(struct recorder *recorder, const struct run_figures *figures,
                             struct messages *messages)
{
    struct run_file *file = recorder->file;
    struct ranks *ranks = recorder->scene->ranks;
    struct walk walk = {.ranks = ranks, .path = file->temporary, .named = file->path, .mode = SET_WRITE};
#pragma omp critical(selas_hdf5)
    {
        const struct quiet quiet = quiet_begin();
        for (bool more = walk_begin(&walk); more; more = walk_again(&walk))
            write_all(recorder, figures, &walk, messages);
        quiet_end(quiet);
    }
    const bool good = walk_good(&walk), first = ranks_first(ranks);
    selas_status status = good ? SELAS_OK : walk_cannot(&walk, "write", messages);
    if (first && good) status = safe_file_commit(file->temporary, file->path, messages);
    if (first && !good) remove(file->temporary);
    return ranks_agree(ranks, status, messages);
}

void run_file_close(struct recorder *recorder, bool complete)
{
    struct run_file *file = recorder->file;
    if (file == NULL) return;
    if (complete && ranks_first(recorder->scene->ranks)) unfinished_remove(&file->unfinished);
    unfinished_close(&file->unfinished);
    free(file->path);
    free(file->temporary);
    free(file);
    recorder->file = NULL;
}

/* `count` blocks of `block` rows, their starts `stride` rows apart. */
static bool read_blocks(hid_t set, hsize_t components, size_t start, size_t stride, size_t count,
                        size_t block, double *value)
{
    const hsize_t from[2] = {start, 0}, apart[2] = {stride, components}, times[2] = {count, 1};
    const hsize_t size[2] = {block, components}, whole[2] = {count * block, components};
    const hid_t there = H5Dget_space(set), here = H5Screate_simple(2, whole, NULL);
    const bool good = H5Sselect_hyperslab(there, H5S_SELECT_SET, from, apart, times, size) >= 0 &&
                      H5Dread(set, H5T_NATIVE_DOUBLE, here, there, H5P_DEFAULT, value) >= 0;
    H5Sclose(here);
    H5Sclose(there);
    return good;
}

selas_status run_file_read(const struct recorder *recorder, size_t number, selas_field field, size_t start,
                           size_t stride, size_t count, size_t block, double *value,
                           struct messages *messages)
{
    char name[64];
    snprintf(name, sizeof name, "/snapshots/%04zu/%s", number, field_name(field));
    bool good = false;
#pragma omp critical(selas_hdf5)
    {
        const struct quiet quiet = quiet_begin();
        const hid_t file = hdf_open_file(recorder->file->path);
        const hid_t set = file >= 0 ? H5Dopen2(file, name, H5P_DEFAULT) : -1;
        const hsize_t components = (hsize_t)field_components(field);
        if (set >= 0) good = read_blocks(set, components, start, stride, count, block, value);
        if (set >= 0) H5Dclose(set);
        if (file >= 0) H5Fclose(file);
        quiet_end(quiet);
    }
    return good ? SELAS_OK
                : fail(messages, SELAS_FILE_ERROR, "cannot read %s of '%s'", name, recorder->file->path);
}
