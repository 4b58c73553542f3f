/* run.h5 and the helpers that write into it; shared by run_file.c, provenance.c and checkpoint.c only. The
 * helpers return false on failure. */
#ifndef SELAS_RUN_FILE_H
#define SELAS_RUN_FILE_H

#include "record/parts.h"

#include <hdf5.h>

struct run_file {
    char *path, *temporary;
    hid_t file, snapshots; /* -1 when closed */
    bool complete;         /* has its name */
};

/* HDF5 prints its errors unless it is told not to; the library prints nothing. */
struct quiet {
    H5E_auto2_t function;
    void *data;
};
struct quiet quiet_begin(void);
void quiet_end(struct quiet quiet);

bool hdf_text(hid_t place, const char *name, const char *text);
bool hdf_numbers(hid_t place, const char *name, size_t count, const double *value);
bool hdf_table(hid_t place, const char *name, hid_t type, size_t rows, size_t columns, const double *value);
hid_t hdf_group(hid_t place, const char *name);

/* provenance.c: groups /settings and /provenance */
bool write_provenance(const struct recorder *recorder, hid_t file, const struct run_figures *figures,
                      struct messages *messages);

#endif
