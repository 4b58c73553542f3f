/* The loops of sweep.h over rows for numbers of type REAL; included by kernels_sweep_double.c and
 * kernels_sweep_single.c.
 *
 * Values and slopes go without their factors: u(K) = u0 + u1, slope u1 - u0; u(M) = u0 + 6 u1 + u2, slope u2 - u0;
 * the product of those of x and y is factor[] of a row, that of depth is in its weights. */
#include "base/machine.h"
#include "method/consistent/general/sweep.h"

#include <string.h>

typedef REAL lanes __attribute__((vector_size(VECTOR_BYTES), aligned(sizeof(REAL)), may_alias));
typedef NUMBER lanes_number __attribute__((vector_size(VECTOR_BYTES)));
enum { LANES = VECTOR_BYTES / sizeof(REAL) };

#define UNROLLED _Pragma("GCC unroll 32")

#if defined(__GNUC__)
#define FETCH(place) __builtin_prefetch(place, 0, 2)
#else
#define FETCH(place) (void)(place)
#endif

INLINED lanes at(const REAL *place)
{
    return *(const lanes *)place;
}

INLINED void put(REAL *place, lanes value)
{
    *(lanes *)place = value;
}

/* `more`: beside what is there. */
INLINED void put_or_add(const bool more, REAL *place, lanes value)
{
    if (more) value += at(place);
    put(place, value);
}

static void depth(size_t n, const REAL *const in[SPAN], const REAL weight[DEPTH_FIELDS][SPAN],
                  REAL *const out[DEPTH_FIELDS])
{
    REAL w[DEPTH_FIELDS][SPAN], *to[DEPTH_FIELDS];
    memcpy(w, weight, sizeof w);
    memcpy(to, out, sizeof to);
    const REAL *const from[SPAN] = {in[0], in[1], in[2]};
    for (size_t i = 0;; i += LANES) {
        if (i + LANES > n) i = n - LANES;
        const lanes a = at(from[0] + i), b = at(from[1] + i), c = at(from[2] + i);
        UNROLLED for (int q = 0; q < DEPTH_FIELDS; q++)
            put(to[q] + i, w[q][0] * a + w[q][1] * b + w[q][2] * c);
        if (i + LANES >= n) break;
    }
}

/* Without their factors, of three numbers one after the other along an axis (of two at knots). */
INLINED lanes value_across(const bool knots, const REAL *one, const REAL *two, const REAL *three)
{
    return knots ? at(one) + at(two) : 6 * at(two) + (at(one) + at(three));
}

INLINED lanes slope_across(const bool knots, const REAL *one, const REAL *two, const REAL *three)
{
    return at(knots ? two : three) - at(one);
}

/* Along y from number i on, of a component: value and slope of the values over depth, value of the slopes. */
INLINED void group_along_y(const bool knots, const struct NAME(sweep_row) * row, int component, size_t i,
                           lanes out[3])
{
    const size_t place = (size_t)(component * DEPTH_FIELDS + row->field) * row->stride + i,
                 deep = place + row->stride;
    out[0] = value_across(knots, row->in[0] + place, row->in[1] + place, row->in[2] + place);
    out[1] = slope_across(knots, row->in[0] + place, row->in[1] + place, row->in[2] + place);
    out[2] = value_across(knots, row->in[0] + deep, row->in[1] + deep, row->in[2] + deep);
}

INLINED void along_y(const bool knots, const struct NAME(sweep_row) * row, int component, REAL *restrict out)
{
    for (size_t i = 0; i < row->width; i += LANES) {
        lanes group[3];
        group_along_y(knots, row, component, i, group);
        UNROLLED for (size_t n = 0; n < 3; n++) put(out + n * row->stride + i, group[n]);
    }
}

/* One of them in some columns, of the field given: its slope or value. */
INLINED void one_along_y(const bool knots, const bool slope, const struct NAME(sweep_row) * row,
                         int component, int field, size_t from, size_t end, REAL *restrict out)
{
    const size_t place = (size_t)(component * DEPTH_FIELDS + field) * row->stride;
    const REAL *restrict v0 = row->in[0] + place, *restrict v1 = row->in[1] + place,
                         *restrict v2 = row->in[2] + place;
    for (size_t i = from; i < end; i += LANES)
        put(out + i, slope ? slope_across(knots, v0 + i, v1 + i, v2 + i)
                           : value_across(knots, v0 + i, v1 + i, v2 + i));
}

INLINED lanes value_of(const bool knots, const REAL *row)
{
    return value_across(knots, row, row + 1, row + 2);
}

INLINED lanes slope_of(const bool knots, const REAL *row)
{
    return slope_across(knots, row, row + 1, row + 2);
}

/* Their transposes. */
INLINED lanes value_pull(const bool knots, const REAL *row)
{
    return knots ? at(row - 1) + at(row) : 6 * at(row - 1) + (at(row - 2) + at(row));
}

INLINED lanes slope_pull(const bool knots, const REAL *row)
{
    return knots ? at(row - 1) - at(row) : at(row - 2) - at(row);
}

#include "method/consistent/general/sweep_points_over.h"

