/* What the ground is at the points of the general operator (doc/general-ground.md, sections 2 to 4). */
#include "method/consistent/general/general.h"

#include "base/memory.h"

/* Weight of a point along an axis: the cell, half of it for a knot at an end. */
static double weight_of(const struct consistent *c, int slot, enum at at, size_t i)
{
    const struct spline *spline = c->layout[slot];
    if (spline == NULL) return 1;
    const double spacing = (spline->high - spline->low) / (double)spline->cells;
    return at == AT_KNOTS && (i == 0 || i == spline->cells) ? spacing / 2 : spacing;
}

/* weight * density and weight to the control values that a point moves. */
static void add_mass(const struct consistent *c, const struct taps *const at[3], double weight,
                     double density, double *mass, double *even)
{
    for (size_t k = 0; k < at[2]->count; k++)
        for (size_t j = 0; j < at[1]->count; j++)
            for (size_t i = 0; i < at[0]->count; i++) {
                const size_t to =
                    at[0]->first + i + c->n[0] * (at[1]->first + j) + c->plane * (at[2]->first + k);
                const double value = weight * at[0]->value[i] * at[1]->value[j] * at[2]->value[k];
                mass[to] += value * density;
                even[to] += value;
            }
}

static void lay_family(struct consistent *c, struct family *family, double *mass, double *even)
{
    const struct general *g = c->general;
    const struct material *material = &c->model.scene->material[c->model.scene->body.material];
    size_t point = 0;
    for (size_t k = 0; k < family->n[2]; k++)
        for (size_t j = 0; j < family->n[1]; j++)
            for (size_t i = 0; i < family->n[0]; i++, point++) {
                const size_t place[3] = {i, j, k};
                const struct taps *at[3];
                double weight = 1. / 3;
                for (int slot = 0; slot < 3; slot++) {
                    at[slot] = &g->taps[slot][0][family->at[slot]][place[slot]];
                    weight *= weight_of(c, slot, family->at[slot], place[slot]);
                }
                family->lambda[point] = weight * material->plane_lambda;
                family->mu[point] = weight * material->mu;
                add_mass(c, at, weight, material->density, mass, even);
            }
}

/* The integral of a control value's function. */
static double integral(const struct consistent *c, const struct band *const mass[3], size_t i)
{
    const size_t at[3] = {i % c->n[0], i / c->n[0] % c->n[1], i / c->plane};
    double product = 1;
    for (int slot = 0; slot < 3; slot++) {
        double sum = mass[slot] == NULL;
        for (size_t d = 0; mass[slot] != NULL && d <= 2 * mass[slot]->half; d++)
            sum += mass[slot]->value[d * mass[slot]->n + at[slot]];
        product *= sum;
    }
    return product;
}

/* The points' mean of the density about each control value, times the exact integral of its function: where
 * faces meet the points' own sum is not exact for an even ground. */
selas_status general_material(struct consistent *c, double *mass, struct messages *messages)
{
    const struct band *band[3] = {NULL, NULL, NULL};
    double *even = array_new(c->volume, sizeof *even);
    if (even == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the ground");
    for (int f = 0; f < 3; f++)
        lay_family(c, &c->general->family[f], mass, even);
    for (int axis = 0; axis < c->dimension; axis++)
        band[c->slot[axis]] = consistent_matrix(c, axis, 0, false, 0, false, WEIGHT_NONE);
    for (size_t i = 0; i < c->volume; i++)
        mass[i] *= integral(c, band, i) / even[i];
    array_free(even);
    return SELAS_OK;
}
