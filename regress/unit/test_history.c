/* Histories: each kind, with and without smoothing, against finite differences and GSL quadrature. */
#include "base/faddeeva.h"
#include "scene/history.h"

#include <gsl/gsl_integration.h>
#include <gsl/gsl_sf_erf.h>
#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include <cmocka.h>

enum { KINDS = 12, MOST_KINKS = 64 };

static double table_time[] = {.2, .5, .55, 1.3, 2}, table_value[] = {.4, 1, -.3, -.2, .7};

/* Two of them are cut at t = 0 where they are far from zero. */
static struct history sample(int i, double smoothing)
{
    const struct history all[KINDS] = {
        {.kind = HISTORY_TRIANGLE, .duration = 2},
        {.kind = HISTORY_STEP},
        {.kind = HISTORY_RICKER, .frequency = .9, .delay = 1.2},
        {.kind = HISTORY_RICKER, .frequency = .4, .delay = .3},
        {.kind = HISTORY_GAUSSIAN, .width = .3, .delay = 2},
        {.kind = HISTORY_GAUSSIAN, .width = .5, .delay = .4},
        {.kind = HISTORY_SINE_BURST, .frequency = 1.5, .cycles = 3},
        {.kind = HISTORY_TABLE, .rows = 5, .table_time = table_time, .table_value = table_value},
        {.kind = HISTORY_BRUNE, .width = .2},
        {.kind = HISTORY_ERROR_FUNCTION, .width = .3, .delay = 2},
        {.kind = HISTORY_ERROR_FUNCTION, .width = .5, .delay = .4, .start = .3},
        {.kind = HISTORY_TRIANGLE, .duration = 1.2, .start = .6},
    };
    struct history history = all[i];
    history.smoothing = smoothing;
    return history;
}

static const double smoothings[] = {0, .7, 1e-3};

struct integrand {
    const struct history *history;
    double complex s;
    int part;
};

static double decayed(double t, void *parameters)
{
    const struct integrand *integrand = parameters;
    const double complex value = history_value(integrand->history, t, 0) * cexp(-integrand->s * t);
    return integrand->part == 0 ? creal(value) : cimag(value);
}

/* Integral of f exp(-s t) over [0, to] piece by piece between kinks (gsl_integration_cquad). */
static double complex quadrature(const struct history *history, double complex s, double to)
{
    double kinks[MOST_KINKS];
    const size_t count = history_kinks(history, kinks, MOST_KINKS);
    assert_true(count <= MOST_KINKS);
    gsl_integration_cquad_workspace *space = gsl_integration_cquad_workspace_alloc(200);
    double sum[2] = {0, 0}, from = 0;
    for (size_t i = 0; i <= count; i++) {
        const double until = i < count ? fmin(kinks[i], to) : to;
        if (until <= from) continue;
        for (int part = 0; part < 2; part++) {
            struct integrand integrand = {history, s, part};
            const gsl_function function = {decayed, &integrand};
            double value = 0;
            gsl_integration_cquad(&function, from, until, 1e-14, 1e-12, space, &value, NULL, NULL);
            sum[part] += value;
        }
        from = until;
    }
    gsl_integration_cquad_workspace_free(space);
    return sum[0] + I * sum[1];
}

static bool near_kink(const struct history *history, double t, double distance)
{
    double kinks[MOST_KINKS];
    const size_t count = history_kinks(history, kinks, MOST_KINKS);
    for (size_t i = 0; i < count; i++)
        if (fabs(t - kinks[i]) < distance) return true;
    return false;
}

static void derivatives_match_differences(void **state)
{
    (void)state;
    const double step = 1e-3;
    int checked = 0;
    for (int kind = 0; kind < KINDS; kind++)
        for (int j = 0; j < 2; j++) {
            const struct history history = sample(kind, smoothings[j]);
            for (double t = .0137; t < 4; t += .0911) {
                if (near_kink(&history, t, 3 * step)) continue;
                for (int order = 0; order <= 2; order++) {
                    double f[5];
                    for (int i = 0; i < 5; i++)
                        f[i] = history_value(&history, t + (i - 2) * step, order - 1);
                    const double difference = (f[0] - 8 * f[1] + 8 * f[3] - f[4]) / (12 * step);
                    const double value = history_value(&history, t, order);
                    assert_true(fabs(value - difference) < 1e-8 * (1 + fabs(value)));
                    checked++;
                }
            }
        }
    assert_true(checked > 1000);
}

