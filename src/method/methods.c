/* The table of methods: a new method is a folder and a line here. */
#include "method/methods.h"

#include "method/cloud/cloud.h"
#include "method/consistent/consistent.h"
#include "method/mirror.h"
#include "method/paper/paper.h"
#include "method/total_lagrangian/total_lagrangian.h"
#include "method/updated_lagrangian/updated_lagrangian.h"
#include "scene/symmetry.h"

#include <string.h>

static const struct method *const methods[] = {
    &method_consistent,         &method_paper, &method_cloud, &method_total_lagrangian,
    &method_updated_lagrangian, NULL,
};

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
    for (size_t i = 0; i < scene->materials; i++)
        if (scene->material[i].q_p > 0)
            return deck_error(scene->deck, deck_get(scene->deck, "material", i), "q_p", messages,
                              "runs are undamped; only 'selas exact' with reference 'layered' takes q_p and "
                              "q_s");
    const struct method *method = method_find(scene->method.name, scene->method.variant);
    if (method == NULL)
        return fail(messages, SELAS_UNSUPPORTED, "method '%s' has no variant '%s'", scene->method.name,
                    scene->method.variant);
    const struct deck_group *group = scene->method.group;
    if (group != NULL && strcmp(deck_text(group, "precision", 0), "single") == 0 && !method->single)
        return deck_error(
            scene->deck, group, "precision", messages,
            "only the consistent smoothed-point method has a state in single precision; expected "
            "'double'");
    const unsigned axes = method->mirrors && mirrors_wanted(scene) ? scene_mirror_axes(scene) : 0;
    if (axes != 0) return mirror_create(method, scene, axes, model, messages);
    return method->create(scene, model, messages);
}
