/* Vectors of loads and moving faces: what is not zero of a field, plane by plane. */
#include "method/consistent/galerkin/galerkin.h"

#include "base/memory.h"

static size_t count_of(size_t n, const double *field)
{
    size_t count = 0;
#pragma omp simd reduction(+ : count)
    for (size_t i = 0; i < n; i++)
        count += field[i] != 0;
    return count;
}

bool sparse_from(const struct consistent *c, const double *field, struct sparse *sparse)
{
    const size_t planes = (size_t)c->dimension * c->n[DEPTH];
    sparse->start = array_new(planes + 1, sizeof *sparse->start);
    if (sparse->start == NULL) return false;
    for (size_t plane = 0; plane < planes; plane++)
        sparse->start[plane + 1] = sparse->start[plane] + count_of(c->plane, field + plane * c->plane);
    sparse->index = array_new(sparse->start[planes], sizeof *sparse->index);
    sparse->value = array_new(sparse->start[planes], sizeof *sparse->value);
    if (sparse->index == NULL || sparse->value == NULL) return false;
    for (size_t plane = 0; plane < planes; plane++) {
        size_t at = sparse->start[plane];
        for (size_t i = 0; at < sparse->start[plane + 1]; i++) {
            if (field[plane * c->plane + i] == 0) continue;
            sparse->index[at] = i;
            sparse->value[at++] = field[plane * c->plane + i];
        }
    }
    return true;
}

void sparse_free(struct sparse *sparse)
{
    array_free(sparse->start);
    array_free(sparse->index);
    array_free(sparse->value);
}

void sparse_add(const struct consistent *c, const struct sparse *sparse, int component, size_t k,
                double factor, double *plane)
{
    const size_t at = (size_t)component * c->n[DEPTH] + k;
    for (size_t e = sparse->start[at]; e < sparse->start[at + 1]; e++)
        plane[sparse->index[e]] += factor * sparse->value[e];
}

void add_forces(const struct consistent *c, const struct drive *drive, const struct sparse *load,
                const struct sparse *pull, int component, size_t k, double *plane)
{
    const struct scene *scene = c->model.scene;
    for (size_t l = 0; drive->load != NULL && l < scene->loads; l++)
        if (drive->load[l] != 0)
            sparse_add(c, &load[l], component, k, drive->load[l] * scene->load[l].amplitude, plane);
    for (int face = 0; drive->motion != NULL && face < 2 * c->dimension; face++)
        if (c->moving[face]) sparse_add(c, &pull[face], component, k, -drive->motion[face], plane);
}

double sparse_dot(const struct consistent *c, const struct sparse *sparse, const double *field)
{
    double sum = 0;
    for (size_t component = 0; component < (size_t)c->dimension; component++)
        for (size_t k = c->part.along[DEPTH].own; k < c->part.along[DEPTH].end; k++) {
            const size_t plane = component * c->n[DEPTH] + k;
            for (size_t e = sparse->start[plane]; e < sparse->start[plane + 1]; e++)
                if (part_owns(&c->part, sparse->index[e] / c->n[0], k))
                    sum += sparse->value[e] * field[plane * c->plane + sparse->index[e]];
        }
    return sum;
}

size_t sparse_bytes(const struct consistent *c, const struct sparse *sparse)
{
    const size_t planes = (size_t)c->dimension * c->n[DEPTH];
    if (sparse->start == NULL) return 0;
    return (planes + 1) * sizeof(size_t) + sparse->start[planes] * (sizeof(size_t) + sizeof(double));
}
