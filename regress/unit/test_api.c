/* The library's door: building by calls, driving, reading, many simulations, two threads (wrong calls:
 * test_api_wrong; checkpoints: test_api_checkpoint). The Fortran twin is regress/hosts/twins.f90. */
#include "api_scene.h"

#include <omp.h>
#include <pthread.h>
#include <stdlib.h>
#include <unistd.h>

static double end_displacement(selas_simulation *simulation)
{
    double value[3];
    assert_int_equal(selas_advance(simulation, 2.0), SELAS_OK);
    assert_int_equal(selas_receiver(simulation, "r", SELAS_DISPLACEMENT, value), SELAS_OK);
    return value[2];
}

/* Layers in place of dampers: the memory of a step must not be moved on twice when a load changes. */
static void put_layers(selas_simulation *simulation)
{
    static const char *const pml[] = {"pml"};
    assert_int_equal(selas_set_text(simulation, "boundary%layer", 1, pml), SELAS_OK);
    assert_int_equal(selas_set_integer(simulation, "boundary%layer_points", 6), SELAS_OK);
    assert_int_equal(selas_set_logical(simulation, "boundary%always", true), SELAS_OK);
}

/* Q of P and S waves, about the hammer's frequency. */
static void put_damping(selas_simulation *simulation, double q_p, double q_s)
{
    const double frequency = .5;
    assert_int_equal(selas_set_real(simulation, "material%q_p", 1, &q_p), SELAS_OK);
    assert_int_equal(selas_set_real(simulation, "material%q_s", 1, &q_s), SELAS_OK);
    assert_int_equal(selas_set_real(simulation, "material%q_frequency", 1, &frequency), SELAS_OK);
}

/* A traction by function, and a load held at a value at each step, are the deck's own load. The held value
 * reaches the acceleration of its own step, so with leapfrog nothing but rounding differs. (On damped ground relaxation
 * mechanisms and the step are others where the deck does not know the load.) */
static void driven_loads(bool layers, bool damped)
{
    const char *const leapfrog[1] = {"leapfrog"};
    double answer[3];
    for (int mode = 0; mode < 3; mode++) {
        selas_simulation *simulation = open_scene();
        if (layers) put_layers(simulation);
        if (damped) put_damping(simulation, 30, 20);
        struct push push = {0};
        assert_int_equal(selas_set_text(simulation, "stepping%scheme", 1, leapfrog), SELAS_OK);
        assert_int_equal(selas_set_logical(simulation, "stepping%unwarp", false), SELAS_OK);
        if (mode == 1) assert_int_equal(selas_set_traction(simulation, "hammer", triangle, &push), SELAS_OK);
        if (mode == 2) assert_int_equal(selas_set_load(simulation, "hammer", 0.0), SELAS_OK);
        const double dt = selas_time_step(simulation);
        for (int i = 0; mode == 2 && i * dt < 2.0; i++) {
            double value[3] = {0};
            triangle(&push, selas_time(simulation), value, value);
            assert_int_equal(selas_set_load(simulation, "hammer", value[2]), SELAS_OK);
            assert_int_equal(selas_step(simulation, 1), SELAS_OK);
        }
        answer[mode] = end_displacement(simulation);
        if (mode == 1) assert_true(push.in_order && push.calls > 10);
        selas_close(&simulation);
    }
    print_message("# layers %d, damped %d: %.9g by the deck, %.9g by a function, %.9g held\n", layers, damped,
                  answer[0], answer[1], answer[2]);
    assert_true(fabs(answer[0]) > 1e-3);
    if (!damped) assert_true(fabs(answer[1] - answer[0]) < 1e-12 * fabs(answer[0]));
    assert_true(fabs(answer[2] - answer[1]) < 2e-12 * fabs(answer[0]));
}

static void test_driven_loads(void **state)
{
    (void)state;
    for (int way = 0; way < 4; way++)
        driven_loads(way % 2 == 1, way / 2 == 1);
}

