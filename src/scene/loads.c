/* Loads: tractions on patches of faces, body forces, moment tensors. */
#include "base/memory.h"
#include "scene/build.h"

#include <math.h>

static const char *const kinds[] = {[LOAD_TRACTION] = "a traction",
                                    [LOAD_BODY_FORCE] = "a body force",
                                    [LOAD_MOMENT_TENSOR] = "a moment tensor"};

/* The two axes of a box face in the order of the axes (one in 2D, none in 1D); how many there are. */
static int axes_of_face(enum face face, int dimension, int axes[2])
{
    int count = 0;
    for (int c = 0; c < dimension; c++)
        if (c != face_axis(face)) axes[count++] = c;
    return count;
}

static bool read_size(struct builder *builder, const struct deck_group *group, struct load *load)
{
    const size_t count = deck_values(group, "size");
    const size_t wanted = load->shape == LOAD_DISC ? 1 : (size_t)builder->scene->dimension - 1;
    if (count != wanted) {
        complain(builder, group, count == 0 ? NULL : "size",
                 "shape '%s' has %zu value%s of size; expected %zu: %s", deck_text(group, "shape", 0), count,
                 count == 1 ? "" : "s", wanted,
                 load->shape == LOAD_DISC ? "the diameter" : "the edges along the axes of the face");
        return false;
    }
    for (size_t i = 0; i < count; i++)
        load->size[i] = deck_real(group, "size", i);
    return true;
}

static double half_patch(const struct load *load, int edge)
{
    if (load->shape == LOAD_POINT) return 0;
    return load->size[load->shape == LOAD_DISC ? 0 : edge] / 2;
}

/* Does a moving patch, now at `place` of the body's frame, come over the face before the end? */
static bool comes_by(const struct builder *builder, const struct load *load, const double place[3])
{
    const struct body *body = &builder->scene->body;
    double velocity[3], from = 0, to = builder->scene->end_time;
    int axes[2];
    const int count = axes_of_face(load->face, builder->scene->dimension, axes);
    body_direction_from_deck(body, load->velocity, velocity);
    for (int i = 0; i < count; i++) {
        const int axis = axes[i];
        const double half = half_patch(load, i), speed = velocity[axis];
        const double low = body->low[axis] - half - place[axis], high = body->high[axis] + half - place[axis];
        if (speed == 0 && (low > 0 || high < 0)) return false;
        if (speed == 0) continue;
        from = fmax(from, speed > 0 ? low / speed : high / speed);
        to = fmin(to, speed > 0 ? high / speed : low / speed);
    }
    return from < to;
}

/* The centre must lie in the plane of the face, where it is then put exactly, and the patch must cover some
 * of the face, if it moves at some time. */
static void place_patch(struct builder *builder, const struct deck_group *group, struct load *load)
{
    const struct body *body = &builder->scene->body;
    const int axis = face_axis(load->face), dimension = builder->scene->dimension;
    const double plane = face_plane(body, load->face);
    double place[3], beyond[2] = {0, 0};
    char text[VECTOR_TEXT_SIZE];
    int axes[2];
    const double asked[3] = {load->centre[0], load->centre[1], load->centre[2]};
    body_from_deck(body, load->centre, place);
    const bool off = fabs(place[axis] - plane) > body_tolerance(body);
    place[axis] = plane;
    body_to_deck(body, place, load->centre);
    if (off) {
        complain(
            builder, group, "centre",
            "the centre lies %.6g off the face '%s'; the nearest place on its plane is %s",
            hypot(hypot(load->centre[0] - asked[0], load->centre[1] - asked[1]), load->centre[2] - asked[2]),
            face_name(load->face), vector_text(text, load->centre, dimension));
        return;
    }
    const int count = axes_of_face(load->face, dimension, axes);
    for (int i = 0; i < count; i++)
        beyond[i] = fmax(0, fmax(body->low[axes[i]] - place[axes[i]], place[axes[i]] - body->high[axes[i]]));
    const double tolerance = body_tolerance(body);
    bool misses = false;
    if (load_moves(load))
        misses = !comes_by(builder, load, place);
    else if (load->shape == LOAD_POINT)
        misses = hypot(beyond[0], beyond[1]) > tolerance;
    else if (load->shape == LOAD_DISC)
        misses = hypot(beyond[0], beyond[1]) >= load->size[0] / 2 - tolerance;
    else
        for (int i = 0; i < count; i++)
            misses = misses || beyond[i] >= load->size[i] / 2 - tolerance;
    if (misses)
        complain(builder, group, "centre",
                 "the load lies beyond the face '%s'%s; no part of it acts on the body",
                 face_name(load->face), load_moves(load) ? " until the end of the run" : "");
}

