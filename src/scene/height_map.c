/* Heights of the surface from a file: a grid of rows and columns, splines of degree 3 through its values by least
 * squares, one axis after the other (C. de Boor, A Practical Guide to Splines, 1978, chapters XIV and XVII). */
#include "scene/height_map.h"
#include "base/gsl_errors.h"
#include "base/memory.h"
#include "scene/build.h"
#include "scene/height_rows.h"
#include "scene/height_splines.h"

#include <gsl/gsl_sort.h>
#include <math.h>
#include <string.h>

struct height_map {
    int axes;
    struct axis_map along[2];
    double *height;      /* [values of 0][values of 1] */
    double *coefficient; /* [count of 0][count of 1] */
    double most, smoothed;
};

/* Places that occur along an axis, those that rounding parts taken together. */
static bool find_places(const struct height_rows *rows, int axis, struct axis_map *along)
{
    along->place = array_new(rows->count, sizeof *along->place);
    if (along->place == NULL) return false;
    for (size_t i = 0; i < rows->count; i++)
        along->place[i] = rows->row[i][axis];
    gsl_sort(along->place, 1, rows->count);
    const double small = 1e-9 * (along->place[rows->count - 1] - along->place[0]);
    along->values = 0;
    for (size_t i = 0; i < rows->count; i++)
        if (along->values == 0 || along->place[i] > along->place[along->values - 1] + small)
            along->place[along->values++] = along->place[i];
    return true;
}

static size_t nearest(const struct axis_map *along, double x)
{
    size_t low = 0, high = along->values - 1;
    while (high - low > 1) {
        const size_t middle = (low + high) / 2;
        *(along->place[middle] <= x ? &low : &high) = middle;
    }
    return x - along->place[low] < along->place[high] - x ? low : high;
}

/* What would do for points that are no grid. */
static const char advice[] = "(grid loose points first: gmt surface FILE -RWEST/EAST/SOUTH/NORTH -ISTEP "
                             "-Ggrid.nc && gmt grd2xyz grid.nc >heights.txt)";

