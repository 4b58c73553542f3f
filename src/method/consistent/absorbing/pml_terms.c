/* The terms of the absorbing layers (doc/theory/absorbing-faces.md, section 2): sums of products of matrices, those
 * of the axis across the face cut to the slab's region. */
#include "method/consistent/absorbing/pml_terms.h"

#include <string.h>

/* Keeps a matrix for the plans; equal ones are shared, so that plans share passes. NULL: no room. */
static const struct band *keep(struct slab *slab, struct band *band)
{
    if (band == NULL) return NULL;
    for (size_t i = 0; i < slab->bands; i++) {
        const struct band *known = slab->band[i];
        if (known->n != band->n || known->half != band->half ||
            memcmp(known->value, band->value, (2 * band->half + 1) * band->n * sizeof(double)) != 0)
            continue;
        band_free(band);
        return known;
    }
    if (slab->bands == SLAB_BANDS) {
        band_free(band);
        return NULL;
    }
    return slab->band[slab->bands++] = band;
}

/* What a term is applied to: a component's displacement, or that component's slope along an axis. */
struct input {
    int component, slope_axis; /* slope_axis -1: the displacement */
};

static bool odd(struct input input, int axis)
{
    return (input.component == axis) != (input.slope_axis == axis);
}

/* Takes a matrix of an axis over, cut to the region along the slab's own axis. */
static const struct band *fit(const struct consistent *c, struct slab *slab, int axis, struct band *whole)
{
    const int slot = c->slot[axis];
    if (whole == NULL || axis != slab->axis) return keep(slab, whole);
    const size_t first = c->part.along[slot].first;
    struct band *part = band_cut(whole, first + slab->region.at[slot], slab->region.n[slot]);
    band_free(whole);
    return keep(slab, part);
}

/* left * (integral of the test functions of `to` and the trial functions of `from`, with a slope on either
 * one), cut to the region along the slab's own axis. */
static const struct band *matrix(struct consistent *c, struct slab *slab, int axis, const struct band *left,
                                 struct input to, bool test_slope, struct input from, bool trial_slope,
                                 enum weighting weight)
{
    const struct band *right =
        consistent_matrix(c, axis, test_slope, odd(to, axis), trial_slope, odd(from, axis), weight);
    if (left == NULL || right == NULL) return NULL;
    return fit(c, slab, axis, band_product(left, right));
}

/* Properties over the density, element by element of the ground over depth, at its control values. NULL: no memory. */
static struct band *ratios(struct consistent *c, enum weighting one, enum weighting other)
{
    const struct spline *spline = c->spline[c->dimension - 1];
    const double *density = c->weighted[WEIGHT_DENSITY];
    struct band *diagonal = band_new(spline->count, 0);
    for (size_t i = 0; diagonal != NULL && i < spline->count; i++) {
        const size_t e = spline_locate(spline, spline->greville[i]);
        const double sum = c->weighted[one][e] + (other == WEIGHT_NONE ? 0 : c->weighted[other][e]);
        band_add(diagonal, i, i, sum / density[e]);
    }
    return diagonal;
}

/* Along an axis without derivatives: the identity (NULL), since N H = 1; over depth N M if M stands there in
 * the stiffness too (hform.c, bare_matrix). What is a slope over depth already has its own N; it lives only
 * in layers over depth, and takes the property over the density of the ground there (of both weights, where there is
 * another). False: no memory. */
static bool bare_matrix(struct consistent *c, struct slab *slab, int out, struct input from,
                        enum weighting weight, enum weighting other, const struct band **band)
{
    const int axis = c->dimension - 1;
    const bool varies = c->weighted[weight] != NULL;
    *band = NULL;
    if (from.slope_axis != axis) {
        if (!varies && (c->hform == NULL || !c->options.depth_exact)) return true;
        *band = matrix(c, slab, axis, c->pml->inverse[out][axis], (struct input){out, -1}, false, from, false,
                       weight);
        return *band != NULL;
    }
    if (!varies) return true;
    *band = fit(c, slab, axis, ratios(c, weight, other));
    return *band != NULL;
}

/* Derivatives along axes, one bit each: of the trial functions, and by parts of the test functions. */
struct slopes {
    unsigned trial, test;
};

static unsigned along(int axis)
{
    return 1U << axis;
}

/* sign * (weight + other) / density * (these derivatives of) `from`, to the acceleration `out`; other: WEIGHT_NONE, or
 * for slopes over depth. */
