/* The surface of the ground from the deck (&topography), and places that are told by their depth below it. */
#include "base/memory.h"
#include "scene/build.h"
#include "scene/ground.h"
#include "scene/resolution.h"
#include "scene/topography.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Pieces of the splines through a file's heights, and the strip before absorbing layers over which the surface is
 * made level, in spacings. */
static const double piece = 2, strip = 8;
/* The lattice of a half-space whose box the program chooses is level below so many times the largest height. */
static const double chosen_depth = 6;
/* Vertical spacings over the body's; slopes in degrees. */
static const double least_stretch = .4, most_stretch = 1.8, steep = 45, steepest = 60;

static void take_map(struct builder *builder, const struct deck_group *group, const char *word,
                     struct topography *topography, struct height_map *map, const struct messages *said)
{
    topography->map = map;
    if (map == NULL) complain_of_heights(builder, group, word, said);
}

/* The ground of the model, which is read below the sea. */
static void read_model_ground(struct builder *builder, const struct deck_group *group,
                              struct topography *topography)
{
    static const char *const other_words[] = {"height", "centre", "width", "azimuth", "datum", NULL};
    const struct body *body = &builder->scene->body;
    struct messages said = {0};
    refuse(builder, group, other_words, "the ground of the model");
    if (body->model == NULL || (builder->body_known && body->model->surfaces == 0))
        complain(builder, group, "shape",
                 "expected a &model with a surface of its own: rfile, sfile or GeoModelGrids");
    else if (builder->body_known)
        take_map(builder, group, "shape", topography,
                 height_map_sample(ground_model_height, body->model, body->low, body->high,
                                   fmin(body->spacing, ground_model_step(body->model)), piece * body->spacing,
                                   &said),
                 &said);
    messages_free(&said);
}

static void read_shape(struct builder *builder, const struct deck_group *group, struct topography *topography)
{
    static const char *const file_words[] = {"datum", NULL};
    static const char *const ridge_words[] = {"azimuth", NULL};
    const double degree = atan(1) / 45;
    if (!deck_given(group, "shape")) {
        complain(builder, group, NULL, "topography needs shape or file");
        return;
    }
    topography->shape = (enum topography_shape)deck_choice(group, "shape", 0);
    if (topography->shape == TOPOGRAPHY_MODEL) {
        read_model_ground(builder, group, topography);
        return;
    }
    refuse(builder, group, file_words, "a shape of topography");
    if (topography->shape == TOPOGRAPHY_GAUSSIAN || builder->scene->dimension == 2)
        refuse(builder, group, ridge_words, "what is round, or to two dimensions");
    const double azimuth = deck_real(group, "azimuth", 0) * degree;
    topography->across[0] = builder->scene->dimension == 2 ? 1 : -sin(azimuth);
    topography->across[1] = builder->scene->dimension == 2 ? 0 : cos(azimuth);
    need_real(builder, group, "height", "a shape of topography", &topography->height);
    need_real(builder, group, "width", "a shape of topography", &topography->width);
    const size_t count = deck_values(group, "centre"), wanted = (size_t)topography->axis;
    if (count != wanted)
        complain(builder, group, count == 0 ? NULL : "centre",
                 "the centre of a topography has %zu value%s; expected %zu: %s", count, count == 1 ? "" : "s",
                 wanted, wanted == 1 ? "x" : "x, y");
    for (size_t i = 0; i < count && i < wanted; i++)
        topography->centre[i] = deck_real(group, "centre", i);
}

static void read_file(struct builder *builder, const struct deck_group *group, struct topography *topography)
{
    static const char *const shape_words[] = {"shape", "height", "centre", "width", "azimuth", NULL};
    struct messages said = {0};
    refuse(builder, group, shape_words, "topography from a file");
    char *path = deck_path(builder, deck_text(group, "file", 0));
    if (path == NULL) return;
    take_map(builder, group, "file", topography,
             height_map_read(path, topography->axis, deck_real(group, "datum", 0),
                             piece * builder->scene->body.spacing, &said),
             &said);
    messages_free(&said);
    array_free(path);
}

static double largest_height(const struct topography *topography)
{
    return topography->map != NULL ? height_map_most(topography->map) : fabs(topography->height);
}

/* The depth below which the lattice is level: the deck's, else the body's own, else some heights; two cells or a
 * multiple of it, so that the map is a spline of the lattice. */
static double take_depth(struct builder *builder, const struct deck_group *group,
                         const struct topography *topography)
{
    const struct body *body = &builder->scene->body;
    const double pair = 2 * body->spacing, deep = body->high[topography->axis] - body->low[topography->axis];
    const bool known = builder->body_known && !body->chosen;
    double depth = known ? floor(deep / pair + 1e-6) * pair
                         : ceil(chosen_depth * largest_height(topography) / pair - 1e-6) * pair;
    if (deck_given(group, "depth")) depth = fmax(1, round(deck_real(group, "depth", 0) / pair)) * pair;
    if (builder->body_known && depth > deep * (1 + 1e-9))
        complain(builder, group, deck_given(group, "depth") ? "depth" : NULL,
                 "the lattice would be level below a depth of %g, the body ends at %g", depth, deep);
    return fmax(depth, pair);
}

