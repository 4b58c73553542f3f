/* The tables of weights of the fused operator (fused.h, F1, F1c). */
#include "method/consistent/fused/fused.h"

#include "base/memory.h"
#include "method/consistent/galerkin/hform.h"

#include <float.h>
#include <math.h>
#include <string.h>

struct band *fused_narrow_matrix(struct consistent *c, int axis, bool test_odd, bool test_slope,
                                 bool trial_odd, bool trial_slope, double share)
{
    const struct band *known =
        consistent_matrix(c, axis, test_slope, test_odd, trial_slope, trial_odd, WEIGHT_NONE);
    struct band *matrix = known == NULL ? NULL : band_sum(known, 0, known);
    if (matrix == NULL) return NULL;
    if (!c->spline[axis]->mirror[0]) band_add(matrix, 0, 0, share);
    if (!c->spline[axis]->mirror[1]) band_add(matrix, matrix->n - 1, matrix->n - 1, -share);
    return matrix;
}

/* Narrow matrices of a side in the order of fused_side, from SIDE_S_EVEN. On layered ground the moduli and what ends do
 * stand elsewhere. */
static struct band *side_matrix(struct consistent *c, bool layered, int axis, enum fused_side which,
                                double *factor)
{
    const double lambda = c->property[WEIGHT_LAMBDA], mu = c->property[WEIGHT_MU];
    const double density = layered ? 1 : c->property[WEIGHT_DENSITY], sum = lambda + mu;
    *factor = which == SIDE_S_EVEN    ? -(layered ? 1 : mu) / density
              : which == SIDE_S_ODD   ? -(layered ? 1 : lambda + 2 * mu) / density
              : which == SIDE_G_FIRST ? 1
                                      : (layered ? 1 : sum) / density;
    switch (which) {
    case SIDE_S_EVEN:
        return fused_narrow_matrix(c, axis, false, true, false, true, 0);
    case SIDE_S_ODD:
        return fused_narrow_matrix(c, axis, true, true, true, true, 0);
    case SIDE_G_FIRST:
        return fused_narrow_matrix(c, axis, false, false, true, true, layered ? 0 : mu / sum);
    default:
        return fused_narrow_matrix(c, axis, true, false, false, true, layered ? 0 : lambda / sum);
    }
}

/* What N stands before over depth, for component `in`: A, C or B of F1, with its factor. */
static struct band *even_inner(struct consistent *c, int in, enum fused_depth which, double *factor)
{
    const double lambda = c->property[WEIGHT_LAMBDA], mu = c->property[WEIGHT_MU];
    const double density = c->property[WEIGHT_DENSITY], sum = lambda + mu;
    const bool odd = in == DEPTH;
    if (which == OVER_DEPTH_A) {
        *factor = odd ? -(lambda + 2 * mu) / density : -mu / density;
        return fused_narrow_matrix(c, DEPTH, odd, true, odd, true, 0);
    }
    if (which == OVER_DEPTH_C) {
        *factor = odd ? 1 : sum / density;
        return fused_narrow_matrix(c, DEPTH, !odd, false, odd, true, (odd ? mu : lambda) / sum);
    }
    *factor = 1;
    return fused_narrow_matrix(c, DEPTH, odd, false, odd, false, 0);
}

/* The same of layered ground (F1c). */
static struct band *layered_inner(struct consistent *c, int in, enum fused_depth which, double *factor)
{
    const bool odd = in == DEPTH, stiff = which == OVER_DEPTH_A, changes = which == OVER_DEPTH_C;
    const enum weighting one = odd ? WEIGHT_LAMBDA : WEIGHT_MU, other = odd ? WEIGHT_MU : WEIGHT_LAMBDA;
    const enum weighting weight = changes                      ? one
                                  : stiff && odd               ? WEIGHT_P
                                  : which == OVER_DEPTH_LAMBDA ? WEIGHT_LAMBDA
                                                               : WEIGHT_MU;
    const struct band *first =
        consistent_matrix(c, DEPTH, stiff, odd != changes, stiff || changes, odd, weight);
    const struct band *turned = changes ? consistent_matrix(c, DEPTH, 1, !odd, 0, odd, other) : first;
    *factor = stiff ? -1 : 1;
    return first == NULL || turned == NULL ? NULL : band_sum(first, changes ? -1 : 0, turned);
}

