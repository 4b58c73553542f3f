/* Forces of the general operator: planes of points across depth, one after the other, each pulling at the
 * planes of control values next to it (doc/theory/general-ground.md, section 2).
 *
 * A thread makes the forces of some planes of control values, from all points that reach them, in the same
 * order whatever the threads: the same bits. */
#include "method/consistent/general/general.h"

#include "method/spline/passes.h"

#include <omp.h>
#include <string.h>

/* Rows of the buffers: values, slopes, pulls of values and of slopes, and where layers keep forces (general.h) those of
 * stresses along y apart, of each component. */
enum field { VALUE, SLOPE, PULL_VALUE, PULL_SLOPE, PULL_ACROSS, FIELDS };
_Static_assert(3 * FIELDS == PLANE_ROWS, "rows of the buffers");

static double *field_of(const struct consistent *c, double *buffer, enum field field, int slot)
{
    return buffer + (size_t)(3 * (int)field + slot) * c->n[1] * c->general->pitch;
}

static double *scratch_of(const struct consistent *c, double *buffer)
{
    return buffer + (size_t)(3 * FIELDS) * c->n[1] * c->general->pitch;
}

/* Control values of the unclamped splines at both ends of a row (G3); row[shift] is the first one of the open
 * ends'. */
static void unclamp(const struct spline *spline, bool odd, size_t cells, const struct part *part, double *row)
{
    const double sign = odd ? -1 : 1;
    if (part->from == 0) row[0] = spline->mirror[0] ? sign * row[1] : 2 * row[0] - row[1];
    if (part->end < cells + 2) return;
    row[cells + 1] = spline->mirror[1] ? sign * row[cells] : 2 * row[cells + 1] - row[cells];
}

/* Its transpose. */
static void clamp(const struct spline *spline, bool odd, size_t cells, const struct part *part, double *row)
{
    const double sign = odd ? -1 : 1, low = row[0], high = row[cells + 1];
    if (part->from == 0 && spline->mirror[0])
        row[1] += sign * low;
    else if (part->from == 0) {
        row[0] = 2 * low;
        row[1] -= low;
    }
    if (part->end < cells + 2) return;
    if (spline->mirror[1])
        row[cells] += sign * high;
    else {
        row[cells + 1] = 2 * high;
        row[cells] -= high;
    }
}

struct part general_whole(const struct consistent *c)
{
    return (struct part){0, c->n[1], 0, c->general->cells[0] + 2};
}

bool general_row_is_loud(const struct consistent *c, const struct taps *y, const struct taps *z)
{
    for (size_t k = z->first; k < z->first + z->count; k++)
        for (size_t j = y->first; j < y->first + y->count; j++)
            if (c->general->loud[k * c->n[1] + j]) return true;
    return false;
}

static const struct taps *taps_at(const struct consistent *c, int slot, bool odd, enum at at, size_t i)
{
    return &c->general->taps[slot][odd][at][i];
}

/* Control values of a row that numbers from .. end - 1 of the unclamped splines stand for. */
static void control_range(const struct consistent *c, const struct part *part, size_t *from, size_t *end)
{
    const size_t shift = c->layout[0]->mirror[0] ? 1 : 0;
    *from = part->from < shift ? 0 : part->from - shift;
    *end = part->end - shift < c->n[0] ? part->end - shift : c->n[0];
}

void general_read(const struct consistent *c, enum at at, size_t m, const struct part *part, const double *u,
                  double *buffer)
{
    const struct general *g = c->general;
    size_t first, end;
    control_range(c, part, &first, &end);
    const struct point_kernels *kernels = taken_point_kernels();
    for (int axis = 0; axis < c->dimension; axis++) {
        const int slot = c->slot[axis];
        const struct taps *z = taps_at(c, DEPTH, slot == DEPTH, at, m);
        const size_t shift = ROW_ROOM + (c->layout[0]->mirror[0] ? 1 : 0);
        for (size_t j = part->row; j < part->row_end; j++) {
            const double *from = u + (size_t)axis * c->volume + z->first * c->plane + j * c->n[0];
            double *value = field_of(c, buffer, VALUE, slot) + j * g->pitch;
            double *slope = field_of(c, buffer, SLOPE, slot) + j * g->pitch;
            kernels->depth(z, from + first, c->plane, end - first, value + shift + first,
                           slope + shift + first);
            unclamp(c->layout[0], slot == 0, g->cells[0], part, value + ROW_ROOM);
            unclamp(c->layout[0], slot == 0, g->cells[0], part, slope + ROW_ROOM);
        }
        for (int f = PULL_VALUE; f < FIELDS; f++)
            memset(field_of(c, buffer, (enum field)f, slot) + part->row * g->pitch, 0,
                   (part->row_end - part->row) * g->pitch * sizeof *buffer);
    }
}

