/* What depends on the compiler and the machine. tiny_as_zero(): numbers below the smallest normal one. */
#ifndef SELAS_MACHINE_H
#define SELAS_MACHINE_H

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
