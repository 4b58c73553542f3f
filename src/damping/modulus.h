/* Moduli of damped solids over the Laplace variable: constant Q, Q that is a power of the frequency, and
 * relaxation mechanisms (doc/theory/damping.md, Eqs 1 to 4). */
#ifndef SELAS_MODULUS_H
#define SELAS_MODULUS_H

#include <complex.h>
#include <stdbool.h>
#include <stddef.h>

enum { MOST_MECHANISMS = 8 };

/* The step that takes mechanisms on (doc/theory/damping.md): leapfrog's (Eq 15) or, corrected, that of the modified
 * equation (Eq 15b); 0: as if it were short. */
struct mechanism_step {
    double dt;
    bool corrected;
};

struct modulus {
    double size;  /* rho c^2 at the reference frequency; unrelaxed with mechanisms */
    double power; /* of s, constant Q: 2 gamma; 2 / pi times the phase at the reference; 0: none */
    double bend;  /* Q grows as this power of the frequency; 0: constant */
    double angular_frequency; /* reference: where constant Q has the size */
    size_t mechanisms;
    double rate[MOST_MECHANISMS], weight[MOST_MECHANISMS];
    struct mechanism_step by;
};

/* The modulus that does not depend on frequency. */
struct modulus modulus_elastic(double size);
/* Quality q > 0, phase speed sqrt(size/density) at the angular frequency (Kjartansson 1979). */
struct modulus modulus_constant_q(double size, double q, double angular_frequency);
/* The same with Q = q (w/angular_frequency)^bend, -1 < bend < 1. */
struct modulus modulus_power_q(double size, double q, double bend, double angular_frequency);
/* What a mechanism takes of a modulus, F_l of Eq 6 (rate/(rate + s) without a step). Re s >= 0. */
double complex mechanism_at(double rate, const struct mechanism_step *by, double complex s);
/* Re s > 0. */
double complex modulus_at(const struct modulus *modulus, double complex s);
/* Of a solid of this density, at an angular frequency: phase speed and 1/Q. */
double modulus_speed(const struct modulus *modulus, double density, double angular_frequency);
double modulus_loss(const struct modulus *modulus, double angular_frequency);

#endif
