/* The H-form (manual, sections 8 and 9): making (accelerate.c uses it).
 *
 *   N = sum over j <= m of (I - D^-1 M)^j D^-1,   D = row sums of M,
 *
 *   rho a_i = -[(lambda + 2 mu) A_i + mu sum A_j] u_i + (lambda + mu) sum over j != i of C2_i C1_j u_j - edges,
 *
 *   A  = N S,
 *   C1 = N (G - mu / (lambda + mu) E),
 *   C2 = N (G - lambda / (lambda + mu) E),
 *   E  = G + G^T,
 *
 * and H = N^-1 in place of M everywhere. */
#include "method/consistent/galerkin/hform.h"

#include "base/memory.h"

#include <string.h>

/* Factors of van Cittert's series; those of the general operator are tuned for its points (G7). */
static const double plain_series[] = {1, 1, 1, 1}, general_series[] = {1, 1, .8962, 1.6064};

struct band *hform_inverse(const struct consistent *c, int component, int axis, bool odd)
{
    const struct spline *spline = c->spline[axis];
    const struct band *mass = consistent_matrix((struct consistent *)c, axis, 0, odd, 0, odd, WEIGHT_DENSITY);
    const struct band *even =
        consistent_matrix((struct consistent *)c, axis, 0, false, 0, false, WEIGHT_DENSITY);
    if (mass == NULL || even == NULL) return NULL;
    const size_t n = spline->count;
    struct band *rest = band_new(n, mass->half), *diagonal = band_new(n, 0), *sum = band_new(n, 0);
    if (rest == NULL || diagonal == NULL || sum == NULL) {
        band_free(rest);
        band_free(diagonal);
        band_free(sum);
        return NULL;
    }
    const double *series = c->options.general ? general_series : plain_series;
    bool held[2], cut[2]; /* cut: the even functions of a mirror plane keep what odd ones have not */
    for (int end = 0; end < 2; end++) {
        held[end] = c->held[component][2 * axis + end];
        cut[end] = held[end] && !spline->mirror[end];
    }
    for (size_t i = 0; i < n; i++) {
        if ((held[0] && i == 0) || (held[1] && i == n - 1)) continue;
        double row_sum = 0;
        for (size_t j = 0; j < n; j++)
            if (!((cut[0] && j == 0) || (cut[1] && j == n - 1))) row_sum += band_get(even, i, j);
        band_add(diagonal, i, i, 1 / row_sum);
        band_add(sum, i, i, series[c->options.sweeps] / row_sum);
        for (size_t j = 0; j < n; j++)
            if (band_get(mass, i, j) != 0) band_add(rest, i, j, -band_get(mass, i, j) / row_sum);
        band_add(rest, i, i, 1);
    }
    for (int term = c->options.sweeps - 1; term >= 0 && sum != NULL; term--) {
        struct band *product = band_product(rest, sum);
        band_free(sum);
        sum = product == NULL ? NULL : band_sum(product, series[term], diagonal);
        band_free(product);
    }
    band_free(rest);
    band_free(diagonal);
    return sum;
}

static bool same_space(const struct consistent *c, int one, int other, int axis)
{
    const bool mirrored = c->spline[axis]->mirror[0] || c->spline[axis]->mirror[1];
    if (mirrored && (one == axis) != (other == axis)) return false;
    return c->held[one][2 * axis] == c->held[other][2 * axis] &&
           c->held[one][2 * axis + 1] == c->held[other][2 * axis + 1];
}

/* Cholesky factor of N with 1 on the diagonal where it is 0; the ends' columns. */
static bool lay_factor(struct consistent *c, int component, int axis)
{
    struct hform *h = c->hform;
    const struct band *inverse = h->inverse[component][axis];
    struct band *full = band_sum(inverse, 0, inverse);
    double *factor = array_new(inverse->n * (inverse->half + 1), sizeof *factor);
    h->factor[component][axis] = factor;
    bool good = full != NULL && factor != NULL;
    for (size_t i = 0; i < inverse->n && good; i++)
        if (band_get(full, i, i) == 0) band_add(full, i, i, 1);
    good = good && band_factorise(full, factor);
    band_free(full);
    if (!good) return false;
    for (int end = 0; end < 2; end++) {
        double *column = array_new(inverse->n, sizeof *column);
        h->column[component][axis][end] = column;
        if (column == NULL) return false;
        for (size_t i = 0; i < inverse->n; i++)
            column[i] = band_get(inverse, i, end == 0 ? 0 : inverse->n - 1);
    }
    h->reach[axis] = inverse->half + 1 < inverse->n ? inverse->half + 1 : inverse->n;
    return good;
}

