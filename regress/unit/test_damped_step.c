/* Steps of damped ground in one pass with two displacements (method/consistent/fused/fused.h, F1a and F1b) against
 * the parts' operators one by one: faces, masses and layers by chance, threads, planes at rest, single
 * precision. */
#include "chance.h"
#include "few.h"
#include "from_deck.h"

#include "base/memory.h"
#include "method/consistent/consistent.h"
#include "method/consistent/fused/fused.h"
#include "method/consistent/galerkin/galerkin.h"
#include "method/damped/damped.h"
#include "method/methods.h"
#include "stepping/stepping.h"

#include <math.h>
#include <omp.h>

/* A model with its stepper and state. */
struct damped_run {
    struct from_deck from;
    struct model *model;
    struct stepper *stepper;
    struct state state;
};

static struct damped_run run_of(const char *deck, bool one_pass)
{
    struct damped_run run = {.from = right_scene(deck)};
    struct messages messages = {0};
    if (model_create(run.from.scene, &run.model, &messages) != SELAS_OK) print_error("%s", messages.text);
    assert_non_null(run.model);
    assert_non_null(run.model->one_pass);
    if (!one_pass) run.model->one_pass = NULL;
    assert_int_equal(stepper_create(run.model, &run.stepper, &messages), SELAS_OK);
    assert_int_equal(state_create(run.stepper, &run.state, &messages), SELAS_OK);
    return run;
}

static void run_free(struct damped_run *run)
{
    state_free(&run->state);
    stepper_free(&run->stepper);
    model_free(&run->model);
    from_deck_free(&run->from);
}

static void drawn(size_t size, char *deck, int number, const char *words)
{
    static const char *const kind[] = {"free", "free", "fixed", "roller", "symmetry", "transmitting"};
    static const char *const face[] = {"x-", "x+", "y-", "y+", "z-", "z+"};
    int at = snprintf(deck, size,
                      "&scene dimension = 3, end_time = 3.0 /\n"
                      "&method degree = 2, mass = 'vc%d', mechanisms = 3, depth_mass = '%s' %s /\n"
                      "&material name = 'm', density = 0.7, lambda = 1.0, mu = 0.5, q_p = %d, q_s = 12, "
                      "q_frequency = 0.5 /\n"
                      "&body material = 'm', shape = 'box', low = 3*0.0, high = %.1f, %.1f, %.1f, "
                      "spacing = 0.3 /\n"
                      "&load face = 'z-', shape = 'square', centre = 1.4, 1.4, 0.0, size = 1.3, 0.9, "
                      "direction = .3, .5, 1, history = 'step' /\n",
                      1 + number % 3, number % 2 == 0 ? "exact" : "same", words, 20,
                      .3 * (double)(17 + chance(10)), .3 * (double)(17 + chance(10)),
                      .3 * (double)(25 + chance(20)));
    for (int i = 0; i < 6; i++) {
        const char *drawn = i == 4 ? "free" : kind[chance(number % 4 == 3 ? 6 : 5)];
        at += snprintf(deck + at, size - (size_t)at, "&boundary face = '%s', kind = '%s'%s /\n", face[i],
                       drawn, drawn[0] == 't' ? ", layer = 'pml', layer_points = 5, always = .true." : "");
    }
}

/* The same, drawn until its steps are one pass. */
static void draw(size_t size, char *deck, int number, const char *words)
{
    for (bool served = false; !served;) {
        drawn(size, deck, number, words);
        struct from_deck from = right_scene(deck);
        struct model *model = NULL;
        struct messages messages = {0};
        served = model_create(from.scene, &model, &messages) == SELAS_OK && model->one_pass != NULL;
        messages_free(&messages);
        if (model != NULL) model_free(&model);
        from_deck_free(&from);
    }
}

static double apart(size_t n, const double *one, const double *other)
{
    double most = 0, largest = 0;
    for (size_t i = 0; i < n; i++) {
        most = fmax(most, fabs(one[i] - other[i]));
        largest = fmax(largest, fabs(other[i]));
    }
    assert_true(largest > 0);
    return most / largest;
}

static void operators_in_one(void **unused)
{
    (void)unused;
    double worst = 0;
    const int scenes = few_of(12, 6);
    for (int i = 0; i < scenes; i++) {
        char deck[2000];
        draw(sizeof deck, deck, i, i % 5 == 4 ? ", quiet = 0.0" : "");
        struct damped_run one = run_of(deck, true), other = run_of(deck, false);
        assert_int_equal(((struct damped *)one.model)->parts, 2);
        for (int step = 0; step < 40; step++) {
            one.stepper->scheme->step(one.stepper, &one.state);
            other.stepper->scheme->step(other.stepper, &other.state);
            if (step % 8 != 5) continue;
            state_settle(one.stepper, &one.state, true);
            const size_t n = one.model->unknowns;
            worst = fmax(worst, apart(n, one.state.y, other.state.y));
            worst = fmax(worst, apart(n, one.state.y + n, other.state.y + n));
            worst = fmax(worst, apart(n, one.state.a, other.state.a));
            worst = fmax(worst, apart(3 * n, one.state.y + 2 * n, other.state.y + 2 * n));
        }
        run_free(&one);
        run_free(&other);
    }
    print_message("# one pass against part by part: %.1e\n", worst);
    assert_true(worst < 1e-12);
}

/* The same bits with any number of threads, looked at on the way or not; some of the body is at rest. */
static void the_same_bits(void **unused)
{
    (void)unused;
    for (int single = 0; single < 2; single++) {
        char deck[2000];
        double *first = NULL;
        draw(sizeof deck, deck, 2, single ? ", precision = 'single'" : "");
        for (int threads = 1; threads <= 3; threads++) {
            omp_set_num_threads(threads);
            struct damped_run run = run_of(deck, true);
            const size_t n = run.model->state_size;
            for (int step = 0; step < 30; step++) {
                run.stepper->scheme->step(run.stepper, &run.state);
                if (threads == 2 && step % 9 == 4) state_settle(run.stepper, &run.state, false);
            }
            state_settle(run.stepper, &run.state, false);
            if (first == NULL) {
                first = array_new(n, sizeof *first);
                memcpy(first, run.state.y, n * sizeof *first);
            }
            assert_memory_equal(first, run.state.y, n * sizeof *first);
            const struct fused *fused = consistent_of(((struct damped *)run.model)->part[0].model)->fused;
            assert_true((single ? fused->single : fused)->skipped > 0);
            run_free(&run);
        }
        array_free(first);
    }
    omp_set_num_threads(1);
}

int main(void)
{
    const struct CMUnitTest tests[] = {cmocka_unit_test(operators_in_one), cmocka_unit_test(the_same_bits)};
    omp_set_num_threads(1);
    seed_begin(6);
    return cmocka_run_group_tests_name("damped steps in one pass", tests, NULL, NULL);
}
