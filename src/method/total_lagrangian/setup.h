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

bool tl_work_allocate(struct tl_work *work, size_t room);
void tl_work_free(struct tl_work *work);
/* Sites within a radius of site i (itself too), ascending, into work->near; false: no memory. */
bool tl_find_near(const struct tl_model *tl, const struct neighbours *near, size_t i, double radius,
                  struct tl_work *work);
/* Layers of a lattice from a face on whose points may have neighbours beyond it within the radius. */
size_t tl_layers_within(const struct scene *scene, const size_t grid[3], double radius);
double tl_distance(const double *a, const double *b);
selas_status tl_no_memory(const struct tl_model *tl, struct messages *messages);

/* What makes the rows of a model. */
struct tl_making {
    struct tl_model *tl;
    struct neighbours near; /* of its sites */
    struct tl_work work;
    double reach; /* largest distance of the neighbours in the gradients */
};

/* Fill tl->gradient, tl->transposed. */
selas_status tl_fill_gradient(struct tl_making *making, struct messages *messages);
selas_status tl_transpose(struct tl_making *making, struct messages *messages);
double tl_reach_of_rows(const struct tl_model *tl);
struct wave_law tl_waves(const struct tl_model *tl);
double tl_largest_spacing(const struct tl_model *tl);
static inline double tl_pair_radius(double largest_spacing)
{
    return 1.6 * (1 + 1e-9) * largest_spacing;
}

/* pairs.c */
selas_status tl_make_hourglass(struct tl_making *making, struct messages *messages);
selas_status tl_make_viscosity(struct tl_making *making, struct messages *messages);

#endif
