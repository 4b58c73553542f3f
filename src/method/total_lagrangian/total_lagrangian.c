/* Total-Lagrangian SPH, method 'sph', variant 'total-lagrangian': the model behind the method table.
 *
 * Points carry reference volumes; the energy is the sum of V_i psi(grad u_i) with least-squares gradients in
 * the reference configuration, the forces are minus its exact derivatives (force.c), the
 * mass is rho V_i. So M u'' + dE/du = F with M diagonal and E bounded below: in the linear regime the
 * spectrum is imaginary whatever the points and weights. Vignjevic, Reveles & Campbell 2006 for the
 * reference-configuration form, doc/theory/sph-total-lagrangian.md for the derivation. */
#include "method/total_lagrangian/run_loops.h"
#include "method/total_lagrangian/setup.h"

#include "base/memory.h"
#include "scene/initial.h"

#include <stdio.h>
#include <string.h>

static struct tl_model *of(struct model *model)
{
    return (struct tl_model *)model;
}

struct tl_options tl_default_options(void)
{
    return (struct tl_options){
        .degree = 2, .hourglass = 0.1, .kernel = kernel_find("cubic"), .law = LAW_SAINT_VENANT_KIRCHHOFF};
}

void tl_free(struct tl_model *tl)
{
    if (tl == NULL) return;
    for (size_t k = 0; tl->load != NULL && k < tl->model.scene->loads; k++) {
        array_free(tl->load[k].point);
        array_free(tl->load[k].force);
    }
    tl_part_free(&tl->part);
    tl_rows_free(&tl->gradient);
    tl_rows_free(&tl->transposed);
    tl_rows_free(&tl->pair);
    tl_rows_free(&tl->viscous);
    neighbours_free(&tl->near);
    cloud_free(&tl->cloud);
    void *const arrays[] = {tl->deck_position,
                            tl->site_position,
                            tl->place,
                            tl->ghost,
                            tl->source,
                            tl->returned_start,
                            tl->returned,
                            tl->gradient_blocks.block,
                            tl->stress_blocks.block,
                            tl->force_blocks.block,
                            tl->all_gradients.block,
                            tl->mass,
                            tl->dampers.damper,
                            tl->held,
                            (void *)tl->material,
                            tl->elastic,
                            tl->load,
                            tl->numbers,
                            tl->own_scene,
                            tl->site_v,
                            tl->found,
                            tl->spacing};
    for (size_t k = 0; k < sizeof arrays / sizeof *arrays; k++)
        array_free(arrays[k]);
    array_free(tl);
}

static void destroy(struct model *model)
{
    tl_free(of(model));
}

/* All forces but the dampers' into tl->force. */
static void all_forces(struct tl_model *tl, const struct drive *drive, const double *u, const double *v)
{
    tl_keep_amplitudes(tl, drive);
    tl_sites(tl, u, v, drive->displacement, drive->velocity);
    tl_gradients(tl);
    tl_forces(tl);
    if (tl->site_v != NULL && v != NULL) tl_viscosity(tl);
    tl_add_loads(tl, drive);
    tl->model.evaluations++;
}

static void accelerate(struct model *model, const struct drive *drive, double half_step, const double *u,
                       const double *v, double *a)
{
    struct tl_model *tl = of(model);
    const size_t d = (size_t)tl->cloud->dimension;
    const struct tl_set *own = &tl->part.own;
    all_forces(tl, drive, u, v);
    tl_damp(tl, half_step, v);
    tl_keep_window(tl, a);
#pragma omp parallel for schedule(static) if (own->points > TL_SERIAL)
    for (size_t r = 0; r < own->count; r++)
        for (size_t i = own->range[r].from; i < own->range[r].end; i++)
            for (size_t k = d * i; k < d * (i + 1); k++)
                a[k] = tl->force[k] / tl->mass[i];
    for (size_t k = 0; k < tl->held_count; k++)
        a[tl->held[k]] = 0;
    tl_exchange(tl, a);
}

static void rate(struct model *model, const struct drive *drive, const double *y, double *dydt)
{
    const size_t n = model->unknowns;
    memcpy(dydt, y + n, n * sizeof *y);
    accelerate(model, drive, 0, y, y + n, dydt + n);
}

static void linearise(struct model *model, bool on)
{
    of(model)->linear = on;
}

