/* damping.png: 1/Q and phase speed of each damped material over frequency, wanted and as the run's relaxation
 * mechanisms have them; beside them the spectrum that the fit goes by. */
#include "base/gnuplot.h"
#include "damping/ground.h"
#include "record/parts.h"
#include "scene/units.h"

#include <math.h>

enum { WIDTH = 1200, TOP = 80, BOTTOM = 10, PANEL = 300, GAP = 90 };

/* f; 1/Q_p, 1/Q_s reached, wanted; c_p, c_s reached, wanted; weight over the largest. */
static void write_data(FILE *script, const struct ground_damping *damping, size_t material, double density)
{
    const struct relaxation_band *band = &damping->band;
    const struct damped_moduli *moduli[2] = {&damping->fitted[material], &damping->wanted[material]};
    double largest = 0;
    for (size_t k = 0; k < RELAXATION_SAMPLES; k++)
        largest = fmax(largest, band->weight[k]);
    fprintf(script, "$damping%zu << END\n", material);
    for (size_t k = 0; k < RELAXATION_SAMPLES; k++) {
        const double w = band->angular_frequency[k];
        fprintf(script, "%.6g", w / (2 * M_PI));
        for (int i = 0; i < 2; i++)
            fprintf(script, " %.6g %.6g", modulus_loss(&moduli[i]->axial, w),
                    modulus_loss(&moduli[i]->shear, w));
        for (int i = 0; i < 2; i++)
            fprintf(script, " %.6g %.6g", modulus_speed(&moduli[i]->axial, density, w),
                    modulus_speed(&moduli[i]->shear, density, w));
        fprintf(script, " %.6g\n", band->weight[k] / largest);
    }
    fprintf(script, "END\n");
}

static void plot_panel(FILE *script, const char *label, size_t material, int first, bool speeds)
{
    const char *name = speeds ? "c" : "1/Q";
    fprintf(script, "set ylabel ");
    gnuplot_quote(script, label);
    fprintf(
        script,
        " noenhanced\nplot $damping%zu u 1:10 axes x1y2 w filledcurves y=0 lc rgb '#e6e6e6' t 'spectrum', "
        "'' u 1:%d w l lc rgb '#f5a742' lw 6 t '%s_P wanted', '' u 1:%d w l lc rgb '#12306b' lw 1.6 t '%s_P "
        "reached', "
        "'' u 1:%d w l lc rgb '#e8a9a0' lw 6 t '%s_S wanted', '' u 1:%d w l lc rgb '#b3202c' lw 1.6 t "
        "'%s_S reached'\n",
        material, first + 2, name, first, name, first + 3, name, first + 1, name);
}

static void plot_materials(FILE *script, const struct recorder *recorder,
                           const struct ground_damping *damping, int height)
{
    const struct scene *scene = recorder->scene;
    int top = TOP;
    for (size_t i = 0; i < scene->materials; i++) {
        char label[NAME_SIZE + 2 * UNIT_TEXT], text[UNIT_TEXT];
        if (!(scene->material[i].q_p > 0)) continue;
        write_data(script, damping, i, scene->material[i].density);
        for (int speeds = 0; speeds < 2; speeds++) {
            gnuplot_panel(script, WIDTH, height, top, top + PANEL);
            if (speeds)
                snprintf(label, sizeof label, "phase speed in %s%s", scene->material[i].name,
                         unit_text(&scene->output, 1, -1, "", text));
            else
                snprintf(label, sizeof label, "1/Q of %s", scene->material[i].name);
            plot_panel(script, label, i, speeds ? 6 : 2, speeds != 0);
            fprintf(script, "unset label 1\n");
            top += PANEL + GAP;
        }
    }
}

void plot_damping(struct recorder *recorder, struct messages *messages)
{
    const struct scene *scene = recorder->scene;
    struct ground_damping *damping = NULL;
    struct messages unsaid = {0};
    struct gnuplot plot;
    int panels = 0;
    for (size_t i = 0; i < scene->materials; i++)
        panels += scene->material[i].q_p > 0 ? 2 : 0;
    if (panels == 0 || ground_damping_new(scene, true, &damping, &unsaid) != SELAS_OK ||
        !gnuplot_begin(&plot, messages)) {
        messages_free(&unsaid);
        ground_damping_free(damping);
        return;
    }
    const int height = TOP + panels * (PANEL + GAP) + BOTTOM;
    gnuplot_page(plot.script, WIDTH, height, TOP, scene->title);
    gnuplot_output(plot.script, recorder->folder, "damping.png");
    char text[UNIT_TEXT];
    fprintf(
        plot.script,
        "set multiplot\nset logscale x\nset xlabel 'frequency%s'\nset y2range [0:1.2]\nset key samplen 2\n",
        unit_text(&scene->output, 0, -1, " (1/unit of time of the deck)", text));
    plot_materials(plot.script, recorder, damping, height);
    fprintf(plot.script, "unset multiplot\nunset output\n");
    gnuplot_keep(recorder->folder, "damping.png", gnuplot_run(&plot, "damping", messages), messages);
    ground_damping_free(damping);
}
