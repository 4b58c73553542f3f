/* Averages of the ground about the points of the general operator: Backus's quantities with kernels of zero
 * second moment (doc/theory/general-ground.md, section 4). Along depth between the places where the rock jumps, so
 * exact for layers; along the axes of the surface, where the ground varies along them, over columns of a
 * fraction of the spacing. */
#include "method/consistent/general/piece.h"

#include "base/memory.h"
#include "scene/grading.h"
#include "scene/topography.h"

#include <math.h>
#include <omp.h>
#include <stdlib.h>
#include <string.h>

enum {
    MOST_COLUMNS = 8, /* a cell; even, so that cells' middles lie between two */
    BEYOND = 3,       /* cells of columns on either side of the body */
};
static const double least_part = .3;

struct columns {
    size_t count, points, a_cell;
    size_t lines; /* of a column: more than one where a model's values lie closer than columns */
    double from, step, spacing; /* place of column n: from + n step */
    bool varies;
    double weight[2][MOST_COLUMNS * PIECES / 2]; /* [at] of the columns about a point */
};

struct medium {
    const struct consistent *c;
    struct columns along[2]; /* by slot */
    double *drop;            /* [columns] of the surface above them, where it is not level; NULL: it is */
    struct piece *column, *row[2]; /* [threads * columns along x]; [at][points along x, columns along y] */
    struct piece *ring[3];         /* by family: [RING][points of a plane] */
    struct averaged *point;
    ptrdiff_t next; /* the piece that none has been made of; number 0 begins at face z- */
    bool part;      /* of damped ground */
    double *jump;   /* [threads * room] */
    size_t room, bytes;
};

static int ascending(const void *one, const void *other)
{
    const double a = *(const double *)one, b = *(const double *)other;
    return (a > b) - (a < b);
}

/* Vertical coordinate of a place of the lattice in a column below a surface so far below the plane, and the other
 * way. */
static double real(const struct medium *medium, double drop, double lattice)
{
    const struct body *body = &medium->c->model.scene->body;
    const double level = grading_real(body->grading, lattice);
    return medium->drop == NULL ? level : topography_real(body->topography, drop, level);
}

static double lattice(const struct medium *medium, double drop, double real)
{
    const struct body *body = &medium->c->model.scene->body;
    if (medium->drop != NULL) real = topography_lattice(body->topography, drop, real);
    return grading_lattice(body->grading, real);
}

static size_t find_jumps(const struct medium *medium, const double place[3], double drop, double from,
                         double to, double *jump)
{
    const struct scene *scene = medium->c->model.scene;
    const size_t count = ground_jumps(scene, place, scene->dimension - 1, real(medium, drop, from),
                                      real(medium, drop, to), jump);
    for (size_t i = 0; i < count; i++)
        jump[i] = lattice(medium, drop, jump[i]);
    return count;
}

static double depth_spacing(const struct medium *medium)
{
    const struct spline *spline = medium->c->layout[DEPTH];
    return (spline->high - spline->low) / (double)spline->cells;
}

/* One sample of a piece, `height` cells over its middle. */
static void sample_at(const struct medium *medium, const double place[3], double height, double part,
                      struct piece *sum)
{
    const struct scene *scene = medium->c->model.scene;
    const struct rock rock = ground_at(scene, place);
    struct shares shares;
    if (medium->part) shares = ground_shares_at(scene, place);
    piece_sample(&rock, medium->part ? &shares : NULL, height, part, sum);
}

/* One piece of a column whose place is `place`. */
static void average_piece(const struct medium *medium, double place[3], double drop, ptrdiff_t number,
                          double *jump, struct piece *sum)
{
    const struct scene *scene = medium->c->model.scene;
    const int axis = medium->c->dimension - 1;
    const double h = depth_spacing(medium), low = medium->c->layout[DEPTH]->low;
    const double from = low + (double)number * h / 2, to = low + (double)(number + 1) * h / 2;
    const double middle = (from + to) / 2;
    size_t count = find_jumps(medium, place, drop, from, to, jump);
    *sum = (struct piece){.even = count == 0 && !ground_grades(scene)};
    for (int n = 0; n < POSITIVE; n++)
        sum->least[n] = INFINITY;
    if (sum->even) {
        place[axis] = real(medium, drop, middle);
        sample_at(medium, place, 0, 1, sum);
        return;
    }
    jump[count++] = from;
    jump[count++] = to;
    qsort(jump, count, sizeof *jump, ascending);
    for (size_t part = 0; part + 1 < count; part++) {
        const double length = jump[part + 1] - jump[part];
        for (int side = -1; side <= 1 && length > 0; side += 2) { /* Gauss, two points */
            const double sample = (jump[part] + jump[part + 1]) / 2 + side * length / (2 * sqrt(3));
            place[axis] = real(medium, drop, sample);
            sample_at(medium, place, (sample - middle) / h, length / h, sum);
        }
    }
}

