/* Weights by which updated-Lagrangian SPH takes values at a place of the undeformed body. */
#include "base/memory.h"
#include "method/updated_lagrangian/updated_lagrangian.h"
#include "points/least_squares.h"

#include <math.h>
#include <string.h>

/* Does a place hold a particle, or its image in walls that prescribe how they move? */
static bool moves_as_told(const struct updated *updated, size_t place)
{
    if (place < updated->points) return true;
    const struct updated_ghost *ghost = &updated->ghost[place - updated->points];
    for (int f = 0; f < ghost->count; f++)
        if (updated->wall[ghost->face[f]] == WALL_TRACTION) return false;
    return true;
}

static size_t source_of(const struct updated *updated, size_t place)
{
    const size_t points = updated->points;
    return place < points ? place : updated->ghost[place - points].source;
}

/* Particles of the undeformed body, and with `walls` their images, within a radius of a place: how many, and with
 * `index` which and where. */
static size_t around(const struct updated *updated, const double place[3], bool walls, double radius,
                     size_t *index, double *offset)
{
    const size_t points = updated->points;
    size_t count = 0;
    for (size_t i = 0; i < points + (walls ? updated->ghosts : 0); i++) {
        double d[3], square = 0;
        for (size_t a = 0; a < 3; a++) {
            d[a] = updated->reference[3 * i + a] - place[a];
            square += d[a] * d[a];
        }
        if (!(square < radius * radius) || !moves_as_told(updated, i)) continue;
        if (index != NULL) {
            index[count] = i;
            memcpy(offset + 3 * count, d, sizeof d);
        }
        count++;
    }
    return count;
}

/* Fits a polynomial of the degree to the particles within the radius; SELAS_NOT_CONVERGED if they do not span
 * it. */
static selas_status fit_probe(const struct updated *updated, const double place[3], bool walls, int degree,
                              double radius, struct probe *probe, struct messages *messages)
{
    const size_t count = around(updated, place, walls, radius, NULL, NULL);
    if (count < fit_terms(updated->dimension, degree)) return SELAS_NOT_CONVERGED;
    const selas_status status = probe_allocate(probe, count, messages);
    if (status != SELAS_OK) return status;
    double *offset = array_new((3 + 1 + FIT_TERMS) * count, sizeof *offset);
    if (offset == NULL) {
        probe_free(probe);
        return fail(messages, SELAS_NO_MEMORY, "no memory for the weights of a receiver");
    }
    double *weight = offset + 3 * count;
    around(updated, place, walls, radius, probe->index, offset);
    for (size_t j = 0; j < count; j++) {
        const double *d = offset + 3 * j;
        const double r = sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        weight[j] = updated->cloud->volume[source_of(updated, probe->index[j])] *
                    kernel_value(updated->options.kernel, updated->dimension, r,
                                 radius / updated->options.kernel->support);
    }
    const struct fit fit = {updated->dimension, degree, radius, count, offset, weight, weight + count};
    const bool spans = fit_free(&fit, probe->weight, probe->gradient);
    array_free(offset);
    if (spans) return SELAS_OK;
    probe_free(probe);
    return SELAS_NOT_CONVERGED;
}

/* Moving least squares with the method's kernel: a quadratic where the particles span one (it leaves a front
 * that is several spacings wide as it is, and averages what alternates from particle to particle), else a
 * straight line. Places outside the outermost particles are extrapolated. */
static selas_status fit_around(const struct updated *updated, const double place[3], bool walls,
                               struct probe *probe, struct messages *messages)
{
    selas_status status = SELAS_NOT_CONVERGED;
    for (int degree = 2; degree >= 1 && status == SELAS_NOT_CONVERGED; degree--)
        for (double factor = 1; factor < 2 && status == SELAS_NOT_CONVERGED; factor *= 1.2)
            status = fit_probe(updated, place, walls, degree, factor * updated->reach, probe, messages);
    if (status == SELAS_NOT_CONVERGED)
        return fail(messages, status, "too few particles around a receiver to interpolate");
    return status;
}

/* Beside walls motions are taken from images, too, so that on the wall they are what it prescribes: weights of these,
 * behind the probe's own. */
static selas_status see_walls(const struct updated *updated, const double place[3], struct probe *probe,
                              struct messages *messages)
{
    struct probe seen = {0}, both = {0};
    bool walls = false;
    selas_status status = fit_around(updated, place, true, &seen, messages);
    for (size_t k = 0; k < seen.count; k++)
        walls = walls || seen.index[k] >= updated->points;
    if (walls) status = probe_allocate(&both, probe->count + seen.count, messages);
    if (walls && status == SELAS_OK) {
        const size_t count = probe->count;
        memcpy(both.index, probe->index, count * sizeof *both.index);
        memcpy(both.weight, probe->weight, count * sizeof *both.weight);
        memcpy(both.gradient, probe->gradient, 3 * count * sizeof *both.gradient);
        memcpy(both.index + count, seen.index, seen.count * sizeof *both.index);
        memcpy(both.weight + count, seen.weight, seen.count * sizeof *both.weight);
        probe_free(probe);
        *probe = both;
        probe->count = count;
        probe->sites = seen.count;
    }
    probe_free(&seen);
    return status;
}

