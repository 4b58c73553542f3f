/* Inside of the watch: watch.c finds that something is wrong, watch_place.c where and why. */
#ifndef SELAS_WATCH_H
#define SELAS_WATCH_H

#include "record/parts.h"

/* Steps from one look at the whole state to the next: more where that costs more. */
enum { WATCH_EVERY = 50 };
static inline unsigned long watch_every(const struct model *model)
{
    return WATCH_EVERY * (unsigned long)(model->energy_calls > 1 ? model->energy_calls : 1);
}

/* Energy that can have been given by a time: at the start, by loads, and by moved faces (of that order). */
static inline double watch_given(const struct watch *watch, double time)
{
    const double later = 1.0 + watch->face_rate * time;
    return watch->initial + watch->gross + watch->face_energy * later * later;
}

/* Fails with time, place and likely cause; `what` is wrong: "the state is not finite". */
selas_status watch_tell(const struct recorder *recorder, const struct state *state, const char *what,
                        struct messages *messages);

/* hindsight.c: places of the body at which rotations are looked at, if it matters; each step, `settled` if all of the
 * state is right; warns at end_time. */
selas_status hindsight_create(struct recorder *recorder, struct messages *messages);
void hindsight_observe(struct recorder *recorder, const struct state *state, bool settled,
                       struct messages *messages);
/* The warnings, as told to the report. */
void hindsight_tell(const struct recorder *recorder,
                    void (*tell)(void *context, const char *key, const char *value), void *context);
void hindsight_free(struct recorder *recorder);

#endif
