/* Bytes that tell what to do with an HDF5 file: data sets of any name, type, extent and layout, links. The
 * structure of the file stays sound: that of HDF5's own bytes is HDF5's to check (and checkpoints have a
 * checksum over them). */
#ifndef SELAS_FUZZ_HDF5_H
#define SELAS_FUZZ_HDF5_H

#include "fuzz.h"

#include <hdf5.h>
#include <string.h>

struct fuzz_bytes {
    const uint8_t *at;
    size_t left;
};

static inline uint8_t fuzz_byte(struct fuzz_bytes *bytes)
{
    if (bytes->left == 0) return 0;
    bytes->left--;
    return *bytes->at++;
}

/* An extent: small ones by a byte, hostile ones by a power of two. */
static inline hsize_t fuzz_extent(struct fuzz_bytes *bytes)
{
    const uint8_t byte = fuzz_byte(bytes);
    return byte < 192 ? byte % 32 : (hsize_t)1 << (byte - 192);
}

static inline hid_t fuzz_type(uint8_t byte)
{
    const hid_t types[8] = {H5T_NATIVE_DOUBLE, H5T_NATIVE_DOUBLE, H5T_NATIVE_CHAR, H5T_NATIVE_UCHAR,
                            H5T_NATIVE_INT,    H5T_NATIVE_FLOAT,  H5T_STD_REF_OBJ, H5T_C_S1};
    return types[byte % 8];
}

/* Numbers for a small set: the bytes again and again, or ones. */
static inline void fuzz_fill(hid_t set, hid_t type, size_t count, struct fuzz_bytes *bytes)
{
    static double block[4096];
    const size_t room = sizeof block / sizeof *block;
    const bool raw = fuzz_byte(bytes) % 2 == 1;
    if (count > room || H5Tequal(type, H5T_STD_REF_OBJ) > 0) return;
    for (size_t i = 0; i < room; i++)
        block[i] = raw ? 0 : (double)(i + 1) / 8;
    if (raw) memcpy(block, bytes->at, bytes->left < 64 ? bytes->left : 64);
    H5Dwrite(set,
             H5Tequal(type, H5T_C_S1) > 0 ? H5T_C_S1
             : raw                        ? type
                                          : H5T_NATIVE_DOUBLE,
             H5S_ALL, H5S_ALL, H5P_DEFAULT, block);
}

static inline void fuzz_set(hid_t place, const char *name, struct fuzz_bytes *bytes)
{
    const uint8_t how = fuzz_byte(bytes);
    const int rank = how % 4;
    hsize_t extent[3] = {1, 1, 1}, chunk[3] = {4, 4, 4};
    double count = 1;
    for (int k = 0; k < rank; k++) {
        extent[k] = fuzz_extent(bytes);
        count *= (double)extent[k];
    }
    const hid_t type = fuzz_type(fuzz_byte(bytes)), creation = H5Pcreate(H5P_DATASET_CREATE);
    const hid_t space = rank > 0 ? H5Screate_simple(rank, extent, NULL) : H5Screate(H5S_SCALAR);
    if (how & 4 && rank > 0) H5Pset_chunk(creation, rank, chunk);
    if (how & 8 && how & 4 && rank > 0) H5Pset_deflate(creation, 6);
    if (how & 16) H5Pset_external(creation, "/proc/self/maps", 0, H5F_UNLIMITED);
    const hid_t set =
        space < 0 ? -1 : H5Dcreate2(place, name, type, space, H5P_DEFAULT, creation, H5P_DEFAULT);
    if (set >= 0 && count <= 4096 && !(how & 16)) fuzz_fill(set, type, (size_t)count, bytes);
    if (set >= 0) H5Dclose(set);
    if (space >= 0) H5Sclose(space);
    H5Pclose(creation);
}

/* One thing is done to the file for every two bytes or so. */
static inline void fuzz_work(hid_t place, size_t names, const char *const *name, struct fuzz_bytes *bytes)
{
    for (int k = 0; k < 6 && bytes->left > 0; k++) {
        const uint8_t what = fuzz_byte(bytes);
        const char *one = name[fuzz_byte(bytes) % names], *other = name[fuzz_byte(bytes) % names];
        if (what % 8 != 0) H5Ldelete(place, one, H5P_DEFAULT);
        if (what % 8 == 2) H5Lcreate_external("/proc/self/fd/0", other, place, one, H5P_DEFAULT, H5P_DEFAULT);
        if (what % 8 == 3) H5Lcreate_soft(other, place, one, H5P_DEFAULT, H5P_DEFAULT);
        if (what % 8 == 4) H5Lcreate_hard(place, other, place, one, H5P_DEFAULT, H5P_DEFAULT);
        if (what % 8 == 5) H5Gclose(H5Gcreate2(place, one, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT));
        if (what % 8 > 5 || what % 8 == 0) fuzz_set(place, one, bytes);
    }
}

#endif
