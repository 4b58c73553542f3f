/* Edges where two free faces meet: S3 lacks the products of (G3) there. They are added in the cells next to an
 * edge, with shares that fall from the faces inwards (doc/theory/general-ground.md, G3a): points of the families
 * take another weight, and where they have none there are points more. At any other corner of the body one point
 * sees what no other does. */
#include "method/consistent/general/general.h"

#include "base/memory.h"
#include "scene/grading.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

enum { WIDE = 2, CLEAR = 3 }; /* cells with a share, and between an edge's points and a layer */
enum { MOST = 9 * EDGE_ROW }; /* numbers of a component */
enum { LOOKED_AT = 256 };     /* points before one among which another that sees alike is sought */
static const double shares[WIDE] = {1, .5};

static int axis_of(const struct consistent *c, int slot)
{
    for (int axis = 0; axis < c->dimension; axis++)
        if (c->slot[axis] == slot) return axis;
    return -1;
}

static double share_at(long cell)
{
    return cell >= 0 && cell < WIDE ? shares[cell] : 0;
}

/* Is the end of an axis a free face? */
static bool is_free(const struct consistent *c, int slot, int high)
{
    const int face = 2 * axis_of(c, slot) + high;
    return !c->layout[slot]->mirror[high] && c->layer[face] == 0 &&
           boundary_is_free(&c->model.scene->boundary[face]);
}

/* Share of cell i of an axis: of its free faces, and of their images behind a symmetry plane. */
static double share_of(const struct consistent *c, int slot, long i)
{
    const struct spline *spline = c->layout[slot];
    const long cells = (long)spline->cells;
    double share = 0;
    if (i < 0 || i >= cells) return 0;
    for (int high = 0; high < 2; high++) {
        const long away = high ? cells - 1 - i : i, image = high ? cells + i : 2 * cells - 1 - i;
        if (!is_free(c, slot, high)) continue;
        share += share_at(away) + (spline->mirror[!high] ? share_at(image) : 0);
    }
    return fmin(share, 1);
}

/* Is cell i far enough from layers across the axis? */
static double clear_at(const struct consistent *c, int slot, long i)
{
    const long cells = (long)c->layout[slot]->cells;
    const size_t *layer = &c->layer[2 * axis_of(c, slot)];
    const long low = layer[0] > 0 ? (long)layer[0] + CLEAR : 0,
               high = layer[1] > 0 ? (long)layer[1] + CLEAR : 0;
    return i >= low && i < cells - high ? 1 : 0;
}

/* Is point i of an axis the knot at an end that is no symmetry plane? */
static bool is_end(const struct consistent *c, int slot, enum at at, size_t i)
{
    const struct spline *spline = c->layout[slot];
    if (spline == NULL || at != AT_KNOTS) return false;
    if (slot == DEPTH) i += c->general->first;
    return (i == 0 && !spline->mirror[0]) || (i == spline->cells && !spline->mirror[1]);
}

/* d of an axis with its shares, and the plain weights, in cells; of one point, 0 and 1, where there is no axis. */
static bool lay_line(const struct consistent *c, int slot, struct edge_line line[2])
{
    for (int at = AT_KNOTS; at <= AT_MIDDLES; at++) {
        const bool none = c->layout[slot] == NULL;
        const size_t n = none ? 1 : c->general->cells[slot] + (at == AT_KNOTS ? 1 : 0);
        line[at] = (struct edge_line){n, array_new(n, sizeof(double)), array_new(n, sizeof(double))};
        if (line[at].share == NULL || line[at].plain == NULL) return false;
        for (size_t i = 0; i < n; i++) {
            const long cell = (long)(i + (slot == DEPTH ? c->general->first : 0));
            if (none) {
                line[at].plain[i] = 1;
                continue;
            }
            double share[2], plain[2];
            for (int before = 0; before < 2; before++) {
                plain[before] = clear_at(c, slot, cell - before);
                share[before] = plain[before] * share_of(c, slot, cell - before);
            }
            line[at].share[i] = at == AT_KNOTS ? (share[0] + share[1]) / 6 : -share[0] / 3;
            line[at].plain[i] = at == AT_KNOTS ? (plain[0] + plain[1]) / 2 : plain[0];
        }
    }
    return true;
}

bool general_lay_edges(struct consistent *c)
{
    int free = 0, ends = 0;
    for (int axis = 0; axis < c->dimension; axis++) {
        const struct spline *spline = c->layout[c->slot[axis]];
        free += is_free(c, c->slot[axis], 0) || is_free(c, c->slot[axis], 1);
        ends += !spline->mirror[0] || !spline->mirror[1];
    }
    if (free < 2 && ends < 3) return true;
    struct edges *edges = c->general->edges = array_new(1, sizeof *edges);
    bool good = edges != NULL;
    for (int slot = 0; good && slot < 3; slot++)
        good = lay_line(c, slot, edges->line[slot]);
    return good;
}

