/* Vectors of loads and moving faces: what is not zero of a field, plane by plane. */
#include "method/consistent/galerkin/galerkin.h"

#include "base/memory.h"

void dense_widen(struct dense *field, int component, const struct footprint *there)
{
    struct footprint *all = &field->footprint[component];
    if (all->to[0] == 0) *all = *there;
    for (int slot = 0; slot < 3; slot++) {
        if (there->from[slot] < all->from[slot]) all->from[slot] = there->from[slot];
        if (there->to[slot] > all->to[slot]) all->to[slot] = there->to[slot];
    }
}

void dense_whole(const struct consistent *c, struct dense *field)
{
    for (int component = 0; component < c->dimension; component++)
        field->footprint[component] = (struct footprint){.to = {c->n[0], c->n[1], c->n[2]}};
}

/* What is not 0 of the rows of plane k that lie within; `sparse` NULL: only counted. Else `field` is 0 there. */
static size_t take_plane(const struct consistent *c, const struct footprint *within, size_t entries,
                         struct sparse *sparse, double *plane)
{
    for (size_t j = within->from[1]; j < within->to[1]; j++)
        for (size_t i = within->from[0]; i < within->to[0]; i++) {
            const size_t at = j * c->n[0] + i;
            if (plane[at] == 0) continue;
            if (sparse != NULL) {
                sparse->index[entries] = at;
                sparse->value[entries] = plane[at];
                plane[at] = 0;
            }
            entries++;
        }
    return entries;
}

bool sparse_take(const struct consistent *c, struct dense *field, struct sparse *sparse)
{
    size_t planes = 0, entries = 0;
    for (int component = 0; component < c->dimension; component++) {
        const struct footprint *within = &field->footprint[component];
        double *first = field->value + (size_t)component * c->volume;
        for (size_t k = within->from[DEPTH]; k < within->to[DEPTH]; k++) {
            const size_t after = take_plane(c, within, entries, NULL, first + k * c->plane);
            planes += after > entries;
            entries = after;
        }
    }
    *sparse = (struct sparse){.plane = array_new(planes, sizeof *sparse->plane),
                              .start = array_new(planes + 1, sizeof *sparse->start),
                              .index = array_new(entries, sizeof *sparse->index),
                              .value = array_new(entries, sizeof *sparse->value)};
    if (sparse->plane == NULL || sparse->start == NULL || sparse->index == NULL || sparse->value == NULL)
        return false;
    entries = 0;
    for (int component = 0; component < c->dimension; component++) {
        struct footprint *within = &field->footprint[component];
        double *first = field->value + (size_t)component * c->volume;
        for (size_t k = within->from[DEPTH]; k < within->to[DEPTH]; k++) {
            const size_t after = take_plane(c, within, entries, sparse, first + k * c->plane);
            if (after == entries) continue;
            sparse->plane[sparse->planes++] = (size_t)component * c->n[DEPTH] + k;
            sparse->start[sparse->planes] = entries = after;
        }
        *within = (struct footprint){{0}, {0}};
    }
    return true;
}

void sparse_free(struct sparse *sparse)
{
    array_free(sparse->plane);
    array_free(sparse->start);
    array_free(sparse->index);
    array_free(sparse->value);
    *sparse = (struct sparse){0};
}

size_t sparse_bytes(const struct sparse *sparse)
{
    if (sparse->start == NULL) return 0;
    return (2 * sparse->planes + 1) * sizeof(size_t) +
           sparse->start[sparse->planes] * (sizeof(size_t) + sizeof(double));
}

bool sparse_list_new(struct sparse_list *list, size_t count)
{
    list->of = array_new(count, sizeof *list->of);
    list->count = list->of != NULL ? count : 0;
    return list->of != NULL;
}

bool sparse_list_sort(const struct consistent *c, struct sparse_list *list)
{
    const size_t planes = (size_t)c->dimension * c->n[DEPTH];
    size_t all = 0;
    for (size_t l = 0; l < list->count; l++)
        all += list->of[l].planes;
    array_free(list->start);
    array_free(list->number);
    array_free(list->part);
    list->start = array_new(planes + 2, sizeof *list->start);
    list->number = array_new(all, sizeof *list->number);
    list->part = array_new(all, sizeof *list->part);
    if (list->start == NULL || list->number == NULL || list->part == NULL) return false;
    size_t *next =
        list->start + 1; /* of a plane: first how many are in those before, then where its next one goes */
    for (size_t l = 0; l < list->count; l++)
        for (size_t p = 0; p < list->of[l].planes; p++)
            next[list->of[l].plane[p] + 1]++;
    for (size_t plane = 0; plane < planes; plane++)
        next[plane + 1] += next[plane];
    for (size_t l = 0; l < list->count; l++)
        for (size_t p = 0; p < list->of[l].planes; p++) {
            const size_t at = next[list->of[l].plane[p]]++;
            list->number[at] = l;
            list->part[at] = p;
        }
    return true;
}

void sparse_list_free(struct sparse_list *list)
{
    for (size_t l = 0; l < list->count; l++)
        sparse_free(&list->of[l]);
    array_free(list->of);
    array_free(list->start);
    array_free(list->number);
    array_free(list->part);
}

size_t sparse_list_bytes(const struct consistent *c, const struct sparse_list *list)
{
    size_t bytes = 0, planes = list->start != NULL ? (size_t)c->dimension * c->n[DEPTH] + 2 : 0;
    for (size_t l = 0; l < list->count; l++) {
        bytes += sparse_bytes(&list->of[l]);
        planes += 2 * list->of[l].planes;
    }
    return bytes + planes * sizeof(size_t);
}

static void add_part(const struct sparse *sparse, size_t part, double factor, double *plane)
{
    for (size_t e = sparse->start[part]; e < sparse->start[part + 1]; e++)
        plane[sparse->index[e]] += factor * sparse->value[e];
}

void sparse_add(const struct consistent *c, const struct sparse *sparse, int component, size_t k,
                double factor, double *plane)
{
    for (size_t p = 0; p < sparse->planes; p++)
        if (sparse->plane[p] == (size_t)component * c->n[DEPTH] + k) add_part(sparse, p, factor, plane);
}

void add_forces(const struct consistent *c, const struct drive *drive, const struct sparse_list *load,
                const struct sparse *pull, int component, size_t k, double *plane)
{
    const struct scene *scene = c->model.scene;
    const size_t at = (size_t)component * c->n[DEPTH] + k;
    for (size_t i = load->start[at]; drive->load != NULL && i < load->start[at + 1]; i++) {
        const size_t l = load->number[i];
        if (drive->load[l] != 0)
            add_part(&load->of[l], load->part[i], drive->load[l] * scene->load[l].amplitude, plane);
    }
    for (int face = 0; drive->motion != NULL && face < 2 * c->dimension; face++)
        if (c->moving[face]) sparse_add(c, &pull[face], component, k, -drive->motion[face], plane);
}

double sparse_dot(const struct consistent *c, const struct sparse *sparse, const double *field)
{
    double sum = 0;
    for (size_t p = 0; p < sparse->planes; p++) {
        const size_t plane = sparse->plane[p], k = plane % c->n[DEPTH];
        if (k < c->part.along[DEPTH].own || k >= c->part.along[DEPTH].end) continue;
        for (size_t e = sparse->start[p]; e < sparse->start[p + 1]; e++)
            if (c->part.ranks == NULL || part_owns(&c->part, sparse->index[e] / c->n[0], k))
                sum += sparse->value[e] * field[plane * c->plane + sparse->index[e]];
    }
    return sum;
}
