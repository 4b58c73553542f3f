/* The consistent smoothed point method (manual, doc/theory/consistent-method.md): Ding et al. (2006), Eq 14, with
 * the smoothing kept on both sides, which is Galerkin's method with tensor-product B-splines:
 *
 *   M a + C v + K u = F.
 *
 * Here: the model's making, its acceleration and energies. */
#include "method/consistent/consistent.h"
#include "method/consistent/absorbing/pml.h"
#include "method/consistent/fused/fused.h"
#include "method/consistent/galerkin/moving_load.h"
#include "method/consistent/general/general.h"
#include "method/consistent/general/sweep.h"

#include "base/memory.h"
#include "scene/absorbing_layers.h"

#include <omp.h>
#include <stdio.h>
#include <string.h>

static void destroy(struct model *model)
{
    struct consistent *c = consistent_of(model);
    general_free(c);
    pml_free(c);
    fused_free(c->fused);
    watch_free(&c->watch);
    hform_free(c);
    forces_free(c);
    mass_free(c);
    tensor_plan_free(c->stiffness);
    tensor_plan_free(c->mass);
    for (size_t i = 0; i < c->matrices; i++)
        band_free(c->matrix[i].band);
    for (int axis = 0; axis < 3; axis++) {
        spline_free(c->spline[axis]);
        array_free(c->lattice[axis][0]);
        array_free(c->lattice[axis][1]);
        band_free(c->collocation[axis][0]);
        band_free(c->collocation[axis][1]);
    }
    for (int weight = 0; weight < WEIGHT_NONE; weight++)
        array_free(c->weighted[weight]);
    for (int face = 0; face < BOX_FACES; face++)
        for (int component = 0; component < 3; component++)
            array_free(c->speed[face][component]);
    part_free(c);
    array_free(c->surface);
    array_free(c->plane_class);
    array_free(c->class_plane);
    array_free(c->line_buffer);
    array_free(c->face_buffer);
    array_free(c->own_scene);
    array_free(c);
}

/* F - K u - C v - M_IB a_B in planes from .. end - 1, at most TENSOR_PLANES. */
static void residual_planes(const struct consistent *c, const struct drive *drive, int thread, size_t from,
                            size_t end, const double *u, const double *v, double *a)
{
    double *out[3] = {NULL, NULL, NULL};
    for (int component = 0; component < c->dimension; component++) {
        out[component] = a + (size_t)component * c->volume + from * c->plane;
        memset(out[component], 0, (end - from) * c->plane * sizeof *a);
    }
    tensor_planes(c->stiffness, thread, from, end - from, 0, c->n[1], -1, u, out);
    for (size_t k = from; k < end; k++) {
        if (v != NULL && c->model.damped) dampers_subtract(c, thread, k, v, out);
        for (int component = 0; component < c->dimension; component++) {
            add_forces(c, drive, &c->load, c->inertia, component, k, out[component]);
            moving_loads_add(c, drive, component, k, out[component]);
            consistent_clear_held(c, component, k, out[component]);
            out[component] += c->plane;
        }
    }
}

static bool faces_move(const struct consistent *c, const struct drive *drive)
{
    bool moving = false;
    for (int face = 0; face < 2 * c->dimension; face++)
        moving = moving || (c->moving[face] && drive->motion != NULL);
    return moving;
}

static void set_moving(const struct consistent *c, const struct drive *drive, double *a)
{
    for (int face = 0; face < 2 * c->dimension; face++) {
        if (!c->moving[face] || drive->motion == NULL) continue;
        for (int component = 0; component < c->dimension; component++)
            for (size_t k = 0; k < c->n[DEPTH]; k++)
                sparse_add(c, &c->pattern[face], component, k, drive->motion[face],
                           a + (size_t)component * c->volume + k * c->plane);
    }
}

