/* Histories for the closed form: v(t) = f'' * (step response), doc/theory/lamb.md, after Eq 10. For straight lines f'' is a
 * sum of impulses; for others the step response is tabulated once on Gauss nodes between the arrivals of the
 * waves from corners and edges, where it is smooth, graded towards them. */
#include "base/memory.h"
#include "exact/gauss12.h"
#include "lamb_closed.h"

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

/* Gauss nodes in panels of 12; panel j reaches from edge[2 j] to edge[2 j + 1]. */
struct table {
    size_t rows;
    double *time, *weight, *step; /* step: 3 a row */
    double *edge;
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
        if (table->edge != NULL) {
            table->edge[table->rows / 6] = at;
            table->edge[table->rows / 6 + 1] = right - size <= 0 ? to : at + size;
        }
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
    array_free(table->edge);
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
                                    array_new(3 * rows, sizeof(double)), array_new(rows / 6, sizeof(double))};
            if (table->time == NULL || table->weight == NULL || table->step == NULL || table->edge == NULL) {
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

/* Step response at a time inside the panel that begins with row `first`, by Lagrange's polynomial. */
static void within_panel(const struct table *table, size_t first, double time, double step[3])
{
    step[0] = step[1] = step[2] = 0;
    for (size_t i = first; i < first + 12; i++) {
        double weight = 1;
        for (size_t j = first; j < first + 12; j++)
            if (j != i) weight *= (time - table->time[j]) / (table->time[i] - table->time[j]);
        for (size_t c = 0; c < 3; c++)
            step[c] += weight * table->step[3 * i + c];
    }
}

/* f''(t - tau) times step response over one panel; cut where f'' has a kink. */
static void add_panel(const struct table *table, size_t first, const struct history *history, size_t kinks,
                      const double *kink, double t, double velocity[3])
{
    const double from = table->edge[first / 6], to = table->edge[first / 6 + 1];
    size_t next = kinks; /* kinks ascend, so their places t - kink descend */
    while (next > 0 && t - kink[next - 1] <= from)
        next--;
    if (next == 0) return; /* the history has not begun */
    if (t - kink[next - 1] >= to) {
        for (size_t j = first; j < first + 12; j++) {
            const double factor = table->weight[j] * history_value(history, t - table->time[j], 2);
            for (size_t c = 0; c < 3; c++)
                velocity[c] += factor * table->step[3 * j + c];
        }
        return;
    }
    double at = from;
    while (at < to && next > 0) {
        const double end = fmin(to, t - kink[next - 1]);
        for (int i = 0; i < 12; i++) {
            double step[3];
            const double time = at + (end - at) * (.5 + .5 * gauss12_node[i]);
            const double factor = .5 * (end - at) * gauss12_weight[i] * history_value(history, t - time, 2);
            within_panel(table, first, time, step);
            for (size_t c = 0; c < 3; c++)
                velocity[c] += factor * step[c];
        }
        at = end;
        next--;
    }
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
    const size_t kinks = history_kinks(history, NULL, 0);
    double *kink = array_new(kinks, sizeof *kink);
    if (kink != NULL) history_kinks(history, kink, kinks);
    for (size_t i = 0; kink != NULL && i < n; i++)
        for (size_t first = 0; first < table.rows; first += 12)
            add_panel(&table, first, history, kinks, kink, time[i], velocity + 3 * i);
    table_free(&table);
    if (kink == NULL) return fail(messages, SELAS_NO_MEMORY, "not enough memory for a history");
    array_free(kink);
    return SELAS_OK;
}
