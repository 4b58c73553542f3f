/* Sums over rows and neighbours in vectors of 64 bytes (GNU C; narrower machines take several for one), four
 * vectors at a time. The last vector of a row that is no whole number of them overlaps the one before: it is
 * made first, from what `out` held on entry, and stored last. */
#include "method/passes.h"

#include "base/machine.h"

typedef double lanes __attribute__((vector_size(64), aligned(sizeof(double)), may_alias));
enum { LANE_COUNT = 8, TOGETHER = 4 };

INLINED const lanes *at(const double *place)
{
    return (const lanes *)place;
}

/* The sums of `count` vectors from i on. */
INLINED void rows_at(const int count, const double *restrict weight, size_t taps, const double *in,
                     size_t stride, size_t i, lanes *sum)
{
    for (size_t d = 0; d < taps; d++)
        for (int v = 0; v < count; v++)
            sum[v] += weight[d] * *at(in + d * stride + i + (size_t)v * LANE_COUNT);
}

INLINED void start(const int count, const double *init, size_t i, lanes *sum)
{
    for (int v = 0; v < count; v++)
        sum[v] = init != NULL ? *at(init + i + (size_t)v * LANE_COUNT) : (lanes){0};
}

INLINED void store(const int count, const lanes *sum, size_t i, double *out)
{
    for (int v = 0; v < count; v++)
        *(lanes *)(out + i + (size_t)v * LANE_COUNT) = sum[v];
}

EACH_MACHINE
void pass_over_rows(const double *weight, size_t taps, const double *in, size_t stride, size_t n,
                    const double *init, double *out)
{
    lanes sum[TOGETHER], last[1];
    if (n < LANE_COUNT) {
        for (size_t i = 0; i < n; i++) {
            double total = init != NULL ? init[i] : 0;
            for (size_t d = 0; d < taps; d++)
                total += weight[d] * in[d * stride + i];
            out[i] = total;
        }
        return;
    }
    start(1, init, n - LANE_COUNT, last);
    rows_at(1, weight, taps, in, stride, n - LANE_COUNT, last);
    size_t i = 0;
    for (; i + TOGETHER * LANE_COUNT <= n; i += TOGETHER * LANE_COUNT) {
        start(TOGETHER, init, i, sum);
        rows_at(TOGETHER, weight, taps, in, stride, i, sum);
        store(TOGETHER, sum, i, out);
    }
    for (; i + LANE_COUNT < n; i += LANE_COUNT) {
        start(1, init, i, sum);
        rows_at(1, weight, taps, in, stride, i, sum);
        store(1, sum, i, out);
    }
    store(1, last, n - LANE_COUNT, out);
}

INLINED void neighbours_at(const int count, const double *restrict value, size_t taps, double factor,
                           const double *restrict in, size_t n, size_t i, const double *out, lanes *sum)
{
    start(count, NULL, i, sum);
    for (size_t d = 0; d < taps; d++)
        for (int v = 0; v < count; v++)
            sum[v] +=
                *at(value + d * n + i + (size_t)v * LANE_COUNT) * *at(in + d + i + (size_t)v * LANE_COUNT);
    for (int v = 0; v < count; v++)
        sum[v] = *at(out + i + (size_t)v * LANE_COUNT) + factor * sum[v];
}

EACH_MACHINE
void pass_over_neighbours(const double *value, size_t taps, double factor, const double *in, size_t n,
                          double *out)
{
    lanes sum[TOGETHER], last[1];
    if (n < LANE_COUNT) {
        for (size_t i = 0; i < n; i++) {
            double total = 0;
            for (size_t d = 0; d < taps; d++)
                total += value[d * n + i] * in[d + i];
            out[i] += factor * total;
        }
        return;
    }
    neighbours_at(1, value, taps, factor, in, n, n - LANE_COUNT, out, last);
    size_t i = 0;
    for (; i + TOGETHER * LANE_COUNT <= n; i += TOGETHER * LANE_COUNT) {
        neighbours_at(TOGETHER, value, taps, factor, in, n, i, out, sum);
        store(TOGETHER, sum, i, out);
    }
    for (; i + LANE_COUNT < n; i += LANE_COUNT) {
        neighbours_at(1, value, taps, factor, in, n, i, out, sum);
        store(1, sum, i, out);
    }
    store(1, last, n - LANE_COUNT, out);
}
