/* Internal forces of total-Lagrangian SPH.
 *
 *   H_i = sum_j (u_j - u_i) x G_ij                                             (gradients, points over sites)
 *   A_i = V_i P(H_i) - 1/2 sum_j k_ij e_ij x X_ij                               (stress, hourglass part)
 *   f_i = A_i sum_j G_ij - sum_j A_j G_ji + sum_j k_ij e_ij                     (the adjoint: minus dE/du_i)
 *
 * with E = sum_i V_i psi(H_i) + 1/2 sum_pairs k_ij |e_ij|^2 and e_ij = u_j - u_i - (H_i + H_j) X_ij / 2, the
 * part of a pair's stretch that the gradients do not see; it vanishes for quadratic fields where the
 * gradients are exact for them. Momentum: the f_i add up to 0 because E depends on differences only; angular
 * momentum: E does not change when x = X + u turns. Each row is a gather, so the result does not depend on
 * the number of threads. The loops over neighbours are in run_loops.c and point_loops.c. */
#include "method/total_lagrangian/run_loops.h"

#include <math.h>
#include <string.h>

void tl_keep_amplitudes(struct tl_model *tl, const struct drive *drive)
{
    const double *const from[] = {drive->displacement, drive->velocity, drive->motion};
    double *const to[] = {tl->displacement, tl->velocity, tl->acceleration};
    for (size_t k = 0; k < 3; k++) {
        memset(to[k], 0, sizeof tl->displacement);
        if (from[k] != NULL) memcpy(to[k], from[k], sizeof tl->displacement);
    }
}

double tl_ghost_value(const struct tl_model *tl, const double *u, size_t g, size_t c, const double *amplitude)
{
    const struct tl_ghost *ghost = &tl->ghost[g];
    double value = ghost->sign[c] * u[(size_t)tl->cloud->dimension * ghost->source + c];
    for (size_t f = 0; amplitude != NULL && tl->moving && f < FACES; f++)
        value += ghost->motion[c][f] * amplitude[f];
    return value;
}

static void fill_ghosts(const struct tl_model *tl, double *site, const double *amplitude)
{
    const size_t d = (size_t)tl->cloud->dimension;
    for (size_t g = 0; g < tl->ghosts; g++)
        for (size_t c = 0; c < d; c++)
            site[d * (tl->cloud->points + g) + c] = tl_ghost_value(tl, site, g, c, amplitude);
}

void tl_sites(struct tl_model *tl, const double *u, const double *v, const double *displacement,
              const double *velocity)
{
    const size_t bytes = tl->model.unknowns * sizeof *u;
    memcpy(tl->site_u, u, bytes);
    for (size_t k = 0; k < tl->held_count; k++)
        tl->site_u[tl->held[k]] = 0;
    fill_ghosts(tl, tl->site_u, displacement);
    if (tl->site_v == NULL || v == NULL) return;
    memcpy(tl->site_v, v, bytes);
    fill_ghosts(tl, tl->site_v, velocity);
}

/* H of the ghosts, for hourglass control: T H R with the reflection R. */
static void ghost_gradients(struct tl_model *tl)
{
    const size_t d = (size_t)tl->cloud->dimension;
    for (size_t g = 0; g < tl->ghosts; g++) {
        const struct tl_ghost *ghost = &tl->ghost[g];
        for (size_t b = 0; b < d; b++) {
            const double *from = tl->H + b * tl->plane + d * ghost->source;
            double *to = tl->H + b * tl->plane + d * (tl->cloud->points + g);
            for (size_t a = 0; a < d; a++)
                to[a] = ghost->sign[a] * ghost->mirror[b] * from[a];
        }
    }
}

/* Non-affine part of the pair i, j: X_ij and e_ij. */
INLINED void mismatch(const struct tl_model *tl, const size_t d, size_t i, size_t j, double X[3], double e[3])
{
    const double *Hi = tl->H + d * i;
    const double *Hj = tl->H + d * j;
    for (size_t a = 0; a < d; a++)
        X[a] = tl->site_position[3 * j + a] - tl->site_position[3 * i + a];
    for (size_t a = 0; a < d; a++) {
        double seen = 0;
        for (size_t b = 0; b < d; b++)
            seen += (Hi[b * tl->plane + a] + Hj[b * tl->plane + a]) * X[b];
        e[a] = tl->site_u[d * j + a] - tl->site_u[d * i + a] - 0.5 * seen;
    }
}

