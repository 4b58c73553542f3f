/* Steps of leapfrog by sweeps as functions of the consistent model. */
#include "method/consistent/general/medium.h"
#include "method/consistent/general/sweep.h"

#include <string.h>

static const struct model_one_pass one_pass;

/* NULL: steps do not relax. */
static const struct relaxing *relaxing_of(const struct consistent *c)
{
    return c->general->sweep->relaxing != NULL ? &c->general->sweep->relaxing->of : NULL;
}

/* The ground of a part, and where in the state's extra part the memory of its layers begins. */
static struct general *ground_of(struct consistent *c, size_t p, size_t *extra)
{
    const struct relaxing *relaxing = relaxing_of(c);
    *extra = relaxing != NULL ? relaxing->part[p].extra : 0;
    return relaxing != NULL ? consistent_of(relaxing->part[p].model)->general : c->general;
}

/* Behind w stand the e_p if they relax; memory is the state's. */
static struct sweep_fields_double fields_double(struct consistent *c, double *y,
                                                const struct fused_relax *relax)
{
    const size_t n = c->model.unknowns;
    double *w = c->general->sweep->kept;
    struct sweep_fields_double fields = {
        .w = w, .work = c->hform->work, .relax = relax, .fields = 1, .parts = c->general->sweep->parts};
    for (size_t p = 0; p < fields.parts; p++) {
        size_t extra;
        fields.part[p].ground = ground_of(c, p, &extra);
        fields.part[p].u = relax != NULL ? w + (1 + p) * n : y;
        fields.part[p].extra = y + 2 * n + extra;
        fields.kept[p] = fields.part[p].u;
    }
    if (relax == NULL) return fields;
    fields.fields = relax->fields;
    for (size_t l = 0; l + 1 < relax->fields; l++)
        if (relax->of[l] > 0) fields.kept[relax->of[l]] = y + (2 + l) * n;
    return fields;
}

/* In single precision u or e_0, w, then all other fields that relax. */
static struct sweep_fields_single fields_single(struct consistent *c, double *y,
                                                const struct fused_relax *relax)
{
    const size_t n = c->model.unknowns;
    float *kept = c->general->sweep->kept;
    void *work = c->hform->work;
    struct sweep_fields_single fields = {.w = kept + n,
                                         .work = work,
                                         .relax = relax,
                                         .fields = relax != NULL ? relax->fields : 1,
                                         .parts = c->general->sweep->parts};
    for (size_t f = 0; f < fields.fields; f++)
        fields.kept[f] = kept + (f > 0 ? 1 + f : 0) * n;
    for (size_t p = 0; p < fields.parts; p++) {
        size_t extra;
        fields.part[p].ground = ground_of(c, p, &extra);
        fields.part[p].u = fields.kept[p];
        fields.part[p].extra = y + 2 * n + extra;
    }
    return fields;
}

/* Memory of the layers' forces at the start, of all parts: in that of the first one, for it is linear in them. */
static void begin_layers(struct consistent *c, size_t p, const double *u, double *y)
{
    const struct relaxing *relaxing = relaxing_of(c);
    const size_t moments = 2 * c->general->moments, phi = 2 * c->model.unknowns + c->pml->slab[0].phi;
    size_t first, own;
    ground_of(c, 0, &first);
    ground_of(c, p, &own);
    struct consistent *part = relaxing != NULL ? consistent_of(relaxing->part[p].model) : c;
    general_layers_start(part, u, y + 2 * c->model.unknowns + own);
    for (size_t i = 0; i < moments && p > 0; i++) {
        y[phi + first + i] += y[phi + own + i];
        y[phi + own + i] = 0;
    }
}

/* u or e_p at the start, in `room` if they relax. */
static const double *begin_part(struct consistent *c, size_t p, double *y, double *room)
{
    const struct relaxing *relaxing = relaxing_of(c);
    const size_t n = c->model.unknowns;
    for (size_t i = 0; i < n && relaxing != NULL; i++)
        room[i] = fused_effective(relaxing, p, n, y, i);
    const double *u = relaxing != NULL ? room : y;
    if (c->pml != NULL) begin_layers(c, p, u, y);
    return u;
}

static void begin_single(struct consistent *c, const struct sweep_fields_single *fields, double *y)
{
    const size_t n = c->model.unknowns;
    for (size_t p = 0; p < fields->parts; p++) {
        const double *u = begin_part(c, p, y, c->hform->work);
        for (size_t i = 0; i < n; i++)
            fields->part[p].u[i] = (float)u[i];
    }
    for (size_t i = 0; i < n; i++)
        fields->w[i] = (float)y[n + i];
    for (size_t l = 0; l + 1 < fields->fields; l++) {
        float *memory = fields->kept[fields->relax->of[l]];
        for (size_t i = 0; i < n && fields->relax->of[l] > 0; i++)
            memory[i] = (float)y[(2 + l) * n + i];
    }
}

