/* Point sources on evenly spaced splines, of higher order than the functions themselves. */
#ifndef SELAS_METHOD_SPLINE_SOURCE_H
#define SELAS_METHOD_SPLINE_SOURCE_H

#include "method/spline/tuned.h"

/* What a unit force at x, or of a moment tensor its value (slope false) or slope (true), gives to each control value:
 * like value or slope of tuned_at(), but free of what the place of x between the knots makes of moment tensors, to
 * fifth order, and of solutions that alternate along the axis (degrees 3 and 4, where there is room for their filter;
 * doc/theory/consistent-splines.md, section 15). False, and nothing set, for other forces and where the seven control
 * values about x are not evenly spaced: next to ends that are no symmetry planes (degree 2: to clamped ones) and to
 * interfaces. */
enum source_kind { SOURCE_NONE, SOURCE_FORCE, SOURCE_MOMENT };
bool source_at(const struct spline *spline, bool odd, enum source_kind kind, bool slope, double x,
               struct tuned_point *point);

/* Weights (V2) of control values at distances `away` (in cells), from a bell that is 0 from `reach` on; slopes: times
 * the cell. */
enum { SOURCE_WIDE = 7 };
void source_weights(int degree, bool slope, const double away[SOURCE_WIDE], double reach,
                    double weight[SOURCE_WIDE]);
/* Shares of the first `hats` hats at the knots 0 .. 6 from an end, the others being 0, in a density with the moments 1
 * to `hats`, at most 6, about it of a unit at `depth` (in cells). */
void source_hats(double depth, int hats, double share[SOURCE_WIDE]);

#endif
