/* The fast paths of total-Lagrangian SPH: runs of lattice points summed eight at a time give what the same
 * points give one at a time, in every dimension, degree and law; points that share a row of weights give what
 * they give with rows of their own; and any number of threads gives the same bits. */
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

#include "base/memory.h"
#include "box_scene.h"
#include "few.h"
#include "method/total_lagrangian/total_lagrangian.h"
#include "stepping/stepping.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <string.h>

static struct tl_model *make(const struct scene *scene, const struct tl_options *options)
{
    struct messages messages = {0};
    struct model *model = NULL;
    if (total_lagrangian_create(scene, options, &model, &messages) != SELAS_OK) fail_msg("%s", messages.text);
    messages_free(&messages);
    return (struct tl_model *)model;
}

/* Smooth, with some noise of its own at each point. */
static void displace(const struct tl_model *tl, double *y)
{
    const size_t d = (size_t)tl->cloud->dimension;
    for (size_t i = 0; i < tl->model.points; i++)
        for (size_t a = 0; a < d; a++) {
            const double *x = tl->model.position + 3 * i;
            const double phase = 3 * x[0] + 2 * x[1] - x[2] + (double)a;
            y[d * i + a] = .01 * sin(phase) + 1e-3 * sin((double)(7919 * i % 1009 + a));
            y[tl->model.unknowns + d * i + a] = cos(phase);
        }
}

static double *acceleration(struct tl_model *tl)
{
    double *y = array_new(tl->model.state_size, sizeof *y), *a = array_new(tl->model.unknowns, sizeof *a);
    const struct drive none = {0};
    assert_true(y != NULL && a != NULL);
    displace(tl, y);
    tl->model.spatial->accelerate(&tl->model, &none, 0, y, y + tl->model.unknowns, a);
    array_free(y);
    return a;
}

static size_t in_runs(const struct tl_blocks *blocks)
{
    size_t points = 0;
    for (size_t k = 0; k < blocks->count; k++)
        points += blocks->block[k].run ? blocks->block[k].count : 0;
    return points;
}

static void take_apart(struct tl_blocks *blocks)
{
    for (size_t k = 0; k < blocks->count; k++)
        blocks->block[k].run = false;
}

static void compare(int d, const struct tl_options *options, bool fixed)
{
    static const double spacing[3] = {.01, .04, .07};
    struct box_scene box;
    make_box(&box, d, 1, spacing[d - 1]);
    if (fixed) box.scene.boundary[FACE_X_LOW].kind = BOUNDARY_FIXED;
    if (fixed && d > 1) box.scene.boundary[FACE_Y_HIGH].kind = BOUNDARY_SYMMETRY;
    struct tl_model *tl = make(&box.scene, options);
    const size_t n = tl->model.points;
    /* a test of runs needs some: of 14 points in a row of the 3D box 8 to 10 */
    assert_true(in_runs(&tl->gradient_blocks) > n / 3);
    assert_true(in_runs(&tl->stress_blocks) > n / 3);
    assert_true(d == 3 || in_runs(&tl->force_blocks) > n / 3);
    double *fast = acceleration(tl);
    take_apart(&tl->gradient_blocks);
    take_apart(&tl->stress_blocks);
    take_apart(&tl->force_blocks);
    double *slow = acceleration(tl), largest = 0, difference = 0;
    for (size_t k = 0; k < tl->model.unknowns; k++) {
        largest = fmax(largest, fabs(slow[k]));
        difference = fmax(difference, fabs(fast[k] - slow[k]));
    }
    if (!(largest > 0) || !(difference <= 1e-11 * largest))
        fail_msg("dimension %d, degree %d: %g of %g", d, options->degree, difference, largest);
    array_free(fast);
    array_free(slow);
    struct model *model = &tl->model;
    model_free(&model);
}

static void runs_are_points(void **state)
{
    (void)state;
    static const enum elastic_law law[3] = {LAW_LINEAR, LAW_SAINT_VENANT_KIRCHHOFF, LAW_NEO_HOOKEAN};
    for (int d = 1; d <= 3; d++)
        for (int degree = 1; degree <= 2; degree++)
            for (int k = 0; k < 3; k++) {
                struct tl_options options = tl_default_options();
                options.degree = degree;
                options.law = law[k];
                options.hourglass = k == 2 ? 0 : .1;
                compare(d, &options, k != 0);
            }
}

/* Runs where there are runs only: a jittered cloud has none. */
static void scattered_points_have_no_runs(void **state)
{
    (void)state;
    struct box_scene box;
    make_box(&box, 2, 1, .05);
    box.scene.body.jitter = .2;
    const struct tl_options options = tl_default_options();
    struct tl_model *tl = make(&box.scene, &options);
    assert_true(in_runs(&tl->gradient_blocks) == 0 && in_runs(&tl->force_blocks) == 0);
    size_t points = 0;
    for (size_t k = 0; k < tl->gradient_blocks.count; k++) {
        assert_true(tl->gradient_blocks.block[k].first == points); /* no point is left out or done twice */
        points += tl->gradient_blocks.block[k].count;
    }
    assert_true(points == tl->model.points);
    struct model *model = &tl->model;
    model_free(&model);
}

static struct tl_model *box_of(struct box_scene *box, int dimension, double spacing, double jitter)
{
    make_box(box, dimension, 1, spacing);
    box->scene.body.jitter = jitter;
    box->scene.boundary[FACE_X_HIGH].kind = BOUNDARY_FIXED;
    box->scene.boundary[FACE_Y_LOW].kind = BOUNDARY_SYMMETRY;
    struct tl_options options = tl_default_options();
    options.degree = 1; /* quadratic weights are others off lattices */
    options.viscosity_alpha = .1;
    return make(&box->scene, &options);
}