void tl_gradient_at(const struct tl_model *tl, const double *u, size_t i, double H[9])
{
    const size_t d = (size_t)tl->cloud->dimension;
    const size_t n = tl->cloud->points;
    memset(H, 0, sizeof(double[9]));
    for (size_t k = tl_first(&tl->gradient, i); k < tl_last(&tl->gradient, i); k++) {
        const size_t j = tl_neighbour(&tl->gradient, i, k);
        for (size_t a = 0; a < d; a++) {
            const double other = j < n ? u[d * j + a] : tl_ghost_value(tl, u, j - n, a, tl->displacement);
            for (size_t b = 0; b < d; b++)
                H[a * d + b] += (other - u[d * i + a]) * tl->gradient.weight[d * k + b];
        }
    }
}

static void gradient_block(struct tl_model *tl, const struct tl_block *block)
{
    const int axis = tl->cloud->dimension - 1;
    (block->run ? taken_tl_run_loops()->gradient : taken_tl_point_loops()->gradient)[axis](tl, block);
}

static void stress_block(struct tl_model *tl, const struct tl_block *block)
{
    const int axis = tl->cloud->dimension - 1;
    taken_tl_run_loops()->stress[axis](tl, block);
    if (!block->run && tl->extra != NULL) taken_tl_point_loops()->control[axis](tl, block);
}

static void force_block(struct tl_model *tl, const struct tl_block *block)
{
    const int axis = tl->cloud->dimension - 1;
    (block->run ? taken_tl_run_loops()->force : taken_tl_point_loops()->force)[axis](tl, block);
}

static void gradients_of(struct tl_model *tl, const struct tl_blocks *blocks)
{
#pragma omp parallel for schedule(static) if (tl->cloud->points > TL_SERIAL)
    for (size_t k = 0; k < blocks->count; k++)
        gradient_block(tl, &blocks->block[k]);
}

void tl_gradients(struct tl_model *tl)
{
    gradients_of(tl, &tl->gradient_blocks);
}

void tl_all_gradients(struct tl_model *tl)
{
    gradients_of(tl, tl->all_gradients.count > 0 ? &tl->all_gradients : &tl->gradient_blocks);
}

void tl_stresses(struct tl_model *tl)
{
    const struct tl_blocks *blocks = &tl->stress_blocks;
    if (tl->extra != NULL) ghost_gradients(tl);
#pragma omp parallel for schedule(static) if (tl->cloud->points > TL_SERIAL)
    for (size_t k = 0; k < blocks->count; k++)
        stress_block(tl, &blocks->block[k]);
}

/* A force on a ghost is one on its source, T^T. */
void tl_divergence(struct tl_model *tl)
{
    const struct tl_blocks *blocks = &tl->force_blocks;
    const size_t d = (size_t)tl->cloud->dimension;
#pragma omp parallel if (tl->cloud->points > TL_SERIAL)
    {
#pragma omp for schedule(static)
        for (size_t k = 0; k < blocks->count; k++)
            force_block(tl, &blocks->block[k]);
#pragma omp for schedule(static)
        for (size_t s = 0; s < tl->sources; s++) {
            const size_t i = tl->source[s];
            for (size_t k = tl->returned_start[s]; k < tl->returned_start[s + 1]; k++) {
                const size_t g = tl->returned[k];
                for (size_t a = 0; a < d; a++)
                    tl->force[d * i + a] += tl->ghost[g].sign[a] * tl->force[d * (tl->cloud->points + g) + a];
            }
        }
    }
}

void tl_forces(struct tl_model *tl)
{
    tl_stresses(tl);
    tl_divergence(tl);
}

/* Hourglass energy of a point's pairs; each pair stands in two rows. A pair with a ghost has its mirror image
 * in the row of the ghost's source: together they are half of the two pairs of the whole body, as it should
 * be, and their forces on a point are those of one full pair, so nothing goes back by T^T. */
INLINED double hourglass_energy(const struct tl_model *tl, const size_t d, size_t i)
{
    double sum = 0;
    for (size_t k = tl_first(&tl->pair, i); k < tl_last(&tl->pair, i); k++) {
        double X[3];
        double e[3];
        mismatch(tl, d, i, tl_neighbour(&tl->pair, i, k), X, e);
        for (size_t a = 0; a < d; a++)
            sum += 0.25 * tl->pair.weight[k] * e[a] * e[a];
    }
    return sum;
}

