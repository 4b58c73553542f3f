/* The time function given as a table: straight lines between rows, zero before the first row, the last value
 * afterwards. */
#include "base/lines.h"
#include "base/memory.h"
#include "scene/history.h"
#include "scene/history_kinds.h"

#include <errno.h>
#include <gsl/gsl_fft_real.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

/* Number of rows with table_time <= t (right) or < t (left). */
static size_t rows_before(const struct history *history, double t, bool right)
{
    size_t low = 0, high = history->rows;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        const double time = history->table_time[middle];
        if (right ? time <= t : time < t)
            low = middle + 1;
        else
            high = middle;
    }
    return low;
}

static double area_between(const struct history *history, size_t row, double t)
{
    const double start = history->table_time[row], from = history->table_value[row];
    if (row + 1 == history->rows) return from * (t - start);
    const double span = history->table_time[row + 1] - start, x = (t - start) / span;
    return (t - start) * (from + .5 * x * (history->table_value[row + 1] - from));
}

double history_table_value(const struct history *history, double t, int derivative, bool right)
{
    const size_t rows = rows_before(history, t, right);
    if (rows == 0 || derivative > 1) return 0;
    const size_t row = rows - 1;
    const double *time = history->table_time, *value = history->table_value;
    if (derivative == -1) {
        double sum = 0;
        for (size_t i = 0; i < row; i++)
            sum += area_between(history, i, time[i + 1]);
        return sum + area_between(history, row, t);
    }
    if (rows == history->rows) return derivative == 0 ? value[row] : 0;
    const double span = time[rows] - time[row];
    if (derivative == 1) return (value[rows] - value[row]) / span;
    const double x = (t - time[row]) / span;
    return (1 - x) * value[row] + x * value[rows];
}

double history_table_kink_after(const struct history *history, double t)
{
    const size_t rows = rows_before(history, t, true);
    return rows < history->rows ? history->table_time[rows] : INFINITY;
}

double complex history_table_laplace(const struct history *history, double complex s)
{
    const double *time = history->table_time, *value = history->table_value;
    double complex sum = 0;
    for (size_t i = 0; i + 1 < history->rows; i++) {
        const double span = time[i + 1] - time[i];
        const double complex x = s * span;
        /* Integrals over 0..1 of exp(-x u) and of u exp(-x u). */
        const double complex even = history_decay_ratio(x);
        const double complex ramp =
            cabs(x) > .1
                ? (even - cexp(-x)) / x
                : 1. / 2 -
                      x * (1. / 3 -
                           x * (1. / 8 -
                                x * (1. / 30 -
                                     x * (1. / 144 - x * (1. / 840 - x * (1. / 5760 -
                                                                          x * (1. / 45360 - x / 403200)))))));
        sum += cexp(-s * time[i]) * span * (value[i] * even + (value[i + 1] - value[i]) * ramp);
    }
    const size_t last = history->rows - 1;
    return sum + value[last] * cexp(-s * time[last]) / s;
}

/* --- Its spectrum ----------------------------------------------------------------------------------------- */

double history_table_top(const struct history *history)
{
    double shortest = INFINITY;
    for (size_t i = 0; i + 1 < history->rows; i++)
        shortest = fmin(shortest, history->table_time[i + 1] - history->table_time[i]);
    return M_PI / shortest;
}

bool history_table_ends(const struct history *history)
{
    static const double nothing = 1e-2;
    double largest = 0;
    for (size_t i = 0; i < history->rows; i++)
        largest = fmax(largest, fabs(history->table_value[i]));
    return history->rows == 0 || fabs(history->table_value[history->rows - 1]) <= nothing * largest;
}

/* Change of the slope at a row, an impulse of f''. */
static double impulse(const struct history *history, size_t row)
{
    const double *time = history->table_time + row, *value = history->table_value + row;
    const double before = row > 0 ? (value[0] - value[-1]) / (time[0] - time[-1]) : 0;
    return (row + 1 < history->rows ? (value[1] - value[0]) / (time[1] - time[0]) : 0) - before;
}

/* The impulses on places `step` apart; one between two places is shared. */
static void lay_impulses(const struct history *history, double step, double *laid)
{
    for (size_t i = 0; i < history->rows; i++) {
        const double place = (history->table_time[i] - history->table_time[0]) / step, below = floor(place);
        laid[(size_t)below] += (1 - (place - below)) * impulse(history, i);
        laid[(size_t)below + 1] += (place - below) * impulse(history, i);
    }
}

/* (i w)^2 F = i w f(t_0) + sum of the impulses times exp(-i w (t - t_0)), by a transform of four times the length,
 * which sees peaks of any width. */
bool history_table_spectrum(const struct history *history, struct table_spectrum *spectrum)
{
    enum { FINER = 4, MOST = 1 << 20 };
    const double length = history->table_time[history->rows - 1] - history->table_time[0];
    const double top = history_table_top(history), step = fmax(M_PI / top, FINER * length / (.5 * MOST));
    size_t n = 16;
    while ((double)n < FINER * (length / step + 2))
        n *= 2;
    double *a = array_new(n, sizeof *a);
    if (a == NULL) return false;
    lay_impulses(history, step, a);
    gsl_fft_real_radix2_transform(a, 1, n);
    *spectrum =
        (struct table_spectrum){.step = 2 * M_PI / ((double)n * step), .count = n / 2, .amplitude = a};
    for (size_t k = 1; k <= n / 2; k++) {
        const double w = (double)k * spectrum->step;
        const double imaginary = (k < n / 2 ? a[n - k] : 0) + w * history->table_value[0];
        a[k] = hypot(a[k], imaginary) / (w * w);
    }
    return true;
}

