/* Rows of weights of total-Lagrangian SPH, each kept once: points whose neighbours stand at the same
 * distances in memory with the same weights share one row, as nearly all points of a lattice do.
 *
 * Weights count as the same within TOLERANCE of the row's largest: on a lattice they differ by the rounding
 * of the positions, some 1e-13, and never do on scattered points. The loops over neighbours take two at a
 * time: rows are filled up with the point itself, which has no weight. */
#include "method/total_lagrangian/total_lagrangian.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

static const double TOLERANCE = 1e-11;

bool tl_near(double a, double b, double scale)
{
    return fabs(a - b) <= TOLERANCE * scale;
}

static bool set_entry_room(struct tl_rows *rows, size_t room)
{
    const size_t count = rows->start[rows->rows] + rows->open;
    rows->shift = array_resized(rows->shift, count, room, sizeof *rows->shift);
    rows->weight = array_resized(rows->weight, count * rows->width, room * rows->width, sizeof *rows->weight);
    rows->entry_room = room;
    return rows->shift != NULL && rows->weight != NULL;
}

static bool set_row_room(struct tl_rows *rows, size_t room)
{
    rows->start =
        array_resized(rows->start, rows->start != NULL ? rows->rows + 1 : 0, room + 1, sizeof *rows->start);
    rows->example = array_resized(rows->example, rows->rows, room, sizeof *rows->example);
    rows->row_room = room;
    return rows->start != NULL && rows->example != NULL;
}

bool tl_rows_begin(struct tl_rows *rows, int dimension, size_t points, size_t width)
{
    *rows = (struct tl_rows){.points = points, .width = width, .dimension = dimension};
    rows->of = array_new(points, sizeof *rows->of);
    return rows->of != NULL && set_row_room(rows, 256) && set_entry_room(rows, 4096);
}

void tl_rows_free(struct tl_rows *rows)
{
    array_free(rows->start);
    array_free(rows->shift);
    array_free(rows->weight);
    array_free(rows->of);
    array_free(rows->example);
    *rows = (struct tl_rows){0};
}

bool tl_rows_add(struct tl_rows *rows, size_t i, size_t j, const double *weight)
{
    const size_t place = rows->start[rows->rows] + rows->open;
    if (place == rows->entry_room && !set_entry_room(rows, 2 * place)) return false;
    rows->shift[place] = (int32_t)(rows->dimension * ((ptrdiff_t)j - (ptrdiff_t)i));
    memcpy(rows->weight + rows->width * place, weight, rows->width * sizeof *weight);
    rows->open++;
    return true;
}

/* The open row is that of point q; with `x`, its neighbours stand in the same directions too. */
static bool same_row(const struct tl_rows *rows, size_t i, size_t q, const double *x, double scale)
{
    const size_t own = rows->start[rows->rows], other = tl_first(rows, q);
    if (tl_last(rows, q) - other != rows->open) return false;
    if (memcmp(rows->shift + own, rows->shift + other, rows->open * sizeof *rows->shift) != 0) return false;
    double largest = 0;
    for (size_t k = 0; k < rows->width * rows->open; k++)
        largest = fmax(largest, fabs(rows->weight[rows->width * own + k]));
    for (size_t k = 0; k < rows->width * rows->open; k++)
        if (!tl_near(rows->weight[rows->width * own + k], rows->weight[rows->width * other + k], largest))
            return false;
    for (size_t k = 0; x != NULL && k < rows->open; k++)
        for (size_t c = 0; c < 3; c++) {
            const double of_i = x[3 * tl_neighbour(rows, i, own + k) + c] - x[3 * i + c];
            const double of_q = x[3 * tl_neighbour(rows, q, other + k) + c] - x[3 * q + c];
            if (!tl_near(of_i, of_q, scale)) return false;
        }
    return true;
}

bool tl_rows_close(struct tl_rows *rows, size_t i, const struct tl_like *like, const double *x, double scale)
{
    static const double nothing[4] = {0};
    if (rows->open % 2 == 1 && !tl_rows_add(rows, i, i, nothing)) return false;
    for (size_t k = 0; k < like->before; k++)
        if (same_row(rows, i, like->point[k], x, scale)) {
            rows->of[i] = rows->of[like->point[k]];
            rows->open = 0;
            return true;
        }
    if (rows->rows == rows->row_room && !set_row_room(rows, 2 * rows->rows)) return false;
    rows->of[i] = (uint32_t)rows->rows;
    rows->example[rows->rows++] = (uint32_t)i;
    rows->start[rows->rows] = rows->start[rows->rows - 1] + rows->open;
    rows->open = 0;
    return true;
}

