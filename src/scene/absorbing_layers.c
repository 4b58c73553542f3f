/* Absorbing layers as the scene asks for them: thickness, profile, and whether a face needs one at all
 * (doc/theory/absorbing-faces.md, sections 3, 6 and 7). */
#include "scene/absorbing_layers.h"
#include "scene/guided.h"
#include "scene/symmetry.h"

#include "scene/echo.h"
#include "scene/grading.h"
#include "scene/ground.h"

#include <float.h>
#include <math.h>
#include <string.h>

/* The reflection that a profile is made for falls with the number of points by this factor a point; then what
 * comes back from the outer end and what the lattice makes of the profile are about equal (measured). A pulse
 * that meets the absorbing layer at right angles sees twice that (measured); waves along a surface far less.
 */
static const double decay_per_point = .78, measured_part = 2;
static double decayed(size_t points)
{
    return exp(fmax(-decay_per_point * (double)points, log(DBL_MIN)));
}

double layer_expected_reflection(size_t points)
{
    return measured_part * decayed(points);
}

static bool given(const struct scene *scene, const char *word)
{
    return scene->method.group != NULL && deck_given(scene->method.group, word);
}

static bool asks_exact(const struct scene *scene)
{
    return given(scene, "mass") && strcmp(deck_text(scene->method.group, "mass", 0), "exact") == 0;
}

long layer_degree(const struct scene *scene)
{
    return given(scene, "degree") ? deck_integer(scene->method.group, "degree", 0) : 2;
}

double layer_cost(const struct scene *scene)
{
    static const double sweeps = 1.4, exact = 8; /* measured: 1.0 to 1.9, 6 to 10 */
    return asks_exact(scene) ? exact : sweeps;
}

double scene_work(const struct scene *scene)
{
    const unsigned mirrors = scene_mirror_axes(scene);
    double all = 1, slabs = 0;
    for (int c = 0; c < scene->dimension; c++) {
        const bool half = (mirrors & 1u << c) != 0;
        const double count = body_cells(&scene->body, c) / (half ? 2 : 1) + 1;
        const double layers =
            (double)(layer_points(scene, 2 * c) + (half ? 0 : layer_points(scene, 2 * c + 1)));
        all *= count + layers;
        slabs += layers / (count + layers);
    }
    return all * (1 + layer_cost(scene) * slabs);
}

double layer_steps(const struct scene *scene)
{
    const char *scheme = scene->stepping.scheme;
    const bool leapfrog =
        scheme[0] == '\0' ? scene->initial.kind == INITIAL_REST : strcmp(scheme, "leapfrog") == 0;
    return leapfrog ? 1 : sqrt(2);
}

/* What sources leave in a layer m cells away: as much as the inverse of the mass carries there, by the slowest root
 * of its polynomial; where they are filtered (method/spline/quiet.c), first as the filter's weights fall, then what it
 * leaves of that root. Measured in the plane, Poisson's ratio .14 to .49, and in space, where it is a quarter
 * (doc/verification/tables/absorbing.txt, table 8). */
struct tail {
    double begins, falls;
};
struct tails {
    struct tail near, far;
    double factor;
};

/* room: cells between the source and the nearest end of its axis of the lattice. */
static struct tails tails_of(const struct scene *scene, double room)
{
    static const double filtered_from = 8;
    static const struct tails sweeps = {{1.2, .194}, {0, .194}, 1};
    static const struct tails exact[2][3] = {
        {{{1.5, .431}, {0, .431}, 1}, {{1.5, .535}, {0, .535}, 1}, {{1.5, .608}, {0, .608}, 1}},
        {{{1.5, .431}, {0, .431}, 1}, {{2.1, .35}, {.13, .535}, 1}, {{2.1, .35}, {.2, .608}, 1}}};
    const long degree = layer_degree(scene), which = degree < 2 ? 0 : degree > 4 ? 2 : degree - 2;
    struct tails tails = asks_exact(scene) ? exact[room >= filtered_from][which] : sweeps;
    double ratio = 1.9;
    for (size_t m = 0; m < scene->materials; m++)
        ratio = fmax(ratio, scene->material[m].p_speed / scene->material[m].s_speed);
    tails.factor = pow(ratio / 1.9, .6) * (scene->dimension == 3 ? .25 : 1);
    return tails;
}

double layer_left_behind(const struct scene *scene, double room, double cells)
{
    const struct tails tails = tails_of(scene, room);
    const double m = fmax(cells, 0);
    return tails.factor *
           fmax(tails.near.begins * pow(tails.near.falls, m), tails.far.begins * pow(tails.far.falls, m));
}

static double cells_until(struct tail tail, double left)
{
    return log(left / tail.begins) / log(tail.falls);
}

double layer_clearance(const struct scene *scene, double room)
{
    const struct tails tails = tails_of(scene, room);
    const double allowed = (asks_exact(scene) ? 5e-4 : 1e-3) / tails.factor;
    return fmax(cells_until(tails.near, allowed), cells_until(tails.far, allowed));
}

