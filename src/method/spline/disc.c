/* Integrals of products of two axes' basis functions over a disc.
 *
 * With x = x0 + r sin(theta) the disc is |y - y0| < r cos(theta): over y the moments are exact, over theta
 * the integrand is analytic between the angles where the circle or the line meets a knot, so that Gauss
 * points between them give rounding. */
#include "method/spline/disc.h"

#include "base/gsl_errors.h"
#include "base/memory.h"
#include "method/spline/tuned.h"

#include <gsl/gsl_integration.h>
#include <math.h>
#include <string.h>

enum { POINTS = 16 };

/* Smallest angle > theta at which the line x or the circle meets a knot. */
static double next_angle(const struct spline *first, const struct spline *second, const struct disc *disc,
                         double theta)
{
    double next = M_PI / 2;
    for (size_t e = 0; e <= first->elements; e++) {
        const double x = e < first->elements ? first->element[e].x_from : first->high;
        const double angle = asin(fmax(-1, fmin(1, (x - disc->first) / disc->radius)));
        if (angle > theta + 1e-12 && angle < next) next = angle;
    }
    for (size_t e = 0; e <= second->elements; e++) {
        const double y = e < second->elements ? second->element[e].x_from : second->high;
        const double cosine = fabs(y - disc->second) / disc->radius;
        if (cosine > 1) continue;
        for (int sign = -1; sign <= 1; sign += 2) {
            const double angle = sign * acos(cosine);
            if (angle > theta + 1e-12 && angle < next) next = angle;
        }
    }
    return next;
}

/* Adds weight * first_i(x) * (integral of second_j over the chord). */
static void add_chord(const struct spline *first, bool first_odd, const struct spline *second,
                      bool second_odd, double x, const double middle_half[2], double weight, double *chord,
                      double *moment)
{
    struct tuned_point at;
    tuned_at(first, first_odd, x, &at);
    tuned_moments(second, second_odd, middle_half[0] - middle_half[1], middle_half[0] + middle_half[1],
                  chord + second->count, chord);
    for (size_t i = 0; i < at.count; i++) {
        double *row = moment + at.index[i] * second->count;
        for (size_t j = 0; j < second->count; j++)
            row[j] += weight * at.value[i] * chord[j];
    }
}

bool disc_moments(const struct spline *first, bool first_odd, const struct spline *second, bool second_odd,
                  const struct disc *disc, double *moment)
{
    memset(moment, 0, first->count * second->count * sizeof *moment);
    gsl_errors_returned();
    gsl_integration_glfixed_table *table = gsl_integration_glfixed_table_alloc(POINTS);
    gsl_errors_as_before();
    double *chord = array_new(2 * second->count, sizeof *chord);
    const bool good = table != NULL && chord != NULL;
    for (double theta = -M_PI / 2; good && theta < M_PI / 2 - 1e-12;) {
        const double next = next_angle(first, second, disc, theta);
        for (size_t q = 0; q < POINTS; q++) {
            double angle, weight;
            gsl_integration_glfixed_point(theta, next, q, &angle, &weight, table);
            const double x = disc->first + disc->radius * sin(angle), half = disc->radius * cos(angle);
            if (x < first->low || x > first->high) continue;
            add_chord(first, first_odd, second, second_odd, x, (const double[2]){disc->second, half},
                      weight * half, chord, moment);
        }
        theta = next;
    }
    if (table != NULL) gsl_integration_glfixed_table_free(table);
    array_free(chord);
    return good;
}
