/* ground.png: the ground as a run sees it, before anything is computed. Three dimensions: a map of the surface
 * and, along the line A-B through the first source (or receiver) and the receiver farthest from it, sections of
 * both speeds; two dimensions: the speeds. Sources, receivers, absorbing layers, what the faces do. */
#include "scene/ground.h"
#include "base/gnuplot.h"
#include "base/safe_file.h"
#include "record/parts.h"
#include "record/plots/marks.h"
#include "record/results.h"
#include "scene/units.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

enum {
    LEFT = 105,    /* pixels left of a panel, for its axis */
    SIDE = 560,    /* of the longer side of a map, and the width of a section */
    HIGHEST = 560, /* a section, */
    LOWEST = 170,  /* which is stretched to be at least as high as this */
    SCALE = 165,   /* for the colours' scale */
    TOP = 120,
    GAP = 125,
    BOTTOM = 160
};
static const char picture[] = "ground.png";

/* --- Panels --- */

static void set_panel(const struct page *page, const struct cut *cut, int left, int top, const int size[2])
{
    FILE *script = page->script;
    char unit[UNIT_TEXT];
    unit_text(&page->scene->output, 1, 0, UNITS_OF_DECK, unit);
    fprintf(script, "set lmargin at screen %.5f\nset rmargin at screen %.5f\n", (double)left / page->width,
            (double)(left + size[0]) / page->width);
    fprintf(script, "set tmargin at screen %.5f\nset bmargin at screen %.5f\n",
            1 - (double)top / page->height, 1 - (double)(top + size[1]) / page->height);
    for (int side = 0; side < 2; side++) {
        const bool down = side == 1 && cut->downwards;
        const double length = cut->high[side] - cut->low[side];
        fprintf(script, "set %crange [%.9g:%.9g]\nset %ctics %.9g\nset %clabel '%s%s'\n", "xy"[side],
                down ? cut->high[side] : cut->low[side], down ? cut->low[side] : cut->high[side], "xy"[side],
                gnuplot_tic_step(length, size[side] / (side == 0 ? 100. : 65.)), "xy"[side],
                cut -> name[side], unit);
    }
}

static void draw(const struct page *page, size_t c, size_t skip, bool key)
{
    const struct cut *cut = &page->cut[c];
    FILE *script = page->script;
    double step[2];
    for (int side = 0; side < 2; side++)
        step[side] = (cut->high[side] - cut->low[side]) / (double)cut->pixels[side];
    marks_names(page, c);
    fprintf(script,
            "plot '" GNUPLOT_DATA "' binary skip=%zu array=(%zu,%zu) origin=(%.9g,%.9g) dx=%.9g dy=%.9g "
            "format='%%float' with image notitle, $layers%zu w filledcurves closed fs transparent pattern 4 "
            "noborder fc rgb '#444444' notitle, $body%zu w l lc rgb '#000000' lw 1.5 notitle, $jumps%zu u "
            "1:2 w p pt "
            "7 ps .18 lc rgb '#000000' notitle, "
            "$surface%zu u 1:2 w l lc rgb '#000000' lw 2 notitle",
            skip, cut->pixels[0], cut->pixels[1], cut->low[0] + step[0] / 2, cut->low[1] + step[1] / 2,
            step[0], step[1], c, c, c, c);
    static const char *const look[LOOKS] = {"lc rgb '#d97706' lw 6", "lc rgb '#1d4ed8' lw 6"},
                             *const name[LOOKS] = {"face with dampers", "face held or moved"};
    for (int n = 0; n < LOOKS; n++)
        if (marks_any_face(page, (enum face_look)n))
            fprintf(script, ", $faces%zu_%d w l %s %s%s%s", c, n, look[n], key ? "t '" : "notitle",
                    key ? name[n] : "", key ? "'" : "");
    fprintf(
        script,
        ", $patches%zu w l lc rgb '#ffffff' lw 5 notitle, '' w l lc rgb '#c00000' lw 2.5 notitle"
        ", $sources%zu w p pt 3 ps 2.2 lw 6 lc rgb '#ffffff' notitle, '' w p pt 3 ps 2 lw 2.5 lc rgb "
        "'#c00000' %s, $receivers%zu w p pt 11 ps 2.4 lc rgb '#ffffff' notitle, '' w p pt 11 ps 1.6 lc rgb "
        "'#000000' %s",
        c, c, key && page->sources > 0 ? "t 'source'" : "notitle", c,
        key && page->receivers > 0 ? "t 'receiver'" : "notitle");
    if (key) {
        if (page->jumps) fprintf(script, ", NaN w p pt 7 ps .5 lc rgb '#000000' t 'interface'");
        if (page->layers)
            fprintf(script,
                    ", NaN w filledcurves fs transparent pattern 4 fc rgb '#444444' t 'absorbing layer'");
    }
    fprintf(script, "\nunset key\nunset label 1\n");
    for (size_t r = 0; r < page->receivers && r < NAMED; r++)
        fprintf(script, "unset label %zu\n", NAME_TAGS + r);
}

