/* Loops over a row of points of the general operator: slopes of u, stresses, and what they pull at
 * (doc/theory/general-ground.md, G1 to G3). */
#include "method/consistent/general/points.h"

#include "base/machine.h"

#include <string.h>

/* Along y: values, slopes and values of slopes over depth of a component at a row of points. */
INLINED void across(const int count, const struct taps *t, double scale, const double *restrict value,
                    const double *restrict slope, size_t pitch, size_t n, double *restrict a,
                    double *restrict b, double *restrict c)
{
#pragma omp simd
    for (size_t i = 0; i < n; i++) {
        double one = 0, two = 0, three = 0;
        for (int d = 0; d < count; d++) {
            const double here = value[(size_t)d * pitch + i];
            one += t->value[d] * here;
            two += t->slope[d] * here;
            three += t->value[d] * slope[(size_t)d * pitch + i];
        }
        a[i] = scale * one;
        b[i] = two;
        c[i] = three;
    }
}

/* Values and slopes (times the spacing) along x at point i of a row. */
#define VALUE(row)                                                                                           \
    (knots ? .5 * ((row)[i] + (row)[i + 1]) : .125 * ((row)[i] + 6 * (row)[i + 1] + (row)[i + 2]))
#define SLOPE(row) (knots ? (row)[i + 1] - (row)[i] : .5 * ((row)[i + 2] - (row)[i]))

/* Rows of the component of slot s in the scratch: a = slope along x to be, b along y, c along depth. */
#define ROWS(s)                                                                                              \
    const double *restrict a##s = in + (3 * (s)) * pitch, *restrict b##s = in + (3 * (s) + 1) * pitch,       \
                           *restrict c##s = in + (3 * (s) + 2) * pitch;
/* xx yy zz yz zx xy */
#define STRESS_ROWS                                                                                          \
    double *restrict xx = out, *restrict yy = out + pitch, *restrict zz = out + 2 * pitch,                   \
                     *restrict yz = out + 3 * pitch, *restrict zx = out + 4 * pitch,                         \
                     *restrict xy = out + 5 * pitch;

INLINED void isotropic(const bool knots, size_t n, size_t pitch, const double *in,
                       const double *restrict lambda, const double *restrict mu, double *out)
{
    ROWS(0)
    ROWS(1)
    ROWS(2)
    STRESS_ROWS
#pragma omp simd
    for (size_t i = 0; i < n; i++) {
        const double exx = SLOPE(a0), eyy = VALUE(b1), ezz = VALUE(c2), twice = 2 * mu[i];
        const double pressure = lambda[i] * (exx + eyy + ezz);
        xx[i] = pressure + twice * exx;
        yy[i] = pressure + twice * eyy;
        zz[i] = pressure + twice * ezz;
        yz[i] = mu[i] * (VALUE(c1) + VALUE(b2));
        zx[i] = mu[i] * (VALUE(c0) + SLOPE(a2));
        xy[i] = mu[i] * (VALUE(b0) + SLOPE(a1));
    }
}

INLINED void isotropic_flat(const bool knots, size_t n, size_t pitch, const double *in,
                            const double *restrict lambda, const double *restrict mu, double *out)
{
    ROWS(0) ROWS(2) double *restrict xx = out, *restrict zz = out + 2 * pitch, *restrict zx = out + 4 * pitch;
    (void)b0;
    (void)b2;
#pragma omp simd
    for (size_t i = 0; i < n; i++) {
        const double exx = SLOPE(a0), ezz = VALUE(c2), twice = 2 * mu[i];
        const double pressure = lambda[i] * (exx + ezz);
        xx[i] = pressure + twice * exx;
        zz[i] = pressure + twice * ezz;
        zx[i] = mu[i] * (VALUE(c0) + SLOPE(a2));
    }
}

