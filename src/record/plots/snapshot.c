/* Plots of snapshots: one PNG each and an animated GIF of all.
 *
 * Three dimensions: the surface (z- face) and a cut through the first load's centre (or the body's), side by
 * side; two: a map; one: a curve; likewise of a region that is a plane or a line. The values come back from
 * run.h5. */
#include "base/gnuplot.h"
#include "record/plots/section.h"
#include "scene/units.h"

#include <math.h>
#include <unistd.h>

/* Blue - white - red for fields of both signs, white - red for energies. */
#define PALETTE_SIGNED                                                                                       \
    "set palette defined (-1 '#08306b', -0.6 '#2b7bba', -0.25 '#a6cde4', 0 '#ffffff', 0.25 '#f9b99b', "      \
    "0.6 '#d33c32', 1 '#67000d')\n"
#define PALETTE_POSITIVE                                                                                     \
    "set palette defined (0 '#ffffff', 0.2 '#fde3a7', 0.45 '#f59b3c', 0.7 '#c0392b', 1 '#4a0d1e')\n"
#define GIF_FONT "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"

enum {
    PANEL = 640,       /* pixels of a page with two sections, each */
    AREA = 445,        /* of which the map gets so many, */
    SINGLE = 800,      /* of a page with one section, */
    SINGLE_AREA = 560, /* likewise */
    AROUND = 175,      /* above and below a map */
    LOWEST = 300,
    HIGHEST = 900,
    CURVE_HEIGHT = 620,
    FRAME_DELAY = 10 /* hundredths of a second */
};
static const char axis_name[3] = {'x', 'y', 'z'};
static const double axis_slack = 1e-9;
static const double quiet = 1e-4;

static bool is_curve(const struct section *section)
{
    return section->along > 0 && section->across <= 1;
}

/* What is drawn: "v_z", "pressure" (gnuplot's enhanced text). */
static void label_of(const struct film *film, char *text, size_t size)
{
    static const char letter[] = "uva\0\0pE";
    const char *component = component_names(film->field)[film->component];
    if (film->field == SELAS_STRESS || film->field == SELAS_STRAIN)
        snprintf(text, size, "%s_{%s}", film->field == SELAS_STRESS ? "σ" : "ε", component);
    else if (component[0] != '\0')
        snprintf(text, size, "%c_%s", letter[film->field], component);
    else
        snprintf(text, size, "%s", field_name(film->field));
}

/* Displacement, velocity, acceleration: length / time^0, 1, 2. */
static const char *unit_of(const struct film *film, char text[UNIT_TEXT])
{
    if (film->field > SELAS_ACCELERATION) return UNITS_OF_DECK;
    return unit_text(film->output, 1, -(int)film->field, UNITS_OF_DECK, text);
}

static void set_range(FILE *script, const char *axis, double low, double high, bool reversed)
{
    const double room = high > low ? axis_slack * (high - low) : 0.5;
    fprintf(script, "set %srange [%.9g:%.9g]\n", axis, reversed ? high + room : low - room,
            reversed ? low - room : high + room);
}

static void set_scale(FILE *script, const struct film *film, double largest)
{
    const double size = largest > 0.0 ? largest : 1.0;
    const bool positive = film->field == SELAS_ENERGY;
    fputs(positive ? PALETTE_POSITIVE : PALETTE_SIGNED, script);
    fprintf(script, "set cbrange [%.6g:%.6g]\n", positive ? 0.0 : -size, size);
}

/* Pixels that the taller of the first `sections` maps needs. */
static int map_height(const struct film *film, size_t sections)
{
    double aspect = 0.0;
    for (size_t s = 0; s < sections; s++) {
        const struct section *section = &film->section[s];
        const double width = section->high[0] - section->low[0], height = section->high[1] - section->low[1];
        aspect = fmax(aspect, width > 0.0 ? height / width : 1.0);
    }
    const double wanted = aspect * (sections > 1 ? AREA : SINGLE_AREA);
    return (int)fmin(fmax(wanted, LOWEST - AROUND), HIGHEST - AROUND);
}

static int page_height(const struct film *film, size_t sections)
{
    return is_curve(&film->section[0]) ? CURVE_HEIGHT : map_height(film, sections) + AROUND;
}

