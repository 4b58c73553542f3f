/* The library's door: building by calls, driving, reading, wrong calls, many simulations, two threads. The
 * Fortran twin is regress/hosts/twins.f90. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "selas.h"

#include <math.h>
#include <omp.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static const char scene[] =
    "&scene dimension = 3, end_time = 2.0 /\n"
    "&method degree = 2 /\n"
    "&material name = 'rock', density = 1, lambda = 1, mu = 1 /\n"
    "&body material = 'rock', shape = 'box', low = 0, 0, 0, high = 4, 4, 4, spacing = 1 /\n"
    "&boundary face = 'x-', 'x+', 'y-', 'y+', 'z+', kind = 'transmitting' /\n"
    "&load name = 'hammer', face = 'z-', shape = 'square', centre = 2, 2, 0, size = 2, 2, direction = 0, 0, "
    "1\n"
    "  amplitude = 1, history = 'triangle', duration = 1 /\n"
    "&receiver name = 'r', position = 2, 2, 0 /\n";

static selas_simulation *open_scene(void)
{
    selas_simulation *simulation = NULL;
    const selas_status status = selas_open_text("test-api", scene, &simulation);
    if (status != SELAS_OK) fail_msg("%s", selas_message(simulation));
    return simulation;
}

struct push {
    int answer;
    unsigned long calls;
    double last;
    bool in_order, not_finite;
};

/* The deck's own triangle. */
static int triangle(void *context, double time, const double position[3], double value[3])
{
    struct push *push = context;
    (void)position;
    push->in_order = (push->calls == 0 || time >= push->last) && (push->calls > 0 || time == 0.0);
    push->calls++;
    push->last = time;
    value[2] = time <= 0 || time >= 1 ? 0 : 1 - fabs(2 * time - 1);
    if (push->not_finite) value[1] = (double)NAN;
    return push->answer;
}

static double end_displacement(selas_simulation *simulation)
{
    double value[3];
    assert_int_equal(selas_advance(simulation, 2.0), SELAS_OK);
    assert_int_equal(selas_receiver(simulation, "r", SELAS_DISPLACEMENT, value), SELAS_OK);
    return value[2];
}

/* A traction by function, and a load held at a value at each step, are the deck's own load. The held value
 * reaches the acceleration of its own step, so with leapfrog nothing but rounding differs. */
static void test_driven_loads(void **state)
{
    (void)state;
    const char *const leapfrog[1] = {"leapfrog"};
    double answer[3];
    for (int mode = 0; mode < 3; mode++) {
        selas_simulation *simulation = open_scene();
        struct push push = {0};
        assert_int_equal(selas_set_text(simulation, "stepping%scheme", 1, leapfrog), SELAS_OK);
        assert_int_equal(selas_set_logical(simulation, "stepping%unwarp", false), SELAS_OK);
        if (mode == 1) assert_int_equal(selas_set_traction(simulation, "hammer", triangle, &push), SELAS_OK);
        if (mode == 2) assert_int_equal(selas_set_load(simulation, "hammer", 0.0), SELAS_OK);
        const double dt = selas_time_step(simulation);
        for (int i = 0; mode == 2 && i * dt < 2.0; i++) {
            double value[3] = {0};
            triangle(&push, selas_time(simulation), value, value);
            assert_int_equal(selas_set_load(simulation, "hammer", value[2]), SELAS_OK);
            assert_int_equal(selas_step(simulation, 1), SELAS_OK);
        }
        answer[mode] = end_displacement(simulation);
        if (mode == 1) assert_true(push.in_order && push.calls > 10);
        selas_close(&simulation);
    }
    assert_true(fabs(answer[0]) > 1e-3);
    assert_true(fabs(answer[1] - answer[0]) < 1e-12 * fabs(answer[0]));
    assert_true(fabs(answer[2] - answer[0]) < 1e-12 * fabs(answer[0]));
}

/* Leapfrog's velocity is the central difference of its displacements, also in the mean; and as long as no
 * wave has reached an absorbing face, a constant force on the patch has done the work force times mean
 * displacement, which is the body's energy. */
