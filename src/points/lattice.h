/* Points of a box that include points on its faces: on a lattice, with jitter and rotation, or given ones. */
#ifndef SELAS_LATTICE_H
#define SELAS_LATTICE_H

#include "scene/scene.h"

struct point_set {
    int dimension;
    size_t points;
    size_t grid[3];       /* points per axis (x fastest), 1 beyond the dimension; 0, 0, 0 for given points */
    double spacing[3];    /* of the lattice before jitter; for given points the body's spacing */
    double *position;     /* [3 * points], deck coordinates (rotated with the body) */
    double *own_position; /* [3 * points], the body's own frame */
    unsigned char *faces; /* [points]: bit 1 << face for each box face the point lies on */
};

/* Lattice with points on the faces: round(length / spacing) intervals per axis, at least one; the spacing is
 * fitted to the length. With jitter each coordinate of a point that is not held by a face moves by up to
 * body->jitter times the spacing to either side: points of a face stay in it, of an edge on it, corners at
 * rest. The displacement is a function of seed, index and axis alone. SELAS_NO_MEMORY, SELAS_BAD_SCENE. */
selas_status lattice_create(const struct body *body, int dimension, struct point_set *set,
                            struct messages *messages);
/* The same from given points of the body (its own frame, [3 * points]); those within 1e-6 spacings of a face
 * lie on it. SELAS_BAD_SCENE if a point lies outside the box or no point on one of its faces. */
selas_status point_set_from_positions(const struct body *body, int dimension, size_t points,
                                      const double *own_position, struct point_set *set,
                                      struct messages *messages);
void point_set_free(struct point_set *set);

/* Reproducible number in [0, 1) from a seed and a counter (splitmix64 of Steele, Lea & Flood 2014). */
double random_uniform(unsigned long seed, unsigned long counter);

/* Number of box faces in a mask. */
int faces_count(unsigned char faces);

#endif
