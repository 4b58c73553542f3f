! Handles that are none: a simulation copied by assignment, and numbers of Fortran 77 that were never opened, or are closed.
! Each is refused; the simulation copied from goes on. Argument: a deck. Ends with 0 if all was so.
program wrong_handles
   use, intrinsic :: iso_fortran_env, only: int64, real64
   use selas
   implicit none
   type(selas_simulation) :: first, second, many(2)
   character(200) :: deck, text
   integer(int64) :: sim, copy
   integer :: status
   real(real64) :: now, ending, dt
   call get_command_argument(1, deck)
   call first%open_deck(trim(deck))
   second = first
   many = first
   if (second%status() /= selas_bad_argument .or. index(second%message(), 'cannot be copied') == 0) error stop 1
   call second%step(1, status)
   if (status == selas_ok .or. many(2)%status() /= selas_bad_argument) error stop 2
   first = first
   call first%step(2, status)
   if (status /= selas_ok .or. first%steps() /= 2) error stop 3
   call second%open_deck(trim(deck), status)
   if (status /= selas_ok .or. second%status() /= selas_ok) error stop 4

   sim = 123456789_int64
   call slstep(sim, 1, status)
   if (status /= selas_bad_argument) error stop 5
   call slopen(trim(deck), sim, status)
   if (status /= selas_ok) error stop 6
   copy = sim
   call slstep(sim, 1, status)
   if (status /= selas_ok) error stop 7
   call slclos(sim)
   call slstep(copy, 1, status)
   if (status /= selas_bad_argument) error stop 8
   call sltime(copy, now, ending, dt)
   call slmesg(copy, text)
   if (abs(dt) > 0 .or. index(text, 'is closed') == 0) error stop 9
   call slclos(copy)
end program
