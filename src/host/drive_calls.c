/* What a host calls to drive loads and faces: by a function, or at a value that it holds; and the mean motion
 * under a load. How they are driven: driven_loads.c. */
#include "host/simulation.h"

#include "base/memory.h"
#include "parallel/ranks.h"
#include "scene/symmetry.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* Index of a load by its name, or its number from 1, that of its &load, where it has none. */
static selas_status find_load(selas_simulation *simulation, const char *name, size_t *index)
{
    const struct scene *scene = simulation->scene;
    for (size_t i = 0; name != NULL && i < scene->loads && scene->load[i].driven != BY_HOST; i++) {
        char number[LOAD_NUMBER_SIZE];
        if (strcmp(load_name(scene, i, number), name) != 0) continue;
        *index = i;
        return host_drives_all(simulation, i);
    }
    return fail(&simulation->messages, SELAS_BAD_ARGUMENT,
                "there is no load '%.60s'; expected the name of a &load, or its number if it has none",
                name != NULL ? name : "(NULL)");
}

static struct driven_load *driven_of(struct host *host, size_t load)
{
    for (size_t i = 0; i < host->loads; i++)
        if (host->load[i].load == load) return &host->load[i];
    return NULL;
}

static selas_status drive_new_load(selas_simulation *simulation, const struct driven_load *wanted)
{
    struct host *host = &simulation->host;
    const selas_status status = simulation_may_change(simulation);
    if (status != SELAS_OK) return status;
    struct driven_load *driven = driven_of(host, wanted->load);
    if (driven == NULL) {
        if (host->loads == host->room) {
            const size_t room = 2 * host->room + 4;
            struct driven_load *grown = realloc(host->load, room * sizeof *grown);
            if (grown == NULL)
                return fail(&simulation->messages, SELAS_NO_MEMORY, "no memory for the host's loads");
            host->load = grown;
            host->room = room;
        }
        driven = &host->load[host->loads++];
    }
    *driven = *wanted;
    driven->group = simulation->scene->load[wanted->load].group;
    simulation_discard(simulation);
    return SELAS_OK;
}

static selas_status set_function(selas_simulation *simulation, const char *load, enum load_kind kind,
                                 selas_vector_function function, void *context)
{
    struct driven_load wanted = {.function = function, .context = context};
    selas_status status = simulation_scene(simulation);
    if (status == SELAS_OK && function == NULL)
        status = fail(&simulation->messages, SELAS_BAD_ARGUMENT, "the function is NULL");
    if (status == SELAS_OK) status = find_load(simulation, load, &wanted.load);
    if (status != SELAS_OK) return status;
    const struct load *named = &simulation->scene->load[wanted.load];
    if (named->kind != kind)
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT, "load '%s' is no %s", load,
                    kind == LOAD_TRACTION ? "traction" : "body force");
    status = host_can_drive(simulation->scene, named, &simulation->messages);
    return status == SELAS_OK ? drive_new_load(simulation, &wanted) : status;
}

selas_status selas_set_traction(selas_simulation *simulation, const char *load,
                                selas_vector_function traction, void *context)
{
    AT_THE_DOOR(simulation);
    simulation_call(simulation);
    return set_function(simulation, load, LOAD_TRACTION, traction, context);
}

selas_status selas_set_body_force(selas_simulation *simulation, const char *load, selas_vector_function force,
                                  void *context)
{
    AT_THE_DOOR(simulation);
    simulation_call(simulation);
    return set_function(simulation, load, LOAD_BODY_FORCE, force, context);
}

selas_status selas_set_motion(selas_simulation *simulation, const char *face,
                              selas_vector_function displacement, void *context)
{
    AT_THE_DOOR(simulation);
    simulation_call(simulation);
    selas_status status = simulation_scene(simulation);
    if (status != SELAS_OK) return status;
    if (displacement == NULL) return fail(&simulation->messages, SELAS_BAD_ARGUMENT, "the function is NULL");
    size_t index = FACES;
    for (size_t i = 0; face != NULL && i < FACES; i++)
        if (strcmp(face_name((enum face)i), face) == 0) index = i;
    if (index == FACES)
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT,
                    "there is no face '%.60s'; expected x-, x+, ... z+", face != NULL ? face : "(NULL)");
    status = host_moves(simulation, (enum face)index);
    if (status == SELAS_OK) status = simulation_may_change(simulation);
    if (status != SELAS_OK) return status;
    simulation->host.face[index] = (struct driven_face){displacement, context};
    simulation_discard(simulation);
    return SELAS_OK;
}

selas_status selas_set_load(selas_simulation *simulation, const char *load, double value)
{
    AT_THE_DOOR(simulation);
    simulation_call(simulation);
    struct driven_load wanted = {.value = value};
    selas_status status = simulation_scene(simulation);
    if (status == SELAS_OK) status = find_load(simulation, load, &wanted.load);
    if (status == SELAS_OK) status = shared_value(simulation, load, value);
    if (status != SELAS_OK) return status;
    if (simulation->finished)
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT,
                    "the histories are finished; no step can follow");
    struct driven_load *driven = driven_of(&simulation->host, wanted.load);
    if (driven != NULL && driven->function != NULL)
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT, "load '%s' is given by a function of the host",
                    load);
    if (driven == NULL) return drive_new_load(simulation, &wanted);
    driven->value = value;
    simulation->dirty = simulation->state.y != NULL;
    return SELAS_OK;
}

/* The velocities of a body that moves as one in the direction given (deck coordinates), but not across mirror planes,
 * which hold it: their power is the part of the load's resultant that is returned. */
