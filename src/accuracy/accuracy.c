/* scene%accuracy: which kind of scene it is, and what no kind can serve (doc/verification/accuracy.md). */
#include "accuracy/accuracy.h"

#include "accuracy/kinds.h"
#include "damping/ground.h"
#include "scene/build.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { KINDS = 5 };
static const struct accuracy_kind *const kinds[KINDS] = {&accuracy_refined, &accuracy_beam, &accuracy_plate,
                                                         &accuracy_wave, &accuracy_ground};

static const struct accuracy_kind *kind_of(const struct scene *scene)
{
    for (int k = 0; k < KINDS; k++)
        if (kinds[k]->looks_like(scene)) return kinds[k];
    return NULL;
}

/* What the deck chooses itself leaves the program no choice. */
static void refuse_choices(struct builder *builder, const struct accuracy_kind *kind)
{
    static const char *const method[] = {"degree",           "ends",        "mass",      "tuned",
                                         "depth_mass",       "dissipation", "hourglass", "kernel",
                                         "smoothing_length", "mechanisms",  NULL};
    static const char *const particles[] = {"gradient", "viscosity_alpha", "viscosity_beta", NULL};
    static const char *const step[] = {"scheme", "time_step", "courant", "safety", "unwarp", "force", NULL};
    static const char *const body_words[] = {"spacing", NULL};
    static const char *const layer[] = {"layer_points", "layer_thickness", "layer_reflection", NULL};
    static const char *const output[] = {"low_pass", NULL};
    const char *purpose = "a deck with scene%accuracy, which makes that choice";
    refuse(builder, deck_get(builder->deck, "method", 0), method, purpose);
    if (kind != NULL && !kind->particles)
        refuse(builder, deck_get(builder->deck, "method", 0), particles, purpose);
    refuse(builder, deck_get(builder->deck, "stepping", 0), step, purpose);
    refuse(builder, deck_get(builder->deck, "output", 0), output, purpose);
    for (size_t k = 0; k < deck_count(builder->deck, "boundary"); k++)
        refuse(builder, deck_get(builder->deck, "boundary", k), layer, purpose);
    if (deck_count(builder->deck, "body") > 0)
        refuse(builder, deck_get(builder->deck, "body", 0), body_words, purpose);
}

const char *accuracy_gradient(const struct scene *scene)
{
    const struct deck_group *group = scene->method.group;
    return deck_values(group, "gradient") > 0 ? deck_text(group, "gradient", 0) : "quadratic";
}

const char *accuracy_refusal(const struct accuracy_kind *kind, const struct scene *scene)
{
    if (scene->body.most_stretch > 1 && kind != &accuracy_ground && kind != &accuracy_refined)
        return "an even spacing, without body%grading, but on half-spaces and boxes of ground";
    if (ground_is_damped(scene) && kind != &accuracy_ground && kind != &accuracy_refined)
        return "materials without q_p and q_s, but on half-spaces and boxes of ground";
    if (kind->variant != NULL && strcmp(kind->variant, scene->method.variant) != 0) return kind->served;
    return kind->refusal(scene);
}

static void check(struct builder *builder)
{
    const struct deck_group *group = deck_get(builder->deck, "scene", 0);
    const bool sound = builder->status == SELAS_OK && builder->scene->materials > 0;
    const struct accuracy_kind *kind = sound ? kind_of(builder->scene) : NULL;
    refuse_choices(builder, kind);
    if (!sound) return; /* complained of elsewhere: a body may have no material that is known */
    if (kind == NULL) {
        complain(builder, group, "accuracy",
                 "there is no table of errors for this scene, only for patches, forces and moment tensors on "
                 "half-spaces and boxes of ground, for plane pulses, loads and motions of whole faces of a "
                 "box, for swinging "
                 "beams and for plates with a hole; give body%%spacing in place of accuracy");
        return;
    }
    const char *why = accuracy_refusal(kind, builder->scene);
    if (why != NULL)
        complain(builder, group, "accuracy",
                 "there is no table of errors for this scene, only for %s; give body%%spacing in place of "
                 "accuracy",
                 why);
}

/* What the run is held against when it is over, if the deck names no &reference. */
static void take_reference(const struct scene_choice *choice, double accuracy, struct reference *reference)
{
    if (reference->kind[0] != '\0' || choice->exact == NULL) return;
    snprintf(reference->kind, sizeof reference->kind, "%s", choice->exact);
    reference->tolerance = fmin(1e-3, .1 * accuracy);
}

/* Builds a scene that asks for an accuracy: with a guess, then with the spacing that follows from it. */
static selas_status build_accurate(const struct deck *deck, double accuracy, trial_run *run,
                                   struct scene **scene, struct messages *messages)
{
    const struct trial trial = {deck, run};
    struct scene_choice choice = {.check = check};
    struct messages scratch = {0}; /* the second building says everything */
    selas_status status = scene_build(deck, &choice, scene, &scratch);
    messages_free(&scratch);
    if (status != SELAS_OK) return scene_build(deck, &choice, scene, messages);
    const struct accuracy_kind *kind = kind_of(*scene);
    status = kind->choose(*scene, accuracy, &trial, &choice, messages);
    scene_free(scene);
    if (status == SELAS_OK) status = scene_build(deck, &choice, scene, messages);
    if (status != SELAS_OK || *scene == NULL) return status;
    memcpy((*scene)->body.accuracy, choice.text, sizeof choice.text);
    if (kind->velocity) (*scene)->accuracy = accuracy;
    take_reference(&choice, accuracy, &(*scene)->reference);
    return SELAS_OK;
}

selas_status accuracy_build(const struct deck *deck, trial_run *run, struct scene **scene,
                            struct messages *messages)
{
    const struct deck_group *group = deck_get(deck, "scene", 0);
    if (!deck_given(group, "accuracy")) return scene_build(deck, NULL, scene, messages);
    return build_accurate(deck, deck_real(group, "accuracy", 0), run, scene, messages);
}
