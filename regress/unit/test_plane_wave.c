/* The exact plane waves: the wave equation and the conditions at the ends by finite differences, closed forms
 * by hand, and a leapfrog chain at Courant number 1, which solves d'Alembert's problem without error. */
#include "exact/exact.h"
#include "from_deck.h"

#include <stdlib.h>

/* rho = 2, E = 8, nu = 0: c = 2 in 1D and for P waves in 3D; impedance rho c = 4; length 4: 2 per transit. */
#define SOLID "&material name='m', density=2, young=8, poisson=0 /\n"
#define BAR                                                                                                  \
    "&scene dimension=1, end_time=9 /\n" SOLID "&body material='m', low=1, high=5, spacing=.5 /\n"           \
    "&reference kind='plane-wave' /\n"

struct case_of_test {
    struct from_deck deck;
    struct exact *exact;
};

static struct case_of_test begin(const char *text)
{
    struct case_of_test test = {.deck = right_scene(text)};
    const selas_status status = exact_create(test.deck.scene, &test.exact, &test.deck.messages);
    if (status != SELAS_OK) print_error("%s", test.deck.messages.text);
    assert_int_equal(status, SELAS_OK);
    return test;
}

static void end(struct case_of_test *test)
{
    exact_free(&test->exact);
    from_deck_free(&test->deck);
}

/* Displacement (0..2) and velocity (3..5). */
static void at(struct case_of_test *test, double x, double y, double z, double t, double value[6])
{
    const double position[3] = {x, y, z};
    assert_int_equal(test->exact->class->history(test->exact, position, 1, &t, value, &test->deck.messages),
                     SELAS_OK);
}

static double displacement(struct case_of_test *test, double x, double t)
{
    double value[6];
    at(test, x, 0, 0, t, value);
    return value[0];
}

static double velocity(struct case_of_test *test, double x, double t)
{
    double value[6];
    at(test, x, 0, 0, t, value);
    return value[3];
}

/* u_tt = c^2 u_xx, v = u_t, in the bar and through several reflections. */
static void check_wave_equation(struct case_of_test *test, double tolerance)
{
    const double h = 1e-3, k = 7e-4, c = 2;
    double most = 0;
    for (double x = 1.37; x < 5; x += .71)
        for (double t = .113; t < 9; t += .37) {
            const double u = displacement(test, x, t);
            const double in_x =
                (displacement(test, x + h, t) - 2 * u + displacement(test, x - h, t)) / (h * h);
            const double in_t =
                (displacement(test, x, t + k) - 2 * u + displacement(test, x, t - k)) / (k * k);
            const double rate = (displacement(test, x, t + k) - displacement(test, x, t - k)) / (2 * k);
            assert_near(in_t, c * c * in_x, tolerance);
            assert_near(velocity(test, x, t), rate, tolerance);
            most = fmax(most, fabs(u));
        }
    assert_true(most > .1); /* there is something to see */
}

/* Slope du/dx at an end by one-sided differences of third order. */
static double slope(struct case_of_test *test, double end_place, double inward, double t)
{
    const double h = inward * 1e-3;
    return (-11 * displacement(test, end_place, t) + 18 * displacement(test, end_place + h, t) -
            9 * displacement(test, end_place + 2 * h, t) + 2 * displacement(test, end_place + 3 * h, t)) /
           (6 * h);
}

/* A pulse between a free and a held end. */
static void pulse_reflects(void **unused)
{
    (void)unused;
    struct case_of_test test =
        begin(BAR "&boundary face='x+', kind='fixed' /\n"
                  "&initial kind='plane-wave', direction=1, centre=3, width=.25, amplitude=1 /\n");
    check_wave_equation(&test, 1e-3);
    for (double t = 0; t < 9; t += .21) {
        assert_near(slope(&test, 1, 1, t), 0, 1e-5);
        assert_near(displacement(&test, 5, t), 0, 1e-13);
        assert_near(velocity(&test, 5, t), 0, 1e-11);
    }
    assert_near(displacement(&test, 4, .5), 1, 1e-12);   /* the peak on its way */
    assert_near(displacement(&test, 4, 1.5), -1, 1e-12); /* back from the held end, turned over */
    assert_near(displacement(&test, 1, 3), -2, 1e-12);   /* doubled at the free end */
    assert_near(displacement(&test, 3, 8), 1, 1e-12);    /* as it began, after four transits */
    assert_near(displacement(&test, 3, 4), -1, 1e-12);   /* and turned over after two */
    end(&test);
}

