/* The mass of the general operator (doc/theory/general-ground.md, section 3): M_R = R^1/2 N^-1 R^1/2, R such that an
 * exact M in the place of N^-1 has the row sums of the mass of the ground,
 *
 *   R^1/2 M R^1/2 1 = m,                                                                              (G5)
 *
 * by r := sqrt(r m / (M r)), r = R^1/2 (Sinkhorn's scaling for symmetric matrices). */
#include "method/consistent/general/general.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

enum { MOST_ROUNDS = 60 };
static const double still = 1e-14;

/* The mass of an even ground of density 1, one component. */
static struct tensor_plan *even_mass(struct consistent *c)
{
    struct tensor_term term = {.factor = 1};
    for (int axis = 0; axis < c->dimension; axis++) {
        term.matrix[c->slot[axis]] = consistent_matrix(c, axis, 0, false, 0, false, WEIGHT_NONE);
        if (term.matrix[c->slot[axis]] == NULL) return NULL;
    }
    return part_terms(c, &term, 1) ? tensor_plan_new(c->n, 1, &term, 1, 1) : NULL;
}

bool general_scale(struct consistent *c, const double *mass)
{
    double *root = c->general->root, *product = array_new(c->volume, sizeof *product);
    struct tensor_plan *plan = even_mass(c);
    const bool mine = product != NULL && plan != NULL, good = part_largest(c, mine ? 0 : 1) == 0 && mine;
    const struct part_fields fields = part_values(c, root, 1, sizeof *root);
    double change = 1;
    for (size_t i = 0; i < c->volume; i++)
        root[i] = 1;
    for (int round = 0; good && round < MOST_ROUNDS && change > still; round++) {
        memset(product, 0, c->volume * sizeof *product);
        for (size_t k = 0; k < c->n[DEPTH]; k++) {
            double *out[3] = {product + k * c->plane, NULL, NULL};
            tensor_plane(plan, 0, k, 1, root, out);
        }
        change = 0;
        for (size_t i = 0; i < c->volume; i++) {
            const size_t k = i / c->plane;
            const double next = sqrt(root[i] * mass[i] / product[i]);
            if (k >= c->part.along[DEPTH].own && k < c->part.along[DEPTH].end)
                change = fmax(change, fabs(next / root[i] - 1));
            root[i] = next;
        }
        part_exchange(c, &fields);
        change = part_largest(c, change);
    }
    for (size_t i = 0; i < c->volume; i++)
        root[i] = 1 / root[i];
    tensor_plan_free(plan);
    array_free(product);
    return good;
}
