/* Comparing histories by receiver and component (`selas diff A B`): norms, shift, misfits in time and
 * frequency, and the tolerance rule |b - a| <= atol * range + rtol * |a|, on the union of the times
 * (diff_pair.c). */
#include "compare/diff.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

const struct tolerance tolerance_default = {1e-6, 1e-6};

/* A component smaller than this part of the receiver's largest one of its kind is rounding: it gets the
 * allowance of one that is just as large. */
static const double rounding = 1e-3;
/* Most values that go into the transforms. */
enum { MOST_VALUES = 4096, CHANNELS = DIFF_CHANNELS };

static double range_of(const struct history_pair *pair, size_t channel)
{
    double low = INFINITY, high = -INFINITY;
    for (size_t i = 0; i < pair->rows; i++) {
        low = fmin(low, pair->a[CHANNELS * i + channel]);
        high = fmax(high, pair->a[CHANNELS * i + channel]);
    }
    return high - low;
}

/* Norms (relative to those of channel `of` in a) and the tolerance rule; all comparisons are written so that
 * NaN differs. */
static void compare_values(const struct history_pair *pair, size_t c, size_t of, double range,
                           const struct tolerance *tolerance, struct channel_difference *result)
{
    double l2 = 0.0, l2_of = 0.0, linf = 0.0, linf_of = 0.0;
    for (size_t i = 0; i < pair->rows; i++) {
        const double a = pair->a[CHANNELS * i + c], away = fabs(pair->b[CHANNELS * i + c] - a);
        const double size = fabs(pair->a[CHANNELS * i + of]);
        const double before = i > 0 ? pair->time[i] - pair->time[i - 1] : 0.0;
        const double after = i + 1 < pair->rows ? pair->time[i + 1] - pair->time[i] : 0.0;
        l2 += 0.5 * (before + after) * away * away; /* trapezoid */
        l2_of += 0.5 * (before + after) * size * size;
        linf = fmax(linf, away);
        linf_of = fmax(linf_of, size);
        const double allowed = tolerance->absolute * range + tolerance->relative * fabs(a);
        if (away <= allowed && !(away > 0.0)) continue;
        const double excess = isfinite(away) && allowed > 0.0 ? away / allowed : INFINITY;
        if (excess > result->excess) {
            result->excess = excess;
            result->when = pair->time[i];
        }
    }
    if (isnan(l2)) linf = NAN; /* fmax() passes over it */
    result->absolute = linf_of == 0.0 && linf != 0.0;
    result->l2 = l2_of > 0.0 ? sqrt(l2 / l2_of) : sqrt(l2);
    result->linf = linf_of > 0.0 ? linf / linf_of : linf;
    result->differs = !(result->excess <= 1.0);
}

static selas_status compare_waves(const struct history_file *a, const struct history_file *b,
                                  const struct history_pair *pair, size_t channel,
                                  struct channel_difference *result, struct messages *messages)
{
    const size_t n = pair->rows < MOST_VALUES ? pair->rows : MOST_VALUES;
    if (n < 4 || !isfinite(result->l2) || result->l2 == 0.0) return SELAS_OK;
    double *series = array_new(2 * n, sizeof *series);
    if (series == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory to compare histories");
    const double begin = pair->time[0];
    const double step = (pair->time[pair->rows - 1] - begin) / (double)(n - 1);
    history_at_even_steps(a, begin, step, n, channel, series);
    history_at_even_steps(b, begin, step, n, channel, series + n);
    selas_status status =
        time_frequency_misfit(n, series, series + n, &result->envelope, &result->phase, messages);
    if (status == SELAS_OK) status = correlation_shift(n, series, series + n, &result->shift, messages);
    result->shift *= step;
    array_free(series);
    return status;
}

selas_status diff_histories(const struct history_file *a, const struct history_file *b,
                            const struct tolerance *tolerance, struct channel_difference difference[CHANNELS],
                            struct messages *messages)
{
    memset(difference, 0, CHANNELS * sizeof *difference);
    struct history_pair pair;
    selas_status status = history_pair_create(&pair, a, b, messages);
    const bool spans = same_span(a, b);
    for (size_t c = 0; c < CHANNELS && status == SELAS_OK; c++) {
        size_t widest = c / 3 * 3; /* of the three components of this kind */
        for (size_t k = widest; k < c / 3 * 3 + 3; k++)
            if (range_of(&pair, k) > range_of(&pair, widest)) widest = k;
        const double range = range_of(&pair, c), least = rounding * range_of(&pair, widest);
        compare_values(&pair, c, range > least ? c : widest, fmax(range, least), tolerance, &difference[c]);
        difference[c].differs = difference[c].differs || !spans;
        if (range > least) status = compare_waves(a, b, &pair, c, &difference[c], messages);
    }
    history_pair_free(&pair);
    return status;
}
