/* Smoothed points on clouds (doc/theory/cloud-method.md): summation by parts, exact linear fields, uniform stress
 * under tractions, a real spectrum, what is refused. */
#include "base/memory.h"
#include "box_scene.h"
#include "method/cloud/cloud.h"

#include <gsl/gsl_eigen.h>
#include <string.h>

static void make(struct box_scene *box, int d, double spacing)
{
    make_box(box, d, 1, spacing);
    box->scene.body.jitter = .2;
    box->scene.body.seed = 5;
}

static struct model *create(const struct scene *scene)
{
    struct tl_options options = tl_default_options();
    options.form = &cloud_form;
    options.law = LAW_LINEAR;
    struct messages messages = {0};
    struct model *model = NULL;
    if (total_lagrangian_create(scene, &options, &model, &messages) != SELAS_OK)
        fail_msg("%s", messages.text);
    messages_free(&messages);
    return model;
}

/* V_i G_ij^c where j is a neighbour of i, else 0. */
static double pair(const struct tl_model *tl, size_t i, size_t j, size_t c)
{
    const size_t d = (size_t)tl->cloud->dimension;
    for (size_t k = tl_first(&tl->gradient, i); k < tl_last(&tl->gradient, i); k++)
        if (tl_neighbour(&tl->gradient, i, k) == j)
            return tl->cloud->volume[i] * tl->gradient.weight[d * k + c];
    return 0;
}

/* Q_ij = -Q_ji, Q_ii = n_i A_i / 2, sum over j of Q_ij (x_j - x_i) = V_i e_c, volumes and areas exact. */
static void summation_by_parts(void **state)
{
    (void)state;
    for (int d = 1; d <= 3; d++) {
        struct box_scene box;
        make(&box, d, d == 3 ? .2 : .1);
        struct model *model = create(&box.scene);
        const struct tl_model *tl = (struct tl_model *)model;
        const size_t n = (size_t)d;
        const double size = pow(box.scene.body.spacing, d - 1);
        double *boundary = array_new(n * model->points, sizeof *boundary);
        double volume = 0;
        double moment = 0;
        for (size_t e = 0; e < tl->cloud->elements; e++) {
            const struct face_element *element = &tl->cloud->element[e];
            const size_t i = neighbours_nearest(&tl->near, element->position);
            for (size_t c = 0; c < n; c++)
                boundary[n * i + c] += element->area * element->normal[c];
            if (element->face == FACE_X_HIGH && d > 1)
                moment += element->area * element->position[1] * element->position[1];
        }
        if (d > 1) assert_near(moment, 1. / 3, 1e-13);
        for (size_t i = 0; i < model->points; i++) {
            volume += tl->cloud->volume[i] * (1 + model->position[3 * i]);
            for (size_t c = 0; c < n; c++) {
                double linear[3] = {0};
                double sum = 0;
                for (size_t k = tl_first(&tl->gradient, i); k < tl_last(&tl->gradient, i); k++) {
                    const size_t j = tl_neighbour(&tl->gradient, i, k);
                    const double q = pair(tl, i, j, c);
                    assert_near(q, -pair(tl, j, i, c), 1e-15);
                    sum += q;
                    for (size_t b = 0; b < n; b++)
                        linear[b] += q * (model->position[3 * j + b] - model->position[3 * i + b]);
                }
                assert_near(sum, -.5 * boundary[n * i + c], 1e-9 * size);
                for (size_t b = 0; b < n; b++)
                    assert_near(linear[b], b == c ? tl->cloud->volume[i] : 0,
                                1e-9 * size * box.scene.body.spacing);
            }
        }
        assert_near(volume, 1.5, 1e-13);
        array_free(boundary);
        model_free(&model);
    }
}

/* Uniform tension between two loaded faces, the others free: at rest. The force on each point is that of its
 * area, so nothing but the gradients can make it so. */
