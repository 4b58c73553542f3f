# The rows of regress/studies/stability/run (numerics C): decks and what is predicted of them.

# A small box of 5 x 5 x 5 points under a short pulse on a quarter of its upper face.
box_deck() { # box_deck END
    cat >"$out/box.nml" <<DECK
&scene dimension = 3, end_time = $1 /
&method name = 'smoothed-point' /
&material name = 'rock', density = 1, lambda = 1, mu = 1 /
&body material = 'rock', low = 0, 0, 0, high = 1, 1, 1, spacing = .25 /
&load face = 'z-', shape = 'square', centre = .5, .5, 0, size = .5, .5, direction = 0, 0, 1
  history = 'gaussian', width = .3, delay = 2 /
&receiver name = 'r', position = .5, .5, 0 /
DECK
}
# A quarter of a half-space in absorbing layers.
quarter_deck() { # quarter_deck END
    cat >"$out/quarter.nml" <<DECK
&scene dimension = 3, end_time = $1 /
&material name = 'rock', density = 1, lambda = 1, mu = 1 /
&body material = 'rock', low = 0, 0, 0, high = 1.5, 1.5, 1, spacing = .25 /
&boundary face = 'x-', 'y-', kind = 'symmetry' /
&boundary face = 'x+', 'y+', 'z+', kind = 'transmitting', layer = 'pml', layer_points = 8, always = .true. /
&load face = 'z-', shape = 'square', centre = 0, 0, 0, size = 1, 1, direction = 0, 0, 1
  history = 'gaussian', width = .3, delay = 2 /
&receiver name = 'r', position = 1, 0, 0 /
DECK
}
# A strip with absorbing layers at both ends and below, free above; `thin`: one cell of it between layers.
strip_deck() { # strip_deck END HEIGHT
    cat >"$out/strip.nml" <<DECK
&scene dimension = 2, end_time = $1 /
&material name = 'rock', density = 1, p_speed = 1.7320508, s_speed = 1 /
&body material = 'rock', low = 0, 0, high = 2, $2, spacing = .25 /
&boundary face = 'x-', 'x+', 'y+', kind = 'transmitting', layer = 'pml', layer_points = 8, always = .true. /
&load face = 'y-', shape = 'square', centre = 1, 0, size = 1, direction = 0, 1, history = 'gaussian', width = .3, delay = 2 /
&receiver name = 'r', position = 1, 0 /
DECK
}
# Soft layer on rock.
layer_deck() { # layer_deck END S_SPEED
    cat >"$out/layer.nml" <<DECK
&scene dimension = 3, end_time = $1 /
&material name = 'soil', density = 1, p_speed = $(awk "BEGIN { print 2 * $2 }"), s_speed = $2 /
&material name = 'rock', density = 1, p_speed = 1.7320508, s_speed = 1 /
&body name = 'ground', material = 'rock', low = 0, 0, 0, high = 1, 1, 1, spacing = .125 /
&layer material = 'soil', top = 0 / &layer material = 'rock', top = .5 /
&boundary face = 'x+', 'y+', 'z+', kind = 'transmitting', layer = 'lysmer' /
&boundary face = 'x-', 'y-', kind = 'symmetry' /
&load face = 'z-', shape = 'square', centre = 0, 0, 0, size = .5, .5, direction = 0, 0, 1
  history = 'gaussian', width = .3, delay = 2 /
&receiver name = 'r', position = .5, 0, 0 /
DECK
}
# Bars and needles of sph, hit on an end.
sph_deck() { # sph_deck END HIGH SPACING
    cat >"$out/sph.nml" <<DECK
&scene dimension = 2, plane = 'stress', end_time = $1 /
&method name = 'sph' /
&material name = 'rock', density = 1, young = 1, poisson = .3 /
&body material = 'rock', low = 0, 0, high = $2, spacing = $3 /
&load face = 'x-', shape = 'face', direction = 1, 0, amplitude = .001, history = 'triangle', duration = .5 /
&receiver name = 'r', position = .5, 0 /
DECK
}

# A cube of 5 x 5 x 5 particles, pushed on a whole face.
cube_deck() { # cube_deck END
    cat >"$out/cube.nml" <<DECK
&scene dimension = 3, end_time = $1 /
&method name = 'sph' /
&material name = 'rock', density = 1, lambda = 1, mu = 1 /
&body material = 'rock', low = 0, 0, 0, high = 1, 1, 1, spacing = .2 /
&load face = 'z-', shape = 'face', direction = 0, 0, 1, amplitude = .01, history = 'gaussian', width = .3, delay = 2 /
&receiver name = 'r', position = .5, .5, .5 /
DECK
}

growing() { # growing DECK OVERRIDES...: largest real part of the measured spectrum
    deck=$1
    shift
    "$build/test/stability-spectrum" "$deck" 0 "$@" 2>/dev/null | sort -g | awk 'END { printf "%.2g", $1 }'
}

