/* The consistent method: its operators alone. Symmetry and null space, patch tests, dispersion against
 * theory, discrete energy, faces, loads, symmetry planes, rotation, threads. */
#include "near.h"

#include "method/consistent.h"
#include "plain_scene.h"

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_sort_vector.h>
#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

static struct consistent_options plain_options(int degree, bool mapped)
{
    return (struct consistent_options){.degree = degree, .mapped = mapped};
}

static struct model *make(const struct plain_scene *plain, struct consistent_options options)
{
    struct messages messages = {0};
    struct model *model = NULL;
    if (consistent_create_with(&plain->scene, &options, &model, &messages) != SELAS_OK)
        print_error("%s", messages.text);
    assert_non_null(model);
    return model;
}

static void noise(size_t n, double *x)
{
    uint64_t seed = 7;
    for (size_t i = 0; i < n; i++) {
        seed = seed * 6364136223846793005u + 1442695040888963407u;
        x[i] = (double)(seed >> 11) * 0x1p-52 - 1;
    }
}

/* Whole field out = plan u. */
static void apply(struct consistent *c, const struct tensor_plan *plan, const double *u, double *out)
{
    memset(out, 0, c->model.unknowns * sizeof *out);
    for (size_t k = 0; k < c->n[DEPTH]; k++) {
        double *plane[3];
        for (int i = 0; i < c->dimension; i++)
            plane[i] = out + (size_t)i * c->volume + k * c->plane;
        tensor_plane(plan, 0, k, 1, u, plane);
    }
}

static double dot(size_t n, const double *a, const double *b)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

/* K is symmetric, has no negative eigenvalue, and its null space is exactly the rigid motions. */
static void test_stiffness_spectrum(void **state)
{
    (void)state;
    static const int rigid[] = {1, 3, 6};
    for (int dimension = 1; dimension <= 3; dimension++)
        for (int kind = 0; kind < 2; kind++) {
            struct plain_scene plain;
            plain_box(&plain, dimension, kind ? (double[]){1.5, 1.5, 1.5} : (double[]){.6, .9, .6}, .3);
            struct model *model = make(&plain, plain_options(kind ? 2 : 3, kind));
            struct consistent *c = consistent_of(model);
            const size_t n = model->unknowns;
            gsl_matrix *k = gsl_matrix_alloc(n, n);
            gsl_vector *values = gsl_vector_alloc(n);
            gsl_eigen_symm_workspace *work = gsl_eigen_symm_alloc(n);
            double *unit = calloc(n, sizeof *unit), *column = calloc(n, sizeof *column), skew = 0;
            for (size_t j = 0; j < n; j++) {
                unit[j] = 1;
                apply(c, c->stiffness, unit, column);
                unit[j] = 0;
                for (size_t i = 0; i < n; i++)
                    gsl_matrix_set(k, i, j, column[i]);
            }
            for (size_t i = 0; i < n; i++)
                for (size_t j = 0; j < i; j++)
                    skew = fmax(skew, fabs(gsl_matrix_get(k, i, j) - gsl_matrix_get(k, j, i)));
            assert_true(skew < 1e-14);
            gsl_eigen_symm(k, values, work);
            const double largest = gsl_vector_max(values);
            int zero = 0;
            for (size_t i = 0; i < n; i++) {
                assert_true(gsl_vector_get(values, i) > -1e-13 * largest);
                zero += gsl_vector_get(values, i) < 1e-9 * largest;
            }
            assert_int_equal(zero, rigid[dimension - 1]);
            gsl_matrix_free(k);
            gsl_vector_free(values);
            gsl_eigen_symm_free(work);
            free(unit);
            free(column);
            model_free(&model);
        }
}

