/* What acts on the faces of a cloud: points that are held, and tractions.
 *
 * The virtual work of a traction t on the boundary operator is sum over the face's points of A_i t.u_i; a
 * patch weighs the areas with the part of each element that it covers, changed as little as may be so that
 * its area and its first moments are exact. */
#include "method/cloud/cloud.h"

#include "base/memory.h"
#include "points/disc.h"

#include <math.h>
#include <string.h>

selas_status cloud_hold(struct tl_model *tl, struct messages *messages)
{
    const struct scene *scene = tl->model.scene;
    const size_t d = (size_t)scene->dimension;
    unsigned char *mark = array_new(d * tl->cloud->points, sizeof *mark);
    if (mark == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for %zu points", tl->cloud->points);
    selas_status status = SELAS_OK;
    for (size_t e = 0; e < tl->cloud->elements && status == SELAS_OK; e++) {
        const struct face_element *element = &tl->cloud->element[e];
        const size_t i = neighbours_nearest(&tl->near, element->position);
        for (size_t c = 0; c < d; c++)
            if (face_holds(scene, (enum face)element->face, (int)c)) mark[d * i + c] = 1;
    }
    size_t count = 0;
    for (size_t k = 0; k < d * tl->cloud->points; k++)
        count += mark[k];
    tl->held = array_new(count, sizeof *tl->held);
    if (tl->held == NULL) {
        array_free(mark);
        return fail(messages, SELAS_NO_MEMORY, "no memory for %zu held components", count);
    }
    for (size_t k = 0; k < d * tl->cloud->points && status == SELAS_OK; k++)
        if (mark[k]) tl->held[tl->held_count++] = k;
    array_free(mark);
    return status;
}

struct patch {
    size_t count;
    size_t *point;
    double *weight;
    double *basis; /* [3 * count]: 1 and the place in the face relative to the centre, in spacings */
};

/* Part [0, 1] of [a, b] that lies in [low, high], its middle relative to `low`. */
static double shared(double a, double b, double low, double high)
{
    return fmax(0, fmin(b, high) - fmax(a, low));
}

/* Area and first moments, in spacings, of the part of a square or disc that lies on the face. */
static void patch_moments(const struct body *body, const struct load *load, const double centre[3],
                          const int *axis, int axes, double spacing, double moment[3])
{
    double low[2] = {0}, high[2] = {1, 1};
    for (int a = 0; a < axes; a++) {
        const double half = 0.5 * load->size[load->shape == LOAD_DISC ? 0 : a];
        low[a] = fmax(-half, body->low[axis[a]] - centre[axis[a]]);
        high[a] = fmax(low[a], fmin(half, body->high[axis[a]] - centre[axis[a]]));
    }
    moment[0] = (high[0] - low[0]) * (high[1] - low[1]);
    moment[1] = moment[0] * (low[0] + high[0]) / 2;
    moment[2] = axes > 1 ? moment[0] * (low[1] + high[1]) / 2 : 0;
    if (load->shape == LOAD_DISC && axes > 1) disc_and_rectangle(low, high, 0.5 * load->size[0], moment);
    moment[1] /= spacing;
    moment[2] /= spacing;
}

/* Points of the face with the parts of their cells that the patch covers. A cell is taken as the square of
 * its area about the point, kept inside the face. */
static void cover(const struct tl_model *tl, const struct load *load, const double centre[3], const int *axis,
                  int axes, struct patch *patch)
{
    const struct body *body = &tl->model.scene->body;
    for (size_t e = 0; e < tl->cloud->elements; e++) {
        const struct face_element *element = &tl->cloud->element[e];
        if (element->face != (int)load->face) continue;
        double part = 1;
        double cell = 1;
        double away = 0;
        double *p = patch->basis + (1 + (size_t)axes) * patch->count;
        p[0] = 1;
        for (int a = 0; a < axes; a++) {
            const int c = axis[a];
            const double x = element->position[c];
            const double low = fmax(x - 0.5 * tl->cloud->spacing, body->low[c]);
            const double high = fmin(x + 0.5 * tl->cloud->spacing, body->high[c]);
            const double half = 0.5 * load->size[load->shape == LOAD_DISC ? 0 : a];
            if (load->shape == LOAD_SQUARE) part *= shared(low, high, centre[c] - half, centre[c] + half);
            cell *= high - low;
            p[1 + a] = (x - centre[c]) / tl->cloud->spacing;
            away += p[1 + a] * p[1 + a];
        }
        if (load->shape == LOAD_SQUARE) part /= cell;
        if (load->shape == LOAD_DISC) /* from the rim inwards over one spacing */
            part = fmin(1, fmax(0, 0.5 * load->size[0] / tl->cloud->spacing - sqrt(away) + 0.5));
        if (!(part > 0)) continue;
        patch->point[patch->count] = neighbours_nearest(&tl->near, element->position);
        patch->weight[patch->count++] = part * element->area;
    }
}

selas_status cloud_traction(struct tl_model *tl, const struct load *load, const double centre[3],
                            const double direction[3], double *force, struct messages *messages)
{
    const size_t d = (size_t)tl->cloud->dimension;
    int axis[2] = {0};
    int axes = 0;
    for (int c = 0; c < (int)d; c++)
        if (c != face_axis(load->face)) axis[axes++] = c;
    struct patch patch = {.point = array_new(tl->cloud->elements, sizeof *patch.point),
                          .weight = array_new(tl->cloud->elements, sizeof *patch.weight),
                          .basis = array_new(3 * tl->cloud->elements, sizeof *patch.basis)};
    selas_status status = SELAS_OK;
    if (patch.point == NULL || patch.weight == NULL || patch.basis == NULL) {
        status = fail(messages, SELAS_NO_MEMORY, "no memory for the load");
    } else {
        cover(tl, load, centre, axis, axes, &patch);
        double moment[3];
        if (load->shape != LOAD_FACE && axes > 0) {
            patch_moments(&tl->model.scene->body, load, centre, axis, axes, tl->cloud->spacing, moment);
            if (patch.count <= (size_t)axes || cloud_fit_weights(patch.count, 1 + (size_t)axes, patch.basis,
                                                                 moment, patch.weight, messages) != SELAS_OK)
                status =
                    fail(messages, SELAS_BAD_SCENE,
                         "a load's patch is too small for the spacing: make it a point load, or the spacing "
                         "smaller");
        }
    }
    for (size_t k = 0; status == SELAS_OK && patch.point != NULL && patch.weight != NULL && k < patch.count;
         k++)
        for (size_t c = 0; c < d; c++)
            force[d * patch.point[k] + c] += load->amplitude * direction[c] * patch.weight[k];
    array_free(patch.point);
    array_free(patch.weight);
    array_free(patch.basis);
    return status;
}
