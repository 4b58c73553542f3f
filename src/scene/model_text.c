/* SPECFEM's tomography_model.xyz: text, '#' comments; ORIG_X ORIG_Y ORIG_Z END_X END_Y END_Z, the spacings, the
 * numbers of values NX NY NZ, least and greatest p_speed, s_speed and density, to which what lies between the
 * values is held; then a line for each, x y z p_speed s_speed density [q_p q_s], x fastest (SPECFEM3D
 * Cartesian, user manual, "Changing the model", and src/generate_databases/model_tomography.f90). Values are
 * held to their bounds here, and linear between them. */
#include "base/lines.h"
#include "base/memory.h"
#include "scene/model_file.h"

#include <math.h>
#include <string.h>

enum { COLUMNS = 8, APART = 16 };

struct text {
    struct model_source *source; /* NULL: values are read again, and nothing is told */
    FILE *file;
    off_t *mark; /* of a grid in pieces: where every 16th line of each row over x begins; else NULL */
    size_t line, clipped;
    double origin[3], step[3], bound[6]; /* steps may lead back: z upward or downward */
    size_t n[3], first[3];
    size_t columns; /* of the first value */
};

/* Numbers of the next line that has any; 0 at the end of the file, -1 after complaining. */
static int next_numbers(struct text *text, double value[COLUMNS])
{
    char line[LINE_SIZE];
    while (true) {
        const enum line_found found = line_next(text->file, line);
        text->line++;
        if (found == LINE_END) return 0;
        if (found != LINE_READ) {
            if (text->source != NULL)
                model_fault(text->source, "line %zu: %s", text->line, line_fault(found));
            return -1;
        }
        int count = 0;
        line[strcspn(line, "#")] = '\0';
        for (char *at = line; *(at += strspn(at, " \t,\r")) != '\0';) {
            char *end = at;
            const double x = count < COLUMNS ? line_number(at, &end) : 0;
            if (end == at || !isfinite(x)) {
                if (text->source != NULL)
                    model_fault(text->source, "line %zu: '%.20s' is not one of at most %d numbers",
                                text->line, at, COLUMNS);
                return -1;
            }
            value[count++] = x;
            at = end;
        }
        if (count > 0) return count;
    }
}

static bool read_head(struct text *text)
{
    static const struct {
        int count;
        const char *what;
    } expected[] = {{6, "ORIG_X ORIG_Y ORIG_Z END_X END_Y END_Z"},
                    {3, "SPACING_X SPACING_Y SPACING_Z"},
                    {3, "NX NY NZ"},
                    {6, "VP_MIN VP_MAX VS_MIN VS_MAX RHO_MIN RHO_MAX"}};
    double value[4][COLUMNS] = {{0}};
    for (int i = 0; i < 4; i++) {
        const int count = next_numbers(text, value[i]);
        if (count < 0) return false;
        if (count != expected[i].count)
            return model_fault(text->source,
                               "line %zu: expected %s of SPECFEM's tomography_model.xyz (models in other "
                               "formats are HDF5 or binary)",
                               text->line, expected[i].what);
    }
    for (int axis = 0; axis < 3; axis++) {
        const double origin = value[0][axis], step = value[1][axis], n = value[2][axis];
        if (!(n >= 2) || n > 1e6 || n != floor(n) || step == 0)
            return model_fault(text->source,
                               "%g values along %c, %g apart; expected at least 2, "
                               "at different places",
                               n, "xyz"[axis], step);
        if (fabs(origin + step * (n - 1) - value[0][3 + axis]) > 1e-3 * fabs(step))
            return model_fault(text->source, "%g values along %c, %g apart, lead from %g to %g, END_%c is %g",
                               n, "xyz"[axis], step, origin, origin + step * (n - 1), "XYZ"[axis],
                               value[0][3 + axis]);
        text->origin[axis] = origin;
        text->step[axis] = step;
        text->n[axis] = (size_t)n;
    }
    memcpy(text->bound, value[3], sizeof text->bound);
    return true;
}

