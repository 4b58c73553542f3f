/* What a run leaves on the disk: histories, run.h5, run.xdmf, report, plots. */
#include "base/gnuplot.h"
#include "fake_model.h"
#include "record/parts.h"

#include <hdf5.h>

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>

#include <cmocka.h>

static const size_t cube[3] = {6, 5, 4};
static const struct run_figures figures = {.wall_seconds = 2.0,
                                           .cpu_seconds = 3.0,
                                           .setup_wall_seconds = 0.5,
                                           .setup_cpu_seconds = 0.6,
                                           .exact_cpu_seconds = 0.7,
                                           .threads = 1};

static int reset(void **state)
{
    (void)state;
    fake_gain = 1.0;
    fake_growth = 0.0;
    return 0;
}

static struct fake fake;
static struct recorder *recorder;
static struct messages messages;

/* A run with two receivers and two groups of snapshots, one of them of a region. */
static void begin(void)
{
    fake_build(&fake, 3, cube, 0.5, 0.1, 4.0);
    fake.scene.receivers = 2;
    fake.receiver[0] = (struct receiver){"centre", {0.0, 0.0, 0.0}};
    fake.receiver[1] = (struct receiver){"a/b", {2.5, 2.0, 0.0}};
    fake.scene.snapshots = 2;
    static double times[2] = {1.24, 3.0};
    fake.snapshot[0] =
        (struct snapshot){.every = 2.0,
                          .fields = 1U << SELAS_VELOCITY | 1U << SELAS_STRESS | 1U << SELAS_ENERGY,
                          .whole = true};
    fake.snapshot[1] = (struct snapshot){.times = 2,
                                         .time = times,
                                         .fields = 1U << SELAS_DISPLACEMENT,
                                         .region_low = {0.4, 0.0, 0.0},
                                         .region_high = {1.6, 1.0, 9.0}};
}

static selas_status run(bool open)
{
    selas_status status = recorder_create(&fake.scene, &fake.model, &fake.stepper, &recorder, &messages);
    if (status == SELAS_OK && open) status = recorder_open(recorder, NULL, &messages);
    if (status == SELAS_OK) status = fake_run(&fake, recorder, &messages);
    if (status == SELAS_OK) status = recorder_finish(recorder, &messages);
    return status;
}

static void end(void)
{
    recorder_free(&recorder);
    messages_free(&messages);
    fake_clear(&fake);
}

static char *path_of(const char *name)
{
    static char path[160];
    snprintf(path, sizeof path, "%s/%s", fake.folder, name);
    return path;
}

static bool there(const char *name)
{
    return access(path_of(name), F_OK) == 0;
}

static char *text_of(const char *name)
{
    static char text[60000];
    FILE *file = fopen(path_of(name), "r");
    assert_non_null(file);
    const size_t length = fread(text, 1, sizeof text - 1, file);
    fclose(file);
    text[length] = '\0';
    return text;
}

static void histories_read_back(void **state)
{
    (void)state;
    begin();
    assert_int_equal(run(true), SELAS_OK);
    assert_int_equal(recorder_write(recorder, &fake.exact, &figures, &messages), SELAS_OK);
    assert_null(messages.text);
    const struct history_rows history = recorder_history(recorder, 1);
    for (int k = 0; k < 2; k++) {
        FILE *file = fopen(path_of(k == 0 ? "a_b.dat" : "a_b.exact.dat"), "r");
        assert_non_null(file);
        char text[512];
        size_t rows = 0;
        while (fgets(text, sizeof text, file) != NULL) {
            if (text[0] == '#') continue;
            char *at = text;
            assert_true(strtod(at, &at) == history.time[rows]); /* to the last bit */
            double exact[6];
            const double *expected = history.value + 6 * rows;
            if (k == 1) {
                fake_history(&fake.exact, fake.receiver[1].position, 1, history.time + rows, exact, NULL);
                expected = exact;
            }
            for (int c = 0; c < 6; c++)
                assert_true(strtod(at, &at) == expected[c]);
            rows++;
        }
        fclose(file);
        assert_int_equal(rows, 41);
    }
    assert_non_null(strstr(text_of("centre.dat"), "\n# t ux uy uz vx vy vz\n"));
    end();
}

static double scalar_attribute(hid_t file, const char *object, const char *name)
{
    double value = NAN;
    const hid_t attribute = H5Aopen_by_name(file, object, name, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(attribute >= 0);
    H5Aread(attribute, H5T_NATIVE_DOUBLE, &value);
    H5Aclose(attribute);
    return value;
}

static size_t read_table(hid_t file, const char *name, double *value, hsize_t columns)
{
    const hid_t set = H5Dopen2(file, name, H5P_DEFAULT);
    assert_true(set >= 0);
    const hid_t space = H5Dget_space(set);
    hsize_t size[2] = {0, 0};
    assert_int_equal(H5Sget_simple_extent_dims(space, size, NULL), 2);
    assert_int_equal(size[1], columns);
    assert_true(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, value) >= 0);
    H5Sclose(space);
    H5Dclose(set);
    return size[0];
}

