/* The consistent smoothed point method (consistent.c): its axes, and what faces and grounds do to the control
 * values on them. */
#include "method/consistent/galerkin/galerkin.h"
#include "method/consistent/galerkin/surface.h"

#include "base/memory.h"
#include "scene/absorbing_layers.h"
#include "scene/grading.h"
#include "scene/ground.h"

#include <math.h>
#include <omp.h>
#include <string.h>

/* What each face does to each component's control values, in the body's frame. */
static void lay_faces(struct consistent *c)
{
    const struct scene *scene = c->model.scene;
    for (int face = 0; face < 2 * c->dimension; face++) {
        const struct boundary *boundary = &scene->boundary[face];
        const struct spline *spline = c->spline[face / 2];
        const bool even =
            boundary_mirrors(boundary) && spline->mirror[face % 2] && !spline->centred[face % 2];
        double direction[3];
        memcpy(direction, boundary->direction, sizeof direction);
        if (scene->body.rotated) body_direction_from_deck(&scene->body, boundary->direction, direction);
        c->moving[face] = boundary_acts(boundary);
        c->damped[face] = boundary_damps(boundary);
        c->model.damped = c->model.damped || c->damped[face];
        for (int component = 0; component < c->dimension; component++) {
            c->motion[face][component] = boundary->amplitude * direction[component];
            c->held[component][face] =
                c->layer[face] > 0 || (face_holds(scene, (enum face)face, component) && !even);
        }
    }
}

/* Depths below the low end of the last axis where the material changes, as positions. */
static size_t interfaces(const struct body *body, int axis, double *at)
{
    size_t count = 0;
    for (size_t i = 0; i < body->layers; i++) {
        const double x = body->low[axis] + body->layer[i].top;
        const double small = 1e-9 * (body->high[axis] - body->low[axis]);
        if (x > body->low[axis] + small && x < body->high[axis] - small) at[count++] = x;
    }
    return count;
}

