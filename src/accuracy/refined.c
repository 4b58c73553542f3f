/* The spacing that scene%accuracy leads to on general ground, for which there is no exact solution: from trials held
 * against finer ones (doc/verification/accuracy.md, section 8). */
#include "accuracy/grade.h"
#include "accuracy/kinds.h"

#include "base/memory.h"
#include "compare/diff.h"
#include "damping/ground.h"
#include "scene/absorbing_layers.h"
#include "scene/ground.h"
#include "scene/resolution.h"

#include <math.h>
#include <stdio.h>

/* Least and largest power of the spacing that errors are taken to fall with; error at so many points per wavelength of
 * the slowest wave and the power for a first guess; spacing of the middle one of three trials over the chosen one,
 * ratio of their spacings; how far below the middle one the choice may lie. */
static const double LEAST_ORDER = 1.5, MOST_ORDER = 3.5, GUESS = .012, GUESS_POINTS = 6, GUESS_ORDER = 2.5,
                    MIDDLE = 2, FINER = 1.5, FAR = 2.3;
enum { ROUNDS = 4, TRIALS = 3 };

static bool looks_like(const struct scene *scene)
{
    return scene->dimension > 1 && body_is_box(&scene->body) && scene->loads > 0 &&
           (ground_is_general(scene) || scene->body.topography != NULL);
}

static const char *refusal(const struct scene *scene)
{
    const double cutoff = source_cutoff(scene);
    if (scene->receivers == 0) return "scenes with receivers, where the error is taken";
    if (scene->initial.kind != INITIAL_REST) return "ground at rest at t = 0";
    if (ground_is_damped(scene)) return "general ground without q_p and q_s";
    if (scene_loads_move(scene)) return "loads that do not move";
    if (!(cutoff > 0) || !isfinite(cutoff)) return "histories whose spectrum ends";
    return NULL;
}

/* Two points along an edge of a patch at least, and the lattice divides a given box. */
static double possible(const struct scene *scene, double h)
{
    for (size_t k = 0; k < scene->loads; k++)
        if (scene->load[k].shape == LOAD_SQUARE || scene->load[k].shape == LOAD_DISC)
            h = fmin(h, scene->load[k].size[0] / 2);
    return scene->body.chosen ? h : dividing_spacing(&scene->body, scene->dimension, h);
}

struct trials {
    double spacing[TRIALS]; /* from the coarsest; the last one's lattice is even */
    double order, error;    /* of the middle one */
    double box;             /* what the box makes of the histories */
    double work;            /* of all that were run */
};

/* The scene of a choice; NULL after saying why there is none, or why it is too much for a trial. */
static struct scene *build(const struct trial *trial, const struct scene_choice *choice, double *work,
                           struct messages *messages)
{
    struct scene *scene = NULL;
    struct messages said = {0};
    if (scene_build(trial->deck, choice, &scene, &said) != SELAS_OK) {
        fail(messages, SELAS_BAD_SCENE, "scene%%accuracy, at a spacing of %.3g: %s", choice->spacing,
             said.text != NULL ? said.text : "no memory");
        scene = NULL;
    } else if (accuracy_work(scene) > ACCURACY_TRIAL_WORK) {
        fail(messages, SELAS_BAD_SCENE,
             "scene%%accuracy: on general ground it follows from trials, and one with a spacing of %.3g "
             "would take %.2g points times steps, more than the %.0g that a trial may; a larger accuracy, or "
             "body%%spacing in its place, would do",
             choice->spacing, accuracy_work(scene), ACCURACY_TRIAL_WORK);
        scene_free(&scene);
    } else {
        *work += accuracy_work(scene);
    }
    messages_free(&said);
    return scene;
}

/* Histories [receivers] of a trial. */
static selas_status run(const struct trial *trial, const struct scene_choice *choice, double *work,
                        struct history_file *kept, struct messages *messages)
{
    struct scene *scene = build(trial, choice, work, messages);
    const selas_status status =
        scene != NULL ? trial->run(scene, NULL, NULL, kept, messages) : SELAS_BAD_SCENE;
    scene_free(&scene);
    return status;
}

static struct history_file *room_for(size_t trials, size_t receivers, struct messages *messages)
{
    struct history_file *kept = array_new(trials * receivers, sizeof *kept);
    if (kept == NULL) fail(messages, SELAS_NO_MEMORY, "no memory for trials");
    return kept;
}

