/* The exact solutions of the list in deck/choices.h: a new one is a file and a line there. */
#include "exact/exact.h"

#include "scene/ground.h"

#include <string.h>

#define DECLARE(symbol, word) extern const struct exact_class exact_##symbol;
#define ENTRY(symbol, word) &exact_##symbol,
EXACT_SOLUTIONS(DECLARE)
static const struct exact_class *const kinds[] = {EXACT_SOLUTIONS(ENTRY) NULL};

const struct exact_class *exact_find(const char *kind)
{
    for (size_t i = 0; kinds[i] != NULL; i++)
        if (strcmp(kinds[i]->kind, kind) == 0) return kinds[i];
    return NULL;
}

selas_status exact_create(const struct scene *scene, struct exact **exact, struct messages *messages)
{
    *exact = NULL;
    const struct exact_class *class = exact_find(scene->reference.kind);
    if (class == NULL)
        return fail(messages, SELAS_BAD_SCENE,
                    "the deck asks for no exact solution that is known here ('%s')", scene->reference.kind);
    for (size_t i = 0; i < scene->materials && !class->damped; i++)
        if (scene->material[i].q_p > 0)
            return fail(messages, SELAS_BAD_SCENE,
                        "reference '%s' is undamped, but material '%s' has q_p and q_s; take reference "
                        "'layered' or 'file'",
                        class->kind, scene->material[i].name);
    if (ground_is_general(scene) && !class->any_ground)
        return fail(messages, SELAS_BAD_SCENE,
                    "reference '%s' takes no &model, no &block, no &topography and no tilted or graded "
                    "&layer; expected 'file'",
                    class->kind);
    return class->create(scene, exact, messages);
}

selas_status exact_compute(struct exact *exact, struct messages *messages)
{
    if (exact->computed || exact->class->compute == NULL) return SELAS_OK;
    const selas_status status = exact->class->compute(exact, messages);
    exact->computed = status == SELAS_OK;
    return status;
}

void exact_free(struct exact **exact)
{
    if (exact == NULL || *exact == NULL) return;
    (*exact)->class->destroy(*exact);
    *exact = NULL;
}
