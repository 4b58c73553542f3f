/* The state at t = 0, for all methods and for exact solutions.
 *
 *   rest              u = v = 0
 *   uniform-velocity  u = 0, v = velocity
 *   plane-wave        u = A p F(s), v = -A c p F'(s) with s = n.(x - centre): travels along n unchanged.
 *                     train: F(s) = sin(2 pi s / wavelength); pulse: F(s) = exp(-s^2 / (2 width^2));
 *                     c and p: p_speed and n (P), s_speed and a unit vector across n (S)
 *   gaussian          u = A d exp(-|x - centre|^2 / (2 width^2)), v = 0
 *   beam-mode         u = 0, v = A c0 e_y [M (cos kx - cosh kx) - N (sin kx - sinh kx)] / Q
 *                     (He & Seaid 2016, Eq 30; x and y in the body's frame, x from its x- face) */
#ifndef SELAS_INITIAL_H
#define SELAS_INITIAL_H

#include "scene/scene.h"

/* Displacement and velocity at t = 0 at a position, all in the deck's coordinates. */
void initial_at(const struct scene *scene, const double position[3], double displacement[3],
                double velocity[3]);

/* A F(s) of a plane wave (derivative 0) or A F'(s) (derivative 1). */
double plane_wave_shape(const struct initial *initial, double s, int derivative);
/* Speed c of the plane wave in the body's material. */
double plane_wave_speed(const struct scene *scene);

/* Shape of a clamped-free beam's first bending mode at distance x from the clamp: the bracket of He & Seaid's
 * Eq 30 over Q; 0 at x = 0, 1 at x = length. */
double beam_mode(double x, double length);

/* kappa L of that mode: the smallest positive root of cos(k) cosh(k) = -1. */
#define BEAM_MODE_ROOT 1.8751040687119611664

#endif
