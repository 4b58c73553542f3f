/* Weighted least-squares polynomials by Gram-Schmidt (with a second sweep) on the weighted basis:
 *
 *   A = sqrt(w) p(d) = Q R,   c = R^-1 Q^T sqrt(w) f,
 *
 * so the weights of coefficient k are sqrt(w_j) (Q R^-T e_k)_j. Lancaster & Salkauskas 1981 (moving least
 * squares); the through-centre form with a linear basis and w = V |W'| / r is the corrected kernel gradient
 * of He & Seaid 2016, before Eq 4 (shown in doc/theory/sph-total-lagrangian.md). */
#include "points/least_squares.h"

#include <math.h>
#include <string.h>

/* A column this much shorter after projection than before depends on the others, or nearly so: the weights
 * would be large and of both signs (two rows of points that are not quite straight do not tell a curvature).
 * One-sided neighbourhoods of three rows leave more than a tenth. */
static const double dependence = 0.02;

size_t fit_terms(int dimension, int degree)
{
    static const size_t terms[3][3] = {{1, 2, 3}, {1, 3, 6}, {1, 4, 10}};
    return terms[dimension - 1][degree];
}

/* Constant, linear, then quadratic terms at d. */
static void basis(int dimension, int degree, const double *offset, double scale, double p[FIT_TERMS])
{
    size_t k = 0;
    p[k++] = 1;
    if (degree == 0) return;
    for (int a = 0; a < dimension; a++)
        p[k++] = offset[a] / scale;
    if (degree == 1) return;
    for (int a = 0; a < dimension; a++)
        for (int b = a; b < dimension; b++)
            p[k++] = p[1 + a] * p[1 + b];
}

static double dot(size_t n, const double *a, const double *b)
{
    double sum = 0;
    for (size_t i = 0; i < n; i++)
        sum += a[i] * b[i];
    return sum;
}

/* Orthonormal columns q (in place) and r with q r = columns; false if they are dependent. */
static bool orthogonalise(size_t n, size_t terms, double *q, double r[FIT_TERMS][FIT_TERMS])
{
    memset(r, 0, sizeof(double[FIT_TERMS][FIT_TERMS]));
    for (size_t k = 0; k < terms; k++) {
        double *column = q + k * n;
        const double before = sqrt(dot(n, column, column));
        for (int sweep = 0; sweep < 2; sweep++)
            for (size_t l = 0; l < k; l++) {
                const double c = dot(n, q + l * n, column);
                r[l][k] += c;
                for (size_t i = 0; i < n; i++)
                    column[i] -= c * q[l * n + i];
            }
        const double after = sqrt(dot(n, column, column));
        if (!(after > dependence * before) || !(before > 0)) return false;
        r[k][k] = after;
        for (size_t i = 0; i < n; i++)
            column[i] /= after;
    }
    return true;
}

/* Weights of coefficient k: sqrt(w_j) * sum over l of Q_jl y_l with R^T y = e_k... y solves R y' = ..., so
 * that c_k = e_k^T R^-1 Q^T sqrt(w) f. */
static void coefficient(const struct fit *fit, size_t terms, double r[FIT_TERMS][FIT_TERMS], size_t k,
                        double factor, double *out, size_t stride)
{
    double y[FIT_TERMS] = {0}; /* y^T = e_k^T R^-1, by forward substitution in y^T R = e_k^T */
    for (size_t l = k; l < terms; l++) {
        double sum = l == k ? 1 : 0;
        for (size_t m = k; m < l; m++)
            sum -= y[m] * r[m][l];
        y[l] = sum / r[l][l];
    }
    for (size_t j = 0; j < fit->count; j++) {
        double sum = 0;
        for (size_t l = k; l < terms; l++)
            sum += fit->work[l * fit->count + j] * y[l];
        out[j * stride] = factor * sqrt(fit->weight[j]) * sum;
    }
}

static bool solve(const struct fit *fit, size_t first, double *value, double *gradient)
{
    const size_t terms = fit_terms(fit->dimension, fit->degree) - first, n = fit->count;
    if (n < terms) return false;
    double r[FIT_TERMS][FIT_TERMS];
    for (size_t j = 0; j < n; j++) {
        double p[FIT_TERMS] = {0};
        basis(fit->dimension, fit->degree, fit->offset + 3 * j, fit->scale, p);
        for (size_t k = 0; k < terms; k++)
            fit->work[k * n + j] = sqrt(fit->weight[j]) * p[k + first];
    }
    if (!orthogonalise(n, terms, fit->work, r)) return false;
    if (value != NULL) coefficient(fit, terms, r, 0, 1, value, 1);
    if (gradient == NULL) return true;
    memset(gradient, 0, 3 * n * sizeof *gradient);
    if (fit->degree > 0)
        for (size_t a = 0; a < (size_t)fit->dimension; a++)
            coefficient(fit, terms, r, 1 + a - first, 1 / fit->scale, gradient + a, 3);
    return true;
}

bool fit_free(const struct fit *fit, double *value, double *gradient)
{
    return solve(fit, 0, value, gradient);
}

bool fit_through_centre(const struct fit *fit, double *gradient)
{
    return solve(fit, 1, NULL, gradient);
}
