/* The box of a half-space whose deck gives no low and high: the smallest that holds all that acts and all that
 * is looked at (extent.h) with absorbing layers around it, or the one so large that nothing comes back from its
 * faces while anybody looks, whichever has less to compute. What has no such box is refused. */
#include "base/memory.h"
#include "scene/absorbing_layers.h"
#include "scene/build.h"
#include "scene/echo.h"
#include "scene/extent.h"
#include "scene/ground.h"
#include "scene/topography.h"

#include <math.h>
#include <stdio.h>

/* A right answer may cost so many times as much as one that is warned of. */
static const double worth = 10;
/* Points between what the box holds and a layer and depth of the box in points, at least. */
enum { MARGIN = 4, LEAST_DEPTH = 12 };

struct span {
    double low, high;
};

static void widen(struct span *span, double low, double high)
{
    span->low = fmin(span->low, low);
    span->high = fmax(span->high, high);
}

struct held { /* what the box has to hold */
    struct span all[3], load[3], dipole[3];
    bool one_centre[3]; /* all that acts has the same centre along this axis and is symmetric about it */
    double centre[3];
    bool plane, whole; /* all moves along the depth alone; the whole body is looked at */
    size_t acts, seen;
    double deepest; /* as far down as that waves of layers come back in time, and the lattice is level */
};

static double deepest_layer(const struct builder *builder, const struct held *held,
                            const struct span large[3])
{
    const int down = builder->scene->dimension - 1;
    double depth = 0.0, away = 0.0;
    for (int c = 0; c < down; c++)
        away = hypot(away, fmax(-large[c].low, large[c].high));
    for (size_t k = 0; k < deck_count(builder->deck, "layer"); k++) {
        const struct deck_group *group = deck_get(builder->deck, "layer", k);
        const double top = deck_real(group, "top", 0), dip = deck_real(group, "dip", 0) * M_PI / 180;
        const bool late = held->acts > 0 && held->seen > 0 && top - tan(dip) * away > large[down].high;
        if (held->whole || !late) depth = fmax(depth, top);
    }
    return depth;
}

static bool tilted(const struct builder *builder)
{
    for (size_t k = 0; k < deck_count(builder->deck, "layer"); k++)
        if (deck_real(deck_get(builder->deck, "layer", k), "dip", 0) != 0) return true;
    return false;
}

/* --- What has a box ------------------------------------------------------------------------------------- */

static bool refuse_box(struct builder *builder, const char *group, size_t index, const char *name,
                       const char *why)
{
    complain(builder, deck_get(builder->deck, group, index), name,
             "%s; give the box of the half-space (body%%low and high) and say what its faces do", why);
    return false;
}

/* Faces of a box that the program chooses stand anywhere: only those that let waves out may be named, and beside
 * what acts alike all over the surface, whose waves run along the sides, rollers. */
static bool faces_fit(struct builder *builder, const struct scene *sketch, bool plane)
{
    const int top = 2 * sketch->dimension - 2;
    for (int face = 0; face < 2 * sketch->dimension; face++) {
        const struct boundary *boundary = &sketch->boundary[face];
        const bool beside = plane && face < top;
        if (face == top || !boundary->given) continue;
        if (beside ? boundary->kind == BOUNDARY_ROLLER : boundary_absorbs(boundary)) continue;
        char why[160];
        snprintf(why, sizeof why,
                 beside
                     ? "what acts all over the surface sends waves along face '%s', where only a roller lets "
                       "them pass"
                     : "the place of face '%s' is not known, and what this one does depends on it",
                 face_name((enum face)face));
        return refuse_box(builder, "boundary", boundary->group, "kind", why);
    }
    return true;
}

/* Everything that acts has a place, or acts alike all over the surface and nothing else does. */
static bool sources_fit(struct builder *builder, const struct scene *sketch, const struct held *held)
{
    struct extent extent;
    for (size_t i = 0; scene_extent(sketch, i, &extent); i++) {
        if (extent.role != EXTENT_ACTS) continue;
        for (int axis = 0; held->plane && axis < sketch->dimension - 1; axis++)
            if (ground_varies(sketch, axis))
                return refuse_box(
                    builder, extent.group, extent.index, NULL,
                    "this one acts all over the surface of ground that varies along it: no sides are right "
                    "for "
                    "that; a box (shape = 'box') with rollers at its sides, far enough off, would do");
        if (held->plane && !extent.plane)
            return refuse_box(
                builder, extent.group, extent.index, NULL,
                "this one has a place, beside others that act all over the surface: no sides are "
                "right for both");
        if (extent.plane || !isinf(extent.low[0])) continue;
        complain(builder, deck_get(builder->deck, extent.group, extent.index), NULL,
                 "what acts here has no end, and is not alike all over the surface along its normal, where "
                 "rollers at the sides would do; a body of shape 'box' has sides of its own");
        return false;
    }
    return true;
}

