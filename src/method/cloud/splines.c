/* Galerkin's matrix of the pair correction on functions f = sum c_s b_s of cubic B-splines with knots a few
 * spacings apart: P takes c to x = (f, grad f / 2), and the matrix is P^T (C w C^T) P (solver.c says
 * why). It takes every STRIDE-th pair, times STRIDE. Splines are numbered row by row, so that the matrix
 * and its Cholesky factor have a band: of each row what stands from its first number to the diagonal is kept.
 * (GSL has band matrices too, but its BLAS does not work in vectors.) */
#include "method/cloud/splines.h"

#include "base/machine.h"
#include "base/memory.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

enum { MOST_SPLINES = 3500, STRIDE = 4, MOST = 64, NUMBERS = 4 };

/* A point's cell: its first spline, and the four B-splines of each axis there and half their derivatives. */
struct local {
    size_t first;
    double value[3][4], slope[3][4];
};

struct cloud_splines {
    const struct cloud_pairs *pairs;
    size_t cells[3], splines[3], total;
    size_t many[3]; /* splines along an axis that do not vanish at a point */
    double step[3];
    struct local *local; /* [points] */
    size_t *begin;       /* [total]: column of a row's first number */
    double **row;        /* [total]: where column 0 of a row would stand; the matrix, then its factor */
    double *band;        /* all rows */
    vec4 *small;         /* [total] */
};

void OF_PROCESSOR(cloud_splines_free)(struct cloud_splines **freed)
{
    struct cloud_splines *splines = *freed;
    if (splines == NULL) return;
    array_free(splines->local);
    array_free(splines->begin);
    array_free(splines->row);
    array_free(splines->band);
    array_free(splines->small);
    array_free(splines);
    *freed = NULL;
}

/* Knots: as close as MOST_SPLINES allows, but not closer than two spacings. */
static void choose_knots(struct cloud_splines *splines)
{
    const struct cloud_pairs *pairs = splines->pairs;
    for (double wide = 2;; wide *= 1.1) {
        splines->total = 1;
        for (size_t c = 0; c < 3; c++) {
            const double length = pairs->high[c] - pairs->low[c];
            const bool used = c < pairs->d;
            splines->cells[c] = used ? (size_t)fmax(1, round(length / wide)) : 1;
            splines->step[c] = used ? length / (double)splines->cells[c] : 1;
            splines->splines[c] = used ? splines->cells[c] + 3 : 1;
            splines->many[c] = used ? 4 : 1;
            splines->total *= splines->splines[c];
        }
        if (splines->total <= MOST_SPLINES) return;
    }
}

/* The four cubic B-splines at s in [0, 1] of a cell, and their derivatives by s. */
static void cubic(double s, double value[4], double slope[4])
{
    const double t = 1 - s;
    value[0] = t * t * t / 6;
    value[1] = 2. / 3 - s * s + s * s * s / 2;
    value[2] = 2. / 3 - t * t + t * t * t / 2;
    value[3] = s * s * s / 6;
    slope[0] = -t * t / 2;
    slope[1] = -2 * s + 1.5 * s * s;
    slope[2] = 2 * t - 1.5 * t * t;
    slope[3] = s * s / 2;
}

static void locate(const struct cloud_splines *splines, size_t i, struct local *local)
{
    const struct cloud_pairs *pairs = splines->pairs;
    size_t first[3] = {0};
    for (size_t c = 0; c < 3; c++)
        local->value[c][0] = 1;
    for (size_t c = 0; c < pairs->d; c++) {
        const double s = (pairs->position[3 * i + c] - pairs->low[c]) / splines->step[c];
        first[c] = (size_t)fmin(fmax(floor(s), 0), (double)(splines->cells[c] - 1));
        cubic(s - (double)first[c], local->value[c], local->slope[c]);
        for (size_t k = 0; k < 4; k++)
            local->slope[c][k] *= 0.5 / splines->step[c];
    }
    local->first = first[0] + splines->splines[0] * (first[1] + splines->splines[1] * first[2]);
}

/* Splines that do not vanish at a point: their numbers and, for each, 1 + d numbers (f, grad f / 2). */
static size_t splines_at(const struct cloud_splines *splines, size_t i, size_t index[MOST],
                         double f[MOST][NUMBERS])
{
    const struct local *at = &splines->local[i];
    size_t count = 0;
    for (size_t z = 0; z < splines->many[2]; z++)
        for (size_t y = 0; y < splines->many[1]; y++)
            for (size_t x = 0; x < splines->many[0]; x++) {
                index[count] = at->first + x + splines->splines[0] * (y + splines->splines[1] * z);
                f[count][0] = at->value[0][x] * at->value[1][y] * at->value[2][z];
                f[count][1] = at->slope[0][x] * at->value[1][y] * at->value[2][z];
                f[count][2] = at->value[0][x] * at->slope[1][y] * at->value[2][z];
                f[count][3] = at->value[0][x] * at->value[1][y] * at->slope[2][z];
                count++;
            }
    return count;
}

