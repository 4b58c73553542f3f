/* What surrounds a host's calls: threads beside each other, floating-point traps, the folder in which it stands. */
#include "api_scene.h"

#include <fenv.h>
#include <omp.h>
#include <pthread.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

static char folder[64];

static int set_up(void **state)
{
    (void)state;
    snprintf(folder, sizeof folder, "/tmp/selas-around-XXXXXX");
    return mkdtemp(folder) == NULL;
}

static int tear_down(void **state)
{
    (void)state;
    char command[128];
    snprintf(command, sizeof command, "rm -rf '%s'", folder);
    return system(command) != 0;
}

/* --- Handles --- */

/* A copy of a handle that is closed, and one that never was any, are told from open ones. */
static void test_stale_handles(void **state)
{
    (void)state;
    char garbage[64] = "none of selas's";
    selas_simulation *s = open_scene(), *copy = s, *none = (selas_simulation *)(void *)garbage;
    double number[6];
    selas_close(&s);
    for (int k = 0; k < 2; k++) {
        selas_simulation *stale = k == 0 ? copy : none;
        wrong(stale, selas_step(stale, 1));
        assert_non_null(strstr(selas_last_message(stale), "not opened, or is closed"));
        wrong(stale, selas_receiver(stale, "r", SELAS_VELOCITY, number));
        wrong(stale, selas_set_load(stale, "hammer", 1));
        wrong(stale, selas_plan(stale, NULL, NULL));
        assert_true(isnan(selas_time(stale)) && selas_steps(stale) == 0 && isnan(selas_end_time(stale)));
        assert_non_null(strstr(selas_message(stale), "not opened"));
        selas_close(&stale);
        assert_null(stale);
    }
    s = open_scene();
    assert_int_equal(selas_step(s, 1), SELAS_OK);
    selas_close(&s);
}

/* --- Threads --- */

/* Another thread asks while the first one is inside a call: its callback waits for that. */
static int ask_beside(void *context, double time, const double position[3], double value[3]);

static void *ask(void *context)
{
    selas_simulation *s = context, *same = s;
    double number[6];
    wrong(s, selas_step(s, 1));
    assert_non_null(strstr(selas_last_message(s), "another thread"));
    assert_non_null(strstr(selas_message(s), "another thread"));
    wrong(s, selas_step(s, (unsigned long)-1));
    wrong(s, selas_receiver(s, "r", SELAS_VELOCITY, number));
    wrong(s, selas_plan(s, NULL, NULL));
    wrong(s, selas_set_load(s, "hammer", 1));
    assert_true(isnan(selas_end_time(s)));
    selas_close(&same);
    assert_ptr_equal(same, s);
    selas_simulation *other = open_scene(); /* of its own */
    assert_int_equal(selas_step(other, 1), SELAS_OK);
    selas_close(&other);
    return NULL;
}

static int ask_beside(void *context, double time, const double position[3], double value[3])
{
    pthread_t thread;
    (void)position;
    value[2] = time;
    assert_int_equal(pthread_create(&thread, NULL, ask, *(selas_simulation **)context), 0);
    return pthread_join(thread, NULL);
}

static void test_one_thread_at_a_time(void **state)
{
    (void)state;
    selas_simulation *s = open_scene();
    assert_int_equal(selas_set_traction(s, "hammer", ask_beside, &s), SELAS_OK);
    assert_int_equal(selas_step(s, 2), SELAS_OK);
    assert_null(strstr(selas_message(s), "another thread"));
    selas_close(&s);
    assert_null(s);
}

enum { THREADS = 4 };

/* A run with snapshots and a checkpoint, from its opening to its results. */
static void *run(void *context)
{
    const int number = *(const int *)context;
    char text[2048], path[128];
    double value[6];
    selas_simulation *s = NULL;
    snprintf(text, sizeof text,
             "%s&snapshot every = .3, fields = 'velocity' /\n&output directory = '%s/%d', plots = F /\n",
             scene, folder, number);
    snprintf(path, sizeof path, "%s/checkpoint-%d.h5", folder, number);
    selas_status status = selas_open_text("beside", text, &s);
    if (status == SELAS_OK) status = selas_record(s);
    if (status == SELAS_OK) status = selas_step(s, 3);
    if (status == SELAS_OK) status = selas_save(s, path);
    if (status == SELAS_OK) status = selas_write(s);
    if (status == SELAS_OK) status = selas_receiver(s, "r", SELAS_VELOCITY, value);
    if (status != SELAS_OK) fprintf(stderr, "%s\n", selas_message(s));
    selas_close(&s);
    double *made = malloc(sizeof *made);
    if (made != NULL) *made = status == SELAS_OK ? value[2] : (double)NAN;
    return made;
}

