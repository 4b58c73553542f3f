/* Points of a file in layers over the longest axis of the body's box, and parts of some of these. Where a point stands
 * hangs on its own place alone, so that whoever reads the file has the same layers (doc/developers/ranks.md, Eq R4). */
#include "points/cloud.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

static double thickness(const struct cloud *cloud, const struct body *body)
{
    return (body->high[cloud->axis] - body->low[cloud->axis]) / (double)cloud->layers;
}

size_t cloud_layer(const struct cloud *cloud, const struct body *body, const double place[3])
{
    const double layer = floor((place[cloud->axis] - body->low[cloud->axis]) / thickness(cloud, body));
    return (size_t)fmin(fmax(layer, 0), (double)cloud->layers - 1);
}

/* Chooses axis and number of layers: no more than points. */
static void lay(struct cloud *cloud, const struct body *body)
{
    double longest = 0;
    for (int c = 0; c < cloud->dimension; c++) {
        const double length = body->high[c] - body->low[c];
        if (length < (1 - 1e-9) * longest) continue;
        longest = length;
        cloud->axis = c;
    }
    cloud->layers = (size_t)fmax(1, fmin((double)cloud->points, round(longest / body->spacing)));
}

/* Things by their layers, in each in their order: of[count], the layer of each, becomes its number. start[layers + 1]
 * gets the first of each layer. */
static void sort(const struct cloud *cloud, size_t count, size_t *start, uint32_t *of)
{
    memset(start, 0, (cloud->layers + 1) * sizeof *start);
    for (size_t i = 0; i < count; i++)
        start[of[i] + 1]++;
    for (size_t l = 0; l < cloud->layers; l++)
        start[l + 1] += start[l];
    for (size_t i = 0; i < count; i++) /* moved on, */
        of[i] = (uint32_t)start[of[i]]++;
    for (size_t l = cloud->layers; l > 0; l--) /* and back */
        start[l] = start[l - 1];
    start[0] = 0;
}

static bool sort_points(struct cloud *cloud, const struct body *body)
{
    const size_t n = cloud->points;
    uint32_t *to = array_new(n, sizeof *to);
    double *position = array_new(3 * n, sizeof *position), *volume = array_new(n, sizeof *volume);
    cloud->start = array_new(cloud->layers + 1, sizeof *cloud->start);
    cloud->number = array_new(n, sizeof *cloud->number);
    const bool room =
        to != NULL && position != NULL && volume != NULL && cloud->start != NULL && cloud->number != NULL;
    for (size_t i = 0; room && i < n; i++)
        to[i] = (uint32_t)cloud_layer(cloud, body, cloud->position + 3 * i);
    if (room) sort(cloud, n, cloud->start, to);
    for (size_t i = 0; room && i < n; i++) {
        memcpy(position + (size_t)3 * to[i], cloud->position + 3 * i, 3 * sizeof *position);
        volume[to[i]] = cloud->volume[i];
        cloud->number[to[i]] = (uint32_t)i;
    }
    array_free(to);
    array_free(room ? cloud->position : position);
    array_free(room ? cloud->volume : volume);
    if (room) cloud->position = position;
    if (room) cloud->volume = volume;
    return room;
}

static bool sort_elements(struct cloud *cloud, const struct body *body)
{
    enum { MORE = 64 }; /* room that cloud_add_element() counts on */
    const size_t count = cloud->elements;
    size_t *start = array_new(cloud->layers + 1, sizeof *start);
    uint32_t *to = array_new(count, sizeof *to);
    struct face_element *sorted = calloc((count / MORE + 1) * MORE, sizeof *sorted);
    const bool room = start != NULL && to != NULL && sorted != NULL;
    for (size_t e = 0; room && e < count; e++)
        to[e] = (uint32_t)cloud_layer(cloud, body, cloud->element[e].position);
    if (room) sort(cloud, count, start, to);
    for (size_t e = 0; room && e < count; e++)
        sorted[to[e]] = cloud->element[e];
    array_free(start);
    array_free(to);
    free(room ? cloud->element : sorted);
    if (room) cloud->element = sorted;
    return room;
}

selas_status cloud_sort(struct cloud *cloud, const struct body *body, struct messages *messages)
{
    if (cloud->points >= UINT32_MAX)
        return fail(messages, SELAS_UNSUPPORTED, "%zu points are more than this method can number",
                    cloud->points);
    lay(cloud, body);
    if (sort_points(cloud, body) && sort_elements(cloud, body)) return SELAS_OK;
    return fail(messages, SELAS_NO_MEMORY, "no memory for %zu points", cloud->points);
}

size_t cloud_on_face(const struct cloud *cloud, int face, double *area)
{
    size_t count = 0;
    *area = 0;
    if (cloud->all != NULL) {
        *area = cloud->all->area[face];
        return cloud->all->of_face[face];
    }
    for (size_t e = 0; e < cloud->elements; e++) {
        if (cloud->element[e].face != face) continue;
        *area += cloud->element[e].area;
        count++;
    }
    return count;
}

size_t cloud_number(const struct cloud *cloud, size_t point)
{
    const size_t number = cloud->first + point;
    return 1 + (cloud->number != NULL ? cloud->number[number] : number);
}

/* What the whole knows; it gives its places away. */
static bool look_at_all(struct cloud *cloud, const struct body *body, struct cloud_all **made)
{
    struct cloud_all *all = *made = array_new(1, sizeof *all);
    if (all == NULL) return false;
    all->volume = cloud_volume(cloud);
    all->square = cloud_mean_power(cloud, 2);
    all->elements = cloud->elements;
    for (int face = 0; face < FACES; face++)
        all->of_face[face] = cloud_on_face(cloud, face, &all->area[face]);
    all->position = cloud->position;
    cloud->position = NULL;
    for (size_t i = 0; i < cloud->points; i++)
        body_to_deck(body, all->position + 3 * i, all->position + 3 * i);
    return true;
}

selas_status cloud_cut(struct cloud **cloud, const struct body *body, size_t from, size_t end,
                       struct messages *messages)
{
    struct cloud *whole = *cloud, *part = NULL;
    const size_t first = whole->start[from], points = whole->start[end] - first;
    const double low = body->low[whole->axis], step = thickness(whole, body), near = 1e-9 * step;
    selas_status status = cloud_allocate(whole->dimension, points, &part, messages);
    if (status == SELAS_OK && part != NULL) {
        memcpy(part->position, whole->position + 3 * first, 3 * points * sizeof *part->position);
        memcpy(part->volume, whole->volume + first, points * sizeof *part->volume);
        part->first = first;
        part->whole = whole->points;
        part->axis = whole->axis;
        part->spacing = whole->spacing;
        if (from > 0) part->low = low + (double)from * step + near;
        if (end < whole->layers) part->high = low + (double)end * step - near;
        for (size_t e = 0; e < whole->elements && status == SELAS_OK; e++)
            status = cloud_add_element(part, &whole->element[e], messages);
        if (status == SELAS_OK && !look_at_all(whole, body, &part->all))
            status = fail(messages, SELAS_NO_MEMORY, "no memory for %zu points", whole->points);
        part->layers = whole->layers;
        part->start = whole->start;
        part->number = whole->number;
        whole->start = NULL;
        whole->number = NULL;
    }
    cloud_free(&whole);
    if (status != SELAS_OK) cloud_free(&part);
    *cloud = part;
    return status;
}
