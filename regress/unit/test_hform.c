/* The H-form: against dense matrices, its sign, energy, faces, symmetry planes, dispersion, long runs. */
#include "consistent_run.h"

#include "method/consistent/galerkin/hform.h"

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_linalg.h>
#include <gsl/gsl_sort_vector.h>
#include <math.h>
#include <omp.h>
#include <string.h>

static bool depth_exact; /* every test runs with both */

static struct consistent_options vc(int degree, int sweeps)
{
    return (struct consistent_options){.degree = degree, .sweeps = sweeps, .depth_exact = depth_exact};
}

static gsl_matrix *dense(const struct band *band)
{
    gsl_matrix *matrix = gsl_matrix_alloc(band->n, band->n);
    for (size_t i = 0; i < band->n; i++)
        for (size_t j = 0; j < band->n; j++)
            gsl_matrix_set(matrix, i, j, band_get(band, i, j));
    return matrix;
}

/* Inverse of N by LU of the dense matrix. */
static gsl_matrix *dense_inverse(const struct band *band)
{
    gsl_matrix *lu = dense(band), *inverse = gsl_matrix_alloc(band->n, band->n);
    gsl_permutation *order = gsl_permutation_alloc(band->n);
    int sign;
    gsl_linalg_LU_decomp(lu, order, &sign);
    gsl_linalg_LU_invert(lu, order, inverse);
    gsl_permutation_free(order);
    gsl_matrix_free(lu);
    return inverse;
}

/* out := matrix along an axis of in. */
static void along(const struct consistent *c, int axis, const gsl_matrix *matrix, const double *in,
                  double *out)
{
    const struct line_set set = line_set(c, c->slot[axis]);
    for (size_t l = 0; l < set.lines; l++)
        for (size_t i = 0; i < set.length; i++) {
            double sum = 0;
            for (size_t j = 0; j < set.length; j++)
                sum += gsl_matrix_get(matrix, i, j) * in[line_start(&set, l) + j * set.stride];
            out[line_start(&set, l) + i * set.stride] = sum;
        }
}

/* -M^-1 K u with dense 1-D matrices and H = N^-1 in every place of M, straight from Eqs 7 to 9. */
static void dense_acceleration(struct consistent *c, const double *u, double *a)
{
    const struct material *m = &c->model.scene->material[0];
    const int dimension = c->dimension;
    double *one = calloc(c->volume, sizeof *one), *two = calloc(c->volume, sizeof *two);
    memset(a, 0, c->model.unknowns * sizeof *a);
    for (int out = 0; out < dimension; out++) {
        for (int in = 0; in < dimension; in++)
            for (int test = 0; test < dimension; test++)
                for (int trial = 0; trial < dimension; trial++) {
                    double factor = 0; /* lambda d_out d_in + mu (delta d_k d_k + d_in d_out) */
                    if (test == out && trial == in) factor += m->lambda;
                    if (test == trial && out == in) factor += m->mu;
                    if (test == in && trial == out) factor += m->mu;
                    if (factor == 0) continue;
                    memcpy(one, u + (size_t)in * c->volume, c->volume * sizeof *one);
                    for (int axis = 0; axis < dimension; axis++) {
                        const bool bare =
                            axis != test && axis != trial && !(depth_exact && c->slot[axis] == DEPTH);
                        struct band *band = spline_matrix(c->spline[axis], axis == out, axis == test,
                                                          axis == in, axis == trial, NULL);
                        gsl_matrix *matrix = bare ? dense_inverse(c->hform->inverse[out][axis]) : dense(band);
                        along(c, axis, matrix, one, two);
                        memcpy(one, two, c->volume * sizeof *one);
                        gsl_matrix_free(matrix);
                        band_free(band);
                    }
                    for (size_t i = 0; i < c->volume; i++)
                        a[(size_t)out * c->volume + i] -= factor / m->density * one[i];
                }
        for (int axis = 0; axis < dimension; axis++) {
            gsl_matrix *matrix = dense(c->hform->inverse[out][axis]);
            along(c, axis, matrix, a + (size_t)out * c->volume, one);
            memcpy(a + (size_t)out * c->volume, one, c->volume * sizeof *one);
            gsl_matrix_free(matrix);
        }
    }
    free(one);
    free(two);
}

