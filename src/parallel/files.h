/* HDF5 files that ranks open together. Alone (alone.c) this does nothing. */
#ifndef SELAS_PARALLEL_FILES_H
#define SELAS_PARALLEL_FILES_H

#include "parallel/ranks.h"

#include <hdf5.h>

/* Files opened with these properties are opened, closed, and asked for what is in them, by all ranks together; numbers
 * each rank writes and reads by itself. */
void ranks_open_together(const struct ranks *ranks, hid_t access);

#endif
