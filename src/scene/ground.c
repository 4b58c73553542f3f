/* The ground as a field (doc/theory/general-ground.md, section 4): layers, each from its upper face down, over them the
 * blocks in the deck's order. */
#include "scene/ground.h"

#include "scene/ground_line.h"
#include "scene/height_map.h"
#include "scene/topography.h"

#include <math.h>

static double depth_of(const struct scene *scene, const double place[3])
{
    const int last = scene->dimension - 1;
    return place[last] - scene->body.low[last];
}

/* Depth of the surface above or below a place: 0 where there is no hill. */
static double surface_at(const struct scene *scene, const double place[3])
{
    const struct topography *topography = scene->body.topography;
    return topography == NULL ? 0 : topography_drop(topography, place);
}

/* No part of the surface lies deeper. */
static double lowest(const struct topography *topography)
{
    if (topography == NULL) return 0;
    const double down = topography->shape == TOPOGRAPHY_CANYON ? topography->height : -topography->height;
    return topography->map != NULL ? topography->depth : fmax(0, down);
}

double layer_top_at(const struct layer *layer, const double place[3])
{
    const double rise = layer->map != NULL ? height_map_at(layer->map, place) : 0;
    return layer->top + layer->slope[0] * place[0] + layer->slope[1] * place[1] - rise;
}

static bool inside(const struct scene *scene, const struct ground_block *block, const double place[3],
                   double surface)
{
    const struct body *body = &scene->body;
    double square = 0;
    for (int axis = 0; axis < scene->dimension; axis++) {
        const double top = axis == scene->dimension - 1 ? surface : 0;
        const double low = body->low[axis] + top + GROUND_FILM * body->spacing;
        const double high = body->high[axis] - GROUND_FILM * body->spacing;
        const double below = place[axis] < high ? place[axis] : high, held = below > low ? below : low;
        const double part = fabs(held - block->centre[axis]) / block->half[axis];
        if (part >= 1) return false;
        square += part * part;
    }
    return block->shape == BLOCK_BOX || square < 1;
}

/* From the moduli: speeds of damped materials are those at one frequency. */
static double p_speed_of(const struct material *material)
{
    return sqrt((material->plane_lambda + 2 * material->mu) / material->density);
}

static double s_speed_of(const struct material *material)
{
    return sqrt(material->mu / material->density);
}

/* Speeds and density between those of two materials. */
static struct rock between(const struct material *one, const struct material *other, double part)
{
    const double density = one->density + part * (other->density - one->density);
    const double from[2] = {p_speed_of(one), s_speed_of(one)};
    const double p = from[0] + part * (p_speed_of(other) - from[0]);
    const double s = from[1] + part * (s_speed_of(other) - from[1]);
    return (struct rock){density, density * (p * p - 2 * s * s), density * s * s};
}

bool layer_leans(const struct layer *layer)
{
    return layer->map != NULL || layer->slope[0] != 0 || layer->slope[1] != 0;
}

/* From the surface on, wherever that is. */
bool layer_covers(const struct layer *layer)
{
    return layer->top == 0 && !layer_leans(layer);
}

bool layer_is_below(const struct body *body, const struct layer *layer)
{
    const int last = body->high[2] > body->low[2] ? 2 : 1;
    double least = layer->top;
    for (int axis = 0; axis < last; axis++)
        least += fmin(layer->slope[axis] * body->low[axis], layer->slope[axis] * body->high[axis]);
    return layer->map == NULL && least >= body->high[last] - body->low[last];
}

/* Index of the layer at a place, or the number of layers: the body's own material. */
static size_t layer_at(const struct body *body, const double place[3], double depth)
{
    size_t found = body->layers;
    for (size_t i = 0; i < body->layers; i++)
        if (layer_top_at(&body->layer[i], place) <= depth || layer_covers(&body->layer[i])) found = i;
    return found;
}

/* The material at a place, and that into which it goes over, `part` of the way on. */
struct found {
    size_t material, bottom;
    double part;
    bool of_model;   /* the ground is that of the model instead ... */
    double place[3]; /* ... here */
};

static struct found find(const struct scene *scene, const double place[3])
{
    const struct body *body = &scene->body;
    const double own = depth_of(scene, place);
    const double surface =
        own > lowest(body->topography) + body->spacing ? -INFINITY : surface_at(scene, place);
    const double depth = fmax(own, surface);
    const size_t layer = layer_at(body, place, depth + body_rounding(scene));
    struct found found = {.material = layer < body->layers ? body->layer[layer].material : body->material};
    bool in_block = false;
    for (size_t i = 0; i < body->blocks; i++)
        if (inside(scene, &body->block[i], place, surface)) {
            found.material = body->block[i].material;
            in_block = true;
        }
    found.of_model = body->model != NULL && !in_block;
    found.bottom = found.material;
    for (int axis = 0; axis < 3 && found.of_model; axis++)
        found.place[axis] = place[axis];
    if (found.of_model) found.place[scene->dimension - 1] += depth - own;
    if (in_block || layer + 1 >= body->layers || !body->layer[layer].graded) return found;
    const double top = layer_top_at(&body->layer[layer], place),
                 end = layer_top_at(&body->layer[layer + 1], place);
    const double part = end > top ? (depth - top) / (end - top) : 0;
    found.bottom = body->layer[layer].bottom;
    found.part = fmin(fmax(part, 0), 1);
    return found;
}

