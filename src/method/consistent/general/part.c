/* The ground of a part of damped ground (method/damped/damped.h). Averages are not linear in the moduli, and their
 * kernels are negative here and there; so that a part takes and leaves nothing negative,
 *
 *   C_part = b_kappa A + b_mu (C - A),   A = dC/de for kappa (1 + e) in place of kappa everywhere,          (G11a)
 *
 * with C of the whole ground and b_kappa, b_mu the part's shares of the moduli, means over the cell about the point. C
 * is of degree 1 in the moduli, so that C - A is the derivative by mu. Eigenvalues of A in the metric of C are clipped
 * to 0 and 1 (they are 0 and 1 in even ground). */
#include "method/consistent/general/general.h"

#include "base/gsl_errors.h"
#include "base/memory.h"
#include "method/consistent/galerkin/surface.h"
#include "scene/ground.h"
#include "scene/topography.h"

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <math.h>
#include <string.h>

enum { SAMPLES = 4, SIDES = 2 }; /* along each axis of a cell */
static const double little = 1e-4;

/* The ground's place of a place of the lattice: below a surface that is not level another depth. */
static void to_ground(const struct consistent *c, double place[3])
{
    const struct topography *topography = c->model.scene->body.topography;
    const int last = c->dimension - 1;
    if (topography != NULL)
        place[last] = topography_real(topography, consistent_drop(c, place, NULL), place[last]);
}

/* Their mean over the cell about a point of a family. */
static struct shares mean_shares(const struct consistent *c, const struct family *family, const size_t at[3])
{
    const struct scene *scene = c->model.scene;
    const int samples = scene->body.model != NULL && scene->body.blocks == 0 ? SAMPLES / 2 : SAMPLES;
    struct shares sum = {0, 0};
    double middle[3] = {0}, spacing[3] = {0};
    for (int axis = 0; axis < c->dimension; axis++) {
        const int slot = c->slot[axis];
        const struct spline *spline = c->layout[slot];
        middle[axis] = general_place(c, slot, family->at[slot], at[slot]);
        spacing[axis] = (spline->high - spline->low) / (double)spline->cells;
    }
    const int count = c->dimension == 3 ? samples * samples * samples : samples * samples;
    for (int sample = 0; sample < count; sample++) {
        const int step[3] = {sample % samples, sample / samples % samples, sample / samples / samples};
        double place[3] = {0};
        for (int axis = 0; axis < c->dimension; axis++)
            place[axis] = middle[axis] + ((step[axis] + .5) / samples - .5) * spacing[axis];
        to_ground(c, place);
        const struct shares one = ground_shares_at(scene, place);
        sum.bulk += one.bulk / count;
        sum.shear += one.shear / count;
    }
    return sum;
}

/* --- Stiffness ------------------------------------------------------------------------------------------ */

/* Room for eigenvalues of symmetric matrices of STRESSES rows. */
struct eigen {
    gsl_eigen_symmv_workspace *room;
    gsl_matrix *matrix, *vector;
    gsl_vector *value;
};

static bool eigen_of(struct eigen *eigen, double a[STRESSES][STRESSES])
{
    for (size_t p = 0; p < STRESSES; p++)
        for (size_t q = 0; q < STRESSES; q++)
            gsl_matrix_set(eigen->matrix, p, q, (a[p][q] + a[q][p]) / 2);
    return gsl_eigen_symmv(eigen->matrix, eigen->value, eigen->vector, eigen->room) == GSL_SUCCESS;
}

/* product := L^T A L or, turned, L A L^T. */
static void both_sides(double l[STRESSES][STRESSES], double a[STRESSES][STRESSES], bool turned,
                       double product[STRESSES][STRESSES])
{
    double half[STRESSES][STRESSES] = {{0}};
    memset(product, 0, sizeof half);
    for (int p = 0; p < STRESSES; p++)
        for (int q = 0; q < STRESSES; q++)
            for (int k = 0; k < STRESSES; k++)
                half[p][q] += a[p][k] * (turned ? l[q][k] : l[k][q]);
    for (int p = 0; p < STRESSES; p++)
        for (int q = 0; q < STRESSES; q++)
            for (int k = 0; k < STRESSES; k++)
                product[p][q] += (turned ? l[p][k] : l[k][p]) * half[k][q];
}

