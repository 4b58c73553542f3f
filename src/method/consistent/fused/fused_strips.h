/* The order of the passes of the fused operator (fused.h, F1), for numbers of type REAL; included by
 * fused_double.c and fused_single.c.
 *
 * A window of FUSED_PLANES planes is made together, in strips of rows: passes over depth and those along x
 * that need nothing of y where rows are new; narrow and wide passes over y so many rows behind that all their
 * inputs are there. What must wait is kept in rings of rows that stay in the cache.
 *
 * What passes along x and y read is made beyond the window, too, as far as they reach, so that results in it
 * are those of whole planes, to the bit. What lies further out is left as it was; nothing that is kept is
 * made of it. */
#include "method/consistent/fused/kernels.h"

#include <string.h>

/* Columns of a row, whole vectors. */
struct span {
    size_t at, n;
};

/* What the steps of a strip share. */
struct strip {
    const struct fused *f;
    const struct NAME(fused_kernels) * kernel;
    int sweeps;           /* less one: which of the kernels are the wide ones */
    struct span own, all; /* columns of the result; with those beyond that passes along x read */
    size_t from, end;     /* rows of the result */
    const struct fused_rings *in_ring;
    REAL *rings, *ring; /* of the first plane; of the plane being worked on */
    REAL *spare, *zero; /* FUSED_ROWS rows each */
};

static REAL *row_of(const struct strip *s, REAL *ring, enum fused_row field, size_t j)
{
    return ring + (s->in_ring->start[field] + j % s->in_ring->rows[field]) * s->f->stride;
}

/* out := init + matrix `side` of y times a field, rows j .. j + 3; init may be out. Rows beyond the ends are
 * read, times 0. */
static void y_pass(const struct strip *s, struct span span, enum fused_side side, enum fused_row field,
                   size_t j, const REAL *init, REAL *out)
{
    const struct fused *f = s->f;
    const REAL *rows[FUSED_MOST_TAPS];
    const bool wide = side <= SIDE_N_ODD, stiff = !wide && side <= SIDE_S_ODD;
    const size_t taps = (size_t)(wide ? f->wide : f->narrow);
    const REAL *weight = (const REAL *)f->y[side] + j * taps;
    const size_t ring = s->in_ring->rows[field];
    size_t place = (j + ring - taps / 2) % ring;
    for (size_t t = 0; t < taps + FUSED_ROWS - 1; t++) {
        rows[t] = s->ring + (s->in_ring->start[field] + place) * f->stride + span.at;
        place = place + 1 < ring ? place + 1 : 0;
    }
    const bool plain = f->plain[j / FUSED_ROWS];
    const int of = wide ? s->sweeps : 0;
    NAME(fused_y) *pass = plain ? s->kernel->of[of].y : s->kernel->of[of].y_ends;
    if (stiff) pass = plain ? s->kernel->y_stiff : s->kernel->y_stiff_ends;
    pass(weight, rows, init + span.at, span.n, f->stride, out + span.at);
}

/* Narrow passes are made for wide ones, which read beyond the window. */
static void x_pass(const struct strip *s, enum fused_side side, const REAL *in, const REAL *init, REAL *out)
{
    const struct fused *f = s->f;
    const bool wide = side <= SIDE_N_ODD, stiff = !wide && side <= SIDE_S_ODD;
    const struct span span = wide ? s->own : s->all;
    const size_t taps = (size_t)(wide ? f->wide : f->narrow);
    NAME(fused_x) *pass = stiff ? s->kernel->x_stiff : s->kernel->of[wide ? s->sweeps : 0].x;
    pass((const REAL *)f->x[side] + span.at * taps, in + span.at, init + span.at, span.n, f->stride,
         out + span.at);
}

/* The passes along x that need nothing of y: g = C_z u_z + N_x G_x b_x, and what goes into a_y and a_z. */
static void first_rows(const struct strip *s, size_t j)
{
    const struct fused *f = s->f;
    REAL *ring = s->ring, *spare = s->spare;
    REAL *ay = row_of(s, ring, ROW_AY, j), *az = row_of(s, ring, ROW_AZ, j);
    x_pass(s, SIDE_G_FIRST, row_of(s, ring, ROW_BX_MIXED, j), s->zero, spare);
    x_pass(s, SIDE_N_EVEN, spare, row_of(s, ring, ROW_CZ, j), row_of(s, ring, ROW_G, j));
    if (j < s->from || j >= s->end) return;
    const REAL *before = s->zero;
    if (!f->bulk) {
        x_pass(s, SIDE_S_EVEN, row_of(s, ring, ROW_BY_SHEAR, j), s->zero, spare);
        x_pass(s, SIDE_N_EVEN, spare, ay, ay);
        x_pass(s, SIDE_S_EVEN, row_of(s, ring, ROW_BZ, j), s->zero, spare);
        before = spare;
    }
    x_pass(s, SIDE_G_FIRST, row_of(s, ring, ROW_CX, j), before, spare);
    x_pass(s, SIDE_N_EVEN, spare, az, az);
}

