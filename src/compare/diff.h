/* Comparing histories: two files, or all receivers of two run folders, by component. */
#ifndef SELAS_COMPARE_DIFF_H
#define SELAS_COMPARE_DIFF_H

#include "base/messages.h"

#include <stdio.h>

enum { DIFF_CHANNELS = 6 }; /* ux uy uz vx vy vz */

/* What the comments of a history say; empty where it says nothing. */
enum { HISTORY_PLACE, HISTORY_UNITS, HISTORY_LOW_PASS, HISTORY_HEADS, HEAD_SIZE = 128 };

/* A history as read from NAME.dat. */
struct history_file {
    size_t rows;
    double *time;  /* [rows], ascending */
    double *value; /* [6 * rows]: ux uy uz vx vy vz */
    char head[HISTORY_HEADS][HEAD_SIZE];
};

/* Reads `t ux uy uz vx vy vz`; SELAS_FILE_ERROR with file and line for what is no such row of finite numbers. */
selas_status history_file_read(const char *path, struct history_file *history, struct messages *messages);
void history_file_free(struct history_file *history);

/* The receivers of a run, as their files are named without ".dat". False if `path` is no run.h5. */
struct run_receivers {
    size_t count;
    char **name;
};
bool run_receivers_read(const char *path, struct run_receivers *receivers);
void run_receivers_free(struct run_receivers *receivers);

/* |b - a| <= absolute * (range of the channel in a) + relative * |a| passes. */
struct tolerance {
    double relative, absolute;
};
extern const struct tolerance tolerance_default;

/* How b differs from a in one channel, over the times that both have. */
struct channel_difference {
    double l2, linf;        /* relative to the norms of a */
    bool absolute;          /* they are not: a is zero throughout */
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

/* Where the outcome goes. */
struct diff_report {
    FILE *table;        /* one line a channel; NULL: none */
    const char *plots;  /* folder for RECEIVER_CHANNEL.png of each channel that differs; NULL: none */
    size_t differences; /* channels (and missing histories) that differ: set by diff_paths() */
};

/* Two files or two folders; tolerance NULL: the default. A plot that cannot be drawn is a warning. */
selas_status diff_paths(const char *a, const char *b, const struct tolerance *tolerance,
                        struct diff_report *report, struct messages *messages);

/* diff_pair.c: both histories at the same times; SELAS_BAD_ARGUMENT if they have none in common. To be freed
 * whatever the outcome. */
struct history_pair {
    size_t rows;
    double *time, *a, *b; /* [rows], [6 * rows] */
};
selas_status history_pair_create(struct history_pair *pair, const struct history_file *a,
                                 const struct history_file *b, struct messages *messages);
void history_pair_free(struct history_pair *pair);
/* Both begin and end at the same times. */
bool same_span(const struct history_file *a, const struct history_file *b);
/* Values of all channels at a time within the history, by cubics; *row (0 at first) is where the last search
 * ended, for times that ascend. */
void history_at(const struct history_file *h, double time, size_t *row, double value[DIFF_CHANNELS]);
/* One channel at times begin + i step, i < n, within the history. */
void history_at_even_steps(const struct history_file *h, double begin, double step, size_t n, size_t channel,
                           double *series);

/* diff_told.c: warns where the comments of two histories tell of other positions, units or low-passes, and where
 * a good part of the differences is interpolation between rows that are far apart. `label`: what the two are
 * called. Units and low-passes are those of a whole run: *told is set, and nothing is said of them where it is. */
void tell_heads(const char *receiver, const char *const label[2], const struct history_file *a,
                const struct history_file *b, bool *told, struct messages *messages);
selas_status tell_interpolation(const char *receiver, const char *const label[2],
                                const struct history_file *a, const struct history_file *b,
                                const struct channel_difference difference[DIFF_CHANNELS],
                                struct messages *messages);

/* diff_plot.c: for each channel that differs both traces, the difference below on its own scale. `label`:
 * what the two are called. */
extern const char *const diff_channel[DIFF_CHANNELS];
void diff_plots(const char *folder, const char *receiver, const char *const label[2],
                const struct history_file *a, const struct history_file *b,
                const struct channel_difference difference[DIFF_CHANNELS], struct messages *messages);

/* time_frequency.c: envelope and phase misfit of b against a, n values each at equal steps. */
selas_status time_frequency_misfit(size_t n, const double *a, const double *b, double *envelope,
                                   double *phase, struct messages *messages);
/* Steps by which b lies later than a: the place of the largest cross-correlation, between the steps by a
 * parabola. */
selas_status correlation_shift(size_t n, const double *a, const double *b, double *shift,
                               struct messages *messages);

#endif
