/* Histories without smoothing, kind by kind, and what their smoothing needs. Inside scene/ only. */
#ifndef SELAS_HISTORY_KINDS_H
#define SELAS_HISTORY_KINDS_H

#include "scene/history.h"

/* Derivative of order -1 (integral from 0) to 2 of the history without smoothing; the mean of both sides at
 * kinks. */
double history_plain_value(const struct history *history, double t, int derivative);
double history_table_value(const struct history *history, double t, int derivative, bool right);
double history_table_kink_after(const struct history *history, double t);
double complex history_table_laplace(const struct history *history, double complex s);

/* (1 - exp(-x)) / x without cancellation for small |x|. */
double complex history_decay_ratio(double complex x);

#endif
