/* What users see of a damped model: strain and motion are those of u, stress is that of all parts,
 * sigma = sum over parts of C_p grad e_p, energies are quadratic forms of u and D_l (doc/theory/damping.md, Eq 16). */
#include "method/damped/damped.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

static struct model *first_of(const struct model *model)
{
    return ((const struct damped *)model)->part[0].model;
}

static void initialise(struct model *model, double *y)
{
    struct damped *d = damped_of(model);
    const size_t n = model->unknowns;
    struct model *first = first_of(model);
    if (first->core->initialise != NULL) first->core->initialise(first, y);
    for (size_t l = 0; l < d->damping->mechanisms; l++) /* nothing has relaxed yet */
        memcpy(y + (2 + l) * n, y, n * sizeof *y);
}

static selas_status find_probe(struct model *model, const double position[3], struct probe *probe,
                               struct messages *messages)
{
    struct model *first = first_of(model);
    return first->core->probe(first, position, probe, messages);
}

/* --- Fields ------------------------------------------------------------------------------------------- */

/* A field of a part: of points, or at a probe. */
struct look {
    const struct probe *probe;
    selas_field field;
    size_t numbers; /* in a value */
    size_t from, end;
};

static void look_at(const struct damped *d, const struct damped_part *part, const struct look *look,
                    const double *y, const double *a, double *value)
{
    if (look->probe == NULL) {
        part->model->core->field(part->model, look->field, y, a, look->from, look->end, value);
        return;
    }
    struct probe probe = *look->probe;
    probe.material = &part->material[look->probe->material - d->part[0].material];
    model_observe(part->model, &probe, look->field, y, a, value);
}

static void add(size_t n, double factor, const double *more, double *value)
{
    for (size_t i = 0; i < n; i++)
        value[i] += factor * more[i];
}

static void add_stress(struct damped *d, const struct look *look, const double *y, const double *a,
                       double *more, double *value)
{
    for (size_t p = 0; p < d->parts; p++) {
        damped_effective(d, &d->part[p], y, y + 2 * d->model.unknowns, d->effective);
        look_at(d, &d->part[p], look, d->effective, a, more);
        add(look->numbers, 1, more, value);
    }
}

/* Kinetic energy of v, and the parts' strain energies of u and of D_l. */
static void add_energy(struct damped *d, const struct look *look, const double *y, const double *a,
                       double *more, double *value)
{
    const size_t n = d->model.unknowns;
    memset(d->effective, 0, n * sizeof *y);
    memcpy(d->effective + n, y + n, n * sizeof *y);
    look_at(d, &d->part[0], look, d->effective, a, more);
    add(look->numbers, 1, more, value);
    memset(d->effective + n, 0, n * sizeof *y);
    for (size_t l = 0; l <= d->damping->mechanisms; l++) {
        memcpy(d->effective, l == 0 ? y : y + (1 + l) * n, n * sizeof *y);
        for (size_t p = 0; p < d->parts; p++) {
            look_at(d, &d->part[p], look, d->effective, a, more);
            add(look->numbers, l == 0 ? d->part[p].given : d->part[p].memory[l - 1], more, value);
        }
    }
}

/* NaN where there is no memory for it. */
static void show(struct model *model, struct look *look, const double *y, const double *a, double *value)
{
    struct damped *d = damped_of(model);
    const selas_field field = look->field;
    if (field != SELAS_STRESS && field != SELAS_PRESSURE && field != SELAS_ENERGY) {
        look_at(d, &d->part[0], look, y, a, value);
        return;
    }
    double *more = array_new(look->numbers, sizeof *more);
    for (size_t i = 0; i < look->numbers; i++)
        value[i] = more == NULL ? NAN : 0;
    if (more != NULL && field == SELAS_ENERGY)
        add_energy(d, look, y, a, more, value);
    else if (more != NULL)
        add_stress(d, look, y, a, more, value);
    array_free(more);
}

static void observe(struct model *model, const struct probe *probe, selas_field field, const double *y,
                    const double *a, double *value)
{
    struct look look = {probe, field, (size_t)field_components(field), 0, 1};
    show(model, &look, y, a, value);
}

static void field_of(struct model *model, selas_field field, const double *y, const double *a, size_t from,
                     size_t end, double *value)
{
    struct look look = {NULL, field, (size_t)field_components(field) * (end - from), from, end};
    show(model, &look, y, a, value);
}

