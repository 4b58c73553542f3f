/* Arrays in HDF5 files (see the header). */
#include "record/sets.h"

#include "base/stored.h"

#include <stdlib.h>
#include <string.h>

hid_t set_make(hid_t file, const char *name, hid_t type, int dimensions, const hsize_t *size)
{
    const hid_t space = H5Screate_simple(dimensions, size, NULL), creation = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_alloc_time(creation, H5D_ALLOC_TIME_EARLY);
    H5Pset_fill_time(creation, H5D_FILL_TIME_NEVER);
    const hid_t set = H5Dcreate2(file, name, type, space, H5P_DEFAULT, creation, H5P_DEFAULT);
    H5Pclose(creation);
    H5Sclose(space);
    return set;
}

/* The set, if it has so many numbers. */
static hid_t of_size(hid_t set, size_t count)
{
    if (set < 0) return set;
    const hid_t space = H5Dget_space(set);
    const bool right =
        H5Sget_simple_extent_npoints(space) == (hssize_t)count && H5Sget_simple_extent_ndims(space) == 1;
    H5Sclose(space);
    if (right) return set;
    H5Dclose(set);
    return -1;
}

hid_t set_open(hid_t file, const char *name, hid_t type, size_t count, enum set_mode mode)
{
    const hsize_t size = count;
    return mode == SET_WRITE ? set_make(file, name, type, 1, &size) : of_size(stored_set(file, name), count);
}

hid_t set_open_known(hid_t file, const char *name, size_t count)
{
    return of_size(H5Dopen2(file, name, H5P_DEFAULT), count);
}

static bool choose(hid_t space, size_t from, size_t step, const struct set_part *part)
{
    const hsize_t start = from, count = part->times, block = part->count, stride = count > 1 ? step : block;
    return H5Sselect_hyperslab(space, H5S_SELECT_SET, &start, &stride, &count, &block) >= 0;
}

bool set_pass_part(hid_t set, hid_t type, bool write, void *data, const struct set_part *part)
{
    const hsize_t extent = (part->times - 1) * part->here_step + part->count;
    const hid_t there = H5Dget_space(set), here = H5Screate_simple(1, &extent, NULL);
    char *from = (char *)data + part->here * H5Tget_size(type);
    bool good = choose(there, part->there, part->there_step, part) && choose(here, 0, part->here_step, part);
    if (good && write)
        good = H5Dwrite(set, type, here, there, H5P_DEFAULT, from) >= 0;
    else if (good)
        good = H5Dread(set, type, here, there, H5P_DEFAULT, from) >= 0;
    H5Sclose(here);
    H5Sclose(there);
    return good;
}

static bool pass_slab(hid_t set, hid_t type, bool write, void *data, size_t from, size_t count)
{
    const struct set_part part = {.there = from, .count = count, .times = 1};
    return set_pass_part(set, type, write, data, &part);
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
        good = pass_slab(set, type, false, piece, from + at, size) &&
               memcmp(piece, (const char *)data + at * width, size * width) == 0;
    }
    free(piece);
    return good;
}

bool set_pass(hid_t set, hid_t type, enum set_mode mode, void *data, size_t from, size_t count)
{
    return mode == SET_COMPARE ? same(set, type, data, from, count)
                               : pass_slab(set, type, mode == SET_WRITE, data, from, count);
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
