# shellcheck shell=sh disable=SC2086,SC2154
# General ground.
stepped="$hill stepping%time_step=.03"
same "1 3 4" "general ground, one pass" $hill
same 3 "general ground, passes one by one" $stepped method%fused=F
same 2 "general ground in single precision" $stepped method%precision=single body%high=4,4,16
same 4 "general operator, mirror planes" $shown method%operator=general body%high=4,4,18
same 3 "general ground, dampers" $stepped "boundary(1)%face=x-,y+,z+" "boundary(1)%kind=transmitting" "boundary(1)%layer=lysmer"
same "2 4" "general ground, layers, one pass" $stepped $layers
same 2 "the same, passes one by one" $stepped method%fused=F $layers
same 3 "the same in single precision" $stepped method%precision=single body%high=4,4,16 $layers
same "1 2 3 4" "damped general ground, layers, one pass" $stepped $layers $quality
same 3 "the same, passes one by one" $stepped method%fused=F $layers $quality
same 2 "the same in single precision" $stepped method%precision=single body%high=4,4,16 $layers $quality
same 3 "general ground in two dimensions, layers" regress/parallel/tall-plane.nml load%delay=.5 scene%end_time=1.5 snapshot%every=.7
same "3 4" "moment tensors beside the sides of a block" regress/parallel/block-side.nml

# The plan's efficiency by Eq (R2b) of doc/developers/ranks.md, of two slabs without layers: seconds of a column of own points,
# of h in the halo, of 3 h numbers sent, of a message
timeout 60 $mpirun -n 2 "$build/selas-mpi" check $hill >"$work/plan" 2>"$work/log"
awk '/^ranks: 2, planes/ { a = $(NF - 1); b = $NF } /^halo bytes a step/ { sub(/.*\(/, ""); h = $1 }
    /^efficiency expected/ { told = $3 } END {
        columns = '"$(sed -n 's/^halo bytes a step: \([0-9]*\) .*/\1/p' "$work/plan")"' / (24 * h)
        most = a > b ? a : b
        e = 16.4e-9 * (a + b) / 2 / (16.4e-9 * most + 3e-9 * h + 24 * h / 2e9 + 2e-6 / columns)
        d = told - e; exit !(told > 0 && told < 1 && d * d < .00505 ^ 2) }' "$work/plan"
verdict $? "the plan on ranks tells the efficiency of the model of cost"

# A model of the ground from a file (an rfile of SW4: 17 x 17 x 481 values, two rocks in turn): a rank reads what its lattice
# needs.
LC_ALL=C awk 'function bytes(list, n, i, one) { n = split(list, one, " "); for (i = 1; i <= n; i++) printf "%c", one[i] }
    BEGIN {
        zero = "0 0 0 0"; real = zero " " zero; fifty = zero " 0 0 73 64"; twenty = zero " 0 0 52 64"
        bytes("1 0 0 0 4 0 0 0 " zero " " real " " real " " real " " zero " 2 0 0 0")
        bytes(fifty " " fifty " " real " 1 0 0 0 17 0 0 0 17 0 0 0 1 0 0 0")
        bytes(fifty " " twenty " " real " 3 0 0 0 17 0 0 0 17 0 0 0 225 1 0 0")
        for (i = 0; i < 289; i++) bytes(zero)
        rock[0] = "0 0 250 68 0 128 59 69 0 128 187 68"; rock[1] = "0 0 225 68 0 0 250 68 0 0 122 68" # 2000 3000 1500, 1800 2000 1000
        for (i = 0; i < 289; i++) for (k = 0; k < 481; k++) bytes(rock[(i + int(k / 40)) % 2])
    }' >"$work/ground.rfile"
cat >"$work/ground.nml" <<'END'
&scene title = 'ground from a file', dimension = 3, end_time = .1 /
&method operator = 'general' /
&body low = 0, 0, 0, high = 800, 800, 9600, spacing = 100 /
&model file = 'ground.rfile' /
&load face = 'z-', shape = 'square', centre = 400, 400, 0, size = 200, 200, direction = 0, 0, 1, history = 'gaussian', width = .1, delay = .5, amplitude = 1e6 /
&receiver name = 'r', position = 500, 400, 0 /
END
SELAS_MODEL_KEPT=0
export SELAS_MODEL_KEPT
same 4 "ground from a file that ranks read in pieces" "$work/ground.nml"
awk '/^ground values read/ { read = $7; all = $9 } END { exit !(all > 3e6 && read < .6 * all) }' "$work/ranks/report.txt"
verdict $? "a rank reads no more of a model than its lattice needs"
unset SELAS_MODEL_KEPT
