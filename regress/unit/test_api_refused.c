/* Calls that are refused: each value is checked at once, nothing changes, one failure is told once, and the last
 * call's message can be had alone. */
#include "api_scene.h"

#include <omp.h>
#include <stdlib.h>

static void test_refused_calls_change_nothing(void **state)
{
    (void)state;
    selas_simulation *s = open_scene();
    const char *const east[1] = {"east"}, *const sideways[1] = {"sideways"}, *const face[1] = {"z-"};
    const double place[4] = {3, 2, 0}, bad = -1, good = 1, *points;
    double value[6];
    size_t number, count;
    assert_int_equal(selas_add(s, "receiver", &number), SELAS_OK);
    assert_int_equal(selas_set_text(s, "receiver(2)%name", 1, east), SELAS_OK);
    assert_int_equal(selas_set_real(s, "receiver(2)%position", 3, place), SELAS_OK);
    assert_int_equal(selas_points(s, &count, &points), SELAS_OK);
    const double first = points[0];
    /* sign, range and word are checked by the call itself */
    wrong(s, selas_set_real(s, "body%spacing", 1, &bad));
    assert_non_null(strstr(selas_last_message(s), "expected a number in (0, inf)"));
    wrong(s, selas_set_real(s, "material%density", 1, &(double){0}));
    wrong(s, selas_set_text(s, "load%shape", 1, sideways));
    assert_non_null(strstr(selas_last_message(s), "expected one of 'square'"));
    wrong(s, selas_set_text(s, "load(2)%shape", 1, sideways)); /* there is no second load before nor after */
    wrong(s, selas_set_integer(s, "method%degree", 9));
    /* which receiver? */
    wrong(s, selas_set_text(s, "receiver%name", 1, face));
    assert_non_null(strstr(selas_last_message(s), "which of the 2"));
    wrong(s, selas_set_real(s, "body%low", 4, place));
    assert_true(points[0] == first); /* what was handed out is still there */
    assert_int_equal(selas_build(s), SELAS_OK);
    assert_int_equal(selas_step(s, 1), SELAS_OK);
    assert_int_equal(selas_receiver(s, "r", SELAS_VELOCITY, value), SELAS_OK);
    assert_int_equal(selas_receiver(s, "east", SELAS_VELOCITY, value), SELAS_OK);
    assert_string_equal(selas_last_message(s), "");
    wrong(s, selas_set_real(s, "body%spacing", 1, &good)); /* too late */
    selas_close(&s);
}

static size_t lines_of(const char *text)
{
    size_t lines = 0;
    for (; *text != '\0'; text++)
        lines += *text == '\n';
    return lines;
}

static void test_one_failure_is_told_once(void **state)
{
    (void)state;
    selas_simulation *s = NULL;
    double value[6];
    selas_status opened = selas_open_deck("/nowhere.nml", &s);
    wrong_open(&s, opened);
    assert_int_equal(selas_step(s, 1), opened);
    selas_close(&s);
    wrong_open(&s, opened = selas_open_text("wrong", "&scene dimension = 5 /", &s));
    assert_int_equal(opened, SELAS_BAD_DECK);
    assert_int_equal(selas_step(s, 1), opened);
    assert_int_equal(selas_build(s), opened);
    size_t told = lines_of(selas_message(s));
    for (int i = 0; i < 3; i++) {
        wrong(s, selas_step(s, 1));
        assert_true(isnan(selas_end_time(s)));
        wrong(s, selas_receiver(s, "r", SELAS_VELOCITY, value));
        assert_non_null(strstr(selas_last_message(s), "dimension"));
    }
    assert_int_equal(lines_of(selas_message(s)), told);
    selas_close(&s);
    /* a scene that cannot be built, until it is mended */
    s = open_scene();
    const double outside[3] = {9, 2, 0}, inside[3] = {3, 2, 0};
    assert_int_equal(selas_set_real(s, "receiver%position", 3, outside), SELAS_OK);
    assert_string_equal(selas_last_message(s), "");
    wrong(s, selas_build(s));
    assert_int_equal(lines_of(selas_message(s)), 1);
    wrong(s, selas_step(s, 1));
    wrong(s, selas_set_real(s, "body%spacing", 1, &(double){-1}));
    wrong(s, selas_step(s, 1));
    assert_non_null(strstr(selas_last_message(s), "outside the body"));
    assert_null(strstr(selas_last_message(s), "spacing"));
    assert_int_equal(lines_of(selas_message(s)), 2);
    assert_int_equal(selas_set_real(s, "receiver%position", 3, inside), SELAS_OK);
    assert_int_equal(selas_step(s, 1), SELAS_OK);
    /* a callback that failed ends the run */
    selas_close(&s);
    s = open_scene();
    struct push push = {.answer = -1};
    assert_int_equal(selas_set_traction(s, "hammer", triangle, &push), SELAS_OK);
    wrong(s, selas_step(s, 3));
    wrong(s, selas_step(s, 1));
    wrong(s, selas_save(s, "checkpoint"));
    assert_int_equal(lines_of(selas_message(s)), 1);
    assert_non_null(strstr(selas_last_message(s), "hammer"));
    selas_close(&s);
    assert_string_equal(selas_last_message(NULL), selas_message(NULL));
}

