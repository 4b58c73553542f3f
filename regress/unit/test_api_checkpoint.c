/* Checkpoints through the library's door: what goes on from one is bit for bit what would have come without
 * a stop, by every method and scheme and with a host that drives loads. */
#include "api_scene.h"

#include <hdf5.h>
#include <omp.h>
#include <stdlib.h>
#include <unistd.h>

enum host { DECK, CALLBACK, HELD, MOTION };

/* The body of every scene here; methods, dimensions and hosts differ. */
struct tested {
    const char *what, *method, *scheme;
    int dimension;
    enum host host;
};

static int shake(void *context, double time, const double position[3], double value[3])
{
    (void)context;
    (void)position;
    value[0] = 0.01 * time * time;
    value[1] = value[2] = 0;
    return 0;
}

static int press(void *context, double time, const double position[3], double value[3])
{
    (void)context;
    value[0] = value[2] = 0;
    value[1] = 0.01 * time * (2 - time) * position[0];
    return 0;
}

static selas_simulation *open_tested(const struct tested *tested)
{
    static const char fixed[] = "fixed'",
                      moving_in_the_plane[] =
                          "displacement', direction = 1, 0, history = 'triangle', duration = 1",
                      moving_in_space[] =
                          "displacement', direction = 1, 0, 0, history = 'triangle', duration = 1";
    char deck[2000];
    const bool space = tested->dimension == 3;
    snprintf(deck, sizeof deck,
             "&scene dimension = %d, end_time = 2.0 /\n&method %s /\n&stepping scheme = '%s' /\n"
             "&material name = 'rock', density = 1, lambda = 1, mu = 1 /\n"
             "&body material = 'rock', shape = 'box', low = 0, 0%s, high = 4, 4%s, spacing = 0.5 /\n"
             "&boundary face = 'x-', kind = '%s /\n"
             "&load name = 'hammer', face = 'y-', shape = 'square', centre = 2, 0%s, size = 2%s, direction "
             "= 0, 1%s\n  amplitude = 0.01, history = 'triangle', duration = 1 /\n"
             "&receiver name = 'r', position = 2, 0%s /\n"
             "&profile name = 'line', from = 2, 0%s, to = 2, 4%s, points = 5, times = 0.2, 1.8, fields = "
             "'displacement' /\n",
             tested->dimension, tested->method, tested->scheme, space ? ", 0" : "", space ? ", 3" : "",
             tested->host != MOTION ? fixed
             : space                ? moving_in_space
                                    : moving_in_the_plane,
             space ? ", 1.5" : "", space ? ", 2" : "", space ? ", 0" : "", space ? ", 1.5" : "",
             space ? ", 1.5" : "", space ? ", 1.5" : "");
    selas_simulation *simulation = NULL;
    if (selas_open_text("checkpoint", deck, &simulation) != SELAS_OK)
        fail_msg("%s: %s", tested->what, selas_message(simulation));
    return simulation;
}

/* Steps until `steps` are done, the host doing its part. */
static void run_to(selas_simulation *simulation, const struct tested *tested, unsigned long steps)
{
    while (selas_steps(simulation) < steps) {
        const double time = selas_time(simulation);
        if (tested->host == HELD)
            assert_int_equal(selas_set_load(simulation, "hammer", 0.01 * time * (2 - time)), SELAS_OK);
        if (selas_step(simulation, 1) != SELAS_OK)
            fail_msg("%s: %s", tested->what, selas_message(simulation));
    }
}

static void drive(selas_simulation *simulation, const struct tested *tested)
{
    if (tested->host == CALLBACK)
        assert_int_equal(selas_set_traction(simulation, "hammer", press, NULL), SELAS_OK);
    if (tested->host == MOTION) assert_int_equal(selas_set_motion(simulation, "x-", shake, NULL), SELAS_OK);
    if (tested->host == HELD) assert_int_equal(selas_set_load(simulation, "hammer", 0), SELAS_OK);
}

