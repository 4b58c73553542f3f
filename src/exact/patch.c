/* Transforms and potentials of loaded patches (doc/theory/lamb.md, Eqs 7, 10). The direction averages of a rectangle
 * are taken by the trapezoidal rule on the full circle (by symmetry: on a quarter), which converges
 * exponentially once it resolves k times the farthest distance; those of a disc and a point are Bessel
 * functions. */
#include "exact/patch.h"

#include "base/gsl_errors.h"

#include <gsl/gsl_integration.h>
#include <math.h>

/* sin and cos of |x| < 1e6 to rounding of x, without branches so that loops over it run in vectors: x = n
 * pi/2 + y with |y| <= pi/4 (pi/2 in three parts, Cody & Waite 1980), Taylor series of y, turned by n
 * quarters. */
static inline void sine_cosine(double x, double *sine, double *cosine)
{
    const double shift = 0x1.8p52; /* adding it rounds to an integer */
    const double n = (x * M_2_PI + shift) - shift, m = n - 4 * ((.25 * n + shift) - shift);
    const double y = ((x - n * 0x1.921fb544p0) - n * 0x1.0b4611a6p-34) - n * 0x1.3198a2e037073p-69;
    const double q = y * y;
    const double s =
        y + y * q *
                (-1. / 6 +
                 q * (1. / 120 + q * (-1. / 5040 +
                                      q * (1. / 362880 + q * (-1. / 39916800 + q * (1. / 6227020800. -
                                                                                    q / 1307674368000.))))));
    const double c =
        1 + q * (-.5 + q * (1. / 24 +
                            q * (-1. / 720 +
                                 q * (1. / 40320 + q * (-1. / 3628800 + q * (1. / 479001600. +
                                                                             q * (-1. / 87178291200. +
                                                                                  q / 20922789888000.)))))));
    const double turn_cosine = 1 - fabs(m), turn_sine = m * (2 - fabs(m));
    *sine = s * turn_cosine + c * turn_sine;
    *cosine = c * turn_cosine - s * turn_sine;
}

enum { DIRECTIONS = 32 }; /* worked off at once */

/* Adds the directions whose cosine and sine are c, s; `shape`: their weights over kx ky. */
static void add_directions(const struct patch *patch, double x, double y, double k, const double *c,
                           const double *s, const double *weight, double average[AVERAGES])
{
    double part[AVERAGES][DIRECTIONS];
    for (int i = 0; i < DIRECTIONS; i++) {
        const double kx = k * c[i], ky = k * s[i];
        double side_x, side_y, sin_x, cos_x, sin_y, cos_y, unused;
        sine_cosine(kx * patch->half[0], &side_x, &unused);
        sine_cosine(ky * patch->half[1], &side_y, &unused);
        sine_cosine(kx * x, &sin_x, &cos_x);
        sine_cosine(ky * y, &sin_y, &cos_y);
        const double shape = weight[i] * 4 * side_x * side_y / (kx * ky);
        part[AVERAGE][i] = shape * cos_x * cos_y;
        part[AVERAGE_X][i] = -shape * c[i] * sin_x * cos_y;
        part[AVERAGE_Y][i] = -shape * s[i] * cos_x * sin_y;
        part[AVERAGE_XX][i] = shape * c[i] * c[i] * cos_x * cos_y;
        part[AVERAGE_XY][i] = -shape * c[i] * s[i] * sin_x * sin_y;
    }
    for (int j = 0; j < AVERAGES; j++)
        for (int i = 0; i < DIRECTIONS; i++)
            average[j] += part[j][i];
}