/* A linear displacement under the tractions of its stress is in balance; a rigid motion needs none. */
static void test_patch(void **state)
{
    (void)state;
    static const double strain[3][3] = {{.3, .1, -.2}, {.4, -.5, .25}, {-.1, .7, .2}}; /* du_i/dx_j */
    for (int dimension = 1; dimension <= 3; dimension++)
        for (int kind = 0; kind < 4; kind++) {
            struct plain_scene plain;
            plain_box(&plain, dimension, (double[]){1.2, 1.5, 1.8}, .15);
            const struct material *m = &plain.material[0];
            double trace = 0;
            for (int i = 0; i < dimension; i++)
                trace += strain[i][i];
            for (int face = 0; face < 2 * dimension; face++) {
                double traction[3] = {0};
                for (int i = 0; i < dimension; i++)
                    traction[i] =
                        face_sign((enum face)face) * (m->mu * (strain[i][face / 2] + strain[face / 2][i]) +
                                                      (i == face / 2 ? m->lambda * trace : 0));
                plain_face_load(&plain, (enum face)face, traction);
            }
            struct model *model = make(&plain, plain_options(kind % 2 ? 3 : 2, kind / 2));
            struct consistent *c = consistent_of(model);
            double *y = calloc(2 * model->unknowns, sizeof *y), *a = calloc(model->unknowns, sizeof *a);
            for (size_t p = 0; p < c->volume; p++) {
                const size_t at[3] = {p % c->n[0], p / c->n[0] % c->n[1], p / c->plane};
                for (int i = 0; i < dimension; i++)
                    for (int j = 0; j < dimension; j++)
                        y[(size_t)i * c->volume + p] += strain[i][j] * c->spline[j]->greville[at[c->slot[j]]];
            }
            const double ones[PLAIN_LOADS] = {1, 1, 1, 1, 1, 1};
            const struct drive drive = {.load = ones};
            model->class->accelerate(model, &drive, 0, y, NULL, a);
            for (size_t i = 0; i < model->unknowns; i++)
                assert_near(a[i], 0, 2e-9); /* K is of order 1/dx, its inverse mass of order 1/dx^3 */
            struct probe probe = {0};
            struct messages messages = {0};
            assert_int_equal(model->class->probe(model, (double[]){.31, .77, 1.03}, &probe, &messages),
                             SELAS_OK);
            double stress[6];
            model->class->observe(model, &probe, SELAS_STRESS, y, a, stress);
            assert_near(stress[0], 2 * m->mu * strain[0][0] + m->lambda * trace, 1e-12);
            if (dimension == 3) assert_near(stress[4], m->mu * (strain[1][2] + strain[2][1]), 1e-12);
            probe_free(&probe);
            for (size_t i = 0; i < model->unknowns; i++)
                y[i] = i / c->volume == 0 ? 1 : -2;
            model->class->accelerate(model, &(struct drive){0}, 0, y, NULL, a);
            for (size_t i = 0; i < model->unknowns; i++)
                assert_near(a[i], 0, 1e-8);
            free(y);
            free(a);
            model_free(&model);
        }
}

/* Largest frequency (times spacing over speed) of a free bar: what each kind of ends costs in time step. The
 * figure for open knots of degree 2 was found again by a dense assembly from the recursive definition. */
static void test_largest_frequency(void **state)
{
    (void)state;
    static const struct {
        int degree;
        bool mapped;
        double expected;
    } cases[] = {{2, false, 4.645}, {3, false, 6.871}, {2, true, 3.2416}, {3, true, 3.2944}};
    for (size_t i = 0; i < 4; i++) {
        struct plain_scene plain;
        plain_box(&plain, 1, (double[]){40, 0, 0}, 1);
        plain_material(&plain.material[0], 1, 0, .5);
        struct model *model = make(&plain, plain_options(cases[i].degree, cases[i].mapped));
        const size_t n = model->unknowns;
        double *y = calloc(2 * n, sizeof *y), *a = calloc(n, sizeof *a), omega = 0;
        noise(n, y);
        for (int iteration = 0; iteration < 3000; iteration++) {
            model->class->accelerate(model, &(struct drive){0}, 0, y, NULL, a);
            omega = sqrt(sqrt(dot(n, a, a) / dot(n, y, y)));
            for (size_t j = 0; j < n; j++)
                y[j] = -a[j] / (omega * omega);
        }
        assert_near(omega, cases[i].expected, .002);
        free(y);
        free(a);
        model_free(&model);
    }
}

/* Phase speed of interior plane waves from the operators' own symbols: eigenvalues of the 3 x 3 matrix K^(k)
 * over M^(k); worst relative error of P and S in three directions. */