/* As many tics as the map has room for. */
static void set_tics(FILE *script, const struct film *film, const struct section *section, size_t sections,
                     double largest)
{
    const double width = section->high[0] - section->low[0], height = section->high[1] - section->low[1];
    const double area = sections > 1 ? AREA : SINGLE_AREA;
    const double pixels = width > 0.0 ? fmin(area * height / width, map_height(film, sections)) : area;
    const double wide = height > 0.0 ? fmin(area, pixels * width / height) : area;
    if (width > 0.0) fprintf(script, "set xtics %.9g\n", gnuplot_tic_step(width, fmax(wide / 65.0, 2.5)));
    if (height > 0.0) fprintf(script, "set ytics %.9g\n", gnuplot_tic_step(height, fmax(pixels / 60.0, 3.5)));
    const double scale = (film->field == SELAS_ENERGY ? 1.0 : 2.0) * (largest > 0.0 ? largest : 1.0);
    fprintf(script, "set cbtics %.9g\n", gnuplot_tic_step(scale, fmin(fmax(pixels / 60.0, 3.5), 8.0)));
}

static void draw_map(FILE *script, const struct film *film, size_t s, size_t sections,
                     const struct frame *frame, double largest)
{
    const struct section *section = &film->section[s];
    char label[64], unit[UNIT_TEXT];
    label_of(film, label, sizeof label);
    unit_text(film->output, 1, 0, "", unit);
    fprintf(script, "set xlabel '%c%s%s'\nset ylabel '%c%s%s'\n", axis_name[section->axis[0]], film->axes,
            unit, axis_name[section->axis[1]], film->axes, unit);
    fprintf(script, "set title '%s%s%s%s'\n", label, section->title[0] != '\0' ? ", " : "", section->title,
            unit_of(film, unit));
    set_range(script, "x", section->low[0], section->high[0], false);
    set_range(script, "y", section->low[1], section->high[1], section->downwards);
    set_scale(script, film, largest);
    set_tics(script, film, section, sections, largest);
    if (section->regular) {
        const double step[2] = {(section->high[0] - section->low[0]) / (double)(section->fine[0] - 1),
                                (section->high[1] - section->low[1]) / (double)(section->fine[1] - 1)};
        fprintf(script,
                "plot '" GNUPLOT_DATA "' binary skip=%zu array=(%zu,%zu) origin=(%.9g,%.9g) dx=%.9g dy=%.9g "
                "format='%%float' with image notitle\n",
                frame->skip[s], section->fine[0], section->fine[1], section->low[0], section->low[1], step[0],
                step[1]);
        return;
    }
    const char *format = "format='%float%float%float' using 1:2:3";
    if (section->along > 0) {
        fprintf(script, "set pm3d map %s\n", section->points < 10000 ? "interpolate 3,3" : "interpolate 1,1");
        fprintf(script, "splot '" GNUPLOT_DATA "' binary skip=%zu record=(%zu,%zu) %s with pm3d notitle\n",
                frame->skip[s], section->along, section->across, format);
        return;
    }
    const double size = 62.0 / sqrt((double)section->points + 1.0);
    fprintf(script,
            "plot '" GNUPLOT_DATA "' binary skip=%zu record=(%zu) format='%%float%%float%%float' using 1:2:3 "
            "with points pt 7 ps %.3g lc palette notitle\n",
            frame->skip[s], section->points, fmin(fmax(size, 0.25), 3.0));
}

static void draw_curve(FILE *script, const struct film *film, const struct frame *frame, double largest)
{
    const struct section *section = &film->section[0];
    char label[64], unit[UNIT_TEXT], along[UNIT_TEXT];
    label_of(film, label, sizeof label);
    const double size = largest > 0.0 ? 1.08 * largest : 1.0;
    fprintf(script, "unset colorbox\nset title '%s'\nset xlabel '%c%s%s'\nset ylabel '%s%s'\nset grid\n",
            section->title, axis_name[section->axis[0]], film->axes, unit_text(film->output, 1, 0, "", along),
            label, unit_of(film, unit));
    set_range(script, "x", section->low[0], section->high[0], false);
    set_range(script, "y", film->field == SELAS_ENERGY ? 0.0 : -size, size, false);
    fprintf(script,
            "plot '" GNUPLOT_DATA "' binary skip=%zu record=(%zu) format='%%float%%float%%float' using 1:3 "
            "with lines lw 2 lc rgb '#12306b' notitle\n",
            frame->skip[0], section->points);
}

static void frame_title(FILE *script, const struct recorder *recorder, const struct frame *frame, int height)
{
    char title[400];
    snprintf(title, sizeof title, "%s    t = %.4g %s", recorder->scene->title, frame->time,
             recorder->scene->output.time_unit);
    fprintf(script, "set label 1 ");
    gnuplot_quote(script, title);
    fprintf(script, " at screen 0.5, screen %.4f center noenhanced\n", 1.0 - 22.0 / height);
}

