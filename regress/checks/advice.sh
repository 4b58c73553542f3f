#!/bin/sh
# What may be wrong in a scene is told by `selas check` and in the report, with what would be right; a sound scene is told
# nothing; --strict makes errors of it. Argument: the build folder. Prints TAP.
build=${1:-build}
selas=$PWD/$build/selas
work=$(mktemp -d "${TMPDIR:-/tmp}/selas-advice-XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
export OMP_NUM_THREADS=1
failures=0
cat >good.nml <<'END'
&scene dimension = 2, end_time = 2.0 /
&material name = 'rock', density = 1.0, lambda = 1.0, mu = 1.0 /
&body material = 'rock', shape = 'box', low = 0, 0, high = 4, 4, spacing = 0.25 /
&boundary face = 'x+', 'y+', kind = 'transmitting' /
&boundary face = 'x-', kind = 'symmetry' /
&load face = 'y-', shape = 'square', centre = 0, 0, size = 1, direction = 0, 1, history = 'gaussian', width = 1, delay = 5 /
&receiver name = 'r', position = 2, 1 /
&output plots = .false. /
END
told() { # told WHAT WORDS OVERRIDE...: the plan warns with the words, and of nothing else
    what=$1
    words=$2
    shift 2
    "$selas" check "${deck:-good.nml}" "$@" >said 2>&1
    "$selas" --strict check "${deck:-good.nml}" "$@" >strict 2>&1
    status=$?
    if [ "$(grep -c '^warning' said)" -eq 1 ] && grep -q "^warning: .*$words" said && [ $status -eq 2 ] &&
        grep -q "^error: .*$words" strict; then
        echo "ok - $what"
    else
        echo "not ok - $what (strict: $status)"
        grep -E '^(warning|error)' said strict | sed 's/^/# /'
        failures=$((failures + 1))
    fi
}
untold() { # untold WHAT OVERRIDE...: nothing to warn of
    what=$1
    shift
    if "$selas" --strict check "$deck" "$@" >said 2>&1 && ! grep -q warning said; then
        echo "ok - $what"
    else
        echo "not ok - $what"
        sed 's/^/# /' said
        failures=$((failures + 1))
    fi
}
if "$selas" --strict check good.nml >said 2>&1 && ! grep -q warning said; then
    echo "ok - nothing to warn of"
else
    echo "not ok - nothing to warn of"
    sed 's/^/# /' said
    failures=1
fi
grep -v receiver good.nml >blind.nml
deck=blind.nml
told "nothing that is looked at" "nothing is looked at"
deck=
# cutoff of the gaussian: exp(-(w width)^2 / 2) = .05 at w = 2.448 / width; S waves of speed 1: 4 points at spacing .642 width
told "few points per wavelength" "3.08 points per wavelength .* 4 need body%spacing = 0.193" load%width=.3 load%delay=2
told "a small step" "leave stepping%time_step" stepping%time_step=1e-3
told "a receiver at an absorbing face" "receiver 'r' lies at the absorbing face x+ .*(0.5) inside" receiver%position=3.9,2
told "a load on an absorbing face" "load 1 acts on the absorbing face y+" load%face=y+ load%centre=0,4
told "few points ahead of a load that moves" "3.08 points per wavelength .* ahead of what moves" load%velocity=.5,0 load%width=.6 \
    load%delay=4 "boundary(2)%kind=free"
told "an edge that comes by" "load 1 comes by receiver 'r'.* err by about 0.19 there.*(displacements by 0.07)" load%velocity=.25,0 receiver%position=1,0 "boundary(2)%kind=free"
told "one three spacings below it" "load 1 comes by receiver 'r'.* err by about 0.041 there" load%velocity=.6,0 receiver%position=1,.75 "boundary(2)%kind=free"
deck=good.nml
untold "below a slow one" load%velocity=.3,0 receiver%position=1,.75 "boundary(2)%kind=free"
cat >rest.nml <<'END'
&scene dimension = 3, end_time = 40 /
&material name = 'rock', density = 1, lambda = 1, mu = 1 /
&body material = 'rock', shape = 'half-space', spacing = .25 /
&load kind = 'moment-tensor', centre = 0, 0, 2, moment = 1, .3, -.5, .2, .6, .1, history = 'error-function', width = .6, delay = 3 /
&receiver name = 'r', position = 4, 0, 0 /
&output plots = F /
END
deck=rest.nml
told "what stays between layers" "load 1 stays on, .* displacements may err by 0.03 of what is left at receiver 'r'; boundary%layer_points = 15 would"
layers="boundary%face=x-,x+,y-,y+,z+ boundary%kind=transmitting"
untold "what stays, with as many points as told" $layers boundary%layer_points=15
told "what stays, with fewer" "err by 0.07 of what is left" $layers boundary%layer_points=8
untold "what stays, seen early" scene%end_time=10
cat >rest.nml <<'END'
&scene dimension = 2, end_time = 40 /
&material name = 'rock', density = 1, p_speed = 1.8, s_speed = 1 /
&body material = 'rock', low = -7, 0, high = 7, 6, spacing = .25 /
&boundary face = 'x-', 'x+', 'y+', kind = 'transmitting', layer = 'pml', layer_points = 8 /
&load kind = 'body-force', shape = 'point', centre = 0, 2, direction = .3, 1, history = 'error-function', width = .8, delay = 4 /
&receiver name = 'a', position = 2, 0 /
&receiver name = 'b', position = 6, 1 /
&output plots = F /
END
told "what stays, in the plane" "displacements and, as these go on growing, velocities may err by 0.2 of what is left at receiver 'b'"
pulse='load%history=gaussian'
told "what a pulse leaves" "give way to what a pulse leaves: by the end displacements may err by 0.1 of the largest; boundary%layer_points = 14 would" $pulse
untold "what a pulse leaves, with as many points as told" $pulse boundary%layer_points=14
untold "what a pulse leaves, seen early" $pulse scene%end_time=10
"$selas" check --echo rest.nml >said 2>&1
if awk '/^echo b:/ { v = $3; u = $(NF - 3) } /^expected of what stays/ { said = $5 } # measured in a box of 88 x 44: .113 and .105
    END { exit !(v > .08 && v < .13 && u > .08 && u < .13 && said > u && said < 3 * u) }' said; then
    echo "ok - check --echo measures what stays: $(grep '^echo b' said)"
else
    echo "not ok - check --echo measures what stays"
    sed 's/^/# /' said
    failures=$((failures + 1))
fi
cat >after.nml <<'END'
&scene dimension = 3, end_time = 12 /
&material name = 'rock', density = 1, p_speed = 1.7320508, s_speed = 1 /
&body material = 'rock', shape = 'half-space', low = -2, -2, 0, high = 2, 2, 3, spacing = .25 /
&boundary face = 'x-', 'x+', 'y-', 'y+', 'z+', kind = 'transmitting', layer = 'pml', layer_points = 4 /
&load face = 'z-', shape = 'square', centre = 0, 0, 0, size = .75, .75, direction = 0, 0, 1, history = 'gaussian', width = .5, delay = 2.5 /
&receiver name = 'r', position = 1, 1, 0 /
&output plots = F /
END
deck=after.nml
told "what a pulse leaves in space" "give way to what a pulse leaves: by the end displacements may err by 0.04 of the largest; boundary%layer_points = 8 would" # .030 against layers of 20 points
untold "what a pulse leaves in space, with as many points as told" boundary%layer_points=8
unset deck
cat >shaken.nml <<'END'
&scene dimension = 2, end_time = 20 /
&material name = 'soil', density = 1, p_speed = 1.8, s_speed = 1 /
&body material = 'soil', low = -6, 0, high = 6, 5, spacing = .25 /
&boundary face = 'x-', 'x+', kind = 'transmitting', layer = 'lysmer' /
&boundary face = 'y+', kind = 'velocity', direction = 1, 0, history = 'gaussian', width = .7, delay = 3 /
&receiver name = 'r', position = 0, 0 /
&output plots = F /
END
deck=shaken.nml
told "a shaken base between dampers" "the motion of face y+ acts as far as the absorbing face x- and on nothing behind it"
untold "one whose sides leave the motion as it is" "boundary(1)%kind=displacement" "boundary(1)%layer=" \
    "boundary(1)%direction=0,1" "boundary(1)%slip=T" "boundary(1)%amplitude=0" "boundary(1)%history=step"
untold "one whose sides are not seen" scene%end_time=3.3
told "a load of a whole face between dampers" "load 1 acts as far as the absorbing face x-" "boundary(2)%kind=fixed" \
    "boundary(2)%direction=" "boundary(2)%history=" "boundary(2)%width=" "boundary(2)%delay=" load%face=y- load%shape=face \
    load%direction=0,1 load%history=gaussian load%width=.7 load%delay=3
told "a body force between dampers" "load 1 acts as far as the absorbing face x-" "boundary(2)%kind=fixed" \
    "boundary(2)%direction=" "boundary(2)%history=" "boundary(2)%width=" "boundary(2)%delay=" load%kind=body-force \
    load%direction=1,0 load%history=gaussian load%width=.7 load%delay=3
patch="boundary(2)%kind=transmitting boundary(2)%direction= boundary(2)%history= boundary(2)%width= boundary(2)%delay= \
    load%face=y- load%shape=square load%size=2 load%direction=0,1 load%history=gaussian load%width=2 load%delay=8 scene%end_time=30"
# shellcheck disable=SC2086
told "a patch that hangs over an absorbing face" "load 1 runs beyond the body.* a body from 4.5 to 6.5 along x" $patch load%centre=5.5,0
# shellcheck disable=SC2086
told "a patch that drives over an absorbing face" "load 1 runs beyond the body.* a body from -1 to 7 along x" $patch load%centre=0,0 \
    load%velocity=.2,0 receiver%position=0,4
# shellcheck disable=SC2086
untold "one that is there at the end only" $patch load%centre=0,0 load%velocity=.167,0 receiver%position=0,4
# shellcheck disable=SC2086
untold "one that drives over a free face" $patch load%centre=0,0 load%velocity=.2,0 receiver%position=0,4 "boundary(1)%face=x-"
unset deck
# lambda = mu: (cR/cs)^2 = 2 - 2/sqrt 3
told "a load faster than the Rayleigh wave" "load 1 moves at 0.95, faster than the Rayleigh wave (0.9194)" load%velocity=-.95,0 "boundary(2)%kind=free"
soft="material(2)%name=soft material(2)%density=1 material(2)%lambda=.6 material(2)%mu=.6 block%material=soft block%centre=2,0 block%size=20,2"
told "one above a block that is soft" "load 1 moves at 0.8, faster than the Rayleigh wave (0.7122)" load%velocity=-.8,0 "boundary(2)%kind=free" $soft
# beside what variant 'paper' is told of whatever acts on its faces
"$selas" check good.nml method%variant=paper method%row_sums=zero scene%end_time=.8 load%delay=4.2 load%size=1.1 "boundary(2)%kind=free" >said 2>&1
if [ "$(grep -c '^warning' said)" -eq 2 ] && grep -q "^warning: variant 'paper' carries what acts on faces" said &&
    grep -q '^warning: .*edges of load 1 along x lie between points; -0.5 to 0.5 would' said; then
    echo "ok - a patch beside the lattice"
else
    echo "not ok - a patch beside the lattice"
    sed 's/^/# /' said
    failures=$((failures + 1))
fi
told "half a patch that is no half" "symmetry plane x- cuts load 1 beside its middle: .*x = 0 would" load%centre=0.25,0
told "a push across the symmetry plane" "pushes across the symmetry plane x-" load%direction=1,0
particles="method%name=sph method%variant=updated-lagrangian boundary(1)%layer=lysmer scene%end_time=.8 load%delay=4.2"
# shellcheck disable=SC2086
told "a patch beside the particles' cells" "edges of load 1 along x lie between the particles' cells.*-0.5 to 0.5 would" $particles load%size=1.1
# 0.55 of a disc of diameter 1.1 lies on the body, with two particles in it: .5 / .55
# shellcheck disable=SC2086
told "a disc of few particles" "have 0.909 of its area.* amplitude = 1.1 would" $particles load%shape=disc load%size=1.1
told "shear on a whole face across a symmetry plane" "load 1 pushes across the symmetry plane x-, beyond which" load%shape=face load%direction=1,0 load%centre= load%size= "boundary(1)%kind=free"
told "a body force across a symmetry plane" "load 1 pushes across the symmetry plane x-, beyond which" load%kind=body-force load%shape=face load%face= load%direction=1,0 load%centre= load%size= "boundary(1)%kind=free"
told "a force at an absorbing face" "load 1 acts at the absorbing face y+.*two spacings (0.5)" load%kind=body-force load%shape=point load%face= load%centre=1,3.9 load%size=
force="load%kind=body-force load%shape=point load%face= load%size="
# shellcheck disable=SC2086
told "a receiver beside a point force" "receiver 'r' is 0.35 from load 1.*nearer than 2 spacings (0.5).*body%spacing = 0.175" $force load%centre=2,1.35
told "one in the midst of a moment tensor" "receiver 'r' is 0.9 from load 1.*nearer than 6 spacings (1.5)" load%face= load%size= load%kind=moment-tensor load%shape= load%direction= load%moment=1,1,0,0,0,0 load%centre=2,1.9
hill="topography%shape=ridge topography%height=.4 topography%width=.5"
# shellcheck disable=SC2086
told "a hill that absorbing layers cut" "made level, which changes its heights by up to" $force load%centre=.8,2.5 $hill topography%centre=3.5
# shellcheck disable=SC2086
"$selas" --strict check good.nml $force load%centre=.8,2.5 $hill topography%centre=.0 >said 2>&1 && echo "ok - a hill that ends before them: nothing to warn of" || { echo "not ok - a hill that ends before them"; failures=$((failures + 1)); }
deck=start.nml
sed '/^&load/d; /^&boundary face = .x+/d; s/spacing = 0.25/spacing = 0.16/' good.nml >start.nml
echo "&stepping scheme = 'modified-equation' /" >>start.nml
echo "&initial kind = 'gaussian', centre = 0, 2, width = 0.5, amplitude = 0.1, direction = 0, 1 /" >>start.nml
"$selas" --strict check start.nml >said 2>&1 && echo "ok - a pulse on a symmetry plane: nothing to warn of" || told "a pulse on a symmetry plane" "nothing"
told "half a pulse that is no half" "initial state is not its own image in the symmetry plane x-" initial%centre=0.5,2
told "a pulse across a symmetry plane" "initial state is not its own image in the symmetry plane x-" initial%direction=1,0
told "a pulse that reaches a free face" "initial state reaches face y-, 2 widths away and free" initial%centre=0,1
# a P wave of 2.567 widths becomes an S wave of 2.567 widths / sqrt 3 at a free face, not at a roller
told "few points in a pulse" "2.32 points per wavelength of the initial state, .* 4 need body%spacing = 0.0926" initial%width=.25
sed '/^&boundary/d' start.nml >rollers.nml
echo "&boundary face = 'all', kind = 'roller' /" >>rollers.nml
deck=rollers.nml
untold "the same between rollers" initial%width=.25 initial%centre=2,2 scene%end_time=.1
told "the same for longer" "initial state's shortest waves, 4.01 points each, .* by about 0.039 by end_time; body%spacing = 0.114" initial%width=.25 initial%centre=2,2
told "at degree 1" "initial state's shortest waves, 4.01 points each, .* by about 0.34 by end_time" initial%width=.25 initial%centre=2,2 method%degree=1
told "at degree 3 with sweeps" "initial state's shortest waves, 4.01 points each, .* by about 0.064 by end_time" initial%width=.25 initial%centre=2,2 method%degree=3
untold "at degree 4" initial%width=.25 initial%centre=2,2 method%degree=4 method%mass=exact
untold "at that spacing" initial%width=.25 initial%centre=2,2 body%spacing=.1
told "a long way to an S wave" "initial state's shortest waves, 4.63 points each, .* by about 0.02[0-9] by end_time" boundary%kind=free initial%centre=2,2 scene%end_time=12
wave="initial%kind=plane-wave initial%centre=2,2 initial%direction"
# shellcheck disable=SC2086
{
    untold "a pulse between rollers" $wave=0,1 initial%width=.4
    told "a pulse askew" "face x-, sliding, cuts the plane wave of t = 0" $wave=.6,.8 initial%width=.4
    told "a P pulse beside free faces" "face x-, free, cuts the plane wave of t = 0" $wave=0,1 boundary%face=y-,y+ initial%width=.5 scene%end_time=1
    told "an S pulse that moves across rollers" "face x-, sliding, cuts the plane wave of t = 0 .* a support that holds motion along the wave alone" $wave=0,1 initial%wave=s initial%polarisation=1,0 initial%width=.4
    told "a pulse that begins near a face" "face y-, sliding, cuts the plane wave of t = 0" $wave=0,1 initial%width=.8
}
told "few points between rollers" "3.21 points per wavelength of the initial state, .* 4 need body%spacing = 0.128" initial%width=.2 initial%centre=2,2
told "a pulse that a roller cuts" "initial state reaches face y-, 2 widths away and sliding" initial%centre=2,1
told "a pulse that a held face cuts" "initial state reaches face x-, 3 widths away and held" boundary%kind=fixed initial%centre=1.5,2
told "a body that runs into a held face" "velocities jump at face x-, which is held" boundary%kind=fixed initial%kind=uniform-velocity initial%velocity=1,0 initial%centre= initial%width= initial%amplitude= initial%direction=
# omega = c_p sqrt 2 / width = 4.899, dt = .0512: omega t (omega dt)^2 / 24
told "the time error of leapfrog" "time error of scheme 'leapfrog' stays .* by about 0.18 by" stepping%scheme=leapfrog initial%centre=2,2 scene%end_time=14
untold "a shorter step" stepping%scheme=leapfrog initial%centre=2,2 scene%end_time=14 stepping%safety=.21
told "waves on total-Lagrangian points" "waves on the points of variant 'total-lagrangian' err by up to 0.[1-9]" initial%centre=2,2 method%name=sph method%gradient=quadratic
untold "longer waves on central differences" initial%centre=2,2 method%name=sph method%gradient=central
# shellcheck disable=SC2086 # words
(
    # .08 of waves, .1 of one-sided gradients
    stress="initial%centre=2,2 method%name=sph method%gradient=central profile%name=p profile%points=5 profile%times=1 profile%fields"
    told "stresses of particles beside a face" "stresses and strains that profiles and snapshots show err by up to about 0.18 within a spacing of faces" $stress=stress profile%from=1,.1 profile%to=3,.1
    untold "velocities there" $stress=velocity profile%from=1,.1 profile%to=3,.1
    untold "stresses inside" $stress=stress profile%from=1,1.5 profile%to=3,2.5
    shown="initial%centre=2,2 method%name=sph method%gradient=central snapshot%times=1 snapshot%fields=stress"
    told "a region of a snapshot beside a face" "show err by up to about 0.18 within a spacing of faces" $shown snapshot%region=1,0,3,.5
    untold "a region inside" $shown snapshot%region=1,1.5,3,2.5
    exit $failures
)
failures=$?
updated="stepping%scheme=rk4 initial%centre=2,2 method%name=sph method%variant=updated-lagrangian method%artificial_stress=0 method%viscosity_beta=0"
# shellcheck disable=SC2086 # words
{
    told "waves on updated-Lagrangian points without viscosity" "'updated-lagrangian' err by up to 0.7[0-9] when" $updated scene%end_time=1.2 method%viscosity_alpha=0
    untold "the same for a moment" $updated scene%end_time=.1 method%viscosity_alpha=0
}
# motion at t = 0 keeps the transform from running: the modified equation, where it can run
scheme() { # scheme WHAT SCHEME OVERRIDE...: what the plan takes where the deck names none
    what=$1
    wanted=$2
    shift 2
    taken=$("$selas" check start.nml stepping%scheme= "$@" 2>&1 | sed -n 's/^scheme: //p')
    if [ "$taken" = "$wanted" ]; then
        echo "ok - scheme of $what: $taken"
    else
        echo "not ok - scheme of $what: '$taken', not $wanted"
        failures=$((failures + 1))
    fi
}
scheme "a motion at t = 0" modified-equation initial%centre=2,2
scheme "the same, total-Lagrangian with a linear law" modified-equation initial%centre=2,2 method%name=sph method%law=linear
scheme "the same with a nonlinear law" leapfrog initial%centre=2,2 method%name=sph
scheme "the same in damped rock" modified-equation initial%centre=2,2 material%q_p=50 material%q_s=50 material%q_frequency=.5
solid="scene%dimension=3 body%low=0,0,0 body%high=4,4,4 receiver%position=2,1,1 initial%centre=2,2,2 initial%direction=0,1,0"
# shellcheck disable=SC2086
scheme "the same in space" modified-equation $solid
# shellcheck disable=SC2086
scheme "the same in single precision" leapfrog $solid method%precision=single
"$selas" -q start.nml stepping%scheme= output%directory=bare initial%centre=2,2 scene%end_time=14 >said 2>&1
"$selas" -q start.nml output%directory=named initial%centre=2,2 scene%end_time=14 >said 2>&1
if grep -v '^#' bare/r.dat >bare.rows && grep -v '^#' named/r.dat | cmp -s - bare.rows; then
    echo "ok - its histories are those of the scheme said"
else
    echo "not ok - its histories are not those of the scheme said"
    failures=$((failures + 1))
fi
deck=good.nml
told "a history that jumps" "a history jumps, .* smoothing = 2.72 would be right" load%history=step load%width= load%delay=
untold "the same with that smoothing" load%history=step load%width= load%delay= load%smoothing=2.72
deck=start.nml
cp start.nml cut.nml
echo "&boundary face = 'y+', kind = 'transmitting', layer = 'lysmer' /" >>cut.nml
deck=cut.nml
told "a pulse that an absorbing face cuts" "initial state reaches face y+, .* absorbing, beyond which there is nothing of it" initial%centre=0,3.5
deck=moved.nml
sed '/^&load/d' good.nml | sed "s/'x+', 'y+', kind = 'transmitting'/'y+', kind = 'displacement', direction = 0, 1, amplitude = 0.1, history = 'gaussian', width = 1, delay = 5/" >moved.nml
"$selas" --strict check moved.nml >said 2>&1 && echo "ok - a face that moves along a symmetry plane: nothing to warn of" || told "a face that moves along" "nothing"
told "a face that moves across a symmetry plane" "face y+ moves across the symmetry plane x-" "boundary(1)%direction=1,0"
deck=edge.nml
sed "/^&load/d; /symmetry/d; s/kind = 'transmitting'/kind = 'velocity', direction = 1, 0, amplitude = 0.1, history = 'gaussian', width = 1, delay = 5/" good.nml >edge.nml
"$selas" --strict check edge.nml >said 2>&1 && echo "ok - two faces that move together: nothing to warn of" || told "two faces that move together" "nothing"
sed "s/'x+', 'y+'/'y+'/" edge.nml >held.nml
echo "&boundary face = 'x-', kind = 'fixed' /" >>held.nml
deck=held.nml
told "a moved face that meets a fixed one" "faces x- and y+ meet, and prescribe different motions along x there"
told "a moved face that meets a roller" "faces x- and y+ meet, and prescribe different motions along x there" "boundary(2)%kind=roller"
"$selas" --strict check held.nml "boundary(2)%face=y-" >said 2>&1 && echo "ok - a fixed face opposite: nothing to warn of" || told "a fixed face opposite" "nothing"
deck=space.nml
cat >space.nml <<'END'
&scene dimension = 3, end_time = 2.0 /
&method name = 'sph', gradient = 'central' /
&material name = 'rock', density = 1.0, lambda = 1.0, mu = 1.0 /
&body material = 'rock', shape = 'box', low = 0, 0, 0, high = 3, 3, 2, spacing = 0.25 /
&load face = 'z-', shape = 'square', centre = 1.5, 1.5, 0, size = 1, 1, direction = 0, 0, 1, history = 'gaussian', width = 1, delay = 5 /
&receiver name = 'r', position = 2, 1, 0 /
END
"$selas" --strict check space.nml >said 2>&1 && echo "ok - central differences under a patch: nothing to warn of" || told "central differences" "nothing"
told "quadratic gradients under a narrow patch" "only 4 points wide.*rings on; method%gradient = 'central'" method%gradient=quadratic
told "linear gradients under a narrow patch" "only 4 points wide.*rings on; method%gradient = 'central'" method%gradient=linear
told "the same on jittered points" "rings on; method%variant = 'cloud'" method%gradient=quadratic body%jitter=0.1
flat="scene%dimension=2 body%low=0,0 body%high=4,2 load%face=y- load%centre=1.5,0 load%size=1 load%direction=0,1 receiver%position=2,1"
# shellcheck disable=SC2086 # words
{
    told "quadratic gradients under a narrow patch in the plane" "only 4 points wide.*rings on; method%gradient = 'central'" $flat method%gradient=quadratic
    untold "central differences in the plane" $flat
}
deck=layers.nml
cat >layers.nml <<'END'
&scene dimension = 3, end_time = 5.0 /
&material name = 'rock', density = 1.0, lambda = 1.0, mu = 1.0 /
&body material = 'rock', shape = 'box', low = 0, 0, 0, high = 2.5, 1.5, 1.5, spacing = 0.0625 /
&boundary face = 'x-', 'y-', kind = 'symmetry' /
&boundary face = 'x+', 'y+', 'z+', kind = 'transmitting', layer = 'pml' /
&load face = 'z-', shape = 'square', centre = 0, 0, 0, size = 1, 1, direction = 0, 0, 1, history = 'triangle', duration = 2, smoothing = 1 /
&receiver name = 'r0', position = 0, 0, 0 /
&receiver name = 'r1', position = 1, 0, 0 /
&receiver name = 'r2', position = 2, 0, 0 /
END
# 8 points leave .0036 there, the spacing .0001 (doc/verification/accuracy.md, section 3)
untold "absorbing layers whose points the program chooses"
sed -i "s/layer = 'pml'/layer = 'pml', layer_points = 8/" layers.nml
told "layers too thin for the spacing" "layers of 8 points are only 0.0[0-9]* P wavelengths thick .* about 0.00[34], the spacing only 0.000[0-9]*; .* layer_points = 1[2-4] would"
untold "layers as thick as advised" "boundary(2)%layer_points=$(sed -n 's/^warning.*layer_points = \([0-9]*\) would.*/\1/p' said)"
untold "eight points are enough for a coarser spacing" body%spacing=0.125
untold "a kinked pulse, of which the spacing leaves more" load%smoothing=0
cat >reach.nml <<'END'
&scene dimension = 3, end_time = 4 /
&material name = 'rock', density = 2.7, p_speed = 5, s_speed = 3 /
&body material = 'rock', shape = 'half-space', spacing = 0.5 /
&load kind = 'body-force', shape = 'point', centre = 0, 0, 6, direction = 0, 0, 1, history = 'gaussian', width = .5, delay = 2.5 /
&receiver name = 'r', position = 5, 0, 0 /
&output plots = .false. /
END
deck=reach.nml
untold "a receiver that waves reach"
untold "one that they reach a little later" receiver%position=15,0,0
told "one in metres beside speeds in km/s" "receiver 'r' by end_time: the fastest, 5, comes there at t = 99.81 at" receiver%position=500,0,0
cat >graded.nml <<'END'
&scene dimension = 3, end_time = 3.0 /
&method operator = 'general' /
&material name = 'soil', density = 1.0, p_speed = 1.0, s_speed = 0.5 /
&material name = 'rock', density = 1.3, p_speed = 2.6, s_speed = 1.5 /
&body low = 0, 0, 0, high = 4, 4, 9, spacing = 0.25, grading = 3.0 /
&layer material = 'soil', top = 0.0 /
&layer material = 'rock', top = 1.0 /
&load kind = 'moment-tensor', centre = 2, 2, 7, moment = 1, 1, 1, 0, 0, 0, history = 'gaussian', width = 1.2, delay = 6 /
&receiver name = 'r', position = 2, 2, 4.6 /
&output plots = .false. /
END
deck=graded.nml
told "a receiver near a source between coarse points" "receiver 'r' is 2.4 from load 1, .* nearer than 6 spacings ([34].[0-9]*)"
untold "the same on an even lattice" body%grading=1
untold "a receiver farther off" receiver%position=2,2,2.5
tilted='layer(2)%dip=1 body%grading=1 receiver%position=2,2,3.5'
told "a moment tensor beside a tilted interface" "load 1 is a moment tensor about 1.[67] spacings from where the rock changes: .* body%spacing = 0.1[34][0-9]* " $tilted load%centre=2,2,1.44
untold "one beside a level interface" body%grading=1 load%centre=2,2,1.4 receiver%position=2,2,3.5 'material(1)%s_speed=0.8'
told "one beside a level interface of strong contrast" "1.[67] spacings .* a twentieth .* 'layered'" body%grading=1 load%centre=2,2,1.4 receiver%position=2,2,3.5
untold "a moment tensor farther off" $tilted load%centre=2,2,1.9
untold "a force beside an interface" $tilted load%centre=2,2,1.4 load%kind=body-force load%shape=point load%direction=0,0,1 load%moment=
awk 'BEGIN { for (x = -5; x <= 5; x += .25) { print x, .3 * x >"tilted.txt"; print x, .4 * exp(-x * x) >"basin.txt" } }'
cat >file.nml <<'END'
&scene dimension = 2, end_time = 12 /
&material name = 'soil', density = 1.0, p_speed = 1.8, s_speed = 1.0 /
&material name = 'rock', density = 1.3, p_speed = 3.0, s_speed = 1.8 /
&body low = -4, 0, high = 4, 4, spacing = 0.2 /
&boundary face = 'x-', 'x+', 'y+', kind = 'transmitting' /
&layer material = 'soil', top = 0 /
&layer material = 'rock', top = 1.5, file = 'tilted.txt' /
&load kind = 'body-force', shape = 'point', centre = 0, 0.8, direction = .3, 1, history = 'gaussian', width = 0.6, delay = 3 /
&receiver name = 'a', position = -1.5, 0 /
&output plots = .false. /
END
deck=file.nml
told "layers of a file that are tilted where the box ends" "tilted layers send waves back from beyond the box"
untold "those of a basin within it" 'layer(2)%file=basin.txt'
told "a dip of a third of a degree" "tilted layers send waves back" 'layer(2)%file=' 'layer(2)%dip=.3'
deck=graded.nml
sed -i '/^&method/d' graded.nml
told "a grading of level layers" "body%grading brings the general operator" receiver%position=2,2,2.5
deck=
"$selas" -q good.nml receiver%position=3.9,2 output%directory=out
if grep -q "^warning: receiver 'r'" out/report.txt; then
    echo "ok - the report tells too"
else
    echo "not ok - the report tells too"
    failures=$((failures + 1))
fi
# --- Words without effect ---
cat >idle.nml <<'END'
&scene dimension = 2, end_time = 6 /
&material name = 'rock', density = 1.0, lambda = 1.0, mu = 1.0 /
&body material = 'rock', low = 0, 0, high = 4, 4, spacing = 0.25 /
&load face = 'y-', shape = 'square', centre = 2, 0, size = 1, direction = 0, 1, history = 'gaussian', width = 1, delay = 5 /
&receiver name = 'r', position = 2, 1 /
&output plots = .false. /
END
deck=idle.nml
lattice="body%jitter has no effect here: the splines of variant 'consistent' have an even lattice"
told "jitter of splines" "$lattice" body%jitter=.2 method%variant=consistent
told "a seed without jitter" "body%seed has no effect here" body%seed=3
told "mechanisms of undamped ground" "method%mechanisms has no effect here: nothing is damped" method%mechanisms=4
untold "as many as there are" method%mechanisms=3
untold "mechanisms of damped ground" method%mechanisms=6 'material(1)%q_p=50' 'material(1)%q_s=30' 'layer%material=rock' layer%top=2
told "a balance of what is not damped" "output%balance has no effect here" output%balance=T
untold "none of it" output%balance=F
told "small waves left out beside the exact mass" "method%quiet has no effect here" method%quiet=1e-9 method%mass=exact
untold "all that moves taken there" method%quiet=0 method%mass=exact
told "the mass over depth of layers" "method%depth_mass has no effect here" method%depth_mass=same layer%material=rock layer%top=2
told "the strike of a level layer" "layer%strike has no effect here: the layer is level" layer%strike=90 layer%material=rock layer%top=2 method%mass=vc3 method%degree=2
told "a rule of another scheme" "stepping%rule has no effect here: the stages of this scheme are fixed" stepping%rule=paper
sed "s/centre = 2, 0, size = 1, direction = 0, 1/direction = 1/; s/y-/x-/; s/dimension = 2/dimension = 1/; s/low.*high = 4, 4/low = 0, high = 4/; s/2, 1 /2 /" idle.nml >line.nml
deck=line.nml
told "a patch along one dimension" "load%shape has no effect here"
sed "s/shape = 'square', //" line.nml >bar.nml
deck=bar.nml
untold "a bar"
told "slip along it" "boundary%slip has no effect here" boundary%face=x+ boundary%kind=displacement boundary%direction=1 boundary%history=gaussian boundary%width=1 boundary%delay=5 boundary%slip=T
sph="method%name=sph method%variant=updated-lagrangian body%spacing=.05"
told "stages by a rule for a step that nobody gives" "stepping%rule has no effect here: it chooses stages for" $sph stepping%rule=paper
untold "for one that is given" $sph stepping%rule=paper stepping%time_step=.005
told "turns along a line" "method%jaumann has no effect here" $sph method%jaumann=F
told "a kernel beside central differences" "method%kernel has no effect here" method%name=sph method%gradient=central method%kernel=quintic
untold "of its viscosity" method%name=sph method%gradient=central method%kernel=quintic method%viscosity_alpha=.1
moved="boundary%face=x+ boundary%kind=displacement boundary%direction=1 boundary%history=gaussian boundary%width=1 boundary%delay=5 load%amplitude=0"
told "a receiver far from a face that moves" "no wave comes as far as receiver 'r'" $moved body%high=100
untold "one that its wave comes to" $moved
exit $failures