static void snapshots_read_back(void **state)
{
    (void)state;
    begin();
    assert_int_equal(run(true), SELAS_OK);
    assert_false(there("run.h5")); /* not before it is complete */
    assert_int_equal(recorder_write(recorder, NULL, &figures, &messages), SELAS_OK);
    assert_null(messages.text);
    assert_false(there("run.h5.part"));
    const hid_t file = H5Fopen(path_of("run.h5"), H5F_ACC_RDONLY, H5P_DEFAULT);
    assert_true(file >= 0);
    static double value[1000], position[1000];
    /* in the order of time: t = 0, 1.2 (the step nearest to 1.24), 2, 3, 4 */
    static const double time[5] = {0.0, 1.2, 2.0, 3.0, 4.0};
    static const double group[5] = {1.0, 2.0, 1.0, 2.0, 1.0};
    for (int k = 0; k < 5; k++) {
        char name[64];
        snprintf(name, sizeof name, "/snapshots/%04d", k);
        assert_true(fabs(scalar_attribute(file, name, "time") - time[k]) < 1e-12);
        assert_true(scalar_attribute(file, name, "group") == group[k]);
        const bool region = group[k] == 2.0;
        const char *where = region ? "/points/region_2/position" : "/points/position";
        const size_t points = read_table(file, where, position, 3);
        assert_int_equal(points, region ? 3 * 3 * 4 : 6 * 5 * 4); /* x = .5, 1, 1.5; y = 0, .5, 1 */
        snprintf(name, sizeof name, "/snapshots/%04d/%s", k, region ? "displacement" : "velocity");
        assert_int_equal(read_table(file, name, value, 3), points);
        for (size_t i = 0; i < 3 * points; i++) {
            const double truth = fake_truth(position + i / 3 * 3, (int)(i % 3), time[k], region ? 0 : 1);
            assert_true(fabs(value[i] - truth) <= 1e-6 * fabs(truth)); /* single precision */
        }
    }
    assert_true(H5Lexists(file, "/snapshots/0005", H5P_DEFAULT) <= 0);
    assert_int_equal(read_table(file, "/snapshots/0000/stress", value, 6), 120);
    assert_int_equal(read_table(file, "/snapshots/0000/energy", value, 1), 120);
    assert_int_equal(read_table(file, "/histories/centre", value, 7), 41);
    assert_true(value[7 * 40] == recorder_history(recorder, 0).time[40]);
    assert_true(value[7 * 40 + 6] == recorder_history(recorder, 0).value[6 * 40 + 5]);
    assert_true(scalar_attribute(file, "/provenance", "time_step") == 0.1);
    H5Fclose(file);
    end();
}

/* The layout that ParaView is told is that of the data sets. */
static void layout_for_paraview(void **state)
{
    (void)state;
    for (int kind = 0; kind < 3; kind++) { /* along the axes, bent, loose */
        begin();
        if (kind == 1)
            for (size_t i = 0; i < fake.model.points; i++)
                fake.position[3 * i] += 0.1 * fake.position[3 * i + 1];
        if (kind == 2) fake.model.grid[0] = fake.model.grid[1] = fake.model.grid[2] = 0;
        assert_int_equal(run(true), SELAS_OK);
        assert_int_equal(recorder_write(recorder, NULL, &figures, &messages), SELAS_OK);
        const char *text = text_of("run.xdmf");
        static const char *const topology[3] = {"\"3DCoRectMesh\" Dimensions=\"4 5 6\"",
                                                "\"3DSMesh\" Dimensions=\"4 5 6\"",
                                                "\"Polyvertex\" NumberOfElements=\"120\""};
        assert_non_null(strstr(text, topology[kind]));
        assert_non_null(strstr(text, "<Time Value=\"4\"/>"));
        assert_non_null(strstr(text, "run.h5:/snapshots/0004/velocity</DataItem>"));
        assert_non_null(strstr(text, "A wave &amp; its &lt;record&gt;"));
        assert_null(strstr(text, "/snapshots/0001/")); /* that is the other group's */
        text = text_of("run_2.xdmf");
        assert_non_null(strstr(text, "run.h5:/snapshots/0001/displacement</DataItem>"));
        if (kind == 0) /* the region is a lattice too */
            assert_non_null(strstr(text, "\"3DCoRectMesh\" Dimensions=\"4 3 3\""));
        end();
    }
}

