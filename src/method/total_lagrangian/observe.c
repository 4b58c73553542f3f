/* What receivers, profiles and snapshots see of total-Lagrangian SPH: values by moving least squares, stress
 * and strain by the law from the gradients of the points around. */
#include "method/total_lagrangian/total_lagrangian.h"

#include <math.h>
#include <string.h>

selas_status tl_model_probe(struct model *model, const double position[3], struct probe *probe,
                            struct messages *messages)
{
    struct tl_model *tl = (struct tl_model *)model;
    struct tl_value value = {0};
    double place[3];
    body_from_deck(&model->scene->body, position, place);
    const bool own = tl_owns(tl, place);
    selas_status status = own ? tl_value_at(tl, place, &value, messages) : SELAS_OK;
    int holder = own ? 0 : tl_owner(tl, place);
    if (status == SELAS_OK && own)
        status = tl_find_holder(tl, value.count + value.sites, value.source, &holder, messages);
    if (holder != ranks_me(tl->part.ranks)) value.count = value.sites = 0;
    if (status == SELAS_OK) status = probe_allocate(probe, value.count + value.sites, messages);
    if (status != SELAS_OK) return status;
    probe->count = value.count;
    probe->sites = value.sites;
    memcpy(probe->position, position, sizeof probe->position);
    memcpy(probe->index, value.index, (value.count + value.sites) * sizeof *value.index);
    memcpy(probe->weight, value.weight, (value.count + value.sites) * sizeof *value.weight);
    memcpy(probe->gradient, value.gradient, 3 * value.count * sizeof *value.gradient);
    probe->material = tl->material[value.heaviest];
    probe->holder = holder;
    return SELAS_OK;
}

static void turn_tensor(const double frame[3][3], double six[6])
{
    static const int place[3][3] = {{0, 3, 5}, {3, 1, 4}, {5, 4, 2}};
    const double own[6] = {six[0], six[1], six[2], six[3], six[4], six[5]};
    for (int a = 0; a < 3; a++)
        for (int b = a; b < 3; b++) {
            double sum = 0;
            for (int c = 0; c < 3; c++)
                for (int e = 0; e < 3; e++)
                    sum += frame[a][c] * own[place[c][e]] * frame[b][e];
            six[place[a][b]] = sum;
        }
}

/* Stress, strain, pressure or energy from H (and velocity) at one place. */
static void nonlinear_field(const struct model *model, const struct material *material,
                            const struct elastic *elastic, const double *H, const double *velocity,
                            selas_field field, double *value)
{
    double stress[6];
    double strain[6];
    elastic_observe(elastic, H, stress, strain);
    if (field == SELAS_PRESSURE) value[0] = -(stress[0] + stress[1] + stress[2]) / 3;
    if (field == SELAS_ENERGY) {
        value[0] = elastic_energy(elastic, H);
        for (int a = 0; a < elastic->dimension; a++)
            value[0] += 0.5 * material->density * velocity[a] * velocity[a];
    }
    if (field != SELAS_STRESS && field != SELAS_STRAIN) return;
    double *six = field == SELAS_STRESS ? stress : strain;
    if (model->frame != NULL) turn_tensor(model->frame, six);
    memcpy(value, six, sizeof stress);
}

static bool is_vector(selas_field field)
{
    return field == SELAS_DISPLACEMENT || field == SELAS_VELOCITY || field == SELAS_ACCELERATION;
}

/* A vector near ghosts, in the body's frame: these carry what faces do to the motion beside them. */
static void vector_of_sites(const struct tl_model *tl, const struct probe *probe, const double *field,
                            const double *amplitude, double *value)
{
    const size_t d = (size_t)tl->cloud->dimension, n = tl->cloud->points;
    for (size_t k = probe->count; k < probe->count + probe->sites; k++)
        for (size_t c = 0; c < d; c++) {
            const size_t site = probe->index[k];
            const double u =
                site < n ? field[d * site + c] : tl_ghost_value(tl, field, site - n, c, amplitude);
            value[c] += probe->weight[k] * u;
        }
}

/* Stress and strain at a place: from H of the points around, interpolated. (The gradient of the interpolated
 * displacements would do for smooth ones, but it magnifies what is left of hourglass modes.) */
void tl_observe(struct model *model, const struct probe *probe, selas_field field, const double *y,
                const double *a, double *value)
{
    const struct tl_model *tl = (const struct tl_model *)model;
    const size_t d = (size_t)tl->cloud->dimension;
    double place[3];
    body_from_deck(&model->scene->body, probe->position, place);
    if (is_vector(field) && probe->sites > 0) {
        double vector[3] = {0};
        const bool displaced = field == SELAS_DISPLACEMENT, moves = field == SELAS_VELOCITY;
        vector_of_sites(tl, probe,
                        displaced ? y
                        : moves   ? y + model->unknowns
                                  : a,
                        displaced ? tl->displacement
                        : moves   ? tl->velocity
                                  : tl->acceleration,
                        vector);
        body_direction_to_deck(&model->scene->body, vector, value);
        return;
    }
    if (is_vector(field)) {
        probe_observe(model, probe, field, y, a, value);
        for (int axis = 0; axis < (int)d && model->frame == NULL; axis++)
            if (tl_on_mirror(tl, place, axis)) value[axis] = 0;
        return;
    }
    double H[9] = {0};
    double velocity[3] = {0};
    for (size_t k = 0; k < probe->count; k++) {
        double point[9];
        tl_gradient_at(tl, y, probe->index[k], point);
        for (size_t c = 0; c < d * d; c++)
            H[c] += probe->weight[k] * point[c];
        for (size_t c = 0; c < d; c++)
            velocity[c] += probe->weight[k] * y[model->unknowns + d * probe->index[k] + c];
    }
    for (int axis = 0; axis < (int)d; axis++)
        for (int c = 0; c < (int)d; c++)
            if (c != axis && tl_on_mirror(tl, place, axis)) H[axis * (int)d + c] = H[c * (int)d + axis] = 0;
    const struct elastic elastic = elastic_of(probe->material, tl->options.law, (int)d, model->scene->plane);
    nonlinear_field(model, probe->material, &elastic, H, velocity, field, value);
}

void tl_field(struct model *model, selas_field field, const double *y, const double *a, size_t from,
              size_t end, double *value)
{
    struct tl_model *tl = (struct tl_model *)model;
    const size_t d = (size_t)tl->cloud->dimension;
    const size_t components = (size_t)field_components(field);
    const double *own = y;
    if (field == SELAS_VELOCITY) own = y + model->unknowns;
    if (field == SELAS_ACCELERATION) own = a;
    if (!is_vector(field)) {
        tl_sites(tl, y, NULL, tl->displacement, NULL);
        tl_all_gradients(tl);
    }
    from -= tl->cloud->first;
    end -= tl->cloud->first;
    for (size_t i = from; i < end; i++) {
        double *out = value + components * (i - from);
        if (!is_vector(field)) {
            double H[9];
            tl_tensor(tl, i, H);
            nonlinear_field(model, tl->material[i], &tl->elastic[i], H, y + model->unknowns + d * i, field,
                            out);
            continue;
        }
        double vector[3] = {0};
        memcpy(vector, own + d * i, d * sizeof *own);
        body_direction_to_deck(&model->scene->body, vector, out);
    }
}
