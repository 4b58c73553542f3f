/* Receivers, profiles, the low-pass and the watch, on a model whose states are known functions. */
#include "fake_model.h"
#include "record/parts.h"

#include <unistd.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

static const size_t line[3] = {9, 1, 1};

static int syncs;

/* In the place of the system's. */
int fsync(int file)
{
    (void)file;
    syncs++;
    return 0;
}

static int reset(void **state)
{
    (void)state;
    fake_gain = 1.0;
    fake_growth = 0.0;
    return 0;
}

/* Largest error of the finished rows of a receiver at x = 0.5, relative to the largest value. */
static double history_error(double dt, double history_step, size_t *rows)
{
    struct fake fake;
    fake_build(&fake, 3, line, 0.25, dt, 6.0);
    fake.scene.receivers = 1;
    fake.receiver[0] = (struct receiver){"middle", {0.5, 0.0, 0.0}};
    fake.scene.output.history_step = history_step;
    struct messages messages = {0};
    struct recorder *recorder = NULL;
    assert_int_equal(recorder_create(&fake.scene, &fake.model, &fake.stepper, &recorder, &messages),
                     SELAS_OK);
    assert_int_equal(fake_run(&fake, recorder, &messages), SELAS_OK);
    assert_int_equal(recorder_finish(recorder, &messages), SELAS_OK);
    const struct history_rows history = recorder_history(recorder, 0);
    double error = 0.0, largest = 0.0;
    syncs = 0; /* what run.h5 has, too, costs no sync of the disk for each receiver */
    assert_int_equal(histories_write(recorder, &messages), SELAS_OK);
    assert_int_equal(syncs, 0);
    for (size_t i = 0; i < history.rows; i++)
        for (int k = 0; k < 6; k++) {
            const double truth = fake_truth(fake.receiver[0].position, k % 3, history.time[i], k / 3);
            error = fmax(error, fabs(history.value[6 * i + (size_t)k] - truth));
            largest = fmax(largest, fabs(truth));
        }
    assert_true(history.time[history.rows - 1] <= 6.0 + 1e-9);
    *rows = history.rows;
    recorder_free(&recorder);
    fake_clear(&fake);
    assert_null(messages.text);
    return error / largest;
}

static void rows_on_steps_are_exact(void **state)
{
    (void)state;
    size_t rows = 0;
    assert_true(history_error(0.1, 0.0, &rows) < 1e-14);
    assert_int_equal(rows, 61);
    assert_true(history_error(0.1, 0.2, &rows) < 1e-14);
    assert_int_equal(rows, 31);
}

/* Cubic Hermite: the error falls as dt^4. */
static void rows_between_steps(void **state)
{
    (void)state;
    size_t rows = 0;
    const double coarse = history_error(0.2, 0.07, &rows);
    assert_int_equal(rows, 86);
    const double fine = history_error(0.1, 0.07, &rows);
    assert_true(coarse < 2e-3);
    const double order = log2(coarse / fine);
    print_message("# interpolated rows: order %.2f, error %.2e at dt = 0.1\n", order, fine);
    assert_true(order > 3.5);
}

/* Largest error of a profile at each of the times. */
static void profile_errors(double dt, double end, size_t times, double *time, double *error)
{
    struct fake fake;
    fake_build(&fake, 3, line, 0.25, dt, end);
    fake.scene.profiles = 1;
    fake.profile = (struct profile){.name = "line",
                                    .to = {2.0, 0.0, 0.0},
                                    .points = 9,
                                    .times = times,
                                    .time = time,
                                    .fields = 1U << SELAS_DISPLACEMENT | 1U << SELAS_VELOCITY};
    struct messages messages = {0};
    struct recorder *recorder = NULL;
    assert_int_equal(recorder_create(&fake.scene, &fake.model, &fake.stepper, &recorder, &messages),
                     SELAS_OK);
    assert_int_equal(fake_run(&fake, recorder, &messages), SELAS_OK);
    assert_int_equal(profile_write(recorder, &messages), SELAS_OK);
    assert_null(messages.text);
    char path[128], text[512];
    snprintf(path, sizeof path, "%s/line.dat", fake.folder);
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    size_t rows = 0;
    while (fgets(text, sizeof text, file) != NULL) {
        double s, x[3], value[6];
        if (sscanf(text, "%lf %lf %lf %lf %lf %lf %lf %lf %lf %lf", &s, x, x + 1, x + 2, value, value + 1,
                   value + 2, value + 3, value + 4, value + 5) != 10)
            continue;
        assert_true(fabs(s - x[0]) < 1e-14);
        assert_true(rows / 9 < times);
        if (rows % 9 == 0) error[rows / 9] = 0.0;
        for (int c = 0; c < 6; c++) {
            const double away = fabs(value[c] - fake_truth(x, c % 3, time[rows / 9], c / 3));
            error[rows / 9] = fmax(error[rows / 9], away);
        }
        rows++;
    }
    fclose(file);
    assert_int_equal(rows, 9 * times);
    recorder_free(&recorder);
    fake_clear(&fake);
}

