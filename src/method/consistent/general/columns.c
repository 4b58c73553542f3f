/* Columns along an axis of the surface (see the header). Beyond the lattice averages take the mirror images of those in
 * it, so that they add up to what there is of the rock; where it rises to is told by the ground that goes on there. */
#include "method/consistent/general/columns.h"

#include "base/memory.h"
#include "scene/topography.h"

#include <gsl/gsl_sort.h>
#include <math.h>
#include <string.h>

enum {
    MOST_COLUMNS = 8, /* a cell; even, so that cells' middles lie between two */
    BEYOND = 3,       /* cells of columns on either side of the body */
    IMAGES = 3        /* of a place: itself and beyond both ends */
};

bool columns_bend(const struct scene *scene)
{
    return scene->body.topography != NULL && ground_varies(scene, scene->dimension - 1);
}

/* Where boxes end within the body, and parts of ellipsoids thinner than the spacing. */
static size_t find_ends(const struct columns *columns, const struct body *body, double *at)
{
    const int axis = columns->slot;
    const double film = GROUND_FILM * body->spacing, low = body->low[axis] + film,
                 high = body->high[axis] - film;
    size_t found = 0;
    for (size_t i = 0; i < body->blocks; i++) {
        const struct ground_block *block = &body->block[i];
        const int parts = block->shape == BLOCK_BOX ? 1 : MOST_COLUMNS;
        for (int n = 0; n <= parts && (parts == 1 || 2 * block->half[axis] < columns->spacing); n++) {
            const double end = block->centre[axis] + (2. * n / parts - 1) * block->half[axis];
            if (end > low && end < high) at[found++] = end;
        }
    }
    return found;
}

/* These and their mirror images, in even columns from the first, in order. */
static size_t find_cuts(const struct columns *columns, const struct body *body, double *at)
{
    static const double close = 1e-6;
    const double low = (double)(BEYOND * columns->a_cell),
                 high = low + (double)(columns->spline->cells * columns->a_cell);
    const size_t found = find_ends(columns, body, at);
    size_t kept = 0;
    for (size_t i = 0; i < found; i++) {
        at[i] = low + (at[i] - columns->spline->low) / columns->step;
        at[found + i] = 2 * low - at[i];
        at[2 * found + i] = 2 * high - at[i];
    }
    gsl_sort(at, 1, IMAGES * found);
    for (size_t i = 0; i < IMAGES * found; i++)
        if (fabs(at[i] - round(at[i])) > close && at[i] > 0 && (kept == 0 || at[i] - at[kept - 1] > close))
            at[kept++] = at[i];
    return kept;
}

static void cut(struct columns *columns, const double *at, size_t cuts)
{
    const size_t even = columns->halves * columns->a_cell / 2;
    columns->count = 0;
    for (size_t n = 0; n < even; n++) {
        double start = (double)n;
        if (n % (columns->a_cell / 2) == 0) columns->first[n / (columns->a_cell / 2)] = columns->count;
        for (bool last = false; !last; columns->count++) {
            last = cuts == 0 || *at > (double)(n + 1);
            const double end = last ? (double)(n + 1) : *at++;
            if (!last) cuts--;
            columns->middle[columns->count] = (start + end) / 2;
            columns->width[columns->count] = end - start;
            start = end;
        }
    }
    columns->first[columns->halves] = columns->count;
}

/* Absorbing layers end in ground that goes on. */
static void find_images(struct columns *columns, const struct consistent *c)
{
    const bool ends[2] = {c->layer[2 * columns->slot] == 0, c->layer[2 * columns->slot + 1] == 0};
    const double from = (double)(BEYOND * columns->a_cell), low = ends[0] ? from : -INFINITY,
                 high = ends[1] ? from + (double)(columns->spline->cells * columns->a_cell) : INFINITY;
    for (size_t n = 0; n < columns->count; n++) {
        double middle = columns->middle[n];
        while (middle < low || middle > high)
            middle = middle < low ? 2 * low - middle : 2 * high - middle;
        size_t image = columns->first[(size_t)(2 * middle / (double)columns->a_cell)];
        while (columns->middle[image] + columns->width[image] / 2 < middle)
            image++;
        columns->image[n] = image;
    }
}

/* How many columns kernels about a point reach over, from the first on. */
static size_t about(const struct columns *columns, enum at at, size_t i, size_t *first)
{
    const size_t half = 2 * (i + BEYOND) + (at == AT_MIDDLES) - PIECES / 2;
    *first = columns->first[half];
    return columns->first[half + PIECES] - *first;
}

static void weigh_about(struct columns *columns, enum at at, size_t i)
{
    size_t first;
    const size_t count = about(columns, at, i, &first);
    const double a_cell = (double)columns->a_cell, start = columns->middle[first] - columns->width[first] / 2;
    for (size_t n = 0; n < count; n++) {
        const double away = (columns->middle[first + n] - start) / a_cell - reach_of_kernel;
        const double width = columns->width[first + n] / a_cell;
        struct column_weight *weight = &columns->weight[at][i * columns->most + n];
        weight->average = piece_kernel(at, away) * width;
        piece_smooth(away - width / 2, away + width / 2, weight->smooth);
    }
}

