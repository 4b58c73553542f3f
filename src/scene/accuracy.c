/* scene%accuracy: which kind of scene it is, and what no kind can serve (doc/accuracy.md). */
#include "scene/accuracy.h"

#include <string.h>

static const struct accuracy_kind *const kinds[2] = {&accuracy_wave, &accuracy_ground};
enum { KINDS = 2 };

static const struct accuracy_kind *kind_of(const struct scene *scene)
{
    for (int k = 0; k < KINDS; k++)
        if (kinds[k]->looks_like(scene)) return kinds[k];
    return NULL;
}

/* What the deck chooses itself leaves the program no choice. */
static void refuse_choices(struct builder *builder)
{
    static const char *const method[] = {"degree",         "ends",     "mass",      "depth_mass",
                                         "dissipation",    "gradient", "hourglass", "viscosity_alpha",
                                         "viscosity_beta", NULL};
    static const char *const step[] = {"scheme", "time_step", "courant", "safety", "unwarp", "force", NULL};
    static const char *const body_words[] = {"spacing", NULL};
    static const char *const layer[] = {"layer_points", "layer_reflection", NULL};
    static const char *const output[] = {"low_pass", NULL};
    const char *purpose = "a deck with scene%accuracy, which makes that choice";
    refuse(builder, deck_get(builder->deck, "method", 0), method, purpose);
    refuse(builder, deck_get(builder->deck, "stepping", 0), step, purpose);
    refuse(builder, deck_get(builder->deck, "output", 0), output, purpose);
    for (size_t k = 0; k < deck_count(builder->deck, "boundary"); k++)
        refuse(builder, deck_get(builder->deck, "boundary", k), layer, purpose);
    if (deck_count(builder->deck, "body") > 0)
        refuse(builder, deck_get(builder->deck, "body", 0), body_words, purpose);
}

void check_accuracy(struct builder *builder)
{
    const struct deck_group *group = deck_get(builder->deck, "scene", 0);
    const bool sound = builder->status == SELAS_OK && builder->scene->materials > 0;
    refuse_choices(builder);
    if (!sound) return; /* complained of elsewhere: a body may have no material that is known */
    const struct accuracy_kind *kind = kind_of(builder->scene);
    if (kind == NULL) {
        complain(builder, group, "accuracy",
                 "there is no table of errors for this scene, only for patches that press on half-spaces and "
                 "boxes "
                 "of one ground, and for plane pulses, loads and motions of whole faces of a box; give "
                 "body%%spacing "
                 "in place of accuracy");
        return;
    }
    const char *why = kind->refusal(builder->scene);
    if (why != NULL)
        complain(builder, group, "accuracy",
                 "there is no table of errors for this scene, only for %s; give body%%spacing in place of "
                 "accuracy",
                 why);
}

selas_status accuracy_choose(const struct scene *scene, double accuracy, struct accuracy_choice *choice,
                             struct messages *messages)
{
    return kind_of(scene)->choose(scene, accuracy, choice, messages);
}
