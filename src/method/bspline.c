/* B-splines on one axis: knots and ends, values, integrals.
 *
 * Values by the recurrence of Cox and de Boor; integrals by Gauss quadrature, exact for polynomials; the
 * rational integrands of mapped ends get enough points for rounding (doc/consistent-method.md, section 2). */
#include "method/bspline.h"

#include "base/gsl_errors.h"
#include "base/memory.h"

#include <gsl/gsl_integration.h>
#include <math.h>

void spline_free(struct spline *spline)
{
    if (spline == NULL) return;
    array_free(spline->knot);
    array_free(spline->control);
    array_free(spline->greville);
    array_free(spline->element);
    array_free(spline->gauss_position);
    array_free(spline->gauss_weight);
    band_free(spline->filter[0]);
    band_free(spline->filter[1]);
    array_free(spline);
}

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

/* Breakpoints on the axis: each piece between interfaces in equal cells. Returns how many; at may be NULL. */
static size_t breakpoints(const struct spline_choice *choice, double *at, bool *is_interface)
{
    size_t count = 0;
    double from = choice->low;
    for (size_t piece = 0; piece <= choice->interfaces; piece++) {
        const double to = piece < choice->interfaces ? choice->interface[piece] : choice->high;
        const double wanted = round((to - from) / choice->spacing);
        const size_t cells = wanted < 1 ? 1 : (size_t)wanted;
        for (size_t i = 0; i < cells; i++, count++)
            if (at != NULL) {
                at[count] = from + (to - from) * (double)i / (double)cells;
                is_interface[count] = i == 0 && piece > 0;
            }
        from = to;
    }
    if (at != NULL) {
        at[count] = choice->high;
        is_interface[count] = false;
    }
    return count + 1;
}

/* Inner knots of open or mirror ends (parameter = x), with the degree's multiplicity at interfaces. */
static double *inner_knots_plain(const struct spline_choice *choice, size_t *count, double domain[2])
{
    const size_t points = breakpoints(choice, NULL, NULL);
    double *at = array_new(points, sizeof *at);
    bool *is_interface = array_new(points, sizeof *is_interface);
    double *inner = array_new(points * SPLINE_MAX_DEGREE, sizeof *inner);
    *count = 0;
    domain[0] = choice->low;
    domain[1] = choice->high;
    if (at != NULL && is_interface != NULL && inner != NULL) {
        breakpoints(choice, at, is_interface);
        for (size_t i = 1; i + 1 < points; i++)
            for (int copy = 0; copy < (is_interface[i] ? choice->degree : 1); copy++)
                inner[(*count)++] = at[i];
    }
    const bool good = at != NULL && is_interface != NULL;
    array_free(at);
    array_free(is_interface);
    if (good) return inner;
    array_free(inner);
    return NULL;
}

/* Inner knots of mapped ends: uniform in a parameter whose unit is a cell; between the ends' control points 0
 * and cells lie cells + 1 control points. */
static double *inner_knots_mapped(const struct spline_choice *choice, size_t cells, size_t *count,
                                  double domain[2])
{
    const double cut = (choice->degree - 1) / 2.0; /* an open end shortens the parameter by this */
    const double start = choice->mirror[0] ? 0 : cut;
    domain[0] = start;
    domain[1] = (double)cells - (choice->mirror[1] ? 0 : cut);
    double *inner = array_new(cells + 1, sizeof *inner);
    *count = 0;
    if (inner == NULL) return NULL;
    for (size_t i = 0; i <= cells; i++) {
        const double at = (double)i + (choice->degree % 2 == 0 ? .5 : 0);
        if (at > domain[0] + .25 && at < domain[1] - .25) inner[(*count)++] = at;
    }
    return inner;
}

/* All knots: copies of the end (open) or reflections (mirror; of the far end's too in a thin body) around the
 * inner ones. */
