/* Loops of the layers' shared passes (pml_fast.h) for numbers of type REAL; included by pml_fast_double.c and
 * pml_fast_single.c. Vectors as in fused_kernel.h; each function is made for each kind of machine. */
#include "base/machine.h"
#include "method/consistent/absorbing/pml_fast.h"

typedef REAL lanes __attribute__((vector_size(64), aligned(sizeof(REAL)), may_alias));
enum { LANE_COUNT = 64 / sizeof(REAL) };

#define UNROLLED _Pragma("GCC unroll 16")

INLINED const lanes *at(const REAL *place)
{
    return (const lanes *)place;
}

/* out row r := (add: out row r) + sum over t of weight[t * rows + r] times in row t, `count` vectors. */
INLINED void rows_block(const int rows, const int count, const bool add, const REAL *restrict weight,
                        size_t inputs, const REAL *in, size_t in_step, REAL *out, size_t out_step)
{
    lanes sum[FAST_ROWS][2];
    UNROLLED for (int r = 0; r < rows; r++) UNROLLED for (int v = 0; v < count; v++) sum[r][v] =
        add ? *at(out + (size_t)r * out_step + v * LANE_COUNT) : (lanes){0};
    for (size_t t = 0; t < inputs; t++, weight += rows, in += in_step)
        UNROLLED for (int r = 0; r < rows; r++) UNROLLED for (int v = 0; v < count; v++) sum[r][v] +=
            weight[r] * *at(in + v * LANE_COUNT);
    UNROLLED for (int r = 0; r < rows; r++) UNROLLED for (int v = 0; v < count; v++) *
        (lanes *)(out + (size_t)r * out_step + v * LANE_COUNT) = sum[r][v];
}

INLINED void rows_all(const int rows, const bool add, const REAL *weight, size_t inputs, const REAL *in,
                      size_t in_step, size_t width, REAL *out, size_t out_step)
{
    size_t i = 0;
    for (; i + 2 * LANE_COUNT <= width; i += 2 * LANE_COUNT)
        rows_block(rows, 2, add, weight, inputs, in + i, in_step, out + i, out_step);
    if (i < width) rows_block(rows, 1, add, weight, inputs, in + i, in_step, out + i, out_step);
}

/* out row r += matrix by diagonals times in row r, with its neighbours. */
INLINED void along_all(const int rows, const REAL *restrict matrix, size_t taps, const REAL *in,
                       size_t in_step, size_t width, REAL *out)
{
    for (size_t i = 0; i < width; i += LANE_COUNT) {
        lanes sum[FAST_ROWS];
        UNROLLED for (int r = 0; r < rows; r++) sum[r] = *at(out + (size_t)r * width + i);
        for (size_t t = 0; t < taps; t++) {
            const lanes weight = *at(matrix + t * width + i);
            const REAL *from = in + i + t - taps / 2;
            UNROLLED for (int r = 0; r < rows; r++) sum[r] += weight * *at(from + (size_t)r * in_step);
        }
        UNROLLED for (int r = 0; r < rows; r++) * (lanes *)(out + (size_t)r * width + i) = sum[r];
    }
}

#define ROWS_KERNEL(rows)                                                                                    \
    void NAME(pml_set_##rows)(const REAL *weight, size_t inputs, const REAL *in, size_t in_step,             \
                              size_t width, REAL *out, size_t out_step);                                     \
    EACH_MACHINE void NAME(pml_set_##rows)(const REAL *weight, size_t inputs, const REAL *in,                \
                                           size_t in_step, size_t width, REAL *out, size_t out_step)         \
    {                                                                                                        \
        rows_all(rows, false, weight, inputs, in, in_step, width, out, out_step);                            \
    }                                                                                                        \
    void NAME(pml_add_##rows)(const REAL *weight, size_t inputs, const REAL *in, size_t in_step,             \
                              size_t width, REAL *out, size_t out_step);                                     \
    EACH_MACHINE void NAME(pml_add_##rows)(const REAL *weight, size_t inputs, const REAL *in,                \
                                           size_t in_step, size_t width, REAL *out, size_t out_step)         \
    {                                                                                                        \
        rows_all(rows, true, weight, inputs, in, in_step, width, out, out_step);                             \
    }                                                                                                        \
    void NAME(pml_along_##rows)(const REAL *matrix, size_t taps, const REAL *in, size_t in_step,             \
                                size_t width, REAL *out);                                                    \
    EACH_MACHINE void NAME(pml_along_##rows)(const REAL *matrix, size_t taps, const REAL *in,                \
                                             size_t in_step, size_t width, REAL *out)                        \
    {                                                                                                        \
        along_all(rows, matrix, taps, in, in_step, width, out);                                              \
    }
ROWS_KERNEL(1)
ROWS_KERNEL(2)
ROWS_KERNEL(3)
ROWS_KERNEL(4)
ROWS_KERNEL(5)
ROWS_KERNEL(6)
ROWS_KERNEL(7)
ROWS_KERNEL(8)
ROWS_KERNEL(9)

