/* Updated-Lagrangian SPH as published by He & Seaid (2016): checks the scene, reads the switches, places
 * particles and ghosts. The equations are in rate.c. */
#include "method/updated_lagrangian/updated_lagrangian.h"

#include "base/memory.h"
#include "base/vectors.h"

#include <math.h>
#include <string.h>

static const char *const NAME = "updated-lagrangian SPH";

static selas_status check_loads(const struct scene *scene, struct messages *messages)
{
    if (scene->loads > 64)
        return fail(messages, SELAS_UNSUPPORTED, "%s takes at most 64 loads, not %zu", NAME, scene->loads);
    for (size_t k = 0; k < scene->loads; k++) {
        const struct load *load = &scene->load[k];
        const bool body_force = load->kind == LOAD_BODY_FORCE && load->shape == LOAD_FACE;
        const bool traction = load->kind == LOAD_TRACTION && load->shape != LOAD_POINT &&
                              load->face != FACE_HOLE && !load_moves(load);
        if (!body_force && !traction)
            return fail(
                messages, SELAS_UNSUPPORTED,
                "%s takes tractions at rest on box faces (square, disc, face) and uniform body forces; "
                "load %zu is another kind",
                NAME, scene->load[k].group + 1);
    }
    return SELAS_OK;
}

/* What the ghosts of a face do; tractions need a face that is free or transmitting. */
static selas_status choose_wall(struct updated *updated, enum face face, struct messages *messages)
{
    const struct scene *scene = updated->model.scene;
    const struct boundary *boundary = &scene->boundary[face];
    bool loaded = false, along = false;
    for (size_t k = 0; k < scene->loads; k++) {
        const struct load *load = &scene->load[k];
        double direction[3];
        if (load->kind != LOAD_TRACTION || load->face != face) continue;
        loaded = true;
        body_direction_from_deck(&scene->body, load->direction, direction);
        for (int axis = 0; axis < scene->dimension; axis++)
            along = along || (axis != face_axis(face) && fabs(direction[axis]) > 1e-12);
    }
    body_direction_from_deck(&scene->body, boundary->direction, updated->direction[face]);
    const bool slips = boundary_slides(boundary) || (boundary_moves(boundary) && boundary->slip);
    const bool held = boundary_meaning(boundary)->holds != HOLDS_NOTHING;
    const enum updated_wall wall = slips                                ? WALL_SLIP
                                   : held                               ? WALL_STICK
                                   : loaded || boundary_damps(boundary) ? WALL_TRACTION
                                                                        : WALL_NONE;
    if (wall == WALL_SLIP && boundary->slip &&
        fabs(fabs(updated->direction[face][face_axis(face)]) - 1) > 1e-9)
        return fail(messages, SELAS_UNSUPPORTED,
                    "%s: a wall that moves with slip moves along its own normal (face '%s')", NAME,
                    face_name(face));
    if (wall == WALL_SLIP && along)
        return fail(messages, SELAS_UNSUPPORTED,
                    "%s: face '%s' slides, and its ghosts carry no traction along it; leave the load out, or "
                    "take method%%variant = 'total-lagrangian'",
                    NAME, face_name(face));
    if (wall != WALL_NONE && face == FACE_HOLE)
        return fail(messages, SELAS_UNSUPPORTED, "%s leaves the hole free", NAME);
    updated->wall[face] = wall;
    updated->pressed = updated->pressed || wall == WALL_TRACTION;
    return SELAS_OK;
}

static selas_status check_scene(struct updated *updated, struct messages *messages)
{
    const struct scene *scene = updated->model.scene;
    if (scene->body.layers > 0)
        return fail(messages, SELAS_UNSUPPORTED, "%s takes one material, no layers", NAME);
    selas_status status = check_loads(scene, messages);
    const int faces = 2 * scene->dimension;
    for (int face = 0; face < faces && status == SELAS_OK; face++)
        status = choose_wall(updated, (enum face)face, messages);
    if (status == SELAS_OK) status = choose_wall(updated, FACE_HOLE, messages);
    return status;
}

/* Ghosts that carry a traction have no adjoint. */
static selas_status check_forces(const struct updated *updated, struct messages *messages)
{
    if (updated->options.adjoint && updated->pressed)
        return fail(messages, SELAS_UNSUPPORTED,
                    "%s with forces = 'adjoint' takes no tractions and no transmitting faces", NAME);
    if (!updated->options.correction && (updated->options.adjoint || updated->options.hourglass > 0))
        return fail(messages, SELAS_UNSUPPORTED,
                    "%s: forces = 'adjoint' and hourglass need gradient_correction = .true.", NAME);
    return SELAS_OK;
}