static void uniform_stress(void **state)
{
    (void)state;
    for (int d = 1; d <= 3; d++) {
        struct box_scene box;
        make(&box, d, d == 3 ? .2 : .1);
        struct load load[2];
        pull_box(&box, load);
        struct model *model = create(&box.scene);
        double *y = array_new(model->state_size, sizeof *y);
        double *a = array_new(model->unknowns, sizeof *a);
        stretch_box(&box, model->position, model->points, y);
        const double amplitude[2] = {1, 1};
        const struct drive drive = {.load = amplitude};
        model->spatial->accelerate(model, &drive, 0, y, NULL, a);
        for (size_t k = 0; k < model->unknowns; k++)
            assert_near(a[k], 0, 1e-8);
        array_free(y);
        array_free(a);
        model_free(&model);
    }
}

/* A patch carries its force and its first moment, a quarter of it where two mirrors cut it. */
static void patches(void **state)
{
    (void)state;
    struct box_scene box;
    make(&box, 3, .125);
    box.scene.boundary[FACE_X_LOW].kind = BOUNDARY_SYMMETRY;
    struct load load = {.face = FACE_Z_LOW, .shape = LOAD_SQUARE, .amplitude = 2};
    load.direction[2] = 1;
    load.centre[1] = .5;
    load.size[0] = .8;
    load.size[1] = .5;
    box.scene.loads = 1;
    box.scene.load = &load;
    struct model *model = create(&box.scene);
    const struct tl_model *tl = (struct tl_model *)model;
    double force = 0;
    double moment = 0;
    for (size_t e = 0; e < tl->load[0].count; e++) {
        force += tl->load[0].force[3 * e + 2];
        moment += tl->load[0].force[3 * e + 2] * model->position[3 * tl->load[0].point[e]];
    }
    assert_near(force, 2 * .4 * .5, 1e-12);
    assert_near(moment, 2 * .4 * .5 * .2, 1e-12);
    model_free(&model);
}

/* Eigenvalues of -M^-1 K by a general solver: real, not negative; a free body has its rigid motions as only
 * zeros. So no motion grows, however long it lasts. */
static void spectrum_is_real(void **state)
{
    (void)state;
    struct box_scene box;
    make(&box, 2, .125);
    struct model *model = create(&box.scene);
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
            gsl_matrix_set(matrix, l, k, -a[l]);
    }
    assert_int_equal(gsl_eigen_nonsymm(matrix, values, work), 0);
    double largest = 0;
    for (size_t k = 0; k < n; k++) {
        const gsl_complex value = gsl_vector_complex_get(values, k);
        largest = fmax(largest, GSL_REAL(value));
    }
    int zeros = 0;
    for (size_t k = 0; k < n; k++) {
        const gsl_complex value = gsl_vector_complex_get(values, k);
        assert_true(GSL_REAL(value) > -1e-9 * largest);
        assert_true(fabs(GSL_IMAG(value)) < 1e-9 * largest);
        zeros += GSL_REAL(value) < 1e-7 * largest;
    }
    assert_int_equal(zeros, 3);
    gsl_matrix_free(matrix);
    gsl_vector_complex_free(values);
    gsl_eigen_nonsymm_free(work);
    array_free(y);
    array_free(a);
    model_free(&model);
}

/* Held components neither move nor count. */
static void held_points_rest(void **state)
{
    (void)state;
    struct box_scene box;
    make(&box, 2, .125);
    box.scene.boundary[FACE_X_LOW].kind = BOUNDARY_FIXED;
    box.scene.boundary[FACE_Y_LOW].kind = BOUNDARY_SYMMETRY;
    struct model *model = create(&box.scene);
    double *u = array_new(model->unknowns, sizeof *u);
    double *a = array_new(model->unknowns, sizeof *a);
    for (size_t k = 0; k < model->unknowns; k++)
        u[k] = sin(7. * (double)k);
    const struct drive quiet = {0};
    model->spatial->accelerate(model, &quiet, 0, u, NULL, a);
    for (size_t i = 0; i < model->points; i++) {
        const double *x = model->position + 3 * i;
        assert_true((a[2 * i] == 0) == (x[0] == 0));
        assert_true((a[2 * i + 1] == 0) == (x[0] == 0 || x[1] == 0));
    }
    array_free(u);
    array_free(a);
    model_free(&model);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(summation_by_parts), cmocka_unit_test(uniform_stress),   cmocka_unit_test(patches),
        cmocka_unit_test(spectrum_is_real),   cmocka_unit_test(held_points_rest),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