/* By the number of rows. */
typedef void rows_kernel(const REAL *weight, size_t inputs, const REAL *in, size_t in_step, size_t width,
                         REAL *out, size_t out_step);
typedef void along_kernel(const REAL *matrix, size_t taps, const REAL *in, size_t in_step, size_t width,
                          REAL *out);
static rows_kernel *const set_kernel[FAST_ROWS + 1] = {NULL,
                                                       NAME(pml_set_1),
                                                       NAME(pml_set_2),
                                                       NAME(pml_set_3),
                                                       NAME(pml_set_4),
                                                       NAME(pml_set_5),
                                                       NAME(pml_set_6),
                                                       NAME(pml_set_7),
                                                       NAME(pml_set_8),
                                                       NAME(pml_set_9)};
static rows_kernel *const add_kernel[FAST_ROWS + 1] = {NULL,
                                                       NAME(pml_add_1),
                                                       NAME(pml_add_2),
                                                       NAME(pml_add_3),
                                                       NAME(pml_add_4),
                                                       NAME(pml_add_5),
                                                       NAME(pml_add_6),
                                                       NAME(pml_add_7),
                                                       NAME(pml_add_8),
                                                       NAME(pml_add_9)};
static along_kernel *const along_kernels[FAST_ROWS + 1] = {NULL,
                                                           NAME(pml_along_1),
                                                           NAME(pml_along_2),
                                                           NAME(pml_along_3),
                                                           NAME(pml_along_4),
                                                           NAME(pml_along_5),
                                                           NAME(pml_along_6),
                                                           NAME(pml_along_7),
                                                           NAME(pml_along_8),
                                                           NAME(pml_along_9)};

/* Rows of a field, `factor` * v added, n numbers each at the steps given, into rows of `width`, 0 from n on.
 */
void NAME(pml_load)(const REAL *u, const REAL *v, REAL factor, size_t rows, size_t step_row, size_t n,
                    size_t step, size_t width, REAL *out);
EACH_MACHINE void NAME(pml_load)(const REAL *restrict u, const REAL *restrict v, REAL factor, size_t rows,
                                 size_t step_row, size_t n, size_t step, size_t width, REAL *restrict out)
{
    for (size_t r = 0; r < rows; r++)
        for (size_t i = n; i < width; i++)
            out[r * width + i] = 0;
    if (step == 1) {
        for (size_t r = 0; r < rows; r++)
            for (size_t i = 0; i < n; i++)
                out[r * width + i] = u[r * step_row + i] + factor * v[r * step_row + i];
        return;
    }
    for (size_t i = 0; i < n; i++)
        for (size_t r = 0; r < rows; r++)
            out[r * width + i] = u[i * step + r * step_row] + factor * v[i * step + r * step_row];
}

/* The other way round: a += factor * rows. */
void NAME(pml_store)(const REAL *in, REAL factor, size_t rows, size_t step_row, size_t n, size_t step,
                     size_t width, REAL *a);
EACH_MACHINE void NAME(pml_store)(const REAL *restrict in, REAL factor, size_t rows, size_t step_row,
                                  size_t n, size_t step, size_t width, REAL *restrict a)
{
    if (step == 1) {
        for (size_t r = 0; r < rows; r++)
            for (size_t i = 0; i < n; i++)
                a[r * step_row + i] += factor * in[r * width + i];
        return;
    }
    for (size_t i = 0; i < n; i++)
        for (size_t r = 0; r < rows; r++)
            a[i * step + r * step_row] += factor * in[r * width + i];
}

void NAME(pml_sum)(size_t n, const REAL *in, REAL *out);
EACH_MACHINE void NAME(pml_sum)(size_t n, const REAL *restrict in, REAL *restrict out)
{
    for (size_t i = 0; i < n; i++)
        out[i] += in[i];
}

/* Moves a row of a memory variable on (Eq 10), q = d dt / 2 and `kept` = 1 / (1 + q + alpha dt / 2); middle
 * (may be NULL) gets the mean of both ends of the step. */
void NAME(pml_move)(size_t n, REAL q, REAL kept, const REAL *g, REAL *memory, REAL *middle);
EACH_MACHINE void NAME(pml_move)(size_t n, REAL q, REAL kept, const REAL *restrict g, REAL *restrict memory,
                                 REAL *restrict middle)
{
    for (size_t i = 0; i < n; i++) {
        const REAL mean = kept * (memory[i] - q * g[i]);
        memory[i] = 2 * mean - memory[i];
        if (middle != NULL) middle[i] = mean;
    }
}

/* Is a number of these rows of n larger than the level, or none? */
bool NAME(pml_loud)(size_t rows, size_t step, size_t n, REAL level, const REAL *x);
EACH_MACHINE bool NAME(pml_loud)(size_t rows, size_t step, size_t n, REAL level, const REAL *x)
{
    for (size_t r = 0; r < rows; r++) {
        int loud = 0;
        for (size_t i = 0; i < n; i++) {
            const REAL size = x[r * step + i] < 0 ? -x[r * step + i] : x[r * step + i];
            loud |= !(size <= level);
        }
        if (loud) return true;
    }
    return false;
}
