/* Files of heights (see the header). netCDF-4 files are HDF5 files whose coordinates are data sets of their own
 * (Unidata, "NetCDF-4/HDF5 file format"); GMT's grids name them x, y and z, rows along y. */
#include "scene/height_rows.h"

#include "base/hdf_quiet.h"
#include "base/lines.h"
#include "base/memory.h"
#include "base/stored.h"
#include "scene/model_file.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <strings.h>

enum { UNIT = 32 };

bool height_rows_keep(struct height_rows *rows, const double *value, int axes)
{
    if (rows->count == rows->room) {
        const size_t more = 2 * rows->room + 1024;
        double(*larger)[3] = array_new(more, sizeof *larger);
        if (larger == NULL) return false;
        if (rows->count > 0) memcpy(larger, rows->row, rows->count * sizeof *larger);
        array_free(rows->row);
        rows->row = larger;
        rows->room = more;
    }
    double *row = rows->row[rows->count++];
    row[0] = value[0];
    row[1] = axes == 2 ? value[1] : 0;
    row[2] = value[axes];
    return true;
}

static selas_status read_text(const char *path, int axes, struct height_rows *rows, struct messages *messages)
{
    FILE *file = fopen(path, "r");
    if (file == NULL) return fail(messages, SELAS_FILE_ERROR, "cannot open '%s': %s", path, strerror(errno));
    char line[LINE_SIZE];
    selas_status status = SELAS_OK;
    enum line_found next = LINE_END;
    for (size_t number = 1; status == SELAS_OK && (next = line_next(file, line)) != LINE_END; number++) {
        double value[3];
        int count = next == LINE_READ ? line_numbers(line, 3, value) : 0;
        for (int i = 0; i < count; i++)
            if (!isfinite(value[i])) count = -1;
        if (next != LINE_READ)
            status = fail(messages, SELAS_FILE_ERROR, "%s:%zu: %s", path, number, line_fault(next));
        else if (count != 0 && count != axes + 1)
            status = fail(messages, SELAS_FILE_ERROR, "%s:%zu: expected %s", path, number,
                          axes == 2 ? "three numbers, x y height" : "two numbers, x height");
        else if (count != 0 && !height_rows_keep(rows, value, axes))
            status = fail(messages, SELAS_NO_MEMORY, "no memory for '%s'", path);
    }
    if (status == SELAS_OK && ferror(file) != 0)
        status = fail(messages, SELAS_FILE_ERROR, "cannot read '%s': %s", path, strerror(errno));
    fclose(file);
    return status;
}

/* What stands for no value becomes NaN, packed numbers those they stand for (NetCDF Users Guide, "Attribute
 * Conventions"). */
static void unpack(hid_t set, size_t count, double *value)
{
    static const char *const none[] = {"_FillValue", "missing_value"};
    double scale = 1, offset = 0, fill[2];
    for (int i = 0; i < 2; i++)
        if (!model_numbers(set, none[i], 1, &fill[i])) fill[i] = NAN;
    if (!model_numbers(set, "scale_factor", 1, &scale)) scale = 1;
    if (!model_numbers(set, "add_offset", 1, &offset)) offset = 0;
    for (size_t k = 0; k < count; k++) {
        bool stored = fabs(value[k]) < 1e19;
        for (int i = 0; i < 2; i++)
            if (fabs(value[k] - fill[i]) <= 1e-6 * fabs(fill[i])) stored = false;
        value[k] = stored ? scale * value[k] + offset : NAN;
    }
}

/* Numbers of a data set of so many axes, with their extents; NULL: there is none such. Free with array_free(). */
static double *read_set(hid_t file, const char *name, int axes, size_t extent[2])
{
    const hid_t set = stored_set(file, name);
    if (set < 0) return NULL;
    hsize_t own[2] = {0, 1};
    const hid_t space = H5Dget_space(set);
    double *value = NULL;
    if (H5Sget_simple_extent_ndims(space) == axes && H5Sget_simple_extent_dims(space, own, NULL) == axes)
        value = array_new((size_t)(own[0] * own[1]), sizeof *value);
    if (value != NULL && H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) < 0) {
        array_free(value);
        value = NULL;
    }
    if (value != NULL) unpack(set, (size_t)(own[0] * own[1]), value);
    for (int axis = 0; axis < 2; axis++)
        extent[axis] = (size_t)own[axis];
    H5Sclose(space);
    H5Dclose(set);
    return value;
}

/* The unit that a data set names, or "". */
static void read_unit(hid_t file, const char *name, char unit[UNIT])
{
    const hid_t set = stored_set(file, name);
    unit[0] = '\0';
    if (set < 0) return;
    if (!model_word(set, "units", 0, unit, UNIT)) unit[0] = '\0';
    H5Dclose(set);
}

