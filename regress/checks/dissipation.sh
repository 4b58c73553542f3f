#!/bin/sh
# method%dissipation: the load centre is at rest once the exact signal has ended (t > 2.8, kinked pulse), which the
# lattice's own undamped waves disturb; the error of a smooth pulse stays what it was.
build=${1:-build}
out=$(mktemp -d) || exit 1
trap 'rm -rf "$out"' EXIT
OMP_NUM_THREADS=1
export OMP_NUM_THREADS
cat >"$out/deck.nml" <<'DECK'
&scene dimension = 3, end_time = 6.0 /
&material name = 'rock', density = 1.0, lambda = 1.0, mu = 1.0 /
&body name = 'ground', material = 'rock', shape = 'box'
  low = 0.0, 0.0, 0.0, high = 6.5, 5.5, 5.25, spacing = 0.25 /
&boundary face = 'x-', 'y-', kind = 'symmetry' /
&load face = 'z-', shape = 'square', centre = 0.0, 0.0, 0.0, size = 1.0, 1.0
  direction = 0.0, 0.0, 1.0, amplitude = 1.0, history = 'triangle', duration = 2.0 /
&receiver name = 'r0', position = 0.0, 0.0, 0.0 /
&receiver name = 'r2', position = 2.0, 0.0, 0.0 /
&reference kind = 'lamb' /
DECK

run() { # run NAME OVERRIDE...
    name=$1
    shift
    "$build/selas" -q "$out/deck.nml" output%plots=F output%directory="$out/$name" "$@" >"$out/$name.log" 2>&1 ||
        cat "$out/$name.log"
}
ringing() { # rms of v_z at the centre, 3.5 < t < 6
    awk '!/^#/ && $1 > 3.5 { s += $7 * $7; n++ } END { printf "%.2e", sqrt(s / n) }' "$out/$1/r0.dat"
}
error() { # error NAME RECEIVER
    sed -n "s/^error $2 vz: L2 \([^ ]*\).*/\1/p" "$out/$1/report.txt"
}
say() { # say TITLE CONDITION-OF-awk VALUES...
    title=$1
    condition=$2
    shift 2
    if echo "$@" | awk "NF == 2 && $condition { good = 1 } END { exit !good }"; then
        echo "ok - $title: $*"
    else
        echo "not ok - $title: $*"
    fi
}
run raw
run damped method%dissipation=1
run smooth load%smoothing=1
run smooth-damped load%smoothing=1 method%dissipation=1
say "ringing at the load centre falls to less than .4 of what it was" '$2 > 0 && $2 < .4 * $1' "$(ringing raw)" \
    "$(ringing damped)"
say "the smooth pulse's error at (2,0) changes by less than 5 %" '$2 > 0 && $2 < 1.05 * $1' \
    "$(error smooth r2)" "$(error smooth-damped r2)"
