/* Waves that two faces guide, and what comes back of them from absorbing layers (doc/theory/absorbing-faces.md,
 * section 4). */
#ifndef SELAS_SCENE_GUIDED_H
#define SELAS_SCENE_GUIDED_H

#include "scene/scene.h"

/* Do the two faces across an axis guide waves between them: no way out, and waves that are not plane ones? */
bool faces_guide(const struct scene *scene, int axis);

/* What acts and what is looked at that waves guided between the faces across `axis` join latest; x = (t - from) / unit
 * in (11b), at the end of the run `ways` (0: no such waves). */
struct guided {
    int axis;
    double from, unit, ways;
};
struct guided guided_waves(const struct scene *scene);
/* May the profile be made for less than is needed to keep such waves from growing? */
bool guided_briefly(const struct scene *scene);
/* (11b): what velocities err by at the end, of the largest, at most; and the time when they err by so much. */
double guided_error(const struct scene *scene, const struct guided *guided);
double guided_since(const struct scene *scene, const struct guided *guided, double error);

#endif
