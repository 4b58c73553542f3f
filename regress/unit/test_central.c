/* Total-Lagrangian points with central differences on a lattice (doc/theory/sph-total-lagrangian.md, section 10):
 * gradients, loads, receivers and the speed of surface waves. */
#include "base/memory.h"
#include "box_scene.h"
#include "method/total_lagrangian/total_lagrangian.h"

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_roots.h>
#include <string.h>

static struct model *make(const struct scene *scene, int degree, bool central, double hourglass)
{
    struct tl_options options = tl_default_options();
    options.degree = degree;
    options.central = central;
    options.hourglass = hourglass;
    options.law = LAW_LINEAR;
    struct messages messages = {0};
    struct model *model = NULL;
    if (total_lagrangian_create(scene, &options, &model, &messages) != SELAS_OK)
        fail_msg("%s", messages.text);
    messages_free(&messages);
    return model;
}

/* Linear fields everywhere, cubic ones two layers inside. */
static void gradients(void **state)
{
    (void)state;
    for (int d = 1; d <= 3; d++) {
        struct box_scene box;
        make_box(&box, d, 1, .125);
        struct model *model = make(&box.scene, 1, true, .5);
        struct tl_model *tl = (struct tl_model *)model;
        const size_t n = (size_t)d;
        double *u = array_new(model->state_size, sizeof *u);
        for (int cubic = 0; cubic < 2; cubic++) {
            for (size_t i = 0; i < model->points; i++)
                for (size_t c = 0; c < n; c++) {
                    const double x = model->position[3 * i + (c + 1) % n];
                    u[n * i + c] = (double)(c + 1) * x + cubic * (x * x * x - 2 * x * x);
                }
            tl_sites(tl, u, NULL, NULL, NULL);
            tl_gradients(tl);
            for (size_t i = 0; i < model->points; i++) {
                bool inside = true;
                for (size_t c = 0; c < n; c++)
                    inside = inside && fabs(model->position[3 * i + c] - .5) < .5 - 2 * .125;
                if (cubic && !inside) continue;
                for (size_t c = 0; c < n; c++) {
                    const double x = model->position[3 * i + (c + 1) % n];
                    const double slope = (double)(c + 1) + cubic * (3 * x * x - 4 * x);
                    double H[9];
                    tl_tensor(tl, i, H);
                    for (size_t b = 0; b < n; b++)
                        assert_near(H[n * c + b], b == (c + 1) % n ? slope : 0, 1e-12);
                }
            }
        }
        array_free(u);
        model_free(&model);
    }
}

/* Uniform tension between two loaded faces moves nothing, and the load on the last layers is (17, -5, 1, -1)
 * / 12 of the traction. */
