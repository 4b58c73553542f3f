/* Values between those of a model's grids (doc/reference/models.md). */
#include "base/memory.h"
#include "scene/model_file.h"

#include <math.h>
#include <string.h>

/* Index of the place before x, and how far x lies beyond it, in parts; outside as at the edge. */
static size_t before(const double *at, size_t n, double x, double *part)
{
    *part = 0;
    if (n < 2 || !(x > at[0])) return 0;
    if (x >= at[n - 1]) {
        *part = 1;
        return n - 2;
    }
    size_t i = (size_t)((x - at[0]) / (at[n - 1] - at[0]) * (double)(n - 1)); /* right if they are even */
    if (i > n - 2) i = n - 2;
    while (x < at[i])
        i--;
    while (x >= at[i + 1])
        i++;
    *part = (x - at[i]) / (at[i + 1] - at[i]);
    return i;
}

/* The values at a corner of a cell: of set s value[s * *stride]; `first` is the piece of the first corner. */
static const double *corner_of(const struct model_grid *grid, const size_t at[3], const size_t up[3],
                               const struct model_piece *first, size_t *stride)
{
    *stride = first->step[3];
    if (up[0] <= first->left[0] && up[1] <= first->left[1] && up[2] <= first->left[2])
        return first->value + up[0] * first->step[0] + up[1] * first->step[1] + up[2];
    const size_t there[3] = {at[0] + up[0], at[1] + up[1], at[2] + up[2]};
    const struct model_piece other = model_pieces_at(grid, there);
    *stride = other.step[3];
    return other.value;
}

void model_grid_at(const struct model_grid *grid, const double place[3], int sets, double *value)
{
    size_t at[3];
    double part[3];
    struct model_piece piece = {.value = NULL};
    for (int axis = 0; axis < 3; axis++)
        at[axis] = before(grid->at[axis], grid->n[axis], place[axis], &part[axis]);
    for (int set = 0; set < sets; set++)
        value[set] = 0;
    if (grid->pieces != NULL) {
        model_pieces_look(grid);
        piece = model_pieces_at(grid, at);
    }
    for (unsigned corner = 0; corner < 8; corner++) {
        size_t index = 0, up[3], stride;
        double weight = 1;
        for (int axis = 0; axis < 3; axis++) {
            const unsigned end = corner >> axis & 1U;
            up[axis] = grid->n[axis] > 1 ? end : 0;
            index = index * grid->n[axis] + at[axis] + up[axis];
            weight *= end ? part[axis] : 1 - part[axis];
        }
        if (weight == 0) continue;
        if (grid->pieces != NULL) {
            const double *found = corner_of(grid, at, up, &piece, &stride);
            for (int set = 0; set < sets; set++)
                value[set] += weight * found[(size_t)set * stride];
        } else {
            for (int set = 0; set < sets; set++)
                value[set] += weight * grid->value[set][index];
        }
    }
    if (grid->pieces != NULL) model_pieces_looked(grid);
}

static double surface_at(const struct ground_model *model, size_t i, const double place[3])
{
    double z = 0;
    model_grid_at(&model->surface[i], place, 1, &z);
    return z;
}

/* Depth below the sea of a depth below the body's surface; `bottom`: of the model, which stays where it is, or
 * INFINITY. */
static double below_sea(const struct ground_model *model, double depth, double ground, double bottom)
{
    if (model->sea) return depth + model->shift;
    return ground + depth * (isfinite(bottom) ? (bottom - ground) / bottom : 1);
}

/* Coordinate along the third axis of grid i at a depth: goes evenly with it; place[0], place[1]: along the others. */
static double along_depth(const struct ground_model *model, size_t i, double depth, const double place[3])
{
    if (model->depth == MODEL_BELOW) return below_sea(model, depth, surface_at(model, 0, place), INFINITY);
    if (model->depth == MODEL_BETWEEN) {
        const double top = surface_at(model, i, place), next = surface_at(model, i + 1, place);
        const double z = below_sea(model, depth, surface_at(model, 0, place),
                                   surface_at(model, model->surfaces - 1, place));
        if (!(next > top)) return z > top ? INFINITY : 0;
        return (z - top) / (next - top);
    }
    if (model->depth == MODEL_STRETCHED) {
        const double top = surface_at(model, 0, place),
                     ground = surface_at(model, model->surfaces - 1, place);
        const double z = below_sea(model, depth, ground, model->bottom);
        return (z - top) * model->bottom / (model->bottom - top);
    }
    return depth + model->shift;
}

/* The grid of a place along the model's horizontal axes at a depth; place[2]: there. Where two grids meet the
 * upper one. */
static const struct model_grid *grid_at(const struct ground_model *model, double depth, double place[3])
{
    size_t i = 0;
    place[2] = along_depth(model, i, depth, place);
    while (i + 1 < model->grids && place[2] > model->grid[i].at[2][model->grid[i].n[2] - 1])
        place[2] = along_depth(model, ++i, depth, place);
    return &model->grid[i];
}

/* Place along the model's horizontal axes; beyond the body that of its nearest face. */
static void place_in(const struct ground_model *model, const double place[2], double there[2])
{
    double inside[2];
    for (int axis = 0; axis < 2; axis++)
        inside[axis] = fmin(fmax(place[axis], model->low[axis]), model->high[axis]);
    for (int axis = 0; axis < 2; axis++)
        there[axis] =
            model->origin[axis] + model->turn[axis][0] * inside[0] + model->turn[axis][1] * inside[1];
}

