/* Rates of updated-Lagrangian SPH (He & Seaid 2016, Eqs 12-19, with the corrections of
 * doc/sph-updated-lagrangian.md):
 *
 *   d rho_i / dt = -rho_i tr(grad v_i)
 *   d v_i / dt   = sum_j m_j (s_j/rho_j^2 + s_i/rho_i^2 - Pi_ij I + f_ij^4 (R_i + R_j)) . L_i^-1 grad W_ij
 *   grad v_i     = sum_j V_j (v_j - v_i) (L_i^-1 grad W_ij)^T,   L_i = sum_j V_j grad W_ij (x_j - x_i)^T
 *   d s_i / dt   = lambda tr(e) I + 2 mu e + w s - s w,   e and w: symmetric and antisymmetric part of grad v
 *
 * One pass over the pairs: L_i^-1 does not depend on j, so the sums are taken with the plain grad W and
 * contracted with L_i^-1 afterwards. A particle only gathers: the sums do not depend on the number of
 * threads. Particles in some order (lattices, rings) are summed eight at a time
 * (updated_lagrangian_eight.h), others one by one (updated_lagrangian_batch.h). */
#include "method/updated_lagrangian_batch.h"
#include "method/updated_lagrangian_eight.h"

#include <string.h>

enum { BLOCK = 32 };

/* Inverse of L; the identity where the neighbours do not span the space. */
static inline void invert(const int dimension, const double matrix[6], double inverse[3][3])
{
    const double *m = matrix;
    memset(inverse, 0, 9 * sizeof(double));
    for (int a = 0; a < dimension; a++)
        inverse[a][a] = 1;
    if (dimension == 1) {
        if (m[0] > 1e-6) inverse[0][0] = 1 / m[0];
    } else if (dimension == 2) {
        const double det = m[0] * m[1] - m[2] * m[2];
        if (!(det > 1e-6)) return;
        inverse[0][0] = m[1] / det;
        inverse[1][1] = m[0] / det;
        inverse[0][1] = inverse[1][0] = -m[2] / det;
    } else {
        const double xx = m[1] * m[2] - m[4] * m[4], xy = m[4] * m[5] - m[3] * m[2],
                     xz = m[3] * m[4] - m[1] * m[5];
        const double det = m[0] * xx + m[3] * xy + m[5] * xz;
        if (!(det > 1e-6)) return;
        inverse[0][0] = xx / det;
        inverse[1][1] = (m[0] * m[2] - m[5] * m[5]) / det;
        inverse[2][2] = (m[0] * m[1] - m[3] * m[3]) / det;
        inverse[0][1] = inverse[1][0] = xy / det;
        inverse[0][2] = inverse[2][0] = xz / det;
        inverse[1][2] = inverse[2][1] = (m[3] * m[5] - m[0] * m[4]) / det;
    }
}

/* Stress rate of Hooke's law and the Jaumann terms from the velocity gradient g[a][b] = d v_a / d x_b. */
static inline void stress_rate(const struct updated *updated, const int dimension, double g[3][3],
                               const double *stress, double *rate)
{
    const double lambda = updated->material->plane_lambda, mu = updated->material->mu;
    double trace = 0;
    for (int a = 0; a < dimension; a++)
        trace += g[a][a];
    for (int a = 0; a < dimension; a++)
        for (int b = a; b < dimension; b++) {
            double sum = mu * (g[a][b] + g[b][a]) + (a == b ? lambda * trace : 0);
            if (updated->options.jaumann)
                for (int c = 0; c < dimension; c++) {
                    const double ac = (g[a][c] - g[c][a]) / 2, cb = (g[c][b] - g[b][c]) / 2;
                    sum += ac * stress[updated_component[dimension][c][b]] -
                           stress[updated_component[dimension][a][c]] * cb;
                }
            rate[updated_component[dimension][a][b]] = sum;
        }
}

void updated_invert(int dimension, const double matrix[6], double inverse[3][3])
{
    invert(dimension, matrix, inverse);
}

