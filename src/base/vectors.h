/* Vectors for the innermost loops: versions of a function for newer machines, chosen at run time, and short
 * vectors of doubles as C extensions of gcc and clang, which compile on any machine.
 *
 * A function with VECTOR_CLONES is compiled for plain x86-64, for AVX2 with FMA (x86-64-v3) and for AVX-512
 * (x86-64-v4). What it calls must be inlined into it (INLINED), and parallel regions stand outside: the
 * functions that the compiler makes of them are not cloned. */
#ifndef SELAS_VECTORS_H
#define SELAS_VECTORS_H

#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__)
#define VECTOR_CLONES __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define VECTOR_CLONES
#endif

#define INLINED __attribute__((always_inline)) static inline

/* Aligned as a double is, so that they can be loaded from anywhere in an array. */
typedef double vec4 __attribute__((vector_size(32), aligned(8), may_alias));
typedef double vec8 __attribute__((vector_size(64), aligned(8), may_alias));

/* What comparisons of vec8 give: all bits where they hold. */
typedef long long mask8 __attribute__((vector_size(64), aligned(8), may_alias));

enum { VEC = 8 };

/* The vectors that stand at an address. */
#define VEC4(address) (*(const vec4 *)(address))
#define VEC8(address) (*(const vec8 *)(address))

#endif
