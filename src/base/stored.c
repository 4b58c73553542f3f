/* HDF5 data sets that lie in their file itself (see the header). */
#include "base/stored.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Deflate makes at most 1032 bytes of one (zlib's technical notes, "Maximum Compression Factor"). */
static const double most_from_one_byte = 1032.0;

bool stored_here(hid_t place, const char *name)
{
    H5L_info_t link;
    return H5Lexists(place, name, H5P_DEFAULT) > 0 && H5Lget_info(place, name, &link, H5P_DEFAULT) >= 0 &&
           link.type == H5L_TYPE_HARD;
}

static double bytes_of_file(hid_t place)
{
    hsize_t size = 0;
    const hid_t file = H5Iget_file_id(place);
    if (file < 0) return 0;
    if (H5Fget_filesize(file, &size) < 0) size = 0;
    H5Fclose(file);
    return (double)size;
}

/* Bytes that the extent stands for; the product may be beyond all integers. */
static double bytes_of_extent(hid_t set)
{
    hsize_t extent[H5S_MAX_RANK] = {0};
    const hid_t space = H5Dget_space(set), type = H5Dget_type(set);
    double bytes = (double)H5Tget_size(type);
    const int rank = H5Sget_simple_extent_dims(space, extent, NULL);
    for (int k = 0; k < rank; k++)
        bytes *= (double)extent[k];
    H5Tclose(type);
    H5Sclose(space);
    return rank < 0 ? HUGE_VAL : bytes;
}

static bool holds_its_numbers(hid_t place, hid_t set)
{
    const hid_t creation = H5Dget_create_plist(set);
    const bool own = H5Pget_layout(creation) != H5D_VIRTUAL && H5Pget_external_count(creation) == 0;
    const double factor = H5Pget_nfilters(creation) > 0 ? most_from_one_byte : 1.0;
    H5Pclose(creation);
    const double stored = (double)H5Dget_storage_size(set);
    return own && stored <= bytes_of_file(place) && bytes_of_extent(set) <= factor * stored;
}

hid_t stored_set(hid_t place, const char *name)
{
    if (!stored_here(place, name)) return -1;
    const hid_t set = H5Dopen2(place, name, H5P_DEFAULT);
    if (set < 0 || holds_its_numbers(place, set)) return set;
    H5Dclose(set);
    return -1;
}

/* Visits an object of a file; 1 ends the visit, with the fault told. */
static herr_t look_at_filters(hid_t place, const char *name, const H5O_info_t *info, void *context)
{
    char filter[64] = "", *fault = context;
    unsigned flags, settings;
    size_t count = 0;
    if (info->type != H5O_TYPE_DATASET) return 0;
    const hid_t set = H5Dopen2(place, name, H5P_DEFAULT), creation = set < 0 ? -1 : H5Dget_create_plist(set);
    const int filters = creation < 0 ? 0 : H5Pget_nfilters(creation);
    for (int i = 0; i < filters && fault[0] == '\0'; i++) {
        const H5Z_filter_t which =
            H5Pget_filter2(creation, (unsigned)i, &flags, &count, NULL, sizeof filter, filter, &settings);
        if (which < 0 || H5Zfilter_avail(which) > 0) continue;
        snprintf(
            fault, STORED_FAULT,
            "'%.60s' is compressed by '%.40s' (filter %d), which HDF5 here does not have; expected gzip or "
            "none: h5repack -f GZIP=6 FILE NEW where it is",
            name, filter, (int)which);
    }
    if (creation >= 0) H5Pclose(creation);
    if (set >= 0) H5Dclose(set);
    return fault[0] != '\0';
}

bool stored_unpacks(hid_t file, char fault[STORED_FAULT])
{
    fault[0] = '\0';
    H5Ovisit(file, H5_INDEX_NAME, H5_ITER_NATIVE, look_at_filters, fault);
    return fault[0] == '\0';
}

bool stored_begins(const char *path, const char start[4], size_t count)
{
    char found[4] = "";
    FILE *file = fopen(path, "rb");
    const bool same =
        file != NULL && fread(found, 1, count, file) == count && memcmp(found, start, count) == 0;
    if (file != NULL) fclose(file);
    return same;
}

bool stored_is_hdf5(const char *path)
{
    enum { LAST = 1 << 20 };
    char found[8];
    bool same = false;
    FILE *file = fopen(path, "rb");
    for (long at = 0; file != NULL && !same && at <= LAST && fseek(file, at, SEEK_SET) == 0 &&
                      fread(found, sizeof found, 1, file) == 1;
         at = at > 0 ? 2 * at : 512)
        same = memcmp(found, "\x89HDF\r\n\x1a\n", sizeof found) == 0;
    if (file != NULL) fclose(file);
    return same;
}