static void initialise(struct model *model, double *y)
{
    const struct tl_model *tl = of(model);
    const struct body *body = &model->scene->body;
    const size_t d = (size_t)tl->cloud->dimension;
    for (size_t i = 0; i < tl->cloud->points; i++) {
        double displacement[3];
        double velocity[3];
        double own[3];
        initial_at(model->scene, tl->deck_position + 3 * i, displacement, velocity);
        body_direction_from_deck(body, displacement, own);
        memcpy(y + d * i, own, d * sizeof *y);
        body_direction_from_deck(body, velocity, own);
        memcpy(y + model->unknowns + d * i, own, d * sizeof *y);
    }
    tl_keep_window(tl, y);
    tl_keep_window(tl, y + model->unknowns);
}

static void describe(const struct model *model,
                     void (*tell)(void *context, const char *key, const char *value), void *context)
{
    const struct tl_model *tl = (const struct tl_model *)model;
    char text[64];
    tell(context, "gradient",
         tl->options.form != NULL  ? tl->options.form->gradient
         : tl->options.central     ? "central"
         : tl->options.degree == 2 ? "quadratic"
                                   : "linear");
    tell(context, "law", elastic_law_name(tl->options.law));
    snprintf(text, sizeof text, "%s", tl->options.kernel->name);
    tell(context, "kernel", text);
    snprintf(text, sizeof text, "%.1f", tl->part.neighbours / (double)tl->cloud->whole);
    tell(context, "neighbours a point", text);
    snprintf(text, sizeof text, "%.0f", tl->part.ghosts);
    tell(context, "ghosts", text);
    snprintf(text, sizeof text, "%g", tl->options.hourglass);
    tell(context, "hourglass control", text);
    snprintf(text, sizeof text, "%g, %g", tl->options.viscosity_alpha, tl->options.viscosity_beta);
    tell(context, "viscosity alpha, beta", text);
    tl_describe_part(tl, tell, context);
}

static const struct model_core core = {
    .destroy = destroy,
    .initialise = initialise,
    .probe = tl_model_probe,
    .observe = tl_observe,
    .field = tl_field,
    .energy = tl_energy,
    .power = tl_power,
    .describe = describe,
};
static const struct model_core shared_core = {
    .destroy = destroy,
    .initialise = initialise,
    .probe = tl_model_probe,
    .observe = tl_observe,
    .field = tl_field,
    .holder = tl_holder,
    .share = tl_share,
    .energy = tl_energy,
    .power = tl_power,
    .unseen = tl_unseen,
    .describe = describe,
};
/* Every rank has all points, and what is right there on demand alone. */
static const struct model_core divided_core = {
    .destroy = destroy,
    .initialise = initialise,
    .probe = tl_model_probe,
    .observe = tl_observe,
    .field = tl_field,
    .complete = tl_complete,
    .energy = tl_energy,
    .power = tl_power,
    .unseen = tl_unseen,
    .describe = describe,
};
/* Hooke's law makes the model linear as a whole (without viscosity). */
static const struct model_operator linear_operator = {
    .accelerate = accelerate,
    .rate = rate,
    .weigh = tl_weigh,
    .shorten = tl_shorten,
};
static const struct model_operator nonlinear_operator = {
    .accelerate = accelerate,
    .rate = rate,
    .weigh = tl_weigh,
    .linearise = linearise,
    .shorten = tl_shorten,
};

selas_status tl_fill_points(struct tl_model *tl, struct messages *messages)
{
    const struct scene *scene = tl->model.scene;
    const size_t n = tl->cloud->points;
    const size_t d = (size_t)scene->dimension;
    tl->mass = array_new(n, sizeof *tl->mass);
    tl->material = array_new(n, sizeof(void *));
    tl->elastic = array_new(n, sizeof *tl->elastic);
    tl->deck_position = array_new(3 * n, sizeof *tl->deck_position);
    tl->found = array_new(n, sizeof *tl->found);
    tl->spacing = array_new(n, sizeof *tl->spacing);
    if (tl->mass == NULL || tl->material == NULL || tl->elastic == NULL || tl->deck_position == NULL ||
        tl->found == NULL || tl->spacing == NULL)
        return fail(messages, SELAS_NO_MEMORY, "no memory for %zu points", n);
    for (size_t i = 0; i < n; i++) {
        const double *x = tl->cloud->position + 3 * i;
        tl->material[i] =
            scene_point_material(scene, tl->cloud->first + i, x[d - 1] - scene->body.low[d - 1]);
        tl->elastic[i] = elastic_of(tl->material[i], tl->options.law, scene->dimension, scene->plane);
        tl->mass[i] = tl->material[i]->density * tl->cloud->volume[i];
        /* of clouds points on faces have half volumes */
        const double *volume = tl->cloud->volume + i;
        if (i > 0 && volume[0] == volume[-1])
            tl->spacing[i] = tl->spacing[i - 1];
        else
            tl->spacing[i] = tl->options.form != NULL ? tl->cloud->spacing : pow(*volume, 1.0 / (double)d);
        body_to_deck(&scene->body, x, tl->deck_position + 3 * i);
    }
    return neighbours_cells(&tl->near, scene->dimension, n, tl->cloud->position, tl_search_radius(tl),
                            messages);
}

