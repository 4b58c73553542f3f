/* The half-space's reference: FFT against the accepted samples and against the closed form, limits, and each
 * piece alone. Errors are L2 of a velocity component's difference over the L2 of the largest component. */
#include "exact/lamb_fft.h"
#include "lamb_closed.h"

#include "few.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { MOST_ROWS = 256 };

static const struct patch square = {PATCH_RECTANGLE, {0, 0}, {.5, .5}};
static const struct history triangle = {.kind = HISTORY_TRIANGLE, .duration = 2};
static const struct history smoothed = {.kind = HISTORY_TRIANGLE, .duration = 2, .smoothing = 1};
static const struct history gaussian = {.kind = HISTORY_GAUSSIAN, .width = .3, .delay = 2};

static double lambda_of(double nu)
{
    return 2 * nu / (1 - 2 * nu);
}

static void compute(const struct lamb_problem *problem, double end, size_t n, struct lamb_signal *signal)
{
    struct messages messages = {0};
    assert_int_equal(lamb_fft(problem, end, n, signal, &messages), SELAS_OK);
    messages_free(&messages);
}

/* Largest L2 error among the components over the L2 of the largest one. */
static double l2_error(size_t n, const double *velocity, const double *expected)
{
    double wrong[3] = {0}, size[3] = {0};
    for (size_t i = 0; i < 3 * n; i++) {
        wrong[i % 3] += (velocity[i] - expected[i]) * (velocity[i] - expected[i]);
        size[i % 3] += expected[i] * expected[i];
    }
    return sqrt(fmax(wrong[0], fmax(wrong[1], wrong[2])) / fmax(size[0], fmax(size[1], size[2])));
}

static void velocities(const struct lamb_problem *problem, const struct lamb_signal *signal, size_t n,
                       const double *time, double *velocity)
{
    for (size_t i = 0; i < n; i++) {
        double value[6];
        lamb_signal_value(problem, signal, time[i], value);
        memcpy(velocity + 3 * i, value + 3, 3 * sizeof *velocity);
    }
}

/* Rows t, then columns; returns how many rows. */
static size_t read_sample(const char *name, const int column[3], double *time, double *velocity)
{
    char path[256], line[512];
    (void)snprintf(path, sizeof path, "regress/reference/lamb/%s.csv", name);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    size_t rows = 0;
    while (fgets(line, sizeof line, file) != NULL) {
        if (line[0] == '#') continue;
        double value[7] = {0};
        char *at = line;
        for (int i = 0; i < 7 && *at != '\0' && *at != '\n'; i++) {
            value[i] = strtod(at, &at);
            if (*at == ',') at++;
        }
        assert_true(rows < MOST_ROWS);
        time[rows] = value[0];
        for (int i = 0; i < 3; i++)
            velocity[3 * rows + (size_t)i] = value[column[i]];
        rows++;
    }
    assert_int_equal(fclose(file), 0);
    return rows;
}

static void compare_samples(const struct history *history, size_t n, const char *const *name,
                            const double (*position)[3], const int column[3], double most)
{
    const struct lamb_load load = {square, {0, 0, 1}, history};
    struct lamb_problem problem = {.loads = 1, .load = &load};
    half_space_set(&problem.ground, 1, 1, 1);
    struct lamb_signal signal[3] = {0};
    for (size_t i = 0; i < n; i++)
        memcpy(signal[i].position, position[i], sizeof position[i]);
    compute(&problem, 10, n, signal);
    for (size_t i = 0; i < n; i++) {
        double time[MOST_ROWS], expected[3 * MOST_ROWS], velocity[3 * MOST_ROWS];
        const size_t rows = read_sample(name[i], column, time, expected);
        assert_true(rows > 90);
        velocities(&problem, &signal[i], rows, time, velocity);
        print_message("# %s: %.1e of %.1e, estimate %.1e\n", name[i], l2_error(rows, velocity, expected),
                      most, signal[i].effort.estimate);
        assert_true(l2_error(rows, velocity, expected) < most);
        lamb_signal_free(&signal[i]);
    }
}