/* What pair k of row i sees of each spline, in ascending order; returns how many. */
static size_t pair_splines(const struct cloud_splines *splines, size_t i, size_t k, size_t index[2 * MOST],
                           double seen[2 * MOST])
{
    const struct cloud_pairs *pairs = splines->pairs;
    size_t own[2][MOST + 1];
    double part[2][MOST + 1];
    for (int side = 0; side < 2; side++) {
        double f[MOST][NUMBERS];
        const size_t many = splines_at(splines, side == 0 ? i : pairs->index[k], own[side], f);
        for (size_t s = 0; s < many; s++) {
            part[side][s] = side == 0 ? f[s][0] : -f[s][0];
            for (size_t c = 0; c < pairs->d; c++)
                part[side][s] += f[s][c + 1] * pairs->offset[pairs->d * k + c];
        }
        own[side][many] = SIZE_MAX;
        part[side][many] = 0;
    }
    size_t at[2] = {0}, count = 0;
    for (;;) {
        const size_t next[2] = {own[0][at[0]], own[1][at[1]]}, least = next[0] < next[1] ? next[0] : next[1];
        if (least == SIZE_MAX) return count;
        index[count] = least;
        seen[count] = 0;
        for (int side = 0; side < 2; side++)
            if (next[side] == least) seen[count] += part[side][at[side]++];
        count++;
    }
}

/* Is this pair of row i among those that the matrix is made of? */
static bool taken(const struct cloud_pairs *pairs, size_t i, size_t k)
{
    return pairs->index[k] >= i && k % STRIDE == 0;
}

/* Rows of the splines of two points begin no later than at the first of them. */
static void begin_at(struct cloud_splines *splines, size_t i, size_t j)
{
    const size_t first[2] = {splines->local[i].first, splines->local[j].first};
    const size_t least = first[0] < first[1] ? first[0] : first[1];
    for (int side = 0; side < 2; side++)
        for (size_t z = 0; z < splines->many[2]; z++)
            for (size_t y = 0; y < splines->many[1]; y++) {
                size_t *row =
                    splines->begin + first[side] + splines->splines[0] * (y + splines->splines[1] * z);
                for (size_t x = 0; x < splines->many[0]; x++)
                    if (least < row[x]) row[x] = least;
            }
}

/* Where the rows begin, and room for them. */
static bool lay_band(struct cloud_splines *splines)
{
    const struct cloud_pairs *pairs = splines->pairs;
    for (size_t a = 0; a < splines->total; a++)
        splines->begin[a] = a;
    for (size_t i = 0; i < pairs->points; i++)
        for (size_t k = pairs->start[i]; k < pairs->start[i + 1]; k++)
            if (taken(pairs, i, k)) begin_at(splines, i, pairs->index[k]);
    size_t numbers = 0;
    for (size_t a = 0; a < splines->total; a++)
        numbers += a + 1 - splines->begin[a];
    splines->band = array_new(numbers, sizeof *splines->band);
    numbers = 0;
    for (size_t a = 0; splines->band != NULL && a < splines->total; a++) {
        splines->row[a] = splines->band + numbers - splines->begin[a];
        numbers += a + 1 - splines->begin[a];
    }
    return splines->band != NULL;
}

static void add_pairs(struct cloud_splines *splines)
{
    const struct cloud_pairs *pairs = splines->pairs;
    for (size_t i = 0; i < pairs->points; i++)
        for (size_t k = pairs->start[i]; k < pairs->start[i + 1]; k++) {
            size_t index[2 * MOST];
            double seen[2 * MOST];
            if (!taken(pairs, i, k)) continue;
            const size_t count = pair_splines(splines, i, k, index, seen);
            const double weight = STRIDE * pairs->weight[k];
            for (size_t a = 0; a < count; a++) {
                double *row = splines->row[index[a]];
                for (size_t b = 0; b <= a; b++)
                    row[index[b]] += weight * seen[a] * seen[b];
            }
        }
    double largest = 0;
    for (size_t a = 0; a < splines->total; a++)
        largest = fmax(largest, splines->row[a][a]);
    for (size_t a = 0; a < splines->total; a++) /* the quadratic functions are its null space */
        splines->row[a][a] += 1e-9 * largest;
}

/* The sum of n products, GROUP of them in lanes of their own: one order whatever the width. */
static double sum_of_products(size_t n, const double *a, const double *b)
{
    lanes sum[GROUP / LANES] = {0};
    double part[GROUP], total = 0;
    size_t k = 0;
    for (; k + GROUP <= n; k += GROUP)
        for (size_t v = 0; v < GROUP / LANES; v++)
            sum[v] += AT(a + k + LANES * v) * AT(b + k + LANES * v);
    memcpy(part, sum, sizeof part);
    for (; k < n; k++)
        part[0] += a[k] * b[k];
    for (size_t lane = 0; lane < GROUP; lane++)
        total += part[lane];
    return total;
}

/* L of L L^T in the matrix's place; false if it is not positive. */
static bool factorise(size_t total, const size_t *begin, double *const *row)
{
    for (size_t i = 0; i < total; i++) {
        double *const own = row[i];
        for (size_t j = begin[i]; j <= i; j++) {
            const double *const other = row[j];
            const size_t first = begin[i] > begin[j] ? begin[i] : begin[j];
            const double sum = first < j ? sum_of_products(j - first, own + first, other + first) : 0;
            if (j == i && !(own[i] > sum)) return false;
            own[j] = j < i ? (own[j] - sum) / other[j] : sqrt(own[i] - sum);
        }
    }
    return true;
}

