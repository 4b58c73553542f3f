/* HDF5 files from elsewhere: extents with nothing behind them and links out of the file end in a message,
 * before memory is taken; what lies in the file itself is read, compressed too. */
#include "base/crc64.h"
#include "base/memory.h"
#include "base/stored.h"
#include "box_scene.h"
#include "points/cloud.h"
#include "record/checkpoint_head.h"
#include "record/kept.h"
#include "record/run_file.h"
#include "record/sets.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <unistd.h>

static char folder[] = "/tmp/selas-stored-XXXXXX";
static char path[64], other[64], said[600];

enum how { PLAIN, CHUNKED, DEFLATED, RAW_FILE, VIRTUAL, STRANGE };
enum { STRANGE_FILTER = 400 }; /* of those that HDF5 leaves to tests */

/* A data set of rows x columns; the first `filled` rows are all `value`. */
static void put(hid_t file, const char *name, hsize_t rows, hsize_t columns, enum how how, hsize_t filled,
                double value)
{
    const hsize_t extent[2] = {rows, columns}, chunk[2] = {filled > 0 ? filled : 4, columns};
    const hid_t creation = H5Pcreate(H5P_DATASET_CREATE), space = H5Screate_simple(2, extent, NULL);
    if (how == CHUNKED || how == DEFLATED || how == STRANGE) H5Pset_chunk(creation, 2, chunk);
    if (how == DEFLATED) H5Pset_deflate(creation, 6);
    if (how == STRANGE) H5Pset_filter(creation, STRANGE_FILTER, H5Z_FLAG_MANDATORY, 0, NULL);
    if (how == RAW_FILE) H5Pset_external(creation, "/dev/zero", 0, H5F_UNLIMITED);
    if (how == VIRTUAL) H5Pset_virtual(creation, space, other, name, space);
    const hid_t set = H5Dcreate2(file, name, H5T_NATIVE_DOUBLE, space, H5P_DEFAULT, creation, H5P_DEFAULT);
    assert_true(set >= 0);
    if (filled > 0) {
        const hsize_t start[2] = {0, 0}, size[2] = {filled, columns};
        double *values = array_new((size_t)(filled * columns), sizeof *values);
        assert_non_null(values);
        for (size_t i = 0; i < (size_t)(filled * columns); i++)
            values[i] = value + (strcmp(name, "position") == 0 && i % 3 == 0 ? .1 * (double)(i / 3) : 0);
        const hid_t here = H5Screate_simple(2, size, NULL);
        H5Sselect_hyperslab(space, H5S_SELECT_SET, start, NULL, size, NULL);
        const bool written = H5Dwrite(set, H5T_NATIVE_DOUBLE, here, space, H5P_DEFAULT, values) >= 0;
        assert_true(written || rows > (hsize_t)1 << 50); /* HDF5 itself has its bounds */
        H5Sclose(here);
        array_free(values);
    }
    H5Dclose(set);
    H5Sclose(space);
    H5Pclose(creation);
}

static hid_t new_file(const char *name)
{
    const hid_t file = H5Fcreate(name, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(file >= 0);
    return file;
}

/* Largest memory so far, bytes. */
static double memory_used(void)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    return 1024.0 * (double)usage.ru_maxrss;
}

/* Reads the points file; the number of points, 0 if it is refused (with a message, and no memory taken). */
static size_t points_read(void)
{
    struct box_scene box;
    struct messages messages = {0};
    struct cloud *cloud = NULL;
    make_box(&box, 3, 1, .1);
    box.scene.body.high[0] = 1e5; /* holds all of them */
    box.scene.body.shape = BODY_POINTS;
    box.scene.body.file = path;
    const double before = memory_used();
    const selas_status status = cloud_create(&box.scene, &cloud, &messages);
    const size_t points = cloud != NULL ? cloud->points : 0;
    snprintf(said, sizeof said, "%s", messages.text != NULL ? messages.text : "");
    if (status != SELAS_OK) {
        assert_non_null(messages.text);
        assert_non_null(strstr(messages.text, path));
        assert_null(cloud);
        assert_true(memory_used() - before < 64e6);
    }
    cloud_free(&cloud);
    messages_free(&messages);
    return points;
}

static size_t points_of(hsize_t rows, enum how how, hsize_t filled)
{
    const hid_t file = new_file(path);
    put(file, "position", rows, 3, how, how == VIRTUAL || how == RAW_FILE ? 0 : filled, .5);
    put(file, "volume", rows, 1, how == DEFLATED ? DEFLATED : CHUNKED, filled, .1);
    H5Fclose(file);
    return points_read();
}

