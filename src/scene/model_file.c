/* The ground from a file (doc/reference/models.md): which format it has, where the body lies in it,
 * whether its values are rock. */
#include "scene/model_file.h"

#include "base/hdf_quiet.h"
#include "base/memory.h"
#include "base/stored.h"

#include <errno.h>
#include <math.h>
#include <stdarg.h>
#include <string.h>

bool model_fault(const struct model_source *source, const char *format, ...)
{
    char text[400];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(text, sizeof text, format, arguments);
    va_end(arguments);
    complain(source->builder, source->group, "file", "'%s': %s", source->path, text);
    return false;
}

/* What rounding leaves of 0 is 0. */
static double rounded(double x)
{
    return fabs(x) < 1e-12 ? 0 : x;
}

/* The place that model%origin names, or the corner, along the file's axes. */
static bool take_origin(struct model_source *source, const struct model_axes *axes)
{
    struct ground_model *model = source->model;
    const size_t given = deck_values(source->group, "origin"), most = model->sea ? 3 : axes->coordinates;
    model->origin[0] = axes->corner[0];
    model->origin[1] = axes->corner[1];
    if (given == 0) return true;
    if (given < 2 || given > most) {
        complain(source->builder, source->group, "origin", "%zu values; expected %s of this format", given,
                 most == 2 ? "2, as depths are those below the model's own ground," : "2 or 3");
        return false;
    }
    double away[2];
    for (int i = 0; i < 2; i++)
        away[i] = deck_real(source->group, "origin", (size_t)i) - axes->from[i];
    const double angle = axes->turned ? axes->bearing * atan(1) / 45 : 0;
    const double c = rounded(cos(angle)), s = rounded(sin(angle));
    model->origin[0] = c * away[0] - s * away[1];
    model->origin[1] = s * away[0] + c * away[1];
    if (given == 3) model->shift += (model->sea ? -1 : 1) * deck_real(source->group, "origin", 2);
    return true;
}

bool model_place(struct model_source *source, const struct model_axes *axes)
{
    struct ground_model *model = source->model;
    const int north = axes->north, east = 1 - north;
    double angle = 0;
    if (deck_given(source->group, "azimuth"))
        angle = (deck_real(source->group, "azimuth", 0) - axes->bearing) * atan(1) / 45;
    const double c = rounded(cos(angle)), s = rounded(sin(angle));
    model->turn[north][0] = c;
    model->turn[east][0] = s;
    model->turn[north][1] = -s;
    model->turn[east][1] = c;
    if (!take_origin(source, axes)) return false;
    for (int axis = 0; axis < 2; axis++) {
        double *range = source->range[axis];
        range[0] = INFINITY;
        range[1] = -INFINITY;
        for (unsigned corner = 0; corner < 4; corner++) {
            const double at = model->origin[axis] +
                              model->turn[axis][0] * (corner & 1U ? model->high[0] : model->low[0]) +
                              model->turn[axis][1] * (corner & 2U ? model->high[1] : model->low[1]);
            range[0] = fmin(range[0], at);
            range[1] = fmax(range[1], at);
        }
    }
    return true;
}

bool model_covers(const struct model_source *source, int axis, double low, double high)
{
    const double *range = source->range[axis], small = 1e-6 * source->builder->scene->body.spacing;
    const bool above = axis == 2 && source->model->sea; /* there it is air */
    if ((low <= range[0] + small || above) && high >= range[1] - small) return true;
    return model_fault(
        source,
        "the model reaches from %.9g to %.9g along %c, the body from %.9g to %.9g, in the model's own %s",
        low, high, "xyz"[axis], range[0], range[1], axis == 2 ? "depths" : "coordinates");
}

bool model_meets(struct model_source *source, size_t i)
{
    const double *whole = source->whole[2], before = source->end;
    source->end = whole[1];
    if (i == 0 || fabs(whole[0] - before) <= 1e-4 * (whole[1] - whole[0])) return true;
    return model_fault(source, "a block that begins at depth %.9g follows one that ends at %.9g", whole[0],
                       before);
}

/* --- Checks --- */

