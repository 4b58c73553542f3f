/* Moving patches: the load vector F_i(t) = f(t) * integral of N_i over the patch at centre + velocity t, a
 * product of one line per axis (the integrals are exact, whatever the place of the patch between the points),
 * as a mean over the way, without the frequencies that points do not carry (manual, doc/theory/sources.md, Eqs 6,
 * 7, 7a). With the H-form M^-1 is a product over the axes too, so each line gets its own factor. */
#include "method/consistent/galerkin/moving_load.h"

#include "base/memory.h"
#include "method/consistent/galerkin/hform.h"
#include "method/consistent/galerkin/surface.h"
#include "scene/ground.h"
#include "scene/resolution.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

void moving_weights(double weight[MOVING_SHIFTS])
{
    static const double flat = 20.1218; /* fifth zero of the spherical Bessel function j_3 */
    double sum = weight[0] = 1;
    for (int j = 1; j < MOVING_SHIFTS; j++) {
        const double part = (double)j / MOVING_SHIFTS;
        weight[j] = sin(flat * part) / (flat * part) * pow(1 - part * part, 2);
        sum += 2 * weight[j];
    }
    for (int j = 0; j < MOVING_SHIFTS; j++)
        weight[j] /= sum;
}

/* The mean's reach, which stops waves of 3 points, of a slow patch those that it would send back (Eq 7a): none where
 * the load is about as fast as the Rayleigh waves beside it, and short waves are what it sends. */
static double lag(const struct consistent *c, const struct load *load, const double velocity[3])
{
    static const double least = 3, more = 1.5, most = 4.6, spacings = 18 / 4.6, rayleigh = .92;
    const struct scene *scene = c->model.scene;
    double place[3], points = least;
    lattice_from_deck(&scene->body, load->centre, place);
    consistent_to_ground(c, place);
    const struct rock rock = ground_at(scene, place);
    const double here = sqrt(rock.mu / rock.density), slowest = fmin(slowest_speed(scene), here);
    const double speed = hypot(hypot(velocity[0], velocity[1]), velocity[2]);
    for (int axis = 0; axis < 3; axis++)
        if (velocity[axis] != 0) points = fmax(points, fmin(most, more + slowest / fabs(velocity[axis])));
    return speed < rayleigh * here
               ? spacings * points / MOVING_SHIFTS * scene->body.spacing / fmax(slowest, speed)
               : 0;
}

/* The mean is one of lines then. */
static bool along_an_axis(const double velocity[3])
{
    int axes = 0;
    for (int axis = 0; axis < 3; axis++)
        axes += velocity[axis] != 0;
    return axes <= 1;
}

static selas_status create(struct consistent *c, size_t index, struct moving_load *moving,
                           struct messages *messages)
{
    const struct scene *scene = c->model.scene;
    const struct load *load = &scene->load[index];
    size_t longest = 1;
    if (load->shape == LOAD_DISC)
        return fail(messages, SELAS_UNSUPPORTED,
                    "load %zu: a disc cannot move with the consistent method; take shape = 'square'",
                    scene->load[index].group + 1);
    moving->load = index;
    body_from_deck(&scene->body, load->centre, moving->centre);
    body_direction_from_deck(&scene->body, load->direction, moving->direction);
    body_direction_from_deck(&scene->body, load->velocity, moving->velocity);
    for (int axis = 0, edge = 0; axis < c->dimension; axis++) {
        if (c->spline[axis]->count > longest) longest = c->spline[axis]->count;
        if (axis != face_axis(load->face) && load->shape == LOAD_SQUARE)
            moving->half[axis] = load->size[edge++] / 2;
    }
    moving->face = face_axis(load->face);
    moving->lag = lag(c, load, moving->velocity);
    moving_weights(moving->weight);
    moving->work = array_new(2 * longest, sizeof *moving->work);
    moving->shifted = moving->work + longest;
    moving->terms = moving->lag == 0 || along_an_axis(moving->velocity) ? 1 : 2 * MOVING_SHIFTS - 1;
    moving->line = calloc((size_t)moving->terms, sizeof *moving->line);
    bool good = moving->work != NULL && moving->line != NULL;
    for (int i = 0; good && i < 9 * moving->terms; i++) {
        if (i / 3 % 3 >= c->dimension || i % 3 >= c->dimension) continue;
        struct moving_line *line = &moving->line[i / 9][i / 3 % 3][i % 3];
        line->value = array_new(c->spline[i % 3]->count, sizeof *line->value);
        good = line->value != NULL;
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
        struct moving_load *moving = &c->moving_load[l];
        array_free(moving->work);
        for (int i = 0; moving->line != NULL && i < 9 * moving->terms; i++)
            array_free(moving->line[i / 9][i / 3 % 3][i % 3].value);
        free(moving->line);
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

/* Adds `weight` times the integrals over the patch, or the point, with its centre at x. */
static void add_patch(const struct consistent *c, struct moving_load *moving, int component, int axis,
                      double x, double weight, double *line)
{
    const struct spline *spline = c->spline[axis];
    const bool odd = axis == component;
    const double small = 1e-12 * (spline->high - spline->low), half = moving->half[axis];
    if (x + half < spline->low - small || x - half > spline->high + small) return;
    if (half > 0)
        tuned_moments(spline, odd, x - half, x + half, moving->work, moving->shifted);
    else
        consistent_point_line(c, axis, odd, false, true, fmin(fmax(x, spline->low), spline->high),
                              moving->shifted);
    for (size_t i = 0; i < spline->count; i++)
        line[i] += weight * moving->shifted[i];
}

/* The line of a term: that of a shift, or the mean over all of them. */
static void place_line(const struct consistent *c, struct moving_load *moving, int term, int component,
                       int axis, double time, struct moving_line *line)
{
    const struct spline *spline = c->spline[axis];
    const struct load *load = &c->model.scene->load[moving->load];
    const double x = moving->centre[axis] + moving->velocity[axis] * time;
    const double shift = moving->lag * moving->velocity[axis];
    memset(line->value, 0, spline->count * sizeof *line->value);
    if (axis == moving->face)
        consistent_point_line(c, axis, axis == component, false, false,
                              face_plane(&c->model.scene->body, load->face), line->value);
    else if (moving->terms > 1 || shift == 0)
        add_patch(c, moving, component, axis, x + (term + 1 - MOVING_SHIFTS) * shift, 1, line->value);
    else
        for (int j = 1 - MOVING_SHIFTS; j < MOVING_SHIFTS; j++)
            add_patch(c, moving, component, axis, x + j * shift, moving->weight[abs(j)], line->value);
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
            for (int i = 0; i < moving->terms * c->dimension; i++) {
                const int term = i / c->dimension, axis = i % c->dimension;
                if (term > 0 && axis == moving->face) continue;
                struct moving_line *line = &moving->line[term][component][axis];
                place_line(c, moving, term, component, axis, time, line);
                if (divided) divide_line(c, component, axis, moving->work, line);
            }
        }
    }
}

