/* The fused operator and step in single precision: in this
 * order: each needs those before. */
#define REAL float
#define NAME(name) name##_single
#define FUSED(c) ((c)->fused->single)
#include "method/consistent/fused/active.h"

#include "method/consistent/fused/fused_strips.h"

#include "method/consistent/galerkin/hform_edges.h"

#include "method/consistent/fused/faces.h"
#include "method/consistent/fused/fused_step.h"
