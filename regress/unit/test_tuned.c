/* Tuned splines (doc/theory/consistent-splines.md, section 14): symbols against theory, signs of the matrices with
 * all kinds of ends, fields that must stay as they are, symmetry planes, energy. */
#include "consistent_run.h"
#include "few.h"

#include <gsl/gsl_linalg.h>
#include <math.h>
#include <string.h>

static struct spline *tuned_axis(size_t cells, bool mirror_low, bool mirror_high, bool tuned)
{
    struct messages messages = {0};
    const struct spline_choice choice = {.degree = TUNED_DEGREE,
                                         .high = .25 * (double)cells,
                                         .spacing = .25,
                                         .mirror = {mirror_low, mirror_high}};
    struct spline *spline = spline_new(&choice, &messages);
    assert_non_null(spline);
    if (tuned) assert_true(spline_tune(spline));
    return spline;
}

/* Symbols of the middle rows, in units of the spacing; G over i. */
static void symbols(const struct spline *spline, double theta, double symbol[3])
{
    const double dx = spline->element[0].x_to - spline->element[0].x_from;
    const size_t middle = spline->count / 2;
    for (int kind = 0; kind < 3; kind++) { /* M, S, G */
        struct band *band = tuned_matrix(spline, false, kind == 1, false, kind > 0, NULL);
        symbol[kind] = 0;
        for (size_t j = 0; j < spline->count; j++) {
            const double angle = ((double)j - (double)middle) * theta;
            symbol[kind] += band_get(band, middle, j) * (kind == 2 ? sin(angle) : cos(angle));
        }
        symbol[kind] *= kind == 0 ? 1 / dx : kind == 1 ? dx : 1;
        band_free(band);
    }
}

/* Errors of frequencies and slopes against theta itself, and S M >= G^2 (U3, U4 of regress/studies/tuned-splines). */
static void test_symbols(void **state)
{
    (void)state;
    static const double angles[] = {1, M_PI / 2, 2.1, 2.5, 2.7};
    static const double most[] = {2e-5, 6e-5, 4e-4, 1e-3, 3e-3};
    struct spline *tuned = tuned_axis(60, false, false, true), *plain = tuned_axis(60, false, false, false);
    for (int i = 0; i < 5; i++) {
        double t[3], p[3];
        symbols(tuned, angles[i], t);
        symbols(plain, angles[i], p);
        const double frequency = sqrt(t[1] / t[0]) / angles[i] - 1, slope = t[2] / t[0] / angles[i] - 1;
        const double before = sqrt(p[1] / p[0]) / angles[i] - 1;
        print_message("# %.3g: frequency %.2e (plain %.2e), slope %.2e (plain %.2e)\n", angles[i], frequency,
                      before, slope, p[2] / p[0] / angles[i] - 1);
        assert_true(fabs(frequency) < most[i] && fabs(slope) < most[i]);
        if (i > 1) assert_true(fabs(frequency) < before / 6);
    }
    for (int i = 1; i <= 1000; i++) {
        double t[3], p[3];
        symbols(tuned, M_PI * i / 1000, t);
        symbols(plain, M_PI * i / 1000, p);
        assert_true(t[1] * t[0] - t[2] * t[2] > -1e-10 * t[1] * t[0]);
        assert_true(t[0] > .19 * p[0] && t[0] < p[0] * (1 + 1e-12) && t[1] < 10.3 * t[0]);
    }
    spline_free(tuned);
    spline_free(plain);
}

static gsl_matrix *dense(const struct band *band)
{
    gsl_matrix *matrix = gsl_matrix_alloc(band->n, band->n);
    for (size_t i = 0; i < band->n; i++)
        for (size_t j = 0; j < band->n; j++)
            gsl_matrix_set(matrix, i, j, band_get(band, i, j));
    return matrix;
}

/* Smallest eigenvalue of S - G^T M^-1 G in the norm of M, for a component that is odd or even at symmetry
 * planes (its slope is the other way round). */