size_t ground_model_kinks(const struct ground_model *model, const double place[3], double from, double to,
                          double *at)
{
    double there[3] = {0}, part;
    size_t count = 0;
    place_in(model, place, there);
    for (size_t i = 0; i < model->grids; i++) {
        const struct model_grid *grid = &model->grid[i];
        const double first = along_depth(model, i, from - model->low[2], there),
                     length = along_depth(model, i, to - model->low[2], there) - first;
        for (size_t k = before(grid->at[2], grid->n[2], first, &part); k < grid->n[2]; k++) {
            const double way = (grid->at[2][k] - first) / length;
            if (!(way < 1 - 1e-9)) break;
            if (way > 1e-9) at[count++] = from + way * (to - from);
        }
    }
    return count;
}

/* Which of the model's surfaces its ground is. */
static size_t ground_of(const struct ground_model *model)
{
    return model->depth == MODEL_STRETCHED ? model->surfaces - 1 : 0;
}

double ground_model_height(const struct ground_model *model, const double place[2])
{
    double there[3] = {0};
    place_in(model, place, there);
    return model->shift - surface_at(model, ground_of(model), there);
}

double ground_model_step(const struct ground_model *model)
{
    const struct model_grid *ground = &model->surface[ground_of(model)];
    double step = INFINITY;
    for (int axis = 0; axis < 2; axis++)
        for (size_t i = 0; i + 1 < ground->n[axis]; i++)
            step = fmin(step, ground->at[axis][i + 1] - ground->at[axis][i]);
    return step;
}

/* The first `sets` values at a place of the body. */
static void values_at(const struct ground_model *model, const double place[3], int sets, double *value)
{
    double there[3] = {0};
    const double z = fmin(model->sea ? place[2] : fmax(place[2], model->low[2]), model->high[2]);
    place_in(model, place, there);
    const struct model_grid *grid = grid_at(model, z - model->low[2], there);
    model_grid_at(grid, there, sets, value);
}

struct shares ground_model_shares(const struct ground_model *model, const double place[3])
{
    double value[MODEL_SETS];
    values_at(model, place, MODEL_SETS, value);
    return (struct shares){value[MODEL_VALUES], value[MODEL_VALUES + 1]};
}

struct rock ground_model_at(const struct ground_model *model, const double place[3])
{
    double value[MODEL_VALUES];
    values_at(model, place, MODEL_VALUES, value);
    const double mu = value[0] * value[2] * value[2];
    return (struct rock){value[0], value[0] * value[1] * value[1] - 2 * mu, mu};
}

struct material ground_model_material(const struct ground_model *model, const struct model_grid *grid,
                                      size_t i)
{
    struct material material = {
        .density = grid->value[0][i], .p_speed = grid->value[1][i], .s_speed = grid->value[2][i]};
    if (model->damped) {
        material.q_p = grid->value[MODEL_VALUES][i];
        material.q_s = grid->value[MODEL_VALUES + 1][i];
        material.q_frequency = model->q_frequency;
        material.q_power = model->q_power;
    }
    material.mu = material.density * material.s_speed * material.s_speed;
    material.lambda = material.plane_lambda =
        material.density * material.p_speed * material.p_speed - 2 * material.mu;
    material.young = material.mu * (3 * material.lambda + 2 * material.mu) / (material.lambda + material.mu);
    material.poisson = material.lambda / (2 * (material.lambda + material.mu));
    return material;
}

static void free_grids(struct model_grid *grid, size_t count)
{
    for (size_t i = 0; grid != NULL && i < count; i++) {
        for (int axis = 0; axis < 3; axis++)
            array_free(grid[i].at[axis]);
        for (int set = 0; set < MODEL_SETS; set++)
            array_free(grid[i].value[set]);
        model_pieces_free(&grid[i]);
    }
    array_free(grid);
}

void ground_model_free(struct ground_model *model)
{
    if (model == NULL) return;
    free_grids(model->grid, model->grids);
    free_grids(model->surface, model->surfaces);
    array_free(model);
}

/* --- What is kept of large grids --- */

void ground_model_forget(const struct ground_model *model)
{
    for (size_t i = 0; model != NULL && i < model->grids; i++)
        model_pieces_forget(&model->grid[i]);
}

void ground_model_bytes(const struct ground_model *model, double bytes[2])
{
    bytes[0] = bytes[1] = 0;
    for (size_t i = 0; model != NULL && i < model->grids; i++) {
        const struct model_grid *grid = &model->grid[i];
        if (grid->pieces == NULL) continue;
        bytes[0] += (double)model_pieces_asked(grid);
        bytes[1] += (double)(grid->n[0] * grid->n[1] * grid->n[2] * sizeof(double)) *
                    (model->damped ? MODEL_SETS : MODEL_VALUES);
    }
}

bool ground_model_sound(const struct ground_model *model)
{
    bool broken = false;
    for (size_t i = 0; model != NULL && i < model->grids; i++)
        broken = broken || model_pieces_broken(&model->grid[i]);
    return !broken;
}
