/* The order of a sweep (sweep.h) for numbers of type REAL; included by sweep_double.c and sweep_single.c.
 *
 * A thread has planes of its own. What its neighbours read of the displacements is brought on first (stage 0); then
 * come its points and the update of those planes whose neighbours are its own (1), last the others (2); all threads
 * wait in between. Each sum is taken in one order: the same bits with any number of threads. */
#include "base/machine.h"
#include "method/consistent/fused/settled.h"
#include "method/consistent/general/sweep.h"
#include "method/spline/passes.h"

#include <math.h>
#include <string.h>

enum { GROUP = FUSED_VECTOR / sizeof(REAL), V_ROWS = 3 * DEPTH_FIELDS, STAGES = 3 };

/* Rows of a thread's buffer, each with room before it. */
struct rings {
    REAL *value, *pull; /* [SPAN slots][component][DEPTH_FIELDS] */
    REAL *scratch;
    REAL *force; /* [SPAN planes][component][rows of unclamped control values] */
    REAL *scaled, *passed, *zero;
    struct rows touched[SPAN]; /* of `force` */
};

struct pass {
    struct consistent *c;
    struct sweep *s;
    const struct drive *drive;
    REAL *u, *out; /* out += factor a; with `moving` u += dt w before, w being out */
    REAL factor;
    bool moving;
    double level; /* smaller displacements move nothing */
};

static size_t unclamped(const struct sweep *s, int slot)
{
    return s->cells[slot] + 2;
}

static struct rings rings_of(const struct sweep *s, REAL *buffer)
{
    struct rings r = {.value = buffer + GROUP};
    r.pull = r.value + (size_t)(SPAN * V_ROWS) * s->stride;
    r.scratch = r.pull + (size_t)(SPAN * V_ROWS) * s->stride;
    r.force = r.scratch + (size_t)(9 + STRESS_ROOM) * s->stride;
    r.scaled = r.force + 3 * SPAN * unclamped(s, 1) * s->stride;
    r.passed = r.scaled + s->n[1] * s->stride;
    r.zero = r.passed + FUSED_ROWS * s->stride;
    return r;
}

static void join(struct rows *rows, size_t from, size_t end)
{
    if (from >= end) return;
    if (rows->from >= rows->end) *rows = (struct rows){from, end};
    if (from < rows->from) rows->from = from;
    if (end > rows->end) rows->end = end;
}

static size_t less(size_t a, size_t b)
{
    return a > b ? a - b : 0;
}

/* --- Displacements --------------------------------------------------------------------------------------- */

/* Largest |u| of each row of plane k, those of u brought on. */
static void bring_plane(const struct pass *pass, size_t k)
{
    const struct sweep *s = pass->s;
    const struct rows *reached = &s->reached[k];
    const REAL dt = pass->moving ? pass->factor : 0;
    for (size_t j = 0; j < s->n[1]; j++) {
        double *size = &s->size[k * s->n[1] + j];
        *size = 0;
        if (pass->moving && (j < reached->from || j >= reached->end)) continue;
        for (size_t component = 0; component < 3; component++) {
            const size_t at = component * s->volume + k * s->plane + j * s->n[0];
            REAL most;
            if (pass->moving)
                most = NAME(taken_sweep_kernels)()->bring(s->n[0], dt, pass->out + at, pass->u + at);
            else
                most = taken_passes()->NAME(largest_size)(pass->u + at, s->n[0]);
            if (!(most <= *size)) *size = most;
        }
    }
}

/* Rows that move anything in the planes of a pair. */
static struct rows loud_rows(const struct pass *pass, size_t m)
{
    const struct sweep *s = pass->s;
    struct rows loud = {0, 0};
    for (size_t k = s->pair[m].base; k < s->pair[m].base + SPAN; k++)
        for (size_t j = 0; j < s->n[1]; j++)
            if (!(s->size[k * s->n[1] + j] <= pass->level)) join(&loud, j, j + 1);
    return loud;
}

