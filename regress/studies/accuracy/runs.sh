# What regress/studies/accuracy/run measures: runs_SCENE for each scene; each method at four resolutions or more.

# Quarter of a half-space under a unit patch, 0 <= t <= 6, receivers at 0, 1 and 2: the program's own box with layers.
half_space() { # half_space HISTORY
    cat >"$out/half-space.nml" <<DECK
&scene dimension = 3, end_time = 6 /
&material name = 'rock', density = 1, lambda = 1, mu = 1 /
&body material = 'rock', shape = 'half-space', spacing = .2 /
&load face = 'z-', shape = 'square', centre = 0, 0, 0, size = 1, 1, direction = 0, 0, 1, $1 /
&receiver name = 'r0', position = 0, 0, 0 / &receiver name = 'r1', position = 1, 0, 0 / &receiver name = 'r2', position = 2, 0, 0 /
&reference kind = 'lamb' /
DECK
    # the same in a box so large that nothing comes back
    sed "s|shape = 'half-space'|low = 0, 0, 0, high = 6.6, 5.4, 5.4|" "$out/half-space.nml" >"$out/box.nml"
    echo "&boundary face = 'x-', 'y-', kind = 'symmetry' /" >>"$out/box.nml"
}
half_space_runs() { # half_space_runs SCENE
    scene_name=$1
    series() { # series METHOD SPACINGS OVERRIDES... on the program's box; big_series on the large one
        method_name=$1
        spacings=$2
        shift 2
        for h in $spacings; do measure "$scene_name" "$method_name" vector "$deck" "body%spacing=$h" "$@"; done
    }
    deck=$out/half-space.nml
    series default "$(some '.25 .2 .1666666666666667 .125 .1' '.25 .1666666666666667')"
    check_falls "$scene_name" default
    [ "$quick" = quick ] && return
    series vc2 '.25 .1666666666666667 .125 .1' method%mass=vc2
    series layer-12 '.1666666666666667 .125 .1 .0714285714285714' boundary%face=x-,x+,y-,y+,z+ boundary%kind=transmitting boundary%layer=pml boundary%layer_points=12
    series vc1 '.25 .1666666666666667 .125 .1' method%mass=vc1
    series degree1 '.25 .1666666666666667 .125 .1' method%degree=1
    series degree3 '.25 .1666666666666667 .125 .1' method%degree=3
    series mapped '.25 .1666666666666667 .125 .1' method%ends=mapped
    series no-transform '.25 .1666666666666667 .125 .1' stepping%unwarp=F
    series depth-mass-same '.25 .1666666666666667 .125 .1' method%depth_mass=same
    series dissipation '.25 .1666666666666667 .125 .1' method%dissipation=.05
    series low-pass '.25 .1666666666666667 .125 .1' output%low_pass=18
    series lysmer '.25 .1666666666666667 .125 .1' boundary%face=x-,x+,y-,y+,z+ boundary%kind=transmitting boundary%layer=lysmer
    deck=$out/box.nml
    series large-box '.6 .3 .2 .15'
    series exact-mass '.6 .3 .2 .15' method%mass=exact
    series degree3-exact-o4 '.6 .3 .2 .15' method%degree=3 method%mass=exact stepping%scheme=modified-equation
    [ "$scene_name" = gaussian ] && return # particles and the published form on the other two pulses
    series sph-quadratic '.6 .4 .3 .24' method%name=sph method%gradient=quadratic method%law=linear method%hourglass=2
    series sph-linear '.6 .4 .3 .24' method%name=sph method%gradient=linear method%law=linear method%hourglass=2
    series published '.6 .3 .2 .15' method%variant=paper
}
runs_smooth() {
    half_space "history = 'triangle', duration = 2, smoothing = 1"
    half_space_runs smooth
}
runs_kinked() {
    half_space "history = 'triangle', duration = 2"
    half_space_runs kinked
}
runs_gaussian() {
    half_space "history = 'gaussian', width = .3, delay = 2"
    half_space_runs gaussian
}

# A P pulse in a bar, reflected at a free end.
runs_wave() {
    series() {
        method_name=$1
        shift
        for h in $(some '.1 .05 .025 .0125 .00625' '.05 .025'); do measure wave "$method_name" vector input/plane-wave.nml "body%spacing=$h" "$@"; done
    }
    o2=stepping%scheme=leapfrog
    series degree3-exact-o4
    check_falls wave degree3-exact-o4
    [ "$quick" = quick ] && return
    series degree3-exact-leapfrog $o2
    series degree2-vc3-leapfrog method%degree=2 method%mass=vc3 $o2
    series degree2-vc3-o4 method%degree=2 method%mass=vc3
    series degree2-exact-o4 method%degree=2
    series degree1-exact-leapfrog method%degree=1 $o2
    series degree4-exact-o4 method%degree=4
    series mapped-degree3-o4 method%ends=mapped
    series degree3-exact-rk4 stepping%scheme=rk4
    sed "s/'consistent', degree = 3, mass = 'exact'/'paper', row_sums = 'zero', filter = 0/" input/plane-wave.nml >"$out/wave-paper.nml"
    for h in .1 .05 .025 .0125 .00625; do measure wave published-zero-sums vector "$out/wave-paper.nml" "body%spacing=$h" $o2; done
    sed "s/'smoothed-point'.*/'sph', viscosity_alpha = 0, law = 'linear' \//" input/plane-wave.nml >"$out/wave-sph.nml"
    for gradient in quadratic linear; do
        for h in .05 .025 .0125 .00625; do
            measure wave "sph-$gradient" vector "$out/wave-sph.nml" "body%spacing=$h" $o2 method%gradient=$gradient
        done
    done
}

