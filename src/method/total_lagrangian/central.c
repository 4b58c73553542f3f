/* Total-Lagrangian SPH on lattices with gradient = 'central': central differences, of fourth order
 * inside, of second in the second layer, one-sided first differences in the layer next to a free face; and
 * the weights of receivers.
 *
 * Least-squares gradients near a face take their neighbours from a wide half-ball; along the face they are
 * low-passes, so that short waves of the surface cost hardly any energy (doc/theory/sph-total-lagrangian.md, section
 * 10, has the flexibility of the surface). Differences along the axes are not: the derivative along the face
 * is the interior's, the one across it the first difference, whose adjoint load on the last layers, (17, -5,
 * 1, -1) / 12, is close to (3/2, -1/2), the transpose of the linear extrapolation by which a receiver reads
 * the face. */
#include "method/total_lagrangian/total_lagrangian.h"

#include <math.h>
#include <string.h>

/* Spacing of the lattice along an axis. */
static double step_of(const struct tl_model *tl, int axis)
{
    const struct body *body = &tl->model.scene->body;
    return (body->high[axis] - body->low[axis]) / (double)tl->cloud->grid[axis];
}

/* Sites on the line through i along an axis, one and two steps below and above: 1 + site, 0 where there is
 * none. Order: -2, -1, 1, 2. */
static void sites_along(const struct tl_model *tl, const uint32_t *near, size_t count, size_t i, int axis,
                        size_t beside[4])
{
    const double step = step_of(tl, axis);
    memset(beside, 0, 4 * sizeof *beside);
    for (size_t k = 0; k < count; k++) {
        const size_t j = near[k];
        double steps = 0;
        bool along = true;
        for (int c = 0; c < 3; c++) {
            const double away = tl->site_position[3 * j + (size_t)c] - tl->site_position[3 * i + (size_t)c];
            if (c == axis)
                steps = away / step;
            else
                along = along && fabs(away) < 1e-6 * step;
        }
        const double whole = round(steps);
        if (!along || whole == 0 || fabs(whole) > 2 || fabs(steps - whole) > 1e-6) continue;
        beside[whole < 0 ? (size_t)(whole + 2) : (size_t)(whole + 1)] = j + 1;
    }
}

size_t tl_central_row(const struct tl_model *tl, const uint32_t *near, size_t found, size_t i,
                      uint32_t *index, double *gradient)
{
    static const double fourth[4] = {1.0 / 12, -8.0 / 12, 8.0 / 12, -1.0 / 12};
    static const double second[4] = {0, -0.5, 0.5, 0};
    static const double ahead[4] = {0, 0, 1, 0};
    static const double behind[4] = {0, -1, 0, 0};
    size_t count = 0;
    for (int axis = 0; axis < tl->cloud->dimension; axis++) {
        size_t beside[4];
        sites_along(tl, near, found, i, axis, beside);
        if (beside[1] == 0 && beside[2] == 0) return 0;
        const double *row = beside[1] == 0 ? ahead : beside[2] == 0 ? behind : second;
        if (row == second && beside[0] != 0 && beside[3] != 0) row = fourth;
        for (size_t k = 0; k < 4; k++) {
            if (row[k] == 0) continue;
            memset(gradient + 3 * count, 0, 3 * sizeof *gradient);
            gradient[3 * count + (size_t)axis] = row[k] / step_of(tl, axis);
            index[count++] = (uint32_t)(beside[k] - 1);
        }
    }
    return count;
}

bool tl_on_mirror(const struct tl_model *tl, const double place[3], int axis)
{
    const struct scene *scene = tl->model.scene;
    for (int side = 0; side < 2; side++) {
        const double plane = face_plane(&scene->body, (enum face)(2 * axis + side));
        if (boundary_slides(&scene->boundary[2 * axis + side]) &&
            fabs(place[axis] - plane) < 1e-6 * scene->body.spacing)
            return true;
    }
    return false;
}

/* Layers of points and ghosts along an axis at one place. */
struct layers {
    ptrdiff_t from, end, first; /* of all there are; the first of those taken */
    size_t count;               /* of those taken */
    double weight[4], slope[4];
};

/* Weights of the value at place along one axis: the cubic through four layers (as many as there are). Of points alone
 * (ghosts false) on a mirror plane the layer next to it and the second one by the even parabola, beyond the last layer
 * the line through two. */