/* Energy of a closed box after a push, undamped and damped: what is missing is what damping takes of waves in the time
 * since, about 1 - exp(-2 pi f t/Q) of them for some f of the push. */
static void test_damped_energy(void **state)
{
    (void)state;
    static const double q[3] = {0, 1e6, 20};
    double energy[3];
    for (int i = 0; i < 3; i++) {
        selas_simulation *simulation = NULL;
        char deck[sizeof scene];
        snprintf(deck, sizeof deck, "%s", scene);
        char *boundary = strstr(deck, "&boundary"), *load = strstr(deck, "&load");
        memmove(boundary, load, strlen(load) + 1);
        if (selas_open_text("closed", deck, &simulation) != SELAS_OK)
            fail_msg("%s", selas_message(simulation));
        if (q[i] > 0) put_damping(simulation, q[i], q[i]);
        double kinetic, strain;
        assert_int_equal(selas_advance(simulation, 2.0), SELAS_OK);
        assert_int_equal(selas_energy(simulation, &kinetic, &strain), SELAS_OK);
        energy[i] = kinetic + strain;
        selas_close(&simulation);
    }
    print_message("# energy %.6g, at Q = 1e6 %.6g, at Q = 20 %.6g\n", energy[0], energy[1], energy[2]);
    assert_true(fabs(energy[1] / energy[0] - 1) < 1e-4);
    assert_true(energy[2] < .97 * energy[0] && energy[2] > .6 * energy[0]);
}

/* A face that goes to and fro, by the deck's history or by a function. */
static int slide(void *context, double time, const double position[3], double value[3])
{
    (void)context;
    (void)position;
    value[1] = value[2] = 0;
    value[0] = .01 * exp(-(time - .8) * (time - .8) / .02);
    return 0;
}

static void test_driven_face(void **state)
{
    (void)state;
    static const char *const methods[] = {"variant = 'consistent'", "variant = 'paper', filter = 0",
                                          "name = 'sph', variant = 'total-lagrangian'"};
    char deck[1000];
    for (size_t m = 0; m < sizeof methods / sizeof *methods; m++) {
        double answer[2];
        snprintf(deck, sizeof deck,
                 "&scene dimension = 2, end_time = 2 /\n&method %s /\n&stepping scheme = 'leapfrog', "
                 "time_step = .05, unwarp = F /\n&material name = 'rock', density = 1, lambda = 1, mu = 1 /\n"
                 "&body material = 'rock', shape = 'box', low = 0, 0, high = 4, 4, spacing = .5 /\n"
                 "&boundary face = 'x-', kind = 'displacement', direction = 1, 0, amplitude = .01, history = "
                 "'gaussian', delay = .8, width = .1 /\n&receiver name = 'r', position = 2, 2 /\n",
                 methods[m]);
        for (int driven = 0; driven < 2; driven++) {
            selas_simulation *simulation = NULL;
            double value[3];
            if (selas_open_text("slide", deck, &simulation) != SELAS_OK ||
                (driven && selas_set_motion(simulation, "x-", slide, NULL) != SELAS_OK) ||
                selas_advance(simulation, 2) != SELAS_OK ||
                selas_receiver(simulation, "r", SELAS_DISPLACEMENT, value) != SELAS_OK)
                fail_msg("%s: %s", methods[m], selas_message(simulation));
            answer[driven] = value[0];
            selas_close(&simulation);
        }
        print_message("# %s: by the deck %.9g, by the host %.9g\n", methods[m], answer[0], answer[1]);
        assert_true(fabs(answer[0]) > 1e-4 && fabs(answer[1] - answer[0]) < 1e-12 * fabs(answer[0]));
    }
}

/* A smooth push, known beforehand or held step by step. */
static double bell(double time)
{
    return time < 2 ? pow(sin(M_PI * time / 2), 6) : 0;
}

static int push_bell(void *context, double time, const double position[3], double value[3])
{
    (void)context;
    (void)position;
    value[0] = value[1] = 0;
    value[2] = bell(time);
    return 0;
}

