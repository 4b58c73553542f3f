/* What formats of models in HDF5 share: attributes and parts of data sets. */
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

bool model_read_part(hid_t set, const struct model_grid *grid, const size_t first[3], size_t component,
                     double *value)
{
    const hid_t space = H5Dget_space(set);
    const int rank = H5Sget_simple_extent_ndims(space), axes = grid->n[2] == 1 ? 2 : 3;
    hsize_t start[4] = {0}, count[4] = {1, 1, 1, 1};
    bool right = rank == axes || rank == axes + 1;
    for (int axis = 0; axis < axes; axis++) {
        start[axis] = first[axis];
        count[axis] = grid->n[axis];
    }
    start[axes] = rank == axes ? 0 : component;
    const hid_t memory = H5Screate_simple(rank, count, NULL);
    right = right && H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, count, NULL) >= 0 &&
            H5Dread(set, H5T_NATIVE_DOUBLE, memory, space, H5P_DEFAULT, value) >= 0;
    H5Sclose(memory);
    H5Sclose(space);
    return right;
}
