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
 * threads. */
#include "method/updated_lagrangian.h"

#include <math.h>
#include <string.h>

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

/* Eq 17 with r_ij read as a vector; acts on pairs that approach each other. */
static inline double viscosity(const struct updated *updated, double approach, double square, double density)
{
    const double h = updated->smoothing_length;
    const double phi = h * approach / (square + .01 * h * h);
    return (-updated->alpha * updated->sound_speed * phi + updated->beta * phi * phi) / density;
}

__attribute__((always_inline)) static inline void gather(const struct updated *updated, const int dimension,
                                                         const bool viscous, const bool repulsive, size_t i,
                                                         struct sums *sums)
{
    const struct kernel *kernel = updated->options.kernel;
    const struct updated_layout layout = updated->layout;
    const int stresses = dimension * (dimension + 1) / 2;
    const double h = updated->smoothing_length, reach = kernel->support * h;
    double scale = kernel->normalisation[dimension - 1] / (h * h);
    for (int a = 0; a < dimension; a++)
        scale /= h;
    const bool pressed = updated->pressed;
    const double *own = updated->record + layout.size * i;
    for (size_t k = updated->neighbours.start[i]; k < updated->neighbours.start[i + 1]; k++) {
        const double *other = updated->record + layout.size * updated->neighbours.index[k];
        double d[3], square = 0;
        for (int a = 0; a < dimension; a++) {
            d[a] = own[a] - other[a];
            square += d[a] * d[a];
        }
        if (square >= reach * reach) continue;
        const double q = sqrt(square) / h;
        const double slope = scale * kernel->slope_over_q(dimension, q);
        const double span = other[layout.span] * slope, mass = other[layout.mass] * slope;
        const double volume = pressed ? other[layout.volume] * slope : span;
        double change[3], approach = 0;
        for (int a = 0; a < dimension; a++) {
            change[a] = other[layout.velocity + (size_t)a] - own[layout.velocity + (size_t)a];
            approach -= change[a] * d[a];
        }
        for (int a = 0; a < dimension; a++) {
            sums->mass[a] += mass * d[a];
            for (int b = 0; b < dimension; b++)
                sums->velocity[a][b] += span * change[a] * d[b];
            for (int b = a; b < dimension; b++)
                sums->matrix[updated_component[dimension][a][b]] -= span * d[a] * d[b];
            if (pressed)
                for (int b = a; b < dimension; b++)
                    sums->full[updated_component[dimension][a][b]] -= volume * d[a] * d[b];
        }
        double repulsion = 0;
        if (repulsive) {
            const double f = updated->repulsion_scale * kernel->shape(dimension, q);
            repulsion = f * f * f * f;
        }
        for (int s = 0; s < stresses; s++) {
            double tension = other[layout.tension + (size_t)s];
            if (repulsive) tension += repulsion * other[layout.repulsion + (size_t)s];
            for (int a = 0; a < dimension; a++)
                sums->tension[s][a] += mass * tension * d[a];
        }
        if (repulsive)
            for (int a = 0; a < dimension; a++)
                sums->repulsive[a] += mass * repulsion * d[a];
        if (viscous && (approach < 0 || updated->both_sides)) {
            const double density =
                (own[layout.mass] / own[layout.volume] + other[layout.mass] / other[layout.volume]) / 2;
            const double pressure = mass * viscosity(updated, approach, square, density);
            for (int a = 0; a < dimension; a++)
                sums->viscous[a] += pressure * d[a];
        }
    }
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
            if (updated->options.jaumann && dimension > 1)
                for (int c = 0; c < dimension; c++) {
                    const double ac = (g[a][c] - g[c][a]) / 2, cb = (g[c][b] - g[b][c]) / 2;
                    sum += ac * stress[updated_component[dimension][c][b]] -
                           stress[updated_component[dimension][a][c]] * cb;
                }
            rate[updated_component[dimension][a][b]] = sum;
        }
}

__attribute__((always_inline)) static inline void rates(struct updated *updated, const int dimension,
                                                        const bool viscous, const bool repulsive,
                                                        const double *y, double *dydt)
{
    const size_t points = updated->cloud->points, unknowns = updated->model.unknowns;
    const size_t dim = (size_t)dimension, stresses = dim * (dim + 1) / 2;
    const struct updated_layout layout = updated->layout;
    const double *density = y + 2 * unknowns, *stress = density + points;
    double *acceleration = dydt + unknowns, *density_rate = dydt + 2 * unknowns,
           *stresses_rate = density_rate + points;
#pragma omp parallel for schedule(static)
    for (size_t i = 0; i < points; i++) {
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
static void rates_of_dimension(struct updated *updated, const double *y, double *dydt)
{
    const bool viscous = updated->alpha > 0 || updated->beta > 0, repulsive = updated->repulsive;
#define SELAS_RATES(dimension)                                                                               \
    if (viscous && repulsive)                                                                                \
        rates(updated, dimension, true, true, y, dydt);                                                      \
    else if (viscous)                                                                                        \
        rates(updated, dimension, true, false, y, dydt);                                                     \
    else if (repulsive)                                                                                      \
        rates(updated, dimension, false, true, y, dydt);                                                     \
    else                                                                                                     \
        rates(updated, dimension, false, false, y, dydt);
    if (updated->dimension == 1) {
        SELAS_RATES(1)
    } else if (updated->dimension == 2) {
        SELAS_RATES(2)
    } else {
        SELAS_RATES(3)
    }
#undef SELAS_RATES
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
    rates_of_dimension(updated, y, dydt);
    add_body_forces(updated, drive, y, dydt + unknowns);
}
