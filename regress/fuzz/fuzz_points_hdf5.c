/* Points files in HDF5: sound files with data sets that are not what was asked for. */
#include "fuzz_hdf5.h"

#include "points/cloud.h"

#include <math.h>

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
    struct messages messages = {0};
    struct scene scene = {.dimension = dimension};
    struct cloud *cloud = NULL;
    scene.body = (struct body){.shape = BODY_POINTS, .high = {1, 1, 1}, .spacing = 0.1, .file = path};
    const selas_status status = cloud_read(&scene, &cloud, &messages);
    fuzz_told(status, &messages);
    for (size_t i = 0; cloud != NULL && i < cloud->points; i++)
        fuzz_require(isfinite(cloud->position[3 * i]) && cloud->volume[i] > 0, "points make sense");
    cloud_free(&cloud);
    unlink(path);
    return 0;
}
