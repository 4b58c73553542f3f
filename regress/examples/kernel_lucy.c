/* Example of a smoothing kernel: Lucy's (1977, Astron. J. 82, 1013), w(q) = (1 + 3 q / 2) (1 - q / 2)^3 for q < 2. */
#include "kernel/kernel.h"

#include <math.h>

static double shape(int dimension, double q)
{
    (void)dimension;
    const double s = 1 - q / 2;
    return (1 + 1.5 * q) * s * s * s;
}

static double slope_over_q(int dimension, double q)
{
    (void)dimension;
    const double s = 1 - q / 2;
    return -3 * s * s;
}

static double curvature(int dimension, double q)
{
    (void)dimension;
    return -3 * (1 - q / 2) * (1 - 1.5 * q);
}

const struct kernel kernel_lucy = {
    .name = "lucy",
    .support = 2,
    .normalisation = {5.0 / 8, 5 / (4 * M_PI), 105 / (128 * M_PI)},
    .plane = {5.0 / 8, 2 / M_PI, 21.0 / 32},
    .shape = shape,
    .slope_over_q = slope_over_q,
    .curvature = curvature,
};