static const double simpson = 1. / 216; /* its weight at a corner */

/* In cells: d_a d_b times the rule P + d, or T - 2 d, of the third axis, over the pairs, less 2 d_x d_y d_z. */
static double added_at(const struct consistent *c, const enum at at[3], const size_t place[3])
{
    const struct edges *edges = c->general->edges;
    double share[3], sum = 0;
    bool corner = true;
    for (int slot = 0; slot < 3; slot++) {
        share[slot] = edges->line[slot][at[slot]].share[place[slot]];
        corner = corner && is_end(c, slot, at[slot], place[slot]);
    }
    if (corner) return simpson;
    for (int third = 0; third < 3; third++) {
        const int a = (third + 1) % 3, b = (third + 2) % 3;
        const double pair = share[a] * share[b];
        if (pair == 0) continue;
        const bool middles = at[a] == AT_MIDDLES && at[b] == AT_MIDDLES;
        const double plain = edges->line[third][at[third]].plain[place[third]];
        const double own = at[third] == (middles ? AT_KNOTS : AT_MIDDLES) ? plain : 0;
        sum += pair * (own + (middles ? -2 : 1) * share[third]);
    }
    return sum - 2 * share[0] * share[1] * share[2];
}

double general_added(const struct consistent *c, const enum at at[3], const size_t place[3])
{
    if (c->general->edges == NULL) return 0;
    double weight = added_at(c, at, place);
    for (int slot = 0; weight != 0 && slot < 3; slot++)
        if (c->layout[slot] != NULL)
            weight *= (c->layout[slot]->high - c->layout[slot]->low) / (double)c->layout[slot]->cells;
    return weight;
}

/* Adds the moduli at a point of a family, without its weight, unless the window has it not. */
static void add_moduli(const struct consistent *c, const struct family *family, const size_t at[3],
                       double sum[3])
{
    for (int slot = 0; slot < 3; slot++)
        if (at[slot] >= family->n[slot]) return; /* below 0 too */
    const size_t point = (at[2] * family->n[1] + at[1]) * family->n[0] + at[0];
    const double weight = general_weight(c, family, at);
    sum[0] += family->lambda[point] / weight;
    sum[1] += family->mu[point] / weight;
    sum[2]++;
}

/* The means of the nearest points of the families. */
static void mean_moduli(const struct consistent *c, const enum at at[3], const size_t place[3],
                        double mean[2])
{
    double sum[3] = {0};
    int away[3], least = 3;
    for (int f = 0; f < 3; f++) {
        away[f] = 0;
        for (int slot = 0; slot < 3; slot++)
            away[f] += c->layout[slot] != NULL && at[slot] != c->general->family[f].at[slot];
        if (away[f] < least) least = away[f];
    }
    for (int f = 0; f < 3; f++)
        for (unsigned turn = 0; away[f] == least && turn < 8; turn++) {
            const struct family *family = &c->general->family[f];
            size_t near[3];
            bool other = true;
            for (int slot = 0; slot < 3; slot++) {
                const bool same = c->layout[slot] == NULL || at[slot] == family->at[slot];
                const size_t next = turn >> slot & 1U;
                near[slot] = place[slot] + next - (!same && at[slot] == AT_KNOTS);
                other = other && !(same && next > 0);
            }
            if (other) add_moduli(c, family, near, sum);
        }
    for (int i = 0; i < 2; i++)
        mean[i] = sum[2] > 0 ? sum[i] / sum[2] : 0;
}

/* Room for one point's numbers of a component behind those that are there. */
static bool make_room(struct edges *edges)
{
    if (edges->used + MOST <= edges->room) return true;
    edges->room = 2 * edges->room + MOST;
    edges->slope = array_resized(edges->slope, edges->used, edges->room, sizeof *edges->slope);
    return edges->slope != NULL;
}

/* Where the numbers behind those in use stand already, as those of one of the last points; else they are in use now. */
static size_t share_slopes(struct edges *edges, int component, size_t count)
{
    const double *slope = edges->slope + edges->used;
    const size_t last = edges->count - 1;
    for (size_t n = 1; n <= LOOKED_AT && n <= last; n++) {
        const struct edge_taps *of = &edges->point[last - n].of[component];
        if (of->planes * of->rows * EDGE_ROW == count &&
            memcmp(edges->slope + of->at, slope, count * sizeof *slope) == 0)
            return of->at;
    }
    edges->used += count;
    return edges->used - count;
}

