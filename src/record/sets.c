/* Arrays in HDF5 files (see the header). */
#include "record/sets.h"

#include "base/stored.h"

#include <stdlib.h>
#include <string.h>

hid_t set_open(hid_t file, const char *name, hid_t type, size_t count, enum set_mode mode)
{
    const hsize_t size = count;
    const hid_t made = mode == SET_WRITE ? H5Screate_simple(1, &size, NULL) : -1;
    const hid_t set = mode == SET_WRITE
                          ? H5Dcreate2(file, name, type, made, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT)
                          : stored_set(file, name);
    if (made >= 0) H5Sclose(made);
    if (set < 0 || mode == SET_WRITE) return set;
    const hid_t space = H5Dget_space(set);
    const bool right =
        H5Sget_simple_extent_npoints(space) == (hssize_t)count && H5Sget_simple_extent_ndims(space) == 1;
    H5Sclose(space);
    if (right) return set;
    H5Dclose(set);
    return -1;
}

/* Numbers one after the other in the set. */
struct slab {
    hid_t there, here;
};

static bool slab_open(hid_t set, size_t from, size_t count, struct slab *slab)
{
    const hsize_t start = from, size = count;
    *slab = (struct slab){H5Dget_space(set), H5Screate_simple(1, &size, NULL)};
    return H5Sselect_hyperslab(slab->there, H5S_SELECT_SET, &start, NULL, &size, NULL) >= 0;
}

static void slab_close(const struct slab *slab)
{
    H5Sclose(slab->here);
    H5Sclose(slab->there);
}

static bool pass_slab(hid_t set, hid_t type, enum set_mode mode, void *data, size_t from, size_t count)
{
    struct slab slab;
    bool good = slab_open(set, from, count, &slab);
    if (good && mode == SET_WRITE)
        good = H5Dwrite(set, type, slab.here, slab.there, H5P_DEFAULT, data) >= 0;
    else if (good)
        good = H5Dread(set, type, slab.here, slab.there, H5P_DEFAULT, data) >= 0;
    slab_close(&slab);
    return good;
}

/* Piece by piece: a checkpoint must not need the memory of another state. */
static bool same(hid_t set, hid_t type, const void *data, size_t from, size_t count)
{
    enum { SLAB = 1 << 16 };
    const size_t width = H5Tget_size(type);
    char *piece = malloc(SLAB * width);
    bool good = piece != NULL;
    for (size_t at = 0; good && at < count; at += SLAB) {
        const size_t size = count - at < SLAB ? count - at : SLAB;
        good = pass_slab(set, type, SET_READ, piece, from + at, size) &&
               memcmp(piece, (const char *)data + at * width, size * width) == 0;
    }
    free(piece);
    return good;
}

bool set_pass(hid_t set, hid_t type, enum set_mode mode, void *data, size_t from, size_t count)
{
    return mode == SET_COMPARE ? same(set, type, data, from, count)
                               : pass_slab(set, type, mode, data, from, count);
}

bool set_compare(hid_t file, const char *name, hid_t type, const void *data, size_t count)
{
    const hid_t set = set_open(file, name, type, count, SET_COMPARE);
    const bool good = set >= 0 && same(set, type, data, 0, count);
    if (set >= 0) H5Dclose(set);
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