static void choose_layout(struct updated *updated)
{
    const size_t dimension = (size_t)updated->dimension, stresses = (size_t)updated->stresses;
    struct updated_layout *layout = &updated->layout;
    layout->velocity = dimension;
    layout->volume = 2 * dimension;
    layout->span = layout->volume + 1;
    layout->mass = layout->span + 1;
    layout->density = layout->mass + 1;
    layout->length = layout->density + 1;
    layout->tension = layout->length + 1;
    layout->repulsion = layout->tension + stresses;
    layout->size = layout->repulsion + stresses;
}

static void choose_lengths(struct updated *updated)
{
    const struct updated_options *options = &updated->options;
    const double spacing = updated->cloud->spacing;
    updated->smoothing_length = options->smoothing_length * spacing;
    updated->reach = options->kernel->support * updated->smoothing_length;
    updated->skin = UPDATED_SKIN * spacing;
    const double shape = 6 * options->kernel->shape(updated->dimension, 1 / options->smoothing_length);
    updated->repulsion_scale = 1 / (shape * shape * shape * shape);
    const double h = updated->smoothing_length;
    updated->slope_scale =
        options->kernel->normalisation[updated->dimension - 1] / pow(h, updated->dimension + 2);
    updated->cubic = options->kernel == kernel_find("cubic");
    updated->sound_speed = sqrt(updated->material->young / updated->material->density); /* Eq 18 */
    updated->alpha = options->alpha;
    updated->beta = options->beta;
    updated->repulsive = options->artificial_stress > 0;
}

/* One smoothing length as published, except where the spacing changes several-fold, on the graded arrangement and
 * in files, and the length follows it: with one length the kernel reaches too few particles where they are far apart
 * and smears the stress where they are close. On even arrangements the volumes tell of noise only. */
static selas_status choose_own_lengths(struct updated *updated, struct messages *messages)
{
    static const double graded = 1.3;
    const struct cloud *cloud = updated->cloud;
    const struct body *body = &updated->model.scene->body;
    double shortest = INFINITY;
    selas_status status = SELAS_OK;
    updated->length = array_new(cloud->points, sizeof(double));
    if (updated->length == NULL)
        return fail(messages, SELAS_NO_MEMORY, "no memory for %zu particles", cloud->points);
    for (size_t i = 0; i < cloud->points; i++)
        updated->length[i] = pow(cloud->volume[i], 1.0 / updated->dimension);
    if (body->shape == BODY_POINTS) status = cloud_local_spacing(cloud, updated->length, messages);
    for (size_t i = 0; i < cloud->points; i++) {
        updated->length[i] /= cloud->spacing;
        shortest = fmin(shortest, updated->length[i]);
        updated->longest = fmax(updated->longest, updated->length[i]);
    }
    updated->even = body->shape == BODY_POINTS
                        ? updated->longest < graded * shortest
                        : body->shape != BODY_PLATE_WITH_HOLE || body->arrangement != ARRANGEMENT_CONFORMAL;
    for (size_t i = 0; i < cloud->points && updated->even; i++)
        updated->length[i] = 1;
    if (updated->even) updated->longest = 1;
    return status;
}

/* Neighbours at rest, of the particles in groups of eight that begin with own ones. */
static selas_status find_first(struct updated *updated, struct messages *messages)
{
    const size_t places = updated->points + updated->ghosts, end = updated->from + updated->own + GROUP - 1;
    memcpy(updated->searched, updated->reference, 3 * places * sizeof(double));
    return neighbours_find_some(&updated->neighbours, updated->dimension, places, updated->searched,
                                updated->longest * updated->reach + updated->skin, updated->from,
                                end < updated->points ? end : updated->points, messages);
}