static void profile_between_steps(void **state)
{
    (void)state;
    double error[2][3], time[3] = {2.43, 4.0, 6.0};
    for (int k = 0; k < 2; k++) {
        profile_errors(k == 0 ? 0.2 : 0.1, 6.0, 3, time, error[k]);
        assert_true(fmax(error[k][1], error[k][2]) < 1e-12); /* times of steps */
    }
    print_message("# profile between steps: errors %.2e, %.2e\n", error[0][0], error[1][0]);
    assert_true(log2(error[0][0] / error[1][0]) > 3.0);
}

/* A run of one step or two has fewer than the cubic wants: at its steps the values are theirs. */
static void profile_of_few_steps(void **state)
{
    (void)state;
    for (int steps = 1; steps <= 2; steps++) {
        double time[2] = {0.0, 0.1 * steps}, error[2];
        profile_errors(0.1, 0.1 * steps, 2, time, error);
        assert_true(fmax(error[0], error[1]) < 1e-12);
    }
}

enum { ROWS = 4000 };

/* A tone of frequency omega well inside the record keeps its phase and is multiplied by exp(-(omega/wc)^4).
 */
static void low_pass_of_tones(void **state)
{
    (void)state;
    static double series[2 * ROWS];
    const double dt = 0.05, cutoff = 4.0;
    for (int k = 1; k <= 6; k++) {
        const double omega = k;
        for (int i = 0; i < ROWS; i++) {
            series[2 * i] = sin(omega * dt * i);
            series[2 * i + 1] = 2.5; /* a constant stays */
        }
        struct messages messages = {0};
        assert_int_equal(low_pass(dt, cutoff, false, ROWS, 2, series, &messages), SELAS_OK);
        const double factor = exp(-pow(omega / cutoff, 4.0));
        for (int i = 500; i < ROWS - 500; i++)
            assert_true(fabs(series[2 * i] - factor * sin(omega * dt * i)) < 1e-9);
        for (int i = 0; i < ROWS; i++)
            assert_true(fabs(series[2 * i + 1] - 2.5) < 1e-9);
    }
}

/* A slow pulse from rest passes unharmed, up to both ends of the record. */
static void low_pass_of_a_slow_pulse(void **state)
{
    (void)state;
    static double series[ROWS];
    const double dt = 0.01;
    for (int i = 0; i < ROWS; i++)
        series[i] = exp(-pow((dt * i - 15.0) / 3.0, 2.0)) + 0.5 * (1.0 + tanh((dt * i - 20.0) / 3.0));
    static double before[ROWS];
    memcpy(before, series, sizeof series);
    struct messages messages = {0};
    assert_int_equal(low_pass(dt, 40.0, true, ROWS, 1, series, &messages), SELAS_OK);
    for (int i = 0; i < ROWS; i++)
        assert_true(fabs(series[i] - before[i]) < 1e-5);
}

static void low_passed_history(void **state)
{
    (void)state;
    struct fake fake;
    fake_build(&fake, 3, line, 0.25, 0.05, 40.0);
    fake.scene.receivers = 1;
    fake.receiver[0] = (struct receiver){"middle", {0.5, 0.0, 0.0}};
    fake.scene.output.low_pass = 1.0;
    struct messages messages = {0};
    struct recorder *recorder = NULL;
    assert_int_equal(recorder_create(&fake.scene, &fake.model, &fake.stepper, &recorder, &messages),
                     SELAS_OK);
    assert_int_equal(fake_run(&fake, recorder, &messages), SELAS_OK);
    assert_int_equal(recorder_finish(recorder, &messages), SELAS_OK);
    /* the spectrum of g' is i omega 720 / (1 + i omega)^7: the filtered history by quadrature */
    const struct history_rows history = recorder_history(recorder, 0);
    double worst = 0.0, largest = 0.0;
    for (size_t i = 20; history.time[i] < 16.0; i += 40) {
        const double t = history.time[i] - 0.5 / fake_speed;
        double value = 0.0;
        const int steps = 4000;
        const double d = 4.0 / steps;
        for (int k = 0; k < steps; k++) {
            const double omega = ((double)k + 0.5) * d;
            const double angle = omega * t - 7.0 * atan(omega) + 0.5 * 3.14159265358979;
            value += 720.0 * omega * pow(1.0 + omega * omega, -3.5) * cos(angle) * exp(-pow(omega, 4.0)) * d /
                     3.14159265358979;
        }
        worst = fmax(worst, fabs(history.value[6 * i + 3] - value));
        largest = fmax(largest, fabs(value));
    }
    print_message("# low-passed history: error %.1e of %.1e\n", worst, largest);
    assert_true(worst < 1e-9 * largest);
    recorder_free(&recorder);
    fake_clear(&fake);
}

