/* Voronoi cells in three dimensions (internal to points/). */
#ifndef SELAS_CELLS_H
#define SELAS_CELLS_H

#include "points/cloud.h"

/* Volumes of the cells of all points inside the body's box. */
selas_status cells_3d(struct cloud *cloud, const struct body *body, struct messages *messages);

#endif
