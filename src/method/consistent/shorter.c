/* The same operator on a shorter body, on which its largest frequency is found: axes of many equal cells keep
 * their ends and their spacing and lose cells from the middle (doc/theory/stepping.md, "The time step"; what was
 * measured: table 5 of doc/verification/tables/consistent.txt).
 *
 * Windows w_s over the control values of an axis with sum w_s^2 = 1 take any vector of the long body apart
 * into vectors that the short body has too,
 *
 *   u.Ku = sum (w_s u).K(w_s u) + 1/2 sum over i, j of u_i K_ij u_j sum over s of (w_s(i) - w_s(j))^2, (T8)
 *
 * and likewise u.Mu. The last sum is of order (pi / cells)^2: by so much of itself the long body's frequency
 * may be above the short one's, 3.6 / cells^2 at most with the exact mass and 2.1 / cells^2 with sweeps. */
#include "method/consistent/consistent.h"
#include "model/short_body.h"

#include "base/memory.h"

/* Longest axes by the number of dimensions; what (T8) adds to the frequency, times their square, for a mass
 * of sweeps and the exact one. */
static const size_t longest_axis[3] = {4096, 192, 40};
static const double sweeps_deficit = 2.5, exact_deficit = 6;

/* Cells that each axis has and loses: none between mapped ends, whose spacing varies with the length. */
struct cells {
    size_t all[3], lost[3];
};

static struct cells cells_of(const struct consistent *c, size_t longest)
{
    struct cells cells = {{0}, {0}};
    for (int axis = 0; axis < c->dimension; axis++) {
        cells.all[axis] = c->spline[axis]->cells;
        if (!c->options.mapped)
            cells.lost[axis] = short_body_lost(c->model.scene, axis, cells.all[axis], longest);
    }
    return cells;
}

/* Layers are lattice like the body, held at their outer ends; the deck's own rules for them are not asked
 * again.
 */
static void cut_boundary(const struct consistent *c, int face, bool shorter, struct boundary *boundary)
{
    if (!boundary_has_layer(boundary)) return;
    boundary->always = true;
    boundary->layer_points = (long)c->layer[face];
    if (c->layer[face] == 0)
        boundary->kind = BOUNDARY_FREE;
    else if (shorter)
        boundary->kind = BOUNDARY_FIXED;
}

/* Takes cells from the body of a scene like the model's. */
static void cut_body(const struct consistent *c, size_t longest, struct scene *scene)
{
    struct body *body = &scene->body;
    const struct cells cells = cells_of(c, longest);
    for (int axis = 0; axis < c->dimension; axis++) {
        const struct spline *spline = c->spline[axis];
        const size_t lost = cells.lost[axis];
        const double spacing = (spline->high - spline->low) / (double)spline->cells;
        for (int face = 2 * axis; face < 2 * axis + 2; face++)
            cut_boundary(c, face, lost > 0, &scene->boundary[face]);
        if (lost > 0) body->high[axis] = body->low[axis] + (double)(spline->cells - lost) * spacing;
    }
}

selas_status consistent_cut(const struct consistent *c, size_t longest, struct model **cut,
                            struct messages *messages)
{
    struct consistent_options options = c->options;
    struct scene *scene = NULL;
    *cut = NULL;
    selas_status status = short_body_scene(c->model.scene, &scene, messages);
    if (status != SELAS_OK) return status;
    cut_body(c, longest, scene);
    options.single = false;
    status = consistent_create_with(scene, &options, cut, messages);
    if (status == SELAS_OK)
        consistent_of(*cut)->own_scene = scene;
    else
        array_free(scene);
    return status;
}

double consistent_deficit(const struct consistent *c, size_t longest)
{
    return (c->options.sweeps > 0 ? sweeps_deficit : exact_deficit) / (double)(longest * longest);
}

selas_status consistent_shorten(const struct model *model, struct model **shorter, double *deficit,
                                struct messages *messages)
{
    const struct consistent *c = (const struct consistent *)model;
    const size_t longest = longest_axis[c->dimension - 1];
    const struct cells cells = cells_of(c, longest);
    *shorter = NULL;
    *deficit = consistent_deficit(c, longest);
    if (!short_body_pays(c->dimension, cells.all, cells.lost)) {
        *deficit = 0;
        return SELAS_OK;
    }
    return consistent_cut(c, longest, shorter, messages);
}
