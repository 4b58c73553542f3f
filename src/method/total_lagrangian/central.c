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

/* Weights of the value at place along one axis: on a mirror plane the layer next to it and the second one by
 * the even parabola; beyond the last layer the line through two; else the cubic through four (as many as
 * there are). Returns how many, from layer *first on, at most 4. */
static size_t axis_weights(const struct tl_model *tl, const double place[3], int axis, size_t *first,
                           double weight[4], double slope[4])
{
    const struct body *body = &tl->model.scene->body;
    const size_t layers = tl->cloud->grid[axis];
    const double step = step_of(tl, axis);
    const double s = (place[axis] - body->low[axis]) / step - 0.5;
    const bool beyond = s < 0 || s > (double)(layers - 1);
    size_t count = beyond ? 2 : 4;
    if (count > layers) count = layers;
    const double lowest = fmax(0, floor(s) - (count == 4 ? 1 : 0));
    *first = (size_t)fmin(lowest, (double)(layers - count));
    memset(slope, 0, 4 * sizeof *slope);
    if (beyond && count == 2 && tl_on_mirror(tl, place, axis)) { /* u = a + b x^2 through x = 1/2, 3/2 */
        const bool low = s < 0;
        weight[0] = low ? 9.0 / 8 : -1.0 / 8;
        weight[1] = low ? -1.0 / 8 : 9.0 / 8;
        return count;
    }
    for (size_t k = 0; k < count; k++) {
        weight[k] = 1;
        for (size_t l = 0; l < count; l++) {
            if (l == k) continue;
            const double across = (double)k - (double)l;
            double others = 1 / (across * step);
            for (size_t m = 0; m < count; m++)
                if (m != l && m != k) others *= (s - (double)(*first + m)) / ((double)k - (double)m);
            weight[k] *= (s - (double)(*first + l)) / across;
            slope[k] += others;
        }
    }
    return count;
}

size_t tl_lattice_probe(const struct tl_model *tl, const double place[3], size_t *index, double *weight,
                        double *gradient)
{
    size_t first[3] = {0};
    size_t many[3] = {1, 1, 1};
    double w[3][4] = {{1}, {1}, {1}};
    double g[3][4] = {{0}};
    for (int axis = 0; axis < tl->cloud->dimension; axis++)
        many[axis] = axis_weights(tl, place, axis, &first[axis], w[axis], g[axis]);
    const size_t *grid = tl->cloud->grid;
    size_t count = 0;
    for (size_t z = 0; z < many[2]; z++)
        for (size_t y = 0; y < many[1]; y++)
            for (size_t x = 0; x < many[0]; x++) {
                index[count] =
                    first[0] + x + grid[0] * (first[1] + y + grid[1] * (first[2] + z)) - tl->cloud->first;
                weight[count] = w[0][x] * w[1][y] * w[2][z];
                gradient[3 * count] = g[0][x] * w[1][y] * w[2][z];
                gradient[3 * count + 1] = w[0][x] * g[1][y] * w[2][z];
                gradient[3 * count + 2] = w[0][x] * w[1][y] * g[2][z];
                count++;
            }
    return count;
}
