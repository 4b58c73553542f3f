/* Steps of leapfrog in one pass as functions of the consistent model, and what is looked at after each. */
#include "method/consistent/absorbing/pml_fast.h"
#include "method/consistent/fused/fused.h"
#include "method/consistent/galerkin/hform.h"

#include "base/memory.h"

#include <stdlib.h>
#include <string.h>

static int by_place(const void *one, const void *other)
{
    const size_t a = *(const size_t *)one, b = *(const size_t *)other;
    return a < b ? -1 : a > b;
}

/* Each entry once, in the order of memory. */
static void sort_watched(struct fused_watch *watch)
{
    if (watch->sorted || watch->count == 0) return;
    qsort(watch->entry, watch->count, sizeof *watch->entry, by_place);
    size_t kept = 1;
    for (size_t i = 1; i < watch->count; i++)
        if (watch->entry[i] != watch->entry[kept - 1]) watch->entry[kept++] = watch->entry[i];
    watch->count = kept;
    watch->sorted = true;
}

bool fused_watch(struct consistent *c, size_t count, const size_t *place)
{
    if (c->model.one_pass == NULL) return true;
    struct fused_watch *watch = &c->fused->watch;
    if (watch->room < watch->count + 3 * count) {
        sort_watched(watch);
        const size_t room = 2 * watch->count + 3 * count;
        size_t *entry = array_new(room, sizeof *entry);
        double *before = array_new(room, sizeof *before);
        if (entry != NULL && watch->count > 0) memcpy(entry, watch->entry, watch->count * sizeof *entry);
        array_free(watch->entry);
        array_free(watch->before);
        watch->entry = entry;
        watch->before = before;
        watch->room = room;
        if (entry == NULL || before == NULL) return false;
    }
    for (size_t component = 0; component < 3; component++)
        for (size_t i = 0; i < count; i++)
            watch->entry[watch->count++] = component * c->volume + place[i];
    watch->sorted = false;
    return true;
}

/* The power of a load is that of the velocities it touches. */
static bool watch_loads(struct consistent *c)
{
    for (size_t l = 0; l < c->model.scene->loads; l++) {
        const struct sparse *load = &c->load[l];
        for (size_t at = 0; at < 3 * c->n[DEPTH]; at++)
            for (size_t e = load->start[at]; e < load->start[at + 1]; e++) {
                const size_t place = at % c->n[DEPTH] * c->plane + load->index[e];
                if (!fused_watch(c, 1, &place)) return false;
            }
    }
    return true;
}

/* Factors of a step of dt. */
static struct fused_relax relax_of(const struct consistent *c, double dt)
{
    const struct relaxing *relaxing = c->fused->relaxing;
    struct fused_relax relax = {.mechanisms = relaxing->mechanisms, .apart = c->model.unknowns};
    relax.given = relaxing->given * dt;
    for (size_t l = 0; l < relaxing->mechanisms; l++) {
        const double half = relaxing->rate[l] * dt / 2;
        relax.weight[l] = relaxing->weight[l];
        relax.kept[l] = (1 - half) / (1 + half);
        relax.taken[l] = dt / (1 + half);
    }
    return relax;
}

static struct step_fields_double fields_double(const struct consistent *c, double *y)
{
    const size_t n = c->model.unknowns;
    double *w = c->fused->kept;
    struct step_fields_double fields = {.u = y, .w = w, .extra = y + 2 * n, .work = c->hform->work};
    if (c->fused->relaxing == NULL) return fields;
    fields.u = w + n;
    fields.memory = fields.extra;
    fields.extra += c->fused->relaxing->mechanisms * n;
    return fields;
}

/* sum over l of weight_l D_l at an entry. */
static double remembered(const struct relaxing *relaxing, size_t n, const double *memory, size_t at)
{
    double sum = 0;
    for (size_t l = 0; l < relaxing->mechanisms; l++)
        sum += relaxing->weight[l] * memory[l * n + at];
    return sum;
}

/* e of a state, or the displacements in it of e. */
static void to_effective(const struct consistent *c, const double *y, double *e)
{
    const struct relaxing *relaxing = c->fused->relaxing;
    const size_t n = c->model.unknowns;
#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (size_t i = 0; i < n; i++)
        e[i] = relaxing->given * y[i] + remembered(relaxing, n, y + 2 * n, i);
}
static void from_effective(const struct consistent *c, const double *e, double *y)
{
    const struct relaxing *relaxing = c->fused->relaxing;
    const size_t n = c->model.unknowns;
#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (size_t i = 0; i < n; i++)
        y[i] = (e[i] - remembered(relaxing, n, y + 2 * n, i)) / relaxing->given;
}

static struct step_fields_single fields_single(const struct consistent *c)
{
    const size_t n = c->model.unknowns;
    float *kept = c->fused->kept;
    void *work = c->hform->work;
    return (struct step_fields_single){.u = kept, .w = kept + n, .extra = kept + 2 * n, .work = work};
}

