/* Reads a history back. */
#include "compare/diff.h"

#include "base/lines.h"
#include "base/memory.h"

#include <errno.h>
#include <math.h>
#include <string.h>

enum { COLUMNS = 7 };

static selas_status grow(double **array, size_t used, size_t room, struct messages *messages)
{
    double *grown = array_new(room, sizeof *grown);
    if (grown == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for a history");
    if (used > 0) memcpy(grown, *array, used * sizeof *grown);
    array_free(*array);
    *array = grown;
    return SELAS_OK;
}

/* Numbers of one line; -1 if there is anything else in it. */
static int read_numbers(const char *line, double number[COLUMNS])
{
    int count = 0;
    for (const char *at = line + strspn(line, " \t\r\n"); *at != '\0'; at += strspn(at, " \t\r\n")) {
        char *end = NULL;
        const double value = line_number(at, &end);
        if (end == at || count == COLUMNS) return -1;
        number[count++] = value;
        at = end;
    }
    return count;
}

/* What selas writes about a history (record/histories.c); comments of other programs say nothing. */
static void read_head(const char *line, struct history_file *history)
{
    static const char *const begin[HISTORY_HEADS] = {", position ", "; units: ", "# low-passed: "};
    const bool place = strstr(line, "history at receiver ") != NULL, deck = strncmp(line, "# deck ", 7) == 0;
    for (int k = 0; k < HISTORY_HEADS; k++) {
        const char *at = strstr(line, begin[k]);
        const bool here = k == HISTORY_PLACE ? place : k == HISTORY_UNITS ? deck : at == line;
        if (at != NULL && here)
            snprintf(history->head[k], HEAD_SIZE, "%.*s", HEAD_SIZE - 1, at + strlen(begin[k]));
    }
}

static selas_status read_rows(FILE *file, const char *path, struct history_file *history,
                              struct messages *messages)
{
    char line[LINE_SIZE];
    size_t room = 0;
    enum line_found next = LINE_END;
    for (size_t number = 1; (next = line_next(file, line)) != LINE_END; number++) {
        if (next != LINE_READ)
            return fail(messages, SELAS_FILE_ERROR, "%s:%zu: %s", path, number, line_fault(next));
        double row[COLUMNS];
        if (line[0] == '#') read_head(line, history);
        if (line[strspn(line, " \t\r\n")] == '#') continue;
        const int count = read_numbers(line, row);
        if (count == 0) continue;
        if (count != COLUMNS)
            return fail(messages, SELAS_FILE_ERROR, "%s:%zu: expected 7 numbers: t ux uy uz vx vy vz", path,
                        number);
        if (!isfinite(row[0]) || (history->rows > 0 && !(row[0] > history->time[history->rows - 1])))
            return fail(messages, SELAS_FILE_ERROR, "%s:%zu: the time does not ascend", path, number);
        for (int c = 1; c < COLUMNS; c++)
            if (!isfinite(row[c]))
                return fail(messages, SELAS_FILE_ERROR, "%s:%zu: a value is not finite", path, number);
        if (history->rows == room) {
            room = 2 * room + 256;
            selas_status status = grow(&history->time, history->rows, room, messages);
            if (status == SELAS_OK) status = grow(&history->value, 6 * history->rows, 6 * room, messages);
            if (status != SELAS_OK) return status;
        }
        history->time[history->rows] = row[0];
        memcpy(history->value + 6 * history->rows, row + 1, 6 * sizeof *row);
        history->rows++;
    }
    if (history->rows == 0) return fail(messages, SELAS_FILE_ERROR, "%s: the history has no rows", path);
    return SELAS_OK;
}

selas_status history_file_read(const char *path, struct history_file *history, struct messages *messages)
{
    *history = (struct history_file){0};
    FILE *file = fopen(path, "r");
    if (file == NULL) return fail(messages, SELAS_FILE_ERROR, "cannot read '%s': %s", path, strerror(errno));
    selas_status status = read_rows(file, path, history, messages);
    if (status == SELAS_OK && ferror(file) != 0)
        status = fail(messages, SELAS_FILE_ERROR, "cannot read '%s'", path);
    fclose(file);
    if (status != SELAS_OK) history_file_free(history);
    return status;
}

void history_file_free(struct history_file *history)
{
    array_free(history->time);
    array_free(history->value);
    *history = (struct history_file){0};
}
