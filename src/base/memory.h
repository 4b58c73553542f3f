/* Memory: zeroed arrays on cache-line (64 byte) boundaries, so that vector loads are aligned. */
#ifndef SELAS_MEMORY_H
#define SELAS_MEMORY_H

#include <stddef.h>

/* Zeroed array of count * size bytes, or NULL if there is no room, the product overflows or is
 * more than the memory of the machine (count 0 gives one
 * element). Free with array_free, which takes NULL. */
void *array_new(size_t count, size_t size);
/* The array, of which `count` elements count, with room for `room` of them, in its place where it can be: what is new
 * is not zeroed. NULL as array_new, and then the old one is freed. Takes NULL. */
void *array_resized(void *array, size_t count, size_t room, size_t size);
void array_free(void *array);

#endif
