/* The general operator: making, acceleration, M v and energies (doc/theory/general-ground.md). */
#include "method/consistent/general/general.h"
#include "method/consistent/general/glut.h"
#include "method/consistent/general/kink.h"
#include "method/consistent/general/sweep.h"

#include "base/memory.h"
#include "method/consistent/galerkin/moving_load.h"
#include "scene/grading.h"

#include <math.h>
#include <omp.h>
#include <string.h>

enum { ALIGN = 8 };
enum {
    EIGHTHS = 8
}; /* values and slopes times the spacing of the functions at knots and middles are whole ones */

/* Functions at one place of an axis, in ascending order, without those that are 0; at places that are alike the same
 * bits. */
static void lay_taps(const struct spline *spline, bool odd, double x, struct taps *taps)
{
    const double spacing = (spline->high - spline->low) / (double)spline->cells;
    struct spline_point at;
    double value[4] = {0}, slope[4] = {0};
    spline_at(spline, odd, x, &at);
    size_t first = at.index[0];
    for (int j = 1; j < 3; j++)
        first = at.index[j] < first ? at.index[j] : first;
    for (int j = 0; j < 3; j++) {
        value[at.index[j] - first] += at.value[j];
        slope[at.index[j] - first] += at.slope[j];
    }
    size_t from = 0, end = 3;
    while (from < 2 && fabs(value[from]) + spacing * fabs(slope[from]) < 1e-12)
        from++;
    while (end > from + 1 && fabs(value[end - 1]) + spacing * fabs(slope[end - 1]) < 1e-12)
        end--;
    *taps = (struct taps){.first = first + from, .count = end - from};
    for (size_t j = from; j < end; j++) {
        taps->value[j - from] = rint(EIGHTHS * value[j]) / EIGHTHS;
        taps->slope[j - from] = rint(EIGHTHS * spacing * slope[j]) / EIGHTHS / spacing;
    }
}

/* Cells over depth all of whose control values, three planes of them, the window has. */
static void lay_cells(struct consistent *c)
{
    struct general *g = c->general;
    const struct spline *spline = c->layout[DEPTH];
    const size_t low = spline->mirror[0] ? 1 : 0, beyond = c->part.along[DEPTH].first + c->n[DEPTH];
    g->first = c->part.along[DEPTH].first == 0 ? 0 : c->part.along[DEPTH].first + low;
    g->cells[DEPTH] = (beyond == c->part.along[DEPTH].whole ? spline->cells : beyond + low - 2) - g->first;
}

static bool lay_axis(struct consistent *c, int slot)
{
    struct general *g = c->general;
    const struct spline *spline = c->layout[slot];
    if (slot == DEPTH)
        lay_cells(c);
    else
        g->cells[slot] = spline == NULL ? 0 : spline->cells;
    for (int odd = 0; odd < 2; odd++)
        for (int at = 0; at < 2; at++) {
            const size_t count = spline == NULL ? 1 : g->cells[slot] + (at == AT_KNOTS ? 1 : 0);
            struct taps *taps = g->taps[slot][odd][at] = array_new(count, sizeof *taps);
            if (taps == NULL) return false;
            if (spline == NULL) taps[0] = (struct taps){.count = 1, .value = {1}};
            for (size_t i = 0; spline != NULL && i < count; i++) {
                lay_taps(spline, odd, general_place(c, slot, (enum at)at, i), &taps[i]);
                if (slot != DEPTH) continue;
                taps[i].first -= c->part.along[DEPTH].first;
                const double stretch =
                    grading_stretch(c->model.scene->body.grading, general_place(c, slot, (enum at)at, i));
                for (size_t d = 0; d < taps[i].count; d++) /* (G19) */
                    taps[i].slope[d] /= stretch;
            }
        }
    return true;
}

double general_place(const struct consistent *c, int slot, enum at at, size_t i)
{
    const struct spline *spline = c->layout[slot];
    if (spline == NULL) return 0;
    if (slot == DEPTH) i += c->general->first;
    const struct spline_element *element = &spline->element[i < spline->cells ? i : spline->cells - 1];
    if (at == AT_KNOTS) return i < spline->cells ? element->x_from : element->x_to;
    return (element->x_from + element->x_to) / 2;
}