static void set_look(FILE *script)
{
    fprintf(script, "set tics out nomirror front\nset border lw 1.2\nunset key\nset size ratio -1\n"
                    "set format cb '%%.2g'\n");
}

static void still_name(const struct frame *frame, char *name, size_t size)
{
    snprintf(name, size, "snapshot_%04zu.png", frame->number);
}

static void draw_still(FILE *script, const struct recorder *recorder, const struct film *film,
                       const struct frame *frame)
{
    char name[48];
    still_name(frame, name, sizeof name);
    fprintf(script, "reset\nset terminal pngcairo size %d,%d font 'DejaVu Sans,13'\n",
            film->sections > 1 ? 2 * PANEL : SINGLE, page_height(film, film->sections));
    gnuplot_output(script, recorder->scene->output.directory, name);
    fprintf(script, "set multiplot\n");
    set_look(script);
    frame_title(script, recorder, frame, page_height(film, film->sections));
    if (is_curve(&film->section[0])) {
        fprintf(script, "set size noratio 1,0.93\n");
        draw_curve(script, film, frame, film->largest[0]);
    } else {
        for (size_t s = 0; s < film->sections; s++) {
            const double width = 1.0 / (double)film->sections;
            fprintf(script, "set origin %.4f,0\nset size ratio -1 %.4f,0.95\n", (double)s * width, width);
            /* a body that is still at rest shows rest, not its rounding */
            draw_map(script, film, s, film->sections, frame,
                     fmax(frame->largest[s], quiet * film->largest[s]));
            fprintf(script, "unset label 1\n");
        }
    }
    fprintf(script, "unset multiplot\nunset output\n");
}

static void animation_name(const struct film *film, char *name, size_t size)
{
    if (film->group == 0)
        snprintf(name, size, "surface.gif");
    else
        snprintf(name, size, "surface_%zu.gif", film->group + 1);
}

static void draw_animation(FILE *script, const struct recorder *recorder, const struct film *film)
{
    char name[48];
    animation_name(film, name, sizeof name);
    fprintf(script, "reset\nset terminal gif animate delay %d loop 0 optimize size %d,%d", FRAME_DELAY,
            SINGLE, page_height(film, 1));
    if (access(GIF_FONT, R_OK) == 0) fprintf(script, " font '" GIF_FONT ",12'");
    fprintf(script, "\n");
    gnuplot_output(script, recorder->scene->output.directory, name);
    set_look(script);
    for (size_t f = 0; f < film->frames; f++) {
        frame_title(script, recorder, &film->frame[f], page_height(film, 1));
        if (is_curve(&film->section[0])) {
            fprintf(script, "set size noratio 1,0.95\n");
            draw_curve(script, film, &film->frame[f], film->largest[0]);
        } else {
            fprintf(script, "set size ratio -1 1,0.95\n");
            draw_map(script, film, 0, 1, &film->frame[f], film->scale[0]);
        }
    }
    fprintf(script, "unset output\n");
}

static void plot_film(const struct recorder *recorder, struct film *film, struct messages *messages)
{
    struct gnuplot plot;
    if (!gnuplot_begin(&plot, messages)) return;
    if (!film_write(recorder, film, plot.data, messages)) {
        warn(messages, "no plots of the snapshots: their values cannot be read back");
        gnuplot_discard(&plot);
        return;
    }
    for (size_t f = 0; f < film->frames; f++)
        draw_still(plot.script, recorder, film, &film->frame[f]);
    if (film->frames > 1) draw_animation(plot.script, recorder, film);
    const bool good = gnuplot_run(&plot, "the snapshots", messages);
    const char *folder = recorder->scene->output.directory;
    char name[48];
    for (size_t f = 0; f < film->frames; f++) {
        still_name(&film->frame[f], name, sizeof name);
        gnuplot_keep(folder, name, good, messages);
    }
    animation_name(film, name, sizeof name);
    if (film->frames > 1) gnuplot_keep(folder, name, good, messages);
}

void plot_snapshots(struct recorder *recorder, struct messages *messages)
{
    for (size_t group = 0; group < recorder->scene->snapshots; group++) {
        struct film film;
        if (!film_create(recorder, group, &film, messages)) continue;
        plot_film(recorder, &film, messages);
        film_free(&film);
    }
}
