/* Comparing histories: norms, shift, envelope and phase misfit of signals whose misfits are known. */
#include "base/memory.h"
#include "compare/diff.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

static const double pi = 3.14159265358979323846;
static const double f0 = 1.5;

/* A long wave packet, centre 10: amplitude, delay and phase of its carrier can be chosen. Channel vz carries
 * it, uz its half; ux, uy, vx, vy are zero. */
struct signal {
    double gain, delay, phase;
};

static double packet(const struct signal *s, double t, int derivative)
{
    const double x = t - 10.0 - s->delay, w = 2.0 * pi * f0, wide = 2.5;
    const double e = s->gain * exp(-0.5 * x * x / (wide * wide));
    const double angle = w * x + s->phase;
    return derivative == 0 ? e * cos(angle) : -e * (x / (wide * wide) * cos(angle) + w * sin(angle));
}

static struct history_file sample(const struct signal *signal, double step, size_t rows)
{
    struct history_file h = {
        .rows = rows, .time = array_new(rows, sizeof(double)), .value = array_new(6 * rows, sizeof(double))};
    for (size_t i = 0; i < rows; i++) {
        h.time[i] = (double)i * step;
        h.value[6 * i + 2] = packet(signal, h.time[i], 0);
        h.value[6 * i + 5] = packet(signal, h.time[i], 1);
    }
    return h;
}

static const struct signal plain = {1.0, 0.0, 0.0};
static struct channel_difference difference[6];

static void compare(const struct signal *b, double step_b, size_t rows_b, const struct tolerance *tolerance)
{
    struct messages messages = {0};
    struct history_file first = sample(&plain, 0.02, 1001), second = sample(b, step_b, rows_b);
    assert_int_equal(diff_histories(&first, &second, tolerance, difference, &messages), SELAS_OK);
    history_file_free(&first);
    history_file_free(&second);
}

static void same_is_same(void **state)
{
    (void)state;
    compare(&plain, 0.02, 1001, &tolerance_default);
    for (int c = 0; c < 6; c++) {
        assert_false(difference[c].differs);
        assert_true(difference[c].l2 == 0.0 && difference[c].excess == 0.0 && difference[c].shift == 0.0);
    }
}

static void louder(void **state)
{
    (void)state;
    const struct signal loud = {1.2, 0.0, 0.0};
    compare(&loud, 0.02, 1001, &tolerance_default);
    assert_true(difference[2].differs && difference[5].differs && !difference[0].differs);
    for (int c = 2; c < 6; c += 3) {
        assert_true(fabs(difference[c].l2 - 0.2) < 1e-12);
        assert_true(fabs(difference[c].linf - 0.2) < 1e-12);
        assert_true(fabs(difference[c].envelope - 0.2) < 1e-9);
        assert_true(difference[c].phase < 1e-9);
        assert_true(fabs(difference[c].shift) < 1e-9);
    }
}

/* A carrier turned by phi: the wavelet transform turns by phi, its modulus stays. */
static void turned(void **state)
{
    (void)state;
    const struct signal turn = {1.0, 0.0, 0.3};
    compare(&turn, 0.02, 1001, &tolerance_default);
    assert_true(fabs(difference[5].phase - 0.3 / pi) < 1e-3);
    assert_true(difference[5].envelope < 1e-3);
}

static void later(void **state)
{
    (void)state;
    const struct signal late = {1.0, 0.053, 0.0}; /* 2.65 steps */
    compare(&late, 0.02, 1001, &tolerance_default);
    assert_true(fabs(difference[5].shift - 0.053) < 1e-3);
    assert_true(fabs(difference[2].shift - 0.053) < 1e-3);
    assert_true(fabs(difference[5].phase - 2.0 * f0 * 0.053) < 0.02); /* 2 pi f0 delay / pi */
    const struct signal early = {1.0, -0.053, 0.0};
    compare(&early, 0.02, 1001, &tolerance_default);
    assert_true(fabs(difference[5].shift + 0.053) < 1e-3);
}

/* The same signal at other times is the same but for the interpolation, which is of third order at least. */
static void other_times(void **state)
{
    (void)state;
    const struct tolerance loose = {0.0, 2e-4};
    compare(&plain, 0.008, 2501, &loose);
    assert_false(difference[2].differs);
    assert_true(difference[2].l2 < 1e-4 && difference[2].l2 > 0.0);
    assert_true(difference[5].l2 < 2e-3);
    assert_true(difference[2].envelope < 1e-3 && difference[2].phase < 1e-3);
}

