/* What the faces do: one treatment a face; a face that nobody names is free. */
#include "base/memory.h"
#include "scene/absorbing_layers.h"
#include "scene/build.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Index of 'all' among the choices of boundary%face; the others are those of enum face. */
enum { FACE_ALL = FACES };

#define KIND(symbol, word, holds, motion, needs) [symbol] = "kind '" word "'",
static const char *const kinds[] = {BOUNDARY_KINDS(KIND)};
#undef KIND

static bool has_face(const struct scene *scene, enum face face)
{
    if (face == FACE_HOLE) return scene->body.shape == BODY_PLATE_WITH_HOLE;
    return face_axis(face) < scene->dimension;
}

/* Number of components along which a unit vector in the deck's coordinates lies in the body's frame: its
 * axis, or -1 if it is along none. */
static int axis_along(const struct body *body, const double direction[3])
{
    double own[3];
    body_direction_from_deck(body, direction, own);
    for (int c = 0; c < 3; c++)
        if (fabs(own[c]) > 1 - 1e-12) return c;
    return -1;
}

static void read_motion(struct builder *builder, const struct deck_group *group, struct boundary *boundary)
{
    const char *purpose = kinds[boundary->kind];
    const bool known = need_direction(builder, group, "direction", purpose, boundary->direction);
    boundary->amplitude = deck_real(group, "amplitude", 0);
    boundary->slip = deck_logical(group, "slip", 0);
    if (boundary->slip && known && builder->body_known &&
        axis_along(&builder->scene->body, boundary->direction) < 0)
        complain(builder, group, "slip", "slip needs a direction along an axis of the body");
    take_history(builder, group, purpose, &boundary->history);
}

/* What a transmitting face has where the deck does not say. */
static enum absorber best_absorber(const struct scene *scene)
{
    return layers_refusal(scene) == NULL && !scene->body.dampers ? ABSORBER_PML : ABSORBER_LYSMER;
}

/* Why a face with dampers takes no word of a layer. */
static const char *dampers_purpose(const struct scene *scene, const struct deck_group *group,
                                   char purpose[160])
{
    const char *why = deck_values(group, "layer") == 0 ? layers_refusal(scene) : NULL;
    snprintf(purpose, 160, "layer 'lysmer', which has no thickness%s%s%s", why != NULL ? " (" : "",
             why != NULL ? why : "", why != NULL ? ")" : "");
    return purpose;
}

static void read_absorber(struct builder *builder, const struct deck_group *group, struct boundary *boundary)
{
    static const char *const layer_words[] = {"layer_points", "layer_thickness", "layer_reflection", "always",
                                              NULL};
    static const char *const factor_words[] = {"normal_factor", "shear_factor", NULL};
    char purpose[160];
    const bool factors = deck_given(group, "normal_factor") || deck_given(group, "shear_factor");
    const bool thickness = deck_given(group, "layer_points") || deck_given(group, "layer_thickness") ||
                           deck_given(group, "layer_reflection");
    boundary->absorber = factors ? ABSORBER_LYSMER : best_absorber(builder->scene);
    boundary->fallen = !factors && deck_values(group, "layer") == 0 && builder->scene->dimension > 1 &&
                       strcmp(builder->scene->method.variant, "consistent") == 0 &&
                       layers_refusal(builder->scene) != NULL;
    if (thickness && layers_refusal(builder->scene) == NULL) boundary->absorber = ABSORBER_PML;
    if (deck_values(group, "layer") > 0) boundary->absorber = (enum absorber)deck_choice(group, "layer", 0);
    boundary->normal_factor = deck_real(group, "normal_factor", 0);
    boundary->shear_factor = deck_real(group, "shear_factor", 0);
    if (boundary->absorber == ABSORBER_LYSMER) {
        refuse(builder, group, layer_words, dampers_purpose(builder->scene, group, purpose));
        return;
    }
    refuse(builder, group, factor_words, "layer 'pml'");
    boundary->always = deck_logical(group, "always", 0);
    if (deck_given(group, "layer_points") + deck_given(group, "layer_thickness") +
            deck_given(group, "layer_reflection") >
        1)
        complain(builder, group,
                 deck_given(group, "layer_reflection") ? "layer_reflection" : "layer_thickness",
                 "give one of layer_points, layer_thickness and layer_reflection");
    boundary->least_points = builder->layer_points; /* scene%accuracy; else 0 */
    if (deck_given(group, "layer_points")) boundary->layer_points = deck_integer(group, "layer_points", 0);
    if (deck_given(group, "layer_thickness"))
        boundary->layer_thickness = deck_real(group, "layer_thickness", 0);
    if (deck_given(group, "layer_reflection"))
        boundary->layer_reflection = deck_real(group, "layer_reflection", 0);
}

