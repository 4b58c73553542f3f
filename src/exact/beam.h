/* First bending mode of a beam: frequencies. */
#ifndef SELAS_BEAM_H
#define SELAS_BEAM_H

#include "exact/exact.h"
#include "scene/initial.h"

extern const struct exact_class exact_beam;

/* A beam of rectangular section: length, width in the plane of bending, effective Young's modulus (E / (1 -
 * nu^2) in plane strain), shear modulus, density, Poisson's ratio. */
struct beam {
    double length, width, young, shear, density, poisson;
    enum beam_ends ends;
};

struct beam beam_of(const struct scene *scene);
/* sqrt(E W^2 kappa^4 / (12 rho)), kappa L = beam_mode_root() (He & Seaid 2016, Eq 31) [rad per time]. */
double beam_euler_bernoulli(const struct beam *beam);
/* With shear and rotary inertia, shear factor 10 (1 + nu) / (12 + 11 nu) of Cowper (1966). */
double beam_timoshenko(const struct beam *beam);
/* Two-dimensional elasticity of the clamped-free beam where it is known (numerics B4: L / W = 5 and 10,
 * poisson .35 or .3975, by two finite-element programs, 2e-5): 0 elsewhere. */
double beam_plane(const struct scene *scene);

#endif
