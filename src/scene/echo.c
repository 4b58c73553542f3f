/* The way of the first echo of a face (doc/absorbing-faces.md, section 6): what tells whether it needs an
 * absorbing layer, and whether scene%accuracy may leave it as it is. */
#include "scene/echo.h"

#include <math.h>

/* Distance of a place (deck coordinates) from a face, or of its mirror image where the opposite face is a
 * symmetry plane. */
static double distance(const struct scene *scene, int face, const double position[3])
{
    double place[3];
    const int opposite = face ^ 1, axis = face / 2;
    const double plane = face_plane(&scene->body, (enum face)face);
    body_from_deck(&scene->body, position, place);
    const double direct = fabs(place[axis] - plane);
    if (!boundary_mirrors(&scene->boundary[opposite])) return direct;
    const double image = 2 * face_plane(&scene->body, (enum face)opposite) - place[axis];
    return fmin(direct, fabs(image - plane));
}

static double source_distance(const struct scene *scene, int face)
{
    double nearest = INFINITY;
    if (scene->initial.kind != INITIAL_REST || (scene_needs(scene) & CAN_MOVE) != 0) return 0;
    for (size_t l = 0; l < scene->loads; l++) {
        const struct load *load = &scene->load[l];
        if (load->shape == LOAD_FACE || load_moves(load)) return 0;
        const double size = load->shape == LOAD_POINT ? 0 : fmax(load->size[0], load->size[1]) / 2;
        nearest = fmin(nearest, distance(scene, face, load->centre) - size);
    }
    return fmax(nearest, 0);
}

static double seen_distance(const struct scene *scene, int face)
{
    double nearest = INFINITY;
    if (scene->snapshots > 0) return 0;
    for (size_t r = 0; r < scene->receivers; r++)
        nearest = fmin(nearest, distance(scene, face, scene->receiver[r].position));
    for (size_t p = 0; p < scene->profiles; p++)
        nearest = fmin(nearest, fmin(distance(scene, face, scene->profile[p].from),
                                     distance(scene, face, scene->profile[p].to)));
    return nearest;
}

double echo_path(const struct scene *scene, int face)
{
    return source_distance(scene, face) + seen_distance(scene, face);
}
