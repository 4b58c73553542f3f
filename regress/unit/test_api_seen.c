/* What hosts look at: means under loads, fields and receivers where and when the deck asked for none. */
#include "api_scene.h"

#include <stdlib.h>
#include <string.h>

static const char plate[] =
    "&scene dimension = 2, end_time = 3 /\n"
    "&material name = 'rock', density = 1, lambda = 1, mu = 1 /\n"
    "&body material = 'rock', shape = 'box', low = -2, 0, high = 2, 3, spacing = 0.25 /\n"
    "&receiver name = 'r', position = 1, 1 /\n";

static selas_simulation *open_with(const char *ground, const char *more)
{
    selas_simulation *simulation = NULL;
    char text[4000];
    snprintf(text, sizeof text, "%s%s", ground, more);
    const selas_status status = selas_open_text("test-api-seen", text, &simulation);
    if (status != SELAS_OK) fail_msg("%s", selas_message(simulation));
    return simulation;
}

/* A load and its image: of the whole body, and of the half that is computed, they have the same means, whichever lies
 * in that half, and where they lie across the mirror plane. */
static void test_means_beyond_mirrors(void **state)
{
    (void)state;
    static const char *const pairs[] = {
        "&load face = 'y-', shape = 'square', centre = %s1, 0, size = .5, direction = %s.3, 1, %s /\n",
        "&load face = 'y-', shape = 'square', centre = %s.2, 0, size = 1, direction = %s.3, 1, %s /\n",
        "&load kind = 'body-force', shape = 'point', centre = %s1, 1, direction = %s.3, 1, %s /\n"};
    static const char *const history = "amplitude = 2, history = 'gaussian', width = .3, delay = 1.2";
    for (size_t p = 0; p < 3; p++) {
        char text[2][300], whole[700];
        double mean[2][2][3];
        snprintf(text[0], sizeof text[0], pairs[p], "", "", history);
        snprintf(text[1], sizeof text[1], pairs[p], "-", "-", history);
        for (int half = 0; half < 2; half++) {
            snprintf(whole, sizeof whole, "%s%s&method symmetry = %s /\n", text[0], text[1],
                     half ? "T" : "F");
            selas_simulation *simulation = open_with(plate, whole);
            assert_int_equal(selas_advance(simulation, 2), SELAS_OK);
            for (int load = 0; load < 2; load++)
                for (int field = 0; field < 3; field++)
                    assert_int_equal(selas_load_mean(simulation, load == 0 ? "1" : "2", (selas_field)field,
                                                     &mean[half][load][field]),
                                     SELAS_OK);
            selas_close(&simulation);
        }
        for (int load = 0; load < 2; load++)
            for (int field = 0; field < 3; field++)
                assert_true(fabs(mean[1][load][field] - mean[0][0][field]) < 1e-10 * fabs(mean[0][0][field]));
    }
}

static const char ground[] =
    "&scene dimension = 2, end_time = 4 /\n"
    "&material name = 'rock', density = 1, lambda = 1, mu = 1 /\n"
    "&body material = 'rock', shape = 'half-space', spacing = 0.125 /\n"
    "&load face = 'y-', shape = 'square', centre = 0, 0, size = 1, direction = 0, 1\n"
    "  history = 'gaussian', width = .3, delay = 1.2 /\n";

/* The mean velocity under the load at the end, and what was said. */
static double end_mean(const char *more, double end, const char **said, selas_simulation **simulation)
{
    double mean = 0;
    *simulation = open_with(ground, more);
    assert_int_equal(selas_advance(*simulation, end), SELAS_OK);
    assert_int_equal(selas_load_mean(*simulation, "1", SELAS_VELOCITY, &mean), SELAS_OK);
    *said = selas_message(*simulation);
    return mean;
}

