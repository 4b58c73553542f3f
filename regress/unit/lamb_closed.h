/* The half-space's surface under a vertical patch load in closed form, in the time domain: the independent
 * check of lamb_fft.c (nothing but the patch is shared with it). Surface points only. */
#ifndef LAMB_CLOSED_H
#define LAMB_CLOSED_H

#include "base/messages.h"
#include "exact/patch.h"
#include "scene/history.h"

#include <complex.h>

enum { LAMB_CLOSED_INTERVALS = 3, LAMB_CLOSED_TERMS = 72 };

struct lamb_closed {
    double mu, s_speed;
    double ratio;                                          /* a = (cs/cp)^2 */
    double complex root[3];                                /* y_j of the cubic (Eq 3 of lamb_closed.c) */
    double complex p[3], s[3];                             /* B_j, C_j */
    int rayleigh;                                          /* which root is the Rayleigh wave's */
    double horizontal;                                     /* C_R */
    double area[LAMB_CLOSED_INTERVALS][LAMB_CLOSED_TERMS]; /* Chebyshev series of W (Eq 6) */
};

selas_status lamb_closed_set(struct lamb_closed *closed, double density, double lambda, double mu,
                             struct messages *messages);

/* Point load: u_z = Z(tau)/(2 pi mu r), u_r = X(tau)/(2 pi mu r) under a unit step, tau = cs t / r. */
double lamb_closed_point_vertical(const struct lamb_closed *closed, double tau);
double lamb_closed_point_radial(const struct lamb_closed *closed, double tau);

/* Displacement ux uy uz at (x, y) from the patch's centre, time t after a unit step of vertical traction was
 * laid on the patch (rectangle or disc). */
selas_status lamb_closed_step(const struct lamb_closed *closed, const struct patch *patch, double x, double y,
                              double t, double displacement[3], struct messages *messages);

/* Velocity (3 * n values) under vertical traction of a history that starts without a jump. Piecewise linear
 * histories exactly; others by quadrature between the arrivals. */
selas_status lamb_closed_velocity(const struct lamb_closed *closed, const struct patch *patch, double x,
                                  double y, const struct history *history, size_t n, const double *time,
                                  double *velocity, struct messages *messages);

#endif