static void fill_model(struct tl_model *tl)
{
    struct model *model = &tl->model;
    const size_t d = (size_t)tl->cloud->dimension;
    const size_t n = tl->cloud->points;
    if (tl->part.ranks != NULL) model->core = tl->part.shared ? &shared_core : &divided_core;
    const bool viscous = tl->site_v != NULL;
    model->spatial = tl->options.law == LAW_LINEAR && !viscous ? &linear_operator : &nonlinear_operator;
    const bool soft = tl->options.degree > 1 || tl->cloud->dimension > 2; /* (section 10) */
    model->patch = tl->options.form == NULL && !tl->options.central && soft ? PATCH_RINGS : PATCH_WHOLE;
    model->waves = tl_waves(tl);
    model->points = tl->cloud->whole;
    if (tl->cloud->all != NULL)
        model->position = tl->cloud->all->position;
    else if (tl->part.shared)
        model->place = cloud_place;
    else
        model->position = tl->deck_position;
    model->number = tl->cloud->number;
    memcpy(model->grid, tl->cloud->grid, sizeof model->grid);
    model->unknowns = d * n;
    model->state_size = 2 * d * n;
    if (tl->part.ranks != NULL) model->whole_unknowns = d * model->points;
    model->component_stride = 1;
    model->point_stride = d;
    model->damped = tl->dampers.damper != NULL || viscous;
    model->self_adjoint = true;
    model->small_strain = tl->options.law == LAW_LINEAR;
    if (model->scene->body.rotated) model->frame = model->scene->body.frame;
    model->bytes = sizeof *tl + tl_rows_bytes(&tl->gradient) + tl_rows_bytes(&tl->transposed) +
                   tl_rows_bytes(&tl->pair) + tl_rows_bytes(&tl->viscous) + neighbours_bytes(&tl->near) +
                   tl->sites * (3 + (viscous ? 4 : 3) * d + d * d) * sizeof(double) +
                   n * (9 + d * d + 2 * d) * sizeof(double) + n * sizeof(struct elastic) +
                   tl->ghosts * sizeof(struct tl_ghost);
    if (tl->cloud->number != NULL) model->bytes += tl->cloud->whole * sizeof *tl->cloud->number;
    if (tl->cloud->all == NULL) return;
    model->bytes += 3 * tl->cloud->whole * sizeof *tl->cloud->all->position;
    model->setup_bytes = tl->cloud->whole * CLOUD_READING;
}

/* The arrays that the loops read and write, in one piece of memory: a processor takes a load for one of what
 * an earlier instruction stores, and waits, if both are at the same place of a page, as they would be for
 * points near each other if all arrays began at the same place. */
