# shellcheck shell=sh
# Sets $mpirun: how tests start ranks, more than there are processors and as root if need be, one thread each.
mpirun='mpirun --oversubscribe'
if [ "$(id -u)" = 0 ]; then
    export OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1
fi
# ranks that wait leave the processor to others
export OMPI_MCA_mpi_yield_when_idle=1
export OMP_NUM_THREADS=1
