/* Making of a sweep (sweep.h): its tables, in numbers of double or single precision. */
#include "method/consistent/general/sweep.h"

#include "base/memory.h"

#include <string.h>

/* Room for numbers of the sweep. */
static void *numbers(struct sweep *s, size_t count)
{
    s->bytes += count * s->number;
    return array_new(count, s->number);
}

static void set(const struct sweep *s, void *table, size_t at, double value)
{
    if (s->number == sizeof(double))
        ((double *)table)[at] = value;
    else
        ((float *)table)[at] = (float)value;
}

/* Weights over depth of the points of pair m: planes of knots and of middles. */
static void lay_pair(const struct consistent *c, struct sweep *s, size_t m)
{
    const size_t most = s->n[2] - SPAN, here = m > s->low[2] ? m - s->low[2] : 0;
    struct over_depth *pair = &s->pair[m];
    pair->base = here < most ? here : most;
    for (size_t odd = 0; odd < 2; odd++) {
        const size_t table = (2 * m + odd) * DEPTH_FIELDS * SPAN;
        pair->weight[odd] = (char *)s->weights + table * s->number;
        for (int at = AT_KNOTS; at <= AT_MIDDLES; at++) {
            if (m == s->cells[2] && at == AT_MIDDLES) continue;
            const struct taps *taps = &c->general->taps[DEPTH][odd][at][m];
            const size_t value = at == AT_KNOTS ? VALUE_KNOTS : VALUE_MIDDLES;
            for (size_t d = 0; d < taps->count; d++) {
                const size_t place = table + value * SPAN + taps->first + d - pair->base;
                set(s, s->weights, place, taps->value[d]);
                set(s, s->weights, place + SPAN, taps->slope[d]);
            }
        }
    }
}

static bool lay_pairs(const struct consistent *c, struct sweep *s)
{
    const size_t pairs = s->cells[2] + 1;
    s->pair = array_new(pairs, sizeof *s->pair);
    s->weights = numbers(s, pairs * 2 * DEPTH_FIELDS * SPAN);
    if (s->pair == NULL || s->weights == NULL) return false;
    for (size_t m = 0; m < pairs; m++)
        lay_pair(c, s, m);
    return true;
}

/* N of the components along the axes. */
static bool lay_inverse(struct consistent *c, struct sweep *s)
{
    const size_t rows = fused_rounded(s->n[1], FUSED_ROWS), planes = fused_rounded(s->n[2], SWEEP_PLANES);
    for (int component = 0; component < 3; component++) {
        struct band *const *band = c->hform->inverse[component];
        const struct band *depth = part_matrix(c, DEPTH, band[2]);
        if (depth == NULL) return false;
        s->x[component] = fused_by_vectors(band[0], 1, SWEEP_TAPS, s->width, FUSED_VECTOR / s->number);
        s->y[component] = fused_by_rows(band[1], 1, SWEEP_TAPS, rows);
        s->z[component] = fused_by_rows(depth, 1, SWEEP_TAPS, planes);
        if (s->x[component] == NULL || s->y[component] == NULL || s->z[component] == NULL) return false;
    }
    s->plain = array_new(rows / FUSED_ROWS, sizeof *s->plain);
    if (s->plain == NULL) return false;
    memset(s->plain, true, rows / FUSED_ROWS * sizeof *s->plain);
    for (int component = 0; component < 3; component++)
        fused_find_plain(s->y[component], SWEEP_TAPS, s->n[1], s->plain);
    for (int component = 0; component < 3 && s->number == sizeof(float); component++) {
        fused_shorten(s->x[component], SWEEP_TAPS * s->width);
        fused_shorten(s->y[component], SWEEP_TAPS * rows);
        fused_shorten(s->z[component], SWEEP_TAPS * planes);
    }
    return true;
}

/* A table of rows of n numbers as rows of `width`, 0 beyond. */
static void *widened(struct sweep *s, const double *table, size_t n, size_t rows)
{
    void *wide = numbers(s, rows * s->width);
    for (size_t row = 0; wide != NULL && row < rows; row++)
        for (size_t i = 0; i < n; i++)
            set(s, wide, row * s->width + i, table[row * n + i]);
    return wide;
}

/* Factors of values and slopes at a point of an axis, without which the kernels take them. */
static double factor_at(const struct consistent *c, int slot, enum at at, bool slope)
{
    const struct spline *spline = c->layout[slot];
    const double scale = (double)c->general->cells[slot] / (spline->high - spline->low);
    if (slope) return at == AT_KNOTS ? scale : scale / 2;
    return at == AT_KNOTS ? .5 : .125;
}

