/* The box of a half-space whose deck gives no low and high: the smallest that holds loads, receivers and
 * profiles with absorbing layers around it, or the one so large that nothing comes back from its faces before
 * end_time, whichever has less to compute.
 *
 * Without absorbing layers the first wave back has gone from the load's edge to the face and on to the
 * outermost receiver: (X - load) + (X - receiver) >= c_p end_time, and likewise in depth. With them the box
 * ends MARGIN points beyond what it has to hold. */
#include "scene/build.h"

#include <math.h>
#include <stdio.h>

/* Points between what the box holds and an absorbing layer, depth of the box in points at least, and what a
 * point of such a layer costs against one of the body (regress/studies/layer-cost; doc/performance.md,
 * section 6). */
enum { MARGIN = 4, LEAST_DEPTH = 12, LAYER = 8 };
static const double LAYER_COST = 2.8;

struct span {
    double low, high;
};

static void widen(struct span *span, double low, double high)
{
    span->low = fmin(span->low, low);
    span->high = fmax(span->high, high);
}

struct extents {
    struct span load[3], place[3]; /* of the loads; of receivers and profiles */
    bool one_centre[3]; /* all loads have the same centre along this axis and are symmetric about it */
    double centre[3];
};

static double component(const struct deck_group *group, const char *name, int c)
{
    return (size_t)c < deck_values(group, name) ? deck_real(group, name, (size_t)c) : 0.0;
}

/* Half the edge of a patch along an axis of the surface. */
static double half_size(const struct deck_group *group, int axis)
{
    const size_t sizes = deck_values(group, "size");
    if (sizes == 0) return 0.0;
    return 0.5 * deck_real(group, "size", (size_t)axis < sizes ? (size_t)axis : sizes - 1);
}

/* Whether a load at its own centre is its mirror image across an axis of the surface. */
static bool mirrored_across(const struct deck_group *group, int axis)
{
    static const int shear[2][2] = {{3, 5}, {3, 4}}; /* of xx yy zz xy yz zx */
    if (axis > 1) return true;
    if (deck_choice(group, "kind", 0) != LOAD_MOMENT_TENSOR)
        return component(group, "direction", axis) == 0.0;
    return component(group, "moment", shear[axis][0]) == 0.0 &&
           component(group, "moment", shear[axis][1]) == 0.0;
}

static void add_loads(const struct builder *builder, struct extents *extents)
{
    const int dimension = builder->scene->dimension;
    for (size_t k = 0; k < deck_count(builder->deck, "load"); k++) {
        const struct deck_group *group = deck_get(builder->deck, "load", k);
        double low[3], high[3];
        const bool many = sources_span(builder, group, low, high);
        for (int c = 0; c < dimension && many; c++) {
            const double centre = .5 * (low[c] + high[c]);
            extents->one_centre[c] = false;
            extents->centre[c] = centre;
            widen(&extents->load[c], low[c], high[c]);
        }
        for (int c = 0; c < dimension && !many; c++) {
            const double centre = component(group, "centre", c);
            const double path = component(group, "velocity", c) * builder->scene->end_time;
            const double half = c < dimension - 1 ? half_size(group, c) : 0.0;
            if (k > 0 && centre != extents->centre[c]) extents->one_centre[c] = false;
            if (path != 0.0 || !mirrored_across(group, c)) extents->one_centre[c] = false;
            extents->centre[c] = centre;
            widen(&extents->load[c], fmin(centre, centre + path) - half, fmax(centre, centre + path) + half);
        }
    }
}

static void add_places(const struct builder *builder, const char *kind, const char *name,
                       struct extents *extents)
{
    for (size_t k = 0; k < deck_count(builder->deck, kind); k++) {
        const struct deck_group *group = deck_get(builder->deck, kind, k);
        for (int c = 0; c < builder->scene->dimension; c++)
            widen(&extents->place[c], component(group, name, c), component(group, name, c));
    }
}

