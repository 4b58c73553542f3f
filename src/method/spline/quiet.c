/* Point sources of degrees 3 and 4 (doc/theory/consistent-splines.md, section 15). Where M is not lumped the equations
 * along an axis have solutions (-1)^b exp(-a |b|), which stand about a point source. The functions at a force,
 * of degree 4 at a moment tensor, and the weights (V2) of one of degree 3 are filtered,
 *
 *   w := P w,   P = 1 - (t / t_a)^n,   t_a = 2 + 2 cosh a,                                                     (V3)
 *
 * t = (2 sin(theta / 2))^2, minus the second difference: P is 0 for these solutions and 1 to order theta^(2 n) for the
 * waves that the lattice carries. */
#include "method/spline/quiet.h"

#include "method/spline/images.h"
#include "method/spline/source.h"

#include <math.h>

/* a between the roots of the symbols of S and M: .843 and .625 (degree 3), .624 and .497 (4), .296 and .260 (4,
 * tuned). */
static const struct rule {
    int power;
    double decay;
} cubic = {4, .72}, quartic = {4, .56}, tuned = {8, .28};

/* The B-spline of a degree about its middle. */
static double cardinal(int degree, double x)
{
    if (degree == 0) return x >= -.5 && x < .5 ? 1 : 0;
    const double half = .5 * (degree + 1);
    return ((half + x) * cardinal(degree - 1, x + .5) + (half - x) * cardinal(degree - 1, x - .5)) / degree;
}

/* t y, y zero beyond its ends. */
static void minus_second_difference(double *y, int count)
{
    double before = 0;
    for (int b = 0; b < count; b++) {
        const double here = y[b];
        y[b] = 2 * here - before - (b + 1 < count ? y[b + 1] : 0);
        before = here;
    }
}

bool quiet_at(const struct spline *spline, bool odd, enum source_kind kind, bool slope, double x,
              struct tuned_point *point)
{
    const int degree = spline->degree;
    const struct rule *rule = degree == 3 ? &cubic : spline->filter[odd] == NULL ? &quartic : &tuned;
    const int wide = 2 * rule->power + SOURCE_WIDE;
    struct images images;
    struct tuned_point plain = {.count = (size_t)wide};
    double away[SOURCE_WIDE], weight[SOURCE_WIDE], function[MOST_IMAGES] = {0}, taken[MOST_IMAGES] = {0};
    if (!spline_images(spline, odd, x, wide, &images)) return false;
    for (int b = 0; b < SOURCE_WIDE; b++)
        away[b] = (images.position[rule->power + b] - x) / images.gap;
    const bool functions = kind == SOURCE_FORCE || degree == TUNED_DEGREE;
    if (!functions) source_weights(degree, slope, away, .5 * SOURCE_WIDE, weight);
    for (int b = 0; b < SOURCE_WIDE && functions; b++)
        weight[b] = slope ? cardinal(degree - 1, away[b] - .5) - cardinal(degree - 1, away[b] + .5)
                          : cardinal(degree, away[b]);
    for (int b = 0; b < SOURCE_WIDE; b++)
        function[rule->power + b] = taken[rule->power + b] = weight[b] / (slope ? images.gap : 1);
    for (int j = 0; j < rule->power; j++)
        minus_second_difference(taken, wide);
    const double most = pow(2 + 2 * cosh(rule->decay), rule->power);
    for (int b = 0; b < wide; b++) {
        plain.index[b] = images.index[b];
        *(slope ? &plain.slope[b] : &plain.value[b]) = images.sign[b] * (function[b] - taken[b] / most);
    }
    tuned_filter(spline, odd, &plain, point);
    return true;
}
