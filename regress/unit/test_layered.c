/* Layered ground: compliances against the equations of motion integrated over depth, limits in one dimension
 * and at rest, passivity; histories against the homogeneous half-space. */
#include "exact/lamb_fft.h"
#include "exact/layered.h"

#include "near.h"

#include <string.h>

static const struct stratum soft_on_rock[3] = {
    {0, .8, .25, .9, .55901699437494745}, {.7, 1.1, .6, 1.4, .73854894587599478}, {1.5, 1, 1, 1.7320508, 1}};
static const double wavenumbers[6] = {.05, .4, 1.3, 3, 6, 11};

static struct layered *layers(size_t count, const struct stratum *stratum)
{
    struct messages messages = {0};
    struct layered *layered = NULL;
    assert_int_equal(layered_from(count, stratum, &layered, &messages), SELAS_OK);
    return layered;
}

static double complex part(double values[2][BLOCK], size_t i)
{
    return values[0][i] + I * values[1][i];
}

/* Motion and stress (U, W, tau, sigma) of (k, s) space, and (V, tau) across the plane: d/dz of both by the
 * equations of motion, with u_r = i U, s_rz = i tau. */
static void rate(const struct stratum *stratum, double k, double complex s, const double complex y[6],
                 double complex dy[6])
{
    const double p_modulus = stratum->density * stratum->p_speed * stratum->p_speed, mu = stratum->mu;
    const double lambda = p_modulus - 2 * mu;
    const double complex inertia = stratum->density * s * s;
    dy[0] = y[2] / mu - k * y[1];
    dy[1] = (y[3] + lambda * k * y[0]) / p_modulus;
    dy[2] = inertia * y[0] + k * (p_modulus * k * y[0] - lambda * dy[1]);
    dy[3] = inertia * y[1] + k * y[2];
    dy[4] = y[5] / mu;
    dy[5] = inertia * y[4] + k * k * mu * y[4];
}

/* From depth z up by `height` in one material, fourth order Runge-Kutta. */
static void integrate_up(const struct stratum *stratum, double height, double k, double complex s,
                         double complex y[6])
{
    enum { STEPS = 1500 };
    const double step = -height / STEPS;
    for (int i = 0; i < STEPS; i++) {
        double complex slope[4][6], at[6];
        rate(stratum, k, s, y, slope[0]);
        for (int stage = 1; stage < 4; stage++) {
            for (int c = 0; c < 6; c++)
                at[c] = y[c] + (stage == 3 ? 1 : .5) * step * slope[stage - 1][c];
            rate(stratum, k, s, at, slope[stage]);
        }
        for (int c = 0; c < 6; c++)
            y[c] += step / 6 * (slope[0][c] + 2 * slope[1][c] + 2 * slope[2][c] + slope[3][c]);
    }
}

/* Waves going down in the half-space, integrated up through the layers to the surface and, on the way, to
 * depth z: u(z) per traction on the surface. */
static void by_integration(double z, double k, double complex s, double complex expected[5])
{
    const struct stratum *rock = &soft_on_rock[2];
    const double complex p = csqrt(k * k + s * s / (rock->p_speed * rock->p_speed)),
                         q = csqrt(k * k + s * s / (rock->s_speed * rock->s_speed));
    const double complex w = s * s / (rock->s_speed * rock->s_speed), kap = 2 * k * k + w;
    const double from = fmax(z, rock->top), below = from - rock->top, mu = rock->mu;
    double complex at[3][6], top[3][6];
    const double complex start[3][6] = {{k, -p, -2 * mu * k * p, mu * kap, 0, 0},
                                        {q, -k, -mu * kap, 2 * mu * k * q, 0, 0},
                                        {0, 0, 0, 0, 1, -mu * q}};
    for (int wave = 0; wave < 3; wave++) {
        double complex y[6];
        memcpy(y, start[wave], sizeof y);
        if (z >= from) memcpy(at[wave], y, sizeof y);
        if (below > 0) integrate_up(rock, below, k, s, y);
        for (int i = 2; i-- > 0;) {
            const double bottom = soft_on_rock[i + 1].top, face = soft_on_rock[i].top;
            const double cut = z > face && z < bottom ? z : face;
            integrate_up(&soft_on_rock[i], bottom - cut, k, s, y);
            if (z == cut) memcpy(at[wave], y, sizeof y);
            if (cut > face) integrate_up(&soft_on_rock[i], cut - face, k, s, y);
        }
        memcpy(top[wave], y, sizeof y);
    }
    /* amplitudes of the two waves for (tau, sigma) = -(Q, Z) on the surface */
    const double complex det = top[0][2] * top[1][3] - top[1][2] * top[0][3];
    const double complex for_z[2] = {top[1][2] / det, -top[0][2] / det};
    const double complex for_q[2] = {-top[1][3] / det, top[0][3] / det};
    expected[0] = for_z[0] * at[0][1] + for_z[1] * at[1][1];
    expected[1] = for_z[0] * at[0][0] + for_z[1] * at[1][0];
    expected[2] = for_q[0] * at[0][0] + for_q[1] * at[1][0];
    expected[3] = -(for_q[0] * at[0][1] + for_q[1] * at[1][1]);
    expected[4] = -at[2][4] / top[2][5];
}

