#!/bin/sh
# The half-space on points: central differences on a lattice, smoothed points on a jittered cloud; a free cloud keeps
# its energy for a long time. Argument: the build folder.
build=${1:-build}
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

run() { "$build/selas" "$@" output%plots=.false. "output%directory=$out/run" >"$out/log" 2>&1 || tail -3 "$out/log"; }
# errors NAME LIMIT LIMIT LIMIT: L2 of vz at the three receivers
errors() {
    awk -v name="$1" -v a="$2" -v b="$3" -v c="$4" '
        /^error (centre|r1|r2) vz: L2/ { e[++n] = $5 }
        END {
            good = n == 3 && e[1] <= a && e[2] <= b && e[3] <= c
            printf "%s - %s: %s %s %s, limits %s %s %s\n", good ? "ok" : "not ok", name, e[1], e[2], e[3], a, b, c
        }' "$out/run/report.txt"
}

run input/halfspace-sph.nml
errors 'half-space, central differences, spacing .25' 0.08 0.13 0.14
run input/halfspace-cloud.nml body%spacing=0.5
errors 'half-space, cloud, spacing .5' 0.22 0.35 0.68

# A struck body, all faces free: the pulse ends at t = 3, the energy stays.
sed -e "s/kind = 'symmetry'/kind = 'free'/" -e '/^&reference/d' -e 's/^&receiver.*$//' input/halfspace-cloud.nml >"$out/free.nml"
echo "&receiver name = 'corner', position = 0.0, 0.0, 0.0 /" >>"$out/free.nml"
run "$out/free.nml" body%high=3.0,3.0,3.0 body%spacing=0.5 scene%end_time=100.0
awk -F': ' '
    /^energy kinetic/ { end += $2 }
    /^energy strain/ { end += $2 }
    /^energy largest/ { most = $2 }
    END {
        good = most > 0 && end > 0.98 * most
        printf "%s - free cloud, t = 100: energy %.5f of at most %.5f\n", good ? "ok" : "not ok", end, most
    }' "$out/run/report.txt"
