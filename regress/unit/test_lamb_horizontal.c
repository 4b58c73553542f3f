/* Horizontal loads and kinked discs on the half-space's surface in closed form, for lamb_fft.c.
 *
 * A unit step of traction along x on a patch; (r, theta) about the receiver, rho = r/(cs t):
 *   2 pi mu u_x/(cs t) = contour-int [(A_R + A_S)/2 - cos(2 theta) (B_R - B_S)/2] dtheta,
 *   2 pi mu u_y/(cs t) = contour-int -sin(2 theta) (B_R - B_S)/2 dtheta                       (1)
 * (n_x^2 -> (J0 - cos(2 theta) J2)/2, n_x n_y -> -sin(2 theta) J2/2; A, B: integrals over rho of what J0 and
 * J2 make). A step's compliance F(gamma)/(mu k), gamma = s/(i k cs), is real in time as
 *   (2/pi) PV-int Re F(gamma)/gamma sin(gamma k cs t) dgamma,                                 (2)
 *   F_R = -gamma^2 q/[(2 - gamma^2)^2 - 4 p q],  p = sqrt(1 - a gamma^2), q = sqrt(1 - gamma^2), (3)
 * Re F_R = 0 beyond cp/cs. int J0(k r) sin(k b) dk = H(b > r)/sqrt(b^2 - r^2) and, for J2, 2 b/r^2 (b < r) or
 * -r^2/(w (b + w)^2), w = sqrt(b^2 - r^2), integrated over r:
 *   A = (2/pi) PV-int Re F [1 - sqrt(1 - sin^2 alpha)] dgamma,  sin alpha = min(1, rho/gamma) (4)
 *   B = (2/pi) PV-int Re F [4 ln cos(alpha/2) + 2 sin^2(alpha/2) + 2 ln max(1, rho/gamma)] dgamma (5)
 * The pole at g = c_R/cs, kappa/(g^2 - gamma^2), is taken out; alone it gives (by cosines)
 *   A = kappa/g^2 [rho - w],  B = kappa/g^2 [rho - w + 2 g arccos(g/rho)],
 *   w = sqrt(rho^2 - g^2),  rho > g                                                           (6)
 * and rho without the rest before. SH waves:
 *   A_S = min(rho, 1),  B_S = rho, beyond 1: 1 + 2 ln rho.                                    (7)
 * The point load's form of this is Chao's (1960, J. Appl. Mech. 27, 559-567). u_z of Tx is -u_x of Tz:
 * Pekeris (lamb_closed.c). Velocity under a triangle is a sum of three step displacements. */
#include "exact/gauss12.h"
#include "exact/lamb_fft.h"
#include "lamb_closed.h"

#include "few.h"
#include "near.h"

#include <stdlib.h>

struct sheet {
    double a, fastest, rayleigh, pole; /* a; cp/cs; g; kappa of Eq 6 */
};

static struct sheet sheet_of(const struct half_space *ground)
{
    struct sheet sheet = {.a = ground->ratio, .fastest = 1 / sqrt(ground->ratio)};
    const double a = sheet.a;
    double low = .5, high = 1 - 1e-9; /* (2 - g^2)^2 - 4 p q: negative below the Rayleigh speed */
    for (int i = 0; i < 100; i++) {
        const double g = .5 * (low + high), y = g * g;
        if ((2 - y) * (2 - y) < 4 * sqrt((1 - a * y) * (1 - y)))
            low = g;
        else
            high = g;
    }
    const double g = sheet.rayleigh = .5 * (low + high), y = g * g, p = sqrt(1 - a * y), q = sqrt(1 - y);
    const double slope = -4 * g * (2 - y) + 4 * g * (a * q / p + p / q);
    sheet.pole = 2 * g * y * q / slope;
    return sheet;
}

/* Re F of Eq 3 without the pole. */
static double remainder_at(const struct sheet *sheet, double gamma)
{
    const double y = gamma * gamma, p = sqrt(fmax(0, 1 - sheet->a * y)), bend = (2 - y) * (2 - y);
    const double pole = sheet->pole / (sheet->rayleigh * sheet->rayleigh - y);
    if (gamma >= sheet->fastest) return -pole;
    if (gamma > 1) return 4 * y * p * (y - 1) / (bend * bend + 16 * p * p * (y - 1)) - pole;
    /* (2 - y)^2 - 4 p q = y [y^3 - 8 y^2 + (24 - 16 a) y - 16 (1 - a)]/[(2 - y)^2 + 4 p q] */
    const double q = sqrt(1 - y), cubic = ((y - 8) * y + 24 - 16 * sheet->a) * y - 16 * (1 - sheet->a);
    return -q * (bend + 4 * p * q) / cubic - pole;
}

