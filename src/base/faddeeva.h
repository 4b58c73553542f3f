/* The scaled complementary error function of a complex argument. */
#ifndef SELAS_FADDEEVA_H
#define SELAS_FADDEEVA_H

#include <complex.h>

/* exp(z^2) erfc(z) for Re z >= 0, to about 1e-14 relative. */
double complex scaled_erfc(double complex z);

#endif
