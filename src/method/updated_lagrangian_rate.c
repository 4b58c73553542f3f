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
 * threads. Pairs within reach are packed into batches, component by component, so that the arithmetic runs in
 * vectors; a batch is full when it holds BATCH pairs within reach, so that it does not depend on when the
 * lists were made either. */
#include "method/updated_lagrangian.h"

#include <math.h>
#include <string.h>

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define VECTOR_CLONES __attribute__((target_clones("default", "arch=x86-64-v3")))
#else
#define VECTOR_CLONES
#endif

enum { BATCH = 64, BLOCK = 32 };

/* Sums over the neighbours of one particle. */
struct sums {
    double matrix[6];      /* V grad W (x_j - x_i), symmetric, over what deforms with the body */
    double full[6];        /* the same over all: with the ghosts of loaded faces */
    double velocity[3][3]; /* V (v_j - v_i) grad W */
    double mass[3];        /* m grad W */
    double tension[6][3];  /* m (s_j/rho_j^2 + f^4 R_j) grad W */
    double viscous[3];     /* m Pi grad W */
    double repulsive[3];   /* m f^4 grad W */
};

/* Pairs of one particle that are within reach. After weigh() span, volume and mass carry the factor W'/r, so
 * that times d they are V grad W, m grad W. */
struct batch {
    int count;
    double d[3][BATCH], change[3][BATCH]; /* x_i - x_j, v_j - v_i */
    double square[BATCH], length[BATCH];  /* h of the pair over the usual one */
    double span[BATCH], volume[BATCH], mass[BATCH];
    double tension[6][BATCH], repulsion[6][BATCH];
    double pressure[BATCH], strength[BATCH]; /* m Pi W'/r, m f^4 W'/r */
};

/* The cubic spline by truncated powers, w = ((2 - q)^3 - 4 (1 - q)^3) / 6, each where positive: no branch. */
static inline double cubic_slope_over_q(double q)
{
    const double outer = q < 2 ? 2 - q : 0, inner = q < 1 ? 1 - q : 0;
    return (2 * inner * inner - outer * outer / 2) / q;
}

static inline double cubic_shape(double q)
{
    const double outer = q < 2 ? 2 - q : 0, inner = q < 1 ? 1 - q : 0;
    return (outer * outer * outer - 4 * inner * inner * inner) / 6;
}

/* Monaghan's viscosity, Eq 17 with r_ij read as a vector, between pairs that approach each other. */
__attribute__((always_inline)) static inline void
add_viscosity(const struct updated *updated, const int dimension, double density, struct batch *batch)
{
    const double usual = updated->smoothing_length, alpha = updated->alpha * updated->sound_speed,
                 beta = updated->beta;
    const bool both_sides = updated->both_sides;
#pragma omp simd
    for (int n = 0; n < batch->count; n++) {
        double approach = 0;
        for (int a = 0; a < dimension; a++)
            approach -= batch->change[a][n] * batch->d[a][n];
        const double h = usual * batch->length[n];
        const double phi = h * approach / (batch->square[n] + .01 * h * h);
        const double mean = (density + batch->mass[n] / batch->volume[n]) / 2;
        const double viscosity = batch->mass[n] * (beta * phi * phi - alpha * phi) / mean;
        batch->pressure[n] = both_sides || approach < 0 ? viscosity : 0;
    }
}