static void test_mean(void **state)
{
    (void)state;
    selas_simulation *simulation = open_scene();
    const char *const leapfrog[1] = {"leapfrog"};
    double displacement[3] = {0}, velocity, kinetic, strain;
    assert_int_equal(selas_set_text(simulation, "stepping%scheme", 1, leapfrog), SELAS_OK);
    assert_int_equal(selas_set_real(simulation, "stepping%safety", 1, &(double){0.1}), SELAS_OK);
    assert_int_equal(selas_set_load(simulation, "hammer", 3.0), SELAS_OK);
    assert_int_equal(selas_advance(simulation, 0.4), SELAS_OK);
    const double dt = selas_time_step(simulation);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(selas_load_mean(simulation, "hammer", SELAS_DISPLACEMENT, &displacement[i]),
                         SELAS_OK);
        if (i == 1)
            assert_int_equal(selas_load_mean(simulation, "hammer", SELAS_VELOCITY, &velocity), SELAS_OK);
        if (i < 2) assert_int_equal(selas_step(simulation, 1), SELAS_OK);
    }
    assert_true(fabs(velocity - (displacement[2] - displacement[0]) / (2 * dt)) < 1e-11 * fabs(velocity));
    assert_int_equal(selas_energy(simulation, &kinetic, &strain), SELAS_OK);
    const double work = 3.0 * 4.0 * displacement[2];
    assert_true(fabs(kinetic + strain - work) < 0.01 * work);
    selas_close(&simulation);
}

static void test_callback_answers(void **state)
{
    (void)state;
    selas_simulation *simulation = open_scene();
    struct push push = {0};
    assert_int_equal(selas_set_traction(simulation, "hammer", triangle, &push), SELAS_OK);
    assert_int_equal(selas_step(simulation, 3), SELAS_OK);
    push.answer = 7;
    assert_int_equal(selas_step(simulation, 3), SELAS_STOPPED);
    assert_int_equal(selas_steps(simulation), 4);
    push.answer = 0;
    assert_int_equal(selas_step(simulation, 1), SELAS_OK);
    push.not_finite = true;
    assert_int_equal(selas_step(simulation, 1), SELAS_CALLBACK_FAILED);
    assert_non_null(strstr(selas_message(simulation), "hammer"));
    push.not_finite = false;
    assert_int_equal(selas_step(simulation, 1), SELAS_CALLBACK_FAILED);
    selas_close(&simulation);
    assert_null(simulation);
}

static int meddle(void *context, double time, const double position[3], double value[3])
{
    selas_simulation *simulation = *(selas_simulation **)context;
    (void)time;
    (void)position;
    const selas_status status = selas_step(simulation, 1);
    selas_close((selas_simulation **)context);
    value[0] = 0;
    return status == SELAS_BAD_ARGUMENT && *(selas_simulation **)context != NULL ? 0 : -1;
}

static void test_callback_must_not_call_back(void **state)
{
    (void)state;
    selas_simulation *simulation = open_scene();
    assert_int_equal(selas_set_traction(simulation, "hammer", meddle, &simulation), SELAS_OK);
    assert_int_equal(selas_step(simulation, 2), SELAS_OK);
    selas_close(&simulation);
}

/* --- Wrong calls
 * ---------------------------------------------------------------------------------------------------- */

static unsigned long wrong_calls;
static char before[1 << 16]; /* messages of the handle in use */

/* Each must give a status that is no success, and a message where there is a handle to keep it. */
static void wrong(selas_simulation *simulation, selas_status status)
{
    wrong_calls++;
    if (status == SELAS_OK) fail_msg("wrong call %lu was taken for right", wrong_calls);
    assert_true(strlen(selas_message(simulation)) > 0);
    if (simulation != NULL && strcmp(before, selas_message(simulation)) == 0)
        fail_msg("wrong call %lu left no message", wrong_calls);
    snprintf(before, sizeof before, "%s", selas_message(simulation));
}

static void tell(void *context, const char *key, const char *value)
{
    (void)context;
    (void)key;
    (void)value;
}

/* The same for a handle that has only just been made. */
static void wrong_open(selas_simulation **simulation, selas_status status)
{
    before[0] = '\0';
    wrong(*simulation, status);
}

