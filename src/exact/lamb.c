/* Reference 'lamb': the infinite half-space under the scene's traction loads (Lamb 1904), computed by
 * exact/lamb_fft.c. This file turns the scene into that problem: the body's frame, mirror images at symmetry
 * planes, whole-face loads (plane waves), and refuses what has no such solution. */

#include "base/memory.h"
#include "exact/exact.h"
#include "exact/ground.h"
#include "exact/lamb_fft.h"
#include "exact/lamb_moving.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

extern const struct exact_class exact_lamb;

struct lamb {
    struct exact exact;
    struct lamb_problem problem;
    struct layered *layers; /* NULL: homogeneous */
    struct lamb_load *load; /* patches, images included */
    size_t planes;
    struct lamb_load *plane; /* loads of the whole face */
    size_t patches;          /* that move; their histories by a problem without loads */
    struct moving_patch *patch;
    struct lamb_problem unloaded;
    struct lamb_signal *moved; /* of the scene's receivers */
    size_t signals;
    struct lamb_signal *signal; /* of the scene's receivers */
};

static selas_status refuse(struct messages *messages, const char *why)
{
    return fail(messages, SELAS_BAD_SCENE, "reference 'lamb': %s", why);
}

static selas_status check_load(const struct scene *scene, const struct load *load, struct messages *messages)
{
    if (load->kind != LOAD_TRACTION)
        return refuse(messages, "only traction loads; body forces and moment tensors have another solution");
    if (load->face != FACE_Z_LOW) return refuse(messages, "loads must act on the free surface, face = 'z-'");
    if (load->shape == LOAD_FACE && scene->body.layers > 0)
        return refuse(messages, "a load of the whole face is not offered on layers");
    if (load_moves(load) && (scene_needs(scene) & CAN_MIRROR) != 0)
        return refuse(messages, "a moving patch is not offered with symmetry planes");
    return SELAS_OK;
}

static selas_status check_scene(const struct scene *scene, struct messages *messages)
{
    selas_status status = ground_check(scene, "lamb", messages);
    for (size_t i = 0; i < scene->loads && status == SELAS_OK; i++)
        status = check_load(scene, &scene->load[i], messages);
    return status;
}

static void set_load(const struct scene *scene, const struct load *load, struct lamb_load *out)
{
    double centre[3], direction[3];
    ground_position(scene, load->centre, centre);
    body_direction_from_deck(&scene->body, load->direction, direction);
    *out = (struct lamb_load){.history = &load->history};
    out->patch.centre[0] = centre[0];
    out->patch.centre[1] = centre[1];
    out->patch.shape = load->shape == LOAD_SQUARE ? PATCH_RECTANGLE
                       : load->shape == LOAD_DISC ? PATCH_DISC
                                                  : PATCH_POINT;
    if (load->shape == LOAD_SQUARE) {
        out->patch.half[0] = .5 * load->size[0];
        out->patch.half[1] = .5 * load->size[1];
    }
    if (load->shape == LOAD_DISC) out->patch.half[0] = out->patch.half[1] = .5 * load->size[0];
    for (int i = 0; i < 3; i++) {
        out->traction[i] = load->amplitude * direction[i];
        if (fabs(direction[i]) < 1e-14) out->traction[i] = 0;
    }
}

/* Mirror images of loads [0, *count) at the symmetry plane of an axis, if there is one. */
static selas_status add_images(const struct scene *scene, int axis, struct lamb_load *load, size_t *count,
                               struct messages *messages)
{
    const bool low = boundary_mirrors(&scene->boundary[2 * axis]);
    if (!low && !boundary_mirrors(&scene->boundary[2 * axis + 1])) return SELAS_OK;
    const double plane = low ? scene->body.low[axis] : scene->body.high[axis];
    const double size = scene->body.high[axis] - scene->body.low[axis];
    const size_t before = *count;
    for (size_t i = 0; i < before; i++) {
        const double away = fabs(load[i].patch.centre[axis] - plane);
        if (away < 1e-9 * size) {
            if (load[i].traction[axis] != 0)
                return refuse(messages, "a load on a symmetry plane cannot act across it");
            continue;
        }
        if (away < load[i].patch.half[axis] * (1 - 1e-9))
            return refuse(messages, "a symmetry plane may cut a load only through its centre");
        load[*count] = load[i];
        load[*count].patch.centre[axis] = 2 * plane - load[i].patch.centre[axis];
        load[*count].traction[axis] = -load[i].traction[axis];
        ++*count;
    }
    return SELAS_OK;
}