/* What is wrong with a value; NULL: nothing. */
static const char *fault_of(const struct model_source *source, double density, double p, double s)
{
    if (!isfinite(density) || !isfinite(p) || !isfinite(s)) return "is not finite";
    if (s == -999 || fmin(fmin(density, p), s) < -1e19 || fmax(fmax(density, p), s) > 1e19)
        return "is air, water or no data";
    if (!(density > 0) || !(p > 0)) return "has a density or p_speed that is not above 0";
    if (!(s > 0)) return "has no s_speed: water and air are not offered";
    if (!(p * p > s * s * 4 / 3))
        return "has an s_speed of sqrt(3)/2 p_speed or more: its bulk modulus is negative";
    if (source->si && p < 30) return "is no rock in m/s; files of this format hold m/s, not km/s";
    if (source->si && p > 3e4)
        return "is no rock in m/s; are its units those that the file or its format names?";
    if (source->si && density < 30)
        return "is no rock in kg/m^3; files of this format hold kg/m^3, not g/cm^3";
    if (source->si && density > 5e4)
        return "is no rock in kg/m^3; are its units those that the file or its format names?";
    return NULL;
}

struct checked {
    const struct model_source *source;
    struct material fastest, slowest;
};

static bool check_box(void *context, const struct model_grid *grid, size_t first_column)
{
    (void)first_column;
    struct checked *checked = context;
    const struct model_source *source = checked->source;
    for (size_t i = 0; i < grid->n[0] * grid->n[1] * grid->n[2]; i++) {
        const double value[] = {grid->value[0][i], grid->value[1][i], grid->value[2][i]};
        const char *fault = fault_of(source, value[0], value[1], value[2]);
        const size_t at[3] = {i / grid->n[2] / grid->n[1], i / grid->n[2] % grid->n[1], i % grid->n[2]};
        if (fault != NULL)
            return model_fault(
                source,
                "the value at (%.9g, %.9g, %.9g) of the model's own axes%s, density %g, p_speed %g, "
                "s_speed %g, %s",
                grid->at[0][at[0]], grid->at[1][at[1]], grid->at[2][at[2]],
                source->model->depth == MODEL_BETWEEN ? " (depth in parts of its grid)" : "", value[0],
                value[1], value[2], fault);
        if (value[1] > checked->fastest.p_speed)
            checked->fastest = ground_model_material(source->model, grid, i);
        if (value[2] < checked->slowest.s_speed)
            checked->slowest = ground_model_material(source->model, grid, i);
    }
    return true;
}

/* Q that is none and air; grids in pieces are mended whenever they are read. */
static bool mend_values(struct model_source *source)
{
    const struct ground_model *model = source->model;
    for (size_t i = 0; i < model->grids && model->damped; i++)
        if (model->grid[i].pieces == NULL) model_no_quality(&model->grid[i]);
    return model_fill(source);
}

/* A deck in km beside a model in m/s makes a thousand times as many as are meant: some tens at the most. */
enum { MOST_CROSSINGS = 300 };

/* Values that are rock; materials of the fastest and the slowest one for what asks the scene for its speeds. */
static bool check_values(struct model_source *source)
{
    struct scene *scene = source->builder->scene;
    struct checked checked = {source, {.p_speed = 0}, {.s_speed = INFINITY}};
    if (!model_quality(source)) return false;
    for (size_t i = 0; i < source->model->grids; i++) {
        bool unread = false;
        if (!model_walk(&source->model->grid[i], check_box, &checked, &unread))
            return unread ? model_unread(source) : false;
    }
    struct material fastest = checked.fastest, slowest = checked.slowest;
    scene->body.material = scene->materials;
    snprintf(fastest.name, sizeof fastest.name, "the model's fastest value");
    snprintf(slowest.name, sizeof slowest.name, "the model's slowest value");
    scene->material[scene->materials++] = fastest;
    scene->material[scene->materials++] = slowest;
    if (fastest.p_speed * scene->end_time < scene->body.spacing)
        warn(source->builder->messages,
             "'%s': its fastest wave, %g, does not come as far as one spacing by end_time; are its speeds in "
             "the deck's units?",
             source->path, fastest.p_speed);
    double edge = 0;
    for (int axis = 0; axis < 3; axis++)
        edge = fmax(edge, scene->body.high[axis] - scene->body.low[axis]);
    if (slowest.s_speed * scene->end_time > MOST_CROSSINGS * edge)
        warn(source->builder->messages,
             "'%s': its slowest wave, %g, crosses the body %.3g times by end_time; are lengths and times of "
             "the deck in "
             "the units of its speeds?",
             source->path, slowest.s_speed, slowest.s_speed * scene->end_time / edge);
    return true;
}

