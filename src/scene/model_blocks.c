/* GeoModelGrids: HDF5; group blocks, of each a data set [nx][ny][nz][values], z downward, with attributes
 * x_resolution or x_coordinates (so y, z; or resolution_horiz, resolution_vert) and z_top; group surfaces,
 * top_surface and topography_bathymetry [nx][ny][1], elevations; attributes of the file: data_values and
 * data_units (Vp, Vs, density are looked for), data_layout 'vertex', origin_x, origin_y, y_azimuth, dim_z. The
 * blocks' z is stretched between the top surface and the bottom (GeoModelGrids' manual, "Storage layout" and
 * "Squashing"; where two blocks meet the upper one counts). Depths of the body are those below the solid ground,
 * in a model squashed down to its bottom, or true elevations. */
#include "base/memory.h"
#include "base/stored.h"
#include "scene/model_file.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

enum { NAME = 64, MOST_BLOCKS = 100, MOST_VALUES = 50 };
static const char *const wanted[MODEL_SETS] = {"density", "Vp", "Vs", "Qp", "Qs"};

struct blocks {
    struct model_source *source;
    hid_t group[2];  /* blocks, surfaces (or -1) */
    bool top, floor; /* surfaces that there are */
    int sets;
    size_t component[MODEL_SETS];
    double factor[MODEL_SETS]; /* to m/s and kg/m^3; of Q 1 */
    double bottom;             /* dim_z */
    size_t count;
    struct block {
        char name[NAME];
        double top;
    } block[MOST_BLOCKS];
};

static bool read_units(struct blocks *blocks, hid_t file, int which)
{
    static const struct {
        const char *unit;
        double factor;
    } known[] = {{"m/s", 1},   {"km/s", 1000},    {"kg/m**3", 1},   {"kg/m^3", 1},
                 {"kg/m3", 1}, {"g/cm**3", 1000}, {"g/cm^3", 1000}, {"g/cm3", 1000}};
    char unit[NAME] = "";
    if (model_word(file, "data_units", blocks->component[which], unit, sizeof unit))
        for (size_t i = 0; i < sizeof known / sizeof *known; i++)
            if (strcmp(unit, known[i].unit) == 0 && (strchr("mk", unit[0]) != NULL || which == 0)) {
                blocks->factor[which] = known[i].factor;
                return true;
            }
    return model_fault(blocks->source, "its %s is in '%s'; expected m/s, km/s, kg/m**3 or g/cm**3",
                       wanted[which], unit);
}

/* Which of the file's values are ours. */
static bool find_values(struct blocks *blocks, hid_t file)
{
    char word[NAME], all[300] = "";
    for (int which = 0; which < MODEL_SETS; which++)
        blocks->component[which] = MOST_VALUES;
    for (size_t i = 0; i < MOST_VALUES && model_word(file, "data_values", i, word, sizeof word); i++) {
        for (int which = 0; which < MODEL_SETS; which++)
            if (strcasecmp(word, wanted[which]) == 0) blocks->component[which] = i;
        const size_t length = strlen(all);
        snprintf(all + length, sizeof all - length, "%s%s", i > 0 ? ", " : "", word);
    }
    for (int which = 0; which < MODEL_VALUES; which++)
        if (blocks->component[which] == MOST_VALUES)
            return model_fault(
                blocks->source,
                "its group blocks makes it a GeoModelGrids file, but its values are %s; expected "
                "density, Vp, Vs among them",
                all[0] != '\0' ? all : "not named");
        else if (!read_units(blocks, file, which))
            return false;
    const bool quality[2] = {blocks->component[MODEL_VALUES] < MOST_VALUES,
                             blocks->component[MODEL_VALUES + 1] < MOST_VALUES};
    if (quality[0] != quality[1])
        return model_fault(blocks->source, "its values are %s; expected Qp and Qs, or neither", all);
    blocks->sets = model_sets(blocks->source, quality[0]);
    blocks->factor[MODEL_VALUES] = blocks->factor[MODEL_VALUES + 1] = 1;
    if (model_word(file, "data_layout", 0, word, sizeof word) && strcmp(word, "vertex") == 0) return true;
    return model_fault(blocks->source, "its data_layout is not 'vertex'");
}

