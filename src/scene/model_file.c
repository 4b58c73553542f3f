/* The ground from a file: density and speeds on an even grid (doc/general-ground.md, section 4).
 *
 * HDF5: data sets density, p_speed, s_speed [nx, ny, nz], z fastest, and attributes origin and spacing, three
 * numbers each, of the file itself: the place of the first value in the body's frame and the steps. */
#include "base/hdf_quiet.h"
#include "base/memory.h"
#include "base/stored.h"
#include "scene/build.h"
#include "scene/ground.h"

#include <math.h>
#include <string.h>

static const char *const sets[MODEL_VALUES] = {"density", "p_speed", "s_speed"};

static size_t points_of(const struct ground_model *model)
{
    return model->n[0] * model->n[1] * model->n[2];
}

static bool read_attribute(hid_t file, const char *name, double value[3])
{
    if (H5Aexists(file, name) <= 0) return false;
    const hid_t attribute = H5Aopen(file, name, H5P_DEFAULT), space = H5Aget_space(attribute);
    const bool right =
        H5Sget_simple_extent_npoints(space) == 3 && H5Aread(attribute, H5T_NATIVE_DOUBLE, value) >= 0;
    H5Sclose(space);
    H5Aclose(attribute);
    return right && isfinite(value[0] + value[1] + value[2]);
}

/* Reads a data set; the first one says how many values there are along each axis. */
static bool read_set(hid_t file, int which, struct ground_model *model)
{
    const hid_t set = stored_set(file, sets[which]);
    if (set < 0) return false;
    const hid_t space = H5Dget_space(set);
    hsize_t extent[3] = {0};
    bool right =
        H5Sget_simple_extent_ndims(space) == 3 && H5Sget_simple_extent_dims(space, extent, NULL) == 3;
    for (int axis = 0; axis < 3 && right; axis++) {
        if (which == 0) model->n[axis] = (size_t)extent[axis];
        right = extent[axis] >= 2 && extent[axis] == model->n[axis];
    }
    if (right) model->value[which] = array_new(points_of(model), sizeof *model->value[which]);
    right = right && model->value[which] != NULL &&
            H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, model->value[which]) >= 0;
    H5Sclose(space);
    H5Dclose(set);
    return right;
}

static bool read_file(const char *path, struct ground_model *model)
{
    bool right = false;
#pragma omp critical(selas_hdf5)
    {
        const struct quiet quiet = quiet_begin();
        const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT);
        right = file >= 0 && read_attribute(file, "origin", model->origin) &&
                read_attribute(file, "spacing", model->spacing);
        for (int which = 0; which < MODEL_VALUES && right; which++)
            right = read_set(file, which, model);
        if (file >= 0) H5Fclose(file);
        quiet_end(quiet);
    }
    for (int axis = 0; axis < 3; axis++)
        right = right && model->spacing[axis] > 0;
    return right;
}

/* What is wrong with a value of the grid; NULL: nothing. */
static const char *fault_of(double density, double p, double s)
{
    if (!isfinite(density) || !isfinite(p) || !isfinite(s)) return "is not finite";
    if (!(density > 0) || !(p > 0)) return "has a density or p_speed that is not above 0";
    if (!(s > 0)) return "has no s_speed: water and air are not offered";
    if (!(p * p > s * s * 4 / 3))
        return "has an s_speed of sqrt(3)/2 p_speed or more: its bulk modulus is negative";
    return NULL;
}

static struct material material_of(const struct ground_model *model, size_t i)
{
    struct material material = {
        .density = model->value[0][i], .p_speed = model->value[1][i], .s_speed = model->value[2][i]};
    material.mu = material.density * material.s_speed * material.s_speed;
    material.lambda = material.plane_lambda =
        material.density * material.p_speed * material.p_speed - 2 * material.mu;
    material.young = material.mu * (3 * material.lambda + 2 * material.mu) / (material.lambda + material.mu);
    material.poisson = material.lambda / (2 * (material.lambda + material.mu));
    return material;
}

