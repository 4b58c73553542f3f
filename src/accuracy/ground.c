/* The spacing that scene%accuracy leads to on half-spaces and boxes of ground (doc/verification/accuracy.md,
 * sections 2 to 4): the largest one for which the error law of surface.c, with the exact velocity's spectrum,
 * gives AIM times the wanted error at every receiver. */
#include "scene/ground.h"
#include "accuracy/grade.h"
#include "accuracy/ground_range.h"
#include "accuracy/ground_task.h"
#include "accuracy/kinds.h"
#include "accuracy/outlook.h"
#include "base/memory.h"
#include "exact/half_space.h"
#include "scene/resolution.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

static const double SLOWLY = 1.1;
/* A trial's spacing over the chosen one, at most: a fifth of the run's work, or half of it where errors do not fall
 * evenly; from where on another trial is made; share of the wanted error that is aimed at after a trial, and that is
 * good enough in one. */
static const double TRIAL_RATIO = 1.5, CLOSE_RATIO = 1.2, FAR_RATIO = 1.6, MEASURED_AIM = .55,
                    MEASURED_MOST = .85;
enum { ROWS = SURFACE_ROWS };

static bool looks_like(const struct scene *scene)
{
    return scene->dimension == 3 && scene->loads > 0 && scene->initial.kind == INITIAL_REST &&
           scene->load[0].shape != LOAD_FACE;
}

static double worst(const struct scene *scene, const struct surface_place *place, double h,
                    const struct surface_ground *ground)
{
    double most = 0;
    for (size_t i = 0; i < scene->receivers; i++)
        most = fmax(most, surface_error(&place[i], h, scene->end_time, ground));
    return most;
}

/* P wavelength at the mean frequency of |V|^2, the longest of all receivers. */
static double mean_wavelength(const struct scene *scene, const struct surface_place *place, double p_speed)
{
    double slowest = INFINITY;
    for (size_t i = 0; i < scene->receivers; i++) {
        double first = 0, whole = 0;
        for (int j = 1; j <= ROWS / 2; j++) {
            whole += place[i].power[j];
            first += j * place[i].power[j];
        }
        slowest = fmin(slowest, first / whole * 2 * M_PI / (1.25 * scene->end_time));
    }
    return 2 * M_PI * p_speed / slowest;
}

/* Absorbing layers are as thick as a seventh of the P wavelength that carries most, and have so many points
 * that little enough comes back (measured). */
static long enough_layer_points(double accuracy, double h, double wavelength)
{
    return (long)fmin(fmax((double)accuracy_layer_points(accuracy), ceil(LAYER_THICKNESS * wavelength / h)),
                      40);
}

/* Where the error falls slower than h^2.5 it is that of waves that the lattice cannot carry: a history with
 * kinks. What of them rings on under the load depends on where its rim lies between the knots, and is several
 * times less where the edge is a whole number of spacings (measured): the next smaller one of that kind. */
static double quiet_spacing(const struct scene *scene, const struct surface_place *place, double h,
                            double gain)
{
    double size = INFINITY;
    for (size_t i = 0; i < scene->receivers; i++)
        size = fmin(size, place[i].size);
    if (gain >= pow(SLOWLY, 2.5)) return h;
    if (scene->body.chosen) return size / ceil(size / h - 1e-9);
    double finer = h;
    while (finer > .5 * h) {
        if (fabs(size / finer - round(size / finer)) < 1e-6) return finer;
        finer = dividing_spacing(&scene->body, 3, .999 * finer);
    }
    return h;
}

/* True if the edges of all squares lie on knots, where tuned splines err least. */
static bool rims_on_knots(const struct scene *scene, double h)
{
    for (size_t k = 0; k < scene->loads; k++)
        for (int c = 0; c < 4 && scene->load[k].shape == LOAD_SQUARE; c++) {
            const int axis = c / 2;
            const double edge = scene->load[k].centre[axis] + (c % 2 - .5) * scene->load[k].size[axis];
            const double cells = (edge - scene->body.low[axis]) / h;
            if (cells > 0 && fabs(cells - round(cells)) > 1e-6) return false;
        }
    return true;
}

