/* B-splines on one axis: values and integrals (knots.c lays the knots).
 *
 * Values by the recurrence of Cox and de Boor; integrals by Gauss quadrature, exact for polynomials; the
 * rational integrands of mapped ends get enough points for rounding (doc/theory/consistent-method.md, section 2). */
#include "method/spline/bspline.h"

#include <math.h>

/* Values and slopes d/dt of the functions first .. first + degree at t (Cox-de Boor). */
static void basis(const struct spline *s, size_t first, double t, double *value, double *slope)
{
    const size_t p = (size_t)s->degree;
    const double *knot = s->knot + first; /* the element lies between knot[p] and knot[p + 1] */
    for (size_t j = 0; j <= p; j++)
        value[j] = slope[j] = j == 0;
    for (size_t degree = 1; degree <= p; degree++) {
        double below[SPLINE_MAX_LOCAL] = {0};
        for (size_t j = 0; j < degree; j++)
            below[j] = value[j];
        for (size_t j = 0; j <= degree; j++) {
            const double *k = knot + (p - degree) + j; /* first knot of this function */
            const double left = j > 0 ? below[j - 1] / (k[degree] - k[0]) : 0;
            const double right = j < degree ? below[j] / (k[degree + 1] - k[1]) : 0;
            value[j] = (t - k[0]) * left + (k[degree + 1] - t) * right;
            slope[j] = (double)degree * (left - right);
        }
    }
}

/* As basis(), with slopes d/dx; gives x(t) and dx/dt. */
static void mapped_basis(const struct spline *s, size_t first, double t, double *value, double *slope,
                         double *x, double *stretch)
{
    basis(s, first, t, value, slope);
    *x = t;
    *stretch = 1;
    if (s->control == NULL) return;
    *x = *stretch = 0;
    for (size_t j = 0; j <= (size_t)s->degree; j++) {
        *x += value[j] * s->control[first + j];
        *stretch += slope[j] * s->control[first + j];
    }
    for (size_t j = 0; j <= (size_t)s->degree; j++)
        slope[j] /= *stretch;
}

/* Control value of a function, and whether it is the mirror image of that control value's own function. */
static size_t fold(const struct spline *s, size_t function, bool *mirrored)
{
    const size_t low = s->folded[0], high = s->folded[1], last = s->functions - 1;
    *mirrored = true;
    if (function < low) return (s->centred[0] ? 2 * low : 2 * low - 1) - function - low;
    if (last - function < high)
        return last - ((s->centred[1] ? 2 * high : 2 * high - 1) - (last - function)) - low;
    *mirrored = false;
    return function - low;
}

/* Factor of a function in the even or odd space. */
static double fold_sign(const struct spline *s, bool odd, size_t index, bool mirrored)
{
    if (!odd) return 1;
    if (s->centred[0] && index == 0) return 0;
    if (s->centred[1] && index == s->count - 1) return 0;
    return mirrored ? -1 : 1;
}

double spline_place(const struct spline *s, size_t first, double parameter)
{
    double value[SPLINE_MAX_LOCAL], slope[SPLINE_MAX_LOCAL], place, stretch;
    mapped_basis(s, first, parameter, value, slope, &place, &stretch);
    return place;
}

/* Parameter of x in an element (Newton; x(t) is monotonic and nearly linear). */
double spline_parameter(const struct spline *s, const struct spline_element *element, double x)
{
    if (s->control == NULL) return x;
    double t = element->from +
               (element->to - element->from) * (x - element->x_from) / (element->x_to - element->x_from);
    for (int i = 0; i < 50; i++) {
        double value[SPLINE_MAX_LOCAL], slope[SPLINE_MAX_LOCAL], here, stretch;
        mapped_basis(s, element->first, t, value, slope, &here, &stretch);
        const double step = (x - here) / stretch;
        t += step;
        if (fabs(step) < 1e-15 * (fabs(t) + 1)) break;
    }
    return t;
}

