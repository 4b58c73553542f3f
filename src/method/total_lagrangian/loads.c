/* Loads of total-Lagrangian SPH. Forces at a place and moment tensors work on the moving-least-squares
 * value and gradient there: f_i = w_i(x) P, f_i = M grad w_i(x), which keeps force and moment. */
#include "method/total_lagrangian/total_lagrangian.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

struct gather {
    double *force; /* [dimension * points] */
    struct messages *messages;
};

/* All points that a value at a place is taken from are this rank's. Where they are not, none of its own is one. */
static bool within(const struct tl_model *tl, const double place[3])
{
    const double along = place[tl->cloud->axis], radius = tl_probe_radius(tl);
    return along - radius >= tl->cloud->low && along + radius <= tl->cloud->high;
}

/* Adds a force (gradient NULL) or a moment tensor at a place. */
static selas_status add_at(struct tl_model *tl, const double place[3], const double force[3],
                           const double *moment, struct gather *gather)
{
    const size_t d = (size_t)tl->cloud->dimension;
    size_t count = 0;
    size_t index[TL_PROBE_ROOM];
    double weight[TL_PROBE_ROOM] = {0};
    double gradient[3 * TL_PROBE_ROOM] = {0};
    if (!within(tl, place)) return SELAS_OK;
    const selas_status status = tl_probe(tl, place, &count, index, weight, gradient, gather->messages);
    if (status != SELAS_OK) return status;
    for (size_t k = 0; k < count; k++)
        for (size_t a = 0; a < d && a < 3; a++) {
            double *out = gather->force + d * index[k] + a;
            if (moment == NULL)
                *out += weight[k] * force[a];
            else
                for (size_t b = 0; b < d; b++)
                    *out += moment[3 * a + b] * gradient[3 * k + b];
        }
    return SELAS_OK;
}

static void moment_in_body(const struct scene *scene, const struct load *load, double scale, double moment[9])
{
    static const int place[9] = {0, 3, 5, 3, 1, 4, 5, 4, 2};
    double half[9];
    for (int b = 0; b < 3; b++) {
        double column[3];
        double turned[3];
        for (int a = 0; a < 3; a++)
            column[a] = scale * load->moment[place[3 * a + b]];
        body_direction_from_deck(&scene->body, column, turned);
        for (int a = 0; a < 3; a++)
            half[3 * a + b] = turned[a];
    }
    for (int a = 0; a < 3; a++)
        body_direction_from_deck(&scene->body, half + 3 * a, moment + 3 * a);
}

/* Tractions on the hole or on surfaces from a file, element by element. */
static selas_status traction_on_elements(struct tl_model *tl, const struct load *load,
                                         const double direction[3], struct gather *gather)
{
    for (size_t e = 0; e < tl->cloud->elements; e++) {
        const struct face_element *element = &tl->cloud->element[e];
        double force[3];
        if (element->face != (int)load->face) continue;
        for (int c = 0; c < 3; c++)
            force[c] = direction[c] * load->amplitude * element->area;
        const selas_status status = add_at(tl, element->position, force, NULL, gather);
        if (status != SELAS_OK) return status;
    }
    return SELAS_OK;
}

static selas_status collect_load(struct tl_model *tl, const struct load *load, struct gather *gather)
{
    const struct scene *scene = tl->model.scene;
    const size_t d = (size_t)scene->dimension;
    double centre[3];
    double direction[3];
    double force[3];
    body_from_deck(&scene->body, load->centre, centre);
    body_direction_from_deck(&scene->body, load->direction, direction);
    const double part = scene_carries(scene, centre) * load->amplitude;
    for (int c = 0; c < 3; c++)
        force[c] = direction[c] * part;
    if (load->kind == LOAD_MOMENT_TENSOR) {
        double moment[9];
        moment_in_body(scene, load, part, moment);
        return add_at(tl, centre, force, moment, gather);
    }
    if (load->shape == LOAD_POINT) return add_at(tl, centre, force, NULL, gather);
    if (load->kind == LOAD_BODY_FORCE) {
        for (size_t i = 0; i < tl->cloud->points; i++)
            for (size_t a = 0; a < d; a++)
                gather->force[d * i + a] = tl->cloud->volume[i] * load->amplitude * direction[a];
        return SELAS_OK;
    }
    if (tl->options.form != NULL && load->face != FACE_HOLE)
        return tl->options.form->traction(tl, load, centre, direction, gather->force, gather->messages);
    if (load->face != FACE_HOLE && (scene->body.shape != BODY_POINTS || load->shape == LOAD_FACE))
        return tl_traction_on_box(tl, load, centre, direction, gather->force, gather->messages);
    if (load->shape != LOAD_FACE)
        return fail(gather->messages, SELAS_UNSUPPORTED, "a load on face '%s' needs shape = 'face'",
                    face_name(load->face));
    return traction_on_elements(tl, load, direction, gather);
}

