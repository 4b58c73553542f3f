/* The general operator below a surface that is not level: the map, rigid motions, symmetry, the largest step, energy,
 * symmetry planes, absorbing layers, threads, moment tensors (doc/theory/topography.md). */
#include "general_run.h"

#include "method/consistent/galerkin/surface.h"
#include "scene/topography.h"

#include <omp.h>

/* A hill as steep as 45 degrees beside the middle of a box of random ground. */
static struct topography steep_hill(const struct scene *scene, double width)
{
    struct topography hill = {.shape = TOPOGRAPHY_GAUSSIAN, .width = width, .across = {1, 0}};
    hill.axis = scene->dimension - 1;
    hill.plane = scene->body.low[hill.axis];
    hill.height = width * exp(.5);
    hill.centre[0] = .45 * scene->body.high[0];
    hill.centre[1] = .4 * scene->body.high[1];
    hill.depth = floor((scene->body.high[hill.axis] - hill.plane) / (2 * scene->body.spacing)) * 2 *
                 scene->body.spacing;
    return hill;
}

static struct run hill_run(struct plain_scene *plain, struct topography *hill, int dimension,
                           const double size[3], double width)
{
    plain_box(plain, dimension, size, .25);
    *hill = steep_hill(&plain->scene, width);
    plain->scene.body.topography = hill;
    struct run run = run_new(plain, general());
    make_random(consistent_of(run.model));
    return run;
}

/* From lattice to deck and back; the surface is that of the shape. */
static void test_map(void **state)
{
    (void)state;
    struct plain_scene plain;
    plain_box(&plain, 3, (double[]){4, 4, 2}, .25);
    struct topography hill = steep_hill(&plain.scene, .4);
    plain.scene.body.topography = &hill;
    for (int shape = 0; shape < 3; shape++)
        for (int i = 0; i <= 20; i++) {
            hill.shape = (enum topography_shape)shape;
            const double place[3] = {.2 * i, 1.5, .1 * i};
            double there[3], back[3], slope;
            body_to_deck(&plain.scene.body, place, there);
            body_from_deck(&plain.scene.body, there, back);
            assert_near(back[2], place[2], 1e-14);
            assert_near(there[2],
                        place[2] + topography_drop(&hill, place) * topography_share(&hill, place[2], &slope),
                        1e-14);
        }
    assert_near(topography_drop(&hill, hill.centre), hill.height, 0); /* a canyon */
    hill.shape = TOPOGRAPHY_GAUSSIAN;
    assert_near(topography_drop(&hill, hill.centre), -hill.height, 0);
    /* drawn out: level across the face, as high as half the strip before it */
    hill.end[0][1] = (struct drawn_out){3, 1};
    const double at_face = topography_drop(&hill, (double[]){4, 1});
    assert_near(topography_drop(&hill, (double[]){5, 1}), at_face, 0);
    assert_near(topography_drop(&hill, (double[]){3.9, 1}), at_face,
                .06 * fabs(at_face)); /* a parabola's end */
    hill.end[0][1] = (struct drawn_out){0, 0};
    assert_near(topography_drop(&hill, (double[]){3.5, 1}), at_face, 1e-15);
}

/* Displacements x, y, z of the deck, by control values: of x and y the Greville points, of z those of the map. */
static void coordinates(const struct consistent *c, int dimension, size_t i, double place[3])
{
    const size_t at[3] = {i % c->n[0], i / c->n[0] % c->n[1], i / c->plane};
    const struct topography *topography = c->model.scene->body.topography;
    for (int axis = 0; axis < dimension; axis++)
        place[axis] = c->spline[axis]->greville[at[c->slot[axis]]];
    /* control values of f, a parabola by pieces: values less an eighth of their second difference inside */
    const struct spline *depth = c->spline[dimension - 1];
    struct band *lu = consistent_collocation(depth, false);
    double *share = calloc(depth->count, sizeof *share), slope;
    for (size_t k = 0; k < depth->count; k++)
        share[k] = topography_share(topography, depth->greville[k] - topography->plane, &slope);
    band_lu_solve(lu, share, 1);
    place[dimension - 1] += c->surface[i % c->plane] * share[at[DEPTH]];
    free(share);
    band_free(lu);
}

static void test_rigid_motions(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        struct plain_scene plain;
        struct topography hill;
        struct run run = hill_run(&plain, &hill, dimension, (double[]){3, dimension == 3 ? 2.5 : 2, 2}, .4);
        struct consistent *c = consistent_of(run.model);
        double scale[2] = {0, 0};
        for (int s = -1; s <= 1; s += 2) /* a pure shear moves things, a rotation does not */
            for (int from = 0; from < dimension; from++) {
                const int to = (from + 1) % dimension;
                memset(run.y, 0, run.n * sizeof *run.y);
                for (size_t i = 0; i < c->volume; i++) {
                    double place[3];
                    coordinates(c, dimension, i, place);
                    run.y[(size_t)from * c->volume + i] = 1 + place[to];
                    run.y[(size_t)to * c->volume + i] = 2 - s * place[from];
                }
                general_forces(c, run.y, NULL, run.a);
                for (size_t i = 0; i < run.n; i++)
                    scale[s > 0] = fmax(scale[s > 0], fabs(run.a[i]));
            }
        assert_true(scale[1] < 1e-14 * scale[0]);
        run_free(&run);
    }
}