static double reported(const char *key)
{
    char line[128];
    snprintf(line, sizeof line, "\n%s", key);
    const char *at = strstr(text_of("report.txt"), line);
    assert_non_null(at);
    return strtod(at + strlen(line), NULL);
}

/* The model computes 1.02 times the truth: every relative error is .02. */
static void errors_in_the_report(void **state)
{
    (void)state;
    begin();
    fake_gain = 1.02;
    assert_int_equal(run(true), SELAS_OK);
    assert_int_equal(recorder_write(recorder, &fake.exact, &figures, &messages), SELAS_OK);
    static const char *const key[] = {"error centre ux: L2 ", "error centre vz: L2 ",
                                      "error centre velocity: L2 ", "error a/b displacement: L2 ",
                                      "error largest: "};
    for (size_t k = 0; k < sizeof key / sizeof *key; k++)
        assert_true(fabs(reported(key[k]) - 0.02) < 1e-6);
    const char *line = strstr(text_of("report.txt"), "error centre vx: ");
    double l2 = 0.0, linf = 0.0; /* vz is three times vx */
    assert_int_equal(sscanf(strstr(line, "of the largest component"),
                            "of the largest component: L2 %lf Linf %lf", &l2, &linf),
                     2);
    assert_true(fabs(l2 - 0.02 / 3.0) < 1e-6 && fabs(linf - 0.02 / 3.0) < 1e-6);
    assert_true(reported("points: ") == 120.0);
    assert_true(fabs(reported("point-steps per second: ") - 120.0 * 41.0 / 2.0) < 1.0);
    end();
}

/* A run that never gets to its end leaves nothing that looks like a result, and an older one stands. */
static void unfinished_run(void **state)
{
    (void)state;
    begin();
    FILE *old = fopen(path_of("run.h5"), "w");
    fputs("older", old);
    fclose(old);
    assert_int_equal(run(true), SELAS_FILE_ERROR); /* is no result of selas ... */
    assert_non_null(strstr(messages.text, "run.h5' is no result of selas"));
    recorder_free(&recorder);
    FILE *list = fopen(path_of(".selas-results"), "w");
    fputs("run.h5\n", list);
    fclose(list);
    assert_int_equal(run(true), SELAS_OK); /* ... but where it is known for one */
    recorder_free(&recorder);
    assert_false(there("run.h5.part"));
    assert_true(there("unfinished/snapshot_0004.h5") && there("unfinished/points.h5"));
    assert_string_equal(text_of("run.h5"), "older");
    end();
}

static void no_folder(void **state)
{
    (void)state;
    begin();
    char in_the_way[128];
    snprintf(in_the_way, sizeof in_the_way, "%s/file/folder", fake.folder);
    FILE *file = fopen(path_of("file"), "w");
    fclose(file);
    fake.scene.output.directory = in_the_way;
    assert_int_equal(run(true), SELAS_FILE_ERROR);
    assert_non_null(strstr(messages.text, in_the_way));
    fake.scene.output.directory = fake.folder;
    end();
}

/* Without run.h5 opened beforehand (a host that wants files only at the end) there are no snapshots. */
static void files_only_at_the_end(void **state)
{
    (void)state;
    begin();
    assert_int_equal(run(false), SELAS_OK);
    assert_int_equal(recorder_write(recorder, NULL, NULL, &messages), SELAS_OK);
    assert_true(there("run.h5") && there("report.txt") && !there("run.xdmf"));
    end();
}

static void exact_alone(void **state)
{
    (void)state;
    begin();
    fake.scene.output.history_step = 0.5;
    assert_int_equal(record_exact(&fake.scene, &fake.exact, &messages), SELAS_OK);
    const char *text = text_of("centre.exact.dat");
    int rows = 0;
    for (const char *at = text; (at = strchr(at, '\n')) != NULL; at++)
        rows += at[1] != '#' && at[1] != '\0';
    assert_int_equal(rows, 9);
    assert_false(there("centre.dat"));
    end();
}

static long png_size(const char *name, int axis)
{
    unsigned char head[24];
    FILE *file = fopen(path_of(name), "rb");
    assert_non_null(file);
    assert_int_equal(fread(head, 1, sizeof head, file), sizeof head);
    fclose(file);
    assert_memory_equal(head, "\x89PNG\r\n\x1a\n", 8);
    const unsigned char *at = head + 16 + 4 * axis;
    return (long)at[0] << 24 | at[1] << 16 | at[2] << 8 | at[3];
}

