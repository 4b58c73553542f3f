/* The methods of the list in deck/choices.h: a new method is a folder and a line there. */
#include "method/methods.h"

#include "method/mirror.h"
#include "scene/symmetry.h"

#include <stdio.h>
#include <string.h>

#define NO_FAMILY(word)
#define DECLARE(symbol, family, word) extern const struct method method_##symbol;
#define ENTRY(symbol, family, word) &method_##symbol,
METHODS(NO_FAMILY, DECLARE)
static const struct method *const methods[] = {METHODS(NO_FAMILY, ENTRY) NULL};

const struct method *method_find(const char *name, const char *variant)
{
    for (size_t i = 0; methods[i] != NULL; i++)
        if (strcmp(methods[i]->name, name) == 0 && strcmp(methods[i]->variant, variant) == 0)
            return methods[i];
    return NULL;
}

selas_status model_create(const struct scene *scene, struct model **model, struct messages *messages)
{
    *model = NULL;
    const struct method *method = method_find(scene->method.name, scene->method.variant);
    if (method == NULL)
        return fail(messages, SELAS_UNSUPPORTED, "method '%s' has no variant '%s'", scene->method.name,
                    scene->method.variant);
    const struct deck_group *group = scene->method.group;
    if (deck_chosen(group, "precision", "single") && !method->single)
        return deck_error(
            scene->deck, group, "precision", messages,
            "only the consistent smoothed-point method has a state in single precision; expected "
            "'double'");
    char name[2 * NAME_SIZE + 32];
    snprintf(name, sizeof name, "method '%s', variant '%s',", method->name, method->variant);
    const selas_status status = scene_check_faces(scene, method->faces, name, messages);
    if (status != SELAS_OK) return status;
    const unsigned axes = method->mirrors && mirrors_wanted(scene) ? scene_mirror_axes(scene) : 0;
    if (axes != 0) return mirror_create(method, scene, axes, model, messages);
    return method->create(scene, model, messages);
}