static void samples_are_met(void **state)
{
    (void)state;
    const int columns[3] = {4, 6, 2}, smooth_columns[3] = {2, 3, 1};
    const char *const surface[] = {"nu0.25_tri_x0_y0_z0", "nu0.25_tri_x1_y0_z0", "nu0.25_tri_x2_y0_z0"};
    const char *const inside[] = {"nu0.25_tri_x0_y0_z1", "nu0.25_tri_x1_y0_z1"};
    const char *const smooth[] = {"nu0.25_smooth1_x0_y0_z0", "nu0.25_smooth1_x1_y0_z0",
                                  "nu0.25_smooth1_x2_y0_z0"};
    const double at_surface[3][3] = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}},
                 at_depth[2][3] = {{0, 0, 1}, {1, 0, 1}};
    compare_samples(&triangle, 3, surface, at_surface, columns, 1e-5);
    compare_samples(&triangle, 2, inside, at_depth, columns, 5e-5);
    compare_samples(&smoothed, 3, smooth, at_surface, smooth_columns, 2e-6);
}

/* Receivers inside, on the edge, near a corner, outside and far. */
static const double receivers[10][3] = {{.25, .1, 0},  {.5, .2, 0},   {.45, -.45, 0}, {.7, .6, 0},
                                        {1.3, -.7, 0}, {-1.5, .3, 0}, {0, 1.9, 0},    {-2, -2, 0},
                                        {3, .4, 0},    {.6, 4.1, 0}};

/* The FFT against the closed form at the receivers from..until. */
static void compare_closed_at(double nu, const struct patch *patch, const struct history *history, size_t n,
                              const double (*at)[3], double most)
{
    enum { ROWS = 24 };
    const double end = 5;
    struct messages messages = {0};
    struct lamb_closed closed;
    assert_int_equal(lamb_closed_set(&closed, 1, lambda_of(nu), 1, &messages), SELAS_OK);
    const struct lamb_load load = {*patch, {0, 0, 1}, history};
    struct lamb_problem problem = {.loads = 1, .load = &load};
    if (history->kind == HISTORY_TRIANGLE && history->smoothing <= 0)
        problem.tolerance = 6e-5; /* the closed form judges what is reached */
    half_space_set(&problem.ground, 1, lambda_of(nu), 1);
    struct lamb_signal signal[10] = {0};
    for (size_t i = 0; i < n; i++)
        memcpy(signal[i].position, at[i], sizeof at[0]);
    compute(&problem, end, n, signal);
    double time[ROWS], velocity[3 * ROWS], expected[3 * ROWS];
    for (size_t i = 0; i < ROWS; i++)
        time[i] = end * ((double)i + .37) / ROWS;
    for (size_t i = 0; i < n; i++) {
        const double *x = signal[i].position;
        assert_int_equal(
            lamb_closed_velocity(&closed, patch, x[0], x[1], history, ROWS, time, expected, &messages),
            SELAS_OK);
        velocities(&problem, &signal[i], ROWS, time, velocity);
        const double error = l2_error(ROWS, velocity, expected);
        if (!(error < most)) print_error("nu %g at %g %g: %.2e\n", nu, x[0], x[1], error);
        assert_true(error < most);
        lamb_signal_free(&signal[i]);
    }
    messages_free(&messages);
}

static void compare_closed(double nu, const struct patch *patch, const struct history *history, size_t from,
                           size_t until, double most)
{
    compare_closed_at(nu, patch, history, until - from, receivers + from, most);
}

static void kinked_pulse_meets_closed_form(void **state)
{
    (void)state;
    compare_closed(.1, &square, &triangle, 0, (size_t)few_of(4, 1), 1e-4);
    compare_closed(.25, &square, &triangle, 0, (size_t)few_of(10, 2), 1e-4);
    compare_closed(.4, &square, &triangle, 1, (size_t)few_of(6, 2), 1e-4);
    compare_closed(.45, &square, &triangle, 1, (size_t)few_of(4, 2), 1e-4);
    compare_closed(.45, &square, &triangle, 7, 9, 1e-4);
}

/* On and close to an edge a short pulse asks most. */
static void short_pulse_meets_closed_form(void **state)
{
    (void)state;
    const struct history brief = {.kind = HISTORY_TRIANGLE, .duration = .5};
    compare_closed(.25, &square, &brief, 1, 2, 1e-4);
    compare_closed(.45, &square, &brief, 1, 2, 1e-4);
}

static void smooth_pulse_meets_closed_form(void **state)
{
    (void)state;
    compare_closed(.1, &square, &smoothed, 0, (size_t)few_of(3, 1), 1e-5);
    compare_closed(.25, &square, &gaussian, 3, (size_t)few_of(6, 4), 1e-5);
    compare_closed(.4, &square, &gaussian, 5, (size_t)few_of(8, 6), 1e-5);
    compare_closed(.45, &square, &smoothed, 6, (size_t)few_of(10, 7), 1e-5);
}

