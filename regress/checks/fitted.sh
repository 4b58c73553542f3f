#!/bin/sh
# The box that the program fits around a half-space knows everything that acts and everything that is looked at, and says or
# refuses what it cannot hold (doc/reference/scene.md, section 7). With `night` as the second word the costly ones too.
build=${1:-build}
out=$(mktemp -d) || exit 1
trap 'rm -rf "$out"' EXIT
rock="&material name = 'rock', density = 1, lambda = 1, mu = 1 /"
pulse="direction = 0, 0, 1, history = 'gaussian', width = 0.3, delay = 2"
receivers="&receiver name = 'r0', position = 0, 0, 0 /
&receiver name = 'r1', position = 1, 0, 0 /
&receiver name = 'r2', position = 2, 0, 0 /"
cat >"$out/f.nml" <<D
&scene dimension = 3, end_time = 6 /
$rock
&body material = 'rock', shape = 'half-space', spacing = 0.25 /
&load face = 'z-', shape = 'square', centre = 0, 0, 0, size = 1, 1, $pulse /
$receivers
&reference kind = 'lamb' /
&output plots = F /
D
ok() { # ok TITLE CONDITION...
    title=$1
    shift
    if "$@"; then echo "ok - $title"; else echo "not ok - $title"; fi
}
below() { awk -v a="$1" -v b="$2" 'BEGIN { exit !(a != "" && a + 0 > 0 && a + 0 < b + 0) }'; }
run() { # run NAME DECK WORDS...: to $out/NAME
    name=$1 deck=$2
    shift 2
    OMP_NUM_THREADS=1 "$build/selas" -q "$out/$deck.nml" output%directory="$out/$name" "$@" >"$out/$name.log" 2>&1
}
largest() { sed -n 's/^error largest: \([^ ]*\).*/\1/p' "$out/$1/report.txt" 2>/dev/null; }
plan() { # plan NAME DECK WORDS...: to $out/NAME.plan, errors too
    name=$1 deck=$2
    shift 2
    "$build/selas" check "$out/$deck.nml" "$@" >"$out/$name.plan" 2>&1
}
echoes() { # echoes DECK WORDS...: the largest echo in $echo, the plan in $out/echo.plan
    deck=$1
    shift
    OMP_NUM_THREADS=1 "$build/selas" check --echo "$out/$deck.nml" "$@" >"$out/echo.plan" 2>&1
    echo=$(sed -n 's/^echo [^e][^:]*: \([^ ]*\).*/\1/p' "$out/echo.plan" | sort -g | tail -1)
}
refused() { # refused TITLE PATTERN DECK WORDS...
    title=$1 pattern=$2
    shift 2
    plan refused "$@"
    status=$?
    ok "$title" test "$status$(grep -c "error: .*$pattern" "$out/refused.plan")" = 21
}
difference() { # relative L2 of the velocity of a receiver between two runs of the same rows
    grep -v '^#' "$out/$2/$3.dat" >"$out/b"
    grep -v '^#' "$out/$1/$3.dat" | paste -d ' ' - "$out/b" | awk '
        { for (i = 5; i <= 7; i++) { d += ($i - $(i + 7)) ^ 2; s += $(i + 7) ^ 2 } }
        END { if (s > 0 && NR > 50) print sqrt(d / s) }'
}

# Transmitting is the best that the method has: absorbing layers.
open="boundary%face=x-,x+,y-,y+,z+ boundary%kind=transmitting"
run open f $open scene%end_time=9 body%spacing=0.2
ok "faces that transmit and say no more: error $(largest open)" below "$(largest open)" 0.04
ok "the plan says that they have layers" grep -q '^face x+: transmitting, absorbing layer' "$out/open/report.txt"
plan lysmer f $open boundary%layer=lysmer scene%end_time=9
ok "dampers that are asked for stand where nothing comes back" \
    grep -q '^box chosen: so large .*the deck asks for dampers' "$out/lysmer.plan"

