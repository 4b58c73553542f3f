/* The fused operator against the passes one by one (which test_hform holds against dense matrices): random
 * fields, even and layered ground, faces of all kinds, mirror planes, sizes down to the smallest, both masses over
 * depth, threads. */
#include "chance.h"
#include "consistent_run.h"

#include "method/consistent/fused/fused.h"

#include <omp.h>

/* Box with faces drawn by chance. */
static void random_scene(struct plain_scene *plain, double poisson)
{
    static const enum boundary_kind kinds[] = {BOUNDARY_FREE,     BOUNDARY_FIXED,        BOUNDARY_ROLLER,
                                               BOUNDARY_SYMMETRY, BOUNDARY_TRANSMITTING, BOUNDARY_VELOCITY};
    const double spacing = .3;
    double size[3];
    for (int axis = 0; axis < 3; axis++)
        size[axis] = spacing * (double)(12 + chance(15));
    plain_box(plain, 3, size, spacing);
    plain_material(&plain->material[0], 1.3, 2 * .9 * poisson / (1 - 2 * poisson), .9);
    for (int face = 0; face < 6; face++) {
        struct boundary *boundary = &plain->scene.boundary[face];
        boundary->kind = kinds[chance(sizeof kinds / sizeof kinds[0])];
        boundary->direction[face / 2] = 1;
        boundary->amplitude = 1;
    }
}

/* Strata of any thickness, also thinner than a cell; `bulk`: without mu. */
static void random_strata(struct plain_scene *plain, bool bulk)
{
    plain_strata(plain, .01 * (double)(1 + chance(50)), .01 * (double)(1 + chance(49)));
    for (int m = 0; m < PLAIN_MATERIALS && bulk; m++)
        plain_material(&plain->material[m], 1 + m, 2 - m, 0);
}

/* Largest difference of accelerations over the largest one; -1 if the scene is none for the fused operator.
 */
static double difference(const struct plain_scene *plain, struct consistent_options options)
{
    struct model *fused = make(plain, options);
    options.unfused = true;
    struct model *plainly = make(plain, options);
    const size_t n = fused->unknowns;
    double *u = calloc(n, sizeof *u), *v = calloc(n, sizeof *v);
    double *a = calloc(n, sizeof *a), *b = calloc(n, sizeof *b);
    noise(n, u);
    for (size_t i = 0; i < n; i++)
        v[i] = u[n - 1 - i];
    fused->spatial->accelerate(fused, &(struct drive){0}, .01, u, v, a);
    plainly->spatial->accelerate(plainly, &(struct drive){0}, .01, u, v, b);
    double error = 0, largest = 0;
    for (size_t i = 0; i < n; i++) {
        error = fmax(error, fabs(a[i] - b[i]));
        largest = fmax(largest, fabs(b[i]));
    }
    const bool used = consistent_of(fused)->fused != NULL;
    assert_null(consistent_of(plainly)->fused);
    model_free(&fused);
    model_free(&plainly);
    free(u);
    free(v);
    free(a);
    free(b);
    return used ? error / largest : -1;
}

static void test_random_scenes(void **state)
{
    (void)state;
    static const double ratios[] = {.1, .25, .45};
    enum { SCENES = 72 };
    double worst[2] = {0, 0}; /* even, layered */
    int served = 0;
    for (int i = 0; i < SCENES; i++) {
        struct plain_scene plain;
        random_scene(&plain, ratios[i % 3]);
        if (i >= 36) random_strata(&plain, i % 8 == 7);
        const struct consistent_options options = {
            .degree = 2, .sweeps = 1 + i / 2 % 3, .depth_exact = i % 2 == 0, .mapped = i % 5 == 4};
        const double error = difference(&plain, options);
        if (error < 0) { /* three sweeps may reach across the thinnest bodies */
            const double *high = plain.scene.body.high;
            assert_true(options.sweeps == 3 && fmin(high[0], fmin(high[1], high[2])) < .3 * 13.5);
            continue;
        }
        worst[i >= 36] = fmax(worst[i >= 36], error);
        served++;
    }
    print_message("# %d of %d scenes: %.1e, layered %.1e\n", served, SCENES, worst[0], worst[1]);
    assert_true(served > 48);
    assert_true(worst[0] < 5e-15);
    assert_true(worst[1] < 1e-14); /* moduli 1 : 2.7 over depth; N M of lambda + 2 mu is a sum */
}