static void equations_of_motion_are_met(void **state)
{
    (void)state;
    struct layered *layered = layers(3, soft_on_rock);
    const double depths[6] = {0, .3, .7, 1.2, 1.5, 2};
    const double complex s[3] = {.4, .6 + 2 * I, .5 + 9 * I};
    for (int d = 0; d < 6; d++)
        for (int j = 0; j < 3; j++) {
            struct compliance compliance;
            layered_compliance(layered, s[j], depths[d], 4, wavenumbers, true, &compliance);
            for (size_t i = 0; i < 4; i++) {
                double complex expected[5];
                by_integration(depths[d], wavenumbers[i], s[j], expected);
                const double complex found[5] = {part(compliance.vertical, i), part(compliance.horizontal, i),
                                                 part(compliance.radial, i), part(compliance.coupled, i),
                                                 part(compliance.shear, i)};
                for (int c = 0; c < 5; c++)
                    assert_near(cabs(found[c] - soft_on_rock[0].mu * expected[c]), 0,
                                2e-8 * (1 + cabs(found[c])));
            }
        }
    layered_free(&layered);
}

/* k -> 0: a layer over a half-space in one dimension, u = (1 + R e)/(1 - R e)/(rho c s) with e = exp(-2 s
 * h/c) and R = (Z1 - Z2)/(Z1 + Z2) the reflection of displacement. */
static void one_dimension_is_met(void **state)
{
    (void)state;
    const struct stratum pair[2] = {soft_on_rock[0], {.7, 1, 1, 1.7320508, 1}};
    struct layered *layered = layers(2, pair);
    const double k = 1e-7;
    for (int j = 0; j < 20; j++) {
        const double complex s = .3 + I * .7 * j;
        struct compliance compliance;
        layered_compliance(layered, s, 0, 1, &k, true, &compliance);
        for (int wave = 0; wave < 2; wave++) {
            const double c1 = wave == 0 ? pair[0].p_speed : pair[0].s_speed,
                         c2 = wave == 0 ? pair[1].p_speed : pair[1].s_speed;
            const double z1 = pair[0].density * c1, z2 = pair[1].density * c2;
            const double complex echo = (z1 - z2) / (z1 + z2) * cexp(-2 * s * pair[1].top / c1);
            const double complex expected = pair[0].mu * (1 + echo) / (1 - echo) / (z1 * s);
            const double complex found =
                wave == 0 ? part(compliance.vertical, 0) : part(compliance.radial, 0);
            assert_near(cabs(found / expected - 1), 0, 1e-11);
            if (wave == 1) assert_near(cabs(part(compliance.shear, 0) / expected - 1), 0, 1e-11);
        }
    }
    layered_free(&layered);
}