static ptrdiff_t pieces_of(const struct medium *medium)
{
    return 2 * (ptrdiff_t)medium->c->layout[DEPTH]->cells;
}

/* Place of a column's line from its middle. */
static double line_place(const struct columns *columns, size_t line)
{
    return (((double)line + .5) / (double)columns->lines - .5) * columns->step;
}

/* Mean of a column over its lines; above and below the lattice the mirror image, so that averages add up to what there
 * is of the rock. */
static void average_column(const struct medium *medium, const double place[3], double drop, ptrdiff_t number,
                           double *jump, struct piece *sum)
{
    const struct columns *x = &medium->along[0], *y = &medium->along[1];
    const size_t lines = x->lines * y->lines;
    const double share = 1. / (double)lines;
    const ptrdiff_t pieces = pieces_of(medium), within = number < 0         ? -1 - number
                                                         : number >= pieces ? 2 * pieces - 1 - number
                                                                            : number;
    for (size_t j = 0, n = 0; j < y->lines; j++)
        for (size_t i = 0; i < x->lines; i++, n++) {
            double there[3] = {place[0] + line_place(x, i), place[1] + line_place(y, j), 0};
            struct piece one = {.level = 0};
            struct piece *found = lines > 1 ? &one : sum;
            average_piece(medium, there, drop, within, jump, found);
            if (within != number) piece_turn(found);
            if (lines == 1) return;
            if (n == 0) {
                *sum = (struct piece){.level = 0};
                memcpy(sum->least, one.least, sizeof sum->least);
            }
            piece_add(&one, share, share, share, sum);
        }
}

