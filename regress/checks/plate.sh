#!/bin/sh
# The settled plate with a hole against the finite-plate curves of regress/reference/hole: L1 of the stress along y = 0
# over the mean of the loaded edge, at 61 even points. Argument: the build folder.
build=${1:-build}
out=$(mktemp -d)
trap 'rm -rf "$out"' EXIT

# compare CURVE FOLDER: L1 error (profile ligament, over the mean of profile loaded)
compare() {
    awk -v curve="$1" -v loaded="$2/loaded.dat" '
        BEGIN {
            while ((getline line < curve) > 0)
                if (line !~ /^#/) { split(line, f, ","); x[++n] = f[1]; s[n] = f[2] }
            while ((getline line < loaded) > 0)
                if (line !~ /^#/ && split(line, f, " ") > 5) { if (cells++) mean += (f[6] + before) / 2; before = f[6] }
            mean /= cells - 1
        }
        /^#/ || NF < 9 { next }
        {
            k = 1
            while (k + 1 < n && x[k + 1] < $2) k++
            exact = s[k] + (s[k + 1] - s[k]) * ($2 - x[k]) / (x[k + 1] - x[k])
            d = $9 / mean - exact
            sum += d < 0 ? -d : d
            all += exact
            rows++
        }
        END { if (rows == 61) printf "%.4f", sum / all; else print "9" }' "$2/ligament.dat"
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

check 'plate R = .3, 1,084 points' 0.015 R0.3_disp.csv
check 'plate R = .3, 3,004 points' 0.006 R0.3_disp.csv body%spacing=0.0183
check 'plate R = .2, 3,132 points' 0.009 R0.2_disp.csv body%spacing=0.0183 body%hole_radius=0.2 'profile(1)%from=0.2,0.0'
