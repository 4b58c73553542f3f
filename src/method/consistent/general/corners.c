/* Corners where three free faces meet: the points of the three families see nothing of one motion of each
 * component there (doc/theory/general-ground.md, section 2). One more point on each corner, of the weight that it has
 * in Simpson's rule, sees them. */
#include "method/consistent/general/general.h"

static const double simpson = 1. / 216;

size_t general_corner_seen(const struct consistent *c, const struct corner *corner, int slot, int next)
{
    const size_t stride[3] = {1, c->n[0], c->plane};
    size_t index = 0;
    for (int s = 0; s < 3; s++) {
        const bool further = s == slot && next == 1;
        index += stride[s] * (corner->high[s] ? c->n[s] - 1 - further : further);
    }
    return index;
}

/* A corner that the window has, slots being axes in three dimensions. */
static bool free_corner(const struct consistent *c, unsigned number, struct corner *corner)
{
    for (int slot = 0; slot < 3; slot++) {
        corner->high[slot] = (number >> slot & 1U) != 0;
        if (c->layout[slot]->mirror[corner->high[slot]]) return false;
        if (part_face(c, 2 * slot + corner->high[slot]) == SIZE_MAX) return false;
    }
    return true;
}

void general_lay_corners(struct consistent *c)
{
    struct general *g = c->general;
    const struct material *material = &c->model.scene->material[c->model.scene->body.material];
    for (unsigned number = 0; c->dimension == 3 && number < 8; number++) {
        struct corner corner;
        if (!free_corner(c, number, &corner)) continue;
        double weight = simpson, place[3] = {0};
        for (int slot = 0; slot < 3; slot++) {
            const struct spline *spline = c->layout[slot];
            const double spacing = (spline->high - spline->low) / (double)spline->cells;
            weight *= spacing;
            corner.slope[slot] = (corner.high[slot] ? -2 : 2) / spacing;
            place[slot] = corner.high[slot] ? c->layout[slot]->high : c->layout[slot]->low;
        }
        corner.metric = consistent_metric(c, place);
        weight *= corner.metric.jacobian;
        corner.lambda = weight * material->plane_lambda;
        corner.mu = weight * material->mu;
        g->corner[g->corners++] = corner;
    }
}

void general_corner_pull(const struct corner *corner, double slope[3][3], int component, double pull[3])
{
    double pressure = 0;
    for (int i = 0; i < 3; i++)
        metric_tilt(&corner->metric, slope[i]);
    for (int i = 0; i < 3; i++)
        pressure += corner->lambda * slope[i][i];
    for (int slot = 0; slot < 3; slot++)
        pull[slot] = corner->mu * (slope[component][slot] + slope[slot][component]) +
                     (component == slot ? pressure : 0);
    pull[DEPTH] = metric_pull(&corner->metric, pull);
    for (int slot = 0; slot < 3; slot++)
        pull[slot] *= corner->slope[slot];
}

void general_corners(const struct consistent *c, const double *u, double *force)
{
    for (size_t n = 0; n < c->general->corners; n++) {
        const struct corner *corner = &c->general->corner[n];
        for (int component = 0; component < 3; component++) {
            double *field = force + (size_t)component * c->volume, slope[3][3], pull[3];
            for (int of = 0; of < 3; of++)
                for (int slot = 0; slot < 3; slot++) {
                    const double *at = u + (size_t)of * c->volume;
                    slope[of][slot] = corner->slope[slot] * (at[general_corner_seen(c, corner, slot, 1)] -
                                                             at[general_corner_seen(c, corner, slot, 0)]);
                }
            general_corner_pull(corner, slope, component, pull);
            for (int slot = 0; slot < 3; slot++) {
                field[general_corner_seen(c, corner, slot, 1)] -= pull[slot];
                field[general_corner_seen(c, corner, slot, 0)] += pull[slot];
            }
        }
    }
}