static void add(struct held *held, const struct extent *extent, int dimension)
{
    held->acts += extent->role == EXTENT_ACTS;
    held->seen += extent->role == EXTENT_SEEN;
    if (extent->role == EXTENT_SEEN && isinf(extent->low[0])) held->whole = true;
    if (extent->role == EXTENT_ACTS && extent->plane) held->plane = true;
    for (int c = 0; c < dimension; c++) {
        if (isinf(extent->low[c])) continue;
        widen(&held->all[c], extent->low[c], extent->high[c]);
        if (extent->role != EXTENT_ACTS) continue;
        const double centre = 0.5 * (extent->low[c] + extent->high[c]);
        if (extent->skew[c]) held->one_centre[c] = false;
        if (held->load[c].low > held->load[c].high) /* the first */
            held->centre[c] = centre;
        else if (fabs(centre - held->centre[c]) > 1e-9 * (fabs(centre) + extent->high[c] - extent->low[c]))
            held->one_centre[c] = false;
        widen(&held->load[c], extent->low[c], extent->high[c]);
        if (extent->dipole) widen(&held->dipole[c], extent->low[c], extent->high[c]);
    }
}

static struct held find_held(const struct scene *sketch)
{
    struct held held = {0};
    struct extent extent;
    for (int c = 0; c < 3; c++) {
        held.all[c] = held.load[c] = held.dipole[c] = (struct span){INFINITY, -INFINITY};
        held.one_centre[c] = true;
    }
    for (size_t i = 0; scene_extent(sketch, i, &extent); i++)
        if (extent.role != EXTENT_IDLE) add(&held, &extent, sketch->dimension);
    for (int c = 0; c < 3; c++)
        if (held.all[c].low > held.all[c].high) held.all[c] = (struct span){0, 0};
    if (held.plane) /* whatever the width, the waves are the same */
        for (int c = 0; c < sketch->dimension - 1; c++)
            held.centre[c] = 0.5 * (held.all[c].low + held.all[c].high);
    return held;
}

/* --- Two boxes ------------------------------------------------------------------------------------------ */

/* Puts the box on the lattice of the first load's centre, symmetric about it where all have one centre, which
 * allows mirror planes. */
static void put(const struct scene *scene, const struct held *held, const struct span want[3],
                struct body *body)
{
    const double dx = scene->body.spacing;
    const int down = scene->dimension - 1;
    for (int c = 0; c < scene->dimension; c++) {
        const double centre = c == down ? 0 : held->centre[c];
        double up = ceil((want[c].high - centre) / dx - 1e-6);
        double back = c == down ? 0 : ceil((centre - want[c].low) / dx - 1e-6);
        if (c != down && held->one_centre[c]) up = back = fmax(up, back);
        body->low[c] = centre - back * dx;
        body->high[c] = centre + up * dx;
    }
}

/* So large that nothing comes back: (X - load) + (X - seen) >= c_p (until - from) for all pairs. */
static void fit_large(const struct builder *builder, struct held *held, struct scene *sketch)
{
    const double dx = sketch->body.spacing, speed = scene_first(sketch);
    const int down = sketch->dimension - 1;
    struct span want[3] = {{0, 0}};
    struct extent seen, acts;
    for (int c = 0; c < sketch->dimension; c++)
        want[c] = (struct span){held->all[c].low - dx, held->all[c].high + dx};
    for (size_t k = 0; scene_extent(sketch, k, &acts); k++)
        for (size_t i = 0; acts.role == EXTENT_ACTS && scene_extent(sketch, i, &seen); i++)
            for (int c = 0; seen.role == EXTENT_SEEN && c < sketch->dimension; c++) {
                const double reach = speed * (seen.until - acts.from);
                if (isinf(seen.low[c]) || (held->plane && c < down)) continue;
                const double above = isinf(acts.high[c]) ? 0 : acts.high[c];
                const double below = isinf(acts.low[c]) ? 0 : acts.low[c];
                widen(&want[c], 0.5 * (below + seen.low[c] - reach), 0.5 * (above + seen.high[c] + reach));
            }
    held->deepest = deepest_layer(builder, held, want);
    if (sketch->body.topography != NULL) held->deepest = fmax(held->deepest, sketch->body.topography->depth);
    want[down].high = fmax(want[down].high, held->deepest + MARGIN * dx);
    put(sketch, held, want, &sketch->body);
}