/* The same numbers to the last bit at the receiver and in the whole field. */
static void compare(selas_simulation *whole, selas_simulation *second, const char *what)
{
    const double *time = NULL, *value = NULL, *other = NULL;
    size_t rows = 0, other_rows = 0, points = 0, components = 0;
    double field[3 * 1000];
    assert_int_equal(selas_field_values(whole, SELAS_VELOCITY, &points, &components, &value), SELAS_OK);
    assert_true(points * components <= 3000);
    memcpy(field, value, points * components * sizeof *value);
    assert_int_equal(selas_field_values(second, SELAS_VELOCITY, &points, &components, &value), SELAS_OK);
    if (memcmp(field, value, points * components * sizeof *value) != 0) fail_msg("%s: the field", what);
    assert_int_equal(selas_history(whole, "r", &rows, &time, &value), SELAS_OK);
    assert_int_equal(selas_history(second, "r", &other_rows, &time, &other), SELAS_OK);
    assert_true(rows == other_rows && rows > 4);
    if (memcmp(value, other, 6 * rows * sizeof *value) != 0) fail_msg("%s: the histories", what);
    double largest = 0;
    for (size_t i = 0; i < 6 * rows; i++)
        largest = fmax(largest, fabs(value[i]));
    if (!(largest > 1e-4)) fail_msg("%s: nothing moved", what);
}

static void hear(void *context, const char *key, const char *value)
{
    bool *timed = context;
    *timed = *timed || (strcmp(key, "estimated stepping seconds") == 0 && strtod(value, NULL) > 0);
}

/* Energies and works so far, as a checkpoint keeps them. */
static void read_watch(selas_simulation *simulation, const char *path, double watch[26])
{
    assert_int_equal(selas_save(simulation, path), SELAS_OK);
    const hid_t file = H5Fopen(path, H5F_ACC_RDONLY, H5P_DEFAULT), set = H5Dopen2(file, "watch", H5P_DEFAULT);
    assert_int_equal(H5Dget_storage_size(set), 26 * sizeof *watch);
    assert_true(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, watch) >= 0);
    H5Dclose(set);
    H5Fclose(file);
}

/* Saved half way and gone on in another simulation: the same bits as without a stop. */
static void go_on(const struct tested *tested)
{
    char path[] = "/tmp/selas-checkpoint-XXXXXX";
    const int file = mkstemp(path);
    assert_true(file >= 0);
    close(file);
    selas_simulation *all[3];
    for (int k = 0; k < 3; k++) {
        all[k] = open_tested(tested);
        drive(all[k], tested);
    }
    const unsigned long steps = selas_steps_needed(all[0]), half = steps / 2;
    if (half < 3) fail_msg("%s: %lu steps; %s", tested->what, steps, selas_message(all[0]));
    bool timed = false; /* the steps that a plan times leave nothing behind */
    assert_int_equal(selas_plan(all[1], hear, &timed), SELAS_OK);
    assert_true(timed);
    run_to(all[0], tested, steps);
    run_to(all[1], tested, half);
    assert_int_equal(selas_save(all[1], path), SELAS_OK);
    assert_int_equal(selas_restore(all[2], path), SELAS_OK);
    assert_true(selas_steps(all[2]) == half && selas_time(all[2]) == selas_time(all[1]));
    run_to(all[2], tested, steps);
    for (int k = 0; k < 3; k += 2)
        assert_int_equal(selas_finish(all[k]), SELAS_OK);
    compare(all[0], all[2], tested->what);
    double watch[2][26]; /* finished histories leave the state as it is */
    read_watch(all[0], path, watch[0]);
    read_watch(all[2], path, watch[1]);
    if (memcmp(watch[0], watch[1], sizeof watch[0]) != 0) fail_msg("%s: energies and works", tested->what);
    for (int k = 0; k < 3; k++)
        selas_close(&all[k]);
    remove(path);
}

#define PLAIN "degree = 2"
#define PAPER "variant = 'paper'"
#define TOTAL "name = 'sph', variant = 'total-lagrangian', gradient = 'linear'"
#define QUADRATIC "name = 'sph', variant = 'total-lagrangian', gradient = 'quadratic'"
#define UPDATED "name = 'sph', variant = 'updated-lagrangian'"

static void test_smoothed_point(void **state)
{
    (void)state;
    static const struct tested all[] = {
        {"consistent, leapfrog", PLAIN, "leapfrog", 3, DECK},
        {"consistent, modified equation", PLAIN, "modified-equation", 3, DECK},
        {"consistent, rk4", PLAIN, "rk4", 2, DECK},
        {"consistent, lsrk54", PLAIN, "lsrk54", 2, DECK},
        {"paper, leapfrog", PAPER, "leapfrog", 3, DECK},
        {"paper, modified equation", PAPER, "modified-equation", 2, DECK},
        {"paper, rk4", PAPER ", filter = 0", "rk4", 2, DECK},
    };
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
        go_on(&all[i]);
}

