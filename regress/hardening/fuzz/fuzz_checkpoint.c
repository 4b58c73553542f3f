/* Checkpoints. A first byte below 128: the bytes behind it are the file. Else: a right checkpoint whose data
 * sets are changed as the bytes say and which is sealed again, so that only what stands in it can tell. */
#include "fuzz_hdf5.h"

#include "record/checkpoint_head.h"
#include "record/kept.h"

static const char deck[] = "&scene dimension = 1, end_time = 4.0 /\n"
                           "&material name = 'm', density = 1.0, young = 1.0, poisson = 0.0 /\n"
                           "&body material = 'm', shape = 'box', low = 0.0, high = 4.0, spacing = 0.5 /\n"
                           "&boundary face = 'x+', kind = 'fixed' /\n"
                           "&load face = 'x-', shape = 'face', direction = 1.0, history = 'ricker',\n"
                           "  frequency = 0.5, delay = 2.0 /\n"
                           "&receiver name = 'r', position = 1.0 /\n"
                           "&profile name = 'p', from = 0.0, to = 4.0, points = 5, times = 1.0 /\n"
                           "&stepping time_step = 0.1 /\n";

static selas_simulation *opened(void)
{
    selas_simulation *simulation = NULL;
    if (selas_open_text("fuzz.nml", deck, &simulation) != SELAS_OK) abort();
    return simulation;
}

/* A right checkpoint of four steps, made once. */
static const uint8_t *right(size_t *size)
{
    static uint8_t *bytes;
    static size_t length;
    if (bytes == NULL) {
        char path[] = "/tmp/selas-fuzz-XXXXXX";
        const int file = mkstemp(path);
        selas_simulation *simulation = opened();
        if (file < 0 || selas_step(simulation, 4) != SELAS_OK || selas_save(simulation, path) != SELAS_OK)
            abort();
        selas_close(&simulation);
        FILE *made = fopen(path, "rb");
        bytes = malloc(1 << 20);
        if (made == NULL || bytes == NULL) abort();
        length = fread(bytes, 1, 1 << 20, made);
        fclose(made);
        close(file);
        unlink(path);
    }
    *size = length;
    return bytes;
}

static void change(const char *path, struct fuzz_bytes *bytes)
{
    static const char *const name[] = {"figures", "y",         "a",      "trace_1_u", "trace_1_v",
                                       "deck",    "trace_1_a", "source", "profile_1", "seen_1",
                                       "watch",   "before",    "name",   "due"};
    struct messages messages = {0};
    const hid_t file = H5Fopen(path, H5F_ACC_RDWR, H5P_DEFAULT);
    if (file < 0) abort();
    if (fuzz_byte(bytes) % 4 == 0) { /* one of the figures */
        double figures[12];
        const hid_t set = H5Dopen2(file, "figures", H5P_DEFAULT);
        if (H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, figures) < 0) abort();
        memcpy(figures + fuzz_byte(bytes) % 12, bytes->at, bytes->left < 8 ? bytes->left : 8);
        H5Dwrite(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, figures);
        H5Dclose(set);
    } else {
        fuzz_work(file, sizeof name / sizeof *name, name, bytes);
    }
    H5Fclose(file);
    if (checkpoint_seal(path, NULL, &messages) != SELAS_OK) abort();
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    struct fuzz_bytes bytes = {data, size};
    struct messages messages = {0};
    struct kept_deck kept;
    char path[FUZZ_PATH];
    size_t length = 0;
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    const uint8_t *made = right(&length);
    const bool raw = fuzz_byte(&bytes) < 128;
    fuzz_file(raw ? bytes.at : made, raw ? bytes.left : length, path);
    if (!raw) change(path, &bytes);
    fuzz_told(kept_deck_of_checkpoint(path, NULL, &kept, &messages), &messages);
    kept_deck_free(&kept);
    fuzz_told(kept_deck_of_run(path, &kept, &messages), &messages);
    kept_deck_free(&kept);
    selas_simulation *simulation = opened();
    const selas_status status = selas_restore(simulation, path);
    fuzz_require((status == SELAS_OK) == (selas_message(simulation)[0] == '\0'), "refused with a reason");
    if (status == SELAS_OK) fuzz_require(selas_step(simulation, 1) != SELAS_BAD_ARGUMENT, "it goes on");
    selas_close(&simulation);
    unlink(path);
    return 0;
}
