/* Averages of the ground about the points of the general operator: Backus's quantities with kernels of zero
 * second moment (doc/theory/general-ground.md, section 4). Along depth between the places where the rock jumps, so
 * exact for layers; along the axes of the surface, where the ground varies along them, over columns of a
 * fraction of the spacing. */
#include "method/consistent/general/medium.h"

#include "base/memory.h"
#include "scene/topography.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum {
    MOST_COLUMNS = 8, /* a cell; even, so that cells' middles lie between two */
    BEYOND = 3,       /* cells of columns on either side of the body */
    PIECES = 10       /* of half a cell, that the widest kernel reaches over */
};
static const double sharpening = 1. / 6, least_part = .3;
static const double reach_of_kernel = PIECES / 4.; /* cells, on either side */

struct columns {
    size_t count, points, a_cell;
    double from, step, spacing; /* place of column n: from + n step */
    bool varies;
};

struct medium {
    const struct consistent *c;
    struct columns along[2]; /* by slot */
    enum at at[3];
    double *drop; /* [columns] of the surface above them, where it is not level; NULL: it is */
    struct averaged *column, *row, *point;
    bool part;    /* of damped ground: by_bulk is wanted */
    double *jump; /* [threads * room] */
    size_t room;
};

static double hat(double t)
{
    return fmax(0, 1 - fabs(t));
}

static double at_knots(double t)
{
    return (1 + 2 * sharpening) * hat(t) - sharpening * (hat(t - 1) + hat(t + 1));
}

/* (G11): t in cells from the point. */
static double kernel(enum at at, double t)
{
    return at == AT_KNOTS ? at_knots(t) : (at_knots(t - .5) + at_knots(t + .5)) / 2;
}

static void quantities(const struct rock *rock, double value[AVERAGES])
{
    const double m = rock->lambda + 2 * rock->mu;
    value[MEAN_DENSITY] = rock->density;
    value[MEAN_SOFTNESS] = 1 / m;
    value[MEAN_SLIP] = 1 / rock->mu;
    value[MEAN_SHEAR] = rock->mu;
    value[MEAN_SPREAD] = rock->mu * (3 * rock->lambda + 2 * rock->mu) / m;
    value[MEAN_RATIO] = rock->lambda / m;
}

/* Their derivatives by e: those of lambda and M are kappa. */
static void by_bulk(const struct rock *rock, double value[AVERAGES])
{
    const double m = rock->lambda + 2 * rock->mu, kappa = rock->lambda + 2. / 3 * rock->mu;
    memset(value, 0, AVERAGES * sizeof *value);
    value[MEAN_SOFTNESS] = -kappa / (m * m);
    value[MEAN_SPREAD] = 4 * kappa * (rock->mu / m) * (rock->mu / m);
    value[MEAN_RATIO] = 2 * kappa * rock->mu / (m * m);
}

static void add_derivatives(const struct rock *rock, double weight, struct averaged *sum)
{
    double value[AVERAGES], derivative[AVERAGES];
    quantities(rock, value);
    by_bulk(rock, derivative);
    for (int n = 0; n < AVERAGES; n++)
        sum->by_bulk[n] += weight * derivative[n];
    for (int n = 0; n < POSITIVE; n++)
        if (value[n] <= sum->least[n]) sum->least_by_bulk[n] = derivative[n];
}

/* One sample of the rock, `t` cells from the point, for `part` of a cell. */
static void add_sample(const struct rock *rock, enum at at, double t, double part, struct averaged *sum)
{
    double value[AVERAGES];
    const double weight = part * kernel(at, t), logarithm = log(rock->lambda + 2 * rock->mu);
    quantities(rock, value);
    for (int n = 0; n < AVERAGES; n++)
        sum->mean[n] += weight * value[n];
    for (int n = 0; n < POSITIVE; n++)
        sum->least[n] = fmin(sum->least[n], value[n]);
    sum->level += part / (2 * reach_of_kernel) * logarithm;
    sum->rise[DEPTH] += (t > 0 ? part : -part) / reach_of_kernel * logarithm;
}

static int ascending(const void *one, const void *other)
{
    const double a = *(const double *)one, b = *(const double *)other;
    return (a > b) - (a < b);
}

/* Vertical coordinate of a place of the lattice in a column below a surface so far below the plane, and the other
 * way. */
static double real(const struct medium *medium, double drop, double lattice)
{
    return medium->drop == NULL ? lattice
                                : topography_real(medium->c->model.scene->body.topography, drop, lattice);
}

static size_t find_jumps(const struct medium *medium, const double place[3], double drop, double from,
                         double to, double *jump)
{
    const struct scene *scene = medium->c->model.scene;
    const size_t count = ground_jumps(scene, place, scene->dimension - 1, real(medium, drop, from),
                                      real(medium, drop, to), jump);
    for (size_t i = 0; i < count && medium->drop != NULL; i++)
        jump[i] = topography_lattice(scene->body.topography, drop, jump[i]);
    return count;
}