void topography_draw_out(struct scene *scene)
{
    struct topography *topography = scene->body.topography;
    for (int face = 0; topography != NULL && face < 2 * topography->axis; face++) {
        struct drawn_out *end = &topography->end[face / 2][face % 2];
        *end = (struct drawn_out){0, 0};
        if (!boundary_has_layer(&scene->boundary[face])) continue;
        const double length = scene->body.high[face / 2] - scene->body.low[face / 2];
        end->width = fmin(strip * scene->body.spacing, length / 4);
        end->from = face_plane(&scene->body, (enum face)face) - face_sign((enum face)face) * end->width;
    }
}

double topography_changed(const struct topography *topography, double spacing, const double low[2],
                          const double high[2])
{
    enum { MOST = 300 };
    if (topography->shape == TOPOGRAPHY_MODEL && topography->map == NULL) return 0; /* not known yet */
    struct topography plain = *topography;
    memset(plain.end, 0, sizeof plain.end);
    double changed = 0;
    size_t count[2] = {1, 1};
    for (int axis = 0; axis < topography->axis; axis++)
        count[axis] = (size_t)fmin((high[axis] - low[axis]) / spacing + 2, MOST);
    for (size_t i = count[0] * count[1]; i-- > 0;) {
        const size_t at[2] = {i % count[0], i / count[0]};
        double place[2] = {0, 0};
        for (int axis = 0; axis < 2 && axis < topography->axis; axis++)
            place[axis] = low[axis] + (high[axis] - low[axis]) * (double)at[axis] / (double)(count[axis] - 1);
        if (topography_drawn(topography, place))
            changed =
                fmax(changed, fabs(topography_drop(topography, place) - topography_drop(&plain, place)));
    }
    return changed > 1e-9 * spacing ? changed : 0;
}

double topography_levelled(const struct scene *scene, double changed)
{
    const double wavelength = points_per_wavelength(scene) * scene->body.spacing;
    return wavelength > 0 ? changed / wavelength : 0;
}

struct range {
    double low, high, slope;
};

/* Over the points of the surface. */
static struct range range_of(const struct body *body)
{
    const struct topography *topography = body->topography;
    struct range range = {INFINITY, -INFINITY, 0};
    size_t count[2] = {1, 1};
    for (int axis = 0; axis < topography->axis; axis++)
        count[axis] = (size_t)((body->high[axis] - body->low[axis]) / body->spacing + 1.5);
    for (size_t i = 0; i < count[0] * count[1]; i++) {
        const size_t column = i % count[0], row = i / count[0];
        const double place[2] = {body->low[0] + (double)column * body->spacing,
                                 body->low[1] + (double)row * body->spacing};
        const double drop = topography_drop(topography, place);
        double square = 0;
        range.low = fmin(range.low, drop);
        range.high = fmax(range.high, drop);
        for (int axis = 0; axis < 2 && axis < topography->axis; axis++) {
            const double half = body->spacing / 4;
            double beside[2][2] = {{place[0], place[1]}, {place[0], place[1]}};
            beside[0][axis] -= half;
            beside[1][axis] += half;
            const double rise =
                (topography_drop(topography, beside[1]) - topography_drop(topography, beside[0])) /
                (2 * half);
            square += rise * rise;
        }
        range.slope = fmax(range.slope, sqrt(square));
    }
    return range;
}

/* Heights less than a millionth of the spacing are none. */
static double height(double drop, double spacing)
{
    return fabs(drop) < 1e-6 * spacing ? 0 : -drop;
}

static void tell(const struct builder *builder, struct topography *topography, const struct range *range)
{
    const double h = builder->scene->body.spacing, stretch = 4 / 3. / topography->depth;
    const size_t size = sizeof topography->text[0];
    snprintf(topography->text[0], size, "heights %.4g to %.4g above face %s, steepest slope %.3g degrees",
             height(range->high, h), height(range->low, h), topography->axis == 2 ? "z-" : "y-",
             atan(range->slope) * 45 / atan(1));
    snprintf(topography->text[1], size,
             "vertical spacing %.4g to %.4g, level below a depth of %.4g; along the steepest slope %.4g",
             h * fmin(1, 1 - stretch * range->high), h * fmax(1, 1 - stretch * range->low), topography->depth,
             h * hypot(1, range->slope));
    if (topography->map != NULL)
        snprintf(topography->text[2], size, "splines differ from the %s's heights by up to %.3g",
                 topography->shape == TOPOGRAPHY_MODEL ? "model" : "file",
                 height_map_smoothed(topography->map));
    if (topography->end[0][0].width + topography->end[0][1].width + topography->end[1][0].width +
            topography->end[1][1].width >
        0)
        snprintf(
            topography->text[3], size,
            "level across faces with absorbing layers: drawn out over %g points before them, heights changed "
            "by up to %.3g",
            strip, topography->changed);
}

