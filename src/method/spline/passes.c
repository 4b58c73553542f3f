/* Sums over rows and neighbours in vectors, eight at a time (sums of fewer wait for each other, more find no
 * registers), and at the end of a row up to nine. The last vector of a row that is no whole number of them
 * overlaps the one before: sums of one go are all made before any is stored. */
#include "method/spline/passes.h"

#include "base/machine.h"
#include "base/vectors.h"

enum { TOGETHER = 8, MOST = TOGETHER + 1 };

/* Where vector v of `count` begins, from i on: the last one at `last`. */
INLINED size_t place(const int count, int v, size_t i, size_t last)
{
    return v == count - 1 ? last : i + (size_t)v * LANES;
}

INLINED void rows_at(const int count, const double *restrict weight, size_t taps, const double *in,
                     size_t stride, size_t i, size_t last, const double *init, double *out)
{
    lanes sum[MOST];
    for (int v = 0; v < count; v++)
        sum[v] = init != NULL ? AT(init + place(count, v, i, last)) : (lanes){0};
    for (size_t d = 0; d < taps; d++)
        for (int v = 0; v < count; v++)
            sum[v] += weight[d] * AT(in + d * stride + place(count, v, i, last));
    for (int v = 0; v < count; v++)
        *(lanes *)(out + place(count, v, i, last)) = sum[v];
}

/* CALL(count) for the vectors that are left from i on, 1 to MOST. */
#define FOR_THE_REST(CALL)                                                                                   \
    switch ((n - i + LANES - 1) / LANES) {                                                                   \
        CASE(1, CALL)                                                                                        \
        CASE(2, CALL)                                                                                        \
        CASE(3, CALL)                                                                                        \
        CASE(4, CALL)                                                                                        \
        CASE(5, CALL)                                                                                        \
        CASE(6, CALL)                                                                                        \
        CASE(7, CALL)                                                                                        \
        CASE(8, CALL)                                                                                        \
    default:                                                                                                 \
        CALL(MOST);                                                                                          \
    }
#define CASE(count, CALL)                                                                                    \
    case count:                                                                                              \
        CALL(count);                                                                                         \
        break;

static void over_rows(const double *weight, size_t taps, const double *in, size_t stride, size_t n,
                      const double *init, double *out)
{
    if (n < LANES) {
        for (size_t i = 0; i < n; i++) {
            double total = init != NULL ? init[i] : 0;
            for (size_t d = 0; d < taps; d++)
                total += weight[d] * in[d * stride + i];
            out[i] = total;
        }
        return;
    }
    size_t i = 0;
    for (; i + MOST * LANES < n; i += TOGETHER * LANES)
        rows_at(TOGETHER, weight, taps, in, stride, i, i + (TOGETHER - 1) * LANES, init, out);
#define ROWS(count) rows_at(count, weight, taps, in, stride, i, n - LANES, init, out)
    FOR_THE_REST(ROWS)
#undef ROWS
}

INLINED void neighbours_at(const int count, const double *restrict value, size_t taps, double factor,
                           const double *in, size_t n, size_t i, size_t last, double *out)
{
    lanes sum[MOST];
    for (int v = 0; v < count; v++)
        sum[v] = (lanes){0};
    for (size_t d = 0; d < taps; d++)
        for (int v = 0; v < count; v++)
            sum[v] += AT(value + d * n + place(count, v, i, last)) * AT(in + d + place(count, v, i, last));
    for (int v = 0; v < count; v++)
        sum[v] = AT(out + place(count, v, i, last)) + factor * sum[v];
    for (int v = 0; v < count; v++)
        *(lanes *)(out + place(count, v, i, last)) = sum[v];
}

static void over_neighbours(const double *value, size_t taps, double factor, const double *in, size_t n,
                            double *out)
{
    if (n < LANES) {
        for (size_t i = 0; i < n; i++) {
            double total = 0;
            for (size_t d = 0; d < taps; d++)
                total += value[d * n + i] * in[d + i];
            out[i] += factor * total;
        }
        return;
    }
    size_t i = 0;
    for (; i + MOST * LANES < n; i += TOGETHER * LANES)
        neighbours_at(TOGETHER, value, taps, factor, in, n, i, i + (TOGETHER - 1) * LANES, out);
#define NEIGHBOURS(count) neighbours_at(count, value, taps, factor, in, n, i, n - LANES, out)
    FOR_THE_REST(NEIGHBOURS)
#undef NEIGHBOURS
}

#define LARGEST_SIZE(name, type)                                                                             \
    static type name(const type *x, size_t n)                                                                \
    {                                                                                                        \
        type largest = 0;                                                                                    \
        _Pragma("omp simd reduction(max : largest)") for (size_t i = 0; i < n; i++)                          \
        {                                                                                                    \
            const type size = x[i] < 0 ? -x[i] : x[i];                                                       \
            largest = size > largest ? size : largest;                                                       \
        }                                                                                                    \
        return largest;                                                                                      \
    }
LARGEST_SIZE(largest_size_double, double)
LARGEST_SIZE(largest_size_single, float)

const struct passes OF_PROCESSOR(passes) = {over_rows, over_neighbours, largest_size_double,
                                            largest_size_single};
