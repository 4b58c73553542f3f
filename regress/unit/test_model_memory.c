/* A model of the ground whose values take 180 MB, in pieces (doc/developers/ranks.md); regress/checks/ground-files.sh runs
 * it where they have no room. */
#include "from_deck.h"

#include "scene/ground.h"

#include <hdf5.h>
#include <unistd.h>

static const char stored[] = "build/test/large-model";
static const hsize_t extent[3] = {128, 128, 512}, part[3] = {16, 16, 64};
static const size_t other[3] = {64, 64, 256};

/* Is a value in the part that has another rock? */
static bool there(const size_t at[3])
{
    bool within = true;
    for (int axis = 0; axis < 3; axis++)
        within = within && at[axis] >= other[axis] && at[axis] < other[axis] + part[axis];
    return within;
}

static void write_set(hid_t file, const char *name, float usual, float otherwise)
{
    static float value[16 * 16 * 64];
    const hid_t all = H5Screate_simple(3, extent, NULL), one = H5Screate_simple(3, part, NULL),
                made = H5Pcreate(H5P_DATASET_CREATE);
    H5Pset_chunk(made, 3, part);
    H5Pset_deflate(made, 1);
    const hid_t set = H5Dcreate2(file, name, H5T_NATIVE_FLOAT, all, H5P_DEFAULT, made, H5P_DEFAULT);
    for (size_t i = 0; i < extent[0]; i += part[0])
        for (size_t j = 0; j < extent[1]; j += part[1])
            for (size_t k = 0; k < extent[2]; k += part[2]) {
                const hsize_t first[3] = {i, j, k};
                for (size_t n = 0; n < sizeof value / sizeof *value; n++)
                    value[n] = there((size_t[]){i, j, k}) ? otherwise : usual;
                H5Sselect_hyperslab(all, H5S_SELECT_SET, first, NULL, part, NULL);
                assert_true(H5Dwrite(set, H5T_NATIVE_FLOAT, one, all, H5P_DEFAULT, value) >= 0);
            }
    H5Dclose(set);
    H5Pclose(made);
    H5Sclose(one);
    H5Sclose(all);
}

static void put_places(hid_t file, const char *name, const double value[3])
{
    const hsize_t three = 3;
    const hid_t space = H5Screate_simple(1, &three, NULL),
                made = H5Acreate2(file, name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT);
    H5Awrite(made, H5T_NATIVE_DOUBLE, value);
    H5Aclose(made);
    H5Sclose(space);
}

static void write_model(void)
{
    const hid_t file = H5Fcreate(stored, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    write_set(file, "density", 2000, 2500);
    write_set(file, "p_speed", 4000, 5000);
    write_set(file, "s_speed", 2000, 2500);
    put_places(file, "origin", (double[]){0, 0, 0});
    put_places(file, "spacing", (double[]){10, 10, 10});
    H5Fclose(file);
}

/* Places of all values, some columns at a time, from the top down and by all threads: how many have another rock. */
static size_t wrong_values(const struct scene *scene)
{
    size_t wrong = 0;
    for (size_t k = 0; k < 511; k += 4)
#pragma omp parallel for reduction(+ : wrong) schedule(dynamic)
        for (size_t j = 0; j < 121; j += 3)
            for (size_t i = 0; i < 121; i += 3) {
                const bool is = there((size_t[]){i, j, k});
                const double place[3] = {10. * (double)i, 10. * (double)j, 10. * (double)k};
                const struct rock rock = ground_at(scene, place);
                wrong += fabs(rock.density / (is ? 2500 : 2000) - 1) > 1e-12 ||
                         fabs(rock.mu / (is ? 15.625e9 : 8e9) - 1) > 1e-12;
            }
    return wrong;
}

static void test_values(void **state)
{
    (void)state;
    double bytes[2];
    write_model();
    struct from_deck made =
        right_scene("&scene dimension = 3, end_time = 1 /\n"
                    "&body low = 0, 0, 0, high = 1200, 1200, 5100, spacing = 100 /\n"
                    "&load face = 'z-', shape = 'square', centre = 600, 600, depth = 0, size = 500, 500, "
                    "direction = 0, 0, 1, history = 'triangle', duration = 1 /\n"
                    "&model file = 'build/test/large-model' /\n");
    assert_int_equal(wrong_values(made.scene), 0);
    assert_true(ground_model_sound(made.scene->body.model));
    ground_model_bytes(made.scene->body.model, bytes);
    assert_true(bytes[0] == bytes[1] && bytes[1] == 24. * 121 * 121 * 511);
    from_deck_free(&made);
    unlink(stored);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_values)};
    return cmocka_run_group_tests(tests, NULL, NULL);
}
