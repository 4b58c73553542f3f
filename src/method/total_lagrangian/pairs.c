/* Set-up of total-Lagrangian SPH: the pairs of hourglass control and of viscosity (force.c
 * has their equations). */
#include "method/total_lagrangian/setup.h"

#include <math.h>

/* Pairs of nearest points (8 in a plane lattice, 18 in space): k_ij = hourglass * (lambda + 2 mu) * volume /
 * (2 dimension |X_ij|^2), so that what the gradients miss of the strain e_ij / |X_ij| counts as a strain with
 * about `hourglass` times the modulus. */
static bool add_hourglass(struct tl_model *tl, size_t i, const struct tl_work *work)
{
    const double usual = 2 * tl->cloud->dimension;
    bool room = true;
    for (size_t k = 0; room && k < work->found; k++) {
        const size_t j = work->near[k], source = tl_source(tl, j);
        if (j == i || (j >= tl->cloud->points && tl->ghost[j - tl->cloud->points].curved)) continue;
        const double r = tl_distance(tl->site_position + 3 * i, tl->site_position + 3 * j);
        if (r > 1.6 * fmax(tl->spacing[i], tl->spacing[source])) continue;
        double stiffness = 0;
        const size_t both[2] = {i, source};
        for (int e = 0; e < 2; e++) {
            const struct elastic *elastic = &tl->elastic[both[e]];
            stiffness += 0.5 * (elastic->plane_lambda + 2 * elastic->mu) * tl->cloud->volume[both[e]];
        }
        const double weight = tl->options.hourglass * stiffness / (usual * r * r);
        room = tl_rows_add(&tl->pair, i, j, &weight);
    }
    return room;
}

static bool add_viscous(struct tl_model *tl, size_t i, const struct tl_work *work)
{
    const struct kernel *kernel = tl->options.kernel;
    const double per_spacing = tl_radius(tl) / (kernel->support * tl->cloud->spacing);
    bool room = true;
    for (size_t k = 0; room && k < work->found; k++) {
        const size_t j = work->near[k], source = tl_source(tl, j);
        const double r = tl_distance(tl->site_position + 3 * i, tl->site_position + 3 * j);
        const double h = 0.5 * per_spacing * (tl->spacing[i] + tl->spacing[source]);
        const double slope = -kernel_derivative(kernel, tl->cloud->dimension, r, h);
        if (j == i || !(slope > 0)) continue;
        const double weight[2] = {tl->mass[i] * tl->mass[source] * slope, h};
        room = tl_rows_add(&tl->viscous, i, j, weight);
    }
    return room;
}

/* Rows of pairs of sites within a radius, which `add` makes from those near a point. */
static selas_status pairs(struct tl_making *making, struct tl_rows *rows, double radius,
                          bool (*add)(struct tl_model *, size_t, const struct tl_work *),
                          struct messages *messages)
{
    struct tl_model *tl = making->tl;
    const size_t layers = tl_layers_within(tl->model.scene, tl->cloud->grid, radius);
    for (size_t i = tl->part.pair.from; i < tl->part.pair.end; i++) {
        struct tl_like like;
        tl_likes(tl, i, layers, &like);
        if (tl_rows_share(tl, rows, i, &like, true)) continue;
        if (!tl_find_near(tl, &making->near, i, radius, &making->work) || !add(tl, i, &making->work) ||
            !tl_rows_close(rows, i, &like, tl->site_position, tl->cloud->spacing))
            return tl_no_memory(tl, messages);
    }
    return tl_rows_end(rows) ? SELAS_OK : tl_no_memory(tl, messages);
}

selas_status tl_make_hourglass(struct tl_making *making, struct messages *messages)
{
    struct tl_model *tl = making->tl;
    return pairs(making, &tl->pair, tl_pair_radius(tl_largest_spacing(tl)), add_hourglass, messages);
}

selas_status tl_make_viscosity(struct tl_making *making, struct messages *messages)
{
    struct tl_model *tl = making->tl;
    return pairs(making, &tl->viscous, tl_search_radius(tl), add_viscous, messages);
}
