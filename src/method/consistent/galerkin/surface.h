/* The map of a lattice below a surface that is not level or graded over depth, and its metric
 * (doc/theory/topography.md, graded-spacing.md). */
#ifndef SELAS_METHOD_CONSISTENT_GALERKIN_SURFACE_H
#define SELAS_METHOD_CONSISTENT_GALERKIN_SURFACE_H

#include "method/consistent/galerkin/galerkin.h"

/* The metric of the map at a place (G17): slopes along the axes are g_s - tilt_s g_z for the slots of the surface and
 * `inverse` g_z along depth, g along the lattice; a cell has `jacobian` times its volume. */
struct metric {
    double tilt[2], inverse, jacobian;
};

/* Metric of a place of the lattice, by axis; 0, 1, 1 on an even lattice below a level surface. */
struct metric consistent_metric(const struct consistent *c, const double place[3]);
/* From Z', s and its slopes, f and its slope over Z. */
struct metric metric_of(double stretch, double drop, const double slope[2], double share, double fall);
/* A place of the lattice becomes one of the ground, by axis. */
void consistent_to_ground(const struct consistent *c, double place[3]);
/* The same below a surface whose s there is known. */
void consistent_to_ground_below(const struct consistent *c, double drop, double place[3]);
/* s at a place of the lattice, by axis, 0 below a level surface; its slopes by slot, unless slope is NULL. */
double consistent_drop(const struct consistent *c, const double place[3], double slope[2]);

/* Slopes along the lattice become those along the axes; stresses the pulls along the lattice. By slot. */
static inline void metric_tilt(const struct metric *metric, double slope[3])
{
    slope[0] -= metric->tilt[0] * slope[2];
    slope[1] -= metric->tilt[1] * slope[2];
    slope[2] *= metric->inverse;
}
static inline double metric_pull(const struct metric *metric, const double stress[3])
{
    return metric->inverse * stress[2] - metric->tilt[0] * stress[0] - metric->tilt[1] * stress[1];
}

#endif
