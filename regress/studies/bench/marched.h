/* A scene that is marched from noise, for benches of steps. */
#ifndef MARCHED_H
#define MARCHED_H

#include "base/memory.h"
#include "from_deck.h"
#include "method/methods.h"
#include "stepping/schemes.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

struct marched {
    struct from_deck from;
    struct stepper stepper;
    struct state state;
};

static inline double now(void)
{
    struct timespec time;
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
    return (double)time.tv_sec + 1e-9 * (double)time.tv_nsec;
}

static inline void stop(const char *text)
{
    fputs(text != NULL ? text : "no memory\n", stderr);
    exit(1);
}

/* Leapfrog with steps of .1 on a deck, from displacements drawn by chance; of mirrored bodies what is computed. */
static inline void open_marched(struct marched *marched, const char *text)
{
    struct messages messages = {0};
    struct model *model = NULL;
    marched->from = from_text(text, 0, NULL);
    if (marched->from.scene == NULL) stop(marched->from.messages.text);
    if (model_create(marched->from.scene, &model, &messages) != SELAS_OK) stop(messages.text);
    model = model_computed(model);
    marched->stepper = (struct stepper){.scheme = &scheme_leapfrog, .model = model, .dt = .1};
    marched->state = (struct state){.y = array_new(model->state_size, sizeof(double)),
                                    .a = array_new(model->unknowns, sizeof(double))};
    if (marched->state.y == NULL || marched->state.a == NULL) stop(NULL);
    if (driver_create(&marched->stepper.driver, marched->from.scene, marched->stepper.dt, &messages) !=
        SELAS_OK)
        stop(messages.text);
    uint64_t seed = 7;
    for (size_t i = 0; i < model->unknowns; i++) {
        seed = seed * 6364136223846793005u + 1442695040888963407u;
        marched->state.y[i] = (double)(seed >> 11) * 0x1p-52 - 1;
    }
    scheme_leapfrog.start(&marched->stepper, &marched->state);
}

static inline void step_marched(struct marched *marched)
{
    scheme_leapfrog.step(&marched->stepper, &marched->state);
}

#endif
