#!/bin/sh
# &scene accuracy: scenes that no table of errors holds (regress/studies/accuracy/scenes.sh, waves.sh, solids.sh), one or more of
# each kind. The error reached against the exact solution lies between a fifth of the wanted one and the wanted one; the plan says what was chosen; the
# echoed deck chooses the same again.
build=${1:-build}
out=$(mktemp -d) || exit 1
trap 'rm -rf "$out"' EXIT
OMP_NUM_THREADS=1
export OMP_NUM_THREADS
. regress/studies/accuracy/scenes.sh
. regress/studies/accuracy/waves.sh
. regress/studies/accuracy/solids.sh
. regress/studies/accuracy/runs.sh
. regress/studies/accuracy/trials.sh
vector() { sed -n 's/^error largest: \([^ ]*\).*/\1/p' "$out/run/report.txt"; }
for pair in w2:.05 w9:.01 12:.03 9:.05 l3:.05 b1:.03 b3:.02 b4:.1 p2:.04 1:.02 5:.03; do
    number=${pair%:*}
    wanted=${pair#*:}
    deck_of "$number" >"$out/scene.nml"
    "$build/selas" -q "$out/scene.nml" "scene%accuracy=$wanted" "output%directory=$out/run" >"$out/log" 2>&1
    reached=$(error_of "$number")
    if awk -v e="$reached" -v w="$wanted" 'BEGIN { exit !(e != "" && e <= w && e >= w / 5) }'; then
        echo "ok - scene $number: error $reached where $wanted is wanted"
    else
        echo "not ok - scene $number: error $reached where $wanted is wanted"
        cat "$out/log"
    fi
done
chosen() { "$build/selas" check "$@" | sed -n 's/^accuracy: //p'; }
first=$(chosen "$out/scene.nml" scene%accuracy=.03)
again=$(chosen "$out/run/deck.nml")
if [ -n "$first" ] && [ "$first" = "$again" ]; then
    echo "ok - the echo chooses the same: $first"
else
    echo "not ok - the echo chooses '$again', not '$first'"
fi
refused() { # refused WORDS SCENE SED [ACCURACY]: the plan of a changed scene is refused with these words
    deck_of "$2" | sed "$3" >"$out/scene.nml"
    if "$build/selas" check "$out/scene.nml" "scene%accuracy=${4:-.01}" 2>&1 | grep -q "$1"; then
        echo "ok - refused: $1"
    else
        echo "not ok - not refused: $1"
    fi
}
cat >"$out/graded.nml" <<'END'
&scene dimension = 3, end_time = 10.0, accuracy = 0.05 /
&material name = 'soil', density = 1.0, p_speed = 1.0, s_speed = 0.5 /
&material name = 'rock', density = 1.3, p_speed = 2.6, s_speed = 1.5 /
&body shape = 'half-space', material = 'rock', grading = 3.0 /
&layer material = 'soil', top = 0.0 /
&layer material = 'rock', top = 1.0 /
&load face = 'z-', shape = 'square', centre = 0, 0, 0, size = 1.2, 1.2, direction = 0, 0, 1, history = 'gaussian', width = 1.1, delay = 5.5 /
&receiver name = 'r0', position = 0, 0, 0 /
&receiver name = 'r1', position = 1, 0, 0 /
&receiver name = 'below', position = 1, 0, 2.5 /
&reference kind = 'layered' /
&output plots = .false. /
END
"$build/selas" -q "$out/graded.nml" "output%directory=$out/run" >"$out/log" 2>&1
reached=$(vector)
if grep -q '^operator: general' "$out/run/report.txt" && grep -q '^spacing over depth: .* growing' "$out/run/report.txt" &&
    awk -v e="$reached" 'BEGIN { exit !(e != "" && e <= .05 && e >= .01) }'; then
    echo "ok - a graded spacing: error $reached where .05 is wanted"
else
    echo "not ok - a graded spacing: error $reached where .05 is wanted"
    cat "$out/log"
fi
if "$build/selas" check "$out/graded.nml" load%kind=moment-tensor load%face= load%shape= load%size= load%direction= load%moment=1,1,1,0,0,0 load%centre=0,0,1.2 2>&1 | grep -q "moment tensors in layered ground without"; then
    echo "ok - refused: moment tensors on a graded spacing"
else
    echo "not ok - not refused: moment tensors on a graded spacing"
fi
# general ground: trials held against finer ones; the grading is chosen with them where it saves
cat >"$out/basin.nml" <<'END'
&scene dimension = 2, end_time = 12.0, accuracy = 0.03 /
&material name = 'soil', density = 1.0, p_speed = 1.0, s_speed = 0.5 /
&material name = 'rock', density = 1.3, p_speed = 2.6, s_speed = 1.5 /
&body shape = 'half-space', material = 'rock' /
&block material = 'soil', shape = 'ellipsoid', centre = 0.0, 0.0, size = 4.0, 1.6 /
&load kind = 'body-force', shape = 'point', centre = 1.5, 3.0, direction = 0.3, 1.0, history = 'gaussian', width = 0.5, delay = 2.5 /
&receiver name = 'm', position = 0.0, 0.0 /
&receiver name = 'e', position = 1.5, 0.0 /
&receiver name = 'o', position = 3.0, 0.0 /
&output plots = .false. /
END
cp "$out/basin.nml" "$out/hill.nml"
sed -i "/soil/{/^&block/!d}; s/^&block.*/\&topography shape = 'gaussian', height = 0.5, centre = 0.0, width = 1.0 \//; s/position = \([0-9.]*\), 0.0/position = \1, depth = 0.0/" "$out/hill.nml"
sed "s/^&block.*/\&topography shape = 'gaussian', height = 0.5, centre = 0.0, width = 1.0 \//; s/position = \([0-9.]*\), 0.0/position = \1, depth = 0.0/; s/width = 0.5/width = 0.6/" "$out/basin.nml" >"$out/cover.nml"
echo "&layer material = 'soil', top = 0.0 /" >>"$out/cover.nml"
echo "&layer material = 'rock', top = 1.0 /" >>"$out/cover.nml"
for ground in basin cover hill; do
    rm -rf "$out/run" "$out/run2" "$out/fine"
    "$build/selas" -q "$out/$ground.nml" "output%directory=$out/run" >"$out/log" 2>&1
    sed "s/, accuracy = 0.03//; s/^&body /&spacing = 0.04, /" "$out/$ground.nml" >"$out/fine.nml"
    "$build/selas" -q "$out/fine.nml" "output%directory=$out/fine" >>"$out/log" 2>&1
    chosen=$(sed -n 's/^accuracy: .* spacing \([0-9.]*\),.*/\1/p' "$out/run/report.txt")
    sed "s/, accuracy = 0.03//; s/^&body /&spacing = $chosen, $(grep -q '^accuracy: .*grading 3' "$out/run/report.txt" && echo 'grading = 3.0,') /" "$out/$ground.nml" >"$out/again.nml"
    echo "&reference kind = 'file', file = '$out/fine' /" >>"$out/again.nml"
    "$build/selas" -q "$out/again.nml" "output%directory=$out/run2" >>"$out/log" 2>&1
    reached=$(sed -n 's/^error largest: \([^ ]*\).*/\1/p' "$out/run2/report.txt")
    if awk -v e="$reached" 'BEGIN { exit !(e != "" && e <= .03 && e >= .006) }'; then
        echo "ok - general ground, $ground: error $reached where .03 is wanted"
    else
        echo "not ok - general ground, $ground: error $reached where .03 is wanted"
        cat "$out/log"
    fi
done
# what the run is held against when it is over: an exact solution without being asked, or the deck's histories
missed='^warning: the error reached is .*, above scene%accuracy'
sed '/^&reference/d' "$out/graded.nml" >"$out/proved.nml"
rm -rf "$out/run"
"$build/selas" -q "$out/proved.nml" "output%directory=$out/run" >"$out/log" 2>&1
if grep -q '^reference: lamb' "$out/run/report.txt" && ! grep -q "$missed" "$out/log" &&
    awk -v e="$(vector)" 'BEGIN { exit !(e != "" && e <= .05 && e >= .01) }'; then
    echo "ok - a deck without a reference says what error it reached"
else
    echo "not ok - a deck without a reference says what error it reached"
    cat "$out/log"
fi
rm -rf "$out/run"
"$build/selas" -q regress/studies/accuracy/uneven.nml "output%directory=$out/run" >"$out/log" 2>&1
if ! grep -q "$missed" "$out/log" && awk -v e="$(vector)" 'BEGIN { exit !(e != "" && e <= .05) }'; then
    echo "ok - errors that do not fall evenly: $(vector) where .05 is wanted"
else
    echo "not ok - errors that do not fall evenly: $(vector) where .05 is wanted"
    cat "$out/log"
fi
points='^warning: .*points per wavelength'
if ! "$build/selas" check regress/studies/accuracy/uneven.nml 2>&1 | grep -q "$points" &&
    "$build/selas" check regress/studies/accuracy/uneven.nml snapshot%times=1 2>&1 | grep -q "$points"; then
    echo "ok - few points a wavelength are told of where a snapshot looks, not where the error at receivers is known"
else
    echo "not ok - few points a wavelength where the error is chosen"
fi
for other in hill basin; do # the last of $out/fine is that of the hill
    echo "&reference kind = 'file', file = '$out/fine' /" | cat "$out/$other.nml" - >"$out/held.nml"
    rm -rf "$out/run"
    "$build/selas" -q "$out/held.nml" "output%directory=$out/run" >"$out/log" 2>&1
    said=$(grep -c "$missed" "$out/log" "$out/run/report.txt" | sed 's/.*://' | tr -d '\n')
    if [ "$said" = "$([ $other = hill ] && echo 00 || echo 11)" ]; then
        echo "ok - an error above the wanted one is told: $other, reached $(vector)"
    else
        echo "not ok - an error above the wanted one is told: $other, reached $(vector)"
        cat "$out/log"
    fi
done
if said=$(regress/studies/accuracy/ground-drawn "$build" 8 8); then
    echo "ok - a hill in space, drawn: $(echo "$said" | sed -n '1s/ spacing.*//p')"
else
    echo "not ok - a hill in space, drawn: $said"
fi
sed "s/^&material.*rock.*/\&material name = 'rock', density = 1.3, p_speed = 2.6, s_speed = 1.5, q_p = 10.0, q_s = 6.0 \//; s/accuracy = 0.03/accuracy = 0.02/" "$out/hill.nml" >"$out/damped.nml"
if said=$(DAMPED=1 DECK="$out/damped.nml" regress/studies/accuracy/ground-drawn "$build") && echo "$said" | grep -q ' right .*; 3 mechanisms, '; then
    echo "ok - a damped hill: $(echo "$said" | sed -n '1s/.* right \([^ ]*\) .*/\1/p') of the error that is wanted"
else
    echo "not ok - a damped hill: $said"
fi
planned() { "$build/selas" check "$@" 2>&1; }
if planned "$out/basin.nml" | grep -q '^accuracy: .*grading 3 (.* % of the work less' &&
    ! planned "$out/hill.nml" | grep -q '^accuracy: .*grading' &&
    ! planned "$out/basin.nml" body%grading=1 | grep -q '^accuracy: .*grading'; then
    echo "ok - a grading is chosen with soft ground on rock, not in even rock, not where the deck says one"
else
    echo "not ok - the choice of a grading"
fi
if planned "$out/basin.nml" scene%accuracy= body%spacing=.05 | grep -q '^spacing over depth: even; .*grading = 3 would' &&
    ! planned "$out/hill.nml" scene%accuracy= body%spacing=.05 | grep -q '^spacing over depth'; then
    echo "ok - the plan names the grading that would save, and none in even rock"
else
    echo "not ok - the plan's grading"
fi
refused 'begins with a jump' w9 's/centre=.8/centre=.15/'
refused "receiver 'a' is in the initial wave already" w9 's/position=1.1/position=.85/'
refused 'disturb' w5 "s/kind='roller'/kind='free'/"
refused 'plane pulses' w9 's/width=.1/wavelength=.4/'
refused 'without absorbing layers' w3 "s/kind='transmitting'/kind='transmitting', layer='pml'/"
refused 'swings by .* of its length' b1 's/amplitude = .001/amplitude = .1/'
refused "fixed at 'x-' and free elsewhere" b3 "s/face = 'x-'/face = 'x-', 'x+'/"
refused 'four times as long' b3 's/high = 4,/high = 1.5,/; s/4,.25/1.5,.25/'
refused "wrong by 15 %" b1 "s/name = 'sph'/name = 'sph', variant = 'updated-lagrangian'/"
refused 'without viscosity' b1 "s/name = 'sph'/name = 'sph', viscosity_alpha = .5/"
refused 'pulled slowly' p2 's/smoothing=0.008/smoothing=0.0001/'
refused 'that settle' p2 's/viscosity_alpha = 0.5//'
refused "arrangement = 'conformal'" p2 "s/'conformal'/'radial'/"
refused 'out of reach of what was measured' p2 's/nothing//' .002
# trials refine: the box stays the one without layers that the law began with, as splines are tuned
cat >"$out/tuned.nml" <<'END'
&scene dimension = 3, end_time = 4.3, accuracy = .08 /
&material name = 'rock', density = 1, p_speed = 1.60743, s_speed = 1 /
&material name = 'soil', density = .9, p_speed = 1.5902, s_speed = .7 /
&layer material = 'soil', top = 0 /
&layer material = 'rock', top = .73 /
&body material = 'rock', shape = 'half-space' /
&load face = 'z-', shape = 'point', centre = 3*0, direction = -.68, .55, .82, history = 'ricker', frequency = .6191, delay = 1.938 /
&receiver name = 'r0', position = -.713, -1.926, 0 /
&receiver name = 'r1', position = -.31, .807, .586 /
&receiver name = 'r2', position = -.53, -.457, .85 /
END
"$build/selas" check "$out/tuned.nml" >"$out/log" 2>&1
if grep -q '^accuracy: .* degree 4, mass exact, tuned' "$out/log" && grep -q '^splines along the surface: tuned' "$out/log" &&
    grep -q '^box chosen: so large .*absorbing layers need splines that are not tuned' "$out/log"; then
    echo "ok - tuned splines, as the plan says, in a box without layers"
else
    echo "not ok - tuned splines, as the plan says, in a box without layers"
    cat "$out/log"
fi
