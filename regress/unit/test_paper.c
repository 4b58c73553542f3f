/* The operator of the published smoothed point method: statistical volumes and areas, row sums, symmetry and
 * its loss, patch tests where they hold and how far they fail where they do not, rotation, threads. */
#include "base/memory.h"
#include "paper_box.h"

#include <omp.h>
#include <string.h>

/* Acceleration of a displacement field without loads and dampers. */
static void accelerate(struct paper *paper, const double *u, double *a)
{
    const struct drive quiet = {0};
    paper->model.spatial->accelerate(&paper->model, &quiet, 0, u, NULL, a);
}

static size_t point_at(const struct paper *paper, size_t i, size_t j, size_t k)
{
    return i + paper->set.grid[0] * (j + paper->set.grid[1] * k);
}

/* The cubic spline of Eq 39 at distances 0, 1, sqrt 2, sqrt 3 for h = 1, written out again. */
static void spline_values(double w[4])
{
    w[0] = 1 / M_PI;
    w[1] = 1 / (4 * M_PI);
    w[2] = pow(2 - sqrt(2), 3) / (4 * M_PI);
    w[3] = pow(2 - sqrt(3), 3) / (4 * M_PI);
}

/* Eqs 24-29 on a lattice with h = dx, against sums written out by hand. */
static void test_statistics(void **state)
{
    (void)state;
    struct box_scene box;
    make_box(&box, 3, 3, .5);
    const struct paper_options options = paper_options_default();
    struct paper *paper = create(&box, &options);
    double w[4];
    spline_values(w);
    const double plane = w[0] + 4 * w[1] + 4 * w[2], layer = w[1] + 4 * w[2] + 4 * w[3];
    const double inside = plane + 2 * layer, face = plane + layer;
    const double half_plane = w[0] + 3 * w[1] + 2 * w[2], half_layer = w[1] + 3 * w[2] + 2 * w[3];
    const double volume = .125; /* dx^3 */
    assert_near(paper->volume[point_at(paper, 3, 3, 3)], volume / inside, 1e-14);
    assert_near(paper->volume[point_at(paper, 3, 3, 0)], volume / 2 / face, 1e-14);
    assert_near(paper->volume[point_at(paper, 3, 0, 0)], volume / 4 / (half_plane + half_layer), 1e-14);
    const double corner = w[0] + 3 * w[1] + 3 * w[2] + w[3];
    assert_near(paper->volume[point_at(paper, 6, 0, 0)], volume / 8 / corner, 1e-14);
    /* areas: S_a = 10 h / 7 */
    const size_t middle = point_at(paper, 3, 3, 0), edge = point_at(paper, 3, 0, 0);
    assert_int_equal(paper->first_element[middle + 1] - paper->first_element[middle], 1);
    assert_int_equal(paper->first_element[edge + 1] - paper->first_element[edge], 2);
    assert_near(paper->element[paper->first_element[middle]].area, .25 * 7 / (10 * plane), 1e-14);
    assert_near(paper->element[paper->first_element[edge]].area, .25 / 2 * 7 / (10 * half_plane), 1e-14);
    /* Eq 29: the corrected kernel sums to one at every boundary point, the inside is left alone */
    for (size_t a = 0; a < paper->set.points; a++) {
        double sum = 0;
        for (size_t p = paper->near.start[a]; p < paper->near.start[a + 1]; p++)
            sum += paper->alpha[a] * paper->kernel_volume[p];
        if (paper->set.faces[a] != 0)
            assert_near(sum, 1, 1e-14);
        else
            assert_near(paper->alpha[a], 1, 0);
    }
    destroy(paper);
}

/* In 2D the sum of the spline along a line is 1 at h = dx, so that areas (lengths) of faces are dx, half at
 * corners; in 1D the area is 1, the inner volume dx and the operator the central difference. */
