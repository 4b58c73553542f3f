/* Functions made once for each kind of machine: the one that fits is taken at run time, so that one binary
 * serves all. Compilers that cannot do this make the plain one. */
#ifndef SELAS_MACHINE_H
#define SELAS_MACHINE_H

#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__gnu_linux__)
#define EACH_MACHINE __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define EACH_MACHINE
#endif

#if defined(__GNUC__)
#define NOT_INLINED __attribute__((noinline))
#else
#define NOT_INLINED
#endif

#define INLINED static inline __attribute__((always_inline))

#endif
