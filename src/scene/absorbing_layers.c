/* Absorbing layers as the scene asks for them: thickness, profile, and whether a face needs one at all
 * (doc/absorbing-faces.md, sections 3 and 6). */
#include "scene/absorbing_layers.h"

#include "scene/echo.h"

#include <math.h>

/* The reflection that a profile is made for falls with the number of points by this factor a point; then what
 * comes back from the outer end and what the lattice makes of the profile are about equal (measured). A pulse
 * that meets the absorbing layer at right angles sees twice that (measured); waves along a surface far less.
 */
static const double decay_per_point = .78, measured_part = 2;
double layer_profile_reflection(size_t points)
{
    return exp(-decay_per_point * (double)points);
}

double layer_expected_reflection(size_t points)
{
    return measured_part * layer_profile_reflection(points);
}

static bool layer_unneeded(const struct scene *scene, int face)
{
    if (scene->boundary[face].always || scene->receivers + scene->profiles == 0) return false;
    return echo_path(scene, face) - 4 * scene->body.spacing > 1.02 * scene_fastest(scene) * scene->end_time;
}

static bool layer_asked(const struct scene *scene, int face)
{
    return body_is_box(&scene->body) && boundary_has_layer(&scene->boundary[face]);
}

size_t layer_points(const struct scene *scene, int face)
{
    const struct boundary *boundary = &scene->boundary[face];
    if (!layer_asked(scene, face) || layer_unneeded(scene, face)) return 0;
    if (boundary->layer_points > 0) return (size_t)boundary->layer_points;
    if (!(boundary->layer_reflection > 0)) return LAYER_POINTS;
    const double points = ceil(log(measured_part / boundary->layer_reflection) / decay_per_point - 1e-9);
    return (size_t)fmin(fmax(points, LEAST_POINTS), MOST_POINTS);
}

bool layer_anywhere(const struct scene *scene)
{
    for (int face = 0; face < 2 * scene->dimension; face++)
        if (layer_points(scene, face) > 0) return true;
    return false;
}

bool layer_left_out(const struct scene *scene, int face)
{
    return layer_asked(scene, face) && layer_unneeded(scene, face);
}