static void check_range(struct builder *builder, const struct deck_group *group,
                        const struct topography *topography, const struct range *range)
{
    const double degrees = atan(range->slope) * 45 / atan(1), stretch = 4 / 3. / topography->depth;
    if (1 - stretch * range->high < least_stretch || 1 - stretch * range->low > most_stretch)
        complain(builder, group, deck_given(group, "depth") ? "depth" : NULL,
                 "the lattice below the surface would be pressed to %.3g or stretched to %.3g of its "
                 "spacing, between "
                 "heights of %g and %g and a level depth of %g; expected %g to %g: a deeper body, or heights "
                 "nearer "
                 "to face z- (datum; of a model the third value of origin)",
                 1 - stretch * range->high, 1 - stretch * range->low, -range->high, -range->low,
                 topography->depth, least_stretch, most_stretch);
    if (degrees > steepest)
        complain(builder, group, NULL, "the surface is as steep as %.3g degrees; expected %g at most",
                 degrees, steepest);
    else if (degrees > steep)
        deck_warning(
            builder->deck, group, NULL, builder->messages,
            "the surface is as steep as %.3g degrees, beyond the %g that errors were measured at; points "
            "along it are %.3g spacings apart",
            degrees, steep, hypot(1, range->slope));
}

/* What cannot stand on a surface that is not level. */
static bool check_body(struct builder *builder, const struct deck_group *group)
{
    const struct scene *scene = builder->scene;
    const int top = 2 * scene->dimension - 2;
    if (scene->dimension == 1 || !body_is_box(&scene->body) || scene->body.rotated || scene->body.jitter > 0)
        complain(builder, group, NULL,
                 "topography needs two or three dimensions and a body of shape 'box' or 'half-space', not "
                 "turned and "
                 "without jitter");
    else if (!boundary_is_free(&scene->boundary[top]))
        complain(builder, group, NULL,
                 "topography is that of a free surface; expected no &boundary at face %s",
                 face_name((enum face)top));
    else
        return true;
    return false;
}

/* A model without a ground of its own that begins below the top of the hill. */
static void warn_of_low_model(struct builder *builder, const struct deck_group *group,
                              const struct range *range)
{
    const struct ground_model *model = builder->scene->body.model;
    if (model == NULL || model->surfaces > 0 || model->grids == 0 || model->grid[0].at[2] == NULL) return;
    const double top = model->grid[0].at[2][0] - model->shift;
    if (top <= range->low + 1e-6 * builder->scene->body.spacing) return;
    deck_warning(
        builder->deck, group, NULL, builder->messages,
        "the model of the ground begins %.4g below face z-; above that, up to %.4g above the face, its "
        "topmost rock goes on",
        top, -range->low);
}

void build_topography(struct builder *builder)
{
    struct scene *scene = builder->scene;
    if (deck_count(builder->deck, "topography") == 0 || !(scene->body.spacing > 0)) return;
    const struct deck_group *group = deck_get(builder->deck, "topography", 0);
    const selas_status before = builder->status;
    if (!check_body(builder, group)) return;
    struct topography *topography = scene_array(builder, 1, sizeof *topography);
    if (topography == NULL) return;
    scene->body.topography = topography;
    topography->axis = scene->dimension - 1;
    topography->plane = scene->body.low[topography->axis];
    topography->depth = 1;
    if (deck_given(group, "file"))
        read_file(builder, group, topography);
    else
        read_shape(builder, group, topography);
    if (builder->status != before || before != SELAS_OK) { /* a surface that is only half known is none */
        topography_free(topography);
        scene->body.topography = NULL;
        return;
    }
    topography->depth = take_depth(builder, group, topography);
    if (!builder->body_known) return;
    if (deck_given(group, "file")) height_map_cover(topography->map, builder, group, topography->axis);
    topography_draw_out(scene);
    const struct body *body = &scene->body;
    topography->changed =
        topography_changed(topography, body->spacing, body->chosen ? body->waves_low : body->low,
                           body->chosen ? body->waves_high : body->high);
    const struct range range = range_of(body);
    topography->top = range.low;
    tell(builder, topography, &range);
    check_range(builder, group, topography, &range);
    warn_of_low_model(builder, group, &range);
}

bool need_place(struct builder *builder, const struct deck_group *group, const char *name,
                const char *purpose, double place[3])
{
    const struct body *body = &builder->scene->body;
    const int down = builder->scene->dimension - 1;
    if (!deck_given(group, "depth")) return need_vector(builder, group, name, purpose, place);
    const size_t count = deck_values(group, name);
    if (down == 0 || count != (size_t)down || body->rotated || !body_is_box(body)) {
        complain(
            builder, group, "depth",
            "depth stands in place of the last of the %d values of %s, in a box or half-space that is not "
            "turned",
            down + 1, name);
        return false;
    }
    for (int c = 0; c < 3; c++)
        place[c] = c < down ? deck_real(group, name, (size_t)c) : 0;
    const double drop = body->topography != NULL ? topography_drop(body->topography, place) : 0;
    place[down] = body->low[down] + drop + deck_real(group, "depth", 0);
    return true;
}
