/* Sums of products in an order that is fixed. */
#ifndef SELAS_SUMS_H
#define SELAS_SUMS_H

#include <stddef.h>

/* sum of x[i] y[i], i < n: blocks that depend on n alone are summed by `threads` threads (at least 1), their
 * sums one after the other. Not finite if a product is not. */
double sum_of_products(size_t n, const double *x, const double *y, int threads);

/* The same for a few numbers, by the calling thread. */
static inline double short_sum_of_products(const double *x, const double *y, size_t n)
{
    double sum[4] = {0, 0, 0, 0};
    size_t i = 0;
    for (; i + 4 <= n; i += 4)
        for (size_t j = 0; j < 4; j++)
            sum[j] += x[i + j] * y[i + j];
    for (; i < n; i++)
        sum[0] += x[i] * y[i];
    return (sum[0] + sum[1]) + (sum[2] + sum[3]);
}

#endif
