/* HDF5 prints its errors unless it is told not to; the library prints nothing. */
#ifndef SELAS_BASE_HDF_QUIET_H
#define SELAS_BASE_HDF_QUIET_H

#include <hdf5.h>

struct quiet {
    H5E_auto2_t function;
    void *data;
};
/* errno is 0 from then on. */
struct quiet quiet_begin(void);
void quiet_end(struct quiet quiet);

#endif
