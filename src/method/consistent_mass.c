/* Solves (M + half_step C) a = f by one banded Cholesky solve per axis (manual, section 5).
 *
 * With transmitting faces the factor of each axis is M + half_step c e e^T. Their product equals M +
 * half_step C where one such face is near; where faces of several axes meet it has terms of order half_step^2
 * more, which are symmetric and not negative: a little mass at edges. */
#include "method/consistent.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

bool mass_allocate(struct consistent *c)
{
    for (int set = 0; set < FACTOR_SETS; set++) {
        c->factors[set].half_step = NAN;
        for (int component = 0; component < c->dimension; component++)
            for (int axis = 0; axis < c->dimension; axis++) {
                const struct spline *spline = c->spline[axis];
                double *factor = array_new(spline->count * (SPLINE_MAX_DEGREE + 1), sizeof *factor);
                if (factor == NULL) return false;
                c->factors[set].factor[component][c->slot[axis]] = factor;
            }
    }
    for (int axis = 0; axis < c->dimension; axis++) {
        const struct band *mass = c->mass_band[0][axis];
        c->scratch[axis] = band_new(mass->n, mass->half);
        if (c->scratch[axis] == NULL) return false;
    }
    c->lane_buffer = array_new((size_t)c->threads * c->n[0] * LANES, sizeof *c->lane_buffer);
    return c->lane_buffer != NULL;
}

void mass_free(struct consistent *c)
{
    for (int set = 0; set < FACTOR_SETS; set++)
        for (int component = 0; component < 3; component++)
            for (int slot = 0; slot < 3; slot++)
                array_free(c->factors[set].factor[component][slot]);
    for (int axis = 0; axis < 3; axis++)
        band_free(c->scratch[axis]);
    array_free(c->lane_buffer);
}

/* Entry (i, j) of a component's 1-D mass with prescribed values cut out and the dampers of both ends in. */
static double mass_entry(const struct consistent *c, const struct band *mass, int component, int axis,
                         double half_step, size_t i, size_t j)
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
        value += half_step * c->damping[face][component] *
                 (density == NULL ? 1 : density[end == 0 ? 0 : c->spline[axis]->elements - 1]);
    }
    return value;
}

static void factorise(struct consistent *c, double half_step, int component, int axis, double *factor)
{
    const struct band *mass = c->mass_band[component][axis];
    struct band *scratch = c->scratch[axis];
    for (size_t i = 0; i < mass->n; i++) {
        const size_t from = i < mass->half ? 0 : i - mass->half;
        band_clear(scratch, i);
        for (size_t j = from; j < mass->n && j <= i + mass->half; j++)
            band_add(scratch, i, j, mass_entry(c, mass, component, axis, half_step, i, j));
    }
    band_factorise(scratch, factor); /* positive definite: a mass matrix plus what is not negative */
}

const struct mass_factors *mass_factors_for(struct consistent *c, double half_step)
{
    struct mass_factors *set = &c->factors[half_step == 0 ? 0 : half_step < DAMPERS_HOLD ? 1 : 2];
    if (set->half_step == half_step) return set;
    for (int component = 0; component < c->dimension; component++)
        for (int axis = 0; axis < c->dimension; axis++)
            factorise(c, half_step, component, axis, set->factor[component][c->slot[axis]]);
    set->half_step = half_step;
    return set;
}

static size_t half_width(const struct consistent *c, int slot)
{
    const size_t p = (size_t)c->options.degree;
    return p < c->n[slot] ? p : c->n[slot] - 1;
}

static void solve_rows(const double *factor, size_t n, size_t half, size_t rows, double *buffer,
                       double *plane)
{
    for (size_t j = 0; j < rows; j += LANES) {
        const size_t lanes = rows - j < LANES ? rows - j : LANES;
        for (size_t lane = 0; lane < lanes; lane++)
            for (size_t i = 0; i < n; i++)
                buffer[i * LANES + lane] = plane[(j + lane) * n + i];
        band_forward(factor, n, half, buffer, LANES, LANES);
        band_backward(factor, n, half, buffer, LANES, LANES);
        for (size_t lane = 0; lane < lanes; lane++)
            for (size_t i = 0; i < n; i++)
                plane[(j + lane) * n + i] = buffer[i * LANES + lane];
    }
}

void mass_solve_plane(struct consistent *c, const struct mass_factors *factors, int thread, size_t k,
                      double *a)
{
    double *buffer = c->lane_buffer + (size_t)thread * c->n[0] * LANES;
    for (int component = 0; component < c->dimension; component++) {
        double *plane = a + (size_t)component * c->volume + k * c->plane;
        const double *y = factors->factor[component][1], *x = factors->factor[component][0];
        if (y != NULL) {
            band_forward(y, c->n[1], half_width(c, 1), plane, c->n[0], c->n[0]);
            band_backward(y, c->n[1], half_width(c, 1), plane, c->n[0], c->n[0]);
        }
        if (x != NULL) solve_rows(x, c->n[0], half_width(c, 0), c->n[1], buffer, plane);
    }
}

void mass_solve_depth(struct consistent *c, const struct mass_factors *factors, double *a)
{
    enum { CHUNK = 128 };
    const size_t chunks = (c->plane + CHUNK - 1) / CHUNK, all = chunks * (size_t)c->dimension;
    const double scale = c->weighted[WEIGHT_DENSITY] == NULL ? 1 / c->property[WEIGHT_DENSITY] : 1;
#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (size_t chunk = 0; chunk < all; chunk++) {
        const size_t component = chunk / chunks, from = chunk % chunks * CHUNK;
        const size_t lanes = c->plane - from < CHUNK ? c->plane - from : CHUNK;
        double *lane = a + component * c->volume + from;
        const double *z = factors->factor[component][DEPTH];
        band_forward(z, c->n[DEPTH], half_width(c, DEPTH), lane, c->plane, lanes);
        band_backward(z, c->n[DEPTH], half_width(c, DEPTH), lane, c->plane, lanes);
        for (size_t k = 0; scale != 1 && k < c->n[DEPTH]; k++)
            for (size_t i = 0; i < lanes; i++)
                lane[k * c->plane + i] *= scale;
    }
}
