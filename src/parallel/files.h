/* HDF5 files that ranks open together. Alone (alone.c) these do nothing. */
#ifndef SELAS_PARALLEL_FILES_H
#define SELAS_PARALLEL_FILES_H

#include "parallel/ranks.h"

#include <hdf5.h>

/* Files opened with these properties are opened, closed, and asked for what is in them, by all ranks together. */
void ranks_open_together(const struct ranks *ranks, hid_t access);
/* Numbers are written and read by all ranks together: each its part, or none. */
void ranks_pass_together(const struct ranks *ranks, hid_t transfer);

#endif
