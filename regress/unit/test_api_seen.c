/* What hosts look at: means under loads, fields and receivers where and when the deck asked for none. */
#include "api_scene.h"

#include <stdlib.h>

static const char plate[] =
    "&scene dimension = 2, end_time = 3 /\n"
    "&material name = 'rock', density = 1, lambda = 1, mu = 1 /\n"
    "&body material = 'rock', shape = 'box', low = -2, 0, high = 2, 3, spacing = 0.25 /\n"
    "&receiver name = 'r', position = 1, 1 /\n";

static selas_simulation *open_with(const char *ground, const char *more)
{
    selas_simulation *simulation = NULL;
    char text[2000];
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

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_means_beyond_mirrors),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
