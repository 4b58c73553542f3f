/* selas_mpi.h - a simulation on the ranks of an MPI communicator; link with selas-mpi. doc/howto/ranks.md says what
 * runs there. */
#ifndef SELAS_MPI_H
#define SELAS_MPI_H

#include "selas.h"

#include <mpi.h>

/* Right after the simulation is opened, on all ranks of the communicator, also where opening failed: from now
 * on they share the work. Every call is made by all of them, in the same order and with the same values,
 * selas_close too. The status is that of the first rank that has an error, and the first rank has the message.
 * MPI_THREAD_FUNNELED is needed where there is more than one thread. Errors: that of opening; SELAS_UNSUPPORTED
 * (without MPI), SELAS_BAD_ARGUMENT (before MPI_Init, after a call that made points; on this rank alone: MPI_COMM_NULL,
 * an intercommunicator, a communicator that is freed), SELAS_NO_MEMORY. */
static inline selas_status selas_share(selas_simulation *simulation, MPI_Comm communicator)
{
    return selas_share_handle(simulation, (int)MPI_Comm_c2f(communicator));
}

#endif
