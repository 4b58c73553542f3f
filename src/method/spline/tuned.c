/* Tuned splines (doc/theory/consistent-splines.md, section 14): with t = (2 sin(theta / 2))^2, theta = k dx,
 *
 *   M' = dx [M + sum over q of m_q B_q^T B_q],
 *   S' = [S + sum of s_q B_q^T B_q] / dx,                                                               (U1)
 *   G' = G + sum of g_q B_q^T A B_q,
 *   F  = 1 + sum of f_q B_q^T B_q,                                                                      (U2)
 *
 * B_q the q-th differences of evenly spaced control values (symbol of B_q^T B_q: t^q), A half the difference
 * of the next row and the last one (symbol i sin(theta)). The numbers are those of regress/studies/tuned-splines.
 * Towards ends that are no symmetry planes all of them fade out, and a little stiffness is added where they
 * do (U6). */
#include "method/spline/tuned.h"

#include "base/memory.h"
#include "method/spline/images.h"

#include <math.h>
#include <string.h>

enum { MOST_ORDER = 9, JOINT_ORDER = 3, START = 4, RAMP = 6, PAD = 4 };
static const double JOINT = 1e-3;

static const struct tuning {
    double mass[MOST_ORDER], stiffness[MOST_ORDER], slope[MOST_ORDER], filter[MOST_ORDER];
} tuning = {
    .mass = {[3] = -0.0036011922461610269, [4] = 0.0010425936878135514, [5] = -5.2659444487194872e-05},
    .stiffness = {[4] = -0.0036086829889305423, [5] = 0.00073417880251125367},
    .slope = {[3] = -0.003620254991744305, [4] = 0.00045530997735942276},
    .filter = {[3] = 0.009000025268562601,
               [4] = -0.032078970040699518,
               [5] = 0.03454595495582452,
               [6] = -0.017582048457027835,
               [7] = 0.0042341929650000698,
               [8] = -0.00039185200278539148},
};

static double spacing(const struct spline *spline)
{
    return (spline->high - spline->low) / (double)spline->cells;
}

/* Distance of a place (index of a control value, or halfway) from the nearer end that is no symmetry plane,
 * beyond START: the widest differences about places further in do not touch the functions that the end cuts
 * short. */
static double distance(const struct spline *spline, double place)
{
    const double skipped = spline->degree - 1 + START, last = (double)spline->count - 1;
    double nearest = INFINITY;
    if (!spline->mirror[0]) nearest = fmin(nearest, place - skipped);
    if (!spline->mirror[1]) nearest = fmin(nearest, last - skipped - place);
    return nearest;
}

/* From 0 to 1 over RAMP cells. */
static double ramp(double cells)
{
    const double s = fmin(1, fmax(0, cells / RAMP));
    return s * s * s * (10 - 15 * s + 6 * s * s);
}

/* Part of a row about a place that lies on this side of the symmetry planes: the integral over the axis is
 * half of that over the axis and its images. */
static double share(const struct spline *spline, double place)
{
    const double low = spline->centred[0] ? 0 : -.5;
    const double high = (double)spline->count - (spline->centred[1] ? 1 : .5);
    double part = 1;
    if (spline->mirror[0]) part *= place < low - .1 ? 0 : place < low + .1 ? .5 : 1;
    if (spline->mirror[1]) part *= place > high + .1 ? 0 : place > high - .1 ? .5 : 1;
    return part;
}

static void add_outer(const struct difference *test, const struct difference *trial, double factor,
                      struct band *band)
{
    for (int i = 0; i <= test->order; i++)
        for (int j = 0; j <= trial->order; j++) {
            const double value = factor * test->factor[i] * trial->factor[j];
            if (value != 0) band_add(band, test->index[i], trial->index[j], value);
        }
}

enum form { SQUARES, SQUARES_AT_JOINTS, TURNED };

/* Adds factor * B_q^T B_q, everywhere or only where the changes fade out, or factor * B_q^T A B_q. */
static void add_form(const struct spline *spline, bool test_odd, bool trial_odd, int order, enum form form,
                     double factor, struct band *band)
{
    const ptrdiff_t count = (ptrdiff_t)spline->count;
    for (ptrdiff_t first = -order - 1; first < count; first++) {
        struct difference test, trial, next_test, next_trial;
        const double place = (double)first + order / 2. + (form == TURNED ? .5 : 0);
        const double cells = distance(spline, place);
        const double here = form == SQUARES_AT_JOINTS ? cells > 0 && cells <= RAMP + PAD : ramp(cells);
        const double part = factor * here * share(spline, place);
        if (part == 0 || !spline_difference(spline, test_odd, first, order, &test) ||
            !spline_difference(spline, trial_odd, first, order, &trial))
            continue;
        if (form != TURNED) {
            add_outer(&test, &trial, part, band);
            continue;
        }
        if (!spline_difference(spline, test_odd, first + 1, order, &next_test) ||
            !spline_difference(spline, trial_odd, first + 1, order, &next_trial))
            continue;
        add_outer(&test, &next_trial, part / 2, band);
        add_outer(&next_test, &trial, -part / 2, band);
    }
}

