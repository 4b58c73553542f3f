/* Points of a file may have gaps between them: a crack, or several bodies. */
#include "points/neighbours.h"

#include <math.h>
#include <stdlib.h>

static int ascending(const void *one, const void *other)
{
    const uint32_t a = *(const uint32_t *)one, b = *(const uint32_t *)other;
    return (a > b) - (a < b);
}

static void swap(uint32_t *one, uint32_t *other)
{
    const uint32_t kept = *one;
    *one = *other;
    *other = kept;
}

static double apart(const double *position, size_t i, size_t j)
{
    double square = 0;
    for (size_t c = 0; c < 3; c++)
        square += (position[3 * i + c] - position[3 * j + c]) * (position[3 * i + c] - position[3 * j + c]);
    return sqrt(square);
}

size_t points_connected(const double *position, point_spacing *spacing, const void *of, size_t first,
                        size_t count, uint32_t *site)
{
    static const double step = 1.9; /* a point that is missing leaves 2 */
    size_t kept = 0;
    for (size_t k = 0; k < count && kept == 0; k++)
        if (site[k] == first) swap(&site[k], &site[kept++]);
    if (kept == 0) return count;
    for (size_t from = 0; from < kept; from++)
        for (size_t k = kept; k < count; k++)
            if (apart(position, site[from], site[k]) <
                step * fmax(spacing(of, site[from]), spacing(of, site[k])))
                swap(&site[k], &site[kept++]);
    qsort(site, kept, sizeof *site, ascending);
    return kept;
}