static void test_symmetric(void **state)
{
    (void)state;
    struct plain_scene plain;
    struct topography hill;
    struct run run = hill_run(&plain, &hill, 3, (double[]){2, 1.5, 1.5}, .3);
    struct consistent *c = consistent_of(run.model);
    double *one = calloc(run.n, sizeof *one), *other = calloc(run.n, sizeof *other);
    bits = 3;
    for (int pair = 0; pair < 5; pair++) {
        for (size_t i = 0; i < run.n; i++) {
            one[i] = chance(.1, 10) - 1;
            other[i] = chance(.1, 10) - 1;
        }
        general_forces(c, one, NULL, run.a);
        const double there = dot(run.n, run.a, other), work = dot(run.n, run.a, one);
        general_forces(c, other, NULL, run.a);
        assert_true(fabs(dot(run.n, run.a, one) - there) < 1e-13 * fabs(work));
        assert_true(work < 0);
    }
    free(one);
    free(other);
    run_free(&run);
}

static void test_largest_step(void **state)
{
    (void)state;
    for (int ground = 0; ground < 4; ground++) {
        struct plain_scene plain;
        struct topography hill;
        struct run run = hill_run(&plain, &hill, 2 + ground % 2, (double[]){2, 1.5, 1.5}, .3);
        struct messages messages = {0};
        double omega, error;
        assert_int_equal(largest_frequency(run.model, &omega, &error, &messages), SELAS_OK);
        assert_false(grows(&run, .995 * 2 / omega));
        assert_true(grows(&run, 1.01 * 2 / omega));
        run_free(&run);
    }
}

static void test_energy(void **state)
{
    (void)state;
    struct plain_scene plain;
    struct topography hill;
    struct run run = hill_run(&plain, &hill, 3, (double[]){2, 1.5, 1.5}, .3);
    struct messages messages = {0};
    double omega, error;
    assert_int_equal(largest_frequency(run.model, &omega, &error, &messages), SELAS_OK);
    const double dt = .9 * 2 / omega;
    const char *given = getenv("HILL_STEPS"); /* more of them by hand */
    noise(run.n, run.y);
    const double before = energy_at(&run, dt);
    for (int step = 0; step < (given != NULL ? atoi(given) : 2000); step++)
        leap(&run, &(struct drive){0}, dt);
    const double change = energy_at(&run, dt) / before - 1;
    if (given != NULL) print_message("energy changes by %.2g\n", change);
    assert_true(fabs(change) < 1e-13);
    run_free(&run);
}

/* A quarter of a hill with symmetry planes gives what the whole gives: patch on the top, moment tensor below. */
static void test_quarter(void **state)
{
    (void)state;
    struct plain_scene plain[2];
    struct topography hill[2];
    struct run run[2];
    double value[2][3];
    for (int half = 0; half < 2; half++) {
        plain_box(&plain[half], 3, (double[]){3, 3, 2}, .25);
        hill[half] = steep_hill(&plain[half].scene, .4);
        hill[half].centre[0] = hill[half].centre[1] = 1.5;
        plain[half].scene.body.topography = &hill[half];
        if (half)
            for (int axis = 0; axis < 2; axis++) {
                plain[half].scene.body.low[axis] = 1.5;
                plain[half].scene.boundary[2 * axis].kind = BOUNDARY_SYMMETRY;
            }
        struct load *load = plain_face_load(&plain[half], FACE_Z_LOW, (double[]){0, 0, 1});
        load->shape = LOAD_SQUARE;
        load->size[0] = load->size[1] = 1;
        struct load *moment = plain_face_load(&plain[half], FACE_Z_LOW, (double[]){0, 0, 1});
        *moment = (struct load){
            .kind = LOAD_MOMENT_TENSOR, .shape = LOAD_POINT, .amplitude = 1, .moment = {1, 2, 3}};
        load->centre[0] = load->centre[1] = moment->centre[0] = moment->centre[1] = 1.5;
        moment->centre[2] = .3;
        run[half] = run_new(&plain[half], general());
        const double amplitude[2] = {1, 1};
        for (int step = 0; step < 30; step++)
            leap(&run[half], &(struct drive){.load = amplitude}, .04);
        velocity_at(&run[half], (double[]){1.8, 2.1, .2}, value[half]);
        run_free(&run[half]);
    }
    for (int i = 0; i < 3; i++)
        assert_true(fabs(value[0][i] - value[1][i]) < 1e-12 * fabs(value[0][2]));
}

static const double strain_of[3][3] = {{.3, -.2, .5}, {.1, .7, .4}, {-.6, .2, -.1}};

