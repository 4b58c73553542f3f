/* Places that are looked at where there is no body: in a hole, or in what the points of a file leave out of its box. */
#include "advice/parts.h"

#include "scene/boundary.h"

#include <math.h>

enum { MOST = 6 }; /* neighbours that tell how far points are apart: two along each axis */

/* The point nearest to a place; its distance. */
static size_t nearest_point(const struct model *model, const double place[3], double *distance)
{
    size_t nearest = 0;
    *distance = INFINITY;
    for (size_t i = 0; i < model->points; i++) {
        const double *x = model->position + 3 * i;
        const double away = hypot(hypot(x[0] - place[0], x[1] - place[1]), x[2] - place[2]);
        if (away < *distance) nearest = i;
        *distance = fmin(*distance, away);
    }
    return nearest;
}

/* Distance of a point from the last of the first 2 d others. */
static double apart(const struct model *model, size_t point)
{
    const double *place = model->position + 3 * point;
    const int count = 2 * model->scene->dimension;
    double least[MOST];
    for (int k = 0; k < MOST; k++)
        least[k] = INFINITY;
    for (size_t i = 0; i < model->points; i++) {
        const double *x = model->position + 3 * i;
        double away = hypot(hypot(x[0] - place[0], x[1] - place[1]), x[2] - place[2]);
        for (int k = 0; i != point && k < count && k < MOST; k++)
            if (away < least[k]) {
                const double kept = least[k];
                least[k] = away;
                away = kept;
            }
    }
    return least[count <= MOST ? count - 1 : 0];
}

static bool empty(const struct model *model, const double place[3])
{
    const struct body *body = &model->scene->body;
    double own[3], distance;
    body_from_deck(body, place, own);
    if (body->shape == BODY_PLATE_WITH_HOLE)
        return hypot(own[0] - body->hole_centre[0], own[1] - body->hole_centre[1]) <
               body->hole_radius - 1e-6 * body->spacing;
    const size_t nearest = nearest_point(model, place, &distance);
    return distance > body->spacing && distance > apart(model, nearest);
}

static void tell(struct adviser *adviser, const char *what, const char *name, const double place[3])
{
    advise(adviser,
           "%s '%s' looks at (%.6g, %.6g, %.6g), where there is no body but a hole or a gap: what it has "
           "from there "
           "is guessed from points beside it; places in the body would be right",
           what, name, place[0], place[1], place[2]);
}

void look_at_voids(struct adviser *adviser, const struct model *model)
{
    enum { LOOKS = 100 };
    const struct scene *scene = adviser->scene;
    if (body_is_box(&scene->body) || model->position == NULL) return;
    for (size_t r = 0; r < scene->receivers; r++)
        if (empty(model, scene->receiver[r].position))
            tell(adviser, "receiver", scene->receiver[r].name, scene->receiver[r].position);
    for (size_t p = 0; p < scene->profiles; p++) {
        const struct profile *profile = &scene->profile[p];
        const size_t count = profile->points < LOOKS ? profile->points : LOOKS;
        for (size_t k = 0; k < count; k++) {
            const double part = (double)k / (double)(count - 1);
            double place[3];
            for (int c = 0; c < 3; c++)
                place[c] = (1 - part) * profile->from[c] + part * profile->to[c];
            if (!empty(model, place)) continue;
            tell(adviser, "profile", profile->name, place);
            break;
        }
    }
}
