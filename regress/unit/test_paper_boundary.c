/* Loads, dampers, held faces, filter and sources of the published smoothed point method. */
#include "base/memory.h"
#include "paper_box.h"

#include <string.h>

/* Total force on the face: sum of traction times area, along the load's direction. */
static double patch_force(struct box_scene *box, const struct paper_options *options)
{
    struct paper *paper = create(box, options);
    const double history = 1;
    const struct drive drive = {.load = &history};
    double force = 0;
    assert_true(paper_tractions(paper, &drive));
    for (size_t e = 0; e < paper->elements; e++)
        for (size_t c = 0; c < 3; c++)
            force += paper->element[e].area * paper->traction[3 * e + c] * box->load.direction[c];
    destroy(paper);
    return force;
}

/* The patch carries amplitude times area: on and off the lattice, cut by the edge of the face, jittered,
 * turned; as a whole face, a disc, a point. */
static void test_patch_force(void **state)
{
    (void)state;
    struct paper_options options = paper_options_default();
    struct box_scene box;
    make_box(&box, 3, 7, .5);
    box.scene.loads = 1;
    box.load = (struct load){.shape = LOAD_SQUARE,
                             .face = FACE_Z_LOW,
                             .centre = {3.5, 3.5, 0},
                             .size = {1, 1},
                             .direction = {0, 0, 1},
                             .amplitude = 2};
    assert_near(patch_force(&box, &options), 2, 1e-13);
    options.patch_overlap = false; /* 9 points, each with dx^2 to 1e-3: too much by 9/4 (numerics A1) */
    assert_near(patch_force(&box, &options), 2 * 2.25, 2 * 2.25 * 1e-3);
    options.patch_overlap = true;
    box.load.centre[0] = 2.83;
    box.load.size[1] = .31;
    assert_near(patch_force(&box, &options), 2 * .31, 1e-13);
    box.load.centre[0] = .2; /* .7 of its width is on the face */
    assert_near(patch_force(&box, &options), 2 * .31 * .7, 1e-13);
    box.scene.body.jitter = .2;
    rotate_box(&box, .3, .4, .5);
    body_to_deck(&box.scene.body, (const double[3]){3.1, 2.9, 0}, box.load.centre);
    assert_near(patch_force(&box, &options), 2 * .31, 1e-13);
    box.load.shape = LOAD_DISC;
    box.load.size[0] = 1.7;
    assert_near(patch_force(&box, &options), 2 * M_PI * .85 * .85, 1e-12);
    box.load.shape = LOAD_FACE;
    assert_near(patch_force(&box, &options), 2 * 49, 1e-11);
    box.load.shape = LOAD_POINT;
    assert_near(patch_force(&box, &options), 2, 1e-13);
}

/* Eq 19 at points near the face: sum of alpha_a W_ab A_b T_b against sums by hand for a whole loaded face on
 * a lattice with h = dx; as printed only face points are loaded, by the same amount. */
static void test_load_sums(void **state)
{
    (void)state;
    struct paper_options options = paper_options_default();
    struct box_scene box;
    make_box(&box, 3, 3, .5);
    box.scene.loads = 1;
    box.load = (struct load){.shape = LOAD_FACE, .face = FACE_Z_LOW, .direction = {0, 0, 1}, .amplitude = 1};
    const double second = pow(2 - sqrt(2), 3) / (4 * M_PI), third = pow(2 - sqrt(3), 3) / (4 * M_PI);
    const double plane = 1 / M_PI + 1 / M_PI + 4 * second;        /* sum of W dx^3 over the face */
    const double layer = 1 / (4 * M_PI) + 4 * second + 4 * third; /* and from one layer below */
    for (int local = 0; local < 2; local++) {
        options.load_distributed = local == 0;
        struct paper *paper = create(&box, &options);
        const double history = 1.3;
        const struct drive drive = {.load = &history};
        double *u = array_new(2 * paper->model.unknowns, sizeof *u), *a = u + paper->model.unknowns;
        paper->model.spatial->accelerate(&paper->model, &drive, 0, u, NULL, a);
        const size_t top = 3 + 7 * 3, below = top + 49, deep = below + 49;
        const double area = .25 * 7 / (10 * plane), density = box.material.density;
        /* the whole face carries exactly 9: shares are 9 over the sum of the statistical areas */
        double carried = 0;
        for (size_t e = 0; e < paper->elements; e++)
            if (paper->element[e].face == FACE_Z_LOW) carried += paper->element[e].area;
        const double traction = history * 9 / carried;
        assert_near(a[3 * top + 2], paper->alpha[top] * plane / .125 * area * traction / density, 1e-12);
        assert_near(a[3 * below + 2], local ? 0 : layer / .125 * area * traction / density, 1e-12);
        assert_near(a[3 * deep + 2], 0, 0);
        assert_near(a[3 * top], 0, 0);
        array_free(u);
        destroy(paper);
    }
}