static void test_particles(void **state)
{
    (void)state;
    static const struct tested all[] = {
        {"total Lagrangian, leapfrog", TOTAL, "leapfrog", 3, DECK},
        {"total Lagrangian, rk4", QUADRATIC, "rk4", 2, DECK},
        {"updated Lagrangian, rkc", UPDATED, "rkc", 2, DECK},
        {"updated Lagrangian, rk4", UPDATED, "rk4", 2, DECK},
        {"updated Lagrangian, pc2", UPDATED, "pc2", 3, DECK},
        {"updated Lagrangian, euler", UPDATED, "euler", 2, DECK},
    };
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
        go_on(&all[i]);
}

static void test_driven(void **state)
{
    (void)state;
    static const struct tested all[] = {
        {"traction, consistent", PLAIN, "leapfrog", 3, CALLBACK},
        {"traction, modified equation", PLAIN, "modified-equation", 2, CALLBACK},
        {"traction, paper", PAPER, "leapfrog", 2, CALLBACK},
        {"traction, total Lagrangian", QUADRATIC, "leapfrog", 2, CALLBACK},
        {"traction, updated Lagrangian", UPDATED, "rk4", 2, CALLBACK},
        {"held, consistent", PLAIN, "leapfrog", 3, HELD},
        {"held, modified equation", PLAIN, "modified-equation", 2, HELD},
        {"held, paper", PAPER, "leapfrog", 2, HELD},
        {"held, total Lagrangian", TOTAL, "leapfrog", 2, HELD},
        {"held, updated Lagrangian", UPDATED, "rk4", 2, HELD},
        {"motion, consistent", PLAIN, "leapfrog", 3, MOTION},
        {"motion, modified equation", PLAIN, "modified-equation", 2, MOTION},
        {"motion, total Lagrangian", QUADRATIC, "leapfrog", 2, MOTION},
        {"motion, updated Lagrangian", UPDATED, "rk4", 2, MOTION},
    };
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++)
        go_on(&all[i]);
}

/* Eight rows of eight points of the host's own, the last of each `wide` off its place. */
static selas_simulation *open_points(double wide)
{
    static const char text[] =
        "&scene dimension = 2, end_time = 2 /\n&method name = 'sph', law = 'linear' /\n"
        "&stepping time_step = .05 /\n&material name = 'm', density = 1, lambda = 1, mu = 1 /\n"
        "&body material = 'm', low = 0, 0, high = 8, 8, spacing = 1 /\n"
        "&initial kind = 'uniform-velocity', velocity = 1, 0 /\n";
    double position[64][3] = {{0}}, volume[64];
    selas_simulation *simulation = NULL;
    for (int i = 0; i < 64; i++) {
        position[i][0] = i % 8 + .5 + (i % 8 == 7 ? wide : 0);
        position[i][1] = i / 8 + .5;
        volume[i] = 1;
    }
    assert_int_equal(selas_open_text("points", text, &simulation), SELAS_OK);
    assert_int_equal(selas_set_points(simulation, 64, position[0], volume, NULL), SELAS_OK);
    return simulation;
}

/* A simulation goes on only with what the host gave: the loads that it drives, and its points. */
static void test_other_host(void **state)
{
    (void)state;
    char path[] = "/tmp/selas-checkpoint-XXXXXX";
    const int file = mkstemp(path);
    assert_true(file >= 0);
    close(file);
    for (int saved = 0; saved < 2; saved++)
        for (int gone_on = 0; gone_on < 2; gone_on++) {
            selas_simulation *one = open_scene(), *other = open_scene();
            selas_simulation *body = open_points(0), *changed = open_points(saved == gone_on ? 0 : .01);
            const selas_status wanted = saved == gone_on ? SELAS_OK : SELAS_FILE_ERROR;
            if (saved) assert_int_equal(selas_set_load(one, "hammer", 1), SELAS_OK);
            if (gone_on) assert_int_equal(selas_set_load(other, "hammer", 1), SELAS_OK);
            assert_int_equal(selas_step(one, 2), SELAS_OK);
            assert_int_equal(selas_save(one, path), SELAS_OK);
            assert_int_equal(selas_restore(other, path), wanted);
            assert_int_equal(selas_step(body, 2), SELAS_OK);
            assert_int_equal(selas_save(body, path), SELAS_OK);
            assert_int_equal(selas_restore(changed, path), wanted);
            selas_close(&one);
            selas_close(&other);
            selas_close(&body);
            selas_close(&changed);
        }
    remove(path);
}

