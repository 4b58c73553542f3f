#!/bin/sh
# method%precision = 'single' against double, displacements and velocities at two receivers: the report's estimate of what
# it adds to the largest holds, and is no more than some 50 times what is added. Argument: the build folder. Prints TAP.
build=${1:-build}
selas=$PWD/$build/selas
study=$PWD/regress/studies/single folder=$PWD/$build
. "$PWD/regress/checks/parts/scenes.sh"
work=$(mktemp -d "${TMPDIR:-/tmp}/selas-single-XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
export OMP_NUM_THREADS=1
failures=0
# held NAME END WORDS...: the scene to t = END in both
held() {
    name=$1 end=$2
    shift 2
    scene "$name"
    for precision in double single; do
        "$selas" -q "$name.nml" output%directory="${name}_$precision" method%precision=$precision scene%end_time="$end" "$@" || return 1
    done
    said=$(sed -n 's/^single precision adds: about \([^ ]*\) .*/\1/p' "${name}_single/report.txt")
    for receiver in r1 r2; do
        grep -v '^#' "${name}_single/$receiver.dat" >single.rows
        grep -v '^#' "${name}_double/$receiver.dat" | paste - single.rows | awk '
            {
                for (i = 2; i <= 7; i++) {
                    of = i > 4
                    d = $i - $(i + 7); if (d < 0) d = -d; if (d > apart[of]) apart[of] = d
                    size = $i < 0 ? -$i : $i; if (size > largest[of]) largest[of] = size
                }
            }
            END { print apart[0] / largest[0]; print apart[1] / largest[1] }'
    done | awk -v said="$said" -v limit="${limit:-50}" -v what="$name to $end $*" '
        $1 > worst { worst = $1 }
        END {
            good = worst > 0 && worst < said && said < limit * worst
            printf "%s - %s: adds %.1e, said %.1e\n", good ? "ok" : "not ok", what, worst, said
            exit !good
        }'
}
held pass 4 || failures=$((failures + 1))
held pass 24 || failures=$((failures + 1))
held sweep 4 || failures=$((failures + 1))
held sweep-layers 4 || failures=$((failures + 1))
held sweep-damped 4 || failures=$((failures + 1))
held single 4 || failures=$((failures + 1))
# slow: displacements that hardly move while their forces are rounded
slow='load%history=gaussian load%frequency= load%width=2 load%delay=10'
# shellcheck disable=SC2086
for scene in pass single; do held $scene 24 $slow || failures=$((failures + 1)); done
# shellcheck disable=SC2086
held sweep 24 $slow || failures=$((failures + 1))
# a moment tensor beside an interface that slopes, a little below the surface: the lattice about it is thinner than the body
held sweep 4 'load%face=' 'load%shape=' 'load%size=' 'load%direction=' load%kind=moment-tensor load%moment=1,0,-1,.3,.2,.5 \
    load%centre=1.75,1.75 load%depth=.5 'layer(2)%top=.2' || failures=$((failures + 1))
# a moment tensor: what is rounded beside it comes to receivers that move little
if sh "$study" "$folder" 63 63 >drawn.rows; then
    echo "ok - a moment tensor: $(tail -1 drawn.rows)"
else
    echo "not ok - a moment tensor: $(tail -1 drawn.rows)"
    failures=$((failures + 1))
fi
if grep -q "^single precision" pass_double/report.txt; then
    echo "not ok - a run in double precision says nothing of it"
    failures=$((failures + 1))
else
    echo "ok - a run in double precision says nothing of it"
fi
exit $failures
