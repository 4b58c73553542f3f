/* Linear stability of the Runge-Kutta schemes, by evaluating the stability polynomial R(z) on the modes of a
 * damped wave operator: no rule of thumb, no fitted constant.
 *
 * An undamped wave has lambda = +-i omega: on the imaginary axis RK4 reaches 2.83, but Euler, the midpoint
 * rule and every Runge-Kutta-Chebyshev method reach 0, whatever their number of stages. Viscosity moves the
 * modes into the left half plane, where the Chebyshev methods live. */
#include "stepping/runge_kutta.h"

#include <math.h>

bool stability_bounded(stability_polynomial *polynomial, long stages, const struct spectrum *spectrum,
                       double dt)
{
    const double tolerance = 1e-9; /* growth per step that no run can notice */
    const int modes = 200 + 20 * (int)stages;
    if (spectrum->viscous > 0 && cabs(polynomial(-spectrum->viscous * dt, stages)) > 1 + tolerance)
        return false;
    for (int k = modes; k > 0; k--) {
        const double theta = (double)k / modes;
        const double frequency = sin(M_PI / 2 * theta) * spectrum->omega * dt,
                     damping = theta * theta * spectrum->wave_damping * dt;
        const double complex root = csqrt(damping * damping / 4 - frequency * frequency);
        if (cabs(polynomial(-damping / 2 - root, stages)) > 1 + tolerance) return false;
        if (cabs(polynomial(-damping / 2 + root, stages)) > 1 + tolerance) return false;
    }
    return true;
}

double stability_limit(stability_polynomial *polynomial, long stages, const struct spectrum *spectrum)
{
    const double radius = fmax(spectrum->omega, spectrum->viscous);
    if (!(radius > 0)) return INFINITY;
    double low = .05 / radius;
    if (!stability_bounded(polynomial, stages, spectrum, low)) return 0;
    double high = low;
    do {
        low = high;
        high *= 1.05;
    } while (stability_bounded(polynomial, stages, spectrum, high));
    while (high - low > 1e-6 * high) {
        const double middle = (low + high) / 2;
        if (stability_bounded(polynomial, stages, spectrum, middle))
            low = middle;
        else
            high = middle;
    }
    return low;
}