static void free_all(struct history_file *kept, size_t count)
{
    for (size_t i = 0; kept != NULL && i < count; i++)
        history_file_free(&kept[i]);
    array_free(kept);
}

/* Relative L2 difference of the velocity vector, at the worst receiver. */
static double difference(const struct history_file *coarse, const struct history_file *fine, size_t receivers)
{
    double most = 0;
    for (size_t i = 0; i < receivers; i++) {
        double apart = 0, whole = 0;
        size_t row = 0;
        for (size_t k = 0; k < coarse[i].rows; k++) {
            double value[DIFF_CHANNELS];
            history_at(&fine[i], fmin(coarse[i].time[k], fine[i].time[fine[i].rows - 1]), &row, value);
            for (size_t c = 3; c < DIFF_CHANNELS; c++) {
                apart += pow(coarse[i].value[DIFF_CHANNELS * k + c] - value[c], 2);
                whole += value[c] * value[c];
            }
        }
        if (whole > 0) most = fmax(most, sqrt(apart / whole));
    }
    return most;
}

/* With E = C h^p the first two differ from the last by C (h^p - h_3^p): p from the ratio (Eq 13). */
static double order_of(const double spacing[TRIALS], double ratio)
{
    double low = LEAST_ORDER, high = MOST_ORDER;
    for (int i = 0; i < 40; i++) {
        const double p = (low + high) / 2, last = pow(spacing[2], p);
        const bool more = (pow(spacing[0], p) - last) / (pow(spacing[1], p) - last) < ratio;
        *(more ? &low : &high) = p;
    }
    return low;
}

static selas_status run_trials(const struct scene *scene, const struct trial *trial,
                               const struct scene_choice *choice, struct trials *trials,
                               struct messages *messages)
{
    const size_t receivers = scene->receivers;
    struct history_file *kept = room_for(TRIALS, receivers, messages);
    selas_status status = kept != NULL ? SELAS_OK : SELAS_NO_MEMORY;
    for (size_t k = TRIALS; k-- > 0 && status == SELAS_OK;) {
        struct scene_choice tried = *choice;
        tried.spacing = trials->spacing[k];
        if (k + 1 == TRIALS) tried.grading = 0;
        status = run(trial, &tried, &trials->work, kept + k * receivers, messages);
    }
    if (status == SELAS_OK) {
        const struct history_file *fine = kept + (TRIALS - 1) * receivers;
        const double middle = difference(kept + receivers, fine, receivers);
        trials->order = order_of(trials->spacing, difference(kept, fine, receivers) / middle);
        trials->error = middle / (1 - pow(trials->spacing[2] / trials->spacing[1], trials->order));
    }
    free_all(kept, TRIALS * receivers);
    return status;
}

/* --- The box ---------------------------------------------------------------------------------------------- */

/* Has the box that the program fits absorbing layers, and of how many points? */
static bool absorbs(const struct trial *trial, const struct scene_choice *choice, long *points)
{
    struct messages unsaid = {0};
    struct scene *scene = NULL;
    bool absorbing = false;
    if (scene_build(trial->deck, choice, &scene, &unsaid) == SELAS_OK) {
        absorbing = scene->body.chosen && scene->body.absorbing;
        for (int face = 0; face < 2 * scene->dimension; face++)
            *points = (long)fmax((double)*points, (double)layer_points(scene, face));
    }
    scene_free(&scene);
    messages_free(&unsaid);
    return absorbing;
}

/* The fitted box against one from which nothing returns, both with the coarsest trial's points: with layers twice and
 * four times as thick, at last the large box, until they differ by little enough. */
static selas_status choose_box(const struct scene *scene, double accuracy, const struct trial *trial,
                               struct scene_choice *choice, struct trials *trials, struct messages *messages)
{
    enum { THICKER = 2 };
    static const double share = .3;
    const size_t receivers = scene->receivers;
    struct scene_choice tried = *choice, large = *choice;
    long points = 0;
    tried.spacing = large.spacing = trials->spacing[0];
    large.large = true;
    if (!absorbs(trial, &tried, &points)) return SELAS_OK;
    struct history_file *kept = room_for(2, receivers, messages);
    selas_status status = kept != NULL ? run(trial, &large, &trials->work, kept, messages) : SELAS_NO_MEMORY;
    trials->box = INFINITY;
    for (int i = 0; i <= THICKER && status == SELAS_OK && trials->box > share * accuracy; i++) {
        if (i > 0) tried.layer_points = points *= 2;
        for (size_t k = 0; k < receivers; k++)
            history_file_free(&kept[receivers + k]);
        status = run(trial, &tried, &trials->work, kept + receivers, messages);
        if (status == SELAS_OK) trials->box = difference(kept + receivers, kept, receivers);
    }
    free_all(kept, 2 * receivers);
    choice->large = trials->box > share * accuracy;
    if (choice->large) trials->box = 0;
    choice->layer_points = (long)ceil((double)points * tried.spacing / choice->spacing);
    return status;
}

