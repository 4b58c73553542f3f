/* The state at t = 0, for all methods and for exact solutions.
 *
 *   rest              u = v = 0
 *   uniform-velocity  u = 0, v = velocity
 *   plane-wave        u = A p F(s), v = -A c p F'(s) with s = n.(x - centre): travels along n unchanged.
 *                     train: F(s) = sin(2 pi s / wavelength); pulse: F(s) = exp(-s^2 / (2 width^2));
 *                     c and p: p_speed of the place and n (P), s_speed and a unit vector across n (S)
 *   gaussian          u = A d exp(-|x - centre|^2 / (2 width^2)), v = 0
 *   beam-mode         u = 0, v = A c0 e_y f(x), f the first bending mode of Euler and Bernoulli's beam with the ends
 *                     of the scene; x and y in the body's frame, x from its x- face */
#ifndef SELAS_INITIAL_H
#define SELAS_INITIAL_H

#include "scene/scene.h"

/* Displacement and velocity at t = 0 at a position, all in the deck's coordinates. */
void initial_at(const struct scene *scene, const double position[3], double displacement[3],
                double velocity[3]);

/* A F(s) of a plane wave (derivative 0) or A F'(s) (derivative 1). */
double plane_wave_shape(const struct initial *initial, double s, int derivative);
/* Speeds of P and S waves in the rock at the middle of a plane wave's front, else at the state's centre. */
void initial_speeds(const struct scene *scene, double speed[2]);
/* That of the plane wave, else of P waves. */
double plane_wave_speed(const struct scene *scene);

/* How a beam is held at its faces x- and x+. */
enum beam_ends {
    BEAM_CLAMPED_FREE,     /* x- fixed, x+ free */
    BEAM_CLAMPED_CLAMPED,  /* both fixed */
    BEAM_SIMPLY_SUPPORTED, /* both held across the beam (along y) and free along it */
    BEAM_FREE_FREE,
    BEAM_ENDS /* none of these */
};
enum beam_ends beam_ends_of(const struct scene *scene);
/* "clamped-free", ... */
const char *beam_ends_name(enum beam_ends ends);

/* Shape of the first bending mode at distance x from the face x- (derivative 0), or its slope (1). Clamped-free: the
 * bracket of He & Seaid's Eq 30 over Q, 1 at x = length; the others (Blevins 1979, Table 8-1) are 1 in the middle or,
 * free-free, at the ends. */
double beam_mode(enum beam_ends ends, double x, double length, int derivative);

/* kappa L of that mode: the smallest positive root of cos(k) cosh(k) = -1 (clamped-free), cos(k) cosh(k) = 1 (clamped-
 * clamped and free-free), sin(k) = 0. */
double beam_mode_root(enum beam_ends ends);

#endif