/* --- The formats --- */

static bool read_hdf5(struct model_source *source)
{
    static const struct {
        const char *group; /* that files of this format have, and no other ones */
        bool (*read)(struct model_source *source, hid_t file);
    } format[] = {
        {"blocks", model_read_blocks}, {"Material_model", model_read_sfile}, {NULL, model_read_plain}};
    char fault[STORED_FAULT];
    bool good = false;
#pragma omp critical(selas_hdf5)
    {
        const struct quiet quiet = quiet_begin();
        const hid_t file = H5Fopen(source->path, H5F_ACC_RDONLY, H5P_DEFAULT);
        size_t i = 0;
        while (file >= 0 && format[i].group != NULL && !stored_here(file, format[i].group))
            i++;
        if (file < 0)
            good = model_fault(source, "cannot read this HDF5 file; is it cut short?");
        else
            good =
                stored_unpacks(file, fault) ? format[i].read(source, file) : model_fault(source, "%s", fault);
        if (file >= 0) H5Fclose(file);
        quiet_end(quiet);
    }
    return good;
}

static bool read_other(struct model_source *source)
{
    FILE *file = fopen(source->path, "rb");
    if (file == NULL) return model_fault(source, "cannot read it: %s", strerror(errno));
    unsigned char start[4] = {0};
    const size_t count = fread(start, 1, sizeof start, file);
    if (count == 0) {
        const bool good = ferror(file) ? model_fault(source, "cannot read it: %s", strerror(errno))
                                       : model_fault(source, "it is empty");
        fclose(file);
        return good;
    }
    const bool binary = count == sizeof start && start[1] == 0 && start[2] == 0 && start[0] + start[3] == 1;
    rewind(file);
    const bool good = binary ? model_read_rfile(source, file) : model_read_text(source, file);
    fclose(file);
    return good;
}

/* Least distance of values along the axes of the body. */
static double detail_of(const struct ground_model *model, const struct model_grid *grid, size_t grids,
                        int own)
{
    double detail = INFINITY;
    for (size_t i = 0; i < grids; i++)
        for (int axis = 0; axis < 2; axis++)
            for (size_t k = 0; k + 1 < grid[i].n[axis] && model->turn[axis][own] != 0; k++)
                detail = fmin(detail,
                              (grid[i].at[axis][k + 1] - grid[i].at[axis][k]) / fabs(model->turn[axis][own]));
    return detail;
}

/* Of the grids, and of the surfaces where depths of the body count from one. */
static void find_detail(struct ground_model *model)
{
    const size_t surfaces = model->sea && model->depth == MODEL_BELOW ? 0 : model->surfaces;
    for (int own = 0; own < 2; own++)
        model->detail[own] = fmin(detail_of(model, model->grid, model->grids, own),
                                  detail_of(model, model->surface, surfaces, own));
}

static void tell_filled(struct model_source *source)
{
    char *text = source->model->text;
    const size_t length = strlen(text);
    if (source->filled > 0)
        snprintf(text + length, sizeof source->model->text - length,
                 "; %zu values of air or water are those of the rock below", source->filled);
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
    struct model_source source = {
        .builder = builder, .group = group, .path = path, .model = model, .none = NAN};
    if (model != NULL && path != NULL && builder->body_known) {
        model->sea = strcmp(deck_text(group, "depth", 0), "sea") == 0;
        source.below_sea = deck_count(builder->deck, "topography") > 0;
        memcpy(model->low, scene->body.low, sizeof model->low);
        memcpy(model->high, scene->body.high, sizeof model->high);
        source.range[2][1] = model->high[2] - model->low[2];
        if ((stored_is_hdf5(path) ? read_hdf5(&source) : read_other(&source)) && mend_values(&source) &&
            check_values(&source)) {
            find_detail(model);
            tell_filled(&source);
        }
    }
    array_free(path);
}
