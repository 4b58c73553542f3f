/* Which part of its planes the fused operator works on (fused.h), for numbers of type REAL; included by
 * fused_double.c and fused_single.c.
 *
 * Where displacements are below a level they move nothing. The largest of each column and of each strip of
 * rows of a plane are taken while it is in the cache; the window of a block of planes is the smallest that
 * holds all columns and strips above the level, of these planes and those within reach, and what they reach
 * along x and y. */
#include "method/consistent/absorbing/pml.h"
#include "method/consistent/fused/kernels.h"
#include "method/spline/passes.h"

#include <math.h>
#include <string.h>

/* Numbers that rows and windows are whole numbers of: not less than passes along x reach. */
enum { FUSED_LANES = FUSED_VECTOR / sizeof(REAL) };

static REAL *columns_of(const struct fused *f, size_t k)
{
    return (REAL *)f->column + k * f->n[0];
}

static REAL *strips_of(const struct fused *f, size_t k)
{
    return (REAL *)f->strip + k * f->strips;
}

static void forget_sizes(const struct fused *f, size_t k)
{
    f->size[k] = 0;
    memset(columns_of(f, k), 0, f->n[0] * sizeof(REAL));
    memset(strips_of(f, k), 0, f->strips * sizeof(REAL));
}

/* Brings the fields that relax on. */
static void relax_rows(const struct fused *f, const struct fused_fields *fields, size_t n, size_t rows,
                       size_t at)
{
    const size_t length = n == f->n[0] ? rows * n : n, end = at + rows * f->n[0]; /* whole rows as one */
    for (size_t from = at; from < end; from += n == f->n[0] ? length : f->n[0]) {
        REAL *field[FUSED_FIELDS_KEPT];
        for (size_t k = 0; k < fields->relax->fields; k++)
            field[k] = (REAL *)fields->kept[k] + from;
        NAME(taken_fused_kernels)
        ()->relax(length, fields->relax, (const REAL *)fields->a + from, field, NULL);
    }
}

/* Brings rows of u on; gives the largest. */
static REAL move_rows(const struct fused *f, const struct fused_fields *fields, size_t n, size_t rows,
                      size_t at, REAL *column)
{
    const struct NAME(fused_kernels) *kernels = NAME(taken_fused_kernels)();
    const REAL *w = (const REAL *)fields->a + at;
    REAL *u = (REAL *)fields->moved + at;
    if (fields->relax == NULL) return kernels->drift(n, rows, f->n[0], (REAL)fields->dt, w, u, column);
    relax_rows(f, fields, n, rows, at);
    return kernels->measure(n, rows, f->n[0], u, column);
}

/* Numbers of plane k of a field u or, with `fields`, of their u brought on: a window of it. */
static void take_sizes(const struct fused *f, size_t k, const struct window *window,
                       const struct fused_fields *fields, const REAL *u)
{
    const struct NAME(fused_kernels) *kernels = NAME(taken_fused_kernels)();
    const size_t n = window->end[0] - window->from[0];
    REAL *column = columns_of(f, k) + window->from[0], *strip = strips_of(f, k);
    if (window_points(window) == 0) return;
    for (size_t j = window->from[1]; j < window->end[1];) {
        const size_t s = j / FUSED_STRIP, end = (s + 1) * FUSED_STRIP;
        const size_t rows = (end < window->end[1] ? end : window->end[1]) - j;
        for (size_t component = 0; component < 3; component++) {
            const size_t at = component * f->volume + k * f->plane + j * f->n[0] + window->from[0];
            const REAL size = fields == NULL ? kernels->measure(n, rows, f->n[0], u + at, column)
                                             : move_rows(f, fields, n, rows, at, column);
            if (size > strip[s]) strip[s] = size;
        }
        if (strip[s] > f->size[k]) f->size[k] = strip[s];
        j += rows;
    }
}

