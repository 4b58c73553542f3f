/* What users see of updated-Lagrangian SPH: initial state, point values, fields, energies. */
#include "base/memory.h"
#include "method/updated_lagrangian/updated_lagrangian.h"
#include "scene/initial.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static size_t stress_offset(const struct updated *updated)
{
    return 2 * updated->model.unknowns + updated->held;
}

/* The stress of an initial displacement is Hooke's law of its gradient, taken with the method's own rates:
 * with v = u and no stress, ds/dt is lambda tr(e) I + 2 mu e of the displacement. */
void updated_initialise(struct model *model, double *y)
{
    struct updated *updated = updated_of(model);
    const struct scene *scene = model->scene;
    const size_t dimension = (size_t)updated->dimension, held = updated->held;
    const size_t unknowns = model->unknowns, extra = stress_offset(updated);
    for (size_t i = 0; i < held; i++)
        y[2 * unknowns + i] = updated->material->density;
    if (scene->initial.kind == INITIAL_REST) return;
    double place[3], displacement[3], velocity[3], own[3];
    for (size_t i = 0; i < held; i++) {
        model_position(model, updated->first + i, place);
        initial_at(scene, place, displacement, velocity);
        body_direction_from_deck(&scene->body, displacement, own);
        memcpy(y + unknowns + dimension * i, own, dimension * sizeof *y);
    }
    double *rate = array_new(model->state_size, sizeof *rate);
    if (updated_all_have(updated, rate != NULL) && rate != NULL) {
        const struct drive quiet = {.time = 0};
        const unsigned long evaluations = model->evaluations;
        updated_rate(model, &quiet, y, rate);
        model->evaluations = evaluations;
        for (size_t i = 0; i < held; i++) /* rho = rho_0 (1 - div u) */
            y[2 * unknowns + i] += rate[2 * unknowns + i];
        memcpy(y + extra, rate + extra, (model->state_size - extra) * sizeof *y);
    }
    array_free(rate);
    memcpy(y, y + unknowns, unknowns * sizeof *y);
    for (size_t i = 0; i < held; i++) {
        model_position(model, updated->first + i, place);
        initial_at(scene, place, displacement, velocity);
        body_direction_from_deck(&scene->body, velocity, own);
        memcpy(y + unknowns + dimension * i, own, dimension * sizeof *y);
    }
}

/* Hooke's law backwards: the elastic strain of a stress in the plane, as a symmetric gradient. */
static void strain_of(const struct updated *updated, const double *stress, double gradient[9])
{
    const double lambda = updated->material->plane_lambda, mu = updated->material->mu;
    double trace = 0;
    for (int a = 0; a < updated->dimension; a++)
        trace += stress[updated_component[updated->dimension][a][a]];
    for (int a = 0; a < updated->dimension; a++)
        for (int b = 0; b < updated->dimension; b++) {
            const double share = a == b ? lambda * trace / (2 * mu + updated->dimension * lambda) : 0;
            gradient[3 * a + b] = (stress[updated_component[updated->dimension][a][b]] - share) / (2 * mu);
        }
}

static bool is_of_state(selas_field field)
{
    return field == SELAS_STRESS || field == SELAS_STRAIN || field == SELAS_PRESSURE || field == SELAS_ENERGY;
}

/* Component c of a vector of a particle or of its image. */
static double seen_at(const struct updated *updated, size_t index, enum updated_motion motion,
                      const double *vector, size_t c)
{
    const size_t faces = index / updated->held;
    double value = vector[(size_t)updated->dimension * (index % updated->held) + c];
    for (size_t face = 0; faces >> face != 0; face++) {
        if ((faces >> face & 1) == 0) continue;
        if (updated->wall[face] == WALL_SLIP && face_axis((enum face)face) != (int)c) continue;
        value = 2 * updated->amplitude[motion][face] * updated->direction[face][c] - value;
    }
    return value;
}

