/* Set-up of total-Lagrangian SPH: what its files share. */
#ifndef SELAS_METHOD_TOTAL_LAGRANGIAN_SETUP_H
#define SELAS_METHOD_TOTAL_LAGRANGIAN_SETUP_H

#include "method/total_lagrangian/total_lagrangian.h"

/* Room for the sites near one point. */
struct tl_work {
    size_t room, found;
    uint32_t *near, *index;
    double *offset, *weight, *gradient, *fit;
};

/* Sites within a radius of site i (itself too), ascending, into work->near; false: no memory. */
bool tl_find_near(const struct tl_model *tl, const struct neighbours *near, size_t i, double radius,
                  struct tl_work *work);
/* Layers of a lattice from a face on whose points may have neighbours beyond it within the radius. */
size_t tl_layers_within(const struct tl_model *tl, double radius);
double tl_distance(const double *a, const double *b);
selas_status tl_no_memory(const struct tl_model *tl, struct messages *messages);

/* pairs.c. `radius`: the largest distance of a pair. */
selas_status tl_make_hourglass(struct tl_model *tl, double radius, const struct neighbours *near,
                               struct tl_work *work, struct messages *messages);
selas_status tl_make_viscosity(struct tl_model *tl, const struct neighbours *near, struct tl_work *work,
                               struct messages *messages);

#endif
