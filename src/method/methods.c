/* The methods: a table of names. A new method is one new file and one line here. */
#include "method/consistent/consistent.h"
#include "method/mirror.h"
#include "method/paper/paper.h"
#include "method/total_lagrangian/total_lagrangian.h"
#include "method/updated_lagrangian/updated_lagrangian.h"
#include "scene/symmetry.h"

#include <string.h>

static const struct model_class *const methods[] = {
    &consistent_class, &paper_class, &cloud_class, &total_lagrangian_class, &model_updated_lagrangian, NULL,
};

const struct model_class *model_find(const char *method, const char *variant)
{
    for (size_t i = 0; methods[i] != NULL; i++)
        if (strcmp(methods[i]->method, method) == 0 && strcmp(methods[i]->variant, variant) == 0)
            return methods[i];
    return NULL;
}

selas_status model_create(const struct scene *scene, struct model **model, struct messages *messages)
{
    *model = NULL;
    const struct model_class *class = model_find(scene->method.name, scene->method.variant);
    if (class == NULL)
        return fail(messages, SELAS_UNSUPPORTED, "method '%s' has no variant '%s'", scene->method.name,
                    scene->method.variant);
    const struct deck_group *group = scene->method.group;
    if (group != NULL && strcmp(deck_text(group, "precision", 0), "single") == 0 &&
        class != &consistent_class)
        return deck_error(
            scene->deck, group, "precision", messages,
            "only the consistent smoothed-point method has a state in single precision; expected "
            "'double'");
    const unsigned axes = class->mirrors && mirrors_wanted(scene) ? scene_mirror_axes(scene) : 0;
    if (axes != 0) return mirror_create(class, scene, axes, model, messages);
    return class->create(scene, model, messages);
}

void model_free(struct model **model)
{
    if (model == NULL || *model == NULL) return;
    (*model)->class->destroy(*model);
    *model = NULL;
}
