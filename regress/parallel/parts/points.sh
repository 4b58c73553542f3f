# shellcheck shell=sh disable=SC2086,SC2154
# Total-Lagrangian points, particles that move.
same "1 3 7" "points" $points
as_planned "a rank sends the bytes a step that the plan of points tells" ranks

# The plan's efficiency by Eq (R3b) of doc/developers/ranks.md, of rows of 16 points free on all sides, in two halves of equal
# rows: neighbours within 3 spacings of own points and of those of the 3 rows besides whose gradients are made
cat >"$work/rows.nml" <<'EOF'
&scene dimension = 2, end_time = 1 /
&method name = 'sph', variant = 'total-lagrangian', gradient = 'linear' /
&material name = 'rock', density = 1, lambda = 1, mu = 1 /
&body material = 'rock', low = 0, 0, high = 4, 10, spacing = .25 /
&initial kind = 'gaussian', amplitude = .01, width = 1, centre = 1, 2, direction = .3, 1 /
&receiver name = 'r', position = 2, 7 /
EOF
timeout 60 $mpirun -n 2 "$build/selas-mpi" check "$work/rows.nml" >"$work/plan" 2>"$work/log"
awk 'function near(rows, i, j, a, b, sum) {
        for (j = 0; j < rows; j++) for (i = 0; i < 16; i++) for (b = -2; b <= 2; b++) for (a = -2; a <= 2; a++)
            sum += (a != 0 || b != 0) && i + a >= 0 && i + a < 16 && j + b >= 0 && j + b < n
        return sum
    }
    /^ranks: 2, points/ { own = $NF / 16; equal = $(NF - 1) == $NF; n = 2 * own } /^neighbours a point/ { mean = $NF }
    /^halo bytes a step/ { sent = $(5) } /^efficiency expected/ { told = $3 } END {
        d = near(n) / (16 * n) - mean; if (!equal || d * d > .051 ^ 2) exit 1
        e = 1.2 * near(n) / 2 / (.6 * (near(own) + near(own + 3)) + sent / 2 + 2000)
        d = told - e; exit !(told > 0 && told < 1 && d * d < .00505 ^ 2) }' "$work/plan"
