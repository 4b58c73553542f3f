/* Ranks of a program with MPI (MPI standard 3.1). A message is at most 1 GiB, so that counts are ints. */
#include "parallel/files.h"

#include "base/memory.h"

#include <mpi.h>
#include <sched.h>
#include <stdio.h>
#include <string.h>

#ifndef H5_HAVE_PARALLEL
#error                                                                                                       \
    "this HDF5 has no MPI: `make setup-mpi`, or name pkg-config's package of one that has: `make mpi MPI_HDF5=...`"
#endif

enum { LONGEST = 1 << 30, MOST_REQUESTS = 512 };

struct ranks {
    MPI_Comm comm; /* MPI_COMM_NULL: idle */
    int me, count;
    bool fixed; /* the communicator is a host's */
    double sent, waited;
    size_t told; /* bytes of this rank's messages that the first one has */
    int under_way;
    MPI_Request request[MOST_REQUESTS];
    MPI_Status status[MOST_REQUESTS]; /* not looked at: gcc warns of MPICH's MPI_STATUSES_IGNORE */
};

static int length_of(size_t left)
{
    return (int)(left < LONGEST ? left : LONGEST);
}

/* Waits for all of them, and lets other processes have the processor meanwhile: MPICH (4.0) would keep it, so that
 * with more ranks than processors those waited for come too late. */
static void wait_for(int count, MPI_Request *request, MPI_Status *status)
{
    for (int all = 0; !all;) {
        MPI_Testall(count, request, &all, status);
        if (!all) sched_yield();
    }
}

static void wait_for_one(MPI_Request request)
{
    MPI_Status status;
    wait_for(1, &request, &status);
}

struct ranks *ranks_begin(void)
{
    int threads, count;
    MPI_Init_thread(NULL, NULL, MPI_THREAD_FUNNELED, &threads);
    MPI_Comm_size(MPI_COMM_WORLD, &count);
    if (count == 1) return NULL;
    struct ranks *ranks = array_new(1, sizeof *ranks);
    if (ranks == NULL) MPI_Abort(MPI_COMM_WORLD, 1);
    MPI_Comm_dup(MPI_COMM_WORLD, &ranks->comm);
    MPI_Comm_rank(ranks->comm, &ranks->me);
    ranks->count = count;
    return ranks;
}

void ranks_end(struct ranks **ended)
{
    struct ranks *ranks = *ended;
    if (ranks != NULL && ranks->comm != MPI_COMM_NULL) MPI_Comm_free(&ranks->comm);
    array_free(ranks);
    *ended = NULL;
    MPI_Request all_ended; /* a failed rank that ends ends the others, who may have more to say */
    MPI_Ibarrier(MPI_COMM_WORLD, &all_ended);
    wait_for_one(all_ended);
    MPI_Finalize();
}

/* What is wrong with a host's communicator, or NULL and its size. Calls with one that is none ask the handler of
 * MPI_COMM_WORLD what to do. */
static const char *wrong_with(MPI_Comm comm, int *count)
{
    MPI_Errhandler handler;
    int between = 0;
    if (comm == MPI_COMM_NULL)
        return "the communicator is MPI_COMM_NULL: this rank is not in it, and takes no part in the "
               "simulation";
    MPI_Comm_get_errhandler(MPI_COMM_WORLD, &handler);
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, MPI_ERRORS_RETURN);
    const bool sound =
        MPI_Comm_test_inter(comm, &between) == MPI_SUCCESS && MPI_Comm_size(comm, count) == MPI_SUCCESS;
    MPI_Comm_set_errhandler(MPI_COMM_WORLD, handler);
    MPI_Errhandler_free(&handler);
    if (!sound) return "the communicator is none, or is freed: one that lives would be right";
    return between ? "the communicator joins two groups: an intracommunicator (MPI_Intercomm_merge) would be "
                     "right"
                   : NULL;
}

selas_status ranks_join(int communicator, struct ranks **joined, struct messages *messages)
{
    int begun = 0, ended = 0, count = 1;
    *joined = NULL;
    MPI_Initialized(&begun);
    MPI_Finalized(&ended);
    if (!begun || ended)
        return fail(messages, SELAS_BAD_ARGUMENT, "a communicator lives between MPI_Init and MPI_Finalize");
    const MPI_Comm comm = MPI_Comm_f2c(communicator);
    const char *wrong = wrong_with(comm, &count);
    if (wrong != NULL) return fail(messages, SELAS_BAD_ARGUMENT, "%s", wrong);
    if (count == 1) return SELAS_OK;
    struct ranks *ranks = array_new(1, sizeof *ranks);
    if (ranks == NULL) return fail(messages, SELAS_NO_MEMORY, "no memory for the ranks");
    MPI_Comm_dup(comm, &ranks->comm);
    MPI_Comm_rank(ranks->comm, &ranks->me);
    ranks->count = count;
    ranks->fixed = true;
    *joined = ranks;
    return SELAS_OK;
}

void ranks_leave(struct ranks **left)
{
    if (*left == NULL) return;
    MPI_Comm_free(&(*left)->comm);
    array_free(*left);
    *left = NULL;
}

bool ranks_fixed(const struct ranks *ranks)
{
    return ranks != NULL && ranks->fixed;
}

int ranks_me(const struct ranks *ranks)
{
    return ranks == NULL ? 0 : ranks->me;
}

int ranks_count(const struct ranks *ranks)
{
    return ranks == NULL ? 1 : ranks->count;
}

void ranks_take(struct ranks *ranks, int count)
{
    if (ranks == NULL || ranks->count <= count) return;
    MPI_Comm part;
    MPI_Comm_split(ranks->comm, ranks->me < count ? 0 : MPI_UNDEFINED, ranks->me, &part);
    MPI_Comm_free(&ranks->comm);
    ranks->comm = part;
    ranks->count = count;
}

