/* Solves (M + half_step C) a = f by one banded Cholesky solve per axis (manual, section 5).
 *
 * With transmitting faces the factor of each axis is M + half_step c e e^T. Their product equals M +
 * half_step C where one such face is near; where faces of several axes meet it has terms of order half_step^2
 * more, which are symmetric and not negative: a little mass at edges. Order of the solves: forward over
 * depth, x and y in each plane, backward over depth, so that the factors of x and y may differ from plane to
 * plane. */
#include "method/consistent/galerkin/galerkin.h"

#include "base/memory.h"

#include <math.h>
#include <omp.h>

/* Entry (i, j) of a component's 1-D mass with prescribed values cut out and, in planes like `plane`, the
 * dampers of both ends in. */
static double mass_entry(const struct consistent *c, const struct band *mass, int component, int axis,
                         double half_step, size_t plane, size_t i, size_t j)
{
    const size_t last = mass->n - 1;
    for (int end = 0; end < 2; end++) {
        const size_t at = end == 0 ? 0 : last;
        if (c->held[component][2 * axis + end] && (i == at || j == at)) return i == j ? 1 : 0;
    }
    double value = band_get(mass, i, j);
    for (int end = 0; end < 2; end++) {
        const int face = 2 * axis + end;
        const size_t at = end == 0 ? 0 : last;
        if (!c->damped[face] || i != at || j != at) continue;
        const double *density = c->slot[axis] == DEPTH ? c->weighted[WEIGHT_DENSITY] : NULL;
        value += half_step * c->speed[face][component][c->slot[axis] == DEPTH ? at : plane] *
                 (density == NULL ? 1 : density[end == 0 ? 0 : c->spline[axis]->elements - 1]);
    }
    return value;
}

static void factorise(struct consistent *c, double half_step, int component, int axis, size_t plane,
                      double *factor)
{
    const struct band *mass = c->mass_band[component][axis];
    struct band *scratch = c->scratch[axis];
    for (size_t i = 0; i < mass->n; i++) {
        const size_t from = i < mass->half ? 0 : i - mass->half;
        band_clear(scratch, i);
        for (size_t j = from; j < mass->n && j <= i + mass->half; j++)
            band_add(scratch, i, j, mass_entry(c, mass, component, axis, half_step, plane, i, j));
    }
    band_factorise(scratch, factor); /* positive definite: a mass matrix plus what is not negative */
}

const struct mass_factors *mass_factors_for(struct consistent *c, double half_step)
{
    struct mass_factors *set = &c->factors[half_step == 0 ? 0 : half_step < DAMPERS_HOLD ? 1 : 2];
    if (set->half_step == half_step) return set;
    for (int component = 0; component < c->dimension; component++)
        for (int axis = 0; axis < c->dimension; axis++) {
            const int slot = c->slot[axis];
            if (slot == DEPTH) {
                factorise(c, half_step, component, axis, 0, set->depth[component]);
                continue;
            }
            for (size_t class = 0; class < c->classes; class ++)
                factorise(c, half_step, component, axis, c->class_plane[class],
                          set->side[class][component][slot]);
        }
    set->half_step = half_step;
    return set;
}

static size_t half_width(const struct consistent *c, int slot)
{
    for (int axis = 0; axis < c->dimension; axis++)
        if (c->slot[axis] == slot) return c->mass_band[0][axis]->half;
    return 0;
}

static void solve_rows(const double *factor, size_t n, size_t half, size_t rows, double *buffer,
                       double *plane)
{
    for (size_t j = 0; j < rows; j += LINES) {
        const size_t lanes = rows - j < LINES ? rows - j : LINES;
        for (size_t lane = 0; lane < lanes; lane++)
            for (size_t i = 0; i < n; i++)
                buffer[i * LINES + lane] = plane[(j + lane) * n + i];
        band_forward(factor, n, half, buffer, LINES, LINES);
        band_backward(factor, n, half, buffer, LINES, LINES);
        for (size_t lane = 0; lane < lanes; lane++)
            for (size_t i = 0; i < n; i++)
                plane[(j + lane) * n + i] = buffer[i * LINES + lane];
    }
}

