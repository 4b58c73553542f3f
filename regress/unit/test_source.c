/* Point sources of higher order (doc/theory/consistent-splines.md, section 15): transforms against that of the functions'
 * own, symmetry planes, where there are none, smoothness in the place. */
#include "near.h"

#include "method/spline/source.h"

#include <complex.h>
#include <math.h>

static struct spline *axis(int degree, size_t cells, bool mirror)
{
    struct messages messages = {0};
    const struct spline_choice choice = {
        .degree = degree, .high = .25 * (double)cells, .spacing = .25, .mirror = {mirror, false}};
    struct spline *spline = spline_new(&choice, &messages);
    assert_non_null(spline);
    return spline;
}

/* |sum w_b exp(-i k (x_b - x)) - (i k)^slope N^(k)| over |i k|^slope: the sign of a moment's -d/dx is the load's. */
static double defect(const struct spline *spline, bool slope, double x, double theta, bool wide)
{
    const double h = .25, k = theta / h;
    const double half = theta / 2, transform = pow(sin(half) / half, spline->degree + 1);
    double complex sum = 0;
    struct tuned_point at;
    if (wide)
        assert_true(source_at(spline, false, SOURCE_MOMENT, slope, x, &at));
    else
        tuned_at(spline, false, x, &at);
    for (size_t b = 0; b < at.count; b++)
        sum += (slope ? at.slope[b] : at.value[b]) * cexp(-I * k * (spline->greville[at.index[b]] - x));
    return slope ? cabs(sum / (-I * k) - transform) : cabs(sum - transform);
}

static void waves_are_those_of_the_functions(void **state)
{
    (void)state;
    for (int degree = 1; degree <= 3; degree++) {
        struct spline *spline = axis(degree, 40, false);
        for (int slope = 0; slope < 2; slope++) {
            double coarse = 0, fine = 0, plain = 0;
            for (double x = 4.6; x < 5.4; x += .013) {
                coarse = fmax(coarse, defect(spline, slope, x, .8, true));
                fine = fmax(fine, defect(spline, slope, x, .4, true));
                plain = fmax(plain, defect(spline, slope, x, .4, false));
            }
            print_message("degree %d, slope %d: %.1e at .4, order %.2f; as they are %.1e\n", degree, slope,
                          fine, log2(coarse / fine), plain);
            assert_true(log2(coarse / fine) > (slope ? 4.7 : 5.7)); /* 5 and 6 */
            assert_true(fine < (slope ? 8e-5 : 4e-5));
            assert_true(plain > fine);
        }
        spline_free(spline);
    }
}

/* What lies beyond a symmetry plane is folded back: the source and its image on the whole axis. */
static void images_are_folded(void **state)
{
    (void)state;
    for (int kind = 1; kind <= 5; kind++)
        for (int odd = 0; odd < 2; odd++)
            for (int slope = 0; slope < 2; slope++) {
                const int degree = kind < 5 ? kind : TUNED_DEGREE;
                const double middle = degree < 3 ? 4 : 12;
                const size_t cells = degree < 3 ? 16 : 48;
                struct spline *half = axis(degree, cells, true), *whole = axis(degree, 2 * cells, false);
                const size_t plane = whole->count - half->count;
                assert_true(kind < 5 ||
                            (spline_tune(half) && spline_tune(whole) && half->filter[odd] != NULL));
                for (double x = 0; x < 1.2; x += .11) {
                    double line[128] = {0}, all[128] = {0};
                    struct tuned_point at;
                    assert_true(source_at(half, odd, SOURCE_MOMENT, slope, x, &at));
                    for (size_t b = 0; b < at.count; b++)
                        line[at.index[b]] += slope ? at.slope[b] : at.value[b];
                    for (int image = 0; image < 2; image++) {
                        const double sign = (image && odd ? -1 : 1) * (image && slope ? -1 : 1);
                        assert_true(
                            source_at(whole, false, SOURCE_MOMENT, slope, middle + (image ? -x : x), &at));
                        for (size_t b = 0; b < at.count; b++)
                            all[at.index[b]] += sign * (slope ? at.slope[b] : at.value[b]);
                    }
                    for (size_t i = 0; i < half->count; i++) {
                        const bool on_plane = half->centred[0] && i == 0;
                        assert_true(fabs(line[i] * (on_plane && !odd ? 2 : 1) - all[plane + i]) <
                                    1e-11 * (slope ? 4 : 1));
                    }
                }
                spline_free(half);
                spline_free(whole);
            }
}

