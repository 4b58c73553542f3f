/* Moving patches in the consistent method: at any time their forces are the mean, over the way, of those of patches at
 * rest where the moving one then is; stepping does not un-warp them. */
#include "base/memory.h"
#include "method/consistent/galerkin/moving_load.h"
#include "method/methods.h"
#include "model/model.h"
#include "stepping/stepping.h"

#include "from_deck.h"

#include <stdlib.h>

static const char deck[] = "&scene dimension=3, end_time=2 /\n"
                           "&material name='m', density=1.3, lambda=1, mu=.8 /\n"
                           "&material name='n', density=1.1, lambda=.4, mu=.3 /\n"
                           "&body material='m', shape='box', low=-1,-1,0, high=1.5,1,1, spacing=.25 /\n"
                           "%s&boundary face='z+', kind='transmitting', layer='lysmer' /\n"
                           "&boundary face='y-', kind='roller' /\n"
                           "&method name='smoothed-point', variant='consistent', %s /\n"
                           "&load face='z-', shape='%s', %s direction=.2,-.5,1,\n"
                           "  history='gaussian', width=.3, delay=1, %s /\n"
                           "&load face='z-', shape='square', centre=.5,.5,0, size=.5,.5, direction=0,0,1,\n"
                           "  history='step' /\n";

struct run {
    struct from_deck from;
    struct model *model;
    struct stepper *stepper;
};

static void start(struct run *run, const char *layers, const char *method, const char *shape,
                  const char *size, const char *place)
{
    char text[2048];
    snprintf(text, sizeof text, deck, layers, method, shape, size, place);
    *run = (struct run){.from = right_scene(text)};
    assert_int_equal(model_create(run->from.scene, &run->model, &run->from.messages), SELAS_OK);
    assert_int_equal(stepper_create(run->model, &run->stepper, &run->from.messages), SELAS_OK);
}

static void finish(struct run *run)
{
    stepper_free(&run->stepper);
    model_free(&run->model);
    from_deck_free(&run->from);
}

/* Accelerations of the body at rest and powers on a made-up velocity. */
static double *forces(struct run *run, double time, double power[2])
{
    const struct model *model = run->model;
    const struct drive drive = driver_at(&run->stepper->driver, time);
    double *y = array_new(model->state_size, sizeof *y), *a = array_new(model->unknowns, sizeof *a);
    assert_non_null(y);
    assert_non_null(a);
    for (size_t i = 0; i < model->unknowns; i++)
        y[model->unknowns + i] = sin(.37 * (double)i);
    model->core->power(run->model, &drive, y, &power[0], &power[1]);
    model->spatial->accelerate(run->model, &drive, 0, y, NULL, a);
    array_free(y);
    return a;
}

/* Adds a weight times the forces of the patch at rest. */
static void add_resting(const char *const words[4], const double centre[2], double time, double weight,
                        double *sum, double *power)
{
    char place[128];
    struct run resting;
    double part[2];
    const double half[2] = {words[3][0] != '\0' ? .299 : 0, words[3][0] != '\0' ? .199 : 0};
    const bool beyond = fabs(centre[0] - .25) > 1.25 + half[0] || fabs(centre[1]) > 1 + half[1]; /* refused */
    snprintf(place, sizeof place, "amplitude=%g, centre=%.17g,%.17g,0", beyond ? 1e-300 : 2.5,
             beyond ? 0 : centre[0], beyond ? 0 : centre[1]);
    start(&resting, words[0], words[1], words[2], words[3], place);
    assert_true(resting.stepper->unwarp);
    double *a = forces(&resting, time, part);
    for (size_t k = 0; k < resting.model->unknowns; k++)
        sum[k] += weight * a[k];
    *power += weight * part[0];
    array_free(a);
    finish(&resting);
}

static void compare_along(const char *const words[4], double vx, double vy)
{
    /* across points, to and over the edge of the body at x = 1.5 */
    static const double times[] = {0, .8, 1.6};
    struct run moving;
    char way[128];
    double weight[MOVING_SHIFTS];
    moving_weights(weight);
    snprintf(way, sizeof way, "amplitude=2.5, centre=.9,.1,0, velocity=%g,%g,0", vx, vy);
    start(&moving, words[0], words[1], words[2], words[3], way);
    assert_false(moving.stepper->unwarp);
    const double lag = ((const struct consistent *)moving.model)->moving_load[0].lag;
    assert_true(lag > 0);
    for (size_t i = 0; i < sizeof times / sizeof *times; i++) {
        double *expected = array_new(moving.model->unknowns, sizeof *expected), power = 0, found_power[2],
               largest = 0;
        assert_non_null(expected);
        for (int j = 1 - MOVING_SHIFTS; j < MOVING_SHIFTS; j++) {
            const double t = times[i] + j * lag, centre[2] = {.9 + vx * t, .1 + vy * t};
            add_resting(words, centre, times[i], weight[abs(j)], expected, &power);
        }
        double *found = forces(&moving, times[i], found_power);
        for (size_t k = 0; k < moving.model->unknowns; k++)
            largest = fmax(largest, fabs(expected[k]));
        assert_true(largest > 0);
        for (size_t k = 0; k < moving.model->unknowns; k++)
            assert_near(found[k], expected[k], 1e-13 * largest);
        assert_near(found_power[0], power, 1e-11 * fabs(power));
        array_free(expected);
        array_free(found);
    }
    finish(&moving);
}

