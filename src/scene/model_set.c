/* What formats of models in HDF5 share: attributes and parts of data sets. */
#include "base/hdf_quiet.h"
#include "base/memory.h"
#include "base/stored.h"
#include "scene/model_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

bool model_numbers(hid_t place, const char *name, size_t count, double *value)
{
    if (H5Aexists(place, name) <= 0) return false;
    const hid_t attribute = H5Aopen(place, name, H5P_DEFAULT), space = H5Aget_space(attribute);
    bool right = H5Sget_simple_extent_npoints(space) == (hssize_t)count &&
                 H5Aread(attribute, H5T_NATIVE_DOUBLE, value) >= 0;
    for (size_t i = 0; i < count; i++)
        right = right && isfinite(value[i]);
    H5Sclose(space);
    H5Aclose(attribute);
    return right;
}

/* The i-th text of an attribute's numbers `raw`; of fixed length, or pointers. */
static void copy_word(const char *raw, hid_t type, size_t i, char *text, size_t size)
{
    const size_t width = H5Tget_size(type);
    if (H5Tis_variable_str(type) > 0) {
        const char *word = ((char *const *)(const void *)raw)[i];
        snprintf(text, size, "%s", word != NULL ? word : "");
    } else {
        snprintf(text, size, "%.*s", (int)(width < size ? width : size - 1), raw + i * width);
    }
    for (size_t length = strlen(text); length > 0 && text[length - 1] == ' '; length--)
        text[length - 1] = '\0';
}

bool model_word(hid_t place, const char *name, size_t i, char *text, size_t size)
{
    static const hssize_t most = 1000;
    if (H5Aexists(place, name) <= 0) return false;
    const hid_t attribute = H5Aopen(place, name, H5P_DEFAULT), space = H5Aget_space(attribute),
                type = H5Aget_type(attribute);
    const hssize_t count = H5Sget_simple_extent_npoints(space);
    bool right =
        H5Tget_class(type) == H5T_STRING && count > (hssize_t)i && count <= most && H5Tget_size(type) <= 4096;
    char *raw = right ? calloc((size_t)count, H5Tget_size(type)) : NULL;
    right = raw != NULL && H5Aread(attribute, type, raw) >= 0;
    if (right) copy_word(raw, type, i, text, size);
    if (right && H5Tis_variable_str(type) > 0) H5Dvlen_reclaim(type, space, H5P_DEFAULT, raw);
    free(raw);
    H5Tclose(type);
    H5Sclose(space);
    H5Aclose(attribute);
    return right;
}

int model_extent(hid_t set, size_t extent[4])
{
    const hid_t space = H5Dget_space(set);
    hsize_t found[4] = {0};
    const int rank = H5Sget_simple_extent_ndims(space);
    const bool right = rank >= 1 && rank <= 4 && H5Sget_simple_extent_dims(space, found, NULL) == rank;
    H5Sclose(space);
    for (int i = 0; i < 4; i++)
        extent[i] = right && i < rank ? (size_t)found[i] : 0;
    return right ? rank : 0;
}

bool model_read_part(hid_t set, int axes, const size_t n[3], const size_t first[3], size_t component,
                     double *value)
{
    const hid_t space = H5Dget_space(set);
    const int rank = H5Sget_simple_extent_ndims(space);
    hsize_t start[4] = {0}, count[4] = {1, 1, 1, 1};
    bool right = rank == axes || rank == axes + 1;
    for (int axis = 0; axis < axes; axis++) {
        start[axis] = first[axis];
        count[axis] = n[axis];
    }
    start[axes] = rank == axes ? 0 : component;
    const hid_t memory = H5Screate_simple(rank, count, NULL);
    right = right && H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, count, NULL) >= 0 &&
            H5Dread(set, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, value) >= 0;
    H5Sclose(memory);
    H5Sclose(space);
    return right;
}

/* --- Values of grids --- */

static bool read_column(const struct model_column *column, const size_t n[3], const size_t first[3],
                        double *value)
{
    if (!model_read_part(column->set, 3, n, first, column->component, value)) return false;
    for (size_t k = 0; k < n[0] * n[1] * n[2] && column->factor != 1; k++)
        if (value[k] > -1e19) value[k] *= column->factor; /* else no data */
    return true;
}

/* Context of pieces of a grid: where its values lie. */
struct columns {
    size_t first[3];
    int sets;
    struct model_column of[MODEL_SETS];
};

static void close_columns(void *context)
{
    struct columns *columns = context;
#pragma omp critical(selas_hdf5)
    for (int set = 0; set < columns->sets; set++)
        if (columns->of[set].set > 0) H5Dclose(columns->of[set].set);
    array_free(columns);
}

static bool read_columns(void *context, const struct model_grid *box, const size_t first[3])
{
    const struct columns *columns = context;
    size_t start[3];
    bool good = true;
    for (int axis = 0; axis < 3; axis++)
        start[axis] = columns->first[axis] + first[axis];
#pragma omp critical(selas_hdf5)
    {
        const struct quiet quiet = quiet_begin();
        for (int set = 0; set < columns->sets && good; set++)
            good = read_column(&columns->of[set], box->n, start, box->value[set]);
        quiet_end(quiet);
    }
    if (columns->sets == MODEL_SETS) model_no_quality(box);
    return good;
}

bool model_take(struct model_grid *grid, int sets, int set, const struct model_column *column,
                const size_t first[3])
{
    if (grid->value[set] != NULL) return read_column(column, grid->n, first, grid->value[set]);
    if (set == 0) {
        struct columns *columns = array_new(1, sizeof *columns);
        if (columns == NULL) return false;
        memcpy(columns->first, first, sizeof columns->first);
        columns->sets = sets;
        const struct model_origin origin = {read_columns, close_columns, columns, sets, NULL};
        if (!model_pieces_new(grid, &origin)) {
            array_free(columns);
            return false;
        }
    }
    struct columns *columns = model_pieces_context(grid);
    columns->of[set] = *column;
    return H5Iinc_ref(column->set) > 0;
}
