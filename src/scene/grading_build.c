/* body%grading of a deck (doc/theory/graded-spacing.md). */
#include "scene/build.h"
#include "scene/grading.h"
#include "scene/ground.h"

/* What cannot have it. */
static bool check_body(struct builder *builder, const struct deck_group *group)
{
    const struct body *body = &builder->scene->body;
    if (builder->scene->dimension > 1 && body_is_box(body) && !body->rotated && body->jitter == 0)
        return true;
    complain(builder, group, "grading",
             "a spacing graded over depth needs two or three dimensions and a body of shape 'box' or "
             "'half-space', not turned and without jitter");
    return false;
}

void build_grading(struct builder *builder)
{
    struct scene *scene = builder->scene;
    const struct body *body = &scene->body;
    if (!(body->most_stretch > 1) || !(body->spacing > 0) || !builder->body_known) return;
    const struct deck_group *group = deck_get(builder->deck, "body", 0);
    if (!check_body(builder, group) || builder->status != SELAS_OK) return;
    if (scene_grade(scene) != SELAS_OK) {
        builder->status = fail(builder->messages, SELAS_NO_MEMORY, "no memory for a graded lattice");
        return;
    }
    if (body->grading == NULL)
        deck_warning(
            builder->deck, group, "grading", builder->messages,
            "the spacing over depth stays even: it may grow where all rock further down is faster than the "
            "slowest, some cells below that, and with &topography below topography%%depth");
}