/* Kernel factors of a batch. */
__attribute__((always_inline)) static inline void weigh(const struct updated *updated, const int dimension,
                                                        const bool viscous, const bool repulsive,
                                                        struct batch *batch)
{
    const struct kernel *kernel = updated->options.kernel;
    const double h = updated->smoothing_length, scale = updated->slope_scale;
    double slope[BATCH], shape[BATCH];
    if (updated->cubic) {
#pragma omp simd
        for (int n = 0; n < batch->count; n++) {
            const double q = sqrt(batch->square[n]) / (h * batch->length[n]);
            slope[n] = scale * cubic_slope_over_q(q);
            if (repulsive) shape[n] = cubic_shape(q);
        }
    } else {
        for (int n = 0; n < batch->count; n++) {
            const double q = sqrt(batch->square[n]) / (h * batch->length[n]);
            slope[n] = scale * kernel->slope_over_q(dimension, q);
            if (repulsive) shape[n] = kernel->shape(dimension, q);
        }
    }
    if (!updated->even)
        for (int n = 0; n < batch->count; n++) {
            const double g = batch->length[n], square = g * g;
            slope[n] /= dimension == 1 ? square * g : dimension == 2 ? square * square : square * square * g;
        }
    const int stresses = dimension * (dimension + 1) / 2;
#pragma omp simd
    for (int n = 0; n < batch->count; n++) {
        batch->span[n] *= slope[n];
        batch->volume[n] *= slope[n];
        batch->mass[n] *= slope[n];
        if (viscous) batch->pressure[n] *= slope[n];
        if (repulsive) {
            const double f = updated->repulsion_scale * shape[n], power = f * f * f * f;
            batch->strength[n] = batch->mass[n] * power;
            for (int s = 0; s < stresses; s++)
                batch->tension[s][n] += power * batch->repulsion[s][n];
        }
    }
}

__attribute__((always_inline)) static inline double dot(const struct batch *batch, const double *weight,
                                                        const double *x)
{
    double sum = 0;
#pragma omp simd reduction(+ : sum)
    for (int n = 0; n < batch->count; n++)
        sum += weight[n] * x[n];
    return sum;
}

__attribute__((always_inline)) static inline void add_batch(const struct updated *updated,
                                                            const int dimension, const bool viscous,
                                                            const bool repulsive, double density,
                                                            struct batch *batch, struct sums *sums)
{
    if (viscous) add_viscosity(updated, dimension, density, batch);
    weigh(updated, dimension, viscous, repulsive, batch);
    const int stresses = dimension * (dimension + 1) / 2;
    double product[BATCH];
    for (int a = 0; a < dimension; a++) {
        const double *d = batch->d[a];
        sums->mass[a] += dot(batch, batch->mass, d);
        if (viscous) sums->viscous[a] += dot(batch, batch->pressure, d);
        if (repulsive) sums->repulsive[a] += dot(batch, batch->strength, d);
#pragma omp simd
        for (int n = 0; n < batch->count; n++)
            product[n] = batch->mass[n] * d[n];
        for (int s = 0; s < stresses; s++)
            sums->tension[s][a] += dot(batch, batch->tension[s], product);
#pragma omp simd
        for (int n = 0; n < batch->count; n++)
            product[n] = batch->span[n] * d[n];
        for (int b = 0; b < dimension; b++)
            sums->velocity[b][a] += dot(batch, batch->change[b], product);
        for (int b = a; b < dimension; b++)
            sums->matrix[updated_component[dimension][a][b]] -= dot(batch, batch->d[b], product);
        if (!updated->pressed) continue;
#pragma omp simd
        for (int n = 0; n < batch->count; n++)
            product[n] = batch->volume[n] * d[n];
        for (int b = a; b < dimension; b++)
            sums->full[updated_component[dimension][a][b]] -= dot(batch, batch->d[b], product);
    }
    batch->count = 0;
}

