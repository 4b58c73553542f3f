/* Steps of leapfrog in one pass (method/consistent/fused/fused_step.h) against drift, operator and kick one
 * by one: whole states and what is looked at after each step, threads, settling, checkpoints' kept part,
 * planes at rest. */
#include "stepped.h"

/* A box with faces drawn by chance, and a load that begins at t = 0. */
static void drawn_scene(struct plain_scene *plain, bool layers, bool strata)
{
    static const enum boundary_kind kinds[] = {BOUNDARY_FREE, BOUNDARY_FIXED, BOUNDARY_ROLLER,
                                               BOUNDARY_SYMMETRY, BOUNDARY_TRANSMITTING};
    const double spacing = .3;
    double size[3];
    for (int axis = 0; axis < 3; axis++)
        size[axis] = spacing * (double)(17 + chance(10)); /* single precision takes 16 at least */
    size[2] += spacing * 20;
    plain_box(plain, 3, size, spacing);
    for (int face = 0; face < 6; face++) {
        struct boundary *boundary = &plain->scene.boundary[face];
        boundary->kind = kinds[chance(layers ? 5 : 4)];
        if (boundary->kind != BOUNDARY_TRANSMITTING) continue;
        boundary->absorber = ABSORBER_PML;
        boundary->layer_points = 4 + (long)chance(8);
        boundary->always = true;
    }
    plain->scene.boundary[4].kind = BOUNDARY_FREE;
    struct load *load = plain_face_load(plain, FACE_Z_LOW, (double[]){.3, .5, 1});
    load->shape = LOAD_SQUARE;
    load->centre[0] = load->centre[1] = 1.4;
    load->size[0] = 1.3;
    load->size[1] = .9;
    load->history = (struct history){.kind = HISTORY_STEP};
    if (strata) plain_strata(plain, .01 * (double)(1 + chance(50)), .01 * (double)(1 + chance(49)));
}

/* The same, drawn until it has steps in one pass, and layers if they are wanted. */
static void random_scene(struct plain_scene *plain, bool layers, bool strata)
{
    for (bool served = false; !served;) {
        drawn_scene(plain, layers, strata);
        struct model *model = make(plain, (struct consistent_options){.degree = 2, .sweeps = 3});
        served = model->one_pass != NULL && (consistent_of(model)->pml != NULL) == layers;
        model_free(&model);
    }
}

static void test_one_by_one(void **unused)
{
    (void)unused;
    double worst = 0, worst_seen = 0, worst_watched = 0;
    const int scenes = few_of(24, 8);
    for (int i = 0; i < scenes; i++) {
        struct plain_scene plain;
        random_scene(&plain, i % 2 == 1, i >= scenes / 2);
        const struct consistent_options options = {
            .degree = 2, .sweeps = 1 + i % 3, .depth_exact = i / 2 % 2 == 0, .quiet = i % 4 == 0 ? 0 : 1e-12};
        struct stepped one = begin(&plain, options, true, i % 3 != 0);
        struct stepped other = begin(&plain, options, false, i % 3 != 0);
        const size_t n = one.model->unknowns, extra = one.model->state_size - 2 * n;
        assert_true(i % 2 == 0 || extra > 0);
        for (int count = 0; count < 40; count++) {
            double a[VALUES], b[VALUES], settled[VALUES];
            observed(&one, a);
            observed(&other, b);
            for (size_t k = 0; k < 3; k++) /* u, v and a apart: their sizes differ */
                for (size_t place = 0; place < PLACES; place++)
                    worst_seen =
                        fmax(worst_seen, difference(3, a + 9 * place + 3 * k, b + 9 * place + 3 * k));
            if (count % 8 == 5) {
                state_settle(one.stepper, &one.state, true);
                observed(&one, settled);
                for (size_t k = 0; k < 3 * PLACES; k++)
                    worst_watched = fmax(worst_watched, difference(3, settled + 3 * k, a + 3 * k));
                worst = fmax(worst, difference(n, one.state.y, other.state.y));
                worst = fmax(worst, difference(n, one.state.y + n, other.state.y + n));
                worst = fmax(worst, difference(n, one.state.a, other.state.a));
                if (i % 3 != 0) /* (before waves come the memory is of the size of what is left out) */
                    worst = fmax(worst, difference(extra, one.state.y + 2 * n, other.state.y + 2 * n));
            }
            step(&one);
            step(&other);
        }
        end(&one);
        end(&other);
    }
    print_message("# %d scenes, 40 steps: states %.1e, receivers %.1e, settled %.1e\n", scenes, worst,
                  worst_seen, worst_watched);
    assert_true(worst < 1e-12);
    assert_true(worst_seen < 1e-11);
    assert_true(worst_watched < 1e-11);
}

/* Displacements or, with field 1, velocities that differ by the rounding of w half a step before and after. */
static double apart(const double *seen, const double *settled, size_t field, double dt)
{
    double error = 0, size = 0;
    for (size_t i = 0; i < 3; i++) {
        const double change = field == 1 ? dt / 2 * fabs(settled[3 + i]) : 0;
        error = fmax(error, fabs(seen[i] - settled[i]));
        size = fmax(size, fabs(settled[i]) + change);
    }
    return error / size;
}