struct point_plane general_plane(const struct consistent *c, const struct family *family, bool apart,
                                 double *buffer)
{
    const struct general *g = c->general;
    struct point_plane plane = {.flat = c->dimension == 2,
                                .knots = family->at[0] == AT_KNOTS,
                                .cells = g->cells[0],
                                .pitch = g->pitch,
                                .scale = (double)g->cells[0] / (c->layout[0]->high - c->layout[0]->low),
                                .scratch = scratch_of(c, buffer)};
    for (int odd = 0; odd < 2; odd++)
        plane.y[odd] = g->taps[1][odd][family->at[1]];
    for (int slot = 0; slot < 3; slot++) {
        plane.value[slot] = field_of(c, buffer, VALUE, slot);
        plane.slope[slot] = field_of(c, buffer, SLOPE, slot);
        plane.pull_value[slot] = field_of(c, buffer, PULL_VALUE, slot);
        plane.pull_slope[slot] = field_of(c, buffer, PULL_SLOPE, slot);
        plane.pull_across[slot] = apart ? field_of(c, buffer, PULL_ACROSS, slot) : NULL;
    }
    return plane;
}

/* All rows of points of a family in a plane. */
static void rows_of(const struct consistent *c, const struct family *family, size_t m, const double *extra,
                    double *buffer)
{
    const struct point_kernels *kernels = taken_point_kernels();
    const struct point_plane plane = general_plane(c, family, extra != NULL, buffer);
    const struct taps *z = taps_at(c, DEPTH, false, family->at[DEPTH], m);
    for (size_t j = 0; j < family->n[1]; j++) {
        if (!general_row_is_loud(c, taps_at(c, 1, false, family->at[1], j), z)) continue;
        const size_t row = m * family->n[1] + j, from = row * family->n[0];
        const size_t run = family->runs > 0 ? family->first_run[row] : 0;
        const size_t runs = family->runs > 0 ? family->first_run[row + 1] - run : 0;
        struct hill_row hill;
        const bool tilted = general_hill_row(c, family, j, m, &hill);
        if (extra == NULL && !tilted) {
            kernels->row(&plane, j, family->lambda + from, family->mu + from, family->run + run, runs,
                         family->stiffness);
            continue;
        }
        kernels->slopes(&plane, j, 0, family->n[0]);
        if (extra != NULL) general_layers_add(c, &plane, family, j, m, 0, family->n[0], extra);
        if (tilted) kernels->tilt(&plane, &hill, 0, family->n[0]);
        kernels->pulls(&plane, j, 0, family->n[0], family->lambda + from, family->mu + from,
                       family->run + run, runs, family->stiffness, tilted);
    }
}