static void axis_weights(const struct tl_model *tl, const double place[3], int axis, bool ghosts,
                         struct layers *to)
{
    const struct body *body = &tl->model.scene->body;
    const double step = step_of(tl, axis);
    const double s = (place[axis] - body->low[axis]) / step - 0.5;
    to->from = ghosts && tl->mirrors[2 * axis] ? -2 : 0;
    to->end = (ptrdiff_t)tl->cloud->grid[axis] + (ghosts && tl->mirrors[2 * axis + 1] ? 2 : 0);
    const bool beyond = s < (double)to->from || s > (double)(to->end - 1);
    to->count = beyond ? 2 : 4;
    if ((ptrdiff_t)to->count > to->end - to->from) to->count = (size_t)(to->end - to->from);
    const double lowest = fmax((double)to->from, floor(s) - (to->count == 4 ? 1 : 0));
    to->first = (ptrdiff_t)fmin(lowest, (double)(to->end - (ptrdiff_t)to->count));
    memset(to->slope, 0, sizeof to->slope);
    if (beyond && to->count == 2 && tl_on_mirror(tl, place, axis)) { /* u = a + b x^2 through x = 1/2, 3/2 */
        const bool low = s < 0;
        to->weight[0] = low ? 9.0 / 8 : -1.0 / 8;
        to->weight[1] = low ? -1.0 / 8 : 9.0 / 8;
        return;
    }
    for (size_t k = 0; k < to->count; k++) {
        to->weight[k] = 1;
        for (size_t l = 0; l < to->count; l++) {
            if (l == k) continue;
            const double across = (double)k - (double)l;
            double others = 1 / (across * step);
            for (size_t m = 0; m < to->count; m++)
                if (m != l && m != k)
                    others *= (s - (double)(to->first + (ptrdiff_t)m)) / ((double)k - (double)m);
            to->weight[k] *= (s - (double)(to->first + (ptrdiff_t)l)) / across;
            to->slope[k] += others;
        }
    }
}

/* Point or ghost of the lattice; SIZE_MAX: none here. */
static size_t site_at(const struct tl_model *tl, const ptrdiff_t at[3])
{
    const struct body *body = &tl->model.scene->body;
    const size_t *grid = tl->cloud->grid;
    bool inside = true;
    for (int axis = 0; axis < 3; axis++)
        inside = inside && at[axis] >= 0 && at[axis] < (ptrdiff_t)grid[axis];
    if (inside) return (size_t)at[0] + grid[0] * ((size_t)at[1] + grid[1] * (size_t)at[2]) - tl->cloud->first;
    for (size_t site = tl->cloud->points; site < tl->sites; site++) {
        bool same = true;
        for (int axis = 0; axis < 3 && axis < tl->cloud->dimension; axis++) {
            const double step = step_of(tl, axis);
            const double x = body->low[axis] + ((double)at[axis] + 0.5) * step;
            same = same && fabs(tl->site_position[3 * site + (size_t)axis] - x) < 1e-3 * step;
        }
        if (same) return site;
    }
    return SIZE_MAX;
}

size_t tl_lattice_probe(const struct tl_model *tl, const double place[3], bool ghosts, size_t *index,
                        double *weight, double *gradient)
{
    struct layers along[3];
    for (int axis = 0; axis < 3; axis++) {
        along[axis] = (struct layers){.end = 1, .count = 1, .weight = {1}};
        if (axis < tl->cloud->dimension) axis_weights(tl, place, axis, ghosts, &along[axis]);
    }
    const struct layers *x = &along[0], *y = &along[1], *z = &along[2];
    const size_t all = x->count * y->count * z->count;
    for (size_t k = 0; k < all; k++) {
        const size_t i = k % x->count, j = k / x->count % y->count, l = k / (x->count * y->count);
        const ptrdiff_t at[3] = {x->first + (ptrdiff_t)i, y->first + (ptrdiff_t)j, z->first + (ptrdiff_t)l};
        index[k] = site_at(tl, at);
        if (index[k] == SIZE_MAX) return 0;
        weight[k] = x->weight[i] * y->weight[j] * z->weight[l];
        gradient[3 * k] = x->slope[i] * y->weight[j] * z->weight[l];
        gradient[3 * k + 1] = x->weight[i] * y->slope[j] * z->weight[l];
        gradient[3 * k + 2] = x->weight[i] * y->weight[j] * z->slope[l];
    }
    return all;
}