/* Places along the axes; the third one of the grid goes downward. */
static bool lay_grid(struct text *text)
{
    struct model_source *source = text->source;
    struct ground_model *model = source->model;
    struct model_axes axes = {.north = 1, .coordinates = 3};
    for (int axis = 0; axis < 2; axis++)
        axes.corner[axis] = text->origin[axis] + fmin(text->step[axis] * (double)(text->n[axis] - 1), 0);
    if (!model_grids(source, 1, 0) || !model_place(source, &axes)) return false;
    if (!model->sea) model->shift = -model->shift; /* from an elevation */
    source->range[2][0] += model->shift;
    source->range[2][1] += model->shift;
    for (int axis = 0; axis < 3; axis++) {
        const double way = text->step[axis] * (double)(text->n[axis] - 1), length = fabs(way);
        const double low = text->origin[axis] + fmin(way, 0), from = axis < 2 ? low : -low - length;
        if (!model_even_part(source, &model->grid[0], axis, from, fabs(text->step[axis]), text->n[axis],
                             &text->first[axis]) ||
            !model_covers(source, axis, from, from + length))
            return false;
    }
    return true;
}

static double held(struct text *text, double value, const double bound[2])
{
    const double inside = fmin(fmax(value, bound[0]), bound[1]);
    if (fabs(inside - value) > 1e-3 * fabs(value)) text->clipped++;
    return inside;
}

/* The index in the file of what has index `at` along an axis of the model, or the other way round. */
static size_t turned(const struct text *text, int axis, size_t at)
{
    const bool forth = (text->step[axis] > 0) == (axis < 2);
    return forth ? at : text->n[axis] - 1 - at;
}

/* The first mark of the row over x of a value. */
static off_t *marks_of(const struct text *text, const size_t at[3])
{
    return text->mark + (at[2] * text->n[1] + at[1]) * ((text->n[0] + APART - 1) / APART);
}

static void put(struct text *text, const struct model_grid *grid, size_t index, const double value[COLUMNS])
{
    grid->value[0][index] = held(text, value[5], text->bound + 4);
    grid->value[1][index] = held(text, value[3], text->bound);
    grid->value[2][index] = held(text, value[4], text->bound + 2);
    for (int set = MODEL_VALUES; set < MODEL_SETS && grid->value[set] != NULL; set++)
        grid->value[set][index] = value[3 + set];
}

/* Keeps a value if the body needs it, and all are kept. */
static void keep(struct text *text, const size_t at[3], const double value[COLUMNS])
{
    const struct model_grid *grid = &text->source->model->grid[0];
    size_t index = 0;
    for (int axis = 0; axis < 3; axis++) {
        const size_t i = turned(text, axis, at[axis]);
        if (i < text->first[axis] || i - text->first[axis] >= grid->n[axis]) return;
        index = index * grid->n[axis] + i - text->first[axis];
    }
    double counted[6]; /* of what is beyond the bounds, too */
    const struct model_grid one = {.value = {counted, counted + 1, counted + 2}};
    if (text->mark == NULL)
        put(text, grid, index, value);
    else
        put(text, &one, 0, value);
}

/* --- Values that are read again --- */

/* Reads those of a row over x that a box has: `row` is the first one's index along the model's own axes. */
static bool read_row(struct text *text, const struct model_grid *box, const size_t row[3], size_t index)
{
    const size_t last = box->n[0] - 1, one = turned(text, 0, row[0]), other = turned(text, 0, row[0] + last);
    const size_t from = one < other ? one : other;
    const size_t at[3] = {from, turned(text, 1, row[1]), turned(text, 2, row[2])};
    double value[COLUMNS];
    if (fseeko(text->file, marks_of(text, at)[from / APART], SEEK_SET) != 0) return false;
    for (size_t i = from / APART * APART; i < from; i++)
        if (next_numbers(text, value) != (int)text->columns) return false;
    for (size_t i = 0; i <= last; i++) {
        if (next_numbers(text, value) != (int)text->columns) return false;
        put(text, box, (one <= other ? i : last - i) * box->n[1] * box->n[2] + index, value);
    }
    return true;
}

static bool read_rows(void *context, const struct model_grid *box, const size_t first[3])
{
    struct text *text = context;
    for (size_t k = 0; k < box->n[2]; k++)
        for (size_t j = 0; j < box->n[1]; j++) {
            const size_t row[3] = {text->first[0] + first[0], text->first[1] + first[1] + j,
                                   text->first[2] + first[2] + k};
            if (!read_row(text, box, row, j * box->n[2] + k)) return false;
        }
    if (box->value[MODEL_VALUES] != NULL) model_no_quality(box);
    return true;
}

static void close_text(void *context)
{
    struct text *text = context;
    if (text->file != NULL) fclose(text->file);
    array_free(text->mark);
    array_free(text);
}