/* Velocities in a window of plane k where layers damp them besides. */
static void drag_rows(const struct fused *f, const struct fused_fields *fields, size_t k,
                      const struct window *window)
{
    for (size_t s = 0; fields->dragged != NULL && s < fields->dragged->slabs; s++) {
        const struct slab *slab = &fields->dragged->slab[s];
        const size_t *at = slab->inside.at, *n = slab->inside.n;
        const struct window inside = {{at[0], at[1]}, {at[0] + n[0], at[1] + n[1]}};
        const struct window both = window_meet(window, &inside);
        if (slab->drag == NULL || k < at[2] || k >= at[2] + n[2] || window_points(&both) == 0) continue;
        for (size_t j = both.from[1]; j < both.end[1]; j++) {
            const size_t place[3] = {both.from[0], j, k};
            const double *kept = slab->kept + place[slab->axis] - at[slab->axis];
            for (size_t component = 0; component < 3; component++)
                NAME(taken_fused_kernels)
            ()->keep(both.end[0] - both.from[0], kept, slab->axis == 0,
                     (REAL *)fields->a + component * f->volume + k * f->plane + j * f->n[0] + both.from[0]);
        }
    }
}

/* Velocities where layers damp them besides, before they move anything. */
static void drag_planes(const struct fused *f, const struct fused_fields *fields)
{
#pragma omp parallel for num_threads(f->threads) schedule(static)
    for (size_t k = 0; k < f->n[2]; k++)
        drag_rows(f, fields, k, &f->reached[k]);
}

/* Brings u on in a window of plane k, as far as waves have reached. */
static void bring_on(const struct fused *f, const struct fused_fields *fields, size_t k,
                     const struct window *window)
{
    const struct window both = window_meet(window, &f->reached[k]);
    take_sizes(f, k, &both, fields, NULL);
}

static void bring_planes(const struct fused *f, const struct fused_fields *fields, size_t from, size_t end)
{
    const struct window whole = fused_whole(f);
    for (size_t k = from; k < end; k++)
        bring_on(f, fields, k, &whole);
}

/* from .. end grow to hold all numbers above the level. */
static void widen(size_t n, const REAL *size, REAL level, size_t *from, size_t *end)
{
    size_t first = 0, last = n;
    while (first < *from && !(size[first] > level))
        first++;
    while (last > *end && !(size[last - 1] > level))
        last--;
    *from = first;
    *end = last;
}

/* Columns and strips above the level in planes from .. end - 1. */
struct loud {
    size_t column[2], strip[2];
};

static void widen_loud(const struct fused *f, double level, size_t from, size_t end, struct loud *loud)
{
    for (size_t k = from; k < end && k < f->n[2]; k++) {
        if (!(f->size[k] > level)) continue;
        widen(f->n[0], columns_of(f, k), (REAL)level, &loud->column[0], &loud->column[1]);
        widen(f->strips, strips_of(f, k), (REAL)level, &loud->strip[0], &loud->strip[1]);
    }
}

static struct loud nothing_loud(const struct fused *f)
{
    return (struct loud){{f->n[0], 0}, {f->strips, 0}};
}

static size_t less(size_t a, size_t b)
{
    return a > b ? a - b : 0;
}

/* What is reached from there, in whole vectors and strips, of what is computed here; strips of the body. */
static struct window window_of(const struct fused *f, const struct loud *loud)
{
    const size_t reach = (size_t)f->deep / 2, first = f->rows.first, whole[2] = {f->n[0], f->rows.whole};
    const struct window own = fused_own(f);
    struct window w = {{0, 0}, {0, 0}};
    if (f->quiet <= 0) return own;
    if (loud->column[0] >= loud->column[1] || loud->strip[0] >= loud->strip[1]) return w;
    const size_t end[2] = {loud->column[1] + reach, loud->strip[1] * FUSED_STRIP + reach};
    w.from[0] = less(loud->column[0], reach) / FUSED_LANES * FUSED_LANES;
    w.from[1] = less(loud->strip[0] * FUSED_STRIP, reach) / FUSED_STRIP * FUSED_STRIP;
    w.end[0] = (end[0] + FUSED_LANES - 1) / FUSED_LANES * FUSED_LANES;
    w.end[1] = (end[1] + FUSED_STRIP - 1) / FUSED_STRIP * FUSED_STRIP;
    for (int axis = 0; axis < 2; axis++)
        if (w.end[axis] > whole[axis]) w.end[axis] = whole[axis];
    w.from[1] = less(w.from[1], first);
    w.end[1] = less(w.end[1], first);
    return window_meet(&w, &own);
}

