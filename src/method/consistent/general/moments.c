/* Memory of forces in absorbing layers (see the header). */
#include "method/consistent/general/moments.h"
#include "method/consistent/general/general.h"

#include "base/machine.h"
#include "base/memory.h"

#include <math.h>

/* Row i of (G13a): d = a x^2 at x beyond the face. Next to the face the difference goes outwards alone, since the
 * forces within it are not the layer's. The last two splines reach the held end and are others: d_i alone. */
static void lay_row(struct moment_rows *rows, size_t i, bool high, double a, double x, double h)
{
    const size_t from_face = high ? i : rows->count - 1 - i;
    double *outer = high ? rows->above : rows->below, *inner = high ? rows->below : rows->above;
    rows->own[i] = a * x * x;
    if (from_face + 2 >= rows->count) return;
    const double slope = a * x * h / 4;
    rows->own[i] += a * h * h / 4;
    if (from_face == 0) {
        rows->own[i] -= 2 * slope;
        outer[i] = 2 * slope;
    } else {
        outer[i] = slope;
        inner[i] = -slope;
    }
}

bool moment_rows_lay(struct moment_rows *rows, const struct consistent *c, const struct slab *slab)
{
    const struct spline *spline = c->spline[slab->axis];
    const double thickness = slab->end == 0 ? slab->edge - spline->low : spline->high - slab->edge;
    const double h = thickness / (double)c->layer[2 * slab->axis + slab->end];
    double **const all[] = {&rows->below, &rows->own, &rows->above, &rows->left, &rows->pivot};
    rows->count = slab->inside.n[c->slot[slab->axis]];
    for (size_t k = 0; k < sizeof all / sizeof *all; k++)
        if ((*all[k] = array_new(rows->count, sizeof(double))) == NULL) return false;
    for (size_t i = 0; i < rows->count; i++)
        lay_row(rows, i, slab->end == 1, slab->most / (thickness * thickness),
                thickness * sqrt(slab->damping[i] / slab->most), h);
    return true;
}

void moment_rows_free(struct moment_rows *rows)
{
    array_free(rows->below);
    array_free(rows->own);
    array_free(rows->above);
    array_free(rows->left);
    array_free(rows->pivot);
}

/* 1 + dt/2 (alpha + D) = L U. */
void moment_rows_eliminate(struct moment_rows *rows, const struct slab *slab, double dt)
{
    for (size_t i = 0; i < rows->count; i++) {
        rows->pivot[i] = 1 + dt / 2 * (slab->relaxation + rows->own[i]);
        if (i == 0) continue;
        rows->left[i] = dt / 2 * rows->below[i] / rows->pivot[i - 1];
        rows->pivot[i] -= rows->left[i] * dt / 2 * rows->above[i - 1];
    }
}

/* Lanes `beside` each other, count values each, `own` apart:
 * (1 + dt/2 (alpha + D)) middle = phi - dt/2 D f,  phi := 2 middle - phi. */
INLINED void move_lanes(const struct moment_rows *rows, double dt, size_t lanes, const size_t beside,
                        size_t own, const double *restrict force, double *restrict phi,
                        double *restrict middle)
{
    const size_t count = rows->count;
    for (size_t i = 0; i < count; i++) {
        const double *f = force + i * own, *before = i > 0 ? f - own : f,
                     *after = i + 1 < count ? f + own : f;
        double *m = middle + i * own;
        const double below = dt / 2 * rows->below[i], at = dt / 2 * rows->own[i],
                     above = dt / 2 * rows->above[i], left = rows->left[i];
        for (size_t k = 0; k < lanes * beside; k += beside)
            m[k] = phi[i * own + k] - (below * before[k] + at * f[k] + above * after[k]);
        for (size_t k = 0; i > 0 && k < lanes * beside; k += beside)
            m[k] -= left * m[k - own];
    }
    for (size_t i = count; i-- > 0;) {
        double *m = middle + i * own, *p = phi + i * own;
        const double above = dt / 2 * rows->above[i], part = 1 / rows->pivot[i];
        for (size_t k = 0; i + 1 < count && k < lanes * beside; k += beside)
            m[k] -= above * m[k + own];
        for (size_t k = 0; k < lanes * beside; k += beside) {
            m[k] *= part;
            p[k] = 2 * m[k] - p[k];
        }
    }
}

size_t moment_rows_lines(const struct consistent *c, const struct slab *slab)
{
    return slab->inside.n[c->slot[slab->axis] == DEPTH ? 1 : DEPTH];
}

void moment_rows_move(const struct consistent *c, const struct moment_rows *rows, const struct slab *slab,
                      double dt, size_t moments, size_t component, size_t line, double *extra)
{
    const struct block *in = &slab->inside;
    const int slot = c->slot[slab->axis];
    const size_t plane = in->n[0] * in->n[1],
                 at = component * slab->inner + line * (slot == DEPTH ? in->n[0] : plane);
    double *force = c->general->pulled + moments + at, *middle = c->general->middle + moments + at;
    if (slot == 0)
        move_lanes(rows, dt, in->n[1], in->n[0], 1, force, extra + slab->phi + at, middle);
    else
        move_lanes(rows, dt, in->n[0], 1, slot == 1 ? in->n[0] : plane, force, extra + slab->phi + at,
                   middle);
}
