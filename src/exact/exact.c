/* The exact solutions: a table of kinds. A new one is one new file and one line here. */
#include "exact/exact.h"

#include "exact/bar.h"
#include "exact/beam.h"
#include "exact/hole.h"
#include "exact/lamb.h"
#include "exact/layered_ground.h"
#include "exact/plane_wave.h"
#include "exact/recorded.h"
#include "exact/stokes.h"

#include <string.h>

static const struct exact_class *const kinds[] = {
    &exact_bar,        &exact_beam,     &exact_hole,   &exact_lamb, &exact_layered_ground,
    &exact_plane_wave, &exact_recorded, &exact_stokes, NULL,
};

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
            return fail(
                messages, SELAS_BAD_SCENE,
                "reference '%s' is undamped, but material '%s' has q_p and q_s; take reference 'layered'",
                class->kind, scene->material[i].name);
    return class->create(scene, exact, messages);
}

void exact_free(struct exact **exact)
{
    if (exact == NULL || *exact == NULL) return;
    (*exact)->class->destroy(*exact);
    *exact = NULL;
}
