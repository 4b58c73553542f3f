/* The passes of the fused operator (fused.h, F1) for numbers of type REAL; included by kernels_double.c and
 * kernels_single.c.
 *
 * Vectors are those of the compiler (GNU C), as wide as the kind of processor has them; a row is a whole
 * number of FUSED_VECTOR bytes on each. With a constant number of taps all loops over taps and rows are
 * unrolled and sums stay in registers. */
#include "base/machine.h"
#include "method/consistent/fused/kernels.h"

#include <string.h>

typedef REAL lanes __attribute__((vector_size(VECTOR_BYTES), aligned(sizeof(REAL)), may_alias));
enum { LANES = VECTOR_BYTES / sizeof(REAL), GROUP = FUSED_VECTOR / sizeof(REAL) };

#define UNROLLED _Pragma("GCC unroll 32")

INLINED const lanes *at(const REAL *place)
{
    return (const lanes *)place;
}

/* Floats take sums with S and A of differences from a value in the middle, whose weight is the sum of the row's
 * (fused.c, shorten_all): most rows have the sum 0, and their rounding would act on an even displacement like a
 * load. */
enum { DIFFERENCES = sizeof(REAL) < sizeof(double) };

#if defined(__GNUC__)
#define FETCH(place) __builtin_prefetch(place, 0, 2)
#else
#define FETCH(place) (void)(place)
#endif

/* Over depth: result[m * FUSED_PLANES + r] := sum over t of weight[m][r * taps + t] times input plane r + t,
 * for one row of n points, matrices m from `begin` to `end` - 1. `bare`: B is the identity, its results are the
 * input. With N M_lambda the results of B with it are made (fused.h, F1c).
 * What is `ahead` numbers on, the next row, is asked for: so many rows are read together that the machine
 * does not foresee them. Floats, half as long, gain nothing from that. */
INLINED void over_depth(const int taps, const bool bare, const int begin, const int end,
                        const REAL *const *in, const REAL *const *weight, size_t n, size_t ahead,
                        REAL *const *result)
{
    for (size_t i = 0;; i += LANES) {
        if (i + LANES > n) i = n - LANES;
        lanes sum[OVER_DEPTH_MATRICES][FUSED_PLANES] = {0};
        const lanes middle = *at(in[taps / 2] + i);
        UNROLLED for (int t = 0; t < taps + FUSED_PLANES - 1; t++)
        {
            const lanes value = *at(in[t] + i);
            lanes change = value;
            if (DIFFERENCES && t != taps / 2) change -= middle;
            if (sizeof(REAL) == sizeof(double)) FETCH(in[t] + i + ahead);
            if (bare && t >= taps / 2 && t < taps / 2 + FUSED_PLANES)
                *(lanes *)(result[OVER_DEPTH_B * FUSED_PLANES + t - taps / 2] + i) = value;
            UNROLLED for (int m = begin; m < end; m++)
                UNROLLED for (int r = 0; r < FUSED_PLANES; r++) if (t >= r && t - r < taps) sum[m][r] +=
                weight[m][r * taps + t - r] * (m == OVER_DEPTH_A ? change : value);
        }
        UNROLLED for (int m = begin; m < end && m < OVER_DEPTH_LAMBDA; m++)
                UNROLLED for (int r = 0; r < FUSED_PLANES; r++) *
            (lanes *)(result[m * FUSED_PLANES + r] + i) = sum[m][r];
        UNROLLED for (int r = 0; r < FUSED_PLANES && end == OVER_DEPTH_MATRICES; r++)
        {
            const lanes mixed = sum[OVER_DEPTH_B][r] + sum[OVER_DEPTH_LAMBDA][r];
            *(lanes *)(result[OVER_DEPTH_B_MIXED * FUSED_PLANES + r] + i) = mixed;
            *(lanes *)(result[OVER_DEPTH_B_AXIAL * FUSED_PLANES + r] + i) = sum[OVER_DEPTH_B][r] + mixed;
        }
        if (i + LANES >= n) break;
    }
}

