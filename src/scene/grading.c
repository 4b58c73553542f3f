/* Spacing that grows over depth with the speed of the rock (see the header). */
#include "scene/grading.h"

#include "base/memory.h"
#include "scene/ground.h"
#include "scene/topography.h"

#include <math.h>

/* From cell to cell at most; cells below slower rock that stay as they are: what averages of the ground reach. */
static const double growth = .1, clearance = 2.5;
static const double small = 1e-9;

/* --- The map ---------------------------------------------------------------------------------------------- */

double grading_real(const struct grading *grading, double lattice)
{
    if (grading == NULL) return lattice;
    const double t = (lattice - grading->low) / grading->step;
    if (t <= 0) return grading->place[0] + t * grading->step * grading->stretch[0];
    const size_t cells = grading->cells, i = t < (double)cells ? (size_t)t : cells;
    const double part = t - (double)i, rise = i < cells ? grading->stretch[i + 1] - grading->stretch[i] : 0;
    return grading->place[i] + grading->step * part * (grading->stretch[i] + rise * part / 2);
}

/* The last knot that is not below a place. */
static size_t knot_above(const struct grading *grading, double real)
{
    size_t low = 0, high = grading->cells;
    while (low < high) {
        const size_t middle = (low + high + 1) / 2;
        if (grading->place[middle] <= real)
            low = middle;
        else
            high = middle - 1;
    }
    return low;
}

double grading_lattice(const struct grading *grading, double real)
{
    if (grading == NULL) return real;
    if (real <= grading->place[0]) return grading->low + (real - grading->place[0]) / grading->stretch[0];
    const size_t i = knot_above(grading, real);
    const double from = grading->stretch[i], rise = i < grading->cells ? grading->stretch[i + 1] - from : 0;
    const double way = (real - grading->place[i]) / grading->step;
    const double part = 2 * way / (from + sqrt(from * from + 2 * rise * way));
    return grading->low + grading->step * ((double)i + part);
}

double grading_stretch(const struct grading *grading, double lattice)
{
    if (grading == NULL) return 1;
    const double t = (lattice - grading->low) / grading->step;
    if (t <= 0) return grading->stretch[0];
    if (t >= (double)grading->cells) return grading->stretch[grading->cells];
    const size_t i = (size_t)t;
    return grading->stretch[i] + (t - (double)i) * (grading->stretch[i + 1] - grading->stretch[i]);
}

void grading_free(struct grading *grading)
{
    if (grading == NULL) return;
    array_free(grading->place);
    array_free(grading->stretch);
    array_free(grading);
}

/* --- The ground ------------------------------------------------------------------------------------------- */

/* Speeds of S waves over the body, half a spacing apart over depth. */
struct slowest {
    size_t count;
    double step, *speed; /* [count] the slowest there and below */
};

/* The slowest in a piece of a column, on either side of where the rock jumps too. Jumps stand where pieces end, and
 * these are known but for rounding: what lies within `near` of the ends is that of the piece beyond. */
static double slowest_in(const struct scene *scene, double place[3], double from, double to, double *jump)
{
    const int axis = scene->dimension - 1;
    const double near = small * (to - from);
    const size_t count = ground_jumps(scene, place, axis, from + near, to - near, jump);
    double slowest = INFINITY, speed[2];
    for (size_t n = 0; n < 2 * count + 3; n++) {
        const double side = n % 2 == 0 ? -near : near;
        place[axis] = n < 2 * count    ? jump[n / 2] + side
                      : n == 2 * count ? from + near
                      : n % 2 == 1     ? (from + to) / 2
                                       : to - near;
        ground_speeds_at(scene, place, speed);
        slowest = fmin(slowest, speed[1]);
    }
    return slowest;
}

static bool find_slowest(const struct scene *scene, struct slowest *found)
{
    const struct body *body = &scene->body;
    const int axis = scene->dimension - 1;
    size_t columns[2] = {1, 1};
    for (int other = 0; other < axis; other++)
        if (ground_varies(scene, other))
            columns[other] = (size_t)((body->high[other] - body->low[other]) / body->spacing + 1.5);
    found->count = (size_t)ceil(2 * (body->high[axis] - body->low[axis]) / body->spacing - small);
    found->step = (body->high[axis] - body->low[axis]) / (double)found->count;
    found->speed = array_new(found->count, sizeof *found->speed);
    double *jump = array_new(ground_jumps_at_most(scene) + 1, sizeof *jump);
    for (size_t k = found->count; found->speed != NULL && jump != NULL && k-- > 0;) {
        found->speed[k] = k + 1 < found->count ? found->speed[k + 1] : INFINITY;
        const double from = body->low[axis] + (double)k * found->step;
        for (size_t n = 0; n < columns[0] * columns[1]; n++) {
            const size_t column = n % columns[0], row = n / columns[0];
            double place[3] = {body->low[0] + (double)column * body->spacing,
                               body->low[1] + (double)row * body->spacing, 0};
            found->speed[k] = fmin(found->speed[k], slowest_in(scene, place, from, from + found->step, jump));
        }
    }
    array_free(jump);
    return found->speed != NULL && jump != NULL;
}

