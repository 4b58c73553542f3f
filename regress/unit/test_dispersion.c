/* Plane waves in the interior: the frequencies that the operators and the schemes in time really have,
 * against theory from the 1-D symbols (doc/theory/consistent-splines.md, section 11). Prints the table of phase
 * errors. */
#include "consistent_run.h"
#include "few.h"

#include "stepping/schemes.h"

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_sort_vector.h>
#include <math.h>
#include <omp.h>
#include <string.h>

static const double directions[3][3] = {
    {1, 0, 0}, {M_SQRT1_2, M_SQRT1_2, 0}, {.57735026918962576, .57735026918962576, .57735026918962576}};
static const double points[3] = {10, 6, 4};
static const char *const wave_name[2] = {"S", "P"};

/* --- Theory ----------------------------------------------------------------------------------------------
 */

/* Rows of the 1-D matrices with spacing 1, offsets 0, 1, 2, 3: integrals of products of B-splines, from the
 * values and derivatives of the B-spline of degree 2p + 1 at whole numbers. */
static const struct rows {
    double mass[5], stiffness[5], gradient[5];
} rows[5] = {
    [1] = {{4 / 6., 1 / 6.}, {2, -1}, {0, 1 / 2.}},
    [2] = {{66 / 120., 26 / 120., 1 / 120.}, {1, -1 / 3., -1 / 6.}, {0, 5 / 12., 1 / 24.}},
    [3] = {{2416 / 5040., 1191 / 5040., 120 / 5040., 1 / 5040.},
           {2 / 3., -1 / 8., -1 / 5., -1 / 120.},
           {0, 49 / 144., 7 / 90., 1 / 720.}},
    [4] = {{156190 / 362880., 88234 / 362880., 14608 / 362880., 502 / 362880., 1 / 362880.},
           {2450 / 5040., -154 / 5040., -952 / 5040., -118 / 5040., -1 / 5040.},
           {0, 11326 / 40320., 4046 / 40320., 246 / 40320., 1 / 40320.}},
};

static double even(const double row[5], double angle)
{
    double sum = row[0];
    for (int j = 1; j < 5; j++)
        sum += 2 * row[j] * cos(j * angle);
    return sum;
}

static double odd(const double row[5], double angle)
{
    double sum = 0;
    for (int j = 1; j < 5; j++)
        sum += 2 * row[j] * sin(j * angle);
    return sum;
}

/* Eigenvalues, ascending, of a symmetric 3 x 3 matrix. */
static void eigenvalues(double matrix[3][3], double value[3])
{
    gsl_matrix *m = gsl_matrix_alloc(3, 3);
    gsl_vector *values = gsl_vector_alloc(3);
    gsl_eigen_symm_workspace *work = gsl_eigen_symm_alloc(3);
    for (size_t i = 0; i < 3; i++)
        for (size_t j = 0; j < 3; j++)
            gsl_matrix_set(m, i, j, (matrix[i][j] + matrix[j][i]) / 2);
    gsl_eigen_symm(m, values, work);
    gsl_sort_vector(values);
    for (size_t i = 0; i < 3; i++)
        value[i] = gsl_vector_get(values, i);
    gsl_matrix_free(m);
    gsl_vector_free(values);
    gsl_eigen_symm_free(work);
}

/* Frequencies in space alone of the waves exp(i k.x): S, S, P. */
static void theory(struct consistent_options options, const struct material *m, double spacing,
                   const double wave[3], double omega[3])
{
    double a[3], c[3], matrix[3][3], bare = 1; /* over depth, of terms without a slope there */
    for (int i = 0; i < 3; i++) {
        const double angle = wave[i] * spacing, mass = even(rows[options.degree].mass, angle);
        double inverse = 1 / mass;
        if (options.sweeps > 0) inverse = (1 - pow(1 - mass, options.sweeps + 1)) / mass;
        if (i == DEPTH && options.depth_exact) bare = inverse * mass;
        a[i] = inverse * even(rows[options.degree].stiffness, angle) / (spacing * spacing);
        c[i] = inverse * odd(rows[options.degree].gradient, angle) / spacing;
    }
    a[0] *= bare;
    a[1] *= bare;
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++) {
            const double mixed = (m->lambda + m->mu) * c[i] * c[j] * (i == DEPTH || j == DEPTH ? 1 : bare);
            const double same = (m->lambda + m->mu) * a[i] + m->mu * (a[0] + a[1] + a[2]);
            matrix[i][j] = (i == j ? same : mixed) / m->density;
        }
    eigenvalues(matrix, omega);
    for (int i = 0; i < 3; i++)
        omega[i] = sqrt(omega[i]);
}

/* What a scheme makes of a frequency omega: leapfrog sin(w dt/2) = omega dt/2; modified equation the same
 * with omega^2 (1 - omega^2 dt^2/12). */
