/* The loops of sweep.h over rows for numbers of type REAL; included by kernels_sweep_double.c and
 * kernels_sweep_single.c.
 *
 * Values and slopes go without their factors: u(K) = u0 + u1, slope u1 - u0; u(M) = u0 + 6 u1 + u2, slope u2 - u0;
 * the product of those of x and y is factor[] of a row, that of depth is in its weights. */
#include "base/machine.h"
#include "method/consistent/general/sweep.h"

#include <string.h>

typedef REAL lanes __attribute__((vector_size(VECTOR_BYTES), aligned(sizeof(REAL)), may_alias));
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

/* Along y, of a component: value and slope of the values over depth, value of the slopes. */
INLINED void along_y(const bool knots, size_t width, const REAL *const *value, const REAL *const *slope,
                     REAL *restrict a, REAL *restrict b, REAL *restrict c)
{
    const REAL *restrict v0 = value[0], *restrict v1 = value[1], *restrict v2 = value[2];
    const REAL *restrict s0 = slope[0], *restrict s1 = slope[1], *restrict s2 = slope[2];
    for (size_t i = 0; i < width; i += LANES)
        if (knots) {
            put(a + i, at(v0 + i) + at(v1 + i));
            put(b + i, at(v1 + i) - at(v0 + i));
            put(c + i, at(s0 + i) + at(s1 + i));
        } else {
            const lanes low = at(v0 + i), high = at(v2 + i);
            put(a + i, 6 * at(v1 + i) + (low + high));
            put(b + i, high - low);
            put(c + i, 6 * at(s1 + i) + (at(s0 + i) + at(s2 + i)));
        }
}

INLINED lanes value_of(const bool knots, const REAL *row)
{
    return knots ? at(row) + at(row + 1) : 6 * at(row + 1) + (at(row) + at(row + 2));
}

