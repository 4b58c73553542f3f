/* Wavenumbers of a band of frequencies (doc/theory/seismograms.md, Eqs 32-35). All poles and branch points lie on
 * k = -i s/c, a ray that leaves the real axis at the angle eta/omega, or farther from it where the ground is
 * damped. Gauss panels of half width b at the distance b/x from them err by rho^-24, rho = x + sqrt(1 + x^2).
 */
#include "base/memory.h"
#include "exact/gauss12.h"
#include "exact/half_space.h"
#include "exact/seismogram_work.h"

#include <math.h>

enum { PANEL = 12 };

void band_set(struct band *band, const struct seismogram_problem *problem, double complex low,
              double complex high)
{
    *band = (struct band){.low = low, .high = high, .from = INFINITY, .angle = M_PI};
    for (size_t i = 0; i < problem->rocks; i++) {
        const struct seismogram_rock *rock = &problem->rock[i];
        struct half_space alone;
        half_space_set(&alone, rock->density, rock->axial.size - 2 * rock->shear.size, rock->shear.size);
        const double complex p_low = -I * low * csqrt(rock->density / modulus_at(&rock->axial, low));
        const double complex p_high = -I * high * csqrt(rock->density / modulus_at(&rock->axial, high));
        const double complex s_high = -I * high * csqrt(rock->density / modulus_at(&rock->shear, high));
        band->from = fmin(band->from, cabs(p_low));
        band->to = fmax(band->to, cabs(s_high) * alone.s_speed / alone.rayleigh_speed);
        band->angle = fmin(band->angle, fmin(-carg(p_high), -carg(s_high)));
    }
}

/* Distance of a real wavenumber from the singularities of a band. */
static double clearance(const struct band *band, double k)
{
    const double t = fmin(fmax(k * cos(band->angle), band->from), band->to);
    return hypot(k - t * cos(band->angle), t * sin(band->angle));
}

/* Real part of the exponent with which what is between two depths fades. */
static double fading(const struct seismogram_problem *problem, double complex s, double k, double from,
                     double to)
{
    double sum = 0;
    for (size_t i = 0; i < problem->rocks; i++) {
        const struct seismogram_rock *rock = &problem->rock[i];
        const double bottom = i + 1 < problem->rocks ? rock[1].top : INFINITY;
        const double thickness = fmin(to, bottom) - fmax(from, rock->top);
        if (thickness > 0)
            sum += thickness * creal(csqrt(k * k + s * s * rock->density / modulus_at(&rock->shear, s)));
    }
    return sum;
}

/* Where exp(-fading) has fallen to exp(-digits). */
static double faded_at(const struct seismogram_problem *problem, const struct band *band, double from,
                       double to, double digits)
{
    double low = 0, high = hypot(band->to, digits / (to - from));
    while (fading(problem, band->high, high, from, to) < digits)
        high *= 1.5;
    for (int i = 0; i < 30; i++) {
        const double k = .5 * (low + high);
        if (fading(problem, band->high, k, from, to) < digits)
            low = k;
        else
            high = k;
    }
    return high;
}

void path_range(struct path *path, const struct seismogram_problem *problem, const struct strata *strata,
                const struct band *band, double digits)
{
    const double one = strata->depth[strata->source[path->source_level]];
    const double other = strata->depth[strata->receiver[path->receiver_level]];
    path->end = path->centre = INFINITY;
    path->width = 0;
    if (one != other) path->end = faded_at(problem, band, fmin(one, other), fmax(one, other), digits);
    double centre = 0, half = 0;
    if (path->patch) {
        const struct patch *patch = &path->source->patch;
        const double edge = 2 * fmin(patch->half[0], patch->half[1]);
        half = 80 / edge;
        centre = 1.5 * band->to + 400 / edge - half;
    } else {
        half = 2 * digits / path->distance;
        centre = 1.02 * band->to + half;
    }
    if (!(centre + half < path->end)) return;
    path->centre = centre;
    path->width = half / sqrt(digits);
    path->end = centre + half;
}

static bool add_panel(struct wavenumbers *grid, double from, double width)
{
    if (grid->nodes + PANEL > grid->room) {
        const size_t room = 2 * grid->room + 64 * PANEL;
        struct wavenumbers wider = {grid->nodes, room, array_new(room, sizeof(double)),
                                    array_new(room, sizeof(double))};
        if (wider.k == NULL || wider.weight == NULL) {
            wavenumbers_free(&wider);
            return false;
        }
        for (size_t i = 0; i < grid->nodes; i++) {
            wider.k[i] = grid->k[i];
            wider.weight[i] = grid->weight[i];
        }
        wavenumbers_free(grid);
        *grid = wider;
    }
    for (size_t i = 0; i < PANEL; i++) {
        grid->k[grid->nodes] = from + .5 * width * (1 + gauss12_node[i]);
        grid->weight[grid->nodes++] = .5 * width * gauss12_weight[i];
    }
    return true;
}

bool wavenumbers_set(struct wavenumbers *grid, const struct band *band, double reach, double end,
                     struct finesse finesse)
{
    const double near = 2 / (sinh(finesse.digits / 24) * finesse.finer), wave = 12 / (reach * finesse.finer);
    grid->nodes = 0;
    for (double k = 0; k < end;) {
        double width = fmin(wave, near * clearance(band, k));
        width = fmin(width, near * fmin(clearance(band, k + .5 * width), clearance(band, k + width)));
        if (!add_panel(grid, k, width)) return false;
        k += width;
    }
    return true;
}

void wavenumbers_free(struct wavenumbers *grid)
{
    array_free(grid->k);
    array_free(grid->weight);
    *grid = (struct wavenumbers){0};
}