/* Thin bodies and other degrees go on one by one; the narrowest that are fused are right. */
static void test_thin(void **state)
{
    (void)state;
    int used = 0;
    for (int cells = 4; cells < 20; cells++)
        for (int axis = 0; axis < 3; axis++) {
            struct plain_scene plain;
            double size[3] = {18, 17, 15};
            size[axis] = cells;
            plain_box(&plain, 3, size, 1);
            plain.scene.boundary[2 * axis].kind = BOUNDARY_SYMMETRY;
            const struct consistent_options options = {
                .degree = 2, .sweeps = 3, .depth_exact = cells % 2 == 0};
            const double error = difference(&plain, options);
            assert_true(error < 3e-15);
            assert_true((error >= 0) == (cells >= 13));
            used += error >= 0;
        }
    assert_true(used > 0);
    struct plain_scene plain;
    plain_box(&plain, 3, (double[3]){16, 16, 16}, 1);
    assert_true(difference(&plain, (struct consistent_options){.degree = 3, .sweeps = 1}) < 0);
}

static void test_threads(void **state)
{
    (void)state;
    struct plain_scene plain;
    plain_box(&plain, 3, (double[3]){19, 21, 30}, 1);
    const struct consistent_options options = {.degree = 2, .sweeps = 3, .depth_exact = true};
    double *result[2], *u = NULL;
    size_t n = 0;
    for (int i = 0; i < 2; i++) {
        omp_set_num_threads(i == 0 ? 1 : 3);
        struct model *model = make(&plain, options);
        assert_non_null(consistent_of(model)->fused);
        n = model->unknowns;
        if (u == NULL) u = calloc(n, sizeof *u);
        noise(n, u);
        result[i] = calloc(n, sizeof *u);
        model->spatial->accelerate(model, &(struct drive){0}, 0, u, NULL, result[i]);
        model_free(&model);
    }
    omp_set_num_threads(1);
    assert_memory_equal(result[0], result[1], n * sizeof *u);
    free(u);
    free(result[0]);
    free(result[1]);
}

/* A bump at one end of a long body, with and without the planes that it has not reached. */
static void test_quiet(void **state)
{
    (void)state;
    struct plain_scene plain;
    plain_box(&plain, 3, (double[3]){14, 14, 100}, 1);
    struct run run[2];
    for (int i = 0; i < 2; i++) {
        const struct consistent_options options = {
            .degree = 2, .sweeps = 3, .depth_exact = true, .quiet = i == 0 ? 1e-12 : 0};
        run[i] = run_new(&plain, options);
        const struct consistent *c = consistent_of(run[i].model);
        for (size_t k = 0; k < 20; k++)
            for (size_t p = 0; p < c->plane; p++)
                run[i].y[2 * c->volume + k * c->plane + p] = exp(-.1 * (double)(k * k + p % c->n[0]));
    }
    const size_t n = run[0].n;
    const struct fused *fused = consistent_of(run[0].model)->fused;
    double error = 0, largest = 0;
    size_t early = 0;
    for (int step = 0; step < 400; step++) {
        for (int i = 0; i < 2; i++)
            leap(&run[i], &(struct drive){0}, .2);
        if (step == 20) early = 100 * fused->skipped / fused->points;
        for (size_t i = 0; i < n; i++) {
            error = fmax(error, fabs(run[0].y[i] - run[1].y[i]));
            largest = fmax(largest, fabs(run[1].y[i]));
        }
    }
    print_message("# difference %.1e of the largest displacement, %.0f %% of points skipped\n",
                  error / largest, 100 * (double)fused->skipped / (double)fused->points);
    assert_true(error < 1e-12 * largest);
    assert_true(early > 33);
    assert_true(fused->skipped < fused->points / 2);
    assert_int_equal(consistent_of(run[1].model)->fused->skipped, 0);
    run_free(&run[0]);
    run_free(&run[1]);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_random_scenes),
        cmocka_unit_test(test_thin),
        cmocka_unit_test(test_threads),
        cmocka_unit_test(test_quiet),
    };
    omp_set_num_threads(1);
    seed_begin(11);
    return cmocka_run_group_tests_name("fused operator", tests, NULL, NULL);
}