static void read_velocity(struct builder *builder, const struct deck_group *group, struct load *load)
{
    double own[3];
    if (!take_vector(builder, group, "velocity", load->velocity) || !builder->body_known) return;
    body_direction_from_deck(&builder->scene->body, load->velocity, own);
    if (load->shape == LOAD_FACE)
        complain(builder, group, "velocity", "a load on a whole face cannot move");
    else if (fabs(own[face_axis(load->face)]) > 1e-9 * hypot(hypot(own[0], own[1]), own[2]))
        complain(builder, group, "velocity", "the velocity leads off the face '%s'; expected one along it",
                 face_name(load->face));
}

/* A load on a face whose motion is held does no work there. */
static void warn_of_held_face(struct builder *builder, const struct deck_group *group,
                              const struct load *load)
{
    const struct boundary *boundary = &builder->scene->boundary[load->face];
    double own[3];
    body_direction_from_deck(&builder->scene->body, load->direction, own);
    const double normal = fabs(own[face_axis(load->face)]);
    const bool slides = boundary_slides(boundary);
    if (boundary_is_fixed(boundary) || (slides && normal > 0) ||
        (boundary_moves(boundary) && !boundary->slip))
        deck_warning(
            builder->deck, group, "face", builder->messages,
            "the load acts on the face '%s', whose motion &boundary %zu prescribes%s; it does nothing "
            "there",
            face_name(load->face), boundary->group + 1, slides ? " along the normal" : "");
}

static void read_traction(struct builder *builder, const struct deck_group *group, struct load *load)
{
    static const char *const patch_words[] = {"centre", "depth", "size", NULL};
    static const char *const size_words[] = {"size", NULL};
    const int dimension = builder->scene->dimension;
    bool known = builder->body_known;
    if (deck_values(group, "face") == 0) {
        complain(builder, group, NULL, "a traction needs face: x-, x+, y-, y+, z-, z+ or hole");
        return;
    }
    load->face = (enum face)deck_choice(group, "face", 0);
    const bool hole = load->face == FACE_HOLE && builder->scene->body.shape == BODY_PLATE_WITH_HOLE;
    if (!hole && (load->face == FACE_HOLE || face_axis(load->face) >= dimension)) {
        complain(builder, group, "face", "no traction can act on a face '%s' of this body%s",
                 face_name(load->face),
                 dimension == 2   ? "; expected one of 'x-', 'x+', 'y-', 'y+'"
                 : dimension == 1 ? "; expected 'x-' or 'x+'"
                                  : "");
        return;
    }
    if (builder->scene->body.chosen && load->face != (enum face)(2 * (dimension - 1))) {
        complain(builder, group, "face",
                 "a half-space has one face, '%s'; at '%s' the box of points ends, which is chosen",
                 face_name((enum face)(2 * (dimension - 1))), face_name(load->face));
        return;
    }
    if (deck_values(group, "shape") == 0 && dimension > 1) {
        complain(builder, group, NULL, "a traction needs shape; expected one of" LOAD_SHAPES(CHOICE_QUOTED));
        return;
    }
    load->shape = LOAD_FACE; /* the end of a bar in 1D is a whole face whatever the shape */
    if (dimension > 1) load->shape = (enum load_shape)deck_choice(group, "shape", 0);
    if (hole && load->shape != LOAD_FACE) {
        complain(builder, group, "shape", "a traction on the hole acts on all of it; expected 'face'");
        return;
    }
    read_velocity(builder, group, load);
    if (load->shape == LOAD_FACE) {
        refuse(builder, group, patch_words, dimension == 1 ? "a traction in 1D" : "shape 'face'");
        if (known && !hole) { /* for those who want one: the middle of the face */
            const struct body *body = &builder->scene->body;
            double middle[3] = {body->pivot[0], body->pivot[1], body->pivot[2]};
            middle[face_axis(load->face)] = face_plane(body, load->face);
            body_to_deck(body, middle, load->centre);
        }
    } else {
        known = need_place(builder, group, "centre", "a traction on a patch", load->centre) && known;
        if (load->shape == LOAD_POINT)
            refuse(builder, group, size_words, "shape 'point'");
        else
            known = read_size(builder, group, load) && known;
        if (known) place_patch(builder, group, load);
    }
    if (need_direction(builder, group, "direction", kinds[load->kind], load->direction) &&
        builder->body_known && !hole)
        warn_of_held_face(builder, group, load);
}

