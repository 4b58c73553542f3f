/* The operator of total-Lagrangian SPH: patch tests, adjoint forces, spectrum, mirrors, loads, motions. */
#include "base/memory.h"
#include "box_scene.h"
#include "method/total_lagrangian/total_lagrangian.h"
#include "points/lattice.h"
#include "points/least_squares.h"

#include <gsl/gsl_eigen.h>
#include <stdlib.h>
#include <string.h>

static struct tl_options options(int degree, enum elastic_law law, double hourglass)
{
    struct tl_options made = tl_default_options();
    made.degree = degree;
    made.law = law;
    made.hourglass = hourglass;
    return made;
}

static struct model *make(const struct scene *scene, const struct tl_options *choice)
{
    struct messages messages = {0};
    struct model *model = NULL;
    if (total_lagrangian_create(scene, choice, &model, &messages) != SELAS_OK) fail_msg("%s", messages.text);
    messages_free(&messages);
    return model;
}

static double scatter(size_t k)
{
    return 2 * random_uniform(11, k) - 1;
}

/* u = x + polynomial of the degree with made-up coefficients; its gradient at x. */
static void polynomial(int d, int degree, const double *x, double *u, double *gradient)
{
    memset(gradient, 0, 9 * sizeof *gradient);
    for (int a = 0; a < d; a++) {
        u[a] = scatter((size_t)a);
        for (int b = 0; b < d; b++) {
            const double slope = scatter((size_t)(10 + 3 * a + b));
            u[a] += slope * x[b];
            gradient[a * d + b] += slope;
            for (int c = 0; c < d && degree == 2; c++) {
                const double bend = scatter((size_t)(30 + 9 * a + 3 * b + c));
                u[a] += bend * x[b] * x[c];
                gradient[a * d + b] += bend * x[c];
                gradient[a * d + c] += bend * x[b];
            }
        }
    }
}

/* Gradients of the degree's polynomials are exact at every point, jittered too, and hourglass control does
 * not see them. */
static void patch_tests(void **state)
{
    (void)state;
    for (int d = 1; d <= 3; d++)
        for (int degree = 1; degree <= 2; degree++) {
            struct box_scene box;
            make_box(&box, d, 1, .12);
            box.scene.body.jitter = .15;
            const struct tl_options choice = options(degree, LAW_LINEAR, .1);
            struct model *model = make(&box.scene, &choice);
            struct tl_model *tl = (struct tl_model *)model;
            double *u = array_new(model->state_size, sizeof *u);
            double gradient[9];
            for (size_t i = 0; i < model->points; i++)
                polynomial(d, degree, model->position + 3 * i, u + (size_t)d * i, gradient);
            tl_sites(tl, u, NULL, NULL, NULL);
            tl_gradients(tl);
            double strain = 0;
            for (size_t i = 0; i < model->points; i++) {
                double value[3];
                polynomial(d, degree, model->position + 3 * i, value, gradient);
                double H[9];
                tl_tensor(tl, i, H);
                for (int k = 0; k < d * d; k++)
                    assert_near(H[k], gradient[k], 1e-11);
                strain += tl->cloud->volume[i] * elastic_energy(&tl->elastic[i], gradient);
            }
            assert_near(tl_strain_energy(tl), strain, 1e-11 * strain);
            array_free(u);
            model_free(&model);
        }
}

/* Probes reproduce the polynomials inside and on the faces. */
static void probes_extrapolate(void **state)
{
    (void)state;
    static const double place[4][3] = {{.5, .43, 0}, {0, .3, 0}, {1, 1, 0}, {.71, 0, 0}};
    struct box_scene box;
    make_box(&box, 2, 1, .1);
    const struct tl_options choice = options(2, LAW_LINEAR, 0);
    struct model *model = make(&box.scene, &choice);
    double *y = array_new(model->state_size, sizeof *y);
    double gradient[9];
    for (size_t i = 0; i < model->points; i++)
        polynomial(2, 2, model->position + 3 * i, y + 2 * i, gradient);
    for (int k = 0; k < 4; k++) {
        struct messages messages = {0};
        struct probe probe = {0};
        double value[6];
        double u[3];
        assert_int_equal(model->core->probe(model, place[k], &probe, &messages), SELAS_OK);
        polynomial(2, 2, place[k], u, gradient);
        model->core->observe(model, &probe, SELAS_DISPLACEMENT, y, NULL, value);
        assert_near(value[0], u[0], 1e-12);
        model->core->observe(model, &probe, SELAS_STRAIN, y, NULL, value);
        assert_near(value[0], gradient[0], 1e-11);
        assert_near(value[3], .5 * (gradient[1] + gradient[2]), 1e-11);
        probe_free(&probe);
    }
    array_free(y);
    model_free(&model);
}