static struct band *depth_matrix(struct consistent *c, bool layered, int in, enum fused_depth which,
                                 double *factor)
{
    const bool to_odd = (in == DEPTH) != (which == OVER_DEPTH_C);
    struct band *inner = (layered ? layered_inner : even_inner)(c, in, which, factor);
    struct band *product =
        inner == NULL ? NULL : band_product(c->hform->inverse[to_odd ? DEPTH : 0][DEPTH], inner);
    band_free(inner);
    return product;
}

double *fused_by_rows(const struct band *band, double factor, int taps, size_t rows)
{
    double *table = array_new(rows * (size_t)taps, sizeof *table);
    for (size_t i = 0; table != NULL && i < band->n; i++)
        for (size_t t = 0; t < (size_t)taps; t++)
            if (i + t >= (size_t)(taps / 2))
                table[i * (size_t)taps + t] = factor * band_get(band, i, i + t - (size_t)(taps / 2));
    return table;
}

double *fused_by_vectors(const struct band *band, double factor, int taps, size_t width, size_t vector)
{
    double *rows = fused_by_rows(band, factor, taps, band->n);
    double *table = rows == NULL ? NULL : array_new((size_t)taps * width, sizeof *table);
    for (size_t i = 0; table != NULL && i < band->n; i++)
        for (size_t t = 0; t < (size_t)taps; t++)
            table[(i / vector * (size_t)taps + t) * vector + i % vector] = rows[i * (size_t)taps + t];
    array_free(rows);
    return table;
}

static bool lay_side(struct consistent *c, struct fused *f, int axis)
{
    const int other = 1 - axis;
    for (int which = 0; which < SIDE_MATRICES; which++) {
        const bool inverse = which == SIDE_N_EVEN || which == SIDE_N_ODD;
        double factor = 1;
        struct band *made =
            inverse ? NULL : side_matrix(c, f->layered, axis, (enum fused_side)which, &factor);
        const struct band *band =
            inverse ? c->hform->inverse[which == SIDE_N_ODD ? axis : other][axis] : made;
        const int taps = inverse ? f->wide : f->narrow;
        void **table = axis == 0 ? &f->x[which] : &f->y[which];
        if (band != NULL)
            *table = axis == 0 ? fused_by_vectors(band, factor, taps, f->width, FUSED_VECTOR / f->number)
                               : fused_by_rows(band, factor, taps, fused_rounded(f->rows.whole, FUSED_ROWS));
        band_free(made);
        if (*table == NULL) return false;
    }
    return true;
}

static bool lay_depth(struct consistent *c, struct fused *f)
{
    for (int component = 0; component < 3; component++)
        for (int which = 0; which < OVER_DEPTH_MATRICES; which++) {
            double factor = 1;
            if (which == OVER_DEPTH_LAMBDA && (!f->layered || component == DEPTH)) continue;
            struct band *whole = depth_matrix(c, f->layered, component, (enum fused_depth)which, &factor);
            struct band *band = whole == NULL ? NULL : band_cut(whole, f->planes.first, f->n[DEPTH]);
            band_free(whole);
            if (band != NULL)
                f->z[component][which] =
                    fused_by_rows(band, factor, f->deep, fused_rounded(f->n[2], FUSED_PLANES));
            band_free(band);
            if (f->z[component][which] == NULL) return false;
        }
    return true;
}

