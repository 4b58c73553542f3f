/* Passes over fields along their rows: what a step does to u and w, and how large u is; included by passes_over.h. */
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

/* Vectors of what `gather` and `weigh` make, side by side from number i on. */
enum { MOST_ABREAST = 4 };

INLINED void gathered(const int abreast, size_t count, const REAL *weight, const REAL *const *row, size_t i,
                      const REAL *out, lanes *sum)
{
    UNROLLED for (int v = 0; v < abreast; v++) sum[v] = *at(out + i + v * LANES);
    for (size_t t = 0; t < count; t++)
        UNROLLED for (int v = 0; v < abreast; v++) sum[v] += weight[t] * *at(row[t] + i + v * LANES);
}

INLINED lanes factors(const double *weight)
{
    const void *same = weight;
    if (sizeof(REAL) == sizeof(double)) return *at(same);
    REAL factor[LANES];
#pragma omp simd
    for (int lane = 0; lane < LANES; lane++)
        factor[lane] = (REAL)weight[lane];
    return *at(factor);
}

INLINED void weighed(const int abreast, size_t n, size_t taps, const double *weight, const REAL *in,
                     const REAL *out, lanes *sum)
{
    UNROLLED for (int v = 0; v < abreast; v++) sum[v] = *at(out + v * LANES);
    for (size_t t = 0; t < taps; t++, weight += n, in++)
        UNROLLED for (int v = 0; v < abreast; v++) sum[v] +=
            factors(weight + v * LANES) * *at(in + v * LANES);
}

/* out += MAKE(abreast, from number i on), n numbers; the last vector ends with them. */
#define ABREAST(n, out, MAKE)                                                                                \
    lanes last[1], sum[MOST_ABREAST];                                                                        \
    size_t i = n - LANES;                                                                                    \
    MAKE(1, last);                                                                                           \
    for (i = 0; i + MOST_ABREAST * LANES <= n; i += MOST_ABREAST * LANES) {                                  \
        MAKE(MOST_ABREAST, sum);                                                                             \
        UNROLLED for (int v = 0; v < MOST_ABREAST; v++) * (lanes *)(out + i + v * LANES) = sum[v];           \
    }                                                                                                        \
    for (; i + LANES < n; i += LANES) {                                                                      \
        MAKE(1, sum);                                                                                        \
        *(lanes *)(out + i) = sum[0];                                                                        \
    }                                                                                                        \
    *(lanes *)(out + n - LANES) = last[0];

/* out += sum over rows of weight times row (less than a vector: number by number). */
static void gather(size_t n, size_t count, const REAL *weight, const REAL *const *row, REAL *out)
{
    for (size_t i = 0; n < LANES && i < n; i++)
        for (size_t t = 0; t < count; t++)
            out[i] += weight[t] * row[t][i];
    if (n < LANES) return;
#define MAKE(abreast, sum) gathered(abreast, count, weight, row, i, out, sum)
    ABREAST(n, out, MAKE)
#undef MAKE
}

/* out += a band matrix, by diagonals, times in. */
static void weigh(size_t n, size_t taps, const double *weight, const REAL *in, REAL *out)
{
    for (size_t i = 0; n < LANES && i < n; i++)
        for (size_t t = 0; t < taps; t++)
            out[i] += (REAL)weight[t * n + i] * in[t + i];
    if (n < LANES) return;
#define MAKE(abreast, sum) weighed(abreast, n, taps, weight + i, in + i, out + i, sum)
    ABREAST(n, out, MAKE)
#undef MAKE
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

/* Numbers of a row times weights, one after the other or, with step 0, one for all. */
static void keep(size_t n, const double *restrict weight, size_t step, REAL *restrict row)
{
    const REAL one = (REAL)weight[0];
    if (step == 0) {
#pragma omp simd
        for (size_t i = 0; i < n; i++)
            row[i] *= one;
        return;
    }
#pragma omp simd
    for (size_t i = 0; i < n; i++)
        row[i] *= (REAL)weight[i];
}