/* Stresses of point m of a run. */
INLINED void law_of(const struct run_of_points *run, size_t m, const double *restrict law,
                    const double *strain, size_t pitch, double *out)
{
    double stress[STRESSES] = {0};
    int at = 0;
    for (int p = 0; p < STRESSES; p++)
        for (int q = p; q < STRESSES; q++, at++) {
            const double modulus = law[(size_t)at * run->count + m];
            stress[p] += modulus * strain[q];
            if (p != q) stress[q] += modulus * strain[p];
        }
    for (int p = 0; p < STRESSES; p++)
        out[(size_t)p * pitch] = stress[p];
}

/* Stresses of a run of points that are not isotropic. */
INLINED void run_stresses(const bool flat, const bool knots, const struct run_of_points *run, size_t pitch,
                          const double *in, const double *stiffness, double *out)
{
    ROWS(0) ROWS(1) ROWS(2) const double *restrict law = stiffness + run->at;
    for (size_t m = 0; m < run->count; m++) {
        const size_t i = run->from + m;
        const double strain[STRESSES] = {SLOPE(a0),
                                         flat ? 0 : VALUE(b1),
                                         VALUE(c2),
                                         flat ? 0 : VALUE(c1) + VALUE(b2),
                                         VALUE(c0) + SLOPE(a2),
                                         flat ? 0 : VALUE(b0) + SLOPE(a1)};
        law_of(run, m, law, strain, pitch, out + i);
    }
}

/* Transposes of VALUE and SLOPE: what points pull at number i of a row; the stresses are 0 beyond both ends. */
#define PULL_VALUE(row)                                                                                      \
    (knots ? .5 * ((row)[(ptrdiff_t)i - 1] + (row)[i])                                                       \
           : .125 * ((row)[(ptrdiff_t)i - 2] + 6 * (row)[(ptrdiff_t)i - 1] + (row)[i]))
#define PULL_SLOPE(row)                                                                                      \
    (knots ? (row)[(ptrdiff_t)i - 1] - (row)[i] : .5 * ((row)[(ptrdiff_t)i - 2] - (row)[i]))

/* Transpose of across(), of a component with the stresses along x, y and depth; `apart`: those of y go elsewhere. */
INLINED void pull(const int count, const bool apart, const bool knots, const struct taps *t, double scale,
                  size_t n, size_t pitch, const double *restrict x, const double *restrict y,
                  const double *restrict z, double *restrict value, double *restrict elsewhere,
                  double *restrict slope)
{
#pragma omp simd
    for (size_t i = 0; i < n; i++) {
        const double one = scale * PULL_SLOPE(x), two = PULL_VALUE(y), three = PULL_VALUE(z);
        for (int d = 0; d < count; d++) {
            value[(size_t)d * pitch + i] += apart ? t->value[d] * one : t->value[d] * one + t->slope[d] * two;
            /* cppcheck-suppress nullPointer ; only where apart */
            if (apart) elsewhere[(size_t)d * pitch + i] += t->slope[d] * two;
            slope[(size_t)d * pitch + i] += t->value[d] * three;
        }
    }
}

#define BY_COUNT(call)                                                                                       \
    switch (t->count) {                                                                                      \
    case 1:                                                                                                  \
        call(1);                                                                                             \
        break;                                                                                               \
    case 2:                                                                                                  \
        call(2);                                                                                             \
        break;                                                                                               \
    default:                                                                                                 \
        call(3);                                                                                             \
    }

