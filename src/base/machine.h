/* What depends on the machine. EACH_MACHINE: functions made once for each kind of it; the one that fits is
 * taken at run time, so that one binary serves all. Compilers that cannot do this make the plain one, and
 * so does -DSELAS_ONE_MACHINE (regress/hardening/valgrind).
 * tiny_as_zero(): numbers below the smallest normal one. */
#ifndef SELAS_MACHINE_H
#define SELAS_MACHINE_H

#if defined(__GNUC__) && !defined(__clang__) && defined(__x86_64__) && defined(__gnu_linux__) &&             \
    !defined(SELAS_ONE_MACHINE)
#define EACH_MACHINE __attribute__((target_clones("default", "arch=x86-64-v3", "arch=x86-64-v4")))
#else
#define EACH_MACHINE
#endif

#if defined(__GNUC__)
#define NOT_INLINED __attribute__((noinline))
#else
#define NOT_INLINED
#endif

#if defined(__SSE2__)
#include <xmmintrin.h>
#endif

/* Numbers below the smallest normal one as 0 in this thread, since processors take a hundred times as long
 * for them: floats ahead of a wave soon get there. Gives what goes back to tiny_as_before(). Other machines:
 * nothing. */
static inline unsigned tiny_as_zero(void)
{
#if defined(__SSE2__)
    enum { FLUSHED = 0x8000, TAKEN = 0x0040 }; /* results; operands */
    const unsigned before = _mm_getcsr();
    _mm_setcsr(before | FLUSHED | TAKEN);
    return before;
#else
    return 0;
#endif
}

static inline void tiny_as_before(unsigned before)
{
#if defined(__SSE2__)
    _mm_setcsr(before);
#else
    (void)before;
#endif
}

#define INLINED static inline __attribute__((always_inline))

#endif