static bool place_inside(struct builder *builder, const struct deck_group *group, struct load *load)
{
    char text[VECTOR_TEXT_SIZE];
    double nearest[3];
    if (!need_place(builder, group, "centre", kinds[load->kind], load->centre) || !builder->body_known)
        return false;
    if (body_holds(&builder->scene->body, builder->scene->dimension, load->centre, nearest)) return true;
    complain(builder, group, "centre", "the centre lies outside the body; the nearest place of its box is %s",
             vector_text(text, nearest, builder->scene->dimension));
    return false;
}

static void read_body_force(struct builder *builder, const struct deck_group *group, struct load *load)
{
    static const char *const other_words[] = {"face", "size", "moment", "mechanism", "velocity", NULL};
    static const char *const place_words[] = {"centre", "depth", NULL};
    refuse(builder, group, other_words, kinds[load->kind]);
    load->shape = LOAD_FACE; /* over the whole body */
    if (deck_values(group, "shape") > 0) {
        load->shape = (enum load_shape)deck_choice(group, "shape", 0);
        if (load->shape != LOAD_POINT && load->shape != LOAD_FACE)
            complain(builder, group, "shape",
                     "a body force acts over the whole body (no shape, or 'face') or at a 'point'");
    }
    if (load->shape == LOAD_POINT)
        place_inside(builder, group, load);
    else
        refuse(builder, group, place_words,
               "a body force over the whole body (a force at a place has shape 'point')");
    need_direction(builder, group, "direction", kinds[load->kind], load->direction);
}

/* Eq S11a of doc/reference/scene.md for M_0 = 1. */
static void couple_of(const double angle[3], double moment[6])
{
    double sine[3], cosine[3], sine_2[3], cosine_2[3];
    for (int i = 0; i < 3; i++) {
        sine_of(angle[i], &sine[i], &cosine[i]);
        sine_of(2 * angle[i], &sine_2[i], &cosine_2[i]);
    }
    enum { STRIKE, DIP, RAKE };
    const double along = sine[DIP] * cosine[RAKE], across = sine_2[DIP] * sine[RAKE];
    const double turned = cosine[DIP] * cosine[RAKE], risen = cosine_2[DIP] * sine[RAKE];
    moment[0] = -along * sine_2[STRIKE] - across * sine[STRIKE] * sine[STRIKE];
    moment[1] = along * sine_2[STRIKE] - across * cosine[STRIKE] * cosine[STRIKE];
    moment[2] = across;
    moment[3] = along * cosine_2[STRIKE] + across * sine_2[STRIKE] / 2;
    moment[4] = -turned * sine[STRIKE] + risen * cosine[STRIKE];
    moment[5] = -turned * cosine[STRIKE] - risen * sine[STRIKE];
}

static void read_mechanism(struct builder *builder, const struct deck_group *group, double moment[6])
{
    const size_t count = deck_values(group, "mechanism");
    double angle[3];
    if (deck_given(group, "moment"))
        complain(builder, group, "mechanism", "expected moment or mechanism, not both");
    else if (builder->scene->dimension < 3)
        complain(builder, group, "mechanism", "a mechanism needs scene%%dimension = 3; expected moment");
    else if (count != 3)
        complain(builder, group, "mechanism", "mechanism has %zu value%s; expected 3: strike, dip, rake",
                 count, count == 1 ? "" : "s");
    for (size_t i = 0; i < 3 && count == 3; i++)
        angle[i] = deck_real(group, "mechanism", i);
    if (count == 3 && (angle[1] < 0 || angle[1] > 90))
        complain(builder, group, "mechanism",
                 "a dip of %g degrees; expected one in [0, 90]: strike, dip, rake", angle[1]);
    if (count == 3) couple_of(angle, moment);
}

