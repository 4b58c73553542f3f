/* Patches that move along a face at constant velocity, in the consistent method: vectors that follow the
 * time (doc/theory/sources.md). Nothing is allocated after creation. */
#ifndef SELAS_METHOD_CONSISTENT_GALERKIN_MOVING_LOAD_H
#define SELAS_METHOD_CONSISTENT_GALERKIN_MOVING_LOAD_H

#include "method/consistent/galerkin/galerkin.h"

enum { MOVING_SHIFTS = 27 };

struct moving_line {
    double *value;   /* [control values of the axis] */
    size_t from, to; /* others are 0 */
};

struct moving_load {
    size_t load;                                 /* index into scene->loads */
    double centre[3], direction[3], velocity[3]; /* body's frame */
    double half[3];                              /* half edges by axis; 0 across the face and for a point */
    int face;                                    /* axis across the face, along which nothing changes */
    double lag, weight[MOVING_SHIFTS]; /* time from shift to shift of the mean over the way; its weights */
    int terms;                         /* the vector is a sum of so many products of lines: */
    struct moving_line (*line)[3][3];  /* [terms][component][axis] */
    double *work, *shifted;            /* longest axis */
};

/* Weights w_j of the mean over the way, j = 0 to MOVING_SHIFTS - 1, w_-j = w_j (Eq 7a): their sum over all j is 1. */
void moving_weights(double weight[MOVING_SHIFTS]);

/* All loads of the scene that move. SELAS_UNSUPPORTED: neither squares nor points. */
selas_status moving_loads_create(struct consistent *c, struct messages *messages);
void moving_loads_free(struct consistent *c);
/* Puts the patches where they are at a time; with `divided` the lines are multiplied by the H-form's M^-1. */
void moving_loads_place(struct consistent *c, double time, bool divided);
/* Adds amplitude times the vectors in plane k. */
void moving_loads_add(const struct consistent *c, const struct drive *drive, int component, size_t k,
                      double *plane);
/* Power on a velocity, after moving_loads_place(.., false). */
double moving_loads_power(const struct consistent *c, const struct drive *drive, const double *v);

#endif
