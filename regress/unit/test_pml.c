/* Absorbing layers: what comes back from waves at all angles, quiet long runs, symmetry planes, layers that
 * nobody needs, scenes without layers. */
#include "consistent_run.h"
#include "few.h"

#include "method/consistent/absorbing/pml.h"
#include "scene/absorbing_layers.h"
#include "stepping/stepping.h"

#include <omp.h>

static const struct consistent_options standard = {.degree = 2, .sweeps = 3};

static void set_layer(struct plain_scene *plain, int face, long points)
{
    struct boundary *boundary = &plain->scene.boundary[face];
    boundary->kind = BOUNDARY_TRANSMITTING;
    boundary->absorber = ABSORBER_PML;
    boundary->layer_points = points;
}

static struct run start(const struct plain_scene *plain, const struct consistent_options *options)
{
    struct run run = run_new(plain, *options);
    free(run.y);
    run.y = calloc(run.model->state_size, sizeof *run.y);
    return run;
}

static double safe_step(const struct run *run)
{
    double omega, error;
    struct messages messages = {0};
    assert_int_equal(largest_frequency(run->model, &omega, &error, &messages), SELAS_OK);
    return 1.8 / (omega * (1 + error));
}

/* A pulse in a box, 0 .. 4 along each axis, whose faces in the mask have layers, and in one so large that
 * nothing comes back; v at three places over the whole time. Gives the norms of the difference and of v. */
static void compare(const struct consistent_options *options, int dimension, double nu, unsigned layered,
                    long points, double end, bool soft_top, double *off, double *norm)
{
    static struct layer ground[2] = {{.material = 1, .top = 0}, {.material = 0, .top = 1}};
    struct material material[2];
    static const double places[3][3] = {{1, 1.5, 0}, {3.25, .5, 0}, {2, 3.5, 0}};
    struct plain_scene plain[2];
    struct run run[2];
    for (int i = 0; i < 2; i++) {
        plain_box(&plain[i], dimension, (double[]){4, 4, 4}, .25);
        struct scene *scene = &plain[i].scene;
        plain_material(&plain[i].material[0], 1, 2 * nu / (1 - 2 * nu), 1);
        if (soft_top) { /* half as stiff */
            material[0] = plain[i].material[0];
            plain_material(&material[1], 1, nu / (1 - 2 * nu), .5);
            scene->material = material;
            scene->materials = 2;
            scene->body.layer = ground;
            scene->body.layers = 2;
        }
        for (int face = 0; face < 2 * dimension; face++) {
            if ((layered & 1u << face) == 0) continue;
            if (i == 0) set_layer(&plain[i], face, points);
            if (i == 1 && face % 2 == 0) scene->body.low[face / 2] -= 8;
            if (i == 1 && face % 2 == 1) scene->body.high[face / 2] += 8;
        }
        scene->initial = (struct initial){.kind = INITIAL_GAUSSIAN, .amplitude = 1, .width = .5};
        for (int axis = 0; axis < dimension; axis++) {
            scene->initial.centre[axis] = 2;
            scene->initial.direction[axis] = axis == 0 ? .6 : .8;
        }
        run[i] = start(&plain[i], options);
        run[i].model->core->initialise(run[i].model, run[i].y);
    }
    const double dt = fmin(safe_step(&run[0]), safe_step(&run[1]));
    *off = *norm = 0;
    for (int step = 0; step < end / dt; step += 2)
        for (int place = 0; place < 3; place++) {
            double value[2][3];
            for (int i = 0; i < 2; i++) {
                struct probe probe = {0};
                struct messages messages = {0};
                if (place == 0) march(&run[i], dt, 2);
                run[i].model->core->probe(run[i].model, places[place], &probe, &messages);
                run[i].model->core->observe(run[i].model, &probe, SELAS_VELOCITY, run[i].y, run[i].a,
                                            value[i]);
                probe_free(&probe);
            }
            for (int c = 0; c < dimension; c++) {
                *off += pow(value[0][c] - value[1][c], 2);
                *norm += pow(value[1][c], 2);
            }
        }
    *off = sqrt(*off);
    *norm = sqrt(*norm);
    run_free(&run[0]);
    run_free(&run[1]);
}