static void test_plane_and_bar(void **state)
{
    (void)state;
    struct box_scene box;
    const struct paper_options options = paper_options_default();
    make_box(&box, 2, 3, .5);
    struct paper *paper = create(&box, &options);
    const size_t edge = 3, corner = 6;
    assert_near(paper->element[paper->first_element[edge]].area, .5, 1e-14);
    assert_int_equal(paper->first_element[corner + 1] - paper->first_element[corner], 2);
    assert_near(paper->element[paper->first_element[corner]].area, .5 / 2 / (2.0 / 3 + 1.0 / 6), 1e-14);
    destroy(paper);
    make_box(&box, 1, 3, .5);
    paper = create(&box, &options);
    assert_int_equal(paper->elements, 2);
    assert_near(paper->element[0].area, 1, 1e-14);
    assert_near(paper->element[0].normal[0], -1, 0);
    assert_near(paper->volume[3], .5, 1e-14);
    assert_near(paper->volume[0], .5 / 2 / (2.0 / 3 + 1.0 / 6), 1e-14);
    const double stiffness = (box.material.lambda + 2 * box.material.mu) / .25;
    const double *row = paper->block + paper->near.start[3];
    assert_int_equal(paper->near.start[4] - paper->near.start[3], 3);
    assert_near(row[0], stiffness, 1e-12);
    assert_near(row[1], -2 * stiffness, 1e-12);
    assert_near(row[2], stiffness, 1e-12);
    destroy(paper);
}

/* Interior row sums of the Laplacian's weights, numerics A1: -2.5, -.50, -.034, -.59, -.31, +.038, +.065 per
 * dx^2 for h/dx = .8 ... 1.4 (lambda = -mu leaves mu times the Laplacian). */
static void test_row_sums(void **state)
{
    (void)state;
    const double length[7] = {.8, .9, 1, 1.1, 1.2, 1.3, 1.4};
    const double expected[7] = {-2.5, -.50, -.034, -.59, -.31, .038, .065};
    const double digit[7] = {.05, .005, .0005, .005, .005, .0005, .0005};
    struct box_scene box;
    make_box(&box, 3, 5, .5);
    set_material(&box.material, -1, 1, 1);
    struct paper_options options = paper_options_default();
    for (int k = 0; k < 7; k++) {
        options.smoothing_length = length[k];
        struct paper *paper = create(&box, &options);
        const size_t a = point_at(paper, 5, 5, 5);
        double sum = 0, across = 0;
        for (size_t p = paper->near.start[a]; p < paper->near.start[a + 1]; p++) {
            sum += paper->block[9 * p];
            across += fabs(paper->block[9 * p + 1]);
        }
        assert_near(sum * .25, expected[k], digit[k]);
        assert_near(across, 0, 0);
        destroy(paper);
    }
}

/* Largest |V_a B_ab - (V_b B_ba)^T| over pairs that pass a test, over the largest |V_a B_ab|. */
static double asymmetry(const struct paper *paper, bool boundary)
{
    double worst = 0, largest = 0;
    for (size_t a = 0; a < paper->set.points; a++)
        for (size_t p = paper->near.start[a]; p < paper->near.start[a + 1]; p++) {
            const size_t b = paper->near.index[p];
            if (!boundary && (paper->set.faces[a] != 0 || paper->set.faces[b] != 0)) continue;
            size_t q = paper->near.start[b];
            while (paper->near.index[q] != a)
                q++;
            for (size_t k = 0; k < 9; k++) {
                const double here = paper->volume[a] * paper->block[9 * p + k];
                const double there = paper->volume[b] * paper->block[9 * q + 3 * (k % 3) + k / 3];
                worst = fmax(worst, fabs(here - there));
                largest = fmax(largest, fabs(here));
            }
        }
    return worst / largest;
}

/* The operator times the volume is symmetric between inner points, on any cloud; the boundary term and the
 * kernel correction take that away at the boundary. */
static void test_symmetry_and_its_loss(void **state)
{
    (void)state;
    struct box_scene box;
    make_box(&box, 3, 3, .5);
    struct paper_options options = paper_options_default();
    for (int jittered = 0; jittered < 2; jittered++) {
        box.scene.body.jitter = jittered ? .2 : 0;
        struct paper *paper = create(&box, &options);
        assert_true(asymmetry(paper, false) < 1e-14);
        assert_true(asymmetry(paper, true) > .1);
        destroy(paper);
        options.boundary_term = options.kernel_correction = false;
        paper = create(&box, &options);
        assert_true(asymmetry(paper, true) < 1e-14); /* Gamma and alpha are all that breaks it */
        destroy(paper);
        options.boundary_term = options.kernel_correction = true;
    }
}

/* Fills u_i = sum of g_ij x_j + offset_i. */
static void linear_field(const struct paper *paper, const double g[9], const double offset[3], double *u)
{
    const size_t n = (size_t)paper->dimension;
    for (size_t i = 0; i < paper->set.points; i++)
        for (size_t c = 0; c < n; c++) {
            u[n * i + c] = offset[c];
            for (size_t d = 0; d < n; d++)
                u[n * i + c] += g[3 * c + d] * paper->set.position[3 * i + d];
        }
}

