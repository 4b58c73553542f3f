/* Moving patches on the half-space: at rest they are the resting ones; in motion, many short resting loads
 * one after the other; later and elsewhere they are the same. */
#include "exact/lamb_moving.h"

#include "few.h"
#include "near.h"

#include <string.h>

enum { PLACES = 2, ROWS = 40 };

static struct lamb_problem ground(const struct layered *layers)
{
    struct lamb_problem problem = {.layers = layers};
    half_space_set(&problem.ground, 1, 1, 1);
    return problem;
}

static const struct history gaussian = {.kind = HISTORY_GAUSSIAN, .width = .4, .delay = 2.4};
static const double places[2][PLACES][3] = {{{1.2, .9, 0}, {.4, 1.4, 0}}, {{.9, .6, .8}, {0, .2, 1.1}}};

static void read(const struct lamb_problem *problem, struct lamb_signal *signal, double end, double *value)
{
    for (int r = 0; r < PLACES; r++) {
        for (int i = 0; i < ROWS; i++) {
            double more[6];
            lamb_signal_value(problem, &signal[r], end * (i + 1) / ROWS, more);
            for (int c = 0; c < 6; c++)
                value[6 * (r * ROWS + i) + c] += more[c];
        }
        lamb_signal_free(&signal[r]);
    }
}

static void moving(const struct layered *layers, const struct moving_patch *patch, size_t patches, int depth,
                   double end, double *value)
{
    const struct lamb_problem problem = ground(layers);
    struct lamb_signal signal[PLACES] = {0};
    struct messages messages = {0};
    memset(value, 0, sizeof(double) * 6 * ROWS * PLACES);
    for (int r = 0; r < PLACES; r++)
        memcpy(signal[r].position, places[depth][r], sizeof signal[r].position);
    assert_int_equal(lamb_moving(&problem, patches, patch, end, PLACES, signal, true, &messages), SELAS_OK);
    read(&problem, signal, end, value);
}

static void resting(const struct layered *layers, const struct lamb_load *load, size_t loads, int depth,
                    double end, double *value)
{
    struct lamb_problem problem = ground(layers);
    struct lamb_signal signal[PLACES] = {0};
    struct messages messages = {0};
    problem.load = load;
    problem.loads = loads;
    memset(value, 0, sizeof(double) * 6 * ROWS * PLACES);
    for (int r = 0; r < PLACES; r++)
        memcpy(signal[r].position, places[depth][r], sizeof signal[r].position);
    assert_int_equal(lamb_fft(&problem, end, PLACES, signal, &messages), SELAS_OK);
    read(&problem, signal, end, value);
}

/* L2 of the difference of velocities (or displacements) over all receivers, over the L2. */
static double apart(const double *value, const double *expected, int velocity)
{
    double wrong[2] = {0}, size[2] = {0};
    for (int i = 0; i < 6 * ROWS * PLACES; i++) {
        wrong[i % 6 / 3] += (value[i] - expected[i]) * (value[i] - expected[i]);
        size[i % 6 / 3] += expected[i] * expected[i];
    }
    return sqrt(wrong[velocity] / size[velocity]);
}

static double difference(const double *value, const double *expected)
{
    return fmax(apart(value, expected, 0), apart(value, expected, 1));
}

static void without_velocity_it_rests(void **state)
{
    (void)state;
    static double one[6 * ROWS * PLACES], other[6 * ROWS * PLACES];
    const struct stratum pair[2] = {{0, 1, 1, 1.7320508075688772, 1}, {.5, 1.2, 2, 2.4, 1.2909944487358056}};
    const struct patch patches[3] = {{PATCH_RECTANGLE, {.1, -.2}, {.5, .3}},
                                     {PATCH_DISC, {.1, .1}, {.4, .4}},
                                     {PATCH_POINT, {0, 0}, {0, 0}}};
    struct messages messages = {0};
    struct layered *layers = NULL;
    assert_int_equal(layered_from(2, pair, &layers, &messages), SELAS_OK);
    for (int i = 0; i < 3; i++) {
        const struct moving_patch patch = {{patches[i], {.3, -.4, 1}, &gaussian}, {0, 0}};
        const struct layered *with = i == 1 ? layers : NULL;
        moving(with, &patch, 1, 1, 6, one);
        resting(with, &patch.load, 1, 1, 6, other);
        assert_true(apart(one, other, 1) < 1e-6);
        /* under the disc the plane wave that lamb_fft splits off leaves a constant displacement, which wraps
         * round the period: e^-16 of it */
        assert_true(apart(one, other, 0) < (i == 1 ? 1e-5 : 1e-7));
    }
    const struct moving_patch patch = {{patches[0], {.3, -.4, 1}, &gaussian}, {0, 0}};
    moving(NULL, &patch, 1, 0, 6, one);
    resting(NULL, &patch.load, 1, 0, 6, other);
    assert_true(difference(one, other) < 1e-6);
    layered_free(&layers);
}

