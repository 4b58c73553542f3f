/* Radial kernels.
 *
 * cubic spline   Ding et al. 2006, Eq 39, and He & Seaid 2016, Eq 2 with the outer branch (2 - q)^3 / 6
 * Wendland C2    (1 - q/2)^4 (1 + 2 q) in 2D and 3D, (1 - q/2)^3 (1 + 3 q/2) in 1D (Wendland 1995)
 * quintic spline (3 - q)^5 - 6 (2 - q)^5 + 15 (1 - q)^5, each power only where its base is
 *                positive; 1/(120 pi) in 3D: the 3/(359 pi) often quoted gives an integral of 1.0028 */
#include "kernel/kernel.h"

#include "deck/choices.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

#define DECLARE(symbol, word) extern const struct kernel kernel_##symbol;
#define ENTRY(symbol, word) &kernel_##symbol,
KERNELS(DECLARE)
static const struct kernel *const kernels[] = {KERNELS(ENTRY) NULL};

static double cubic_shape(int dimension, double q)
{
    (void)dimension;
    if (q < 1) return 2.0 / 3 - q * q * (1 - q / 2);
    const double s = 2 - q;
    return s * s * s / 6;
}

static double cubic_slope_over_q(int dimension, double q)
{
    (void)dimension;
    if (q < 1) return -2 + 1.5 * q;
    const double s = 2 - q;
    return -s * s / (2 * q);
}

static double cubic_curvature(int dimension, double q)
{
    (void)dimension;
    return q < 1 ? -2 + 3 * q : 2 - q;
}

static double wendland_shape(int dimension, double q)
{
    const double s = 1 - q / 2, s3 = s * s * s;
    return dimension == 1 ? s3 * (1 + 1.5 * q) : s3 * s * (1 + 2 * q);
}

static double wendland_slope_over_q(int dimension, double q)
{
    const double s = 1 - q / 2;
    return dimension == 1 ? -3 * s * s : -5 * s * s * s;
}

static double wendland_curvature(int dimension, double q)
{
    const double s = 1 - q / 2;
    return dimension == 1 ? -3 * s * (1 - 1.5 * q) : -5 * s * s * (1 - 2 * q);
}

/* Sum of weight * (knot - q)^power over the knots 3, 2, 1 that lie beyond q. */
static double quintic_sum(double q, int power)
{
    static const double weight[3] = {1, -6, 15};
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        const double s = 3 - i - q;
        if (s <= 0) break;
        double term = weight[i];
        for (int p = 0; p < power; p++)
            term *= s;
        sum += term;
    }
    return sum;
}

static double quintic_shape(int dimension, double q)
{
    (void)dimension;
    return quintic_sum(q, 5);
}

static double quintic_curvature(int dimension, double q)
{
    (void)dimension;
    return 20 * quintic_sum(q, 3);
}

static double quintic_slope_over_q(int dimension, double q)
{
    (void)dimension;
    /* inside q < 1 the constants of the slope cancel: -120 + 120 q^2 - 50 q^3 */
    if (q < 1) return -120 + 120 * q * q - 50 * q * q * q;
    return -5 * quintic_sum(q, 4) / q;
}

const struct kernel kernel_cubic = {"cubic",
                                    2,
                                    {1, 15 / (7 * M_PI), 3 / (2 * M_PI)},
                                    {2.0 / 3, 15 / (7 * M_PI), 7.0 / 10},
                                    cubic_shape,
                                    cubic_slope_over_q,
                                    cubic_curvature};
const struct kernel kernel_wendland = {"wendland",
                                       2,
                                       {5.0 / 8, 7 / (4 * M_PI), 21 / (16 * M_PI)},
                                       {5.0 / 8, 7 / (3 * M_PI), 3.0 / 4},
                                       wendland_shape,
                                       wendland_slope_over_q,
                                       wendland_curvature};
const struct kernel kernel_quintic = {"quintic",
                                      3,
                                      {1.0 / 120, 7 / (478 * M_PI), 1 / (120 * M_PI)},
                                      {66.0 / 120, 420 / (239 * M_PI), 239.0 / 420},
                                      quintic_shape,
                                      quintic_slope_over_q,
                                      quintic_curvature};

const struct kernel *kernel_find(const char *name)
{
    for (size_t i = 0; kernels[i] != NULL; i++)
        if (strcmp(kernels[i]->name, name) == 0) return kernels[i];
    return NULL;
}

/* c_d / h^(d + order) */
static double scale(const struct kernel *kernel, int dimension, double h, int order)
{
    double power = 1;
    for (int i = 0; i < dimension + order; i++)
        power *= h;
    return kernel->normalisation[dimension - 1] / power;
}

double kernel_value(const struct kernel *kernel, int dimension, double r, double h)
{
    const double q = r / h;
    return q < kernel->support ? scale(kernel, dimension, h, 0) * kernel->shape(dimension, q) : 0;
}

double kernel_derivative_over_r(const struct kernel *kernel, int dimension, double r, double h)
{
    const double q = r / h;
    return q < kernel->support ? scale(kernel, dimension, h, 2) * kernel->slope_over_q(dimension, q) : 0;
}

double kernel_derivative(const struct kernel *kernel, int dimension, double r, double h)
{
    return r * kernel_derivative_over_r(kernel, dimension, r, h);
}

double kernel_second_derivative(const struct kernel *kernel, int dimension, double r, double h)
{
    const double q = r / h;
    return q < kernel->support ? scale(kernel, dimension, h, 2) * kernel->curvature(dimension, q) : 0;
}

double kernel_plane_factor(const struct kernel *kernel, int dimension, double h)
{
    return h / kernel->plane[dimension - 1];
}

double kernel_dispersion(const struct kernel *kernel, int dimension, double h, double power)
{
    const int most = (int)ceil(kernel->support * h);
    const int m[3] = {most, dimension > 1 ? most : 0, dimension > 2 ? most : 0};
    double second = 0, fourth = 0;
    for (int x = 1; x <= m[0]; x++)
        for (int y = -m[1]; y <= m[1]; y++)
            for (int z = -m[2]; z <= m[2]; z++) {
                const double r = sqrt(x * x + y * y + z * z), square = x * x;
                if (r >= kernel->support * h * (1 - 1e-9)) continue; /* (as neighbours are counted) */
                const double weight = power > 0 ? pow(kernel_value(kernel, dimension, r, h), power)
                                                : -kernel_derivative_over_r(kernel, dimension, r, h);
                second += weight * square;
                fourth += weight * square * square;
            }
    return second > 0 ? fourth / second : 1;
}
