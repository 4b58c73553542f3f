/* Steps of leapfrog in one pass as functions of the consistent model, and what is looked at after each. */
#include "method/consistent/absorbing/pml_fast.h"
#include "method/consistent/fused/fused.h"
#include "method/consistent/galerkin/hform.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

static const struct model_one_pass one_pass;

/* What memory is but for u: e_1 - (given_1 / given_0) e_0 = sum over l of this times D_l. */
static double between(const struct relaxing *relaxing, size_t l)
{
    const struct relaxing_part *part = relaxing->part;
    return part[1].weight[l] - part[1].given / part[0].given * part[0].weight[l];
}

/* Mechanisms in the order of the scene, but of two parts the one last that they tell best. */
static void lay_order(const struct relaxing *relaxing, size_t n, struct fused_relax *relax)
{
    const size_t last = relaxing->mechanisms - 1;
    size_t best = last;
    for (size_t l = 0; l < last && relaxing->parts > 1; l++)
        if (fabs(between(relaxing, l)) > fabs(between(relaxing, best))) best = l;
    for (size_t l = 0; l <= last; l++) {
        relax->order[l] = l == best ? last : l == last ? best : l;
        relax->at[l] = relax->order[l] * n;
    }
    if (relaxing->parts == 1) return;
    relax->from_parts[1] = 1 / between(relaxing, best);
    relax->from_parts[0] = -relaxing->part[1].given / relaxing->part[0].given * relax->from_parts[1];
    for (size_t l = 0; l < last; l++)
        relax->from_memory[l] = -between(relaxing, relax->order[l]) * relax->from_parts[1];
}

/* Factors of a step of dt. */
static struct fused_relax relax_of(const struct consistent *c, double dt)
{
    const struct relaxing *relaxing = c->fused->relaxing;
    struct fused_relax relax = {.mechanisms = relaxing->mechanisms, .parts = relaxing->parts, .dt = dt};
    lay_order(relaxing, c->model.unknowns, &relax);
    for (size_t p = 0; p < relaxing->parts; p++) {
        relax.given[p] = relaxing->part[p].given;
        relax.by_rate[p] = relax.given[p] * dt;
    }
    for (size_t l = 0; l < relaxing->mechanisms; l++) {
        const double half = relaxing->rate[relax.order[l]] * dt / 2;
        relax.kept[l] = (1 - half) / (1 + half);
        relax.taken[l] = dt / (1 + half);
        for (size_t p = 0; p < relaxing->parts; p++) {
            relax.weight[p][l] = relaxing->part[p].weight[relax.order[l]];
            relax.by_rate[p] += relax.weight[p][l] * relax.taken[l];
            relax.by_memory[p][l] = -2 * half / (1 + half) * relax.weight[p][l];
        }
    }
    return relax;
}

/* The model of a part, and where in the state's extra part its own begins. */
static const struct consistent *part_of(const struct consistent *c, size_t p, size_t *extra)
{
    const struct relaxing *relaxing = c->fused->relaxing;
    *extra = relaxing != NULL ? relaxing->part[p].extra : 0;
    return relaxing != NULL ? consistent_of(relaxing->part[p].model) : c;
}

static struct step_fields_double fields_double(const struct consistent *c, double *y,
                                               const struct fused_relax *relax)
{
    const size_t n = c->model.unknowns;
    double *w = c->fused->kept, *memory = y + 2 * n;
    struct step_fields_double fields = {.w = w, .work = c->hform->work, .relax = relax, .parts = 1};
    if (relax != NULL) {
        fields.parts = relax->parts;
        fields.memory = memory;
    }
    for (size_t p = 0; p < fields.parts; p++) {
        size_t extra;
        fields.part[p].c = part_of(c, p, &extra);
        fields.part[p].u = relax != NULL ? w + (1 + p) * n : y;
        fields.part[p].extra = memory + extra;
    }
    return fields;
}

/* Numbers in the extra part of a state. */
static size_t extra_of(const struct consistent *c)
{
    const struct relaxing *relaxing = c->fused->relaxing;
    return relaxing != NULL ? relaxing->extra : c->model.state_size - 2 * c->model.unknowns;
}