static void test_against_dense(void **state)
{
    (void)state;
    for (int dimension = 1; dimension <= 3; dimension++)
        for (int sweeps = 1; sweeps <= 3; sweeps++)
            for (int p = 1; p <= 3; p++) {
                struct plain_scene plain;
                plain_box(&plain, dimension, (double[]){2.1, 2.4, 1.5}, .3);
                if (sweeps == 3 && p < 3) plain.scene.boundary[0].kind = BOUNDARY_SYMMETRY;
                plain.scene.boundary[FACE_X_HIGH].kind = sweeps == 2 ? BOUNDARY_FREE : BOUNDARY_TRANSMITTING;
                struct run run = run_new(&plain, vc(p, sweeps));
                struct consistent *c = consistent_of(run.model);
                double *expected = calloc(run.n, sizeof *expected), largest = 0, off = 0;
                noise(run.n, run.y);
                if (c->spline[0]->centred[0]) /* an odd component is 0 on its plane */
                    for (size_t i = 0; i < c->volume; i++)
                        if (c->slot[0] == DEPTH ? i / c->plane == 0 : i % c->n[0] == 0) run.y[i] = 0;
                if (!c->spline[0]->centred[0]) dense_acceleration(c, run.y, expected);
                run.model->spatial->accelerate(run.model, &(struct drive){0}, 0, run.y, NULL, run.a);
                for (size_t i = 0; i < run.n && !c->spline[0]->centred[0]; i++) {
                    largest = fmax(largest, fabs(expected[i]));
                    off = fmax(off, fabs(expected[i] - run.a[i]));
                }
                assert_true(off <= 2e-14 * largest);
                free(expected);
                run_free(&run);
            }
}

/* S - G^T N G has no negative eigenvalue: the strain energy of the H-form is at least that of what N leaves.
 */
static void test_sign(void **state)
{
    (void)state;
    for (int p = 1; p <= 3; p++)
        for (int sweeps = 1; sweeps <= 3; sweeps++) {
            struct plain_scene plain;
            plain_box(&plain, 1, (double[]){6, 0, 0}, .3);
            struct model *model = make(&plain, vc(p, sweeps));
            struct consistent *c = consistent_of(model);
            struct band *s = spline_matrix(c->spline[0], false, 1, false, 1, NULL);
            struct band *g = spline_matrix(c->spline[0], false, 0, false, 1, NULL);
            struct band *t = spline_matrix(c->spline[0], false, 1, false, 0, NULL);
            struct band *ng = band_product(c->hform->inverse[0][0], g), *gng = band_product(t, ng);
            struct band *rest = band_sum(s, -1, gng);
            gsl_matrix *matrix = dense(rest);
            gsl_vector *values = gsl_vector_alloc(rest->n);
            gsl_eigen_symm_workspace *work = gsl_eigen_symm_alloc(rest->n);
            gsl_eigen_symm(matrix, values, work);
            assert_true(gsl_vector_min(values) > -1e-13 * gsl_vector_max(values));
            assert_true(gsl_vector_max(values) > .1);
            gsl_matrix_free(matrix);
            gsl_vector_free(values);
            gsl_eigen_symm_free(work);
            band_free(s);
            band_free(g);
            band_free(t);
            band_free(ng);
            band_free(gng);
            band_free(rest);
            model_free(&model);
        }
}

/* u.Kw / 2 from the model's energies. */
static double cross_energy(struct model *model, const double *u, const double *w)
{
    const size_t n = model->unknowns;
    double *y = calloc(2 * n, sizeof *y);
    struct energy plus, minus;
    for (size_t i = 0; i < n; i++)
        y[i] = u[i] + w[i];
    model->core->energy(model, y, &plus);
    for (size_t i = 0; i < n; i++)
        y[i] = u[i] - w[i];
    model->core->energy(model, y, &minus);
    free(y);
    return (plus.strain - minus.strain) / 4;
}