static void integral_matches_quadrature(void **state)
{
    (void)state;
    for (int kind = 0; kind < KINDS; kind++)
        for (int j = 0; j < 3; j++) {
            const struct history history = sample(kind, smoothings[j]);
            for (double t = .3; t < 4.5; t += .83)
                assert_true(fabs(history_value(&history, t, -1) - creal(quadrature(&history, 0, t))) < 1e-12);
        }
}

static void laplace_matches_quadrature(void **state)
{
    (void)state;
    const double complex s[] = {1e-3 + 1e-3 * I, .02,          .35 + 2 * I,  .35 - 2 * I,
                                .5 + 9 * I,      .9 + 9.5 * I, .1 + 6.2 * I, 4 + 25 * I};
    for (int kind = 0; kind < KINDS; kind++)
        for (int j = 0; j < 3; j++) {
            const struct history history = sample(kind, smoothings[j]);
            const double end = history_end(&history);
            for (size_t i = 0; i < sizeof s / sizeof *s; i++) {
                const double complex tail = history_value(&history, end + 1, 0) * cexp(-s[i] * end) / s[i];
                const double complex expected = quadrature(&history, s[i], end) + tail;
                assert_true(cabs(history_laplace(&history, s[i]) - expected) < 2e-12 * (1 + cabs(tail)));
            }
        }
}

/* The convolution of polynomials in closed form: step * B rises as the fourth-order integral of the knots. */
static void smoothed_step_is_exact(void **state)
{
    (void)state;
    const struct history history = sample(1, .8);
    const double h = .2, binomial[5] = {1, -4, 6, -4, 1};
    for (double t = 0; t < 1.2; t += .0173) {
        double sum = 0;
        for (int i = 0; i < 5; i++)
            sum += binomial[i] * pow(fmax(0, t / h - i), 4) / 24;
        assert_true(fabs(history_value(&history, t, 0) - sum) < 1e-12);
    }
    assert_true(fabs(history_value(&history, 1, 0) - 1) < 1e-14);
}

static void kinks_are_knots(void **state)
{
    (void)state;
    double kinks[16];
    struct history history = sample(0, 0);
    assert_int_equal(history_kinks(&history, kinks, 16), 3);
    assert_true(kinks[0] == 0 && kinks[1] == 1 && kinks[2] == 2);
    history.smoothing = 1;
    assert_int_equal(history_kinks(&history, kinks, 16), 13); /* 0, .25, ... 3 */
    for (int i = 0; i < 13; i++)
        assert_true(fabs(kinks[i] - .25 * i) < 1e-15);
    assert_int_equal(history_kinks(&history, kinks, 2), 13);
    history = sample(7, 0);
    assert_int_equal(history_kinks(&history, kinks, 16), 5);
}

static void both_sides_are_averaged(void **state)
{
    (void)state;
    const struct history triangle = sample(0, 0), step = sample(1, 0), table = sample(7, 0);
    assert_true(history_value(&triangle, 1, 0) == 1);
    assert_true(history_value(&triangle, 1, 1) == 0);
    assert_true(history_value(&triangle, 0, 1) == .5);
    assert_true(history_value(&step, 0, 0) == .5);
    assert_true(history_value(&step, -1e-300, 0) == 0);
    assert_true(history_value(&table, .2, 0) == .2);
    assert_true(history_value(&table, 99, 0) == .7);
    assert_true(fabs(history_value(&table, .5, 1) - .5 * (2 - 26)) < 1e-12);
}

static void cutoff_of_a_step_has_no_unit(void **state)
{
    (void)state;
    for (int table = 0; table < 2; table++)
        for (int k = -1; k < 2; k++) {
            double zero = 0, one = 1;
            struct history history = {.kind = table ? HISTORY_TABLE : HISTORY_STEP,
                                      .smoothing = 3 * pow(1e9, k)};
            if (table) {
                history.rows = 1;
                history.table_time = &zero;
                history.table_value = &one;
            }
            assert_true(fabs(history_cutoff(&history, .05) * history.smoothing - 3 * 5.639) < .01);
        }
}

