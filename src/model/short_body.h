/* What methods share that have their largest frequency measured on a shorter body (model.h, shorten): axes of
 * many equal cells lose cells from the middle. */
#ifndef SELAS_MODEL_SHORT_BODY_H
#define SELAS_MODEL_SHORT_BODY_H

#include "scene/scene.h"

/* Cells that an axis of so many loses down to `longest`; none where the ground varies along it. */
size_t short_body_lost(const struct scene *scene, int axis, size_t cells, size_t longest);
/* True if what is left of axes of cells[c] that lose lost[c] is little enough to be worth its making. */
bool short_body_pays(int dimension, const size_t *cells, const size_t *lost);
/* A copy of the scene that nothing drives, records, has set in motion or shares; it borrows all else from the scene;
 * to be freed by array_free(). SELAS_NO_MEMORY. */
selas_status short_body_scene(const struct scene *scene, struct scene **undriven, struct messages *messages);

#endif