static double in_time(const char *scheme, double omega, double dt)
{
    const double square = omega * omega * dt * dt;
    const bool plain = strcmp(scheme, "leapfrog") == 0;
    return 2 / dt * asin(sqrt(plain ? square : square * (1 - square / 12)) / 2);
}

/* --- Measured --------------------------------------------------------------------------------------------
 */

struct lattice {
    struct plain_scene plain;
    struct model *model;
    struct stepper stepper;
    struct state state;
    double *work[2];
    double ends; /* what the ends of the box still are in its middle: the inverse mass falls off like this */
};

/* One step needs no stable step: leapfrog's is near the limit of the default method, for all the same. */
static void lattice_create(struct lattice *lattice, struct consistent_options options, size_t cells,
                           const char *scheme)
{
    static const double decay[5] = {0, .268, .431, .536, .608}; /* largest root of the mass symbol */
    const double size = (double)cells;
    *lattice = (struct lattice){0};
    plain_box(&lattice->plain, 3, (double[]){size, size, size}, 1);
    plain_material(&lattice->plain.material[0], 1, 1, 1);
    lattice->plain.scene.materials = 1;
    lattice->model = make(&lattice->plain, options);
    const size_t n = lattice->model->unknowns;
    for (int i = 0; i < 2; i++)
        lattice->work[i] = calloc(2 * n, sizeof(double));
    lattice->stepper = (struct stepper){.scheme = scheme_find(scheme),
                                        .model = lattice->model,
                                        .dt = strcmp(scheme, "leapfrog") == 0 ? .19 : .33,
                                        .work = lattice->work};
    assert_int_equal(
        driver_create(&lattice->stepper.driver, &lattice->plain.scene, lattice->stepper.dt, NULL), SELAS_OK);
    lattice->state = (struct state){.y = calloc(2 * n, sizeof(double)), .a = calloc(n, sizeof(double))};
    assert_non_null(lattice->work[0]);
    assert_non_null(lattice->work[1]);
    assert_non_null(lattice->state.y);
    assert_non_null(lattice->state.a);
    lattice->ends = 1e-11 + (options.sweeps > 0 ? 0 : 50 * pow(decay[options.degree], size / 2));
}

static void lattice_free(struct lattice *lattice)
{
    free(lattice->state.y);
    free(lattice->state.a);
    free(lattice->work[0]);
    free(lattice->work[1]);
    driver_free(&lattice->stepper.driver);
    model_free(&lattice->model);
}

/* Frequencies that one step shows: from cos(k.x) e_j at rest the middle of the box goes to T e_j; the
 * eigenvalues of T are cos(w dt). All of this with the model's own operator and the scheme's own step. */
static void measure(struct lattice *lattice, const double wave[3], double omega[3])
{
    struct consistent *c = consistent_of(lattice->model);
    const size_t n = lattice->model->unknowns, at[3] = {c->n[0] / 2, c->n[1] / 2, c->n[2] / 2};
    const size_t middle = at[0] + c->n[0] * at[1] + c->plane * at[2];
    struct state *state = &lattice->state;
    double t[3][3], value[3];
    for (size_t from = 0; from < 3; from++) {
        memset(state->y, 0, 2 * n * sizeof(double));
        state->step = 0;
        for (size_t p = 0; p < c->volume; p++) {
            const double x = (double)(p % c->n[0]) - (double)at[0];
            const double y = (double)(p / c->n[0] % c->n[1]) - (double)at[1];
            const double z = (double)(p / c->plane) - (double)at[2];
            state->y[from * c->volume + p] = cos(wave[0] * x + wave[1] * y + wave[2] * z);
        }
        lattice->stepper.scheme->start(&lattice->stepper, state);
        lattice->stepper.scheme->step(&lattice->stepper, state);
        state_settle(&lattice->stepper, state, false);
        for (size_t to = 0; to < 3; to++)
            t[to][from] = state->y[to * c->volume + middle];
    }
    eigenvalues(t, value); /* ascending cosines: P, S, S */
    for (int i = 0; i < 3; i++)
        omega[i] = acos(value[2 - i]) / lattice->stepper.dt;
}

/* --- Both ------------------------------------------------------------------------------------------------
 */

struct phase {
    double wanted, found, unwarped; /* relative errors of the phase speed */
};