/* Every function, with the handle given and else good arguments. */
static void call_all(selas_simulation *s)
{
    double value[6];
    const double *values;
    size_t count;
    struct push push = {0};
    const char *const text[1] = {"x"};
    const double one = 1;
    wrong(s, selas_advance(s, 1));
    wrong(s, selas_step(s, 1));
    wrong(s, selas_receiver(s, "r", SELAS_VELOCITY, value));
    wrong(s, selas_finish(s));
    wrong(s, selas_history(s, "r", &count, &values, &values));
    wrong(s, selas_record(s));
    wrong(s, selas_write(s));
    wrong(s, selas_write_exact(s));
    wrong(s, selas_plan(s, tell, NULL));
    wrong(s, selas_build(s));
    wrong(s, selas_add(s, "load", &count));
    wrong(s, selas_set_real(s, "body%spacing", 1, &one));
    wrong(s, selas_set_integer(s, "method%degree", 2));
    wrong(s, selas_set_logical(s, "output%plots", true));
    wrong(s, selas_set_text(s, "scene%title", 1, text));
    wrong(s, selas_set_points(s, 1, value, value, NULL));
    wrong(s, selas_set_traction(s, "hammer", triangle, &push));
    wrong(s, selas_set_body_force(s, "hammer", triangle, &push));
    wrong(s, selas_set_motion(s, "x-", triangle, &push));
    wrong(s, selas_set_load(s, "hammer", 1));
    wrong(s, selas_load_mean(s, "hammer", SELAS_VELOCITY, value));
    wrong(s, selas_points(s, &count, &values));
    wrong(s, selas_field_values(s, SELAS_VELOCITY, &count, &count, &values));
    wrong(s, selas_energy(s, value, value));
    wrong(s, selas_save(s, "checkpoint"));
    wrong(s, selas_restore(s, "checkpoint"));
    assert_true(selas_steps_needed(s) == 0 && selas_time_step(s) == 0.0);
    assert_true(isnan(selas_end_time(s)));
    assert_string_equal(selas_output_directory(s), "");
}

static void test_wrong_handles(void **state)
{
    (void)state;
    selas_simulation *simulation = NULL;
    call_all(NULL);
    wrong(NULL, selas_open_deck("x", NULL));
    wrong(NULL, selas_open_text("x", "y", NULL));
    wrong(NULL, selas_open_new("x", NULL));
    const char *const override[2] = {"body%spacing", NULL};
    const char *const texts[6] = {"",           "&scene",   "&scene dimension = 5 /",
                                  "&nothing /", "\xff\xfe", "&body /"};
    for (int i = 0; i < 6; i++) {
        wrong_open(&simulation, selas_open_text("wrong", texts[i], &simulation));
        if (i < 2) call_all(simulation);
        selas_close(&simulation);
        assert_null(simulation);
    }
    wrong_open(&simulation, selas_open_text(NULL, scene, &simulation));
    selas_close(&simulation);
    wrong_open(&simulation, selas_open_text("x", NULL, &simulation));
    selas_close(&simulation);
    wrong_open(&simulation, selas_open_deck(NULL, &simulation));
    selas_close(&simulation);
    wrong_open(&simulation, selas_open_deck("/no/such/deck.nml", &simulation));
    selas_close(&simulation);
    wrong_open(&simulation, selas_open_deck("/", &simulation));
    selas_close(&simulation);
    wrong_open(&simulation, selas_open_deck_with("input/bar.nml", 1, NULL, &simulation));
    selas_close(&simulation);
    wrong_open(&simulation, selas_open_deck_with("input/bar.nml", 1, override, &simulation));
    selas_close(&simulation);
    wrong_open(&simulation, selas_open_new(NULL, &simulation));
    call_all(simulation);
    selas_close(&simulation);
    wrong_open(&simulation, selas_open_new("", &simulation));
    selas_close(&simulation);
    selas_close(&simulation);
    selas_close(NULL);
}

