/* Volumes of scattered points: areas of the Voronoi cells, cut by the box and by the hole. They add up to the
 * body's area exactly because the cells tile the box: each cell is the box's rectangle clipped by the
 * bisectors to the neighbours, less its intersection with the disc (moments by Green's theorem, edge by
 * edge). Lloyd's iteration (points to the centroids of their cells) spreads points evenly and makes the
 * one-point quadrature sum V_i f(x_i) exact for linear f. */
#include "points/cloud.h"

#include "base/memory.h"
#include "points/cells.h"
#include "points/neighbours.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { CORNERS = 64, NEAR = 512 };

struct polygon {
    size_t corners;
    double corner[CORNERS][2];
};

struct moments {
    double area, x, y; /* integrals of 1, x, y */
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

/* Triangle (0, a, b), signed. */
static void add_triangle(struct moments *sum, const double a[2], const double b[2])
{
    const double area = 0.5 * (a[0] * b[1] - a[1] * b[0]);
    sum->area += area;
    sum->x += area * (a[0] + b[0]) / 3;
    sum->y += area * (a[1] + b[1]) / 3;
}

/* Sector of radius r from direction a to direction b, signed, less than half a turn. */
static void add_sector(struct moments *sum, double r, const double a[2], const double b[2])
{
    const double from = atan2(a[1], a[0]);
    const double angle = atan2(a[0] * b[1] - a[1] * b[0], a[0] * b[0] + a[1] * b[1]);
    sum->area += 0.5 * r * r * angle;
    sum->x += r * r * r / 3 * (sin(from + angle) - sin(from));
    sum->y += r * r * r / 3 * (cos(from) - cos(from + angle));
}

/* Triangle (0, a, b) within the disc of radius r about 0: pieces of the edge inside the circle count as
 * triangles, those outside as sectors. */
static void add_in_disc(struct moments *sum, double r, const double a[2], const double b[2])
{
    const double d[2] = {b[0] - a[0], b[1] - a[1]};
    const double qa = d[0] * d[0] + d[1] * d[1];
    if (qa == 0) return;
    const double qb = a[0] * d[0] + a[1] * d[1];
    const double qc = a[0] * a[0] + a[1] * a[1] - r * r;
    const double discriminant = qb * qb - qa * qc;
    double t[4] = {0, 0, 1, 1};
    if (discriminant > 0) {
        t[1] = fmin(fmax((-qb - sqrt(discriminant)) / qa, 0), 1);
        t[2] = fmin(fmax((-qb + sqrt(discriminant)) / qa, 0), 1);
    } else {
        t[2] = 0; /* the whole edge is outside */
    }
    for (int piece = 0; piece < 3; piece++) {
        if (t[piece + 1] <= t[piece]) continue;
        const double from[2] = {a[0] + t[piece] * d[0], a[1] + t[piece] * d[1]};
        const double to[2] = {a[0] + t[piece + 1] * d[0], a[1] + t[piece + 1] * d[1]};
        if (piece == 1)
            add_triangle(sum, from, to);
        else
            add_sector(sum, r, from, to);
    }
}

/* Moments about `origin` of the polygon outside the hole. */
static struct moments polygon_moments(const struct polygon *polygon, const struct body *body,
                                      const double origin[2])
{
    struct moments whole = {0};
    struct moments inside = {0};
    for (size_t k = 0; k < polygon->corners; k++) {
        double a[2];
        double b[2];
        for (int c = 0; c < 2; c++) {
            a[c] = polygon->corner[k][c] - origin[c];
            b[c] = polygon->corner[(k + 1) % polygon->corners][c] - origin[c];
        }
        add_triangle(&whole, a, b);
        if (body->shape != BODY_PLATE_WITH_HOLE) continue;
        for (int c = 0; c < 2; c++) {
            a[c] += origin[c] - body->hole_centre[c];
            b[c] += origin[c] - body->hole_centre[c];
        }
        add_in_disc(&inside, body->hole_radius, a, b);
    }
    const double shift[2] = {body->hole_centre[0] - origin[0], body->hole_centre[1] - origin[1]};
    return (struct moments){whole.area - inside.area, whole.x - inside.x - shift[0] * inside.area,
                            whole.y - inside.y - shift[1] * inside.area};
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

/* One sweep: volumes, and the centroids into `centroid` [2 * points]. */
static selas_status sweep(struct cloud *cloud, const struct body *body, struct neighbours *near,
                          double *centroid, struct messages *messages)
{
    const selas_status status =
        neighbours_find(near, 2, cloud->points, cloud->position, 4 * cloud->spacing, false, messages);
    if (status != SELAS_OK) return status;
#pragma omp parallel for schedule(dynamic, 64)
    for (size_t i = 0; i < cloud->points; i++) {
        struct polygon polygon;
        cell(cloud, body, near, i, &polygon);
        const double *x = cloud->position + 3 * i;
        const struct moments moments = polygon_moments(&polygon, body, x);
        cloud->volume[i] = moments.area;
        centroid[2 * i] = moments.area > 0 ? x[0] + moments.x / moments.area : x[0];
        centroid[2 * i + 1] = moments.area > 0 ? x[1] + moments.y / moments.area : x[1];
    }
    return SELAS_OK;
}

static selas_status cells_2d(struct cloud *cloud, const struct body *body, int relax,
                             struct messages *messages)
{
    struct neighbours near = {0};
    double *centroid = array_new(2 * cloud->points, sizeof *centroid);
    selas_status status = SELAS_OK;
    if (centroid == NULL) status = fail(messages, SELAS_NO_MEMORY, "no memory for cells");
    for (int k = 0; k <= relax && status == SELAS_OK; k++) {
        status = sweep(cloud, body, &near, centroid, messages);
        for (size_t i = 0; i < cloud->points && k < relax && status == SELAS_OK; i++) {
            cloud->position[3 * i] = centroid[2 * i];
            cloud->position[3 * i + 1] = centroid[2 * i + 1];
        }
    }
    neighbours_free(&near);
    array_free(centroid);
    for (size_t i = 0; i < cloud->points && status == SELAS_OK; i++)
        if (!(cloud->volume[i] > 0))
            status = fail(messages, SELAS_BAD_SCENE, "point %zu at (%g, %g) stands for no volume", i,
                          cloud->position[3 * i], cloud->position[3 * i + 1]);
    return status;
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

selas_status cloud_cells(struct cloud *cloud, const struct body *body, int relax, struct messages *messages)
{
    if (cloud->dimension == 1) return cells_1d(cloud, body, messages);
    if (cloud->dimension == 2) return cells_2d(cloud, body, relax, messages);
    return cells_3d(cloud, body, messages);
}
