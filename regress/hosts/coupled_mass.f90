! Host 2: a mass m on the half-space, coupled both ways. The mass rests on a patch of uniform pressure and moves
! with the patch's mean displacement U; a force F(t) acts on it. At every step the ground tells the patch's mean
! acceleration and the mass the force R it presses with:
!
!    m U'' = F - R,     U = mean displacement of the ground under R.                                          (1)
!
! R is found without iteration: the acceleration is linear in the load, a = a0 + b R with b measured once, so that
! R = R0 + (F - R0 - m a(R0)) / (1 + m b).                                                                   (2)
!
! Exact answer (Laplace transform, C(s) the mean compliance of the patch): m s^2 U + U / C(s) = F(s), with
!    C(s) = 1/(4 pi^2) int int X^2 uz(k, s) dkx dky,  X = (2 sin(kx/2)/kx) (2 sin(ky/2)/ky),                   (3)
!    uz = nu_p w / R,  R = (2 k^2 + w)^2 - 4 k^2 nu_p nu_s,  w = s^2/cs^2  (Lamb 1904; doc/lamb.md).             (4)
! The integral is split: the static part uz = (1 - nu)/k in closed form, the rest by Gauss quadrature.
!
!   coupled_mass [SPACING [TOLERANCE]]     prints the relative L2 error of U; ends with 1 if above the tolerance
program coupled_mass
   use, intrinsic :: iso_fortran_env, only: real64, error_unit
   use selas
   implicit none
   integer, parameter :: r = real64
   real(r), parameter :: pi = acos(-1.0_r), mass = 1.0_r, last = 3.7_r
   type(selas_simulation) :: sim
   character(32) :: word
   real(r) :: spacing, tolerance, pressed, b, acceleration, displacement, difference, norm, answer
   real(r), allocatable :: node(:), weight(:), shape(:)

   call get_command_argument(1, word)
   spacing = 0.25_r
   if (word /= '') read (word, *) spacing
   call get_command_argument(2, word)
   tolerance = 0.01_r
   if (word /= '') read (word, *) tolerance

   call describe_ground()
   call prepare_compliance()
   call sim%set_load('patch', 1.0_r)             ! from now on the host drives the patch
   call sim%load_mean('patch', selas_acceleration, b)
   pressed = 0
   difference = 0
   norm = 0
   do while (sim%time() < last)
      call sim%set_load('patch', pressed)
      call sim%load_mean('patch', selas_acceleration, acceleration)
      pressed = pressed + (force(sim%time()) - pressed - mass*acceleration)/(1 + mass*b)
      call sim%set_load('patch', pressed)
      call sim%load_mean('patch', selas_displacement, displacement)
      answer = exact(sim%time())
      difference = difference + (displacement - answer)**2
      norm = norm + answer**2
      call sim%step()
      if (sim%status() /= selas_ok) then
         write (error_unit, '(a)') sim%message()
         error stop 1
      end if
   end do
   print '(a, f6.4, a, f8.5, a, f8.5)', 'spacing ', spacing, ': relative L2 error of the mass''s motion ', &
      sqrt(difference/norm), ', U at the end ', displacement
   if (.not. sqrt(difference/norm) < tolerance) error stop 1

contains

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
      call sim%add('load')
      call sim%set('load%name', 'patch')
      call sim%set('load%face', 'z-')
      call sim%set('load%shape', 'square')
      call sim%set('load%centre', [3.5_r, 3.5_r, 0.0_r])
      call sim%set('load%size', [1.0_r, 1.0_r])
      call sim%set('load%direction', [0.0_r, 0.0_r, 1.0_r])
      call sim%set('load%history', 'step')
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

   ! Panels of 12 Gauss points in k, with k A(k), A(k) = 1/(4 pi^2) times the integral of X^2 over the circle.
   subroutine prepare_compliance()
      real(r), parameter :: x(6) = [0.125233408511468916_r, 0.367831498998180194_r, 0.587317954286617447_r, &
         0.769902674194304687_r, 0.904117256370474857_r, 0.981560634246719251_r]
      real(r), parameter :: w(6) = [0.249147045813402785_r, 0.233492536538354809_r, 0.203167426723065922_r, &
         0.160078328543346226_r, 0.106939325995318431_r, 0.047175336386511827_r]
      integer, parameter :: panels = 160, angles = 400
      real(r), parameter :: half = 0.375_r
      integer :: panel, i, j, at
      real(r) :: phi, k, total
      allocate (node(12*panels), weight(12*panels), shape(12*panels))
      at = 0
      do panel = 1, panels
         do i = 1, 12
            at = at + 1
            k = half*(2*panel - 1) + merge(1, -1, i > 6)*half*x(mod(i - 1, 6) + 1)
            total = 0
            do j = 1, angles ! midpoints of a quadrant
               phi = (j - 0.5_r)*pi/(2*angles)
               total = total + (sinc(k*cos(phi)/2)*sinc(k*sin(phi)/2))**2
            end do
            node(at) = k
            weight(at) = half*w(mod(i - 1, 6) + 1)
            shape(at) = k*total*(2*pi/angles)/(4*pi**2)
         end do
      end do
   end subroutine

   real(r) function sinc(x)
      real(r), intent(in) :: x
      sinc = 1
      if (abs(x) > 1e-8_r) sinc = sin(x)/x
   end function

   ! (3), lambda = mu = rho = 1: cs = 1, cp^2 = 3, nu = 1/4; the static mean of 1/r over two points of a unit square
   ! is 4 log(1 + sqrt 2) - 4 (sqrt 2 - 1) / 3.
   complex(r) function compliance(s)
      complex(r), intent(in) :: s
      real(r), parameter :: a2 = 1.0_r/3, mean = 4*log(1 + sqrt(2.0_r)) - 4*(sqrt(2.0_r) - 1)/3
      complex(r) :: w, p, q, kap, rayleigh
      real(r) :: k2
      integer :: i
      w = s**2
      compliance = 0.75_r/(2*pi)*mean
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
         compliance = compliance + weight(i)*shape(i)*(p*w/rayleigh - 0.75_r/node(i))
      end do
   end function

   ! Inverse transform at s = eta + i omega; eta T = 14 keeps wrap-around below 1e-6.
   real(r) function exact(t)
      real(r), intent(in) :: t
      integer, parameter :: terms = 200
      real(r), parameter :: period = 16, eta = 0.875_r
      complex(r), allocatable, save :: u(:)
      complex(r) :: s
      integer :: j
      if (.not. allocated(u)) then
         allocate (u(0:terms))
         do j = 0, terms
            s = cmplx(eta, 2*pi*j/period, r)
            u(j) = force_transform(s)/(mass*s**2 + 1/compliance(s))
         end do
      end if
      exact = real(u(0))/2
      do j = 1, terms
         exact = exact + real(u(j)*exp(cmplx(0.0_r, 2*pi*j*t/period, r)))
      end do
      exact = exact*2/period*exp(eta*t)
   end function
end program
