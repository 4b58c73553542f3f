/* Loaded patches on a plane: rectangle, disc, point; their transforms and potentials. */
#ifndef SELAS_PATCH_H
#define SELAS_PATCH_H

#include <complex.h>
#include <stdbool.h>

enum patch_shape { PATCH_RECTANGLE, PATCH_DISC, PATCH_POINT };

struct patch {
    enum patch_shape shape;
    double centre[2];
    double half[2]; /* half edges; radius twice; 0, 0 */
};

/* Averages over the direction of the wavenumber, times X(k)/(2 pi), X the patch's transform; receiver at (x,
 * y) from the centre, n = k/|k|:  exp(i k.x), i n_x exp(i k.x), i n_y exp(..), n_x^2 exp(..), n_x n_y
 * exp(..). All are real. */
enum { AVERAGE, AVERAGE_X, AVERAGE_Y, AVERAGE_XX, AVERAGE_XY, AVERAGES };
void patch_averages(const struct patch *patch, double x, double y, double k, double average[AVERAGES]);

/* 1 inside, 1/2 on the edge, 1/4 in a corner, 0 outside (and for a point). */
double patch_share(const struct patch *patch, double x, double y);
/* The same for one side of the half length `half`, by the distance from its middle. */
double patch_side_share(double distance, double half);

/* Integrals over the patch; R^2 = x^2 + y^2 + depth^2, derivatives with respect to the receiver. Additive
 * parts that do not depend on depth are left out of `once`, `twice` and their gradients. */
struct potentials {
    double complex angle; /* -d(plain)/d(depth) */
    double complex plain; /* integral of 1/R */
    double complex plain_x, plain_y;
    double complex once; /* plain integrated over depth */
    double complex once_x, once_y;
    double complex once_xx, once_xy, once_yy;
    double complex twice_x, twice_y; /* integrated over depth once more */
    double complex twice_xx, twice_xy, twice_yy;
};

/* Receiver at (x, y) from the centre, Re depth >= 0. A disc needs real depth and has no `once`, `twice_x`,
 * `twice_y`. */
void patch_potentials(const struct patch *patch, double x, double y, double complex depth,
                      struct potentials *potentials);
void rectangle_potentials(const double half[2], double x, double y, double complex depth,
                          struct potentials *potentials);
#endif