INLINED void row_of(const bool flat, const bool knots, const struct point_plane *plane, size_t j,
                    const double *lambda, const double *mu, const struct run_of_points *run, size_t runs,
                    const double *stiffness)
{
    /* rows of the stresses of a component: along x, y, depth */
    static const int place[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};
    const size_t pitch = plane->pitch, width = plane->cells + 2, points = plane->cells + (knots ? 1 : 0);
    double *in = plane->scratch + ROW_ROOM, *out = in + 9 * pitch;
    for (int s = 0; s < 3; s += flat ? 2 : 1) {
        const struct taps *t = &plane->y[s == 1][j];
        const size_t from = t->first * pitch + ROW_ROOM;
        double *rows = in + (size_t)(3 * s) * pitch;
#define ACROSS(count)                                                                                        \
    across(count, t, plane->scale, plane->value[s] + from, plane->slope[s] + from, pitch, width, rows,       \
           rows + pitch, rows + 2 * pitch)
        BY_COUNT(ACROSS)
    }
    if (flat)
        isotropic_flat(knots, points, pitch, in, lambda, mu, out);
    else
        isotropic(knots, points, pitch, in, lambda, mu, out);
    for (size_t r = 0; r < runs; r++)
        run_stresses(flat, knots, &run[r], pitch, in, stiffness, out);
    for (int p = 0; p < STRESSES; p++) /* of a row of knots before this one */
        for (size_t i = points; i < width; i++)
            out[(size_t)p * pitch + i] = 0;
    for (int s = 0; s < 3; s += flat ? 2 : 1) {
        const struct taps *t = &plane->y[s == 1][j];
        const size_t from = t->first * pitch + ROW_ROOM;
#define PULL(count)                                                                                          \
    pull(count, false, knots, t, plane->scale, width, pitch, out + (size_t)place[s][0] * pitch,              \
         out + (size_t)place[s][1] * pitch, out + (size_t)place[s][2] * pitch, plane->pull_value[s] + from,  \
         NULL, plane->pull_slope[s] + from)
        BY_COUNT(PULL)
    }
}

/* Slopes along x, y and depth of points from .. end - 1. */
INLINED void slopes_of(const bool flat, const bool knots, const struct point_plane *plane, size_t j,
                       size_t first, size_t end)
{
    const size_t pitch = plane->pitch, width = end - first + 2;
    double *in = plane->scratch + ROW_ROOM + first;
    for (int s = 0; s < 3; s += flat ? 2 : 1) {
        const struct taps *t = &plane->y[s == 1][j];
        const size_t from = t->first * pitch + ROW_ROOM + first;
        double *rows = in + (size_t)(3 * s) * pitch;
        BY_COUNT(ACROSS)
        const double *restrict a = rows, *restrict b = rows + pitch, *restrict c = rows + 2 * pitch;
        double *restrict x = slope_row(plane, s, 0) + first, *restrict y = slope_row(plane, s, 1) + first;
        double *restrict z = slope_row(plane, s, 2) + first;
#pragma omp simd
        for (size_t i = 0; i < end - first; i++) {
            x[i] = SLOPE(a);
            y[i] = VALUE(b);
            z[i] = VALUE(c);
        }
    }
}

static void slopes(const struct point_plane *plane, size_t j, size_t from, size_t end)
{
    if (plane->flat && plane->knots)
        slopes_of(true, true, plane, j, from, end);
    else if (plane->flat)
        slopes_of(true, false, plane, j, from, end);
    else if (plane->knots)
        slopes_of(false, true, plane, j, from, end);
    else
        slopes_of(false, false, plane, j, from, end);
}

/* Rows of the slopes: g of component s along slot t. */
#define SLOPE_ROWS                                                                                           \
    const double *restrict g00 = slope_row(plane, 0, 0), *restrict g01 = slope_row(plane, 0, 1),             \
                           *restrict g02 = slope_row(plane, 0, 2), *restrict g10 = slope_row(plane, 1, 0),   \
                           *restrict g11 = slope_row(plane, 1, 1), *restrict g12 = slope_row(plane, 1, 2),   \
                           *restrict g20 = slope_row(plane, 2, 0), *restrict g21 = slope_row(plane, 2, 1),   \
                           *restrict g22 = slope_row(plane, 2, 2);

