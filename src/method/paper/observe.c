/* What is seen of the published method: de-convolution (Ding et al. 2006, Eq 38), values and gradients at any
 * place, energies.
 *
 * Eq 38 takes the computed values as smoothed ones, <u>, and sharpens them:
 *
 *   u_a = (s_a <u>_a - sum over b /= a of alpha_a W_ab V_b <u>_b) / (alpha_a W(0) V_a)
 *
 * with s_a the sum over all b, a too, of alpha_a W_ab V_b, 1 but in the second layer (as printed 1 there, too, where
 * a body that moves as a whole would be seen to be torn: doc/theory/paper-method.md).
 * What faces prescribe is no smoothed value, and stays as it is.
 *
 * Between points the values are blended from first-order expansions about the points around (modified
 * Shepard interpolation, Franke & Nielson 1980), which passes through the points and is exact for linear
 * fields. The gradient at a point is the least-squares fit with weights W_ab V_b. */
#include "base/memory.h"
#include "method/paper/paper.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

/* Inverse of the symmetric n x n matrix in the upper left of m; a direction without extent gives 0 there. */
static void invert_moments(int n, double m[3][3], double inverse[3][3])
{
    double work[3][6] = {{0}};
    double scale = 0;
    for (int i = 0; i < n; i++) {
        for (int j = 0; j < n; j++)
            work[i][j] = m[i][j];
        work[i][n + i] = 1;
        scale = fmax(scale, m[i][i]);
    }
    for (int k = 0; k < n; k++) {
        const double pivot = work[k][k];
        if (!(pivot > 1e-12 * scale)) { /* no point lies in this direction */
            for (int j = 0; j < 2 * n; j++)
                work[k][j] = 0;
            continue;
        }
        for (int j = 0; j < 2 * n; j++)
            work[k][j] /= pivot;
        for (int i = 0; i < n; i++) {
            const double factor = work[i][k];
            if (i == k || factor == 0) continue;
            for (int j = 0; j < 2 * n; j++)
                work[i][j] -= factor * work[k][j];
        }
    }
    for (int i = 0; i < n; i++)
        for (int j = 0; j < n; j++)
            inverse[i][j] = work[i][n + j];
}

/* Inverse moment matrix of the least-squares gradient at a point. */
static void gradient_matrix(const struct paper *paper, size_t a, double inverse[3][3])
{
    const double *position = paper->set.position;
    double moments[3][3] = {{0}};
    for (size_t p = paper->near.start[a]; p < paper->near.start[a + 1]; p++) {
        const size_t b = paper->near.index[p];
        for (size_t i = 0; i < (size_t)paper->dimension; i++)
            for (size_t j = 0; j < (size_t)paper->dimension; j++)
                moments[i][j] += paper->kernel_volume[p] * (position[3 * b + i] - position[3 * a + i]) *
                                 (position[3 * b + j] - position[3 * a + j]);
    }
    invert_moments(paper->dimension, moments, inverse);
}

/* Weight of neighbour p of point a in the gradient there; the point itself has minus the sum of them. */
static void gradient_weight(const struct paper *paper, size_t a, size_t p, double inverse[3][3],
                            double weight[3])
{
    const double *position = paper->set.position;
    const size_t b = paper->near.index[p];
    for (size_t i = 0; i < 3; i++) {
        weight[i] = 0;
        for (size_t j = 0; j < (size_t)paper->dimension && i < (size_t)paper->dimension; j++)
            weight[i] +=
                inverse[i][j] * paper->kernel_volume[p] * (position[3 * b + j] - position[3 * a + j]);
    }
}

/* Factor of neighbour p in Eq 38 at point a (1 for the point itself without de-convolution). */
static double sharpening(const struct paper *paper, size_t a, size_t p)
{
    const bool self = paper->near.index[p] == a;
    if (!paper->options.deconvolution || paper->told[a]) return self ? 1 : 0;
    const double centre = paper->alpha[a] * paper->volume[a] *
                          kernel_value(paper->options.kernel, paper->dimension, 0, paper->h);
    return (self ? paper->whole[a] : -paper->alpha[a] * paper->kernel_volume[p]) / centre;
}

/* Dense weights while a probe is being put together: value and gradient, [4 * points]. */
static void add_point(const struct paper *paper, size_t a, const double factor[4], double *dense)
{
    for (size_t p = paper->near.start[a]; p < paper->near.start[a + 1]; p++) {
        const double sharp = sharpening(paper, a, p);
        for (size_t k = 0; k < 4; k++)
            dense[4 * paper->near.index[p] + k] += sharp * factor[k];
    }
}