/* Acceleration of one point for u = 0 and the velocity v everywhere. */
static void damped_acceleration(struct paper *paper, const double v[3], double half_step, size_t point,
                                double acceleration[3])
{
    const struct drive quiet = {0};
    const size_t n = paper->model.unknowns;
    double *u = array_new(3 * n, sizeof *u);
    for (size_t k = 0; k < n; k++)
        u[n + k] = v[k % 3];
    paper->model.spatial->accelerate(&paper->model, &quiet, half_step, u, u + n, u + 2 * n);
    memcpy(acceleration, u + 2 * n + 3 * point, 3 * sizeof *acceleration);
    array_free(u);
}

/* Eqs 31-33: -C s v / (1 + half_step C s) per component with C = c_p along the normal, c_s across, s =
 * alpha sum(W A); at edges and corners the faces add. */
static void test_dampers(void **state)
{
    (void)state;
    const struct paper_options options = paper_options_default();
    struct box_scene box;
    make_box(&box, 3, 3, .5);
    for (int face = 0; face < BOX_FACES; face++)
        box.scene.boundary[face].kind = BOUNDARY_TRANSMITTING;
    box.scene.boundary[FACE_Z_LOW].kind = BOUNDARY_FREE;
    struct paper *paper = create(&box, &options);
    assert_true(paper->model.damped);
    const double v[3] = {.3, -.7, 1.1}, half_step = .04;
    const double p = box.material.p_speed, s = box.material.s_speed;
    const size_t face = 0 + 7 * (3 + 7 * 3), edge = 0 + 7 * (6 + 7 * 3), corner = 0 + 7 * (6 + 7 * 6);
    const size_t inside = 3 + 7 * (3 + 7 * 3), free_face = 3 + 7 * 3, rim = 0 + 7 * 3;
    const double face_sum = paper_face_sum(paper, face, FACE_X_LOW);
    const double edge_sum = paper_face_sum(paper, edge, FACE_X_LOW);
    const double corner_sum = paper_face_sum(paper, corner, FACE_X_LOW);
    assert_near(edge_sum, paper_face_sum(paper, edge, FACE_Y_HIGH), 1e-12);
    const struct {
        size_t point;
        double c[3];
    } expected[] = {
        {face, {face_sum * p, face_sum * s, face_sum * s}},
        {edge, {edge_sum * (p + s), edge_sum * (p + s), 2 * edge_sum * s}},
        {corner, {corner_sum * (p + 2 * s), corner_sum * (p + 2 * s), corner_sum * (p + 2 * s)}},
        {inside, {0, 0, 0}},
        {free_face, {0, 0, 0}},
        {rim,
         {paper_face_sum(paper, rim, FACE_X_LOW) * p, paper_face_sum(paper, rim, FACE_X_LOW) * s,
          paper_face_sum(paper, rim, FACE_X_LOW) * s}},
    };
    for (size_t k = 0; k < sizeof expected / sizeof expected[0]; k++) {
        double a[3];
        damped_acceleration(paper, v, half_step, expected[k].point, a);
        for (int c = 0; c < 3; c++)
            assert_near(a[c], -expected[k].c[c] * v[c] / (1 + half_step * expected[k].c[c]), 1e-12);
    }
    /* alpha sum(W A) of a face point by hand: alpha times 7 / (10 dx), whatever the areas are */
    assert_near(face_sum, paper->alpha[face] * .7 / .5, 1e-12);
    destroy(paper);
}