static selas_status watched_run(double growth, bool nan, struct messages *messages)
{
    struct fake fake;
    fake_build(&fake, 3, line, 0.25, 0.01, 40.0);
    fake.scene.receivers = 1;
    fake.receiver[0] = (struct receiver){"middle", {0.5, 0.0, 0.0}};
    fake_growth = growth;
    struct recorder *recorder = NULL;
    assert_int_equal(recorder_create(&fake.scene, &fake.model, &fake.stepper, &recorder, messages), SELAS_OK);
    selas_status status = SELAS_OK;
    for (unsigned long step = 0; step <= 4000 && status == SELAS_OK; step++) {
        fake_state(&fake.model, &fake.state, 0.01, step);
        if (nan && step >= 1210) fake.state.y[3 * 7 + 1] = NAN; /* not where the receiver is */
        status = recorder_observe(recorder, &fake.state, messages);
        if (nan && status != SELAS_OK) assert_true(step < 1210 + 100);
    }
    recorder_free(&recorder);
    fake_clear(&fake);
    return status;
}

static void quiet_run_is_left_alone(void **state)
{
    (void)state;
    struct messages messages = {0};
    assert_int_equal(watched_run(0.0, false, &messages), SELAS_OK);
    assert_null(messages.text);
}

static void growth_is_found(void **state)
{
    (void)state;
    struct messages messages = {0};
    assert_int_equal(watched_run(1.5, false, &messages), SELAS_UNSTABLE);
    assert_non_null(strstr(messages.text, "went unstable at t = "));
    double time = 0.0, x[3] = {0};
    assert_int_equal(sscanf(strstr(messages.text, "t = "), "t = %lf", &time), 1);
    assert_int_equal(
        sscanf(strstr(messages.text, "fastest at"), "fastest at (%lf, %lf, %lf)", x, x + 1, x + 2), 3);
    const double there = fabs(fake_truth(x, 2, time, 1));
    for (size_t i = 0; i < line[0]; i++) {
        const double other[3] = {0.25 * (double)i, 0.0, 0.0};
        assert_true(fabs(fake_truth(other, 2, time, 1)) <= there * (1.0 + 1e-6));
    }
    messages_free(&messages);
}

static void nan_is_found(void **state)
{
    (void)state;
    struct messages messages = {0};
    assert_int_equal(watched_run(0.0, true, &messages), SELAS_UNSTABLE);
    assert_non_null(strstr(messages.text, "not finite"));
    messages_free(&messages);
}

/* Places that are no points of the body are named where they are the fastest. */
static double unseen_speed;

static void unseen(struct model *model, const double *y, struct unseen *found)
{
    (void)model;
    (void)y;
    *found = (struct unseen){.speed = unseen_speed, .place = "in the layer behind face x+, at (9, 8, 7)"};
}

/* An oscillator-like body that is pushed: the model tells 1 unit of power; its energy may not exceed that. */
static double energy_factor;

static void known_energy(struct model *model, const double *y, struct energy *energy)
{
    (void)model;
    *energy = (struct energy){.kinetic = energy_factor * y[0]};
}

static void known_power(struct model *model, const struct drive *drive, const double *y, double *load,
                        double *absorbed)
{
    (void)model;
    (void)y;
    *load = drive->time < 10.0 ? 1.0 : 0.0;
    *absorbed = drive->time < 10.0 ? 0.25 : 0.0;
}

static selas_status worked_run(double factor, struct recorder **recorder, struct fake *fake,
                               struct messages *messages)
{
    static struct model_core core;
    core = fake_core;
    core.energy = known_energy;
    core.power = known_power;
    core.unseen = unseen;
    energy_factor = factor;
    fake_build(fake, 3, line, 0.25, 0.01, 20.0);
    fake->model.core = &core;
    assert_int_equal(recorder_create(&fake->scene, &fake->model, &fake->stepper, recorder, messages),
                     SELAS_OK);
    selas_status status = SELAS_OK;
    for (unsigned long step = 0; step <= 2000 && status == SELAS_OK; step++) {
        fake_state(&fake->model, &fake->state, 0.01, step);
        fake->state.y[0] = fmin(fake->state.time, 10.0); /* the work so far */
        status = recorder_observe(*recorder, &fake->state, messages);
    }
    return status;
}

