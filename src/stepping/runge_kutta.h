/* What the Runge-Kutta schemes share: y' = F(t, y) for every model, and the end of a step.
 *
 * All schemes of this family keep F(t_n, y_n) in work[0] between steps ("first same as last"): the
 * acceleration that receivers see costs no extra call, and a restart from y alone gives the same bits. */
#ifndef SELAS_RUNGE_KUTTA_H
#define SELAS_RUNGE_KUTTA_H

#include "stepping/stepping.h"

#include <complex.h>

/* dydt = F(time, y). A model that has only accelerate() is read as y = [u | v]: F = [v | a(u, v)]. */
void runge_kutta_rate(struct stepper *stepper, double time, const double *y, double *dydt);

/* Start, restart and change of loads in the family: work[0] = F(t, y), state->a. */
void runge_kutta_start(struct stepper *stepper, struct state *state);
#define RUNGE_KUTTA_STARTS .start = runge_kutta_start, .resume = runge_kutta_start, .again = runge_kutta_start

/* Ends a step: time and step count move on, then runge_kutta_start() for the next one. The filter of a model
 * (after_step()) belongs to leapfrog's half-step velocity and is not called: such models are refused. */
void runge_kutta_finish(struct stepper *stepper, struct state *state);

/* out = x + factor * f, for n numbers; out may be x. */
void runge_kutta_add(size_t n, double *out, const double *x, double factor, const double *f);

/* stepping/stability.c: R(z) of a scheme with the given number of stages: y_(n+1) = R(dt lambda) y_n. */
typedef double complex stability_polynomial(double complex z, long stages);

/* Largest dt for which every mode stays bounded: the waves, lambda^2 + d lambda + w^2 = 0 with
 *     w = omega sin(pi theta / 2),   d = theta^2 wave_damping,   0 < theta <= 1,
 * theta being the wave number over that of the fastest wave (a discrete gradient bends over as the sine does,
 * a viscosity grows with the square of the wave number), and the mode with the largest damping, lambda =
 * -viscous. 0 if no dt is stable (|R| > 1 + 1e-9 however small dt), INFINITY if omega = viscous = 0. */
double stability_limit(stability_polynomial *polynomial, long stages, const struct spectrum *spectrum);
/* True if every such mode stays bounded with this dt. */
bool stability_bounded(stability_polynomial *polynomial, long stages, const struct spectrum *spectrum,
                       double dt);

#endif
