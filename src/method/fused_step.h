/* A step of leapfrog in one pass over the fields (fused.h), for numbers of type REAL; included by
 * fused_double.c and fused_single.c.
 *
 *   u(n+1) = u(n) + dt w(n+1/2),   w(n+3/2) = w(n+1/2) + dt a(n+1),   a(n+1) = (F1) + edges + loads + layers
 *
 * The first runs ahead of (F1) by the planes that it reaches, the second follows it row by row, so that u and
 * w come from memory once and go there once. A thread has planes of its own; those that its neighbours read
 * too are brought on first, and all threads wait for that. */
#include "method/fused.h"
#include "method/passes.h"
#include "method/pml_fast.h"

#include <string.h>

/* What the blocks of a thread share. */
struct pass {
    const struct consistent *c;
    const struct drive *drive;
    struct fused_fields fields;
    double level;       /* smaller displacements move nothing */
    size_t next, limit; /* the next plane to be brought on; those from `limit` on are already */
    int thread;
};

static void bring_planes(const struct fused *f, const struct fused_fields *fields, size_t from, size_t end)
{
    for (size_t k = from; k < end; k++)
        bring_on(f, fields, k, 0, f->n[1]);
}

static bool loud(const struct fused *f, double level, size_t from, size_t end)
{
    for (size_t k = from; k < end && k < f->n[2]; k++)
        if (f->size[k] > level) return true;
    return false;
}

/* Adds factor times what edges and loads do in plane k. */
static void add_rest(const struct consistent *c, const struct drive *drive, size_t k, double factor,
                     const REAL *u, REAL *field)
{
    REAL *out[3];
    for (size_t component = 0; component < 3; component++)
        out[component] = field + component * c->volume + k * c->plane;
    NAME(hform_edges)(c, k, factor, u, out);
    for (size_t l = 0; drive->load != NULL && l < c->model.scene->loads; l++) {
        const struct sparse *load = &c->hform->load[l];
        const double amplitude = factor * drive->load[l] * c->model.scene->load[l].amplitude;
        for (size_t component = 0; amplitude != 0 && component < 3; component++) {
            const size_t at = component * c->n[DEPTH] + k;
            for (size_t e = load->start[at]; e < load->start[at + 1]; e++)
                out[component][load->index[e]] += (REAL)(amplitude * load->value[e]);
        }
    }
}

/* Whether a block is computed hangs on planes that may not have been brought on yet: those are then brought
 * on before, else on the way. */
static void pass_block(struct pass *pass, size_t first)
{
    const struct consistent *c = pass->c;
    const struct fused *f = FUSED(c);
    const size_t reach = (size_t)f->deep / 2, low = first < reach ? 0 : first - reach;
    const size_t planes = f->n[2] - first < FUSED_PLANES ? f->n[2] - first : FUSED_PLANES;
    const size_t high = first + FUSED_PLANES + reach, upto = high < pass->limit ? high : pass->limit;
    struct fused_fields *fields = &pass->fields;
    fields->bring_on = pass->next;
    fields->before = upto > pass->next ? upto : pass->next;
    bool computed = f->quiet <= 0 || loud(f, pass->level, low, fields->bring_on) ||
                    loud(f, pass->level, fields->before, high);
    if (!computed) {
        bring_planes(f, fields, fields->bring_on, fields->before);
        computed = loud(f, pass->level, fields->bring_on, fields->before);
        fields->bring_on = fields->before;
    }
    pass->next = fields->before;
    f->computed[first / FUSED_PLANES] = computed;
    if (computed)
        NAME(fused_planes)(f, pass->thread, first, fields);
    else
        for (size_t component = 0; fields->moved == NULL && component < 3; component++)
            memset((REAL *)fields->a + component * f->volume + first * f->plane, 0,
                   planes * f->plane * sizeof(REAL));
    for (size_t k = first; k < first + planes; k++)
        add_rest(c, pass->drive, k, fields->moved == NULL ? 1 : fields->dt, fields->u, fields->a);
}

/* Where the planes of each thread begin, so that all have about as much to do: a block that was quiet in the
 * last call, and is only brought on, costs an eighth of one that is computed. What is computed does not
 * depend on the bounds. */
static void lay_bounds(const struct fused *f)
{
    enum { COMPUTED = 8, QUIET = 1 };
    const size_t blocks = (f->n[2] + FUSED_PLANES - 1) / FUSED_PLANES, threads = (size_t)f->threads;
    size_t all = 0, done = 0, thread = 1;
    for (size_t block = 0; block < blocks; block++)
        all += f->computed[block] ? COMPUTED : QUIET;
    f->bound[0] = 0;
    for (size_t block = 0; block < blocks; block++) {
        while (thread < threads && done * threads >= all * thread)
            f->bound[thread++] = block * FUSED_PLANES;
        done += f->computed[block] ? COMPUTED : QUIET;
    }
    while (thread <= threads)
        f->bound[thread++] = f->n[2];
}