/* Leapfrog's energy is kept with all kinds of faces that take none, and falls by what a damped face takes. */
static void test_energy(void **state)
{
    (void)state;
    for (int kind = 0; kind < 7; kind++) {
        struct plain_scene plain;
        plain_box(&plain, 3, (double[]){2.1, 2.4, 1.8}, .3);
        plain.scene.boundary[FACE_X_LOW].kind = BOUNDARY_SYMMETRY;
        if (kind == 0) plain.scene.boundary[FACE_Y_HIGH].kind = BOUNDARY_FIXED;
        if (kind == 0) plain.scene.boundary[FACE_Z_HIGH].kind = BOUNDARY_ROLLER;
        if (kind > 1) plain.scene.boundary[kind - 1].kind = BOUNDARY_TRANSMITTING;
        if (kind > 1 && kind % 2 == 0) plain.scene.boundary[FACE_Y_LOW].kind = BOUNDARY_FIXED;
        struct run run = run_new(&plain, vc(1 + kind % 3, 3 - kind % 2));
        double *before = calloc(2 * run.n, sizeof *before), *v = run.y + run.n, energy = 0;
        const double dt = .02;
        noise(run.n, run.y);
        run.model->spatial->accelerate(run.model, &(struct drive){0}, 0, run.y, NULL, v);
        memset(run.y, 0, run.n * sizeof *run.y);
        for (int step = 0; step < 60; step++) {
            memcpy(before, run.y, 2 * run.n * sizeof *before);
            leap(&run, &(struct drive){0}, dt);
            struct energy parts;
            run.model->core->energy(run.model, run.y, &parts);
            const double now = parts.kinetic + cross_energy(run.model, before, run.y);
            for (size_t i = 0; i < run.n; i++)
                before[run.n + i] = (before[run.n + i] + v[i]) / 2;
            double input, loss;
            run.model->core->power(run.model, &(struct drive){0}, before, &input, &loss);
            assert_true(kind > 1 ? loss > 0 : loss == 0);
            if (step > 0) assert_near((energy - now - dt * loss) / energy, 0, 2e-12);
            energy = now;
        }
        free(before);
        run_free(&run);
    }
}

/* Constant strain under its tractions and rigid motion: as for the exact mass, to rounding. */
static void test_patch(void **state)
{
    (void)state;
    static const double strain[3][3] = {{.3, .1, -.2}, {.4, -.5, .25}, {-.1, .7, .2}};
    for (int p = 1; p <= 3; p++) {
        struct plain_scene plain;
        plain_box(&plain, 3, (double[]){2.1, 1.8, 2.4}, .3);
        const struct material *m = &plain.material[0];
        const double trace = strain[0][0] + strain[1][1] + strain[2][2];
        for (int face = 0; face < 6; face++) {
            double traction[3];
            for (int i = 0; i < 3; i++)
                traction[i] =
                    face_sign((enum face)face) * (m->mu * (strain[i][face / 2] + strain[face / 2][i]) +
                                                  (i == face / 2 ? m->lambda * trace : 0));
            plain_face_load(&plain, (enum face)face, traction);
        }
        struct run run = run_new(&plain, vc(p, 3));
        struct consistent *c = consistent_of(run.model);
        for (size_t q = 0; q < c->volume; q++) {
            const size_t at[3] = {q % c->n[0], q / c->n[0] % c->n[1], q / c->plane};
            for (int i = 0; i < 3; i++)
                for (int j = 0; j < 3; j++)
                    run.y[(size_t)i * c->volume + q] += strain[i][j] * c->spline[j]->greville[at[j]];
        }
        const double ones[PLAIN_LOADS] = {1, 1, 1, 1, 1, 1};
        run.model->spatial->accelerate(run.model, &(struct drive){.load = ones}, 0, run.y, NULL, run.a);
        for (size_t i = 0; i < run.n; i++)
            assert_near(run.a[i], 0, 1e-11);
        run_free(&run);
    }
}

/* All faces transmitting, at .9 of the limit that accelerate() itself shows: the motion dies away. Between
 * rigid walls it stays bounded. */