/* Rates of particle i from its sums. */
INLINED void contract(const struct updated *updated, const int dimension, size_t i, struct updated_sums *sums,
                      const double *y, double *dydt)
{
    const size_t points = updated->cloud->points, unknowns = updated->model.unknowns;
    const size_t dim = (size_t)dimension, stresses = dim * (dim + 1) / 2;
    const double *density = y + 2 * unknowns, *stress = density + points;
    double *acceleration = dydt + unknowns, *density_rate = dydt + 2 * unknowns,
           *stresses_rate = density_rate + points;
    double inverse[3][3], gradient[3][3] = {{0}}, trace = 0;
    if (!updated->options.correction) {
        memset(sums->matrix, 0, sizeof sums->matrix);
        memset(sums->full, 0, sizeof sums->full);
    }
    invert(dimension, sums->matrix, inverse);
    for (int a = 0; a < dimension; a++) {
        for (int b = 0; b < dimension; b++)
            for (int c = 0; c < dimension; c++)
                gradient[a][b] += sums->velocity[a][c] * inverse[b][c];
        trace += gradient[a][a];
    }
    if (updated->pressed) invert(dimension, sums->full, inverse);
    for (int a = 0; a < dimension; a++) {
        double sum = 0;
        for (int c = 0; c < dimension; c++)
            for (int b = 0; b < dimension; b++)
                sum += sums->push[updated_component[dimension][a][b]][c] * inverse[b][c];
        acceleration[dim * i + (size_t)a] = sum;
    }
    density_rate[i] = -density[i] * trace;
    stress_rate(updated, dimension, gradient, stress + stresses * i, stresses_rate + stresses * i);
}

/* Rates of the particles first ... last - 1; first is a multiple of VEC. */
INLINED void rates(const struct updated *updated, const int dimension, const bool viscous,
                   const bool repulsive, size_t first, size_t last, const double *y, double *dydt)
{
    for (size_t i = first; updated->ordered && i < last; i += VEC) {
        struct updated_sums sums[VEC];
        updated_eight(updated, dimension, viscous, repulsive, i, sums);
        for (size_t lane = 0; lane < VEC && i + lane < last; lane++)
            contract(updated, dimension, i + lane, &sums[lane], y, dydt);
    }
    for (size_t i = first; !updated->ordered && i < last; i++) {
        struct updated_sums sums = {0};
        updated_gather(updated, dimension, viscous, repulsive, i, &sums);
        contract(updated, dimension, i, &sums, y, dydt);
    }
}

/* Instances with constant dimension and switches: what is off is not there. */
#define RATES(dimension)                                                                                     \
    EACH_MACHINE static void rates_##dimension(const struct updated *updated, size_t first, size_t last,     \
                                               const double *y, double *dydt)                                \
    {                                                                                                        \
        const bool viscous = updated->alpha > 0 || updated->beta > 0;                                        \
        if (viscous && updated->repulsive)                                                                   \
            rates(updated, dimension, true, true, first, last, y, dydt);                                     \
        else if (viscous)                                                                                    \
            rates(updated, dimension, true, false, first, last, y, dydt);                                    \
        else if (updated->repulsive)                                                                         \
            rates(updated, dimension, false, true, first, last, y, dydt);                                    \
        else                                                                                                 \
            rates(updated, dimension, false, false, first, last, y, dydt);                                   \
    }
RATES(1)
RATES(2)
RATES(3)
#undef RATES

static void all_rates(const struct updated *updated, const double *y, double *dydt)
{
    const size_t points = updated->cloud->points, blocks = (points + BLOCK - 1) / BLOCK;
#pragma omp parallel for schedule(static) if (points >= UPDATED_PARALLEL)
    for (size_t block = 0; block < blocks; block++) {
        const size_t first = BLOCK * block;
        const size_t last = first + BLOCK < points ? first + BLOCK : points;
        if (updated->dimension == 1)
            rates_1(updated, first, last, y, dydt);
        else if (updated->dimension == 2)
            rates_2(updated, first, last, y, dydt);
        else
            rates_3(updated, first, last, y, dydt);
    }
}

static void add_body_forces(const struct updated *updated, const struct drive *drive, const double *y,
                            double *acceleration)
{
    const struct scene *scene = updated->model.scene;
    if (drive->load == NULL) return;
    const size_t points = updated->cloud->points, dimension = (size_t)updated->dimension;
    const double *density = y + 2 * updated->model.unknowns;
    for (size_t k = 0; k < scene->loads; k++) {
        if (scene->load[k].kind != LOAD_BODY_FORCE) continue;
        for (size_t i = 0; i < points; i++)
            for (size_t a = 0; a < dimension; a++)
                acceleration[dimension * i + a] +=
                    drive->load[k] * updated->load_direction[3 * k + a] / density[i];
    }
}

void updated_rate(struct model *model, const struct drive *drive, const double *y, double *dydt)
{
    struct updated *updated = updated_of(model);
    const size_t unknowns = model->unknowns;
    model->evaluations++;
    updated_fill(updated, drive, y);
    memcpy(dydt, y + unknowns, unknowns * sizeof *dydt);
    if (updated->search_failed) {
        for (size_t i = unknowns; i < model->state_size; i++)
            dydt[i] = NAN;
        return;
    }
    all_rates(updated, y, dydt);
    if (updated->hourglass != NULL) updated_add_hourglass(updated, y, dydt + unknowns);
    add_body_forces(updated, drive, y, dydt + unknowns);
}
