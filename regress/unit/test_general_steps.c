/* Steps of leapfrog of the general operator by sweeps (method/consistent/general/sweep.h) against drift, operator and
 * kick one by one: whole states and what is looked at after each step, threads, what is kept, what is refused. */
#include "stepped.h"

#include "method/consistent/general/sweep.h"
#include "scene/grading.h"
#include "scene/topography.h"

static struct consistent_options general(void)
{
    return (struct consistent_options){
        .degree = 2, .sweeps = 3, .depth_exact = true, .general = true, .quiet = 1e-12};
}

/* Absorbing layers of all thicknesses behind faces drawn by chance, one of x, y and depth at least. */
static void lay_layers(struct plain_scene *plain, bool hilly)
{
    const size_t sure = chance(3);
    for (size_t face = 0; face < 6; face++) {
        if ((face != 2 * sure + 1 && chance(2) == 0) || (face == FACE_Z_LOW && hilly)) continue;
        plain->scene.boundary[face] = (struct boundary){.kind = BOUNDARY_TRANSMITTING,
                                                        .absorber = ABSORBER_PML,
                                                        .layer_points = 4 + (long)chance(8),
                                                        .always = true};
    }
}

/* A box with faces drawn by chance, of one rock or of two that meet at a tilted face, below a hill or not (of two and
 * below one the spacing is graded), with layers or none, and a load that begins at t = 0. */
static void drawn_scene(struct plain_scene *plain, struct topography *hill, bool hilly, bool rocks,
                        bool layers)
{
    static const enum boundary_kind kinds[] = {BOUNDARY_FREE, BOUNDARY_FIXED, BOUNDARY_ROLLER,
                                               BOUNDARY_SYMMETRY};
    const double spacing = .3;
    double size[3];
    for (int axis = 0; axis < 3; axis++)
        size[axis] = spacing * (double)(17 + chance(10)); /* single precision takes 16 at least */
    size[2] += spacing * 4;
    plain_box(plain, 3, size, spacing);
    for (int face = 0; face < 6; face++)
        plain->scene.boundary[face].kind = kinds[chance(4)];
    plain->scene.boundary[4].kind = chance(3) == 0 ? BOUNDARY_SYMMETRY : BOUNDARY_FREE;
    if (hilly) plain->scene.boundary[4].kind = BOUNDARY_FREE;
    if (layers) lay_layers(plain, hilly);
    plain->scene.body.layers = rocks ? 2 : 0;
    plain->layer[0] = (struct layer){.material = 0};
    plain->layer[1] = (struct layer){.material = 1, .top = .8, .slope = {.2, .1}};
    *hill = (struct topography){.shape = TOPOGRAPHY_GAUSSIAN, .width = .8, .height = .5, .across = {1, 0}};
    hill->axis = 2;
    hill->centre[0] = hill->centre[1] = 1.6;
    hill->depth = 12 * spacing;
    if (hilly) plain->scene.body.topography = hill;
    if (hilly && rocks) {
        plain->scene.body.most_stretch = 3;
        assert_int_equal(scene_grade(&plain->scene), SELAS_OK);
    }
    struct load *load = plain_face_load(plain, FACE_Z_LOW, (double[]){.3, .5, 1});
    load->shape = LOAD_SQUARE;
    load->centre[0] = load->centre[1] = 1.4;
    load->size[0] = 1.3;
    load->size[1] = .9;
    load->history = (struct history){.kind = HISTORY_STEP};
}

/* u, v, the layers' memory and a of two settled states. */
enum { MEMORY = 2, ACCELERATION, PARTS };
static void compare(const struct stepped *one, const struct stepped *other, double worst[PARTS])
{
    const size_t n = one->model->unknowns, extra = one->model->state_size - 2 * n;
    for (size_t part = 0; part < PARTS; part++) {
        const bool last = part == ACCELERATION;
        worst[part] = fmax(worst[part], difference(part == MEMORY ? extra : n,
                                                   last ? one->state.a : one->state.y + part * n,
                                                   last ? other->state.a : other->state.y + part * n));
    }
}

static void assert_one_by_one(bool layers)
{
    double worst[PARTS] = {0}, seen = 0, watched = 0;
    const int scenes = few_of(8, 2);
    for (int i = 0; i < scenes; i++) {
        struct plain_scene plain;
        struct topography hill;
        drawn_scene(&plain, &hill, i % 2 == 1, i % 4 == 0 || i % 4 == 3, layers);
        struct consistent_options options = general();
        options.quiet = i % 4 < 2 ? 0 : 1e-15; /* what is left out differs: rows within reach of others */
        struct stepped one = begin(&plain, options, true, i % 3 != 0);
        struct stepped other = begin(&plain, options, false, i % 3 != 0);
        for (int count = 0; count < 40; count++) {
            double a[VALUES], b[VALUES], settled[VALUES];
            observed(&one, a);
            observed(&other, b);
            for (size_t k = 0; k < 3 * PLACES && options.quiet == 0;
                 k++) /* before waves come they may be all quiet */
                seen = fmax(seen, difference(3, a + 3 * k, b + 3 * k));
            if (count % 8 == 5) {
                state_settle(one.stepper, &one.state, true);
                observed(&one, settled);
                for (size_t k = 0; k < 3 * PLACES; k++)
                    watched = fmax(watched, difference(3, settled + 3 * k, a + 3 * k));
                compare(&one, &other, worst);
            }
            step(&one);
            step(&other);
        }
        end(&one);
        end(&other);
        grading_free(plain.scene.body.grading);
    }
    print_message(
        "# %d scenes, 40 steps: u %.1e, v %.1e, memory %.1e, a %.1e, receivers %.1e, settled %.1e\n", scenes,
        worst[0], worst[1], worst[2], worst[3], seen, watched);
    for (size_t part = 0; part < PARTS; part++)
        assert_true(worst[part] < 1e-12);
    assert_true(seen < 1e-11);
    assert_true(watched < 1e-11);
}

