/* One PNG per receiver: velocity computed over exact, and below each component the difference on its own
 * scale. */
#include "base/gnuplot.h"
#include "base/safe_file.h"
#include "compare/misfit.h"
#include "record/parts.h"
#include "scene/units.h"

#include <math.h>

/* A component below this part of the largest one is not drawn. */
static const double drawn_from = 1e-6;

enum {
    WIDTH = 1200,
    TOP = 80,
    BOTTOM = 60,
    MAIN = 300,
    DIFFERENCE = 130,
    GAP = 34,
    MAIN_TICS = 6,
    DIFFERENCE_TICS = 3
};

static double largest(const double *value, size_t rows, size_t column)
{
    double size = 0.0;
    for (size_t i = 0; value != NULL && i < rows; i++)
        size = fmax(size, fabs(value[6 * i + column]));
    return size;
}

/* Columns (3, 4, 5: vx vy vz) worth drawing; at least one. */
static int choose_columns(const struct recorder *recorder, const double *value, const double *exact,
                          size_t column[3])
{
    double size[3], most = 0.0;
    for (size_t c = 0; c < 3; c++) {
        size[c] = fmax(largest(value, recorder->rows, 3 + c), largest(exact, recorder->rows, 3 + c));
        most = fmax(most, size[c]);
    }
    int count = 0;
    for (size_t c = 0; c < 3; c++)
        if (size[c] > drawn_from * most) column[count++] = 3 + c;
    if (count == 0) column[count++] = 3 + (size_t)recorder->scene->dimension - 1;
    return count;
}

static void write_data(FILE *script, const struct recorder *recorder, size_t receiver)
{
    const double *value = recorder->trace[receiver].value;
    const double *exact = recorder->exact != NULL ? recorder->exact + receiver * recorder->rows * 6 : NULL;
    fprintf(script, "$history << END\n");
    for (size_t i = 0; i < recorder->rows; i++) {
        fprintf(script, "%.9g", recorder->time[i]);
        for (size_t c = 3; c < 6; c++)
            fprintf(script, " %.7g", value[6 * i + c]);
        for (size_t c = 3; exact != NULL && c < 6; c++)
            fprintf(script, " %.7g %.5g", exact[6 * i + c], value[6 * i + c] - exact[6 * i + c]);
        fputc('\n', script);
    }
    fprintf(script, "END\n");
}

static void range_of(const double *a, const double *b, size_t rows, size_t column, bool difference,
                     double range[2])
{
    range[0] = range[1] = 0.0;
    for (size_t i = 0; i < rows; i++) {
        const double x = a[6 * i + column], y = b != NULL ? b[6 * i + column] : x;
        range[0] = fmin(range[0], difference ? x - y : fmin(x, y));
        range[1] = fmax(range[1], difference ? x - y : fmax(x, y));
    }
}

/* What is compared with, in words. */
static const char *compared(const struct recorder *recorder)
{
    return scene_has_exact(recorder->scene) ? "exact" : "reference";
}

/* The error in words, as in report.txt. */
static void write_error(const struct recorder *recorder, const double *value, const double *exact,
                        size_t column, char *text, size_t size)
{
    struct misfit misfit[3];
    struct misfit largest;
    misfits_of(recorder->rows, recorder->time, value + 3, exact + 3, misfit, &largest);
    const struct misfit *own = &misfit[column - 3];
    const struct misfit *of = misfit_is_small(own, &largest) ? &largest : own;
    if (!(of->l2_of > 0.0) || !(of->linf_of > 0.0))
        snprintf(text, size, "%s is zero", compared(recorder));
    else
        snprintf(text, size, "L2 %.3g %%, L∞ %.3g %%%s", 100.0 * own->l2 / of->l2_of,
                 100.0 * own->linf / of->linf_of, of == own ? "" : " of the largest component");
}

