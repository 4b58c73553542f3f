#!/bin/sh
# The coefficients of plane pulses in src/accuracy/lattice.c (doc/verification/accuracy.md, section 5, and the steps of the four settings), anew. Bars in which
# P waves have speed 1; pulses u = exp(-x^2 / 2), whose velocity has the spectrum omega exp(-omega^2 / 2), so that |omega^k V| / |V| is the square root of
# 1.5 2.5 ... (k factors): 1.936, 3.623, 7.685 for k = 2, 3, 4. Usage: sh regress/studies/accuracy/ends.sh [BUILD] (seconds). Leaves output/accuracy-ends/.
set -eu
build=${1:-build}
out=output/accuracy-ends
mkdir -p "$out"
OMP_NUM_THREADS=1
export OMP_NUM_THREADS

bar() { # bar SPACING END CENTRE FACE RECEIVER... -- OVERRIDES...: 0 <= x <= 40
    {
        echo "&scene dimension = 1, end_time = $2 /"
        echo "&material name = 'rod', density = 1, p_speed = 1, s_speed = .5 /"
        echo "&body material = 'rod', shape = 'box', low = 0, high = 40, spacing = $1 /"
        [ "$4" = free ] || echo "&boundary face = 'x+', kind = '$4' /"
        echo "&initial kind = 'plane-wave', amplitude = 1, wave = 'p', direction = 1, centre = $3, width = 1 /"
        shift 4
        while [ "$1" != -- ]; do
            echo "&receiver name = 'r$1', position = $1 /"
            shift
        done
        echo "&reference kind = 'plane-wave' / &output plots = .false., directory = '$out/run' /"
    } >"$out/bar.nml"
    while [ "$1" != -- ]; do shift; done
    shift
    rm -rf "$out/run"
    "$build/selas" -q "$out/bar.nml" "$@"
}
step() { awk -F': ' '/^time step:/ { print $2 }' "$out/run/report.txt"; }
# error RECEIVER FROM TO: L2 of v - exact in that time over the L2 of the exact velocity at all times
error() {
    grep -v '^#' "$out/run/$1.exact.dat" >"$out/exact"
    grep -v '^#' "$out/run/$1.dat" | paste - "$out/exact" |
        awk -v a="$2" -v b="$3" '{ if ($1 >= a && $1 <= b) d += ($5 - $12)^2; v += $12^2 } END { print sqrt(d / v) }'
}
setting() { # setting DEGREE MASS SCHEME: overrides
    echo "method%degree=$1 method%mass=$2 stepping%scheme=$3"
}

echo "the modified equation's recorded velocity: error / (omega dt)^4, degree 4, from two distances"
for h in .25 .125 .0625; do
    # shellcheck disable=SC2046 # several words
    bar $h 30 10 free 18 34 -- $(setting 4 exact modified-equation)
    awk -v near="$(error r18 0 30)" -v far="$(error r34 0 30)" -v dt="$(step)" -v h=$h 'BEGIN {
        way = (far^2 - near^2) / (24^2 - 8^2); if (way < 0) way = 0
        printf "    spacing %s: %.4f\n", h, sqrt(near^2 - 8^2 * way) / 7.685 / dt^4 }'
done
for scheme in leapfrog modified-equation; do
    echo "what a damper sends back with $scheme: error / (omega dt)^2"
    for h in .5 .25 .125; do
        for dm in '2 vc3' '3 exact' '4 exact'; do
            [ "$scheme" = leapfrog ] && [ "$dm" != '2 vc3' ] && continue
            # shellcheck disable=SC2046,SC2086 # several words
            bar $h 40 20 transmitting 30 -- $(setting $dm $scheme)
            awk -v e="$(error r30 20 40)" -v dt="$(step)" -v h=$h -v dm="$dm" 'BEGIN { printf "    degree %s, spacing %s: %.4f\n", dm, h, e / 1.936 / dt^2 }'
        done
    done
done
echo "one reflection at a held end with sweeps beyond one at a free end: error / (omega h / c)^3, degree 2, modified equation"
for h in .25 .125 .0625 .03125; do
    # shellcheck disable=SC2046 # several words
    bar $h 36 20 fixed 30 -- $(setting 2 vc3 modified-equation)
    held=$(error r30 20 36)
    # shellcheck disable=SC2046 # several words
    bar $h 36 20 free 30 -- $(setting 2 vc3 modified-equation)
    awk -v held="$held" -v free="$(error r30 20 36)" -v h=$h 'BEGIN { d = held^2 - free^2; printf "    spacing %s: %.4f\n", h, sqrt(d > 0 ? d : 0) * sqrt(2) / 3.623 / h^3 }'
done
echo "steps of the settings, c_p dt / spacing in 1, 2, 3 dimensions, and nanoseconds a point and step in three (this machine, now)"
for s in '2 vc3 leapfrog' '2 vc3 modified-equation' '3 exact modified-equation' '4 exact modified-equation'; do
    printf '    degree %s:' "$s"
    for dimension in 1 2 3; do
        places=$(echo "2,2,2" | cut -d, -f1-$dimension)
        cat >"$out/cube.nml" <<DECK
&scene dimension = $dimension, end_time = .4 /
&material name = 'rock', density = 1, p_speed = 1.7320508, s_speed = 1 /
&body material = 'rock', shape = 'box', low = $(echo "0,0,0" | cut -d, -f1-$dimension), high = $(echo "4,4,4" | cut -d, -f1-$dimension), spacing = .125 /
&initial kind = 'plane-wave', amplitude = 1, wave = 'p', direction = $(echo "1,0,0" | cut -d, -f1-$dimension), centre = $places, width = .3 /
&receiver name = 'a', position = $places /
&output plots = .false., directory = '$out/run' /
DECK
        # shellcheck disable=SC2046,SC2086 # several words
        "$build/selas" -q "$out/cube.nml" $(setting $s)
        printf ' %s' "$(awk "BEGIN { printf \"%.2f\", 1.7320508 * $(step) / .125 }")"
    done
    awk -F': ' '/^unknowns/ { u = $2 } /^operator calls/ { calls = $2 } /^steps done/ { n = $2 } /^stepping CPU seconds/ { c = $2 } END { printf ", %.0f ns\n", 3e9 * c / u / n }' "$out/run/report.txt"
done