/* Absorbing layers make the surface level before and behind them: not enough to matter in the large box. */
static bool level_there(struct scene *sketch, const struct body *large)
{
    const struct topography *topography = sketch->body.topography;
    if (topography == NULL) return true;
    topography_draw_out(sketch);
    const double changed = topography_changed(topography, large->spacing, large->low, large->high);
    return topography_levelled(sketch, changed) <= TOPOGRAPHY_LEVELLED;
}

/* Do a file's heights reach as far? */
static bool heights_reach(const struct body *large)
{
    const struct topography *topography = large->topography;
    bool reach = true;
    for (int axis = 0; topography != NULL && topography->map != NULL && axis < topography->axis; axis++) {
        double low, high;
        height_map_extent(topography->map, axis, &low, &high);
        reach = reach && low <= large->low[axis] && high >= large->high[axis];
    }
    return reach;
}

/* With absorbing layers: the cheapest of some distances, since layers nearer by have to be thicker; if there is one,
 * of those outside which the ground is level. */
static double fit_small(const struct builder *builder, const struct held *held, const struct body *large,
                        struct scene *sketch, bool *level)
{
    enum { TRIES = 16 };
    static const double wider = 1.25;
    const double dx = sketch->body.spacing;
    const int down = sketch->dimension - 1;
    double factor = 1.0, least = INFINITY;
    *level = false;
    struct body best = sketch->body;
    for (int face = 0; face < 2 * sketch->dimension; face++) {
        struct boundary *boundary = &sketch->boundary[face];
        if (face == 2 * down || boundary->given) continue;
        boundary->kind = held->plane && face < 2 * down ? BOUNDARY_ROLLER : BOUNDARY_TRANSMITTING;
        boundary->absorber = sketch->body.dampers ? ABSORBER_LYSMER : ABSORBER_PML;
        boundary->least_points = builder->layer_points;
    }
    for (int i = 0; i < TRIES; i++, factor *= wider) {
        struct span want[3] = {{0, 0}};
        for (int c = 0; c < sketch->dimension; c++) {
            const double widest = c < down ? dx : dx * sketch->body.most_stretch;
            const double margin = (held->plane && c < down ? 1 : MARGIN * factor) * widest;
            const double room = c < down                         ? INFINITY
                                : body_is_layered(&sketch->body) ? 0
                                                                 : held->dipole[c].low / widest;
            const double clear = layer_clearance(sketch, room) * widest;
            want[c] = (struct span){held->all[c].low - margin, held->all[c].high + margin};
            widen(&want[c], held->dipole[c].low - clear, held->dipole[c].high + clear);
        }
        want[down].high = fmax(fmax(want[down].high, LEAST_DEPTH * factor * dx), held->deepest + MARGIN * dx);
        put(sketch, held, want, &sketch->body);
        const double here = scene_work(sketch);
        const bool now = level_there(sketch, large) && !tilted(builder);
        if (now == *level ? here >= least : *level) continue;
        best = sketch->body;
        least = here;
        *level = now;
    }
    sketch->body = best;
    return least;
}

static void keep(const struct body *found, const struct body *large, const struct held *held,
                 struct body *body)
{
    body->chosen = true;
    body->absorbing = found != large;
    body->plane = held->plane;
    body->dampers = large->dampers;
    for (int c = 0; c < 3; c++) {
        body->low[c] = found->low[c];
        body->high[c] = found->high[c];
        body->waves_low[c] = large->low[c];
        body->waves_high[c] = large->high[c];
    }
}