bool ranks_idle(const struct ranks *ranks)
{
    return ranks != NULL && ranks->comm == MPI_COMM_NULL;
}

static void reduce(struct ranks *ranks, size_t n, double *value, MPI_Op operation)
{
    if (ranks == NULL) return;
    const double begun = MPI_Wtime();
    MPI_Request reduced;
    MPI_Iallreduce(MPI_IN_PLACE, value, (int)n, MPI_DOUBLE, operation, ranks->comm, &reduced);
    wait_for_one(reduced);
    ranks->waited += MPI_Wtime() - begun;
}

void ranks_largest(struct ranks *ranks, size_t n, double *value)
{
    reduce(ranks, n, value, MPI_MAX);
}

void ranks_sum(struct ranks *ranks, size_t n, double *value)
{
    reduce(ranks, n, value, MPI_SUM);
}

void ranks_spread(struct ranks *ranks, int from, void *data, size_t bytes)
{
    for (size_t at = 0; ranks != NULL && at < bytes; at += LONGEST) {
        MPI_Request spread;
        MPI_Ibcast((char *)data + at, length_of(bytes - at), MPI_BYTE, from, ranks->comm, &spread);
        wait_for_one(spread);
    }
}

static MPI_Request *next(struct ranks *ranks)
{
    if (ranks->under_way == MOST_REQUESTS) MPI_Abort(ranks->comm, 1); /* hundreds of GiB at once */
    return &ranks->request[ranks->under_way++];
}

void ranks_depart(struct ranks *ranks, size_t pieces, const struct ranks_piece *piece)
{
    if (ranks == NULL) return;
    const double begun = MPI_Wtime();
    for (size_t p = 0; p < pieces; p++)
        for (size_t at = 0; at < piece[p].receive_bytes; at += LONGEST)
            MPI_Irecv((char *)piece[p].receive + at, length_of(piece[p].receive_bytes - at), MPI_BYTE,
                      piece[p].with, 0, ranks->comm, next(ranks));
    for (size_t p = 0; p < pieces; p++) {
        for (size_t at = 0; at < piece[p].send_bytes; at += LONGEST)
            MPI_Isend((const char *)piece[p].send + at, length_of(piece[p].send_bytes - at), MPI_BYTE,
                      piece[p].with, 0, ranks->comm, next(ranks));
        ranks->sent += (double)piece[p].send_bytes;
    }
    ranks->waited += MPI_Wtime() - begun;
}

void ranks_go_on(struct ranks *ranks)
{
    int all;
    if (ranks == NULL || ranks->under_way == 0) return;
    MPI_Testall(ranks->under_way, ranks->request, &all, ranks->status);
    if (all) ranks->under_way = 0;
}

void ranks_arrive(struct ranks *ranks)
{
    if (ranks == NULL) return;
    const double begun = MPI_Wtime();
    wait_for(ranks->under_way, ranks->request, ranks->status);
    ranks->under_way = 0;
    ranks->waited += MPI_Wtime() - begun;
}

double ranks_sent(const struct ranks *ranks)
{
    return ranks == NULL ? 0 : ranks->sent;
}

double ranks_waited(const struct ranks *ranks)
{
    return ranks == NULL ? 0 : ranks->waited;
}

/* Warnings that all ranks have are told once. */
static void add_lines(struct messages *messages, char *text)
{
    char *rest;
    for (const char *line = strtok_r(text, "\n", &rest); line != NULL; line = strtok_r(NULL, "\n", &rest)) {
        const bool is_error = strstr(line, "error: ") != NULL;
        messages_add(messages, is_error, !is_error, line);
    }
}

/* The text of another rank's messages, for the first one: what it has not got before. */
static void take_messages(struct ranks *ranks, int from, struct messages *messages)
{
    unsigned long size = messages->text == NULL ? 0 : messages->length - ranks->told;
    char named[64];
    ranks_spread(ranks, from, &size, sizeof size);
    char *text = array_new(size + 1, 1);
    if (text == NULL) MPI_Abort(ranks->comm, 1);
    if (ranks->me == from && size > 0) memcpy(text, messages->text + ranks->told, size);
    if (ranks->me == from) ranks->told += size;
    ranks_spread(ranks, from, text, size);
    snprintf(named, sizeof named, "on rank %d of %d:", from, ranks->count);
    if (ranks->me == 0 && size > 0) {
        messages_add(messages, false, false, named);
        add_lines(messages, text);
    }
    array_free(text);
}

selas_status ranks_agree(struct ranks *ranks, selas_status status, struct messages *messages)
{
    if (ranks == NULL || ranks_idle(ranks)) return status;
    int first = status == SELAS_OK ? ranks->count : ranks->me, agreed = (int)status;
    MPI_Request reduced;
    MPI_Iallreduce(MPI_IN_PLACE, &first, 1, MPI_INT, MPI_MIN, ranks->comm, &reduced);
    wait_for_one(reduced);
    if (first == ranks->count) return SELAS_OK;
    ranks_spread(ranks, first, &agreed, sizeof agreed);
    if (first > 0 && messages != NULL) take_messages(ranks, first, messages);
    return (selas_status)agreed;
}

void ranks_abort(struct ranks *ranks, int exit_status)
{
    if (ranks != NULL && !ranks_idle(ranks)) MPI_Abort(ranks->comm, exit_status);
}

void ranks_open_together(const struct ranks *ranks, hid_t access)
{
    if (ranks == NULL) return;
    H5Pset_fapl_mpio(access, ranks->comm, MPI_INFO_NULL);
    H5Pset_all_coll_metadata_ops(access, true);
    H5Pset_coll_metadata_write(access, true);
}
