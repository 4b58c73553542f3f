/* run.h5 and the helpers that write into it; shared by the files of this room that speak HDF5. The helpers
 * return false on failure. */
#ifndef SELAS_RUN_FILE_H
#define SELAS_RUN_FILE_H

#include "base/hdf_quiet.h"
#include "record/parts.h"
#include "record/unfinished.h"
#include "record/walk.h"

#include <hdf5.h>

struct run_file {
    char *path, *temporary;
    struct unfinished unfinished; /* its folder, and the lock on that of the results */
    size_t synced;                /* snapshots whose files are known to be on the disk */
};

/* "cannot WHAT 'PATH': ..." with the system's reason, if `error` (errno after the failure) is one. */
selas_status hdf_cannot(const char *what, const char *path, int error, struct messages *messages);
/* New file with `head` bytes before HDF5's own (0, 512, 1024, ...); negative on failure. */
hid_t hdf_create_file(const char *path, size_t head);
hid_t hdf_open_file(const char *path); /* for reading */
/* Together: a file that is there, for all ranks. */
hid_t hdf_open_together(const struct ranks *ranks, const char *path, bool write);
/* An attribute, or a data set where the text is too long for one. */
bool hdf_text(hid_t place, const char *name, const char *text);
bool hdf_numbers(hid_t place, const char *name, size_t count, const double *value);
/* A table whose rows come piece by piece; negative on failure. */
hid_t hdf_rows(hid_t place, const char *name, hid_t type, size_t rows, size_t columns);
/* Rows from `first` on, written (or read). */
bool hdf_rows_pass(hid_t set, bool write, size_t first, size_t rows, size_t columns, double *value);
hid_t hdf_group(hid_t place, const char *name);

/* snapshot_file.c, together: group /points, and /snapshots from the files of their own */
void hdf_points(const struct recorder *recorder, struct walk *walk);
void snapshots_gather(const struct recorder *recorder, struct walk *walk);
/* True if the file of snapshot `number` can be read and shows the time given. */
bool snapshot_file_there(const struct recorder *recorder, size_t number, double time);
/* Brings the files of all snapshots so far on the disk. */
void snapshot_files_sync(const struct recorder *recorder);

/* settings.c: group /settings; provenance.c: group /provenance */
bool write_settings(const struct deck *deck, hid_t file);
bool write_provenance(const struct recorder *recorder, hid_t file, const struct run_figures *figures,
                      struct messages *messages);

#endif