/* share * (u_a + gradient_a . d) to the value and share * gradient_a to the gradient. */
static void add_expansion(const struct paper *paper, size_t a, const double d[3], double share, double *dense)
{
    double inverse[3][3], self[4] = {share, 0, 0, 0};
    gradient_matrix(paper, a, inverse);
    for (size_t p = paper->near.start[a]; p < paper->near.start[a + 1]; p++) {
        double slope[3], factor[4] = {0};
        if (paper->near.index[p] == a) continue;
        gradient_weight(paper, a, p, inverse, slope);
        for (size_t k = 0; k < 3; k++) {
            factor[k + 1] = share * slope[k];
            factor[0] += share * slope[k] * d[k];
        }
        for (size_t k = 0; k < 4; k++)
            self[k] -= factor[k];
        add_point(paper, paper->near.index[p], factor, dense);
    }
    add_point(paper, a, self, dense);
}

static double distance(const struct paper *paper, size_t a, const double place[3], double d[3])
{
    double square = 0;
    for (size_t c = 0; c < 3; c++) {
        d[c] = c < (size_t)paper->dimension ? place[c] - paper->set.position[3 * a + c] : 0;
        square += d[c] * d[c];
    }
    return sqrt(square);
}

static void blend(const struct paper *paper, const double place[3], const uint32_t *near, size_t count,
                  double *dense)
{
    double total = 0, d[3];
    for (size_t k = 0; k < count; k++) {
        const double r = distance(paper, near[k], place, d);
        if (r < 1e-9 * paper->h) {
            add_expansion(paper, near[k], d, 1, dense);
            return;
        }
        total += kernel_value(paper->options.kernel, paper->dimension, r, paper->h) / (r * r);
    }
    for (size_t k = 0; k < count; k++) {
        const double r = distance(paper, near[k], place, d);
        const double share = kernel_value(paper->options.kernel, paper->dimension, r, paper->h) / (r * r);
        add_expansion(paper, near[k], d, share / total, dense);
    }
}

selas_status paper_probe(struct model *model, const double position[3], struct probe *probe,
                         struct messages *messages)
{
    struct paper *paper = (struct paper *)model;
    const size_t points = paper->set.points;
    const size_t count = neighbours_at(&paper->near, position, 0, NULL);
    if (count == 0)
        return fail(messages, SELAS_BAD_ARGUMENT, "no point of the body is near (%g, %g, %g)", position[0],
                    position[1], position[2]);
    uint32_t *near = array_new(count, sizeof *near);
    double *dense = array_new(4 * points, sizeof *dense);
    size_t used = 0;
    selas_status status = SELAS_OK;
    if (near == NULL || dense == NULL) {
        status = fail(messages, SELAS_NO_MEMORY, "no memory for a receiver");
    } else {
        neighbours_at(&paper->near, position, count, near);
        blend(paper, position, near, count, dense);
        for (size_t i = 0; i < points; i++)
            used +=
                dense[4 * i] != 0 || dense[4 * i + 1] != 0 || dense[4 * i + 2] != 0 || dense[4 * i + 3] != 0;
        status = probe_allocate(probe, used, messages);
    }
    for (size_t i = 0, k = 0; status == SELAS_OK && i < points && k < used; i++) {
        const double *weight = dense + 4 * i;
        if (weight[0] == 0 && weight[1] == 0 && weight[2] == 0 && weight[3] == 0) continue;
        probe->index[k] = i;
        probe->weight[k] = weight[0];
        for (size_t c = 0; c < 3; c++)
            probe->gradient[3 * k + c] = weight[c + 1];
        k++;
    }
    array_free(near);
    array_free(dense);
    if (status != SELAS_OK) return status;
    memcpy(probe->position, position, sizeof probe->position);
    probe->material = paper->material;
    return SELAS_OK;
}

/* Value at a point, sharpened by Eq 38 where that is wanted. */
static void point_value(const struct paper *paper, size_t a, const double *field, bool sharp, double value[3])
{
    const size_t dimension = (size_t)paper->dimension;
    for (size_t c = 0; c < dimension; c++)
        value[c] = sharp ? 0 : field[dimension * a + c];
    for (size_t p = paper->near.start[a]; sharp && p < paper->near.start[a + 1]; p++) {
        const double factor = sharpening(paper, a, p);
        for (size_t c = 0; c < dimension; c++)
            value[c] += factor * field[dimension * paper->near.index[p] + c];
    }
}

static void point_gradient(const struct paper *paper, size_t a, const double *u, bool sharp,
                           double gradient[9])
{
    double inverse[3][3], own[3] = {0};
    gradient_matrix(paper, a, inverse);
    point_value(paper, a, u, sharp, own);
    for (size_t p = paper->near.start[a]; p < paper->near.start[a + 1]; p++) {
        double other[3] = {0}, weight[3];
        gradient_weight(paper, a, p, inverse, weight);
        point_value(paper, paper->near.index[p], u, sharp, other);
        for (size_t i = 0; i < 3; i++)
            for (size_t j = 0; j < 3; j++)
                gradient[3 * i + j] += weight[j] * (other[i] - own[i]);
    }
}

