/* The step of a damped model (doc/theory/damping.md, section 4):
 *
 *   D_l(n+1) = a_l D_l(n) + b_l w(n+1/2),  a_l = (1 - h_l/2)/(1 + h_l/2),  b_l = dt/(1 + h_l/2),  h_l = r_l dt.
 */
#include "method/damped/damped.h"

#include "base/memory.h"

#include <string.h>

/* Below this a parallel region costs more than it saves. */
enum { SERIAL = 20000 };

static size_t mechanisms_of(const struct damped *d)
{
    return d->damping->mechanisms;
}

void damped_effective(const struct damped *d, const struct damped_part *part, const double *u,
                      const double *extra, double *effective)
{
    const size_t n = d->model.unknowns, mechanisms = mechanisms_of(d);
#pragma omp parallel for simd schedule(static) if (n > SERIAL)
    for (size_t i = 0; i < n; i++) {
        double sum = part->given * u[i];
        for (size_t l = 0; l < mechanisms; l++)
            sum += part->memory[l] * extra[l * n + i];
        effective[i] = sum;
    }
}

/* --- Acceleration ------------------------------------------------------------------------------------- */

static const double *extra_of(const struct damped_part *part, const double *extra)
{
    return part->model->memory != NULL ? extra + part->extra : NULL;
}

static void accelerate(struct model *model, const struct drive *drive, double half_step, const double *u,
                       const double *v, double *a)
{
    struct damped *d = damped_of(model);
    const struct damped_part *first = &d->part[0];
    const size_t n = model->unknowns;
    model->evaluations++;
    if (drive->extra == NULL) {
        first->model->spatial->accelerate(first->model, drive, half_step, u, v, a);
        return;
    }
    struct drive own = *drive;
    own.extra = extra_of(first, drive->extra);
    damped_effective(d, first, u, drive->extra, d->effective);
    first->model->spatial->accelerate(first->model, &own, half_step, d->effective, v, a);
    for (size_t p = 1; p < d->parts; p++) {
        const struct damped_part *part = &d->part[p];
        const struct drive quiet = {.time = drive->time, .extra = extra_of(part, drive->extra)};
        damped_effective(d, part, u, drive->extra, d->effective);
        part->model->spatial->accelerate(part->model, &quiet, half_step, d->effective, NULL, d->sum);
#pragma omp parallel for simd schedule(static) if (n > SERIAL)
        for (size_t i = 0; i < n; i++)
            a[i] += d->sum[i];
    }
}

static void weigh(struct model *model, const double *v, double *product)
{
    struct model *first = damped_of(model)->part[0].model;
    first->spatial->weigh(first, v, product);
}

static selas_status shorten(const struct model *model, struct model **shorter, double *deficit,
                            struct messages *messages)
{
    const struct model *first = ((const struct damped *)model)->part[0].model;
    return first->spatial->shorten(first, shorter, deficit, messages);
}

/* --- Memory ------------------------------------------------------------------------------------------- */

struct update {
    double kept[MOST_MECHANISMS], taken[MOST_MECHANISMS];
};

static struct update update_of(const struct damped *d, double dt)
{
    struct update update = {{0}, {0}};
    for (size_t l = 0; l < mechanisms_of(d); l++) {
        const double half = d->damping->rate[l] * dt / 2;
        update.kept[l] = (1 - half) / (1 + half);
        update.taken[l] = dt / (1 + half);
    }
    return update;
}

/* e_p at the end of the step, and (e_p(n+1) - e_p(n)) / dt behind it; extra is that of the start. */
static void part_moves(const struct damped *d, const struct damped_part *part, const struct update *update,
                       double dt, const double *u, const double *v, const double *extra)
{
    const size_t n = d->model.unknowns, mechanisms = mechanisms_of(d);
    double *effective = d->effective;
#pragma omp parallel for simd schedule(static) if (n > SERIAL)
    for (size_t i = 0; i < n; i++) {
        double end = part->given * u[i], rate = part->given * v[i];
        for (size_t l = 0; l < mechanisms; l++) {
            const double before = extra[l * n + i],
                         after = update->kept[l] * before + update->taken[l] * v[i];
            end += part->memory[l] * after;
            rate += part->memory[l] * (after - before) / dt;
        }
        effective[i] = end;
        effective[n + i] = rate;
    }
}

