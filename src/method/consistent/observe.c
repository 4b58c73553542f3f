/* What users see of the consistent method: point values are the spline's own (this is Ding et al.'s
 * de-convolution, Eq 38, done exactly), fields stand at the lattice points, initial states are interpolated
 * at the Greville points of the control values (manual, section 6). */
#include "method/consistent/consistent.h"
#include "method/consistent/galerkin/surface.h"
#include "method/consistent/general/kink.h"

#include "base/memory.h"
#include "scene/grading.h"
#include "scene/ground.h"
#include "scene/initial.h"

#include <string.h>

/* Functions of the three axes at one place, for components that are even and odd at symmetry planes. */
struct place {
    const struct tuned_point *at[3][2]; /* [axis][odd] */
    const size_t *point;                /* of the lattice; NULL: none */
    const double *position;             /* its place */
};

/* Value, and with a gradient the slopes, of one component of a control field. */
static void evaluate(const struct consistent *c, const struct place *place, int component,
                     const double *field, double *value, double *gradient)
{
    static const struct tuned_point one = {.count = 1, .value = {1}};
    const struct tuned_point *at[3] = {&one, &one, &one};
    size_t count[3] = {1, 1, 1};
    for (int axis = 0; axis < c->dimension; axis++) {
        at[c->slot[axis]] = place->at[axis][axis == component];
        count[c->slot[axis]] = place->at[axis][axis == component]->count;
    }
    double sum = 0, slope[3] = {0, 0, 0};
    for (size_t k = 0; k < count[2]; k++)
        for (size_t j = 0; j < count[1]; j++) {
            const double *row = field + (at[2]->index[k] - c->part.along[DEPTH].first) * c->plane +
                                (at[1]->index[j] - c->part.along[1].first) * c->n[0];
            double along = 0, along_slope = 0;
            for (size_t i = 0; i < count[0]; i++) {
                along += at[0]->value[i] * row[at[0]->index[i]];
                along_slope += at[0]->slope[i] * row[at[0]->index[i]];
            }
            sum += at[2]->value[k] * at[1]->value[j] * along;
            slope[0] += at[2]->value[k] * at[1]->value[j] * along_slope;
            slope[1] += at[2]->value[k] * at[1]->slope[j] * along;
            slope[2] += at[2]->slope[k] * at[1]->value[j] * along;
        }
    *value = sum;
    for (int axis = 0; gradient != NULL && axis < c->dimension; axis++)
        gradient[axis] = slope[c->slot[axis]];
}

static bool tilted(const struct consistent *c)
{
    return c->surface != NULL || c->model.scene->body.grading != NULL;
}

/* Slopes of a component along the lattice become those along the axes. */
static void tilt(const struct consistent *c, const struct metric *metric, double *gradient)
{
    double slope[3] = {0};
    for (int axis = 0; axis < c->dimension; axis++)
        slope[c->slot[axis]] = gradient[axis];
    metric_tilt(metric, slope);
    for (int axis = 0; axis < c->dimension; axis++)
        gradient[axis] = slope[c->slot[axis]];
}

/* Sum of `each` sites of a probe beside an interface (general/kink.c), places in the whole field. */
static double read_sites(const struct probe *probe, size_t from, size_t each, const double *field)
{
    double sum = 0;
    for (size_t site = from; site < from + each; site++)
        sum += probe->weight[site] * field[probe->index[site]];
    return sum;
}

/* What such a probe adds to a component of a control field. */
static double kink_of(const struct consistent *c, const struct probe *probe, int component,
                      const double *field)
{
    if (probe == NULL) return 0;
    const size_t each = (probe->sites - probe->strains) / (size_t)c->dimension;
    return read_sites(probe, probe->count + (size_t)component * each, each, field);
}

/* The strains that it reads, in the place of slopes. */
static void strains_of(const struct consistent *c, const struct probe *probe, const double *u,
                       double *gradient)
{
    const size_t each = probe->strains / (size_t)(c->dimension * (c->dimension + 1) / 2);
    size_t from = probe->count + probe->sites - probe->strains;
    for (int i = 0; i < c->dimension; i++)
        for (int j = i; j < c->dimension; j++, from += each)
            gradient[3 * i + j] = gradient[3 * j + i] = read_sites(probe, from, each, u);
}

static bool is_strained(selas_field field)
{
    return field == SELAS_STRAIN || field == SELAS_STRESS || field == SELAS_PRESSURE || field == SELAS_ENERGY;
}