/* Together, where ranks share rows: sets computed[] by what is loud in the rows of all. */
static void meet_loud(struct fused *f, double level)
{
    const size_t reach = (size_t)f->deep / 2, strips = f->rows.first / FUSED_STRIP;
    const size_t first_block = f->planes.first / FUSED_PLANES;
    const size_t blocks = (f->planes.whole + FUSED_PLANES - 1) / FUSED_PLANES;
    for (size_t i = 0; i < 4 * blocks; i++)
        f->loud[i] = -INFINITY;
    for (size_t first = f->planes.own; first < f->planes.end; first += FUSED_PLANES) {
        double *bound = f->loud + 4 * (first_block + first / FUSED_PLANES);
        struct loud loud = nothing_loud(f);
        widen_loud(f, level, less(first, reach), first + FUSED_PLANES + reach, &loud);
        if (loud.column[0] >= loud.column[1] || loud.strip[0] >= loud.strip[1]) continue;
        bound[0] = -(double)loud.column[0];
        bound[1] = (double)loud.column[1];
        bound[2] = -(double)(loud.strip[0] + strips);
        bound[3] = (double)(loud.strip[1] + strips);
    }
    if (f->quiet > 0) ranks_largest(f->ranks, 4 * blocks, f->loud);
    for (size_t first = f->planes.own; first < f->planes.end; first += FUSED_PLANES) {
        const double *bound = f->loud + 4 * (first_block + first / FUSED_PLANES);
        struct loud loud = nothing_loud(f);
        if (bound[1] > 0)
            loud =
                (struct loud){{(size_t)-bound[0], (size_t)bound[1]}, {(size_t)-bound[2], (size_t)bound[3]}};
        f->computed[first / FUSED_PLANES] = window_of(f, &loud);
    }
}

/* The largest displacement, those of all planes being taken (0 where quiet is 0). */
static double all_sizes(const struct fused *f, const REAL *u)
{
    const struct window whole = fused_whole(f);
    double largest = 0;
#pragma omp parallel for num_threads(f->threads) schedule(static)
    for (size_t k = 0; k < f->n[2]; k++) {
        forget_sizes(f, k);
        if (f->quiet > 0) take_sizes(f, k, &whole, NULL, u);
    }
    for (size_t k = 0; k < f->n[2]; k++)
        largest = fmax(largest, f->size[k]);
    return largest;
}

/* Together. */
static double largest_of_all(const struct fused *f, double largest)
{
    if (f->quiet > 0) ranks_largest(f->ranks, 1, &largest);
    return largest;
}

static REAL plane_size(const struct fused *f, size_t k, const REAL *u)
{
    REAL largest = 0;
    for (size_t component = 0; component < 3; component++) {
        const REAL size =
            taken_passes()->NAME(largest_size)(u + component * f->volume + k * f->plane, f->plane);
        if (size > largest) largest = size;
    }
    return largest;
}

/* Largest |u| before a step: that kept from the last one if u has it still. */
static double largest_before(const struct fused *f, const REAL *u)
{
    if (f->quiet <= 0) return 0;
    const double largest = plane_size(f, f->loudest, u);
    return largest_of_all(f, largest > 0 && largest == f->largest ? largest : all_sizes(f, u));
}

void NAME(fused_look)(struct fused *f, const REAL *u)
{
    const double level = f->quiet * largest_of_all(f, all_sizes(f, u));
    const size_t reach = (size_t)f->deep / 2;
    if (f->rows.ranks > 1) meet_loud(f, level);
    for (size_t first = 0; first < f->n[2] && f->rows.ranks == 1; first += FUSED_PLANES) {
        struct loud loud = nothing_loud(f);
        widen_loud(f, level, less(first, reach), first + FUSED_PLANES + reach, &loud);
        f->computed[first / FUSED_PLANES] = window_of(f, &loud);
    }
    fused_count(f);
}

/* Where u or w is not 0 in each plane. */
static void find_reached(struct fused *f, const REAL *u, const REAL *w)
{
    const struct window whole = fused_whole(f);
#pragma omp parallel for num_threads(f->threads) schedule(static)
    for (size_t k = 0; k < f->n[2]; k++) {
        struct loud loud = nothing_loud(f);
        forget_sizes(f, k);
        take_sizes(f, k, &whole, NULL, u);
        take_sizes(f, k, &whole, NULL, w);
        widen_loud(f, 0, k, k + 1, &loud);
        f->reached[k] = (struct window){{loud.column[0], loud.strip[0] * FUSED_STRIP},
                                        {loud.column[1], loud.strip[1] * FUSED_STRIP}};
        if (f->reached[k].end[1] > f->n[1]) f->reached[k].end[1] = f->n[1];
    }
    f->known = true;
}
