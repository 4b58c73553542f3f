/* The shared passes of absorbing layers (pml_fast.h) against the passes one by one, which test_pml holds
 * against large boxes: random scenes marched from noise, with layers of all thicknesses behind some faces and
 * other faces of all kinds, both masses over depth, threads. */
#include "chance.h"
#include "consistent_run.h"
#include "few.h"

#include "method/consistent/absorbing/pml_fast.h"

#include <omp.h>

/* Box with faces drawn by chance, the one given with a layer. */
static void random_scene(struct plain_scene *plain, int layered, double poisson)
{
    static const enum boundary_kind kinds[] = {BOUNDARY_FREE,        BOUNDARY_FIXED,    BOUNDARY_ROLLER,
                                               BOUNDARY_SYMMETRY,    BOUNDARY_VELOCITY, BOUNDARY_TRANSMITTING,
                                               BOUNDARY_TRANSMITTING};
    const double spacing = .3;
    double size[3];
    for (int axis = 0; axis < 3; axis++)
        size[axis] = spacing * (double)(14 + chance(8));
    plain_box(plain, 3, size, spacing);
    plain_material(&plain->material[0], 1.3, 2 * .9 * poisson / (1 - 2 * poisson), .9);
    for (int face = 0; face < 6; face++) {
        struct boundary *boundary = &plain->scene.boundary[face];
        boundary->kind =
            face == layered ? BOUNDARY_TRANSMITTING : kinds[chance(sizeof kinds / sizeof kinds[0])];
        boundary->direction[face / 2] = 1;
        boundary->amplitude = 1;
        if (boundary->kind != BOUNDARY_TRANSMITTING || (face != layered && chance(3) == 0)) continue;
        boundary->absorber = ABSORBER_PML;
        boundary->layer_points = 4 + (long)chance(10);
    }
}

/* Steps from noise, with the scheme of test_pml. */
static struct run marched(const struct plain_scene *plain, struct consistent_options options, int steps)
{
    struct run run = {.model = make(plain, options)};
    const double dt = .25 * .3 / plain->material[0].p_speed;
    run.n = run.model->unknowns;
    run.y = calloc(run.model->state_size, sizeof *run.y);
    run.a = calloc(run.n, sizeof *run.a);
    noise(run.n, run.y);
    const struct consistent *c = consistent_of(run.model);
    for (int component = 0; component < 3; component++)
        for (size_t k = 0; k < c->n[DEPTH]; k++)
            consistent_clear_held(c, component, k, run.y + (size_t)component * c->volume + k * c->plane);
    for (int step = 0; step < steps; step++)
        leap(&run, &(struct drive){.extra = run.y + 2 * run.n}, dt);
    return run;
}

static double difference(const struct plain_scene *plain, struct consistent_options options, bool *shared)
{
    struct run fast = marched(plain, options, 24);
    options.unfused = true;
    struct run plainly = marched(plain, options, 24);
    double error = 0, largest = 0;
    for (size_t i = fast.n; i < 2 * fast.n; i++) {
        error = fmax(error, fabs(fast.y[i] - plainly.y[i]));
        largest = fmax(largest, fabs(plainly.y[i]));
    }
    /* Nothing pulls where values are held. */
    const struct consistent *c = consistent_of(fast.model);
    memset(fast.a, 0, fast.n * sizeof *fast.a);
    pml_accelerate(c, 1, fast.y + 2 * fast.n, fast.a);
    memcpy(plainly.a, fast.a, fast.n * sizeof *fast.a);
    for (int component = 0; component < 3; component++)
        for (size_t k = 0; k < c->n[DEPTH]; k++)
            consistent_clear_held(c, component, k, fast.a + (size_t)component * c->volume + k * c->plane);
    assert_memory_equal(fast.a, plainly.a, fast.n * sizeof *fast.a);
    *shared = consistent_of(fast.model)->pml->fast != NULL;
    assert_null(consistent_of(plainly.model)->pml->fast);
    run_free(&fast);
    run_free(&plainly);
    return error / largest;
}

static void test_random_scenes(void **state)
{
    (void)state;
    static const double ratios[] = {.1, .25, .45};
    double worst = 0;
    const int scenes = few_of(24, 6);
    for (int i = 0; i < scenes; i++) {
        struct plain_scene plain;
        bool shared;
        random_scene(&plain, i % 6, ratios[i % 3]);
        const struct consistent_options options = {
            .degree = 2, .sweeps = 1 + i / 6 % 3, .depth_exact = i % 2 == 0, .mapped = i % 5 == 4};
        const double error = difference(&plain, options, &shared);
        assert_true(shared);
        worst = fmax(worst, error);
    }
    print_message("# %d scenes, velocities after 24 steps: %.1e\n", scenes, worst);
    assert_true(worst < 2e-14);
}

