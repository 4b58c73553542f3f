/* Exact solution 'plane-wave': d'Alembert's plane waves in a box and bars with loads on their ends. */
#ifndef SELAS_PLANE_WAVE_H
#define SELAS_PLANE_WAVE_H

#include "exact/exact.h"

extern const struct exact_class exact_plane_wave;

/* Time until which a solution of this kind is right at a place: when disturbing faces can be felt; INFINITY
 * if always. */
double plane_wave_until(const struct exact *exact, const double position[3]);

#endif
