/* The consistent smoothed point method (manual, doc/consistent-method.md): Ding et al. (2006), Eq 14, with
 * the smoothing kept on both sides, which is Galerkin's method with tensor-product B-splines:
 *
 *   M a + C v + K u = F.
 *
 * Here: the model's making, its acceleration and energies. */
#include "method/fused.h"
#include "method/moving_load.h"
#include "method/pml.h"

#include "base/memory.h"

#include <math.h>
#include <omp.h>
#include <stdio.h>
#include <string.h>

static void destroy(struct model *model)
{
    struct consistent *c = consistent_of(model);
    pml_free(c);
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
    array_free(c->plane_class);
    array_free(c->class_plane);
    array_free(c->line_buffer);
    array_free(c->face_buffer);
    array_free(c->own_scene);
    array_free(c);
}

/* Control values of a component on a held face: the mass solve leaves 0 there. */
void consistent_clear_held(const struct consistent *c, int component, size_t k, double *plane)
{
    for (int face = 0; face < 2 * c->dimension; face++) {
        if (!c->held[component][face]) continue;
        const int slot = c->slot[face / 2];
        const size_t at = face % 2 == 0 ? 0 : c->n[slot] - 1;
        if (slot == 0)
            for (size_t j = 0; j < c->n[1]; j++)
                plane[j * c->n[0] + at] = 0;
        else if (slot == 1)
            memset(plane + at * c->n[0], 0, c->n[0] * sizeof *plane);
        else if (k == at)
            memset(plane, 0, c->plane * sizeof *plane);
    }
}

/* F - K u - C v - M_IB a_B in plane k. */
static void residual_plane(const struct consistent *c, const struct drive *drive, int thread, size_t k,
                           const double *u, const double *v, double *a)
{
    double *out[3] = {NULL, NULL, NULL};
    for (int component = 0; component < c->dimension; component++) {
        out[component] = a + (size_t)component * c->volume + k * c->plane;
        memset(out[component], 0, c->plane * sizeof *a);
    }
    tensor_plane(c->stiffness, thread, k, -1, u, out);
    if (v != NULL && c->model.damped) dampers_subtract(c, thread, k, v, out);
    for (int component = 0; component < c->dimension; component++) {
        add_forces(c, drive, c->load, c->inertia, component, k, out[component]);
        moving_loads_add(c, drive, component, k, out[component]);
        consistent_clear_held(c, component, k, out[component]);
    }
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
#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (size_t k = 0; k < c->n[DEPTH]; k++)
        residual_plane(c, drive, omp_get_thread_num(), k, u, v, a);
    mass_solve(c, factors, a);
}

static void accelerate(struct model *model, const struct drive *drive, double half_step, const double *u,
                       const double *v, double *a)
{
    struct consistent *c = consistent_of(model);
    moving_loads_place(c, drive->time, c->hform != NULL);
    if (c->hform != NULL)
        hform_accelerate(c, drive, half_step, u, v, a);
    else
        exact_accelerate(c, drive, half_step, u, v, a);
    set_moving(c, drive, a);
    model->evaluations++;
}

static void energy(struct model *model, const double *y, struct energy *energy)
{
    struct consistent *c = consistent_of(model);
    const double *v = y + model->unknowns;
    bool moving = false;
    for (int face = 0; face < BOX_FACES; face++)
        moving = moving || c->moving[face];
    if (c->hform != NULL && !moving) {
        hform_energy(c, y, energy);
        return;
    }
    energy->kinetic = tensor_form(c->mass, v, v) / 2;
    energy->strain = tensor_form(c->stiffness, y, y) / 2;
}

static void weigh(struct model *model, const double *v, double *product)
{
    struct consistent *c = consistent_of(model);
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
            *load += drive->load[l] * model->scene->load[l].amplitude * sparse_dot(c, &c->load[l], v);
    if (c->moving_loads > 0) {
        moving_loads_place(c, drive->time, false);
        *load += moving_loads_power(c, drive, v);
    }
    *absorbed = c->hform != NULL ? hform_damper_power(c, v) : dampers_power(c, v);
    if (c->hform != NULL) *absorbed += hform_dissipation_power(c, v);
}