/* Averages along a slot of the surface about point i from columns `stride` apart. */
static void average_along(const struct medium *medium, int slot, enum at at, size_t i,
                          const struct piece *column, size_t stride, struct piece *sum)
{
    const struct columns *columns = &medium->along[slot];
    if (!columns->varies) {
        *sum = *column;
        return;
    }
    const size_t width = columns->a_cell * PIECES / 2;
    const size_t first =
        (i + BEYOND) * columns->a_cell + (at == AT_MIDDLES ? columns->a_cell / 2 : 0) - width / 2;
    const struct piece *from = column + first * stride;
    *sum = *from;
    if (from[(width - 1) * stride].alike + 1 >= width) return;
    *sum = (struct piece){.level = 0};
    memcpy(sum->least, from->least, sizeof sum->least);
    for (size_t n = 0; n < width; n++) {
        const struct piece *one = from + n * stride;
        const double even = 1. / (double)width;
        const bool within = 2 * n >= width - columns->a_cell && 2 * n < width + columns->a_cell;
        piece_add(one, columns->weight[at][n], even, within ? 1. / (double)columns->a_cell : 0, sum);
        sum->rise[slot] += (n < width / 2 ? -2 : 2) * even * one->level;
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
    columns->count = columns->lines = 1;
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
    const struct body *body = &c->model.scene->body;
    if (body->model != NULL && body->line == NULL)
        columns->lines = (size_t)fmax(1, ceil(columns->step / body->model->detail[slot] - 1e-6));
    columns->from += columns->step / 2 - BEYOND * columns->spacing;
    for (size_t n = 0; n < columns->a_cell * PIECES / 2; n++)
        for (int at = AT_KNOTS; at <= AT_MIDDLES; at++)
            columns->weight[at][n] =
                piece_kernel((enum at)at, ((double)n + .5) / (double)columns->a_cell - reach_of_kernel) /
                (double)columns->a_cell;
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

static void *held(struct medium *medium, size_t count, size_t size)
{
    medium->bytes += count * size;
    return array_new(count, size);
}

static bool lay_drops(struct medium *medium)
{
    const struct consistent *c = medium->c;
    const struct columns *x = &medium->along[0], *y = &medium->along[1];
    if (c->surface == NULL) return true;
    medium->drop = held(medium, x->count * y->count, sizeof *medium->drop);
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
    medium->room = ground_jumps_at_most(c->model.scene) + 2;
    medium->next = 2 * (ptrdiff_t)c->general->first - PIECES / 2;
    medium->column = held(medium, (size_t)c->threads * along[0].count, sizeof *medium->column);
    for (int at = AT_KNOTS; at <= AT_MIDDLES; at++)
        medium->row[at] = held(medium, along[0].points * along[1].count, sizeof **medium->row);
    medium->point = held(medium, along[0].points * along[1].points, sizeof *medium->point);
    medium->jump = held(medium, (size_t)c->threads * medium->room, sizeof *medium->jump);
    bool good = medium->column != NULL && medium->row[0] != NULL && medium->row[1] != NULL &&
                medium->point != NULL && medium->jump != NULL;
    for (int f = 0; f < 3 && good; f++) {
        medium->ring[f] = held(medium, RING * along[0].points * along[1].points, sizeof **medium->ring);
        good = medium->ring[f] != NULL;
    }
    if (good && lay_drops(medium)) return medium;
    medium_free(medium);
    return NULL;
}

void medium_free(struct medium *medium)
{
    if (medium == NULL) return;
    array_free(medium->drop);
    array_free(medium->column);
    for (int at = AT_KNOTS; at <= AT_MIDDLES; at++)
        array_free(medium->row[at]);
    for (int f = 0; f < 3; f++)
        array_free(medium->ring[f]);
    array_free(medium->point);
    array_free(medium->jump);
    array_free(medium);
}

size_t medium_bytes(const struct medium *medium)
{
    return medium->bytes;
}

/* The next piece of all columns, and its averages along the surface about the points of each family. */
static void advance(struct medium *medium)
{
    const struct consistent *c = medium->c;
    const struct columns *x = &medium->along[0], *y = &medium->along[1];
    const size_t plane = x->points * y->points;
    const ptrdiff_t number = medium->next++;
#pragma omp parallel for num_threads(c->threads) schedule(dynamic)
    for (size_t j = 0; j < y->count; j++) {
        const size_t thread = (size_t)omp_get_thread_num();
        struct piece *column = medium->column + thread * x->count;
        double place[3] = {0};
        for (size_t i = 0; i < x->count; i++) {
            place[0] = column_place(medium, 0, i);
            if (c->dimension == 3) place[1] = column_place(medium, 1, j);
            const double drop = medium->drop != NULL ? medium->drop[j * x->count + i] : 0;
            average_column(medium, place, drop, number, medium->jump + thread * medium->room, &column[i]);
            piece_follow(i > 0 ? &column[i - 1] : NULL, &column[i]);
        }
        for (int at = AT_KNOTS; at <= AT_MIDDLES; at++)
            for (size_t i = 0; i < x->points - (at == AT_MIDDLES ? 1 : 0); i++)
                average_along(medium, 0, (enum at)at, i, column, 1, &medium->row[at][j * x->points + i]);
    }
#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (size_t i = 0; i < x->points; i++)
        for (int at = AT_KNOTS; at <= AT_MIDDLES; at++)
            for (size_t j = 0; j < y->count; j++) {
                struct piece *piece = &medium->row[at][j * x->points + i];
                piece_follow(j > 0 ? piece - x->points : NULL, piece);
            }
    for (int f = 0; f < 3; f++) {
        const struct family *family = &c->general->family[f];
        const struct piece *row = medium->row[family->at[0]];
        struct piece *point = medium->ring[f] + plane * (size_t)((number + RING) % RING);
        const struct piece *before = medium->ring[f] + plane * (size_t)((number - 1 + RING) % RING);
#pragma omp parallel for num_threads(c->threads) schedule(dynamic)
        for (size_t j = 0; j < family->n[1]; j++)
            for (size_t i = 0; i < family->n[0]; i++) {
                const size_t at = j * x->points + i;
                average_along(medium, 1, family->at[1], j, &row[i], x->points, &point[at]);
                piece_follow(&before[at], &point[at]);
            }
    }
}

void medium_plane(struct medium *medium, int f, size_t k)
{
    const struct consistent *c = medium->c;
    const struct family *family = &c->general->family[f];
    const enum at at = family->at[DEPTH];
    const size_t points = medium->along[0].points, plane = points * medium->along[1].points;
    const ptrdiff_t first = 2 * (ptrdiff_t)(c->general->first + k) + (at == AT_MIDDLES) - PIECES / 2;
    while (medium->next < first + PIECES)
        advance(medium);
#pragma omp parallel for num_threads(c->threads) schedule(dynamic)
    for (size_t j = 0; j < family->n[1]; j++)
        for (size_t i = 0; i < family->n[0]; i++)
            piece_average(medium->ring[f] + j * points + i, plane, at, first, pieces_of(medium),
                          &medium->point[j * points + i]);
}

void medium_point(const struct medium *medium, size_t i, size_t j, const struct metric *metric,
                  struct averaged *averaged)
{
    *averaged = medium->point[j * medium->along[0].points + i];
    if (medium->c->model.scene->body.grading != NULL) /* from rises a cell */
        averaged->rise[DEPTH] *= medium->along[0].spacing / depth_spacing(medium);
    metric_tilt(metric, averaged->rise);
    for (int n = 0; n < POSITIVE; n++)
        averaged->mean[n] = fmax(averaged->mean[n], least_part * averaged->least[n]);
}
