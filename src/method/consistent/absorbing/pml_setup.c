/* Building the absorbing layers: slabs, damping profiles, matrices (doc/theory/absorbing-faces.md, sections 2 and
 * 3). The matrices of the axis across the face are cut to the slab's region; nothing outside is touched. */
#include "method/consistent/absorbing/pml_fast.h"
#include "method/consistent/absorbing/pml_terms.h"

#include "base/memory.h"
#include "scene/absorbing_layers.h"
#include "scene/grading.h"

#include <math.h>
#include <string.h>
/* Damping of velocities (Eq 11): this power of d / d_max. */
static const double drag_power = 4;

static bool lay_drag(const struct consistent *c, struct slab *slab, size_t count, double most)
{
    const double share = layer_drag(c->model.scene, 2 * slab->axis + slab->end);
    c->pml->drag = fmax(c->pml->drag, share);
    if (share == 0) return true;
    slab->drag = array_new(count, sizeof *slab->drag);
    slab->kept = array_new(count, sizeof *slab->kept);
    if (slab->drag == NULL || slab->kept == NULL) return false;
    for (size_t i = 0; i < count; i++)
        slab->drag[i] = share * slab->damping[i] * pow(slab->damping[i] / most, drag_power);
    return true;
}

/* d(x) = (p + 1) c_p ln(1/R) / (2 L) * (distance / L)^p: then the integral of d over the layer's thickness L,
 * there and back, takes the amplitude down to R at normal incidence (Eq 9). */
double pml_damping_at(const struct consistent *c, const struct slab *slab, double x)
{
    const struct spline *spline = c->spline[slab->axis];
    const double thickness = slab->end == 0 ? slab->edge - spline->low : spline->high - slab->edge;
    return slab->most * pow(fabs(x - slab->edge) / thickness, LAYER_POWER);
}

static bool lay_damping(struct consistent *c, struct slab *slab)
{
    const struct body *body = &c->model.scene->body;
    const struct spline *spline = c->spline[slab->axis];
    const int slot = c->slot[slab->axis], face = 2 * slab->axis + slab->end;
    const double edge = slab->end == 0 ? body->low[slab->axis] : body->high[slab->axis];
    const double thickness = slab->end == 0 ? edge - spline->low : spline->high - edge;
    const double reflection = layer_profile_reflection(c->model.scene, face, c->layer[face]);
    const double fastest = consistent_fastest(c, face);
    const double stretch =
        slot == DEPTH ? grading_stretch(body->grading, edge) : 1; /* even beyond the face */
    const double most = (LAYER_POWER + 1) * fastest * log(1 / reflection) / (2 * thickness * stretch);
    slab->most = most;
    slab->edge = edge;
    slab->relaxation = LAYER_RELAXATION * fastest / (thickness * stretch);
    size_t count = 0, first = 0;
    for (size_t i = 0; i < spline->count; i++) {
        const double beyond = slab->end == 0 ? edge - spline->greville[i] : spline->greville[i] - edge;
        if (beyond <= 1e-9 * thickness) continue;
        if (count++ == 0) first = i;
    }
    slab->damping = array_new(count, sizeof *slab->damping);
    if (slab->damping == NULL) return false;
    for (size_t i = 0; i < count; i++)
        slab->damping[i] = pml_damping_at(c, slab, spline->greville[first + i]);
    slab->inside = (struct block){.n = {c->n[0], c->n[1], c->n[2]}};
    slab->inside.at[slot] = first - c->part.along[slot].first;
    slab->inside.n[slot] = count;
    return lay_drag(c, slab, count, most);
}

/* The region: the slab and as much before it as the widest matrix reaches. */
static void lay_region(const struct consistent *c, struct slab *slab)
{
    const int slot = c->slot[slab->axis];
    const size_t reach = c->pml->inverse[slab->axis][slab->axis]->half + (size_t)c->options.degree;
    const size_t room = c->n[slot] - slab->inside.n[slot], wider = reach < room ? reach : room;
    slab->region = slab->inside;
    slab->region.n[slot] += wider;
    if (slab->end == 1) slab->region.at[slot] -= wider;
    slab->inner = slab->inside.n[0] * slab->inside.n[1] * slab->inside.n[2];
    slab->volume = slab->region.n[0] * slab->region.n[1] * slab->region.n[2];
}

static struct tensor_plan *plan(struct terms t)
{
    struct consistent *c = t.c;
    if (!t.good || !part_terms(c, t.term, t.count)) return NULL;
    struct tensor_plan *made = tensor_plan_new(t.slab->region.n, c->dimension, t.term, t.count, c->threads);
    if (made != NULL) c->pml->bytes += tensor_plan_bytes(made);
    return made;
}

/* Memory and plans of a slab whose passes are not shared. */
static bool lay_plans(struct consistent *c, struct slab *slab)
{
    const size_t dimension = (size_t)c->dimension;
    slab->middle = array_new(dimension * slab->inner, sizeof *slab->middle);
    c->pml->bytes += dimension * slab->inner * sizeof *slab->middle;
    slab->gradient = plan(terms_gradient(c, slab));
    slab->outer = plan(terms_outer(c, slab));
    slab->pull = plan(terms_pull(c, slab));
    return slab->middle != NULL && slab->gradient != NULL && slab->outer != NULL && slab->pull != NULL;
}

