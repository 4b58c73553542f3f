/* The ground as a field (doc/general-ground.md, section 4). */
#include "scene/ground.h"

#include <math.h>

static struct rock rock_of(const struct material *material)
{
    return (struct rock){material->density, material->plane_lambda, material->mu};
}

struct rock ground_at(const struct scene *scene, const double place[3])
{
    const int last = scene->dimension - 1;
    return rock_of(scene_material_at(scene, fmax(0, place[last] - scene->body.low[last])));
}

size_t ground_jumps(const struct scene *scene, const double place[3], int axis, double from, double to,
                    double *at)
{
    const struct body *body = &scene->body;
    size_t count = 0;
    (void)place;
    for (size_t i = 0; i < body->layers && axis == scene->dimension - 1; i++) {
        const double x = body->low[axis] + body->layer[i].top;
        if (x > fmax(from, body->low[axis]) && x < to) at[count++] = x;
    }
    return count;
}

size_t ground_jumps_at_most(const struct scene *scene)
{
    return scene->body.layers;
}

bool ground_grades(const struct scene *scene)
{
    (void)scene;
    return false;
}

bool ground_varies(const struct scene *scene, int axis)
{
    return axis == scene->dimension - 1 && body_is_layered(&scene->body);
}
