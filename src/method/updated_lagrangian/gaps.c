/* Kernels do not see a gap that they reach across: its sides pull at each other. */
#include "method/updated_lagrangian/updated_lagrangian.h"

#include "base/memory.h"

#include <math.h>

static size_t point_of(const struct updated *updated, size_t site)
{
    const size_t points = updated->points;
    return site < points ? site : updated->ghost[site - points].source;
}

static double spacing_of(const void *of, size_t site)
{
    const struct updated *updated = of;
    return updated->length[point_of(updated, site)] * updated->cloud->spacing;
}

static bool reaches(const struct updated *updated, size_t i, size_t j)
{
    const double *a = updated->reference + 3 * i, *b = updated->reference + 3 * j;
    const double both = updated->length[i] + updated->length[point_of(updated, j)];
    return hypot(hypot(a[0] - b[0], a[1] - b[1]), a[2] - b[2]) < .5 * both * updated->reach * (1 - 1e-9);
}

/* Is one of a point's neighbours across a gap? site: room for all of them. */
static bool beside_gap(const struct updated *updated, size_t i, uint32_t *site)
{
    const struct neighbours *near = &updated->neighbours;
    size_t count = 1;
    site[0] = (uint32_t)i;
    for (size_t k = near->start[i]; k < near->start[i + 1]; k++)
        if (reaches(updated, i, near->index[k])) site[count++] = near->index[k];
    return points_connected(updated->reference, spacing_of, updated, i, count, site) < count;
}

selas_status updated_warn_of_gaps(const struct updated *updated, struct messages *messages)
{
    const struct body *body = &updated->model.scene->body;
    const size_t points = updated->points;
    double beside = 0, first = -INFINITY;
    if (body->shape != BODY_POINTS) return SELAS_OK;
    uint32_t *site = array_new(points + updated->ghosts, sizeof *site);
    selas_status status = SELAS_OK;
    if (site == NULL) status = fail(messages, SELAS_NO_MEMORY, "no memory for %zu particles", points);
    status = updated_agree(updated, status, messages);
    for (size_t i = updated->from; status == SELAS_OK && site != NULL && i < updated->from + updated->own;
         i++)
        if (beside_gap(updated, i, site) && beside++ == 0) first = -(double)i;
    array_free(site);
    if (status != SELAS_OK) return status;
    ranks_sum(updated->part.ranks, 1, &beside);
    ranks_largest(updated->part.ranks, 1, &first); /* all ranks have all points of a file */
    const double *x = updated->cloud->position + 3 * (beside > 0 ? (size_t)-first : 0);
    if (beside > 0)
        warn(messages,
             "kernels reach across a gap beside (%.6g, %.6g, %.6g), and %.0f more points: its sides pull at "
             "each "
             "other, and velocities may be several tenths wrong; finer points, or method%%variant = "
             "'total-lagrangian', which sees gaps, would be right",
             x[0], x[1], x[2], beside - 1);
    return SELAS_OK;
}
