#!/bin/sh
# Updated-Lagrangian SPH against He & Seaid (2016): entries of Table 1, the work of the bar with weak viscosity, the
# refusal of what cannot be stable, the beam's frequency. Argument: the build folder.
build=${1:-build}
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT
export OMP_NUM_THREADS=1

run() { # run NAME DECK OVERRIDES...
    name=$1
    deck=$2
    shift 2
    "$build/selas" "$deck" output%plots=.false. "output%directory=$out/$name" "$@" >"$out/$name.log" 2>&1
}
value() { awk -v key="$2" -F': ' '$1 == key { v = $2 } END { print v + 0 }' "$out/$1/report.txt"; }
holds() { # holds NAME CONDITION (awk)
    if awk "BEGIN { exit !($2) }"; then echo "ok - $1: $2"; else echo "not ok - $1: $2"; fi
}
errors() { # L1 and L2 of the velocity against d'Alembert's step
    awk '/^#/ || NF < 5 { next }
        { exact = $2 < sqrt(45e9 / 1738) * .12e-3 ? 1 : 0; e = $5 - exact; s += e < 0 ? -e : e; q += e * e; all += exact }
        END { print s / all, sqrt(q / all) }' "$out/$1/along.dat"
}
bar() { # bar NP OVERRIDES...: errors in $l1 and $l2, 9 if the run failed
    np=$1
    shift
    rm -rf "$out/bar"
    l1=9 l2=9
    run bar input/bar.nml "body%spacing=$(awk "BEGIN { printf \"%.17g\", 1 / $np }")" "profile%points=$np" \
        "profile%from=$(awk "BEGIN { printf \"%.17g\", .5 / $np }")" \
        "profile%to=$(awk "BEGIN { printf \"%.17g\", 1 - .5 / $np }")" "$@" || return 0
    set -- $(errors bar)
    l1=$1 l2=$2
}
entry() { # entry NP STEP SCHEME L1 L2: within 2.5 % of the paper
    bar "$1" "stepping%scheme=$3" "stepping%time_step=$2" stepping%rule=paper stepping%force=.true.
    holds "Table 1, $1 particles, $2 s, $3" "$l1 > .975 * $4 && $l1 < 1.025 * $4 && $l2 > .975 * $5 && $l2 < 1.025 * $5"
}
entry 250 .118e-6 euler .0840 .1569
entry 250 .236e-6 pc2 .0889 .1613
entry 250 .236e-6 rk4 .0889 .1613
entry 250 .472e-6 rkc .0889 .1612
entry 500 .236e-6 rkc .0625 .1354
entry 1000 .472e-6 rkc .0441 .1137
for scheme in euler pc2 rk4; do
    bar 1000 stepping%scheme=$scheme stepping%time_step=.472e-6 stepping%force=.true.
    holds "1000 particles, .472e-6 s, $scheme is unstable" "$l1 == 9"
done
bar 250 stepping%scheme=rk4 stepping%time_step=1e-6
holds 'rk4 beyond its limit is refused without force' "$l1 == 9 && $(grep -c 'stability limit' "$out/bar.log") > 0"
bar 250 method%viscosity_alpha=0 method%viscosity_beta=0
holds 'rkc without viscosity is refused' "$l1 == 9 && $(grep -c 'whatever the number of stages' "$out/bar.log") > 0"
bar 250 method%viscosity_alpha=.5 method%viscosity_beta=.5 method%variant=total-lagrangian method%gradient=linear \
    stepping%scheme=leapfrog
holds 'viscosity .5, leapfrog' "$l1 <= .041 && 250 * $(value bar 'operator calls') <= 40000"

run beam input/beam.nml method%variant=updated-lagrangian scene%end_time=.0065 snapshot%every=1.0
frequency=$(value beam 'frequency at tip')
holds 'beam, spacing .01: 1727 rad/s or nearer 2008.3' "$frequency >= 1727 && $frequency <= 2300"
