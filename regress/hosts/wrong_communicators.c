/* Communicators that cannot share a simulation, on 2 ranks or more: wrong_communicators DECK prints what each is told,
 * on the first rank, and that the simulation can be shared after that. Status 0: each was refused in a line. */
#include "selas_mpi.h"

#include <stdio.h>
#include <string.h>

static int refused(selas_simulation *sim, MPI_Comm communicator, int tell)
{
    const selas_status status = selas_share(sim, communicator);
    const char *said = selas_last_message(sim), *end = strchr(said, '\n');
    if (tell) printf("%s", said);
    return status == SELAS_BAD_ARGUMENT && end != NULL && end[1] == '\0';
}

int main(int count, char **words)
{
    int me, good = 1;
    selas_simulation *sim = NULL;
    MPI_Comm own, between, freed, copy;
    MPI_Init(&count, &words);
    MPI_Comm_rank(MPI_COMM_WORLD, &me);
    MPI_Comm_split(MPI_COMM_WORLD, me == 0, me, &own);
    MPI_Intercomm_create(own, 0, MPI_COMM_WORLD, me == 0 ? 1 : 0, 1, &between);
    MPI_Comm_dup(MPI_COMM_WORLD, &freed);
    copy = freed;
    MPI_Comm_free(&freed);
    good &= selas_open_deck(count > 1 ? words[1] : "", &sim) == SELAS_OK;
    good &= refused(sim, MPI_COMM_NULL, me == 0);
    good &= refused(sim, between, me == 0);
    good &= refused(sim, copy, me == 0);
    good &= selas_share(sim, MPI_COMM_WORLD) == SELAS_OK && selas_step(sim, 3) == SELAS_OK;
    if (!good) fprintf(stderr, "rank %d: %s", me, selas_message(sim));
    selas_close(&sim);
    MPI_Finalize();
    return good ? 0 : 1;
}
