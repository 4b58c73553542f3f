/* What tests of steps in one pass share: a model with its stepper, state and probes. */
#ifndef STEPPED_H
#define STEPPED_H

#include "chance.h"
#include "consistent_run.h"
#include "few.h"

#include "base/memory.h"
#include "method/consistent/fused/fused.h"
#include "stepping/schemes.h"

#include <omp.h>

static const double places[][3] = {{.1, .2, .3}, {1.7, 2.2, .9}, {2.05, .4, 3.1}};
enum { PLACES = sizeof places / sizeof places[0], VALUES = PLACES * 9 };

/* A model with its stepper and state, and probes. */
struct stepped {
    struct model *model;
    struct stepper *stepper;
    struct state state;
    struct probe probe[PLACES];
};

static inline struct stepped begin(const struct plain_scene *plain, struct consistent_options options,
                                   bool one_pass, bool moves)
{
    struct stepped s = {.model = make(plain, options)};
    struct messages messages = {0};
    struct consistent *c = consistent_of(s.model);
    assert_non_null(c->model.one_pass);
    for (size_t i = 0; i < PLACES; i++)
        assert_int_equal(s.model->core->probe(s.model, places[i], &s.probe[i], &messages), SELAS_OK);
    if (!one_pass) c->model.one_pass = NULL;
    assert_int_equal(stepper_create(s.model, &s.stepper, &messages), SELAS_OK);
    assert_int_equal(state_create(s.stepper, &s.state, &messages), SELAS_OK);
    const size_t n = s.model->unknowns;
    if (moves) { /* a body that is not at rest at t = 0, 0 where it is held */
        noise(2 * n, s.state.y);
        for (size_t half = 0; half < 2; half++)
            for (int component = 0; component < 3; component++)
                for (size_t k = 0; k < c->n[2]; k++)
                    consistent_clear_held(
                        c, component, k, s.state.y + half * n + (size_t)component * c->volume + k * c->plane);
        s.stepper->scheme->start(s.stepper, &s.state);
    }
    assert_int_equal(s.stepper->one_pass, one_pass);
    return s;
}

static inline void end(struct stepped *s)
{
    for (size_t i = 0; i < PLACES; i++)
        probe_free(&s->probe[i]);
    state_free(&s->state);
    stepper_free(&s->stepper);
    model_free(&s->model);
}

static inline void step(struct stepped *s)
{
    s->stepper->scheme->step(s->stepper, &s->state);
}

static inline double difference(size_t n, const double *a, const double *b)
{
    double error = 0, largest = 0;
    for (size_t i = 0; i < n; i++) {
        error = fmax(error, fabs(a[i] - b[i]));
        largest = fmax(largest, fabs(b[i]));
    }
    return largest > 0 ? error / largest : error;
}

/* Displacements, velocities and accelerations at the places. */
static inline void observed(struct stepped *s, double value[VALUES])
{
    static const selas_field field[3] = {SELAS_DISPLACEMENT, SELAS_VELOCITY, SELAS_ACCELERATION};
    for (size_t i = 0; i < PLACES; i++)
        for (size_t k = 0; k < 3; k++) {
            double six[6] = {0};
            model_observe(s->model, &s->probe[i], field[k], s->state.y, s->state.a, six);
            memcpy(value + 9 * i + 3 * k, six, 3 * sizeof *six);
        }
}

/* The same bits with any number of threads, whether or not somebody looks at the whole state on the way; `also` (NULL:
 * nothing) looks at each run. */
static inline void assert_same_bits(const struct plain_scene *plain, struct consistent_options options,
                                    void (*also)(const struct stepped *s))
{
    double *first = NULL;
    const int runs = few_of(4, 2);
    for (int i = 0; i < runs; i++) {
        omp_set_num_threads(1 + i);
        struct stepped s = begin(plain, options, true, false);
        assert_true(i < 2 || consistent_of(s.model)->threads > 1);
        const size_t n = s.model->unknowns;
        for (int count = 0; count < 50; count++) {
            step(&s);
            if (i % 2 == 1 && count % 9 == 4) state_settle(s.stepper, &s.state, count % 2 == 0);
        }
        if (also != NULL) also(&s);
        state_settle(s.stepper, &s.state, true);
        if (first == NULL) first = array_new(3 * n, sizeof *first);
        if (i == 0) memcpy(first, s.state.y, 2 * n * sizeof *first);
        if (i == 0) memcpy(first + 2 * n, s.state.a, n * sizeof *first);
        assert_memory_equal(first, s.state.y, 2 * n * sizeof *first);
        assert_memory_equal(first + 2 * n, s.state.a, n * sizeof *first);
        end(&s);
    }
    omp_set_num_threads(1);
    array_free(first);
}

/* y and what is kept are all that goes on: a state that is taken to another model goes on to the same bits. */
static inline void assert_goes_on(const struct plain_scene *plain, struct consistent_options options)
{
    struct stepped one = begin(plain, options, true, true), other = begin(plain, options, true, false);
    const size_t n = one.model->unknowns;
    for (int count = 0; count < 17; count++)
        step(&one);
    size_t bytes = 0, room = 0;
    const void *from = one.model->one_pass->kept(one.model, &bytes);
    void *to = other.model->one_pass->kept(other.model, &room);
    assert_int_equal(bytes, room);
    memcpy(to, from, bytes);
    memcpy(other.state.y, one.state.y, one.model->state_size * sizeof(double));
    other.state.step = one.state.step;
    for (int count = 0; count < 17; count++) {
        step(&one);
        step(&other);
    }
    state_settle(one.stepper, &one.state, true);
    state_settle(other.stepper, &other.state, true);
    assert_memory_equal(one.state.y, other.state.y, one.model->state_size * sizeof(double));
    assert_memory_equal(one.state.a, other.state.a, n * sizeof(double));
    end(&one);
    end(&other);
}

#endif
