/* Clouds of points: boxes on a lattice half a spacing inside, jitter; the other shapes are in their own
 * files. */
#include "points/cloud.h"

#include "base/memory.h"
#include "points/cells.h"
#include "points/lattice.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

double body_volume(const struct body *body, int dimension)
{
    double volume = 1;
    for (int c = 0; c < dimension; c++)
        volume *= body->high[c] - body->low[c];
    if (body->shape == BODY_PLATE_WITH_HOLE) {
        double first = 0;
        double last = 0;
        hole_angles(body, &first, &last);
        volume -= 0.5 * (last - first) * body->hole_radius * body->hole_radius;
    }
    return volume;
}

selas_status cloud_allocate(int dimension, size_t points, struct cloud **cloud, struct messages *messages)
{
    *cloud = array_new(1, sizeof **cloud);
    if (*cloud != NULL) {
        (*cloud)->dimension = dimension;
        (*cloud)->points = (*cloud)->whole = points;
        (*cloud)->axis = dimension - 1;
        (*cloud)->low = -INFINITY;
        (*cloud)->high = INFINITY;
        (*cloud)->position = array_new(3 * points, sizeof(double));
        (*cloud)->volume = array_new(points, sizeof(double));
    }
    if (*cloud == NULL || (*cloud)->position == NULL || (*cloud)->volume == NULL) {
        cloud_free(cloud);
        return fail(messages, SELAS_NO_MEMORY, "no memory for %zu points", points);
    }
    return SELAS_OK;
}

void cloud_free(struct cloud **cloud)
{
    if (cloud == NULL || *cloud == NULL) return;
    array_free((*cloud)->position);
    array_free((*cloud)->volume);
    array_free((*cloud)->start);
    array_free((*cloud)->number);
    if ((*cloud)->all != NULL) array_free((*cloud)->all->position);
    array_free((*cloud)->all);
    free((*cloud)->element);
    array_free(*cloud);
    *cloud = NULL;
}

static void box_grid(const struct scene *scene, size_t grid[3])
{
    const struct body *body = &scene->body;
    for (int c = 0; c < 3; c++)
        grid[c] =
            c < scene->dimension ? (size_t)fmax(1, round((body->high[c] - body->low[c]) / body->spacing)) : 1;
}

/* Middle of cell k of the body. */
static void middle_of(const struct scene *scene, const size_t grid[3], size_t k, double place[3])
{
    const struct body *body = &scene->body;
    const size_t at[3] = {k % grid[0], k / grid[0] % grid[1], k / (grid[0] * grid[1])};
    for (int c = 0; c < 3; c++) {
        const double step = (body->high[c] - body->low[c]) / (double)grid[c];
        place[c] = c < scene->dimension ? body->low[c] + ((double)at[c] + 0.5) * step : 0;
    }
}

/* Planes from .. end - 1 over the last axis. */
static selas_status box(const struct scene *scene, const size_t grid[3], size_t from, size_t end,
                        struct cloud **cloud, struct messages *messages)
{
    const struct body *body = &scene->body;
    const size_t last = (size_t)scene->dimension - 1, plane = grid[0] * grid[1] * grid[2] / grid[last];
    const double step = (body->high[last] - body->low[last]) / (double)grid[last];
    double volume = 1;
    for (int c = 0; c < scene->dimension; c++)
        volume *= (body->high[c] - body->low[c]) / (double)grid[c];
    struct cloud *made = NULL;
    const selas_status status = cloud_allocate(scene->dimension, plane * (end - from), &made, messages);
    if (status != SELAS_OK || made == NULL) return status;
    made->first = plane * from;
    made->whole = plane * grid[last];
    if (from > 0) made->low = body->low[last] + (double)from * step;
    if (end < grid[last]) made->high = body->low[last] + (double)end * step;
    for (size_t i = 0; i < made->points; i++) {
        middle_of(scene, grid, made->first + i, made->position + 3 * i);
        made->volume[i] = volume;
    }
    memcpy(made->grid, grid, sizeof made->grid);
    made->spacing = body->spacing;
    *cloud = made;
    return SELAS_OK;
}

/* Moves point i of the body by up to jitter * spacing along each axis; it stays inside its own lattice cell's reach of
 * the box, and outside the hole. */
static void move(const struct body *body, size_t dimension, size_t i, double x[3])
{
    double moved[3] = {0};
    double distance = 0;
    for (size_t c = 0; c < dimension; c++) {
        const double random = random_uniform((unsigned long)body->seed, 3 * i + c);
        const double margin = 0.05 * body->spacing;
        moved[c] = x[c] + body->jitter * body->spacing * (2 * random - 1);
        moved[c] = fmin(fmax(moved[c], body->low[c] + margin), body->high[c] - margin);
        const double d = moved[c] - body->hole_centre[c];
        distance += d * d;
    }
    if (body->shape == BODY_PLATE_WITH_HOLE && sqrt(distance) < body->hole_radius) return;
    memcpy(x, moved, sizeof moved);
}

static void jitter(struct cloud *cloud, const struct body *body)
{
    for (size_t i = 0; i < cloud->points; i++)
        move(body, (size_t)cloud->dimension, cloud->first + i, cloud->position + 3 * i);
    memset(cloud->grid, 0, sizeof cloud->grid);
}

static selas_status check(const struct scene *scene, struct messages *messages)
{
    const struct body *body = &scene->body;
    if (!(body->spacing > 0)) return fail(messages, SELAS_BAD_SCENE, "body%%spacing must be positive");
    if (body->shape == BODY_HALF_SPACE)
        return fail(messages, SELAS_UNSUPPORTED,
                    "body%%shape 'half-space' has no SPH points: give a 'box' with transmitting faces");
    if (body->shape == BODY_BOX && body->arrangement != ARRANGEMENT_LATTICE)
        return fail(messages, SELAS_UNSUPPORTED, "rings of points need body%%shape 'plate-with-hole'");
    if (body->shape == BODY_PLATE_WITH_HOLE && scene->dimension != 2)
        return fail(messages, SELAS_UNSUPPORTED, "a plate with a hole needs scene%%dimension = 2");
    return SELAS_OK;
}

