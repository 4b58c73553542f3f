/* Symmetry planes: what lies on the body must go on in its mirror image, or the half is no half of anything.
 * A vector across the plane points the other way in the image. */
#include "advice/parts.h"

#include "scene/topography.h"

#include <math.h>
#include <string.h>

struct mirror_plane {
    enum face face;
    int axis;
    double place;
};

static bool across(const struct mirror_plane *plane, const struct body *body, const double direction[3])
{
    double own[3];
    body_direction_from_deck(body, direction, own);
    return fabs(own[plane->axis]) > 1e-6;
}

static void look_at_patch(struct adviser *adviser, const struct mirror_plane *plane, size_t k)
{
    const struct scene *scene = adviser->scene;
    const struct load *load = &scene->load[k];
    double centre[3];
    body_from_deck(&scene->body, load->centre, centre);
    const double off = fabs(centre[plane->axis] - plane->place), half = half_size(load, plane->axis);
    if (off >= half) return; /* not cut */
    if (off > 1e-6 * half)
        advise(adviser,
               "the symmetry plane %s cuts load %zu beside its middle: it and its image are no such patch; "
               "%c = %.6g "
               "would be its middle",
               face_name(plane->face), scene->load[k].group + 1, "xyz"[plane->axis], plane -> place);
    if (across(plane, &scene->body, load->direction))
        advise(adviser,
               "load %zu pushes across the symmetry plane %s that cuts it, where its image pushes back; a "
               "load along "
               "the plane, or the whole body, would be right",
               scene->load[k].group + 1, face_name(plane->face));
}

/* Loads that reach everywhere, and those at one place in the plane. */
static void look_at_load(struct adviser *adviser, const struct mirror_plane *plane, size_t k)
{
    const struct scene *scene = adviser->scene;
    const struct load *load = &scene->load[k];
    const bool on_face = load->kind == LOAD_TRACTION && (int)load->face < BOX_FACES;
    if (on_face && plane->axis == face_axis(load->face)) return; /* the image pulls at the opposite face */
    if (has_patch(load)) {
        look_at_patch(adviser, plane, k);
        return;
    }
    double centre[3];
    body_from_deck(&scene->body, load->centre, centre);
    const double off = fabs(centre[plane->axis] - plane->place);
    if (load->shape == LOAD_POINT && off > 1e-6 * scene->body.spacing) return;
    if (load->kind != LOAD_MOMENT_TENSOR && across(plane, &scene->body, load->direction))
        advise(adviser,
               "load %zu pushes across the symmetry plane %s, beyond which its image pushes the other way; a "
               "load along "
               "the plane, or the whole body, would be right",
               scene->load[k].group + 1, face_name(plane->face));
}

static void look_at_motions(struct adviser *adviser, const struct mirror_plane *plane)
{
    const struct scene *scene = adviser->scene;
    for (int face = 0; face < BOX_FACES; face++) {
        const struct boundary *boundary = &scene->boundary[face];
        if (!boundary_moves(boundary) || face_axis((enum face)face) == plane->axis ||
            !across(plane, &scene->body, boundary->direction))
            continue;
        advise(adviser,
               "face %s moves across the symmetry plane %s, beyond which its image moves the other way; a "
               "motion along "
               "the plane, or the whole body, would be right",
               face_name((enum face)face), face_name(plane->face));
    }
}

static void look_at_start(struct adviser *adviser, const struct mirror_plane *plane)
{
    const struct scene *scene = adviser->scene;
    const struct initial *initial = &scene->initial;
    const struct body *body = &scene->body;
    static const double reach = 3.0; /* widths of a pulse */
    double centre[3];
    body_from_deck(body, initial->centre, centre);
    const double off = fabs(centre[plane->axis] - plane->place);
    bool wrong = false;
    if (initial->kind == INITIAL_UNIFORM_VELOCITY) wrong = across(plane, body, initial->velocity);
    if (initial->kind == INITIAL_PLANE_WAVE)
        wrong = across(plane, body, initial->direction) ||
                (initial->shear && across(plane, body, initial->polarisation));
    if (initial->kind == INITIAL_GAUSSIAN && off < reach * initial->width)
        wrong = off > 1e-6 * initial->width || across(plane, body, initial->direction);
    if (wrong)
        advise(adviser,
               "the initial state is not its own image in the symmetry plane %s; one along the plane and "
               "centred on "
               "it, or the whole body, would be right",
               face_name(plane->face));
}

/* Beyond the plane the surface is its mirror image: a fold along it unless it is level across. */
static void look_at_surface(struct adviser *adviser, const struct mirror_plane *plane)
{
    const struct scene *scene = adviser->scene;
    const struct topography *topography = scene->body.topography;
    const double steep = .02, step = scene->body.spacing / 1000;
    if (topography == NULL || plane->axis == topography->axis) return;
    const int other = 1 - plane->axis;
    const double inward = -face_sign(plane->face) * step;
    double worst = 0, place[2] = {0, 0};
    place[plane->axis] = plane->place;
    const size_t count =
        topography->axis == 2
            ? (size_t)((scene->body.high[other] - scene->body.low[other]) / scene->body.spacing + 1.5)
            : 1;
    for (size_t i = 0; i < count; i++) {
        double beside[2];
        if (topography->axis == 2) place[other] = scene->body.low[other] + (double)i * scene->body.spacing;
        memcpy(beside, place, sizeof beside);
        beside[plane->axis] += inward;
        const double near = topography_drop(topography, place), far = topography_drop(topography, beside);
        worst = fmax(worst, fabs(far - near) / step);
    }
    if (worst > steep)
        advise(adviser,
               "the surface is as steep as %.2g across the symmetry plane %s, beyond which its mirror image "
               "folds it; a "
               "plane through the middle of the hill, or the whole body, would be right",
               worst, face_name(plane->face));
}

void look_at_mirrors(struct adviser *adviser)
{
    const struct scene *scene = adviser->scene;
    for (int face = 0; face < 2 * scene->dimension; face++) {
        const struct mirror_plane plane = {(enum face)face, face_axis((enum face)face),
                                           face_plane(&scene->body, (enum face)face)};
        if (!boundary_mirrors(&scene->boundary[face])) continue;
        for (size_t k = 0; k < scene->loads; k++)
            look_at_load(adviser, &plane, k);
        look_at_motions(adviser, &plane);
        look_at_surface(adviser, &plane);
        look_at_start(adviser, &plane);
        if (scene->body.shape != BODY_PLATE_WITH_HOLE) continue;
        const double off = fabs(scene->body.hole_centre[plane.axis] - plane.place);
        if (off > 1e-6 * scene->body.hole_radius && off < scene->body.hole_radius)
            advise(adviser,
                   "the symmetry plane %s cuts the hole beside its middle: it and its image are no circle; "
                   "%c = %.6g "
                   "would be its middle",
                   face_name(plane.face), "xyz"[plane.axis], plane.place);
    }
}