/* Moduli of part p, that of `ground`. */
static bool lay_moduli(const struct general *ground, struct sweep *s, size_t p)
{
    for (int f = 0; f < 3; f++) {
        const struct family *family = &ground->family[f];
        const size_t rows = family->n[1] * family->n[2];
        void *lambda = s->moduli[p].lambda[f] = widened(s, family->lambda, family->n[0], rows);
        void *mu = s->moduli[p].mu[f] = widened(s, family->mu, family->n[0], rows);
        if (lambda == NULL || mu == NULL) return false;
        for (size_t row = 0; p > 0 && family->runs > 0 && row < rows; row++)
            for (size_t n = family->first_run[row]; n < family->first_run[row + 1]; n++)
                for (size_t i = 0; i < family->run[n].count; i++) {
                    set(s, lambda, row * s->width + family->run[n].from + i, 0);
                    set(s, mu, row * s->width + family->run[n].from + i, 0);
                }
    }
    return true;
}

static bool lay_points(const struct consistent *c, struct sweep *s)
{
    const struct hill *hill = c->general->hill;
    for (int f = 0; f < 3; f++) {
        const struct family *family = &c->general->family[f];
        s->points[f][0] = family->n[1];
        s->points[f][1] = family->n[2];
        for (int slot = 0; slot < 3; slot++)
            s->factor[f][slot] =
                factor_at(c, 0, family->at[0], slot == 0) * factor_at(c, 1, family->at[1], slot == 1);
        for (int i = 0; hill != NULL && i < 3; i++) {
            s->hill[f][i] =
                widened(s, i == 0 ? hill->drop[f] : hill->slope[f][i - 1], family->n[0], family->n[1]);
            if (s->hill[f][i] == NULL) return false;
        }
    }
    return true;
}

/* Rings for forces along the axes of layers. */
static void lay_parts(const struct consistent *c, struct sweep *s)
{
    s->layered = c->pml != NULL;
    for (size_t l = 0; l < c->general->layers; l++) {
        const struct general_layer *layer = &c->general->layer[l];
        const struct block *in = &layer->slab->inside;
        struct sweep_part *part = &s->part[l];
        *part = (struct sweep_part){.n = {s->width, s->cells[1] + 2, s->n[2]}, .start = s->part_size};
        part->at[layer->slot] = in->at[layer->slot] + (layer->slot == DEPTH ? 0 : s->low[layer->slot]);
        part->n[layer->slot] = in->n[layer->slot];
        part->stride = fused_rounded(part->n[0], FUSED_VECTOR / s->number);
        s->part_size += 3 * SPAN * part->n[1] * part->stride;
    }
}

/* Rooms of the threads, for all parts. */
static bool lay_buffers(const struct consistent *c, struct sweep *s)
{
    const struct edges *edges = c->general->edges;
    const size_t at_edges = edges != NULL ? SPAN * edges->most * 9 : 0,
                 taken = (s->stride + at_edges) * sizeof(double) / s->number; /* of doubles */
    const size_t room = (SPAN * 3 * (s->parts * DEPTH_FIELDS + PULL_FIELDS) + 9 + STRESS_ROOM +
                         3 * SPAN * (s->cells[1] + 2) + s->n[1] + 2 * FUSED_ROWS + 2) *
                            s->stride +
                        (s->layered ? SPAN * 3 * s->parts * DEPTH_FIELDS + 9 : 0) * s->stride + s->part_size +
                        taken;
    for (size_t thread = 0; thread < (size_t)c->threads; thread++) {
        array_free(s->buffer[thread]);
        s->buffer[thread] = numbers(s, room);
        if (s->buffer[thread] == NULL) return false;
    }
    return true;
}

static bool lay_fields(const struct consistent *c, struct sweep *s)
{
    const size_t planes = s->n[2], threads = (size_t)c->threads;
    s->root = numbers(s, s->volume);
    s->ready = numbers(s, 3 * planes * s->rows * s->stride + s->stride);
    s->size = array_new(planes * s->n[1], sizeof *s->size);
    s->reached = array_new(planes, sizeof *s->reached);
    s->loaded = array_new(planes, sizeof *s->loaded);
    s->filled = array_new(planes, sizeof *s->filled);
    s->waiting = array_new(planes, sizeof *s->waiting);
    s->bound = array_new(threads + 1, sizeof *s->bound);
    s->buffer = array_new(threads, sizeof *s->buffer);
    s->kept_bytes = (s->number == sizeof(double) ? 1 : 2) * c->model.unknowns * s->number;
    s->kept = array_new(1, s->kept_bytes);
    s->bytes += s->kept_bytes + planes * s->n[1] * sizeof *s->size;
    if (s->root == NULL || s->ready == NULL || s->size == NULL || s->reached == NULL || s->loaded == NULL ||
        s->filled == NULL || s->waiting == NULL || s->bound == NULL || s->buffer == NULL || s->kept == NULL)
        return false;
    for (size_t i = 0; i < s->volume; i++)
        set(s, s->root, i, c->general->root[i]);
    return lay_buffers(c, s);
}

