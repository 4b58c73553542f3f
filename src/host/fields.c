/* Whole fields, points and energies handed out to a host. */
#include "host/simulation.h"

#include "base/memory.h"

selas_status selas_points(selas_simulation *simulation, size_t *count, const double **position)
{
    AT_THE_DOOR(simulation);
    simulation_call(simulation);
    selas_status status = simulation_begin(simulation);
    if (status == SELAS_OK) status = shared_alone(simulation, "all points");
    if (status != SELAS_OK) return status;
    if (count == NULL || position == NULL)
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT, "no room for the count or the positions");
    const struct model *model = simulation->model;
    *count = 0;
    *position = NULL;
    if (model->position == NULL && simulation->lattice == NULL) {
        simulation->lattice = array_new(3 * model->points, sizeof *simulation->lattice);
        if (simulation->lattice == NULL)
            return fail(&simulation->messages, SELAS_NO_MEMORY, "no memory for %zu positions", model->points);
        for (size_t i = 0; i < model->points; i++)
            model_position(model, i, simulation->lattice + 3 * i);
    }
    *count = model->points;
    *position = model->position != NULL ? model->position : simulation->lattice;
    return SELAS_OK;
}

selas_status selas_field_values(selas_simulation *simulation, selas_field field, size_t *count,
                                size_t *components, const double **value)
{
    AT_THE_DOOR(simulation);
    simulation_call(simulation);
    selas_status status = simulation_begin(simulation);
    if (status == SELAS_OK) status = shared_alone(simulation, "a whole field");
    if (status != SELAS_OK) return status;
    const size_t width = (size_t)field_components(field);
    if (width == 0 || count == NULL || components == NULL || value == NULL)
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT, "no such field, or no room for it");
    struct model *model = simulation->model;
    if (model->core->field == NULL)
        return fail(&simulation->messages, SELAS_UNSUPPORTED, "this method has no whole fields");
    if (simulation->values_room < width * model->points) {
        array_free(simulation->values);
        simulation->values_room = width * model->points;
        simulation->values = array_new(simulation->values_room, sizeof(double));
        if (simulation->values == NULL) {
            simulation->values_room = 0;
            return fail(&simulation->messages, SELAS_NO_MEMORY, "no memory for a field of %zu points",
                        model->points);
        }
    }
    host_looks_at_all(simulation);
    state_settle(simulation->stepper, &simulation->state, field == SELAS_ACCELERATION);
    const bool moves = field == SELAS_VELOCITY || field == SELAS_ENERGY;
    if (moves) state_show(simulation->stepper, &simulation->state, true);
    model->core->field(model, field, simulation->state.y, simulation->state.a, 0, model->points,
                       simulation->values);
    if (moves) state_show(simulation->stepper, &simulation->state, false);
    *count = model->points;
    *components = width;
    *value = simulation->values;
    return SELAS_OK;
}

selas_status selas_energy(selas_simulation *simulation, double *kinetic, double *strain)
{
    AT_THE_DOOR(simulation);
    simulation_call(simulation);
    const selas_status status = simulation_begin(simulation);
    if (status != SELAS_OK) return status;
    if (kinetic == NULL || strain == NULL)
        return fail(&simulation->messages, SELAS_BAD_ARGUMENT, "no room for the energies");
    struct model *model = simulation->model;
    if (model->core->energy == NULL)
        return fail(&simulation->messages, SELAS_UNSUPPORTED, "this method knows no energy");
    struct energy energy = {0};
    state_settle(simulation->stepper, &simulation->state, false);
    state_show(simulation->stepper, &simulation->state, true);
    model->core->energy(model, simulation->state.y, &energy);
    state_show(simulation->stepper, &simulation->state, false);
    *kinetic = energy.kinetic;
    *strain = energy.strain;
    return SELAS_OK;
}

int selas_field_components(selas_field field)
{
    return field_components(field);
}