/* --- Points ---------------------------------------------------------------------------------------------- */

static REAL *ring_row(const struct sweep *s, REAL *ring, size_t row, int component, int field)
{
    return ring + (row % SPAN * V_ROWS + (size_t)(component * DEPTH_FIELDS + field)) * s->stride;
}

/* out := a out + b in */
static void mix(size_t n, REAL a, REAL b, const REAL *restrict in, REAL *restrict out)
{
#pragma omp simd
    for (size_t i = 0; i < n; i++)
        out[i] = a * out[i] + b * in[i];
}

/* The row of the unclamped splines at an end of y from that next to it (G5). */
static void end_row(const struct sweep *s, const struct rings *r, bool high)
{
    const size_t row = high ? unclamped(s, 1) - 1 : 0, next = high ? row - 1 : 1;
    for (int component = 0; component < 3; component++)
        for (int field = 0; field < DEPTH_FIELDS; field++) {
            const REAL *in = ring_row(s, r->value, next, component, field);
            REAL *out = ring_row(s, r->value, row, component, field);
            if (s->mirror[1][high])
                mix(s->width, 0, component == 1 ? -1 : 1, in, out);
            else
                mix(s->width, 2, -1, in, out);
        }
}

/* Values and slopes over depth of row `row` of the unclamped splines. */
static void read_row(const struct pass *pass, const struct rings *r, size_t m, size_t row)
{
    const struct sweep *s = pass->s;
    const size_t last = s->cells[0] + 1;
    const bool ghost = row < s->low[1] || row - s->low[1] >= s->n[1];
    for (int component = 0; component < 3 && !ghost; component++) {
        const REAL *in[SPAN];
        REAL *out[DEPTH_FIELDS];
        for (size_t d = 0; d < SPAN; d++)
            in[d] = pass->u + (size_t)component * s->volume + (s->pair[m].base + d) * s->plane +
                    (row - s->low[1]) * s->n[0];
        for (int field = 0; field < DEPTH_FIELDS; field++)
            out[field] = ring_row(s, r->value, row, component, field) + s->low[0];
        NAME(taken_sweep_kernels)()->depth(s->n[0], in, s->pair[m].weight[component == DEPTH], out);
        for (int field = 0; field < DEPTH_FIELDS; field++) {
            REAL *to = ring_row(s, r->value, row, component, field);
            const REAL sign = component == 0 ? -1 : 1;
            to[0] = s->mirror[0][0] ? sign * to[1] : 2 * to[0] - to[1];
            to[last] = s->mirror[0][1] ? sign * to[last - 1] : 2 * to[last] - to[last - 1];
        }
    }
    if (row == 1) end_row(s, r, false);
    if (row == s->cells[1] + 1) end_row(s, r, true);
}

