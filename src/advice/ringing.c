/* What rings at frequencies that the source hardly has: damped bodies, whose mechanisms are fitted to the source's
 * band; the lattice, where a moment tensor begins with a jump, or straight lines join samples of a smooth function. */
#include "advice/parts.h"

#include "damping/ground.h"
#include "scene/absorbing_layers.h"
#include "scene/resolution.h"

#include <math.h>

/* Over speed, of displacements of one component held on a face across an axis: a quarter of the edge's wave; where the
 * body is thin along the component that of bending, 1/2pi times about h/L^2. */
static double swing(const struct scene *scene, int component, int axis)
{
    const double *low = scene->body.low, *high = scene->body.high;
    const double edge = high[axis] - low[axis], thick = high[component] - low[component];
    return axis == component ? .25 / edge : fmin(.25, .16 * thick / edge) / edge;
}

/* Of the components' the least: held on both faces twice that of one; where none holds it that of the longest edge. */
static double lowest_frequency(const struct scene *scene)
{
    const struct body *body = &scene->body;
    double least = INFINITY;
    int longest = 0;
    for (int axis = 1; axis < scene->dimension; axis++)
        if (body->high[axis] - body->low[axis] > body->high[longest] - body->low[longest]) longest = axis;
    for (int component = 0; component < scene->dimension; component++) {
        double held = 0;
        for (int axis = 0; axis < scene->dimension; axis++) {
            const int faces = face_holds(scene, (enum face)(2 * axis), component) +
                              face_holds(scene, (enum face)(2 * axis + 1), component);
            if (faces > 0) /* without it gcc 12 breaks off on AArch64 */
                held = fmax(held, faces * swing(scene, component, axis));
        }
        least = fmin(least, held > 0 ? held : swing(scene, component, longest));
    }
    return slowest_speed(scene) * least;
}

static bool absorbs_anywhere(const struct scene *scene)
{
    bool absorbs = scene->body.chosen || layer_anywhere(scene);
    for (int face = 0; face < 2 * scene->dimension; face++)
        absorbs = absorbs || boundary_absorbs(&scene->boundary[face]);
    return absorbs;
}

/* Where it says .11 to .14 velocities of bars were .04 wrong, displacements .06, with six mechanisms .004 at most
 * (regress/studies/ringing). */
void look_at_ringing_body(struct adviser *adviser)
{
    static const double seen = .05;
    enum { ENOUGH = 6 };
    const struct scene *scene = adviser->scene;
    struct ground_damping *damping = NULL;
    struct messages none = {0};
    if (!ground_is_damped(scene) || absorbs_anywhere(scene) || scene->method.mechanisms >= ENOUGH) return;
    if (ground_damping_new(scene, true, &damping, &none) == SELAS_OK && damping != NULL) {
        const double error = ground_damping_rings(damping, lowest_frequency(scene), scene->end_time);
        if (error > seen)
            advise(
                adviser,
                "the body rings at frequencies below the source's, to which its damping is not fitted: what "
                "rings there may be up to %.2g wrong by end_time; method%%mechanisms = %d would do",
                fmin(1, error), ENOUGH);
    }
    ground_damping_free(damping);
    messages_free(&none);
}

/* Of the velocities from a moment tensor the share, in relative L2, that a jump at t = 0 leaves up to the frequency
 * where S waves are two spacings long: they go with w^2 times the spectrum of the time function, in the plane with
 * w^(3/2), along a line with w. What rings is 1.7 times as much, as P waves and waves askew are faster
 * (regress/studies/ringing: .4 to 1.3 of what is told; along a line .3). */
