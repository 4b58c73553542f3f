/* Sums in fixed blocks (see the header). */
#include "base/sums.h"

enum { BLOCKS = 256, LEAST = 4096 /* numbers that are worth a block */ };

static double block_sum(size_t n, const double *x, const double *y)
{
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (size_t i = 0; i < n; i++)
        sum += x[i] * y[i];
    return sum;
}

double sum_of_products(size_t n, const double *x, const double *y, int threads)
{
    double partial[BLOCKS], sum = 0;
    size_t size = (n + BLOCKS - 1) / BLOCKS;
    if (size < LEAST) size = LEAST;
    const size_t blocks = (n + size - 1) / size;
#pragma omp parallel for num_threads(threads) schedule(static) if (blocks > 1)
    for (size_t b = 0; b < blocks; b++) {
        const size_t from = b * size, count = from + size < n ? size : n - from;
        partial[b] = block_sum(count, x + from, y + from);
    }
    for (size_t b = 0; b < blocks; b++)
        sum += partial[b];
    return sum;
}