/* Values that are rock; materials of the fastest and the slowest one for what asks the scene for its speeds. */
static bool check_values(struct builder *builder, const struct deck_group *group,
                         const struct ground_model *model)
{
    size_t fastest = 0, slowest = 0;
    for (size_t i = 0; i < points_of(model); i++) {
        const char *fault = fault_of(model->value[0][i], model->value[1][i], model->value[2][i]);
        const size_t at[3] = {i / model->n[2] / model->n[1], i / model->n[2] % model->n[1], i % model->n[2]};
        if (fault != NULL) {
            complain(builder, group, "file",
                     "value [%zu, %zu, %zu], at (%g, %g, %g), density %g, p_speed %g, s_speed %g, %s", at[0],
                     at[1], at[2], model->origin[0] + (double)at[0] * model->spacing[0],
                     model->origin[1] + (double)at[1] * model->spacing[1],
                     model->origin[2] + (double)at[2] * model->spacing[2], model->value[0][i],
                     model->value[1][i], model->value[2][i], fault);
            return false;
        }
        if (model->value[1][i] > model->value[1][fastest]) fastest = i;
        if (model->value[2][i] < model->value[2][slowest]) slowest = i;
    }
    struct scene *scene = builder->scene;
    scene->body.material = scene->materials;
    scene->material[scene->materials++] = material_of(model, fastest);
    scene->material[scene->materials++] = material_of(model, slowest);
    return true;
}

static void check_cover(struct builder *builder, const struct deck_group *group,
                        const struct ground_model *model)
{
    const struct body *body = &builder->scene->body;
    for (int axis = 0; axis < 3 && builder->body_known; axis++) {
        const double end = model->origin[axis] + (double)(model->n[axis] - 1) * model->spacing[axis];
        const double small = 1e-6 * body->spacing;
        if (model->origin[axis] <= body->low[axis] + small && end >= body->high[axis] - small) continue;
        complain(builder, group, "file", "the model reaches from %g to %g along %c, the body from %g to %g",
                 model->origin[axis], end, "xyz"[axis], body -> low[axis], body -> high[axis]);
    }
}

void build_model(struct builder *builder)
{
    struct scene *scene = builder->scene;
    if (deck_count(builder->deck, "model") == 0) return;
    const struct deck_group *group = deck_get(builder->deck, "model", 0);
    if (scene->dimension != 3 || scene->body.shape != BODY_BOX) {
        complain(builder, group, NULL,
                 "a model of the ground needs scene%%dimension = 3 and body%%shape = 'box'");
        return;
    }
    struct ground_model *model = scene_array(builder, 1, sizeof *model);
    char *path = deck_path(builder, deck_text(group, "file", 0));
    scene->body.model = model;
    if (model == NULL || path == NULL) return;
    if (!read_file(path, model))
        complain(builder, group, "file",
                 "cannot read '%s': expected an HDF5 file with data sets density, p_speed, s_speed [nx, ny, "
                 "nz], at "
                 "least two values along each axis, and attributes origin and spacing of three numbers each",
                 path);
    else if (check_values(builder, group, model))
        check_cover(builder, group, model);
    array_free(path);
}

void ground_model_free(struct ground_model *model)
{
    for (int which = 0; model != NULL && which < MODEL_VALUES; which++)
        array_free(model->value[which]);
    array_free(model);
}

struct rock ground_model_at(const struct ground_model *model, const double place[3])
{
    size_t at[3];
    double part[3], value[MODEL_VALUES] = {0};
    for (int axis = 0; axis < 3; axis++) {
        const double last = (double)(model->n[axis] - 1);
        const double x = fmin(fmax((place[axis] - model->origin[axis]) / model->spacing[axis], 0), last);
        at[axis] = (size_t)fmin(floor(x), last - 1);
        part[axis] = x - (double)at[axis];
    }
    for (unsigned corner = 0; corner < 8; corner++) {
        size_t index = 0;
        double weight = 1;
        for (int axis = 0; axis < 3; axis++) {
            const unsigned up = corner >> axis & 1U;
            index = index * model->n[axis] + at[axis] + up;
            weight *= up ? part[axis] : 1 - part[axis];
        }
        for (int which = 0; which < MODEL_VALUES; which++)
            value[which] += weight * model->value[which][index];
    }
    const double mu = value[0] * value[2] * value[2];
    return (struct rock){value[0], value[0] * value[1] * value[1] - 2 * mu, mu};
}