/* |sum w_b c_b - (i k)^slope N^(k) exp(i k x)| over |k|^slope near an open end of degree 2, c the control values of a wave. */
static double end_defect(const struct spline *spline, bool slope, double x, double theta)
{
    const double h = .25, k = theta / h;
    const double transform = pow(sin(theta / 2) / (theta / 2), 3);
    const size_t last = spline->count - 1;
    double complex sum = 0;
    struct tuned_point at;
    assert_true(source_at(spline, false, SOURCE_MOMENT, slope, x, &at));
    for (size_t b = 0; b < at.count; b++) {
        const size_t i = at.index[b];
        const double place = spline->greville[i];
        const double complex wave =
            i == 0 || i == last ? cexp(I * k * place) * cos(theta / 2) : cexp(I * k * place);
        sum += (slope ? at.slope[b] : at.value[b]) * wave;
    }
    return cabs(sum / cpow(I * k, slope) - transform * cexp(I * k * x));
}

static void one_sided_at_open_ends(void **state)
{
    (void)state;
    struct spline *spline = axis(2, 24, false);
    for (int slope = 0; slope < 2; slope++)
        for (int end = 0; end < 2; end++) {
            double coarse = 0, fine = 0;
            for (double away = -1e-12; away < .62; away += .013) { /* the first: outside by rounding */
                const double x = end == 0 ? away : 6 - away;
                coarse = fmax(coarse, end_defect(spline, slope, x, .4));
                fine = fmax(fine, end_defect(spline, slope, x, .2));
            }
            print_message("end %d, slope %d: %.1e at .2, order %.2f\n", end, slope, fine,
                          log2(coarse / fine));
            assert_true(log2(coarse / fine) > (slope ? 4.7 : 5.7)); /* 5 and 6 */
            assert_true(fine < (slope ? 8e-5 : 2e-6));
        }
    spline_free(spline);
}

/* The value of sum w_b z^b where the equations of the axis have their solutions (-1)^b exp(-+a b), by that of the functions
 * themselves; and what the filter takes from waves of theta. */
static void what_alternates_is_left_alone(void **state)
{
    (void)state;
    const struct {
        int degree;
        bool tuned;
        double decay[2], left, theta, change;
    } cases[] = {{3, false, {.625, .843}, .21, .8, 3.3e-4},
                 {4, false, {.497, .624}, .08, .8, 4e-4},
                 {4, true, {.260, .296}, .03, 1.6, 4.3e-3}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        struct spline *spline = axis(cases[i].degree, 96, false);
        assert_true(!cases[i].tuned || (spline_tune(spline) && spline->filter[0] != NULL));
        for (double x = 12; x < 12.25; x += .031) {
            struct tuned_point wide, plain;
            assert_true(source_at(spline, false, SOURCE_FORCE, false, x, &wide));
            tuned_at(spline, false, x, &plain);
            for (int end = 0; end < 4; end++) {
                double sum[2] = {0}, most = 0;
                for (int part = 0; part < 2; part++) {
                    const struct tuned_point *at = part == 0 ? &wide : &plain;
                    for (size_t b = 0; b < at->count; b++) {
                        const double away = (spline->greville[at->index[b]] - x) / .25;
                        const double value = at->value[b];
                        sum[part] += value * (at->index[b] % 2 == 0 ? 1 : -1) *
                                     exp((end % 2 == 0 ? 1 : -1) * cases[i].decay[end / 2] * away);
                        most += part == 1 ? fabs(value) : 0;
                    }
                }
                assert_true(fabs(sum[0]) < cases[i].left * fabs(sum[1]) + 1e-9 * most);
            }
            double complex taken = 0, whole = 0;
            for (size_t b = 0; b < wide.count; b++)
                taken +=
                    (wide.value[b]) * cexp(-I * cases[i].theta * (spline->greville[wide.index[b]] - x) / .25);
            for (size_t b = 0; b < plain.count; b++)
                whole += (plain.value[b]) *
                         cexp(-I * cases[i].theta * (spline->greville[plain.index[b]] - x) / .25);
            assert_true(cabs(taken - whole) < cases[i].change * cabs(whole));
        }
        spline_free(spline);
    }
}

