/* A spacing graded over depth: the map, rigid motions, symmetry, the largest step, energy, strains, moment tensors,
 * absorbing layers, threads (doc/theory/graded-spacing.md). */
#include "from_deck.h"
#include "general_run.h"

#include "method/methods.h"
#include "scene/grading.h"
#include "scene/ground.h"

#include <omp.h>

#define ROCKS                                                                                                \
    "&material name = 'soil', density = 1, p_speed = .9, s_speed = .5 /\n"                                   \
    "&material name = 'rock', density = 1.3, p_speed = 2.6, s_speed = 1.5 /\n"
#define FLAT                                                                                                 \
    "&scene dimension = 3, end_time = 1 /\n&method operator = 'general' /\n" ROCKS                           \
    "&body low = 0, 0, 0, high = 1.5, 1.25, 5, spacing = .25, grading = 3 /\n"                               \
    "&layer material = 'soil', top = 0 /\n&layer material = 'rock', top = .6 /\n"                            \
    "&load face = 'z-', shape = 'face', direction = 0, 0, 1, history = 'triangle', duration = 1 /\n"
#define HILLY FLAT "&topography shape = 'gaussian', height = .3, centre = .7, .6, width = .5, depth = 2 /\n"
#define PLANE                                                                                                \
    "&scene dimension = 2, end_time = 1 /\n&method operator = 'general' /\n" ROCKS                           \
    "&body material = 'soil', low = 0, 0, high = 2, 6, spacing = .25, grading = 2.5 /\n"                     \
    "&block material = 'rock', centre = 1, 4, size = 9, 6 /\n"                                               \
    "&load face = 'y-', shape = 'face', direction = 0, 1, history = 'triangle', duration = 1 /\n"
static const char *const decks[] = {FLAT, HILLY, PLANE};
enum { DECKS = 3 };

struct made {
    struct from_deck from;
    struct run run;
};

static struct made make_deck(const char *deck)
{
    struct made made = {.from = right_scene(deck)};
    struct messages messages = {0};
    struct model *model = NULL;
    assert_non_null(made.from.scene->body.grading);
    assert_int_equal(model_create(made.from.scene, &model, &messages), SELAS_OK);
    made.run.model = model;
    made.run.n = model->unknowns;
    made.run.y = calloc(model->state_size, sizeof(double));
    made.run.a = calloc(made.run.n, sizeof(double));
    return made;
}

static void made_free(struct made *made)
{
    run_free(&made->run);
    from_deck_free(&made->from);
}

/* There and back, from face to face, and never coarser than the rock's waves are longer. */
static void test_map(void **state)
{
    (void)state;
    for (int deck = 0; deck < DECKS; deck++) {
        struct from_deck made = right_scene(decks[deck]);
        const struct scene *scene = made.scene;
        const struct body *body = &scene->body;
        const struct grading *grading = body->grading;
        const int down = scene->dimension - 1;
        const double high = body->high[down];
        assert_non_null(grading);
        assert_near(grading_real(grading, high), high, 1e-14);
        assert_near(grading->stretch[0] * grading->step, body->spacing, 1e-15);
        assert_true(grading->largest > 1.6 * body->spacing && grading->largest <= 3 * body->spacing);
        for (double zeta = -.5; zeta < high + 1; zeta += .0137) {
            const double z = grading_real(grading, zeta), step = 1e-6;
            assert_near(grading_lattice(grading, z), zeta, 1e-13);
            assert_near((grading_real(grading, zeta + step) - grading_real(grading, zeta - step)) /
                            (2 * step),
                        grading_stretch(grading, zeta), 1e-5);
            double place[3] = {.1, .1, .1}, speed[2];
            place[down] = fmin(fmax(z, 0), high);
            ground_speeds_at(scene, place, speed);
            assert_true(body_spacing_at(body, place) <= body->spacing * speed[1] / .5 * (1 + 1e-12));
        }
        from_deck_free(&made);
    }
}

/* Control values of a coordinate of the deck. */
static double *coordinate(const struct consistent *c, int axis)
{
    double *control = calloc(c->volume, sizeof *control);
    for (size_t i = 0; i < c->volume; i++) {
        const size_t at[3] = {i % c->n[0], i / c->n[0] % c->n[1], i / c->plane};
        double place[3] = {0};
        for (int other = 0; other < c->dimension; other++)
            place[other] = c->spline[other]->greville[at[c->slot[other]]];
        consistent_to_ground(c, place);
        control[i] = place[axis];
    }
    for (int other = 0; other < c->dimension; other++) {
        const int slot = c->slot[other];
        const size_t stride[3] = {1, c->n[0], c->plane};
        struct band *lu = consistent_collocation(c->spline[other], false);
        for (size_t i = 0; i < c->volume; i++)
            if (i / stride[slot] % c->n[slot] == 0) band_lu_solve(lu, control + i, stride[slot]);
        band_free(lu);
    }
    return control;
}