static double least_eigenvalue(const struct spline *spline, bool odd)
{
    const size_t n = spline->count;
    struct band *bands[4] = {
        tuned_matrix(spline, odd, 1, odd, 1, NULL), tuned_matrix(spline, !odd, 0, odd, 1, NULL),
        tuned_matrix(spline, !odd, 0, !odd, 0, NULL), tuned_matrix(spline, odd, 0, odd, 0, NULL)};
    gsl_matrix *z = dense(bands[0]), *g = dense(bands[1]), *l = dense(bands[2]), *m = dense(bands[3]);
    assert_int_equal(gsl_linalg_cholesky_decomp1(l), GSL_SUCCESS); /* M is positive definite */
    gsl_blas_dtrsm(CblasLeft, CblasLower, CblasNoTrans, CblasNonUnit, 1, l, g);
    gsl_blas_dsyrk(CblasLower, CblasTrans, -1, g, 1, z);
    for (size_t i = 0; i < n; i++)
        for (size_t j = i + 1; j < n; j++)
            gsl_matrix_set(z, i, j, gsl_matrix_get(z, j, i));
    gsl_vector *values = gsl_vector_alloc(n);
    gsl_eigen_gensymm_workspace *work = gsl_eigen_gensymm_alloc(n);
    gsl_eigen_gensymm(z, m, values, work);
    const double least = gsl_vector_min(values);
    gsl_eigen_gensymm_free(work);
    gsl_vector_free(values);
    gsl_matrix_free(z);
    gsl_matrix_free(g);
    gsl_matrix_free(l);
    gsl_matrix_free(m);
    for (int i = 0; i < 4; i++)
        band_free(bands[i]);
    return least;
}

/* M > 0 and S >= G^T M^-1 G: no motion has negative energy (Eq U7). */
static void test_signs(void **state)
{
    (void)state;
    gsl_set_error_handler_off();
    for (size_t cells = 9; cells <= 57; cells += cells < 30 ? 1 : 9)
        for (int ends = 0; ends < 3; ends++)
            for (int odd = 0; odd < (ends == 0 ? 1 : 2); odd++) {
                struct spline *spline = tuned_axis(cells, ends > 0, ends > 1, true);
                const double least = least_eigenvalue(spline, odd);
                if (least < -2e-9) /* of a largest one of 1500 */
                    fail_msg("%zu cells, ends %d, odd %d: %g", cells, ends, odd, least);
                spline_free(spline);
            }
}

/* Functions and moments still add up to 1, x and x^2; the filter is at work. */
static void test_filter(void **state)
{
    (void)state;
    struct spline *spline = tuned_axis(40, true, false, true);
    for (double x = 0; x <= 10; x += .13) {
        struct tuned_point at;
        tuned_at(spline, false, x, &at);
        double sum = 0, slopes = 0, square = 0;
        for (size_t i = 0; i < at.count; i++) {
            const double here = spline->greville[at.index[i]];
            sum += at.value[i];
            square += at.value[i] * here * here;
            slopes += at.slope[i] * here * here;
        }
        assert_near(sum, 1, 1e-13);
        if (x < 9) { /* x^2 has the control values x^2 - c, c the same everywhere inside */
            assert_near(square - x * x, 5 / 12. * .25 * .25, 1e-12);
            assert_near(slopes, 2 * x, 1e-11);
        }
    }
    double moment[64], work[64], plain[64], total = 0, difference = 0;
    tuned_moments(spline, false, .3, 2.17, work, moment);
    spline_moments(spline, false, .3, 2.17, plain);
    for (size_t i = 0; i < spline->count; i++) {
        total += moment[i];
        difference = fmax(difference, fabs(moment[i] - plain[i]));
    }
    assert_near(total, 1.87, 1e-13);
    assert_true(difference > .001 * .25);
    spline_free(spline);
}

static struct consistent_options tuned_options(void)
{
    return (struct consistent_options){.degree = TUNED_DEGREE, .tuned = true};
}

/* A linear displacement under the tractions of its stress is in balance; noise is accelerated differently
 * than without tuning. */
