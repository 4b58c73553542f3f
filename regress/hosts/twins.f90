! The Fortran twin of regress/unit/test_api.c: every procedure of the module once, rightly and wrongly; prints TAP.
module twin_functions
   use, intrinsic :: iso_fortran_env, only: real64
   use selas
   implicit none
   type :: counter
      integer :: calls = 0, answer = 0
   end type
   integer :: lines = 0
contains
   subroutine push(t, position, value, ierr, host)
      real(real64), intent(in) :: t, position(3)
      real(real64), intent(out) :: value(3)
      integer, intent(out) :: ierr
      class(*), pointer, intent(in) :: host
      value = [0.0_real64, 0.0_real64, min(t, 1.0_real64)*(1 + 0*position(1))]
      ierr = 0
      select type (host)
      type is (counter)
         host%calls = host%calls + 1
         ierr = host%answer
      end select
   end subroutine
   subroutine listen(key, value)
      character(*), intent(in) :: key, value
      if (len(key) > 0 .and. len(value) >= 0) lines = lines + 1
   end subroutine
end module

program twins
   use, intrinsic :: iso_fortran_env, only: real64
   use, intrinsic :: ieee_arithmetic, only: ieee_is_nan
   use selas
   use twin_functions
   implicit none
   character(256) :: deck
   call get_command_argument(1, deck)
   call opening()
   call reading()
   call driving()
   call moving()
   call own_points()
