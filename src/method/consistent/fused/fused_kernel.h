/* The passes of the fused operator (fused.h, F1) for numbers of type REAL; included by fused_double.c and
 * fused_single.c.
 *
 * Vectors are those of the compiler (GNU C), 64 bytes, as wide as any machine's; on others the compiler takes
 * two or four for one. With a constant number of taps all loops over taps and rows are unrolled and sums stay
 * in registers. */
#include "base/machine.h"
#include "method/consistent/fused/fused.h"

typedef REAL lanes __attribute__((vector_size(FUSED_VECTOR), aligned(sizeof(REAL)), may_alias));
enum { LANE_COUNT = FUSED_VECTOR / sizeof(REAL) };

#define UNROLLED _Pragma("GCC unroll 32")

INLINED const lanes *at(const REAL *place)
{
    return (const lanes *)place;
}

#if defined(__GNUC__)
#define FETCH(place) __builtin_prefetch(place, 0, 2)
#else
#define FETCH(place) (void)(place)
#endif

/* Over depth: result[m * FUSED_PLANES + r] := sum over t of weight[m][r * taps + t] times input plane r + t,
 * for one row of n points. Without the last matrix, B, which is then the identity, its results are the input.
 * What is `ahead` numbers on, the next row, is asked for: so many rows are read together that the machine
 * does not foresee them. Floats, half as long, gain nothing from that. */
INLINED void over_depth(const int taps, const int matrices, const REAL *const *in, const REAL *const *weight,
                        size_t n, size_t ahead, REAL *const *result)
{
    for (size_t i = 0;; i += LANE_COUNT) {
        if (i + LANE_COUNT > n) i = n - LANE_COUNT;
        lanes sum[OVER_DEPTH_MATRICES][FUSED_PLANES] = {0};
        UNROLLED for (int t = 0; t < taps + FUSED_PLANES - 1; t++)
        {
            const lanes value = *at(in[t] + i);
            if (sizeof(REAL) == sizeof(double)) FETCH(in[t] + i + ahead);
            if (matrices < OVER_DEPTH_MATRICES && t >= taps / 2 && t < taps / 2 + FUSED_PLANES)
                *(lanes *)(result[OVER_DEPTH_B * FUSED_PLANES + t - taps / 2] + i) = value;
            UNROLLED for (int m = 0; m < matrices; m++)
                UNROLLED for (int r = 0; r < FUSED_PLANES; r++) if (t >= r && t - r < taps) sum[m][r] +=
                weight[m][r * taps + t - r] * value;
        }
        UNROLLED for (int m = 0; m < matrices; m++) UNROLLED for (int r = 0; r < FUSED_PLANES; r++) *
            (lanes *)(result[m * FUSED_PLANES + r] + i) = sum[m][r];
        if (i + LANE_COUNT >= n) break;
    }
}

/* Along x: out := init + matrix in, FUSED_ROWS rows, all from the same column on; entries beyond the row are
 * read, times 0. */
INLINED void along_x(const int taps, const REAL *restrict matrix, const REAL *in, const REAL *init,
                     size_t width, size_t stride, REAL *out)
{
    for (size_t i = 0; i < width; i += LANE_COUNT) {
        lanes sum[FUSED_ROWS];
        UNROLLED for (int r = 0; r < FUSED_ROWS; r++) sum[r] = *at(init + (size_t)r * stride + i);
        UNROLLED for (int t = 0; t < taps; t++)
        {
            const lanes weight = *at(matrix + i * (size_t)taps + (size_t)t * LANE_COUNT);
            UNROLLED for (int r = 0; r < FUSED_ROWS; r++) sum[r] +=
                weight * *at(in + (size_t)r * stride + i + t - taps / 2);
        }
        UNROLLED for (int r = 0; r < FUSED_ROWS; r++) * (lanes *)(out + (size_t)r * stride + i) = sum[r];
    }
}

/* Across rows: out := init + sum over t of weights times row t, FUSED_ROWS rows of the result from taps +
 * FUSED_ROWS - 1 rows. `step` from the weights of one row to the next: 0 where all are the same. */
