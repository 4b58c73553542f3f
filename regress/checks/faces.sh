#!/bin/sh
# What acts and what the ground is made of end on faces: blocks drawn to a face are those drawn past it, rock that a valley
# takes away is none, dampers beside a plateau have the speeds of the rock there, a traction on the edge of a plate leaves
# the rim of its hole alone. Argument: the build folder. TAP.
build=${1:-build}
selas=$PWD/$build/selas
work=$(mktemp -d "${TMPDIR:-/tmp}/selas-faces-XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
export OMP_NUM_THREADS=1
failures=0
cat >flush.nml <<'END'
&scene dimension = 2, end_time = 3 /
&material name = 'rock', density = 1.3, p_speed = 1.8, s_speed = 1.0 /
&material name = 'soft', density = 1.0, p_speed = 1.2, s_speed = 0.6 /
&body material = 'rock', low = -3, 0, high = 3, 3, spacing = 0.2 /
&block material = 'soft', shape = 'box', centre = 0, 0.5, size = 3, 1 /
&load face = 'y-', shape = 'square', centre = 0.2, 0, size = 0.6, direction = 0, 1, history = 'gaussian', width = 0.5, delay = 2 /
&receiver name = 'a', position = 1.2, 0 /
&receiver name = 'b', position = -0.8, 0.6 /
&output history_step = 0.2, plots = F /
END
differ() { # differ WHAT LEAST MOST ONE OTHER: velocities at a and b of two runs
    for r in a b; do paste "$4/$r.dat" "$5/$r.dat"; done | awk -v low="$2" -v high="$3" '!/^#/ { n = NF / 2
        for (i = 5; i <= 6; i++) { d += ($i - $(i + n)) ^ 2; a += $i ^ 2 } }
        END { printf "# %.2e\n", (a > 0 ? sqrt(d / a) : -1); exit !(a > 0 && sqrt(d / a) >= low && sqrt(d / a) <= high) }' &&
        echo "ok - $1" && return
    echo "not ok - $1"
    failures=$((failures + 1))
}
run() { # run DIRECTORY DECK WORDS...
    out=$1 deck=$2
    shift 2
    "$selas" -q "$deck" output%directory="$out" "$@" >/dev/null 2>&1
}
for side in "" boundary%face=y+ "boundary%face=y+ boundary%kind=fixed" "boundary%face=y+ boundary%kind=transmitting boundary%layer=lysmer"; do
    at="0,.5 2.5"
    [ -n "$side" ] && at="0,2.5 .5"
    # shellcheck disable=SC2086 # words
    run flush flush.nml block%centre="${at% *}" $side && run beyond flush.nml block%centre="$(echo "${at% *}" | sed 's/,.5/,0/; s/,2.5/,3/')" block%size=3,2 $side
    differ "a block that ends on a face as one drawn past it (${side:-surface})" 0 1e-9 flush beyond
done
# Absorbing layers know the rock in them, whatever words brought it there: waves that a block which ends on the face guides are
# damped (they grew), and the profile is made for the fastest rock (made for the body's own it sent back .006 here).
pml="boundary%face=x-,x+,y+ boundary%kind=transmitting boundary%layer=pml boundary%always=T scene%end_time=12"
# shellcheck disable=SC2086 # words
run flush flush.nml block%size=6,1 $pml && run beyond flush.nml block%size=20,1 $pml
differ "a block that ends on an absorbing layer as one drawn past it" 0 1e-9 flush beyond
sides="\&boundary face = 'x-', 'x+', kind = 'transmitting', layer = 'pml', layer_points = 12, always = T \/ \&boundary face = 'y+', kind = 'transmitting', layer = 'lysmer' \/"
sed "s/p_speed = 1.8, s_speed = 1.0/p_speed = 5, s_speed = 2.6/; s/^&block.*/$sides/" flush.nml >fast.nml
run layers fast.nml scene%end_time=12 method%operator=general layer%material=soft layer%top=0 'layer(2)%material=rock' 'layer(2)%top=1.1' &&
    run blocks fast.nml scene%end_time=12 body%material=soft block%material=rock block%centre=0,11.1 block%size=60,20 \
        stepping%time_step="$(sed -n 's/^time step: //p' layers/report.txt)"
differ "fast rock in absorbing layers as layers and as a block" 0 1e-4 layers blocks
printf '%s\n' '-9 -.3' '9 -.3' >flat.txt
sed "s/^&block.*/\&topography file = 'flat.txt' \/ \&layer material = 'soft', top = 0 \/ \&layer material = 'rock', top = .3 \//
    s/centre = 0.2, 0,/centre = 0.2, .3,/; s/position = 1.2, 0 /position = 1.2, .3 /" flush.nml >valley.nml
