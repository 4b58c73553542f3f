/* HDF5 data sets that lie in their file itself. A file from elsewhere may hold links to other files and
 * extents with nothing behind them; neither is followed, and what is opened here is no larger than the file
 * can hold, so that memory may be taken for it. */
#ifndef SELAS_STORED_H
#define SELAS_STORED_H

#include <hdf5.h>
#include <stdbool.h>

/* True if `name` (one name, no path) in a file or group is there and is no soft or external link. */
bool stored_here(hid_t place, const char *name);
/* Opens the data set `name` in a file or group (H5Dclose); negative if it is not there, is linked from
 * elsewhere, is virtual, keeps its numbers in another file, or has more of them than the file holds. */
hid_t stored_set(hid_t place, const char *name);

enum { STORED_FAULT = 300 };
/* False, with `fault` saying what would be right, if a data set of the file is compressed by what the HDF5 library here
 * does not have: no reader gets at its numbers. */
bool stored_unpacks(hid_t file, char fault[STORED_FAULT]);

/* True if the file begins with the first `count` of these characters. */
bool stored_begins(const char *path, const char start[4], size_t count);
/* True if the file begins as HDF5 files do, or has that behind a user block (of 512 bytes doubled any number of times),
 * as MATLAB's have. */
bool stored_is_hdf5(const char *path);

#endif