/* Slabs whose passes are worked on one by one, region after region. */
static bool lay_regions(struct consistent *c)
{
    const size_t dimension = (size_t)c->dimension;
    size_t largest = 0;
    bool good = true;
    for (size_t s = 0; good && s < c->pml->slabs; s++) {
        good = lay_plans(c, &c->pml->slab[s]);
        largest = c->pml->slab[s].volume > largest ? c->pml->slab[s].volume : largest;
    }
    c->pml->in = array_new(3 * dimension * largest, sizeof(double));
    c->pml->out = array_new(dimension * largest, sizeof(double));
    c->pml->bytes += 4 * dimension * largest * sizeof(double);
    return good && c->pml->in != NULL && c->pml->out != NULL;
}

/* A layer across an axis that ranks share is whole that of the first or last of them (part_lay.c). */
static bool has_layer(const struct consistent *c, int face)
{
    const struct part_axis *along = &c->part.along[c->slot[face / 2]];
    return along->me == (face % 2 == 0 ? 0 : along->ranks - 1);
}

/* A column of the inverse of an axis' mass, 0 at control values that are held. */
static void inverse_column(struct consistent *c, int component, int axis, size_t column, double *x)
{
    const struct mass_factors *factors = mass_factors_for(c, 0);
    const int slot = c->slot[axis];
    const size_t n = c->spline[axis]->count;
    const double *factor = slot == DEPTH ? factors->depth[component] : factors->side[0][component][slot];
    const bool *held = &c->held[component][2 * axis];
    memset(x, 0, n * sizeof *x);
    if ((held[0] && column == 0) || (held[1] && column == n - 1)) return;
    x[column] = 1;
    band_forward(factor, n, factors->half[slot], x, 1, 1);
    band_backward(factor, n, factors->half[slot], x, 1, 1);
}

/* The inverse of an exact mass as a band: what is below `cut` of the largest in a column is left out. NULL:
 * no memory. */
static struct band *exact_inverse(struct consistent *c, int component, int axis)
{
    const double cut = 1e-10;
    const size_t n = c->spline[axis]->count;
    double *x = array_new(n, sizeof *x);
    size_t half = 0;
    for (size_t j = 0; x != NULL && j < n; j++) {
        double largest = 0;
        inverse_column(c, component, axis, j, x);
        for (size_t i = 0; i < n; i++)
            largest = fmax(largest, fabs(x[i]));
        for (size_t i = 0; i < n; i++) {
            const size_t away = i > j ? i - j : j - i;
            if (fabs(x[i]) > cut * largest && away > half) half = away;
        }
    }
    const size_t most = exact_inverse_half(&c->options); /* leaves room for N G; what halos are laid for */
    if (half > most) half = most;
    struct band *inverse = x == NULL ? NULL : band_new(n, half);
    for (size_t j = 0; inverse != NULL && j < n; j++) {
        inverse_column(c, component, axis, j, x);
        for (size_t i = j < half ? 0 : j - half; i < n && i <= j + half; i++)
            band_add(inverse, i, j, x[i]);
    }
    array_free(x);
    return inverse;
}

/* N of each component and axis: that of the sweeps, or the inverse of the exact mass. */
static bool lay_inverses(struct consistent *c)
{
    struct pml *pml = c->pml;
    for (int axis = 0; axis < c->dimension; axis++)
        for (int component = 0; component < c->dimension; component++) {
            if (c->hform == NULL) pml->own[component][axis] = exact_inverse(c, component, axis);
            pml->inverse[component][axis] =
                c->hform != NULL ? c->hform->inverse[component][axis] : pml->own[component][axis];
            if (pml->inverse[component][axis] == NULL) return false;
        }
    return true;
}

selas_status pml_create(struct consistent *c, struct messages *messages)
{
    bool good = true;
    c->pml = array_new(1, sizeof *c->pml);
    if (c->pml == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for absorbing layers");
    good = lay_inverses(c);
    for (int face = 0; good && face < 2 * c->dimension; face++) {
        if (c->layer[face] == 0 || !has_layer(c, face)) continue;
        struct slab *slab = &c->pml->slab[c->pml->slabs++];
        slab->axis = face / 2;
        slab->end = face % 2;
        good = lay_damping(c, slab);
        if (good) lay_region(c, slab);
    }
    if (good && c->options.general) return SELAS_OK;
    good = good && pml_fast_create(c) && (c->pml->fast != NULL || lay_regions(c));
    if (!good) return fail(messages, SELAS_NO_MEMORY, "no memory for absorbing layers");
    for (size_t s = 0; s < c->pml->slabs; s++) {
        struct slab *slab = &c->pml->slab[s];
        slab->psi = c->pml->extra;
        slab->phi = slab->psi + (size_t)c->dimension * slab->inner;
        c->pml->extra += 2 * (size_t)c->dimension * slab->inner;
    }
    return SELAS_OK;
}

void pml_free(struct consistent *c)
{
    if (c->pml == NULL) return;
    pml_fast_free(c);
    for (size_t s = 0; s < c->pml->slabs; s++) {
        struct slab *slab = &c->pml->slab[s];
        tensor_plan_free(slab->gradient);
        tensor_plan_free(slab->outer);
        tensor_plan_free(slab->pull);
        for (size_t i = 0; i < slab->bands; i++)
            band_free(slab->band[i]);
        array_free(slab->damping);
        array_free(slab->drag);
        array_free(slab->kept);
        array_free(slab->middle);
    }
    for (int component = 0; component < 3; component++)
        for (int axis = 0; axis < 3; axis++)
            band_free(c->pml->own[component][axis]);
    array_free(c->pml->in);
    array_free(c->pml->out);
    array_free(c->pml);
}
