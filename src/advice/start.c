/* States at t = 0: waves that the points do not carry, faces that cut them, the time error that stays in them. */
#include "advice/parts.h"

#include "scene/initial.h"
#include "scene/resolution.h"
#include "scene/topography.h"

#include <math.h>
#include <string.h>

/* A true place of a face, parts of its edges from its low corner along the other two axes. */
static void place_on_face(const struct scene *scene, int face, const double part[2], double place[3])
{
    const struct body *body = &scene->body;
    const struct topography *topography = body->topography;
    for (int axis = 0, other = 0; axis < 3; axis++) {
        const double low = body->low[axis], high = body->high[axis];
        place[axis] = axis == face / 2          ? face_plane(body, (enum face)face)
                      : axis < scene->dimension ? low + part[other++] * (high - low)
                                                : 0;
    }
    if (topography == NULL) return;
    double *down = &place[topography->axis];
    *down = topography_real(topography, topography_drop(topography, place), *down);
}

/* How far the surface of a hill or canyon lies above the state's centre, at the nearest place; below it: negative. */
static double distance_of_surface(const struct scene *scene, const double centre[3])
{
    enum { LOOKS = 16 };
    const struct topography *topography = scene->body.topography;
    const int down = topography->axis, rows = down == 2 ? LOOKS : 0;
    const double step = STATE_REACH * scene->initial.width / LOOKS;
    const double above =
        centre[down] - topography_real(topography, topography_drop(topography, centre), topography->plane);
    double nearest = fabs(above);
    for (int i = -LOOKS; i <= LOOKS; i++)
        for (int j = -rows; j <= rows; j++) {
            const double aside[2] = {i * step, j * step};
            const double place[2] = {centre[0] + aside[0], centre[1] + aside[1]};
            const double surface =
                topography_real(topography, topography_drop(topography, place), topography->plane);
            nearest = fmin(nearest, hypot(hypot(aside[0], aside[1]), surface - centre[down]));
        }
    return above < 0 ? -nearest : nearest;
}

/* Distance of a face from the centre of the state, along the face's normal; the least of a surface not level. */
static double distance(const struct scene *scene, int face)
{
    const struct topography *topography = scene->body.topography;
    double centre[3];
    ground_from_deck(&scene->body, scene->initial.centre, centre);
    if (topography != NULL && face == 2 * topography->axis) return distance_of_surface(scene, centre);
    return face_sign((enum face)face) * (face_plane(&scene->body, (enum face)face) - centre[face / 2]);
}

/* Does a P wave of the state leave this face as an S wave, too? */
static bool converts(const struct scene *scene, int face)
{
    static const double along = 1 - 1e-9;
    const struct initial *initial = &scene->initial;
    const struct boundary *boundary = &scene->boundary[face];
    double direction[3];
    if (scene->dimension == 1 || initial->shear || boundary_slides(boundary) || boundary_absorbs(boundary))
        return false;
    if (initial->kind == INITIAL_GAUSSIAN)
        return distance(scene, face) < scene_fastest(scene) * scene->end_time + STATE_REACH * initial->width;
    body_direction_from_deck(&scene->body, initial->direction, direction);
    return fabs(direction[face / 2]) < along;
}

/* Does what the state sends go on as slower waves? */
static bool slows_down(const struct scene *scene)
{
    bool slower = scene->materials > 1 || !body_is_box(&scene->body);
    for (int face = 0; face < 2 * scene->dimension && !slower; face++)
        slower = converts(scene, face);
    return slower;
}

/* Shortest wave that counts: exp(-(x/w)^2 / 2) has 5 % of its spectrum left at k w = 2.448, a wave of 2.567 w. It
 * keeps its frequency where it becomes a slower one: an S wave at faces, any in other rock. */
static double shortest_wave(const struct scene *scene, bool slower, bool train)
{
    const double wave = train ? scene->initial.wavelength : 2.567 * scene->initial.width;
    return slower ? wave * slowest_speed(scene) / plane_wave_speed(scene) : wave;
}

double error_of_waves(const struct scene *scene, const struct wave_law *law, double k, double way)
{
    const double points = 2 * M_PI / (k * scene->body.spacing);
    return k > 0 && isfinite(way)
               ? k * way / (2 * M_PI) * (law->floor + law->constant / pow(points, law->order))
               : 0;
}

bool on_splines(const struct model *model)
{
    return strcmp(model->method->variant, "consistent") == 0;
}

double longest_way(const struct scene *scene, double speed)
{
    double way = 0;
    for (int axis = 0; axis < scene->dimension; axis++) {
        const int open =
            boundary_absorbs(&scene->boundary[2 * axis]) + boundary_absorbs(&scene->boundary[2 * axis + 1]);
        const double edge = scene->body.high[axis] - scene->body.low[axis];
        way = fmax(way, open > 0 ? 2 * edge / open : INFINITY);
    }
    return fmin(way, speed * scene->end_time);
}

