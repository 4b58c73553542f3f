/* Making of the fused operator (fused.h, F1): rings, windows, rooms. */
#include "method/consistent/fused/fused.h"

#include "base/memory.h"
#include "method/consistent/galerkin/hform.h"
#include "method/spline/passes.h"

#include <string.h>

/* How long rows are waited for: from the newest, which the strip or the narrow passes over y make, to the
 * oldest that those behind still read. b_x and b_y are the same whatever multiplies them but where
 * displacements are mixed or moduli stand in b. */
static void lay_rings(const struct fused *f, bool mixed, struct fused_rings *rings)
{
    size_t all = 0;
    for (int field = 0; field < FUSED_FIELDS; field++) {
        size_t rows = FUSED_STRIP + f->late[1];
        if (field == ROW_CX || field == ROW_BX_MIXED || field == ROW_BY_SHEAR) rows = FUSED_STRIP;
        if (field == ROW_BY || field == ROW_BX_SHEAR || field == ROW_BY_MIXED || field == ROW_BZ ||
            field == ROW_CY || field == ROW_G)
            rows = FUSED_STRIP + f->late[0] + (size_t)f->narrow / 2;
        if (field >= ROW_T1) rows = f->late[1] + (size_t)f->wide / 2 + FUSED_ROWS - f->late[0];
        const bool same = !mixed && field >= ROW_BX_SHEAR && field < ROW_BZ;
        const int as = (field - ROW_BX_SHEAR) % 2 == 0 ? ROW_BX : ROW_BY;
        rings->rows[field] = same ? rings->rows[as] : fused_rounded(rows, FUSED_ROWS);
        rings->start[field] = same ? rings->start[as] : all;
        all += same ? 0 : rings->rows[field];
    }
    rings->size = all * f->stride;
}

bool fused_lay_rings(struct fused *f, int displacements)
{
    struct fused_rings *rings = &f->rings[displacements - 1];
    const size_t before = f->buffer_size;
    lay_rings(f, displacements > 1 || f->layered, rings);
    f->buffer_size = FUSED_PLANES * rings->size + 2 * FUSED_ROWS * f->stride + 2 * (f->stride - f->width);
    f->bytes += (size_t)f->threads * f->number * (f->buffer_size - before);
    if (f->buffer == NULL) f->buffer = array_new((size_t)f->threads, sizeof *f->buffer);
    for (int t = 0; f->buffer != NULL && t < f->threads; t++) {
        array_free(f->buffer[t]);
        f->buffer[t] = array_new(f->buffer_size, f->number);
        if (f->buffer[t] == NULL) return false;
    }
    return f->buffer != NULL;
}

/* Where loads act. */
static void lay_loaded(const struct consistent *c, struct fused *f)
{
    for (size_t l = 0; l < c->hform->load.count; l++) {
        const struct sparse *load = &c->hform->load.of[l];
        for (size_t p = 0; p < load->planes; p++)
            for (size_t e = load->start[p]; e < load->start[p + 1]; e++) {
                const size_t x = load->index[e] % f->n[0], y = load->index[e] / f->n[0];
                const struct window one = {{x, y}, {x + 1, y + 1}};
                struct window *loaded = &f->loaded[load->plane[p] % f->n[2]];
                *loaded = window_join(loaded, &one);
            }
    }
}

static bool lay_windows(const struct consistent *c, struct fused *f)
{
    const size_t planes = f->n[2], blocks = fused_rounded(planes, FUSED_PLANES) / FUSED_PLANES;
    f->bound = array_new((size_t)f->threads + 1, sizeof *f->bound);
    f->strips = fused_rounded(f->n[1], FUSED_STRIP) / FUSED_STRIP;
    f->size = array_new(planes, sizeof *f->size);
    f->column = array_new(planes * f->n[0], f->number);
    f->strip = array_new(planes * f->strips, f->number);
    f->computed = array_new(blocks, sizeof *f->computed);
    f->reached = array_new(planes, sizeof *f->reached);
    f->will_reach = array_new(planes, sizeof *f->will_reach);
    f->loaded = array_new(planes, sizeof *f->loaded);
    f->bytes += planes * (f->n[0] + f->strips) * f->number + (3 * planes + blocks) * sizeof *f->loaded;
    if (f->rows.ranks > 1) {
        f->loud =
            array_new(4 * (fused_rounded(f->planes.whole, FUSED_PLANES) / FUSED_PLANES), sizeof *f->loud);
        if (f->loud == NULL) return false;
    }
    if (f->bound == NULL || f->size == NULL || f->column == NULL || f->strip == NULL || f->computed == NULL ||
        f->reached == NULL || f->will_reach == NULL || f->loaded == NULL)
        return false;
    lay_loaded(c, f);
    return true;
}

