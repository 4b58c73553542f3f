/* A host that writes numbers with a comma: every file that a run leaves, and every message, is the one of a
 * host that writes them with a point. */
#include "api_scene.h"

#include <dirent.h>
#include <locale.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[64];

/* A locale of this test's own: not every machine has one with a comma. */
static const char comma[] =
    "LC_NUMERIC\ndecimal_point \",\"\nthousands_sep \".\"\ngrouping 3;3\nEND LC_NUMERIC\n";

static void write_file(const char *name, const char *text)
{
    FILE *file = fopen(name, "w");
    assert_non_null(file);
    fputs(text, file);
    assert_int_equal(fclose(file), 0);
}

static int set_up(void **state)
{
    (void)state;
    snprintf(folder, sizeof folder, "/tmp/selas-locale-XXXXXX");
    if (mkdtemp(folder) == NULL || chdir(folder) != 0) return 1;
    write_file("comma", comma);
    if (system("localedef -c -i ./comma ./xx_XX >said 2>&1") < 0) return 1;
    return setenv("LOCPATH", folder, 1);
}

static int tear_down(void **state)
{
    (void)state;
    char command[128];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return chdir("/") != 0 || system(command) != 0;
}

static void host_writes(const char *wanted)
{
    char text[16];
    snprintf(text, sizeof text, "%.1f", 0.5);
    assert_string_equal(text, wanted);
}

static void with_comma(void)
{
    if (setlocale(LC_ALL, "xx_XX") == NULL)
        fail_msg("localedef (packages libc-bin, locales) has made no locale");
    host_writes("0,5");
}

static void with_point(void)
{
    setlocale(LC_ALL, "C");
    host_writes("0.5");
}

/* --- Files
 * -------------------------------------------------------------------------------------------------------- */

static const char deck[] =
    "&scene title = 'A small half-space', dimension = 3, end_time = 2.5 /\n"
    "&material name = 'rock', density = 1.25, lambda = 1, mu = 1 /\n"
    "&body material = 'rock', shape = 'box', low = 0, 0, 0, high = 4.5, 4.5, 4.5, spacing = 0.75 /\n"
    "&boundary face = 'x-', 'x+', 'y-', 'y+', 'z+', kind = 'transmitting' /\n"
    "&load face = 'z-', shape = 'square', centre = 2.25, 2.25, 0, size = 1.5, 1.5, direction = 0, 0, 1\n"
    "  history = 'table', file = 'push.txt' /\n"
    "&receiver name = 'centre', position = 2.25, 2.25, 0.25 /\n"
    "&profile name = 'depth', from = 2.25, 2.25, 0, to = 2.25, 2.25, 4.5, points = 4, times = 1.25 /\n"
    "&snapshot every = 1.25, fields = 'velocity' /\n"
    "&output directory = 'out', history_step = 0.125 /\n";

struct told {
    char text[20000];
    size_t length;
};

static void note(void *context, const char *key, const char *value)
{
    struct told *told = context;
    if (strstr(key, "seconds") != NULL) return; /* measured: other ones each time */
    const int length =
        snprintf(told->text + told->length, sizeof told->text - told->length, "%s: %s\n", key, value);
    told->length += (size_t)length;
    assert_true(told->length < sizeof told->text);
}

static void run(const char *more, struct told *told)
{
    char text[4000];
    selas_simulation *simulation = NULL;
    *told = (struct told){0};
    snprintf(text, sizeof text, "%s%s", deck, more);
    selas_status status = selas_open_text("test-locale", text, &simulation);
    if (status == SELAS_OK) status = selas_plan(simulation, note, told);
    if (status == SELAS_OK) status = selas_record(simulation);
    if (status == SELAS_OK) status = selas_step(simulation, 2);
    if (status == SELAS_OK) status = selas_save(simulation, "checkpoint.h5");
    if (status == SELAS_OK) status = selas_write(simulation);
    if (status != SELAS_OK) fail_msg("%s", selas_message(simulation));
    note(told, "messages", selas_message(simulation));
    selas_close(&simulation);
}

static char *content(const char *where, const char *name, size_t *size)
{
    char path[512];
    snprintf(path, sizeof path, "%s/%s", where, name);
    FILE *file = fopen(path, "rb");
    assert_non_null(file);
    char *text = calloc(1, 1 << 24);
    assert_non_null(text);
    *size = fread(text, 1, (1 << 24) - 1, file);
    assert_true(*size < (1 << 24) - 1);
    fclose(file);
    return text;
}