# The bar that is hit on its end: a shock, so that everything is of first order at most.
runs_bar() {
    series() {
        method_name=$1
        shift
        for h in $(some '.016 .008 .004 .002' '.008 .004'); do measure bar "$method_name" vector input/bar.nml "body%spacing=$h" "$@"; done
    }
    series rkc-2.5
    check_falls bar rkc-2.5
    [ "$quick" = quick ] && return
    series rk4-2.5 stepping%scheme=rk4
    series rkc-.5 method%viscosity_alpha=.5 method%viscosity_beta=.5
    series rk4-.5 method%viscosity_alpha=.5 method%viscosity_beta=.5 stepping%scheme=rk4
    series lsrk54-.5 method%viscosity_alpha=.5 method%viscosity_beta=.5 stepping%scheme=lsrk54
    series rk4-1 method%viscosity_alpha=1 method%viscosity_beta=1 stepping%scheme=rk4
    total="method%variant=total-lagrangian stepping%scheme=leapfrog"
    for alpha in .25 .5 1; do
        # shellcheck disable=SC2086 # several words
        series total-leapfrog-$alpha $total method%viscosity_alpha=$alpha method%viscosity_beta=$alpha
    done
    sed "/viscosity/d; /artificial/d; s/name = 'sph'.*/name = 'smoothed-point'/; s/'rkc'/'leapfrog'/" input/bar.nml >"$out/bar-spline.nml"
    for h in .02 .01 .004 .002; do measure bar consistent vector "$out/bar-spline.nml" "body%spacing=$h"; done
    for h in .02 .01 .004 .002; do measure bar consistent-dissipation vector "$out/bar-spline.nml" "body%spacing=$h" method%dissipation=.1; done
}

# The clamped beam: its frequency against two-dimensional elasticity.
frequency() { awk -F': ' '/^frequency at tip/ { f = $2 + 0 } END { e = f / 2008.3 - 1; print f ? (e < 0 ? -e : e) : "-" }' "$out/run/report.txt"; }
runs_beam() {
    series() {
        method_name=$1
        spacings=$2
        shift 2
        for h in $spacings; do
            measure beam "$method_name" frequency "$deck" "body%spacing=$h" snapshot%every=1 scene%end_time=.0066 initial%amplitude=.001 "$@"
        done
    }
    deck=input/beam.nml
    series quadratic "$(some '.025 .02 .0125 .01' '.025 .02')"
    check_falls beam quadratic
    [ "$quick" = quick ] && return
    series linear '.025 .02 .0125 .01' method%gradient=linear
    series quadratic-bare '.025 .02 .0125 .01' method%hourglass=0
    series quadratic-rk4 '.025 .02 .0125 .01' stepping%scheme=rk4
    awk '/^&method/ { out = 1 } !out { print } /^\// { out = 0 }' input/beam.nml >"$out/beam-spline.nml"
    deck=$out/beam-spline.nml
    series degree2-vc3 '.05 .025 .0125 .01' # without a transform: the beam is not at rest at the start
    series degree1-vc3 '.05 .025 .0125 .01' method%degree=1
    series degree2-exact-o4 '.05 .025 .0125 .01' method%mass=exact stepping%scheme=modified-equation
    series degree3-exact-o4 '.05 .025 .0125 .01' method%degree=3 method%mass=exact stepping%scheme=modified-equation
    sed "/gradient =/d; /hourglass/d; s/'total-lagrangian'.*/'updated-lagrangian'/" input/beam.nml >"$out/beam-updated.nml"
    for h in .05 .025 .02 .0125; do
        measure beam updated-rkc frequency "$out/beam-updated.nml" "body%spacing=$h" snapshot%every=1 scene%end_time=.0066 initial%amplitude=.001
    done
    for h in .05 .025 .02 .0125; do
        measure beam updated-rk4 frequency "$out/beam-updated.nml" "body%spacing=$h" snapshot%every=1 scene%end_time=.0066 initial%amplitude=.001 stepping%scheme=rk4
    done
}

# The plate with a hole, settled: L1 of the stress along the ligament against the finite plate.
ligament() { # ligament [CURVE]
    awk -v curve="regress/reference/hole/${1:-R0.3_disp}.csv" '
        BEGIN { while ((getline line < curve) > 0) if (line !~ /^#/) { split(line, f, ","); x[++n] = f[1]; s[n] = f[2] } }
        /^#/ || NF < 9 { next }
        { at[++rows] = $2; stress[rows] = $9 }
        END {
            for (i = 1; i < rows; i++) mean += (stress[i] + stress[i + 1]) / 2 * (at[i + 1] - at[i]) / at[rows]
            for (i = 1; i <= rows; i++) {
                k = 1
                while (k + 1 < n && x[k + 1] < at[i]) k++
                e = s[k] + (s[k + 1] - s[k]) * (at[i] - x[k]) / (x[k + 1] - x[k]); d = stress[i] / mean - e
                sum += d < 0 ? -d : d; all += e
            }
            print sum / all }' "$out/run/ligament.dat"
}
runs_plate() {
    for arrangement in conformal equally-radial radial lattice; do
        for h in .08 .057 .0425 .0304 .0215; do
            measure plate "$arrangement" ligament input/plate.nml "body%spacing=$h" body%arrangement=$arrangement
        done
    done
    for h in .08 .057 .0425 .0304 .0215; do measure plate conformal-linear ligament input/plate.nml "body%spacing=$h" method%gradient=linear; done
}
