/* Closed form of Lamb's problem on the surface, any Poisson ratio: Pekeris (1955), Proc. Natl. Acad. Sci. 41,
 * 469-480; Mooney (1974), Bull. Seismol. Soc. Am. 64, 473-491; in the form of Kausel (2012), Proc. R. Soc. A
 * 468, 3751-3769. Integrated over the patch by its edge (doc/theory/lamb.md), theta and r polar coordinates
 * about the receiver:
 *
 *   step response = 1/(2 pi mu) contour integral of d(theta) cs t W(r/(cs t)),
 *   W(rho) = int_0^rho Z(1/r) dr,                                                                        (1)
 *
 * horizontally with -cos(theta), -sin(theta) and X for Z. With a = (cs/cp)^2,
 *
 *   Q_j(c) = sqrt((y_j - c)/(y_j - tau^2)),
 *   Z = -[H(tau^2 > a) sum B_j (1 - Q_j(a)) + H(tau > 1) sum C_j (1 - Q_j(1))],                          (2)
 *   P(y) = -(16 (1-a) y^3 - 8 (3-2a) y^2 + 8 y - 1) = 0,
 *   B_j = (1-2y_j)^2/P',  C_j = 4 y_j (y_j-a)/P',                                                        (3)
 *   int Q_j(c) dr = (y_j r^2 - 1)/y_j sqrt((y_j - c)/(y_j r^2 - 1))  at tau = 1/r,                       (4)
 *
 * where Q_j = 0 for the Rayleigh root beyond its arrival, and
 *
 *   X = -(2/pi) int q Im G tau/sqrt(tau^2-q^2) dq over [sqrt a, min(1,tau)]
 *       + C_R tau/sqrt(tau^2-g^2) H(tau > g),                                                            (5)
 *   W = -(2/pi) int Im G asin(min(1, q rho)) dq over [sqrt a, 1] + (C_R/g) asin(min(1, g rho)),          (6)
 *   Im G = -2 A B (1-2q^2)/[(1-2q^2)^4 + 16 q^4 A^2 B^2],
 *   A^2 = q^2 - a,  B^2 = 1 - q^2,  g = cs/c_R.                                                          (7) */
#include "lamb_closed.h"

#include "base/gsl_errors.h"
#include "base/memory.h"
#include "exact/gauss12.h"

#include <gsl/gsl_integration.h>
#include <gsl/gsl_poly.h>
#include <math.h>
#include <stdlib.h>

/* Integral of 1 - Q_j(c) over r from 0 to rho, Eq 4. */
static double complex without_wave(const struct lamb_closed *closed, int j, double c, double rho)
{
    const double complex y = closed->root[j];
    if (j == closed->rayleigh) {
        const double real = creal(y), beyond = real * rho * rho - 1;
        return rho - (beyond > 0 ? sqrt((real - c) * beyond) / real : 0);
    }
    const double complex from = -csqrt(c - y) / y;
    const double complex beyond = y * rho * rho - 1;
    const double complex to = cabs(beyond) > 0 ? beyond / y * csqrt((y - c) / beyond) : 0;
    return rho - (to - from);
}

/* W of Eq 1 for Z. */
static double vertical_area(const struct lamb_closed *closed, double rho)
{
    const double p_front = fmin(rho, 1 / sqrt(closed->ratio)), s_front = fmin(rho, 1);
    double complex sum = 0;
    for (int j = 0; j < 3; j++)
        sum -= closed->p[j] * without_wave(closed, j, closed->ratio, p_front) +
               closed->s[j] * without_wave(closed, j, 1, s_front);
    return creal(sum);
}

double lamb_closed_point_vertical(const struct lamb_closed *closed, double tau)
{
    const double t2 = tau * tau;
    double complex sum = 0;
    for (int j = 0; j < 3; j++) {
        const double complex y = closed->root[j];
        const bool past = j == closed->rayleigh && t2 > creal(y);
        const double complex p = past ? 0 : csqrt((y - closed->ratio) / (y - t2));
        const double complex s = past ? 0 : csqrt((y - 1) / (y - t2));
        if (t2 > closed->ratio) sum -= closed->p[j] * (1 - p);
        if (tau > 1) sum -= closed->s[j] * (1 - s);
    }
    return creal(sum);
}

/* Im G sqrt((q - q0)(1 - q)) ... over q = middle - half cos(angle): the roots at both ends are taken up by
 * the substitution. Returns Im G dq/d(angle). */
