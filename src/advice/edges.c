/* Faces that meet in an edge and prescribe it differently: no body does both. Which of them has its way is
 * left to the method (doc/reference/scene.md). */
#include "advice/parts.h"

#include <math.h>

/* Is a component (of the body's frame) prescribed on the face? With which amplitude? */
static bool prescribed(const struct scene *scene, int face, int component, double *amplitude)
{
    const struct boundary *boundary = &scene->boundary[face];
    double own[3];
    *amplitude = 0.0;
    if (!face_holds(scene, (enum face)face, component)) return false;
    if (!boundary_moves(boundary)) return !boundary_mirrors(boundary);
    body_direction_from_deck(&scene->body, boundary->direction, own);
    *amplitude = boundary->amplitude * own[component];
    return true;
}

static bool contradict(const struct scene *scene, int one, int other, int component)
{
    const struct boundary *first = &scene->boundary[one], *second = &scene->boundary[other];
    double a, b;
    if (!prescribed(scene, one, component, &a) || !prescribed(scene, other, component, &b)) return false;
    const double largest = fmax(fabs(a), fabs(b));
    if (largest <= 1e-9 * fmax(fabs(first->amplitude), fabs(second->amplitude))) return false;
    return fabs(a - b) > 1e-9 * largest || first->kind != second->kind ||
           !history_same(&first->history, &second->history);
}

void look_at_meetings(struct adviser *adviser)
{
    const int faces = 2 * adviser->scene->dimension;
    for (int one = 0; one < faces; one++)
        for (int other = 2 * (one / 2) + 2; other < faces; other++)
            for (int component = 0; component < adviser->scene->dimension; component++) {
                if (!contradict(adviser->scene, one, other, component)) continue;
                advise(adviser,
                       "faces %s and %s meet, and prescribe different motions along %c there; with slip = "
                       ".true. or "
                       "one of them free they would not",
                       face_name((enum face)one), face_name((enum face)other), "xyz"[component]);
                break;
            }
}
