/* The body: its box, its shape, the spacing of its points and its frame; layers of ground. */
#include "base/memory.h"
#include "scene/build.h"
#include "scene/ground.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

size_t find_material(struct builder *builder, const struct deck_group *group, const char *word)
{
    const struct scene *scene = builder->scene;
    const char *name = deck_text(group, word, 0);
    for (size_t i = 0; i < scene->materials; i++)
        if (strcmp(scene->material[i].name, name) == 0) return i;
    if (scene->materials == 1)
        complain(builder, group, word, "no &material is named '%s'; expected '%s'", name,
                 scene->material[0].name);
    else if (scene->materials > 1)
        complain(builder, group, word, "no &material is named '%s'; expected one of the %zu, '%s' to '%s'",
                 name, scene->materials, scene->material[0].name, scene->material[scene->materials - 1].name);
    return scene->materials;
}

static bool divides(double spacing, double length)
{
    const double intervals = length / spacing;
    return round(intervals) >= 1 && fabs(intervals - round(intervals)) <= 1e-6 * round(intervals);
}

/* Spacing nearest to `wanted` (in ratio) that divides every edge of the box; 0 if none lies within a factor
 * of 4. */
static double nearest_spacing(const struct body *body, int dimension, double wanted)
{
    double shortest = INFINITY, best = 0;
    for (int c = 0; c < dimension; c++)
        shortest = fmin(shortest, body->high[c] - body->low[c]);
    const long first = (long)fmin(fmax(1, floor(shortest / wanted / 4)), 1e6);
    const long last = (long)fmin(ceil(4 * shortest / wanted), 1e6);
    for (long n = first; n <= last; n++) {
        const double spacing = shortest / (double)n;
        bool all = true;
        for (int c = 0; c < dimension; c++)
            all = all && divides(spacing, body->high[c] - body->low[c]);
        if (all && (best == 0 || fabs(log(spacing / wanted)) < fabs(log(best / wanted)))) best = spacing;
    }
    return best;
}

double dividing_spacing(const struct body *body, int dimension, double at_most)
{
    double shortest = INFINITY;
    for (int c = 0; c < dimension; c++)
        shortest = fmin(shortest, body->high[c] - body->low[c]);
    const long first = (long)fmin(fmax(1, ceil(shortest / at_most * (1 - 1e-9))), 1e6);
    for (long n = first; n <= 4 * first; n++) {
        const double spacing = shortest / (double)n;
        bool all = spacing <= at_most * (1 + 1e-9);
        for (int c = 0; c < dimension; c++)
            all = all && divides(spacing, body->high[c] - body->low[c]);
        if (all) return spacing;
    }
    return 0;
}

/* Smoothed points lie on the faces, so the spacing must divide every edge; SPH fits it edge by edge. */
static void check_division(struct builder *builder, const struct deck_group *group)
{
    const struct scene *scene = builder->scene;
    const struct body *body = &scene->body;
    for (int c = 0; c < scene->dimension; c++) {
        const double length = body->high[c] - body->low[c];
        if (divides(body->spacing, length)) continue;
        const double nearest = nearest_spacing(body, scene->dimension, body->spacing);
        if (scene->method.points == POINTS_IN_CELLS) {
            deck_warning(builder->deck, group, "spacing", builder->messages,
                         "spacing = %g does not divide the edge of %.10g along %c, which gets %.0f points %g "
                         "apart",
                         body->spacing, length, "xyz"[c], fmax(1, round(length / body->spacing)),
                         length / fmax(1, round(length / body->spacing)));
            continue;
        }
        if (nearest > 0)
            complain(
                builder, group, "spacing",
                "spacing = %.10g does not divide the edge of %.10g along %c (points lie on the faces); the "
                "nearest spacing that divides every edge is %.10g",
                body->spacing, length, "xyz"[c], nearest);
        else
            complain(
                builder, group, "spacing",
                "spacing = %.10g does not divide the edge of %.10g along %c (points lie on the faces), nor "
                "does any spacing near it divide every edge; change low or high",
                body->spacing, length, "xyz"[c]);
        return;
    }
}

