/* Ranks of a program without MPI: there is one. */
#include "parallel/files.h"

struct ranks *ranks_begin(void)
{
    return NULL;
}

void ranks_end(struct ranks **ranks)
{
    (void)ranks;
}

selas_status ranks_join(int communicator, struct ranks **ranks, struct messages *messages)
{
    (void)communicator;
    *ranks = NULL;
    return fail(messages, SELAS_UNSUPPORTED,
                "this library has no MPI: a host with a communicator is linked with selas-mpi (make mpi)");
}

void ranks_leave(struct ranks **ranks)
{
    *ranks = NULL;
}

bool ranks_fixed(const struct ranks *ranks)
{
    (void)ranks;
    return false;
}

int ranks_me(const struct ranks *ranks)
{
    (void)ranks;
    return 0;
}

int ranks_count(const struct ranks *ranks)
{
    (void)ranks;
    return 1;
}

void ranks_take(struct ranks *ranks, int count)
{
    (void)ranks;
    (void)count;
}

bool ranks_idle(const struct ranks *ranks)
{
    (void)ranks;
    return false;
}

void ranks_largest(struct ranks *ranks, size_t n, double *value)
{
    (void)ranks;
    (void)n;
    (void)value;
}

void ranks_sum(struct ranks *ranks, size_t n, double *value)
{
    (void)ranks;
    (void)n;
    (void)value;
}

void ranks_spread(struct ranks *ranks, int from, void *data, size_t bytes)
{
    (void)ranks;
    (void)from;
    (void)data;
    (void)bytes;
}

void ranks_depart(struct ranks *ranks, size_t pieces, const struct ranks_piece *piece)
{
    (void)ranks;
    (void)pieces;
    (void)piece;
}

void ranks_go_on(struct ranks *ranks)
{
    (void)ranks;
}

void ranks_arrive(struct ranks *ranks)
{
    (void)ranks;
}

double ranks_sent(const struct ranks *ranks)
{
    (void)ranks;
    return 0;
}

double ranks_waited(const struct ranks *ranks)
{
    (void)ranks;
    return 0;
}

selas_status ranks_agree(struct ranks *ranks, selas_status status, struct messages *messages)
{
    (void)ranks;
    (void)messages;
    return status;
}

void ranks_abort(struct ranks *ranks, int exit_status)
{
    (void)ranks;
    (void)exit_status;
}

void ranks_open_together(const struct ranks *ranks, hid_t access)
{
    (void)ranks;
    (void)access;
}
