/* Points of a file may have gaps between them: a crack, or several bodies. Points across one are no neighbours, though
 * they lie within the reach of gradients, four spacings at faces. */
#include "method/total_lagrangian/setup.h"

#include <stdlib.h>

bool tl_has_gaps(const struct tl_model *tl)
{
    return tl->model.scene->body.shape == BODY_POINTS && tl->options.form == NULL;
}

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

size_t tl_connected(const struct tl_model *tl, size_t first, size_t count, uint32_t *site)
{
    static const double step = 1.9; /* a point that is missing leaves 2 */
    size_t kept = 0;
    for (size_t k = 0; k < count && kept == 0; k++)
        if (site[k] == first) swap(&site[k], &site[kept++]);
    if (kept == 0) return count;
    for (size_t from = 0; from < kept; from++)
        for (size_t k = kept; k < count; k++) {
            const double one = tl->spacing[tl_source(tl, site[from])],
                         other = tl->spacing[tl_source(tl, site[k])];
            if (tl_distance(tl->site_position + 3 * (size_t)site[from],
                            tl->site_position + 3 * (size_t)site[k]) < step * (one > other ? one : other))
                swap(&site[k], &site[kept++]);
        }
    qsort(site, kept, sizeof *site, ascending);
    return kept;
}
