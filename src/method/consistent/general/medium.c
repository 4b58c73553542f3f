/* Averages of the ground about the points of the general operator: Backus's quantities with kernels of zero
 * second moment (doc/theory/general-ground.md, section 4). Along depth between the places where the rock jumps, so
 * exact for layers; along the axes of the surface, where the ground varies along them, over columns of a
 * fraction of the spacing. */
#include "method/consistent/general/columns.h"

#include "base/memory.h"
#include "scene/grading.h"
#include "scene/topography.h"

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_sort.h>
#include <math.h>
#include <omp.h>
#include <string.h>

static const double least_part = .3;

struct medium {
    const struct consistent *c;
    struct columns along[2]; /* by slot */
    double *drop;            /* [columns] of the surface above them, where it is not level; NULL: it is */
    struct piece *column, *row[2]; /* [threads * columns along x]; [at][points along x, columns along y] */
    bool *even;            /* [threads * cells along x] all columns of the cell are of the same even rock */
    struct piece *ring[3]; /* by family: [RING][points of a plane] */
    struct averaged *point;
    ptrdiff_t next; /* the piece that none has been made of; number 0 begins at face z- */
    bool part;      /* of damped ground */
    double *jump;   /* [threads * room] */
    size_t room, bytes;
    gsl_eigen_symmv_workspace *eigen;
    gsl_vector *values;
    gsl_matrix *vectors;
};

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