static void observe_beside_walls(const struct updated *updated, const struct probe *probe, selas_field field,
                                 const double *y, const double *a, double *value)
{
    const enum updated_motion motion = field == SELAS_DISPLACEMENT ? WALL_PLACE
                                       : field == SELAS_VELOCITY   ? WALL_SPEED
                                                                   : WALL_ACCELERATION;
    const double *vector = motion == WALL_PLACE ? y : motion == WALL_SPEED ? y + updated->model.unknowns : a;
    double sum[3] = {0};
    for (size_t k = probe->count; vector != NULL && k < probe->count + probe->sites; k++)
        for (size_t c = 0; c < (size_t)updated->dimension; c++)
            sum[c] += probe->weight[k] * seen_at(updated, probe->index[k], motion, vector, c);
    body_direction_to_deck(&updated->model.scene->body, sum, value);
}

void updated_observe(struct model *model, const struct probe *probe, selas_field field, const double *y,
                     const double *a, double *value)
{
    const struct updated *updated = updated_of(model);
    if (!is_of_state(field)) {
        if (probe->sites > 0)
            observe_beside_walls(updated, probe, field, y, a, value);
        else
            probe_observe(model, probe, field, y, a, value);
        return;
    }
    const size_t stresses = (size_t)updated->stresses, dimension = (size_t)updated->dimension;
    const double *stress = y + stress_offset(updated), *v = y + model->unknowns;
    double sum[6] = {0};
    struct point_values values = {0};
    for (size_t j = 0; j < probe->count; j++) {
        for (size_t s = 0; s < stresses; s++)
            sum[s] += probe->weight[j] * stress[stresses * probe->index[j] + s];
        for (size_t c = 0; c < dimension; c++)
            values.velocity[c] += probe->weight[j] * v[dimension * probe->index[j] + c];
    }
    strain_of(updated, sum, values.gradient);
    field_from_values(model, updated->material, &values, field, value);
}

void updated_field(struct model *model, selas_field field, const double *y, const double *a, size_t from,
                   size_t end, double *value)
{
    const struct updated *updated = updated_of(model);
    const size_t stresses = (size_t)updated->stresses, dimension = (size_t)updated->dimension;
    const size_t components = (size_t)field_components(field), bytes = dimension * sizeof(double);
    for (size_t point = from; point < end; point++) {
        struct point_values values = {0};
        const size_t i = point - updated->first;
        memcpy(values.displacement, y + dimension * i, bytes);
        memcpy(values.velocity, y + model->unknowns + dimension * i, bytes);
        if (a != NULL) memcpy(values.acceleration, a + dimension * i, bytes);
        strain_of(updated, y + stress_offset(updated) + stresses * i, values.gradient);
        field_from_values(model, updated->material, &values, field, value + components * (point - from));
    }
}

/* Square of the numbers of a row: of its velocity, and in *all of them all. Alone the density is all that no field
 * shows; it is not finite, or overflows, at first. */
static double look_at(const struct updated *updated, const double *y, size_t row, double *all)
{
    const size_t d = (size_t)updated->dimension, stresses = (size_t)updated->stresses,
                 unknowns = updated->model.unknowns;
    const double *u = y + d * row, *v = u + unknowns, density = y[2 * unknowns + row],
                 *stress = y + stress_offset(updated) + stresses * row;
    double square = 0;
    *all = density * density;
    for (size_t c = 0; c < d; c++) {
        square += v[c] * v[c];
        *all += updated->part.ranks != NULL ? u[c] * u[c] + v[c] * v[c] : 0;
    }
    for (size_t s = 0; s < stresses && updated->part.ranks != NULL; s++)
        *all += stress[s] * stress[s];
    return square;
}

void updated_unseen(struct model *model, const double *y, struct unseen *found)
{
    const struct updated *updated = updated_of(model);
    double middle[3] = {0}, fastest[3] = {0};
    *found = (struct unseen){.speed = -1, .places = updated->own};
    for (size_t row = updated->lead; row < updated->lead + updated->own; row++) {
        double x[3], all;
        const double square = look_at(updated, y, row, &all);
        if (isfinite(all) && (updated->part.ranks == NULL || !(sqrt(square) > found->speed))) continue;
        model_position(model, updated->first + row, x);
        if (isfinite(all)) {
            found->speed = sqrt(square);
            memcpy(fastest, x, sizeof fastest);
            continue;
        }
        found->spoiled++;
        for (int axis = 0; axis < 3; axis++)
            middle[axis] += (x[axis] - middle[axis]) / (double)found->spoiled;
    }
    const double *place = found->spoiled > 0 ? middle : fastest;
    snprintf(found->place, sizeof found->place, "%s(%.6g, %.6g, %.6g)",
             updated->part.ranks == NULL ? "with the density of a particle, about "
             : found->spoiled > 0        ? "about "
                                         : "at ",
             place[0], place[1], place[2]);
}

