#!/bin/sh
# Mirror planes that the program finds by itself: with method%symmetry on and off the same histories to 1e-12 of
# the largest value, for a part of the work and of the memory; none where there are none.
build=${1:-build}
out=$(mktemp -d) || exit 1
trap 'rm -rf "$out"' EXIT
OMP_NUM_THREADS=1
export OMP_NUM_THREADS

# deck NAME DIMENSION BODY REST: leaves $out/NAME.nml
deck() {
    cat >"$out/$1.nml" <<DECK
&scene dimension = $2, end_time = 3.0 /
&stepping time_step = 0.05 /
&material name = 'rock', density = 1.3, lambda = 1.7, mu = 0.9 /
&body material = 'rock', spacing = 0.25, $3 /
$4
DECK
}

run() { # run NAME on|off VALUE
    "$build/selas" -q "$out/$1.nml" method%symmetry="$3" output%plots=F output%directory="$out/$1-$2" \
        >"$out/$1-$2.log" 2>&1 || cat "$out/$1-$2.log"
}

value() { # value NAME KEY: of report.txt
    sed -n "s/^$2: \([^ ]*\).*/\1/p" "$out/$1/report.txt"
}

memory_of() { # memory_of NAME: planned, without the histories, which are as long in part of a body
    awk -F ': ' '{ of[$1] = $2 + 0 } END { print of["planned memory bytes"] - 72 * of["receivers"] * (of["steps"] + of["steps beyond end_time"] + 2) }' \
        "$out/$1/report.txt"
}

# judge TITLE NAME PART: histories agree to 1e-12, unknowns (and so the work of an evaluation) and memory of the
# model's state are the part's (a few per cent more, for the ends)
judge() {
    run "$2" on T
    run "$2" off F
    cat "$out/$2-on/"r?.dat | grep -v '^#' >"$out/$2.on"
    cat "$out/$2-off/"r?.dat | grep -v '^#' >"$out/$2.off"
    difference=$(paste "$out/$2.on" "$out/$2.off" | awk '{
        for (i = 2; i <= 7; i++) {
            d = $i - $(i + 7); if (d < 0) d = -d; if (d > worst) worst = d
            a = $i < 0 ? -$i : $i; if (a > largest) largest = a
        } } END { if (largest > 0 && $1 == $8 && NR > 60) printf "%.2e", worst / largest }')
    if awk -v d="$difference" 'BEGIN { exit !(d != "" && d + 0 <= 1e-12) }'; then
        echo "ok - $1: largest difference $difference"
    else
        echo "not ok - $1: largest difference '$difference' (at most 1e-12)"
    fi
    part=$(awk -v a="$(value "$2-on" unknowns)" -v b="$(value "$2-off" unknowns)" 'BEGIN { printf "%.3f", a / b }')
    calls=$(awk -v a="$(value "$2-on" 'operator calls')" -v b="$(value "$2-off" 'operator calls')" 'BEGIN { print a - b }')
    memory=$(awk -v a="$(memory_of "$2-on")" -v b="$(memory_of "$2-off")" 'BEGIN { printf "%.3f", a / b }')
    if awk -v p="$memory" -v w="$3" 'BEGIN { exit !(p > 0 && p <= 1.3 * w + .01) }'; then
        echo "ok - $1: $memory of the memory"
    else
        echo "not ok - $1: $memory of the memory (expected $3)"
    fi
    if awk -v p="$part" -v w="$3" -v c="$calls" 'BEGIN { exit !(p >= w && p <= 1.3 * w && (w == 1 || c == 0)) }'; then
        echo "ok - $1: $part of the unknowns at the same number of operator calls"
    else
        echo "not ok - $1: $part of the unknowns (expected $3), $calls more operator calls"
    fi
}

receivers="&receiver name = 'r1', position = 2.0, 2.0, 0.0 / &receiver name = 'r2', position = 3.1, 1.3, 0.4 /
&receiver name = 'r3', position = 0.6, 3.7, 1.9 /"
square="shape = 'square', size = 1.0, 1.0, history = 'triangle', duration = 1.0"
box="low = 0.0, 0.0, 0.0, high = 4.0, 4.5, 3.0"

deck one 3 "$box" "&load face = 'z-', centre = 2.0, 2.25, 0.0, direction = 0.0, 0.0, 1.0, $square / $receivers"
judge "one load" one .25
deck several 3 "$box" "&load face = 'z-', centre = 1.0, 2.25, 0.0, direction = 1.0, 0.0, 1.0, $square /
&load face = 'z-', centre = 3.0, 2.25, 0.0, direction = -1.0, 0.0, 1.0, $square /
&load kind = 'body-force', shape = 'point', centre = 2.0, 2.25, 1.1, direction = 0.0, 0.0, 2.0, history = 'ricker',
  frequency = 1.0, delay = 1.0 /
