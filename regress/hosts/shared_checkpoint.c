/* Host: ranks that save what they share: shared_checkpoint TO FROM STEPS DECK WORDS... goes on from the checkpoint FROM
 * ("-": begins), makes STEPS steps more and saves; prints seconds, how much longer the longest rank has known memory,
 * and bytes. The last of several ranks of MPI_COMM_WORLD has no part in it if SELAS_SPARE is set. */
#include "selas_mpi.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/resource.h>
#include <sys/stat.h>

/* KB, of the rank that had most. */
static long most_memory(MPI_Comm comm)
{
    struct rusage usage;
    getrusage(RUSAGE_SELF, &usage);
    long most = usage.ru_maxrss;
    MPI_Allreduce(MPI_IN_PLACE, &most, 1, MPI_LONG, MPI_MAX, comm);
    return most;
}

static selas_status run(selas_simulation *sim, MPI_Comm comm, char **words)
{
    selas_status status = selas_share(sim, comm);
    if (status == SELAS_OK && strcmp(words[2], "-") != 0) status = selas_restore(sim, words[2]);
    if (status == SELAS_OK) status = selas_step(sim, strtoul(words[3], NULL, 10));
    const long before = most_memory(comm);
    const double begun = MPI_Wtime();
    if (status == SELAS_OK) status = selas_save(sim, words[1]);
    const double seconds = MPI_Wtime() - begun;
    const long after = most_memory(comm);
    struct stat about = {0};
    int me;
    MPI_Comm_rank(comm, &me);
    if (status == SELAS_OK && me == 0 && stat(words[1], &about) == 0)
        printf("saved in %.3f s, %lld bytes, memory %ld KB, before %ld KB\n", seconds,
               (long long)about.st_size, after, before);
    if (status != SELAS_OK && me == 0) fprintf(stderr, "%s", selas_message(sim));
    return status;
}

int main(int count, char **words)
{
    int provided, me, ranks;
    selas_simulation *sim = NULL;
    selas_status status = SELAS_OK;
    MPI_Comm comm;
    MPI_Init_thread(&count, &words, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &me);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    const int spare = getenv("SELAS_SPARE") != NULL && me == ranks - 1;
    MPI_Comm_split(MPI_COMM_WORLD, spare, 0, &comm);
    if (count > 4 && !spare) {
        selas_open_deck_with(words[4], (size_t)count - 5, (const char *const *)words + 5, &sim);
        status = run(sim, comm, words);
        selas_close(&sim);
    }
    MPI_Comm_free(&comm);
    MPI_Finalize();
    return status == SELAS_OK ? 0 : 1;
}
