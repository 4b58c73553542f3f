/* The surface of the ground from the deck: shapes, heights from files, what is refused, places by their
 * depth, boxes and mirror planes, who takes it (doc/theory/topography.md). */
#include "from_deck.h"

#include "method/methods.h"
#include "record/plots/cut.h"
#include "scene/symmetry.h"
#include "scene/topography.h"

#include <hdf5.h>
#include <math.h>
#include <unistd.h>

static const char stored[] = "build/test/heights.txt";

#define HEAD                                                                                                 \
    "&scene dimension = 3, end_time = 1 /\n"                                                                 \
    "&material name = 'soil', density = 2.0, p_speed = 2.0, s_speed = 1.0 /\n"
#define BOX                                                                                                  \
    "&body material = 'soil', low = 0.0, 0.0, 0.0, high = 4.0, 4.0, 2.0, spacing = 0.25 /\n"                 \
    "&load face = 'z-', shape = 'square', centre = 2.0, 2.0, depth = 0.0, size = 1.0, 1.0, "                 \
    "direction = 0, 0, 1, history = 'triangle', duration = 1 /\n"
#define HILL "&topography shape = 'gaussian', height = 0.5, centre = 2.0, 2.0, width = 0.7 /\n"
#define HEIGHTS "&topography file = 'build/test/heights.txt', datum = 100.0 /\n"

static void test_shapes(void **state)
{
    (void)state;
    struct from_deck made =
        right_scene(HEAD BOX HILL "&receiver name = 'top', position = 2.0, 2.0, -0.5 /\n"
                                  "&receiver name = 'deep', position = 2.7, 2.0, depth = 0.3 /\n");
    const struct scene *scene = made.scene;
    const double side = -.5 * exp(-.5);
    assert_near(scene->load[0].centre[2], -.5, 1e-15);
    assert_near(scene->receiver[1].position[2], side + .3, 1e-15);
    assert_int_equal(scene_mirror_axes(scene), 3);
    from_deck_free(&made);
    made =
        right_scene(HEAD BOX "&topography shape = 'ridge', height = 0.4, centre = 2, 2.2, width = 0.7 /\n");
    assert_near(made.scene->load[0].centre[2], -.4 * exp(-.04 / .98), 1e-15);
    assert_int_equal(scene_mirror_axes(made.scene), 1); /* along x, beside the middle of y */
    from_deck_free(&made);
    made = right_scene(
        HEAD BOX "&topography shape = 'canyon', height = 0.4, centre = 2, 2, width = 0.7, azimuth = 30 /\n");
    assert_near(made.scene->load[0].centre[2], .4, 1e-15);
    assert_int_equal(scene_mirror_axes(made.scene), 0);
    assert_non_null(strstr(made.scene->body.topography->text[0], "heights -0.4 to"));
    from_deck_free(&made);
}

static void write_heights(double step, double end, double fault, bool whole)
{
    FILE *file = fopen(stored, "w");
    fprintf(file, "# x y height\n");
    for (double x = 0; x < end + step / 2; x += step)
        for (double y = 0; y < 4 + step / 2; y += step) {
            if (!whole && x == 2 && y == 1) continue;
            fprintf(file, "%.17g, %.17g %.17g\n", x, y,
                    x == 1 && y == 1 ? fault : 100 + .1 * x + .2 * sin(y));
        }
    fclose(file);
}

/* Splines through heights: between the values too; coarse and fine grids; ends of a plane exact. */
static void test_heights(void **state)
{
    (void)state;
    for (int fine = 0; fine < 2; fine++) {
        write_heights(fine ? .125 : .5, 4, 100.1 + .2 * sin(1), true);
        struct from_deck made = right_scene(HEAD BOX HEIGHTS);
        const struct topography *topography = made.scene->body.topography;
        double worst = 0;
        for (double x = 0; x <= 4; x += .3)
            for (double y = 0; y <= 4; y += .3)
                worst =
                    fmax(worst, fabs(topography_drop(topography, (double[]){x, y}) + .1 * x + .2 * sin(y)));
        assert_true(worst < .0015); /* pieces of .8 and .5: .0012, .0002 */
        assert_near(topography_drop(topography, (double[]){0, 0}), 0, 1e-3);
        from_deck_free(&made);
    }
}

/* Heights with gaps along x, the last ones such as leave splines barely told: told; those of a parabola are what they
 * are all the same. */
