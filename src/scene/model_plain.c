/* A plain grid: HDF5 data sets density, p_speed, s_speed [nx, ny, nz], z fastest and downward, and attributes
 * origin and spacing of the file itself, three numbers each: the place of the first value and the steps; where it is
 * damped, q_p and q_s beside them. */
#include "base/stored.h"
#include "scene/model_file.h"

static const char *const names[MODEL_SETS] = {"density", "p_speed", "s_speed", "q_p", "q_s"};

static bool not_plain(const struct model_source *source, const char *what)
{
    return model_fault(source,
                       "cannot read it: expected an HDF5 file with data sets density, p_speed, s_speed [nx, "
                       "ny, nz] and attributes origin and spacing of three numbers each (or a GeoModelGrids "
                       "file, or SW4's sfile); %s",
                       what);
}

/* Reads a data set; the first one says how many values there are along each axis. */
static bool read_set(struct model_source *source, hid_t file, int which, int sets, const double origin[3],
                     const double spacing[3], size_t extent[4], size_t first[3])
{
    struct model_grid *grid = &source->model->grid[0];
    size_t own[4];
    const hid_t set = stored_set(file, names[which]);
    bool good = set >= 0 && model_extent(set, own) == 3;
    for (int axis = 0; axis < 3 && good; axis++) {
        if (which == 0) extent[axis] = own[axis];
        good = own[axis] == extent[axis];
    }
    if (!good) not_plain(source, "a data set is missing, cut short or of another extent");
    for (int axis = 0; axis < 3 && good && which == 0; axis++)
        good = model_even_part(source, grid, axis, origin[axis], spacing[axis], extent[axis], &first[axis]) &&
               model_covers(source, axis, origin[axis],
                            origin[axis] + spacing[axis] * (double)(extent[axis] - 1));
    if (good && which == 0) good = model_room(source, grid, sets);
    const struct model_column column = {set, 0, 1};
    if (good && !model_take(grid, sets, which, &column, first))
        good = not_plain(source, "a data set cannot be read");
    if (set >= 0) H5Dclose(set);
    return good;
}

bool model_read_plain(struct model_source *source, hid_t file)
{
    struct ground_model *model = source->model;
    const struct model_axes axes = {.coordinates = 3};
    double origin[3], spacing[3];
    size_t extent[4] = {0}, first[3] = {0};
    if (!model_numbers(file, "origin", 3, origin) || !model_numbers(file, "spacing", 3, spacing))
        return not_plain(source, "an attribute is missing");
    if (model->sea) return model_fault(source, "a plain grid knows no sea; leave model%%depth out");
    model->shift = model->low[2]; /* its depths are the body's own z */
    if (!model_grids(source, 1, 0) || !model_place(source, &axes)) return false;
    model->sea = source->below_sea; /* at its own z, also above face z- */
    source->range[2][0] = model->shift;
    source->range[2][1] += model->shift;
    const int sets = model_sets(source, stored_here(file, "q_p") || stored_here(file, "q_s"));
    for (int which = 0; which < sets; which++)
        if (!read_set(source, file, which, sets, origin, spacing, extent, first)) return false;
    snprintf(model->text, sizeof model->text, "plain grid of %zu x %zu x %zu, %zu x %zu x %zu of them read",
             extent[0], extent[1], extent[2], model->grid[0].n[0], model->grid[0].n[1], model->grid[0].n[2]);
    return true;
}