/* A train of waves that leaves an absorbing end alone and comes back from a damper of twice the impedance. */
static void dampers(void **unused)
{
    (void)unused;
    struct case_of_test test =
        begin(BAR "&boundary face='x+', kind='transmitting', normal_factor=2 /\n"
                  "&boundary face='x-', kind='transmitting' /\n"
                  "&initial kind='plane-wave', direction=1, centre=2, width=.125, amplitude=1 /\n");
    check_wave_equation(&test, 2e-2);
    for (double t = 0; t < 4; t += .17) /* traction = -2 rho c v, E u_x = -2 rho c v */
        assert_near(8 * slope(&test, 5, -1, t), -2 * 4 * velocity(&test, 5, t), 1e-3);
    assert_near(displacement(&test, 3, 2.5), -1. / 3, 1e-12); /* (1 - 2) / (1 + 2) */
    assert_near(displacement(&test, 3, 6), displacement(&test, 3, 8), 1e-12);
    assert_near(velocity(&test, 3, 6), 0, 1e-12); /* all has left */
    end(&test);
}

/* Traction on the end of a bar at rest: v = f(t - x/c) / (rho c), doubled where it meets a free end. */
static void traction_on_an_end(void **unused)
{
    (void)unused;
    struct case_of_test test = begin(BAR "&load face='x-', direction=1, amplitude=6, history='gaussian', "
                                         "delay=1, width=.15 /\n");
    check_wave_equation(&test, 2e-2);
    for (double t = 0; t < 9; t += .21) {
        assert_near(-8 * slope(&test, 1, 1, t), 6 * exp(-pow((t - 1) / .15, 2) / 2), 1e-3);
        assert_near(slope(&test, 5, -1, t), 0, 1e-4);
    }
    assert_near(velocity(&test, 1, 1), 6. / 4, 1e-9);
    assert_near(velocity(&test, 3, 2), 6. / 4, 1e-9);
    assert_near(velocity(&test, 5, 3), 2 * 6. / 4, 1e-9);
    assert_near(displacement(&test, 3, 2.5), 6. / 4 * .15 * sqrt(2 * M_PI), 3e-3 * .5);
    /* momentum per area: the impulse 6 * .15 sqrt(2 pi), at rest to begin with */
    double momentum = 0;
    for (int i = 0; i < 400; i++)
        momentum += 2 * velocity(&test, 1.005 + .01 * i, 6.3) * .01;
    assert_near(momentum, 6 * .15 * sqrt(2 * M_PI), 1e-6);
    end(&test);
}

/* Pulling at the other end: the wave goes the other way. */
static void traction_on_the_high_end(void **unused)
{
    (void)unused;
    struct case_of_test test = begin(BAR "&load face='x+', direction=1, amplitude=6, history='gaussian', "
                                         "delay=1, width=.15 /\n&boundary face='x-', kind='roller' /\n");
    assert_near(velocity(&test, 5, 1), 6. / 4, 1e-9);
    assert_near(velocity(&test, 3, 2), 6. / 4, 1e-9);
    assert_near(velocity(&test, 3, 4), -6. / 4, 1e-9);
    for (double t = 0; t < 9; t += .21)
        assert_near(8 * slope(&test, 5, -1, t), 6 * exp(-pow((t - 1) / .15, 2) / 2), 1e-3);
    end(&test);
}

static void moving_ends(void **unused)
{
    (void)unused;
    struct case_of_test test =
        begin(BAR "&boundary face='x-', kind='velocity', direction=-1, amplitude=3, history='triangle', "
                  "duration=1, smoothing=.5 /\n"
                  "&boundary face='x+', kind='displacement', direction=1, amplitude=.5, history='gaussian', "
                  "delay=3, width=.2 /\n");
    check_wave_equation(&test, 2e-2);
    const struct boundary *boundary = test.deck.scene->boundary;
    for (double t = .05; t < 9; t += .21) {
        assert_near(velocity(&test, 1, t), -3 * history_value(&boundary[0].history, t, 0), 1e-12);
        assert_near(displacement(&test, 1, t), -3 * history_value(&boundary[0].history, t, -1), 1e-12);
        assert_near(displacement(&test, 5, t), .5 * history_value(&boundary[1].history, t, 0), 1e-12);
    }
    assert_near(velocity(&test, 3, 1.7), -3 * history_value(&boundary[0].history, .7, 0), 1e-12);
    end(&test);
}