/* A blow g(t) on the patch at rest gives w(x, t). Blows a(m) g(t - m) where the patch is at the time m, one
 * after the other, make the moving patch's solution u convolved with g over time:
 *   integral of u(x, t - tau) g(tau) dtau = integral of a(m) w(x - V m, t - m) dm.
 * The trapezoidal rule takes the right side to the spectrum of g at 2 pi/(step (1 + V/c)), waves c that run
 * against the patch: 1e-6 and less. */
enum { BLOWS = 35, MOST_STEPS = 400 };
static const double apart_in_time = .1;
static const struct history blow = {.kind = HISTORY_GAUSSIAN, .width = .2, .delay = 1.2};

static void superpose(const struct lamb_load *load, const double velocity[2], int depth, double end,
                      double *value)
{
    struct lamb_problem problem = ground(NULL);
    struct lamb_load one = *load;
    static struct lamb_signal signal[BLOWS * PLACES];
    struct messages messages = {0};
    one.history = &blow;
    problem.load = &one;
    problem.loads = 1;
    memset(value, 0, sizeof(double) * 6 * ROWS * PLACES);
    for (int i = 0; i < BLOWS * PLACES; i++) {
        memcpy(signal[i].position, places[depth][i % PLACES], sizeof signal[i].position);
        for (int c = 0; c < 2; c++)
            signal[i].position[c] -= velocity[c] * (i / PLACES + 1) * apart_in_time;
    }
    assert_int_equal(lamb_fft(&problem, end, BLOWS * PLACES, signal, &messages), SELAS_OK);
    for (int i = 0; i < BLOWS * PLACES; i++) {
        const double middle = (i / PLACES + 1) * apart_in_time;
        const double height = apart_in_time * history_value(load->history, middle, 0);
        for (int row = 0; row < ROWS; row++) {
            double more[6], *to = value + 6 * (i % PLACES * ROWS + row);
            const double t = end * (row + 1) / ROWS - middle;
            if (t <= 0) continue;
            lamb_signal_value(&problem, &signal[i], t, more);
            for (int c = 0; c < 6; c++)
                to[c] += height * more[c];
        }
        lamb_signal_free(&signal[i]);
    }
}

/* The left side above. */
static void convolve(const struct moving_patch *patch, int depth, double end, double *value)
{
    const struct lamb_problem problem = ground(NULL);
    struct lamb_signal signal[PLACES] = {0};
    struct messages messages = {0};
    const double step = 2 * blow.delay / MOST_STEPS;
    memset(value, 0, sizeof(double) * 6 * ROWS * PLACES);
    for (int r = 0; r < PLACES; r++)
        memcpy(signal[r].position, places[depth][r], sizeof signal[r].position);
    assert_int_equal(lamb_moving(&problem, 1, patch, end, PLACES, signal, true, &messages), SELAS_OK);
    for (int i = 0; i < PLACES * ROWS; i++)
        for (int j = 0; j < MOST_STEPS; j++) {
            double more[6];
            const double before = j * step, t = end * (i % ROWS + 1) / ROWS - before;
            if (t <= 0) continue;
            lamb_signal_value(&problem, &signal[i / ROWS], t, more);
            for (int c = 0; c < 6; c++)
                value[6 * i + c] += step * history_value(&blow, before, 0) * more[c];
        }
    for (int r = 0; r < PLACES; r++)
        lamb_signal_free(&signal[r]);
}