static void begin(struct model *model, const struct drive *drive, double dt, double *y, double *a)
{
    struct consistent *c = consistent_of(model);
    const size_t n = model->unknowns;
    sort_watched(&c->fused->watch);
    model->evaluations++;
    if (model->single) {
        const struct step_fields_single fields = fields_single(c);
        for (size_t i = 0; i < model->state_size; i++)
            fields.u[i] = (float)y[i];
        fused_begin_single(c, drive, dt, &fields, a);
        return;
    }
    const struct step_fields_double fields = fields_double(c, y);
    memcpy(fields.w, y + n, n * sizeof *y);
    if (fields.memory != NULL) to_effective(c, y, fields.u);
    fused_begin_double(c, drive, dt, &fields, a);
}

static void advance(struct model *model, const struct drive *drive, double dt, double *y, double *a)
{
    struct consistent *c = consistent_of(model);
    model->evaluations++;
    if (model->single) {
        const struct step_fields_single fields = fields_single(c);
        fused_advance_single(c, drive, dt, &fields, y, a);
        return;
    }
    struct step_fields_double fields = fields_double(c, y);
    struct fused_relax relax = {0};
    if (fields.memory != NULL) {
        relax = relax_of(c, dt);
        fields.relax = &relax;
    }
    fused_advance_double(c, drive, dt, &fields, y, a);
    const struct fused_watch *watch = &c->fused->watch;
    for (size_t i = 0; fields.memory != NULL && i < watch->count; i++) {
        const size_t at = watch->entry[i];
        y[at] = (fields.u[at] - remembered(c->fused->relaxing, model->unknowns, fields.memory, at)) /
                c->fused->relaxing->given;
    }
}

static void settle(struct model *model, const struct drive *drive, double dt, double *y, double *a)
{
    struct consistent *c = consistent_of(model);
    if (!model->single) {
        const struct step_fields_double fields = fields_double(c, y);
        fused_settle_double(c, drive, dt, &fields, y, a);
        if (fields.memory != NULL) from_effective(c, fields.u, y);
        return;
    }
    const struct step_fields_single fields = fields_single(c);
    fused_settle_single(c, drive, dt, &fields, y, a);
    for (size_t i = 2 * model->unknowns; i < model->state_size; i++)
        y[i] = fields.u[i];
}

/* Who asks may write. */
static void *kept(struct model *model, size_t *bytes)
{
    struct fused *fused = consistent_of(model)->fused;
    fused->known = false;
    if (fused->single != NULL) fused->single->known = false;
    *bytes = fused->kept_bytes;
    return fused->kept;
}

static bool relax(struct model *model, const struct relaxing *relaxing)
{
    struct fused *fused = consistent_of(model)->fused;
    array_free(fused->kept);
    fused->bytes += fused->kept_bytes + sizeof *relaxing;
    fused->kept_bytes *= 2;
    fused->kept = array_new(1, fused->kept_bytes);
    fused->relaxing = array_new(1, sizeof *relaxing);
    if (fused->kept == NULL || fused->relaxing == NULL) return false;
    *fused->relaxing = *relaxing;
    return true;
}

static const struct model_one_pass one_pass = {begin, advance, settle, kept, relax};

/* Why steps of leapfrog cannot be made in one pass here; NULL: they can. */
static const char *obstacle(const struct consistent *c)
{
    bool moving = c->moving_loads > 0;
    for (int face = 0; face < BOX_FACES; face++)
        moving = moving || c->moving[face];
    if (c->fused == NULL)
        return "the fused operator: three dimensions, degree 2, a mass of sweeps, one kind of ground, no "
               "thin body";
    if (moving) return "no moving faces or loads";
    if (c->model.damped) return "absorbing layers ('pml') in place of dampers ('lysmer')";
    if (c->hform->dissipation != NULL) return "no dissipation";
    if (c->pml != NULL && (c->pml->fast == NULL || c->pml->drag > 0)) return "layers whose passes are shared";
    if (!c->options.single) return NULL;
    if (c->fused->single == NULL) return "16 control values along x";
    if (c->pml != NULL && c->pml->single == NULL) return "layers whose passes are shared";
    return NULL;
}

selas_status fused_steps_create(struct consistent *c, struct messages *messages)
{
    const char *missing = obstacle(c);
    if (missing != NULL && c->options.single)
        return fail(messages, SELAS_UNSUPPORTED, "method%%precision = 'single' needs %s", missing);
    if (missing != NULL) return SELAS_OK;
    c->model.one_pass = &one_pass;
    c->model.single = c->options.single;
    c->fused->kept_bytes =
        c->options.single ? c->model.state_size * sizeof(float) : c->model.unknowns * sizeof(double);
    c->fused->kept = array_new(1, c->fused->kept_bytes);
    c->fused->bytes += c->fused->kept_bytes;
    if (c->fused->kept != NULL && watch_loads(c)) return SELAS_OK;
    return fail(messages, SELAS_NO_MEMORY, "no memory for a model of %zu control values", c->volume);
}