static void test_long_runs(void **state)
{
    (void)state;
    for (int walls = 0; walls < 2; walls++) {
        struct plain_scene plain;
        plain_box(&plain, 3, (double[]){1.8, 1.5, 1.8}, .3);
        for (int face = 0; face < 6; face++)
            plain.scene.boundary[face].kind = walls ? BOUNDARY_FIXED : BOUNDARY_TRANSMITTING;
        struct run run = run_new(&plain, vc(2, 3));
        double omega = 0;
        noise(run.n, run.y);
        for (int iteration = 0; iteration < 400; iteration++) {
            run.model->spatial->accelerate(run.model, &(struct drive){0}, 0, run.y, NULL, run.a);
            omega = sqrt(sqrt(dot(run.n, run.a, run.a) / dot(run.n, run.y, run.y)));
            for (size_t i = 0; i < run.n; i++)
                run.y[i] = -run.a[i] / (omega * omega);
        }
        noise(run.n, run.y);
        run.model->spatial->accelerate(run.model, &(struct drive){0}, 0, run.y, NULL, run.y + run.n);
        memset(run.y, 0, run.n * sizeof *run.y);
        const double dt = 1.8 / omega, first = dot(run.n, run.y + run.n, run.y + run.n);
        for (int step = 0; step < 3000; step++)
            leap(&run, &(struct drive){0}, dt);
        const double last = dot(run.n, run.y + run.n, run.y + run.n);
        assert_true(last < (walls ? 20 : 1e-6) * first);
        run_free(&run);
    }
}

/* A quarter with symmetry planes does what the whole box does, to rounding; so do 1 and 3 threads, to the
 * bit. */
static void test_symmetry_planes(void **state)
{
    (void)state;
    for (int p = 1; p <= 3; p++) {
        struct run run[3];
        struct plain_scene plain[3];
        const int most = omp_get_max_threads();
        for (int i = 0; i < 3; i++) {
            plain_box(&plain[i], 3, (double[]){4.8, 4.8, 1.8}, .3);
            struct scene *scene = &plain[i].scene;
            scene->boundary[FACE_Z_HIGH].kind = scene->boundary[FACE_X_HIGH].kind = BOUNDARY_TRANSMITTING;
            scene->boundary[FACE_X_LOW].kind = BOUNDARY_TRANSMITTING;
            if (i > 0) {
                scene->body.low[0] = scene->body.low[1] = 2.4;
                scene->boundary[FACE_X_LOW].kind = scene->boundary[FACE_Y_LOW].kind = BOUNDARY_SYMMETRY;
            }
            struct load *load = plain_face_load(&plain[i], FACE_Z_LOW, (double[]){0, 0, 1});
            load->shape = LOAD_SQUARE;
            load->centre[0] = load->centre[1] = 2.4;
            load->size[0] = 1.3;
            load->size[1] = .9;
            omp_set_num_threads(i == 2 ? 3 : 1);
            run[i] = run_new(&plain[i], vc(p, 3));
            for (int step = 0; step < 60; step++) {
                const double amplitude = sin(.2 * step);
                leap(&run[i], &(struct drive){.load = &amplitude}, .02);
            }
        }
        omp_set_num_threads(most);
        assert_memory_equal(run[1].a, run[2].a, run[1].n * sizeof(double));
        static const double places[2][3] = {{2.4, 2.4, 0}, {3.3, 2.5, .4}};
        for (int place = 0; place < 2; place++) {
            double value[2][3];
            for (int i = 0; i < 2; i++) {
                struct probe probe = {0};
                struct messages messages = {0};
                run[i].model->core->probe(run[i].model, places[place], &probe, &messages);
                run[i].model->core->observe(run[i].model, &probe, SELAS_VELOCITY, run[i].y, run[i].a,
                                            value[i]);
                probe_free(&probe);
            }
            if (place == 0) assert_true(fabs(value[0][2]) > .04);
            for (int component = 0; component < 3; component++)
                assert_near(value[1][component], value[0][component], 1e-12);
        }
        for (int i = 0; i < 3; i++)
            run_free(&run[i]);
    }
}

