/* Sections through snapshots. A lattice gives its planes of points, loose points those near a plane. */
#include "record/plots/section.h"

#include "base/memory.h"
#include "scene/ground.h"
#include "scene/topography.h"

#include <gsl/gsl_sort.h>
#include <math.h>
#include <string.h>

/* Takes a place of the deck to the body's own frame; what is zero there but for the rounding of the rotation is 0. */
static void own_position(const struct body *body, double position[3])
{
    if (!body->rotated) return;
    double size = 0;
    for (int axis = 0; axis < 3; axis++)
        size = fmax(size, fmax(fabs(position[axis]), fabs(body->pivot[axis])));
    body_from_deck(body, position, position);
    for (int axis = 0; axis < 3; axis++)
        if (fabs(position[axis]) <= 1e-12 * size) position[axis] = 0;
}

static void body_position(const struct recorder *recorder, const struct snapshot_record *record, size_t point,
                          double position[3])
{
    model_position(recorder->model, snapshot_point(recorder->model, record, point), position);
    own_position(&recorder->scene->body, position);
}

static void bounds_of(const struct recorder *recorder, const struct snapshot_record *record, double low[3],
                      double high[3])
{
    for (size_t i = 0; i < record->points; i++) {
        double x[3];
        body_position(recorder, record, i, x);
        for (int axis = 0; axis < 3; axis++) {
            low[axis] = i == 0 ? x[axis] : fmin(low[axis], x[axis]);
            high[axis] = i == 0 ? x[axis] : fmax(high[axis], x[axis]);
        }
    }
}

/* Where the vertical cut goes: through the first load that has a place, else through the middle. */
static double cut_place(const struct recorder *recorder, const double low[3], const double high[3])
{
    const struct scene *scene = recorder->scene;
    for (size_t k = 0; k < scene->loads; k++) {
        if (scene->load[k].shape == LOAD_FACE) continue;
        double centre[3];
        memcpy(centre, scene->load[k].centre, sizeof centre);
        own_position(&scene->body, centre);
        return fmin(fmax(centre[1], low[1]), high[1]);
    }
    return 0.5 * (low[1] + high[1]);
}

/* Keeps the points whose coordinate `axis` lies within `reach` of `place`. */
static bool pick_near(const struct recorder *recorder, const struct snapshot_record *record,
                      struct section *section, int axis, double place, double reach)
{
    section->stride = section->block = record->points;
    section->count = 1;
    section->pick = array_new(record->points, sizeof *section->pick);
    if (section->pick == NULL) return false;
    for (size_t i = 0; i < record->points; i++) {
        double x[3];
        body_position(recorder, record, i, x);
        if (axis < 0 || fabs(x[axis] - place) <= reach) section->pick[section->points++] = i;
    }
    return section->points > 0;
}

static size_t row_of(const struct section *section, size_t point)
{
    const size_t read = section->pick != NULL ? section->pick[point] : point;
    return section->start + read / section->block * section->stride + read % section->block;
}

static bool place_points(const struct recorder *recorder, const struct snapshot_record *record,
                         struct section *section)
{
    section->coordinate = array_new(2 * section->points, sizeof *section->coordinate);
    if (section->coordinate == NULL) return false;
    for (size_t k = 0; k < section->points; k++) {
        double x[3];
        body_position(recorder, record, row_of(section, k), x);
        for (int side = 0; side < 2; side++) {
            const double at = x[section->axis[side]];
            section->coordinate[2 * k + (size_t)side] = (float)at;
            section->low[side] = k == 0 ? at : fmin(section->low[side], at);
            section->high[side] = k == 0 ? at : fmax(section->high[side], at);
        }
    }
    image_prepare(section);
    return true;
}

/* Loose points have no spacing that is known here beyond the body's. */
static double spacing_of(const struct recorder *recorder, const double low[3], const double high[3])
{
    const struct body *body = &recorder->scene->body;
    if (body->spacing > 0.0) return body->spacing;
    const double volume = (high[0] - low[0]) * (high[1] - low[1]) * (high[2] - low[2]);
    return cbrt(volume / (double)(recorder->model->points + 1));
}

static bool surface_section(const struct recorder *recorder, const struct snapshot_record *record,
                            const double low[3], const double high[3], struct section *section)
{
    *section = (struct section){.axis = {0, 1}};
    const struct body *body = &recorder->scene->body;
    double top[3];
    body_position(recorder, record, 0, top);
    const double drop = body->topography != NULL ? topography_drop(body->topography, top) : 0;
    const bool below = body_is_box(body) && top[2] > body->low[2] + drop + .01 * body->spacing;
    if (body->topography != NULL)
        snprintf(section->title, sizeof section->title, "%s, seen from above",
                 below ? "top of the region" : "surface");
    else
        snprintf(section->title, sizeof section->title, "%s z%s = %.4g", below ? "cut at" : "surface",
                 own_axes(body), low[2]);
    const size_t *grid = record->grid;
    if (grid[0] == 0)
        return pick_near(recorder, record, section, 2, low[2], 0.55 * spacing_of(recorder, low, high)) &&
               place_points(recorder, record, section);
    section->along = grid[0];
    section->across = grid[1];
    section->points = section->stride = section->block = grid[0] * grid[1];
    section->count = 1;
    return place_points(recorder, record, section);
}