/* A load with a file of sources is several in the scene: the next one keeps its number. */
static void test_loads_behind_sources(void **state)
{
    (void)state;
    static const char *const path = "build/test-api-sources.txt";
    char text[2048], fit[sizeof scene];
    double own = 0, value[6];
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs("1 1 1  0 0 1\n3 1 1  0 0 1\n", file);
    fclose(file);
    memcpy(fit, scene, sizeof scene);
    char *name = strstr(fit, "name = 'hammer',"); /* it has its number alone */
    memset(name, ' ', strlen("name = 'hammer',"));
    snprintf(
        text, sizeof text,
        "%s&load kind = 'body-force', sources = '%s', amplitude = 0, history = 'triangle', duration = 1 /\n"
        "&load face = 'z-', shape = 'square', centre = 2, 2, 0, size = 2, 2, direction = 0, 0, 1, "
        "history = 'triangle', duration = 1 /\n",
        fit, path);
    for (int number = 1; number <= 3; number += 2) {
        selas_simulation *s = NULL;
        if (selas_open_text("sources.nml", text, &s) != SELAS_OK) fail_msg("%s", selas_message(s));
        assert_int_equal(selas_set_real(s, "load(1)%amplitude", 1, &(double){0}), SELAS_OK);
        assert_int_equal(selas_set_real(s, "load(3)%amplitude", 1, &(double){0}), SELAS_OK);
        wrong(s, selas_set_load(s, "2", 1));
        assert_non_null(strstr(selas_last_message(s), "is several sources"));
        wrong(s, selas_set_load(s, "4", 1));
        if (selas_set_load(s, number == 1 ? "1" : "3", 1) != SELAS_OK) fail_msg("%s", selas_message(s));
        assert_int_equal(selas_step(s, 3), SELAS_OK);
        assert_int_equal(selas_receiver(s, "r", SELAS_VELOCITY, value), SELAS_OK);
        assert_true(fabs(value[2]) > 1e-3);
        if (number == 1) own = value[2];
        if (number == 3) assert_true(value[2] == own);
        selas_close(&s);
    }
    remove(path);
}