run valley valley.nml && sed "s/.soft., top/'rock', top/; /name = .soft/d" valley.nml >even.nml && run even even.nml
differ "rock that a valley takes away acts on nothing" 0 1e-9 valley even
# --- The same ground as a body below a plateau and as one with a level surface ---
printf '%s\n' '-9 .8' '9 .8' >plateau.txt
cat >plateau.nml <<'END'
&scene dimension = 2, end_time = 7 /
&material name = 'rock', density = 1.2, p_speed = 3, s_speed = 1.7 /
&material name = 'soft', density = .8, p_speed = 1.4, s_speed = .7 /
&body material = 'rock', shape = 'box', low = -2, 0, high = 2, 3, spacing = .1 /
&topography file = 'plateau.txt' /
&layer material = 'soft', top = 0 /
&layer material = 'rock', top = .4 /
&load kind = 'body-force', shape = 'point', centre = .2, -.1, direction = 1, .6, history = 'gaussian', width = .5, delay = 2 /
&receiver name = 'a', position = -1, -.8 /
&receiver name = 'b', position = 1.2, -.3 /
&output history_step = .1, plots = F /
END
sed "s/^&topography.*/\&method operator = 'general' \//; s/low = -2, 0/low = -2, -.8/; s/top = .4/top = 1.2/" plateau.nml >level.nml
for side in "" "boundary%face=x-,x+ boundary%kind=transmitting boundary%layer=lysmer"; do
    # shellcheck disable=SC2086 # words
    run plateau plateau.nml $side && run level level.nml $side
    differ "ground below a plateau as level ground (${side:-free sides})" 0 .015 plateau level
done
# --- Rock thinner than the spacing at the surface or the bottom counts as what there is of it ---
cat >thin.nml <<'END'
&scene dimension = 2, end_time = 5 /
&material name = 'rock', density = 1, p_speed = 2, s_speed = 1 /
&material name = 'heavy', density = 5, p_speed = 2, s_speed = 1 /
&body material = 'rock', low = 0, 0, high = 4, 1, spacing = .1 /
&layer material = 'heavy', top = 0 /
&layer material = 'rock', top = .01 /
&load kind = 'body-force', shape = 'point', centre = 1, .4, direction = 1, .6, history = 'gaussian', width = .3, delay = 1.3 /
&receiver name = 'a', position = 2, 0 /
&receiver name = 'b', position = 3, .5 /
&output history_step = .1, plots = F /
END
sed "s/'heavy', top = 0/'rock', top = 0/; s/'rock', top = .01/'heavy', top = .99/" thin.nml >thick.nml
for scene in thin thick; do
    run layers $scene.nml method%operator=layered && run general $scene.nml method%operator=general
    differ "a thin layer at a face as the layered operator has it ($scene)" 0 .08 general layers
done
# --- Thin walls, within the body and at its side, are the same walls lying flat ---
cat >wall.nml <<'END'
&scene dimension = 2, end_time = 5 /
&material name = 'rock', density = 1, p_speed = 2, s_speed = 1 /
&material name = 'heavy', density = 5, p_speed = 2, s_speed = 1 /
&body material = 'rock', low = 0, 0, high = 4, 4, spacing = .1 /
&block material = 'heavy', centre = 1.53, 2, size = .006, 9 /
&block material = 'heavy', centre = 4, 2, size = .04, 9 /
&load kind = 'body-force', shape = 'point', centre = 1, 1.4, direction = 1, .6, history = 'gaussian', width = .3, delay = 1.3 /
&receiver name = 'a', position = 2, 1 /
&receiver name = 'b', position = 3.9, 2.5 /
&output history_step = .1, plots = F /
END
sed -E 's/(centre|size|direction|position) = ([^ ,]*), ([^ ,]*)/\1 = \3, \2/g' wall.nml >flat.nml
run wall wall.nml && run flat flat.nml
for r in a b; do awk '!/^#/ { v = $5; $5 = $6; $6 = v } { print }' flat/$r.dat >flat/turned && mv flat/turned flat/$r.dat; done
differ "thin walls as the same walls lying flat" 0 1e-9 wall flat
# Walls in the middle of points, about which the rock rises to neither side, too.
for middle in 1.5 1.55; do
    for way in wall flat; do
        place="$middle,2" size=.14,9
        [ $way = flat ] && place="2,$middle" size=9,.14
        run $way $way.nml 'material(2)%density=1' 'material(2)%s_speed=2.5' 'material(2)%p_speed=5' 'block(2)%material=rock' "block(1)%centre=$place" "block(1)%size=$size"
    done
    for r in a b; do awk '!/^#/ { v = $5; $5 = $6; $6 = v } { print }' flat/$r.dat >flat/turned && mv flat/turned flat/$r.dat; done
    differ "a stiff wall about $middle as the same wall lying flat" 0 1e-9 wall flat
done
for shape in box ellipsoid; do
    for place in 1.53 1.536; do run $place wall.nml 'block(2)%material=rock' "block(1)%shape=$shape" 'block(1)%size=.006,3' "block(1)%centre=$place,2"; done
    differ "a thin $shape is there wherever it stands" 0 .01 1.53 1.536