static void other_ends_stay(void **state)
{
    (void)state;
    struct tuned_point at;
    struct spline *cubic = axis(3, 24, false), *quartic = axis(4, 24, false);
    assert_false(source_at(cubic, false, SOURCE_MOMENT, true, .5, &at));
    assert_false(source_at(cubic, false, SOURCE_MOMENT, true, 5.9, &at));
    assert_true(source_at(cubic, false, SOURCE_MOMENT, true, 3, &at));
    assert_true(source_at(quartic, false, SOURCE_MOMENT, true, 3, &at));
    assert_true(source_at(quartic, false, SOURCE_MOMENT, true, 1.7, &at)); /* no room for the filter */
    assert_int_equal(at.count, 7);
    assert_false(source_at(quartic, false, SOURCE_FORCE, false, 1.7, &at));
    spline_free(cubic);
    spline_free(quartic);
}

static void weights_change_smoothly(void **state)
{
    (void)state;
    struct spline *spline = axis(2, 24, false);
    static const double step = 1e-7;
    for (double x = 2.5; x < 3.5; x += .0125) { /* knots and control values among them */
        struct tuned_point at;
        double line[2][32] = {{0}};
        for (int side = 0; side < 2; side++) {
            assert_true(source_at(spline, false, SOURCE_MOMENT, false, x + (side ? step : -step), &at));
            for (size_t b = 0; b < at.count; b++)
                line[side][at.index[b]] += at.value[b];
        }
        for (size_t i = 0; i < spline->count; i++)
            assert_true(fabs(line[1][i] - line[0][i]) < 2 * step * 4 * 3); /* slopes of a few per spacing */
    }
    spline_free(spline);
}

/* Hats at the knots 0 .. 6 and fewer, half of one at the end: moments of the density, by Simpson's rule. */
static void hats_have_the_moments(void **state)
{
    enum { FINE = 1000 };
    (void)state;
    for (int place = 0; place < 20; place++) {
        const double depth = place * .17;
        const int hats = SOURCE_WIDE - place % SOURCE_WIDE;
        double share[SOURCE_WIDE + 1] = {0};
        source_hats(depth, hats, share);
        for (int j = hats; j < SOURCE_WIDE; j++)
            assert_true(share[j] == 0);
        for (int m = 1; m <= hats && m <= 6; m++) {
            double sum = 0;
            for (int n = 0; n < FINE * SOURCE_WIDE; n++)
                for (int part = 0; part < 3; part++) {
                    const double t = (n + part / 2.) / FINE, in = t - n / FINE;
                    const double here = share[n / FINE] * (1 - in) + share[n / FINE + 1] * in;
                    sum += (part == 1 ? 4 : 1) * here * pow(t, m) / (6 * FINE);
                }
            assert_true(fabs(sum - pow(depth, m)) < 1e-9 * pow(SOURCE_WIDE, m));
        }
        for (int j = 0; place == 0 && j < SOURCE_WIDE; j++)
            assert_true(fabs(share[j]) < 1e-12);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(waves_are_those_of_the_functions),
        cmocka_unit_test(images_are_folded),
        cmocka_unit_test(one_sided_at_open_ends),
        cmocka_unit_test(what_alternates_is_left_alone),
        cmocka_unit_test(other_ends_stay),
        cmocka_unit_test(weights_change_smoothly),
        cmocka_unit_test(hats_have_the_moments),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
