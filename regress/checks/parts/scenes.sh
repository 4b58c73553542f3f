# Small scenes for restarts: every method, schemes of each kind, boundaries with memory. Sourced by
# regress/checks/restart.sh and regress/hardening/kills. scene NAME writes NAME.nml; the names are in $scenes.
scenes='layers damped damped-particles relaxing relaxing-single pass sweep sweep-layers sweep-single sweep-damped single modified paper plate bar flying moving'
rock="&material name = 'rock', density = 1.0, lambda = 1.0, mu = 1.0 /"
steel="&material name = 'steel', density = 7800.0, young = 2e11, poisson = 0.3 /"
marks="&snapshot every = 0.4, fields = 'velocity', 'stress' /
&output plots = .false. /"
# looked at in boxes with steps of .25 and .5
watched="&receiver name = 'r1', position = 2, 1.5, 0 /
&receiver name = 'r2', position = 1.2, 1.1, 0.7 /
&profile name = 'depth', from = 1.5, 1.5, 0, to = 1.5, 1.5, 2, points = 7, times = 1.03, 2.51, 3.9, fields = 'velocity', 'stress' /
$marks"

# steps in one pass beside layers, but for the rock
fine="&scene dimension = 3, end_time = 4.0 /
&body material = 'rock', shape = 'box', low = 0, 0, 0, high = 3.5, 3.5, 3, spacing = 0.25 /
&boundary face = 'x-', 'x+', 'y-', 'y+', 'z+', kind = 'transmitting', layer = 'pml', layer_points = 4, always = .true. /
&load face = 'z-', shape = 'square', centre = 1.3, 1.5, depth = 0.0, size = 1, 1, direction = 0, 0, 1
  history = 'ricker', frequency = 0.4, delay = 2.5 /
$watched"

# ground of the general operator, below a hill
tilted="&material name = 'soil', density = 0.8, lambda = 0.6, mu = 0.4 /
&layer material = 'soil', top = 0 /
&layer material = 'rock', top = 1.3, dip = 12, strike = 30 /
&topography shape = 'gaussian', height = 0.5, centre = 1.5, 1.7, width = 0.9 /"

# closed boxes
closed="&scene dimension = 3, end_time = 4.0 /
&body material = 'rock', shape = 'box', low = 0, 0, 0, high = 3.5, 3.5, 9, spacing = 0.25 /
&boundary face = 'x-', kind = 'fixed' /
&boundary face = 'z+', kind = 'roller' /
&load face = 'z-', shape = 'square', centre = 1.3, 1.5, depth = 0.0, size = 1, 1, direction = 0, 0.3, 1
  history = 'ricker', frequency = 0.4, delay = 2.5 /
$watched"

scene() {
    case $1 in
    layers) cat <<END ;; # C-PML, histories un-warped at the end
&scene dimension = 3, end_time = 4.0 /
$rock
&body material = 'rock', shape = 'box', low = 0, 0, 0, high = 3, 3, 2, spacing = 0.5 /
&boundary face = 'x-', 'x+', 'y-', 'y+', 'z+', kind = 'transmitting', layer = 'pml', layer_points = 4, always = .true. /
&load face = 'z-', shape = 'square', centre = 1.5, 1.5, 0, size = 1, 1, direction = 0, 0, 1
  history = 'ricker', frequency = 0.4, delay = 2.5 /
$watched
END
    damped) cat <<END ;; # relaxation mechanisms of three operators, C-PML beside them
&scene dimension = 3, end_time = 4.0 /
&method mechanisms = 2 /
&material name = 'rock', density = 1.0, lambda = 1.0, mu = 1.0, q_p = 30, q_s = 20 /
&material name = 'soil', density = 0.8, lambda = 0.6, mu = 0.4, q_p = 12, q_s = 9, q_frequency = 0.3, q_power = 0.2 /
&body material = 'rock', shape = 'box', low = 0, 0, 0, high = 3, 3, 2, spacing = 0.5 /
&layer material = 'soil', top = 0 /
&layer material = 'rock', top = 0.7 /
&boundary face = 'x-', 'x+', 'y-', 'y+', 'z+', kind = 'transmitting', layer = 'pml', layer_points = 4, always = .true. /
&load face = 'z-', shape = 'square', centre = 1.5, 1.5, 0, size = 1, 1, direction = 0, 0, 1
  history = 'ricker', frequency = 0.4, delay = 2.5 /
