# The hosts of regress/hosts/ are built against an installed copy (pkg-config, DESTDIR) and run; what is installed, the
# names that the libraries show, and the declarations of the Fortran module are checked. Argument: the build folder.
build=$(cd "${1:-build}" && pwd)
root=$PWD
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
export OMP_NUM_THREADS=1
check() { # check NAME COMMAND...
    name=$1
    shift
    if "$@" >"$work/log" 2>&1; then echo "ok - $name"; else
        echo "not ok - $name"
        sed 's/^/# /' "$work/log" | head -20
    fi
}
place=$work/place
check "make install" make -s install BUILD="$build" PREFIX="$place"
check "make install with DESTDIR puts the same files below it" sh -c "
    make -s install BUILD='$build' PREFIX=/opt/selas DESTDIR='$work/dest' &&
    (cd '$place' && find . | sort) >'$work/one' && (cd '$work/dest/opt/selas' && find . | sort) >'$work/two' &&
    cmp '$work/one' '$work/two' && grep -q '^prefix=/opt/selas$' '$work/dest/opt/selas/lib/pkgconfig/selas.pc'"
check "make uninstall leaves no file" sh -c "
    make -s uninstall BUILD='$build' PREFIX=/opt/selas DESTDIR='$work/dest' && ! find '$work/dest' ! -type d | grep -q ."
only_selas() { ! nm "$@" | awk 'NF > 1 {print $NF}' | grep -v '^selas_'; }
check "libselas.so shows only selas_ names" only_selas -D --defined-only "$place/lib/libselas.so"
check "libselas.a shows only selas_ names" only_selas -g --defined-only "$place/lib/libselas.a"
check "libselas.so has a versioned name" sh -c "readelf -d '$place/lib/libselas.so' | grep -q 'SONAME.*libselas.so.[0-9]'"

export PKG_CONFIG_PATH=$place/lib/pkgconfig
flags="$(pkg-config --cflags --libs selas-fortran) -Wl,-rpath,$place/lib"
cd "$work" || exit 1
for host in halfspace_by_calls coupled_mass twins; do
    # shellcheck disable=SC2086
    check "$host compiles (f2018)" gfortran -std=f2018 -Wall -Wno-compare-reals -Werror -O1 "$root/regress/hosts/$host.f90" $flags -o $host
done
# shellcheck disable=SC2086
check "legacy compiles (fixed form, legacy)" gfortran -std=legacy -ffixed-form -O1 "$root/regress/hosts/legacy.f" $flags -o legacy
cat >ten.c <<'C'
#include <selas.h>
#include <stdio.h>
int main(int count, char **words)
{
    selas_simulation *sim = NULL;
    selas_status status = selas_open_deck(count > 1 ? words[1] : "", &sim);
    if (status == SELAS_OK) status = selas_step(sim, 3);
    if (status != SELAS_OK) fprintf(stderr, "%s\n", selas_message(sim));
    selas_close(&sim);
    return status == SELAS_OK ? 0 : 1;
}
C
shared="$(pkg-config --cflags --libs selas) -Wl,-rpath,$place/lib"
# shellcheck disable=SC2086
check "a C host links the shared library" sh -c "cc -std=c17 -Wall -Werror ten.c $shared -o ten && ./ten '$root/input/bar.nml'"
# shellcheck disable=SC2046
check "a C host links the static library" sh -c "cc ten.c -I'$place/include' '$place/lib/libselas.a' $(pkg-config --libs gsl fftw3 hdf5) -fopenmp -lm -o ten-static && ./ten-static '$root/input/bar.nml'"

spacing=0.5
check "the program runs halfspace.nml" "$build/selas" -q "$root/input/halfspace.nml" body%spacing=$spacing output%directory="$work/run" output%plots=.false.
check "host 1: by calls, bit for bit the program's histories" ./halfspace_by_calls run $spacing
# measured .0157 at spacing .25 (.0042 at .125, .049 at .5): command in doc/calling.md
check "host 2: two-way coupled mass" ./coupled_mass 0.25 0.018
check "the program runs bar.nml" "$build/selas" -q "$root/input/bar.nml" body%spacing=0.02 output%directory="$work/bar" output%plots=.false.
check "host 3: Fortran 77" ./legacy "$root/input/bar.nml" middle bar/middle.dat 0.02
./twins "$root/input/halfspace.nml" || echo "not ok - the Fortran twins ended early"

# The interfaces of selas.f90 are the declarations of selas.h, types and all; a difference is seen on either side.
check "selas.h and selas.f90 declare the same functions with the same types" sh "$root/regress/hosts/declarations" "$root/src/selas.h" "$root/src/selas.f90"
planted() { # planted FILE EDIT: an edit of selas.h or selas.f90 that the comparison must notice
    cp "$root/src/selas.h" "$root/src/selas.f90" .
    sed "$2" "$root/src/$1" >"$1"
    ! cmp -s "$1" "$root/src/$1" && ! sh "$root/regress/hosts/declarations" selas.h selas.f90
}
check "a changed type in selas.h is noticed" planted selas.h '/selas_advance/s/double time/float time/'
check "a changed pointer in selas.h is noticed" planted selas.h 's/const size_t [*]material/const int *material/'
check "a changed order in selas.h is noticed" planted selas.h 's/const char [*]word, bool value/bool value, const char *word/'
check "a changed kind in selas.f90 is noticed" planted selas.f90 '/function c_set_points/,/end/s/integer(c_size_t), value/integer(c_int), value/'
check "a changed passing in selas.f90 is noticed" planted selas.f90 '/function c_step(/,/end/s/(c_long), value/(c_long), intent(in)/'
check "a changed callback in selas.f90 is noticed" planted selas.f90 '/function call_back/,/end/s/real(c_double), value :: time/real(c_double), intent(in) :: time/'
rm -f selas.h selas.f90
cat >codes.c <<'C'
#include <selas.h>
#include <stdio.h>
int main(void)
{
#define ONE(name, value, gloss) printf("%s %d\n", #name, name);
    SELAS_STATUS_LIST(ONE)
    static const char *const field[] = {"displacement", "velocity", "acceleration", "stress", "strain", "pressure", "energy_density"};
    for (int i = SELAS_DISPLACEMENT; i <= SELAS_ENERGY; i++)
        printf("selas_%s %d\n", field[i], i);
    return 0;
}
C
check "selas.f90 has the same codes and fields" sh -c "
    cc codes.c -I'$place/include' -o codes && ./codes | tr 'A-Z' 'a-z' | sort >codes-c &&
    sed -n '/parameter, public/,/^ *!*\$/p' '$root/src/selas.f90' | tr ',&' '\n\n' |
        sed -n 's/.*\(selas_[a-z_]*\) = \([0-9]*\).*/\1 \2/p' | sort >codes-f && diff codes-c codes-f"
