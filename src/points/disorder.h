/* How far scattered points are from a lattice, as waves feel it: what pushes them aside in a uniform stress. */
#ifndef SELAS_DISORDER_H
#define SELAS_DISORDER_H

#include "points/cloud.h"

/* Adds what a uniform unit stress does to point i, off the faces: force per volume, times its spacing. Gradients reach
 * as far as `reach`. On ranks the sums add up. */
void disorder_add(double sums[2], const struct cloud *cloud, const struct body *body, double reach, size_t i,
                  const double force[3]);
/* Mean square of it. */
double disorder_mean(const double sums[2], int dimension);

#endif
