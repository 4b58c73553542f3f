/* Loops that reach what a processor of this kind can do (peak.h). */
#include "peak.h"

#include "base/vectors.h"

/* The latency of a multiplication with addition times as many as begin in a cycle: at most 10 on any
 * processor so far. With factor and term they leave two of sixteen registers free. */
enum { CHAINS = 12 };

#define EACH_CHAIN(DO) DO(0) DO(1) DO(2) DO(3) DO(4) DO(5) DO(6) DO(7) DO(8) DO(9) DO(10) DO(11)

static double multiply(long rounds, double *value)
{
    const lanes factor = AT(value), term = AT(value + LANES);
#define BEGIN(i) lanes sum##i = term + i;
#define GO_ON(i) sum##i = sum##i * factor + term;
#define END(i) +sum##i
    EACH_CHAIN(BEGIN)
    for (long round = 0; round < rounds; round++) {
        EACH_CHAIN(GO_ON)
    }
    *(lanes *)value = EACH_CHAIN(END);
    return (double)rounds * CHAINS * LANES;
}

static void triad(size_t n, const double *restrict a, const double *restrict b, double *restrict c)
{
    for (size_t i = 0; i < n; i++)
        c[i] = a[i] + 3.0 * b[i];
}

const struct peak_loops OF_PROCESSOR(peak_loops) = {multiply, triad};