static void test_held_faces(void **state)
{
    (void)state;
    const struct paper_options options = paper_options_default();
    struct box_scene box;
    make_box(&box, 3, 2, .5);
    rotate_box(&box, .2, .7, -.4);
    struct boundary *boundary = box.scene.boundary;
    boundary[FACE_X_LOW].kind = BOUNDARY_FIXED;
    boundary[FACE_Y_LOW].kind = BOUNDARY_ROLLER;
    boundary[FACE_Z_HIGH].kind = BOUNDARY_VELOCITY;
    boundary[FACE_Z_HIGH].amplitude = 3;
    boundary[FACE_Z_HIGH].slip = true;
    body_direction_to_deck(&box.scene.body, (const double[3]){0, 0, 1}, boundary[FACE_Z_HIGH].direction);
    struct paper *paper = create(&box, &options);
    const size_t n = paper->model.unknowns;
    double *u = array_new(3 * n, sizeof *u), *a = u + n, *before = u + 2 * n;
    uint64_t seed = 3;
    for (size_t k = 0; k < n; k++)
        u[k] = noise(&seed);
    double motion[FACES] = {0};
    motion[FACE_Z_HIGH] = .5;
    const struct drive drive = {.motion = motion};
    paper->model.spatial->accelerate(&paper->model, &drive, 0, u, NULL, a);
    for (size_t i = 0; i < paper->set.points; i++) {
        double own[3];
        body_direction_from_deck(&box.scene.body, a + 3 * i, own);
        const unsigned faces = paper->set.faces[i];
        const bool fixed = (faces >> FACE_X_LOW & 1) != 0, moved = (faces >> FACE_Z_HIGH & 1) != 0;
        const bool roller = (faces >> FACE_Y_LOW & 1) != 0;
        if (moved)
            assert_near(own[2], 1.5, 1e-13); /* a moving face wins over one at rest */
        else if (fixed)
            assert_near(own[2], 0, 1e-13);
        else
            assert_true(fabs(own[2]) > 1e-6);
        if (fixed || roller)
            assert_near(own[1], 0, 1e-13);
        else
            assert_true(fabs(own[1]) > 1e-6);
    }
    /* the filter leaves held components alone and moves the others */
    memcpy(a, u, n * sizeof *a);
    paper->model.spatial->after_step(&paper->model, .1, before, u, before + 0);
    size_t changed = 0;
    for (size_t i = 0; i < paper->set.points; i++) {
        double change[3], own[3];
        for (size_t c = 0; c < 3; c++)
            change[c] = u[3 * i + c] - a[3 * i + c];
        body_direction_from_deck(&box.scene.body, change, own);
        if ((paper->set.faces[i] >> FACE_Y_LOW & 1) != 0) assert_near(own[1], 0, 1e-14);
        changed += fabs(own[0]) > 1e-6;
    }
    assert_int_equal(changed, paper->set.points - paper->set.grid[1] * paper->set.grid[2]);
    array_free(u);
    destroy(paper);
}

/* Eq 35 on a lattice: constants pass, the sawtooth (-1)^(i+j+k) changes by its mean over the neighbours, on
 * the increment or on the displacement; v follows the increment. */
static void test_filter(void **state)
{
    (void)state;
    struct box_scene box;
    make_box(&box, 3, 3, .5);
    for (int increment = 0; increment < 2; increment++) {
        struct paper_options options = paper_options_default();
        options.filter = .3;
        options.filter_increment = increment != 0;
        struct paper *paper = create(&box, &options);
        const size_t n = paper->model.unknowns, centre = 3 + 7 * (3 + 7 * 3);
        double *u = array_new(3 * n, sizeof *u), *v = u + n, *before = u + 2 * n;
        for (size_t i = 0; i < paper->set.points; i++) {
            const size_t parity = i % 7 + i / 7 % 7 + i / 49;
            u[3 * i] = parity % 2 == 0 ? 1 : -1;
            u[3 * i + 1] = 2;
            u[3 * i + 2] = before[3 * i + 2] = u[3 * i]; /* no increment */
        }
        paper->model.spatial->after_step(&paper->model, .1, before, u, v);
        const double w1 = .25, w2 = pow(2 - sqrt(2), 3) / 4, w3 = pow(2 - sqrt(3), 3) / 4;
        const double mean = (-6 * w1 + 12 * w2 - 8 * w3) / (6 * w1 + 12 * w2 + 8 * w3);
        const double filtered = -1 + .3 * (-mean + 1); /* the centre's parity is odd */
        assert_near(u[3 * centre], filtered, 1e-14);
        assert_near(u[3 * centre + 1], 2, 1e-14);
        assert_near(u[3 * centre + 2], increment ? -1 : filtered, 1e-14);
        for (size_t c = 0; c < 3; c++)
            assert_near(v[3 * centre + c], (u[3 * centre + c] - before[3 * centre + c]) / .1, 1e-12);
        array_free(u);
        destroy(paper);
    }
}

/* Point force: rho V a sums to the force, whatever the points. Moment tensor: no total force (to the accuracy
 * of the lattice sum) and first moments rho V a_i x_j = M_ij times the stencil's own -sum of W_,j x_j V (1.04
 * at h = dx on the lattice, at a point of it). */
