/* Corners where three free faces meet: the points of the three families see nothing of one motion of each
 * component there (doc/theory/general-ground.md, section 2). One more point on each corner, of the weight that it has
 * in Simpson's rule, sees them. */
#include "method/consistent/general/general.h"

static const double simpson = 1. / 216;

/* Control values that the point sees: on the corner, and the next one along each axis. */
static size_t seen(const struct consistent *c, const struct corner *corner, int slot, int next)
{
    const size_t stride[3] = {1, c->n[0], c->plane};
    size_t index = 0;
    for (int s = 0; s < 3; s++) {
        const bool further = s == slot && next == 1;
        index += stride[s] * (corner->high[s] ? c->n[s] - 1 - further : further);
    }
    return index;
}

static bool free_corner(const struct consistent *c, unsigned number, struct corner *corner)
{
    for (int slot = 0; slot < 3; slot++) {
        corner->high[slot] = (number >> slot & 1U) != 0;
        if (c->layout[slot]->mirror[corner->high[slot]]) return false;
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
            const double spacing = (c->layout[slot]->high - c->layout[slot]->low) / (double)g->cells[slot];
            weight *= spacing;
            corner.slope[slot] = (corner.high[slot] ? -2 : 2) / spacing;
            place[slot] = corner.high[slot] ? c->layout[slot]->high : c->layout[slot]->low;
        }
        corner.metric = consistent_metric(c, place); /* slots are axes in three dimensions */
        weight *= corner.metric.jacobian;
        corner.lambda = weight * material->plane_lambda;
        corner.mu = weight * material->mu;
        g->corner[g->corners++] = corner;
    }
}

void general_corners(const struct consistent *c, const double *u, double *force)
{
    for (size_t n = 0; n < c->general->corners; n++) {
        const struct corner *corner = &c->general->corner[n];
        const struct metric *metric = &corner->metric;
        double slope[3][3], pressure = 0;
        for (int component = 0; component < 3; component++)
            for (int slot = 0; slot < 3; slot++) {
                const double *field = u + (size_t)component * c->volume;
                slope[component][slot] =
                    corner->slope[slot] * (field[seen(c, corner, slot, 1)] - field[seen(c, corner, slot, 0)]);
            }
        for (int component = 0; component < 3; component++)
            metric_tilt(metric, slope[component]);
        for (int i = 0; i < 3; i++)
            pressure += corner->lambda * slope[i][i];
        for (int component = 0; component < 3; component++) {
            double *field = force + (size_t)component * c->volume, stress[3];
            for (int slot = 0; slot < 3; slot++)
                stress[slot] = corner->mu * (slope[component][slot] + slope[slot][component]) +
                               (component == slot ? pressure : 0);
            stress[DEPTH] = metric_pull(metric, stress);
            for (int slot = 0; slot < 3; slot++) {
                field[seen(c, corner, slot, 1)] -= corner->slope[slot] * stress[slot];
                field[seen(c, corner, slot, 0)] += corner->slope[slot] * stress[slot];
            }
        }
    }
}
