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

void model_grid_at(const struct model_grid *grid, const double place[3], int sets, double *value)
{
    size_t at[3];
    double part[3];
    for (int axis = 0; axis < 3; axis++)
        at[axis] = before(grid->at[axis], grid->n[axis], place[axis], &part[axis]);
    for (int set = 0; set < sets; set++)
        value[set] = 0;
    for (unsigned corner = 0; corner < 8; corner++) {
        size_t index = 0;
        double weight = 1;
        for (int axis = 0; axis < 3; axis++) {
            const unsigned up = corner >> axis & 1U;
            index = index * grid->n[axis] + at[axis] + (grid->n[axis] > 1 ? up : 0);
            weight *= up ? part[axis] : 1 - part[axis];
        }
        for (int set = 0; set < sets && weight != 0; set++)
            value[set] += weight * grid->value[set][index];
    }
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
    double there[3];
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

/* --- While it is read --- */

bool model_grids(struct model_source *source, size_t grids, size_t surfaces)
{
    struct ground_model *model = source->model;
    model->grid = scene_array(source->builder, grids, sizeof *model->grid);
    model->surface = scene_array(source->builder, surfaces, sizeof *model->surface);
    if (model->grid == NULL || model->surface == NULL) return false;
    model->grids = grids;
    model->surfaces = surfaces;
    return true;
}

bool model_part(struct model_source *source, struct model_grid *grid, int axis, const double *place,
                size_t count, size_t *first)
{
    if (count < 2)
        return model_fault(source, "there is one value along %c; expected at least two", "xyz"[axis]);
    size_t last = count - 1;
    for (size_t i = 0; i < last; i++)
        if (!(place[i + 1] > place[i]))
            return model_fault(source,
                               "rows %zu and %zu along %c coincide or go back, from %g to %g; expected "
                               "places one after the other",
                               i, i + 1, "xyz"[axis], place[i], place[i + 1]);
    source->whole[axis][0] = place[0];
    source->whole[axis][1] = place[last];
    const bool above = axis == 2 && source->model->sea; /* all that is above the body, too */
    *first = 0;
    while (*first + 2 < count && !above && place[*first + 1] <= source->range[axis][0])
        ++*first;
    while (last > *first + 1 && place[last - 1] >= source->range[axis][1])
        last--;
    grid->n[axis] = last - *first + 1;
    grid->at[axis] = scene_array(source->builder, grid->n[axis], sizeof *grid->at[axis]);
    for (size_t i = 0; grid->at[axis] != NULL && i < grid->n[axis]; i++)
        grid->at[axis][i] = place[*first + i];
    return grid->at[axis] != NULL;
}

bool model_even_part(struct model_source *source, struct model_grid *grid, int axis, double from, double step,
                     size_t count, size_t *first)
{
    if (!(step > 0) || !isfinite(from + step * (double)count))
        return model_fault(source, "the step along %c is %g; expected one above 0", "xyz"[axis], step);
    double *place = scene_array(source->builder, count, sizeof *place);
    for (size_t i = 0; place != NULL && i < count; i++)
        place[i] = from + (double)i * step;
    const bool good = place != NULL && model_part(source, grid, axis, place, count, first);
    array_free(place);
    return good;
}

bool model_room(struct model_source *source, struct model_grid *grid, int sets)
{
    if (grid->n[2] == 0) { /* a surface */
        grid->n[2] = 1;
        grid->at[2] = scene_array(source->builder, 1, sizeof *grid->at[2]);
    }
    const double count = (double)grid->n[0] * (double)grid->n[1] * (double)grid->n[2];
    for (int set = 0; set < sets; set++) {
        if (grid->value[set] != NULL) continue;
        grid->value[set] = count < 1e15 ? array_new((size_t)count, sizeof(double)) : NULL;
        if (grid->value[set] != NULL) continue;
        complain_of_memory(source->builder);
        return model_fault(source, "no memory for the %zu x %zu x %zu values that the body needs", grid->n[0],
                           grid->n[1], grid->n[2]);
    }
    return grid->at[2] != NULL;
}

void model_extremes(const struct model_grid *surface, double *least, double *greatest)
{
    *least = INFINITY;
    *greatest = -INFINITY;
    for (size_t i = 0; i < surface->n[0] * surface->n[1]; i++) {
        *least = fmin(*least, surface->value[0][i]);
        *greatest = fmax(*greatest, surface->value[0][i]);
    }
}

void model_tell_depth(struct ground_model *model, const char *ground)
{
    const size_t length = strlen(model->text), room = sizeof model->text - length;
    if (model->sea)
        snprintf(model->text + length, room, "its elevation %g", 0 - model->shift);
    else
        snprintf(model->text + length, room, "%s", ground);
}

/* Rock for a column of grid i that has none: at the top of the grid below. */
static bool rock_below(const struct ground_model *model, size_t i, size_t column, int sets,
                       double value[MODEL_SETS])
{
    const struct model_grid *grid = &model->grid[i];
    if (i + 1 == model->grids) return false;
    const double place[3] = {grid->at[0][column / grid->n[1]], grid->at[1][column % grid->n[1]], -INFINITY};
    model_grid_at(&model->grid[i + 1], place, sets, value);
    return true;
}

void model_fill(struct model_source *source, double none)
{
    struct ground_model *model = source->model;
    const int sets = model->damped ? MODEL_SETS : MODEL_VALUES;
    for (size_t i = model->grids; i-- > 0;) {
        const struct model_grid *grid = &model->grid[i];
        for (size_t column = 0; column < grid->n[0] * grid->n[1]; column++) {
            const size_t top = column * grid->n[2];
            double value[MODEL_SETS];
            size_t rock = 0;
            while (rock < grid->n[2] && grid->value[MODEL_VALUES - 1][top + rock] <= none)
                rock++;
            if (rock == 0 || (rock == grid->n[2] && !rock_below(model, i, column, sets, value))) continue;
            for (int set = 0; set < sets; set++) {
                if (rock < grid->n[2]) value[set] = grid->value[set][top + rock];
                for (size_t k = 0; k < rock; k++)
                    grid->value[set][top + k] = value[set];
            }
            source->filled += rock;
        }
    }
}