/* The same scene in other units: lengths by 10 m, density 2000 kg/m3, mu 1.8e9 Pa, traction 3e5 Pa. */
static void units_do_not_matter(void **state)
{
    (void)state;
    const double length = 10, density = 2000, mu = 1.8e9, traction = 3e5, nu = .31;
    const double duration = length / sqrt(mu / density); /* unit of time */
    for (int depth = 0; depth < 2; depth++) {
        const struct history here = {.kind = HISTORY_TRIANGLE, .duration = 2, .smoothing = .7};
        const struct history there = {
            .kind = HISTORY_TRIANGLE, .duration = 2 * duration, .smoothing = .7 * duration};
        const struct patch large = {PATCH_RECTANGLE, {0, 0}, {.5 * length, .5 * length}};
        const struct lamb_load load[2] = {{square, {.5, 0, 1}, &here},
                                          {large, {.5 * traction, 0, traction}, &there}};
        struct lamb_problem problem[2] = {{.loads = 1, .load = &load[0]}, {.loads = 1, .load = &load[1]}};
        half_space_set(&problem[0].ground, 1, lambda_of(nu), 1);
        half_space_set(&problem[1].ground, density, mu * lambda_of(nu), mu);
        struct lamb_signal signal[2] = {{.position = {.8, .3, .4 * depth}}};
        for (int i = 0; i < 3; i++)
            signal[1].position[i] = length * signal[0].position[i];
        compute(&problem[0], 4, 1, &signal[0]);
        compute(&problem[1], 4 * duration, 1, &signal[1]);
        for (double t = .1; t < 4; t += .3) {
            double value[2][6];
            lamb_signal_value(&problem[0], &signal[0], t, value[0]);
            lamb_signal_value(&problem[1], &signal[1], t * duration, value[1]);
            for (int i = 0; i < 6; i++) {
                const double unit = (i < 3 ? length : length / duration) * traction / mu;
                assert_true(fabs(value[1][i] / unit - value[0][i]) < 1e-9);
            }
        }
        for (int i = 0; i < 2; i++)
            lamb_signal_free(&signal[i]);
    }
}

/* Sums end sooner below the surface: where both ends are near each other, too, nothing jumps with the depth. */
static void depths_go_on_evenly(void **state)
{
    (void)state;
    const double depth[] = {.09, .12, .102, .104, .106, .107, .108};
    const struct lamb_load load = {square, {1, 0, 0}, &gaussian};
    struct lamb_problem problem = {.loads = 1, .load = &load};
    struct lamb_signal signal[7] = {{.position = {0}}};
    half_space_set(&problem.ground, 1, 1, 1);
    for (int i = 0; i < 7; i++) {
        const double position[3] = {1, .5, depth[i]};
        memcpy(signal[i].position, position, sizeof position);
        compute(&problem, 6, 1, &signal[i]);
    }
    for (int i = 2; i < 7; i++)
        for (double t = .5; t < 6; t += .5) {
            double value[3][6];
            const int from[3] = {0, 1, i};
            for (int k = 0; k < 3; k++)
                lamb_signal_value(&problem, &signal[from[k]], t, value[k]);
            const double part = (depth[i] - depth[0]) / (depth[1] - depth[0]);
            for (int c = 0; c < 6; c++) /* up to some .14 */
                assert_true(fabs((1 - part) * value[0][c] + part * value[1][c] - value[2][c]) < 2e-4);
        }
    for (int i = 0; i < 7; i++)
        lamb_signal_free(&signal[i]);
}

static void disc_meets_closed_form(void **state)
{
    (void)state;
    const struct patch disc = {PATCH_DISC, {0, 0}, {.6, .6}};
    static const double special[3][3] = {{0, 0, 0}, {.6, 0, 0}, {.36, -.48, 0}}; /* its centre and its rim */
    compare_closed(.3, &disc, &gaussian, 4, 5, 1e-5);
    compare_closed_at(.3, &disc, &gaussian, 3, special, 1e-5);
}

/* Before the reflection from the edges the ground under the load is a plane wave, v = f/(rho cp); long after
 * a smoothed step it is Boussinesq's: (1 - nu)/(2 pi mu) 4 ln(1 + sqrt 2) at the centre of the unit square.
 * Nothing moves before the P wave. */
