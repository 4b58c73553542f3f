/* The state at t = 0 that &initial asks for, at any place. */
#ifndef SELAS_INITIAL_H
#define SELAS_INITIAL_H

#include "scene/scene.h"

/* Displacement and velocity at `position`; all three in deck coordinates. */
void initial_at(const struct scene *scene, const double position[3], double displacement[3],
                double velocity[3]);

/* Shape of a clamped-free beam's first mode at distance x of the clamp, as He & Seaid (2016) have it in Eq
 * 30: v_y / (c0 V_f); about 1 in magnitude at x = length. */
double beam_mode(double x, double length);

/* kappa L of that mode: the smallest positive root of cos(k) cosh(k) = -1. */
#define BEAM_MODE_ROOT 1.8751040687119611664

#endif