/* Takes the pulls of a plane off the forces of planes from .. end - 1; `apart`: as general_plane(). */
static void write_pulls(const struct consistent *c, enum at at, size_t m, size_t from, size_t end, bool apart,
                        double *buffer, double *force)
{
    const struct general *g = c->general;
    const struct part whole = general_whole(c);
    const struct point_kernels *kernels = taken_point_kernels();
    const size_t shift = ROW_ROOM + (c->layout[0]->mirror[0] ? 1 : 0);
    for (int axis = 0; axis < c->dimension; axis++) {
        const int slot = c->slot[axis];
        const struct taps *z = taps_at(c, DEPTH, slot == DEPTH, at, m);
        for (size_t j = 0; j < c->n[1]; j++) {
            double *pull[FIELDS] = {NULL};
            for (int f = PULL_VALUE; f <= (apart ? PULL_ACROSS : PULL_SLOPE); f++) {
                pull[f] = field_of(c, buffer, (enum field)f, slot) + j * g->pitch;
                clamp(c->layout[0], slot == 0, g->cells[0], &whole, pull[f] + ROW_ROOM);
                pull[f] += shift;
            }
            const double *const along[3] = {pull[PULL_VALUE], apart ? pull[PULL_ACROSS] : NULL,
                                            pull[PULL_SLOPE]};
            for (size_t d = 0; apart && d < z->count; d++)
                if (z->first + d >= from && z->first + d < end)
                    general_layers_keep(c, (size_t)axis, j, z->first + d, z->value[d], z->slope[d], along);
            if (apart) kernels->add(c->n[0], 1, pull[PULL_ACROSS], 0, pull[PULL_ACROSS], pull[PULL_VALUE]);
            for (size_t d = 0; d < z->count; d++) {
                const size_t k = z->first + d;
                if (k < from || k >= end) continue;
                kernels->add(c->n[0], -z->value[d], pull[PULL_VALUE], -z->slope[d], pull[PULL_SLOPE],
                             force + (size_t)axis * c->volume + k * c->plane + j * c->n[0]);
            }
        }
    }
}

bool general_plane_counts(const struct consistent *c, enum at at, size_t m, size_t from, size_t end)
{
    bool reaches = false, loud = false;
    for (int odd = 0; odd < 2; odd++) {
        const struct taps *z = taps_at(c, DEPTH, odd, at, m);
        reaches = reaches || (z->first < end && z->first + z->count > from);
        for (size_t i = z->first * c->n[1]; i < (z->first + z->count) * c->n[1]; i++)
            loud = loud || c->general->loud[i];
    }
    return reaches && loud;
}

/* Forces of planes from .. end - 1. */
static void make_planes(const struct consistent *c, int thread, size_t from, size_t end, const double *u,
                        const double *extra, double *force)
{
    const struct part whole = general_whole(c);
    const struct general *g = c->general;
    double *buffer = g->buffer[thread];
    for (int axis = 0; axis < c->dimension; axis++)
        memset(force + (size_t)axis * c->volume + from * c->plane, 0,
               (end - from) * c->plane * sizeof *force);
    if (extra != NULL) general_layers_forget(c, from, end);
    for (size_t m = 0; m <= g->cells[DEPTH]; m++)
        for (int at = AT_KNOTS; at <= AT_MIDDLES; at++) {
            if (m == g->cells[DEPTH] && at == AT_MIDDLES) continue;
            if (!general_plane_counts(c, (enum at)at, m, from, end)) continue;
            general_read(c, (enum at)at, m, &whole, u, buffer);
            for (int f = 0; f < 3; f++)
                if (g->family[f].at[DEPTH] == (enum at)at) rows_of(c, &g->family[f], m, extra, buffer);
            write_pulls(c, (enum at)at, m, from, end, extra != NULL, buffer, force);
        }
    general_edges(c, u, from, end, force);
}

void general_look(struct consistent *c, const double *u)
{
    struct general *g = c->general;
    const struct passes *passes = taken_passes();
    const size_t rows = c->n[1] * c->n[2];
    double *most = g->work, largest = 0;
#pragma omp parallel for num_threads(c->threads) schedule(static) reduction(max : largest)
    for (size_t row = 0; row < rows; row++) {
        most[row] = 0;
        for (int axis = 0; axis < c->dimension; axis++) {
            const double size =
                passes->largest_size_double(u + (size_t)axis * c->volume + row * c->n[0], c->n[0]);
            most[row] = size > most[row] || size != size ? size : most[row];
        }
        largest = most[row] > largest ? most[row] : largest;
    }
    largest = part_largest(c, largest);
    for (size_t row = 0; row < rows; row++)
        g->loud[row] = !(most[row] <= c->options.quiet * largest);
}

void general_forces(struct consistent *c, const double *u, const double *extra, double *force)
{
    c->general->made = false;
    general_look(c, u);
    const size_t block = (c->n[DEPTH] + (size_t)c->threads - 1) / (size_t)c->threads;
#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (int thread = 0; thread < c->threads; thread++) {
        const size_t from = (size_t)thread * block, next = from + block;
        const size_t end = next < c->n[DEPTH] ? next : c->n[DEPTH];
        if (from < end) make_planes(c, omp_get_thread_num(), from, end, u, extra, force);
    }
}
