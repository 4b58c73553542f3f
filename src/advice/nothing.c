/* What a deck says and the scene has nothing of. */
#include "advice/parts.h"

#include "scene/boundary.h"
#include "scene/ground.h"
#include "scene/topography.h"

#include <math.h>

static void look_at_rest(struct adviser *adviser)
{
    const struct scene *scene = adviser->scene;
    bool acts = scene_driven(scene) || scene->initial.kind != INITIAL_REST;
    for (size_t k = 0; k < scene->loads; k++) {
        const struct load *load = &scene->load[k];
        if (load->amplitude == 0) continue;
        acts = true;
        if (load->driven == BY_HISTORY && load->history.start >= scene->end_time)
            advise(adviser, "load %zu begins at t = %g and the run ends at %g: it does nothing",
                   scene->load[k].group + 1, load->history.start, scene->end_time);
    }
    for (int face = 0; face < FACES; face++)
        acts = acts || boundary_acts(&scene->boundary[face]);
    if (!acts)
        advise(adviser, "nothing acts: no load, no face that moves, no state at t = 0; all results are 0");
}

static void look_at_blocks(struct adviser *adviser)
{
    const struct body *body = &adviser->scene->body;
    for (size_t k = 0; k < body->blocks; k++)
        for (int axis = 0; axis < adviser->scene->dimension; axis++) {
            const double from = body->block[k].centre[axis] - body->block[k].half[axis];
            const double to = body->block[k].centre[axis] + body->block[k].half[axis];
            const double low = ground_low(body, axis);
            if (to > low && from < body->high[axis]) continue;
            advise(adviser,
                   "&block %zu lies outside the body: along %c it goes from %g to %g, the body from %g to %g",
                   k + 1, 'x' + axis, from, to, low, body->high[axis]);
            break;
        }
}

/* A hill between two points is none, or a spike of one. */
static void look_at_hill(struct adviser *adviser)
{
    const struct body *body = &adviser->scene->body;
    const struct topography *hill = body->topography;
    if (hill == NULL || hill->map != NULL || !(hill->height != 0) || !(hill->width < body->spacing)) return;
    advise(adviser,
           "topography%%width = %g is less than the spacing of %g: the points do not see the shape; a finer "
           "spacing or a wider shape would be right",
           hill->width, body->spacing);
}

static void look_at_rows(struct adviser *adviser)
{
    const struct scene *scene = adviser->scene;
    if (scene->receivers == 0 || scene->output.history_step <= scene->end_time) return;
    advise(adviser,
           "output%%history_step = %g is longer than the run, %g: histories have the row t = 0 alone",
           scene->output.history_step, scene->end_time);
}

void look_at_nothing(struct adviser *adviser)
{
    look_at_rows(adviser);
    look_at_rest(adviser);
    look_at_blocks(adviser);
    look_at_hill(adviser);
}
