/* What users see of updated-Lagrangian SPH: initial state, point values, fields, energies. */
#include "base/memory.h"
#include "method/updated_lagrangian/updated_lagrangian.h"
#include "points/least_squares.h"
#include "scene/initial.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static size_t stress_offset(const struct updated *updated)
{
    return 2 * updated->model.unknowns + updated->cloud->points;
}

/* The stress of an initial displacement is Hooke's law of its gradient, taken with the method's own rates:
 * with v = u and no stress, ds/dt is lambda tr(e) I + 2 mu e of the displacement. */
void updated_initialise(struct model *model, double *y)
{
    struct updated *updated = updated_of(model);
    const struct scene *scene = model->scene;
    const size_t dimension = (size_t)updated->dimension, points = updated->cloud->points;
    const size_t unknowns = model->unknowns, extra = stress_offset(updated);
    for (size_t i = 0; i < points; i++)
        y[2 * unknowns + i] = updated->material->density;
    if (scene->initial.kind == INITIAL_REST) return;
    double displacement[3], velocity[3], own[3];
    for (size_t i = 0; i < points; i++) {
        initial_at(scene, model->position + 3 * i, displacement, velocity);
        body_direction_from_deck(&scene->body, displacement, own);
        memcpy(y + unknowns + dimension * i, own, dimension * sizeof *y);
    }
    double *rate = array_new(model->state_size, sizeof *rate);
    if (rate != NULL) {
        const struct drive quiet = {.time = 0};
        const unsigned long evaluations = model->evaluations;
        updated_rate(model, &quiet, y, rate);
        model->evaluations = evaluations;
        for (size_t i = 0; i < points; i++) /* rho = rho_0 (1 - div u) */
            y[2 * unknowns + i] += rate[2 * unknowns + i];
        memcpy(y + extra, rate + extra, (model->state_size - extra) * sizeof *y);
    }
    array_free(rate);
    memcpy(y, y + unknowns, unknowns * sizeof *y);
    for (size_t i = 0; i < points; i++) {
        initial_at(scene, model->position + 3 * i, displacement, velocity);
        body_direction_from_deck(&scene->body, velocity, own);
        memcpy(y + unknowns + dimension * i, own, dimension * sizeof *y);
    }
}

/* Does a place hold a particle, or its image in walls that prescribe how they move? */
static bool moves_as_told(const struct updated *updated, size_t place)
{
    if (place < updated->cloud->points) return true;
    const struct updated_ghost *ghost = &updated->ghost[place - updated->cloud->points];
    for (int f = 0; f < ghost->count; f++)
        if (updated->wall[ghost->face[f]] == WALL_TRACTION) return false;
    return true;
}

static size_t source_of(const struct updated *updated, size_t place)
{
    const size_t points = updated->cloud->points;
    return place < points ? place : updated->ghost[place - points].source;
}

/* Particles of the undeformed body, and with `walls` their images, within a radius of a place: how many, and with
 * `index` which and where. */
static size_t around(const struct updated *updated, const double place[3], bool walls, double radius,
                     size_t *index, double *offset)
{
    const size_t points = updated->cloud->points;
    size_t count = 0;
    for (size_t i = 0; i < points + (walls ? updated->ghosts : 0); i++) {
        double d[3], square = 0;
        for (size_t a = 0; a < 3; a++) {
            d[a] = updated->reference[3 * i + a] - place[a];
            square += d[a] * d[a];
        }
        if (!(square < radius * radius) || !moves_as_told(updated, i)) continue;
        if (index != NULL) {
            index[count] = i;
            memcpy(offset + 3 * count, d, sizeof d);
        }
        count++;
    }
    return count;
}

/* Fits a polynomial of the degree to the particles within the radius; SELAS_NOT_CONVERGED if they do not span
 * it. */