void paper_field(struct model *model, selas_field field, const double *y, const double *a, size_t from,
                 size_t end, double *value)
{
    const struct paper *paper = (const struct paper *)model;
    const bool sharp = paper->options.deconvolution;
    const bool slopes =
        field == SELAS_STRESS || field == SELAS_STRAIN || field == SELAS_PRESSURE || field == SELAS_ENERGY;
    const size_t components = (size_t)field_components(field);
#pragma omp parallel for schedule(static)
    for (size_t i = from; i < end; i++) {
        struct point_values values = {0};
        if (field == SELAS_DISPLACEMENT) point_value(paper, i, y, sharp, values.displacement);
        if (field == SELAS_VELOCITY || field == SELAS_ENERGY)
            point_value(paper, i, y + model->unknowns, sharp, values.velocity);
        if (field == SELAS_ACCELERATION && a != NULL) point_value(paper, i, a, sharp, values.acceleration);
        if (slopes) point_gradient(paper, i, y, sharp, values.gradient);
        field_from_values(model, paper->material, &values, field, value + components * (i - from));
    }
}

/* Energies of the values as computed (not sharpened), summed with the statistical volumes: the operator is
 * not symmetric, so that u.Ku/2 would not be an energy; the strain energy is that of the gradient. Summed in
 * fixed blocks for the same bits with any number of threads. */
void paper_energy(struct model *model, const double *y, struct energy *energy)
{
    const struct paper *paper = (const struct paper *)model;
    enum { BLOCKS = 64 };
    double kinetic[BLOCKS] = {0}, strain[BLOCKS] = {0};
#pragma omp parallel for schedule(static)
    for (size_t block = 0; block < BLOCKS; block++) {
        for (size_t i = block * model->points / BLOCKS; i < (block + 1) * model->points / BLOCKS; i++) {
            struct point_values values = {0};
            double part;
            point_gradient(paper, i, y, false, values.gradient);
            field_from_values(model, paper->material, &values, SELAS_ENERGY, &part);
            strain[block] += paper->volume[i] * part;
            values = (struct point_values){0};
            point_value(paper, i, y + model->unknowns, false, values.velocity);
            field_from_values(model, paper->material, &values, SELAS_ENERGY, &part);
            kinetic[block] += paper->volume[i] * part;
        }
    }
    *energy = (struct energy){0, 0};
    for (int block = 0; block < BLOCKS; block++) {
        energy->kinetic += kinetic[block];
        energy->strain += strain[block];
    }
}

void paper_power(struct model *model, const struct drive *drive, const double *y, double *load,
                 double *absorbed)
{
    struct paper *paper = (struct paper *)model;
    const size_t dimension = (size_t)paper->dimension;
    const double *v = y + model->unknowns;
    *load = *absorbed = 0;
    if (paper_tractions(paper, drive))
        for (size_t i = 0; i < model->points; i++)
            for (size_t row = paper->load_start[i]; row < paper->load_start[i + 1]; row++)
                for (size_t c = 0; c < dimension; c++)
                    *load += paper->volume[i] * paper->load_value[row] * v[dimension * i + c] *
                             paper->traction[3 * paper->load_element[row] + c];
    for (size_t k = 0; drive->load != NULL && k < model->scene->loads; k++) {
        const struct paper_load *ready = &paper->load[k];
        for (size_t i = 0; i < ready->points; i++)
            for (size_t c = 0; c < dimension; c++)
                *load += paper->volume[ready->point[i]] * drive->load[k] * ready->push[dimension * i + c] *
                         v[dimension * ready->point[i] + c];
    }
    for (size_t k = 0; k < paper->dampers; k++) {
        const struct damper *damper = &paper->damper[k];
        const double *own = v + dimension * damper->point;
        for (size_t i = 0; i < dimension; i++)
            for (size_t j = 0; j < dimension; j++)
                *absorbed += paper->material->density * paper->volume[damper->point] * own[i] *
                             damper->matrix[i * dimension + j] * own[j];
    }
}

void paper_describe(const struct model *model,
                    void (*tell)(void *context, const char *key, const char *value), void *context)
{
    const struct paper *paper = (const struct paper *)model;
    const struct paper_options *options = &paper->options;
    char line[160];
    snprintf(line, sizeof line, "%s, h = %.4g", options->kernel->name, paper->h);
    tell(context, "kernel", line);
    snprintf(line, sizeof line, "%.4g", (double)paper->near.start[model->points] / (double)model->points);
    tell(context, "neighbours per point", line);
    double volume = 0, body = 1;
    for (size_t i = 0; i < model->points; i++)
        volume += paper->volume[i];
    for (int c = 0; c < paper->dimension; c++)
        body *= model->scene->body.high[c] - model->scene->body.low[c];
    snprintf(line, sizeof line, "%.6g of %.6g", volume, body);
    tell(context, "statistical volume", line);
    snprintf(line, sizeof line, "%g on the %s", options->filter,
             options->filter_increment ? "increment" : "displacement");
    tell(context, "filter", options->filter > 0 ? line : "none");
    tell(context, "de-convolution", options->deconvolution ? "Eq 38" : "none");
    tell(context, "row sums", options->zero_row_sums ? "zero" : "as printed");
}
