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
 * the number of threads. */
#include "method/total_lagrangian.h"

#include <math.h>
#include <string.h>

static double ghost_value(const struct tl_model *tl, const double *u, size_t g, size_t c,
                          const double *amplitude)
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
            site[d * (tl->cloud->points + g) + c] = ghost_value(tl, site, g, c, amplitude);
}

void tl_sites(struct tl_model *tl, const double *u, const double *v, const double *displacement,
              const double *velocity)
{
    const size_t bytes = tl->model.unknowns * sizeof *u;
    memcpy(tl->site_u, u, bytes);
    fill_ghosts(tl, tl->site_u, displacement);
    if (tl->site_v == NULL || v == NULL) return;
    memcpy(tl->site_v, v, bytes);
    fill_ghosts(tl, tl->site_v, velocity);
}

/* Two numbers handled as one: rows of the 2 x 2 tensors in the plane. */
typedef double two __attribute__((vector_size(16), aligned(8), may_alias));

static inline two load(const double *from)
{
    return *(const two *)from;
}

/* Adds (u_j - u_i) x G_ij of entry k. */
static inline __attribute__((always_inline)) void add_pair(const struct tl_model *tl, size_t k,
                                                           const size_t d, const double own[3], double sum[9])
{
    const double *restrict other = tl->site_u + d * tl->gradient.index[k];
    const double *restrict g = tl->gradient.weight + d * k;
    for (size_t a = 0; a < d; a++) {
        const double difference = other[a] - own[a];
        for (size_t b = 0; b < d; b++)
            sum[a * d + b] += difference * g[b];
    }
}

/* Rows are summed in two interleaved halves: one sum would wait for each addition before. */
static inline __attribute__((always_inline)) void gradient_of(const struct tl_model *tl, size_t i,
                                                              const size_t d, double *H)
{
    const size_t end = tl->gradient.start[i + 1];
    double own[3];
    double even[9] = {0};
    double odd[9] = {0};
    for (size_t a = 0; a < d; a++)
        own[a] = tl->site_u[d * i + a];
    size_t k = tl->gradient.start[i];
    for (; k + 1 < end; k += 2) {
        add_pair(tl, k, d, own, even);
        add_pair(tl, k + 1, d, own, odd);
    }
    if (k < end) add_pair(tl, k, d, own, even);
    for (size_t c = 0; c < d * d; c++)
        H[c] = even[c] + odd[c];
}

static inline void gradient_in_plane(const struct tl_model *tl, size_t i, double *H)
{
    const size_t end = tl->gradient.start[i + 1];
    const double *restrict u = tl->site_u;
    const double *restrict weight = tl->gradient.weight;
    const uint32_t *restrict index = tl->gradient.index;
    const two own_x = {u[2 * i], u[2 * i]};
    const two own_y = {u[2 * i + 1], u[2 * i + 1]};
    two x[2] = {{0, 0}, {0, 0}};
    two y[2] = {{0, 0}, {0, 0}};
    for (size_t k = tl->gradient.start[i]; k < end; k++) {
        const double *other = u + 2 * (size_t)index[k];
        const two g = load(weight + 2 * k);
        x[k % 2] += ((two){other[0], other[0]} - own_x) * g;
        y[k % 2] += ((two){other[1], other[1]} - own_y) * g;
    }
    *(two *)H = x[0] + x[1];
    *(two *)(H + 2) = y[0] + y[1];
}

static inline __attribute__((always_inline)) void gradients(struct tl_model *tl, const size_t d)
{
    const size_t n = tl->cloud->points;
#pragma omp parallel for schedule(static) if (n > TL_SERIAL)
    for (size_t i = 0; i < n; i++) {
        double P[9];
        double *H = tl->H + d * d * i;
        double *A = tl->A + d * d * i;
        if (d == 2)
            gradient_in_plane(tl, i, H);
        else
            gradient_of(tl, i, d, H);
        struct elastic elastic = tl->elastic[i];
        if (tl->linear) elastic.law = LAW_LINEAR;
        elastic_stress(&elastic, H, P);
        for (size_t k = 0; k < d * d; k++)
            A[k] = tl->cloud->volume[i] * P[k];
    }
}

/* H of the ghosts, for hourglass control: T H R with the reflection R. */
static void ghost_gradients(struct tl_model *tl)
{
    const size_t d = (size_t)tl->cloud->dimension;
    for (size_t g = 0; g < tl->ghosts; g++) {
        const struct tl_ghost *ghost = &tl->ghost[g];
        const double *from = tl->H + d * d * ghost->source;
        double *to = tl->H + d * d * (tl->cloud->points + g);
        for (size_t a = 0; a < d; a++)
            for (size_t b = 0; b < d; b++)
                to[a * d + b] = ghost->sign[a] * ghost->mirror[b] * from[a * d + b];
    }
}

