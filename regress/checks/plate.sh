#!/bin/sh
# The settled plate with a hole against the finite-plate curves of regress/reference/hole: L1 of the stress along y = 0
# over the mean stress of the loaded edge, at 61 even points. That mean follows from equilibrium: the force through the
# ligament over the length of the edge. Argument: the build folder.
build=${1:-build}
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

# compare CURVE FOLDER: L1 error of profile ligament
compare() {
    awk -v curve="$1" '
        BEGIN {
            while ((getline line < curve) > 0)
                if (line !~ /^#/) { split(line, f, ","); x[++n] = f[1]; s[n] = f[2] }
        }
        /^#/ || NF < 9 { next }
        { at[++rows] = $2; stress[rows] = $9 }
        END {
            if (rows != 61) { print "9"; exit }
            for (i = 1; i < rows; i++) mean += (stress[i] + stress[i + 1]) / 2 * (at[i + 1] - at[i]) / at[rows]
            for (i = 1; i <= rows; i++) {
                k = 1
                while (k + 1 < n && x[k + 1] < at[i]) k++
                exact = s[k] + (s[k + 1] - s[k]) * (at[i] - x[k]) / (x[k + 1] - x[k])
                d = stress[i] / mean - exact
                sum += d < 0 ? -d : d
                all += exact
            }
            printf "%.4f", sum / all
        }' "$2/ligament.dat"
}

check() { # check NAME LIMIT CURVE OVERRIDES...
    name=$1
    limit=$2
    curve=regress/reference/hole/$3
    shift 3
    "$build/selas" input/plate.nml output%plots=.false. "output%directory=$out" "$@" >"$out.log" 2>&1 || cat "$out.log"
    rm -f "$out.log"
    error=$(compare "$curve" "$out")
    quiet=$(awk -F': ' '/^energy kinetic/ { k = $2 } /^energy strain/ { s = $2 } END { print k < 1e-6 * s }' "$out/report.txt")
    if [ "$quiet" = 1 ] && awk "BEGIN { exit !($error <= $limit) }"; then
        echo "ok - $name: L1 $error <= $limit"
    else
        echo "not ok - $name: L1 $error, limit $limit, settled: $quiet"
    fi
}

check 'plate R = .3, 1,026 points, moved edge' 0.008 R0.3_disp.csv
check 'plate R = .2, 1,054 points, moved edge' 0.008 R0.2_disp.csv body%hole_radius=0.2 'profile(1)%from=0.2,0.0'

# Updated Lagrangian: with one smoothing length for all particles of the graded arrangement .050 and .071.
updated='method%variant=updated-lagrangian method%artificial_stress=0 method%viscosity_alpha=2.5'
check 'plate R = .3, 1,026 points, updated Lagrangian' 0.035 R0.3_disp.csv $updated
check 'plate R = .2, 1,054 points, updated Lagrangian' 0.025 R0.2_disp.csv body%hole_radius=0.2 'profile(1)%from=0.2,0.0' \
    $updated
