/* Memory for FFTW's planner, tried before it asks (see the header). */
#include "base/fft_room.h"

#include <stdlib.h>

/* What a plan of FFTW_ESTIMATE keeps and takes on the way: tables of sines and buffers, a few complex numbers
 * for each of the transform's, and some kB besides. */
enum { BYTES_EACH = 64, BESIDES = 1 << 18 };

bool fft_room(size_t length)
{
    void *tried = malloc(BYTES_EACH * length + BESIDES);
    const bool room = tried != NULL;
    free(tried);
    return room;
}
