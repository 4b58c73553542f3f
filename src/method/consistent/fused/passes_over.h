/* The passes of the fused operator (fused.h, F1) for numbers of type REAL; included by kernels_double.c and
 * kernels_single.c.
 *
 * Vectors are those of the compiler (GNU C), as wide as the kind of processor has them; a row is a whole
 * number of FUSED_VECTOR bytes on each. With a constant number of taps all loops over taps and rows are
 * unrolled and sums stay in registers. */
#include "base/machine.h"
#include "method/consistent/fused/kernels.h"

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
 * for one row of n points, matrices m from `begin` to `end` - 1. Without the last matrix, B, which is then the
 * identity, its results are the input.
 * What is `ahead` numbers on, the next row, is asked for: so many rows are read together that the machine
 * does not foresee them. Floats, half as long, gain nothing from that. */
INLINED void over_depth(const int taps, const int begin, const int end, const REAL *const *in,
                        const REAL *const *weight, size_t n, size_t ahead, REAL *const *result)
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
            if (end < OVER_DEPTH_MATRICES && t >= taps / 2 && t < taps / 2 + FUSED_PLANES)
                *(lanes *)(result[OVER_DEPTH_B * FUSED_PLANES + t - taps / 2] + i) = value;
            UNROLLED for (int m = begin; m < end; m++)
                UNROLLED for (int r = 0; r < FUSED_PLANES; r++) if (t >= r && t - r < taps) sum[m][r] +=
                weight[m][r * taps + t - r] * (m == OVER_DEPTH_A ? change : value);
        }
        UNROLLED for (int m = begin; m < end; m++) UNROLLED for (int r = 0; r < FUSED_PLANES; r++) *
            (lanes *)(result[m * FUSED_PLANES + r] + i) = sum[m][r];
        if (i + LANES >= n) break;
    }
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
        lanes sum[OVER_DEPTH_MATRICES + 1][FUSED_PLANES] = {0};
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
                const int matrix = m < OVER_DEPTH_MATRICES ? m : OVER_DEPTH_B;
                UNROLLED for (int r = 0; r < FUSED_PLANES; r++) if (t >= r && t - r < taps) sum[m][r] +=
                    weight[matrix][r * taps + t - r] * value[m];
            }
        }
        UNROLLED for (int r = 0; r < FUSED_PLANES; r++)
        {
            UNROLLED for (int m = begin; m < end && m < OVER_DEPTH_MATRICES; m++) *
                (lanes *)(result[m * FUSED_PLANES + r] + i) = sum[m][r];
            if (end <= OVER_DEPTH_MATRICES) continue;
            *(lanes *)(result[OVER_DEPTH_B_MIXED * FUSED_PLANES + r] + i) =
                sum[OVER_DEPTH_B][r] + mixed * sum[OVER_DEPTH_MATRICES][r];
            *(lanes *)(result[OVER_DEPTH_B_AXIAL * FUSED_PLANES + r] + i) =
                sum[OVER_DEPTH_B][r] + axial * sum[OVER_DEPTH_MATRICES][r];
        }
        if (i + LANES >= n) break;
    }
}