/* Three strata of any thickness, also thinner than a cell and nearer to the layers than these reach. */
static void test_layered_ground(void **state)
{
    (void)state;
    double worst = 0;
    const int scenes = few_of(18, 6);
    for (int i = 0; i < scenes; i++) {
        struct plain_scene plain;
        bool shared;
        random_scene(&plain, i % 6, .25);
        plain_material(&plain.material[1], .8, .7, .3 + .1 * (double)chance(5));
        plain_strata(&plain, .01 * (double)(1 + chance(50)), .01 * (double)(1 + chance(49)));
        const struct consistent_options options = {.degree = 2, .sweeps = 1 + i / 6 % 3, .quiet = 0};
        const double error = difference(&plain, options, &shared);
        assert_true(shared);
        worst = fmax(worst, error);
    }
    print_message("# %d scenes of layered ground, velocities after 24 steps: %.1e\n", scenes, worst);
    assert_true(worst < 2e-14);
}

/* A body so thin that the layer's region reaches its other face, one that is not fused, and other degrees:
 * one by one. */
static void test_others(void **state)
{
    (void)state;
    struct plain_scene plain;
    bool shared;
    for (int kind = 0; kind < 3; kind++) {
        plain_box(&plain, 3, (double[3]){15, 15, kind == 0 ? 5 : kind == 1 ? 6 : 15}, 1);
        plain.scene.boundary[FACE_Z_HIGH] = (struct boundary){
            .kind = BOUNDARY_TRANSMITTING, .absorber = ABSORBER_PML, .layer_points = kind == 1 ? 4 : 8};
        const struct consistent_options options = {.degree = kind == 2 ? 3 : 2, .sweeps = kind == 2 ? 0 : 3};
        struct run run = marched(&plain, options, 1);
        shared = consistent_of(run.model)->pml->fast != NULL;
        assert_false(shared);
        run_free(&run);
    }
}

static double worst_of(size_t n, const double *exact, const float *value)
{
    double error = 0, largest = 0;
    for (size_t i = 0; i < n; i++) {
        error = fmax(error, fabs(exact[i] - (double)value[i]));
        largest = fmax(largest, fabs(exact[i]));
    }
    return error / largest;
}

/* The same in single precision: memory after some steps of a field that does not rest, and what it does; from
 * the start of a step as from its end. */
static void test_single(void **state)
{
    (void)state;
    double worst = 0;
    int served = 0;
    const int scenes = few_of(8, 2);
    for (int scene = 0; served < scenes && scene < 400; scene++) {
        struct plain_scene plain;
        random_scene(&plain, scene, .25);
        for (int face = 0; face < 6; face++) { /* what steps in single precision do not have */
            struct boundary *boundary = &plain.scene.boundary[face];
            const bool damped =
                boundary->kind == BOUNDARY_TRANSMITTING && boundary->absorber == ABSORBER_LYSMER;
            if (damped || boundary->kind == BOUNDARY_VELOCITY) boundary->kind = BOUNDARY_FREE;
        }
        const struct consistent_options options = {
            .degree = 2, .sweeps = 3, .depth_exact = scene % 2 == 0, .single = true};
        struct model *made = NULL;
        struct messages messages = {0};
        const selas_status status = consistent_create_with(&plain.scene, &options, &made, &messages);
        messages_free(&messages);
        if (status != SELAS_OK) continue; /* layers that damp velocities besides */
        const bool fit = consistent_of(made)->pml != NULL;
        model_free(&made);
        if (!fit) continue;
        served++;
        struct run run = marched(&plain, options, 0);
        struct consistent *c = consistent_of(run.model);
        const size_t extra = run.model->state_size - 2 * run.n;
        double *u = run.y, *v = u + run.n, *memory = v + run.n, dt = .02;
        float *u4 = calloc(run.n, sizeof *u4), *v4 = calloc(run.n, sizeof *v4),
              *a4 = calloc(run.n, sizeof *a4);
        float *memory4 = calloc(extra, sizeof *memory4);
        assert_non_null(c->pml->single);
        for (int step = 0; step < 12; step++) {
            for (size_t i = 0; i < run.n; i++) {
                u4[i] = (float)(u[i] = sin((double)(i * (size_t)(step + 3))));
                v4[i] = (float)(v[i] = cos((double)(i * (size_t)(step + 5))));
            }
            pml_remember(c, dt, -dt / 2, u, v, memory);
            for (size_t i = 0; i < run.n; i++)
                u4[i] -= (float)dt * v4[i];
            pml_fast_remember_single(c, dt, dt / 2, pml_fast_quiet_single(c, u4), u4, v4, memory4);
        }
        pml_accelerate(c, .7, memory, run.a);
        pml_fast_accelerate_single(c, .7, memory4, a4);
        worst = fmax(worst, fmax(worst_of(extra, memory, memory4), worst_of(run.n, run.a, a4)));
        run_free(&run);
        free(u4);
        free(v4);
        free(a4);
        free(memory4);
    }
    print_message("# single precision, %d scenes: %.1e\n", served, worst);
    assert_int_equal(served, scenes);
    assert_true(worst < 2e-6);
}