/* Row j of the points of a family. */
static void point_row(const struct pass *pass, const struct rings *r, int f, size_t m, size_t j)
{
    const struct sweep *s = pass->s;
    const struct family *family = &pass->c->general->family[f];
    const size_t at = m * s->points[f][0] + j, row = m * family->n[1] + j;
    const enum sweep_field value = family->at[DEPTH] == AT_KNOTS ? VALUE_KNOTS : VALUE_MIDDLES;
    struct NAME(sweep_row) points = {.x_knots = family->at[0] == AT_KNOTS,
                                     .y_knots = family->at[1] == AT_KNOTS,
                                     .width = s->width,
                                     .stride = s->stride,
                                     .lambda = (const REAL *)s->lambda[f] + at * s->width,
                                     .mu = (const REAL *)s->mu[f] + at * s->width,
                                     .scratch = r->scratch};
    for (int slot = 0; slot < 3; slot++)
        points.factor[slot] = (REAL)s->factor[f][slot];
    if (family->runs > 0) {
        points.run = family->run + family->first_run[row];
        points.runs = family->first_run[row + 1] - family->first_run[row];
        points.stiffness = family->stiffness;
    }
    struct hill_row level;
    struct NAME(sweep_hill) hill;
    if (general_hill_row(pass->c, family, j, m, &level)) {
        hill = (struct NAME(sweep_hill)){.share = (REAL)level.share, .fall = (REAL)level.fall};
        hill.drop = (const REAL *)s->hill[f][0] + j * s->width;
        for (int slot = 0; slot < 2; slot++)
            hill.slope[slot] = (const REAL *)s->hill[f][1 + slot] + j * s->width;
        points.hill = &hill;
    }
    for (int component = 0; component < 3; component++)
        for (size_t d = 0; d < SPAN; d++) {
            points.value[component][d] = ring_row(s, r->value, j + d, component, (int)value);
            points.slope[component][d] = ring_row(s, r->value, j + d, component, (int)value + 1);
            points.pull[component][d] = ring_row(s, r->pull, j + d, component, (int)value);
            points.slope_pull[component][d] = ring_row(s, r->pull, j + d, component, (int)value + 1);
        }
    NAME(taken_sweep_kernels)()->points(&points);
}

static REAL *force_row(const struct sweep *s, const struct rings *r, size_t k, size_t component, size_t row)
{
    return r->force + ((k % SPAN * 3 + component) * unclamped(s, 1) + row) * s->stride;
}

/* Takes the pulls at a row that is done off the forces. */
static void write_row(const struct pass *pass, const struct rings *r, size_t m, size_t row)
{
    const struct sweep *s = pass->s;
    for (int component = 0; component < 3; component++) {
        const REAL *in[DEPTH_FIELDS];
        REAL *out[SPAN];
        for (int field = 0; field < DEPTH_FIELDS; field++)
            in[field] = ring_row(s, r->pull, row, component, field);
        for (size_t d = 0; d < SPAN; d++)
            out[d] = force_row(s, r, s->pair[m].base + d, (size_t)component, row);
        NAME(taken_sweep_kernels)()->pulls(s->width, in, s->pair[m].weight[component == DEPTH], out);
    }
}

/* All points of pair m that move anything. */
static void point_planes(const struct pass *pass, struct rings *r, size_t m)
{
    struct sweep *s = pass->s;
    const struct rows loud = loud_rows(pass, m);
    if (loud.from >= loud.end) return;
    const size_t from = less(loud.from + s->low[1], 2);
    const size_t most = s->cells[1] + 1, after = loud.end + s->low[1] + 1;
    const size_t end = after < most ? after : most;
    for (size_t slot = 0; slot < SPAN; slot++) /* the first two rows; what no point of a plane sets */
        memset(ring_row(s, r->pull, slot, 0, 0), 0, (size_t)V_ROWS * s->stride * sizeof(REAL));
    for (size_t row = from; row < from + 2; row++)
        read_row(pass, r, m, row);
    for (size_t j = from; j < end; j++) {
        if (j + 2 < unclamped(s, 1)) read_row(pass, r, m, j + 2);
        for (int f = 0; f < 3; f++)
            if (m < s->points[f][1] && j < s->points[f][0]) point_row(pass, r, f, m, j);
        write_row(pass, r, m, j);
    }
    for (size_t row = end; row < end + 2 && row < unclamped(s, 1); row++)
        write_row(pass, r, m, row);
    for (size_t k = s->pair[m].base; k < s->pair[m].base + SPAN; k++)
        join(&r->touched[k % SPAN], from, end + 2 < unclamped(s, 1) ? end + 2 : unclamped(s, 1));
}

/* --- Planes of forces ------------------------------------------------------------------------------------ */

