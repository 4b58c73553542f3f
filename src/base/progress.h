/* Progress: a bar with the time left on a terminal, a line now and then elsewhere. The library prints nothing
 * itself: text goes to a function of the caller. */
#ifndef SELAS_BASE_PROGRESS_H
#define SELAS_BASE_PROGRESS_H

#include <stdbool.h>

struct progress {
    void (*write)(void *context, const char *text);
    void *context;
    bool terminal;       /* redraw one line instead of adding lines */
    double end;          /* of the simulated time */
    double started;      /* wall clock, seconds */
    double next_moment;  /* wall clock of the next redraw (terminal) */
    double next_portion; /* fraction done at which the next line is due (elsewhere) */
};

/* Starts the clock. `write` gets text that is ready to print (with its own line ends). */
void progress_start(struct progress *progress, double end_time, bool terminal,
                    void (*write)(void *context, const char *text), void *context);
/* To be called after every step; costs a clock reading and now and then a line. */
void progress_update(struct progress *progress, double time, unsigned long step);
/* Leaves the line finished: "done" with the wall time, or where the run stopped. */
void progress_finish(struct progress *progress, double time, unsigned long step, bool done);

#endif