INLINED void pulls_taken(const bool apart, size_t width, const REAL *const in[PULL_FIELDS],
                         const REAL weight[DEPTH_FIELDS][SPAN], REAL *const out[SPAN])
{
    REAL w[DEPTH_FIELDS][SPAN], *to[SPAN];
    memcpy(w, weight, sizeof w);
    memcpy(to, out, sizeof to);
    const REAL *const from[PULL_FIELDS] = {in[0], in[1], in[2], in[3], in[4], in[5]};
    for (size_t i = 0; i < width; i += LANES) {
        lanes a = at(from[0] + i), c = at(from[2] + i);
        const lanes b = at(from[1] + i), d = at(from[3] + i);
        if (apart) {
            a += at(from[4] + i);
            c += at(from[5] + i);
        }
        UNROLLED for (int s = 0; s < SPAN; s++)
            put(to[s] + i, at(to[s] + i) - w[0][s] * a - w[1][s] * b - w[2][s] * c - w[3][s] * d);
    }
}

static void pulls(bool apart, size_t width, const REAL *const in[PULL_FIELDS],
                  const REAL weight[DEPTH_FIELDS][SPAN], REAL *const out[SPAN])
{
    if (apart)
        pulls_taken(true, width, in, weight, out);
    else
        pulls_taken(false, width, in, weight, out);
}

#include "method/consistent/general/sweep_memory_over.h"

typedef double edge_lanes __attribute__((vector_size(EDGE_LANES * 8), aligned(8), may_alias));
typedef REAL edge_numbers
    __attribute__((vector_size(EDGE_LANES * sizeof(REAL)), aligned(sizeof(REAL)), may_alias));

static void edge_slopes(const struct edge_taps *of, const double *slope, const size_t n[3], const REAL *u,
                        double sum[3])
{
    edge_lanes x = {0}, y = {0}, z = {0};
    for (size_t k = of->plane; k < of->plane + of->planes; k++)
        for (size_t j = of->row; j < of->row + of->rows; j++, slope += EDGE_ROW) {
            const REAL *row = u + (k * n[1] + j) * n[0] + of->column;
            const edge_lanes value = __builtin_convertvector(*(const edge_numbers *)row, edge_lanes),
                             *of_slot = (const edge_lanes *)slope;
            x += of_slot[0] * value;
            y += of_slot[1] * value;
            z += of_slot[2] * value;
        }
    sum[0] = (x[0] + x[2]) + (x[1] + x[3]);
    sum[1] = (y[0] + y[2]) + (y[1] + y[3]);
    sum[2] = (z[0] + z[2]) + (z[1] + z[3]);
}

static void edge_pulls(const struct edge_taps *of, const double *slope, const double pull[3], size_t stride,
                       REAL *force)
{
    const double a = pull[0], b = pull[1], c = pull[2];
    for (size_t j = of->row; j < of->row + of->rows; j++, slope += EDGE_ROW) {
        const edge_lanes *const of_slot = (const edge_lanes *)slope;
        edge_numbers *to = (edge_numbers *)(force + j * stride + of->column);
        *to -= __builtin_convertvector(a * of_slot[0] + b * of_slot[1] + c * of_slot[2], edge_numbers);
    }
}

INLINED void finished(const int planes, size_t n, const REAL *weight, const REAL *const *in, size_t ahead,
                      REAL factor, const REAL *const *root, REAL *const *out)
{
    for (size_t i = 0; i < n; i += LANES) {
        lanes sum[SWEEP_PLANES] = {0};
        UNROLLED for (int t = 0; t < SWEEP_TAPS + planes - 1; t++)
        {
            const lanes value = at(in[t] + i);
            FETCH(in[t] + i + ahead);
            UNROLLED for (int p = 0; p < planes; p++) if (t >= p && t - p < SWEEP_TAPS) sum[p] +=
                weight[p * SWEEP_TAPS + t - p] * value;
        }
        if (i + LANES <= n) {
            UNROLLED for (int p = 0; p < planes; p++)
                put(out[p] + i, at(out[p] + i) + factor * at(root[p] + i) * sum[p]);
            continue;
        }
        for (int p = 0; p < planes; p++)
            for (size_t lane = 0; i + lane < n; lane++)
                out[p][i + lane] += factor * root[p][i + lane] * sum[p][lane];
    }
}

static void finish(size_t n, size_t planes, const REAL *weight, const REAL *const *in, size_t ahead,
                   REAL factor, const REAL *const *root, REAL *const *out)
{
    if (planes == SWEEP_PLANES) {
        finished(SWEEP_PLANES, n, weight, in, ahead, factor, root, out);
        return;
    }
    for (size_t p = 0; p < planes; p++)
        finished(1, n, weight + p * SWEEP_TAPS, in + p, ahead, factor, root + p, out + p);
}

static REAL bring(size_t n, REAL dt, const REAL *restrict w, REAL *restrict u)
{
    REAL most = 0;
#pragma omp simd reduction(max : most)
    for (size_t i = 0; i < n; i++) {
        const REAL value = u[i] + dt * w[i], size = value < 0 ? -value : value;
        u[i] = value;
        most = size > most ? size : most;
    }
    return most;
}

static void scale(size_t n, const REAL *restrict factor, const REAL *restrict in, REAL *restrict out)
{
#pragma omp simd
    for (size_t i = 0; i < n; i++)
        out[i] = factor[i] * in[i];
}

const struct NAME(sweep_kernels) OF_PROCESSOR(NAME(sweep_kernels)) = {
    bring,  depth,    points, slopes, stresses, slope,       stresses_of, pulls_of, pulls,
    recall, remember, pull,   keep,   scale,    edge_slopes, edge_pulls,  finish};
