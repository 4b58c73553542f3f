/* The half-space inside, straight below a point load, where Cagniard's inversion has a closed form: at r = 0
 * all of exp(-k eta(k) z) with k = s xi/cs arrives at t = z eta/cs, so that for a unit step (cs = mu = 1)
 *
 *   2 pi z^2 u/t = [P part at xi^2 = t^2/z^2 - a, t > z sqrt a] + [S part at xi^2 = t^2/z^2 - 1, t > z]   (1)
 *
 * of the compliances without their exponentials (doc/theory/lamb.md, Eqs 1-3; p^2 = xi^2 + a, q^2 = xi^2 + 1):
 *
 *   u_z of Tz:                  p (2 xi^2 + 1)/R,   -2 xi^2 p/R,
 *   u_x of Tx, n_x^2 averaged:  -xi^2 q/R,          [(2 xi^2 + 1) q/R + 1/q]/2.
 *
 * Velocity = f'' * u. Holds lamb_fft's compliances at depth and all that follows them. */
#include "exact/gauss12.h"
#include "exact/lamb_fft.h"

#include "near.h"

static const struct history gaussian = {.kind = HISTORY_GAUSSIAN, .width = .3, .delay = 1.8};

/* (1), horizontal or vertical. */
static double step(double a, bool horizontal, double z, double t)
{
    double sum = 0;
    for (int wave = 0; wave < 2; wave++) {
        const double slowness = wave == 0 ? a : 1, x = t * t / (z * z) - slowness;
        if (t <= 0 || x < 0) continue;
        const double p = sqrt(x + a), q = sqrt(x + 1), kap = 2 * x + 1, r = kap * kap - 4 * x * p * q;
        if (horizontal)
            sum += wave == 0 ? -x * q / r : .5 * (kap * q / r + 1 / q);
        else
            sum += wave == 0 ? p * kap / r : -2 * x * p / r;
    }
    return sum * t / (2 * M_PI * z * z);
}

/* Panels between the arrivals. */
static double velocity(double a, bool horizontal, double z, double t)
{
    enum { PANELS = 60 };
    const double cut[4] = {0, z * sqrt(a), z, INFINITY};
    double sum = 0;
    for (int i = 0; i < 3; i++) {
        const double from = cut[i], to = fmin(cut[i + 1], t);
        if (to <= from) continue;
        for (int j = 0; j < 12 * PANELS; j++) {
            const double tau = from + (to - from) * (j / 12 + .5 + .5 * gauss12_node[j % 12]) / PANELS;
            sum += .5 * gauss12_weight[j % 12] * (to - from) / PANELS * history_value(&gaussian, t - tau, 2) *
                   step(a, horizontal, z, tau);
        }
    }
    return sum;
}

static void compare(double nu, bool horizontal, double z)
{
    enum { ROWS = 60 };
    const double lambda = 2 * nu / (1 - 2 * nu), end = 4 + z;
    const struct lamb_load load = {
        {PATCH_POINT, {.3, -.2}, {0, 0}}, {horizontal ? 1 : 0, 0, horizontal ? 0 : 1}, &gaussian};
    struct lamb_problem problem = {.loads = 1, .load = &load};
    struct lamb_signal signal = {.position = {.3, -.2, z}};
    struct messages messages = {0};
    const int component = horizontal ? 3 : 5;
    double wrong = 0, size = 0, across = 0;
    half_space_set(&problem.ground, 1, lambda, 1);
    assert_int_equal(lamb_fft(&problem, end, 1, &signal, &messages), SELAS_OK);
    for (int i = 0; i < ROWS; i++) {
        double value[6];
        const double t = end * (i + 1) / ROWS, expected = velocity(problem.ground.ratio, horizontal, z, t);
        lamb_signal_value(&problem, &signal, t, value);
        wrong += pow(value[component] - expected, 2);
        size += expected * expected;
        across += pow(value[horizontal ? 5 : 3], 2) + pow(value[4], 2);
    }
    print_message("nu %g, %s, depth %g: %.1e, across %.1e (norm %.3g)\n", nu,
                  horizontal ? "horizontal" : "vertical", z, sqrt(wrong / size), sqrt(across / size),
                  sqrt(size / ROWS));
    assert_true(size > 0);
    assert_true(sqrt(wrong / size) < 5e-6);
    assert_true(sqrt(across / size) < 1e-6);
    lamb_signal_free(&signal);
}

static void below_a_point_load(void **state)
{
    (void)state;
    compare(.25, false, .5);
    compare(.25, false, 2);
    compare(.4, false, 6);
    compare(.25, true, .5);
    compare(.1, true, 2);
    compare(.45, true, 6);
}

/* Long after the step: Boussinesq's u_z = (3 - 2 nu)/(4 pi z) and Cerruti's u_x = [1 + (1 - 2 nu)/2]/(4 pi
 * z); nothing before the P wave. */
static void closed_form_has_its_limits(void **state)
{
    (void)state;
    for (double nu = .1; nu < .46; nu += .1) {
        const double a = (1 - 2 * nu) / (2 - 2 * nu);
        assert_near(step(a, false, 2, 400), (3 - 2 * nu) / (4 * M_PI * 2), 1e-5);
        assert_near(step(a, true, 2, 400), (3 - 2 * nu) / (8 * M_PI * 2), 1e-5);
        assert_near(step(a, false, 2, 1.99 * sqrt(a)), 0, 0);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(closed_form_has_its_limits),
        cmocka_unit_test(below_a_point_load),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
