/* Cuts through the ground (see the header). */
#include "record/plots/cut.h"

#include "base/memory.h"
#include "scene/absorbing_layers.h"
#include "scene/ground.h"
#include "scene/topography.h"

#include <math.h>
#include <string.h>

enum { PIXELS = 420, LEAST_PIXELS = 120 };

/* Extent of the absorbing layers behind the six faces. */
static void cut_layers(const struct scene *scene, double thickness[BOX_FACES])
{
    for (int face = 0; face < BOX_FACES; face++)
        thickness[face] =
            face < 2 * scene->dimension ? (double)layer_points(scene, face) * layer_spacing(scene, face) : 0;
}

/* How far the surface lies below face z-, or y-, of the body. */
static double drop_at(const struct scene *scene, const double place[3])
{
    return scene->body.topography == NULL ? 0 : topography_drop(scene->body.topography, place);
}

/* A section reaches up to the highest place of the surface along it. */
static void reach_up(const struct scene *scene, struct cut *cut)
{
    const int last = scene->dimension - 1;
    for (int i = 0; i <= PIXELS && scene->body.topography != NULL; i++) {
        double place[3];
        const double at = cut->low[0] + (cut->high[0] - cut->low[0]) * i / PIXELS;
        for (int axis = 0; axis < 3; axis++)
            place[axis] = cut->origin[axis] + at * cut->along[axis];
        cut->low[1] = fmin(cut->low[1], scene->body.low[last] + 1.1 * drop_at(scene, place));
        cut->body_low[1] = cut->low[1];
    }
}

/* Pixels that are nearly square. */
static void choose_pixels(struct cut *cut)
{
    const double size[2] = {cut->high[0] - cut->low[0], cut->high[1] - cut->low[1]};
    for (int side = 0; side < 2; side++) {
        const double part = size[side] / fmax(size[0], size[1]);
        cut->pixels[side] = (size_t)fmax(LEAST_PIXELS, round(PIXELS * part));
    }
}

static void set_axis(const struct scene *scene, struct cut *cut, int side, int axis)
{
    double thickness[BOX_FACES];
    cut_layers(scene, thickness);
    snprintf(cut->name[side], sizeof cut->name[side], "%c%s", "xyz"[axis], own_axes(&scene->body));
    (side == 0 ? cut->along : cut->across)[axis] = 1;
    cut->body_low[side] = scene->body.low[axis];
    cut->body_high[side] = scene->body.high[axis];
    cut->low[side] = scene->body.low[axis] - thickness[2 * axis];
    cut->high[side] = scene->body.high[axis] + thickness[2 * axis + 1];
    cut->face[side][0] = 2 * axis;
    cut->face[side][1] = 2 * axis + 1;
}

void cut_map(const struct scene *scene, struct cut *cut)
{
    *cut = (struct cut){.downwards = false};
    set_axis(scene, cut, 0, 0);
    set_axis(scene, cut, 1, 1);
    cut->origin[2] = scene->body.low[2];
    choose_pixels(cut);
}

/* Where a line through `from` leaves a box, in lengths of `along`. */
static void clip(const double low[2], const double high[2], const double from[3], const double along[3],
                 double range[2])
{
    range[0] = -INFINITY;
    range[1] = INFINITY;
    for (int axis = 0; axis < 2; axis++) {
        if (along[axis] == 0) continue;
        const double one = (low[axis] - from[axis]) / along[axis],
                     other = (high[axis] - from[axis]) / along[axis];
        range[0] = fmax(range[0], fmin(one, other));
        range[1] = fmin(range[1], fmax(one, other));
    }
}

void cut_section(const struct scene *scene, const double from[3], const double to[3], struct cut *cut)
{
    const int last = scene->dimension - 1;
    const double sign = to[0] < from[0] ? -1 : 1; /* A is on the left */
    const double way[2] = {sign * (to[0] - from[0]), sign * (to[1] - from[1])},
                 length = hypot(way[0], way[1]);
    *cut = (struct cut){.downwards = ground_has_depth(scene)};
    set_axis(scene, cut, 1, last);
    const double straight = 1e-3 * length;
    if (last == 1 || fabs(way[1]) <= straight || fabs(way[0]) <= straight) {
        const int axis = last == 1 || fabs(way[1]) <= straight ? 0 : 1;
        set_axis(scene, cut, 0, axis);
        if (last == 2) cut->origin[1 - axis] = from[1 - axis];
    } else {
        double thickness[BOX_FACES], low[2], high[2], range[2][2];
        cut_layers(scene, thickness);
        for (int axis = 0; axis < 2; axis++) {
            cut->along[axis] = way[axis] / length;
            low[axis] = scene->body.low[axis] - thickness[2 * axis];
            high[axis] = scene->body.high[axis] + thickness[2 * axis + 1];
        }
        clip(low, high, from, cut->along, range[0]);
        clip(scene->body.low, scene->body.high, from, cut->along, range[1]);
        for (int axis = 0; axis < 2; axis++)
            cut->origin[axis] = from[axis] + range[0][0] * cut->along[axis];
        snprintf(cut->name[0], sizeof cut->name[0], "distance along A-B");
        cut->high[0] = range[0][1] - range[0][0];
        cut->body_low[0] = range[1][0] - range[0][0];
        cut->body_high[0] = range[1][1] - range[0][0];
        cut->face[0][0] = cut->face[0][1] = -1;
    }
    reach_up(scene, cut);
    choose_pixels(cut);
}

