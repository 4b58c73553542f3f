/* Moduli of damped solids over the Laplace variable: constant Q, and relaxation mechanisms
 * (doc/seismograms.md, Eqs 22, 23). */
#ifndef SELAS_MODULUS_H
#define SELAS_MODULUS_H

#include <complex.h>
#include <stddef.h>

enum { MOST_MECHANISMS = 8 };

struct modulus {
    double size;              /* rho c^2 at the reference frequency; unrelaxed with mechanisms */
    double power;             /* of s: 2 gamma of constant Q; 0: none */
    double angular_frequency; /* where constant Q has the size */
    size_t mechanisms;
    double rate[MOST_MECHANISMS], weight[MOST_MECHANISMS];
};

/* The modulus that does not depend on frequency. */
struct modulus modulus_elastic(double size);
/* Quality q > 0, phase speed sqrt(size/density) at the angular frequency (Kjartansson 1979). */
struct modulus modulus_constant_q(double size, double q, double angular_frequency);
/* Re s > 0. */
double complex modulus_at(const struct modulus *modulus, double complex s);

#endif