double typical_number(const struct scene *scene, double order)
{
    const struct initial *initial = &scene->initial;
    const bool plane = initial->kind == INITIAL_PLANE_WAVE;
    if (plane && initial->wavelength > 0) return 2 * M_PI / initial->wavelength;
    if (!plane && initial->kind != INITIAL_GAUSSIAN) return 0;
    const double half = 1 + (plane ? 1 : scene->dimension) / 2.;
    return pow(tgamma(half + order + 1) / tgamma(half), 0.5 / (order + 1)) / initial->width;
}

/* What the velocities of a pulse or a Gaussian err by (initial-states.md, Eq 3a). */
static double error_of_state(const struct scene *scene, const struct wave_law *law, bool slower)
{
    const bool plane = scene->initial.kind == INITIAL_PLANE_WAVE;
    const double speed = slower ? slowest_speed(scene) : plane_wave_speed(scene);
    const double way = longest_way(scene, speed);
    const double k = typical_number(scene, 0) * (slower ? plane_wave_speed(scene) / speed : 1);
    return (plane ? 1 : slower ? law->turned : law->spread) * error_of_waves(scene, law, k, way);
}

void look_at_short_waves(struct adviser *adviser, const struct model *model)
{
    static const double seen = .02;
    const struct scene *scene = adviser->scene;
    const struct initial *initial = &scene->initial;
    double centre[3];
    if (initial->kind != INITIAL_PLANE_WAVE && initial->kind != INITIAL_GAUSSIAN) return;
    body_from_deck(&scene->body, initial->centre, centre);
    const bool anywhere = initial->kind == INITIAL_PLANE_WAVE, train = anywhere && initial->wavelength > 0;
    const bool slower = slows_down(scene), told = scene_has_exact(scene);
    const double spacing = body_spacing_at(&scene->body, anywhere ? scene->body.high : centre);
    const double wave = shortest_wave(scene, slower, train);
    const double error = train ? 0 : error_of_state(scene, &model->waves, slower);
    if (spacing > 0 && wave < FEWEST_POINTS * spacing)
        advise(
            adviser,
            "%.3g points per wavelength of the initial state, as the slowest wave that it becomes; %g need "
            "body%%spacing = %.3g",
            wave / spacing, FEWEST_POINTS, wave / FEWEST_POINTS);
    else if (spacing > 0 && !told && error > seen && on_splines(model))
        advise(adviser,
               "the initial state's shortest waves, %.3g points each, let velocities err by about %.2g by "
               "end_time; body%%spacing = %.3g would be right",
               wave / spacing, fmin(1, error), spacing * pow(seen / 2 / error, 1 / model->waves.order));
}

/* What a face does to a displacement that reaches it; NULL: nothing, or mirrors.c tells. */
static const char *cut_by(const struct scene *scene, int face)
{
    const struct boundary *boundary = &scene->boundary[face];
    double direction[3];
    if (boundary_is_free(boundary))
        return "free, where it begins with a traction that the face does not bear: short waves that the "
               "points do not carry";
    if (boundary_absorbs(boundary)) return "absorbing, beyond which there is nothing of it";
    if (!boundary_slides(boundary))
        return "held, where it begins with a jump: short waves that the points do not "
               "carry";
    if (boundary_mirrors(boundary)) return NULL;
    body_direction_from_deck(&scene->body, scene->initial.direction, direction);
    const bool own_image =
        fabs(distance(scene, face)) <= 1e-6 * scene->initial.width && fabs(direction[face / 2]) < 1e-9;
    return own_image ? NULL
                     : "sliding, in which it is not its own image: short waves that the points do not carry";
}

/* Does a plane wave go by a face, or not reach it at t = 0? */
static bool suits(const struct scene *scene, int face)
{
    enum { LOOKS = 32 };
    const struct initial *initial = &scene->initial;
    const struct boundary *boundary = &scene->boundary[face];
    const struct body *body = &scene->body;
    const int axis = face / 2;
    double direction[3], motion[3], centre[3], least = INFINITY, most = -INFINITY;
    body_direction_from_deck(body, initial->direction, direction);
    body_direction_from_deck(body, initial->shear ? initial->polarisation : initial->direction, motion);
    ground_from_deck(body, initial->centre, centre);
    if (fabs(direction[axis]) < 1e-9 && fabs(motion[axis]) < 1e-9)
        return boundary_slides(boundary) || (initial->shear && boundary_is_free(boundary));
    if (fabs(direction[axis]) < 1e-9)
        return boundary_moves(boundary) && boundary->slip && !face_holds(scene, (enum face)face, axis);
    if (initial->wavelength > 0)
        return boundary_moves(boundary) && boundary->slip; /* what it holds is not looked at */
    for (int i = 0; i <= LOOKS; i++)
        for (int j = 0; j <= LOOKS; j++) {
            const double part[2] = {(double)i / LOOKS, (double)j / LOOKS};
            double place[3] = {0, 0, 0}, s = 0;
            place_on_face(scene, face, part, place);
            for (int c = 0; c < 3; c++)
                s += direction[c] * (place[c] - centre[c]);
            least = fmin(least, s);
            most = fmax(most, s);
        }
    return least > STATE_REACH * initial->width || most < -STATE_REACH * initial->width;
}

