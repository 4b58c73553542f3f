/* What a sweep does row by row (sweep.h), for numbers of type REAL; included by sweep_double.c and sweep_single.c:
 * displacements brought on, points and what they pull at. */
#include "method/consistent/general/sweep.h"
#include "method/spline/passes.h"

#include <string.h>

enum { GROUP = FUSED_VECTOR / sizeof(REAL), V_ROWS = 3 * DEPTH_FIELDS, P_ROWS = 3 * PULL_FIELDS };

/* Rows of a thread's buffer, each with room before it. */
struct rings {
    REAL *value,
        *pull;  /* [part][SPAN slots][component][DEPTH_FIELDS]; [SPAN slots][component][PULL_FIELDS] */
    REAL *rate; /* as `value`, of what displacements have moved by */
    REAL *scratch, *rates;
    REAL *force; /* [SPAN planes][component][rows of unclamped control values] */
    REAL *part;  /* of each layer (struct sweep_part) */
    REAL *scaled, *passed, *zero;
    double *taken;             /* a row of a layer */
    double *edge;              /* [SPAN planes][most of the edges' points in a plane][3][3] */
    size_t edged[SPAN];        /* 1 more than the plane whose are there */
    struct rows touched[SPAN]; /* of `force` */
};

/* What is done with a pair of planes: memory of layers goes on, or has gone on already, or it alone. */
enum task { PULL_AND_MOVE, PULL, MOVE };

struct pass {
    struct consistent *c;
    struct sweep *s;
    const struct drive *drive;
    const struct NAME(sweep_fields) * fields;
    REAL *out; /* out += factor a; with `moving` fields go on by w before, w being out */
    REAL factor;
    bool moving;
    double dt;                   /* of the step, while moving */
    double level;                /* smaller displacements move nothing */
    double *extra;               /* memory of absorbing layers, that of forces for all parts */
    struct rows deep[BOX_FACES]; /* of those over depth: rows where it may not be 0 */
};

static size_t unclamped(const struct sweep *s, int slot)
{
    return s->cells[slot] + 2;
}

