/* Shorter bodies (see the header). */
#include "model/short_body.h"

#include "base/memory.h"
#include "scene/ground.h"

enum { WORTH = 2 }; /* times as many points as the short body has are in the whole one */

size_t short_body_lost(const struct scene *scene, int axis, size_t cells, size_t longest)
{
    if (scene->body.topography != NULL || ground_varies(scene, axis)) return 0;
    return cells > longest ? cells - longest : 0;
}

bool short_body_pays(int dimension, const size_t *cells, const size_t *lost)
{
    double left = 1;
    for (int axis = 0; axis < dimension; axis++)
        left *= 1 - (double)lost[axis] / (double)cells[axis];
    return left * WORTH <= 1;
}

selas_status short_body_scene(const struct scene *scene, struct scene **undriven, struct messages *messages)
{
    struct scene *copy = array_new(1, sizeof *copy);
    *undriven = copy;
    if (copy == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory to measure the largest frequency");
    *copy = *scene;
    copy->loads = copy->receivers = copy->profiles = copy->snapshots = 0;
    copy->initial.kind = INITIAL_REST;
    copy->ranks = NULL;
    return SELAS_OK;
}