/* Points moved by a millionth of what would matter are no lattice to the set-up: each has a row of its own,
 * from its own neighbours. */
static void shared_rows_are_those_of_each(void **state)
{
    (void)state;
    for (int d = 2; d <= 3; d++) {
        struct box_scene lattice, scattered;
        struct tl_model *shared = box_of(&lattice, d, d == 2 ? .04 : .09, 0);
        struct tl_model *own = box_of(&scattered, d, d == 2 ? .04 : .09, 1e-9);
        assert_int_equal(shared->model.points, own->model.points);
        assert_true(shared->cloud->grid[0] > 0 && own->cloud->grid[0] == 0);
        assert_true(own->gradient.rows == own->model.points && shared->gradient.rows < own->model.points / 2);
        double *a = acceleration(shared), *b = acceleration(own), largest = 0, difference = 0;
        for (size_t k = 0; k < shared->model.unknowns; k++) {
            largest = fmax(largest, fabs(b[k]));
            difference = fmax(difference, fabs(a[k] - b[k]));
        }
        if (!(difference <= 1e-7 * largest)) fail_msg("dimension %d: %g of %g", d, difference, largest);
        array_free(a);
        array_free(b);
        struct model *models[2] = {&shared->model, &own->model};
        model_free(&models[0]);
        model_free(&models[1]);
    }
}

/* A larger lattice has no more rows than the smaller one, but for points whose ghosts stand elsewhere. */
static void rows_do_not_grow(void **state)
{
    (void)state;
    size_t rows[2], points[2];
    for (int k = 0; k < 2; k++) {
        struct box_scene box;
        make_box(&box, 2, 1, k == 0 ? .03 : .015);
        const struct tl_options options = tl_default_options();
        struct tl_model *tl = make(&box.scene, &options);
        rows[k] = tl->gradient.rows + tl->transposed.rows + tl->pair.rows;
        points[k] = tl->model.points;
        struct model *model = &tl->model;
        model_free(&model);
    }
    assert_true(points[1] > 3 * points[0]);
    assert_int_equal(rows[1], rows[0]);
}

/* The largest frequency and the bound on its error, of the model or, with `whole`, without shortening. */
static double fastest(struct tl_model *tl, bool whole, double *error)
{
    const struct model_operator *spatial = tl->model.spatial;
    struct model_operator without = *spatial;
    struct messages messages = {0};
    double omega = 0;
    without.shorten = NULL;
    if (whole) tl->model.spatial = &without;
    const selas_status status = largest_frequency(&tl->model, &omega, error, &messages);
    tl->model.spatial = spatial;
    if (status != SELAS_OK) fail_msg("%s", messages.text);
    messages_free(&messages);
    return omega;
}

/* Long lattices are measured on shorter ones: with what is added never below the true frequency, and little
 * above. */
static void short_bodies_are_fast_enough(void **state)
{
    (void)state;
    static const enum boundary_kind kind[3] = {BOUNDARY_FREE, BOUNDARY_FIXED, BOUNDARY_SYMMETRY};
    for (int d = 2; d <= 3; d++)
        for (int k = few_of(0, 2); k < 3; k++)
            for (int degree = few_of(1, d - 1); degree <= few_of(2, d - 1); degree++) {
                struct box_scene box;
                make_box(&box, d, d == 2 ? .05 : .06, d == 2 ? .0025 : .0075);
                box.scene.body.high[0] = 1;
                box.scene.boundary[FACE_X_LOW].kind = box.scene.boundary[FACE_X_HIGH].kind = kind[k];
                box.scene.boundary[FACE_Y_LOW].kind = kind[(k + 1) % 3];
                struct tl_options options = tl_default_options();
                options.degree = degree;
                struct tl_model *tl = make(&box.scene, &options);
                double error, short_error;
                const double omega = fastest(tl, true, &error);
                const unsigned long calls = tl->model.evaluations;
                const double shorter = fastest(tl, false, &short_error);
                assert_int_equal(tl->model.evaluations, calls); /* it was another model */
                if (!(shorter * (1 + short_error) >= omega) ||
                    !(shorter * (1 - short_error) <= omega * (1 + error)))
                    fail_msg("dimension %d, degree %d, faces %d: %.8g +- %g, whole %.8g +- %g", d, degree, k,
                             shorter, short_error, omega, error);
                struct model *model = &tl->model;
                model_free(&model);
            }
}

static void threads_do_not_matter(void **state)
{
    (void)state;
    for (int jittered = 0; jittered < 2; jittered++) {
        struct box_scene box;
        make_box(&box, 2, 1, .016);
        box.scene.body.jitter = jittered * .2;
        box.scene.boundary[FACE_X_LOW].kind = BOUNDARY_FIXED;
        const struct tl_options options = tl_default_options();
        struct tl_model *tl = make(&box.scene, &options);
        assert_true(tl->model.points > TL_SERIAL);
        double *one = acceleration(tl);
        omp_set_num_threads(2);
        double *two = acceleration(tl);
        omp_set_num_threads(1);
        assert_memory_equal(one, two, tl->model.unknowns * sizeof *one);
        array_free(one);
        array_free(two);
        struct model *model = &tl->model;
        model_free(&model);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(runs_are_points),
        cmocka_unit_test(scattered_points_have_no_runs),
        cmocka_unit_test(shared_rows_are_those_of_each),
        cmocka_unit_test(rows_do_not_grow),
        cmocka_unit_test(short_bodies_are_fast_enough),
        cmocka_unit_test(threads_do_not_matter),
    };
    omp_set_num_threads(1);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