static struct rings rings_of(const struct sweep *s, REAL *buffer)
{
    struct rings r = {.value = buffer + GROUP};
    r.pull = r.value + s->parts * SPAN * V_ROWS * s->stride;
    r.scratch = r.pull + (size_t)(SPAN * P_ROWS) * s->stride;
    r.rate = r.scratch + (size_t)(9 + STRESS_ROOM) * s->stride;
    r.rates = r.rate + (s->layered ? s->parts * SPAN * V_ROWS : 0) * s->stride;
    r.force = r.rates + (size_t)(s->layered ? 9 : 0) * s->stride;
    r.part = r.force + 3 * SPAN * unclamped(s, 1) * s->stride;
    r.scaled = r.part + s->part_size;
    r.passed = r.scaled + s->n[1] * s->stride;
    r.zero = r.passed + FUSED_ROWS * s->stride;
    void *taken = r.zero + FUSED_ROWS * s->stride;
    r.taken = taken;
    r.edge = r.taken + s->stride;
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

/* What u of a part has moved by in a step, or what that is a multiple of (half_rate()): w, or if displacements relax
 * room that steps do not need else. */
static REAL *rate_of(const struct pass *pass, size_t p)
{
    void *room = pass->fields->part[p].ground->work;
    return pass->fields->relax == NULL ? pass->out : (REAL *)room;
}

static REAL half_rate(const struct pass *pass)
{
    return pass->fields->relax == NULL ? (REAL)(pass->dt / 2) : (REAL).5;
}

/* Fields that relax go on in a row from number `at` on; where it is not reached they are 0, and so is what they move
 * by, for layers. */
static void relax_row(const struct pass *pass, size_t at, bool reached)
{
    const struct NAME(sweep_fields) *fields = pass->fields;
    const size_t n = pass->s->n[0];
    REAL *field[FUSED_FIELDS_KEPT], *change[FUSED_FIELDS_KEPT];
    for (size_t p = 0; p < fields->parts; p++) {
        change[p] = rate_of(pass, p) + at;
        if (!reached && pass->s->layered) memset(change[p], 0, n * sizeof(REAL));
    }
    if (!reached) return;
    for (size_t f = 0; f < fields->fields; f++)
        field[f] = (REAL *)fields->kept[f] + at;
    NAME(taken_fused_kernels)
    ()->relax(n, fields->relax, pass->out + at, field, pass->s->layered ? change : NULL);
}

/* The largest displacement in a row from number `at` on. */
static REAL row_size(const struct pass *pass, size_t at)
{
    REAL most = 0;
    for (size_t p = 0; p < pass->fields->parts; p++) {
        const REAL size = taken_passes()->NAME(largest_size)(pass->fields->part[p].u + at, pass->s->n[0]);
        if (!(size <= most)) most = size;
    }
    return most;
}

/* Largest |u| of each row of plane k, those of u brought on. */
static void bring_plane(const struct pass *pass, size_t k)
{
    const struct sweep *s = pass->s;
    const struct rows *rows = &s->reached[k];
    const bool relaxes = pass->moving && pass->fields->relax != NULL;
    const REAL dt = pass->moving ? pass->factor : 0;
    for (size_t j = 0; j < s->n[1]; j++) {
        double *size = &s->size[k * s->n[1] + j];
        const bool reached = !pass->moving || (j >= rows->from && j < rows->end);
        *size = 0;
        if (!reached && !relaxes) continue;
        for (size_t component = 0; component < 3; component++) {
            const size_t at = component * s->volume + k * s->plane + j * s->n[0];
            REAL most = 0;
            if (relaxes) relax_row(pass, at, reached);
            if (pass->moving && !relaxes)
                most = NAME(taken_sweep_kernels)()->bring(s->n[0], dt, pass->out + at,
                                                          pass->fields->part[0].u + at);
            else if (reached)
                most = row_size(pass, at);
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

/* The ring of a part. */
static REAL *ring_of(const struct sweep *s, REAL *rings, size_t p)
{
    return rings + p * SPAN * V_ROWS * s->stride;
}

static REAL *ring_row(const struct sweep *s, REAL *ring, size_t row, int component, int field)
{
    return ring + (row % SPAN * V_ROWS + (size_t)(component * DEPTH_FIELDS + field)) * s->stride;
}

static REAL *pull_row(const struct sweep *s, REAL *ring, size_t row, int component, int field)
{
    return ring + (row % SPAN * P_ROWS + (size_t)(component * PULL_FIELDS + field)) * s->stride;
}

/* out := a out + b in */
static void mix(size_t n, REAL a, REAL b, const REAL *restrict in, REAL *restrict out)
{
#pragma omp simd
    for (size_t i = 0; i < n; i++)
        out[i] = a * out[i] + b * in[i];
}

/* The row of the unclamped splines at an end of y from that next to it (G5), in some columns. */
static void end_row(const struct sweep *s, REAL *ring, bool high, struct rows columns)
{
    const size_t row = high ? unclamped(s, 1) - 1 : 0, next = high ? row - 1 : 1;
    for (int component = 0; component < 3; component++)
        for (int field = 0; field < DEPTH_FIELDS; field++) {
            const REAL *in = ring_row(s, ring, next, component, field) + columns.from;
            REAL *out = ring_row(s, ring, row, component, field) + columns.from;
            if (s->mirror[1][high])
                mix(columns.end - columns.from, 0, component == 1 ? -1 : 1, in, out);
            else
                mix(columns.end - columns.from, 2, -1, in, out);
        }
}

/* The control values behind some columns of the unclamped splines, a vector at least. */
static struct rows controls_of(const struct sweep *s, struct rows columns)
{
    const size_t n = s->n[0], end = less(columns.end, s->low[0]);
    struct rows controls = {less(columns.from, s->low[0]), end < n ? end : n};
    if (controls.end < controls.from + GROUP)
        controls.end = controls.from + GROUP < n ? controls.from + GROUP : n;
    if (controls.end < controls.from + GROUP) controls.from = less(controls.end, GROUP);
    return controls;
}

/* Values and slopes over depth of row `row` of the unclamped splines of u, or w in its place, in some columns. */
static void read_row(const struct pass *pass, const REAL *u, REAL *ring, size_t m, size_t row,
                     struct rows columns)
{
    const struct sweep *s = pass->s;
    const size_t last = s->cells[0] + 1;
    const bool ghost = row < s->low[1] || row - s->low[1] >= s->n[1];
    const struct rows controls = controls_of(s, columns);
    for (int component = 0; component < 3 && !ghost; component++) {
        const REAL *in[SPAN];
        REAL *out[DEPTH_FIELDS];
        for (size_t d = 0; d < SPAN; d++)
            in[d] = u + (size_t)component * s->volume + (s->pair[m].base + d) * s->plane +
                    (row - s->low[1]) * s->n[0] + controls.from;
        for (int field = 0; field < DEPTH_FIELDS; field++)
            out[field] = ring_row(s, ring, row, component, field) + s->low[0] + controls.from;
        NAME(taken_sweep_kernels)
        ()->depth(controls.end - controls.from, in, s->pair[m].weight[component == DEPTH], out);
        for (int field = 0; field < DEPTH_FIELDS; field++) {
            REAL *to = ring_row(s, ring, row, component, field);
            const REAL sign = component == 0 ? -1 : 1;
            if (controls.from == 0) to[0] = s->mirror[0][0] ? sign * to[1] : 2 * to[0] - to[1];
            if (controls.end == s->n[0])
                to[last] = s->mirror[0][1] ? sign * to[last - 1] : 2 * to[last] - to[last - 1];
        }
    }
    if (row == 1) end_row(s, ring, false, columns);
    if (row == s->cells[1] + 1) end_row(s, ring, true, columns);
}

#include "method/consistent/general/sweep_layers.h"

/* Rows of a ring that row j of points reads. */
static void take_values(const struct sweep *s, REAL *ring, size_t j, struct NAME(sweep_row) * points)
{
    for (size_t d = 0; d < SPAN; d++)
        points->in[d] = ring_row(s, ring, j + d, 0, 0);
}

/* Slopes of u of a part at a row of points where layers are, with their memory. */
static void slope_row_of(const struct pass *pass, const struct rings *r,
                         const struct NAME(sweep_row) * points, size_t p, int f, size_t m, size_t j,
                         enum task task)
{
    struct NAME(sweep_row) rate = *points;
    NAME(taken_sweep_kernels)()->slopes(points);
    if (task != PULL) {
        take_values(pass->s, ring_of(pass->s, r->rate, p), j, &rate);
        rate.scratch = r->rates;
    }
    add_memory(pass, points, task != PULL ? &rate : NULL, p, f, m, j);
}

/* Moduli of a part at row j. */
static void take_moduli(const struct pass *pass, size_t p, int f, size_t m, size_t j,
                        struct NAME(sweep_row) * points)
{
    const struct sweep *s = pass->s;
    const struct family *family = &pass->fields->part[p].ground->family[f];
    const size_t at = m * s->points[f][0] + j, row = m * family->n[1] + j;
    points->lambda = (const REAL *)s->moduli[p].lambda[f] + at * s->width;
    points->mu = (const REAL *)s->moduli[p].mu[f] + at * s->width;
    if (family->runs == 0) return;
    points->run = family->run + family->first_run[row];
    points->runs = family->first_run[row + 1] - family->first_run[row];
    points->stiffness = family->stiffness;
}

/* Slopes and stresses of a part at row j, and what they pull at if there is no other part. */
static void point_row_of(const struct pass *pass, const struct rings *r, struct NAME(sweep_row) * points,
                         size_t p, int f, size_t m, size_t j, enum task task)
{
    const struct NAME(sweep_kernels) *kernels = NAME(taken_sweep_kernels)();
    const bool layered = pass->s->layered;
    take_moduli(pass, p, f, m, j, points);
    take_values(pass->s, ring_of(pass->s, r->value, p), j, points);
    if (layered) slope_row_of(pass, r, points, p, f, m, j, task);
    if (task == MOVE) return;
    if (pass->fields->parts > 1)
        kernels->stresses_of(points, layered, p > 0);
    else if (layered)
        kernels->stresses(points);
    else
        kernels->points(points);
}

/* Row j of the points of a family. */
static void point_row(const struct pass *pass, const struct rings *r, int f, size_t m, size_t j,
                      enum task task)
{
    const struct sweep *s = pass->s;
    const struct family *family = &pass->c->general->family[f];
    const bool deep_knots = family->at[DEPTH] == AT_KNOTS;
    struct NAME(sweep_row) points = {.x_knots = family->at[0] == AT_KNOTS,
                                     .y_knots = family->at[1] == AT_KNOTS,
                                     .field = deep_knots ? VALUE_KNOTS : VALUE_MIDDLES,
                                     .across = deep_knots ? ACROSS_KNOTS : ACROSS_MIDDLES,
                                     .width = s->width,
                                     .stride = s->stride,
                                     .scratch = r->scratch};
    for (int slot = 0; slot < 3; slot++)
        points.factor[slot] = (REAL)s->factor[f][slot];
    struct hill_row level;
    struct NAME(sweep_hill) hill;
    if (general_hill_row(pass->c, family, j, m, &level)) {
        hill = (struct NAME(sweep_hill)){.share = (REAL)level.share, .fall = (REAL)level.fall};
        hill.drop = (const REAL *)s->hill[f][0] + j * s->width;
        for (int slot = 0; slot < 2; slot++)
            hill.slope[slot] = (const REAL *)s->hill[f][1 + slot] + j * s->width;
        points.hill = &hill;
    }
    for (size_t d = 0; d < SPAN; d++)
        points.out[d] = pull_row(s, r->pull, j + d, 0, 0);
    for (size_t p = 0; p < pass->fields->parts; p++)
        point_row_of(pass, r, &points, p, f, m, j, task);
    if (task != MOVE && pass->fields->parts > 1) NAME(taken_sweep_kernels)()->pulls_of(&points, s->layered);
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
        const REAL *in[PULL_FIELDS];
        REAL *out[SPAN];
        for (int field = 0; field < PULL_FIELDS; field++)
            in[field] = pull_row(s, r->pull, row, component, field);
        for (size_t d = 0; d < SPAN; d++)
            out[d] = force_row(s, r, s->pair[m].base + d, (size_t)component, row);
        NAME(taken_sweep_kernels)
        ()->pulls(s->layered, s->width, in, s->pair[m].weight[component == DEPTH], out);
    }
    keep_row(pass, r, m, row);
}

/* All fields that a row of points needs. */
static void read_rows(const struct pass *pass, const struct rings *r, size_t m, size_t row, enum task task)
{
    for (size_t p = 0; p < pass->fields->parts; p++) {
        read_row(pass, pass->fields->part[p].u, ring_of(pass->s, r->value, p), m, row,
                 (struct rows){0, pass->s->width});
        if (task != PULL) read_rates(pass, ring_of(pass->s, r->rate, p), p, m, row);
    }
}

/* All points of pair m that move anything. */
static void point_planes(const struct pass *pass, struct rings *r, size_t m, enum task task)
{
    struct sweep *s = pass->s;
    const struct rows loud = loud_rows(pass, m);
    if (loud.from >= loud.end) return;
    const size_t from = less(loud.from + s->low[1], 2);
    const size_t most = s->cells[1] + 1, after = loud.end + s->low[1] + 1;
    const size_t end = after < most ? after : most;
    for (size_t slot = 0; slot < SPAN; slot++) /* the first two rows; what no point of a plane sets */
        memset(pull_row(s, r->pull, slot, 0, 0), 0, (size_t)P_ROWS * s->stride * sizeof(REAL));
    for (size_t row = from; row < from + 2; row++)
        read_rows(pass, r, m, row, task);
    for (size_t j = from; j < end; j++) {
        if (j + 2 < unclamped(s, 1)) read_rows(pass, r, m, j + 2, task);
        for (int f = 0; f < 3; f++)
            if (m < s->points[f][1] && j < s->points[f][0]) point_row(pass, r, f, m, j, task);
        if (task != MOVE) write_row(pass, r, m, j);
    }
    if (task == MOVE) return;
    for (size_t row = end; row < end + 2 && row < unclamped(s, 1); row++)
        write_row(pass, r, m, row);
    for (size_t k = s->pair[m].base; k < s->pair[m].base + SPAN; k++)
        join(&r->touched[k % SPAN], from, end + 2 < unclamped(s, 1) ? end + 2 : unclamped(s, 1));
}
