/* Ground that the general operator takes: tilted and graded layers, blocks. */
#include "scene/build.h"

#include <math.h>
#include <string.h>

void read_tilt_and_grade(struct builder *builder, const struct deck_group *group, struct layer *layer)
{
    const double degree = atan(1) / 45;
    const double dip = deck_real(group, "dip", 0) * degree;
    const double towards = (deck_real(group, "strike", 0) + 90) * degree;
    layer->slope[0] = tan(dip) * cos(towards);
    layer->slope[1] = tan(dip) * sin(towards);
    for (int axis = 0; axis < 2; axis++) /* along an axis: what rounding left of 0 */
        if (fabs(layer->slope[axis]) < 1e-12 * tan(dip)) layer->slope[axis] = 0;
    layer->graded = deck_given(group, "bottom");
    if (layer->graded) layer->bottom = find_material(builder, group, "bottom");
}

void build_blocks(struct builder *builder)
{
    struct scene *scene = builder->scene;
    struct body *body = &scene->body;
    const size_t count = deck_count(builder->deck, "block");
    const struct layer *last = body->layers > 0 ? &body->layer[body->layers - 1] : NULL;
    if (last != NULL && last->graded)
        complain(
            builder, deck_get(builder->deck, "layer", 0), NULL,
            "the lowest layer has a material at its bottom but no lower face; expected a layer below it");
    if (count == 0) return;
    body->block = scene_array(builder, count, sizeof *body->block);
    if (body->block == NULL) return;
    body->blocks = count;
    for (size_t i = 0; i < count; i++) {
        const struct deck_group *group = deck_get(builder->deck, "block", i);
        struct ground_block *block = &body->block[i];
        double size[3] = {0};
        block->shape = (enum block_shape)deck_choice(group, "shape", 0);
        block->material = find_material(builder, group, "material");
        if (!need_vector(builder, group, "centre", "a block", block->centre) ||
            !need_vector(builder, group, "size", "a block", size))
            continue;
        for (int axis = 0; axis < 3; axis++)
            block->half[axis] = axis < scene->dimension ? size[axis] / 2 : INFINITY;
    }
}
