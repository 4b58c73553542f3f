/* What a bar's wave looks like, without and with artificial viscosity. */
#ifndef SELAS_BAR_H
#define SELAS_BAR_H

#include "exact/exact.h"

extern const struct exact_class exact_bar;

/* Relative errors sum|e| / sum|v| and sqrt(sum e^2 / sum v^2) of the velocity behind a step front that
 * Monaghan's viscosity has smeared, at time t after it entered the bar at speed c (before it returns). The
 * linear term is, in the continuum, a viscosity that spreads the front like heat with D = alpha c h / 4: v =
 * v0/2 erfc((x - c t) / (2 sqrt(D t))), L1 = 2 sqrt(D t / pi) / (c t),   L2^2 = (2 - sqrt(2)) sqrt(D t / pi)
 * / (c t). */
void bar_smearing(double alpha, double smoothing_length, double speed, double time, double *l1, double *l2);

#endif