static void test_rigid_motions(void **state)
{
    (void)state;
    for (int deck = 0; deck < DECKS; deck++) {
        struct made made = make_deck(decks[deck]);
        struct run *run = &made.run;
        struct consistent *c = consistent_of(run->model);
        double *x[3] = {NULL}, scale[2] = {0, 0};
        for (int axis = 0; axis < c->dimension; axis++)
            x[axis] = coordinate(c, axis);
        for (int s = -1; s <= 1; s += 2) /* a pure shear moves things, a rotation does not */
            for (int from = 0; from < c->dimension; from++) {
                const int to = (from + 1) % c->dimension;
                memset(run->y, 0, run->n * sizeof *run->y);
                for (size_t i = 0; i < c->volume; i++) {
                    run->y[(size_t)from * c->volume + i] = 1 + x[to][i];
                    run->y[(size_t)to * c->volume + i] = 2 - s * x[from][i];
                }
                general_forces(c, run->y, NULL, run->a);
                for (size_t i = 0; i < run->n; i++)
                    scale[s > 0] = fmax(scale[s > 0], fabs(run->a[i]));
            }
        assert_true(scale[1] < 2e-14 * scale[0]);
        for (int axis = 0; axis < c->dimension; axis++)
            free(x[axis]);
        made_free(&made);
    }
}

/* Where the spacing has not grown yet the ground at the points is that of an even lattice, normals of interfaces too. */
static void test_ground(void **state)
{
    (void)state;
    for (int deck = 0; deck < DECKS; deck++) {
        struct made graded = make_deck(decks[deck]);
        struct from_deck even = from_text(decks[deck], 1, (const char *const[]){"body%grading=1"});
        struct messages messages = {0};
        struct model *model = NULL;
        assert_int_equal(model_create(even.scene, &model, &messages), SELAS_OK);
        for (int f = 0; f < 3; f++) {
            const struct family *one = &consistent_of(graded.run.model)->general->family[f];
            const struct family *other = &consistent_of(model)->general->family[f];
            const size_t rows = 4 * one->n[1], points = rows * one->n[0];
            double most[2] = {0, 0};
            for (size_t i = 0; i < points; i++)
                most[0] = fmax(most[0], fabs(one->mu[i] / other->mu[i] - 1));
            assert_int_equal(one->first_run[rows], other->first_run[rows]);
            const size_t numbers = one->run[one->first_run[rows]].at;
            assert_true(numbers > 0);
            for (size_t i = 0; i < numbers; i++)
                most[1] = fmax(most[1], fabs(one->stiffness[i] - other->stiffness[i]) / other->mu[0]);
            assert_true(most[0] < 1e-12 && most[1] < 1e-12);
        }
        model_free(&model);
        from_deck_free(&even);
        made_free(&graded);
    }
}

static void test_symmetric(void **state)
{
    (void)state;
    for (int deck = 0; deck < DECKS; deck++) {
        struct made made = make_deck(decks[deck]);
        struct run *run = &made.run;
        struct consistent *c = consistent_of(run->model);
        double *one = calloc(run->n, sizeof *one), *other = calloc(run->n, sizeof *other);
        for (size_t i = 0; i < run->n; i++) {
            one[i] = chance(.1, 10) - 1;
            other[i] = chance(.1, 10) - 1;
        }
        general_forces(c, one, NULL, run->a);
        const double there = dot(run->n, run->a, other), work = dot(run->n, run->a, one);
        general_forces(c, other, NULL, run->a);
        assert_true(fabs(dot(run->n, run->a, one) - there) < 1e-13 * fabs(work));
        assert_true(work < 0);
        free(one);
        free(other);
        made_free(&made);
    }
}

