/* Weights of mechanisms along few directions, so that a run needs few operators (doc/theory/damping.md, section 3). */
#ifndef SELAS_DAMPING_DIRECTIONS_H
#define SELAS_DAMPING_DIRECTIONS_H

#include "damping/ground.h"

/* Bulk (0) and shear modulus (1) with their weights. */
struct damping_column {
    double size, weight[MOST_MECHANISMS];
    double length; /* what it does to waves over the band: of kappa with what mu does to the same waves */
};
/* Lengths are left 0. */
void damping_columns(size_t mechanisms, const struct damped_moduli *moduli, struct damping_column column[2]);

/* Changes the fitted weights by not more, over the band, than a third of `misfit` of what they do, so that
 * they need as few operators as that allows; phase speeds stay what they are where they are given, weights
 * that are not negative stay so. SELAS_NO_MEMORY. */
selas_status damping_directions(struct ground_damping *damping, struct messages *messages);

#endif
