/* Square band matrices of one axis, their products and their Cholesky factors. */
#include "method/spline/band.h"

#include "base/memory.h"
#include "method/spline/passes.h"

#include <math.h>

enum { MOST_HALF = 63 };

static size_t smaller(size_t a, size_t b)
{
    return a < b ? a : b;
}

struct band *band_new(size_t n, size_t half)
{
    struct band *band = array_new(1, sizeof *band);
    if (band == NULL) return NULL;
    band->n = n;
    band->half = half;
    band->value = array_new((2 * half + 1) * n, sizeof *band->value);
    if (band->value != NULL) return band;
    array_free(band);
    return NULL;
}

void band_free(struct band *band)
{
    if (band == NULL) return;
    array_free(band->value);
    array_free(band);
}

double band_get(const struct band *band, size_t row, size_t column)
{
    if (column + band->half < row || column > row + band->half) return 0;
    return band->value[(column + band->half - row) * band->n + row];
}

void band_add(struct band *band, size_t row, size_t column, double value)
{
    band->value[(column + band->half - row) * band->n + row] += value;
}

void band_clear(struct band *band, size_t row)
{
    for (size_t d = 0; d <= 2 * band->half; d++)
        band->value[d * band->n + row] = 0;
}

/* First column of the band in a row, and one past the last. */
static size_t first_column(const struct band *band, size_t row)
{
    return row < band->half ? 0 : row - band->half;
}

static size_t end_column(const struct band *band, size_t row)
{
    return smaller(band->n, row + band->half + 1);
}

struct band *band_product(const struct band *a, const struct band *b)
{
    struct band *c = band_new(a->n, smaller(a->half + b->half, a->n - 1));
    if (c == NULL) return NULL;
    for (size_t i = 0; i < a->n; i++)
        for (size_t j = first_column(a, i); j < end_column(a, i); j++) {
            const double left = band_get(a, i, j);
            if (left == 0) continue;
            for (size_t k = first_column(b, j); k < end_column(b, j); k++)
                band_add(c, i, k, left * band_get(b, j, k));
        }
    return c;
}

struct band *band_sum(const struct band *a, double factor, const struct band *b)
{
    struct band *c = band_new(a->n, a->half > b->half ? a->half : b->half);
    if (c == NULL) return NULL;
    for (size_t i = 0; i < a->n; i++)
        for (size_t j = first_column(c, i); j < end_column(c, i); j++)
            band_add(c, i, j, band_get(a, i, j) + factor * band_get(b, i, j));
    return c;
}

struct band *band_cut(const struct band *band, size_t from, size_t n)
{
    struct band *part = band_new(n, smaller(band->half, n - 1));
    for (size_t i = 0; part != NULL && i < n; i++)
        for (size_t j = first_column(part, i); j < end_column(part, i); j++)
            band_add(part, i, j, band_get(band, from + i, from + j));
    return part;
}

bool band_factorise(const struct band *band, double *factor)
{
    const size_t n = band->n, half = band->half;
    for (size_t i = 0; i < n; i++) {
        const size_t reach = smaller(i, half);
        for (size_t d = half; d > reach; d--)
            factor[d * n + i] = 0;
        for (size_t d = reach + 1; d-- > 0;) {
            const size_t j = i - d;
            double sum = band_get(band, i, j);
            for (size_t e = d + 1; e <= reach && e - d <= half; e++)
                sum -= factor[e * n + i] * factor[(e - d) * n + j];
            if (d > 0)
                factor[d * n + i] = sum * factor[j];
            else if (sum > 0)
                factor[i] = 1 / sqrt(sum);
            else
                return false;
        }
    }
    return true;
}

/* row -= factor * other */
static void subtract(double factor, const double *restrict other, size_t lanes, double *restrict row)
{
#pragma omp simd
    for (size_t lane = 0; lane < lanes; lane++)
        row[lane] -= factor * other[lane];
}

static void scale(double factor, size_t lanes, double *row)
{
#pragma omp simd
    for (size_t lane = 0; lane < lanes; lane++)
        row[lane] *= factor;
}