static double largest_of(size_t n, const double *values)
{
    double largest = 0;
    for (size_t i = 0; i < n; i++)
        largest = fmax(largest, fabs(values[i]));
    return largest;
}

/* Rounding of the sums of a, and that of u (6e-7 of the largest, rms), which the fastest waves bring back as (2/dt)^2
 * times as much acceleration. */
static double allowed_of_a(const struct stepped *exact)
{
    const size_t n = exact->model->unknowns;
    const double dt = exact->stepper->dt;
    return 1e-5 + 6e-7 * 4 / (dt * dt) * largest_of(n, exact->state.y) / largest_of(n, exact->state.a);
}

/* Single precision against double: rounding of u, w and the operator's sums, and no more. What is looked at
 * is what settling gives but for the rounding of a = (w - w before) / dt. */
static void test_single(void **unused)
{
    (void)unused;
    double worst[3] = {0, 0, 0}, worst_settled = 0;
    const int scenes = few_of(12, 4);
    for (int i = 0; i < scenes; i++) {
        struct plain_scene plain;
        random_scene(&plain, i % 3 == 1, i >= scenes / 2);
        struct consistent_options options = {.degree = 2, .sweeps = 1 + i % 3, .quiet = 1e-12};
        struct stepped exact = begin(&plain, options, true, i % 2 != 0);
        options.single = true;
        struct stepped s = begin(&plain, options, true, i % 2 != 0);
        assert_true(s.model->single && !exact.model->single);
        const size_t n = s.model->unknowns;
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
            if (k % 3 != 2)
                worst_settled =
                    fmax(worst_settled, apart(seen + 3 * k, settled + 3 * k, k % 3, s.stepper->dt));
        for (size_t part = 0; part < 3; part++) {
            const double *one = part == 2 ? s.state.a : s.state.y + part * n;
            const double *other = part == 2 ? exact.state.a : exact.state.y + part * n;
            worst[part] =
                fmax(worst[part], difference(n, one, other) / (part < 2 ? 1 : allowed_of_a(&exact)));
        }
        end(&s);
        end(&exact);
    }
    print_message("# %d scenes, 60 steps: u %.1e, v %.1e, a %.2f of what is allowed; settled %.1e\n", scenes,
                  worst[0], worst[1], worst[2], worst_settled);
    /* a step rounds each u by 3e-8 of its size and the sums of a by as much again, the fastest waves double
     * what they are given: 6e-7 rms after 60 steps, largest of 10^4 values four to five times that */
    assert_true(worst[0] > 1e-8 && worst[0] < 1e-5);
    assert_true(worst[1] < 2e-5);
    assert_true(worst[2] < 1);
    assert_true(worst_settled < 1e-6);
}

static void some_skipped(const struct stepped *s)
{
    const struct fused *both = consistent_of(s->model)->fused;
    assert_true((s->model->single ? both->single : both)->skipped > 0);
}

static void same_bits(bool single, bool layers, bool strata)
{
    struct plain_scene plain;
    random_scene(&plain, layers, strata);
    plain.scene.body.high[2] = 60 * .3;
    assert_same_bits(&plain,
                     (struct consistent_options){.degree = 2, .sweeps = 3, .quiet = 1e-12, .single = single},
                     some_skipped);
}

static void test_bits(void **unused)
{
    (void)unused;
    same_bits(false, false, false);
    same_bits(true, true, false);
    same_bits(false, true, true);
    same_bits(true, false, true);
}

static void goes_on(bool single, bool layers, bool strata)
{
    struct plain_scene plain;
    random_scene(&plain, layers, strata);
    assert_goes_on(&plain,
                   (struct consistent_options){.degree = 2, .sweeps = 3, .quiet = 1e-12, .single = single});
}

static void test_kept(void **unused)
{
    (void)unused;
    goes_on(false, true, false);
    goes_on(true, false, false);
    goes_on(false, false, true);
    goes_on(true, true, true);
}

/* What a pass cannot do goes the old way, and in single precision not at all. */
static void test_refused(void **unused)
{
    (void)unused;
    struct consistent_options options = {.degree = 2, .sweeps = 3};
    for (int kind = 0; kind < 4; kind++) {
        struct plain_scene plain;
        plain_box(&plain, 3, (double[3]){16, 16, 16}, 1);
        if (kind == 0) plain.scene.boundary[1].kind = BOUNDARY_TRANSMITTING;
        if (kind == 1) plain.scene.boundary[1].kind = BOUNDARY_VELOCITY;
        if (kind == 1) plain.scene.boundary[1].amplitude = plain.scene.boundary[1].direction[0] = 1;
        options.dissipation = kind == 2 ? .01 : 0;
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
        options.single = false;
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_one_by_one), cmocka_unit_test(test_single),  cmocka_unit_test(test_bits),
        cmocka_unit_test(test_kept),       cmocka_unit_test(test_refused),
    };
    omp_set_num_threads(1);
    seed_begin(5);
    return cmocka_run_group_tests_name("steps in one pass", tests, NULL, NULL);
}