static double share_of_jump(const struct scene *scene, const struct history *history)
{
    static const double pulse[2][3] = {{1.67, 2.51, 3.54}, {3.23, 6.15, 10.5}};
    const bool ricker = history->kind == HISTORY_RICKER;
    if ((!ricker && history->kind != HISTORY_GAUSSIAN) || history->smoothing > 0) return 0;
    struct history raw = *history;
    raw.start = 0;
    const double jump = 2 * fabs(history_value(&raw, 0, 0));
    const double width = ricker ? 1 / (sqrt(2) * M_PI * history->frequency) : history->width;
    const double pass = scene->output.low_pass, highest = M_PI * slowest_speed(scene) / scene->body.spacing;
    const double band = width * (pass > 0 ? fmin(pass, highest) : highest);
    return 1.7 * jump * pow(band, .5 * scene->dimension) / pulse[ricker][scene->dimension - 1];
}

/* Of a load that is a moment tensor by the deck's history; else 0. */
static double moment_of(const struct load *load)
{
    double sum = 0;
    for (int n = 0; n < 6 && load->kind == LOAD_MOMENT_TENSOR && load->driven == BY_HISTORY; n++)
        sum += load->moment[n] * load->moment[n];
    return fabs(load->amplitude) * sqrt(sum);
}

void look_at_cut_moment(struct adviser *adviser)
{
    static const double seen = .01;
    const struct scene *scene = adviser->scene;
    double worst = 0, most = 0;
    size_t group = 0;
    for (size_t k = 0; k < scene->loads; k++)
        most = fmax(most, moment_of(&scene->load[k]));
    for (size_t k = 0; k < scene->loads; k++) {
        const struct load *load = &scene->load[k];
        if (moment_of(load) == 0) continue;
        const double share = share_of_jump(scene, &load->history) * moment_of(load) / most;
        if (share > worst) group = load->group;
        worst = fmax(worst, share);
    }
    if (worst > seen)
        advise(
            adviser,
            "load %zu is a moment tensor that begins with a small jump at t = 0, of which the finer lattice "
            "carries more: velocities ring by some %.2g of themselves; a longer delay, or output%%low_pass, "
            "would do",
            group + 1, worst);
}

/* Velocities err by .4 to 1.5 times the sag where kinks repeat sooner than .9 periods of the lattice's fastest wave.
 * Later they keep step with some of the lattice's shortest ones, and beside loads on a surface it is up to 20 times, in
 * the ground up to 2.5, of uneven rows 13 and 4 (regress/studies/sampled). */
static void look_at_samples(struct adviser *adviser, const struct stepper *stepper, const char *what,
                            size_t group, const struct history *history)
{
    static const double near = .9, slight[2] = {.005, .001}, good[2] = {.004, .8};
    const double period = 2 * M_PI / stepper->spectrum.omega, pass = adviser->scene->output.low_pass;
    double step;
    const bool far = history_table_sag(history, near * period, &step) > slight[true];
    const double sag = history_table_sag(history, 0, &step);
    if (!(sag > slight[far]) || history->smoothing >= 4 * step) return;
    const bool ringing = far && !(pass > 0 && pass * step < M_PI);
    if (!ringing && !(sag > slight[0])) return;
    advise(
        adviser,
        "straight lines between the rows of the table of &%s %zu are up to %.2g of its largest value off a "
        "smooth curve through them: where that is meant velocities err by some 2 times as much%s; even rows "
        "%.3g apart would do",
        what, group + 1, sag,
        ringing ? ", and up to 20 times beside loads, where the lattice rings at each row" : "",
        fmin(step * sqrt(good[0] / sag), far ? good[1] * period : INFINITY));
}

void look_at_tables(struct adviser *adviser, const struct stepper *stepper)
{
    const struct scene *scene = adviser->scene;
    for (size_t k = 0; k < scene->loads && stepper->spectrum.omega > 0; k++)
        if (k == 0 || scene->load[k].group != scene->load[k - 1].group)
            look_at_samples(adviser, stepper, "load", scene->load[k].group, &scene->load[k].history);
    for (size_t face = 0; face < FACES && stepper->spectrum.omega > 0; face++)
        if (boundary_acts(&scene->boundary[face]))
            look_at_samples(adviser, stepper, "boundary", scene->boundary[face].group,
                            &scene->boundary[face].history);
}