/* Does an S wave run along a face and move across it? */
static bool moves_across(const struct scene *scene, int face)
{
    double direction[3], motion[3];
    body_direction_from_deck(&scene->body, scene->initial.direction, direction);
    body_direction_from_deck(&scene->body, scene->initial.polarisation, motion);
    return scene->initial.shear && fabs(direction[face / 2]) < 1e-9 && fabs(motion[face / 2]) > 1e-9;
}

static void look_at_cut_wave(struct adviser *adviser)
{
    const struct scene *scene = adviser->scene;
    for (int face = 0; face < 2 * scene->dimension; face++) {
        const struct boundary *boundary = &scene->boundary[face];
        if (boundary_mirrors(boundary) || suits(scene, face)) continue; /* (mirrors.c tells) */
        char right[200];
        snprintf(right, sizeof right,
                 moves_across(scene, face)
                     ? "a support that holds motion along the wave alone (kind = 'displacement', direction "
                       "along the wave, slip = .true., amplitude = 0, history = 'step')"
                     : "a pulse that begins %g widths from it, or beside the wave faces that leave it as it "
                       "is (rollers; free ones, too, along which an S wave is polarised),",
                 STATE_REACH);
        advise(adviser,
               "face %s, %s, cuts the plane wave of t = 0 into short waves that the points do not carry; %s "
               "would be right",
               face_name((enum face)face),
               boundary_absorbs(boundary)   ? "absorbing"
               : boundary_is_free(boundary) ? "free"
               : boundary_slides(boundary)  ? "sliding"
                                            : "held",
               right);
        return;
    }
}

void look_at_cut_start(struct adviser *adviser)
{
    const struct scene *scene = adviser->scene;
    const double width = scene->initial.width;
    if (scene->initial.kind == INITIAL_PLANE_WAVE && !scene_has_exact(scene)) look_at_cut_wave(adviser);
    if (scene->initial.kind != INITIAL_GAUSSIAN) return;
    for (int face = 0; face < 2 * scene->dimension; face++) {
        const double away = distance(scene, face);
        if (away < -1e-9 * width) {
            advise(adviser, "the initial state lies outside the body, %.2g widths beyond face %s",
                   -away / width, face_name((enum face)face));
            return;
        }
        const char *cut = away <= STATE_REACH * width ? cut_by(scene, face) : NULL;
        if (cut == NULL) continue;
        advise(adviser,
               "the initial state reaches face %s, %.2g widths away and %s; %g widths from it would do",
               face_name((enum face)face), away / width, cut, STATE_REACH);
        return;
    }
}

/* A body that moves into a held face: a front of all wavelengths, beside which velocities err by the square root of the
 * spacing. */
void look_at_impact(struct adviser *adviser)
{
    const struct scene *scene = adviser->scene;
    double velocity[3];
    if (scene->initial.kind != INITIAL_UNIFORM_VELOCITY) return;
    body_direction_from_deck(&scene->body, scene->initial.velocity, velocity);
    for (int face = 0; face < 2 * scene->dimension; face++)
        for (int component = 0; component < scene->dimension; component++) {
            const bool mirror = boundary_mirrors(&scene->boundary[face]); /* mirrors.c tells */
            if (mirror || velocity[component] == 0 || !face_holds(scene, (enum face)face, component))
                continue;
            advise(
                adviser,
                "velocities jump at face %s, which is held, at t = 0: no spacing resolves their front (about "
                ".1 of them is wrong, less as the square root of the spacing); a face of kind 'velocity' "
                "with a smooth history would be right",
                face_name((enum face)face));
            return;
        }
}

double typical_frequency(const struct scene *scene)
{
    const double half = source_cutoff_at(scene, .5);
    return isfinite(half) ? half : 0;
}

/* Leapfrog runs ahead by omega t (omega dt)^2 / 24 (doc/theory/time-schemes.md), where the time-dispersion transform
 * cannot take that out. An exact solution tells of it, too. */
void look_at_time_error(struct adviser *adviser, const struct stepper *stepper)
{
    static const double seen = .02;
    const struct scene *scene = adviser->scene;
    const bool told = scene_has_exact(scene);
    const bool leapfrog = (stepper->scheme->can & SCHEME_UNWARPS) != 0 && stepper->model->self_adjoint;
    if (!leapfrog || stepper->unwarp || told) return;
    const double omega = fmax(typical_number(scene, 0) * plane_wave_speed(scene), typical_frequency(scene));
    const double phase = omega * scene->end_time * pow(omega * stepper->dt, 2) / 24;
    const bool better = scheme_serves(scheme_find("modified-equation"), stepper->model);
    if (phase > seen)
        advise(adviser,
               "the time error of scheme '%s' stays in the histories: waves that leave at t = 0 err by about "
               "%.2g by end_time; %sstepping%%safety = %.2g%s would be right",
               stepper->scheme->name, fmin(1, phase), better ? "scheme = 'modified-equation', or " : "",
               sqrt(seen / 2 / phase) * stepper->dt / stepper->limit, better ? "," : "");
}