/* Puts the rows into the grid: each place once. */
static selas_status lay_grid(const char *path, const struct height_rows *rows, double datum,
                             struct height_map *map, struct messages *messages)
{
    const size_t n[2] = {map->along[0].values, map->along[1].values};
    if (n[0] < 2 || (map->axes == 2 && n[1] < 2))
        return fail(messages, SELAS_FILE_ERROR, "%s: %zu x %zu places; expected two at least along each axis",
                    path, n[0], n[1]);
    if (n[0] * n[1] > 4 * rows->count + 4)
        return fail(
            messages, SELAS_FILE_ERROR,
            "%s: %zu heights at %zu places along x and %zu along y, which is no grid; expected each x with "
            "each y %s",
            path, rows->count, n[0], n[1], advice);
    map->height = array_new(n[0] * n[1], sizeof *map->height);
    if (map->height == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for '%s'", path);
    for (size_t i = 0; i < n[0] * n[1]; i++)
        map->height[i] = NAN;
    for (size_t r = 0; r < rows->count; r++) {
        const double *row = rows->row[r];
        double *height =
            &map->height[nearest(&map->along[0], row[0]) * n[1] + nearest(&map->along[1], row[1])];
        if (!isnan(*height))
            return fail(messages, SELAS_FILE_ERROR, "%s: two heights at (%g, %g)", path, row[0], row[1]);
        *height = row[2] - datum;
    }
    for (size_t i = 0; i < n[0] * n[1]; i++) {
        if (isnan(map->height[i]))
            return fail(messages, SELAS_FILE_ERROR,
                        "%s: no height at (%g, %g); expected each x of the file with each y: %zu x %zu %s",
                        path, map->along[0].place[i / n[1]], map->along[1].place[i % n[1]], n[0], n[1],
                        advice);
        map->most = fmax(map->most, fabs(map->height[i]));
    }
    return SELAS_OK;
}

static bool fit_all(struct height_map *map)
{
    const struct axis_map *x = &map->along[0], *y = &map->along[1];
    double *half = array_new(x->count * y->values, sizeof *half);
    map->coefficient = array_new(x->count * y->count, sizeof *map->coefficient);
    const bool good = half != NULL && map->coefficient != NULL &&
                      height_splines_fit(x, y->values, (struct lines_of){map->height, y->values, 1},
                                         (struct lines_of){half, y->values, 1}) &&
                      height_splines_fit(y, x->count, (struct lines_of){half, 1, y->values},
                                         (struct lines_of){map->coefficient, 1, y->count});
    array_free(half);
    for (size_t i = 0; good && i < x->values * y->values; i++) {
        const double place[2] = {x->place[i / y->values], y->place[i % y->values]};
        map->smoothed = fmax(map->smoothed, fabs(height_map_at(map, place) - map->height[i]));
    }
    return good;
}

/* Splines through rows of a grid; `path`: what they are from. */
static struct height_map *map_of(const struct height_rows *rows, const char *path, int axes, double datum,
                                 double piece, struct messages *messages)
{
    struct height_map *map = array_new(1, sizeof *map);
    selas_status status = map != NULL ? SELAS_OK : SELAS_NO_MEMORY;
    if (status == SELAS_OK) {
        map->axes = axes;
        const bool found = find_places(rows, 0, &map->along[0]) && find_places(rows, 1, &map->along[1]);
        status = found ? lay_grid(path, rows, datum, map, messages) : SELAS_NO_MEMORY;
    }
    if (status == SELAS_OK) {
        gsl_errors_returned();
        const bool laid =
            height_splines_lay(&map->along[0], piece) && height_splines_lay(&map->along[1], piece);
        if (!laid || !fit_all(map)) status = fail(messages, SELAS_NO_MEMORY, "no memory for '%s'", path);
        gsl_errors_as_before();
    }
    if (status == SELAS_OK) return map;
    height_map_free(map);
    return NULL;
}

struct height_map *height_map_read(const char *path, int axes, double datum, double piece,
                                   struct messages *messages)
{
    struct height_rows rows = {0};
    struct height_map *map = NULL;
    const selas_status status = height_rows_read(path, axes, &rows, messages);
    if (status == SELAS_OK && rows.count == 0)
        fail(messages, SELAS_FILE_ERROR, "%s: no heights", path);
    else if (status == SELAS_OK)
        map = map_of(&rows, path, axes, datum, piece, messages);
    array_free(rows.row);
    return map;
}

struct height_map *height_map_sample(double (*height)(const struct ground_model *of, const double place[2]),
                                     const struct ground_model *of, const double low[2], const double high[2],
                                     double step, double piece, struct messages *messages)
{
    struct height_rows rows = {0};
    size_t n[2];
    bool room = true;
    for (int axis = 0; axis < 2; axis++)
        n[axis] = (size_t)fmax(ceil((high[axis] - low[axis]) / step), 1) + 1;
    for (size_t i = 0; i < n[0] * n[1] && room; i++) {
        const size_t row = i / n[1], column = i % n[1];
        const double x = low[0] + (high[0] - low[0]) * (double)row / (double)(n[0] - 1);
        const double y = low[1] + (high[1] - low[1]) * (double)column / (double)(n[1] - 1);
        room = height_rows_keep(&rows, (double[]){x, y, height(of, (double[]){x, y})}, 2);
    }
    struct height_map *map = NULL;
    if (room)
        map = map_of(&rows, "the ground of the model", 2, 0, piece, messages);
    else
        fail(messages, SELAS_NO_MEMORY, "no memory for the ground of the model");
    array_free(rows.row);
    return map;
}

void height_map_free(struct height_map *map)
{
    if (map == NULL) return;
    for (int axis = 0; axis < 2; axis++) {
        array_free(map->along[axis].place);
        array_free(map->along[axis].knot);
        array_free(map->along[axis].piece_of);
    }
    array_free(map->height);
    array_free(map->coefficient);
    array_free(map);
}

double height_map_at(const struct height_map *map, const double place[2])
{
    const struct axis_map *x = &map->along[0], *y = &map->along[1];
    double along[2][HEIGHT_ORDER];
    size_t first[2];
    const size_t rows = height_splines_at(x, place[0], along[0], &first[0]),
                 columns = height_splines_at(y, place[1], along[1], &first[1]);
    double sum = 0;
    for (size_t i = 0; i < rows; i++)
        for (size_t j = 0; j < columns; j++)
            sum += along[0][i] * along[1][j] * map->coefficient[(first[0] + i) * y->count + first[1] + j];
    return sum;
}

void height_map_extent(const struct height_map *map, int axis, double *low, double *high)
{
    *low = map->along[axis].place[0];
    *high = map->along[axis].place[map->along[axis].values - 1];
}

double height_map_most(const struct height_map *map)
{
    return map->most;
}

double height_map_smoothed(const struct height_map *map)
{
    return map->smoothed;
}

double height_map_smoothed_in(const struct height_map *map, const double low[2], const double high[2])
{
    const struct axis_map *x = &map->along[0], *y = &map->along[1];
    double most = 0;
    for (size_t i = 0; i < x->values * y->values; i++) {
        const double place[2] = {x->place[i / y->values], y->place[i % y->values]};
        if (place[0] < low[0] || place[0] > high[0]) continue;
        if (map->axes > 1 && (place[1] < low[1] || place[1] > high[1])) continue;
        most = fmax(most, fabs(height_map_at(map, place) - map->height[i]));
    }
    return most;
}

double height_map_centre(struct height_map *map)
{
    const size_t values = map->along[0].values * map->along[1].values;
    double mean = 0;
    for (size_t i = 0; i < values; i++)
        mean += map->height[i] / (double)values;
    map->most = 0;
    for (size_t i = 0; i < values; i++) {
        map->height[i] -= mean;
        map->most = fmax(map->most, fabs(map->height[i]));
    }
    for (size_t i = 0; i < map->along[0].count * map->along[1].count; i++)
        map->coefficient[i] -= mean; /* splines add up to 1 */
    return mean;
}

void complain_of_heights(struct builder *builder, const struct deck_group *group, const char *word,
                         const struct messages *said)
{
    const char *text = said->text != NULL ? said->text : "";
    if (strncmp(text, "error: ", 7) == 0) text += 7;
    complain(builder, group, word, "the heights cannot be used: %.*s", (int)strcspn(text, "\n"), text);
}

void height_map_cover(const struct height_map *map, struct builder *builder, const struct deck_group *group,
                      int axes)
{
    const struct body *body = &builder->scene->body;
    const double small = 1e-6 * body->spacing;
    for (int axis = 0; axis < axes; axis++) {
        double low, high;
        height_map_extent(map, axis, &low, &high);
        if (low > body->low[axis] + small || high < body->high[axis] - small)
            complain(builder, group, "file",
                     "the heights reach from %g to %g along %c, the body from %g to %g; a file that reaches "
                     "as far, or body%%low and high within it, would be right",
                     low, high, "xy"[axis], body -> low[axis], body -> high[axis]);
        double most = 0;
        for (size_t i = 0; i + 1 < map->along[axis].values; i++)
            most = fmax(most, map->along[axis].place[i + 1] - map->along[axis].place[i]);
        if (map->along[axis].gaps)
            deck_warning(builder->deck, group, "file", builder->messages,
                         "the heights have gaps along %c, of up to %.4g: splines go across, wherever the "
                         "ground is; heights at even distances would be right",
                         "xy"[axis], most);
    }
}