done
# --- A source in the middle of a thin layer, from which the rock changes to neither side ---
cat >middle.nml <<'END'
&scene dimension = 2, end_time = 4 /
&material name = 'soft', density = 1, s_speed = 1, p_speed = 1.67 /
&material name = 'stiff', density = 1.16, s_speed = 2, p_speed = 3.4 /
&body material = 'stiff', shape = 'half-space', low = -2.2, 0, high = 2.2, 2, spacing = .1 /
&layer material = 'stiff', top = 0 /
&layer material = 'soft', top = 0.6954 /
&layer material = 'stiff', top = 0.8056 /
&load kind = 'moment-tensor', centre = -0.01, 0.7505, moment = 0.71, -0.13, 0, 0.71, 0, 0, history = 'gaussian', width = 0.25, delay = 1.25 /
&receiver name = 'a', position = 1.09, 0 /
&receiver name = 'b', position = -1.69, 0.95 /
&output history_step = 0.05, plots = F /
END
run thin middle.nml method%operator=general && run exact middle.nml method%operator=layered body%spacing=.05
differ "a moment tensor in the middle of a layer 1.1 spacings thick" 0 .05 thin exact
# a snapshot there, of rocks of one shear modulus, about whose middle nothing has a direction
cat >wet.nml <<'END'
&scene dimension = 2, end_time = 3 /
&material name = 'rock', density = 1, p_speed = 1.8, s_speed = 1 /
&material name = 'wet', density = 1, p_speed = 4, s_speed = 1 /
&body material = 'rock', low = -1, 0, high = 1, 2, spacing = .1 /
&boundary face = 'x-', 'x+', 'y+', kind = 'roller' /
&layer material = 'rock', top = 0 /
&layer material = 'wet', top = .9 /
&layer material = 'rock', top = 1.1 /
&load face = 'y-', shape = 'square', centre = -.2, 0, size = .5, direction = .3, 1, history = 'gaussian', width = .3, delay = 1.2 /
&profile name = 'p', from = -.8, 1, to = .8, 1, points = 17, fields = 'stress', times = 2.5 /
&snapshot times = 2.5, fields = 'stress', region = -.8, 1, .8, 1 /
&output plots = F /
END
run shown wet.nml method%operator=general && run exact wet.nml method%operator=layered body%spacing=.05
if { awk '!/#/ && NF == 10' exact/p.dat && h5dump -y -w 0 -m %.9g -d /snapshots/0000/stress shown/run.h5 | sed -n '/DATA {/,/}/s/[^0-9.e+-]/ /gp'; } |
    awk 'NF == 10 { for (i = 5; i <= 10; i++) p[n++] = $i; next }
        { for (i = 1; i <= NF; i++) { d += ($i - p[m])^2; s += p[m++]^2 } } END { printf "# %.2e\n", (s > 0 ? sqrt(d / s) : -1); exit !(n == 102 && m == 102 && d < .03^2 * s) }'; then
    echo "ok - a snapshot in the middle of a layer two spacings thick, of one shear modulus"
else
    echo "not ok - a snapshot in the middle of a layer two spacings thick, of one shear modulus"
    failures=$((failures + 1))
fi

# --- A moment tensor beside an interface, half a spacing from a symmetry plane and a little more ---
cat >plane.nml <<'END'
&scene dimension = 2, end_time = 2.5 /
&method operator = 'general' /
&material name = 'soft', density = 1, lambda = 1, mu = 1 /
&material name = 'stiff', density = 1.3, p_speed = 3.4, s_speed = 2 /
&body material = 'stiff', low = 0, 0, high = 1.6, 1.6, spacing = .1 /
&layer material = 'soft', top = 0 /
&layer material = 'stiff', top = .9 /
&boundary face = 'x-', kind = 'symmetry' /
&load kind = 'moment-tensor', centre = .05, .87, moment = 0, 0, 0, 1, 0, 0, history = 'gaussian', width = .25, delay = 1.25 /
&receiver name = 'a', position = .8, 0 /
&receiver name = 'b', position = .5, .5 /
END
run half plane.nml
run beside plane.nml load%centre=.0501,.87
differ "a moment tensor half a spacing from a symmetry plane" 0 .02 half beside
# --- The rim of a hole ---
cat >hole.nml <<'END'
&scene dimension = 2, end_time = 8 /
&method name = 'sph', law = 'linear' /
&material name = 'm', density = 1, lambda = 1, mu = 1 /
&body material = 'm', shape = 'plate-with-hole', low = -1, -1, high = 1, 1, hole_centre = 0, 0, hole_radius = 0.5, spacing = 0.05 /
&load face = 'y+', shape = 'face', direction = 0, 1, amplitude = 1e-3, history = 'gaussian', width = 1.2, delay = 5 /
&load face = 'y-', shape = 'face', direction = 0, -1, amplitude = 1e-3, history = 'gaussian', width = 1.2, delay = 5 /
&receiver name = 'a', position = 0.7, 0.0 /
&receiver name = 'b', position = 0.0, 0.7 /
&output history_step = 0.1, plots = F /
END
run hole hole.nml body%arrangement=conformal && run fine hole.nml body%arrangement=conformal body%spacing=.025
differ "a traction beside a hole converges" 0 .1 hole fine
if "$selas" check hole.nml body%spacing=.1 2>&1 | grep -q "5.0 points lie between the hole's rim and the edge"; then
    echo "ok - few points beside a hole are told of"
else
    echo "not ok - few points beside a hole are told of"
    failures=$((failures + 1))
fi
exit $failures