/* N = U U^T over depth: the Cholesky factor of N with its rows and columns in the opposite order. */
static bool lay_upper(struct consistent *c, int component)
{
    const int axis = c->dimension - 1;
    if (c->weighted[WEIGHT_DENSITY] == NULL) return true;
    const struct band *inverse = c->hform->inverse[component][axis];
    struct band *turned = band_new(inverse->n, inverse->half);
    double *factor = array_new(inverse->n * (inverse->half + 1), sizeof *factor);
    c->hform->upper[component] = factor;
    c->hform->upper_half = inverse->half;
    if (turned == NULL || factor == NULL) {
        band_free(turned);
        return false;
    }
    const size_t last = inverse->n - 1;
    for (size_t i = 0; i <= last; i++)
        for (size_t j = i < inverse->half ? 0 : i - inverse->half; j <= last && j <= i + inverse->half; j++)
            band_add(turned, i, j, band_get(inverse, last - i, last - j));
    for (size_t i = 0; i <= last; i++)
        if (band_get(turned, i, i) == 0) band_add(turned, i, i, 1);
    const bool good = band_factorise(turned, factor);
    band_free(turned);
    return good;
}

static bool lay_inverses(struct consistent *c)
{
    struct hform *h = c->hform;
    h->factors.side = array_new(c->classes, sizeof *h->factors.side);
    if (h->factors.side == NULL) return false;
    for (int axis = 0; axis < c->dimension; axis++)
        for (int component = 0; component < c->dimension; component++) {
            for (int other = 0; other < component; other++)
                if (same_space(c, component, other, axis))
                    h->inverse[component][axis] = h->inverse[other][axis];
            if (h->inverse[component][axis] == NULL) {
                h->inverse[component][axis] = hform_inverse(c, component, axis, component == axis);
                h->owns_inverse[component][axis] = true;
            }
            if (h->inverse[component][axis] == NULL || !lay_factor(c, component, axis)) return false;
            if (axis == c->dimension - 1 && !lay_upper(c, component)) return false;
            const int slot = c->slot[axis];
            h->factors.half[slot] = h->inverse[component][axis]->half;
            if (slot == DEPTH) h->factors.depth[component] = h->factor[component][axis];
            for (size_t class = 0; slot != DEPTH && class < c->classes; class ++)
                h->factors.side[class][component][slot] = h->factor[component][axis];
        }
    return true;
}

/* left * (right - share E), E = -1 and 1 at the low and the high end unless that is a mirror. */
static const struct band *multiply(struct consistent *c, int axis, const struct band *left,
                                   const struct band *right, double share)
{
    struct hform *h = c->hform;
    if (left == NULL || right == NULL || h->products == MAX_PRODUCTS) return NULL;
    struct band *inner = band_sum(right, 0, right);
    if (inner == NULL) return NULL;
    const size_t last = inner->n - 1;
    if (!c->spline[axis]->mirror[0]) band_add(inner, 0, 0, share);
    if (!c->spline[axis]->mirror[1]) band_add(inner, last, last, -share);
    struct band *product = band_product(left, inner);
    band_free(inner);
    if (product == NULL) return NULL;
    for (size_t i = 0; i < h->products; i++) { /* equal ones are shared, so that plans share passes */
        const struct band *known = h->product[i];
        if (known->n != product->n || known->half != product->half ||
            memcmp(known->value, product->value, (2 * known->half + 1) * known->n * sizeof(double)) != 0)
            continue;
        band_free(product);
        return known;
    }
    h->product[h->products++] = product;
    return product;
}

