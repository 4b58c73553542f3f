/* Transmitting faces of the H-form (manual, sections 8 and 9).
 *
 * Dampers, one face: (M + h C)^-1 M = I - (h c / (1 + h c n_e)) n e^T on the axis across, n = N e, so that
 *   a := a - c n v_e;   a := a - h c n a_e',   a_e' = a_e / (1 + h c n_e),
 * only the planes that N reaches from the face. Faces of several axes: all velocities first, then the factors
 * one after the other, as in the exact-mass form. */
#include "method/consistent/galerkin/hform.h"

#include <string.h>

/* Points of a face across a slot: lane i of plane k, at index `at` across, stands at i * lane + k * plane +
 * at * across in a component, and at k * lanes + i among face values. */
struct face_points {
    size_t planes, lanes, lane, plane, across;
};

static struct face_points face_points(const struct consistent *c, int slot)
{
    if (slot == 0) return (struct face_points){c->n[2], c->n[1], c->n[0], c->plane, 1};
    if (slot == 1) return (struct face_points){c->n[2], c->n[0], 1, c->plane, c->n[0]};
    return (struct face_points){1, c->plane, 1, 0, c->plane};
}

/* (0 where the face is not in the window.) */
static void gather(const struct face_points *face, size_t at, const double *field, double *values)
{
    if (at == SIZE_MAX) memset(values, 0, face->planes * face->lanes * sizeof *values);
    for (size_t k = 0; k < face->planes && at != SIZE_MAX; k++)
        for (size_t i = 0; i < face->lanes; i++)
            values[k * face->lanes + i] = field[i * face->lane + k * face->plane + at * face->across];
}

/* field -= column (x) face values, over the column's reach. */
static void spread(const struct consistent *c, int axis, int end, const double *column, const double *values,
                   double *field)
{
    const struct face_points face = face_points(c, c->slot[axis]);
    const size_t n = c->n[c->slot[axis]], reach = c->hform->reach[axis];
    const size_t from = end == 0 ? 0 : n - reach, first = c->part.along[c->slot[axis]].first;
    if (part_face(c, 2 * axis + end) == SIZE_MAX) return;
    for (size_t k = 0; k < face.planes; k++)
        for (size_t at = from; at < from + reach; at++)
            for (size_t i = 0; i < face.lanes; i++)
                field[i * face.lane + k * face.plane + at * face.across] -=
                    column[first + at] * values[k * face.lanes + i];
}

/* Rows of a face across x or y in the order of the other end. */
static void turn_rows(size_t rows, size_t lanes, double *values)
{
    for (size_t row = 0; row < rows / 2; row++)
        for (size_t i = 0; i < lanes; i++) {
            const double value = values[row * lanes + i];
            values[row * lanes + i] = values[(rows - 1 - row) * lanes + i];
            values[(rows - 1 - row) * lanes + i] = value;
        }
}

/* With layers the speeds of a face across x or y vary over depth. With N = U U^T over depth, U upper
 * triangular, C = (e e^T) (x) H (x) U^-T diag(c) U^-1 is symmetric and positive, and everything is pointwise
 * in U^-1 v. The factor is that of the matrix turned round (lower), hence the turned rows. */
static void to_diagonal(const struct consistent *c, int slot, int component, double *values)
{
    const double *upper = c->hform->upper[component];
    if (upper == NULL || slot == DEPTH) return;
    const size_t n = c->n[DEPTH], lanes = c->n[1 - slot];
    turn_rows(n, lanes, values);
    band_forward(upper, n, c->hform->upper_half, values, lanes, lanes);
    turn_rows(n, lanes, values);
}

static void from_diagonal(const struct consistent *c, int slot, int component, double *values)
{
    const double *upper = c->hform->upper[component];
    if (upper == NULL || slot == DEPTH) return;
    const size_t n = c->n[DEPTH], lanes = c->n[1 - slot];
    turn_rows(n, lanes, values);
    band_lower_multiply(upper, n, c->hform->upper_half, values, lanes, lanes);
    turn_rows(n, lanes, values);
}

/* Speed of a damped face's component in plane k, 0 if the face is not damped; over depth the columns of N
 * have the density in them. */
static double damping(const struct consistent *c, int axis, int end, int component, size_t k)
{
    const int face = 2 * axis + end;
    if (!c->damped[face]) return 0;
    const double *density = c->slot[axis] == DEPTH ? c->weighted[WEIGHT_DENSITY] : NULL;
    k = c->slot[axis] != DEPTH ? c->part.along[DEPTH].first + k
        : end == 0             ? 0
                               : c->part.along[DEPTH].whole - 1;
    return c->speed[face][component][k] *
           (density == NULL ? 1 : density[end == 0 ? 0 : c->spline[axis]->elements - 1]);
}

