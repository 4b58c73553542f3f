/* Histories for the closed form: v(t) = f'' * (step response), doc/lamb.md Eq 51. For straight lines f'' is a
 * sum of impulses; for others the step response is tabulated once on Gauss nodes between the arrivals of the
 * waves from corners and edges, where it is smooth, graded towards them. */
#include "base/memory.h"
#include "exact/gauss12.h"
#include "exact/lamb_closed.h"

#include <math.h>
#include <stdlib.h>

static int ascending(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

/* Distances from the receiver at which the patch's edge begins, ends or turns. */
static size_t landmarks(const struct patch *patch, double x, double y, double distance[12])
{
    size_t count = 0;
    if (patch->shape == PATCH_DISC) {
        distance[count++] = fabs(hypot(x, y) - patch->half[0]);
        distance[count++] = hypot(x, y) + patch->half[0];
        return count;
    }
    for (int i = -1; i <= 1; i += 2) {
        distance[count++] = fabs(x + i * patch->half[0]);
        distance[count++] = fabs(y + i * patch->half[1]);
        for (int j = -1; j <= 1; j += 2)
            distance[count++] = hypot(x + i * patch->half[0], y + j * patch->half[1]);
    }
    return count;
}

static bool straight(const struct history *history)
{
    return history->smoothing <= 0 && (history->kind == HISTORY_TRIANGLE || history->kind == HISTORY_TABLE);
}

static selas_status by_kinks(const struct lamb_closed *closed, const struct patch *patch, double x, double y,
                             const struct history *history, double t, double velocity[3],
                             struct messages *messages)
{
    double before = 0;
    const size_t kinks = history_kinks(history, NULL, 0);
    double *kink = array_new(kinks, sizeof *kink);
    if (kink == NULL) return fail(messages, SELAS_NO_MEMORY, "not enough memory for a history");
    history_kinks(history, kink, kinks);
    selas_status status = SELAS_OK;
    for (size_t i = 0; i < kinks && kink[i] < t && status == SELAS_OK; i++) {
        const double next = i + 1 < kinks ? .5 * (kink[i] + kink[i + 1]) : kink[i] + 1;
        const double slope = history_value(history, next, 1);
        double step[3];
        status = lamb_closed_step(closed, patch, x, y, t - kink[i], step, messages);
        for (int c = 0; c < 3; c++)
            velocity[c] += (slope - before) * step[c];
        before = slope;
    }
    array_free(kink);
    return status;
}

struct table {
    size_t rows;
    double *time, *weight, *step; /* step: 3 a row */
};

/* Gauss nodes on [from, to], the middle part in panels no longer than `longest`, halved towards both ends. */
static void fill(struct table *table, double from, double to, double longest)
{
    enum { LEVELS = 4 };
    const double length = to - from;
    const int panels = (int)ceil(length / longest) + 1;
    double at = from;
    for (int panel = 0; at < to; panel++) {
        const double width = length / panels, left = at - from, right = to - at;
        double size = fmin(width, right);
        /* next panel: as long as the distance to the nearer end, not less than the smallest */
        const double smallest = width * ldexp(1, -LEVELS);
        size = fmin(size, fmax(left, smallest));
        if (right > smallest * 1.001) size = fmin(size, fmax(.5 * right, smallest));
        if (right - size < .5 * smallest) size = right;
        for (int i = 0; i < 12; i++) {
            if (table->time != NULL) {
                table->time[table->rows] = at + size * (.5 + .5 * gauss12_node[i]);
                table->weight[table->rows] = .5 * size * gauss12_weight[i];
            }
            table->rows++;
        }
        at = right - size <= 0 ? to : at + size;
    }
}

static void table_free(struct table *table)
{
    array_free(table->time);
    array_free(table->weight);
    array_free(table->step);
}

static selas_status make_table(const struct lamb_closed *closed, const struct patch *patch, double x,
                               double y, double end, double longest, struct table *table,
                               struct messages *messages)
{
    double distance[12], arrival[40] = {0};
    const size_t count = landmarks(patch, x, y, distance);
    size_t arrivals = 1;
    const double g = sqrt(creal(closed->root[closed->rayleigh]));
    const double slowness[3] = {sqrt(closed->ratio) / closed->s_speed, 1 / closed->s_speed,
                                g / closed->s_speed};
    for (size_t i = 0; i < count; i++)
        for (int wave = 0; wave < 3; wave++)
            if (distance[i] * slowness[wave] < end) arrival[arrivals++] = distance[i] * slowness[wave];
    qsort(arrival, arrivals, sizeof *arrival, ascending);
    arrival[arrivals++] = end;
    *table = (struct table){0};
    for (int pass = 0; pass < 2; pass++) {
        const size_t rows = table->rows;
        if (pass == 1) {
            *table = (struct table){0, array_new(rows, sizeof(double)), array_new(rows, sizeof(double)),
                                    array_new(3 * rows, sizeof(double))};
            if (table->time == NULL || table->weight == NULL || table->step == NULL) {
                table_free(table);
                return fail(messages, SELAS_NO_MEMORY, "not enough memory for a step response");
            }
        }
        for (size_t i = 0; i + 1 < arrivals; i++)
            if (arrival[i + 1] - arrival[i] > 1e-9 * end) fill(table, arrival[i], arrival[i + 1], longest);
    }
    selas_status status = SELAS_OK;
    for (size_t i = 0; i < table->rows && status == SELAS_OK; i++)
        status = lamb_closed_step(closed, patch, x, y, table->time[i], table->step + 3 * i, messages);
    if (status != SELAS_OK) table_free(table);
    return status;
}

selas_status lamb_closed_velocity(const struct lamb_closed *closed, const struct patch *patch, double x,
                                  double y, const struct history *history, size_t n, const double *time,
                                  double *velocity, struct messages *messages)
{
    for (size_t i = 0; i < 3 * n; i++)
        velocity[i] = 0;
    if (n == 0) return SELAS_OK;
    if (straight(history)) {
        for (size_t i = 0; i < n; i++) {
            const selas_status status =
                by_kinks(closed, patch, x, y, history, time[i], velocity + 3 * i, messages);
            if (status != SELAS_OK) return status;
        }
        return SELAS_OK;
    }
    struct table table;
    const double longest = 2 / history_cutoff(history, 1e-3);
    const selas_status status = make_table(closed, patch, x, y, time[n - 1], longest, &table, messages);
    if (status != SELAS_OK) return status;
    for (size_t i = 0; i < n; i++)
        for (size_t j = 0; j < table.rows && table.time[j] < time[i]; j++) {
            const double factor = table.weight[j] * history_value(history, time[i] - table.time[j], 2);
            for (size_t c = 0; c < 3; c++)
                velocity[3 * i + c] += factor * table.step[3 * j + c];
        }
    table_free(&table);
    return SELAS_OK;
}
