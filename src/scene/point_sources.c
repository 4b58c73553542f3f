/* Lists of point sources, text or HDF5 (see the header). */
#include "scene/point_sources.h"

#include "base/lines.h"
#include "base/memory.h"
#include "base/stored.h"

#include <errno.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { MOST_NUMBERS = 11 };

static struct point_source *add(struct point_sources *sources, size_t *room)
{
    if (sources->count == *room) {
        const size_t more = 2 * *room + 64;
        struct point_source *larger = array_new(more, sizeof *larger);
        if (larger == NULL) return NULL;
        if (sources->count > 0) memcpy(larger, sources->source, sources->count * sizeof *larger);
        array_free(sources->source);
        sources->source = larger;
        *room = more;
    }
    return &sources->source[sources->count++];
}

static selas_status read_lines(FILE *file, const char *path, size_t values, struct point_sources *sources,
                               struct messages *messages)
{
    char line[LINE_SIZE];
    enum line_found next = LINE_END;
    size_t room = 0;
    for (size_t number = 1; (next = line_next(file, line)) != LINE_END; number++) {
        double value[MOST_NUMBERS] = {0};
        if (next != LINE_READ)
            return fail(messages, SELAS_FILE_ERROR, "%s:%zu: %s", path, number, line_fault(next));
        const int count = line_numbers(line, MOST_NUMBERS, value), least = (int)(3 + values);
        if (count == 0) continue;
        if (count < least || count > least + 2)
            return fail(messages, SELAS_FILE_ERROR,
                        "%s:%zu: expected %d numbers, x y z and %s, and after them amplitude and start if "
                        "they are not 1 and 0",
                        path, number, least, values == 6 ? "moment xx yy zz xy yz zx" : "force x y z");
        for (int i = 0; i < count; i++)
            if (!isfinite(value[i]))
                return fail(messages, SELAS_FILE_ERROR, "%s:%zu: number %d is not finite", path, number,
                            i + 1);
        if (value[least + 1] < 0)
            return fail(messages, SELAS_FILE_ERROR, "%s:%zu: the start is %g; expected 0 or later", path,
                        number, value[least + 1]);
        struct point_source *source = add(sources, &room);
        if (source == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for '%s'", path);
        memcpy(source->position, value, sizeof source->position);
        memcpy(source->value, value + 3, values * sizeof *value);
        source->amplitude = count > least ? value[least] : 1;
        source->start = value[least + 1];
    }
    return SELAS_OK;
}

static selas_status read_text(const char *path, size_t values, struct point_sources *sources,
                              struct messages *messages)
{
    FILE *file = fopen(path, "r");
    if (file == NULL) return fail(messages, SELAS_FILE_ERROR, "cannot open '%s': %s", path, strerror(errno));
    selas_status status = read_lines(file, path, values, sources, messages);
    if (status == SELAS_OK && ferror(file) != 0)
        status = fail(messages, SELAS_FILE_ERROR, "cannot read '%s': %s", path, strerror(errno));
    fclose(file);
    return status;
}

/* --- HDF5 --------------------------------------------------------------------------------------------- */

/* Numbers of a data set [n, columns], n as in *rows unless that is 0; NULL if it is not so. */
static double *read_set(hid_t file, const char *name, size_t columns, size_t *rows)
{
    const hid_t set = stored_set(file, name);
    if (set < 0) return NULL;
    hsize_t extent[2] = {0, 1};
    const hid_t space = H5Dget_space(set);
    const int rank = H5Sget_simple_extent_ndims(space);
    double *value = NULL;
    if (rank >= 1 && rank <= 2 && H5Sget_simple_extent_dims(space, extent, NULL) == rank &&
        extent[1] == columns && extent[0] > 0 && (*rows == 0 || extent[0] == *rows))
        value = array_new((size_t)extent[0] * columns, sizeof *value);
    if (value != NULL && H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) < 0) {
        array_free(value);
        value = NULL;
    }
    for (size_t i = 0; value != NULL && i < (size_t)extent[0] * columns; i++)
        if (!isfinite(value[i])) {
            array_free(value);
            value = NULL;
        }
    if (value != NULL) *rows = (size_t)extent[0];
    H5Sclose(space);
    H5Dclose(set);
    return value;
}

/* False: the data sets are not as they should be, or there is no memory. */
static bool read_sets(hid_t file, size_t values, struct point_sources *sources)
{
    size_t rows = 0;
    double *position = read_set(file, "position", 3, &rows);
    double *value = position != NULL ? read_set(file, values == 6 ? "moment" : "force", values, &rows) : NULL;
    const bool scaled = stored_here(file, "amplitude"), delayed = stored_here(file, "start");
    double *amplitude = scaled && value != NULL ? read_set(file, "amplitude", 1, &rows) : NULL;
    double *start = delayed && value != NULL ? read_set(file, "start", 1, &rows) : NULL;
    bool right = value != NULL && (!scaled || amplitude != NULL) && (!delayed || start != NULL);
    if (right) sources->source = array_new(rows, sizeof *sources->source);
    right = right && sources->source != NULL;
    for (size_t i = 0; i < rows && right; i++) {
        struct point_source *source = &sources->source[i];
        memcpy(source->position, position + 3 * i, sizeof source->position);
        memcpy(source->value, value + values * i, values * sizeof *value);
        source->amplitude = scaled ? amplitude[i] : 1;
        source->start = delayed ? start[i] : 0;
        right = source->start >= 0;
    }
    if (right) sources->count = rows;
    array_free(position);
    array_free(value);
    array_free(amplitude);
    array_free(start);
    return right;
}

static selas_status read_hdf5(const char *path, size_t values, struct point_sources *sources,
                              struct messages *messages)
{
    char fault[STORED_FAULT] = "";
    bool right = false;
#pragma omp critical(selas_hdf5)
    {
        H5E_auto2_t function = NULL; /* HDF5 prints its errors unless it is told not to */
        void *data = NULL;
        H5Eget_auto2(H5E_DEFAULT, &function, &data);
        H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
        const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
        if (file >= 0) {
            right = stored_unpacks(file, fault) && read_sets(file, values, sources);
            H5Fclose(file);
        }
        H5Eset_auto2(H5E_DEFAULT, function, data);
    }
    if (right) return SELAS_OK;
    if (fault[0] != '\0') return fail(messages, SELAS_FILE_ERROR, "'%s': %s", path, fault);
    return fail(
        messages, SELAS_FILE_ERROR,
        "'%s': expected data sets position [n, 3], %s and, if any, amplitude [n], start [n] >= 0, in the "
        "file itself",
        path, values == 6 ? "moment [n, 6]" : "force [n, 3]");
}

selas_status point_sources_read(const char *path, size_t values, struct point_sources *sources,
                                struct messages *messages)
{
    *sources = (struct point_sources){0};
    selas_status status = stored_is_hdf5(path) ? read_hdf5(path, values, sources, messages)
                                               : read_text(path, values, sources, messages);
    if (status == SELAS_OK && sources->count == 0)
        status = fail(messages, SELAS_FILE_ERROR, "'%s' holds no source", path);
    if (status != SELAS_OK) point_sources_free(sources);
    return status;
}

void point_sources_free(struct point_sources *sources)
{
    array_free(sources->source);
    *sources = (struct point_sources){0};
}