static void test_sources(void **state)
{
    (void)state;
    const struct paper_options options = paper_options_default();
    struct box_scene box;
    make_box(&box, 3, 3, .5);
    box.scene.loads = 1;
    box.load = (struct load){.kind = LOAD_BODY_FORCE,
                             .shape = LOAD_POINT,
                             .centre = {1.4, 1.6, 1.3},
                             .direction = {.6, 0, .8},
                             .amplitude = 5};
    for (int moment = 0; moment < 2; moment++) {
        if (moment) {
            box.load.kind = LOAD_MOMENT_TENSOR;
            for (int c = 0; c < 3; c++)
                box.load.centre[c] = 1.5;
            for (int k = 0; k < 6; k++)
                box.load.moment[k] = .3 * k - .4;
        } else {
            box.scene.body.jitter = .2;
        }
        struct paper *paper = create(&box, &options);
        const size_t n = paper->model.unknowns;
        double *u = array_new(2 * n, sizeof *u), *a = u + n;
        const double history = .7;
        const struct drive drive = {.load = &history};
        paper->model.spatial->accelerate(&paper->model, &drive, 0, u, NULL, a);
        double force[3] = {0}, first[3][3] = {{0}};
        for (size_t i = 0; i < paper->set.points; i++)
            for (size_t c = 0; c < 3; c++) {
                const double part = box.material.density * paper->volume[i] * a[3 * i + c];
                force[c] += part;
                for (size_t d = 0; d < 3; d++)
                    first[c][d] += part * (paper->set.position[3 * i + d] - box.load.centre[d]);
            }
        for (size_t c = 0; c < 3; c++)
            assert_near(force[c], moment ? 0 : .7 * 5 * box.load.direction[c], 1e-12);
        /* -sum of W' r / 3 V over the lattice: 6 points at 1, 12 at sqrt 2, 8 at sqrt 3, -W' r = 3/(4 pi) r
         * (2 - r)^2 for r >= 1 */
        const double stencil =
            (6 + 12 * sqrt(2) * pow(2 - sqrt(2), 2) + 8 * sqrt(3) * pow(2 - sqrt(3), 2)) / (4 * M_PI);
        const double volume = paper->volume[3 + 7 * (3 + 7 * 3)] / .125;
        static const int place[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
        for (int c = 0; c < 3 && moment; c++)
            for (int d = 0; d < 3; d++)
                assert_near(first[c][d], .7 * 5 * box.load.moment[place[c][d]] * stencil * volume, 1e-12);
        array_free(u);
        destroy(paper);
        box.scene.body.jitter = 0;
    }
}

/* A pulse in a bar of 80 intervals (1D, zero row sums, no filter) goes to both fixed ends and comes back
 * upside down after 8 lengths over c_p; free ends return it upright. */
static void test_bar(void **state)
{
    (void)state;
    struct paper_options options = paper_options_default();
    options.zero_row_sums = true;
    options.filter = 0;
    struct box_scene box;
    for (int fixed = 0; fixed < 2; fixed++) {
        make_box(&box, 1, 8, .1);
        for (int face = 0; face < 2 && fixed; face++)
            box.scene.boundary[face].kind = BOUNDARY_FIXED;
        struct paper *paper = create(&box, &options);
        const size_t n = paper->model.unknowns;
        double *u = array_new(3 * n, sizeof *u), *v = u + n, *a = u + 2 * n;
        const double speed = box.material.p_speed, dt = 8 / speed / 200;
        const struct drive quiet = {0};
        for (size_t i = 0; i < n; i++) {
            const double x = paper->set.position[3 * i] - 4;
            u[i] = exp(-x * x / .32);
            v[i] = speed * x / .16 * u[i];
        }
        paper->model.spatial->accelerate(&paper->model, &quiet, 0, u, NULL, a);
        for (int step = 0; step < 200; step++) {
            for (size_t i = 0; i < n; i++) {
                v[i] += dt / 2 * a[i];
                u[i] += dt * v[i];
            }
            paper->model.spatial->accelerate(&paper->model, &quiet, 0, u, NULL, a);
            for (size_t i = 0; i < n; i++)
                v[i] += dt / 2 * a[i];
        }
        double error = 0, size = 0;
        for (size_t i = 0; i < n; i++) {
            const double x = paper->set.position[3 * i] - 4, expected = (fixed ? -1 : 1) * exp(-x * x / .32);
            error += (u[i] - expected) * (u[i] - expected);
            size += expected * expected;
        }
        assert_true(sqrt(error / size) < .2);
        array_free(u);
        destroy(paper);
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_patch_force), cmocka_unit_test(test_load_sums), cmocka_unit_test(test_dampers),
        cmocka_unit_test(test_held_faces),  cmocka_unit_test(test_filter),    cmocka_unit_test(test_sources),
        cmocka_unit_test(test_bar),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