static void start(struct model *model, const double *u, double *extra)
{
    struct damped *d = damped_of(model);
    struct update none = {{0}, {0}};
    for (size_t l = 0; l < mechanisms_of(d); l++)
        none.kept[l] = 1;
    for (size_t p = 0; p < d->parts; p++) {
        struct model *part = d->part[p].model;
        if (part->memory == NULL) continue;
        part_moves(d, &d->part[p], &none, 1, u, u, extra);
        part->memory->start(part, d->effective, extra + d->part[p].extra);
    }
}

static void remember(struct model *model, double dt, const double *u, const double *v, double *extra)
{
    struct damped *d = damped_of(model);
    const size_t n = model->unknowns, mechanisms = mechanisms_of(d);
    const struct update update = update_of(d, dt);
    for (size_t p = 0; p < d->parts; p++) {
        const struct damped_part *part = &d->part[p];
        if (part->model->memory == NULL) continue;
        part_moves(d, part, &update, dt, u, v, extra);
        part->model->memory->remember(part->model, dt, d->effective, d->effective + n, extra + part->extra);
    }
#pragma omp parallel for simd schedule(static) if (n > SERIAL)
    for (size_t i = 0; i < n; i++)
        for (size_t l = 0; l < mechanisms; l++)
            extra[l * n + i] = update.kept[l] * extra[l * n + i] + update.taken[l] * v[i];
}

static void drag(struct model *model, double dt, double *v)
{
    struct model *first = damped_of(model)->part[0].model;
    if (first->memory != NULL) first->memory->drag(first, dt, v);
}

/* --- Making ------------------------------------------------------------------------------------------- */

void damped_free(struct model *model)
{
    struct damped *d = damped_of(model);
    for (size_t p = 0; p < d->parts; p++) {
        model_free(&d->part[p].model);
        array_free(d->part[p].material);
    }
    damped_field_free(d);
    ground_damping_free(d->damping);
    array_free(d->effective);
    array_free(d->sum);
    array_free(d);
}

/* Steps in one pass are those of the only part, whose state has the mechanisms' memory before its own. */
static void begin(struct model *model, const struct drive *drive, double dt, double *y, double *a)
{
    struct model *first = damped_of(model)->part[0].model;
    first->one_pass->begin(first, drive, dt, y, a);
    model->evaluations++;
}

static void advance(struct model *model, const struct drive *drive, double dt, double *y, double *a)
{
    struct model *first = damped_of(model)->part[0].model;
    first->one_pass->advance(first, drive, dt, y, a);
    model->evaluations++;
}

static void settle(struct model *model, const struct drive *drive, double dt, double *y, double *a)
{
    struct model *first = damped_of(model)->part[0].model;
    first->one_pass->settle(first, drive, dt, y, a);
}

static void *kept(struct model *model, size_t *bytes)
{
    struct model *first = damped_of(model)->part[0].model;
    return first->one_pass->kept(first, bytes);
}

static void share(struct model *model, struct spread *shares)
{
    struct model *first = damped_of(model)->part[0].model;
    first->one_pass->share(first, shares);
}

/* Steps in one pass where the parts' can be made together, else pass by pass. */
static selas_status relax(struct damped *d, size_t extra)
{
    struct model *first = d->part[0].model;
    struct relaxing relaxing = {.mechanisms = mechanisms_of(d), .parts = d->parts, .extra = extra};
    memcpy(relaxing.rate, d->damping->rate, sizeof relaxing.rate);
    for (size_t p = 0; p < d->parts; p++) {
        const struct damped_part *part = &d->part[p];
        relaxing.part[p] =
            (struct relaxing_part){.model = part->model, .given = part->given, .extra = part->extra};
        memcpy(relaxing.part[p].weight, part->memory, sizeof relaxing.part[p].weight);
    }
    const selas_status status =
        first->one_pass != NULL ? first->one_pass->relax(first, &relaxing) : SELAS_UNSUPPORTED;
    if (status == SELAS_UNSUPPORTED) first->one_pass = NULL;
    return status == SELAS_NO_MEMORY ? status : SELAS_OK;
}