struct band *tuned_matrix(const struct spline *spline, bool test_odd, int test_slope, bool trial_odd,
                          int trial_slope, const double *weight)
{
    struct band *exact = spline_matrix(spline, test_odd, test_slope, trial_odd, trial_slope, weight);
    if (spline->filter[0] == NULL || exact == NULL) return exact;
    const size_t half = TUNED_REACH < spline->count ? TUNED_REACH : spline->count - 1;
    struct band *change = band_new(spline->count, half), *sum = NULL;
    const bool turn = test_slope != trial_slope;
    const double *factor = turn ? tuning.slope : test_slope ? tuning.stiffness : tuning.mass;
    const double unit = turn ? (trial_slope ? 1 : -1) : test_slope ? 1 / spacing(spline) : spacing(spline);
    for (int order = 1; change != NULL && order < MOST_ORDER; order++)
        if (factor[order] != 0)
            add_form(spline, test_odd, trial_odd, order, turn ? TURNED : SQUARES, unit * factor[order],
                     change);
    if (change != NULL && test_slope && trial_slope)
        add_form(spline, test_odd, trial_odd, JOINT_ORDER, SQUARES_AT_JOINTS, unit * JOINT, change);
    if (change != NULL) sum = band_sum(exact, 1, change);
    band_free(exact);
    band_free(change);
    return sum;
}

bool spline_tune(struct spline *spline)
{
    const double last = (double)spline->count - 1;
    const double innermost = spline->mirror[0] ? 0 : spline->mirror[1] ? last : last / 2;
    if (distance(spline, innermost) < RAMP + PAD) return true;
    const size_t half = FILTER_REACH < spline->count ? FILTER_REACH : spline->count - 1;
    for (int odd = 0; odd < 2; odd++) {
        struct band *filter = spline->filter[odd] = band_new(spline->count, half);
        if (filter == NULL) return false;
        for (size_t row = 0; row < spline->count; row++)
            band_add(filter, row, row, 1);
        for (int order = 1; order < MOST_ORDER; order++)
            if (tuning.filter[order] != 0)
                add_form(spline, odd, odd, order, SQUARES, tuning.filter[order], filter);
    }
    return true;
}

void tuned_filter(const struct spline *spline, bool odd, const struct tuned_point *plain,
                  struct tuned_point *point)
{
    const struct band *filter = spline->filter[odd];
    size_t first = plain->index[0], last = first;
    for (size_t j = 1; j < plain->count; j++) {
        first = plain->index[j] < first ? plain->index[j] : first;
        last = plain->index[j] > last ? plain->index[j] : last;
    }
    const size_t reach = filter != NULL ? FILTER_REACH : 0;
    first = first < reach ? 0 : first - reach;
    last = last + reach < spline->count ? last + reach : spline->count - 1;
    *point = (struct tuned_point){.count = last - first + 1};
    for (size_t i = 0; i < point->count; i++)
        point->index[i] = first + i;
    for (size_t j = 0; j < plain->count; j++)
        for (size_t i = 0; i < point->count; i++) {
            const double factor =
                filter != NULL ? band_get(filter, plain->index[j], first + i) : first + i == plain->index[j];
            point->value[i] += factor * plain->value[j];
            point->slope[i] += factor * plain->slope[j];
        }
}

static void plain_at(const struct spline *spline, bool odd, double x, struct tuned_point *plain)
{
    struct spline_point at;
    *plain = (struct tuned_point){.count = (size_t)spline->degree + 1};
    spline_at(spline, odd, x, &at);
    for (size_t j = 0; j < plain->count; j++) {
        plain->index[j] = at.index[j];
        plain->value[j] = at.value[j];
        plain->slope[j] = at.slope[j];
    }
}

void tuned_at(const struct spline *spline, bool odd, double x, struct tuned_point *point)
{
    struct tuned_point plain;
    plain_at(spline, odd, x, &plain);
    tuned_filter(spline, odd, &plain, point);
}

static double middle_of(const struct spline_element *element)
{
    return (element->x_from + element->x_to) / 2;
}

/* Is there a cell, or (`image`) the image of this one, beyond the lower or upper end of a cell on even ground? */
static bool goes_on(const struct spline *spline, size_t here, bool upper, bool *image)
{
    const bool end = upper ? here + 1 == spline->elements : here == 0;
    *image = end && spline->mirror[upper];
    return *image || (!end && !spline->element[upper ? here : here - 1].jump);
}

void tuned_seen(const struct spline *spline, bool odd, double x, struct tuned_point *point)
{
    const size_t here = spline_locate(spline, x);
    const double middle = middle_of(&spline->element[here]);
    struct tuned_point plain, beside;
    plain_at(spline, odd, x, &plain);
    bool upper = x > middle, image = false, more = spline->degree == 1;
    if (more && !goes_on(spline, here, upper, &image)) {
        upper = !upper;
        more = goes_on(spline, here, upper, &image);
    }
    if (more) {
        const size_t other = image ? here : upper ? here + 1 : here - 1;
        const double plane = upper ? spline->high : spline->low;
        const double there = image ? 2 * plane - middle : middle_of(&spline->element[other]);
        const double part = (x - middle) / (there - middle), sign = image && !odd ? -1 : 1;
        plain_at(spline, odd, middle_of(&spline->element[other]), &beside);
        for (size_t j = 0; j < 2; j++) {
            plain.index[2 + j] = beside.index[j];
            plain.slope[2 + j] = sign * part * beside.slope[j];
            plain.slope[j] *= 1 - part;
        }
        plain.count = 4;
    }
    tuned_filter(spline, odd, &plain, point);
}

void tuned_moments(const struct spline *spline, bool odd, double from, double to, double *work,
                   double *moment)
{
    const struct band *filter = spline->filter[odd];
    spline_moments(spline, odd, from, to, moment);
    if (filter == NULL) return;
    memcpy(work, moment, spline->count * sizeof *work);
    memset(moment, 0, spline->count * sizeof *moment);
    for (size_t i = 0; i < spline->count; i++) {
        const size_t low = i < filter->half ? 0 : i - filter->half;
        for (size_t j = low; work[i] != 0 && j <= i + filter->half && j < spline->count; j++)
            moment[j] += band_get(filter, i, j) * work[i];
    }
}
