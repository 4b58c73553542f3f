/* The largest frequency on a body whose long axes are cut: never below that of the whole body by more than
 * what is added for it, and not far above; bodies that are short themselves are measured as they are. */
#include "consistent_run.h"
#include "few.h"

#include "stepping/stepping.h"

#include <setjmp.h>
#include <stdarg.h>
#include <stdint.h>

#include <cmocka.h>

enum { FREE, FIXED, ROLLER, MIRROR, HALF_MIRROR, LAYERS, LYSMER, ENDS };

static void set_ends(struct plain_scene *plain, int ends)
{
    const int last = 2 * plain->scene.dimension - 1;
    for (int face = 0; face <= last; face++) {
        struct boundary *boundary = &plain->scene.boundary[face];
        const bool surface = face == last - 1;
        boundary->absorber = ends == LAYERS ? ABSORBER_PML : ABSORBER_LYSMER;
        if (ends == FIXED) boundary->kind = BOUNDARY_FIXED;
        if (ends == ROLLER) boundary->kind = BOUNDARY_ROLLER;
        if (ends == MIRROR || (ends == HALF_MIRROR && face % 2 == 0)) boundary->kind = BOUNDARY_SYMMETRY;
        if (ends >= LAYERS && !surface) boundary->kind = BOUNDARY_TRANSMITTING;
        if (ends == LAYERS && !surface) boundary->layer_points = 6;
        boundary->always = true;
    }
}

static void set_poisson(struct plain_scene *plain, double nu)
{
    plain_material(&plain->material[0], 1.3, 2 * .9 * nu / (1 - 2 * nu), .9);
}

static double frequency(struct model *model, double *error)
{
    struct messages messages = {0};
    double omega = 0;
    assert_int_equal(largest_frequency(model, &omega, error, &messages), SELAS_OK);
    return omega;
}

/* Makes the largest frequency be measured on the whole body. */
static void whole_body(struct model *model)
{
    static struct model_operator whole;
    whole = *model->spatial;
    whole.shorten = NULL;
    model->spatial = &whole;
}

/* How far the bound from the cut body is above the frequency of the whole one, a Ritz value. */
static double excess(const struct plain_scene *plain, struct consistent_options options, size_t longest)
{
    struct model *whole = make(plain, options), *cut = NULL;
    struct consistent *c = consistent_of(whole);
    struct messages messages = {0};
    double error = 0, unused = 0;
    assert_int_equal(consistent_cut(c, longest, &cut, &messages), SELAS_OK);
    assert_true(2 * cut->unknowns < whole->unknowns);
    whole_body(whole);
    const double short_one = frequency(cut, &error);
    const double above =
        short_one * (1 + error + consistent_deficit(c, longest)) / frequency(whole, &unused) - 1;
    model_free(&cut);
    model_free(&whole);
    return above;
}

static void a_cut_body_bounds_the_whole_one(void **state)
{
    static const double poisson[] = {.05, .45};
    static const struct consistent_options options[] = {{.degree = 2, .sweeps = 3, .depth_exact = true},
                                                        {.degree = 2, .sweeps = 1},
                                                        {.degree = 1, .sweeps = 2},
                                                        {.degree = 1},
                                                        {.degree = 2},
                                                        {.degree = 4, .tuned = true}};
    const size_t longest = 30;
    (void)state;
    for (size_t o = 0; o < sizeof options / sizeof *options; o++)
        for (int ends = FREE; ends < ENDS; ends++)
            for (size_t m = (size_t)few_of(0, 1); m < 2; m++) {
                struct plain_scene plain;
                const double size[3] = {50, 45, 0};
                if (ends == LAYERS && options[o].sweeps == 0) continue;
                plain_box(&plain, 2, size, 1);
                set_ends(&plain, ends);
                set_poisson(&plain, poisson[m]);
                const double above = excess(&plain, options[o], longest);
                const double most = (options[o].sweeps > 0 ? 3 : 7) / (double)(longest * longest) + 1e-3;
                assert_true(above >= 0);
                assert_true(above <= most);
            }
}

/* What stepping takes: in space, with a mirror and a free end on each axis or layers of six cells, and ground
 * that varies over depth, which is not cut. */
static void the_frequency_that_steps_are_chosen_by(void **state)
{
    static const struct consistent_options options = {.degree = 2, .sweeps = 3, .depth_exact = true};
    static const int ends[3] = {HALF_MIRROR, LAYERS, FREE};
    (void)state;
    for (int scene = few_of(0, 2); scene < 3; scene++) {
        struct plain_scene plain;
        const double layers = ends[scene] == LAYERS ? 12 : 0, depth = scene == 2 ? 14 : 44;
        const double size[3] = {90 - layers, 48 - layers, depth};
        plain_box(&plain, 3, size, 1);
        set_ends(&plain, ends[scene]);
        set_poisson(&plain, .25);
        if (scene == 2) {
            plain.scene.body.layers = 2;
            plain.layer[1] = (struct layer){.material = 1, .top = 5};
        }
        struct model *model = make(&plain, options), *shorter = NULL;
        struct messages messages = {0};
        double deficit = 0, error = 0, unused = 0;
        assert_int_equal(consistent_shorten(model, &shorter, &deficit, &messages), SELAS_OK);
        assert_non_null(shorter);
        for (int axis = 0; axis < 3; axis++)
            assert_int_equal(consistent_of(shorter)->spline[axis]->cells, axis == 2 && scene == 2 ? 14 : 40);
        model_free(&shorter);
        const double bound = frequency(model, &error) * (1 + error);
        assert_true(error >= deficit && deficit > 0);
        whole_body(model);
        const double whole = frequency(model, &unused);
        model_free(&model);
        assert_true(bound >= whole && bound <= whole * (1 + deficit + 1e-3));
    }
}

static void short_bodies_are_measured_as_they_are(void **state)
{
    static const struct consistent_options options = {.degree = 2, .sweeps = 3};
    static const double sizes[2][3] = {{40, 40, 40}, {70, 40, 40}}; /* the second: not worth it */
    (void)state;
    for (int i = 0; i < 2; i++) {
        struct plain_scene plain;
        struct messages messages = {0};
        plain_box(&plain, 3, sizes[i], 1);
        struct model *model = make(&plain, options), *shorter = NULL;
        double deficit;
        assert_int_equal(consistent_shorten(model, &shorter, &deficit, &messages), SELAS_OK);
        assert_null(shorter);
        model_free(&model);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(a_cut_body_bounds_the_whole_one),
        cmocka_unit_test(the_frequency_that_steps_are_chosen_by),
        cmocka_unit_test(short_bodies_are_measured_as_they_are),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
