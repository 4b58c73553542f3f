/* Loads, dampers, held faces, filter and de-convolution of the published smoothed point method. */
#include "base/memory.h"
#include "box_scene.h"
#include "method/paper.h"

#include <string.h>

static struct paper *create(struct box_scene *box, const struct paper_options *options)
{
    struct messages messages = {0};
    struct model *model;
    const selas_status status = paper_create(&box->scene, options, &model, &messages);
    if (status != SELAS_OK) print_error("%s", messages.text);
    assert_int_equal(status, SELAS_OK);
    return (struct paper *)model;
}

static void destroy(struct paper *paper)
{
    paper->model.class->destroy(&paper->model);
}

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
        paper->model.class->accelerate(&paper->model, &drive, 0, u, NULL, a);
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
    paper->model.class->accelerate(&paper->model, &quiet, half_step, u, u + n, u + 2 * n);
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
    paper->model.class->accelerate(&paper->model, &drive, 0, u, NULL, a);
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
    paper->model.class->after_step(&paper->model, .1, before, u, before + 0);
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
        paper->model.class->after_step(&paper->model, .1, before, u, v);
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

/* Value and gradient of a field u_x = f at a probe. */
static void observe(const struct probe *probe, const struct paper *paper, const double *f, double value[4])
{
    (void)paper;
    memset(value, 0, 4 * sizeof *value);
    for (size_t k = 0; k < probe->count; k++) {
        value[0] += probe->weight[k] * f[probe->index[k]];
        for (size_t c = 0; c < 3; c++)
            value[c + 1] += probe->gradient[3 * k + c] * f[probe->index[k]];
    }
}

/* Without de-convolution probes are exact for linear fields anywhere, on jittered points, and give the
 * point's own value at a point; with it they are Eq 38 there. */
static void test_probes(void **state)
{
    (void)state;
    struct box_scene box;
    make_box(&box, 3, 3, .5);
    box.scene.body.jitter = .2;
    struct paper_options options = paper_options_default();
    options.deconvolution = false;
    struct paper *paper = create(&box, &options);
    double *f = array_new(paper->set.points, sizeof *f);
    const double slope[3] = {.7, -1.2, .4};
    const double *position = paper->set.position;
    for (size_t i = 0; i < paper->set.points; i++)
        f[i] =
            3 + slope[0] * position[3 * i] + slope[1] * position[3 * i + 1] + slope[2] * position[3 * i + 2];
    const double places[][3] = {{1.3, 1.7, .9}, {0, 0, 0}, {3, .01, 1.2}, {1.5, 2.999, 0}, {.25, .25, .25}};
    struct messages messages = {0};
    struct probe probe = {0};
    double value[4];
    for (size_t k = 0; k < 5; k++) {
        assert_int_equal(paper_probe(&paper->model, places[k], &probe, &messages), SELAS_OK);
        observe(&probe, paper, f, value);
        assert_near(value[0], 3 + slope[0] * places[k][0] + slope[1] * places[k][1] + slope[2] * places[k][2],
                    1e-12);
        for (size_t c = 0; c < 3; c++)
            assert_near(value[c + 1], slope[c], 1e-11);
        probe_free(&probe);
    }
    const double away[3] = {9, 9, 9};
    assert_int_equal(paper_probe(&paper->model, away, &probe, &messages), SELAS_BAD_ARGUMENT);
    const size_t point = 3 + 7 * (2 + 7 * 0);
    uint64_t seed = 21;
    for (size_t i = 0; i < paper->set.points; i++)
        f[i] = noise(&seed);
    assert_int_equal(paper_probe(&paper->model, position + 3 * point, &probe, &messages), SELAS_OK);
    observe(&probe, paper, f, value);
    assert_near(value[0], f[point], 1e-12);
    probe_free(&probe);
    destroy(paper);

    options.deconvolution = true;
    paper = create(&box, &options);
    double others = 0;
    for (size_t p = paper->near.start[point]; p < paper->near.start[point + 1]; p++)
        if (paper->near.index[p] != point)
            others += paper->alpha[point] * paper->kernel_volume[p] * f[paper->near.index[p]];
    const double centre = paper->alpha[point] * paper->volume[point] / (M_PI * pow(paper->h, 3));
    assert_int_equal(paper_probe(&paper->model, paper->set.position + 3 * point, &probe, &messages),
                     SELAS_OK);
    observe(&probe, paper, f, value);
    assert_near(value[0], (f[point] - others) / centre, 1e-11);
    double sum = 0; /* at the boundary, where the kernel is corrected, constants pass unchanged */
    for (size_t k = 0; k < probe.count; k++)
        sum += probe.weight[k];
    assert_near(sum, 1, 1e-11);
    probe_free(&probe);
    array_free(f);
    messages_free(&messages);
    destroy(paper);
}

/* Fields at all points are what probes at the points see, turned body included. */
static void test_fields(void **state)
{
    (void)state;
    const struct paper_options options = paper_options_default();
    struct box_scene box;
    make_box(&box, 3, 1.5, .5);
    rotate_box(&box, .3, -.5, 1);
    struct paper *paper = create(&box, &options);
    struct model *model = &paper->model;
    double *y = array_new(model->state_size + 6 * model->points, sizeof *y);
    double *value = y + model->state_size;
    uint64_t seed = 77;
    for (size_t k = 0; k < model->state_size; k++)
        y[k] = noise(&seed);
    const selas_field fields[] = {SELAS_DISPLACEMENT, SELAS_VELOCITY, SELAS_STRESS, SELAS_ENERGY};
    struct messages messages = {0};
    for (size_t f = 0; f < 4; f++) {
        const size_t components = (size_t)field_components(fields[f]);
        model->class->field(model, fields[f], y, NULL, value);
        for (size_t i = 0; i < model->points; i += 7) {
            struct probe probe = {0};
            double seen[6];
            assert_int_equal(paper_probe(model, model->position + 3 * i, &probe, &messages), SELAS_OK);
            probe_observe(model, &probe, fields[f], y, NULL, seen);
            for (size_t c = 0; c < components; c++)
                assert_near(seen[c], value[components * i + c], 1e-10 * (1 + fabs(seen[c])));
            probe_free(&probe);
        }
    }
    array_free(y);
    destroy(paper);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_patch_force), cmocka_unit_test(test_load_sums), cmocka_unit_test(test_dampers),
        cmocka_unit_test(test_held_faces),  cmocka_unit_test(test_filter),    cmocka_unit_test(test_probes),
        cmocka_unit_test(test_fields),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
