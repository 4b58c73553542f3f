/* The same operator on a shorter body, on which its largest frequency is found: axes of many cells of a
 * lattice keep their ends and lose cells from the middle. Motions at ends, edges and corners lose nothing by
 * that; motions all over the body lose what the wavenumber that fits is away from the fastest, a part of the
 * order (pi / cells)^2 of the frequency (doc/sph-total-lagrangian.md, section 2, with what was measured). */
#include "method/total_lagrangian.h"

#include "base/memory.h"

/* Longest axes by the number of dimensions; part of the frequency that may be missing, times their square:
 * twice the most that was found. */
static const size_t longest_axis[3] = {4096, 192, 64};
static const double missing = 16;
enum { WORTH = 2 }; /* times as many points as the short body has are in the whole one */

/* Cells that an axis loses: none over depth where the ground varies. */
static size_t lost_cells(const struct tl_model *tl, int axis, size_t longest)
{
    const size_t cells = tl->cloud->grid[axis];
    if (axis == tl->cloud->dimension - 1 && tl->model.scene->body.layers > 0) return 0;
    return cells > longest ? cells - longest : 0;
}

/* A scene like the model's on a body from which cells are taken; nothing drives it. */
static void cut_scene(const struct tl_model *tl, size_t longest, struct scene *scene)
{
    struct body *body = &scene->body;
    *scene = *tl->model.scene;
    scene->loads = scene->receivers = scene->profiles = scene->snapshots = 0;
    scene->initial.kind = INITIAL_REST;
    for (int axis = 0; axis < tl->cloud->dimension; axis++) {
        const double cells = (double)tl->cloud->grid[axis];
        const double left = cells - (double)lost_cells(tl, axis, longest);
        body->high[axis] = body->low[axis] + (body->high[axis] - body->low[axis]) * left / cells;
    }
}

selas_status tl_shorten(const struct model *model, struct model **shorter, double *deficit,
                        struct messages *messages)
{
    const struct tl_model *tl = (const struct tl_model *)model;
    const size_t longest = longest_axis[tl->cloud->dimension - 1];
    double left = 1;
    *shorter = NULL;
    *deficit = missing / (double)(longest * longest);
    if (tl->cloud->grid[0] == 0) return SELAS_OK;
    for (int axis = 0; axis < tl->cloud->dimension; axis++)
        left *= 1 - (double)lost_cells(tl, axis, longest) / (double)tl->cloud->grid[axis];
    if (left * WORTH > 1) return SELAS_OK;
    struct scene *scene = array_new(1, sizeof *scene);
    if (scene == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory to measure the largest frequency");
    cut_scene(tl, longest, scene);
    const selas_status status = total_lagrangian_create(scene, &tl->options, shorter, messages);
    if (status == SELAS_OK)
        ((struct tl_model *)*shorter)->own_scene = scene;
    else
        array_free(scene);
    return status;
}
