/* Arrays in HDF5 files (see the header). */
#include "record/sets.h"

#include "base/stored.h"

#include <stdlib.h>
#include <string.h>

bool set_write(hid_t file, const char *name, hid_t type, const void *data, size_t count)
{
    const hsize_t size = count;
    const hid_t space = H5Screate_simple(1, &size, NULL);
    const hid_t set = H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    bool good = set >= 0 && H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0;
    if (set >= 0) good = H5Dclose(set) >= 0 && good;
    H5Sclose(space);
    return good;
}

/* A set of so many numbers, open; negative if there is none. */
static hid_t set_open(hid_t file, const char *name, size_t count)
{
    const hid_t set = stored_set(file, name);
    if (set < 0) return set;
    const hid_t space = H5Dget_space(set);
    const bool right =
        H5Sget_simple_extent_npoints(space) == (hssize_t)count && H5Sget_simple_extent_ndims(space) == 1;
    H5Sclose(space);
    if (right) return set;
    H5Dclose(set);
    return -1;
}

bool set_read(hid_t file, const char *name, hid_t type, void *data, size_t count)
{
    const hid_t set = set_open(file, name, count);
    if (set < 0) return false;
    const bool good = H5Dread(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, data) >= 0;
    H5Dclose(set);
    return good;
}

/* Piece by piece: a checkpoint must not need the memory of another state. */
bool set_compare(hid_t file, const char *name, hid_t type, const void *data, size_t count)
{
    enum { SLAB = 1 << 16 };
    const size_t width = H5Tget_size(type);
    char *piece = malloc(SLAB * width);
    const hid_t set = set_open(file, name, count);
    bool good = piece != NULL && set >= 0;
    for (size_t from = 0; good && from < count; from += SLAB) {
        const hsize_t start = from, size = count - from < SLAB ? count - from : SLAB;
        const hid_t there = H5Dget_space(set), here = H5Screate_simple(1, &size, NULL);
        good = H5Sselect_hyperslab(there, H5S_SELECT_SET, &start, NULL, &size, NULL) >= 0 &&
               H5Dread(set, type, here, there, H5P_DEFAULT, piece) >= 0 &&
               memcmp(piece, (const char *)data + from * width, (size_t)size * width) == 0;
        H5Sclose(here);
        H5Sclose(there);
    }
    if (set >= 0) H5Dclose(set);
    free(piece);
    return good;
}

char *set_text(hid_t file, const char *name)
{
    const hid_t set = stored_set(file, name);
    if (set < 0) return NULL;
    const hid_t space = H5Dget_space(set);
    const hssize_t size = H5Sget_simple_extent_npoints(space);
    char *text = size > 0 && size < (hssize_t)1 << 30 ? calloc((size_t)size + 1, 1) : NULL;
    const bool good = text != NULL && H5Dread(set, H5T_NATIVE_CHAR, H5S_ALL, H5S_ALL, H5P_DEFAULT, text) >= 0;
    H5Sclose(space);
    H5Dclose(set);
    if (good) return text;
    free(text);
    return NULL;
}
