/* What the faces of a box send back (see the header).
 *
 * The way of a wave from what acts over the face to what is looked at is no shorter than the sum of their
 * distances from the face. A box has few faces, extents and pairs of them: all pairs are looked at. */
#include "scene/echo.h"

#include "scene/absorbing_layers.h"
#include "scene/late.h"

#include <math.h>

/* Distance of an extent from a face, 0 where it reaches it; or of its mirror image where the opposite face is
 * a symmetry plane. */
static double distance(const struct scene *scene, int face, const struct extent *extent)
{
    const struct body *body = &scene->body;
    const int axis = face / 2, sign = face % 2 == 0 ? -1 : 1;
    const double plane = sign * (sign < 0 ? body->low[axis] : body->high[axis]);
    const double mirror = sign * (sign < 0 ? body->high[axis] : body->low[axis]);
    const double near = sign < 0 ? -extent->low[axis] : extent->high[axis];
    const double far = sign < 0 ? -extent->high[axis] : extent->low[axis];
    const bool mirrored = boundary_mirrors(&scene->boundary[face ^ 1]);
    return fmax(0, plane - (mirrored ? fmax(near, 2 * mirror - far) : near));
}

double echo_way(const struct scene *scene, int face, const struct extent *acts, const struct extent *seen)
{
    return distance(scene, face, acts) + distance(scene, face, seen);
}

bool echo_seen(const struct scene *scene, int face, double less)
{
    const double speed = 1.02 * scene_first(scene);
    struct extent seen, acts;
    bool looked = false;
    for (size_t k = 0; scene_extent(scene, k, &acts); k++)
        looked = looked || acts.role == EXTENT_SEEN;
    for (size_t k = 0; scene_extent(scene, k, &acts); k++) {
        const double left = distance(scene, face, &acts) - less;
        for (size_t i = 0; acts.role == EXTENT_ACTS && scene_extent(scene, i, &seen); i++)
            if (seen.role == EXTENT_SEEN &&
                left + distance(scene, face, &seen) <= speed * (seen.until - acts.from))
                return true;
    }
    return !looked;
}

/* One behind which ground goes on that is not computed. */
static bool is_open(const struct scene *scene, int face)
{
    const struct boundary *boundary = &scene->boundary[face];
    const bool surface = face == 2 * scene->dimension - 2;
    return layer_left_out(scene, face) ||
           (scene->body.chosen && !surface && !boundary->given && boundary_is_free(boundary));
}

int echo_heard(const struct scene *scene, const struct extent *seen, double time)
{
    const double reach = scene_first(scene) * time;
    struct extent acts;
    for (int face = 0; body_is_box(&scene->body) && face < 2 * scene->dimension; face++) {
        if (!is_open(scene, face)) continue;
        const double back = distance(scene, face, seen);
        for (size_t k = 0; back < reach && scene_extent(scene, k, &acts); k++)
            if (acts.role == EXTENT_ACTS && distance(scene, face, &acts) + back < reach) return face;
    }
    return FACES;
}

/* --- Absorbing layers ----------------------------------------------------------------------------------- */

/* What a layer of n points sends back, over the velocity at the place that is looked at,
 *   e = A (exp(-.7 n) (Lambda/h)^1.65 max(1, r/d)^1.6 + .4 exp(-.2 n) (c_p/c_s / sqrt(3))^2.6),            (15)
 * Lambda the P wavelength, h the spacing, r the way along the face, d the way to it and back; measured
 * (regress/studies/echo; doc/theory/absorbing-faces.md, section 7). In the plane waves spread out less, and not at
 * all where all moves along the depth alone. */
static const double decay = .7, wavelength_power = 1.65, grazing_power = 1.6;
static const double late_part = .4, late_decay = .2, late_power = 2.6;
static const double in_plane = .012, in_space = .0025, along_depth = .043;
/* And where velocities in the layer are damped besides, at the share s against guided waves,
 *   e = B s max(1, r/d)^.6 Lambda / h n^(-10/3) min(1, Lambda / (h n)):                                    (16)
 * what weak damping scatters back within a stretched coordinate, B by measurement. */
static const double dragged_in_plane = 3.5, dragged_in_space = 1, dragged_grazing = .6;
static const double dragged_power = 10. / 3;
/* And where the splines are of degree 1, whose errors in the stretched coordinate fall as n^-2, by measurement:
 *   e = B Lambda / h n^-2.                                                                                (16a) */
static const double linear_in_plane = .45, linear_in_space = .07;
/* Of a static field no more is felt than belongs to waves of so many times the way from load to receiver. */
static const double static_reach = 4;
/* Wanted of a layer whose thickness the deck leaves open: what the points themselves err falls with the
 * spacing, so this falls too, and a finer scene is never a worse one. */
static const double most_wanted = 1e-3, coarse = 12;
/* Of the part (16): of all faces together, in squares. */
static const double most_dragged = 4e-3;
enum { MOST = 40 };

