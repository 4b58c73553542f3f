/* Ranks of a method that deals out places of the body one by one. */
#ifndef SELAS_PARALLEL_FEW_RANKS_H
#define SELAS_PARALLEL_FEW_RANKS_H

#include "parallel/ranks.h"

/* Together: goes on with one rank a place at most, and says so; `what` are the places ("planes over its last axis").
 * SELAS_STOPPED: this rank has nothing to do. SELAS_UNSUPPORTED: a host's communicator has more. */
selas_status ranks_at_most(struct ranks *ranks, size_t places, const char *what, struct messages *messages);

#endif
