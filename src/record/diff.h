/* Comparing histories: two files, or all receivers of two run folders, by component. */
#ifndef SELAS_DIFF_H
#define SELAS_DIFF_H

#include "base/messages.h"

#include <stdio.h>

/* A history as read from NAME.dat. */
struct history_file {
    size_t rows;
    double *time;  /* [rows], ascending */
    double *value; /* [6 * rows]: ux uy uz vx vy vz */
};

/* Reads `t ux uy uz vx vy vz`; SELAS_FILE_ERROR with file and line for what is no such row. */
selas_status history_file_read(const char *path, struct history_file *history, struct messages *messages);
void history_file_free(struct history_file *history);

/* |b - a| <= absolute * (range of the channel in a) + relative * |a| passes. */
struct tolerance {
    double relative, absolute;
};
extern const struct tolerance tolerance_default;

/* How b differs from a in one channel, over the times that both have. */
struct channel_difference {
    double l2, linf;        /* relative to the norms of a; absolute where a is zero throughout */
    double shift;           /* time by which b lies later than a (largest cross-correlation) */
    double envelope, phase; /* single-valued misfits of Kristekova et al. (2006), 0 = none */
    double excess;          /* largest |b - a| over what is allowed; beyond 1 the channel differs */
    double when;            /* time of it */
    bool differs;
};

/* All six channels of two histories on the union of their times. Histories that do not cover the same span
 * differ in every channel; SELAS_BAD_ARGUMENT if they have no time in common. */
selas_status diff_histories(const struct history_file *a, const struct history_file *b,
                            const struct tolerance *tolerance, struct channel_difference difference[6],
                            struct messages *messages);

/* Two files or two folders; the table goes to `table` (NULL: none); *differences gets the number of channels
 * (and missing histories) that differ. */
selas_status diff_paths(const char *a, const char *b, const struct tolerance *tolerance, FILE *table,
                        size_t *differences, struct messages *messages);

/* time_frequency.c: envelope and phase misfit of b against a, n values each at equal steps. */
selas_status time_frequency_misfit(size_t n, const double *a, const double *b, double *envelope,
                                   double *phase, struct messages *messages);
/* Steps by which b lies later than a: the place of the largest cross-correlation, between the steps by a
 * parabola. */
selas_status correlation_shift(size_t n, const double *a, const double *b, double *shift,
                               struct messages *messages);

#endif
