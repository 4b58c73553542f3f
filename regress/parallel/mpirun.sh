# shellcheck shell=sh
# Sets $mpirun: how tests start ranks, more than there are processors and as root if need be, one thread each; $mpicc and
# $mpifc: compilers of hosts. MPI=mpich: those of MPICH by Debian's names.
mpirun='mpirun --oversubscribe' mpicc=mpicc mpifc=mpif90
if [ "${MPI:-}" = mpich ]; then
    mpirun=mpirun.mpich mpicc=mpicc.mpich mpifc=mpif90.mpich
fi
if [ "$(id -u)" = 0 ]; then
    export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
fi
# ranks that wait leave the processor to others
export OMPI_MCA_mpi_yield_when_idle=1
export OMP_NUM_THREADS=1
# a rank killed in MPI_Init must not leave a lock behind that the launcher waits for forever (openpmix issue 1233)
export PMIX_MCA_gds=hash