/* Sixteen registers do not hold the sums of four matrices. */
enum { MANY = VECTOR_BYTES == 64 };

/* All of layered ground for a component along it. */
INLINED void layered_over_depth(const int taps, const int begin, const REAL *const *in,
                                const REAL *const *weight, size_t n, size_t ahead, REAL *const *result)
{
    over_depth(taps, false, begin, MANY ? OVER_DEPTH_MATRICES : OVER_DEPTH_B, in, weight, n, ahead, result);
    if (!MANY) over_depth(taps, false, OVER_DEPTH_B, OVER_DEPTH_MATRICES, in, weight, n, 0, result);
}

/* The same where `other` displacements act by a lambda of their own (fused.h, F1a): A, C and B of what multiplies
 * them, and B of what q and p multiply, which x and y alone ask for. Sums `begin` to `end` - 1 of A, C, B and B of
 * `other`. */
INLINED void mixed_sums(const int taps, const bool normal, const int begin, const int end,
                        const REAL *const *in, const REAL *const *other, const REAL *const *weight,
                        const REAL *share, size_t n, size_t ahead, REAL *const *result)
{
    const REAL mixed = share[SHARE_MIXED], axial = share[SHARE_AXIAL];
    for (size_t i = 0;; i += LANES) {
        if (i + LANES > n) i = n - LANES;
        lanes sum[OVER_DEPTH_MATRICES][FUSED_PLANES] = {0};
        lanes middle = *at(in[taps / 2] + i);
        if (normal) middle += axial * *at(other[taps / 2] + i);
        UNROLLED for (int t = 0; t < taps + FUSED_PLANES - 1; t++)
        {
            const lanes shear = *at(in[t] + i), more = *at(other[t] + i);
            lanes value[] = {shear, shear + mixed * more, shear, more};
            if (normal) value[OVER_DEPTH_A] += axial * more;
            if (DIFFERENCES && t != taps / 2) value[OVER_DEPTH_A] -= middle;
            if (begin == 0) FETCH(in[t] + i + ahead);
            if (begin == 0) FETCH(other[t] + i + ahead);
            UNROLLED for (int m = begin; m < end; m++)
            {
                const int matrix = m < OVER_DEPTH_LAMBDA ? m : OVER_DEPTH_B;
                UNROLLED for (int r = 0; r < FUSED_PLANES; r++) if (t >= r && t - r < taps) sum[m][r] +=
                    weight[matrix][r * taps + t - r] * value[m];
            }
        }
        UNROLLED for (int r = 0; r < FUSED_PLANES; r++)
        {
            UNROLLED for (int m = begin; m < end && m < OVER_DEPTH_LAMBDA; m++) *
                (lanes *)(result[m * FUSED_PLANES + r] + i) = sum[m][r];
            if (end <= OVER_DEPTH_LAMBDA) continue;
            *(lanes *)(result[OVER_DEPTH_B_MIXED * FUSED_PLANES + r] + i) =
                sum[OVER_DEPTH_B][r] + mixed * sum[OVER_DEPTH_LAMBDA][r];
            *(lanes *)(result[OVER_DEPTH_B_AXIAL * FUSED_PLANES + r] + i) =
                sum[OVER_DEPTH_B][r] + axial * sum[OVER_DEPTH_LAMBDA][r];
        }
        if (i + LANES >= n) break;
    }
}

