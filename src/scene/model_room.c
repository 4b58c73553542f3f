/* Rooms for a model while it is read: which part of the file, what is kept of it, what takes the place of air. */
#include "base/memory.h"
#include "scene/model_file.h"

#include <math.h>
#include <string.h>

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

/* Bytes of values that are kept whole. */
enum { WHOLE_BYTES = 32 << 20 };

bool model_room(struct model_source *source, struct model_grid *grid, int sets)
{
    if (grid->n[2] == 0) { /* a surface */
        grid->n[2] = 1;
        grid->at[2] = scene_array(source->builder, 1, sizeof *grid->at[2]);
    }
    const double count = (double)grid->n[0] * (double)grid->n[1] * (double)grid->n[2];
    if (grid->value[0] == NULL && sets > 1) {
        source->kept += (double)sets * sizeof(double) * count;
        if (source->kept > model_pieces_kept(WHOLE_BYTES)) return true;
    }
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

bool model_unread(const struct model_source *source)
{
    return model_fault(source, "its values cannot be read; is it cut short?");
}

/* --- Air and water --- */

/* A grid while its air becomes rock. */
struct filling {
    struct model_source *source;
    size_t number;
    int sets;
    unsigned *rock; /* of one in pieces: model_pieces_fill() */
    double *value;
};

/* Rock for a column of the grid that has none: at the top of the grid below. */
static bool rock_below(const struct filling *filling, const struct model_grid *box, size_t column,
                       double value[MODEL_SETS])
{
    const struct ground_model *model = filling->source->model;
    if (filling->number + 1 == model->grids) return false;
    const double place[3] = {box->at[0][column / box->n[1]], box->at[1][column % box->n[1]], -INFINITY};
    model_grid_at(&model->grid[filling->number + 1], place, filling->sets, value);
    return true;
}

/* Room for what takes the place of air in a grid in pieces. */
static bool filling_room(struct filling *filling)
{
    const struct model_grid *grid = &filling->source->model->grid[filling->number];
    if (grid->pieces == NULL || filling->rock != NULL) return true;
    const size_t columns = grid->n[0] * grid->n[1];
    filling->rock = scene_array(filling->source->builder, columns, sizeof *filling->rock);
    filling->value = scene_array(filling->source->builder, columns * (size_t)filling->sets, sizeof(double));
    return filling->rock != NULL && filling->value != NULL;
}

static bool fill_box(void *context, const struct model_grid *box, size_t first_column)
{
    struct filling *filling = context;
    const size_t sets = (size_t)filling->sets;
    for (size_t column = 0; column < box->n[0] * box->n[1]; column++) {
        const size_t top = column * box->n[2];
        double value[MODEL_SETS];
        size_t rock = 0;
        while (rock < box->n[2] && box->value[MODEL_VALUES - 1][top + rock] <= filling->source->none)
            rock++;
        if (rock == 0 || (rock == box->n[2] && !rock_below(filling, box, column, value))) continue;
        if (!filling_room(filling)) return false;
        if (filling->rock != NULL) filling->rock[first_column + column] = (unsigned)rock;
        for (size_t set = 0; set < sets; set++) {
            if (rock < box->n[2]) value[set] = box->value[set][top + rock];
            for (size_t k = 0; k < rock; k++)
                box->value[set][top + k] = value[set];
            if (filling->rock != NULL) filling->value[(first_column + column) * sets + set] = value[set];
        }
        filling->source->filled += rock;
    }
    return true;
}

bool model_fill(struct model_source *source)
{
    struct ground_model *model = source->model;
    for (size_t i = model->grids; i-- > 0 && !isnan(source->none);) {
        struct filling filling = {source, i, model->damped ? MODEL_SETS : MODEL_VALUES, NULL, NULL};
        bool unread = false;
        const bool good = model_walk(&model->grid[i], fill_box, &filling, &unread);
        if (filling.rock != NULL) model_pieces_fill(&model->grid[i], filling.rock, filling.value);
        if (!good) return unread ? model_unread(source) : false;
    }
    ground_model_forget(model);
    return true;
}
