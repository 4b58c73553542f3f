! A thin layer for hosts in Fortran 77: external subroutines with names of six letters. SIM is an INTEGER*8 that
! stands for a simulation (0: none; one that was not opened, or is closed, is refused); IERR is a status of selas.h
! (0: success); reals are DOUBLE PRECISION. The table of all of them is in doc/howto/calling.md.
module selas77
   use, intrinsic :: iso_c_binding, only: c_loc
   use, intrinsic :: iso_fortran_env, only: int64, real64
   use selas
   implicit none

   ! The simulations that were opened here; SIM is the address of one. Of one that is closed the address is null, until
   ! the next is opened.
   type :: opened
      type(selas_simulation), pointer :: simulation => null()
      type(opened), pointer :: next => null()
   end type
   type(opened), pointer :: first => null()
contains
   ! A new one; its address goes to SIM.
   function new_simulation(sim) result(made)
      integer(int64), intent(out) :: sim
      type(selas_simulation), pointer :: made
      type(opened), pointer :: entry
      allocate (made)
      entry => first
      do while (associated(entry))
         if (.not. associated(entry%simulation)) exit
         entry => entry%next
      end do
      if (.not. associated(entry)) then
         allocate (entry)
         entry%next => first
         first => entry
      end if
      entry%simulation => made
      sim = transfer(c_loc(made), sim)
   end function

   ! The entry behind a handle, or an unassociated pointer: it was not opened, or is closed.
   function entry_of(sim) result(at)
      integer(int64), intent(in) :: sim
      type(opened), pointer :: at
      integer(int64) :: address
      at => first
      do while (associated(at))
         if (associated(at%simulation)) then
            if (transfer(c_loc(at%simulation), address) == sim) exit
         end if
         at => at%next
      end do
   end function

   function simulation_of(sim) result(found)
      integer(int64), intent(in) :: sim
      type(selas_simulation), pointer :: found
      type(opened), pointer :: at
      found => null()
      at => entry_of(sim)
      if (associated(at)) found => at%simulation
   end function
end module selas77

! Opens a deck file.
subroutine slopen(path, sim, ierr)
   use selas77
   implicit none
   character(*), intent(in) :: path
   integer(int64), intent(out) :: sim
   integer, intent(out) :: ierr
   type(selas_simulation), pointer :: made
   made => new_simulation(sim)
   call made%open_deck(path, ierr)
end subroutine

! A scene with nothing in it, to be made by SLADD and SLSET...
subroutine slnew(name, sim, ierr)
   use selas77
   implicit none
   character(*), intent(in) :: name
   integer(int64), intent(out) :: sim
   integer, intent(out) :: ierr
   type(selas_simulation), pointer :: made
   made => new_simulation(sim)
   call made%open_new(name, ierr)
end subroutine

! Closes a simulation and sets SIM to 0.
subroutine slclos(sim)
   use selas77
   implicit none
   integer(int64), intent(inout) :: sim
   type(opened), pointer :: at
   at => entry_of(sim)
   if (associated(at)) deallocate (at%simulation) ! the final procedure closes it
   sim = 0
end subroutine

! All messages so far, cut to the length of TEXT.
subroutine slmesg(sim, text)
   use selas77
   implicit none
   integer(int64), intent(in) :: sim
   character(*), intent(out) :: text
   type(selas_simulation), pointer :: found
   found => simulation_of(sim)
   text = 'no simulation: SIM was not opened, or is closed'
   if (associated(found)) text = found%message()
end subroutine

! What the last call said, cut to the length of TEXT.
subroutine sllast(sim, text)
   use selas77
   implicit none
   integer(int64), intent(in) :: sim
   character(*), intent(out) :: text
   type(selas_simulation), pointer :: found
   found => simulation_of(sim)
   text = 'no simulation: SIM was not opened, or is closed'
   if (associated(found)) text = found%last_message()
end subroutine

! Time reached, end time and time step; 0 for a handle that is 0.
subroutine sltime(sim, now, end, dt)
   use selas77
   implicit none
   integer(int64), intent(in) :: sim
   real(real64), intent(out) :: now, end, dt
   type(selas_simulation), pointer :: found
   found => simulation_of(sim)
   now = 0
   end = 0
   dt = 0
   if (.not. associated(found)) return
   now = found%time()
   end = found%end_time()
   dt = found%time_step()
