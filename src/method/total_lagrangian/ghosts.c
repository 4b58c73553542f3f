/* Ghosts of total-Lagrangian SPH: kinematic, u_g = T u_m + prescribed motion; the forces on them go back by
 * T^T (force.c).
 *
 * The points within reach of a face are mirrored in it. On symmetry planes, rollers and faces pushed along
 * their normal while they slip, the normal component changes its sign (plus twice the motion); this is exact,
 * for the mirror image of an isotropic body's motion is a motion. On clamped faces, and those that move as a
 * whole, all components do: u_g = 2 U - u_m, so that the field extended beyond the face passes through U
 * there. (Nodes on the clamped face that enter the least-squares gradients were tried: the fit then lets the
 * body slide away from them, the beam of He & Seaid, section 4.2, becomes 30 % too soft.) */
#include "method/total_lagrangian/total_lagrangian.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum treatment { LEAVE, SLIP, HOLD };

struct ghosts {
    size_t count, room;
    double (*position)[3];
    struct tl_ghost *ghost;
};

static selas_status treatment_of(const struct tl_model *tl, int face, enum treatment *treatment,
                                 struct messages *messages)
{
    const struct scene *scene = tl->model.scene;
    const struct boundary *boundary = &scene->boundary[face];
    *treatment = LEAVE;
    if (tl->options.form != NULL) return SELAS_OK; /* its points on the faces are held */
    if (face < BOX_FACES && face / 2 >= scene->dimension) return SELAS_OK;
    const bool slips = boundary_slides(boundary) || (boundary_moves(boundary) && boundary->slip);
    if (boundary_meaning(boundary)->holds != HOLDS_NOTHING) *treatment = HOLD;
    if (!slips) return SELAS_OK;
    *treatment = SLIP;
    if (face == FACE_HOLE)
        return fail(messages, SELAS_UNSUPPORTED, "face 'hole' cannot slip with total-Lagrangian points");
    double along[3];
    body_direction_from_deck(&scene->body, boundary->direction, along);
    if (boundary_moves(boundary) && fabs(fabs(along[face / 2]) - 1) > 1e-9)
        return fail(messages, SELAS_UNSUPPORTED,
                    "face '%s': slip = .true. needs a direction along the face's normal",
                    face_name((enum face)face));
    return SELAS_OK;
}

static bool add(struct ghosts *ghosts, const double position[3], const struct tl_ghost *ghost)
{
    if (ghosts->count == ghosts->room) {
        const size_t room = ghosts->room + ghosts->room / 2 + 64;
        void *position_larger = realloc(ghosts->position, room * sizeof *ghosts->position);
        if (position_larger != NULL) ghosts->position = position_larger;
        void *ghost_larger = realloc(ghosts->ghost, room * sizeof *ghosts->ghost);
        if (ghost_larger != NULL) ghosts->ghost = ghost_larger;
        if (position_larger == NULL || ghost_larger == NULL) return false;
        ghosts->room = room;
    }
    memcpy(ghosts->position[ghosts->count], position, sizeof(double[3]));
    ghosts->ghost[ghosts->count++] = *ghost;
    return true;
}

/* Motion of a face in the body's frame per unit of its history. */
static void face_motion(const struct scene *scene, int face, double motion[3])
{
    const struct boundary *boundary = &scene->boundary[face];
    memset(motion, 0, sizeof(double[3]));
    if (!boundary_moves(boundary)) return;
    body_direction_from_deck(&scene->body, boundary->direction, motion);
    for (int c = 0; c < 3; c++)
        motion[c] *= boundary->amplitude;
}

