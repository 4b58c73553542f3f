/* Exact solution 'plane-wave': d'Alembert's plane waves in a box and bars with loads on their ends. */
#ifndef SELAS_PLANE_WAVE_H
#define SELAS_PLANE_WAVE_H

#include "exact/exact.h"

extern const struct exact_class exact_plane_wave;

#endif
