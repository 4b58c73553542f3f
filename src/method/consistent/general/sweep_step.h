/* The order of a sweep (sweep.h) for numbers of type REAL; included by sweep_double.c and sweep_single.c.
 *
 * A thread has planes of its own. What its neighbours read of the displacements is brought on first (stage 0); then
 * the memory of absorbing layers at points that two threads need (1), points and the update of those planes whose
 * neighbours are a thread's own (2), last the others (5). In between memory over depth goes on (3), and the planes that
 * wait for it (4); all threads wait after each. Each sum is taken in one order: the same bits with any number of
 * threads. */
#include "base/machine.h"
#include "method/consistent/fused/settled.h"

enum { BRING, MOVE_SHARED, POINTS, MOVE_OVER_DEPTH, GO_ON, FINISH, STAGES };

/* Are all planes that the update of these reads those of the thread, and none waits? */
static bool own(const struct pass *pass, size_t first, size_t from, size_t end)
{
    const struct sweep *s = pass->s;
    const size_t after = first + SWEEP_PLANES + SWEEP_REACH;
    for (size_t k = less(first, SWEEP_REACH); k < after; k++)
        if (waits(pass, k)) return false;
    return (from == 0 || first >= from + SWEEP_REACH) && (end == s->n[2] || after <= end);
}

/* The first pair of planes that a thread needs of its planes' neighbours: two of them. */
static size_t first_pair(const struct sweep *s, size_t from)
{
    return less(from + s->low[2], 2);
}

static enum task task_of(const struct pass *pass, size_t m)
{
    const struct sweep *s = pass->s;
    if (!pass->moving || !plane_is_layered(pass, m)) return PULL;
    for (int thread = 1; thread < s->threads; thread++) {
        const size_t from = s->bound[thread], first = first_pair(s, from);
        if (from > 0 && from < s->n[2] && m >= first && m < first + 2) return PULL;
    }
    return PULL_AND_MOVE;
}

/* Memory at the points that the thread before needs too. */
static void move_shared(const struct pass *pass, struct rings *r, size_t from)
{
    for (size_t m = first_pair(pass->s, from); from > 0 && m < first_pair(pass->s, from) + 2; m++)
        if (pass->moving && plane_is_layered(pass, m)) point_planes(pass, r, m, MOVE);
}

/* Planes from `from` to `end`. */
static void sweep_points(const struct pass *pass, struct rings *r, size_t from, size_t end)
{
    const struct sweep *s = pass->s;
    size_t next = from + 2, done = from, finished = from;
    for (size_t slot = 0; slot < SPAN; slot++) {
        r->touched[slot] = (struct rows){0, 0};
        r->edged[slot] = 0;
    }
    memset(r->force, 0, (3 * SPAN * unclamped(s, 1) * s->stride + s->part_size) * sizeof(REAL));
    for (size_t m = first_pair(s, from); done < end; m++) {
        if (m <= s->cells[2]) {
            for (; pass->moving && next < s->pair[m].base + SPAN && next + 2 < end; next++)
                bring_plane(pass, next);
            point_planes(pass, r, m, task_of(pass, m));
        }
        if (m >= s->low[2] && m - s->low[2] < from) forget_plane(pass, r, m - s->low[2]);
        if (m >= done + s->low[2]) plane_done(pass, r, done++);
        for (; finished < end; finished += SWEEP_PLANES) {
            const size_t after = finished + SWEEP_PLANES + SWEEP_REACH;
            if (!own(pass, finished, from, end)) continue;
            if (done < (after < end ? after : end)) break;
            finish_planes(pass, r, finished);
        }
    }
}

static void sweep_stage(const struct pass *pass, size_t thread, int stage)
{
    const struct sweep *s = pass->s;
    const size_t from = s->bound[thread], end = s->bound[thread + 1], threads = (size_t)pass->c->threads;
    struct rings r = rings_of(s, s->buffer[thread]);
    if (from >= end && stage != MOVE_OVER_DEPTH) return;
    if (stage == BRING)
        for (size_t k = from; k < end; k++) {
            if (!pass->moving || k < from + 2 || k + 2 >= end) bring_plane(pass, k);
        }
    else if (stage == MOVE_SHARED)
        move_shared(pass, &r, from);
    else if (stage == POINTS)
        sweep_points(pass, &r, from, end);
    else if (stage == MOVE_OVER_DEPTH && pass->moving)
        move_over_depth(pass, s->n[1] * thread / threads, s->n[1] * (thread + 1) / threads);
    else if (stage == GO_ON)
        for (size_t k = from; k < end; k++) {
            if (waits(pass, k)) go_on_with_plane(pass, &r, k);
        }
    else if (stage == FINISH)
        for (size_t first = from; first < end; first += SWEEP_PLANES)
            if (!own(pass, first, from, end)) finish_planes(pass, &r, first);
}