static void set_scale(const struct page *page, int which)
{
    const double low = page->least[which], high = page->greatest[which];
    const double room = high - low > 1e-6 * high ? 0 : .1 * high;
    char unit[UNIT_TEXT];
    fprintf(page->script, "set cbrange [%.9g:%.9g]\nset cbtics %.9g\nset cblabel '%c speed%s'\n", low - room,
            high + room, gnuplot_tic_step(high - low + 2 * room, 5), "SP"[which],
            unit_text(&page->scene->output, 1, -1, UNITS_OF_DECK, unit));
}

static void draw_sections(const struct page *page, int left, const size_t skip[2])
{
    const struct cut *cut = &page->cut[0];
    int top = TOP;
    for (int which = 0; which < 2; which++) {
        set_panel(page, cut, left, top, page->size[0]);
        set_scale(page, which);
        const double scale =
            page->size[0][1] / (cut->high[1] - cut->low[1]) * (cut->high[0] - cut->low[0]) / page->size[0][0];
        char stretched[48] = "";
        if (fabs(scale - 1) > .02)
            snprintf(stretched, sizeof stretched, ", %c stretched %.2g times", page->cut[0].name[1][0],
                     scale);
        fprintf(page->script, "set colorbox\nset title '%s%s' offset 0,.9\n",
                page->cuts > 1
                    ? which == 0 ? "section A-B: speed of S waves" : "section A-B: speed of P waves"
                : which == 0 ? "speed of S waves"
                             : "speed of P waves",
                stretched);
        draw(page, 0, skip[which], page->cuts == 1 && which == 0);
        top += page->size[0][1] + GAP;
    }
}

/* The line A-B on the map. */
static void set_line(const struct page *page)
{
    const struct cut *cut = &page->cut[0];
    double end[2][2];
    for (int e = 0; e < 2; e++)
        for (int axis = 0; axis < 2; axis++)
            end[e][axis] = cut->origin[axis] + (e == 0 ? cut->low[0] : cut->high[0]) * cut->along[axis];
    fprintf(page->script,
            "set arrow 1 from %.9g,%.9g to %.9g,%.9g nohead front lc rgb '#000000' dt 2 lw 1.5\n", end[0][0],
            end[0][1], end[1][0], end[1][1]);
    fprintf(page->script, "set label 2 'A' at %.9g,%.9g front offset %.2f,%.2f font 'DejaVu Sans,15'\n",
            end[0][0], end[0][1], .8 * cut->along[0], .8 * cut->along[1] + .7 * (fabs(cut->along[0]) > .5));
    fprintf(page->script, "set label 3 'B' at %.9g,%.9g right front offset %.2f,%.2f font 'DejaVu Sans,15'\n",
            end[1][0], end[1][1], -.8 * cut->along[0], -.8 * cut->along[1] + .7 * (fabs(cut->along[0]) > .5));
}

static void draw_map(const struct page *page, size_t skip)
{
    set_panel(page, &page->cut[1], LEFT, TOP, page->size[1]);
    set_scale(page, 0);
    set_line(page);
    fprintf(page->script, "unset colorbox\nset title 'map of the surface: speed of S waves' offset 0,.9\n");
    draw(page, 1, skip, true);
    fprintf(page->script, "unset arrow 1\nunset label 2\nunset label 3\n");
}

/* --- The page --- */