static double branch(const struct lamb_closed *closed, double angle, double *q)
{
    const double low = sqrt(closed->ratio), half = .5 * (1 - low);
    *q = low + 2 * half * sin(.5 * angle) * sin(.5 * angle);
    const double q2 = *q * *q;
    const double root = half * sin(angle) * sqrt((*q + low) * (1 + *q)); /* A B */
    const double bend = 1 - 2 * q2;
    return -2 * root * bend / (bend * bend * bend * bend + 16 * q2 * q2 * root * root) * half * sin(angle);
}

/* Angle of `branch` at which q = value. */
static double branch_angle(const struct lamb_closed *closed, double value)
{
    const double low = sqrt(closed->ratio);
    const double x = (value - low) / (1 - low);
    return 2 * asin(sqrt(fmin(1, fmax(0, x))));
}

/* Composite 12-point Gauss rule over the branch cut from one angle to another; `rho` > 0: Eq 6, otherwise Eq
 * 5 at tau = -rho. The root at the upper end is taken up by angle = to - (to - from) u^2; the panels shrink
 * towards the lower end, where roots y_j near a make Im G peak. */
static double over_branch(const struct lamb_closed *closed, double from, double to, double rho)
{
    enum { PANELS = 6 };
    static const double edge[PANELS + 1] = {0, .5, .8, .92, .97, .99, 1};
    double sum = 0;
    for (int panel = 0; panel < PANELS; panel++)
        for (int i = 0; i < 12; i++) {
            const double half = .5 * (edge[panel + 1] - edge[panel]);
            const double u = .5 * (edge[panel + 1] + edge[panel]) + half * gauss12_node[i];
            const double angle = to - (to - from) * u * u;
            double q = 0;
            const double g = branch(closed, angle, &q);
            const double f =
                rho > 0 ? asin(fmin(1, q * rho)) : q * -rho / sqrt(fmax(rho * rho - q * q, 1e-300));
            sum += 2 * half * gauss12_weight[i] * g * f * (to - from) * u;
        }
    return sum;
}

static double direct_horizontal_area(const struct lamb_closed *closed, double rho)
{
    const double g = sqrt(creal(closed->root[closed->rayleigh]));
    const double kink = branch_angle(closed, 1 / rho);
    double sum = closed->horizontal / g * asin(fmin(1, g * rho));
    /* the root of asin at q = 1/rho lies at the end of the first piece; beyond it asin = pi/2 */
    sum -= 2 / M_PI * over_branch(closed, 0, kink, rho);
    if (kink < M_PI) sum -= 2 / M_PI * over_branch(closed, kink, M_PI, rho);
    return sum;
}

/* Ends of the intervals of rho on which W (Eq 6) is smooth; it is constant from the last one on. */
static void area_intervals(const struct lamb_closed *closed, double end[LAMB_CLOSED_INTERVALS + 1])
{
    end[0] = 0;
    end[1] = 1 / sqrt(creal(closed->root[closed->rayleigh]));
    end[2] = 1;
    end[3] = 1 / sqrt(closed->ratio);
}

/* Chebyshev series of W in u on each interval, rho = from + (to - from) u^2 (3 - 2u): the roots at both ends
 * are taken up. */
static void tabulate_horizontal_area(struct lamb_closed *closed)
{
    enum { TERMS = LAMB_CLOSED_TERMS };
    double end[LAMB_CLOSED_INTERVALS + 1];
    area_intervals(closed, end);
    for (int interval = 0; interval < LAMB_CLOSED_INTERVALS; interval++) {
        double value[TERMS];
        for (int i = 0; i < TERMS; i++) {
            const double u = .5 + .5 * cos(M_PI * (i + .5) / TERMS);
            value[i] = direct_horizontal_area(closed, end[interval] + (end[interval + 1] - end[interval]) *
                                                                          u * u * (3 - 2 * u));
        }
        for (int j = 0; j < TERMS; j++) {
            double sum = 0;
            for (int i = 0; i < TERMS; i++)
                sum += value[i] * cos(M_PI * j * (i + .5) / TERMS);
            closed->area[interval][j] = (j == 0 ? 1. : 2.) / TERMS * sum;
        }
    }
}

/* u in [0, 1] with u^2 (3 - 2u) = share. */
static double inverse_smoothstep(double share)
{
    return .5 - sin(asin(1 - 2 * fmin(1, fmax(0, share))) / 3);
}

