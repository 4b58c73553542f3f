/* Points of a plate with a hole: squared, radial and equally radial as in He & Seaid 2016, Fig. 15, and
 * conformal. Positions only; volumes come from the cells.
 *
 *   squared         lattice without the points in the hole
 *   radial          rings one spacing apart, the same number of points on each (rays)
 *   equally radial  rings one spacing apart, points one spacing apart on each
 *   conformal       rings r(s) = R + s (D - R), 0 < s < 1, where D(angle) is the distance to the box: circles
 *                   at the hole, the box's edges outside; points evenly spaced along each ring */
#include "points/cloud.h"

#include <math.h>
#include <stdlib.h>

enum { SAMPLES = 2048 }; /* of a ring when its length is measured */

struct place {
    double x[2];
};

struct list {
    size_t count, room;
    struct place *place;
    bool failed;
};

static void add(struct list *list, const struct body *body, double x, double y)
{
    const double margin =
        0.2 * body->spacing; /* nearer to a straight edge a point would stand for a sliver */
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
    for (double r = body->hole_radius + 0.5 * body->spacing; r < farthest; r += body->spacing) {
        const size_t points = (size_t)fmax(1, round((last - first) * (equally ? r : middle) / body->spacing));
        for (size_t k = 0; k < points; k++) {
            const double angle = first + (last - first) * ((double)k + 0.5) / (double)points;
            add(list, body, body->hole_centre[0] + r * cos(angle), body->hole_centre[1] + r * sin(angle));
        }
    }
}

static void ring_point(const struct body *body, double s, double angle, double p[2])
{
    const double r = body->hole_radius + s * (reach(body, angle) - body->hole_radius);
    p[0] = body->hole_centre[0] + r * cos(angle);
    p[1] = body->hole_centre[1] + r * sin(angle);
}

/* Points evenly along the ring at s, by its length measured on a fine polygon. */
static void ring(struct list *list, const struct body *body, double s, double first, double last)
{
    double length[SAMPLES + 1] = {0};
    double before[2];
    ring_point(body, s, first, before);
    for (int k = 1; k <= SAMPLES; k++) {
        double p[2];
        ring_point(body, s, first + (last - first) * k / SAMPLES, p);
        length[k] = length[k - 1] + hypot(p[0] - before[0], p[1] - before[1]);
        before[0] = p[0];
        before[1] = p[1];
    }
    const size_t points = (size_t)fmax(1, round(length[SAMPLES] / body->spacing));
    int k = 0;
    for (size_t i = 0; i < points; i++) {
        const double wanted = length[SAMPLES] * ((double)i + 0.5) / (double)points;
        while (k + 1 < SAMPLES && length[k + 1] < wanted)
            k++;
        const double part = (wanted - length[k]) / (length[k + 1] - length[k]);
        double p[2];
        ring_point(body, s, first + (last - first) * (k + part) / SAMPLES, p);
        add(list, body, p[0], p[1]);
    }
}

static void conformal(struct list *list, const struct body *body)
{
    double first = 0;
    double last = 0;
    double mean = 0;
    hole_angles(body, &first, &last);
    for (int k = 0; k < SAMPLES; k++)
        mean += (reach(body, first + (last - first) * (k + 0.5) / SAMPLES) - body->hole_radius) / SAMPLES;
    const size_t rings = (size_t)fmax(1, round(mean / body->spacing));
    for (size_t k = 0; k < rings; k++)
        ring(list, body, ((double)k + 0.5) / (double)rings, first, last);
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
