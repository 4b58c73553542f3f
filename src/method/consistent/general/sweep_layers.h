/* What a sweep does where absorbing layers are (doc/theory/general-ground.md, section 5), for numbers of type REAL;
 * included by sweep_double.c and sweep_single.c. Their memory is in double precision.
 *
 * psi goes on by the slopes of u - dt/2 w, u being that of the step's end and w still the velocity in its middle,
 * right before the points' stresses are made; in planes that two threads need, in a stage of its own. Forces of
 * stresses along a layer's axis are kept apart in rings. Once those of a plane are complete phi of layers across x
 * and y goes on there; of layers across depth, once all planes are. */

/* psi of a part at the points of a row goes on, or has gone on already, and comes to their slopes; rate: of what u has
 * moved by. */
static void add_memory(const struct pass *pass, const struct NAME(sweep_row) * points,
                       const struct NAME(sweep_row) * rate, size_t p, int f, size_t m, size_t j)
{
    const struct general *g = pass->c->general;
    const struct NAME(sweep_kernels) *kernels = NAME(taken_sweep_kernels)();
    for (size_t l = 0; l < g->layers; l++) {
        const struct general_layer *layer = &g->layer[l];
        size_t first = 0, end = g->family[f].n[0], at;
        if (!general_layer_points(layer, f, j, m, &first, &end, &at)) continue;
        const enum at along = g->family[f].at[layer->slot];
        const size_t place = general_layer_place(layer, f, first, j, m), n = end - first;
        if (rate != NULL) kernels->slope(rate, layer->slot, first, end);
        for (size_t component = 0; component < 3; component++) {
            const size_t row = (3 * component + (size_t)layer->slot) * points->stride + first;
            double *psi = pass->fields->part[p].extra + at + component * layer->points[f];
            if (rate == NULL)
                kernels->recall(n, psi, points->scratch + row);
            else
                kernels->remember(n, layer->slot == 0, layer->kept[along] + place,
                                  layer->taken[along] + place, half_rate(pass), rate->scratch + row, psi,
                                  points->scratch + row);
        }
    }
}

/* Does a layer have points in plane m of the pairs? */
static bool plane_is_layered(const struct pass *pass, size_t m)
{
    const struct general *g = pass->c->general;
    for (size_t l = 0; l < g->layers; l++)
        for (int f = 0; f < 3; f++)
            if (m >= g->layer[l].at[f][DEPTH] && m < g->layer[l].at[f][DEPTH] + g->layer[l].n[f][DEPTH])
                return true;
    return false;
}

/* Columns of the unclamped splines that a layer's points in row `row` of plane m of the pairs and the two before it
 * read. */
static struct rows columns_read(const struct general *g, size_t l, size_t m, size_t row)
{
    const struct general_layer *layer = &g->layer[l];
    struct rows columns = {0, 0};
    for (int f = 0; f < 3; f++) {
        const size_t *at = layer->at[f], *n = layer->n[f];
        if (m >= at[2] && m < at[2] + n[2] && row >= at[1] && row < at[1] + n[1] + 2)
            join(&columns, at[0], at[0] + n[0] + (g->family[f].at[0] == AT_KNOTS ? 1 : 2));
    }
    return columns;
}

/* What a part moves by, where memory reads it: whole rows in layers across y or depth. */
static void read_rates(const struct pass *pass, REAL *ring, size_t p, size_t m, size_t row)
{
    const struct general *g = pass->c->general;
    struct rows all = {0, 0}, columns[BOX_FACES];
    for (size_t l = 0; l < g->layers; l++) {
        columns[l] = columns_read(g, l, m, row);
        if (g->layer[l].slot != 0) join(&all, columns[l].from, columns[l].end);
    }
    if (all.from < all.end) read_row(pass, rate_of(pass, p), ring, m, row, all);
    for (size_t l = 0; l < g->layers && all.from >= all.end; l++)
        if (columns[l].from < columns[l].end) read_row(pass, rate_of(pass, p), ring, m, row, columns[l]);
}

/* Row of the ring of a part. */
static REAL *part_row(const struct sweep_part *part, const struct rings *r, size_t k, size_t component,
                      size_t row)
{
    return r->part + part->start +
           ((k % SPAN * 3 + component) * part->n[1] + row - part->at[1]) * part->stride;
}

static bool part_has(const struct sweep_part *part, int slot, size_t i)
{
    return i >= part->at[slot] && i < part->at[slot] + part->n[slot];
}

