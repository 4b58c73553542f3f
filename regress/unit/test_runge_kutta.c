/* The Runge-Kutta schemes: observed order on a forced, damped, nonlinear oscillator; the step itself against
 * the stability polynomial; real and imaginary limits; internal stability of RKC with many stages. */
#include "stepping/rkc.h"
#include "stepping/schemes.h"

#include "near.h"

/* y = [u | v] of two test problems, by the model's `unknowns` = 1:
 *
 *   pendulum  u' = v, v' = -sin u - v/2 + cos t
 *   decay     u' = rate u (v unused) */
static double decay_rate;

static void pendulum(struct model *model, const struct drive *drive, const double *y, double *dydt)
{
    model->evaluations++;
    dydt[0] = y[1];
    dydt[1] = -sin(y[0]) - .5 * y[1] + cos(drive->time);
}

static void decay(struct model *model, const struct drive *drive, const double *y, double *dydt)
{
    (void)drive;
    model->evaluations++;
    dydt[0] = decay_rate * y[0];
    dydt[1] = 0;
}

/* The same pendulum in second-order form. */
static void pendulum_acceleration(struct model *model, const struct drive *drive, double half_step,
                                  const double *u, const double *v, double *a)
{
    (void)half_step;
    model->evaluations++;
    a[0] = -sin(u[0]) - .5 * v[0] + cos(drive->time);
}

static const struct scene empty;
static const struct model_operator pendulum_operator = {.rate = pendulum};
static const struct model_operator decay_operator = {.rate = decay};
static const struct model_operator acceleration_operator = {.accelerate = pendulum_acceleration};

/* Runs `steps` steps from y; returns the number of calls. */
static unsigned long run(const struct model_operator *spatial, const char *scheme, long stages, double dt,
                         long steps, double y[2])
{
    struct model model = {.spatial = spatial, .scene = &empty, .unknowns = 1, .state_size = 2};
    double work[5][2], *vectors[5] = {work[0], work[1], work[2], work[3], work[4]}, a[1];
    struct messages messages = {0};
    struct stepper stepper = {
        .scheme = scheme_find(scheme), .model = &model, .dt = dt, .stages = stages, .work = vectors};
    struct state state = {.y = y, .a = a};
    assert_int_equal(driver_create(&stepper.driver, &empty, dt, &messages), SELAS_OK);
    assert_true(stepper.scheme->vectors <= 5);
    stepper.scheme->start(&stepper, &state);
    for (long n = 0; n < steps; n++)
        stepper.scheme->step(&stepper, &state);
    assert_int_equal(state.step, steps);
    driver_free(&stepper.driver);
    return model.evaluations;
}

static double pendulum_error(const struct model_operator *spatial, const char *scheme, long stages,
                             long steps)
{
    double fine[2] = {1, .5}, y[2] = {1, .5};
    run(&pendulum_operator, "rk4", 0, 2.0 / 20000, 20000, fine);
    run(spatial, scheme, stages, 2.0 / (double)steps, steps, y);
    return hypot(y[0] - fine[0], y[1] - fine[1]);
}

static void check_order(const char *scheme, long stages, long steps, double order)
{
    const double coarse = pendulum_error(&pendulum_operator, scheme, stages, steps);
    const double fine = pendulum_error(&pendulum_operator, scheme, stages, 2 * steps);
    const double observed = log2(coarse / fine);
    if (fabs(observed - order) > .12) fail_msg("%s(%ld): order %.3f", scheme, stages, observed);
}

static void orders(void **unused)
{
    (void)unused;
    check_order("euler", 0, 400, 1);
    check_order("pc2", 0, 100, 2);
    check_order("rk4", 0, 40, 4);
    check_order("lsrk54", 0, 40, 4);
    const long stages[] = {2, 3, 4, 5, 10, 30};
    for (size_t i = 0; i < sizeof stages / sizeof *stages; i++)
        check_order("rkc", stages[i], 400, 2);
}

static void acceleration_form_is_the_same(void **unused)
{
    (void)unused;
    const char *const schemes[] = {"euler", "pc2", "rk4", "lsrk54", "rkc"};
    for (size_t i = 0; i < 5; i++) {
        double first[2] = {1, .5}, second[2] = {1, .5};
        run(&pendulum_operator, schemes[i], 4, .05, 20, first);
        run(&acceleration_operator, schemes[i], 4, .05, 20, second);
        assert_true(first[0] == second[0] && first[1] == second[1]);
    }
}

/* One evaluation at the start, then `evaluations` a step (RKC: one per stage). */
static void calls_a_step(void **unused)
{
    (void)unused;
    double y[2] = {1, 0};
    assert_int_equal(run(&pendulum_operator, "euler", 0, .01, 10, y), 11);
    assert_int_equal(run(&pendulum_operator, "pc2", 0, .01, 10, y), 21);
    assert_int_equal(run(&pendulum_operator, "rk4", 0, .01, 10, y), 41);
    assert_int_equal(run(&pendulum_operator, "lsrk54", 0, .01, 10, y), 51);
    assert_int_equal(run(&pendulum_operator, "rkc", 7, .01, 10, y), 71);
}

/* A step of y' = z y multiplies y by R(z); for RKC this holds all coefficients against the closed form. */
static void step_follows_polynomial(void **unused)
{
    (void)unused;
    for (long stages = 2; stages <= 200; stages += stages < 20 ? 1 : 45)
        for (double z = -.6 * (double)(stages * stages - 1); z < .5; z += .07 * (double)(stages * stages)) {
            double y[2] = {1, 0};
            decay_rate = z;
            run(&decay_operator, "rkc", stages, 1, 1, y);
            assert_near(y[0], creal(rkc_polynomial(z, stages)), 1e-11 * (double)stages);
        }
}

