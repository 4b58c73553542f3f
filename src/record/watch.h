/* Inside of the watch: watch.c finds that something is wrong, watch_place.c where and why. */
#ifndef SELAS_WATCH_H
#define SELAS_WATCH_H

#include "record/parts.h"

/* Steps from one look at the whole state to the next. */
enum { WATCH_EVERY = 50 };

/* Fails with time, place and likely cause; `what` is wrong: "the state is not finite". */
selas_status watch_tell(const struct recorder *recorder, const struct state *state, const char *what,
                        struct messages *messages);

#endif
