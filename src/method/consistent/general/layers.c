/* Absorbing layers of the general operator: convolutional perfectly matched layers at its points
 * (doc/theory/general-ground.md, section 5). Along the axis j across the face the layer keeps
 *
 *   psi_ij = F_j[d_j u_i]  at the points,   phi_ij = F_j[f_ij]  at the control values,                  (G13)
 *
 * f_ij the forces of the stresses along j, made with d_j u_i + psi_ij for every slope, F_j of them as of moments
 * (moments.h); steps by the trapezoidal rule as in absorbing/pml.c. */
#include "method/consistent/general/layers.h"

#include "base/memory.h"

#include <math.h>
#include <omp.h>
#include <string.h>

enum { PIECE = 4096 }; /* of numbers that a thread takes */

/* Points of a layer along its slot: those of its cells, the knot of the face not among them. */
static void lay_points(const struct consistent *c, struct general_layer *layer)
{
    for (int f = 0; f < 3; f++) {
        const struct family *family = &c->general->family[f];
        layer->points[f] = 1;
        for (int slot = 0; slot < 3; slot++) {
            layer->at[f][slot] = 0;
            layer->n[f][slot] = family->n[slot];
            if (slot == layer->slot) {
                layer->n[f][slot] = layer->width;
                layer->at[f][slot] = layer->high ? family->n[slot] - layer->width : 0;
            }
            layer->points[f] *= layer->n[f][slot];
        }
    }
}

static bool lay_layer(struct consistent *c, const struct slab *slab, struct general_layer *layer,
                      size_t *extra)
{
    layer->slab = slab;
    layer->slot = c->slot[slab->axis];
    layer->high = slab->end == 1;
    layer->width = c->layer[2 * slab->axis + slab->end];
    lay_points(c, layer);
    for (int at = AT_KNOTS; at <= AT_MIDDLES; at++) {
        layer->damping[at] = array_new(layer->width, sizeof(double));
        layer->kept[at] = array_new(layer->width, sizeof(double));
        layer->taken[at] = array_new(layer->width, sizeof(double));
        if (layer->damping[at] == NULL || layer->kept[at] == NULL || layer->taken[at] == NULL) return false;
        const size_t points = c->general->cells[layer->slot] + (at == AT_KNOTS ? 1 : 0);
        const size_t first = layer->high ? points - layer->width : 0;
        for (size_t i = 0; i < layer->width; i++)
            layer->damping[at][i] =
                pml_damping_at(c, slab, general_place(c, layer->slot, (enum at)at, first + i));
    }
    for (int f = 0; f < 3; f++) {
        layer->psi[f] = *extra;
        *extra += (size_t)c->dimension * layer->points[f];
    }
    return moment_rows_lay(&layer->rows, c, slab);
}

selas_status general_layers_create(struct consistent *c, struct messages *messages)
{
    struct general *g = c->general;
    g->layers = c->pml->slabs;
    g->layer = array_new(g->layers, sizeof *g->layer);
    bool good = g->layer != NULL;
    size_t extra = 0;
    for (size_t l = 0; good && l < g->layers; l++)
        good = lay_layer(c, &c->pml->slab[l], &g->layer[l], &extra);
    for (size_t l = 0; l < g->layers; l++) { /* what looks for spoiled places reads phi in both */
        struct slab *slab = &c->pml->slab[l];
        slab->psi = slab->phi = extra;
        extra += (size_t)c->dimension * slab->inner;
        g->moments += (size_t)c->dimension * slab->inner;
    }
    c->pml->extra = extra + g->moments;
    g->pulled = array_new(g->moments, sizeof *g->pulled);
    g->middle = array_new(g->moments, sizeof *g->middle);
    c->pml->bytes += 2 * g->moments * sizeof *g->middle;
    if (good && g->pulled != NULL && g->middle != NULL) return SELAS_OK;
    return fail(messages, SELAS_NO_MEMORY, "no memory for absorbing layers");
}

void general_layers_free(struct consistent *c)
{
    struct general *g = c->general;
    for (size_t l = 0; g->layer != NULL && l < g->layers; l++) {
        for (int at = 0; at < 2; at++) {
            array_free(g->layer[l].damping[at]);
            array_free(g->layer[l].kept[at]);
            array_free(g->layer[l].taken[at]);
        }
        moment_rows_free(&g->layer[l].rows);
    }
    array_free(g->layer);
    array_free(g->pulled);
    array_free(g->middle);
}

bool general_layer_points(const struct general_layer *layer, int family, size_t j, size_t m, size_t *first,
                          size_t *end, size_t *psi)
{
    const size_t *at = layer->at[family], *n = layer->n[family];
    if (j < at[1] || j >= at[1] + n[1] || m < at[2] || m >= at[2] + n[2]) return false;
    *first = *first > at[0] ? *first : at[0];
    *end = *end < at[0] + n[0] ? *end : at[0] + n[0];
    *psi = layer->psi[family] + ((m - at[2]) * n[1] + j - at[1]) * n[0] + *first - at[0];
    return *first < *end;
}

