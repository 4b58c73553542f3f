/* A step of leapfrog in one pass over the fields (fused.h), for numbers of type REAL; included by
 * fused_double.c and fused_single.c.
 *
 *   u(n+1) = u(n) + dt w(n+1/2),   w(n+3/2) = w(n+1/2) + dt a(n+1),   a(n+1) = (F1) + edges + loads + layers
 *
 * The first runs ahead of (F1) by the planes that it reaches, the second follows it row by row, so that u and
 * w come from memory once and go there once. A thread has planes of its own; those that its neighbours read
 * too are brought on first, and all threads wait for that. */
#include "base/machine.h"
#include "method/consistent/absorbing/pml_fast.h"
#include "method/consistent/fused/fused.h"
#include "method/consistent/fused/settled.h"
#include "method/spline/passes.h"

#include <string.h>

/* What the blocks of a thread share. */
struct pass {
    const struct consistent *c;
    const struct drive *drive;
    struct fused_fields fields;
    double level;       /* smaller displacements move nothing */
    size_t next, limit; /* the next plane to be brought on; those from `limit` on are already */
    int thread;
    bool begun; /* it has made a plane */
};

/* Adds factor times what edges and loads do in plane k. */
static void add_rest(const struct consistent *c, const struct drive *drive, size_t k, double factor,
                     const REAL *u, REAL *field)
{
    REAL *out[3];
    for (size_t component = 0; component < 3; component++)
        out[component] = field + component * c->volume + k * c->plane;
    NAME(hform_edges)(c, k, factor, u, out);
    const struct sparse_list *loads = &c->hform->load;
    for (size_t component = 0; drive->load != NULL && component < 3; component++) {
        const size_t at = component * c->n[DEPTH] + k;
        for (size_t i = loads->start[at]; i < loads->start[at + 1]; i++) {
            const size_t l = loads->number[i], part = loads->part[i];
            const struct sparse *load = &loads->of[l];
            const double amplitude = factor * drive->load[l] * c->model.scene->load[l].amplitude;
            for (size_t e = load->start[part]; amplitude != 0 && e < load->start[part + 1]; e++)
                out[component][load->index[e]] += (REAL)(amplitude * load->value[e]);
        }
    }
}

/* What edges make of u, in plane k. */
static struct window reached_by_edges(const struct consistent *c, const struct fused *f, size_t k)
{
    struct window reached = {{0, 0}, {0, 0}};
    for (size_t e = 0; e < c->hform->edges; e++) {
        const struct edge *edge = &c->hform->edge[e];
        const bool along[2] = {edge->column[0] == NULL, edge->column[1] == NULL};
        const bool upright = !along[0] && !along[1];
        const size_t plane = upright ? k : edge->at[2];
        const size_t half = upright && edge->depth != NULL ? edge->depth->half : 0;
        if (k < edge->from[2] || k >= edge->to[2]) continue;
        struct window source = {{0, 0}, {0, 0}};
        for (size_t p = less(plane, half); p <= plane + half && p < f->n[2]; p++)
            source = window_join(&source, &f->reached[p]);
        if (!window_holds(&source, along[0] ? source.from[0] : edge->at[0],
                          along[1] ? source.from[1] : edge->at[1]))
            continue;
        for (int axis = 0; axis < 2; axis++) {
            if (along[axis]) continue;
            source.from[axis] = edge->from[axis];
            source.end[axis] = edge->to[axis];
        }
        reached = window_join(&reached, &source);
    }
    return reached;
}

/* What a block reads is brought on before, since its window hangs on that, or, where what neighbours have
 * brought on shows that it is whole, on the way. */
static void take_window(struct pass *pass, size_t first)
{
    const struct fused *f = FUSED(pass->c);
    const size_t reach = (size_t)f->deep / 2, high = first + FUSED_PLANES + reach;
    const size_t upto = high < pass->limit ? high : pass->limit;
    struct fused_fields *fields = &pass->fields;
    struct loud loud = nothing_loud(f);
    fields->bring_on = pass->next;
    fields->before = upto > pass->next ? upto : pass->next;
    widen_loud(f, pass->level, less(first, reach), fields->bring_on, &loud);
    widen_loud(f, pass->level, fields->before, high, &loud);
    struct window window = window_of(f, &loud);
    if (window_points(&window) < f->plane) {
        bring_planes(f, fields, fields->bring_on, fields->before);
        widen_loud(f, pass->level, fields->bring_on, fields->before, &loud);
        window = window_of(f, &loud);
        fields->bring_on = fields->before;
    }
    pass->next = fields->before;
    f->computed[first / FUSED_PLANES] = window;
}