contains
   subroutine ok(name, good)
      character(*), intent(in) :: name
      logical, intent(in) :: good
      if (good) then
         print '(a)', 'ok - Fortran: '//name
      else
         print '(a)', 'not ok - Fortran: '//name
      end if
   end subroutine

   subroutine opening()
      type(selas_simulation) :: sim
      integer :: status, file
      call sim%open_deck('no/such/deck.nml', status)
      call ok('a deck that is not there', status == selas_bad_deck .and. index(sim%message(), 'no/such') > 0)
      call sim%step(1, status)
      call ok('a simulation that did not open', status == selas_bad_deck)
      call ok('no time without a simulation', ieee_is_nan(sim%time()))
      call sim%close()
      call sim%step(1, status)
      call ok('a closed simulation', status == selas_bad_argument .and. index(sim%message(), 'NULL') > 0)
      call sim%open_deck(trim(deck), status, [character(20) :: 'body%spacing=0.5', 'output%low_pass=0'])
      call ok('a deck with overrides', status == selas_ok .and. abs(sim%end_time() - 6) < 1e-12_real64)
      call ok('its folder', sim%output_directory() == 'output/halfspace-lysmer')
      open (newunit=file, file=trim(deck), action='read')
      call sim%open_deck(file, status)
      call ok('a deck from a unit', status == selas_ok)
      close (file)
      call sim%open_text('text', '&scene dimension = 4 /', status)
      call ok('a wrong text', status == selas_bad_deck)
      call sim%open_new('', status)
      call ok('a scene without a name', status == selas_bad_argument)
      call ok('names', selas_status_name(selas_bad_deck) == 'SELAS_BAD_DECK' .and. &
         selas_status_gloss(selas_ok) == 'success' .and. selas_version() /= '' .and. &
         selas_components(selas_stress) == 6 .and. selas_components(99) == 0)
   end subroutine

   subroutine coarse(sim)
      type(selas_simulation), intent(inout) :: sim
      integer :: status
      call sim%open_deck(trim(deck), status, [character(24) :: 'body%spacing=1', 'output%plots=.false.', &
         'output%directory=out'])
      if (status /= selas_ok) print '(a)', 'not ok - Fortran: the coarse deck', sim%message()
   end subroutine

   subroutine reading()
      type(selas_simulation) :: sim
      real(real64), pointer :: position(:, :), u(:, :), time(:), value(:, :)
      real(real64) :: velocity(3), small(1), kinetic, strain
      integer :: status
      call coarse(sim)
      call sim%plan(listen, status)
      call ok('plan', status == selas_ok .and. lines > 5)
      call sim%record(status)
      call sim%advance(1.0_real64, status)
      call ok('advance', status == selas_ok .and. sim%time() > 1 - 1e-9_real64 .and. sim%steps() > 0 .and. &
         sim%time_step() > 0 .and. sim%steps_needed() > sim%steps())
      call sim%step(-3, status)
      call ok('no steps back', status == selas_bad_argument .and. index(sim%last_message(), 'below 0') > 0)
      call sim%receiver('centre', selas_velocity, velocity, status)
      call ok('receiver', status == selas_ok .and. velocity(3) > 0)
      call sim%receiver('nowhere', selas_velocity, velocity, status)
      call ok('a receiver that is not there', status == selas_bad_argument)
      call sim%receiver('centre', selas_velocity, small, status)
      call ok('too little room', status == selas_bad_argument)
      call sim%points(position)
      call sim%field(selas_displacement, u)
      call ok('points and field', sim%status() == selas_ok .and. all(shape(u) == [3, 512]) .and. &
         all(shape(position) == [3, 512]) .and. maxval(abs(u)) > 0)
      call sim%energy(kinetic, strain, status)
      call ok('energy', status == selas_ok .and. kinetic > 0 .and. strain > 0)
      call sim%set('body%spacing', 1.0_real64, status)
      call ok('no change after the first step', status == selas_bad_argument)
      call sim%history('centre', time, value, status)
      call ok('no history before finish', status == selas_bad_argument .and. .not. associated(time))
      call sim%save('checkpoint', status)
      call ok('checkpoint beside result files', status == selas_ok)
      call sim%write(status)
      call ok('write', status == selas_ok)
      call sim%finish(status)
      call sim%history('centre', time, value, status)
      call ok('history', status == selas_ok .and. size(value, 1) == 6 .and. size(value, 2) == size(time))
      call sim%write_exact(status)
      call ok('write_exact', status == selas_ok)
      call coarse(sim)
      call sim%advance(1.0_real64, status)
      call sim%save('checkpoint', status)
      call ok('save', status == selas_ok)
      call coarse(sim)
      call sim%restore('checkpoint', status)
      call ok('restore', status == selas_ok .and. sim%time() > 1 - 1e-9_real64)
      call sim%restore('no such file', status)
      call ok('no second restore', status == selas_bad_argument)
      call sim%finish(status)
      call sim%step(1)
      call ok('a kept status', sim%status() == selas_bad_argument)
   end subroutine

   subroutine driving()
      type(selas_simulation) :: sim
      type(counter), target :: count
      real(real64) :: mean, before, response, value(3)
      integer :: status, number
      call coarse(sim)
      call sim%set_traction('1', push, count, status)
      call sim%advance(1.0_real64, status)
      call ok('set_traction', status == selas_ok .and. count%calls > 0)
      count%answer = 1
      call sim%step(1, status)
      call ok('a callback that stops', status == selas_stopped)
      count%answer = 0
      call sim%step(1, status)
      call ok('and goes on', status == selas_ok)
      count%answer = -1
      call sim%step(1, status)
      call ok('a callback that fails', status == selas_callback_failed .and. index(sim%message(), 'function') > 0)
      call coarse(sim)
      call sim%set_load('1', 2.0_real64, status)
      call sim%load_mean('1', selas_acceleration, mean, status)
      call ok('set_load and load_mean', status == selas_ok .and. mean > 0)
      call sim%step(1, status)
      call sim%receiver('centre', selas_displacement, value, status)
      call ok('the load acts', value(3) > 0)
      call sim%load_mean('1', selas_acceleration, before, status)
      call sim%set_load('1', 3.0_real64, status)
      call sim%load_mean('1', selas_acceleration, mean, status)
      call sim%load_response('1', '1', response, status)
      call ok('load_response', status == selas_ok .and. abs(mean - before - response) < 1e-9_real64*response)
      call sim%set_load('nobody', 1.0_real64, status)
      call ok('a load that is not there', status == selas_bad_argument)
      call coarse(sim)
      call sim%add('load', number, status)
      call sim%set('load(2)%name', 'weight')
      call sim%set('load(2)%kind', 'body-force')
      call sim%set('load(2)%direction', [0.0_real64, 0.0_real64, 1.0_real64])
      call sim%set('load(2)%history', 'step')
      count%answer = 0
      call sim%set_body_force('weight', push, count, status)
      call sim%step(2, status)
      call ok('set_body_force', status == selas_ok .and. number == 2 .and. sim%status() == selas_ok)
      call sim%set('load(2)%colour', 'red', status)
      call ok('no change then', status == selas_bad_argument)
   end subroutine

   subroutine moving()
      type(selas_simulation) :: sim
      integer :: status
      call coarse(sim)
      call sim%set('boundary(2)%face', [character(2) :: 'x-', 'x+', 'y-', 'y+'])
      call sim%add('boundary')
      call sim%set('boundary(3)%face', 'z+')
      call sim%set('boundary(3)%kind', 'displacement')
      call sim%set('boundary(3)%direction', [0.0_real64, 0.0_real64, 1.0_real64])
      call sim%set('boundary(3)%history', 'step')
      call sim%set('boundary(3)%smoothing', 1.0_real64)
      call sim%build(status)
      if (status /= selas_ok) print '(a)', sim%message()
      call sim%set_motion('z+', push, status=status)
      call ok('set_motion', status == selas_ok)
      call sim%step(3, status)
      call ok('a moving face', status == selas_ok)
   end subroutine

   subroutine own_points()
      type(selas_simulation) :: sim
      real(real64) :: position(3, 64), volume(64)
      integer :: material(64), i, status
      position = 0
      do i = 1, 64
         position(1, i) = (mod(i - 1, 8) + 0.5_real64)/8
         position(2, i) = ((i - 1)/8 + 0.5_real64)/8
      end do
      volume = 1.0_real64/64
      material = merge(1, 2, position(1, :) < 0.5_real64)
      call sim%open_new('points')
      call sim%set('scene%dimension', 2)
      call sim%set('scene%end_time', 0.1_real64)
      call sim%set('method%name', 'sph')
      call sim%set('method%variant', 'total-lagrangian')
      do i = 1, 2
         call sim%add('material')
      end do
      call sim%set('material(1)%name', 'soft')
      call sim%set('material(2)%name', 'hard')
      do i = 1, 2
         call sim%set('material('//char(48 + i)//')%density', 1.0_real64)
         call sim%set('material('//char(48 + i)//')%young', real(i, real64))
         call sim%set('material('//char(48 + i)//')%poisson', 0.25_real64)
      end do
      call sim%add('body')
      call sim%set('body%material', 'soft')
      call sim%set('body%low', [0.0_real64, 0.0_real64])
      call sim%set('body%high', [1.0_real64, 1.0_real64])
      call sim%set('body%spacing', 0.125_real64)
      call sim%set_points(position, volume(:63), material, status)
      call ok('sizes that disagree', status == selas_bad_argument)
      call sim%set_points(position, volume, material, status)
      call sim%step(2, status)
      if (status /= selas_ok) print '(a)', '# '//sim%message()
      call ok('own points with materials', status == selas_ok)
   end subroutine
end program
