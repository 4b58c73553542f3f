/* Making of the fused operator: tables of weights (fused.h, F1). */
#include "method/consistent/fused/fused.h"

#include "base/memory.h"
#include "method/consistent/galerkin/hform.h"
#include "method/spline/passes.h"

#include <float.h>
#include <math.h>
#include <string.h>

static size_t rounded(size_t n, size_t unit)
{
    return (n + unit - 1) / unit * unit;
}

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

/* Narrow matrices of a side in the order of fused_side, from SIDE_S_EVEN. */
static struct band *side_matrix(struct consistent *c, int axis, enum fused_side which, double *factor)
{
    const double lambda = c->property[WEIGHT_LAMBDA], mu = c->property[WEIGHT_MU];
    const double density = c->property[WEIGHT_DENSITY], sum = lambda + mu;
    *factor = which == SIDE_S_EVEN    ? -mu / density
              : which == SIDE_S_ODD   ? -(lambda + 2 * mu) / density
              : which == SIDE_G_FIRST ? 1
                                      : sum / density;
    switch (which) {
    case SIDE_S_EVEN:
        return fused_narrow_matrix(c, axis, false, true, false, true, 0);
    case SIDE_S_ODD:
        return fused_narrow_matrix(c, axis, true, true, true, true, 0);
    case SIDE_G_FIRST:
        return fused_narrow_matrix(c, axis, false, false, true, true, mu / sum);
    default:
        return fused_narrow_matrix(c, axis, true, false, false, true, lambda / sum);
    }
}

/* Product over depth of component `in`: A, C or B of F1, with its factor. */
static struct band *depth_matrix(struct consistent *c, int in, enum fused_depth which, double *factor)
{
    const double lambda = c->property[WEIGHT_LAMBDA], mu = c->property[WEIGHT_MU];
    const double density = c->property[WEIGHT_DENSITY], sum = lambda + mu;
    const bool odd = in == DEPTH, changes = which == OVER_DEPTH_C;
    const bool to_odd = changes ? !odd : odd;
    struct band *inner = NULL;
    if (which == OVER_DEPTH_A) {
        *factor = odd ? -(lambda + 2 * mu) / density : -mu / density;
        inner = fused_narrow_matrix(c, DEPTH, odd, true, odd, true, 0);
    } else if (changes) {
        *factor = odd ? 1 : sum / density;
        inner = fused_narrow_matrix(c, DEPTH, !odd, false, odd, true, (odd ? mu : lambda) / sum);
    } else {
        *factor = 1;
        inner = fused_narrow_matrix(c, DEPTH, odd, false, odd, false, 0);
    }
    const struct band *left = c->hform->inverse[to_odd ? DEPTH : 0][DEPTH];
    struct band *product = inner == NULL ? NULL : band_product(left, inner);
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
        struct band *made = inverse ? NULL : side_matrix(c, axis, (enum fused_side)which, &factor);
        const struct band *band =
            inverse ? c->hform->inverse[which == SIDE_N_ODD ? axis : other][axis] : made;
        const int taps = inverse ? f->wide : f->narrow;
        void **table = axis == 0 ? &f->x[which] : &f->y[which];
        if (band != NULL)
            *table = axis == 0 ? fused_by_vectors(band, factor, taps, f->width, FUSED_VECTOR / f->number)
                               : fused_by_rows(band, factor, taps, rounded(f->rows.whole, FUSED_ROWS));
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
            struct band *whole = depth_matrix(c, component, (enum fused_depth)which, &factor);
            struct band *band = whole == NULL ? NULL : band_cut(whole, f->planes.first, f->n[DEPTH]);
            band_free(whole);
            if (band != NULL)
                f->z[component][which] = fused_by_rows(band, factor, f->deep, rounded(f->n[2], FUSED_PLANES));
            band_free(band);
            if (f->z[component][which] == NULL) return false;
        }
    return true;
}