static bool choose(struct builder *builder, const struct deck_group *group, struct scene *sketch)
{
    struct held held = find_held(sketch);
    struct body *body = &builder->scene->body;
    const char *why = layers_refusal(sketch);
    if (held.acts + held.seen == 0) {
        complain(builder, group, NULL,
                 "a half-space without low and high is fitted around loads and receivers: give some");
        return false;
    }
    if (!faces_fit(builder, sketch, held.plane) || !sources_fit(builder, sketch, &held)) return false;
    for (int face = 0; face < 2 * sketch->dimension; face++)
        if (sketch->boundary[face].given && boundary_damps(&sketch->boundary[face]))
            why = why != NULL ? why : "the deck asks for dampers";
    sketch->body.dampers =
        held.plane && !ground_is_general(sketch) && !tilted(builder) && !ground_is_damped(sketch);
    fit_large(builder, &held, sketch);
    const struct body large = sketch->body;
    const double large_cost = held.whole ? INFINITY : scene_work(sketch);
    bool level = true;
    const double small_cost =
        why == NULL ? layer_steps(sketch) * fit_small(builder, &held, &large, sketch, &level) : INFINITY;
    if (!level && heights_reach(&large) && large_cost < worth * small_cost)
        why = tilted(builder) ? "tilted layers send waves back from beyond smaller ones"
                              : "absorbing layers would make a surface level that is not";
    if (builder->large != NULL && isfinite(large_cost) && why == NULL) why = builder->large;
    if (isinf(small_cost) && isinf(large_cost)) {
        char text[200];
        snprintf(text, sizeof text,
                 "the whole body is looked at, faces and all, and %s; give &snapshot a region", why);
        return refuse_box(builder, "body", 0, NULL, text);
    }
    keep(why == NULL && small_cost < large_cost ? &sketch->body : &large, &large, &held, body);
    if (held.whole)
        snprintf(body->choice, sizeof body->choice,
                 "absorbing layers around what is looked at: work as for %.3g points; all of the body is "
                 "looked at, so in no box would nothing return",
                 small_cost);
    else if (body->absorbing)
        snprintf(body->choice, sizeof body->choice,
                 "%s: work as for %.3g points, against %.3g in a box so large that nothing returns before "
                 "end_time",
                 body->dampers ? "a small box with dampers below it, which suit what moves along the "
                                 "depth alone"
                               : "absorbing layers around a small box",
                 small_cost, large_cost);
    else
        snprintf(body->choice, sizeof body->choice,
                 "so large that nothing returns to what is looked at: %.3g points%s%s", large_cost,
                 why != NULL ? "; " : ", less work than with absorbing layers", why != NULL ? why : "");
    return true;
}

/* Where layers of rock begin: beside them absorbing layers are thicker (echo.c). */
static void sketch_layers(struct builder *drawing)
{
    struct body *body = &drawing->scene->body;
    const size_t count = deck_count(drawing->deck, "layer");
    if (count == 0 || (body->layer = scene_array(drawing, count, sizeof *body->layer)) == NULL) return;
    for (body->layers = 0; body->layers < count; body->layers++)
        body->layer[body->layers].top = deck_real(deck_get(drawing->deck, "layer", body->layers), "top", 0);
}

/* The scene as far as it can be read without its box: what acts, what is looked at, what faces do. */
static bool sketch_scene(const struct builder *builder, struct scene *sketch)
{
    struct messages unsaid = {0}; /* the scene itself complains of all that is wrong */
    const struct scene *scene = builder->scene;
    struct builder drawing = *builder;
    drawing.scene = sketch;
    drawing.messages = &unsaid;
    drawing.status = SELAS_OK;
    drawing.body_known = false;
    sketch->deck = scene->deck;
    sketch->dimension = scene->dimension;
    sketch->end_time = scene->end_time;
    sketch->materials = scene->materials;
    sketch->material = scene->material;
    sketch->method = scene->method;
    sketch->stepping = scene->stepping;
    sketch->body.shape = BODY_HALF_SPACE;
    sketch->body.spacing = scene->body.spacing;
    sketch->body.most_stretch = scene->body.most_stretch;
    body_set_frame(&sketch->body);
    build_boundaries(&drawing);
    for (int face = 0; face < FACES; face++) /* those that nobody named are opened when the box is known */
        if (!sketch->boundary[face].given) sketch->boundary[face].kind = BOUNDARY_FREE;
    sketch_layers(&drawing);
    build_blocks(&drawing);
    build_topography(&drawing);
    build_loads(&drawing);
    build_initial(&drawing);
    build_receivers(&drawing);
    build_profiles(&drawing);
    build_snapshots(&drawing);
    messages_free(&unsaid);
    return drawing.status == SELAS_OK;
}

bool choose_half_space(struct builder *builder, const struct deck_group *group)
{
    struct scene *scene = builder->scene;
    if (scene->materials == 0 || !take_spacing(builder, group, &scene->body.spacing))
        return false; /* complained of elsewhere */
    if (deck_given(group, "rotation"))
        return refuse_box(builder, "body", 0, "rotation", "a body turns about the middle of its box");
    struct scene *sketch = scene_array(builder, 1, sizeof *sketch);
    if (sketch == NULL) return false;
    const bool right = sketch_scene(builder, sketch) && choose(builder, group, sketch);
    sketch->materials = 0;
    sketch->material = NULL; /* the scene's */
    scene_free(&sketch);
    return right;
}
