/* Words that the deck gives and that change nothing of this run. */
#include "advice/parts.h"

#include "method/methods.h"
#include "scene/ground.h"

#include <string.h>

/* Where the words stand, and what they would act on. */
struct place {
    const struct scene *scene;
    const struct stepper *stepper;
    const struct deck_group *group; /* this one of the groups */
};

static bool is_box(const struct place *at)
{
    return at->scene->body.shape != BODY_POINTS;
}

static bool loose(const struct place *at)
{
    return !on_splines(at->stepper->model);
}

static bool shifts(const struct place *at)
{
    return at->scene->body.jitter > 0;
}

static bool damped(const struct place *at)
{
    return ground_is_damped(at->scene);
}

static bool model_damped(const struct place *at)
{
    const struct ground_model *model = at->scene->body.model;
    return model == NULL || (model->damped && model->loss[1] > 0);
}

static bool dips(const struct place *at)
{
    return deck_real(at->group, "dip", 0) != 0;
}

static bool on_a_part(const struct place *at)
{
    return at->scene->dimension > 1 || !deck_chosen(at->group, "kind", "traction");
}

static bool across(const struct place *at)
{
    return at->scene->dimension > 1;
}

/* Central differences leave the kernel to viscosity alone. */
static bool has_kernel(const struct place *at)
{
    if (deck_values(at->group, "gradient") == 0 || !deck_chosen(at->group, "gradient", "central"))
        return true;
    for (int i = 0; i < 2; i++) {
        const char *const word = i == 0 ? "viscosity_alpha" : "viscosity_beta";
        if (deck_values(at->group, word) > 0 && deck_real(at->group, word, 0) > 0) return true;
    }
    return false;
}

static bool sweeps(const struct place *at)
{
    return !by_exact_mass(at->scene);
}

static bool two_masses(const struct place *at)
{
    return !by_general_operator(at->scene) && !body_is_layered(&at->scene->body);
}

static bool filters(const struct place *at)
{
    return !deck_given(at->group, "filter") || deck_real(at->group, "filter", 0) > 0;
}

static bool has_stages(const struct place *at)
{
    return (at->stepper->scheme->can & SCHEME_STAGES) != 0;
}

static bool rules(const struct place *at)
{
    const struct stepping_choice *choice = &at->scene->stepping;
    return !has_stages(at) || (choice->stages == 0 && (choice->time_step > 0 || choice->courant > 0));
}

/* Words of which the method, or the kind of its group, has no use at all are told of or refused elsewhere, those that
 * only allow or limit something (symmetry, fused, force, max_stages) nowhere. */
static const struct idle_word {
    const char *group, *word;
    const char *
        usual; /* what it means to leave the word out, where the table of words has no default; NULL: nothing */
    bool (*acts)(const struct place *at);
    const char *why;
} idle_words[] = {
    {"body", "jitter", NULL, loose,
     "the splines of variant 'consistent' have an even lattice; 'cloud' has scattered points"},
    {"body", "jitter", NULL, is_box, "points that are given are not shifted"},
    {"body", "seed", NULL, shifts, "no point is shifted; body%jitter shifts them"},
    {"layer", "strike", NULL, dips, "the layer is level; dip tilts it"},
    {"model", "q_frequency", NULL, model_damped, "the ground of the model is not damped"},
    {"model", "q_power", NULL, model_damped, "the ground of the model is not damped"},
    {"boundary", "slip", NULL, across, "along one dimension there are no other components"},
    {"load", "shape", "face", on_a_part, "along one dimension a traction acts on a whole face"},
    {"method", "mechanisms", "3", damped, "nothing is damped; q_p and q_s of a material damp it"},
    {"method", "kernel", "cubic", has_kernel, "gradient = 'central' takes no kernel"},
    {"method", "smoothing_length", NULL, has_kernel, "gradient = 'central' takes no kernel"},
    {"method", "quiet", "0", sweeps, "beside the exact mass everything moves"},
    {"method", "depth_mass", "exact", two_masses, "layers and the general operator leave no choice"},
    {"method", "filter_form", "increment", filters, "method%filter is 0"},
    {"method", "jaumann", ".true.", across, "along one dimension nothing turns"},
    {"stepping", "stages", NULL, has_stages, "the stages of this scheme are fixed"},
    {"stepping", "max_stages", NULL, has_stages, "the stages of this scheme are fixed"},
    {"stepping", "rule", NULL, has_stages, "the stages of this scheme are fixed"},
    {"stepping", "rule", NULL, rules, "it chooses stages for a given time_step or courant"},
    {"output", "balance", ".false.", damped, "nothing is damped; the balance of energy is in the report"},
    {"reference", "spectrum", "constant-q", damped, "nothing is damped"},
};
enum { IDLE_WORDS = sizeof idle_words / sizeof *idle_words };

static bool is_idle(const struct idle_word *word, const struct place *at)
{
    const bool of_method = strcmp(word->group, "method") == 0;
    if (!deck_given(at->group, word->word)) return false;
    if (of_method && !method_has_word(at->stepper->model->method, word->word)) return false;
    return !(word->usual != NULL && deck_says(at->group, word->word, word->usual)) && !word->acts(at);
}

void look_at_idle_words(struct adviser *adviser, const struct stepper *stepper)
{
    const struct deck *deck = adviser->scene->deck;
    for (size_t k = 0; k < IDLE_WORDS && deck != NULL; k++) {
        const struct idle_word *word = &idle_words[k];
        const size_t count = deck_count(deck, word->group);
        for (size_t i = 0; i < count; i++) {
            const struct place at = {adviser->scene, stepper, deck_get(deck, word->group, i)};
            char number[32] = "";
            if (!is_idle(word, &at)) continue;
            if (count > 1) snprintf(number, sizeof number, "(%zu)", i + 1);
            advise(adviser, "%s%s%%%s has no effect here: %s", word->group, number, word->word, word->why);
        }
    }
}
