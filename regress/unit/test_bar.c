/* The reference 'bar': reflections at fixed, free, driven and transmitting ends, and the closed form of the
 * smearing. */
#include "exact/bar.h"
#include "plain_scene.h"

#include "near.h"

static struct plain_scene plain;
static double speed, impedance;

/* A bar of length 2 with a step traction of 3 on the low end, another end as `kind`. */
static struct exact *bar(enum boundary_kind high)
{
    const double size[3] = {2, 0, 0}, traction[3] = {1, 0, 0};
    plain_box(&plain, 1, size, .1);
    struct load *load = plain_face_load(&plain, FACE_X_LOW, traction);
    load->amplitude = 3;
    load->history.kind = HISTORY_STEP;
    plain.scene.boundary[FACE_X_HIGH].kind = high;
    speed = plain.material[0].p_speed;
    impedance = speed * plain.material[0].density;
    strcpy(plain.scene.reference.kind, "bar");
    struct exact *exact = NULL;
    struct messages messages = {0};
    if (exact_create(&plain.scene, &exact, &messages) != SELAS_OK) fail_msg("%s", messages.text);
    return exact;
}

/* Velocity and displacement at x and time t, in units of the front's velocity v0 = 3 / impedance. */
static void at(struct exact *exact, double x, double t, double *velocity, double *displacement)
{
    const double place[3] = {x, 0, 0}, v0 = 3 / impedance;
    double value[6];
    struct messages messages = {0};
    assert_int_equal(exact->class->history(exact, place, 1, &t, value, &messages), SELAS_OK);
    *displacement = value[0] / v0;
    *velocity = value[3] / v0;
    for (int c = 1; c < 6; c++)
        if (c != 3) assert_true(value[c] == 0);
}

static void ends(void **unused)
{
    (void)unused;
    const enum boundary_kind kinds[3] = {BOUNDARY_FIXED, BOUNDARY_FREE, BOUNDARY_TRANSMITTING};
    const double after[3] = {0, 2, 1};
    for (int k = 0; k < 3; k++) {
        struct exact *exact = bar(kinds[k]);
        const double x = 1.5, arrival = x / speed, back = 2.5 / speed;
        double v, u;
        at(exact, x, .99 * arrival, &v, &u);
        assert_true(v == 0 && u == 0);
        at(exact, x, 2 / speed, &v, &u);
        assert_near(v, 1, 1e-13);
        assert_near(u, 2 / speed - arrival, 1e-13);
        at(exact, x, 3 / speed, &v, &u);
        assert_near(v, after[k], 1e-13);
        assert_near(u, back - arrival + after[k] * (3 / speed - back), 1e-13);
        exact_free(&exact);
    }
}

/* Between two free ends the load of a step accelerates the whole bar: mean velocity = force t / mass. */
static void momentum(void **unused)
{
    (void)unused;
    struct exact *exact = bar(BOUNDARY_FREE);
    const double t = 7.3 / speed;
    double mean = 0, v, u;
    const int n = 1000;
    for (int i = 0; i < n; i++) {
        at(exact, 2 * (i + .5) / n, t, &v, &u);
        mean += v / n;
    }
    assert_near(mean * 3 / impedance, 3 * t / (2 * plain.material[0].density), 2e-3);
    exact_free(&exact);
}

/* A driven end: the wall's velocity, reflected at the other, fixed end. */
static void driven_end(void **unused)
{
    (void)unused;
    struct exact *exact = bar(BOUNDARY_FIXED);
    plain.scene.loads = 0;
    struct boundary *low = &plain.scene.boundary[FACE_X_LOW];
    low->kind = BOUNDARY_VELOCITY;
    low->amplitude = 3 / impedance;
    low->direction[0] = 1;
    low->history.kind = HISTORY_STEP;
    double v, u;
    at(exact, .5, 1 / speed, &v, &u);
    assert_near(v, 1, 1e-13);
    at(exact, .5, 4 / speed, &v, &u);
    assert_near(v, 0, 1e-13);
    at(exact, .5, 5 / speed, &v, &u);
    assert_near(v, 1, 1e-13);
    exact_free(&exact);
}

/* Relative errors sum|e| / sum|v| and sqrt(sum e^2 / sum v^2) of the velocity behind a step front that
 * Monaghan's viscosity has smeared, at time t after it entered the bar at speed c (before it returns). The
 * linear term is, in the continuum, a viscosity that spreads the front like heat with D = alpha c h / 4:
 *
 *   v = v0/2 erfc((x - c t) / (2 sqrt(D t))),  L1 = 2 sqrt(D t / pi) / (c t),
 *   L2^2 = (2 - sqrt(2)) sqrt(D t / pi) / (c t) */
static void front_errors(double alpha, double smoothing_length, double c, double time, double *l1, double *l2)
{
    const double width = sqrt(alpha * c * smoothing_length / 4 * time);
    *l1 = 2 * width / (sqrt(M_PI) * c * time);
    *l2 = sqrt((2 - sqrt(2)) * width / (sqrt(M_PI) * c * time));
}

/* L1 and L2 by summing the smeared front itself; the values of the design notes for 250 particles. */
static void smearing(void **unused)
{
    (void)unused;
    const double c = 5088.4, t = .12e-3, h = 1.5 / 250, width = sqrt(2.5 * c * h / 4 * t);
    double first = 0, second = 0, all = 0, l1, l2;
    for (double x = .00005; x < 1; x += .0001) {
        const double exact = x < c * t ? 1 : 0, error = erfc((x - c * t) / (2 * width)) / 2 - exact;
        first += fabs(error);
        second += error * error;
        all += exact;
    }
    front_errors(2.5, h, c, t, &l1, &l2);
    assert_near(l1, first / all, 2e-5);
    assert_near(l2, sqrt(second / all), 2e-5);
    assert_near(l1, .0884, 5e-5);
    assert_near(l2, .1609, 5e-5);
}

static void refuses(void **unused)
{
    (void)unused;
    struct exact *exact = bar(BOUNDARY_FREE);
    exact_free(&exact);
    struct messages messages = {0};
    plain.scene.dimension = 2;
    assert_int_equal(exact_create(&plain.scene, &exact, &messages), SELAS_BAD_SCENE);
    assert_non_null(strstr(messages.text, "one-dimensional"));
    messages_free(&messages);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(ends), cmocka_unit_test(momentum),
                                       cmocka_unit_test(driven_end), cmocka_unit_test(smearing),
                                       cmocka_unit_test(refuses)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