/* Mass in the stiffness along an axis without derivatives: the identity, since N H = 1, but over depth N M if
 * M stands there. False: no memory. */
static bool bare_matrix(struct consistent *c, int axis, int out, int in, enum weighting weight,
                        const struct band **matrix)
{
    *matrix = NULL;
    if (c->slot[axis] != DEPTH || (c->weighted[weight] == NULL && !c->options.depth_exact)) return true;
    const struct band *mass = consistent_matrix(c, axis, 0, axis == out, 0, axis == in, weight);
    *matrix = multiply(c, axis, c->hform->inverse[out][axis], mass, 0);
    return *matrix != NULL;
}

/* Term of -M^-1 K with derivatives of the test and trial functions along the axes given. */
static bool add_term(struct consistent *c, struct tensor_term *terms, size_t *count, int out, int in,
                     int test, int trial, enum weighting weight)
{
    const bool varies = c->weighted[weight] != NULL;
    struct tensor_term *term = &terms[(*count)++];
    *term = (struct tensor_term){.out = out, .in = in, .factor = -1};
    if (!varies) term->factor = -c->property[weight] / c->property[WEIGHT_DENSITY];
    for (int axis = 0; axis < c->dimension; axis++) {
        if (axis != test && axis != trial) {
            if (!bare_matrix(c, axis, out, in, weight, &term->matrix[c->slot[axis]])) return false;
            continue;
        }
        const struct band *band =
            consistent_matrix(c, axis, axis == test, axis == out, axis == trial, axis == in, weight);
        term->matrix[c->slot[axis]] = multiply(c, axis, c->hform->inverse[out][axis], band, 0);
        if (term->matrix[c->slot[axis]] == NULL) return false;
    }
    return true;
}

/* Do the boundary terms of an axis play no part in what moves a component, N G^T = -N G? */
static bool ends_out(const struct consistent *c, int component, int axis)
{
    const bool *mirror = c->spline[axis]->mirror, *held = &c->held[component][2 * axis];
    return (mirror[0] || held[0]) && (mirror[1] || held[1]);
}

/* left * (one + factor * other). */
static const struct band *multiply_sum(struct consistent *c, int axis, const struct band *left,
                                       const struct band *one, double factor, const struct band *other)
{
    struct band *sum = one == NULL || other == NULL ? NULL : band_sum(one, factor, other);
    const struct band *product = sum == NULL ? NULL : multiply(c, axis, left, sum, 0);
    band_free(sum);
    return product;
}

/* Both products of K_ij in one where the ground varies over depth and the ends of the axes along it play no part:
 * N G along these and, over depth, N (G_trial - G_test^T) with lambda and mu (N M of lambda + mu if neither is over
 * depth). */
static bool add_layered(struct consistent *c, struct tensor_term *terms, size_t *count, int out, int in)
{
    const int depth = c->dimension - 1;
    struct tensor_term *term = &terms[(*count)++];
    *term = (struct tensor_term){.out = out, .in = in, .factor = 1};
    for (int axis = 0; axis < c->dimension; axis++) {
        const struct band *left = c->hform->inverse[out][axis], **product = &term->matrix[c->slot[axis]];
        const bool to = axis == out, from = axis == in;
        if (axis != depth && (to || from))
            *product = multiply(c, axis, left, consistent_matrix(c, axis, 0, to, 1, from, WEIGHT_NONE), 0);
        else if (axis == depth && (to || from))
            *product = multiply_sum(
                c, axis, left, consistent_matrix(c, axis, 0, to, 1, from, from ? WEIGHT_LAMBDA : WEIGHT_MU),
                -1, consistent_matrix(c, axis, 1, to, 0, from, from ? WEIGHT_MU : WEIGHT_LAMBDA));
        else if (axis == depth)
            *product = multiply_sum(c, axis, left, consistent_matrix(c, axis, 0, to, 0, from, WEIGHT_LAMBDA),
                                    1, consistent_matrix(c, axis, 0, to, 0, from, WEIGHT_MU));
        else
            continue;
        if (*product == NULL) return false;
    }
    return true;
}

