/* Files of point sources: text and HDF5, right and wrong ones; a deck that names one. */
#include "scene/point_sources.h"

#include "from_deck.h"

#include <hdf5.h>
#include <unistd.h>

static void write_text(const char *path, const char *text)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    assert_true(fputs(text, file) >= 0);
    assert_int_equal(fclose(file), 0);
}

static const char path[] = "build/test/sources.txt", stored[] = "build/test/sources.h5";

static void text_is_read(void **state)
{
    (void)state;
    struct point_sources sources;
    struct messages messages = {0};
    write_text(
        path,
        "# places\n1 2 3  4 5 6 7 8 9\n\n-1,0,2 0 0 0 1 0 0  2.5e3 ! scaled\n0 0 1 1 1 1 0 0 0 3 .25\n");
    assert_int_equal(point_sources_read(path, 6, &sources, &messages), SELAS_OK);
    assert_int_equal(sources.count, 3);
    for (int i = 0; i < 3; i++)
        assert_near(sources.source[0].position[i], 1 + i, 0);
    for (int i = 0; i < 6; i++)
        assert_near(sources.source[0].value[i], 4 + i, 0);
    assert_near(sources.source[0].amplitude, 1, 0);
    assert_near(sources.source[1].amplitude, 2500, 0);
    assert_near(sources.source[2].start, .25, 0);
    point_sources_free(&sources);
    write_text(path, "1 2 3 4 5 6\n");
    assert_int_equal(point_sources_read(path, 3, &sources, &messages), SELAS_OK);
    assert_near(sources.source[0].value[2], 6, 0);
    assert_near(sources.source[0].value[3], 0, 0);
    point_sources_free(&sources);
}

static void wrong_text_is_refused(void **state)
{
    (void)state;
    static const struct {
        const char *text, *word;
    } wrong[] = {
        {"1 2 3 4 5 6 7 8\n", "sources.txt:1: expected 9 numbers"},
        {"1 2 3 4 5 6 7 8 9 1 0 3\n", "sources.txt:1: expected 9 numbers"},
        {"1 2 3 4 5 6 7 8 nine\n", "sources.txt:1: expected 9 numbers"},
        {"1 2 3 4 5 6 7 8 inf\n", "sources.txt:1: number 9 is not finite"},
        {"# x\n1 2 3 4 5 6 7 8 9 1 -2\n", "sources.txt:2: the start is -2"},
        {"# nothing\n", "holds no source"},
    };
    for (size_t i = 0; i < sizeof wrong / sizeof *wrong; i++) {
        struct point_sources sources;
        struct messages messages = {0};
        write_text(path, wrong[i].text);
        assert_int_equal(point_sources_read(path, 6, &sources, &messages), SELAS_FILE_ERROR);
        if (strstr(messages.text, wrong[i].word) == NULL) fail_msg("%s", messages.text);
        assert_null(sources.source);
        messages_free(&messages);
    }
    struct point_sources sources;
    struct messages messages = {0};
    assert_int_equal(point_sources_read("build/test/none.txt", 6, &sources, &messages), SELAS_FILE_ERROR);
    messages_free(&messages);
}

static void write_set(hid_t file, const char *name, hsize_t rows, hsize_t columns, const double *value)
{
    const hsize_t extent[2] = {rows, columns};
    const hid_t space = H5Screate_simple(columns > 1 ? 2 : 1, extent, NULL);
    const hid_t set = H5Dcreate2(file, name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) >= 0);
    H5Dclose(set);
    H5Sclose(space);
}

