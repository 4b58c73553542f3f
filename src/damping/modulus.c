/* Constant Q: M = size cos^2(pi g/2) (s/w_ref)^(2 g), g = atan(1/Q)/pi (Kjartansson, J. Geophys. Res. 84
 * (1979) 4737-4748): its phase speed is sqrt(size/rho) at w_ref and Im M / Re M = 1/Q at every frequency.
 * Mechanisms: M = size (1 - sum_l weight_l rate_l/(rate_l + s)). */
#include "damping/modulus.h"

#include <math.h>

struct modulus modulus_elastic(double size)
{
    return (struct modulus){.size = size};
}

struct modulus modulus_constant_q(double size, double q, double angular_frequency)
{
    const double gamma = atan(1 / q) / M_PI, cosine = cos(.5 * M_PI * gamma);
    return (struct modulus){
        .size = size * cosine * cosine, .power = 2 * gamma, .angular_frequency = angular_frequency};
}

double complex modulus_at(const struct modulus *modulus, double complex s)
{
    if (modulus->power > 0) return modulus->size * cpow(s / modulus->angular_frequency, modulus->power);
    double complex left = 1;
    for (size_t l = 0; l < modulus->mechanisms; l++)
        left -= modulus->weight[l] * modulus->rate[l] / (modulus->rate[l] + s);
    return modulus->size * left;
}