static void plots(void **state)
{
    (void)state;
    begin();
    fake.scene.output.plots = true;
    assert_int_equal(run(true), SELAS_OK);
    assert_int_equal(recorder_write(recorder, &fake.exact, &figures, &messages), SELAS_OK);
    assert_null(messages.text);
    assert_int_equal(png_size("centre.png", 0), 1200);
    assert_true(png_size("centre.png", 1) > 1200); /* three components, each with its difference */
    assert_int_equal(png_size("snapshot_0000.png", 0), 1280);
    assert_true(there("a_b.png") && there("snapshot_0004.png") && there("surface.gif"));
    assert_false(there("centre.png.part"));
    assert_memory_equal(text_of("surface.gif"), "GIF89a", 6);
    end();
}

static void without_gnuplot(void **state)
{
    (void)state;
    begin();
    fake.scene.output.plots = true;
    char *path = strdup(getenv("PATH"));
    setenv("PATH", "/nowhere", 1);
    const selas_status ran = run(true);
    const selas_status written = recorder_write(recorder, NULL, &figures, &messages);
    setenv("PATH", path, 1);
    free(path);
    assert_int_equal(ran, SELAS_OK);
    assert_int_equal(written, SELAS_OK);
    assert_int_equal(messages.errors, 0);
    assert_non_null(strstr(messages.text, "gnuplot is not installed"));
    assert_false(there("centre.png"));
    end();
}

static void text_setting(hid_t file, const char *group, const char *name, const char *wanted)
{
    char text[200] = "";
    const hid_t setting = H5Aopen_by_name(file, group, name, H5P_DEFAULT, H5P_DEFAULT);
    assert_true(setting >= 0);
    const hid_t type = H5Aget_type(setting);
    assert_true(H5Tget_size(type) <= sizeof text && H5Aread(setting, type, text) >= 0);
    assert_string_equal(text, wanted);
    H5Tclose(type);
    H5Aclose(setting);
}

static void every_setting(void **state)
{
    (void)state;
    static const char text[] =
        "&scene title = 'a / b, c = d ! e', end_time = 2.5 /\n"
        "&material name = 'rock', density = 2, lambda = 1, mu = 1 /\n"
        "&body name = 'b', material = 'rock', low = 0,0,0, high = 1,1,1, spacing = .5 /\n"
        "&load face = 'z-', shape = 'face', direction = 0,0,1, history = 'step' /\n"
        "&load face = 'z-', shape = 'face', direction = 1,0,0, history = 'step' /\n"
        "&snapshot fields = 'velocity', 'stress' /\n";
    struct deck *deck = NULL;
    if (deck_read_text("t.nml", text, sizeof text - 1, 0, NULL, &deck, &messages) != SELAS_OK)
        fail_msg("%s", messages.text);
    begin();
    fake.scene.deck = deck;
    assert_int_equal(run(true), SELAS_OK);
    assert_int_equal(recorder_write(recorder, NULL, &figures, &messages), SELAS_OK);
    const hid_t file = H5Fopen(path_of("run.h5"), H5F_ACC_RDONLY, H5P_DEFAULT);
    assert_true(scalar_attribute(file, "/settings/material_1", "density") == 2.0);
    assert_true(scalar_attribute(file, "/settings/scene_1", "end_time") == 2.5);
    text_setting(file, "/settings/scene_1", "title", "a / b, c = d ! e");
    text_setting(file, "/settings/load_2", "history", "step");
    text_setting(file, "/settings/method_1", "name", "smoothed-point"); /* a default */
    text_setting(file, "/settings/output_1", "plots", ".true.");
    text_setting(file, "/settings/snapshot_1", "fields", "'velocity', 'stress'");
    assert_true(H5Aexists_by_name(file, "/settings/load_2", "face", H5P_DEFAULT) > 0);
    assert_true(H5Aexists_by_name(file, "/provenance", "deck", H5P_DEFAULT) > 0);
    H5Fclose(file);
    assert_true(there("deck.nml"));
    end();
    deck_free(&deck);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test_setup(histories_read_back, reset),
        cmocka_unit_test_setup(snapshots_read_back, reset),
        cmocka_unit_test_setup(layout_for_paraview, reset),
        cmocka_unit_test_setup(errors_in_the_report, reset),
        cmocka_unit_test_setup(unfinished_run, reset),
        cmocka_unit_test_setup(no_folder, reset),
        cmocka_unit_test_setup(files_only_at_the_end, reset),
        cmocka_unit_test_setup(exact_alone, reset),
        cmocka_unit_test_setup(plots, reset),
        cmocka_unit_test_setup(without_gnuplot, reset),
        cmocka_unit_test_setup(every_setting, reset),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
