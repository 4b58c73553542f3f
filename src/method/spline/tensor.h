/* Sums of Kronecker products applied plane by plane.
 *
 * The operators of the consistent method are sums of terms factor * A_x (x) A_y (x) A_z from one component to
 * another, each A a band matrix of one axis. A plan shares what terms have in common; up to four z planes of the
 * result are made together, strip after strip of rows in buffers that stay in the cache, by 1-D passes in the order z,
 * y, x, all of them unit-stride loops over x. Sums are in a fixed order: the result depends neither on the number of
 * threads nor on what is made together. */
#ifndef SELAS_METHOD_SPLINE_TENSOR_H
#define SELAS_METHOD_SPLINE_TENSOR_H

#include "method/spline/band.h"

struct tensor_term {
    int out, in;                  /* components */
    const struct band *matrix[3]; /* axes x, y, z; NULL = identity; not owned */
    double factor;
};

struct tensor_plan;

/* Entries that a matrix may have on each side of its diagonal; planes that are made together, at most; rows of a
 * strip. */
enum { TENSOR_MOST_HALF = 63, TENSOR_PLANES = 4, TENSOR_STRIP = 8 };

/* Plan for fields of n[0] x n[1] x n[2] values a component (x fastest, component stride = their product);
 * keeps the pointers to the matrices. NULL: no memory, or a matrix wider than TENSOR_MOST_HALF. */
struct tensor_plan *tensor_plan_new(const size_t n[3], int components, const struct tensor_term *terms,
                                    size_t count, int threads);
void tensor_plan_free(struct tensor_plan *plan);
size_t tensor_plan_bytes(const struct tensor_plan *plan);

/* Adds factor * (plan's operator on u) to out[component], where plane k begins: in `planes` planes from k on (1 to
 * TENSOR_PLANES) at least the rows from .. end - 1; thread is the caller's number below `threads`. */
void tensor_planes(const struct tensor_plan *plan, int thread, size_t k, size_t planes, size_t from,
                   size_t end, double factor, const double *u, double *const *out);

/* All of one plane. */
void tensor_plane(const struct tensor_plan *plan, int thread, size_t k, double factor, const double *u,
                  double *const *out);

/* Control values that a number reads on each side, at most: along x (slot 0), y, z. */
size_t tensor_reach(const struct tensor_plan *plan, int slot);

/* w^T A u, summed plane by plane; of the rows [0] .. [1] - 1 of such planes of w alone. */
double tensor_form(struct tensor_plan *plan, const double *w, const double *u);
double tensor_form_part(struct tensor_plan *plan, const size_t rows[2], const size_t planes[2],
                        const double *w, const double *u);

#endif
