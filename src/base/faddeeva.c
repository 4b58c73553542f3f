/* Scaled complementary error function erfcx(z) = w(i z), w the Faddeeva function, by the modified trapezoidal
 * rules of Al Azah & Chandler-Wilde (2021), SIAM J. Numer. Anal. 59, 2346-2367 (their w_N, Eqs 1.6-1.8, N = 11,
 * relative error 2e-15): the trapezoidal or midpoint rule for
 *
 *   w(z) = (2 i z / pi) integral over t > 0 of exp(-t^2) / (z^2 - t^2) dt
 *
 * with the residue of the pole at t = z added where the pole lies within pi/h of the real line. Which of the
 * two rules is taken depends on which one has no abscissa near the pole. */
#include "base/faddeeva.h"

#include <math.h>
#include <stdbool.h>

enum { TERMS = 11 };

/* w(z) for Re z >= 0 and Im z >= 0. */
static double complex first_quadrant(double complex z)
{
    const double h = sqrt(M_PI / (TERMS + 1)), x = creal(z), y = cimag(z);
    const double phase = x / h - floor(x / h);
    const double complex square = z * z;
    const bool midpoint = y >= x || phase < .25 || phase > .75;
    double complex sum = midpoint ? 0 : .5 / square;
    for (int k = midpoint ? 0 : 1; k <= TERMS; k++) {
        const double t = (midpoint ? k + .5 : k) * h;
        sum += exp(-t * t) / (square - t * t);
    }
    sum *= 2 * I * h * z / M_PI;
    if (y >= fmax(x, M_PI / h)) return sum;
    const double complex turn = cexp(-2 * I * M_PI * z / h);
    return sum + 2 * cexp(-square) / (midpoint ? 1 + turn : 1 - turn);
}

double complex scaled_erfc(double complex z)
{
    /* i z has the imaginary part Re z >= 0; w(-conj(u)) = conj(w(u)). */
    if (cimag(z) <= 0) return first_quadrant(I * z);
    return conj(first_quadrant(-conj(I * z)));
}
