/* The state at t = 0 as the scene and the scheme have it. */
#include "stepping/stepping.h"

#include "base/memory.h"
#include "parallel/ranks.h"

selas_status state_create(struct stepper *stepper, struct state *state, struct messages *messages)
{
    struct model *model = stepper->model;
    *state = (struct state){0};
    state->y = array_new(model->state_size, sizeof *state->y);
    state->a = array_new(model->unknowns, sizeof *state->a);
    selas_status status = SELAS_OK;
    if (state->y == NULL || state->a == NULL)
        status = fail(messages, SELAS_NO_MEMORY, "no memory for a state of %zu numbers", model->state_size);
    status = ranks_agree(model->scene->ranks, status, messages); /* schemes start together */
    if (status != SELAS_OK) {
        state_free(state);
        return status;
    }
    if (model->core->initialise != NULL) model->core->initialise(model, state->y);
    if (stepper->scheme->start != NULL) stepper->scheme->start(stepper, state);
    return SELAS_OK;
}

void state_settle(const struct stepper *stepper, const struct state *state, bool acceleration)
{
    struct model *model = stepper->model;
    if (!stepper->one_pass) return;
    const struct drive drive = driver_last(&stepper->driver, state->time);
    model->one_pass->settle(model, &drive, stepper->dt, state->y, acceleration ? state->a : NULL);
}

void state_show(const struct stepper *stepper, const struct state *state, bool shown)
{
    if (stepper->scheme->show != NULL) stepper->scheme->show(stepper, state, shown);
}

void state_free(struct state *state)
{
    array_free(state->y);
    array_free(state->a);
    *state = (struct state){0};
}