# Loads all over the surface: rollers at the sides, or no box.
sed "s/shape = 'square', centre = 0, 0, 0, size = 1, 1/shape = 'face'/; s/'lamb'/'plane-wave'/" "$out/f.nml" >"$out/face.nml"
run face face
ok "a pressure all over the surface: error $(largest face)" below "$(largest face)" 0.02
grep -q '^face z+: transmitting, dampers' "$out/face/report.txt"
ok "below it dampers" test $? -eq 0
echo "&boundary face = 'z+', kind = 'transmitting', layer = 'pml', layer_points = 8 /" | cat "$out/face.nml" - >"$out/sunk.nml"
echoes sunk scene%end_time=30
ok "layers there send slow waves back, echo $echo, and the plan says so" \
    awk -v e="$echo" -v said="$(grep -c 'warning: all moves at right angles' "$out/echo.plan")" 'BEGIN { exit !(e > .01 && said == 1) }'
echoes face scene%end_time=30
ok "dampers hardly: echo $echo" below "$echo" 7e-3
refused "layers beside a pressure all over the surface" 'only a roller' face boundary%face=x- boundary%kind=transmitting
refused "a shear all over the surface has no box" 'has no end' face load%direction=1,0,0 reference%kind=file
sed "/^&reference/d; s/^&load.*/\&load kind = 'body-force', $pulse \//" "$out/f.nml" >"$out/body.nml"
refused "a force all over the body has no box" 'has no end' body

# What moves at first, below all else: against a quarter so large that nothing comes back.
sed "/^&reference/d; /^&load/d" "$out/f.nml" >"$out/deep.nml"
echo "&initial kind = 'gaussian', amplitude = 1, width = 0.5, centre = 0, 0, 3, direction = 0, 0, 1 /" >>"$out/deep.nml"
sed "s/shape = 'half-space'/low = 0, 0, 0, high = 7, 7, 10/" "$out/deep.nml" >"$out/quarter.nml"
echo "&boundary face = 'x-', 'y-', kind = 'symmetry' /" >>"$out/quarter.nml"
for name in deep quarter; do run $name $name scene%end_time=5 stepping%time_step=0.05; done
far=$(difference deep quarter r2)
ok "an initial state below the receivers: $far of what a large box shows" below "$far" 0.005
refused "an initial state without end has no box" 'has no end' deep initial%kind=uniform-velocity initial%velocity=1,0,0 \
    initial%amplitude= initial%width= initial%centre= initial%direction=

# Snapshots look at the whole body, or at their region, as long as they look.
echo "&snapshot times = 6 /" | cat "$out/f.nml" - >"$out/shown.nml"
plan whole shown
ok "a snapshot of the whole body asks for layers" grep -q '^box chosen: absorbing layers' "$out/whole.plan"
plan region shown snapshot%region=-1,-1,0,1,1,9
depth=$(sed -n 's/^lattice: .* x //p' "$out/region.plan")
ok "a snapshot's region lies in the box: $depth points over a depth of 9" test "$depth" -ge 37
refused "a snapshot of the whole body where there are no layers" 'give &snapshot a region' shown stepping%scheme=rk4

# Receivers far away along the layers; refining helps.
sed "s/width = 0.3, delay = 2/width = 0.6, delay = 3/; s/position = 1,/position = 5,/; s/position = 2,/position = 10,/" \
    "$out/f.nml" >"$out/line.nml"
run coarse line scene%end_time=14 body%spacing=0.2
ok "a line of receivers of length 10: error $(largest coarse)" below "$(largest coarse)" 0.004
if [ "$2" = night ]; then
    run fine line scene%end_time=14 body%spacing=0.1
    ok "the same at half the spacing: error $(largest fine)" below "$(largest fine)" "$(largest coarse)"
fi

# What the ground is like beyond the box: hills of a file are held, or the box is so large that they may go on; tilted layers.
cat >"$out/hills.nml" <<D
&scene dimension = 2, end_time = 14 /
&material name = 'rock', density = 1, p_speed = 1.8, s_speed = 1 /
&body material = 'rock', shape = 'half-space', spacing = 0.1 /
&topography file = 'hills.txt' /
&load kind = 'body-force', shape = 'point', centre = 0, depth = 0.8, direction = .3, 1, history = 'gaussian', width = 0.4, delay = 2 /
&receiver name = 'a', position = -1, depth = 0 /
&receiver name = 'b', position = 0.8, depth = 0 /
D
heights() { awk "BEGIN { for (i = -400; i <= 400; i++) { x = i * .05; print x, $1 } }" >"$out/hills.txt"; }
heights '.35 * exp(-((x - 2.2) / .4) ^ 2 / 2) + .2 * exp(-((x + 2) / .3) ^ 2 / 2)'
echoes hills
ok "hills of a file beyond the receivers are in the box: echo $echo" below "$echo" 2e-3
heights '.3 * exp(-((x - 5) / .4) ^ 2 / 2)'
plan beyond hills
ok "one farther away too: $(sed -n 's/^lattice points: //p' "$out/beyond.plan")" \
    awk -v p="$(sed -n 's/^lattice points: \([0-9]*\).*/\1/p' "$out/beyond.plan")" 'BEGIN { exit !(p > 100) }'
