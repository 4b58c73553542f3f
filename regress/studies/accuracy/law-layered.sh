#!/bin/sh
# The coefficients of the error law of layered ground with tuned splines in src/accuracy/surface.c (doc/verification/accuracy.md, section 3), anew: as law.sh,
# on a soft layer over rock. Usage: sh regress/studies/accuracy/law-layered.sh [BUILD] (two minutes of one core). Leaves output/accuracy-layered/.
set -eu
build=${1:-build}
out=output/accuracy-layered
mkdir -p "$out"
OMP_NUM_THREADS=1
export OMP_NUM_THREADS

shoot() { # shoot NAME SPACING WIDTH TOP SPEED: quarter of a ground from which next to nothing comes back in time
    [ -e "$out/$1/report.txt" ] && return
    cat >"$out/$1.nml" <<DECK
&scene dimension = 3, end_time = 7 /
&material name = 'rock', density = 1, s_speed = 1, p_speed = 1.7320508 /
&material name = 'soil', density = 1, s_speed = $5, p_speed = $(awk "BEGIN { print $5 * 1.7320508 }") /
&body material = 'rock', low = 0, 0, 0, high = 7, 7, 5, spacing = $2 /
&layer material = 'soil', top = 0 /
&layer material = 'rock', top = $4 /
&boundary face = 'x-', 'y-', kind = 'symmetry' /
&boundary face = 'x+', 'y+', 'z+', kind = 'transmitting', layer = 'lysmer' /
&load face = 'z-', shape = 'square', centre = 0, 0, 0, size = 1, 1, direction = 0, 0, 1, history = 'gaussian', width = $3, delay = $(awk "BEGIN { print 5 * $3 }") /
&receiver name = 'r0', position = 0, 0, 0 / &receiver name = 'r1', position = 1, 0, 0 /
&receiver name = 'r2', position = 2, 0, 0 / &receiver name = 'd2', position = 1.5, 1.5, 0 /
&reference kind = 'lamb' /
&output directory = '$out/$1', plots = .false. /
DECK
    "$build/selas" -q "$out/$1.nml"
}
. regress/studies/accuracy/spectra.sh
: >"$out/spectra.txt"
for run in fifth:.2:.26:1:.5 sixth:.1666666666666667:.21:1:.5 thin:.125:.16:.6:.5 faster:.1666666666666667:.16:.5:.6666667 eighth:.125:.16:1:.5 \
    tenth:.1:.13:1:.5; do
    # shellcheck disable=SC2046 # five words
    set -- $(echo "$run" | tr : ' ')
    shoot "$@"
    spectra "$1" "$2" "$3" "$(awk "BEGIN { print .9194 * $5 }")" "$(awk "BEGIN { print 3.3 * .9194 * $5 }")" "$4" .9194
done
awk -v scale=1.8 -v felt=.5 -v together=1 -v start='-7 6 -13 8 4 5.2 3.5 .4' -f regress/studies/accuracy/law.awk "$out/spectra.txt"
