/* Control values of an axis and their images beyond symmetry planes; differences of evenly spaced ones. */
#include "method/spline/images.h"

#include <math.h>

/* Control value that stands at place `at` of the axis, which may lie beyond a mirror: its index, sign and
 * position. False: none does. */
static bool control_at(const struct spline *spline, bool odd, ptrdiff_t at, size_t *index, double *sign,
                       double *position)
{
    const ptrdiff_t count = (ptrdiff_t)spline->count;
    ptrdiff_t inside = at;
    if (at < 0) inside = spline->centred[0] ? -at : -1 - at;
    if (at >= count) inside = 2 * count - at - (spline->centred[1] ? 2 : 1);
    const int end = at < 0 ? 0 : 1;
    const bool beyond = inside != at;
    if (inside < 0 || inside >= count || (beyond && !spline->mirror[end])) return false;
    const bool on_plane = (spline->centred[0] && inside == 0) || (spline->centred[1] && inside == count - 1);
    *index = (size_t)inside;
    *sign = !odd ? 1 : on_plane ? 0 : beyond ? -1 : 1;
    *position = spline->greville[inside];
    if (beyond) *position = 2 * (end == 0 ? spline->low : spline->high) - *position;
    return true;
}

bool spline_difference(const struct spline *spline, bool odd, ptrdiff_t first, int order,
                       struct difference *difference)
{
    double position[MOST_DIFFERENCE + 1] = {0}, binomial = order % 2 == 0 ? 1 : -1;
    difference->order = order;
    for (int i = 0; i <= order; i++) {
        double sign;
        if (!control_at(spline, odd, first + i, &difference->index[i], &sign, &position[i])) return false;
        difference->factor[i] = binomial * sign;
        binomial *= -(double)(order - i) / (i + 1);
    }
    const double gap = (position[order] - position[0]) / order;
    for (int i = 1; i <= order; i++)
        if (fabs(position[i] - position[i - 1] - gap) > 1e-6 * gap) return false;
    return true;
}

bool spline_images(const struct spline *spline, bool odd, double x, int count, struct images *images)
{
    ptrdiff_t nearest = 0;
    for (ptrdiff_t at = -1; at <= (ptrdiff_t)spline->count; at++) {
        double sign, here, best;
        size_t index;
        if (control_at(spline, odd, at, &index, &sign, &here) &&
            (!control_at(spline, odd, nearest, &index, &sign, &best) || fabs(here - x) < fabs(best - x)))
            nearest = at;
    }
    for (int i = 0; i < count; i++)
        if (!control_at(spline, odd, nearest - count / 2 + i, &images->index[i], &images->sign[i],
                        &images->position[i]))
            return false;
    images->gap = (images->position[count - 1] - images->position[0]) / (count - 1);
    for (int i = 1; i < count; i++)
        if (fabs(images->position[i] - images->position[i - 1] - images->gap) > 1e-6 * images->gap)
            return false;
    return true;
}
