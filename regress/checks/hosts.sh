# The hosts of regress/hosts/ are built against an installed copy (pkg-config, DESTDIR) and run; what is installed, the
# names that the libraries show, and the declarations of the Fortran module are checked. Argument: the build folder.
build=${1:-build}
root=$PWD
selas=$root/$build/selas
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
place="$work/a place" # blanks in a path hurt nobody
check "make install" make -s install BUILD="$build" PREFIX="$place"
check "make install with DESTDIR puts the same files below it" sh -c "
    make -s install BUILD='$build' PREFIX=/opt/selas DESTDIR='$work/dest' &&
    (cd '$place' && find . | sort) >'$work/one' && (cd '$work/dest/opt/selas' && find . | sort) >'$work/two' &&
    cmp '$work/one' '$work/two' && grep -q '^prefix=/opt/selas$' '$work/dest/opt/selas/lib/pkgconfig/selas.pc'"
check "make uninstall leaves no file" sh -c "
    make -s uninstall BUILD='$build' PREFIX=/opt/selas DESTDIR='$work/dest' && ! find '$work/dest' ! -type d | grep -q ."
only_selas() { ! nm "$@" | awk 'NF > 1 {print $NF}' | grep -v '^selas_'; }
check "the manual and the decks are installed" test -s "$place/share/doc/selas/README.md" -a -s "$place/share/selas/halfspace.nml" -a -s "$place/share/selas/loh2-fault.txt"
check "libselas.so shows only selas_ names" only_selas -D --defined-only "$place/lib/libselas.so"
check "libselas.a shows only selas_ names" only_selas -g --defined-only "$place/lib/libselas.a"
check "libselas.so has a versioned name" sh -c "readelf -d '$place/lib/libselas.so' | grep -q 'SONAME.*libselas.so.[0-9]'"

export PKG_CONFIG_PATH=$place/lib/pkgconfig
with() { # with PACKAGE COMMAND...: the command with what pkg-config says of the package
    package=$1
    shift
    eval "set -- \"\$@\" $(pkg-config $static --cflags --libs "$package")"
    "$@"
}
static=
rpath="-Wl,-rpath,$place/lib"
cd "$work" || exit 1
for host in halfspace_by_calls coupled_mass twins wrong_handles; do
    check "$host compiles (f2018)" with selas-fortran gfortran -std=f2018 -Wall -Wno-compare-reals -Werror -O1 "$rpath" \
        -o $host "$root/regress/hosts/$host.f90"
done
check "legacy compiles (fixed form, legacy)" with selas-fortran gfortran -std=legacy -ffixed-form -O1 "$rpath" -o legacy \
    "$root/regress/hosts/legacy.f"
check "legacy_scene compiles" with selas-fortran gfortran -std=legacy -ffixed-form -O1 "$rpath" -o legacy_scene \
    "$root/regress/hosts/legacy_scene.f"
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
check "a C host links the shared library" with selas cc -std=c17 -Wall -Werror "$rpath" -o ten ten.c
check "and runs" ./ten "$root/input/bar.nml"
static=--static
check "a C host links all libraries statically" with selas cc -static -o ten-static ten.c
check "and runs" ./ten-static "$root/input/bar.nml"
check "a Fortran host links all libraries statically" with selas-fortran gfortran -static -o legacy-static "$root/regress/hosts/legacy.f"
mkdir alone
cp "$place"/lib/*.a alone/
check "a C host links libselas.a with the other libraries shared" with selas cc -Lalone -o ten-mixed ten.c
check "it needs no libselas.so" sh -c "! readelf -d ten-mixed | grep -q 'NEEDED.*selas' && ./ten-mixed '$root/input/bar.nml'"

spacing=0.5
check "the program runs halfspace.nml" "$selas" -q "$root/input/halfspace.nml" body%spacing=$spacing output%directory="$work/run" output%plots=.false.
check "host 1: by calls, bit for bit the program's histories" ./halfspace_by_calls run $spacing
# measured .0157 at spacing .25 (.0042 at .125, .049 at .5): command in doc/howto/calling.md
check "host 2: two-way coupled block" ./coupled_mass 0.25 0.018 0.065
check "the program runs bar.nml" "$selas" -q "$root/input/bar.nml" body%spacing=0.02 output%directory="$work/bar" output%plots=.false.
check "host 3: Fortran 77" ./legacy "$root/input/bar.nml" middle bar/middle.dat 0.02
check "host 3, all libraries static" ./legacy-static "$root/input/bar.nml" middle bar/middle.dat 0.02
check "Fortran 77: a scene by calls, energy, saved and taken up again" ./legacy_scene
# with 8-byte default integers the Fortran part has to be compiled with them too (doc/howto/calling.md, section 6)
check "and with -fdefault-integer-8 throughout" with selas gfortran -std=legacy -fdefault-integer-8 "$rpath" -o legacy_8 \
    "$place"/include/selas/selas.f90 "$place"/include/selas/selas77.f90 "$root/regress/hosts/legacy_scene.f"
check "which runs" ./legacy_8
check "and with 8-byte default reals" with selas-fortran gfortran -std=legacy -fdefault-real-8 -fdefault-double-8 "$rpath" -o legacy_r8 \
    "$root/regress/hosts/legacy_scene.f"
check "which runs too" ./legacy_r8
check "handles that are none are refused" ./wrong_handles "$root/input/bar.nml"
./twins "$root/input/halfspace-lysmer.nml" || echo "not ok - the Fortran twins ended early"

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
    cc codes.c '-I$place/include' -o codes && ./codes | tr 'A-Z' 'a-z' | sort >codes-c &&
    sed -n '/parameter, public/,/^ *!*\$/p' '$root/src/selas.f90' | tr ',&' '\n\n' |
        sed -n 's/.*\(selas_[a-z_]*\) = \([0-9]*\).*/\1 \2/p' | sort >codes-f && diff codes-c codes-f"

# CFLAGS is in every link, as -fsanitize and -flto need it: objects that are there linked anew.
cd "$root" || exit 1
mkdir "$work/linked"
cp -a "$build/obj" "$build/commit" "$work/linked/"
linked() { # linked FILE: it asks for the library of the sanitizer
    make --no-print-directory BUILD="$work/linked" CFLAGS='-O1 -fsanitize=undefined' "$work/linked/$1" && readelf -d "$work/linked/$1" | grep -q libubsan
}
check "CFLAGS is used in linking the program" linked selas
check "CFLAGS is used in linking the shared library" linked "$(basename "$(readlink "$place/lib/libselas.so")")"

# A tree on a path with blanks
tree="$work/a tree"
mkdir -p "$tree/$build"
cp -a Makefile src input doc regress "$tree/"
cp -a "$build/obj" "$build/whole" "$build"/[!t]*.* "$tree/$build/"
cd "$tree" || exit 1
check "a tree on a path with blanks: make" make -s BUILD="$build"
check "and make install" make -s install BUILD="$build" PREFIX="$tree/in stalled"
check "and make uninstall" sh -c "make -s uninstall BUILD='$build' PREFIX='$tree/in stalled' && ! find 'in stalled' ! -type d | grep -q ."
check "and scripts there" sh -c "! TMPDIR='$tree' sh regress/checks/wrong-decks.sh '$build' | grep -v '^ok' && ! sh regress/checks/results.sh '$build' | grep -v '^ok'"