heights '.15 * sin(2 * x) + .1 * sin(3.3 * x + 1)'
plan rough hills
ok "ground that is nowhere level: the larger box" grep -q '^box chosen: so large .*surface level that is not' "$out/rough.plan"
plan cut hills scene%end_time=60
ok "where that costs too much: told" grep -q 'warning: before the absorbing layers the surface is made level' "$out/cut.plan"
cat >"$out/dip.nml" <<D
&scene dimension = 3, end_time = 10 /
&material name = 'rock', density = 1.3, p_speed = 3, s_speed = 1.8 /
&material name = 'soil', density = 1, p_speed = 1.8, s_speed = 1 /
&layer material = 'soil', top = 0 /
&layer material = 'rock', top = 1.5, dip = 20 /
&body material = 'rock', shape = 'half-space', spacing = 0.2 /
&load kind = 'body-force', shape = 'point', centre = 0, 0, depth = 0.8, direction = .3, 0, 1, history = 'gaussian', width = 0.5, delay = 2.5 /
&receiver name = 'a', position = -1, 0, depth = 0 /
D
plan dip dip
ok "tilted layers that go on beyond the box are told of" grep -q 'warning: tilted layers send waves back' "$out/dip.plan"
plan dip dip scene%end_time=5
ok "or held" grep -q '^box chosen: so large .*tilted layers' "$out/dip.plan"
if [ "$2" = night ]; then
    echoes dip
    ok "what a dip of 20 degrees sends back from beyond the box: $echo" awk -v e="$echo" 'BEGIN { exit !(e > .01 && e < .03) }'
fi

# A layer so deep that no wave comes back from it in time, level or tilted, does not draw the box down, and changes nothing.
cat >"$out/deep.nml" <<D
&scene dimension = 2, end_time = 4 /
&material name = 'rock', density = 1, p_speed = 1.8, s_speed = 1 /
&material name = 'hard', density = 1.2, p_speed = 2.3, s_speed = 1.3 /
&body material = 'rock', shape = 'half-space', spacing = 0.1 /
&method operator = 'general' /
&layer material = 'rock', top = 0 /
&layer material = 'hard', top = 40 /
&load kind = 'body-force', shape = 'point', centre = 0, 0.8, direction = 1, 0.5, history = 'gaussian', width = 0.4, delay = 2 /
&receiver name = 'r', position = 1, 0 /
&output plots = F, history_step = 0.02 /
D
for dip in 0 20; do
    plan deep deep "layer(2)%dip=$dip"
    ok "a layer with a dip of $dip that is too deep to be seen: told, and the box is small" \
        sh -c "grep -q '^layers below the box: 1, from which no wave' '$out/deep.plan' && awk '/^points:/ { exit !(\$2 < 6000) }' '$out/deep.plan'"
done
plan seen deep 'layer(2)%top=5'
ok "one that is seen is held" sh -c "! grep -q '^layers below the box' '$out/seen.plan'"
run late deep 'layer(2)%top=5.4'
run held deep 'layer(2)%top=5.4' body%low=-7,0 body%high=7,8 "boundary%face='x-','x+','y+'" boundary%kind=transmitting boundary%layer=lysmer \
    "reference%kind='file'" "reference%file='$out/late'"
ok "its waves come too late: $(largest held)" below "$(largest held)" 1e-5

# Layers beside the exact mass and the modified equation; a scheme without layers gets the larger box.
plan exact f scene%end_time=15 method%mass=exact
ok "method%mass=exact: layers" grep -q '^box chosen: absorbing layers' "$out/exact.plan"
for words in method%degree=2 "method%degree=3 method%mass=exact body%spacing=.3" "method%operator=general body%spacing=.2"; do
    OMP_NUM_THREADS=1 "$build/selas" check --echo "$out/f.nml" scene%end_time=9 stepping%scheme=modified-equation $words >"$out/fourth.plan" 2>&1
    echo=$(sed -n 's/^echo r2: \([^ ]*\).*/\1/p' "$out/fourth.plan")
    ok "the modified equation, $words: echo $echo" below "$echo" 2e-3
