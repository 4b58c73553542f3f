/* Transmitting faces after Lysmer and Kuhlemeyer: traction = -factor rho c v (Ding et al. 2006, Eqs 31 and
 * 32), c the P speed across the face and the S speed along it:
 *
 *   C = factor rho c (e e^T) (x) M (x) M   (e e^T on the axis across the face; manual, section 5). */
#include "method/consistent/galerkin/galerkin.h"

#include "base/memory.h"

#include <string.h>

bool dampers_allocate(struct consistent *c)
{
    c->line_buffer = array_new((size_t)c->threads * (c->n[0] + c->n[1]), sizeof *c->line_buffer);
    c->face_buffer = array_new((size_t)c->dimension * c->plane, sizeof *c->face_buffer);
    return c->line_buffer != NULL && c->face_buffer != NULL;
}

/* Masses of the slots along the face, over depth the window's part; NULL where the scene has no such axis. */
static const struct band *slot_mass(const struct consistent *c, int component, int slot)
{
    if (slot == DEPTH) return c->mass_depth[component];
    for (int axis = 0; axis < c->dimension; axis++)
        if (c->slot[axis] == slot) return c->mass_band[component][axis];
    return NULL;
}

/* Density at a face across depth, or of the whole body. */
static double face_density(const struct consistent *c, int face)
{
    const double *density = c->weighted[WEIGHT_DENSITY];
    if (density == NULL) return c->property[WEIGHT_DENSITY];
    return density[face % 2 == 0 ? 0 : c->spline[face / 2]->elements - 1];
}

/* Face across slot x or y in plane k: first over depth into a line, then along the line. */
static void subtract_side(const struct consistent *c, int face, int component, size_t at, size_t k,
                          const double *v, double *line, double *out)
{
    const int slot = c->slot[face / 2];
    const size_t step = slot == 0 ? c->n[0] : 1, length = slot == 0 ? c->n[1] : c->n[0];
    const size_t from = slot == 0 ? at : at * c->n[0];
    const struct band *side = c->side[face][component]; /* has density and speed in it */
    const struct band *along = slot_mass(c, component, 1 - slot);
    const struct band *depth = side != NULL ? side : slot_mass(c, component, DEPTH);
    const double factor = side != NULL ? 1
                                       : c->property[WEIGHT_DENSITY] *
                                             c->speed[face][component][c->part.along[DEPTH].first + k];
    for (size_t j = 0; j < length; j++)
        line[j] = band_row(depth, k, v + from + j * step, c->plane);
    for (size_t j = 0; j < length; j++)
        out[from + j * step] -= factor * band_row(along, j, line, 1);
}

/* Face across depth: one whole plane. */
static void subtract_end(const struct consistent *c, int component, double factor, const double *plane,
                         double *line, double *out)
{
    const struct band *x = slot_mass(c, component, 0), *y = slot_mass(c, component, 1);
    for (size_t j = 0; j < c->n[1]; j++) {
        for (size_t i = 0; i < c->n[0]; i++)
            line[i] = band_row(y, j, plane + i, c->n[0]);
        for (size_t i = 0; i < c->n[0]; i++)
            out[j * c->n[0] + i] -= factor * band_row(x, i, line, 1);
    }
}

void dampers_subtract(const struct consistent *c, int thread, size_t k, const double *v, double *const *out)
{
    double *line = c->line_buffer + (size_t)thread * (c->n[0] + c->n[1]);
    for (int face = 0; face < 2 * c->dimension; face++) {
        if (!c->damped[face]) continue;
        const int slot = c->slot[face / 2];
        const size_t at = part_face(c, face);
        if (slot == DEPTH && k != at) continue;
        for (int component = 0; component < c->dimension; component++) {
            const double *field = v + (size_t)component * c->volume;
            if (slot == DEPTH)
                subtract_end(c, component,
                             face_density(c, face) *
                                 c->speed[face][component][c->part.along[DEPTH].first + k],
                             field + k * c->plane, line, out[component]);
            else
                subtract_side(c, face, component, at, k, field, line, out[component]);
        }
    }
}

double dampers_power(const struct consistent *c, const double *v)
{
    if (!c->model.damped) return 0;
    double power = 0, *out[3] = {NULL, NULL, NULL};
    for (int component = 0; component < c->dimension; component++)
        out[component] = c->face_buffer + (size_t)component * c->plane;
    for (size_t k = c->part.along[DEPTH].own; k < c->part.along[DEPTH].end; k++) {
        memset(c->face_buffer, 0, (size_t)c->dimension * c->plane * sizeof *c->face_buffer);
        dampers_subtract(c, 0, k, v, out);
        for (int component = 0; component < c->dimension; component++)
            for (size_t i = 0; i < c->plane; i++)
                power -= out[component][i] * v[(size_t)component * c->volume + k * c->plane + i];
    }
    return power;
}