/* All of them. */
INLINED void mixed_over_depth(const int taps, const bool bare, const bool normal, const REAL *const *in,
                              const REAL *const *other, const REAL *const *weight, const REAL *share,
                              size_t n, size_t ahead, REAL *const *result)
{
    if (bare) {
        mixed_sums(taps, normal, 0, OVER_DEPTH_B, in, other, weight, share, n, ahead, result);
        for (int r = 0; r < FUSED_PLANES; r++) {
            const REAL *shear = in[r + taps / 2], *more = other[r + taps / 2];
            REAL *const *place = result + r;
#pragma omp simd
            for (size_t i = 0; i < n; i++) {
                place[OVER_DEPTH_B * FUSED_PLANES][i] = shear[i];
                if (normal) continue;
                place[OVER_DEPTH_B_MIXED * FUSED_PLANES][i] = shear[i] + share[SHARE_MIXED] * more[i];
                place[OVER_DEPTH_B_AXIAL * FUSED_PLANES][i] = shear[i] + share[SHARE_AXIAL] * more[i];
            }
        }
    } else if (normal || MANY) {
        mixed_sums(taps, normal, 0, normal ? OVER_DEPTH_LAMBDA : OVER_DEPTH_MATRICES, in, other, weight,
                   share, n, ahead, result);
    } else {
        mixed_sums(taps, false, 0, OVER_DEPTH_B, in, other, weight, share, n, ahead, result);
        mixed_sums(taps, false, OVER_DEPTH_B, OVER_DEPTH_MATRICES, in, other, weight, share, n, ahead,
                   result);
    }
}

/* Along x: out := init + matrix in, FUSED_ROWS rows, all from the same column on; entries beyond the row are
 * read, times 0. `stiff`: the matrix is S. */
INLINED void along_x(const int taps, const bool stiff, const REAL *restrict matrix, const REAL *in,
                     const REAL *init, size_t width, size_t stride, REAL *out)
{
    for (size_t i = 0; i < width; i += LANES) {
        const size_t group = i / GROUP * GROUP;
        lanes sum[FUSED_ROWS];
        UNROLLED for (int r = 0; r < FUSED_ROWS; r++) sum[r] = *at(init + (size_t)r * stride + i);
        UNROLLED for (int t = 0; t < taps; t++)
        {
            const lanes weight = *at(matrix + group * (size_t)taps + (size_t)t * GROUP + i - group);
            UNROLLED for (int r = 0; r < FUSED_ROWS; r++)
            {
                const REAL *middle = in + (size_t)r * stride + i;
                lanes value = *at(middle + t - taps / 2);
                if (stiff && DIFFERENCES && t != taps / 2) value -= *at(middle);
                sum[r] += weight * value;
            }
        }
        UNROLLED for (int r = 0; r < FUSED_ROWS; r++) * (lanes *)(out + (size_t)r * stride + i) = sum[r];
    }
}

/* Across rows: out := init + sum over t of weights times row t, FUSED_ROWS rows of the result from taps +
 * FUSED_ROWS - 1 rows. `step` from the weights of one row to the next: 0 where all are the same (of S: with the
 * sum 0). */
INLINED void across_y(const int taps, const bool stiff, const REAL *restrict weight, const size_t step,
                      const REAL *const *in, const REAL *init, size_t width, size_t stride, REAL *out)
{
    for (size_t i = 0; i < width; i += LANES) {
        lanes sum[FUSED_ROWS];
        UNROLLED for (int r = 0; r < FUSED_ROWS; r++) sum[r] = *at(init + (size_t)r * stride + i);
        const lanes first = *at(in[taps / 2] + i);
        UNROLLED for (int t = 0; t < taps + FUSED_ROWS - 1; t++)
        {
            const lanes value = *at(in[t] + i);
            lanes change = value;
            if (stiff && DIFFERENCES) change -= first;
            UNROLLED for (int r = 0; r < FUSED_ROWS; r++) if (t >= r && t - r < taps)
            {
                if (stiff && DIFFERENCES && step > 0 && t - r == taps / 2) change = value;
                if (stiff && DIFFERENCES && step > 0 && t - r != taps / 2)
                    change = value - *at(in[r + taps / 2] + i);
                sum[r] += weight[(size_t)r * step + (size_t)(t - r)] * change;
            }
        }
        UNROLLED for (int r = 0; r < FUSED_ROWS; r++) * (lanes *)(out + (size_t)r * stride + i) = sum[r];
    }
}

#include "method/consistent/fused/passes_fields.h"