/* Its coordinates are in metres, as far as its crs says: PROJ's +units, or the unit that its text (WKT) names. */
static bool in_metres(const struct blocks *blocks, hid_t file)
{
    char crs[4000] = "";
    if (!model_word(file, "crs", 0, crs, sizeof crs)) return true;
    const char *unit = strstr(crs, "+units=");
    const bool other = unit != NULL && strcspn(unit + 7, " ") != 1;
    if (!other && strcasestr(crs, "foot") == NULL && strcasestr(crs, "feet") == NULL) return true;
    return model_fault(blocks->source, "its crs has lengths in other units than metres: '%.200s'", crs);
}

static int by_top(const void *one, const void *other)
{
    const double a = ((const struct block *)one)->top, b = ((const struct block *)other)->top;
    return (a < b) - (a > b);
}

/* The elevation of a block's first values. */
static bool find_top(hid_t set, double *top)
{
    size_t extent[4];
    if (model_numbers(set, "z_top", 1, top)) return true;
    if (model_extent(set, extent) != 4 || extent[2] == 0 || extent[2] > 1000000) return false;
    double *place = array_new(extent[2], sizeof *place);
    const bool good = place != NULL && model_numbers(set, "z_coordinates", extent[2], place);
    for (size_t i = 0; good && i < extent[2]; i++)
        *top = i == 0 ? place[0] : fmax(*top, place[i]);
    array_free(place);
    return good;
}

/* Names of the blocks from the top down. */
static bool find_blocks(struct blocks *blocks)
{
    H5G_info_t info;
    if (blocks->group[0] < 0 || H5Gget_info(blocks->group[0], &info) < 0 || info.nlinks < 1 ||
        info.nlinks > MOST_BLOCKS)
        return model_fault(blocks->source, "its group blocks does not hold 1 to %d blocks", MOST_BLOCKS);
    for (blocks->count = 0; blocks->count < info.nlinks; blocks->count++) {
        char *name = blocks->block[blocks->count].name;
        if (H5Lget_name_by_idx(blocks->group[0], ".", H5_INDEX_NAME, H5_ITER_INC, blocks->count, name, NAME,
                               H5P_DEFAULT) < 0)
            return model_fault(blocks->source, "cannot read the name of block %zu", blocks->count + 1);
        const hid_t set = stored_set(blocks->group[0], name);
        const bool good = set >= 0 && find_top(set, &blocks->block[blocks->count].top);
        if (set >= 0) H5Dclose(set);
        if (!good)
            return model_fault(blocks->source,
                               "block '%s' is cut short or has neither z_top nor z_coordinates", name);
    }
    qsort(blocks->block, blocks->count, sizeof *blocks->block, by_top);
    return true;
}

static int rising(const void *one, const void *other)
{
    const double a = *(const double *)one, b = *(const double *)other;
    return (a > b) - (a < b);
}

/* Places along one axis of a data set: even or listed; z downward. */
static bool lay_axis(const struct blocks *blocks, hid_t set, const char *name, int axis, size_t count,
                     double top, struct model_grid *grid, size_t *first)
{
    char even[] = "x_resolution", listed[] = "x_coordinates";
    double step = 0;
    even[0] = listed[0] = "xyz"[axis];
    const bool is_listed = H5Aexists(set, listed) > 0;
    if (model_numbers(set, even, 1, &step) ||
        (!is_listed && model_numbers(set, axis == 2 ? "resolution_vert" : "resolution_horiz", 1, &step)))
        return model_even_part(blocks->source, grid, axis, axis == 2 ? -top : 0, step, count, first);
    double *place = scene_array(blocks->source->builder, count, sizeof *place);
    bool good = place != NULL;
    if (good && !model_numbers(set, listed, count, place))
        good = model_fault(blocks->source, "'%s' has neither %s nor %zu %s", name, even, count, listed);
    for (size_t i = 0; good && i < count && axis == 2; i++)
        place[i] = -place[i];
    /* over depth in any order in the file, values top down, as GeoModelGrids' own reader has it (serial/Block.cc) */
    if (good && axis == 2) qsort(place, count, sizeof *place, rising);
    good = good && model_part(blocks->source, grid, axis, place, count, first);
    array_free(place);
    return good;
}