/* A correction at two ends; none where the ends are not in the window. False: no memory. */
static bool add_edge(struct consistent *c, int out, int in, const int end[2], const struct band *depth)
{
    struct hform *h = c->hform;
    const double lambda = c->property[WEIGHT_LAMBDA], mu = c->property[WEIGHT_MU];
    const double density = c->property[WEIGHT_DENSITY];
    const int axes[2] = {out, in};
    struct edge edge = {.out = out, .in = in, .to = {c->n[0], c->n[1], c->n[2]}};
    edge.factor = (end[0] == end[1] ? -1 : 1) * lambda * mu / ((lambda + mu) * density);
    edge.depth = part_matrix(c, DEPTH, depth);
    if (depth != NULL && edge.depth == NULL) return false;
    for (int i = 0; i < 2; i++) {
        const int axis = axes[i], slot = c->slot[axis];
        const size_t n = c->n[slot];
        edge.at[slot] = part_face(c, 2 * axis + end[i]);
        if (edge.at[slot] == SIZE_MAX) return true;
        edge.from[slot] = end[i] == 0 ? 0 : n - h->reach[axis];
        edge.to[slot] = end[i] == 0 ? h->reach[axis] : n;
        edge.column[slot] = h->column[out][axis][end[i]] + c->part.along[slot].first;
    }
    h->edge[h->edges++] = edge;
    return true;
}

/* Both products of K_ij in one, and what that leaves where two faces meet. */
static bool add_mixed(struct consistent *c, struct tensor_term *terms, size_t *count, int out, int in)
{
    struct hform *h = c->hform;
    const double lambda = c->property[WEIGHT_LAMBDA], mu = c->property[WEIGHT_MU];
    const double density = c->property[WEIGHT_DENSITY];
    struct tensor_term *term = &terms[(*count)++];
    *term = (struct tensor_term){.out = out, .in = in, .factor = (lambda + mu) / density};
    for (int i = 0; i < 2; i++) {
        const int axis = i == 0 ? out : in;
        const struct band *gradient = consistent_matrix(c, axis, 0, axis == out, 1, axis == in, WEIGHT_NONE);
        term->matrix[c->slot[axis]] =
            multiply(c, axis, h->inverse[out][axis], gradient, (axis == out ? lambda : mu) / (lambda + mu));
        if (term->matrix[c->slot[axis]] == NULL) return false;
    }
    const int across = 3 - out - in; /* the axis that is left, in three dimensions */
    if (c->dimension == 3 && !bare_matrix(c, across, out, in, WEIGHT_MU, &term->matrix[c->slot[across]]))
        return false;
    for (int ends = 0; ends < 4; ends++) {
        const int end[2] = {ends % 2, ends / 2};
        if (c->spline[out]->mirror[end[0]] || c->spline[in]->mirror[end[1]]) continue;
        const struct band *depth = c->dimension == 3 ? term->matrix[c->slot[across]] : NULL;
        if (!add_edge(c, out, in, end, depth)) return false;
    }
    return true;
}

static bool lay_plan(struct consistent *c)
{
    struct tensor_term terms[32];
    size_t count = 0;
    bool good = true;
    for (int i = 0; i < c->dimension; i++)
        for (int j = 0; j < c->dimension; j++) {
            good = good && add_term(c, terms, &count, i, i, j, j, i == j ? WEIGHT_P : WEIGHT_MU);
            if (i == j) continue;
            if (c->weighted[WEIGHT_MU] == NULL)
                good = good && add_mixed(c, terms, &count, i, j);
            else if ((i == c->dimension - 1 || ends_out(c, i, i)) &&
                     (j == c->dimension - 1 || ends_out(c, i, j)))
                good = good && add_layered(c, terms, &count, i, j);
            else
                good = good && add_term(c, terms, &count, i, j, i, j, WEIGHT_LAMBDA) &&
                       add_term(c, terms, &count, i, j, j, i, WEIGHT_MU);
        }
    if (!good || !part_terms(c, terms, count)) return false;
    c->hform->acceleration = tensor_plan_new(c->n, c->dimension, terms, count, c->threads);
    return c->hform->acceleration != NULL;
}

