! The Fortran module selas: selas.h for Fortran 2018 hosts. Names are those of selas.h without the prefix and
! are bound to the type selas_simulation; strings are trimmed and terminated, arrays are (dimension, n) and
! 1-based, `status` is last and optional: without it a failure is kept and asked for by sim%status() and
! sim%message(). What each procedure does, its units and errors stand in selas.h and doc/howto/calling.md.
module selas
   use, intrinsic :: iso_c_binding
   use, intrinsic :: iso_fortran_env, only: real64, int64
   implicit none
   private

   ! Status codes and fields of selas.h
   integer, parameter, public :: selas_ok = 0, selas_bad_deck = 1, selas_bad_scene = 2, selas_bad_argument = 3, &
      selas_no_memory = 4, selas_file_error = 5, selas_unstable = 6, selas_not_converged = 7, &
      selas_unsupported = 8, selas_callback_failed = 9, selas_stopped = 10
   integer, parameter, public :: selas_displacement = 0, selas_velocity = 1, selas_acceleration = 2, &
      selas_stress = 3, selas_strain = 4, selas_pressure = 5, selas_energy_density = 6

   public :: selas_simulation, selas_vector_function, selas_teller, selas_version, selas_status_gloss, &
      selas_status_name, selas_components

   character(*), parameter :: no_copies = &
      'a simulation cannot be copied: a pointer to it, or an argument, would be right'

   abstract interface
      ! A vector at a time and a place: ierr = 0 goes on, > 0 stops after this step, < 0 fails. `host` is what was
      ! given beside the procedure (null if nothing was): select type gets at it.
      subroutine selas_vector_function(t, position, value, ierr, host)
         import :: real64
         real(real64), intent(in) :: t, position(3)
         real(real64), intent(out) :: value(3)
         integer, intent(out) :: ierr
         class(*), pointer, intent(in) :: host
      end subroutine
      ! One line of the plan.
      subroutine selas_teller(key, value)
         character(*), intent(in) :: key, value
      end subroutine
   end interface

   ! What a callback needs to find its way back to Fortran; its address is the C context.
   type :: callback
      procedure(selas_vector_function), pointer, nopass :: function => null()
      class(*), pointer :: host => null()
      type(callback), pointer :: next => null()
   end type
   type :: teller
      procedure(selas_teller), pointer, nopass :: tell => null()
   end type

   ! One simulation; closed by close() or when it goes out of scope. It cannot be copied: what it is assigned to is
   ! none.
   type :: selas_simulation
      private
      type(c_ptr) :: handle = c_null_ptr
      type(callback), pointer :: callbacks => null()
      integer :: kept = selas_ok
      logical :: copied = .false.
   contains
      procedure, private :: open_file, open_unit, refuse_copy
      generic, public :: assignment(=) => refuse_copy
      generic, public :: open_deck => open_file, open_unit
      procedure, public :: open_text, open_new, add, set_points, build
      procedure, private :: set_real_one, set_real_many, set_integer_one, set_logical_one, set_text_one, &
         set_text_many
      generic, public :: set => set_real_one, set_real_many, set_integer_one, set_logical_one, set_text_one, &
         set_text_many
      procedure, public :: advance, step, time, end_time, time_step, steps, steps_needed
      procedure, public :: receiver, finish, history, record, write => write_results, write_exact, plan
      procedure, public :: set_traction, set_body_force, set_motion, set_load, load_mean, load_response
      procedure, public :: points, field, energy, save => save_state, restore
      procedure, public :: status => kept_status, message, last_message, output_directory, &
         close => close_simulation
      final :: finalise
   end type

   interface
      function c_open_deck(path, sim) bind(c, name='selas_open_deck')
         import :: c_int, c_char, c_ptr
         character(kind=c_char), intent(in) :: path(*)
         type(c_ptr), intent(out) :: sim
         integer(c_int) :: c_open_deck
      end function
      function c_open_deck_with(path, count, overrides, sim) bind(c, name='selas_open_deck_with')
         import :: c_int, c_char, c_ptr, c_size_t
         character(kind=c_char), intent(in) :: path(*)
         integer(c_size_t), value :: count
         type(c_ptr), intent(in) :: overrides(*) ! const char *const *
         type(c_ptr), intent(out) :: sim
         integer(c_int) :: c_open_deck_with
      end function
      function c_share_handle(sim, communicator) bind(c, name='selas_share_handle')
         import :: c_int, c_ptr
         type(c_ptr), value :: sim
         integer(c_int), value :: communicator
         integer(c_int) :: c_share_handle
      end function
      function c_open_text(name, text, sim) bind(c, name='selas_open_text')
         import :: c_int, c_char, c_ptr
         character(kind=c_char), intent(in) :: name(*), text(*)
         type(c_ptr), intent(out) :: sim
         integer(c_int) :: c_open_text
      end function
      function c_open_new(name, sim) bind(c, name='selas_open_new')
         import :: c_int, c_char, c_ptr
         character(kind=c_char), intent(in) :: name(*)
         type(c_ptr), intent(out) :: sim
         integer(c_int) :: c_open_new
      end function
      function c_add(sim, group, number) bind(c, name='selas_add')
         import :: c_int, c_char, c_ptr, c_size_t
         type(c_ptr), value :: sim
         character(kind=c_char), intent(in) :: group(*)
         integer(c_size_t), intent(out) :: number
         integer(c_int) :: c_add
      end function
      function c_set_real(sim, word, count, values) bind(c, name='selas_set_real')
         import :: c_int, c_char, c_ptr, c_size_t, c_double
         type(c_ptr), value :: sim
         character(kind=c_char), intent(in) :: word(*)
         integer(c_size_t), value :: count
         real(c_double), intent(in) :: values(*)
         integer(c_int) :: c_set_real
      end function
      function c_set_integer(sim, word, val) bind(c, name='selas_set_integer')
         import :: c_int, c_char, c_ptr, c_long
         type(c_ptr), value :: sim
         character(kind=c_char), intent(in) :: word(*)
         integer(c_long), value :: val
         integer(c_int) :: c_set_integer
      end function
      function c_set_logical(sim, word, val) bind(c, name='selas_set_logical')
         import :: c_int, c_char, c_ptr, c_bool
         type(c_ptr), value :: sim
         character(kind=c_char), intent(in) :: word(*)
         logical(c_bool), value :: val
         integer(c_int) :: c_set_logical
      end function
      function c_set_text(sim, word, count, values) bind(c, name='selas_set_text')
         import :: c_int, c_char, c_ptr, c_size_t
         type(c_ptr), value :: sim
         character(kind=c_char), intent(in) :: word(*)
         integer(c_size_t), value :: count
         type(c_ptr), intent(in) :: values(*) ! const char *const *
         integer(c_int) :: c_set_text
      end function
      function c_set_points(sim, count, position, volume, material) bind(c, name='selas_set_points')
         import :: c_int, c_ptr, c_size_t, c_double
         type(c_ptr), value :: sim
         integer(c_size_t), value :: count
         real(c_double), intent(in) :: position(*), volume(*)
         type(c_ptr), value :: material ! const size_t *
         integer(c_int) :: c_set_points
      end function
      function c_build(sim) bind(c, name='selas_build')
         import :: c_int, c_ptr
         type(c_ptr), value :: sim
         integer(c_int) :: c_build
      end function
      function c_advance(sim, time) bind(c, name='selas_advance')
         import :: c_int, c_ptr, c_double
         type(c_ptr), value :: sim
         real(c_double), value :: time
         integer(c_int) :: c_advance
      end function
      function c_step(sim, steps) bind(c, name='selas_step')
         import :: c_int, c_ptr, c_long
         type(c_ptr), value :: sim
         integer(c_long), value :: steps
         integer(c_int) :: c_step
      end function
      function c_time(sim) bind(c, name='selas_time')
         import :: c_ptr, c_double
         type(c_ptr), value :: sim
         real(c_double) :: c_time
      end function
      function c_end_time(sim) bind(c, name='selas_end_time')
         import :: c_ptr, c_double
         type(c_ptr), value :: sim
         real(c_double) :: c_end_time
      end function
      function c_time_step(sim) bind(c, name='selas_time_step')
         import :: c_ptr, c_double
         type(c_ptr), value :: sim
         real(c_double) :: c_time_step
      end function
      function c_steps(sim) bind(c, name='selas_steps')
         import :: c_ptr, c_long
         type(c_ptr), value :: sim
         integer(c_long) :: c_steps
      end function
      function c_steps_needed(sim) bind(c, name='selas_steps_needed')
         import :: c_ptr, c_long
         type(c_ptr), value :: sim
         integer(c_long) :: c_steps_needed
      end function
      function c_receiver(sim, name, field, val) bind(c, name='selas_receiver')
         import :: c_int, c_char, c_ptr, c_double
         type(c_ptr), value :: sim
         character(kind=c_char), intent(in) :: name(*)
         integer(c_int), value :: field
         real(c_double), intent(out) :: val(*)
         integer(c_int) :: c_receiver
      end function
      function c_finish(sim) bind(c, name='selas_finish')
         import :: c_int, c_ptr
         type(c_ptr), value :: sim
         integer(c_int) :: c_finish
      end function
      function c_history(sim, name, rows, time, val) bind(c, name='selas_history')
         import :: c_int, c_char, c_ptr, c_size_t
         type(c_ptr), value :: sim
         character(kind=c_char), intent(in) :: name(*)
         integer(c_size_t), intent(out) :: rows
         type(c_ptr), intent(out) :: time, val ! const double **
         integer(c_int) :: c_history
      end function
      function c_record(sim) bind(c, name='selas_record')
         import :: c_int, c_ptr
         type(c_ptr), value :: sim
         integer(c_int) :: c_record
      end function
      function c_write(sim) bind(c, name='selas_write')
         import :: c_int, c_ptr
         type(c_ptr), value :: sim
         integer(c_int) :: c_write
      end function
      function c_write_exact(sim) bind(c, name='selas_write_exact')
         import :: c_int, c_ptr
         type(c_ptr), value :: sim
         integer(c_int) :: c_write_exact
      end function
      function c_plan(sim, tell, context) bind(c, name='selas_plan')
         import :: c_int, c_ptr, c_funptr
         type(c_ptr), value :: sim
         type(c_funptr), value :: tell
         type(c_ptr), value :: context
         integer(c_int) :: c_plan
      end function
      function c_message(sim) bind(c, name='selas_message')
         import :: c_ptr
         type(c_ptr), value :: sim
         type(c_ptr) :: c_message ! const char *
      end function
      function c_last_message(sim) bind(c, name='selas_last_message')
         import :: c_ptr
         type(c_ptr), value :: sim
         type(c_ptr) :: c_last_message ! const char *
      end function
      function c_output_directory(sim) bind(c, name='selas_output_directory')
         import :: c_ptr
         type(c_ptr), value :: sim
         type(c_ptr) :: c_output_directory ! const char *
      end function
      subroutine c_close(sim) bind(c, name='selas_close')
         import :: c_ptr
         type(c_ptr), intent(inout) :: sim
      end subroutine
      function c_set_traction(sim, load, traction, context) bind(c, name='selas_set_traction')
         import :: c_int, c_char, c_ptr, c_funptr
         type(c_ptr), value :: sim
         character(kind=c_char), intent(in) :: load(*)
         type(c_funptr), value :: traction
         type(c_ptr), value :: context
         integer(c_int) :: c_set_traction
      end function
      function c_set_body_force(sim, load, force, context) bind(c, name='selas_set_body_force')
         import :: c_int, c_char, c_ptr, c_funptr
         type(c_ptr), value :: sim
         character(kind=c_char), intent(in) :: load(*)
         type(c_funptr), value :: force
         type(c_ptr), value :: context
         integer(c_int) :: c_set_body_force
      end function
      function c_set_motion(sim, face, displacement, context) bind(c, name='selas_set_motion')
         import :: c_int, c_char, c_ptr, c_funptr
         type(c_ptr), value :: sim
         character(kind=c_char), intent(in) :: face(*)
         type(c_funptr), value :: displacement
         type(c_ptr), value :: context
         integer(c_int) :: c_set_motion
      end function
      function c_set_load(sim, load, val) bind(c, name='selas_set_load')
         import :: c_int, c_char, c_ptr, c_double
         type(c_ptr), value :: sim
         character(kind=c_char), intent(in) :: load(*)
         real(c_double), value :: val
         integer(c_int) :: c_set_load
      end function
      function c_load_mean(sim, load, field, val) bind(c, name='selas_load_mean')
         import :: c_int, c_char, c_ptr, c_double
         type(c_ptr), value :: sim
         character(kind=c_char), intent(in) :: load(*)
         integer(c_int), value :: field
         real(c_double), intent(out) :: val
         integer(c_int) :: c_load_mean
      end function
      function c_load_response(sim, load, moved, val) bind(c, name='selas_load_response')
         import :: c_int, c_char, c_ptr, c_double
         type(c_ptr), value :: sim
         character(kind=c_char), intent(in) :: load(*), moved(*)
         real(c_double), intent(out) :: val
         integer(c_int) :: c_load_response
      end function
      function c_points(sim, count, position) bind(c, name='selas_points')
         import :: c_int, c_ptr, c_size_t
         type(c_ptr), value :: sim
         integer(c_size_t), intent(out) :: count
         type(c_ptr), intent(out) :: position ! const double **
         integer(c_int) :: c_points
      end function
      function c_field_values(sim, field, count, components, val) bind(c, name='selas_field_values')
         import :: c_int, c_ptr, c_size_t
         type(c_ptr), value :: sim
         integer(c_int), value :: field
         integer(c_size_t), intent(out) :: count, components
         type(c_ptr), intent(out) :: val ! const double **
         integer(c_int) :: c_field_values
      end function
      function c_energy(sim, kinetic, strain) bind(c, name='selas_energy')
         import :: c_int, c_ptr, c_double
         type(c_ptr), value :: sim
         real(c_double), intent(out) :: kinetic, strain
         integer(c_int) :: c_energy
      end function
      function c_save(sim, path) bind(c, name='selas_save')
         import :: c_int, c_char, c_ptr
         type(c_ptr), value :: sim
         character(kind=c_char), intent(in) :: path(*)
         integer(c_int) :: c_save
      end function
      function c_restore(sim, path) bind(c, name='selas_restore')
         import :: c_int, c_char, c_ptr
         type(c_ptr), value :: sim
         character(kind=c_char), intent(in) :: path(*)
         integer(c_int) :: c_restore
      end function
      function c_field_components(field) bind(c, name='selas_field_components')
         import :: c_int
         integer(c_int), value :: field
         integer(c_int) :: c_field_components
      end function
      function c_status_gloss(status) bind(c, name='selas_status_gloss')
         import :: c_int, c_ptr
         integer(c_int), value :: status
         type(c_ptr) :: c_status_gloss ! const char *
      end function
      function c_status_name(status) bind(c, name='selas_status_name')
         import :: c_int, c_ptr
         integer(c_int), value :: status
         type(c_ptr) :: c_status_name ! const char *
      end function
      function c_version() bind(c, name='selas_version')
         import :: c_ptr
         type(c_ptr) :: c_version ! const char *
      end function
      pure function c_strlen(text) bind(c, name='strlen')
         import :: c_ptr, c_size_t
         type(c_ptr), value :: text
         integer(c_size_t) :: c_strlen
      end function
   end interface