static void test_one_by_one(void **unused)
{
    (void)unused;
    assert_one_by_one(false);
}

/* Layers of faces that no wave leaves by damp velocities besides; those of other scenes do not. */
static void test_layers_one_by_one(void **unused)
{
    (void)unused;
    assert_one_by_one(true);
}

/* Single precision against double: rounding of u, w and the operator's sums, and no more. */
static void assert_single(bool layers)
{
    double worst[PARTS] = {0}, watched = 0;
    const int scenes = few_of(4, 2);
    for (int i = 0; i < scenes; i++) {
        struct plain_scene plain;
        struct topography hill;
        drawn_scene(&plain, &hill, i % 2 == 1, i % 4 == 0 || i % 4 == 3, layers);
        struct consistent_options options = general();
        struct stepped exact = begin(&plain, options, true, i % 3 != 0);
        options.single = true;
        struct stepped s = begin(&plain, options, true, i % 3 != 0);
        assert_true(s.model->single && !exact.model->single);
        double seen[VALUES], settled[VALUES];
        for (int count = 0; count < 60; count++) {
            step(&s);
            step(&exact);
        }
        observed(&s, seen);
        state_settle(s.stepper, &s.state, true);
        state_settle(exact.stepper, &exact.state, true);
        observed(&s, settled);
        for (size_t k = 0; k < 3 * PLACES; k++)
            if (k % 3 != 2) watched = fmax(watched, difference(3, seen + 3 * k, settled + 3 * k));
        const double before = worst[ACCELERATION];
        compare(&s, &exact, worst);
        if (i % 3 == 0)
            worst[ACCELERATION] = before; /* a is small beside the frequencies that round u: waves are long */
        end(&s);
        end(&exact);
        grading_free(plain.scene.body.grading);
    }
    print_message("# %d scenes, 60 steps: u %.1e, v %.1e, memory %.1e, a %.1e; settled %.1e\n", scenes,
                  worst[0], worst[1], worst[MEMORY], worst[ACCELERATION], watched);
    assert_true(worst[0] > 1e-8 && worst[0] < 1e-5); /* as the fused operator's (test_fused_step) */
    /* The plain kind rounds products as well as sums. */
    const double rounding = processor_taken() == PROCESSOR_PLAIN ? sqrt(2) * 2e-5 : 2e-5;
    assert_true(worst[1] < rounding);
    assert_true(worst[MEMORY] < rounding);
    assert_true(worst[ACCELERATION] < rounding);
    assert_true(watched < 1e-6);
}

static void test_single(void **unused)
{
    (void)unused;
    assert_single(false);
}

static void test_layers_single(void **unused)
{
    (void)unused;
    assert_single(true);
}

static void test_bits(void **unused)
{
    (void)unused;
    for (int kind = 0; kind < 4; kind++) {
        struct plain_scene plain;
        struct topography hill;
        struct consistent_options options = general();
        const bool single = kind % 2 == 1;
        drawn_scene(&plain, &hill, !single, false, kind > 1);
        plain.scene.body.high[2] = 40 * .3;
        options.single = single;
        assert_same_bits(&plain, options, NULL);
    }
}

static void test_kept(void **unused)
{
    (void)unused;
    for (int kind = 0; kind < 4; kind++) {
        struct plain_scene plain;
        struct topography hill;
        struct consistent_options options = general();
        drawn_scene(&plain, &hill, true, false, kind > 1);
        options.single = kind % 2 == 1;
        assert_goes_on(&plain, options);
    }
}

/* What a sweep cannot do goes the old way, and in single precision not at all. */
static void test_refused(void **unused)
{
    (void)unused;
    for (int kind = 0; kind < 4; kind++) {
        struct plain_scene plain;
        struct consistent_options options = general();
        plain_box(&plain, kind == 0 ? 2 : 3, (double[3]){16, 16, kind == 1 ? 4 : 16}, 1);
        if (kind == 2) plain.scene.boundary[1].kind = BOUNDARY_TRANSMITTING;
        options.unfused = kind == 3;
        struct model *model = make(&plain, options);
        assert_null(model->one_pass);
        model_free(&model);
        struct messages messages = {0};
        options.single = true;
        assert_int_equal(consistent_create_with(&plain.scene, &options, &model, &messages),
                         SELAS_UNSUPPORTED);
        assert_non_null(strstr(messages.text, "precision"));
        messages_free(&messages);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_one_by_one), cmocka_unit_test(test_layers_one_by_one),
        cmocka_unit_test(test_single),     cmocka_unit_test(test_layers_single),
        cmocka_unit_test(test_bits),       cmocka_unit_test(test_kept),
        cmocka_unit_test(test_refused),
    };
    omp_set_num_threads(1);
    seed_begin(5);
    return cmocka_run_group_tests_name("steps of the general operator", tests, NULL, NULL);
}
