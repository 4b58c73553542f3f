/* Point sources of degrees 3 and 4 that leave alone what alternates along the axes. */
#ifndef SELAS_METHOD_SPLINE_QUIET_H
#define SELAS_METHOD_SPLINE_QUIET_H

#include "method/spline/tuned.h"

/* Value (slope false) or slope at x of the functions filtered by P (V3), and by F where the spline is tuned: what a
 * unit force or slope there gives to each control value. False, and nothing set, where the control values about x (13,
 * of a tuned spline 21) are not evenly spaced. */
bool quiet_at(const struct spline *spline, bool odd, bool slope, double x, struct tuned_point *point);

#endif