static const struct model_one_pass one_pass = {
    .begin = begin, .advance = advance, .settle = settle, .kept = kept, .share = share};
static const struct model_operator spatial = {.accelerate = accelerate, .weigh = weigh, .shorten = shorten};
static const struct model_memory memory = {start, remember, drag};

/* What the whole shows of part 0; its state has the mechanisms' memory behind v, then that of the parts. */
static selas_status fill(struct damped *d, const struct scene *scene, struct messages *messages)
{
    struct model *model = &d->model;
    struct model *first = d->part[0].model;
    size_t extra = d->damping->mechanisms * first->unknowns, bytes = 0, most = 0;
    for (size_t p = 0; p < d->parts; p++) {
        d->part[p].extra = extra;
        extra += d->part[p].model->state_size - 2 * first->unknowns;
        if (bytes + d->part[p].model->setup_bytes > most) most = bytes + d->part[p].model->setup_bytes;
        bytes += d->part[p].model->bytes;
    }
    first->parts = (unsigned)d->parts;
    const bool room = relax(d, extra) == SELAS_OK;
    bytes = 0; /* with what steps in one pass take, or no more need */
    for (size_t p = 0; p < d->parts; p++)
        bytes += d->part[p].model->bytes;
    if (first->single && first->one_pass == NULL)
        return fail(messages, SELAS_UNSUPPORTED,
                    "method%%precision = 'single' needs one damped material and no more");
    *model = *first;
    d->core = damped_core;
    if (first->core->holder == NULL) d->core.holder = NULL;
    if (first->core->share == NULL) d->core.share = NULL;
    if (first->core->complete == NULL) d->core.complete = NULL;
    model->core = &d->core;
    model->energy_calls = (unsigned)(d->parts * (1 + mechanisms_of(d)));
    model->spatial = &spatial;
    model->memory = &memory;
    model->one_pass = first->one_pass != NULL ? &one_pass : NULL;
    model->scene = scene;
    model->state_size = 2 * model->unknowns + extra;
    d->effective = array_new(2 * model->unknowns, sizeof *d->effective);
    if (d->parts > 1) d->sum = array_new(model->unknowns, sizeof *d->sum);
    model->setup_bytes = most; /* the parts are made one after the other */
    model->bytes = bytes + sizeof *d + (d->parts > 1 ? 3 : 2) * model->unknowns * sizeof(double);
    if (!room || d->effective == NULL || (d->parts > 1 && d->sum == NULL))
        return fail(messages, SELAS_NO_MEMORY, "no memory for damped materials");
    return SELAS_OK;
}

selas_status damped_or_plain(const struct method *method, const struct scene *scene, struct model **model,
                             struct messages *messages)
{
    *model = NULL;
    if (!ground_is_damped(scene)) return method->create(scene, model, messages);
    struct damped *d = array_new(1, sizeof *d);
    if (d == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for damped materials");
    selas_status status = ground_damping_new(scene, true, &d->damping, messages);
    if (status == SELAS_OK) status = damped_split(d, scene, messages);
    for (size_t p = 0; p < d->parts && status == SELAS_OK; p++) {
        status = method->create(&d->part[p].scene, &d->part[p].model, messages);
        if (status == SELAS_OK) d->part[p].model->whole = d->part[0].model;
        if (d->field != NULL) ground_model_forget(&d->field[p]);
    }
    if (status == SELAS_OK) status = fill(d, scene, messages);
    if (status == SELAS_OK)
        *model = &d->model;
    else
        damped_free(&d->model);
    return status;
}
