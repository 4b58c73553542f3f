/* Sums over rows and neighbours in vectors, so many at a time that none waits for another and all find registers, and
 * at the end of a row one more. The last vector of a row that is no whole number of them overlaps the one before: sums
 * of one go are all made before any is stored. */
#include "method/spline/passes.h"

#include "base/machine.h"
#include "base/vectors.h"

enum { MOST = 9 };

#define UNROLLED _Pragma("GCC unroll 16")

/* Vectors of each of so many rows that are made together. */
INLINED int together(const int rows)
{
    return rows == 1 ? 8 : rows == 2 ? 4 : FEW_REGISTERS ? 2 : 4;
}

/* Where vector v of `count` begins, from i on: the last one at `last`. */
INLINED size_t place(const int count, int v, size_t i, size_t last)
{
    return v == count - 1 ? last : i + (size_t)v * LANES;
}

INLINED void rows_at(const int rows, const int count, const double *restrict weight, size_t inputs,
                     const double *const *in, size_t i, size_t last, bool add, double *const *out)
{
    lanes sum[PASS_ROWS][MOST];
    UNROLLED for (int r = 0; r < rows; r++) UNROLLED for (int v = 0; v < count; v++) sum[r][v] =
        add ? AT(out[r] + place(count, v, i, last)) : (lanes){0};
    for (size_t t = 0; t < inputs; t++, weight += rows) {
        const double *from = in[t];
        UNROLLED for (int v = 0; v < count; v++)
        {
            const lanes value = AT(from + place(count, v, i, last));
            UNROLLED for (int r = 0; r < rows; r++) sum[r][v] += weight[r] * value;
        }
    }
    UNROLLED for (int r = 0; r < rows; r++) UNROLLED for (int v = 0; v < count; v++) *
        (lanes *)(out[r] + place(count, v, i, last)) = sum[r][v];
}

/* CALL(count) for the vectors that are left from i on, at most one more than are made together. */
#define FOR_THE_REST(rows, CALL)                                                                             \
    for (int left = (int)((n - i + LANES - 1) / LANES), count = 1; count <= MOST; count++)                   \
        if (count == left && count <= together(rows) + 1) CALL(count)

INLINED void rows_all(const int rows, const double *weight, size_t inputs, const double *const *in, size_t n,
                      bool add, double *const *out)
{
    if (n < LANES) {
        for (int r = 0; r < rows; r++)
            for (size_t i = 0; i < n; i++) {
                double total = add ? out[r][i] : 0;
                for (size_t t = 0; t < inputs; t++)
                    total += weight[t * (size_t)rows + (size_t)r] * in[t][i];
                out[r][i] = total;
            }
        return;
    }
    const size_t ahead = (size_t)together(rows) * LANES;
    size_t i = 0;
    for (; i + ahead + LANES < n; i += ahead)
        rows_at(rows, together(rows), weight, inputs, in, i, i + ahead - LANES, add, out);
#define ROWS(count) rows_at(rows, count, weight, inputs, in, i, n - LANES, add, out);
    UNROLLED FOR_THE_REST(rows, ROWS)
#undef ROWS
}

INLINED void neighbours_at(const int rows, const int count, const double *restrict value, size_t taps,
                           double factor, const double *in, size_t in_step, size_t n, size_t i, size_t last,
                           double *out, size_t step)
{
    lanes sum[PASS_ROWS][MOST];
    UNROLLED for (int r = 0; r < rows; r++) UNROLLED for (int v = 0; v < count; v++) sum[r][v] = (lanes){0};
    for (size_t d = 0; d < taps; d++)
        UNROLLED for (int v = 0; v < count; v++)
        {
            const lanes weight = AT(value + d * n + place(count, v, i, last));
            UNROLLED for (int r = 0; r < rows; r++) sum[r][v] +=
                weight * AT(in + (size_t)r * in_step + d + place(count, v, i, last));
        }
    UNROLLED for (int r = 0; r < rows; r++) UNROLLED for (int v = 0; v < count; v++) sum[r][v] =
        AT(out + (size_t)r * step + place(count, v, i, last)) + factor * sum[r][v];
    UNROLLED for (int r = 0; r < rows; r++) UNROLLED for (int v = 0; v < count; v++) *
        (lanes *)(out + (size_t)r * step + place(count, v, i, last)) = sum[r][v];
}

INLINED void neighbours_all(const int rows, const double *value, size_t taps, double factor, const double *in,
                            size_t in_step, size_t n, double *out, size_t step)
{
    if (n < LANES) {
        for (int r = 0; r < rows; r++)
            for (size_t i = 0; i < n; i++) {
                double total = 0;
                for (size_t d = 0; d < taps; d++)
                    total += value[d * n + i] * in[(size_t)r * in_step + d + i];
                out[(size_t)r * step + i] += factor * total;
            }
        return;
    }
    const size_t ahead = (size_t)together(rows) * LANES;
    size_t i = 0;
    for (; i + ahead + LANES < n; i += ahead)
        neighbours_at(rows, together(rows), value, taps, factor, in, in_step, n, i, i + ahead - LANES, out,
                      step);
#define NEIGHBOURS(count)                                                                                    \
    neighbours_at(rows, count, value, taps, factor, in, in_step, n, i, n - LANES, out, step);
    UNROLLED FOR_THE_REST(rows, NEIGHBOURS)
#undef NEIGHBOURS
}

#define OF_ROWS(count)                                                                                       \
    static void rows_##count(const double *weight, size_t inputs, const double *const *in, size_t n,         \
                             bool add, double *const *out)                                                   \
    {                                                                                                        \
        if (add)                                                                                             \
            rows_all(count, weight, inputs, in, n, true, out);                                               \
        else                                                                                                 \
            rows_all(count, weight, inputs, in, n, false, out);                                              \
    }                                                                                                        \
    static void neighbours_##count(const double *value, size_t taps, double factor, const double *in,        \
                                   size_t in_step, size_t n, double *out, size_t step)                       \
    {                                                                                                        \
        neighbours_all(count, value, taps, factor, in, in_step, n, out, step);                               \
    }
OF_ROWS(1)
OF_ROWS(2)
OF_ROWS(3)
OF_ROWS(4)

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

static bool all_finite(const double *x, size_t n)
{
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (size_t i = 0; i < n; i++)
        sum += x[i] - x[i];
    return sum == 0;
}

const struct passes OF_PROCESSOR(passes) = {{NULL, rows_1, rows_2, rows_3, rows_4},
                                            {NULL, neighbours_1, neighbours_2, neighbours_3, neighbours_4},
                                            largest_size_double,
                                            largest_size_single,
                                            all_finite};
