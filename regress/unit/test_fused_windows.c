/* Windows of the fused operator (method/consistent/fused/active.h): fields that are 0 but in some places
 * against whole planes, to the bit; steps in one pass with and without parts at rest, and with what waves
 * have reached followed or looked for anew in each step, for sources in a corner, in the middle and in two
 * places. */
#include "few.h"
#include "stepped.h"

enum { SOURCES = 2 };

/* A wide box with faces drawn by chance. */
static void wide_scene(struct plain_scene *plain, bool layers, int long_axis, bool strata)
{
    static const enum boundary_kind kinds[] = {BOUNDARY_FREE, BOUNDARY_FIXED, BOUNDARY_ROLLER,
                                               BOUNDARY_SYMMETRY, BOUNDARY_TRANSMITTING};
    const size_t long_one = (size_t)few_of(60, 40), short_one = (size_t)few_of(12, 2);
    double size[3];
    for (int axis = 0; axis < 3; axis++)
        size[axis] = .3 * (double)(14 + chance(8) + (axis == long_axis ? long_one : short_one));
    plain_box(plain, 3, size, .3);
    for (int face = 0; face < 6; face++) {
        struct boundary *boundary = &plain->scene.boundary[face];
        boundary->kind = kinds[chance(layers ? 5 : 4)];
        if (boundary->kind != BOUNDARY_TRANSMITTING) continue;
        boundary->absorber = ABSORBER_PML;
        boundary->layer_points = 4 + (long)chance(4);
    }
    plain->scene.boundary[4].kind = BOUNDARY_FREE;
    struct load *load = plain_face_load(plain, FACE_Z_LOW, (double[]){.3, .5, 1});
    load->shape = LOAD_SQUARE;
    load->centre[0] = load->centre[1] = 1.4;
    load->size[0] = load->size[1] = .9;
    load->history = (struct history){.kind = HISTORY_STEP};
    if (strata) plain_strata(plain, .01 * (double)(10 + chance(30)), .01 * (double)(10 + chance(50)));
}

/* The same, drawn until steps in one pass serve it (layers' passes are not shared everywhere). */
static void one_pass_scene(struct plain_scene *plain, bool layers, int long_axis, bool strata)
{
    for (bool served = false; !served;) {
        wide_scene(plain, layers, long_axis, strata);
        struct model *model = make(plain, (struct consistent_options){.degree = 2, .sweeps = 3});
        served = model->one_pass != NULL;
        model_free(&model);
    }
}

/* Noise in some blocks of so many numbers; held values stay 0. */
static void blocks_of_noise(const struct consistent *c, size_t blocks, double *u)
{
    enum { SIDE = 4 };
    for (size_t block = 0; block < blocks; block++) {
        size_t at[3];
        for (int axis = 0; axis < 3; axis++)
            at[axis] = block == 0 && chance(3) == 0 ? 0 : chance(c->n[axis] - SIDE);
        for (size_t i = 0; i < 3 * SIDE * SIDE * SIDE; i++) {
            const size_t x = at[0] + i % SIDE, y = at[1] + i / SIDE % SIDE,
                         z = at[2] + i / SIDE / SIDE % SIDE;
            const size_t component = i / SIDE / SIDE / SIDE;
            u[component * c->volume + z * c->plane + y * c->n[0] + x] = (double)chance(1000) / 500 - 1;
        }
    }
    for (int component = 0; component < 3; component++)
        for (size_t k = 0; k < c->n[DEPTH]; k++)
            consistent_clear_held(c, component, k, u + (size_t)component * c->volume + k * c->plane);
}

static void test_same_bits(void **unused)
{
    (void)unused;
    size_t skipped = 0, points = 0;
    const int scenes = few_of(18, 3);
    for (int i = 0; i < scenes; i++) {
        struct plain_scene plain;
        wide_scene(&plain, false, i % 3, i % 4 == 3);
        struct consistent_options options = {
            .degree = 2, .sweeps = 1 + i / 3 % 3, .depth_exact = i % 2 == 0, .quiet = 1e-12};
        struct model *part = make(&plain, options);
        options.quiet = 0;
        struct model *whole = make(&plain, options);
        const size_t n = part->unknowns;
        double *u = array_new(n, sizeof *u), *a = array_new(n, sizeof *a), *b = array_new(n, sizeof *b);
        blocks_of_noise(consistent_of(part), 1 + (size_t)i % SOURCES, u);
        noise(n, a); /* all of it is to be set */
        part->spatial->accelerate(part, &(struct drive){0}, 0, u, NULL, a);
        whole->spatial->accelerate(whole, &(struct drive){0}, 0, u, NULL, b);
        size_t different = 0;
        for (size_t k = 0; k < n; k++)
            different += a[k] != b[k];
        assert_int_equal(different, 0);
        skipped += consistent_of(part)->fused->skipped;
        points += consistent_of(part)->fused->points;
        assert_int_equal(consistent_of(whole)->fused->skipped, 0);
        model_free(&part);
        model_free(&whole);
        array_free(u);
        array_free(a);
        array_free(b);
    }
    print_message("# %d scenes: %.0f %% of points skipped\n", scenes, 100 * (double)skipped / (double)points);
    assert_true(skipped > points / 4 && skipped < points);
}