/* The whole of damped ground. */
static const struct consistent *whole_of(const struct consistent *c)
{
    return c->model.whole != NULL ? consistent_of(c->model.whole) : c;
}

/* A field in deck coordinates at one place; metric NULL: below a level surface; probe NULL: of a snapshot. */
static void field_at(const struct consistent *c, const struct place *place, const struct probe *probe,
                     const struct metric *metric, const struct material *material, selas_field field,
                     const double *y, const double *a, double *value)
{
    struct point_values values = {0};
    const double *v = y + c->model.unknowns;
    for (int component = 0; component < c->dimension; component++) {
        const size_t from = (size_t)component * c->volume;
        if (field == SELAS_VELOCITY || field == SELAS_ENERGY)
            evaluate(c, place, component, v + from, &values.velocity[component], NULL);
        if (field == SELAS_ACCELERATION)
            evaluate(c, place, component, a + from, &values.acceleration[component], NULL);
        values.velocity[component] += field == SELAS_VELOCITY ? kink_of(c, probe, component, v) : 0;
        values.acceleration[component] += field == SELAS_ACCELERATION ? kink_of(c, probe, component, a) : 0;
        if (field == SELAS_VELOCITY || field == SELAS_ACCELERATION) continue;
        double *gradient = &values.gradient[3 * component];
        evaluate(c, place, component, y + from, &values.displacement[component], gradient);
        values.displacement[component] += field == SELAS_DISPLACEMENT ? kink_of(c, probe, component, y) : 0;
        if (metric != NULL) tilt(c, metric, gradient);
    }
    if (c->general != NULL && place->point != NULL && is_strained(field))
        general_mend(whole_of(c), place->point, place->position, y, values.gradient);
    if (probe != NULL && probe->strains > 0) strains_of(c, probe, y, values.gradient);
    field_from_values(&c->model, material, &values, field, value);
}

static const struct material *material_at(const struct consistent *c, double depth_position)
{
    const struct scene *scene = c->model.scene;
    if (scene->body.layers == 0) return &scene->material[scene->body.material];
    return scene_material_at(scene, grading_real(scene->body.grading, depth_position) -
                                        scene->body.low[c->dimension - 1]);
}

/* The same on any ground, at a place of the lattice; what Hooke's law and energies need of it. */
static const struct material *general_material_at(const struct consistent *c, const double place[3],
                                                  struct material *material)
{
    double real[3];
    memcpy(real, place, sizeof real);
    consistent_to_ground(c, real);
    const struct rock rock = ground_part_at(c->model.scene, real);
    *material = (struct material){
        .density = rock.density, .lambda = rock.lambda, .plane_lambda = rock.lambda, .mu = rock.mu};
    return material;
}

void consistent_observe(struct model *model, const struct probe *probe, selas_field field, const double *y,
                        const double *a, double *value)
{
    const struct consistent *c = consistent_of(model);
    struct tuned_point at[3][2];
    struct place place = {0};
    double position[3];
    lattice_from_deck(&c->model.scene->body, probe->position, position);
    for (int axis = 0; axis < c->dimension; axis++)
        for (int odd = 0; odd < 2; odd++) {
            tuned_seen(c->spline[axis], odd, position[axis], &at[axis][odd]);
            place.at[axis][odd] = &at[axis][odd];
        }
    struct material here;
    const struct metric metric = consistent_metric(c, position);
    field_at(c, &place, probe, tilted(c) ? &metric : NULL,
             c->general == NULL ? probe->material : general_material_at(c, position, &here), field, y, a,
             value);
}

/* What consistent_observe() reads there. */
static bool watch_place(struct consistent *c, const double place[3])
{
    struct spline_point at[3];
    const size_t local = (size_t)c->options.degree + 1;
    for (unsigned odd = 0; odd < 8; odd++) {
        for (int axis = 0; axis < c->dimension; axis++)
            spline_at(c->spline[axis], (odd >> axis & 1U) != 0, place[axis], &at[c->slot[axis]]);
        for (size_t w = 0; c->dimension == 3 && w < local * local * local; w++) {
            const size_t row = at[1].index[w / local % local] - c->part.along[1].first;
            const size_t seen = at[0].index[w % local] + c->n[0] * row +
                                c->plane * (at[2].index[w / (local * local)] - c->part.along[DEPTH].first);
            if (!watch_places(c, 1, &seen)) return false;
        }
    }
    return true;
}

/* The rank that has this for its own has all rows and planes of a place in its window. */
static size_t lowest(const struct tuned_point *at)
{
    size_t index = at->index[0];
    for (size_t j = 1; j < at->count; j++)
        index = at->index[j] < index ? at->index[j] : index;
    return index;
}