/* Normal incidence (a bar), all angles and corners (a square), the free surface and its waves (face y-). */
static void test_reflection(void **state)
{
    (void)state;
    static const struct {
        int dimension;
        unsigned layered;
        long points;
        double nu, end, most;
        bool soft_top;
        int degree, sweeps; /* 0: exact mass */
    } cases[] = {{1, 3, 8, .25, 6, 5e-3, false, 2, 3},    {1, 3, 12, .25, 6, 3e-4, false, 2, 3},
                 {2, 15, 8, .25, 6, 2.5e-3, false, 2, 3}, {2, 15, 12, .25, 6, 1.5e-4, false, 2, 3},
                 {2, 11, 8, .25, 6, 2e-3, false, 2, 3},   {2, 11, 8, .45, 3, 3e-3, false, 2, 3},
                 {2, 11, 8, .25, 6, 3e-3, true, 2, 3},    {2, 11, 12, .25, 6, 9e-4, true, 2, 3},
                 {2, 15, 8, .25, 6, 2.5e-3, false, 2, 0}, {2, 11, 8, .45, 3, 4.2e-3, false, 3, 0},
                 {2, 11, 8, .25, 6, 3e-3, false, 4, 0},   {2, 11, 8, .25, 6, 3e-3, true, 4, 0},
                 {2, 15, 12, .25, 6, 1.5e-4, false, 4, 0}};
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        double off, norm;
        const struct consistent_options options = {.degree = cases[i].degree, .sweeps = cases[i].sweeps};
        compare(&options, cases[i].dimension, cases[i].nu, cases[i].layered, cases[i].points, cases[i].end,
                cases[i].soft_top, &off, &norm);
        print_message("# reflection %zu: %.3g of %.3g: %.3g\n", i, off, norm, off / norm);
        assert_true(norm > .1);
        assert_true(off < cases[i].most * norm);
    }
}

/* Noise dies away and never comes back, whatever Poisson's ratio, with layers all around and on both sides of
 * a thin body, at nine tenths of the limit. Under a free face the fastest modes of the open knots, bound to
 * the face, stay; nothing grows. */
static void test_quiet(void **state)
{
    (void)state;
    static const double poisson[3] = {.25, .45, .49};
    for (int kind = 0; kind < 3; kind++) /* square, thin, free face */
        for (int material = few_of(0, 2); material < 3; material++) {
            struct plain_scene plain;
            plain_box(&plain, 2, (double[]){2.5, kind == 1 ? 1 : 2.5, 0}, .25);
            plain_material(&plain.material[0], 1, 2 * poisson[material] / (1 - 2 * poisson[material]), 1);
            for (int face = 0; face < 4; face++)
                if (face != FACE_Y_LOW || kind < 2) set_layer(&plain, face, 6);
            struct run run = start(&plain, &standard);
            double *v = run.y + run.n, first = 0, before = 0;
            const double dt = safe_step(&run);
            noise(run.n, run.y);
            run.model->spatial->accelerate(run.model, &(struct drive){0}, 0, run.y, NULL, v);
            memset(run.y, 0, run.n * sizeof *run.y);
            first = dot(run.n, v, v);
            for (int round = 0; round < 8; round++) {
                double most = 0;
                for (int part = 0; part < 25; part++) {
                    march(&run, dt, 10);
                    most = fmax(most, dot(run.n, v, v));
                }
                if (round > 0) assert_true(most < (kind < 2 ? 1.01 * before : first));
                before = most;
            }
            print_message("# noise left, kind %d, nu %g: %.2g\n", kind, poisson[material], before / first);
            assert_true(before < (kind < 2 ? 1e-3 : .1) * first);
            run_free(&run);
        }
}

/* A quarter with symmetry planes does what the whole does; 1 and 3 threads give the same bits. */
static void test_symmetry_planes(void **state)
{
    (void)state;
    struct plain_scene plain[3];
    struct run run[3];
    const int most = omp_get_max_threads();
    for (int i = 0; i < 3; i++) {
        plain_box(&plain[i], 3, (double[]){4.8, 4.8, 1.2}, .4);
        struct scene *scene = &plain[i].scene;
        for (int face = 0; face < 6; face++)
            if (face != FACE_Z_LOW) set_layer(&plain[i], face, 4);
        if (i > 0) {
            scene->body.low[0] = scene->body.low[1] = 2.4;
            scene->boundary[FACE_X_LOW].kind = scene->boundary[FACE_Y_LOW].kind = BOUNDARY_SYMMETRY;
        }
        scene->initial = (struct initial){.kind = INITIAL_GAUSSIAN,
                                          .amplitude = 1,
                                          .width = .6,
                                          .centre = {2.4, 2.4, .3},
                                          .direction = {0, 0, 1}};
        omp_set_num_threads(i == 2 ? 3 : 1);
        run[i] = start(&plain[i], &standard);
        run[i].model->core->initialise(run[i].model, run[i].y);
        march(&run[i], .05, 60);
    }
    omp_set_num_threads(most);
    assert_memory_equal(run[1].y, run[2].y, run[1].model->state_size * sizeof(double));
    static const double places[2][3] = {{2.4, 2.4, 0}, {4, 2.8, .4}};
    for (int place = 0; place < 2; place++) {
        double value[2][3];
        for (int i = 0; i < 2; i++)
            velocity_at(&run[i], places[place], value[i]);
        assert_true(fabs(value[0][2]) > 1e-3);
        for (int component = 0; component < 3; component++)
            assert_near(value[1][component], value[0][component], 1e-12);
    }
    for (int i = 0; i < 3; i++)
        run_free(&run[i]);
}

/* Points, positions and the state: users see their box, the state has the memory, others have nothing of it.
 */
