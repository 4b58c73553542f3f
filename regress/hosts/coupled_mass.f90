! Host 2: a rigid block on the half-space, coupled both ways. It rests on a unit square, each half of which it presses
! with a uniform traction, and moves with the halves' mean displacements U_l, U_r; a force F(t) acts on it, EAST of the middle.
! With U, V half the sum and the difference of U_r and U_l, R, Q those of the tractions, m the block's mass, J 16 times its
! moment of inertia,
!
!    m U'' = F - R,     J V'' = 4 EAST F - Q.                                                                  (1)
!
! At every step the ground tells the halves' mean accelerations. They are linear in the tractions, a = a0 + b R with b from
! load_response, so that R is found without iteration from the accelerations a under any tractions R0:
!
!    R = R0 + (F - R0 - m a) / (1 + m b),     b = b_rr + b_rl; for Q alike with b_rr - b_rl.                   (2)
!
! Exact answer (Laplace transform): m s^2 U + U / C(s) = F(s), J s^2 V + V / D(s) = 4 EAST F(s), with
!    C(s) = 1/(4 pi^2) int int X^2 uz dkx dky,  D(s) = 1/(4 pi^2) int int Y^2 uz dkx dky,                       (3)
!    X = S(kx/2) S(ky/2),  Y = S(kx/4) S(ky/2) sin(kx/4),  S(x) = sin(x)/x,
!    uz = nu_p w / R,  R = (2 k^2 + w)^2 - 4 k^2 nu_p nu_s,  w = s^2/cs^2  (Lamb 1904; doc/theory/lamb.md).             (4)
! The integrals are split: the static part uz = (1 - nu)/k in closed form, the rest by Gauss quadrature.
!
!   coupled_mass [SPACING [TOLERANCE OF_V]]     prints the relative L2 errors of U and V; ends with 1 if above the tolerances
program coupled_mass
   use, intrinsic :: iso_fortran_env, only: real64, error_unit
   use selas
   implicit none
   integer, parameter :: r = real64
   real(r), parameter :: pi = acos(-1.0_r), mass = 1.0_r, inertia = 2.0_r, east = 0.2_r, last = 3.7_r
   type(selas_simulation) :: sim
   character(32) :: word
   integer, parameter :: mean = 1, rocking = 2 ! (U, V), and the tractions alike
   real(r) :: spacing, tolerance(2), pressed(2), b(2), acceleration(2), displacement(2), difference(2), norm(2), answer(2)
   real(r) :: own, other
   integer :: i
   real(r), parameter :: pushed(2) = [mass, inertia], lever(2) = [1.0_r, 4*east]
   real(r), allocatable :: node(:), weight(:), shape(:, :)

   call get_command_argument(1, word)
   spacing = 0.25_r
   if (word /= '') read (word, *) spacing
   call get_command_argument(2, word)
   tolerance = [0.018_r, 0.065_r]
   do i = 1, 2
      call get_command_argument(1 + i, word)
      if (word /= '') read (word, *) tolerance(i)
   end do

   call describe_ground()
   call prepare_compliance()
   pressed = 0
   difference = 0
   norm = 0
   call press()                                     ! from now on the host drives both halves
   call sim%load_response('right', 'right', own)
   call sim%load_response('left', 'right', other)
   b = [own + other, own - other]
   do while (sim%time() < last)
      call press()
      acceleration = seen(selas_acceleration)
      pressed = pressed + (force(sim%time())*lever - pressed - pushed*acceleration)/(1 + pushed*b)
      call press()
      displacement = seen(selas_displacement)
      answer = exact(sim%time())
      difference = difference + (displacement - answer)**2
      norm = norm + answer**2
      call sim%step()
      if (sim%status() /= selas_ok) then
         write (error_unit, '(a)') sim%message()
         error stop 1
      end if
   end do
   print '(a, f6.4, a, 2f8.5, a, 2f8.5)', 'spacing ', spacing, ': relative L2 errors of the block''s mean motion and rocking ', &
      sqrt(difference/norm), ', at the end ', displacement
   if (.not. all(sqrt(difference/norm) < tolerance)) error stop 1