static void exact_accelerate(struct consistent *c, const struct drive *drive, double half_step,
                             const double *u, const double *v, double *a)
{
    const struct mass_factors *factors = mass_factors_for(c, half_step);
    const struct part_axis *own = &c->part.along[DEPTH];
#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (size_t k = own->own; k < own->end; k += TENSOR_PLANES) {
        const size_t end = k + TENSOR_PLANES < own->end ? k + TENSOR_PLANES : own->end;
        residual_planes(c, drive, omp_get_thread_num(), k, end, u, v, a);
    }
    mass_solve(c, factors, a);
    if (drive->extra == NULL) return;
    pml_accelerate(c, 1, drive->extra, a);
    for (int component = 0; component < c->dimension; component++)
        for (size_t k = 0; k < c->n[DEPTH]; k++)
            consistent_clear_held(c, component, k, a + (size_t)component * c->volume + k * c->plane);
}

static void accelerate(struct model *model, const struct drive *drive, double half_step, const double *u,
                       const double *v, double *a)
{
    struct consistent *c = consistent_of(model);
    const bool moving = faces_move(c, drive);
    moving_loads_place(c, drive->time, c->hform != NULL && c->general == NULL);
    if (c->general != NULL)
        general_accelerate(c, drive, half_step, u, v, a);
    else if (c->hform != NULL)
        hform_accelerate(c, drive, half_step, u, v, !moving, a);
    else
        exact_accelerate(c, drive, half_step, u, v, a);
    set_moving(c, drive, a);
    const struct part_fields fields = part_values(c, a, (size_t)c->dimension, sizeof *a);
    if (c->general != NULL || c->hform == NULL || moving) part_exchange(c, &fields);
    model->evaluations++;
}

static void energy(struct model *model, const double *y, struct energy *energy)
{
    struct consistent *c = consistent_of(model);
    const double *v = y + model->unknowns;
    const struct part_axis *y_axis = &c->part.along[1], *z_axis = &c->part.along[DEPTH];
    const size_t rows[] = {y_axis->own, y_axis->end}, planes[] = {z_axis->own, z_axis->end};
    bool moving = false;
    for (int face = 0; face < BOX_FACES; face++)
        moving = moving || c->moving[face];
    if (c->general != NULL) {
        general_energy(c, y, energy);
    } else if (c->hform != NULL && !moving) {
        hform_energy(c, y, energy);
    } else {
        energy->kinetic = tensor_form_part(c->mass, rows, planes, v, v) / 2;
        energy->strain = tensor_form_part(c->stiffness, rows, planes, y, y) / 2;
    }
    double sums[2] = {energy->kinetic, energy->strain};
    ranks_sum(c->part.ranks, 2, sums);
    *energy = (struct energy){sums[0], sums[1]};
}

static void weigh(struct model *model, const double *v, double *product)
{
    struct consistent *c = consistent_of(model);
    if (c->general != NULL) {
        general_weigh(c, v, product);
        return;
    }
    if (c->hform != NULL) {
        hform_weigh(c, v, product);
        return;
    }
    memset(product, 0, model->unknowns * sizeof *product);
#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (size_t k = 0; k < c->n[DEPTH]; k++) {
        double *out[3] = {NULL, NULL, NULL};
        for (int component = 0; component < c->dimension; component++)
            out[component] = product + (size_t)component * c->volume + k * c->plane;
        tensor_plane(c->mass, omp_get_thread_num(), k, 1, v, out);
    }
}

static void power(struct model *model, const struct drive *drive, const double *y, double *load,
                  double *absorbed)
{
    struct consistent *c = consistent_of(model);
    const double *v = y + model->unknowns;
    *load = 0;
    for (size_t l = 0; drive->load != NULL && l < model->scene->loads; l++)
        if (drive->load[l] != 0)
            *load += drive->load[l] * model->scene->load[l].amplitude * sparse_dot(c, &c->load.of[l], v);
    if (c->moving_loads > 0) {
        moving_loads_place(c, drive->time, false);
        *load += moving_loads_power(c, drive, v);
    }
    *absorbed = c->general != NULL ? general_damper_power(c, v)
                : c->hform != NULL ? hform_damper_power(c, v)
                                   : dampers_power(c, v);
    if (c->hform != NULL) *absorbed += hform_dissipation_power(c, v);
}

