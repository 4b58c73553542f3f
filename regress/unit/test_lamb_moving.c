/* Moving patches on the half-space: at rest they are the resting ones; in motion, many short resting loads
 * one after the other; later and elsewhere they are the same. */
#include "exact/lamb_moving.h"

#include "near.h"

#include <string.h>

enum { PLACES = 2, ROWS = 40, MOST_PULSES = 96 };

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
    assert_int_equal(lamb_moving(&problem, patches, patch, end, PLACES, signal, &messages), SELAS_OK);
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

/* f(t) = sum over m of f(t) (d / (w sqrt(2 pi))) exp(-(t - m d)^2 / (2 w^2)), d <= w, to 1e-8; each part is a
 * Gaussian again, and the patch moves V w while it lasts: put at its place at the middle, an error of order
 * w^2. */
static void superpose(double w, double *value)
{
    static const double velocity[2] = {.45, -.2};
    struct history part[MOST_PULSES];
    struct lamb_load load[MOST_PULSES];
    const double sigma = gaussian.width, d = w, product = 1 / sqrt(1 / (sigma * sigma) + 1 / (w * w));
    size_t count = 0;
    for (double t = -.3; t < 5.2; t += d) {
        const double height =
            d / (w * sqrt(2 * M_PI)) * exp(-.5 * pow(t - gaussian.delay, 2) / (sigma * sigma + w * w));
        const double middle = (gaussian.delay * w * w + t * sigma * sigma) / (sigma * sigma + w * w);
        if (height < 1e-7) continue;
        assert_true(count < MOST_PULSES);
        part[count] = (struct history){.kind = HISTORY_GAUSSIAN, .width = product, .delay = middle};
        load[count] = (struct lamb_load){
            {PATCH_RECTANGLE, {-.8 + velocity[0] * middle, .3 + velocity[1] * middle}, {.5, .4}},
            {.2 * height, -.3 * height, height},
            &part[count]};
        count++;
    }
    resting(NULL, load, count, 1, 6, value);
}

static void short_resting_loads_make_a_moving_one(void **state)
{
    (void)state;
    static double found[6 * ROWS * PLACES], coarse[6 * ROWS * PLACES], fine[6 * ROWS * PLACES];
    const struct moving_patch patch = {{{PATCH_RECTANGLE, {-.8, .3}, {.5, .4}}, {.2, -.3, 1}, &gaussian},
                                       {.45, -.2}};
    const double w = .12;
    moving(NULL, &patch, 1, 1, 6, found);
    superpose(w, coarse);
    superpose(w * M_SQRT1_2, fine);
    const double first = difference(coarse, found), second = difference(fine, found);
    /* the parts' own widths squared, 1/(1/sigma^2 + 1/w^2), are what the error goes with */
    const double square = gaussian.width * gaussian.width, ratio = (2 * square + w * w) / (square + w * w);
    for (int i = 0; i < 6 * ROWS * PLACES; i++)
        fine[i] = (ratio * fine[i] - coarse[i]) / (ratio - 1);
    const double last = difference(fine, found);
    print_message("superposition: %.2g and %.2g apart, extrapolated %.2g\n", first, second, last);
    assert_near(first / second, ratio, .05);
    assert_true(last < .05 * second);
    assert_true(last < 1e-3);
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

static void fast_and_kinked_patches_are_refused(void **state)
{
    (void)state;
    const struct history triangle = {.kind = HISTORY_TRIANGLE, .duration = 1};
    const struct lamb_problem problem = ground(NULL);
    const struct moving_patch patch[2] = {
        {{{PATCH_RECTANGLE, {0, 0}, {.5, .5}}, {0, 0, 1}, &gaussian}, {.95, 0}},
        {{{PATCH_RECTANGLE, {0, 0}, {.5, .5}}, {0, 0, 1}, &triangle}, {.1, 0}}};
    for (int i = 0; i < 2; i++) {
        struct lamb_signal signal = {.position = {1, 0, 0}};
        struct messages messages = {0};
        assert_int_equal(lamb_moving(&problem, 1, &patch[i], 2, 1, &signal, &messages), SELAS_BAD_SCENE);
        assert_null(signal.value);
        messages_free(&messages);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(without_velocity_it_rests),
        cmocka_unit_test(short_resting_loads_make_a_moving_one),
        cmocka_unit_test(patches_shift_and_add),
        cmocka_unit_test(fast_and_kinked_patches_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