static double worst_dispersion(struct model *model, double points, double spacing)
{
    static const double directions[3][3] = {
        {1, 0, 0}, {M_SQRT1_2, M_SQRT1_2, 0}, {.57735027, .57735027, .57735027}};
    struct consistent *c = consistent_of(model);
    const struct material *m = &model->scene->material[0];
    const size_t n = model->unknowns,
                 middle = c->n[0] / 2 + c->n[0] * (c->n[1] / 2) + c->plane * (c->n[2] / 2);
    double *u = calloc(n, sizeof *u), *out = calloc(n, sizeof *out), worst = 0;
    gsl_matrix *symbol = gsl_matrix_alloc(3, 3);
    gsl_vector *values = gsl_vector_alloc(3);
    gsl_eigen_symm_workspace *work = gsl_eigen_symm_alloc(3);
    const double wavenumber = 2 * M_PI / (points * spacing);
    for (int d = 0; d < 3; d++) {
        double mass = 0;
        for (int from = 0; from < 3; from++) {
            memset(u, 0, n * sizeof *u);
            for (size_t p = 0; p < c->volume; p++) {
                const double i = (double)(p % c->n[0]) - (double)(c->n[0] / 2);
                const double j = (double)(p / c->n[0] % c->n[1]) - (double)(c->n[1] / 2);
                const double k = (double)(p / c->plane) - (double)(c->n[2] / 2);
                u[(size_t)from * c->volume + p] =
                    cos(wavenumber * spacing *
                        (i * directions[d][0] + j * directions[d][1] + k * directions[d][2]));
            }
            apply(c, c->stiffness, u, out); /* the symbol is real and even: cosines suffice */
            for (size_t to = 0; to < 3; to++)
                gsl_matrix_set(symbol, to, (size_t)from, out[to * c->volume + middle]);
            apply(c, c->mass, u, out);
            mass = out[(size_t)from * c->volume + middle];
        }
        gsl_matrix_scale(symbol, 1 / mass);
        gsl_eigen_symm(symbol, values, work);
        gsl_sort_vector(values);
        for (size_t i = 0; i < 3; i++) {
            const double speed = i < 2 ? m->s_speed : m->p_speed;
            worst = fmax(worst, fabs(sqrt(gsl_vector_get(values, i)) / (wavenumber * speed) - 1));
        }
    }
    gsl_matrix_free(symbol);
    gsl_vector_free(values);
    gsl_eigen_symm_free(work);
    free(u);
    free(out);
    return worst;
}

/* Theory: 1-D waves of degree p with exact mass are off by c_p (k dx)^(2p); in the design's table (lambda =
 * mu) 1.2e-4, 1.0e-3, 6.6e-3 for p = 2 and 1.2e-6, 3.5e-5, 6.5e-4 for p = 3 at 10, 6, 4 points per
 * wavelength. */
static void test_dispersion(void **state)
{
    (void)state;
    static const double points[] = {10, 6, 4};
    static const double expected[2][3] = {{1.2e-4, 1.0e-3, 6.6e-3}, {1.2e-6, 3.5e-5, 6.5e-4}};
    for (int p = 2; p <= 3; p++) {
        struct plain_scene plain;
        plain_box(&plain, 3, (double[]){3, 3, 3}, .25);
        plain_material(&plain.material[0], 1, 1, 1);
        struct model *model = make(&plain, plain_options(p, false));
        for (int i = 0; i < 3; i++)
            print_message("# p = %d, %g points: %.3g\n", p, points[i],
                          worst_dispersion(model, points[i], .25));
        for (int i = 0; i < 3; i++)
            assert_near(worst_dispersion(model, points[i], .25) / expected[p - 2][i], 1, .1);
        model_free(&model);
    }
}

/* Leapfrog's own energy, v(n+1/2).M v(n+1/2)/2 + u(n).K u(n+1)/2, stays to rounding with free faces. */
static void test_energy(void **state)
{
    (void)state;
    struct plain_scene plain;
    plain_box(&plain, 3, (double[]){1.2, .9, 1.5}, .3);
    for (int face = 0; face < 2; face++) /* what holds values takes no energy */
        plain.scene.boundary[face].kind = face ? BOUNDARY_FIXED : BOUNDARY_ROLLER;
    struct model *model = make(&plain, plain_options(3, false));
    struct consistent *c = consistent_of(model);
    const size_t n = model->unknowns;
    double *y = calloc(2 * n, sizeof *y), *a = calloc(n, sizeof *a), *before = calloc(n, sizeof *before);
    double *v = y + n, first = 0;
    const double dt = .01;
    noise(n, y);
    model->class->accelerate(model, &(struct drive){0}, 0, y, NULL, v); /* admissible: 0 where held */
    memset(y, 0, n * sizeof *y);
    for (int step = 0; step < 400; step++) {
        memcpy(before, y, n * sizeof *y);
        for (size_t i = 0; i < n; i++)
            y[i] += dt * v[i];
        const double total = (tensor_form(c->mass, v, v) + tensor_form(c->stiffness, before, y)) / 2;
        if (step == 0) first = total;
        assert_near(total / first, 1, 1e-11);
        model->class->accelerate(model, &(struct drive){0}, dt / 2, y, v, a);
        for (size_t i = 0; i < n; i++)
            v[i] += dt * a[i];
    }
    free(y);
    free(a);
    free(before);
    model_free(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_stiffness_spectrum),
        cmocka_unit_test(test_patch),
        cmocka_unit_test(test_largest_frequency),
        cmocka_unit_test(test_dispersion),
        cmocka_unit_test(test_energy),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