/* The worse of the S waves or the P wave. */
static struct phase phase_of(struct lattice *lattice, struct consistent_options options, const char *scheme,
                             const double direction[3], int kind, double per_wavelength)
{
    const struct material *m = &lattice->plain.material[0];
    const double dt = lattice->stepper.dt, wavenumber = 2 * M_PI / per_wavelength;
    const double exact = wavenumber * (kind == 0 ? m->s_speed : m->p_speed);
    double wave[3], expected[3], found[3];
    struct phase phase = {0};
    for (int i = 0; i < 3; i++)
        wave[i] = wavenumber * direction[i];
    theory(options, m, 1, wave, expected);
    measure(lattice, wave, found);
    for (int i = kind == 0 ? 0 : 2; i < (kind == 0 ? 2 : 3); i++) {
        const double space = expected[i] / exact - 1, wanted = in_time(scheme, expected[i], dt) / exact - 1;
        const double error = found[i] / exact - 1, unwarped = 2 / dt * sin(found[i] * dt / 2) / exact - 1;
        if (lattice->ends > .1 * fabs(wanted)) continue; /* test_consistent looks closer */
        assert_true(fabs(error - wanted) <= .01 * fabs(wanted) + lattice->ends);
        if (strcmp(scheme, "leapfrog") == 0) /* the transform leaves the error in space */
            assert_true(fabs(unwarped - space) <= .01 * fabs(space) + lattice->ends);
        if (fabs(wanted) >= fabs(phase.wanted)) phase = (struct phase){wanted, error, unwarped};
    }
    return phase;
}

static void compare(struct consistent_options options, size_t cells, const char *title, const char *scheme)
{
    static const char *const where[3] = {"100", "110", "111"};
    struct lattice lattice;
    lattice_create(&lattice, options, cells, scheme);
    const bool leaps = strcmp(scheme, "leapfrog") == 0;
    const int first = few_of(0, 2); /* across, the shortest waves */
    for (int d = first; d < 3; d++)
        for (int kind = few_of(0, 1); kind < 2; kind++) {
            struct phase phase[3] = {{0}};
            for (int i = first; i < 3; i++)
                phase[i] = phase_of(&lattice, options, scheme, directions[d], kind, points[i]);
            print_message("# | %s | %s | %s %s | %.2e / %.2e | %.2e / %.2e | %.2e / %.2e |\n", title, scheme,
                          wave_name[kind], where[d], phase[0].wanted, phase[0].found, phase[1].wanted,
                          phase[1].found, phase[2].wanted, phase[2].found);
            if (leaps)
                print_message("# | %s | the same, transformed | %s %s | %.2e | %.2e | %.2e |\n", title,
                              wave_name[kind], where[d], phase[0].unwarped, phase[1].unwarped,
                              phase[2].unwarped);
        }
    lattice_free(&lattice);
}

static void test_exact_mass(void **state)
{
    (void)state;
    compare((struct consistent_options){.degree = 1}, 31, "1, exact", "leapfrog");
    compare((struct consistent_options){.degree = 2}, 41, "2, exact", "leapfrog");
    compare((struct consistent_options){.degree = 2}, 41, "2, exact", "modified-equation");
    compare((struct consistent_options){.degree = 3}, 57, "3, exact", "leapfrog");
}

static void test_van_cittert(void **state)
{
    (void)state;
    compare((struct consistent_options){.degree = 2, .sweeps = 1}, 21, "2, vc1", "leapfrog");
    compare((struct consistent_options){.degree = 2, .sweeps = 2}, 21, "2, vc2", "leapfrog");
    compare((struct consistent_options){.degree = 2, .sweeps = 3}, 25, "2, vc3", "leapfrog");
    compare((struct consistent_options){.degree = 2, .sweeps = 3}, 35, "2, vc3", "modified-equation");
    compare((struct consistent_options){.degree = 2, .sweeps = 3, .depth_exact = true}, 27,
            "2, vc3, exact over depth", "leapfrog");
    compare((struct consistent_options){.degree = 1, .sweeps = 3}, 15, "1, vc3", "leapfrog");
    compare((struct consistent_options){.degree = 3, .sweeps = 3}, 37, "3, vc3", "leapfrog");
    compare((struct consistent_options){.degree = 4, .sweeps = 3}, 49, "4, vc3", "leapfrog");
}

/* Theory of theory: on the axis the error of the exact mass falls with the power 2p of the angle k dx per
 * point, theta^2 / 24, theta^4 / 1440, theta^6 / 60480 in frequency, and m sweeps take (1 - M)^(m+1) / 2 off,
 * M = 1 - (p + 1) theta^2 / 12. */
static void test_leading_terms(void **state)
{
    (void)state;
    static const double series[4] = {0, 1 / 24., 1 / 1440., 1 / 60480.};
    struct material rock;
    plain_material(&rock, 1, 1, 1);
    const double angle = .12;
    for (int p = 1; p <= 3; p++)
        for (int sweeps = 0; sweeps <= 3; sweeps++) {
            double omega[3];
            theory((struct consistent_options){.degree = p, .sweeps = sweeps}, &rock, 1,
                   (double[]){angle, 0, 0}, omega);
            double expected = series[p] * pow(angle, 2 * p);
            if (sweeps > 0) expected -= pow((p + 1) * angle * angle / 12, sweeps + 1) / 2;
            assert_near((omega[2] / (rock.p_speed * angle) - 1) / expected, 1, .03);
        }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_leading_terms),
        cmocka_unit_test(test_exact_mass),
        cmocka_unit_test(test_van_cittert),
    };
    (void)plain_face_load;
    return cmocka_run_group_tests(tests, NULL, NULL);
}
