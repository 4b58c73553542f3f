/* Damped scenes whose steps are one pass, or part by part, side by side. */
#ifndef DAMPED_RUN_H
#define DAMPED_RUN_H

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

static inline struct damped_run run_of(const char *deck, bool one_pass)
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

static inline void run_free(struct damped_run *run)
{
    state_free(&run->state);
    stepper_free(&run->stepper);
    model_free(&run->model);
    from_deck_free(&run->from);
}

static inline double apart(size_t n, const double *one, const double *other)
{
    double most = 0, largest = 0;
    for (size_t i = 0; i < n; i++) {
        most = fmax(most, fabs(one[i] - other[i]));
        largest = fmax(largest, fabs(other[i]));
    }
    assert_true(largest > 0);
    return most / largest;
}

/* The same bits with any number of threads, looked at on the way or not. */
static inline void assert_same_states(const char *deck, void (*look)(struct damped_run *run))
{
    double *first = NULL;
    for (int threads = 1; threads <= 3; threads += 2) {
        omp_set_num_threads(threads);
        struct damped_run run = run_of(deck, true);
        const size_t n = run.model->state_size;
        for (int step = 0; step < 30; step++) {
            run.stepper->scheme->step(run.stepper, &run.state);
            if (threads == 3 && step % 9 == 4) state_settle(run.stepper, &run.state, false);
        }
        state_settle(run.stepper, &run.state, false);
        if (first == NULL) {
            first = array_new(n, sizeof *first);
            memcpy(first, run.state.y, n * sizeof *first);
        }
        assert_memory_equal(first, run.state.y, n * sizeof *first);
        look(&run);
        run_free(&run);
    }
    array_free(first);
    omp_set_num_threads(1);
}

#endif
