#!/bin/sh
# Runs input/plane-wave.nml in its variants against d'Alembert: P in a bar and a box, S in a rectangle, askew in
# a box; held, free and absorbing ends; the observed order of the whole chain (start, operator, step, recording).
build=${1:-build}
work=$(mktemp -d) || exit 1
trap 'rm -rf "$work"' EXIT
out=$work/run
OMP_NUM_THREADS=1
export OMP_NUM_THREADS

# Runs the deck with overrides; prints the error of the worst receiver.
largest() {
    "$build/selas" -q input/plane-wave.nml output%plots=F output%directory="$out" "$@" >"$out.log" 2>&1 || cat "$out.log" >&2
    sed -n 's/^error largest: \([^ ]*\).*/\1/p' "$out/report.txt"
    rm -rf "$out"
}
# below TITLE ERROR LIMIT
below() {
    if awk -v e="$2" -v l="$3" 'BEGIN { exit !(e != "" && e + 0 <= l + 0 && e + 0 > 0) }'; then
        echo "ok - $1: $2 (at most $3)"
    else
        echo "not ok - $1: '$2' (at most $3)"
    fi
}
rollers="boundary%face='y-','y+','z-','z+'"
coarse=$(largest)
fine=$(largest body%spacing=0.01)
below "P pulse in a bar, free ends" "$coarse" 1.2e-4
below "order at least 3.7 between spacings .02 and .01: error ratio times 13" \
    "$(awk -v c="$coarse" -v f="$fine" 'BEGIN { print f / c * 13 }')" 1
below "held end" "$(largest boundary%kind=fixed)" 1.2e-4
below "thin bar" "$(largest scene%plane=stress)" 1.2e-4
below "absorbing end, leapfrog" "$(largest boundary%kind=transmitting stepping%scheme=leapfrog)" 1.5e-2
below "absorbing end, modified equation" "$(largest boundary%kind=transmitting)" 1e-3
below "P pulse in a box with rollers" "$(largest scene%dimension=3 body%low=0,0,0 body%high=4,0.4,0.4 \
    body%spacing=0.05 initial%direction=1,0,0 initial%centre=1,0,0 initial%width=0.2 "$rollers" \
    boundary%kind=roller 'receiver(1)%position=2,0.2,0.2' 'receiver(2)%position=3.5,0.4,0.2')" 5e-5
below "S pulse in a rectangle" "$(largest scene%dimension=2 body%low=0,0 body%high=4,0.4 body%spacing=0.04 \
    initial%wave=s initial%direction=1,0 initial%centre=1,0 initial%width=0.2 "boundary%face='y-','y+'" \
    boundary%kind=displacement boundary%direction=1,0 boundary%slip=T boundary%amplitude=0 \
    boundary%history=step 'receiver(1)%position=2,0.2' 'receiver(2)%position=3.5,0.4')" 5e-5
general="method%operator=general method%degree= method%mass="
# shellcheck disable=SC2086
below "S pulse in a rectangle, general operator" "$(largest $general scene%dimension=2 body%low=0,0 body%high=4,0.4 body%spacing=0.04 \
    initial%wave=s initial%direction=1,0 initial%centre=1,0 initial%width=0.2 "boundary%face='y-','y+'" \
    boundary%kind=displacement boundary%direction=1,0 boundary%slip=T boundary%amplitude=0 \
    boundary%history=step 'receiver(1)%position=2,0.2' 'receiver(2)%position=3.5,0.4')" 1e-3
# shellcheck disable=SC2086
below "S pulse in a box, general operator" "$(largest $general scene%dimension=3 body%low=0,0,0 body%high=4,0.4,0.4 body%spacing=0.04 \
    initial%wave=s initial%direction=1,0,0 initial%centre=1,0,0 initial%polarisation=0,1,0 initial%width=0.2 "boundary%face='y-','y+'" \
    boundary%kind=displacement boundary%direction=1,0,0 boundary%slip=T boundary%amplitude=0 \
    boundary%history=step 'receiver(1)%position=2,0.2,0.2' 'receiver(2)%position=3.5,0.2,0.4')" 1e-3
below "S pulse askew in a box" "$(largest scene%dimension=3 scene%end_time=0.5 body%low=0,0,0 body%high=4,4,4 \
    body%spacing=0.1 initial%wave=s initial%direction=2,3,6 initial%polarisation=3,-2,0 \
    initial%centre=1.86,1.79,1.57 initial%width=0.5 'receiver(1)%position=2,2,2' \
    'receiver(2)%position=2.1,1.9,2')" 4e-4

