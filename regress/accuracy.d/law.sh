#!/bin/sh
# The coefficients of the error law in src/scene/accuracy_ground.c (doc/accuracy.md, section 3), anew: runs of the default method under a pulse
# that is short against the lattice, spectra of error and exact velocity, least squares. Usage: sh regress/accuracy.d/law.sh [BUILD]
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

# Spectra: run, receiver, spacing, Rayleigh speed, distance, diagonal, then omega |D|^2 |V|^2 over the pulse's own spectrum.
: >"$out/spectra.txt"
for run in third:.3333333333333333:.2:.9194 fourth:.25:.16:.9194 fifth:.2:.13:.9194 sixth:.1666666666666667:.11:.9194 \
    eighth:.125:.08:.9194 tenth:.1:.064:.9194 soft:.125:.08:.9422 hard:.125:.08:.8931; do
    # shellcheck disable=SC2046 # four words
    set -- $(echo "$run" | tr : ' ')
    for receiver in r0:0:0 r1:1:0 r2:2:0 d2:2.1213:1; do
        name=${receiver%%:*}
        grep -hv '^#' "$out/$1/$name.exact.dat" >"$out/exact"
        grep -hv '^#' "$out/$1/$name.dat" | paste - "$out/exact" | awk -v head="$1 $name $2 $4 $(echo "${receiver#*:}" | tr : ' ')" -v h="$2" -v width="$3" '
            { t[NR] = $1; for (c = 0; c < 3; c++) { e[NR, c] = $(12 + c); d[NR, c] = $(5 + c) - $(12 + c) } }
            END {
                pi = atan2(0, -1)
                for (j = 1; j <= NR; j++) { # the last quarter fades out, so that its end makes no frequencies
                    late = (t[j] / t[NR] - .75) / .25
                    if (late > 0) for (c = 0; c < 3; c++) { e[j, c] *= .5 * (1 + cos(pi * late)); d[j, c] *= .5 * (1 + cos(pi * late)) }
                }
                for (w = .5 * pi / t[NR]; w < 3.3 / h; w += pi / t[NR]) {
                    whole = error = 0
                    for (c = 0; c < 3; c++) {
                        er = ei = dr = di = 0
                        for (j = 1; j <= NR; j++) {
                            a = cos(w * t[j]); b = sin(w * t[j])
                            er += e[j, c] * a; ei += e[j, c] * b; dr += d[j, c] * a; di += d[j, c] * b
                        }
                        whole += er * er + ei * ei; error += dr * dr + di * di
                    }
                    print head, w, error * exp((w * width)^2), whole * exp((w * width)^2)
                }
            }' >>"$out/spectra.txt"
    done
done
awk -f regress/accuracy.d/law.awk "$out/spectra.txt"
