/* What a scene may be wrong in without being refused: warnings in the plan and the report, each with what
 * would be right (doc/results.md). */
#include "record/parts.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

struct adviser {
    const struct scene *scene;
    void (*tell)(void *context, const char *key, const char *value);
    void *context;
    size_t count;
};

__attribute__((format(printf, 2, 3))) static void advise(struct adviser *adviser, const char *format, ...)
{
    char text[512];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    if (adviser->tell != NULL) adviser->tell(adviser->context, "warning", text);
    adviser->count++;
}

/* Waves of fewer points are not waves but noise, whatever the method. */
static void look_at_resolution(struct adviser *adviser)
{
    static const double fewest = 4.0;
    const double spacing = adviser->scene->body.spacing, points = points_per_wavelength(adviser->scene);
    if (points > 0.0 && points < fewest)
        advise(adviser,
               "%.3g points per wavelength of the slowest wave at the source's cutoff; %g need body%%spacing "
               "= %.3g or a smoother history",
               points, fewest, spacing * points / fewest);
}

static void look_at_step(struct adviser *adviser, const struct stepper *stepper)
{
    static const double smallest = 0.1;
    const double part = stepper->dt / stepper->limit;
    if (stepper->limit > 0.0 && isfinite(stepper->limit) && part < smallest)
        advise(adviser,
               "the time step is only %.2g of the stability limit %.3g: %.0f times the steps that are "
               "needed; leave stepping%%time_step and courant out",
               part, stepper->limit, 0.9 / part);
}

static double plane_of(const struct body *body, enum face face)
{
    return face_sign(face) < 0 ? body->low[face_axis(face)] : body->high[face_axis(face)];
}

static bool is_box(const struct body *body)
{
    return body->shape == BODY_BOX || body->shape == BODY_HALF_SPACE;
}

static void look_at_receivers(struct adviser *adviser)
{
    const struct scene *scene = adviser->scene;
    const struct body *body = &scene->body;
    for (size_t r = 0; r < scene->receivers; r++)
        for (int face = 0; face < 2 * scene->dimension; face++) {
            if (scene->boundary[face].kind != BOUNDARY_TRANSMITTING) continue;
            double place[3];
            body_from_deck(body, scene->receiver[r].position, place);
            const double depth = fabs(place[face_axis((enum face)face)] - plane_of(body, (enum face)face));
            if (depth < 0.999 * body->spacing)
                advise(adviser,
                       "receiver '%s' lies at the absorbing face %s and sees what it does to waves; two "
                       "spacings (%.3g) inside it would not",
                       scene->receiver[r].name, face_name((enum face)face), 2.0 * body->spacing);
        }
}

static bool has_patch(const struct load *load)
{
    return load->kind == LOAD_TRACTION && (load->shape == LOAD_SQUARE || load->shape == LOAD_DISC);
}

/* Half the patch's extent along an axis; 0 across its face. */
static double half_size(const struct load *load, int axis)
{
    if (load->shape == LOAD_DISC) return axis == face_axis(load->face) ? 0.0 : 0.5 * load->size[0];
    int place = 0;
    for (int c = 0; c < axis; c++)
        place += c != face_axis(load->face);
    return axis == face_axis(load->face) ? 0.0 : 0.5 * load->size[place];
}

/* Methods that press points one by one see a patch only as wide as the points in it. */
static void look_at_lattice(struct adviser *adviser, size_t k)
{
    const struct scene *scene = adviser->scene;
    const struct load *load = &scene->load[k];
    const struct body *body = &scene->body;
    if (load->shape != LOAD_SQUARE || strcmp(scene->method.variant, "paper") != 0) return;
    double centre[3];
    body_from_deck(body, load->centre, centre);
    for (int axis = 0; axis < scene->dimension; axis++) {
        const double half = half_size(load, axis);
        const double low = (centre[axis] - half - body->low[axis]) / body->spacing;
        const double high = (centre[axis] + half - body->low[axis]) / body->spacing;
        if (half <= 0.0 || (fabs(low - round(low)) < 1e-6 && fabs(high - round(high)) < 1e-6)) continue;
        advise(adviser, "the edges of load %zu along %c lie between points; %.6g to %.6g would lie on them",
               k + 1, "xyz"[axis], body -> low[axis] + body -> spacing *round(low),
               body -> low[axis] + body -> spacing *round(high));
    }
}

/* The image of a load behind a mirror plane must go on where the load ends. */
static void look_at_mirrors(struct adviser *adviser, size_t k)
{
    const struct scene *scene = adviser->scene;
    const struct load *load = &scene->load[k];
    double centre[3], direction[3];
    body_from_deck(&scene->body, load->centre, centre);
    body_direction_from_deck(&scene->body, load->direction, direction);
    for (int face = 0; face < 2 * scene->dimension; face++) {
        const int axis = face_axis((enum face)face);
        if (scene->boundary[face].kind != BOUNDARY_SYMMETRY || axis == face_axis(load->face)) continue;
        const double plane = plane_of(&scene->body, (enum face)face);
        const double off = fabs(centre[axis] - plane), half = half_size(load, axis);
        if (off >= half) continue; /* not cut */
        if (off > 1e-6 * half)
            advise(adviser,
                   "the symmetry plane %s cuts load %zu beside its middle: it and its image are no such "
                   "patch; %c = %.6g would be its middle",
                   face_name((enum face)face), k + 1, "xyz"[axis], plane);
        if (fabs(direction[axis]) > 1e-6)
            advise(adviser,
                   "load %zu pushes across the symmetry plane %s that cuts it, where its image pushes back; "
                   "a load along the plane, or the whole body, would be right",
                   k + 1, face_name((enum face)face));
    }
}

size_t advice_tell(const struct scene *scene, const struct stepper *stepper,
                   void (*tell)(void *context, const char *key, const char *value), void *context)
{
    struct adviser adviser = {scene, tell, context, 0};
    look_at_resolution(&adviser);
    look_at_step(&adviser, stepper);
    if (!is_box(&scene->body)) return adviser.count;
    look_at_receivers(&adviser);
    for (size_t k = 0; k < scene->loads; k++) {
        const struct load *load = &scene->load[k];
        if (load->kind == LOAD_TRACTION && (int)load->face < BOX_FACES &&
            scene->boundary[load->face].kind == BOUNDARY_TRANSMITTING)
            advise(&adviser,
                   "load %zu acts on the absorbing face %s, which takes up part of it; a free face would not",
                   k + 1, face_name(load->face));
        if (!has_patch(load)) continue;
        look_at_lattice(&adviser, k);
        look_at_mirrors(&adviser, k);
    }
    return adviser.count;
}