&boundary face = 'x-', 'x+', 'z+', kind = 'transmitting', layer = 'lysmer' / $receivers"
judge "several loads, dampers" several .25
deck pairs 3 "$box" "&load kind = 'body-force', shape = 'point', centre = 0.8, 2.25, 1.1, direction = 0.5, 0.0, 2.0, history = 'ricker',
  frequency = 1.0, delay = 1.0 /
&load kind = 'body-force', shape = 'point', centre = 3.2, 2.25, 1.1, direction = -0.5, 0.0, 2.0, history = 'ricker',
  frequency = 1.0, delay = 1.0 /
&load face = 'z-', shape = 'point', centre = 2.0, 1.1, 0.0, direction = 0.0, 0.0, 1.0, history = 'triangle', duration = 1.0 /
&load face = 'z-', shape = 'point', centre = 2.0, 3.4, 0.0, direction = 0.0, 0.0, 1.0, history = 'triangle', duration = 1.0 /
&load kind = 'moment-tensor', centre = 1.7, 2.25, 1.4, moment = 1.0, 2.0, 3.0, 0.0, 0.0, 0.5, history = 'triangle', duration = 1.0 /
&load kind = 'moment-tensor', centre = 2.3, 2.25, 1.4, moment = 1.0, 2.0, 3.0, 0.0, 0.0, -0.5, history = 'triangle', duration = 1.0 /
$receivers"
judge "pairs of point sources" pairs .25
deck half 3 "$box" "&load face = 'z-', centre = 1.0, 2.25, 0.0, direction = 1.0, 0.0, 1.0, $square /
&load face = 'z-', centre = 3.0, 2.25, 0.0, direction = 1.0, 0.0, 1.0, $square / $receivers"
judge "two loads that push the same way: half" half .5
deck none 3 "$box" "&load face = 'z-', centre = 1.0, 2.0, 0.0, direction = 1.0, 1.0, 1.0, $square / $receivers"
judge "no mirror plane" none 1
deck turned 3 "$box, rotation = 20.0, -30.0, 40.0" "&load kind = 'body-force', shape = 'point',
  centre = 2.0, 2.25, 1.5, direction = 0.0, 0.0, 1.0, history = 'triangle', duration = 1.0 /
&receiver name = 'r1', position = 2.0, 2.0, 1.0 / &receiver name = 'r2', position = 2.6, 1.8, 1.4 /"
judge "turned body, skew force: nothing to find" turned 1
# the body's z axis in the deck's coordinates: third column of Rz Ry Rx for 0, 30, 0 degrees
deck tilted 3 "$box, rotation = 0.0, 30.0, 0.0" "&load kind = 'body-force', shape = 'point',
  centre = 2.0, 2.25, 1.5, direction = 0.5, 0.0, 0.86602540378443865, history = 'triangle', duration = 1.0 /
&receiver name = 'r1', position = 2.0, 2.0, 1.0 / &receiver name = 'r2', position = 2.6, 2.8, 1.4 /"
judge "turned body, force along its axis" tilted .25
deck tensor 3 "$box, rotation = 0.0, 0.0, 30.0" "&load kind = 'moment-tensor',
  centre = 2.0, 2.25, 1.1, moment = 1.0, 2.0, 3.0, 0.0, 0.0, 0.0, history = 'triangle', duration = 1.0 /
&receiver name = 'r1', position = 2.0, 2.0, 1.0 / &receiver name = 'r2', position = 2.6, 2.8, 1.4 /"
judge "turned body, moment tensor of the deck's axes: nothing to find" tensor 1
deck plane 2 "low = 0.0, 0.0, high = 6.0, 4.5" "&load face = 'y-', centre = 3.0, 0.0, direction = 0.0, 1.0,
  shape = 'square', size = 1.0, history = 'triangle', duration = 1.0 /
&receiver name = 'r1', position = 3.0, 0.0 / &receiver name = 'r2', position = 4.7, 1.3 /"
judge "two dimensions" plane .5
deck thin 3 "low = 0.0, 0.0, 0.0, high = 4.0, 1.0, 2.0" "&load face = 'z-', centre = 2.0, 0.5, 0.0,
  direction = 0.0, 0.0, 1.0, $square / &receiver name = 'r1', position = 2.0, 0.5, 0.0 /
&receiver name = 'r2', position = 3.1, 0.2, 0.4 /"
judge "thin body: half, not quarter" thin .5
for mass in exact vc2; do
    deck "$mass" 3 "$box" "&load face = 'z-', centre = 2.0, 2.25, 0.0, direction = 0.0, 0.0, 1.0, $square /
&method degree = 3, mass = '$mass' / &stepping / $receivers"
    sed -i 's/^&stepping time_step.*$//; s/&stepping \//\&stepping time_step = 0.02 \//' "$out/$mass.nml"
    judge "degree 3, mass $mass" "$mass" .25
done
deck damped 3 "$box" "&load face = 'z-', centre = 2.0, 2.25, 0.0, direction = 0.0, 0.0, 1.0, $square /
&method dissipation = 0.3 / $receivers"
judge "with dissipation" damped .25
