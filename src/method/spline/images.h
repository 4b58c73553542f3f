/* Control values of an axis and their images beyond symmetry planes, and differences of them: what the
 * dissipation (hform_dissipation.c) and the tuned matrices (tuned.c) are made of. */
#ifndef SELAS_METHOD_SPLINE_IMAGES_H
#define SELAS_METHOD_SPLINE_IMAGES_H

#include "method/spline/bspline.h"

#include <stddef.h>

enum { MOST_DIFFERENCE = 16 };

/* A difference of control values: sum over i of factor[i] * c[index[i]]. */
struct difference {
    int order;
    size_t index[MOST_DIFFERENCE + 1]; /* may hold an index twice */
    double factor[MOST_DIFFERENCE + 1];
};

/* The difference of an order, at most MOST_DIFFERENCE, of the control values at places first .. first +
 * order, images beyond symmetry planes among them; odd: of a component that changes its sign there. False
 * where there are not so many in a row or they are not evenly spaced. */
bool spline_difference(const struct spline *spline, bool odd, ptrdiff_t first, int order,
                       struct difference *difference);

/* The evenly spaced control values nearest x, an odd number of them, images beyond symmetry planes among them. */
enum { MOST_IMAGES = 23 };
struct images {
    size_t index[MOST_IMAGES];
    double sign[MOST_IMAGES]; /* -1 beyond a plane where the component changes its sign there */
    double position[MOST_IMAGES], gap;
};
/* False where there are not so many or they are not evenly spaced. */
bool spline_images(const struct spline *spline, bool odd, double x, int count, struct images *images);

#endif
