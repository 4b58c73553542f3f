/* The ground as a field: tilted and graded layers, blocks, a model from a file, what is refused; the effective
 * medium at an interface (doc/theory/general-ground.md, section 4). */
#include "chance.h"
#include "from_deck.h"

#include "method/consistent/consistent.h"
#include "method/methods.h"
#include "scene/ground.h"

#include <hdf5.h>
#include <math.h>
#include <stdlib.h>
#include <unistd.h>

static const char stored[] = "build/test/ground.h5";

#define HEAD                                                                                                 \
    "&scene dimension = 3, end_time = 1 /\n"                                                                 \
    "&material name = 'soil', density = 2.0, p_speed = 2.0, s_speed = 1.0 /\n"
#define ROCK "&material name = 'rock', density = 3.0, p_speed = 6.0, s_speed = 3.0 /\n"
#define BODY                                                                                                 \
    "&body material = 'soil', low = 0.0, 0.0, 0.0, high = 2.0, 2.0, 2.0, spacing = 0.25 /\n"                 \
    "&load face = 'z-', shape = 'square', centre = 1.0, 1.0, 0.0, size = 1.0, 1.0, direction = 0, 0, 1, "    \
    "history = 'triangle', duration = 1 /\n"

#define HILL                                                                                                 \
    "&body material = 'soil', low = 0.0, 0.0, 0.0, high = 2.0, 2.0, 2.0, spacing = 0.25 /\n"                 \
    "&load kind = 'moment-tensor', centre = 1.0, 1.0, 1.5, moment = 1, 1, 1, 0, 0, 0, "                      \
    "history = 'triangle', duration = 1 /\n"

static void assert_rock(const struct scene *scene, double x, double y, double z, double density, double p,
                        double s)
{
    const struct rock rock = ground_at(scene, (double[]){x, y, z});
    assert_near(rock.density, density, 1e-12);
    assert_near(rock.mu, density * s * s, 1e-12);
    assert_near(rock.lambda, density * (p * p - 2 * s * s), 1e-12);
}

static void test_layers_and_blocks(void **state)
{
    (void)state;
    struct from_deck made =
        right_scene(HEAD ROCK BODY
                    "&layer material = 'soil', bottom = 'rock', top = 0.0 /\n"
                    "&layer material = 'rock', top = 1.0, dip = 45, strike = 90 /\n"
                    "&block material = 'soil', centre = 1, 1, 2, size = 1, 1, 1 /\n"
                    "&block material = 'rock', shape = 'ellipsoid', centre = 1, 1, 2, size = .5, .5, 1 /\n");
    const struct scene *scene = made.scene;
    assert_true(ground_is_general(scene));
    assert_rock(scene, 0, 0, 1.01, 3, 6, 3);
    assert_rock(scene, 0, 0, 0, 2, 2, 1);
    assert_rock(scene, 0, 0, .5, 2.5, 4, 2);
    assert_rock(scene, 0, 1.5, .5, 2.5, 4, 2); /* level along y: the strike */
    assert_rock(scene, .5, 0, .25, 2.5, 4, 2); /* rises along x: strike + 90 is -x */
    assert_rock(scene, .5, 0, .51, 3, 6, 3);
    assert_rock(scene, .6, 1, 1.9, 2, 2, 1);   /* in the box */
    assert_rock(scene, 1, 1.2, 1.95, 3, 6, 3); /* in the ellipsoid */
    double at[128];
    assert_true(ground_jumps_at_most(scene) <= 128);
    assert_int_equal(ground_jumps(scene, (double[]){1, 1, 0}, 2, 1.2, 2, at), 2); /* top of either block */
    from_deck_free(&made);
}

/* Is a place in the box, by chance, of another rock than the first one? */
static bool differs(const struct scene *scene, const double low[3], const double high[3])
{
    const struct rock first = ground_at(scene, low);
    double place[3];
    for (int axis = 0; axis < 3; axis++)
        place[axis] = low[axis] + (high[axis] - low[axis]) * (double)chance(5) / 4;
    const struct rock rock = ground_at(scene, place);
    return rock.density != first.density || rock.lambda != first.lambda || rock.mu != first.mu;
}