static void tractions_balance(void **state)
{
    (void)state;
    static const double layer[4] = {17. / 12, -5. / 12, 1. / 12, -1. / 12};
    for (int d = 1; d <= 3; d++) {
        struct box_scene box;
        make_box(&box, d, 1, .1);
        struct load load[2];
        pull_box(&box, load);
        struct model *model = make(&box.scene, 1, true, .5);
        const struct tl_model *tl = (struct tl_model *)model;
        const size_t n = (size_t)d;
        const double area = pow(.1, d - 1);
        for (size_t k = 0; k < tl->load[0].count; k++) {
            const double depth = model->position[3 * tl->load[0].point[k]] / .1;
            const double part = depth < 4 ? layer[(size_t)depth] : 0;
            assert_near(tl->load[0].force[n * k], -.3 * area * part, 1e-13);
        }
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

/* Rayleigh's equation in x = (c / c_s)^2: (2 - x)^2 - 4 sqrt((1 - x)(1 - x c_s^2 / c_p^2)). */
static double rayleigh(double x, void *ratio)
{
    return (2 - x) * (2 - x) - 4 * sqrt((1 - x) * (1 - x * *(double *)ratio));
}

static double rayleigh_speed(const struct material *material)
{
    double ratio = pow(material->s_speed / material->p_speed, 2);
    gsl_function function = {rayleigh, &ratio};
    gsl_root_fsolver *solver = gsl_root_fsolver_alloc(gsl_root_fsolver_brent);
    assert_int_equal(gsl_root_fsolver_set(solver, &function, .5, 1 - 1e-9), 0);
    for (int k = 0; k < 60; k++)
        gsl_root_fsolver_iterate(solver);
    const double root = gsl_root_fsolver_root(solver);
    gsl_root_fsolver_free(solver);
    return material->s_speed * sqrt(root);
}

/* Frequency of the slowest motion with wave number k = pi / width along x in a plane slab with mirrors at
 * both ends: u_x ~ sin kx, u_y ~ cos kx times any profile over the layers. */
static double slowest(struct model *model, double k)
{
    const size_t columns = model->grid[0];
    const size_t layers = model->grid[1];
    gsl_matrix *matrix = gsl_matrix_calloc(2 * layers, 2 * layers);
    gsl_vector_complex *values = gsl_vector_complex_alloc(2 * layers);
    gsl_eigen_nonsymm_workspace *work = gsl_eigen_nonsymm_alloc(2 * layers);
    double *u = array_new(model->unknowns, sizeof *u);
    double *a = array_new(model->unknowns, sizeof *a);
    const struct drive quiet = {0};
    for (size_t q = 0; q < 2 * layers; q++) {
        memset(u, 0, model->unknowns * sizeof *u);
        for (size_t i = 0; i < columns; i++) {
            const size_t point = i + columns * (q / 2);
            const double phase = k * model->position[3 * point];
            u[2 * point + q % 2] = q % 2 == 0 ? sin(phase) : cos(phase);
        }
        model->spatial->accelerate(model, &quiet, 0, u, NULL, a);
        for (size_t p = 0; p < 2 * layers; p++) { /* every column says the same */
            const size_t point = columns * (p / 2);
            const double phase = k * model->position[3 * point];
            gsl_matrix_set(matrix, p, q, -a[2 * point + p % 2] / (p % 2 == 0 ? sin(phase) : cos(phase)));
        }
    }
    assert_int_equal(gsl_eigen_nonsymm(matrix, values, work), 0);
    double least = INFINITY;
    for (size_t q = 0; q < 2 * layers; q++) {
        const gsl_complex value = gsl_vector_complex_get(values, q);
        least = fmin(least, GSL_REAL(value));
    }
    gsl_matrix_free(matrix);
    gsl_vector_complex_free(values);
    gsl_eigen_nonsymm_free(work);
    array_free(u);
    array_free(a);
    return sqrt(fmax(0, least));
}

/* The slowest motion along a free surface is the Rayleigh wave: with six points a wavelength it runs within 2
 * % of its speed with central differences; with quadratic least-squares gradients and the default hourglass
 * control there is one at two thirds of that, which is why they ring under a small patch. */
static void surface_waves(void **state)
{
    (void)state;
    struct box_scene box;
    make_box(&box, 2, 1, 1. / 3);
    box.scene.body.high[1] = 6;
    box.scene.boundary[FACE_X_LOW].kind = BOUNDARY_SYMMETRY;
    box.scene.boundary[FACE_X_HIGH].kind = BOUNDARY_SYMMETRY;
    const double exact = rayleigh_speed(&box.material) * M_PI;
    struct model *central = make(&box.scene, 1, true, .5);
    struct model *quadratic = make(&box.scene, 2, false, .1);
    const double here = slowest(central, M_PI) / exact;
    const double there = slowest(quadratic, M_PI) / exact;
    model_free(&central);
    model_free(&quadratic);
    print_message("# surface wave, 6 points: central %.3f, quadratic %.3f of Rayleigh's speed\n", here,
                  there);
    assert_near(here, 1, .02);
    assert_true(there < .8);
}

/* Receivers: bilinear fields to rounding inside and on free faces, even fields and nought on mirrors. */
static void receivers(void **state)
{
    (void)state;
    struct box_scene box;
    make_box(&box, 2, 1, .1);
    box.scene.boundary[FACE_X_LOW].kind = BOUNDARY_SYMMETRY;
    struct model *model = make(&box.scene, 1, true, .5);
    double *y = array_new(model->state_size, sizeof *y);
    static const double place[3][3] = {{0, 0}, {.37, 0}, {.31, .52}};
    for (size_t i = 0; i < model->points; i++) {
        const double *x = model->position + 3 * i;
        y[2 * i] = x[0] * (2 - x[1]);
        y[2 * i + 1] = 3 + x[1] - .5 * (1 + x[1]) * x[0] * x[0];
    }
    for (int k = 0; k < 3; k++) {
        struct messages messages = {0};
        struct probe probe = {0};
        double value[6];
        assert_int_equal(model->core->probe(model, place[k], &probe, &messages), SELAS_OK);
        model->core->observe(model, &probe, SELAS_DISPLACEMENT, y, NULL, value);
        const double *x = place[k];
        assert_near(value[0], x[0] * (2 - x[1]), 1e-13);
        assert_near(value[1], 3 + x[1] - .5 * (1 + x[1]) * x[0] * x[0], 1e-13);
        probe_free(&probe);
    }
    array_free(y);
    model_free(&model);
}

static void jitter_is_refused(void **state)
{
    (void)state;
    struct box_scene box;
    make_box(&box, 2, 1, .1);
    box.scene.body.jitter = .1;
    struct tl_options options = tl_default_options();
    options.degree = 1;
    options.central = true;
    struct messages messages = {0};
    struct model *model = NULL;
    assert_int_equal(total_lagrangian_create(&box.scene, &options, &model, &messages), SELAS_UNSUPPORTED);
    messages_free(&messages);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(gradients), cmocka_unit_test(tractions_balance), cmocka_unit_test(surface_waves),
        cmocka_unit_test(receivers), cmocka_unit_test(jitter_is_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
