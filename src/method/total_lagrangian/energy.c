/* Total-Lagrangian SPH: forces of the loads, energies, and the power of loads, moving faces, dampers and
 * viscosity (doc/theory/sph-total-lagrangian.md). */
#include "method/total_lagrangian/total_lagrangian.h"

#include <string.h>

void tl_add_loads(struct tl_model *tl, const struct drive *drive)
{
    const size_t d = (size_t)tl->cloud->dimension;
    if (drive->load == NULL) return;
    for (size_t k = 0; k < tl->model.scene->loads; k++) {
        const struct tl_load *load = &tl->load[k];
        const double amplitude = drive->load[k];
        if (amplitude == 0) continue;
        for (size_t e = 0; e < load->count; e++)
            for (size_t a = 0; a < d; a++)
                tl->force[d * load->point[e] + a] += amplitude * load->force[d * e + a];
    }
}

/* M v. */
void tl_weigh(struct model *model, const double *v, double *product)
{
    const struct tl_model *tl = (const struct tl_model *)model;
    const size_t d = (size_t)tl->cloud->dimension;
    for (size_t i = 0; i < tl->cloud->points; i++)
        for (size_t k = d * i; k < d * (i + 1); k++)
            product[k] = tl->mass[i] * v[k];
}

void tl_energy(struct model *model, const double *y, struct energy *energy)
{
    struct tl_model *tl = (struct tl_model *)model;
    const size_t d = (size_t)tl->cloud->dimension;
    const struct tl_set *own = &tl->part.own;
    tl_sites(tl, y, NULL, tl->displacement, NULL);
    tl_gradients(tl);
    energy->strain = tl_strain_energy(tl);
    energy->kinetic = 0;
    for (size_t r = 0; r < own->count; r++)
        for (size_t i = own->range[r].from; i < own->range[r].end; i++)
            for (size_t c = 0; c < d; c++) {
                const double v = y[model->unknowns + d * i + c];
                energy->kinetic += 0.5 * tl->mass[i] * v * v;
            }
    double sums[2] = {energy->kinetic, energy->strain};
    ranks_sum(tl->part.ranks, 2, sums);
    *energy = (struct energy){sums[0], sums[1]};
}

/* Work done at moving faces: minus the force on each ghost, hourglass control's too, times its prescribed
 * velocity. */
static double motion_power(struct tl_model *tl, const double *velocity)
{
    const size_t d = (size_t)tl->cloud->dimension;
    double power = 0;
    for (size_t g = 0; g < tl->ghosts; g++) /* those of own points alone are known */
        if (!tl_set_has(&tl->part.own, tl->ghost[g].source))
            memset(tl->force + d * (tl->cloud->points + g), 0, d * sizeof *tl->force);
    tl_ghost_hourglass(tl);
    for (size_t g = 0; g < tl->ghosts; g++)
        for (size_t c = 0; c < d; c++)
            for (size_t f = 0; f < FACES; f++)
                power -= tl->force[d * (tl->cloud->points + g) + c] * tl->ghost[g].motion[c][f] * velocity[f];
    return power;
}

/* Adds the product of force and velocity at the own points. */
static void add_power(const struct tl_model *tl, const double *force, const double *v, double *sum)
{
    const size_t d = (size_t)tl->cloud->dimension;
    const struct tl_set *own = &tl->part.own;
    for (size_t r = 0; r < own->count; r++)
        for (size_t k = d * own->range[r].from; k < d * own->range[r].end; k++)
            *sum += force[k] * v[k];
}

void tl_power(struct model *model, const struct drive *drive, const double *y, double *load, double *absorbed)
{
    struct tl_model *tl = (struct tl_model *)model;
    const size_t n = model->unknowns;
    const double *v = y + n;
    double viscous = 0;
    *load = 0;
    *absorbed = 0;
    if (tl->moving && drive->velocity != NULL) {
        tl_sites(tl, y, v, drive->displacement, drive->velocity);
        tl_gradients(tl);
        tl_forces(tl);
        *load += motion_power(tl, drive->velocity);
    }
    if (tl->site_v != NULL) {
        tl_sites(tl, y, v, drive->displacement, drive->velocity);
        memset(tl->force, 0, n * sizeof *tl->force);
        tl_viscosity(tl);
        add_power(tl, tl->force, v, &viscous);
        *absorbed = -viscous;
    }
    *absorbed += tl_damped(tl, v);
    memset(tl->force, 0, n * sizeof *tl->force);
    tl_add_loads(tl, drive);
    add_power(tl, tl->force, v, load);
}
