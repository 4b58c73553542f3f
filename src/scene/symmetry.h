/* Mirror planes of a scene: where everything (faces, ground, loads) maps onto itself, half of the body is
 * enough. */
#ifndef SELAS_SYMMETRY_H
#define SELAS_SYMMETRY_H

#include "scene/scene.h"

/* Bit 1 << axis (of the body's frame) is set if the plane across this axis through the middle of the box is a
 * mirror plane of the scene and a plane of lattice points. Boxes at rest at t = 0 only; 0 otherwise, and where
 * the deck says method%symmetry = .false. */
unsigned scene_mirror_axes(const struct scene *scene);

/* Is load `other` the load itself or its image across any of these mirror planes? */
bool scene_load_repeats(const struct scene *scene, unsigned axes, size_t load, size_t other);

/* The part of a scene below its mirror planes: low..middle along each axis of the mask, symmetry on the new
 * faces. A shallow copy that shares all arrays with the scene given, which must outlive it; loads keep their
 * order. */
struct scene scene_below_mirrors(const struct scene *scene, unsigned axes);

#endif