/* Narrow passes over y. */
static void second_rows(const struct strip *s, size_t j)
{
    const struct fused *f = s->f;
    REAL *t1 = row_of(s, s->ring, ROW_T1, j), *t2 = row_of(s, s->ring, ROW_T2, j);
    REAL *t3 = row_of(s, s->ring, ROW_T3, j), *t4 = row_of(s, s->ring, ROW_T4, j);
    y_pass(s, s->all, SIDE_G_FIRST, ROW_BY_MIXED, j, s->zero, t1);
    if (!f->bulk) y_pass(s, s->own, SIDE_S_EVEN, ROW_BX_SHEAR, j, s->zero, t2);
    y_pass(s, s->own, SIDE_S_ODD, ROW_BY, j, s->zero, t3);
    y_pass(s, s->own, SIDE_G_SECOND, ROW_G, j, t3, t3);
    if (!f->bulk) y_pass(s, s->own, SIDE_S_EVEN, ROW_BZ, j, s->zero, t4);
    y_pass(s, s->own, SIDE_G_FIRST, ROW_CY, j, f->bulk ? s->zero : t4, t4);
}

/* Wide passes over y, and along x of what waited for them. */
static void third_rows(const struct strip *s, size_t j)
{
    const struct fused *f = s->f;
    REAL *ring = s->ring, *spare = s->spare;
    REAL *ax = row_of(s, ring, ROW_AX, j), *ay = row_of(s, ring, ROW_AY, j), *az = row_of(s, ring, ROW_AZ, j);
    REAL *divergence = row_of(s, ring, ROW_CZ, j);
    y_pass(s, s->all, SIDE_N_EVEN, ROW_T1, j, divergence, divergence);
    if (!f->bulk) y_pass(s, s->own, SIDE_N_EVEN, ROW_T2, j, ax, ax);
    y_pass(s, s->own, SIDE_N_ODD, ROW_T3, j, f->bulk ? s->zero : ay, ay);
    y_pass(s, s->own, SIDE_N_EVEN, ROW_T4, j, az, az);
    x_pass(s, SIDE_S_ODD, row_of(s, ring, ROW_BX, j), s->zero, spare);
    x_pass(s, SIDE_G_SECOND, divergence, spare, spare);
    x_pass(s, SIDE_N_ODD, spare, f->bulk ? s->zero : ax, ax);
}

/* Passes over depth for row j of FUSED_PLANES planes; planes that are not there have weight 0. */
static void depth_rows(const struct strip *s, size_t first, size_t j, const struct fused_fields *fields)
{
    static const enum fused_row result[3][OVER_DEPTH_RESULTS] = {
        {ROW_AX, ROW_CX, ROW_BX_SHEAR, ROW_BX_MIXED, ROW_BX},
        {ROW_AY, ROW_CY, ROW_BY_SHEAR, ROW_BY_MIXED, ROW_BY},
        {ROW_AZ, ROW_CZ, ROW_BZ, ROW_BZ, ROW_BZ}};
    const struct fused *f = s->f;
    const size_t half = (size_t)f->deep / 2, last = s->all.at + s->all.n;
    const size_t n = (last < f->n[0] ? last : f->n[0]) - s->all.at;
    const REAL share[SHARES] = {(REAL)f->share[SHARE_MIXED], (REAL)f->share[SHARE_AXIAL]};
    for (int component = 0; component < 3; component++) {
        const size_t at = (size_t)component * f->volume + j * f->n[0] + s->all.at;
        const bool layered = f->layered && component != DEPTH;
        const REAL *in[FUSED_MOST_TAPS], *other[FUSED_MOST_TAPS], *weight[OVER_DEPTH_MATRICES];
        REAL *out[OVER_DEPTH_RESULTS * FUSED_PLANES];
        for (size_t t = 0; t < (size_t)f->deep + FUSED_PLANES - 1; t++) {
            const size_t k = first + t < half ? 0 : first + t - half;
            const size_t place = at + (k < f->n[2] ? k : f->n[2] - 1) * f->plane;
            in[t] = (const REAL *)fields->u + place;
            if (fields->other != NULL) other[t] = (const REAL *)fields->other + place;
        }
        for (size_t m = 0; m < OVER_DEPTH_RESULTS; m++)
            for (size_t r = 0; r < FUSED_PLANES; r++)
                out[m * FUSED_PLANES + r] =
                    row_of(s, s->rings + r * s->in_ring->size, result[component][m], j) + s->all.at;
        for (size_t m = 0; m < OVER_DEPTH_MATRICES && f->z[component][m] != NULL; m++)
            weight[m] = (const REAL *)f->z[component][m] + first * (size_t)f->deep;
        if (fields->other != NULL)
            s->kernel->of[s->sweeps].mixed[!f->bare][component == DEPTH](in, other, weight, share, n, f->n[0],
                                                                         out);
        else
            s->kernel->of[s->sweeps].depth[layered ? 2 : !f->bare][f->bulk && component != DEPTH](
                in, weight, n, f->n[0], out);
    }
}

