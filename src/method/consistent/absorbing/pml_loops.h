/* Loops of the layers' shared passes (pml_fast.h) for numbers of type REAL; included by pml_kernels_double.c
 * and pml_kernels_single.c. Rows are whole numbers of FAST_LANES doubles or twice as many floats. */
#include "base/machine.h"
#include "method/consistent/absorbing/pml_kernels.h"

typedef REAL lanes __attribute__((vector_size(VECTOR_BYTES), aligned(sizeof(REAL)), may_alias));
enum { LANES = VECTOR_BYTES / sizeof(REAL), MOST_VECTORS = 4 };

#define UNROLLED _Pragma("GCC unroll 16")

INLINED const lanes *at(const REAL *place)
{
    return (const lanes *)place;
}

/* What sums of rows begin with: 0, what is there, or (CHANGE) the sum of the weights times the input in the
 * middle, where that sum stands in the place of the middle's weight and the other inputs are less the middle. */
enum begin { SET, ADD, CHANGE };

/* out row r := (ADD: out row r) + sum over t of weight[t * rows + r] times in row t, `count` vectors. */
INLINED void rows_block(const int rows, const int count, const enum begin begin, const REAL *restrict weight,
                        size_t inputs, const REAL *in, size_t in_step, REAL *out, size_t out_step)
{
    lanes sum[FAST_ROWS][MOST_VECTORS], middle[MOST_VECTORS];
    UNROLLED for (int v = 0; begin == CHANGE && v < count; v++) middle[v] =
        *at(in + inputs / 2 * in_step + v * LANES);
    UNROLLED for (int r = 0; r < rows; r++) UNROLLED for (int v = 0; v < count; v++)
    {
        sum[r][v] = begin == ADD ? *at(out + (size_t)r * out_step + v * LANES) : (lanes){0};
        if (begin == CHANGE) sum[r][v] = weight[inputs / 2 * (size_t)rows + (size_t)r] * middle[v];
    }
    for (size_t t = 0; t < inputs; t++, weight += rows, in += in_step) {
        lanes value[MOST_VECTORS];
        UNROLLED for (int v = 0; v < count; v++)
        {
            value[v] = *at(in + v * LANES);
            if (begin == CHANGE) value[v] -= middle[v];
        }
        UNROLLED for (int r = 0; r < rows; r++) /* a weight once for all vectors */
            UNROLLED for (int v = 0; v < count; v++) sum[r][v] += weight[r] * value[v];
    }
    UNROLLED for (int r = 0; r < rows; r++) UNROLLED for (int v = 0; v < count; v++) *
        (lanes *)(out + (size_t)r * out_step + v * LANES) = sum[r][v];
}

/* Fetches so many numbers of each row from i on, by lines of 64 bytes. Where rows stand together all of a group's are
 * in one line or two: the first is fetched, the next group's first is the second. */
INLINED void fetch(const int rows, const size_t numbers, const struct ahead *ahead, size_t i)
{
    enum { LINE = 64 / sizeof(REAL) };
    const REAL *place = (const REAL *)ahead->place + i * ahead->step;
    if (ahead->step != 1) {
        for (size_t n = 0; n < numbers; n++)
            __builtin_prefetch(place + n * ahead->step);
        return;
    }
    for (int r = 0; r < rows; r++, place += ahead->step_row)
        for (size_t n = 0; n < numbers; n += LINE)
            __builtin_prefetch(place + n);
}

/* Few rows: four vectors, as few sums wait for each other. */
INLINED void rows_all(const int rows, const enum begin begin, const REAL *weight, size_t inputs,
                      const REAL *in, size_t in_step, size_t width, REAL *out, size_t out_step,
                      const struct ahead *ahead)
{
    const int count = rows < 3 ? MOST_VECTORS : 2;
    const size_t together = (size_t)count * LANES;
    size_t i = 0;
    for (; i + together <= width; i += together) {
        if (ahead != NULL) fetch(rows, together, ahead, i);
        rows_block(rows, count, begin, weight, inputs, in + i, in_step, out + i, out_step);
    }
    for (; i < width; i += LANES)
        rows_block(rows, 1, begin, weight, inputs, in + i, in_step, out + i, out_step);
}

