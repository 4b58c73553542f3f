/* Neighbours: who is within a radius of whom, for any set of points in 1, 2 or 3 dimensions.
 *
 * Linked cells of the size of the radius; the result is a list per point (compressed rows), sorted by index,
 * and does not depend on the number of threads. */
#ifndef SELAS_NEIGHBOURS_H
#define SELAS_NEIGHBOURS_H

#include "base/messages.h"

#include <stdint.h>

struct neighbours {
    size_t points;
    size_t *start;   /* [points + 1]: neighbours of i stand at start[i] .. start[i + 1] - 1; NULL after
                        neighbours_cells() */
    uint32_t *index; /* [start[points]]: ascending in each row */

    /* the cells, kept for neighbours_at and for the next search; of no concern to users */
    int dimension;
    const double *position; /* borrowed from the last search */
    double radius, corner[3], cell_size[3];
    size_t cells[3];
    size_t *cell_start;    /* [cells + 1] */
    uint32_t *cell_member; /* [points], ascending in each cell */
    uint32_t *cell_of;     /* [points] */
    size_t point_room, pair_room, cell_room;
};

/* Finds all pairs closer than `radius` (distance < radius). position: [3 * points], components beyond the
 * dimension are ignored. With `with_self` each point is a neighbour of itself. `neighbours` is zero before
 * the first call; later calls take memory only where there is not enough. SELAS_NO_MEMORY,
 * SELAS_BAD_ARGUMENT (radius not positive, a position not finite, more than 2^32 - 1 points). */
selas_status neighbours_find(struct neighbours *neighbours, int dimension, size_t points,
                             const double *position, double radius, bool with_self,
                             struct messages *messages);

/* As neighbours_find without self, of the points from .. end - 1: the rows of others are empty. */
selas_status neighbours_find_some(struct neighbours *neighbours, int dimension, size_t points,
                                  const double *position, double radius, size_t from, size_t end,
                                  struct messages *messages);

/* The cells alone, of about the size `radius`, for the functions below. On `neighbours` that are zero. Errors
 * as above. */
selas_status neighbours_cells(struct neighbours *neighbours, int dimension, size_t points,
                              const double *position, double radius, struct messages *messages);

/* As neighbours_at, for any radius. */
size_t neighbours_within(const struct neighbours *neighbours, const double place[3], double radius,
                         size_t room, uint32_t *index);

/* Points closer than the radius of the last search to any place, ascending; at most `room` are written,
 * returns how many there are. The positions of the last search must still be there. */
size_t neighbours_at(const struct neighbours *neighbours, const double place[3], size_t room,
                     uint32_t *index);

/* Point nearest to a place; neighbours->points if there is none within the radius of the last search. */
size_t neighbours_nearest(const struct neighbours *neighbours, const double place[3]);

/* Of `count` sites, ascending, those to which steps of at most 1.9 spacings lead from site `first`, itself among
 * them, from one to the other: sites across a gap or a crack are left out. Returns how many, ascending. position:
 * [3 * sites]. */
typedef double point_spacing(const void *of, size_t site);
size_t points_connected(const double *position, point_spacing *spacing, const void *of, size_t first,
                        size_t count, uint32_t *site);

/* Bytes held. */
size_t neighbours_bytes(const struct neighbours *neighbours);
void neighbours_free(struct neighbours *neighbours);

#endif