/* Forces of unclamped splines to those of the open ends, along y. */
static void clamp_rows(const struct sweep *s, const struct rings *r, size_t k, size_t component)
{
    for (int high = 0; high < 2; high++) {
        const size_t row = high ? unclamped(s, 1) - 1 : 0, next = high ? row - 1 : 1;
        REAL *at = force_row(s, r, k, component, row), *to = force_row(s, r, k, component, next);
        mix(s->width, 1, !s->mirror[1][high] ? -1 : component == 1 ? -1 : 1, at, to);
        for (size_t i = 0; i < s->width && !s->mirror[1][high]; i++)
            at[i] *= 2;
    }
}

/* The same along x, times root: a row of control values. */
static void scale_row(const struct sweep *s, size_t component, const REAL *root, REAL *row, REAL *out)
{
    const size_t last = s->cells[0] + 1;
    const REAL sign = component == 0 ? -1 : 1;
    row[1] += (s->mirror[0][0] ? sign : -1) * row[0];
    row[last - 1] += (s->mirror[0][1] ? sign : -1) * row[last];
    if (!s->mirror[0][0]) row[0] *= 2;
    if (!s->mirror[0][1]) row[last] *= 2;
    NAME(taken_sweep_kernels)()->scale(s->n[0], root, row + s->low[0], out);
}

/* Corners (corners.c) that act on plane k. */
static void add_corners(const struct pass *pass, const struct rings *r, size_t k, size_t component,
                        const struct rows *rows)
{
    const struct sweep *s = pass->s;
    const struct general *g = pass->c->general;
    for (size_t n = 0; n < g->corners; n++) {
        const struct corner *corner = &g->corner[n];
        const size_t end = corner->high[2] ? s->n[2] - 1 : 0, beside = corner->high[2] ? end - 1 : 1;
        if (k != end && k != beside) continue;
        double slope[3][3], pull[3];
        for (size_t of = 0; of < 3; of++)
            for (int slot = 0; slot < 3; slot++) {
                const REAL *u = pass->u + of * s->volume;
                slope[of][slot] = corner->slope[slot] * ((double)u[general_corner_seen(pass->c, corner, slot, 1)] -
                                                         (double)u[general_corner_seen(pass->c, corner, slot, 0)]);
            }
        general_corner_pull(corner, slope, (int)component, pull);
        for (int slot = 0; slot < 3; slot++)
            for (int next = 0; next < 2; next++) {
                const size_t at = general_corner_seen(pass->c, corner, slot, next);
                const size_t j = at % s->plane / s->n[0], i = at % s->n[0];
                if (at / s->plane != k || j < rows->from || j >= rows->end) continue;
                r->scaled[j * s->stride + i] +=
                    ((const REAL *)s->root)[at] * (REAL)(next == 1 ? -pull[slot] : pull[slot]);
            }
    }
}

static void add_loads(const struct pass *pass, const struct rings *r, size_t k, size_t component)
{
    const struct sweep *s = pass->s;
    const struct drive *drive = pass->drive;
    const REAL *root = (const REAL *)s->root + k * s->plane;
    for (size_t l = 0; drive->load != NULL && l < pass->c->model.scene->loads; l++) {
        const struct sparse *load = &pass->c->load[l];
        const double amplitude = drive->load[l] * pass->c->model.scene->load[l].amplitude;
        const size_t at = component * s->n[2] + k;
        for (size_t e = load->start[at]; amplitude != 0 && e < load->start[at + 1]; e++) {
            const size_t index = load->index[e];
            r->scaled[index / s->n[0] * s->stride + index % s->n[0]] +=
                root[index] * (REAL)(amplitude * load->value[e]);
        }
    }
}

static REAL *ready_row(const struct sweep *s, size_t component, size_t k, size_t j)
{
    return (REAL *)s->ready + GROUP + ((component * s->n[2] + k) * s->rows + j) * s->stride;
}

