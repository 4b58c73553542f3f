/* What the plan says of damping: mechanisms, Q(f) and c(f) that they reach over the source's band, what they
 * cost. */
#include "method/damped/damped.h"

#include <math.h>
#include <stdio.h>

/* The band: between these shares of the source's energy. */
static const double from_share = .01, to_share = .99;

struct reached {
    double q[2], speed[2]; /* smallest and largest */
    double misfit;         /* largest |M/M_wanted - 1| */
};

static struct reached reached_of(const struct ground_damping *damping, const struct modulus *fitted,
                                 const struct modulus *wanted, double density)
{
    const struct relaxation_band *band = &damping->band;
    const double low = relaxation_quantile(band, from_share), high = relaxation_quantile(band, to_share);
    struct reached reached = {{INFINITY, 0}, {INFINITY, 0}, 0};
    for (size_t k = 0; k < RELAXATION_SAMPLES; k++) {
        const double w = band->angular_frequency[k];
        if (w < low || w > high) continue;
        const double q = 1 / modulus_loss(fitted, w), speed = modulus_speed(fitted, density, w);
        reached.q[0] = fmin(reached.q[0], q);
        reached.q[1] = fmax(reached.q[1], q);
        reached.speed[0] = fmin(reached.speed[0], speed);
        reached.speed[1] = fmax(reached.speed[1], speed);
        reached.misfit =
            fmax(reached.misfit, cabs(modulus_at(fitted, I * w) / modulus_at(wanted, I * w) - 1));
    }
    return reached;
}

/* Of a model: Q that is wanted and the worst that is reached, by its samples. */
static void describe_model(const struct damped *d,
                           void (*tell)(void *context, const char *key, const char *value), void *context)
{
    const struct ground_damping *damping = d->damping;
    const struct scene *scene = d->model.scene;
    struct material sample[MOST_SAMPLES];
    double q[2][2] = {{INFINITY, 0}, {INFINITY, 0}}, off = 0;
    char text[300];
    if (scene->body.model == NULL || !scene->body.model->damped) return;
    const size_t count = damping_samples(scene->body.model, sample);
    for (size_t i = 0; i < count; i++) {
        const struct damped_moduli *fitted = &damping->fitted[scene->materials + i];
        const struct damped_moduli *wanted = &damping->wanted[scene->materials + i];
        const double own[2] = {sample[i].q_p, sample[i].q_s};
        for (int k = 0; k < 2 && own[k] > 0; k++) {
            const struct reached one =
                reached_of(damping, k == 0 ? &fitted->axial : &fitted->shear,
                           k == 0 ? &wanted->axial : &wanted->shear, sample[i].density);
            off = fmax(off, one.misfit * own[k]);
            q[k][0] = fmin(q[k][0], own[k]);
            q[k][1] = fmax(q[k][1], own[k]);
        }
    }
    snprintf(text, sizeof text,
             "Q_p %.4g to %.4g, Q_s %.4g to %.4g in %zu values that stand for all; largest misfit of their "
             "moduli %.2g/Q; %zu values are not damped",
             q[0][0], q[0][1], q[1][0], q[1][1], count, off, scene->body.model->undamped);
    tell(context, "damping of the model", text);
}

static void describe_material(const struct damped *d, size_t index,
                              void (*tell)(void *context, const char *key, const char *value), void *context)
{
    const struct material *material = &d->model.scene->material[index];
    const struct damped_moduli *fitted = &d->damping->fitted[index], *wanted = &d->damping->wanted[index];
    if (!(material->q_p > 0)) return;
    const struct reached p = reached_of(d->damping, &fitted->axial, &wanted->axial, material->density);
    const struct reached s = reached_of(d->damping, &fitted->shear, &wanted->shear, material->density);
    char key[NAME_SIZE + 16], text[400], power[48] = "";
    if (material->q_power != 0) snprintf(power, sizeof power, " times (f/f_ref)^%g", material->q_power);
    snprintf(key, sizeof key, "damping of %s", material->name);
    snprintf(
        text, sizeof text,
        "Q_p %g%s wanted, %.4g to %.4g reached, c_p %.5g to %.5g; Q_s %g%s wanted, %.4g to %.4g reached, c_s "
        "%.5g to %.5g; largest misfit of moduli %.2g; speeds as given at f_ref = %.4g",
        material->q_p, power, p.q[0], p.q[1], p.speed[0], p.speed[1], material->q_s, power, s.q[0], s.q[1],
        s.speed[0], s.speed[1], fmax(p.misfit, s.misfit), wanted->shear.angular_frequency / (2 * M_PI));
    tell(context, key, text);
}

void damped_describe(const struct model *model,
                     void (*tell)(void *context, const char *key, const char *value), void *context)
{
    const struct damped *d = (const struct damped *)model;
    const struct ground_damping *damping = d->damping;
    const struct model *first = d->part[0].model;
    char text[400];
    if (first->core->describe != NULL) first->core->describe(first, tell, context);
    int at = snprintf(text, sizeof text, "%zu relaxation mechanisms, misfit %.2g/Q, at frequencies",
                      damping->mechanisms, damping->misfit);
    for (size_t l = 0; l < damping->mechanisms; l++)
        at += snprintf(text + at, sizeof text - (size_t)at, " %.4g", damping->rate[l] / (2 * M_PI));
    snprintf(text + at, sizeof text - (size_t)at, "; source between %.4g and %.4g, centroid %.4g",
             relaxation_quantile(&damping->band, from_share) / (2 * M_PI),
             relaxation_quantile(&damping->band, to_share) / (2 * M_PI), damping->centroid / (2 * M_PI));
    tell(context, "damping", text);
    for (size_t i = 0; i < deck_count(d->model.scene->deck, "material"); i++)
        describe_material(d, i, tell, context);
    describe_model(d, tell, context);
    const size_t dimension = (size_t)d->model.scene->dimension;
    const char *calls = d->parts == 1             ? "operator call a step"
                        : model->one_pass != NULL ? "operators in one call a step"
                                                  : "operator calls a step";
    snprintf(text, sizeof text, "%zu %s in place of 1; %zu memory variables a point, %zu bytes", d->parts,
             calls, dimension * damping->mechanisms, 8 * dimension * damping->mechanisms);
    tell(context, "damping adds", text);
}
