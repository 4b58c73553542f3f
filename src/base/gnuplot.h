/* Plots off-screen by gnuplot. Script and data are unlinked temporary files that gnuplot reads through its
 * standard input and /dev/fd/3: nothing is left behind, and a gnuplot that dies cannot hurt us. */
#ifndef SELAS_BASE_GNUPLOT_H
#define SELAS_BASE_GNUPLOT_H

#include "base/messages.h"

#include <stdio.h>

#define GNUPLOT_DATA "/dev/fd/3" /* what `data` is called in the script */

struct gnuplot {
    FILE *script; /* write commands here */
    FILE *data;   /* binary or text data, if any */
};

/* False (and a warning) if there is no room for temporary files. */
bool gnuplot_begin(struct gnuplot *plot, struct messages *messages);
/* Runs the script; false and a warning with gnuplot's first words if there is no gnuplot or it fails. */
bool gnuplot_run(struct gnuplot *plot, const char *what, struct messages *messages);
/* In place of gnuplot_run() when there is nothing to draw. */
void gnuplot_discard(struct gnuplot *plot);

/* A file name or text as a gnuplot string in single quotes. */
void gnuplot_quote(FILE *script, const char *text);
/* Plots of panels one below the other, lengths in pixels from above: a page with its title (centred in the
 * `top` highest pixels) and common style; where the next panel lies; its range of values (flat ones get a
 * range too) with about `tics` tics; the axis of time below the last panel only (unit: " (s)"). */
void gnuplot_page(FILE *script, int width, int height, int top, const char *title);
void gnuplot_panel(FILE *script, int width, int height, int top, int bottom);
void gnuplot_range(FILE *script, double low, double high, int tics);
void gnuplot_time_axis(FILE *script, bool last, const char *unit);

/* Step between tics: 1, 2 or 5 times a power of ten, about `wanted` of them in a range > 0. */
double gnuplot_tic_step(double range, double wanted);
/* `set output` to the temporary name of folder/name; after gnuplot_run(): give it its name (or remove it). */
void gnuplot_output(FILE *script, const char *folder, const char *name);
void gnuplot_keep(const char *folder, const char *name, bool good, struct messages *messages);

#endif