selas_status hform_create(struct consistent *c, struct messages *messages)
{
    size_t largest = c->plane;
    for (int slot = 0; slot < 2; slot++)
        if (c->n[1 - slot] * c->n[DEPTH] > largest) largest = c->n[1 - slot] * c->n[DEPTH];
    for (int face = 0; face < 2 * c->dimension && !c->options.general; face++)
        for (int one = 0; one < c->dimension; one++)
            for (int other = 0; other < one; other++)
                if (one != face / 2 && other != face / 2 && c->held[one][face] != c->held[other][face])
                    return fail(
                        messages, SELAS_UNSUPPORTED,
                        "face %s prescribes motion along %c and leaves it free along %c, both in the face: "
                        "method%%mass = 'vc1', 'vc2', 'vc3' has no such face; method%%mass = 'exact' would "
                        "be right",
                        face_name((enum face)face), "xyz"[c->held[one][face] ? one : other],
                        "xyz"[c->held[one][face] ? other : one]);
    for (int face = 0; c->part.ranks != NULL && face < 2 * c->dimension; face++) {
        if (!c->damped[face] || c->slot[face / 2] == DEPTH) continue;
        c->model.untold = true;
        if (c->weighted[WEIGHT_DENSITY] != NULL)
            return fail(
                messages, SELAS_UNSUPPORTED,
                "face %s: dampers (layer = 'lysmer') beside layered ground and a mass of sweeps: on one rank "
                "only; start it without mpirun, or take method%%mass = 'exact' or layer = 'pml'",
                face_name((enum face)face));
    }
    struct hform *h = array_new(1, sizeof *h);
    c->hform = h;
    if (h == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for a model");
    h->work = array_new(c->model.unknowns, sizeof *h->work);
    h->loudest = array_new(c->n[DEPTH] * ((c->n[1] + TENSOR_STRIP - 1) / TENSOR_STRIP), sizeof *h->loudest);
    h->face[0] = array_new(largest, sizeof(double));
    h->face[1] = array_new(largest, sizeof(double));
    if (h->work == NULL || h->loudest == NULL || h->face[0] == NULL || h->face[1] == NULL ||
        !lay_inverses(c) ||
        (!c->options.general && (!lay_plan(c) || !hform_forces(c) || !hform_dissipation_create(c))))
        return fail(messages, SELAS_NO_MEMORY, "no memory for a model of %zu control values", c->volume);
    return SELAS_OK;
}

size_t hform_bytes(const struct consistent *c)
{
    const struct hform *h = c->hform;
    if (h == NULL) return 0;
    return sizeof *h + c->model.unknowns * sizeof *h->work + sparse_list_bytes(c, &h->load) +
           (h->acceleration != NULL ? tensor_plan_bytes(h->acceleration) : 0) +
           (h->dissipation != NULL ? tensor_plan_bytes(h->dissipation) : 0);
}

void hform_free(struct consistent *c)
{
    struct hform *h = c->hform;
    if (h == NULL) return;
    for (int component = 0; component < 3; component++)
        array_free(h->upper[component]);
    for (int component = 0; component < 3; component++)
        for (int axis = 0; axis < 3; axis++) {
            if (h->owns_inverse[component][axis]) band_free(h->inverse[component][axis]);
            array_free(h->factor[component][axis]);
            array_free(h->column[component][axis][0]);
            array_free(h->column[component][axis][1]);
        }
    for (size_t i = 0; i < h->products; i++)
        band_free(h->product[i]);
    tensor_plan_free(h->acceleration);
    hform_dissipation_free(c);
    sparse_list_free(&h->load);
    for (int face = 0; face < BOX_FACES; face++)
        sparse_free(&h->pulled[face]);
    array_free(h->factors.side);
    array_free(h->loudest);
    array_free(h->face[0]);
    array_free(h->face[1]);
    array_free(h->work);
    array_free(h);
}
