/* B-splines on one axis: partition of unity, smoothness, integrals against known coefficients and an
 * independent quadrature, folding at symmetry planes, band matrices. */
#include "near.h"

#include "method/spline/bspline.h"
#include "method/spline/disc.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static struct spline *make(int degree, double low, double high, double spacing, bool mapped, bool mirror_low,
                           bool mirror_high)
{
    const struct spline_choice choice = {.degree = degree,
                                         .low = low,
                                         .high = high,
                                         .spacing = spacing,
                                         .mapped = mapped,
                                         .mirror = {mirror_low, mirror_high}};
    struct messages messages = {0};
    struct spline *spline = spline_new(&choice, &messages);
    assert_non_null(spline);
    return spline;
}

static double sum_at(const struct spline *s, bool odd, double x, const double *control, bool slope)
{
    struct spline_point at;
    spline_at(s, odd, x, &at);
    double sum = 0;
    for (int j = 0; j <= s->degree; j++)
        sum += (slope ? at.slope[j] : at.value[j]) * control[at.index[j]];
    return sum;
}

/* Control values count: n + p with open knots, n + 1 with mapped ends. */
static void test_counts(void **state)
{
    (void)state;
    for (int p = 1; p <= 4; p++) {
        struct spline *open = make(p, 0, 7, .125, false, false, false);
        struct spline *mapped = make(p, 0, 7, .125, true, false, false);
        assert_int_equal(open->count, 56 + p);
        assert_int_equal(mapped->count, 57);
        for (size_t i = 0; i < mapped->count; i++)
            assert_near(mapped->greville[i], .125 * (double)i, 1e-14);
        spline_free(open);
        spline_free(mapped);
    }
}

/* Constants and linear functions are exact everywhere, slopes too; all kinds of ends. */
static void test_linear_exact(void **state)
{
    (void)state;
    for (int p = 1; p <= 4; p++)
        for (int kind = 0; kind < 4; kind++) {
            const bool mirror = kind >= 2;
            struct spline *s = make(p, 1, 5, .3, kind % 2 == 1, mirror, false);
            double ones[64], line[64];
            for (size_t i = 0; i < s->count; i++) {
                ones[i] = 1;
                line[i] = s->greville[i] - 1; /* odd about x = 1 */
            }
            for (double x = 1; x <= 5; x += .0371) {
                assert_near(sum_at(s, false, x, ones, false), 1, 1e-13);
                assert_near(sum_at(s, false, x, ones, true), 0, 1e-11);
                assert_near(sum_at(s, mirror, x, line, false), x - 1, 1e-12);
                assert_near(sum_at(s, mirror, x, line, true), 1, 1e-10);
            }
            spline_free(s);
        }
}

/* Interior rows of M and S for p = 1, 2, 3 (Schoenberg 1946: values of the B-spline of degree 2 p + 1 at the
 * integers, and minus its second differences). */
static void test_interior_rows(void **state)
{
    (void)state;
    static const double mass[3][4] = {{4. / 6, 1. / 6, 0, 0},
                                      {66. / 120, 26. / 120, 1. / 120, 0},
                                      {2416. / 5040, 1191. / 5040, 120. / 5040, 1. / 5040}};
    static const double stiffness[3][4] = {
        {2, -1, 0, 0}, {1, -1. / 3, -1. / 6, 0}, {2. / 3, -1. / 8, -1. / 5, -1. / 120}};
    static const double gradient[3][4] = {
        {0, 1. / 2, 0, 0}, {0, 5. / 12, 1. / 24, 0}, {0, 49. / 144, 7. / 90, 1. / 720}};
    const double h = .25;
    for (int p = 1; p <= 3; p++)
        for (int mapped = 0; mapped < 2; mapped++) {
            struct spline *s = make(p, 0, 10, h, mapped, false, false);
            struct band *m = spline_matrix(s, false, 0, false, 0, NULL);
            struct band *k = spline_matrix(s, false, 1, false, 1, NULL);
            struct band *g = spline_matrix(s, false, 0, false, 1, NULL);
            for (size_t d = 0; d < 4; d++) {
                assert_near(band_get(m, 20, 20 + d), h * mass[p - 1][d], 1e-14);
                assert_near(band_get(k, 20, 20 - d), stiffness[p - 1][d] / h, 1e-12);
                assert_near(band_get(g, 20, 20 + d), gradient[p - 1][d], 1e-13);
                assert_near(band_get(g, 20, 20 - d), -gradient[p - 1][d], 1e-13);
            }
            band_free(m);
            band_free(k);
            band_free(g);
            spline_free(s);
        }
}

