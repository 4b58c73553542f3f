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
    return add_faces(c, 1, &fields);
}
