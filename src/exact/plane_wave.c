/* Exact solution 'plane-wave': d'Alembert's, in two settings (doc/theory/initial-states.md, section 3).
 *
 * Along an axis of the box everything depends on one coordinate: a bar with two ends, which reflect and send
 * waves (exact/dalembert.c). It holds for all time where the other faces do not disturb the wave: rollers and
 * mirrors beside a P wave; beside an S wave free faces, rollers and mirrors across its polarisation, and
 * along it faces that hold the component along the direction alone.
 *
 * In any other direction, and beside faces that disturb, the wave of an infinite solid is right at a place
 * until the fastest wave from the nearest disturbing face can have arrived: distance / p_speed. */
#include "exact/plane_wave.h"
#include "base/memory.h"
#include "exact/dalembert.h"
#include "scene/initial.h"

#include <math.h>
#include <stdio.h>

struct plane_wave {
    struct exact exact;
    bool along; /* the direction is along an axis of the box */
    bool shear;
    int axis;               /* of the body's frame, along which the wave travels */
    int motion;             /* axis of the body along which it moves, -1: none */
    double sign;            /* of the initial wave's direction along the axis */
    double polarisation[3]; /* deck */
    struct bar bar;
    double origin; /* initial: where the phase is 0, along the axis */
    double part;   /* initial: component of a gaussian or a velocity along the polarisation */
    bool disturbs[BOX_FACES];
};

/* Axis of the body along which a direction of the deck lies, with its sign; -1: none. */
static int axis_of(const struct body *body, const double direction[3], double *sign)
{
    double own[3];
    body_direction_from_deck(body, direction, own);
    for (int c = 0; c < 3; c++)
        if (fabs(own[c]) > 1 - 1e-12) {
            *sign = own[c] < 0 ? -1 : 1;
            return c;
        }
    return -1;
}

static double component(const double one[3], const double other[3])
{
    return one[0] * other[0] + one[1] * other[1] + one[2] * other[2];
}

/* The initial waves f and g of the bar. */
static double initial_wave(const void *context, bool rightward, double x, int derivative)
{
    const struct plane_wave *wave = context;
    const struct initial *initial = &wave->exact.scene->initial;
    const double half = rightward ? -.5 : .5;
    switch (initial->kind) {
    case INITIAL_PLANE_WAVE: {
        if (rightward != (wave->sign > 0)) return 0;
        const double value = plane_wave_shape(initial, wave->sign * (x - wave->origin), derivative);
        return derivative == 0 ? value : wave->sign * value;
    }
    case INITIAL_GAUSSIAN: { /* at rest: both halves alike */
        const double r = (x - wave->origin) / initial->width;
        const double value = wave->part * exp(-r * r / 2) / 2;
        return derivative == 0 ? value : -r / initial->width * value;
    }
    case INITIAL_UNIFORM_VELOCITY: { /* f = -V / (2c), g = V / (2c), V the integral of v from the low end */
        const double slope = half * wave->part / wave->bar.speed;
        return derivative == 0 ? slope * (x - wave->bar.low.place) : slope;
    }
    default:
        return 0;
    }
}

/* True if a face beside the wave (its normal across the direction) leaves it as it is. */
static bool lets_pass(const struct plane_wave *wave, enum face face)
{
    const struct scene *scene = wave->exact.scene;
    const struct boundary *boundary = &scene->boundary[face];
    double sign;
    if (!wave->shear) return boundary_slides(boundary);
    if (wave->motion < 0) return false;
    if (face_axis(face) != wave->motion) return boundary_slides(boundary) || boundary_is_free(boundary);
    return boundary_moves(boundary) && boundary->slip && boundary->amplitude == 0 &&
           axis_of(&scene->body, boundary->direction, &sign) == wave->axis;
}

/* The share of the arriving wave that an end sends back: displacement held -1, traction held 1, with a damper
 * of `factor` times the impedance (1 - factor) / (1 + factor). */
