/* Memory: zeroed arrays on cache-line (64 byte) boundaries, so that vector loads are aligned. */
#include "base/memory.h"

#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

enum { ALIGNMENT = 64, PLACE = sizeof(void *) };

/* Systems grant more than they have and end the program when it is used: an array that no machine of this
 * size holds is refused here. */
static bool beyond_machine(size_t bytes)
{
    if (bytes < (size_t)1 << 30) return false;
    const double memory = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
    return memory > 0 && (double)bytes > memory;
}

/* calloc() gives large arrays pages that are 0 and take memory once they are written to, by the thread that
 * does so first. Before the array stands the place that it was given. */
void *array_new(size_t count, size_t size)
{
    if (count == 0) count = 1;
    if (size != 0 && count > (SIZE_MAX / 2) / size) return NULL;
    if (beyond_machine(count * size)) return NULL;
    const size_t bytes = (count * size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT;
    unsigned char *given = calloc(1, bytes + ALIGNMENT + PLACE);
    if (given == NULL) return NULL;
    const size_t past = ((uintptr_t)given + PLACE) % ALIGNMENT;
    unsigned char *array = given + PLACE + (past == 0 ? 0 : ALIGNMENT - past);
    memcpy(array - PLACE, &given, PLACE);
    return array;
}

void *array_resized(void *array, size_t count, size_t room, size_t size)
{
    unsigned char *given = NULL;
    if (array == NULL) return array_new(room, size);
    memcpy(&given, (unsigned char *)array - PLACE, PLACE);
    const size_t before = (size_t)((unsigned char *)array - given);
    unsigned char *fresh = NULL;
    if (room <= (SIZE_MAX / 2) / size && !beyond_machine(room * size))
        fresh = realloc(given, (room * size + ALIGNMENT - 1) / ALIGNMENT * ALIGNMENT + ALIGNMENT + PLACE);
    if (fresh == NULL) {
        free(given);
        return NULL;
    }
    const size_t past = ((uintptr_t)fresh + PLACE) % ALIGNMENT;
    unsigned char *resized = fresh + PLACE + (past == 0 ? 0 : ALIGNMENT - past);
    if (resized != fresh + before) memmove(resized, fresh + before, (count < room ? count : room) * size);
    memcpy(resized - PLACE, &fresh, PLACE);
    return resized;
}

void array_free(void *array)
{
    unsigned char *given = NULL;
    if (array == NULL) return;
    memcpy(&given, (unsigned char *)array - PLACE, PLACE);
    free(given);
}