/* out row r += matrix by diagonals times in row r, with its neighbours. */
INLINED void along_all(const int rows, const REAL *restrict matrix, size_t taps, const REAL *in,
                       size_t in_step, size_t width, REAL *out)
{
    for (size_t i = 0; i < width; i += LANES) {
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

#define OF_ROWS(rows)                                                                                        \
    static void set_##rows(const REAL *weight, size_t inputs, const REAL *in, size_t in_step, size_t width,  \
                           REAL *out, size_t out_step, const struct ahead *ahead)                            \
    {                                                                                                        \
        rows_all(rows, SET, weight, inputs, in, in_step, width, out, out_step, ahead);                       \
    }                                                                                                        \
    static void add_##rows(const REAL *weight, size_t inputs, const REAL *in, size_t in_step, size_t width,  \
                           REAL *out, size_t out_step, const struct ahead *ahead)                            \
    {                                                                                                        \
        rows_all(rows, ADD, weight, inputs, in, in_step, width, out, out_step, ahead);                       \
    }                                                                                                        \
    static void change_##rows(const REAL *weight, size_t inputs, const REAL *in, size_t in_step,             \
                              size_t width, REAL *out, size_t out_step, const struct ahead *ahead)           \
    {                                                                                                        \
        rows_all(rows, CHANGE, weight, inputs, in, in_step, width, out, out_step, ahead);                    \
    }                                                                                                        \
    static void along_##rows(const REAL *matrix, size_t taps, const REAL *in, size_t in_step, size_t width,  \
                             REAL *out)                                                                      \
    {                                                                                                        \
        along_all(rows, matrix, taps, in, in_step, width, out);                                              \
    }
OF_ROWS(1)
OF_ROWS(2)
OF_ROWS(3)
OF_ROWS(4)
OF_ROWS(5)

/* Rows of a field, `factor` * v added, n numbers each at the steps given, into rows of `width`, 0 from n on.
 */
static void load(const REAL *restrict u, const REAL *restrict v, REAL factor, size_t rows, size_t step_row,
                 size_t n, size_t step, size_t width, REAL *restrict out)
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
static void store(const REAL *restrict in, REAL factor, size_t rows, size_t step_row, size_t n, size_t step,
                  size_t width, REAL *restrict a)
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

static void sum_up(size_t n, const REAL *restrict in, REAL *restrict out)
{
    for (size_t i = 0; i < n; i++)
        out[i] += in[i];
}

/* Moves a row of a memory variable on (Eq 10), q = d dt / 2 and `kept` = 1 / (1 + q + alpha dt / 2); middle
 * (may be NULL) gets the mean of both ends of the step. */
static void move(size_t n, REAL q, REAL kept, const REAL *restrict g, REAL *restrict memory,
                 REAL *restrict middle)
{
    for (size_t i = 0; i < n; i++) {
        const REAL mean = kept * (memory[i] - q * g[i]);
        memory[i] = 2 * mean - memory[i];
        if (middle != NULL) middle[i] = mean;
    }
}

/* Is a number of these rows of n larger than the level, or none? (Where one is others are near: looked for in pieces.)
 */
static bool loud(size_t rows, size_t step, size_t n, REAL level, const REAL *x)
{
    enum { PIECE = 64 * LANES };
    for (size_t r = 0; r < rows; r++)
        for (size_t from = 0; from < n; from += PIECE) {
            const REAL *piece = x + r * step + from;
            const size_t numbers = n - from < PIECE ? n - from : PIECE;
            int loud = 0;
            for (size_t i = 0; i < numbers; i++) {
                const REAL size = piece[i] < 0 ? -piece[i] : piece[i];
                loud |= !(size <= level);
            }
            if (loud) return true;
        }
    return false;
}

#define BY_ROWS(name)                                                                                        \
    {                                                                                                        \
        NULL, name##_1, name##_2, name##_3, name##_4, name##_5                                               \
    }
const struct NAME(pml_kernels) OF_PROCESSOR(NAME(pml_kernels)) = {
    BY_ROWS(set), BY_ROWS(add), BY_ROWS(change), BY_ROWS(along), load, store, sum_up, move, loud};