static void test_patch(void **state)
{
    (void)state;
    static const double strain[3][3] = {{.3, .1, -.2}, {.4, -.5, .25}, {-.1, .7, .2}}; /* du_i/dx_j */
    struct plain_scene plain;
    plain_box(&plain, 3, (double[]){5.4, 4.8, .9}, .15);
    const struct material *m = &plain.material[0];
    const double trace = strain[0][0] + strain[1][1] + strain[2][2];
    for (int face = 0; face < 6; face++) {
        double traction[3];
        for (int i = 0; i < 3; i++)
            traction[i] = face_sign((enum face)face) * (m->mu * (strain[i][face / 2] + strain[face / 2][i]) +
                                                        (i == face / 2 ? m->lambda * trace : 0));
        plain_face_load(&plain, (enum face)face, traction);
    }
    struct run run = run_new(&plain, tuned_options()),
               other = run_new(&plain, plain_options(TUNED_DEGREE, false));
    struct consistent *c = consistent_of(run.model);
    for (size_t p = 0; p < c->volume; p++) {
        const size_t at[3] = {p % c->n[0], p / c->n[0] % c->n[1], p / c->plane};
        for (int i = 0; i < 3; i++)
            for (int j = 0; j < 3; j++)
                run.y[(size_t)i * c->volume + p] += strain[i][j] * c->spline[j]->greville[at[c->slot[j]]];
    }
    const double ones[PLAIN_LOADS] = {1, 1, 1, 1, 1, 1};
    run.model->spatial->accelerate(run.model, &(struct drive){.load = ones}, 0, run.y, NULL, run.a);
    for (size_t i = 0; i < run.n; i++)
        assert_near(run.a[i], 0, 1e-8);
    noise(run.n, run.y);
    run.model->spatial->accelerate(run.model, &(struct drive){0}, 0, run.y, NULL, run.a);
    other.model->spatial->accelerate(other.model, &(struct drive){0}, 0, run.y, NULL, other.a);
    double difference = 0;
    for (size_t i = 0; i < run.n; i++)
        difference += (run.a[i] - other.a[i]) * (run.a[i] - other.a[i]);
    print_message("# patch: tuning changes what noise does by %.2g\n",
                  sqrt(difference / dot(run.n, run.a, run.a)));
    assert_true(difference > 1e-6 * dot(run.n, run.a, run.a));
    run_free(&run);
    run_free(&other);
}

/* Layered ground, faces free and transmitting: leapfrog's energy stays to rounding, or falls. */
static void test_energy(void **state)
{
    (void)state;
    for (int damped = 0; damped < 2; damped++) {
        struct plain_scene plain;
        plain_box(&plain, 3, (double[]){7.5, 6.9, 1.5}, .3);
        plain.scene.body.layers = 2;
        plain.layer[0] = (struct layer){.material = 1};
        plain.layer[1] = (struct layer){.top = .7};
        plain.scene.boundary[FACE_X_LOW].kind = BOUNDARY_SYMMETRY;
        if (damped)
            plain.scene.boundary[FACE_X_HIGH].kind = plain.scene.boundary[FACE_Y_HIGH].kind =
                BOUNDARY_TRANSMITTING;
        struct run run = run_new(&plain, tuned_options());
        struct consistent *c = consistent_of(run.model);
        double *v = run.y + run.n, *before = calloc(run.n, sizeof *before), first = 0, last = 0;
        const double dt = .008;
        const int steps = few_of(300, 100);
        noise(run.n, run.y);
        run.model->spatial->accelerate(run.model, &(struct drive){0}, 0, run.y, NULL, v);
        memset(run.y, 0, run.n * sizeof *run.y);
        for (int step = 0; step < steps; step++) {
            memcpy(before, run.y, run.n * sizeof *before);
            for (size_t i = 0; i < run.n; i++)
                run.y[i] += dt * v[i];
            last = (tensor_form(c->mass, v, v) + tensor_form(c->stiffness, before, run.y)) / 2;
            if (step == 0) first = last;
            if (!damped) assert_near(last / first, 1, 1e-11);
            run.model->spatial->accelerate(run.model, &(struct drive){0}, dt / 2, run.y, v, run.a);
            for (size_t i = 0; i < run.n; i++)
                v[i] += dt * run.a[i];
        }
        if (damped) assert_true(last < .99 * first && last > 0);
        free(before);
        run_free(&run);
    }
}

