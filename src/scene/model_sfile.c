/* SW4's sfile: HDF5; Z_interfaces/z_values_i [nx][ny], depths below the sea of the surfaces between the grids,
 * the first one the ground; Material_model/grid_i/Rho, Cp, Cs (and Qp, Qs) [nx][ny][nz], attribute Horizontal
 * grid size, values at even parts of the way between the surfaces; attributes of the file ngrids, Attenuation,
 * and the origin's place and azimuth (SW4 User's Guide, file formats). Surfaces of more values than their grid
 * lie on the same ground. Air and water take what is below them, as SW4 does. Between the ground and the last
 * surface depths of the body are stretched, so that the last surface stays where it is. */
#include "base/stored.h"
#include "scene/model_file.h"

#include <math.h>

enum { MOST_GRIDS = 100 };
static const char *const names[MODEL_SETS] = {"Rho", "Cp", "Cs", "Qp", "Qs"};

static bool not_sfile(const struct model_source *source, const char *name, size_t i, const char *why)
{
    return model_fault(source, "its group Material_model makes it SW4's sfile, but %s%zu is %s", name, i,
                       why);
}

static hid_t open_group(hid_t place, const char *name)
{
    return stored_here(place, name) ? H5Gopen2(place, name, H5P_DEFAULT) : -1;
}

/* How the values of a grid lie along x and y. */
struct lay {
    size_t n[2];
    double step;
};

static double length_of(const struct lay *lay, int axis)
{
    return lay->step * (double)(lay->n[axis] - 1);
}

/* Step of `count` values along an axis: of the one of two grids that has as many, or even parts of the model. */
static double step_along(const struct lay *lay, const size_t grid[2], int axis, size_t count)
{
    for (int i = 0; i < 2; i++)
        if (lay[grid[i]].n[axis] == count) return lay[grid[i]].step;
    return length_of(&lay[0], axis) / (double)(count - 1);
}

/* A data set that lies as one of two grids does, with values at even distances. */
static bool read_values(struct model_source *source, hid_t group, const char *name, struct model_grid *grid,
                        const struct lay *lay, const size_t alike[2], int set)
{
    size_t extent[4], first[3] = {0};
    const struct ground_model *model = source->model;
    const hid_t data = stored_set(group, name);
    const int rank = data >= 0 ? model_extent(data, extent) : 0;
    const bool surface = rank == 2;
    bool good = rank == 3 || surface;
    for (int axis = 0; axis < rank && good; axis++) {
        const double step =
            axis < 2 ? step_along(lay, alike, axis, extent[axis]) : 1. / (double)(extent[2] - 1);
        good = extent[axis] > 1;
        if (!good) continue;
        if (set == 0)
            good = model_even_part(source, grid, axis, 0, step, extent[axis], &first[axis]);
        else
            first[axis] = (size_t)lround(grid->at[axis][0] / step);
        good = good && fabs(grid->at[axis][1] - grid->at[axis][0] - step) < 1e-6 * step;
    }
    const int sets = surface ? 1 : model->damped ? MODEL_SETS : MODEL_VALUES;
    const struct model_column column = {data, 0, 1};
    if (good && set == 0) good = model_room(source, grid, sets);
    if (good)
        good = surface ? model_read_part(data, 2, grid->n, first, 0, grid->value[0])
                       : model_take(grid, sets, set, &column, first);
    if (data >= 0) H5Dclose(data);
    return good;
}

static bool read_surfaces(struct model_source *source, hid_t file, const struct lay *lay)
{
    struct ground_model *model = source->model;
    const hid_t group = open_group(file, "Z_interfaces");
    if (group < 0) return model_fault(source, "it has no group Z_interfaces, as SW4's sfiles have");
    bool good = true;
    for (size_t i = 0; i < model->surfaces && good; i++) {
        char name[32];
        const size_t alike[2] = {i > 0 ? i - 1 : 0, i < model->grids ? i : i - 1};
        snprintf(name, sizeof name, "z_values_%zu", i);
        good = read_values(source, group, name, &model->surface[i], lay, alike, 0) ||
               not_sfile(source, "Z_interfaces/z_values_", i, "missing, cut short or not [nx][ny]");
        for (size_t k = 0; good && k < model->surface[i].n[0] * model->surface[i].n[1]; k++)
            if (!(fabs(model->surface[i].value[0][k]) < 1e6))
                good = not_sfile(source, "Z_interfaces/z_values_", i, "not finite");
    }
    H5Gclose(group);
    return good;
}

/* Each surface below the one before, at the values of the finer of the two. */
static bool check_order(const struct model_source *source)
{
    const struct ground_model *model = source->model;
    for (size_t s = 0; s + 1 < model->surfaces; s++) {
        const struct model_grid *fine = &model->surface[s];
        for (size_t i = 0; i < fine->n[0] * fine->n[1]; i++) {
            const double place[3] = {fine->at[0][i / fine->n[1]], fine->at[1][i % fine->n[1]], 0};
            double below = 0;
            model_grid_at(&model->surface[s + 1], place, 1, &below);
            if (below < fine->value[0][i] || (s + 2 == model->surfaces && !(below > 0)))
                return model_fault(
                    source,
                    "surface %zu, at depth %g below the sea, lies above surface %zu, at %g, or "
                    "the last one above the sea, at (%g, %g)",
                    s + 1, below, s, fine->value[0][i], place[0], place[1]);
        }
    }
    return true;
}