static struct extents find_extents(const struct builder *builder)
{
    struct extents extents;
    for (int c = 0; c < 3; c++) {
        extents.load[c] = extents.place[c] = (struct span){INFINITY, -INFINITY};
        extents.one_centre[c] = true;
        extents.centre[c] = 0.0;
    }
    add_loads(builder, &extents);
    add_places(builder, "receiver", "position", &extents);
    add_places(builder, "profile", "from", &extents);
    add_places(builder, "profile", "to", &extents);
    for (int c = 0; c < 3; c++) /* without places the loads are what counts, and the other way round */
        if (extents.place[c].low > extents.place[c].high)
            extents.place[c] = extents.load[c];
        else if (extents.load[c].low > extents.load[c].high)
            extents.load[c] = extents.place[c];
    return extents;
}

static double deepest_layer(const struct builder *builder)
{
    double depth = 0.0;
    for (size_t k = 0; k < deck_count(builder->deck, "layer"); k++)
        depth = fmax(depth, component(deck_get(builder->deck, "layer", k), "top", 0));
    return depth;
}

/* Box on the lattice of the first load's centre. Symmetric about it where one load, or several on one centre,
 * allow mirror planes. */
static double fit(const struct builder *builder, const struct extents *extents, bool layers,
                  struct span box[3])
{
    const struct scene *scene = builder->scene;
    const double dx = scene->body.spacing;
    const double reach = scene_fastest(scene) * scene->end_time;
    const int down = scene->dimension - 1;
    double points = 1.0;
    double with_layers = 1.0;
    for (int c = 0; c < scene->dimension; c++) {
        const struct span load = extents->load[c];
        const struct span place = extents->place[c];
        const double high = fmax(load.high, place.high);
        const double low = fmin(load.low, place.low);
        double above = layers ? high + MARGIN * dx : fmax(0.5 * (reach + load.high + place.high), high + dx);
        double below = layers ? low - MARGIN * dx : fmin(0.5 * (load.low + place.low - reach), low - dx);
        if (c == down) {
            if (layers) above = fmax(fmax(above, LEAST_DEPTH * dx), deepest_layer(builder) + MARGIN * dx);
            box[c] = (struct span){0.0, ceil(above / dx - 1e-6) * dx};
        } else {
            const double centre = extents->centre[c];
            double up = ceil((above - centre) / dx - 1e-6);
            double back = ceil((centre - below) / dx - 1e-6);
            if (extents->one_centre[c]) up = back = fmax(up, back);
            box[c] = (struct span){centre - back * dx, centre + up * dx};
        }
        const double count = (box[c].high - box[c].low) / dx + 1.0;
        points *= count;
        with_layers *= count + (c == down ? LAYER : 2 * LAYER);
    }
    return layers ? with_layers + (LAYER_COST - 1.0) * (with_layers - points) : points;
}

bool choose_half_space(struct builder *builder, const struct deck_group *group)
{
    struct scene *scene = builder->scene;
    struct body *body = &scene->body;
    if (deck_count(builder->deck, "load") + deck_count(builder->deck, "receiver") == 0) {
        complain(builder, group, NULL,
                 "a half-space without low and high is fitted around loads and receivers: give some");
        return false;
    }
    if (scene->materials == 0 || !take_spacing(builder, group, &body->spacing))
        return false; /* complained of elsewhere */
    const struct extents extents = find_extents(builder);
    struct span small[3];
    struct span large[3];
    const double small_cost = fit(builder, &extents, true, small);
    const double large_cost = fit(builder, &extents, false, large);
    body->chosen = true;
    body->absorbing = small_cost < large_cost;
    for (int c = 0; c < scene->dimension; c++) {
        const struct span *box = body->absorbing ? small : large;
        body->low[c] = box[c].low;
        body->high[c] = box[c].high;
    }
    if (body->absorbing)
        snprintf(body->choice, sizeof body->choice,
                 "absorbing layers around a small box: work as for %.3g points, against %.3g in a box so "
                 "large that nothing "
                 "returns before end_time",
                 small_cost, large_cost);
    else
        snprintf(body->choice, sizeof body->choice,
                 "so large that nothing returns before end_time: %.3g points, against work as for %.3g with "
                 "absorbing layers",
                 large_cost, small_cost);
    return true;
}
