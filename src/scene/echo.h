/* What the faces of a box send back: when it can be seen, and how much it is expected to be
 * (doc/theory/absorbing-faces.md, sections 6 and 7). */
#ifndef SELAS_SCENE_ECHO_H
#define SELAS_SCENE_ECHO_H

#include "scene/extent.h"

/* False if no wave reaches the face of the box and then, `less` short of the whole way, anything that is
 * looked at in time. Without anything that acts or anything that looks: true. */
bool echo_seen(const struct scene *scene, int face, double less);

/* Shortest way from what acts over a face to what is looked at. */
double echo_way(const struct scene *scene, int face, const struct extent *acts, const struct extent *seen);

/* A face without an absorbing layer, since nobody sees by the end what it sends back, whose echo has reached an extent
 * by `time`; FACES if there is none. */
int echo_heard(const struct scene *scene, const struct extent *seen, double time);

/* Relative amplitude (of the velocity where it is looked at) of what an absorbing layer of so many points
 * behind the face sends back, for the worst pair of what acts and what is looked at. */
double echo_of_layer(const struct scene *scene, int face, size_t points);
/* Points of a layer that sends back little enough beside what the spacing errs; 0 to 40. */
size_t echo_points(const struct scene *scene, int face);

#endif
