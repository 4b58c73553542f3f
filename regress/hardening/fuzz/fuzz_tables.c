/* Tables of a load's history, and histories of receivers as `selas diff` and &reference file read them. */
#include "fuzz.h"

#include "compare/diff.h"
#include "scene/history.h"

#include <math.h>

static void use(const struct history *history)
{
    double kinks[8] = {0};
    fuzz_require(history->rows > 0, "a table that was read has rows");
    for (size_t i = 1; i < history->rows; i++)
        fuzz_require(history->table_time[i] > history->table_time[i - 1], "times ascend");
    fuzz_require(isfinite(history_value(history, history->table_time[0], 0)), "values are finite");
    (void)history_value(history, 0.5 * history->table_time[history->rows - 1], 1);
    (void)history_value(history, history->table_time[history->rows - 1], -1);
    (void)history_laplace(history, 1.0 + 1.0 * I);
    (void)history_kinks(history, kinks, sizeof kinks / sizeof *kinks);
    (void)history_end(history);
}

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    char path[FUZZ_PATH];
    struct messages messages = {0};
    struct history table = {.kind = HISTORY_TABLE};
    struct history_file history = {0};
    fuzz_file(data, size, path);
    selas_status status = history_read_table(&table, path, &messages);
    fuzz_told(status, &messages);
    if (status == SELAS_OK) use(&table);
    history_free(&table);
    status = history_file_read(path, &history, &messages);
    fuzz_told(status, &messages);
    if (status == SELAS_OK) {
        struct channel_difference difference[DIFF_CHANNELS];
        status = diff_histories(&history, &history, &tolerance_default, difference, &messages);
        fuzz_told(status, &messages);
    }
    history_file_free(&history);
    unlink(path);
    return 0;
}
