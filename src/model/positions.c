/* Where the points that users see are: stored, or those of a lattice that fills the body, whose corner points
 * are the body's corners: x_i = low + (high - low) i / cells on each axis of the body, or those that the model
 * tells. Neither needs memory for them. */
#include "model/model.h"

#include <string.h>

void model_position(const struct model *model, size_t point, double position[3])
{
    if (model->position != NULL) {
        memcpy(position, model->position + 3 * point, 3 * sizeof *position);
        return;
    }
    if (model->place != NULL) {
        model->place(model->scene, point, position);
        return;
    }
    const struct body *body = &model->scene->body;
    const size_t *grid = model->grid;
    const size_t at[3] = {point % grid[0], point / grid[0] % grid[1], point / (grid[0] * grid[1])};
    for (int axis = 0; axis < 3; axis++) {
        const double low = body->low[axis], high = body->high[axis];
        const size_t last = grid[axis] - 1;
        position[axis] = 0;
        if (axis < model->scene->dimension)
            position[axis] = at[axis] == last ? high : low + (high - low) * (double)at[axis] / (double)last;
    }
    lattice_to_deck(body, position, position);
}

void model_free(struct model **model)
{
    if (model == NULL || *model == NULL) return;
    (*model)->core->destroy(*model);
    *model = NULL;
}