/* The weights are those of components that are even at symmetry planes; consistent_observe knows the others.
 */
selas_status consistent_probe(struct model *model, const double position[3], struct probe *probe,
                              struct messages *messages)
{
    struct consistent *c = consistent_of(model);
    struct tuned_point at[3] = {{.value = {1}}, {.value = {1}}, {.value = {1}}};
    size_t count[3] = {1, 1, 1};
    double place[3];
    lattice_from_deck(&c->model.scene->body, position, place);
    for (int axis = 0; axis < c->dimension; axis++) {
        tuned_seen(c->spline[axis], false, place[axis], &at[c->slot[axis]]);
        count[c->slot[axis]] = at[c->slot[axis]].count;
    }
    const size_t first[3] = {0, c->part.along[1].first, c->part.along[DEPTH].first};
    const int holder = part_holder(c, lowest(&at[1]), lowest(&at[DEPTH]));
    const size_t all = holder == ranks_me(c->part.ranks) ? count[0] * count[1] * count[2] : 0;
    struct readings beside = {0};
    if (c->general != NULL && !general_see(c, place, probe->fields, &beside))
        return fail(messages, SELAS_NO_MEMORY, "no memory for a receiver");
    const selas_status status =
        probe_allocate(probe, all + (all > 0 ? readings_sites(c, &beside) : 0), messages);
    probe->count = all;
    const bool good =
        status == SELAS_OK && (all == 0 || (watch_place(c, place) && readings_keep(c, &beside, probe)));
    readings_free(&beside);
    if (!good) return fail(messages, SELAS_NO_MEMORY, "no memory for a receiver");
    const struct metric metric = consistent_metric(c, place);
    memcpy(probe->position, position, sizeof probe->position);
    probe->material = material_at(c, place[c->dimension - 1]);
    probe->holder = holder;
    for (size_t w = 0; w < probe->count; w++) {
        const size_t i = w % count[0], j = w / count[0] % count[1], k = w / (count[0] * count[1]);
        const double value[3] = {at[0].value[i], at[1].value[j], at[2].value[k]};
        const double slope[3] = {at[0].slope[i] * value[1] * value[2], value[0] * at[1].slope[j] * value[2],
                                 value[0] * value[1] * at[2].slope[k]};
        probe->index[w] =
            at[0].index[i] + c->n[0] * (at[1].index[j] - first[1]) + c->plane * (at[2].index[k] - first[2]);
        probe->weight[w] = value[0] * value[1] * value[2];
        for (int axis = 0; axis < c->dimension; axis++)
            probe->gradient[3 * w + (size_t)axis] = slope[c->slot[axis]];
        if (tilted(c)) tilt(c, &metric, &probe->gradient[3 * w]);
    }
    return SELAS_OK;
}

/* Lattice points per axis: the deck's spacing, whatever the knots. */
static double lattice_position(const struct consistent *c, int axis, size_t i)
{
    const double low = c->model.scene->body.low[axis], high = c->model.scene->body.high[axis];
    const size_t cells = c->model.grid[axis] - 1;
    return i == cells ? high : low + (high - low) * (double)i / (double)cells;
}

bool observe_create(struct consistent *c)
{
    struct model *model = &c->model;
    const struct body *body = &model->scene->body;
    model->points = 1;
    for (int axis = 0; axis < 3; axis++) {
        model->grid[axis] = 1;
        if (axis >= c->dimension) continue;
        const double cells = body_cells(body, axis);
        model->grid[axis] = cells < 1.5 ? 2 : (size_t)(cells + .5) + 1;
        model->points *= model->grid[axis];
        for (int odd = 0; odd < 2; odd++) {
            c->lattice[axis][odd] = array_new(model->grid[axis], sizeof(struct tuned_point));
            if (c->lattice[axis][odd] == NULL) return false;
            for (size_t i = 0; i < model->grid[axis]; i++)
                tuned_seen(c->spline[axis], odd, lattice_position(c, axis, i), &c->lattice[axis][odd][i]);
        }
    }
    return true;
}

int consistent_holder(const struct model *model, size_t point)
{
    const struct consistent *c = (const struct consistent *)model;
    const size_t at[3] = {point % model->grid[0], point / model->grid[0] % model->grid[1],
                          point / (model->grid[0] * model->grid[1])};
    size_t first[3] = {0};
    for (int axis = 0; axis < c->dimension && axis < 3; axis++)
        first[c->slot[axis]] = lowest(&c->lattice[axis][0][at[axis]]);
    return part_holder(c, first[1], first[DEPTH]);
}