/* A bump at one end of a long body with layers along it and at its ends, with and without the rows that it
 * has not reached. */
static void test_quiet(void **state)
{
    (void)state;
    struct plain_scene plain;
    struct run run[2];
    unsigned long early = 0, all = 0;
    double error = 0, largest = 0;
    plain_box(&plain, 3, (double[3]){14, 14, 70}, 1);
    for (int face = 0; face < 6; face++)
        if (face != FACE_Y_LOW)
            plain.scene.boundary[face] =
                (struct boundary){.kind = BOUNDARY_TRANSMITTING, .absorber = ABSORBER_PML, .layer_points = 6};
    for (int i = 0; i < 2; i++) {
        const struct consistent_options options = {
            .degree = 2, .sweeps = 3, .depth_exact = true, .quiet = i == 0 ? 1e-12 : 0};
        run[i] = marched(&plain, options, 0);
        const struct consistent *c = consistent_of(run[i].model);
        memset(run[i].y, 0, run[i].n * sizeof *run[i].y);
        for (size_t k = 0; k < 20; k++)
            for (size_t p = 0; p < c->plane; p++)
                run[i].y[2 * c->volume + k * c->plane + p] =
                    exp(-.1 * (double)(k * k) - .02 * pow((double)(p % c->n[0]) - 10, 2));
    }
    const size_t n = run[0].n;
    const struct pml_fast *fast = consistent_of(run[0].model)->pml->fast;
    const int steps = few_of(300, 60);
    for (int step = 0; step < steps; step++) {
        for (int i = 0; i < 2; i++)
            leap(&run[i], &(struct drive){.extra = run[i].y + 2 * n}, .2);
        if (step == 20) early = fast->skipped;
        if (step == 20) all = fast->groups;
        for (size_t i = 0; i < n; i++) {
            error = fmax(error, fabs(run[0].y[i] - run[1].y[i]));
            largest = fmax(largest, fabs(run[1].y[i]));
        }
    }
    print_message("# difference %.1e of the largest displacement; skipped: %lu of %lu, first %lu of %lu\n",
                  error / largest, fast->skipped, fast->groups, early, all);
    assert_true(error > 0);
    assert_true(error < 1e-12 * largest);
    assert_true(early > all / 4);
    assert_true(fast->skipped < fast->groups / 2);
    assert_int_equal(consistent_of(run[1].model)->pml->fast->skipped, 0);
    run_free(&run[0]);
    run_free(&run[1]);
}

static void test_threads(void **state)
{
    (void)state;
    struct plain_scene plain;
    struct run run[2];
    random_scene(&plain, FACE_X_HIGH, .25);
    plain.scene.boundary[FACE_Y_HIGH] = plain.scene.boundary[FACE_Z_HIGH] = plain.scene.boundary[FACE_X_HIGH];
    const struct consistent_options options = {.degree = 2, .sweeps = 3, .depth_exact = true};
    for (int i = 0; i < 2; i++) {
        omp_set_num_threads(i == 0 ? 1 : 3);
        run[i] = marched(&plain, options, 12);
    }
    omp_set_num_threads(1);
    assert_non_null(consistent_of(run[0].model)->pml->fast);
    assert_int_equal(consistent_of(run[1].model)->threads, 3);
    assert_memory_equal(run[0].y, run[1].y, run[0].model->state_size * sizeof(double));
    run_free(&run[0]);
    run_free(&run[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random_scenes), cmocka_unit_test(test_layered_ground),
        cmocka_unit_test(test_others),        cmocka_unit_test(test_single),
        cmocka_unit_test(test_quiet),         cmocka_unit_test(test_threads)};
    omp_set_num_threads(1);
    seed_begin(5);
    return cmocka_run_group_tests_name("shared passes of absorbing layers", tests, NULL, NULL);
}
