/* Options of the consistent smoothed point method: what the deck says, what it leaves open, what cannot be
 * (manual, doc/theory/consistent-method.md). */
#include "method/consistent/consistent.h"
#include "method/consistent/galerkin/galerkin.h"
#include "scene/absorbing_layers.h"
#include "scene/ground.h"

#include <string.h>

/* Cells between two layers, of degree 3 and more: thinner bodies grew (doc/theory/absorbing-faces.md, section 5). */
enum { THINNEST = 4 };

static bool tunable(const struct scene *scene, const struct consistent_options *options)
{
    return options->degree == TUNED_DEGREE && options->sweeps == 0 && !options->mapped &&
           scene->initial.kind == INITIAL_REST;
}

/* Loads whose integrals know nothing of the map (doc/theory/topography.md, graded-spacing.md). */
static selas_status check_surface(const struct scene *scene, struct messages *messages)
{
    const bool bent = scene->body.topography != NULL;
    const char *word = bent ? "&topography" : "body%grading";
    for (size_t k = 0; (bent || scene->body.grading != NULL) && k < scene->loads; k++) {
        const struct load *load = &scene->load[k];
        if (load->kind == LOAD_BODY_FORCE && load->shape == LOAD_FACE)
            return fail(messages, SELAS_UNSUPPORTED,
                        "load %zu: with %s a body force acts at a point, not over the whole body",
                        load->group + 1, word);
        if (load->kind == LOAD_TRACTION && face_axis(load->face) != scene->dimension - 1)
            return fail(messages, SELAS_UNSUPPORTED,
                        "load %zu: with %s tractions act on the surface or the lower face, not on face %s",
                        load->group + 1, word, face_name(load->face));
    }
    return SELAS_OK;
}

/* What the general operator has and has not. */
static selas_status check_general(const struct scene *scene, const struct consistent_options *options,
                                  struct messages *messages)
{
    if (options->degree != 2 || options->sweeps != 3 || options->mapped || options->tuned ||
        options->dissipation > 0)
        return fail(
            messages, SELAS_UNSUPPORTED,
            "method%%operator = 'general' needs method%%degree = 2, method%%mass = 'vc3', method%%ends "
            "= 'open', splines that are not tuned and no dissipation");
    if (scene->dimension == 1)
        return fail(messages, SELAS_UNSUPPORTED,
                    "method%%operator = 'general' needs two or three dimensions; in one take 'layered'");
    if (scene->dimension == 2 && scene->plane == PLANE_STRESS)
        return fail(messages, SELAS_UNSUPPORTED,
                    "method%%operator = 'general' takes plane strain, not plane stress");
    for (int face = 0; face < 2 * scene->dimension; face++) {
        if (boundary_acts(&scene->boundary[face]))
            return fail(
                messages, SELAS_UNSUPPORTED,
                "face %s: method%%operator = 'general' has no moved faces (but supports, of amplitude 0)",
                face_name((enum face)face));
    }
    return check_surface(scene, messages);
}

/* The operator that the deck names, else the one that the ground needs. */
static bool wants_general(const struct scene *scene)
{
    const struct deck_group *group = scene->method.group;
    if (group == NULL || !deck_given(group, "operator")) return ground_needs_general(scene);
    return deck_chosen(group, "operator", "general");
}

/* Layers beside this degree and mass (doc/theory/absorbing-faces.md, section 5: what grew). */
static selas_status check_layers(const struct scene *scene, const struct consistent_options *options,
                                 struct messages *messages)
{
    for (int face = 0; face < 2 * scene->dimension; face++) {
        if (layer_points(scene, face) == 0) continue;
        const char *missing = NULL;
        if (options->tuned)
            missing = "splines that are not tuned";
        else if (options->sweeps > 0)
            missing = options->degree > 2 ? "at degree 3 and more method%mass = 'exact'" : NULL;
        else if (scene->dimension == 1)
            missing = "in one dimension method%mass = 'vc1', 'vc2' or 'vc3'";
        if (missing != NULL)
            return fail(messages, SELAS_UNSUPPORTED,
                        "face %s: layer 'pml' needs %s; else take layer = 'lysmer'",
                        face_name((enum face)face), missing);
        const int axis = face / 2;
        const double cells = (scene->body.high[axis] - scene->body.low[axis]) / scene->body.spacing;
        if (options->degree > 2 && face % 2 == 1 && layer_points(scene, face - 1) > 0 &&
            cells < THINNEST - 1e-6)
            return fail(
                messages, SELAS_UNSUPPORTED,
                "faces %s, %s: between two absorbing layers a body of degree %d is at least %d spacings "
                "wide, this one %g",
                face_name((enum face)(face - 1)), face_name((enum face)face), options->degree, THINNEST,
                cells);
    }
    return SELAS_OK;
}