/* Lines of the report that tell of this very run go: clocks, memory, date. */
static size_t without_measured(char *text)
{
    static const char *const measured[] = {"seconds", "per second", "memory", "per point", "date: "};
    char *to = text;
    for (char *line = strtok(text, "\n"); line != NULL; line = strtok(NULL, "\n")) {
        bool own = false;
        for (size_t i = 0; i < sizeof measured / sizeof *measured; i++)
            own = own || strstr(line, measured[i]) != NULL;
        const size_t length = strlen(line);
        if (own) {
            const char *value = strchr(line, ':'); /* still a number with a point */
            assert_true(strstr(line, "date: ") == line || strchr(value, ',') == NULL);
        } else {
            memmove(to, line, length);
            to += length;
            *to++ = '\n';
        }
    }
    *to = '\0';
    return (size_t)(to - text);
}

static void same_file(const char *name)
{
    size_t size[2], deck_size;
    char *text[2] = {content("point", name, &size[0]), content("out", name, &size[1])};
    char *echo = content("point", "deck.nml", &deck_size);
    if (strcmp(name, "report.txt") == 0)
        for (int k = 0; k < 2; k++)
            size[k] = without_measured(text[k]);
    if (strcmp(name, "run.h5") == 0) { /* has a date: its one text with numbers is the echo of the deck */
        for (int k = 0; k < 2; k++)
            assert_non_null(memmem(text[k], size[k], echo, deck_size));
    } else if (size[0] != size[1] || memcmp(text[0], text[1], size[0]) != 0) {
        size_t at = 0;
        while (at < size[0] && at < size[1] && text[0][at] == text[1][at])
            at++;
        while (at > 0 && text[0][at - 1] != '\n')
            at--;
        fail_msg("%s is another one beside a host that writes commas: %.160s", name, text[1] + at);
    }
    free(text[0]);
    free(text[1]);
    free(echo);
}

static void every_file(void **state)
{
    (void)state;
    static struct told point, other;
    const char reference[] = "&reference kind = 'file', file = 'first' /\n";
    write_file("push.txt", "# time value\n0 0\n0.25 0.5\n0.5 1.5\n1.25 0\n");
    run("", &point);
    assert_int_equal(rename("out", "first"), 0);
    run(reference, &point);
    assert_int_equal(rename("out", "point"), 0);
    with_comma();
    run(reference, &other);
    host_writes("0,5"); /* the host's own is as it was */
    with_point();
    assert_string_equal(other.text, point.text);
    DIR *made = opendir("out");
    assert_non_null(made);
    unsigned files = 0;
    for (const struct dirent *entry = readdir(made); entry != NULL; entry = readdir(made))
        if (entry->d_name[0] != '.') {
            same_file(entry->d_name);
            files++;
        }
    closedir(made);
    /* deck.nml centre.dat centre.exact.dat depth.dat run.h5 run.xdmf report.txt, plots */
    printf("# %u files\n", files);
    assert_true(files >= 10);
}

/* --- Calls
 * -------------------------------------------------------------------------------------------------------- */

static unsigned asked;

/* A host's function still has the host's locale. */
static int push_softly(void *context, double time, const double position[3], double value[3])
{
    (void)context;
    (void)position;
    char text[16];
    snprintf(text, sizeof text, "%.1f", 0.5);
    asked += strcmp(text, "0,5") == 0;
    value[0] = value[1] = 0;
    value[2] = time * (2 - time);
    return 0;
}

static void calls(void **state)
{
    (void)state;
    const double half = 0.5, wrong[2] = {-2.5, 1};
    with_comma();
    selas_simulation *simulation = open_scene();
    assert_int_equal(selas_set_real(simulation, "body%spacing", 1, &half), SELAS_OK);
    assert_int_equal(selas_set_traction(simulation, "hammer", push_softly, NULL), SELAS_OK);
    assert_true(selas_end_time(simulation) == 2.0);
    asked = 0;
    assert_int_equal(selas_advance(simulation, 1.0), SELAS_OK);
    assert_true(asked > 10);
    selas_close(&simulation);
    simulation = open_scene();
    assert_int_not_equal(selas_set_real(simulation, "body%spacing", 1, wrong) == SELAS_OK
                             ? selas_build(simulation)
                             : SELAS_BAD_DECK,
                         SELAS_OK);
    if (strstr(selas_message(simulation), "-2.5") == NULL) fail_msg("%s", selas_message(simulation));
    selas_close(&simulation);
    host_writes("0,5");
    with_point();
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup_teardown(every_file, set_up, tear_down),
        cmocka_unit_test_setup_teardown(calls, set_up, tear_down),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