void fused_find_plain(const double *table, size_t taps, size_t n, bool *plain)
{
    const double rounding = 2 * DBL_EPSILON * (double)n;
    for (size_t group = 0; group < fused_rounded(n, FUSED_ROWS) / FUSED_ROWS; group++) {
        const double *row = table + group * FUSED_ROWS * taps;
        double largest = 0;
        for (size_t i = 0; i < taps; i++)
            largest = fmax(largest, fabs(row[i]));
        for (size_t i = taps; i < FUSED_ROWS * taps; i++)
            plain[group] = plain[group] && fabs(row[i] - row[i - taps]) <= rounding * largest;
    }
}

/* Plain groups of all rows of the body; then the tables of those of the window, weights of rows beyond it and all. */
static bool lay_plain(struct fused *f)
{
    const size_t groups = fused_rounded(f->rows.whole, FUSED_ROWS) / FUSED_ROWS;
    const size_t first = f->rows.first, rows = fused_rounded(f->n[1], FUSED_ROWS);
    f->plain = array_new(groups, sizeof *f->plain);
    if (f->plain == NULL) return false;
    memset(f->plain, true, groups * sizeof *f->plain);
    for (int which = 0; which < SIDE_MATRICES; which++) {
        const bool inverse = which == SIDE_N_EVEN || which == SIDE_N_ODD;
        const size_t taps = (size_t)(inverse ? f->wide : f->narrow);
        double *table = f->y[which];
        fused_find_plain(table, taps, f->rows.whole, f->plain);
        memmove(table, table + first * taps, rows * taps * sizeof *table);
    }
    memmove(f->plain, f->plain + first / FUSED_ROWS, rows / FUSED_ROWS * sizeof *f->plain);
    return true;
}

void fused_shorten(void *table, size_t n)
{
    const double *long_one = table;
    float *single = table;
    for (size_t i = 0; i < n; i++) {
        const float value = (float)long_one[i];
        memcpy(single + i, &value, sizeof value);
    }
}

/* The weight of the value in the middle becomes the sum of all (passes_over.h, DIFFERENCES). */
static void sum_in_middle(double *weight, size_t taps, size_t apart, size_t middle)
{
    double sum = 0;
    for (size_t t = 0; t < taps; t++)
        sum += weight[t * apart];
    weight[middle * apart] = sum;
}

static void shorten_all(struct fused *f)
{
    const size_t narrow = (size_t)f->narrow, deep = (size_t)f->deep, group = FUSED_VECTOR / f->number;
    for (int which = SIDE_S_EVEN; which <= SIDE_S_ODD; which++) {
        for (size_t i = 0; i < f->width; i++)
            sum_in_middle((double *)f->x[which] + i / group * narrow * group + i % group, narrow, group,
                          narrow / 2);
        for (size_t i = 0; i < f->n[1]; i++)
            if (!f->plain[i / FUSED_ROWS])
                sum_in_middle((double *)f->y[which] + i * narrow, narrow, 1, narrow / 2);
    }
    for (int which = 0; which < SIDE_MATRICES; which++) {
        const size_t taps = which <= SIDE_N_ODD ? (size_t)f->wide : narrow;
        fused_shorten(f->x[which], taps * f->width);
        fused_shorten(f->y[which], taps * fused_rounded(f->n[1], FUSED_ROWS));
    }
    for (int component = 0; component < 3; component++) {
        double *stiff = f->z[component][OVER_DEPTH_A];
        for (size_t k = 0; k < f->n[2]; k++)
            sum_in_middle(stiff + k * deep, deep, 1, deep / 2 - k % FUSED_PLANES);
        for (int which = 0; which < OVER_DEPTH_MATRICES; which++)
            if (f->z[component][which] != NULL)
                fused_shorten(f->z[component][which], deep * fused_rounded(f->n[2], FUSED_PLANES));
    }
}

bool fused_lay_tables(struct consistent *c, struct fused *f)
{
    if (!lay_side(c, f, 0) || !lay_side(c, f, 1) || !lay_depth(c, f) || !lay_plain(f)) return false;
    if (f->number == sizeof(float)) shorten_all(f);
    return true;
}