static void describe(const struct model *model,
                     void (*tell)(void *context, const char *key, const char *value), void *context)
{
    const struct consistent *c = (const struct consistent *)model;
    char text[160];
    snprintf(text, sizeof text, "B-splines of degree %d, %s ends", c->options.degree,
             c->options.mapped ? "mapped" : "open");
    tell(context, "basis", text);
    snprintf(text, sizeof text, "van Cittert, %d sweeps (H-form%s)", c->options.sweeps,
             c->options.depth_exact ? ", exact over depth in the stiffness" : "");
    if (c->options.tuned) tell(context, "splines along the surface", "tuned for short waves");
    tell(context, "mass", c->options.sweeps == 0 ? "exact (banded Cholesky per axis)" : text);
    if (c->fused != NULL) {
        snprintf(text, sizeof text, "fused, %d planes at a time in strips of %d rows", FUSED_PLANES,
                 FUSED_STRIP);
        tell(context, "operator", text);
        tell(context, "step",
             model->single                   ? "leapfrog's is one pass with the operator, in single precision"
             : model->class->advance != NULL ? "leapfrog's is one pass with the operator"
                                             : "apart from the operator");
        snprintf(text, sizeof text, "what is below %g of the largest displacement moves nothing",
                 c->fused->quiet);
        tell(context, "quiet parts", c->fused->quiet > 0 ? text : "all are computed");
        const struct fused *used = model->single ? c->fused->single : c->fused;
        if (used->skipped > 0) {
            snprintf(text, sizeof text, "%.1f %% of points, all calls so far",
                     100 * (double)used->skipped / (double)used->points);
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
}

/* What each face does to each component's control values, in the body's frame. */
static void lay_faces(struct consistent *c)
{
    const struct scene *scene = c->model.scene;
    for (int face = 0; face < 2 * c->dimension; face++) {
        const struct boundary *boundary = &scene->boundary[face];
        const int axis = face / 2;
        const struct spline *spline = c->spline[axis];
        double direction[3];
        memcpy(direction, boundary->direction, sizeof direction);
        if (scene->body.rotated) body_direction_from_deck(&scene->body, boundary->direction, direction);
        c->moving[face] = boundary->kind == BOUNDARY_VELOCITY || boundary->kind == BOUNDARY_DISPLACEMENT;
        c->damped[face] = boundary->kind == BOUNDARY_TRANSMITTING && boundary->absorber == ABSORBER_LYSMER;
        c->model.damped = c->model.damped || c->damped[face];
        for (int component = 0; component < c->dimension; component++) {
            const bool normal = component == axis;
            bool *held = &c->held[component][face];
            c->motion[face][component] = boundary->amplitude * direction[component];
            if (boundary->kind == BOUNDARY_FIXED || c->layer[face] > 0) *held = true;
            if (boundary->kind == BOUNDARY_ROLLER) *held = normal;
            if (boundary->kind == BOUNDARY_SYMMETRY)
                *held = normal && (!spline->mirror[face % 2] || spline->centred[face % 2]);
            if (c->moving[face]) *held = !boundary->slip || fabs(direction[component]) > 1e-9;
        }
    }
}

/* Depths below the low end of the last axis where the material changes, as positions. */
static size_t interfaces(const struct body *body, int axis, double *at)
{
    size_t count = 0;
    for (size_t i = 0; i < body->layers; i++) {
        const double x = body->low[axis] + body->layer[i].top;
        const double small = 1e-9 * (body->high[axis] - body->low[axis]);
        if (x > body->low[axis] + small && x < body->high[axis] - small) at[count++] = x;
    }
    return count;
}

static selas_status lay_axes(struct consistent *c, struct messages *messages)
{
    static const int slots[3][3] = {{2, 0, 0}, {0, 2, 0}, {0, 1, 2}};
    const struct body *body = &c->model.scene->body;
    double *interface = array_new(body->layers, sizeof *interface);
    if (interface == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the axes");
    for (int axis = 0; axis < 3; axis++)
        c->n[axis] = 1;
    selas_status status = SELAS_OK;
    for (int axis = 0; axis < c->dimension && status == SELAS_OK; axis++) {
        struct spline_choice choice = {.degree = c->options.degree,
                                       .low = body->low[axis],
                                       .high = body->high[axis],
                                       .spacing = body->spacing,
                                       .mapped = c->options.mapped,
                                       .interface = interface};
        const double cells = round((choice.high - choice.low) / choice.spacing);
        if (c->layer[2 * axis] + c->layer[2 * axis + 1] > 0)
            choice.spacing = (choice.high - choice.low) / fmax(cells, 1);
        choice.low -= (double)c->layer[2 * axis] * choice.spacing;
        choice.high += (double)c->layer[2 * axis + 1] * choice.spacing;
        c->slot[axis] = slots[c->dimension - 1][axis];
        if (c->slot[axis] == DEPTH) choice.interfaces = interfaces(body, axis, interface);
        const struct boundary *boundary = &c->model.scene->boundary[2 * axis];
        for (int end = 0; end < 2; end++)
            choice.mirror[end] = boundary[end].kind == BOUNDARY_SYMMETRY;
        if (choice.mirror[0] && choice.mirror[1] && cells <= 2 * choice.degree)
            choice.mirror[0] = choice.mirror[1] = false; /* too thin: the normal component is held instead */
        c->spline[axis] = spline_new(&choice, messages);
        if (c->spline[axis] == NULL)
            status = messages->no_memory ? SELAS_NO_MEMORY : SELAS_BAD_SCENE;
        else
            c->n[c->slot[axis]] = c->spline[axis]->count;
        if (status == SELAS_OK && c->options.tuned && c->slot[axis] != DEPTH && !spline_tune(c->spline[axis]))
            status = fail(messages, SELAS_NO_MEMORY, "no memory for the axes");
        c->layout[c->slot[axis]] = c->spline[axis];
    }
    array_free(interface);
    c->plane = c->n[0] * c->n[1];
    c->volume = c->plane * c->n[2];
    /* a thread that has less than this many values to work on costs more than it helps */
    const size_t worth = 1 + c->volume / 4000, all = (size_t)omp_get_max_threads();
    c->threads = (int)(worth < all ? worth : all);
    c->model.unknowns = (size_t)c->dimension * c->volume;
    return status;
}

static void properties(const struct material *material, double property[WEIGHT_NONE])
{
    property[WEIGHT_DENSITY] = material->density;
    property[WEIGHT_LAMBDA] = material->plane_lambda;
    property[WEIGHT_MU] = material->mu;
    property[WEIGHT_P] = material->plane_lambda + 2 * material->mu;
}

/* Material by element of the depth axis. */
static bool lay_material(struct consistent *c)
{
    const struct scene *scene = c->model.scene;
    properties(&scene->material[scene->body.material], c->property);
    if (scene->body.layers == 0) return true;
    const struct spline *spline = c->layout[DEPTH];
    for (int weight = 0; weight < WEIGHT_NONE; weight++) {
        c->weighted[weight] = array_new(spline->elements, sizeof(double));
        if (c->weighted[weight] == NULL) return false;
    }
    for (size_t e = 0; e < spline->elements; e++) {
        const double middle = (spline->element[e].x_from + spline->element[e].x_to) / 2;
        double property[WEIGHT_NONE];
        properties(scene_material_at(scene, middle - scene->body.low[c->dimension - 1]), property);
        for (int weight = 0; weight < WEIGHT_NONE; weight++)
            c->weighted[weight][e] = property[weight];
    }
    return true;
}

/* Planes of control values by their material, and the damped faces' speeds there. */
static bool lay_planes(struct consistent *c)
{
    const struct scene *scene = c->model.scene;
    const size_t n = c->n[DEPTH];
    c->plane_class = array_new(n, sizeof *c->plane_class);
    c->class_plane = array_new(n, sizeof *c->class_plane);
    if (c->plane_class == NULL || c->class_plane == NULL) return false;
    for (int face = 0; face < 2 * c->dimension; face++)
        for (int component = 0; component < c->dimension; component++) {
            c->speed[face][component] = array_new(n, sizeof(double));
            if (c->speed[face][component] == NULL) return false;
        }
    const struct material *before = NULL;
    for (size_t k = 0; k < n; k++) {
        const struct spline *spline = c->layout[DEPTH];
        const struct material *material =
            scene->body.layers == 0
                ? &scene->material[scene->body.material]
                : scene_material_at(scene, spline->greville[k] - scene->body.low[c->dimension - 1]);
        if (material == NULL) return false;
        if (material != before) c->class_plane[c->classes++] = k;
        before = material;
        c->plane_class[k] = c->classes - 1;
        for (int face = 0; face < 2 * c->dimension; face++)
            for (int component = 0; component < c->dimension; component++) {
                const struct boundary *boundary = &scene->boundary[face];
                c->speed[face][component][k] = component == face / 2
                                                   ? boundary->normal_factor * material->p_speed
                                                   : boundary->shear_factor * material->s_speed;
            }
    }
    return true;
}

double consistent_fastest(const struct consistent *c, int face)
{
    const struct scene *scene = c->model.scene;
    const struct body *body = &scene->body;
    double fastest = scene->material[body->material].p_speed;
    if (body->layers == 0) return fastest;
    const double depth = body->high[c->dimension - 1] - body->low[c->dimension - 1];
    if (c->slot[face / 2] == DEPTH) return scene_material_at(scene, face % 2 == 0 ? 0 : depth)->p_speed;
    for (size_t i = 0; i < body->layers; i++)
        fastest = fmax(fastest, scene->material[body->layer[i].material].p_speed);
    return fastest;
}

static selas_status build(struct consistent *c, struct messages *messages)
{
    for (int face = 0; face < 2 * c->dimension; face++)
        c->layer[face] = layer_points(c->model.scene, face);
    selas_status status = lay_axes(c, messages);
    if (status != SELAS_OK) return status;
    lay_faces(c);
    if (!lay_material(c) || !lay_planes(c) || !consistent_plans(c) || !mass_allocate(c) ||
        !dampers_allocate(c) || !observe_create(c) || !collocation_create(c))
        return fail(messages, SELAS_NO_MEMORY, "no memory for a model of %zu control values", c->volume);
    status = forces_create(c, messages);
    if (status == SELAS_OK && c->options.sweeps > 0) status = hform_create(c, messages);
    if (status == SELAS_OK && layer_anywhere(c->model.scene)) status = pml_create(c, messages);
    return status;
}

static void remember(struct model *model, double dt, double *y)
{
    double *v = y + model->unknowns;
    pml_remember(consistent_of(model), dt, -dt / 2, y, v, v + model->unknowns);
    pml_damp(consistent_of(model), dt, v);
}

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
    c->own_class = consistent_class;
    c->model.class = &c->own_class;
    c->model.scene = scene;
    c->model.self_adjoint = true;
    status = build(c, messages);
    if (c->pml != NULL) c->own_class.remember = remember;
    if (c->pml != NULL) c->own_class.unseen = layers_fastest;
    c->model.state_size = 2 * c->model.unknowns + (c->pml != NULL ? c->pml->extra : 0);
    if (status == SELAS_OK) status = fused_steps_create(c, messages);
    if (status != SELAS_OK) {
        destroy(&c->model);
        return status;
    }
    c->model.component_stride = c->volume;
    c->model.point_stride = 1;
    c->model.frame = scene->body.rotated ? scene->body.frame : NULL;
    c->model.bytes = sizeof *c + tensor_plan_bytes(c->stiffness) + tensor_plan_bytes(c->mass) +
                     forces_bytes(c) + hform_bytes(c) + (c->pml != NULL ? c->pml->bytes : 0);
    *model = &c->model;
    return SELAS_OK;
}

static selas_status create(const struct scene *scene, struct model **model, struct messages *messages)
{
    const struct consistent_options options = consistent_options_of(scene);
    return consistent_create_with(scene, &options, model, messages);
}

const struct model_class consistent_class = {
    .method = "smoothed-point",
    .variant = "consistent",
    .mirrors = true,
    .create = create,
    .destroy = destroy,
    .accelerate = accelerate,
    .initialise = consistent_initialise,
    .probe = consistent_probe,
    .observe = consistent_observe,
    .field = consistent_field,
    .energy = energy,
    .weigh = weigh,
    .shorten = consistent_shorten,
    .power = power,
    .describe = describe,
};