/* Boxes by chance, in the body and beside it, that are told to be even are. */
static void test_even(void **state)
{
    (void)state;
    static const char *const ground[] = {
        "&layer material = 'soil', top = 0.0 /\n&layer material = 'rock', top = 1.0, dip = 40, strike = 60 "
        "/\n",
        "&block material = 'rock', centre = 0.5, 1, 0.3, size = 1, 1, 0.6 /\n"
        "&block material = 'rock', shape = 'ellipsoid', centre = 1.5, 1.2, 1.5, size = 1, 0.5, 1 /\n",
        "&topography shape = 'gaussian', centre = 1, 1, height = 0.4, width = 0.5 /\n"
        "&layer material = 'soil', top = 0.0 /\n&layer material = 'rock', top = 0.2 /\n"
        "&block material = 'soil', centre = 1, 1, 1, size = 0.4, 4, 0.5 /\n"};
    seed_begin(20);
    for (size_t n = 0; n < sizeof ground / sizeof *ground; n++) {
        char text[2000];
        size_t even = 0;
        enum { BOXES = 4000 };
        snprintf(text, sizeof text, "%s%s%s", HEAD ROCK, n < 2 ? BODY : HILL, ground[n]);
        struct from_deck made = right_scene(text);
        for (size_t i = 0; i < BOXES; i++) {
            double low[3], high[3];
            for (int axis = 0; axis < 3; axis++) {
                low[axis] = axis < 2 ? -.8 + (double)chance(3600) / 1000 : (double)chance(1900) / 1000;
                high[axis] = low[axis] + (double)(1 + chance(250)) / 1000;
            }
            for (int corner = 0; corner < 4; corner++) /* below the surface */
                low[2] =
                    fmax(low[2], ground_surface(made.scene, (double[]){corner & 1 ? high[0] : low[0],
                                                                       corner & 2 ? high[1] : low[1], 0}));
            if (low[2] >= high[2]) continue;
            if (!ground_is_even(made.scene, low, high)) continue;
            even++;
            for (int k = 0; k < 50; k++)
                assert_false(differs(made.scene, low, high));
        }
        assert_true(even > BOXES / 4);
        from_deck_free(&made);
    }
}

static const char heights[] = "build/test/interface.txt";

/* Heights 100 + x + bend y^2 in rows that are not evenly apart. */
static void write_heights(double bend, double end)
{
    FILE *file = fopen(heights, "w");
    for (int i = 0; i <= 20; i++)
        for (int j = 0; j <= 20; j++) {
            const double x = end * pow(i / 20., 1.3), y = j * .1;
            fprintf(file, "%.17g %.17g %.17g\n", x, y, 100 + x + bend * y * y);
        }
    fclose(file);
}

/* An interface from a file: of a plane that of a tilted layer, of a parabola its own; what is refused. */
static void test_interface_from_file(void **state)
{
    (void)state;
#define FROM_FILE(words)                                                                                     \
    HEAD ROCK BODY "&layer material = 'soil', bottom = 'rock', top = 0.0 /\n"                                \
                   "&layer material = 'rock', file = 'build/test/interface.txt', " words " /\n"
    write_heights(0, 2);
    struct from_deck made = right_scene(FROM_FILE("top = 1.0, datum = 100"));
    assert_true(ground_is_general(made.scene) && ground_varies(made.scene, 1));
    assert_rock(made.scene, 0, 0, 1.01, 3, 6, 3);
    assert_rock(made.scene, 0, 1.5, .5, 2.5, 4, 2);
    assert_rock(made.scene, .5, 0, .25, 2.5, 4, 2);
    assert_rock(made.scene, .5, 0, .51, 3, 6, 3);
    assert_rock(made.scene, 1.5, 0, .01, 3, 6, 3); /* above the surface there */
    from_deck_free(&made);
    write_heights(-.25, 2);
    made = right_scene(FROM_FILE("top = 101.0"));
    double at[128];
    assert_true(ground_jumps_at_most(made.scene) <= 128);
    const size_t count = ground_jumps(made.scene, (double[]){.3, 1.7, 0}, 2, .1, 2, at);
    const double interface = 1 - .3 + .25 * 1.7 * 1.7;
    assert_true(count >= 16 && count <= 32); /* the graded layer above it in parts */
    assert_near(at[count - 1], interface, 1e-12);
    for (size_t i = 0; i + 1 < count; i++)
        assert_true(at[i] > .1 && at[i] < interface);
    assert_int_equal(ground_jumps(made.scene, (double[]){.3, 1.7, 0}, 0, 0, 2, at), 0);
    from_deck_free(&made);
    assert_refused(FROM_FILE("top = 101.0, dip = 3"), "t.nml:", (const char *[]){"dip", "from a file", NULL});
    assert_refused(HEAD ROCK BODY "&layer material = 'rock', top = 1.0, datum = 3 /\n",
                   "t.nml:", (const char *[]){"datum", "without a file", NULL});
    write_heights(0, 1.5);
    assert_refused(FROM_FILE("top = 101.0"),
                   "t.nml:7:", (const char *[]){"from 0 to 1.5 along x", "the body from 0 to 2", NULL});
    unlink(heights);
    assert_refused(FROM_FILE("top = 101.0"), "t.nml:7:", (const char *[]){"cannot open", NULL});
}