/* Largest acceleration over inner points (all neighbours inside a full support) or over all. */
static double largest_acceleration(const struct paper *paper, const double *a, bool everywhere)
{
    const size_t n = (size_t)paper->dimension;
    double largest = 0;
    for (size_t i = 0; i < paper->set.points; i++) {
        bool inner = true;
        for (size_t p = paper->near.start[i]; p < paper->near.start[i + 1]; p++)
            inner = inner && paper->set.faces[paper->near.index[p]] == 0;
        if (!inner && !everywhere) continue;
        for (size_t c = 0; c < n; c++)
            largest = fmax(largest, fabs(a[n * i + c]));
    }
    return largest;
}

/* Constants: no force with zero row sums, at every point of any cloud; a spring to the ground as printed.
 * Linear fields: no force inside on a lattice (by symmetry of the stencil), with zero row sums; the free
 * surface does not balance them (documented: the body's stress sigma is 2 mu + lambda, and the residual of a
 * face point is a sizeable part of sigma / (rho dx)), nor do jittered points inside. */
static void test_patches(void **state)
{
    (void)state;
    static const double gradient[9] = {.3, -.2, .5, .1, .7, -.4, .25, .15, -.6}, zero[9] = {0};
    static const double offset[3] = {.4, -1, 2};
    struct box_scene box;
    make_box(&box, 3, 3, .5);
    struct paper_options options = paper_options_default();
    for (int jittered = 0; jittered < 2; jittered++)
        for (int zeroed = 0; zeroed < 2; zeroed++) {
            box.scene.body.jitter = jittered ? .2 : 0;
            options.zero_row_sums = zeroed != 0;
            struct paper *paper = create(&box, &options);
            double *u = array_new(paper->model.unknowns, sizeof *u);
            double *a = array_new(paper->model.unknowns, sizeof *a);
            linear_field(paper, zero, offset, u);
            accelerate(paper, u, a);
            if (zeroed)
                assert_true(largest_acceleration(paper, a, true) < 1e-12);
            else
                assert_true(largest_acceleration(paper, a, false) > .1);
            linear_field(paper, gradient, offset, u);
            accelerate(paper, u, a);
            const double scale = (box.material.lambda + 2 * box.material.mu) / (box.material.density * .5);
            if (zeroed && !jittered) assert_true(largest_acceleration(paper, a, false) < 1e-12);
            if (zeroed && jittered) assert_true(largest_acceleration(paper, a, false) > .01 * scale);
            assert_true(largest_acceleration(paper, a, true) > .1 * scale);
            array_free(u);
            array_free(a);
            destroy(paper);
        }
}

/* Inside, u_x = x^2 / 2 has the force (lambda + 2 mu) m and m is the second moment of the stencil's W_,xx, 1
 * only in the limit of many neighbours: the method is of order 0 in dx at fixed h / dx, and so says its law of waves,
 * of S waves by u_y = x^2 / 2. */
static void test_quadratic_field(void **state)
{
    (void)state;
    struct box_scene box;
    struct paper_options options = paper_options_default();
    options.zero_row_sums = true;
    double ratio[3];
    const double spacing[3] = {.5, .25, .5}, length[3] = {1, 1, 2.2};
    for (int k = 0; k < 3; k++) {
        options.smoothing_length = length[k];
        make_box(&box, 3, k == 2 ? 6 : 3, spacing[k]);
        struct paper *paper = create(&box, &options);
        double *u = array_new(paper->model.unknowns, sizeof *u);
        double *a = array_new(paper->model.unknowns, sizeof *a);
        for (size_t i = 0; i < paper->set.points; i++)
            u[3 * i] = u[3 * i + 1] = pow(paper->set.position[3 * i], 2) / 2;
        accelerate(paper, u, a);
        const size_t middle = paper->set.grid[0] / 2, centre = point_at(paper, middle, middle, middle);
        ratio[k] = a[3 * centre] * box.material.density / (box.material.lambda + 2 * box.material.mu);
        const double shear = a[3 * centre + 1] * box.material.density / box.material.mu;
        const struct wave_law *told = &paper->model.waves;
        const double tolerance = k < 2 ? 1e-12 : .01; /* wide stencils reach volumes that the faces change */
        assert_near(told->floor, M_PI * fabs(ratio[k] - 1), tolerance);
        assert_near(told->floor + told->shear, M_PI * fabs(shear - 1), tolerance);
        array_free(u);
        array_free(a);
        destroy(paper);
    }
    assert_near(ratio[0], ratio[1], 1e-12); /* refining does not change it */
    assert_true(fabs(ratio[0] - 1) > .02);
    assert_near(ratio[2], 1, .02); /* with some 350 neighbours it does hold */
}