static bool lay_knots(struct spline *s, const double *inner, size_t inner_count, const double domain[2])
{
    const size_t p = (size_t)s->degree, total = inner_count + 2 * (p + 1);
    const bool between = s->control != NULL && p % 2 == 0; /* a mirror plane lies between two knots */
    s->knot = array_new(total, sizeof *s->knot);
    if (s->knot == NULL) return false;
    s->functions = total - p - 1;
    for (size_t i = 0; i < inner_count; i++)
        s->knot[p + 1 + i] = inner[i];
    for (size_t i = 0; i <= p; i++) { /* i-th knot outwards from either end */
        double low = domain[0], high = domain[1];
        const size_t reflected = between ? i + 1 : i; /* so many knots inside are needed */
        if (s->mirror[0] && reflected > 0)
            low = 2 * domain[0] - (reflected <= inner_count ? inner[reflected - 1] : domain[1]);
        if (s->mirror[1] && reflected > 0)
            high = 2 * domain[1] - (reflected <= inner_count ? inner[inner_count - reflected] : domain[0]);
        s->knot[p - i] = low;
        s->knot[p + 1 + inner_count + i] = high;
    }
    return true;
}

/* Elements between distinct knots inside the domain, cut at interfaces (mapped ends only: else they are
 * knots). */
static bool lay_elements(struct spline *s, const struct spline_choice *choice, const double domain[2])
{
    const size_t p = (size_t)s->degree;
    s->element = array_new(s->functions + choice->interfaces + 1, sizeof *s->element);
    if (s->element == NULL) return false;
    for (size_t k = p; k < s->functions; k++) {
        const double from = fmax(s->knot[k], domain[0]), to = fmin(s->knot[k + 1], domain[1]);
        if (!(to > from)) continue;
        double value[SPLINE_MAX_LOCAL], slope[SPLINE_MAX_LOCAL], stretch;
        struct spline_element element = {.from = from, .to = to, .first = k - p};
        mapped_basis(s, element.first, from, value, slope, &element.x_from, &stretch);
        mapped_basis(s, element.first, to, value, slope, &element.x_to, &stretch);
        s->element[s->elements++] = element;
    }
    s->element[0].x_from = s->low;
    s->element[s->elements - 1].x_to = s->high;
    return true;
}

/* Parameter of x in an element (Newton; x(t) is monotonic and nearly linear). */
static double parameter_at(const struct spline *s, const struct spline_element *element, double x)
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

/* Splits elements at interfaces that are not knots. */
static void cut_elements(struct spline *s, const struct spline_choice *choice)
{
    for (size_t i = 0; i < choice->interfaces; i++) {
        const double x = choice->interface[i];
        const size_t at = spline_locate(s, x);
        const struct spline_element whole = s->element[at];
        const double small = 1e-9 * (whole.x_to - whole.x_from);
        if (x - whole.x_from < small || whole.x_to - x < small) continue;
        const double t = parameter_at(s, &whole, x);
        for (size_t e = s->elements; e > at; e--)
            s->element[e] = s->element[e - 1];
        s->elements++;
        s->element[at].to = s->element[at + 1].from = t;
        s->element[at].x_to = s->element[at + 1].x_from = x;
    }
}

static bool lay_gauss(struct spline *s)
{
    s->gauss = (size_t)s->degree + 1 + (s->control != NULL ? 11 : 0);
    s->gauss_position = array_new(s->gauss, sizeof *s->gauss_position);
    s->gauss_weight = array_new(s->gauss, sizeof *s->gauss_weight);
    gsl_errors_returned();
    gsl_integration_glfixed_table *table = gsl_integration_glfixed_table_alloc(s->gauss);
    gsl_errors_as_before();
    const bool good = table != NULL && s->gauss_position != NULL && s->gauss_weight != NULL;
    if (good)
        for (size_t q = 0; q < s->gauss; q++)
            gsl_integration_glfixed_point(0, 1, q, &s->gauss_position[q], &s->gauss_weight[q], table);
    if (table != NULL) gsl_integration_glfixed_table_free(table);
    return good;
}