# A pulse goes on in the rock that it begins in, be that a block's: none of it goes back.
cat >"$work/block.nml" <<'D'
&scene dimension = 2, end_time = 2 /
&material name = 'soil', density = 1, s_speed = 0.5, p_speed = 1 /
&material name = 'rock', density = 1.2, s_speed = 1, p_speed = 1.8 /
&body material = 'soil', low = 0, 0, high = 1, 10, spacing = 0.1 /
&block material = 'rock', centre = 0.5, 5.5, size = 3, 9 /
&boundary face = 'y+', kind = 'transmitting', layer = 'lysmer' /
&boundary face = 'x-', 'x+', kind = 'displacement', direction = 0, 1, slip = .true., amplitude = 0, history = 'step' /
&initial kind = 'plane-wave', wave = 's', direction = 0, -1, polarisation = 1, 0, centre = 0, 6, width = 0.5, amplitude = 1 /
&receiver name = 'behind', position = 0.5, 8.5 /
&output plots = F /
D
"$build/selas" -q "$work/block.nml" output%directory="$out" >"$out.log" 2>&1 || cat "$out.log" >&2
below "an S pulse in a block sends nothing back" "$(awk '!/^#/ { if ($2^2 > most) most = $2^2 } END { print sqrt(most) }' "$out/behind.dat")" 1e-3

# In layers a pulse goes on in the rock that it begins in, too. Once in the layer above it goes to and fro (impedances Z
# there, Z' below): u = 2 t (f(c' (t - t0)) + r f(c' (t - t0 - 2 d / c)) + ...) at the surface, t = 2 Z' / (Z + Z'),
# r = (Z - Z') / (Z + Z'), d the layer's thickness, t0 the time to the surface.
cat >"$work/layers.nml" <<'D'
&scene dimension = 2, end_time = 14 /
&material name = 'soil', density = 1, s_speed = 0.5, p_speed = 1 /
&material name = 'rock', density = 1.2, s_speed = 1.2, p_speed = 2.1 /
&body material = 'rock', low = 0, 0, high = 0.4, 8.2, spacing = 0.1 /
&layer material = 'soil', top = 0 /
&layer material = 'rock', top = 1 /
&boundary face = 'y+', kind = 'transmitting', layer = 'lysmer' /
&boundary face = 'x-', 'x+', kind = 'displacement', direction = 0, 1, slip = .true., amplitude = 0, history = 'step' /
&initial kind = 'plane-wave', wave = 's', direction = 0, -1, polarisation = 1, 0, centre = 0, 4.6, width = 1, amplitude = 1 /
&receiver name = 'top', position = 0.2, 0 /
&output plots = F /
D
to_and_fro() { # to_and_fro C C' Z Z' D T0 COLUMN: relative L2 of the displacement at the surface
    awk -v c="$1" -v below="$2" -v soft="$3" -v hard="$4" -v d="$5" -v first="$6" -v column="$7" '!/^#/ {
        t = 2 * hard / (soft + hard); r = (soft - hard) / (soft + hard); u = 0
        for (n = 0; n < 9; n++) u += 2 * t * r ^ n * exp(-(below * ($1 - first - 2 * n * d / c)) ^ 2 / 2)
        wrong += ($column - u) ^ 2; all += u * u } END { print sqrt(wrong / all) }' "$out/top.dat"
}
for operator in layered general; do
    "$build/selas" -q "$work/layers.nml" output%directory="$out" method%operator=$operator >"$out.log" 2>&1 || cat "$out.log" >&2
    below "an S pulse from the rock into a layer, operator $operator" "$(to_and_fro .5 1.2 .5 1.44 1 5 2)" 4e-3
done
sed -e 's/dimension = 2, end_time = 14/dimension = 3, end_time = 8/' -e 's/low = 0, 0, high = 0.4, 8.2/low = 3*0, high = 0.3, 0.3, 8.2/' \
    -e "s/'y+'/'z+'/" -e "s/&boundary face = 'x-.*/\&boundary face = 'x-', 'x+', 'y-', 'y+', kind = 'roller' \//" \
    -e "s/wave = 's', direction = 0, -1, polarisation = 1, 0, centre = 0, 4.6/direction = 0, 0, -1, centre = 0, 0, 4.6/; s/amplitude = 1 /amplitude = -1 /" \
    -e 's/position = 0.2, 0/position = 0.1, 0.1, 0/' "$work/layers.nml" >"$work/space.nml"
"$build/selas" -q "$work/space.nml" output%directory="$out" >"$out.log" 2>&1 || cat "$out.log" >&2
below "a P pulse in space" "$(to_and_fro 1 2.1 1 2.52 1 2.7142857 4)" 4e-3