static selas_status allocate_numbers(struct tl_model *tl, struct messages *messages)
{
    enum { PAGE = 512, APART = 72, ARRAYS = 5 };
    const size_t d = (size_t)tl->cloud->dimension;
    tl->plane =
        ((d * tl->sites + GROUP - 1) / PAGE + 1) * PAGE + APART; /* room to read a vector at the last point */
    const size_t counts[ARRAYS] = {tl->plane, tl->plane, tl->plane, d * tl->plane, d * tl->plane};
    double **const arrays[ARRAYS] = {&tl->site_u, &tl->force, &tl->extra, &tl->H, &tl->A};
    size_t total = 0;
    for (size_t k = 0; k < ARRAYS; k++)
        total += counts[k];
    tl->numbers = array_new(total, sizeof *tl->numbers);
    if (tl->numbers == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for %zu sites", tl->sites);
    for (size_t k = 0, place = 0; k < ARRAYS; place += counts[k++])
        if (k != 2 || tl->options.hourglass > 0) *arrays[k] = tl->numbers + place;
    return SELAS_OK;
}

selas_status total_lagrangian_create(const struct scene *scene, const struct tl_options *options,
                                     struct model **model, struct messages *messages)
{
    *model = NULL;
    struct tl_model *tl = array_new(1, sizeof *tl);
    if (tl == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the model");
    tl->model.scene = scene;
    tl->model.method = options->form != NULL ? options->form->method : &method_total_lagrangian;
    tl->model.core = &core;
    tl->options = *options;
    const struct tl_form *form = options->form;
    selas_status status = tl_make_points(tl, messages);
    if (status == SELAS_STOPPED) {
        destroy(&tl->model);
        return status;
    }
    if (status == SELAS_OK && options->central && tl->cloud->grid[0] == 0)
        status =
            fail(messages, SELAS_UNSUPPORTED,
                 "method%%gradient = 'central' needs points on a lattice without jitter; take 'quadratic' or "
                 "'linear'");
    if (status == SELAS_OK) status = tl_fill_points(tl, messages);
    status = tl_make_rows(tl, status, messages);
    if (status == SELAS_OK && form != NULL) status = form->hold(tl, messages);
    if (status == SELAS_OK) status = allocate_numbers(tl, messages);
    status = tl_agree(tl, status, messages);
    if (status == SELAS_OK) status = tl_make_loads(tl, messages);
    if (status == SELAS_OK) status = tl_make_dampers(tl, messages);
    status = tl_agree(tl, status, messages);
    if (status == SELAS_OK) status = tl_share_points(tl, messages);
    if (status != SELAS_OK) {
        destroy(&tl->model);
        return status;
    }
    fill_model(tl);
    *model = &tl->model;
    return SELAS_OK;
}

static void read_real(const struct deck_group *group, const char *name, double *value)
{
    if (deck_values(group, name) > 0) *value = deck_real(group, name, 0);
}

/* Parts of a damped body (method/damped/damped.h) take e_p in the place of u: only what is linear in u can, and
 * moved walls have no memory. */
static selas_status check_part(const struct scene *scene, const struct tl_options *options,
                               struct messages *messages)
{
    const struct deck_group *group = scene->method.group;
    if (options->law != LAW_LINEAR)
        return deck_error(scene->deck, group, "law", messages,
                          "damping by q_p and q_s is linear; expected law = 'linear'");
    if (options->viscosity_alpha > 0 || options->viscosity_beta > 0)
        return deck_error(scene->deck, group,
                          options->viscosity_alpha > 0 ? "viscosity_alpha" : "viscosity_beta", messages,
                          "viscosity is not linear, beside q_p and q_s; expected 0");
    for (int face = 0; face < FACES; face++)
        if (boundary_moves(&scene->boundary[face]))
            return fail(messages, SELAS_UNSUPPORTED,
                        "face %s is moved, which 'total-lagrangian' does not take beside q_p and q_s; "
                        "'smoothed-point', 'consistent' does",
                        face_name((enum face)face));
    return SELAS_OK;
}

static selas_status create(const struct scene *scene, struct model **model, struct messages *messages)
{
    struct tl_options options = tl_default_options();
    const struct deck_group *group = scene->method.group;
    if (deck_values(group, "kernel") > 0) options.kernel = kernel_find(deck_text(group, "kernel", 0));
    if (deck_values(group, "gradient") > 0)
        options.degree = deck_chosen(group, "gradient", "quadratic") ? 2 : 1;
    options.central = deck_chosen(group, "gradient", "central");
    if (options.central) options.hourglass = 0.5; /* doc/theory/sph-total-lagrangian.md, section 10 */
    if (deck_values(group, "law") > 0) options.law = (enum elastic_law)deck_choice(group, "law", 0);
    read_real(group, "smoothing_length", &options.smoothing_length);
    read_real(group, "hourglass", &options.hourglass);
    read_real(group, "viscosity_alpha", &options.viscosity_alpha);
    read_real(group, "viscosity_beta", &options.viscosity_beta);
    const selas_status status = scene->whole != NULL ? check_part(scene, &options, messages) : SELAS_OK;
    if (status != SELAS_OK) return status;
    return total_lagrangian_create(scene, &options, model, messages);
}

const struct method method_total_lagrangian = {
    .name = "sph",
    .variant = "total-lagrangian",
    .words = "kernel smoothing_length viscosity_alpha viscosity_beta hourglass gradient law mechanisms",
    .damping = true,
    .ranks = true,
    .point_materials = true,
    .faces = CAN_HOLD | CAN_MOVE | CAN_MIRROR | CAN_DAMP,
    .create = create,
};