/* How much longer the slowest waves are at and below a depth; where a piece begins, but for rounding, from there on. */
static double longer_at(const struct slowest *slowest, double depth)
{
    const double at = depth / slowest->step + small;
    const size_t k = at > 0 ? (size_t)at : 0;
    return slowest->speed[k < slowest->count ? k : slowest->count - 1] / slowest->speed[0];
}

/* --- The spacing ------------------------------------------------------------------------------------------ */

/* Spacings at the knots, in that of the surface, until they reach the depth, which `spacing` has room for; their
 * sum. */
static double march(const struct scene *scene, const struct slowest *slowest, double depth, double *spacing,
                    size_t *cells)
{
    const struct body *body = &scene->body;
    const double level = body->topography != NULL ? body->topography->depth : 0, h = body->spacing;
    double sum = 0;
    spacing[0] = 1;
    for (*cells = 0; sum * h < depth * (1 - small); (*cells)++) {
        const double here = spacing[*cells], clear = sum * h - clearance * here * h;
        double next = here;
        if (sum * h >= level - small * h && clear > 0)
            next = fmax(here, fmin(fmin(body->most_stretch, longer_at(slowest, clear)), (1 + growth) * here));
        spacing[*cells + 1] = next;
        sum += (here + next) / 2;
    }
    return sum;
}

/* The spacing less even by so much less that the cells fill the depth; false: no memory. */
static bool lay_knots(struct grading *grading, const double *spacing, double sum, double depth, double h)
{
    const size_t cells = grading->cells;
    const double part = (depth / h - (double)cells) / (sum - (double)cells);
    grading->place = array_new(cells + 1, sizeof *grading->place);
    grading->stretch = array_new(cells + 1, sizeof *grading->stretch);
    if (grading->place == NULL || grading->stretch == NULL) return false;
    grading->step = depth / (double)cells;
    grading->largest = h;
    grading->from = 0;
    for (size_t i = 0; i <= cells; i++) {
        grading->stretch[i] = (1 + part * (spacing[i] - 1)) * h / grading->step;
        grading->place[i] = i == 0 ? grading->low
                                   : grading->place[i - 1] +
                                         grading->step * (grading->stretch[i - 1] + grading->stretch[i]) / 2;
        grading->largest = fmax(grading->largest, grading->stretch[i] * grading->step);
        if (spacing[i] == 1) grading->from = grading->place[i] - grading->low;
    }
    grading->place[cells] = grading->low + depth;
    return true;
}

selas_status scene_grade(struct scene *scene)
{
    struct body *body = &scene->body;
    const int axis = scene->dimension - 1;
    const double depth = body->high[axis] - body->low[axis];
    grading_free(body->grading);
    body->grading = NULL;
    if (!(body->most_stretch > 1)) return SELAS_OK;
    struct slowest slowest = {0};
    struct grading *grading = array_new(1, sizeof *grading);
    double *spacing = array_new((size_t)ceil(depth / body->spacing) + 2, sizeof *spacing);
    bool good = grading != NULL && spacing != NULL && find_slowest(scene, &slowest);
    if (good) {
        *grading = (struct grading){.axis = axis, .low = body->low[axis]};
        const double sum = march(scene, &slowest, depth, spacing, &grading->cells);
        const bool even = depth / body->spacing - (double)grading->cells < .5; /* none saved */
        good = even || lay_knots(grading, spacing, sum, depth, body->spacing);
        if (good && !even) {
            body->grading = grading;
            grading = NULL;
        }
    }
    grading_free(grading);
    array_free(spacing);
    array_free(slowest.speed);
    return good ? SELAS_OK : SELAS_NO_MEMORY;
}

double grading_saves(const struct scene *scene)
{
    struct scene graded = *scene;
    const int axis = scene->dimension - 1;
    const double even = (scene->body.high[axis] - scene->body.low[axis]) / scene->body.spacing + 1;
    double saved = 0;
    graded.body.grading = NULL;
    graded.body.most_stretch = GRADING_MEASURED;
    if (scene_grade(&graded) == SELAS_OK && graded.body.grading != NULL)
        saved = 1 - ((double)graded.body.grading->cells + 1) / even;
    grading_free(graded.body.grading);
    return saved;
}
