/* The general operator of the consistent method on random ground: symmetry, sign, rigid motions, plane waves,
 * the largest step, energy, dampers, symmetry planes, threads (doc/theory/general-ground.md). */
#include "general_run.h"

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_sort_vector.h>
#include <math.h>
#include <omp.h>
#include <string.h>

static struct run random_run(struct plain_scene *plain, int dimension, const double size[3])
{
    plain_box(plain, dimension, size, .25);
    struct run run = run_new(plain, general());
    make_random(consistent_of(run.model));
    return run;
}

static void test_symmetric_and_positive(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        struct plain_scene plain;
        struct run run = random_run(&plain, dimension, (double[]){1, .75, .75});
        struct consistent *c = consistent_of(run.model);
        gsl_matrix *k = gsl_matrix_alloc(run.n, run.n);
        double off = 0, largest = 0;
        for (size_t j = 0; j < run.n; j++) {
            memset(run.y, 0, run.n * sizeof *run.y);
            run.y[j] = 1;
            general_forces(c, run.y, NULL, run.a);
            for (size_t i = 0; i < run.n; i++)
                gsl_matrix_set(k, i, j, -run.a[i]);
        }
        for (size_t i = 0; i < run.n; i++)
            for (size_t j = 0; j < i; j++) {
                off = fmax(off, fabs(gsl_matrix_get(k, i, j) - gsl_matrix_get(k, j, i)));
                largest = fmax(largest, fabs(gsl_matrix_get(k, i, j)));
            }
        assert_true(off < 1e-14 * largest);
        gsl_vector *values = gsl_vector_alloc(run.n);
        gsl_eigen_symm_workspace *work = gsl_eigen_symm_alloc(run.n);
        gsl_eigen_symm(k, values, work);
        gsl_sort_vector(values);
        const double top = gsl_vector_get(values, run.n - 1);
        const size_t rigid = dimension == 2 ? 3 : 6;
        assert_true(gsl_vector_get(values, 0) > -1e-13 * top);
        assert_true(gsl_vector_get(values, rigid - 1) < 1e-13 * top); /* and no other null modes */
        assert_true(gsl_vector_get(values, rigid) > 1e-5 * top);
        gsl_eigen_symm_free(work);
        gsl_vector_free(values);
        gsl_matrix_free(k);
        run_free(&run);
    }
}

/* u_from = the coordinate along to, u_to = -s times that along from; control values of coordinates are the
 * Greville points. */
static void test_rigid_motions(void **state)
{
    (void)state;
    struct plain_scene plain;
    struct run run = random_run(&plain, 3, (double[]){2, 1.5, 1.25});
    struct consistent *c = consistent_of(run.model);
    double scale[2] = {0, 0};
    for (int s = -1; s <= 1; s += 2) /* a pure shear moves things, a rotation does not */
        for (int from = 0; from < 3; from++) {
            const int to = (from + 1) % 3;
            memset(run.y, 0, run.n * sizeof *run.y);
            for (size_t i = 0; i < c->volume; i++) {
                const size_t at[3] = {i % c->n[0], i / c->n[0] % c->n[1], i / c->plane};
                run.y[(size_t)from * c->volume + i] = 1 + c->spline[to]->greville[at[to]];
                run.y[(size_t)to * c->volume + i] = 2 - s * c->spline[from]->greville[at[from]];
            }
            general_forces(c, run.y, NULL, run.a);
            for (size_t i = 0; i < run.n; i++)
                scale[s > 0] = fmax(scale[s > 0], fabs(run.a[i]));
        }
    assert_true(scale[1] < 1e-14 * scale[0]);
    run_free(&run);
}

/* u_x = x^2 / 2: free edges and corners are pulled at by (lambda + 2 mu) times the exact integrals of x N'(x) and N, h / 3
 * each, and h along an edge. */
static void test_edges_are_exact(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        struct plain_scene plain;
        plain_box(&plain, dimension, (double[]){2.5, 2.25, 2.5}, .25);
        struct run run = run_new(&plain, general());
        struct consistent *c = consistent_of(run.model);
        const struct material *m = &run.model->scene->material[0];
        const double h = run.model->scene->body.spacing, third = h / 3;
        for (size_t i = 0; i < c->volume; i++) {
            const double x = c->layout[0]->greville[i % c->n[0]];
            const bool inside = i % c->n[0] > 0 && i % c->n[0] + 1 < c->n[0];
            run.y[i] = (x * x - (inside ? h * h / 4 : 0)) / 2;
        }
        general_forces(c, run.y, NULL, run.a);
        const size_t middle = dimension == 3 ? c->n[1] / 2 * c->n[0] : 0;
        const double edge = (m->plane_lambda + 2 * m->mu) * third * third * (dimension == 3 ? h : 1);
        assert_true(fabs(run.a[middle] - edge) < 1e-12 * edge);
        if (dimension == 3) assert_true(fabs(run.a[0] - edge / 3) < 1e-12 * edge);
        run_free(&run);
    }
}

