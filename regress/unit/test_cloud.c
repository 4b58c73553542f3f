/* Clouds: volumes and areas add up, cells are true Voronoi cells, points conform to the hole, files are read.
 */
#include "box_scene.h"
#include "points/cloud.h"

#include <hdf5.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

static struct cloud *make(const struct scene *scene)
{
    struct messages messages = {0};
    struct cloud *cloud = NULL;
    if (cloud_create(scene, &cloud, &messages) != SELAS_OK) fail_msg("%s", messages.text);
    messages_free(&messages);
    return cloud;
}

static double total(const struct cloud *cloud)
{
    double sum = 0;
    for (size_t i = 0; i < cloud->points; i++)
        sum += cloud->volume[i];
    return sum;
}

static double area_of(const struct cloud *cloud, int face)
{
    double sum = 0;
    for (size_t e = 0; e < cloud->elements; e++)
        if (cloud->element[e].face == face) sum += cloud->element[e].area;
    return sum;
}

static void boxes_of_all_dimensions(void **state)
{
    (void)state;
    for (int d = 1; d <= 3; d++)
        for (int jittered = 0; jittered < 2; jittered++) {
            struct box_scene box;
            make_box(&box, d, 1, .13);
            box.scene.body.high[0] = 1.7;
            box.scene.body.jitter = jittered ? .3 : 0;
            box.scene.body.seed = 4;
            struct cloud *cloud = make(&box.scene);
            assert_int_equal(cloud->points, 13 * (d > 1 ? 8 : 1) * (d > 2 ? 8 : 1));
            assert_near(total(cloud), 1.7, 1e-13);
            for (size_t i = 0; i < cloud->points; i++)
                assert_true(cloud->volume[i] > 0);
            assert_near(area_of(cloud, FACE_X_HIGH), 1, 1e-14);
            if (d > 1) assert_near(area_of(cloud, FACE_Y_LOW), 1.7, 1e-13);
            cloud_free(&cloud);
        }
}

/* The cells of an undisturbed lattice are its own boxes; one moved point changes the cells by hand. */
static void cells_are_voronoi_cells(void **state)
{
    (void)state;
    for (int d = 2; d <= 3; d++) {
        struct box_scene box;
        struct messages messages = {0};
        make_box(&box, d, 1, .2);
        struct cloud *cloud = make(&box.scene);
        const double volume = pow(.2, d);
        assert_int_equal(cloud_cells(cloud, &box.scene.body, &messages), SELAS_OK);
        for (size_t i = 0; i < cloud->points; i++)
            assert_near(cloud->volume[i], volume, 1e-15);
        cloud_free(&cloud);
    }
    /* two points in a square: the bisector from (.2, .5) to (.6, .5) is x = .4 */
    struct box_scene box;
    struct messages messages = {0};
    struct cloud *cloud = NULL;
    make_box(&box, 2, 1, .5);
    assert_int_equal(cloud_allocate(2, 2, &cloud, &messages), SELAS_OK);
    const double position[6] = {.2, .5, 0, .6, .5, 0};
    memcpy(cloud->position, position, sizeof position);
    assert_int_equal(cloud_cells(cloud, &box.scene.body, &messages), SELAS_OK);
    assert_near(cloud->volume[0], .4, 1e-15);
    assert_near(cloud->volume[1], .6, 1e-15);
    cloud_free(&cloud);
    /* in a cube, and skew: (.25, .25, .5) and (.75, .75, .5) share it by the diagonal plane */
    make_box(&box, 3, 1, .5);
    assert_int_equal(cloud_allocate(3, 2, &cloud, &messages), SELAS_OK);
    const double skew[6] = {.25, .25, .5, .75, .75, .5};
    memcpy(cloud->position, skew, sizeof skew);
    assert_int_equal(cloud_cells(cloud, &box.scene.body, &messages), SELAS_OK);
    assert_near(cloud->volume[0], .5, 1e-15);
    assert_near(cloud->volume[1], .5, 1e-15);
    cloud_free(&cloud);
}

static void make_plate(struct box_scene *box, double size, double x, double y, double radius, double spacing)
{
    make_box(box, 2, size, spacing);
    box->scene.body.shape = BODY_PLATE_WITH_HOLE;
    box->scene.body.hole_centre[0] = x;
    box->scene.body.hole_centre[1] = y;
    box->scene.body.hole_radius = radius;
}