selas_status consistent_check(const struct scene *scene, const struct consistent_options *options,
                              struct messages *messages)
{
    if (options->degree < 1 || options->degree > SPLINE_MAX_DEGREE)
        return fail(messages, SELAS_BAD_SCENE, "method%%degree = %d; expected 1 to %d", options->degree,
                    SPLINE_MAX_DEGREE);
    static const char *const of_sweeps[] = {"dissipation", "depth_mass"};
    const struct deck_group *group = scene->method.group;
    for (size_t i = 0; i < 2 && group != NULL && options->sweeps == 0; i++)
        if (deck_given(group, of_sweeps[i]) && !(i == 0 && deck_real(group, "dissipation", 0) == 0))
            return fail(messages, SELAS_UNSUPPORTED,
                        "method%%%s needs method%%mass = 'vc1', 'vc2' or 'vc3', not 'exact'", of_sweeps[i]);
    if (options->tuned && !tunable(scene, options))
        return fail(
            messages, SELAS_UNSUPPORTED,
            "method%%tuned needs method%%degree = %d, method%%mass = 'exact', method%%ends = 'open' and a "
            "body at rest",
            TUNED_DEGREE);
    if (!body_is_box(&scene->body))
        return fail(messages, SELAS_UNSUPPORTED,
                    "the consistent smoothed point method needs a box or a half-space; for other bodies take "
                    "method%%variant = 'paper' or method%%name = 'sph'");
    selas_status status = check_layers(scene, options, messages);
    if (status != SELAS_OK) return status;
    if (!options->general && ground_needs_general(scene))
        return fail(messages, SELAS_UNSUPPORTED,
                    "&model, &block, &topography, body%%grading and tilted or graded &layer need "
                    "method%%operator = 'general'");
    if (options->general) return check_general(scene, options, messages);
    return SELAS_OK;
}

static bool given(const struct deck_group *group, const char *word)
{
    return group != NULL && deck_values(group, word) > 0;
}

struct wave_law consistent_waves(const struct consistent_options *options)
{
    static const double constant[SPLINE_MAX_DEGREE - 1][4] = {
        {25, 2000, 400, 120}, {7, 3000, 600, 200}, {2, 4000, 800, 300}}; /* by degree from 2 on, by sweeps */
    static const double sent_exactly[SPLINE_MAX_DEGREE - 1] = {15, 150, 2200};
    const int degree = options->degree, sweeps = options->sweeps;
    const bool exact = sweeps == 0, plain = degree == 2 && exact;
    if (degree == 1)
        return (struct wave_law){
            .constant = 12, .order = 2, .spread = .44, .turned = .26, .sent = 8, .sent_order = 2};
    const double most = constant[degree - 2][sweeps];
    const double sent = exact ? sent_exactly[degree - 2] : (sweeps == 1 ? .4 : .25) * most;
    return (struct wave_law){.constant = most,
                             .order = 4,
                             .spread = .24,
                             .turned = plain ? .26 : .093,
                             .sent = sent,
                             .sent_order = exact ? 2 * degree : 4};
}

/* The deck's options; what it leaves open has the method's defaults. Layered ground has degree 4, the exact mass and
 * tuned splines where no C-PML stands beside it: waves in a soft layer are short against the spacing, and there this
 * errs a fifth of what degree 2 with sweeps does (doc/theory/layered.md). Beside C-PML degree 2 with sweeps is the
 * cheapest at equal error (doc/verification/tables/layered.txt, table 2). */
struct consistent_options consistent_options_of(const struct scene *scene)
{
    const struct deck_group *group = scene->method.group;
    struct consistent_options options = {.degree = 2, .sweeps = 3, .general = wants_general(scene)};
    if (!options.general && body_is_layered(&scene->body) && !layer_anywhere(scene) &&
        !given(group, "mass") && !given(group, "depth_mass") && !given(group, "dissipation")) {
        options.degree = 4;
        options.sweeps = 0;
    }
    if (scene->method.degree > 0) { /* scene%accuracy */
        options.degree = scene->method.degree;
        options.sweeps = scene->method.sweeps;
    }
    if (given(group, "degree")) options.degree = (int)deck_integer(group, "degree", 0);
    if (given(group, "mass")) {
        const char *mass = deck_text(group, "mass", 0);
        options.sweeps = strcmp(mass, "exact") == 0 ? 0 : mass[2] - '0'; /* vc1, vc2, vc3 */
    }
    options.depth_exact = !deck_chosen(group, "depth_mass", "same");
    if (given(group, "dissipation")) options.dissipation = deck_real(group, "dissipation", 0);
    options.quiet = given(group, "quiet") ? deck_real(group, "quiet", 0) : 1e-12;
    options.single = deck_chosen(group, "precision", "single");
    if (given(group, "fused")) options.unfused = !deck_logical(group, "fused", 0);
    options.mapped = deck_chosen(group, "ends", "mapped");
    options.tuned = !options.general && body_is_layered(&scene->body) && tunable(scene, &options) &&
                    !layer_anywhere(scene);
    if (given(group, "tuned")) options.tuned = deck_logical(group, "tuned", 0);
    return options;
}