/* The box holds what a host looks at; past the end, or where it does not, the host is told. */
static void test_looks(void **state)
{
    (void)state;
    static const char *const far = "&receiver name = 'r', position = 6, 0 /\n";
    const char *said;
    selas_simulation *s, *large;
    const double nobody = end_mean("", 4, &said, &s);
    assert_string_equal(said, "");
    assert_int_equal(selas_load_mean(s, "1", SELAS_DISPLACEMENT, &(double){0}), SELAS_OK);
    selas_close(&s);
    const char *deck = strstr(ground, "&body");
    char text[2000];
    snprintf(text, sizeof text,
             "%.*s&body material = 'rock', low = -15, 0, high = 15, 15, spacing = 0.125 /%s",
             (int)(deck - ground), ground, strchr(deck, '/') + 1);
    large = open_with(text, far);
    double right = 0, late = 0;
    assert_int_equal(selas_advance(large, 4), SELAS_OK);
    assert_int_equal(selas_load_mean(large, "1", SELAS_VELOCITY, &right), SELAS_OK);
    assert_int_equal(selas_advance(large, 8), SELAS_OK);
    assert_int_equal(selas_load_mean(large, "1", SELAS_VELOCITY, &late), SELAS_OK);
    assert_string_equal(selas_message(large), "");
    selas_close(&large);
    assert_true(fabs(nobody - right) < 2e-3);

    const double past = end_mean("", 8, &said, &s);
    assert_true(fabs(past - late) > 1e-2); /* the side has come back */
    assert_non_null(strstr(said, "may hold what face"));
    selas_close(&s);
    s = open_with(ground, far);
    size_t count, components;
    const double *field;
    assert_int_equal(selas_advance(s, 4), SELAS_OK);
    assert_int_equal(selas_receiver(s, "r", SELAS_VELOCITY, (double[3]){0}), SELAS_OK);
    assert_string_equal(selas_message(s), "");
    for (int i = 0; i < 2; i++)
        assert_int_equal(selas_field_values(s, SELAS_VELOCITY, &count, &components, &field), SELAS_OK);
    const char *first = strstr(selas_message(s), "may hold");
    assert_non_null(first);
    assert_null(strstr(first + 1, "may hold"));
    selas_close(&s);
}

/* The warnings that the program prints are messages to a host, once. */
static void test_advice(void **state)
{
    (void)state;
    selas_simulation *s = open_with(
        plate, "&method name = 'sph', law = 'linear' /\n&load face = 'y-', shape = 'square', centre = 1, 0\n"
               "size = .5, direction = 0, 1, history = 'gaussian', width = .3, delay = 1.2 /\n");
    assert_int_equal(selas_step(s, 0), SELAS_OK);
    assert_string_equal(selas_message(s), "");
    for (int i = 0; i < 2; i++)
        assert_int_equal(selas_step(s, 1), SELAS_OK);
    const char *first = strstr(selas_message(s), "points per wavelength of the slowest wave");
    assert_non_null(first);
    assert_null(strstr(first + 1, "points per wavelength of the slowest wave"));
    selas_close(&s);
}

static void count_driven(void *context, const char *key, const char *value)
{
    int *told = context;
    if (strcmp(key, "driven by the host") == 0) *told += strcmp(value, "load 1") == 0 ? 1 : 10;
}

static int push(void *context, double time, const double position[3], double value[3])
{
    (void)context, (void)time, (void)position;
    value[0] = value[2] = 0;
    value[1] = 1;
    return 0;
}

/* The plan, and so the report, tells what the deck alone does not do. */
static void test_driven(void **state)
{
    (void)state;
    for (int drives = 0; drives < 2; drives++) {
        int told = 0;
        selas_simulation *s = open_with(ground, "");
        if (drives) assert_int_equal(selas_set_traction(s, "1", push, NULL), SELAS_OK);
        assert_int_equal(selas_plan(s, count_driven, &told), SELAS_OK);
        assert_int_equal(told, drives);
        selas_close(&s);
    }
}