static void plates_have_their_area(void **state)
{
    (void)state;
    static const struct {
        double x, y, angle; /* hole's centre in a plate [0, 2]^2, angle of the hole inside */
    } hole[] = {{0, 0, .5}, {2, 0, .5}, {0, 2, .5},  {2, 2, .5},  {0, 1, 1},
                {1, 0, 1},  {2, .9, 1}, {1.2, 2, 1}, {.9, 1.1, 2}};
    for (size_t k = 0; k < sizeof hole / sizeof *hole; k++)
        for (int arrangement = 0; arrangement < 4; arrangement++) {
            struct box_scene box;
            make_plate(&box, 2, hole[k].x, hole[k].y, .6, .09);
            box.scene.body.arrangement = (enum arrangement)arrangement;
            struct cloud *cloud = make(&box.scene);
            const double area = 4 - .5 * hole[k].angle * M_PI * .36;
            assert_near(body_volume(&box.scene.body, 2), area, 1e-14);
            assert_near(total(cloud), area, 1e-12);
            assert_near(area_of(cloud, FACE_HOLE), hole[k].angle * M_PI * .6, 1e-12);
            const bool cut = hole[k].x == 0;
            const bool corner = hole[k].angle == .5;
            assert_near(area_of(cloud, FACE_X_LOW), cut ? (corner ? 1.4 : .8) : 2, 1e-12);
            for (size_t i = 0; i < cloud->points; i++)
                assert_true(
                    hypot(cloud->position[3 * i] - hole[k].x, cloud->position[3 * i + 1] - hole[k].y) > .6);
            cloud_free(&cloud);
        }
}

/* Conformal points: the first ring follows the hole and the last one the edges, half a step away, everywhere;
 * neighbouring volumes differ little. */
static void conformal_points_conform(void **state)
{
    (void)state;
    struct box_scene box;
    make_plate(&box, 1, 0, 0, .3, .04);
    box.scene.body.arrangement = ARRANGEMENT_CONFORMAL;
    struct cloud *cloud = make(&box.scene);
    assert_true(fabs((double)cloud->points * .0016 / body_volume(&box.scene.body, 2) - 1) < .1);
    double hole[2] = {1, 0}; /* nearest and farthest of the first ring */
    double edge[2] = {1, 0}; /* of the last */
    size_t first = 0;
    size_t last = 0;
    for (size_t i = 0; i < cloud->points; i++) {
        const double *x = cloud->position + 3 * i;
        const double from_hole = hypot(x[0], x[1]) - .3;
        const double from_edge = fmin(1 - x[0], 1 - x[1]);
        const double step = sqrt(cloud->volume[i]);
        if (from_hole < .9 * step) {
            first++;
            hole[0] = fmin(hole[0], from_hole / step);
            hole[1] = fmax(hole[1], from_hole / step);
        }
        if (from_edge < .9 * step) {
            last++;
            edge[0] = fmin(edge[0], from_edge / step);
            edge[1] = fmax(edge[1], from_edge / step);
        }
    }
    assert_int_equal(first, last);
    assert_true(first >= 20);
    assert_true(hole[0] > .35 && hole[1] < .7);
    assert_true(edge[0] > .35 && edge[1] < .7);
    cloud_free(&cloud);
}

static void jitter_follows_the_seed(void **state)
{
    (void)state;
    struct cloud *cloud[3];
    for (int k = 0; k < 3; k++) {
        struct box_scene box;
        make_box(&box, 2, 1, .1);
        box.scene.body.jitter = .2;
        box.scene.body.seed = k == 2 ? 8 : 7;
        cloud[k] = make(&box.scene);
    }
    const size_t bytes = 3 * cloud[0]->points * sizeof(double);
    assert_memory_equal(cloud[0]->position, cloud[1]->position, bytes);
    assert_memory_not_equal(cloud[0]->position, cloud[2]->position, bytes);
    double farthest = 0;
    for (size_t i = 0; i < cloud[0]->points; i++)
        farthest = fmax(farthest, fabs(cloud[0]->position[3 * i] - (.05 + .1 * (double)(i % 10))));
    assert_true(farthest > .015 && farthest <= .02);
    for (int k = 0; k < 3; k++)
        cloud_free(&cloud[k]);
}