void updated_energy(struct model *model, const double *y, struct energy *energy)
{
    const struct updated *updated = updated_of(model);
    const size_t stresses = (size_t)updated->stresses, dimension = (size_t)updated->dimension;
    const double *density = y + 2 * model->unknowns;
    double sum[2] = {0}; /* kinetic, strain */
    for (size_t i = updated->lead; i < updated->lead + updated->own; i++) {
        const double mass =
            updated->material->density * updated->cloud->volume[i - updated->lead + updated->made];
        const double *v = y + model->unknowns + dimension * i,
                     *stress = y + stress_offset(updated) + stresses * i;
        double gradient[9], work = 0, square = 0;
        strain_of(updated, stress, gradient);
        for (size_t p = 0; p < dimension; p++) {
            square += v[p] * v[p];
            for (size_t q = 0; q < dimension; q++)
                work += gradient[3 * p + q] * stress[updated_component[dimension][p][q]];
        }
        sum[0] += mass * square / 2;
        sum[1] += mass / density[i] * work / 2;
    }
    ranks_sum(updated->part.ranks, 2, sum);
    *energy = (struct energy){.kinetic = sum[0], .strain = sum[1]};
}

/* Power of tractions, moving walls and body forces, estimated with the outermost layer of particles: area =
 * volume over spacing, traction of a wall = the particle's own stress. Transmitting faces absorb. */
void updated_power(struct model *model, const struct drive *drive, const double *y, double *load,
                   double *absorbed)
{
    const struct updated *updated = updated_of(model);
    const struct scene *scene = model->scene;
    *load = updated_power_of_faces(updated, drive, y, absorbed);
    const size_t dimension = (size_t)updated->dimension;
    for (size_t k = 0; drive->load != NULL && k < scene->loads; k++) {
        if (scene->load[k].kind != LOAD_BODY_FORCE) continue;
        for (size_t i = updated->from; i < updated->from + updated->own; i++)
            for (size_t c = 0; c < dimension; c++)
                *load += drive->load[k] * updated->load_direction[3 * k + c] * updated_volume(updated, i) *
                         y[model->unknowns + dimension * updated_row(updated, i) + c];
    }
}

void updated_describe(const struct model *model,
                      void (*tell)(void *context, const char *key, const char *value), void *context)
{
    const struct updated *updated = (const struct updated *)model;
    const struct updated_options *options = &updated->options;
    char text[160];
    snprintf(text, sizeof text, "%.0f", updated->images);
    tell(context, "ghost particles", text);
    snprintf(text, sizeof text, "%.1f in lists", updated->pairs / (double)updated->cloud->whole);
    tell(context, "neighbours of a particle", text);
    snprintf(text, sizeof text, "%s, smoothing length %g spacings", options->kernel->name,
             options->smoothing_length);
    tell(context, "kernel", text);
    snprintf(text, sizeof text, "alpha %g, beta %g", options->alpha, options->beta);
    tell(context, "artificial viscosity", options->alpha > 0 || options->beta > 0 ? text : "off");
    snprintf(text, sizeof text, "epsilon %g", options->artificial_stress);
    tell(context, "artificial stress", options->artificial_stress > 0 ? text : "off");
    tell(context, "kernel gradient correction", options->correction ? "on" : "off");
    tell(context, "stress divergence", options->adjoint ? "adjoint of the gradient" : "as published");
    tell(context, "Jaumann rate", options->jaumann ? "on" : "off");
    snprintf(text, sizeof text, "%g", options->hourglass);
    tell(context, "hourglass control", options->hourglass > 0 ? text : "off");
    updated_describe_part(updated, tell, context);
}