static void unpack(const double *packed, size_t apart, double a[STRESSES][STRESSES])
{
    for (int p = 0; p < STRESSES; p++)
        for (int q = p; q < STRESSES; q++, packed += apart)
            a[p][q] = a[q][p] = *packed;
}

/* A := A clipped between 0 and C; false: C is not positive. */
static bool clip(struct eigen *eigen, double c[STRESSES][STRESSES], double a[STRESSES][STRESSES])
{
    double root[STRESSES][STRESSES], inverse[STRESSES][STRESSES], inner[STRESSES][STRESSES];
    if (!eigen_of(eigen, c)) return false;
    for (size_t q = 0; q < STRESSES; q++) {
        const double value = gsl_vector_get(eigen->value, q);
        if (!(value > 0)) return false;
        for (size_t p = 0; p < STRESSES; p++) {
            root[p][q] = gsl_matrix_get(eigen->vector, p, q) * sqrt(value);
            inverse[p][q] = gsl_matrix_get(eigen->vector, p, q) / sqrt(value);
        }
    }
    both_sides(inverse, a, false, inner);
    if (!eigen_of(eigen, inner)) return false;
    memset(inner, 0, sizeof inner);
    for (size_t k = 0; k < STRESSES; k++) {
        const double value = fmin(fmax(gsl_vector_get(eigen->value, k), 0), 1);
        for (size_t p = 0; p < STRESSES; p++)
            for (size_t q = 0; q < STRESSES; q++)
                inner[p][q] +=
                    value * gsl_matrix_get(eigen->vector, p, k) * gsl_matrix_get(eigen->vector, q, k);
    }
    both_sides(root, inner, true, a);
    return true;
}

/* Numbers of point m of a run: of the whole ground, and of it with kappa (1 +- little) times. */
static void set_point(struct eigen *eigen, double *whole, const double *const side[SIDES], size_t apart,
                      const struct shares *share)
{
    double c[STRESSES][STRESSES], a[STRESSES][STRESSES], less[STRESSES][STRESSES];
    unpack(whole, apart, c);
    unpack(side[0], apart, a);
    unpack(side[1], apart, less);
    for (int p = 0; p < STRESSES; p++)
        for (int q = 0; q < STRESSES; q++)
            a[p][q] = (a[p][q] - less[p][q]) / (2 * little);
    const bool good = clip(eigen, c, a);
    for (int p = 0; p < STRESSES; p++)
        for (int q = p; q < STRESSES; q++, whole += apart)
            *whole =
                good ? share->bulk * a[p][q] + share->shear * (c[p][q] - a[p][q]) : share->shear * c[p][q];
}

/* --- Families ------------------------------------------------------------------------------------------- */

static bool alike(const struct family *one, const struct family *other)
{
    return one->runs == other->runs &&
           (one->runs == 0 || memcmp(one->run, other->run, one->runs * sizeof *one->run) == 0);
}

/* From the whole ground's numbers to the part's; `side`: families with kappa (1 +- little) times. */
static bool turn_family(const struct consistent *c, struct eigen *eigen,
                        const struct family *const side[SIDES], struct family *family)
{
    const size_t *n = family->n;
    if (!alike(side[0], family) || !alike(side[1], family)) return false;
    for (size_t point = 0; point < n[0] * n[1] * n[2]; point++) {
        const size_t at[3] = {point % n[0], point / n[0] % n[1], point / n[0] / n[1]};
        double place[3] = {0};
        for (int axis = 0; axis < c->dimension; axis++)
            place[axis] = general_place(c, c->slot[axis], family->at[c->slot[axis]], at[c->slot[axis]]);
        to_ground(c, place);
        const struct shares share = ground_shares_at(c->model.scene, place);
        const double kappa = family->lambda[point] + 2. / 3 * family->mu[point];
        family->mu[point] *= share.shear;
        family->lambda[point] = share.bulk * kappa - 2. / 3 * family->mu[point];
    }
    for (size_t row = 0; row < n[1] * n[2]; row++)
        for (size_t r = family->first_run[row]; r < family->first_run[row + 1]; r++)
            for (size_t m = 0; m < family->run[r].count; m++) {
                const size_t at[3] = {family->run[r].from + m, row % n[1], row / n[1]};
                const size_t first = family->run[r].at + m;
                const double *const sides[SIDES] = {side[0]->stiffness + first, side[1]->stiffness + first};
                const struct shares share = mean_shares(c, family, at);
                set_point(eigen, family->stiffness + first, sides, family->run[r].count, &share);
            }
    return true;
}