INLINED void stresses(const struct point_plane *plane, size_t first, size_t end,
                      const double *restrict lambda, const double *restrict mu, double *out)
{
    const size_t pitch = plane->pitch;
    SLOPE_ROWS STRESS_ROWS
#pragma omp simd
        for (size_t i = first; i < end; i++)
    {
        const double twice = 2 * mu[i], pressure = lambda[i] * (g00[i] + g11[i] + g22[i]);
        xx[i] = pressure + twice * g00[i];
        yy[i] = pressure + twice * g11[i];
        zz[i] = pressure + twice * g22[i];
        yz[i] = mu[i] * (g12[i] + g21[i]);
        zx[i] = mu[i] * (g20[i] + g02[i]);
        xy[i] = mu[i] * (g01[i] + g10[i]);
    }
}

/* Rows of the scratch that slopes() is done with. */
static double *free_row(const struct point_plane *plane, int row)
{
    return plane->scratch + ROW_ROOM + (size_t)row * plane->pitch;
}
enum { DEPTH_ROWS = 3, METRIC_ROWS = 6 };

static void tilt(const struct point_plane *plane, const struct hill_row *hill, size_t first, size_t end)
{
    const double *restrict drop = hill->drop, *restrict along_x = hill->slope[0],
                           *restrict along_y = hill->slope[1];
    double *restrict one = free_row(plane, METRIC_ROWS), *restrict two = free_row(plane, METRIC_ROWS + 1),
                     *restrict three = free_row(plane, METRIC_ROWS + 2);
    const double share = hill->share, fall = hill->fall;
#pragma omp simd
    for (size_t i = first; i < end; i++) {
        three[i] = 1 / (1 + drop[i] * fall);
        one[i] = along_x[i] * share * three[i];
        two[i] = along_y[i] * share * three[i];
    }
    for (int s = 0; s < 3; s += plane->flat ? 2 : 1) {
        double *restrict x = slope_row(plane, s, 0), *restrict y = slope_row(plane, s, 1),
                         *restrict z = slope_row(plane, s, 2);
#pragma omp simd
        for (size_t i = first; i < end; i++) {
            x[i] -= one[i] * z[i];
            y[i] -= two[i] * z[i];
            z[i] *= three[i];
        }
    }
}

/* What the stresses of component s pull at along the depth of the lattice: the transpose of tilt(). */
static void tilted_back(const struct point_plane *plane, int s, const double *restrict x,
                        const double *restrict y, const double *restrict z, size_t first, size_t end)
{
    const double *restrict one = free_row(plane, METRIC_ROWS),
                           *restrict two = free_row(plane, METRIC_ROWS + 1),
                           *restrict three = free_row(plane, METRIC_ROWS + 2);
    double *restrict depth = free_row(plane, DEPTH_ROWS + s);
#pragma omp simd
    for (size_t i = first; i < end; i++)
        depth[i] = three[i] * z[i] - one[i] * x[i] - two[i] * y[i];
    for (int i = 0; i < 2; i++) {
        depth[end + (size_t)i] = 0;
        *(depth + first - 1 - i) = 0;
    }
}

