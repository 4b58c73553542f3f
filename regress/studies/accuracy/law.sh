#!/bin/sh
# The coefficients of the error law in src/accuracy/surface.c (doc/verification/accuracy.md, section 3), anew: runs of the default method under a pulse
# that is short against the lattice, spectra of error and exact velocity, least squares. Usage: sh regress/studies/accuracy/law.sh [BUILD]
# (some three minutes of one core). Leaves output/accuracy-law/; prints coefficients and how well they predict.
set -eu
build=${1:-build}
out=output/accuracy-law
mkdir -p "$out"
OMP_NUM_THREADS=1
export OMP_NUM_THREADS

shoot() { # shoot NAME SPACING WIDTH DELAY END NU HIGH: quarter of a half-space from which nothing comes back
    [ -e "$out/$1/report.txt" ] && return
    cat >"$out/$1.nml" <<DECK
&scene dimension = 3, end_time = $5 /
&material name = 'rock', density = 1, s_speed = 1, p_speed = $(awk "BEGIN { print sqrt((2 - 2 * $6) / (1 - 2 * $6)) }") /
&body material = 'rock', low = 0, 0, 0, high = $7, spacing = $2 /
&boundary face = 'x-', 'y-', kind = 'symmetry' /
&load face = 'z-', shape = 'square', centre = 0, 0, 0, size = 1, 1, direction = 0, 0, 1, history = 'gaussian', width = $3, delay = $4 /
&receiver name = 'r0', position = 0, 0, 0 / &receiver name = 'r1', position = 1, 0, 0 /
&receiver name = 'r2', position = 2, 0, 0 / &receiver name = 'd2', position = 1.5, 1.5, 0 /
&reference kind = 'lamb' /
&output directory = '$out/$1', plots = .false. /
DECK
    "$build/selas" -q "$out/$1.nml"
}
shoot third .3333333333333333 .2 1 6 .25 7,6.666666666666667,6
shoot fourth .25 .16 .8 6 .25 7,6.5,6
shoot fifth .2 .13 .65 6 .25 7,6.6,6
shoot sixth .1666666666666667 .11 .55 5.5 .25 6.5,6,5.5
shoot eighth .125 .08 .4 5.5 .25 6.5,6,5.5
shoot tenth .1 .064 .32 5.5 .25 6.5,6,5.5
shoot soft .125 .08 .4 5.5 .4 10.5,10,8
shoot hard .125 .08 .4 5.5 .1 6,5.5,5

. regress/studies/accuracy/spectra.sh
: >"$out/spectra.txt"
for run in third:.3333333333333333:.2:.9194 fourth:.25:.16:.9194 fifth:.2:.13:.9194 sixth:.1666666666666667:.11:.9194 \
    eighth:.125:.08:.9194 tenth:.1:.064:.9194 soft:.125:.08:.9422 hard:.125:.08:.8931; do
    # shellcheck disable=SC2046 # four words
    spectra $(echo "$run" | tr : ' ') 3.3
done
awk -f regress/studies/accuracy/law.awk "$out/spectra.txt"