/* Of the particles of the cloud. */
static selas_status take_memory(struct updated *updated, struct messages *messages)
{
    const struct scene *scene = updated->model.scene;
    const size_t points = updated->points, places = points + updated->ghosts;
    updated->mass = array_new(points, sizeof(double));
    updated->searched = array_new(3 * places, sizeof(double));
    updated->deck_position = array_new(updated->part.planes ? 0 : 3 * points, sizeof(double));
    updated->load_direction = array_new(3 * scene->loads, sizeof(double));
    if (updated->mass == NULL || updated->searched == NULL || updated->deck_position == NULL ||
        updated->load_direction == NULL)
        return fail(messages, SELAS_NO_MEMORY, "no memory for %zu particles and %zu ghosts", points,
                    updated->ghosts);
    for (size_t i = 0; i < points; i++) {
        updated->mass[i] = updated->material->density * updated->cloud->volume[i];
        if (!updated->part.planes)
            body_to_deck(&scene->body, updated->cloud->position + 3 * i, updated->deck_position + 3 * i);
    }
    for (size_t k = 0; k < scene->loads; k++) {
        body_direction_from_deck(&scene->body, scene->load[k].direction, updated->load_direction + 3 * k);
        for (size_t a = 0; a < 3; a++)
            updated->load_direction[3 * k + a] *= scene->load[k].amplitude;
    }
    return find_first(updated, messages);
}

static void destroy(struct model *model)
{
    struct updated *updated = updated_of(model);
    cloud_free(&updated->cloud);
    neighbours_free(&updated->neighbours);
    array_free(updated->mass);
    array_free(updated->length);
    array_free(updated->ghost);
    array_free(updated->reference);
    array_free(updated->searched);
    array_free(updated->record);
    updated_hourglass_free(updated->hourglass);
    updated_part_free(&updated->part);
    array_free(updated->planes);
    array_free(updated->shifts);
    array_free(updated->shift);
    array_free(updated->deck_position);
    array_free(updated->load_direction);
    array_free(updated);
}

static size_t bytes_of(const struct updated *updated)
{
    const size_t places = updated->points + updated->ghosts;
    return neighbours_bytes(&updated->neighbours) + places * 6 * sizeof(double) +
           updated->ghosts * sizeof *updated->ghost +
           updated->layout.size * sizeof(double) * (updated->ordered ? updated->stride : places) +
           updated->shift_room * sizeof *updated->shift + updated->points * 2 * sizeof(double) +
           updated->cloud->points * (updated->part.planes ? 5 : 8) * sizeof(double) +
           updated_hourglass_bytes(updated) + updated_window_bytes(updated);
}

static void fill_public_face(struct updated *updated)
{
    struct model *model = &updated->model;
    const size_t dimension = (size_t)updated->dimension;
    model->points = updated->cloud->whole;
    if (updated->part.planes)
        model->place = cloud_place;
    else
        model->position = updated->deck_position;
    if (updated->part.ranks != NULL) model->whole_unknowns = dimension * model->points;
    memcpy(model->grid, updated->cloud->grid, sizeof model->grid);
    model->component_stride = 1;
    model->point_stride = dimension;
    model->damped = updated->alpha > 0 || updated->beta > 0;
    model->frame = model->scene->body.rotated ? model->scene->body.frame : NULL;
    model->bytes = bytes_of(updated);
}

/* From here on it is what waves err by, and holds motions that alternate from particle to particle. */
#define ENOUGH_VISCOSITY .5

/* Viscosity damps to order 1 what is wrong to order 2 (180 / p^2 without any; by the kernel), of a pulse that is
 * seen at end_time alone. A uniform stress pushes scattered particles aside, against hourglass control and what
 * else holds them: waves are slower, whatever the spacing (measured: regress/studies/bodies/scattered). */
static struct wave_law waves_of(const struct updated *updated, double disorder)
{
    const struct updated_options *options = &updated->options;
    const double lost =
        kernel_dispersion(options->kernel, updated->dimension, options->smoothing_length, 0); /* (2.1) */
    const double scatter = 50 / (1 + 10 * options->hourglass) * disorder / updated->dimension;
    const bool thick = options->alpha >= ENOUGH_VISCOSITY;
    const int order = thick ? 1 : 2;
    const double coarser = updated_mean_power(updated, order);
    return (struct wave_law){.constant = coarser * (thick ? 1.3 + 1.55 * options->alpha : 44 * lost),
                             .order = order,
                             .sent = coarser * (thick ? 1.7 + 2 * options->alpha : 86 * lost),
                             .sent_order = order,
                             .floor = .5 * options->artificial_stress + scatter,
                             .scatter = scatter,
                             .bends = 1,
                             .bends_order = 1,
                             .bare = .94 * options->smoothing_length}; /* (U14) */
}

