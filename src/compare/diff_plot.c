/* One PNG for each channel in which two histories differ: both traces over each other, below them the
 * difference on its own scale with the allowance that it exceeds. */
#include "base/gnuplot.h"
#include "compare/diff.h"

#include "base/safe_file.h"

#include <math.h>

const char *const diff_channel[DIFF_CHANNELS] = {"ux", "uy", "uz", "vx", "vy", "vz"};

enum { WIDTH = 1200, TOP = 80, MAIN = 340, GAP = 40, DIFFERENCE = 180, BOTTOM = 70, TICS = 6 };
enum { HEIGHT = TOP + MAIN + GAP + DIFFERENCE + BOTTOM };

/* Where traces are not finite gnuplot leaves a gap; so do the ranges. */
static void widen(double range[2], double value)
{
    if (!isfinite(value)) return;
    range[0] = fmin(range[0], value);
    range[1] = fmax(range[1], value);
}

static void write_values(FILE *script, const struct history_pair *pair, size_t channel, double traces[2],
                         double difference[2])
{
    traces[0] = difference[0] = INFINITY;
    traces[1] = difference[1] = -INFINITY;
    fprintf(script, "$both << END\n");
    for (size_t i = 0; i < pair->rows; i++) {
        const double a = pair->a[DIFF_CHANNELS * i + channel], b = pair->b[DIFF_CHANNELS * i + channel];
        widen(traces, a);
        widen(traces, b);
        widen(difference, b - a);
        fprintf(script, "%.9g %.9g %.9g %.9g\n", pair->time[i], a, b, b - a);
    }
    fprintf(script, "END\n");
    for (double *range = traces; range != NULL; range = range == traces ? difference : NULL)
        if (!(range[0] <= range[1])) range[0] = range[1] = 0.0;
}

static void plot_name(const char *receiver, size_t channel, char *name, size_t size)
{
    char ending[16];
    snprintf(ending, sizeof ending, "_%s.png", diff_channel[channel]);
    file_name_of(receiver, ending, name, size);
}

static void plot_channel(FILE *script, const char *folder, const char *receiver, const char *const label[2],
                         const struct history_pair *pair, size_t channel, const struct channel_difference *d)
{
    char name[FILE_NAME_SIZE], title[512];
    double traces[2], difference[2];
    plot_name(receiver, channel, name, sizeof name);
    snprintf(title, sizeof title, "%s %s: L2 %.3g, L∞ %.3g, envelope %.3g, phase %.3g, shift %.3g", receiver,
             diff_channel[channel], d->l2, d->linf, d->envelope, d->phase, d->shift);
    gnuplot_page(script, WIDTH, HEIGHT, TOP, title);
    gnuplot_output(script, folder, name);
    write_values(script, pair, channel, traces, difference);
    fprintf(script, "set multiplot\n");
    if (pair->rows > 1)
        fprintf(script, "set xrange [%.9g:%.9g]\n", pair->time[0], pair->time[pair->rows - 1]);
    gnuplot_panel(script, WIDTH, HEIGHT, TOP, TOP + MAIN);
    gnuplot_time_axis(script, false, "");
    gnuplot_range(script, traces[0], traces[1], TICS);
    fprintf(script, "set ylabel '{/:Italic %c_%c} (units of the deck)'\n", diff_channel[channel][0],
            diff_channel[channel][1]);
    fprintf(script, "plot $both u 1:2 w l lc rgb '#f5a742' lw 6 t ");
    gnuplot_quote(script, label[0]);
    fprintf(script, " noenhanced, '' u 1:3 w l lc rgb '#12306b' lw 1.6 t ");
    gnuplot_quote(script, label[1]);
    fprintf(script, " noenhanced\nunset label 1\n"); /* the title is drawn once */
    gnuplot_panel(script, WIDTH, HEIGHT, TOP + MAIN + GAP, TOP + MAIN + GAP + DIFFERENCE);
    gnuplot_time_axis(script, true, " (units of the deck)");
    gnuplot_range(script, difference[0], difference[1], TICS / 2);
    fprintf(script, "set ylabel 'difference' offset 1,0\nplot $both u 1:4 w l lc rgb '#b3202c' lw 1.4 t ");
    if (isfinite(d->excess) && d->excess > 1.0)
        fprintf(script, "'second - first: %.3g times what is allowed, at t = %.4g'\n", d->excess, d->when);
    else
        fprintf(script, "'second - first'\n");
    fprintf(script, "unset multiplot\nunset output\n");
}

void diff_plots(const char *folder, const char *receiver, const char *const label[2],
                const struct history_file *a, const struct history_file *b,
                const struct channel_difference difference[DIFF_CHANNELS], struct messages *messages)
{
    struct history_pair pair;
    struct gnuplot plot;
    if (history_pair_create(&pair, a, b, messages) == SELAS_OK && make_folder(folder, messages) == SELAS_OK &&
        gnuplot_begin(&plot, messages)) {
        for (size_t c = 0; c < DIFF_CHANNELS; c++)
            if (difference[c].differs)
                plot_channel(plot.script, folder, receiver, label, &pair, c, &difference[c]);
        const bool good = gnuplot_run(&plot, "the differences", messages);
        for (size_t c = 0; c < DIFF_CHANNELS; c++) {
            if (!difference[c].differs) continue;
            char name[FILE_NAME_SIZE];
            plot_name(receiver, c, name, sizeof name);
            gnuplot_keep(folder, name, good, messages);
        }
    }
    history_pair_free(&pair);
}
