! Host 4: ranks that share a column of ground, coupled both ways. At every step the host reads the mean velocity V under the first
! load and presses with P = F(t) - C V, a push through a dashpot; all ranks do the same. Prints what each rank sees: the same for
! any number of ranks. With `use mpi` in place of `use mpi_f08` the communicator is MPI_COMM_WORLD itself.
!
!   mpirun -n 3 coupled_ranks DECK
program coupled_ranks
   use, intrinsic :: iso_fortran_env, only: real64, error_unit
   use mpi_f08
   use selas
   implicit none
   integer, parameter :: r = real64
   real(r), parameter :: dashpot = 0.5_r, width = 0.4_r, late = 1.6_r
   type(selas_simulation) :: sim
   character(512) :: deck
   real(r) :: velocity, top(3), far(3), work
   integer :: code, me, provided

   call get_command_argument(1, deck)
   call MPI_Init_thread(MPI_THREAD_FUNNELED, provided, code)
   call MPI_Comm_rank(MPI_COMM_WORLD, me, code)
   call sim%open_deck(trim(deck), status=code, comm=MPI_COMM_WORLD%mpi_val)
   if (code /= selas_ok) call stop_all()
   work = 0
   call sim%set_load('1', 0.0_r, code)              ! from now on the host holds it
   do while (sim%time() < sim%end_time() .and. code == selas_ok)
      call sim%load_mean('1', selas_velocity, velocity, code)
      if (code == selas_ok) call sim%set_load('1', push(sim%time()) - dashpot*velocity, code)
      work = work + velocity*(push(sim%time()) - dashpot*velocity)*sim%time_step()
      if (code == selas_ok) call sim%step(status=code)
   end do
   if (code == selas_ok) call sim%receiver('top', selas_displacement, top, code)
   if (code == selas_ok) call sim%receiver('lower', selas_displacement, far, code)
   if (code /= selas_ok) call stop_all()
   print '(a, i0, a, 7es24.16)', 'rank ', me, ':', top, far, work
   call sim%close()
   call MPI_Finalize(code)
contains

   real(r) function push(t)
      real(r), intent(in) :: t
      push = exp(-((t - late)/width)**2)
   end function

   subroutine stop_all()
      if (me == 0) write (error_unit, '(a)') sim%message()
      call sim%close()
      call MPI_Finalize(code)
      stop 1
   end subroutine
end program
