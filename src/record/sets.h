/* Arrays of one dimension in HDF5 files: written, read back, and compared with what is in memory. */
#ifndef SELAS_SETS_H
#define SELAS_SETS_H

#include <hdf5.h>
#include <stdbool.h>
#include <stddef.h>

/* What is done with numbers in memory and in a file. SET_COMPARE: are they the same bit for bit? */
enum set_mode { SET_WRITE, SET_READ, SET_COMPARE };

/* Numbers of a set and where they are in memory: `times` times `count` of them, from `here` on in memory, from
 * `there` on in the set; the next time here_step and there_step further. */
struct set_part {
    size_t here, there, count, times, here_step, there_step;
};

/* A new set, which has its place in the file at once: those who write it may be others. */
hid_t set_make(hid_t file, const char *name, hid_t type, int dimensions, const hsize_t *size);
/* A set of `count` numbers of a type as they are in memory: a new one, or (not SET_WRITE) one that is there and
 * has so many. Close it with H5Dclose; negative on failure. */
hid_t set_open(hid_t file, const char *name, hid_t type, size_t count, enum set_mode mode);
/* A set that set_open has found or made in this file. */
hid_t set_open_known(hid_t file, const char *name, size_t count);
/* `count` of its numbers, from `from` on; false on failure, or if they differ. */
bool set_pass(hid_t set, hid_t type, enum set_mode mode, void *data, size_t from, size_t count);
/* A part of its numbers; data: the memory that `here` counts from. */
bool set_pass_part(hid_t set, hid_t type, bool write, void *data, const struct set_part *part);
/* True if the file has a set of the very same numbers. */
bool set_compare(hid_t file, const char *name, hid_t type, const void *data, size_t count);
/* A text (free it); NULL if there is none or it is beyond all bounds. */
char *set_text(hid_t file, const char *name);

#endif