/* Leapfrog keeps its energy at .9 of the limit, stays bounded just below and grows just above it. */
static void test_steps(void **state)
{
    (void)state;
    for (int deck = 0; deck < DECKS; deck++) {
        struct made made = make_deck(decks[deck]);
        struct messages messages = {0};
        double omega, error;
        make_random(consistent_of(made.run.model));
        assert_int_equal(largest_frequency(made.run.model, &omega, &error, &messages), SELAS_OK);
        noise(made.run.n, made.run.y);
        const double dt = .9 * 2 / omega, before = energy_at(&made.run, dt);
        for (int step = 0; step < 2000; step++)
            leap(&made.run, &(struct drive){0}, dt);
        assert_true(fabs(energy_at(&made.run, dt) / before - 1) < 1e-13);
        assert_false(grows(&made.run, .995 * 2 / omega));
        assert_true(grows(&made.run, 1.01 * 2 / omega));
        made_free(&made);
    }
}

/* The mass of the whole body moves as one. */
static void test_mass(void **state)
{
    (void)state;
    struct made made = make_deck(FLAT);
    struct consistent *c = consistent_of(made.run.model);
    double *product = calloc(made.run.n, sizeof *product), sum = 0;
    for (size_t i = 0; i < c->volume; i++)
        made.run.y[i] = 1;
    made.run.model->spatial->weigh(made.run.model, made.run.y, product);
    for (size_t i = 0; i < c->volume; i++)
        sum += product[i];
    assert_near(sum, 1.5 * 1.25 * (.6 + 1.3 * 4.4), 1e-3);
    free(product);
    made_free(&made);
}

static const double strain_of[3][3] = {{.3, -.2, .5}, {.1, .7, .4}, {-.6, .2, -.1}};

static void strain_evenly(const struct consistent *c, double *y)
{
    for (int axis = 0; axis < 3; axis++) {
        double *x = coordinate(c, axis);
        for (int component = 0; component < 3; component++)
            for (size_t i = 0; i < c->volume; i++)
                y[(size_t)component * c->volume + i] += strain_of[component][axis] * x[i];
        free(x);
    }
}

/* An even strain has the stress of Hooke's law where it is looked at, and the places that are shown are true ones; a
 * moment tensor does as much work on it as its components on the strain. */
static void test_even_strain(void **state)
{
    (void)state;
    struct made made =
        make_deck(FLAT "&load kind = 'moment-tensor', centre = .8, .6, 3.3, moment = 1, -2, .5, .3, .7, -.9,"
                       " history = 'triangle', duration = 1 /\n");
    struct run *run = &made.run;
    struct consistent *c = consistent_of(run->model);
    strain_evenly(c, run->y);
    const struct material *rock = &made.from.scene->material[1];
    const double trace = strain_of[0][0] + strain_of[1][1] + strain_of[2][2];
    struct probe probe = {0};
    struct messages messages = {0};
    double stress[6], moved[3];
    assert_int_equal(run->model->core->probe(run->model, (double[]){.7, .8, 3.1}, &probe, &messages),
                     SELAS_OK);
    run->model->core->observe(run->model, &probe, SELAS_STRESS, run->y, run->a, stress);
    assert_near(stress[2], rock->lambda * trace + 2 * rock->mu * strain_of[2][2], 1e-12);
    assert_near(stress[5], rock->mu * (strain_of[0][2] + strain_of[2][0]), 1e-12);
    run->model->core->observe(run->model, &probe, SELAS_DISPLACEMENT, run->y, run->a, moved);
    assert_near(moved[2], -.6 * .7 + .2 * .8 - .1 * 3.1, 1e-13);
    probe_free(&probe);
    double place[3], value[3];
    const size_t point = run->model->points - 2 * run->model->grid[0] * run->model->grid[1] + 3;
    model_position(run->model, point, place);
    run->model->core->field(run->model, SELAS_DISPLACEMENT, run->y, run->a, point, point + 1, value);
    assert_near(value[2], -.6 * place[0] + .2 * place[1] - .1 * place[2], 1e-13);
    static const int pair[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};
    const struct load *load = &made.from.scene->load[1];
    double work = 0;
    for (int m = 0; m < 6; m++) {
        const int i = pair[m][0], j = pair[m][1];
        work += load->moment[m] * (i == j ? strain_of[i][j] : strain_of[i][j] + strain_of[j][i]);
    }
    assert_near(sparse_dot(c, &c->load.of[1], run->y), work, 3e-3);
    made_free(&made);
}