/* Along each side the components across it share one inverse mass; else the passes could not be shared. */
static bool shares_masses(const struct consistent *c)
{
    for (int axis = 0; axis < 3; axis++) {
        const int one = axis == 0 ? 1 : 0, other = axis == 2 ? 1 : 2;
        if (c->hform->inverse[one][axis] != c->hform->inverse[other][axis]) return false;
    }
    return true;
}

static bool no_shear(const struct consistent *c)
{
    if (c->weighted[WEIGHT_MU] == NULL) return c->property[WEIGHT_MU] == 0;
    for (size_t e = 0; e < c->layout[DEPTH]->elements; e++)
        if (c->weighted[WEIGHT_MU][e] != 0) return false;
    return true;
}

/* Tables and rings for numbers of so many bytes; NULL: no memory. */
static struct fused *fused_new(struct consistent *c, size_t number)
{
    const size_t degree = (size_t)c->options.degree, reach = degree * (size_t)c->options.sweeps;
    struct fused *f = array_new(1, sizeof *f);
    if (f == NULL) return NULL;
    memcpy(f->n, c->n, sizeof f->n);
    f->number = number;
    f->plane = c->plane;
    f->volume = c->volume;
    f->threads = c->threads;
    f->ranks = c->part.ranks;
    f->rows = c->part.along[1];
    f->planes = c->part.along[DEPTH];
    f->layered = c->weighted[WEIGHT_MU] != NULL;
    f->bare = !c->options.depth_exact && !f->layered;
    f->bulk = no_shear(c);
    f->quiet = c->options.quiet;
    f->narrow = (int)(2 * degree + 1);
    f->wide = (int)(2 * reach + 1);
    f->deep = (int)(2 * (reach + degree) + 1);
    f->width = fused_rounded(f->n[0], FUSED_VECTOR / number);
    f->stride = f->width + fused_rounded(reach, FUSED_VECTOR / number);
    f->late[0] = fused_rounded(degree, FUSED_ROWS);
    f->late[1] = fused_rounded(f->late[0] + reach, FUSED_ROWS);
    f->bytes = sizeof *f;
    if (fused_lay_tables(c, f) && fused_lay_rings(f, 1) && lay_windows(c, f)) return f;
    fused_free(f);
    return NULL;
}

bool fused_create(struct consistent *c)
{
    const size_t degree = (size_t)c->options.degree, reach = degree * (size_t)c->options.sweeps;
    if (c->dimension != 3 || !shares_masses(c)) return true;
    if (degree != 2 || c->n[0] * sizeof(double) < FUSED_VECTOR) return true;
    for (int axis = 0; axis < 3; axis++)
        if (c->spline[axis]->count < 2 * reach + 2) return true;
    c->fused = fused_new(c, sizeof(double));
    if (c->fused == NULL) return false;
    if (c->options.single && c->n[0] * sizeof(float) >= FUSED_VECTOR) {
        c->fused->single = fused_new(c, sizeof(float));
        if (c->fused->single == NULL) return false;
    }
    return !c->fused->layered || fused_layered_faces(c);
}

struct window fused_whole(const struct fused *f)
{
    return (struct window){.end = {f->n[0], f->n[1]}};
}

struct window fused_own(const struct fused *f)
{
    return (struct window){{0, f->rows.own}, {f->n[0], f->rows.end}};
}

void fused_count(struct fused *f)
{
    f->largest = 0;
    for (size_t k = 0; k < f->n[2]; k++)
        if (f->size[k] > f->largest) {
            f->largest = f->size[k];
            f->loudest = k;
        }
    const struct window own = fused_own(f);
    for (size_t k = f->planes.own; k < f->planes.end; k++) {
        f->points += window_points(&own);
        f->skipped += window_points(&own) - window_points(&f->computed[k / FUSED_PLANES]);
    }
}

void fused_forget(struct fused *fused)
{
    for (; fused != NULL; fused = fused->single)
        fused->points = fused->skipped = 0;
}

void fused_free(struct fused *fused)
{
    if (fused == NULL) return;
    if (fused->single != NULL) fused->single->faces = NULL;
    fused_free(fused->single);
    fused_faces_free(fused->faces);
    for (int which = 0; which < SIDE_MATRICES; which++) {
        array_free(fused->x[which]);
        array_free(fused->y[which]);
    }
    for (int component = 0; component < 3; component++)
        for (int which = 0; which < OVER_DEPTH_MATRICES; which++)
            array_free(fused->z[component][which]);
    for (int t = 0; fused->buffer != NULL && t < fused->threads; t++)
        array_free(fused->buffer[t]);
    array_free(fused->buffer);
    array_free(fused->kept);
    array_free(fused->relaxing);
    array_free(fused->plain);
    array_free(fused->size);
    array_free(fused->column);
    array_free(fused->strip);
    array_free(fused->computed);
    array_free(fused->reached);
    array_free(fused->will_reach);
    array_free(fused->loaded);
    array_free(fused->loud);
    array_free(fused->bound);
    array_free(fused);
}
