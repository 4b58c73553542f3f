/* Time functions of loads and prescribed motions, which the word `history` names: f(t), dimensionless, zero
 * for t < 0 (Gaussian, Ricker wavelet and error function are cut at t = 0: choose the delay so that this does
 * not matter; scene/ warns otherwise).
 *
 * With smoothing S > 0 the history is convolved with the unit-area cubic B-spline supported on [0, S]. All of
 * it begins at `start` in place of 0. */
#ifndef SELAS_HISTORY_H
#define SELAS_HISTORY_H

#include "base/messages.h"
#include "deck/choices.h"

#include <complex.h>

enum history_kind { HISTORY_KINDS(CHOICE_SYMBOL) };

struct history {
    enum history_kind kind;
    double duration, frequency, delay, width, cycles, smoothing, start;
    size_t rows; /* table */
    double *table_time, *table_value;
    double
        rate; /* root mean square angular frequency of f' while it acts, 0 without one: history_set_rate() */
    double lasts, middle; /* of a pulse: its integral over its largest value, and when: history_set_rate() */
    double peak; /* largest amplitude of the spectrum (history_cutoff); 0: not known, history_set_peak() */
};

/* Derivative of order `derivative` = -1 (integral from 0), 0, 1 or 2 at time t; kinks and jumps without
 * smoothing: the mean of both sides for the value and the first derivative, impulses in derivatives are left
 * out. */
double history_value(const struct history *history, double t, int derivative);

/* Laplace transform: integral of f(t) exp(-s t) dt from 0 to infinity (Re s > 0), smoothing included. For the
 * kinds that are cut at t = 0 the cut is part of the transform. */
double complex history_laplace(const struct history *history, double complex s);
/* The same without the cut where that takes less than 5e-5 of the peak away: then the pulse is smooth, and
 * has begun before t = 0. */
double complex history_laplace_uncut(const struct history *history, double complex s);

/* Times >= 0 at which f or a derivative up to the second jumps (kinks, knots of the smoothing); at most
 * `room` are written, ascending; returns how many there are. */
size_t history_kinks(const struct history *history, double *times, size_t room);

/* The same function of time, number by number; but for where it begins. */
bool history_same(const struct history *a, const struct history *b);
bool history_alike(const struct history *a, const struct history *b);

/* Time after which f stays constant; INFINITY if never (not for kinds of
 * today). */
double history_end(const struct history *history);

/* Sets `rate`, for runs to this time: of a pulse from f' and f, as of a bell (kinks then count as what they are for
 * a lattice), and `lasts` and `middle`; of what lasts from f'' and f'. */
void history_set_rate(struct history *history, double end_time);

/* L2 norm of f' over all time, impulses left out. */
double history_rate_norm(const struct history *history);

/* Keeps what history_cutoff() searches for, as long as nothing but the start changes. */
void history_set_peak(struct history *history);
/* Angular frequency above which the amplitude spectrum of f, wherever it begins, stays below `fraction` of its largest
 * value; of a table that its rows resolve so far, that of the smooth function behind it. */
double history_cutoff(const struct history *history, double fraction);

/* How far straight lines between the rows of a table are off the cubics through four of them, of its largest value: the
 * most in the middles of intervals after which kinks repeat later than `longer` (uneven ones: after two), and the
 * interval's length. 0 of few rows and of other kinds; lines that go on straight, or off which cubics are farther than
 * the largest value, are hardly samples'. */
double history_table_sag(const struct history *history, double longer, double *step);

/* Reads a table: text, two columns, '#' or '!' comments; times must ascend from t >= 0. */
selas_status history_read_table(struct history *history, const char *path, struct messages *messages);
void history_free(struct history *history);

#endif
