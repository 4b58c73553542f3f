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
/* Is the last value nothing beside the largest? */
bool history_table_ends(const struct history *history);
/* pi over the shortest interval between rows, of which a table has two at least. */
double history_table_top(const struct history *history);

/* Sum of the changes of slope: no spectrum of f'' is larger (but for a jump to the first value). */
double history_table_kinks(const struct history *history);

/* |F(i w)| of a table, w = k `step`, k = 1 .. `count`, as far as history_table_top(). */
struct table_spectrum {
    double step;
    size_t count;
    double *amplitude; /* of k, [0] unused; array_free() */
};
/* false: no memory. */
bool history_table_spectrum(const struct history *history, struct table_spectrum *spectrum);

/* (1 - exp(-x)) / x without cancellation for small |x|. */
double complex history_decay_ratio(double complex x);

#endif
