/* Points, volumes and areas of the cloud method: Voronoi cells of the points in the body and, on each face,
 * of the points that lie on it, then the smallest relative change that makes the sums exact for polynomials.
 *
 * Gradients that sum by parts and are exact for linear fields exist only if the discrete divergence theorem
 * holds for quadratic functions (doc/theory/cloud-method.md, Eq 5): volumes exact for linear functions and areas for
 * quadratic ones are enough. */
#include "method/cloud/cloud.h"

#include "base/gsl_errors.h"
#include "base/memory.h"
#include "points/lattice.h"

#include <gsl/gsl_linalg.h>
#include <math.h>
#include <string.h>

enum { MOMENTS = 10 };

selas_status cloud_fit_weights(size_t count, size_t terms, const double *basis, const double *target,
                               double *weight, struct messages *messages)
{
    double matrix[MOMENTS * MOMENTS] = {0};
    double rest[MOMENTS] = {0};
    double change[MOMENTS] = {0};
    for (size_t k = 0; k < terms; k++)
        rest[k] = target[k];
    for (size_t i = 0; i < count; i++)
        for (size_t k = 0; k < terms; k++) {
            const double *p = basis + terms * i;
            rest[k] -= weight[i] * p[k];
            for (size_t l = 0; l < terms; l++)
                matrix[terms * k + l] += weight[i] * p[k] * p[l];
        }
    gsl_matrix_view a = gsl_matrix_view_array(matrix, terms, terms);
    gsl_vector_view b = gsl_vector_view_array(rest, terms);
    gsl_vector_view x = gsl_vector_view_array(change, terms);
    gsl_errors_returned();
    const bool solved = gsl_linalg_cholesky_decomp1(&a.matrix) == 0 &&
                        gsl_linalg_cholesky_solve(&a.matrix, &b.vector, &x.vector) == 0;
    gsl_errors_as_before();
    bool positive = solved;
    for (size_t i = 0; i < count && solved; i++) {
        double factor = 1;
        for (size_t k = 0; k < terms; k++)
            factor += change[k] * basis[terms * i + k];
        weight[i] *= factor;
        positive = positive && weight[i] > 0;
    }
    if (!positive)
        return fail(messages, SELAS_BAD_SCENE,
                    "%zu points are too few, or too uneven, for volumes and areas that sum exactly: make the "
                    "spacing or the jitter smaller",
                    count);
    return SELAS_OK;
}

/* 1, x, y, .. (centred, in halves of the box), then squares and products. */
static size_t polynomials(const double *x, const double *low, const double *high, const int *axis, int axes,
                          bool quadratic, double p[MOMENTS])
{
    double s[3];
    size_t k = 0;
    p[k++] = 1;
    for (int a = 0; a < axes && a < 3; a++)
        p[k++] = s[a] = (2 * x[axis[a]] - low[axis[a]] - high[axis[a]]) / (high[axis[a]] - low[axis[a]]);
    for (int a = 0; a < axes && quadratic; a++)
        for (int b = a; b < axes; b++)
            p[k++] = s[a] * s[b];
    return k;
}

/* Makes weights of the points exact: integral of 1 is `measure`, of linear terms and products 0, of squares a
 * third of the measure. */
