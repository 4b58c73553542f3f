/* Reference 'layered': horizontally layered, damped ground under patches, point forces and moment tensors at
 * any depth (doc/theory/seismograms.md), computed by exact/seismogram.c. This file turns the scene into that
 * problem: the body's frame, mirror images at symmetry planes, damping; and refuses what has no such
 * solution. */
#include "exact/layered_ground.h"

#include "base/memory.h"
#include "damping/ground.h"
#include "exact/ground.h"
#include "exact/seismogram.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

struct layered_ground {
    struct exact exact;
    struct seismogram_problem problem;
    struct seismogram_rock *rock;
    struct seismogram_source *source; /* images included */
    struct ground_damping *damping;   /* NULL: none */
    size_t seismograms;
    struct seismogram *seismogram; /* of the scene's receivers */
};

static selas_status refuse(struct messages *messages, const char *why)
{
    return fail(messages, SELAS_BAD_SCENE, "reference 'layered': %s", why);
}

/* --- Ground ------------------------------------------------------------------------------------------- */

static struct seismogram_rock rock_of(const struct layered_ground *ground, size_t material, double top)
{
    const struct scene *scene = ground->exact.scene;
    const struct material *m = &scene->material[material];
    struct damped_moduli moduli = {modulus_elastic(m->lambda + 2 * m->mu), modulus_elastic(m->mu)};
    if (ground->damping != NULL)
        moduli = (scene->reference.scheme ? ground->damping->fitted : ground->damping->wanted)[material];
    return (struct seismogram_rock){
        .top = top, .density = m->density, .axial = moduli.axial, .shear = moduli.shear};
}

static selas_status set_rocks(struct layered_ground *ground, const struct scene *scene,
                              struct messages *messages)
{
    const struct body *body = &scene->body;
    ground->rock = array_new(body->layers + 1, sizeof *ground->rock);
    if (ground->rock == NULL)
        return fail(messages, SELAS_NO_MEMORY, "no memory for the layers of the ground");
    size_t rocks = 0;
    if (body->layers == 0 || body->layer[0].top > 0)
        ground->rock[rocks++] = rock_of(ground, body->material, 0);
    for (size_t i = 0; i < body->layers; i++)
        ground->rock[rocks++] = rock_of(ground, body->layer[i].material, body->layer[i].top);
    ground->problem.rocks = rocks;
    ground->problem.rock = ground->rock;
    return SELAS_OK;
}

/* --- Sources ------------------------------------------------------------------------------------------ */

static selas_status check_load(const struct scene *scene, const struct load *load, struct messages *messages)
{
    if (load_moves(load)) return refuse(messages, "loads that move are not offered; take reference 'lamb'");
    if (load->kind == LOAD_TRACTION && load->face != FACE_Z_LOW)
        return refuse(messages, "tractions must act on the free surface, face = 'z-'");
    if (load->shape == LOAD_FACE)
        return refuse(messages, "a load of the whole face or body is not offered, only patches and points");
    if (load->shape != LOAD_POINT && scene->reference.stress)
        return refuse(messages, "stress is offered for point sources only, not under patches");
    return SELAS_OK;
}

/* A tensor on an interface would depend on the side that is meant. */
static selas_status check_interfaces(const struct layered_ground *ground, const struct load *load,
                                     double depth, struct messages *messages)
{
    for (size_t i = 1; i < ground->problem.rocks && load->kind == LOAD_MOMENT_TENSOR; i++)
        if (fabs(ground->rock[i].top - depth) < 1e-9 * ground->rock[i].top)
            return fail(
                messages, SELAS_BAD_SCENE,
                "reference 'layered': a moment tensor lies on the interface at depth %g, where it depends on "
                "the side that is meant; move it a little up or down",
                depth);
    return SELAS_OK;
}