/* A unit in metres; `other` of one that is not known. */
static double metres(const char *unit, double other)
{
    static const struct {
        const char *name;
        double size;
    } known[] = {
        {"m", 1},     {"meter", 1},        {"meters", 1},        {"metre", 1},        {"metres", 1},
        {"km", 1000}, {"kilometer", 1000}, {"kilometers", 1000}, {"kilometre", 1000}, {"kilometres", 1000}};
    for (size_t i = 0; i < sizeof known / sizeof *known; i++)
        if (strcasecmp(unit, known[i].name) == 0) return known[i].size;
    return other;
}

struct grid {
    char unit[2][UNIT]; /* of the places, of the heights */
    double *place[2], *height;
    size_t n[2], extent[2]; /* of the places along x and y; of the data set */
    bool turned;            /* rows along y */
};

static bool read_grid(hid_t file, int axes, struct grid *grid)
{
    size_t extent[2] = {0, 0};
    grid->place[0] = read_set(file, "x", 1, extent);
    if (grid->place[0] == NULL) return false;
    grid->n[0] = extent[0];
    if (axes == 2) {
        grid->place[1] = read_set(file, "y", 1, extent);
        if (grid->place[1] == NULL) return false;
        grid->n[1] = extent[0];
    }
    grid->height = read_set(file, "height", axes, grid->extent);
    grid->turned = grid->height == NULL;
    if (grid->turned) grid->height = read_set(file, "z", axes, grid->extent);
    if (grid->height == NULL) return false;
    const bool across = grid->turned && axes == 2;
    read_unit(file, "x", grid->unit[0]);
    read_unit(file, grid->turned ? "z" : "height", grid->unit[1]);
    return grid->extent[0] == grid->n[across ? 1 : 0] && grid->extent[1] == grid->n[across ? 0 : 1];
}

static selas_status keep_grid(const char *path, int axes, const struct grid *grid, struct height_rows *rows,
                              struct messages *messages)
{
    const char *name = grid->turned ? "z" : "height";
    const double size = metres(grid->unit[0], 1);
    if (metres(grid->unit[1], size) != size)
        return fail(messages, SELAS_FILE_ERROR,
                    "%s: '%s' is in '%s', x in '%s'; expected both in the deck's unit of length", path, name,
                    grid->unit[1], grid->unit[0]);
    for (size_t i = 0; i < grid->extent[0] * grid->extent[1]; i++) {
        const size_t row = i / grid->extent[1], column = i % grid->extent[1];
        const bool across = grid->turned && axes == 2;
        double value[3] = {grid->place[0][across ? column : row], 0, 0};
        if (axes == 2) value[1] = grid->place[1][across ? row : column];
        value[axes] = grid->height[i];
        for (int n = 0; n <= axes; n++)
            if (!isfinite(value[n]))
                return fail(messages, SELAS_FILE_ERROR,
                            "%s: value %zu of '%s', at (%g, %g), is not a number, or no data (_FillValue, "
                            "missing_value); expected a height at each place",
                            path, i + 1, name, value[0], axes == 2 ? value[1] : 0.0);
        if (!height_rows_keep(rows, value, axes))
            return fail(messages, SELAS_NO_MEMORY, "no memory for '%s'", path);
    }
    return SELAS_OK;
}

static selas_status read_hdf5(const char *path, int axes, struct height_rows *rows, struct messages *messages)
{
    struct grid grid = {.n = {1, 1}};
    char fault[STORED_FAULT] = "";
    bool good = false;
#pragma omp critical(selas_hdf5)
    {
        const struct quiet quiet = quiet_begin();
        const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
        good = file >= 0 && stored_unpacks(file, fault) && read_grid(file, axes, &grid);
        if (file >= 0) H5Fclose(file);
        quiet_end(quiet);
    }
    selas_status status = SELAS_FILE_ERROR;
    if (good)
        status = keep_grid(path, axes, &grid, rows, messages);
    else if (fault[0] != '\0')
        fail(messages, status, "%s: %s", path, fault);
    else
        fail(messages, status, "%s: expected the HDF5 data sets %s", path,
             axes == 2 ? "x [nx], y [ny] and height [nx, ny], or z [ny, nx] as in grids of netCDF-4 (GMT)"
                       : "x [nx] and height [nx], or z [nx]");
    array_free(grid.place[0]);
    array_free(grid.place[1]);
    array_free(grid.height);
    return status;
}

selas_status height_rows_read(const char *path, int axes, struct height_rows *rows, struct messages *messages)
{
    if (stored_begins(path, "CDF", 3)) /* GMT's choice for grids of less than 16384 values */
        return fail(messages, SELAS_FILE_ERROR,
                    "%s: netCDF of the classic format; make text or netCDF-4 of it: gmt grd2xyz %s "
                    ">heights.txt, or nccopy -k nc4",
                    path, path);
    return stored_is_hdf5(path) ? read_hdf5(path, axes, rows, messages)
                                : read_text(path, axes, rows, messages);
}