static void test_gaps(void **state)
{
    (void)state;
    static const double place[][10] = {{0, .1, .2, .3, .4, .5, 3, 3.4, 3.8, 4},
                                       {0, .6, 3, 3.1, 3.2, 3.3, 3.4, 3.5, 3.6, 4},
                                       {0, .1, .2, .3, .4, 3.4, 3.5, 3.6, 3.7, 4},
                                       {0, .1, .3, .5, .7, 1.2, 1.4, 2.4, 2.7, 4}};
    for (int n = 0; n < 4; n++) {
        FILE *file = fopen(stored, "w");
        for (int i = 0; i < 10; i++)
            for (int j = 0; j < 9; j++)
                fprintf(file, "%.17g %.17g %.17g\n", place[n][i], .5 * j,
                        100 + .02 * pow(place[n][i] - 1, 2));
        fclose(file);
        struct from_deck made = right_scene(HEAD BOX HEIGHTS);
        assert_non_null(strstr(made.messages.text, "the heights have gaps along x, of up to"));
        for (double x = 0; x <= 4; x += .25)
            assert_near(topography_drop(made.scene->body.topography, (double[]){x, 2.2}),
                        -.02 * pow(x - 1, 2), 1e-12);
        from_deck_free(&made);
    }
}

/* The map of a plot shows where rocks meet at the surface. */
static void test_map(void **state)
{
    (void)state;
    struct from_deck made =
        right_scene(HEAD "&material name = 'rock', density = 2.0, p_speed = 4.0, s_speed = 2.0 /\n" BOX HILL
                         "&layer material = 'soil', top = 0 /\n&block material = 'rock', centre = 2, 2, 0, "
                         "size = 9, 9, .6 /\n");
    const struct scene *scene = made.scene;
    struct cut cut;
    cut_map(scene, &cut);
    assert_true(cut_fill(scene, &cut));
    FILE *file = fopen(stored, "w+");
    assert_true(cut_write_jumps(scene, &cut, file));
    rewind(file);
    double x, y;
    for (int count = 0; fscanf(file, "%lf %lf", &x, &y) == 2 || (assert_true(count > 100), false); count++)
        assert_near(topography_drop(scene->body.topography, (double[]){x, y}), -.3, .008);
    fclose(file);
    cut_free(&cut);
    from_deck_free(&made);
}

static void write_set(hid_t file, const char *name, int axes, const hsize_t *extent, const double *value)
{
    const hid_t space = H5Screate_simple(axes, extent, NULL);
    const hid_t set = H5Dcreate2(file, name, H5T_IEEE_F32BE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) >= 0);
    H5Dclose(set);
    H5Sclose(space);
}

enum { ALONG = 9, ACROSS = 5 };

/* In floats of the other end; z: rows along y, named so; fault: a value without a height. */
static void store_heights(const char *path, bool z, bool fault)
{
    const hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    double x[ALONG], y[ACROSS], height[ALONG * ACROSS];
    for (size_t i = 0; i < ALONG; i++)
        for (size_t j = 0; j < ACROSS; j++) {
            x[i] = (double)i / 2;
            y[j] = (double)j;
            height[z ? j * ALONG + i : i * ACROSS + j] = 100 + x[i] / 8 + y[j] * y[j] / 32;
        }
    if (fault) height[ALONG + 2] = NAN; /* (1, 1) where rows are along y */
    write_set(file, "x", 1, (hsize_t[]){ALONG}, x);
    write_set(file, "y", 1, (hsize_t[]){ACROSS}, y);
    write_set(file, z ? "z" : "height", 2, z ? (hsize_t[]){ACROSS, ALONG} : (hsize_t[]){ALONG, ACROSS},
              height);
    H5Fclose(file);
}

/* An attribute of a data set: a number, or a text if that is not NULL. */
static void mark_set(const char *path, const char *name, const char *word, const char *text, double number)
{
    const hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT), set = H5Dopen2(file, name, H5P_DEFAULT);
    const hid_t type = text != NULL ? H5Tcopy(H5T_C_S1) : H5Tcopy(H5T_NATIVE_DOUBLE),
                one = H5Screate(H5S_SCALAR);
    if (text != NULL) H5Tset_size(type, strlen(text) + 1);
    const hid_t attribute = H5Acreate2(set, word, type, one, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(H5Awrite(attribute, type, text != NULL ? (const void *)text : (const void *)&number) >= 0);
    H5Aclose(attribute);
    H5Sclose(one);
    H5Tclose(type);
    H5Dclose(set);
    H5Fclose(file);
}

