/* Where the ground is sure to be one rock (ground.h). */
#include "scene/ground.h"

#include <math.h>

/* Does a layer begin above all of the box, or below it, whatever rounding does? */
static bool clear_of_layer(const struct body *body, const struct layer *layer, int axis, const double low[],
                           const double high[], double margin)
{
    double top[2] = {body->low[axis] + layer->top, body->low[axis] + layer->top};
    if (layer_covers(layer)) return true;
    if (layer->map != NULL) return false;
    for (int along = 0; along < axis; along++) {
        const double end[2] = {layer->slope[along] * low[along], layer->slope[along] * high[along]};
        top[0] += fmin(end[0], end[1]);
        top[1] += fmax(end[0], end[1]);
    }
    return top[1] + margin < low[axis] || top[0] - margin > high[axis];
}

/* Is the box outside the block's own? Places beyond the body have the ground of its nearest face. */
static bool clear_of_block(const struct body *body, const struct ground_block *block, int axes,
                           const double low[], const double high[], double margin)
{
    for (int axis = 0; axis < axes; axis++) {
        const double from = fmin(fmax(low[axis], body->low[axis]), body->high[axis]);
        const double end = fmin(fmax(high[axis], body->low[axis]), body->high[axis]);
        const double first = axis == axes - 1 ? low[axis] : from, last = axis == axes - 1 ? high[axis] : end;
        if (fabs(block->centre[axis] - (first + last) / 2) > block->half[axis] + (last - first) / 2 + margin)
            return true;
    }
    return false;
}

bool ground_is_even(const struct scene *scene, const double low[3], const double high[3])
{
    const struct body *body = &scene->body;
    const double margin = 2 * GROUND_FILM * body->spacing;
    if (body->line != NULL || ground_grades(scene)) return false;
    for (size_t i = 0; i < body->layers; i++)
        if (!clear_of_layer(body, &body->layer[i], scene->dimension - 1, low, high, margin)) return false;
    for (size_t i = 0; i < body->blocks; i++)
        if (!clear_of_block(body, &body->block[i], scene->dimension, low, high, margin)) return false;
    return true;
}
