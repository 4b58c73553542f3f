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

enum { COLUMNS = 8 };

struct text {
    struct model_source *source;
    FILE *file;
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
            model_fault(text->source, "line %zu: %s", text->line, line_fault(found));
            return -1;
        }
        int count = 0;
        line[strcspn(line, "#")] = '\0';
        for (char *at = line; *(at += strspn(at, " \t,\r")) != '\0';) {
            char *end = at;
            const double x = count < COLUMNS ? line_number(at, &end) : 0;
            if (end == at || !isfinite(x)) {
                model_fault(text->source, "line %zu: '%.20s' is not one of at most %d numbers", text->line,
                            at, COLUMNS);
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

/* Keeps a value if the body needs it. */
static void keep(struct text *text, const size_t at[3], const double value[COLUMNS])
{
    struct model_grid *grid = &text->source->model->grid[0];
    size_t index = 0;
    for (int axis = 0; axis < 3; axis++) {
        const bool forth = (text->step[axis] > 0) == (axis < 2);
        const size_t i = forth ? at[axis] : text->n[axis] - 1 - at[axis];
        if (i < text->first[axis] || i - text->first[axis] >= grid->n[axis]) return;
        index = index * grid->n[axis] + i - text->first[axis];
    }
    grid->value[0][index] = held(text, value[5], text->bound + 4);
    grid->value[1][index] = held(text, value[3], text->bound);
    grid->value[2][index] = held(text, value[4], text->bound + 2);
    for (int set = MODEL_VALUES; set < MODEL_SETS && grid->value[set] != NULL; set++)
        grid->value[set][index] = value[3 + set];
}

static bool read_value(struct text *text, const size_t at[3])
{
    double value[COLUMNS];
    const int count = next_numbers(text, value);
    const size_t number = (at[2] * text->n[1] + at[1]) * text->n[0] + at[0];
    if (count < 0) return false;
    if (count == 0)
        return model_fault(text->source, "it ends after %zu of %zu x %zu x %zu values, at line %zu", number,
                           text->n[0], text->n[1], text->n[2], text->line);
    if (number == 0) {
        text->columns = (size_t)count;
        if (!model_room(text->source, &text->source->model->grid[0],
                        model_sets(text->source, count == COLUMNS)))
            return false;
    }
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

bool model_read_text(struct model_source *source, FILE *file)
{
    struct text text = {.source = source, .file = file};
    double more[COLUMNS];
    source->si = source->plainly = true;
    source->model->sea = source->model->sea || source->below_sea;
    if (!read_head(&text) || !lay_grid(&text)) return false;
    for (size_t at[3] = {0}; at[2] < text.n[2]; at[2]++)
        for (at[1] = 0; at[1] < text.n[1]; at[1]++)
            for (at[0] = 0; at[0] < text.n[0]; at[0]++)
                if (!read_value(&text, at)) return false;
    if (next_numbers(&text, more) != 0)
        return model_fault(source, "line %zu: more than %zu x %zu x %zu values", text.line, text.n[0],
                           text.n[1], text.n[2]);
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