static void tolerance_rule(void **state)
{
    (void)state;
    struct messages messages = {0};
    const struct tolerance tolerance = {1e-3, 1e-4};
    struct history_file first = sample(&plain, 0.02, 1001), second = sample(&plain, 0.02, 1001);
    double low = 0.0, high = 0.0;
    for (size_t i = 0; i < first.rows; i++) {
        low = fmin(low, first.value[6 * i + 5]);
        high = fmax(high, first.value[6 * i + 5]);
    }
    double *one = &second.value[6 * 480 + 5];
    const double truth = *one, allowed = 1e-4 * (high - low) + 1e-3 * fabs(truth);
    *one = truth + 0.99 * allowed;
    assert_int_equal(diff_histories(&first, &second, &tolerance, difference, &messages), SELAS_OK);
    assert_false(difference[5].differs);
    assert_true(fabs(difference[5].excess - 0.99) < 1e-6 && difference[5].when == first.time[480]);
    *one = truth - 1.01 * allowed;
    assert_int_equal(diff_histories(&first, &second, &tolerance, difference, &messages), SELAS_OK);
    assert_true(difference[5].differs);
    *one = NAN;
    assert_int_equal(diff_histories(&first, &second, &tolerance, difference, &messages), SELAS_OK);
    assert_true(difference[5].differs && !difference[2].differs);
    assert_true(isnan(difference[5].linf) && difference[2].linf == 0.0);
    *one = truth;
    second.value[6 * 100] = 1e-14; /* rounding in a component that is zero */
    assert_int_equal(diff_histories(&first, &second, &tolerance, difference, &messages), SELAS_OK);
    assert_false(difference[0].differs);
    assert_true(difference[0].linf < 1e-13); /* relative to uz, which is about 1 */
    second.value[6 * 100] = 1e-3;
    assert_int_equal(diff_histories(&first, &second, &tolerance, difference, &messages), SELAS_OK);
    assert_true(difference[0].differs);
    second.value[6 * 100] = 0.0;
    second.rows -= 1; /* a shorter history */
    assert_int_equal(diff_histories(&first, &second, &tolerance, difference, &messages), SELAS_OK);
    assert_true(difference[5].differs);
    history_file_free(&first);
    history_file_free(&second);
}

static char folder[2][32], path[2][128];

static void write_file(const char *to, const char *text)
{
    FILE *file = fopen(to, "w");
    assert_non_null(file);
    fputs(text, file);
    fclose(file);
}

static int make_folders(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        snprintf(folder[k], sizeof folder[k], "/tmp/selas-diff-XXXXXX");
        if (mkdtemp(folder[k]) == NULL) return 1;
        snprintf(path[k], sizeof path[k], "%s/r1.dat", folder[k]);
    }
    return 0;
}

static int remove_folders(void **state)
{
    (void)state;
    for (int k = 0; k < 2; k++) {
        static const char *const name[] = {"r1.dat", "r1.exact.dat", "r2.dat", "line.dat"};
        for (size_t i = 0; i < sizeof name / sizeof *name; i++) {
            char one[128];
            snprintf(one, sizeof one, "%s/%s", folder[k], name[i]);
            unlink(one);
        }
        if (rmdir(folder[k]) != 0) return 1;
    }
    return 0;
}

static const char good[] =
    "# a history\n# t ux uy uz vx vy vz\n0 0 0 0 0 0 0\n0.1 0 0 1 0 0 2\n0.2 0 0 3 0 0 4\n";

static void folders(void **state)
{
    (void)state;
    struct messages messages = {0};
    struct diff_report report = {NULL, NULL, 99};
    char other[128];
    for (int k = 0; k < 2; k++) {
        write_file(path[k], good);
        snprintf(other, sizeof other, "%s/r1.exact.dat", folder[k]);
        write_file(other, k == 0 ? good : "rubbish\n"); /* not compared */
        snprintf(other, sizeof other, "%s/line.dat", folder[k]);
        write_file(other, "# s x y z velocity_x\n0 0 0 0 1\n"); /* nor profiles */
    }
    assert_int_equal(diff_paths(folder[0], folder[1], NULL, &report, &messages), SELAS_OK);
    assert_int_equal(report.differences, 0);
    snprintf(other, sizeof other, "%s/r2.dat", folder[1]);
    write_file(other, good); /* one more there */
    char *table = NULL;
    size_t size = 0;
    report.table = open_memstream(&table, &size);
    assert_int_equal(diff_paths(folder[0], folder[1], NULL, &report, &messages), SELAS_OK);
    fclose(report.table);
    report.table = NULL;
    assert_int_equal(report.differences, 1);
    assert_non_null(strstr(table, "\nr2 "));
    assert_non_null(strstr(table, " is not in /tmp/selas-diff-"));
    free(table);
    unlink(other);
    write_file(path[1], "# t ux uy uz vx vy vz\n0 0 0 0 0 0 0\n0.1 0 0 1 0 0 2\n0.2 0 0 3 0 0 4.1\n");
    assert_int_equal(diff_paths(folder[0], folder[1], NULL, &report, &messages), SELAS_OK);
    assert_int_equal(report.differences, 1);
    assert_int_equal(diff_paths(path[0], path[1], NULL, &report, &messages), SELAS_OK);
    assert_int_equal(report.differences, 1);
    assert_null(messages.text);
    assert_int_equal(diff_paths(path[0], folder[1], NULL, &report, &messages), SELAS_BAD_ARGUMENT);
    messages_free(&messages);
}

