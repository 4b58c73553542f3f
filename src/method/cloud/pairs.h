/* The pairs of a cloud and the sparse system of its pair correction (internal to the cloud method). */
#ifndef SELAS_METHOD_CLOUD_PAIRS_H
#define SELAS_METHOD_CLOUD_PAIRS_H

#include "base/messages.h"
#include "base/vectors.h"

#include <stdbool.h>
#include <stdint.h>

/* Lengths in spacings. The multipliers have 1 + d numbers a point, l_i and then the vector g_i, each for all
 * axes c of the gradient at once: lane c of a vec4. Lanes beyond the dimension are 0. */
struct cloud_pairs {
    size_t points, d;
    const double *position; /* [3 * points] */
    double low[3], high[3]; /* of the box */
    size_t *start;          /* [points + 1] */
    uint32_t *index;        /* [pairs] */
    uint32_t *back;         /* [pairs]: place of i in the row of j, counted from its start */
    double *offset;         /* [d * pairs]: x_j - x_i */
    double *weight;         /* [pairs] */
    double *value;          /* [d * pairs]: a_ij of each axis */
};

/* solver.c: (C w C^T) x = r by conjugate gradients. The system is not negative, its null space are the
 * quadratic functions (x = (f, grad f / 2)); r must be orthogonal to them. */
struct cloud_solver;
struct cloud_solvers {
    selas_status (*create)(const struct cloud_pairs *pairs, struct cloud_solver **solver,
                           struct messages *messages);
    void (*free)(struct cloud_solver **solver);
    /* All axes at once, each until the root mean square of its residual is below `small`; r and x
     * [(d + 1) * points], r is spent. Number of iterations, -1 if it does not get there. */
    int (*solve)(struct cloud_solver *solver, vec4 *r, double small, vec4 *x);
    /* a += w C^T x. */
    void (*correct)(struct cloud_pairs *pairs, const vec4 *x);
};
EACH_PROCESSOR(struct cloud_solvers, cloud_solvers)

#endif