static void write_panels(FILE *script, const struct recorder *recorder, size_t receiver, size_t column,
                         int height, int *top, bool last)
{
    static const char *const name[6] = {"", "", "", "v_x", "v_y", "v_z"};
    const double *value = recorder->trace[receiver].value;
    const double *exact = recorder->exact != NULL ? recorder->exact + receiver * recorder->rows * 6 : NULL;
    const struct output_choice *output = &recorder->scene->output;
    double range[2];
    char time_unit[UNIT_TEXT], unit[UNIT_TEXT];
    unit_text(output, 0, 1, UNITS_OF_DECK, time_unit);
    range_of(value, exact, recorder->rows, column, false, range);
    gnuplot_panel(script, WIDTH, height, *top, *top + MAIN);
    gnuplot_time_axis(script, last && exact == NULL, time_unit);
    gnuplot_range(script, range[0], range[1], MAIN_TICS);
    fprintf(script, "set ylabel '{/:Italic %s}%s'\n", name[column],
            unit_text(output, 1, -1, UNITS_OF_DECK, unit));
    const size_t c = column - 3;
    if (exact != NULL)
        fprintf(script,
                "plot $history u 1:%zu w l lc rgb '#f5a742' lw 6 t '%s', "
                "'' u 1:%zu w l lc rgb '#12306b' lw 1.6 t 'computed'\n",
                5 + 2 * c, compared(recorder), 2 + c);
    else
        fprintf(script, "plot $history u 1:%zu w l lc rgb '#12306b' lw 1.8 t 'computed'\n", 2 + c);
    *top += MAIN + GAP;
    if (exact == NULL) return;
    fprintf(script, "unset label 1\n"); /* the title is drawn once */
    char error[128];
    write_error(recorder, value, exact, column, error, sizeof error);
    range_of(value, exact, recorder->rows, column, true, range);
    gnuplot_panel(script, WIDTH, height, *top, *top + DIFFERENCE);
    gnuplot_time_axis(script, last, time_unit);
    gnuplot_range(script, range[0], range[1], DIFFERENCE_TICS);
    fprintf(script, "set ylabel 'difference'\n");
    fprintf(script, "plot $history u 1:%zu w l lc rgb '#b3202c' lw 1.4 t 'computed - %s: %s'\n", 6 + 2 * c,
            compared(recorder), error);
    *top += DIFFERENCE + GAP;
}

static void plot_name(const struct recorder *recorder, size_t receiver, char *name, size_t size)
{
    file_name_of(recorder->scene->receiver[receiver].name, ".png", name, size);
}

/* What is nothing beside the spacing, such as the far foot of a hill, is told as 0. */
static double told(const struct scene *scene, double place)
{
    return fabs(place) > 1e-6 * scene->body.spacing ? place : 0.0;
}

static void plot_one(FILE *script, const struct recorder *recorder, size_t receiver)
{
    const struct scene *scene = recorder->scene;
    const struct receiver *place = &scene->receiver[receiver];
    const double *exact = recorder->exact != NULL ? recorder->exact + receiver * recorder->rows * 6 : NULL;
    size_t column[3];
    const int panels = choose_columns(recorder, recorder->trace[receiver].value, exact, column);
    const int one = exact != NULL ? MAIN + GAP + DIFFERENCE + GAP : MAIN + GAP;
    const int height = TOP + panels * one + BOTTOM;
    char name[NAME_SIZE + 16], title[512];
    plot_name(recorder, receiver, name, sizeof name);
    int used = snprintf(title, sizeof title, "%s%s%s%s at ", recorder->so_far ? "UNFINISHED: " : "",
                        scene->title, scene->title[0] != '\0' ? ": " : "", place->name);
    for (int d = 0; d < scene->dimension && used < (int)sizeof title; d++)
        used += snprintf(title + used, sizeof title - (size_t)used, "%s%g%s", d == 0 ? "(" : ", ",
                         told(scene, place->position[d]), d + 1 == scene->dimension ? ")" : "");
    gnuplot_page(script, WIDTH, height, TOP, title);
    gnuplot_output(script, recorder->folder, name);
    write_data(script, recorder, receiver);
    fprintf(script, "set multiplot\n");
    fprintf(script, "set xrange [0:%.9g]\n", recorder->rows > 1 ? recorder->time[recorder->rows - 1] : 1.0);
    int top = TOP;
    for (int p = 0; p < panels; p++) {
        write_panels(script, recorder, receiver, column[p], height, &top, p == panels - 1);
        fprintf(script, "unset label 1\n"); /* the title, drawn once */
    }
    fprintf(script, "unset multiplot\nunset output\n");
}

void plot_histories(struct recorder *recorder, struct messages *messages)
{
    const struct scene *scene = recorder->scene;
    if (scene->receivers == 0 || recorder->rows == 0) return;
    struct gnuplot plot;
    if (!gnuplot_begin(&plot, messages)) return;
    for (size_t r = 0; r < scene->receivers; r++)
        plot_one(plot.script, recorder, r);
    const bool good = gnuplot_run(&plot, "the receivers", messages);
    for (size_t r = 0; r < scene->receivers; r++) {
        char name[NAME_SIZE + 16];
        plot_name(recorder, r, name, sizeof name);
        gnuplot_keep(recorder->folder, name, good, messages);
    }
}