static bool cut_section(const struct recorder *recorder, const struct snapshot_record *record,
                        const double low[3], const double high[3], struct section *section)
{
    *section = (struct section){.axis = {0, 2}, .downwards = true};
    const char *axes = own_axes(&recorder->scene->body);
    const double place = cut_place(recorder, low, high);
    const size_t *grid = record->grid;
    snprintf(section->title, sizeof section->title, "cut at y%s = %.4g", axes, place);
    if (grid[0] == 0)
        return pick_near(recorder, record, section, 1, place, 0.55 * spacing_of(recorder, low, high)) &&
               place_points(recorder, record, section);
    double nearest = INFINITY;
    for (size_t j = 0; j < grid[1]; j++) {
        double x[3];
        body_position(recorder, record, j * grid[0], x);
        if (fabs(x[1] - place) >= nearest) continue;
        nearest = fabs(x[1] - place);
        section->start = j * grid[0];
        snprintf(section->title, sizeof section->title, "cut at y%s = %.4g", axes, x[1]);
    }
    section->along = grid[0];
    section->across = grid[2];
    section->points = grid[0] * grid[2];
    section->stride = grid[0] * grid[1];
    section->count = grid[2];
    section->block = grid[0];
    return place_points(recorder, record, section);
}

/* All of a region that is a plane or a line: one or two dimensions, or planes of a lattice. */
static bool whole_section(const struct recorder *recorder, const struct snapshot_record *record,
                          struct section *section)
{
    const struct scene *scene = recorder->scene;
    const int dimension = scene->dimension, last = dimension - 1;
    *section = (struct section){.axis = {0, 1},
                                .downwards = dimension == 3 || (dimension == 2 && ground_has_depth(scene))};
    if (record->grid[0] == 0)
        return pick_near(recorder, record, section, -1, 0.0, 0.0) && place_points(recorder, record, section);
    section->along = section->across = 1;
    section->points = section->stride = section->block = record->points;
    section->count = 1;
    double first[3];
    int sides = 0;
    body_position(recorder, record, 0, first);
    for (int axis = 0; axis < 3 && axis < dimension; axis++) {
        const size_t length = strlen(section->title);
        if (record->grid[axis] > 1) {
            *(sides == 0 ? &section->along : &section->across) = record->grid[axis];
            section->axis[sides++] = axis;
        } else if (axis < last || scene->body.topography == NULL)
            snprintf(section->title + length, sizeof section->title - length, "%s%c%s = %.4g",
                     length > 0 ? ", " : "at ", "xyz"[axis], own_axes(&scene->body), first[axis]);
    }
    return sides > 0 && place_points(recorder, record, section);
}

static bool choose_sections(const struct recorder *recorder, struct film *film)
{
    const struct snapshot_record *record = &recorder->snapshot[film->group];
    const size_t *grid = record->grid;
    film->sections = 1;
    if (recorder->scene->dimension < 3 || grid[0] == 1 || grid[1] == 1)
        return whole_section(recorder, record, &film->section[0]);
    double low[3] = {0}, high[3] = {0};
    bounds_of(recorder, record, low, high);
    film->sections = grid[2] == 1 ? 1 : 2;
    return surface_section(recorder, record, low, high, &film->section[0]) &&
           (film->sections == 1 || cut_section(recorder, record, low, high, &film->section[1]));
}

static bool choose_field(unsigned fields, selas_field *field)
{
    static const selas_field order[] = {SELAS_VELOCITY, SELAS_DISPLACEMENT, SELAS_ACCELERATION,
                                        SELAS_PRESSURE, SELAS_ENERGY,       SELAS_STRESS,
                                        SELAS_STRAIN};
    for (size_t k = 0; k < sizeof order / sizeof *order; k++)
        if ((fields >> order[k] & 1U) != 0) {
            *field = order[k];
            return true;
        }
    return false;
}

