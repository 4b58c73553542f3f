/* Heights of the surface from a file: a grid of rows and columns, splines of degree 3 through its values by least
 * squares, one axis after the other (C. de Boor, A Practical Guide to Splines, 1978, chapters XIV and XVII). */
#include "scene/height_map.h"
#include "base/gsl_errors.h"
#include "base/memory.h"
#include "scene/build.h"
#include "scene/height_rows.h"

#include <gsl/gsl_linalg.h>

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum { ORDER = 4 }; /* degree and one */
/* Values that a piece has at least. */
static const double values_a_piece = 1.5;

struct axis_map {
    size_t values, order, count; /* of the grid; of the splines: order, coefficients */
    double *place;               /* [values] */
    size_t pieces, parts;        /* of the splines; 0: no such axis; even parts, one or several to a piece */
    double *knot;                /* [pieces + 1] ends of the pieces, in parts */
    size_t *piece_of;            /* [parts] */
    bool gaps;                   /* between the values, beyond what the parts could have */
};

struct height_map {
    int axes;
    struct axis_map along[2];
    double *height;      /* [values of 0][values of 1] */
    double *coefficient; /* [count of 0][count of 1] */
    double most, smoothed;
};

static int ascending(const void *one, const void *other)
{
    const double a = *(const double *)one, b = *(const double *)other;
    return (a > b) - (a < b);
}