static double horizontal_area(const struct lamb_closed *closed, double rho)
{
    double end[LAMB_CLOSED_INTERVALS + 1];
    area_intervals(closed, end);
    int interval = 0;
    while (interval + 1 < LAMB_CLOSED_INTERVALS && rho > end[interval + 1])
        interval++;
    const double x = 2 * inverse_smoothstep((rho - end[interval]) / (end[interval + 1] - end[interval])) - 1;
    double one = 0, two = 0;
    for (int j = LAMB_CLOSED_TERMS - 1; j > 0; j--) {
        const double next = 2 * x * one - two + closed->area[interval][j];
        two = one;
        one = next;
    }
    return x * one - two + closed->area[interval][0];
}

selas_status lamb_closed_set(struct lamb_closed *closed, double density, double lambda, double mu,
                             struct messages *messages)
{
    *closed = (struct lamb_closed){.mu = mu, .s_speed = sqrt(mu / density), .ratio = mu / (lambda + 2 * mu)};
    const double a = closed->ratio, lead = 16 * (1 - a);
    gsl_complex roots[3];
    if (gsl_poly_complex_solve_cubic(-8 * (3 - 2 * a) / lead, 8 / lead, -1 / lead, &roots[0], &roots[1],
                                     &roots[2]) != 3)
        return fail(messages, SELAS_NOT_CONVERGED, "the Rayleigh cubic has no three roots");
    for (int j = 0; j < 3; j++) {
        double complex y = GSL_REAL(roots[j]) + I * GSL_IMAG(roots[j]);
        double complex slope = 0;
        for (int i = 0; i < 4; i++) { /* polish by Newton, then P'(y) */
            slope = -((3 * lead * y - 16 * (3 - 2 * a)) * y + 8);
            const double complex value = -(((lead * y - 8 * (3 - 2 * a)) * y + 8) * y - 1);
            if (i < 3) y -= value / slope;
        }
        closed->root[j] = y;
        closed->p[j] = (1 - 2 * y) * (1 - 2 * y) / slope;
        closed->s[j] = 4 * y * (y - a) / slope;
        if (creal(y) > 1 && fabs(cimag(y)) < 1e-12) closed->rayleigh = j;
    }
    /* C_R = -2 g N / R'(g), R = (1-2q^2)^2 - 4 q^2 sqrt((q^2-a)(q^2-1)),
     * N = 1 - 2 g^2 + 2 sqrt((g^2-a)(g^2-1)) */
    const double y = creal(closed->root[closed->rayleigh]), g = sqrt(y);
    const double product = sqrt((y - a) * (y - 1));
    const double slope = -8 * g * (1 - 2 * y) - 8 * g * product - 4 * g * y * (2 * y - a - 1) / product;
    closed->horizontal = -2 * g * (1 - 2 * y + 2 * product) / slope;
    tabulate_horizontal_area(closed);
    return SELAS_OK;
}

double lamb_closed_point_radial(const struct lamb_closed *closed, double tau)
{
    const double g2 = creal(closed->root[closed->rayleigh]), low = sqrt(closed->ratio);
    if (tau <= low) return 0;
    const double sum = -2 / M_PI * over_branch(closed, 0, branch_angle(closed, fmin(1, tau)), -tau);
    return sum + (tau * tau > g2 ? closed->horizontal * tau / sqrt(tau * tau - g2) : 0);
}

/* The patch's edge in pieces seen from the receiver: straight lines or arcs. */
struct edge {
    const struct lamb_closed *closed;
    double t;
    bool arc;
    double from[2], along[2]; /* line: start and unit vector */
    double radius, centre[2]; /* arc: by angle */
    int which;                /* component: 0 x, 1 y, 2 z */
};

static double edge_integrand(double s, const struct edge *edge)
{
    double x = 0, y = 0, cross = 0; /* cross = r x dr/ds */
    if (edge->arc) {
        const double dx = edge->radius * cos(s), dy = edge->radius * sin(s);
        x = edge->centre[0] + dx;
        y = edge->centre[1] + dy;
        cross = x * dx + y * dy;
    } else {
        x = edge->from[0] + s * edge->along[0];
        y = edge->from[1] + s * edge->along[1];
        cross = x * edge->along[1] - y * edge->along[0];
    }
    const double square = x * x + y * y, r = sqrt(square), scale = edge->closed->s_speed * edge->t;
    if (square == 0) return 0;
    const double turn = cross / square * scale;
    if (edge->which == 2) return turn * vertical_area(edge->closed, r / scale);
    return turn * -(edge->which == 0 ? x : y) / r * horizontal_area(edge->closed, r / scale);
}