/* Noise on random ground with absorbing layers at five faces: nothing grows. */
static void test_layers_are_quiet(void **state)
{
    (void)state;
    struct made made = make_deck(FLAT "&boundary face = 'x-', 'x+', 'y-', 'y+', 'z+', kind = 'transmitting', "
                                      "layer = 'pml', layer_points = 6, always = T /\n");
    struct run *run = &made.run;
    struct messages messages = {0};
    double omega, error;
    make_random(consistent_of(run->model));
    assert_int_equal(largest_frequency(run->model, &omega, &error, &messages), SELAS_OK);
    noise(run->n, run->y + run->n);
    const double first = size_of(run->n, run->y + run->n);
    march(run, .9 * 2 / omega, 500);
    const double early = size_of(run->n, run->y + run->n);
    march(run, .9 * 2 / omega, 500);
    assert_true(early < first);
    assert_true(size_of(run->n, run->y + run->n) < early);
    made_free(&made);
}

static void test_threads(void **state)
{
    (void)state;
    double *kept = NULL;
    for (int threads = 1; threads <= 3; threads += 2) {
        omp_set_num_threads(threads);
        struct from_deck from =
            from_text(FLAT, 2, (const char *const[]){"body%high=5.75,4.75,5", "method%symmetry=F"});
        struct run run = {0};
        struct messages messages = {0};
        assert_non_null(from.scene);
        assert_int_equal(model_create(from.scene, &run.model, &messages), SELAS_OK);
        run.n = run.model->unknowns;
        run.y = calloc(run.model->state_size, sizeof *run.y);
        run.a = calloc(run.n, sizeof *run.a);
        assert_same_steps(&run, threads, &kept);
        run_free(&run);
        from_deck_free(&from);
    }
    free(kept);
}

static void test_refusals(void **state)
{
    (void)state;
    assert_refused("&scene dimension = 2, end_time = 1 /\n" ROCKS
                   "&body material = 'soil', low = 0, 0, high = 2, 6, spacing = .25, grading = 2, rotation = "
                   "0, 0, 30 /\n"
                   "&block material = 'rock', centre = 1, 4, size = 9, 6 /\n",
                   "t.nml:4:", (const char *const[]){"graded", "not turned", NULL});
    struct from_deck even =
        right_scene("&scene dimension = 2, end_time = 1 /\n" ROCKS
                    "&body material = 'soil', low = 0, 0, high = 2, 6, spacing = .25, grading = 2 /\n"
                    "&block material = 'rock', centre = 1, 2, size = 9, 2 /\n");
    assert_null(even.scene->body.grading); /* soil again below the rock */
    assert_non_null(strstr(even.messages.text, "stays even"));
    from_deck_free(&even);
    struct from_deck sides = right_scene(
        PLANE "&load face = 'x+', shape = 'face', direction = 1, 0, history = 'triangle', duration = 1 /\n");
    struct model *model = NULL;
    struct messages messages = {0};
    assert_int_equal(model_create(sides.scene, &model, &messages), SELAS_UNSUPPORTED);
    assert_non_null(strstr(messages.text, "body%grading tractions act on"));
    messages_free(&messages);
    from_deck_free(&sides);
}

/* The same grading in other units of length, with layers where pieces of the column end but for rounding. */
static void test_units(void **state)
{
    (void)state;
    static const double units[] = {1, .3048, 3, 1e3, 1. / 7};
    for (int half = 6; half < 26; half++) {
        double from = 0, largest = 0;
        for (size_t k = 0; k < sizeof units / sizeof *units; k++) {
            const double h = .3 * units[k];
            char text[900];
            snprintf(
                text, sizeof text,
                "&scene dimension = 2, end_time = 1 /\n&method operator = 'general' /\n" ROCKS
                "&body low = 0, 0, high = %.17g, %.17g, spacing = %.17g, grading = 3 /\n"
                "&layer material = 'soil', top = 0 /\n&layer material = 'rock', top = %.17g /\n"
                "&load face = 'y-', shape = 'face', direction = 0, 1, history = 'triangle', duration = 1 /\n",
                9 * h, 36 * h, h, half * h / 2);
            struct from_deck made = right_scene(text);
            const struct grading *grading = made.scene->body.grading;
            assert_non_null(grading);
            if (k == 0) {
                from = grading->from;
                largest = grading->largest;
            }
            assert_near(grading->from, from * units[k], 1e-9 * from * units[k]);
            assert_near(grading->largest, largest * units[k], 1e-9 * largest * units[k]);
            from_deck_free(&made);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_units),         cmocka_unit_test(test_map),
        cmocka_unit_test(test_rigid_motions), cmocka_unit_test(test_ground),
        cmocka_unit_test(test_symmetric),     cmocka_unit_test(test_steps),
        cmocka_unit_test(test_mass),          cmocka_unit_test(test_even_strain),
        cmocka_unit_test(test_threads),       cmocka_unit_test(test_layers_are_quiet),
        cmocka_unit_test(test_refusals),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