/* Largest displacement of all rows of all ranks. */
static double largest_size(const struct pass *pass)
{
    const struct sweep *s = pass->s;
    double largest = 0;
    for (size_t row = 0; row < s->n[1] * s->n[2]; row++)
        if (s->size[row] > largest) largest = s->size[row];
    return part_largest(pass->c, largest);
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
    lay_deep(pass);
    for (int stage = 0; stage < STAGES; stage++) {
#pragma omp parallel for num_threads(threads) schedule(static, 1)
        for (int thread = 0; thread < threads; thread++) {
            const unsigned before = tiny_as_zero();
            sweep_stage(pass, (size_t)thread, stage);
            tiny_as_before(before);
        }
        if (stage == BRING && !pass->moving) pass->level = s->quiet * largest_size(pass);
    }
    s->largest = largest_size(pass);
    const struct part_fields fields = part_values(pass->c, pass->out, 3, sizeof(REAL));
    part_exchange(pass->c, &fields);
}

static void accelerate(struct consistent *c, const struct drive *drive,
                       const struct NAME(sweep_fields) * fields)
{
    struct pass pass = {.c = c,
                        .s = c->general->sweep,
                        .drive = drive,
                        .fields = fields,
                        .factor = 1,
                        .out = fields->work,
                        .extra = fields->part[0].extra};
    memset(fields->work, 0, c->model.unknowns * sizeof *fields->work);
    sweep_over(&pass);
}

/* Is any of the fields or w not 0 in a row from number `at` on? */
static bool row_moves(const struct sweep *s, const struct NAME(sweep_fields) * fields, size_t at)
{
    bool moves = taken_passes()->NAME(largest_size)(fields->w + at, s->n[0]) != 0;
    for (size_t f = 0; f < fields->fields && !moves; f++)
        moves = taken_passes()->NAME(largest_size)((const REAL *)fields->kept[f] + at, s->n[0]) != 0;
    return moves;
}

/* Rows that move, in the halo all, and the largest u. */
static void find_reached(const struct pass *pass)
{
    struct sweep *s = pass->s;
    s->largest = 0;
    for (size_t k = 0; k < s->n[2]; k++) {
        const bool halo = k < pass->c->part.along[DEPTH].own || k >= pass->c->part.along[DEPTH].end;
        s->reached[k] = (struct rows){0, halo ? s->n[1] : 0};
        for (size_t component = 0; component < 3; component++)
            for (size_t j = 0; j < s->n[1]; j++) {
                const size_t at = component * s->volume + k * s->plane + j * s->n[0];
                const double size = row_size(pass, at);
                if (size > s->largest) s->largest = size;
                if (row_moves(s, pass->fields, at)) join(&s->reached[k], j, j + 1);
            }
    }
    s->largest = part_largest(pass->c, s->largest);
    s->known = true;
}

void NAME(sweep_begin)(struct consistent *c, const struct drive *drive, double dt,
                       const struct NAME(sweep_fields) * fields)
{
    c->general->sweep->known = false;
    accelerate(c, drive, fields);
    for (size_t i = 0; i < c->model.unknowns; i++)
        fields->w[i] += (REAL)(dt / 2) * fields->work[i];
}

void NAME(sweep_settle)(struct consistent *c, const struct drive *drive, double dt,
                        const struct NAME(sweep_fields) * fields, double *y, double *a)
{
    const struct NAME(settled)
        settled = {c->model.unknowns, c->threads, fields->part[0].u, fields->w, fields->work};
    accelerate(c, drive, fields);
    NAME(settle)(&settled, dt, y, a);
}

/* u itself, and memory, at an entry of a state. */
static void tell(const struct NAME(sweep_fields) * fields, size_t n, size_t at, double *y)
{
    if (fields->relax == NULL)
        y[at] = fields->part[0].u[at];
    else
        fused_tell(fields->relax, n, at, (const void *const *)fields->kept, sizeof(REAL), y);
}

void NAME(sweep_advance)(struct consistent *c, const struct drive *drive, double dt,
                         const struct NAME(sweep_fields) * fields, double *y, double *a)
{
    struct sweep *s = c->general->sweep;
    const struct watch *watch = &c->watch;
    const REAL *w = fields->w;
    if (s->layered) general_layers_prepare(c, dt);
    struct pass pass = {.c = c,
                        .s = s,
                        .drive = drive,
                        .fields = fields,
                        .out = fields->w,
                        .factor = (REAL)dt,
                        .moving = true,
                        .dt = dt,
                        .extra = fields->part[0].extra};
    if (!s->known) find_reached(&pass);
    drag_planes(&pass);
    for (size_t i = 0; i < watch->count; i++)
        watch->before[i] = w[watch->entry[i]];
    pass.level = s->quiet * s->largest;
    sweep_over(&pass);
    for (size_t i = 0; i < watch->count; i++) {
        const size_t at = watch->entry[i];
        const double before = watch->before[i], after = w[at];
        tell(fields, c->model.unknowns, at, y);
        y[c->model.unknowns + at] = (before + after) / 2;
        a[at] = (after - before) / dt;
    }
}
