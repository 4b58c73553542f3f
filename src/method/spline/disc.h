/* Integrals of products of two axes' basis functions over a disc. */
#ifndef SELAS_METHOD_SPLINE_DISC_H
#define SELAS_METHOD_SPLINE_DISC_H

#include "method/spline/bspline.h"

struct disc {
    double first, second, radius; /* centre on the first and the second axis */
};

/* moment[i * second->count + j] = integral of first_i second_j over the part of the disc inside both axes, to
 * rounding. Returns false if there is no memory. */
bool disc_moments(const struct spline *first, bool first_odd, const struct spline *second, bool second_odd,
                  const struct disc *disc, double *moment);

#endif