/* Along x, and along y if the rank has all rows. */
static void solve_plane(const struct consistent *c, const struct mass_factors *factors, int thread, size_t k,
                        double *a)
{
    double *buffer = c->lane_buffer + (size_t)thread * c->n[0] * LINES;
    for (int component = 0; component < c->dimension; component++) {
        double *plane = a + (size_t)component * c->volume + k * c->plane;
        double *const *side = factors->side[c->plane_class[c->part.along[DEPTH].first + k]][component];
        if (side[1] != NULL && !part_rows(&c->part)) {
            band_forward(side[1], c->n[1], factors->half[1], plane, c->n[0], c->n[0]);
            band_backward(side[1], c->n[1], factors->half[1], plane, c->n[0], c->n[0]);
        }
        if (side[0] != NULL) solve_rows(side[0], c->n[0], factors->half[0], c->n[1], buffer, plane);
    }
}

/* One half of the solves over depth or rows. */
struct part_solve {
    const struct consistent *c;
    const struct mass_factors *factors;
    bool forward;
    double *a;
};

/* Planes from .. end - 1, for chunks of a plane. */
static void solve_planes(void *context, size_t from_plane, size_t end_plane)
{
    enum { CHUNK = 128 };
    const struct part_solve *solve = context;
    const struct consistent *c = solve->c;
    const struct mass_factors *factors = solve->factors;
    const struct band_rows rows = {c->part.along[DEPTH].whole, c->part.along[DEPTH].first, from_plane,
                                   end_plane};
    const size_t chunks = (c->plane + CHUNK - 1) / CHUNK, all = chunks * (size_t)c->dimension;
    const double scale = c->weighted[WEIGHT_DENSITY] == NULL ? 1 / c->property[WEIGHT_DENSITY] : 1;
#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (size_t chunk = 0; chunk < all; chunk++) {
        const size_t component = chunk / chunks, from = chunk % chunks * CHUNK;
        const size_t lanes = c->plane - from < CHUNK ? c->plane - from : CHUNK;
        double *lane = solve->a + component * c->volume + from;
        if (!solve->forward) {
            band_backward_rows(factors->depth[component], &rows, factors->half[DEPTH], lane, c->plane, lanes);
            continue;
        }
        /* before the sweep, whose last planes the next rank goes on with */
        for (size_t k = from_plane; scale != 1 && k < end_plane; k++)
            for (size_t i = 0; i < lanes; i++)
                lane[k * c->plane + i] *= scale;
        band_forward_rows(factors->depth[component], &rows, factors->half[DEPTH], lane, c->plane, lanes);
    }
}

/* Rows from .. end - 1 of own planes. */
static void solve_along_y(void *context, size_t from, size_t end)
{
    const struct part_solve *solve = context;
    const struct consistent *c = solve->c;
    const struct part_axis *y = &c->part.along[1], *z = &c->part.along[DEPTH];
    const struct band_rows rows = {y->whole, y->first, from, end};
#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (size_t k = z->own; k < z->end; k++)
        for (size_t component = 0; component < 3; component++) {
            const double *factor = solve->factors->side[c->plane_class[z->first + k]][component][1];
            double *plane = solve->a + component * c->volume + k * c->plane;
            (solve->forward ? band_forward_rows : band_backward_rows)(factor, &rows, solve->factors->half[1],
                                                                      plane, c->n[0], c->n[0]);
        }
}

static void solve_over(const struct consistent *c, int slot, const struct mass_factors *factors, bool forward,
                       double *a)
{
    struct part_solve solve = {c, factors, forward, a};
    const struct part_fields fields = part_values(c, a, (size_t)c->dimension, sizeof *a);
    part_sweep(c, slot, forward, factors->half[slot], &fields, slot == DEPTH ? solve_planes : solve_along_y,
               &solve);
}