static double bulk_of(const struct material *material)
{
    return material->lambda + 2. / 3 * material->mu;
}

struct rock ground_at(const struct scene *scene, const double place[3])
{
    if (scene->body.line != NULL) return *ground_line_at(scene->body.line, place);
    const struct found found = find(scene, place);
    const struct material *list = scene->whole != NULL ? scene->whole : scene->material;
    const struct material *material = &list[found.material];
    if (found.of_model) return ground_model_at(scene->body.model, found.place);
    if (found.bottom != found.material) return between(material, &list[found.bottom], found.part);
    return (struct rock){material->density, material->plane_lambda, material->mu};
}

struct shares ground_shares_at(const struct scene *scene, const double place[3])
{
    const struct found found = find(scene, place);
    const size_t index[2] = {found.material, found.bottom};
    const double weight[2] = {1 - found.part, found.part};
    struct shares sum = {0, 0};
    if (found.of_model) return ground_model_shares(scene->body.model, found.place);
    for (int i = 0; i < 2; i++) {
        const struct material *whole = &scene->whole[index[i]], *part = &scene->material[index[i]];
        sum.bulk += weight[i] * bulk_of(part) / bulk_of(whole);
        sum.shear += weight[i] * part->mu / whole->mu;
    }
    return sum;
}

struct rock ground_part_at(const struct scene *scene, const double place[3])
{
    struct rock rock = ground_at(scene, place);
    if (scene->whole == NULL || scene->whole == scene->material) return rock;
    const struct shares share = ground_shares_at(scene, place);
    const double bulk = share.bulk * (rock.lambda + 2. / 3 * rock.mu);
    rock.mu *= share.shear;
    rock.lambda = bulk - 2. / 3 * rock.mu;
    return rock;
}

void ground_speeds_at(const struct scene *scene, const double place[3], double speed[2])
{
    const struct ground_model *model = scene->body.model;
    const struct found found = find(scene, place);
    if (scene->whole != NULL && !found.of_model) {
        const struct material *one = &scene->material[found.material],
                              *other = &scene->material[found.bottom];
        speed[0] = one->p_speed + found.part * (other->p_speed - one->p_speed);
        speed[1] = one->s_speed + found.part * (other->s_speed - one->s_speed);
        return;
    }
    const struct rock rock = found.of_model && model->given != NULL
                                 ? ground_model_at(model->given, found.place)
                                 : ground_at(scene, place);
    speed[0] = sqrt((rock.lambda + 2 * rock.mu) / rock.density);
    speed[1] = sqrt(rock.mu / rock.density);
}

/* --- Where ground goes over much: between values of a model or the faces of a graded layer, which may be much nearer
 * than the points of the lattice --- */

/* A part over which the shear modulus rises by more than this is halved, and so are its halves, so often. */
enum { HALVINGS = 5 };
static const double much = .05;

/* In logarithms: of a graded layer, or of the model. */
static double stiffness_at(const struct scene *scene, const double place[3], const struct layer *layer,
                           double z)
{
    const int axis = scene->dimension - 1;
    double there[3] = {place[0], place[1], place[2]};
    there[axis] = z;
    if (layer == NULL) return log(ground_model_at(scene->body.model, there).mu);
    const struct material *list = scene->whole != NULL ? scene->whole : scene->material;
    const double top = layer_top_at(layer, place), end = layer_top_at(layer + 1, place);
    const double part = (z - scene->body.low[axis] - top) / (end - top);
    return log(between(&list[layer->material], &list[layer->bottom], part).mu);
}

/* Ends of a piece and the stiffness there. */
struct piece {
    double from, to, low, high;
    int halvings;
};

static size_t halve(const struct scene *scene, const double place[3], const struct layer *layer, double from,
                    double to, double *at)
{
    struct piece piece[HALVINGS + 1] = {
        {from, to, stiffness_at(scene, place, layer, from), stiffness_at(scene, place, layer, to), 0}};
    size_t count = 0;
    for (int pieces = 1; pieces > 0;) {
        const struct piece whole = piece[--pieces];
        if (whole.halvings == HALVINGS || fabs(whole.high - whole.low) < much) continue;
        const double middle = (whole.from + whole.to) / 2,
                     between = stiffness_at(scene, place, layer, middle);
        at[count++] = middle;
        piece[pieces++] = (struct piece){whole.from, middle, whole.low, between, whole.halvings + 1};
        piece[pieces++] = (struct piece){middle, whole.to, between, whole.high, whole.halvings + 1};
    }
    return count;
}