/* Image of x in a plane face of the box or in the hole's circle; false beyond `radius`. */
static bool mirrored(const struct body *body, int face, double radius, double x[3], double *volume)
{
    if (face < BOX_FACES) {
        const int axis = face_axis((enum face)face);
        const double plane = face_plane(body, (enum face)face);
        if (fabs(x[axis] - plane) >= radius) return false;
        x[axis] = 2 * plane - x[axis];
        return true;
    }
    const double away[2] = {x[0] - body->hole_centre[0], x[1] - body->hole_centre[1]};
    const double r = hypot(away[0], away[1]);
    const double image = 2 * body->hole_radius - r;
    if (fabs(r - body->hole_radius) >= radius || image <= 0) return false;
    for (int c = 0; c < 2; c++)
        x[c] = body->hole_centre[c] + away[c] * image / r;
    *volume *= image / r;
    return true;
}

/* Mirrors the points and the ghosts there are. */
static bool add_mirror(const struct tl_model *tl, struct ghosts *ghosts, int face, bool slips, double radius)
{
    double motion[3];
    face_motion(tl->model.scene, face, motion);
    const size_t n = tl->cloud->points, before = ghosts->count;
    for (size_t s = 0; s < n + before; s++) {
        double x[3], part = 1;
        memcpy(x, s < n ? tl->cloud->position + 3 * s : ghosts->position[s - n], sizeof x);
        if (!mirrored(&tl->model.scene->body, face, radius, x, &part)) continue;
        struct tl_ghost ghost = {.source = s, .sign = {1, 1, 1}, .mirror = {1, 1, 1}};
        if (s >= n) ghost = ghosts->ghost[s - n];
        ghost.volume = part * (s < n ? tl->cloud->volume[s] : ghost.volume);
        if (face < BOX_FACES)
            ghost.mirror[face / 2] *= -1;
        else
            ghost.curved = true;
        for (int c = 0; c < 3; c++) {
            if (slips && c != face / 2) continue;
            ghost.sign[c] *= -1;
            for (int f = 0; f < FACES; f++)
                ghost.motion[c][f] *= -1;
            ghost.motion[c][face] += 2 * motion[c];
        }
        if (!add(ghosts, x, &ghost)) return false;
    }
    return true;
}

static bool keep(struct tl_model *tl, const struct ghosts *ghosts)
{
    const size_t n = tl->cloud->points, d = (size_t)tl->cloud->dimension;
    tl->ghosts = ghosts->count;
    tl->sites = n + tl->ghosts;
    tl->site_position = array_new(3 * tl->sites, sizeof(double));
    tl->ghost = array_new(tl->ghosts, sizeof *tl->ghost);
    if (tl->site_position == NULL || tl->ghost == NULL) return false;
    memcpy(tl->site_position, tl->cloud->position, n * sizeof(double[3]));
    if (tl->ghosts > 0) {
        memcpy(tl->site_position + 3 * n, ghosts->position, tl->ghosts * sizeof(double[3]));
        memcpy(tl->ghost, ghosts->ghost, tl->ghosts * sizeof *tl->ghost);
    }
    tl->place = array_new(d * tl->sites, sizeof(double));
    if (tl->place == NULL) return false;
    for (size_t s = 0; s < tl->sites; s++)
        for (size_t c = 0; c < d; c++)
            tl->place[d * s + c] = tl->site_position[3 * s + c];
    return true;
}

selas_status tl_make_ghosts(struct tl_model *tl, double radius, struct messages *messages)
{
    struct ghosts ghosts = {0};
    enum treatment treatment[FACES];
    selas_status status = SELAS_OK;
    bool room = true;
    for (int face = 0; face < FACES && status == SELAS_OK; face++) {
        status = treatment_of(tl, face, &treatment[face], messages);
        tl->mirrors[face] = treatment[face] != LEAVE;
        tl->moving = tl->moving || boundary_moves(&tl->model.scene->boundary[face]);
    }
    for (int face = 0; face < FACES && status == SELAS_OK && room; face++)
        if (treatment[face] != LEAVE) room = add_mirror(tl, &ghosts, face, treatment[face] == SLIP, radius);
    if (status == SELAS_OK && room) room = keep(tl, &ghosts);
    if (status == SELAS_OK && !room) status = fail(messages, SELAS_NO_MEMORY, "no memory for ghosts");
    free(ghosts.position);
    free(ghosts.ghost);
    return status;
}