static selas_status fit_probe(const struct updated *updated, const double place[3], bool walls, int degree,
                              double radius, struct probe *probe, struct messages *messages)
{
    const size_t count = around(updated, place, walls, radius, NULL, NULL);
    if (count < fit_terms(updated->dimension, degree)) return SELAS_NOT_CONVERGED;
    const selas_status status = probe_allocate(probe, count, messages);
    if (status != SELAS_OK) return status;
    double *offset = array_new((3 + 1 + FIT_TERMS) * count, sizeof *offset);
    if (offset == NULL) {
        probe_free(probe);
        return fail(messages, SELAS_NO_MEMORY, "no memory for the weights of a receiver");
    }
    double *weight = offset + 3 * count;
    around(updated, place, walls, radius, probe->index, offset);
    for (size_t j = 0; j < count; j++) {
        const double *d = offset + 3 * j;
        const double r = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        weight[j] = updated->cloud->volume[source_of(updated, probe->index[j])] *
                    kernel_value(updated->options.kernel, updated->dimension, r,
                                 radius / updated->options.kernel->support);
    }
    const struct fit fit = {updated->dimension, degree, radius, count, offset, weight, weight + count};
    const bool spans = fit_free(&fit, probe->weight, probe->gradient);
    array_free(offset);
    if (spans) return SELAS_OK;
    probe_free(probe);
    return SELAS_NOT_CONVERGED;
}

/* Moving least squares with the method's kernel: a quadratic where the particles span one (it leaves a front
 * that is several spacings wide as it is, and averages what alternates from particle to particle), else a
 * straight line. Places outside the outermost particles are extrapolated. */
static selas_status fit_around(const struct updated *updated, const double place[3], bool walls,
                               struct probe *probe, struct messages *messages)
{
    selas_status status = SELAS_NOT_CONVERGED;
    for (int degree = 2; degree >= 1 && status == SELAS_NOT_CONVERGED; degree--)
        for (double factor = 1; factor < 2 && status == SELAS_NOT_CONVERGED; factor *= 1.2)
            status = fit_probe(updated, place, walls, degree, factor * updated->reach, probe, messages);
    if (status == SELAS_NOT_CONVERGED)
        return fail(messages, status, "too few particles around a receiver to interpolate");
    return status;
}

/* Beside walls motions are taken from images, too, so that on the wall they are what it prescribes: weights of these,
 * behind the probe's own. */
static selas_status see_walls(const struct updated *updated, const double place[3], struct probe *probe,
                              struct messages *messages)
{
    struct probe seen = {0}, both = {0};
    bool walls = false;
    selas_status status = fit_around(updated, place, true, &seen, messages);
    for (size_t k = 0; k < seen.count; k++)
        walls = walls || seen.index[k] >= updated->cloud->points;
    if (walls) status = probe_allocate(&both, probe->count + seen.count, messages);
    if (walls && status == SELAS_OK) {
        const size_t count = probe->count;
        memcpy(both.index, probe->index, count * sizeof *both.index);
        memcpy(both.weight, probe->weight, count * sizeof *both.weight);
        memcpy(both.gradient, probe->gradient, 3 * count * sizeof *both.gradient);
        memcpy(both.index + count, seen.index, seen.count * sizeof *both.index);
        memcpy(both.weight + count, seen.weight, seen.count * sizeof *both.weight);
        probe_free(probe);
        *probe = both;
        probe->count = count;
        probe->sites = seen.count;
    }
    probe_free(&seen);
    return status;
}

