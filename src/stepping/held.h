/* Loads that a host holds at a value and may change at the time reached. A linear body's acceleration, as the
 * scheme sees it, is
 *
 *   (M + dt/2 C) a = F - K u - C w + sum over k of L_k f_k,   a = a0 + sum over k of L_k g_k,             (H1)
 *
 * (the modified equation alike), g_k the acceleration by a unit of load k alone, which is 0 (below 1e-18 of its
 * largest value) but near the load. With a0 and all g_k kept where any g_k is not 0, a change of L_k costs these few
 * numbers and no operator call. */
#ifndef SELAS_HELD_H
#define SELAS_HELD_H

#include "model/model.h"

struct held {
    size_t loads,
        *load; /* those that are held: numbers of the scene's loads; 0: all changes go by the operator */
    size_t count, *index; /* unknowns that they accelerate */
    double *rest;         /* [count]: a0 */
    double *pull;         /* [loads][count]: g_k */
    double *others;       /* [scene->loads]: amplitudes of a drive, 0 for held loads */
};

/* Acceleration of the body as a scheme sees it in a step. */
typedef void held_acceleration(void *scheme, const struct drive *drive, const double *u, const double *v,
                               double *a);

/* Finds (H1); nothing is held where the model is not linear, or a host drives by functions too. SELAS_NO_MEMORY;
 * held_free() is to be called in any case. */
selas_status held_create(struct held *held, const struct model *model, held_acceleration *accelerate,
                         void *scheme, struct messages *messages);
void held_free(struct held *held);
/* The drive without the held loads: for what makes a0 of (H1). Holds until the next call. */
struct drive held_left_out(const struct held *held, const struct scene *scene, const struct drive *drive);
/* a, which is a0, gets the held loads as the drive has them. */
void held_add(struct held *held, const struct drive *drive, double *a);
/* The same after a change: a, and v, which has `half` a in it. */
void held_change(const struct held *held, const struct drive *drive, double half, double *v, double *a);

#endif