/* (F1), which brings all displacements on, and what others add to it. */
static void pass_block(struct pass *pass, size_t first)
{
    const struct fused *f = FUSED(pass->c);
    const bool step = pass->fields.moved != NULL;
    const double factor = step ? pass->fields.dt : 1;
    if (step && f->rows.ranks == 1) take_window(pass, first);
    NAME(fused_planes)(f, pass->thread, first, &pass->fields);
    for (size_t k = first; k < first + FUSED_PLANES && k < f->n[2]; k++) {
        add_rest(pass->c, pass->drive, k, factor, pass->fields.u, pass->fields.a);
        add_faces(pass->c, pass->thread, factor, &pass->fields, !pass->begun, k);
        pass->begun = true;
        if (!step) continue;
        const struct window edges = reached_by_edges(pass->c, f, k), faces = reached_by_faces(pass->c, f, k);
        struct window *after = &f->will_reach[k];
        *after = window_join(&f->reached[k], &f->computed[first / FUSED_PLANES]);
        *after = window_join(after, &f->loaded[k]);
        *after = window_join(after, &edges);
        *after = window_join(after, &faces);
    }
}

/* What a block cost in the last call: a point that is only brought on an eighth of one that is computed. */
static size_t cost(const struct fused *f, size_t block)
{
    enum { COMPUTED = 8 };
    const size_t first = block * FUSED_PLANES;
    size_t sum = 1 + COMPUTED * FUSED_PLANES * window_points(&f->computed[block]);
    for (size_t k = first; k < first + FUSED_PLANES && k < f->n[2]; k++)
        sum += window_points(&f->reached[k]);
    return sum;
}

/* Where those of the planes begin that each thread makes, so that all have about as much to do. What is computed does
 * not depend on the bounds. */
static void lay_bounds(const struct fused *f, struct part_range made)
{
    const size_t threads = (size_t)f->threads;
    size_t all = 0, done = 0, thread = 1;
    for (size_t first = made.from; first < made.end; first += FUSED_PLANES)
        all += cost(f, first / FUSED_PLANES);
    f->bound[0] = made.from;
    for (size_t first = made.from; first < made.end; first += FUSED_PLANES) {
        while (thread < threads && done * threads >= all * thread)
            f->bound[thread++] = first;
        done += cost(f, first / FUSED_PLANES);
    }
    while (thread <= threads)
        f->bound[thread++] = made.end;
}

static size_t between(size_t a, size_t low, size_t high)
{
    return a < low ? low : a > high ? high : a;
}

/* The blocks of a thread: all of u that others read is brought on before (stage 0), the rest on the way. `bring`: those
 * that all threads bring on. */
static void pass_thread(const struct consistent *c, const struct drive *drive,
                        const struct fused_fields *fields, struct part_range bring, double level, int thread,
                        int stage)
{
    const struct fused *f = FUSED(c);
    const bool lowest = thread == 0, highest = thread + 1 == f->threads;
    const size_t reach = (size_t)f->deep / 2, from = f->bound[thread], end = f->bound[thread + 1];
    const size_t first = lowest ? bring.from : between(from, bring.from, bring.end);
    const size_t last = highest ? bring.end : between(end, first, bring.end);
    const size_t low = lowest ? first : between(first + reach, first, last);
    const size_t high = highest ? last : between(less(last, reach), low, last);
    if (stage == 0) {
        bring_planes(f, fields, first, low);
        bring_planes(f, fields, high, last);
        return;
    }
    struct pass pass = {c, drive, *fields, level, low, high, thread, false};
    for (size_t block = from; block < end; block += FUSED_PLANES) {
        pass_block(&pass, block);
        if (lowest) ranks_go_on(f->ranks);
    }
    bring_planes(f, fields, pass.next, pass.limit);
}

/* All of u at once: what is computed hangs on what other ranks have in the same planes. */
static void bring_before(struct fused *f, const struct fused_fields *fields, double level)
{
#pragma omp parallel for num_threads(f->threads) schedule(static)
    for (size_t k = 0; k < f->n[2]; k++) {
        const unsigned before = tiny_as_zero();
        bring_planes(f, fields, k, k + 1);
        tiny_as_before(before);
    }
    meet_loud(f, level);
}