__attribute__((always_inline)) static inline void gather(const struct updated *updated, const int dimension,
                                                         const bool viscous, const bool repulsive, size_t i,
                                                         struct sums *sums)
{
    const struct updated_layout layout = updated->layout;
    const int stresses = dimension * (dimension + 1) / 2;
    const double reach = updated->reach * updated->reach;
    const double *own = updated->record + layout.size * i;
    const double density = own[layout.mass] / own[layout.volume];
    struct batch batch;
    batch.count = 0;
    for (size_t k = updated->neighbours.start[i]; k < updated->neighbours.start[i + 1]; k++) {
        const double *other = updated->record + layout.size * updated->neighbours.index[k];
        const int n = batch.count;
        double square = 0;
        for (int a = 0; a < dimension; a++) {
            const double d = own[a] - other[a];
            batch.d[a][n] = d;
            square += d * d;
        }
        const double length = (own[layout.length] + other[layout.length]) / 2;
        if (!(square < reach * length * length)) continue;
        batch.square[n] = square;
        batch.length[n] = length;
        batch.volume[n] = other[layout.volume];
        batch.span[n] = other[layout.span];
        batch.mass[n] = other[layout.mass];
        for (int a = 0; a < dimension; a++)
            batch.change[a][n] = other[layout.velocity + (size_t)a] - own[layout.velocity + (size_t)a];
        for (int s = 0; s < stresses; s++)
            batch.tension[s][n] = other[layout.tension + (size_t)s];
        if (repulsive)
            for (int s = 0; s < stresses; s++)
                batch.repulsion[s][n] = other[layout.repulsion + (size_t)s];
        if (++batch.count == BATCH) add_batch(updated, dimension, viscous, repulsive, density, &batch, sums);
    }
    add_batch(updated, dimension, viscous, repulsive, density, &batch, sums);
}

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

/* Rates of the particles first ... last - 1. */
__attribute__((always_inline)) static inline void rates(const struct updated *updated, const int dimension,
                                                        const bool viscous, const bool repulsive,
                                                        size_t first, size_t last, const double *y,
                                                        double *dydt)
{
    const size_t points = updated->cloud->points, unknowns = updated->model.unknowns;
    const size_t dim = (size_t)dimension, stresses = dim * (dim + 1) / 2;
    const struct updated_layout layout = updated->layout;
    const double *density = y + 2 * unknowns, *stress = density + points;
    double *acceleration = dydt + unknowns, *density_rate = dydt + 2 * unknowns,
           *stresses_rate = density_rate + points;
    for (size_t i = first; i < last; i++) {
        struct sums sums = {0};
        gather(updated, dimension, viscous, repulsive, i, &sums);
        double inverse[3][3];
        if (!updated->options.correction) {
            memset(sums.matrix, 0, sizeof sums.matrix);
            memset(sums.full, 0, sizeof sums.full);
        }
        invert(dimension, sums.matrix, inverse);
        double gradient[3][3] = {{0}}, trace = 0;
        for (int a = 0; a < dimension; a++) {
            for (int b = 0; b < dimension; b++)
                for (int c = 0; c < dimension; c++)
                    gradient[a][b] += sums.velocity[a][c] * inverse[b][c];
            trace += gradient[a][a];
        }
        const double *own = updated->record + layout.size * i;
        if (updated->pressed) invert(dimension, sums.full, inverse);
        for (int a = 0; a < dimension; a++) {
            double sum = 0;
            for (int c = 0; c < dimension; c++) {
                for (int b = 0; b < dimension; b++) {
                    const size_t s = (size_t)updated_component[dimension][a][b];
                    double tension = sums.tension[s][c] + own[layout.tension + s] * sums.mass[c];
                    if (repulsive) tension += own[layout.repulsion + s] * sums.repulsive[c];
                    sum += tension * inverse[b][c];
                }
                if (viscous) sum -= sums.viscous[c] * inverse[a][c];
            }
            acceleration[dim * i + (size_t)a] = sum;
        }
        density_rate[i] = -density[i] * trace;
        stress_rate(updated, dimension, gradient, stress + stresses * i, stresses_rate + stresses * i);
    }
}

/* Instances with constant dimension and switches: what is off is not there. */
#define RATES(dimension)                                                                                     \
    VECTOR_CLONES static void rates_##dimension(const struct updated *updated, size_t first, size_t last,    \
                                                const double *y, double *dydt)                               \
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
    add_body_forces(updated, drive, y, dydt + unknowns);
}
