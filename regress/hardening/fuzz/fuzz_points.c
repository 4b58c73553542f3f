/* Points files: the bytes as they are, in one, two and three dimensions. */
#include "fuzz_cloud.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    fuzz_file(data, size, path);
    for (int dimension = 1; dimension <= 3; dimension++)
        fuzz_cloud(dimension, path);
    unlink(path);
    return 0;
}
