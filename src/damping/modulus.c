/* Constant Q: M = size cos^2(pi g/2) (s/w_ref)^(2 g), g = atan(1/Q)/pi (Kjartansson, J. Geophys. Res. 84
 * (1979) 4737-4748): its phase speed is sqrt(size/rho) at w_ref and Im M / Re M = 1/Q at every frequency.
 * Q = q (w/w_ref)^b: ln M = -phi/sin(pi b/2) (s/w_ref)^(-b) + const, phi = atan(1/q): the phase is
 * phi (w/w_ref)^(-b) and the modulus causal for |b| < 1.
 * Mechanisms: M = size (1 - sum_l weight_l F_l), F_l = rate_l/(rate_l + s), or what the step makes of it. */
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

struct modulus modulus_power_q(double size, double q, double bend, double angular_frequency)
{
    struct modulus modulus = modulus_constant_q(size, q, angular_frequency);
    modulus.bend = bend;
    return modulus;
}

/* ln M less that of the size at i w_ref, over the phase there. */
static double complex bent(double bend, double complex s)
{
    const double turn = .5 * M_PI * bend;
    return (cos(turn) - cpow(s, -bend)) / sin(turn);
}

double complex mechanism_at(double rate, const struct mechanism_step *by, double complex s)
{
    const double complex turn = s * by->dt;
    if (!(by->dt > 0)) return rate / (rate + s);
    if (by->corrected) return (1 - turn * turn / 12) * rate / (rate + 2 / by->dt * ctanh(.5 * turn));
    const double complex slower = rate * csqrt(1 + .25 * turn * turn);
    return slower / (slower + s);
}

double complex modulus_at(const struct modulus *modulus, double complex s)
{
    if (modulus->bend != 0)
        return modulus->size *
               cexp(.5 * M_PI * modulus->power * bent(modulus->bend, s / modulus->angular_frequency));
    if (modulus->power > 0) return modulus->size * cpow(s / modulus->angular_frequency, modulus->power);
    double complex left = 1;
    for (size_t l = 0; l < modulus->mechanisms; l++)
        left -= modulus->weight[l] * mechanism_at(modulus->rate[l], &modulus->by, s);
    return modulus->size * left;
}

double modulus_speed(const struct modulus *modulus, double density, double angular_frequency)
{
    return 1 / creal(csqrt(density / modulus_at(modulus, I * angular_frequency)));
}

double modulus_loss(const struct modulus *modulus, double angular_frequency)
{
    const double complex m = modulus_at(modulus, I * angular_frequency);
    return cimag(m) / creal(m);
}
