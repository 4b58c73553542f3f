/* Damped bodies that ring, at frequencies that the source hardly has: mechanisms are fitted to the source's band. */
#include "advice/parts.h"

#include "damping/ground.h"
#include "scene/absorbing_layers.h"
#include "scene/resolution.h"

#include <math.h>

/* Of bending, c/2pi times about h/L^2 of a body clamped at one end; in one dimension c/4L. */
static double lowest_frequency(const struct scene *scene)
{
    double least = INFINITY, most = 0;
    for (int axis = 0; axis < scene->dimension; axis++) {
        const double edge = scene->body.high[axis] - scene->body.low[axis];
        least = fmin(least, edge);
        most = fmax(most, edge);
    }
    return slowest_speed(scene) / most * (scene->dimension == 1 ? .25 : .16 * least / most);
}

static bool absorbs_anywhere(const struct scene *scene)
{
    bool absorbs = scene->body.chosen || layer_anywhere(scene);
    for (int face = 0; face < 2 * scene->dimension; face++)
        absorbs = absorbs || boundary_absorbs(&scene->boundary[face]);
    return absorbs;
}

/* Where it says .11 to .14 velocities of bars were .04 wrong, displacements .06, with six mechanisms .004 at most
 * (regress/studies/ringing). */
void look_at_ringing_body(struct adviser *adviser)
{
    static const double seen = .05;
    enum { ENOUGH = 6 };
    const struct scene *scene = adviser->scene;
    struct ground_damping *damping = NULL;
    struct messages none = {0};
    if (!ground_is_damped(scene) || absorbs_anywhere(scene) || scene->method.mechanisms >= ENOUGH) return;
    if (ground_damping_new(scene, true, &damping, &none) == SELAS_OK && damping != NULL) {
        const double error = ground_damping_rings(damping, lowest_frequency(scene), scene->end_time);
        if (error > seen)
            advise(
                adviser,
                "the body rings at frequencies below the source's, to which its damping is not fitted: what "
                "rings there may be up to %.2g wrong by end_time; method%%mechanisms = %d would do",
                fmin(1, error), ENOUGH);
    }
    ground_damping_free(damping);
    messages_free(&none);
}