static void compare(const char *layers, const char *method, const char *shape, const char *size)
{
    const char *const words[4] = {layers, method, shape, size};
    compare_along(words, .45, -.1);
    compare_along(words, .45, 0);
}

/* Of a slow patch waves of 7.3 points and more pass, of 4.6 and less, which it would send back, do not. */
static void the_mean_passes_what_points_carry(void **unused)
{
    (void)unused;
    double weight[MOVING_SHIFTS];
    moving_weights(weight);
    for (double x = 0; x < 5; x += .01) { /* angular frequency times spacing over speed */
        double part = weight[0];
        for (int j = 1; j < MOVING_SHIFTS; j++)
            part += 2 * weight[j] * cos(x * 2 / 3 * j);
        if (x == 0) assert_near(part, 1, 1e-14);
        if (x < .86) assert_near(part, 1, .015);
        if (x > 1.366) assert_near(part, 0, .02);
    }
}

static void forces_follow_the_patch(void **unused)
{
    (void)unused;
    static const char layers[] = "&layer material='n', top=0 /\n&layer material='m', top=.4 /\n";
    static const char square[] = "size=.6,.4,";
    compare("&material name='n2', density=1, lambda=1, mu=1 /\n&layer material='n', top=.3 /\n"
            "&layer material='n2', top=.6 /\n",
            "degree=2, mass='vc3'", "square", square);
    compare(layers, "degree=2, mass='vc3'", "square", square);
    compare(layers, "degree=3, mass='exact'", "square", square);
    compare(layers, "degree=3, mass='exact'", "point", "");
    compare(layers, "degree=1, mass='vc1'", "point", "");
}

static void a_patch_that_has_left_pushes_no_more(void **unused)
{
    (void)unused;
    static const char layers[] = "&layer material='n', top=0 /\n&layer material='m', top=.4 /\n";
    struct run run;
    double power[2], power_later[2];
    start(&run, layers, "degree=2, mass='vc3'", "square", "size=.6,.4,",
          "amplitude=2.5, centre=-.3,.1,0, velocity=4,0,0");
    double *a = forces(&run, 1.2, power), *later = forces(&run, 1.4, power_later);
    for (size_t k = 0; k < run.model->unknowns; k++)
        assert_near(a[k], later[k], 0); /* only the resting step is left */
    assert_near(power[0], power_later[0], 0);
    array_free(a);
    array_free(later);
    finish(&run);
}

/* A block is the top of a plateau: the patch is slower than the Rayleigh waves there, or not. */
static void the_rock_is_that_below_the_patch(void **unused)
{
    (void)unused;
    static const char text[] =
        "&scene dimension=2, end_time=2 /\n&material name='m', density=1.2, p_speed=3, s_speed=1.7 /\n"
        "&material name='soft', density=.8, p_speed=1.4, s_speed=.7 /\n"
        "&body material='m', shape='box', low=-3,0, high=3,3, spacing=.25 /\n"
        "&topography shape='gaussian', height=.8, centre=0, width=1.5 /\n"
        "&block material='soft', shape='box', centre=0,-.6, size=20,.8 /\n"
        "&load face='y-', shape='point', centre=0,-.8, direction=0,1, velocity=%g,0, history='step' /\n";
    for (int fast = 0; fast < 2; fast++) {
        char full[1024];
        struct model *model = NULL;
        snprintf(full, sizeof full, text, fast == 1 ? .66 : .62);
        struct from_deck from = right_scene(full);
        assert_int_equal(model_create(from.scene, &model, &from.messages), SELAS_OK);
        assert_int_equal(((const struct consistent *)model)->moving_load[0].lag == 0, fast == 1);
        model_free(&model);
        from_deck_free(&from);
    }
}

static void what_cannot_move_is_refused(void **unused)
{
    (void)unused;
    static const char text[] =
        "&scene dimension=3, end_time=2 /\n&material name='m', density=1, lambda=1, mu=1 /\n"
        "&body material='m', shape='box', low=-1,-1,0, high=1,1,1, spacing=.25 /\n"
        "&load face='z-', shape='%s', centre=0,0,0, size=.5%s, direction=0,0,1, velocity=1,0,0, "
        "history='step' /\n"
        "&stepping scheme='%s' /\n";
    static const char *const cases[2][3] = {{"disc", "", "leapfrog"}, {"square", ",.5", "modified-equation"}};
    for (int i = 0; i < 2; i++) {
        char full[1024];
        struct model *model = NULL;
        struct stepper *stepper = NULL;
        snprintf(full, sizeof full, text, cases[i][0], cases[i][1], cases[i][2]);
        struct from_deck from = right_scene(full);
        selas_status status = model_create(from.scene, &model, &from.messages);
        if (status == SELAS_OK) status = stepper_create(model, &stepper, &from.messages);
        assert_int_equal(status, SELAS_UNSUPPORTED);
        assert_non_null(strstr(from.messages.text, "move"));
        stepper_free(&stepper);
        model_free(&model);
        from_deck_free(&from);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(forces_follow_the_patch),
        cmocka_unit_test(the_mean_passes_what_points_carry),
        cmocka_unit_test(a_patch_that_has_left_pushes_no_more),
        cmocka_unit_test(the_rock_is_that_below_the_patch),
        cmocka_unit_test(what_cannot_move_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