bool tl_rows_end(struct tl_rows *rows)
{
    const size_t entries = rows->start[rows->rows];
    return set_row_room(rows, rows->rows) && set_entry_room(rows, entries);
}

size_t tl_rows_bytes(const struct tl_rows *rows)
{
    return rows->points * sizeof *rows->of + rows->row_room * (sizeof *rows->start + sizeof *rows->example) +
           rows->entry_room * (sizeof *rows->shift + rows->width * sizeof *rows->weight);
}

/* --- Who is like whom --- */

/* Points of a file share rows in their layers alone, so that a part of these has the rows of the whole. */
static bool same_layer(const struct tl_model *tl, size_t i, size_t j)
{
    const struct cloud *cloud = tl->cloud;
    const struct body *body = &tl->model.scene->body;
    return cloud->number == NULL || cloud_layer(cloud, body, cloud->position + 3 * i) ==
                                        cloud_layer(cloud, body, cloud->position + 3 * j);
}

/* Points before i that may share its row: its last neighbours along each axis of a lattice, or the point
 * before. Those of a lattice do, but for the places of ghosts in memory, if all faces across the axis are
 * `layers` or more away from both; they come first. */
void tl_likes(const struct tl_model *tl, size_t i, size_t layers, struct tl_like *like)
{
    const size_t *grid = tl->cloud->grid;
    size_t unsure[3], unsure_count = 0;
    *like = (struct tl_like){.inside = true};
    if (grid[0] == 0 || i >= tl->cloud->points) {
        like->inside = false;
        like->point[0] = i - 1;
        like->before =
            i > 0 && i != tl->cloud->points && same_layer(tl, tl_source(tl, i - 1), tl_source(tl, i));
        return;
    }
    for (size_t c = 0, stride = 1; c < (size_t)tl->cloud->dimension; stride *= grid[c++]) {
        const size_t k = (tl->cloud->first + i) / stride % grid[c];
        const bool between = k >= layers && k + layers < grid[c];
        like->inside = like->inside && between;
        if (k == 0) continue;
        if (between && k > layers)
            like->point[like->sure++] = i - stride;
        else
            unsure[unsure_count++] = i - stride;
    }
    like->before = like->sure;
    for (size_t k = 0; k < unsure_count; k++)
        like->point[like->before++] = unsure[k];
}

/* Ghosts in the row of q have their like at the same places from i. */
static bool same_ghosts(const struct tl_model *tl, const struct tl_rows *rows, size_t q, size_t i)
{
    const size_t n = tl->cloud->points;
    const double *x = tl->site_position;
    for (size_t k = tl_first(rows, q); k < tl_last(rows, q); k++) {
        const size_t of_q = tl_neighbour(rows, q, k), of_i = tl_neighbour(rows, i, k);
        if (of_q < n) continue;
        if (of_i < n || of_i >= tl->sites) return false;
        for (size_t c = 0; c < 3; c++)
            if (!tl_near(x[3 * of_q + c] - x[3 * q + c], x[3 * of_i + c] - x[3 * i + c],
                         100 * tl->cloud->spacing))
                return false;
    }
    return true;
}

/* Points about i are made of the same as those about q. */
static bool same_materials(const struct tl_model *tl, const struct tl_rows *rows, size_t q, size_t i)
{
    if (tl->model.scene->materials == 1) return true;
    if (tl->material[q] != tl->material[i]) return false;
    for (size_t k = tl_first(rows, q); k < tl_last(rows, q); k++)
        if (tl->material[tl_source(tl, tl_neighbour(rows, q, k))] !=
            tl->material[tl_source(tl, tl_neighbour(rows, i, k))])
            return false;
    return true;
}

bool tl_rows_share(const struct tl_model *tl, struct tl_rows *rows, size_t i, const struct tl_like *like,
                   bool of_materials)
{
    for (size_t k = 0; k < like->sure; k++) {
        const size_t q = like->point[k];
        if (!like->inside && !same_ghosts(tl, rows, q, i)) continue;
        if (of_materials && !same_materials(tl, rows, q, i)) continue;
        rows->of[i] = rows->of[q];
        return true;
    }
    return false;
}

double tl_neighbours(const struct tl_model *tl, struct tl_range range)
{
    const struct tl_rows *rows = &tl->gradient;
    double sum = 0;
    for (size_t i = range.from; i < range.end; i++) {
        const size_t first = tl_first(rows, i);
        size_t last = tl_last(rows, i);
        if (last > first && rows->shift[last - 1] == 0) last--; /* what fills up the row */
        sum += (double)(last - first);
    }
    return sum;
}
