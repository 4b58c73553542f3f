/* Held loads (stepping/held.h, Eq H1): a change at the time reached without the operator against one by it,
 * on bodies with dampers, layers, mirror planes, exact mass and ground that varies; operator calls counted;
 * responses; what profiles and snapshots show of it. */
#include "host/simulation.h"
#include "record/run_file.h"

#include "api_scene.h"

#include <stdlib.h>

static const char rest[] =
    "&scene dimension = 3, end_time = 2.0 /\n"
    "&material name = 'rock', density = 1, lambda = 1, mu = 1 %s /\n"
    "&body material = 'rock', shape = 'box', low = 0, 0, 0, high = 8, 8, 6, spacing = .5 /\n"
    "&load name = 'left', face = 'z-', shape = 'square', centre = 3.6, 4, 0, size = .8, 1, history = 'step', "
    "direction = 0, 0, "
    "1 /\n"
    "&load name = 'right', face = 'z-', shape = 'square', centre = 4.4, 4, 0, size = .8, 1, history = "
    "'step', "
    "direction = 0, 0, 1 /\n"
    "&load name = 'deck', face = 'z-', shape = 'square', centre = 4, 4, 0, size = 2, 2, direction = 0, 0, 1\n"
    "  history = 'gaussian', width = .2, delay = 1 /\n"
    "&receiver name = 'r', position = 4, 4, 0 /\n";

static const struct ground {
    const char *name, *words, *rock;
} grounds[] = {
    {"dampers", "&boundary face = 'x-', 'x+', 'z+', kind = 'transmitting', layer = 'lysmer' /\n", ""},
    {"layers",
     "&boundary face = 'x-', 'z+', kind = 'transmitting', layer = 'pml', layer_points = 6, always = T /\n",
     ""},
    {"exact mass", "&method degree = 3, mass = 'exact' /\n&stepping scheme = 'leapfrog' /\n", ""},
    {"held face under a load", "&boundary face = 'x-', kind = 'fixed' /\n", ""},
    {"general ground",
     "&material name = 'soil', density = .8, lambda = .5, mu = .3 /\n&block material = 'soil', shape = "
     "'box', centre = 3, 4, 0, size = 2, 2, 2 /\n",
     ""},
    {"modified equation", "&stepping scheme = 'modified-equation' /\n", ""},
    {"modified equation, dampers",
     "&stepping scheme = 'modified-equation' /\n&boundary face = 'x-', 'z+', kind = 'transmitting', layer = "
     "'lysmer' /\n",
     ""},
    {"damped", "&method mechanisms = 2 /\n", ", q_p = 20, q_s = 10, q_frequency = .5"},
};

static selas_simulation *open_on(const struct ground *ground, bool held)
{
    char text[2000];
    selas_simulation *simulation = NULL;
    int used = snprintf(text, sizeof text, rest, ground->rock);
    snprintf(text + used, sizeof text - (size_t)used, "%s", ground->words);
    if (selas_open_text("held", text, &simulation) != SELAS_OK) fail_msg("%s", selas_message(simulation));
    assert_int_equal(selas_set_load(simulation, "left", 0), SELAS_OK);
    assert_int_equal(selas_set_load(simulation, "right", .5), SELAS_OK);
    if (selas_step(simulation, 0) != SELAS_OK) fail_msg("%s: %s", ground->name, selas_message(simulation));
    struct held *loads = &simulation->stepper->held;
    assert_int_equal(loads->loads, 2);
    assert_true(loads->count > 0);
    if (!held) loads->loads = loads->count = 0;
    return simulation;
}

static unsigned long calls(const selas_simulation *simulation)
{
    return model_computed(simulation->model)->evaluations;
}

static double furthest(size_t n, const double *one, const double *other)
{
    double most = 0, largest = 0;
    for (size_t i = 0; i < n; i++) {
        most = fmax(most, fabs(one[i] - other[i]));
        largest = fmax(largest, fabs(other[i]));
    }
    assert_true(largest > 0);
    return most / largest;
}