INLINED void pulls_of(const bool flat, const bool knots, const struct point_plane *plane, size_t j,
                      size_t first, size_t end, const double *lambda, const double *mu,
                      const struct run_of_points *run, size_t runs, const double *stiffness, bool tilted)
{
    static const int place[3][3] = {{0, 5, 4}, {5, 1, 3}, {4, 3, 2}};
    const size_t pitch = plane->pitch;
    double *out = plane->scratch + ROW_ROOM + 9 * pitch;
    SLOPE_ROWS
    stresses(plane, first, end, lambda, mu, out);
    for (size_t r = 0; r < runs; r++)
        for (size_t m = 0; m < run[r].count; m++) {
            const size_t i = run[r].from + m;
            if (i < first || i >= end) continue;
            const double strain[STRESSES] = {g00[i],          g11[i],          g22[i],
                                             g12[i] + g21[i], g20[i] + g02[i], g01[i] + g10[i]};
            law_of(&run[r], m, stiffness + run[r].at, strain, pitch, out + i);
        }
    for (int p = 0; p < STRESSES; p++)
        for (int i = 0; i < 2; i++) {
            out[(size_t)p * pitch + end + (size_t)i] = 0;
            *(out + (size_t)p * pitch + first - 1 - i) = 0;
        }
    for (int s = 0; s < 3; s += flat ? 2 : 1) {
        const struct taps *t = &plane->y[s == 1][j];
        const size_t from = t->first * pitch + ROW_ROOM + first;
        const double *row[3];
        for (int slot = 0; slot < 3; slot++)
            row[slot] = out + (size_t)place[s][slot] * pitch + first;
        if (tilted) {
            tilted_back(plane, s, row[0] - first, row[1] - first, row[2] - first, first, end);
            row[2] = free_row(plane, DEPTH_ROWS + s) + first;
        }
#define PULL_ROWS(count, apart)                                                                              \
    pull(count, apart, knots, t, plane->scale, end - first + 2, pitch, row[0], row[1], row[2],               \
         plane->pull_value[s] + from, (apart) ? plane->pull_across[s] + from : NULL,                         \
         plane->pull_slope[s] + from)
#define PULL_ALONG(count) PULL_ROWS(count, false)
#define PULL_APART(count) PULL_ROWS(count, true)
        if (plane->pull_across[s] != NULL) {
            BY_COUNT(PULL_APART)
        } else {
            BY_COUNT(PULL_ALONG)
        }
    }
}

static void pulls(const struct point_plane *plane, size_t j, size_t from, size_t end, const double *lambda,
                  const double *mu, const struct run_of_points *run, size_t runs, const double *stiffness,
                  bool tilted)
{
    if (plane->flat && plane->knots)
        pulls_of(true, true, plane, j, from, end, lambda, mu, run, runs, stiffness, tilted);
    else if (plane->flat)
        pulls_of(true, false, plane, j, from, end, lambda, mu, run, runs, stiffness, tilted);
    else if (plane->knots)
        pulls_of(false, true, plane, j, from, end, lambda, mu, run, runs, stiffness, tilted);
    else
        pulls_of(false, false, plane, j, from, end, lambda, mu, run, runs, stiffness, tilted);
}

static void row(const struct point_plane *plane, size_t j, const double *lambda, const double *mu,
                const struct run_of_points *run, size_t runs, const double *stiffness)
{
    if (plane->flat && plane->knots)
        row_of(true, true, plane, j, lambda, mu, run, runs, stiffness);
    else if (plane->flat)
        row_of(true, false, plane, j, lambda, mu, run, runs, stiffness);
    else if (plane->knots)
        row_of(false, true, plane, j, lambda, mu, run, runs, stiffness);
    else
        row_of(false, false, plane, j, lambda, mu, run, runs, stiffness);
}

static void add(size_t n, double v, const double *restrict value, double s, const double *restrict slope,
                double *restrict out)
{
#pragma omp simd
    for (size_t i = 0; i < n; i++)
        out[i] += v * value[i] + s * slope[i];
}

INLINED void depth_of(const int count, const struct taps *t, const double *restrict u, size_t stride,
                      size_t n, double *restrict value, double *restrict slope)
{
#pragma omp simd
    for (size_t i = 0; i < n; i++) {
        double one = 0, two = 0;
        for (int d = 0; d < count; d++) {
            one += t->value[d] * u[(size_t)d * stride + i];
            two += t->slope[d] * u[(size_t)d * stride + i];
        }
        value[i] = one;
        slope[i] = two;
    }
}

static void depth(const struct taps *t, const double *u, size_t stride, size_t n, double *value,
                  double *slope)
{
#define DEPTH_OF(count) depth_of(count, t, u, stride, n, value, slope)
    BY_COUNT(DEPTH_OF)
}

const struct point_kernels OF_PROCESSOR(point_kernels) = {row, slopes, pulls, tilt, add, depth};
