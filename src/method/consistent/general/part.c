/* The ground of a part of damped ground (method/damped/damped.h). Averages are not linear in the moduli, and their
 * kernels are negative here and there; so that a part takes and leaves nothing negative,
 *
 *   C_part = b_kappa A + b_mu (C - A),   A = dC/de for kappa (1 + e) in place of kappa everywhere,          (G11a)
 *
 * with C of the whole ground and b_kappa, b_mu the part's shares of the moduli, means over the cell about the point. C
 * is of degree 1 in the moduli, so that C - A is the derivative by mu. Eigenvalues of A in the metric of C are clipped
 * to 0 and 1 (they are 0 and 1 in even ground). */
#include "method/consistent/general/medium.h"

#include "base/gsl_errors.h"
#include "base/memory.h"
#include "method/consistent/galerkin/surface.h"

#include <gsl/gsl_eigen.h>
#include <gsl/gsl_errno.h>
#include <math.h>
#include <string.h>

enum { SAMPLES = 4 }; /* along each axis of a cell */

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
        consistent_to_ground(c, place);
        const struct shares one = ground_shares_at(scene, place);
        sum.bulk += one.bulk / count;
        sum.shear += one.shear / count;
    }
    return sum;
}

/* --- Stiffness ------------------------------------------------------------------------------------------ */

struct sharing {
    const struct consistent *c;
    gsl_eigen_symmv_workspace *room; /* for eigenvalues of symmetric matrices of STRESSES rows */
    gsl_matrix *matrix, *vector;
    gsl_vector *value;
};

static bool eigen_of(const struct sharing *eigen, double a[STRESSES][STRESSES])
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

static void unpack(const double *packed, double a[STRESSES][STRESSES])
{
    for (int p = 0; p < STRESSES; p++)
        for (int q = p; q < STRESSES; q++)
            a[p][q] = a[q][p] = *packed++;
}

/* A := A clipped between 0 and C; false: C is not positive. */
static bool clip(const struct sharing *eigen, double c[STRESSES][STRESSES], double a[STRESSES][STRESSES])
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

/* (G11a) */
static void share_stiffness(const struct sharing *sharing, const struct averaged *averaged,
                            const struct shares *share, double *stiffness)
{
    double c[STRESSES][STRESSES], a[STRESSES][STRESSES], derivative[STIFFNESSES];
    medium_bulk_stiffness(averaged, derivative);
    unpack(stiffness, c);
    unpack(derivative, a);
    const bool good = clip(sharing, c, a);
    for (int p = 0; p < STRESSES; p++)
        for (int q = p; q < STRESSES; q++)
            *stiffness++ =
                good ? share->bulk * a[p][q] + share->shear * (c[p][q] - a[p][q]) : share->shear * c[p][q];
}

void general_share(const struct sharing *sharing, const struct family *family, const size_t at[3],
                   const struct averaged *averaged, double *stiffness, double *lambda, double *mu)
{
    const struct consistent *c = sharing->c;
    double place[3] = {0};
    for (int axis = 0; axis < c->dimension; axis++)
        place[axis] = general_place(c, c->slot[axis], family->at[c->slot[axis]], at[c->slot[axis]]);
    consistent_to_ground(c, place);
    const struct shares share = ground_shares_at(c->model.scene, place);
    const double kappa = *lambda + 2. / 3 * *mu;
    *mu *= share.shear;
    *lambda = share.bulk * kappa - 2. / 3 * *mu;
    if (stiffness == NULL) return;
    const struct shares mean = mean_shares(c, family, at);
    gsl_errors_returned();
    share_stiffness(sharing, averaged, &mean, stiffness);
    gsl_errors_as_before();
}

bool general_is_part(const struct scene *scene)
{
    return scene->whole != NULL && scene->whole != scene->material;
}

struct sharing *sharing_new(const struct consistent *c)
{
    struct sharing *sharing = array_new(1, sizeof *sharing);
    if (sharing == NULL) return NULL;
    gsl_errors_returned();
    *sharing = (struct sharing){c, gsl_eigen_symmv_alloc(STRESSES), gsl_matrix_alloc(STRESSES, STRESSES),
                                gsl_matrix_alloc(STRESSES, STRESSES), gsl_vector_alloc(STRESSES)};
    gsl_errors_as_before();
    if (sharing->room != NULL && sharing->matrix != NULL && sharing->vector != NULL && sharing->value != NULL)
        return sharing;
    sharing_free(sharing);
    return NULL;
}

void sharing_free(struct sharing *sharing)
{
    if (sharing == NULL) return;
    if (sharing->room != NULL) gsl_eigen_symmv_free(sharing->room);
    gsl_matrix_free(sharing->matrix);
    gsl_matrix_free(sharing->vector);
    gsl_vector_free(sharing->value);
    array_free(sharing);
}