/* Places that occur along an axis, those that rounding parts taken together. */
static bool find_places(const struct height_rows *rows, int axis, struct axis_map *along)
{
    along->place = array_new(rows->count, sizeof *along->place);
    if (along->place == NULL) return false;
    for (size_t i = 0; i < rows->count; i++)
        along->place[i] = rows->row[i][axis];
    qsort(along->place, rows->count, sizeof *along->place, ascending);
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

/* Place along an axis in its even parts. */
static double in_parts(const struct axis_map *along, double x)
{
    const double low = along->place[0], high = along->place[along->values - 1];
    return fmin(fmax((x - low) / (high - low), 0), 1) * (double)along->parts;
}

/* Do the values tell all splines on the even parts: each has one of its own well within its support (I. J. Schoenberg,
 * A. Whitney, Trans. Am. Math. Soc. 74 (1953) 246)? */
static bool told(const struct axis_map *along)
{
    static const double within = .05;
    const size_t count = along->parts + along->order - 1;
    size_t next = 1;
    for (size_t i = 1; i + 1 < count; i++, next++) { /* the ends tell the first and the last */
        const double low = i < along->order ? 0 : (double)(i + 1 - along->order),
                     high = fmin((double)i + 1, (double)along->parts);
        while (next < along->values && in_parts(along, along->place[next]) < low + within)
            next++;
        if (next >= along->values || in_parts(along, along->place[next]) > high - within) return false;
    }
    return true;
}

/* Pieces of a part each or, where gaps between the values leave splines untold, of two values at least. */
static void lay_knots(struct axis_map *along)
{
    along->gaps = !told(along);
    size_t next = 0, taken = 0; /* values before the part's end, before the piece */
    for (size_t part = 0; part < along->parts; part++) {
        along->piece_of[part] = along->pieces;
        while (next < along->values && in_parts(along, along->place[next]) < (double)part + 1)
            next++;
        const bool few = along->gaps && (next < taken + 2 || along->values < next + 2);
        if (few && part + 1 < along->parts) continue;
        along->knot[++along->pieces] = (double)part + 1;
        taken = next;
    }
}

/* Splines of an axis whose pieces are no shorter than `piece` nor than so many values. */
static bool lay_splines(struct axis_map *along, double piece)
{
    along->count = 1;
    if (along->values < 2) return true; /* no such axis */
    const double low = along->place[0], high = along->place[along->values - 1];
    along->order = along->values < ORDER ? along->values : ORDER;
    const double most = fmin((high - low) / piece, (double)(along->values - 1) / values_a_piece);
    along->parts = most > 1 ? (size_t)most : 1;
    if (along->parts > along->values - along->order + 1) along->parts = along->values - along->order + 1;
    along->knot = array_new(along->parts + 1, sizeof *along->knot);
    along->piece_of = array_new(along->parts, sizeof *along->piece_of);
    if (along->knot == NULL || along->piece_of == NULL) return false;
    lay_knots(along);
    along->count = along->pieces + along->order - 1;
    return true;
}

/* Values of the splines that are not 0 at x, from *first on; the knots at the ends count as many times as the order
 * (L. Piegl, W. Tiller, The NURBS Book, 1997, A2.2). */
static size_t basis_at(const struct axis_map *along, double x, double basis[ORDER], size_t *first)
{
    basis[0] = 1;
    *first = 0;
    if (along->pieces == 0) return 1;
    const double t = in_parts(along, x);
    const size_t at = along->piece_of[(size_t)fmin(floor(t), (double)along->parts - 1)];
    double left[ORDER], right[ORDER];
    *first = at;
    for (size_t j = 1; j < along->order; j++) {
        left[j] = t - along->knot[at + 1 > j ? at + 1 - j : 0];
        right[j] = along->knot[at + j < along->pieces ? at + j : along->pieces] - t;
        double saved = 0;
        for (size_t r = 0; r < j; r++) {
            const double part = basis[r] / (right[r + 1] + left[j - r]);
            basis[r] = saved + right[r + 1] * part;
            saved = left[j - r] * part;
        }
        basis[j] = saved;
    }
    return along->order;
}

/* Coefficients along an axis: `lines` lines of values, number i of line l at in[l * skip + i * step]; out alike,
 * with steps of its own. */
struct lines_of {
    double *at;
    size_t step, skip;
};

static bool fit(const struct axis_map *along, size_t lines, struct lines_of in, struct lines_of out)
{
    if (along->pieces == 0) {
        for (size_t l = 0; l < lines; l++)
            out.at[l * out.skip] = in.at[l * in.skip];
        return true;
    }
    gsl_matrix *matrix = gsl_matrix_calloc(along->values, along->count);
    gsl_vector *tau = gsl_vector_alloc(along->count), *value = gsl_vector_alloc(along->values);
    gsl_vector *found = gsl_vector_alloc(along->count), *rest = gsl_vector_alloc(along->values);
    bool good = matrix != NULL && tau != NULL && value != NULL && found != NULL && rest != NULL;
    for (size_t i = 0; good && i < along->values; i++) {
        double basis[ORDER];
        size_t first;
        const size_t count = basis_at(along, along->place[i], basis, &first);
        for (size_t n = 0; n < count; n++)
            gsl_matrix_set(matrix, i, first + n, basis[n]);
    }
    good = good && gsl_linalg_QR_decomp(matrix, tau) == 0;
    for (size_t l = 0; good && l < lines; l++) {
        for (size_t i = 0; i < along->values; i++)
            gsl_vector_set(value, i, in.at[l * in.skip + i * in.step]);
        good = gsl_linalg_QR_lssolve(matrix, tau, value, found, rest) == 0;
        for (size_t i = 0; good && i < along->count; i++)
            out.at[l * out.skip + i * out.step] = gsl_vector_get(found, i);
    }
    gsl_matrix_free(matrix);
    gsl_vector_free(tau);
    gsl_vector_free(value);
    gsl_vector_free(found);
    gsl_vector_free(rest);
    return good;
}

static bool fit_all(struct height_map *map)
{
    const struct axis_map *x = &map->along[0], *y = &map->along[1];
    double *half = array_new(x->count * y->values, sizeof *half);
    map->coefficient = array_new(x->count * y->count, sizeof *map->coefficient);
    const bool good = half != NULL && map->coefficient != NULL &&
                      fit(x, y->values, (struct lines_of){map->height, y->values, 1},
                          (struct lines_of){half, y->values, 1}) &&
                      fit(y, x->count, (struct lines_of){half, 1, y->values},
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
        const bool laid = lay_splines(&map->along[0], piece) && lay_splines(&map->along[1], piece);
        gsl_errors_returned();
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
    double along[2][ORDER];
    size_t first[2];
    const size_t rows = basis_at(x, place[0], along[0], &first[0]),
                 columns = basis_at(y, place[1], along[1], &first[1]);
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
                     "the heights reach from %g to %g along %c, the body from %g to %g", low, high,
                     "xy"[axis], body -> low[axis], body -> high[axis]);
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