/* Non-affine part of the pair i, j: X_ij and e_ij. */
static inline __attribute__((always_inline)) void mismatch(const struct tl_model *tl, size_t i, size_t j,
                                                           const size_t d, double X[3], double e[3])
{
    const double *Hi = tl->H + d * d * i;
    const double *Hj = tl->H + d * d * j;
    for (size_t a = 0; a < d; a++)
        X[a] = tl->site_position[3 * j + a] - tl->site_position[3 * i + a];
    for (size_t a = 0; a < d; a++) {
        double seen = 0;
        for (size_t b = 0; b < d; b++)
            seen += (Hi[a * d + b] + Hj[a * d + b]) * X[b];
        e[a] = tl->site_u[d * j + a] - tl->site_u[d * i + a] - 0.5 * seen;
    }
}

static inline __attribute__((always_inline)) void hourglass(struct tl_model *tl, const size_t d)
{
    const size_t n = tl->cloud->points;
    ghost_gradients(tl);
#pragma omp parallel for schedule(static) if (n > TL_SERIAL)
    for (size_t i = 0; i < n; i++) {
        double force[3] = {0};
        double moment[9] = {0};
        for (size_t k = tl->pair.start[i]; k < tl->pair.start[i + 1]; k++) {
            double X[3];
            double e[3];
            mismatch(tl, i, tl->pair.index[k], d, X, e);
            for (size_t a = 0; a < d; a++) {
                e[a] *= tl->pair.weight[k];
                force[a] += e[a];
                for (size_t b = 0; b < d; b++)
                    moment[a * d + b] += e[a] * X[b];
            }
        }
        for (size_t a = 0; a < d; a++)
            tl->extra[d * i + a] = force[a];
        for (size_t k = 0; k < d * d; k++)
            tl->A[d * d * i + k] -= 0.5 * moment[k];
    }
}

/* Adds A_j G_js of entry k, column by column: sum[b] [a] = A_ab G_b. */
static inline __attribute__((always_inline)) void add_adjoint(const struct tl_model *tl, size_t k,
                                                              const size_t d, double sum[9])
{
    const double *restrict stress = tl->A + d * d * tl->transposed.index[k];
    const double *restrict g = tl->transposed.weight + d * k;
    for (size_t a = 0; a < d; a++)
        for (size_t b = 0; b < d; b++)
            sum[a * d + b] += stress[a * d + b] * g[b];
}

/* Force on site s by the points in whose gradients it stands. */
static inline __attribute__((always_inline)) void adjoint(const struct tl_model *tl, size_t s, const size_t d,
                                                          double force[3])
{
    const size_t end = tl->transposed.start[s + 1];
    double even[9] = {0};
    double odd[9] = {0};
    size_t k = tl->transposed.start[s];
    for (; k + 1 < end; k += 2) {
        add_adjoint(tl, k, d, even);
        add_adjoint(tl, k + 1, d, odd);
    }
    if (k < end) add_adjoint(tl, k, d, even);
    for (size_t a = 0; a < d; a++) {
        force[a] = 0;
        for (size_t b = 0; b < d; b++)
            force[a] -= even[a * d + b] + odd[a * d + b];
    }
}

static inline void adjoint_in_plane(const struct tl_model *tl, size_t s, double force[3])
{
    const size_t end = tl->transposed.start[s + 1];
    const double *restrict A = tl->A;
    const double *restrict weight = tl->transposed.weight;
    const uint32_t *restrict index = tl->transposed.index;
    two x[2] = {{0, 0}, {0, 0}};
    two y[2] = {{0, 0}, {0, 0}};
    for (size_t k = tl->transposed.start[s]; k < end; k++) {
        const double *stress = A + 4 * (size_t)index[k];
        const two g = load(weight + 2 * k);
        x[k % 2] += load(stress) * g;
        y[k % 2] += load(stress + 2) * g;
    }
    const two sum_x = x[0] + x[1];
    const two sum_y = y[0] + y[1];
    force[0] = -(sum_x[0] + sum_x[1]);
    force[1] = -(sum_y[0] + sum_y[1]);
}

static inline __attribute__((always_inline)) void forces(struct tl_model *tl, const size_t d)
{
    const size_t n = tl->cloud->points;
#pragma omp parallel if (n > TL_SERIAL)
    {
#pragma omp for schedule(static)
        for (size_t s = n; s < tl->sites; s++) {
            double force[3];
            if (d == 2)
                adjoint_in_plane(tl, s, force);
            else
                adjoint(tl, s, d, force);
            for (size_t a = 0; a < d; a++)
                tl->force[d * s + a] = force[a];
        }
#pragma omp for schedule(static)
        for (size_t i = 0; i < n; i++) {
            double force[3];
            if (d == 2)
                adjoint_in_plane(tl, i, force);
            else
                adjoint(tl, i, d, force);
            for (size_t a = 0; a < d; a++) {
                for (size_t b = 0; b < d; b++)
                    force[a] += tl->A[d * d * i + a * d + b] * tl->row_sum[d * i + b];
                if (tl->extra != NULL) force[a] += tl->extra[d * i + a];
            }
            for (size_t k = tl->returned.start[i]; k < tl->returned.start[i + 1]; k++) {
                const size_t g = tl->returned.index[k];
                for (size_t a = 0; a < d; a++)
                    force[a] += tl->ghost[g].sign[a] * tl->force[d * (n + g) + a];
            }
            for (size_t a = 0; a < d; a++)
                tl->force[d * i + a] = force[a];
        }
    }
}