static double translate(const struct model *model, unsigned mirrors, const double direction[3],
                        double *velocity)
{
    static const double little = 1e-3;
    const size_t d = (size_t)model->scene->dimension;
    double own[3] = {direction[0], direction[1], direction[2]}, along = 0.0;
    if (model->frame != NULL) body_direction_from_deck(&model->scene->body, direction, own);
    for (size_t c = 0; c < 3 && c < d; c++)
        if ((mirrors & 1u << c) == 0) along += own[c] * own[c];
    for (size_t c = 0; c < 3 && c < d && along > little; c++)
        if ((mirrors & 1u << c) != 0) own[c] = 0.0;
    for (size_t i = 0; i < model->unknowns / d; i++)
        for (size_t c = 0; c < 3 && c < d; c++)
            velocity[c * model->component_stride + i * model->point_stride] = own[c];
    return along > little ? along : 1.0;
}

/* What a unit of a load does work on, and what it would if all moved as one by its direction, added to sum[2]. */
static void add_work(struct model *model, unsigned mirrors, const struct state *state, size_t index,
                     const double *part, double *scratch, double sum[2])
{
    const struct scene *scene = model->scene;
    const size_t n = model->unknowns;
    double *y = scratch, *unit = y + model->state_size;
    for (size_t k = 0; k < scene->loads; k++)
        unit[k] = k == index ? 1.0 / fabs(scene->load[k].amplitude) : 0.0;
    const struct drive drive = {.time = state->time, .load = unit};
    double measure = 0.0, power = 0.0, absorbed = 0.0;
    memcpy(y, state->y, model->state_size * sizeof *y);
    const double along = translate(model, mirrors, scene->load[index].direction, y + n);
    model->core->power(model, &drive, y, &measure, &absorbed);
    memcpy(y + n, part, n * sizeof *y);
    model->core->power(model, &drive, y, &power, &absorbed);
    sum[0] += power;
    sum[1] += fabs(measure) / along;
}

/* Mean of a part [unknowns] of the state or of a change of it over the patch of a load, what of it lies beyond mirror
 * planes by the images of the load, which are among the loads. The power of a unit load is the integral of what it
 * does work on. */
static selas_status mean_of(selas_simulation *simulation, size_t index, const double *part, double *value)
{
    struct model *model = simulation->model;
    const struct scene *scene = simulation->scene;
    const struct load *named = &scene->load[index];
    const size_t loads = scene->loads;
    if (model->core->power == NULL || model->state_size < 2 * model->unknowns ||
        named->kind == LOAD_MOMENT_TENSOR || named->amplitude == 0.0)
        return fail(&simulation->messages, SELAS_UNSUPPORTED, "this load or method has no mean displacement");
    if (simulation->scratch == NULL) {
        simulation->scratch = array_new(model->state_size + loads, sizeof(double));
        simulation->mirrors = scene_mirror_axes(scene);
    }
    if (simulation->scratch == NULL)
        return fail(&simulation->messages, SELAS_NO_MEMORY, "no memory for a mean");
    double sum[2] = {0.0, 0.0};
    for (size_t k = 0; k < loads; k++)
        if (scene_load_repeats(scene, simulation->mirrors, index, k))
            add_work(model, simulation->mirrors, &simulation->state, k, part, simulation->scratch, sum);
    ranks_sum(simulation->ranks, 2, sum);
    *value = (named->amplitude < 0.0 ? -sum[0] : sum[0]) / sum[1];
    ranks_spread(simulation->ranks, 0, value, sizeof *value);
    return SELAS_OK;
}

selas_status selas_load_mean(selas_simulation *simulation, const char *load, selas_field field, double *value)
{
    AT_THE_DOOR(simulation);
    simulation_call(simulation);
    selas_status status = simulation_begin(simulation);
    size_t index = 0;
    if (status == SELAS_OK) status = find_load(simulation, load, &index);
    if (status != SELAS_OK) return status;
    if (value == NULL || field < SELAS_DISPLACEMENT || field > SELAS_ACCELERATION)
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT,
                    "means are those of displacement, velocity or acceleration, and need room for a value");
    const struct state *state = &simulation->state;
    host_looks_at(simulation, simulation->scene->load[index].centre, "the mean under a load");
    state_settle(simulation->stepper, state, true);
    return mean_of(simulation, index,
                   field == SELAS_ACCELERATION
                       ? state->a
                       : state->y + (field == SELAS_VELOCITY ? simulation->model->unknowns : 0),
                   value);
}

selas_status selas_load_response(selas_simulation *simulation, const char *load, const char *moved,
                                 double *value)
{
    AT_THE_DOOR(simulation);
    simulation_call(simulation);
    selas_status status = simulation_begin(simulation);
    size_t pushed = 0, seen = 0, row = 0;
    if (status == SELAS_OK) status = find_load(simulation, load, &pushed);
    if (status == SELAS_OK) status = find_load(simulation, moved, &seen);
    if (status != SELAS_OK) return status;
    if (value == NULL) return fail(&simulation->messages, SELAS_BAD_ARGUMENT, "no room for the response");
    const struct held *held = &simulation->stepper->held;
    while (row < held->loads && held->load[row] != pushed)
        row++;
    if (row == held->loads)
        return fail(&simulation->messages, SELAS_UNSUPPORTED,
                    "the response to load '%s' is known where set_load holds it, with 'leapfrog' or "
                    "'modified-equation', a linear "
                    "method and no functions of the host",
                    load);
    double *change = array_new(simulation->model->unknowns, sizeof *change);
    if (change == NULL) return fail(&simulation->messages, SELAS_NO_MEMORY, "no memory for a response");
    for (size_t i = 0; i < held->count; i++)
        change[held->index[i]] = held->pull[row * held->count + i];
    status = mean_of(simulation, seen, change, value);
    array_free(change);
    return status;
}