static selas_status exact_weights(const struct body *body, const double *position, size_t count,
                                  const int *axis, int axes, bool quadratic, double measure, double *weight,
                                  struct messages *messages)
{
    double target[MOMENTS] = {measure};
    double p[MOMENTS];
    size_t terms = polynomials(position, body->low, body->high, axis, axes, quadratic, p);
    double *basis = array_new(terms * count, sizeof *basis);
    if (basis == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for %zu points", count);
    for (int a = 0, k = 1 + axes; a < axes && quadratic; a++)
        for (int b = a; b < axes; b++, k++)
            target[k] = a == b ? measure / 3 : 0;
    for (size_t i = 0; i < count; i++) {
        polynomials(position + 3 * i, body->low, body->high, axis, axes, quadratic, p);
        memcpy(basis + terms * i, p, terms * sizeof *p);
    }
    const selas_status status = cloud_fit_weights(count, terms, basis, target, weight, messages);
    array_free(basis);
    return status;
}

/* Elements of one face: one at each of its points, with the area of its cell in the face. */
static selas_status face_elements(struct cloud *cloud, const struct body *body, const unsigned char *faces,
                                  int face, struct messages *messages)
{
    const int d = cloud->dimension;
    const int normal = face / 2;
    size_t count = 0;
    for (size_t i = 0; i < cloud->points; i++)
        count += faces[i] >> face & 1u;
    struct cloud *flat = NULL;
    struct body patch = *body;
    selas_status status = cloud_allocate(d > 1 ? d - 1 : 1, count, &flat, messages);
    if (status != SELAS_OK || flat == NULL) return status;
    int axis[3] = {0};
    int axes = 0;
    double measure = 1;
    for (int c = 0; c < d; c++) {
        if (c == normal) continue;
        patch.low[axes] = body->low[c];
        patch.high[axes] = body->high[c];
        measure *= body->high[c] - body->low[c];
        axis[axes++] = c;
    }
    const int own[3] = {0, 1, 2};
    for (size_t i = 0, k = 0; i < cloud->points; i++) {
        if ((faces[i] >> face & 1u) == 0) continue;
        for (int a = 0; a < axes; a++)
            flat->position[3 * k + (size_t)a] = cloud->position[3 * i + (size_t)axis[a]];
        flat->volume[k++] = 1;
    }
    patch.shape = BODY_BOX;
    if (axes > 0) status = cloud_cells(flat, &patch, messages);
    if (status == SELAS_OK && axes > 0)
        status =
            exact_weights(&patch, flat->position, count, own, axes, true, measure, flat->volume, messages);
    for (size_t i = 0, k = 0; i < cloud->points && status == SELAS_OK; i++) {
        if ((faces[i] >> face & 1u) == 0) continue;
        struct face_element element = {.area = flat->volume[k++], .face = face};
        memcpy(element.position, cloud->position + 3 * i, sizeof element.position);
        element.normal[normal] = face % 2 == 0 ? -1 : 1;
        for (int a = 0; a < axes; a++)
            element.width[axis[a]] = pow(element.area, 1.0 / axes);
        status = cloud_add_element(cloud, &element, messages);
    }
    cloud_free(&flat);
    return status;
}

static selas_status make_set(const struct scene *scene, struct point_set *set, struct messages *messages)
{
    if (scene->body.shape == BODY_BOX) return lattice_create(&scene->body, scene->dimension, set, messages);
    if (scene->body.shape != BODY_POINTS)
        return fail(messages, SELAS_UNSUPPORTED,
                    "method%%variant = 'cloud' needs body%%shape = 'box' or 'points' that fill a box");
    struct cloud *given = NULL;
    selas_status status = cloud_read(scene, &given, messages);
    if (status != SELAS_OK || given == NULL) return status;
    status = point_set_from_positions(&scene->body, scene->dimension, given->points, given->position, set,
                                      messages);
    cloud_free(&given);
    return status;
}

selas_status cloud_method_points(const struct scene *scene, struct cloud **cloud, struct messages *messages)
{
    static const int all[3] = {0, 1, 2};
    struct point_set set = {0};
    struct body box = scene->body;
    box.shape = BODY_BOX;
    selas_status status = make_set(scene, &set, messages);
    if (status == SELAS_OK) status = cloud_allocate(scene->dimension, set.points, cloud, messages);
    if (status == SELAS_OK && *cloud != NULL && set.own_position != NULL) {
        memcpy((*cloud)->position, set.own_position, 3 * set.points * sizeof(double));
        (*cloud)->spacing = scene->body.spacing;
        status = cloud_cells(*cloud, &box, messages);
        if (status == SELAS_OK)
            status = exact_weights(&box, (*cloud)->position, set.points, all, scene->dimension, false,
                                   body_volume(&box, scene->dimension), (*cloud)->volume, messages);
        for (int face = 0; face < 2 * scene->dimension && status == SELAS_OK; face++)
            status = face_elements(*cloud, &box, set.faces, face, messages);
    }
    point_set_free(&set);
    if (status != SELAS_OK) cloud_free(cloud);
    return status;
}