selas_status updated_probe(struct model *model, const double position[3], struct probe *probe,
                           struct messages *messages)
{
    const struct updated *updated = updated_of(model);
    double place[3];
    body_from_deck(&model->scene->body, position, place);
    selas_status status = fit_around(updated, place, false, probe, messages);
    if (status == SELAS_OK && updated->ghosts > 0) status = see_walls(updated, place, probe, messages);
    if (status != SELAS_OK) return status;
    memcpy(probe->position, position, sizeof probe->position);
    probe->material = updated->material;
    return SELAS_OK;
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
static double seen_at(const struct updated *updated, size_t place, enum updated_motion motion,
                      const double *vector, size_t c)
{
    double value = vector[(size_t)updated->dimension * source_of(updated, place) + c];
    if (place < updated->cloud->points) return value;
    const struct updated_ghost *ghost = &updated->ghost[place - updated->cloud->points];
    for (int f = 0; f < ghost->count; f++) {
        const size_t face = ghost->face[f];
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
    for (size_t i = from; i < end; i++) {
        struct point_values values = {0};
        memcpy(values.displacement, y + dimension * i, bytes);
        memcpy(values.velocity, y + model->unknowns + dimension * i, bytes);
        if (a != NULL) memcpy(values.acceleration, a + dimension * i, bytes);
        strain_of(updated, y + stress_offset(updated) + stresses * i, values.gradient);
        field_from_values(model, updated->material, &values, field, value + components * (i - from));
    }
}

/* A density that is not finite, or overflows, shows in no field at first. */
void updated_unseen(struct model *model, const double *y, struct unseen *found)
{
    const double *density = y + 2 * model->unknowns;
    double middle[3] = {0};
    *found = (struct unseen){.speed = -1, .places = model->points};
    for (size_t i = 0; i < model->points; i++) {
        double x[3];
        if (isfinite(density[i] * density[i])) continue;
        model_position(model, i, x);
        found->spoiled++;
        for (int axis = 0; axis < 3; axis++)
            middle[axis] += (x[axis] - middle[axis]) / (double)found->spoiled;
    }
    snprintf(found->place, sizeof found->place, "with the density of a particle, about (%.6g, %.6g, %.6g)",
             middle[0], middle[1], middle[2]);
}

void updated_energy(struct model *model, const double *y, struct energy *energy)
{
    const struct updated *updated = updated_of(model);
    const size_t stresses = (size_t)updated->stresses, dimension = (size_t)updated->dimension;
    const double *density = y + 2 * model->unknowns;
    *energy = (struct energy){0};
    for (size_t i = 0; i < updated->cloud->points; i++) {
        const double *v = y + model->unknowns + dimension * i,
                     *stress = y + stress_offset(updated) + stresses * i;
        double gradient[9], work = 0, square = 0;
        strain_of(updated, stress, gradient);
        for (size_t p = 0; p < dimension; p++) {
            square += v[p] * v[p];
            for (size_t q = 0; q < dimension; q++)
                work += gradient[3 * p + q] * stress[updated_component[dimension][p][q]];
        }
        energy->kinetic += updated->mass[i] * square / 2;
        energy->strain += updated->mass[i] / density[i] * work / 2;
    }
}

/* Power of tractions, moving walls and body forces, estimated with the outermost layer of particles: area =
 * volume over spacing, traction of a wall = the particle's own stress. Transmitting faces absorb. */
void updated_power(struct model *model, const struct drive *drive, const double *y, double *load,
                   double *absorbed)
{
    const struct updated *updated = updated_of(model);
    const struct scene *scene = model->scene;
    *load = *absorbed = 0;
    if (!ranks_first(updated->part.ranks)) return; /* all have all */
    *load = updated_power_of_faces(updated, drive, y, absorbed);
    const size_t dimension = (size_t)updated->dimension;
    for (size_t k = 0; drive->load != NULL && k < scene->loads; k++) {
        if (scene->load[k].kind != LOAD_BODY_FORCE) continue;
        for (size_t i = 0; i < updated->cloud->points; i++)
            for (size_t c = 0; c < dimension; c++)
                *load += drive->load[k] * updated->load_direction[3 * k + c] * updated->cloud->volume[i] *
                         y[model->unknowns + dimension * i + c];
    }
}

void updated_describe(const struct model *model,
                      void (*tell)(void *context, const char *key, const char *value), void *context)
{
    const struct updated *updated = (const struct updated *)model;
    const struct updated_options *options = &updated->options;
    char text[160];
    const size_t places = updated->cloud->points + updated->ghosts;
    snprintf(text, sizeof text, "%zu", updated->ghosts);
    tell(context, "ghost particles", text);
    snprintf(text, sizeof text, "%.1f in lists",
             (double)updated->neighbours.start[places] / (double)(places > 0 ? places : 1));
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
