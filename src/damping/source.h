/* The spectrum of the velocities that a scene's loads and moved faces make (doc/theory/damping.md, Eqs 5 and 5a). */
#ifndef SELAS_DAMPING_SOURCE_H
#define SELAS_DAMPING_SOURCE_H

#include "scene/scene.h"

/* Its square at an angular frequency; data: the scene. */
double source_power(const void *data, double angular_frequency);

/* Angular frequency above which each source's spectrum stays below this fraction of the strongest one's; 0 if there is
 * none, INFINITY if it is not known. */
double source_top(const struct scene *scene, double fraction);

#endif
