! Simple shear of one RVE at constant volume, by the C interface of rvelab:  element_test SPECIMEN.h5
!
! Prints gamma and the stresses across the shear plane in Pa, tension positive. Matrices of the interface are row-major:
! dH(2) is d(du_x)/dy. A negative status is an error; rvelab_last_error has its text, which is printed.
program element_test
  use, intrinsic :: iso_c_binding
  use, intrinsic :: iso_fortran_env, only: error_unit
  implicit none
  interface
    integer(c_int32_t) function rvelab_pool_create(def, pool) bind(c)
      import
      type(c_ptr), value :: def
      type(c_ptr) :: pool
    end function
    integer(c_int32_t) function rvelab_template_load(pool, path, tmpl) bind(c)
      import
      type(c_ptr), value :: pool
      character(kind=c_char) :: path(*)
      integer(c_int64_t) :: tmpl
    end function
    integer(c_int32_t) function rvelab_spawn(pool, tmpl, n, ids) bind(c)
      import
      type(c_ptr), value :: pool
      integer(c_int64_t), value :: tmpl, n
      integer(c_int64_t) :: ids(*)
    end function
    integer(c_int32_t) function rvelab_apply(pool, id, dH, dt, sigma) bind(c)
      import
      type(c_ptr), value :: pool
      integer(c_int64_t), value :: id
      real(c_double) :: dH(9), sigma(9)
      real(c_double), value :: dt
    end function
    integer(c_int32_t) function rvelab_pool_destroy(pool) bind(c)
      import
      type(c_ptr), value :: pool
    end function
    type(c_ptr) function rvelab_last_error() bind(c)
      import
    end function
    integer(c_size_t) function strlen(text) bind(c)
      import
      type(c_ptr), value :: text
    end function
  end interface
  type(c_ptr) :: pool
  integer(c_int64_t) :: specimen, ids(1)
  real(c_double) :: dH(9), sigma(9)
  character(len=1024) :: path
  integer :: step

  if (command_argument_count() /= 1) then
    write (error_unit, "(a)") "usage: element_test SPECIMEN.h5, a file of discs that rvelab pack wrote"
    stop 2
  end if
  call get_command_argument(1, path)
  call expect(rvelab_pool_create(c_null_ptr, pool))
  call expect(rvelab_template_load(pool, trim(path)//c_null_char, specimen))
  call expect(rvelab_spawn(pool, specimen, 1_c_int64_t, ids))
  dH = 0
  dH(2) = 1d0/8192
  do step = 1, 40
    call expect(rvelab_apply(pool, ids(1), dH, 0d0, sigma))
    if (mod(step, 8) == 0) print "(f8.5, 2es24.16)", step*dH(2), sigma(2), sigma(5)
  end do
  call expect(rvelab_pool_destroy(pool))

contains

  ! error stop alone would print a backtrace and not what was wrong.
  subroutine expect(status)
    integer(c_int32_t), intent(in) :: status
    character(kind=c_char), pointer :: letters(:)
    if (status >= 0) return
    call c_f_pointer(rvelab_last_error(), letters, [strlen(rvelab_last_error())])
    write (error_unit, "(*(a))") "element_test: ", letters
    stop 1
  end subroutine
end program
