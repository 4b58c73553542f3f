/* Relaxation mechanisms of a scene's ground: rates common to all materials, fitted to the loads' spectrum. */
#include "exact/layered_damping.h"

#include "base/memory.h"
#include "damping/relaxation.h"

#include <math.h>
#include <stdlib.h>

/* Squared spectrum of the velocities that the loads make: their rates, and of moment tensors, far away, the
 * rates of those. */
static double source_power(const void *data, double angular_frequency)
{
    const struct scene *scene = data;
    double sum = 0;
    for (size_t i = 0; i < scene->loads; i++) {
        const double part =
            angular_frequency * cabs(history_laplace_uncut(&scene->load[i].history, I * angular_frequency));
        const double more = scene->load[i].kind == LOAD_MOMENT_TENSOR ? angular_frequency : 1;
        sum += part * part * more * more;
    }
    return sum;
}

static int ascending(const void *one, const void *other)
{
    const double a = *(const double *)one, b = *(const double *)other;
    return (a > b) - (a < b);
}

selas_status layered_mechanisms(const struct scene *scene, size_t rocks, struct seismogram_rock *rock,
                                struct layered_damping *damping, struct messages *messages)
{
    const struct deck_group *group = scene->method.group;
    double *q = array_new(2 * scene->materials, sizeof *q), top = 0;
    size_t count = 0;
    if (q == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the damping of the ground");
    for (size_t i = 0; i < scene->materials; i++)
        if (scene->material[i].q_p > 0) {
            q[count++] = scene->material[i].q_p;
            q[count++] = scene->material[i].q_s;
        }
    qsort(q, count, sizeof *q, ascending);
    const double middle = count > 0 ? q[count / 2] : 0;
    array_free(q);
    if (count == 0) return SELAS_OK;
    for (size_t i = 0; i < scene->loads; i++)
        top = fmax(top, history_cutoff(&scene->load[i].history, 1e-3));
    struct relaxation_band band;
    relaxation_band_set(&band, top, source_power, scene);
    damping->mechanisms =
        deck_values(group, "mechanisms") > 0 ? (size_t)deck_integer(group, "mechanisms", 0) : 3;
    selas_status status =
        relaxation_rates(&band, middle, damping->mechanisms, damping->rate, &damping->misfit, messages);
    for (size_t i = 0; i < rocks && status == SELAS_OK; i++)
        if (rock[i].shear.power > 0)
            status = relaxation_fit(&band, damping->mechanisms, damping->rate, &rock[i].axial, &rock[i].shear,
                                    messages);
    return status;
}