static double pixel_place(const struct cut *cut, int side, size_t i)
{
    return cut->low[side] + (cut->high[side] - cut->low[side]) * ((double)i + .5) / (double)cut->pixels[side];
}

/* A map shows the surface. */
static void to_surface(const struct scene *scene, const struct cut *cut, double place[3])
{
    if (scene->dimension == 3 && cut->across[2] == 0) place[2] = scene->body.low[2] + drop_at(scene, place);
}

static void pixel(const struct scene *scene, const struct cut *cut, size_t i, double place[3])
{
    for (int axis = 0; axis < 3; axis++)
        place[axis] = cut->origin[axis] + pixel_place(cut, 0, i % cut->pixels[0]) * cut->along[axis] +
                      pixel_place(cut, 1, i / cut->pixels[0]) * cut->across[axis];
    to_surface(scene, cut, place);
}

bool cut_fill(const struct scene *scene, struct cut *cut)
{
    const size_t count = cut->pixels[0] * cut->pixels[1];
    for (int which = 0; which < 2; which++) {
        cut->speed[which] = array_new(count, sizeof *cut->speed[which]);
        cut->least[which] = INFINITY;
        if (cut->speed[which] == NULL) return false;
    }
    for (size_t i = 0; i < count; i++) {
        double place[3];
        pixel(scene, cut, i, place);
        const double surface = scene->body.low[scene->dimension - 1] + drop_at(scene, place);
        if (place[scene->dimension - 1] < surface) { /* air */
            cut->speed[0][i] = cut->speed[1][i] = (float)NAN;
            continue;
        }
        const struct rock rock = ground_at(scene, place);
        const double speed[2] = {sqrt(rock.mu / rock.density),
                                 sqrt((rock.lambda + 2 * rock.mu) / rock.density)};
        for (int which = 0; which < 2; which++) {
            cut->speed[which][i] = (float)speed[which];
            cut->least[which] = fmin(cut->least[which], speed[which]);
            cut->greatest[which] = fmax(cut->greatest[which], speed[which]);
        }
    }
    return true;
}

double cut_project(const struct cut *cut, const double place[3], double at[2])
{
    double away[3], square = 0;
    at[0] = at[1] = 0;
    for (int axis = 0; axis < 3; axis++) {
        at[0] += (place[axis] - cut->origin[axis]) * cut->along[axis];
        at[1] += (place[axis] - cut->origin[axis]) * cut->across[axis];
    }
    for (int axis = 0; axis < 3; axis++) {
        away[axis] = place[axis] - cut->origin[axis] - at[0] * cut->along[axis] - at[1] * cut->across[axis];
        square += away[axis] * away[axis];
    }
    return sqrt(square);
}

static double contrast(const struct rock *one, const struct rock *other)
{
    const double a[] = {one->mu, one->lambda + 2 * one->mu, one->density},
                 b[] = {other->mu, other->lambda + 2 * other->mu, other->density};
    double most = 0;
    for (int n = 0; n < 3; n++)
        most = fmax(most, fabs(a[n] - b[n]) / fmin(a[n], b[n]));
    return most;
}