/* Values of a section in one frame, [points * components] in the film's room; vectors in the body's frame. */
static bool read_section(const struct recorder *recorder, const struct film *film,
                         const struct section *section, const struct frame *frame, struct messages *messages)
{
    const size_t components = (size_t)field_components(film->field);
    double *value = film->value;
    if (run_file_read(recorder, frame->number, film->field, section->start, section->stride, section->count,
                      section->block, value, messages) != SELAS_OK)
        return false;
    for (size_t k = 0; section->pick != NULL && k < section->points; k++) /* picks ascend: in place */
        memmove(value + components * k, value + components * section->pick[k], components * sizeof *value);
    if (components == 3 && recorder->scene->body.rotated)
        for (size_t k = 0; k < section->points; k++) {
            double own[3];
            body_direction_from_deck(&recorder->scene->body, value + 3 * k, own);
            memcpy(value + 3 * k, own, sizeof own);
        }
    return true;
}

/* The component that is largest anywhere at any time. */
static bool choose_component(const struct recorder *recorder, struct film *film, struct messages *messages)
{
    const size_t components = (size_t)field_components(film->field);
    double largest[6] = {0};
    for (size_t f = 0; f < film->frames && components > 1; f++)
        for (size_t s = 0; s < film->sections; s++) {
            if (!read_section(recorder, film, &film->section[s], &film->frame[f], messages)) return false;
            const double *value = film->value;
            for (size_t i = 0; i < film->section[s].points * components; i++)
                largest[i % components] = fmax(largest[i % components], fabs(value[i]));
        }
    for (size_t c = 1; c < components; c++)
        if (largest[c] > largest[film->component]) film->component = c;
    return true;
}

/* Room for a field of the largest section, as it is read. */
static bool make_room(struct film *film)
{
    size_t most = 0;
    for (size_t s = 0; s < film->sections; s++) {
        const size_t rows = film->section[s].count * film->section[s].block;
        most = rows > most ? rows : most;
    }
    film->value = array_new(most, (size_t)field_components(film->field) * sizeof *film->value);
    return film->value != NULL;
}

bool film_create(const struct recorder *recorder, size_t group, struct film *film, struct messages *messages)
{
    *film = (struct film){
        .group = group, .output = &recorder->scene->output, .axes = own_axes(&recorder->scene->body)};
    if (!choose_field(recorder->scene->snapshot[group].fields, &film->field)) return false;
    film->frame = array_new(recorder->entries, sizeof *film->frame);
    for (size_t k = 0; film->frame != NULL && k < recorder->entries; k++)
        if (recorder->entry[k].group == group)
            film->frame[film->frames++] =
                (struct frame){.number = recorder->entry[k].number, .time = recorder->entry[k].time};
    if (film->frames > 0 && choose_sections(recorder, film) && make_room(film) &&
        choose_component(recorder, film, messages))
        return true;
    film_free(film);
    return false;
}

static bool write_points(const struct section *section, const double *value, size_t components, FILE *data)
{
    for (size_t k = 0; k < section->points; k++) {
        const float row[3] = {section->coordinate[2 * k], section->coordinate[2 * k + 1],
                              (float)value[components * k]};
        if (fwrite(row, sizeof row, 1, data) != 1) return false;
    }
    return true;
}

/* One scale for all frames: curves get the largest value; maps half as much again as the median of the
 * frames' largest, so that late and faint waves still show while the few strongest frames saturate. */
static void choose_scale(struct film *film)
{
    double *sorted = array_new(film->frames, sizeof *sorted);
    for (size_t s = 0; s < film->sections; s++) {
        for (size_t f = 0; f < film->frames; f++) {
            film->largest[s] = fmax(film->largest[s], film->frame[f].largest[s]);
            if (sorted != NULL) sorted[f] = film->frame[f].largest[s];
        }
        film->scale[s] = film->largest[s];
        if (sorted == NULL) continue;
        gsl_sort(sorted, 1, film->frames);
        const double moderate = 1.5 * sorted[film->frames / 2];
        if (moderate > 0.0) film->scale[s] = fmin(film->largest[s], moderate);
    }
    array_free(sorted);
}

bool film_write(const struct recorder *recorder, struct film *film, FILE *data, struct messages *messages)
{
    const size_t components = (size_t)field_components(film->field);
    for (size_t f = 0; f < film->frames; f++)
        for (size_t s = 0; s < film->sections; s++) {
            const struct section *section = &film->section[s];
            struct frame *frame = &film->frame[f];
            if (!read_section(recorder, film, section, frame, messages)) return false;
            const double *value = film->value + film->component;
            frame->skip[s] = (size_t)ftell(data);
            if (!(section->regular ? image_write : write_points)(section, value, components, data))
                return false;
            for (size_t k = 0; k < section->points; k++)
                frame->largest[s] = fmax(frame->largest[s], fabs(value[components * k]));
        }
    choose_scale(film);
    return true;
}

void film_free(struct film *film)
{
    array_free(film->frame);
    array_free(film->value);
    for (size_t s = 0; s < 2; s++) {
        array_free(film->section[s].pick);
        array_free(film->section[s].coordinate);
        array_free(film->section[s].row);
    }
    *film = (struct film){0};
}