/* Refuses more points than this machine could hold with displacement, velocity and acceleration alone. */
static bool check_memory(struct builder *builder, const struct deck_group *group)
{
    const struct scene *scene = builder->scene;
    const struct body *body = &scene->body;
    double points = 1, volume = 1;
    for (int c = 0; c < scene->dimension; c++) {
        const double least = c == scene->dimension - 1 ? 1 / body->most_stretch : 1;
        points *= round(least * (body->high[c] - body->low[c]) / body->spacing) + 1;
        volume *= body->high[c] - body->low[c];
    }
    const double bytes = 3 * sizeof(double) * (double)scene->dimension;
    const double memory = (double)sysconf(_SC_PHYS_PAGES) * (double)sysconf(_SC_PAGESIZE);
    if (points * bytes <= memory) return true;
    complain(builder, group, "spacing",
             "%.3g points need at least %.3g GB, this machine has %.3g GB; expected a spacing above %.3g",
             points, points * bytes / 1e9, memory / 1e9, pow(volume * bytes / memory, 1. / scene->dimension));
    return false;
}

static bool read_box(struct builder *builder, const struct deck_group *group, const char *purpose)
{
    struct body *body = &builder->scene->body;
    const bool low = need_vector(builder, group, "low", purpose, body->low);
    const bool high = need_vector(builder, group, "high", purpose, body->high);
    if (!low || !high) return false;
    for (int c = 0; c < builder->scene->dimension; c++)
        if (!(body->low[c] < body->high[c]) || !isfinite(body->high[c] - body->low[c])) {
            complain(builder, group, "high", "high = %g is not above low = %g along %c", body->high[c],
                     body->low[c], "xyz"[c]);
            return false;
        }
    return true;
}

/* The hole must take something out of the box and leave something. */
static bool read_hole(struct builder *builder, const struct deck_group *group)
{
    struct body *body = &builder->scene->body;
    double nearest = 0, farthest = 0;
    if (builder->scene->dimension != 2) {
        complain(builder, group, "shape", "a plate with a hole needs scene%%dimension = 2");
        return false;
    }
    const bool centre = need_vector(builder, group, "hole_centre", "a plate with a hole", body->hole_centre);
    if (!need_real(builder, group, "hole_radius", "a plate with a hole", &body->hole_radius) || !centre)
        return false;
    for (int c = 0; c < 2; c++) {
        const double below = body->low[c] - body->hole_centre[c],
                     above = body->hole_centre[c] - body->high[c];
        nearest = hypot(nearest, fmax(0, fmax(below, above)));
        farthest = hypot(farthest, fmax(fabs(below), fabs(above)));
    }
    if (nearest < body->hole_radius && body->hole_radius < farthest) return true;
    complain(
        builder, group, "hole_radius",
        "the hole of radius %g %s; expected a radius between %g and %g about this centre", body->hole_radius,
        nearest < body->hole_radius ? "takes away the whole plate" : "misses the plate", nearest, farthest);
    return false;
}

static bool read_rotation(struct builder *builder, const struct deck_group *group)
{
    const int dimension = builder->scene->dimension;
    struct body *body = &builder->scene->body;
    const size_t count = deck_values(group, "rotation");
    for (size_t c = 0; c < 3; c++)
        body->rotation[c] = c < count ? deck_real(group, "rotation", c) : 0;
    if (dimension == 1 && (body->rotation[0] != 0 || body->rotation[1] != 0 || body->rotation[2] != 0)) {
        complain(builder, group, "rotation", "a bar in one dimension cannot be turned");
        return false;
    }
    if (dimension == 2 && (body->rotation[0] != 0 || body->rotation[1] != 0)) {
        complain(builder, group, "rotation",
                 "in two dimensions a body turns about z alone; expected rotation = 0, 0, ANGLE");
        return false;
    }
    return true;
}

bool take_spacing(const struct builder *builder, const struct deck_group *group, double *spacing)
{
    const struct scene *scene = builder->scene;
    if (builder->accurate &&
        !(builder->spacing > 0)) { /* a first guess: a sixteenth of what a P wave covers, or of an edge */
        const double covered = scene_fastest(scene) * scene->end_time; /* 0: all speeds are a model's */
        *spacing = (covered > 0 ? covered : scene->body.high[0] - scene->body.low[0]) / 16;
        return *spacing > 0;
    }
    if (builder->accurate) {
        *spacing = builder->spacing;
        return true;
    }
    if (deck_values(group, "spacing") == 0) return false;
    *spacing = deck_real(group, "spacing", 0);
    return true;
}

