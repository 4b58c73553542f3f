/* When what a face sends back can be seen. */
#ifndef SELAS_SCENE_ECHO_H
#define SELAS_SCENE_ECHO_H

#include "scene/scene.h"

/* Shortest way from where waves begin (the edges of loads; 0 if they begin everywhere, move or fill a face)
 * to the face of the box and on to a receiver or profile (0 if snapshots look everywhere), mirror images
 * behind an opposite symmetry plane included; >= 0, infinite without loads or without anything that looks. */
double echo_path(const struct scene *scene, int face);

#endif