/* Everything a group says about its faces but their names. */
static void read_treatment(struct builder *builder, const struct deck_group *group, struct boundary *boundary)
{
    static const char *const motion_words[] = {"direction", "slip", NULL};
    static const char *const absorber_words[] = {
        "layer",         "layer_points", "layer_thickness", "layer_reflection",
        "normal_factor", "shear_factor", "always",          NULL};
    boundary->kind = (enum boundary_kind)deck_choice(group, "kind", 0);
    boundary->normal_factor = boundary->shear_factor = 1;
    const char *purpose = kinds[boundary->kind];
    if (boundary_moves(boundary)) {
        read_motion(builder, group, boundary);
    } else {
        refuse(builder, group, motion_words, purpose);
        refuse(builder, group, history_words, purpose);
    }
    if (boundary_absorbs(boundary))
        read_absorber(builder, group, boundary);
    else
        refuse(builder, group, absorber_words, purpose);
}

/* The same treatment for another face, with a table of its own. */
static bool copy_boundary(struct builder *builder, const struct boundary *from, struct boundary *to)
{
    const size_t rows = from->history.rows;
    *to = *from;
    if (rows == 0) return true;
    to->history.table_time = scene_array(builder, rows, sizeof(double));
    to->history.table_value = scene_array(builder, rows, sizeof(double));
    if (to->history.table_time == NULL || to->history.table_value == NULL) {
        history_free(&to->history);
        to->history = (struct history){0};
        return false;
    }
    memcpy(to->history.table_time, from->history.table_time, rows * sizeof(double));
    memcpy(to->history.table_value, from->history.table_value, rows * sizeof(double));
    return true;
}

static void set_face(struct builder *builder, const struct deck_group *group, enum face face,
                     const struct boundary *treatment)
{
    struct boundary *boundary = &builder->scene->boundary[face];
    if (boundary->given) {
        complain(builder, group, "face",
                 "face '%s' is named twice, first in &boundary %zu; name each face once", face_name(face),
                 boundary->group + 1);
        return;
    }
    if (face == FACE_HOLE && !boundary_is_free(treatment)) {
        complain(builder, group, "kind", "the hole can only be free");
        return;
    }
    copy_boundary(builder, treatment, boundary);
}

static void read_boundary(struct builder *builder, size_t index)
{
    const struct deck_group *group = deck_get(builder->deck, "boundary", index);
    struct boundary treatment = {.given = true, .group = index};
    read_treatment(builder, group, &treatment);
    for (size_t i = 0; i < deck_values(group, "face"); i++) {
        const size_t named = deck_choice(group, "face", i);
        if (named == FACE_ALL) {
            for (int face = 0; face < BOX_FACES; face++)
                if (has_face(builder->scene, (enum face)face))
                    set_face(builder, group, (enum face)face, &treatment);
        } else if (!has_face(builder->scene, (enum face)named)) {
            complain(builder, group, "face", "this body has no face '%s'; its faces are x- x+%s%s%s",
                     face_name((enum face)named), builder->scene->dimension > 1 ? " y- y+" : "",
                     builder->scene->dimension > 2 ? " z- z+" : "",
                     has_face(builder->scene, FACE_HOLE) ? " hole" : "");
        } else {
            set_face(builder, group, (enum face)named, &treatment);
        }
    }
    history_free(&treatment.history);
}

/* Sides and bottom of a half-space that the deck does not name absorb, but where the program fitted the box so
 * that nothing comes back; beside what moves all the surface alike the sides are rollers. */
static void open_sides(const struct builder *builder)
{
    struct scene *scene = builder->scene;
    const int top = 2 * scene->dimension - 2;
    const struct body *body = &scene->body;
    for (int face = 0; face < 2 * scene->dimension; face++) {
        if (face == top || scene->boundary[face].given) continue;
        if (body->plane && face < top) {
            scene->boundary[face].kind = BOUNDARY_ROLLER;
        } else if (!body->chosen || body->absorbing) {
            scene->boundary[face].kind = BOUNDARY_TRANSMITTING;
            scene->boundary[face].absorber = best_absorber(scene);
            scene->boundary[face].least_points = builder->layer_points;
        }
    }
}

void build_boundaries(struct builder *builder)
{
    for (int face = 0; face < FACES; face++)
        builder->scene->boundary[face].normal_factor = builder->scene->boundary[face].shear_factor = 1;
    for (size_t i = 0; i < deck_count(builder->deck, "boundary"); i++)
        read_boundary(builder, i);
    if (builder->scene->body.shape == BODY_HALF_SPACE) open_sides(builder);
}