/* What a function gives is one load, whatever its pieces are; beside it the deck's own loads are told of as ever. */
static void test_advice_on_driven(void **state)
{
    (void)state;
    static const char cut[] =
        "&boundary face = 'x-', kind = 'symmetry' /\n&load face = 'y-', shape = 'square'\n"
        "centre = -2, 0, size = 1, direction = 0, 1, history = 'step' /\n",
                      sharp[] =
                          "&load face = 'y+', shape = 'square', centre = 1, 3, size = 1, direction = 0, 1\n"
                          "history = 'gaussian', width = .1, delay = .4 /\n";
    for (int beside = 0; beside < 2; beside++) {
        char more[sizeof cut + sizeof sharp];
        snprintf(more, sizeof more, "%s%s", cut, beside ? sharp : "");
        selas_simulation *s = open_with(plate, more);
        assert_int_equal(selas_set_traction(s, "1", push, NULL), SELAS_OK);
        assert_int_equal(selas_step(s, 1), SELAS_OK);
        if (beside)
            assert_non_null(strstr(selas_message(s), "points per wavelength of the slowest wave"));
        else
            assert_string_equal(selas_message(s), "");
        selas_close(&s);
    }
}

static int shear(void *context, double time, const double position[3], double value[3])
{
    const double *along = context;
    (void)time, (void)position;
    value[0] = *along;
    value[1] = 1;
    value[2] = 0;
    return 0;
}

/* Sides that the program made rollers, for the deck's load is alike all over the surface, hold what a function gives
 * across it; a deck that names one side leaves it the others. */
static void test_sides_hold(void **state)
{
    (void)state;
    static const char column[] = "&scene dimension = 2, end_time = 1 /\n"
                                 "&material name = 'rock', density = 1, lambda = 1, mu = 1 /\n"
                                 "&body material = 'rock', shape = 'half-space', spacing = 0.125 /\n"
                                 "&load face = 'y-', shape = 'face', direction = 0, 1, history = 'step' /\n"
                                 "&receiver name = 'r', position = 0, .5 /\n";
    static const char *const named[] = {"", "&boundary face = 'x-', kind = 'roller' /\n",
                                        "&boundary face = 'x-', 'x+', kind = 'roller' /\n"};
    for (int across = 0; across < 6; across++) {
        double along = across % 2;
        selas_simulation *s = open_with(column, named[across / 2]);
        assert_int_equal(selas_set_traction(s, "1", shear, &along), SELAS_OK);
        assert_int_equal(selas_step(s, 3), SELAS_OK);
        const char *first = strstr(selas_message(s), "the sides are rollers");
        assert_true((first != NULL) == (across == 1 || across == 3));
        if (first != NULL) assert_null(strstr(first + 1, "the sides are rollers"));
        selas_close(&s);
    }
}

/* Past end_time loads and faces go on as the deck has them (their warped histories grow), from a checkpoint too. */
static void test_past_the_end(void **state)
{
    (void)state;
    static const char *const driven =
        "&load face = 'y-', shape = 'square', centre = .3, 0, size = 1, direction = 0.3, 1\n"
        "  history = 'sine-burst', frequency = .3, cycles = 8 /\n"
        "&boundary face = 'y+', kind = 'velocity', direction = 0, 1, history = 'sine-burst', frequency = "
        ".2,\n"
        "  cycles = 3 /\n";
    char path[] = "/tmp/selas-past-XXXXXX";
    const double late = 20, planned = 2;
    selas_simulation *all[3];
    double value[3][6];
    assert_true(mkstemp(path) >= 0);
    for (int k = 0; k < 3; k++) {
        all[k] = open_with(plate, driven);
        assert_int_equal(selas_set_real(all[k], "scene%end_time", 1, k == 0 ? &late : &planned), SELAS_OK);
    }
    for (int t = 5; t <= 20; t += 5) {
        for (int k = 0; k < 3; k++) {
            if (k == 2 && t == 10) assert_int_equal(selas_restore(all[2], path), SELAS_OK);
            if (k < 2 || t >= 10) assert_int_equal(selas_advance(all[k], t), SELAS_OK);
            assert_int_equal(selas_receiver(all[k], "r", SELAS_VELOCITY, value[k]), SELAS_OK);
        }
        if (t == 5) assert_int_equal(selas_save(all[1], path), SELAS_OK);
        if (t > 5) assert_memory_equal(value[1], value[2], 2 * sizeof **value);
        for (int c = 0; c < 2; c++)
            assert_true(fabs(value[1][c] - value[0][c]) < 1e-4 * hypot(value[0][0], value[0][1]));
    }
    for (int k = 0; k < 3; k++)
        selas_close(&all[k]);
    remove(path);
}

