/* What the ground is at the points of the general operator (doc/theory/general-ground.md, sections 1, 3 and 4). */
#include "method/consistent/general/medium.h"

#include "base/memory.h"

#include <string.h>

bool general_is_part(const struct scene *scene)
{
    return scene->whole != NULL && scene->whole != scene->material;
}

/* Weight of a point along an axis: the cell, half of it for a knot at an end. */
static double weight_of(const struct consistent *c, int slot, enum at at, size_t i)
{
    const struct spline *spline = c->layout[slot];
    if (spline == NULL) return 1;
    const double spacing = (spline->high - spline->low) / (double)spline->cells;
    if (slot == DEPTH) i += c->general->first;
    return at == AT_KNOTS && (i == 0 || i == spline->cells) ? spacing / 2 : spacing;
}

double general_weight(const struct consistent *c, const struct family *family, const size_t at[3])
{
    double weight = 1. / 3;
    for (int slot = 0; slot < 3; slot++)
        weight *= weight_of(c, slot, family->at[slot], at[slot]);
    weight += general_added(c, family->at, at);
    return weight * general_metric_at(c, family, at[0], at[1], at[2]).jacobian;
}

/* Sums over the points about each control value: weight times density, and weight. */
struct sums {
    double *mass, *even;
    bool part; /* of damped ground */
};

static void add_mass(const struct consistent *c, const struct taps *const at[3], double weight,
                     double density, const struct sums *sums) /* density: times the map's Jacobian */
{
    for (size_t k = 0; k < at[2]->count; k++)
        for (size_t j = 0; j < at[1]->count; j++)
            for (size_t i = 0; i < at[0]->count; i++) {
                const size_t to =
                    at[0]->first + i + c->n[0] * (at[1]->first + j) + c->plane * (at[2]->first + k);
                const double value = weight * at[0]->value[i] * at[1]->value[j] * at[2]->value[k];
                sums->mass[to] += value * density;
                sums->even[to] += value;
            }
}

/* Points of a family that are not isotropic, while they are found. */
struct found {
    size_t runs, room_of_runs, numbers, room_of_numbers;
};

/* Makes room for one more entry of `size` bytes behind `used` of them; false: no memory. */
static bool grow(void **array, size_t *room, size_t used, size_t more, size_t size)
{
    if (used + more <= *room) return true;
    const size_t wanted = 2 * (used + more);
    void *larger = array_new(wanted, size);
    if (larger == NULL) return false;
    if (used > 0) memcpy(larger, *array, used * size);
    array_free(*array);
    *array = larger;
    *room = wanted;
    return true;
}

/* Adds point i, the next one that is not isotropic, to the run that it goes on or to a new one. The numbers of
 * a run stand point by point until turn_runs(). */
static bool add_point(struct family *family, struct found *found, size_t row, size_t i,
                      const double stiffness[STIFFNESSES], double weight)
{
    void *runs = family->run, *numbers = family->stiffness;
    const bool good = grow(&runs, &found->room_of_runs, found->runs, 1, sizeof *family->run) &&
                      grow(&numbers, &found->room_of_numbers, found->numbers, STIFFNESSES, sizeof(double));
    family->run = runs;
    family->stiffness = numbers;
    if (!good) return false;
    struct run_of_points *last = found->runs > 0 ? &family->run[found->runs - 1] : NULL;
    if (last == NULL || found->runs == family->first_run[row] || last->from + last->count != i) {
        last = &family->run[found->runs++];
        *last = (struct run_of_points){.from = i, .at = found->numbers};
    }
    last->count++;
    for (int n = 0; n < STIFFNESSES; n++)
        family->stiffness[found->numbers++] = weight * stiffness[n];
    return true;
}

/* Brings the numbers of each run into the order of run_of_points. */
static bool turn_runs(struct family *family)
{
    size_t longest = 0;
    for (size_t r = 0; r < family->runs; r++)
        longest = family->run[r].count > longest ? family->run[r].count : longest;
    double *turned = array_new(longest * STIFFNESSES, sizeof *turned);
    for (size_t r = 0; r < family->runs && turned != NULL; r++) {
        const size_t count = family->run[r].count;
        double *numbers = family->stiffness + family->run[r].at;
        for (size_t m = 0; m < count; m++)
            for (size_t n = 0; n < STIFFNESSES; n++)
                turned[n * count + m] = numbers[m * STIFFNESSES + n];
        memcpy(numbers, turned, count * STIFFNESSES * sizeof *numbers);
    }
    array_free(turned);
    return turned != NULL;
}

