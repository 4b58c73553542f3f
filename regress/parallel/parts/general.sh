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

# A model of the ground from a file: a rank reads what its lattice needs.
ground="regress/parallel/ground-file.nml model%file=$work/ground.rfile"
LC_ALL=C awk -v values=1921 -f regress/parallel/rfile.awk >"$work/ground.rfile"
SELAS_MODEL_KEPT=0
export SELAS_MODEL_KEPT
same 4 "ground from a file that ranks read in pieces" $ground
awk '/^ground values read/ { read = $7; all = $9 } END { exit !(all > 1.3e7 && read < .6 * all) }' "$work/ranks/report.txt"
verdict $? "a rank reads no more of a model than its lattice needs"
unset SELAS_MODEL_KEPT
[ -z "${SELAS_SANITIZED:-}" ] || return 0 # sanitizers keep what is let go of
quiet 4 $ground output%plots=F output%directory="$work/whole"
awk -F ': ' '/^peak memory/ { peak[FILENAME] = $2 } END { exit !(peak[ARGV[1]] + .75 * 24 * 17 * 17 * 1921 < peak[ARGV[2]]) }' "$work/ranks/report.txt" "$work/whole/report.txt"
verdict $? "no rank that reads a model in pieces has a quarter of it at once"