/* The planes that are made in a turn; in a step those of u that they read are brought on too, of those that `still`
 * have to be. */
static void pass_turn(const struct consistent *c, const struct drive *drive,
                      const struct fused_fields *fields, double level, int turn, struct part_range *still)
{
    struct fused *f = FUSED(c);
    const size_t reach = (size_t)f->deep / 2;
    const struct part_range made = c->part.made[turn];
    struct part_range bring = *still;
    if (turn < PART_LAST && made.from >= made.end) return;
    if (turn == PART_HIGH)
        still->end = bring.from = between(less(made.from, reach), still->from, still->end);
    else
        still->from = bring.end =
            turn == PART_LAST ? still->end : between(made.end + reach, still->from, still->end);
    lay_bounds(f, made);
#pragma omp parallel num_threads(f->threads)
    for (int stage = bring.from < bring.end ? 0 : 1; stage < 2; stage++) {
#pragma omp for schedule(static, 1)
        for (int thread = 0; thread < f->threads; thread++) {
            const unsigned before = tiny_as_zero();
            pass_thread(c, drive, fields, bring, level, thread, stage);
            tiny_as_before(before);
        }
    }
}

/* After an exchange a halo may have reached everywhere. */
static void halo_reached(const struct consistent *c, const struct fused *f)
{
    for (size_t k = 0; k < f->n[2]; k++)
        if (part_rows(&c->part) || k < f->planes.own || k >= f->planes.end) f->reached[k] = fused_whole(f);
}

/* What layers add in a turn; then what is made travels. */
static void pull_turn(const struct consistent *c, const struct NAME(step_fields) * step, double factor,
                      int turn, REAL *out)
{
    const struct part_fields fields = part_values(c, out, 3, sizeof *out);
    for (size_t p = 0; p < step->parts && c->pml != NULL; p++)
        NAME(pml_fast_pull)(step->part[p].c, turn, factor, step->part[p].extra, out);
    part_send(c, &fields, turn);
}

/* Faces across depth, before all planes: theirs of u are brought on first, and leave those that `still` have to be. */
static void begin_faces(const struct consistent *c, const struct fused_fields *fields,
                        struct part_range *still)
{
    const struct fused_faces *faces = c->fused->faces;
    if (left_at_faces(c, fields) == NULL) return;
    for (size_t i = 0; i < faces->count; i++) {
        const size_t at = faces->face[i].at;
        if (faces->face[i].axis != DEPTH || at < still->from || at >= still->end) continue;
        bring_planes(FUSED(c), fields, at, at + 1);
        if (faces->face[i].end == 0)
            still->from = at + 1;
        else
            still->end = at;
    }
#pragma omp parallel for num_threads(c->threads) schedule(static, 1)
    for (int thread = 0; thread < c->threads; thread++)
        make_flat(c, thread, fields);
}

/* Accelerations, or in a step velocities, with the halo: in turns, so that halos travel while the inside is made. */
static void make(const struct consistent *c, const struct drive *drive, const struct fused_fields *fields,
                 double level, const struct NAME(step_fields) * step)
{
    struct fused *f = FUSED(c);
    const bool moving = fields->moved != NULL, before = f->rows.ranks > 1;
    struct part_range still = {0, moving && !before ? f->n[2] : 0};
    if (moving && before) bring_before(f, fields, level);
    begin_faces(c, fields, &still);
    for (size_t p = 0; p < step->parts && c->pml != NULL; p++)
        NAME(pml_fast_look)(step->part[p].c, step->part[p].extra);
    for (int turn = 0; turn < PART_TURNS; turn++) {
        pass_turn(c, drive, fields, level, turn, &still);
        pull_turn(c, step, moving ? fields->dt : 1, turn, fields->a);
    }
}

/* a := acceleration. */
static void accelerate(const struct consistent *c, const struct drive *drive,
                       const struct NAME(step_fields) * step, REAL *a)
{
    const struct fused_fields fields = {
        .u = step->part[0].u, .a = a, .other = step->parts > 1 ? step->part[1].u : NULL};
    NAME(fused_look)(FUSED(c), step->part[0].u);
    make(c, drive, &fields, 0, step);
}

void NAME(fused_begin)(const struct consistent *c, const struct drive *drive, double dt,
                       const struct NAME(step_fields) * step, double *a)
{
    const struct watch *watch = &c->watch;
    FUSED(c)->known = false;
    accelerate(c, drive, step, step->work);
    for (size_t i = 0; i < c->model.unknowns; i++)
        step->w[i] += (REAL)(dt / 2) * step->work[i];
    for (size_t i = 0; i < watch->count; i++)
        a[watch->entry[i]] = step->work[watch->entry[i]];
}

