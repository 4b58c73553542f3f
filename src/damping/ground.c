/* Rates are common to all materials and suit the middle one of all Q; weights are fitted material by material
 * (relaxation.c). */
#include "damping/directions.h"
#include "damping/source.h"

#include "base/memory.h"
#include "scene/resolution.h"
#include <math.h>
#include <stdlib.h>
#include <string.h>

/* --- The band ------------------------------------------------------------------------------------------ */

/* Where the source is not known: a decade on each side of the reference. */
static double flat_power(const void *reference, double angular_frequency)
{
    const double relative = angular_frequency / *(const double *)reference;
    return relative < .1 ? 0 : 1 / relative;
}

static double reference_given(const struct scene *scene)
{
    for (size_t i = 0; i < scene->materials; i++)
        if (scene->material[i].q_frequency > 0) return 2 * M_PI * scene->material[i].q_frequency;
    return 0;
}

static selas_status set_band(const struct scene *scene, struct ground_damping *damping,
                             struct messages *messages)
{
    const double top = source_top(scene, 1e-3), given = reference_given(scene);
    const struct stepping_choice *stepping = &scene->stepping;
    if (top > 0 && isfinite(top))
        relaxation_band_set(&damping->band, top, source_power, scene);
    else if (given > 0)
        relaxation_band_set(&damping->band, 10 * given, flat_power, &given);
    else
        return fail(
            messages, SELAS_BAD_SCENE,
            "damping is fitted to the spectrum of loads and moved faces, and there is none here; give "
            "material%%q_frequency");
    damping->centroid = relaxation_centroid(&damping->band);
    damping->band.by.dt = stepping->time_step;
    if (stepping->courant > 0)
        damping->band.by.dt = stepping->courant * scene->body.spacing / scene_fastest(scene);
    /* the scheme of a body that moves at t = 0, too, if the deck names none */
    damping->band.by.corrected = strcmp(stepping->scheme, "modified-equation") == 0 ||
                                 (stepping->scheme[0] == '\0' && scene->initial.kind != INITIAL_REST);
    return SELAS_OK;
}

/* --- Materials ---------------------------------------------------------------------------------------- */

static struct damped_moduli wanted_of(const struct material *material, double centroid)
{
    const double axial = material->lambda + 2 * material->mu, shear = material->mu;
    const double reference = material->q_frequency > 0 ? 2 * M_PI * material->q_frequency : centroid;
    if (!(material->q_p > 0)) return (struct damped_moduli){modulus_elastic(axial), modulus_elastic(shear)};
    return (struct damped_moduli){modulus_power_q(axial, material->q_p, material->q_power, reference),
                                  modulus_power_q(shear, material->q_s, material->q_power, reference)};
}

static int by_loss(const void *one, const void *other)
{
    const double a = ((const struct modulus *)one)->power, b = ((const struct modulus *)other)->power;
    return (a < b) - (a > b);
}