void tl_gradient_at(const struct tl_model *tl, const double *u, size_t i, double H[9])
{
    const size_t d = (size_t)tl->cloud->dimension;
    const size_t n = tl->cloud->points;
    memset(H, 0, sizeof(double[9]));
    for (size_t k = tl->gradient.start[i]; k < tl->gradient.start[i + 1]; k++) {
        const size_t j = tl->gradient.index[k];
        for (size_t a = 0; a < d; a++) {
            const double other = j < n ? u[d * j + a] : ghost_value(tl, u, j - n, a, tl->displacement);
            for (size_t b = 0; b < d; b++)
                H[a * d + b] += (other - u[d * i + a]) * tl->gradient.weight[d * k + b];
        }
    }
}

void tl_gradients(struct tl_model *tl)
{
    switch (tl->cloud->dimension) {
    case 1:
        gradients(tl, 1);
        break;
    case 2:
        gradients(tl, 2);
        break;
    default:
        gradients(tl, 3);
    }
}

void tl_forces(struct tl_model *tl)
{
    const bool controlled = tl->extra != NULL;
    switch (tl->cloud->dimension) {
    case 1:
        if (controlled) hourglass(tl, 1);
        forces(tl, 1);
        break;
    case 2:
        if (controlled) hourglass(tl, 2);
        forces(tl, 2);
        break;
    default:
        if (controlled) hourglass(tl, 3);
        forces(tl, 3);
    }
}

/* Hourglass energy of a point's pairs; each pair stands in two rows. A pair with a ghost has its mirror image
 * in the row of the ghost's source: together they are half of the two pairs of the whole body, as it should
 * be, and their forces on a point are those of one full pair, so nothing goes back by T^T. */
static double hourglass_energy(const struct tl_model *tl, size_t i)
{
    const size_t d = (size_t)tl->cloud->dimension;
    double sum = 0;
    for (size_t k = tl->pair.start[i]; k < tl->pair.start[i + 1]; k++) {
        double X[3];
        double e[3];
        mismatch(tl, i, tl->pair.index[k], d, X, e);
        for (size_t a = 0; a < d; a++)
            sum += 0.25 * tl->pair.weight[k] * e[a] * e[a];
    }
    return sum;
}

double tl_strain_energy(struct tl_model *tl)
{
    const size_t d = (size_t)tl->cloud->dimension;
    double sum = 0;
    if (tl->extra != NULL) ghost_gradients(tl);
    for (size_t i = 0; i < tl->cloud->points; i++) {
        struct elastic elastic = tl->elastic[i];
        if (tl->linear) elastic.law = LAW_LINEAR;
        sum += tl->cloud->volume[i] * elastic_energy(&elastic, tl->H + d * d * i);
        if (tl->extra != NULL) sum += hourglass_energy(tl, i);
    }
    return sum;
}

/* Minus the derivative of the hourglass energy by the displacement of each ghost. */
void tl_ghost_hourglass(struct tl_model *tl)
{
    const size_t n = tl->cloud->points;
    const size_t d = (size_t)tl->cloud->dimension;
    for (size_t i = 0; tl->extra != NULL && i < n; i++)
        for (size_t k = tl->pair.start[i]; k < tl->pair.start[i + 1]; k++) {
            double X[3];
            double e[3];
            if (tl->pair.index[k] < n) continue;
            mismatch(tl, i, tl->pair.index[k], d, X, e);
            for (size_t a = 0; a < d; a++)
                tl->force[d * tl->pair.index[k] + a] -= 0.5 * tl->pair.weight[k] * e[a];
        }
}

/* Monaghan's viscosity (He & Seaid 2016, Eqs 16 and 17, r_ij a vector) along the line of each approaching
 * pair in its present position, added to tl->force: m_i m_j Pi_ij |W'(X_ij)|, so momentum and angular
 * momentum stay. A mirrored point pushes as its source would; the reaction falls on the mirror image. */
void tl_viscosity(struct tl_model *tl)
{
    const size_t n = tl->cloud->points;
    const size_t d = (size_t)tl->cloud->dimension;
#pragma omp parallel for schedule(static) if (n > TL_SERIAL)
    for (size_t i = 0; i < n; i++) {
        const double speed = tl->material[i]->p_speed;
        for (size_t k = tl->viscous.start[i]; k < tl->viscous.start[i + 1]; k++) {
            const size_t j = tl->viscous.index[k];
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
            const double pressure =
                (-tl->options.viscosity_alpha * speed + tl->options.viscosity_beta * phi) * phi /
                tl->material[i]->density;
            const double push = tl->viscous.weight[2 * k] * pressure / sqrt(square);
            for (size_t a = 0; a < d; a++)
                tl->force[d * i + a] += push * r[a];
        }
    }
}