static bool lay_families(struct consistent *c)
{
    struct general *g = c->general;
    for (int f = 0; f < 3; f++) {
        struct family *family = &g->family[f];
        size_t points = 1;
        for (int slot = 0; slot < 3; slot++) {
            family->at[slot] = slot == f ? AT_KNOTS : AT_MIDDLES;
            family->n[slot] = c->layout[slot] == NULL ? 1 : g->cells[slot] + (slot == f ? 1 : 0);
            points *= family->n[slot];
        }
        family->lambda = array_new(points, sizeof(double));
        family->mu = array_new(points, sizeof(double));
        g->bytes += 2 * points * sizeof(double);
        if (family->lambda == NULL || family->mu == NULL) return false;
    }
    return true;
}

static bool lay_inverse(struct consistent *c)
{
    struct tensor_term term[3];
    for (int i = 0; i < c->dimension; i++) {
        term[i] = (struct tensor_term){.out = i, .in = i, .factor = 1};
        for (int axis = 0; axis < c->dimension; axis++)
            term[i].matrix[c->slot[axis]] = c->hform->inverse[i][axis];
    }
    if (!part_terms(c, term, (size_t)c->dimension)) return false;
    c->general->inverse = tensor_plan_new(c->n, c->dimension, term, (size_t)c->dimension, c->threads);
    return c->general->inverse != NULL;
}

static bool lay_buffers(struct consistent *c)
{
    struct general *g = c->general;
    g->pitch = (g->cells[0] + 2 + ALIGN - 1) / ALIGN * ALIGN + 2 * ROW_ROOM;
    g->buffer_size = g->pitch * (PLANE_ROWS * c->n[1] + SCRATCH_ROWS);
    g->buffer = array_new((size_t)c->threads, sizeof *g->buffer);
    for (int thread = 0; g->buffer != NULL && thread < c->threads; thread++) {
        g->buffer[thread] = array_new(g->buffer_size, sizeof **g->buffer);
        if (g->buffer[thread] == NULL) return false;
    }
    g->force = array_new(c->model.unknowns, sizeof *g->force);
    g->work = array_new(c->model.unknowns, sizeof *g->work);
    g->root = array_new(c->volume, sizeof *g->root);
    g->loud = array_new(c->n[1] * c->n[2], sizeof *g->loud);
    g->bytes += ((size_t)c->threads * g->buffer_size + 2 * c->model.unknowns + c->volume) * sizeof(double);
    return g->buffer != NULL && g->force != NULL && g->work != NULL && g->root != NULL && g->loud != NULL;
}

selas_status general_create(struct consistent *c, struct messages *messages)
{
    struct general *g = c->general = array_new(1, sizeof *g);
    bool good = g != NULL;
    for (int slot = 0; good && slot < 3; slot++)
        good = lay_axis(c, slot);
    double *mass = array_new(c->volume, sizeof *mass);
    good = good && mass != NULL && lay_families(c) && general_lay_hill(c) && general_lay_edges(c) &&
           lay_inverse(c) && general_material(c, mass) && general_lay_edge_points(c) && lay_buffers(c);
    selas_status status =
        good ? SELAS_OK
             : fail(messages, SELAS_NO_MEMORY, "no memory for a model of %zu control values", c->volume);
    status = ranks_agree(c->part.ranks, status, messages);
    if (status == SELAS_OK) status = forces_in_ground(c, general_add_glut, general_add_kink, messages);
    if (status == SELAS_OK && !general_scale(c, mass))
        status = fail(messages, SELAS_NO_MEMORY, "no memory for a model of %zu control values", c->volume);
    array_free(mass);
    if (good && status == SELAS_OK) g->bytes += tensor_plan_bytes(g->inverse);
    return status;
}

static void free_family(struct family *family)
{
    array_free(family->lambda);
    array_free(family->mu);
    array_free(family->first_run);
    array_free(family->run);
    array_free(family->stiffness);
}