double history_table_kinks(const struct history *history)
{
    double sum = 0;
    for (size_t i = 0; i < history->rows; i++)
        sum += fabs(impulse(history, i));
    return sum;
}

/* Newton's second divided difference of the rows about one. */
static double bend(const struct history *history, size_t row)
{
    return impulse(history, row) / (history->table_time[row + 1] - history->table_time[row - 1]);
}

double history_table_sag(const struct history *history, double longer, double *step)
{
    enum { FEWEST = 8 };
    const double *time = history->table_time, *value = history->table_value;
    static const double straight = 1e-3, even = 1.1;
    double most = 0, largest = 0;
    *step = 0;
    if (history->kind != HISTORY_TABLE || history->rows < FEWEST) return 0;
    for (size_t i = 0; i < history->rows; i++)
        largest = fmax(largest, fabs(value[i]));
    for (size_t i = 1; i + 2 < history->rows; i++) {
        const double length = time[i + 1] - time[i], before = time[i] - time[i - 1],
                     after = time[i + 2] - time[i + 1], bends[2] = {bend(history, i), bend(history, i + 1)};
        const bool evenly = fmax(length, fmax(before, after)) < even * fmin(length, fmin(before, after));
        const double part = (.5 * (time[i] + time[i + 1]) - time[i - 1]) / (time[i + 2] - time[i - 1]);
        const double sag = length * length / 4 * fabs((1 - part) * bends[0] + part * bends[1]);
        const double less = fmin(fabs(bends[0]), fabs(bends[1])), more = fmax(fabs(bends[0]), fabs(bends[1]));
        if (less <= straight * more || sag > largest || sag <= most) continue;
        if ((evenly ? length : 2 * length) <= longer) continue;
        most = sag;
        *step = length;
    }
    return most > 0 ? most / largest : 0;
}

/* --- Reading it ------------------------------------------------------------------------------------------- */

static selas_status keep_row(struct history *history, size_t *room, double time, double value)
{
    if (history->rows == *room) {
        const size_t more = *room == 0 ? 64 : 2 * *room;
        double *times = array_new(more, sizeof *times), *values = array_new(more, sizeof *values);
        if (times == NULL || values == NULL) {
            array_free(times);
            array_free(values);
            return SELAS_NO_MEMORY;
        }
        if (history->rows > 0) {
            memcpy(times, history->table_time, history->rows * sizeof *times);
            memcpy(values, history->table_value, history->rows * sizeof *values);
        }
        history_free(history);
        history->table_time = times;
        history->table_value = values;
        *room = more;
    }
    history->table_time[history->rows] = time;
    history->table_value[history->rows++] = value;
    return SELAS_OK;
}

static selas_status read_rows(struct history *history, FILE *file, const char *path,
                              struct messages *messages)
{
    char line[LINE_SIZE];
    size_t room = 0;
    enum line_found next = LINE_END;
    for (size_t number = 1; (next = line_next(file, line)) != LINE_END; number++) {
        double row[2] = {0};
        if (next != LINE_READ)
            return fail(messages, SELAS_FILE_ERROR, "%s:%zu: %s", path, number, line_fault(next));
        const int count = line_numbers(line, 2, row);
        if (count == 0) continue;
        const double time = row[0], value = row[1];
        if (count != 2 || !isfinite(time) || !isfinite(value))
            return fail(messages, SELAS_FILE_ERROR, "%s:%zu: expected two numbers, 'time value'", path,
                        number);
        if (time < 0 || (history->rows > 0 && time <= history->table_time[history->rows - 1]))
            return fail(messages, SELAS_FILE_ERROR, "%s:%zu: times must ascend from 0 or later, here is %g",
                        path, number, time);
        if (keep_row(history, &room, time, value) != SELAS_OK)
            return fail(messages, SELAS_NO_MEMORY, "%s: not enough memory for the table", path);
    }
    if (ferror(file)) return fail(messages, SELAS_FILE_ERROR, "%s: %s", path, strerror(errno));
    if (history->rows == 0)
        return fail(messages, SELAS_FILE_ERROR, "%s: no rows 'time value' in the table", path);
    return SELAS_OK;
}

selas_status history_read_table(struct history *history, const char *path, struct messages *messages)
{
    history_free(history);
    history->rows = 0;
    FILE *file = fopen(path, "r");
    if (file == NULL) return fail(messages, SELAS_FILE_ERROR, "%s: %s", path, strerror(errno));
    const selas_status status = read_rows(history, file, path, messages);
    (void)fclose(file);
    if (status != SELAS_OK) {
        history_free(history);
        history->rows = 0;
    }
    return status;
}

void history_free(struct history *history)
{
    array_free(history->table_time);
    array_free(history->table_value);
    history->table_time = NULL;
    history->table_value = NULL;
}