static selas_status set_loads(struct lamb *lamb, const struct scene *scene, struct messages *messages)
{
    lamb->load = array_new(4 * scene->loads, sizeof *lamb->load);
    lamb->plane = array_new(scene->loads, sizeof *lamb->plane);
    lamb->patch = array_new(scene->loads, sizeof *lamb->patch);
    if (lamb->load == NULL || lamb->plane == NULL || lamb->patch == NULL)
        return fail(messages, SELAS_NO_MEMORY, "not enough memory for the reference 'lamb'");
    size_t count = 0;
    for (size_t i = 0; i < scene->loads; i++) {
        const struct load *load = &scene->load[i];
        if (load_moves(load)) {
            struct moving_patch *patch = &lamb->patch[lamb->patches++];
            double velocity[3];
            set_load(scene, load, &patch->load);
            body_direction_from_deck(&scene->body, load->velocity, velocity);
            memcpy(patch->velocity, velocity, sizeof patch->velocity);
        } else {
            set_load(scene, load,
                     load->shape == LOAD_FACE ? &lamb->plane[lamb->planes++] : &lamb->load[count++]);
        }
    }
    for (int axis = 0; axis < 2; axis++) {
        const selas_status status = add_images(scene, axis, lamb->load, &count, messages);
        if (status != SELAS_OK) return status;
    }
    lamb->problem.loads = count;
    lamb->problem.load = lamb->load;
    lamb->unloaded = (struct lamb_problem){.ground = lamb->problem.ground, .layers = lamb->problem.layers};
    return SELAS_OK;
}

/* A point of a point load has no value. */
static selas_status check_position(const struct lamb *lamb, const double position[3],
                                   struct messages *messages)
{
    if (position[2] < 0) return refuse(messages, "a receiver lies above the ground");
    for (size_t i = 0; i < lamb->problem.loads; i++) {
        const struct patch *patch = &lamb->load[i].patch;
        if (patch->shape == PATCH_POINT && position[2] == 0 && position[0] == patch->centre[0] &&
            position[1] == patch->centre[1])
            return refuse(messages, "the displacement right under a point load is infinite");
    }
    return SELAS_OK;
}

/* Histories at n places, of loads at rest and of those that move. */
static selas_status compute(const struct lamb *lamb, double end_time, size_t n, struct lamb_signal *signal,
                            struct lamb_signal *moved, struct messages *messages)
{
    selas_status status = SELAS_OK;
    if (lamb->problem.loads > 0) status = lamb_fft(&lamb->problem, end_time, n, signal, messages);
    if (status == SELAS_OK && lamb->patches > 0) {
        for (size_t i = 0; i < n; i++)
            memcpy(moved[i].position, signal[i].position, sizeof moved[i].position);
        status = lamb_moving(&lamb->unloaded, lamb->patches, lamb->patch, end_time, n, moved, true, messages);
        for (size_t i = 0; i < n && status != SELAS_OK; i++)
            lamb_signal_free(&signal[i]);
        for (size_t i = 0; i < n && status == SELAS_OK; i++)
            signal[i].end_time = end_time;
    }
    return status;
}

static selas_status set_receivers(struct lamb *lamb, const struct scene *scene, struct messages *messages)
{
    lamb->signal = array_new(scene->receivers, sizeof *lamb->signal);
    lamb->moved = array_new(scene->receivers, sizeof *lamb->moved);
    if (lamb->signal == NULL || lamb->moved == NULL)
        return fail(messages, SELAS_NO_MEMORY, "not enough memory for the reference 'lamb'");
    for (size_t i = 0; i < scene->receivers; i++) {
        ground_position(scene, scene->receiver[i].position, lamb->signal[i].position);
        const selas_status status = check_position(lamb, lamb->signal[i].position, messages);
        if (status != SELAS_OK) return status;
    }
    return lamb_moving(&lamb->unloaded, lamb->patches, lamb->patch, scene->end_time, scene->receivers,
                       lamb->signal, false, messages);
}

static selas_status compute_receivers(struct exact *exact, struct messages *messages)
{
    struct lamb *lamb = (struct lamb *)exact;
    const struct scene *scene = exact->scene;
    if (scene->receivers == 0) return SELAS_OK;
    const selas_status status =
        compute(lamb, scene->end_time, scene->receivers, lamb->signal, lamb->moved, messages);
    if (status == SELAS_OK && lamb->problem.loads + lamb->patches > 0) lamb->signals = scene->receivers;
    return status;
}

static void destroy(struct exact *exact)
{
    struct lamb *lamb = (struct lamb *)exact;
    for (size_t i = 0; i < lamb->signals; i++) {
        lamb_signal_free(&lamb->signal[i]);
        lamb_signal_free(&lamb->moved[i]);
    }
    array_free(lamb->signal);
    array_free(lamb->moved);
    array_free(lamb->patch);
    array_free(lamb->load);
    array_free(lamb->plane);
    layered_free(&lamb->layers);
    array_free(lamb);
}