/* The modulus with the middle one of all Q. */
static selas_status choose_rates(struct ground_damping *damping, struct messages *messages)
{
    struct modulus *damped = array_new(2 * damping->materials, sizeof *damped);
    size_t count = 0;
    if (damped == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the damping of the ground");
    for (size_t i = 0; i < damping->materials; i++)
        if (damping->wanted[i].shear.power > 0) {
            damped[count++] = damping->wanted[i].axial;
            damped[count++] = damping->wanted[i].shear;
        }
    qsort(damped, count, sizeof *damped, by_loss);
    const selas_status status = relaxation_rates(&damping->band, &damped[count / 2], damping->mechanisms,
                                                 damping->rate, &damping->misfit, messages);
    array_free(damped);
    return status;
}

static selas_status set_wanted(const struct scene *scene, const struct material *sample,
                               struct ground_damping *damping, struct messages *messages)
{
    const selas_status status = set_band(scene, damping, messages);
    for (size_t i = 0; i < damping->materials; i++)
        damping->wanted[i] = damping->fitted[i] = wanted_of(
            i < scene->materials ? &scene->material[i] : &sample[i - scene->materials], damping->centroid);
    return status;
}

static selas_status fit(const struct scene *scene, struct ground_damping *damping, struct messages *messages)
{
    damping->mechanisms = scene->method.mechanisms;
    selas_status status = choose_rates(damping, messages);
    for (size_t i = 0; i < damping->materials && status == SELAS_OK; i++)
        if (damping->wanted[i].shear.power > 0)
            status = relaxation_fit(&damping->band, damping->mechanisms, damping->rate,
                                    &damping->fitted[i].axial, &damping->fitted[i].shear, messages);
    if (status == SELAS_OK) status = damping_directions(damping, messages);
    return status;
}

selas_status ground_damping_new(const struct scene *scene, bool fitted, struct ground_damping **made,
                                struct messages *messages)
{
    *made = NULL;
    if (!ground_is_damped(scene)) return SELAS_OK;
    struct ground_damping *damping = array_new(1, sizeof *damping);
    if (damping == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the damping of the ground");
    struct material sample[MOST_SAMPLES] = {{.density = 0}};
    damping->materials = scene->materials;
    if (scene->body.model != NULL) damping->materials += damping_samples(scene->body.model, sample);
    damping->wanted = array_new(damping->materials, sizeof *damping->wanted);
    damping->fitted = array_new(damping->materials, sizeof *damping->fitted);
    if (damping->wanted == NULL || damping->fitted == NULL) {
        ground_damping_free(damping);
        return fail(messages, SELAS_NO_MEMORY, "no memory for the damping of the ground");
    }
    selas_status status = set_wanted(scene, sample, damping, messages);
    if (status == SELAS_OK && fitted) status = fit(scene, damping, messages);
    if (status == SELAS_OK)
        *made = damping;
    else
        ground_damping_free(damping);
    return status;
}

static double modulus_off(const struct relaxation_band *band, const struct modulus *fitted,
                          const struct modulus *wanted)
{
    double sum = 0, all = 0;
    for (size_t k = 0; k < RELAXATION_SAMPLES; k++) {
        const double complex s = I * band->angular_frequency[k];
        const double off = cabs(modulus_at(fitted, s) / modulus_at(wanted, s) - 1);
        sum += band->weight[k] * off * off;
        all += band->weight[k];
    }
    return sqrt(sum / all);
}

double ground_damping_off(const struct ground_damping *damping)
{
    double most = 0;
    for (size_t i = 0; i < damping->materials; i++) {
        const struct damped_moduli *fitted = &damping->fitted[i], *wanted = &damping->wanted[i];
        if (!(wanted->shear.power > 0)) continue;
        most = fmax(most, modulus_off(&damping->band, &fitted->axial, &wanted->axial));
        most = fmax(most, modulus_off(&damping->band, &fitted->shear, &wanted->shear));
    }
    return most;
}

static double rings_off(const struct modulus *fitted, const struct modulus *wanted, double frequency,
                        double end_time)
{
    const double w = 2 * M_PI * frequency, fades = 1 / modulus_loss(wanted, w);
    return fmin(M_PI * frequency * end_time, fades) *
           cabs(modulus_at(fitted, I * w) / modulus_at(wanted, I * w) - 1);
}

double ground_damping_rings(const struct ground_damping *damping, double lowest, double end_time)
{
    static const double next = 1.2;
    const double band = relaxation_held(&damping->band, 0) / (2 * M_PI);
    double most = 0;
    for (double f = fmax(lowest, 1 / end_time); f < band && f > 0; f *= next)
        for (size_t i = 0; i < damping->materials; i++) {
            const struct damped_moduli *fitted = &damping->fitted[i], *wanted = &damping->wanted[i];
            if (!(wanted->shear.power > 0)) continue;
            most = fmax(most, rings_off(&fitted->axial, &wanted->axial, f, end_time));
            most = fmax(most, rings_off(&fitted->shear, &wanted->shear, f, end_time));
        }
    return most;
}

void ground_damping_free(struct ground_damping *damping)
{
    if (damping == NULL) return;
    array_free(damping->wanted);
    array_free(damping->fitted);
    array_free(damping);
}