/* Keeps the pulls at a row that is done, apart by their axis. */
static void keep_row(const struct pass *pass, const struct rings *r, size_t m, size_t row)
{
    static const int fields[3][2] = {
        {VALUE_MIDDLES, VALUE_KNOTS}, {ACROSS_MIDDLES, ACROSS_KNOTS}, {SLOPE_MIDDLES, SLOPE_KNOTS}};
    const struct sweep *s = pass->s;
    for (size_t l = 0; l < pass->c->general->layers; l++) {
        const struct sweep_part *part = &s->part[l];
        const int slot = pass->c->general->layer[l].slot, of = slot == DEPTH ? 1 : 0;
        if (!part_has(part, 1, row)) continue;
        for (int component = 0; component < 3; component++) {
            const REAL(*weight)[SPAN] = s->pair[m].weight[component == DEPTH];
            const REAL *one = pull_row(s, r->pull, row, component, fields[slot][0]) + part->at[0],
                       *other = pull_row(s, r->pull, row, component, fields[slot][1]) + part->at[0];
            for (size_t d = 0; d < SPAN; d++)
                if (part_has(part, DEPTH, s->pair[m].base + d)) NAME(taken_sweep_kernels)
            ()->keep(part->n[0], weight[VALUE_MIDDLES + of][d], one, weight[VALUE_KNOTS + of][d], other,
                     part_row(part, r, s->pair[m].base + d, (size_t)component, row));
        }
    }
}

static void forget_parts(const struct pass *pass, const struct rings *r, size_t k)
{
    for (size_t l = 0; l < pass->c->general->layers; l++) {
        const struct sweep_part *part = &pass->s->part[l];
        if (part_has(part, DEPTH, k))
            memset(part_row(part, r, k, 0, part->at[1]), 0, 3 * part->n[1] * part->stride * sizeof(REAL));
    }
}

/* Numbers of unclamped splines to those of the open ends, n of them at an end, from row to row `stride` apart. */
static void clamp_end(size_t n, bool mirror, bool odd, REAL *end, REAL *next)
{
    mix(n, 1, mirror && !odd ? 1 : -1, end, next);
    for (size_t i = 0; i < n && !mirror; i++)
        end[i] *= 2;
}

/* The same for all ends that a part has. */
static void clamp_part(const struct pass *pass, const struct rings *r, const struct sweep_part *part,
                       size_t k, size_t component)
{
    const struct sweep *s = pass->s;
    for (int high = 0; high < 2; high++) {
        const size_t row = high ? unclamped(s, 1) - 1 : 0, next = high ? row - 1 : 1;
        if (part_has(part, 1, row))
            clamp_end(part->n[0], s->mirror[1][high], component == 1, part_row(part, r, k, component, row),
                      part_row(part, r, k, component, next));
        const size_t column = high ? unclamped(s, 0) - 1 : 0, beside = high ? column - 1 : 1;
        for (size_t j = part->at[1]; part_has(part, 0, column) && j < part->at[1] + part->n[1]; j++) {
            REAL *at = part_row(part, r, k, component, j) - part->at[0];
            clamp_end(1, s->mirror[0][high], component == 0, at + column, at + beside);
        }
    }
}

/* Does plane k wait for all planes of a layer over depth? */
static bool waits_for(const struct pass *pass, size_t l, size_t k)
{
    return pass->moving && pass->c->general->layer[l].slot == DEPTH && part_has(&pass->s->part[l], DEPTH, k);
}

/* Rows where the memory of layers over depth is not 0 after the step, in any plane: moments act on all across a layer,
 * and points reach 2 rows and planes beyond what moves. */
static void lay_deep(struct pass *pass)
{
    enum { REACH = 2 };
    const struct sweep *s = pass->s;
    for (size_t l = 0; pass->moving && l < pass->c->general->layers; l++) {
        const struct sweep_part *part = &s->part[l];
        const size_t after = part->at[DEPTH] + part->n[DEPTH] + REACH;
        struct rows *deep = &pass->deep[l];
        for (size_t k = less(part->at[DEPTH], REACH); k < after && k < s->n[DEPTH]; k++)
            join(deep, s->reached[k].from, s->reached[k].end);
        if (deep->from < deep->end) join(deep, less(deep->from, REACH), deep->end + REACH);
        if (deep->end > s->n[1]) deep->end = s->n[1];
    }
}

/* Adds the rows of plane k where the memory of layers is not 0. */
static void join_layers(const struct pass *pass, size_t k, struct rows *rows)
{
    const struct sweep *s = pass->s;
    if (!s->layered) return;
    join(rows, pass->moving ? s->reached[k].from : 0, pass->moving ? s->reached[k].end : s->n[1]);
    for (size_t l = 0; l < pass->c->general->layers; l++) {
        const struct general_layer *layer = &pass->c->general->layer[l];
        const size_t from = layer->slab->inside.at[1], end = from + layer->slab->inside.n[1];
        if (layer->slot == 1 && rows->from < end && rows->end > from) join(rows, from, end);
        if (waits_for(pass, l, k)) join(rows, pass->deep[l].from, pass->deep[l].end);
    }
}

