/* Comparing histories by receiver and component (`selas diff A B`).
 *
 * Both are brought onto the union of their times: displacements by the cubic Hermite polynomial from u and v,
 * velocities by the cubic through slopes of three-point differences. */
#include "record/diff.h"

#include "base/memory.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

const struct tolerance tolerance_default = {1e-6, 1e-6};

/* A component smaller than this part of the receiver's largest one of its kind is rounding: it gets the
 * allowance of one that is just as large. */
static const double rounding = 1e-6;
/* Most values that go into the transforms. */
enum { MOST_VALUES = 4096, CHANNELS = 6 };

/* Slope of a channel at a row: of displacements the velocity, of velocities three-point differences. */
static double slope_at(const struct history_file *h, size_t row, size_t channel)
{
    if (channel < 3) return h->value[6 * row + channel + 3];
    const size_t low = row > 0 ? row - 1 : row, high = row + 1 < h->rows ? row + 1 : row;
    if (low == high) return 0.0;
    const double here = h->value[6 * row + channel];
    if (low == row || high == row)
        return (h->value[6 * high + channel] - h->value[6 * low + channel]) / (h->time[high] - h->time[low]);
    const double before = h->time[row] - h->time[low], after = h->time[high] - h->time[row];
    return ((h->value[6 * high + channel] - here) * before / after +
            (here - h->value[6 * low + channel]) * after / before) /
           (before + after);
}

/* Values of all channels at a time within the history; *row is where the last search ended. */
static void values_at(const struct history_file *h, double time, size_t *row, double value[CHANNELS])
{
    while (*row + 1 < h->rows && h->time[*row + 1] <= time)
        (*row)++;
    const size_t low = *row;
    if (time <= h->time[low] || low + 1 == h->rows) {
        memcpy(value, h->value + 6 * low, CHANNELS * sizeof *value);
        return;
    }
    const double step = h->time[low + 1] - h->time[low];
    const double s = (time - h->time[low]) / step, r = 1.0 - s;
    for (size_t c = 0; c < CHANNELS; c++)
        value[c] = r * r * (1.0 + 2.0 * s) * h->value[6 * low + c] +
                   s * s * (1.0 + 2.0 * r) * h->value[6 * (low + 1) + c] +
                   s * r * step * (r * slope_at(h, low, c) - s * slope_at(h, low + 1, c));
}

/* Both histories at the same times, channel by channel. */
struct pair {
    size_t rows;
    double *time, *a, *b; /* [rows], [6 * rows] */
};

static selas_status pair_create(struct pair *pair, size_t room, struct messages *messages)
{
    *pair = (struct pair){0};
    pair->time = array_new(room, sizeof *pair->time);
    pair->a = array_new(room, CHANNELS * sizeof *pair->a);
    pair->b = array_new(room, CHANNELS * sizeof *pair->b);
    if (pair->time != NULL && pair->a != NULL && pair->b != NULL) return SELAS_OK;
    return fail(messages, SELAS_NO_MEMORY, "no memory to compare histories of %zu rows", room);
}

static void pair_free(struct pair *pair)
{
    array_free(pair->time);
    array_free(pair->a);
    array_free(pair->b);
}

/* Times closer than this are one. */
static double same_time(const struct history_file *a, const struct history_file *b)
{
    return 1e-9 * fmax(fabs(a->time[a->rows - 1]), fabs(b->time[b->rows - 1]));
}

static void fill_union(struct pair *pair, const struct history_file *a, const struct history_file *b)
{
    const double close = same_time(a, b);
    const double begin = fmax(a->time[0], b->time[0]) - close;
    const double end = fmin(a->time[a->rows - 1], b->time[b->rows - 1]) + close;
    size_t i = 0, j = 0, at_a = 0, at_b = 0;
    while (i < a->rows || j < b->rows) {
        const double next_a = i < a->rows ? a->time[i] : INFINITY;
        const double next_b = j < b->rows ? b->time[j] : INFINITY;
        const double time = fmin(next_a, next_b);
        const bool both = fabs(next_a - next_b) <= close;
        if (both || next_a < next_b) i++;
        if (both || next_b < next_a) j++;
        if (time < begin || time > end) continue;
        const size_t n = pair->rows++;
        pair->time[n] = time;
        values_at(a, both ? next_a : time, &at_a, pair->a + CHANNELS * n);
        values_at(b, both ? next_b : time, &at_b, pair->b + CHANNELS * n);
    }
}

static double range_of(const struct pair *pair, size_t channel)
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
static void compare_values(const struct pair *pair, size_t c, size_t of, double range,
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
    result->l2 = l2_of > 0.0 ? sqrt(l2 / l2_of) : sqrt(l2);
    result->linf = linf_of > 0.0 ? linf / linf_of : linf;
    result->differs = !(result->excess <= 1.0);
}

/* One channel at equal steps, for the transforms. */
static void even_steps(const struct history_file *h, double begin, double step, size_t n, size_t channel,
                       double *series)
{
    size_t row = 0;
    for (size_t i = 0; i < n; i++) {
        double value[CHANNELS];
        values_at(h, begin + (double)i * step, &row, value);
        series[i] = value[channel];
    }
}

static selas_status compare_waves(const struct history_file *a, const struct history_file *b,
                                  const struct pair *pair, size_t channel, struct channel_difference *result,
                                  struct messages *messages)
{
    const size_t n = pair->rows < MOST_VALUES ? pair->rows : MOST_VALUES;
    if (n < 4 || !isfinite(result->l2) || result->l2 == 0.0) return SELAS_OK;
    double *series = array_new(2 * n, sizeof *series);
    if (series == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory to compare histories");
    const double begin = pair->time[0];
    const double step = (pair->time[pair->rows - 1] - begin) / (double)(n - 1);
    even_steps(a, begin, step, n, channel, series);
    even_steps(b, begin, step, n, channel, series + n);
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
    struct pair pair;
    selas_status status = pair_create(&pair, a->rows + b->rows, messages);
    if (status == SELAS_OK) {
        fill_union(&pair, a, b);
        if (pair.rows == 0)
            status = fail(messages, SELAS_BAD_ARGUMENT, "the histories have no time in common");
    }
    const double close = same_time(a, b);
    const bool spans =
        fabs(a->time[0] - b->time[0]) <= close && fabs(a->time[a->rows - 1] - b->time[b->rows - 1]) <= close;
    for (size_t c = 0; c < CHANNELS && status == SELAS_OK; c++) {
        size_t widest = c / 3 * 3; /* of the three components of this kind */
        for (size_t k = widest; k < c / 3 * 3 + 3; k++)
            if (range_of(&pair, k) > range_of(&pair, widest)) widest = k;
        const double range = range_of(&pair, c), least = rounding * range_of(&pair, widest);
        compare_values(&pair, c, range > least ? c : widest, fmax(range, least), tolerance, &difference[c]);
        difference[c].differs = difference[c].differs || !spans;
        if (range > least) status = compare_waves(a, b, &pair, c, &difference[c], messages);
    }
    pair_free(&pair);
    return status;
}
