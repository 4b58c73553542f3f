/* Scenes that stand for a half-space (see the header). */
#include "exact/ground.h"

#include <math.h>

static double surface_depth(const struct body *body)
{
    return body->shape == BODY_BOX ? body->low[2] : 0;
}

void ground_position(const struct scene *scene, const double deck[3], double position[3])
{
    body_from_deck(&scene->body, deck, position);
    position[2] -= surface_depth(&scene->body);
    const double size = fabs(deck[0]) + fabs(deck[1]) + fabs(deck[2]) + 1;
    if (fabs(position[2]) < 1e-12 * size) position[2] = 0;
}

static selas_status refuse(struct messages *messages, const char *reference, const char *why)
{
    return fail(messages, SELAS_BAD_SCENE, "reference '%s': %s", reference, why);
}

selas_status ground_check(const struct scene *scene, const char *reference, struct messages *messages)
{
    if (scene->dimension != 3)
        return refuse(messages, reference, "the half-space is three-dimensional, dimension = 3");
    if (!body_is_box(&scene->body))
        return refuse(messages, reference, "the body must have shape = 'box' or 'half-space'");
    if (scene->initial.kind != INITIAL_REST)
        return refuse(messages, reference, "the ground must start at rest");
    if (scene->loads == 0) return refuse(messages, reference, "there is no &load");
    for (int face = 0; face < BOX_FACES; face++) {
        const struct boundary *boundary = &scene->boundary[face];
        const bool open = boundary_absorbs(boundary) || boundary_mirrors(boundary);
        if (!boundary_is_free(boundary) && (face == FACE_Z_LOW || !open))
            return fail(
                messages, SELAS_BAD_SCENE, "reference '%s': face %s must be %s for an infinite half-space",
                reference, face_name((enum face)face),
                face == FACE_Z_LOW ? "'free'" : "'transmitting', 'symmetry' (sides) or 'free' and far away");
        if (boundary_mirrors(boundary) && face == FACE_Z_HIGH)
            return refuse(messages, reference, "face z+ cannot be a symmetry plane of a half-space");
    }
    for (int axis = 0; axis < 2; axis++)
        if (boundary_mirrors(&scene->boundary[2 * axis]) && boundary_mirrors(&scene->boundary[2 * axis + 1]))
            return refuse(messages, reference,
                          "opposite symmetry planes repeat the load without end; make one of them "
                          "'transmitting'");
    return SELAS_OK;
}