INLINED lanes slope_of(const bool knots, const REAL *row)
{
    return knots ? at(row + 1) - at(row) : at(row + 2) - at(row);
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

enum { XX, YY, ZZ, YZ, ZX, XY, DEPTH_X, DEPTH_Y, DEPTH_Z };

/* A slope along x, or along another slot, where `row` is its row of the scratch; `made`: it is there already. */
INLINED lanes strain_x(const bool knots, const bool made, REAL factor, const REAL *row)
{
    if (made) return at(row);
    return factor * slope_of(knots, row);
}

INLINED lanes strain_of(const bool knots, const bool made, REAL factor, const REAL *row)
{
    if (made) return at(row);
    return factor * value_of(knots, row);
}

INLINED void level_stresses(const bool knots, const bool made, const struct NAME(sweep_row) * row,
                            const REAL *in, REAL *out)
{
    const size_t stride = row->stride, width = row->width;
    const REAL x = row->factor[0], y = row->factor[1], z = row->factor[2], *lambda = row->lambda,
               *shear = row->mu;
#define AT(component, slot) (in + (3 * (component) + (slot)) * stride + i)
    for (size_t i = 0; i < width; i += LANES) {
        const lanes exx = strain_x(knots, made, x, AT(0, 0)), eyy = strain_of(knots, made, y, AT(1, 1)),
                    ezz = strain_of(knots, made, z, AT(2, 2)), mu = at(shear + i), twice = mu + mu,
                    pressure = at(lambda + i) * (exx + eyy + ezz);
        put(out + XX * stride + i, pressure + twice * exx);
        put(out + YY * stride + i, pressure + twice * eyy);
        put(out + ZZ * stride + i, pressure + twice * ezz);
        put(out + YZ * stride + i,
            mu * (strain_of(knots, made, z, AT(1, 2)) + strain_of(knots, made, y, AT(2, 1))));
        put(out + ZX * stride + i,
            mu * (strain_of(knots, made, z, AT(0, 2)) + strain_x(knots, made, x, AT(2, 0))));
        put(out + XY * stride + i,
            mu * (strain_of(knots, made, y, AT(0, 1)) + strain_x(knots, made, x, AT(1, 0))));
    }
}

/* Below a surface that is not level: slopes along the axes (G17), and what pulls along the lattice's depth. */
INLINED void tilted_stresses(const bool knots, const bool made, const struct NAME(sweep_row) * row,
                             const REAL *in, REAL *out)
{
    const struct NAME(sweep_hill) hill = *row->hill;
    const size_t stride = row->stride, width = row->width;
    const REAL factor[3] = {row->factor[0], row->factor[1], row->factor[2]}, *lambda = row->lambda,
               *shear = row->mu;
    for (size_t i = 0; i < width; i += LANES) {
        const lanes up = 1 / (1 + hill.fall * at(hill.drop + i)),
                    one = hill.share * at(hill.slope[0] + i) * up,
                    two = hill.share * at(hill.slope[1] + i) * up;
        lanes x[3], y[3], z[3];
        UNROLLED for (size_t c = 0; c < 3; c++)
        {
            const lanes down = strain_of(knots, made, factor[2], AT(c, 2));
            x[c] = strain_x(knots, made, factor[0], AT(c, 0)) - one * down;
            y[c] = strain_of(knots, made, factor[1], AT(c, 1)) - two * down;
            z[c] = up * down;
        }
        const lanes mu = at(shear + i), twice = mu + mu, pressure = at(lambda + i) * (x[0] + y[1] + z[2]);
        const lanes xx = pressure + twice * x[0], yy = pressure + twice * y[1], zz = pressure + twice * z[2];
        const lanes yz = mu * (z[1] + y[2]), zx = mu * (z[0] + x[2]), xy = mu * (y[0] + x[1]);
        put(out + XX * stride + i, xx);
        put(out + YY * stride + i, yy);
        put(out + YZ * stride + i, yz);
        put(out + ZX * stride + i, zx);
        put(out + XY * stride + i, xy);
        put(out + DEPTH_X * stride + i, up * zx - one * xx - two * xy);
        put(out + DEPTH_Y * stride + i, up * yz - one * xy - two * yy);
        put(out + DEPTH_Z * stride + i, up * zz - one * zx - two * yz);
    }
#undef AT
}

#define VALUE_AT(row) (knots ? (row)[i] + (row)[i + 1] : 6 * (row)[i + 1] + ((row)[i] + (row)[i + 2]))
#define SLOPE_AT(row) (knots ? (row)[i + 1] - (row)[i] : (row)[i + 2] - (row)[i])

/* The same at points that are not isotropic. */
INLINED void other_stresses(const bool knots, const bool made, const struct NAME(sweep_row) * row,
                            const REAL *in, REAL *out)
{
    const struct NAME(sweep_hill) *hill = row->hill;
    const size_t stride = row->stride;
    for (size_t r = 0; r < row->runs; r++)
        for (size_t m = 0; m < row->run[r].count; m++) {
            const size_t i = row->run[r].from + m;
            const double *law = row->stiffness + row->run[r].at + m;
            const REAL up = hill == NULL ? 1 : 1 / (1 + hill->fall * hill->drop[i]),
                       one = hill == NULL ? 0 : hill->share * hill->slope[0][i] * up,
                       two = hill == NULL ? 0 : hill->share * hill->slope[1][i] * up;
            REAL x[3], y[3], z[3], stress[STRESSES] = {0};
            for (size_t c = 0; c < 3; c++) {
                const REAL *along = in + 3 * c * stride, *across = along + stride, *deep = across + stride;
                const REAL down = made ? deep[i] : row->factor[2] * VALUE_AT(deep);
                x[c] = (made ? along[i] : row->factor[0] * SLOPE_AT(along)) - one * down;
                y[c] = (made ? across[i] : row->factor[1] * VALUE_AT(across)) - two * down;
                z[c] = up * down;
            }
            const REAL strain[STRESSES] = {x[0], y[1], z[2], y[2] + z[1], z[0] + x[2], x[1] + y[0]};
            int entry = 0;
            for (int p = 0; p < STRESSES; p++)
                for (int q = p; q < STRESSES; q++, entry++) {
                    const REAL modulus = (REAL)law[(size_t)entry * row->run[r].count];
                    stress[p] += modulus * strain[q];
                    if (p != q) stress[q] += modulus * strain[p];
                }
            for (size_t p = 0; p < STRESSES; p++)
                out[p * stride + i] = stress[p];
            out[DEPTH_X * stride + i] = up * stress[ZX] - one * stress[XX] - two * stress[XY];
            out[DEPTH_Y * stride + i] = up * stress[YZ] - one * stress[XY] - two * stress[YY];
            out[DEPTH_Z * stride + i] = up * stress[ZZ] - one * stress[ZX] - two * stress[YZ];
        }
}

/* Back along x, then along y: what stresses x, y, z of a component pull at; `apart`: those of y go into rows of their
 * own. */
INLINED void pulls_back(const bool x_knots, const bool y_knots, const bool apart,
                        const struct NAME(sweep_row) * row, int component, const REAL *restrict x,
                        const REAL *restrict y, const REAL *restrict z)
{
    REAL *const *across = row->across_pull[component];
    REAL *const *pull = row->pull[component], *const *slope = row->slope_pull[component];
    REAL *restrict p0 = pull[0], *restrict p1 = pull[1], *restrict p2 = pull[2];
    REAL *restrict s0 = slope[0], *restrict s1 = slope[1], *restrict s2 = slope[2];
    const REAL factor[3] = {row->factor[0], row->factor[1], row->factor[2]};
    const size_t width = row->width;
    for (size_t i = 0; i < width; i += LANES) {
        const lanes one = factor[0] * slope_pull(x_knots, x + i),
                    two = factor[1] * value_pull(x_knots, y + i),
                    three = factor[2] * value_pull(x_knots, z + i);
        lanes both = one, less = one;
        if (!apart) {
            both += two;
            less -= two;
        }
        put(p0 + i, at(p0 + i) + less);
        put(s0 + i, at(s0 + i) + three);
        if (y_knots) {
            put(p1 + i, at(p1 + i) + both);
            put(s1 + i, at(s1 + i) + three);
        } else {
            put(p1 + i, at(p1 + i) + 6 * one);
            put(s1 + i, at(s1 + i) + 6 * three);
            put(p2 + i, both);
            put(s2 + i, three);
        }
        if (!apart) continue;
        put(across[0] + i, at(across[0] + i) - two);
        if (y_knots)
            put(across[1] + i, at(across[1] + i) + two);
        else
            put(across[2] + i, two);
    }
}

INLINED void slopes_of(const bool x_knots, const bool y_knots, const struct NAME(sweep_row) * row)
{
    const size_t stride = row->stride, width = row->width;
    for (int c = 0; c < 3; c++) {
        REAL *x = row->scratch + (size_t)(3 * c) * stride, *y = x + stride, *z = y + stride;
        along_y(y_knots, width, row->value[c], row->slope[c], x, y, z);
        for (size_t i = 0; i < width; i += LANES) {
            put(x + i, row->factor[0] * slope_of(x_knots, x + i));
            put(y + i, row->factor[1] * value_of(x_knots, y + i));
            put(z + i, row->factor[2] * value_of(x_knots, z + i));
        }
    }
}

/* made: the slopes are there, and pulls are kept apart. */
INLINED void points_of(const bool x_knots, const bool y_knots, const bool made,
                       const struct NAME(sweep_row) * row)
{
    static const int level[3][3] = {{XX, XY, ZX}, {XY, YY, YZ}, {ZX, YZ, ZZ}};
    const size_t stride = row->stride;
    REAL *in = row->scratch, *out = in + 9 * stride;
    for (int c = 0; c < 3 && !made; c++) {
        REAL *rows = in + (size_t)(3 * c) * stride;
        along_y(y_knots, row->width, row->value[c], row->slope[c], rows, rows + stride, rows + 2 * stride);
    }
    if (row->hill != NULL)
        tilted_stresses(x_knots, made, row, in, out);
    else
        level_stresses(x_knots, made, row, in, out);
    if (row->runs > 0) other_stresses(x_knots, made, row, in, out);
    for (int c = 0; c < 3; c++) {
        const int along = row->hill != NULL ? DEPTH_X + c : level[c][2];
        pulls_back(x_knots, y_knots, made, row, c, out + (size_t)level[c][0] * stride,
                   out + (size_t)level[c][1] * stride, out + (size_t)along * stride);
    }
}

static void points(const struct NAME(sweep_row) * row)
{
    if (row->x_knots)
        points_of(true, false, false, row);
    else if (row->y_knots)
        points_of(false, true, false, row);
    else
        points_of(false, false, false, row);
}

static void slopes(const struct NAME(sweep_row) * row)
{
    if (row->x_knots)
        slopes_of(true, false, row);
    else if (row->y_knots)
        slopes_of(false, true, row);
    else
        slopes_of(false, false, row);
}

static void stresses(const struct NAME(sweep_row) * row)
{
    if (row->x_knots)
        points_of(true, false, true, row);
    else if (row->y_knots)
        points_of(false, true, true, row);
    else
        points_of(false, false, true, row);
}

INLINED void pulls_of(const bool apart, size_t width, const REAL *const in[PULL_FIELDS],
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
        pulls_of(true, width, in, weight, out);
    else
        pulls_of(false, width, in, weight, out);
}

#include "method/consistent/general/sweep_memory_over.h"

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
    bring, depth, points, slopes, stresses, pulls, recall, remember, pull, keep, scale, finish};
