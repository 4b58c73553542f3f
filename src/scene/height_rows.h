/* Heights as they stand in a file, before they are laid into a grid (height_map.h). */
#ifndef SELAS_SCENE_HEIGHT_ROWS_H
#define SELAS_SCENE_HEIGHT_ROWS_H

#include "base/messages.h"

#include <stddef.h>

/* Place along the one or two axes (else 0), height. Free row with array_free(). */
struct height_rows {
    size_t count, room;
    double (*row)[3];
};

/* Adds x height or x y height; false: no memory. */
bool height_rows_keep(struct height_rows *rows, const double *value, int axes);
/* Text: lines x height or x y height. HDF5: data sets x [nx], y [ny] and height [nx, ny], or z [ny, nx] as in grids
 * of netCDF-4, packed by scale_factor and add_offset or not; without y in two dimensions. SELAS_FILE_ERROR,
 * SELAS_NO_MEMORY. */
selas_status height_rows_read(const char *path, int axes, struct height_rows *rows,
                              struct messages *messages);

#endif
