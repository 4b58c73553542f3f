/* Moving patches: the load vector F_i(t) = f(t) * integral of N_i over the patch at centre + velocity t, a
 * product of one line per axis (the integrals are exact, whatever the place of the patch between the points).
 * With the H-form M^-1 is a product over the axes too, so each line gets its own factor (manual,
 * doc/theory/sources.md, Eqs 6, 7). A few hundred multiplications per step and patch. */
#include "method/consistent/galerkin/moving_load.h"

#include "base/memory.h"
#include "method/consistent/galerkin/hform.h"

#include <math.h>
#include <string.h>

static selas_status create(struct consistent *c, size_t index, struct moving_load *moving,
                           struct messages *messages)
{
    const struct scene *scene = c->model.scene;
    const struct load *load = &scene->load[index];
    size_t longest = 1;
    if (load->shape == LOAD_DISC)
        return fail(messages, SELAS_UNSUPPORTED,
                    "load %zu: a disc cannot move with the consistent method; take shape = 'square'",
                    index + 1);
    moving->load = index;
    body_from_deck(&scene->body, load->centre, moving->centre);
    body_direction_from_deck(&scene->body, load->direction, moving->direction);
    body_direction_from_deck(&scene->body, load->velocity, moving->velocity);
    for (int axis = 0, edge = 0; axis < c->dimension; axis++) {
        if (c->spline[axis]->count > longest) longest = c->spline[axis]->count;
        if (axis != face_axis(load->face) && load->shape == LOAD_SQUARE)
            moving->half[axis] = load->size[edge++] / 2;
    }
    moving->work = array_new(longest, sizeof *moving->work);
    bool good = moving->work != NULL;
    for (int component = 0; component < c->dimension; component++)
        for (int axis = 0; axis < c->dimension; axis++) {
            struct moving_line *line = &moving->line[component][axis];
            line->value = array_new(c->spline[axis]->count, sizeof *line->value);
            good = good && line->value != NULL;
        }
    return good ? SELAS_OK : fail(messages, SELAS_NO_MEMORY, "no memory for a moving load");
}