/* A step within 10 of 1000 in a model: places for the integrals are its values' and, in the step, more. */
static void test_step_of_a_model(void **state)
{
    (void)state;
    FILE *file = fopen(heights, "w");
    fprintf(file, "0 0 -2005 4000 4000 5\n4000 4000 10\n2 2 202\n100 9000 100 9000 100 9000\n");
    for (int k = 0; k < 202; k++)
        for (int i = 0; i < 4; i++) {
            const double z = -2005 + 10 * k;
            fprintf(file, "%d %d %g %s\n", i % 2 * 4000, i / 2 * 4000, z,
                    z > -1030 ? "900 500 1000" : "1800 1000 1000");
        }
    fclose(file);
    struct from_deck made = right_scene(
        "&scene dimension = 3, end_time = 9 /\n"
        "&body low = 0, 0, 0, high = 4000, 4000, 2000, spacing = 100 /\n"
        "&load face = 'z-', shape = 'square', centre = 1000, 1000, 0, size = 900, 900, direction = 0, 0, 1, "
        "history = 'triangle', duration = 1 /\n"
        "&model file = 'build/test/interface.txt', origin = 0, 0 /\n");
    const size_t most = ground_jumps_at_most(made.scene);
    double *at = calloc(most, sizeof *at);
    const double place[3] = {1234, 567, 0};
    assert_int_equal(ground_jumps(made.scene, place, 2, 101, 104, at), 0);
    assert_int_equal(ground_jumps(made.scene, place, 2, 100, 150, at), 5);
    const size_t count = ground_jumps(made.scene, place, 2, 1000, 1050, at);
    assert_true(count >= 5 + 15 && count <= 5 + 31);
    for (size_t i = 0; i < count; i++)
        if (i < 5)
            assert_near(at[i], 1005 + 10 * (double)i, 1e-9);
        else
            assert_true(at[i] > 1025 && at[i] < 1035);
    free(at);
    from_deck_free(&made);
    unlink(heights);
}