enum { NODES = 20 }; /* Gauss nodes on each piece of the edge */

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Integral over one edge piece, cut where the three fronts cross it and at its point nearest to the receiver.
 */
static double over_edge(struct edge *edge, double length, const gsl_integration_glfixed_table *rule)
{
    double cut[16] = {0, length};
    size_t cuts = 2;
    const double g = sqrt(creal(edge->closed->root[edge->closed->rayleigh]));
    const double fronts[4] = {0, edge->closed->s_speed * edge->t / sqrt(edge->closed->ratio),
                              edge->closed->s_speed * edge->t, edge->closed->s_speed * edge->t / g};
    const double distance = hypot(edge->centre[0], edge->centre[1]);
    const double to_centre = atan2(-edge->centre[1], -edge->centre[0]);
    const double foot = -(edge->from[0] * edge->along[0] + edge->from[1] * edge->along[1]);
    const double height = edge->from[0] * edge->along[1] - edge->from[1] * edge->along[0];
    for (int i = 0; i < 4; i++) {
        double middle = foot, half = 0;
        if (edge->arc) {
            middle = to_centre;
            if (distance == 0) continue;
            const double cosine =
                (edge->radius * edge->radius + distance * distance - fronts[i] * fronts[i]) /
                (2 * edge->radius * distance);
            if (i > 0 && fabs(cosine) > 1) continue;
            half = i == 0 ? 0 : acos(cosine);
        } else if (i > 0) {
            if (fronts[i] <= fabs(height)) continue;
            half = sqrt(fronts[i] * fronts[i] - height * height);
        }
        for (int sign = -1; sign <= 1; sign += 2) {
            double at = middle + sign * half;
            if (edge->arc) at -= length * floor(at / length);
            if (at > 0 && at < length) cut[cuts++] = at;
        }
    }
    qsort(cut, cuts, sizeof *cut, ascending);
    double sum = 0;
    for (size_t i = 0; i + 1 < cuts; i++) {
        const double piece = cut[i + 1] - cut[i];
        if (piece < 1e-14 * length) continue;
        for (size_t j = 0; j < rule->n; j++) {
            double u = 0, weight = 0; /* s = cut + piece u^2 (3 - 2 u): roots at both ends are taken up */
            gsl_integration_glfixed_point(0, 1, j, &u, &weight, rule);
            sum +=
                6 * weight * piece * u * (1 - u) * edge_integrand(cut[i] + piece * u * u * (3 - 2 * u), edge);
        }
    }
    return sum;
}

selas_status lamb_closed_step(const struct lamb_closed *closed, const struct patch *patch, double x, double y,
                              double t, double displacement[3], struct messages *messages)
{
    displacement[0] = displacement[1] = displacement[2] = 0;
    if (t <= 0) return SELAS_OK;
    gsl_errors_returned();
    gsl_integration_glfixed_table *rule =
        gsl_integration_glfixed_table_alloc(patch->shape == PATCH_DISC ? 3 * NODES : NODES);
    gsl_errors_as_before();
    if (rule == NULL) return fail(messages, SELAS_NO_MEMORY, "not enough memory for a quadrature");
    const bool disc = patch->shape == PATCH_DISC;
    static const double turns[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    for (int side = 0; side < (disc ? 1 : 4); side++) {
        struct edge edge = {.closed = closed, .t = t, .arc = disc};
        double length = 2 * M_PI;
        if (disc) {
            edge.radius = patch->half[0];
            edge.centre[0] = -x;
            edge.centre[1] = -y;
        } else {
            /* counter-clockwise, from the corner where the side begins */
            for (int i = 0; i < 2; i++) {
                edge.along[i] = turns[side][i];
                edge.from[i] =
                    patch->half[i] * (-turns[side][i] + turns[(side + 3) % 4][i]) - (i == 0 ? x : y);
            }
            length = 2 * (side % 2 == 0 ? patch->half[0] : patch->half[1]);
        }
        for (edge.which = 0; edge.which < 3; edge.which++)
            displacement[edge.which] += over_edge(&edge, length, rule) / (2 * M_PI * closed->mu);
    }
    gsl_integration_glfixed_table_free(rule);
    return SELAS_OK;
}
