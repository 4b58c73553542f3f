/* Sources at a point (doc/theory/consistent-splines.md, section 15). The functions at x, N_b(x), have the transform
 *
 *   sum over b of N_b(x) exp(-i k (x_b - x)) = sum over n of N^(k + 2 pi n / h) exp(2 pi i n x / h),          (V1)
 *
 * N^ = sinc^(p + 1). Waves that the lattice carries should get n = 0 alone: the others are of order (k h)^(p + 1),
 * in slopes (k h)^p beside k. Weights w_b over seven control values have the moments of n = 0,
 *
 *   sum w_b (x_b - x)^j = m_j,  or for slopes  j m_(j - 1),   j = 0 .. 5,                                    (V2)
 *   m_0 = 1, m_2 = s, m_4 = 3 s^2 - (p + 1) h^4 / 120, s = (p + 1) h^2 / 12, m_1 = m_3 = 0,
 *
 * and are the smallest such: least sum of w_b^2 / r_b, r a bell over seven cells, so that they change smoothly with
 * x and stand alike on both sides of it. Degrees 3 and 4 filter them where there is room (quiet.c). */
#include "method/spline/source.h"

#include "method/spline/images.h"
#include "method/spline/quiet.h"

#include <gsl/gsl_linalg.h>
#include <math.h>

enum { WIDE = SOURCE_WIDE, MOMENTS = 6 };

static void set_moments(int degree, bool slope, double moment[MOMENTS])
{
    const double s = (degree + 1) / 12., plain[MOMENTS] = {1, 0, s, 0, 3 * s * s - (degree + 1) / 120., 0};
    for (int j = 0; j < MOMENTS; j++)
        moment[j] = !slope ? plain[j] : j > 0 ? j * plain[j - 1] : 0;
}

/* Legendre polynomials 0 to 5 by powers of t; they keep the equations well conditioned. */
static const double legendre[MOMENTS][MOMENTS] = {{1},
                                                  {0, 1},
                                                  {-.5, 0, 1.5},
                                                  {0, -1.5, 0, 2.5},
                                                  {.375, 0, -3.75, 0, 4.375},
                                                  {0, 1.875, 0, -8.75, 0, 7.875}};

/* The smallest weights, in the metric of a bell, whose sums over `value` are those wanted. */
static void solve(const double bell[WIDE], double value[WIDE][MOMENTS], size_t count, double *wanted,
                  double weight[WIDE])
{
    double matrix[MOMENTS * MOMENTS] = {0};
    for (int b = 0; b < WIDE; b++)
        for (size_t i = 0; i < count; i++)
            for (size_t j = 0; j < count; j++)
                matrix[i * count + j] += bell[b] * value[b][i] * value[b][j];
    gsl_matrix_view a = gsl_matrix_view_array(matrix, count, count);
    gsl_vector_view x = gsl_vector_view_array(wanted, count);
    gsl_linalg_cholesky_decomp1(&a.matrix);
    gsl_linalg_cholesky_svx(&a.matrix, &x.vector);
    for (int b = 0; b < WIDE; b++) {
        weight[b] = 0;
        for (size_t j = 0; j < count; j++)
            weight[b] += bell[b] * wanted[j] * value[b][j];
    }
}

static double bell_at(double t)
{
    return pow(fmax(0, 1 - t * t), 3);
}

void source_weights(int degree, bool slope, const double away[SOURCE_WIDE], double reach,
                    double weight[SOURCE_WIDE])
{
    double moment[MOMENTS], bell[WIDE], value[WIDE][MOMENTS] = {{0}}, wanted[MOMENTS] = {0};
    set_moments(degree, slope, moment);
    for (int j = 0; j < MOMENTS; j++)
        for (int k = 0; k <= j; k++)
            wanted[j] += legendre[j][k] * moment[k] / pow(reach, k);
    for (int b = 0; b < WIDE; b++) {
        bell[b] = bell_at(away[b] / reach);
        for (int j = 0; j < MOMENTS; j++)
            for (int k = 0; k <= j; k++)
                value[b][j] += legendre[j][k] * pow(away[b] / reach, k);
    }
    solve(bell, value, MOMENTS, wanted, weight);
}