/* x of each control value: the geometry's control points, or the Greville points (means of inner knots). */
static bool lay_greville(struct spline *s)
{
    s->greville = array_new(s->count, sizeof *s->greville);
    if (s->greville == NULL) return false;
    for (size_t i = 0; i < s->count; i++) {
        const size_t j = i + s->folded[0];
        double mean = 0;
        for (size_t k = 1; k <= (size_t)s->degree; k++)
            mean += s->knot[j + k] / s->degree;
        s->greville[i] = s->control != NULL ? s->control[j] : mean;
    }
    return true;
}

static bool build(struct spline *s, const struct spline_choice *choice, const double *inner,
                  size_t inner_count, const double domain[2])
{
    const size_t p = (size_t)s->degree;
    for (int end = 0; end < 2; end++) {
        s->folded[end] = s->mirror[end] ? p / 2 : 0;
        s->centred[end] = s->mirror[end] && (p % 2 == 1 || choice->mapped);
    }
    if (choice->mapped) {
        s->control = array_new(inner_count + p + 1, sizeof *s->control);
        if (s->control == NULL) return false;
    }
    if (!lay_knots(s, inner, inner_count, domain)) return false;
    s->count = s->functions - s->folded[0] - s->folded[1];
    const double spacing = (s->high - s->low) / (double)s->cells;
    for (size_t j = 0; choice->mapped && j < s->functions; j++)
        s->control[j] = s->low + spacing * ((double)j - (double)s->folded[0]);
    if (!lay_elements(s, choice, domain)) return false;
    cut_elements(s, choice);
    return lay_gauss(s) && lay_greville(s);
}

struct spline *spline_new(const struct spline_choice *choice, struct messages *messages)
{
    struct spline *s = array_new(1, sizeof *s);
    if (s == NULL) {
        fail(messages, SELAS_NO_MEMORY, "no memory for the B-splines of an axis");
        return NULL;
    }
    s->degree = choice->degree;
    s->low = choice->low;
    s->high = choice->high;
    s->mirror[0] = choice->mirror[0];
    s->mirror[1] = choice->mirror[1];
    const struct spline_choice whole = {.low = choice->low, .high = choice->high, .spacing = choice->spacing};
    s->cells = breakpoints(choice->mapped ? &whole : choice, NULL, NULL) - 1;
    const bool both = choice->mirror[0] && choice->mirror[1], one = choice->mirror[0] || choice->mirror[1];
    const size_t p = (size_t)choice->degree; /* half of a mapped body may be thinner than a whole one */
    const size_t least = both || (choice->mapped && !one) ? 2 * p + 1 : choice->mapped ? p + 1 : 1;
    if (s->cells < least) {
        fail(messages, SELAS_BAD_SCENE,
             "degree %d with %s needs at least %zu spacings along each axis, there are %zu", choice->degree,
             choice->mapped ? "mapped ends" : "symmetry on both sides", least, s->cells);
        spline_free(s);
        return NULL;
    }
    double domain[2];
    size_t inner_count;
    double *inner = choice->mapped ? inner_knots_mapped(choice, s->cells, &inner_count, domain)
                                   : inner_knots_plain(choice, &inner_count, domain);
    const bool good = inner != NULL && build(s, choice, inner, inner_count, domain);
    array_free(inner);
    if (good) return s;
    fail(messages, SELAS_NO_MEMORY, "no memory for the B-splines of an axis");
    spline_free(s);
    return NULL;
}

void spline_at(const struct spline *s, bool odd, double x, struct spline_point *point)
{
    const struct spline_element *element = &s->element[spline_locate(s, x)];
    const double t = parameter_at(s, element, x);
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
        const double t_from = x_from > element->x_from ? parameter_at(s, element, x_from) : element->from;
        const double t_to = x_to < element->x_to ? parameter_at(s, element, x_to) : element->to;
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
