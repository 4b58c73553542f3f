/* How far a history lies from its reference. */
#ifndef SELAS_COMPARE_MISFIT_H
#define SELAS_COMPARE_MISFIT_H

#include <stdbool.h>
#include <stddef.h>

/* Error of one component over the whole history (trapezoid in time, equal rows) */
struct misfit {
    double l2, linf;       /* norms of the difference */
    double l2_of, linf_of; /* norms of the reference */
};
struct misfit misfit_of(size_t rows, const double *time, const double *value, const double *reference,
                        size_t stride, size_t components);
/* The three components of displacement or velocity (stride 6); the norms of the largest reference. */
void misfits_of(size_t rows, const double *time, const double *value, const double *reference,
                struct misfit misfit[3], struct misfit *largest);
/* A component whose reference is below 1e-3 of the largest one is as good as zero: its own norm says nothing,
 * the error is then told relative to the largest component. */
bool misfit_is_small(const struct misfit *misfit, const struct misfit *largest);

#endif