contains

   subroutine press()
      call sim%set_load('left', pressed(mean) - pressed(rocking))
      call sim%set_load('right', pressed(mean) + pressed(rocking))
   end subroutine

   function seen(field)
      integer, intent(in) :: field
      real(r) :: seen(2), left, right
      call sim%load_mean('left', field, left)
      call sim%load_mean('right', field, right)
      seen = [right + left, right - left]/2
   end function

   subroutine describe_ground()
      integer :: number
      call sim%open_new('coupled-mass')
      call sim%set('scene%dimension', 3)
      call sim%set('scene%end_time', 4.0_r)
      call sim%set('method%degree', 3)
      call sim%set('method%ends', 'open')
      call sim%set('method%mass', 'exact')
      call sim%set('stepping%scheme', 'leapfrog')
      call sim%add('material')
      call sim%set('material%name', 'rock')
      call sim%set('material%density', 1.0_r)
      call sim%set('material%lambda', 1.0_r)
      call sim%set('material%mu', 1.0_r)
      call sim%add('body')
      call sim%set('body%material', 'rock')
      call sim%set('body%shape', 'box')
      call sim%set('body%low', [0.0_r, 0.0_r, 0.0_r])
      call sim%set('body%high', [7.0_r, 7.0_r, 7.0_r])
      call sim%set('body%spacing', spacing)
      call sim%add('boundary', number)
      call sim%set('boundary%face', [character(2) :: 'x-', 'x+', 'y-', 'y+', 'z+'])
      call sim%set('boundary%kind', 'transmitting')
      call describe_half('left', 3.25_r)
      call describe_half('right', 3.75_r)
   end subroutine

   subroutine describe_half(name, x)
      character(*), intent(in) :: name
      real(r), intent(in) :: x
      integer :: number
      character(12) :: load
      call sim%add('load', number)
      write (load, '(a, i0, a)') 'load(', number, ')%'
      call sim%set(trim(load)//'name', name)
      call sim%set(trim(load)//'face', 'z-')
      call sim%set(trim(load)//'shape', 'square')
      call sim%set(trim(load)//'centre', [x, 3.5_r, 0.0_r])
      call sim%set(trim(load)//'size', [0.5_r, 1.0_r])
      call sim%set(trim(load)//'direction', [0.0_r, 0.0_r, 1.0_r])
      call sim%set(trim(load)//'history', 'step')
   end subroutine

   ! F(t) = (1 - cos(pi t)) / 2 for 0 <= t <= 2, and its transform.
   real(r) function force(t)
      real(r), intent(in) :: t
      force = 0
      if (t > 0 .and. t < 2) force = (1 - cos(pi*t))/2
   end function

   complex(r) function force_transform(s)
      complex(r), intent(in) :: s
      force_transform = (1 - exp(-2*s))/2*(1/s - s/(s**2 + pi**2))
   end function

   ! Panels of 12 Gauss points in k, with k A(k), A(k) = 1/(4 pi^2) times the integrals of X^2 and Y^2 over the circle.
   subroutine prepare_compliance()
      real(r), parameter :: x(6) = [0.125233408511468916_r, 0.367831498998180194_r, 0.587317954286617447_r, &
         0.769902674194304687_r, 0.904117256370474857_r, 0.981560634246719251_r]
      real(r), parameter :: w(6) = [0.249147045813402785_r, 0.233492536538354809_r, 0.203167426723065922_r, &
         0.160078328543346226_r, 0.106939325995318431_r, 0.047175336386511827_r]
      integer, parameter :: panels = 160, angles = 400
      real(r), parameter :: half = 0.375_r
      integer :: panel, i, j, at
      real(r) :: phi, k, across, total(2)
      allocate (node(12*panels), weight(12*panels), shape(12*panels, 2))
      at = 0
      do panel = 1, panels
         do i = 1, 12
            at = at + 1
            k = half*(2*panel - 1) + merge(1, -1, i > 6)*half*x(mod(i - 1, 6) + 1)
            total = 0
            do j = 1, angles ! midpoints of a quadrant
               phi = (j - 0.5_r)*pi/(2*angles)
               across = sinc(k*sin(phi)/2)
               total(mean) = total(mean) + (sinc(k*cos(phi)/2)*across)**2
               total(rocking) = total(rocking) + (sinc(k*cos(phi)/4)*sin(k*cos(phi)/4)*across)**2
            end do
            node(at) = k
            weight(at) = half*w(mod(i - 1, 6) + 1)
            shape(at, :) = k*total*(2*pi/angles)/(4*pi**2)
         end do
      end do
   end subroutine

   real(r) function sinc(x)
      real(r), intent(in) :: x
      sinc = 1
      if (abs(x) > 1e-8_r) sinc = sin(x)/x
   end function

   ! Mean of 1/r over two points of a rectangle.
   real(r) function inverse_distance(a, b)
      real(r), intent(in) :: a, b
      inverse_distance = 2/(a*b)**2*(a**2*b*asinh(b/a) + a*b**2*asinh(a/b) + (a**3 + b**3 - (a**2 + b**2)**1.5_r)/3)
   end function

   ! (3), lambda = mu = rho = 1: cs = 1, cp^2 = 3, nu = 1/4. The static part of D has the mean of 1/r over two points of one half
   ! less that over two points of the square.
   function compliance(s)
      complex(r), intent(in) :: s
      complex(r) :: compliance(2)
      real(r), parameter :: a2 = 1.0_r/3
      real(r) :: whole
      complex(r) :: w, p, q, kap, rayleigh
      real(r) :: k2
      integer :: i
      w = s**2
      whole = inverse_distance(1.0_r, 1.0_r)
      compliance = 0.75_r/(2*pi)*[whole, inverse_distance(0.5_r, 1.0_r) - whole]
      do i = 1, size(node)
         k2 = node(i)**2
         p = sqrt(k2 + a2*w)
         q = sqrt(k2 + w)
         kap = 2*k2 + w
         if (k2 > 2*abs(w)) then ! R multiplied out: its terms cancel for large k
            rayleigh = w*(16*(1 - a2)*k2**3 + (24 - 16*a2)*k2**2*w + 8*k2*w**2 + w**3)/(kap**2 + 4*k2*p*q)
         else
            rayleigh = kap**2 - 4*k2*p*q
         end if
         compliance = compliance + weight(i)*shape(i, :)*(p*w/rayleigh - 0.75_r/node(i))
      end do
   end function

   ! Inverse transform at s = eta + i omega; eta T = 14 keeps wrap-around below 1e-6.
   function exact(t)
      real(r), intent(in) :: t
      real(r) :: exact(2)
      integer, parameter :: terms = 200
      real(r), parameter :: period = 16, eta = 0.875_r
      complex(r), allocatable, save :: u(:, :)
      complex(r) :: s
      integer :: j
      if (.not. allocated(u)) then
         allocate (u(2, 0:terms))
         do j = 0, terms
            s = cmplx(eta, 2*pi*j/period, r)
            u(:, j) = lever*force_transform(s)/(pushed*s**2 + 1/compliance(s))
         end do
      end if
      exact = real(u(:, 0))/2
      do j = 1, terms
         exact = exact + real(u(:, j)*exp(cmplx(0.0_r, 2*pi*j*t/period, r)))
      end do
      exact = exact*2/period*exp(eta*t)
   end function
end program