/* The particles of the cloud at rest, and their neighbours. */
static selas_status lay_out(struct updated *updated, struct messages *messages)
{
    const size_t points = updated->points;
    updated->reference = array_new(3 * points, sizeof(double));
    if (updated->reference == NULL)
        return fail(messages, SELAS_NO_MEMORY, "no memory for %zu particles", points);
    memcpy(updated->reference, updated->cloud->position, 3 * points * sizeof(double));
    selas_status status = check_forces(updated, messages);
    if (status == SELAS_OK) status = choose_own_lengths(updated, messages);
    if (status == SELAS_OK) status = updated_ghosts_create(updated, messages);
    if (status == SELAS_OK) status = take_memory(updated, messages);
    return status;
}

/* Together: what the particles of all have, and those that this rank goes on with. */
static selas_status meet(struct updated *updated, struct messages *messages)
{
    struct model *model = &updated->model;
    const size_t dimension = (size_t)updated->dimension;
    selas_status status = updated_warn_of_gaps(updated, messages);
    if (status == SELAS_OK) status = updated_choose_order(updated, messages);
    status = updated_agree(updated, status, messages);
    if (status != SELAS_OK) return status;
    for (size_t g = 0; g < updated->ghosts; g++)
        updated->images += updated_owns(updated, updated->ghost[g].source);
    ranks_sum(updated->part.ranks, 1, &updated->images);
    updated_share(updated);
    model->unknowns = dimension * updated->held;
    model->state_size = (2 * dimension + 1 + (size_t)updated->stresses) * updated->held;
    if (updated->part.ranks != NULL) {
        model->setup_bytes = bytes_of(updated);
        updated->part.length = updated->length;
        updated->length = NULL;
        if (!updated_meet(updated)) return fail(messages, SELAS_NO_MEMORY, "no memory for the ranks");
        status = updated_find_neighbours(updated, messages);
    }
    if (status == SELAS_OK && (updated->options.hourglass > 0 || updated->options.adjoint))
        status = updated_hourglass_new(updated, messages);
    status = updated_agree(updated, status, messages);
    if (status == SELAS_OK) updated_look_ahead(updated);
    return status;
}

static selas_status build(struct updated *updated, struct messages *messages)
{
    choose_layout(updated);
    selas_status status = check_scene(updated, messages);
    updated->model.level_images = updated->pressed;
    if (status == SELAS_OK) status = updated_make_points(updated, messages);
    if (status != SELAS_OK) return status;
    choose_lengths(updated);
    status = updated_agree(updated, lay_out(updated, messages), messages);
    if (status == SELAS_OK) status = meet(updated, messages);
    if (status != SELAS_OK) return status;
    fill_public_face(updated);
    const size_t measured = updated_spectrum_bytes(updated);
    if (updated->model.setup_bytes < measured) updated->model.setup_bytes = measured;
    double disorder = 0;
    if (updated->cloud->grid[0] == 0) status = updated_disorder(updated, &disorder, messages);
    updated->model.waves = waves_of(updated, disorder);
    updated->model.alternates =
        !(updated->options.alpha >= ENOUGH_VISCOSITY || updated->options.hourglass > 0);
    return status;
}

#define CORE                                                                                                 \
    .destroy = destroy, .initialise = updated_initialise, .probe = updated_probe,                            \
    .observe = updated_observe, .field = updated_field, .energy = updated_energy, .power = updated_power,    \
    .unseen = updated_unseen, .describe = updated_describe
static const struct model_core core = {CORE};
static const struct model_core shared_core = {CORE, .holder = updated_holder, .share = updated_spread};
static const struct model_operator spatial = {.rate = updated_rate, .spectrum = updated_spectrum};

selas_status updated_lagrangian_new(const struct scene *scene, const struct updated_options *options,
                                    struct cloud *cloud, struct model **model, struct messages *messages)
{
    *model = NULL;
    struct updated *updated = array_new(1, sizeof *updated);
    if (updated == NULL) {
        cloud_free(&cloud);
        return fail(messages, SELAS_NO_MEMORY, "no memory for the method");
    }
    updated->model.method = &method_updated_lagrangian;
    updated->model.core = ranks_count(scene->ranks) > 1 ? &shared_core : &core;
    updated->model.patch = PATCH_BY_CELLS;
    updated->model.spatial = &spatial;
    updated->model.scene = scene;
    updated->options = *options;
    updated->dimension = scene->dimension;
    updated->stresses = scene->dimension * (scene->dimension + 1) / 2;
    updated->cloud = cloud;
    updated->material = &scene->material[scene->body.material];
    const selas_status status = build(updated, messages);
    if (status != SELAS_OK) {
        destroy(&updated->model);
        return status;
    }
    *model = &updated->model;
    return SELAS_OK;
}