/* Gives the grid pieces, which own the marks. */
static bool read_later(struct text *text)
{
    struct model_source *source = text->source;
    struct text *again = scene_array(source->builder, 1, sizeof *again);
    if (again == NULL) return false;
    *again = *text;
    again->source = NULL;
    again->file = fopen(source->path, "rb");
    const struct model_origin origin = {read_rows, close_text, again,
                                        source->model->damped ? MODEL_SETS : MODEL_VALUES, NULL};
    text->mark = NULL;
    if (again->file != NULL && model_pieces_new(&source->model->grid[0], &origin)) return true;
    if (again->file != NULL) complain_of_memory(source->builder);
    close_text(again);
    return model_unread(source);
}

/* For the values, or for the marks of those that are read again. */
static bool find_room(struct text *text)
{
    struct model_source *source = text->source;
    struct model_grid *grid = &source->model->grid[0];
    if (!model_room(source, grid, model_sets(source, text->columns == COLUMNS))) return false;
    if (grid->value[0] != NULL) return true;
    const size_t row = (text->n[0] + APART - 1) / APART;
    text->mark = scene_array(source->builder, row * text->n[1] * text->n[2], sizeof *text->mark);
    return text->mark != NULL;
}

static bool read_value(struct text *text, const size_t at[3])
{
    double value[COLUMNS];
    const off_t here = at[0] % APART == 0 ? ftello(text->file) : 0;
    const int count = next_numbers(text, value);
    const size_t number = (at[2] * text->n[1] + at[1]) * text->n[0] + at[0];
    if (count < 0) return false;
    if (count == 0)
        return model_fault(text->source, "it ends after %zu of %zu x %zu x %zu values, at line %zu", number,
                           text->n[0], text->n[1], text->n[2], text->line);
    if (number == 0) {
        text->columns = (size_t)count;
        if (!find_room(text)) return false;
    }
    if (text->mark != NULL && at[0] % APART == 0) marks_of(text, at)[at[0] / APART] = here;
    if ((count != 6 && count != 8) || (size_t)count != text->columns)
        return model_fault(text->source,
                           "line %zu: %d numbers; expected x y z p_speed s_speed density, or q_p q_s behind "
                           "them on every line",
                           text->line, count);
    for (int axis = 0; axis < 3; axis++) {
        const double expected = text->origin[axis] + (double)at[axis] * text->step[axis];
        if (fabs(value[axis] - expected) > 1e-3 * fabs(text->step[axis]))
            return model_fault(text->source,
                               "line %zu: value %zu lies at %c = %.9g; expected %.9g (even rows, x fastest, "
                               "then y, then z)",
                               text->line, number + 1, "xyz"[axis], value[axis], expected);
    }
    if (!(value[3] > 0) || !(value[4] > 0) || !(value[5] > 0))
        return model_fault(text->source,
                           "line %zu: p_speed %g, s_speed %g, density %g; expected speeds and "
                           "a density above 0",
                           text->line, value[3], value[4], value[5]);
    keep(text, at, value);
    return true;
}

static bool read_values(struct text *text)
{
    double more[COLUMNS];
    for (size_t at[3] = {0}; at[2] < text->n[2]; at[2]++)
        for (at[1] = 0; at[1] < text->n[1]; at[1]++)
            for (at[0] = 0; at[0] < text->n[0]; at[0]++)
                if (!read_value(text, at)) return false;
    if (next_numbers(text, more) == 0) return text->mark == NULL || read_later(text);
    return model_fault(text->source, "line %zu: more than %zu x %zu x %zu values", text->line, text->n[0],
                       text->n[1], text->n[2]);
}

bool model_read_text(struct model_source *source, FILE *file)
{
    struct text text = {.source = source, .file = file};
    source->si = true;
    source->model->sea = source->model->sea || source->below_sea;
    const bool good = read_head(&text) && lay_grid(&text) && read_values(&text);
    array_free(text.mark);
    if (!good) return false;
    if (text.clipped > 0)
        warn(source->builder->messages,
             "'%s': %zu numbers lie beyond the bounds of its fourth line and are held to them, as the format "
             "says",
             source->path, text.clipped);
    snprintf(source->model->text, sizeof source->model->text,
             "tomography_model.xyz of %zu x %zu x %zu, depth 0 is its elevation %g", text.n[0], text.n[1],
             text.n[2], 0 - source->model->shift);
    return true;
}