static void begin(struct model *model, const struct drive *drive, double dt, double *y, double *a)
{
    struct consistent *c = consistent_of(model);
    const struct fused_relax *relax = fused_factors(c->general->sweep->relaxing, dt);
    const struct watch *watch = &c->watch;
    void *work = c->hform->work;
    watch_sort(&c->watch);
    model->evaluations++;
    if (model->single) {
        const struct sweep_fields_single fields = fields_single(c, y, relax);
        begin_single(c, &fields, y);
        sweep_begin_single(c, drive, dt, &fields);
    } else {
        const struct sweep_fields_double fields = fields_double(c, y, relax);
        memcpy(fields.w, y + model->unknowns, model->unknowns * sizeof *y);
        for (size_t p = 0; p < fields.parts; p++)
            begin_part(c, p, y, fields.part[p].u);
        sweep_begin_double(c, drive, dt, &fields);
    }
    for (size_t i = 0; i < watch->count; i++)
        a[watch->entry[i]] =
            model->single ? ((const float *)work)[watch->entry[i]] : ((const double *)work)[watch->entry[i]];
}

static void advance(struct model *model, const struct drive *drive, double dt, double *y, double *a)
{
    struct consistent *c = consistent_of(model);
    const struct fused_relax *relax = fused_factors(c->general->sweep->relaxing, dt);
    model->evaluations++;
    if (model->single) {
        const struct sweep_fields_single fields = fields_single(c, y, relax);
        sweep_advance_single(c, drive, dt, &fields, y, a);
    } else {
        const struct sweep_fields_double fields = fields_double(c, y, relax);
        sweep_advance_double(c, drive, dt, &fields, y, a);
    }
}

static void settle(struct model *model, const struct drive *drive, double dt, double *y, double *a)
{
    struct consistent *c = consistent_of(model);
    const struct fused_relax *relax = fused_factors(c->general->sweep->relaxing, dt);
    if (model->single) {
        const struct sweep_fields_single fields = fields_single(c, y, relax);
        sweep_settle_single(c, drive, dt, &fields, y, a);
        if (relax != NULL)
            fused_tell_all(relax, model->unknowns, c->threads, (const void *const *)fields.kept,
                           sizeof(float), y);
    } else {
        const struct sweep_fields_double fields = fields_double(c, y, relax);
        sweep_settle_double(c, drive, dt, &fields, y, a);
        if (relax != NULL)
            fused_tell_all(relax, model->unknowns, c->threads, (const void *const *)fields.kept,
                           sizeof(double), y);
    }
}

/* Who asks may write. */
static void *kept(struct model *model, size_t *bytes)
{
    struct sweep *sweep = consistent_of(model)->general->sweep;
    sweep->known = false;
    *bytes = sweep->kept_bytes;
    return sweep->kept;
}

/* As fields_double() and fields_single() have it. */
static void share(struct model *model, struct spread *shares)
{
    const struct sweep *sweep = consistent_of(model)->general->sweep;
    const size_t arrays = sweep->kept_bytes / (model->unknowns * sweep->number);
    for (size_t i = 0; i < arrays; i++)
        model->core->share(model, ARRAY_UNKNOWNS, shares);
}

static selas_status relax(struct model *model, const struct relaxing *relaxing)
{
    for (size_t p = 0; p < relaxing->parts; p++)
        if (relaxing->part[p].model->one_pass != &one_pass) return SELAS_UNSUPPORTED;
    model->parts = 1; /* what is rounded is the sum of their stresses */
    return sweep_relax(consistent_of(model), relaxing) ? SELAS_OK : SELAS_NO_MEMORY;
}

static const struct model_one_pass one_pass = {begin, advance, settle, kept, share, relax};

/* Why steps cannot be made in one pass here; NULL: they can. */
static const char *obstacle(const struct consistent *c)
{
    if (c->dimension != 3) return "three dimensions";
    for (int slot = 0; slot < 3; slot++)
        if ((slot == DEPTH ? c->part.along[DEPTH].whole : c->n[slot]) < (c->options.single ? 16 : 8))
            return "8 control values along each axis, 16 in single precision";
    if (c->options.unfused) return "method%fused = .true.";
    if (c->moving_loads > 0) return "no moving loads";
    if (c->model.damped) return "no dampers";
    return NULL;
}

selas_status general_steps_create(struct consistent *c, struct messages *messages)
{
    if (c->model.scene->body.line != NULL) return SELAS_OK; /* about a source (window.h): it makes no steps */
    const char *missing = obstacle(c);
    if (missing != NULL && c->options.single)
        return fail(messages, SELAS_UNSUPPORTED,
                    "method%%precision = 'single' with method%%operator = 'general' needs %s", missing);
    if (missing != NULL) return SELAS_OK;
    c->model.one_pass = &one_pass;
    c->model.single = c->options.single;
    if (general_is_part(c->model.scene)) return SELAS_OK; /* steps are those of the first part */
    if (sweep_create(c) && watch_loads(c)) return SELAS_OK;
    return fail(messages, SELAS_NO_MEMORY, "no memory for a model of %zu control values", c->volume);
}
