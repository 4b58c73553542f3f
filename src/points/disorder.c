/* How far scattered points are from a lattice, as waves feel it: what pushes them aside in a uniform stress. */
#include "points/disorder.h"

#include <math.h>

/* Distance of a point from the faces across an axis, and from the rim of the hole. */
static double depth_of(const struct body *body, size_t axis, const double *x)
{
    const double depth = fmin(x[axis] - body->low[axis], body->high[axis] - x[axis]);
    if (body->shape != BODY_PLATE_WITH_HOLE) return depth;
    return fmin(depth, hypot(x[0] - body->hole_centre[0], x[1] - body->hole_centre[1]) - body->hole_radius);
}

void disorder_add(double sums[2], const struct cloud *cloud, const struct body *body, double reach, size_t i,
                  const double force[3])
{
    for (size_t a = 0; a < (size_t)cloud->dimension; a++) {
        const double middle = 0.425 * (body->high[a] - body->low[a]);
        const double deep = fmax(4 * cloud->spacing, fmin(2 * reach, middle));
        if (depth_of(body, a, cloud->position + 3 * i) < deep) continue;
        sums[0] += log(fmax(1e-30, force[a] * force[a]));
        sums[1]++;
    }
}

double disorder_mean(const double sums[2], int dimension)
{
    static const double normal = 3.56; /* mean over geometric mean of squares of a normal distribution */
    return sums[1] > 0 ? dimension * normal * exp(sums[0] / sums[1]) : 0;
}
