/* Square band matrices of one axis, their products and their Cholesky factors.
 *
 * Stored by diagonals: value[d * n + i] multiplies entry i + d - half of the vector in row i (0 where that is
 * outside), so that a row of lattice points is a unit-stride loop. */
#ifndef SELAS_METHOD_SPLINE_BAND_H
#define SELAS_METHOD_SPLINE_BAND_H

#include <stdbool.h>
#include <stddef.h>

struct band {
    size_t n, half; /* rows; half-width */
    double *value;  /* [(2 * half + 1) * n] */
};

/* Zero matrix, or NULL if there is no memory. band_free takes NULL. */
struct band *band_new(size_t n, size_t half);
void band_free(struct band *band);

double band_get(const struct band *band, size_t row, size_t column);       /* 0 outside the band */
void band_add(struct band *band, size_t row, size_t column, double value); /* inside the band */
void band_clear(struct band *band, size_t row);                            /* row = 0 */

/* New matrices (NULL: no memory): a b, and a + factor b. */
struct band *band_product(const struct band *a, const struct band *b);
struct band *band_sum(const struct band *a, double factor, const struct band *b);

/* Entry `row` of A x, x[j] at x[j * stride]; a NULL matrix is the identity. */
static inline double band_row(const struct band *band, size_t row, const double *x, size_t stride)
{
    if (band == NULL) return x[row * stride];
    const size_t n = band->n, half = band->half;
    const size_t from = row < half ? 0 : row - half, end = row + half + 1 < n ? row + half + 1 : n;
    double sum = 0;
    for (size_t j = from; j < end; j++)
        sum += band->value[(j + half - row) * n + row] * x[j * stride];
    return sum;
}

/* Cholesky factor A = L L^T of a symmetric positive definite band: factor[d * n + i] = L(i, i - d) for
 * d = 1 .. half and 1 / L(i, i) for d = 0. Returns false if A is not positive definite. `factor` has
 * (half + 1) * n numbers. */
bool band_factorise(const struct band *band, double *factor);

/* New matrix of n rows and columns from `from` on; entries outside are left out. NULL: no memory. */
struct band *band_cut(const struct band *band, size_t from, size_t n);

/* Rows from .. end - 1 of a vector whose row 0 is row `first` of a matrix of n rows. */
struct band_rows {
    size_t n, first, from, end;
};

/* As band_forward() and band_backward() for some rows, those that they need before them being done. */
void band_forward_rows(const double *factor, const struct band_rows *rows, size_t half, double *x,
                       size_t stride, size_t lanes);
void band_backward_rows(const double *factor, const struct band_rows *rows, size_t half, double *x,
                        size_t stride, size_t lanes);

/* Solves with L (forward) or L^T (backward) in place for `lanes` vectors at once: entry i of lane l stands at
 * x[i * stride + l]. */
void band_forward(const double *factor, size_t n, size_t half, double *x, size_t stride, size_t lanes);
void band_backward(const double *factor, size_t n, size_t half, double *x, size_t stride, size_t lanes);

/* x := L x, in place, as above. */
void band_lower_multiply(const double *factor, size_t n, size_t half, double *x, size_t stride, size_t lanes);

/* LU factors in place, without pivoting (for matrices that need none: totally positive ones such as spline
 * collocation, or the identity plus what is not negative); the factors keep the band. Returns false at a zero
 * pivot. Solves in place for x[i * stride]. */
bool band_lu(struct band *band);
void band_lu_solve(const struct band *lu, double *x, size_t stride);
/* One half of it, forward first, for some rows, those that they need before them being done. */
void band_lu_rows(const struct band *lu, const struct band_rows *rows, bool forward, double *x,
                  size_t stride);

#endif
