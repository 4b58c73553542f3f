/* The operator of the very weak kernel estimate, Ding et al. 2006, Eqs 13-15, 21-23:
 *
 *   K_ik     = mu delta_ik W_,jj + (lambda + mu) W_,ik
 *   Gamma_ik = mu delta_ik n_j W_,j + mu n_i W_,k + lambda n_k W_,i      (n at the point b of the face)
 *
 * with derivatives with respect to x_a - x_b (Eq 12) and W multiplied by alpha_a at boundary points (Eq 28).
 * One dim x dim block per pair: K V_b plus Gamma A_b for each face that b lies on. */
#include "base/memory.h"
#include "method/paper/paper.h"

#include <math.h>
#include <string.h>

/* Gradient and second derivatives of W at the vector from b to a. */
struct kernel_slopes {
    double first[3], second[3][3];
};

static struct kernel_slopes slopes_of(const struct paper *paper, size_t a, size_t b)
{
    struct kernel_slopes slopes = {0};
    double d[3] = {0}, square = 0;
    const size_t dimension = (size_t)paper->dimension;
    for (size_t c = 0; c < dimension; c++) {
        d[c] = paper->set.position[3 * a + c] - paper->set.position[3 * b + c];
        square += d[c] * d[c];
    }
    const double r = sqrt(square);
    const struct kernel *kernel = paper->options.kernel;
    const double over_r = kernel_derivative_over_r(kernel, paper->dimension, r, paper->h);
    const double second = kernel_second_derivative(kernel, paper->dimension, r, paper->h);
    const double along = r > 0 ? (second - over_r) / square : 0;
    for (size_t i = 0; i < dimension; i++) {
        slopes.first[i] = over_r * d[i];
        for (size_t k = 0; k < dimension; k++)
            slopes.second[i][k] = along * d[i] * d[k] + (i == k ? over_r : 0);
    }
    return slopes;
}

static void add_volume_term(const struct paper *paper, const struct kernel_slopes *slopes, double factor,
                            double *block)
{
    const size_t dimension = (size_t)paper->dimension;
    const double mu = paper->material->mu, lambda = paper->material->plane_lambda;
    double laplacian = 0;
    for (size_t j = 0; j < dimension; j++)
        laplacian += slopes->second[j][j];
    for (size_t i = 0; i < dimension; i++)
        for (size_t k = 0; k < dimension; k++)
            block[i * dimension + k] +=
                factor * ((i == k ? mu * laplacian : 0) + (lambda + mu) * slopes->second[i][k]);
}

static void add_surface_term(const struct paper *paper, const struct kernel_slopes *slopes,
                             const struct surface_element *element, double factor, double *block)
{
    const size_t dimension = (size_t)paper->dimension;
    const double mu = paper->material->mu, lambda = paper->material->plane_lambda;
    const double *n = element->normal;
    double normal_slope = 0;
    for (size_t j = 0; j < dimension; j++)
        normal_slope += n[j] * slopes->first[j];
    for (size_t i = 0; i < dimension; i++)
        for (size_t k = 0; k < dimension; k++)
            block[i * dimension + k] += factor * element->area *
                                        ((i == k ? mu * normal_slope : 0) + mu * n[i] * slopes->first[k] +
                                         lambda * n[k] * slopes->first[i]);
}

/* Takes the sum of a row of blocks off its diagonal: the same as K (u_b - u_a). */
static void zero_row_sum(struct paper *paper, size_t a)
{
    const size_t dimension = (size_t)paper->dimension, size = dimension * dimension;
    double sum[9] = {0}, *diagonal = NULL;
    for (size_t p = paper->near.start[a]; p < paper->near.start[a + 1]; p++) {
        double *block = paper->block + size * p;
        if (paper->near.index[p] == a) diagonal = block;
        for (size_t k = 0; k < size; k++)
            sum[k] += block[k];
    }
    for (size_t k = 0; diagonal != NULL && k < size; k++)
        diagonal[k] -= sum[k];
}

selas_status paper_make_operator(struct paper *paper, struct messages *messages)
{
    const struct neighbours *near = &paper->near;
    const size_t dimension = (size_t)paper->dimension, size = dimension * dimension;
    paper->block = array_new(size * near->start[near->points], sizeof *paper->block);
    if (paper->block == NULL)
        return fail(messages, SELAS_NO_MEMORY, "no memory for the operator: %zu pairs of points",
                    near->start[near->points]);
#pragma omp parallel for schedule(static)
    for (size_t a = 0; a < near->points; a++) {
        for (size_t p = near->start[a]; p < near->start[a + 1]; p++) {
            const size_t b = near->index[p];
            const struct kernel_slopes slopes = slopes_of(paper, a, b);
            double *block = paper->block + size * p;
            add_volume_term(paper, &slopes, paper->alpha[a] * paper->volume[b], block);
            if (!paper->options.boundary_term) continue;
            for (size_t e = paper->first_element[b]; e < paper->first_element[b + 1]; e++)
                add_surface_term(paper, &slopes, &paper->element[e], paper->alpha[a], block);
        }
        if (paper->options.zero_row_sums) zero_row_sum(paper, a);
    }
    return SELAS_OK;
}