/* Planes `from` .. `end` - 1 of a cloud against the whole: points, volumes but for the margin, and the surface. */
static void compare_part(const struct scene *scene, const struct cloud *whole, size_t from, size_t end)
{
    struct messages messages = {0};
    struct cloud *part = NULL;
    size_t grid[3], elements = 0;
    assert_true(cloud_in_planes(scene, grid));
    const size_t planes = grid[scene->dimension - 1], plane = whole->points / planes;
    const size_t margin = plane * cloud_margin(scene), first = plane * from, last = plane * end;
    assert_int_equal(cloud_create_planes(scene, from, end, &part, &messages), SELAS_OK);
    assert_int_equal(part->first, first);
    assert_int_equal(part->points, last - first);
    assert_int_equal(part->whole, whole->points);
    assert_memory_equal(part->grid, whole->grid, sizeof part->grid);
    assert_memory_equal(part->position, whole->position + 3 * first, 3 * part->points * sizeof(double));
    const size_t right = from > 0 ? first + margin : 0, over = end < planes ? last - margin : last;
    assert_true(right < over);
    assert_memory_equal(part->volume + (right - first), whole->volume + right,
                        (over - right) * sizeof(double));
    for (size_t e = 0; e < whole->elements; e++) {
        const double place = whole->element[e].position[scene->dimension - 1];
        if (place < part->low || place > part->high) continue;
        assert_memory_equal(&part->element[elements], &whole->element[e], sizeof *part->element);
        elements++;
    }
    assert_int_equal(part->elements, elements);
    for (size_t i = 0; i < part->points; i++) {
        double place[3];
        cloud_place(scene, first + i, place);
        assert_memory_equal(place, whole->position + 3 * (first + i), sizeof place);
    }
    cloud_free(&part);
}

static void parts_are_those_of_the_whole(void **state)
{
    (void)state;
    for (int d = 2; d <= 3; d++)
        for (int k = 0; k < 3; k++) {
            struct box_scene box;
            size_t grid[3];
            make_box(&box, d, .6, .11);
            box.scene.body.high[d - 1] = 3;
            box.scene.body.jitter = .15 * k;
            struct cloud *whole = make(&box.scene);
            compare_part(&box.scene, whole, 0, 13);
            compare_part(&box.scene, whole, 6, 19);
            compare_part(&box.scene, whole, 14, 27);
            cloud_free(&whole);
            box.scene.body.jitter = 1; /* cells may reach anywhere */
            assert_false(cloud_in_planes(&box.scene, grid));
        }
}

static void bad_plates_are_refused(void **state)
{
    (void)state;
    static const double centre[3][2] = {{.2, 1}, {-.1, 1}, {1, 1.8}};
    for (int k = 0; k < 3; k++) {
        struct box_scene box;
        struct messages messages = {0};
        struct cloud *cloud = NULL;
        make_plate(&box, 2, centre[k][0], centre[k][1], .3, .1);
        assert_int_equal(cloud_create(&box.scene, &cloud, &messages), SELAS_BAD_SCENE);
        assert_null(cloud);
        assert_int_equal(messages.errors, 1);
        messages_free(&messages);
    }
}

static void check_file(const char *path, bool with_surface)
{
    struct box_scene box;
    make_box(&box, 2, 1, .5);
    box.scene.body.shape = BODY_POINTS;
    char name[64];
    snprintf(name, sizeof name, "%s", path);
    box.scene.body.file = name;
    struct cloud *cloud = make(&box.scene);
    assert_int_equal(cloud->points, 2);
    assert_near(cloud->position[3], .75, 0);
    assert_near(cloud->position[4], .5, 0);
    assert_near(cloud->volume[1], .25, 0);
    assert_int_equal(cloud->elements, with_surface ? 1 : 0);
    if (with_surface) {
        assert_int_equal(cloud->element[0].face, FACE_X_HIGH);
        assert_near(cloud->element[0].area, .5, 0);
        assert_near(cloud->element[0].position[0], 1, 1e-15);
    }
    cloud_free(&cloud);
}

static void write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static void write_dataset(hid_t file, const char *name, int rank, const double *values)
{
    const hsize_t extent[2] = {2, 2};
    const hid_t space = H5Screate_simple(rank, extent, NULL);
    const hid_t set = H5Dcreate2(file, name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values) >= 0);
    H5Dclose(set);
    H5Sclose(space);
}

