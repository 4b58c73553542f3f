/* Volumes of scattered points: areas of the Voronoi cells, cut by the box and by the hole. They add up to the
 * body's area exactly because the cells tile the box: each cell is the box's rectangle clipped by the
 * bisectors to the neighbours, less its intersection with the disc (Green's theorem, edge by edge). (Moving
 * the points to the centroids of their cells by Lloyd's iteration was tried for plates: it spoils the order
 * of the rings, and the noise in the stress grows threefold.) */
#include "points/cloud.h"

#include "base/memory.h"
#include "points/cells.h"
#include "points/neighbours.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CORNERS = 64 };

struct polygon {
    size_t corners;
    double corner[CORNERS][2];
};

/* Keeps the part of the polygon where (p - middle) . normal <= 0 (Sutherland-Hodgman). */
static void clip(struct polygon *polygon, const double middle[2], const double normal[2])
{
    struct polygon kept = {0};
    for (size_t k = 0; k < polygon->corners; k++) {
        const double *a = polygon->corner[k];
        const double *b = polygon->corner[(k + 1) % polygon->corners];
        const double side_a = (a[0] - middle[0]) * normal[0] + (a[1] - middle[1]) * normal[1];
        const double side_b = (b[0] - middle[0]) * normal[0] + (b[1] - middle[1]) * normal[1];
        if (side_a <= 0 && kept.corners < CORNERS) memcpy(kept.corner[kept.corners++], a, sizeof(double[2]));
        if ((side_a < 0 && side_b > 0) || (side_a > 0 && side_b < 0)) {
            const double t = side_a / (side_a - side_b);
            if (kept.corners == CORNERS) continue;
            kept.corner[kept.corners][0] = a[0] + t * (b[0] - a[0]);
            kept.corner[kept.corners++][1] = a[1] + t * (b[1] - a[1]);
        }
    }
    *polygon = kept;
}

static double triangle(const double a[2], const double b[2])
{
    return 0.5 * (a[0] * b[1] - a[1] * b[0]);
}

/* Sector of radius r from direction a to direction b, signed, less than half a turn. */
static double sector(double r, const double a[2], const double b[2])
{
    return 0.5 * r * r * atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
}

/* Triangle (0, a, b) within the disc of radius r about 0: the piece of the edge inside the circle counts as a
 * triangle, those outside as sectors. */
static double in_disc(double r, const double a[2], const double b[2])
{
    const double d[2] = {b[0] - a[0], b[1] - a[1]};
    const double qa = d[0] * d[0] + d[1] * d[1];
    if (qa == 0) return 0;
    const double qb = a[0] * d[0] + a[1] * d[1];
    const double qc = a[0] * a[0] + a[1] * a[1] - r * r;
    const double discriminant = qb * qb - qa * qc;
    double t[4] = {0, 0, 0, 1}; /* ends of the pieces: outside, inside, outside */
    if (discriminant > 0) {
        t[1] = fmin(fmax((-qb - sqrt(discriminant)) / qa, 0), 1);
        t[2] = fmin(fmax((-qb + sqrt(discriminant)) / qa, 0), 1);
    }
    double sum = 0;
    for (int piece = 0; piece < 3; piece++) {
        if (t[piece + 1] <= t[piece]) continue;
        const double from[2] = {a[0] + t[piece] * d[0], a[1] + t[piece] * d[1]};
        const double to[2] = {a[0] + t[piece + 1] * d[0], a[1] + t[piece + 1] * d[1]};
        sum += piece == 1 ? triangle(from, to) : sector(r, from, to);
    }
    return sum;
}

/* Area of the polygon outside the hole; sums are about a corner or the hole's centre to lose no digits. */
static double area(const struct polygon *polygon, const struct body *body)
{
    double sum = 0;
    for (size_t k = 0; k < polygon->corners; k++) {
        const double *p = polygon->corner[k];
        const double *q = polygon->corner[(k + 1) % polygon->corners];
        const double *origin = polygon->corner[0];
        const double a[2] = {p[0] - origin[0], p[1] - origin[1]};
        const double b[2] = {q[0] - origin[0], q[1] - origin[1]};
        sum += triangle(a, b);
        if (body->shape != BODY_PLATE_WITH_HOLE) continue;
        const double c[2] = {p[0] - body->hole_centre[0], p[1] - body->hole_centre[1]};
        const double e[2] = {q[0] - body->hole_centre[0], q[1] - body->hole_centre[1]};
        sum -= in_disc(body->hole_radius, c, e);
    }
    return sum;
}

