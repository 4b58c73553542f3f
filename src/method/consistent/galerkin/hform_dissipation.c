/* A little dissipation of the shortest waves (manual, section 12): to the acceleration comes
 *
 *   -rate sum over axes of P v,   P = N B^T B dx / (256 (sweeps + 1)),
 *
 * B the fourth differences of the control values along the axis, wherever five of them in a row are evenly
 * spaced. M P = H (x) H (x) B^T B is symmetric and not negative, so that it only takes energy; cubic motions
 * (rigid ones, even strains) feel nothing of it, also at faces; a wave of angle theta = k dx a point loses
 * amplitude at half the rate times N^ (2 sin(theta/2))^8 / (256 (sweeps + 1)), which is of order theta^8. */
#include "method/consistent/galerkin/hform.h"

#include "base/memory.h"
#include "method/spline/images.h"

#include <math.h>
#include <omp.h>
#include <string.h>

enum { REACH = 2 };

/* Adds factor times the square of the fourth difference about a place, if there is one. */
static void add_difference(const struct spline *spline, bool odd, size_t centre, double factor,
                           struct band *square)
{
    struct difference d;
    if (!spline_difference(spline, odd, (ptrdiff_t)centre - REACH, 2 * REACH, &d)) return;
    for (int i = 0; i <= d.order; i++)
        for (int j = 0; j <= d.order; j++)
            band_add(square, d.index[i], d.index[j], factor * d.factor[i] * d.factor[j]);
}

/* P of a component's axis. Over depth N has the density in it: that of the lightest layer makes P the same or
 * smaller. */
static struct band *smoother(const struct consistent *c, int component, int axis)
{
    const struct spline *spline = c->spline[axis];
    const struct band *inverse = c->hform->inverse[component][axis];
    const size_t half = 2 * REACH < spline->count ? 2 * REACH : spline->count - 1;
    struct band *square = band_new(spline->count, half);
    if (square == NULL) return NULL;
    const double *density = c->slot[axis] == DEPTH ? c->weighted[WEIGHT_DENSITY] : NULL;
    double factor = (spline->high - spline->low) / (double)spline->cells / (256.0 * (c->options.sweeps + 1));
    if (density != NULL) {
        double lightest = density[0];
        for (size_t e = 0; e < spline->elements; e++)
            lightest = fmin(lightest, density[e]);
        factor *= lightest;
    }
    for (size_t i = 0; i < spline->count; i++) {
        const bool on_plane =
            (spline->centred[0] && i == 0) || (spline->centred[1] && i == spline->count - 1);
        add_difference(spline, component == axis, i, on_plane ? factor / 2 : factor, square);
    }
    struct band *product = band_product(inverse, square);
    band_free(square);
    return product;
}

/* Largest sum of a row's sizes: not below the largest eigenvalue. */
static double row_bound(const struct band *band)
{
    double bound = 0;
    for (size_t i = 0; i < band->n; i++) {
        double sum = 0;
        for (size_t d = 0; d <= 2 * band->half; d++)
            sum += fabs(band->value[d * band->n + i]);
        bound = fmax(bound, sum);
    }
    return bound;
}

bool hform_dissipation_create(struct consistent *c)
{
    struct hform *h = c->hform;
    struct tensor_term terms[9];
    size_t count = 0;
    double largest = 0;
    if (!(c->options.dissipation > 0)) return true;
    const struct scene *scene = c->model.scene;
    const double rate = c->options.dissipation * scene_fastest(scene) / scene->body.spacing;
    for (int component = 0; component < c->dimension; component++) {
        double bound = 0;
        for (int axis = 0; axis < c->dimension; axis++) {
            struct band *band = smoother(c, component, axis);
            h->smoother[component][axis] = band;
            if (band == NULL) return false;
            bound += rate * row_bound(band);
            terms[count] = (struct tensor_term){.out = component, .in = component, .factor = -rate};
            terms[count++].matrix[c->slot[axis]] = band;
        }
        largest = fmax(largest, bound);
    }
    c->model.dissipation = largest;
    if (!part_terms(c, terms, count)) return false;
    h->dissipation = tensor_plan_new(c->n, c->dimension, terms, count, c->threads);
    return h->dissipation != NULL;
}

void hform_dissipation_free(struct consistent *c)
{
    tensor_plan_free(c->hform->dissipation);
    for (int component = 0; component < 3; component++)
        for (int axis = 0; axis < 3; axis++)
            band_free(c->hform->smoother[component][axis]);
}

/* Energy taken a unit of time, v.M (rate sum of P) v. */
double hform_dissipation_power(struct consistent *c, const double *v)
{
    struct hform *h = c->hform;
    const size_t n = c->model.unknowns;
    if (h->dissipation == NULL) return 0;
    memset(h->work, 0, n * sizeof *h->work);
    for (size_t k = 0; k < c->n[DEPTH]; k++) {
        double *out[3] = {NULL, NULL, NULL};
        for (int component = 0; component < c->dimension; component++)
            out[component] = h->work + (size_t)component * c->volume + k * c->plane;
        tensor_plane(h->dissipation, 0, k, 1, v, out);
        for (int component = 0; component < c->dimension; component++)
            consistent_clear_held(c, component, k, out[component]);
    }
    mass_solve(c, &h->factors, h->work);
    const double density = c->weighted[WEIGHT_DENSITY] == NULL ? c->property[WEIGHT_DENSITY] : 1;
    const struct part_axis *rows = &c->part.along[1], *planes = &c->part.along[DEPTH];
    double sum = 0;
    for (size_t component = 0; component < (size_t)c->dimension; component++)
        for (size_t k = planes->own; k < planes->end; k++) {
            const size_t from = component * c->volume + k * c->plane;
            for (size_t i = from + rows->own * c->n[0]; i < from + rows->end * c->n[0]; i++)
                sum += h->work[i] * v[i];
        }
    return -density * density * sum;
}