/* R(z) = 1 + z + z^2/2 + O(z^3). */
static void rkc_is_second_order(void **unused)
{
    (void)unused;
    for (long stages = 2; stages <= 120; stages += 7) {
        const double h = 1e-2;
        const double plus = creal(rkc_polynomial(h, stages)), minus = creal(rkc_polynomial(-h, stages));
        assert_near((plus - minus) / (2 * h), 1, h * h / 6);
        assert_near((plus - 2 + minus) / (h * h), 1, h * h / 12);
    }
}

/* Rounding noise of 1e-16 a stage must not be blown up: many steps at the edge of stability with s = 150. */
static void rkc_internal_stability(void **unused)
{
    (void)unused;
    double y[2] = {1, 0};
    decay_rate = -.653 * (150.0 * 150 - 1);
    run(&decay_operator, "rkc", 150, 1, 2000, y);
    assert_true(fabs(y[0]) < 1e-12);
    double slow[2] = {1, 0};
    decay_rate = -1e-3;
    run(&decay_operator, "rkc", 150, 1, 1000, slow);
    assert_near(slow[0], exp(-1), 2e-7);
}

static double limit(const char *scheme, double omega, double viscous, long stages)
{
    const struct spectrum spectrum = {.omega = omega, .wave_damping = viscous, .viscous = viscous};
    return scheme_limit(scheme_find(scheme), &spectrum, stages);
}

static void imaginary_limits(void **unused)
{
    (void)unused;
    assert_near(limit("rk4", 1, 0, 0), sqrt(8), 1e-4);
    assert_near(limit("leapfrog", 1, 0, 0), 2, 1e-12);
    assert_near(limit("lsrk54", 1, 0, 0), 3.342, 2e-3); /* Carpenter & Kennedy 1994, table 1: 3.34 */
    assert_true(limit("euler", 1, 0, 0) == 0);
    assert_true(limit("pc2", 1, 0, 0) == 0);
    for (long stages = 2; stages <= 40; stages++)
        assert_true(limit("rkc", 1, 0, stages) == 0);
    assert_near(limit("rk4", 50, 0, 0), sqrt(8) / 50, 1e-5);
    assert_true(isinf(limit("rk4", 0, 0, 0)));
}

static void real_limits(void **unused)
{
    (void)unused;
    assert_near(limit("euler", 0, 1, 0), 2, 1e-4);
    assert_near(limit("pc2", 0, 1, 0), 2, 1e-4);
    assert_near(limit("rk4", 0, 1, 0), 2.7853, 1e-4);
    const long stages[] = {2, 3, 5, 10, 30, 100};
    for (size_t i = 0; i < 6; i++) {
        const double s = (double)stages[i], bound = .653 * (s * s - 1);
        const double longest = limit("rkc", 0, 1, stages[i]);
        assert_true(longest >= bound && longest < 1.2 * bound);
    }
    assert_near(limit("rkc", 0, 1, 3), 6.2, .1); /* measured values of the design notes */
    assert_near(limit("rkc", 0, 1, 5), 16.6, .1);
    assert_near(limit("rkc", 0, 1, 10), 64.7, .3);
}

/* With waves and viscosity together more stages stop paying: the limit grows no more although the real axis
 * would allow s^2. */
static void stages_do_not_lift_the_wave_limit(void **unused)
{
    (void)unused;
    const double five = limit("rkc", .69, 2.17, 5), ten = limit("rkc", .69, 2.17, 10),
                 thirty = limit("rkc", .69, 2.17, 30);
    assert_true(five > 2 && ten < 3 * five && thirty < 1.6 * ten);
    double best = 0;
    const struct spectrum spectrum = {.omega = .69, .wave_damping = 2.17, .viscous = 2.17};
    const long stages = rkc_best_stages(&spectrum, 50, &best);
    assert_true(stages >= 3 && stages <= 10);
    assert_near(best, limit("rkc", .69, 2.17, stages), 1e-5);
    assert_int_equal(rkc_stages_for(.999 * best, &spectrum, 50), stages);
    const struct spectrum waves = {.omega = 1};
    assert_int_equal(rkc_best_stages(&waves, 50, &best), 0);
    assert_int_equal(rkc_stages_for(.5, &waves, 50), 0);
}

/* Stages between brackets in He & Seaid's Table 1: CFL = c0 dt NP with c0 = 5088.4 m/s and steps of .118,
 * .236, .472 microseconds. Eq 28 gives all of them but one: 750 particles at .118 microseconds have (2)
 * there. */
static void paper_rule(void **unused)
{
    (void)unused;
    const double c0 = sqrt(45e9 / 1738);
    const long stages[4][3] = {{2, 2, 3}, {2, 3, 4}, {3, 3, 4}, {3, 4, 5}};
    for (int i = 0; i < 4; i++)
        for (int j = 0; j < 3; j++)
            assert_int_equal(rkc_paper_stages(c0 * .118e-6 * (1 << j) * 250 * (i + 1)), stages[i][j]);
    assert_int_equal(rkc_paper_stages(2.5), 5); /* "only five stages" at CFL 2.5, section 4.2 */
    assert_int_equal(rkc_radius_stages(.653 * 24), 6);
    assert_int_equal(rkc_paper_stages(0), 2);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(orders),
        cmocka_unit_test(acceleration_form_is_the_same),
        cmocka_unit_test(calls_a_step),
        cmocka_unit_test(step_follows_polynomial),
        cmocka_unit_test(rkc_is_second_order),
        cmocka_unit_test(rkc_internal_stability),
        cmocka_unit_test(imaginary_limits),
        cmocka_unit_test(real_limits),
        cmocka_unit_test(stages_do_not_lift_the_wave_limit),
        cmocka_unit_test(paper_rule),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