static struct step_fields_single fields_single(const struct consistent *c, const struct fused_relax *relax)
{
    const size_t n = c->model.unknowns;
    float *kept = c->fused->kept, *memory = kept + 2 * n;
    void *work = c->hform->work;
    struct step_fields_single fields = {.w = kept + n, .work = work, .relax = relax, .parts = 1};
    if (relax != NULL) {
        fields.parts = relax->parts;
        fields.memory = memory;
    }
    for (size_t p = 0; p < fields.parts; p++) {
        size_t extra;
        fields.part[p].c = part_of(c, p, &extra);
        fields.part[p].u = p == 0 ? kept : memory + extra_of(c);
        fields.part[p].extra = memory + extra;
    }
    return fields;
}

/* sum over l of weight_pl D_l at an entry of a state. */
static double remembered(const struct relaxing *relaxing, size_t p, size_t n, const double *y, size_t at)
{
    double sum = 0;
    for (size_t l = 0; l < relaxing->mechanisms; l++)
        sum += relaxing->part[p].weight[l] * y[(2 + l) * n + at];
    return sum;
}

/* e_p of a state at an entry. */
static double effective(const struct relaxing *relaxing, size_t p, size_t n, const double *y, size_t at)
{
    return relaxing->part[p].given * y[at] + remembered(relaxing, p, n, y, at);
}

static void begin(struct model *model, const struct drive *drive, double dt, double *y, double *a)
{
    struct consistent *c = consistent_of(model);
    const struct relaxing *relaxing = c->fused->relaxing;
    const struct fused_relax factors = relaxing != NULL ? relax_of(c, dt) : (struct fused_relax){0};
    const struct fused_relax *relax = relaxing != NULL ? &factors : NULL;
    const size_t n = model->unknowns;
    watch_sort(&c->watch);
    model->evaluations++;
    if (model->single) {
        const struct step_fields_single fields = fields_single(c, relax);
        float *kept = c->fused->kept;
        for (size_t i = 0; i < 2 * n + extra_of(c); i++)
            kept[i] = (float)y[i];
        for (size_t p = 0; p < fields.parts && relax != NULL; p++)
            for (size_t i = 0; i < n; i++)
                fields.part[p].u[i] = (float)effective(relaxing, p, n, y, i);
        fused_begin_single(c, drive, dt, &fields, a);
        return;
    }
    const struct step_fields_double fields = fields_double(c, y, relax);
    memcpy(fields.w, y + n, n * sizeof *y);
    for (size_t p = 0; p < fields.parts && relax != NULL; p++)
        for (size_t i = 0; i < n; i++)
            fields.part[p].u[i] = effective(relaxing, p, n, y, i);
    fused_begin_double(c, drive, dt, &fields, a);
}

static void advance(struct model *model, const struct drive *drive, double dt, double *y, double *a)
{
    struct consistent *c = consistent_of(model);
    const struct fused_relax factors = c->fused->relaxing != NULL ? relax_of(c, dt) : (struct fused_relax){0};
    const struct fused_relax *relax = c->fused->relaxing != NULL ? &factors : NULL;
    model->evaluations++;
    if (model->single) {
        const struct step_fields_single fields = fields_single(c, relax);
        fused_advance_single(c, drive, dt, &fields, y, a);
    } else {
        const struct step_fields_double fields = fields_double(c, y, relax);
        fused_advance_double(c, drive, dt, &fields, y, a);
    }
}

/* u, and the memory that the parts tell, where e_0 stands in a state; e_1: in either precision, NULL if there is
 * one part. */
static void tell_displacements(const struct consistent *c, const struct fused_relax *relax, const double *e_1,
                               const float *single, double *y)
{
    const struct relaxing *relaxing = c->fused->relaxing;
    const size_t n = c->model.unknowns, last = relax->mechanisms - 1;
#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (size_t i = 0; i < n; i++) {
        if (relax->parts > 1) {
            double *told = y + 2 * n + relax->at[last] + i;
            const double other = e_1 != NULL ? e_1[i] : single != NULL ? (double)single[i] : 0;
            double memory = relax->from_parts[0] * y[i] + relax->from_parts[1] * other;
            for (size_t l = 0; l < last; l++)
                memory += relax->from_memory[l] * y[2 * n + relax->at[l] + i];
            if (memory != *told) *told = memory;
        }
        const double u = (y[i] - remembered(relaxing, 0, n, y, i)) / relaxing->part[0].given;
        if (u != y[i]) y[i] = u;
    }
}