/* Leapfrog at Courant number 1: u(i, n+1) = u(i+1, n) + u(i-1, n) - u(i, n-1) holds exactly for d'Alembert's
 * solution, with images u(-1) = u(1) at a free end and u = 0 at a held one. */
static void chain_without_error(void **unused)
{
    (void)unused;
    enum { CELLS = 40, STEPS = 170 };
    struct case_of_test test =
        begin(BAR "&boundary face='x-', kind='fixed' /\n"
                  "&initial kind='gaussian', direction=-1, centre=3.2, width=.2, amplitude=1.5 /\n");
    double u[3][CELLS + 1];
    const double h = 4. / CELLS, dt = h / 2;
    for (int i = 0; i <= CELLS; i++) {
        const double r = (1 + i * h - 3.2) / .2;
        u[0][i] = -1.5 * exp(-r * r / 2);
    }
    for (int i = 0; i <= CELLS; i++) /* at rest: the mean of the neighbours */
        u[1][i] = i == 0 ? 0 : (u[0][i - 1] + u[0][i == CELLS ? i - 1 : i + 1]) / 2;
    for (int n = 1; n < STEPS; n++) {
        const double *now = u[n % 3], *before = u[(n + 2) % 3];
        double *next = u[(n + 1) % 3];
        for (int i = 0; i <= CELLS; i++) {
            assert_near(displacement(&test, 1 + i * h, n * dt), now[i], 1e-12);
            next[i] = i == 0 ? 0 : now[i - 1] + now[i == CELLS ? i - 1 : i + 1] - before[i];
        }
    }
    end(&test);
}

/* All of the bar moves: it goes on until the held end stops it, part by part; after two transits it flies
 * back. */
static void flying_bar(void **unused)
{
    (void)unused;
    struct case_of_test test = begin(BAR "&boundary face='x+', kind='fixed' /\n"
                                         "&initial kind='uniform-velocity', velocity=3 /\n");
    assert_near(velocity(&test, 4, .4), 3, 1e-13);
    assert_near(displacement(&test, 4, .4), 1.2, 1e-13);
    assert_near(velocity(&test, 4, .6), 0, 1e-13);
    assert_near(displacement(&test, 4, 1), 1.5, 1e-13);
    assert_near(velocity(&test, 2, 3), -3, 1e-13); /* 2 to 5 and back to 2 is not there yet, from 1 it is */
    end(&test);
}

/* Reference 'bar' solves the bars at rest by its own sums over reflections: both agree, loads and moving
 * ends, through nine transits. */
static void agrees_with_bar(void **unused)
{
    (void)unused;
    static const char *const ends[] = {
        "&load face='x-', direction=1, amplitude=6, history='triangle', duration=1.3 /\n"
        "&boundary face='x+', kind='fixed' /\n",
        "&load face='x+', direction=-1, amplitude=6, history='ricker', frequency=1, delay=1.5 /\n",
        "&boundary face='x-', kind='velocity', direction=1, amplitude=3, history='sine-burst', frequency=2 "
        "/\n"
        "&boundary face='x+', kind='transmitting' /\n",
    };
    enum { TIMES = 60 };
    double time[TIMES], one[6 * TIMES], other[6 * TIMES];
    const double place[3] = {2.3, 0, 0};
    for (int i = 0; i < TIMES; i++)
        time[i] = .017 + .3 * i;
    for (size_t k = 0; k < sizeof ends / sizeof ends[0]; k++) {
        char text[1024];
        double most = 0;
        snprintf(text, sizeof text, BAR "%s", ends[k]);
        struct case_of_test wave = begin(text);
        memcpy(strstr(text, "'plane-wave'"), "'bar'       ", 12);
        struct case_of_test bar = begin(text);
        assert_int_equal(wave.exact->class->history(wave.exact, place, TIMES, time, one, &wave.deck.messages),
                         SELAS_OK);
        assert_int_equal(bar.exact->class->history(bar.exact, place, TIMES, time, other, &bar.deck.messages),
                         SELAS_OK);
        for (int i = 0; i < 6 * TIMES; i++) {
            assert_near(one[i], other[i], 1e-11);
            most = fmax(most, fabs(one[i]));
        }
        assert_true(most > .5);
        end(&wave);
        end(&bar);
    }
}

