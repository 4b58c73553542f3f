/* Where total-Lagrangian SPH takes the value at a place from: moving least squares over the points around, and over
 * ghosts, by which the value on a face is what the face prescribes. */
#include "method/total_lagrangian/total_lagrangian.h"

#include "points/least_squares.h"

#include <math.h>

double tl_probe_radius(const struct tl_model *tl)
{
    const struct body *body = &tl->model.scene->body;
    const double four = tl->options.central ? 2.5 * tl_plane_step(tl) : 0;
    return fmax(tl->near.radius, four) + body->jitter * body->spacing;
}

/* What a fit at a place takes within a radius. */
struct taken {
    size_t count;
    bool full; /* there was no room for all */
    size_t *index;
    double offset[3 * TL_PROBE_ROOM], kernel[TL_PROBE_ROOM];
};

static void take(const struct tl_model *tl, const double place[3], double radius, double spacing, size_t site,
                 struct taken *taken)
{
    const size_t n = tl->cloud->points;
    const double *position = site < n ? tl->cloud->position + 3 * site : tl->site_position + 3 * site;
    double square = 0, *offset = taken->offset + 3 * taken->count, *kernel = &taken->kernel[taken->count];
    if (taken->count == TL_PROBE_ROOM) {
        taken->full = true;
        return;
    }
    for (size_t c = 0; c < 3; c++) {
        offset[c] = position[c] - place[c];
        square += offset[c] * offset[c];
    }
    *kernel = kernel_value(tl->options.kernel, tl->cloud->dimension, sqrt(square),
                           radius / tl->options.kernel->support);
    *kernel *= site < n ? tl->cloud->volume[site] : tl->ghost[site - n].volume;
    if (tl->options.form != NULL) /* interpolates: a receiver at a point reads that point */
        *kernel /= 1e-6 + square / (spacing * spacing);
    if (*kernel > 0) taken->index[taken->count++] = site;
}

/* Weights of the value and of its gradient at a place by moving least squares. */
static selas_status fit_at(struct tl_model *tl, const double place[3], size_t ghosts, struct taken *taken,
                           double *weight, double *gradient, struct messages *messages)
{
    double work[FIT_TERMS * TL_PROBE_ROOM];
    const size_t wanted = tl_wanted(tl);
    size_t near = neighbours_at(&tl->near, place, tl->cloud->points, tl->found);
    const size_t nearest = neighbours_nearest(&tl->near, place);
    if (tl_has_gaps(tl) && near > 0) near = tl_connected(tl, nearest, near, tl->found);
    const double spacing = nearest < tl->cloud->points ? tl->spacing[nearest] : tl->cloud->spacing;
    double radius = tl_radius(tl) * spacing / tl->cloud->spacing;
    while (radius <= tl->near.radius * (1 + 1e-9)) {
        taken->count = 0;
        for (size_t k = 0; k < near; k++)
            take(tl, place, radius, spacing, tl->found[k], taken);
        for (size_t g = 0; g < ghosts; g++)
            take(tl, place, radius, spacing, tl->cloud->points + g, taken);
        const struct fit fit = {tl->cloud->dimension, tl->options.degree, radius, taken->count,
                                taken->offset,        taken->kernel,      work};
        if (taken->full)
            return fail(
                messages, SELAS_UNSUPPORTED,
                "more than %d points lie within the kernel about (%g, %g, %g); a smaller smoothing_length "
                "would be right",
                TL_PROBE_ROOM, place[0], place[1], place[2]);
        const bool enough = taken->count >= wanted || radius * 1.05 > tl->near.radius;
        if (enough && fit_free(&fit, weight, gradient)) return SELAS_OK;
        radius *= 1.05;
    }
    return fail(messages, SELAS_BAD_SCENE, "no points near (%g, %g, %g) to take a value from", place[0],
                place[1], place[2]);
}

selas_status tl_probe(struct tl_model *tl, const double body_position[3], size_t *count, size_t *index,
                      double *weight, double *gradient, struct messages *messages)
{
    if (tl->options.central) {
        *count = tl_lattice_probe(tl, body_position, false, index, weight, gradient);
        return SELAS_OK;
    }
    struct taken taken = {.index = index};
    const selas_status status = fit_at(tl, body_position, 0, &taken, weight, gradient, messages);
    *count = taken.count;
    return status;
}

selas_status tl_value_at(struct tl_model *tl, const double place[3], struct tl_value *value,
                         struct messages *messages)
{
    double unused[3 * TL_PROBE_ROOM];
    size_t heaviest = 0;
    selas_status status =
        tl_probe(tl, place, &value->count, value->index, value->weight, value->gradient, messages);
    for (size_t k = 1; k < value->count; k++)
        if (fabs(value->weight[k]) > fabs(value->weight[heaviest])) heaviest = k;
    value->heaviest = value->index[heaviest];
    struct taken taken = {.index = value->index + value->count};
    double *weight = value->weight + value->count;
    if (status == SELAS_OK && tl->ghosts > 0 && tl->options.central)
        taken.count = tl_lattice_probe(tl, place, true, taken.index, weight, unused);
    else if (status == SELAS_OK && tl->ghosts > 0)
        status = fit_at(tl, place, tl->ghosts, &taken, weight, unused, messages);
    value->sites = 0;
    for (size_t k = 0; k < taken.count; k++)
        if (taken.index[k] >= tl->cloud->points) value->sites = taken.count;
    for (size_t k = 0; k < value->count + value->sites; k++)
        value->source[k] = tl_source(tl, value->index[k]);
    return status;
}
