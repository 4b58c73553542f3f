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

bool ground_load_moves(const struct load *load)
{
    return load->velocity[0] != 0 || load->velocity[1] != 0 || load->velocity[2] != 0;
}

bool ground_has_symmetry(const struct scene *scene)
{
    for (int face = 0; face < BOX_FACES; face++)
        if (scene->boundary[face].kind == BOUNDARY_SYMMETRY) return true;
    return false;
}

static selas_status refuse(struct messages *messages, const char *reference, const char *why)
{
    return fail(messages, SELAS_BAD_SCENE, "reference '%s': %s", reference, why);
}

selas_status ground_check(const struct scene *scene, const char *reference, struct messages *messages)
{
    if (scene->dimension != 3)
        return refuse(messages, reference, "the half-space is three-dimensional, dimension = 3");
    if (scene->body.shape != BODY_BOX && scene->body.shape != BODY_HALF_SPACE)
        return refuse(messages, reference, "the body must have shape = 'box' or 'half-space'");
    if (scene->initial.kind != INITIAL_REST)
        return refuse(messages, reference, "the ground must start at rest");
    if (scene->loads == 0) return refuse(messages, reference, "there is no &load");
    for (int face = 0; face < BOX_FACES; face++) {
        const enum boundary_kind kind = scene->boundary[face].kind;
        if (face == FACE_Z_LOW
                ? kind != BOUNDARY_FREE
                : kind != BOUNDARY_FREE && kind != BOUNDARY_TRANSMITTING && kind != BOUNDARY_SYMMETRY)
            return fail(
                messages, SELAS_BAD_SCENE, "reference '%s': face %s must be %s for an infinite half-space",
                reference, face_name((enum face)face),
                face == FACE_Z_LOW ? "'free'" : "'transmitting', 'symmetry' (sides) or 'free' and far away");
        if (kind == BOUNDARY_SYMMETRY && face == FACE_Z_HIGH)
            return refuse(messages, reference, "face z+ cannot be a symmetry plane of a half-space");
    }
    for (int axis = 0; axis < 2; axis++)
        if (scene->boundary[2 * axis].kind == BOUNDARY_SYMMETRY &&
            scene->boundary[2 * axis + 1].kind == BOUNDARY_SYMMETRY)
            return refuse(messages, reference,
                          "opposite symmetry planes repeat the load without end; make one of them "
                          "'transmitting'");
    return SELAS_OK;
}