selas_status OF_PROCESSOR(cloud_splines_create)(const struct cloud_pairs *pairs,
                                                struct cloud_splines **created, struct messages *messages)
{
    *created = NULL;
    struct cloud_splines *splines = array_new(1, sizeof *splines);
    if (splines == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the pair correction");
    splines->pairs = pairs;
    choose_knots(splines);
    splines->local = array_new(pairs->points, sizeof *splines->local);
    splines->begin = array_new(splines->total, sizeof *splines->begin);
    splines->row = array_new(splines->total, sizeof *splines->row);
    splines->small = array_new(splines->total, sizeof *splines->small);
    bool room =
        splines->local != NULL && splines->begin != NULL && splines->row != NULL && splines->small != NULL;
    for (size_t i = 0; room && i < pairs->points; i++)
        locate(splines, i, &splines->local[i]);
    room = room && lay_band(splines);
    selas_status status = SELAS_OK;
    if (!room) status = fail(messages, SELAS_NO_MEMORY, "no memory for the pair correction");
    if (room) {
        add_pairs(splines);
        if (!factorise(splines->total, splines->begin, splines->row))
            status = fail(messages, SELAS_BAD_SCENE, "the points are too uneven for the cloud method");
    }
    if (status != SELAS_OK) OF_PROCESSOR(cloud_splines_free)(&splines);
    *created = splines;
    return status;
}

/* x := (L L^T)^-1 x. */
static void solve(size_t total, const size_t *begin, double *const *row, vec4 *x)
{
    for (size_t i = 0; i < total; i++) {
        const double *own = row[i];
        vec4 sum[4] = {0}; /* that the processor need not wait for one */
        size_t j = begin[i];
        for (; j + 4 <= i; j += 4)
            for (size_t k = 0; k < 4; k++)
                sum[k] += own[j + k] * x[j + k];
        for (; j < i; j++)
            sum[0] += own[j] * x[j];
        x[i] = (x[i] - ((sum[0] + sum[1]) + (sum[2] + sum[3]))) / own[i];
    }
    for (size_t i = total; i-- > 0;) {
        const double *own = row[i];
        const vec4 known = x[i] / own[i];
        x[i] = known;
        for (size_t j = begin[i]; j < i; j++)
            x[j] -= own[j] * known;
    }
}

/* c += P^T r: the splines are products, summed axis by axis. */
static void take(const struct cloud_splines *splines, const vec4 *r, vec4 *c)
{
    const size_t numbers = splines->pairs->d + 1;
    for (size_t i = 0; i < splines->pairs->points; i++) {
        const struct local *at = &splines->local[i];
        const vec4 *own = r + numbers * i;
        for (size_t z = 0; z < splines->many[2]; z++)
            for (size_t y = 0; y < splines->many[1]; y++) {
                vec4 *row = c + at->first + splines->splines[0] * (y + splines->splines[1] * z);
                const double both = at->value[1][y] * at->value[2][z];
                const vec4 along = own[1] * both;
                vec4 plain = own[0] * both;
                if (numbers > 2) plain += own[2] * (at->slope[1][y] * at->value[2][z]);
                if (numbers > 3) plain += own[3] * (at->value[1][y] * at->slope[2][z]);
                for (size_t x = 0; x < 4; x++)
                    row[x] += at->value[0][x] * plain + at->slope[0][x] * along;
            }
    }
}

/* r += P c. */
static void give(const struct cloud_splines *splines, const vec4 *c, vec4 *r)
{
    const size_t numbers = splines->pairs->d + 1;
    for (size_t i = 0; i < splines->pairs->points; i++) {
        const struct local *at = &splines->local[i];
        vec4 *own = r + numbers * i;
        for (size_t z = 0; z < splines->many[2]; z++)
            for (size_t y = 0; y < splines->many[1]; y++) {
                const vec4 *row = c + at->first + splines->splines[0] * (y + splines->splines[1] * z);
                vec4 plain = {0}, along = {0};
                for (size_t x = 0; x < 4; x++) {
                    plain += at->value[0][x] * row[x];
                    along += at->slope[0][x] * row[x];
                }
                own[0] += at->value[1][y] * at->value[2][z] * plain;
                own[1] += at->value[1][y] * at->value[2][z] * along;
                if (numbers > 2) own[2] += at->slope[1][y] * at->value[2][z] * plain;
                if (numbers > 3) own[3] += at->value[1][y] * at->slope[2][z] * plain;
            }
    }
}

void OF_PROCESSOR(cloud_splines_add)(struct cloud_splines *splines, const vec4 *r, vec4 *z)
{
    memset(splines->small, 0, splines->total * sizeof *splines->small);
    take(splines, r, splines->small);
    solve(splines->total, splines->begin, splines->row, splines->small);
    give(splines, splines->small, z);
}
