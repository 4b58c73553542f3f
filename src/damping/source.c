/* Every source counts as the force that would send as much of a wave far away: a moment M as the force M w/c, a moved
 * face of the edge L as rho c^2 L^(d-2) times its displacement. */
#include "damping/source.h"

#include "scene/resolution.h"

#include <math.h>

/* A force (of a face: in its place) and the power of the frequency that makes a velocity of its history. */
struct source {
    const struct history *history;
    double force;
    int derivatives;
};

static double edge(const struct body *body, int axis)
{
    const double length = body->high[axis] - body->low[axis];
    return isfinite(length) && length > 0 ? length : 1;
}

/* Of the body's edges but that along `left_out` (-1: of all). */
static double extent(const struct scene *scene, int left_out)
{
    double product = 1;
    for (int axis = 0; axis < scene->dimension; axis++)
        if (axis != left_out) product *= edge(&scene->body, axis);
    return product;
}

/* Of the slowest wave; 1 where there is none. */
static double speed_of(const struct scene *scene)
{
    const double speed = slowest_speed(scene);
    return isfinite(speed) && speed > 0 ? speed : 1;
}

/* What an amplitude of 1 acts on: area, volume, or 1. */
static double measure(const struct scene *scene, const struct load *load)
{
    const bool plane = scene->dimension == 2;
    if (load->kind == LOAD_MOMENT_TENSOR || load->shape == LOAD_POINT || scene->dimension == 1) return 1;
    if (load->kind == LOAD_BODY_FORCE) return extent(scene, -1);
    if (load->face == FACE_HOLE) return 2 * M_PI * scene->body.hole_radius;
    if (load->shape == LOAD_FACE) return extent(scene, face_axis(load->face));
    if (load->shape == LOAD_DISC) return plane ? load->size[0] : M_PI / 4 * load->size[0] * load->size[0];
    return plane ? load->size[0] : load->size[0] * load->size[1];
}

/* Length of a moment tensor: xx yy zz xy yz zx. */
static double moment_size(const double moment[6])
{
    double sum = 0;
    for (int i = 0; i < 6; i++)
        sum += (i < 3 ? 1 : 2) * moment[i] * moment[i];
    return sqrt(sum);
}

static struct source source_of_load(const struct scene *scene, const struct load *load)
{
    struct source source = {&load->history, fabs(load->amplitude) * measure(scene, load), 1};
    if (load->kind != LOAD_MOMENT_TENSOR) return source;
    source.force *= moment_size(load->moment) / speed_of(scene);
    source.derivatives = 2;
    return source;
}

/* Largest value of a table; 1 of what is made by a formula. */
static double largest_value(const struct history *history)
{
    double largest = history->kind == HISTORY_TABLE ? 0 : 1;
    for (size_t i = 0; history->kind == HISTORY_TABLE && i < history->rows; i++)
        largest = fmax(largest, fabs(history->table_value[i]));
    return largest;
}

static bool stays(const struct history *history)
{
    const double end = history_end(history);
    return !isfinite(end) || fabs(history_value(history, end, 0)) > 1e-6 * largest_value(history);
}

/* A function that stays counts by its rate: no integral of it has a spectrum. */
static struct source source_of_face(const struct scene *scene, enum face face)
{
    const struct boundary *boundary = &scene->boundary[face];
    const double area = extent(scene, face_axis(face)), speed = speed_of(scene),
                 density = scene->materials > 0 ? scene->material[0].density : 1,
                 length = scene->dimension == 3 ? sqrt(area) : edge(&scene->body, 0);
    const int order = 1 - boundary_meaning(boundary)->motion, least = stays(&boundary->history) ? 1 : 0;
    return (struct source){&boundary->history,
                           fabs(boundary->amplitude) * density * speed * speed *
                               pow(length, scene->dimension - 2),
                           order > least ? order : least};
}

/* Of the index'th of all loads and, behind them, faces; one that does nothing has no force. */
static struct source source_at(const struct scene *scene, size_t index)
{
    if (index < scene->loads) return source_of_load(scene, &scene->load[index]);
    const enum face face = (enum face)(index - scene->loads);
    const struct boundary *boundary = &scene->boundary[face];
    return boundary_acts(boundary) ? source_of_face(scene, face) : (struct source){&boundary->history, 0, 1};
}

static double part_of(const struct source *source, double w)
{
    return source->force * pow(w, source->derivatives) * cabs(history_laplace_uncut(source->history, I * w));
}

double source_power(const void *data, double angular_frequency)
{
    const struct scene *scene = data;
    double sum = 0;
    for (size_t i = 0; i < scene->loads + FACES; i++) {
        const struct source source = source_at(scene, i);
        if (source.force > 0) sum += pow(part_of(&source, angular_frequency), 2);
    }
    return sum;
}

/* As a force, at the frequency of its history. */
static double strength(const struct scene *scene, const struct source *source)
{
    if (!(source->force > 0)) return 0;
    const double w = source->history->rate > 0 ? source->history->rate : 1 / scene->end_time;
    return source->force * largest_value(source->history) * pow(w, source->derivatives - 1);
}

double source_top(const struct scene *scene, double fraction)
{
    double top = 0, strongest = 0, taken = 0;
    const struct history *last = NULL;
    if (scene_driven(scene)) return INFINITY;
    for (size_t i = 0; i < scene->loads + FACES; i++) {
        const struct source source = source_at(scene, i);
        strongest = fmax(strongest, strength(scene, &source));
    }
    for (size_t i = 0; i < scene->loads + FACES; i++) {
        const struct source source = source_at(scene, i);
        const double own = strength(scene, &source);
        if (own <= fraction * strongest) continue;
        if (last != NULL && taken >= own && history_alike(last, source.history)) continue;
        top = fmax(top, history_cutoff(source.history, fraction * strongest / own));
        last = source.history; /* many sources of a list have one history */
        taken = own;
    }
    return top;
}
