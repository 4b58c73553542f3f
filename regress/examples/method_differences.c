/* Example of a spatial method, the smallest sensible one: second differences on a bar in one dimension,
 *
 *   m_i a_i = T_(i+1/2) - T_(i-1/2) + F_i,   T_(i+1/2) = M (u_(i+1) - u_i) / h,   m_i = rho h (half of it at the ends),
 *
 * M the modulus along the bar, F the tractions on its ends. What it cannot do it refuses: the table says what faces may
 * be, create() the rest. */
#include "base/memory.h"
#include "model/model.h"
#include "scene/initial.h"

#include <math.h>
#include <string.h>

struct bar {
    struct model model;
    double *position; /* [3 * points] */
    double h, modulus, mass;
};

extern const struct method method_differences;

static struct bar *bar_of(struct model *model)
{
    return (struct bar *)model;
}

static bool is_end(const struct bar *bar, size_t i)
{
    return i == 0 || i + 1 == bar->model.points;
}

static double mass_at(const struct bar *bar, size_t i)
{
    return is_end(bar, i) ? bar->mass / 2 : bar->mass;
}

static bool held(const struct bar *bar, size_t i)
{
    return is_end(bar, i) &&
           boundary_needs(&bar->model.scene->boundary[i == 0 ? FACE_X_LOW : FACE_X_HIGH]) != 0;
}

/* Force of a load per unit of its history, and the point on which it acts. */
static double force_of(const struct bar *bar, const struct load *load, size_t *point)
{
    *point = load->face == FACE_X_LOW ? 0 : bar->model.points - 1;
    return load->amplitude * load->direction[0];
}

static void accelerate(struct model *model, const struct drive *drive, double half_step, const double *u,
                       const double *v, double *a)
{
    const struct bar *bar = bar_of(model);
    (void)half_step;
    (void)v;
    memset(a, 0, model->points * sizeof *a);
    for (size_t i = 0; i + 1 < model->points; i++) {
        const double tension = bar->modulus * (u[i + 1] - u[i]) / bar->h;
        a[i] += tension;
        a[i + 1] -= tension;
    }
    for (size_t k = 0; drive->load != NULL && k < model->scene->loads; k++) {
        size_t point;
        const double force = force_of(bar, &model->scene->load[k], &point);
        a[point] += drive->load[k] * force;
    }
    for (size_t i = 0; i < model->points; i++)
        a[i] = held(bar, i) ? 0 : a[i] / mass_at(bar, i);
    model->evaluations++;
}

static void destroy(struct model *model)
{
    array_free(bar_of(model)->position);
    array_free(model);
}

static void initialise(struct model *model, double *y)
{
    for (size_t i = 0; i < model->points; i++) {
        double u[3], v[3];
        initial_at(model->scene, model->position + 3 * i, u, v);
        y[i] = held(bar_of(model), i) ? 0 : u[0];
        y[model->points + i] = held(bar_of(model), i) ? 0 : v[0];
    }
}

/* Straight between the two points around. */
static selas_status find_probe(struct model *model, const double position[3], struct probe *probe,
                               struct messages *messages)
{
    const struct bar *bar = bar_of(model);
    const double x = (position[0] - model->position[0]) / bar->h;
    const size_t i = (size_t)fmin(fmax(floor(x), 0), (double)model->points - 2);
    const selas_status status = probe_allocate(probe, 2, messages);
    if (status != SELAS_OK) return status;
    memcpy(probe->position, position, sizeof probe->position);
    for (size_t end = 0; end < 2; end++) {
        probe->index[end] = i + end;
        probe->weight[end] = end == 0 ? 1 + (double)i - x : x - (double)i;
        probe->gradient[3 * end] = end == 0 ? -1 / bar->h : 1 / bar->h;
    }
    probe->material = &model->scene->material[model->scene->body.material];
    return SELAS_OK;
}

static void field(struct model *model, selas_field wanted, const double *y, const double *a, size_t from,
                  size_t end, double *value)
{
    for (size_t i = from; i < end; i++) {
        struct probe probe = {0};
        struct messages messages = {0};
        if (find_probe(model, model->position + 3 * i, &probe, &messages) == SELAS_OK)
            probe_observe(model, &probe, wanted, y, a, value + (size_t)field_components(wanted) * (i - from));
        probe_free(&probe);
        messages_free(&messages);
    }
}

static void energy(struct model *model, const double *y, struct energy *energy)
{
    const struct bar *bar = bar_of(model);
    *energy = (struct energy){0};
    for (size_t i = 0; i < model->points; i++) {
        const double v = y[model->points + i], stretch = i + 1 < model->points ? y[i + 1] - y[i] : 0;
        energy->kinetic += mass_at(bar, i) * v * v / 2;
        energy->strain += bar->modulus * stretch * stretch / bar->h / 2;
    }
}

static void power(struct model *model, const struct drive *drive, const double *y, double *load,
                  double *absorbed)
{
    *load = *absorbed = 0;
    for (size_t k = 0; drive->load != NULL && k < model->scene->loads; k++) {
        size_t point;
        const double force = force_of(bar_of(model), &model->scene->load[k], &point);
        *load += drive->load[k] * force * y[model->points + point];
    }
}

/* What the table of kinds of faces cannot tell. */
static const char *refusal(const struct scene *scene)
{
    if (scene->dimension != 1) return "scene%dimension = 1";
    if (scene->body.shape != BODY_BOX || scene->body.layers > 0) return "a box of one material";
    for (size_t k = 0; k < scene->loads; k++)
        if (scene->load[k].kind != LOAD_TRACTION || scene->load[k].shape != LOAD_FACE)
            return "tractions on its ends";
    return NULL;
}

static const struct model_core core = {.destroy = destroy,
                                       .initialise = initialise,
                                       .probe = find_probe,
                                       .field = field,
                                       .energy = energy,
                                       .power = power};
static const struct model_operator spatial = {.accelerate = accelerate};

static selas_status create(const struct scene *scene, struct model **model, struct messages *messages)
{
    const char *why = refusal(scene);
    if (why != NULL) return fail(messages, SELAS_UNSUPPORTED, "method 'finite-differences' needs %s", why);
    const struct body *body = &scene->body;
    const struct material *material = &scene->material[body->material];
    const double length = body->high[0] - body->low[0];
    const size_t cells = (size_t)ceil(length / body->spacing - 1e-9);
    struct bar *bar = array_new(1, sizeof *bar);
    double *position = array_new(3 * (cells + 1), sizeof *position);
    if (bar == NULL || position == NULL) {
        array_free(bar);
        array_free(position);
        return fail(messages, SELAS_NO_MEMORY, "no memory for the model");
    }
    bar->position = position;
    bar->h = length / (double)cells;
    bar->modulus = material->plane_lambda + 2 * material->mu;
    bar->mass = material->density * bar->h;
    for (size_t i = 0; i <= cells; i++)
        position[3 * i] = body->low[0] + (double)i * bar->h;
    bar->model = (struct model){.method = &method_differences,
                                .core = &core,
                                .spatial = &spatial,
                                .scene = scene,
                                .points = cells + 1,
                                .position = position,
                                .grid = {cells + 1, 0, 0},
                                .unknowns = cells + 1,
                                .state_size = 2 * (cells + 1),
                                .component_stride = cells + 1,
                                .point_stride = 1,
                                .bytes = sizeof *bar + 3 * (cells + 1) * sizeof *position,
                                .self_adjoint = true};
    *model = &bar->model;
    return SELAS_OK;
}

const struct method method_differences = {
    .name = "finite-differences",
    .variant = "bar",
    .faces = CAN_HOLD,
    .create = create,
};