#define DEPTH(name, deep, bare, begin, end)                                                                  \
    static void name(const REAL *const *in, const REAL *const *weight, size_t n, size_t ahead,               \
                     REAL *const *result)                                                                    \
    {                                                                                                        \
        over_depth(deep, bare, begin, end, in, weight, n, ahead, result);                                    \
    }

#define LAYERED(name, deep, begin)                                                                           \
    static void name(const REAL *const *in, const REAL *const *weight, size_t n, size_t ahead,               \
                     REAL *const *result)                                                                    \
    {                                                                                                        \
        layered_over_depth(deep, begin, in, weight, n, ahead, result);                                       \
    }

#define MIXED(name, deep, bare, normal)                                                                      \
    static void name(const REAL *const *in, const REAL *const *other, const REAL *const *weight,             \
                     const REAL *share, size_t n, size_t ahead, REAL *const *result)                         \
    {                                                                                                        \
        mixed_over_depth(deep, bare, normal, in, other, weight, share, n, ahead, result);                    \
    }

/* Along x and across y. */
#define SIDES(name, taps, stiff)                                                                             \
    static void x_##name(const REAL *matrix, const REAL *in, const REAL *init, size_t width, size_t stride,  \
                         REAL *out)                                                                          \
    {                                                                                                        \
        along_x(taps, stiff, matrix, in, init, width, stride, out);                                          \
    }                                                                                                        \
    static void y_##name(const REAL *weight, const REAL *const *in, const REAL *init, size_t width,          \
                         size_t stride, REAL *out)                                                           \
    {                                                                                                        \
        across_y(taps, stiff, weight, 0, in, init, width, stride, out);                                      \
    }                                                                                                        \
    static void ends_##name(const REAL *weight, const REAL *const *in, const REAL *init, size_t width,       \
                            size_t stride, REAL *out)                                                        \
    {                                                                                                        \
        across_y(taps, stiff, weight, taps, in, init, width, stride, out);                                   \
    }
SIDES(stiff, 5, true)

/* One function for each pass and number of taps. */
#define PASSES(wide, deep)                                                                                   \
    SIDES(wide, wide, false)                                                                                 \
    DEPTH(two_##deep, deep, true, 0, 2)                                                                      \
    DEPTH(three_##deep, deep, false, 0, 3)                                                                   \
    DEPTH(two_bulk_##deep, deep, true, 1, 2)                                                                 \
    DEPTH(three_bulk_##deep, deep, false, 1, 3)                                                              \
    LAYERED(four_##deep, deep, 0)                                                                            \
    LAYERED(four_bulk_##deep, deep, 1)                                                                       \
    MIXED(bare_##deep, deep, true, false)                                                                    \
    MIXED(bare_normal_##deep, deep, true, true)                                                              \
    MIXED(mixed_##deep, deep, false, false)                                                                  \
    MIXED(mixed_normal_##deep, deep, false, true)
PASSES(5, 9)
PASSES(9, 13)
PASSES(13, 17)

#define OF(wide, deep)                                                                                       \
    {                                                                                                        \
        wide, x_##wide, y_##wide, ends_##wide,                                                               \
            {                                                                                                \
                {two_##deep, two_bulk_##deep},                                                               \
                {three_##deep, three_bulk_##deep},                                                           \
                {four_##deep, four_bulk_##deep},                                                             \
            },                                                                                               \
        {                                                                                                    \
            {bare_##deep, bare_normal_##deep},                                                               \
            {                                                                                                \
                mixed_##deep, mixed_normal_##deep                                                            \
            }                                                                                                \
        }                                                                                                    \
    }
const struct NAME(fused_kernels) OF_PROCESSOR(NAME(fused_kernels)) = {{OF(5, 9), OF(9, 13), OF(13, 17)},
                                                                      x_stiff,
                                                                      y_stiff,
                                                                      ends_stiff,
                                                                      measure,
                                                                      drift,
                                                                      relax,
                                                                      kick,
                                                                      gather,
                                                                      weigh,
                                                                      spread,
                                                                      keep};
