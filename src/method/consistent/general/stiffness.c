/* Stiffness of the effective medium of Backus (1962): transversely isotropic about the normal n of the layering
 * (doc/theory/general-ground.md, G10 and G12). */
#include "method/consistent/general/medium.h"

#include <math.h>

static const double rounding = 1e-12;

/* C_ijkl of a solid that is isotropic about n:
 *
 *   C12 d_ij d_kl + C66 (d_ik d_jl + d_il d_jk) + (C13 - C12)(d_ij n_k n_l + d_kl n_i n_j)
 *   + (C55 - C66)(d_ik n_j n_l + d_il n_j n_k + d_jk n_i n_l + d_jl n_i n_k)
 *   + (C11 + C33 - 2 C13 - 4 C55) n_i n_j n_k n_l. */
static double about_axis(double c11, double c33, double c13, double c55, double c66, const double n[3],
                         const int p[2], const int q[2])
{
    const int i = p[0], j = p[1], k = q[0], l = q[1];
    const double c12 = c11 - 2 * c66;
    double sum = (c11 + c33 - 2 * c13 - 4 * c55) * n[i] * n[j] * n[k] * n[l];
    if (i == j) sum += (c13 - c12) * n[k] * n[l];
    if (k == l) sum += (c13 - c12) * n[i] * n[j];
    if (i == j && k == l) sum += c12;
    if (i == k) sum += (c55 - c66) * n[j] * n[l] + (j == l ? c66 : 0);
    if (i == l) sum += (c55 - c66) * n[j] * n[k] + (j == k ? c66 : 0);
    if (j == k) sum += (c55 - c66) * n[i] * n[l];
    if (j == l) sum += (c55 - c66) * n[i] * n[k];
    return sum;
}

static const int pair[STRESSES][2] = {{0, 0}, {1, 1}, {2, 2}, {1, 2}, {2, 0}, {0, 1}};

/* The upper triangle by rows. */
static void about_normal(const double normal[3], double c11, double c33, double c13, double c55, double c66,
                         double stiffness[STIFFNESSES])
{
    int at = 0;
    for (int p = 0; p < STRESSES; p++)
        for (int q = p; q < STRESSES; q++)
            stiffness[at++] = about_axis(c11, c33, c13, c55, c66, normal, pair[p], pair[q]);
}

bool medium_stiffness(const struct averaged *averaged, double stiffness[STIFFNESSES], double *lambda,
                      double *mu)
{
    const double *mean = averaged->mean;
    const double c33 = 1 / mean[MEAN_SOFTNESS], c13 = mean[MEAN_RATIO] * c33, c66 = mean[MEAN_SHEAR];
    const double c55 = 1 / mean[MEAN_SLIP];
    const double c11 = mean[MEAN_SPREAD] + c66 + mean[MEAN_RATIO] * c13;
    *mu = c66;
    *lambda = c11 - 2 * c66;
    if (averaged->even || (fabs(c33 - c11) <= rounding * c11 && fabs(c55 - c66) <= rounding * c66 &&
                           fabs(c13 - *lambda) <= rounding * c11))
        return false;
    about_normal(averaged->normal, c11, c33, c13, c55, c66, stiffness);
    return true;
}

/* In the stress across the interface and the strain along it, in which the averages are sums, the part of the cell's
 * mean in the metric of the whole's, put in the metric of C. */
void medium_part(const struct averaged *averaged, double *stiffness, double *lambda, double *mu)
{
    const double *mean = averaged->mean, *cell = averaged->cell;
    const double c33 = 1 / mean[MEAN_SOFTNESS], c13 = mean[MEAN_RATIO] * c33;
    const double softness = cell[PART_SOFTNESS] / cell[CELL_SOFTNESS] * mean[MEAN_SOFTNESS];
    const double spread = cell[PART_SPREAD] / cell[CELL_SPREAD] * mean[MEAN_SPREAD];
    const double ratio = cell[PART_RATIO] * sqrt(mean[MEAN_SOFTNESS] / cell[CELL_SOFTNESS] *
                                                 (mean[MEAN_SPREAD] / cell[CELL_SPREAD]));
    const double p33 = softness * c33 * c33, p13 = softness * c33 * c13 + ratio * c33;
    const double p55 = cell[PART_SLIP] / cell[CELL_SLIP] / mean[MEAN_SLIP];
    const double p66 = cell[PART_SHEAR] / cell[CELL_SHEAR] * mean[MEAN_SHEAR];
    const double p11 = softness * c13 * c13 + 2 * ratio * c13 + spread + p66;
    *mu = p66;
    *lambda = p33 - 2 * p66;
    if (stiffness != NULL) about_normal(averaged->normal, p11, p33, p13, p55, p66, stiffness);
}

/* The run of a row that has point i; NULL: the solid is isotropic there. */
static const struct run_of_points *run_at(const struct family *family, size_t row, size_t i)
{
    size_t from = family->first_run[row], end = family->first_run[row + 1];
    while (from < end) {
        const size_t middle = (from + end) / 2;
        const struct run_of_points *run = &family->run[middle];
        if (i >= run->from && i < run->from + run->count) return run;
        if (i < run->from)
            end = middle;
        else
            from = middle + 1;
    }
    return NULL;
}

bool general_is_turned(const struct family *family, const size_t at[3])
{
    return run_at(family, at[2] * family->n[1] + at[1], at[0]) != NULL;
}

void general_add_stiffness(const struct family *family, const size_t at[3], double factor,
                           double stiffness[STRESSES][STRESSES])
{
    const size_t row = at[2] * family->n[1] + at[1], point = row * family->n[0] + at[0];
    const struct run_of_points *run = run_at(family, row, at[0]);
    const double *number = run != NULL ? family->stiffness + run->at + at[0] - run->from : NULL;
    for (int p = 0; p < STRESSES && run != NULL; p++)
        for (int q = p; q < STRESSES; q++, number += run->count) {
            stiffness[p][q] += factor * *number;
            if (q != p) stiffness[q][p] += factor * *number;
        }
    for (int p = 0; p < STRESSES && run == NULL; p++) {
        stiffness[p][p] += factor * family->mu[point] * (p < 3 ? 2 : 1);
        for (int q = 0; p < 3 && q < 3; q++)
            stiffness[p][q] += factor * family->lambda[point];
    }
}