/* N along y and x of rows `rows` of `scaled`, for rows `filled`. */
static void pass_along(const struct sweep *s, const struct rings *r, size_t component, size_t k,
                       const struct rows *rows, const struct rows *filled)
{
    const struct NAME(fused_kernels) *kernels = NAME(taken_fused_kernels)();
    enum { WIDE = 2 };
    for (size_t j = filled->from; j < filled->end; j += FUSED_ROWS) {
        const REAL *in[SWEEP_TAPS + FUSED_ROWS - 1];
        for (size_t t = 0; t < SWEEP_TAPS + FUSED_ROWS - 1; t++) {
            const size_t row = j + t - SWEEP_REACH; /* wraps round below 0 */
            in[t] = row >= rows->from && row < rows->end ? r->scaled + row * s->stride : r->zero;
        }
        const REAL *weight = (const REAL *)s->y[component] + j * SWEEP_TAPS;
        (s->plain[j / FUSED_ROWS] ? kernels->of[WIDE].y : kernels->of[WIDE].y_ends)(
            weight, in, r->zero, s->width, s->stride, r->passed);
        kernels->of[WIDE].x(s->x[component], r->passed, r->zero, s->width, s->stride,
                            ready_row(s, component, k, j));
    }
}

static void forget_plane(const struct sweep *s, struct rings *r, size_t k)
{
    memset(force_row(s, r, k, 0, 0), 0, 3 * unclamped(s, 1) * s->stride * sizeof(REAL));
    r->touched[k % SPAN] = (struct rows){0, 0};
}

/* The forces of plane k are complete. */
static void plane_done(const struct pass *pass, struct rings *r, size_t k)
{
    struct sweep *s = pass->s;
    struct rows *touched = &r->touched[k % SPAN], rows = {0, 0};
    if (touched->from < touched->end) {
        rows.from = less(touched->from, s->low[1]);
        rows.end = touched->end - s->low[1] < s->n[1] ? touched->end - s->low[1] : s->n[1];
    }
    if (pass->drive->load != NULL) join(&rows, s->loaded[k].from, s->loaded[k].end);
    struct rows *filled = &s->filled[k];
    *filled = (struct rows){0, 0};
    if (rows.from >= rows.end) return;
    filled->from = less(rows.from, SWEEP_REACH) / FUSED_ROWS * FUSED_ROWS;
    filled->end = rows.end + SWEEP_REACH < s->n[1] ? rows.end + SWEEP_REACH : s->n[1];
    for (size_t component = 0; component < 3; component++) {
        clamp_rows(s, r, k, component);
        for (size_t j = rows.from; j < rows.end; j++)
            scale_row(s, component, (const REAL *)s->root + k * s->plane + j * s->n[0],
                      force_row(s, r, k, component, j + s->low[1]), r->scaled + j * s->stride);
        add_corners(pass, r, k, component, &rows);
        add_loads(pass, r, k, component);
        pass_along(s, r, component, k, &rows, filled);
    }
    forget_plane(s, r, k);
}

/* N over depth and the update of planes first .. first + SWEEP_PLANES - 1. */
static void finish_planes(const struct pass *pass, const struct rings *r, size_t first)
{
    struct sweep *s = pass->s;
    const size_t planes = s->n[2] - first < SWEEP_PLANES ? s->n[2] - first : SWEEP_PLANES;
    struct rows rows = {0, 0};
    for (size_t k = less(first, SWEEP_REACH); k < first + planes + SWEEP_REACH && k < s->n[2]; k++)
        join(&rows, s->filled[k].from, s->filled[k].end);
    for (size_t component = 0; component < 3; component++)
        for (size_t j = rows.from; j < rows.end; j++) {
            const REAL *in[SWEEP_TAPS + SWEEP_PLANES - 1], *root[SWEEP_PLANES];
            REAL *out[SWEEP_PLANES];
            for (size_t t = 0; t < SWEEP_TAPS + SWEEP_PLANES - 1; t++) {
                const size_t k = first + t - SWEEP_REACH; /* wraps round below 0 */
                const bool there = k < s->n[2] && j >= s->filled[k].from && j < s->filled[k].end;
                in[t] = there ? ready_row(s, component, k, j) : r->zero;
            }
            for (size_t p = 0; p < planes; p++) {
                const size_t at = (first + p) * s->plane + j * s->n[0];
                root[p] = (const REAL *)s->root + at;
                out[p] = pass->out + component * s->volume + at;
            }
            NAME(taken_sweep_kernels)()->finish(s->n[0], planes,
                                                (const REAL *)s->z[component] + first * SWEEP_TAPS, in,
                                                s->stride, pass->factor, root, out);
        }
    for (size_t k = first; pass->moving && k < first + planes; k++)
        join(&s->reached[k], rows.from, rows.end);
}

