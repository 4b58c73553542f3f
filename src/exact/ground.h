/* What the exact solutions of half-spaces ask of a scene, and places in the ground. */
#ifndef SELAS_GROUND_H
#define SELAS_GROUND_H

#include "scene/scene.h"

/* Position relative to the free surface, in the body's frame; depths of rounding size are 0. */
void ground_position(const struct scene *scene, const double deck[3], double position[3]);

/* SELAS_BAD_SCENE with the reason, in the name of the reference, unless body, faces and start are those of a
 * half-space under loads. */
selas_status ground_check(const struct scene *scene, const char *reference, struct messages *messages);

#endif