static selas_status lay_axes(struct consistent *c, struct messages *messages)
{
    static const int slots[3][3] = {{2, 0, 0}, {0, 2, 0}, {0, 1, 2}};
    const struct body *body = &c->model.scene->body;
    double *interface = array_new(body->layers, sizeof *interface);
    if (interface == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the axes");
    for (int axis = 0; axis < 3; axis++)
        c->n[axis] = 1;
    selas_status status = SELAS_OK;
    for (int axis = 0; axis < c->dimension && status == SELAS_OK; axis++) {
        struct spline_choice choice = {.degree = c->options.degree,
                                       .low = body->low[axis],
                                       .high = body->high[axis],
                                       .spacing = body->spacing,
                                       .mapped = c->options.mapped,
                                       .interface = interface};
        const double cells = round(body_cells(body, axis));
        if (c->layer[2 * axis] + c->layer[2 * axis + 1] > 0 || body->grading != NULL)
            choice.spacing = (choice.high - choice.low) / fmax(cells, 1);
        choice.low -= (double)c->layer[2 * axis] * choice.spacing;
        choice.high += (double)c->layer[2 * axis + 1] * choice.spacing;
        c->slot[axis] = slots[c->dimension - 1][axis];
        if (c->slot[axis] == DEPTH && !c->options.general)
            choice.interfaces = interfaces(body, axis, interface);
        const struct boundary *boundary = &c->model.scene->boundary[2 * axis];
        for (int end = 0; end < 2; end++)
            choice.mirror[end] = boundary_mirrors(&boundary[end]);
        if (choice.mirror[0] && choice.mirror[1] && cells <= 2 * choice.degree)
            choice.mirror[0] = choice.mirror[1] = false; /* too thin: the normal component is held instead */
        c->spline[axis] = spline_new(&choice, messages);
        if (c->spline[axis] == NULL)
            status = messages->no_memory ? SELAS_NO_MEMORY : SELAS_BAD_SCENE;
        else
            c->n[c->slot[axis]] = c->spline[axis]->count;
        if (status == SELAS_OK && c->options.tuned && c->slot[axis] != DEPTH && !spline_tune(c->spline[axis]))
            status = fail(messages, SELAS_NO_MEMORY, "no memory for the axes");
        c->layout[c->slot[axis]] = c->spline[axis];
    }
    array_free(interface);
    if (status == SELAS_OK) status = part_lay(c, messages);
    c->plane = c->n[0] * c->n[1];
    c->volume = c->plane * c->n[2];
    /* a thread that has less than this many values to work on costs more than it helps */
    const size_t worth = 1 + c->volume / 4000, all = (size_t)omp_get_max_threads();
    c->threads = (int)(worth < all ? worth : all);
    c->model.unknowns = (size_t)c->dimension * c->volume;
    return status;
}

static void properties(const struct material *material, double property[WEIGHT_NONE])
{
    property[WEIGHT_DENSITY] = material->density;
    property[WEIGHT_LAMBDA] = material->plane_lambda;
    property[WEIGHT_MU] = material->mu;
    property[WEIGHT_P] = material->plane_lambda + 2 * material->mu;
}

/* Material by element of the depth axis. */
static bool lay_material(struct consistent *c)
{
    const struct scene *scene = c->model.scene;
    properties(&scene->material[scene->body.material], c->property);
    if (scene->body.layers == 0 || c->options.general) return true;
    const struct spline *spline = c->layout[DEPTH];
    for (int weight = 0; weight < WEIGHT_NONE; weight++) {
        c->weighted[weight] = array_new(spline->elements, sizeof(double));
        if (c->weighted[weight] == NULL) return false;
    }
    for (size_t e = 0; e < spline->elements; e++) {
        const double middle = (spline->element[e].x_from + spline->element[e].x_to) / 2;
        double property[WEIGHT_NONE];
        properties(scene_material_at(scene, middle - scene->body.low[c->dimension - 1]), property);
        for (int weight = 0; weight < WEIGHT_NONE; weight++)
            c->weighted[weight][e] = property[weight];
    }
    return true;
}

/* Speeds of P and S waves on a face of general ground where plane k of the lattice lies (on those across depth: all
 * planes), the mean over places along it: the dampers of a plane are one. */
static void mean_speeds(const struct consistent *c, int face, size_t k, double speed[2])
{
    enum { SAMPLES = 33 };
    const struct scene *scene = c->model.scene;
    const int across = face / 2, depth = c->dimension - 1;
    double place[3] = {0};
    const int n[3] = {across == 0 || depth == 0 ? 1 : SAMPLES, across == 1 || depth < 2 ? 1 : SAMPLES, 1};
    place[across] = face_plane(&scene->body, (enum face)face);
    place[depth] =
        across == depth ? grading_lattice(scene->body.grading, place[depth]) : c->layout[DEPTH]->greville[k];
    speed[0] = speed[1] = 0;
    for (int i = 0; i < n[0] * n[1]; i++) {
        const int at[2] = {i % n[0], i / n[0]};
        for (int axis = 0; axis < 2; axis++)
            if (n[axis] > 1)
                place[axis] = scene->body.low[axis] +
                              (at[axis] + .5) / SAMPLES * (scene->body.high[axis] - scene->body.low[axis]);
        double real[3] = {place[0], place[1], place[2]}, here[2];
        consistent_to_ground(c, real);
        ground_speeds_at(scene, real, here);
        speed[0] += here[0] / (n[0] * n[1]);
        speed[1] += here[1] / (n[0] * n[1]);
    }
}

/* Planes of control values by their material, and the damped faces' speeds there. */
static bool lay_planes(struct consistent *c)
{
    const struct scene *scene = c->model.scene;
    const size_t n = c->part.along[DEPTH].whole;
    c->plane_class = array_new(n, sizeof *c->plane_class);
    c->class_plane = array_new(n, sizeof *c->class_plane);
    if (c->plane_class == NULL || c->class_plane == NULL) return false;
    for (int face = 0; face < 2 * c->dimension; face++)
        for (int component = 0; component < c->dimension; component++) {
            c->speed[face][component] = array_new(n, sizeof(double));
            if (c->speed[face][component] == NULL) return false;
        }
    const struct material *before = NULL;
    for (size_t k = 0; k < n; k++) {
        const struct spline *spline = c->layout[DEPTH];
        const struct material *material =
            scene->body.layers == 0
                ? &scene->material[scene->body.material]
                : scene_material_at(scene, grading_real(scene->body.grading, spline->greville[k]) -
                                               scene->body.low[c->dimension - 1]);
        if (material == NULL) return false;
        if (material != before) c->class_plane[c->classes++] = k;
        before = material;
        c->plane_class[k] = c->classes - 1;
        for (int face = 0; face < 2 * c->dimension; face++) {
            const struct boundary *boundary = &scene->boundary[face];
            double speed[2] = {material->p_speed, material->s_speed};
            if (c->damped[face] && ground_is_general(scene)) mean_speeds(c, face, k, speed);
            if (c->slot[face / 2] == DEPTH) /* R has the Jacobian, the area of this face has not */
                for (int s = 0; s < 2; s++)
                    speed[s] /=
                        grading_stretch(scene->body.grading, face_plane(&scene->body, (enum face)face));
            for (int component = 0; component < c->dimension; component++)
                c->speed[face][component][k] = component == face / 2 ? boundary->normal_factor * speed[0]
                                                                     : boundary->shear_factor * speed[1];
        }
    }
    return true;
}

double consistent_fastest(const struct consistent *c, int face)
{
    const struct scene *scene = c->model.scene;
    const struct body *body = &scene->body;
    const double depth = body->high[c->dimension - 1] - body->low[c->dimension - 1];
    const bool across = c->slot[face / 2] == DEPTH;
    double fastest = across ? scene_material_at(scene, face % 2 == 0 ? 0 : depth)->p_speed
                            : scene->material[body->material].p_speed;
    for (size_t i = 0; i < body->layers; i++) {
        const struct layer *layer = &body->layer[i];
        if (across && !layer->graded && !layer_leans(layer)) continue; /* only the deepest one is there */
        fastest = fmax(fastest, scene->material[layer->material].p_speed);
        if (layer->graded) fastest = fmax(fastest, scene->material[layer->bottom].p_speed);
    }
    for (size_t i = 0; i < body->blocks; i++)
        if (block_goes_on(scene, &body->block[i], face))
            fastest = fmax(fastest, scene->material[body->block[i].material].p_speed);
    return fastest;
}

selas_status consistent_lay(struct consistent *c, struct messages *messages)
{
    for (int face = 0; face < 2 * c->dimension; face++)
        c->layer[face] = layer_points(c->model.scene, face);
    const selas_status status = lay_axes(c, messages);
    if (status != SELAS_OK) return status;
    lay_faces(c);
    if (lay_material(c) && consistent_lay_surface(c) && lay_planes(c)) return SELAS_OK;
    return fail(messages, SELAS_NO_MEMORY, "no memory for a model of %zu control values", c->volume);
}

/* Control values of a component on a held face: the mass solve leaves 0 there. */
void consistent_clear_held(const struct consistent *c, int component, size_t k, double *plane)
{
    for (int face = 0; face < 2 * c->dimension; face++) {
        if (!c->held[component][face]) continue;
        const int slot = c->slot[face / 2];
        const size_t at = part_face(c, face);
        if (slot == 0)
            for (size_t j = 0; j < c->n[1]; j++)
                plane[j * c->n[0] + at] = 0;
        else if (slot == 1 && at != SIZE_MAX)
            memset(plane + at * c->n[0], 0, c->n[0] * sizeof *plane);
        else if (slot == DEPTH && k == at)
            memset(plane, 0, c->plane * sizeof *plane);
    }
}

struct band *consistent_collocation(const struct spline *spline, bool odd)
{
    struct band *band = band_new(spline->count, (size_t)spline->degree);
    for (size_t i = 0; band != NULL && i < spline->count; i++) {
        struct spline_point at;
        spline_at(spline, odd, spline->greville[i], &at);
        for (int j = 0; j <= spline->degree; j++)
            if (at.value[j] != 0) band_add(band, i, at.index[j], at.value[j]);
        if (band_get(band, i, i) == 0) band_add(band, i, i, 1); /* odd, on a symmetry plane */
    }
    if (band == NULL || band_lu(band)) return band;
    band_free(band);
    return NULL;
}