/* Longest distance between two extents along the face, as far as the box goes. */
static double way_along(const struct scene *scene, int face, const struct extent *one,
                        const struct extent *other)
{
    const struct body *body = &scene->body;
    double way = 0;
    for (int c = 0; c < scene->dimension; c++) {
        if (c == face / 2) continue;
        const double low = fmax(one->low[c], body->low[c]), high = fmin(one->high[c], body->high[c]);
        const double from = fmax(other->low[c], body->low[c]), to = fmin(other->high[c], body->high[c]);
        way = hypot(way, fmax(0, fmax(high - from, to - low)));
    }
    return way;
}

/* Wavelength of what one sends to the other: of a static field no more than is felt, and never more than the
 * run lets pass. */
static double wavelength_between(const struct scene *scene, const struct extent *acts, double way)
{
    const double felt = acts->plane ? INFINITY : way * static_reach;
    return fmin(acts->wavelength, fmin(felt, scene_fastest(scene) * scene->end_time));
}

struct echo {
    double early, late; /* the factor of exp(-.7 n) and .4 (...)^2.6 in (15) */
    double grazing;     /* max(1, r/d) */
    double wavelength;  /* the longest */
    bool plane;         /* what acts moves all along the depth alone */
};

static void take_worst(const struct scene *scene, int face, const struct extent *acts,
                       const struct extent *seen, struct echo *worst)
{
    const double h = layer_spacing(scene, face);
    const double way = acts->plane ? 0 : way_along(scene, face, acts, seen);
    const double across = fmax(distance(scene, face, acts) + distance(scene, face, seen), h);
    const double wavelength = wavelength_between(scene, acts, fmax(way, across));
    worst->wavelength = fmax(worst->wavelength, wavelength);
    const double grazing = fmax(1, way / across);
    worst->grazing = fmax(worst->grazing, grazing);
    worst->plane = worst->plane || acts->plane;
    worst->early =
        fmax(worst->early, pow(fmax(1, wavelength / h), wavelength_power) * pow(grazing, grazing_power));
}

static struct echo worst_echo(const struct scene *scene, int face)
{
    struct echo worst = {0};
    struct extent acts, seen;
    double ratio = sqrt(3.);
    for (size_t m = 0; m < scene->materials; m++)
        ratio = fmax(ratio, scene->material[m].p_speed / scene->material[m].s_speed);
    worst.late = late_part * pow(ratio / sqrt(3.), late_power);
    for (size_t k = 0; scene_extent(scene, k, &acts); k++)
        for (size_t i = 0; acts.role == EXTENT_ACTS && scene_extent(scene, i, &seen); i++)
            if (seen.role == EXTENT_SEEN) take_worst(scene, face, &acts, &seen, &worst);
    return worst;
}

static double of_points(const struct scene *scene, const struct echo *echo, size_t points)
{
    const double n = (double)points;
    return (echo->plane             ? along_depth
            : scene->dimension == 3 ? in_space
                                    : in_plane) *
           (echo->early * exp(-decay * n) + echo->late * exp(-late_decay * n));
}

/* (16) */
static double of_drag(const struct scene *scene, int face, const struct echo *echo, size_t points)
{
    const double n = fmax(1, (double)points), waves = echo->wavelength / layer_spacing(scene, face);
    return (scene->dimension == 3 ? dragged_in_space : dragged_in_plane) * layer_drag(scene, face) *
           pow(echo->grazing, dragged_grazing) * waves * pow(n, -dragged_power) * fmin(1, waves / n);
}

/* (16a) */
static double of_linear(const struct scene *scene, int face, const struct echo *echo, size_t points)
{
    const double waves = echo->wavelength / layer_spacing(scene, face), n = fmax(1, (double)points);
    if (layer_degree(scene) != 1) return 0;
    return (scene->dimension == 3 ? linear_in_space : linear_in_plane) * waves / (n * n);
}

double echo_of_layer(const struct scene *scene, int face, size_t points)
{
    const struct echo echo = worst_echo(scene, face);
    return of_points(scene, &echo, points) + of_drag(scene, face, &echo, points) +
           of_linear(scene, face, &echo, points) + layer_least_reflection(scene, face);
}

/* Of what all faces may send back by (16), the share of one. */
static double share_of_drag(const struct scene *scene)
{
    int faces = 0;
    for (int face = 0; face < 2 * scene->dimension; face++)
        if (layer_needed(scene, face) && layer_drag(scene, face) > 0) faces++;
    return 1 / sqrt(fmax(1, faces));
}

size_t echo_points(const struct scene *scene, int face)
{
    const struct echo echo = worst_echo(scene, face);
    const struct lates lates = late_worst(scene, face);
    const double h = layer_spacing(scene, face), finer = coarse * h / fmax(echo.wavelength, h);
    const double wanted = most_wanted * fmin(1, finer), dragged = most_dragged * share_of_drag(scene);
    size_t points = 0;
    while (points < MOST &&
           (of_points(scene, &echo, points) > wanted || of_drag(scene, face, &echo, points) > dragged ||
            late_of_points(scene, face, &lates, points) > wanted))
        points++;
    return points;
}