static void strain_evenly(const struct consistent *c, double *y)
{
    for (size_t i = 0; i < c->volume; i++) {
        double place[3];
        coordinates(c, 3, i, place);
        for (int component = 0; component < 3; component++)
            for (int axis = 0; axis < 3; axis++)
                y[(size_t)component * c->volume + i] += strain_of[component][axis] * place[axis];
    }
}

/* Stress of an even strain is that of Hooke's law wherever it is looked at. */
static void test_even_strain(void **state)
{
    (void)state;
    struct plain_scene plain;
    plain_box(&plain, 3, (double[]){3, 2.5, 2}, .25);
    struct topography hill = steep_hill(&plain.scene, .4);
    plain.scene.body.topography = &hill;
    struct run run = run_new(&plain, general());
    struct consistent *c = consistent_of(run.model);
    strain_evenly(c, run.y);
    const struct material *material = &plain.material[0];
    const double trace = strain_of[0][0] + strain_of[1][1] + strain_of[2][2];
    struct probe probe = {0};
    struct messages messages = {0};
    double stress[6], strain[6];
    assert_int_equal(run.model->core->probe(run.model, (double[]){1, 1.1, .25}, &probe, &messages), SELAS_OK);
    run.model->core->observe(run.model, &probe, SELAS_STRESS, run.y, run.a, stress);
    run.model->core->observe(run.model, &probe, SELAS_STRAIN, run.y, run.a, strain);
    assert_near(stress[2], material->lambda * trace + 2 * material->mu * strain_of[2][2], 1e-13);
    assert_near(stress[3], material->mu * (strain_of[0][1] + strain_of[1][0]), 1e-13);
    assert_near(strain[5], (strain_of[0][2] + strain_of[2][0]) / 2, 1e-13);
    double by_weights = 0;
    for (size_t w = 0; w < probe.count; w++)
        by_weights += probe.gradient[3 * w] * run.y[2 * c->volume + probe.index[w]];
    assert_near(by_weights, strain_of[2][0], 1e-13);
    probe_free(&probe);
    run_free(&run);
}

/* A moment tensor does as much work on an even strain as its components on the strain, but for the spread of its slopes
 * over the lattice, which falls with the spacing. */
static double moment_error(double spacing)
{
    struct plain_scene plain;
    plain_box(&plain, 3, (double[]){5, 5, 4}, spacing);
    struct topography hill = steep_hill(&plain.scene, 1);
    plain.scene.body.topography = &hill;
    struct load *load = plain_face_load(&plain, FACE_Z_LOW, (double[]){0, 0, 1});
    *load = (struct load){.kind = LOAD_MOMENT_TENSOR,
                          .shape = LOAD_POINT,
                          .amplitude = 1,
                          .centre = {2.6, 2.2, .35},
                          .moment = {1, -2, .5, .3, .7, -.9}};
    struct run run = run_new(&plain, general());
    struct consistent *c = consistent_of(run.model);
    strain_evenly(c, run.y);
    static const int place[6][2] = {{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}};
    double work = 0;
    for (int m = 0; m < 6; m++) {
        const int i = place[m][0], j = place[m][1];
        work += load->moment[m] * (i == j ? strain_of[i][j] : strain_of[i][j] + strain_of[j][i]);
    }
    const double error = fabs(sparse_dot(c, &c->load.of[0], run.y) - work);
    run_free(&run);
    return error;
}

static void test_moment(void **state)
{
    (void)state;
    const double coarse = moment_error(.25), fine = moment_error(.125);
    assert_true(coarse < .003 && fine < coarse / 8); /* .0023, .00027 */
}

static void test_layers_are_quiet(void **state)
{
    (void)state;
    struct plain_scene plain;
    plain_box(&plain, 3, (double[]){2, 1.75, 1.5}, .25);
    struct topography hill = steep_hill(&plain.scene, .3);
    for (int axis = 0; axis < 2; axis++) {
        hill.end[axis][0] = (struct drawn_out){.5, .5};
        hill.end[axis][1] = (struct drawn_out){plain.scene.body.high[axis] - .5, .5};
    }
    plain.scene.body.topography = &hill;
    assert_layers_are_quiet(&plain);
}

static void test_threads(void **state)
{
    (void)state;
    double *kept = NULL;
    for (int threads = 1; threads <= 3; threads += 2) {
        struct plain_scene plain;
        struct topography hill;
        omp_set_num_threads(threads);
        bits = 5;
        struct run run = hill_run(&plain, &hill, 3, (double[]){6, 5, 4}, .5);
        assert_same_steps(&run, threads, &kept);
        run_free(&run);
    }
    free(kept);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_map),         cmocka_unit_test(test_rigid_motions),
        cmocka_unit_test(test_symmetric),   cmocka_unit_test(test_largest_step),
        cmocka_unit_test(test_energy),      cmocka_unit_test(test_quarter),
        cmocka_unit_test(test_even_strain), cmocka_unit_test(test_moment),
        cmocka_unit_test(test_threads),     cmocka_unit_test(test_layers_are_quiet),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