static int holder_of(const struct model *model, size_t point)
{
    const struct model *first = first_of(model);
    return first->core->holder(first, point);
}

static void complete(struct model *model, double *u)
{
    struct model *first = first_of(model);
    first->core->complete(first, u);
}

static void share(struct model *model, enum model_array array, struct spread *shares)
{
    struct damped *d = damped_of(model);
    struct model *first = first_of(model);
    if (array != ARRAY_EXTRA) first->core->share(first, array, shares);
    if (array != ARRAY_EXTRA) return;
    for (size_t l = 0; l < d->damping->mechanisms; l++)
        first->core->share(first, ARRAY_UNKNOWNS, shares);
    for (size_t p = 0; p < d->parts; p++)
        first->core->share(d->part[p].model, ARRAY_EXTRA, shares);
}

/* --- Energy ------------------------------------------------------------------------------------------- */

/* x.K_p x / 2 */
static double strain_of(struct damped *d, const struct damped_part *part, const double *x)
{
    const size_t n = d->model.unknowns;
    struct energy energy;
    memcpy(d->effective, x, n * sizeof *x);
    memset(d->effective + n, 0, n * sizeof *x);
    part->model->core->energy(part->model, d->effective, &energy);
    return energy.strain;
}

static void energy(struct model *model, const double *y, struct energy *energy)
{
    struct damped *d = damped_of(model);
    const size_t n = model->unknowns;
    struct model *first = first_of(model);
    memset(d->effective, 0, n * sizeof *y);
    memcpy(d->effective + n, y + n, n * sizeof *y);
    first->core->energy(first, d->effective, energy);
    energy->strain = 0;
    for (size_t p = 0; p < d->parts; p++) {
        energy->strain += d->part[p].given * strain_of(d, &d->part[p], y);
        for (size_t l = 0; l < d->damping->mechanisms; l++)
            energy->strain += d->part[p].memory[l] * strain_of(d, &d->part[p], y + (2 + l) * n);
    }
}

/* What damping takes: sum over l of r_l D_l.K_l D_l. */
static double loss(struct model *model, const double *y)
{
    struct damped *d = damped_of(model);
    const size_t n = model->unknowns;
    double sum = 0;
    for (size_t l = 0; l < d->damping->mechanisms; l++)
        for (size_t p = 0; p < d->parts; p++)
            sum +=
                2 * d->damping->rate[l] * d->part[p].memory[l] * strain_of(d, &d->part[p], y + (2 + l) * n);
    return sum;
}

static void power(struct model *model, const struct drive *drive, const double *y, double *load,
                  double *absorbed)
{
    struct model *first = first_of(model);
    first->core->power(first, drive, y, load, absorbed);
}

/* Where layers go wrong; nowhere if there is no memory to look. */
static void unseen(struct model *model, const double *y, struct unseen *found)
{
    struct damped *d = damped_of(model);
    *found = (struct unseen){.speed = -1};
    for (size_t p = 0; p < d->parts; p++) {
        struct model *part = d->part[p].model;
        struct unseen one = {.speed = -1};
        double *own = part->core->unseen != NULL ? array_new(part->state_size, sizeof *own) : NULL;
        if (own == NULL) continue;
        memcpy(own, y, 2 * model->unknowns * sizeof *own);
        memcpy(own + 2 * model->unknowns, y + 2 * model->unknowns + d->part[p].extra,
               (part->state_size - 2 * model->unknowns) * sizeof *own);
        part->core->unseen(part, own, &one);
        if (one.spoiled > found->spoiled || (found->spoiled == 0 && one.speed > found->speed)) *found = one;
        array_free(own);
    }
}

static void forget(struct model *model)
{
    struct model *first = first_of(model);
    if (first->core->forget != NULL) first->core->forget(first);
}

const struct model_core damped_core = {
    .destroy = damped_free,
    .initialise = initialise,
    .probe = find_probe,
    .observe = observe,
    .field = field_of,
    .holder = holder_of,
    .share = share,
    .complete = complete,
    .energy = energy,
    .power = power,
    .loss = loss,
    .unseen = unseen,
    .describe = damped_describe,
    .forget = forget,
};