end subroutine

! Adds a group; N is its number, from 1.
subroutine sladd(sim, group, n, ierr)
   use selas77
   implicit none
   integer(int64), intent(in) :: sim
   character(*), intent(in) :: group
   integer, intent(out) :: n
   integer, intent(out) :: ierr
   type(selas_simulation), pointer :: found
   found => simulation_of(sim)
   ierr = selas_bad_argument
   n = 0
   if (associated(found)) call found%add(group, n, ierr)
end subroutine

! Sets a word of the deck to N reals (before the first step).
subroutine slsetr(sim, word, n, value, ierr)
   use selas77
   implicit none
   integer(int64), intent(in) :: sim
   character(*), intent(in) :: word
   integer, intent(in) :: n
   real(real64), intent(in) :: value(*)
   integer, intent(out) :: ierr
   type(selas_simulation), pointer :: found
   found => simulation_of(sim)
   ierr = selas_bad_argument
   if (associated(found)) call found%set(word, value(:max(n, 0)), ierr)
end subroutine

! Sets a word of the deck to a text.
subroutine slsetc(sim, word, value, ierr)
   use selas77
   implicit none
   integer(int64), intent(in) :: sim
   character(*), intent(in) :: word, value
   integer, intent(out) :: ierr
   type(selas_simulation), pointer :: found
   found => simulation_of(sim)
   ierr = selas_bad_argument
   if (associated(found)) call found%set(word, value, ierr)
end subroutine

! Sets a word of the deck to an integer.
subroutine slseti(sim, word, value, ierr)
   use selas77
   implicit none
   integer(int64), intent(in) :: sim
   character(*), intent(in) :: word
   integer, intent(in) :: value
   integer, intent(out) :: ierr
   type(selas_simulation), pointer :: found
   found => simulation_of(sim)
   ierr = selas_bad_argument
   if (associated(found)) call found%set(word, value, ierr)
end subroutine

! Sets a word of the deck to a logical.
subroutine slsetl(sim, word, value, ierr)
   use selas77
   implicit none
   integer(int64), intent(in) :: sim
   character(*), intent(in) :: word
   logical, intent(in) :: value
   integer, intent(out) :: ierr
   type(selas_simulation), pointer :: found
   found => simulation_of(sim)
   ierr = selas_bad_argument
   if (associated(found)) call found%set(word, value, ierr)
end subroutine

! Runs to the first step at or past TIME.
subroutine sladvn(sim, time, ierr)
   use selas77
   implicit none
   integer(int64), intent(in) :: sim
   real(real64), intent(in) :: time
   integer, intent(out) :: ierr
   type(selas_simulation), pointer :: found
   found => simulation_of(sim)
   ierr = selas_bad_argument
   if (associated(found)) call found%advance(time, ierr)
end subroutine

! Runs N steps.
subroutine slstep(sim, n, ierr)
   use selas77
   implicit none
   integer(int64), intent(in) :: sim
   integer, intent(in) :: n
   integer, intent(out) :: ierr
   type(selas_simulation), pointer :: found
   found => simulation_of(sim)
   ierr = selas_bad_argument
   if (associated(found)) call found%step(n, ierr)
end subroutine

! Field (0 displacement, 1 velocity, ...) at a receiver into VALUE(6).
subroutine slrecv(sim, name, field, value, ierr)
   use selas77
   implicit none
   integer(int64), intent(in) :: sim
   character(*), intent(in) :: name
   integer, intent(in) :: field
   real(real64), intent(inout) :: value(6)
   integer, intent(out) :: ierr
   type(selas_simulation), pointer :: found
   found => simulation_of(sim)
   ierr = selas_bad_argument
   if (associated(found)) call found%receiver(name, field, value, ierr)
end subroutine

! Holds a load at VALUE from the time reached on.
subroutine slload(sim, load, value, ierr)
   use selas77
   implicit none
   integer(int64), intent(in) :: sim
   character(*), intent(in) :: load
   real(real64), intent(in) :: value
   integer, intent(out) :: ierr
   type(selas_simulation), pointer :: found
   found => simulation_of(sim)
   ierr = selas_bad_argument
   if (associated(found)) call found%set_load(load, value, ierr)
end subroutine

