/* What a processor of a kind can do: loops of the bench, compiled as kernels are. */
#ifndef SELAS_BENCH_PEAK_H
#define SELAS_BENCH_PEAK_H

#include "base/processor.h"

struct peak_loops {
    /* `rounds` multiplications with addition in each lane of enough registers that none waits for another;
     * gives how many that were. Results go to `value`, so that they are made. */
    double (*multiply)(long rounds, double *value);
    /* c = a + 3 b */
    void (*triad)(size_t n, const double *a, const double *b, double *c);
};
EACH_PROCESSOR(struct peak_loops, peak_loops)

#endif
