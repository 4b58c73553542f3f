! Printing of values for the program that values.c writes: those that reading has set. Before reading, reals
! and integers hold the bits of `unset`, logicals those of `unset_logical`, texts are blank.
module show
  use, intrinsic :: iso_fortran_env, only: real64, int64, int32
  implicit none
  integer(int64), parameter :: unset = -6148914691236517206_int64
  integer(int32) :: unset_logical = 7
contains
  subroutine show_real(name, value)
    character(len=*), intent(in) :: name
    real(real64), intent(in) :: value(:)
    integer :: i
    do i = 1, size(value)
      if (transfer(value(i), 1_int64) == unset) cycle
      if (value(i) /= value(i)) then
        print '(a, "(", i0, ") NaN")', name, i
      else
        print '(a, "(", i0, ") ", z16.16)', name, i, transfer(value(i), 1_int64)
      end if
    end do
  end subroutine

  subroutine show_integer(name, value)
    character(len=*), intent(in) :: name
    integer(int64), intent(in) :: value(:)
    integer :: i
    do i = 1, size(value)
      if (value(i) /= unset) print '(a, "(", i0, ") ", i0)', name, i, value(i)
    end do
  end subroutine

  subroutine show_logical(name, value)
    character(len=*), intent(in) :: name
    logical(int32), intent(in) :: value(:)
    integer :: i
    do i = 1, size(value)
      if (transfer(value(i), 1) /= 7) print '(a, "(", i0, ") ", i0)', name, i, merge(1, 0, value(i))
    end do
  end subroutine

  subroutine show_text(name, value)
    character(len=*), intent(in) :: name
    character(len=*), intent(in) :: value(:)
    integer :: i
    do i = 1, size(value)
      if (value(i) /= ' ') print '(a, "(", i0, ") [", a, "]")', name, i, trim(value(i))
    end do
  end subroutine
end module