$watched
END
    damped-particles) cat <<END ;; # particles with relaxation mechanisms of two operators, dampers
&scene dimension = 2, end_time = 4.0 /
&method name = 'sph', variant = 'total-lagrangian', law = 'linear', mechanisms = 2 /
&material name = 'rock', density = 1.0, lambda = 1.0, mu = 1.0, q_p = 30, q_s = 20 /
&body material = 'rock', low = 0, 0, high = 3, 2, spacing = 0.25, jitter = 0.1 /
&boundary face = 'x+', kind = 'transmitting' /
&load face = 'x-', shape = 'face', direction = 1, 0.3, history = 'ricker', frequency = 0.4, delay = 2.5 /
&receiver name = 'r1', position = 2, 1.5 /
$marks
END
    relaxing) cat <<END ;; # relaxation mechanisms of two operators in steps in one pass, with layers
&material name = 'rock', density = 1.0, lambda = 1.0, mu = 1.0, q_p = 30, q_s = 20 /
$fine
END
    relaxing-single) cat <<END ;; # the same in single precision
&method precision = 'single' /
&material name = 'rock', density = 1.0, lambda = 1.0, mu = 1.0, q_p = 30, q_s = 20 /
$fine
END
    single) cat <<END ;; # steps in one pass in single precision, with layers
&method precision = 'single' /
$rock
$fine
END
    pass) cat <<END ;; # steps in one pass, planes at rest
$rock
$closed
END
    sweep) cat <<END ;; # the same of the general operator, below a hill
$rock
$tilted
$closed
END
    sweep-layers) cat <<END ;; # with layers
$rock
$fine
$tilted
END
    sweep-single) cat <<END ;; # with layers in single precision
&method precision = 'single' /
$rock
$fine
$tilted
END
    sweep-damped) cat <<END ;; # relaxation mechanisms of three operators, with layers
&method mechanisms = 2 /
&material name = 'rock', density = 1.0, lambda = 1.0, mu = 1.0, q_p = 30, q_s = 20 /
$fine
${tilted%%mu = 0.4*}mu = 0.4, q_p = 12, q_s = 9, q_frequency = 0.3, q_power = 0.2${tilted#*mu = 0.4}
END
    modified) cat <<END ;; # fourth order in time, dampers
&scene dimension = 2, end_time = 4.0 /
&stepping scheme = 'modified-equation', safety = 0.3 /
$rock
&body material = 'rock', shape = 'box', low = 0, 0, high = 6, 4, spacing = 0.25 /
&boundary face = 'x-', 'x+', 'y+', kind = 'transmitting', layer = 'lysmer' /
&load face = 'y-', shape = 'square', centre = 3, 0, size = 1, direction = 1, 1, history = 'gaussian', width = 0.3, delay = 1.2 /
&receiver name = 'r1', position = 4, 0 /
&profile name = 'line', from = 0, 1, to = 6, 1, points = 9, times = 1.5, 3.3, fields = 'acceleration' /
$marks
END
    paper) cat <<END ;; # as published, with its filter
&scene dimension = 3, end_time = 4.0 /
&method variant = 'paper', filter = 0.1 /
&stepping time_step = 0.05 /
$rock
&body material = 'rock', shape = 'box', low = 0, 0, 0, high = 3, 3, 3, spacing = 0.5 /
&boundary face = 'x-', 'x+', 'y-', 'y+', 'z+', kind = 'transmitting' /
&load face = 'z-', shape = 'square', centre = 1.5, 1.5, 0, size = 1, 1, direction = 0, 0, 1, history = 'triangle', duration = 2 /
&receiver name = 'r1', position = 2, 1.5, 0 /
&profile name = 'line', from = 0, 1, 0, to = 3, 1, 0, points = 9, times = 1.5, 3.3, fields = 'displacement' /
$marks
END
    plate) cat <<END ;; # total Lagrangian, Runge-Kutta, mirror planes, a face that is moved