static double modified_equation(double dt, bool held)
{
    const char *const scheme[1] = {"modified-equation"};
    selas_simulation *simulation = open_scene();
    double value[3];
    assert_int_equal(selas_set_text(simulation, "stepping%scheme", 1, scheme), SELAS_OK);
    assert_int_equal(selas_set_real(simulation, "stepping%time_step", 1, &dt), SELAS_OK);
    if (!held)
        assert_int_equal(selas_set_traction(simulation, "hammer", push_bell, NULL), SELAS_OK);
    else
        assert_int_equal(selas_set_load(simulation, "hammer", 0), SELAS_OK);
    while (selas_time(simulation) < 1.6 - 1e-9) {
        if (held)
            assert_int_equal(selas_set_load(simulation, "hammer", bell(selas_time(simulation))), SELAS_OK);
        assert_int_equal(selas_step(simulation, 1), SELAS_OK);
    }
    assert_int_equal(selas_receiver(simulation, "r", SELAS_DISPLACEMENT, value), SELAS_OK);
    selas_close(&simulation);
    return value[2];
}

/* The modified equation takes the second difference of a load that a function gives; that of a held load is
 * not known, which leaves dt^2/12 F'': second order (the fixed scene of doc/howto/calling.md, section 4). */
static void test_held_order(void **state)
{
    (void)state;
    const double exact = modified_equation(0.0125, false);
    const double coarse = fabs(modified_equation(0.1, true) - exact),
                 fine = fabs(modified_equation(0.05, true) - exact),
                 function = fabs(modified_equation(0.1, false) - exact);
    print_message("# held: %.1e at dt = .1, %.1e at .05; by a function: %.1e at .1\n", coarse / fabs(exact),
                  fine / fabs(exact), function / fabs(exact));
    assert_true(fine > 0 && coarse / fine > 3.4 && coarse / fine < 4.6);
    assert_true(function < 0.25 * coarse);
}

/* Leapfrog's velocity is the central difference of its displacements, also in the mean; and as long as no
 * wave has reached an absorbing face, a constant force on the patch has done the work force times mean
 * displacement, which is the body's energy. */
static void test_mean(void **state)
{
    (void)state;
    selas_simulation *simulation = open_scene();
    const char *const leapfrog[1] = {"leapfrog"};
    double displacement[3] = {0}, velocity, kinetic, strain;
    assert_int_equal(selas_set_text(simulation, "stepping%scheme", 1, leapfrog), SELAS_OK);
    assert_int_equal(selas_set_real(simulation, "stepping%safety", 1, &(double){0.1}), SELAS_OK);
    assert_int_equal(selas_set_load(simulation, "hammer", 3.0), SELAS_OK);
    assert_int_equal(selas_advance(simulation, 0.4), SELAS_OK);
    const double dt = selas_time_step(simulation);
    for (int i = 0; i < 3; i++) {
        assert_int_equal(selas_load_mean(simulation, "hammer", SELAS_DISPLACEMENT, &displacement[i]),
                         SELAS_OK);
        if (i == 1)
            assert_int_equal(selas_load_mean(simulation, "hammer", SELAS_VELOCITY, &velocity), SELAS_OK);
        if (i < 2) assert_int_equal(selas_step(simulation, 1), SELAS_OK);
    }
    assert_true(fabs(velocity - (displacement[2] - displacement[0]) / (2 * dt)) < 1e-11 * fabs(velocity));
    assert_int_equal(selas_energy(simulation, &kinetic, &strain), SELAS_OK);
    const double work = 3.0 * 4.0 * displacement[2];
    assert_true(fabs(kinetic + strain - work) < 0.01 * work);
    selas_close(&simulation);
}