/* Twice a step another value, as contact asks for it. */
static void test_changes(void **state)
{
    (void)state;
    for (size_t g = 0; g < sizeof grounds / sizeof *grounds; g++) {
        selas_simulation *one[2] = {open_on(&grounds[g], true), open_on(&grounds[g], false)};
        const unsigned long before[2] = {calls(one[0]), calls(one[1])};
        enum { STEPS = 20 };
        for (int i = 0; i < STEPS; i++)
            for (int s = 0; s < 2; s++)
                for (int change = 0; change < 2; change++) {
                    double mean;
                    assert_int_equal(selas_set_load(one[s], "left", sin(i) + change), SELAS_OK);
                    assert_int_equal(selas_set_load(one[s], "right", cos(2 * i) - change), SELAS_OK);
                    assert_int_equal(selas_load_mean(one[s], "left", SELAS_ACCELERATION, &mean), SELAS_OK);
                    if (change == 1) assert_int_equal(selas_step(one[s], 1), SELAS_OK);
                }
        const size_t n = model_computed(one[0]->model)->unknowns;
        const double moved = furthest(2 * n, one[0]->state.y, one[1]->state.y),
                     accelerated = furthest(n, one[0]->state.a, one[1]->state.a);
        print_message("# %s: %.1e, accelerations %.1e; %lu operator calls, %lu without\n", grounds[g].name,
                      moved, accelerated, calls(one[0]) - before[0], calls(one[1]) - before[1]);
        assert_true(moved < 1e-13 && accelerated < 1e-12);
        const unsigned long a_step = (unsigned long)one[0]->stepper->scheme->evaluations;
        assert_true(calls(one[0]) - before[0] <= a_step * (STEPS + 2)); /* two changes at t = 0 */
        assert_int_equal(calls(one[1]) - before[1], 3 * a_step * STEPS);
        selas_close(&one[0]);
        selas_close(&one[1]);
    }
}

/* A response is the difference that a unit makes, and the same both ways round. */
static void test_response(void **state)
{
    (void)state;
    for (size_t g = 0; g < sizeof grounds / sizeof *grounds; g++) {
        static const char *const name[2] = {"left", "right"};
        selas_simulation *simulation = open_on(&grounds[g], true);
        double response[2][2], none, one;
        assert_int_equal(selas_step(simulation, 3), SELAS_OK);
        for (int i = 0; i < 2; i++)
            for (int j = 0; j < 2; j++) {
                assert_int_equal(selas_load_response(simulation, name[i], name[j], &response[i][j]),
                                 SELAS_OK);
                assert_int_equal(selas_set_load(simulation, name[i], 0), SELAS_OK);
                assert_int_equal(selas_load_mean(simulation, name[j], SELAS_ACCELERATION, &none), SELAS_OK);
                assert_int_equal(selas_set_load(simulation, name[i], 1), SELAS_OK);
                assert_int_equal(selas_load_mean(simulation, name[j], SELAS_ACCELERATION, &one), SELAS_OK);
                assert_true(fabs(one - none - response[i][j]) < 1e-12 * (fabs(one) + fabs(none)));
            }
        assert_true(response[0][0] > 0 && response[1][1] > 0);
        assert_true(fabs(response[0][1] - response[1][0]) < 1e-12 * response[0][0]);
        selas_close(&simulation);
    }
}

static double bell(double time)
{
    return exp(-12.5 * (time - 1) * (time - 1));
}

/* Velocities and accelerations of a profile between steps and of a snapshot, by the deck's history or the same held
 * step by step. */
