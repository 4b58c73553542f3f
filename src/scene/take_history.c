/* The words of a time function (&load, &boundary): each kind has its own parameters, and takes no others. */
#include "base/memory.h"
#include "scene/build.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

const char *const history_words[] = {"history", "duration",  "frequency", "delay",     "width", "cycles",
                                     "file",    "smoothing", "start",     "amplitude", NULL};

enum { PARAMETERS = 6 };

/* Which parameters a kind takes. */
static const struct {
    const char *kind;
    bool takes[PARAMETERS];
} kinds[] = {
    [HISTORY_TRIANGLE] = {"history 'triangle'", {true, false, false, false, false, false}},
    [HISTORY_STEP] = {"history 'step'", {false, false, false, false, false, false}},
    [HISTORY_RICKER] = {"history 'ricker'", {false, true, true, false, false, false}},
    [HISTORY_GAUSSIAN] = {"history 'gaussian'", {false, false, true, true, false, false}},
    [HISTORY_SINE_BURST] = {"history 'sine-burst'", {false, true, false, false, true, false}},
    [HISTORY_TABLE] = {"history 'table'", {false, false, false, false, false, true}},
    [HISTORY_BRUNE] = {"history 'brune'", {false, false, false, true, false, false}},
    [HISTORY_ERROR_FUNCTION] = {"history 'error-function'", {false, false, true, true, false, false}},
};
static const char *const parameters[PARAMETERS] = {"duration", "frequency", "delay",
                                                   "width",    "cycles",    "file"};

/* Reads the table of a file and puts the place in the deck before what the reader says. */
static bool take_table(struct builder *builder, const struct deck_group *group, struct history *history)
{
    struct messages said = {0};
    char *path = deck_path(builder, deck_text(group, "file", 0));
    if (path == NULL) return false;
    const selas_status status = history_read_table(history, path, &said);
    if (status == SELAS_NO_MEMORY) {
        complain_of_memory(builder);
    } else if (status != SELAS_OK) {
        const char *text = said.text != NULL ? said.text : "";
        if (strncmp(text, "error: ", 7) == 0) text += 7;
        complain(builder, group, "file", "the table cannot be used: %.*s", (int)strcspn(text, "\n"), text);
    }
    messages_free(&said);
    array_free(path);
    return status == SELAS_OK;
}

/* Before its first row a table is 0, after its last one it holds the last value: the plan says so of each. What is
 * hardly meant is a jump after t = 0, and a last value that is small beside the largest but not 0. */
static void warn_of_table(struct builder *builder, const struct deck_group *group,
                          const struct history *history)
{
    static const double small = .1, nothing = 1e-3;
    const size_t last = history->rows - 1;
    const double held = history->table_value[last];
    double largest = 0;
    for (size_t i = 0; i <= last; i++)
        largest = fmax(largest, fabs(history->table_value[i]));
    if (history->table_time[0] > 0 && fabs(history->table_value[0]) > nothing * largest)
        deck_warning(builder->deck, group, "file", builder->messages,
                     "the table begins at t = %.6g with %.6g; before that the history is 0, so that it jumps "
                     "there; a row before it with the value 0 would let it begin smoothly",
                     history->table_time[0], history->table_value[0]);
    if (fabs(held) > nothing * largest && fabs(held) < small * largest &&
        history->table_time[last] < builder->scene->end_time)
        deck_warning(
            builder->deck, group, "file", builder->messages,
            "the table ends at t = %.6g with %.6g, which holds from then on; a last row with the value 0 "
            "would end it",
            history->table_time[last], held);
}

/* Values before t = 0 are cut off: a pulse that begins earlier starts with a jump, of which history_value() gives half
 * at t = 0 itself. */
static void warn_of_jumps(struct builder *builder, const struct deck_group *group,
                          const struct history *history)
{
    if (history->kind == HISTORY_TABLE) warn_of_table(builder, group, history);
    if (history->kind != HISTORY_RICKER && history->kind != HISTORY_GAUSSIAN &&
        history->kind != HISTORY_ERROR_FUNCTION)
        return;
    struct history raw = *history;
    raw.smoothing = raw.start = 0;
    const double start = 2 * fabs(history_value(&raw, 0, 0));
    if (start > 1e-3)
        deck_warning(
            builder->deck, group, "delay", builder->messages,
            "the time function is cut at t = 0, where it is %.3g of its peak; a longer delay would let it "
            "begin smoothly",
            start);
}

bool take_history(struct builder *builder, const struct deck_group *group, const char *purpose,
                  struct history *history)
{
    *history = (struct history){0};
    if (deck_values(group, "history") == 0) {
        complain(builder, group, NULL,
                 "%s needs history, the time function; expected one of" HISTORY_KINDS(CHOICE_QUOTED),
                 purpose);
        return false;
    }
    double *const numbers[PARAMETERS] = {&history->duration, &history->frequency, &history->delay,
                                         &history->width,    &history->cycles,    NULL};
    bool right = true;
    history->kind = (enum history_kind)deck_choice(group, "history", 0);
    for (int i = 0; i < PARAMETERS; i++) {
        if (!kinds[history->kind].takes[i]) {
            const char *const one[] = {parameters[i], NULL};
            if (deck_given(group, parameters[i])) right = false;
            refuse(builder, group, one, kinds[history->kind].kind);
        } else if (deck_values(group, parameters[i]) == 0) {
            complain(builder, group, NULL, "%s needs %s", kinds[history->kind].kind, parameters[i]);
            right = false;
        } else if (numbers[i] != NULL) {
            *numbers[i] = deck_real(group, parameters[i], 0);
        }
    }
    history->smoothing = deck_real(group, "smoothing", 0);
    history->start = deck_real(group, "start", 0);
    if (right && history->kind == HISTORY_TABLE) right = take_table(builder, group, history);
    if (!right) {
        *history = (struct history){0};
        return false;
    }
    warn_of_jumps(builder, group, history);
    history_set_rate(history, builder->scene->end_time);
    history_set_peak(history);
    return true;
}
