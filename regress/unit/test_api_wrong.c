/* More than 200 wrong calls of the library: each gives a status and a message, none a crash or a word on
 * standard output or standard error. `make check-leaks` runs them with LeakSanitizer and under valgrind. */
#include "api_scene.h"

#include <omp.h>
#include <stdlib.h>
#include <unistd.h>

static void tell(void *context, const char *key, const char *value)
{
    (void)context;
    (void)key;
    (void)value;
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
    wrong(s, selas_load_response(s, "hammer", "hammer", value));
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
    static const char *const holes[] = {"body%spacing=.5", NULL};
    wrong_open(&simulation, selas_open_deck_with("input/bar.nml", 2, holes, &simulation));
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

/* A warning of a scene that is built anew, as each call about its loads does, is said once. */
static void test_warnings_once(void **state)
{
    (void)state;
    static const char late[] = "&scene dimension = 2, end_time = 1 /\n"
                               "&material name = 'rock', density = 1, lambda = 1, mu = 1 /\n"
                               "&body material = 'rock', low = 0, 0, high = 2, 2, spacing = .25 /\n"
                               "&load name = 'a', face = 'y-', shape = 'face', direction = 0, 1, history = "
                               "'gaussian', width = 1, delay = 1 /\n";
    selas_simulation *simulation = NULL;
    assert_int_equal(selas_open_text("late", late, &simulation), SELAS_OK);
    for (int i = 0; i < 3; i++)
        assert_int_equal(selas_set_load(simulation, "a", 1), SELAS_OK);
    const char *first = strstr(selas_message(simulation), "cut at t = 0");
    assert_non_null(first);
    assert_null(strstr(first + 1, "cut at t = 0"));
    assert_int_equal(selas_energy(simulation, &(double){0}, &(double){0}), SELAS_OK);
    wrong(simulation, selas_record(simulation));
    selas_close(&simulation);
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
    wrong(s, selas_set_real(s, "body%low", (size_t)-1, many)); /* refused before they are read */
    wrong(s, selas_set_text(s, "scene%title", (size_t)-1, text));
    wrong(s, selas_set_text(s, "body%spacing", 1, text));
    wrong(s, selas_set_text(s, "scene%title", 2, text));
    wrong(s, selas_set_text(s, "scene%title", 1, nobody));
    wrong(s, selas_set_text(s, "scene%title", 1, NULL));
    wrong(s, selas_set_real(s, "method%degree", 1, &(double){1.5}));
    wrong(s, selas_set_logical(s, "scene%end_time", true));
    for (int i = 0; i < 2; i++) /* blanks as in an override; again in place of what it had */
        assert_int_equal(selas_set_real(s, " scene% end_time", 1, &(double){2}), SELAS_OK);
    wrong(s, selas_set_real(s, " body% spacing", 1, &(double){-1}));
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
    if (selas_build(s) != SELAS_OK) fail_msg("%s", selas_message(s));
    assert_int_equal(selas_step(s, 1), SELAS_OK);
    wrong(s, selas_step(s, (unsigned long)-3));
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
        wrong(s, selas_load_response(s, names[i], "hammer", value));
        wrong(s, selas_load_response(s, "hammer", names[i], value));
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
    wrong(s, selas_load_response(s, "hammer", "hammer", value)); /* not held */
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
    assert_true(wrong_calls >= 200); /* with those of the tests above */
}

/* A path for a checkpoint, to be removed. */
static void new_path(char path[40])
{
    snprintf(path, 40, "/tmp/selas-checkpoint-XXXXXX");
    const int file = mkstemp(path);
    assert_true(file >= 0);
    close(file);
}

static void test_wrong_checkpoints(void **state)
{
    (void)state;
    char path[40];
    const char *const scheme[1] = {"rk4"};
    new_path(path);
    selas_simulation *simulation = open_scene();
    wrong_open(&simulation, selas_restore(simulation, path)); /* an empty file */
    wrong(simulation, selas_step(simulation, 1));
    selas_close(&simulation);
    simulation = open_scene();
    assert_int_equal(selas_set_text(simulation, "stepping%scheme", 1, scheme), SELAS_OK);
    assert_int_equal(selas_save(simulation, path), SELAS_OK);
    selas_close(&simulation);
    simulation = open_scene();
    wrong_open(&simulation, selas_save(simulation, "/no/such/folder/checkpoint"));
    wrong(simulation, selas_save(simulation, NULL));
    wrong(simulation, selas_save(simulation, ""));
    wrong(simulation, selas_restore(simulation, NULL));
    wrong(simulation, selas_restore(simulation, path)); /* another scene: rk4 */
    wrong(simulation, selas_step(simulation, 1));
    wrong(simulation, selas_save(simulation, path));
    selas_close(&simulation);
    simulation = open_scene();
    wrong_open(&simulation, selas_restore(simulation, "/no/such/checkpoint"));
    selas_close(&simulation);
    simulation = open_scene();
    assert_int_equal(selas_step(simulation, 2), SELAS_OK);
    wrong_open(&simulation, selas_restore(simulation, path)); /* after the first step */
    selas_close(&simulation);
    static const long length[5] = {1, 100, 3000, 9000, 20000};
    for (int i = 0; i < 5; i++) { /* damaged: cut short */
        simulation = open_scene();
        assert_int_equal(selas_step(simulation, 2), SELAS_OK);
        assert_int_equal(selas_save(simulation, path), SELAS_OK);
        selas_close(&simulation);
        assert_int_equal(truncate(path, length[i]), 0);
        simulation = open_scene();
        wrong_open(&simulation, selas_restore(simulation, path));
        selas_close(&simulation);
    }
    remove(path);
}

/* --- Nothing is printed --- */

static int kept[2];   /* standard output and error while they go to the file */
static FILE *printed; /* what was written to them */

static int listen_to_output(void **state)
{
    (void)state;
    fflush(NULL);
    printed = tmpfile();
    if (printed == NULL) return -1;
    for (int i = 0; i < 2; i++) {
        kept[i] = dup(i + 1);
        if (kept[i] < 0 || dup2(fileno(printed), i + 1) < 0) return -1;
    }
    return 0;
}

/* 0 if nothing was written; else it is shown on standard error. */
static int nothing_was_printed(void **state)
{
    (void)state;
    fflush(NULL);
    for (int i = 0; i < 2; i++) {
        dup2(kept[i], i + 1);
        close(kept[i]);
    }
    char text[4096];
    rewind(printed);
    const size_t length = fread(text, 1, sizeof text, printed);
    fclose(printed);
    fwrite(text, 1, length, stderr);
    return length == 0 ? 0 : -1;
}

/* Every status has a name and a gloss of its own; a number that is none is told as such. */
static void test_statuses(void **state)
{
    (void)state;
    assert_string_equal(selas_status_name(SELAS_UNSTABLE), "SELAS_UNSTABLE");
    for (int one = SELAS_OK; one <= SELAS_STOPPED; one++) {
        assert_true(strlen(selas_status_gloss((selas_status)one)) > 5);
        for (int other = SELAS_OK; other < one; other++) {
            assert_string_not_equal(selas_status_name((selas_status)one),
                                    selas_status_name((selas_status)other));
            assert_string_not_equal(selas_status_gloss((selas_status)one),
                                    selas_status_gloss((selas_status)other));
        }
    }
    assert_string_equal(selas_status_name((selas_status)99), "unknown status");
    assert_string_equal(selas_status_gloss((selas_status)-1), "unknown status");
    assert_string_equal(selas_version(), SELAS_VERSION);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_statuses),
        cmocka_unit_test_setup_teardown(test_wrong_handles, listen_to_output, nothing_was_printed),
        cmocka_unit_test_setup_teardown(test_warnings_once, listen_to_output, nothing_was_printed),
        cmocka_unit_test_setup_teardown(test_wrong_words, listen_to_output, nothing_was_printed),
        cmocka_unit_test_setup_teardown(test_wrong_calls, listen_to_output, nothing_was_printed),
        cmocka_unit_test_setup_teardown(test_wrong_checkpoints, listen_to_output, nothing_was_printed),
    };
    omp_set_num_threads(1);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