static void what_lies_in_the_file_is_read(void **state)
{
    (void)state;
    assert_int_equal(points_of(20, PLAIN, 20), 20);
    assert_int_equal(points_of(20, CHUNKED, 20), 20);
    assert_int_equal(points_of(100000, DEFLATED, 100000), 100000); /* alike: compressed as far as it goes */
}

static size_t unchanged(unsigned flags, size_t settings, const unsigned setting[], size_t bytes, size_t *room,
                        void **buffer)
{
    (void)flags, (void)settings, (void)setting, (void)room, (void)buffer;
    return bytes;
}

static void filters_that_are_not_there_are_named(void **state)
{
    (void)state;
    const H5Z_class2_t strange = {H5Z_CLASS_T_VERS, STRANGE_FILTER, 1, 1, "strange", NULL, NULL, unchanged};
    const hid_t file = new_file(path);
    assert_true(H5Zregister(&strange) >= 0);
    put(file, "position", 20, 3, STRANGE, 20, .5);
    put(file, "volume", 20, 1, PLAIN, 20, .1);
    H5Fclose(file);
    assert_int_equal(points_read(), 20);
    assert_true(H5Zunregister(STRANGE_FILTER) >= 0);
    assert_int_equal(points_read(), 0);
    assert_non_null(strstr(said, "'position' is compressed by 'strange' (filter 400)"));
}

static void huge_extents_are_refused(void **state)
{
    (void)state;
    assert_int_equal(points_of((hsize_t)1000000000000, CHUNKED, 4), 0);
    assert_int_equal(points_of((hsize_t)1 << 61, CHUNKED, 4), 0); /* bytes beyond 64 bits */
    assert_int_equal(points_of((hsize_t)1 << 62, DEFLATED, 4), 0);
    assert_int_equal(points_of(100000000, CHUNKED, 0), 0);
}

static void numbers_elsewhere_are_refused(void **state)
{
    (void)state;
    const hid_t there = new_file(other);
    put(there, "position", 20, 3, PLAIN, 20, .5);
    put(there, "volume", 20, 1, PLAIN, 20, .1);
    H5Fclose(there);
    assert_int_equal(points_of(20, RAW_FILE, 20), 0);
    assert_int_equal(points_of(20, VIRTUAL, 20), 0);
    for (int soft = 0; soft < 2; soft++) {
        const hid_t file = new_file(path);
        put(file, "volume", 20, 1, PLAIN, 20, .1);
        put(file, "hidden", 20, 3, PLAIN, 20, .5);
        if (soft)
            H5Lcreate_soft("/hidden", file, "position", H5P_DEFAULT, H5P_DEFAULT);
        else
            H5Lcreate_external(other, "/position", file, "position", H5P_DEFAULT, H5P_DEFAULT);
        H5Fclose(file);
        assert_int_equal(points_read(), 0);
    }
}

static void put_text(hid_t file, const char *name)
{
    char text[] = "text";
    const hid_t set = set_open(file, name, H5T_NATIVE_CHAR, sizeof text, SET_WRITE);
    assert_true(set >= 0 && set_pass(set, H5T_NATIVE_CHAR, SET_WRITE, text, 0, sizeof text));
    H5Dclose(set);
}

/* A deck kept in a checkpoint or run.h5 must be its own. */
static void decks_elsewhere_are_refused(void **state)
{
    (void)state;
    static const char *const name[3] = {"deck", "source", "name"};
    static const char *const of_run[3] = {"deck_echo", "deck", "deck_name"};
    const hid_t there = new_file(other);
    for (int k = 0; k < 3; k++)
        put_text(there, name[k]);
    const hid_t group = hdf_group(there, "provenance");
    for (int k = 0; k < 3; k++)
        assert_true(hdf_text(group, of_run[k], "text"));
    H5Gclose(group);
    H5Fclose(there);
    for (int linked = 0; linked < 2; linked++) {
        struct messages messages = {0};
        struct kept_deck kept;
        const hid_t file = hdf_create_file(path, CHECKPOINT_HEAD);
        for (int k = 0; k < 3; k++)
            if (linked)
                H5Lcreate_external(other, name[k], file, name[k], H5P_DEFAULT, H5P_DEFAULT);
            else
                put_text(file, name[k]);
        if (linked) H5Lcreate_external(other, "provenance", file, "provenance", H5P_DEFAULT, H5P_DEFAULT);
        H5Fclose(file);
        assert_int_equal(checkpoint_seal(path, NULL, &messages), SELAS_OK);
        assert_int_equal(kept_deck_of_checkpoint(path, NULL, &kept, &messages),
                         linked ? SELAS_FILE_ERROR : SELAS_OK);
        kept_deck_free(&kept);
        assert_int_equal(kept_deck_of_run(linked ? path : other, &kept, &messages),
                         linked ? SELAS_FILE_ERROR : SELAS_OK);
        kept_deck_free(&kept);
        messages_free(&messages);
    }
}