static void test_wrong_words(void **state)
{
    (void)state;
    selas_simulation *s = open_scene();
    const double many[40] = {0}, bad[3] = {(double)NAN, INFINITY, -INFINITY}, one = 1;
    const char *const words[10] = {"",
                                   "body",
                                   "%spacing",
                                   "body%",
                                   "boddy%spacing",
                                   "body%spacng",
                                   "body(2)%spacing",
                                   "load(0)%amplitude",
                                   "load(-1)%amplitude",
                                   "body%spacing=3 body%x"};
    const char *const text[2] = {"x", NULL}, *const nobody[1] = {NULL};
    size_t number;
    for (int i = 0; i < 10; i++) {
        wrong(s, selas_set_real(s, words[i], 1, &one));
        wrong(s, selas_set_text(s, words[i], 1, text));
        wrong(s, selas_set_integer(s, words[i], 1));
        wrong(s, selas_set_logical(s, words[i], false));
    }
    for (int i = 0; i < 3; i++)
        wrong(s, selas_set_real(s, "body%spacing", 1, &bad[i]));
    wrong(s, selas_set_real(s, NULL, 1, &one));
    wrong(s, selas_set_real(s, "body%spacing", 0, &one));
    wrong(s, selas_set_real(s, "body%spacing", 1, NULL));
    wrong(s, selas_set_real(s, "body%low", 40, many));
    wrong(s, selas_set_text(s, "body%spacing", 1, text));
    wrong(s, selas_set_text(s, "scene%title", 2, text));
    wrong(s, selas_set_text(s, "scene%title", 1, nobody));
    wrong(s, selas_set_text(s, "scene%title", 1, NULL));
    wrong(s, selas_set_real(s, "method%degree", 1, &(double){1.5}));
    wrong(s, selas_set_logical(s, "scene%end_time", true));
    wrong(s, selas_add(s, "lode", &number));
    wrong(s, selas_add(s, "body", &number));
    wrong(s, selas_add(s, "scene", &number));
    wrong(s, selas_add(s, NULL, &number));
    wrong(s, selas_add(s, "load", NULL));
    wrong(s, selas_set_points(s, 0, many, many, NULL));
    wrong(s, selas_set_points(s, 1, NULL, many, NULL));
    wrong(s, selas_set_points(s, 1, many, NULL, NULL));
    wrong(s, selas_set_points(s, 1, many, many, NULL)); /* no volume */
    wrong(s, selas_set_points(s, 1, bad, &one, NULL));
    wrong(s, selas_set_points(s, 1, many, &one, &(size_t){2}));
    wrong(s, selas_set_points(s, 1, many, &one, &(size_t){0}));
    wrong(s, selas_set_points(s, SIZE_MAX / 2, many, &one, NULL));
    /* a value out of its range is found when the scene is used, and can be mended */
    assert_int_equal(selas_set_real(s, "body%spacing", 1, &(double){-1}), SELAS_OK);
    wrong(s, selas_build(s));
    wrong(s, selas_step(s, 1));
    wrong(s, selas_build(s));
    assert_int_equal(selas_set_real(s, "body%spacing", 1, &one), SELAS_OK);
    wrong(s, selas_build(s)); /* what was set wrongly above counts as not set */
    assert_int_equal(selas_set_real(s, "body%low", 3, many), SELAS_OK);
    assert_int_equal(selas_set_real(s, "scene%end_time", 1, &one), SELAS_OK);
    if (selas_build(s) != SELAS_OK) fail_msg("%s", selas_message(s));
    assert_int_equal(selas_step(s, 1), SELAS_OK);
    selas_close(&s);
}