/* Points of the host's own, for which `given` stands. */
static bool take_points(struct builder *builder, const struct deck_group *group,
                        const struct given_points *given)
{
    const int d = builder->scene->dimension;
    if (builder->scene->body.shape != BODY_POINTS) {
        complain(builder, group, "shape",
                 "the host gave the body points of its own; expected shape 'points'");
        return false;
    }
    builder->scene->body.given = given;
    for (size_t i = 0; i < given->count; i++)
        for (int c = d; c < 3; c++)
            if (fabs(given->position[3 * i + (size_t)c]) > 0) {
                complain(builder, group, NULL,
                         "point %zu of the host has %c = %g; expected 0 in %d dimension%s", i + 1, "xyz"[c],
                         given -> position[3 * i + (size_t)c], d, d == 1 ? "" : "s");
                return false;
            }
    return true;
}

static bool read_shape(struct builder *builder, const struct deck_group *group)
{
    static const char *const hole_words[] = {"hole_centre", "hole_radius", NULL};
    static const char *const file_words[] = {"file", NULL};
    static const char *const purposes[] = {"shape 'box'", "shape 'half-space'", "shape 'plate-with-hole'",
                                           "shape 'points'"};
    struct body *body = &builder->scene->body;
    body->shape = (enum body_shape)deck_choice(group, "shape", 0);
    const char *purpose = purposes[body->shape];
    const bool fitted = body->shape == BODY_HALF_SPACE && deck_values(group, "low") == 0 &&
                        deck_values(group, "high") == 0 && builder->scene->dimension > 1;
    bool right = fitted ? choose_half_space(builder, group) : read_box(builder, group, purpose);
    if (body->shape == BODY_PLATE_WITH_HOLE)
        right = read_hole(builder, group) && right;
    else
        refuse(builder, group, hole_words, purpose);
    if (deck_points(builder->deck) != NULL) {
        right = take_points(builder, group, deck_points(builder->deck)) && right;
        refuse(builder, group, file_words, "a body whose points the host hands over");
    } else if (body->shape != BODY_POINTS) {
        refuse(builder, group, file_words, purpose);
    } else if (deck_values(group, "file") == 0) {
        complain(builder, group, NULL, "%s needs file", purpose);
        right = false;
    } else {
        body->file = deck_path(builder, deck_text(group, "file", 0));
        right = right && body->file != NULL;
    }
    if (body->shape == BODY_HALF_SPACE && right &&
        (builder->scene->dimension == 1 || body->low[builder->scene->dimension - 1] != 0)) {
        complain(builder, group, "low",
                 "the surface of a half-space is at %c = 0 with %c down; expected low = 0 there",
                 "xyz"[builder->scene->dimension - 1], "xyz"[builder->scene->dimension - 1]);
        right = false;
    }
    return right;
}

void build_body(struct builder *builder)
{
    struct scene *scene = builder->scene;
    struct body *body = &scene->body;
    if (deck_count(builder->deck, "body") == 0) {
        complain(builder, deck_get(builder->deck, "scene", 0), NULL, "the deck has no &body");
        return;
    }
    const struct deck_group *group = deck_get(builder->deck, "body", 0);
    take_name(builder, group, "name", body->name);
    if (deck_values(group, "material") > 0)
        body->material = find_material(builder, group, "material");
    else
        body->material = scene->materials; /* build_layers complains unless layers fill the body */
    body->arrangement = (enum arrangement)deck_choice(group, "arrangement", 0);
    body->jitter = deck_real(group, "jitter", 0);
    body->most_stretch =
        deck_given(group, "grading") ? deck_real(group, "grading", 0) : fmax(builder->grading, 1);
    body->seed = deck_integer(group, "seed", 0);
    bool right = read_shape(builder, group);
    right = read_rotation(builder, group) && right;
    if (body->arrangement != ARRANGEMENT_LATTICE && body->shape != BODY_PLATE_WITH_HOLE)
        complain(builder, group, "arrangement",
                 "arrangement '%s' is for shape 'plate-with-hole'; expected 'lattice'",
                 deck_text(group, "arrangement", 0));
    const bool spaced = take_spacing(builder, group, &body->spacing) ||
                        need_real(builder, group, "spacing", "a body of points", &body->spacing);
    if (!right) return;
    body_set_frame(body);
    builder->body_known = true;
    const bool lattice = body_is_box(body);
    if (spaced && check_memory(builder, group) && lattice && !builder->accurate)
        check_division(builder, group);
}

/* Depth of a layer's upper face in the middle of the body (where it is known; of a file its mean). What begins at the
 * surface, wherever that is, comes first. */
static double middle_depth(const struct builder *builder, const struct layer *layer)
{
    const struct scene *scene = builder->scene;
    const struct body *body = &scene->body;
    double depth = layer->top;
    if (layer_covers(layer)) return -INFINITY;
    for (int axis = 0; builder->body_known && axis < scene->dimension - 1; axis++)
        depth += layer->slope[axis] * (body->low[axis] + body->high[axis]) / 2;
    return depth;
}

