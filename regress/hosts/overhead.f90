! What it costs to step one step at a time and read a receiver at each: CPU time against one call for all steps, the
! least of several turns each.
!
!   overhead DECK [SPACING [STEPS [TURNS]]]
program overhead
   use, intrinsic :: iso_fortran_env, only: real64
   use selas
   implicit none
   character(256) :: deck, word
   character(32) :: spacing
   integer :: steps, turns, turn
   real(real64) :: together, apart

   call get_command_argument(1, deck)
   call get_command_argument(2, spacing)
   if (spacing == '') spacing = '0.125'
   steps = 100
   call get_command_argument(3, word)
   if (word /= '') read (word, *) steps
   turns = 5
   call get_command_argument(4, word)
   if (word /= '') read (word, *) turns
   together = huge(together)
   apart = huge(apart)
   do turn = 1, turns
      together = min(together, seconds(.false.))
      apart = min(apart, seconds(.true.))
   end do
   print '(a, f9.4, a, f9.4, a, f7.2, a)', 'together ', together, ' s, one by one ', apart, ' s, overhead ', &
      100*(apart/together - 1), ' %'

contains

   real(real64) function seconds(singly)
      logical, intent(in) :: singly
      type(selas_simulation) :: sim
      real(real64) :: start, end, velocity(3)
      character(48) :: override(1)
      integer :: i, status
      override(1) = 'body%spacing='//trim(spacing)
      call sim%open_deck(trim(deck), status, override)
      call sim%step(1, status) ! builds everything
      if (status /= selas_ok) error stop 1
      call cpu_time(start)
      if (singly) then
         do i = 1, steps
            call sim%step(1, status)
            call sim%receiver('r1', selas_velocity, velocity, status)
         end do
      else
         call sim%step(steps, status)
      end if
      call cpu_time(end)
      if (status /= selas_ok) error stop 1
      seconds = end - start
   end function
end program
