/* Points from a file: positions, volumes and, for points next to the surface, the outward normal and the area
 * they stand for.
 *
 * Text: a point a line, columns x [y [z]] volume [nx [ny [nz]] area], '#' or '!' comments. HDF5: datasets
 * position [n, dimension], volume [n] and, if there is a surface, normal [n, dimension] and area [n]. A
 * normal of zeros stands for "inside". The surface element lies half a local spacing outside the point along
 * its normal; it belongs to a face of the body's box if it lies within one spacing of it and the normals
 * agree. */
#include "points/cloud.h"

#include "base/lines.h"
#include "base/memory.h"
#include "base/stored.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

enum { COLUMNS = 8 };

/* Rows of `columns` numbers: 3 positions, volume, 3 normal components, area (unused ones 0). */
struct table {
    size_t rows, room;
    double (*row)[COLUMNS];
    size_t *line; /* [rows] of a text file; else NULL */
    size_t line_room;
};

static bool make_room(struct table *table, size_t rows)
{
    if (rows <= table->room) return true;
    const size_t room = rows + rows / 2 + 64;
    double(*larger)[COLUMNS] = realloc(table->row, room * sizeof *larger);
    if (larger == NULL) return false;
    table->row = larger;
    table->room = room;
    return true;
}

static bool make_room_for_lines(struct table *table)
{
    if (table->line_room == table->room) return true;
    size_t *larger = realloc(table->line, table->room * sizeof *larger);
    if (larger == NULL) return false;
    table->line = larger;
    table->line_room = table->room;
    return true;
}

static selas_status add_row(struct table *table, size_t d, int count, const double *value, const char *path,
                            size_t line, struct messages *messages)
{
    if (count != (int)d + 1 && count != (int)(2 * d) + 2)
        return fail(messages, SELAS_FILE_ERROR,
                    "%s:%zu: expected %zu numbers (position, volume) or %zu (and normal, area)", path, line,
                    d + 1, 2 * d + 2);
    if (!make_room(table, table->rows + 1) || !make_room_for_lines(table))
        return fail(messages, SELAS_NO_MEMORY, "no memory for '%s'", path);
    table->line[table->rows] = line;
    double *row = table->row[table->rows++];
    memset(row, 0, sizeof *table->row);
    memcpy(row, value, d * sizeof *row);
    row[3] = value[d];
    if (count > (int)d + 1) memcpy(row + 4, value + d + 1, d * sizeof *row);
    if (count > (int)d + 1) row[7] = value[2 * d + 1];
    return SELAS_OK;
}

static selas_status read_text(const char *path, size_t d, struct table *table, struct messages *messages)
{
    FILE *file = fopen(path, "r");
    if (file == NULL) return fail(messages, SELAS_FILE_ERROR, "cannot open '%s': %s", path, strerror(errno));
    selas_status status = SELAS_OK;
    char line[LINE_SIZE];
    enum line_found next = LINE_END;
    for (size_t number = 1; status == SELAS_OK && (next = line_next(file, line)) != LINE_END; number++) {
        double value[COLUMNS] = {0};
        if (next != LINE_READ) {
            status = fail(messages, SELAS_FILE_ERROR, "%s:%zu: %s", path, number, line_fault(next));
            break;
        }
        const int count = line_numbers(line, COLUMNS, value);
        if (count != 0) status = add_row(table, d, count, value, path, number, messages);
    }
    if (status == SELAS_OK && ferror(file) != 0)
        status = fail(messages, SELAS_FILE_ERROR, "cannot read '%s': %s", path, strerror(errno));
    fclose(file);
    return status;
}

/* Reads dataset `name` of n x columns into the table from column `at` on. */
static bool read_dataset(hid_t file, const char *name, size_t columns, size_t at, struct table *table)
{
    const hid_t set = stored_set(file, name);
    if (set < 0) return false;
    const hid_t space = H5Dget_space(set);
    hsize_t extent[2] = {0, 1};
    const int rank = H5Sget_simple_extent_ndims(space);
    bool right = rank >= 1 && rank <= 2 && H5Sget_simple_extent_dims(space, extent, NULL) == rank;
    right = right && extent[1] == columns && (table->rows == 0 || extent[0] == table->rows) &&
            make_room(table, (size_t)extent[0]);
    double *values = right ? array_new((size_t)extent[0] * columns, sizeof *values) : NULL;
    right = values != NULL && H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0;
    if (right && table->row != NULL && table->rows == 0) {
        table->rows = (size_t)extent[0];
        memset(table->row, 0, table->rows * sizeof *table->row);
    }
    for (size_t i = 0; right && i < table->rows; i++)
        memcpy(table->row[i] + at, values + columns * i, columns * sizeof *values);
    array_free(values);
    H5Sclose(space);
    H5Dclose(set);
    return right;
}

/* HDF5 prints its errors unless it is told not to. */
static bool read_datasets(const char *path, size_t d, struct table *table, bool *opened,
                          char fault[STORED_FAULT])
{
    bool right = false;
#pragma omp critical(selas_hdf5)
    {
        H5E_auto2_t function = NULL;
        void *data = NULL;
        H5Eget_auto2(H5E_DEFAULT, &function, &data);
        H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
        const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
        *opened = file >= 0;
        right = *opened && stored_unpacks(file, fault) && read_dataset(file, "position", d, 0, table) &&
                read_dataset(file, "volume", 1, 3, table);
        if (right && H5Lexists(file, "normal", H5P_DEFAULT) > 0)
            right = read_dataset(file, "normal", d, 4, table) && read_dataset(file, "area", 1, 7, table);
        if (*opened) H5Fclose(file);
        H5Eset_auto2(H5E_DEFAULT, function, data);
    }
    return right;
}

