/* Loads and moving faces of the H-form: M^-1 F, made once (manual, section 8). */
#include "method/consistent/galerkin/hform.h"

#include "base/memory.h"

#include <string.h>

/* Where a component of a sparse vector is not 0; empty: all 0. */
static struct footprint footprint_of(const struct consistent *c, const struct sparse *sparse, int component)
{
    struct footprint extent = {.from = {c->n[0], c->n[1], c->n[2]}};
    for (size_t p = 0; p < sparse->planes; p++) {
        const size_t k = sparse->plane[p] % c->n[DEPTH];
        if (sparse->plane[p] / c->n[DEPTH] != (size_t)component) continue;
        for (size_t e = sparse->start[p]; e < sparse->start[p + 1]; e++) {
            const size_t at[3] = {sparse->index[e] % c->n[0], sparse->index[e] / c->n[0], k};
            for (int slot = 0; slot < 3; slot++) {
                if (at[slot] < extent.from[slot]) extent.from[slot] = at[slot];
                if (at[slot] >= extent.to[slot]) extent.to[slot] = at[slot] + 1;
            }
        }
    }
    return extent;
}

/* N along one axis of a component, over the density where that is the same everywhere and the axis the first;
 * the field is 0 out of the extent, which grows. False: no memory. */
static bool divide_along(struct consistent *c, int component, int axis, struct footprint *extent,
                         double *field, double *line)
{
    const struct band *inverse = part_matrix(c, c->slot[axis], c->hform->inverse[component][axis]);
    if (inverse == NULL) return false;
    const double density = c->weighted[WEIGHT_DENSITY] == NULL && axis == 0 ? c->property[WEIGHT_DENSITY] : 1;
    const size_t stride[3] = {1, c->n[0], c->plane};
    const int slot = c->slot[axis], one = slot == 0 ? 1 : 0, other = slot == 2 ? 1 : 2;
    size_t *from = &extent->from[slot], *to = &extent->to[slot];
    *from = *from < inverse->half ? 0 : *from - inverse->half;
    *to = *to + inverse->half < c->n[slot] ? *to + inverse->half : c->n[slot];
    for (size_t k = extent->from[other]; k < extent->to[other]; k++)
        for (size_t j = extent->from[one]; j < extent->to[one]; j++) {
            double *first = field + (size_t)component * c->volume + j * stride[one] + k * stride[other];
            for (size_t i = *from; i < *to; i++)
                line[i] = band_row(inverse, i, first, stride[slot]) / density;
            for (size_t i = *from; i < *to; i++)
                first[i * stride[slot]] = line[i];
        }
    return true;
}

/* wide := M^-1 sparse (N along each axis). */
static bool widen(struct consistent *c, const struct sparse *sparse, struct dense *field, double *line,
                  struct sparse *wide)
{
    for (int component = 0; component < c->dimension; component++) {
        struct footprint *extent = &field->footprint[component];
        *extent = footprint_of(c, sparse, component);
        for (size_t k = extent->from[DEPTH]; k < extent->to[DEPTH]; k++)
            sparse_add(c, sparse, component, k, 1,
                       field->value + (size_t)component * c->volume + k * c->plane);
        for (int axis = 0; axis < c->dimension && extent->to[0] > 0; axis++)
            if (!divide_along(c, component, axis, extent, field->value, line)) return false;
    }
    return sparse_take(c, field, wide);
}

bool hform_forces(struct consistent *c)
{
    struct hform *h = c->hform;
    const size_t loads = c->model.scene->loads;
    double *line = array_new(c->n[0] + c->n[1] + c->n[2], sizeof *line);
    struct dense field = {.value = h->work};
    memset(h->work, 0, c->model.unknowns * sizeof *h->work);
    bool good = line != NULL && sparse_list_new(&h->load, loads);
    for (size_t l = 0; good && l < loads; l++)
        good = widen(c, &c->load.of[l], &field, line, &h->load.of[l]);
    if (good) good = sparse_list_sort(c, &h->load);
    for (int face = 0; good && face < 2 * c->dimension; face++)
        if (c->moving[face]) good = widen(c, &c->inertia[face], &field, line, &h->pulled[face]);
    array_free(line);
    return good;
}
