/* Mirror planes of a scene.
 *
 * A mirror across axis a maps positions x_a -> 2 m - x_a (m: middle of the box) and vector components v_a ->
 * -v_a. The scene has this symmetry if the set of loads, the treatment of the faces and the ground map onto
 * themselves; the solution then has it too. */
#include "scene/symmetry.h"
#include "scene/ground.h"
#include "scene/topography.h"

#include <math.h>
#include <string.h>

/* What counts as the same place or number: rounding of decks written in decimals. */
static bool same(double a, double b, double scale)
{
    return fabs(a - b) <= 1e-12 * scale;
}

static bool same_vector(const double a[3], const double b[3], double scale)
{
    return same(a[0], b[0], scale) && same(a[1], b[1], scale) && same(a[2], b[2], scale);
}

/* xx yy zz xy yz zx in the body's frame: R^T M R. */
static void moment_in_body_frame(const struct body *body, const double deck[6], double moment[6])
{
    static const int place[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    for (int i = 0; i < 3; i++)
        for (int j = i; j < 3; j++) {
            double sum = 0.0;
            for (int k = 0; k < 3; k++)
                for (int l = 0; l < 3; l++)
                    sum += body->frame[k][i] * deck[place[k][l]] * body->frame[l][j];
            moment[place[i][j]] = sum;
        }
}

/* A load with its geometry in the body's frame and its amplitude in its vectors. */
static struct load in_body_frame(const struct body *body, const struct load *load)
{
    struct load result = *load;
    body_from_deck(body, load->centre, result.centre);
    body_direction_from_deck(body, load->direction, result.direction);
    body_direction_from_deck(body, load->velocity, result.velocity);
    for (int c = 0; c < 3; c++)
        result.direction[c] *= load->amplitude;
    if (body->rotated) moment_in_body_frame(body, load->moment, result.moment);
    for (int c = 0; c < 6; c++)
        result.moment[c] *= load->amplitude;
    return result;
}

static enum face mirrored_face(enum face face, int axis)
{
    if (face == FACE_HOLE || face_axis(face) != axis) return face;
    return (enum face)((int)face ^ 1);
}

static struct load mirrored(const struct load *load, int axis, double middle)
{
    static const int shear[3][2] = {
        {3, 5}, {3, 4}, {4, 5}}; /* of xx yy zz xy yz zx: those that change sign */
    struct load image = *load;
    image.centre[axis] = 2.0 * middle - load->centre[axis];
    image.direction[axis] = -load->direction[axis];
    image.velocity[axis] = -load->velocity[axis];
    image.moment[shear[axis][0]] = -load->moment[shear[axis][0]];
    image.moment[shear[axis][1]] = -load->moment[shear[axis][1]];
    if (load->kind == LOAD_TRACTION) image.face = mirrored_face(load->face, axis);
    return image;
}

static double largest_moment(const struct load *load)
{
    double largest = 0.0;
    for (int c = 0; c < 6; c++)
        largest = fmax(largest, fabs(load->moment[c]));
    return largest;
}

static bool same_load(const struct load *a, const struct load *b, double length)
{
    if (a->kind != b->kind || a->shape != b->shape) return false;
    if (a->kind == LOAD_TRACTION && a->face != b->face) return false;
    if (a->shape != LOAD_FACE && !same_vector(a->centre, b->centre, length)) return false;
    if ((a->shape == LOAD_SQUARE || a->shape == LOAD_DISC) && !same_vector(a->size, b->size, length))
        return false;
    if (a->kind == LOAD_MOMENT_TENSOR)
        for (int c = 0; c < 6; c++)
            if (!same(a->moment[c], b->moment[c], largest_moment(a))) return false;
    if (a->kind != LOAD_MOMENT_TENSOR && !same_vector(a->direction, b->direction, fabs(a->amplitude)))
        return false;
    return same_vector(a->velocity, b->velocity,
                       fabs(a->velocity[0]) + fabs(a->velocity[1]) + fabs(a->velocity[2])) &&
           history_same(&a->history, &b->history);
}

/* Each load's image must be among the loads as often as the load itself (two equal loads add). What a host
 * gives is like nothing but itself. */
static bool loads_are_symmetric(const struct scene *scene, int axis, double middle, double length)
{
    for (size_t i = 0; i < scene->loads; i++) {
        const struct load load = in_body_frame(&scene->body, &scene->load[i]);
        const struct load image = mirrored(&load, axis, middle);
        size_t equals = 0;
        size_t images = 0;
        for (size_t j = 0; j < scene->loads; j++) {
            if (i != j && (load.driven != BY_HISTORY || scene->load[j].driven != BY_HISTORY)) continue;
            const struct load other = in_body_frame(&scene->body, &scene->load[j]);
            equals += same_load(&load, &other, length);
            images += same_load(&image, &other, length);
        }
        if (equals != images) return false;
    }
    return true;
}

bool scene_load_repeats(const struct scene *scene, unsigned axes, size_t load, size_t other)
{
    const struct body *body = &scene->body;
    const struct load found = in_body_frame(body, &scene->load[other]);
    if (load == other) return true;
    for (unsigned planes = 1; planes < 8; planes++) {
        struct load image = in_body_frame(body, &scene->load[load]);
        double length = 0.0;
        if ((planes & ~axes) != 0) continue;
        for (int axis = 0; axis < scene->dimension; axis++) {
            length = fmax(length, body->high[axis] - body->low[axis]);
            if ((planes & 1u << axis) != 0)
                image = mirrored(&image, axis, 0.5 * (body->low[axis] + body->high[axis]));
        }
        if (same_load(&image, &found, length)) return true;
    }
    return false;
}

static bool faces_are_symmetric(const struct scene *scene, int axis)
{
    const struct boundary *low = &scene->boundary[2 * axis];
    const struct boundary *high = &scene->boundary[2 * axis + 1];
    if (low->kind != high->kind || boundary_moves(low)) return false;
    if (boundary_absorbs(low) &&
        (low->absorber != high->absorber || low->layer_points != high->layer_points ||
         low->layer_thickness != high->layer_thickness || low->layer_reflection != high->layer_reflection ||
         low->always != high->always || low->normal_factor != high->normal_factor ||
         low->shear_factor != high->shear_factor))
        return false;
    for (int face = 0; face < BOX_FACES; face++) {
        if (!boundary_moves(&scene->boundary[face])) continue;
        double direction[3];
        body_direction_from_deck(&scene->body, scene->boundary[face].direction, direction);
        if (fabs(direction[axis]) > 1e-12) return false;
    }
    return true;
}

/* The part must have more than twice as many cells as the degree, or its splines cannot have a mirror plane.
 */
static bool has_middle_points(const struct scene *scene, int axis)
{
    const struct deck_group *method = scene->method.group;
    const bool given = method != NULL && deck_values(method, "degree") > 0;
    const int chosen = scene->method.degree;
    const double degree = chosen > 0 ? chosen : given ? (double)deck_integer(method, "degree", 0) : 2.0;
    const struct body *body = &scene->body;
    const double cells = (body->high[axis] - body->low[axis]) / body->spacing;
    return cells > 4.0 * degree + 0.5 && same(cells, 2.0 * round(0.5 * cells), 1e4);
}

static bool mirrors_wanted(const struct scene *scene)
{
    return scene->method.group == NULL || deck_logical(scene->method.group, "symmetry", 0);
}

unsigned scene_mirror_axes(const struct scene *scene)
{
    const struct body *body = &scene->body;
    if (!body_is_box(body) || !mirrors_wanted(scene)) return 0;
    if (scene->initial.kind != INITIAL_REST || body->jitter != 0.0) return 0;
    unsigned axes = 0;
    for (int axis = 0; axis < scene->dimension; axis++) {
        if (ground_varies(scene, axis) || !topography_mirrors(body, scene->dimension, axis)) continue;
        const double middle = 0.5 * (body->low[axis] + body->high[axis]);
        const double length = body->high[axis] - body->low[axis];
        if (has_middle_points(scene, axis) && faces_are_symmetric(scene, axis) &&
            loads_are_symmetric(scene, axis, middle, length))
            axes |= 1u << axis;
    }
    return axes;
}

struct scene scene_below_mirrors(const struct scene *scene, unsigned axes)
{
    struct scene part = *scene;
    for (int axis = 0; axis < scene->dimension; axis++) {
        if ((axes & 1u << axis) == 0) continue;
        part.body.high[axis] = 0.5 * (scene->body.low[axis] + scene->body.high[axis]);
        part.boundary[2 * axis + 1] = (struct boundary){.kind = BOUNDARY_SYMMETRY, .given = true};
    }
    return part;
}