/* Forces f of a layer in plane k, which are complete, into the state. */
static void take_forces(const struct pass *pass, const struct rings *r, size_t l, size_t k,
                        const struct rows *rows)
{
    const struct sweep *s = pass->s;
    const struct slab *slab = pass->c->general->layer[l].slab;
    const size_t moments = general_layer_moments(pass->c, slab), n = slab->inside.n[0];
    double *row = (double *)r->taken;
    for (size_t component = 0; component < 3; component++) {
        clamp_part(pass, r, &s->part[l], k, component);
        for (size_t j = rows->from, at; j < rows->end; j++) {
            if (!general_layer_row(slab, j, k, &at)) continue;
            const REAL *from = part_row(&s->part[l], r, k, component, j + s->low[1]) + slab->inside.at[0] +
                               s->low[0] - s->part[l].at[0];
            for (size_t i = 0; i < n; i++)
                row[i] = from[i];
            general_layers_take(pass->c, moments + component * slab->inner + at, n, row, pass->extra);
        }
    }
}

/* phi of a layer across x or y goes on in plane k. */
static void move_along(const struct pass *pass, size_t l, size_t k)
{
    const struct general_layer *layer = &pass->c->general->layer[l];
    for (size_t component = 0; component < 3; component++)
        moment_rows_move(pass->c, &layer->rows, layer->slab, pass->dt,
                         general_layer_moments(pass->c, layer->slab), component, k, pass->extra);
}

/* What layers do in a plane whose forces are complete. */
static void layers_done(const struct pass *pass, const struct rings *r, size_t k, const struct rows *rows)
{
    for (size_t l = 0; pass->moving && l < pass->c->general->layers; l++) {
        if (!part_has(&pass->s->part[l], DEPTH, k)) continue;
        take_forces(pass, r, l, k, rows);
        if (pass->c->general->layer[l].slot != DEPTH) move_along(pass, l, k);
    }
}

/* Does plane k wait for any? */
static bool waits(const struct pass *pass, size_t k)
{
    for (size_t l = 0; l < pass->c->general->layers; l++)
        if (waits_for(pass, l, k)) return true;
    return false;
}

/* Adds phi, times root, to rows of plane k: of layers over depth, or of the others. */
static void add_moments(const struct pass *pass, const struct rings *r, bool over_depth, size_t component,
                        size_t k, const struct rows *rows)
{
    const struct sweep *s = pass->s;
    for (size_t l = 0; l < pass->c->general->layers; l++) {
        const struct slab *slab = pass->c->general->layer[l].slab;
        if ((pass->c->general->layer[l].slot == DEPTH) != over_depth) continue;
        for (size_t j = rows->from, at; j < rows->end; j++) {
            if (!general_layer_row(slab, j, k, &at)) continue;
            const size_t first = slab->inside.at[0];
            NAME(taken_sweep_kernels)
            ()->pull(slab->inside.n[0], pass->extra + slab->phi + component * slab->inner + at,
                     (const REAL *)s->root + k * s->plane + j * s->n[0] + first,
                     r->scaled + j * s->stride + first);
        }
    }
}

/* phi of layers over depth goes on in the rows of a thread. */
static void move_over_depth(const struct pass *pass, size_t from, size_t end)
{
    for (size_t l = 0; l < pass->c->general->layers; l++) {
        const struct general_layer *layer = &pass->c->general->layer[l];
        if (layer->slot != DEPTH) continue;
        for (size_t component = 0; component < 3; component++)
            for (size_t j = from; j < end; j++)
                moment_rows_move(pass->c, &layer->rows, layer->slab, pass->dt,
                                 general_layer_moments(pass->c, layer->slab), component, j, pass->extra);
    }
}

/* What is left of the velocities of plane k where layers damp them besides (Eq 11 of absorbing-faces.md). */
static void drag_plane(const struct pass *pass, size_t k)
{
    const struct sweep *s = pass->s;
    for (size_t l = 0; l < pass->c->general->layers; l++) {
        const struct slab *slab = pass->c->general->layer[l].slab;
        const struct block *in = &slab->inside;
        const int slot = pass->c->general->layer[l].slot;
        for (size_t j = s->reached[k].from, at; slab->drag != NULL && j < s->reached[k].end; j++) {
            if (!general_layer_row(slab, j, k, &at)) continue;
            const double *kept = slot == 0 ? slab->kept : slab->kept + (slot == 1 ? j : k) - in->at[slot];
            for (size_t component = 0; component < 3; component++) {
                REAL *row = pass->out + component * s->volume + k * s->plane + j * s->n[0] + in->at[0];
                for (size_t i = 0; i < in->n[0]; i++)
                    row[i] *= (REAL)kept[slot == 0 ? i : 0];
            }
        }
    }
}

static void drag_planes(const struct pass *pass)
{
    const struct consistent *c = pass->c;
#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (size_t k = 0; k < (c->pml != NULL && c->pml->drag > 0 ? pass->s->n[2] : 0); k++)
        drag_plane(pass, k);
}
