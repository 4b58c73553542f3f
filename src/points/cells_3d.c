/* Volumes of scattered points in a box: their Voronoi cells, convex polyhedra kept as lists of polygons and
 * clipped by the bisectors to the neighbours. The cells tile the box, so the volumes add up to the box's. */
#include "points/cells.h"

#include "points/neighbours.h"

#include <math.h>
#include <string.h>

enum { SIDES = 64, CORNERS = 48 };

struct side {
    size_t corners;
    double corner[CORNERS][3];
};

struct polyhedron {
    size_t sides;
    struct side side[SIDES];
};

static double dot(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross(const double a[3], const double b[3], double c[3])
{
    c[0] = a[1] * b[2] - a[2] * b[1];
    c[1] = a[2] * b[0] - a[0] * b[2];
    c[2] = a[0] * b[1] - a[1] * b[0];
}

static void put(struct side *side, const double corner[3])
{
    if (side->corners < CORNERS) memcpy(side->corner[side->corners++], corner, sizeof(double[3]));
}

/* Clips one polygon by p . normal <= level; its corners on the plane go into `rim`. Corners within
 * `tolerance` of the plane lie on it, so that all polygons that share one agree. */
static void clip_side(struct side *side, const double normal[3], double level, double tolerance,
                      struct side *rim)
{
    double over[CORNERS];
    bool cut = false;
    for (size_t k = 0; k < side->corners; k++) {
        over[k] = dot(side->corner[k], normal) - level;
        if (fabs(over[k]) <= tolerance) over[k] = 0;
        cut = cut || over[k] > 0;
    }
    if (!cut) return;
    struct side kept = {0};
    for (size_t k = 0; k < side->corners; k++) {
        const size_t next = (k + 1) % side->corners;
        const double *a = side->corner[k];
        const double *b = side->corner[next];
        if (over[k] <= 0) put(&kept, a);
        if (over[k] == 0) put(rim, a);
        if ((over[k] < 0 && over[next] > 0) || (over[k] > 0 && over[next] < 0)) {
            const double t = over[k] / (over[k] - over[next]);
            const double p[3] = {a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1]),
                                 a[2] + t * (b[2] - a[2])};
            put(&kept, p);
            put(rim, p);
        }
    }
    *side = kept;
}

/* Orders the corners of the new side around its middle, as seen against its outward normal. */
static void order_rim(struct side *rim, const double normal[3])
{
    double middle[3] = {0};
    double first[3];
    double second[3];
    double angle[CORNERS];
    for (size_t k = 0; k < rim->corners; k++)
        for (int c = 0; c < 3; c++)
            middle[c] += rim->corner[k][c] / (double)rim->corners;
    for (int c = 0; c < 3; c++)
        first[c] = rim->corner[0][c] - middle[c];
    cross(normal, first, second);
    const double length = sqrt(dot(normal, normal));
    for (size_t k = 0; k < rim->corners; k++) {
        double d[3];
        for (int c = 0; c < 3; c++)
            d[c] = rim->corner[k][c] - middle[c];
        angle[k] = atan2(dot(d, second) / length, dot(d, first));
    }
    for (size_t k = 1; k < rim->corners; k++)
        for (size_t l = k; l > 0 && angle[l] < angle[l - 1]; l--) {
            double corner[3];
            const double a = angle[l];
            angle[l] = angle[l - 1];
            angle[l - 1] = a;
            memcpy(corner, rim->corner[l], sizeof corner);
            memcpy(rim->corner[l], rim->corner[l - 1], sizeof corner);
            memcpy(rim->corner[l - 1], corner, sizeof corner);
        }
}

static void clip(struct polyhedron *cell, const double normal[3], double level)
{
    struct side rim = {0};
    size_t kept = 0;
    for (size_t s = 0; s < cell->sides; s++) {
        clip_side(&cell->side[s], normal, level, 1e-11 * level, &rim);
        if (cell->side[s].corners < 3) continue;
        if (kept != s) cell->side[kept] = cell->side[s];
        kept++;
    }
    cell->sides = kept;
    if (rim.corners < 3 || kept == SIDES) return;
    order_rim(&rim, normal);
    cell->side[cell->sides++] = rim;
}

/* A sixth of the sum over sides of the fan's triple products about the origin. */
static double volume(const struct polyhedron *cell)
{
    double sum = 0;
    for (size_t s = 0; s < cell->sides; s++)
        for (size_t k = 1; k + 1 < cell->side[s].corners; k++) {
            double c[3];
            cross(cell->side[s].corner[k], cell->side[s].corner[k + 1], c);
            sum += dot(cell->side[s].corner[0], c);
        }
    return sum / 6;
}

static double farthest(const struct polyhedron *cell)
{
    double distance = 0;
    for (size_t s = 0; s < cell->sides; s++)
        for (size_t k = 0; k < cell->side[s].corners; k++)
            distance = fmax(distance, dot(cell->side[s].corner[k], cell->side[s].corner[k]));
    return sqrt(distance);
}

/* The box about x, corners relative to x, outward orientation. */
static void box(struct polyhedron *cell, const struct body *body, const double x[3])
{
    cell->sides = 6;
    for (int s = 0; s < 6; s++) {
        const int axis = s / 2;
        const int u = (axis + 1) % 3;
        const int v = (axis + 2) % 3;
        const bool high = s % 2 == 1;
        struct side *side = &cell->side[s];
        side->corners = 4;
        for (int k = 0; k < 4; k++) {
            const bool u_high = k == 1 || k == 2;
            const bool v_high = k >= 2;
            double *p = side->corner[high ? k : 3 - k];
            p[axis] = (high ? body->high[axis] : body->low[axis]) - x[axis];
            p[u] = (u_high ? body->high[u] : body->low[u]) - x[u];
            p[v] = (v_high ? body->high[v] : body->low[v]) - x[v];
        }
    }
}

/* Clips by the bisector to point j if its distance lies in from <= r < to. */
static void clip_by(struct polyhedron *cell, const double *position, size_t i, size_t j, double from,
                    double to)
{
    double normal[3];
    if (i == j) return;
    for (size_t c = 0; c < 3; c++)
        normal[c] = position[3 * j + c] - position[3 * i + c];
    const double square = dot(normal, normal);
    if (square >= from * from && square < to * to) clip(cell, normal, 0.5 * square);
}

selas_status cells_3d(struct cloud *cloud, const struct body *body, struct messages *messages)
{
    const double close = 1.8 * body->spacing; /* most cells are done by the points within it */
    struct neighbours near = {0};
    const selas_status status =
        neighbours_find(&near, 3, cloud->points, cloud->position, cells_radius(body, 3), false, messages);
    if (status != SELAS_OK) {
        neighbours_free(&near);
        return status;
    }
#pragma omp parallel for schedule(dynamic, 16)
    for (size_t i = 0; i < cloud->points; i++) {
        struct polyhedron cell;
        box(&cell, body, cloud->position + 3 * i);
        for (size_t k = near.start[i]; k < near.start[i + 1]; k++)
            clip_by(&cell, cloud->position, i, near.index[k], 0, close);
        /* bisectors to points beyond twice the farthest corner pass the cell by */
        double reach = 2 * farthest(&cell);
        for (size_t k = near.start[i]; k < near.start[i + 1]; k++)
            clip_by(&cell, cloud->position, i, near.index[k], close, reach);
        reach = 2 * farthest(&cell);
        for (size_t j = 0; j < cloud->points && reach > near.radius; j++)
            clip_by(&cell, cloud->position, i, j, close, reach);
        cloud->volume[i] = volume(&cell);
    }
    neighbours_free(&near);
    return SELAS_OK;
}