/* At rest: short waves feel the uppermost material alone, long ones the half-space alone. */
static void static_limits_are_met(void **state)
{
    (void)state;
    struct layered *layered = layers(3, soft_on_rock);
    const double k[2] = {1e-3, 30};
    const double complex s[2] = {1e-6, 1e-2};
    for (int i = 0; i < 2; i++) {
        struct half_space alone;
        const struct stratum *stratum = &soft_on_rock[i == 0 ? 2 : 0];
        const double modulus = stratum->density * stratum->p_speed * stratum->p_speed;
        struct compliance compliance;
        double expected[5];
        half_space_set(&alone, stratum->density, modulus - 2 * stratum->mu, stratum->mu);
        half_space_static(&alone, 0, k[i], expected);
        layered_compliance(layered, s[i], 0, 1, k + i, true, &compliance);
        const double factor = soft_on_rock[0].mu / stratum->mu, near = i == 0 ? 1e-2 : 1e-5;
        assert_near(compliance.vertical[0][0] / (factor * expected[0]), 1, near);
        assert_near(compliance.radial[0][0] / (factor * expected[2]), 1, near);
        assert_near(compliance.shear[0][0] / (factor * expected[4]), 1, near);
    }
    layered_free(&layered);
}

/* No overflow at any thickness; the ground takes energy in and never gives any (s C is positive real), and
 * force and motion may be exchanged (C is symmetric). */
static void ground_is_passive(void **state)
{
    (void)state;
    struct stratum thick[3];
    memcpy(thick, soft_on_rock, sizeof thick);
    struct layered *layered = layers(3, soft_on_rock);
    thick[1].top = 300;
    thick[2].top = 1000;
    struct layered *deep = layers(3, thick);
    const double far[3] = {.5, 20, 900};
    for (int j = 0; j < 40; j++) {
        const double complex s = .05 + I * .25 * j;
        struct compliance c;
        layered_compliance(layered, s, 0, 6, wavenumbers, true, &c);
        for (size_t i = 0; i < 6; i++) {
            const double vertical = creal(s * part(c.vertical, i)), radial = creal(s * part(c.radial, i));
            /* the Hermitian part of s C with C = [radial horizontal; horizontal vertical] */
            const double across = creal(s * part(c.horizontal, i));
            assert_true(vertical > 0);
            assert_true(radial > 0);
            assert_true(vertical * radial > across * across);
            assert_true(creal(s * part(c.shear, i)) > 0);
            assert_near(cabs(part(c.horizontal, i) + part(c.coupled, i)), 0, 1e-9);
        }
        layered_compliance(deep, s, 0, 3, far, true, &c);
        for (size_t i = 0; i < 3; i++)
            assert_true(isfinite(cabs(part(c.vertical, i))) && cabs(part(c.vertical, i)) > 0);
    }
    layered_free(&layered);
    layered_free(&deep);
}

static const struct history gaussian = {.kind = HISTORY_GAUSSIAN, .width = .3, .delay = 2};
static const struct history pulse = {.kind = HISTORY_TRIANGLE, .duration = 1, .smoothing = .5};
enum { PLACES = 4, ROWS = 61 };
static const double places[PLACES][3] = {{0, 0, 0}, {1.2, .3, 0}, {.6, -.4, .5}, {.6, -.4, 1.3}};

static void histories(const struct layered *layered, const struct stratum *top, const struct history *history,
                      double end, double *value)
{
    struct lamb_load load[2] = {{{PATCH_RECTANGLE, {0, 0}, {.5, .5}}, {0, 0, 1}, history},
                                {{PATCH_DISC, {.2, .1}, {.4, .4}}, {.3, .5, 0}, history}};
    struct lamb_problem problem = {.loads = history == &gaussian ? 2 : 1, .load = load, .layers = layered};
    struct lamb_signal signal[PLACES] = {0};
    struct messages messages = {0};
    half_space_set(&problem.ground, top->density, top->density * top->p_speed * top->p_speed - 2 * top->mu,
                   top->mu);
    for (int r = 0; r < PLACES; r++)
        memcpy(signal[r].position, places[r], sizeof places[r]);
    assert_int_equal(lamb_fft(&problem, end, PLACES, signal, &messages), SELAS_OK);
    for (int r = 0; r < PLACES; r++) {
        for (int i = 0; i < ROWS; i++)
            lamb_signal_value(&problem, &signal[r], end * i / (ROWS - 1), value + 6 * (ROWS * r + i));
        lamb_signal_free(&signal[r]);
    }
}

