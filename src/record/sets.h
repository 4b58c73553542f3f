/* Arrays of one dimension in HDF5 files: written, read back, and compared with what is in memory. */
#ifndef SELAS_SETS_H
#define SELAS_SETS_H

#include <hdf5.h>
#include <stdbool.h>
#include <stddef.h>

/* `count` numbers of a type as they are in memory; false on failure, or if the file has another number of
 * them. */
bool set_write(hid_t file, const char *name, hid_t type, const void *data, size_t count);
bool set_read(hid_t file, const char *name, hid_t type, void *data, size_t count);
/* True if the file has the same numbers, bit for bit. */
bool set_compare(hid_t file, const char *name, hid_t type, const void *data, size_t count);
/* A text (free it); NULL if there is none or it is beyond all bounds. */
char *set_text(hid_t file, const char *name);

#endif
