/* Point sources from a file: many places with a force or a moment tensor each (&load sources). */
#ifndef SELAS_POINT_SOURCES_H
#define SELAS_POINT_SOURCES_H

#include "base/messages.h"

struct point_source {
    double position[3];
    double value[6]; /* force x y z, or moment xx yy zz xy yz zx */
    double amplitude, start;
};

struct point_sources {
    size_t count;
    struct point_source *source;
};

/* Reads a file of forces (values 3) or moment tensors (values 6). Text: a source a line, x y z, the values,
 * and if they are there amplitude (1) and start >= 0 (0); '#' or '!' begin comments. HDF5: data sets position
 * [n, 3], force [n, 3] or moment [n, 6], and if they are there amplitude [n] and start [n]. SELAS_FILE_ERROR
 * with file and line. */
selas_status point_sources_read(const char *path, size_t values, struct point_sources *sources,
                                struct messages *messages);
void point_sources_free(struct point_sources *sources);

#endif
