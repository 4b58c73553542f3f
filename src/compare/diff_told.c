/* What two histories do not share, and what of their differences is interpolation alone. */
#include "compare/diff.h"

#include "base/lines.h"
#include "base/memory.h"

#include <math.h>
#include <string.h>

/* Part of a difference from which on interpolation is told of. */
static const double good_part = 0.1;

/* (By 1e-9 of the larger coordinates.) */
static bool recorded_elsewhere(const char *place, const char *other_place)
{
    double a[3], b[3], size = 0, apart = 0;
    if (line_numbers(place, 3, a) != 3 || line_numbers(other_place, 3, b) != 3) return false;
    for (int axis = 0; axis < 3; axis++) {
        size = fmax(size, fmax(fabs(a[axis]), fabs(b[axis])));
        apart = fmax(apart, fabs(a[axis] - b[axis]));
    }
    return apart > 1e-9 * size;
}

void tell_heads(const char *receiver, const char *const label[2], const struct history_file *a,
                const struct history_file *b, bool *told, struct messages *messages)
{
    if (recorded_elsewhere(a->head[HISTORY_PLACE], b->head[HISTORY_PLACE]))
        warn(messages, "%s: the receiver stands elsewhere: at %s in %s, at %s in %s", receiver,
             a->head[HISTORY_PLACE], label[0], b->head[HISTORY_PLACE], label[1]);
    const char *units[2] = {a->head[HISTORY_UNITS], b->head[HISTORY_UNITS]};
    if (*told || units[0][0] == '\0' || units[1][0] == '\0') return; /* or another program's */
    const char *low_pass[2] = {a->head[HISTORY_LOW_PASS], b->head[HISTORY_LOW_PASS]};
    const bool other_units = strcmp(units[0], units[1]) != 0,
               other_pass = strcmp(low_pass[0], low_pass[1]) != 0;
    if (other_units)
        warn(messages, "the units have other names: %s in %s, %s in %s; numbers are compared as they are",
             units[0], label[0], units[1], label[1]);
    if (other_pass)
        warn(messages, "the low-pass is another one: %s in %s, %s in %s",
             low_pass[0][0] != '\0' ? low_pass[0] : "none", label[0],
             low_pass[1][0] != '\0' ? low_pass[1] : "none", label[1]);
    *told = other_units || other_pass;
}

/* The finer history on those rows of the other that lie within it. */
static selas_status thin_out(const struct history_file *fine, const struct history_file *coarse,
                             struct history_file *thin, struct messages *messages)
{
    thin->time = array_new(coarse->rows, sizeof *thin->time);
    thin->value = array_new(coarse->rows, DIFF_CHANNELS * sizeof *thin->value);
    if (thin->time == NULL || thin->value == NULL)
        return fail(messages, SELAS_NO_MEMORY, "no memory to compare histories");
    size_t row = 0;
    for (size_t i = 0; i < coarse->rows; i++) {
        if (coarse->time[i] < fine->time[0] || coarse->time[i] > fine->time[fine->rows - 1]) continue;
        thin->time[thin->rows] = coarse->time[i];
        history_at(fine, coarse->time[i], &row, thin->value + DIFF_CHANNELS * thin->rows++);
    }
    return SELAS_OK;
}

static double row_step(const struct history_file *h)
{
    return h->rows > 1 ? (h->time[h->rows - 1] - h->time[0]) / (double)(h->rows - 1) : 0;
}

selas_status tell_interpolation(const char *receiver, const char *const label[2],
                                const struct history_file *a, const struct history_file *b,
                                const struct channel_difference difference[DIFF_CHANNELS],
                                struct messages *messages)
{
    const struct history_file *fine = a->rows > b->rows ? a : b, *coarse = fine == a ? b : a;
    struct history_file thin = {0};
    struct channel_difference alone[DIFF_CHANNELS] = {{0}};
    selas_status status = thin_out(fine, coarse, &thin, messages);
    if (status == SELAS_OK && thin.rows > 0)
        status = diff_histories(fine, &thin, &tolerance_default, alone, messages);
    size_t worst = 0;
    for (size_t c = 0; c < DIFF_CHANNELS; c++) {
        if (!difference[c].differs || alone[c].l2 < good_part * difference[c].l2) alone[c].l2 = 0;
        if (alone[c].l2 > alone[worst].l2) worst = c;
    }
    if (alone[worst].l2 > 0)
        warn(messages,
             "%s: interpolation between rows alone errs by %.2g of %s (L2): they are %.3g apart in %s, %.3g "
             "in %s; output%%history_step gives both the same",
             receiver, alone[worst].l2, diff_channel[worst], row_step(a), label[0], row_step(b), label[1]);
    history_file_free(&thin);
    return status;
}