/* The three lines by slot, that across the face the same for all terms; 1 where there is no axis. The term's weight. */
static double by_slot(const struct consistent *c, const struct moving_load *moving, int term, int component,
                      const struct moving_line *line[3])
{
    static double one = 1;
    static const struct moving_line nothing = {&one, 0, 1};
    line[0] = line[1] = line[2] = &nothing;
    for (int axis = 0; axis < c->dimension; axis++)
        line[c->slot[axis]] = &moving->line[axis == moving->face ? 0 : term][component][axis];
    return moving->terms > 1 ? moving->weight[abs(term + 1 - MOVING_SHIFTS)] : 1;
}

/* A term of a load in plane k, times a factor. */
static void add_term(const struct consistent *c, const struct moving_line *const line[3], double factor,
                     size_t k, double *plane)
{
    const size_t depth = c->part.along[DEPTH].first + k;
    if (depth < line[2]->from || depth >= line[2]->to) return;
    factor *= line[2]->value[depth];
    for (size_t j = 0; factor != 0 && j < c->n[1]; j++) {
        const size_t row = c->part.along[1].first + j;
        if (row < line[1]->from || row >= line[1]->to) continue;
        for (size_t i = line[0]->from; i < line[0]->to; i++)
            plane[j * c->n[0] + i] += factor * line[1]->value[row] * line[0]->value[i];
    }
}

void moving_loads_add(const struct consistent *c, const struct drive *drive, int component, size_t k,
                      double *plane)
{
    for (size_t l = 0; drive->load != NULL && l < c->moving_loads; l++) {
        const struct moving_load *moving = &c->moving_load[l];
        const double amplitude = drive->load[moving->load] * c->model.scene->load[moving->load].amplitude;
        for (int term = 0; moving->direction[component] != 0 && term < moving->terms; term++) {
            const struct moving_line *line[3];
            const double weight = by_slot(c, moving, term, component, line);
            add_term(c, line, amplitude * moving->direction[component] * weight, k, plane);
        }
    }
}

/* Power of a term on a component of the velocity. */
static double power_of_term(const struct consistent *c, const struct moving_line *const line[3],
                            const double *field)
{
    double power = 0;
    for (size_t k = c->part.along[DEPTH].own; k < c->part.along[DEPTH].end; k++) {
        const size_t depth = c->part.along[DEPTH].first + k;
        if (depth < line[2]->from || depth >= line[2]->to) continue;
        for (size_t j = c->part.along[1].own; j < c->part.along[1].end; j++) {
            const size_t row = c->part.along[1].first + j;
            if (row < line[1]->from || row >= line[1]->to) continue;
            for (size_t i = line[0]->from; i < line[0]->to; i++)
                power += line[2]->value[depth] * line[1]->value[row] * line[0]->value[i] *
                         field[k * c->plane + j * c->n[0] + i];
        }
    }
    return power;
}

double moving_loads_power(const struct consistent *c, const struct drive *drive, const double *v)
{
    double power = 0;
    for (size_t l = 0; drive->load != NULL && l < c->moving_loads; l++) {
        const struct moving_load *moving = &c->moving_load[l];
        const double amplitude = drive->load[moving->load] * c->model.scene->load[moving->load].amplitude;
        for (int i = 0; i < moving->terms * c->dimension; i++) {
            const int term = i / c->dimension, component = i % c->dimension;
            const struct moving_line *line[3];
            if (moving->direction[component] == 0) continue;
            const double weight = by_slot(c, moving, term, component, line);
            power += weight * amplitude * moving->direction[component] *
                     power_of_term(c, line, v + (size_t)component * c->volume);
        }
    }
    return power;
}
