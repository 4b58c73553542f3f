/* Vectors as C extensions of gcc and clang, which compile on any machine. Kernels use those of their kind of
 * processor (base/processor.h); what they call must be inlined into them (INLINED), as functions that take or
 * return vectors would differ between kinds. */
#ifndef SELAS_VECTORS_H
#define SELAS_VECTORS_H

#include "base/machine.h"
#include "base/processor.h"

#include <math.h>
#include <string.h>

/* As wide as the kind's registers; aligned as a double is, so that they can be loaded from anywhere in an
 * array. */
typedef double lanes __attribute__((vector_size(VECTOR_BYTES), aligned(8), may_alias));
/* What comparisons of them give: all bits where they hold. */
typedef long long lanes_mask __attribute__((vector_size(VECTOR_BYTES), aligned(8), may_alias));
/* Their bits. */
typedef unsigned long long lanes_bits __attribute__((vector_size(VECTOR_BYTES), aligned(8), may_alias));
enum { LANES = VECTOR_BYTES / 8 };

/* Sixteen, not thirty-two: loops whose sums do not all stay in registers are cut into several. */
enum { FEW_REGISTERS = VECTOR_BYTES < 64 };

/* Numbers that are laid out together, whatever the kind: a whole number of vectors on each. */
enum { GROUP = 8 };

/* Two and four doubles on every kind. */
typedef double vec2 __attribute__((vector_size(16), aligned(8), may_alias));
typedef double vec4 __attribute__((vector_size(32), aligned(8), may_alias));

/* The vectors that stand at an address. */
#define VEC2(address) (*(const vec2 *)(address))
#define VEC4(address) (*(const vec4 *)(address))
#define AT(address) (*(const lanes *)(address))

/* Where the condition holds the value, else 0. */
#define WHERE(condition, value) ((lanes)((lanes_mask)(value) & (lanes_mask)(condition)))

INLINED void lanes_root(const lanes *square, lanes *result)
{
    double number[LANES];
    memcpy(number, square, sizeof number);
#pragma omp simd
    for (int n = 0; n < LANES; n++)
        number[n] = sqrt(number[n]);
    memcpy(result, number, sizeof number);
}

#endif