/* A model that goes on from noise in some places, and from its load. */
static struct stepped started(const struct plain_scene *plain, struct consistent_options options, int sources)
{
    const uint64_t before = seed;
    struct stepped s = begin(plain, options, true, false);
    blocks_of_noise(consistent_of(s.model), (size_t)sources, s.state.y);
    if (sources > 0) s.stepper->scheme->start(s.stepper, &s.state);
    seed = before;
    return s;
}

static void settle(struct stepped *s)
{
    state_settle(s->stepper, &s->state, true);
}

/* Parts at rest left out, or not: differences of the size of what is left out. */
static void test_quiet(void **unused)
{
    (void)unused;
    double worst = 0;
    size_t skipped = 0, points = 0;
    const int scenes = few_of(8, 2);
    for (int i = 0; i < scenes; i++) {
        struct plain_scene plain;
        one_pass_scene(&plain, i % 2 == 1, i % 3, i % 4 > 1);
        struct consistent_options options = {
            .degree = 2, .sweeps = 1 + i / 2 % 3, .depth_exact = i % 4 < 2, .quiet = 1e-14};
        struct stepped part = started(&plain, options, i % (SOURCES + 1));
        options.quiet = 0;
        struct stepped whole = started(&plain, options, i % (SOURCES + 1));
        const size_t n = part.model->unknowns;
        for (int count = 0; count < 30; count++) {
            step(&part);
            step(&whole);
        }
        skipped += consistent_of(part.model)->fused->skipped;
        points += consistent_of(part.model)->fused->points;
        settle(&part);
        settle(&whole);
        worst = fmax(worst, difference(n, part.state.y, whole.state.y));
        worst = fmax(worst, difference(n, part.state.y + n, whole.state.y + n));
        worst = fmax(worst, difference(n, part.state.a, whole.state.a));
        end(&part);
        end(&whole);
    }
    print_message("# %d scenes, 30 steps: %.1e, %.0f %% of points skipped\n", scenes, worst,
                  100 * (double)skipped / (double)points);
    assert_true(worst < 1e-12);
    assert_true(skipped > points / 50);
}

/* Steps of two models; the second looks anew for what waves have reached. */
static void step_both(int steps, struct stepped *one, struct stepped *other)
{
    for (int count = 0; count < steps; count++) {
        size_t bytes = 0;
        other->model->one_pass->kept(other->model, &bytes);
        step(one);
        step(other);
    }
}

static void same_in_the_end(struct stepped *one, struct stepped *other)
{
    const size_t n = one->model->unknowns;
    settle(one);
    settle(other);
    assert_memory_equal(one->state.y, other->state.y, 2 * n * sizeof(double));
    assert_memory_equal(one->state.a, other->state.a, n * sizeof(double));
    end(one);
    end(other);
}

/* What waves have reached is followed from step to step, or looked for in each, as after a restart, with any
 * number of threads: the same bits. */
static void test_reached(void **unused)
{
    (void)unused;
    const int scenes = few_of(8, 2);
    for (int i = 0; i < scenes; i++) {
        struct plain_scene plain;
        one_pass_scene(&plain, i % 2 == 1, i % 3, i % 4 > 1);
        const struct consistent_options options = {.degree = 2,
                                                   .sweeps = 1 + i / 2 % 3,
                                                   .depth_exact = i % 4 < 2,
                                                   .quiet = 1e-12,
                                                   .single = i % 4 == 3};
        omp_set_num_threads(1);
        struct stepped one = started(&plain, options, i % (SOURCES + 1));
        omp_set_num_threads(1 + i % 4);
        struct stepped other = started(&plain, options, i % (SOURCES + 1));
        step_both(30, &one, &other);
        same_in_the_end(&one, &other);
    }
    omp_set_num_threads(1);
}

/* A source that begins when the wave of another is far, or when it has just come: what it touches counts as
 * reached, so that a run from a checkpoint goes the same way. Without the transform of loads, which lets a
 * little of each begin at once. */
static void test_late(void **unused)
{
    (void)unused;
    enum { STEPS = 45 };
    const int scenes = few_of(6, 1);
    for (int i = 0; i < scenes; i++) {
        struct plain_scene plain;
        one_pass_scene(&plain, i % 2 == 1, i % 3, i % 4 > 1);
        plain.scene.stepping.unwarp_given = true;
        struct load *late = plain_face_load(&plain, FACE_Z_LOW, (double[]){.2, -.4, 1});
        late->shape = LOAD_SQUARE;
        for (int axis = 0; axis < 2; axis++) {
            late->centre[axis] = plain.scene.body.high[axis] - 1.2;
            late->size[axis] = .9;
        }
        late->history = (struct history){.kind = HISTORY_GAUSSIAN, .width = .04, .delay = 1.7};
        plain.load[0].history = late->history;
        plain.load[0].history.delay = i < 3 ? .5 : 1.7;
        const struct consistent_options options = {.degree = 2, .sweeps = 3, .quiet = 1e-5};
        struct stepped one = started(&plain, options, 0), other = started(&plain, options, 0);
        step_both(STEPS, &one, &other);
        assert_false(one.stepper->unwarp);
        same_in_the_end(&one, &other);
    }
}

