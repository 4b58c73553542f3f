/* Radial kernels W(r, h): value and derivatives in 1, 2 and 3 dimensions, normalised to unit integral.
 *
 *   W(r, h) = c_d / h^d * w(q),   q = r / h,   W = 0 for r >= support * h
 *
 * A new kernel is a file, kernel_SYMBOL with its shape functions, and a line in deck/choices.h. */
#ifndef SELAS_KERNEL_H
#define SELAS_KERNEL_H

struct kernel {
    const char *name;        /* as in method%kernel: 'cubic', 'wendland', 'quintic' */
    double support;          /* radius of the support in smoothing lengths */
    double normalisation[3]; /* c_d of dimension 1, 2, 3 */
    double plane[3];         /* h times the integral of W over a plane (line, point) through its centre */
    double (*shape)(int dimension, double q);        /* w(q), 0 <= q < support; likewise below */
    double (*slope_over_q)(int dimension, double q); /* w'(q) / q, finite at q = 0 */
    double (*curvature)(int dimension, double q);    /* w''(q) */
};

/* NULL if there is no kernel of that name. */
const struct kernel *kernel_find(const char *name);

/* W, dW/dr, d2W/dr2 at distance r >= 0 for smoothing length h > 0; dimension 1, 2 or 3. */
double kernel_value(const struct kernel *kernel, int dimension, double r, double h);
double kernel_derivative(const struct kernel *kernel, int dimension, double r, double h);
double kernel_second_derivative(const struct kernel *kernel, int dimension, double r, double h);
/* (dW/dr) / r with its limit d2W/dr2 at r = 0: gradient of W = this times the vector from the centre. */
double kernel_derivative_over_r(const struct kernel *kernel, int dimension, double r, double h);

/* S_a of Ding et al. 2006, Eqs 20 and 41: one over the integral of W over a plane through its centre;
 * 10 h / 7 for the cubic spline in 3D, 7 pi h / 15 in 2D, 3 h / 2 in 1D (where the plane is a point). */
double kernel_plane_factor(const struct kernel *kernel, int dimension, double h);

/* What least-squares gradients by W^power (power 0: by -W'(r) / r) lose of long waves along an axis of a lattice of
 * unit spacing: the sum of weight x^4 over that of weight x^2, times k^2 / 6. 1 for differences of nearest points. */
double kernel_dispersion(const struct kernel *kernel, int dimension, double h, double power);

#endif