/* A turned body gives turned accelerations, with jitter, load, dampers and held faces. */
static void test_rotation(void **state)
{
    (void)state;
    const struct paper_options options = paper_options_default();
    struct box_scene box, turned;
    make_box(&box, 3, 2, .5);
    box.scene.body.jitter = .2;
    box.scene.boundary[FACE_X_LOW].kind = BOUNDARY_TRANSMITTING;
    box.scene.boundary[FACE_Y_LOW].kind = BOUNDARY_TRANSMITTING;
    box.scene.boundary[FACE_Z_HIGH].kind = BOUNDARY_ROLLER;
    box.scene.boundary[FACE_X_HIGH].kind = BOUNDARY_FIXED;
    box.scene.loads = 1;
    box.load = (struct load){.shape = LOAD_SQUARE,
                             .face = FACE_Z_LOW,
                             .centre = {1.1, .8, 0},
                             .size = {.9, .7},
                             .direction = {.6, 0, .8},
                             .amplitude = 2};
    turned = box;
    turned.scene.material = &turned.material;
    turned.scene.load = &turned.load;
    rotate_box(&turned, .4, -.9, 2.1);
    body_to_deck(&turned.scene.body, box.load.centre, turned.load.centre);
    body_direction_to_deck(&turned.scene.body, box.load.direction, turned.load.direction);
    struct paper *straight = create(&box, &options), *rotated = create(&turned, &options);
    const size_t n = straight->model.unknowns;
    double *work = array_new(6 * n, sizeof *work);
    double *u = work, *v = work + n, *a = work + 2 * n;
    double *turned_u = work + 3 * n, *turned_v = work + 4 * n, *turned_a = work + 5 * n;
    uint64_t seed = 5;
    for (size_t k = 0; k < 2 * n; k++)
        work[k] = noise(&seed);
    for (size_t i = 0; i < 2 * straight->set.points; i++)
        body_direction_to_deck(&turned.scene.body, work + 3 * i, turned_u + 3 * i);
    const double history = 1.7;
    const struct drive drive = {.load = &history};
    straight->model.spatial->accelerate(&straight->model, &drive, .05, u, v, a);
    rotated->model.spatial->accelerate(&rotated->model, &drive, .05, turned_u, turned_v, turned_a);
    double largest = 0;
    for (size_t k = 0; k < n; k++)
        largest = fmax(largest, fabs(a[k]));
    assert_true(largest > 1);
    for (size_t i = 0; i < straight->set.points; i++) {
        double expected[3];
        body_direction_to_deck(&turned.scene.body, a + 3 * i, expected);
        for (size_t c = 0; c < 3; c++)
            assert_near(turned_a[3 * i + c], expected[c], 1e-11 * largest);
    }
    array_free(work);
    destroy(straight);
    destroy(rotated);
}

/* The same bits with any number of threads. */
static void test_threads(void **state)
{
    (void)state;
    struct box_scene box;
    make_box(&box, 3, 2, .2);
    box.scene.body.jitter = .1;
    const struct paper_options options = paper_options_default();
    struct paper *paper = create(&box, &options);
    const size_t n = paper->model.unknowns;
    double *y = array_new(4 * n, sizeof *y), *one = y + 2 * n, *many = y + 3 * n;
    uint64_t seed = 9;
    for (size_t k = 0; k < 2 * n; k++)
        y[k] = noise(&seed);
    struct energy energy[2];
    omp_set_num_threads(1);
    accelerate(paper, y, one);
    paper->model.core->energy(&paper->model, y, &energy[0]);
    omp_set_num_threads(5);
    accelerate(paper, y, many);
    paper->model.core->energy(&paper->model, y, &energy[1]);
    assert_memory_equal(one, many, n * sizeof *one);
    assert_memory_equal(&energy[0], &energy[1], sizeof energy[0]);
    array_free(y);
    destroy(paper);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_statistics), cmocka_unit_test(test_plane_and_bar),
        cmocka_unit_test(test_row_sums),   cmocka_unit_test(test_symmetry_and_its_loss),
        cmocka_unit_test(test_patches),    cmocka_unit_test(test_quadratic_field),
        cmocka_unit_test(test_rotation),   cmocka_unit_test(test_threads),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
