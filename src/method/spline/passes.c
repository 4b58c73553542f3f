/* Sums over rows and neighbours in vectors of 64 bytes (GNU C; narrower machines take several for one), four
 * vectors at a time, and at the end of a row up to five. The last vector of a row that is no whole number of
 * them overlaps the one before: sums of one go are all made before any is stored. */
#include "method/spline/passes.h"

#include "base/machine.h"

typedef double lanes __attribute__((vector_size(64), aligned(sizeof(double)), may_alias));
enum { LANE_COUNT = 8, TOGETHER = 4, MOST = TOGETHER + 1 };

INLINED const lanes *at(const double *place)
{
    return (const lanes *)place;
}

/* Where vector v of `count` begins, from i on: the last one at `last`. */
INLINED size_t place(const int count, int v, size_t i, size_t last)
{
    return v == count - 1 ? last : i + (size_t)v * LANE_COUNT;
}

INLINED void rows_at(const int count, const double *restrict weight, size_t taps, const double *in,
                     size_t stride, size_t i, size_t last, const double *init, double *out)
{
    lanes sum[MOST];
    for (int v = 0; v < count; v++)
        sum[v] = init != NULL ? *at(init + place(count, v, i, last)) : (lanes){0};
    for (size_t d = 0; d < taps; d++)
        for (int v = 0; v < count; v++)
            sum[v] += weight[d] * *at(in + d * stride + place(count, v, i, last));
    for (int v = 0; v < count; v++)
        *(lanes *)(out + place(count, v, i, last)) = sum[v];
}

/* CALL(count) for the vectors that are left from i on. */
#define FOR_THE_REST(CALL)                                                                                   \
    switch ((n - i + LANE_COUNT - 1) / LANE_COUNT) {                                                         \
    case 1:                                                                                                  \
        CALL(1);                                                                                             \
        break;                                                                                               \
    case 2:                                                                                                  \
        CALL(2);                                                                                             \
        break;                                                                                               \
    case 3:                                                                                                  \
        CALL(3);                                                                                             \
        break;                                                                                               \
    case 4:                                                                                                  \
        CALL(4);                                                                                             \
        break;                                                                                               \
    default:                                                                                                 \
        CALL(5);                                                                                             \
    }

EACH_MACHINE
void pass_over_rows(const double *weight, size_t taps, const double *in, size_t stride, size_t n,
                    const double *init, double *out)
{
    if (n < LANE_COUNT) {
        for (size_t i = 0; i < n; i++) {
            double total = init != NULL ? init[i] : 0;
            for (size_t d = 0; d < taps; d++)
                total += weight[d] * in[d * stride + i];
            out[i] = total;
        }
        return;
    }
    size_t i = 0;
    for (; i + MOST * LANE_COUNT < n; i += TOGETHER * LANE_COUNT)
        rows_at(TOGETHER, weight, taps, in, stride, i, i + (TOGETHER - 1) * LANE_COUNT, init, out);
#define ROWS(count) rows_at(count, weight, taps, in, stride, i, n - LANE_COUNT, init, out)
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
            sum[v] += *at(value + d * n + place(count, v, i, last)) * *at(in + d + place(count, v, i, last));
    for (int v = 0; v < count; v++)
        sum[v] = *at(out + place(count, v, i, last)) + factor * sum[v];
    for (int v = 0; v < count; v++)
        *(lanes *)(out + place(count, v, i, last)) = sum[v];
}

EACH_MACHINE
void pass_over_neighbours(const double *value, size_t taps, double factor, const double *in, size_t n,
                          double *out)
{
    if (n < LANE_COUNT) {
        for (size_t i = 0; i < n; i++) {
            double total = 0;
            for (size_t d = 0; d < taps; d++)
                total += value[d * n + i] * in[d + i];
            out[i] += factor * total;
        }
        return;
    }
    size_t i = 0;
    for (; i + MOST * LANE_COUNT < n; i += TOGETHER * LANE_COUNT)
        neighbours_at(TOGETHER, value, taps, factor, in, n, i, i + (TOGETHER - 1) * LANE_COUNT, out);
#define NEIGHBOURS(count) neighbours_at(count, value, taps, factor, in, n, i, n - LANE_COUNT, out)
    FOR_THE_REST(NEIGHBOURS)
#undef NEIGHBOURS
}

#define LARGEST_SIZE(name, type)                                                                             \
    EACH_MACHINE                                                                                             \
    type name(const type *x, size_t n)                                                                       \
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
