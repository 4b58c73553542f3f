/* Where the points that users see are: stored, or those of a lattice that fills the body, whose corner points
 * are the body's corners: x_i = low + (high - low) i / cells on each axis of the body. A lattice needs no
 * memory for them. */
#include "model/model.h"
#include "parallel/ranks.h"

#include <string.h>

void model_position(const struct model *model, size_t point, double position[3])
{
    if (model->position != NULL) {
        memcpy(position, model->position + 3 * point, 3 * sizeof *position);
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
    body_to_deck(body, position, position);
}

void model_free(struct model **model)
{
    if (model == NULL || *model == NULL) return;
    (*model)->core->destroy(*model);
    *model = NULL;
}

size_t model_piece(const struct model *model, size_t from, int *holder)
{
    enum { LEAST = 1 << 17, PIECES = 16 };
    *holder = 0;
    if (model->core->holder == NULL) return model->points;
    const size_t share = model->points / (size_t)ranks_count(model->scene->ranks) / PIECES;
    const size_t most = share > LEAST ? share : LEAST;
    const size_t planes = model->grid[model->scene->dimension - 1], plane = model->points / planes;
    size_t k = from / plane;
    *holder = model->core->holder(model, k);
    do
        k++;
    while (k < planes && (k + 1) * plane - from <= most && model->core->holder(model, k) == *holder);
    return k * plane;
}