static void settle(struct model *model, const struct drive *drive, double dt, double *y, double *a)
{
    struct consistent *c = consistent_of(model);
    const struct fused_relax factors = c->fused->relaxing != NULL ? relax_of(c, dt) : (struct fused_relax){0};
    const struct fused_relax *relax = c->fused->relaxing != NULL ? &factors : NULL;
    const size_t n = model->unknowns;
    if (model->single) {
        const struct step_fields_single fields = fields_single(c, relax);
        const float *kept = c->fused->kept;
        fused_settle_single(c, drive, dt, &fields, y, a);
        for (size_t i = 2 * n; i < 2 * n + extra_of(c); i++)
            y[i] = kept[i];
        if (relax != NULL) tell_displacements(c, relax, NULL, fields.part[1].u, y);
    } else {
        const struct step_fields_double fields = fields_double(c, y, relax);
        fused_settle_double(c, drive, dt, &fields, y, a);
        if (relax != NULL) tell_displacements(c, relax, fields.part[1].u, NULL, y);
    }
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

static void share_times(struct model *model, size_t times, struct spread *shares)
{
    for (size_t i = 0; i < times; i++)
        model->core->share(model, ARRAY_UNKNOWNS, shares);
}

/* As step_fields have it: in double precision w and the u of all parts if they relax; in single precision u, w,
 * the extra part of the state, and the u of parts but the first. */
static void share(struct model *model, struct spread *shares)
{
    const struct relaxing *relaxing = consistent_of(model)->fused->relaxing;
    if (!model->single) {
        share_times(model, relaxing != NULL ? 1 + relaxing->parts : 1, shares);
        return;
    }
    share_times(model, 2 + (relaxing != NULL ? relaxing->mechanisms : 0), shares);
    if (relaxing == NULL) model->core->share(model, ARRAY_EXTRA, shares);
    for (size_t p = 0; relaxing != NULL && p < relaxing->parts; p++)
        model->core->share(relaxing->part[p].model, ARRAY_EXTRA, shares);
    if (relaxing != NULL) share_times(model, relaxing->parts - 1, shares);
}

static selas_status relax(struct model *model, const struct relaxing *relaxing)
{
    struct fused *fused = consistent_of(model)->fused;
    const size_t n = model->unknowns;
    bool possible = relaxing->parts <= (fused->layered ? 1 : FUSED_PARTS);
    for (size_t p = 0; p < relaxing->parts; p++)
        possible = possible && relaxing->part[p].model->one_pass == &one_pass;
    for (size_t p = 0; p < relaxing->parts; p++) {
        struct model *part = relaxing->part[p].model;
        if (part->one_pass != &one_pass) continue;
        struct fused *its = consistent_of(part)->fused;
        array_free(its->kept);
        its->kept = NULL;
        part->bytes -= its->kept_bytes;
        its->kept_bytes = 0;
    }
    if (!possible) return SELAS_UNSUPPORTED;
    if (relaxing->parts > 1 && !fused_mix(consistent_of(model), consistent_of(relaxing->part[1].model)))
        return SELAS_NO_MEMORY;
    fused->kept_bytes = model->single ? ((1 + relaxing->parts) * n + relaxing->extra) * sizeof(float)
                                      : (1 + relaxing->parts) * n * sizeof(double);
    model->bytes += fused->kept_bytes + sizeof *relaxing;
    fused->kept = array_new(1, fused->kept_bytes);
    fused->relaxing = array_new(1, sizeof *relaxing);
    if (fused->kept == NULL || fused->relaxing == NULL) return SELAS_NO_MEMORY;
    *fused->relaxing = *relaxing;
    return SELAS_OK;
}

static const struct model_one_pass one_pass = {begin, advance, settle, kept, share, relax};

/* Why steps of leapfrog cannot be made in one pass here; NULL: they can. */
static const char *obstacle(const struct consistent *c)
{
    bool moving = c->moving_loads > 0;
    for (int face = 0; face < BOX_FACES; face++)
        moving = moving || c->moving[face];
    if (c->fused == NULL)
        return "the fused operator: three dimensions, degree 2, a mass of sweeps, no thin body";
    if (moving) return "no moving faces or loads";
    if (c->model.damped) return "absorbing layers ('pml') in place of dampers ('lysmer')";
    if (c->hform->dissipation != NULL) return "no dissipation";
    if (c->pml != NULL && c->pml->fast == NULL) return "layers whose passes are shared";
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