/* What a component's control values are at a point, by slot of the component: slopes along the axes. */
static bool lay_taps(const struct consistent *c, const enum at at[3], const size_t place[3], int component,
                     const struct metric *metric, struct edges *edges, struct edge_taps *of)
{
    const double stretch =
        grading_stretch(c->model.scene->body.grading, general_place(c, DEPTH, at[DEPTH], place[DEPTH]));
    const struct taps *taps[3];
    for (int slot = 0; slot < 3; slot++)
        taps[slot] = &c->general->taps[slot][slot == component][at[slot]][place[slot]];
    const struct taps *x = taps[0], *y = taps[1], *z = taps[2];
    const size_t columns = c->n[0] < EDGE_LANES ? c->n[0] : EDGE_LANES, most = c->n[0] - columns,
                 column = x->first < most ? x->first : most;
    if (!make_room(edges)) return false;
    double *row = edges->slope + edges->used;
    for (size_t k = 0; k < z->count; k++)
        for (size_t j = 0; j < y->count; j++, row += EDGE_ROW) {
            memset(row, 0, EDGE_ROW * sizeof *row);
            for (size_t i = 0; i < x->count; i++) {
                double slope[3] = {x->slope[i] * y->value[j] * z->value[k],
                                   x->value[i] * y->slope[j] * z->value[k],
                                   x->value[i] * y->value[j] * z->slope[k] * stretch};
                metric_tilt(metric, slope);
                for (int slot = 0; slot < 3; slot++)
                    row[(size_t)slot * EDGE_LANES + x->first - column + i] = slope[slot];
            }
        }
    const size_t at_numbers = share_slopes(edges, component, z->count * y->count * EDGE_ROW);
    *of = (struct edge_taps){z->first, z->count, y->first, y->count, column, columns, at_numbers};
    return true;
}

static bool lay_point(const struct consistent *c, const enum at at[3], const size_t place[3], double added,
                      struct edges *edges, struct edge_point *point)
{
    const struct metric metric = general_metric_of(c, at, place);
    double mean[2];
    mean_moduli(c, at, place, mean);
    point->lambda = added * metric.jacobian * mean[0];
    point->mu = added * metric.jacobian * mean[1];
    point->plane = point->row = SIZE_MAX;
    for (int axis = 0; axis < c->dimension; axis++) {
        struct edge_taps *of = &point->of[c->slot[axis]];
        if (!lay_taps(c, at, place, c->slot[axis], &metric, edges, of)) return false;
        if (of->plane < point->plane) point->plane = of->plane;
        if (of->plane + of->planes > point->plane_end) point->plane_end = of->plane + of->planes;
        if (of->row < point->row) point->row = of->row;
        if (of->row + of->rows > point->row_end) point->row_end = of->row + of->rows;
    }
    return true;
}

/* Points of one kind over depth at m that are of no family and count: how many, or laid. SIZE_MAX: no memory. */
static size_t points_at(const struct consistent *c, enum at depth, size_t m, struct edges *edges, bool lay)
{
    size_t count = 0;
    for (unsigned kind = 0; kind < 4; kind++) {
        const enum at at[3] = {kind & 1U ? AT_KNOTS : AT_MIDDLES, kind & 2U ? AT_KNOTS : AT_MIDDLES, depth};
        const int knots = (at[0] == AT_KNOTS) + (at[1] == AT_KNOTS) + (at[2] == AT_KNOTS);
        if (knots == 1 || (c->layout[1] == NULL && (knots == 0 || at[1] == AT_KNOTS))) continue;
        const struct edge_line *x = &edges->line[0][at[0]], *y = &edges->line[1][at[1]];
        const bool deep = edges->line[2][depth].share[m] != 0 || is_end(c, DEPTH, depth, m);
        for (size_t j = 0; j < y->n; j++)
            for (size_t i = 0; (y->share[j] != 0 || deep) && i < x->n; i++) {
                const size_t place[3] = {i, j, m};
                const double added = general_added(c, at, place);
                if (added == 0) continue;
                count++;
                if (lay && !lay_point(c, at, place, added, edges, &edges->point[edges->count++]))
                    return SIZE_MAX;
            }
    }
    return count;
}

/* Does a point of either kind at m see plane k first? */
static bool begins_at(const struct consistent *c, enum at depth, size_t m, size_t k)
{
    const struct taps *even = &c->general->taps[DEPTH][0][depth][m],
                      *odd = &c->general->taps[DEPTH][1][depth][m];
    return (even->first < odd->first ? even->first : odd->first) == k;
}

