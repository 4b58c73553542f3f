/* Heights from files that splines leave out (doc/theory/topography.md, section 1; regress/studies/blocks, `heights` and
 * `tops`). */
#include "advice/parts.h"

#include "scene/height_map.h"
#include "scene/topography.h"

#include <math.h>

static const double seen = .1;

/* What they leave out of a map in the body, and that in slowest waves at the source's cutoff. */
static double left_out(const struct scene *scene, const struct height_map *map, double *waves)
{
    const double left = height_map_smoothed_in(map, scene->body.low, scene->body.high);
    *waves = topography_levelled(scene, left);
    return left;
}

/* Velocities differ by up to 4 times the largest, in waves. */
static void look_at_surface(struct adviser *adviser)
{
    static const double law = 4;
    const struct topography *topography = adviser->scene->body.topography;
    double part;
    if (topography == NULL || topography->map == NULL) return;
    const double left = left_out(adviser->scene, topography->map, &part);
    if (!(law * part > seen)) return;
    advise(
        adviser,
        "the surface's splines, of pieces of two spacings, leave out up to %.3g of the heights, %.2g of the "
        "slowest wave's length at the source's cutoff: velocities may differ by up to about %.2g; a finer "
        "body%%spacing, or heights without parts as short, would be right",
        left, part, fmin(1, law * part));
}

/* What an interface sends back, in parts: of the rocks' S impedances. */
static double sent_back(const struct scene *scene, size_t layer)
{
    const struct body *body = &scene->body;
    const struct layer *own = &body->layer[layer], *above = layer > 0 ? own - 1 : NULL;
    const size_t upper = above == NULL ? body->material : above->graded ? above->bottom : above->material;
    const struct material *rock[2] = {&scene->material[upper], &scene->material[own->material]};
    const double one = sqrt(rock[0]->density * rock[0]->mu), other = sqrt(rock[1]->density * rock[1]->mu);
    return fabs(one - other) / (one + other);
}

static void look_at_interface(struct adviser *adviser, size_t layer)
{
    static const double law = 1.6;
    const struct height_map *map = adviser->scene->body.layer[layer].map;
    double part;
    if (map == NULL) return;
    const double left = left_out(adviser->scene, map, &part),
                 error = law * part * sent_back(adviser->scene, layer);
    if (!(error > seen)) return;
    advise(adviser,
           "the splines of the upper face of &layer %zu, of pieces of two spacings, leave out up to %.3g of "
           "its heights, "
           "%.2g of the slowest wave's length at the source's cutoff: velocities may differ by up to about "
           "%.2g; a finer body%%spacing, or heights without parts as short, would be right",
           layer + 1, left, part, fmin(1, error));
}

void look_at_smoothed(struct adviser *adviser)
{
    look_at_surface(adviser);
    for (size_t layer = 0; layer < adviser->scene->body.layers; layer++)
        look_at_interface(adviser, layer);
}
