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
#include <string.h>

/* Power of the spacing with which errors fall in ground of one rock and, at most, in all other general ground
 * (measured on scenes drawn by chance: of one rock it tells more than its trials, beside jumps of the rock trials
 * that come closer with a smaller power, SURE_ORDER at least), and the least of the trials' own that is let stand;
 * error at so many points per wavelength of the slowest wave for a first guess; the first trial's spacing over
 * that, and of one trial over the next; how far below the last trial's the choice lies as a rule, and at most
 * where the next one would be too much (no farther than the trial where its own power is below SURE_ORDER); the
 * most of a trial's error from which one may tell. */
static const double EVEN_ORDER = 4.8, ORDER = 3.2, LEAST_ORDER = 1.5, GUESS = .012, GUESS_POINTS = 6,
                    COARSE = 2.83, FINER = 1.41421356, SURE_ORDER = 2, NEAR = 1.5, FAR = 2.5, CARRIED = .5;
enum { MOST_TRIALS = 16, TRIALS = 3 };

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
    struct history_file *kept; /* [TRIALS * receivers], in the order of spacing[] */
    size_t count;              /* how many there were; the last three are kept */
    double spacing[TRIALS];    /* from the coarsest to the last, which stands last */
    double apart[TRIALS - 1];  /* how far neighbours lie apart */
    double most, order,
        error;   /* power with which errors fall at most, and are taken to fall; error of the last one */
    double box;  /* what the box makes of the histories; INFINITY: not tried */
    double work; /* of all that were run */
    size_t mechanisms; /* of damped ground; 0: there is no damping ... */
    double off;        /* ... and how far off constant Q */
};

/* The scene of a choice; NULL after saying why there is none. */
static struct scene *build(const struct trial *trial, const struct scene_choice *choice,
                           struct messages *messages)
{
    struct scene *scene = NULL;
    struct messages said = {0};
    if (scene_build(trial->deck, choice, &scene, &said) != SELAS_OK) {
        fail(messages, SELAS_BAD_SCENE, "scene%%accuracy, at a spacing of %.3g: %s", choice->spacing,
             said.text != NULL ? said.text : "no memory");
        scene = NULL;
    }
    messages_free(&said);
    return scene;
}

/* Histories [receivers] of a trial. */
static selas_status run(const struct trial *trial, const struct scene_choice *choice, double *work,
                        struct history_file *kept, struct messages *messages)
{
    struct scene *scene = build(trial, choice, messages);
    if (scene == NULL) return SELAS_BAD_SCENE;
    *work += accuracy_work(scene);
    const selas_status status = trial->run(scene, NULL, NULL, kept, messages);
    scene_free(&scene);
    return status;
}

static void free_all(struct history_file *kept, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        history_file_free(&kept[i]);
        kept[i] = (struct history_file){0};
    }
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

/* The power with which neighbours come closer. */
static double own_order(const struct trials *trials)
{
    return log(trials->apart[0] / trials->apart[1]) / log(trials->spacing[0] / trials->spacing[1]);
}