&scene dimension = 2, plane = 'stress', end_time = 4.0 /
&method name = 'sph', variant = 'total-lagrangian', gradient = 'quadratic' /
&stepping scheme = 'rk4', safety = 0.6 /
$rock
&body material = 'rock', shape = 'plate-with-hole', low = 0, 0, high = 2, 2, spacing = 0.125
  hole_centre = 0, 0, hole_radius = 0.6, arrangement = 'conformal' /
&boundary face = 'x-', 'y-', kind = 'symmetry' /
&boundary face = 'y+', kind = 'displacement', slip = .true., direction = 0, 1, amplitude = 1e-3, history = 'step', smoothing = 1 /
&receiver name = 'r1', position = 1, 2 /
&profile name = 'line', from = 0.6, 0, to = 2, 0, points = 9, times = 1.5, 3.3, fields = 'stress' /
$marks
END
    bar) cat <<END ;; # updated Lagrangian, stabilised stages, viscosity, an exact solution
&scene dimension = 1, plane = 'stress', end_time = 0.2e-3 /
&method name = 'sph', variant = 'updated-lagrangian', artificial_stress = 0.0 /
&stepping scheme = 'rkc', safety = 0.5 /
$steel
&body material = 'steel', shape = 'box', low = 0, high = 1, spacing = .01 /
&boundary face = 'x+', kind = 'fixed' /
&load face = 'x-', shape = 'face', direction = 1, amplitude = 1e7, history = 'step' /
&receiver name = 'r1', position = .5 /
&profile name = 'along', from = .01, to = .99, points = 21, times = .1e-3, .2e-3, fields = 'velocity', 'stress' /
&reference kind = 'bar' /
&snapshot every = 2e-5, fields = 'velocity', 'stress' /
&output plots = .false. /
END
    flying) cat <<END ;; # updated Lagrangian on the move: new neighbours, artificial stress, turning stress
&scene dimension = 2, plane = 'strain', end_time = 1.0 /
&method name = 'sph', variant = 'updated-lagrangian', viscosity_alpha = 1.0, viscosity_beta = 1.0 /
&stepping scheme = 'pc2', courant = 0.2 /
$rock
&body material = 'rock', shape = 'box', low = 0, 0, high = 4.2, 3, spacing = 0.1 /
&initial kind = 'gaussian', centre = 1, 1, width = 0.6, amplitude = 0.3, direction = 1, 0.5 /
&receiver name = 'r1', position = 1.2, 1.1 /
&profile name = 'line', from = 0, 1, to = 4, 1, points = 9, times = 0.5, 0.9, fields = 'pressure' /
&snapshot every = 0.1, fields = 'velocity', 'stress' /
&output plots = .false. /
END
    moving) cat <<END ;; # a patch on the move, half of the body, no transform
&scene dimension = 3, end_time = 4.0 /
&stepping scheme = 'leapfrog', safety = 0.4 /
$rock
&body material = 'rock', shape = 'box', low = -2, -1.5, 0, high = 2, 1.5, 1.5, spacing = 0.5 /
&boundary face = 'x-', 'x+', 'y-', 'y+', 'z+', kind = 'transmitting', layer = 'lysmer' /
&load face = 'z-', shape = 'square', centre = -1, 0, 0, size = 1, 1, velocity = 0.5, 0, 0
  direction = 0, 0, 1, history = 'gaussian', width = 0.4, delay = 2.4 /
&receiver name = 'r1', position = 0, -1, 0 /
&profile name = 'line', from = -2, 0, 0, to = 2, 0, 0, points = 9, times = 1.5, 3.3, fields = 'velocity' /
$marks
END
    esac >"$1.nml"
}

# same A B: true if two folders of results have the same bits: histories, profiles, snapshots, figures of the report.
same() {
    for one in "$1"/*.dat; do cmp "$one" "$2/$(basename "$one")" || return 1; done
    [ "$(ls "$1")" = "$(ls "$2")" ] || { echo "other files: $(ls "$2")"; return 1; }
    h5diff --exclude-path /provenance --exclude-path /settings "$1/run.h5" "$2/run.h5" || return 1
    for folder in "$1" "$2"; do
        grep -E '^(points|steps|time|energy|work|error|operator calls|order|stages|judged)' "$folder/report.txt" >"$folder.figures"
    done
    diff "$1.figures" "$2.figures"
}
