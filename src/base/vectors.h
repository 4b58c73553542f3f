/* Short vectors of doubles as C extensions of gcc and clang, which compile on any machine. Functions that use
 * them are EACH_MACHINE (base/machine.h): what they call must be inlined into them (INLINED), and parallel
 * regions stand outside, as the functions that the compiler makes of those exist once only. */
#ifndef SELAS_VECTORS_H
#define SELAS_VECTORS_H

#include "base/machine.h"

#include <math.h>
#include <string.h>

/* Aligned as a double is, so that they can be loaded from anywhere in an array. */
typedef double vec2 __attribute__((vector_size(16), aligned(8), may_alias));
typedef double vec4 __attribute__((vector_size(32), aligned(8), may_alias));
typedef double vec8 __attribute__((vector_size(64), aligned(8), may_alias));

typedef float float8 __attribute__((vector_size(32), aligned(4), may_alias));

/* Of bytes. */
typedef char byte8 __attribute__((vector_size(8)));

/* What comparisons of vec8 give: all bits where they hold. */
typedef long long mask8 __attribute__((vector_size(64), aligned(8), may_alias));

enum { VEC = 8 };

/* The vectors that stand at an address. */
#define VEC2(address) (*(const vec2 *)(address))
#define VEC4(address) (*(const vec4 *)(address))
#define VEC8(address) (*(const vec8 *)(address))

/* Where the condition holds the value, else 0. */
#define WHERE(condition, value) ((vec8)((mask8)(value) & (mask8)(condition)))

/* By address: functions that take or return such vectors would differ between machines. */
INLINED void vec8_root(const vec8 *square, vec8 *result)
{
    double number[VEC];
    memcpy(number, square, sizeof number);
#pragma omp simd
    for (int n = 0; n < VEC; n++)
        number[n] = sqrt(number[n]);
    memcpy(result, number, sizeof number);
}

#endif