static void sort_layers(const struct builder *builder)
{
    struct body *body = &builder->scene->body;
    for (size_t i = 1; i < body->layers; i++) {
        const struct layer layer = body->layer[i];
        size_t k = i;
        for (; k > 0 && middle_depth(builder, &body->layer[k - 1]) > middle_depth(builder, &layer); k--)
            body->layer[k] = body->layer[k - 1];
        body->layer[k] = layer;
    }
}

static bool same_face(const struct layer *one, const struct layer *other)
{
    return one->top == other->top && one->slope[0] == other->slope[0] && one->slope[1] == other->slope[1] &&
           one->map == NULL && other->map == NULL;
}

/* Each layer by itself: its body, material and depth. */
static void read_layer(struct builder *builder, const struct deck_group *group, struct layer *layer)
{
    const struct scene *scene = builder->scene;
    if (deck_given(group, "body") && strcmp(deck_text(group, "body", 0), scene->body.name) != 0)
        complain(builder, group, "body", "no &body is named '%s'; expected '%s'", deck_text(group, "body", 0),
                 scene->body.name);
    layer->material = find_material(builder, group, "material");
    layer->top = deck_real(group, "top", 0);
    read_interface(builder, group, layer);
    read_grade(builder, group, layer);
    const int last = scene->dimension - 1;
    const double depth = scene->body.high[last] - scene->body.low[last];
    const bool level = layer->slope[0] == 0 && layer->slope[1] == 0 && layer->map == NULL;
    if (builder->body_known && level && layer->top >= depth && !scene->body.chosen)
        complain(builder, group, "top", "the layer begins at depth %g, below the body; expected less than %g",
                 layer->top, depth);
}

static void check_materials_used(struct builder *builder)
{
    const struct scene *scene = builder->scene;
    for (size_t i = 0; i < deck_count(builder->deck, "material"); i++) {
        bool used =
            scene->body.material == i || (scene->body.given != NULL && scene->body.given->material != NULL);
        for (size_t k = 0; k < scene->body.layers; k++)
            used = used || scene->body.layer[k].material == i ||
                   (scene->body.layer[k].graded && scene->body.layer[k].bottom == i);
        for (size_t k = 0; k < scene->body.blocks; k++)
            used = used || scene->body.block[k].material == i;
        if (!used)
            complain(builder, deck_get(builder->deck, "material", i), "name",
                     "material '%s' is used by no &body, &layer or &block; leave it out or use it",
                     scene->material[i].name);
    }
}

void build_layers(struct builder *builder)
{
    struct scene *scene = builder->scene;
    struct body *body = &scene->body;
    const size_t count = deck_count(builder->deck, "layer");
    if (deck_count(builder->deck, "body") == 0) return;
    const struct deck_group *group = deck_get(builder->deck, "body", 0);
    const selas_status before = builder->status;
    if (count > 0 && scene->dimension == 1) {
        complain(builder, deck_get(builder->deck, "layer", 0), NULL, "layers need scene%%dimension = 2 or 3");
        return;
    }
    if (count > 0) {
        body->layer = scene_array(builder, count, sizeof *body->layer);
        if (body->layer == NULL) return;
        body->layers = count;
        for (size_t i = 0; i < count; i++) {
            read_layer(builder, deck_get(builder->deck, "layer", i), &body->layer[i]);
            for (size_t k = 0; k < i; k++)
                if (same_face(&body->layer[k], &body->layer[i]))
                    complain(builder, deck_get(builder->deck, "layer", i), "top",
                             "&layer %zu begins at depth %g already", k + 1, body->layer[i].top);
        }
        sort_layers(builder);
    }
    if (count > 0 && deck_count(builder->deck, "model") > 0)
        complain(builder, deck_get(builder->deck, "layer", 0), NULL,
                 "the ground is that of &model; leave &layer out");
    build_model(builder);
    const bool covered = body->model != NULL || (count > 0 && layer_covers(&body->layer[0]));
    if (deck_values(group, "material") == 0 && !covered)
        complain(builder, group, NULL,
                 "the body needs material: the name of a &material (or layers from depth 0 on)");
    else if (deck_values(group, "material") == 0 && body->model == NULL)
        body->material = body->layer[0].material;
    build_blocks(builder);
    if (before == SELAS_OK && builder->status == SELAS_OK) check_materials_used(builder);
}
