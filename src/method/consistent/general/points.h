/* Points of quadrature of the general operator and the loops over a plane of them, for each kind of
 * processor (points_double.c). */
#ifndef SELAS_METHOD_CONSISTENT_GENERAL_POINTS_H
#define SELAS_METHOD_CONSISTENT_GENERAL_POINTS_H

#include "base/processor.h"

#include <stdbool.h>
#include <stddef.h>

enum at { AT_KNOTS, AT_MIDDLES };

/* Functions that are not zero at a point of an axis: control values first .. first + count - 1. */
struct taps {
    size_t first, count;
    double value[3], slope[3];
};

/* Points of a row, one after the other, whose solid is not isotropic: number m of `count` has the stiffness
 * stiffness[at + n * count + m], n < 21, the upper triangle of C in Voigt's order xx yy zz yz zx xy by rows,
 * times the weight of the point. */
struct run_of_points {
    size_t from, count, at;
};
enum { STIFFNESSES = 21, STRESSES = 6 };

/* A plane of points across depth. Rows of control values are those of the unclamped splines along x (G3):
 * two more than the cells. Index by slot: component, then direction of the slope. */
struct point_plane {
    bool flat;  /* two dimensions: one row, no component and no slope along y */
    bool knots; /* points on x are knots, else middles */
    size_t cells;
    size_t pitch;                      /* of rows */
    double scale;                      /* 1 / spacing along x */
    const struct taps *y[2];           /* [odd][rows of points] */
    const double *value[3], *slope[3]; /* [component] rows of values and slopes along depth */
    double *pull_value[3], *pull_slope[3];
    double *pull_across[3]; /* of stresses along y, which else go into pull_value; NULL: they do */
    double *scratch;        /* [SCRATCH_ROWS * pitch] zeros to begin with */
};
enum { PLANE_ROWS = 15 }; /* of the buffers, for each row of control values (forces.c) */
enum { SCRATCH_ROWS = 18 + STRESSES, ROW_ROOM = 8 }; /* numbers before the first of a row */

/* Slopes of a component along a slot at the points of a row. */
static inline double *slope_row(const struct point_plane *plane, int component, int slot)
{
    return plane->scratch + ROW_ROOM + (size_t)(9 + STRESSES + 3 * component + slot) * plane->pitch;
}

/* A row of points below a surface that is not level: s and its slopes along x and y at each of them, f and its slope
 * over depth (G16). */
struct hill_row {
    const double *drop, *slope[2];
    double share, fall;
};

struct point_kernels {
    /* Row j of points: adds B^T of the stresses to the pulls. lambda, mu: of the row; runs may be none. */
    void (*row)(const struct point_plane *plane, size_t j, const double *lambda, const double *mu,
                const struct run_of_points *run, size_t runs, const double *stiffness);
    /* The same in two: slopes of points from .. end - 1 of row j into the scratch (slope_row()), where others may
     * change them, and the pulls of their stresses. */
    void (*slopes)(const struct point_plane *plane, size_t j, size_t from, size_t end);
    void (*pulls)(const struct point_plane *plane, size_t j, size_t from, size_t end, const double *lambda,
                  const double *mu, const struct run_of_points *run, size_t runs, const double *stiffness,
                  bool tilted);
    /* Between the two, slopes along the lattice become those along the axes (G17); pulls() with `tilted` then takes the
     * transpose. */
    void (*tilt)(const struct point_plane *plane, const struct hill_row *hill, size_t from, size_t end);
    /* out[i] += v * in[i] + s * slope[i], i < n */
    void (*add)(size_t n, double v, const double *value, double s, const double *slope, double *out);
    /* value := sum of weight[d] rows of u, slope alike with weight slope; d < count, n numbers each. */
    void (*depth)(const struct taps *taps, const double *u, size_t stride, size_t n, double *value,
                  double *slope);
};
EACH_PROCESSOR(struct point_kernels, point_kernels)

#endif
