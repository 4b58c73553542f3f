/* Spacing that grows over depth with the speed of the rock (doc/theory/graded-spacing.md): the lattice is even in
 * zeta, from one face across depth to the other, and the ground's own depth is
 *
 *   z = Z(zeta),   Z' straight from knot to knot,                                                       (G18)
 *
 * a spline of degree 2 with the knots of the lattice; lattice_from_deck() and lattice_to_deck() go through the map.
 * Z is a depth of the body's own frame, that of level ground. */
#ifndef SELAS_SCENE_GRADING_H
#define SELAS_SCENE_GRADING_H

#include "scene/scene.h"

struct grading {
    int axis;
    size_t cells;            /* over depth */
    double low, step;        /* of zeta: from the plane of the upper face on */
    double *place, *stretch; /* [cells + 1] z and Z' at the knots */
    double largest;          /* distance of points over depth */
    double from;             /* depth where it begins to grow */
};

/* Of all of these NULL is an even lattice. */
double grading_real(const struct grading *grading, double lattice);
double grading_lattice(const struct grading *grading, double real);
double grading_stretch(const struct grading *grading,
                       double lattice); /* Z', beyond the ends that of the end */
void grading_free(struct grading *grading);

/* Lays body.grading for body.most_stretch and the scene's ground anew; an even lattice where the rock gives no reason
 * for another. SELAS_NO_MEMORY. */
selas_status scene_grade(struct scene *scene);
/* What share of an even lattice's points a grading of GRADING_MEASURED leaves out. */
double grading_saves(const struct scene *scene);
/* The largest that errors were measured with, and the share of the work from which on it is worth its while (G20b). */
#define GRADING_MEASURED 3.0
#define GRADING_WORTH 0.2

#endif