static void test_what_is_kept(void **state)
{
    (void)state;
    struct plain_scene plain, with;
    plain_box(&plain, 3, (double[]){1.5, 1.2, 1.5}, .3);
    with = plain;
    with.scene.material = with.material;
    set_layer(&with, FACE_X_HIGH, 5);
    struct run bare = start(&plain, &standard), layered = start(&with, &standard);
    assert_null(bare.model->memory);
    assert_null(consistent_of(bare.model)->pml);
    assert_int_equal(bare.model->state_size, 2 * bare.model->unknowns);
    assert_int_equal(layered.model->points, bare.model->points);
    for (size_t i = 0; i < bare.model->points; i++) {
        double x[2][3];
        model_position(layered.model, i, x[0]);
        model_position(bare.model, i, x[1]);
        assert_memory_equal(x[0], x[1], sizeof x[0]);
    }
    const struct consistent *c = consistent_of(layered.model);
    assert_int_equal(c->n[0], consistent_of(bare.model)->n[0] + 5);
    assert_int_equal(layered.model->state_size - 2 * layered.model->unknowns,
                     18 * c->pml->slab[0].inside.n[0] * c->n[1] * c->n[2] / 3);
    run_free(&bare);
    run_free(&layered);
}

/* The fastest place in a layer is found and named; speeds that are not finite go before all others. */
static void test_fastest_place(void **state)
{
    (void)state;
    struct plain_scene plain;
    plain_box(&plain, 2, (double[]){1.5, 1.5, 0}, .25);
    set_layer(&plain, FACE_X_HIGH, 4);
    set_layer(&plain, FACE_Y_HIGH, 4);
    struct run run = start(&plain, &standard);
    const struct consistent *c = consistent_of(run.model);
    const struct slab *upper = &c->pml->slab[1];
    const size_t i = 3, k = upper->inside.at[DEPTH] + 2, at = k * c->plane + i;
    double *v = run.y + run.n, x, y, z;
    struct unseen found;
    for (size_t j = 0; j < run.n; j++)
        v[j] = 1e-3;
    for (int bad = 0; bad < 2; bad++) {
        v[at] = bad == 1 ? NAN : 3;
        v[c->volume + at] = 4;
        run.model->core->unseen(run.model, run.y, &found);
        assert_true(bad == 1 ? isinf(found.speed) : fabs(found.speed - 5) < 1e-12);
        assert_true(found.spoiled == (size_t)bad);
        assert_int_equal(
            sscanf(found.place, "in the layer behind face y+, a%*[bout] (%lf, %lf, %lf)", &x, &y, &z), 3);
        assert_near(x, c->spline[0]->greville[i], 1e-5);
        assert_near(y, c->spline[1]->greville[k], 1e-5);
        assert_true(y > 1.5);
    }
    run_free(&run);
}

/* A layer is left out where no reflection is seen by end_time, and kept one wave path later or on request.
 */
static void test_left_out(void **state)
{
    (void)state;
    struct plain_scene plain;
    struct receiver receiver = {.position = {1, 0, 0}};
    plain_box(&plain, 2, (double[]){6, 6, 0}, .25);
    struct load *load = plain_face_load(&plain, FACE_Y_LOW, (double[]){0, 1, 0});
    load->shape = LOAD_SQUARE;
    load->size[0] = load->size[1] = 1;
    load->centre[0] = 1;
    plain.scene.receivers = 1;
    plain.scene.receiver = &receiver;
    set_layer(&plain, FACE_X_HIGH, 8);
    const double speed = plain.material[0].p_speed; /* the path is 4.5 + 5 */
    plain.scene.end_time = 8 / speed;
    assert_true(layer_left_out(&plain.scene, FACE_X_HIGH));
    assert_int_equal(layer_points(&plain.scene, FACE_X_HIGH), 0);
    plain.scene.boundary[FACE_X_HIGH].always = true;
    assert_int_equal(layer_points(&plain.scene, FACE_X_HIGH), 8);
    plain.scene.boundary[FACE_X_HIGH].always = false;
    plain.scene.end_time = 9.5 / speed;
    assert_int_equal(layer_points(&plain.scene, FACE_X_HIGH), 8);
    plain.scene.end_time = 8 / speed;
    plain.scene.boundary[FACE_X_LOW].kind = BOUNDARY_SYMMETRY; /* images are no nearer */
    assert_true(layer_left_out(&plain.scene, FACE_X_HIGH));
    receiver.position[0] = 5;
    assert_int_equal(layer_points(&plain.scene, FACE_X_HIGH), 8);
    plain.scene.boundary[FACE_X_HIGH].layer_points = 0;
    assert_true(layer_points(&plain.scene, FACE_X_HIGH) >= LAYER_POINTS);
    plain.scene.boundary[FACE_X_HIGH].layer_reflection = layer_expected_reflection(12);
    assert_int_equal(layer_points(&plain.scene, FACE_X_HIGH), 12);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_reflection),      cmocka_unit_test(test_quiet),
        cmocka_unit_test(test_symmetry_planes), cmocka_unit_test(test_what_is_kept),
        cmocka_unit_test(test_left_out),        cmocka_unit_test(test_fastest_place),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
