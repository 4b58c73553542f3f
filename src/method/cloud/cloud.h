/* Smoothed points on clouds (doc/theory/cloud-method.md): what its files share with the total-Lagrangian model that
 * carries it (struct tl_form).
 *
 * Points lie in the body and on its faces. Gradients G_ij = Q_ij / V_i with Q_ij + Q_ji = n_i A_i (i = j) or
 * 0, so that summation by parts holds, and linear fields are exact. */
#ifndef SELAS_METHOD_CLOUD_CLOUD_H
#define SELAS_METHOD_CLOUD_CLOUD_H

#include "method/total_lagrangian/total_lagrangian.h"

extern const struct method method_cloud;
extern const struct tl_form cloud_form;

/* points.c. Points of the box with jitter, or those of a file or host, with a point on every face;
 * volumes exact for linear functions, areas of each face's elements (one a point, at the point) exact for
 * quadratic ones. */
selas_status cloud_method_points(const struct scene *scene, struct cloud **cloud, struct messages *messages);
/* Weights w_i (1 + sum over k of c_k p_k) with sum over i of weight p_k = target[k]; basis[terms * i + k] is
 * p_k at i, terms <= 10. SELAS_BAD_SCENE if they cannot be had with all weights positive. */
selas_status cloud_fit_weights(size_t count, size_t terms, const double *basis, const double *target,
                               double *weight, struct messages *messages);

/* gradients.c. The antisymmetric pair correction; fills tl->gradient. */
selas_status cloud_gradients(struct tl_model *tl, const struct neighbours *near, struct messages *messages);

/* boundary.c: unknowns at rest (tl->held), tractions on faces into force[dimension * points]. */
selas_status cloud_hold(struct tl_model *tl, struct messages *messages);
selas_status cloud_traction(struct tl_model *tl, const struct load *load, const double centre[3],
                            const double direction[3], double *force, struct messages *messages);

#endif
