/* Points of a box that include points on its faces: on a lattice, with jitter and rotation, or given ones. */
#include "points/lattice.h"

#include "base/memory.h"
#include "points/cloud.h"

#include <math.h>
#include <stdint.h>

double random_uniform(unsigned long seed, unsigned long counter)
{
    uint64_t z = (uint64_t)seed * 0xd1342543de82ef95u + ((uint64_t)counter + 1) * 0x9e3779b97f4a7c15u;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    z ^= z >> 31;
    return (double)(z >> 11) * 0x1p-53;
}

int faces_count(unsigned char faces)
{
    int count = 0;
    for (unsigned mask = faces; mask != 0; mask &= mask - 1)
        count++;
    return count;
}

/* Coordinate and faces of one point along one axis. */
static double place(const struct body *body, const struct point_set *set, int axis, size_t k, size_t point,
                    unsigned char *faces)
{
    const size_t last = set->grid[axis] - 1;
    if (k == 0) {
        *faces |= (unsigned char)(1u << (2 * axis));
        return body->low[axis];
    }
    if (k == last) {
        *faces |= (unsigned char)(1u << (2 * axis + 1));
        return body->high[axis];
    }
    double x = body->low[axis] + (body->high[axis] - body->low[axis]) * (double)k / (double)last;
    if (body->jitter > 0) {
        const double random = random_uniform((unsigned long)body->seed, 3 * point + (unsigned long)axis);
        x += body->jitter * set->spacing[axis] * (2 * random - 1);
    }
    return x;
}

static selas_status allocate(struct point_set *set, struct messages *messages)
{
    set->position = array_new(3 * set->points, sizeof *set->position);
    set->own_position = array_new(3 * set->points, sizeof *set->own_position);
    set->faces = array_new(set->points, sizeof *set->faces);
    if (set->position != NULL && set->own_position != NULL && set->faces != NULL) return SELAS_OK;
    const size_t points = set->points;
    point_set_free(set);
    return fail(messages, SELAS_NO_MEMORY, "no memory for %zu points", points);
}

/* Fills the positions in deck coordinates. */
static void turn(const struct body *body, struct point_set *set)
{
    for (size_t i = 0; i < set->points; i++)
        if (body->rotated)
            body_to_deck(body, set->own_position + 3 * i, set->position + 3 * i);
        else
            for (size_t c = 0; c < 3; c++)
                set->position[3 * i + c] = set->own_position[3 * i + c];
}

selas_status lattice_create(const struct body *body, int dimension, struct point_set *set,
                            struct messages *messages)
{
    *set = (struct point_set){.dimension = dimension, .points = 1, .grid = {1, 1, 1}};
    double total = 1;
    for (int c = 0; c < dimension; c++) {
        const double length = body->high[c] - body->low[c];
        if (!(length > 0) || !(body->spacing > 0))
            return fail(messages, SELAS_BAD_SCENE, "the body needs a positive size and spacing");
        const double intervals = fmax(1, round(length / body->spacing));
        total *= intervals + 1;
        if (total > 1e15) return fail(messages, SELAS_NO_MEMORY, "%g points are too many", total);
        set->grid[c] = (size_t)intervals + 1;
        set->spacing[c] = length / intervals;
        set->points *= set->grid[c];
    }
    const selas_status status = allocate(set, messages);
    if (status != SELAS_OK) return status;
    size_t i = 0, k[3];
    for (k[2] = 0; k[2] < set->grid[2]; k[2]++)
        for (k[1] = 0; k[1] < set->grid[1]; k[1]++)
            for (k[0] = 0; k[0] < set->grid[0]; k[0]++, i++) {
                double *own = set->own_position + 3 * i;
                for (int c = 0; c < dimension; c++)
                    own[c] = place(body, set, c, k[c], i, &set->faces[i]);
            }
    turn(body, set);
    return SELAS_OK;
}

selas_status point_set_from_positions(const struct body *body, int dimension, size_t points,
                                      const double *own_position, struct point_set *set,
                                      struct messages *messages)
{
    *set = (struct point_set){.dimension = dimension, .points = points};
    const selas_status status = allocate(set, messages);
    if (status != SELAS_OK) return status;
    const double near = 1e-6 * body->spacing;
    unsigned seen = 0;
    for (int c = 0; c < dimension; c++)
        set->spacing[c] = body->spacing;
    for (size_t i = 0; i < points; i++)
        for (int c = 0; c < dimension; c++) {
            const double x = set->own_position[3 * i + (size_t)c] = own_position[3 * i + (size_t)c];
            if (!(x > body->low[c] - near && x < body->high[c] + near)) {
                point_set_free(set);
                return fail(messages, SELAS_BAD_SCENE,
                            "point %zu lies outside the box low .. high of the body (%c = %g)", i + 1,
                            "xyz"[c], x);
            }
            if (x < body->low[c] + near) set->faces[i] |= (unsigned char)(1u << (2 * c));
            if (x > body->high[c] - near) set->faces[i] |= (unsigned char)(1u << (2 * c + 1));
            seen |= set->faces[i];
        }
    for (enum face face = FACE_X_LOW; (int)face < 2 * dimension; face++)
        if ((seen >> face & 1) == 0) {
            point_set_free(set);
            return fail(messages, SELAS_BAD_SCENE,
                        "the method needs points on all faces of the body; there is none on %s",
                        face_name(face));
        }
    turn(body, set);
    const selas_status looked = points_warn_of_gaps(body, dimension, points, set->own_position, messages);
    if (looked != SELAS_OK) point_set_free(set);
    return looked;
}

void point_set_free(struct point_set *set)
{
    array_free(set->position);
    array_free(set->own_position);
    array_free(set->faces);
    *set = (struct point_set){0};
}