/* Layers along a long side, loud near one end of it: what they pull on beyond the window of their planes
 * counts as reached. */
static void test_layers_reach(void **unused)
{
    (void)unused;
    const int scenes = few_of(4, 1), steps = few_of(45, 15);
    for (int i = 0; i < scenes; i++) {
        const int along = i % 2, across = 1 - along;
        struct plain_scene plain;
        wide_scene(&plain, false, along, false);
        for (int face = 0; face < 6; face++)
            plain.scene.boundary[face].kind = face / 2 == along ? BOUNDARY_SYMMETRY : BOUNDARY_FREE;
        for (int axis = across; axis < 3; axis += 2 - across)
            plain.scene.boundary[2 * axis + 1] =
                (struct boundary){.kind = BOUNDARY_TRANSMITTING, .absorber = ABSORBER_PML, .layer_points = 5};
        plain.load[0].centre[across] = plain.scene.body.high[across] - 1.2;
        plain.scene.stepping.unwarp_given = true;
        plain.load[0].history = (struct history){.kind = HISTORY_GAUSSIAN, .width = .2, .delay = .6};
        const struct consistent_options options = {
            .degree = 2, .sweeps = 3, .depth_exact = true, .quiet = 1e-5, .single = i >= 2};
        struct stepped one = started(&plain, options, 0), other = started(&plain, options, 0);
        step_both(steps, &one, &other);
        same_in_the_end(&one, &other);
    }
}

/* A jump in u or v that ends some numbers before a layer, behind the surface or at the depth: in the first
 * steps velocities reach rows of the layer in which displacements still are 0. */
static void test_layers_wake(void **unused)
{
    (void)unused;
    enum { CELLS = 16, SIDE = 3 };
    const size_t step_of_gap = (size_t)few_of(2, 4);
    double worst = 0, least = 1;
    for (size_t axis = 0; axis < 3; axis++)
        for (size_t gap = 0; gap < 8; gap += step_of_gap) {
            struct plain_scene plain;
            plain_box(&plain, 3, (double[3]){CELLS, CELLS, CELLS}, 1);
            for (int face = 1; face < 6; face += 2)
                plain.scene.boundary[face] = (struct boundary){.kind = BOUNDARY_TRANSMITTING,
                                                               .absorber = ABSORBER_PML,
                                                               .layer_points = 5,
                                                               .always = true};
            const bool moves = gap / step_of_gap % 2 == 1;
            struct stepped s[2];
            double *end_of[2];
            for (int whole = 0; whole < 2; whole++) {
                const struct consistent_options options = {
                    .degree = 2, .sweeps = 2, .quiet = whole == 1 ? 0 : 1e-14};
                s[whole] = begin(&plain, options, true, false);
                const struct consistent *c = consistent_of(s[whole].model);
                double *field = s[whole].state.y + (moves ? s[whole].model->unknowns : 0);
                for (size_t i = 0; i < 3 * SIDE * SIDE * SIDE; i++) {
                    size_t at[3] = {6 + i % SIDE, 6 + i / SIDE % SIDE, 6 + i / SIDE / SIDE % SIDE};
                    at[axis] += CELLS - 6 - SIDE - gap;
                    field[i / SIDE / SIDE / SIDE * c->volume + at[2] * c->plane + at[1] * c->n[0] + at[0]] =
                        1 + (double)(i % 7);
                }
                s[whole].stepper->scheme->start(s[whole].stepper, &s[whole].state);
                for (int count = 0; count < 3; count++)
                    step(&s[whole]);
                settle(&s[whole]);
                end_of[whole] = s[whole].state.y;
                const size_t n = s[whole].model->unknowns, extra = s[whole].model->state_size - 2 * n;
                assert_true(extra > 0);
                if (whole == 0) continue;
                const double *memory[2] = {end_of[0] + 2 * n, end_of[1] + 2 * n};
                double largest = 0;
                for (size_t i = 0; i < extra; i++)
                    largest = fmax(largest, fabs(memory[1][i]));
                least = fmin(least, largest);
                worst = fmax(worst, difference(2 * n, end_of[0], end_of[1]));
                worst = fmax(worst, difference(extra, memory[0], memory[1]));
            }
            end(&s[0]);
            end(&s[1]);
        }
    print_message("# layers' memory of %.1e and more, differences %.1e\n", least, worst);
    assert_true(least > 1e-8);
    assert_true(worst < 1e-11);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_same_bits),    cmocka_unit_test(test_quiet),
        cmocka_unit_test(test_reached),      cmocka_unit_test(test_late),
        cmocka_unit_test(test_layers_reach), cmocka_unit_test(test_layers_wake),
    };
    omp_set_num_threads(1);
    seed_begin(5);
    return cmocka_run_group_tests_name("windows of the fused operator", tests, NULL, NULL);
}