static bool lay_row(struct consistent *c, struct family *family, const struct medium *medium, size_t j,
                    size_t k, struct found *found, const struct sums *sums)
{
    const size_t row = k * family->n[1] + j;
    family->first_run[row] = found->runs;
    for (size_t i = 0; i < family->n[0]; i++) {
        const size_t place[3] = {i, j, k}, point = row * family->n[0] + i;
        const struct taps *at[3];
        struct averaged averaged;
        double even = 1. / 3, lambda, mu, stiffness[STIFFNESSES];
        for (int slot = 0; slot < 3; slot++) {
            at[slot] = &c->general->taps[slot][0][family->at[slot]][place[slot]];
            even *= weight_of(c, slot, family->at[slot], place[slot]);
        }
        const struct metric metric = general_metric_at(c, family, i, j, k);
        const double weight = (even + general_added(c, family->at, place)) * metric.jacobian;
        medium_point(medium, i, j, &metric, &averaged);
        const bool turned = medium_stiffness(&averaged, stiffness, &lambda, &mu);
        if (sums->part) medium_part(&averaged, turned ? stiffness : NULL, &lambda, &mu);
        if (turned && !add_point(family, found, row, i, stiffness, weight)) return false;
        family->lambda[point] = weight * lambda;
        family->mu[point] = weight * mu;
        add_mass(c, at, even, metric.jacobian * averaged.mean[MEAN_DENSITY], sums);
    }
    return true;
}

/* The families a plane after the other, so that all see the same columns of the ground. */
static bool lay_families(struct consistent *c, struct medium *medium, const struct sums *sums)
{
    struct found found[3] = {{0}};
    struct family *family = c->general->family;
    size_t planes = 0;
    for (int f = 0; f < 3; f++) {
        family[f].first_run = array_new(family[f].n[1] * family[f].n[2] + 1, sizeof *family->first_run);
        if (family[f].first_run == NULL) return false;
        if (family[f].n[2] > planes) planes = family[f].n[2];
    }
    for (size_t k = 0; k < planes; k++)
        for (int f = 0; f < 3; f++) {
            if (k >= family[f].n[2]) continue;
            medium_plane(medium, f, k);
            for (size_t j = 0; j < family[f].n[1]; j++)
                if (!lay_row(c, &family[f], medium, j, k, &found[f], sums)) return false;
        }
    for (int f = 0; f < 3; f++) {
        family[f].runs = family[f].first_run[family[f].n[1] * family[f].n[2]] = found[f].runs;
        c->general->bytes += found[f].room_of_numbers * sizeof(double);
        if (!turn_runs(&family[f])) return false;
    }
    return true;
}

/* The integral of a control value's function. */
static double integral(const struct consistent *c, const struct band *const mass[3], size_t i)
{
    const size_t at[3] = {i % c->n[0], i / c->n[0] % c->n[1], c->part.along[DEPTH].first + i / c->plane};
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
bool general_material(struct consistent *c, double *mass)
{
    const struct band *band[3] = {NULL, NULL, NULL};
    const struct sums sums = {mass, array_new(c->volume, sizeof *mass), general_is_part(c->model.scene)};
    struct medium *medium = medium_new(c);
    bool good = sums.even != NULL && medium != NULL;
    good = good && lay_families(c, medium, &sums);
    for (int axis = 0; axis < c->dimension; axis++)
        band[c->slot[axis]] = consistent_matrix(c, axis, 0, false, 0, false, WEIGHT_NONE);
    for (size_t i = 0; good && i < c->volume; i++)
        mass[i] *= integral(c, band, i) / sums.even[i];
    if (good)
        c->general->setup_bytes = c->general->bytes + 2 * c->volume * sizeof *mass +
                                  medium_bytes(medium); /* with `mass` and `even` */
    array_free(sums.even);
    medium_free(medium);
    return good;
}