/* --- The choice ------------------------------------------------------------------------------------------- */

static bool find_spacings(const struct scene *scene, double h, double spacing[TRIALS])
{
    spacing[0] = possible(scene, FINER * MIDDLE * h);
    for (int k = 1; k < TRIALS && spacing[k - 1] > 0; k++)
        spacing[k] = possible(scene, spacing[k - 1] / FINER);
    return spacing[2] > 0 && spacing[2] < spacing[1] && spacing[1] < spacing[0];
}

static selas_status narrow(const struct scene *scene, double accuracy, const struct trial *trial,
                           const struct scene_choice *choice, struct trials *trials, double *h,
                           struct messages *messages)
{
    const double *middle = &trials->spacing[1];
    for (int i = 0; i<ROUNDS && * h> 0 && find_spacings(scene, *h, trials->spacing); i++) {
        const selas_status status = run_trials(scene, trial, choice, trials, messages);
        if (status != SELAS_OK) return status;
        const double part = fmin(fmax(ACCURACY_AIM * accuracy / trials->error, .01), 10);
        *h = possible(scene, *middle * pow(part, 1 / trials->order));
        if (*h <= trials->spacing[0] && *middle <= FAR * *h) return SELAS_OK;
    }
    return fail(
        messages, SELAS_BAD_SCENE,
        "scene%%accuracy = %g: trials with spacings near %.3g (error %.2g) lead to none; give body%%spacing",
        accuracy, *middle, trials->error);
}

static double first_guess(const struct scene *scene, double accuracy)
{
    const double wave = 2 * M_PI * slowest_speed(scene) / source_cutoff(scene);
    return possible(scene, wave / GUESS_POINTS * pow(ACCURACY_AIM * accuracy / GUESS, 1 / GUESS_ORDER));
}

static void say(struct scene_choice *choice, double accuracy, const char *graded, const struct trials *trials)
{
    const double *spacing = trials->spacing;
    const int length = snprintf(
        choice->text, sizeof choice->text,
        "%g wanted: spacing %.6g%s, degree 2, mass vc3, leapfrog with the time-dispersion transform; ",
        accuracy, choice->spacing, graded);
    snprintf(choice->text + length, sizeof choice->text - (size_t)length,
             "after trials with %.4g and %.4g, held against an even %.4g (order %.2g): expected error %.2g, "
             "and %.1g from the box; trials took %.2g points times steps",
             spacing[0], spacing[1], spacing[2], trials->order,
             trials->error * pow(choice->spacing / spacing[1], trials->order), trials->box, trials->work);
}

static selas_status choose(const struct scene *scene, double accuracy, const struct trial *trial,
                           struct scene_choice *choice, struct messages *messages)
{
    char graded[GRADE_TEXT];
    struct trials trials = {0};
    double h = first_guess(scene, accuracy);
    if (trial->run == NULL || !(h > 0))
        return fail(messages, SELAS_BAD_SCENE,
                    "scene%%accuracy on general ground follows from trials, which "
                    "cannot be run here; give body%%spacing");
    choice->layer_points = accuracy_layer_points(accuracy);
    choice->spacing = h;
    accuracy_grade(scene, trial, choice, graded);
    selas_status status = narrow(scene, accuracy, trial, choice, &trials, &h, messages);
    choice->spacing = h;
    if (status == SELAS_OK) status = choose_box(scene, accuracy, trial, choice, &trials, messages);
    if (status != SELAS_OK) return status;
    say(choice, accuracy, graded, &trials);
    return SELAS_OK;
}

const struct accuracy_kind accuracy_refined = {
    .looks_like = looks_like,
    .variant = "consistent",
    .served = "method 'smoothed-point', variant 'consistent'",
    .refusal = refusal,
    .choose = choose,
};
