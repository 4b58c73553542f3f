/* Weighted least-squares polynomials: values and gradients of a field from its values at scattered points.
 *
 * The polynomial sum over k of c_k p_k(d), d = (x - centre) / scale, fits values f_j at offsets d_j with
 * weights w_j; value and gradient at the centre are linear in the f_j, and exact for polynomials of the
 * degree. */
#ifndef SELAS_LEAST_SQUARES_H
#define SELAS_LEAST_SQUARES_H

#include <stdbool.h>
#include <stddef.h>

enum { FIT_TERMS = 10 }; /* full quadratic in three dimensions */

struct fit {
    int dimension, degree; /* degree 0, 1 or 2 */
    double scale;          /* length of the order of the neighbourhood */
    size_t count;          /* neighbours */
    const double *offset;  /* [3 * count] x_j - centre */
    const double *weight;  /* [count] > 0 */
    double *work;          /* [FIT_TERMS * count] */
};

/* Number of terms with the constant: 1, 2, 3 in 1D; 1, 3, 6 in 2D; 1, 4, 10 in 3D. */
size_t fit_terms(int dimension, int degree);
/* value[j] and gradient[3 * j + axis]; false if the neighbours do not determine the polynomial. Either output
 * may be NULL. */
bool fit_free(const struct fit *fit, double *value, double *gradient);
/* The same with the polynomial forced through the value at the centre: gradient applies to f_j - f(centre).
 */
bool fit_through_centre(const struct fit *fit, double *gradient);

#endif