size_t spline_locate(const struct spline *s, double x)
{
    size_t low = 0, high = s->elements - 1;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (x < s->element[middle].x_to)
            high = middle;
        else
            low = middle + 1;
    }
    return low;
}

void spline_at(const struct spline *s, bool odd, double x, struct spline_point *point)
{
    const struct spline_element *element = &s->element[spline_locate(s, x)];
    const double t = spline_parameter(s, element, x);
    double here, stretch;
    mapped_basis(s, element->first, t, point->value, point->slope, &here, &stretch);
    for (size_t j = 0; j <= (size_t)s->degree; j++) {
        bool mirrored;
        point->index[j] = fold(s, element->first + j, &mirrored);
        const double sign = fold_sign(s, odd, point->index[j], mirrored);
        point->value[j] *= sign;
        point->slope[j] *= sign;
    }
}

/* Adds one Gauss point's products to a matrix. */
static void add_products(const struct spline *s, const struct spline_element *element, const double *test,
                         bool test_odd, const double *trial, bool trial_odd, double weight,
                         struct band *matrix)
{
    const size_t p = (size_t)s->degree;
    for (size_t i = 0; i <= p; i++) {
        bool row_mirrored;
        const size_t row = fold(s, element->first + i, &row_mirrored);
        const double left = test[i] * fold_sign(s, test_odd, row, row_mirrored) * weight;
        for (size_t j = 0; j <= p; j++) {
            bool mirrored;
            const size_t column = fold(s, element->first + j, &mirrored);
            band_add(matrix, row, column, left * trial[j] * fold_sign(s, trial_odd, column, mirrored));
        }
    }
}

struct band *spline_matrix(const struct spline *s, bool test_odd, int test_slope, bool trial_odd,
                           int trial_slope, const double *weight)
{
    const size_t p = (size_t)s->degree;
    struct band *matrix = band_new(s->count, p < s->count ? p : s->count - 1);
    if (matrix == NULL) return NULL;
    for (size_t e = 0; e < s->elements; e++) {
        const struct spline_element *element = &s->element[e];
        for (size_t q = 0; q < s->gauss; q++) {
            const double length = element->to - element->from;
            double value[SPLINE_MAX_LOCAL], slope[SPLINE_MAX_LOCAL], x, stretch;
            mapped_basis(s, element->first, element->from + length * s->gauss_position[q], value, slope, &x,
                         &stretch);
            const double w = s->gauss_weight[q] * length * stretch * (weight != NULL ? weight[e] : 1);
            add_products(s, element, test_slope ? slope : value, test_odd, trial_slope ? slope : value,
                         trial_odd, w, matrix);
        }
    }
    return matrix;
}

void spline_moments(const struct spline *s, bool odd, double from, double to, double *moment)
{
    for (size_t i = 0; i < s->count; i++)
        moment[i] = 0;
    for (size_t e = 0; e < s->elements; e++) {
        const struct spline_element *element = &s->element[e];
        const double x_from = fmax(from, element->x_from), x_to = fmin(to, element->x_to);
        if (!(x_to > x_from)) continue;
        const double t_from = x_from > element->x_from ? spline_parameter(s, element, x_from) : element->from;
        const double t_to = x_to < element->x_to ? spline_parameter(s, element, x_to) : element->to;
        for (size_t q = 0; q < s->gauss; q++) {
            double value[SPLINE_MAX_LOCAL], slope[SPLINE_MAX_LOCAL], x, stretch;
            mapped_basis(s, element->first, t_from + (t_to - t_from) * s->gauss_position[q], value, slope, &x,
                         &stretch);
            const double w = s->gauss_weight[q] * (t_to - t_from) * stretch;
            for (size_t j = 0; j <= (size_t)s->degree; j++) {
                bool mirrored;
                const size_t index = fold(s, element->first + j, &mirrored);
                moment[index] += w * value[j] * fold_sign(s, odd, index, mirrored);
            }
        }
    }
}