/* Averages over depth of one column about a point. place: of the column, by axis; middle: of the point. */
static void average_column(const struct medium *medium, double place[3], double drop, double middle,
                           double *jump, struct averaged *sum)
{
    const struct scene *scene = medium->c->model.scene;
    const struct spline *spline = medium->c->layout[DEPTH];
    const int axis = medium->c->dimension - 1;
    const double h = (spline->high - spline->low) / (double)spline->cells, reach = reach_of_kernel * h;
    const enum at at = medium->at[DEPTH];
    size_t count = find_jumps(medium, place, drop, middle - reach, middle + reach, jump);
    *sum = (struct averaged){.even = count == 0 && !ground_grades(scene)};
    for (int n = 0; n < POSITIVE; n++)
        sum->least[n] = INFINITY;
    if (sum->even) {
        place[axis] = real(medium, drop, middle);
        const struct rock rock = ground_at(scene, place);
        quantities(&rock, sum->mean);
        memcpy(sum->least, sum->mean, sizeof sum->least);
        sum->level = log(rock.lambda + 2 * rock.mu);
        if (medium->part) add_derivatives(&rock, 1, sum);
        return;
    }
    for (int piece = 0; piece <= PIECES; piece++)
        jump[count++] = middle - reach + piece * h / 2;
    qsort(jump, count, sizeof *jump, ascending);
    for (size_t piece = 0; piece + 1 < count; piece++) {
        const double length = jump[piece + 1] - jump[piece];
        for (int side = -1; side <= 1 && length > 0; side += 2) { /* Gauss, two points */
            const double sample = (jump[piece] + jump[piece + 1]) / 2 + side * length / (2 * sqrt(3));
            place[axis] = real(medium, drop, sample);
            const struct rock rock = ground_at(scene, place);
            add_sample(&rock, at, (sample - middle) / h, length / (2 * h), sum);
            if (medium->part)
                add_derivatives(&rock, length / (2 * h) * kernel(at, (sample - middle) / h), sum);
        }
    }
}

static bool alike(const struct averaged *one, const struct averaged *other)
{
    return one->even && other->even && one->mean[MEAN_DENSITY] == other->mean[MEAN_DENSITY] &&
           one->mean[MEAN_SHEAR] == other->mean[MEAN_SHEAR] &&
           one->mean[MEAN_SOFTNESS] == other->mean[MEAN_SOFTNESS];
}

/* Averages along a slot of the surface about point i from columns `stride` apart. */
static void average_along(const struct medium *medium, int slot, size_t i, const struct averaged *column,
                          size_t stride, struct averaged *sum)
{
    const struct columns *columns = &medium->along[slot];
    if (!columns->varies) {
        *sum = *column;
        return;
    }
    const enum at at = medium->at[slot];
    const size_t width = columns->a_cell * PIECES / 2;
    const size_t first =
        (i + BEYOND) * columns->a_cell + (at == AT_MIDDLES ? columns->a_cell / 2 : 0) - width / 2;
    const struct averaged *from = column + first * stride;
    bool same = true;
    for (size_t n = 1; n < width && same; n++)
        same = alike(from, from + n * stride);
    *sum = *from;
    if (same) return;
    *sum = (struct averaged){.level = 0};
    memcpy(sum->least, from->least, sizeof sum->least);
    memcpy(sum->least_by_bulk, from->least_by_bulk, sizeof sum->least_by_bulk);
    for (size_t n = 0; n < width; n++) {
        const struct averaged *one = from + n * stride;
        const double t = ((double)n + .5) / (double)columns->a_cell - reach_of_kernel,
                     weight = kernel(at, t) / (double)columns->a_cell;
        for (int q = 0; q < AVERAGES; q++)
            sum->mean[q] += weight * one->mean[q];
        for (int q = 0; q < POSITIVE && medium->part; q++)
            if (one->least[q] < sum->least[q]) sum->least_by_bulk[q] = one->least_by_bulk[q];
        for (int q = 0; q < POSITIVE; q++)
            sum->least[q] = fmin(sum->least[q], one->least[q]);
        for (int q = 0; q < AVERAGES && medium->part; q++)
            sum->by_bulk[q] += weight * one->by_bulk[q];
        const double even = 1. / (double)width;
        sum->level += even * one->level;
        for (int s = 0; s < 3; s++)
            sum->rise[s] += even * one->rise[s];
        sum->rise[slot] += (t > 0 ? 2 : -2) * even * one->level;
    }
}

/* Does ground that varies over depth vary along the lattice too? */
static bool bent(const struct scene *scene)
{
    return scene->body.topography != NULL && ground_varies(scene, scene->dimension - 1);
}

static void lay_columns(struct medium *medium, int slot)
{
    const struct consistent *c = medium->c;
    struct columns *columns = &medium->along[slot];
    const struct spline *spline = c->layout[slot];
    columns->points = spline == NULL ? 1 : spline->cells + 1;
    columns->varies = spline != NULL && (ground_varies(c->model.scene, slot) || bent(c->model.scene));
    columns->count = 1;
    if (spline == NULL) return;
    columns->spacing = (spline->high - spline->low) / (double)spline->cells;
    columns->from = spline->low;
    if (!columns->varies) return;
    const double detail = bent(c->model.scene) ? 0 : ground_detail(c->model.scene, slot);
    columns->a_cell = MOST_COLUMNS;
    if (detail * MOST_COLUMNS / 2 > columns->spacing)
        columns->a_cell = 2 * (size_t)ceil(columns->spacing / detail);
    columns->count = (spline->cells + 2 * BEYOND) * columns->a_cell;
    columns->step = columns->spacing / (double)columns->a_cell;
    columns->from += columns->step / 2 - BEYOND * columns->spacing;
}