static bool weigh(struct columns *columns)
{
    for (size_t half = 0; half + PIECES <= columns->halves; half++) {
        const size_t count = columns->first[half + PIECES] - columns->first[half];
        if (count > columns->most) columns->most = count;
    }
    for (int at = AT_KNOTS; at <= AT_MIDDLES; at++) {
        columns->weight[at] = array_new(columns->points * columns->most, sizeof *columns->weight[at]);
        if (columns->weight[at] == NULL) return false;
        for (size_t i = 0; i < columns->points - (at == AT_MIDDLES); i++)
            weigh_about(columns, (enum at)at, i);
    }
    columns->bytes += 2 * columns->points * columns->most * sizeof *columns->weight[0];
    return true;
}

static bool lay(struct columns *columns, const struct consistent *c)
{
    const struct body *body = &c->model.scene->body;
    double *at = array_new(IMAGES * (MOST_COLUMNS + 1) * body->blocks, sizeof *at);
    if (at == NULL) return false;
    columns->halves = 2 * (columns->spline->cells + 2 * BEYOND);
    const size_t cuts = find_cuts(columns, body, at), count = columns->halves * columns->a_cell / 2 + cuts;
    columns->middle = array_new(count, sizeof *columns->middle);
    columns->width = array_new(count, sizeof *columns->width);
    columns->image = array_new(count, sizeof *columns->image);
    columns->first = array_new(columns->halves + 1, sizeof *columns->first);
    columns->bytes = count * (2 * sizeof(double) + sizeof(size_t)) + columns->halves * sizeof(size_t);
    const bool good =
        columns->middle != NULL && columns->width != NULL && columns->image != NULL && columns->first != NULL;
    if (good) cut(columns, at, cuts);
    array_free(at);
    if (good) find_images(columns, c);
    return good && weigh(columns);
}

bool columns_lay(struct columns *columns, const struct consistent *c, int slot)
{
    const struct spline *spline = c->layout[slot];
    const struct scene *scene = c->model.scene;
    *columns = (struct columns){.spline = spline, .slot = slot, .points = 1, .count = 1, .lines = 1};
    if (spline == NULL) return true;
    columns->points = spline->cells + 1;
    columns->varies = ground_varies(scene, slot) || columns_bend(scene);
    columns->spacing = (spline->high - spline->low) / (double)spline->cells;
    columns->from = spline->low;
    if (!columns->varies) return true;
    const double detail = columns_bend(scene) ? 0 : ground_detail(scene, slot);
    columns->a_cell = MOST_COLUMNS;
    if (detail * MOST_COLUMNS / 2 > columns->spacing)
        columns->a_cell = 2 * (size_t)ceil(columns->spacing / detail);
    columns->step = columns->spacing / (double)columns->a_cell;
    const struct body *body = &scene->body;
    if (body->model != NULL && body->line == NULL)
        columns->lines = (size_t)fmax(1, ceil(columns->step / body->model->detail[slot] - 1e-6));
    columns->from += columns->step / 2 - BEYOND * columns->spacing;
    return lay(columns, c);
}

void columns_free(struct columns *columns)
{
    array_free(columns->middle);
    array_free(columns->width);
    array_free(columns->image);
    array_free(columns->first);
    for (int at = AT_KNOTS; at <= AT_MIDDLES; at++)
        array_free(columns->weight[at]);
}

double columns_place(const struct columns *columns, size_t n)
{
    const struct spline *spline = columns->spline;
    if (!columns->varies) return columns->from;
    const double place = columns->from + (columns->middle[n] - .5) * columns->step;
    if (place < spline->low && spline->mirror[0]) return 2 * spline->low - place;
    if (place > spline->high && spline->mirror[1]) return 2 * spline->high - place;
    return place;
}

double columns_line(const struct columns *columns, size_t n, size_t line)
{
    const double width = columns->varies ? columns->step * columns->width[n] : columns->step;
    return (((double)line + .5) / (double)columns->lines - .5) * width;
}

void columns_average(const struct columns *columns, enum at at, size_t i, const struct piece *column,
                     size_t stride, struct piece *sum)
{
    size_t first = 0;
    const size_t count = columns->varies ? about(columns, at, i, &first) : 1;
    *sum = column[first * stride];
    if (count == 1 || column[(first + count - 1) * stride].alike + 1 >= count) return;
    const double cell = (double)columns->a_cell, reach = cell * PIECES / 2,
                 middle = columns->middle[first] - columns->width[first] / 2 + reach / 2;
    const struct piece *from = column + columns->image[first] * stride;
    *sum = (struct piece){.even = false};
    memcpy(sum->least, from->least, sizeof sum->least);
    for (size_t n = first; n < first + count; n++) {
        const struct piece *there = column + n * stride;
        const struct column_weight *weight = &columns->weight[at][i * columns->most + n - first];
        const double within = fabs(columns->middle[n] - middle) < cell / 2;
        piece_add(column + columns->image[n] * stride, weight->average, within * columns->width[n] / cell,
                  sum);
        piece_slopes(there->slope, columns->slot, weight->smooth, sum->slope);
    }
}