bool general_lay_edge_points(struct consistent *c)
{
    struct edges *edges = c->general->edges;
    size_t points = 0;
    if (edges == NULL) return true;
    for (int at = AT_KNOTS; at <= AT_MIDDLES; at++)
        for (size_t m = 0; m < edges->line[DEPTH][at].n; m++)
            points += points_at(c, (enum at)at, m, edges, false);
    edges->start = array_new(c->n[DEPTH] + 1, sizeof *edges->start);
    edges->point = array_new(points, sizeof *edges->point);
    if (edges->start == NULL || edges->point == NULL) return false;
    for (size_t k = 0; k < c->n[DEPTH]; k++) {
        for (int at = AT_KNOTS; at <= AT_MIDDLES; at++)
            for (size_t m = k < 1 ? 0 : k - 1; m < edges->line[DEPTH][at].n && m <= k + 2; m++)
                if (begins_at(c, (enum at)at, m, k) && points_at(c, (enum at)at, m, edges, true) == SIZE_MAX)
                    return false;
        edges->start[k + 1] = edges->count;
        const size_t here = edges->count - edges->start[k];
        if (here > edges->most) edges->most = here;
    }
    c->general->bytes += (c->n[DEPTH] + 1) * sizeof *edges->start + points * sizeof *edges->point +
                         edges->room * sizeof *edges->slope;
    return edges->count == points;
}

void general_free_edges(struct consistent *c)
{
    struct edges *edges = c->general->edges;
    if (edges == NULL) return;
    for (int slot = 0; slot < 3; slot++)
        for (int at = AT_KNOTS; at <= AT_MIDDLES; at++) {
            array_free(edges->line[slot][at].share);
            array_free(edges->line[slot][at].plain);
        }
    array_free(edges->start);
    array_free(edges->point);
    array_free(edges->slope);
    array_free(edges);
}

void general_edge_stress(const struct edge_point *point, double slope[3][3], double stress[3][3])
{
    const double pressure = point->lambda * (slope[0][0] + slope[1][1] + slope[2][2]);
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            stress[i][j] += point->mu * (slope[i][j] + slope[j][i]) + (i == j ? pressure : 0);
}

static bool is_loud(const struct consistent *c, const struct edge_point *point)
{
    for (size_t k = point->plane; k < point->plane_end; k++)
        for (size_t j = point->row; j < point->row_end; j++)
            if (c->general->loud[k * c->n[1] + j]) return true;
    return false;
}

/* The first number of a row that a point sees of a component. */
static size_t place_of(const struct consistent *c, int axis, size_t k, const struct edge_taps *of, size_t row)
{
    return (size_t)axis * c->volume + k * c->plane + (of->row + row) * c->n[0] + of->column;
}

static void add_slopes(const struct consistent *c, int axis, const struct edge_taps *of, const double *u,
                       double slope[3])
{
    const double *row = c->general->edges->slope + of->at;
    for (size_t k = of->plane; k < of->plane + of->planes; k++)
        for (size_t j = 0; j < of->rows; j++, row += EDGE_ROW)
            for (size_t i = 0; i < of->columns; i++)
                for (int slot = 0; slot < 3; slot++)
                    slope[slot] += row[slot * EDGE_LANES + (int)i] * u[place_of(c, axis, k, of, j) + i];
}

/* What a component's stresses pull at in planes from .. end - 1. */
static void take_pulls(const struct consistent *c, int axis, const struct edge_taps *of, const double pull[3],
                       size_t from, size_t end, double *force)
{
    const double *row = c->general->edges->slope + of->at;
    for (size_t k = of->plane; k < of->plane + of->planes; k++)
        for (size_t j = 0; j < of->rows; j++, row += EDGE_ROW)
            for (size_t i = 0; k >= from && k < end && i < of->columns; i++)
                force[place_of(c, axis, k, of, j) + i] -=
                    row[i] * pull[0] + row[EDGE_LANES + i] * pull[1] + row[2 * EDGE_LANES + i] * pull[2];
}

void general_edges(const struct consistent *c, const double *u, size_t from, size_t end, double *force)
{
    const struct edges *edges = c->general->edges;
    if (edges == NULL) return;
    for (size_t n = edges->start[from < 2 ? 0 : from - 2]; n < edges->start[end]; n++) {
        const struct edge_point *point = &edges->point[n];
        double slope[3][3] = {{0}}, stress[3][3] = {{0}};
        if (!is_loud(c, point)) continue;
        for (int axis = 0; axis < c->dimension; axis++)
            add_slopes(c, axis, &point->of[c->slot[axis]], u, slope[c->slot[axis]]);
        general_edge_stress(point, slope, stress);
        for (int axis = 0; axis < c->dimension; axis++)
            take_pulls(c, axis, &point->of[c->slot[axis]], stress[c->slot[axis]], from, end, force);
    }
}