/* The host's load stays that of its &load when a list of sources before it grows; it cannot become several. */
static void test_sources_grow(void **state)
{
    (void)state;
    static const char *const path[2] = {"build/test-api-source.txt", "build/test-api-sources.txt"};
    static const char more[] =
        "%s&load kind = 'body-force', sources = '%s', amplitude = 0, history = 'triangle', duration = 1 /\n"
        "&load name = 'held', face = 'z-', shape = 'square', centre = 2, 2, 0, size = 2, 2, direction = 0, "
        "0, 1,\n"
        "  history = 'triangle', duration = 1 /\n";
    char text[2048];
    double value[2][6];
    for (int n = 0; n < 2; n++) {
        FILE *file = fopen(path[n], "w");
        assert_non_null(file);
        fputs(n == 0 ? "1 1 1  0 0 1\n" : "1 1 1  0 0 1\n3 1 1  0 0 1\n", file);
        fclose(file);
    }
    snprintf(text, sizeof text, more, scene, path[0]);
    for (int grown = 0; grown < 2; grown++) {
        selas_simulation *s = NULL;
        if (selas_open_text("grown.nml", text, &s) != SELAS_OK) fail_msg("%s", selas_message(s));
        assert_int_equal(selas_set_load(s, "held", 1), SELAS_OK);
        assert_int_equal(selas_set_text(s, "load(2)%sources", 1, &path[grown]), SELAS_OK);
        if (selas_step(s, 3) != SELAS_OK) fail_msg("%s", selas_message(s));
        assert_int_equal(selas_receiver(s, "r", SELAS_VELOCITY, value[grown]), SELAS_OK);
        assert_true(value[grown][2] == value[0][2] && fabs(value[0][2]) > 1e-3);
        selas_close(&s);
    }
    selas_simulation *s = NULL;
    assert_int_equal(selas_open_text("grown.nml", text, &s), SELAS_OK);
    assert_int_equal(selas_set_load(s, "2", 1), SELAS_OK);
    assert_int_equal(selas_set_text(s, "load(2)%sources", 1, &path[1]), SELAS_OK);
    wrong(s, selas_step(s, 1));
    assert_non_null(strstr(selas_last_message(s), "is several sources"));
    assert_int_equal(selas_set_text(s, "load(2)%sources", 1, &path[0]), SELAS_OK);
    assert_int_equal(selas_step(s, 1), SELAS_OK);
    selas_close(&s);
    remove(path[0]);
    remove(path[1]);
}

/* An exact solution, asked for or that of scene%accuracy, is that of the deck's histories: not of what a host drives. */
static void test_nothing_to_compare(void **state)
{
    (void)state;
    static const char *const ground =
        "&scene dimension = 3, end_time = 4%s /\n&material name = 'r', density = 1, s_speed = 1, p_speed = "
        "1.8 /\n"
        "&body material = 'r', shape = 'half-space'%s /\n"
        "&load name = 'l', face = 'z-', shape = 'square', size = 1, 1, centre = 0, 0, 0, direction = 0, 0, "
        "1,\n"
        "history = 'gaussian', width = .8, delay = 3 /\n"
        "&receiver name = 'a', position = 1.5, .3, 0 /\n%s&output directory = '%s' /\n";
    static const char *const words[2][3] = {{", accuracy = .1", "", ""},
                                            {"", ", spacing = .5", "&reference kind = 'lamb' /\n"}};
    char folder[] = "/tmp/selas-compare-XXXXXX", command[64], text[1024];
    assert_non_null(mkdtemp(folder));
    for (int k = 0; k < 4; k++) {
        const bool asked = k >= 2, driven = k % 2 == 1;
        const char *const *word = words[asked];
        selas_simulation *s = NULL;
        snprintf(text, sizeof text, ground, word[0], word[1], word[2], folder);
        assert_int_equal(selas_open_text("t", text, &s), SELAS_OK);
        if (driven) assert_int_equal(selas_set_load(s, "l", 1), SELAS_OK);
        assert_int_equal(selas_build(s), SELAS_OK);
        assert_int_equal(strstr(selas_message(s), "nothing is compared") != NULL, asked && driven);
        assert_int_equal(selas_write_exact(s), driven ? SELAS_BAD_SCENE : SELAS_OK);
        selas_close(&s);
    }
    snprintf(command, sizeof command, "rm -r %s", folder);
    assert_int_equal(system(command), 0);
}

/* Of the simulation whose plan is told. */
static void call_back(void *context, const char *key, const char *value)
{
    selas_simulation **s = context, *const own = *s;
    (void)key;
    (void)value;
    const double end = 1;
    assert_int_equal(selas_step(own, 1), SELAS_BAD_ARGUMENT);
    assert_int_equal(selas_set_real(own, "scene%end_time", 1, &end), SELAS_BAD_ARGUMENT);
    selas_close(s);
    assert_ptr_equal(*s, own);
}

static void test_plans_are_not_interrupted(void **state)
{
    (void)state;
    selas_simulation *s = open_scene();
    assert_int_equal(selas_plan(s, call_back, &s), SELAS_OK);
    assert_int_equal(selas_steps(s), 0);
    assert_int_equal(selas_step(s, 1), SELAS_OK);
    selas_close(&s);
    assert_null(s);
}

