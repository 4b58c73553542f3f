/* What each group and kind acts on or looks at (see the header). A kind that is missing in a switch does not
 * compile (-Wswitch, an error in CI); a group that is missing in the table below fails test_extent. */
#include "scene/extent.h"

#include "scene/topography.h"

#include <math.h>
#include <string.h>

/* A Gaussian of width w ends here: exp(-5^2 / 2) = 4e-6. */
static const double gaussian_end = 5;
/* A hill's profile ends here: exp(-3.5^2 / 2) = .002. */
static const double shape_end = 4.0;
/* Root mean square frequency of a Gaussian's slope over that of the Gaussian itself. */
static const double slope_over_value = 1.7320508075688772;

/* Sets the place to nothing, for widen(). */
static void begin_place(struct extent *extent)
{
    for (int c = 0; c < 3; c++) {
        extent->low[c] = INFINITY;
        extent->high[c] = -INFINITY;
    }
}

/* Takes a place of the deck, with as much on both sides along each axis of the body, into the extent. */
static void widen(const struct scene *scene, const double position[3], const double half[3],
                  struct extent *extent)
{
    double place[3];
    body_from_deck(&scene->body, position, place);
    for (int c = 0; c < 3; c++) {
        extent->low[c] = fmin(extent->low[c], place[c] - half[c]);
        extent->high[c] = fmax(extent->high[c], place[c] + half[c]);
    }
}

/* P wavelength at the root mean square frequency of f'. */
static double wavelength_of(const struct scene *scene, const struct history *history)
{
    if (!(history->rate > 0)) return INFINITY; /* a host's, or one that never changes */
    return 2 * M_PI * scene_fastest(scene) / history->rate;
}

/* --- What acts ------------------------------------------------------------------------------------------ */

/* All loads of one &load (a file of sources has many) are one extent; they stand side by side. */
static size_t count_loads(const struct scene *scene)
{
    const size_t loads = scene_deck_loads(scene);
    return loads > 0 ? scene->load[loads - 1].group + 1 : 0;
}

/* The first load of a group or of one after it. */
static size_t first_of_group(const struct scene *scene, size_t group)
{
    size_t first = 0, past = scene_deck_loads(scene);
    while (first < past) {
        const size_t middle = first + (past - first) / 2;
        if (scene->load[middle].group < group)
            first = middle + 1;
        else
            past = middle;
    }
    return first;
}

static bool is_surface(const struct scene *scene, enum face face)
{
    return (int)face == 2 * (scene->dimension - 1);
}

/* Along the normal of a level surface; no other has one. */
static bool along_normal(const struct scene *scene, const double direction[3])
{
    double own[3];
    if (scene->body.topography != NULL) return false;
    body_direction_from_deck(&scene->body, direction, own);
    return fabs(own[scene->dimension - 1]) > 1 - 1e-9;
}

/* Is a load at its own centre another one than its mirror image across an axis? */
static bool is_skew(const struct scene *scene, const struct load *load, int axis)
{
    static const int shear[3][2] = {{3, 5}, {3, 4}, {4, 5}}; /* of xx yy zz xy yz zx */
    double own[3];
    if (load->kind == LOAD_MOMENT_TENSOR)
        return scene->body.rotated || load->moment[shear[axis][0]] != 0 || load->moment[shear[axis][1]] != 0;
    body_direction_from_deck(&scene->body, load->direction, own);
    return own[axis] != 0;
}

/* Where a load of a place of its own acts, wherever it moves to. */
static void widen_by_load(const struct scene *scene, const struct load *load, struct extent *extent)
{
    double half[3] = {0}, end[3];
    int side = 0;
    for (int c = 0; c < scene->dimension; c++) {
        if (load->shape == LOAD_DISC && c != face_axis(load->face)) half[c] = load->size[0] / 2;
        if (load->shape == LOAD_SQUARE && c != face_axis(load->face)) half[c] = load->size[side++] / 2;
    }
    for (int c = 0; c < 3; c++)
        end[c] = load->centre[c] + load->velocity[c] * scene->end_time;
    widen(scene, load->centre, half, extent);
    widen(scene, end, half, extent);
}