/* Adds the integrals 4 and 5 from one value of gamma to another: roots at the ends are taken up by
 * gamma = from + (to - from) u^2 (3 - 2u); to = infinity by its inverse. */
static void add_piece(const struct sheet *sheet, double rho, double from, double to, double sum[2])
{
    enum { PANELS = 3 };
    const double low = isinf(to) ? 0 : from, high = isinf(to) ? 1 / from : to;
    for (int panel = 0; panel < PANELS; panel++)
        for (int i = 0; i < 12; i++) {
            const double u = (panel + .5 + .5 * gauss12_node[i]) / PANELS;
            const double x = low + (high - low) * u * u * (3 - 2 * u), gamma = isinf(to) ? 1 / x : x;
            const double weight = .5 * gauss12_weight[i] / PANELS * 6 * u * (1 - u) * (high - low) *
                                  (isinf(to) ? gamma * gamma : 1);
            const double sine = fmin(1, rho / gamma), half = sin(.5 * asin(sine));
            const double value = 2 / M_PI * weight * remainder_at(sheet, gamma);
            sum[0] += value * (1 - sqrt(fmax(0, 1 - sine * sine)));
            sum[1] += value * (2 * log1p(-half * half) + 2 * half * half + 2 * log(fmax(1, rho / gamma)));
        }
}

/* (A_R + A_S)/2 and (B_R - B_S)/2. */
static void areas(const struct sheet *sheet, double rho, double area[2])
{
    const double g = sheet->rayleigh, w = rho > g ? sqrt(rho * rho - g * g) : 0;
    const double scale = sheet->pole / (g * g);
    double cut[5] = {0, 1, sheet->fastest, INFINITY, INFINITY}, sum[2];
    int cuts = 4, place = 4;
    while (place > 0 && cut[place - 1] > rho)
        place--;
    if (rho > 0) {
        for (int i = cuts++; i > place; i--)
            cut[i] = cut[i - 1];
        cut[place] = rho;
    }
    sum[0] = scale * (rho - w);
    sum[1] = scale * (rho - w + (rho > g ? 2 * g * acos(g / rho) : 0));
    for (int i = 0; i + 1 < cuts; i++) {
        double from = cut[i];
        if (i == 0) { /* Eq 5 has a logarithm at 0 */
            from = cut[1] / 4096;
            add_piece(sheet, rho, 0, from, sum);
        }
        for (; from < 1; from *= 8) { /* beyond rho the kernels fall as (rho/gamma)^2 */
            if (8 * from >= fmin(1, cut[i + 1])) break;
            add_piece(sheet, rho, from, 8 * from, sum);
        }
        if (cut[i + 1] - from > 1e-13) add_piece(sheet, rho, from, cut[i + 1], sum);
    }
    area[0] = .5 * (sum[0] + fmin(rho, 1));
    area[1] = .5 * (sum[1] - (rho < 1 ? rho : 1 + 2 * log(rho)));
}

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* One side of a patch's edge, seen from the receiver: a line or a circle. */
struct side {
    double from[2], along[2], length; /* line; circle: its centre is `from`, length 2 pi */
    double radius;
};

static void side_at(const struct side *side, double s, double place[2], double slope[2])
{
    for (int i = 0; i < 2; i++) {
        const double turn = i == 0 ? cos(s) : sin(s), next = i == 0 ? -sin(s) : cos(s);
        place[i] = side->from[i] + (side->radius > 0 ? side->radius * turn : s * side->along[i]);
        slope[i] = side->radius > 0 ? side->radius * next : side->along[i];
    }
}

/* Ascending places between which the integrand is smooth: where the fronts cross, and the nearest one. */
static size_t cuts_of(const struct side *side, const double front[4], double cut[12])
{
    size_t cuts = 2;
    const double distance = hypot(side->from[0], side->from[1]), radius = side->radius;
    const double foot = -side->from[0] * side->along[0] - side->from[1] * side->along[1];
    const double height = side->from[0] * side->along[1] - side->from[1] * side->along[0];
    cut[0] = 0;
    cut[1] = side->length;
    for (int i = 0; i < 4; i++) {
        double middle = foot, half = i == 0 ? 0 : sqrt(fmax(0, front[i] * front[i] - height * height));
        if (radius > 0) {
            const double cosine = (radius * radius + distance * distance - front[i] * front[i]) /
                                  (2 * radius * fmax(distance, 1e-300));
            middle = atan2(-side->from[1], -side->from[0]);
            half = i == 0 ? 0 : acos(fmin(1, fmax(-1, cosine)));
        }
        for (int sign = -1; sign <= 1; sign += 2) {
            double at = middle + sign * half;
            if (radius > 0) at -= 2 * M_PI * floor(at / (2 * M_PI));
            if (at > 0 && at < side->length) cut[cuts++] = at;
        }
    }
    qsort(cut, cuts, sizeof *cut, ascending);
    return cuts;
}

