/* What a deck says and the scene has nothing of. */
#include "advice/parts.h"

#include "scene/boundary.h"
#include "scene/ground.h"
#include "scene/topography.h"

#include <math.h>

/* A share of the largest value of a time function below which it is nothing. */
static const double hardly = 1e-3;

/* Does a time function come to more than hardly anything by `until`? Looked at by golden sections, which no sine keeps
 * step with, and at its peak. */
static bool begins(const struct history *history, double until)
{
    enum { LOOKS = 100 };
    static const double golden = .6180339887498949;
    const double from = history->start, to = fmin(until, history_end(history));
    double largest =
        fabs(history_value(history, fmin(until, from + history->delay + history->smoothing / 2), 0));
    double most = history->rows > 0 ? 0 : 1; /* of the kinds that have a formula */
    for (size_t row = 0; row < history->rows; row++) {
        const double value = fabs(history->table_value[row]);
        most = fmax(most, value);
        if (from + history->table_time[row] + history->smoothing / 2 <= until) largest = fmax(largest, value);
    }
    for (int i = 1; i <= LOOKS && from < until; i++)
        largest = fmax(largest, fabs(history_value(history, from + (to - from) * fmod(i * golden, 1), 0)));
    return most == 0 || largest > hardly * most;
}

static void tell_of_late(struct adviser *adviser, const char *what, size_t number,
                         const struct history *history)
{
    const double end = adviser->scene->end_time;
    if (history->start >= end)
        advise(adviser, "%s %zu begins at t = %g and the run ends at %g: it does nothing", what, number + 1,
               history->start, end);
    else
        advise(adviser,
               "%s %zu has come to less than %g of its largest value when the run ends at %g: it does "
               "nothing; a "
               "later end_time or an earlier peak would be right",
               what, number + 1, hardly, end);
}

/* Of several sources in one &load the last one says whether any that is not 0 begins. */
static void look_at_rest(struct adviser *adviser)
{
    const struct scene *scene = adviser->scene;
    bool acts = scene_driven(scene) || scene->initial.kind != INITIAL_REST;
    bool some = false, any = false; /* of the group: has an amplitude; begins, too */
    for (size_t k = 0; k < scene->loads; k++) {
        const struct load *load = &scene->load[k];
        const bool last = k + 1 == scene->loads || load[1].group != load->group;
        some = some || load->amplitude != 0;
        any = any || (load->amplitude != 0 &&
                      (load->driven != BY_HISTORY || begins(&load->history, scene->end_time)));
        acts = acts || some;
        if (!last) continue;
        if (some && !any) tell_of_late(adviser, "load", load->group, &load->history);
        some = any = false;
    }
    for (int face = 0; face < FACES; face++) {
        const struct boundary *boundary = &scene->boundary[face];
        if (!boundary_acts(boundary)) continue;
        acts = true;
        if (boundary->driven == BY_HISTORY && !begins(&boundary->history, scene->end_time))
            tell_of_late(adviser, "&boundary", boundary->group, &boundary->history);
    }
    if (!acts)
        advise(adviser, "nothing acts: no load, no face that moves, no state at t = 0; all results are 0");
}

static double distance(const double one[3], const double other[3])
{
    return hypot(hypot(one[0] - other[0], one[1] - other[1]), one[2] - other[2]);
}

/* From the plane of a face; 0 from the hole. */
static double from_face(const struct scene *scene, enum face face, const double place[3])
{
    double own[3];
    if (face == FACE_HOLE) return 0;
    body_from_deck(&scene->body, place, own);
    return fabs(own[face_axis(face)] - face_plane(&scene->body, face));
}

/* 0 from what acts all over the body or moves. */
static double from_load(const struct scene *scene, const struct load *load, const double place[3])
{
    const double size = has_patch(load) ? hypot(load->size[0], load->size[1]) / 2 : 0;
    if (load_moves(load)) return 0;
    if (load->shape == LOAD_FACE)
        return load->kind == LOAD_TRACTION ? from_face(scene, load->face, place) : 0;
    return distance(place, load->centre) - size;
}

/* When the fastest wave comes to a place, at the earliest, of loads, faces that move and the state at t = 0. */
static double earliest(const struct scene *scene, const double place[3])
{
    static const double spread = 2; /* spacings over which a lattice spreads a point */
    const struct initial *initial = &scene->initial;
    const double speed = scene_fastest(scene), before = spread * scene->body.spacing;
    double time = INFINITY;
    if (initial->kind != INITIAL_REST && initial->kind != INITIAL_GAUSSIAN) return 0;
    if (initial->kind == INITIAL_GAUSSIAN)
        time = fmax(distance(place, initial->centre) - STATE_REACH * initial->width - before, 0) / speed;
    for (size_t k = 0; k < scene->loads; k++) {
        const struct load *load = &scene->load[k];
        if (load->amplitude == 0) continue;
        const double way = from_load(scene, load, place) - before;
        time = fmin(time, load->history.start + fmax(way, 0) / speed);
    }
    for (int face = 0; face < FACES; face++) {
        const struct boundary *boundary = &scene->boundary[face];
        if (!boundary_acts(boundary)) continue;
        const double way = from_face(scene, (enum face)face, place) - before;
        time = fmin(time, boundary->history.start + fmax(way, 0) / speed);
    }
    return time;
}