/* Packed heights, those of no data, of another unit than the places. */
static void test_attributes_of_heights(void **state)
{
    (void)state;
    const char deck[] = HEAD BOX "&topography file = 'build/test/heights.h5', datum = 50.0 /\n";
    const char path[] = "build/test/heights.h5";
    store_heights(path, true, false);
    mark_set(path, "z", "scale_factor", NULL, .25);
    mark_set(path, "z", "add_offset", NULL, 25);
    mark_set(path, "z", "units", "meters", 0);
    mark_set(path, "x", "units", "m", 0);
    struct from_deck made = right_scene(deck);
    const double drop = topography_drop(made.scene->body.topography, (double[]){1.3, 2.2});
    assert_near(drop, -(1.3 / 8 + 2.2 * 2.2 / 32) / 4, 1e-6);
    from_deck_free(&made);
    static const char *const none[] = {"_FillValue", "missing_value"};
    for (int i = 0; i < 2; i++) {
        store_heights(path, true, false);
        mark_set(path, "z", none[i], NULL, 100 + 1. / 8 + 1. / 32); /* the one at (1, 1) */
        assert_refused(deck,
                       "t.nml:5:", (const char *[]){"'z', at (1, 1), is not a number, or no data", NULL});
    }
    store_heights(path, true, false);
    mark_set(path, "z", "units", "km", 0);
    assert_refused(deck, "t.nml:5:", (const char *[]){"'z' is in 'km', x in ''; expected both", NULL});
    mark_set(path, "x", "units", "km", 0);
    assert_refused(deck, "t.nml:5:", (const char *[]){"pressed to", NULL}); /* by the datum: the units pass */
    unlink(path);
}

/* A grid of HDF5, rows along x or, as netCDF-4 has them, along y. */
static void test_stored_heights(void **state)
{
    (void)state;
    const char deck[] = HEAD BOX "&topography file = 'build/test/heights.h5', datum = 100.0 /\n";
    const char path[] = "build/test/heights.h5";
    for (int z = 0; z < 2; z++) {
        store_heights(path, z, false);
        struct from_deck made = right_scene(deck);
        const double drop = topography_drop(made.scene->body.topography, (double[]){1.3, 2.2});
        assert_near(drop, -(1.3 / 8 + 2.2 * 2.2 / 32), 1e-12); /* of degree 2: no spline changes it */
        from_deck_free(&made);
    }
    store_heights(path, true, true);
    assert_refused(deck, "t.nml:5:", (const char *[]){"'z', at (1, 1), is not a number", NULL});
    const hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    write_set(file, "lon", 1, (hsize_t[]){2}, (double[]){7, 8});
    H5Fclose(file);
    assert_refused(deck, "t.nml:5:", (const char *[]){"expected the HDF5 data sets x [nx], y [ny]", NULL});
    unlink(path);
}

static void test_refused(void **state)
{
    (void)state;
    write_heights(.5, 3, 100.3, true);
    assert_refused(HEAD BOX HEIGHTS, "t.nml:5:",
                   (const char *[]){"the heights reach from 0 to 3 along x", "the body from 0 to 4", NULL});
    write_heights(.5, 4, NAN, true);
    assert_refused(HEAD BOX HEIGHTS,
                   "t.nml:5:", (const char *[]){"heights.txt:22: expected three numbers, x y height", NULL});
    write_heights(.5, 4, 100, false);
    assert_refused(HEAD BOX HEIGHTS,
                   "t.nml:5:", (const char *[]){"no height at (2, 1)", "9 x 9", "gmt surface", NULL});
    FILE *file = fopen(stored, "w");
    for (int i = 0; i < 40; i++)
        fprintf(file, "%g %g 100\n", i * .1, fmod(i * .77, 4));
    fclose(file);
    assert_refused(HEAD BOX HEIGHTS, "t.nml:5:", (const char *[]){"which is no grid", "gmt surface", NULL});
    file = fopen(stored, "w");
    fputs("CDF\001", file);
    fclose(file);
    assert_refused(HEAD BOX HEIGHTS, "t.nml:5:", (const char *[]){"classic", "gmt grd2xyz", NULL});
    write_heights(.5, 4, 100, true);
    assert_refused(HEAD BOX "&topography file = 'build/test/heights.txt' /\n",
                   "t.nml:5:", (const char *[]){"pressed to", "datum", NULL});
    assert_refused(HEAD BOX "&topography file = 'build/test/no.txt' /\n",
                   "t.nml:5:", (const char *[]){"cannot open", NULL});
    assert_refused(HEAD BOX "&topography shape = 'gaussian', height = .5, centre = 2, width = .7 /\n",
                   "t.nml:5:", (const char *[]){"1 value", "expected 2: x, y", NULL});
    assert_refused(HEAD BOX "&topography shape = 'gaussian', height = 1.0, centre = 2, 2, width = .3 /\n",
                   "t.nml:5:", (const char *[]){"as steep as 6", "60 at most", NULL});
    assert_refused(HEAD BOX HILL "&boundary face = 'z-', kind = 'fixed' /\n",
                   "t.nml:5:", (const char *[]){"free surface", NULL});
    assert_refused(HEAD BOX HILL "&receiver name = 'air', position = 2, 2, -.6 /\n", "t.nml:6:",
                   (const char *[]){"above the surface", "z = -0.5 there; position = 2, 2, depth = 0", NULL});
    assert_refused(HEAD BOX HILL "&profile name = 'line', from = 2, 2, -.5, to = 4, 2, 0, points = 5 /\n",
                   "t.nml:6:", (const char *[]){"leaves the ground at", NULL});
    assert_refused(HEAD BOX HILL "&receiver name = 'three', position = 2, 2, 1, depth = 0 /\n",
                   "t.nml:6:", (const char *[]){"in place of the last of the 3 values", NULL});
}

