/* What a scene may be wrong in without being refused: warnings in the plan and the report, each with what
 * would be right (doc/results.md). */
#include "advice/parts.h"

#include "exact/half_space.h"
#include "scene/resolution.h"

#include <math.h>
#include <stdarg.h>
#include <string.h>

void advise(struct adviser *adviser, const char *format, ...)
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
static const double fewest = 4.0;

static void look_at_resolution(struct adviser *adviser)
{
    const double spacing = adviser->scene->body.spacing, points = points_per_wavelength(adviser->scene);
    if (points > 0.0 && points < fewest)
        advise(adviser,
               "%.3g points per wavelength of the slowest wave at the source's cutoff; %g need body%%spacing "
               "= %.3g or a smoother history",
               points, fewest, spacing * points / fewest);
}

/* exp(-(x/w)^2 / 2) has 5 % of its spectrum left at k w = 2.448, a wave of 2.567 w. */
static void look_at_start(struct adviser *adviser)
{
    const struct initial *initial = &adviser->scene->initial;
    const double spacing = adviser->scene->body.spacing;
    double wave = 0.0;
    if (initial->kind == INITIAL_PLANE_WAVE) wave = initial->wavelength;
    if (initial->kind == INITIAL_GAUSSIAN) wave = 2.567 * initial->width;
    if (wave > 0.0 && spacing > 0.0 && wave < fewest * spacing)
        advise(adviser, "%.3g points per wavelength of the initial state; %g need body%%spacing = %.3g",
               wave / spacing, fewest, wave / fewest);
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

double plane_of(const struct body *body, enum face face)
{
    return face_sign(face) < 0 ? body->low[face_axis(face)] : body->high[face_axis(face)];
}

static void look_at_receivers(struct adviser *adviser)
{
    const struct scene *scene = adviser->scene;
    const struct body *body = &scene->body;
    for (size_t r = 0; r < scene->receivers; r++)
        for (int face = 0; face < 2 * scene->dimension; face++) {
            if (!boundary_absorbs(&scene->boundary[face])) continue;
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

bool has_patch(const struct load *load)
{
    return load->kind == LOAD_TRACTION && (load->shape == LOAD_SQUARE || load->shape == LOAD_DISC);
}

double half_size(const struct load *load, int axis)
{
    if (load->shape == LOAD_DISC) return axis == face_axis(load->face) ? 0.0 : 0.5 * load->size[0];
    int place = 0;
    for (int c = 0; c < axis; c++)
        place += c != face_axis(load->face);
    return axis == face_axis(load->face) ? 0.0 : 0.5 * load->size[place];
}

/* Tractions on an absorbing face, and forces and moments right behind it. */
static void look_at_absorbers(struct adviser *adviser, size_t k)
{
    const struct scene *scene = adviser->scene;
    const struct load *load = &scene->load[k];
    double centre[3];
    if (load->kind == LOAD_TRACTION) {
        if (boundary_absorbs(&scene->boundary[load->face]))
            advise(adviser,
                   "load %zu acts on the absorbing face %s, which takes up part of it; a free face would not",
                   k + 1, face_name(load->face));
        return;
    }
    body_from_deck(&scene->body, load->centre, centre);
    for (int face = 0; face < 2 * scene->dimension && load->shape == LOAD_POINT; face++) {
        const double depth =
            fabs(centre[face_axis((enum face)face)] - plane_of(&scene->body, (enum face)face));
        if (boundary_absorbs(&scene->boundary[face]) && depth < 1.999 * scene->body.spacing)
            advise(adviser,
                   "load %zu acts at the absorbing face %s, which takes up part of it; two spacings (%.3g) "
                   "inside it "
                   "would not",
                   k + 1, face_name((enum face)face), 2.0 * scene->body.spacing);
    }
}

/* On the Mach lines of the Rayleigh wave displacements have kinks and velocities poles (doc/sources.md, Eq
 * 11). */
static void look_at_speed(struct adviser *adviser, size_t k)
{
    const struct scene *scene = adviser->scene;
    const struct load *load = &scene->load[k];
    const int down = scene->dimension - 1;
    double centre[3], speed = 0.0;
    for (int axis = 0; axis < 3; axis++)
        speed = hypot(speed, load->velocity[axis]);
    if (load->kind != LOAD_TRACTION || speed <= 0.0) return;
    body_from_deck(&scene->body, load->centre, centre);
    const double depth = fmax(0.0, centre[down] - scene->body.low[down]);
    const struct material *material = scene_material_at(scene, depth);
    struct half_space ground;
    half_space_set(&ground, material->density, material->plane_lambda, material->mu);
    if (speed > ground.rayleigh_speed)
        advise(adviser,
               "load %zu moves at %.4g, faster than the Rayleigh wave (%.4g): its Mach lines have velocities "
               "that no spacing resolves; compare displacements, or velocities through a window of some "
               "spacings, or move it slower",
               k + 1, speed, ground.rayleigh_speed);
}

size_t advice_tell(const struct scene *scene, const struct stepper *stepper,
                   void (*tell)(void *context, const char *key, const char *value), void *context)
{
    struct adviser adviser = {scene, tell, context, 0};
    look_at_resolution(&adviser);
    look_at_start(&adviser);
    look_at_step(&adviser, stepper);
    if (scene->body.shape != BODY_POINTS) look_at_mirrors(&adviser);
    if (!body_is_box(&scene->body)) return adviser.count;
    look_at_meetings(&adviser);
    look_at_receivers(&adviser);
    look_at_layers(&adviser, stepper);
    for (size_t k = 0; k < scene->loads; k++) {
        look_at_absorbers(&adviser, k);
        look_at_speed(&adviser, k);
        if (has_patch(&scene->load[k])) look_at_points(&adviser, stepper->model->patch, k);
    }
    return adviser.count;
}