INLINED void across_y(const int taps, const REAL *restrict weight, const size_t step, const REAL *const *in,
                      const REAL *init, size_t width, size_t stride, REAL *out)
{
    for (size_t i = 0; i < width; i += LANE_COUNT) {
        lanes sum[FUSED_ROWS];
        UNROLLED for (int r = 0; r < FUSED_ROWS; r++) sum[r] = *at(init + (size_t)r * stride + i);
        UNROLLED for (int t = 0; t < taps + FUSED_ROWS - 1; t++)
        {
            const lanes value = *at(in[t] + i);
            UNROLLED for (int r = 0; r < FUSED_ROWS; r++) if (t >= r && t - r < taps) sum[r] +=
                weight[(size_t)r * step + (size_t)(t - r)] * value;
        }
        UNROLLED for (int r = 0; r < FUSED_ROWS; r++) * (lanes *)(out + (size_t)r * stride + i) = sum[r];
    }
}

/* Largest |u| of so many rows in a vector of columns: that of each column so far in `column`, of all in
 * `largest`. */
INLINED void measured(size_t rows, size_t step, const REAL *restrict u, REAL *restrict column,
                      REAL *restrict largest)
{
    REAL most[LANE_COUNT] = {0};
    for (size_t row = 0; row < rows; row++) {
#pragma omp simd
        for (int lane = 0; lane < LANE_COUNT; lane++) {
            const REAL value = u[row * step + (size_t)lane], size = value < 0 ? -value : value;
            most[lane] = size > most[lane] ? size : most[lane];
        }
    }
#pragma omp simd
    for (int lane = 0; lane < LANE_COUNT; lane++) {
        column[lane] = most[lane] > column[lane] ? most[lane] : column[lane];
        largest[lane] = most[lane] > largest[lane] ? most[lane] : largest[lane];
    }
}

/* The same for n columns, the last vector ending with them (less than a vector: one by one); gives the
 * largest. */
INLINED REAL measured_rows(size_t n, size_t rows, size_t step, const REAL *u, REAL *column)
{
    REAL lane[LANE_COUNT] = {0}, largest = 0;
    for (size_t i = 0; n >= LANE_COUNT; i += LANE_COUNT) {
        if (i + LANE_COUNT > n) i = n - LANE_COUNT;
        measured(rows, step, u + i, column + i, lane);
        if (i + LANE_COUNT == n) break;
    }
    for (size_t row = 0; n < LANE_COUNT && row < rows; row++)
        for (size_t i = 0; i < n; i++) {
            const REAL value = u[row * step + i], size = value < 0 ? -value : value;
            column[i] = size > column[i] ? size : column[i];
            lane[i] = size > lane[i] ? size : lane[i];
        }
    for (int i = 0; i < LANE_COUNT; i++)
        largest = lane[i] > largest ? lane[i] : largest;
    return largest;
}

REAL NAME(fused_measure)(size_t n, size_t rows, size_t step, const REAL *u, REAL *column);
EACH_MACHINE REAL NAME(fused_measure)(size_t n, size_t rows, size_t step, const REAL *u, REAL *column)
{
    return measured_rows(n, rows, step, u, column);
}

INLINED void moved(size_t n, REAL dt, const REAL *restrict w, REAL *restrict u)
{
#pragma omp simd
    for (size_t i = 0; i < n; i++)
        u[i] += dt * w[i];
}

/* The same with u += dt w before. */
REAL NAME(fused_drift)(size_t n, size_t rows, size_t step, REAL dt, const REAL *w, REAL *u, REAL *column);
EACH_MACHINE REAL NAME(fused_drift)(size_t n, size_t rows, size_t step, REAL dt, const REAL *w, REAL *u,
                                    REAL *column)
{
    if (n == step)
        moved(rows * n, dt, w, u);
    else
        for (size_t row = 0; row < rows; row++)
            moved(n, dt, w + row * step, u + row * step);
    return measured_rows(n, rows, step, u, column);
}

