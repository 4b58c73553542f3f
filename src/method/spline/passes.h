/* Sums over a few rows or a few neighbours: what passes of band matrices over fields are made of. */
#ifndef SELAS_METHOD_SPLINE_PASSES_H
#define SELAS_METHOD_SPLINE_PASSES_H

#include "base/processor.h"

#include <stdbool.h>
#include <stddef.h>

/* Rows that are made together, at most. */
enum { PASS_ROWS = 4 };

/* out[r][i] := (add: out[r][i]) + sum over t < inputs of weight[t * rows + r] * in[t][i], i < n, for so many rows;
 * single rows of `in` may be among those of `out`. */
typedef void passes_rows(const double *weight, size_t inputs, const double *const *in, size_t n, bool add,
                         double *const *out);
/* out[r * step + i] += factor * sum over d < taps of value[d * n + i] * in[r * in_step + d + i], i < n. */
typedef void passes_neighbours(const double *value, size_t taps, double factor, const double *in,
                               size_t in_step, size_t n, double *out, size_t step);

struct passes {
    passes_rows *rows[PASS_ROWS + 1];
    passes_neighbours *neighbours[PASS_ROWS + 1];
    /* Largest |x[i]|, i < n. */
    double (*largest_size_double)(const double *x, size_t n);
    float (*largest_size_single)(const float *x, size_t n);
    /* Is none of them infinite or no number? */
    bool (*all_finite)(const double *x, size_t n);
};
EACH_PROCESSOR(struct passes, passes)

#endif
