/* Ranks of a method that deals out places of the body one by one; what all have the same. */
#ifndef SELAS_PARALLEL_FEW_RANKS_H
#define SELAS_PARALLEL_FEW_RANKS_H

#include "parallel/ranks.h"

#include <stdint.h>

/* Together: goes on with one rank a place at most, and says so; `what` are the places ("planes over its last axis").
 * SELAS_STOPPED: this rank has nothing to do. SELAS_UNSUPPORTED: a host's communicator has more. */
selas_status ranks_at_most(struct ranks *ranks, size_t places, const char *what, struct messages *messages);

/* Deals out places in their order, one each at least, by what they cost (any unit, >= 0): rank r has
 * bound[r] .. bound[r + 1] - 1. There are at least as many places as ranks. */
void ranks_deal(size_t places, double (*cost)(const void *context, size_t place), const void *context,
                size_t ranks, size_t *bound);

/* Together: is the number the same on all? */
bool ranks_same(struct ranks *ranks, uint64_t number);

/* Seconds of a byte and of a message that the models of cost assume (doc/developers/ranks.md). */
#define RANKS_BYTE 5e-10
#define RANKS_MESSAGE 2e-6
/* What the shares of the ranks let expect by these models: mean over largest work, and seconds of one process over
 * ranks times those of the longest rank. */
struct ranks_outlook {
    double balance, efficiency;
};
/* Together: from the work (any unit, > 0) and the seconds of this rank, and the seconds of one process. */
struct ranks_outlook ranks_look_ahead(struct ranks *ranks, double work, double seconds, double alone);
/* Of the plan; `with` names the measured times. */
void ranks_tell_outlook(const struct ranks_outlook *outlook, const char *with,
                        void (*tell)(void *context, const char *key, const char *value), void *context);

#endif
