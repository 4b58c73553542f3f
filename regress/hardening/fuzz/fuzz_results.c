/* Results read again: the deck that run.h5 keeps (`selas rerun`), and a folder of histories (`selas diff`). A
 * first byte below 64: the bytes behind it are run.h5; below 192: a right one whose groups, data sets and
 * attributes are changed as the bytes say; else they are two folders' histories, divided at a byte 0. */
#include "fuzz_hdf5.h"

#include "compare/diff.h"
#include "host/simulation.h"
#include "record/kept.h"

#include <math.h>
#include <sys/stat.h>

static const char deck[] = "&scene dimension = 1, end_time = 1.0 /\n"
                           "&material name = 'm', density = 1.0, young = 1.0, poisson = 0.0 /\n"
                           "&body material = 'm', shape = 'box', low = 0.0, high = 4.0, spacing = 0.5 /\n";

static void put_text(hid_t place, const char *name, const char *text, size_t size, bool attribute)
{
    const hid_t type = H5Tcopy(H5T_C_S1), space = H5Screate(H5S_SCALAR);
    if (size == 0) text = "";
    H5Tset_size(type, size > 0 ? size : 1);
    const hid_t made = attribute
                           ? H5Acreate2(place, name, type, space, H5P_DEFAULT, H5P_DEFAULT)
                           : H5Dcreate2(place, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    if (made >= 0 && attribute) {
        H5Awrite(made, type, text);
        H5Aclose(made);
    } else if (made >= 0) {
        H5Dwrite(made, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text);
        H5Dclose(made);
    }
    H5Sclose(space);
    H5Tclose(type);
}

/* An attribute of any type and extent in place of a text. */
static void put_attribute(hid_t place, const char *name, struct fuzz_bytes *bytes)
{
    const hsize_t extent[1] = {1 + fuzz_byte(bytes) % 64};
    const uint8_t how = fuzz_byte(bytes);
    const hid_t type = how & 1 ? H5Tcopy(H5T_C_S1) : H5Tcopy(fuzz_type(fuzz_byte(bytes)));
    if (how & 1) H5Tset_size(type, how & 2 ? H5T_VARIABLE : 1 + fuzz_extent(bytes));
    const hid_t space =
        how & 4 ? H5Screate_simple(1, extent, NULL) : H5Screate(how & 8 ? H5S_NULL : H5S_SCALAR);
    H5Adelete(place, name);
    const hid_t made = H5Acreate2(place, name, type, space, H5P_DEFAULT, H5P_DEFAULT);
    if (made >= 0) H5Aclose(made);
    H5Sclose(space);
    H5Tclose(type);
}

static void make_run(const char *path, struct fuzz_bytes *bytes)
{
    static const char *const name[] = {"deck_echo", "deck", "deck_name", "provenance"};
    enum { NAMES = sizeof name / sizeof *name };
    const hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    if (file < 0) abort();
    const hid_t place = H5Gcreate2(file, "provenance", H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT);
    const uint8_t how = fuzz_byte(bytes);
    put_text(place, "deck_echo", deck, sizeof deck, how & 1);
    put_text(place, "deck", deck, sizeof deck, how & 2);
    put_text(place, "deck_name", "fuzz", 5, how & 4);
    if (how & 8) { /* the deck's name or text are the bytes */
        const char *one = name[fuzz_byte(bytes) % 3];
        H5Adelete(place, one);
        H5Ldelete(place, one, H5P_DEFAULT);
        put_text(place, one, (const char *)bytes->at, bytes->left, how & 16);
    } else if (how & 32) {
        put_attribute(place, name[fuzz_byte(bytes) % 3], bytes);
    } else {
        fuzz_work(how & 64 ? file : place, NAMES, name, bytes);
    }
    if (place >= 0) H5Gclose(place);
    H5Fclose(file);
}

static void rerun(const char *path)
{
    struct messages messages = {0};
    struct kept_deck kept;
    fuzz_told(kept_deck_of_run(path, &kept, &messages), &messages);
    kept_deck_free(&kept);
    selas_simulation *simulation = NULL;
    const selas_status status = simulation_open_run(path, 0, NULL, &simulation);
    fuzz_require(status == SELAS_OK || selas_message(simulation)[0] != '\0', "refused with a reason");
    selas_close(&simulation);
}

/* Numbers that are not finite differ from themselves. */
static bool all_finite(const char *path)
{
    struct messages messages = {0};
    struct history_file history;
    bool all = true;
    const selas_status status = history_file_read(path, &history, &messages);
    for (size_t i = 0; status == SELAS_OK && i < DIFF_CHANNELS * history.rows; i++)
        all = all && isfinite(history.value[i]);
    if (status == SELAS_OK) history_file_free(&history);
    messages_free(&messages);
    return all;
}

static void compare(const struct fuzz_bytes *bytes)
{
    const uint8_t *cut = bytes->left > 0 ? memchr(bytes->at, 0, bytes->left) : NULL;
    const size_t first = cut != NULL ? (size_t)(cut - bytes->at) : bytes->left;
    char folder[2][FUZZ_PATH], path[2][FUZZ_PATH + 8];
    for (int k = 0; k < 2; k++) {
        snprintf(folder[k], FUZZ_PATH, "%s/selas-fuzz-XXXXXX",
                 access("/dev/shm", W_OK) == 0 ? "/dev/shm" : "/tmp");
        if (mkdtemp(folder[k]) == NULL) abort();
        snprintf(path[k], sizeof path[k], "%s/r.dat", folder[k]);
        FILE *file = fopen(path[k], "wb");
        if (file == NULL) abort();
        if (k == 0 && first > 0) fwrite(bytes->at, 1, first, file);
        if (k == 1 && cut != NULL) fwrite(cut + 1, 1, bytes->left - first - 1, file);
        if (k == 1 && cut == NULL && first > 0) fwrite(bytes->at, 1, first, file);
        fclose(file);
    }
    struct messages messages = {0};
    struct diff_report report = {0};
    const selas_status status = diff_paths(folder[0], folder[1], NULL, &report, &messages);
    fuzz_require(status != SELAS_OK || cut != NULL || report.differences == 0 || !all_finite(path[0]),
                 "a history is like itself");
    fuzz_told(status, &messages);
    for (int k = 0; k < 2; k++) {
        unlink(path[k]);
        rmdir(folder[k]);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_bytes bytes = {data, size};
    char path[FUZZ_PATH];
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    const uint8_t way = fuzz_byte(&bytes);
    if (way >= 192) {
        compare(&bytes);
        return 0;
    }
    fuzz_file(bytes.at, way < 64 ? bytes.left : 0, path);
    if (way >= 64) make_run(path, &bytes);
    rerun(path);
    unlink(path);
    return 0;
}