void source_hats(double depth, int hats, double share[SOURCE_WIDE])
{
    const double reach = fmax(depth, WIDE - 1 - depth) + .5;
    const int moments = hats < MOMENTS ? hats : MOMENTS;
    double bell[WIDE], value[WIDE][MOMENTS], wanted[MOMENTS];
    for (int m = 1; m <= moments; m++)
        wanted[m - 1] = pow(depth / WIDE, m);
    for (int j = 0; j < WIDE; j++) {
        bell[j] = j < hats ? bell_at((j - depth) / reach) : 0;
        for (int m = 1; m <= moments; m++) {
            const double beyond = pow(j + 1, m + 2) - pow(j, m + 2),
                         before = pow(j, m + 2) - pow(j - 1, m + 2);
            value[j][m - 1] = (j > 0 ? beyond - before : beyond) / ((m + 1) * (m + 2) * pow(WIDE, m));
        }
    }
    solve(bell, value, (size_t)moments, wanted, share);
}

/* The seven control values of the unclamped spline next to an open end, where x is too near for as many on either side;
 * the first of them is twice that on the end less its neighbour. Degree 2. */
static bool end_images(const struct spline *spline, double x, int end, struct images *images)
{
    const ptrdiff_t last = (ptrdiff_t)spline->count - 1, step = end == 0 ? 1 : -1;
    const double *at = spline->greville + (end == 0 ? 0 : last);
    if (spline->degree != 2 || spline->mirror[end] || last < WIDE) return false;
    images->gap = fabs(at[step * WIDE] - at[step]) / (WIDE - 1);
    const double toward = (x - at[0]) * (double)step;
    if (toward < 0 || toward > .5 * WIDE * images->gap) return false;
    for (ptrdiff_t b = 0; b < WIDE; b++) {
        images->index[b] = (size_t)(end == 0 ? b : last - b);
        images->sign[b] = 1;
        images->position[b] = at[0] + (double)step * ((double)b - .5) * images->gap;
        if (b > 0 && fabs(at[step * b] - images->position[b]) > 1e-6 * images->gap) return false;
    }
    return true;
}

bool source_at(const struct spline *spline, bool odd, enum source_kind kind, bool slope, double x,
               struct tuned_point *point)
{
    struct images images;
    double away[WIDE], weight[WIDE];
    const double rounding =
        1e-9 * (spline->high - spline->low); /* of a place on an end, in a body that is turned */
    if (x < spline->low && x > spline->low - rounding) x = spline->low;
    if (x > spline->high && x < spline->high + rounding) x = spline->high;
    if (kind == SOURCE_NONE) return false;
    if (spline->degree > 2 && quiet_at(spline, odd, kind, slope, x, point)) return true;
    if (kind == SOURCE_FORCE) return false;
    const bool inside = spline_images(spline, odd, x, WIDE, &images);
    if (!inside && !end_images(spline, x, 0, &images) && !end_images(spline, x, 1, &images)) return false;
    double farthest = 0;
    for (int b = 0; b < WIDE; b++) {
        away[b] = (images.position[b] - x) / images.gap;
        farthest = fmax(farthest, fabs(away[b]));
    }
    source_weights(spline->degree, slope, away, inside ? .5 * WIDE : farthest + .5, weight);
    struct tuned_point plain = {.count = WIDE};
    double *line = slope ? plain.slope : plain.value;
    for (size_t b = 0; b < WIDE; b++) {
        plain.index[b] = images.index[b];
        line[b] = weight[b] * images.sign[b] / (slope ? images.gap : 1);
    }
    if (!inside) {
        line[1] -= line[0];
        line[0] *= 2;
    }
    tuned_filter(spline, odd, &plain, point);
    return true;
}