static double damping(const struct plane_wave *wave, const struct boundary *boundary)
{
    if (boundary_has_layer(boundary)) return 1;
    if (!boundary_damps(boundary)) return 0;
    return wave->shear ? boundary->shear_factor : boundary->normal_factor;
}

static bool holds(const struct plane_wave *wave, const struct boundary *boundary)
{
    return boundary_is_fixed(boundary) || boundary_moves(boundary) ||
           (boundary_slides(boundary) && !wave->shear);
}

static selas_status fill_end(struct plane_wave *wave, enum face face, struct bar_end *end,
                             struct messages *messages)
{
    const struct scene *scene = wave->exact.scene;
    const struct boundary *boundary = &scene->boundary[face];
    const struct material *material = &scene->material[scene->body.material];
    const double alpha = damping(wave, boundary);
    end->place = face_plane(&scene->body, face);
    end->reflection = holds(wave, boundary) ? -1 : (1 - alpha) / (1 + alpha);
    end->source = array_new(scene->loads + 1, sizeof *end->source);
    if (end->source == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the exact solution");
    if (boundary_moves(boundary)) {
        const double along = component(boundary->direction, wave->polarisation);
        if (boundary->amplitude != 0 && fabs(along) < 1 - 1e-9)
            return fail(messages, SELAS_BAD_SCENE,
                        "no plane wave: the face '%s' moves in another direction than the wave",
                        face_name(face));
        end->source[end->sources++] = (struct bar_source){&boundary->history, boundary->amplitude * along,
                                                          -boundary_meaning(boundary)->motion};
    }
    if (holds(wave, boundary)) return SELAS_OK; /* a load on a held end does nothing */
    for (size_t i = 0; i < scene->loads; i++) {
        const struct load *load = &scene->load[i];
        if (load->face != face) continue;
        const double along = component(load->direction, wave->polarisation);
        end->source[end->sources++] = (struct bar_source){
            &load->history, load->amplitude * along / (material->density * wave->bar.speed * (1 + alpha)),
            -1};
    }
    return SELAS_OK;
}

/* Loads must be tractions on the whole of an end, along the wave's motion. */
static selas_status check_loads(const struct plane_wave *wave, struct messages *messages)
{
    const struct scene *scene = wave->exact.scene;
    for (size_t i = 0; i < scene->loads; i++) {
        const struct load *load = &scene->load[i];
        if (load->amplitude == 0) continue;
        if (load->kind != LOAD_TRACTION || load->shape != LOAD_FACE || !wave->along ||
            face_axis(load->face) != wave->axis ||
            fabs(component(load->direction, wave->polarisation)) < 1 - 1e-9)
            return fail(
                messages, SELAS_BAD_SCENE,
                "no plane wave: &load %zu is not a traction on the whole of an end along the wave's motion",
                scene->load[i].group + 1);
    }
    return SELAS_OK;
}

/* Direction and motion of the wave that a load or a moving face sends into a body at rest. */
static bool find_sender(struct plane_wave *wave)
{
    const struct scene *scene = wave->exact.scene;
    const double *direction = NULL;
    double sign = 1;
    for (int face = 0; face < 2 * scene->dimension && direction == NULL; face++)
        if (boundary_moves(&scene->boundary[face]) && scene->boundary[face].amplitude != 0) {
            direction = scene->boundary[face].direction;
            wave->axis = face_axis((enum face)face);
        }
    if (direction == NULL && scene->loads > 0 && scene->load[0].kind == LOAD_TRACTION) {
        direction = scene->load[0].direction;
        wave->axis = face_axis(scene->load[0].face);
    }
    if (direction == NULL) return false;
    wave->motion = axis_of(&scene->body, direction, &sign);
    if (wave->motion < 0) return false;
    wave->shear = wave->motion != wave->axis;
    wave->along = true;
    for (int c = 0; c < 3; c++)
        wave->polarisation[c] = sign * direction[c];
    return true;
}

/* Which wave the scene has: its direction, its motion. */
static selas_status find_wave(struct plane_wave *wave, struct messages *messages)
{
    const struct scene *scene = wave->exact.scene;
    const struct initial *initial = &scene->initial;
    double sign = 1, centre[3];
    body_from_deck(&scene->body, initial->centre, centre);
    wave->sign = 1;
    if (initial->kind == INITIAL_PLANE_WAVE) {
        wave->axis = axis_of(&scene->body, initial->direction, &wave->sign);
        wave->along = wave->axis >= 0;
        wave->shear = initial->shear;
        wave->motion = axis_of(&scene->body, initial->polarisation, &sign);
        for (int c = 0; c < 3; c++)
            wave->polarisation[c] = initial->polarisation[c];
        if (wave->along) wave->origin = centre[wave->axis];
        return SELAS_OK;
    }
    if (scene->dimension == 1) {
        wave->along = true;
        wave->polarisation[0] = 1;
        wave->origin = centre[0];
        if (initial->kind == INITIAL_GAUSSIAN) wave->part = initial->amplitude * initial->direction[0];
        if (initial->kind == INITIAL_UNIFORM_VELOCITY) wave->part = initial->velocity[0];
        return SELAS_OK;
    }
    if (initial->kind == INITIAL_REST && find_sender(wave)) return SELAS_OK;
    return fail(
        messages, SELAS_BAD_SCENE,
        "no plane wave: the scene has none at t = 0 (&initial kind = 'plane-wave'), nor does a whole face "
        "send one along an axis of the body into a body at rest");
}

/* Time until which the solution is right at a place; INFINITY if always. */
static double valid_until(const struct plane_wave *wave, const double position[3])
{
    const struct scene *scene = wave->exact.scene;
    const struct body *body = &scene->body;
    double own[3], distance = INFINITY;
    body_from_deck(body, position, own);
    for (int face = 0; face < 2 * scene->dimension; face++) {
        const int axis = face / 2;
        if (!wave->disturbs[face]) continue;
        distance = fmin(distance, face % 2 == 0 ? own[axis] - body->low[axis] : body->high[axis] - own[axis]);
    }
    return fmax(0, distance) / scene->material[body->material].p_speed;
}

double plane_wave_until(const struct exact *exact, const double position[3])
{
    return valid_until((const struct plane_wave *)exact, position);
}

static selas_status check_place(const struct plane_wave *wave, const double position[3],
                                struct messages *messages)
{
    const double tolerance = 1e-6 * wave->exact.scene->body.spacing /
                             wave->exact.scene->material[wave->exact.scene->body.material].p_speed;
    if (valid_until(wave, position) > tolerance) return SELAS_OK;
    return fail(
        messages, SELAS_BAD_SCENE,
        "the plane wave is disturbed from the start at %g, %g, %g, on a face that changes it; move the "
        "receiver inside, or make the face one that lets the wave pass (a roller beside a P wave)",
        position[0], position[1], position[2]);
}

static void destroy(struct exact *exact)
{
    struct plane_wave *wave = (struct plane_wave *)exact;
    array_free(wave->bar.low.source);
    array_free(wave->bar.high.source);
    array_free(wave);
}

static selas_status prepare(struct plane_wave *wave, struct messages *messages)
{
    const struct scene *scene = wave->exact.scene;
    if (!body_is_box(&scene->body))
        return fail(messages, SELAS_BAD_SCENE, "the exact plane wave needs a body of shape 'box'");
    if (scene->body.layers > 0)
        return fail(messages, SELAS_BAD_SCENE, "the exact plane wave needs a body without layers");
    if (scene_check_faces(scene, CAN_HOLD | CAN_MOVE | CAN_MIRROR | CAN_DAMP | CAN_ABSORB,
                          "the exact plane wave", messages) != SELAS_OK)
        return SELAS_BAD_SCENE;
    selas_status status = find_wave(wave, messages);
    if (status == SELAS_OK) status = check_loads(wave, messages);
    if (status != SELAS_OK) return status;
    const struct material *material = &scene->material[scene->body.material];
    wave->bar.speed = wave->shear ? material->s_speed : material->p_speed;
    wave->bar.wave = initial_wave;
    wave->bar.context = wave;
    for (int face = 0; face < 2 * scene->dimension; face++)
        wave->disturbs[face] = !wave->along || (face / 2 != wave->axis && !lets_pass(wave, (enum face)face));
    if (wave->along) {
        status = fill_end(wave, (enum face)(2 * wave->axis), &wave->bar.low, messages);
        if (status == SELAS_OK)
            status = fill_end(wave, (enum face)(2 * wave->axis + 1), &wave->bar.high, messages);
    }
    for (size_t i = 0; i < scene->receivers && status == SELAS_OK; i++)
        status = check_place(wave, scene->receiver[i].position, messages);
    return status;
}

static selas_status create(const struct scene *scene, struct exact **exact, struct messages *messages)
{
    struct plane_wave *wave = array_new(1, sizeof *wave);
    *exact = NULL;
    if (wave == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the exact solution");
    wave->exact = (struct exact){.class = &exact_plane_wave, .scene = scene};
    const selas_status status = prepare(wave, messages);
    if (status != SELAS_OK)
        destroy(&wave->exact);
    else
        *exact = &wave->exact;
    return status;
}

/* Displacement (0) or velocity (1) along the polarisation. */
static double value_at(const struct plane_wave *wave, const double position[3], double t, int derivative)
{
    const struct scene *scene = wave->exact.scene;
    if (wave->along) {
        double own[3];
        body_from_deck(&scene->body, position, own);
        const double x = fmin(fmax(own[wave->axis], wave->bar.low.place), wave->bar.high.place);
        return bar_value(&wave->bar, x, t, derivative);
    }
    const struct initial *initial = &scene->initial;
    const double c = wave->bar.speed;
    double s = -c * t;
    for (int k = 0; k < 3; k++)
        s += initial->direction[k] * (position[k] - initial->centre[k]);
    return (derivative == 0 ? 1 : -c) * plane_wave_shape(initial, s, derivative);
}

static selas_status history(struct exact *exact, const double position[3], size_t n, const double *time,
                            double *value, struct messages *messages)
{
    const struct plane_wave *wave = (const struct plane_wave *)exact;
    const selas_status status = check_place(wave, position, messages);
    if (status != SELAS_OK) return status;
    for (size_t i = 0; i < n; i++) {
        const double u = value_at(wave, position, time[i], 0), v = value_at(wave, position, time[i], 1);
        for (int c = 0; c < 3; c++) {
            value[6 * i + (size_t)c] = u * wave->polarisation[c];
            value[6 * i + 3 + (size_t)c] = v * wave->polarisation[c];
        }
    }
    return SELAS_OK;
}

static void describe(const struct exact *exact,
                     void (*tell)(void *context, const char *key, const char *value), void *context)
{
    const struct plane_wave *wave = (const struct plane_wave *)exact;
    const struct scene *scene = exact->scene;
    char text[192];
    double until = INFINITY;
    size_t first = 0;
    tell(context, "exact solution",
         wave->along ? "plane wave by d'Alembert, reflections by images" : "plane wave of an infinite solid");
    for (size_t i = 0; i < scene->receivers; i++)
        if (valid_until(wave, scene->receiver[i].position) < until) {
            until = valid_until(wave, scene->receiver[i].position);
            first = i;
        }
    if (isinf(until))
        snprintf(text, sizeof text, "all times");
    else
        snprintf(text, sizeof text, "t = %.6g at receiver %s, when the faces can be felt%s", until,
                 scene->receiver[first].name, until < scene->end_time ? " (before end_time)" : "");
    tell(context, "exact until", text);
}

const struct exact_class exact_plane_wave = {
    .kind = "plane-wave",
    .create = create,
    .destroy = destroy,
    .history = history,
    .describe = describe,
};
