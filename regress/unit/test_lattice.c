/* Points of a box: faces, jitter, rotation. */
#include "box_scene.h"
#include "points/lattice.h"

#include <string.h>

static void test_faces_and_spacing(void **state)
{
    (void)state;
    struct box_scene box;
    struct messages messages = {0};
    struct point_set set;
    make_box(&box, 3, 7, .125);
    assert_int_equal(lattice_create(&box.scene.body, 3, &set, &messages), SELAS_OK);
    assert_int_equal(set.points, 57 * 57 * 57);
    point_set_free(&set);

    make_box(&box, 3, 2, .5);
    box.scene.body.low[1] = -1;
    box.scene.body.high[2] = 1.2; /* not a multiple of the spacing: 2 intervals of .6 */
    assert_int_equal(lattice_create(&box.scene.body, 3, &set, &messages), SELAS_OK);
    assert_int_equal(set.grid[0], 5);
    assert_int_equal(set.grid[1], 7);
    assert_int_equal(set.grid[2], 3);
    assert_near(set.spacing[2], .6, 1e-15);
    size_t on_faces[4] = {0};
    for (size_t i = 0; i < set.points; i++)
        on_faces[faces_count(set.faces[i])]++;
    assert_int_equal(on_faces[3], 8);
    assert_int_equal(on_faces[2], 4 * (3 + 5 + 1));
    assert_int_equal(on_faces[1], 2 * (3 * 5 + 3 * 1 + 5 * 1));
    const size_t i = 1 + 5 * (6 + 7 * 2); /* x inside, y high, z high */
    assert_int_equal(set.faces[i], 1 << FACE_Y_HIGH | 1 << FACE_Z_HIGH);
    assert_near(set.position[3 * i], .5, 1e-15);
    assert_near(set.position[3 * i + 1], 2, 0);
    assert_near(set.position[3 * i + 2], 1.2, 0);
    point_set_free(&set);
    messages_free(&messages);
}

static void test_jitter(void **state)
{
    (void)state;
    struct box_scene box;
    struct messages messages = {0};
    struct point_set still, moved, again, other;
    make_box(&box, 3, 2, .25);
    assert_int_equal(lattice_create(&box.scene.body, 3, &still, &messages), SELAS_OK);
    box.scene.body.jitter = .2;
    box.scene.body.seed = 7;
    assert_int_equal(lattice_create(&box.scene.body, 3, &moved, &messages), SELAS_OK);
    assert_int_equal(lattice_create(&box.scene.body, 3, &again, &messages), SELAS_OK);
    box.scene.body.seed = 8;
    assert_int_equal(lattice_create(&box.scene.body, 3, &other, &messages), SELAS_OK);
    assert_memory_equal(moved.position, again.position, 3 * moved.points * sizeof *moved.position);
    double largest = 0, sum = 0, squares = 0;
    size_t free_coordinates = 0, same = 0;
    for (size_t k = 0; k < 3 * still.points; k++) {
        const double shift = moved.position[k] - still.position[k];
        const bool held = (still.faces[k / 3] >> (2 * (k % 3)) & 3) != 0;
        if (held) {
            assert_near(shift, 0, 0);
            continue;
        }
        same += moved.position[k] == other.position[k];
        largest = fmax(largest, fabs(shift));
        sum += shift;
        squares += shift * shift;
        free_coordinates++;
    }
    assert_int_equal(same, 0);
    assert_true(largest <= .05 && largest > .049);
    /* uniform in +-.05: mean 0, variance .05^2/3, each within 4 standard deviations of its estimate */
    const double n = (double)free_coordinates, variance = .05 * .05 / 3;
    assert_near(sum / n, 0, 4 * sqrt(variance / n));
    assert_near(squares / n, variance, 4 * variance * sqrt(.8 / n));
    point_set_free(&still);
    point_set_free(&moved);
    point_set_free(&again);
    point_set_free(&other);
    messages_free(&messages);
}

static void test_rotation(void **state)
{
    (void)state;
    struct box_scene box;
    struct messages messages = {0};
    struct point_set set;
    make_box(&box, 3, 2, 1);
    rotate_box(&box, 0, 0, M_PI / 2); /* about z through the centre: (x, y) -> (2 - y, x) */
    assert_int_equal(lattice_create(&box.scene.body, 3, &set, &messages), SELAS_OK);
    for (size_t i = 0; i < set.points; i++) {
        assert_near(set.position[3 * i], 2 - set.own_position[3 * i + 1], 1e-15);
        assert_near(set.position[3 * i + 1], set.own_position[3 * i], 1e-15);
        assert_near(set.position[3 * i + 2], set.own_position[3 * i + 2], 1e-15);
    }
    point_set_free(&set);
    messages_free(&messages);
}

/* Given points: a turned, jittered lattice comes back with its faces; a hole in a face or a stray point do
 * not pass. */
static void test_given_points(void **state)
{
    (void)state;
    struct box_scene box;
    struct messages messages = {0};
    struct point_set set, given;
    make_box(&box, 3, 2, .5);
    rotate_box(&box, .1, .2, .3);
    box.scene.body.jitter = .3;
    assert_int_equal(lattice_create(&box.scene.body, 3, &set, &messages), SELAS_OK);
    assert_int_equal(
        point_set_from_positions(&box.scene.body, 3, set.points, set.own_position, &given, &messages),
        SELAS_OK);
    assert_memory_equal(given.faces, set.faces, set.points);
    assert_memory_equal(given.position, set.position, 3 * set.points * sizeof *set.position);
    assert_int_equal(given.grid[0], 0);
    point_set_free(&given);
    assert_int_equal(
        point_set_from_positions(&box.scene.body, 3, set.points - 25, set.own_position, &given, &messages),
        SELAS_BAD_SCENE); /* the layer z+ is missing */
    set.own_position[0] = -.01;
    assert_int_equal(
        point_set_from_positions(&box.scene.body, 3, set.points, set.own_position, &given, &messages),
        SELAS_BAD_SCENE);
    assert_int_equal(messages.errors, 2);
    point_set_free(&set);
    messages_free(&messages);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_faces_and_spacing),
        cmocka_unit_test(test_jitter),
        cmocka_unit_test(test_rotation),
        cmocka_unit_test(test_given_points),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