static void points_come_from_files(void **state)
{
    (void)state;
    char path[] = "/tmp/selas-points-XXXXXX";
    const int descriptor = mkstemp(path);
    assert_true(descriptor >= 0);
    close(descriptor);
    write_text(path, "# x y volume\n.25 .5 .25\n\n.75, .5, .25 ! two\n");
    check_file(path, false);
    write_text(path, ".25 .5 .25 0 0 0\n.75 .5 .25 2 0 .5\n");
    check_file(path, true);
    const hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    write_dataset(file, "position", 2, (const double[]){.25, .5, .75, .5});
    write_dataset(file, "volume", 1, (const double[]){.25, .25});
    write_dataset(file, "normal", 2, (const double[]){0, 0, 1, 0});
    write_dataset(file, "area", 1, (const double[]){0, .5});
    H5Fclose(file);
    check_file(path, true);
    static const char *const bad[] = {"1 2\n",      "a b c\n",     "",
                                      ".1 .1 -1\n", ".1 .1 nan\n", "1 2 3 4 5 6 7 8 9\n"};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        struct box_scene box;
        struct messages messages = {0};
        struct cloud *cloud = NULL;
        make_box(&box, 2, 1, .5);
        box.scene.body.shape = BODY_POINTS;
        box.scene.body.file = path;
        write_text(path, bad[k]);
        assert_int_not_equal(cloud_create(&box.scene, &cloud, &messages), SELAS_OK);
        assert_null(cloud);
        messages_free(&messages);
    }
    unlink(path);
}

/* 9 x 4 points in no order, .1 apart but for one, with normals at two ends; x is the longest axis. */
static void write_layers(const char *path)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    for (int k = 0; k < 36; k++) {
        const int at = k * 7 % 36, i = at % 9, j = at / 9;
        fprintf(file, "%.3f %.3f .01 %d 0 %g\n", .05 + .1 * i + (at == 13 ? .04 : 0), .05 + .1 * j,
                i == 0   ? -1
                : i == 8 ? 1
                         : 0,
                i % 8 == 0 ? .1 : 0);
    }
    fclose(file);
}

static struct cloud *read_layers(struct box_scene *box, char *path)
{
    struct messages messages = {0};
    make_box(box, 2, 1, .1);
    box->scene.body.shape = BODY_POINTS;
    box->scene.body.high[0] = .9;
    box->scene.body.high[1] = .4;
    box->scene.body.file = path;
    struct cloud *cloud = make(&box->scene);
    assert_int_equal(cloud_sort(cloud, &box->scene.body, &messages), SELAS_OK);
    return cloud;
}

/* Layers hold their points in the order of the file; a part is a piece of the whole, and knows what that has. */
static void points_of_files_stand_in_layers(void **state)
{
    (void)state;
    char path[] = "/tmp/selas-points-XXXXXX";
    const int descriptor = mkstemp(path);
    assert_true(descriptor >= 0);
    close(descriptor);
    write_layers(path);
    struct box_scene box;
    struct messages messages = {0};
    struct cloud *whole = read_layers(&box, path), *part = read_layers(&box, path);
    assert_int_equal(whole->axis, 0);
    assert_int_equal(whole->layers, 9);
    for (size_t l = 0; l < 9; l++) {
        assert_int_equal(whole->start[l], 4 * l);
        for (size_t i = 4 * l; i < 4 * l + 4; i++) {
            const size_t at = 7 * (cloud_number(whole, i) - 1) % 36;
            assert_int_equal(at % 9, l);
            assert_near(whole->position[3 * i + 1], .05 + .1 * (double)(at / 9), 1e-12);
            assert_true(i % 4 == 0 || cloud_number(whole, i) > cloud_number(whole, i - 1));
        }
    }
    assert_int_equal(cloud_cut(&part, &box.scene.body, 1, 6, &messages), SELAS_OK);
    assert_int_equal(part->first, 4);
    assert_int_equal(part->points, 20);
    assert_int_equal(part->whole, 36);
    assert_memory_equal(part->position, whole->position + 12, 60 * sizeof(double));
    assert_memory_equal(part->all->position, whole->position, 108 * sizeof(double));
    assert_int_equal(part->elements, 0);
    for (int face = 0; face < FACES; face++) {
        double area = 0, of_part = 0;
        assert_int_equal(cloud_on_face(part, face, &of_part), cloud_on_face(whole, face, &area));
        assert_near(of_part, area, 0);
    }
    assert_near(cloud_volume(part), cloud_volume(whole), 0);
    assert_near(cloud_mean_power(part, 2), cloud_mean_power(whole, 2), 0);
    assert_int_equal(cloud_number(part, 3), cloud_number(whole, 7));
    cloud_free(&part);
    cloud_free(&whole);
    unlink(path);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(boxes_of_all_dimensions),         cmocka_unit_test(cells_are_voronoi_cells),
        cmocka_unit_test(plates_have_their_area),          cmocka_unit_test(conformal_points_conform),
        cmocka_unit_test(jitter_follows_the_seed),         cmocka_unit_test(bad_plates_are_refused),
        cmocka_unit_test(points_come_from_files),          cmocka_unit_test(parts_are_those_of_the_whole),
        cmocka_unit_test(points_of_files_stand_in_layers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
