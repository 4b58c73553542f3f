/* Points files in HDF5: sound files with data sets that are not what was asked for. */
#include "fuzz_cloud.h"
#include "fuzz_hdf5.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static const char *const name[] = {"position", "volume", "normal", "area"};
    struct fuzz_bytes bytes = {data, size};
    char path[FUZZ_PATH];
    H5Eset_auto2(H5E_DEFAULT, NULL, NULL);
    fuzz_file(data, 0, path);
    const int dimension = 1 + fuzz_byte(&bytes) % 3;
    const hid_t file = H5Fcreate(path, H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
    if (file < 0) abort();
    fuzz_work(file, sizeof name / sizeof *name, name, &bytes);
    H5Fclose(file);
    fuzz_cloud(dimension, path);
    unlink(path);
    return 0;
}