/* The largest spacing up to h that will do; 0 if there is none. */
static double possible_spacing(const struct scene *scene, const struct surface_ground *ground, double h)
{
    const struct load *load = &scene->load[0];
    if (scene->body.chosen && (!ground->tuned || load->shape != LOAD_SQUARE)) return h;
    if (scene->body.chosen) { /* the lattice stands on the load's centre */
        const double half = .5 * fmin(load->size[0], load->size[1]);
        return half / ceil(half / h - 1e-9);
    }
    const double first = dividing_spacing(&scene->body, 3, h);
    double finer = first;
    while (ground->tuned && finer > .5 * first && !rims_on_knots(scene, finer))
        finer = dividing_spacing(&scene->body, 3, .999 * finer);
    return finer > .5 * first ? finer : first;
}

/* --- The choice ------------------------------------------------------------------------------------------- */

/* The largest spacing for which the law gives so much of the wanted error, and the error. */
static selas_status find_spacing(const struct task *task, const struct surface_ground *ground, double most,
                                 double *spacing, struct messages *messages)
{
    enum { MOST = 800 };
    static const double finer = 1.01; /* 800 times: 1/2800 */
    const struct scene *scene = task->scene;
    double h = most, last = INFINITY, error = INFINITY, last_error = INFINITY;
    for (int i = 0; i < MOST && h > 0 && !(error <= task->aim * task->accuracy); i++) {
        last = h;
        last_error = error;
        h = possible_spacing(scene, ground, i > 0 ? h / finer : h);
        error = h > 0 ? worst(scene, task->place, h, ground) : INFINITY;
    }
    if (error < ACCURACY_LEAST * task->accuracy &&
        last_error <= ACCURACY_MOST * task->accuracy) { /* few spacings divide */
        h = last;
        error = last_error;
    }
    if (!(error <= ACCURACY_MOST * task->accuracy))
        return fail(messages, SELAS_BAD_SCENE,
                    "scene%%accuracy = %g is out of reach here: a spacing of %.3g would still leave %.2g",
                    task->accuracy, h, error);
    const double gain = error / worst(scene, task->place, h / SLOWLY, ground);
    *spacing = ground->tuned ? h : quiet_spacing(scene, task->place, h, gain);
    return SELAS_OK;
}

/* True if waves come that the lattice hardly carries: errors then do not fall evenly with the spacing. */
static bool rings(const struct scene *scene, double h)
{
    static const double carried = 3; /* points a wavelength at the cutoff */
    const double wavelength = points_per_wavelength(scene) * scene->body.spacing;
    return wavelength > 0 && wavelength < carried * h;
}

/* A coarser spacing of the same kind, up to `times` h and below `most`, for a trial; h if there is none. */
static double trial_spacing(const struct task *task, const struct surface_ground *ground, double h,
                            double times, double most)
{
    static const double least = 1.15, step = 1.04, useful = .5;
    double ratio = times * step;
    while ((ratio /= step) > least) {
        double coarse = possible_spacing(task->scene, ground, ratio * h);
        const double error = coarse > 0 ? worst(task->scene, task->place, coarse, ground) : INFINITY;
        if (error > useful || coarse >= most) continue;
        const double gain = error / worst(task->scene, task->place, coarse / SLOWLY, ground);
        if (!ground->tuned) coarse = quiet_spacing(task->scene, task->place, coarse, gain);
        if (coarse > least * h) return coarse;
    }
    return h;
}

static void set_choice(const struct task *task, const struct surface_ground *ground, double h,
                       struct scene_choice *choice)
{
    const double wavelength = mean_wavelength(task->scene, task->place, ground->p_speed);
    choice->spacing = h;
    choice->layer_points = enough_layer_points(task->accuracy, h, wavelength);
    choice->large = ground->tuned ? "absorbing layers need splines that are not tuned" : NULL;
    if (ground->layers < 2) return;
    choice->degree = ground->tuned ? 4 : 2;
    choice->sweeps = ground->tuned ? 0 : 3;
}

/* True if the box that fits this spacing has absorbing layers, beside which splines are not tuned: another law.
 * Else the box stays without, whatever spacing trials lead to. */
