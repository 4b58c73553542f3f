/* The 1-D matrices of the consistent method and the Kronecker sums made of them (manual, section 3):
 *
 *   K_ii = (lambda + 2 mu) S_i (x) M (x) M + mu (sum over j != i of S_j (x) M (x) M)
 *   K_ij = lambda G_i^T (x) G_j (x) M + mu G_i (x) G_j^T (x) M,  i != j,  G = integral of N_a dN_b/dx,
 *
 * with lambda, mu and the density under the integral of the depth axis where they vary. */
#include "method/consistent/galerkin/galerkin.h"

#include "base/memory.h"

static bool mirrored(const struct spline *spline)
{
    return spline->mirror[0] || spline->mirror[1];
}

const struct band *consistent_matrix(struct consistent *c, int axis, int test_slope, bool test_odd,
                                     int trial_slope, bool trial_odd, enum weighting weight)
{
    const struct spline *spline = c->spline[axis];
    if (!mirrored(spline)) test_odd = trial_odd = false;
    if (c->slot[axis] != DEPTH || weight == WEIGHT_NONE || c->weighted[weight] == NULL) weight = WEIGHT_NONE;
    for (size_t i = 0; i < c->matrices; i++) {
        const struct axis_matrix *m = &c->matrix[i];
        if (m->axis == axis && m->test_slope == test_slope && m->trial_slope == trial_slope &&
            m->test_odd == test_odd && m->trial_odd == trial_odd && m->weight == weight)
            return m->band;
    }
    if (c->matrices == MAX_MATRICES) return NULL;
    struct band *band = tuned_matrix(spline, test_odd, test_slope, trial_odd, trial_slope,
                                     weight == WEIGHT_NONE ? NULL : c->weighted[weight]);
    if (band != NULL)
        c->matrix[c->matrices++] =
            (struct axis_matrix){axis, test_slope, trial_slope, test_odd, trial_odd, weight, band};
    return band;
}

/* Adds the term with derivatives of the test function along axis `test` and of the trial function along axis
 * `trial` (-1: none), from component `in` to `out`. */
static bool add_term(struct consistent *c, struct tensor_term *terms, size_t *count, int out, int in,
                     int test, int trial, enum weighting weight)
{
    struct tensor_term *term = &terms[(*count)++];
    *term = (struct tensor_term){.out = out, .in = in, .factor = 1};
    if (c->weighted[weight] == NULL) term->factor = c->property[weight];
    for (int axis = 0; axis < c->dimension; axis++) {
        const struct band *band =
            consistent_matrix(c, axis, axis == test, axis == out, axis == trial, axis == in, weight);
        if (band == NULL) return false;
        term->matrix[c->slot[axis]] = band;
    }
    return true;
}

static bool stiffness_terms(struct consistent *c, struct tensor_term *terms, size_t *count)
{
    bool good = true;
    for (int i = 0; i < c->dimension; i++)
        for (int j = 0; j < c->dimension; j++) {
            good = good && add_term(c, terms, count, i, i, j, j, i == j ? WEIGHT_P : WEIGHT_MU);
            if (i == j) continue;
            good = good && add_term(c, terms, count, i, j, i, j, WEIGHT_LAMBDA) &&
                   add_term(c, terms, count, i, j, j, i, WEIGHT_MU);
        }
    return good;
}

bool consistent_plans(struct consistent *c)
{
    struct tensor_term terms[32];
    size_t count = 0;
    if (!stiffness_terms(c, terms, &count) || !part_terms(c, terms, count)) return false;
    c->stiffness = tensor_plan_new(c->n, c->dimension, terms, count, c->threads);
    count = 0;
    for (int i = 0; i < c->dimension; i++) {
        if (!add_term(c, terms, &count, i, i, -1, -1, WEIGHT_DENSITY)) return false;
        for (int axis = 0; axis < c->dimension; axis++)
            c->mass_band[i][axis] = terms[count - 1].matrix[c->slot[axis]];
    }
    if (!part_terms(c, terms, count)) return false;
    for (int i = 0; i < c->dimension; i++)
        c->mass_depth[i] = terms[i].matrix[DEPTH];
    c->mass = tensor_plan_new(c->n, c->dimension, terms, count, c->threads);
    return c->stiffness != NULL && c->mass != NULL;
}