static void describe(const struct model *model,
                     void (*tell)(void *context, const char *key, const char *value), void *context)
{
    const struct consistent *c = (const struct consistent *)model;
    const char *step = model->single ? "leapfrog's is one pass with the operator, in single precision"
                       : model->one_pass != NULL ? "leapfrog's is one pass with the operator"
                                                 : "apart from the operator";
    char text[160];
    snprintf(text, sizeof text, "B-splines of degree %d, %s ends", c->options.degree,
             c->options.mapped ? "mapped" : "open");
    tell(context, "basis", text);
    snprintf(text, sizeof text, "van Cittert, %d sweeps (H-form%s)", c->options.sweeps,
             c->options.depth_exact ? ", exact over depth in the stiffness" : "");
    if (c->options.tuned) tell(context, "splines along the surface", "tuned for short waves");
    if (c->general != NULL) {
        tell(context, "operator", "general: three points of quadrature a control value");
        tell(context, "step", step);
        snprintf(text, sizeof text, "van Cittert, %d sweeps tuned for the points, between two diagonals",
                 c->options.sweeps);
    }
    tell(context, "mass", c->options.sweeps == 0 ? "exact (banded Cholesky per axis)" : text);
    if (c->fused != NULL) {
        snprintf(text, sizeof text, "fused, %d planes at a time in strips of %d rows", FUSED_PLANES,
                 FUSED_STRIP);
        tell(context, "operator", text);
        tell(context, "step", step);
    }
    if (c->hform != NULL && c->general == NULL) {
        snprintf(text, sizeof text, "what is below %g of the largest displacement moves nothing",
                 c->options.quiet);
        tell(context, "quiet parts", c->options.quiet > 0 ? text : "all are computed");
    }
    if (c->fused != NULL) {
        const struct fused *used = model->single ? c->fused->single : c->fused;
        if (used->skipped > 0) {
            snprintf(text, sizeof text, "%.1f %% of %spoints, all calls so far",
                     100 * (double)used->skipped / (double)used->points,
                     c->part.ranks != NULL ? "the first rank's " : "");
            tell(context, "operator skipped", text);
        }
    }
    if (c->options.dissipation > 0) {
        snprintf(text, sizeof text, "%g c_p / spacing, largest damping rate at most %.4g",
                 c->options.dissipation, model->dissipation);
        tell(context, "dissipation", text);
    }
    size_t control[3] = {1, 1, 1};
    for (int axis = 0; axis < c->dimension; axis++)
        control[axis] = c->spline[axis]->count;
    snprintf(text, sizeof text, "%zu x %zu x %zu", model->grid[0], model->grid[1], model->grid[2]);
    tell(context, "lattice points", text);
    snprintf(text, sizeof text, "%zu x %zu x %zu", control[0], control[1], control[2]);
    tell(context, "control values per component", text);
    layers_describe(c, tell, context);
    shared_describe(c, tell, context);
}

static void forget(struct model *model)
{
    struct consistent *c = consistent_of(model);
    fused_forget(c->fused);
    layers_forget(c->pml);
}

static selas_status build_space(struct consistent *c, struct messages *messages)
{
    selas_status status = consistent_lay(c, messages);
    if (status != SELAS_OK) return status;
    if (!consistent_plans(c) || !mass_allocate(c) || !dampers_allocate(c) || !observe_create(c) ||
        !collocation_create(c))
        return fail(messages, SELAS_NO_MEMORY, "no memory for a model of %zu control values", c->volume);
    status = forces_create(c, messages);
    return status == SELAS_OK && c->options.sweeps > 0 ? hform_create(c, messages) : status;
}

/* Ranks make the mass together: they agree before on what one of them alone has failed in, and at the end. */
static selas_status build_general(struct consistent *c, struct messages *messages)
{
    selas_status status = ranks_agree(c->part.ranks, build_space(c, messages), messages);
    if (status == SELAS_OK) status = general_create(c, messages);
    if (status == SELAS_OK && layer_anywhere(c->model.scene)) status = pml_create(c, messages);
    return status == SELAS_OK && c->pml != NULL ? general_layers_create(c, messages) : status;
}

static selas_status build(struct consistent *c, struct messages *messages)
{
    if (c->options.general) return build_general(c, messages);
    selas_status status = build_space(c, messages);
    if (status == SELAS_OK && c->hform != NULL && !c->options.unfused && !fused_create(c))
        status = fail(messages, SELAS_NO_MEMORY, "no memory for the fused operator");
    if (status == SELAS_OK && layer_anywhere(c->model.scene)) status = pml_create(c, messages);
    return status;
}

