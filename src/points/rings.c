/* Points of a plate with a hole: squared, radial and equally radial as in He & Seaid 2016, Fig. 15, and
 * conformal. Positions only; volumes come from the cells.
 *
 *   squared         lattice without the points in the hole
 *   radial          rings one spacing apart, the same number of points on each (rays)
 *   equally radial  rings one spacing apart, points one spacing apart on each
 *   conformal       rays that run straight from even places on the hole to even places on each edge, and rings
 *                   that blend from the circle to the edges, nearer to each other at the hole: a smooth map of
 *                   a lattice, cells about square. (Rings with as many points as fit on each have dislocations
 *                   where the number changes, which make noise in the stress.) */
#include "points/cloud.h"

#include <math.h>
#include <stdlib.h>

enum { SAMPLES = 2048 }; /* of a ring when its length is measured */

enum { PARTS = 5 };

/* A part of all rings between two angles. */
struct part {
    double first, last;
};

struct place {
    double x[2];
};

struct list {
    size_t count, room;
    double margin; /* least distance to the box's edges: nearer, a point would stand for a sliver */
    struct place *place;
    bool failed;
};

static void add(struct list *list, const struct body *body, double x, double y)
{
    const double margin = list->margin;
    if (x < body->low[0] + margin || x > body->high[0] - margin) return;
    if (y < body->low[1] + margin || y > body->high[1] - margin) return;
    if (list->count == list->room) {
        const size_t room = 2 * list->room + 256;
        struct place *larger = realloc(list->place, room * sizeof *larger);
        if (larger == NULL) {
            list->failed = true;
            return;
        }
        list->place = larger;
        list->room = room;
    }
    list->place[list->count++] = (struct place){{x, y}};
}

static void squared(struct list *list, const struct body *body)
{
    size_t count[2];
    double step[2];
    for (int c = 0; c < 2; c++) {
        const double length = body->high[c] - body->low[c];
        count[c] = (size_t)fmax(1, round(length / body->spacing));
        step[c] = length / (double)count[c];
    }
    for (size_t j = 0; j < count[1]; j++)
        for (size_t i = 0; i < count[0]; i++) {
            const double x = body->low[0] + ((double)i + 0.5) * step[0];
            const double y = body->low[1] + ((double)j + 0.5) * step[1];
            if (hypot(x - body->hole_centre[0], y - body->hole_centre[1]) > body->hole_radius)
                add(list, body, x, y);
        }
}

/* Distance from the hole's centre to the box in a direction. */
static double reach(const struct body *body, double angle)
{
    const double direction[2] = {cos(angle), sin(angle)};
    double distance = INFINITY;
    for (int c = 0; c < 2; c++) {
        if (direction[c] > 1e-12)
            distance = fmin(distance, (body->high[c] - body->hole_centre[c]) / direction[c]);
        if (direction[c] < -1e-12)
            distance = fmin(distance, (body->low[c] - body->hole_centre[c]) / direction[c]);
    }
    return distance;
}

static void circles(struct list *list, const struct body *body, bool equally)
{
    double first = 0;
    double last = 0;
    hole_angles(body, &first, &last);
    double farthest = 0;
    for (int k = 0; k <= SAMPLES; k++)
        farthest = fmax(farthest, reach(body, first + (last - first) * k / SAMPLES));
    /* as many rays as give the mean spacing half way between hole and box */
    const double middle = 0.5 * (body->hole_radius + farthest / sqrt(2));
    const size_t rings = (size_t)ceil((farthest - body->hole_radius) / body->spacing - 0.5);
    for (size_t ring = 0; ring < rings; ring++) {
        const double r = body->hole_radius + ((double)ring + 0.5) * body->spacing;
        const size_t points = (size_t)fmax(1, round((last - first) * (equally ? r : middle) / body->spacing));
        for (size_t k = 0; k < points; k++) {
            const double angle = first + (last - first) * ((double)k + 0.5) / (double)points;
            add(list, body, body->hole_centre[0] + r * cos(angle), body->hole_centre[1] + r * sin(angle));
        }
    }
}

/* Where the ray at `angle` meets the box. */
static void on_box(const struct body *body, double angle, double p[2])
{
    const double r = reach(body, angle);
    p[0] = body->hole_centre[0] + r * cos(angle);
    p[1] = body->hole_centre[1] + r * sin(angle);
}

static double edge_length(const struct body *body, const struct part *part)
{
    double from[2];
    double to[2];
    on_box(body, part->first, from);
    on_box(body, part->last, to);
    return hypot(to[0] - from[0], to[1] - from[1]);
}

/* Points of the ring at s between two rays. */
static void ring_part(struct list *list, const struct body *body, double s, const struct part *part,
                      size_t points)
{
    double from[2];
    double to[2];
    on_box(body, part->first, from);
    on_box(body, part->last, to);
    for (size_t i = 0; i < points; i++) {
        const double t = ((double)i + 0.5) / (double)points;
        const double angle = part->first + (part->last - part->first) * t;
        const double inner[2] = {body->hole_centre[0] + body->hole_radius * cos(angle),
                                 body->hole_centre[1] + body->hole_radius * sin(angle)};
        add(list, body, inner[0] + s * (from[0] + t * (to[0] - from[0]) - inner[0]),
            inner[1] + s * (from[1] + t * (to[1] - from[1]) - inner[1]));
    }
}

