/* B-splines on one axis: knots, ends, elements and points of quadrature (bspline.c: values and integrals;
 * doc/theory/consistent-method.md, section 2). */
#include "method/spline/bspline.h"

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
        s->element[s->elements++] = (struct spline_element){.from = from,
                                                            .to = to,
                                                            .x_from = spline_place(s, k - p, from),
                                                            .x_to = spline_place(s, k - p, to),
                                                            .first = k - p};
    }
    s->element[0].x_from = s->low;
    s->element[s->elements - 1].x_to = s->high;
    return true;
}

/* Splits elements at interfaces that are not knots; marks those that end at one. */
static void cut_elements(struct spline *s, const struct spline_choice *choice)
{
    for (size_t i = 0; i < choice->interfaces; i++) {
        const double x = choice->interface[i];
        const size_t at = spline_locate(s, x);
        const struct spline_element whole = s->element[at];
        const double small = 1e-9 * (whole.x_to - whole.x_from);
        if (x - whole.x_from < small && at > 0) s->element[at - 1].jump = true;
        if (whole.x_to - x < small) s->element[at].jump = true;
        if (x - whole.x_from < small || whole.x_to - x < small) continue;
        const double t = spline_parameter(s, &whole, x);
        for (size_t e = s->elements; e > at; e--)
            s->element[e] = s->element[e - 1];
        s->elements++;
        s->element[at].to = s->element[at + 1].from = t;
        s->element[at].x_to = s->element[at + 1].x_from = x;
        s->element[at].jump = true;
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
