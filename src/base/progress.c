/* Progress: a bar with the time left on a terminal, a line every tenth elsewhere. */
#include "base/progress.h"

#include "base/clock.h"

#include <math.h>
#include <stdio.h>

static const double redraw_every = 0.1; /* seconds */
static const double line_every = 0.1;   /* of the whole */
static const double patience = 2.0;     /* seconds: a run shorter than this needs no lines on the way */

/* "12 s", "3 min 20 s", "2 h 05 min" */
static void write_duration(char *text, size_t size, double seconds)
{
    const double whole = fmin(fmax(seconds, 0.0), 1e9);
    const long s = lround(whole);
    if (whole < 9.95)
        snprintf(text, size, "%.1f s", whole);
    else if (s < 60)
        snprintf(text, size, "%ld s", s);
    else if (s < 3600)
        snprintf(text, size, "%ld min %02ld s", s / 60, s % 60);
    else
        snprintf(text, size, "%ld h %02ld min", s / 3600, s / 60 % 60);
}

void progress_start(struct progress *progress, double end_time, bool terminal,
                    void (*write)(void *context, const char *text), void *context)
{
    const double now = wall_seconds();
    *progress = (struct progress){write, context, terminal, end_time, now, now + redraw_every, line_every};
}

static void write_bar(const struct progress *progress, double portion, double time, const char *left)
{
    enum { WIDTH = 30 };
    char bar[WIDTH + 1];
    for (int i = 0; i < WIDTH; i++)
        bar[i] = i < (int)(portion * WIDTH) ? '#' : '.';
    bar[WIDTH] = '\0';
    char line[160];
    snprintf(line, sizeof line, "\r[%s] %3.0f %%  t = %.4g of %.4g  %s left\033[K", bar, 100.0 * portion,
             time, progress->end, left);
    progress->write(progress->context, line);
}

void progress_update(struct progress *progress, double time, unsigned long step)
{
    if (progress->write == NULL) return;
    const double now = wall_seconds();
    const double spent = now - progress->started;
    const double portion = progress->end > 0.0 ? fmin(fmax(time / progress->end, 0.0), 1.0) : 1.0;
    char left[32];
    write_duration(left, sizeof left, portion > 0.0 ? spent * (1.0 - portion) / portion : 0.0);
    if (progress->terminal) {
        if (now < progress->next_moment) return;
        progress->next_moment = now + redraw_every;
        write_bar(progress, portion, time, left);
        return;
    }
    if (portion < progress->next_portion || portion >= 1.0) return;
    progress->next_portion = (floor(portion / line_every + 1e-9) + 1.0) * line_every;
    if (spent < patience) return;
    char line[160];
    snprintf(line, sizeof line, "%3.0f %%  step %lu  t = %.4g of %.4g  %s left\n", 100.0 * portion, step,
             time, progress->end, left);
    progress->write(progress->context, line);
}

void progress_finish(struct progress *progress, double time, unsigned long step, bool done)
{
    if (progress->write == NULL) return;
    char spent[32], line[160];
    write_duration(spent, sizeof spent, wall_seconds() - progress->started);
    snprintf(line, sizeof line, "%s%s: %lu steps to t = %.6g in %s\n", progress->terminal ? "\r\033[K" : "",
             done ? "done" : "stopped", step, time, spent);
    progress->write(progress->context, line);
}
