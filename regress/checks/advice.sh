#!/bin/sh
# What may be wrong in a scene is told by `selas check` and in the report, with what would be right; a sound scene is told
# nothing; --strict makes errors of it. Argument: the build folder. Prints TAP.
build=${1:-build}
selas=$PWD/$build/selas
work=$(mktemp -d "${TMPDIR:-/tmp}/selas-advice-XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
export OMP_NUM_THREADS=1
failures=0
cat >good.nml <<'END'
&scene dimension = 2, end_time = 2.0 /
&material name = 'rock', density = 1.0, lambda = 1.0, mu = 1.0 /
&body material = 'rock', shape = 'box', low = 0, 0, high = 4, 4, spacing = 0.25 /
&boundary face = 'x+', 'y+', kind = 'transmitting' /
&boundary face = 'x-', kind = 'symmetry' /
&load face = 'y-', shape = 'square', centre = 0, 0, size = 1, direction = 0, 1, history = 'gaussian', width = 1, delay = 5 /
&receiver name = 'r', position = 2, 1 /
&output plots = .false. /
END
told() { # told WHAT WORDS OVERRIDE...: the plan warns with the words, and of nothing else
    what=$1
    words=$2
    shift 2
    "$selas" check good.nml "$@" >said 2>&1
    "$selas" --strict check good.nml "$@" >strict 2>&1
    status=$?
    if [ "$(grep -c '^warning' said)" -eq 1 ] && grep -q "^warning: .*$words" said && [ $status -eq 2 ] &&
        grep -q "^error: .*$words" strict; then
        echo "ok - $what"
    else
        echo "not ok - $what (strict: $status)"
        grep -E '^(warning|error)' said strict | sed 's/^/# /'
        failures=$((failures + 1))
    fi
}
if "$selas" --strict check good.nml >said 2>&1 && ! grep -q warning said; then
    echo "ok - nothing to warn of"
else
    echo "not ok - nothing to warn of"
    sed 's/^/# /' said
    failures=1
fi
# cutoff of the gaussian: exp(-(w width)^2 / 2) = .05 at w = 2.448 / width; S waves of speed 1: 4 points at spacing .642 width
told "few points per wavelength" "3.08 points per wavelength .* 4 need body%spacing = 0.193" load%width=.3 load%delay=2
told "a small step" "leave stepping%time_step" stepping%time_step=1e-3
told "a receiver at an absorbing face" "receiver 'r' lies at the absorbing face x+ .*(0.5) inside" receiver%position=3.9,2
told "a load on an absorbing face" "load 1 acts on the absorbing face y+" load%face=y+ load%centre=0,4
told "a patch beside the lattice" "edges of load 1 along x lie between points; -0.5 to 0.5 would" method%variant=paper load%size=1.1 "boundary(2)%kind=free"
told "half a patch that is no half" "symmetry plane x- cuts load 1 beside its middle: .*x = 0 would" load%centre=0.25,0
told "a push across the symmetry plane" "pushes across the symmetry plane x-" load%direction=1,0
"$selas" -q good.nml receiver%position=3.9,2 output%directory=out
if grep -q "^warning: receiver 'r'" out/report.txt; then
    echo "ok - the report tells too"
else
    echo "not ok - the report tells too"
    failures=$((failures + 1))
fi
exit $failures
