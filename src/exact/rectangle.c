/* Potentials of a uniform rectangle at complex depth d, as sums over the corners: Love (1929), Phil. Trans.
 * R. Soc. A 228, 377-420 for 1/R; Nagy, Papp & Benedek (2000), J. Geodesy 74, 552-560 for the integral over
 * depth; the next one is derived in doc/theory/lamb.md (Eqs 9, 10). With u, v the distances from the receiver to the
 * corner's two edges and R = sqrt(u^2 + v^2 + d^2):
 *
 *   plain       = u ln(v+R) + v ln(u+R) - d atan(u v / (d R)),
 *   d(plain)/dd = -atan(u v / (d R)),
 *   once        = u v ln(d+R) + u d ln(v+R) + v d ln(u+R)
 *                 - (u^2 atan(v d/(u R)) + v^2 atan(u d/(v R)) + d^2 atan(u v/(d R)))/2,
 *   once_u      = v ln(d+R) + d ln(v+R) - u atan(v d/(u R)),
 *   twice_u     = v d ln(d+R) + (d^2 - u^2)/2 ln(v+R) - u d atan(v d/(u R)) - v R/2,
 *
 * with atan(v d/(u R)) standing for atan(v d/(u R)) - atan(v/u), so that all gradients vanish at great depth.
 * They are analytic in Re d > 0 with principal branches; on Re d = 0 the limit from the right is meant. */
#include "exact/patch.h"

#include <math.h>

/* a * atan(b / c) where both a and c vanish with b finite is 0. */
static double complex angle_of(double complex above, double complex below)
{
    if (below == 0) return above == 0 ? 0 : (creal(above) >= 0 ? M_PI_2 : -M_PI_2);
    return catan(above / below);
}

/* ln(v + R) without cancellation for v < 0: (R + v)(R - v) = u^2 + d^2. */
static double complex log_sum(double v, double complex r, double complex rest)
{
    if (v >= 0) return clog(v + r);
    return clog(rest) - clog(r - v);
}

static void add_corner(double sign, double u, double v, double complex d, struct potentials *sum)
{
    const double complex r = csqrt(u * u + v * v + d * d);
    const double complex log_v = log_sum(v, r, u * u + d * d), log_u = log_sum(u, r, v * v + d * d);
    const double complex log_d = clog(d + r);
    const double complex flat = angle_of(u * v, d * r);
    const double complex at_u = angle_of(v * d, u * r) - atan(v / u);
    const double complex at_v = angle_of(u * d, v * r) - atan(u / v);
    sum->angle += sign * flat;
    sum->plain += sign * (u * log_v + v * log_u - d * flat);
    sum->plain_x += sign * log_v;
    sum->plain_y += sign * log_u;
    sum->once += sign * (u * v * log_d + u * d * log_v + v * d * log_u -
                         .5 * (u * u * at_u + v * v * at_v + d * d * flat));
    sum->once_x += sign * (v * log_d + d * log_v - u * at_u);
    sum->once_y += sign * (u * log_d + d * log_u - v * at_v);
    sum->once_xx -= sign * at_u;
    sum->once_yy -= sign * at_v;
    sum->once_xy += sign * log_d;
    sum->twice_x += sign * (v * d * log_d + .5 * (d * d - u * u) * log_v - u * d * at_u - .5 * v * r);
    sum->twice_y += sign * (u * d * log_d + .5 * (d * d - v * v) * log_u - v * d * at_v - .5 * u * r);
    sum->twice_xx -= sign * (d * at_u + u * log_v);
    sum->twice_yy -= sign * (d * at_v + v * log_u);
    sum->twice_xy += sign * (d * log_d - r);
}

void rectangle_potentials(const double half[2], double x, double y, double complex depth,
                          struct potentials *potentials)
{
    *potentials = (struct potentials){0};
    /* A distance of exactly zero meets logarithms of zero times zero; the functions are continuous. */
    const double tiny = 1e-13 * (half[0] + half[1]);
    const double complex d = creal(depth) < tiny ? tiny + I * cimag(depth) : depth;
    for (int i = -1; i <= 1; i += 2)
        for (int j = -1; j <= 1; j += 2) {
            double u = x + i * half[0], v = y + j * half[1];
            if (fabs(u) < tiny) u = tiny;
            if (fabs(v) < tiny) v = tiny;
            add_corner(i * j, u, v, d, potentials);
        }
}
