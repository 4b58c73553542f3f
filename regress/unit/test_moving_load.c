/* Moving patches in the consistent method: at any time their forces are those of a patch at rest where the
 * moving one then is; stepping does not un-warp them. */
#include "base/memory.h"
#include "method/methods.h"
#include "model/model.h"
#include "stepping/stepping.h"

#include "from_deck.h"

static const char deck[] = "&scene dimension=3, end_time=2 /\n"
                           "&material name='m', density=1.3, lambda=1, mu=.8 /\n"
                           "&material name='n', density=1.1, lambda=.4, mu=.3 /\n"
                           "&body material='m', shape='box', low=-1,-1,0, high=1.5,1,1, spacing=.25 /\n"
                           "%s&boundary face='z+', kind='transmitting', layer='lysmer' /\n"
                           "&boundary face='y-', kind='roller' /\n"
                           "&method name='smoothed-point', variant='consistent', %s /\n"
                           "&load face='z-', shape='%s', %s direction=.2,-.5,1, amplitude=2.5,\n"
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

static void compare(const char *layers, const char *method, const char *shape, const char *size)
{
    /* from the middle across points, to and over the edge of the body at x = 1.5, and far beyond it */
    static const double times[] = {0, .31, .8, 1.37, 1.6};
    struct run moving;
    start(&moving, layers, method, shape, size, "centre=-.3,.1,0, velocity=1.1,-.2,0");
    assert_false(moving.stepper->unwarp);
    for (size_t i = 0; i < sizeof times / sizeof *times; i++) {
        char place[128];
        struct run resting;
        double power[2][2], largest = 0;
        snprintf(place, sizeof place, "centre=%.17g,%.17g,0", -.3 + 1.1 * times[i], .1 - .2 * times[i]);
        start(&resting, layers, method, shape, size, place);
        assert_true(resting.stepper->unwarp);
        double *expected = forces(&resting, times[i], power[0]), *found = forces(&moving, times[i], power[1]);
        for (size_t k = 0; k < moving.model->unknowns; k++)
            largest = fmax(largest, fabs(expected[k]));
        assert_true(largest > 0);
        for (size_t k = 0; k < moving.model->unknowns; k++)
            assert_near(found[k], expected[k], 1e-13 * largest);
        assert_near(power[1][0], power[0][0], 1e-12 * fabs(power[0][0]));
        array_free(expected);
        array_free(found);
        finish(&resting);
    }
    finish(&moving);
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
    start(&run, layers, "degree=2, mass='vc3'", "square", "size=.6,.4,", "centre=-.3,.1,0, velocity=4,0,0");
    double *a = forces(&run, .9, power), *later = forces(&run, 1.1, power_later);
    for (size_t k = 0; k < run.model->unknowns; k++)
        assert_near(a[k], later[k], 0); /* only the resting step is left */
    assert_near(power[0], power_later[0], 0);
    array_free(a);
    array_free(later);
    finish(&run);
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
        cmocka_unit_test(a_patch_that_has_left_pushes_no_more),
        cmocka_unit_test(what_cannot_move_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
