/* Example of an exact solution: a free body that moves as a whole, u = v0 t, v = v0. */
#include "base/memory.h"
#include "exact/exact.h"

extern const struct exact_class exact_uniform_motion;

static selas_status create(const struct scene *scene, struct exact **exact, struct messages *messages)
{
    *exact = NULL;
    bool at_rest = scene->initial.kind != INITIAL_UNIFORM_VELOCITY || scene->loads > 0;
    for (int face = 0; face < FACES; face++)
        at_rest = at_rest || !boundary_is_free(&scene->boundary[face]);
    if (at_rest)
        return fail(
            messages, SELAS_BAD_SCENE,
            "reference 'uniform-motion' needs &initial kind = 'uniform-velocity', free faces and no loads");
    struct exact *solution = array_new(1, sizeof *solution);
    if (solution == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the exact solution");
    *solution = (struct exact){.class = &exact_uniform_motion, .scene = scene};
    *exact = solution;
    return SELAS_OK;
}

static void destroy(struct exact *exact)
{
    array_free(exact);
}

static selas_status history(struct exact *exact, const double position[3], size_t n, const double *time,
                            double *value, struct messages *messages)
{
    (void)position;
    (void)messages;
    for (size_t i = 0; i < n; i++)
        for (size_t c = 0; c < 3; c++) {
            value[6 * i + c] = exact->scene->initial.velocity[c] * time[i];
            value[6 * i + 3 + c] = exact->scene->initial.velocity[c];
        }
    return SELAS_OK;
}

const struct exact_class exact_uniform_motion = {
    .kind = "uniform-motion",
    .create = create,
    .destroy = destroy,
    .history = history,
};
