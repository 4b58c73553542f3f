/* Held loads (stepping/held.h, Eq H1): a change at the time reached without the operator against one by it,
 * on bodies with dampers, layers, mirror planes, exact mass and ground that varies; operator calls counted;
 * responses. */
#include "host/simulation.h"

#include "api_scene.h"

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

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_changes), cmocka_unit_test(test_response)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