static void store_row(const struct strip *s, size_t k, size_t j, const struct fused_fields *fields)
{
    const struct fused *f = s->f;
    static const enum fused_row sum[3] = {ROW_AX, ROW_AY, ROW_AZ};
    const size_t from = s->own.at, last = from + s->own.n, n = (last < f->n[0] ? last : f->n[0]) - from;
    for (int component = 0; component < 3; component++) {
        const REAL *row = row_of(s, s->ring, sum[component], j) + from;
        const size_t at = (size_t)component * f->volume + k * f->plane + j * f->n[0] + from;
        REAL *a = (REAL *)fields->a + at;
        if (fields->moved == NULL)
            memcpy(a, row, n * sizeof *a);
        else
            s->kernel->kick(n, (REAL)fields->dt, row, a);
    }
}

/* Rows j .. j + FUSED_STRIP - 1 of a plane where they are new, and those that come after them; `first` and
 * `last`: rows that are made over depth. */
static void strip_rows(const struct strip *s, size_t k, size_t first, size_t last, size_t j,
                       const struct fused_fields *fields)
{
    const struct fused *f = s->f;
    for (size_t row = j; row < j + FUSED_STRIP; row += FUSED_ROWS) {
        if (row < last) first_rows(s, row);
        if (row >= first + f->late[0] && row - f->late[0] < last) second_rows(s, row - f->late[0]);
        if (row < s->from + f->late[1] || row - f->late[1] >= s->end) continue;
        const size_t done = row - f->late[1];
        third_rows(s, done);
        for (size_t r = done; r < done + FUSED_ROWS && r < f->n[1]; r++)
            store_row(s, k, r, fields);
    }
}

static void window_planes(struct strip *s, size_t first, const struct fused_fields *fields)
{
    const struct fused *f = s->f;
    const size_t all = (f->n[1] + FUSED_ROWS - 1) / FUSED_ROWS * FUSED_ROWS;
    const size_t planes = f->n[2] - first < FUSED_PLANES ? f->n[2] - first : FUSED_PLANES;
    const size_t from = less(s->from, FUSED_STRIP);
    const size_t last = s->end + FUSED_STRIP < all ? s->end + FUSED_STRIP : all;
    for (size_t j = from; j < s->end + f->late[1]; j += FUSED_STRIP) {
        const size_t after = j + FUSED_STRIP < last ? j + FUSED_STRIP : last;
        const size_t end = after < f->n[1] ? after : f->n[1];
        const struct window rows = {{0, j}, {f->n[0], end}};
        for (size_t k = fields->bring_on; k < fields->before && j < end; k++)
            bring_on(f, fields, k, &rows);
        for (size_t row = j; row < end; row++)
            depth_rows(s, first, row, fields);
        for (size_t plane = 0; plane < planes; plane++) {
            s->ring = s->rings + plane * s->in_ring->size;
            strip_rows(s, first + plane, from, last, j, fields);
        }
    }
}

static void clear_planes(const struct fused *f, size_t first, REAL *a)
{
    const size_t planes = f->n[2] - first < FUSED_PLANES ? f->n[2] - first : FUSED_PLANES;
    for (size_t component = 0; component < 3; component++)
        memset(a + component * f->volume + first * f->plane, 0, planes * f->plane * sizeof *a);
}

void NAME(fused_planes)(const struct fused *fused, int thread, size_t first,
                        const struct fused_fields *fields)
{
    const struct fused *f = fused;
    const struct window *window = &f->computed[first / FUSED_PLANES];
    struct strip s = {.f = f, .zero = (REAL *)f->buffer[thread] + (f->stride - f->width)};
    s.in_ring = &f->rings[fields->other != NULL];
    s.spare = s.zero + FUSED_ROWS * f->stride;
    s.rings = s.spare + FUSED_ROWS * f->stride;
    s.kernel = NAME(taken_fused_kernels)();
    while (s.kernel->of[s.sweeps].taps != f->wide)
        s.sweeps++;
    if (fields->moved == NULL && window_points(window) < f->plane) clear_planes(f, first, (REAL *)fields->a);
    if (window_points(window) == 0) return;
    const size_t from = window->from[0], before = less(from, FUSED_LANES);
    const size_t end = (window->end[0] + FUSED_LANES - 1) / FUSED_LANES * FUSED_LANES;
    const size_t after = end + FUSED_LANES < f->width ? end + FUSED_LANES : f->width;
    s.own = (struct span){from, end - from};
    s.all = (struct span){before, after - before};
    s.from = window->from[1];
    s.end = (window->end[1] + FUSED_ROWS - 1) / FUSED_ROWS * FUSED_ROWS;
    window_planes(&s, first, fields);
}
