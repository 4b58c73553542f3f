/* What is seen of the published smoothed point method: probes, de-convolution, fields. */
#include "base/memory.h"
#include "paper_box.h"

#include <string.h>

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
    probe_free(&probe);
    array_free(f);
    messages_free(&messages);
    destroy(paper);
}

/* A body that moves as a whole is seen to do so, by Eq 38 too: nowhere another motion, nowhere a gradient. */
static void test_whole_motion(void **state)
{
    (void)state;
    for (int jittered = 0; jittered < 2; jittered++) {
        struct box_scene box;
        make_box(&box, 3, 3, .5);
        box.scene.body.jitter = jittered * .2;
        const struct paper_options options = paper_options_default();
        struct paper *paper = create(&box, &options);
        double *f = array_new(paper->set.points, sizeof *f);
        struct messages messages = {0};
        for (size_t i = 0; i < paper->set.points; i++)
            f[i] = 1;
        for (size_t i = 0; i < paper->set.points; i += 3) {
            struct probe probe = {0};
            double value[4];
            assert_int_equal(paper_probe(&paper->model, paper->set.position + 3 * i, &probe, &messages),
                             SELAS_OK);
            observe(&probe, paper, f, value);
            assert_near(value[0], 1, 1e-11);
            for (size_t c = 1; c < 4; c++)
                assert_near(value[c], 0, 1e-10);
            probe_free(&probe);
        }
        array_free(f);
        destroy(paper);
    }
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
        model->core->field(model, fields[f], y, NULL, 0, model->points, value);
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
        cmocka_unit_test(test_probes),
        cmocka_unit_test(test_whole_motion),
        cmocka_unit_test(test_fields),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