static void limits_hold(void **state)
{
    (void)state;
    const double nu = .3;
    const struct history step = {.kind = HISTORY_STEP, .smoothing = .4};
    const struct lamb_load load = {square, {0, 0, 2}, &step};
    struct lamb_problem problem = {.loads = 1, .load = &load};
    half_space_set(&problem.ground, 1.7, 3 * lambda_of(nu), 3);
    struct lamb_signal signal[2] = {{.position = {0, 0, 0}}, {.position = {3, 0, 2}}};
    compute(&problem, 12, 2, signal);
    double value[6];
    const double cp = problem.ground.p_speed;
    for (double t = .05; t < .5 / cp; t += .05) {
        lamb_signal_value(&problem, &signal[0], t, value);
        assert_true(fabs(value[5] - 2 * history_value(&step, t, 0) / (1.7 * cp)) < 1e-5);
    }
    lamb_signal_value(&problem, &signal[0], 11, value);
    assert_true(fabs(value[2] / (2 * (1 - nu) / (2 * M_PI * 3) * 4 * log(1 + M_SQRT2)) - 1) < 1e-5);
    for (double t = .1; t < hypot(2.5, 2) / cp; t += .1) {
        lamb_signal_value(&problem, &signal[1], t, value);
        for (int i = 0; i < 6; i++)
            assert_true(fabs(value[i]) < 1e-6);
    }
    for (int i = 0; i < 2; i++)
        lamb_signal_free(&signal[i]);
}

/* Stress at the surface by one-sided differences of the compliances: the traction that was put on, nothing
 * else. */
static void compliances_carry_the_load(void **state)
{
    (void)state;
    const double forward[5] = {-25. / 12, 4, -3, 4. / 3, -1. / 4}, step = 1e-3;
    for (double nu = -.3; nu < .5; nu += .195)
        for (int i = 0; i < 6; i++) {
            struct half_space ground;
            half_space_set(&ground, 1, lambda_of(nu), 1);
            const double k = .3 + 1.7 * i, stiff = 1 / ground.ratio;
            const double complex s = .4 + 3 * I;
            struct compliance at[5];
            for (int j = 0; j < 5; j++)
                half_space_compliance(&ground, s, j * step, 1, &k, true, false, &at[j]);
#define VALUE(name, j) (at[j].name[0][0] + I * at[j].name[1][0])
#define SLOPE(name)                                                                                          \
    ((forward[0] * VALUE(name, 0) + forward[1] * VALUE(name, 1) + forward[2] * VALUE(name, 2) +              \
      forward[3] * VALUE(name, 3) + forward[4] * VALUE(name, 4)) /                                           \
     step)
            /* -sigma_zz = T: u_r = i horizontal; -sigma_rz = 0 */
            assert_true(cabs(-stiff * SLOPE(vertical) + (stiff - 2) * k * VALUE(horizontal, 0) - 1) < 1e-6);
            assert_true(cabs(SLOPE(horizontal) + k * VALUE(vertical, 0)) < 1e-6);
            assert_true(cabs(-SLOPE(radial) + k * VALUE(coupled, 0) - 1) < 1e-6);
            assert_true(cabs(stiff * SLOPE(coupled) + (stiff - 2) * k * VALUE(radial, 0)) < 1e-6);
            assert_true(cabs(-SLOPE(shear) - 1) < 1e-6);
            /* static limit, by slowness and by wavenumber */
            double rest[5];
            const double fast = 1e4 * k;
            struct compliance slow;
            half_space_compliance(&ground, 1e-4 * s, .2e-3, 1, &k, true, false, &slow);
            half_space_static(&ground, .2e-3, k, rest);
            assert_true(fabs(slow.vertical[0][0] / rest[0] - 1) < 1e-4);
            assert_true(fabs(slow.radial[0][0] / rest[2] - 1) < 1e-4);
            half_space_compliance(&ground, s, 0, 1, &fast, true, false, &slow);
            half_space_static(&ground, 0, fast, rest);
            assert_true(fabs(slow.vertical[0][0] / rest[0] - 1) < 1e-4);
            assert_true(fabs(slow.horizontal[0][0] - rest[1]) < 1e-4 * rest[0]);
            assert_true(fabs(slow.coupled[0][0] - rest[3]) < 1e-4 * rest[0]);
        }
}

/* Left side of the Rayleigh equation in y = s^2 / (s_speed k)^2, Re y > -1. */
static double complex rayleigh_function(const struct half_space *ground, double complex y)
{
    return (2 + y) * (2 + y) - 4 * csqrt(1 + ground->ratio * y) * csqrt(1 + y);
}