/* Worst relative error of P and S over three directions, from the operator itself: cosines inside a box. */
static double dispersion(struct run *run, double points)
{
    static const double directions[3][3] = {
        {1, 0, 0}, {M_SQRT1_2, M_SQRT1_2, 0}, {.57735027, .57735027, .57735027}};
    struct consistent *c = consistent_of(run->model);
    const struct material *m = &run->model->scene->material[0];
    const double wavenumber = 2 * M_PI / points; /* times the spacing */
    const size_t middle = c->n[0] / 2 + c->n[0] * (c->n[1] / 2) + c->plane * (c->n[2] / 2);
    double worst = 0;
    gsl_matrix *symbol = gsl_matrix_alloc(3, 3);
    gsl_vector *values = gsl_vector_alloc(3);
    gsl_eigen_symm_workspace *work = gsl_eigen_symm_alloc(3);
    for (int d = 0; d < 3; d++) {
        for (size_t from = 0; from < 3; from++) {
            memset(run->y, 0, run->n * sizeof *run->y);
            for (size_t p = 0; p < c->volume; p++) {
                const double i = (double)(p % c->n[0]) - (double)(c->n[0] / 2);
                const double j = (double)(p / c->n[0] % c->n[1]) - (double)(c->n[1] / 2);
                const double k = (double)(p / c->plane) - (double)(c->n[2] / 2);
                run->y[from * c->volume + p] =
                    cos(wavenumber * (i * directions[d][0] + j * directions[d][1] + k * directions[d][2]));
            }
            run->model->spatial->accelerate(run->model, &(struct drive){0}, 0, run->y, NULL, run->a);
            for (size_t to = 0; to < 3; to++)
                gsl_matrix_set(symbol, to, from, -run->a[to * c->volume + middle]);
        }
        gsl_eigen_symm(symbol, values, work);
        gsl_sort_vector(values);
        for (size_t i = 0; i < 3; i++) {
            const double speed = i < 2 ? m->s_speed : m->p_speed, h = run->model->scene->body.spacing;
            worst = fmax(worst, fabs(sqrt(gsl_vector_get(values, i)) * h / (wavenumber * speed) - 1));
        }
    }
    gsl_matrix_free(symbol);
    gsl_vector_free(values);
    gsl_eigen_symm_free(work);
    return worst;
}

/* doc/theory/general-ground.md, section 6: phase errors for nu = 1/4 (worst of 150 directions there, three here). */
static void test_plane_waves(void **state)
{
    (void)state;
    static const double table[][2] = {{10, 1.3e-4}, {6, 8.6e-4}, {5, 2.4e-3}, {4, 6.9e-3}};
    struct plain_scene plain;
    plain_box(&plain, 3, (double[]){4.5, 4.5, 4.5}, .25);
    plain_material(&plain.material[0], 1, 1, 1);
    struct run run = run_new(&plain, general());
    for (size_t i = 0; i < 4; i++) {
        const double error = dispersion(&run, table[i][0]);
        assert_true(fabs(error / table[i][1] - 1) < .05);
    }
    run_free(&run);
}

