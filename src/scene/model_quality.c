/* Q of a model of the ground (doc/theory/damping.md, section 7). Files say with 0, negative numbers (-999, -1e20) or
 * NaN that there is none. */
#include "scene/model_file.h"

#include <math.h>

int model_sets(struct model_source *source, bool damped)
{
    struct ground_model *model = source->model;
    model->damped = damped && deck_logical(source->group, "damped", 0);
    if (deck_values(source->group, "q_frequency") > 0)
        model->q_frequency = deck_real(source->group, "q_frequency", 0);
    if (deck_values(source->group, "q_power") > 0) model->q_power = deck_real(source->group, "q_power", 0);
    return model->damped ? MODEL_SETS : MODEL_VALUES;
}

/* The place of value i of a grid, for messages. */
static void place_of(const struct model_grid *grid, size_t i, double place[3])
{
    place[0] = grid->at[0][i / grid->n[2] / grid->n[1]];
    place[1] = grid->at[1][i / grid->n[2] % grid->n[1]];
    place[2] = grid->at[2][i % grid->n[2]];
}

/* As check of materials: what compression takes must not be negative. */
static bool passive(const struct model_source *source, const struct model_grid *grid, size_t i)
{
    const double q_p = grid->value[MODEL_VALUES][i], q_s = grid->value[MODEL_VALUES + 1][i];
    const double ratio = grid->value[1][i] / grid->value[2][i], most = .75 * ratio * ratio * q_s;
    double place[3];
    if (!(q_p > 1.01 * most)) return true;
    place_of(grid, i, place);
    return model_fault(source,
                       "q_p = %g is too large beside q_s = %g at (%.9g, %.9g, %.9g) of the model's own axes: "
                       "compression would gain energy; expected at most 3/4 (p_speed/s_speed)^2 q_s = %g",
                       q_p, q_s, place[0], place[1], place[2], most);
}

void model_no_quality(const struct model_grid *box)
{
    double *const q[2] = {box->value[MODEL_VALUES], box->value[MODEL_VALUES + 1]};
    for (size_t i = 0; i < box->n[0] * box->n[1] * box->n[2]; i++)
        if (!(q[0][i] > 0 && q[1][i] > 0 && isfinite(q[0][i]) && isfinite(q[1][i]))) q[0][i] = q[1][i] = 0;
}

struct looked {
    const struct model_source *source;
    size_t values;
    double place[3]; /* of the first value without Q */
};

static bool look(void *context, const struct model_grid *box, size_t first_column)
{
    (void)first_column;
    struct looked *looked = context;
    struct ground_model *model = looked->source->model;
    double *const q[2] = {box->value[MODEL_VALUES], box->value[MODEL_VALUES + 1]};
    for (size_t i = 0; i < box->n[0] * box->n[1] * box->n[2]; i++, looked->values++) {
        if (q[0][i] > 0) {
            if (!passive(looked->source, box, i)) return false;
            model->loss[0] = fmin(model->loss[0], fmin(1 / q[0][i], 1 / q[1][i]));
            model->loss[1] = fmax(model->loss[1], fmax(1 / q[0][i], 1 / q[1][i]));
            continue;
        }
        if (model->undamped++ == 0) place_of(box, i, looked->place);
    }
    return true;
}

bool model_quality(struct model_source *source)
{
    struct ground_model *model = source->model;
    struct looked looked = {.source = source};
    if (!model->damped) return true;
    model->loss[0] = INFINITY;
    for (size_t g = 0; g < model->grids; g++) {
        bool unread = false;
        if (!model_walk(&model->grid[g], look, &looked, &unread))
            return unread ? model_unread(source) : false;
    }
    if (model->undamped > 0)
        warn(source->builder->messages,
             "'%s': %zu of %zu values have no q_p or q_s above 0, the first one at (%.9g, %.9g, %.9g) of the "
             "model's own axes; the ground is not damped there",
             source->path, model->undamped, looked.values, looked.place[0], looked.place[1], looked.place[2]);
    if (model->undamped == looked.values) model->damped = false;
    return true;
}
