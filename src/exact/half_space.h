/* The homogeneous elastic half-space z >= 0, z down, with tractions on its surface: compliances in
 * (wavenumber, Laplace) space. Formulas and their sources: half_space.c, doc/theory/lamb.md. */
#ifndef SELAS_HALF_SPACE_H
#define SELAS_HALF_SPACE_H

#include <complex.h>
#include <stdbool.h>
#include <stddef.h>

struct half_space {
    double density, mu, poisson;
    double p_speed, s_speed, rayleigh_speed;
    double ratio;            /* (s_speed / p_speed)^2 */
    double rayleigh;         /* (rayleigh_speed / s_speed)^2 */
    double p_decay, s_decay; /* depth decay of the Rayleigh wave: exp(-decay k z) */
    /* Residues of the compliances at w = s^2 / s_speed^2 = -rayleigh k^2, times mu: those of exp(-p_decay k
     * z) and of exp(-s_decay k z). */
    double vertical_residue[2]; /* uz of a vertical traction: k residue / (w + rayleigh k^2) */
    double
        horizontal_residue[2]; /* (ux, uy) of a vertical traction: i (kx, ky) residue / (w + rayleigh k^2) */
    double radial_residue[2];  /* along k of a traction along k: k residue / (w + rayleigh k^2) */
    double coupled_residue[2]; /* uz of a traction along k: i k residue / (w + rayleigh k^2) */
};

/* Density > 0, mu > 0, lambda > -2 mu / 3. */
void half_space_set(struct half_space *half_space, double density, double lambda, double mu);

enum { BLOCK = 48 }; /* wavenumbers evaluated at once */

/* Compliances times mu on a block of wavenumbers; real and imaginary parts apart. */
struct compliance {
    double vertical[2][BLOCK];   /* uz / Tz */
    double horizontal[2][BLOCK]; /* u_r / (i Tz) */
    double radial[2][BLOCK];     /* u_r / T_r */
    double coupled[2][BLOCK];    /* uz / (i T_r) */
    double shear[2][BLOCK];      /* u_t / T_t */
};

/* At depth z >= 0 for ascending wavenumbers k > 0, Re s > 0, Im s >= 0; the last three only if horizontal
 * loads are wanted. With `without_rayleigh` the pole is subtracted from all of them but shear. */
void half_space_compliance(const struct half_space *half_space, double complex s, double z, size_t count,
                           const double *k, bool horizontal_loads, bool without_rayleigh,
                           struct compliance *compliance);

/* Static values (s = 0) of the five, times mu, in the order of struct compliance. */
void half_space_static(const struct half_space *half_space, double z, double k, double value[5]);
/* Static values of the subtracted poles of the first four. */
void half_space_static_rayleigh(const struct half_space *half_space, double z, double k, double value[4]);

#endif