static void test_wrong_calls(void **state)
{
    (void)state;
    selas_simulation *s = open_scene();
    struct push push = {0};
    double value[6];
    const double *values;
    size_t count;
    const char *const names[4] = {"", "R", "hamm",
                                  "nobody in particular, but with a name that goes on and on and on and on"};
    const selas_field fields[3] = {(selas_field)-1, (selas_field)7, (selas_field)1000};
    for (int i = 0; i < 4; i++) {
        wrong(s, selas_receiver(s, names[i], SELAS_VELOCITY, value));
        wrong(s, selas_set_traction(s, names[i], triangle, &push));
        wrong(s, selas_set_body_force(s, names[i], triangle, &push));
        wrong(s, selas_set_motion(s, names[i], triangle, &push));
        wrong(s, selas_set_load(s, names[i], 1));
        wrong(s, selas_load_mean(s, names[i], SELAS_VELOCITY, value));
    }
    for (int i = 0; i < 3; i++) {
        wrong(s, selas_receiver(s, "r", fields[i], value));
        wrong(s, selas_field_values(s, fields[i], &count, &count, &values));
        wrong(s, selas_load_mean(s, "hammer", fields[i], value));
    }
    wrong(s, selas_receiver(s, NULL, SELAS_VELOCITY, value));
    wrong(s, selas_receiver(s, "r", SELAS_VELOCITY, NULL));
    wrong(s, selas_set_traction(s, NULL, triangle, &push));
    wrong(s, selas_set_traction(s, "hammer", NULL, &push));
    wrong(s, selas_set_body_force(s, "hammer", triangle, &push)); /* a traction */
    wrong(s, selas_set_motion(s, "z+", triangle, &push));         /* a transmitting face */
    wrong(s, selas_set_motion(s, "z+", NULL, &push));
    wrong(s, selas_set_load(s, "hammer", (double)NAN));
    wrong(s, selas_set_load(s, "hammer", INFINITY));
    wrong(s, selas_load_mean(s, "hammer", SELAS_STRESS, value));
    wrong(s, selas_load_mean(s, "hammer", SELAS_VELOCITY, NULL));
    wrong(s, selas_points(s, NULL, &values));
    wrong(s, selas_points(s, &count, NULL));
    wrong(s, selas_field_values(s, SELAS_VELOCITY, NULL, &count, &values));
    wrong(s, selas_field_values(s, SELAS_VELOCITY, &count, NULL, &values));
    wrong(s, selas_field_values(s, SELAS_VELOCITY, &count, &count, NULL));
    wrong(s, selas_energy(s, NULL, value));
    wrong(s, selas_energy(s, value, NULL));
    wrong(s, selas_plan(s, NULL, NULL));
    wrong(s, selas_advance(s, (double)NAN));
    wrong(s, selas_advance(s, INFINITY));
    wrong(s, selas_advance(s, 1e300));
    wrong(s, selas_write(s)); /* nothing was recorded */
    wrong(s, selas_write_exact(s));
    wrong(s, selas_history(s, "r", &count, &values, &values));
    assert_int_equal(selas_step(s, 1), SELAS_OK);
    wrong(s, selas_record(s));
    wrong(s, selas_set_load(s, "hammer", 1)); /* too late for the first time */
    wrong(s, selas_set_traction(s, "hammer", triangle, &push));
    assert_int_equal(selas_finish(s), SELAS_OK);
    wrong(s, selas_history(s, "r", NULL, &values, &values));
    wrong(s, selas_history(s, "r", &count, NULL, &values));
    wrong(s, selas_history(s, "r", &count, &values, NULL));
    wrong(s, selas_history(s, "q", &count, &values, &values));
    wrong(s, selas_history(s, NULL, &count, &values, &values));
    wrong(s, selas_step(s, 1));
    wrong(s, selas_advance(s, 1e3));
    wrong(s, selas_set_load(s, "hammer", 1));
    selas_close(&s);
    assert_true(wrong_calls >= 200);
}

/* --- Checkpoints
 * ---------------------------------------------------------------------------------------------------- */

/* Saved half way and gone on in another simulation: the same bits as without a stop, by each family of
 * schemes. */
