/* Ground that the general operator takes: tilted and graded layers, blocks. */
#include "base/memory.h"
#include "scene/build.h"
#include "scene/height_map.h"

#include <math.h>
#include <string.h>

/* An interface of heights in a file. */
static void read_heights(struct builder *builder, const struct deck_group *group, struct layer *layer)
{
    static const char *const tilt_words[] = {"dip", "strike", NULL};
    static const double piece = 2; /* of the splines, in spacings */
    const int axes = builder->scene->dimension - 1;
    const struct body *body = &builder->scene->body;
    struct messages said = {0};
    refuse(builder, group, tilt_words, "a layer whose upper face is from a file");
    if (body->shape != BODY_BOX) {
        complain(builder, group, "file", "interfaces from files need body%%shape = 'box'");
        return;
    }
    char *path = deck_path(builder, deck_text(group, "file", 0));
    if (path != NULL && builder->body_known)
        layer->map = height_map_read(path, axes, deck_real(group, "datum", 0), piece * body->spacing, &said);
    if (path != NULL && builder->body_known && layer->map == NULL)
        complain_of_heights(builder, group, "file", &said);
    messages_free(&said);
    array_free(path);
    if (layer->map == NULL) return;
    height_map_cover(layer->map, builder, group, axes);
    layer->top -= height_map_centre(layer->map);
}

void read_interface(struct builder *builder, const struct deck_group *group, struct layer *layer)
{
    static const char *const file_words[] = {"datum", NULL};
    if (deck_given(group, "file")) {
        read_heights(builder, group, layer);
        return;
    }
    refuse(builder, group, file_words, "a layer without a file");
    const double degree = atan(1) / 45;
    const double dip = deck_real(group, "dip", 0) * degree;
    const bool in_plane = builder->scene->dimension == 2;
    const double strike = in_plane && !deck_given(group, "strike") ? -90 : deck_real(group, "strike", 0);
    if (in_plane && fabs(strike) != 90)
        complain(builder, group, "strike",
                 "in two dimensions faces tilt along x; expected -90 (deeper towards x, the default) or 90");
    const double towards = (strike + 90) * degree;
    layer->slope[0] = tan(dip) * cos(towards);
    layer->slope[1] = tan(dip) * sin(towards);
    for (int axis = 0; axis < 2; axis++) /* along an axis: what rounding left of 0 */
        if (fabs(layer->slope[axis]) < 1e-12 * tan(dip)) layer->slope[axis] = 0;
}

void read_grade(struct builder *builder, const struct deck_group *group, struct layer *layer)
{
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