/* The trapezoidal rule's points lie half a step from the axes, where kx or ky vanish. */
static void rectangle_averages(const struct patch *patch, double x, double y, double k,
                               double average[AVERAGES])
{
    const double reach = k * hypot(fabs(x) + patch->half[0], fabs(y) + patch->half[1]);
    const int points = (int)(.27 * reach + 5 * cbrt(reach)) + 20; /* in a quarter of the circle */
    const double turn = M_PI_2 / points, turn_cos = cos(turn), turn_sin = sin(turn);
    double next_c = cos(.5 * turn), next_s = sin(.5 * turn);
    for (int i = 0; i < AVERAGES; i++)
        average[i] = 0;
    for (int from = 0; from < points; from += DIRECTIONS) {
        double c[DIRECTIONS], s[DIRECTIONS], weight[DIRECTIONS];
        for (int i = 0; i < DIRECTIONS; i++) {
            c[i] = next_c;
            s[i] = next_s;
            weight[i] = from + i < points ? 1 : 0;
            if (from + i + 1 >= points) continue; /* the rest is filled up with the last one */
            next_c = c[i] * turn_cos - s[i] * turn_sin;
            next_s = s[i] * turn_cos + c[i] * turn_sin;
        }
        add_directions(patch, x, y, k, c, s, weight, average);
    }
    for (int i = 0; i < AVERAGES; i++)
        average[i] /= 2 * M_PI * points;
}

void patch_averages(const struct patch *patch, double x, double y, double k, double average[AVERAGES])
{
    if (patch->shape == PATCH_RECTANGLE) {
        rectangle_averages(patch, x, y, k, average);
        return;
    }
    const double radius = patch->half[0], r = hypot(x, y), kr = k * r;
    const double shape = patch->shape == PATCH_POINT ? 1 / (2 * M_PI) : radius * j1(k * radius) / k;
    const double zero = j0(kr), one = j1(kr);
    const double one_over = kr > 1e-4 ? one / kr : .5 - kr * kr / 16;
    const double two = kr > 1e-4 ? 2 * one / kr - zero : kr * kr / 8;
    const double nx = r > 0 ? x / r : 0, ny = r > 0 ? y / r : 0;
    average[AVERAGE] = shape * zero;
    average[AVERAGE_X] = -shape * one * nx;
    average[AVERAGE_Y] = -shape * one * ny;
    average[AVERAGE_XX] = shape * (one_over - nx * nx * two);
    average[AVERAGE_XY] = -shape * nx * ny * two;
}

double patch_side_share(double distance, double half)
{
    const double near = 1e-9 * half;
    if (fabs(fabs(distance) - half) <= near) return .5;
    return fabs(distance) < half ? 1 : 0;
}

double patch_share(const struct patch *patch, double x, double y)
{
    if (patch->shape == PATCH_POINT) return 0;
    if (patch->shape == PATCH_DISC) return patch_side_share(hypot(x, y), patch->half[0]);
    return patch_side_share(x, patch->half[0]) * patch_side_share(y, patch->half[1]);
}

static void point_potentials(double x, double y, double complex d, struct potentials *potentials)
{
    const double complex r = csqrt(x * x + y * y + d * d), sum = r + d, r3 = r * r * r;
    const double complex slope = 1 / (r * sum); /* once_x = x slope */
    const double complex bend = -(2 * r + d) / (r3 * sum * sum);
    const double complex turn = 1 / (r * sum * sum);
    potentials->angle = d / r3;
    potentials->plain = 1 / r;
    potentials->plain_x = -x / r3;
    potentials->plain_y = -y / r3;
    potentials->once = clog(sum);
    potentials->once_x = x * slope;
    potentials->once_y = y * slope;
    potentials->once_xx = slope + x * x * bend;
    potentials->once_yy = slope + y * y * bend;
    potentials->once_xy = x * y * bend;
    potentials->twice_x = -x / sum;
    potentials->twice_y = -y / sum;
    potentials->twice_xx = -1 / sum + x * x * turn;
    potentials->twice_yy = -1 / sum + y * y * turn;
    potentials->twice_xy = x * y * turn;
}

/* Integrals round the disc's edge: integral of f over the disc = contour integral of F (r x dl)/r^2 with
 * F = integral of f r dr; gradients: minus the contour integral of f n dl. */
struct edge {
    double radius, distance, depth;
    int which;
};

