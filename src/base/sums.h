/* Sums over long vectors by several threads, the same bits whatever their number. */
#ifndef SELAS_SUMS_H
#define SELAS_SUMS_H

#include <stddef.h>

/* sum of x[i] y[i], i < n: blocks that depend on n alone are summed by `threads` threads (at least 1), their
 * sums one after the other. Not finite if a product is not. */
double sum_of_products(size_t n, const double *x, const double *y, int threads);

#endif
