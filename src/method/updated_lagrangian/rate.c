/* Rates of updated-Lagrangian SPH (He & Seaid 2016, Eqs 12-19, with the corrections of
 * doc/theory/sph-updated-lagrangian.md):
 *
 *   d rho_i / dt = -rho_i tr(grad v_i)
 *   d v_i / dt   = sum_j m_j (s_j/rho_j^2 + s_i/rho_i^2 - Pi_ij I + f_ij^4 (R_i + R_j)) . L_i^-1 grad W_ij
 *   grad v_i     = sum_j V_j (v_j - v_i) (L_i^-1 grad W_ij)^T,   L_i = sum_j V_j grad W_ij (x_j - x_i)^T
 *   d s_i / dt   = lambda tr(e) I + 2 mu e + w s - s w,   e and w: symmetric and antisymmetric part of grad v
 *
 *
 * The sums: block_rates.c. */
#include "method/updated_lagrangian/contract.h"

#include <string.h>

void updated_invert(int dimension, const double matrix[6], double inverse[3][3])
{
    lanes m[6] = {{0}}, x[3][3];
    for (int s = 0; s < dimension * (dimension + 1) / 2; s++)
        m[s] += matrix[s];
    if (dimension == 1)
        invert(1, m, x);
    else if (dimension == 2)
        invert(2, m, x);
    else
        invert(3, m, x);
    for (int a = 0; a < dimension; a++)
        for (int b = 0; b < dimension; b++)
            inverse[a][b] = x[a][b][0];
}

static void all_rates(const struct updated *updated, const double *y, double *dydt)
{
    const size_t end = updated->from + updated->own,
                 blocks = (updated->own + UPDATED_BLOCK - 1) / UPDATED_BLOCK;
#pragma omp parallel for schedule(static) if (updated->own >= UPDATED_PARALLEL)
    for (size_t block = 0; block < blocks; block++) {
        const size_t first = updated->from + UPDATED_BLOCK * block;
        const size_t last = first + UPDATED_BLOCK < end ? first + UPDATED_BLOCK : end;
        taken_updated_rates()->of[updated->dimension - 1](updated, first, last, y, dydt);
    }
}

static void add_body_forces(const struct updated *updated, const struct drive *drive, const double *y,
                            double *acceleration)
{
    const struct scene *scene = updated->model.scene;
    if (drive->load == NULL) return;
    const size_t from = updated->lead, end = from + updated->own, dimension = (size_t)updated->dimension;
    const double *density = y + 2 * updated->model.unknowns;
    for (size_t k = 0; k < scene->loads; k++) {
        if (scene->load[k].kind != LOAD_BODY_FORCE) continue;
        for (size_t i = from; i < end; i++)
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
    updated_exchange(updated, dydt);
}