/* Receivers that no wave reaches by far: lengths, times and speeds of several systems of units, most often. Damped
 * rock carries its shortest waves faster than its p_speed, by 1 + ln(50) / (5 pi) = 1.25 at Q = 5 and 50 times
 * q_frequency. */
static void look_at_reach(struct adviser *adviser)
{
    const struct scene *scene = adviser->scene;
    static const double far = 2;
    double latest = 0;
    size_t missed = 0, last = 0;
    if (scene_driven(scene)) return;
    for (size_t r = 0; r < scene->receivers; r++) {
        const double time = earliest(scene, scene->receiver[r].position);
        missed += isfinite(time) && time > far * scene->end_time; /* or nothing acts: told */
        if (time > latest) last = r;
        latest = fmax(latest, time);
    }
    if (missed == 0) return;
    char others[48] = "";
    if (missed > 1) snprintf(others, sizeof others, " and %zu other receivers", missed - 1);
    advise(adviser,
           "no wave comes as far as receiver '%s'%s by end_time: the fastest, %.4g, comes there at t = %.4g "
           "at the earliest; a later end_time would be right, or lengths, times and speeds of one system of "
           "units",
           scene->receiver[last].name, others, scene_fastest(scene), latest);
}

static void look_at_blocks(struct adviser *adviser)
{
    const struct body *body = &adviser->scene->body;
    for (size_t k = 0; k < body->blocks; k++)
        for (int axis = 0; axis < adviser->scene->dimension; axis++) {
            const double from = body->block[k].centre[axis] - body->block[k].half[axis];
            const double to = body->block[k].centre[axis] + body->block[k].half[axis];
            const double low = ground_low(body, axis);
            if (to > low && from < body->high[axis]) continue;
            advise(adviser,
                   "&block %zu lies outside the body: along %c it goes from %g to %g, the body from %g to %g",
                   k + 1, 'x' + axis, from, to, low, body->high[axis]);
            break;
        }
}

/* Is a layer above the next ones, below the surface and in the body at a place? */
static bool has_layer(const struct scene *scene, size_t layer, const double place[3])
{
    const struct body *body = &scene->body;
    const int last = scene->dimension - 1;
    const double drop = body->topography != NULL ? topography_drop(body->topography, place) : 0;
    const double top = layer_covers(&body->layer[layer]) ? drop : layer_top_at(&body->layer[layer], place);
    double end = body->high[last] - body->low[last];
    for (size_t k = layer + 1; k < body->layers; k++)
        end = fmin(end, layer_top_at(&body->layer[k], place));
    return fmax(top, drop) < end;
}

/* Tilted layers, and those of files, may miss the body or hide others. */
static void look_at_layers_there(struct adviser *adviser)
{
    enum { LOOKS = 40 };
    const struct scene *scene = adviser->scene;
    const struct body *body = &scene->body;
    const int rows = scene->dimension == 3 ? LOOKS : 0;
    for (size_t k = 0; k < body->layers && body_is_box(body); k++) {
        bool there = body->chosen && layer_is_below(body, &body->layer[k]); /* the plan tells */
        for (int i = 0; i < (LOOKS + 1) * (rows + 1) && !there; i++) {
            const int at[2] = {i % (LOOKS + 1), i / (LOOKS + 1)};
            double place[3] = {0};
            for (int axis = 0; axis < 2 && axis < scene->dimension - 1; axis++)
                place[axis] = body->low[axis] + (body->high[axis] - body->low[axis]) * at[axis] / LOOKS;
            there = has_layer(scene, k, place);
        }
        if (!there)
            advise(adviser,
                   "the layer of '%s' is nowhere in the body: it lies below it, or other layers hide it; the "
                   "top of a tilted layer is its depth at x = y = 0",
                   scene->material[body->layer[k].material].name);
    }
}

/* A hill between two points is none, or a spike of one. */
static void look_at_hill(struct adviser *adviser)
{
    const struct body *body = &adviser->scene->body;
    const struct topography *hill = body->topography;
    if (hill == NULL || hill->map != NULL || !(hill->height != 0) || !(hill->width < body->spacing)) return;
    advise(adviser,
           "topography%%width = %g is less than the spacing of %g: the points do not see the shape; a finer "
           "spacing or a wider shape would be right",
           hill->width, body->spacing);
}

static void look_at_rows(struct adviser *adviser)
{
    const struct scene *scene = adviser->scene;
    for (size_t k = 0; k < scene->snapshots; k++)
        if (scene->snapshot[k].every > scene->end_time)
            advise(
                adviser,
                "snapshot%%every = %g, a time, is longer than the run, %g: &snapshot %zu shows t = 0 alone",
                scene->snapshot[k].every, scene->end_time, k + 1);
    if (scene->receivers == 0 || scene->output.history_step <= scene->end_time) return;
    advise(adviser,
           "output%%history_step = %g is longer than the run, %g: histories have the row t = 0 alone",
           scene->output.history_step, scene->end_time);
}

void look_at_nothing(struct adviser *adviser)
{
    look_at_rows(adviser);
    look_at_rest(adviser);
    look_at_reach(adviser);
    look_at_blocks(adviser);
    look_at_layers_there(adviser);
    look_at_hill(adviser);
}