/* A held load of a run whose histories are finished: nothing follows, so nothing changes. */
static void test_finished(void **state)
{
    (void)state;
    double before[6], after[6];
    selas_simulation *s = open_scene();
    assert_int_equal(selas_set_load(s, "hammer", 1), SELAS_OK);
    assert_int_equal(selas_finish(s), SELAS_OK);
    assert_int_equal(selas_receiver(s, "r", SELAS_ACCELERATION, before), SELAS_OK);
    wrong(s, selas_set_load(s, "hammer", 100));
    assert_int_equal(selas_receiver(s, "r", SELAS_ACCELERATION, after), SELAS_OK);
    assert_memory_equal(before, after, 3 * sizeof *before);
    selas_close(&s);
}

/* A face that a function moves must still be one that the deck moves when the scene is built. */
static void test_moved_face(void **state)
{
    (void)state;
    char text[2048];
    selas_simulation *s = NULL;
    struct push push = {0};
    snprintf(text, sizeof text,
             "&scene dimension = 2, end_time = 1 /\n&material name = 'r', density = 1, lambda = 1, mu = 1 /\n"
             "&body material = 'r', low = 0, 0, high = 4, 4, spacing = 1 /\n"
             "&boundary face = 'x-', kind = 'displacement', direction = 1, 0, history = 'step' /\n");
    assert_int_equal(selas_open_text("moved", text, &s), SELAS_OK);
    assert_int_equal(selas_set_motion(s, "x-", triangle, &push), SELAS_OK);
    assert_int_equal(selas_set_text(s, "boundary%face", 1, &(const char *const){"y-"}), SELAS_OK);
    wrong(s, selas_step(s, 1));
    assert_non_null(strstr(selas_last_message(s), "moves face 'x-', which has no &boundary"));
    assert_int_equal(selas_set_text(s, "boundary%face", 1, &(const char *const){"x-"}), SELAS_OK);
    assert_int_equal(selas_step(s, 1), SELAS_OK);
    selas_close(&s);
}

/* Points of the host: all of what it gave is used, or refused. */
static void test_points_that_are_not_used(void **state)
{
    (void)state;
    enum { POINTS = 32, ALONG = 8 };
    double position[3 * POINTS] = {0}, volume[POINTS];
    selas_simulation *s = NULL;
    for (int i = 0; i < POINTS; i++) {
        position[3 * i] = .125 + .25 * (i % ALONG);
        position[3 * i + 1] = .125 + .25 * (i / ALONG);
        volume[i] = .0625;
    }
    assert_int_equal(selas_open_text("points",
                                     "&scene dimension = 2, end_time = 1 /\n&method name = 'sph' /\n"
                                     "&material name = 'r', density = 1, lambda = 1, mu = 1 /\n"
                                     "&body material = 'r', low = 0, 0, high = 2, 1, spacing = .25 /\n",
                                     &s),
                     SELAS_OK);
    position[2] = .05;
    assert_int_equal(selas_set_points(s, POINTS, position, volume, NULL), SELAS_OK);
    wrong(s, selas_build(s));
    assert_non_null(
        strstr(selas_last_message(s), "point 1 of the host has z = 0.05; expected 0 in 2 dimensions"));
    position[2] = 0;
    assert_int_equal(selas_set_points(s, POINTS, position, volume, NULL), SELAS_OK);
    assert_int_equal(selas_build(s), SELAS_OK);
    assert_int_equal(selas_set_text(s, "body%shape", 1, &(const char *const){"box"}), SELAS_OK);
    wrong(s, selas_build(s));
    assert_non_null(strstr(selas_last_message(s), "expected shape 'points'"));
    selas_close(&s);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_refused_calls_change_nothing),
        cmocka_unit_test(test_one_failure_is_told_once),
        cmocka_unit_test(test_loads_behind_sources),
        cmocka_unit_test(test_sources_grow),
        cmocka_unit_test(test_nothing_to_compare),
        cmocka_unit_test(test_plans_are_not_interrupted),
        cmocka_unit_test(test_finished),
        cmocka_unit_test(test_moved_face),
        cmocka_unit_test(test_points_that_are_not_used),
    };
    omp_set_num_threads(1);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
