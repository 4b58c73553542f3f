/* Absorbing layers of the general operator (layers.c): what steps by sweeps make of them row by row. */
#ifndef SELAS_METHOD_CONSISTENT_GENERAL_LAYERS_H
#define SELAS_METHOD_CONSISTENT_GENERAL_LAYERS_H

#include "method/consistent/general/general.h"
#include "method/consistent/general/moments.h"

struct general_layer {
    int slot;
    bool high;
    size_t width; /* cells */
    const struct slab *slab;
    size_t at[3][3], n[3][3];   /* [family][slot] of its points */
    double *damping[2];         /* [at] at its points along the slot, ... */
    double *kept[2], *taken[2]; /* ... and what a step makes of it: psi := kept psi - taken slope */
    size_t psi[3], points[3];   /* [family] place in extra; points */
    struct moment_rows rows;
};

/* Factors of a step dt: of all psi and phi, and of velocities that layers damp besides. */
void general_layers_prepare(struct consistent *c, double dt);
/* Points of a layer in row j of plane m of a family: those from *first to *end - 1 that lie in it, which becomes
 * *first .. *end - 1; *psi: where the memory of component 0 begins in the state's extra part, that of component i being
 * i * points[family] behind. False: none do. */
bool general_layer_points(const struct general_layer *layer, int family, size_t j, size_t m, size_t *first,
                          size_t *end, size_t *psi);
/* Which entry of kept[] and taken[] point i of row j in plane m has; along x those of the points after it follow. */
size_t general_layer_place(const struct general_layer *layer, int family, size_t i, size_t j, size_t m);
/* Numbers of phi of a slab stand from here on in g->pulled and g->middle. */
size_t general_layer_moments(const struct consistent *c, const struct slab *slab);
/* Where row j of plane k stands in the numbers of a component of a slab; false: not there. */
bool general_layer_row(const struct slab *slab, size_t j, size_t k, size_t *at);
/* A row of f at the end of a step, n numbers whose first is number `at` of all moments: in the state it takes the place
 * of that at its start, and in g->pulled stands that of the middle (G13b). */
void general_layers_take(const struct consistent *c, size_t at, size_t n, const double *end, double *extra);

#endif