/* More than the machine has is refused, not granted and then taken away. */
static void arrays_beyond_the_machine(void **state)
{
    (void)state;
    const size_t memory = (size_t)sysconf(_SC_PHYS_PAGES) * (size_t)sysconf(_SC_PAGESIZE);
    assert_null(array_new(memory / 8 + 1000, 8));
    assert_null(array_new(SIZE_MAX / 2, 3));
    void *some = array_new(1000, 8);
    assert_non_null(some);
    array_free(some);
}

/* The checksum of a file from those of its pieces, wherever it is cut, in any order. */
static void checksums_of_pieces_join(void **unused)
{
    (void)unused;
    enum { SIZE = 70001 };
    static const size_t cut[] = {0, 1, 7, 8, 4096, 65537, SIZE};
    static char text[SIZE];
    struct crc64_table table;
    crc64_prepare(&table);
    assert_true(crc64_add(&table, 0, "123456789", 9) == UINT64_C(0x995DC9BBDF1939FA));
    for (size_t i = 0; i < SIZE; i++)
        text[i] = (char)(i * i / 7 + i);
    const uint64_t whole = crc64_add(&table, 0, text, SIZE);
    uint64_t sum = 0;
    for (size_t k = 0; k < sizeof cut / sizeof *cut; k++) {
        const uint64_t head = crc64_add(&table, 0, text, cut[k]);
        const uint64_t rest = crc64_add(&table, 0, text + cut[k], SIZE - cut[k]);
        assert_true(crc64_join(head, rest, SIZE - cut[k]) == whole);
    }
    for (size_t k = sizeof cut / sizeof *cut - 1; k > 0; k--) {
        const uint64_t part = crc64_add(&table, 0, text + cut[k - 1], cut[k] - cut[k - 1]);
        sum ^= crc64_join(part, 0, SIZE - cut[k]);
    }
    assert_true(sum == whole);
    assert_true(crc64_join(whole, 0, (uint64_t)1 << 40) != whole);
}

static int make_folder_of_files(void **state)
{
    (void)state;
    if (mkdtemp(folder) == NULL) return 1;
    snprintf(path, sizeof path, "%s/file.h5", folder);
    snprintf(other, sizeof other, "%s/other.h5", folder);
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    return 0;
}

static int remove_files(void **state)
{
    (void)state;
    unlink(path);
    unlink(other);
    return rmdir(folder);
}

/* Behind a user block, as MATLAB writes, too. */
static void test_user_block(void **state)
{
    (void)state;
    for (hsize_t block = 0; block <= 4096; block = block > 0 ? 2 * block : 512) {
        const hid_t creation = H5Pcreate(H5P_FILE_CREATE);
        H5Pset_userblock(creation, block);
        H5Fclose(H5Fcreate(path, H5F_ACC_TRUNC, creation, H5P_DEFAULT));
        H5Pclose(creation);
        assert_true(stored_is_hdf5(path));
    }
    FILE *file = fopen(path, "w");
    for (int i = 0; i < 300; i++)
        fputs("1 2 3 4\n", file);
    fclose(file);
    assert_false(stored_is_hdf5(path));
    assert_false(stored_is_hdf5("/tmp"));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_user_block),
        cmocka_unit_test(what_lies_in_the_file_is_read),
        cmocka_unit_test(filters_that_are_not_there_are_named),
        cmocka_unit_test(huge_extents_are_refused),
        cmocka_unit_test(numbers_elsewhere_are_refused),
        cmocka_unit_test(decks_elsewhere_are_refused),
        cmocka_unit_test(arrays_beyond_the_machine),
        cmocka_unit_test(checksums_of_pieces_join),
    };
    return cmocka_run_group_tests(tests, make_folder_of_files, remove_files);
}