const char *layers_refusal(const struct scene *scene)
{
    if (strcmp(scene->method.variant, "consistent") != 0) return "this method has no absorbing layers";
    if (!body_is_box(&scene->body)) return "only boxes and half-spaces have absorbing layers";
    if (scene->dimension == 1) return "in one dimension they send nothing back";
    if (!asks_exact(scene) && layer_degree(scene) > 2)
        return "absorbing layers at degree 3 and more need method%mass = 'exact'";
    if (given(scene, "tuned") && deck_logical(scene->method.group, "tuned", 0))
        return "absorbing layers need splines that are not tuned";
    const char *scheme = scene->stepping.scheme;
    if (scheme[0] != '\0' && strcmp(scheme, "leapfrog") != 0 && strcmp(scheme, "modified-equation") != 0)
        return "absorbing layers need stepping%scheme = 'leapfrog' or 'modified-equation'";
    return NULL;
}

static bool layer_unneeded(const struct scene *scene, int face)
{
    return !scene->boundary[face].always && !echo_seen(scene, face, 4 * scene->body.spacing);
}

static bool layer_asked(const struct scene *scene, int face)
{
    return body_is_box(&scene->body) && boundary_has_layer(&scene->boundary[face]);
}

static size_t within_limits(double points, size_t least)
{
    return (size_t)fmin(fmax(points, (double)least), MOST_POINTS);
}

double layer_spacing(const struct scene *scene, int face)
{
    const struct grading *grading = scene->body.grading;
    if (grading == NULL || face / 2 != grading->axis) return scene->body.spacing;
    return grading->step * grading_stretch(grading, face_plane(&scene->body, (enum face)face));
}

bool layer_needed(const struct scene *scene, int face)
{
    return layer_asked(scene, face) && !layer_unneeded(scene, face);
}

size_t layer_points(const struct scene *scene, int face)
{
    const struct boundary *boundary = &scene->boundary[face];
    if (!layer_needed(scene, face)) return 0;
    if (boundary->layer_points > 0) return (size_t)boundary->layer_points;
    if (boundary->layer_thickness > 0)
        return within_limits(ceil(boundary->layer_thickness / layer_spacing(scene, face) - 1e-9),
                             LEAST_POINTS);
    if (boundary->layer_reflection > 0)
        return within_limits(ceil(log(measured_part / boundary->layer_reflection) / decay_per_point - 1e-9),
                             LEAST_POINTS);
    return within_limits(fmax((double)echo_points(scene, face), (double)boundary->least_points),
                         LAYER_POINTS);
}

bool layer_anywhere(const struct scene *scene)
{
    for (int face = 0; face < 2 * scene->dimension; face++)
        if (layer_points(scene, face) > 0) return true;
    return false;
}

bool block_goes_on(const struct scene *scene, const struct ground_block *block, int face)
{
    const int axis = face / 2, sign = face_sign((enum face)face);
    const double plane = sign * face_plane(&scene->body, (enum face)face) - GROUND_FILM * scene->body.spacing;
    return sign * block->centre[axis] + block->half[axis] > plane;
}

/* Does the rock change within the layer behind a face, as far out as it may go? (A surface is level there.) */
static bool ground_changes_behind(const struct scene *scene, int face)
{
    const struct body *body = &scene->body;
    const int axis = face / 2, sign = face_sign((enum face)face);
    const bool across_depth = axis == scene->dimension - 1;
    const bool model =
        scene->deck != NULL && deck_count(scene->deck, "model") > 0; /* known before the box is */
    if (model || (body_is_layered(body) && !across_depth)) return true;
    for (size_t i = 0; i < body->layers; i++)
        if (layer_leans(&body->layer[i]) ||
            (sign > 0 && body->layer[i].top > body->high[axis] - body->low[axis]))
            return true;
    for (size_t i = 0; i < body->blocks; i++)
        if (block_goes_on(scene, &body->block[i], face)) return true;
    return false;
}

double ground_contrast(const struct scene *scene)
{
    double fastest = 0, slowest = INFINITY;
    for (size_t m = 0; m < scene->materials; m++) {
        fastest = fmax(fastest, scene->material[m].s_speed);
        slowest = fmin(slowest, scene->material[m].s_speed);
    }
    return slowest > 0 ? fastest / slowest : INFINITY;
}

/* Against guided waves: the share of d in (11), and the least R of (9), by whose logarithm they grow; measured, in
 * ground by its contrast of speeds. */
struct guiding {
    double share, least;
};

static struct guiding guiding(const struct scene *scene, int face)
{
    static const struct guiding none = {0, 0}, ground = {.3, 0}, plate = {1.2, .02}, rigid = {3, .05};
    for (int axis = 0; axis < scene->dimension; axis++)
        if (faces_guide(scene, axis)) return plate;
    if (!ground_changes_behind(scene, face)) return none;
    const double contrast = ground_contrast(scene);
    return contrast <= 4 ? ground : contrast <= 8 ? plate : rigid;
}

double layer_least_reflection(const struct scene *scene, int face)
{
    const double least = guiding(scene, face).least;
    return least > 0 && guided_briefly(scene) ? 0 : least;
}

double layer_profile_reflection(const struct scene *scene, int face, size_t points)
{
    return fmax(decayed(points), layer_least_reflection(scene, face));
}

double layer_drag(const struct scene *scene, int face)
{
    return guiding(scene, face).share;
}

double layer_stretch(const struct scene *scene, int face, size_t points)
{
    static const double dragged = .6;
    const double whole = log(1 / layer_profile_reflection(scene, face, points));
    return layer_drag(scene, face) > 0 ? dragged * whole : whole;
}

bool layer_left_out(const struct scene *scene, int face)
{
    return layer_asked(scene, face) && layer_unneeded(scene, face);
}