static bool layers_fit(const struct task *task, const struct surface_ground *ground, double h,
                       const struct trial *trial, const struct scene_choice *choice)
{
    struct scene_choice fitted = *choice;
    struct messages unsaid = {0};
    struct scene *scene = NULL;
    set_choice(task, ground, h, &fitted);
    fitted.large = NULL;
    const bool layers =
        scene_build(trial->deck, &fitted, &scene, &unsaid) == SELAS_OK && scene->body.absorbing;
    scene_free(&scene);
    messages_free(&unsaid);
    return layers;
}

/* Runs the scene with a spacing and sets the places' factors; `*made` tells whether it could. */
static selas_status make_trial(struct task *task, const struct surface_ground *ground, double h,
                               const struct trial *trial, const struct scene_choice *choice, bool *made,
                               struct messages *messages)
{
    struct scene_choice coarse = *choice;
    struct messages unsaid = {0};
    struct scene *scene = NULL;
    double *error = array_new(task->scene->receivers, sizeof *error);
    *made = false;
    if (error == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for a trial");
    set_choice(task, ground, h, &coarse);
    selas_status status = scene_build(trial->deck, &coarse, &scene, &unsaid);
    const bool same = scene != NULL && !(ground->tuned && scene->body.absorbing);
    if (same && accuracy_work(scene) <= ACCURACY_TRIAL_WORK) {
        status = trial->run(scene, task->exact, error, NULL, messages);
        *made = status == SELAS_OK;
    }
    for (size_t i = 0; i < task->scene->receivers && *made; i++) {
        struct surface_place *place = &task->place[i];
        place->tried = 0;
        place->factor *= fmax(error[i], 1e-9) / surface_error(place, h, task->scene->end_time, ground);
        place->tried = h;
        place->reached = error[i];
        place->order = ground_order(task->scene);
    }
    scene_free(&scene);
    messages_free(&unsaid);
    array_free(error);
    return status;
}

/* Narrows the choice down by trials (doc/verification/accuracy.md, section 2): *h is the law's spacing at
 * first, the chosen one at last, *tried the last trial's, 0 without one. */
static selas_status narrow(struct task *task, const struct surface_ground *ground, const struct trial *trial,
                           const struct scene_choice *choice, double most, double *h, double *tried,
                           struct messages *messages)
{
    enum { TRIALS = 4 };
    static const double good = .3;
    double proven = 0, reached = 0, next = trial_spacing(task, ground, *h, TRIAL_RATIO, most);
    for (int i = 0; i < TRIALS && next < most; i++) {
        bool made = false;
        selas_status status = make_trial(task, ground, next, trial, choice, &made, messages);
        if (!made || status != SELAS_OK) return status;
        const double error = worst(task->scene, task->place, next, ground) / task->accuracy;
        *tried = next;
        task->aim = MEASURED_AIM;
        *h = next;
        if (error <= MEASURED_MOST) {
            proven = next;
            reached = error;
        } else {
            most = .98 * next;
        }
        if (error <= MEASURED_MOST && error >= good) return SELAS_OK;
        status = find_spacing(task, ground, most, h, messages);
        if (status != SELAS_OK) return status;
        const bool close = rings(task->scene, *h);
        if (*h < next && next < (close ? CLOSE_RATIO : FAR_RATIO) * *h) return SELAS_OK;
        if (*h < next && proven > *h) break;
        next =
            *h > next ? *h : trial_spacing(task, ground, *h, close ? CLOSE_RATIO : TRIAL_RATIO, .98 * next);
    }
    if (proven == 0) return SELAS_OK;
    *h = *tried = proven;
    task->expected = reached * task->accuracy;
    return SELAS_OK;
}

/* Fails only if no spacing will do. */
static selas_status choose(struct task *task, const struct trial *trial, struct scene_choice *choice,
                           struct messages *messages)
{
    const struct scene *scene = task->scene;
    double most = INFINITY, h = 0, tried = 0;
    for (size_t k = 0; k < scene->receivers; k++)
        most = fmin(most, task->place[k].size / 2); /* at least two points along an edge */
    struct surface_ground ground = surface_ground_of(scene, most);
    most = fmin(most, ground.rayleigh_speed * scene->end_time);
    task->aim = ACCURACY_AIM;
    selas_status status = find_spacing(task, &ground, most, &h, messages);
    if (status == SELAS_OK && ground.tuned && layers_fit(task, &ground, h, trial, choice)) {
        ground.tuned = false;
        status = find_spacing(task, &ground, most, &h, messages);
    }
    char graded[GRADE_TEXT] = "";
    if (status == SELAS_OK && trial->run != NULL) {
        set_choice(task, &ground, h, choice);
        accuracy_grade(scene, trial, choice, graded);
        status = narrow(task, &ground, trial, choice, most, &h, &tried, messages);
    }
    if (tried == 0) choice->grading = graded[0] = 0;
    if (status == SELAS_OK && tried == 0) status = ground_in_range(scene, h, messages);
    if (status != SELAS_OK) return status;
    set_choice(task, &ground, h, choice);
    choice->exact = exact_of_ground(scene);
    const double expected = task->expected > 0 ? task->expected : worst(scene, task->place, h, &ground);
    char how[48] = "predicted";
    if (tried > 0) snprintf(how, sizeof how, "after a trial with %.6g: expected", tried);
    snprintf(choice->text, sizeof choice->text,
             "%g wanted: spacing %.6g, %s, leapfrog with the time-dispersion transform%s; %s error %.2g",
             task->accuracy, h, ground.tuned ? "degree 4, mass exact, tuned" : "degree 2, mass vc3", graded,
             how, expected);
    return SELAS_OK;
}

static selas_status choose_for(const struct scene *scene, double accuracy, const struct trial *trial,
                               struct scene_choice *choice, struct messages *messages)
{
    struct task task;
    char damping[DAMPING_TEXT] = "";
    selas_status status = begin_task(scene, &task, messages);
    task.accuracy = accuracy;
    if (status == SELAS_OK) status = enough_mechanisms(&task, choice, damping, messages);
    if (status == SELAS_OK) status = choose(&task, trial, choice, messages);
    strncat(choice->text, damping, sizeof choice->text - strlen(choice->text) - 1);
    end_task(&task);
    return status;
}

/* The law is that of degree 2 with three sweeps and open ends, of histories as they are. */
static bool measured_setting(const struct scene *scene)
{
    const struct deck_group *group = scene->method.group;
    return (!deck_given(group, "degree") || deck_integer(group, "degree", 0) == 2) &&
           (!deck_given(group, "mass") || deck_chosen(group, "mass", "vc3")) &&
           !deck_chosen(group, "ends", "mapped") && !(scene->output.low_pass > 0);
}

bool ground_outlook(const struct scene *scene, struct ground_outlook *outlook)
{
    enum { ENOUGH = 8 }; /* receivers looked at: each costs an exact history */
    struct scene few = *scene;
    struct messages unsaid = {0};
    struct task task;
    if (!looks_like(scene) || accuracy_refusal(&accuracy_ground, scene) != NULL) return false;
    if (!measured_setting(scene) || ground_range_refusal(scene) != NULL) return false;
    if (scene->body.layers > 0) return false; /* exact histories take seconds there */
    if (few.receivers > ENOUGH) few.receivers = ENOUGH;
    bool known = begin_task(&few, &task, &unsaid) == SELAS_OK;
    if (known) {
        const double h = scene->body.spacing;
        const struct surface_ground ground = surface_ground_of(scene, h);
        outlook->error = worst(&few, task.place, h, &ground);
        outlook->wavelength = mean_wavelength(&few, task.place, ground.p_speed);
        outlook->layer_points = enough_layer_points(outlook->error / ACCURACY_AIM, h, outlook->wavelength);
        known = isfinite(outlook->error) && isfinite(outlook->wavelength);
    }
    end_task(&task);
    messages_free(&unsaid);
    return known;
}

const struct accuracy_kind accuracy_ground = {
    .looks_like = looks_like,
    .variant = "consistent",
    .served = "method 'smoothed-point', variant 'consistent'",
    .refusal = ground_refusal,
    .choose = choose_for,
    .velocity = true,
};
