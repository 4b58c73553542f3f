/* The surface of the ground and the map of the lattice below it (see the header). */
#include "scene/topography.h"

#include "base/memory.h"

#include <math.h>

/* Drawn out: x from there on becomes from + width (t - t^2 / 2), t the distance in widths; its slope falls from 1
 * to 0. */
static double drawn(const struct drawn_out end[2], double x)
{
    for (int side = 0; side < 2; side++) {
        const double sign = side == 0 ? -1 : 1, beyond = sign * (x - end[side].from);
        if (end[side].width == 0 || beyond <= 0) continue;
        const double t = fmin(beyond / end[side].width, 1);
        return end[side].from + sign * end[side].width * (t - t * t / 2);
    }
    return x;
}

bool topography_drawn(const struct topography *topography, const double place[2])
{
    for (int axis = 0; axis < 2 && axis < topography->axis; axis++)
        if (drawn(topography->end[axis], place[axis]) != place[axis]) return true;
    return false;
}

static double bell(double distance, double width)
{
    return exp(-distance * distance / (2 * width * width));
}

double topography_drop(const struct topography *topography, const double place[2])
{
    double x[2] = {0, 0};
    for (int axis = 0; axis < 2 && axis < topography->axis; axis++)
        x[axis] = drawn(topography->end[axis], place[axis]);
    if (topography->map != NULL) return -height_map_at(topography->map, x);
    double off[2] = {0, 0};
    for (int axis = 0; axis < 2 && axis < topography->axis; axis++)
        off[axis] = x[axis] - topography->centre[axis];
    const double width = topography->width;
    if (topography->shape == TOPOGRAPHY_GAUSSIAN)
        return -topography->height * bell(hypot(off[0], off[1]), width);
    const double rise =
        topography->height * bell(off[0] * topography->across[0] + off[1] * topography->across[1], width);
    return topography->shape == TOPOGRAPHY_CANYON ? rise : -rise;
}

/* Straight to the middle, then a parabola that ends level: a spline of degree 2 with knots at 0, 1/2 and 1. */
double topography_share(const struct topography *topography, double depth, double *slope)
{
    const double t = depth / topography->depth;
    if (t >= 1) {
        *slope = 0;
        return 0;
    }
    *slope = (t < .5 ? -4 / 3. : -8 / 3. * (1 - t)) / topography->depth;
    return t < .5 ? 1 - 4 / 3. * t : 4 / 3. * (1 - t) * (1 - t);
}

double topography_real(const struct topography *topography, double drop, double lattice)
{
    double slope;
    return lattice + drop * topography_share(topography, lattice - topography->plane, &slope);
}

/* The map is straight, then a parabola, then straight: three cases, each solved as it is. */
double topography_lattice(const struct topography *topography, double drop, double real)
{
    const double d = topography->depth, depth = real - topography->plane;
    if (depth >= d || drop == 0) return real;
    const double upper = (depth - drop) / (1 - 4 / 3. * drop / d);
    if (upper < d / 2) return topography->plane + upper;
    /* b t^2 - t + (1 - depth / d) = 0 with t = 1 - zeta / d, b = 4/3 drop / d */
    const double b = 4 / 3. * drop / d, rest = 1 - depth / d;
    return topography->plane + d * (1 - 2 * rest / (1 + sqrt(1 - 4 * b * rest)));
}

void topography_to_lattice(const struct topography *topography, double place[3])
{
    double *down = &place[topography->axis];
    *down = topography_lattice(topography, topography_drop(topography, place), *down);
}

void topography_to_deck(const struct topography *topography, double place[3])
{
    double *down = &place[topography->axis];
    *down = topography_real(topography, topography_drop(topography, place), *down);
}

bool topography_mirrors(const struct body *body, int dimension, int axis)
{
    const struct topography *topography = body->topography;
    const double small = 1e-12 * body->spacing;
    size_t count[2] = {1, 1};
    if (topography == NULL) return true;
    if (axis == topography->axis) return false;
    for (int other = 0; other < dimension - 1; other++)
        count[other] = (size_t)((body->high[other] - body->low[other]) / body->spacing + 1.5);
    for (size_t j = 0; j < count[1]; j++)
        for (size_t i = 0; i < count[0]; i++) {
            double place[2] = {body->low[0] + (double)i * body->spacing,
                               body->low[1] + (double)j * body->spacing};
            const double drop = topography_drop(topography, place);
            place[axis] = body->low[axis] + body->high[axis] - place[axis];
            if (!(fabs(topography_drop(topography, place) - drop) <= small)) return false;
        }
    return true;
}

void topography_free(struct topography *topography)
{
    if (topography == NULL) return;
    height_map_free(topography->map);
    array_free(topography);
}
