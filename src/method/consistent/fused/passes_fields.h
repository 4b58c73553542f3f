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

/* Less than a vector of a row: what is not there is 0, or stays. */
INLINED lanes part_of(const REAL *row, size_t count)
{
    lanes value = {0};
    memcpy(&value, row, count * sizeof *row);
    return value;
}

INLINED void put_part(REAL *row, size_t count, lanes value)
{
    if (count >= LANES)
        *(lanes *)row = value;
    else
        memcpy(row, &value, count * sizeof *row);
}

/* Fields of displacements that relax go on (relax.h, F2), n numbers; change, if it is not NULL: by how much those of
 * the parts do. */
INLINED void relaxed(const size_t parts, const size_t fields, size_t n, const struct fused_relax *r,
                     const REAL *w, REAL *const *field, REAL *const *change)
{
    REAL rate[FUSED_FIELDS_KEPT] = {0}, by[FUSED_FIELDS_KEPT][FUSED_FIELDS_KEPT], *to[FUSED_FIELDS_KEPT];
    for (size_t f = 0; f < fields; f++) {
        to[f] = field[f];
        rate[f] = (REAL)r->rate[f];
        for (size_t g = 0; g < fields; g++)
            by[f][g] = (REAL)r->by[f][g];
    }
    for (size_t i = 0; i < n; i += LANES) {
        const size_t count = n - i;
        const lanes speed = count >= LANES ? *at(w + i) : part_of(w + i, count);
        lanes z[FUSED_FIELDS_KEPT] = {0};
        UNROLLED for (size_t f = 0; f < fields; f++) z[f] =
            count >= LANES ? *at(to[f] + i) : part_of(to[f] + i, count);
        UNROLLED for (size_t p = 0; p < parts; p++)
        {
            lanes sum = rate[p] * speed;
            UNROLLED for (size_t g = 0; g < fields; g++) sum += by[p][g] * z[g];
            put_part(to[p] + i, count, z[p] + sum);
            if (change != NULL) put_part(change[p] + i, count, sum);
        }
        UNROLLED for (size_t f = parts; f < fields; f++)
            put_part(to[f] + i, count, z[f] + (rate[f] * speed + by[f][f] * z[f]));
    }
}

INLINED void relaxed_by(const size_t parts, size_t n, const struct fused_relax *r, const REAL *w,
                        REAL *const *field, REAL *const *change)
{
    if (r->fields == parts)
        relaxed(parts, parts, n, r, w, field, change);
    else if (r->fields == parts + 1)
        relaxed(parts, parts + 1, n, r, w, field, change);
    else if (r->fields == parts + 2)
        relaxed(parts, parts + 2, n, r, w, field, change);
    else if (r->fields == parts + 3)
        relaxed(parts, parts + 3, n, r, w, field, change);
    else
        relaxed(parts, r->fields, n, r, w, field, change);
}

static void relax(size_t n, const struct fused_relax *r, const REAL *w, REAL *const *field,
                  REAL *const *change)
{
    switch (r->parts) {
    case 1:
        relaxed_by(1, n, r, w, field, change);
        break;
    case 2:
        relaxed_by(2, n, r, w, field, change);
        break;
    case 3:
        relaxed_by(3, n, r, w, field, change);
        break;
    case 4:
        relaxed_by(4, n, r, w, field, change);
        break;
    default:
        relaxed(r->parts, r->fields, n, r, w, field, change);
    }
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