static void write_table(const char *path, double peak)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "0 0\n.5 %g\n1 0\n", peak);
    assert_int_equal(fclose(file), 0);
}

/* A checkpoint goes on with the files that its run has read, whatever they have become before it was saved. */
static void test_changed_file(void **state)
{
    (void)state;
    char path[] = "/tmp/selas-checkpoint-XXXXXX", table[] = "/tmp/selas-table-XXXXXX";
    const char *const words[2] = {"table", table};
    const int file[2] = {mkstemp(path), mkstemp(table)};
    assert_true(file[0] >= 0 && file[1] >= 0);
    close(file[0]);
    close(file[1]);
    for (int changed = 0; changed < 2; changed++) {
        write_table(table, 1);
        selas_simulation *all[2] = {open_scene(), open_scene()};
        for (int k = 0; k < 2; k++) {
            assert_int_equal(selas_add(all[k], "load", &(size_t){0}), SELAS_OK);
            assert_int_equal(selas_set_text(all[k], "load(2)%face", 1, &(const char *){"z-"}), SELAS_OK);
            assert_int_equal(selas_set_text(all[k], "load(2)%shape", 1, &(const char *){"face"}), SELAS_OK);
            assert_int_equal(selas_set_real(all[k], "load(2)%direction", 3, (double[]){0, 0, 1}), SELAS_OK);
            assert_int_equal(selas_set_text(all[k], "load(2)%history", 1, &words[0]), SELAS_OK);
            assert_int_equal(selas_set_text(all[k], "load(2)%file", 1, &words[1]), SELAS_OK);
            if (k == 1) break;
            if (selas_step(all[k], 2) != SELAS_OK) fail_msg("%s", selas_message(all[k]));
            if (changed) write_table(table, 2);
            assert_int_equal(selas_save(all[k], path), SELAS_OK);
        }
        assert_int_equal(selas_restore(all[1], path), changed ? SELAS_FILE_ERROR : SELAS_OK);
        for (int k = 0; k < 2; k++)
            selas_close(&all[k]);
    }
    remove(path);
    remove(table);
}

static void write_rows(const char *path, int last)
{
    FILE *file = fopen(path, "w");
    assert_non_null(file);
    fprintf(file, "0 0 0 0 0 0 0\n1 %d 0 0 0 0 0\n", last);
    assert_int_equal(fclose(file), 0);
}

/* A reference from a file that is another one at the end: told. */
static void test_changed_reference(void **state)
{
    (void)state;
    static const char deck[] =
        "&scene dimension = 1, end_time = 1 /\n&material name = 'rock', density = 1, lambda = 1, mu = 1 /\n"
        "&body material = 'rock', low = 0, high = 4, spacing = .5 /\n&receiver name = 'r', position = 2 /\n"
        "&initial kind = 'gaussian', amplitude = .01, direction = 1, centre = 2, width = .6 /\n"
        "&reference kind = 'file', file = '%s/rows' /\n&output directory = '%s/out', plots = .false. /\n";
    char folder[] = "/tmp/selas-reference-XXXXXX", rows[60], text[1000], command[60];
    assert_non_null(mkdtemp(folder));
    snprintf(rows, sizeof rows, "%s/rows", folder);
    snprintf(text, sizeof text, deck, folder, folder);
    for (int changed = 0; changed < 2; changed++) {
        selas_simulation *simulation = NULL;
        write_rows(rows, 0);
        if (selas_open_text("reference", text, &simulation) != SELAS_OK ||
            selas_record(simulation) != SELAS_OK || selas_step(simulation, 1) != SELAS_OK)
            fail_msg("%s", selas_message(simulation));
        write_rows(rows, changed);
        if (selas_write(simulation) != SELAS_OK) fail_msg("%s", selas_message(simulation));
        const char *const told = strstr(selas_message(simulation), "names has changed since the run began");
        assert_true((told != NULL) == (changed == 1));
        selas_close(&simulation);
    }
    snprintf(command, sizeof command, "rm -r %s", folder);
    assert_int_equal(system(command), 0);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_changed_reference), cmocka_unit_test(test_other_host),
        cmocka_unit_test(test_changed_file),      cmocka_unit_test(test_smoothed_point),
        cmocka_unit_test(test_particles),         cmocka_unit_test(test_driven),
    };
    omp_set_num_threads(1);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