/* Above the cutoff the spectrum stays below the fraction; a fifth of it is not yet enough. */
static void cutoff_bounds_the_spectrum(void **state)
{
    (void)state;
    const double fraction = 1e-3;
    for (int kind = 0; kind < KINDS; kind++)
        for (int j = 0; j < 2; j++) {
            const struct history history = sample(kind, smoothings[j]);
            const double cutoff = history_cutoff(&history, fraction);
            struct history later = history;
            history_set_peak(&later);
            later.start += 3.7;
            assert_true(history_cutoff(&later, fraction) == cutoff);
            assert_true(history_alike(&history, &later) && !history_same(&history, &later));
            later.smoothing += 1;
            assert_false(history_alike(&history, &later));
            if ((kind == 1 || kind == 7 || kind == 10) && j == 0) { /* a jump and no way back */
                assert_true(isinf(cutoff));
                continue;
            }
            const bool back = kind != 1 && kind != 7 && (kind < 8 || kind > 10);
            double largest = 0, above = 0, below = 0;
            for (double w = .01; w < 20 * cutoff; w *= 1.002) {
                const double complex s = 1e-7 + I * w;
                const double amplitude = cabs(history_laplace(&history, s)) * (back ? 1 : w);
                largest = fmax(largest, amplitude);
                if (w > cutoff) above = fmax(above, amplitude);
                if (w > .2 * cutoff && w < cutoff) below = fmax(below, amplitude);
            }
            assert_true(above <= 1.02 * fraction * largest);
            assert_true(below > fraction * largest);
        }
}

/* Rows of a smooth function, as fine as they may be, have its spectrum, and not that of the corners between them. */
static void rows_of_a_smooth_function_have_its_cutoff(void **state)
{
    (void)state;
    enum { MOST = 801 };
    static const double intervals[] = {.01, .05, .1, .2};
    static const enum history_kind kinds[] = {HISTORY_GAUSSIAN, HISTORY_RICKER, HISTORY_ERROR_FUNCTION};
    static double time[MOST], value[MOST];
    for (size_t i = 0; i < sizeof intervals / sizeof *intervals; i++)
        for (size_t k = 0; k < sizeof kinds / sizeof *kinds; k++) {
            const struct history made = {.kind = kinds[k], .width = .4, .frequency = .5, .delay = 2.4};
            struct history rows = {.kind = HISTORY_TABLE, .table_time = time, .table_value = value};
            for (; (double)rows.rows * intervals[i] < 8.001; rows.rows++) {
                time[rows.rows] = (double)rows.rows * intervals[i] * (rows.rows % 7 == 3 ? 1 + 1e-7 : 1);
                value[rows.rows] = history_value(&made, time[rows.rows], 0);
            }
            for (double fraction = .05; fraction > .009; fraction /= 2) {
                const double cutoff = history_cutoff(&made, fraction);
                assert_true(fabs(history_cutoff(&rows, fraction) - cutoff) < .08 * cutoff);
            }
        }
}

/* erfcx on the real axis against GSL; elsewhere against its integral (2/sqrt pi) int exp(-t^2 - 2 z t) dt. */
static double erfc_integrand(double t, void *parameters)
{
    const double complex *z = parameters;
    const double complex value = 2 / sqrt(M_PI) * cexp(-t * t - 2 * z[0] * t);
    return creal(z[1]) > 0 ? creal(value) : cimag(value);
}

static void complex_error_function(void **state)
{
    (void)state;
    for (double x = 0; x < 5; x += .037)
        assert_true(fabs(creal(scaled_erfc(x)) / (exp(x * x) * gsl_sf_erfc(x)) - 1) < 1e-13);
    gsl_integration_cquad_workspace *space = gsl_integration_cquad_workspace_alloc(200);
    for (double x = 0; x < 3; x += .31)
        for (double y = -6; y < 6; y += .53)
            for (int part = 0; part < 2; part++) {
                double complex parameters[2] = {x + I * y, part == 0};
                const gsl_function function = {erfc_integrand, parameters};
                double value = 0;
                gsl_integration_cquad(&function, 0, 7, 1e-14, 1e-13, space, &value, NULL, NULL);
                const double complex expected = scaled_erfc(x + I * y);
                assert_true(fabs(value - (part == 0 ? creal(expected) : cimag(expected))) < 2e-13);
            }
    gsl_integration_cquad_workspace_free(space);
}

