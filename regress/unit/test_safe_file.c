/* Files that last: complete or not there, whatever goes wrong on the way. */
#include "base/progress.h"
#include "base/safe_file.h"

#include <signal.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>
#include <unistd.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

static char folder[64], path[128], temporary[128];

static int set_up(void **state)
{
    (void)state;
    snprintf(folder, sizeof folder, "/tmp/selas-safe-XXXXXX");
    if (mkdtemp(folder) == NULL) return 1;
    snprintf(path, sizeof path, "%s/a.txt", folder);
    snprintf(temporary, sizeof temporary, "%s/a.txt.part", folder);
    return 0;
}

static int tear_down(void **state)
{
    (void)state;
    unlink(path);
    unlink(temporary);
    return rmdir(folder);
}

static void write_text(const char *text)
{
    struct messages messages = {0};
    struct safe_file file;
    assert_int_equal(safe_file_open(folder, "a.txt", &file, &messages), SELAS_OK);
    fputs(text, file.file);
    assert_int_equal(safe_file_close(&file, SELAS_OK, &messages), SELAS_OK);
    assert_null(messages.text);
}

static void assert_holds(const char *text)
{
    char read[64] = "";
    FILE *file = fopen(path, "r");
    assert_non_null(file);
    const size_t length = fread(read, 1, sizeof read - 1, file);
    fclose(file);
    read[length] = '\0';
    assert_string_equal(read, text);
    assert_int_not_equal(access(temporary, F_OK), 0);
}

static void old_or_new(void **state)
{
    (void)state;
    write_text("old\n");
    assert_holds("old\n");
    struct messages messages = {0};
    struct safe_file file;
    assert_int_equal(safe_file_open(folder, "a.txt", &file, &messages), SELAS_OK);
    fputs("half of the n", file.file);
    fflush(file.file);
    char read[8] = ""; /* while it is being written the old one stands */
    FILE *old = fopen(path, "r");
    assert_non_null(fgets(read, sizeof read, old));
    fclose(old);
    assert_string_equal(read, "old\n");
    assert_int_equal(safe_file_close(&file, SELAS_NO_MEMORY, &messages), SELAS_NO_MEMORY);
    assert_holds("old\n");
    write_text("new\n");
    assert_holds("new\n");
}

/* A limit on the size of files fails a write as a full disk does. */
static void full_disk(void **state)
{
    (void)state;
    write_text("old\n");
    struct rlimit before;
    assert_int_equal(getrlimit(RLIMIT_FSIZE, &before), 0);
    void (*handler)(int) = signal(SIGXFSZ, SIG_IGN);
    const struct rlimit small = {1000, before.rlim_max};
    assert_int_equal(setrlimit(RLIMIT_FSIZE, &small), 0);
    struct messages messages = {0};
    struct safe_file file;
    const selas_status opened = safe_file_open(folder, "a.txt", &file, &messages);
    for (int i = 0; i < 1000; i++)
        fputs("0123456789", file.file);
    const selas_status closed = safe_file_close(&file, SELAS_OK, &messages);
    setrlimit(RLIMIT_FSIZE, &before);
    signal(SIGXFSZ, handler);
    assert_int_equal(opened, SELAS_OK);
    assert_int_equal(closed, SELAS_FILE_ERROR);
    assert_non_null(strstr(messages.text, "cannot write"));
    assert_non_null(strstr(messages.text, path));
    messages_free(&messages);
    assert_holds("old\n");
}

static void no_folder(void **state)
{
    (void)state;
    struct messages messages = {0};
    struct safe_file file;
    char missing[128];
    snprintf(missing, sizeof missing, "%s/b/c", folder);
    assert_int_equal(safe_file_open(missing, "a.txt", &file, &messages), SELAS_FILE_ERROR);
    assert_non_null(strstr(messages.text, "No such file"));
    messages_free(&messages);
    write_text("old\n");
    assert_int_equal(make_folder(path, &messages), SELAS_FILE_ERROR); /* a file is in the way */
    assert_int_equal(messages.errors, 1);
    messages_free(&messages);
    assert_int_equal(make_folder(missing, &messages), SELAS_OK);
    assert_int_equal(make_folder(missing, &messages), SELAS_OK);
    assert_null(messages.text);
    assert_int_equal(rmdir(missing), 0);
    *strrchr(missing, '/') = '\0';
    assert_int_equal(rmdir(missing), 0);
}

static char shown[4000];
static int calls;

static void show(void *context, const char *text)
{
    (void)context;
    strncat(shown, text, sizeof shown - strlen(shown) - 1);
    calls++;
}

static void progress_on_paper(void **state)
{
    (void)state;
    struct progress progress;
    shown[0] = '\0';
    calls = 0;
    progress_start(&progress, 10.0, false, show, NULL);
    progress.started -= 100.0; /* as if it had taken that long */
    for (unsigned long step = 1; step <= 1000; step++)
        progress_update(&progress, 0.01 * (double)step, step);
    assert_int_equal(calls, 9); /* 10 % ... 90 % */
    assert_non_null(strstr(shown, " 50 %  step 500  t = 5 of 10  1 min 40 s left\n"));
    progress_finish(&progress, 10.0, 1000, true);
    assert_non_null(strstr(shown, "done: 1000 steps to t = 10 in 1 min 40 s\n"));
    assert_null(strchr(shown, '\r'));
}

static void progress_on_a_terminal(void **state)
{
    (void)state;
    struct progress progress;
    shown[0] = '\0';
    calls = 0;
    progress_start(&progress, 10.0, true, show, NULL);
    progress.next_moment = 0.0;
    progress_update(&progress, 5.0, 10);
    progress_update(&progress, 5.1, 11); /* too soon to draw again */
    assert_int_equal(calls, 1);
    assert_non_null(strstr(shown, "[###############...............]  50 %"));
    progress_finish(&progress, 5.1, 11, false);
    assert_non_null(strstr(shown, "stopped: 11 steps to t = 5.1 in "));
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(old_or_new, set_up, tear_down),
        cmocka_unit_test_setup_teardown(full_disk, set_up, tear_down),
        cmocka_unit_test_setup_teardown(no_folder, set_up, tear_down),
        cmocka_unit_test(progress_on_paper),
        cmocka_unit_test(progress_on_a_terminal),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
