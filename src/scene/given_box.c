/* The box of a half-space whose deck gives low and high: what acts all over it needs sides that let its waves pass. */
#include "scene/absorbing_layers.h"
#include "scene/build.h"
#include "scene/extent.h"

#include <math.h>

/* Waves from all over the surface, or the body, run along the sides: rollers let those along the depth pass,
 * nothing the others. */
static void check_sides(struct builder *builder, const struct extent *extent)
{
    const struct scene *scene = builder->scene;
    const int sides = 2 * scene->dimension - 2;
    bool slide = true;
    for (int face = 0; face < sides; face++)
        slide = slide && boundary_slides(&scene->boundary[face]);
    if (extent->role != EXTENT_ACTS || !isinf(extent->low[0]) || (extent->plane && slide)) return;
    complain(builder, deck_get(builder->deck, extent->group, extent->index), NULL,
             extent->plane
                 ? "what acts all over a half-space sends waves along its sides, where only rollers let "
                   "them pass: say &boundary kind = 'roller' of them"
                 : "what acts here has no end, and the sides of a half-space have no place for it; a "
                   "body of shape 'box' has sides of its own");
}

void check_half_space(struct builder *builder)
{
    const struct scene *scene = builder->scene;
    struct extent extent;
    bool damped = false;
    if (scene->body.shape != BODY_HALF_SPACE || scene->body.chosen || builder->status != SELAS_OK) return;
    for (size_t i = 0; scene_extent(scene, i, &extent); i++)
        check_sides(builder, &extent);
    for (int face = 0; face < 2 * scene->dimension; face++)
        damped = damped || (!scene->boundary[face].given && boundary_damps(&scene->boundary[face]));
    if (damped)
        deck_warning(
            builder->deck, deck_get(builder->deck, "body", 0), "low", builder->messages,
            "the faces of the half-space that no &boundary names have dampers, which send back a good part "
            "of the waves that meet them askew (%s); without low and high the program chooses a box from "
            "which nothing returns",
            layers_refusal(scene));
}
