/* Tuned splines: B-splines of an axis along which the ground does not vary, whose mass and stiffness are
 * changed by a few high differences of the control values so that short waves keep their speed, and whose
 * loads and read-out are filtered to match (doc/theory/consistent-splines.md, section 14).
 *
 * The functions below do what their namesakes in bspline.h do, and the same where the spline is not tuned. */
#ifndef SELAS_METHOD_SPLINE_TUNED_H
#define SELAS_METHOD_SPLINE_TUNED_H

#include "method/spline/bspline.h"

enum {
    TUNED_DEGREE = 4, /* the only one there are numbers for */
    TUNED_REACH = 5,  /* half-width of the matrices */
    FILTER_REACH = 8,
    TUNED_MOST_LOCAL = 23 + 2 * FILTER_REACH /* of a filtered source (quiet.c) */
};

/* Builds the filters of a spline of TUNED_DEGREE, plain knots and no interfaces: from here on it is tuned.
 * An axis too short for the numbers to fade out towards its ends stays as it is. False: no memory. */
bool spline_tune(struct spline *spline);

/* Functions that are not zero at x, filtered where the spline is tuned. */
struct tuned_point {
    size_t count;
    size_t index[TUNED_MOST_LOCAL];
    double value[TUNED_MOST_LOCAL], slope[TUNED_MOST_LOCAL];
};
/* The values and slopes of control values with a filter, what it is of those without: sum over b of F_ab. */
void tuned_filter(const struct spline *spline, bool odd, const struct tuned_point *plain,
                  struct tuned_point *point);
void tuned_at(const struct spline *spline, bool odd, double x, struct tuned_point *point);
/* The same for who looks. Slopes of straight pieces (degree 1) are right to second order in the middles of cells;
 * between these, and as far as ends and jumps of the ground, they go on in straight lines, across symmetry planes to
 * the image. */
void tuned_seen(const struct spline *spline, bool odd, double x, struct tuned_point *point);

struct band *tuned_matrix(const struct spline *spline, bool test_odd, int test_slope, bool trial_odd,
                          int trial_slope, const double *weight);

/* work: [spline->count]; moment: F^T of spline_moments */
void tuned_moments(const struct spline *spline, bool odd, double from, double to, double *work,
                   double *moment);

#endif