cases() {
    bar=input/bar.nml
    for alpha in 2.5 .5; do
        steady=1061 # traction^2 / (rho c0) * t
        row "bar-default-$alpha" stable "bar, shock, alpha = $alpha, rkc of the program's choice" "" $bar method%viscosity_alpha=$alpha method%viscosity_beta=$alpha
    done
    waves="method%viscosity_alpha=0 method%viscosity_beta=0"
    # shellcheck disable=SC2086 # several words
    {
        row rkc-0 said "RKC at alpha = 0" "imaginary axis: limit 0 for every s" $bar $waves
        row rkc-0-forced said "RKC at alpha = 0, s = 5, CFL 2, forced" "imaginary axis: limit 0 for every s" $bar $waves \
            stepping%stages=5 stepping%time_step=1.6e-6 stepping%force=T
        steady=1061
        row rk4-0 stable "the same bar by rk4" "" $bar $waves stepping%scheme=rk4
    }
    row rkc-8 said "RKC, alpha = 2.5, s = 20, CFL 8" "limit 4.06" $bar stepping%stages=20 stepping%time_step=6.3e-6
    row rkc-8-forced said "the same, forced" "limit 4.06" $bar stepping%stages=20 stepping%time_step=6.3e-6 stepping%force=T
    steady=14300 # traction times (2 + 3 * 2 transits + ...) * traction / (rho c0)
    row shock-back stable "reflected shock (free end), t = 4 transits" "" $bar boundary%face=x+ boundary%kind=free scene%end_time=.8e-3 "profile%times=.12e-3"
    beam=input/beam.nml
    periods=$(late .0313 .0063)
    row beam-05 stable "beam, V_f = .05" "" $beam initial%amplitude=.05 "scene%end_time=$periods" snapshot%every=1 body%spacing=.02
    row beam-bare said "beam, V_f = .05, no hourglass control" "gradients that do not see some modes" $beam initial%amplitude=.05 method%hourglass=0 \
        "scene%end_time=$periods" snapshot%every=1 body%spacing=.02
    updated="method%variant=updated-lagrangian method%gradient=linear"
    row beam-ul said "beam, updated Lagrangian, V_f = .05, no artificial stress (clamp ghosts without the transpose)" "growing modes" "$here/beam-updated.nml" \
        initial%amplitude=.05 "scene%end_time=$periods"
    row tension said "long tension (updated Lagrangian, pulled at both ends)" "tension instability" "$here/tension.nml" method%variant=updated-lagrangian
    row tension-tl stable "long tension (total Lagrangian)" "" "$here/tension.nml"

    box_deck "$(late 1000 100)"
    row free stable "all faces free" "omega real" "$out/box.nml"
    for lambda in 9 49 499; do
        row "free-$lambda" stable "all faces free, nu = $(awk "BEGIN { print $lambda / 2 / ($lambda + 1) }"), step from c_p" "" "$out/box.nml" material%lambda=$lambda \
            "scene%end_time=$(late 1000 20)"
    done
    row corners stable "transmitting faces that meet at corners" "dampers take energy" "$out/box.nml" boundary%face=all boundary%kind=transmitting
    row edge stable "a load on an edge" "" "$out/box.nml" load%centre=0,.5,0
    row corner stable "a load on a corner" "" "$out/box.nml" load%centre=0,0,0
    cube_deck "$(late 500 20)"
    row jitter-5 stable "jitter 5 %, total Lagrangian, all faces free" "" "$out/cube.nml" body%jitter=.05
    row jitter-20 stable "jitter 20 %, total Lagrangian, all faces free" "" "$out/cube.nml" body%jitter=.2
    row jitter-bare said "jitter 20 %, no hourglass control" "" "$out/cube.nml" body%jitter=.2 method%hourglass=0
    printed=method%variant=paper
    row paper said "published smoothed points, all faces free, without filter" "spectrum: growth $(growing "$out/box.nml" $printed method%filter=0)" "$out/box.nml" $printed method%filter=0
    row paper-zero said "the same, zero row sums" "spectrum: growth $(growing "$out/box.nml" $printed method%filter=0 method%row_sums=zero)" "$out/box.nml" $printed method%filter=0 method%row_sums=zero
    row paper-short said "the same, as printed, to t = 7.6" "" "$out/box.nml" $printed method%filter=0 scene%end_time=7.6
    row paper-default said "published smoothed points with their own defaults" "" "$out/box.nml" $printed
    quarter_deck "$(late 1000 60)"
    row pml-25 stable "C-PML, quarter of a half-space, nu = .25, the quiet tail" "" "$out/quarter.nml"
    row pml-45 stable "C-PML, the same, nu = .45" "" "$out/quarter.nml" material%lambda=9 "scene%end_time=$(late 1000 30)"
    strip_deck "$(late 1000 100)" 1
    row pml-strip-49 stable "C-PML, a strip, nu = .49" "" "$out/strip.nml" material%p_speed=7.1414284
    strip_deck "$(late 1000 100)" .5
    row pml-thin stable "C-PML, a thin body, nu = .25" "" "$out/strip.nml"
    row pml-thin-45 stable "C-PML, a thin body, nu = .45" "" "$out/strip.nml" material%p_speed=3.3166248
    layer_deck "$(late 1000 20)" .2
    row layer-5 stable "soft layer, velocity ratio 5" "" "$out/layer.nml"
    layer_deck "$(late 1000 20)" .1
    row layer-10 stable "soft layer, velocity ratio 10" "" "$out/layer.nml"
    sph_deck "$(late 1000 50)" "1, .05" .05
    row needle said "needle, one cell across, total Lagrangian" "" "$out/sph.nml"
    row needle-smooth stable "needle, one cell across, smoothed points" "" "$out/sph.nml" method%name=smoothed-point
    sph_deck "$(late 1000 50)" "1, .15" .05
    row needle-3 stable "needle, three cells across, total Lagrangian" "" "$out/sph.nml"
}