/* Adds one side's share of Eq 1, times 2 pi mu / reach; reach = cs t. */
static void add_side(const struct sheet *sheet, const struct side *side, double reach, double u[2])
{
    const double front[4] = {0, sheet->rayleigh * reach, reach, sheet->fastest * reach};
    double cut[12];
    const size_t cuts = cuts_of(side, front, cut);
    for (size_t piece = 0; piece + 1 < cuts; piece++)
        for (int i = 0; i < 24; i++) {
            const double v = .25 + .5 * (i / 12) + .25 * gauss12_node[i % 12];
            const double width = cut[piece + 1] - cut[piece], s = cut[piece] + width * v * v * (3 - 2 * v);
            double at[2], slope[2], area[2];
            side_at(side, s, at, slope);
            const double square = at[0] * at[0] + at[1] * at[1];
            const double turn = (at[0] * slope[1] - at[1] * slope[0]) / square; /* d(theta)/ds */
            const double weight = .25 * gauss12_weight[i % 12] * 6 * v * (1 - v) * width * turn;
            if (weight == 0) continue;
            areas(sheet, sqrt(square) / reach, area);
            u[0] += weight * (area[0] - (at[0] * at[0] - at[1] * at[1]) / square * area[1]);
            u[1] -= weight * 2 * at[0] * at[1] / square * area[1];
        }
}

/* u_x, u_y at (x, y) from the patch's centre, a time t after a unit step along x; cs = mu = 1. */
static void horizontal_step(const struct sheet *sheet, const struct patch *patch, double x, double y,
                            double t, double u[2])
{
    static const double turns[4][2] = {{1, 0}, {0, 1}, {-1, 0}, {0, -1}};
    u[0] = u[1] = 0;
    if (t <= 0) return;
    if (patch->shape == PATCH_DISC)
        add_side(sheet, &(struct side){{-x, -y}, {0, 0}, 2 * M_PI, patch->half[0]}, t, u);
    for (int i = 0; i < 4 && patch->shape == PATCH_RECTANGLE; i++) {
        const double *along = turns[i], *before = turns[(i + 3) % 4];
        const struct side side = {
            {patch->half[0] * (before[0] - along[0]) - x, patch->half[1] * (before[1] - along[1]) - y},
            {along[0], along[1]},
            2 * patch->half[i % 2],
            0};
        add_side(sheet, &side, t, u);
    }
    u[0] *= t / (2 * M_PI);
    u[1] *= t / (2 * M_PI);
}

enum { PLACES = 3, ROWS = 24 };
static const double duration = 2, end = 5;
static const struct history triangle = {.kind = HISTORY_TRIANGLE, .duration = 2};
static const double places[PLACES][2] = {{.2, -.1}, {1.3, -.7}, {-.4, 2.2}};

/* Velocity under a triangle: step displacements at its kinks. u_z of Tx is -u_x of Tz; Tz itself too. */
static void expected_velocity(const struct sheet *sheet, const struct lamb_closed *closed,
                              const struct patch *patch, const double force[2], const double place[2],
                              double t, double velocity[3])
{
    struct messages messages = {0};
    velocity[0] = velocity[1] = velocity[2] = 0;
    for (int kink = 0; kink < 3; kink++) {
        const double since = t - .5 * kink * duration, slope = (kink == 1 ? -2 : 1) / (.5 * duration);
        double across[2], down[3];
        if (since <= 0) continue;
        horizontal_step(sheet, patch, place[0], place[1], since, across);
        assert_int_equal(lamb_closed_step(closed, patch, place[0], place[1], since, down, &messages),
                         SELAS_OK);
        velocity[0] += slope * (force[0] * across[0] + force[1] * down[0]);
        velocity[1] += slope * (force[0] * across[1] + force[1] * down[1]);
        velocity[2] += slope * (-force[0] * down[0] + force[1] * down[2]);
    }
}

