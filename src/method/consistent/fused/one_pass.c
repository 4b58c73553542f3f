/* Steps of leapfrog in one pass as functions of the consistent model, and what is looked at after each. */
#include "method/consistent/absorbing/pml_fast.h"
#include "method/consistent/fused/fused.h"
#include "method/consistent/galerkin/hform.h"

#include "base/memory.h"

#include <string.h>

static const struct model_one_pass one_pass;

/* NULL: steps do not relax. */
static const struct relaxing *relaxing_of(const struct consistent *c)
{
    return c->fused->relaxing != NULL ? &c->fused->relaxing->of : NULL;
}

/* The model of a part, and where in the state's extra part its own begins. */
static const struct consistent *part_of(const struct consistent *c, size_t p, size_t *extra)
{
    const struct relaxing *relaxing = relaxing_of(c);
    *extra = relaxing != NULL ? relaxing->part[p].extra : 0;
    return relaxing != NULL ? consistent_of(relaxing->part[p].model) : c;
}

static struct step_fields_double fields_double(const struct consistent *c, double *y,
                                               const struct fused_relax *relax)
{
    const size_t n = c->model.unknowns;
    double *w = c->fused->kept, *memory = y + 2 * n;
    struct step_fields_double fields = {.w = w, .work = c->hform->work, .relax = relax, .parts = 1};
    if (relax != NULL) fields.parts = relax->parts;
    for (size_t l = 0; relax != NULL && l + 1 < relax->fields; l++)
        if (relax->of[l] > 0) fields.kept[relax->of[l]] = memory + l * n;
    for (size_t p = 0; p < fields.parts; p++) {
        size_t extra;
        fields.part[p].c = part_of(c, p, &extra);
        fields.part[p].u = relax != NULL ? w + (1 + p) * n : y;
        fields.part[p].extra = memory + extra;
        fields.kept[p] = fields.part[p].u;
    }
    return fields;
}

/* Numbers in the extra part of a state. */
static size_t extra_of(const struct consistent *c)
{
    const struct relaxing *relaxing = relaxing_of(c);
    return relaxing != NULL ? relaxing->extra : c->model.state_size - 2 * c->model.unknowns;
}

static struct step_fields_single fields_single(const struct consistent *c, const struct fused_relax *relax)
{
    const size_t n = c->model.unknowns;
    float *kept = c->fused->kept, *memory = kept + 2 * n;
    void *work = c->hform->work;
    struct step_fields_single fields = {.w = kept + n, .work = work, .relax = relax, .parts = 1};
    if (relax != NULL) fields.parts = relax->parts;
    for (size_t l = 0; relax != NULL && l + 1 < relax->fields; l++)
        if (relax->of[l] > 0) fields.kept[relax->of[l]] = memory + l * n;
    for (size_t p = 0; p < fields.parts; p++) {
        size_t extra;
        fields.part[p].c = part_of(c, p, &extra);
        fields.part[p].u = p == 0 ? kept : memory + extra_of(c);
        fields.part[p].extra = memory + extra;
        fields.kept[p] = fields.part[p].u;
    }
    return fields;
}

static void begin(struct model *model, const struct drive *drive, double dt, double *y, double *a)
{
    struct consistent *c = consistent_of(model);
    const struct relaxing *relaxing = relaxing_of(c);
    const struct fused_relax *relax = fused_factors(c->fused->relaxing, dt);
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
                fields.part[p].u[i] = (float)fused_effective(relaxing, p, n, y, i);
        fused_begin_single(c, drive, dt, &fields, a);
        return;
    }
    const struct step_fields_double fields = fields_double(c, y, relax);
    memcpy(fields.w, y + n, n * sizeof *y);
    for (size_t p = 0; p < fields.parts && relax != NULL; p++)
        for (size_t i = 0; i < n; i++)
            fields.part[p].u[i] = fused_effective(relaxing, p, n, y, i);
    fused_begin_double(c, drive, dt, &fields, a);
}

static void advance(struct model *model, const struct drive *drive, double dt, double *y, double *a)
{
    struct consistent *c = consistent_of(model);
    const struct fused_relax *relax = fused_factors(c->fused->relaxing, dt);
    model->evaluations++;
    if (model->single) {
        const struct step_fields_single fields = fields_single(c, relax);
        fused_advance_single(c, drive, dt, &fields, y, a);
    } else {
        const struct step_fields_double fields = fields_double(c, y, relax);
        fused_advance_double(c, drive, dt, &fields, y, a);
    }
}

static void settle(struct model *model, const struct drive *drive, double dt, double *y, double *a)
{
    struct consistent *c = consistent_of(model);
    const struct fused_relax *relax = fused_factors(c->fused->relaxing, dt);
    const size_t n = model->unknowns;
    if (model->single) {
        const struct step_fields_single fields = fields_single(c, relax);
        const float *kept = c->fused->kept;
        fused_settle_single(c, drive, dt, &fields, y, a);
        for (size_t i = 2 * n; i < 2 * n + extra_of(c); i++)
            y[i] = kept[i];
        if (relax != NULL)
            fused_tell_all(relax, n, c->threads, (const void *const *)fields.kept, sizeof(float), y);
    } else {
        const struct step_fields_double fields = fields_double(c, y, relax);
        fused_settle_double(c, drive, dt, &fields, y, a);
        if (relax != NULL)
            fused_tell_all(relax, n, c->threads, (const void *const *)fields.kept, sizeof(double), y);
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
    const struct relaxing *relaxing = relaxing_of(consistent_of(model));
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
    model->bytes += fused->kept_bytes + sizeof *fused->relaxing;
    fused->kept = array_new(1, fused->kept_bytes);
    fused->relaxing = fused_relaxing_new(relaxing);
    return fused->kept != NULL && fused->relaxing != NULL ? SELAS_OK : SELAS_NO_MEMORY;
}

static const struct model_one_pass one_pass = {begin, advance, settle, kept, share, relax};

/* Why steps of leapfrog cannot be made in one pass here; NULL: they can. */
static const char *obstacle(const struct consistent *c)
{
    bool moving = c->moving_loads > 0;
    for (int face = 0; face < BOX_FACES; face++)
        moving = moving || c->moving[face];
    if (c->fused == NULL)
        return "the fused operator: three dimensions, degree 2, a mass of sweeps, 14 control values along "
               "each axis (mirror planes halve them; method%symmetry = F has none)";
    if (moving) return "no moving faces or loads";
    if (c->model.damped) return "absorbing layers ('pml') in place of dampers ('lysmer')";
    if (c->hform->dissipation != NULL) return "no dissipation";
    if (c->pml != NULL && c->pml->fast == NULL) return "layers whose passes are shared";
    if (!c->options.single) return NULL;
    if (c->fused->single == NULL)
        return "16 control values along x (a mirror plane halves them; method%symmetry = F has none)";
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
