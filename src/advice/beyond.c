/* Ground that goes on: an absorbing face stands for more of it, and so does any face for an exact half-space. What
 * acts there, too, is not in the body, and neither is what it sends from there. */
#include "advice/parts.h"
#include "scene/extent.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static double face_place(const struct body *body, int face)
{
    return face % 2 == 0 ? body->low[face / 2] : body->high[face / 2];
}

/* Can waves that set out from a face at a time come by what is looked at? */
static bool is_seen(const struct scene *scene, int face, double since)
{
    const double speed = scene_fastest(scene), plane = face_place(&scene->body, face); /* 0: a model's */
    struct extent extent;
    for (size_t i = 0; scene_extent(scene, i, &extent); i++) {
        const double near = face % 2 == 0 ? extent.low[face / 2] : extent.high[face / 2];
        const double away = fmax(0, face % 2 == 0 ? near - plane : plane - near);
        const bool looks = extent.role == EXTENT_SEEN && strcmp(extent.group, "block") != 0 &&
                           strcmp(extent.group, "topography") != 0;
        if (looks && since < extent.until && (speed == 0 || since + away / speed < extent.until)) return true;
    }
    return false;
}

/* Patches that reach beyond the body; those that a symmetry plane cuts go on behind it. */
static void look_at_patch(struct adviser *adviser, size_t k)
{
    const struct scene *scene = adviser->scene;
    const struct load *load = &scene->load[k];
    const bool compared = strcmp(scene->reference.kind, "lamb") == 0;
    double from[3], velocity[3];
    body_from_deck(&scene->body, load->centre, from);
    body_direction_from_deck(&scene->body, load->velocity, velocity);
    for (int face = 0; face < 2 * scene->dimension; face++) {
        const struct boundary *boundary = &scene->boundary[face];
        const int axis = face / 2;
        const double to = from[axis] + velocity[axis] * scene->end_time, half = half_size(load, axis);
        const double low = fmin(from[axis], to) - half, high = fmax(from[axis], to) + half;
        const double outward = face % 2 == 0 ? -1 : 1, plane = face_place(&scene->body, face);
        const double least = 1e-9 * scene->body.spacing;
        const double at_first = outward * (from[axis] - plane) + half,
                     at_last = outward * (to - plane) + half;
        const double since = at_first > least ? 0 : scene->end_time * at_first / (at_first - at_last);
        if (axis == face_axis(load->face) || fmax(at_first, at_last) <= least) continue;
        if (boundary_mirrors(boundary) || !(compared || boundary_absorbs(boundary))) continue;
        if (!is_seen(scene, face, since)) continue;
        advise(adviser,
               "load %zu runs beyond the body, where nothing feels it; %s there, so that what it sends from "
               "there is missing here; a body from %.6g to %.6g along %c would hold it",
               load->group + 1,
               compared ? "the exact solution loads the ground"
                        : "the ground behind an absorbing face goes on",
               low, high, "xyz"[axis]);
        return;
    }
}

/* What acts all over the body but across own_axis (-1: none): a layer of soil, 12 wide and 5 deep, that is shaken
 * between dampers moves by .5 to .75 otherwise than one that goes on (regress/checks/advice.sh). */
static void look_at_all_along(struct adviser *adviser, const char *what, int own_axis)
{
    const struct scene *scene = adviser->scene;
    for (int face = 0; face < 2 * scene->dimension; face++) {
        if (face / 2 == own_axis || !boundary_absorbs(&scene->boundary[face]) || !is_seen(scene, face, 0))
            continue;
        advise(
            adviser,
            "%s acts as far as the absorbing face %s and on nothing behind it, which sends waves inward as "
            "from the edge of a patch; for ground that goes on and moves alike, rollers beside a motion "
            "along "
            "the face would be right, and beside one across it faces that hold the component along the depth "
            "alone (slip = .true., amplitude = 0)",
            what, face_name((enum face)face));
        return;
    }
}

void look_at_beyond(struct adviser *adviser)
{
    const struct scene *scene = adviser->scene;
    char what[64];
    for (size_t k = 0; k < scene->loads; k++) {
        const struct load *load = &scene->load[k];
        if (has_patch(load)) look_at_patch(adviser, k);
        snprintf(what, sizeof what, "load %zu", load->group + 1);
        if (load->shape == LOAD_FACE)
            look_at_all_along(adviser, what, load->kind == LOAD_TRACTION ? (int)face_axis(load->face) : -1);
    }
    for (int face = 0; face < 2 * scene->dimension; face++) {
        snprintf(what, sizeof what, "the motion of face %s", face_name((enum face)face));
        if (boundary_acts(&scene->boundary[face])) look_at_all_along(adviser, what, face / 2);
    }
    if (scene->initial.kind == INITIAL_UNIFORM_VELOCITY)
        look_at_all_along(adviser, "the velocity of t = 0", -1);
}
