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
    const size_t first = slot == DEPTH ? c->part.first : 0;
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

/* Along an axis without derivatives: the identity (NULL), since N H = 1; over depth N M if M stands there in
 * the stiffness too (hform.c, bare_matrix). What is a slope over depth already has its own N; it lives only
 * in layers over depth, and takes the property over the density of the ground there. False: no memory. */
static bool bare_matrix(struct consistent *c, struct slab *slab, int out, struct input from,
                        enum weighting weight, const struct band **band)
{
    const int axis = c->dimension - 1;
    const double *property = c->weighted[weight], *density = c->weighted[WEIGHT_DENSITY];
    *band = NULL;
    if (from.slope_axis != axis) {
        if (property == NULL && (c->hform == NULL || !c->options.depth_exact)) return true;
        *band = matrix(c, slab, axis, c->pml->inverse[out][axis], (struct input){out, -1}, false, from, false,
                       weight);
        return *band != NULL;
    }
    if (property == NULL) return true;
    const struct spline *spline = c->spline[axis];
    struct band *diagonal = band_new(spline->count, 0);
    for (size_t i = 0; diagonal != NULL && i < spline->count; i++) {
        const size_t element = spline_locate(spline, spline->greville[i]);
        band_add(diagonal, i, i, property[element] / density[element]);
    }
    *band = fit(c, slab, axis, diagonal);
    return *band != NULL;
}

/* sign * weight / density * (d/dx_test, by parts) (d/dx_trial) `from`, to the acceleration `out`; test or
 * trial may be -1. */
static void add(struct terms *t, int out, size_t in, struct input from, int test, int trial,
                enum weighting weight, double sign)
{
    struct consistent *c = t->c;
    const bool varies = c->weighted[weight] != NULL;
    struct tensor_term *term = &t->term[t->count++];
    *term = (struct tensor_term){.out = out, .in = (int)in, .factor = sign};
    if (!varies) term->factor *= c->property[weight] / c->property[WEIGHT_DENSITY];
    for (int axis = 0; axis < c->dimension; axis++) {
        /* cppcheck-suppress negativeIndex ; axis is never negative, test may be (no axis) */
        const struct band **band = &term->matrix[c->slot[axis]];
        if (axis == test || axis == trial) {
            /* cppcheck-suppress negativeIndex ; axis is never negative, test may be (no axis) */
            *band = matrix(c, t->slab, axis, c->pml->inverse[out][axis], (struct input){out, -1},
                           axis == test, from, axis == trial, weight);
            t->good = t->good && *band != NULL;
        } else if (c->slot[axis] == DEPTH)
            t->good = t->good && bare_matrix(c, t->slab, out, from, weight, band);
    }
}

enum { NO_AXIS = 3 };

/* Two terms in one where the ground is the same everywhere: trial / density N G - test / density N G^T along
 * an axis, and N G along the other (NO_AXIS: none). */
static void add_pair(struct terms *t, int out, size_t in, struct input from, int axis, int other,
                     enum weighting trial, enum weighting test)
{
    struct consistent *c = t->c;
    const struct input to = {out, -1};
    const double density = c->property[WEIGHT_DENSITY], factor = c->property[trial] / density;
    struct tensor_term *term = &t->term[t->count++];
    *term = (struct tensor_term){.out = out, .in = (int)in, .factor = 1};
    const struct band *inverse = c->pml->inverse[out][axis];
    const struct band *slope = consistent_matrix(c, axis, 0, odd(to, axis), 1, odd(from, axis), WEIGHT_NONE);
    const struct band *turned = consistent_matrix(c, axis, 1, odd(to, axis), 0, odd(from, axis), WEIGHT_NONE);
    struct band *scaled = slope == NULL ? NULL : band_sum(slope, factor - 1, slope);
    struct band *sum =
        scaled == NULL || turned == NULL ? NULL : band_sum(scaled, -c->property[test] / density, turned);
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
        } else if (bare != axis && c->slot[bare] == DEPTH)
            t->good = t->good && bare_matrix(c, t->slab, out, from, trial, place);
    }
}

bool far_end_out(const struct consistent *c, const struct slab *slab)
{
    const int slot = c->slot[slab->axis];
    const size_t first = slot == DEPTH ? c->part.first : 0;
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

struct terms terms_outer(struct consistent *c, struct slab *slab)
{
    const int j = slab->axis;
    const size_t dimension = (size_t)c->dimension;
    struct terms t = {.c = c, .slab = slab, .good = true};
    for (int i = 0; i < c->dimension; i++) {
        const enum weighting weight = i == j ? WEIGHT_P : WEIGHT_MU;
        add(&t, i, (size_t)i, (struct input){i, -1}, j, j, weight, -1);
        add(&t, i, dimension + (size_t)i, (struct input){i, j}, -1, j, weight, 1);
    }
    for (int k = 0; k < c->dimension; k++) {
        if (k == j) continue;
        const size_t slope = 2 * dimension + (size_t)k;
        if (c->weighted[WEIGHT_MU] == NULL && far_end_out(c, slab)) {
            add_pair(&t, j, (size_t)k, (struct input){k, -1}, k, j, WEIGHT_LAMBDA, WEIGHT_MU);
            add_pair(&t, j, slope, (struct input){k, k}, j, NO_AXIS, WEIGHT_MU, WEIGHT_LAMBDA);
            continue;
        }
        add(&t, j, (size_t)k, (struct input){k, -1}, j, k, WEIGHT_LAMBDA, -1);
        add(&t, j, (size_t)k, (struct input){k, -1}, k, j, WEIGHT_MU, -1);
        add(&t, j, slope, (struct input){k, k}, j, -1, WEIGHT_LAMBDA, -1);
        add(&t, j, slope, (struct input){k, k}, -1, j, WEIGHT_MU, 1);
    }
    return t;
}

struct terms terms_pull(struct consistent *c, struct slab *slab)
{
    const int j = slab->axis;
    struct terms t = {.c = c, .slab = slab, .good = true};
    for (int i = 0; i < c->dimension; i++) {
        add(&t, i, (size_t)i, (struct input){i, j}, -1, j, i == j ? WEIGHT_P : WEIGHT_MU, 1);
        if (i == j) continue;
        if (c->weighted[WEIGHT_MU] == NULL) {
            add_pair(&t, i, (size_t)j, (struct input){j, j}, i, NO_AXIS, WEIGHT_MU, WEIGHT_LAMBDA);
            continue;
        }
        add(&t, i, (size_t)j, (struct input){j, j}, i, -1, WEIGHT_LAMBDA, -1);
        add(&t, i, (size_t)j, (struct input){j, j}, -1, i, WEIGHT_MU, 1);
    }
    return t;
}