static void subtract_velocities(struct consistent *c, int axis, int component, const double *v, double *a)
{
    const int slot = c->slot[axis];
    const struct face_points face = face_points(c, slot);
    for (int end = 0; end < 2; end++) {
        if (!c->damped[2 * axis + end]) continue;
        double *values = c->hform->face[0];
        gather(&face, part_face(c, 2 * axis + end), v, values);
        to_diagonal(c, slot, component, values);
        for (size_t k = 0; k < face.planes; k++)
            for (size_t i = 0; i < face.lanes; i++)
                values[k * face.lanes + i] *= damping(c, axis, end, component, k);
        from_diagonal(c, slot, component, values);
        spread(c, axis, end, c->hform->column[component][axis][end], values, a);
    }
}

/* Solves the 2 x 2 equations of both ends' values, then takes h c n a_e' off. */
static void implicit_part(struct consistent *c, int axis, int component, double half_step, double *a)
{
    double *const *column = c->hform->column[component][axis], *const *value = c->hform->face;
    const int slot = c->slot[axis];
    const struct face_points face = face_points(c, slot);
    const size_t last = c->spline[axis]->count - 1;
    if (!c->damped[2 * axis] && !c->damped[2 * axis + 1]) return;
    gather(&face, part_face(c, 2 * axis), a, value[0]);
    gather(&face, part_face(c, 2 * axis + 1), a, value[1]);
    to_diagonal(c, slot, component, value[0]);
    to_diagonal(c, slot, component, value[1]);
    for (size_t k = 0; k < face.planes; k++) {
        const double low = half_step * damping(c, axis, 0, component, k);
        const double high = half_step * damping(c, axis, 1, component, k);
        const double m00 = 1 + low * column[0][0], m01 = high * column[1][0];
        const double m10 = low * column[0][last], m11 = 1 + high * column[1][last];
        const double determinant = m00 * m11 - m01 * m10;
        for (size_t p = k * face.lanes; p < (k + 1) * face.lanes; p++) {
            const double a0 = value[0][p], a1 = value[1][p];
            value[0][p] = low * (m11 * a0 - m01 * a1) / determinant;
            value[1][p] = high * (m00 * a1 - m10 * a0) / determinant;
        }
    }
    for (int end = 0; end < 2; end++) {
        if (!c->damped[2 * axis + end]) continue;
        from_diagonal(c, slot, component, value[end]);
        spread(c, axis, end, column[end], value[end], a);
    }
}

void hform_dampers(struct consistent *c, double half_step, const double *v, double *a)
{
    for (int component = 0; component < c->dimension; component++) {
        const size_t from = (size_t)component * c->volume;
        for (int axis = 0; v != NULL && axis < c->dimension; axis++)
            subtract_velocities(c, axis, component, v + from, a + from);
        for (int axis = 0; half_step != 0 && axis < c->dimension; axis++)
            implicit_part(c, axis, component, half_step, a + from);
    }
}

/* A face that ranks share would cost a solve from rank to rank at every step. */
static bool told(const struct consistent *c, int face)
{
    const size_t at = part_face(c, face);
    if (c->part.ranks == NULL) return true;
    return c->slot[face / 2] == DEPTH && at >= c->part.along[DEPTH].own && at < c->part.along[DEPTH].end;
}

/* rho c v_e.(H (x) H) v_e: the masses of the face's own axes, one banded solve each. */
double hform_damper_power(struct consistent *c, const double *v)
{
    double power = 0;
    double *values = c->hform->face[0], *weighed = c->hform->face[1];
    if (c->model.untold) return 0;
    for (int face = 0; face < 2 * c->dimension; face++) {
        if (!c->damped[face] || !told(c, face)) continue;
        const int slot = c->slot[face / 2], across = slot == 0 ? 1 : 0, outer = slot == DEPTH ? 1 : DEPTH;
        const struct face_points points = face_points(c, slot);
        const size_t inner = c->n[across], rows = c->n[outer];
        const size_t at = part_face(c, face);
        for (int component = 0; component < c->dimension; component++) {
            gather(&points, at, v + (size_t)component * c->volume, values);
            to_diagonal(c, slot, component, values);
            const bool diagonal = c->hform->upper[component] != NULL && slot != DEPTH;
            memcpy(weighed, values, points.planes * points.lanes * sizeof *values);
            for (int axis = 0; axis < c->dimension; axis++) {
                const double *factor = c->hform->factor[component][axis];
                const size_t half = c->hform->inverse[component][axis]->half;
                if (c->slot[axis] == DEPTH && diagonal) continue;
                if (c->slot[axis] == outer) {
                    band_forward(factor, rows, half, weighed, inner, inner);
                    band_backward(factor, rows, half, weighed, inner, inner);
                } else if (c->slot[axis] == across)
                    for (size_t row = 0; row < rows; row++) {
                        band_forward(factor, inner, half, weighed + row * inner, 1, 1);
                        band_backward(factor, inner, half, weighed + row * inner, 1, 1);
                    }
            }
            double sum = 0;
            for (size_t k = 0; k < points.planes; k++) {
                const double speed = damping(c, face / 2, face % 2, component, k);
                for (size_t p = k * points.lanes; p < (k + 1) * points.lanes; p++)
                    sum += speed * values[p] * weighed[p];
            }
            power += (c->weighted[WEIGHT_DENSITY] == NULL ? c->property[WEIGHT_DENSITY] : 1) * sum;
        }
    }
    return power;
}
