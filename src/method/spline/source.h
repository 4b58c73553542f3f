/* Point sources on evenly spaced splines, of higher order than the functions themselves. */
#ifndef SELAS_METHOD_SPLINE_SOURCE_H
#define SELAS_METHOD_SPLINE_SOURCE_H

#include "method/spline/tuned.h"

/* What a unit force at x (slope false), or the slope there (true), gives to each control value: like value or slope
 * of tuned_at(), but free of what the place of x between the knots makes of them, to fifth order (degrees 1 and 2),
 * or of solutions that alternate along the axis (3 and 4; doc/theory/consistent-splines.md, section 15). False, and
 * nothing set, where the control values about x are not evenly spaced: next to ends that are no symmetry planes
 * (degree 2: to clamped ones) and to interfaces. */
bool source_at(const struct spline *spline, bool odd, bool slope, double x, struct tuned_point *point);

#endif
