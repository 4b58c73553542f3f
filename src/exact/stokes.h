/* Reference kind 'stokes': point sources in an infinite solid. */
#ifndef SELAS_STOKES_H
#define SELAS_STOKES_H

#include "exact/exact.h"

extern const struct exact_class exact_stokes;

struct solid {
    double density, p_speed, s_speed;
};

/* Adds displacement and velocity at time t, at `away` (not 0) from a point force or a moment tensor, in the
 * deck's axes. */
void stokes_add(const struct solid *solid, const struct load *load, const double away[3], double t,
                double value[6]);

#endif