static void add(struct terms *t, int out, size_t in, struct input from, struct slopes slopes,
                enum weighting weight, enum weighting other, double sign)
{
    struct consistent *c = t->c;
    const bool varies = c->weighted[weight] != NULL;
    struct tensor_term *term = &t->term[t->count++];
    *term = (struct tensor_term){.out = out, .in = (int)in, .factor = sign};
    if (!varies) term->factor *= c->property[weight] / c->property[WEIGHT_DENSITY];
    for (int axis = 0; axis < c->dimension; axis++) {
        const struct band **band = &term->matrix[c->slot[axis]];
        if (((slopes.trial | slopes.test) & along(axis)) != 0) {
            *band = matrix(c, t->slab, axis, c->pml->inverse[out][axis], (struct input){out, -1},
                           (slopes.test & along(axis)) != 0, from, (slopes.trial & along(axis)) != 0, weight);
            t->good = t->good && *band != NULL;
        } else if (c->slot[axis] == DEPTH)
            t->good = t->good && bare_matrix(c, t->slab, out, from, weight, other, band);
    }
}

enum { NO_AXIS = 3 };

/* Where terms in pairs take a property over the density: at the slab's end if the ground varies; 1 along an axis whose
 * matrices have it in them. */
static double ratio_at(const struct terms *t, enum weighting weight, int axis)
{
    const struct consistent *c = t->c;
    if (c->weighted[weight] == NULL) return c->property[weight] / c->property[WEIGHT_DENSITY];
    if (c->slot[axis] == DEPTH) return 1;
    const size_t e = t->slab->end == 0 ? 0 : c->spline[c->dimension - 1]->elements - 1;
    return c->weighted[weight][e] / c->weighted[WEIGHT_DENSITY][e];
}

/* Two terms in one: trial / density N G - test / density N G^T along an axis, and N G along the other (NO_AXIS: none).
 * Where the ground varies the axis is over depth, or all is in a layer over depth. */
static void add_pair(struct terms *t, int out, size_t in, struct input from, int axis, int other,
                     enum weighting trial, enum weighting test)
{
    struct consistent *c = t->c;
    const struct input to = {out, -1};
    const double factor = ratio_at(t, trial, axis);
    const bool varies = c->weighted[trial] != NULL;
    struct tensor_term *term = &t->term[t->count++];
    *term = (struct tensor_term){.out = out, .in = (int)in, .factor = 1};
    const struct band *inverse = c->pml->inverse[out][axis];
    const struct band *slope = consistent_matrix(c, axis, 0, odd(to, axis), 1, odd(from, axis), trial);
    const struct band *turned = consistent_matrix(c, axis, 1, odd(to, axis), 0, odd(from, axis), test);
    struct band *scaled = slope == NULL ? NULL : band_sum(slope, factor - 1, slope);
    struct band *sum =
        scaled == NULL || turned == NULL ? NULL : band_sum(scaled, -ratio_at(t, test, axis), turned);
    const struct band *band = sum == NULL ? NULL : fit(c, t->slab, axis, band_product(inverse, sum));
    band_free(scaled);
    band_free(sum);
    term->matrix[c->slot[axis]] = band;
    t->good = t->good && band != NULL;
    for (int bare = 0; bare < c->dimension; bare++) {
        const struct band **place = &term->matrix[c->slot[bare]];
        if (bare == other) {
            /* cppcheck-suppress arrayIndexOutOfBoundsCond ; bare is an axis, other may be none */
            *place = matrix(c, t->slab, bare, c->pml->inverse[out][bare], to, false, from, true, trial);
            t->good = t->good && *place != NULL;
        } else if (bare != axis && c->slot[bare] == DEPTH && !varies)
            t->good = t->good && bare_matrix(c, t->slab, out, from, trial, WEIGHT_NONE, place);
    }
}

bool far_end_out(const struct consistent *c, const struct slab *slab)
{
    const int slot = c->slot[slab->axis];
    const size_t first = c->part.along[slot].first;
    const size_t from = first + slab->region.at[slot], n = slab->region.n[slot];
    return c->spline[slab->axis]->mirror[1 - slab->end] ||
           (slab->end == 1 ? from > 0 : from + n < c->spline[slab->axis]->count);
}

/* N for the slopes of u_i along the slab's axis: that of components with their parity at symmetry planes. */
static const struct band *slope_inverse(const struct consistent *c, struct slab *slab, int i)
{
    const int j = slab->axis;
    if (i != j) return c->pml->inverse[j][j];
    if (c->dimension > 1) return c->pml->inverse[(j + 1) % c->dimension][j];
    return keep(slab, hform_inverse(c, 0, 0, false));
}