/* --- Threads --------------------------------------------------------------------------------------------- */

/* Are all planes that the update of these reads those of the thread? */
static bool own(const struct sweep *s, size_t first, size_t from, size_t end)
{
    const size_t after = first + SWEEP_PLANES + SWEEP_REACH;
    return (from == 0 || first >= from + SWEEP_REACH) && (end == s->n[2] || after <= end);
}

/* Planes from `from` to `end`. */
static void sweep_points(const struct pass *pass, struct rings *r, size_t from, size_t end)
{
    const struct sweep *s = pass->s;
    size_t next = from + 2, done = from, finished = from;
    for (size_t slot = 0; slot < SPAN; slot++)
        r->touched[slot] = (struct rows){0, 0};
    memset(r->force, 0, 3 * SPAN * unclamped(s, 1) * s->stride * sizeof(REAL));
    for (size_t m = less(from + s->low[2], 2); done < end; m++) {
        if (m <= s->cells[2]) {
            for (; pass->moving && next < s->pair[m].base + SPAN && next + 2 < end; next++)
                bring_plane(pass, next);
            point_planes(pass, r, m);
        }
        if (m >= s->low[2] && m - s->low[2] < from) forget_plane(s, r, m - s->low[2]);
        if (m >= done + s->low[2]) plane_done(pass, r, done++);
        for (; finished < end && own(s, finished, from, end); finished += SWEEP_PLANES) {
            const size_t after = finished + SWEEP_PLANES + SWEEP_REACH;
            if (done < (after < end ? after : end)) break;
            finish_planes(pass, r, finished);
        }
        while (finished < end && !own(s, finished, from, end) && finished < from + SWEEP_REACH)
            finished += SWEEP_PLANES;
    }
}

static void sweep_stage(const struct pass *pass, int thread, int stage)
{
    const struct sweep *s = pass->s;
    const size_t from = s->bound[thread], end = s->bound[thread + 1];
    struct rings r = rings_of(s, s->buffer[thread]);
    if (from >= end) return;
    if (stage == 0)
        for (size_t k = from; k < end; k++) {
            if (!pass->moving || k < from + 2 || k + 2 >= end) bring_plane(pass, k);
        }
    else if (stage == 1)
        sweep_points(pass, &r, from, end);
    else
        for (size_t first = from; first < end; first += SWEEP_PLANES)
            if (!own(s, first, from, end)) finish_planes(pass, &r, first);
}

/* Largest displacement of all rows. */
static double largest_size(const struct sweep *s)
{
    double largest = 0;
    for (size_t row = 0; row < s->n[1] * s->n[2]; row++)
        if (s->size[row] > largest) largest = s->size[row];
    return largest;
}

/* Where the planes of each thread begin: about as many rows of points for each in the step before. What is computed
 * does not depend on it. */