/* The FFT's velocities against these: L2 of a component over that of the largest, all places. */
static void compare(double nu, const struct patch *patch, double across, double down, double most)
{
    const double lambda = 2 * nu / (1 - 2 * nu);
    const struct lamb_load load = {*patch, {across, 0, down}, &triangle};
    struct lamb_problem problem = {.loads = 1, .load = &load};
    struct lamb_closed closed;
    struct messages messages = {0};
    struct lamb_signal signal[PLACES] = {0};
    const size_t count = (size_t)few_of(PLACES, 1);
    half_space_set(&problem.ground, 1, lambda, 1);
    assert_int_equal(lamb_closed_set(&closed, 1, lambda, 1, &messages), SELAS_OK);
    const struct sheet sheet = sheet_of(&problem.ground);
    for (size_t r = 0; r < count; r++)
        for (int i = 0; i < 2; i++)
            signal[r].position[i] = places[r][i];
    assert_int_equal(lamb_fft(&problem, end, count, signal, &messages), SELAS_OK);
    for (size_t r = 0; r < count; r++) {
        double wrong[3] = {0}, size[3] = {0}, largest = 0;
        for (int i = 0; i < ROWS; i++) {
            const double t = end * (i + .5) / ROWS;
            double value[6], expected[3];
            lamb_signal_value(&problem, &signal[r], t, value);
            expected_velocity(&sheet, &closed, patch, (const double[2]){across, down}, places[r], t,
                              expected);
            for (int c = 0; c < 3; c++) {
                wrong[c] += pow(value[3 + c] - expected[c], 2);
                size[c] += pow(expected[c], 2);
                largest = fmax(largest, size[c]);
            }
        }
        print_message("nu %g, %s, T = (%g, 0, %g) at (%g, %g): x %.1e, y %.1e, z %.1e; own estimate %.1e\n",
                      nu, patch->shape == PATCH_DISC ? "disc" : "rectangle", across, down, places[r][0],
                      places[r][1], sqrt(wrong[0] / largest), sqrt(wrong[1] / largest),
                      sqrt(wrong[2] / largest), signal[r].effort.estimate);
        for (int c = 0; c < 3; c++)
            assert_true(sqrt(wrong[c] / largest) < most);
        lamb_signal_free(&signal[r]);
    }
}

static const struct patch disc = {PATCH_DISC, {0, 0}, {.6, .6}},
                          rectangle = {PATCH_RECTANGLE, {0, 0}, {.5, .3}};

static void kinked_horizontal_loads(void **state)
{
    (void)state;
    compare(.25, &rectangle, 1, 0, 2e-5);
    if (few_of(0, 1)) return;
    compare(.25, &disc, 1, 0, 2e-5);
    compare(.4, &disc, 1, 0, 2e-5);
}

static void kinked_vertical_disc(void **state)
{
    (void)state;
    compare(.25, &disc, 0, 1, 2e-5);
}

/* The closed form itself: nothing before the P wave; Cerruti's solution in the end, u_x = (1 - nu + nu
 * x^2/r^2)/ (2 pi mu r) per unit force, here by the areas' slopes at rho = 0; */
static void closed_form_has_its_limits(void **state)
{
    (void)state;
    for (double nu = .25; nu < .46; nu += .1) { /* smaller ones have a peak in F that takes more panels */
        struct half_space ground;
        double area[2], other[2], u[2];
        half_space_set(&ground, 1, 2 * nu / (1 - 2 * nu), 1);
        const struct sheet sheet = sheet_of(&ground);
        assert_near(sheet.rayleigh, ground.rayleigh_speed, 1e-12);
        areas(&sheet, 1e-3, area);
        assert_near(area[0], 1e-3 * (1 - .5 * nu), 1e-11);
        assert_near(area[1], -1e-3 * .5 * nu, 1e-11);
        areas(&sheet, 1.001 * sheet.fastest, area);
        areas(&sheet, 3 * sheet.fastest, other);
        assert_near(other[0], area[0], 1e-7);
        assert_near(other[1], area[1], 1e-7);
        horizontal_step(&sheet, &disc, 1.3, -.7, .99 * (hypot(1.3, .7) - .6) / sheet.fastest, u);
        assert_near(u[0], 0, 1e-7);
        assert_near(u[1], 0, 1e-7);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(closed_form_has_its_limits),
        cmocka_unit_test(kinked_horizontal_loads),
        cmocka_unit_test(kinked_vertical_disc),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
