/* Point sources of degrees 3 and 4 that leave alone what alternates along the axes. */
#ifndef SELAS_METHOD_SPLINE_QUIET_H
#define SELAS_METHOD_SPLINE_QUIET_H

#include "method/spline/source.h"

/* Source of degree 3 or 4: the functions at a force, the weights (V2) of a moment tensor, filtered by P (V3) and, where
 * the spline is tuned, by F. False, and nothing set, where the control values about x (15, of a tuned spline 23) are
 * not evenly spaced. */
bool quiet_at(const struct spline *spline, bool odd, enum source_kind kind, bool slope, double x,
              struct tuned_point *point);

#endif