static void test_largest_step(void **state)
{
    (void)state;
    for (int ground = 0; ground < 6; ground++) {
        struct plain_scene plain;
        struct run run = random_run(&plain, 2 + ground % 2, (double[]){1.5, 1.25, 1.5});
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
    struct run run = random_run(&plain, 3, (double[]){1.5, 1.25, 1});
    struct messages messages = {0};
    double omega, error;
    assert_int_equal(largest_frequency(run.model, &omega, &error, &messages), SELAS_OK);
    const double dt = .9 * 2 / omega;
    noise(run.n, run.y);
    const double before = energy_at(&run, dt);
    for (int step = 0; step < 2000; step++)
        leap(&run, &(struct drive){0}, dt);
    assert_true(fabs(energy_at(&run, dt) / before - 1) < 1e-13);
    run_free(&run);
}

/* Dampers on all faces: energy falls, at any step below the limit of the undamped body. */
static void test_dampers(void **state)
{
    (void)state;
    struct plain_scene plain;
    plain_box(&plain, 3, (double[]){1.5, 1.25, 1}, .25);
    for (int face = 0; face < BOX_FACES; face++)
        plain.scene.boundary[face].kind = BOUNDARY_TRANSMITTING;
    struct run run = run_new(&plain, general());
    make_random(consistent_of(run.model));
    struct messages messages = {0};
    double omega, error;
    assert_int_equal(largest_frequency(run.model, &omega, &error, &messages), SELAS_OK);
    noise(run.n, run.y);
    struct energy first, now;
    run.model->core->energy(run.model, run.y, &first);
    for (int step = 0; step < 2000; step++)
        leap(&run, &(struct drive){0}, .99 * 2 / omega);
    memset(run.y, 0, run.n * sizeof *run.y);
    run.model->core->energy(run.model, run.y, &now);
    assert_true(now.kinetic < 1e-4 * first.strain);
    double load, absorbed;
    noise(run.n, run.y + run.n);
    run.model->core->power(run.model, &(struct drive){0}, run.y, &load, &absorbed);
    assert_true(absorbed > 0);
    run_free(&run);
}

/* A quarter with symmetry planes gives what the whole gives. */
static void test_quarter(void **state)
{
    (void)state;
    struct plain_scene plain[2];
    struct run run[2];
    double value[2][3];
    for (int half = 0; half < 2; half++) {
        plain_box(&plain[half], 3, (double[]){2, 2, 1.5}, .25);
        if (half)
            for (int axis = 0; axis < 2; axis++) {
                plain[half].scene.body.low[axis] = 1;
                plain[half].scene.boundary[2 * axis].kind = BOUNDARY_SYMMETRY;
            }
        struct load *load = plain_face_load(&plain[half], FACE_Z_LOW, (double[]){0, 0, 1});
        load->shape = LOAD_SQUARE;
        load->size[0] = load->size[1] = 1;
        load->centre[0] = load->centre[1] = 1;
        run[half] = run_new(&plain[half], general());
        const double amplitude = 1;
        for (int step = 0; step < 30; step++)
            leap(&run[half], &(struct drive){.load = &amplitude}, .04);
        velocity_at(&run[half], (double[]){1.3, 1.6, .2}, value[half]);
        run_free(&run[half]);
    }
    for (int i = 0; i < 3; i++)
        assert_true(fabs(value[0][i] - value[1][i]) < 1e-12 * fabs(value[0][2]));
}

static void test_layers_are_quiet(void **state)
{
    (void)state;
    struct plain_scene plain;
    plain_box(&plain, 3, (double[]){1.5, 1.25, 1}, .25);
    assert_layers_are_quiet(&plain);
}

/* A pulse on the surface, one or two layers of ground, absorbing layers at x+ and z+ against a box so large that
 * nothing comes back: what comes back of the velocity at a receiver. */
static double sent_back(size_t layers)
{
    struct plain_scene plain[2];
    struct run run[2];
    double off = 0, norm = 0;
    for (int large = 0; large < 2; large++) {
        plain_box(&plain[large], 3, (double[]){2, 2, 2}, .25);
        struct scene *scene = &plain[large].scene;
        scene->body.layers = layers;
        plain[large].layer[0] = (struct layer){.material = 0};
        plain[large].layer[1] = (struct layer){.material = 1, .top = .6};
        for (int face = 0; face < 4; face++)
            scene->boundary[face].kind = BOUNDARY_SYMMETRY;
        struct boundary *far = &scene->boundary[FACE_X_HIGH], *deep = &scene->boundary[FACE_Z_HIGH];
        *far = *deep = (struct boundary){.kind = large ? BOUNDARY_FIXED : BOUNDARY_TRANSMITTING,
                                         .absorber = ABSORBER_PML,
                                         .layer_points = 10,
                                         .always = true};
        if (large) scene->body.high[0] = scene->body.high[2] = 6.5;
        struct load *load = plain_face_load(&plain[large], FACE_Z_LOW, (double[]){0, 0, 1});
        load->shape = LOAD_SQUARE;
        load->size[0] = 1;
        load->size[1] = 4;
        load->centre[1] = 2;
        run[large] = run_new(&plain[large], quick());
        free(run[large].y);
        run[large].y = calloc(run[large].model->state_size, sizeof *run[large].y);
    }
    const double dt = .04;
    for (int step = 0; step < 150; step++) {
        const double amplitude = exp(-pow((step * dt - 1.6) / .5, 2));
        double value[2][3];
        for (int large = 0; large < 2; large++) {
            const struct drive drive = {.load = &amplitude,
                                        .extra = large ? NULL : run[large].y + 2 * run[large].n};
            leap(&run[large], &drive, dt);
            velocity_at(&run[large], (double[]){1, 1, 0}, value[large]);
        }
        off += pow(value[0][0] - value[1][0], 2) + pow(value[0][2] - value[1][2], 2);
        norm += pow(value[1][0], 2) + pow(value[1][2], 2);
    }
    for (int large = 0; large < 2; large++)
        run_free(&run[large]);
    return sqrt(off / norm);
}

/* Forces along the layers in the middle of a step, half the sum of those at its ends (G13b), against those of the means;
 * the acceleration at the end from the forces made for them. */
static void test_layers_forces(void **state)
{
    (void)state;
    for (int dimension = 2; dimension <= 3; dimension++) {
        struct plain_scene plain;
        plain_box(&plain, dimension, (double[]){2, 2, 2}, .25);
        for (int face = 1; face < 2 * dimension; face++)
            plain.scene.boundary[face] = (struct boundary){
                .kind = BOUNDARY_TRANSMITTING, .absorber = ABSORBER_PML, .layer_points = 6, .always = true};
        struct run run = run_new(&plain, quick());
        struct model *model = run.model;
        const struct general *g = consistent_of(model)->general;
        const size_t n = run.n, all = model->state_size;
        double *start = calloc(all, sizeof *start), *mean = calloc(all, sizeof *mean);
        double *again = calloc(n, sizeof *again), *pulled = calloc(g->moments, sizeof *pulled);
        noise(all, start);
        model->memory->start(model, start, start + 2 * n);
        free(run.y);
        run.y = calloc(all, sizeof *run.y);
        memcpy(run.y, start, all * sizeof *start);
        const double dt = .04;
        for (size_t i = 0; i < n; i++)
            run.y[i] += dt * run.y[n + i];
        const struct drive drive = {.extra = run.y + 2 * n};
        model->memory->remember(model, dt, run.y, run.y + n, run.y + 2 * n);
        memcpy(pulled, g->pulled, g->moments * sizeof *pulled);
        model->spatial->accelerate(model, &drive, 0, run.y, NULL, run.a);
        model->spatial->accelerate(model, &drive, 0, run.y, NULL, again);
        assert_memory_equal(run.a, again, n * sizeof *again);
        for (size_t i = 0; i < all; i++)
            mean[i] = (start[i] + run.y[i]) / 2;
        general_forces(consistent_of(model), mean, mean + 2 * n, again);
        double off = 0, largest = 0;
        for (size_t i = 0; i < g->moments; i++) {
            off = fmax(off, fabs(pulled[i] - g->pulled[i]));
            largest = fmax(largest, fabs(pulled[i]));
        }
        assert_true(largest > 0 && off < 1e-13 * largest);
        free(start);
        free(mean);
        free(again);
        free(pulled);
        run_free(&run);
    }
}

static void test_layers_absorb(void **state)
{
    (void)state;
    assert_true(sent_back(1) < .0005); /* .00036; d_i in place of (G13a): .00088 */
    assert_true(sent_back(2) < .0007); /* .00055; .00080 */
}

static void test_threads(void **state)
{
    (void)state;
    double *kept = NULL;
    for (int threads = 1; threads <= 3; threads += 2) {
        struct plain_scene plain;
        omp_set_num_threads(threads);
        bits = 5;
        struct run run = random_run(&plain, 3, (double[]){6, 5, 4});
        assert_same_steps(&run, threads, &kept);
        run_free(&run);
    }
    free(kept);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_symmetric_and_positive),
        cmocka_unit_test(test_rigid_motions),
        cmocka_unit_test(test_edges_are_exact),
        cmocka_unit_test(test_plane_waves),
        cmocka_unit_test(test_largest_step),
        cmocka_unit_test(test_energy),
        cmocka_unit_test(test_dampers),
        cmocka_unit_test(test_quarter),
        cmocka_unit_test(test_threads),
        cmocka_unit_test(test_layers_are_quiet),
        cmocka_unit_test(test_layers_forces),
        cmocka_unit_test(test_layers_absorb),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
