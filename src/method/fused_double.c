/* The fused operator and step in double precision: kernels for degree 2 with one to three sweeps. In this
 * order: each needs those before. */
#define REAL double
#define NAME(name) name##_double
#define FUSED(c) ((c)->fused)
#include "method/fused_kernel.h"

#include "method/fused_window.h"

#include "method/fused_strips.h"

#include "method/hform_edges.h"

#include "method/fused_step.h"
