/* The fused operator in double precision: kernels for degree 2 with one to three sweeps. */
#define REAL double
#define NAME(name) name##_double
#include "method/fused_kernel.h"
#include "method/fused_strips.h"
