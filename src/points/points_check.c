/* What points that come from outside may be wrong in: two at one place, places where there are none. */
#include "points/cloud.h"
#include "points/lattice.h"
#include "points/neighbours.h"

#include "base/memory.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

struct place {
    int64_t at[3]; /* in millionths of the spacing */
    size_t point;
};

static int by_place(const void *one, const void *other)
{
    const struct place *a = one, *b = other;
    for (int c = 0; c < 3; c++)
        if (a->at[c] != b->at[c]) return a->at[c] < b->at[c] ? -1 : 1;
    return (a->point > b->point) - (a->point < b->point);
}

selas_status points_check_apart(size_t points, const double *position, double spacing, const char *path,
                                const size_t *line, struct messages *messages)
{
    struct place *place = array_new(points, sizeof *place);
    if (place == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for %zu points", points);
    for (size_t i = 0; i < points; i++) {
        place[i].point = i;
        for (size_t c = 0; c < 3; c++) {
            const double at = round(position[3 * i + c] / (1e-6 * spacing));
            place[i].at[c] = fabs(at) < 9e18 ? (int64_t)at : 0;
        }
    }
    qsort(place, points, sizeof *place, by_place);
    selas_status status = SELAS_OK;
    for (size_t k = 1; k < points && status == SELAS_OK; k++) {
        const struct place *a = &place[k - 1], *b = &place[k];
        if (a->at[0] != b->at[0] || a->at[1] != b->at[1] || a->at[2] != b->at[2]) continue;
        char lines[64] = "";
        if (line != NULL)
            snprintf(lines, sizeof lines, ", lines %zu and %zu", line[a->point], line[b->point]);
        status =
            fail(messages, SELAS_BAD_SCENE, "%s%spoints %zu and %zu coincide%s: each place takes one point",
                 path != NULL ? path : "", path != NULL ? ": " : "", a->point + 1, b->point + 1, lines);
    }
    array_free(place);
    return status;
}

/* A closed surface encloses a third of the sum of area times normal times place (a half in two dimensions); that of
 * points with one normal each, cut off at corners, 3 % less with five points across. */
void points_warn_of_volumes(const struct cloud *cloud, const struct body *body, struct messages *messages)
{
    double enclosed = 0, area = 0, open[3] = {0};
    for (size_t e = 0; e < cloud->elements; e++) {
        const struct face_element *element = &cloud->element[e];
        area += element->area;
        for (int c = 0; c < 3; c++) {
            open[c] += element->area * element->normal[c];
            const double place = element->position[c] - 0.5 * (body->low[c] + body->high[c]);
            enclosed += element->area * element->normal[c] * place / cloud->dimension;
        }
    }
    const double volume = cloud_volume(cloud), share = volume / enclosed;
    if (fmax(fmax(fabs(open[0]), fabs(open[1])), fabs(open[2])) > 0.02 * area ||
        (share > 0.75 && share < 1.33))
        return;
    warn(messages,
         "%s: the volumes of the points add up to %.3g, but their areas and outward normals enclose "
         "%.3g: masses are density times volume, loads traction times area; those that fit would be right",
         body->file, volume, enclosed);
}

void points_warn_of_spacing(const struct cloud *cloud, const struct body *body, struct messages *messages)
{
    const double apart = pow(cloud_volume(cloud) / (double)cloud->points, 1.0 / cloud->dimension);
    if (apart > 0.7 * body->spacing && apart < 1.4 * body->spacing) return;
    warn(messages,
         "%s: by their volumes the points are %.3g apart, not body%%spacing = %.3g, by which the program "
         "tells what "
         "they resolve, and kernels their reach; body%%spacing = %.3g would be right",
         body->file != NULL ? body->file : "points of the host", apart, body->spacing, apart);
}

/* Looks at places half a spacing apart: in a lattice without gaps the farthest from any point is a cell's middle, at
 * most .87 spacings away, and where a point is missing it is a whole spacing. */
selas_status points_warn_of_gaps(const struct body *body, int dimension, size_t points,
                                 const double *position, struct messages *messages)
{
    static const double wide = .999;
    struct neighbours near = {0};
    size_t count[3] = {1, 1, 1}, gaps = 0;
    double first[3] = {0};
    const selas_status status =
        neighbours_cells(&near, dimension, points, position, wide * body->spacing, messages);
    if (status != SELAS_OK) return status;
    for (int c = 0; c < dimension; c++)
        count[c] = (size_t)round(2 * (body->high[c] - body->low[c]) / body->spacing) + 1;
    for (size_t k = 0; k < count[2]; k++)
        for (size_t j = 0; j < count[1]; j++)
            for (size_t i = 0; i < count[0]; i++) {
                const size_t at[3] = {i, j, k};
                double place[3] = {0};
                for (int c = 0; c < dimension; c++)
                    place[c] = fmin(body->low[c] + .5 * (double)at[c] * body->spacing, body->high[c]);
                if (neighbours_at(&near, place, 0, NULL) > 0) continue;
                if (gaps++ == 0)
                    for (int c = 0; c < 3; c++)
                        first[c] = place[c];
            }
    neighbours_free(&near);
    if (gaps > 0)
        warn(messages,
             "no point lies within a spacing of (%.6g, %.6g, %.6g), nor of %zu more such places: this method "
             "has no "
             "surface around a gap and takes it for part of the body; histories were .05 to .18 wrong so; "
             "points "
             "there, or method%%name = 'sph' with normals and areas, would be right",
             first[0], first[1], first[2], gaps - 1);
    return SELAS_OK;
}