/* All entries against the midpoint rule with 4000 points a cell, at all ends. */
static void test_against_midpoint_rule(void **state)
{
    (void)state;
    for (int kind = 0; kind < 12; kind++) {
        const int p = 1 + kind % 4;
        const bool mapped = kind / 4 == 1, mirror = kind / 4 == 2;
        struct spline *s = make(p, 0, 3, .3, mapped, mirror, false);
        struct band *k = spline_matrix(s, mirror, 1, mirror, 1, NULL);
        struct band *g = spline_matrix(s, mirror, 0, false, 1, NULL);
        const size_t n = s->count;
        double *ks = calloc(n * n, sizeof *ks), *gs = calloc(n * n, sizeof *gs);
        const double step = .3 / 4000;
        for (size_t q = 0; q < 40000; q++) {
            struct spline_point a, b;
            spline_at(s, mirror, step * ((double)q + .5), &a);
            spline_at(s, false, step * ((double)q + .5), &b);
            for (int i = 0; i <= p; i++)
                for (int j = 0; j <= p; j++) {
                    ks[a.index[i] * n + a.index[j]] += step * a.slope[i] * a.slope[j];
                    gs[a.index[i] * n + b.index[j]] += step * a.value[i] * b.slope[j];
                }
        }
        for (size_t i = 0; i < n; i++)
            for (size_t j = 0; j < n; j++) {
                assert_near(band_get(k, i, j), ks[i * n + j], 3e-5);
                assert_near(band_get(g, i, j), gs[i * n + j], 3e-6);
            }
        free(ks);
        free(gs);
        band_free(k);
        band_free(g);
        spline_free(s);
    }
}

/* A half with a mirror gives what the whole gives for even and odd fields. */
static void compare_half(int p, bool odd, double spacing, bool mapped)
{
    struct spline *whole = make(p, -3, 3, spacing, mapped, false, false);
    struct spline *half = make(p, 0, 3, spacing, mapped, true, false);
    double own[64], full[64];
    const size_t shift = whole->count - half->count;
    for (size_t i = 0; i < half->count; i++)
        own[i] = sin(1 + 3. * (double)i);
    if (odd && half->centred[0]) own[0] = 0;
    for (size_t i = 0; i < half->count; i++) {
        full[shift + i] = own[i];
        full[whole->count - 1 - shift - i] = odd && !(half->centred[0] && i == 0) ? -own[i] : own[i];
    }
    for (double x = 0; x <= 3; x += .0173) {
        assert_near(sum_at(half, odd, x, own, false), sum_at(whole, false, x, full, false), 1e-12);
        assert_near(sum_at(half, odd, x, own, true), sum_at(whole, false, x, full, true), 1e-10);
    }
    spline_free(whole);
    spline_free(half);
}

static void test_mirror_is_half_of_whole(void **state)
{
    (void)state;
    static const double spacings[] = {.3, 1, 1.5, 3}; /* 10, 3, 2, 1 cells */
    for (int p = 1; p <= 4; p++)
        for (int odd = 0; odd < 2; odd++) {
            for (int i = 0; i < 4; i++)
                compare_half(p, odd, spacings[i], false);
            compare_half(p, odd, .3, true);
            compare_half(p, odd, 3. / (p + 1), true); /* the thinnest */
        }
}

/* An interface keeps its place and its C0 knot: |x - xi| is in the space. */
static void test_interface(void **state)
{
    (void)state;
    const double at = 1.07;
    const struct spline_choice choice = {
        .degree = 3, .low = 0, .high = 3, .spacing = .25, .interfaces = 1, .interface = &at};
    struct messages messages = {0};
    struct spline *s = spline_new(&choice, &messages);
    assert_non_null(s);
    double control[64];
    for (size_t i = 0; i < s->count; i++)
        control[i] = fabs(s->greville[i] - at);
    for (double x = 0; x <= 3; x += .0093)
        assert_near(sum_at(s, false, x, control, false), fabs(x - at), 1e-13);
    spline_free(s);
}

/* Moments: over part of the axis against the midpoint rule; over the whole they add up to its length. */
static void test_moments(void **state)
{
    (void)state;
    for (int mapped = 0; mapped < 2; mapped++) {
        struct spline *s = make(3, 0, 7, .5, mapped, false, false);
        double moment[64], sum = 0, reference[64] = {0};
        spline_moments(s, false, 2.9, 4.13, moment);
        for (size_t q = 0; q < 100000; q++) {
            struct spline_point at;
            spline_at(s, false, 2.9 + 1.23e-5 * ((double)q + .5), &at);
            for (int j = 0; j <= 3; j++)
                reference[at.index[j]] += 1.23e-5 * at.value[j];
        }
        for (size_t i = 0; i < s->count; i++)
            assert_near(moment[i], reference[i], 1e-9);
        spline_moments(s, false, 0, 7, moment);
        for (size_t i = 0; i < s->count; i++)
            sum += moment[i];
        assert_near(sum, 7, 1e-13);
        spline_free(s);
    }
}

