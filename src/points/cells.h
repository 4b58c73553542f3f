/* Voronoi cells in three dimensions (internal to points/). */
#ifndef SELAS_CELLS_H
#define SELAS_CELLS_H

#include "points/cloud.h"

/* Points further from one than this are asked for its cell only where it is larger than half of that. */
static inline double cells_radius(const struct body *body, int dimension)
{
    return (dimension == 2 ? 4 : 3) * body->spacing;
}

/* Volumes of the cells of all points inside the body's box. */
selas_status cells_3d(struct cloud *cloud, const struct body *body, struct messages *messages);

#endif