static void write_model(int nz, double fault, bool whole)
{
    enum { NX = 2, NY = 3, MOST = 40 };
    double value[3][NX * NY * MOST];
    const hsize_t extent[3] = {NX, NY, (hsize_t)nz};
    for (int i = 0; i < NX * NY * nz; i++) {
        value[0][i] = 2 + .1 * (i % nz);
        value[1][i] = 4;
        value[2][i] = i == 4 ? fault : 2 - .1 * (i / nz % NY);
    }
    static const char *const names[] = {"density", "p_speed", "s_speed"};
    const double origin[3] = {0, 0, -.5}, spacing[3] = {2, 1, .5};
    const hid_t file = H5Fcreate(stored, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    const hid_t space = H5Screate_simple(3, extent, NULL);
    for (int n = 0; n < (whole ? 3 : 2); n++) {
        const hid_t set =
            H5Dcreate2(file, names[n], H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
        H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, value[n]);
        H5Dclose(set);
    }
    const hid_t three = H5Screate_simple(1, (const hsize_t[]){3}, NULL);
    for (int n = 0; n < 2; n++) {
        const hid_t attribute = H5Acreate2(file, n == 0 ? "origin" : "spacing", H5T_NATIVE_DOUBLE, three,
                                           H5P_DEFAULT, H5P_DEFAULT);
        H5Awrite(attribute, H5T_NATIVE_DOUBLE, n == 0 ? origin : spacing);
        H5Aclose(attribute);
    }
    H5Sclose(three);
    H5Sclose(space);
    H5Fclose(file);
}

#define MODEL                                                                                                \
    "&scene dimension = 3, end_time = 1 /\n"                                                                 \
    "&body low = 0.0, 0.0, 0.0, high = 2.0, 2.0, 2.0, spacing = 0.25 /\n"                                    \
    "&load face = 'z-', shape = 'square', centre = 1.0, 1.0, 0.0, size = 1.0, 1.0, direction = 0, 0, 1, "    \
    "history = 'triangle', duration = 1 /\n"                                                                 \
    "&model file = 'build/test/ground.h5' /\n"

static void test_model(void **state)
{
    (void)state;
    write_model(6, 2, true);
    struct from_deck made = right_scene(MODEL);
    assert_rock(made.scene, 0, 0, -.5, 2.1, 4, 2); /* beyond the body as at its face */
    assert_rock(made.scene, 1.3, .5, .25, 2.15, 4, 1.95);
    assert_rock(made.scene, 9, 9, 9, 2.5, 4, 1.8); /* as at the grid's edge */
    assert_near(scene_fastest(made.scene), 4, 1e-12);
    struct messages messages = {0};
    struct model *model = NULL;
    assert_int_equal(model_create(made.scene, &model, &messages), SELAS_OK);
    model_free(&model);
    from_deck_free(&made);
}

static void test_refused_models(void **state)
{
    (void)state;
    write_model(6, 0, true);
    assert_refused(MODEL, "t.nml:4:", (const char *[]){"the value at (0, 0, 1.5) of ", "no s_speed", NULL});
    write_model(6, 3.9, true);
    assert_refused(
        MODEL, "t.nml:4:", (const char *[]){"the value at (0, 0, 1.5)", "bulk modulus is negative", NULL});
    write_model(6, NAN, true);
    assert_refused(MODEL, "t.nml:4:", (const char *[]){"the value at (0, 0, 1.5)", "is not finite", NULL});
    write_model(5, 2, true);
    assert_refused(MODEL, "t.nml:4:", (const char *[]){"-0.5 to 1.5 along z", "the body from 0 to 2", NULL});
    write_model(6, 2, false);
    assert_refused(MODEL, "t.nml:4:", (const char *[]){"cannot read", "s_speed [nx, ny, nz]", NULL});
    FILE *file = fopen(stored, "r+");
    assert_int_equal(ftruncate(fileno(file), 700), 0); /* cut short */
    fclose(file);
    assert_refused(MODEL, "t.nml:4:", (const char *[]){"cannot read", NULL});
}

/* Other methods and references have no such ground. */
static void test_who_takes_it(void **state)
{
    (void)state;
    struct from_deck made =
        right_scene(HEAD ROCK BODY
                    "&method name = 'sph' /\n&block material = 'rock', centre = 1, 1, 1, size = 1, 1, 1 /\n");
    struct messages messages = {0};
    struct model *model = NULL;
    assert_int_equal(model_create(made.scene, &model, &messages), SELAS_UNSUPPORTED);
    assert_non_null(strstr(messages.text, "&block"));
    messages_free(&messages);
    from_deck_free(&made);
}

/* Speeds of the damped faces: those of a block where it lies, of its part of the face on the way. */
static void test_dampers(void **state)
{
    (void)state;
    struct from_deck made =
        right_scene(HEAD ROCK BODY "&boundary face = 'x+', 'z+', kind = 'transmitting', layer = 'lysmer' /\n"
                                   "&block material = 'rock', centre = 2, 1, 1, size = 1, 8, 1 /\n"
                                   "&block material = 'rock', centre = 1, 0, 2, size = 8, 2.2, .2 /\n");
    struct messages messages = {0};
    struct model *model = NULL;
    assert_int_equal(model_create(made.scene, &model, &messages), SELAS_OK);
    const struct consistent *c = consistent_of(model);
    for (size_t k = 0; k < c->n[DEPTH]; k++) {
        const double z = c->layout[DEPTH]->greville[k];
        const bool rock = fabs(z - 1)<.5, part = z> 1.9;
        const double most = 18. / 33; /* of 33 places, 0 < y < 1.1 */
        assert_near(c->speed[1][0][k], rock ? 6 : part ? 2 + 4 * most : 2, 1e-12);
        assert_near(c->speed[1][1][k], rock ? 3 : part ? 1 + 2 * most : 1, 1e-12);
        assert_near(c->speed[5][2][k], 2 + 4 * most, 1e-12);
        assert_near(c->speed[5][0][k], 1 + 2 * most, 1e-12);
    }
    model_free(&model);
    from_deck_free(&made);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_layers_and_blocks),
        cmocka_unit_test(test_even),
        cmocka_unit_test(test_interface_from_file),
        cmocka_unit_test(test_step_of_a_model),
        cmocka_unit_test(test_model),
        cmocka_unit_test(test_refused_models),
        cmocka_unit_test(test_who_takes_it),
        cmocka_unit_test(test_dampers),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