/* Two rows of points that are not quite straight tell no curvature across them: no quadratic is fitted. */
static void nearly_dependent_fits_are_refused(void **state)
{
    (void)state;
    double offset[3 * 10] = {0};
    double weight[10];
    double value[10];
    double work[FIT_TERMS * 10];
    for (int k = 0; k < 10; k++) {
        offset[3 * k] = k / 2 - 2;
        offset[3 * k + 1] = (k % 2 + .5) * (1 + 1e-3 * offset[3 * k] * offset[3 * k]);
        weight[k] = 1;
    }
    struct fit fit = {2, 2, 2, 10, offset, weight, work};
    assert_false(fit_free(&fit, value, NULL));
    fit.degree = 1;
    assert_true(fit_free(&fit, value, NULL));
    for (int k = 0; k < 10; k++)
        assert_true(fabs(value[k]) < 1);
}

static double energy_at(struct model *model, const double *y)
{
    struct energy energy;
    model->core->energy(model, y, &energy);
    return energy.strain;
}

/* m a = -dE/du for every law, with hourglass control, mirrors and a clamp, at finite strain. */
static void forces_are_the_energys_derivative(void **state)
{
    (void)state;
    for (int law = 0; law < 3; law++)
        for (int degree = 1; degree <= 2; degree++) {
            struct box_scene box;
            make_box(&box, 2, 1, .17);
            box.scene.body.jitter = .1;
            box.scene.boundary[FACE_X_LOW].kind = BOUNDARY_FIXED;
            box.scene.boundary[FACE_Y_LOW].kind = BOUNDARY_SYMMETRY;
            const struct tl_options choice = options(degree, (enum elastic_law)law, .1);
            struct model *model = make(&box.scene, &choice);
            const struct tl_model *tl = (struct tl_model *)model;
            double *y = array_new(model->state_size, sizeof *y);
            double *a = array_new(model->unknowns, sizeof *a);
            for (size_t k = 0; k < model->unknowns; k++)
                y[k] = .01 * scatter(k);
            const struct drive quiet = {0};
            model->spatial->accelerate(model, &quiet, 0, y, NULL, a);
            for (size_t k = 0; k < model->unknowns; k += 5) {
                const double here = y[k];
                const double step = 1e-5;
                y[k] = here + step;
                const double more = energy_at(model, y);
                y[k] = here - step;
                const double less = energy_at(model, y);
                y[k] = here;
                assert_near(tl->mass[k / 2] * a[k], -(more - less) / (2 * step), 2e-8);
            }
            array_free(y);
            array_free(a);
            model_free(&model);
        }
}

/* Eigenvalues of -M^-1 K as a general matrix: real and not above 0; a free body has the rigid motions as its
 * only zeros once hourglass control is on. */
