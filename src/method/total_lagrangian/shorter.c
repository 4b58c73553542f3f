/* The same operator on a shorter body, on which its largest frequency is found: axes of many cells of a
 * lattice keep their ends and lose cells from the middle. Motions at ends, edges and corners lose nothing by
 * that; motions all over the body lose what the wavenumber that fits is away from the fastest, a part of the
 * order (pi / cells)^2 of the frequency, 7.9 / cells^2 at most (build/test/test_total_lagrangian_runs). */
#include "method/total_lagrangian/total_lagrangian.h"
#include "model/short_body.h"

#include "base/memory.h"

/* Longest axes by the number of dimensions; part of the frequency that may be missing, times their square:
 * twice the most that was found. */
static const size_t longest_axis[3] = {4096, 192, 64};
static const double missing = 16;

selas_status tl_shorten(const struct model *model, struct model **shorter, double *deficit,
                        struct messages *messages)
{
    const struct tl_model *tl = (const struct tl_model *)model;
    const size_t longest = longest_axis[tl->cloud->dimension - 1], *cells = tl->cloud->grid;
    struct scene *scene = NULL;
    size_t lost[3];
    *shorter = NULL;
    *deficit = missing / (double)(longest * longest);
    if (cells[0] == 0 || tl->options.form != NULL) return SELAS_OK;
    for (int axis = 0; axis < tl->cloud->dimension; axis++)
        lost[axis] = short_body_lost(model->scene, axis, cells[axis], longest);
    if (!short_body_pays(tl->cloud->dimension, cells, lost)) return SELAS_OK;
    selas_status status = short_body_scene(model->scene, &scene, messages);
    if (status != SELAS_OK) return status;
    struct body *body = &scene->body;
    for (int axis = 0; axis < tl->cloud->dimension; axis++) {
        const double all = (double)cells[axis], left = all - (double)lost[axis];
        body->high[axis] = body->low[axis] + (body->high[axis] - body->low[axis]) * left / all;
    }
    status = total_lagrangian_create(scene, &tl->options, shorter, messages);
    if (status == SELAS_OK)
        ((struct tl_model *)*shorter)->own_scene = scene;
    else
        array_free(scene);
    return status;
}