static void state_load(const struct scene *scene, size_t index, struct extent *extent)
{
    const size_t first = first_of_group(scene, index), past = first_of_group(scene, index + 1);
    const struct load *load = &scene->load[first];
    if (first == past) return;
    extent->role = EXTENT_ACTS;
    extent->wavelength = wavelength_of(scene, &load->history);
    extent->lasts = load->history.lasts;
    extent->middle = load->history.middle;
    switch (load->shape) {
    case LOAD_FACE:
        extent->plane = load->kind == LOAD_TRACTION && is_surface(scene, load->face) &&
                        along_normal(scene, load->direction);
        return; /* wherever the body is */
    case LOAD_SQUARE:
    case LOAD_DISC:
    case LOAD_POINT:
        break;
    }
    extent->dipole = load->kind == LOAD_MOMENT_TENSOR;
    begin_place(extent);
    for (size_t k = first; k < past; k++)
        widen_by_load(scene, &scene->load[k], extent);
    for (int c = 0; c < 3; c++)
        extent->skew[c] = past - first > 1 || is_skew(scene, load, c);
}

static size_t count_faces(const struct scene *scene)
{
    return 2 * (size_t)scene->dimension;
}

static void state_face(const struct scene *scene, size_t index, struct extent *extent)
{
    const struct boundary *boundary = &scene->boundary[index];
    if (!boundary_moves(boundary)) return;
    extent->role = EXTENT_ACTS;
    extent->index = boundary->group;
    extent->wavelength = wavelength_of(scene, &boundary->history);
    extent->plane = is_surface(scene, (enum face)index) && along_normal(scene, boundary->direction);
}

static size_t count_initial(const struct scene *scene)
{
    (void)scene;
    return 1;
}

static void state_initial(const struct scene *scene, size_t index, struct extent *extent)
{
    const struct initial *initial = &scene->initial;
    const double wide = gaussian_end * initial->width, half[3] = {wide, wide, wide};
    (void)index;
    extent->role = EXTENT_ACTS;
    extent->wavelength = 2 * M_PI * initial->width * sqrt(2.) / slope_over_value;
    switch (initial->kind) {
    case INITIAL_REST:
        extent->role = EXTENT_IDLE;
        return;
    case INITIAL_GAUSSIAN:
        begin_place(extent);
        widen(scene, initial->centre, half, extent);
        return;
    case INITIAL_PLANE_WAVE:
        extent->plane = !initial->shear && initial->width > 0 && along_normal(scene, initial->direction);
        if (extent->plane) {
            double place[3];
            const int down = scene->dimension - 1;
            body_from_deck(&scene->body, initial->centre, place);
            extent->low[down] = place[down] - wide;
            extent->high[down] = place[down] + wide;
        } else {
            extent->wavelength = initial->wavelength;
        }
        return;
    case INITIAL_UNIFORM_VELOCITY:
    case INITIAL_BEAM_MODE:
        extent->wavelength = INFINITY;
        return;
    }
}

/* --- What is looked at ---------------------------------------------------------------------------------- */

static const double nothing[3] = {0};

static size_t count_receivers(const struct scene *scene)
{
    return scene->receivers;
}

static void state_receiver(const struct scene *scene, size_t index, struct extent *extent)
{
    extent->role = EXTENT_SEEN;
    begin_place(extent);
    widen(scene, scene->receiver[index].position, nothing, extent);
}

static size_t count_profiles(const struct scene *scene)
{
    return scene->profiles;
}

static void state_profile(const struct scene *scene, size_t index, struct extent *extent)
{
    const struct profile *profile = &scene->profile[index];
    extent->role = EXTENT_SEEN;
    extent->until = profile->time[profile->times - 1];
    begin_place(extent);
    widen(scene, profile->from, nothing, extent);
    widen(scene, profile->to, nothing, extent);
}

static size_t count_snapshots(const struct scene *scene)
{
    return scene->snapshots;
}

static void state_snapshot(const struct scene *scene, size_t index, struct extent *extent)
{
    const struct snapshot *snapshot = &scene->snapshot[index];
    extent->role = EXTENT_SEEN;
    if (snapshot->times > 0) extent->until = snapshot->time[snapshot->times - 1];
    if (snapshot->whole) return;
    begin_place(extent);
    for (int corner = 0; corner < 8; corner++) {
        double place[3];
        for (int c = 0; c < 3; c++)
            place[c] = corner >> c & 1 ? snapshot->region_high[c] : snapshot->region_low[c];
        if (scene->body.topography != NULL) topography_to_deck(scene->body.topography, place);
        widen(scene, place, nothing, extent);
    }
}