/* New families in place of those there, which are kept elsewhere: with kappa 1 + `bulk` times. */
static selas_status lay(struct consistent *c, double bulk, struct messages *messages)
{
    struct general *g = c->general;
    const struct scene *scene = c->model.scene;
    struct scene varied = *scene;
    varied.more_bulk = bulk;
    double *mass = array_new(c->volume, sizeof *mass);
    bool good = mass != NULL;
    for (int f = 0; f < 3; f++) {
        struct family *family = &g->family[f];
        const size_t points = family->n[0] * family->n[1] * family->n[2];
        family->first_run = NULL;
        family->run = NULL;
        family->stiffness = NULL;
        family->runs = 0;
        family->lambda = array_new(points, sizeof(double));
        family->mu = array_new(points, sizeof(double));
        good = good && family->lambda != NULL && family->mu != NULL;
    }
    c->model.scene = &varied;
    const selas_status status = good ? general_material(c, mass, messages)
                                     : fail(messages, SELAS_NO_MEMORY, "no memory for the ground");
    c->model.scene = scene;
    array_free(mass);
    return status;
}

static selas_status turn(struct consistent *c, struct family side[SIDES][3], struct messages *messages)
{
    gsl_errors_returned();
    struct eigen eigen = {gsl_eigen_symmv_alloc(STRESSES), gsl_matrix_alloc(STRESSES, STRESSES),
                          gsl_matrix_alloc(STRESSES, STRESSES), gsl_vector_alloc(STRESSES)};
    bool room = eigen.room != NULL && eigen.matrix != NULL && eigen.vector != NULL && eigen.value != NULL;
    selas_status status = room ? SELAS_OK : fail(messages, SELAS_NO_MEMORY, "no memory for the ground");
    for (int f = 0; f < 3 && status == SELAS_OK; f++) {
        const struct family *const sides[SIDES] = {&side[0][f], &side[1][f]};
        if (!turn_family(c, &eigen, sides, &c->general->family[f]))
            status =
                fail(messages, SELAS_UNSUPPORTED, "damped ground whose averages differ in kind by kappa");
    }
    if (eigen.room != NULL) gsl_eigen_symmv_free(eigen.room);
    gsl_matrix_free(eigen.matrix);
    gsl_matrix_free(eigen.vector);
    gsl_vector_free(eigen.value);
    gsl_errors_as_before();
    return status;
}

/* Families of both sides, then of the part in place of the whole. */
static selas_status lay_part(struct consistent *c, struct messages *messages)
{
    struct family side[SIDES][3], whole[3];
    selas_status status = SELAS_OK;
    memcpy(whole, c->general->family, sizeof whole);
    memset(side, 0, sizeof side);
    for (int i = 0; i < SIDES && status == SELAS_OK; i++) {
        status = lay(c, i == 0 ? little : -little, messages);
        memcpy(side[i], c->general->family, sizeof side[i]);
        memcpy(c->general->family, whole, sizeof whole);
    }
    if (status == SELAS_OK) status = turn(c, side, messages);
    for (int i = 0; i < SIDES; i++)
        for (int f = 0; f < 3; f++)
            general_free_family(&side[i][f]);
    return status;
}

selas_status general_part_material(struct consistent *c, double *mass, struct messages *messages)
{
    const struct scene *scene = c->model.scene;
    selas_status status = general_material(c, mass, messages);
    if (status == SELAS_OK && scene->whole != NULL && scene->whole != scene->material)
        status = lay_part(c, messages);
    return status;
}