/* One piece of a column whose place is `place`; jump NULL: it is even rock. */
static void average_piece(const struct medium *medium, double place[3], double drop, ptrdiff_t number,
                          double *jump, struct piece *sum)
{
    const struct scene *scene = medium->c->model.scene;
    const int axis = medium->c->dimension - 1;
    const double h = depth_spacing(medium), low = medium->c->layout[DEPTH]->low;
    const double from = low + (double)number * h / 2, to = low + (double)(number + 1) * h / 2;
    const double middle = (from + to) / 2;
    size_t count = jump == NULL ? 0 : find_jumps(medium, place, drop, from, to, jump);
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
    gsl_sort(jump, 1, count);
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

/* Above and below the lattice the mirror image, so that averages add up to what there is of the rock. */
static ptrdiff_t within_lattice(const struct medium *medium, ptrdiff_t number)
{
    const ptrdiff_t pieces = pieces_of(medium);
    return number < 0 ? -1 - number : number >= pieces ? 2 * pieces - 1 - number : number;
}

/* Mean of a column over its lines. */
static void average_column(const struct medium *medium, const size_t at[2], double drop, ptrdiff_t number,
                           double *jump, struct piece *sum)
{
    const struct columns *x = &medium->along[0], *y = &medium->along[1];
    const double place[2] = {columns_place(x, at[0]), columns_place(y, at[1])};
    const size_t lines = x->lines * y->lines;
    const double share = 1. / (double)lines;
    const ptrdiff_t within = within_lattice(medium, number);
    for (size_t j = 0, n = 0; j < y->lines; j++)
        for (size_t i = 0; i < x->lines; i++, n++) {
            double there[3] = {place[0] + columns_line(x, at[0], i), place[1] + columns_line(y, at[1], j), 0};
            struct piece one = {.even = false};
            struct piece *found = lines > 1 ? &one : sum;
            average_piece(medium, there, drop, within, jump, found);
            if (within != number) piece_turn(found);
            if (lines == 1) return;
            if (n == 0) {
                *sum = (struct piece){.even = false};
                memcpy(sum->least, one.least, sizeof sum->least);
            }
            piece_add(&one, share, share, sum);
            sum->slope[SLOPE_NONE] += share * one.slope[SLOPE_NONE];
        }
}

static double drop_at(const struct medium *medium, size_t i, size_t j)
{
    return medium->drop != NULL ? medium->drop[j * medium->along[0].count + i] : 0;
}

/* Are columns first .. end - 1 of row j sure to be of one rock in a piece? */
static bool is_even(const struct medium *medium, size_t first, size_t end, size_t j, ptrdiff_t number)
{
    const struct scene *scene = medium->c->model.scene;
    const struct columns *along = medium->along;
    const size_t ends[2][2] = {{first, end - 1}, {j, j}};
    const double h = depth_spacing(medium), top = medium->c->layout[DEPTH]->low + (double)number * h / 2;
    double low[3], high[3], drop[2] = {drop_at(medium, first, j), drop_at(medium, first, j)};
    for (int slot = 0; slot < 2; slot++) {
        const double place[2] = {columns_place(&along[slot], ends[slot][0]),
                                 columns_place(&along[slot], ends[slot][1])};
        low[slot] = fmin(place[0], place[1]) - along[slot].step;
        high[slot] = fmax(place[0], place[1]) + along[slot].step;
    }
    for (size_t i = first + 1; i < end; i++) {
        drop[0] = fmin(drop[0], drop_at(medium, i, j));
        drop[1] = fmax(drop[1], drop_at(medium, i, j));
    }
    low[scene->dimension - 1] = fmin(real(medium, drop[0], top), real(medium, drop[1], top));
    high[scene->dimension - 1] = fmax(real(medium, drop[0], top + h / 2), real(medium, drop[1], top + h / 2));
    return ground_is_even(scene, low, high);
}

/* A piece of columns first .. end - 1 of row j. *even: they are of one rock, and what is there is. */
static void fill_columns(const struct medium *medium, size_t first, size_t end, size_t j, ptrdiff_t number,
                         double *jump, struct piece *column, bool *even)
{
    const bool was = *even;
    *even = is_even(medium, first, end, j, within_lattice(medium, number));
    struct piece one;
    average_column(medium, (size_t[2]){first, j}, drop_at(medium, first, j), number, *even ? NULL : jump,
                   &one);
    piece_follow(&column[first], &one);
    const bool there = *even && was && one.alike > 0;
    if (!there) column[first] = one;
    piece_follow(first > 0 ? &column[first - 1] : NULL, &column[first]);
    for (size_t i = first + 1; i < end; i++) {
        if (*even && !there) column[i] = one;
        if (*even) {
            column[i].alike = column[i - 1].alike + 1;
            continue;
        }
        average_column(medium, (size_t[2]){i, j}, drop_at(medium, i, j), number, jump, &column[i]);
        piece_follow(&column[i - 1], &column[i]);
    }
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
        const double place[3] = {columns_place(x, n % x->count), columns_place(y, n / x->count), 0};
        medium->drop[n] = consistent_drop(c, place, NULL);
    }
    return medium->drop != NULL;
}

static size_t cells_of(const struct columns *along)
{
    return along->varies ? along->halves / 2 : 1;
}

struct medium *medium_new(const struct consistent *c)
{
    struct medium *medium = array_new(1, sizeof *medium);
    if (medium == NULL) return NULL;
    medium->c = c;
    medium->part = general_is_part(c->model.scene);
    const struct columns *along = medium->along;
    bool good = columns_lay(&medium->along[0], c, 0) && columns_lay(&medium->along[1], c, 1);
    medium->room = ground_jumps_at_most(c->model.scene) + 2;
    medium->next = 2 * (ptrdiff_t)c->general->first - PIECES / 2;
    medium->column = held(medium, (size_t)c->threads * along[0].count, sizeof *medium->column);
    for (int at = AT_KNOTS; at <= AT_MIDDLES; at++)
        medium->row[at] = held(medium, along[0].points * along[1].count, sizeof **medium->row);
    medium->point = held(medium, along[0].points * along[1].points, sizeof *medium->point);
    medium->even = held(medium, (size_t)c->threads * cells_of(&along[0]), sizeof *medium->even);
    medium->jump = held(medium, (size_t)c->threads * medium->room, sizeof *medium->jump);
    good = good && medium->column != NULL && medium->row[0] != NULL && medium->row[1] != NULL &&
           medium->point != NULL && medium->jump != NULL && medium->even != NULL;
    medium->eigen = gsl_eigen_symmv_alloc(3);
    medium->values = gsl_vector_alloc(3);
    medium->vectors = gsl_matrix_alloc(3, 3);
    good = good && medium->eigen != NULL && medium->values != NULL && medium->vectors != NULL;
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
    columns_free(&medium->along[0]);
    columns_free(&medium->along[1]);
    array_free(medium->drop);
    array_free(medium->column);
    array_free(medium->even);
    for (int at = AT_KNOTS; at <= AT_MIDDLES; at++)
        array_free(medium->row[at]);
    for (int f = 0; f < 3; f++)
        array_free(medium->ring[f]);
    array_free(medium->point);
    array_free(medium->jump);
    if (medium->eigen != NULL) gsl_eigen_symmv_free(medium->eigen);
    gsl_vector_free(medium->values);
    gsl_matrix_free(medium->vectors);
    array_free(medium);
}

