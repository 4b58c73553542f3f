#!/bin/sh
# Frequency and energy of the swinging beam (input/beam.nml) against two-dimensional elasticity. Argument: the build
# folder.
build=${1:-build}
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

check() { # check NAME LIMIT OVERRIDES...
    name=$1
    limit=$2
    shift 2
    "$build/selas" input/beam.nml output%plots=.false. "output%directory=$out" initial%amplitude=0.001 "$@" \
        >"$out.log" 2>&1 || cat "$out.log"
    rm -f "$out.log"
    error=$(sed -n 's/^frequency error at tip: //p' "$out/report.txt")
    defect=$(sed -n 's/^energy balance defect: \([^ ]*\).*/\1/p' "$out/report.txt")
    if awk "BEGIN { e = ${error:-9}; exit !(e < $limit && e > -$limit) }"; then
        echo "ok - $name: frequency error $error within $limit"
    else
        echo "not ok - $name: frequency error $error, limit $limit"
    fi
    if awk "BEGIN { exit !(${defect:-9} < 3e-3) }"; then
        echo "ok - $name: energy within $defect"
    else
        echo "not ok - $name: energy within $defect, limit 3e-3"
    fi
}

check 'W = .1, spacing .01' 0.005
check 'W = .05, spacing .01' 0.02 body%high=0.5,0.05 scene%end_time=0.03 'receiver(1)%position=0.5,0.025' \
    'receiver(2)%position=0.25,0.025'