static selas_status create(const struct scene *scene, struct exact **exact, struct messages *messages)
{
    *exact = NULL;
    selas_status status = check_scene(scene, messages);
    if (status != SELAS_OK) return status;
    struct lamb *lamb = array_new(1, sizeof *lamb);
    if (lamb == NULL) return fail(messages, SELAS_NO_MEMORY, "not enough memory for the reference 'lamb'");
    lamb->exact.class = &exact_lamb;
    lamb->exact.scene = scene;
    lamb->problem.tolerance = scene->reference.tolerance;
    const struct material *material = scene_material_at(scene, 0);
    half_space_set(&lamb->problem.ground, material->density, material->lambda, material->mu);
    if (scene->body.layers > 0) status = layered_create(scene, &lamb->layers, messages);
    lamb->problem.layers = lamb->layers;
    if (status == SELAS_OK) status = set_loads(lamb, scene, messages);
    if (status == SELAS_OK) status = set_receivers(lamb, scene, messages);
    if (status != SELAS_OK) {
        destroy(&lamb->exact);
        return status;
    }
    *exact = &lamb->exact;
    return SELAS_OK;
}

static void add_plane_wave(const struct half_space *ground, const struct lamb_load *load, double z, double t,
                           double value[6])
{
    for (int i = 0; i < 3; i++) {
        const double speed = i == 2 ? ground->p_speed : ground->s_speed;
        const double factor = load->traction[i] / (ground->density * speed);
        if (factor == 0) continue;
        value[i] += factor * history_value(load->history, t - z / speed, -1);
        value[3 + i] += factor * history_value(load->history, t - z / speed, 0);
    }
}

static void evaluate(const struct lamb *lamb, const struct lamb_signal *signal,
                     const struct lamb_signal *moved, size_t n, const double *time, double *value)
{
    for (size_t i = 0; i < n; i++) {
        double body[6] = {0}, more[6] = {0};
        if (lamb->problem.loads > 0) lamb_signal_value(&lamb->problem, signal, time[i], body);
        if (lamb->patches > 0) lamb_signal_value(&lamb->unloaded, moved, time[i], more);
        for (int c = 0; c < 6; c++)
            body[c] += more[c];
        for (size_t l = 0; l < lamb->planes; l++)
            add_plane_wave(&lamb->problem.ground, &lamb->plane[l], signal->position[2], time[i], body);
        body_direction_to_deck(&lamb->exact.scene->body, body, value + 6 * i);
        body_direction_to_deck(&lamb->exact.scene->body, body + 3, value + 6 * i + 3);
    }
}

static selas_status history(struct exact *exact, const double position[3], size_t n, const double *time,
                            double *value, struct messages *messages)
{
    const struct lamb *lamb = (const struct lamb *)exact;
    if (n == 0) return SELAS_OK;
    struct lamb_signal own = {.value = NULL}, moved = {.value = NULL};
    ground_position(exact->scene, position, own.position);
    for (size_t i = 0; i < lamb->signals; i++) {
        const struct lamb_signal *signal = &lamb->signal[i];
        if (signal->position[0] == own.position[0] && signal->position[1] == own.position[1] &&
            signal->position[2] == own.position[2] && time[n - 1] <= signal->end_time) {
            evaluate(lamb, signal, &lamb->moved[i], n, time, value);
            return SELAS_OK;
        }
    }
    selas_status status = check_position(lamb, own.position, messages);
    if (status != SELAS_OK) return status;
    status = compute(lamb, fmax(exact->scene->end_time, time[n - 1]), 1, &own, &moved, messages);
    if (status != SELAS_OK) return status;
    evaluate(lamb, &own, &moved, n, time, value);
    lamb_signal_free(&own);
    lamb_signal_free(&moved);
    return SELAS_OK;
}

static void describe(const struct exact *exact,
                     void (*tell)(void *context, const char *key, const char *value), void *context)
{
    const struct lamb *lamb = (const struct lamb *)exact;
    struct lamb_effort effort = {0};
    for (size_t i = 0; i < lamb->signals; i++) {
        if (lamb->signal[i].effort.cutoff > 0) {
            const double estimate = fmax(effort.estimate, lamb->signal[i].effort.estimate);
            effort = lamb->signal[i].effort;
            effort.estimate = estimate;
        }
    }
    char text[128];
    tell(context, "exact", "infinite half-space under traction patches, by FFT (doc/theory/lamb.md)");
    if (lamb->problem.layers != NULL)
        tell(context, "exact layers", "by reflections (doc/theory/layered.md, doc/theory/seismograms.md)");
    if (lamb->patches > 0)
        tell(context, "exact moving patches", "by wavenumbers and directions (doc/theory/sources.md)");
    if (lamb->signals == 0 || lamb->problem.loads == 0) return;
    (void)snprintf(text, sizeof text, "%.1e", fmax(effort.estimate, 5e-7));
    tell(context, "exact accuracy (L2 of velocity, estimated)", text);
    (void)snprintf(text, sizeof text, "%.4g", effort.cutoff);
    tell(context, "exact largest angular frequency", text);
    (void)snprintf(text, sizeof text, "%.4g", effort.largest_wavenumber);
    tell(context, "exact largest wavenumber", text);
    (void)snprintf(text, sizeof text, "%.4g, %.4g", effort.period, effort.decay);
    tell(context, "exact period and decay", text);
}

const struct exact_class exact_lamb = {
    .kind = "lamb",
    .create = create,
    .compute = compute_receivers,
    .destroy = destroy,
    .history = history,
    .describe = describe,
};