done
# Its inverse carries a load's forces into layers that are near.
cat >"$out/near.nml" <<D
&scene dimension = 2, end_time = 40 /
&material name = 'rock', density = 1, p_speed = 1.54, s_speed = 1 /
&body material = 'rock', shape = 'half-space', spacing = 0.421 /
&method mass = 'exact', degree = 4 /
&load kind = 'moment-tensor', centre = 1.894, 1.253, moment = 1, .5, 0, .3, 0, 0, history = 'gaussian', width = 0.974, delay = 4.872 /
&receiver name = 'r', position = -0.456, 2.987 /
D
OMP_NUM_THREADS=1 "$build/selas" check --echo "$out/near.nml" >"$out/near.plan" 2>&1
echo=$(sed -n 's/^echo r: \([^ ]*\).*/\1/p' "$out/near.plan")
ok "a source 17 cells from layers beside the exact mass of degree 4: echo $echo" below "$echo" 2e-4
plan close near body%low=-6.736,0 body%high=3.368,8.42 boundary%face=x-,x+,y+ boundary%kind=transmitting boundary%layer_points=13
ok "one that is too near is told of" grep -q 'warning: the moment tensor of load 1 lies 3.5 cells from .* face x+, .* up to about 0.05 of' "$out/close.plan"
# Beside an interface, along its normal, and near a surface no source is filtered.
soil="material(2)%name=soil material(2)%density=.9 material(2)%p_speed=1.2 material(2)%s_speed=.7 layer(1)%material=soil layer(1)%top=0 layer(2)%material=rock layer(2)%top=2.526"
plan below near body%low=-8.42,0 body%high=8.42,5.052 boundary%face=x-,x+,y+ boundary%kind=transmitting boundary%layer_points=13 load%centre=1.894,3.5785
ok "one above a layer" grep -q 'warning: the moment tensor of load 1 lies 3.5 cells from .* face y+, .* up to about 0.05 of .*; 13 cells' "$out/below.plan"
plan beneath near body%low=-8.42,0 body%high=8.42,5.052 boundary%face=x-,x+,y+ boundary%kind=transmitting boundary%layer_points=13 load%centre=1.894,3.5785 $soil
ok "one between an interface and a layer" grep -q 'warning: the moment tensor of load 1 lies 3.5 cells from .* face y+, .* up to about 0.3 of .*; 17 cells' "$out/beneath.plan"
plan none f scene%end_time=9 stepping%scheme=rk4
ok "stepping%scheme=rk4: the larger box, and why" \
    grep -q '^box chosen: so large .*absorbing layers need' "$out/none.plan"

# A half-space whose box is given: what the deck does not name absorbs.
run given f body%low=-3,-3,0 body%high=3,3,3
ok "sides that nobody names absorb: error $(largest given)" below "$(largest given)" 0.1

refused "a pressure all over a half-space that is given" 'only rollers' face body%low=-3,-3,0 body%high=3,3,3
plan damped f body%low=-3,-3,0 body%high=3,3,3 stepping%scheme=rk4
ok "dampers that nobody asked for are told of" grep -q 'warning: .*have dampers' "$out/damped.plan"

# Faces whose place counts.
for face in "z+ fixed" "x- symmetry" "y+ roller" "x+ free"; do
    refused "a face of a box that is not known: $face" 'is not known' f "boundary%face=${face% *}" "boundary%kind=${face#* }"
done
refused "a turned body whose box is not known" 'turns about the middle' f body%rotation=0,0,30

# What comes back, measured.
"$build/selas" check --echo "$out/f.nml" scene%end_time=9 body%low=-3,-3,0 body%high=3,3,3 >"$out/echo" 2>&1
ok "check --echo: $(grep '^echo r2' "$out/echo")" \
    below "$(sed -n 's/^echo r2: \([^ ]*\).*/\1/p' "$out/echo")" "$(sed -n 's/^echo expected: \([^ ]*\).*/\1/p' "$out/echo")"
