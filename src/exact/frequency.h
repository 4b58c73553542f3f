/* Frequency of a history by least squares. */
#ifndef SELAS_FREQUENCY_H
#define SELAS_FREQUENCY_H

#include "base/messages.h"

/* Angular frequency near `guess` (within a factor 1.5) at which a cos(w t) + b sin(w t) + c fits the n values
 * value[stride * i] at ascending times best, rows weighed with Hann's window so that other modes leak little.
 * The history must hold at least two periods of `guess`. SELAS_NOT_CONVERGED, SELAS_BAD_ARGUMENT. */
selas_status fit_frequency(size_t n, const double *time, const double *value, size_t stride, double guess,
                           double *frequency, struct messages *messages);

#endif