static void energy_against_work(void **state)
{
    (void)state;
    struct messages messages = {0};
    struct recorder *recorder = NULL;
    struct fake fake;
    assert_int_equal(worked_run(0.75, &recorder, &fake, &messages), SELAS_OK);
    assert_true(fabs(recorder->watch.work - 10.0) < 0.011); /* the jump at t = 10: half a step */
    assert_true(fabs(recorder->watch.absorbed - 2.5) < 0.003);
    assert_true(recorder->watch.largest_defect < 0.01);
    recorder_free(&recorder);
    fake_clear(&fake);
    for (int far = 0; far < 2; far++) {
        unseen_speed = far == 1 ? 1e6 : 0.0;
        assert_int_equal(worked_run(12.0, &recorder, &fake, &messages), SELAS_UNSTABLE);
        assert_non_null(strstr(messages.text, "but was given only"));
        assert_true(
            (strstr(messages.text, "fastest in the layer behind face x+, at (9, 8, 7), speed 1e+06") !=
             NULL) == (far == 1));
        messages_free(&messages);
        recorder_free(&recorder);
        fake_clear(&fake);
    }
}

static void steps_in_order(void **state)
{
    (void)state;
    struct fake fake;
    fake_build(&fake, 3, line, 0.25, 0.1, 1.0);
    struct messages messages = {0};
    struct recorder *recorder = NULL;
    assert_int_equal(recorder_create(&fake.scene, &fake.model, &fake.stepper, &recorder, &messages),
                     SELAS_OK);
    fake_state(&fake.model, &fake.state, 0.1, 0);
    assert_int_equal(recorder_observe(recorder, &fake.state, &messages), SELAS_OK);
    fake_state(&fake.model, &fake.state, 0.1, 2);
    assert_int_equal(recorder_observe(recorder, &fake.state, &messages), SELAS_BAD_ARGUMENT);
    messages_free(&messages);
    recorder_free(&recorder);
    fake_clear(&fake);
}

/* Seen through the method's own function where it has one. */
static void own_observe(struct model *model, const struct probe *probe, selas_field field, const double *y,
                        const double *a, double *value)
{
    probe_observe(model, probe, field, y, a, value);
    for (int c = 0; c < field_components(field); c++)
        value[c] = 7.0 - value[c];
}

static void own_observe_is_asked(void **state)
{
    (void)state;
    static struct model_core core;
    core = fake_core;
    core.observe = own_observe;
    struct fake fake;
    fake_build(&fake, 3, line, 0.25, 0.1, 1.0);
    fake.model.core = &core;
    fake.scene.receivers = 1;
    struct messages messages = {0};
    struct recorder *recorder = NULL;
    assert_int_equal(recorder_create(&fake.scene, &fake.model, &fake.stepper, &recorder, &messages),
                     SELAS_OK);
    assert_int_equal(fake_run(&fake, recorder, &messages), SELAS_OK);
    assert_int_equal(recorder_finish(recorder, &messages), SELAS_OK);
    const struct history_rows history = recorder_history(recorder, 0);
    const double origin[3] = {0.0, 0.0, 0.0};
    assert_true(fabs(history.value[6 * 10 + 5] - (7.0 - fake_truth(origin, 2, 1.0, 1))) < 1e-14);
    double value[6];
    recorder_value(recorder, 0, SELAS_VELOCITY, &fake.state, value);
    assert_true(fabs(value[2] - (7.0 - fake_truth(origin, 2, 1.1, 1))) < 1e-14);
    recorder_free(&recorder);
    fake_clear(&fake);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(rows_on_steps_are_exact, reset),
        cmocka_unit_test_setup(rows_between_steps, reset),
        cmocka_unit_test_setup(profile_between_steps, reset),
        cmocka_unit_test_setup(profile_of_few_steps, reset),
        cmocka_unit_test(low_pass_of_tones),
        cmocka_unit_test(low_pass_of_a_slow_pulse),
        cmocka_unit_test_setup(low_passed_history, reset),
        cmocka_unit_test_setup(quiet_run_is_left_alone, reset),
        cmocka_unit_test_setup(growth_is_found, reset),
        cmocka_unit_test_setup(nan_is_found, reset),
        cmocka_unit_test_setup(energy_against_work, reset),
        cmocka_unit_test_setup(steps_in_order, reset),
        cmocka_unit_test_setup(own_observe_is_asked, reset),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