enum { PROFILE = 2 * 5 * 6, SHOWN = PROFILE + 3 * 125 };
static void record_of(bool held, double shown[SHOWN])
{
    static const char words[] =
        "&stepping unwarp = .false., time_step = .2 /\n"
        "&material name = 'rock', density = 1, lambda = 1, mu = 1 /\n"
        "&body material = 'rock', shape = 'box', low = 0, 0, 0, high = 4, 4, 4, spacing = 1 /\n"
        "&load name = 'hammer', face = 'z-', shape = 'square', centre = 2, 2, 0, size = 2, 2, direction = 0, "
        "0, 1\n"
        "  history = 'gaussian', width = .2, delay = 1 /\n"
        "&profile name = 'line', from = 0, 2, 0, to = 4, 2, 0, points = 5, times = .77, 1.5\n"
        "  fields = 'velocity', 'acceleration' /\n&snapshot times = 1.1, fields = 'velocity' /\n";
    char folder[] = "/tmp/selas-held-XXXXXX", text[1000], command[100];
    assert_non_null(mkdtemp(folder));
    snprintf(text, sizeof text,
             "&scene end_time = 1.5 /\n&output directory = '%s/out', plots = .false. /\n%s", folder, words);
    selas_simulation *simulation = NULL;
    if (selas_open_text("held", text, &simulation) != SELAS_OK) fail_msg("%s", selas_message(simulation));
    if (held) assert_int_equal(selas_set_load(simulation, "hammer", 0), SELAS_OK);
    assert_int_equal(selas_record(simulation), SELAS_OK);
    for (unsigned long n = selas_steps_needed(simulation); held && n > 0; n--) {
        assert_int_equal(selas_set_load(simulation, "hammer", bell(selas_time(simulation))), SELAS_OK);
        assert_int_equal(selas_step(simulation, 1), SELAS_OK);
    }
    if (held) { /* what is held behind the end is in no result, nor can it be once histories are finished */
        double mean;
        assert_int_equal(selas_set_load(simulation, "hammer", bell(selas_time(simulation))), SELAS_OK);
        assert_int_equal(selas_finish(simulation), SELAS_OK);
        assert_int_equal(selas_set_load(simulation, "hammer", 9), SELAS_BAD_ARGUMENT);
        assert_int_equal(selas_load_mean(simulation, "hammer", SELAS_VELOCITY, &mean), SELAS_OK);
    }
    if (selas_write(simulation) != SELAS_OK) fail_msg("%s", selas_message(simulation));
    const struct recorder *recorder = simulation->recorder;
    memcpy(shown, recorder->profile[0].value, PROFILE * sizeof *shown);
    assert_int_equal(recorder->entries, 1);
    snprintf(text, sizeof text, "%s/out/run.h5", folder);
    const hid_t file = hdf_open_file(text), set = H5Dopen2(file, "/snapshots/0000/velocity", H5P_DEFAULT);
    assert_true(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, shown + PROFILE) >= 0);
    H5Dclose(set);
    H5Fclose(file);
    selas_close(&simulation);
    snprintf(command, sizeof command, "rm -r %s", folder);
    assert_int_equal(system(command), 0);
}

/* They show the load as it was held at their time. */
static void test_records(void **state)
{
    (void)state;
    double by_deck[SHOWN], held[SHOWN];
    record_of(false, by_deck);
    record_of(true, held);
    const double profile = furthest(PROFILE, held, by_deck),
                 snapshot = furthest(SHOWN - PROFILE, held + PROFILE, by_deck + PROFILE);
    print_message("# held against the deck: profile %.1e, snapshot %.1e\n", profile, snapshot);
    assert_true(profile < 1e-12 && snapshot < 1e-6);
}

/* A load that makes the state overflow ends the run, whatever is held after it. */
static void test_overflow(void **state)
{
    (void)state;
    double value[6];
    selas_simulation *simulation = open_on(&grounds[0], true);
    assert_int_equal(selas_step(simulation, 3), SELAS_OK);
    assert_int_equal(selas_set_load(simulation, "left", 1e160), SELAS_OK);
    assert_int_equal(selas_receiver(simulation, "r", SELAS_VELOCITY, value), SELAS_UNSTABLE);
    assert_int_equal(selas_set_load(simulation, "left", 0), SELAS_OK);
    assert_int_equal(selas_step(simulation, 1), SELAS_UNSTABLE);
    assert_non_null(strstr(selas_last_message(simulation), "went unstable"));
    assert_non_null(strstr(selas_last_message(simulation), "likely: a given number too large"));
    assert_int_equal(selas_finish(simulation), SELAS_UNSTABLE);
    assert_int_equal(selas_steps(simulation), 3);
    size_t count, width;
    const double *values;
    assert_int_equal(selas_receiver(simulation, "r", SELAS_VELOCITY, value), SELAS_UNSTABLE);
    assert_non_null(strstr(selas_last_message(simulation), "went unstable"));
    assert_int_equal(selas_field_values(simulation, SELAS_VELOCITY, &count, &width, &values), SELAS_UNSTABLE);
    assert_int_equal(selas_energy(simulation, &value[0], &value[1]), SELAS_UNSTABLE);
    assert_int_equal(selas_load_mean(simulation, "left", SELAS_VELOCITY, value), SELAS_UNSTABLE);
    selas_close(&simulation);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_changes), cmocka_unit_test(test_response),
                                       cmocka_unit_test(test_records), cmocka_unit_test(test_overflow)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