/* Layers of even and of layered ground keep nothing of u. */
static void start(struct model *model, const double *u, double *extra)
{
    struct consistent *c = consistent_of(model);
    if (c->general != NULL) general_layers_start(c, u, extra);
}

static void remember(struct model *model, double dt, const double *u, const double *v, double *extra)
{
    struct consistent *c = consistent_of(model);
    (c->general != NULL ? general_layers_remember : pml_remember)(c, dt, -dt / 2, u, v, extra);
}

static void drag(struct model *model, double dt, double *v)
{
    pml_damp(consistent_of(model), dt, v);
}

static const struct model_core core = {
    .destroy = destroy,
    .initialise = consistent_initialise,
    .probe = consistent_probe,
    .observe = consistent_observe,
    .field = consistent_field,
    .holder = consistent_holder,
    .share = consistent_share,
    .energy = energy,
    .power = power,
    .unseen = consistent_unseen,
    .describe = describe,
    .forget = forget,
};
static const struct model_operator spatial = {
    .accelerate = accelerate,
    .weigh = weigh,
    .shorten = consistent_shorten,
};
static const struct model_memory memory = {start, remember, drag};

selas_status consistent_create_with(const struct scene *scene, const struct consistent_options *options,
                                    struct model **model, struct messages *messages)
{
    *model = NULL;
    selas_status status = consistent_check(scene, options, messages);
    if (status != SELAS_OK) return status;
    struct consistent *c = array_new(1, sizeof *c);
    if (c == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for a model");
    c->options = *options;
    c->dimension = scene->dimension;
    c->model.method = &method_consistent;
    c->model.core = &core;
    c->model.spatial = &spatial;
    c->model.scene = scene;
    c->model.self_adjoint = true;
    c->model.small_strain = true;
    c->model.waves = consistent_waves(options);
    status = build(c, messages);
    if (c->pml != NULL) c->model.memory = &memory;
    c->model.layers = c->pml != NULL;
    if (status == SELAS_OK) c->model.shallow = consistent_shallow(c);
    c->model.state_size = 2 * c->model.unknowns + (c->pml != NULL ? c->pml->extra : 0);
    if (status == SELAS_OK)
        status = (c->general != NULL ? general_steps_create : fused_steps_create)(c, messages);
    if (options->general) status = ranks_agree(c->part.ranks, status, messages);
    if (status != SELAS_OK) {
        destroy(&c->model);
        return status;
    }
    c->model.whole_unknowns = (size_t)c->dimension;
    for (int slot = 0; slot < 3; slot++)
        c->model.whole_unknowns *= c->part.along[slot].whole;
    c->model.component_stride = c->volume;
    c->model.point_stride = 1;
    c->model.frame = scene->body.rotated ? scene->body.frame : NULL;
    c->model.bytes = sizeof *c + tensor_plan_bytes(c->stiffness) + tensor_plan_bytes(c->mass) +
                     forces_bytes(c) + hform_bytes(c);
    if (c->general != NULL) {
        c->model.setup_bytes = c->model.bytes + c->general->setup_bytes;
        c->model.bytes += c->general->bytes;
    }
    c->model.bytes += (c->fused != NULL ? c->fused->bytes : 0) + (c->pml != NULL ? c->pml->bytes : 0);
    *model = &c->model;
    return SELAS_OK;
}

static selas_status create(const struct scene *scene, struct model **model, struct messages *messages)
{
    const struct consistent_options options = consistent_options_of(scene);
    return consistent_create_with(scene, &options, model, messages);
}

const struct method method_consistent = {
    .name = "smoothed-point",
    .variant = "consistent",
    .words = "degree ends mass tuned depth_mass dissipation fused quiet operator mechanisms",
    .faces = CAN_HOLD | CAN_MOVE | CAN_MIRROR | CAN_DAMP | CAN_ABSORB,
    .mirrors = true,
    .single = true,
    .any_ground = true,
    .damping = true,
    .ranks = true,
    .create = create,
};
