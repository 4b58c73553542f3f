! Host 1: the scene of input/halfspace.nml by calls only, and its finished histories held bit for bit against
! those that the program left.
!
!   halfspace_by_calls FOLDER [SPACING]     FOLDER: what `selas input/halfspace.nml body%spacing=SPACING` left
program halfspace_by_calls
   use, intrinsic :: iso_fortran_env, only: real64, error_unit
   use selas
   implicit none
   character(*), parameter :: name(3) = [character(6) :: 'centre', 'r1', 'r2']
   real(real64), parameter :: place(3) = [0.0_real64, 1.0_real64, 2.0_real64]
   type(selas_simulation) :: sim
   character(256) :: folder, word
   real(real64) :: spacing
   integer :: i, different, rows

   call get_command_argument(1, folder)
   call get_command_argument(2, word)
   spacing = 0.125_real64
   if (word /= '') read (word, *) spacing

   call describe_scene()
   if (sim%status() /= selas_ok) call complain('the scene')
   do while (sim%steps() < sim%steps_needed()) ! one step at a time, as a host with work of its own would
      call sim%step()
      if (sim%status() /= selas_ok) call complain('the run')
   end do
   call sim%finish()
   if (sim%status() /= selas_ok) call complain('the histories')
   do i = 1, 3
      call compare(trim(name(i)), rows, different)
      print '(a, a, i0, a, i0, a)', trim(name(i)), ': ', rows, ' rows, ', different, ' numbers differ'
      if (different > 0 .or. rows < 2) error stop 1
   end do
   call sim%close()

contains

   subroutine describe_scene()
      real(real64), parameter :: down(3) = [0.0_real64, 0.0_real64, 1.0_real64]
      character(32) :: receiver
      integer :: k, number
      call sim%open_new('halfspace-by-calls')
      call sim%set('scene%dimension', 3)
      call sim%set('scene%end_time', 6.0_real64)
      call sim%set('method%name', 'smoothed-point')
      call sim%set('method%variant', 'consistent')
      call sim%set('stepping%scheme', 'leapfrog')
      call sim%set('method%degree', 4)
      call sim%set('method%mass', 'exact')
      call sim%set('method%tuned', .true.)
      call sim%set('output%low_pass', 30.0_real64)
      call sim%add('material')
      call sim%set('material%name', 'rock')
      call sim%set('material%density', 1.0_real64)
      call sim%set('material%lambda', 1.0_real64)
      call sim%set('material%mu', 1.0_real64)
      call sim%add('body')
      call sim%set('body%name', 'ground')
      call sim%set('body%material', 'rock')
      call sim%set('body%shape', 'half-space')
      call sim%set('body%spacing', spacing)
      call sim%add('load')
      call sim%set('load%face', 'z-')
      call sim%set('load%shape', 'square')
      call sim%set('load%centre', [0.0_real64, 0.0_real64, 0.0_real64])
      call sim%set('load%size', [1.0_real64, 1.0_real64])
      call sim%set('load%direction', down)
      call sim%set('load%amplitude', 1.0_real64)
      call sim%set('load%history', 'triangle')
      call sim%set('load%duration', 2.0_real64)
      do k = 1, 3
         call sim%add('receiver', number)
         write (receiver, '(a, i0, a)') 'receiver(', number, ')%'
         call sim%set(trim(receiver)//'name', name(k))
         call sim%set(trim(receiver)//'position', [place(k), 0.0_real64, 0.0_real64])
      end do
      call sim%add('snapshot') ! what is looked at belongs to the scene: the box is fitted to it
      call sim%set('snapshot%times', [1.5_real64, 3.0_real64, 4.5_real64])
      call sim%set('snapshot%fields', 'velocity')
      call sim%set('snapshot%region', [-3.5_real64, -3.5_real64, 0.0_real64, 3.5_real64, 3.5_real64, 3.5_real64])
      call sim%build()
   end subroutine

   ! Numbers of NAME.dat are written with 17 digits, so that what is read is what was computed.
   subroutine compare(receiver, rows, different)
      character(*), intent(in) :: receiver
      integer, intent(out) :: rows, different
      real(real64), pointer :: time(:), value(:, :)
      real(real64) :: line(7)
      character(400) :: text
      integer :: file, ios
      call sim%history(receiver, time, value)
      rows = 0
      different = 0
      open (newunit=file, file=trim(folder)//'/'//receiver//'.dat', status='old', action='read')
      do
         read (file, '(a)', iostat=ios) text
         if (ios /= 0) exit
         if (text(1:1) == '#') cycle
         read (text, *) line
         rows = rows + 1
         if (rows > size(time)) exit
         different = different + count(line /= [time(rows), value(:, rows)])
      end do
      close (file)
      if (rows /= size(time)) different = different + abs(rows - size(time))
   end subroutine

   subroutine complain(what)
      character(*), intent(in) :: what
      write (error_unit, '(a)') what//': '//sim%message()
      error stop 1
   end subroutine
end program
