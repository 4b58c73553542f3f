/* Kernels: unit integral, plane integral (S_a), continuity, derivatives against differences of the value. */
#include "deck/choices.h"
#include "kernel/kernel.h"
#include "near.h"

#define NAME(symbol, word) word,
static const char *const kernels[] = {KERNELS(NAME) NULL};

/* Surface of the unit sphere in 1, 2, 3 dimensions (0: the point itself). */
static const double sphere[4] = {1, 2, 2 * M_PI, 4 * M_PI};

static double value_integrand(const struct kernel *kernel, int dimension, int space, double h, double r)
{
    return sphere[space] * pow(r, space - 1) * kernel_value(kernel, dimension, r, h);
}

/* Integral of the kernel of `dimension` over a space of dimension `space` through its centre. The kernels
 * are polynomials between knots at multiples of h, of degree 7 at most with r^2: a 4-point Gauss rule per
 * interval is exact. */
static double integral(const struct kernel *kernel, int dimension, int space, double h)
{
    static const double node[2] = {.339981043584856265, .861136311594052575};
    static const double weight[2] = {.652145154862546143, .347854845137453857};
    if (space == 0) return kernel_value(kernel, dimension, 0, h);
    double sum = 0;
    for (int interval = 0; interval < (int)kernel->support; interval++)
        for (int i = 0; i < 2; i++)
            for (int sign = -1; sign <= 1; sign += 2) {
                const double r = h * (interval + .5 + .5 * sign * node[i]);
                sum += .5 * h * weight[i] * value_integrand(kernel, dimension, space, h, r);
            }
    return sum;
}

static void test_unit_integral(void **state)
{
    (void)state;
    for (int i = 0; kernels[i] != NULL; i++)
        for (int dimension = 1; dimension <= 3; dimension++) {
            const struct kernel *kernel = kernel_find(kernels[i]);
            assert_near(integral(kernel, dimension, dimension, .7), 1, 1e-13);
        }
}

static void test_plane_factor(void **state)
{
    (void)state;
    const double h = 1.3;
    for (int i = 0; kernels[i] != NULL; i++)
        for (int dimension = 1; dimension <= 3; dimension++) {
            const struct kernel *kernel = kernel_find(kernels[i]);
            const double plane = integral(kernel, dimension, dimension - 1, h);
            assert_near(kernel_plane_factor(kernel, dimension, h) * plane, 1, 1e-13);
        }
    const struct kernel *cubic = kernel_find("cubic");
    assert_near(kernel_plane_factor(cubic, 3, h), 10 * h / 7, 1e-14); /* Ding Eq 41 */
    assert_near(kernel_plane_factor(cubic, 2, h), 7 * M_PI * h / 15, 1e-14);
    assert_near(kernel_plane_factor(cubic, 1, h), 3 * h / 2, 1e-14);
}

static void test_published_values(void **state)
{
    (void)state;
    const struct kernel *cubic = kernel_find("cubic");
    /* Ding Eq 39 at v = 0, 1/2, 1, 3/2: (1/pi) {1, 23/32, 1/4, 1/32} */
    assert_near(kernel_value(cubic, 3, 0, 1), 1 / M_PI, 1e-15);
    assert_near(kernel_value(cubic, 3, .5, 1), 23 / (32 * M_PI), 1e-15);
    assert_near(kernel_value(cubic, 3, 1, 1), 1 / (4 * M_PI), 1e-15);
    assert_near(kernel_value(cubic, 3, 3, 2), 1 / (8 * 32 * M_PI), 1e-15);
    assert_near(kernel_value(cubic, 1, .5, 1), 23.0 / 48, 1e-15); /* He & Seaid Eq 2, alpha = 1/h */
    assert_true(kernel_value(cubic, 3, 2, 1) == 0 && kernel_value(cubic, 3, 2.5, 1) == 0);
    assert_null(kernel_find("gaussian"));
    assert_near(kernel_dispersion(cubic, 2, 1, 2), 1, 1e-15);     /* nearest points alone */
    assert_near(kernel_dispersion(cubic, 1, 1.5, 0), 2.2, 1e-14); /* -W'(r)/r at 1 and 2: 6 to 1 */
}

static void test_derivatives(void **state)
{
    (void)state;
    const double h = .8, step = 1e-5;
    for (int i = 0; kernels[i] != NULL; i++)
        for (int dimension = 1; dimension <= 3; dimension++) {
            const struct kernel *kernel = kernel_find(kernels[i]);
            const double size = kernel_value(kernel, dimension, 0, h);
            for (int k = 0; .07 + .13 * k < kernel->support + .2; k++) {
                const double r = (.07 + .13 * k) * h;
                const double up = kernel_value(kernel, dimension, r + step, h);
                const double down = kernel_value(kernel, dimension, r - step, h);
                const double slope = kernel_derivative(kernel, dimension, r, h);
                assert_near(slope, (up - down) / (2 * step), 1e-8 * size);
                assert_near(kernel_derivative_over_r(kernel, dimension, r, h) * r, slope, 1e-14 * size);
                const double slope_up = kernel_derivative(kernel, dimension, r + step, h);
                const double slope_down = kernel_derivative(kernel, dimension, r - step, h);
                assert_near(kernel_second_derivative(kernel, dimension, r, h),
                            (slope_up - slope_down) / (2 * step), 1e-7 * size);
            }
            /* at the centre the slope over r and the curvature meet */
            assert_near(kernel_derivative_over_r(kernel, dimension, 0, h),
                        kernel_second_derivative(kernel, dimension, 0, h), 1e-12 * size);
        }
}

/* Value, slope and curvature have no jump at any knot (the C2 kernels all have continuous curvature). */
static void test_continuity(void **state)
{
    (void)state;
    const double tiny = 1e-9;
    for (int i = 0; kernels[i] != NULL; i++)
        for (int dimension = 1; dimension <= 3; dimension++)
            for (int knot = 1; knot <= 3; knot++) {
                const struct kernel *kernel = kernel_find(kernels[i]);
                const double size = kernel_value(kernel, dimension, 0, 1);
                assert_near(kernel_value(kernel, dimension, knot - tiny, 1),
                            kernel_value(kernel, dimension, knot + tiny, 1), 1e-7 * size);
                assert_near(kernel_derivative(kernel, dimension, knot - tiny, 1),
                            kernel_derivative(kernel, dimension, knot + tiny, 1), 1e-7 * size);
                assert_near(kernel_second_derivative(kernel, dimension, knot - tiny, 1),
                            kernel_second_derivative(kernel, dimension, knot + tiny, 1), 1e-7 * size);
            }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_unit_integral),    cmocka_unit_test(test_plane_factor),
        cmocka_unit_test(test_published_values), cmocka_unit_test(test_derivatives),
        cmocka_unit_test(test_continuity),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