static void choose_sizes(struct page *page)
{
    for (size_t c = 0; c < page->cuts; c++) {
        const struct cut *cut = &page->cut[c];
        const double aspect = (cut->high[1] - cut->low[1]) / (cut->high[0] - cut->low[0]);
        const double wide = c == 0 || aspect < 1 ? SIDE : SIDE / aspect;
        page->size[c][0] = (int)fmax(wide, LOWEST);
        page->size[c][1] = (int)fmin(fmax(wide * aspect, LOWEST), c == 0 ? HIGHEST : SIDE);
    }
    const int sections = 2 * page->size[0][1] + GAP, map = page->cuts > 1 ? page->size[1][1] : 0;
    page->width = LEFT + page->size[0][0] + SCALE + (page->cuts > 1 ? page->size[1][0] + LEFT + 20 : 0);
    page->height = TOP + (sections > map ? sections : map) + BOTTOM;
}

static void write_page(struct page *page, FILE *data)
{
    size_t skip[3] = {0};
    for (int n = 0; n < 2 + (page->cuts > 1); n++) {
        skip[n] = (size_t)ftell(data);
        if (!cut_write_speed(&page->cut[n == 2], n % 2, data)) return; /* gnuplot complains */
    }
    choose_sizes(page);
    char title[320];
    snprintf(title, sizeof title, "%s%sground", page->scene->title,
             page->scene->title[0] != '\0' ? ": " : "");
    gnuplot_page(page->script, page->width, page->height, TOP - 30, title);
    gnuplot_output(page->script, page->scene->output.directory, picture);
    for (size_t c = 0; c < page->cuts; c++)
        marks_write(page, c);
    fprintf(
        page->script,
        "set palette defined (0 '#fdf3c2', .25 '#d3e49b', .5 '#98cda3', .75 '#74b3bb', 1 '#7f97cc')\n"
        "unset grid\nset datafile separator whitespace\nset key at screen .5, screen %.5f center vertical "
        "maxrows 2 samplen 2\nset multiplot\n",
        26. / page->height);
    if (page->cuts > 1) draw_map(page, skip[2]);
    draw_sections(page, page->cuts > 1 ? LEFT + page->size[1][0] + LEFT + 20 : LEFT, skip);
    fprintf(page->script, "unset multiplot\nunset output\n");
}

static bool make_cuts(struct page *page)
{
    const struct scene *scene = page->scene;
    double from[3], to[3];
    marks_line(scene, from, to);
    cut_section(scene, from, to, &page->cut[0]);
    page->cuts = scene->dimension == 3 ? 2 : 1;
    if (page->cuts > 1) cut_map(scene, &page->cut[1]);
    for (size_t c = 0; c < page->cuts; c++) {
        if (!cut_fill(scene, &page->cut[c])) return false;
        for (int which = 0; which < 2; which++) {
            page->least[which] =
                c == 0 ? page->cut[c].least[which] : fmin(page->least[which], page->cut[c].least[which]);
            page->greatest[which] = fmax(page->greatest[which], page->cut[c].greatest[which]);
        }
    }
    for (size_t k = 0; k < scene->loads; k++)
        page->sources += scene->load[k].shape != LOAD_FACE;
    page->receivers = scene->receivers;
    return true;
}

static bool can_plot(const struct scene *scene)
{
    return scene->dimension > 1 && body_is_box(&scene->body);
}

bool plots_ground(const struct scene *scene)
{
    return can_plot(scene) && (ground_is_general(scene) || body_is_layered(&scene->body));
}

void plot_ground(const struct scene *scene, struct messages *messages)
{
    struct page page = {.scene = scene};
    struct gnuplot plot;
    if (!make_cuts(&page)) {
        warn(messages, "no plot of the ground: no memory");
    } else if (gnuplot_begin(&plot, messages)) {
        page.script = plot.script;
        write_page(&page, plot.data);
        gnuplot_keep(scene->output.directory, picture, gnuplot_run(&plot, "the ground", messages), messages);
    }
    for (size_t c = 0; c < page.cuts; c++)
        cut_free(&page.cut[c]);
}

selas_status record_ground(const struct scene *scene, struct messages *messages)
{
    static const char names[] = "\nground.png\n";
    if (!can_plot(scene))
        return fail(messages, SELAS_UNSUPPORTED,
                    "there is no plot of the ground of this body; expected a box in two or three dimensions");
    selas_status status = make_folder(scene->output.directory, messages);
    if (status == SELAS_OK) status = results_claim(scene, names, messages);
    if (status == SELAS_OK) status = results_list(scene, names, messages);
    if (status == SELAS_OK) plot_ground(scene, messages);
    return status;
}
