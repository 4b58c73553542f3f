/* Host 5: ranks that share a column of ground: shared_column DECK prints what each rank sees at the receiver
 * 'lower'. shared_column DECK VALUE: the last rank, and it alone, holds the first load at VALUE after ten steps. */
#include "selas_mpi.h"

#include <stdio.h>
#include <stdlib.h>

int main(int count, char **words)
{
    int provided, me, ranks;
    double u[3] = {0}, kinetic = 0, strain = 0;
    selas_simulation *sim = NULL;
    MPI_Init_thread(&count, &words, MPI_THREAD_FUNNELED, &provided);
    MPI_Comm_rank(MPI_COMM_WORLD, &me);
    selas_open_deck(count > 1 ? words[1] : "", &sim);
    selas_status status = selas_share(sim, MPI_COMM_WORLD);
    MPI_Comm_size(MPI_COMM_WORLD, &ranks);
    if (status == SELAS_OK && count > 2) status = selas_set_load(sim, "1", 0);
    if (status == SELAS_OK && count > 2) status = selas_step(sim, 10);
    if (status == SELAS_OK && count > 2)
        status = selas_set_load(sim, "1", me + 1 == ranks ? strtod(words[2], NULL) : 0);
    if (status == SELAS_OK) status = selas_advance(sim, selas_end_time(sim));
    if (status == SELAS_OK) status = selas_energy(sim, &kinetic, &strain);
    if (status == SELAS_OK) status = selas_receiver(sim, "lower", SELAS_DISPLACEMENT, u);
    if (status == SELAS_OK)
        printf("rank %d: %.17g %.17g %.17g %.9g\n", me, u[0], u[1], u[2], kinetic + strain);
    if (status != SELAS_OK && me == 0) fprintf(stderr, "%s", selas_message(sim));
    selas_close(&sim);
    MPI_Finalize();
    return status == SELAS_OK ? 0 : 1;
}
