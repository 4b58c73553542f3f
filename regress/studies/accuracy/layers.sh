#!/bin/sh
# What absorbing layers of n points leave (doc/verification/accuracy.md, Eq 5a; src/advice/layers.c, the points of src/accuracy/ground.c), and how much less
# receivers in the ground err (BURIED of src/accuracy/surface.c), anew. Usage: sh regress/studies/accuracy/layers.sh [BUILD] (a minute or two of one core).
# Leaves output/accuracy-layers/.
set -eu
build=${1:-build}
out=output/accuracy-layers
mkdir -p "$out"
OMP_NUM_THREADS=1
export OMP_NUM_THREADS

ground() { # ground END HIGH RECEIVERS: quarter of a half-space under the smooth pulse
    echo "&scene dimension = 3, end_time = $1 /"
    echo "&material name = 'rock', density = 1, lambda = 1, mu = 1 /"
    echo "&body material = 'rock', low = 0, 0, 0, high = $2, spacing = .1 /"
    echo "&boundary face = 'x-', 'y-', kind = 'symmetry' /"
    echo "&load face = 'z-', shape = 'square', centre = 0, 0, 0, size = 1, 1, direction = 0, 0, 1, history = 'triangle', duration = 2, smoothing = 1 /"
    for place in $3; do echo "&receiver name = 'r$(echo "$place" | tr , -)', position = $place /"; done
    echo "&output plots = .false., directory = '$out/run' /"
}
error() { sed -n "s/^error $1 velocity: L2 \([^ ]*\).*/\1/p" "$out/run/report.txt"; }

# The velocity's difference to layers of 20 points and more, as the error against such a run: a reference of kind 'file'.
echo 'n points leave, error at the worst receiver; (5a) says'
for at in .1:20 .0625:24; do
    h=${at%:*}
    ground 6 2.5,1.5,1.5 '0,0,0 1,0,0 2,0,0' >"$out/thick.nml"
    echo "&boundary face = 'x+', 'y+', 'z+', kind = 'transmitting', layer = 'pml', layer_points = ${at#*:} /" >>"$out/thick.nml"
    rm -rf "$out/thick" "$out/run"
    "$build/selas" -q "$out/thick.nml" "body%spacing=$h" "output%directory=$out/thick"
    for n in 4 6 8 10; do
        sed "s/layer_points = [0-9]*/layer_points = $n/" "$out/thick.nml" >"$out/thin.nml"
        echo "&reference kind = 'file', file = 'thick' /" >>"$out/thin.nml"
        "$build/selas" -q "$out/thin.nml" "body%spacing=$h"
        awk -v e="$(sed -n 's/^error largest: \([^ ]*\).*/\1/p' "$out/run/report.txt")" -v n=$n -v h="$h" \
            'BEGIN { printf "    spacing %s, n %d: %.2g; %.2g\n", h, n, e, .0011 * exp(-.78 * n) * (5.1 / h)^1.7 }'
    done
done
echo 'errors in the ground over those at the surface as far from the load'
for h in .25 .2 .125; do
    { ground 5 5.5,5.5,5.5 '0,0,0 0,0,1 1,0,0 1,0,1 1.4,0,0' && echo "&reference kind = 'lamb' /"; } | sed 's/high = 5.5,5.5,5.5/high = 6,6,6/' >"$out/deep.nml"
    "$build/selas" -q "$out/deep.nml" "body%spacing=$h"
    awk -v under="$(error r0-0-1)" -v beside="$(error r1-0-1)" -v one="$(error r1-0-0)" -v far="$(error r1.4-0-0)" -v h=$h \
        'BEGIN { printf "    spacing %s: under the load %.2f, beside it %.2f\n", h, under / one, beside / far }'
done