double cloud_volume(const struct cloud *cloud)
{
    double volume = 0;
    if (cloud->all != NULL) return cloud->all->volume;
    for (size_t i = 0; i < cloud->points; i++)
        volume += cloud->volume[i];
    return volume;
}

double cloud_filling(const struct cloud *cloud, const struct body *body)
{
    return cloud_volume(cloud) / body_volume(body, cloud->dimension);
}

/* No place of a box with jitter is further than D = sqrt(dimension) (step / 2 + jitter spacing) from a point. So those
 * within R of one cut its cell down to what is within D of it, if 2 D < R, and others do not touch it. */
static bool cells_are_near(const struct scene *scene, const size_t grid[3])
{
    const struct body *body = &scene->body;
    double step = 0;
    for (int c = 0; c < scene->dimension; c++)
        step = fmax(step, (body->high[c] - body->low[c]) / (double)grid[c]);
    const double distance = sqrt((double)scene->dimension) * (step / 2 + body->jitter * body->spacing);
    return 2 * distance < 0.999 * cells_radius(body, scene->dimension);
}

bool cloud_in_planes(const struct scene *scene, size_t grid[3])
{
    const struct body *body = &scene->body;
    if (body->shape != BODY_BOX || body->arrangement != ARRANGEMENT_LATTICE || scene->dimension < 2 ||
        !(body->spacing > 0))
        return false;
    box_grid(scene, grid);
    return !(body->jitter > 0) || cells_are_near(scene, grid);
}

size_t cloud_margin(const struct scene *scene)
{
    const struct body *body = &scene->body;
    size_t grid[3];
    const int last = scene->dimension - 1;
    if (!(body->jitter > 0)) return 0;
    box_grid(scene, grid);
    const double step = (body->high[last] - body->low[last]) / (double)grid[last];
    return (size_t)ceil((cells_radius(body, scene->dimension) + 2 * body->jitter * body->spacing) / step) + 1;
}

void cloud_place(const struct scene *scene, size_t point, double position[3])
{
    size_t grid[3];
    double place[3];
    box_grid(scene, grid);
    middle_of(scene, grid, point, place);
    if (scene->body.jitter > 0) move(&scene->body, (size_t)scene->dimension, point, place);
    body_to_deck(&scene->body, place, position);
}

selas_status cloud_create_planes(const struct scene *scene, size_t from, size_t end, struct cloud **cloud,
                                 struct messages *messages)
{
    size_t grid[3];
    *cloud = NULL;
    box_grid(scene, grid);
    selas_status status = box(scene, grid, from, end, cloud, messages);
    if (status != SELAS_OK || *cloud == NULL) return status;
    if (scene->body.jitter > 0) {
        jitter(*cloud, &scene->body);
        status = cloud_cells(*cloud, &scene->body, messages);
    }
    if (status == SELAS_OK) status = cloud_surface(*cloud, &scene->body, messages);
    if (status != SELAS_OK) cloud_free(cloud);
    return status;
}

/* Points of which none lies outside the box fill no more than it; those of a body with cavities fill less. */
static selas_status check_filling(const struct cloud *cloud, const struct body *body,
                                  struct messages *messages)
{
    const double filling = cloud_filling(cloud, body);
    if (filling < 1.02) return SELAS_OK;
    return fail(
        messages, SELAS_BAD_SCENE,
        "%s: the volumes of the points add up to %.4g times that of the box low .. high; expected at most "
        "1.02, as masses are density times volume",
        body->file != NULL ? body->file : "points of the host", filling);
}

selas_status cloud_create(const struct scene *scene, struct cloud **cloud, struct messages *messages)
{
    const struct body *body = &scene->body;
    *cloud = NULL;
    selas_status status = body->shape == BODY_POINTS ? SELAS_OK : check(scene, messages);
    if (status != SELAS_OK) return status;
    if (body->shape == BODY_POINTS) {
        status = cloud_read(scene, cloud, messages);
        if (status == SELAS_OK && *cloud != NULL) status = check_filling(*cloud, body, messages);
        if (status == SELAS_OK && *cloud != NULL) points_warn_of_spacing(*cloud, body, messages);
        if (status == SELAS_OK && *cloud != NULL && (*cloud)->elements > 0)
            points_warn_of_volumes(*cloud, body, messages);
        else if (status == SELAS_OK && *cloud != NULL && fabs(cloud_filling(*cloud, body) - 1) < 0.02)
            status = cloud_surface(*cloud, body, messages);
        if (status != SELAS_OK) cloud_free(cloud);
        return status;
    }
    if (body->shape == BODY_PLATE_WITH_HOLE)
        status = cloud_plate(body, cloud, messages);
    else {
        size_t grid[3];
        box_grid(scene, grid);
        status = box(scene, grid, 0, grid[scene->dimension - 1], cloud, messages);
    }
    if (status != SELAS_OK || *cloud == NULL) return status;
    (*cloud)->spacing = body->spacing;
    if (body->jitter > 0) jitter(*cloud, body);
    if (body->jitter > 0 || body->shape == BODY_PLATE_WITH_HOLE) status = cloud_cells(*cloud, body, messages);
    if (status == SELAS_OK) status = cloud_surface(*cloud, body, messages);
    if (status != SELAS_OK) cloud_free(cloud);
    return status;
}