static double farthest(const struct polygon *polygon, const double x[2])
{
    double distance = 0;
    for (size_t k = 0; k < polygon->corners; k++)
        distance = fmax(distance, hypot(polygon->corner[k][0] - x[0], polygon->corner[k][1] - x[1]));
    return distance;
}

static void clip_by(struct polygon *polygon, const double *position, size_t i, size_t j)
{
    const double *x = position + 3 * i;
    const double *y = position + 3 * j;
    const double middle[2] = {0.5 * (x[0] + y[0]), 0.5 * (x[1] + y[1])};
    const double normal[2] = {y[0] - x[0], y[1] - x[1]};
    if (i != j) clip(polygon, middle, normal);
}

static void cell(const struct cloud *cloud, const struct body *body, const struct neighbours *near, size_t i,
                 struct polygon *polygon)
{
    const double *low = body->low;
    const double *high = body->high;
    *polygon =
        (struct polygon){4, {{low[0], low[1]}, {high[0], low[1]}, {high[0], high[1]}, {low[0], high[1]}}};
    for (size_t k = near->start[i]; k < near->start[i + 1]; k++)
        clip_by(polygon, cloud->position, i, near->index[k]);
    /* a cell that reaches further than half the search radius may have neighbours beyond it */
    if (2 * farthest(polygon, cloud->position + 3 * i) > near->radius)
        for (size_t j = 0; j < cloud->points; j++)
            clip_by(polygon, cloud->position, i, j);
}

static selas_status cells_2d(struct cloud *cloud, const struct body *body, struct messages *messages)
{
    struct neighbours near = {0};
    const selas_status status =
        neighbours_find(&near, 2, cloud->points, cloud->position, cells_radius(body, 2), false, messages);
    if (status != SELAS_OK) {
        neighbours_free(&near);
        return status;
    }
#pragma omp parallel for schedule(dynamic, 64)
    for (size_t i = 0; i < cloud->points; i++) {
        struct polygon polygon;
        cell(cloud, body, &near, i, &polygon);
        cloud->volume[i] = area(&polygon, body);
    }
    neighbours_free(&near);
    for (size_t i = 0; i < cloud->points; i++)
        if (!(cloud->volume[i] > 0))
            return fail(messages, SELAS_BAD_SCENE, "point %zu at (%g, %g) stands for no volume",
                        cloud->first + i + 1, cloud->position[3 * i], cloud->position[3 * i + 1]);
    return SELAS_OK;
}

static int ascending(const void *a, const void *b)
{
    const double x = **(double *const *)a;
    const double y = **(double *const *)b;
    return (x > y) - (x < y);
}

/* In 1D the cells end half way to the neighbours. */
static selas_status cells_1d(struct cloud *cloud, const struct body *body, struct messages *messages)
{
    const size_t n = cloud->points;
    double **order = array_new(n, sizeof *order);
    if (order == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for cells");
    for (size_t i = 0; i < n; i++)
        order[i] = cloud->position + 3 * i;
    qsort(order, n, sizeof *order, ascending);
    for (size_t k = 0; k < n; k++) {
        const double from = k == 0 ? body->low[0] : 0.5 * (*order[k - 1] + *order[k]);
        const double to = k + 1 == n ? body->high[0] : 0.5 * (*order[k] + *order[k + 1]);
        cloud->volume[(size_t)(order[k] - cloud->position) / 3] = to - from;
    }
    array_free(order);
    return SELAS_OK;
}

selas_status cloud_cells(struct cloud *cloud, const struct body *body, struct messages *messages)
{
    if (cloud->dimension == 1) return cells_1d(cloud, body, messages);
    if (cloud->dimension == 2) return cells_2d(cloud, body, messages);
    return cells_3d(cloud, body, messages);
}