/* One more trial, behind which the three last ones are kept, and what they tell once there are as many. */
static selas_status add_trial(const struct scene *scene, const struct trial *trial,
                              const struct scene_choice *choice, double spacing, struct trials *trials,
                              struct messages *messages)
{
    const size_t receivers = scene->receivers;
    struct history_file *kept = trials->kept, *last = kept + (TRIALS - 1) * receivers;
    struct scene_choice tried = *choice;
    for (size_t i = 0; i < receivers; i++)
        history_file_free(&kept[i]);
    memmove(kept, kept + receivers, (TRIALS - 1) * receivers * sizeof *kept);
    memset(last, 0, receivers * sizeof *last);
    memmove(trials->spacing, trials->spacing + 1, (TRIALS - 1) * sizeof spacing);
    trials->spacing[TRIALS - 1] = tried.spacing = spacing;
    const selas_status status = run(trial, &tried, &trials->work, last, messages);
    if (status != SELAS_OK || ++trials->count < 2) return status;
    trials->apart[0] = trials->apart[1];
    trials->apart[1] = difference(last - receivers, last, receivers);
    if (trials->count >= TRIALS && trials->most < EVEN_ORDER)
        trials->order = fmin(trials->most, fmax(own_order(trials), SURE_ORDER));
    trials->error = trials->apart[1] / (pow(trials->spacing[1] / spacing, trials->order) - 1);
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

/* The fitted box against one from which nothing returns, both with the coarsest of the last trials' points: with
 * layers twice and four times as thick, at last the large box, until they differ by little enough. */
static selas_status choose_box(const struct scene *scene, double accuracy, const struct trial *trial,
                               struct scene_choice *choice, struct trials *trials, struct messages *messages)
{
    enum { THICKER = 2 };
    static const double share = .3;
    static const char *const why = "layers sent back too much in a trial";
    const size_t receivers = scene->receivers;
    struct history_file *kept = trials->kept;
    struct scene_choice tried = *choice, large = *choice;
    long points = 0;
    tried.spacing = large.spacing = trials->spacing[0];
    large.large = why;
    if (!absorbs(trial, &tried, &points)) return SELAS_OK;
    trials->box = INFINITY;
    if (accuracy_work_of(trial, &large) > ACCURACY_TRIAL_WORK) return SELAS_OK;
    free_all(kept + receivers, 2 * receivers);
    selas_status status = run(trial, &large, &trials->work, kept + receivers, messages);
    if (status == SELAS_OK) trials->box = difference(kept, kept + receivers, receivers);
    for (int i = 0; i < THICKER && status == SELAS_OK && trials->box > share * accuracy; i++) {
        tried.layer_points = points *= 2;
        free_all(kept, receivers);
        status = run(trial, &tried, &trials->work, kept, messages);
        if (status == SELAS_OK) trials->box = difference(kept, kept + receivers, receivers);
    }
    choice->large = trials->box > share * accuracy ? why : NULL;
    if (choice->large != NULL) trials->box = 0;
    choice->layer_points = (long)ceil((double)points * tried.spacing / choice->spacing);
    return status;
}

/* --- Mechanisms ------------------------------------------------------------------------------------------- */

/* What so many are off by their fit; INFINITY: there is none. */
static double fit_off(const struct trial *trial, const struct scene_choice *choice)
{
    struct messages unsaid = {0};
    struct scene *scene = NULL;
    struct ground_damping *damping = NULL;
    double off = INFINITY;
    if (scene_build(trial->deck, choice, &scene, &unsaid) == SELAS_OK &&
        ground_damping_new(scene, true, &damping, &unsaid) == SELAS_OK)
        off = ground_damping_off(damping);
    ground_damping_free(damping);
    scene_free(&scene);
    messages_free(&unsaid);
    return off;
}

/* Mechanisms from one up to the most: what their fits are off (0: not tried), and their histories. */
struct fits {
    double off[MOST_MECHANISMS + 1];
    struct history_file *kept; /* [MOST_MECHANISMS + 1][receivers] */
};

/* Runs so many mechanisms, unless that has been done or no fit is passive. */
static selas_status try_mechanisms(const struct trial *trial, const struct scene_choice *choice, size_t count,
                                   size_t receivers, struct fits *fits, double *work,
                                   struct messages *messages)
{
    struct scene_choice tried = *choice;
    if (fits->off[count] > 0) return SELAS_OK;
    tried.mechanisms = count;
    fits->off[count] = fit_off(trial, &tried);
    if (isinf(fits->off[count])) return SELAS_OK;
    return run(trial, &tried, work, fits->kept + count * receivers, messages);
}

/* The fewest mechanisms whose run lies within a share of the wanted error of constant Q, of which those with BETTER
 * more stand for: these are off themselves, by as much less as their fit is (doc/verification/accuracy.md, Eq 13a).
 * The points are those of the coarsest of the last trials. */
static selas_status find_mechanisms(const struct scene *scene, double accuracy, const struct trial *trial,
                                    const struct scene_choice *choice, struct trials *trials,
                                    struct fits *fits, struct messages *messages)
{
    enum { BETTER = 2 };
    static const double share = .3;
    struct scene_choice coarse = *choice;
    selas_status status = SELAS_OK;
    coarse.spacing = trials->spacing[0];
    trials->off = INFINITY;
    while (status == SELAS_OK && trials->off > share * accuracy && trials->mechanisms < MOST_MECHANISMS - 1) {
        const size_t n = ++trials->mechanisms, receivers = scene->receivers;
        const size_t better = n + BETTER < MOST_MECHANISMS ? n + BETTER : MOST_MECHANISMS;
        status = try_mechanisms(trial, &coarse, n, receivers, fits, &trials->work, messages);
        if (status == SELAS_OK)
            status = try_mechanisms(trial, &coarse, better, receivers, fits, &trials->work, messages);
        if (status == SELAS_OK && isfinite(fits->off[n]) && fits->off[better] < fits->off[n])
            trials->off = difference(fits->kept + n * receivers, fits->kept + better * receivers, receivers) /
                          (1 - fits->off[better] / fits->off[n]);
    }
    if (status != SELAS_OK || trials->off <= share * accuracy) return status;
    return fail(
        messages, SELAS_BAD_SCENE,
        "scene%%accuracy = %g is out of reach here: %zu relaxation mechanisms are %.2g off constant Q",
        accuracy, trials->mechanisms, trials->off);
}

static selas_status choose_mechanisms(const struct scene *scene, double accuracy, const struct trial *trial,
                                      const struct scene_choice *choice, struct trials *trials,
                                      struct messages *messages)
{
    if (!ground_is_damped(scene)) return SELAS_OK;
    const size_t count = (MOST_MECHANISMS + 1) * scene->receivers;
    struct fits fits = {.kept = array_new(count, sizeof *fits.kept)};
    if (fits.kept == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for trials");
    const selas_status status = find_mechanisms(scene, accuracy, trial, choice, trials, &fits, messages);
    free_all(fits.kept, count);
    array_free(fits.kept);
    return status;
}

/* --- The choice ------------------------------------------------------------------------------------------- */

/* Where the third trial would be too much, up to twice as coarse. */
static double first_trial(const struct scene *scene, const struct trial *trial,
                          const struct scene_choice *choice, double guess)
{
    struct scene_choice third = *choice;
    double h = COARSE * guess;
    for (int i = 0; i < 2; i++) {
        third.spacing = possible(scene, h / (FINER * FINER));
        if (accuracy_work_of(trial, &third) > ACCURACY_TRIAL_WORK) h *= FINER;
    }
    return possible(scene, h);
}

/* Trials from coarse to fine until the choice lies near the last one, or as far as may be where the next would be too
 * much. */
static selas_status narrow(const struct scene *scene, double accuracy, const struct trial *trial,
                           const struct scene_choice *choice, struct trials *trials, double *h,
                           struct messages *messages)
{
    struct scene_choice next = *choice;
    bool told = false;
    for (next.spacing = first_trial(scene, trial, choice, *h);
         next.spacing > 0 && trials->count < MOST_TRIALS;
         next.spacing = possible(scene, next.spacing / FINER)) {
        if (accuracy_work_of(trial, &next) > ACCURACY_TRIAL_WORK) break;
        const selas_status status = add_trial(scene, trial, choice, next.spacing, trials, messages);
        if (status != SELAS_OK) return status;
        if (trials->count < TRIALS) continue;
        const double part = pow(ACCURACY_AIM * accuracy / trials->error, 1 / trials->order);
        *h = possible(scene, fmin(next.spacing * part, trials->spacing[0]));
        told =
            *h > 0 && trials->error < CARRIED && next.spacing <= FAR * *h && own_order(trials) >= LEAST_ORDER;
        if (told && next.spacing <= (own_order(trials) < SURE_ORDER ? 1 : NEAR) * *h) return SELAS_OK;
    }
    if (told) return SELAS_OK;
    return fail(
        messages, SELAS_BAD_SCENE,
        "scene%%accuracy = %g: on general ground the spacing follows from trials, and those of at most %.0g "
        "points times steps, down to a spacing of %.3g, do not tell; a larger accuracy, or body%%spacing in "
        "its place, would do",
        accuracy, ACCURACY_TRIAL_WORK, trials->spacing[TRIALS - 1]);
}

static double order_of(const struct scene *scene)
{
    return scene->materials > 1 || scene->body.model != NULL ? ORDER : EVEN_ORDER;
}

static double first_guess(const struct scene *scene, double accuracy)
{
    const double wave = 2 * M_PI * slowest_speed(scene) / source_cutoff(scene);
    return possible(scene, wave / GUESS_POINTS * pow(ACCURACY_AIM * accuracy / GUESS, 1 / order_of(scene)));
}

static void say(struct scene_choice *choice, double accuracy, const char *graded, const struct trials *trials)
{
    const double *spacing = trials->spacing, beyond = spacing[TRIALS - 1] / choice->spacing;
    char box[48] = "", far[80] = "", damping[64] = "";
    if (isinf(trials->box)) snprintf(box, sizeof box, ", that of the box not tried");
    if (trials->box > 0 && isfinite(trials->box))
        snprintf(box, sizeof box, ", and %.1g from the box", trials->box);
    if (trials->mechanisms > 0)
        snprintf(damping, sizeof damping, "; %zu mechanisms, %.2g off constant Q", trials->mechanisms,
                 trials->off);
    if (beyond > NEAR)
        snprintf(far, sizeof far, "; extrapolated by a factor of %.2g from what trials could take", beyond);
    snprintf(choice->text, sizeof choice->text,
             "%g wanted: spacing %.6g%s, degree 2, mass vc3, leapfrog with the time-dispersion transform; "
             "after trials with %.4g, %.4g, %.4g (of order %.2g, %.2g taken): expected error %.2g%s%s%s; "
             "trials took %.2g points times steps",
             accuracy, choice->spacing, graded, spacing[0], spacing[1], spacing[2], own_order(trials),
             trials->order, trials->error * pow(choice->spacing / spacing[2], trials->order), box, far,
             damping, trials->work);
}

static selas_status choose_by(const struct scene *scene, double accuracy, const struct trial *trial,
                              struct scene_choice *choice, struct trials *trials, struct messages *messages)
{
    char graded[GRADE_TEXT];
    double h = first_guess(scene, accuracy);
    if (trial->run == NULL || !(h > 0))
        return fail(messages, SELAS_BAD_SCENE,
                    "scene%%accuracy on general ground follows from trials, which "
                    "cannot be run here; give body%%spacing");
    choice->layer_points = accuracy_layer_points(accuracy);
    choice->spacing = h;
    accuracy_grade(scene, trial, choice, graded);
    selas_status status = narrow(scene, accuracy, trial, choice, trials, &h, messages);
    choice->spacing = h;
    if (status == SELAS_OK) status = choose_mechanisms(scene, accuracy, trial, choice, trials, messages);
    if (status == SELAS_OK) status = choose_box(scene, accuracy, trial, choice, trials, messages);
    choice->mechanisms = trials->mechanisms;
    if (status == SELAS_OK) say(choice, accuracy, graded, trials);
    return status;
}

static selas_status choose(const struct scene *scene, double accuracy, const struct trial *trial,
                           struct scene_choice *choice, struct messages *messages)
{
    struct trials trials = {.kept = array_new(TRIALS * scene->receivers, sizeof *trials.kept),
                            .most = order_of(scene)};
    trials.order = trials.most;
    if (trials.kept == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for trials");
    const selas_status status = choose_by(scene, accuracy, trial, choice, &trials, messages);
    free_all(trials.kept, TRIALS * scene->receivers);
    array_free(trials.kept);
    return status;
}

const struct accuracy_kind accuracy_refined = {
    .looks_like = looks_like,
    .variant = "consistent",
    .served = "method 'smoothed-point', variant 'consistent'",
    .refusal = refusal,
    .choose = choose,
    .velocity = true,
};