static void lay_bounds(struct sweep *s, size_t threads)
{
    const size_t blocks = (s->n[2] + SWEEP_PLANES - 1) / SWEEP_PLANES;
    size_t all = 0, done = 0, thread = 1;
    for (int turn = 0; turn < 2; turn++)
        for (size_t block = 0; block < blocks; block++) {
            while (turn == 1 && thread < threads && done * threads >= all * thread)
                s->bound[thread++] = block * SWEEP_PLANES;
            for (size_t k = block * SWEEP_PLANES; k < (block + 1) * SWEEP_PLANES && k < s->n[2]; k++)
                *(turn == 0 ? &all : &done) += 1 + s->filled[k].end - s->filled[k].from;
        }
    while (thread <= threads)
        s->bound[thread++] = s->n[2];
}

static void sweep_over(struct pass *pass)
{
    struct sweep *s = pass->s;
    const int threads = pass->c->threads;
    lay_bounds(s, (size_t)threads);
    for (int stage = 0; stage < STAGES; stage++) {
#pragma omp parallel for num_threads(threads) schedule(static, 1)
        for (int thread = 0; thread < threads; thread++) {
            const unsigned before = tiny_as_zero();
            sweep_stage(pass, thread, stage);
            tiny_as_before(before);
        }
        if (stage == 0 && !pass->moving) pass->level = s->quiet * largest_size(s);
    }
    s->largest = largest_size(s);
}

static void accelerate(struct consistent *c, const struct drive *drive, const REAL *u, REAL *work)
{
    struct pass pass = {.c = c, .s = c->general->sweep, .drive = drive, .factor = 1, .out = work};
    pass.u = (REAL *)u; /* stands still */
    memset(work, 0, c->model.unknowns * sizeof *work);
    sweep_over(&pass);
}

/* Rows where u or w is not 0, and the largest u. */
static void find_reached(struct sweep *s, const REAL *u, const REAL *w)
{
    s->largest = 0;
    for (size_t k = 0; k < s->n[2]; k++) {
        s->reached[k] = (struct rows){0, 0};
        for (size_t component = 0; component < 3; component++)
            for (size_t j = 0; j < s->n[1]; j++) {
                const size_t at = component * s->volume + k * s->plane + j * s->n[0];
                const double size = taken_passes()->NAME(largest_size)(u + at, s->n[0]);
                if (size > s->largest) s->largest = size;
                if (size != 0 || taken_passes()->NAME(largest_size)(w + at, s->n[0]) != 0)
                    join(&s->reached[k], j, j + 1);
            }
    }
    s->known = true;
}

void NAME(sweep_begin)(struct consistent *c, const struct drive *drive, double dt, const REAL *u, REAL *w,
                       REAL *work)
{
    c->general->sweep->known = false;
    accelerate(c, drive, u, work);
    for (size_t i = 0; i < c->model.unknowns; i++)
        w[i] += (REAL)(dt / 2) * work[i];
}

void NAME(sweep_settle)(struct consistent *c, const struct drive *drive, double dt, REAL *u, REAL *w,
                        REAL *work, double *y, double *a)
{
    const struct NAME(settled) settled = {c->model.unknowns, c->threads, u, w, work};
    accelerate(c, drive, u, work);
    NAME(settle)(&settled, dt, y, a);
}

void NAME(sweep_advance)(struct consistent *c, const struct drive *drive, double dt, REAL *u, REAL *w,
                         double *y, double *a)
{
    struct sweep *s = c->general->sweep;
    const struct watch *watch = &c->watch;
    for (size_t i = 0; i < watch->count; i++)
        watch->before[i] = w[watch->entry[i]];
    if (!s->known) find_reached(s, u, w);
    struct pass pass = {.c = c,
                        .s = s,
                        .drive = drive,
                        .u = u,
                        .out = w,
                        .factor = (REAL)dt,
                        .moving = true,
                        .level = s->quiet * s->largest};
    sweep_over(&pass);
    for (size_t i = 0; i < watch->count; i++) {
        const size_t at = watch->entry[i];
        const double before = watch->before[i], after = w[at];
        y[at] = u[at];
        y[c->model.unknowns + at] = (before + after) / 2;
        a[at] = (after - before) / dt;
    }
}