/* A host looks at the motion under its loads: those with a name, and all where the deck looks at nothing. */
static void state_patch(const struct scene *scene, size_t index, struct extent *extent)
{
    const struct load *load = &scene->load[first_of_group(scene, index)];
    const bool looked = scene->receivers + scene->profiles + scene->snapshots > 0;
    state_load(scene, index, extent);
    if (extent->role == EXTENT_IDLE) return;
    extent->role = !isinf(extent->low[0]) && (load->name[0] != '\0' || !looked) ? EXTENT_SEEN : EXTENT_IDLE;
    extent->dipole = extent->plane = false;
}

/* What a block sends back has to be in the box: it is held as if it were looked at. */
static size_t count_blocks(const struct scene *scene)
{
    return scene->body.blocks;
}

static void state_block(const struct scene *scene, size_t index, struct extent *extent)
{
    const struct ground_block *block = &scene->body.block[index];
    double half[3] = {0};
    for (int c = 0; c < scene->dimension; c++)
        half[c] = block->half[c];
    extent->role = EXTENT_SEEN;
    begin_place(extent);
    widen(scene, block->centre, half, extent);
}

/* A hill, ridge or canyon is in the box as far as 4 times its width; a file's heights only need to reach as far
 * as the box. */
static size_t count_topography(const struct scene *scene)
{
    return scene->body.topography != NULL && scene->body.topography->map == NULL ? 1 : 0;
}

static void state_topography(const struct scene *scene, size_t index, struct extent *extent)
{
    const struct topography *topography = scene->body.topography;
    (void)index;
    extent->role = EXTENT_SEEN;
    begin_place(extent);
    for (int axis = 0; axis < topography->axis; axis++) {
        extent->low[axis] = topography->centre[axis] - shape_end * topography->width;
        extent->high[axis] = topography->centre[axis] + shape_end * topography->width;
    }
    extent->low[topography->axis] = extent->high[topography->axis] = topography->plane;
}

/* --- All of them ---------------------------------------------------------------------------------------- */

static const struct kind {
    const char *group;
    size_t (*count)(const struct scene *scene); /* NULL: neither acts nor looks */
    void (*state)(const struct scene *scene, size_t index, struct extent *extent);
} kinds[] = {
    {"load", count_loads, state_load},
    {"boundary", count_faces, state_face},
    {"initial", count_initial, state_initial},
    {"receiver", count_receivers, state_receiver},
    {"profile", count_profiles, state_profile},
    {"snapshot", count_snapshots, state_snapshot},
    {"load", count_loads, state_patch},
    {"scene", NULL, NULL},
    {"method", NULL, NULL},
    {"stepping", NULL, NULL},
    {"material", NULL, NULL},
    {"body", NULL, NULL},
    {"layer", NULL, NULL},
    {"block", count_blocks, state_block},
    {"model", NULL, NULL}, /* in boxes that the deck gives */
    {"topography", count_topography, state_topography},
    {"output", NULL, NULL},
    {"reference", NULL, NULL}, /* its histories are those of receivers */
};
enum { KINDS = sizeof kinds / sizeof *kinds };

bool extent_stated(const char *group)
{
    for (size_t k = 0; k < KINDS; k++)
        if (strcmp(kinds[k].group, group) == 0) return true;
    return false;
}

bool scene_extent(const struct scene *scene, size_t index, struct extent *extent)
{
    for (size_t k = 0; k < KINDS; k++) {
        const size_t count = kinds[k].count != NULL ? kinds[k].count(scene) : 0;
        if (index >= count) {
            index -= count;
            continue;
        }
        *extent = (struct extent){.group = kinds[k].group,
                                  .index = index,
                                  .low = {-INFINITY, -INFINITY, -INFINITY},
                                  .high = {INFINITY, INFINITY, INFINITY},
                                  .until = scene->end_time,
                                  .wavelength = INFINITY};
        kinds[k].state(scene, index, extent);
        return true;
    }
    return false;
}
