/* Weights of mechanisms along few directions, so that a run needs few operators (doc/damping.md, section 3). */
#ifndef SELAS_DAMPING_DIRECTIONS_H
#define SELAS_DAMPING_DIRECTIONS_H

#include "damping/ground.h"

/* Changes the fitted weights by not more, over the band, than a third of `misfit` of what they do, so that they need as few operators as
 * that allows; phase speeds stay what they are where they are given, weights that are not negative stay so. SELAS_NO_MEMORY. */
selas_status damping_directions(struct ground_damping *damping, struct messages *messages);

#endif