static void fictitious_interface_changes_nothing(void **state)
{
    (void)state;
    static double plain[6 * ROWS * PLACES], layered_value[6 * ROWS * PLACES];
    const struct stratum same[3] = {{0, 1, 1, 2, 1}, {.4, 1, 1, 2, 1}, {1.1, 1, 1, 2, 1}};
    struct layered *layered = layers(3, same);
    histories(NULL, same, &gaussian, 6, plain);
    histories(layered, same, &gaussian, 6, layered_value);
    for (int i = 0; i < 6 * ROWS * PLACES; i++)
        assert_near(layered_value[i], plain[i], 1e-10);
    layered_free(&layered);
}

/* Until the first echo from the interface arrives, the layer is the whole ground; then it is not. */
static void echo_comes_in_time(void **state)
{
    (void)state;
    static double plain[6 * ROWS * PLACES], value[6 * ROWS * PLACES];
    const struct stratum pair[2] = {{0, 1, 1, 2, 1}, {1.6, 1.2, 4, 3.6, 1.8257418583505538}};
    struct layered *layered = layers(2, pair);
    const double end = 4;
    histories(NULL, pair, &pulse, end, plain);
    histories(layered, pair, &pulse, end, value);
    for (int r = 0; r < 3; r++) {
        const double z = places[r][2];
        /* straight under the nearest point of the patch */
        const double away = fmax(0, hypot(places[r][0], places[r][1]) - .8);
        const double echo = hypot(2 * 1.6 - z, away) / 2;
        double late = 0;
        for (int i = 0; i < ROWS; i++)
            for (int c = 0; c < 6; c++) {
                const int at = 6 * (ROWS * r + i) + c;
                if (end * i / (ROWS - 1) < echo - .05)
                    assert_near(value[at], plain[at], 1e-6);
                else
                    late = fmax(late, fabs(value[at] - plain[at]));
            }
        assert_true(late > .01);
    }
    layered_free(&layered);
}

/* A time before the pulse: what is judged is the source, not the little that has come. */
static void a_short_time_costs_little(void **state)
{
    (void)state;
    const struct history bell = {.kind = HISTORY_GAUSSIAN, .width = .4, .delay = 2.4};
    const struct lamb_load load = {{.shape = PATCH_RECTANGLE, .half = {.5, .5}}, {0, 0, 1}, &bell};
    const struct stratum strata[2] = {{0, 1, .25, .75, .5}, {1, 1, 1, sqrt(3), 1}};
    struct layered *layered = NULL;
    struct messages messages = {0};
    struct lamb_problem problem = {.loads = 1, .load = &load};
    half_space_set(&problem.ground, 1, 1 * .75 * .75 - 2 * .25, .25);
    assert_int_equal(layered_from(2, strata, &layered, &messages), SELAS_OK);
    problem.layers = layered;
    struct lamb_signal whole = {.position = {1, 0, 0}}, early = {.position = {1, 0, 0}};
    assert_int_equal(lamb_fft(&problem, 7.5, 1, &whole, &messages), SELAS_OK);
    assert_int_equal(lamb_fft(&problem, 1, 1, &early, &messages), SELAS_OK);
    print_message("evaluations until 7.5: %g, until 1: %g\n", whole.effort.evaluations,
                  early.effort.evaluations);
    assert_true(early.effort.evaluations < whole.effort.evaluations);
    for (int i = 0; i <= 20; i++) {
        double a[6], b[6];
        lamb_signal_value(&problem, &whole, .05 * i, a);
        lamb_signal_value(&problem, &early, .05 * i, b);
        for (int c = 0; c < 6; c++)
            assert_near(b[c], a[c], 2e-7);
    }
    lamb_signal_free(&whole);
    lamb_signal_free(&early);
    layered_free(&layered);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(equations_of_motion_are_met),
        cmocka_unit_test(one_dimension_is_met),
        cmocka_unit_test(static_limits_are_met),
        cmocka_unit_test(ground_is_passive),
        cmocka_unit_test(fictitious_interface_changes_nothing),
        cmocka_unit_test(echo_comes_in_time),
        cmocka_unit_test(a_short_time_costs_little),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