void general_free(struct consistent *c)
{
    struct general *g = c->general;
    if (g == NULL) return;
    general_layers_free(c);
    sweep_free(g->sweep);
    general_free_hill(c);
    general_free_edges(c);
    for (int slot = 0; slot < 3; slot++)
        for (int odd = 0; odd < 2; odd++)
            for (int at = 0; at < 2; at++)
                array_free(g->taps[slot][odd][at]);
    for (int f = 0; f < 3; f++)
        free_family(&g->family[f]);
    for (int thread = 0; g->buffer != NULL && thread < c->threads; thread++)
        array_free(g->buffer[thread]);
    array_free(g->buffer);
    tensor_plan_free(g->inverse);
    array_free(g->force);
    array_free(g->work);
    array_free(g->root);
    array_free(g->loud);
    array_free(g);
}

/* field *= root, or over it, of all components. */
static void scale(const struct consistent *c, bool over, double *field)
{
    const double *root = c->general->root;
#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (size_t k = 0; k < c->n[DEPTH]; k++)
        for (int component = 0; component < c->dimension; component++) {
            double *plane = field + (size_t)component * c->volume + k * c->plane;
            for (size_t i = 0; i < c->plane; i++)
                plane[i] = over ? plane[i] / root[k * c->plane + i] : plane[i] * root[k * c->plane + i];
        }
}

/* a = R^-1/2 N R^-1/2 force; the force is spoiled. */
static void divide(struct consistent *c, double *force, double *a)
{
    scale(c, false, force);
#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (size_t k = 0; k < c->n[DEPTH]; k++) {
        double *out[3] = {NULL, NULL, NULL};
        for (int component = 0; component < c->dimension; component++) {
            out[component] = a + (size_t)component * c->volume + k * c->plane;
            memset(out[component], 0, c->plane * sizeof *a);
        }
        tensor_plane(c->general->inverse, omp_get_thread_num(), k, 1, force, out);
    }
    scale(c, false, a);
}

void general_accelerate(struct consistent *c, const struct drive *drive, double half_step, const double *u,
                        const double *v, double *a)
{
    struct general *g = c->general;
    const double *extra = c->pml != NULL ? drive->extra : NULL;
    if (extra == NULL || !g->made) general_forces(c, u, extra, g->force);
    g->made = false;
    if (extra != NULL) general_layers_pull(c, extra, g->force);
    for (int component = 0; component < c->dimension; component++)
        for (size_t k = 0; k < c->n[DEPTH]; k++) {
            double *plane = g->force + (size_t)component * c->volume + k * c->plane;
            add_forces(c, drive, &c->load, NULL, component, k, plane);
            moving_loads_add(c, drive, component, k, plane);
        }
    divide(c, g->force, a);
    if (!c->model.damped || (v == NULL && half_step == 0)) return;
    scale(c, true, a);
    if (v != NULL) {
        memcpy(g->work, v, c->model.unknowns * sizeof *v);
        scale(c, true, g->work);
    }
    hform_dampers(c, half_step, v != NULL ? g->work : NULL, a);
    scale(c, false, a);
}

void general_weigh(struct consistent *c, const double *v, double *product)
{
    const double density = c->property[WEIGHT_DENSITY];
    memcpy(product, v, c->model.unknowns * sizeof *v);
    scale(c, true, product);
    mass_solve(c, &c->hform->factors, product); /* gives N^-1 over the density of the body */
#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (size_t i = 0; i < c->model.unknowns; i++)
        product[i] *= density;
    scale(c, true, product);
}

void general_energy(struct consistent *c, const double *y, struct energy *energy)
{
    struct general *g = c->general;
    const size_t n = c->model.unknowns;
    general_weigh(c, y + n, g->work);
    energy->kinetic = part_product(c, g->work, y + n) / 2;
    general_forces(c, y, NULL, g->force);
    energy->strain = -part_product(c, g->force, y) / 2;
}

double general_damper_power(struct consistent *c, const double *v)
{
    if (!c->model.damped) return 0;
    memcpy(c->general->work, v, c->model.unknowns * sizeof *v);
    scale(c, true, c->general->work);
    return hform_damper_power(c, c->general->work) / c->property[WEIGHT_DENSITY];
}