static void spectrum_is_imaginary(void **state)
{
    (void)state;
    for (int degree = 1; degree <= 2; degree++)
        for (int clamped = 0; clamped < 2; clamped++) {
            struct box_scene box;
            make_box(&box, 2, 1, .143);
            box.scene.body.jitter = .1;
            if (clamped) box.scene.boundary[FACE_X_LOW].kind = BOUNDARY_FIXED;
            const struct tl_options choice = options(degree, LAW_LINEAR, .1);
            struct model *model = make(&box.scene, &choice);
            const size_t n = model->unknowns;
            gsl_matrix *matrix = gsl_matrix_alloc(n, n);
            gsl_vector_complex *values = gsl_vector_complex_alloc(n);
            gsl_eigen_nonsymm_workspace *work = gsl_eigen_nonsymm_alloc(n);
            double *y = array_new(n, sizeof *y);
            double *a = array_new(n, sizeof *a);
            const struct drive quiet = {0};
            for (size_t k = 0; k < n; k++) {
                y[k] = 1;
                model->spatial->accelerate(model, &quiet, 0, y, NULL, a);
                y[k] = 0;
                for (size_t l = 0; l < n; l++)
                    gsl_matrix_set(matrix, l, k, a[l]);
            }
            assert_int_equal(gsl_eigen_nonsymm(matrix, values, work), 0);
            double largest = 0;
            for (size_t k = 0; k < n; k++) {
                const gsl_complex value = gsl_vector_complex_get(values, k);
                largest = fmax(largest, -GSL_REAL(value));
            }
            int zeros = 0;
            for (size_t k = 0; k < n; k++) {
                const gsl_complex value = gsl_vector_complex_get(values, k);
                assert_true(GSL_REAL(value) < 1e-9 * largest);
                assert_true(fabs(GSL_IMAG(value)) < 1e-9 * largest);
                zeros += GSL_REAL(value) > -1e-7 * largest;
            }
            assert_int_equal(zeros, clamped ? 0 : 3);
            gsl_matrix_free(matrix);
            gsl_vector_complex_free(values);
            gsl_eigen_nonsymm_free(work);
            array_free(y);
            array_free(a);
            model_free(&model);
        }
}

/* A rigid turn by any angle makes no force. */
static void turns_make_no_force(void **state)
{
    (void)state;
    for (int law = 1; law < 3; law++) {
        struct box_scene box;
        make_box(&box, 2, 1, .12);
        box.scene.body.jitter = .1;
        const struct tl_options choice = options(2, (enum elastic_law)law, .1);
        struct model *model = make(&box.scene, &choice);
        double *y = array_new(model->state_size, sizeof *y);
        double *a = array_new(model->unknowns, sizeof *a);
        for (size_t i = 0; i < model->points; i++) {
            const double *x = model->position + 3 * i;
            y[2 * i] = cos(2.5) * x[0] - sin(2.5) * x[1] - x[0] + 3;
            y[2 * i + 1] = sin(2.5) * x[0] + cos(2.5) * x[1] - x[1] - 1;
        }
        const struct drive quiet = {0};
        model->spatial->accelerate(model, &quiet, 0, y, NULL, a);
        for (size_t k = 0; k < model->unknowns; k++)
            assert_near(a[k], 0, 1e-9);
        array_free(y);
        array_free(a);
        model_free(&model);
    }
}

/* A quarter with two symmetry planes accelerates as the whole body does. */
static void quarters_are_wholes(void **state)
{
    (void)state;
    struct box_scene whole;
    struct box_scene quarter;
    make_box(&whole, 2, 2, .2);
    make_box(&quarter, 2, 1, .2);
    quarter.scene.boundary[FACE_X_HIGH].kind = BOUNDARY_SYMMETRY;
    quarter.scene.boundary[FACE_Y_HIGH].kind = BOUNDARY_SYMMETRY;
    const struct tl_options choice = options(2, LAW_SAINT_VENANT_KIRCHHOFF, .1);
    struct model *all = make(&whole.scene, &choice);
    struct model *part = make(&quarter.scene, &choice);
    double *ya = array_new(all->state_size, sizeof *ya);
    double *yp = array_new(part->state_size, sizeof *yp);
    double *aa = array_new(all->unknowns, sizeof *aa);
    double *ap = array_new(part->unknowns, sizeof *ap);
    for (size_t j = 0; j < 10; j++)
        for (size_t i = 0; i < 10; i++) {
            const size_t source = (j < 5 ? j : 9 - j) * 5 + (i < 5 ? i : 9 - i);
            ya[2 * (10 * j + i)] = .02 * scatter(2 * source) * (i < 5 ? 1 : -1);
            ya[2 * (10 * j + i) + 1] = .02 * scatter(2 * source + 1) * (j < 5 ? 1 : -1);
            yp[2 * source] = .02 * scatter(2 * source);
            yp[2 * source + 1] = .02 * scatter(2 * source + 1);
        }
    const struct drive quiet = {0};
    all->spatial->accelerate(all, &quiet, 0, ya, NULL, aa);
    part->spatial->accelerate(part, &quiet, 0, yp, NULL, ap);
    for (size_t j = 0; j < 5; j++)
        for (size_t i = 0; i < 5; i++)
            for (size_t c = 0; c < 2; c++)
                assert_near(ap[2 * (5 * j + i) + c], aa[2 * (10 * j + i) + c], 1e-11);
    assert_near(energy_at(all, ya), 4 * energy_at(part, yp), 1e-13);
    array_free(ya);
    array_free(yp);
    array_free(aa);
    array_free(ap);
    model_free(&all);
    model_free(&part);
}