/* Turns a tensor xx yy zz xy yz zx into the body's frame: R^T M R. */
static void turn_moment(const struct body *body, const double moment[6], double turned[6])
{
    static const int place[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    double half[3][3], whole[3][3];
    for (int i = 0; i < 3; i++) {
        const double row[3] = {moment[place[i][0]], moment[place[i][1]], moment[place[i][2]]};
        body_direction_from_deck(body, row, half[i]);
    }
    for (int j = 0; j < 3; j++) {
        const double column[3] = {half[0][j], half[1][j], half[2][j]};
        body_direction_from_deck(body, column, whole[j]);
    }
    for (int i = 0; i < 3; i++)
        for (int j = i; j < 3; j++)
            turned[place[i][j]] = whole[j][i];
}

static void set_source(const struct scene *scene, const struct load *load, struct seismogram_source *source)
{
    double direction[3];
    *source = (struct seismogram_source){.history = &load->history, .patch.shape = PATCH_POINT};
    ground_position(scene, load->centre, source->position);
    if (load->kind == LOAD_MOMENT_TENSOR) {
        turn_moment(&scene->body, load->moment, source->moment);
        for (int i = 0; i < 6; i++)
            source->moment[i] *= load->amplitude;
        return;
    }
    body_direction_from_deck(&scene->body, load->direction, direction);
    for (int c = 0; c < 3; c++)
        source->force[c] = fabs(direction[c]) < 1e-14 ? 0 : load->amplitude * direction[c];
    if (load->shape == LOAD_POINT) return;
    source->patch.shape = load->shape == LOAD_SQUARE ? PATCH_RECTANGLE : PATCH_DISC;
    for (int c = 0; c < 2; c++)
        source->patch.half[c] = .5 * load->size[load->shape == LOAD_SQUARE ? c : 0];
}

/* Mirror image at a plane across an axis. */
static void mirror(int axis, double plane, const struct seismogram_source *source,
                   struct seismogram_source *image)
{
    *image = *source;
    image->position[axis] = 2 * plane - source->position[axis];
    image->force[axis] = -source->force[axis];
    image->moment[3] = -source->moment[3];
    image->moment[axis == 0 ? 5 : 4] = -source->moment[axis == 0 ? 5 : 4];
}

/* Images of sources [0, *count) at the symmetry plane of an axis, if there is one. */
static selas_status add_images(const struct scene *scene, int axis, struct seismogram_source *source,
                               size_t *count, struct messages *messages)
{
    const bool low = boundary_mirrors(&scene->boundary[2 * axis]);
    if (!low && !boundary_mirrors(&scene->boundary[2 * axis + 1])) return SELAS_OK;
    const double plane = low ? scene->body.low[axis] : scene->body.high[axis];
    const double size = scene->body.high[axis] - scene->body.low[axis];
    const size_t before = *count;
    for (size_t i = 0; i < before; i++) {
        const double away = fabs(source[i].position[axis] - plane);
        struct seismogram_source *image = &source[*count];
        mirror(axis, plane, &source[i], image);
        if (away < 1e-9 * size) {
            for (int c = 0; c < 6; c++)
                if (image->moment[c] != source[i].moment[c] ||
                    (c < 3 && image->force[c] != source[i].force[c]))
                    return refuse(messages, "a source on a symmetry plane must be its own mirror image");
            continue;
        }
        if (away < source[i].patch.half[axis] * (1 - 1e-9))
            return refuse(messages, "a symmetry plane may cut a load only through its centre");
        ++*count;
    }
    return SELAS_OK;
}

static selas_status set_sources(struct layered_ground *ground, const struct scene *scene,
                                struct messages *messages)
{
    ground->source = array_new(4 * scene->loads + 1, sizeof *ground->source);
    if (ground->source == NULL)
        return fail(messages, SELAS_NO_MEMORY, "no memory for %zu loads", scene->loads);
    size_t count = scene->loads;
    selas_status status = SELAS_OK;
    for (size_t i = 0; i < count && status == SELAS_OK; i++) {
        set_source(scene, &scene->load[i], &ground->source[i]);
        const double depth = ground->source[i].position[2];
        status = check_load(scene, &scene->load[i], messages);
        if (status == SELAS_OK) status = check_interfaces(ground, &scene->load[i], depth, messages);
        if (status == SELAS_OK && depth < 0) status = refuse(messages, "a source lies above the ground");
    }
    for (int axis = 0; axis < 2 && status == SELAS_OK; axis++)
        status = add_images(scene, axis, ground->source, &count, messages);
    ground->problem.sources = count;
    ground->problem.source = ground->source;
    return status;
}

/* --- The solution ------------------------------------------------------------------------------------- */

static void destroy(struct exact *exact)
{
    struct layered_ground *ground = (struct layered_ground *)exact;
    for (size_t i = 0; i < ground->seismograms; i++)
        seismogram_free(&ground->seismogram[i]);
    array_free(ground->seismogram);
    array_free(ground->rock);
    array_free(ground->source);
    ground_damping_free(ground->damping);
    array_free(ground);
}

static selas_status set_receivers(struct layered_ground *ground, const struct scene *scene,
                                  struct messages *messages)
{
    ground->seismogram = array_new(scene->receivers, sizeof *ground->seismogram);
    if (ground->seismogram == NULL)
        return fail(messages, SELAS_NO_MEMORY, "no memory for %zu seismograms", scene->receivers);
    for (size_t i = 0; i < scene->receivers; i++)
        ground_position(scene, scene->receiver[i].position, ground->seismogram[i].position);
    return seismograms_check(&ground->problem, scene->receivers, ground->seismogram, messages);
}

static void warn_of_miss(const struct layered_ground *ground, struct messages *messages)
{
    static const double much = 10, least = 1e-3, usual = 1e-6;
    const double wanted = ground->problem.tolerance > 0 ? ground->problem.tolerance : usual;
    double worst = 0;
    for (size_t i = 0; i < ground->seismograms; i++)
        worst = fmax(worst, ground->seismogram[i].effort.reached);
    if (worst > fmax(least, much * wanted))
        warn(
            messages,
            "the exact velocities are good to %.2g only, where reference%%tolerance = %g is wanted: the time "
            "function has high frequencies without end (a jump or a kink); a smoother one would do "
            "(smoothing, a "
            "longer delay)",
            worst, wanted);
}

static selas_status compute(struct exact *exact, struct messages *messages)
{
    struct layered_ground *ground = (struct layered_ground *)exact;
    const size_t receivers = exact->scene->receivers;
    const selas_status status = seismograms(&ground->problem, receivers, ground->seismogram, messages);
    if (status != SELAS_OK) return status;
    ground->seismograms = receivers;
    warn_of_miss(ground, messages);
    return status;
}

static selas_status create(const struct scene *scene, struct exact **exact, struct messages *messages)
{
    *exact = NULL;
    selas_status status = ground_check(scene, "layered", messages);
    if (status != SELAS_OK) return status;
    struct layered_ground *ground = array_new(1, sizeof *ground);
    if (ground == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the reference 'layered'");
    ground->exact = (struct exact){.class = &exact_layered, .scene = scene};
    ground->problem.end_time = scene->end_time;
    ground->problem.tolerance = scene->reference.tolerance;
    ground->problem.stress = scene->reference.stress;
    status = ground_damping_new(scene, scene->reference.scheme, &ground->damping, messages);
    if (status == SELAS_OK) status = set_rocks(ground, scene, messages);
    if (status == SELAS_OK) status = set_sources(ground, scene, messages);
    if (status == SELAS_OK) status = set_receivers(ground, scene, messages);
    if (status != SELAS_OK) {
        destroy(&ground->exact);
        return status;
    }
    *exact = &ground->exact;
    return SELAS_OK;
}

/* The seismogram of a place until a time: one that is there, or *own, computed. */
static selas_status find(const struct layered_ground *ground, const double position[3], double until,
                         struct seismogram *own, const struct seismogram **found, struct messages *messages)
{
    ground_position(ground->exact.scene, position, own->position);
    for (size_t i = 0; i < ground->seismograms; i++) {
        const struct seismogram *seismogram = &ground->seismogram[i];
        const double *place = seismogram->position;
        if (place[0] == own->position[0] && place[1] == own->position[1] && place[2] == own->position[2] &&
            until <= seismogram->end_time) {
            *found = seismogram;
            return SELAS_OK;
        }
    }
    struct seismogram_problem problem = ground->problem;
    problem.end_time = fmax(problem.end_time, until);
    *found = own;
    return seismograms(&problem, 1, own, messages);
}

static selas_status history(struct exact *exact, const double position[3], size_t n, const double *time,
                            double *value, struct messages *messages)
{
    const struct layered_ground *ground = (const struct layered_ground *)exact;
    const struct seismogram *seismogram = NULL;
    struct seismogram own = {.value = NULL};
    if (n == 0) return SELAS_OK;
    const selas_status status = find(ground, position, time[n - 1], &own, &seismogram, messages);
    for (size_t i = 0; i < n && status == SELAS_OK; i++) {
        double line[SEISMOGRAM_LINES];
        seismogram_at(seismogram, time[i], line);
        body_direction_to_deck(&exact->scene->body, line + SEISMOGRAM_DISPLACEMENT, value + 6 * i);
        body_direction_to_deck(&exact->scene->body, line + SEISMOGRAM_VELOCITY, value + 6 * i + 3);
    }
    seismogram_free(&own);
    return status;
}

static selas_status stress(struct exact *exact, const double position[3], size_t n, const double *time,
                           double *value, struct messages *messages)
{
    const struct layered_ground *ground = (const struct layered_ground *)exact;
    const struct seismogram *seismogram = NULL;
    struct seismogram own = {.value = NULL};
    if (n == 0) return SELAS_OK;
    const selas_status status = find(ground, position, time[n - 1], &own, &seismogram, messages);
    struct body back = exact->scene->body; /* its frame the other way round turns a tensor back */
    for (int i = 0; i < 3; i++)
        for (int j = 0; j < 3; j++)
            back.frame[i][j] = exact->scene->body.frame[j][i];
    for (size_t i = 0; i < n && status == SELAS_OK; i++) {
        double line[SEISMOGRAM_LINES];
        seismogram_at(seismogram, time[i], line);
        turn_moment(&back, line + SEISMOGRAM_STRESS, value + 6 * i);
    }
    seismogram_free(&own);
    return status;
}

/* Mechanisms or constant Q, and what the loads' spectrum sees of the difference. */
static void describe_damping(const struct layered_ground *ground,
                             void (*tell)(void *context, const char *key, const char *value), void *context)
{
    const struct ground_damping *damping = ground->damping;
    char text[256];
    if (damping == NULL) return;
    if (!ground->exact.scene->reference.scheme) {
        tell(context, "exact damping", "by Q as it is wanted (Kjartansson 1979 where it is constant)");
        return;
    }
    int at = snprintf(text, sizeof text, "%zu relaxation mechanisms, misfit %.2g/Q, angular frequencies",
                      damping->mechanisms, damping->misfit);
    for (size_t l = 0; l < damping->mechanisms; l++)
        at += snprintf(text + at, sizeof text - (size_t)at, " %.4g", damping->rate[l]);
    tell(context, "exact damping", text);
}

static void tell_number(void (*tell)(void *context, const char *key, const char *value), void *context,
                        const char *key, double number)
{
    char text[32];
    (void)snprintf(text, sizeof text, "%.3g", number);
    tell(context, key, text);
}

static void describe(const struct exact *exact,
                     void (*tell)(void *context, const char *key, const char *value), void *context)
{
    const struct layered_ground *ground = (const struct layered_ground *)exact;
    struct seismogram_effort worst = {0};
    for (size_t i = 0; i < ground->seismograms; i++)
        if (ground->seismogram[i].effort.reached >= worst.reached) worst = ground->seismogram[i].effort;
    tell(context, "exact", "layered ground by wavenumbers and FFT (doc/theory/seismograms.md)");
    describe_damping(ground, tell, context);
    if (ground->seismograms == 0) return;
    tell_number(tell, context, "exact accuracy (L2 of velocity, estimated)", worst.reached);
    tell_number(tell, context, "exact accuracy of the wavenumbers", worst.of_wavenumbers);
    tell_number(tell, context, "exact accuracy of the cutoff", worst.of_frequencies);
    tell_number(tell, context, "exact accuracy of the period", worst.of_period);
    tell_number(tell, context, "exact largest angular frequency", worst.cutoff);
    tell_number(tell, context, "exact period", worst.period);
    tell_number(tell, context, "exact decay", worst.decay);
}

const struct exact_class exact_layered = {
    .kind = "layered",
    .damped = true,
    .create = create,
    .compute = compute,
    .destroy = destroy,
    .history = history,
    .stress = stress,
    .describe = describe,
};