/* A quarter with symmetry planes does what the whole box does, to rounding: loads, operators, read-out. */
static void test_symmetry_planes(void **state)
{
    (void)state;
    struct plain_scene whole, quarter;
    plain_box(&whole, 3, (double[]){9.6, 9, 1.2}, .3);
    plain_box(&quarter, 3, (double[]){9.6, 9, 1.2}, .3);
    quarter.scene.body.low[0] = 4.8;
    quarter.scene.body.low[1] = 4.5;
    quarter.scene.boundary[FACE_X_LOW].kind = quarter.scene.boundary[FACE_Y_LOW].kind = BOUNDARY_SYMMETRY;
    struct run run[2];
    for (int i = 0; i < 2; i++) {
        struct plain_scene *plain = i == 0 ? &whole : &quarter;
        struct load *load = plain_face_load(plain, FACE_Z_LOW, (double[]){0, 0, 1});
        load->shape = LOAD_SQUARE;
        load->centre[0] = 4.8;
        load->centre[1] = 4.5;
        load->size[0] = 1.3;
        load->size[1] = .9;
        run[i] = run_new(plain, tuned_options());
        for (int step = 0; step < 40; step++) {
            const double amplitude = sin(.2 * step);
            leap(&run[i], &(struct drive){.load = &amplitude}, .015);
        }
    }
    static const double places[3][3] = {{4.8, 4.5, 0}, {5.7, 4.6, .4}, {6.4, 6.7, 1.2}};
    for (int place = 0; place < 3; place++) {
        double value[2][3];
        for (int i = 0; i < 2; i++)
            velocity_at(&run[i], places[place], value[i]);
        if (place < 2) assert_true(fabs(value[0][2]) > .05);
        for (int component = 0; component < 3; component++)
            assert_near(value[1][component], value[0][component], 1e-12);
    }
    run_free(&run[0]);
    run_free(&run[1]);
}

/* What the numbers are not made for is refused. */
static void test_refusals(void **state)
{
    (void)state;
    struct plain_scene plain;
    plain_box(&plain, 2, (double[]){4.5, .9, 0}, .15);
    const struct consistent_options wrong[3] = {{.degree = 3, .tuned = true},
                                                {.degree = 4, .tuned = true, .sweeps = 3},
                                                {.degree = 4, .tuned = true, .mapped = true}};
    for (int i = 0; i < 3; i++) {
        struct messages messages = {0};
        struct model *model = NULL;
        assert_int_equal(consistent_create_with(&plain.scene, &wrong[i], &model, &messages),
                         SELAS_UNSUPPORTED);
        assert_non_null(strstr(messages.text, "method%tuned"));
        messages_free(&messages);
    }
}

/* What is seen of straight pieces: slopes of quadratics are exact at any place, up to ends, on symmetry planes and on
 * either side of a jump. */
static void test_seen(void **state)
{
    (void)state;
    const double jump = 1.25;
    for (int kind = 0; kind < 3; kind++) { /* open ends, a symmetry plane, a jump */
        struct messages messages = {0};
        const struct spline_choice choice = {.degree = 1,
                                             .high = 3,
                                             .spacing = .25,
                                             .mirror = {kind == 1, false},
                                             .interfaces = kind == 2 ? 1 : 0,
                                             .interface = &jump};
        struct spline *spline = spline_new(&choice, &messages);
        assert_non_null(spline);
        for (double x = 0; x <= 3; x += .0625) {
            const bool below = kind == 2 && x >= jump;
            struct tuned_point at;
            double value = 0, slope = 0;
            tuned_seen(spline, false, x, &at);
            for (size_t i = 0; i < at.count; i++) {
                const double here = spline->greville[at.index[i]];
                value += at.value[i] * here;
                slope += at.slope[i] * (here * here + (kind == 2 && here > jump ? 3 * (here - jump) : 0));
            }
            assert_near(value, x, 1e-13);
            assert_near(slope, 2 * x + (below ? 3 : 0), 1e-12);
        }
        spline_free(spline);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_symbols),  cmocka_unit_test(test_signs),
        cmocka_unit_test(test_filter),   cmocka_unit_test(test_patch),
        cmocka_unit_test(test_energy),   cmocka_unit_test(test_symmetry_planes),
        cmocka_unit_test(test_refusals), cmocka_unit_test(test_seen),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