void consistent_field(struct model *model, selas_field field, const double *y, const double *a, size_t from,
                      size_t end, double *value)
{
    const struct consistent *c = consistent_of(model);
    const size_t components = (size_t)field_components(field);
#pragma omp parallel for schedule(dynamic, 64)
    for (size_t p = from; p < end; p++) {
        const size_t at[3] = {p % model->grid[0], p / model->grid[0] % model->grid[1],
                              p / (model->grid[0] * model->grid[1])};
        double position[3] = {0};
        struct place place = {.point = at, .position = position};
        for (int axis = 0; axis < c->dimension; axis++)
            for (int odd = 0; odd < 2; odd++)
                place.at[axis][odd] = &c->lattice[axis][odd][at[axis]];
        for (int axis = 0; axis < c->dimension; axis++)
            position[axis] = lattice_position(c, axis, at[axis]);
        struct material here;
        const struct metric metric = consistent_metric(c, position);
        const struct material *material = c->general != NULL ? general_material_at(c, position, &here)
                                                             : material_at(c, position[c->dimension - 1]);
        field_at(c, &place, NULL, tilted(c) ? &metric : NULL, material, field, y, a,
                 value + components * (p - from));
    }
}

/* Lines along an axis of one component, whose values at the Greville points become control values. */
struct interpolation {
    const struct consistent *c;
    const struct band *lu;
    int slot;
    bool forward;
    double *field;
};

static void interpolate_rows(void *context, size_t from, size_t end)
{
    const struct interpolation *task = context;
    const struct line_set set = line_set(task->c, task->slot);
    const struct band_rows rows = {task->lu->n, task->c->part.along[task->slot].first, from, end};
    for (size_t line = 0; line < set.lines; line++)
        band_lu_rows(task->lu, &rows, task->forward, task->field + line_start(&set, line), set.stride);
}

/* One axis after the other, depth last. */
static void interpolate(struct consistent *c, int component, double *field)
{
    const struct part_fields fields = part_values(c, field, 1, sizeof *field);
    for (int axis = 0; axis < c->dimension; axis++) {
        struct interpolation task = {c, c->collocation[axis][axis == component], c->slot[axis], true, field};
        for (int half = 0; half < 2; half++) {
            task.forward = half == 0;
            if (c->part.along[task.slot].ranks > 1)
                part_sweep(c, task.slot, task.forward, (size_t)c->options.degree, &fields, interpolate_rows,
                           &task);
            else
                interpolate_rows(&task, 0, c->n[task.slot]);
        }
    }
    part_exchange(c, &fields);
    for (size_t k = 0; k < c->n[DEPTH]; k++)
        consistent_clear_held(c, component, k, field + k * c->plane);
}

void consistent_initialise(struct model *model, double *y)
{
    struct consistent *c = consistent_of(model);
    const struct scene *scene = model->scene;
    if (scene->initial.kind == INITIAL_REST) return;
    double *fields[2] = {y, y + model->unknowns};
    for (size_t i = 0; i < c->volume; i++) {
        const size_t at[3] = {i % c->n[0], i / c->n[0] % c->n[1], i / c->plane};
        double position[3] = {0}, state[2][3];
        for (int axis = 0; axis < c->dimension; axis++)
            position[axis] =
                c->spline[axis]->greville[at[c->slot[axis]] + c->part.along[c->slot[axis]].first];
        lattice_to_deck(&scene->body, position, position);
        initial_at(scene, position, state[0], state[1]);
        for (int kind = 0; kind < 2; kind++) {
            if (scene->body.rotated) body_direction_from_deck(&scene->body, state[kind], state[kind]);
            for (int component = 0; component < c->dimension; component++)
                fields[kind][(size_t)component * c->volume + i] = state[kind][component];
        }
    }
    for (int kind = 0; kind < 2; kind++)
        for (int component = 0; component < c->dimension; component++)
            interpolate(c, component, fields[kind] + (size_t)component * c->volume);
}

bool collocation_create(struct consistent *c)
{
    if (c->model.scene->initial.kind == INITIAL_REST) return true;
    for (int axis = 0; axis < c->dimension; axis++)
        for (int odd = 0; odd < 2; odd++) {
            c->collocation[axis][odd] = consistent_collocation(c->spline[axis], odd);
            if (c->collocation[axis][odd] == NULL) return false;
        }
    return true;
}
