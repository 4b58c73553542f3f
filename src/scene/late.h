/* Displacements long after a pulse between absorbing layers (doc/theory/absorbing-faces.md, section 7). */
#ifndef SELAS_SCENE_LATE_H
#define SELAS_SCENE_LATE_H

#include "scene/scene.h"

/* The worst of all pairs of a load's pulse and what looks at it, over a face. */
struct late {
    double lasts, time; /* of the pulse; from its middle to the end; 0: no load is one */
    double way, apart;  /* over the face, and straight */
    double image;       /* over the face, by the mirror image across a symmetry plane opposite */
};
struct lates {
    struct late of_force, of_dipole;
};
struct lates late_worst(const struct scene *scene, int face);

/* What layers of so many points behind a face may make displacements err by, of the largest, without what the lattice
 * adds in space (18c). */
double late_of_points(const struct scene *scene, int face, const struct lates *lates, size_t points);
/* With that, of all faces as they are. */
double late_error(const struct scene *scene);
/* The least points of each layer with which that is too little to be told; 0: not even the most do. */
long late_points(const struct scene *scene);

/* An error that the plan tells. */
#define LATE_TOLD .003

#endif
