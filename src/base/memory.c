/* Memory: zeroed arrays on cache-line (64 byte) boundaries, so that vector loads are aligned. */
#include "base/memory.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

enum { ALIGNMENT = 64 };

void *array_new(size_t count, size_t size)
{
    if (count == 0) count = 1;
    if (size != 0 && count > (SIZE_MAX / 2) / size) return NULL;
    const size_t bytes = (count * size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    void *array = aligned_alloc(ALIGNMENT, bytes);
    if (array != NULL) memset(array, 0, bytes);
    return array;
}

void array_free(void *array)
{
    free(array);
}