static bool read_grids(struct model_source *source, hid_t file, const struct lay *lay)
{
    struct ground_model *model = source->model;
    const hid_t all = open_group(file, "Material_model");
    bool good = all >= 0;
    for (size_t i = 0; i < model->grids && good; i++) {
        char name[32];
        snprintf(name, sizeof name, "grid_%zu", i);
        const hid_t group = open_group(all, name);
        for (int set = 0; set < (model->damped ? MODEL_SETS : MODEL_VALUES) && good; set++)
            good = group >= 0 &&
                   read_values(source, group, names[set], &model->grid[i], lay, (const size_t[2]){i, i}, set);
        if (!good)
            not_sfile(source, "Material_model/grid_", i,
                      model->damped ? "missing, cut short or not Rho, Cp, Cs, Qp, Qs [nx][ny][nz]"
                                    : "missing, cut short or not Rho, Cp, Cs [nx][ny][nz]");
        if (group >= 0) H5Gclose(group);
    }
    if (all >= 0) H5Gclose(all);
    return good;
}

/* How each grid lies; all cover the same ground, but for a step. */
static bool find_lays(const struct model_source *source, hid_t file, size_t grids, struct lay *lay)
{
    const hid_t all = open_group(file, "Material_model");
    bool good = all >= 0;
    for (size_t i = 0; i < grids && good; i++) {
        char name[32];
        snprintf(name, sizeof name, "grid_%zu", i);
        const hid_t group = open_group(all, name), data = group >= 0 ? stored_set(group, "Cp") : -1;
        size_t extent[4] = {0};
        good = data >= 0 && model_extent(data, extent) == 3 && extent[0] > 1 && extent[1] > 1 &&
               model_numbers(group, "Horizontal grid size", 1, &lay[i].step) && lay[i].step > 0;
        if (!good)
            not_sfile(
                source, "Material_model/grid_", i,
                "missing, cut short or not [nx][ny][nz], or its attribute Horizontal grid size is missing");
        for (int axis = 0; axis < 2 && good; axis++) {
            lay[i].n[axis] = extent[axis];
            const double own = length_of(&lay[i], axis), first = length_of(&lay[0], axis);
            if (!(fabs(own - first) < 1.001 * lay[i].step))
                good = model_fault(
                    source,
                    "grid_%zu reaches to %.9g along %c (Horizontal grid size %.9g), grid_0 to %.9g; "
                    "expected the same but for a step",
                    i, own, "xy"[axis], lay[i].step, first);
        }
        if (data >= 0) H5Dclose(data);
        if (group >= 0) H5Gclose(group);
    }
    if (all >= 0) H5Gclose(all);
    return good;
}

bool model_read_sfile(struct model_source *source, hid_t file)
{
    struct ground_model *model = source->model;
    double place[3], grids = 0, damped = 0, top, least, end, deepest;
    source->si = true;
    source->none = -999;
    source->model->sea = source->model->sea || source->below_sea;
    if (!model_numbers(file, "Origin longitude, latitude, azimuth", 3, place) ||
        !model_numbers(file, "ngrids", 1, &grids) || !(grids >= 1) || grids > MOST_GRIDS)
        return model_fault(source,
                           "its group Material_model makes it SW4's sfile, but its attributes 'Origin "
                           "longitude, latitude, azimuth' or 'ngrids' (1 to 100) are missing");
    const struct model_axes axes = {.bearing = place[2], .coordinates = 2};
    model_sets(source, model_numbers(file, "Attenuation", 1, &damped) && damped == 1);
    model->depth = MODEL_BETWEEN;
    struct lay lay[MOST_GRIDS] = {0};
    if (!find_lays(source, file, (size_t)grids, lay) ||
        !model_grids(source, (size_t)grids, (size_t)grids + 1) || !model_place(source, &axes) ||
        !model_covers(source, 0, 0, length_of(lay, 0)) || !model_covers(source, 1, 0, length_of(lay, 1)) ||
        !read_surfaces(source, file, lay) || !check_order(source))
        return false;
    model_extremes(&model->surface[0], &least, &top);
    model_extremes(&model->surface[model->surfaces - 1], &end, &deepest);
    source->range[2][1] += model->shift;
    if (!model_covers(source, 2, 0, end)) return false;
    source->range[2][1] = 1; /* of each grid all */
    snprintf(model->text, sizeof model->text,
             "sfile of %zu grids, x points %.6g degrees from north, ground %.6g to %.6g above the sea, "
             "bottom %.6g "
             "below it; depth 0 is ",
             model->grids, place[2], -top, -least, end);
    model_tell_depth(model, "its ground, depths are stretched above its bottom");
    if (!read_grids(source, file, lay)) return false;
    return true;
}