/* Stresses of a receiver beside an interface are those of a smooth strain, and that is said once; others are not. */
static void test_smooth_strains(void **state)
{
    (void)state;
    static const char *const said = "mid-run are those of a strain";
    static const char block[] =
        "&material name = 'soil', density = 1, lambda = .3, mu = .2 /\n"
        "&block material = 'soil', centre = 0, 1, size = 2, 1 /\n"
        "&load kind = 'body-force', shape = 'point', centre = -1, 2, direction = 1, 0, history = 'gaussian', "
        "width = 1, delay = 5 /\n"
        "&receiver name = 'far', position = -1.5, 2.5 /\n";
    double value[6];
    selas_simulation *simulation = open_with(plate, block);
    assert_int_equal(selas_advance(simulation, 1), SELAS_OK);
    assert_int_equal(selas_receiver(simulation, "far", SELAS_STRESS, value), SELAS_OK);
    assert_int_equal(selas_receiver(simulation, "r", SELAS_VELOCITY, value), SELAS_OK);
    assert_null(strstr(selas_message(simulation), said));
    assert_int_equal(selas_receiver(simulation, "r", SELAS_STRESS, value), SELAS_OK);
    assert_int_equal(selas_receiver(simulation, "r", SELAS_ENERGY, value), SELAS_OK);
    const char *first = strstr(selas_message(simulation), said);
    assert_non_null(first);
    assert_null(strstr(first + 1, said));
    selas_close(&simulation);
}

/* Of total-Lagrangian particles beside a face stresses err by more than velocities, and that is said once. */
static void test_strains_of_particles(void **state)
{
    (void)state;
    static const char *const said = "stresses and strains at receiver 'edge' err by up to about";
    static const char body[] =
        "&scene dimension = 2, end_time = 3 /\n"
        "&material name = 'rock', density = 1, lambda = 1, mu = 1 /\n"
        "&body material = 'rock', low = 0, 0, high = 4, 3, spacing = 0.125 /\n"
        "&method name = 'sph', law = 'linear' /\n"
        "&load face = 'y-', shape = 'square', centre = 2, 0, size = 1, direction = 0, 1\n"
        "  amplitude = 1e-5, history = 'gaussian', width = 1, delay = 3.5 /\n"
        "&boundary face = 'y+', kind = 'fixed' /\n"
        "&receiver name = 'edge', position = 2, .05 /\n"
        "&receiver name = 'inside', position = 2, 1 /\n";
    double value[6];
    selas_simulation *simulation = open_with(body, "");
    assert_int_equal(selas_step(simulation, 3), SELAS_OK);
    assert_int_equal(selas_receiver(simulation, "inside", SELAS_STRESS, value), SELAS_OK);
    assert_int_equal(selas_receiver(simulation, "edge", SELAS_VELOCITY, value), SELAS_OK);
    assert_null(strstr(selas_message(simulation), "stresses and strains at receiver"));
    assert_int_equal(selas_receiver(simulation, "edge", SELAS_STRESS, value), SELAS_OK);
    assert_int_equal(selas_receiver(simulation, "edge", SELAS_PRESSURE, value), SELAS_OK);
    const char *first = strstr(selas_message(simulation), said);
    assert_non_null(first);
    assert_null(strstr(first + 1, said));
    selas_close(&simulation);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_looks),
        cmocka_unit_test(test_past_the_end),
        cmocka_unit_test(test_advice),
        cmocka_unit_test(test_driven),
        cmocka_unit_test(test_advice_on_driven),
        cmocka_unit_test(test_sides_hold),
        cmocka_unit_test(test_means_beyond_mirrors),
        cmocka_unit_test(test_smooth_strains),
        cmocka_unit_test(test_strains_of_particles),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