#define OF_DIMENSION(d)                                                                                      \
    static double hourglass_energy_##d(const struct tl_model *tl, size_t i)                                  \
    {                                                                                                        \
        return hourglass_energy(tl, d, i);                                                                   \
    }
OF_DIMENSION(1)
OF_DIMENSION(2)
OF_DIMENSION(3)
#undef OF_DIMENSION

double tl_strain_energy(struct tl_model *tl)
{
    double (*const hourglass[])(const struct tl_model *, size_t) = {hourglass_energy_1, hourglass_energy_2,
                                                                    hourglass_energy_3};
    const struct tl_set *own = &tl->part.own;
    double sum = 0;
    if (tl->extra != NULL) ghost_gradients(tl);
    for (size_t r = 0; r < own->count; r++)
        for (size_t i = own->range[r].from; i < own->range[r].end; i++) {
            double H[9];
            struct elastic elastic = tl->elastic[i];
            if (tl->linear) elastic.law = LAW_LINEAR;
            tl_tensor(tl, i, H);
            sum += tl->cloud->volume[i] * elastic_energy(&elastic, H);
            if (tl->extra != NULL) sum += hourglass[tl->cloud->dimension - 1](tl, i);
        }
    return sum;
}

/* Minus the derivative of the hourglass energy of point i by the displacement of each ghost. */
static void ghost_hourglass(struct tl_model *tl, size_t i)
{
    const size_t n = tl->cloud->points;
    const size_t d = (size_t)tl->cloud->dimension;
    for (size_t k = tl_first(&tl->pair, i); k < tl_last(&tl->pair, i); k++) {
        const size_t j = tl_neighbour(&tl->pair, i, k);
        double X[3];
        double e[3];
        if (j < n) continue;
        mismatch(tl, d, i, j, X, e);
        for (size_t a = 0; a < d; a++)
            tl->force[d * j + a] -= 0.5 * tl->pair.weight[k] * e[a];
    }
}

void tl_ghost_hourglass(struct tl_model *tl)
{
    const struct tl_set *own = &tl->part.own;
    for (size_t r = 0; tl->extra != NULL && r < own->count; r++)
        for (size_t i = own->range[r].from; i < own->range[r].end; i++)
            ghost_hourglass(tl, i);
}

/* Monaghan's viscosity (He & Seaid 2016, Eqs 16 and 17, r_ij a vector) along the line of each approaching
 * pair in its present position, added to tl->force: m_i m_j Pi_ij |W'(X_ij)|, so momentum and angular
 * momentum stay. A mirrored point pushes as its source would; the reaction falls on the mirror image. */
static void viscous_force(struct tl_model *tl, size_t i)
{
    const size_t d = (size_t)tl->cloud->dimension;
    const double speed = tl->material[i]->p_speed;
    for (size_t k = tl_first(&tl->viscous, i); k < tl_last(&tl->viscous, i); k++) {
        const size_t j = tl_neighbour(&tl->viscous, i, k);
        double r[3] = {0};
        double square = 0;
        double approach = 0;
        for (size_t a = 0; a < d; a++) {
            r[a] = tl->site_position[3 * i + a] - tl->site_position[3 * j + a];
            if (!tl->linear) r[a] += tl->site_u[d * i + a] - tl->site_u[d * j + a];
            square += r[a] * r[a];
            approach += r[a] * (tl->site_v[d * i + a] - tl->site_v[d * j + a]);
        }
        if (approach >= 0) continue;
        const double h = tl->viscous.weight[2 * k + 1];
        const double phi = h * approach / (square + 0.01 * h * h);
        const double pressure = (-tl->options.viscosity_alpha * speed + tl->options.viscosity_beta * phi) *
                                phi / tl->material[i]->density;
        const double push = tl->viscous.weight[2 * k] * pressure / sqrt(square);
        for (size_t a = 0; a < d; a++)
            tl->force[d * i + a] += push * r[a];
    }
}

void tl_viscosity(struct tl_model *tl)
{
    const struct tl_set *own = &tl->part.own;
#pragma omp parallel for schedule(static) if (own->points > TL_SERIAL)
    for (size_t r = 0; r < own->count; r++)
        for (size_t i = own->range[r].from; i < own->range[r].end; i++)
            viscous_force(tl, i);
}