/* The blocks of a thread: all of u that others read is brought on before (stage 0), the rest on the way. */
static void pass_thread(const struct consistent *c, const struct drive *drive,
                        const struct fused_fields *fields, bool bring, double level, int thread, int stage)
{
    const struct fused *f = FUSED(c);
    const size_t reach = (size_t)f->deep / 2, from = f->bound[thread], end = f->bound[thread + 1];
    const size_t low = !bring || from + reach > end ? end : from + reach;
    const size_t high = end == f->n[2] ? end : end > low + reach ? end - reach : low;
    if (stage == 0) {
        bring_planes(f, fields, from, low);
        bring_planes(f, fields, high, end);
        return;
    }
    struct pass pass = {c, drive, *fields, level, low, high, thread};
    for (size_t first = from; first < end; first += FUSED_PLANES)
        pass_block(&pass, first);
}

/* All planes; u is brought on too if `bring`. */
static void pass_over(const struct consistent *c, const struct drive *drive,
                      const struct fused_fields *fields, bool bring, double level)
{
    const struct fused *f = FUSED(c);
    lay_bounds(f);
#pragma omp parallel num_threads(f->threads)
    for (int stage = bring ? 0 : 1; stage < 2; stage++) {
#pragma omp for schedule(static, 1)
        for (int thread = 0; thread < f->threads; thread++)
            pass_thread(c, drive, fields, bring, level, thread, stage);
    }
}

static REAL plane_size(const struct fused *f, size_t k, const REAL *u)
{
    REAL largest = 0;
    for (size_t component = 0; component < 3; component++) {
        const REAL size = NAME(largest_size)(u + component * f->volume + k * f->plane, f->plane);
        if (size > largest) largest = size;
    }
    return largest;
}

double NAME(fused_sizes)(const struct fused *f, const REAL *u)
{
    double largest = 0;
#pragma omp parallel for num_threads(f->threads) schedule(static)
    for (size_t k = 0; k < f->n[2]; k++)
        f->size[k] = f->quiet > 0 ? plane_size(f, k, u) : 0;
    for (size_t k = 0; k < f->n[2]; k++)
        if (f->size[k] > largest) largest = f->size[k];
    return largest;
}

/* Largest |u| before a step: that kept from the last one if u has it still. */
static double largest_before(const struct fused *f, const REAL *u)
{
    if (f->quiet <= 0) return 0;
    const double largest = plane_size(f, f->loudest, u);
    return largest > 0 && largest == f->largest ? largest : NAME(fused_sizes)(f, u);
}

/* a := acceleration. */
static void accelerate(const struct consistent *c, const struct drive *drive,
                       const struct NAME(step_fields) * step, REAL *a)
{
    const struct fused_fields fields = {.u = step->u, .a = a};
    const double level = FUSED(c)->quiet * NAME(fused_sizes)(FUSED(c), step->u);
    pass_over(c, drive, &fields, false, level);
    if (c->pml != NULL) NAME(pml_fast_accelerate)(c, 1, step->extra, a);
    fused_count(FUSED(c));
}

void NAME(fused_begin)(const struct consistent *c, const struct drive *drive, double dt,
                       const struct NAME(step_fields) * step, double *a)
{
    const struct fused_watch *watch = &c->fused->watch;
    accelerate(c, drive, step, step->work);
    for (size_t i = 0; i < c->model.unknowns; i++)
        step->w[i] += (REAL)(dt / 2) * step->work[i];
    for (size_t i = 0; i < watch->count; i++)
        a[watch->entry[i]] = step->work[watch->entry[i]];
}

/* The layers' memory goes on before u does, from the displacements in the middle of the step; what it does
 * then comes last. */
void NAME(fused_advance)(const struct consistent *c, const struct drive *drive, double dt,
                         const struct NAME(step_fields) * step, double *y, double *a)
{
    struct fused *f = FUSED(c);
    const struct fused_watch *watch = &c->fused->watch;
    const struct fused_fields fields = {.u = step->u, .a = step->w, .moved = step->u, .dt = dt};
    const double level = f->quiet * largest_before(f, step->u);
    const size_t n = c->model.unknowns;
    memset(f->size, 0, f->n[2] * sizeof *f->size);
    for (size_t i = 0; i < watch->count; i++)
        watch->before[i] = step->w[watch->entry[i]];
    if (c->pml != NULL) NAME(pml_fast_remember)(c, dt, dt / 2, level, step->u, step->w, step->extra);
    pass_over(c, drive, &fields, true, level);
    if (c->pml != NULL) NAME(pml_fast_accelerate)(c, dt, step->extra, step->w);
    for (size_t i = 0; i < watch->count; i++) {
        const size_t at = watch->entry[i];
        const double before = watch->before[i], after = step->w[at];
        y[at] = step->u[at];
        y[n + at] = (before + after) / 2;
        a[at] = (after - before) / dt;
    }
    fused_count(f);
}

void NAME(fused_settle)(const struct consistent *c, const struct drive *drive, double dt,
                        const struct NAME(step_fields) * step, double *y, double *a)
{
    const size_t n = c->model.unknowns;
    accelerate(c, drive, step, step->work);
#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (size_t i = 0; i < n; i++) {
        y[i] = step->u[i];
        y[n + i] = step->w[i] - dt / 2 * step->work[i];
        if (a != NULL) a[i] = step->work[i];
    }
}