/* w += dt a */
void NAME(fused_kick)(size_t n, REAL dt, const REAL *a, REAL *w);
EACH_MACHINE void NAME(fused_kick)(size_t n, REAL dt, const REAL *restrict a, REAL *restrict w)
{
#pragma omp simd
    for (size_t i = 0; i < n; i++)
        w[i] += dt * a[i];
}

/* One function for each kernel and number of taps, once for each kind of machine; at run time that which fits
 * is taken. */
#define DEPTH_KERNEL(name, taps, matrices)                                                                   \
    void name(const REAL *const *in, const REAL *const *weight, size_t n, size_t ahead,                      \
              REAL *const *result);                                                                          \
    EACH_MACHINE void name(const REAL *const *in, const REAL *const *weight, size_t n, size_t ahead,         \
                           REAL *const *result)                                                              \
    {                                                                                                        \
        over_depth(taps, matrices, in, weight, n, ahead, result);                                            \
    }
#define X_KERNEL(name, taps)                                                                                 \
    void name(const REAL *matrix, const REAL *in, const REAL *init, size_t width, size_t stride, REAL *out); \
    EACH_MACHINE void name(const REAL *matrix, const REAL *in, const REAL *init, size_t width,               \
                           size_t stride, REAL *out)                                                         \
    {                                                                                                        \
        along_x(taps, matrix, in, init, width, stride, out);                                                 \
    }
#define Y_KERNEL(name, taps, step)                                                                           \
    void name(const REAL *weight, const REAL *const *in, const REAL *init, size_t width, size_t stride,      \
              REAL *out);                                                                                    \
    EACH_MACHINE void name(const REAL *weight, const REAL *const *in, const REAL *init, size_t width,        \
                           size_t stride, REAL *out)                                                         \
    {                                                                                                        \
        across_y(taps, weight, step, in, init, width, stride, out);                                          \
    }

/* Degree 2: 5 taps for S and G, 2 * 2 * sweeps + 1 for N, four more for products over depth. */
#define SWEEPS(wide, deep)                                                                                   \
    X_KERNEL(NAME(fused_x_##wide), wide)                                                                     \
    Y_KERNEL(NAME(fused_y_##wide), wide, 0)                                                                  \
    Y_KERNEL(NAME(fused_ends_##wide), wide, wide)                                                            \
    DEPTH_KERNEL(NAME(fused_two_##deep), deep, 2)                                                            \
    DEPTH_KERNEL(NAME(fused_three_##deep), deep, 3)
SWEEPS(5, 9)
SWEEPS(9, 13)
SWEEPS(13, 17)

struct kernels {
    int wide;
    void (*two)(const REAL *const *in, const REAL *const *weight, size_t n, size_t ahead,
                REAL *const *result);
    void (*three)(const REAL *const *in, const REAL *const *weight, size_t n, size_t ahead,
                  REAL *const *result);
    void (*x_narrow)(const REAL *matrix, const REAL *in, const REAL *init, size_t width, size_t stride,
                     REAL *out);
    void (*x_wide)(const REAL *matrix, const REAL *in, const REAL *init, size_t width, size_t stride,
                   REAL *out);
    void (*y_narrow)(const REAL *weight, const REAL *const *in, const REAL *init, size_t width, size_t stride,
                     REAL *out);
    void (*y_narrow_ends)(const REAL *weight, const REAL *const *in, const REAL *init, size_t width,
                          size_t stride, REAL *out);
    void (*y_wide)(const REAL *weight, const REAL *const *in, const REAL *init, size_t width, size_t stride,
                   REAL *out);
    void (*y_wide_ends)(const REAL *weight, const REAL *const *in, const REAL *init, size_t width,
                        size_t stride, REAL *out);
};

#define KERNELS_OF(wide, deep)                                                                               \
    {                                                                                                        \
        wide, NAME(fused_two_##deep), NAME(fused_three_##deep), NAME(fused_x_5), NAME(fused_x_##wide),       \
            NAME(fused_y_5), NAME(fused_ends_5), NAME(fused_y_##wide), NAME(fused_ends_##wide)               \
    }
static const struct kernels kernel_table[] = {KERNELS_OF(5, 9), KERNELS_OF(9, 13), KERNELS_OF(13, 17)};
