/* Kirsch's plate: a circular hole in an infinite plate under tension. */
#ifndef SELAS_HOLE_H
#define SELAS_HOLE_H

#include "exact/exact.h"

extern const struct exact_class exact_hole;

/* Displacement x y at (x, y) from the hole's centre, |(x, y)| >= radius, under the far stress `far` along x;
 * kappa = (3 - nu) / (1 + nu) in plane stress, 3 - 4 nu in plane strain. */
void hole_displacement(double far, double radius, double mu, double kappa, double x, double y,
                       double displacement[2]);

#endif