/* The particles of the cloud and their ghosts in place of those here. */
static selas_status all_at_rest(const struct updated *updated, struct updated *rest,
                                struct messages *messages)
{
    const size_t points = updated->cloud->points;
    *rest = *updated;
    rest->points = points;
    rest->ghosts = 0;
    rest->ghost = NULL;
    rest->reference = array_new(3 * points, sizeof *rest->reference);
    if (rest->reference == NULL)
        return fail(messages, SELAS_NO_MEMORY, "no memory for %zu particles", points);
    memcpy(rest->reference, updated->cloud->position, 3 * points * sizeof *rest->reference);
    return updated_ghosts_create(rest, messages);
}

/* Weights of the particles of `rest`. */
static selas_status fit_place(const struct updated *rest, const double place[3], struct probe *probe,
                              struct messages *messages)
{
    const selas_status status = fit_around(rest, place, false, probe, messages);
    return status == SELAS_OK && rest->ghosts > 0 ? see_walls(rest, place, probe, messages) : status;
}

/* The same by numbers in the cloud: of particles, and of those that images are of, with bits of their faces in
 * *faces. */
static selas_status probe_at_rest(const struct updated *updated, const double place[3], struct probe *probe,
                                  unsigned **faces, struct messages *messages)
{
    struct updated rest = *updated;
    const bool shared = updated->part.ranks != NULL;
    selas_status status = shared ? all_at_rest(updated, &rest, messages) : SELAS_OK;
    if (status == SELAS_OK) status = fit_place(&rest, place, probe, messages);
    *faces = status == SELAS_OK && rest.reference != NULL
                 ? array_new(probe->count + probe->sites, sizeof **faces)
                 : NULL;
    if (status == SELAS_OK && *faces == NULL) {
        probe_free(probe);
        status = fail(messages, SELAS_NO_MEMORY, "no memory for the weights of a receiver");
    }
    for (size_t k = 0; status == SELAS_OK && *faces != NULL && k < probe->count + probe->sites; k++) {
        const size_t at = probe->index[k];
        probe->index[k] = source_of(&rest, at);
        for (int f = 0; at >= rest.points && f < rest.ghost[at - rest.points].count; f++)
            (*faces)[k] |= 1U << rest.ghost[at - rest.points].face[f];
    }
    if (shared) {
        array_free(rest.reference);
        array_free(rest.ghost);
    }
    return status;
}

selas_status updated_reads(const struct updated *updated, const double position[3], size_t *from, size_t *end,
                           struct messages *messages)
{
    struct probe probe = {0};
    unsigned *faces;
    double place[3];
    body_from_deck(&updated->model.scene->body, position, place);
    const selas_status status = probe_at_rest(updated, place, &probe, &faces, messages);
    *from = updated->cloud->whole;
    *end = 0;
    for (size_t k = 0; status == SELAS_OK && k < probe.count + probe.sites; k++) {
        const size_t point = updated->cloud->first + probe.index[k];
        *from = point < *from ? point : *from;
        *end = point + 1 > *end ? point + 1 : *end;
    }
    array_free(faces);
    if (status == SELAS_OK) probe_free(&probe);
    return status;
}

/* A probe reads rows of the state, and images at `held` times the bits of their faces beyond their particle's. */
static selas_status read_rows(const struct updated *updated, const unsigned *faces, struct probe *probe,
                              struct messages *messages)
{
    for (size_t k = 0; k < probe->count + probe->sites; k++) {
        const size_t row = updated->cloud->first + probe->index[k] - updated->first;
        if (row >= updated->held)
            return fail(messages, SELAS_UNSUPPORTED,
                        "the particles about (%g, %g, %g), from which a value is taken, are on no rank "
                        "together: take fewer ranks",
                        probe->position[0], probe->position[1], probe->position[2]);
        probe->index[k] = row + updated->held * faces[k];
    }
    return SELAS_OK;
}

selas_status updated_probe(struct model *model, const double position[3], struct probe *probe,
                           struct messages *messages)
{
    const struct updated *updated = updated_of(model);
    double place[3];
    unsigned *faces = NULL;
    body_from_deck(&model->scene->body, position, place);
    const int holder = updated->part.ranks != NULL ? updated_owner(updated, place) : 0;
    const bool here = holder == ranks_me(updated->part.ranks);
    selas_status status =
        here ? probe_at_rest(updated, place, probe, &faces, messages) : probe_allocate(probe, 0, messages);
    if (status != SELAS_OK) return status;
    memcpy(probe->position, position, sizeof probe->position);
    probe->material = updated->material;
    probe->holder = holder;
    if (here) status = read_rows(updated, faces, probe, messages);
    array_free(faces);
    if (status != SELAS_OK) probe_free(probe);
    return status;
}