static selas_status compress(struct tl_model *tl, const double *force, struct tl_load *load,
                             struct messages *messages)
{
    const size_t d = (size_t)tl->cloud->dimension;
    for (int pass = 0; pass < 2; pass++) {
        size_t count = 0;
        for (size_t i = 0; i < tl->cloud->points; i++) {
            bool loaded = false;
            for (size_t a = 0; a < d; a++)
                loaded = loaded || force[d * i + a] != 0;
            if (!loaded) continue;
            if (pass == 1) {
                load->point[count] = i;
                memcpy(load->force + d * count, force + d * i, d * sizeof *force);
            }
            count++;
        }
        if (pass == 1) break;
        load->count = count;
        load->point = array_new(count, sizeof *load->point);
        load->force = array_new(d * count, sizeof *load->force);
        if (load->point == NULL || load->force == NULL)
            return fail(messages, SELAS_NO_MEMORY, "no memory for the load on %zu points", count);
    }
    return SELAS_OK;
}

/* Areas from a file on the faces where something acts: no more than the box has, nor less where the points fill it. */
static selas_status check_areas(const struct tl_model *tl, struct messages *messages)
{
    const struct scene *scene = tl->model.scene;
    const struct body *body = &scene->body;
    const bool filled = fabs(cloud_filling(tl->cloud, body) - 1) < 0.02;
    for (int face = 0; face < 2 * scene->dimension; face++) {
        bool acts = boundary_absorbs(&scene->boundary[face]);
        double area = 0;
        for (size_t k = 0; k < scene->loads; k++)
            acts = acts || (scene->load[k].kind == LOAD_TRACTION && scene->load[k].face == (enum face)face);
        if (acts) cloud_on_face(tl->cloud, face, &area);
        for (int c = 0; c < scene->dimension; c++)
            if (c != face_axis((enum face)face)) area /= body->high[c] - body->low[c];
        if (area > 1.02)
            return fail(
                messages, SELAS_BAD_SCENE,
                "%s: the areas of the points on face '%s' add up to %.4g times that of the box low .. high; "
                "expected at most 1.02, as loads are traction times area",
                body->file, face_name((enum face)face), area);
        if (area > 0 && area < 0.98 && filled)
            warn(
                messages,
                "%s: the points fill their box low .. high, but their areas on face '%s' add up to %.3g "
                "times "
                "its: loads and dampers there act by as much; no normals and areas would be right: the faces "
                "are then those of the box",
                body->file, face_name((enum face)face), area);
    }
    return SELAS_OK;
}

selas_status tl_make_loads(struct tl_model *tl, struct messages *messages)
{
    const struct scene *scene = tl->model.scene;
    const size_t n = (size_t)scene->dimension * tl->cloud->points;
    struct gather gather = {array_new(n, sizeof(double)), messages};
    tl->load = array_new(scene->loads, sizeof *tl->load);
    selas_status status = SELAS_OK;
    if (gather.force == NULL || tl->load == NULL)
        status = fail(messages, SELAS_NO_MEMORY, "no memory for loads");
    if (status == SELAS_OK && scene->body.file != NULL) status = check_areas(tl, messages);
    status = tl_agree(tl, status, messages);
    for (size_t k = 0; k < scene->loads && status == SELAS_OK; k++) {
        const struct load *load = &scene->load[k];
        if (load_moves(load))
            status = fail(messages, SELAS_UNSUPPORTED, "total-Lagrangian points take no moving loads");
        if (status != SELAS_OK || gather.force == NULL) break;
        memset(gather.force, 0, n * sizeof(double));
        status = collect_load(tl, load, &gather);
        if (status == SELAS_OK) status = compress(tl, gather.force, &tl->load[k], messages);
        status = tl_agree(tl, status, messages);
    }
    array_free(gather.force);
    return status;
}