/* Disc: area, and the second moment r^4 pi / 4 with control values that make x^2 (inside the axes). */
static void test_disc(void **state)
{
    (void)state;
    struct spline *x = make(2, 0, 5, .5, false, false, false), *y = make(3, 0, 5, .4, false, false, false);
    const struct disc disc = {2.3, 2.6, 1.1};
    double *moment = calloc(x->count * y->count, sizeof *moment);
    assert_true(disc_moments(x, false, y, false, &disc, moment));
    double area = 0, first = 0, mixed = 0;
    for (size_t i = 0; i < x->count; i++)
        for (size_t j = 0; j < y->count; j++) {
            area += moment[i * y->count + j];
            first += moment[i * y->count + j] * (x->greville[i] - 2.3);
            mixed += moment[i * y->count + j] * (x->greville[i] - 2.3) * (y->greville[j] - 2.6);
        }
    assert_near(area, M_PI * 1.21, 1e-12);
    assert_near(first, 0, 1e-12);
    assert_near(mixed, 0, 1e-12);
    const struct disc cut = {0, 2.6, 1.1}; /* half of it outside */
    assert_true(disc_moments(x, false, y, false, &cut, moment));
    area = 0;
    for (size_t i = 0; i < x->count * y->count; i++)
        area += moment[i];
    assert_near(area, M_PI * 1.21 / 2, 1e-12);
    free(moment);
    spline_free(x);
    spline_free(y);
}

static void apply(const struct band *band, const double *x, double *y)
{
    for (size_t i = 0; i < band->n; i++)
        y[i] = band_row(band, i, x, 1);
}

/* Banded Cholesky and LU against the matrix itself; product and sum against dense arithmetic. */
static void test_band(void **state)
{
    (void)state;
    struct spline *s = make(3, 0, 3, .3, false, false, false);
    struct band *m = spline_matrix(s, false, 0, false, 0, NULL);
    struct band *g = spline_matrix(s, false, 0, false, 1, NULL);
    struct band *product = band_product(m, g), *sum = band_sum(m, -2, g);
    const size_t n = s->count;
    double x[64] = {0}, y[64], z[64], lanes[64 * 4], factor[64 * 5];
    for (size_t i = 0; i < n; i++)
        x[i] = cos(2. * (double)i);
    apply(g, x, y);
    apply(m, y, z);
    apply(product, x, y);
    for (size_t i = 0; i < n; i++)
        assert_near(y[i], z[i], 1e-13);
    apply(sum, x, y);
    for (size_t i = 0; i < n; i++)
        assert_near(y[i], band_row(m, i, x, 1) - 2 * band_row(g, i, x, 1), 1e-13);
    assert_true(band_factorise(m, factor));
    for (size_t i = 0; i < n; i++)
        for (size_t lane = 0; lane < 4; lane++)
            lanes[i * 4 + lane] = (double)(lane + 1) * band_row(m, i, x, 1);
    band_forward(factor, n, m->half, lanes, 4, 4);
    band_backward(factor, n, m->half, lanes, 4, 4);
    for (size_t i = 0; i < n; i++)
        for (size_t lane = 0; lane < 4; lane++)
            assert_near(lanes[i * 4 + lane], (double)(lane + 1) * x[i], 1e-11);
    apply(m, x, y);
    assert_true(band_lu(m));
    band_lu_solve(m, y, 1);
    for (size_t i = 0; i < n; i++)
        assert_near(y[i], x[i], 1e-12);
    band_free(m);
    band_free(g);
    band_free(product);
    band_free(sum);
    spline_free(s);
}

/* Too few cells are refused with a message. */
static void test_refuses(void **state)
{
    (void)state;
    const struct spline_choice choice = {.degree = 3, .low = 0, .high = 1, .spacing = .25, .mapped = true};
    struct messages messages = {0};
    assert_null(spline_new(&choice, &messages));
    assert_int_equal(messages.errors, 1);
    assert_non_null(strstr(messages.text, "at least 7 spacings"));
    messages_free(&messages);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_counts),
        cmocka_unit_test(test_linear_exact),
        cmocka_unit_test(test_interior_rows),
        cmocka_unit_test(test_against_midpoint_rule),
        cmocka_unit_test(test_mirror_is_half_of_whole),
        cmocka_unit_test(test_interface),
        cmocka_unit_test(test_moments),
        cmocka_unit_test(test_disc),
        cmocka_unit_test(test_band),
        cmocka_unit_test(test_refuses),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
