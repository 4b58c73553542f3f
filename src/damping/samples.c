/* The damping of ground from a model (doc/theory/damping.md, section 7): values that stand for all of it where rates
 * and directions are chosen, and weights over 1/Q. */
#include "damping/ground.h"

#include "scene/ground.h"
#include "scene/model_pieces.h"

#include <math.h>

/* About 1/Q of the bulk modulus. */
static double compression(const struct material *material)
{
    const double bulk = material->lambda + 2. / 3 * material->mu;
    return ((bulk + 4. / 3 * material->mu) / material->q_p - 4. / 3 * material->mu / material->q_s) / bulk;
}

/* Classes of log(1/Q_s); the last one has none. */
static size_t class_of(const struct ground_model *model, double q_s)
{
    const double whole = log(model->loss[1] / model->loss[0]);
    if (!(q_s > 0)) return SAMPLE_CLASSES;
    const double part = whole > 0 ? log(1 / q_s / model->loss[0]) / whole : 0;
    return (size_t)fmin(fmax(part, 0) * SAMPLE_CLASSES, SAMPLE_CLASSES - 1);
}

/* Of each class the values whose bulk modulus loses least and most. */
struct sampled {
    const struct ground_model *model;
    struct material found[SAMPLE_CLASSES + 1][2];
    bool any[SAMPLE_CLASSES + 1];
};

static bool sample_box(void *context, const struct model_grid *box, size_t first_column)
{
    (void)first_column;
    struct sampled *sampled = context;
    for (size_t i = 0; i < box->n[0] * box->n[1] * box->n[2]; i++) {
        const struct material value = ground_model_material(sampled->model, box, i);
        const size_t class = class_of(sampled->model, value.q_s);
        struct material *found = sampled->found[class];
        const double loss = compression(&value);
        if (!sampled->any[class]) found[0] = found[1] = value;
        sampled->any[class] = true;
        if (class == SAMPLE_CLASSES) continue;
        if (loss < compression(&found[0])) found[0] = value;
        if (loss > compression(&found[1])) found[1] = value;
    }
    return true;
}

size_t damping_samples(const struct ground_model *model, struct material sample[MOST_SAMPLES])
{
    struct sampled sampled = {.model = model};
    size_t count = 0;
    bool unread;
    for (size_t g = 0; g < model->grids && model->damped; g++)
        model_walk(&model->grid[g], sample_box, &sampled, &unread);
    for (size_t class = 0; class <= SAMPLE_CLASSES; class ++)
        for (size_t k = 0; k < (class < SAMPLE_CLASSES ? 2 : 1) && sampled.any[class]; k++)
            sample[count++] = sampled.found[class][k];
    return count;
}

selas_status damping_curve_set(const struct ground_damping *damping, const struct ground_model *model,
                               struct damping_curve *curve, struct messages *messages)
{
    const double reference = model->q_frequency > 0 ? 2 * M_PI * model->q_frequency : damping->centroid;
    selas_status status = SELAS_OK;
    curve->from = model->loss[0];
    curve->step = fmax(model->loss[1] - model->loss[0], 1e-3 * model->loss[1]) / (CURVE_NODES - 1);
    for (size_t node = 0; node < CURVE_NODES && status == SELAS_OK; node++) {
        const double loss = curve->from + (double)node * curve->step;
        const struct modulus wanted = modulus_power_q(1, 1 / loss, model->q_power, reference);
        status = relaxation_weights(&damping->band, damping->mechanisms, damping->rate, &wanted,
                                    curve->weight[node], messages);
        for (size_t l = 0; l < damping->mechanisms; l++)
            curve->weight[node][l] /= loss;
    }
    return status;
}

void damping_curve_at(const struct damping_curve *curve, size_t mechanisms, double q, double *weight)
{
    const double at = fmin(fmax((1 / q - curve->from) / curve->step, 0), CURVE_NODES - 1);
    const size_t node = at < CURVE_NODES - 2 ? (size_t)at : CURVE_NODES - 2;
    const double part = at - (double)node;
    for (size_t l = 0; l < mechanisms; l++)
        weight[l] = ((1 - part) * curve->weight[node][l] + part * curve->weight[node + 1][l]) / q;
}
