/* B-splines of degree 1 to 4 on one axis: knots, ends, values, and the 1-D matrices of the consistent
 * smoothed point method (doc/theory/consistent-method.md, section 2).
 *
 * Ends. Open: the knot at the end is repeated, the first function is 1 at the end and all others 0. Mapped:
 * open knots in a parameter t with uniformly spaced control points, x(t) = sum_j N_j(t) x_j. Mirror: a
 * symmetry plane; the functions go on across it and are folded back, with the sign of the component: even
 * (the mirrored value is the same) or odd (it changes sign). */
#ifndef SELAS_METHOD_SPLINE_BSPLINE_H
#define SELAS_METHOD_SPLINE_BSPLINE_H

#include "base/messages.h"
#include "method/spline/band.h"

enum { SPLINE_MAX_DEGREE = 4, SPLINE_MAX_LOCAL = SPLINE_MAX_DEGREE + 1 };

struct spline_choice {
    int degree;
    double low, high; /* of the axis; high > low */
    double spacing;   /* wanted; the number of cells is the nearest whole one of each piece */
    bool mapped;      /* ends that are not mirrors: mapped instead of open */
    bool mirror[2];   /* symmetry plane at the low, high end */
    size_t interfaces;
    const double *interface; /* [interfaces] ascending positions inside: material changes, C0 knots there */
};

struct spline_element {
    double from, to;     /* in the parameter */
    double x_from, x_to; /* on the axis */
    size_t first;        /* first of the degree + 1 functions that are not zero (before folding) */
    bool jump;           /* the ground jumps where it ends */
};

struct spline {
    int degree;
    double low, high;
    size_t cells;
    size_t count;     /* control values */
    size_t functions; /* before folding */
    size_t folded[2]; /* functions folded back at either end */
    bool mirror[2];
    bool centred[2];  /* the end's control value lies on a mirror plane: 0 where the component is odd */
    double *knot;     /* [functions + degree + 1] */
    double *control;  /* [functions] x of the geometry's control points; NULL: the parameter is x */
    double *greville; /* [count] x of each control value */
    size_t elements;
    struct spline_element *element;
    double *gauss_position, *gauss_weight; /* [gauss] on [0, 1] */
    size_t gauss;
    struct band *filter[2]; /* [odd] tuned splines (tuned.h); NULL: none */
};

/* Builds the basis; NULL with a message if there are too few cells for the degree or no memory. */
struct spline *spline_new(const struct spline_choice *choice, struct messages *messages);
void spline_free(struct spline *spline);

/* Element that holds x (the nearest one if x is outside). */
size_t spline_locate(const struct spline *spline, double x);
/* The parameter at x in an element, and x at a parameter where `first` is the first function that is not 0.
 */
double spline_parameter(const struct spline *spline, const struct spline_element *element, double x);
double spline_place(const struct spline *spline, size_t first, double parameter);

/* Functions that are not zero at x: control value, value and slope d/dx of degree + 1 of them (an index may
 * occur twice where functions are folded). x may lie a little outside: the end's polynomial goes on. */
struct spline_point {
    size_t index[SPLINE_MAX_LOCAL];
    double value[SPLINE_MAX_LOCAL], slope[SPLINE_MAX_LOCAL];
};
void spline_at(const struct spline *spline, bool odd, double x, struct spline_point *point);

/* Integral over the axis of weight * (d/dx)^test_slope test_i * (d/dx)^trial_slope trial_j; weight has one
 * value per element or is NULL for 1. NULL: no memory. */
struct band *spline_matrix(const struct spline *spline, bool test_odd, int test_slope, bool trial_odd,
                           int trial_slope, const double *weight);

/* moment[i] = integral of function i from..to (inside the axis). */
void spline_moments(const struct spline *spline, bool odd, double from, double to, double *moment);

#endif