static void tables_are_read_or_refused(void **state)
{
    (void)state;
    char path[] = "/tmp/selas-table-XXXXXX";
    const int descriptor = mkstemp(path);
    assert_true(descriptor >= 0);
    close(descriptor);
    static const struct {
        const char *text;
        size_t rows;
        const char *says;
    } cases[] = {
        {"# time value\n0 1\n\n .5  2.5 ! peak\r\n1,\t-3e-1\n", 3, NULL},
        {"# bare CR ends lines\r0 1\r.5 2.5\r1 -.3\r", 3, NULL},
        {"\xEF\xBB\xBF"
         "0.0D0 1d0\n5.D-1 2.5D+0\n1 -3d-1\n",
         3, NULL},
        {"0 1.0+0\n.5 25.0-1\n1 -3.0-001\n", 3, NULL},
        {"0 0 0 1.0-2-3\n", 0, ":1: expected two numbers"},
        {"0 1\n1-.5\n", 0, ":2: expected two numbers"},
        {"0 1\r1 x\r", 0, ":2: expected two numbers"},
        {"0 1\n1 2D\n", 0, ":2: expected two numbers"},
        {"", 0, "no rows"},
        {"0 1\n0 2\n", 0, ":2: times must ascend"},
        {"-1 1\n", 0, ":1: times must ascend"},
        {"0 1\n1 x\n", 0, ":2: expected two numbers"},
        {"0 1 2\n", 0, ":1: expected two numbers"},
        {"0 nan\n", 0, ":1: expected two numbers"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        FILE *file = fopen(path, "w");
        assert_non_null(file);
        assert_true(fputs(cases[i].text, file) >= 0);
        assert_int_equal(fclose(file), 0);
        struct history history = {.kind = HISTORY_TABLE};
        struct messages messages = {0};
        const selas_status status = history_read_table(&history, path, &messages);
        assert_int_equal(status, cases[i].says == NULL ? SELAS_OK : SELAS_FILE_ERROR);
        assert_int_equal(history.rows, cases[i].rows);
        if (cases[i].says != NULL) assert_non_null(strstr(messages.text, cases[i].says));
        if (cases[i].rows == 3) assert_true(history_value(&history, .75, 0) == .5 * (2.5 - .3));
        history_free(&history);
        messages_free(&messages);
    }
    assert_int_equal(unlink(path), 0);
    struct history history = {.kind = HISTORY_TABLE};
    struct messages messages = {0};
    assert_int_equal(history_read_table(&history, path, &messages), SELAS_FILE_ERROR);
    messages_free(&messages);
}

/* A jump at the start has its middle there, for a step of time that is on it but for rounding, too. */
static void test_start_but_for_rounding(void **state)
{
    (void)state;
    const struct history step = {.kind = HISTORY_STEP, .start = .3};
    assert_true(3 * .1 > .3);
    assert_true(history_value(&step, 3 * .1, 0) == .5);
    assert_true(history_value(&step, .3, 0) == .5);
    assert_true(history_value(&step, nextafter(.3, 0), 0) == .5);
    assert_true(history_value(&step, .3 + 1e-9, 0) == 1);
    assert_true(history_value(&step, .3 - 1e-9, 0) == 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(derivatives_match_differences),
        cmocka_unit_test(integral_matches_quadrature),
        cmocka_unit_test(laplace_matches_quadrature),
        cmocka_unit_test(smoothed_step_is_exact),
        cmocka_unit_test(kinks_are_knots),
        cmocka_unit_test(both_sides_are_averaged),
        cmocka_unit_test(cutoff_bounds_the_spectrum),
        cmocka_unit_test(cutoff_of_a_step_has_no_unit),
        cmocka_unit_test(rows_of_a_smooth_function_have_its_cutoff),
        cmocka_unit_test(complex_error_function),
        cmocka_unit_test(test_start_but_for_rounding),
        cmocka_unit_test(tables_are_read_or_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