size_t medium_bytes(const struct medium *medium)
{
    return medium->bytes + medium->along[0].bytes + medium->along[1].bytes;
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
        for (size_t cell = 0; cell < cells_of(x); cell++)
            fill_columns(medium, x->varies ? x->first[2 * cell] : 0, x->varies ? x->first[2 * cell + 2] : 1,
                         j, number, medium->jump + thread * medium->room, column,
                         &medium->even[thread * cells_of(x) + cell]);
        for (int at = AT_KNOTS; at <= AT_MIDDLES; at++)
            for (size_t i = 0; i < x->points - (at == AT_MIDDLES ? 1 : 0); i++)
                columns_average(x, (enum at)at, i, column, 1, &medium->row[at][j * x->points + i]);
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
                columns_average(y, family->at[1], j, &row[i], x->points, &point[at]);
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

/* The direction in which log M changes most (G10a). */
static void find_normal(const struct medium *medium, const struct metric *metric, struct averaged *averaged)
{
    static const double variance = reach_of_kernel * reach_of_kernel / 7; /* of the kernel, in cells */
    static const enum slope second[3][3] = {
        {SLOPE_00, SLOPE_01, SLOPE_02}, {SLOPE_01, SLOPE_11, SLOPE_12}, {SLOPE_02, SLOPE_12, SLOPE_22}};
    const double *slope = averaged->slope, flatter = medium->along[0].spacing / depth_spacing(medium);
    double sum[9] = {[8] = 1e-24}; /* along depth where there is none but rounding */
    for (int n = -1; n < 3; n++) {
        double change[3] = {slope[SLOPE_0], slope[SLOPE_1], slope[SLOPE_2]};
        for (int s = 0; s < 3 && n >= 0; s++)
            change[s] = sqrt(variance) * slope[second[n][s]];
        change[DEPTH] *= flatter;
        metric_tilt(metric, change);
        for (int s = 0; s < 9; s++)
            sum[s] += change[s / 3] * change[s % 3];
    }
    gsl_matrix_view tensor = gsl_matrix_view_array(sum, 3, 3);
    gsl_eigen_symmv(&tensor.matrix, medium->values, medium->vectors, medium->eigen);
    const size_t most = gsl_vector_max_index(medium->values);
    for (size_t s = 0; s < 3; s++)
        averaged->normal[s] = gsl_matrix_get(medium->vectors, s, most);
}

void medium_point(const struct medium *medium, size_t i, size_t j, const struct metric *metric,
                  struct averaged *averaged)
{
    *averaged = medium->point[j * medium->along[0].points + i];
    if (!averaged->even) find_normal(medium, metric, averaged);
    for (int n = 0; n < POSITIVE; n++)
        averaged->mean[n] = fmax(averaged->mean[n], least_part * averaged->least[n]);
}