! Mean displacement (0), velocity (1) or acceleration (2) of a load's patch along its direction.
subroutine slmean(sim, load, field, value, ierr)
   use selas77
   implicit none
   integer(int64), intent(in) :: sim
   character(*), intent(in) :: load
   integer, intent(in) :: field
   real(real64), intent(out) :: value
   integer, intent(out) :: ierr
   type(selas_simulation), pointer :: found
   found => simulation_of(sim)
   ierr = selas_bad_argument
   if (associated(found)) call found%load_mean(load, field, value, ierr)
end subroutine

! Mean acceleration of the patch of load MOVED that a unit of the held LOAD makes at once.
subroutine slresp(sim, load, moved, value, ierr)
   use selas77
   implicit none
   integer(int64), intent(in) :: sim
   character(*), intent(in) :: load, moved
   real(real64), intent(out) :: value
   integer, intent(out) :: ierr
   type(selas_simulation), pointer :: found
   found => simulation_of(sim)
   ierr = selas_bad_argument
   if (associated(found)) call found%load_response(load, moved, value, ierr)
end subroutine

! Kinetic and strain energy of the body.
subroutine slener(sim, kinetic, strain, ierr)
   use selas77
   implicit none
   integer(int64), intent(in) :: sim
   real(real64), intent(out) :: kinetic, strain
   integer, intent(out) :: ierr
   type(selas_simulation), pointer :: found
   found => simulation_of(sim)
   ierr = selas_bad_argument
   kinetic = 0
   strain = 0
   if (associated(found)) call found%energy(kinetic, strain, ierr)
end subroutine

! Saves the state in a file.
subroutine slsave(sim, path, ierr)
   use selas77
   implicit none
   integer(int64), intent(in) :: sim
   character(*), intent(in) :: path
   integer, intent(out) :: ierr
   type(selas_simulation), pointer :: found
   found => simulation_of(sim)
   ierr = selas_bad_argument
   if (associated(found)) call found%save(path, ierr)
end subroutine

! Goes on from a file of SLSAVE: before the first step.
subroutine slrest(sim, path, ierr)
   use selas77
   implicit none
   integer(int64), intent(in) :: sim
   character(*), intent(in) :: path
   integer, intent(out) :: ierr
   type(selas_simulation), pointer :: found
   found => simulation_of(sim)
   ierr = selas_bad_argument
   if (associated(found)) call found%restore(path, ierr)
end subroutine

! Finishes the histories.
subroutine slfini(sim, ierr)
   use selas77
   implicit none
   integer(int64), intent(in) :: sim
   integer, intent(out) :: ierr
   type(selas_simulation), pointer :: found
   found => simulation_of(sim)
   ierr = selas_bad_argument
   if (associated(found)) call found%finish(ierr)
end subroutine

! Asks for result files: before the first step.
subroutine slreco(sim, ierr)
   use selas77
   implicit none
   integer(int64), intent(in) :: sim
   integer, intent(out) :: ierr
   type(selas_simulation), pointer :: found
   found => simulation_of(sim)
   ierr = selas_bad_argument
   if (associated(found)) call found%record(ierr)
end subroutine

! Writes all results.
subroutine slwrit(sim, ierr)
   use selas77
   implicit none
   integer(int64), intent(in) :: sim
   integer, intent(out) :: ierr
   type(selas_simulation), pointer :: found
   found => simulation_of(sim)
   ierr = selas_bad_argument
   if (associated(found)) call found%write(ierr)
end subroutine

! Rows of a finished history: N of them, at most ROOM into TIME(ROOM) and VALUE(6, ROOM).
subroutine slhist(sim, name, room, n, time, value, ierr)
   use selas77
   implicit none
   integer(int64), intent(in) :: sim
   character(*), intent(in) :: name
   integer, intent(in) :: room
   integer, intent(out) :: n, ierr
   real(real64), intent(inout) :: time(*), value(6, *)
   type(selas_simulation), pointer :: found
   real(real64), pointer :: times(:), values(:, :)
   integer :: i
   found => simulation_of(sim)
   ierr = selas_bad_argument
   n = 0
   if (.not. associated(found)) return
   call found%history(name, times, values, ierr)
   if (ierr /= selas_ok) return
   n = size(times)
   do i = 1, min(n, room)
      time(i) = times(i)
      value(:, i) = values(:, i)
   end do
end subroutine