/* Uniform tension t along x between two loaded faces: at the strain of Hooke's law nothing moves, to the last
 * layer. */
static void tractions_balance_uniform_stress(void **state)
{
    (void)state;
    for (int d = 1; d <= 3; d++)
        for (int degree = 1; degree <= 2; degree++) {
            struct box_scene box;
            make_box(&box, d, 1, d == 3 ? 1. / 16 : .05);
            struct load load[2];
            pull_box(&box, load);
            const struct tl_options choice = options(degree, LAW_LINEAR, .1);
            struct model *model = make(&box.scene, &choice);
            const struct tl_model *tl = (struct tl_model *)model;
            double force = 0;
            for (size_t k = 0; k < tl->load[1].count; k++)
                force += tl->load[1].force[(size_t)d * k];
            assert_near(force, .3, 1e-14);
            double *y = array_new(model->state_size, sizeof *y);
            double *a = array_new(model->unknowns, sizeof *a);
            stretch_box(&box, model->position, model->points, y);
            const double amplitude[2] = {1, 1};
            const struct drive drive = {.load = amplitude};
            model->spatial->accelerate(model, &drive, 0, y, NULL, a);
            for (size_t k = 0; k < model->unknowns; k++)
                assert_near(a[k], 0, 1e-12);
            array_free(y);
            array_free(a);
            model_free(&model);
        }
}

/* Across a body of few points, too, a traction has its force and its moment about the middle. */
static void tractions_have_their_moment(void **state)
{
    (void)state;
    for (int n = 3; n <= 8; n++)
        for (int kind = 0; kind < 6; kind++) {
            struct box_scene box;
            make_box(&box, 2, 1, .05);
            box.scene.body.high[1] = n * .05;
            box.scene.body.jitter = kind > 3 ? .2 : 0;
            struct load load = {
                .shape = kind % 2 == 0 ? LOAD_FACE : LOAD_SQUARE, .face = FACE_Y_HIGH, .amplitude = 1};
            load.centre[0] = .5;
            load.centre[1] = n * .05;
            load.size[0] = .6;
            load.direction[0] = 1;
            box.scene.loads = 1;
            box.scene.load = &load;
            struct tl_options choice = options(kind / 2 == 1 ? 1 : 2, LAW_LINEAR, .1);
            struct model *model = make(&box.scene, &choice);
            const struct tl_load *made = ((struct tl_model *)model)->load;
            double force = 0, moment = 0;
            for (size_t k = 0; k < made->count; k++) {
                force += made->force[2 * k];
                moment += made->force[2 * k] * (model->position[3 * made->point[k] + 1] - n * .025);
            }
            const double expected = load.shape == LOAD_FACE ? 1 : .6;
            assert_near(force, expected, 1e-13);
            assert_near(moment / (expected * n * .025), 1,
                        kind > 3        ? .1
                        : kind % 2 == 1 ? .03
                                        : 1e-12); /* beside the ends rows differ */
            model_free(&model);
        }
}

/* Patches carry their force whatever part of the points they cut; point forces too, halved on a symmetry
 * plane. */
