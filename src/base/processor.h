/* Kinds of processors. The kernels, the loops that take most of the time, are compiled once for each kind
 * (Makefile, KERNELS), each with vectors of that kind's width:
 *
 *   x86-64      16 bytes (any other architecture too)
 *   x86-64-v3   32 bytes, fused multiplication and addition (AVX2 and FMA)
 *   x86-64-v4   64 bytes (AVX-512)
 *
 * (Levels of the System V psABI for x86-64, version 1.0, section 3.1.1.) The best kind that the machine has
 * is taken, or that which SELAS_PROCESSOR names. Kinds with fused multiplication give the same bits: each sum
 * is taken in one order, whatever the width. The plain kind rounds products too.
 *
 * A file of kernels puts its functions into a table, whose name ends with the kind it is compiled for, and
 * its header declares the tables of all kinds and the choice between them:
 *
 *   header:  EACH_PROCESSOR(struct passes, passes)                declares taken_passes()
 *   source:  const struct passes OF_PROCESSOR(passes) = {...};
 */
#ifndef SELAS_BASE_PROCESSOR_H
#define SELAS_BASE_PROCESSOR_H

#include "base/messages.h"

enum processor { PROCESSOR_PLAIN, PROCESSOR_V3, PROCESSOR_V4, PROCESSORS };

/* The plain kind alone: `make KINDS=plain`, and other architectures. */
#if defined(__x86_64__) && !defined(SELAS_ONE_KIND)
#define PROCESSOR_CHOICE
#endif

/* The kind taken. Where SELAS_PROCESSOR cannot be met, the best that the machine has. */
enum processor processor_taken(void);
/* Does the machine have it? */
bool processor_there(enum processor kind);
/* "x86-64-v3" and so on; on other architectures "plain". */
const char *processor_name(enum processor kind);
/* Width of its vectors. */
int processor_bytes(enum processor kind);
/* SELAS_BAD_ARGUMENT: SELAS_PROCESSOR names no kind, or one that the machine does not have. */
selas_status processor_check(struct messages *messages);

/* The Makefile says which kind a kernel is compiled for (1, 3, 4); all else is as for the plain one. */
#if !defined(SELAS_KIND) || SELAS_KIND == 1
#define PROCESSOR_SUFFIX plain
#define VECTOR_BYTES 16
#elif SELAS_KIND == 3
#define PROCESSOR_SUFFIX v3
#define VECTOR_BYTES 32
#else
#define PROCESSOR_SUFFIX v4
#define VECTOR_BYTES 64
#endif
#define OF_PROCESSOR(name) PROCESSOR_JOINED(name, PROCESSOR_SUFFIX)
#define PROCESSOR_JOINED(name, suffix) PROCESSOR_PASTED(name, suffix)
#define PROCESSOR_PASTED(name, suffix) name##_##suffix

#ifdef PROCESSOR_CHOICE
#define EACH_PROCESSOR(type, table)                                                                          \
    extern const type table##_plain, table##_v3, table##_v4;                                                 \
    static inline const type *taken_##table(void)                                                            \
    {                                                                                                        \
        const enum processor kind = processor_taken();                                                       \
        return kind == PROCESSOR_V4 ? &table##_v4 : kind == PROCESSOR_V3 ? &table##_v3 : &table##_plain;     \
    }
#else
#define EACH_PROCESSOR(type, table)                                                                          \
    extern const type table##_plain;                                                                         \
    static inline const type *taken_##table(void)                                                            \
    {                                                                                                        \
        return &table##_plain;                                                                               \
    }
#endif

#endif