static selas_status read_hdf5(const char *path, size_t d, struct table *table, struct messages *messages)
{
    char fault[STORED_FAULT] = "";
    bool opened = false;
    if (read_datasets(path, d, table, &opened, fault)) return SELAS_OK;
    if (fault[0] != '\0') return fail(messages, SELAS_FILE_ERROR, "'%s': %s", path, fault);
    if (!opened) return fail(messages, SELAS_FILE_ERROR, "cannot open '%s' as an HDF5 file", path);
    return fail(
        messages, SELAS_FILE_ERROR,
        "'%s': expected datasets position [n, %zu], volume [n] and, if any, normal [n, %zu], area [n], in "
        "the file itself",
        path, d, d);
}

/* Face of the box that an element lies on, FACES if none. */
static int face_of(const struct body *body, int dimension, const struct face_element *element, double spacing)
{
    for (int face = 0; face < 2 * dimension; face++) {
        const int axis = face / 2;
        if (element->normal[axis] * face_sign((enum face)face) > 0.99 &&
            fabs(element->position[axis] - face_plane(body, (enum face)face)) < spacing)
            return face;
    }
    return FACES;
}

/* Where a point is from, for a message. */
static const char *origin_of(const struct scene *scene, const struct table *table, size_t i, char place[300])
{
    if (scene->body.file == NULL)
        snprintf(place, 300, "points of the host");
    else if (table->line != NULL)
        snprintf(place, 300, "%s:%zu", scene->body.file, table->line[i]);
    else
        snprintf(place, 300, "%s", scene->body.file);
    return place;
}

/* The box holds all points, its faces too. */
static selas_status check_inside(const struct scene *scene, const struct table *table, size_t i,
                                 struct messages *messages)
{
    const struct body *body = &scene->body;
    const double near = 1e-6 * body->spacing, *x = table->row[i];
    char place[300];
    for (int c = 0; c < scene->dimension; c++)
        if (!(x[c] > body->low[c] - near && x[c] < body->high[c] + near))
            return fail(
                messages, SELAS_BAD_SCENE,
                "%s: point %zu lies outside the box low .. high of the body: %c = %g; expected %g to %g",
                origin_of(scene, table, i, place), i + 1, "xyz"[c], x[c], body -> low[c], body -> high[c]);
    return SELAS_OK;
}

static selas_status take(const struct scene *scene, const struct table *table, struct cloud *cloud,
                         struct messages *messages)
{
    selas_status status = SELAS_OK;
    for (size_t i = 0; i < table->rows && status == SELAS_OK; i++) {
        const double *row = table->row[i];
        memcpy(cloud->position + 3 * i, row, 3 * sizeof *row);
        cloud->volume[i] = row[3];
        if (!(row[3] > 0) || !isfinite(row[0] + row[1] + row[2] + row[3]))
            return fail(messages, SELAS_BAD_SCENE,
                        "'%s': point %zu needs a finite position and a finite volume above 0",
                        scene->body.file != NULL ? scene->body.file : "points of the host", i + 1);
        if (!isfinite(row[4] + row[5] + row[6] + row[7]) || row[7] < 0)
            return fail(messages, SELAS_BAD_SCENE,
                        "'%s': point %zu needs a finite normal and a finite area, 0 or above",
                        scene->body.file, i + 1);
        status = check_inside(scene, table, i, messages);
        if (status != SELAS_OK) break;
        const double length = sqrt(row[4] * row[4] + row[5] * row[5] + row[6] * row[6]);
        if (!(length > 0)) continue;
        const double spacing = pow(row[3], 1.0 / scene->dimension);
        struct face_element element = {.area = row[7]};
        for (int c = 0; c < 3; c++) {
            element.normal[c] = row[4 + c] / length;
            element.position[c] = row[c] + 0.5 * spacing * element.normal[c];
        }
        element.face = face_of(&scene->body, scene->dimension, &element, spacing);
        status = cloud_add_element(cloud, &element, messages);
    }
    return status;
}

/* Points that the host handed over. */
static bool take_given(const struct given_points *given, struct table *table)
{
    if (!make_room(table, given->count) || table->row == NULL) return false;
    memset(table->row, 0, given->count * sizeof *table->row);
    for (size_t i = 0; i < given->count; i++) {
        memcpy(table->row[i], given->position + 3 * i, 3 * sizeof(double));
        table->row[i][3] = given->volume[i];
    }
    table->rows = given->count;
    return true;
}

selas_status cloud_read(const struct scene *scene, struct cloud **cloud, struct messages *messages)
{
    const char *path = scene->body.file;
    const size_t d = (size_t)scene->dimension;
    struct table table = {0};
    selas_status status = SELAS_OK;
    if (scene->body.given != NULL)
        status = take_given(scene->body.given, &table)
                     ? SELAS_OK
                     : fail(messages, SELAS_NO_MEMORY, "no memory for the points");
    else
        status = stored_is_hdf5(path) ? read_hdf5(path, d, &table, messages)
                                      : read_text(path, d, &table, messages);
    if (status == SELAS_OK && table.rows == 0)
        status = fail(messages, SELAS_FILE_ERROR, "'%s' has no points", path);
    if (status == SELAS_OK) status = cloud_allocate(scene->dimension, table.rows, cloud, messages);
    if (status == SELAS_OK) {
        (*cloud)->spacing = scene->body.spacing;
        status = take(scene, &table, *cloud, messages);
        free(table.row);
        table.row = NULL;
        if (status == SELAS_OK)
            status = points_check_apart(table.rows, (*cloud)->position, scene->body.spacing, path, table.line,
                                        messages);
    }
    free(table.row);
    free(table.line);
    if (status != SELAS_OK) cloud_free(cloud);
    return status;
}