size_t general_layer_place(const struct general_layer *layer, int family, size_t i, size_t j, size_t m)
{
    return (size_t[]){i, j, m}[layer->slot] - layer->at[family][layer->slot];
}

void general_layers_add(const struct consistent *c, const struct point_plane *plane,
                        const struct family *family, size_t j, size_t m, size_t from, size_t end,
                        const double *extra)
{
    const struct general *g = c->general;
    const int f = (int)(family - g->family);
    for (size_t l = 0; l < g->layers; l++) {
        const struct general_layer *layer = &g->layer[l];
        size_t first = from, last = end, at;
        if (!general_layer_points(layer, f, j, m, &first, &last, &at)) continue;
        for (size_t axis = 0; axis < (size_t)c->dimension; axis++) {
            double *restrict slope = slope_row(plane, c->slot[axis], layer->slot) + first;
            const double *restrict psi = extra + at + axis * layer->points[f];
            for (size_t i = 0; i < last - first; i++)
                slope[i] += psi[i];
        }
    }
}

void general_layers_pull(const struct consistent *c, const double *extra, double *force)
{
    for (size_t s = 0; s < c->pml->slabs; s++) {
        const struct slab *slab = &c->pml->slab[s];
        const struct block *in = &slab->inside;
#pragma omp parallel for num_threads(c->threads) schedule(static)
        for (size_t k = 0; k < in->n[2]; k++)
            for (size_t component = 0; component < (size_t)c->dimension; component++)
                for (size_t j = 0; j < in->n[1]; j++) {
                    double *row = force + component * c->volume + (k + in->at[2]) * c->plane +
                                  (j + in->at[1]) * c->n[0] + in->at[0];
                    const double *phi =
                        extra + slab->phi + component * slab->inner + (k * in->n[1] + j) * in->n[0];
                    for (size_t i = 0; i < in->n[0]; i++)
                        row[i] += phi[i];
                }
    }
}

/* What a layer must read for points first .. end - 1 along each slot: control values, unclamped along x. */
static struct part part_of(const struct consistent *c, const size_t first[2], const size_t end[2])
{
    struct part part = general_whole(c);
    part.from = first[0];
    part.end = end[0] + 2 < part.end ? end[0] + 2 : part.end;
    if (c->layout[1] == NULL) return part;
    part.row = first[1] > 1 ? first[1] - 1 : 0; /* a control value less at a symmetry plane */
    part.row_end = end[1] + 2 < part.row_end ? end[1] + 2 : part.row_end;
    return part;
}

/* Moves psi on at the points of a layer in plane m. */
static void move_slopes(const struct consistent *c, const struct general_layer *layer, int f, size_t m,
                        double *extra, double *buffer)
{
    const struct general *g = c->general;
    const struct family *family = &g->family[f];
    const struct point_plane plane = general_plane(c, family, false, buffer);
    const size_t *at = layer->at[f], *n = layer->n[f];
    const enum at along = family->at[layer->slot];
    for (size_t j = at[1]; j < at[1] + n[1]; j++) {
        if (!general_row_is_loud(c, &g->taps[1][0][family->at[1]][j], &g->taps[2][0][family->at[2]][m]))
            continue;
        taken_point_kernels()->slopes(&plane, j, at[0], at[0] + n[0]);
        size_t first = at[0], end = at[0] + n[0], psi;
        if (!general_layer_points(layer, f, j, m, &first, &end, &psi)) continue;
        for (size_t axis = 0; axis < (size_t)c->dimension; axis++) {
            const double *slope = slope_row(&plane, c->slot[axis], layer->slot) + at[0];
            double *memory = extra + psi + axis * layer->points[f];
            const size_t place = general_layer_place(layer, f, at[0], j, m);
            const double *kept = layer->kept[along] + place, *taken = layer->taken[along] + place;
            for (size_t i = 0; i < n[0]; i++) {
                const size_t one = layer->slot == 0 ? i : 0;
                memory[i] = kept[one] * memory[i] - taken[one] * slope[i];
            }
        }
    }
}

static void move_all_slopes(struct consistent *c, const struct general_layer *layer, const double *u,
                            double *extra)
{
    const struct general *g = c->general;
    for (int f = 0; f < 3; f++) {
        const size_t *at = layer->at[f], *n = layer->n[f];
        const struct part part = part_of(c, at, (size_t[]){at[0] + n[0], at[1] + n[1]});
        const enum at depth = g->family[f].at[DEPTH];
#pragma omp parallel for num_threads(c->threads) schedule(static)
        for (size_t m = at[2]; m < at[2] + n[2]; m++) {
            double *buffer = g->buffer[omp_get_thread_num()];
            if (!general_plane_counts(c, depth, m, 0, c->n[DEPTH])) continue;
            general_read(c, depth, m, &part, u, buffer);
            move_slopes(c, layer, f, m, extra, buffer);
        }
    }
}

