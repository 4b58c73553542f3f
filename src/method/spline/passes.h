/* Sums over a few rows or a few neighbours: what passes of band matrices over fields are made of. */
#ifndef SELAS_METHOD_SPLINE_PASSES_H
#define SELAS_METHOD_SPLINE_PASSES_H

#include "base/processor.h"

#include <stddef.h>

struct passes {
    /* out[i] := init[i] + sum over d < taps of weight[d] * in[d * stride + i], i < n; init NULL: 0; init
     * and single rows of `in` may be out. */
    void (*over_rows)(const double *weight, size_t taps, const double *in, size_t stride, size_t n,
                      const double *init, double *out);
    /* out[i] += factor * sum over d < taps of value[d * n + i] * in[d + i], i < n. */
    void (*over_neighbours)(const double *value, size_t taps, double factor, const double *in, size_t n,
                            double *out);
    /* Largest |x[i]|, i < n. */
    double (*largest_size_double)(const double *x, size_t n);
    float (*largest_size_single)(const float *x, size_t n);
};
EACH_PROCESSOR(struct passes, passes)

#endif
