#!/bin/sh
# Absorbing layers around a quarter of a half-space in three dimensions, free surface running into them: quiet long after the waves
# have left. (With memory terms that did not know the exact mass over depth it grew from t = 9 on.)
build=${1:-build}
out=$(mktemp -d) || exit 1
trap 'rm -rf "$out"' EXIT
cat >"$out/quarter.nml" <<'D'
&scene dimension = 3, end_time = 40 /
&material name = 'rock', density = 1, lambda = 1, mu = 1 /
&body material = 'rock', low = 0, 0, 0, high = 3, 3, 2, spacing = 0.25 /
&boundary face = 'x-', 'y-', kind = 'symmetry' /
&boundary face = 'x+', 'y+', 'z+', kind = 'transmitting', layer = 'pml', layer_points = 8, always = .true. /
&load face = 'z-', shape = 'square', centre = 0, 0, 0, size = 1, 1, direction = 0, 0, 1
  history = 'gaussian', width = 0.3, delay = 2 /
&receiver name = 'r2', position = 2, 0, 0 /
D
run() { OMP_NUM_THREADS=1 "$build/selas" -q "$out/quarter.nml" output%plots=F output%directory="$out/run" "$@" >"$out/log" 2>&1; }
for words in material%lambda=1 material%lambda=9 method%depth_mass=same; do
    if run $words; then
        tail=$(awk '!/^#/ && $1 > 35 { v = $7 < 0 ? -$7 : $7; if (v > w) w = v } END { print w + 0 }' "$out/run/r2.dat")
        peak=$(awk '!/^#/ { v = $7 < 0 ? -$7 : $7; if (v > w) w = v } END { print w + 0 }' "$out/run/r2.dat")
        if awk -v t="$tail" -v p="$peak" 'BEGIN { exit !(p > 0 && t < 1e-3 * p) }'; then
            echo "ok - quiet after t = 35, $words: $tail of $peak"
        else
            echo "not ok - quiet after t = 35, $words: $tail of $peak"
        fi
    else
        echo "not ok - runs to the end, $words: $(head -c 300 "$out/log")"
    fi
done
# Beside layered ground the layers stand too (with sweeps, their only mass), and degree 4 of layered ground gives way.
sed 's/^&body.*/\&material name = "soil", density = 1, lambda = 0.25, mu = 0.25 \/\n\&layer material = "soil", top = 0 \/\n\&layer material = "rock", top = 1 \/\n&/' \
    "$out/quarter.nml" >"$out/layered.nml"
if "$build/selas" check "$out/layered.nml" >"$out/log" 2>&1; then
    echo "ok - layered ground may have absorbing layers"
else
    echo "not ok - layered ground may have absorbing layers: $(head -c 300 "$out/log")"
fi
# The layers turn with the body: the same scene turned by 30 degrees about z has the same vertical motion.
run scene%end_time=5 && cp "$out/run/r2.dat" "$out/straight.dat" &&
    run scene%end_time=5 body%rotation=0,0,30 receiver%position=2.6830127018922196,0.4509618943233421,0 \
        load%centre=0.9509618943233423,-0.549038105676658,0
grep -v '^#' "$out/straight.dat" >"$out/a"
grep -v '^#' "$out/run/r2.dat" | paste -d ' ' "$out/a" - | awk '
    { d = $7 - $14; if (d < 0) d = -d; if (d > far) far = d; v = $7 < 0 ? -$7 : $7; if (v > peak) peak = v }
    END { print (NR > 50 && peak > 1e-3 && far < 1e-11 * peak ? "ok" : "not ok") " - layers of a body turned by 30 degrees: " far " of " peak }'
# A plate in space, layers on four sides: what damps velocities there (Eq 11) leaves the limit of the time step as it is, in each
# way that a step is made. (Damped after displacements had gone on by them it was unstable at t = 5 to 20.)
cat >"$out/plate.nml" <<'END'
&scene dimension = 3, end_time = 16 /
&material name = 'rock', density = 1, lambda = 1, mu = 1 /
&body material = 'rock', low = -0.4, -0.4, 0, high = 0.4, 0.4, 1.2, spacing = 0.1 /
&boundary face = 'x-', 'x+', 'y-', 'y+', kind = 'transmitting', layer = 'pml', layer_points = 8 /
&load face = 'z-', shape = 'square', centre = 0, 0, 0, size = 0.4, 0.4, direction = 0.1, 0.2, 1
  history = 'gaussian', width = 0.4, delay = 2 /
&receiver name = 'r', position = 0.3, 0.2, 0 /
&output plots = .false. /
END
for words in method%precision=double method%precision=single method%fused=F stepping%scheme=modified-equation method%operator=general; do
    if OMP_NUM_THREADS=1 "$build/selas" -q "$out/plate.nml" output%directory="$out/run" "$words" >"$out/log" 2>&1 &&
        awk '!/^#/ { v = $7 * $7; if (v > peak) peak = v; if ($1 > 15 && v > late) late = v } END { exit !(peak > 0 && late < 0.01 * peak) }' "$out/run/r.dat"; then
        echo "ok - a plate between layers, $words"
    else
        echo "not ok - a plate between layers, $words: $(head -c 200 "$out/log")"
    fi
done
# Soft ground on rock six times as fast: waves that it guides do not grow in layers. (At s = .3 in Eq 11: unstable at t = 112.)
set -- $(sh "$(dirname "$0")/../studies/soft-on-rock" "$build" 6 1.6 16)
if awk -v first="${4:-0}" -v late="${9:-1}" 'BEGIN { exit !(first > 0.1 && late + 0 < 1e-4) }'; then
    echo "ok - soft ground on rock between layers, to t = 400"
else
    echo "not ok - soft ground on rock between layers, to t = 400: $*"
fi
# A load that stays: the static field's strain energy in the layers is no growth, and what grows there is found.
cat >"$out/step.nml" <<'END'
&scene dimension = 2, end_time = 10 /
&material name = 'rock', density = 1, lambda = 1, mu = 1 /
&body material = 'rock', shape = 'box', low = -1, 0, high = 1, 1, spacing = 0.125 /
&boundary face = 'x-', 'x+', 'y+', kind = 'transmitting', layer = 'pml' /
&load face = 'y-', shape = 'square', centre = 0, 0, size = 1, direction = 0, 1, history = 'step' /
&receiver name = 'a', position = 0, 0 /
&output plots = .false. /
END
for end in 10 40; do
    if "$build/selas" -q "$out/step.nml" output%directory="$out/run" scene%end_time=$end >"$out/log" 2>&1 && ! [ -s "$out/log" ]; then
        echo "ok - a step beside layers until t = $end: no warning"
    else
        echo "not ok - a step beside layers until t = $end: no warning"
        sed 's/^/# /' "$out/log"
    fi
done
limit=$("$build/selas" check "$out/step.nml" | sed -n 's/^time step limit: //p')
for beyond in 1.001 1.01; do
    "$build/selas" -q "$out/step.nml" output%directory="$out/run" scene%end_time=20 stepping%force=T "stepping%time_step=$(echo "$limit $beyond" | awk '{ print $1 * $2 }')" >"$out/log" 2>&1
    if [ $? -eq 1 ] && grep -q "went unstable" "$out/log"; then
        echo "ok - growth beside layers at $beyond of the limit is found"
    else
        echo "not ok - growth beside layers at $beyond of the limit is found"
    fi
done