/* Does the rock jump between two pixels? A gradient fades when the way between them is halved. */
static bool jumps(const struct scene *scene, const struct cut *cut, size_t one, size_t other)
{
    static const double part = .02;
    enum { HALVINGS = 6 };
    if (isnan(cut->speed[0][one] + cut->speed[0][other])) return false;
    if (fabsf(cut->speed[0][one] - cut->speed[0][other]) <= (float)part / 4 * cut->speed[0][one] &&
        fabsf(cut->speed[1][one] - cut->speed[1][other]) <= (float)part / 4 * cut->speed[1][one])
        return false;
    double place[2][3], middle[3];
    pixel(scene, cut, one, place[0]);
    pixel(scene, cut, other, place[1]);
    struct rock rock[2] = {ground_at(scene, place[0]), ground_at(scene, place[1])};
    for (int n = 0; n < HALVINGS; n++) {
        for (int axis = 0; axis < 3; axis++)
            middle[axis] = (place[0][axis] + place[1][axis]) / 2;
        to_surface(scene, cut, middle);
        const struct rock between = ground_at(scene, middle);
        const int end = contrast(&rock[0], &between) > contrast(&between, &rock[1]) ? 1 : 0;
        rock[end] = between;
        memcpy(place[end], middle, sizeof middle);
    }
    return contrast(&rock[0], &rock[1]) > part;
}

bool cut_write_jumps(const struct scene *scene, const struct cut *cut, FILE *script)
{
    bool found = false;
    for (size_t j = 0; j < cut->pixels[1]; j++)
        for (size_t i = 0; i < cut->pixels[0]; i++) {
            const size_t here = j * cut->pixels[0] + i;
            const bool next[2] = {i + 1 < cut->pixels[0] && jumps(scene, cut, here, here + 1),
                                  j + 1 < cut->pixels[1] && jumps(scene, cut, here, here + cut->pixels[0])};
            for (int side = 0; side < 2; side++) {
                if (!next[side]) continue;
                const double half = (cut->high[side] - cut->low[side]) / (double)cut->pixels[side] / 2;
                found = true;
                fprintf(script, "%.9g %.9g\n", pixel_place(cut, 0, i) + (side == 0 ? half : 0),
                        pixel_place(cut, 1, j) + (side == 1 ? half : 0));
            }
        }
    return found;
}

/* The surface at a coordinate along a cut; of a map and of level ground the page's upper end. */
static double upper_end(const struct scene *scene, const struct cut *cut, double at)
{
    const int last = scene->dimension - 1;
    if (scene->body.topography == NULL || cut->across[last] == 0) return cut->low[1];
    double place[3];
    for (int axis = 0; axis < 3; axis++)
        place[axis] = cut->origin[axis] + at * cut->along[axis];
    return scene->body.low[last] + drop_at(scene, place);
}

void cut_write_surface(const struct scene *scene, const struct cut *cut, FILE *script)
{
    if (scene->body.topography == NULL || cut->across[scene->dimension - 1] == 0) return;
    for (int i = 0; i <= PIXELS; i++) {
        const double at = cut->low[0] + (cut->high[0] - cut->low[0]) * i / PIXELS;
        fprintf(script, "%.9g %.9g\n", at, upper_end(scene, cut, at));
    }
}

void cut_write_part(const struct scene *scene, const struct cut *cut, const double low[2],
                    const double high[2], FILE *script)
{
    for (int i = 0; i <= PIXELS; i++) {
        const double at = low[0] + (high[0] - low[0]) * i / PIXELS;
        fprintf(script, "%.9g %.9g\n", at, fmax(low[1], upper_end(scene, cut, at)));
    }
    fprintf(script, "%.9g %.9g\n%.9g %.9g\n", high[0], high[1], low[0], high[1]);
    fprintf(script, "%.9g %.9g\n\n", low[0], fmax(low[1], upper_end(scene, cut, low[0])));
}

bool cut_write_layers(const struct scene *scene, const struct cut *cut, FILE *script)
{
    bool found = false;
    for (int side = 0; side < 2; side++)
        for (int end = 0; end < 2; end++) {
            double low[2] = {cut->low[0], cut->low[1]}, high[2] = {cut->high[0], cut->high[1]};
            if (end == 0)
                high[side] = cut->body_low[side];
            else
                low[side] = cut->body_high[side];
            if (side == 1) { /* corners once */
                low[0] = cut->body_low[0];
                high[0] = cut->body_high[0];
            }
            if (!(high[side] - low[side] > 1e-9 * (cut->high[side] - cut->low[side]))) continue;
            cut_write_part(scene, cut, low, high, script);
            found = true;
        }
    return found;
}

bool cut_write_speed(const struct cut *cut, int which, FILE *data)
{
    const size_t count = cut->pixels[0] * cut->pixels[1];
    return fwrite(cut->speed[which], sizeof *cut->speed[which], count, data) == count;
}

void cut_free(struct cut *cut)
{
    for (int which = 0; which < 2; which++)
        array_free(cut->speed[which]);
}