static void stored_sources_are_read(void **state)
{
    (void)state;
    static const double position[6] = {1, 2, 3, 4, 5, 6}, force[6] = {0, 0, 1, 2, 0, 0}, start[2] = {.5, 0};
    struct point_sources sources;
    struct messages messages = {0};
    hid_t file = H5Fcreate(stored, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    write_set(file, "position", 2, 3, position);
    write_set(file, "force", 2, 3, force);
    write_set(file, "start", 2, 1, start);
    H5Fclose(file);
    assert_int_equal(point_sources_read(stored, 3, &sources, &messages), SELAS_OK);
    assert_int_equal(sources.count, 2);
    assert_near(sources.source[1].position[1], 5, 0);
    assert_near(sources.source[1].value[0], 2, 0);
    assert_near(sources.source[0].start, .5, 0);
    assert_near(sources.source[1].amplitude, 1, 0);
    point_sources_free(&sources);
    assert_int_equal(point_sources_read(stored, 6, &sources, &messages),
                     SELAS_FILE_ERROR); /* no moments there */
    assert_non_null(strstr(messages.text, "moment [n, 6]"));
    messages_free(&messages);
    file = H5Fcreate(stored, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    write_set(file, "position", 2, 3, position);
    write_set(file, "force", 1, 3, force);
    H5Fclose(file);
    assert_int_equal(point_sources_read(stored, 3, &sources, &messages), SELAS_FILE_ERROR);
    messages_free(&messages);
    assert_int_equal(unlink(stored), 0);
}

#define GROUND                                                                                               \
    "&scene end_time=6 /\n&material name='rock', density=2, lambda=3, mu=5 /\n&body material='rock', "       \
    "low=0,0,0, "                                                                                            \
    "high=7,7,7, spacing=.5 /\n"

static void deck_makes_loads_of_them(void **state)
{
    (void)state;
    write_text(path, "1 2 3  0 3 4\n4 5 6  1 0 0 -2 .25\n");
    struct from_deck deck =
        right_scene(GROUND "&load kind='body-force', sources='build/test/sources.txt', amplitude=2, "
                           "history='gaussian', width=.3, delay=2, start=.5 /\n"
                           "&load kind='moment-tensor', centre=1,1,1, moment=1,0,0,0,0,0, "
                           "history='brune', width=.1 /\n");
    const struct scene *scene = deck.scene;
    assert_int_equal(scene->loads, 3);
    assert_near(scene->load[0].amplitude, 10, 1e-14);
    assert_near(scene->load[0].direction[1], .6, 1e-15);
    assert_near(scene->load[1].amplitude, -4, 0);
    assert_near(scene->load[1].history.start, .75, 0);
    assert_near(scene->load[0].history.start, .5, 0);
    assert_int_equal(scene->load[1].group, 0);
    assert_int_equal(scene->load[2].kind, LOAD_MOMENT_TENSOR);
    assert_int_equal(scene->load[2].group, 1);
    from_deck_free(&deck);
}

static void wrong_decks_are_refused(void **state)
{
    (void)state;
    static const char *const outside[] = {"source 2 of the file lies outside", NULL};
    static const char *const other[] = {"'centre' does not belong to a load with sources", NULL};
    static const char *const traction[] = {"expected kind = 'body-force' or 'moment-tensor'", NULL};
    static const char *const none[] = {"the sources cannot be used: cannot open", NULL};
    write_text(path, "1 2 3  0 3 4\n4 5 8  1 0 0\n");
    assert_refused(GROUND "&load kind='body-force', sources='build/test/sources.txt', history='step' /\n",
                   "t.nml:4:", outside);
    assert_refused(
        GROUND "&load kind='body-force', sources='build/test/sources.txt', centre=1,1,1, history='step' /\n",
        "t.nml:4:", other);
    assert_refused(GROUND "&load sources='build/test/sources.txt', history='step' /\n", "t.nml:4:", traction);
    assert_refused(GROUND "&load kind='body-force', sources='build/test/none', history='step' /\n",
                   "t.nml:4:", none);
    assert_int_equal(unlink(path), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(text_is_read),
        cmocka_unit_test(wrong_text_is_refused),
        cmocka_unit_test(stored_sources_are_read),
        cmocka_unit_test(deck_makes_loads_of_them),
        cmocka_unit_test(wrong_decks_are_refused),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