selas_status moving_loads_create(struct consistent *c, struct messages *messages)
{
    const struct scene *scene = c->model.scene;
    c->moving_load = array_new(scene->loads, sizeof *c->moving_load);
    if (c->moving_load == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for moving loads");
    selas_status status = SELAS_OK;
    for (size_t l = 0; l < scene->loads && status == SELAS_OK; l++)
        if (load_moves(&scene->load[l])) status = create(c, l, &c->moving_load[c->moving_loads++], messages);
    return status;
}

void moving_loads_free(struct consistent *c)
{
    for (size_t l = 0; l < c->moving_loads; l++) {
        array_free(c->moving_load[l].work);
        for (int i = 0; i < 9; i++)
            array_free(c->moving_load[l].line[i / 3][i % 3].value);
    }
    array_free(c->moving_load);
}

/* Range of the entries that are not 0. */
static void find_range(size_t count, struct moving_line *line)
{
    line->from = 0;
    line->to = count;
    while (line->from < line->to && line->value[line->from] == 0)
        line->from++;
    while (line->to > line->from && line->value[line->to - 1] == 0)
        line->to--;
}

static void place_line(const struct consistent *c, struct moving_load *moving, int component, int axis,
                       double time, struct moving_line *line)
{
    const struct spline *spline = c->spline[axis];
    const struct load *load = &c->model.scene->load[moving->load];
    const bool odd = axis == component;
    const double x = moving->centre[axis] + moving->velocity[axis] * time, half = moving->half[axis];
    const double small = 1e-12 * (spline->high - spline->low);
    if (axis == face_axis(load->face))
        consistent_point_line(c, axis, odd, false, false,
                              load->face % 2 == 0 ? c->model.scene->body.low[axis]
                                                  : c->model.scene->body.high[axis],
                              line->value);
    else if (half > 0)
        tuned_moments(spline, odd, x - half, x + half, moving->work, line->value);
    else if (x < spline->low - small || x > spline->high + small)
        memset(line->value, 0, spline->count * sizeof *line->value);
    else
        consistent_point_line(c, axis, odd, false, true, fmin(fmax(x, spline->low), spline->high),
                              line->value);
    find_range(spline->count, line);
}

/* line := N line, and over the density where that is the same everywhere. */
static void divide_line(const struct consistent *c, int component, int axis, double *work,
                        struct moving_line *line)
{
    const struct band *inverse = c->hform->inverse[component][axis];
    const size_t count = c->spline[axis]->count, half = inverse != NULL ? inverse->half : 0;
    const bool uniform = c->weighted[WEIGHT_DENSITY] == NULL;
    const double density = axis == 0 && uniform ? c->property[WEIGHT_DENSITY] : 1;
    if (line->from == line->to) return;
    memcpy(work, line->value, count * sizeof *work);
    line->from = line->from < half ? 0 : line->from - half;
    line->to = line->to + half < count ? line->to + half : count;
    for (size_t i = line->from; i < line->to; i++)
        line->value[i] = band_row(inverse, i, work, 1) / density;
}

void moving_loads_place(struct consistent *c, double time, bool divided)
{
    for (size_t l = 0; l < c->moving_loads; l++) {
        struct moving_load *moving = &c->moving_load[l];
        for (int component = 0; component < c->dimension; component++) {
            if (moving->direction[component] == 0) continue;
            for (int axis = 0; axis < c->dimension; axis++) {
                struct moving_line *line = &moving->line[component][axis];
                place_line(c, moving, component, axis, time, line);
                if (divided) divide_line(c, component, axis, moving->work, line);
            }
        }
    }
}

/* The three lines by slot; 1 where there is no axis. */
static void by_slot(const struct consistent *c, const struct moving_load *moving, int component,
                    const struct moving_line *line[3])
{
    static double one = 1;
    static const struct moving_line nothing = {&one, 0, 1};
    line[0] = line[1] = line[2] = &nothing;
    for (int axis = 0; axis < c->dimension; axis++)
        line[c->slot[axis]] = &moving->line[component][axis];
}

void moving_loads_add(const struct consistent *c, const struct drive *drive, int component, size_t k,
                      double *plane)
{
    for (size_t l = 0; drive->load != NULL && l < c->moving_loads; l++) {
        const struct moving_load *moving = &c->moving_load[l];
        const struct moving_line *line[3];
        if (moving->direction[component] == 0) continue;
        by_slot(c, moving, component, line);
        const size_t depth = c->part.along[DEPTH].first + k;
        if (depth < line[2]->from || depth >= line[2]->to) continue;
        const double factor = drive->load[moving->load] * c->model.scene->load[moving->load].amplitude *
                              moving->direction[component] * line[2]->value[depth];
        for (size_t j = 0; factor != 0 && j < c->n[1]; j++) {
            const size_t row = c->part.along[1].first + j;
            if (row < line[1]->from || row >= line[1]->to) continue;
            for (size_t i = line[0]->from; i < line[0]->to; i++)
                plane[j * c->n[0] + i] += factor * line[1]->value[row] * line[0]->value[i];
        }
    }
}

double moving_loads_power(const struct consistent *c, const struct drive *drive, const double *v)
{
    double power = 0;
    for (size_t l = 0; drive->load != NULL && l < c->moving_loads; l++) {
        const struct moving_load *moving = &c->moving_load[l];
        const double amplitude = drive->load[moving->load] * c->model.scene->load[moving->load].amplitude;
        for (int component = 0; component < c->dimension; component++) {
            const struct moving_line *line[3];
            if (moving->direction[component] == 0) continue;
            by_slot(c, moving, component, line);
            const double *field = v + (size_t)component * c->volume;
            for (size_t k = c->part.along[DEPTH].own; k < c->part.along[DEPTH].end; k++) {
                const size_t depth = c->part.along[DEPTH].first + k;
                if (depth < line[2]->from || depth >= line[2]->to) continue;
                for (size_t j = c->part.along[1].own; j < c->part.along[1].end; j++) {
                    const size_t row = c->part.along[1].first + j;
                    if (row < line[1]->from || row >= line[1]->to) continue;
                    for (size_t i = line[0]->from; i < line[0]->to; i++)
                        power += amplitude * moving->direction[component] * line[2]->value[depth] *
                                 line[1]->value[row] * line[0]->value[i] *
                                 field[k * c->plane + j * c->n[0] + i];
                }
            }
        }
    }
    return power;
}