/* The moved end of a bar sends the wave u(t - x / c) into it (d'Alembert); exact mass beside it. */
static double moved_end_error(int sweeps, double spacing)
{
    struct plain_scene plain;
    plain_box(&plain, 1, (double[]){6, 0, 0}, spacing);
    plain.scene.boundary[FACE_X_LOW] =
        (struct boundary){.kind = BOUNDARY_DISPLACEMENT, .direction = {1, 0, 0}, .amplitude = 1};
    struct run run = run_new(&plain, vc(2, sweeps));
    const double dt = .002, speed = plain.material[0].p_speed;
    for (int step = 0; step < 1250; step++) { /* u = exp(-s^2 / 2 w^2), s = t - 1, w = .2 */
        const double s = (step * dt - 1) / .2, motion[FACES] = {(s * s - 1) * exp(-s * s / 2) / .04};
        leap(&run, &(struct drive){.motion = motion}, dt);
    }
    double worst = 0;
    for (int i = 0; i < 40; i++) {
        const double x = .05 * i, s = (1250 * dt - x / speed - 1) / .2;
        double value[3];
        struct probe probe = {0};
        struct messages messages = {0};
        run.model->core->probe(run.model, (double[]){x, 0, 0}, &probe, &messages);
        run.model->core->observe(run.model, &probe, SELAS_DISPLACEMENT, run.y, run.a, value);
        probe_free(&probe);
        worst = fmax(worst, fabs(value[0] - exp(-s * s / 2)));
    }
    run_free(&run);
    return worst;
}

static void test_prescribed(void **state)
{
    (void)state;
    for (int sweeps = 0; sweeps <= 3; sweeps++) {
        const double coarse = moved_end_error(sweeps, .1), fine = moved_end_error(sweeps, .05);
        assert_true(coarse < (sweeps == 1 ? .005 : sweeps == 2 ? 8e-4 : 3e-4));
        assert_true(fine < 5e-4); /* leapfrog's own error is 2.3e-4 */
    }
}

/* Along an axis P and S waves have omega^2 = c^2 N^ S^, with the 1-D symbols for p = 2
 *
 *   M^ = (66 + 52 cos k + 2 cos 2k) / 120,
 *   S^ = 1 - (2/3) cos k - (1/3) cos 2k,
 *   N^ = (1 - (1 - M^)^(m+1)) / M^.
 *
 * Three sweeps, worst of three directions at 10, 6, 4 points: 7.8e-5, 6.7e-4, 1.8e-2. */
static void test_dispersion(void **state)
{
    (void)state;
    static const double points[] = {10, 6, 4}, worst[] = {7.8e-5, 6.7e-4, 1.76e-2};
    for (int sweeps = 1; sweeps <= 3; sweeps++) {
        struct plain_scene plain;
        plain_box(&plain, 3, (double[]){5, 5, 5}, .25);
        plain_material(&plain.material[0], 1, 1, 1);
        struct model *model = make(&plain, vc(2, sweeps));
        for (int i = 0; i < 3; i++) {
            const double k = 2 * M_PI / points[i], mass = (66 + 52 * cos(k) + 2 * cos(2 * k)) / 120;
            const double stiffness = 1 - 2 * cos(k) / 3 - cos(2 * k) / 3;
            const double inverse = (1 - pow(1 - mass, sweeps + 1)) / mass;
            const double theory = fabs(sqrt(inverse * stiffness) / k - 1);
            assert_near(worst_dispersion(model, 1, points[i], .25), theory, 1e-10);
            if (sweeps == 3) assert_near(worst_dispersion(model, 3, points[i], .25) / worst[i], 1, .02);
        }
        model_free(&model);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_dispersion),
        cmocka_unit_test(test_against_dense),
        cmocka_unit_test(test_sign),
        cmocka_unit_test(test_energy),
        cmocka_unit_test(test_patch),
        cmocka_unit_test(test_long_runs),
        cmocka_unit_test(test_symmetry_planes),
        cmocka_unit_test(test_prescribed),
    };
    omp_set_num_threads(1); /* small models */
    const int failed = cmocka_run_group_tests_name("H-form", tests, NULL, NULL);
    depth_exact = true;
    return failed + cmocka_run_group_tests_name("H-form, exact over depth", tests, NULL, NULL);
}
