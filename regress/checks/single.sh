#!/bin/sh
# method%precision = 'single' against double: the report's estimate of what it adds holds, and is no more than some 30
# times what is added. Argument: the build folder. Prints TAP.
build=${1:-build}
selas=$PWD/$build/selas
. "$PWD/regress/checks/parts/scenes.sh"
work=$(mktemp -d "${TMPDIR:-/tmp}/selas-single-XXXXXX") || exit 1
trap 'rm -rf "$work"' EXIT
cd "$work" || exit 1
export OMP_NUM_THREADS=1
failures=0
# held NAME END: the scene to t = END in both
held() {
    scene "$1"
    for precision in double single; do
        "$selas" -q "$1.nml" output%directory="$1_$precision" method%precision=$precision scene%end_time="$2" || return 1
    done
    said=$(sed -n 's/^single precision adds: about \([^ ]*\) .*/\1/p' "$1_single/report.txt")
    "$selas" diff "$1_double" "$1_single" | awk -v said="$said" -v what="$1 to $2" '
        $2 ~ /^[uv][xyz]$/ && $3 + 0 > worst { worst = $3 + 0 }
        END {
            good = worst > 0 && worst < said && said < 30 * worst
            printf "%s - %s: adds %.1e, said %.1e\n", good ? "ok" : "not ok", what, worst, said
            exit !good
        }'
}
held pass 4 || failures=$((failures + 1))
held pass 24 || failures=$((failures + 1))
held sweep 4 || failures=$((failures + 1))
held sweep-layers 4 || failures=$((failures + 1))
held single 4 || failures=$((failures + 1))
if grep -q "^single precision" pass_double/report.txt; then
    echo "not ok - a run in double precision says nothing of it"
    failures=$((failures + 1))
else
    echo "ok - a run in double precision says nothing of it"
fi
exit $failures