static bool lay_grid(const struct blocks *blocks, hid_t set, const char *name, int axes, double top,
                     struct model_grid *grid, size_t first[3])
{
    size_t extent[4];
    if (set < 0 || model_extent(set, extent) != axes + 1)
        return model_fault(blocks->source, "'%s' is missing, cut short or has not %d axes", name, axes + 1);
    if (axes == 3)
        for (int which = 0; which < blocks->sets; which++)
            if (blocks->component[which] >= extent[3])
                return model_fault(blocks->source, "block '%s' has %zu values each, fewer than are named",
                                   name, extent[3]);
    for (int axis = 0; axis < axes; axis++) {
        if (!lay_axis(blocks, set, name, axis, extent[axis], top, grid, &first[axis])) return false;
        const double *whole = blocks->source->whole[axis];
        if (axis < 2 && !model_covers(blocks->source, axis, whole[0], whole[1])) return false;
    }
    return model_room(blocks->source, grid, axes == 3 ? blocks->sets : 1);
}

static bool read_block(const struct blocks *blocks, size_t i)
{
    struct model_grid *grid = &blocks->source->model->grid[i];
    const char *name = blocks->block[i].name;
    size_t first[3] = {0};
    const hid_t set = stored_set(blocks->group[0], name);
    bool good = lay_grid(blocks, set, name, 3, blocks->block[i].top, grid, first) &&
                model_meets(blocks->source, i) &&
                (i + 1 < blocks->count ||
                 model_covers(blocks->source, 2, 0 - blocks->block[0].top, blocks->source->whole[2][1]));
    for (int which = 0; good && which < blocks->sets; which++) {
        const struct model_column column = {set, blocks->component[which], blocks->factor[which]};
        good = model_take(grid, blocks->sets, which, &column, first) ||
               model_fault(blocks->source, "cannot read block '%s'", name);
    }
    if (set >= 0) H5Dclose(set);
    return good;
}

/* A surface, downward. */
static bool read_surface(const struct blocks *blocks, const char *name, struct model_grid *surface)
{
    size_t first[3] = {0};
    const hid_t set = stored_set(blocks->group[1], name);
    bool good = lay_grid(blocks, set, name, 2, 0, surface, first);
    if (good && !model_read_part(set, 2, surface->n, first, 0, surface->value[0]))
        good = model_fault(blocks->source, "cannot read '%s'", name);
    for (size_t k = 0; good && k < surface->n[0] * surface->n[1]; k++) {
        surface->value[0][k] = -surface->value[0][k];
        if (!(fabs(surface->value[0][k]) < fmin(1e6, blocks->bottom)))
            good =
                model_fault(blocks->source, "'%s' has elevation %g at (%g, %g)", name, -surface->value[0][k],
                            surface->at[0][k / surface->n[1]], surface->at[1][k % surface->n[1]]);
    }
    if (set >= 0) H5Dclose(set);
    return good;
}

/* A level surface at the sea, in place of a top that the file leaves out. */
static bool lay_level(const struct blocks *blocks, struct model_grid *surface)
{
    for (int axis = 0; axis < 2; axis++) {
        surface->n[axis] = 1;
        surface->at[axis] = scene_array(blocks->source->builder, 1, sizeof *surface->at[axis]);
        if (surface->at[axis] == NULL) return false;
    }
    return model_room(blocks->source, surface, 1);
}

/* The solid ground nowhere above the top, but for what surfaces of different steps make of one another. */
static bool check_floor(const struct blocks *blocks)
{
    const struct ground_model *model = blocks->source->model;
    const struct model_grid *floor = &model->surface[1];
    for (size_t k = 0; k < floor->n[0] * floor->n[1]; k++) {
        const double place[3] = {floor->at[0][k / floor->n[1]], floor->at[1][k % floor->n[1]], 0};
        double top = 0;
        model_grid_at(&model->surface[0], place, 1, &top);
        if (floor->value[0][k] < top - 1e-3 * blocks->bottom)
            return model_fault(blocks->source,
                               "its topography_bathymetry has elevation %g at (%g, %g), above its top, %g%s; "
                               "expected none above it",
                               -floor->value[0][k], place[0], place[1], 0 - top,
                               blocks->top ? "" : " without a top_surface");
    }
    return true;
}