void fused_find_plain(const double *table, size_t taps, size_t n, bool *plain)
{
    const double rounding = 2 * DBL_EPSILON * (double)n;
    for (size_t group = 0; group < rounded(n, FUSED_ROWS) / FUSED_ROWS; group++) {
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
    const size_t groups = rounded(f->rows.whole, FUSED_ROWS) / FUSED_ROWS;
    const size_t first = f->rows.first, rows = rounded(f->n[1], FUSED_ROWS);
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

/* How long rows are waited for: from the newest, which the strip or the narrow passes over y make, to the
 * oldest that those behind still read. b_x and b_y are the same whatever multiplies them but where
 * displacements are mixed. */
static void lay_rings(const struct fused *f, bool mixed, struct fused_rings *rings)
{
    size_t all = 0;
    for (int field = 0; field < FUSED_FIELDS; field++) {
        size_t rows = FUSED_STRIP + f->late[1];
        if (field == ROW_CX || field == ROW_BX_MIXED || field == ROW_BY_SHEAR) rows = FUSED_STRIP;
        if (field == ROW_BY || field == ROW_BX_SHEAR || field == ROW_BY_MIXED || field == ROW_BZ ||
            field == ROW_CY || field == ROW_G)
            rows = FUSED_STRIP + f->late[0] + (size_t)f->narrow / 2;
        if (field >= ROW_T1) rows = f->late[1] + (size_t)f->wide / 2 + FUSED_ROWS - f->late[0];
        const bool same = !mixed && field >= ROW_BX_SHEAR && field < ROW_BZ;
        const int as = (field - ROW_BX_SHEAR) % 2 == 0 ? ROW_BX : ROW_BY;
        rings->rows[field] = same ? rings->rows[as] : rounded(rows, FUSED_ROWS);
        rings->start[field] = same ? rings->start[as] : all;
        all += same ? 0 : rings->rows[field];
    }
    rings->size = all * f->stride;
}

bool fused_lay_rings(struct fused *f, int displacements)
{
    struct fused_rings *rings = &f->rings[displacements - 1];
    const size_t before = f->buffer_size;
    lay_rings(f, displacements > 1, rings);
    f->buffer_size = FUSED_PLANES * rings->size + 2 * FUSED_ROWS * f->stride + 2 * (f->stride - f->width);
    f->bytes += (size_t)f->threads * f->number * (f->buffer_size - before);
    if (f->buffer == NULL) f->buffer = array_new((size_t)f->threads, sizeof *f->buffer);
    for (int t = 0; f->buffer != NULL && t < f->threads; t++) {
        array_free(f->buffer[t]);
        f->buffer[t] = array_new(f->buffer_size, f->number);
        if (f->buffer[t] == NULL) return false;
    }
    return f->buffer != NULL;
}

/* Where loads act. */
static void lay_loaded(const struct consistent *c, struct fused *f)
{
    for (size_t l = 0; l < c->model.scene->loads; l++) {
        const struct sparse *load = &c->hform->load[l];
        for (size_t at = 0; at < 3 * f->n[2]; at++)
            for (size_t e = load->start[at]; e < load->start[at + 1]; e++) {
                const size_t x = load->index[e] % f->n[0], y = load->index[e] / f->n[0];
                const struct window one = {{x, y}, {x + 1, y + 1}};
                f->loaded[at % f->n[2]] = window_join(&f->loaded[at % f->n[2]], &one);
            }
    }
}

static bool lay_windows(const struct consistent *c, struct fused *f)
{
    const size_t planes = f->n[2], blocks = rounded(planes, FUSED_PLANES) / FUSED_PLANES;
    f->bound = array_new((size_t)f->threads + 1, sizeof *f->bound);
    f->strips = rounded(f->n[1], FUSED_STRIP) / FUSED_STRIP;
    f->size = array_new(planes, sizeof *f->size);
    f->column = array_new(planes * f->n[0], f->number);
    f->strip = array_new(planes * f->strips, f->number);
    f->computed = array_new(blocks, sizeof *f->computed);
    f->reached = array_new(planes, sizeof *f->reached);
    f->will_reach = array_new(planes, sizeof *f->will_reach);
    f->loaded = array_new(planes, sizeof *f->loaded);
    f->bytes += planes * (f->n[0] + f->strips) * f->number + (3 * planes + blocks) * sizeof *f->loaded;
    if (f->rows.ranks > 1) {
        f->loud = array_new(4 * (rounded(f->planes.whole, FUSED_PLANES) / FUSED_PLANES), sizeof *f->loud);
        if (f->loud == NULL) return false;
    }
    if (f->bound == NULL || f->size == NULL || f->column == NULL || f->strip == NULL || f->computed == NULL ||
        f->reached == NULL || f->will_reach == NULL || f->loaded == NULL)
        return false;
    lay_loaded(c, f);
    return true;
}

/* Along each side the components across it share one inverse mass; else the passes could not be shared. */
static bool shares_masses(const struct consistent *c)
{
    for (int axis = 0; axis < 3; axis++) {
        const int one = axis == 0 ? 1 : 0, other = axis == 2 ? 1 : 2;
        if (c->hform->inverse[one][axis] != c->hform->inverse[other][axis]) return false;
    }
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
        fused_shorten(f->y[which], taps * rounded(f->n[1], FUSED_ROWS));
    }
    for (int component = 0; component < 3; component++) {
        double *stiff = f->z[component][OVER_DEPTH_A];
        for (size_t k = 0; k < f->n[2]; k++)
            sum_in_middle(stiff + k * deep, deep, 1, deep / 2 - k % FUSED_PLANES);
        for (int which = 0; which < OVER_DEPTH_MATRICES; which++)
            fused_shorten(f->z[component][which], deep * rounded(f->n[2], FUSED_PLANES));
    }
}

/* Tables and rings for numbers of so many bytes; NULL: no memory. */
static struct fused *fused_new(struct consistent *c, size_t number)
{
    const size_t degree = (size_t)c->options.degree, reach = degree * (size_t)c->options.sweeps;
    struct fused *f = array_new(1, sizeof *f);
    if (f == NULL) return NULL;
    memcpy(f->n, c->n, sizeof f->n);
    f->number = number;
    f->plane = c->plane;
    f->volume = c->volume;
    f->threads = c->threads;
    f->ranks = c->part.ranks;
    f->rows = c->part.along[1];
    f->planes = c->part.along[DEPTH];
    f->bare = !c->options.depth_exact;
    f->bulk = c->property[WEIGHT_MU] == 0;
    f->quiet = c->options.quiet;
    f->narrow = (int)(2 * degree + 1);
    f->wide = (int)(2 * reach + 1);
    f->deep = (int)(2 * (reach + degree) + 1);
    f->width = rounded(f->n[0], FUSED_VECTOR / number);
    f->stride = f->width + rounded(reach, FUSED_VECTOR / number);
    f->late[0] = rounded(degree, FUSED_ROWS);
    f->late[1] = rounded(f->late[0] + reach, FUSED_ROWS);
    f->bytes = sizeof *f;
    const bool good = lay_side(c, f, 0) && lay_side(c, f, 1) && lay_depth(c, f) && lay_plain(f) &&
                      fused_lay_rings(f, 1) && lay_windows(c, f);
    if (good && number == sizeof(float)) shorten_all(f);
    if (good) return f;
    fused_free(f);
    return NULL;
}

bool fused_create(struct consistent *c)
{
    const size_t degree = (size_t)c->options.degree, reach = degree * (size_t)c->options.sweeps;
    if (c->dimension != 3 || c->weighted[WEIGHT_MU] != NULL || !shares_masses(c)) return true;
    if (degree != 2 || c->n[0] * sizeof(double) < FUSED_VECTOR) return true;
    for (int axis = 0; axis < 3; axis++)
        if (c->spline[axis]->count < 2 * reach + 2) return true;
    c->fused = fused_new(c, sizeof(double));
    if (c->fused == NULL) return false;
    if (!c->options.single || c->n[0] * sizeof(float) < FUSED_VECTOR) return true;
    c->fused->single = fused_new(c, sizeof(float));
    return c->fused->single != NULL;
}

struct window fused_whole(const struct fused *f)
{
    return (struct window){.end = {f->n[0], f->n[1]}};
}

struct window fused_own(const struct fused *f)
{
    return (struct window){{0, f->rows.own}, {f->n[0], f->rows.end}};
}

void fused_count(struct fused *f)
{
    f->largest = 0;
    for (size_t k = 0; k < f->n[2]; k++)
        if (f->size[k] > f->largest) {
            f->largest = f->size[k];
            f->loudest = k;
        }
    const struct window own = fused_own(f);
    for (size_t k = f->planes.own; k < f->planes.end; k++) {
        f->points += window_points(&own);
        f->skipped += window_points(&own) - window_points(&f->computed[k / FUSED_PLANES]);
    }
}

void fused_forget(struct fused *fused)
{
    for (; fused != NULL; fused = fused->single)
        fused->points = fused->skipped = 0;
}

void fused_free(struct fused *fused)
{
    if (fused == NULL) return;
    if (fused->single != NULL) fused->single->faces = NULL;
    fused_free(fused->single);
    fused_faces_free(fused->faces);
    for (int which = 0; which < SIDE_MATRICES; which++) {
        array_free(fused->x[which]);
        array_free(fused->y[which]);
    }
    for (int component = 0; component < 3; component++)
        for (int which = 0; which < OVER_DEPTH_MATRICES; which++)
            array_free(fused->z[component][which]);
    for (int t = 0; fused->buffer != NULL && t < fused->threads; t++)
        array_free(fused->buffer[t]);
    array_free(fused->buffer);
    array_free(fused->kept);
    array_free(fused->relaxing);
    array_free(fused->plain);
    array_free(fused->size);
    array_free(fused->column);
    array_free(fused->strip);
    array_free(fused->computed);
    array_free(fused->reached);
    array_free(fused->will_reach);
    array_free(fused->loaded);
    array_free(fused->loud);
    array_free(fused->bound);
    array_free(fused);
}