verdict $? "the plan of points on ranks tells the efficiency of the model of cost"
same 7 "points in many planes, central differences" $points body%high=2,1.5,24 profile%to=1,.75,24 method%gradient=central
same 3 "scattered points" $points body%jitter=.15
same 3 "points, a moved face and viscosity" $points method%viscosity_alpha=.5 "boundary(1)%kind=displacement" "boundary(1)%direction=.2,0,1" "boundary(1)%history=gaussian" "boundary(1)%width=.4" "boundary(1)%delay=.6" "boundary(1)%amplitude=.05"
same 3 "damped points" $points method%law=linear material%q_p=40 material%q_s=25
as_planned "and with damped points" ranks
same "2 7" "points in layers" $column
same 3 "points in layers with viscosity, linear gradients" $column method%viscosity_alpha=.5 method%gradient=linear
same 7 "scattered points in layers" $column body%jitter=.15
same "2 7" "points along the first axis" $long
as_planned "a rank sends the bytes a step that the plan of points of all ranks tells" ranks
along=$sent
quiet 7 $points output%plots=F output%directory="$work/upright"
[ "$along" -lt "$(sed -n 's/^halo bytes sent in the last step: //p' "$work/upright/report.txt")" ]
verdict $? "a beam along the first axis sends no more than one along the last, in planes: $along"
same 3 "scattered points along the first axis" $long body%jitter=.15
same 4 "points along the first axis, central differences, linear law" $long method%gradient=central method%law=linear
same 3 "damped points along the first axis" $long method%law=linear "material(1)%q_p=40" "material(1)%q_s=25" "material(2)%q_p=30" "material(2)%q_s=20"
as_planned "and with damped points of all ranks" ranks
memory() { # memory KB WORDS...: one process has no memory for what 4 ranks run
    [ -z "${SELAS_SANITIZED:-}" ] || return # the shadow of sanitizers is larger than any limit
    limit=$1
    shift
    (ulimit -v "$limit" && OMP_NUM_THREADS=1 "$build/selas" -q "$@" output%plots=F output%directory="$work/alone") >"$work/log" 2>&1
    [ $? = 1 ] && grep -q '^error: no memory' "$work/log" &&
        (ulimit -v "$limit" && OMP_NUM_THREADS=1 && export OMP_NUM_THREADS && quiet 4 "$@" output%plots=F output%directory="$work/ranks")
    verdict $? "4 ranks have memory for points that one process has none for"
}
memory 400000 regress/parallel/tall-sph.nml body%high=2,1.5,720 "boundary(3)%kind=symmetry" "boundary(3)%layer=" scene%end_time=.5 stepping%time_step=.1 profile%times=.4 "snapshot(1)%every=.4" "snapshot(2)%times=.4"
same "2 4" "points of a file" regress/cases/cloud/deck.nml
drawn() { # drawn N WORDS...: points of a file, into $work/drawn.txt
    size=$1 && shift
    LC_ALL=C awk -v n="$size" "$@" -f regress/parallel/points.awk >"$work/drawn.txt"
}
flat="regress/parallel/file-plane.nml body%file=$work/drawn.txt" bar="regress/parallel/file-sph.nml body%file=$work/drawn.txt"
drawn "10 80" -v jitter=.15
same "2 7" "points of a file in layers" $flat
as_planned "and with points of a file" ranks
drawn "10 80" -v normals=1
same 4 "points of a lattice in a file, with normals" $flat "boundary(2)%kind=symmetry" "boundary(2)%layer="
drawn "10 80" -v graded=1
same 3 "graded points of a file, linear gradients, viscosity" $flat method%gradient=linear method%viscosity_alpha=.5
drawn "52 7 6" -v jitter=.1
same 3 "points of a file along the first axis" $bar
same 2 "damped points of a file along the first axis" $bar method%law=linear material%q_p=40 material%q_s=25
drawn "10 80" -v gap=1 -v normals=1
same 3 "two bodies of points of a lattice in a file" $flat profile%from=1,9
drawn "6 6 600" -v jitter=.1
one_line "points of a file outside their box" "drawn.txt:2: point 2 lies outside the box" 3 $bar
memory 400000 $bar body%high=1.5,1.5,150 method%smoothing_length=2 "boundary(1)%face=z+" "boundary(2)%face=y-" "load(1)%face=z-" "load(2)%centre=.6,.7,70" "receiver(1)%position=.3,1.3,.1" "receiver(2)%position=.6,1,80" "receiver(3)%position=.8,.6,120" profile%from=.7,.7,1 profile%to=.7,.7,149 scene%end_time=.15 stepping%time_step=.05 profile%times=.1 "snapshot(1)%every=.1" "snapshot(2)%times=.1" "snapshot(2)%region=0,0,20,1,1,100"
same 3 "points about a hole in a plane" input/plate.nml body%spacing=.05 scene%end_time=.001 snapshot%times=.001 "profile(1)%times=.001" "profile(2)%times=.001"
same 2 "points of a beam in its mode, four stages of Runge and Kutta" input/beam.nml scene%end_time=.001 stepping%scheme=rk4
same "2 7" "particles that move" $moving
as_planned "a rank sends the bytes a step that the plan of particles tells" ranks
# by Eq (R9b): neighbours of own particles; own ones and as many others as the first rank sends; the bytes told
timeout 60 $mpirun -n 2 "$build/selas-mpi" check regress/parallel/moving-particles.nml body%spacing=.05 >"$work/plan" 2>"$work/log"
awk '/^ranks: 2, particles/ { a = $(NF - 1); b = $NF } /^neighbours of a particle/ { near = $5 } /^halo bytes a step/ { sent = $5 }
    /^halo bytes a step/ { sub(/.*\(/, ""); met = $1 }
    /^efficiency expected/ { told = $3; sub(/;/, "", $5); balance = $5 } END {
        n = a + b; own = near * n / 2 / balance
        e = (18 * n + 4.5 * near * n) / 2 / (18 * ((a > b ? a : b) + met) + 4.5 * own + sent / 2 + 10000)
        d = told - e; exit !(met > 0 && told > 0 && told < 1 && d * d < .01 ^ 2) }' "$work/plan"
verdict $? "the plan of particles on ranks tells the efficiency of the model of cost"
same 3 "scattered particles that move, hourglass control, stages of Runge, Kutta and Chebyshev" $moving body%jitter=.1 method%kernel=wendland method%hourglass=.2 stepping%scheme=rkc
same "2 4" "particles that move in space" regress/parallel/solid-particles.nml
same 3 "scattered particles in space, hourglass control" regress/parallel/solid-particles.nml body%jitter=.1 method%hourglass=.2
# two blocks, 5 spacings apart, that are pressed together and meet; in the order of space and in none
awk 'BEGIN { for (k = 0; k < 72; k++) printf "%g %g .01\n", .05 + .1 * (k % 6) + (k < 36 ? 0 : 1.1), .05 + .1 * int(k % 36 / 6) }' >"$work/two.txt"
awk '{ printf "%d %s\n", NR * 31 % 73, $0 }' "$work/two.txt" | sort -n | cut -d ' ' -f 2- >"$work/mixed.txt"
cat >"$work/two.nml" <<'END'
&scene title = 'Blocks that meet', dimension = 2, end_time = 3.0 /
&method name = 'sph', variant = 'updated-lagrangian', hourglass = 0.2 /
&material name = 'rock', density = 1.0, lambda = 1.0, mu = 1.0 /
&body name = 'blocks', material = 'rock', shape = 'points', file = 'two.txt', low = 0.0, 0.0, high = 1.7, 0.6, spacing = 0.1 /
&load face = 'x-', shape = 'face', direction = 1.0, 0.0, amplitude = 0.3, history = 'gaussian', width = 0.3, delay = 1.2 /
&load face = 'x+', shape = 'face', direction = -1.0, 0.0, amplitude = 0.3, history = 'gaussian', width = 0.3, delay = 1.2 /
&receiver name = 'left', position = 0.6, 0.3 /
&receiver name = 'right', position = 1.1, 0.3 /
&snapshot every = 1.0, fields = 'displacement', 'velocity', 'stress' /
&output history_step = 0.1, plots = .false. /
END
MEET=1
same "2 3" "particles of two blocks that meet" "$work/two.nml"
same 3 "the same in a file of no order" "$work/two.nml" body%file=mixed.txt
unset MEET
deep='regress/parallel/solid-particles.nml body%high=.9,.8,6.4 load%centre=.3,.2,6.4 receiver(1)%position=.3,.2,6.4'
# shellcheck disable=SC2086
"$build/selas" check $deep >"$work/plan" 2>"$work/log" && timeout 60 $mpirun -n 4 "$build/selas-mpi" check $deep >"$work/log" 2>&1
awk -F ': ' '/^planned memory bytes/ { planned[++runs] = $2 } END { exit !(runs == 2 && planned[2] > 0 && planned[2] < .45 * planned[1]) }' "$work/plan" "$work/log"
verdict $? "4 ranks plan less than .45 of the memory of one process each for particles"