static double edge_integrand(double angle, void *parameters)
{
    const struct edge *edge = parameters;
    /* Edge point seen from the receiver; the disc's centre lies at -distance on the x axis. */
    const double u = edge->radius * cos(angle) - edge->distance, v = edge->radius * sin(angle);
    const double square = u * u + v * v, r = sqrt(square + edge->depth * edge->depth);
    const double cross = edge->radius * (edge->radius - edge->distance * cos(angle));
    const double share = square > 0 ? cross / square : .5;
    switch (edge->which) {
    case 0: /* angle: depth/R^3 */
        return edge->depth > 0 ? (1 - edge->depth / r) * share : 0;
    case 1: /* 1/R */
        return (r - edge->depth) * share;
    case 2: /* d/dx of 1/R */
        return -edge->radius * cos(angle) / r;
    case 3: /* d/dx of ln(depth + R) */
        return -edge->radius * cos(angle) * log(edge->depth + r);
    case 4: /* d2/dx2 of the integral of ln(depth + R) over depth: d/dx of it at a point is -u/(R + depth)
               with u from the point to the receiver */
        return -edge->radius * cos(angle) * u / (r + edge->depth);
    case 5: /* d2/dy2 of the same */
        return -edge->radius * sin(angle) * v / (r + edge->depth);
    case 6: /* d2/dx2 of ln(depth + R) */
        return edge->radius * cos(angle) * u / (r * (r + edge->depth));
    default: /* d2/dy2 of ln(depth + R) */
        return edge->radius * sin(angle) * v / (r * (r + edge->depth));
    }
}

static void disc_potentials(double radius, double x, double y, double depth, struct potentials *potentials)
{
    const double distance = hypot(x, y), nx = distance > 0 ? x / distance : 1,
                 ny = distance > 0 ? y / distance : 0;
    struct edge edge = {radius, distance, depth, 0};
    const gsl_function function = {edge_integrand, &edge};
    gsl_errors_returned(); /* also where a rule stops short of what was asked for */
    gsl_integration_cquad_workspace *space = gsl_integration_cquad_workspace_alloc(400);
    double value[8] = {0};
    const bool rim = depth <= 0 && patch_side_share(distance, radius) == .5;
    for (edge.which = 0; space != NULL && edge.which < (depth > 0 ? 8 : 6); edge.which++) {
        if (rim && edge.which == 2) continue; /* infinite there; whoever takes it multiplies by the depth */
        /* symmetric about the line to the receiver; halves of the half circle so that the end near the
         * receiver is an end of the rule */
        double part = 0;
        gsl_integration_cquad(&function, 0, .5, 1e-13, 1e-12, space, &part, NULL, NULL);
        value[edge.which] = 2 * part;
        gsl_integration_cquad(&function, .5, M_PI, 1e-13, 1e-12, space, &part, NULL, NULL);
        value[edge.which] += 2 * part;
    }
    for (size_t k = 0; space == NULL && k < sizeof value / sizeof *value; k++)
        value[k] = (double)NAN; /* no memory: no number rather than a wrong one */
    gsl_integration_cquad_workspace_free(space);
    gsl_errors_as_before();
    potentials->angle = value[0];
    potentials->plain = value[1];
    potentials->plain_x = nx * value[2];
    potentials->plain_y = ny * value[2];
    potentials->once_x = nx * value[3];
    potentials->once_y = ny * value[3];
    potentials->once_xx = nx * nx * value[6] + ny * ny * value[7];
    potentials->once_yy = ny * ny * value[6] + nx * nx * value[7];
    potentials->once_xy = nx * ny * (value[6] - value[7]);
    potentials->twice_xx = nx * nx * value[4] + ny * ny * value[5];
    potentials->twice_yy = ny * ny * value[4] + nx * nx * value[5];
    potentials->twice_xy = nx * ny * (value[4] - value[5]);
}

void patch_potentials(const struct patch *patch, double x, double y, double complex depth,
                      struct potentials *potentials)
{
    *potentials = (struct potentials){0};
    switch (patch->shape) {
    case PATCH_RECTANGLE:
        rectangle_potentials(patch->half, x, y, depth, potentials);
        break;
    case PATCH_DISC:
        disc_potentials(patch->half[0], x, y, creal(depth), potentials);
        break;
    case PATCH_POINT:
        point_potentials(x, y, depth, potentials);
        break;
    }
}