/* Place of column n; beyond a symmetry plane its mirror image. */
static double column_place(const struct medium *medium, int slot, size_t n)
{
    const struct columns *columns = &medium->along[slot];
    const struct spline *spline = medium->c->layout[slot];
    const double place = columns->from + (double)n * columns->step;
    if (place < spline->low && spline->mirror[0]) return 2 * spline->low - place;
    if (place > spline->high && spline->mirror[1]) return 2 * spline->high - place;
    return place;
}

static bool lay_drops(struct medium *medium)
{
    const struct consistent *c = medium->c;
    const struct columns *x = &medium->along[0], *y = &medium->along[1];
    if (c->surface == NULL) return true;
    medium->drop = array_new(x->count * y->count, sizeof *medium->drop);
    for (size_t n = 0; medium->drop != NULL && n < x->count * y->count; n++) {
        const double place[3] = {column_place(medium, 0, n % x->count),
                                 c->dimension == 3 ? column_place(medium, 1, n / x->count) : 0, 0};
        medium->drop[n] = consistent_drop(c, place, NULL);
    }
    return medium->drop != NULL;
}

struct medium *medium_new(const struct consistent *c)
{
    struct medium *medium = array_new(1, sizeof *medium);
    if (medium == NULL) return NULL;
    medium->c = c;
    medium->part = general_is_part(c->model.scene);
    const struct columns *along = medium->along;
    lay_columns(medium, 0);
    lay_columns(medium, 1);
    medium->room = ground_jumps_at_most(c->model.scene) + PIECES + 1;
    medium->column = array_new(along[0].count * along[1].count, sizeof *medium->column);
    medium->row = array_new(along[0].points * along[1].count, sizeof *medium->row);
    medium->point = array_new(along[0].points * along[1].points, sizeof *medium->point);
    medium->jump = array_new((size_t)c->threads * medium->room, sizeof *medium->jump);
    if (!lay_drops(medium)) {
        medium_free(medium);
        return NULL;
    }
    if (medium->column != NULL && medium->row != NULL && medium->point != NULL && medium->jump != NULL)
        return medium;
    medium_free(medium);
    return NULL;
}

void medium_free(struct medium *medium)
{
    if (medium == NULL) return;
    array_free(medium->drop);
    array_free(medium->column);
    array_free(medium->row);
    array_free(medium->point);
    array_free(medium->jump);
    array_free(medium);
}

void medium_plane(struct medium *medium, const enum at at[3], size_t k)
{
    const struct consistent *c = medium->c;
    const struct columns *x = &medium->along[0], *y = &medium->along[1];
    const double middle = general_place(c, DEPTH, at[DEPTH], k);
    memcpy(medium->at, at, sizeof medium->at);
#pragma omp parallel for num_threads(c->threads) schedule(dynamic)
    for (size_t j = 0; j < y->count; j++) {
        double place[3] = {0};
        for (size_t i = 0; i < x->count; i++) {
            place[0] = column_place(medium, 0, i);
            if (c->dimension == 3) place[1] = column_place(medium, 1, j);
            const double drop = medium->drop != NULL ? medium->drop[j * x->count + i] : 0;
            average_column(medium, place, drop, middle,
                           medium->jump + (size_t)omp_get_thread_num() * medium->room,
                           &medium->column[j * x->count + i]);
        }
        for (size_t i = 0; i < x->points - (at[0] == AT_MIDDLES ? 1 : 0); i++)
            average_along(medium, 0, i, &medium->column[j * x->count], 1, &medium->row[j * x->points + i]);
    }
    const size_t rows = y->points - (c->dimension == 3 && at[1] == AT_MIDDLES ? 1 : 0);
#pragma omp parallel for num_threads(c->threads) schedule(dynamic)
    for (size_t j = 0; j < rows; j++)
        for (size_t i = 0; i < x->points - (at[0] == AT_MIDDLES ? 1 : 0); i++)
            average_along(medium, 1, j, &medium->row[i], x->points, &medium->point[j * x->points + i]);
}

void medium_point(const struct medium *medium, size_t i, size_t j, const struct metric *metric,
                  struct averaged *averaged)
{
    *averaged = medium->point[j * medium->along[0].points + i];
    metric_tilt(metric, averaged->rise);
    for (int n = 0; n < POSITIVE; n++) {
        if (averaged->mean[n] < least_part * averaged->least[n])
            averaged->by_bulk[n] = least_part * averaged->least_by_bulk[n];
        averaged->mean[n] = fmax(averaged->mean[n], least_part * averaged->least[n]);
    }
}