static void read_moment(struct builder *builder, const struct deck_group *group, double moment[6])
{
    const size_t count = deck_values(group, "moment");
    if (count != 6) {
        complain(builder, group, count == 0 ? NULL : "moment",
                 "a moment tensor has %zu value%s of moment; expected 6: xx yy zz xy yz zx%s", count,
                 count == 1 ? "" : "s", count == 0 ? ", or mechanism: strike, dip, rake" : "");
        return;
    }
    bool zero = true;
    for (size_t i = 0; i < 6; i++) {
        moment[i] = deck_real(group, "moment", i);
        zero = zero && moment[i] == 0;
        const bool beyond = builder->scene->dimension < 2 ? i > 0 : i == 2 || i > 3;
        if (builder->scene->dimension < 3 && beyond && moment[i] != 0)
            complain(builder, group, "moment", "moment has components beyond the scene's %s must be 0",
                     builder->scene->dimension == 1 ? "1 dimension: all but xx"
                                                    : "2 dimensions: zz, yz and zx");
    }
    if (zero) complain(builder, group, "moment", "moment is zero; expected a component that is not");
}

static void read_moment_tensor(struct builder *builder, const struct deck_group *group, struct load *load)
{
    static const char *const other_words[] = {"face", "size", "direction", "shape", "velocity", NULL};
    refuse(builder, group, other_words, kinds[load->kind]);
    load->shape = LOAD_POINT;
    place_inside(builder, group, load);
    if (deck_given(group, "mechanism"))
        read_mechanism(builder, group, load->moment);
    else
        read_moment(builder, group, load->moment);
}

static void read_load(struct builder *builder, size_t index, const struct point_sources *sources,
                      struct load *load)
{
    static const char *const moment_words[] = {"moment", "mechanism", NULL};
    const struct deck_group *group = deck_get(builder->deck, "load", index);
    load->group = index;
    take_name(builder, group, "name", load->name);
    load->kind = (enum load_kind)deck_choice(group, "kind", 0);
    load->amplitude = deck_real(group, "amplitude", 0);
    if (deck_given(group, "sources")) {
        take_history(builder, group, kinds[load->kind], &load->history);
        read_sources(builder, group, sources, load);
        return;
    }
    if (load->kind == LOAD_TRACTION) {
        refuse(builder, group, moment_words, kinds[load->kind]);
        read_traction(builder, group, load);
    } else if (load->kind == LOAD_BODY_FORCE) {
        read_body_force(builder, group, load);
    } else {
        read_moment_tensor(builder, group, load);
    }
    take_history(builder, group, kinds[load->kind], &load->history);
}

void build_loads(struct builder *builder)
{
    struct scene *scene = builder->scene;
    const size_t groups = deck_count(builder->deck, "load");
    if (groups == 0) return;
    struct point_sources *sources = scene_array(builder, groups, sizeof *sources);
    size_t count = 0;
    for (size_t i = 0; i < groups && sources != NULL; i++) {
        const struct deck_group *group = deck_get(builder->deck, "load", i);
        if (deck_given(group, "sources"))
            sources[i] = take_sources(builder, group, (enum load_kind)deck_choice(group, "kind", 0));
        count += sources[i].count > 0 ? sources[i].count : 1;
    }
    if (sources != NULL) scene->load = scene_array(builder, count, sizeof *scene->load);
    if (scene->load != NULL) scene->loads = count;
    for (size_t i = 0, at = 0; i < groups && sources != NULL; i++) {
        if (scene->load != NULL) read_load(builder, i, &sources[i], &scene->load[at]);
        at += sources[i].count > 0 ? sources[i].count : 1;
        point_sources_free(&sources[i]);
    }
    array_free(sources);
}