static void test_checkpoint(void **state)
{
    (void)state;
    static const char *const scheme[4] = {"leapfrog", "modified-equation", "rk4", "lsrk54"};
    char path[] = "/tmp/selas-checkpoint-XXXXXX";
    const int file = mkstemp(path);
    assert_true(file >= 0);
    close(file);
    for (int i = 0; i < 4; i++) {
        selas_simulation *whole = open_scene(), *first = open_scene(), *second = open_scene();
        selas_simulation *const all[3] = {whole, first, second};
        const double *time = NULL, *value = NULL, *other = NULL;
        size_t rows = 0, other_rows = 0;
        for (int k = 0; k < 3; k++)
            assert_int_equal(selas_set_text(all[k], "stepping%scheme", 1, &scheme[i]), SELAS_OK);
        assert_int_equal(selas_step(first, 4), SELAS_OK);
        assert_int_equal(selas_save(first, path), SELAS_OK);
        assert_int_equal(selas_restore(second, path), SELAS_OK);
        assert_true(selas_steps(second) == 4 && selas_time(second) == selas_time(first));
        assert_int_equal(selas_finish(whole), SELAS_OK);
        assert_int_equal(selas_finish(second), SELAS_OK);
        assert_int_equal(selas_history(whole, "r", &rows, &time, &value), SELAS_OK);
        assert_int_equal(selas_history(second, "r", &other_rows, &time, &other), SELAS_OK);
        assert_true(rows == other_rows && rows > 4);
        assert_memory_equal(value, other, 6 * rows * sizeof *value);
        wrong_open(&second, selas_save(second, path)); /* finished */
        for (int k = 0; k < 3; k++)
            selas_close(&(selas_simulation *){all[k]});
    }
    selas_simulation *simulation = open_scene();
    wrong_open(&simulation, selas_save(simulation, "/no/such/folder/checkpoint"));
    wrong(simulation, selas_save(simulation, NULL));
    wrong(simulation, selas_restore(simulation, path)); /* another scene: lsrk54 */
    wrong(simulation, selas_step(simulation, 1));
    selas_close(&simulation);
    assert_int_equal(truncate(path, 3000), 0);
    simulation = open_scene();
    wrong_open(&simulation, selas_restore(simulation, path));
    selas_close(&simulation);
    remove(path);
}

/* --- Many simulations
 * ----------------------------------------------------------------------------------------------- */

static long resident_pages(void)
{
    long size = 0, resident = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (file == NULL || fscanf(file, "%ld %ld", &size, &resident) != 2) resident = 0;
    if (file != NULL) fclose(file);
    return resident;
}

static void test_no_growth(void **state)
{
    (void)state;
    long settled = 0;
    for (int i = 0; i < 1000; i++) {
        selas_simulation *simulation = open_scene();
        if (i % 10 == 0) assert_int_equal(selas_step(simulation, 2), SELAS_OK);
        selas_close(&simulation);
        if (i == 200) settled = resident_pages();
    }
    assert_true(settled > 0);
    assert_true((resident_pages() - settled) * sysconf(_SC_PAGESIZE) < 1 << 20);
}

static void *run_one(void *answer)
{
    selas_simulation *simulation = NULL;
    double *value = answer;
    value[6] = selas_open_text("thread", scene, &simulation) == SELAS_OK ? 1 : 0;
    size_t rows = 0;
    const double *time = NULL, *values = NULL;
    if (selas_finish(simulation) != SELAS_OK ||
        selas_history(simulation, "r", &rows, &time, &values) != SELAS_OK)
        value[6] = 0;
    if (rows > 0) memcpy(value, values + 6 * (rows - 1), 6 * sizeof *value);
    selas_close(&simulation);
    return NULL;
}

static void test_two_threads(void **state)
{
    (void)state;
    double alone[7] = {0}, beside[2][7] = {{0}};
    pthread_t thread[2] = {0};
    run_one(alone);
    assert_true(alone[6] == 1 && fabs(alone[2]) > 0);
    for (int round = 0; round < 5; round++) {
        for (int i = 0; i < 2; i++)
            if (pthread_create(&thread[i], NULL, run_one, beside[i]) != 0) abort();
        for (int i = 0; i < 2; i++) {
            pthread_join(thread[i], NULL);
            assert_memory_equal(beside[i], alone, sizeof alone);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_driven_loads),     cmocka_unit_test(test_mean),
        cmocka_unit_test(test_callback_answers), cmocka_unit_test(test_callback_must_not_call_back),
        cmocka_unit_test(test_wrong_handles),    cmocka_unit_test(test_wrong_words),
        cmocka_unit_test(test_wrong_calls),      cmocka_unit_test(test_checkpoint),
        cmocka_unit_test(test_no_growth),        cmocka_unit_test(test_two_threads),
    };
    omp_set_num_threads(1);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