/* A plot of each channel that differs, none of others, PNG files that are whole. */
static void plots(void **state)
{
    (void)state;
    struct messages messages = {0};
    char there[64], one[128];
    snprintf(there, sizeof there, "%s/plots", folder[0]);
    write_file(path[0], good);
    write_file(path[1], "# t ux uy uz vx vy vz\n0 0 0 0 0 0 0\n0.1 0 0 1 0 0 2\n0.2 0 0 3 0 1 4.1\n");
    struct diff_report report = {NULL, there, 0};
    assert_int_equal(diff_paths(folder[0], folder[1], NULL, &report, &messages), SELAS_OK);
    assert_int_equal(report.differences, 2);
    assert_null(messages.text);
    static const char *const expected[] = {"r1_vy.png", "r1_vz.png"};
    for (size_t i = 0; i < 2; i++) {
        unsigned char head[8] = {0};
        snprintf(one, sizeof one, "%s/%s", there, expected[i]);
        FILE *file = fopen(one, "rb");
        assert_non_null(file);
        assert_int_equal(fread(head, 1, sizeof head, file), sizeof head);
        assert_memory_equal(head, "\x89PNG\r\n\x1a\n", 8);
        fclose(file);
        unlink(one);
    }
    assert_int_equal(rmdir(there), 0); /* nothing else in it */
}

static void bad_histories(void **state)
{
    (void)state;
    static const struct {
        const char *text, *said;
    } bad[] = {{"", "has no rows"},
               {"# t ux uy uz vx vy vz\n", "has no rows"},
               {"0 0 0 0 0 0\n", ":1: expected 7 numbers"},
               {"0 0 0 0 0 0 0\n1 0 0 0 0 0 0 0\n", ":2: expected 7 numbers"},
               {"0 0 0 0 0 0 zero\n", ":1: expected 7 numbers"},
               {"0 0 0 0 0 0 0\n0 0 0 0 0 0 0\n", ":2: the time does not ascend"},
               {"nan 0 0 0 0 0 0\n", "the time does not ascend"},
               {"0 0 0 0 0 0 0\n1 0 0 nan 0 0 0\n", ":2: a value is not finite"},
               {"0 0 0 0 0 0 -inf\n", ":1: a value is not finite"}};
    for (size_t k = 0; k < sizeof bad / sizeof *bad; k++) {
        struct messages messages = {0};
        struct history_file history;
        write_file(path[0], bad[k].text);
        assert_int_equal(history_file_read(path[0], &history, &messages), SELAS_FILE_ERROR);
        assert_non_null(strstr(messages.text, bad[k].said));
        messages_free(&messages);
    }
    struct messages messages = {0};
    struct history_file history;
    assert_int_equal(history_file_read("/nowhere/r.dat", &history, &messages), SELAS_FILE_ERROR);
    messages_free(&messages);
    write_file(path[0], good);
    assert_int_equal(history_file_read(path[0], &history, &messages), SELAS_OK);
    assert_int_equal(history.rows, 3);
    assert_true(history.value[6 * 2 + 5] == 4.0 && history.time[1] == 0.1);
    history_file_free(&history);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(same_is_same),
        cmocka_unit_test(louder),
        cmocka_unit_test(turned),
        cmocka_unit_test(later),
        cmocka_unit_test(other_times),
        cmocka_unit_test(tolerance_rule),
        cmocka_unit_test_setup_teardown(folders, make_folders, remove_folders),
        cmocka_unit_test_setup_teardown(plots, make_folders, remove_folders),
        cmocka_unit_test_setup_teardown(bad_histories, make_folders, remove_folders),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