/* All of them; sixteen registers do not hold the sums of four matrices. */
INLINED void mixed_over_depth(const int taps, const bool bare, const bool normal, const REAL *const *in,
                              const REAL *const *other, const REAL *const *weight, const REAL *share,
                              size_t n, size_t ahead, REAL *const *result)
{
    enum { ALL = OVER_DEPTH_MATRICES + 1, MANY = VECTOR_BYTES == 64 };
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
        mixed_sums(taps, normal, 0, normal ? OVER_DEPTH_MATRICES : ALL, in, other, weight, share, n, ahead,
                   result);
    } else {
        mixed_sums(taps, false, 0, OVER_DEPTH_B, in, other, weight, share, n, ahead, result);
        mixed_sums(taps, false, OVER_DEPTH_B, ALL, in, other, weight, share, n, ahead, result);
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

/* Largest |u| of so many rows in a vector of columns: that of each column so far in `column`, of all in
 * `largest`. */
INLINED void measured(size_t rows, size_t step, const REAL *restrict u, REAL *restrict column,
                      REAL *restrict largest)
{
    REAL most[LANES] = {0};
    for (size_t row = 0; row < rows; row++) {
#pragma omp simd
        for (int lane = 0; lane < LANES; lane++) {
            const REAL value = u[row * step + (size_t)lane], size = value < 0 ? -value : value;
            most[lane] = size > most[lane] ? size : most[lane];
        }
    }
#pragma omp simd
    for (int lane = 0; lane < LANES; lane++) {
        column[lane] = most[lane] > column[lane] ? most[lane] : column[lane];
        largest[lane] = most[lane] > largest[lane] ? most[lane] : largest[lane];
    }
}

/* The same for n columns, the last vector ending with them (less than a vector: one by one); gives the
 * largest. */
INLINED REAL measured_rows(size_t n, size_t rows, size_t step, const REAL *u, REAL *column)
{
    REAL lane[LANES] = {0}, largest = 0;
    for (size_t i = 0; n >= LANES; i += LANES) {
        if (i + LANES > n) i = n - LANES;
        measured(rows, step, u + i, column + i, lane);
        if (i + LANES == n) break;
    }
    for (size_t row = 0; n < LANES && row < rows; row++)
        for (size_t i = 0; i < n; i++) {
            const REAL value = u[row * step + i], size = value < 0 ? -value : value;
            column[i] = size > column[i] ? size : column[i];
            lane[i] = size > lane[i] ? size : lane[i];
        }
    for (int i = 0; i < LANES; i++)
        largest = lane[i] > largest ? lane[i] : largest;
    return largest;
}

static REAL measure(size_t n, size_t rows, size_t step, const REAL *u, REAL *column)
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
static REAL drift(size_t n, size_t rows, size_t step, REAL dt, const REAL *w, REAL *u, REAL *column)
{
    if (n == step)
        moved(rows * n, dt, w, u);
    else
        for (size_t row = 0; row < rows; row++)
            moved(n, dt, w + row * step, u + row * step);
    return measured_rows(n, rows, step, u, column);
}

/* u, `other` if there are two parts, and their memory go on (fused.h, fused_relax), n numbers. */
INLINED void relaxed(const size_t mechanisms, const size_t parts, size_t n, const struct fused_relax *r,
                     const REAL *restrict w, REAL *restrict memory, REAL *restrict u, REAL *restrict other)
{
    const REAL by_rate = (REAL)r->by_rate[0], other_by_rate = (REAL)r->by_rate[1];
    const REAL from = (REAL)r->from_parts[0], from_other = (REAL)r->from_parts[1];
#pragma omp simd
    for (size_t i = 0; i < n; i++) {
        REAL change = by_rate * w[i], change_other = other_by_rate * w[i];
        REAL told = parts > 1 ? from * u[i] + from_other * other[i] : 0;
        for (size_t l = 0; l < mechanisms; l++) {
            const bool last = parts > 1 && l + 1 == mechanisms;
            const REAL before = last ? told : memory[r->at[l] + i];
            if (!last) memory[r->at[l] + i] = (REAL)r->kept[l] * before + (REAL)r->taken[l] * w[i];
            if (!last && parts > 1) told += (REAL)r->from_memory[l] * before;
            change += (REAL)r->by_memory[0][l] * before;
            if (parts > 1) change_other += (REAL)r->by_memory[1][l] * before;
        }
        u[i] += change;
        if (parts > 1) other[i] += change_other;
    }
}

INLINED void relaxed_by(const size_t parts, size_t n, const struct fused_relax *r, const REAL *w,
                        REAL *memory, REAL *u, REAL *other)
{
    switch (r->mechanisms) {
    case 1:
        relaxed(1, parts, n, r, w, memory, u, other);
        break;
    case 2:
        relaxed(2, parts, n, r, w, memory, u, other);
        break;
    case 3:
        relaxed(3, parts, n, r, w, memory, u, other);
        break;
    case 4:
        relaxed(4, parts, n, r, w, memory, u, other);
        break;
    default:
        relaxed(r->mechanisms, parts, n, r, w, memory, u, other);
    }
}

static REAL relax(size_t n, size_t rows, size_t step, const struct fused_relax *r, const REAL *w,
                  REAL *memory, REAL *u, REAL *other, REAL *column)
{
    const size_t length = n == step ? rows * n : n; /* whole rows as one */
    for (size_t at = 0; at < rows * step; at += n == step ? length : step) {
        if (other == NULL)
            relaxed_by(1, length, r, w + at, memory + at, u + at, NULL);
        else
            relaxed_by(2, length, r, w + at, memory + at, u + at, other + at);
    }
    return measured_rows(n, rows, step, u, column);
}

/* w += dt a */
static void kick(size_t n, REAL dt, const REAL *restrict a, REAL *restrict w)
{
    moved(n, dt, a, w);
}

/* out += weight in, number by number */
static void weigh(size_t n, const double *restrict weight, const REAL *restrict in, REAL *restrict out)
{
#pragma omp simd
    for (size_t i = 0; i < n; i++)
        out[i] += (REAL)weight[i] * in[i];
}

/* FUSED_STRIP numbers of each row += weights times the row's value. */
static void spread(size_t rows, size_t step, const REAL *restrict weight, const REAL *restrict value,
                   REAL *restrict sum)
{
    for (size_t row = 0; row < rows; row++)
#pragma omp simd
        for (size_t i = 0; i < FUSED_STRIP; i++)
            sum[row * step + i] += weight[i] * value[row];
}

#define DEPTH(name, deep, begin, end)                                                                        \
    static void name(const REAL *const *in, const REAL *const *weight, size_t n, size_t ahead,               \
                     REAL *const *result)                                                                    \
    {                                                                                                        \
        over_depth(deep, begin, end, in, weight, n, ahead, result);                                          \
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
    DEPTH(two_##deep, deep, 0, 2)                                                                            \
    DEPTH(three_##deep, deep, 0, 3)                                                                          \
    DEPTH(two_bulk_##deep, deep, 1, 2)                                                                       \
    DEPTH(three_bulk_##deep, deep, 1, 3)                                                                     \
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
                                                                      weigh,
                                                                      spread};