contains

   ! --- Strings and statuses ---

   pure function terminated(text) result(c_text)
      character(*), intent(in) :: text
      character(len_trim(text) + 1, kind=c_char) :: c_text
      c_text = trim(text)//c_null_char
   end function

   function from_c(text) result(string)
      type(c_ptr), intent(in) :: text
      character(:), allocatable :: string
      character(kind=c_char), pointer :: letters(:)
      integer :: i, length
      length = int(c_strlen(text))
      call c_f_pointer(text, letters, [length])
      allocate (character(length) :: string)
      do i = 1, length
         string(i:i) = letters(i)
      end do
   end function

   ! Hands a status to the caller, or keeps the first that is not ok.
   subroutine report(sim, code, status)
      class(selas_simulation), intent(inout) :: sim
      integer(c_int), intent(in) :: code
      integer, intent(out), optional :: status
      if (present(status)) then
         status = int(code)
      else if (sim%kept == selas_ok) then
         sim%kept = int(code)
      end if
   end subroutine

   ! First failure of a call without status since the simulation was opened; selas_ok if there was none.
   integer function kept_status(self)
      class(selas_simulation), intent(in) :: self
      kept_status = self%kept
   end function

   function message(self) result(text)
      class(selas_simulation), intent(in) :: self
      character(:), allocatable :: text
      if (self%copied) then
         text = no_copies
         return
      end if
      text = from_c(c_message(self%handle))
   end function

   ! What the last call said; of a call that was not done because an earlier one had failed, what that one said.
   function last_message(self) result(text)
      class(selas_simulation), intent(in) :: self
      character(:), allocatable :: text
      if (self%copied) then
         text = no_copies
         return
      end if
      text = from_c(c_last_message(self%handle))
   end function

   function output_directory(self) result(text)
      class(selas_simulation), intent(in) :: self
      character(:), allocatable :: text
      text = from_c(c_output_directory(self%handle))
   end function

   function selas_version() result(text)
      character(:), allocatable :: text
      text = from_c(c_version())
   end function

   function selas_status_gloss(status) result(text)
      integer, intent(in) :: status
      character(:), allocatable :: text
      text = from_c(c_status_gloss(int(status, c_int)))
   end function

   function selas_status_name(status) result(text)
      integer, intent(in) :: status
      character(:), allocatable :: text
      text = from_c(c_status_name(int(status, c_int)))
   end function

   integer function selas_components(field)
      integer, intent(in) :: field
      selas_components = int(c_field_components(int(field, c_int)))
   end function

   ! --- Opening and closing ---

   subroutine close_simulation(self)
      class(selas_simulation), intent(inout) :: self
      type(callback), pointer :: next
      call c_close(self%handle)
      if (c_associated(self%handle)) return ! a callback may not close its own simulation
      do while (associated(self%callbacks))
         next => self%callbacks%next
         deallocate (self%callbacks)
         self%callbacks => next
      end do
      self%kept = selas_ok
      self%copied = .false.
   end subroutine

   ! left = right: two that close one simulation would be wrong.
   impure elemental subroutine refuse_copy(left, right)
      class(selas_simulation), intent(inout) :: left
      type(selas_simulation), intent(in) :: right
      if (c_associated(left%handle) .and. c_associated(left%handle, right%handle)) return ! itself
      call close_simulation(left)
      left%kept = selas_bad_argument
      left%copied = .true.
   end subroutine

   impure elemental subroutine finalise(self)
      type(selas_simulation), intent(inout) :: self
      call close_simulation(self)
   end subroutine

   ! Opens a deck file; overrides(i) = 'group%name=value'.
   ! comm: Fortran handle of an MPI communicator (of mpi_f08: comm%mpi_val), whose ranks share the work and all make
   ! the same calls; needs the library selas-mpi.
   subroutine open_file(self, path, status, overrides, comm)
      class(selas_simulation), intent(inout) :: self
      character(*), intent(in) :: path
      integer, intent(out), optional :: status
      character(*), intent(in), optional :: overrides(:)
      integer, intent(in), optional :: comm
      character(1, kind=c_char), allocatable, target :: texts(:, :)
      type(c_ptr), allocatable :: pointers(:)
      integer(c_int) :: code
      call self%close()
      if (present(overrides)) then
         call pack_texts(overrides, texts, pointers)
         code = c_open_deck_with(terminated(path), int(size(overrides), c_size_t), pointers, self%handle)
      else
         code = c_open_deck(terminated(path), self%handle)
      end if
      if (present(comm)) code = c_share_handle(self%handle, int(comm, c_int))
      call report(self, code, status)
   end subroutine

   ! Opens the deck in a formatted file that the host has open; reads from its beginning and leaves it there.
   subroutine open_unit(self, unit, status)
      class(selas_simulation), intent(inout) :: self
      integer, intent(in) :: unit
      integer, intent(out), optional :: status
      character(:), allocatable :: text
      character(1024) :: line
      integer :: length, ios
      text = ''
      rewind (unit, iostat=ios)
      do while (ios == 0)
         read (unit, '(a)', advance='no', size=length, iostat=ios) line
         text = text//line(:length)
         if (is_iostat_eor(ios)) then
            text = text//new_line('a')
            ios = 0
         end if
      end do
      rewind (unit, iostat=ios)
      call self%open_text('deck', text, status)
   end subroutine

   subroutine open_text(self, name, text, status)
      class(selas_simulation), intent(inout) :: self
      character(*), intent(in) :: name, text
      integer, intent(out), optional :: status
      integer(c_int) :: code
      call self%close()
      code = c_open_text(terminated(name), text//c_null_char, self%handle)
      call report(self, code, status)
   end subroutine

   subroutine open_new(self, name, status)
      class(selas_simulation), intent(inout) :: self
      character(*), intent(in) :: name
      integer, intent(out), optional :: status
      integer(c_int) :: code
      call self%close()
      code = c_open_new(terminated(name), self%handle)
      call report(self, code, status)
   end subroutine

   ! --- Building by calls ---

   subroutine add(self, group, number, status)
      class(selas_simulation), intent(inout) :: self
      character(*), intent(in) :: group
      integer, intent(out), optional :: number, status
      integer(c_size_t) :: made
      integer(c_int) :: code
      made = 0
      code = c_add(self%handle, terminated(group), made)
      if (present(number)) number = int(made)
      call report(self, code, status)
   end subroutine

   subroutine set_real_many(self, word, values, status)
      class(selas_simulation), intent(inout) :: self
      character(*), intent(in) :: word
      real(real64), intent(in) :: values(:)
      integer, intent(out), optional :: status
      call report(self, c_set_real(self%handle, terminated(word), size(values, kind=c_size_t), values), status)
   end subroutine

   subroutine set_real_one(self, word, value, status)
      class(selas_simulation), intent(inout) :: self
      character(*), intent(in) :: word
      real(real64), intent(in) :: value
      integer, intent(out), optional :: status
      call set_real_many(self, word, [value], status)
   end subroutine

   subroutine set_integer_one(self, word, value, status)
      class(selas_simulation), intent(inout) :: self
      character(*), intent(in) :: word
      integer, intent(in) :: value
      integer, intent(out), optional :: status
      call report(self, c_set_integer(self%handle, terminated(word), int(value, c_long)), status)
   end subroutine

   subroutine set_logical_one(self, word, value, status)
      class(selas_simulation), intent(inout) :: self
      character(*), intent(in) :: word
      logical, intent(in) :: value
      integer, intent(out), optional :: status
      call report(self, c_set_logical(self%handle, terminated(word), logical(value, c_bool)), status)
   end subroutine

   subroutine set_text_many(self, word, values, status)
      class(selas_simulation), intent(inout) :: self
      character(*), intent(in) :: word, values(:)
      integer, intent(out), optional :: status
      character(1, kind=c_char), allocatable, target :: texts(:, :)
      type(c_ptr), allocatable :: pointers(:)
      call pack_texts(values, texts, pointers)
      call report(self, c_set_text(self%handle, terminated(word), size(values, kind=c_size_t), pointers), status)
   end subroutine

   subroutine set_text_one(self, word, value, status)
      class(selas_simulation), intent(inout) :: self
      character(*), intent(in) :: word, value
      integer, intent(out), optional :: status
      call set_text_many(self, word, [value], status)
   end subroutine

   subroutine pack_texts(values, texts, pointers)
      character(*), intent(in) :: values(:)
      character(1, kind=c_char), allocatable, target, intent(out) :: texts(:, :)
      type(c_ptr), allocatable, intent(out) :: pointers(:)
      integer :: i, k, length
      allocate (texts(len(values) + 1, max(size(values), 1)))
      texts = c_null_char
      allocate (pointers(max(size(values), 1)))
      pointers = c_null_ptr
      do i = 1, size(values)
         length = len_trim(values(i))
         do k = 1, length
            texts(k, i) = values(i)(k:k)
         end do
         pointers(i) = c_loc(texts(1, i))
      end do
   end subroutine

   ! Points of the host's own: position(3, n), volume(n), and if present material(n), numbers from 1.
   subroutine set_points(self, position, volume, material, status)
      class(selas_simulation), intent(inout) :: self
      real(real64), intent(in) :: position(:, :), volume(:)
      integer, intent(in), optional :: material(:)
      integer, intent(out), optional :: status
      integer(c_size_t), allocatable, target :: numbers(:)
      integer(c_size_t) :: count
      type(c_ptr) :: given
      count = size(volume, kind=c_size_t)
      if (size(position, 1) /= 3 .or. size(position, 2) /= size(volume)) count = 0
      given = c_null_ptr
      if (present(material)) then
         if (size(material) /= size(volume)) count = 0
         allocate (numbers(max(size(material), 1)))
         numbers(:size(material)) = max(material, 0)
         given = c_loc(numbers)
      end if
      call report(self, c_set_points(self%handle, count, position, volume, given), status)
   end subroutine

   subroutine build(self, status)
      class(selas_simulation), intent(inout) :: self
      integer, intent(out), optional :: status
      call report(self, c_build(self%handle), status)
   end subroutine

   ! --- Running ---

   subroutine advance(self, time, status)
      class(selas_simulation), intent(inout) :: self
      real(real64), intent(in) :: time
      integer, intent(out), optional :: status
      call report(self, c_advance(self%handle, time), status)
   end subroutine

   subroutine step(self, steps, status)
      class(selas_simulation), intent(inout) :: self
      integer, intent(in), optional :: steps
      integer, intent(out), optional :: status
      integer(c_long) :: count
      count = 1
      if (present(steps)) count = steps
      call report(self, c_step(self%handle, count), status)
   end subroutine

   real(real64) function time(self)
      class(selas_simulation), intent(in) :: self
      time = c_time(self%handle)
   end function

   real(real64) function end_time(self)
      class(selas_simulation), intent(in) :: self
      end_time = c_end_time(self%handle)
   end function

   real(real64) function time_step(self)
      class(selas_simulation), intent(in) :: self
      time_step = c_time_step(self%handle)
   end function

   integer(int64) function steps(self)
      class(selas_simulation), intent(in) :: self
      steps = int(c_steps(self%handle), int64)
   end function

   integer(int64) function steps_needed(self)
      class(selas_simulation), intent(in) :: self
      steps_needed = int(c_steps_needed(self%handle), int64)
   end function

   ! --- Results ---

   ! Components of a field at a receiver: value(1:3), (1:6) or (1:1); what is beyond stays as it was.
   subroutine receiver(self, name, field, value, status)
      class(selas_simulation), intent(inout) :: self
      character(*), intent(in) :: name
      integer, intent(in) :: field
      real(real64), intent(inout) :: value(:)
      integer, intent(out), optional :: status
      real(real64) :: room(6)
      integer :: width
      integer(c_int) :: code
      width = selas_components(field)
      code = selas_bad_argument
      if (width > 0 .and. size(value) >= width) then
         code = c_receiver(self%handle, terminated(name), int(field, c_int), room)
         if (code == selas_ok) value(:width) = room(:width)
      else
         ! the wrong size becomes the library's own complaint
         code = c_receiver(self%handle, terminated(name), -1_c_int, room)
      end if
      call report(self, code, status)
   end subroutine

   subroutine finish(self, status)
      class(selas_simulation), intent(inout) :: self
      integer, intent(out), optional :: status
      call report(self, c_finish(self%handle), status)
   end subroutine

   ! After finish: time(n) and value(6, n) = ux uy uz vx vy vz; they belong to the simulation.
   subroutine history(self, name, time, value, status)
      class(selas_simulation), intent(inout) :: self
      character(*), intent(in) :: name
      real(real64), pointer, intent(out) :: time(:), value(:, :)
      integer, intent(out), optional :: status
      type(c_ptr) :: times, values
      integer(c_size_t) :: rows
      integer(c_int) :: code
      time => null()
      value => null()
      code = c_history(self%handle, terminated(name), rows, times, values)
      if (code == selas_ok) then
         call c_f_pointer(times, time, [rows])
         call c_f_pointer(values, value, [6_c_size_t, rows])
      end if
      call report(self, code, status)
   end subroutine

   subroutine record(self, status)
      class(selas_simulation), intent(inout) :: self
      integer, intent(out), optional :: status
      call report(self, c_record(self%handle), status)
   end subroutine

   subroutine write_results(self, status)
      class(selas_simulation), intent(inout) :: self
      integer, intent(out), optional :: status
      call report(self, c_write(self%handle), status)
   end subroutine

   subroutine write_exact(self, status)
      class(selas_simulation), intent(inout) :: self
      integer, intent(out), optional :: status
      call report(self, c_write_exact(self%handle), status)
   end subroutine

   subroutine plan(self, tell, status)
      class(selas_simulation), intent(inout) :: self
      procedure(selas_teller) :: tell
      integer, intent(out), optional :: status
      type(teller), target :: who
      who%tell => tell
      call report(self, c_plan(self%handle, c_funloc(tell_line), c_loc(who)), status)
   end subroutine

   subroutine tell_line(context, key, value) bind(c, name='selas_fortran_tell')
      type(c_ptr), value :: context
      type(c_ptr), value :: key, value ! const char *
      type(teller), pointer :: who
      call c_f_pointer(context, who)
      call who%tell(from_c(key), from_c(value))
   end subroutine

   ! position(3, n); it belongs to the simulation.
   subroutine points(self, position, status)
      class(selas_simulation), intent(inout) :: self
      real(real64), pointer, intent(out) :: position(:, :)
      integer, intent(out), optional :: status
      integer(c_size_t) :: count
      type(c_ptr) :: values
      integer(c_int) :: code
      position => null()
      code = c_points(self%handle, count, values)
      if (code == selas_ok) call c_f_pointer(values, position, [3_c_size_t, count])
      call report(self, code, status)
   end subroutine

   ! value(components, n); it belongs to the simulation and lives until the next call.
   subroutine field(self, which, value, status)
      class(selas_simulation), intent(inout) :: self
      integer, intent(in) :: which
      real(real64), pointer, intent(out) :: value(:, :)
      integer, intent(out), optional :: status
      integer(c_size_t) :: count, components
      type(c_ptr) :: values
      integer(c_int) :: code
      value => null()
      code = c_field_values(self%handle, int(which, c_int), count, components, values)
      if (code == selas_ok) call c_f_pointer(values, value, [components, count])
      call report(self, code, status)
   end subroutine

   subroutine energy(self, kinetic, strain, status)
      class(selas_simulation), intent(inout) :: self
      real(real64), intent(out) :: kinetic, strain
      integer, intent(out), optional :: status
      kinetic = 0
      strain = 0
      call report(self, c_energy(self%handle, kinetic, strain), status)
   end subroutine

   ! --- Checkpoints ---

   subroutine save_state(self, path, status)
      class(selas_simulation), intent(inout) :: self
      character(*), intent(in) :: path
      integer, intent(out), optional :: status
      call report(self, c_save(self%handle, terminated(path)), status)
   end subroutine

   subroutine restore(self, path, status)
      class(selas_simulation), intent(inout) :: self
      character(*), intent(in) :: path
      integer, intent(out), optional :: status
      call report(self, c_restore(self%handle, terminated(path)), status)
   end subroutine

   ! --- What the host drives ---

   integer(c_int) function call_back(context, time, position, value) bind(c, name='selas_fortran_call')
      type(c_ptr), value :: context
      real(c_double), value :: time
      real(c_double), intent(in) :: position(3)
      real(c_double), intent(out) :: value(3)
      type(callback), pointer :: who
      integer :: ierr
      call c_f_pointer(context, who)
      ierr = 0
      call who%function(time, position, value, ierr, who%host)
      call_back = int(ierr, c_int)
   end function

   function new_callback(self, function, host) result(context)
      class(selas_simulation), intent(inout) :: self
      procedure(selas_vector_function) :: function
      class(*), target, intent(in), optional :: host
      type(callback), pointer :: made
      type(c_ptr) :: context
      allocate (made)
      made%function => function
      if (present(host)) made%host => host
      made%next => self%callbacks
      self%callbacks => made
      context = c_loc(made)
   end function

   ! `host` must live as long as the simulation (give it the target attribute).
   subroutine set_traction(self, load, traction, host, status)
      class(selas_simulation), intent(inout) :: self
      character(*), intent(in) :: load
      procedure(selas_vector_function) :: traction
      class(*), target, intent(in), optional :: host
      integer, intent(out), optional :: status
      type(c_ptr) :: context
      context = new_callback(self, traction, host)
      call report(self, c_set_traction(self%handle, terminated(load), c_funloc(call_back), context), status)
   end subroutine

   subroutine set_body_force(self, load, force, host, status)
      class(selas_simulation), intent(inout) :: self
      character(*), intent(in) :: load
      procedure(selas_vector_function) :: force
      class(*), target, intent(in), optional :: host
      integer, intent(out), optional :: status
      type(c_ptr) :: context
      context = new_callback(self, force, host)
      call report(self, c_set_body_force(self%handle, terminated(load), c_funloc(call_back), context), status)
   end subroutine

   subroutine set_motion(self, face, displacement, host, status)
      class(selas_simulation), intent(inout) :: self
      character(*), intent(in) :: face
      procedure(selas_vector_function) :: displacement
      class(*), target, intent(in), optional :: host
      integer, intent(out), optional :: status
      type(c_ptr) :: context
      context = new_callback(self, displacement, host)
      call report(self, c_set_motion(self%handle, terminated(face), c_funloc(call_back), context), status)
   end subroutine

   subroutine set_load(self, load, value, status)
      class(selas_simulation), intent(inout) :: self
      character(*), intent(in) :: load
      real(real64), intent(in) :: value
      integer, intent(out), optional :: status
      call report(self, c_set_load(self%handle, terminated(load), value), status)
   end subroutine

   subroutine load_mean(self, load, field, value, status)
      class(selas_simulation), intent(inout) :: self
      character(*), intent(in) :: load
      integer, intent(in) :: field
      real(real64), intent(out) :: value
      integer, intent(out), optional :: status
      value = 0
      call report(self, c_load_mean(self%handle, terminated(load), int(field, c_int), value), status)
   end subroutine

   subroutine load_response(self, load, moved, value, status)
      class(selas_simulation), intent(inout) :: self
      character(*), intent(in) :: load, moved
      real(real64), intent(out) :: value
      integer, intent(out), optional :: status
      value = 0
      call report(self, c_load_response(self%handle, terminated(load), terminated(moved), value), status)
   end subroutine
end module selas