/* Cuts the angles in the box at its corners; returns the number of parts. */
static size_t ring_parts(const struct body *body, struct part part[PARTS])
{
    double first = 0;
    double last = 0;
    double kink[4] = {0};
    size_t kinks = 0;
    hole_angles(body, &first, &last);
    const double turn = 2 * acos(-1.0);
    const bool closed = last - first > 0.99 * turn;
    for (int corner = 0; corner < 4; corner++) {
        const double x = (corner == 1 || corner == 2 ? body->low[0] : body->high[0]) - body->hole_centre[0];
        const double y = (corner >= 2 ? body->low[1] : body->high[1]) - body->hole_centre[1];
        double angle = atan2(y, x);
        while (angle < first - 1e-9)
            angle += turn;
        if (hypot(x, y) < body->hole_radius || angle > last - 1e-9 || angle < first + 1e-9) continue;
        size_t place = kinks++;
        for (; place > 0 && kink[place - 1] > angle; place--)
            kink[place] = kink[place - 1];
        kink[place] = angle;
    }
    size_t parts = 0;
    if (!closed) part[parts++] = (struct part){first, kinks > 0 ? kink[0] : last};
    for (size_t k = 0; k < kinks; k++) {
        const double end = closed ? kink[0] + turn : last;
        part[parts++] = (struct part){kink[k], k + 1 < kinks ? kink[k + 1] : end};
    }
    return parts;
}

/* Rings so that the step between them is 1 + (ratio - 1) (s + s^2 - s^3) of the step at the hole: it grows as
 * the step along the rings does and levels off at both ends: where the step changes from ring to ring the
 * one-point quadrature errs, worst at a boundary. Place s of the ring after `part` of all; part = 1 gives the
 * sum of ds / step itself. */
static double ring_place(double ratio, double part, double *sum)
{
    double all = 0;
    for (int k = 0; k < SAMPLES; k++) {
        const double s = (k + 0.5) / SAMPLES;
        all += 1 / (1 + (ratio - 1) * s * (1 + s - s * s)) / SAMPLES;
    }
    if (sum != NULL) *sum = all;
    double before = 0;
    for (int k = 0; k < SAMPLES; k++) {
        const double s = (k + 0.5) / SAMPLES;
        const double more = 1 / (1 + (ratio - 1) * s * (1 + s - s * s)) / SAMPLES;
        if (before + more >= part * all) return (k + (part * all - before) / more) / SAMPLES;
        before += more;
    }
    return 1;
}

/* Rays straight from even places on the hole to even places on the edge, cell middles, and rings across them.
 * The area over the spacing squared gives their number. */
static void conformal(struct list *list, const struct body *body)
{
    struct part part[PARTS];
    const size_t parts = ring_parts(body, part);
    double edge = 0;
    double hole = 0;
    double between = 0;
    for (size_t p = 0; p < parts; p++) {
        edge += edge_length(body, &part[p]);
        hole += body->hole_radius * (part[p].last - part[p].first);
        for (int k = 0; k < SAMPLES; k++) {
            const double angle = part[p].first + (part[p].last - part[p].first) * (k + 0.5) / SAMPLES;
            between += (reach(body, angle) - body->hole_radius) * (part[p].last - part[p].first) / SAMPLES;
        }
    }
    between *= body->hole_radius / hole; /* mean distance from hole to edge */
    const double points = body_volume(body, 2) / (body->spacing * body->spacing);
    double sum = 0;
    (void)ring_place(edge / hole, 1, &sum);
    const double rays = sqrt(points * hole / (between * sum));
    const size_t rings = (size_t)fmax(1, round(points / rays));
    for (size_t k = 0; k < rings; k++) {
        const double s = ring_place(edge / hole, ((double)k + 0.5) / (double)rings, NULL);
        for (size_t p = 0; p < parts; p++)
            ring_part(list, body, s, &part[p],
                      (size_t)fmax(1, round(rays * edge_length(body, &part[p]) / edge)));
    }
}

static selas_status check(const struct body *body, struct messages *messages)
{
    if (!(body->hole_radius > 0))
        return fail(messages, SELAS_BAD_SCENE, "body%%hole_radius must be positive");
    for (int c = 0; c < 2; c++) {
        const double low = body->hole_centre[c] - body->low[c];
        const double high = body->high[c] - body->hole_centre[c];
        const double tolerance = 1e-9 * (low + high);
        const bool cut_low = low < body->hole_radius && fabs(low) > tolerance;
        const bool cut_high = high < body->hole_radius && fabs(high) > tolerance;
        if (low < -tolerance || high < -tolerance || cut_low || cut_high)
            return fail(messages, SELAS_BAD_SCENE,
                        "the hole must lie inside the plate, or its centre on an edge or a corner");
    }
    return SELAS_OK;
}

selas_status cloud_plate(const struct body *body, struct cloud **cloud, struct messages *messages)
{
    struct list list = {0};
    selas_status status = check(body, messages);
    if (status != SELAS_OK) return status;
    if (body->arrangement != ARRANGEMENT_CONFORMAL) list.margin = 0.2 * body->spacing;
    switch (body->arrangement) {
    case ARRANGEMENT_LATTICE:
        squared(&list, body);
        break;
    case ARRANGEMENT_RADIAL:
        circles(&list, body, false);
        break;
    case ARRANGEMENT_EQUALLY_RADIAL:
        circles(&list, body, true);
        break;
    case ARRANGEMENT_CONFORMAL:
        conformal(&list, body);
        break;
    }
    if (list.failed || list.count == 0)
        status = list.failed ? fail(messages, SELAS_NO_MEMORY, "no memory for the points of the plate")
                             : fail(messages, SELAS_BAD_SCENE, "body%%spacing is too large for this plate");
    if (status == SELAS_OK) status = cloud_allocate(2, list.count, cloud, messages);
    for (size_t i = 0; i < list.count && status == SELAS_OK; i++) {
        (*cloud)->position[3 * i] = list.place[i].x[0];
        (*cloud)->position[3 * i + 1] = list.place[i].x[1];
    }
    free(list.place);
    return status;
}