#define BLOCK(faces)                                                                                         \
    "&scene dimension=3, end_time=9 /\n&material name='m', density=2, lambda=3, mu=5 /\n"                    \
    "&body material='m', low=0,0,0, high=4,2,2, spacing=.5 /\n&reference kind='plane-wave' /\n" faces
#define P_WAVE "&initial kind='plane-wave', direction=1,0,0, centre=1,0,0, width=.2, amplitude=1 /\n"
#define S_WAVE                                                                                               \
    "&initial kind='plane-wave', wave='s', direction=1,0,0, polarisation=0,1,0, centre=1,0,0, width=.2, "    \
    "amplitude=1 /\n"

static const char *last_told;
static char told_text[256];
static void tell(void *context, const char *key, const char *value)
{
    (void)context;
    if (strcmp(key, "exact until") != 0) return;
    snprintf(told_text, sizeof told_text, "%s", value);
    last_told = told_text;
}

static const char *until(struct case_of_test *test)
{
    last_told = "";
    test->exact->class->describe(test->exact, tell, NULL);
    return last_told;
}

/* In a box: rollers let a P wave pass for all time, free faces do not. */
static void p_wave_in_a_box(void **unused)
{
    (void)unused;
    const double c = sqrt(6.5);
    double value[6];
    struct case_of_test test = begin(BLOCK("&boundary face='y-','y+','z-','z+', kind='roller' /\n") P_WAVE
                                     "&receiver name='a', position=2,0,2 /\n");
    assert_string_equal(until(&test), "all times");
    at(&test, 2, 0, 2, 1 / c, value);
    assert_near(value[0], 1, 1e-13);
    at(&test, 4, 1, 1, 3 / c, value);
    assert_near(value[0], 2, 1e-13); /* the far end is free */
    end(&test);
    test = begin(BLOCK(P_WAVE "&receiver name='a', position=2,.5,1.5 /\n"));
    char text[64];
    snprintf(text, sizeof text, "t = %.6g at receiver a", .5 / c);
    assert_non_null(strstr(until(&test), text));
    assert_non_null(strstr(until(&test), "before end_time"));
    end(&test);
}

/* S waves: rollers (or nothing) across the polarisation, x held along it. */
static void s_wave_in_a_box(void **unused)
{
    (void)unused;
    const double c = sqrt(2.5);
    double value[6];
    struct case_of_test test =
        begin(BLOCK("&boundary face='y-','y+', kind='displacement', direction=1,0,0, slip=T, amplitude=0, "
                    "history='step' /\n&boundary face='z-', kind='symmetry' /\n") S_WAVE
              "&receiver name='a', position=2,0,2 /\n");
    assert_string_equal(until(&test), "all times");
    at(&test, 2, 0, 2, 1 / c, value);
    assert_near(value[1], 1, 1e-13);
    assert_near(value[0], 0, 0);
    end(&test);
    test = begin(BLOCK("&boundary face='y-','y+', kind='roller' /\n") S_WAVE
                 "&receiver name='a', position=2,1,2 /\n");
    assert_non_null(strstr(until(&test), "t = 0.392232 at receiver a")); /* 1 / sqrt(6.5) */
    end(&test);
}

/* A traction on the whole of a face sends a P or an S wave into a box at rest; also a turned one. */
static void load_on_a_box(void **unused)
{
    (void)unused;
    double value[6];
    struct case_of_test test = begin(
        BLOCK("&boundary face='y-','y+','z-','z+', kind='roller' /\n"
              "&load face='x-', shape='face', direction=1,0,0, amplitude=6, history='gaussian', delay=1, "
              "width=.15 /\n&receiver name='a', position=2,0,2 /\n"));
    at(&test, 2, 1, 1, 1 + 2 / sqrt(6.5), value);
    assert_near(value[3], 6 / (2 * sqrt(6.5)), 1e-9);
    end(&test);
    test = begin("&scene dimension=3, end_time=9 /\n&material name='m', density=2, lambda=3, mu=5 /\n"
                 "&body material='m', low=-2,-2,-2, high=2,2,2, spacing=.5, rotation=0,0,30 /\n"
                 "&boundary face='y-','y+','z-','z+', kind='roller' /\n&reference kind='plane-wave' /\n"
                 "&initial kind='plane-wave', direction=0.8660254037844386,0.5,0, centre=0,0,0, width=.2, "
                 "amplitude=1 /\n&receiver name='a', position=0,0,2 /\n");
    assert_string_equal(until(&test), "all times");
    at(&test, .8660254037844386, .5, 1, 1 / sqrt(6.5), value);
    assert_near(value[0], .8660254037844386, 1e-12);
    assert_near(value[1], .5, 1e-12);
    end(&test);
}

