/* The time-dispersion transform: leapfrog's only time error is the warp omega = (2/dt) sin(omega' dt/2).
 * Driving it with warped histories and un-warping what it records gives histories without time error (Wang &
 * Xu 2015; Koene et al. 2018). */
#ifndef SELAS_TIME_DISPERSION_H
#define SELAS_TIME_DISPERSION_H

#include "base/messages.h"
#include "scene/history.h"

/* Warped history: value[stride * i], i = 0..rows-1, at times i dt, such that leapfrog driven by it answers at
 * the warped frequency as the exact equation does at the true one. `integrals` = 1 takes the integral of the
 * history instead (prescribed velocity -> displacement). */
selas_status time_dispersion_warp(const struct history *history, int integrals, double dt, size_t rows,
                                  size_t stride, double *value, struct messages *messages);

/* Un-warps a recorded displacement u[3 * n] (rows at i dt) in place and sets v and a to its exact first and
 * second derivatives. The record must begin at rest. */
selas_status time_dispersion_unwarp(double dt, size_t n, double *u, double *v, double *a,
                                    struct messages *messages);

#endif