/* Row `to` := the sum of the weights times as many rows from `from` on, which it may be one of. */
static void sum_rows(const struct passes *passes, const double *weight, size_t count, const double *from,
                     size_t stride, size_t lanes, double *to)
{
    const double *in[MOST_HALF + 1];
    for (size_t d = 0; d < count; d++)
        in[d] = from + d * stride;
    passes->rows[1](weight, count, in, lanes, false, &to);
}

/* Each row of the solution is a sum over rows that are known, and itself. */
void band_forward_rows(const double *factor, const struct band_rows *rows, size_t half, double *x,
                       size_t stride, size_t lanes)
{
    const struct passes *passes = taken_passes();
    double weight[MOST_HALF + 1];
    for (size_t row = rows->from; row < rows->end; row++) {
        const size_t i = rows->first + row, reach = smaller(i, half);
        for (size_t d = 1; d <= reach; d++)
            weight[reach - d] = -factor[i] * factor[d * rows->n + i];
        weight[reach] = factor[i];
        sum_rows(passes, weight, reach + 1, x + (row - reach) * stride, stride, lanes, x + row * stride);
    }
}

void band_backward_rows(const double *factor, const struct band_rows *rows, size_t half, double *x,
                        size_t stride, size_t lanes)
{
    const struct passes *passes = taken_passes();
    double weight[MOST_HALF + 1];
    for (size_t row = rows->end; row-- > rows->from;) {
        const size_t i = rows->first + row, reach = smaller(rows->n - 1 - i, half);
        for (size_t d = 1; d <= reach; d++)
            weight[d] = -factor[i] * factor[d * rows->n + i + d];
        weight[0] = factor[i];
        sum_rows(passes, weight, reach + 1, x + row * stride, stride, lanes, x + row * stride);
    }
}

void band_forward(const double *factor, size_t n, size_t half, double *x, size_t stride, size_t lanes)
{
    band_forward_rows(factor, &(struct band_rows){n, 0, 0, n}, half, x, stride, lanes);
}

void band_backward(const double *factor, size_t n, size_t half, double *x, size_t stride, size_t lanes)
{
    band_backward_rows(factor, &(struct band_rows){n, 0, 0, n}, half, x, stride, lanes);
}

void band_lower_multiply(const double *factor, size_t n, size_t half, double *x, size_t stride, size_t lanes)
{
    for (size_t i = n; i-- > 0;) {
        scale(1 / factor[i], lanes, x + i * stride);
        for (size_t d = 1; d <= smaller(i, half); d++)
            subtract(-factor[d * n + i], x + (i - d) * stride, lanes, x + i * stride);
    }
}

bool band_lu(struct band *band)
{
    for (size_t i = 0; i < band->n; i++) {
        const double pivot = band_get(band, i, i);
        if (pivot == 0) return false;
        for (size_t row = i + 1; row < end_column(band, i); row++) {
            const double ratio = band_get(band, row, i) / pivot;
            band_add(band, row, i, ratio - band_get(band, row, i)); /* L is kept below the diagonal */
            for (size_t j = i + 1; j < end_column(band, i); j++)
                band_add(band, row, j, -ratio * band_get(band, i, j));
        }
    }
    return true;
}

void band_lu_rows(const struct band *lu, const struct band_rows *rows, bool forward, double *x, size_t stride)
{
    const size_t first = rows->first;
    for (size_t row = rows->from; row < rows->end && forward; row++)
        for (size_t i = first + row, j = first_column(lu, i); j < i; j++)
            x[row * stride] -= band_get(lu, i, j) * x[(j - first) * stride];
    for (size_t row = rows->end; row-- > rows->from && !forward;) {
        const size_t i = first + row;
        for (size_t j = i + 1; j < end_column(lu, i); j++)
            x[row * stride] -= band_get(lu, i, j) * x[(j - first) * stride];
        x[row * stride] /= band_get(lu, i, i);
    }
}

void band_lu_solve(const struct band *lu, double *x, size_t stride)
{
    const struct band_rows all = {lu->n, 0, 0, lu->n};
    band_lu_rows(lu, &all, true, x, stride);
    band_lu_rows(lu, &all, false, x, stride);
}