/* Rows where loads act. */
static void lay_loaded(const struct consistent *c, struct sweep *s)
{
    for (size_t l = 0; l < c->load.count; l++) {
        const struct sparse *load = &c->load.of[l];
        for (size_t p = 0; p < load->planes; p++)
            for (size_t e = load->start[p]; e < load->start[p + 1]; e++) {
                struct rows *rows = &s->loaded[load->plane[p] % s->n[2]];
                const size_t j = load->index[e] / s->n[0];
                if (rows->from >= rows->end) *rows = (struct rows){j, j + 1};
                if (j < rows->from) rows->from = j;
                if (j >= rows->end) rows->end = j + 1;
            }
    }
}

bool sweep_create(struct consistent *c)
{
    struct sweep *s = c->general->sweep = array_new(1, sizeof *s);
    if (s == NULL) return false;
    s->number = c->options.single ? sizeof(float) : sizeof(double);
    s->plane = c->plane;
    s->volume = c->volume;
    s->quiet = c->options.quiet;
    s->threads = c->threads;
    s->parts = 1;
    for (int slot = 0; slot < 3; slot++) {
        s->n[slot] = c->n[slot];
        s->cells[slot] = c->general->cells[slot];
        for (int end = 0; end < 2; end++)
            s->mirror[slot][end] = c->layout[slot]->mirror[end];
        s->low[slot] = s->mirror[slot][0] && (slot != DEPTH || c->part.along[DEPTH].first == 0) ? 1 : 0;
    }
    s->width = fused_rounded(s->cells[0] + 2, FUSED_VECTOR / s->number);
    s->stride = s->width + FUSED_VECTOR / s->number;
    s->rows = fused_rounded(s->n[1], FUSED_ROWS);
    lay_parts(c, s);
    if (!lay_pairs(c, s) || !lay_inverse(c, s) || !lay_moduli(c->general, s, 0) || !lay_points(c, s) ||
        !lay_fields(c, s))
        return false;
    lay_loaded(c, s);
    c->general->bytes += s->bytes;
    return true;
}

bool sweep_relax(struct consistent *c, const struct relaxing *relaxing)
{
    struct sweep *s = c->general->sweep;
    const bool single = s->number == sizeof(float);
    const size_t fields = single ? 1 + relaxing->mechanisms : relaxing->parts, before = s->bytes;
    s->parts = relaxing->parts;
    s->bytes -= s->kept_bytes;
    s->kept_bytes = (1 + fields) * c->model.unknowns * s->number;
    s->bytes += s->kept_bytes;
    array_free(s->kept);
    s->kept = array_new(1, s->kept_bytes);
    s->relaxing = fused_relaxing_new(relaxing);
    if (s->kept == NULL || s->relaxing == NULL) return false;
    for (size_t p = 1; p < relaxing->parts; p++)
        if (!lay_moduli(consistent_of(relaxing->part[p].model)->general, s, p)) return false;
    if (relaxing->parts > 1 && !lay_buffers(c, s)) return false;
    c->model.bytes += s->bytes - before;
    return true;
}

void sweep_free(struct sweep *s)
{
    if (s == NULL) return;
    for (int i = 0; i < 3; i++) {
        array_free(s->x[i]);
        array_free(s->y[i]);
        array_free(s->z[i]);
        for (size_t p = 0; p < FUSED_FIELDS_KEPT; p++) {
            array_free(s->moduli[p].lambda[i]);
            array_free(s->moduli[p].mu[i]);
        }
        for (int j = 0; j < 3; j++)
            array_free(s->hill[i][j]);
    }
    for (int thread = 0; s->buffer != NULL && thread < s->threads; thread++)
        array_free(s->buffer[thread]);
    array_free(s->buffer);
    array_free(s->pair);
    array_free(s->weights);
    array_free(s->plain);
    array_free(s->root);
    array_free(s->ready);
    array_free(s->size);
    array_free(s->reached);
    array_free(s->loaded);
    array_free(s->filled);
    array_free(s->waiting);
    array_free(s->bound);
    array_free(s->kept);
    array_free(s->relaxing);
    array_free(s);
}