bool general_layer_row(const struct slab *slab, size_t j, size_t k, size_t *at)
{
    const struct block *in = &slab->inside;
    if (j < in->at[1] || j >= in->at[1] + in->n[1] || k < in->at[2] || k >= in->at[2] + in->n[2])
        return false;
    *at = ((k - in->at[2]) * in->n[1] + j - in->at[1]) * in->n[0];
    return true;
}

size_t general_layer_moments(const struct consistent *c, const struct slab *slab)
{
    return slab->phi - c->pml->slab[0].phi;
}

void general_layers_forget(const struct consistent *c, size_t from, size_t end)
{
    for (size_t s = 0; s < c->pml->slabs; s++) {
        const struct slab *slab = &c->pml->slab[s];
        const size_t plane = slab->inside.n[0] * slab->inside.n[1];
        for (size_t component = 0; component < (size_t)c->dimension; component++)
            for (size_t k = from, at; k < end; k++)
                if (general_layer_row(slab, slab->inside.at[1], k, &at))
                    memset(c->general->pulled + general_layer_moments(c, slab) + component * slab->inner + at,
                           0, plane * sizeof(double));
    }
}

void general_layers_keep(const struct consistent *c, size_t component, size_t j, size_t k, double value,
                         double slope, const double *const pull[3])
{
    for (size_t s = 0, at; s < c->pml->slabs; s++) {
        const struct slab *slab = &c->pml->slab[s];
        if (!general_layer_row(slab, j, k, &at)) continue;
        const int slot = c->slot[slab->axis];
        const double *from = pull[slot] + slab->inside.at[0], weight = slot == DEPTH ? slope : value;
        double *to = c->general->pulled + general_layer_moments(c, slab) + component * slab->inner + at;
        for (size_t i = 0; i < slab->inside.n[0]; i++)
            to[i] -= weight * from[i];
    }
}

void general_layers_start(struct consistent *c, const double *u, double *extra)
{
    struct general *g = c->general;
    general_forces(c, u, extra, g->force);
    memcpy(extra + c->pml->slab[0].phi + g->moments, g->pulled, g->moments * sizeof *extra);
}

void general_layers_take(const struct consistent *c, size_t at, size_t n, const double *end, double *extra)
{
    const struct general *g = c->general;
    double *pulled = g->pulled + at, *forces = extra + c->pml->slab[0].phi + g->moments + at;
    for (size_t i = 0; i < n; i++) { /* (G13b) */
        const double after = end[i];
        pulled[i] = (forces[i] + after) / 2;
        forces[i] = after;
    }
}

/* By the trapezoidal rule (Eq 10 of absorbing-faces.md). */
void general_layers_prepare(struct consistent *c, double dt)
{
    for (size_t l = 0; l < c->general->layers; l++) {
        struct general_layer *layer = &c->general->layer[l];
        for (int at = AT_KNOTS; at <= AT_MIDDLES; at++)
            for (size_t i = 0; i < layer->width; i++) {
                const double q = layer->damping[at][i] * dt / 2,
                             all = 1 + q + layer->slab->relaxation * dt / 2;
                layer->kept[at][i] = 2 / all - 1;
                layer->taken[at][i] = 2 * q / all;
            }
        moment_rows_eliminate(&layer->rows, layer->slab, dt);
    }
    pml_keep(c, dt);
}

static void move_moments(struct consistent *c, struct general_layer *layer, double dt, double *extra)
{
    const size_t moments = general_layer_moments(c, layer->slab);
    const size_t lines = moment_rows_lines(c, layer->slab);
#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (size_t line = 0; line < (size_t)c->dimension * lines; line++)
        moment_rows_move(c, &layer->rows, layer->slab, dt, moments, line / lines, line % lines, extra);
}

void general_layers_remember(struct consistent *c, double dt, double to_middle, const double *u,
                             const double *v, double *extra)
{
    struct general *g = c->general;
    general_look(c, u); /* before its numbers go into work */
#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (size_t i = 0; i < c->model.unknowns; i++)
        g->work[i] = u[i] + to_middle * v[i];
    general_layers_prepare(c, dt);
    for (size_t l = 0; l < g->layers; l++)
        move_all_slopes(c, &g->layer[l], g->work, extra);
    general_forces(c, u, extra, g->force);
#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (size_t from = 0; from < g->moments; from += PIECE)
        general_layers_take(c, from, g->moments - from < PIECE ? g->moments - from : PIECE, g->pulled + from,
                            extra);
    for (size_t l = 0; l < g->layers; l++)
        move_moments(c, &g->layer[l], dt, extra);
    g->made = true;
}