/* Simulations beside each other, their files, too. */
static void test_a_simulation_a_thread(void **state)
{
    (void)state;
    for (int repeat = 0; repeat < 5; repeat++) {
        pthread_t thread[THREADS];
        double first = 0;
        int number[THREADS];
        for (int i = 0; i < THREADS; i++) {
            number[i] = i;
            assert_int_equal(pthread_create(&thread[i], NULL, run, &number[i]), 0);
        }
        for (int i = 0; i < THREADS; i++) {
            void *made;
            assert_int_equal(pthread_join(thread[i], &made), 0);
            const double value = *(double *)made;
            free(made);
            if (i == 0) first = value;
            assert_true(isfinite(value) && value == first);
        }
    }
}

/* --- Arithmetic --- */

#ifdef __GLIBC__
enum { TRAPS = FE_INVALID | FE_DIVBYZERO | FE_OVERFLOW };

/* The host's functions have its own rules. */
static int look(void *context, double time, const double position[3], double value[3])
{
    (void)position;
    *(int *)context = fegetexcept() == TRAPS && fegetround() == FE_UPWARD;
    value[2] = time;
    return 0;
}

static double velocity_after(int threads, bool rules)
{
    int right = 0;
    double value[6] = {0};
    selas_simulation *s = NULL;
    omp_set_num_threads(threads);
#pragma omp parallel
    {
        feclearexcept(FE_ALL_EXCEPT);
        if (rules) feenableexcept(TRAPS);
        if (rules) fesetround(FE_UPWARD);
    }
    assert_int_equal(
        selas_open_deck_with("input/halfspace.nml", 1, &(const char *const){"body%spacing=.5"}, &s),
        SELAS_OK);
    assert_int_equal(selas_set_traction(s, "1", look, &right), SELAS_OK);
    assert_int_equal(selas_step(s, 5), SELAS_OK);
    assert_int_equal(selas_receiver(s, "r1", SELAS_VELOCITY, value), SELAS_OK);
    selas_close(&s);
    assert_true(right == rules);
    bool kept = true;
#pragma omp parallel reduction(&& : kept)
    {
        kept = !rules || (fegetexcept() == TRAPS && fegetround() == FE_UPWARD);
        fesetenv(FE_DFL_ENV);
    }
    assert_true(kept);
    return value[2];
}

/* As gfortran's -ffpe-trap has them; results do not depend on the host's rules. */
static void test_traps(void **state)
{
    (void)state;
    const double wanted = velocity_after(1, false);
    assert_true(wanted != 0);
    for (int threads = 1; threads <= 3; threads += 2)
        assert_true(velocity_after(threads, true) == wanted);
    omp_set_num_threads(1);
}
#endif

/* --- The host leaves its folder --- */

static void test_another_folder(void **state)
{
    (void)state;
    char text[2048], *back = getcwd(NULL, 0);
    double value[2][6];
    assert_non_null(back);
    assert_int_equal(chdir(folder), 0);
    assert_int_equal(mkdir("elsewhere", 0700), 0);
    for (int n = 0; n < 2; n++) { /* another table lies there under the same name */
        FILE *file = fopen(n == 0 ? "push.txt" : "elsewhere/push.txt", "w");
        assert_non_null(file);
        fputs(n == 0 ? "0 0\n1 1\n" : "0 0\n1 5\n", file);
        fclose(file);
    }
    snprintf(text, sizeof text, "%s&output plots = F /\n", scene);
    char *word = strstr(text, "'triangle', duration = 1");
    memcpy(word, "'table', file='push.txt'", strlen("'table', file='push.txt'"));
    for (int moved = 0; moved < 2; moved++) {
        selas_simulation *s = NULL;
        if (selas_open_text("moved", text, &s) != SELAS_OK) fail_msg("%s", selas_message(s));
        if (moved) assert_int_equal(chdir("elsewhere"), 0);
        assert_int_equal(selas_set_real(s, "scene%end_time", 1, &(double){1.5}), SELAS_OK);
        assert_int_equal(selas_record(s), SELAS_OK);
        if (moved) { /* results would go astray */
            wrong(s, selas_step(s, 3));
            assert_non_null(strstr(selas_last_message(s), "output%directory"));
            assert_int_equal(selas_set_text(s, "output%directory", 1, &(const char *const){folder}),
                             SELAS_OK);
        }
        assert_int_equal(selas_step(s, 3), SELAS_OK);
        assert_int_equal(selas_receiver(s, "r", SELAS_VELOCITY, value[moved]), SELAS_OK);
        assert_int_equal(selas_write(s), SELAS_OK);
        selas_close(&s);
    }
    assert_true(value[0][2] == value[1][2] && value[0][2] > 0);
    assert_int_equal(chdir(back), 0);
    free(back);
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_stale_handles),
        cmocka_unit_test(test_one_thread_at_a_time),
        cmocka_unit_test(test_a_simulation_a_thread),
#ifdef __GLIBC__
        cmocka_unit_test(test_traps),
#endif
        cmocka_unit_test(test_another_folder),
    };
    omp_set_num_threads(1);
    return cmocka_run_group_tests(tests, set_up, tear_down);
}
