/* The smooth part of the pair correction's multipliers on cubic B-splines (internal to the cloud method). */
#ifndef SELAS_METHOD_CLOUD_SPLINES_H
#define SELAS_METHOD_CLOUD_SPLINES_H

#include "method/cloud/pairs.h"

struct cloud_splines;
/* Lays the knots and factorises Galerkin's matrix. SELAS_BAD_SCENE: it is singular. */
selas_status OF_PROCESSOR(cloud_splines_create)(const struct cloud_pairs *pairs,
                                                struct cloud_splines **splines, struct messages *messages);
void OF_PROCESSOR(cloud_splines_free)(struct cloud_splines **splines);
/* z += P (P^T A P)^-1 P^T r; r and z [(d + 1) * points] (cloud_solve). */
void OF_PROCESSOR(cloud_splines_add)(struct cloud_splines *splines, const vec4 *r, vec4 *z);

#endif