/* The box of a half-space holds the hill, and the depth below which its lattice is level. */
static void test_fitted(void **state)
{
    (void)state;
    struct from_deck made =
        right_scene(HEAD "&body material = 'soil', shape = 'half-space', spacing = 0.125 /\n"
                         "&load face = 'z-', shape = 'square', centre = 0, 0, depth = 0.0, size = .5, .5, "
                         "direction = 0, 0, 1, history = 'gaussian', width = .2, delay = .5 /\n"
                         "&topography shape = 'gaussian', height = 0.3, centre = 1, 0, width = 0.5 /\n");
    const struct body *body = &made.scene->body;
    assert_true(body->low[0] < -.7 && body->high[0] > 2.7 && body->low[1] < -1.7);
    assert_near(body->topography->depth, 2, 1e-12); /* of 1.8 even numbers of spacings */
    assert_true(body->high[2] > 2);
    from_deck_free(&made);
}

static void assert_no_model(const char *text, const char *word)
{
    struct from_deck made = right_scene(text);
    struct messages messages = {0};
    struct model *model = NULL;
    assert_int_equal(model_create(made.scene, &model, &messages), SELAS_UNSUPPORTED);
    if (strstr(messages.text, word) == NULL) fail_msg("%s", messages.text);
    messages_free(&messages);
    from_deck_free(&made);
}

static void test_who_takes_it(void **state)
{
    (void)state;
    assert_no_model(HEAD BOX HILL "&method name = 'sph' /\n", "no &topography");
    assert_no_model(HEAD BOX HILL "&method operator = 'layered' /\n", "&topography");
    assert_no_model(HEAD BOX HILL "&load kind = 'body-force', direction = 0, 0, 1, history = 'triangle', "
                                  "duration = 1 /\n",
                    "acts at a point");
    assert_no_model(HEAD BOX HILL "&load face = 'x-', shape = 'face', direction = 1, 0, 0, "
                                  "history = 'triangle', duration = 1 /\n",
                    "not on face x-");
    assert_refused("&scene dimension = 3, end_time = 4, accuracy = .01 /\n"
                   "&material name = 'soil', density = 2.0, p_speed = 2.0, s_speed = 1.0 /\n"
                   "&body material = 'soil', shape = 'half-space' /\n"
                   "&load face = 'z-', shape = 'square', centre = 0, 0, depth = 0.0, size = .5, .5, "
                   "direction = 0, 0, 1, history = 'step' /\n"
                   "&topography shape = 'gaussian', height = 0.3, centre = 1, 0, width = 0.5 /\n"
                   "&receiver name = 'r', position = 1, 0, depth = 0 /\n",
                   "t.nml:1:", (const char *[]){"histories whose spectrum ends", NULL});
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_stored_heights),
        cmocka_unit_test(test_attributes_of_heights),
        cmocka_unit_test(test_shapes),
        cmocka_unit_test(test_heights),
        cmocka_unit_test(test_refused),
        cmocka_unit_test(test_fitted),
        cmocka_unit_test(test_who_takes_it),
        cmocka_unit_test(test_gaps),
        cmocka_unit_test(test_map),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