static void patches_carry_their_force(void **state)
{
    (void)state;
    struct box_scene box;
    make_box(&box, 3, 1, .1);
    box.scene.boundary[FACE_X_LOW].kind = BOUNDARY_SYMMETRY;
    struct load load[3] = {0};
    for (int k = 0; k < 3; k++) {
        load[k].face = FACE_Z_LOW;
        load[k].direction[2] = 1;
        load[k].amplitude = 2;
        load[k].centre[1] = .47;
    }
    load[0].shape = LOAD_SQUARE;
    load[0].size[0] = .62;
    load[0].size[1] = .33;
    load[1].shape = LOAD_DISC;
    load[1].size[0] = .7;
    load[2].shape = LOAD_POINT;
    box.scene.loads = 3;
    box.scene.load = load;
    const struct tl_options choice = options(1, LAW_LINEAR, 0);
    struct model *model = make(&box.scene, &choice);
    const struct tl_model *tl = (struct tl_model *)model;
    const double expected[3] = {2 * .31 * .33, 2 * .5 * M_PI * .35 * .35, 1};
    for (int k = 0; k < 3; k++) {
        double force = 0;
        for (size_t e = 0; e < tl->load[k].count; e++)
            force += tl->load[k].force[3 * e + 2];
        assert_near(force, expected[k], k == 1 ? 5e-3 : 1e-13); /* the disc's area is counted in cuts */
    }
    model_free(&model);
}

/* Faces that move together carry the body along; a face pushed along its normal with slip stretches it
 * evenly. */
static void motions_are_followed(void **state)
{
    (void)state;
    for (int slip = 0; slip < 2; slip++) {
        struct box_scene box;
        make_box(&box, 2, 1, .15);
        for (int face = 0; face < 2; face++) {
            struct boundary *boundary = &box.scene.boundary[face];
            boundary->kind = BOUNDARY_DISPLACEMENT;
            boundary->direction[0] = 1;
            boundary->slip = slip == 1;
            boundary->amplitude = slip == 1 ? face * .01 : .01;
        }
        const struct tl_options choice = options(2, LAW_LINEAR, .1);
        struct model *model = make(&box.scene, &choice);
        double *y = array_new(model->state_size, sizeof *y);
        double *a = array_new(model->unknowns, sizeof *a);
        const double across = box.material.lambda / (box.material.lambda + 2 * box.material.mu);
        for (size_t i = 0; i < model->points; i++) {
            const double *x = model->position + 3 * i;
            y[2 * i] = slip ? .02 * x[0] : .02;
            y[2 * i + 1] = slip ? -.02 * across * x[1] : 0;
        }
        const double amplitude[FACES] = {2, 2};
        const struct drive drive = {.displacement = amplitude};
        model->spatial->accelerate(model, &drive, 0, y, NULL, a);
        for (size_t k = 0; k < model->unknowns; k++)
            assert_near(a[k], 0, 1e-12);
        array_free(y);
        array_free(a);
        model_free(&model);
    }
}

static void what_cannot_be_is_refused(void **state)
{
    (void)state;
    for (int k = 0; k < 3; k++) {
        struct box_scene box;
        struct messages messages = {0};
        struct model *model = NULL;
        struct tl_options choice = options(2, LAW_LINEAR, .1);
        make_box(&box, 2, 1, .1);
        if (k == 0) box.scene.body.spacing = .6; /* two points across: no quadratic */
        if (k == 1) {
            box.scene.boundary[0].kind = BOUNDARY_VELOCITY;
            box.scene.boundary[0].slip = true;
            box.scene.boundary[0].direction[1] = 1;
        }
        if (k == 2) {
            box.scene.loads = 1;
            box.scene.load[0] = (struct load){.velocity = {1, 0, 0}, .shape = LOAD_FACE};
        }
        assert_int_not_equal(total_lagrangian_create(&box.scene, &choice, &model, &messages), SELAS_OK);
        assert_null(model);
        assert_int_equal(messages.errors, 1);
        messages_free(&messages);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(patch_tests),
        cmocka_unit_test(probes_extrapolate),
        cmocka_unit_test(nearly_dependent_fits_are_refused),
        cmocka_unit_test(forces_are_the_energys_derivative),
        cmocka_unit_test(spectrum_is_imaginary),
        cmocka_unit_test(turns_make_no_force),
        cmocka_unit_test(quarters_are_wholes),
        cmocka_unit_test(tractions_balance_uniform_stress),
        cmocka_unit_test(tractions_have_their_moment),
        cmocka_unit_test(patches_carry_their_force),
        cmocka_unit_test(motions_are_followed),
        cmocka_unit_test(what_cannot_be_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
