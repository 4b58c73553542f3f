#include "scene/resolution.h"

#include <math.h>

double source_cutoff(const struct scene *scene)
{
    return source_cutoff_at(scene, SOURCE_COUNTS);
}

/* As many sources of a list have one history. */
static bool as_before(const struct scene *scene, size_t k)
{
    return k > 0 && scene->load[k - 1].amplitude != 0 &&
           history_alike(&scene->load[k - 1].history, &scene->load[k].history);
}

/* Of the histories that the deck has; 0 if it has none. */
static double cutoff_of_deck(const struct scene *scene, double counts)
{
    double omega = 0.0;
    for (size_t k = 0; k < scene->loads; k++)
        if (scene->load[k].amplitude != 0 && !as_before(scene, k))
            omega = fmax(omega, history_cutoff(&scene->load[k].history, counts));
    for (size_t face = 0; face < FACES; face++)
        if (boundary_acts(&scene->boundary[face]))
            omega = fmax(omega, history_cutoff(&scene->boundary[face].history, counts));
    return omega;
}

double source_cutoff_at(const struct scene *scene, double counts)
{
    return scene_driven(scene) ? INFINITY : cutoff_of_deck(scene, counts);
}

double slowest_speed(const struct scene *scene)
{
    double slowest = INFINITY;
    for (size_t m = 0; m < scene->materials; m++)
        slowest =
            fmin(slowest, scene->dimension == 1 ? scene->material[m].p_speed : scene->material[m].s_speed);
    return slowest;
}

double jump_smoothing(double period)
{
    return 8 / pow(SOURCE_COUNTS, .25) * period / 6.283185307179586477;
}

/* The source's cutoff of waves ahead of the loads: one that runs after them crowds them (faster than they it is told of
 * for itself). */
static double cutoff_ahead(const struct scene *scene, double speed)
{
    double omega = cutoff_of_deck(scene, SOURCE_COUNTS);
    for (size_t k = 0; k < scene->loads; k++) {
        const double *velocity = scene->load[k].velocity;
        const double own =
            sqrt(velocity[0] * velocity[0] + velocity[1] * velocity[1] + velocity[2] * velocity[2]);
        if (own > 0 && own < .92 * speed && scene->load[k].amplitude != 0)
            omega = fmax(omega, history_cutoff(&scene->load[k].history, SOURCE_COUNTS) / (1 - own / speed));
    }
    return omega;
}

double points_per_wavelength(const struct scene *scene)
{
    const double cutoff = cutoff_of_deck(scene, SOURCE_COUNTS), slowest = slowest_speed(scene);
    if (!(cutoff > 0.0) || !isfinite(cutoff) || !isfinite(slowest) || !(scene->body.spacing > 0.0))
        return 0.0;
    return 6.283185307179586477 * slowest / cutoff_ahead(scene, slowest) / scene->body.spacing;
}