void mass_solve(struct consistent *c, const struct mass_factors *factors, double *a)
{
    solve_over(c, DEPTH, factors, true, a);
    for (int back = 0; back < 2 && part_rows(&c->part); back++)
        solve_over(c, 1, factors, back == 0, a);
#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (size_t k = c->part.along[DEPTH].own; k < c->part.along[DEPTH].end; k++)
        solve_plane(c, factors, omp_get_thread_num(), k, a);
    solve_over(c, DEPTH, factors, false, a);
}

/* With layers the dampers of a face across x or y vary over depth: with M = L L^T over depth and diag(c) the
 * speeds at the planes, L diag(c) L^T stands for the integral of rho c N_a N_b (symmetric, positive, and
 * equal to c M where c is constant), because it keeps the solve a product (manual, section 5). */
static bool lay_sides(struct consistent *c)
{
    if (c->weighted[WEIGHT_DENSITY] == NULL) return true;
    const struct mass_factors *factors = mass_factors_for(c, 0);
    const size_t n = c->part.along[DEPTH].whole, half = half_width(c, DEPTH);
    for (int face = 0; face < 2 * c->dimension; face++)
        for (int component = 0; component < c->dimension; component++) {
            if (!c->damped[face] || c->slot[face / 2] == DEPTH) continue;
            const double *factor = factors->depth[component], *speed = c->speed[face][component];
            struct band *side = band_new(n, half);
            if (side == NULL) return false;
            for (size_t m = 0; m < n; m++)
                for (size_t i = m; i < n && i <= m + half; i++)
                    for (size_t j = m; j < n && j <= m + half; j++) {
                        const double left = i == m ? 1 / factor[m] : factor[(i - m) * n + i];
                        const double right = j == m ? 1 / factor[m] : factor[(j - m) * n + j];
                        band_add(side, i, j, left * speed[m] * right);
                    }
            c->side[face][component] = band_cut(side, c->part.along[DEPTH].first, c->n[DEPTH]);
            band_free(side);
            if (c->side[face][component] == NULL) return false;
        }
    return true;
}

bool mass_allocate(struct consistent *c)
{
    for (int axis = 0; axis < c->dimension; axis++) {
        const struct band *mass = c->mass_band[0][axis];
        c->scratch[axis] = band_new(mass->n, mass->half);
        if (c->scratch[axis] == NULL) return false;
    }
    for (int set = 0; set < FACTOR_SETS; set++) {
        struct mass_factors *factors = &c->factors[set];
        factors->half_step = NAN;
        for (int slot = 0; slot < 3; slot++)
            factors->half[slot] = half_width(c, slot);
        factors->side = array_new(c->classes, sizeof *factors->side);
        if (factors->side == NULL) return false;
        for (int component = 0; component < c->dimension; component++)
            for (int axis = 0; axis < c->dimension; axis++) {
                const int slot = c->slot[axis];
                const size_t numbers = c->spline[axis]->count * (factors->half[slot] + 1);
                for (size_t class = 0; class < (slot == DEPTH ? 1 : c->classes); class ++) {
                    double *factor = array_new(numbers, sizeof *factor);
                    if (factor == NULL) return false;
                    if (slot == DEPTH)
                        factors->depth[component] = factor;
                    else
                        factors->side[class][component][slot] = factor;
                }
            }
    }
    c->lane_buffer = array_new((size_t)c->threads * c->n[0] * LINES, sizeof *c->lane_buffer);
    return c->lane_buffer != NULL && lay_sides(c);
}

void mass_free(struct consistent *c)
{
    for (int set = 0; set < FACTOR_SETS; set++) {
        struct mass_factors *factors = &c->factors[set];
        for (int component = 0; component < 3; component++) {
            array_free(factors->depth[component]);
            for (size_t class = 0; factors->side != NULL && class < c->classes; class ++)
                for (int slot = 0; slot < 2; slot++)
                    array_free(factors->side[class][component][slot]);
        }
        array_free(factors->side);
    }
    for (int face = 0; face < BOX_FACES; face++)
        for (int component = 0; component < 3; component++)
            band_free(c->side[face][component]);
    for (int axis = 0; axis < 3; axis++)
        band_free(c->scratch[axis]);
    array_free(c->lane_buffer);
}