/* The top, and the sea floor if there is one; how deep into the blocks the body reaches. */
static bool read_surfaces(const struct blocks *blocks)
{
    struct model_source *source = blocks->source;
    struct ground_model *model = source->model;
    if (model->surfaces == 0) return true;
    if (!(blocks->top ? read_surface(blocks, "top_surface", &model->surface[0])
                      : lay_level(blocks, &model->surface[0])))
        return false;
    if (blocks->floor &&
        (!read_surface(blocks, "topography_bathymetry", &model->surface[1]) || !check_floor(blocks)))
        return false;
    double least = 0, ground = 0, top = 0, greatest = 0;
    model_extremes(&model->surface[0], &top, &greatest);
    model_extremes(&model->surface[model->surfaces - 1], &least, &ground);
    const double depth = source->range[2][1], bottom = blocks->bottom;
    const double z = model->sea ? depth : ground + depth * (bottom - ground) / bottom;
    model->depth = MODEL_STRETCHED;
    model->bottom = bottom;
    source->range[2][1] = fmax(depth, (z - top) * bottom / (bottom - top));
    return true;
}

static bool read_all(struct blocks *blocks, hid_t file)
{
    struct model_source *source = blocks->source;
    double from[2], azimuth;
    if (!find_values(blocks, file) || !in_metres(blocks, file) || !find_blocks(blocks)) return false;
    if (!model_numbers(file, "origin_x", 1, &from[0]) || !model_numbers(file, "origin_y", 1, &from[1]) ||
        !model_numbers(file, "y_azimuth", 1, &azimuth) || !model_numbers(file, "dim_z", 1, &blocks->bottom) ||
        !(blocks->bottom > 0))
        return model_fault(source, "origin_x, origin_y, y_azimuth or dim_z (above 0) is missing");
    const struct model_axes axes = {
        .north = 1, .bearing = azimuth, .from = {from[0], from[1]}, .turned = true, .coordinates = 2};
    blocks->top = blocks->group[1] >= 0 && stored_here(blocks->group[1], "top_surface");
    blocks->floor = blocks->group[1] >= 0 && stored_here(blocks->group[1], "topography_bathymetry");
    if (!model_place(source, &axes)) return false;
    source->range[2][1] += source->model->shift;
    if (!model_covers(source, 2, 0, blocks->bottom) ||
        !model_grids(source, blocks->count, blocks->floor ? 2 : (size_t)blocks->top) ||
        !read_surfaces(blocks))
        return false;
    for (size_t i = 0; i < blocks->count; i++)
        if (!read_block(blocks, i)) return false;
    snprintf(source->model->text, sizeof source->model->text,
             "GeoModelGrids file of %zu blocks, y points %.6g degrees from north, bottom %.6g below the sea; "
             "depth 0 "
             "is ",
             blocks->count, azimuth, blocks->bottom);
    model_tell_depth(source->model, blocks->floor ? "its solid ground, depths are stretched above its bottom"
                                                  : "its top, depths are stretched above its bottom");
    return true;
}

bool model_read_blocks(struct model_source *source, hid_t file)
{
    struct blocks *blocks = scene_array(source->builder, 1, sizeof *blocks);
    if (blocks == NULL) return false;
    source->si = true;
    source->none = -1e19;
    source->model->sea = source->model->sea || source->below_sea;
    blocks->source = source;
    blocks->group[0] = H5Gopen2(file, "blocks", H5P_DEFAULT);
    blocks->group[1] = stored_here(file, "surfaces") ? H5Gopen2(file, "surfaces", H5P_DEFAULT) : -1;
    const bool good = read_all(blocks, file);
    for (int i = 0; i < 2; i++)
        if (blocks->group[i] >= 0) H5Gclose(blocks->group[i]);
    array_free(blocks);
    return good;
}