/* Mean velocities of the u of a part over the step to come, where layers ask for them: w, or if they relax in
 * `work`. */
static const REAL *rates(const struct consistent *c, const struct NAME(step_fields) * step, size_t part)
{
    const struct fused_relax *relax = step->relax;
    if (relax == NULL) return step->w;
    REAL by[FUSED_FIELDS_KEPT];
    for (size_t f = 0; f < relax->fields; f++)
        by[f] = (REAL)(relax->by[part][f] / relax->dt);
    const REAL factor = (REAL)(relax->rate[part] / relax->dt);
    for (size_t s = 0; s < c->pml->slabs; s++) {
        const struct block *region = &c->pml->slab[s].region;
        const size_t rows = region->n[1] * region->n[2];
#pragma omp parallel for num_threads(c->threads) schedule(static)
        for (size_t row = 0; row < 3 * rows; row++) {
            const size_t k = row % rows / region->n[1] + region->at[2],
                         j = row % region->n[1] + region->at[1];
            const size_t at = row / rows * c->volume + k * c->plane + j * c->n[0] + region->at[0];
            for (size_t i = at; i < at + region->n[0]; i++) {
                REAL sum = factor * step->w[i];
                for (size_t f = 0; f < relax->fields; f++)
                    sum += by[f] * ((const REAL *)step->kept[f])[i];
                step->work[i] = sum;
            }
        }
    }
    return step->work;
}

/* u itself, and memory, at an entry of a state. */
static void tell(const struct NAME(step_fields) * step, size_t n, size_t at, double *y)
{
    if (step->relax == NULL)
        y[at] = step->part[0].u[at];
    else
        fused_tell(step->relax, n, at, (const void *const *)step->kept, sizeof(REAL), y);
}

/* The layers' memory goes on before u does, from the displacements in the middle of the step; what it does
 * then comes last. */
void NAME(fused_advance)(const struct consistent *c, const struct drive *drive, double dt,
                         const struct NAME(step_fields) * step, double *y, double *a)
{
    struct fused *f = FUSED(c);
    const struct watch *watch = &c->watch;
    const bool dragged = c->pml != NULL && c->pml->drag > 0;
    REAL *u = step->part[0].u;
    const struct fused_fields fields = {.u = u,
                                        .a = step->w,
                                        .moved = u,
                                        .dt = dt,
                                        .relax = step->relax,
                                        .kept = step->kept,
                                        .dragged = dragged ? c->pml : NULL,
                                        .other = step->parts > 1 ? step->part[1].u : NULL};
    const double level = f->quiet * largest_before(f, u);
    const size_t n = c->model.unknowns;
    if (!f->known) find_reached(f, u, step->w);
    for (size_t k = 0; k < f->n[2]; k++)
        forget_sizes(f, k);
    if (dragged) pml_keep(c, dt);
    if (dragged) drag_planes(f, &fields);
    for (size_t i = 0; i < watch->count; i++)
        watch->before[i] = step->w[watch->entry[i]];
    for (size_t p = 0; p < step->parts && c->pml != NULL; p++)
        NAME(pml_fast_remember)
    (step->part[p].c, dt, dt / 2, level, step->part[p].u, rates(c, step, p), step->part[p].extra);
    make(c, drive, &fields, level, step);
    for (size_t p = 0; p < step->parts && c->pml != NULL; p++)
        NAME(pml_fast_reached)(step->part[p].c, f->will_reach);
    struct window *spare = f->reached;
    f->reached = f->will_reach;
    f->will_reach = spare;
    halo_reached(c, f);
    for (size_t i = 0; i < watch->count; i++) {
        const size_t at = watch->entry[i];
        const double before = watch->before[i], after = step->w[at];
        tell(step, n, at, y);
        y[n + at] = (before + after) / 2;
        a[at] = (after - before) / dt;
    }
    fused_count(f);
}

void NAME(fused_settle)(const struct consistent *c, const struct drive *drive, double dt,
                        const struct NAME(step_fields) * step, double *y, double *a)
{
    const struct NAME(settled)
        settled = {c->model.unknowns, c->threads, step->part[0].u, step->w, step->work};
    accelerate(c, drive, step, step->work);
    NAME(settle)(&settled, dt, y, a);
}
