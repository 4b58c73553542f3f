/* Damped bodies that ring, at frequencies that the source hardly has: mechanisms are fitted to the source's band. */
#include "advice/parts.h"

#include "damping/ground.h"
#include "scene/absorbing_layers.h"
#include "scene/resolution.h"

#include <math.h>

/* Over speed, of displacements of one component held on a face across an axis: a quarter of the edge's wave; where the
 * body is thin along the component that of bending, 1/2pi times about h/L^2. */
static double swing(const struct scene *scene, int component, int axis)
{
    const double *low = scene->body.low, *high = scene->body.high;
    const double edge = high[axis] - low[axis], thick = high[component] - low[component];
    return axis == component ? .25 / edge : fmin(.25, .16 * thick / edge) / edge;
}

/* Of the components' the least: held on both faces twice that of one; where none holds it that of the longest edge. */
static double lowest_frequency(const struct scene *scene)
{
    const struct body *body = &scene->body;
    double least = INFINITY;
    int longest = 0;
    for (int axis = 1; axis < scene->dimension; axis++)
        if (body->high[axis] - body->low[axis] > body->high[longest] - body->low[longest]) longest = axis;
    for (int component = 0; component < scene->dimension; component++) {
        double held = 0;
        for (int axis = 0; axis < scene->dimension; axis++) {
            const int faces = face_holds(scene, (enum face)(2 * axis), component) +
                              face_holds(scene, (enum face)(2 * axis + 1), component);
            held = fmax(held, faces * swing(scene, component, axis));
        }
        least = fmin(least, held > 0 ? held : swing(scene, component, longest));
    }
    return slowest_speed(scene) * least;
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
