/* What tests of steps in one pass share: a model with its stepper, state and probes. */
#ifndef STEPPED_H
#define STEPPED_H

#include "chance.h"
#include "consistent_run.h"

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

#endif
