/* Steps of leapfrog by sweeps as functions of the consistent model. */
#include "method/consistent/general/sweep.h"

#include <string.h>

/* u and w in single precision. */
static float *kept_u(const struct consistent *c)
{
    return c->general->sweep->kept;
}

static float *kept_w(const struct consistent *c)
{
    return kept_u(c) + c->model.unknowns;
}

static void begin(struct model *model, const struct drive *drive, double dt, double *y, double *a)
{
    struct consistent *c = consistent_of(model);
    const size_t n = model->unknowns;
    const struct watch *watch = &c->watch;
    void *work = c->hform->work;
    double *extra = y + 2 * n;
    watch_sort(&c->watch);
    model->evaluations++;
    if (c->pml != NULL) general_layers_start(c, y, extra);
    if (model->single) {
        for (size_t i = 0; i < 2 * n; i++)
            kept_u(c)[i] = (float)y[i];
        sweep_begin_single(c, drive, dt, kept_u(c), extra, kept_w(c), work);
    } else {
        memcpy(c->general->sweep->kept, y + n, n * sizeof *y);
        sweep_begin_double(c, drive, dt, y, extra, c->general->sweep->kept, work);
    }
    for (size_t i = 0; i < watch->count; i++)
        a[watch->entry[i]] =
            model->single ? ((const float *)work)[watch->entry[i]] : ((const double *)work)[watch->entry[i]];
}

static void advance(struct model *model, const struct drive *drive, double dt, double *y, double *a)
{
    struct consistent *c = consistent_of(model);
    model->evaluations++;
    if (model->single)
        sweep_advance_single(c, drive, dt, kept_u(c), kept_w(c), y, a);
    else
        sweep_advance_double(c, drive, dt, y, c->general->sweep->kept, y, a);
}

static void settle(struct model *model, const struct drive *drive, double dt, double *y, double *a)
{
    struct consistent *c = consistent_of(model);
    void *work = c->hform->work;
    if (model->single)
        sweep_settle_single(c, drive, dt, kept_u(c), kept_w(c), work, y, a);
    else
        sweep_settle_double(c, drive, dt, y, c->general->sweep->kept, work, y, a);
}

/* Who asks may write. */
static void *kept(struct model *model, size_t *bytes)
{
    struct sweep *sweep = consistent_of(model)->general->sweep;
    sweep->known = false;
    *bytes = sweep->kept_bytes;
    return sweep->kept;
}

/* w, in single precision behind u. */
static void share(struct model *model, struct spread *shares)
{
    for (int times = model->single ? 2 : 1; times > 0; times--)
        model->core->share(model, ARRAY_UNKNOWNS, shares);
}

static const struct model_one_pass one_pass = {begin, advance, settle, kept, share, NULL};

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
    if (c->model.scene->whole != NULL) return "materials without q_p and q_s";
    return NULL;
}

selas_status general_steps_create(struct consistent *c, struct messages *messages)
{
    const char *missing = obstacle(c);
    if (missing != NULL && c->options.single)
        return fail(messages, SELAS_UNSUPPORTED,
                    "method%%precision = 'single' with method%%operator = 'general' needs %s", missing);
    if (missing != NULL) return SELAS_OK;
    c->model.one_pass = &one_pass;
    c->model.single = c->options.single;
    if (sweep_create(c) && watch_loads(c)) return SELAS_OK;
    return fail(messages, SELAS_NO_MEMORY, "no memory for a model of %zu control values", c->volume);
}
