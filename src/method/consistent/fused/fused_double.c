/* The fused operator and step in double precision: in this
 * order: each needs those before. */
#define REAL double
#define NAME(name) name##_double
#define FUSED(c) ((c)->fused)
#include "method/consistent/fused/active.h"

#include "method/consistent/fused/fused_strips.h"

#include "method/consistent/galerkin/hform_edges.h"

#include "method/consistent/fused/faces.h"
#include "method/consistent/fused/fused_step.h"

bool fused_add_faces_double(const struct consistent *c, const double *u, double *a)
{
    const struct fused_fields fields = {.u = u, .a = a};
    if (left_at_faces(c, &fields) == NULL) return false;
#pragma omp parallel for num_threads(c->threads) schedule(static)
    for (int thread = 0; thread < c->threads; thread++) {
        const size_t n = c->n[DEPTH], all = (size_t)c->threads, from = (size_t)thread * n / all;
        for (size_t k = from; k < (size_t)(thread + 1) * n / all; k++)
            add_faces(c, thread, 1, &fields, k == from, k);
    }
    return true;
}
