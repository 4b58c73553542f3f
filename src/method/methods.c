/* The methods of the list in deck/choices.h: a new method is a folder and a line there. */
#include "method/methods.h"

#include "base/processor.h"
#include "method/damped/damped.h"
#include "method/mirror.h"
#include "parallel/ranks.h"
#include "scene/ground.h"
#include "scene/symmetry.h"

#include <stdio.h>
#include <string.h>

#define NO_FAMILY(word)
#define DECLARE(symbol, ...) extern const struct method method_##symbol;
#define ENTRY(symbol, ...) &method_##symbol,
METHODS(NO_FAMILY, DECLARE)
const struct method *const method_table[] = {METHODS(NO_FAMILY, ENTRY) NULL};

const struct method *method_find(const char *name, const char *variant)
{
    for (size_t i = 0; method_table[i] != NULL; i++)
        if (strcmp(method_table[i]->name, name) == 0 && strcmp(method_table[i]->variant, variant) == 0)
            return method_table[i];
    return NULL;
}

/* Does a list of words parted by blanks have this one? */
static bool has_word(const char *words, const char *word)
{
    const size_t length = strlen(word);
    for (const char *at = words; at != NULL && *at != '\0'; at += strspn(at, " ")) {
        const size_t here = strcspn(at, " ");
        if (here == length && strncmp(at, word, length) == 0) return true;
        at += here;
    }
    return false;
}

bool method_has_word(const struct method *method, const char *word)
{
    static const char all[] = "name variant symmetry precision";
    return method->words == NULL || has_word(all, word) || has_word(method->words, word);
}

/* Words of another method are told of: the deck may have been made for it. */
static void warn_of_idle_words(const struct method *method, const struct scene *scene,
                               struct messages *messages)
{
    const struct deck_group *group = scene->method.group;
    const char *first = NULL;
    char idle[256] = "";
    for (size_t i = 0; group != NULL && deck_word(group, i) != NULL; i++) {
        const char *word = deck_word(group, i);
        if (!deck_given(group, word) || method_has_word(method, word)) continue;
        const size_t length = strlen(idle);
        snprintf(idle + length, sizeof idle - length, "%s'%s'", first != NULL ? ", " : "", word);
        if (first == NULL) first = word;
    }
    if (first != NULL)
        deck_warning(scene->deck, group, first, messages,
                     "method '%s', variant '%s', has no use for %s; its own words are: %s", method->name,
                     method->variant, idle, method->words);
}

/* What the scene asks of the method beyond its equations. */
static selas_status check_abilities(const struct method *method, const struct scene *scene,
                                    struct messages *messages)
{
    const struct deck_group *group = scene->method.group;
    const struct method *other = method;
    char name[2 * NAME_SIZE + 32];
    snprintf(name, sizeof name, "method '%s', variant '%s',", method->name, method->variant);
    if (ranks_count(scene->ranks) > 1 && !method->ranks)
        return fail(messages, SELAS_UNSUPPORTED,
                    "%s runs on one rank: start it without mpirun; 'smoothed-point', 'consistent' and 'sph', "
                    "'total-lagrangian' and 'updated-lagrangian' run on many",
                    name);
    if (deck_chosen(group, "precision", "single") && !method->single)
        return deck_error(scene->deck, group, "precision", messages,
                          "%s has no state in single precision; expected 'double'", name);
    for (size_t i = 0; i < deck_count(scene->deck, "material") && !method->damping; i++)
        if (scene->material[i].q_p > 0)
            return deck_error(
                scene->deck, deck_get(scene->deck, "material", i), "q_p", messages,
                "%s has no damping by q_p and q_s; expected 'smoothed-point', 'consistent' or 'sph', "
                "'total-lagrangian'",
                name);
    for (size_t i = 0; method_table[i] != NULL && !other->point_materials; i++)
        other = method_table[i];
    if (scene->body.given != NULL && scene->body.given->material != NULL && other != method)
        return fail(messages, SELAS_UNSUPPORTED,
                    "%s has no materials point by point, only &layer where it takes layers; expected '%s', "
                    "'%s'",
                    name, other->name, other->variant);
    if (ground_needs_general(scene) && !method->any_ground)
        return fail(messages, SELAS_UNSUPPORTED,
                    "%s takes no &model, no &block, no &topography, no body%%grading and no tilted or "
                    "graded &layer; expected 'smoothed-point', 'consistent'",
                    name);
    return scene_check_faces(scene, method->faces, name, messages);
}

bool method_takes(const struct method *method, const struct scene *scene)
{
    struct messages said = {0};
    selas_status status = check_abilities(method, scene, &said);
    if (status == SELAS_OK && method->suits != NULL) status = method->suits(scene, &said);
    const bool quietly = said.warnings == 0;
    messages_free(&said);
    return status == SELAS_OK && quietly;
}

selas_status model_create(const struct scene *scene, struct model **model, struct messages *messages)
{
    *model = NULL;
    selas_status status = processor_check(messages);
    if (status != SELAS_OK) return status;
    const struct method *method = method_find(scene->method.name, scene->method.variant);
    if (method == NULL)
        return fail(messages, SELAS_UNSUPPORTED, "method '%s' has no variant '%s'", scene->method.name,
                    scene->method.variant);
    status = check_abilities(method, scene, messages);
    if (status != SELAS_OK) return status;
    warn_of_idle_words(method, scene, messages);
    const unsigned axes = method->mirrors ? scene_mirror_axes(scene) : 0;
    if (axes != 0) return mirror_create(method, scene, axes, model, messages);
    return damped_or_plain(method, scene, model, messages);
}