static void test_callback_answers(void **state)
{
    (void)state;
    selas_simulation *simulation = open_scene();
    struct push push = {0};
    assert_int_equal(selas_set_traction(simulation, "hammer", triangle, &push), SELAS_OK);
    assert_int_equal(selas_step(simulation, 3), SELAS_OK);
    push.answer = 7;
    assert_int_equal(selas_step(simulation, 3), SELAS_STOPPED);
    assert_int_equal(selas_steps(simulation), 4);
    push.answer = 0;
    assert_int_equal(selas_step(simulation, 1), SELAS_OK);
    push.not_finite = true;
    assert_int_equal(selas_step(simulation, 1), SELAS_CALLBACK_FAILED);
    assert_non_null(strstr(selas_message(simulation), "hammer"));
    push.not_finite = false;
    assert_int_equal(selas_step(simulation, 1), SELAS_CALLBACK_FAILED);
    selas_close(&simulation);
    assert_null(simulation);
}

static int meddle(void *context, double time, const double position[3], double value[3])
{
    selas_simulation *simulation = *(selas_simulation **)context;
    (void)time;
    (void)position;
    const selas_status status = selas_step(simulation, 1);
    selas_close((selas_simulation **)context);
    value[0] = 0;
    return status == SELAS_BAD_ARGUMENT && *(selas_simulation **)context != NULL ? 0 : -1;
}

static void test_callback_must_not_call_back(void **state)
{
    (void)state;
    selas_simulation *simulation = open_scene();
    assert_int_equal(selas_set_traction(simulation, "hammer", meddle, &simulation), SELAS_OK);
    assert_int_equal(selas_step(simulation, 2), SELAS_OK);
    selas_close(&simulation);
}

/* --- Many simulations --- */

static long resident_pages(void)
{
    long size = 0, resident = 0;
    FILE *file = fopen("/proc/self/statm", "r");
    if (file == NULL || fscanf(file, "%ld %ld", &size, &resident) != 2) resident = 0;
    if (file != NULL) fclose(file);
    return resident;
}

static void test_no_growth(void **state)
{
    (void)state;
    /* a sanitizer keeps what is freed; its own search for leaks looks closer */
    if (getenv("ASAN_OPTIONS") != NULL) skip();
    long settled = 0;
    for (int i = 0; i < 1000; i++) {
        selas_simulation *simulation = open_scene();
        if (i % 10 == 0) assert_int_equal(selas_step(simulation, 2), SELAS_OK);
        selas_close(&simulation);
        if (i == 200) settled = resident_pages();
    }
    assert_true(settled > 0);
    assert_true((resident_pages() - settled) * sysconf(_SC_PAGESIZE) < 1 << 20);
}

static void *run_one(void *answer)
{
    selas_simulation *simulation = NULL;
    double *value = answer;
    value[6] = selas_open_text("thread", scene, &simulation) == SELAS_OK ? 1 : 0;
    size_t rows = 0;
    const double *time = NULL, *values = NULL;
    if (selas_finish(simulation) != SELAS_OK ||
        selas_history(simulation, "r", &rows, &time, &values) != SELAS_OK)
        value[6] = 0;
    if (rows > 0) memcpy(value, values + 6 * (rows - 1), 6 * sizeof *value);
    selas_close(&simulation);
    return NULL;
}

static void test_two_threads(void **state)
{
    (void)state;
    double alone[7] = {0}, beside[2][7] = {{0}};
    pthread_t thread[2] = {0};
    run_one(alone);
    assert_true(alone[6] == 1 && fabs(alone[2]) > 0);
    for (int round = 0; round < 5; round++) {
        for (int i = 0; i < 2; i++)
            if (pthread_create(&thread[i], NULL, run_one, beside[i]) != 0) abort();
        for (int i = 0; i < 2; i++) {
            pthread_join(thread[i], NULL);
            assert_memory_equal(beside[i], alone, sizeof alone);
        }
    }
}

int main(void)
{
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_driven_loads),
        cmocka_unit_test(test_damped_energy),
        cmocka_unit_test(test_driven_face),
        cmocka_unit_test(test_mean),
        cmocka_unit_test(test_held_order),
        cmocka_unit_test(test_callback_answers),
        cmocka_unit_test(test_callback_must_not_call_back),
        cmocka_unit_test(test_no_growth),
        cmocka_unit_test(test_two_threads),
    };
    omp_set_num_threads(1);
    return cmocka_run_group_tests(tests, NULL, NULL);
}
