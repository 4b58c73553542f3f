/* Ranks: processes that share one body, each with a part of it. A pointer that is NULL stands for a process
 * alone, and every function takes it. Two files have these functions: alone.c, which plain programs are linked
 * with, and mpi.c in its place where MPI is (make mpi). All ranks call the functions marked "together", in the
 * same order. */
#ifndef SELAS_PARALLEL_RANKS_H
#define SELAS_PARALLEL_RANKS_H

#include "base/messages.h"

struct ranks;

/* What goes to one rank and comes from it in an exchange; no bytes: nothing. */
struct ranks_piece {
    int with;
    const void *send;
    void *receive;
    size_t send_bytes, receive_bytes;
};

/* First and last thing of a program. NULL: this process is alone. */
struct ranks *ranks_begin(void);
void ranks_end(struct ranks **ranks);

/* Together: those of a host's communicator (its Fortran handle), which stay as many as they are. NULL: there is one.
 * SELAS_UNSUPPORTED without MPI, SELAS_BAD_ARGUMENT before MPI_Init, SELAS_NO_MEMORY. */
selas_status ranks_join(int communicator, struct ranks **ranks, struct messages *messages);
void ranks_leave(struct ranks **ranks); /* together; NULL is fine */
bool ranks_fixed(const struct ranks *ranks);

int ranks_me(const struct ranks *ranks);
int ranks_count(const struct ranks *ranks); /* 1: alone */
/* The first one speaks to the user and writes the files. */
static inline bool ranks_first(const struct ranks *ranks)
{
    return ranks_me(ranks) == 0;
}

/* Together: the first `count` go on, the others have nothing to do (ranks_idle) and call no function but
 * ranks_end() any more. */
void ranks_take(struct ranks *ranks, int count);
bool ranks_idle(const struct ranks *ranks);

/* Together: each number becomes the largest, or the sum, of those of all ranks. Sums may hang on their number by
 * rounding. */
void ranks_largest(struct ranks *ranks, size_t n, double *value);
void ranks_sum(struct ranks *ranks, size_t n, double *value);
/* Together: what rank `from` has, for all. */
void ranks_spread(struct ranks *ranks, int from, void *data, size_t bytes);

/* Begins to send and receive; two ranks name the pieces between them in the same order. What is sent stays as it is,
 * and what is received is not looked at, until ranks_arrive() has waited for all that is under way. MPI may need to be
 * called for messages to go on: ranks_go_on(), by the thread that began. Counts the bytes sent. */
void ranks_depart(struct ranks *ranks, size_t pieces, const struct ranks_piece *piece);
void ranks_go_on(struct ranks *ranks);
void ranks_arrive(struct ranks *ranks);
static inline void ranks_exchange(struct ranks *ranks, size_t pieces, const struct ranks_piece *piece)
{
    ranks_depart(ranks, pieces, piece);
    ranks_arrive(ranks);
}
/* The first rank gets what rank `from` has there; others, and what is the first one's own: nothing to do. */
static inline void ranks_fetch(struct ranks *ranks, int from, void *data, size_t bytes)
{
    const struct ranks_piece get = {.with = from, .receive = data, .receive_bytes = bytes};
    const struct ranks_piece give = {.with = 0, .send = data, .send_bytes = bytes};
    if (from > 0 && ranks_first(ranks)) ranks_exchange(ranks, 1, &get);
    if (from > 0 && ranks_me(ranks) == from) ranks_exchange(ranks, 1, &give);
}
double ranks_sent(const struct ranks *ranks);   /* bytes, by this rank */
double ranks_waited(const struct ranks *ranks); /* seconds, for others and for what they send */

/* Together: the first failure (by rank) is that of all, and its messages (NULL: none) reach the first rank. */
selas_status ranks_agree(struct ranks *ranks, selas_status status, struct messages *messages);
/* Ends all ranks, for what only this one knows. Does not come back where there are others. */
void ranks_abort(struct ranks *ranks, int exit_status);

#endif