static size_t model_jumps(const struct scene *scene, const double place[3], double from, double to,
                          double *at)
{
    const size_t kinks = ground_model_kinks(scene->body.model, place, from, to, at);
    double start = from;
    size_t count = kinks;
    for (size_t part = 0; part <= kinks; part++) {
        const double end = part < kinks ? at[part] : to;
        count += halve(scene, place, NULL, start, end, at + count);
        start = end;
    }
    return count;
}

size_t ground_jumps(const struct scene *scene, const double place[3], int axis, double from, double to,
                    double *at)
{
    const struct body *body = &scene->body;
    size_t count = 0;
    if (body->line != NULL) return ground_line_jumps(body->line, place, axis, from, to, at);
    for (size_t i = 0; i < body->layers && axis == scene->dimension - 1; i++) {
        const double top = layer_top_at(&body->layer[i], place), x = body->low[axis] + top;
        if (x > from && x < to && (top > 0 || top > fmin(0, surface_at(scene, place)))) at[count++] = x;
        if (i + 1 == body->layers || !body->layer[i].graded) continue;
        const double start = fmax(from, x),
                     end = fmin(to, body->low[axis] + layer_top_at(&body->layer[i + 1], place));
        if (end > start) count += halve(scene, place, &body->layer[i], start, end, at + count);
    }
    for (size_t i = 0; i < body->blocks; i++) {
        const struct ground_block *block = &body->block[i];
        double rest = 1;
        for (int other = 0; other < scene->dimension && block->shape == BLOCK_ELLIPSOID; other++)
            if (other != axis) rest -= pow((place[other] - block->centre[other]) / block->half[other], 2);
        for (int side = -1; side <= 1 && rest > 0; side += 2) {
            const double x = block->centre[axis] + side * sqrt(rest) * block->half[axis];
            if (x > from && x < to) at[count++] = x;
        }
    }
    if (body->model != NULL && axis == scene->dimension - 1)
        count += model_jumps(scene, place, from, to, at + count);
    return count;
}

size_t ground_jumps_at_most(const struct scene *scene)
{
    if (scene->body.line != NULL) return ground_line_jumps_at_most(scene->body.line);
    const struct ground_model *model = scene->body.model;
    size_t parts = ground_grades(scene) ? scene->body.layers : 0;
    parts += model != NULL;
    for (size_t i = 0; model != NULL && i < model->grids; i++)
        parts += model->grid[i].n[2];
    return scene->body.layers + 2 * scene->body.blocks + (parts << HALVINGS);
}

double ground_surface(const struct scene *scene, const double place[3])
{
    return scene->body.low[scene->dimension - 1] + surface_at(scene, place);
}

double ground_low(const struct body *body, int axis)
{
    const struct topography *topography = body->topography;
    return body->low[axis] + (topography != NULL && axis == topography->axis ? topography->top : 0);
}

bool ground_grades(const struct scene *scene)
{
    if (scene->body.line != NULL) return false;
    if (scene->body.model != NULL) return true;
    for (size_t i = 0; i < scene->body.layers; i++)
        if (scene->body.layer[i].graded) return true;
    return false;
}

double ground_detail(const struct scene *scene, int axis)
{
    const struct body *body = &scene->body;
    return body->line != NULL || body->model == NULL || body->blocks > 0 ? 0 : body->model->detail[axis];
}

bool ground_varies(const struct scene *scene, int axis)
{
    const struct body *body = &scene->body;
    if (body->line != NULL || body->blocks > 0 || body->model != NULL) return true;
    for (size_t i = 0; i < body->layers && axis < scene->dimension - 1; i++)
        if (body->layer[i].slope[axis] != 0 || body->layer[i].map != NULL) return true;
    return axis == scene->dimension - 1 && body_is_layered(body);
}

bool ground_is_general(const struct scene *scene)
{
    bool general = scene->body.topography != NULL || ground_grades(scene) || scene->body.blocks > 0;
    for (int axis = 0; axis < scene->dimension - 1; axis++)
        general = general || ground_varies(scene, axis);
    return general;
}

bool ground_needs_general(const struct scene *scene)
{
    return ground_is_general(scene) || scene->body.grading != NULL;
}

bool ground_has_depth(const struct scene *scene)
{
    return scene->dimension == 3 || scene->body.shape == BODY_HALF_SPACE || ground_is_general(scene) ||
           body_is_layered(&scene->body);
}

bool ground_is_damped(const struct scene *scene)
{
    for (size_t i = 0; i < scene->materials; i++)
        if (scene->material[i].q_p > 0) return true;
    return scene->body.model != NULL && scene->body.model->damped;
}