struct terms terms_gradient(struct consistent *c, struct slab *slab)
{
    const int j = slab->axis;
    struct terms t = {.c = c, .slab = slab, .good = true};
    for (int i = 0; i < c->dimension; i++) {
        const struct band *left = slope_inverse(c, slab, i);
        struct tensor_term *term = &t.term[t.count++];
        *term = (struct tensor_term){.out = i, .in = i, .factor = 1};
        term->matrix[c->slot[j]] = matrix(c, slab, j, left, (struct input){i, j}, false,
                                          (struct input){i, -1}, true, WEIGHT_DENSITY);
        t.good = t.good && term->matrix[c->slot[j]] != NULL;
    }
    return t;
}

/* To T_jj from component k and from psi_kk: (7). Where the axis' boundary term plays no part, slopes of the trial
 * functions along j serve for both products. */
static void add_mixed(struct terms *t, int k)
{
    const struct consistent *c = t->c;
    const int j = t->slab->axis, depth = c->dimension - 1;
    const size_t from = (size_t)k, slope = 2 * (size_t)c->dimension + from;
    const struct input u = {k, -1}, psi = {k, k};
    const bool far = far_end_out(c, t->slab), varies = c->weighted[WEIGHT_MU] != NULL;
    if (far && (!varies || k == depth))
        add_pair(t, j, from, u, k, j, WEIGHT_LAMBDA, WEIGHT_MU);
    else {
        const struct slopes trial = {along(j) | along(k), 0}, parts = {along(k), along(j)};
        const bool swapped = far && j != depth;
        add(t, j, from, u, swapped ? trial : parts, WEIGHT_LAMBDA, WEIGHT_NONE, swapped ? 1 : -1);
        add(t, j, from, u, (struct slopes){along(j), along(k)}, WEIGHT_MU, WEIGHT_NONE, -1);
    }
    if (far && (!varies || j == depth))
        add_pair(t, j, slope, psi, j, NO_AXIS, WEIGHT_MU, WEIGHT_LAMBDA);
    else if (far && k == depth)
        add(t, j, slope, psi, (struct slopes){along(j), 0}, WEIGHT_LAMBDA, WEIGHT_MU, 1);
    else {
        const struct slopes trial = {along(j), 0}, parts = {0, along(j)};
        add(t, j, slope, psi, far ? trial : parts, WEIGHT_LAMBDA, WEIGHT_NONE, far ? 1 : -1);
        add(t, j, slope, psi, trial, WEIGHT_MU, WEIGHT_NONE, 1);
    }
}

struct terms terms_outer(struct consistent *c, struct slab *slab)
{
    const int j = slab->axis;
    const size_t dimension = (size_t)c->dimension;
    struct terms t = {.c = c, .slab = slab, .good = true};
    for (int i = 0; i < c->dimension; i++) {
        const enum weighting weight = i == j ? WEIGHT_P : WEIGHT_MU;
        add(&t, i, (size_t)i, (struct input){i, -1}, (struct slopes){along(j), along(j)}, weight, WEIGHT_NONE,
            -1);
        add(&t, i, dimension + (size_t)i, (struct input){i, j}, (struct slopes){along(j), 0}, weight,
            WEIGHT_NONE, 1);
    }
    for (int k = 0; k < c->dimension; k++)
        if (k != j) add_mixed(&t, k);
    return t;
}

struct terms terms_pull(struct consistent *c, struct slab *slab)
{
    const int j = slab->axis, depth = c->dimension - 1;
    struct terms t = {.c = c, .slab = slab, .good = true};
    for (int i = 0; i < c->dimension; i++) {
        add(&t, i, (size_t)i, (struct input){i, j}, (struct slopes){along(j), 0},
            i == j ? WEIGHT_P : WEIGHT_MU, WEIGHT_NONE, 1);
        if (i == j) continue;
        if (c->weighted[WEIGHT_MU] == NULL || i == depth || j == depth) {
            add_pair(&t, i, (size_t)j, (struct input){j, j}, i, NO_AXIS, WEIGHT_MU, WEIGHT_LAMBDA);
            continue;
        }
        add(&t, i, (size_t)j, (struct input){j, j}, (struct slopes){0, along(i)}, WEIGHT_LAMBDA, WEIGHT_NONE,
            -1);
        add(&t, i, (size_t)j, (struct input){j, j}, (struct slopes){along(i), 0}, WEIGHT_MU, WEIGHT_NONE, 1);
    }
    return t;
}