static void rayleigh_speed_is_known(void **state)
{
    (void)state;
    struct half_space ground;
    half_space_set(&ground, 1, 1, 1); /* nu = 1/4: (cR/cs)^2 = 2 - 2/sqrt 3 */
    assert_true(fabs(ground.rayleigh - (2 - 2 / sqrt(3))) < 1e-15);
    for (double nu = -.9; nu < .5; nu += .0999) {
        half_space_set(&ground, 2.5, 4 * lambda_of(nu), 4);
        assert_true(cabs(rayleigh_function(&ground, -ground.rayleigh)) < 1e-13);
        assert_true(ground.rayleigh > 0 && ground.rayleigh < 1);
    }
}

/* Midpoint sums over the patch against the potentials, at complex depth. */
static void potentials_are_integrals(void **state)
{
    (void)state;
    enum { CELLS = 300 };
    const double half[2] = {.5, .3}, place[3][2] = {{0, 0}, {1, .2}, {.3, -.1}};
    const double complex depth[2] = {.4, .3 - .7 * I};
    for (int q = 0; q < 3; q++)
        for (int e = 0; e < 2; e++) {
            struct potentials p, sum = {0};
            const double complex d = depth[e];
            rectangle_potentials(half, place[q][0], place[q][1], d, &p);
            const double area = 4 * half[0] * half[1] / CELLS / CELLS;
            for (int i = 0; i < CELLS; i++)
                for (int j = 0; j < CELLS; j++) {
                    const double u = place[q][0] + half[0] * (1 - (2 * i + 1.) / CELLS);
                    const double v = place[q][1] + half[1] * (1 - (2 * j + 1.) / CELLS);
                    const double complex r = csqrt(u * u + v * v + d * d);
                    sum.plain += area / r;
                    sum.angle += area * d / (r * r * r);
                    sum.plain_x -= area * u / (r * r * r);
                    sum.once_y += area * v / (r * (r + d));
                    sum.once_xy -= area * u * v * (2 * r + d) / (r * r * r * (r + d) * (r + d));
                    sum.twice_x -= area * u / (r + d);
                    sum.twice_xx += area * (-1 / (r + d) + u * u / (r * (r + d) * (r + d)));
                }
            assert_true(cabs(p.plain - sum.plain) < 1e-4);
            assert_true(cabs(p.angle - sum.angle) < 1e-4);
            assert_true(cabs(p.plain_x - sum.plain_x) < 1e-4);
            assert_true(cabs(p.once_y - sum.once_y) < 1e-4);
            assert_true(cabs(p.once_xy - sum.once_xy) < 1e-4);
            assert_true(cabs(p.twice_x - sum.twice_x) < 1e-4);
            assert_true(cabs(p.twice_xx - sum.twice_xx) < 1e-4);
        }
}

/* Horizontal and vertical point loads are reciprocal: uz at the distance x under a force along x is minus ux
 * under a force along z. Two loads add up. */
static void loads_are_reciprocal(void **state)
{
    (void)state;
    const struct patch point = {PATCH_POINT, {0, 0}, {0, 0}};
    double value[3][6];
    for (int which = 0; which < 3; which++) {
        const struct lamb_load load[2] = {{point, {which == 0, 0, which == 1}, &gaussian},
                                          {point, {0, 0, 1}, &gaussian}};
        const struct lamb_load both[2] = {{point, {1, 0, 0}, &gaussian}, load[1]};
        struct lamb_problem problem = {.loads = which == 2 ? 2 : 1, .load = which == 2 ? both : load};
        half_space_set(&problem.ground, 1, 1, 1);
        struct lamb_signal signal = {.position = {1.1, 0, 0}};
        compute(&problem, 4, 1, &signal);
        lamb_signal_value(&problem, &signal, 3.3, value[which]);
        lamb_signal_free(&signal);
    }
    assert_true(fabs(value[0][5]) > .01);
    assert_true(fabs(value[0][5] + value[1][3]) < 1e-6);
    for (int i = 0; i < 6; i++)
        assert_true(fabs(value[2][i] - value[0][i] - value[1][i]) < 1e-6);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(rayleigh_speed_is_known),
        cmocka_unit_test(compliances_carry_the_load),
        cmocka_unit_test(potentials_are_integrals),
        cmocka_unit_test(loads_are_reciprocal),
        cmocka_unit_test(limits_hold),
        cmocka_unit_test(samples_are_met),
        cmocka_unit_test(kinked_pulse_meets_closed_form),
        cmocka_unit_test(short_pulse_meets_closed_form),
        cmocka_unit_test(smooth_pulse_meets_closed_form),
        cmocka_unit_test(units_do_not_matter),
        cmocka_unit_test(depths_go_on_evenly),
        cmocka_unit_test(disc_meets_closed_form),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