/* Askew: the infinite solid's wave, until the faces are felt. */
static void askew(void **unused)
{
    (void)unused;
    double value[6];
    struct case_of_test test = begin(
        BLOCK("&initial kind='plane-wave', wave='s', direction=1,2,2, polarisation=0,1,-1, wavelength=3, "
              "amplitude=2 /\n&receiver name='a', position=2,1,1.5 /\n"));
    const double s = (2 + 2 + 3) / 3. - sqrt(2.5) * .1, k = 2 * M_PI / 3;
    at(&test, 2, 1, 1.5, .1, value);
    assert_near(value[1], 2 * sin(k * s) / sqrt(2), 1e-13);
    assert_near(value[2], -2 * sin(k * s) / sqrt(2), 1e-13);
    assert_near(value[4], -2 * k * sqrt(2.5) * cos(k * s) / sqrt(2), 1e-13);
    assert_near(value[0], 0, 1e-16);
    assert_non_null(strstr(until(&test), "t = 0.196116 at receiver a")); /* .5 / sqrt(6.5) */
    end(&test);
}

static void refusals(void **unused)
{
    (void)unused;
    static const struct {
        const char *deck, *word;
    } cases[] = {
        {BLOCK(P_WAVE "&receiver name='a', position=2,0,1 /\n"), "disturbed from the start at 2, 0, 1"},
        {BLOCK("&initial kind='gaussian', direction=1,0,0, centre=1,1,1, width=1, amplitude=1 /\n"),
         "the scene has none at t = 0"},
        {BLOCK(""), "the scene has none at t = 0"},
        {BLOCK(P_WAVE "&load face='z-', shape='face', direction=0,0,1, history='step' /\n"),
         "&load 1 is not a traction on the whole of an end"},
        {BLOCK(P_WAVE "&load face='x-', shape='face', direction=0,0,1, history='step' /\n"),
         "&load 1 is not a traction on the whole of an end"},
        {BLOCK("&load face='x-', shape='disc', centre=0,1,1, size=1, direction=1,0,0, history='step' /\n"),
         "&load 1 is not a traction on the whole of an end"},
        {BAR "&load kind='body-force', direction=1, history='step' /\n",
         "&load 1 is not a traction on the whole of an end"},
        {BLOCK(P_WAVE "&boundary face='x+', kind='velocity', direction=0,1,0, history='step' /\n"),
         "'x+' moves in another direction"},
        {"&scene dimension=2, end_time=9 /\n" SOLID
         "&body material='m', shape='plate-with-hole', low=0,0, high=1,1, spacing=.1, hole_centre=0,0, "
         "hole_radius=.2 /\n&reference kind='plane-wave' /\n",
         "shape 'box'"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct from_deck deck = right_scene(cases[i].deck);
        struct exact *exact = NULL;
        assert_int_equal(exact_create(deck.scene, &exact, &deck.messages), SELAS_BAD_SCENE);
        assert_null(exact);
        if (strstr(deck.messages.text, cases[i].word) == NULL) {
            print_error("expected \"%s\" in %s", cases[i].word, deck.messages.text);
            assert_true(false);
        }
        from_deck_free(&deck);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(pulse_reflects),     cmocka_unit_test(dampers),
        cmocka_unit_test(traction_on_an_end), cmocka_unit_test(traction_on_the_high_end),
        cmocka_unit_test(moving_ends),        cmocka_unit_test(chain_without_error),
        cmocka_unit_test(flying_bar),         cmocka_unit_test(agrees_with_bar),
        cmocka_unit_test(p_wave_in_a_box),    cmocka_unit_test(s_wave_in_a_box),
        cmocka_unit_test(load_on_a_box),      cmocka_unit_test(askew),
        cmocka_unit_test(refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
