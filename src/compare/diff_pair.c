/* Two histories at the same times: the union of their own within the span that both cover. Between rows
 * displacements follow the cubic Hermite polynomial from u and v, velocities the cubic through slopes of
 * three-point differences. */
#include "compare/diff.h"

#include "base/memory.h"

#include <math.h>
#include <string.h>

enum { CHANNELS = DIFF_CHANNELS };

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

void history_at(const struct history_file *h, double time, size_t *row, double value[CHANNELS])
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

/* Times closer than this are one. */
static double same_time(const struct history_file *a, const struct history_file *b)
{
    return 1e-9 * fmax(fabs(a->time[a->rows - 1]), fabs(b->time[b->rows - 1]));
}

static void fill_union(struct history_pair *pair, const struct history_file *a, const struct history_file *b)
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
        history_at(a, both ? next_a : time, &at_a, pair->a + CHANNELS * n);
        history_at(b, both ? next_b : time, &at_b, pair->b + CHANNELS * n);
    }
}

selas_status history_pair_create(struct history_pair *pair, const struct history_file *a,
                                 const struct history_file *b, struct messages *messages)
{
    const size_t room = a->rows + b->rows;
    *pair = (struct history_pair){0};
    pair->time = array_new(room, sizeof *pair->time);
    pair->a = array_new(room, CHANNELS * sizeof *pair->a);
    pair->b = array_new(room, CHANNELS * sizeof *pair->b);
    if (pair->time == NULL || pair->a == NULL || pair->b == NULL)
        return fail(messages, SELAS_NO_MEMORY, "no memory to compare histories of %zu rows", room);
    fill_union(pair, a, b);
    if (pair->rows > 0) return SELAS_OK;
    return fail(messages, SELAS_BAD_ARGUMENT, "the histories have no time in common");
}

void history_pair_free(struct history_pair *pair)
{
    array_free(pair->time);
    array_free(pair->a);
    array_free(pair->b);
}

bool same_span(const struct history_file *a, const struct history_file *b)
{
    const double close = same_time(a, b);
    return fabs(a->time[0] - b->time[0]) <= close &&
           fabs(a->time[a->rows - 1] - b->time[b->rows - 1]) <= close;
}

void history_at_even_steps(const struct history_file *h, double begin, double step, size_t n, size_t channel,
                           double *series)
{
    size_t row = 0;
    for (size_t i = 0; i < n; i++) {
        double value[CHANNELS];
        history_at(h, begin + (double)i * step, &row, value);
        series[i] = value[channel];
    }
}
