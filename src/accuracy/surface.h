/* The error of the consistent method at a receiver under loads on the surface of the ground, for
 * scene%accuracy (surface.c; doc/verification/accuracy.md, sections 2 and 3). */
#ifndef SELAS_ACCURACY_SURFACE_H
#define SELAS_ACCURACY_SURFACE_H

#include "scene/scene.h"

enum { SURFACE_ROWS = 4096, SURFACE_LAYERS = 64 };

/* A receiver; lengths in the deck's units. */
struct surface_place {
    double distance, size; /* to the nearest load's centre; that load's shortest edge */
    double rim;            /* to the nearest edge of a patch, INFINITY without one */
    double diagonal;       /* 0 along an axis of the lattice, 1 halfway between two */
    double depth;
    double factor;         /* of what the law says: 1, or what a trial has measured */
    double tried, reached; /* a trial's spacing (0: none) and the error there, which falls ... */
    double order;          /* ... with this power of the spacing at most */
    double *power; /* [SURFACE_ROWS / 2 + 1] sum over components of |V|^2 at 2 pi j / (1.25 end_time) */
};

/* What the errors of a scene follow from. */
struct surface_ground {
    bool tuned;            /* splines of degree 4 tuned along the surface; else degree 2 with three sweeps */
    double rayleigh_speed; /* of the slowest layer */
    double p_speed;        /* of the fastest */
    size_t layers;         /* 1: one material; more than SURFACE_LAYERS are looked at as far as that */
    double top[SURFACE_LAYERS], slowness[SURFACE_LAYERS]; /* of each layer's Rayleigh wave */
};

/* Splines are tuned on layered ground without absorbing layers, that is, where no echo could be seen with
 * `spacing` or a smaller one. */
struct surface_ground surface_ground_of(const struct scene *scene, double spacing);

/* Expected relative L2 error of the velocity there until end_time with spacing h. */
double surface_error(const struct surface_place *place, double h, double end_time,
                     const struct surface_ground *ground);

#endif
