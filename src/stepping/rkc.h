/* Runge-Kutta-Chebyshev: the coefficients and the choice of stages. */
#ifndef SELAS_RKC_H
#define SELAS_RKC_H

#include "stepping/runge_kutta.h"

/* Coefficients of stage j >= 1; y_j = mu y_(j-1) + nu y_(j-2) + (1 - mu - nu) y_0 + dt (mu_rate F_(j-1) +
 * gamma F_0), with mu = nu = gamma = 0 at j = 1; time is c_(j): y_j belongs to t + c dt. */
struct rkc_stage {
    double mu, nu, mu_rate, gamma, time;
};

/* Walks through the stages of the scheme with s >= 2 stages: Chebyshev polynomials and two derivatives at
 * q0 by their recursions. */
struct rkc_walk {
    long stages, stage;
    double q0, q1;                      /* q0 = 1 + epsilon/s^2, q1 = T_s'(q0) / T_s''(q0) */
    double value[2], slope[2], bend[2]; /* T, T', T'' of degrees stage and stage - 1 */
    double b[2];                        /* b of degrees stage and stage - 1 */
};
struct rkc_walk rkc_begin(long stages);
struct rkc_stage rkc_next(struct rkc_walk *walk);

/* R(z) = 1 - b_s T_s(q0) + b_s T_s(q0 + q1 z). */
double complex rkc_polynomial(double complex z, long stages);

/* Number of stages of He & Seaid (2016) for a step dt. Eq 28, s = 1 + [sqrt(1 + CFL / .131)] with CFL = c0 dt
 * / spacing, is Eq 26 with the Gerschgorin bound 4.985 c0 / spacing put in for the spectral radius, which is
 * the one of the artificial viscosity at alpha = 2.5, not that of the waves. At least 2. */
long rkc_paper_stages(double courant);
/* Eq 26 with a spectral radius: s = 1 + [sqrt(1 + dt radius / .653)], at least 2. */
long rkc_radius_stages(double dt_radius);

/* Fewest stages (2 ... max_stages) that are stable for dt; 0 if there are none. */
long rkc_stages_for(double dt, const struct spectrum *spectrum, long max_stages);
/* Number of stages (2 ... max_stages) with the longest stable step per call; *limit gets that step. 0 if no
 * number of stages is stable (no viscosity). */
long rkc_best_stages(const struct spectrum *spectrum, long max_stages, double *limit);

#endif