static void compare_with_blows(const double velocity[2], int depth)
{
    static double found[6 * ROWS * PLACES], expected[6 * ROWS * PLACES];
    const struct history history = {.kind = HISTORY_GAUSSIAN, .width = .3, .delay = 1.8};
    const struct moving_patch patch = {{{PATCH_RECTANGLE, {-.8, .3}, {.5, .4}}, {.2, -.3, 1}, &history},
                                       {velocity[0], velocity[1]}};
    convolve(&patch, depth, 3.6, found);
    superpose(&patch.load, velocity, depth, 3.6, expected);
    print_message("V (%g, %g), depth %g: displacement %.1e, velocity %.1e\n", velocity[0], velocity[1],
                  places[depth][0][2], apart(found, expected, 0), apart(found, expected, 1));
    assert_true(apart(found, expected, 0) < 5e-6);
    assert_true(apart(found, expected, 1) < 2e-5);
}

/* Rayleigh .919, S 1, P 1.732. On the surface test_lamb_fast.c has a closed form for vertical loads. */
static void blows_make_a_moving_patch(void **state)
{
    (void)state;
    compare_with_blows((const double[2]){.7, -.2}, 1);
    if (few_of(0, 1)) return;
    compare_with_blows((const double[2]){1.3, -.2}, 1);
    compare_with_blows((const double[2]){1, -.2}, 0);
}

/* The same patch started later and farther back is the same; two patches add. */
static void patches_shift_and_add(void **state)
{
    (void)state;
    static double one[6 * ROWS * PLACES], other[6 * ROWS * PLACES];
    const struct history earlier = {.kind = HISTORY_GAUSSIAN, .width = .4, .delay = 2.4},
                         later = {.kind = HISTORY_GAUSSIAN, .width = .4, .delay = 3};
    /* .6 later = 24 / 40 of the end: 4 rows of .15 */
    const struct moving_patch patch[2] = {
        {{{PATCH_RECTANGLE, {0, 0}, {.5, .5}}, {0, 0, 1}, &earlier}, {.5, 0}},
        {{{PATCH_RECTANGLE, {-.3, 0}, {.5, .5}}, {0, 0, -1}, &later}, {.5, 0}}};
    moving(NULL, patch, 1, 0, 6, one);
    moving(NULL, patch, 2, 0, 6, other);
    double largest = 0;
    for (int r = 0; r < PLACES; r++)
        for (int i = 0; i < ROWS; i++)
            for (int c = 0; c < 6; c++) {
                const double *now = one + 6 * (r * ROWS + i) + c;
                const double expected = *now - (i >= 4 ? now[-24] : 0);
                largest = fmax(largest, fabs(*now));
                assert_near(other[6 * (r * ROWS + i) + c], expected, 1e-6);
            }
    assert_true(largest > .05);
}

static void fast_points_and_kinked_patches_are_refused(void **state)
{
    (void)state;
    const struct history triangle = {.kind = HISTORY_TRIANGLE, .duration = 1};
    const struct stratum pair[2] = {{0, 1, 1, 1.7320508075688772, 1}, {.5, 1.2, 2, 2.4, 1.2909944487358056}};
    const struct moving_patch patch[3] = {
        {{{PATCH_POINT, {0, 0}, {0, 0}}, {0, 0, 1}, &gaussian}, {.95, 0}},
        {{{PATCH_RECTANGLE, {0, 0}, {.5, .5}}, {0, 0, 1}, &triangle}, {.1, 0}},
        {{{PATCH_RECTANGLE, {0, 0}, {.5, .5}}, {0, 0, 1}, &gaussian}, {.95, 0}}};
    struct messages messages = {0};
    struct layered *layers = NULL;
    assert_int_equal(layered_from(2, pair, &layers, &messages), SELAS_OK);
    for (int i = 0; i < 3; i++) {
        const struct lamb_problem problem = ground(i == 2 ? layers : NULL);
        struct lamb_signal signal = {.position = {1, 1, 0}};
        assert_int_equal(lamb_moving(&problem, 1, &patch[i], 2, 1, &signal, true, &messages),
                         SELAS_BAD_SCENE);
        assert_null(signal.value);
        messages_free(&messages);
    }
    layered_free(&layers);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_velocity_it_rests),
        cmocka_unit_test(blows_make_a_moving_patch),
        cmocka_unit_test(patches_shift_and_add),
        cmocka_unit_test(fast_points_and_kinked_patches_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
